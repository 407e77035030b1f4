"""Cells set in the bytes of a workbook: what is asked for changes, and nothing else does."""

import io
import math
import re
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import openpyxl
import pytest
import xlsxwriter
from hypothesis import given, settings, strategies as st

from assess.errors import WorkbookError
from assess.workbook.open import UNSAVED, Book
from assess.workbook.plain_rows import column_letters
from assess.workbook.read import open_workbook
from tests.pictures import picture
from tests.recalculate import libreoffice, needs_libreoffice, stored_cells
from tests.workbook.books import change_parts, replace
from tests.workbook.raw import MAIN, RELATIONS, SHEET, zip_bytes
from tests.workbooks import edited, parts_of, places

BOOK, CHAIN, TYPES = "xl/workbook.xml", "xl/calcChain.xml", "[Content_Types].xml"


def directory_of(data: bytes) -> list[tuple[Any, ...]]:
    """What the zip says of each part, but for what depends on its bytes."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        names = ("filename", "date_time", "compress_type", "comment", "extra", "external_attr", "create_system")
        return [tuple(getattr(info, name) for name in names) for info in archive.infolist()]


def changed_parts(before: bytes, after: bytes) -> set[str]:
    old, new = parts_of(before), parts_of(after)
    return {name for name in {*old, *new} if old.get(name) != new.get(name)}


def values_of(data: bytes, sheet: str = "Items") -> dict[str, Any]:
    """What openpyxl reads."""
    book = openpyxl.load_workbook(io.BytesIO(data))
    found = {cell.coordinate: cell.value for row in book[sheet].iter_rows() for cell in row if cell.value is not None}
    book.close()
    return found


def own_values(data: bytes, sheet: str = "Items") -> dict[str, Any]:
    """What assess reads."""
    with Book(data, "book.xlsx") as book:
        rows = list(book.cells(sheet).rows())
    return {f"{column_letters(at)}{number}": value for number, cells in rows for at, value in cells.items()}


def refusals(data: bytes, changes: Mapping[str, Mapping[str, Any]], **named: Any) -> set[str]:
    with pytest.raises(WorkbookError) as caught:
        edited(data, changes, **named)
    return {str(one) for one in caught.value.problems}


def minimal(rows: str, *, head: str = "", tail: str = "", root: str = f'<worksheet xmlns="{MAIN}">') -> bytes:
    """A workbook whose sheet Items holds this XML."""
    packed = io.BytesIO()
    with xlsxwriter.Workbook(packed) as book:
        book.add_worksheet("Items")
    name = root[1:].partition(" ")[0]
    return zip_bytes(parts_of(packed.getvalue()) | {SHEET: f"{root}{head}{rows}{tail}</{name}>".encode()})


def rich(path: Path) -> Path:
    """A workbook with what openpyxl loses or writes anew."""
    with xlsxwriter.Workbook(path) as book:
        page, other = book.add_worksheet("Items"), book.add_worksheet("Other")
        bold, text = book.add_format({"bold": True}), book.add_format({"num_format": "@", "bg_color": "#ffee00"})
        page.write_row(0, 0, ["Item", "Floor", "Breadth [cm]", "Height [cm]"], bold)
        for row in range(1, 12):
            page.write(row, 0, f"A{row}")
            page.write(row, 1, "1")
            page.write_string(row, 2, f"{30 + row} cm", text)
            page.write_number(row, 3, 180 + row)
            page.write_formula(row, 4, f"=C{row + 1}/D{row + 1}", None, 0.25)
        page.write_rich_string("G1", "Rich ", bold, "text")
        page.write_comment("A2", "A comment")
        page.insert_image("H2", "grey.png", {"image_data": io.BytesIO(picture("PNG"))})
        chart = book.add_chart({"type": "column"})
        chart.add_series({"values": "=Items!$D$2:$D$12"})
        page.insert_chart("H8", chart)
        page.conditional_format("D2:D12", {"type": "data_bar"})
        page.data_validation("B2:B12", {"validate": "list", "source": ["1", "2"]})
        page.add_sparkline("F2", {"range": "Items!D2:D12"})
        page.autofilter("A1:E12")
        page.set_column(20, 20, 12, text)
        page.merge_range("A20:C21", "merged")
        other.add_table("B2:D5", {"columns": [{"header": name} for name in "xyz"], "data": [[1, 2, 3]] * 3})
        book.define_name("Sizes", "=Items!$C$2:$C$12")
    return change_parts(path, {
        "xl/unknown.bin": bytes(range(256)),
        TYPES: replace("</Types>", '<Default Extension="bin" ContentType="application/octet-stream"/></Types>'),
    })  # fmt: skip


CHANGES: dict[str, Any] = {f"C{row}": 30.0 + row for row in range(2, 8)} | {
    "B3": "Ground & <1>", "C9": 0.15, "A40": "new", "U5": True,
}  # fmt: skip


def test_every_other_byte_of_a_rich_workbook_and_the_format_of_a_cell_stays(tmp_path: Path) -> None:
    before = rich(tmp_path / "book.xlsx").read_bytes()
    after = edited(before, {"Items": CHANGES})
    assert changed_parts(before, after) == {SHEET}
    assert directory_of(before) == directory_of(after)
    assert edited(after, {"Items": CHANGES}) == after
    assert edited(before, {"Items": {}}) == before
    assert values_of(after) == values_of(before) | CHANGES
    assert {**own_values(after), "E2": 0} == {**own_values(before), **CHANGES, "E2": 0}
    assert refusals(before, {"Other": {"B2": "u", "B3": 5, "E2": 1}}) == {
        "Other!B2: it is a header of a table. Change this cell in Excel."
    }
    cells = re.compile(rb'<c r="(\w+)".*?(?:/>|</c>)', re.S)
    old, new = parts_of(before)[SHEET], parts_of(after)[SHEET]
    outside = [re.sub(rb"<dimension[^>]*>", b"", cells.sub(b"", text)) for text in (old, new)]
    assert outside[1].replace(b'<row r="40"></row>', b"") == re.sub(rb'(<row r="5") spans="[^"]*"', rb"\1", outside[0])
    kept = {found[1]: found[0] for found in cells.finditer(old) if found[1].decode() not in CHANGES}
    assert {found[1]: found[0] for found in cells.finditer(new) if found[1].decode() not in CHANGES} == kept
    # A number in a cell of the format Text is a number all the same.
    after = edited(rich(tmp_path / "book.xlsx").read_bytes(), {"Items": {"C2": 45.5, "C3": None, "U9": 2}})
    page = openpyxl.load_workbook(io.BytesIO(after))["Items"]
    assert (page["C2"].value, page["C2"].data_type, page["C2"].number_format) == (45.5, "n", "@")
    assert (page["C3"].value, page["C3"].fill.fgColor.rgb) == (None, "FFFFEE00")
    assert page["U9"].number_format == "@", "a new cell takes the format of its column"
    assert own_values(after)["C2"] == 45.5


@needs_libreoffice
@pytest.mark.libreoffice
@pytest.mark.slow
def test_libreoffice_reads_it(tmp_path: Path) -> None:
    after = edited(rich(tmp_path / "book.xlsx").read_bytes(), {"Items": CHANGES | {"E5": 7}})
    (tmp_path / "after.xlsx").write_bytes(after)
    found = stored_cells(libreoffice(tmp_path / "after.xlsx", tmp_path / "out.xlsx"))
    assert {cell: found["Items", cell] for cell in CHANGES} == CHANGES
    assert found["Items", "E2"] == pytest.approx(32 / 181)
    assert found["Items", "E5"] == 7


FIVE = '<sheetData><row r="1" spans="2:4"><c r="B1" s="0"/><c r="D1"><v>4</v></c></row></sheetData>'
IN_ORDER: list[tuple[str, dict[str, Any], str]] = [
    ("<sheetData/>", {"B2": 1}, '<sheetData><row r="2"><c r="B2"><v>1</v></c></row></sheetData>'),
    ("<sheetData></sheetData>", {"B2": 1}, '<sheetData><row r="2"><c r="B2"><v>1</v></c></row></sheetData>'),
    ("<sheetData />", {"B2": None}, "<sheetData />"),
    ('<sheetData><row r="2"/><row r="5" ht="20"/></sheetData>', {"A6": 6, "B3": 3, "A3": 2, "C5": 5, "A1": 1},
     '<sheetData><row r="1"><c r="A1"><v>1</v></c></row><row r="2"/>'
     '<row r="3"><c r="A3"><v>2</v></c><c r="B3"><v>3</v></c></row>'
     '<row r="5" ht="20"><c r="C5"><v>5</v></c></row><row r="6"><c r="A6"><v>6</v></c></row></sheetData>'),
    (FIVE, {"A1": 1, "B1": 2, "C1": 3, "E1": 5},
     '<sheetData><row r="1"><c r="A1"><v>1</v></c><c r="B1" s="0"><v>2</v></c><c r="C1"><v>3</v></c>'
     '<c r="D1"><v>4</v></c><c r="E1"><v>5</v></c></row></sheetData>'),
    (FIVE, {"C1": 3}, FIVE.replace('<c r="D1">', '<c r="C1"><v>3</v></c><c r="D1">')),
    # rows and cells without their addresses
    ("<sheetData><row><c><v>1</v></c><c><v>2</v></c></row><row><c><v>3</v></c></row></sheetData>", {"B1": 9, "A2": 8},
     "<sheetData><row><c><v>1</v></c><c><v>9</v></c></row><row><c><v>8</v></c></row></sheetData>"),
    ('<sheetData><row r="2" s="3" customFormat="1"><c r="A2" s="1"/></row></sheetData>', {"B2": 1},
     '<sheetData><row r="2" s="3" customFormat="1"><c r="A2" s="1"/><c r="B2" s="3"><v>1</v></c></row></sheetData>'),
]  # fmt: skip


def test_rows_and_cells_are_put_in_their_order_under_any_prefix_and_within_a_true_extent() -> None:
    for rows, changes, expected in IN_ORDER:
        sheet = parts_of(edited(minimal(rows), {"Items": changes}))[SHEET].decode()
        assert sheet == f'<worksheet xmlns="{MAIN}">{expected}</worksheet>'
    before = minimal(
        '<x:sheetData><x:row r="1"><x:c r="A1" t="b"><x:v>1</x:v></x:c></x:row></x:sheetData>',
        root=f'<x:worksheet xmlns:x="{MAIN}">',
    )
    after = edited(before, {"Items": {"A1": "text", "B1": 2, "A3": True}})
    assert values_of(after) == own_values(after) == {"A1": "text", "B1": 2, "A3": True}
    before = minimal('<sheetData><row r="3"><c r="B3"/></row></sheetData>', head='<dimension ref="B3"/>')
    assert b'<dimension ref="B3"/>' in parts_of(edited(before, {"Items": {"B3": 1}}))[SHEET]
    assert b'<dimension ref="A2:B3"/>' in parts_of(edited(before, {"Items": {"A2": 1}}))[SHEET]


def test_what_only_looks_like_a_cell_and_texts_and_numbers() -> None:
    """Comments, CDATA, attributes and elements elsewhere may hold what looks like a cell."""
    rows = """<sheetData><!-- <row r="1"><c r="A1"><v>9</v></c></row> --><row r='1' note="&lt;c r=&quot;A1&quot;>">
 <c t = "inlineStr" r='A1'><is><t><![CDATA[<c r="B1"><v>5</v></c></row></sheetData>]]></t></is></c >
 <!-- </row> --><c r="C1"><v>3</v></c></row ></sheetData >"""
    tail = '<extLst><ext uri="u"><c r="A1"><v>7</v></c></ext></extLst>'
    before = minimal(rows, tail=tail)
    after = edited(before, {"Items": {"B1": 2, "C1": 4}})
    text = parts_of(after)[SHEET].decode()
    expected = rows.replace('<c r="C1"><v>3</v>', '<c r="B1"><v>2</v></c><c r="C1"><v>4</v>')
    assert text == f'<worksheet xmlns="{MAIN}">{expected}{tail}</worksheet>'
    assert values_of(after)["A1"] == '<c r="B1"><v>5</v></c></row></sheetData>'
    awkward = ["", " padded ", "a\nb\tc", "a\rb", "<&>\"'", "_x0041_", "_x005F_", "é€𝄞", "=1+1", "0123", "]]>"]
    before = minimal("<sheetData/>")
    for text in awkward:
        after = edited(before, {"Items": {"A1": text}})
        assert own_values(after).get("A1", "") == text
        coded = re.sub("_(?=x[0-9A-F]{4}_)", "_x005F_", text)  # which openpyxl leaves as it is
        assert values_of(after).get("A1", "") == coded
    for value in (0, -0.0, 45.0, 0.1, 1 / 3, 1e22, 5e-324, -1.5e300, 2**53 + 1, 10**20):
        after = edited(before, {"Items": {"A1": value}})
        assert own_values(after)["A1"] == values_of(after)["A1"] == float(value)
    after = edited(minimal("<sheetData/>"), {"Items": {"A1": "a\x07b\uffff\ud800"}})
    assert ">a_x0007_b_xFFFF_\ufffd</t>".encode() in parts_of(after)[SHEET]  # a surrogate alone is no character


def test_what_cannot_be_changed_is_refused_by_name() -> None:
    before = minimal("<sheetData/>")
    values: list[Any] = [math.nan, math.inf, -math.inf, 1e308, 10**400, "x" * 32_768]
    for value in values:
        (problem,) = refusals(before, {"Items": {"A1": value, "A2": 3}})
        assert problem.startswith("Items!A1: the ")
    for place in ((0, 0), (-1, 3), (1, -1), (1, 16_384), (1_048_577, 0)):
        with pytest.raises(WorkbookError, match="is no cell of a sheet"):
            open_workbook(before, "book.xlsx").set({"Items": {place: 1}})
    assert refusals(before, {"Itmes": {"A1": 1}}) == {"Itmes: the sheet is missing."}
    assert refusals(minimal(FORMULAS), {"Items": {"B1": 1, "C1": 1, "C2": 1, "D2": 1, "E3": 1}}) == {
        "Items!B1: its formula is shared by other cells. Change this cell in Excel.",
        "Items!C1: it belongs to an array formula. Change this cell in Excel.",
        "Items!C2: it belongs to an array formula. Change this cell in Excel.",
        "Items!D2: it belongs to a data table. Change this cell in Excel.",
        "Items!E3: it belongs to a data table. Change this cell in Excel.",
    }
    assert values_of(edited(minimal(FORMULAS), {"Items": {"B2": 1}}))["B2"] == 1
    signed = zip_bytes(parts_of(minimal("<sheetData/>")) | {"_xmlsignatures/sig1.xml": b"<Signature/>"})
    assert refusals(signed, {"Items": {"A1": 1}}) == {
        "book.xlsx is digitally signed; a change would break the signature. Save it from Excel without the signature."
    }
    for rows, expected in ODD.values():
        (problem,) = refusals(minimal(rows), {"Items": {"A1": 1}})
        assert expected in problem


FORMULAS = (
    '<sheetData><row r="1"><c r="A1"><f>1+1</f><v>2</v></c><c r="B1"><f t="shared" ref="B1:B3" si="0">A1</f><v>2</v></c>'
    '<c r="C1" cm="1"><f t="array" ref="C1:C2">A1:A2</f><v>2</v></c><c r="D1" t="str"><f>"x"</f><v>x</v></c></row>'
    '<row r="2"><c r="A2"><v>2</v></c><c r="B2"><f t="shared" si="0"/><v>2</v></c><c r="C2"><v>2</v></c>'
    '<c r="D2"><f t="dataTable" ref="D2:E3" dt2D="1" r1="A1" r2="A2"/><v>1</v></c><c r="E2"><v>1</v></c></row>'
    '</sheetData>'
)  # fmt: skip


def with_chain(data: bytes, chain: str) -> bytes:
    types = "application/vnd.openxmlformats-officedocument.spreadsheetml.calcChain+xml"
    kind = "http://schemas.openxmlformats.org/officeDocument/2006/relationships/calcChain"
    parts = parts_of(data)
    parts[CHAIN] = f'<calcChain xmlns="{MAIN}">{chain}</calcChain>'.encode()
    for part, end, more in (
        (TYPES, b"</Types>", f'<Override PartName="/{CHAIN}" ContentType="{types}"/>'),
        (RELATIONS, b"</Relationships>", f'<Relationship Id="rId77" Type="{kind}" Target="calcChain.xml"/>'),
    ):
        parts[part] = parts[part].replace(end, more.encode() + end)
    return zip_bytes(parts)


def test_the_calculation_chain_goes_with_a_formula() -> None:
    """Excel makes it anew; with an entry for a cell without a formula it would repair the file."""
    plain = minimal('<sheetData><row r="1"><c r="A1"><f>1+1</f><v>2</v></c></row></sheetData>')
    before = with_chain(plain, '<c r="A1" i="1"/><c r="A1" i="2"/>')
    after = edited(before, {"Items": {"A1": 3}})
    assert changed_parts(before, after) == {SHEET, CHAIN, TYPES, RELATIONS}
    assert {name: parts_of(after)[name] for name in (TYPES, RELATIONS)} == {
        name: parts_of(plain)[name] for name in (TYPES, RELATIONS)
    }
    assert CHAIN not in parts_of(after)
    assert values_of(after) == {"A1": 3}


def test_stored_results_of_formulas() -> None:
    results: dict[str, Any] = {"A1": 0.5, "B1": "a<b", "D1": None, "C1": True}
    before = minimal(FORMULAS)
    items = open_workbook(before, "book.xlsx").sheet("Items")
    assert items.marks.formulas == {*places(dict.fromkeys(["A1", "B1", "C1", "D1", "B2", "D2"]))}
    assert all(items.value(place) not in (None, UNSAVED) for place in items.marks.formulas)
    after = open_workbook(before, "book.xlsx").store({"Items": places(results)}).to_bytes()
    assert (
        parts_of(after)[SHEET]
        .decode()
        .partition("<sheetData")[2]
        .startswith(
            '><row r="1"><c r="A1"><f>1+1</f><v>0.5</v></c>'
            '<c r="B1" t="str"><f t="shared" ref="B1:B3" si="0">A1</f><v>a&lt;b</v></c>'
            '<c r="C1" cm="1" t="b"><f t="array" ref="C1:C2">A1:A2</f><v>1</v></c><c r="D1"><f>"x"</f></c></row>'
        )
    )
    assert open_workbook(after, "book.xlsx").sheet("Items").value((1, 3)) is UNSAVED
    assert open_workbook(after, "book.xlsx").store({"Items": places(results)}).to_bytes() == after
    with pytest.raises(WorkbookError) as caught:
        open_workbook(before, "book.xlsx").store({"Items": places({"A2": 1, "Z9": 1})}).to_bytes()
    assert {str(one) for one in caught.value.problems} == {
        "Items!A2: it holds no formula. Change this cell in Excel.",
        "Items!Z9: it holds no formula. Change this cell in Excel.",
    }


def test_programs_are_asked_to_recalculate() -> None:
    asked = '<calcPr fullCalcOnLoad="1"/>'
    for before, after in (
        ('<calcPr calcId="1" fullCalcOnLoad="1"/>', '<calcPr calcId="1" fullCalcOnLoad="1"/>'),
        ('<calcPr calcId="1" fullCalcOnLoad="0"/>', '<calcPr calcId="1" fullCalcOnLoad="1"/>'),
        ('<calcPr calcId="1" />', '<calcPr calcId="1" fullCalcOnLoad="1"/>'), ("", asked),
        ("<oleSize ref='A1'/>", f"{asked}<oleSize ref='A1'/>"),
    ):  # fmt: skip
        parts = parts_of(minimal("<sheetData/>"))
        text = re.sub("<calcPr[^>]*>", "", parts[BOOK].decode())
        old, new = (text.replace("</sheets>", f"</sheets>{one}").encode() for one in (before, after))
        data = zip_bytes(parts | {BOOK: old})
        assert parts_of(edited(data, {"Items": {"A1": 1}}))[BOOK] == new


ODD: dict[str, tuple[str, str]] = {
    "an element instead of a row": ("<sheetData><x/></sheetData>", "x stands where row is expected"),
    "an alternative": ('<sheetData><row r="1"><AlternateContent/></row></sheetData>', "where c is expected"),
    "another prefix": ('<sheetData><b:row xmlns:b="b" r="1"/></sheetData>', "b:row stands where row is expected"),
    "rows out of order": ('<sheetData><row r="2"/><row r="1"/></sheetData>', "out of order"),
    "a cell of another row": ('<sheetData><row r="1"><c r="A2"/></row></sheetData>', "cell A2 stands in row 1"),
    "cells out of order": ('<sheetData><row r="1"><c r="B1"/><c r="A1"/></row></sheetData>', "cell A1 stands in row 1"),
    "a content that is not known": ('<sheetData><row r="1"><c r="A1"><extLst/></c></row></sheetData>', "extLst"),
    "rows twice": ("<sheetData/><sheetData/>", "twice"),
    "no rows": ("<sheetViews/>", "it holds no rows"),
    "a row that is no number": ('<sheetData><row r="x"/></sheetData>', "damaged"),
    "an array of nothing": (
        '<sheetData><row r="1"><c r="A1"><f t="array">1</f></c></row></sheetData>', "several cells does not say",
    ),
}  # fmt: skip


HOSTILE: dict[str, tuple[Callable[[bytes], bytes], str]] = {
    "entities": (lambda data: b'<!DOCTYPE x [<!ENTITY a "ha">]>' + data, "document type|entities"),
    "a document type": (lambda data: b"<!DOCTYPE x>" + data, "document type"),
    "another encoding": (lambda data: b'<?xml version="1.0" encoding="iso-8859-1"?>' + data, "not written in UTF-8"),
    "UTF-16": (lambda data: data.decode().encode("utf-16"), "not written in UTF-8"),
    "half a part": (lambda data: data[: len(data) // 2], "damaged"),
    "deep": (lambda data: b"<a>" * 5000 + b"</a>" * 5000, "too deep"),
}


def test_hostile_parts() -> None:
    parts = parts_of(with_chain(minimal(FORMULAS), '<c r="A1" i="1"/><c r="D1"/>'))
    for change, expected in HOSTILE.values():
        for part in (SHEET, BOOK, RELATIONS):
            problems = refusals(zip_bytes(parts | {part: change(parts[part])}), {"Items": {"A1": 1}})
            assert re.search(f"{expected}|declares XML entities|damaged", " ".join(problems))
    bomb = io.BytesIO()
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in (parts | {"xl/media/bomb.bin": bytes(80_000_000)}).items():
            archive.writestr(name, data)
    (problem,) = refusals(bomb.getvalue(), {"Items": {"A1": 1}})
    assert "zip bomb" in problem


@given(
    old=st.dictionaries(
        st.tuples(st.integers(1, 12), st.integers(1, 30)), st.one_of(st.integers(-9, 9), st.text("ab <&é", max_size=5))
    ),
    new=st.dictionaries(
        st.tuples(st.integers(1, 14), st.integers(1, 34)),
        st.one_of(
            st.none(),
            st.booleans(),
            st.floats(-1e300, 1e300),
            st.text(st.characters(exclude_categories=["Cs", "Cc"], exclude_characters="\ufffe\uffff"), max_size=20),
        ),
    ),
)
@settings(max_examples=60, deadline=None)
@pytest.mark.slow
def test_any_sheet(old: dict[tuple[int, int], Any], new: dict[tuple[int, int], Any]) -> None:
    packed = io.BytesIO()
    with xlsxwriter.Workbook(packed, {"strings_to_formulas": False}) as book:
        page = book.add_worksheet("Items")
        for (column, row), value in old.items():
            page.write(row - 1, column - 1, value)
    changes = {f"{column_letters(column - 1)}{row}": value for (column, row), value in new.items()}
    before = packed.getvalue()
    after = edited(before, {"Items": changes})
    expected = {cell: value for cell, value in (own_values(before) | changes).items() if value not in (None, "")}
    assert {cell: value for cell, value in own_values(after).items() if value != ""} == expected
    assert edited(after, {"Items": changes}) == after
