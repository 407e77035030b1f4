"""Files that are no workbook, damaged, or made to do harm: each ends in one clear sentence or in the right answer.

Where memory matters the file is read in a process of its own, whose peak is measured.
"""

import contextlib
import io
import random
import re
import struct
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path

import openpyxl
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from assess.errors import WorkbookError
from assess.inventory.workbook import read_inventory
from tests.inventory.books import FLOORS, ITEMS, change_parts, errors_of, problems_of, replace, write, write_shared

SHEETS = {"Items": ITEMS, "Floors": FLOORS}

MOST_MEMORY = 300
"""MB at the peak, 70 of them for Python and its libraries."""

SECONDS = 60

SHEET = "xl/worksheets/sheet1.xml"  # Items
WORKBOOK = "xl/workbook.xml"
RELATIONS = "xl/_rels/workbook.xml.rels"
MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"

_CHILD = """
import sys
import assess
try:
    print(len(assess.read_inventory(sys.argv[1]).items), "items")
except assess.WorkbookError as error:
    print(error)
with open("/proc/self/status") as status:
    print(next(line for line in status if line.startswith("VmHWM")).split()[1])
"""


def read_apart(path: Path) -> str:
    """Read a workbook in a process of its own; return what it says, having checked how much memory it took."""
    command = [sys.executable, "-c", _CHILD, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=False)
    assert done.returncode == 0, done.stderr
    assert not done.stderr
    text, _, peak = done.stdout.rstrip().rpartition("\n")
    assert int(peak) / 1024 < MOST_MEMORY, f"{int(peak) // 1024} MB"
    return text


def add_part(path: Path, name: str, pieces: Iterator[bytes]) -> Path:
    """Write a large part into a workbook's zip piece by piece, in place of the one that is there."""
    with zipfile.ZipFile(path) as archive:
        parts = {one: archive.read(one) for one in archive.namelist() if one != name}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for one, data in parts.items():
            archive.writestr(one, data)
        with archive.open(name, "w", force_zip64=True) as part:
            for piece in pieces:
                part.write(piece)
    return path


def sheet_of(rows: Iterator[bytes], before: bytes = b"", after: bytes = b"") -> Iterator[bytes]:
    """Yield the pieces of a sheet's XML."""
    yield f'<worksheet xmlns="{MAIN}">'.encode() + before + b"<sheetData>"
    yield from rows
    yield b"</sheetData>" + after + b"</worksheet>"


def text_cell(address: str, text: str) -> str:
    return f'<c r="{address}" t="inlineStr"><is><t>{text}</t></is></c>'


HEADER = '<row r="1">{}</row>'.format(
    "".join(text_cell(f"{letter}1", text) for letter, text in zip("ABCD", ITEMS[0], strict=True))
)
FIRST = f'<row r="2">{text_cell("A2", "A1")}{text_cell("B2", "1")}<c r="C2"><v>40</v></c><c r="D2"><v>180</v></c></row>'
TABLE = (HEADER + FIRST).encode()


# ---------------------------------------------------------------- no workbook


def zip_bytes(parts: dict[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, data in parts.items():
            archive.writestr(name, data)
    return buffer.getvalue()


DOCX = zip_bytes({"[Content_Types].xml": b"<Types/>", "word/document.xml": b"<document/>"})
FOREIGN = [
    ("list.csv", b"Item,Floor\nA1,1\n", "list.csv is not an Excel workbook (.xlsx). Save it from Excel as .xlsx."),
    ("page.xlsx", b"<html><table></table></html>", "page.xlsx is not an Excel workbook (.xlsx)."),
    ("empty.xlsx", b"", "empty.xlsx is not an Excel workbook (.xlsx)."),
    ("noise.xlsx", random.Random(1).randbytes(5000), "noise.xlsx is not an Excel workbook (.xlsx)."),
    ("letter.xlsx", DOCX, "letter.xlsx is a zip file, but not an Excel workbook (.xlsx). Save it from Excel as .xlsx."),
    ("old.xls", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(5000),
     "old.xls is an old .xls workbook or is protected by a password. Open it in Excel and save it as .xlsx without a "
     "password."),
    ("cut.xlsx", b"PK\x03\x04" + bytes(100),
     "cut.xlsx is damaged: its zip cannot be read. Open it in Excel and save it again."),
]  # fmt: skip


@pytest.mark.parametrize(("name", "data", "message"), FOREIGN, ids=[name for name, _, _ in FOREIGN])
def test_no_workbook(tmp_path: Path, name: str, data: bytes, message: str) -> None:
    path = tmp_path / name
    path.write_bytes(data)
    (error,) = errors_of(path)
    assert error.startswith(message)


def test_folder(tmp_path: Path) -> None:
    assert errors_of(tmp_path) == {f"{tmp_path} is a folder, not a workbook. Name the .xlsx file in it."}


def test_missing(tmp_path: Path) -> None:
    path = tmp_path / "gone.xlsx"
    assert errors_of(path) == {f"{path} is not there. Check the name and the folder."}


@pytest.mark.parametrize("name", ["n" * 5000, "zero\0.xlsx"])
def test_names_that_no_file_can_have(name: str) -> None:
    (error,) = errors_of(Path(name))
    assert "cannot be opened" in error or "is not there" in error


def test_too_large(tmp_path: Path) -> None:
    path = tmp_path / "large.xlsx"
    with path.open("wb") as file:
        file.write(b"PK\x03\x04")
        file.truncate(101 * 2**20)  # a hole, which takes no space on the disk
    assert errors_of(path) == {"large.xlsx is larger than 100 MB. Remove pictures and unused sheets."}


@pytest.mark.parametrize("share", [0.2, 0.5, 0.9, 0.99])
def test_truncated(tmp_path: Path, share: float) -> None:
    path = write(tmp_path)
    path.write_bytes(path.read_bytes()[: int(share * path.stat().st_size)])
    assert errors_of(path) == {"book.xlsx is damaged: its zip cannot be read. Open it in Excel and save it again."}


def test_password_of_the_zip(tmp_path: Path) -> None:
    path = write(tmp_path)
    data = bytearray(path.read_bytes())
    place = data.index(b"PK\x01\x02")
    data[place + 8] |= 1
    path.write_bytes(data)
    assert errors_of(path) == {"book.xlsx is protected by a password. Save it without a password."}


def test_strict_open_xml(tmp_path: Path) -> None:
    strict = replace(MAIN, "http://purl.oclc.org/ooxml/spreadsheetml/main")
    path = change_parts(write(tmp_path), {WORKBOOK: strict, SHEET: strict})
    assert errors_of(path) == {
        "the workbook is saved as Strict Open XML. In Excel: Save As, Excel Workbook (.xlsx), without Strict."
    }


def test_any_ending_will_do(tmp_path: Path) -> None:
    path = write(tmp_path).rename(tmp_path / "book.bak")
    assert len(read_inventory(path).items) == 1


def test_workbook_with_macros(tmp_path: Path) -> None:
    path = change_parts(
        write(tmp_path),
        {
            "[Content_Types].xml": replace(
                "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml",
                "application/vnd.ms-excel.sheet.macroEnabled.main+xml",
            ),
            "xl/vbaProject.bin": b"\xd0\xcf\x11\xe0 never run",
        },
    ).rename(tmp_path / "book.xlsm")
    assert len(read_inventory(path).items) == 1


# ---------------------------------------------------------------- the zip


def test_zip_bomb(tmp_path: Path) -> None:
    blanks = (b" " * 2**20 for _ in range(520))
    path = add_part(write(tmp_path), SHEET, sheet_of(blanks))
    assert path.stat().st_size < 3 * 2**20
    assert read_apart(path) == (
        "book.xlsx unpacks to far more than a furniture list needs, as a zip bomb does; it was not opened. "
        "Copy the tables into a new workbook made with `assess new`."
    )


@pytest.mark.parametrize("part", ["xl/sharedStrings.xml", "xl/styles.xml", WORKBOOK, "xl/media/photo.png"])
def test_bomb_in_another_part(tmp_path: Path, part: str) -> None:
    path = add_part(write(tmp_path), part, (b" " * 2**20 for _ in range(300)))
    assert "as a zip bomb does" in read_apart(path)


def test_too_many_parts(tmp_path: Path) -> None:
    path = change_parts(write(tmp_path), {f"xl/{number}.xml": b"" for number in range(2001)})
    assert "as a zip bomb does" in next(iter(errors_of(path)))


def test_two_parts_of_one_name(tmp_path: Path) -> None:
    path = write(tmp_path)
    with zipfile.ZipFile(path, "a") as archive, pytest.warns(UserWarning, match="Duplicate name"):
        archive.writestr(SHEET, "<worksheet/>")
    assert errors_of(path) == {
        "the workbook is damaged: its zip holds two parts of one name. Open it in Excel and save it again."
    }


def test_unusual_compression(tmp_path: Path) -> None:
    path = write(tmp_path)
    with zipfile.ZipFile(path, "a", zipfile.ZIP_LZMA) as archive:
        archive.writestr("xl/more.xml", "<more/>")
    assert errors_of(path) == {
        "the workbook is damaged: its zip is packed in a way that Excel does not use. "
        "Open it in Excel and save it again."
    }


@pytest.mark.parametrize("size", [0, 10, 100_000_000])
def test_a_size_that_lies(tmp_path: Path, size: int) -> None:
    path = write(tmp_path)
    with zipfile.ZipFile(path) as archive:
        place = [one.filename for one in archive.infolist()].index(SHEET)
    data, at = bytearray(path.read_bytes()), -1
    for _ in range(place + 1):
        at = data.index(b"PK\x01\x02", at + 1)
    data[at + 24 : at + 28] = struct.pack("<I", size)
    path.write_bytes(data)
    (error,) = errors_of(path)
    assert error.startswith("book.xlsx ")


# ---------------------------------------------------------------- XML

LAUGHS = "<!DOCTYPE x [" + '<!ENTITY a0 "ha">' + "".join(
    f'<!ENTITY a{n} "{f"&a{n - 1};" * 10}">' for n in range(1, 10)
) + "]>"  # fmt: skip
OUTSIDE = '<!DOCTYPE x [<!ENTITY a9 SYSTEM "file:///etc/hostname">]>'
ENTITIES = {"laughs": LAUGHS, "outside": OUTSIDE}
STRINGS = "xl/sharedStrings.xml"


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
        r"(book.xlsx is damaged or is no Excel workbook \(\w+\)|the workbook is damaged: .* breaks off)\. "
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
    (error, *_) = errors_of(tmp_path / "book.xlsx")
    assert "is damaged" in error or "Items" in error


# ---------------------------------------------------------------- sheets that lie


def test_dimension_that_lies(tmp_path: Path) -> None:
    items = [ITEMS[0], *([f"A{n}", "1", 40, 180] for n in range(5))]
    path = write(tmp_path, items)
    change_parts(path, {SHEET: replace('<dimension ref="A1:D6"', '<dimension ref="A1"')})
    assert len(read_inventory(path).items) == 5


@pytest.mark.parametrize(
    ("cell", "message"),
    [
        ("XFD1048576", "Items!A1048576: holds a value far below the table; at most 100,000 rows are read. "
                       "Delete the rows below the table."),
        ("A200000", "Items!A200000: holds a value far below the table; at most 100,000 rows are read. "
                    "Delete the rows below the table."),
        ("XFD3", "Items!XFD3: holds a value far right of the table; 256 columns are read. "
                 "Delete the columns right of the table."),
        ("IW1", "Items!IW1: holds a value far right of the table; 256 columns are read. "
                "Delete the columns right of the table."),
    ],
)  # fmt: skip
def test_far_values(tmp_path: Path, cell: str, message: str) -> None:
    path = write(tmp_path)
    book = openpyxl.load_workbook(path)
    book["Items"][cell] = "far"
    book.save(path)
    assert read_apart(path) == message


@pytest.mark.parametrize("blank", ['<row r="{}" s="1" customFormat="1"/>', '<row r="{}"><c r="A{}" s="0"/></row>'])
def test_a_million_styled_blank_rows(tmp_path: Path, blank: str) -> None:
    rows = (
        "".join(blank.format(number, number) for number in range(first, first + 1000)).encode()
        for first in range(3, 1_000_000, 1000)
    )

    def all_rows() -> Iterator[bytes]:
        yield TABLE
        yield from rows

    assert read_apart(add_part(write(tmp_path), SHEET, sheet_of(all_rows()))) == "1 items"


def test_every_column_styled(tmp_path: Path) -> None:
    letters = [openpyxl.utils.get_column_letter(at) for at in range(5, 16385)]
    rows = HEADER.encode()
    for number in range(2, 40):
        own = FIRST.replace(">A1<", f">P{number}<").replace('2"', f'{number}"')
        blank = "".join(f'<c r="{letter}{number}" s="0"/>' for letter in letters)
        rows += own.replace("</row>", blank + "</row>").encode()
    path = add_part(write(tmp_path), SHEET, sheet_of(iter([rows])))
    assert read_apart(path) == "38 items"


@pytest.mark.parametrize("cell", ["<c><v>1</v></c>", '<c t="inlineStr"><is><t>x</t></is></c>'])
def test_every_column_filled_without_addresses(tmp_path: Path, cell: str) -> None:
    rows = TABLE + b"<row>" + cell.encode() * 300 + b"</row>"
    text = read_apart(add_part(write(tmp_path), SHEET, sheet_of(iter([rows]))))
    assert text == (
        "Items!column 257 of row 3: holds a value far right of the table; 256 columns are read. "
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


# ---------------------------------------------------------------- slow patterns and large tables


def many(piece: bytes, total: int) -> bytes:
    return piece * (total // len(piece))


SLOW: dict[str, Callable[[], bytes]] = {
    "attributes": lambda: b"<row " + many(b' r="A1"', 1_900_000),
    "cells": lambda: b'<row r="3">' + many(b"<c r='A1' ", 1_900_000),
    "formulas": lambda: b'<row r="3">' + many(b'<c r="A1"><f>', 1_900_000),
    "blanks": lambda: b'<row r="3"><c r="A3">' + many(b" ", 1_900_000) + b"<f>",
    "rows": lambda: many(b"<row", 1_900_000),
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
    "strings": (STRINGS, f'<sst xmlns="{MAIN}">', "<si><t>ab</t></si>", 490_000, "</sst>"),
    "blank strings": (STRINGS, f'<sst xmlns="{MAIN}">', "<si/>", 1_900_000, "</sst>"),
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
    assert "as a zip bomb does" in read_apart(path)


def test_a_tail_of_merged_cells(tmp_path: Path) -> None:
    def pieces() -> Iterator[bytes]:
        yield from sheet_of(iter([TABLE]))

    merged = (
        b"<mergeCells>" + b"".join(b'<mergeCell ref="A%d:B%d"/>' % (n, n) for n in range(1, 300_000)) + b"</mergeCells>"
    )
    path = add_part(write(tmp_path), SHEET, sheet_of(iter([TABLE]), after=merged))
    assert "cells are merged inside the table" in read_apart(path)


# ---------------------------------------------------------------- damaged at random


def sound() -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        items = [[*ITEMS[0], "Notes"], ["A1", "1", 40, 180, "=1+1"], ["A2", "1", 30, "x", "é"]]
        return write_shared(Path(folder) / "book.xlsx", {"Items": items, "Floors": FLOORS}).read_bytes()


SOUND = sound()
with zipfile.ZipFile(io.BytesIO(SOUND)) as _archive:
    PARTS = {name: _archive.read(name) for name in _archive.namelist()}
QUICK = settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
CHANGES = st.lists(
    st.tuples(st.sampled_from(["flip", "cut", "insert", "drop"]), st.floats(0, 1), st.binary(min_size=1, max_size=6)),
    min_size=1,
    max_size=4,
)


def damage(data: bytes, changes: list[tuple[str, float, bytes]]) -> bytes:
    for what, share, new in changes:
        at = int(share * len(data))
        data = {
            "flip": data[:at] + new + data[at + len(new) :],
            "cut": data[:at],
            "insert": data[:at] + new + data[at:],
            "drop": data[:at] + data[at + len(new) :],
        }[what]
    return data


def read_or_refuse(path: Path) -> None:
    with contextlib.suppress(WorkbookError):
        read_inventory(path)


@QUICK
@given(CHANGES)
def test_damaged_file(tmp_path: Path, changes: list[tuple[str, float, bytes]]) -> None:
    path = tmp_path / "book.xlsx"
    path.write_bytes(damage(SOUND, changes))
    read_or_refuse(path)


@QUICK
@given(st.sampled_from(sorted(PARTS)), CHANGES)
@example(WORKBOOK, [("flip", 0.0, b'<?xml version="1.0" encoding="no-such"?>')])
def test_damaged_part(tmp_path: Path, part: str, changes: list[tuple[str, float, bytes]]) -> None:
    """Damage inside the zip, with sums that are right: it reaches the XML parser, and openpyxl."""
    path = tmp_path / "book.xlsx"
    path.write_bytes(zip_bytes({**PARTS, part: damage(PARTS[part], changes)}))
    read_or_refuse(path)


WORDS = st.sampled_from(
    [
        "s",
        "n",
        "str",
        "e",
        "b",
        "d",
        "inlineStr",
        "-1",
        "1e999",
        "nan",
        "99999999999",
        "",
        "A0",
        "zz",
        "../x",
        "#REF!",
        "true",
    ]
)


@QUICK
@given(st.sampled_from([SHEET, STRINGS, WORKBOOK, RELATIONS, "xl/styles.xml", "[Content_Types].xml"]), st.data())
def test_attributes_exchanged(tmp_path: Path, part: str, data: st.DataObject) -> None:
    """Sound XML with values that openpyxl does not expect."""
    pieces = PARTS[part].decode().split('"')
    if len(pieces) < 3:
        return
    at = data.draw(st.integers(0, (len(pieces) - 3) // 2)) * 2 + 1
    pieces[at] = data.draw(WORDS)
    path = tmp_path / "book.xlsx"
    path.write_bytes(zip_bytes({**PARTS, part: '"'.join(pieces).encode()}))
    read_or_refuse(path)


def test_every_problem_can_be_printed(tmp_path: Path) -> None:
    path = write(tmp_path, [["Item\x07".replace("\x07", ""), "Floor"], ["A" * 30_000, "\u202e1"]])
    for problem in problems_of(path):
        assert len(str(problem)) < 400
