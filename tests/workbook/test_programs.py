"""Workbooks as other programs write them."""

import re
from datetime import datetime
from pathlib import Path

import pytest

from assess.errors import WorkbookError
from assess.workbook.read import read_inventory
from tests.recalculate import libreoffice, needs_libreoffice
from tests.workbook.books import FLOORS, ITEMS, change_parts, read_part, write, write_book, write_shared
from tests.workbook.raw import SHEET, SHEETS, zip_bytes
from tests.workbooks import edited, parts_of

FLOOR_SHEET = "xl/worksheets/sheet2.xml"


def items_of(path: Path) -> list[tuple[str, str, float, float]]:
    return [(one.item, one.floor, one.breadth, one.height) for one in read_inventory(path).items]


def test_files_by_xlsxwriter_and_by_other_programs(tmp_path: Path) -> None:
    for options in ({}, {"constant_memory": True}):
        path = write_shared(tmp_path / "book.xlsx", SHEETS, **options)
        assert items_of(path) == [("A1", "1", 0.4, 1.8)]
    rich = '<c r="A2" t="inlineStr"><is><r><t>A</t></r><r><rPr><b/></rPr><t>1b</t></r></is></c>'
    path = write_shared(tmp_path / "book.xlsx", SHEETS)
    change_parts(path, {SHEET: lambda data: re.sub(rb'<c r="A2" t="s"><v>\d+</v></c>', rich.encode(), data)})
    assert items_of(path)[0][0] == "A1b"
    # As WPS, Java and JavaScript libraries write them: no addresses, no dimension, prefixes, line breaks.
    changes = (
        without_addresses, with_prefix, lambda data: data.replace(b'"', b"'"),
        lambda data: data.replace(b"><", b">\n\t<"),
    )  # fmt: skip
    for change in changes:
        path = write(tmp_path, [*ITEMS, ["A2", "1", 50, 200]])
        change_parts(path, {SHEET: change, FLOOR_SHEET: change})
        assert items_of(path) == [("A1", "1", 0.4, 1.8), ("A2", "1", 0.5, 2.0)]


def without_addresses(data: bytes) -> bytes:
    text = re.sub(r'<c r="[A-Z]+\d+"', "<c", data.decode())
    return re.sub(r'<row r="\d+"[^>]*>', "<row>", re.sub(r"<dimension[^>]*/>", "", text)).encode()


def with_prefix(data: bytes) -> bytes:
    text = re.sub(r"<(/?)(?=[a-z])", r"<\1x:", data.decode())
    return text.replace("xmlns=", "xmlns:x=").encode()


def test_a_date_beyond_the_calendar_is_an_error_and_broken_names_and_other_sheets_do_no_harm(tmp_path: Path) -> None:
    path = write(tmp_path, [ITEMS[0], ["A1", "1", datetime(2024, 1, 1), 180]])
    change_parts(path, {SHEET: lambda data: re.sub(rb"<v>45292</v>|<v>2024-01-01[^<]*</v>", b"<v>99999999</v>", data)})
    with pytest.raises(WorkbookError, match="Items!C2: Breadth holds"):
        read_inventory(path)
    # Print areas whose sheet is gone, and a sheet that is none of ours and damaged.
    path = write_book(tmp_path / "book.xlsx", {"Items": ITEMS, "Floors": FLOORS, "Photos": [["x"]]})
    names = '<definedNames><definedName name="_xlnm.Print_Titles" localSheetId="0">#REF!</definedName></definedNames>'
    workbook = "xl/workbook.xml"
    text = re.sub(r"<definedNames\s*/>", names, read_part(path, workbook))
    assert "#REF!" in text
    change_parts(path, {workbook: text.encode(), "xl/worksheets/sheet3.xml": b"<worksheet><broken"})
    assert len(items_of(path)) == 1


@pytest.mark.libreoffice
@needs_libreoffice
def test_files_by_libreoffice(tmp_path: Path) -> None:
    path = write(tmp_path, [[*ITEMS[0], "Quantity", "Notes"], [*ITEMS[1], "=1+1", "ä\n2"]], Building=[["Use", "x"]])
    found = read_inventory(libreoffice(path, tmp_path / "again.xlsx")).items[0]
    assert (found.item, found.breadth, found.quantity, found.notes) == ("A1", 0.4, 2, "ä\n2")


def test_signs_without_width_round_a_text_and_the_case_of_names_of_parts_do_not_count(tmp_path: Path) -> None:
    for form in ("\ufeff{}", "{}\u200b", "\u2060{}\u2060", "{}_x000D_\n", "\r\n{}"):
        items = [[form.format(one) if isinstance(one, str) else one for one in row] for row in ITEMS]
        path = write_book(tmp_path / "book.xlsx", {" ITEMS": items, "floors ": FLOORS})
        assert (items_of(path), read_inventory(path).problems) == ([("A1", "1", 0.4, 1.8)], ())
    parts = parts_of(write_shared(tmp_path / "book.xlsx", SHEETS))
    for name, other in CASES.items():
        path, saved = tmp_path / "other.xlsx", tmp_path / "saved.xlsx"
        path.write_bytes(zip_bytes({other if one == name else one: data for one, data in parts.items()}))
        assert items_of(path) == [("A1", "1", 0.4, 1.8)]
        saved.write_bytes(edited(path.read_bytes(), {"Items": {"D2": 150}}))
        assert items_of(saved) == [("A1", "1", 0.4, 1.5)]


CASES = {
    "xl/sharedStrings.xml": "xl/SharedStrings.xml",
    SHEET: "xl\\worksheets\\Sheet1.XML",
    "xl/workbook.xml": "XL/Workbook.xml",
}
