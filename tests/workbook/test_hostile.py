"""XML made to do harm, sheets that lie, parts that are too large: one clear sentence, or the right answer."""

import random
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import openpyxl
import openpyxl.utils
import pytest

from assess.workbook.read import read_inventory
from tests.workbook.books import ITEMS, change_parts, errors_of, replace, write, write_shared
from tests.workbook.raw import (
    FIRST,
    HEADER,
    MAIN,
    RELATIONS,
    SHEET,
    SHEETS,
    STRINGS,
    TABLE,
    WORKBOOK,
    add_part,
    read_apart,
    sheet_of,
    zip_bytes,
)
from tests.workbooks import parts_of

LAUGHS = "<!DOCTYPE x [" + '<!ENTITY a0 "ha">' + "".join(
    f'<!ENTITY a{n} "{f"&a{n - 1};" * 10}">' for n in range(1, 10)
) + "]>"  # fmt: skip
OUTSIDE = '<!DOCTYPE x [<!ENTITY a9 SYSTEM "file:///etc/hostname">]>'
ENTITIES = {"laughs": LAUGHS, "outside": OUTSIDE}
STYLES, TYPES = "xl/styles.xml", "[Content_Types].xml"
PARTS = [SHEET, STRINGS, WORKBOOK, RELATIONS, STYLES, TYPES]


def test_entities(tmp_path: Path) -> None:
    for name, entities in ENTITIES.items():

        def declare(data: bytes, declared: bytes = entities.encode()) -> bytes:
            return declared + data.split(b"?>")[-1]

        for at, part in enumerate(PARTS):
            change_parts(write_shared(tmp_path / f"{name}-{at}.xlsx", SHEETS), {part: declare})
    found = read_apart(tmp_path)
    assert len(found) == len(ENTITIES) * len(PARTS)
    assert found == {
        name: f"{name}.xlsx declares XML entities, as an attack does. Save it again from Excel." for name in found
    }


def test_damaged_xml(tmp_path: Path) -> None:
    for part in PARTS:
        path = write_shared(tmp_path / "book.xlsx", SHEETS)
        change_parts(path, {part: lambda data: data[: len(data) // 2]})
        (error,) = errors_of(path)
        assert re.fullmatch(
            r"(book.xlsx is damaged or is no Excel workbook: its XML is broken|the workbook is damaged: .* breaks off)\. "
            r"Open it in Excel and save it again\.",
            error,
        )


def test_relations_that_lead_outside_of_every_spelling_and_to_one_sheet_under_two_names(tmp_path: Path) -> None:
    for target in ("../../x.xml", "http://127.0.0.1:9/sheet.xml", "file:///etc/passwd", "//h/s.xml"):
        for mode in ("", ' TargetMode="External"'):
            change = replace('Target="/xl/worksheets/sheet1.xml"', f'Target="{target}"{mode}')
            (error,) = errors_of(change_parts(write(tmp_path), {RELATIONS: change}))
            assert "Items: the sheet is missing." in error or "is damaged" in error
    for target in ("worksheets/sheet1.xml", "../xl/worksheets/sheet1.xml", "./worksheets/sheet1.xml"):
        path = change_parts(write(tmp_path), {RELATIONS: replace("/xl/worksheets/sheet1.xml", target)})
        assert len(read_inventory(path).items) == 1
    path = write(tmp_path)
    parts = parts_of(path)
    other = parts[WORKBOOK].replace(b'r:id="rId1"', b'r:id="rId9"').replace(b'r:id="rId2"', b'r:id="rId1"')
    other = other.replace(b'r:id="rId9"', b'r:id="rId2"')
    types = replace('PartName="/xl/workbook.xml"', 'PartName="/xl/other.xml"')
    change_parts(path, {"xl/other.xml": other, "xl/_rels/other.xml.rels": parts[RELATIONS], TYPES: types})
    assert errors_of(path) == {
        "the workbook is damaged: xl/other.xml stands for xl/workbook.xml. Open it in Excel and save it again."
    }


def test_a_sheet_that_is_a_chart_a_dimension_that_lies_and_deep_xml(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    book.create_chartsheet("Items")
    book.save(tmp_path / "book.xlsx")
    missing = "the sheet is missing. Add it, or start from a workbook made with `assess new`."
    assert errors_of(tmp_path / "book.xlsx") == {f"Items: {missing}", f"Floors: {missing}"}
    items = [ITEMS[0], *([f"A{n}", "1", 40, 180] for n in range(5))]
    path = write(tmp_path, items)
    change_parts(path, {SHEET: replace('<dimension ref="A1:D6"', '<dimension ref="A1"')})
    assert len(read_inventory(path).items) == 5
    change_parts(write(tmp_path), {STYLES: b"<a>" * 100_000 + b"</a>" * 100_000})
    text = read_apart(tmp_path)["book"]
    assert text == "1 items" or "is damaged" in text


ROWS_BELOW = "a value far below the table; at most 100,000 rows are read. Delete the rows below the table."
COLUMNS_BEYOND = (
    "a value far to the right of the table; at most 256 columns are read. Delete the columns right of the table."
)
FAR = {"XFD1048576": f"A1048576: {ROWS_BELOW}", "A200000": f"A200000: {ROWS_BELOW}",
       "XFD3": f"XFD3: {COLUMNS_BEYOND}", "IW1": f"IW1: {COLUMNS_BEYOND}"}  # fmt: skip


def blank_rows(row: str) -> Iterator[bytes]:
    """Yield the table, and 400,000 rows below it."""
    yield TABLE
    for first in range(3, 400_000, 1000):
        yield "".join(row.format(number, number) for number in range(first, first + 1000)).encode()


def styled_columns() -> bytes:
    letters, rows = [openpyxl.utils.get_column_letter(at) for at in range(5, 16385)], HEADER
    for number in range(2, 10):
        own = FIRST.replace(">A1<", f">P{number}<").replace('2"', f'{number}"')
        rows += own.replace("</row>", "".join(f'<c r="{one}{number}" s="0"/>' for one in letters) + "</row>")
    return rows.encode()


def filled(cell: bytes) -> list[bytes]:
    return [TABLE, b"<row>" + cell * 300 + b"</row>"]


NOISE = random.Random(2).randbytes(4 * 2**20).hex().encode()
MERGED = b"".join(b'<mergeCell ref="A%d:B%d"/>' % (n, n) for n in range(1, 300_000))
ODD_SHEETS: dict[str, tuple[Iterable[bytes], dict[str, bytes], str]] = {
    "styled rows": (blank_rows('<row r="{}" s="1" customFormat="1"/>'), {}, "1 items"),
    "styled cells": (blank_rows('<row r="{}"><c r="A{}" s="0"/></row>'),
                     {"before": b'<dimension ref="A1:D400000"/>'}, "1 items"),
    "styled columns": ([styled_columns()], {}, "8 items"),
    "numbers without addresses": (filled(b"<c><v>1</v></c>"), {}, f"Items column 257 of row 3: {COLUMNS_BEYOND}"),
    "texts without addresses": (filled(b'<c t="inlineStr"><is><t>x</t></is></c>'), {},
                                f"Items column 257 of row 3: {COLUMNS_BEYOND}"),
    "many cells": ([TABLE, b"<row>" + b"<c/>" * 40_000 + b"</row>"], {},
                   f"the workbook is damaged: row 3 of {SHEET} has more cells than a sheet has columns. "
                   "Open it in Excel and save it again."),
    "a long row": ([TABLE, b'<row r="3"><c r="D3" t="inlineStr"><is><t>' + NOISE + b"</t></is></c></row>"], {},
                   f"{SHEET} holds a row of over 2 MB. Delete that row."),
    "merged cells": ([TABLE], {"after": b"<mergeCells>" + MERGED + b"</mergeCells>"},
                     "cells are merged inside the table"),
}  # fmt: skip


@pytest.mark.slow
def test_sheets_that_are_large_or_lie_about_it(tmp_path: Path) -> None:
    expected = {cell: f"Items!{message}" for cell, message in FAR.items()}
    for cell in FAR:
        book = openpyxl.load_workbook(write(tmp_path))
        book["Items"][cell] = "far"
        book.save(tmp_path / f"{cell}.xlsx")
    for name, (pieces, options, message) in ODD_SHEETS.items():
        path = add_part(write(tmp_path), SHEET, sheet_of(iter(pieces), **options))
        path.rename(tmp_path / f"{name}.xlsx")
        expected[name] = message
    found = read_apart(tmp_path)
    assert expected.pop("merged cells") in found.pop("merged cells")
    assert found == expected


def test_rows_out_of_order_or_without_a_number_and_another_encoding_are_damage(tmp_path: Path) -> None:
    """Openpyxl's quick reader leaves such rows out without a word."""
    order = [(2, 5, 3), (2, 2), (0,), (9_999_999,)]
    for numbers in order:
        rows = "".join(f'<row r="{n}"><c r="A{n}" t="inlineStr"><is><t>A{n}</t></is></c></row>' for n in numbers)
        path = add_part(write(tmp_path), SHEET, sheet_of(iter([HEADER.encode(), rows.encode()])))
        assert errors_of(path) == {
            f"the workbook is damaged: the rows of {SHEET} are out of order. Open it in Excel and save it again."
        }
    for number in ("x", "-3", "1e3", "99999999", ""):
        row = f'<row r="{number}"><c t="inlineStr"><is><t>A2</t></is></c></row>'.encode()
        assert errors_of(add_part(write(tmp_path), SHEET, sheet_of(iter([TABLE, row])))) == {
            f"the workbook is damaged: {SHEET} has a row numbered {number}. Open it in Excel and save it again."
        }
    path = change_parts(write(tmp_path), {SHEET: lambda data: data.decode().encode("utf-16")})
    assert errors_of(path) == {
        f"the workbook is damaged: {SHEET} is not written in UTF-8. Open it in Excel and save it again."
    }


SLOW: dict[str, tuple[bytes, bytes, int, bytes]] = {
    "attributes": (b"<row ", b' r="A1"', 1_900_000, b""), "cells": (b'<row r="3">', b"<c r='A1' ", 1_900_000, b""),
    "formulas": (b'<row r="3">', b'<c r="A1"><f>', 1_900_000, b""),
    "blanks": (b'<row r="3"><c r="A3">', b" ", 1_900_000, b"<f>"), "rows": (b"", b"<row", 1_900_000, b""),
    "a long tag": (b'<row r="', b"1", 40_000_000, b""), "a deep tree": (b"", b"<a>", 40_000_000, b""),
}  # fmt: skip
"""A start, what is repeated, so many bytes of it, and an end."""


@pytest.mark.slow
def test_bytes_made_to_be_slow(tmp_path: Path) -> None:
    parts = parts_of(write(tmp_path))
    for name, (start, piece, size, end) in SLOW.items():
        parts[SHEET] = b"".join(sheet_of(iter([TABLE, start + piece * (size // len(piece)) + end])))
        (tmp_path / f"{name}.xlsx").write_bytes(zip_bytes(parts))
    found = read_apart(tmp_path)
    assert found.pop("book") == "1 items"
    assert set(found) == set(SLOW)
    assert "1 items" not in found.values()


def xml(start: str, piece: str, count: int, end: str) -> bytes:
    """Return pieces that are all alike, and so much noise that the zip does not look like a bomb."""
    noise = random.Random(3).randbytes(60_000).hex()
    return f"{start}<!--{noise}-->{piece * count}{end}".encode()


LARGE: dict[str, tuple[str, str, str, int, str]] = {
    "strings": (STRINGS, f'<sst xmlns="{MAIN}">', "<si><t>ab</t></si>", 249_000, "</sst>"),
    "blank strings": (STRINGS, f'<sst xmlns="{MAIN}">', "<si/>", 990_000, "</sst>"),
    "cell styles": (STYLES, f'<styleSheet xmlns="{MAIN}"><cellXfs>', "<xf/>", 290_000, "</cellXfs></styleSheet>"),
    "fonts": (STYLES, f'<styleSheet xmlns="{MAIN}"><fonts>', "<font/>", 290_000, "</fonts></styleSheet>"),
    "names": (WORKBOOK, f'<workbook xmlns="{MAIN}"><definedNames>', '<definedName name="a">1</definedName>', 140_000,
              "</definedNames></workbook>"),
    "sheets": (WORKBOOK, f'<workbook xmlns="{MAIN}"><sheets>', '<sheet name="a" sheetId="1"/>', 200_000,
               "</sheets></workbook>"),
    "links": (RELATIONS, '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">',
              '<Relationship Id="r" Type="t" Target="x"/>', 180_000, "</Relationships>"),
    "types": (TYPES, '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">',
              '<Override PartName="/p" ContentType="t"/>', 190_000, "</Types>"),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("times", [pytest.param(1, marks=pytest.mark.long), 2])
def test_large_parts(tmp_path: Path, times: int) -> None:
    """Just below the limits the memory stays within bounds; above them they are refused."""
    for name, (part, start, piece, count, end) in LARGE.items():
        path = write_shared(tmp_path / f"{name}.xlsx", SHEETS)
        change_parts(path, {part: xml(start, piece, times * count, end)})
    found = read_apart(tmp_path)
    assert set(found) == set(LARGE)
    assert {name for name, text in found.items() if "as a zip bomb does" in text} == (
        set() if times == 1 else set(LARGE)
    )
