"""XML made to do harm, sheets that lie, parts that are too large: one clear sentence, or the right answer."""

import random
import re
import zipfile
from collections.abc import Callable, Iterator
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
)

LAUGHS = "<!DOCTYPE x [" + '<!ENTITY a0 "ha">' + "".join(
    f'<!ENTITY a{n} "{f"&a{n - 1};" * 10}">' for n in range(1, 10)
) + "]>"  # fmt: skip
OUTSIDE = '<!DOCTYPE x [<!ENTITY a9 SYSTEM "file:///etc/hostname">]>'
ENTITIES = {"laughs": LAUGHS, "outside": OUTSIDE}


@pytest.mark.parametrize("entities", ENTITIES.values(), ids=ENTITIES)
@pytest.mark.parametrize("part", [SHEET, STRINGS, WORKBOOK, RELATIONS, "xl/styles.xml", "[Content_Types].xml"])
def test_entities(tmp_path: Path, part: str, entities: str) -> None:
    path = write_shared(tmp_path / "book.xlsx", SHEETS)
    change_parts(path, {part: lambda data: entities.encode() + data.split(b"?>")[-1]})
    assert read_apart(path) == "book.xlsx declares XML entities, as an attack does. Save it again from Excel."


@pytest.mark.parametrize("part", [SHEET, STRINGS, WORKBOOK, RELATIONS, "xl/styles.xml", "[Content_Types].xml"])
def test_damaged_xml(tmp_path: Path, part: str) -> None:
    path = write_shared(tmp_path / "book.xlsx", SHEETS)
    change_parts(path, {part: lambda data: data[: len(data) // 2]})
    (error,) = errors_of(path)
    assert re.fullmatch(
        r"(book.xlsx is damaged or is no Excel workbook: its XML is broken|the workbook is damaged: .* breaks off)\. "
        r"Open it in Excel and save it again\.",
        error,
    )


def test_deep_xml(tmp_path: Path) -> None:
    path = change_parts(write(tmp_path), {"xl/styles.xml": b"<a>" * 100_000 + b"</a>" * 100_000})
    text = read_apart(path)
    assert text == "1 items" or "is damaged" in text


@pytest.mark.parametrize("target", ["../../x.xml", "http://127.0.0.1:9/sheet.xml", "file:///etc/passwd", "//h/s.xml"])
@pytest.mark.parametrize("mode", ["", ' TargetMode="External"'])
def test_relations_that_lead_outside(tmp_path: Path, target: str, mode: str) -> None:
    change = replace('Target="/xl/worksheets/sheet1.xml"', f'Target="{target}"{mode}')
    path = change_parts(write(tmp_path), {RELATIONS: change})
    (error,) = errors_of(path)
    assert "Items: the sheet is missing." in error or "is damaged" in error


@pytest.mark.parametrize("target", ["worksheets/sheet1.xml", "../xl/worksheets/sheet1.xml", "./worksheets/sheet1.xml"])
def test_relations_of_every_spelling(tmp_path: Path, target: str) -> None:
    path = change_parts(write(tmp_path), {RELATIONS: replace("/xl/worksheets/sheet1.xml", target)})
    assert len(read_inventory(path).items) == 1


def test_sheet_that_is_a_chart(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    book.create_chartsheet("Items")
    book.save(tmp_path / "book.xlsx")
    missing = "the sheet is missing. Add it, or start from a workbook made with `assess new`."
    assert errors_of(tmp_path / "book.xlsx") == {f"Items: {missing}", f"Floors: {missing}"}


def test_dimension_that_lies(tmp_path: Path) -> None:
    items = [ITEMS[0], *([f"A{n}", "1", 40, 180] for n in range(5))]
    path = write(tmp_path, items)
    change_parts(path, {SHEET: replace('<dimension ref="A1:D6"', '<dimension ref="A1"')})
    assert len(read_inventory(path).items) == 5


@pytest.mark.parametrize(
    ("cell", "message"),
    [
        ("XFD1048576", "Items!A1048576: a value far below the table; at most 100,000 rows are read. "
                       "Delete the rows below the table."),
        ("A200000", "Items!A200000: a value far below the table; at most 100,000 rows are read. "
                    "Delete the rows below the table."),
        ("XFD3", "Items!XFD3: a value far to the right of the table; at most 256 columns are read. "
                 "Delete the columns right of the table."),
        ("IW1", "Items!IW1: a value far to the right of the table; at most 256 columns are read. "
                "Delete the columns right of the table."),
    ],
)  # fmt: skip
def test_far_values(tmp_path: Path, cell: str, message: str) -> None:
    path = write(tmp_path)
    book = openpyxl.load_workbook(path)
    book["Items"][cell] = "far"
    book.save(path)
    assert read_apart(path) == message


@pytest.mark.parametrize(
    ("blank", "dimension"),
    [
        ('<row r="{}" s="1" customFormat="1"/>', b""),
        ('<row r="{}"><c r="A{}" s="0"/></row>', b'<dimension ref="A1:D1000000"/>'),
    ],
)
def test_a_million_styled_blank_rows(tmp_path: Path, blank: str, dimension: bytes) -> None:
    rows = (
        "".join(blank.format(number, number) for number in range(first, first + 1000)).encode()
        for first in range(3, 1_000_000, 1000)
    )

    def all_rows() -> Iterator[bytes]:
        yield TABLE
        yield from rows

    assert read_apart(add_part(write(tmp_path), SHEET, sheet_of(all_rows(), before=dimension))) == "1 items"


def test_every_column_styled(tmp_path: Path) -> None:
    letters = [openpyxl.utils.get_column_letter(at) for at in range(5, 16385)]
    rows = HEADER.encode()
    for number in range(2, 10):
        own = FIRST.replace(">A1<", f">P{number}<").replace('2"', f'{number}"')
        blank = "".join(f'<c r="{letter}{number}" s="0"/>' for letter in letters)
        rows += own.replace("</row>", blank + "</row>").encode()
    path = add_part(write(tmp_path), SHEET, sheet_of(iter([rows])))
    assert read_apart(path) == "8 items"


@pytest.mark.parametrize("cell", ["<c><v>1</v></c>", '<c t="inlineStr"><is><t>x</t></is></c>'])
def test_every_column_filled_without_addresses(tmp_path: Path, cell: str) -> None:
    rows = TABLE + b"<row>" + cell.encode() * 300 + b"</row>"
    text = read_apart(add_part(write(tmp_path), SHEET, sheet_of(iter([rows]))))
    assert text == (
        "Items column 257 of row 3: a value far to the right of the table; at most 256 columns are read. "
        "Delete the columns right of the table."
    )


def test_row_with_a_million_cells(tmp_path: Path) -> None:
    row = b"<row>" + b"<c/>" * 40_000 + b"</row>"
    text = read_apart(add_part(write(tmp_path), SHEET, sheet_of(iter([TABLE, row]))))
    assert text == (
        f"the workbook is damaged: row 3 of {SHEET} has more cells than a sheet has columns. "
        "Open it in Excel and save it again."
    )


def test_row_of_many_megabytes(tmp_path: Path) -> None:
    noise = random.Random(2).randbytes(4 * 2**20).hex().encode()
    row = b'<row r="3"><c r="D3" t="inlineStr"><is><t>' + noise + b"</t></is></c></row>"
    text = read_apart(add_part(write(tmp_path), SHEET, sheet_of(iter([TABLE, row]))))
    assert text == f"{SHEET} holds a row of over 2 MB. Delete that row."


ORDER = [(2, 5, 3), (2, 2), (0,), (9_999_999,)]


@pytest.mark.parametrize("numbers", ORDER)
def test_rows_out_of_order(tmp_path: Path, numbers: tuple[int, ...]) -> None:
    """Openpyxl's quick reader leaves such rows out without a word."""
    rows = [f'<row r="{n}"><c r="A{n}" t="inlineStr"><is><t>A{n}</t></is></c></row>' for n in numbers]
    path = add_part(write(tmp_path), SHEET, sheet_of(iter([HEADER.encode(), "".join(rows).encode()])))
    assert errors_of(path) == {
        f"the workbook is damaged: the rows of {SHEET} are out of order. Open it in Excel and save it again."
    }


@pytest.mark.parametrize("number", ["x", "-3", "1e3", "99999999", ""])
def test_row_numbers_that_are_none(tmp_path: Path, number: str) -> None:
    row = f'<row r="{number}"><c t="inlineStr"><is><t>A2</t></is></c></row>'.encode()
    path = add_part(write(tmp_path), SHEET, sheet_of(iter([TABLE, row])))
    assert errors_of(path) == {
        f"the workbook is damaged: {SHEET} has a row numbered {number}. Open it in Excel and save it again."
    }


def test_sheet_in_another_encoding(tmp_path: Path) -> None:
    path = change_parts(write(tmp_path), {SHEET: lambda data: data.decode().encode("utf-16")})
    assert errors_of(path) == {
        f"the workbook is damaged: {SHEET} is not written in UTF-8. Open it in Excel and save it again."
    }


def test_one_sheet_under_two_names(tmp_path: Path) -> None:
    """The workbook that openpyxl reads is not the one at the usual place."""
    path = write(tmp_path)
    with zipfile.ZipFile(path) as archive:
        other = archive.read(WORKBOOK).replace(b'r:id="rId1"', b'r:id="rId9"').replace(b'r:id="rId2"', b'r:id="rId1"')
    other = other.replace(b'r:id="rId9"', b'r:id="rId2"')
    types = replace('PartName="/xl/workbook.xml"', 'PartName="/xl/other.xml"')
    with zipfile.ZipFile(path) as archive:
        links = archive.read(RELATIONS)
    change_parts(path, {"xl/other.xml": other, "xl/_rels/other.xml.rels": links, "[Content_Types].xml": types})
    assert errors_of(path) == {
        "the workbook is damaged: xl/other.xml stands for xl/workbook.xml. Open it in Excel and save it again."
    }


def many(piece: bytes, total: int) -> bytes:
    return piece * (total // len(piece))


SLOW: dict[str, Callable[[], bytes]] = {
    "attributes": lambda: b"<row " + many(b' r="A1"', 1_900_000),
    "cells": lambda: b'<row r="3">' + many(b"<c r='A1' ", 1_900_000),
    "formulas": lambda: b'<row r="3">' + many(b'<c r="A1"><f>', 1_900_000),
    "blanks": lambda: b'<row r="3"><c r="A3">' + many(b" ", 1_900_000) + b"<f>",
    "rows": lambda: many(b"<row", 1_900_000),
    "a long tag": lambda: b'<row r="' + many(b"1", 40_000_000),
    "a deep tree": lambda: many(b"<a>", 40_000_000),
}


@pytest.mark.parametrize("name", SLOW)
def test_bytes_made_to_be_slow(tmp_path: Path, name: str) -> None:
    path = write(tmp_path)
    with zipfile.ZipFile(path) as archive:
        parts = {one: archive.read(one) for one in archive.namelist()}
    parts[SHEET] = b"".join(sheet_of(iter([TABLE, SLOW[name]()])))
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:
        for one, data in parts.items():
            archive.writestr(one, data)
    assert read_apart(path)


def xml(start: str, piece: str, count: int, end: str) -> bytes:
    """Return pieces that are all alike, and so much noise that the zip does not look like a bomb."""
    noise = random.Random(3).randbytes(60_000).hex()
    return f"{start}<!--{noise}-->{piece * count}{end}".encode()


STYLES, TYPES = "xl/styles.xml", "[Content_Types].xml"
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


@pytest.mark.parametrize("name", LARGE)
def test_large_parts(tmp_path: Path, name: str) -> None:
    """Just below the limits: the memory stays within bounds."""
    part, start, piece, count, end = LARGE[name]
    path = change_parts(write_shared(tmp_path / "book.xlsx", SHEETS), {part: xml(start, piece, count, end)})
    assert "as a zip bomb does" not in read_apart(path)


@pytest.mark.parametrize("name", LARGE)
def test_larger_parts(tmp_path: Path, name: str) -> None:
    """Above the limits: refused."""
    part, start, piece, count, end = LARGE[name]
    path = change_parts(write_shared(tmp_path / "book.xlsx", SHEETS), {part: xml(start, piece, 2 * count, end)})
    assert "as a zip bomb does" in next(iter(errors_of(path)))


def test_a_tail_of_merged_cells(tmp_path: Path) -> None:
    def pieces() -> Iterator[bytes]:
        yield from sheet_of(iter([TABLE]))

    merged = (
        b"<mergeCells>" + b"".join(b'<mergeCell ref="A%d:B%d"/>' % (n, n) for n in range(1, 300_000)) + b"</mergeCells>"
    )
    path = add_part(write(tmp_path), SHEET, sheet_of(iter([TABLE]), after=merged))
    assert "cells are merged inside the table" in read_apart(path)
