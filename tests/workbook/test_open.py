"""Files that are no workbook, and zips made to do harm: each ends in one clear sentence."""

import random
import struct
import zipfile
from pathlib import Path

import pytest

from assess.workbook.read import read_inventory
from tests.workbook.books import change_parts, errors_of, replace, write
from tests.workbook.raw import MAIN, SHEET, WORKBOOK, add_part, read_apart, sheet_of, zip_bytes

DOCX = zip_bytes({"[Content_Types].xml": b"<Types/>", "word/document.xml": b"<document/>"})
FOREIGN = [
    ("list.csv", b"Item,Floor\nA1,1\n", "list.csv is not an Excel workbook (.xlsx). Save it from Excel as .xlsx."),
    ("page.xlsx", b"<html><table></table></html>", "page.xlsx is not an Excel workbook (.xlsx)."),
    ("empty.xlsx", b"", "empty.xlsx is empty (0 bytes). Download or copy it again."),
    ("noise.xlsx", random.Random(1).randbytes(5000), "noise.xlsx is not an Excel workbook (.xlsx)."),
    ("letter.xlsx", DOCX, "letter.xlsx is a zip file, but not an Excel workbook (.xlsx). Save it from Excel as .xlsx."),
    ("old.xls", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(5000),
     "old.xls is an old .xls workbook or is protected by a password. Open it in Excel and save it as .xlsx without a "
     "password."),
    ("cut.xlsx", b"PK\x03\x04" + bytes(100),
     "cut.xlsx is damaged: its zip cannot be read. Open it in Excel and save it again."),
]  # fmt: skip


def test_no_workbook_and_workbooks_that_are_too_large_cut_off_protected_or_strict(tmp_path: Path) -> None:
    for name, data, message in FOREIGN:
        (tmp_path / name).write_bytes(data)
        (error,) = errors_of(tmp_path / name)
        assert error.startswith(message)
    gone = tmp_path / "gone.xlsx"
    assert errors_of(gone) == {f"{gone} does not exist. Check the name and the folder."}
    assert errors_of(tmp_path) == {f"{tmp_path} is a folder, not a workbook. Name the .xlsx file in it."}
    for name in ("n" * 5000, "zero\0.xlsx"):
        (error,) = errors_of(Path(name))
        assert "cannot be opened" in error or "does not exist" in error
    path = tmp_path / "large.xlsx"
    with path.open("wb") as file:
        file.write(b"PK\x03\x04")
        file.truncate(101 * 2**20)  # a hole, which takes no space on the disk
    assert errors_of(path) == {"large.xlsx is larger than 100 MB. Remove pictures and unused sheets."}
    path = write(tmp_path)
    whole = path.read_bytes()
    for share in (0.2, 0.9, 0.99):
        path.write_bytes(whole[: int(share * len(whole))])
        assert errors_of(path) == {"book.xlsx is damaged: its zip cannot be read. Open it in Excel and save it again."}
    path = write(tmp_path)
    coded = bytearray(path.read_bytes())
    place = coded.index(b"PK\x01\x02")
    coded[place + 8] |= 1
    path.write_bytes(coded)
    assert errors_of(path) == {"book.xlsx is protected by a password. Save it without a password."}
    strict = replace(MAIN, "http://purl.oclc.org/ooxml/spreadsheetml/main")
    path = change_parts(write(tmp_path), {WORKBOOK: strict, SHEET: strict})
    assert errors_of(path) == {
        "the workbook is saved as Strict Open XML. In Excel: Save As, Excel Workbook (.xlsx), without Strict."
    }


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


@pytest.mark.slow
def test_zip_bomb(tmp_path: Path) -> None:
    for at, part in enumerate([SHEET, "xl/sharedStrings.xml", "xl/styles.xml", WORKBOOK, "xl/media/photo.png"]):
        blanks = (b" " * 2**20 for _ in range(520 if part == SHEET else 300))
        path = add_part(write(tmp_path), part, sheet_of(blanks) if part == SHEET else blanks)
        assert path.stat().st_size < 3 * 2**20
        path.rename(tmp_path / f"{at}.xlsx")
    assert read_apart(tmp_path) == {
        str(at): f"{at}.xlsx unpacks to far more than a furniture list needs, as a zip bomb does; it was not opened. "
        "Copy the tables into a new workbook made with `assess new`."
        for at in range(5)
    }


def test_zips_of_too_many_parts_with_two_of_one_name_unusually_packed_or_of_a_size_that_lies(tmp_path: Path) -> None:
    path = change_parts(write(tmp_path), {f"xl/{number}.xml": b"" for number in range(2001)})
    assert "as a zip bomb does" in next(iter(errors_of(path)))
    path = write(tmp_path)
    with zipfile.ZipFile(path, "a") as archive, pytest.warns(UserWarning, match="Duplicate name"):
        archive.writestr(SHEET, "<worksheet/>")
    assert errors_of(path) == {
        "the workbook is damaged: its zip holds two parts of one name. Open it in Excel and save it again."
    }
    path = write(tmp_path)
    with zipfile.ZipFile(path, "a", zipfile.ZIP_LZMA) as archive:
        archive.writestr("xl/more.xml", "<more/>")
    assert errors_of(path) == {
        "the workbook is damaged: its zip uses a compression that Excel does not use. "
        "Open it in Excel and save it again."
    }
    path = write(tmp_path)
    with zipfile.ZipFile(path) as archive:
        place = [one.filename for one in archive.infolist()].index(SHEET)
    data, at = bytearray(path.read_bytes()), -1
    for _ in range(place + 1):
        at = data.index(b"PK\x01\x02", at + 1)
    for size in (0, 10, 100_000_000):
        data[at + 24 : at + 28] = struct.pack("<I", size)
        path.write_bytes(data)
        (error,) = errors_of(path)
        assert error.startswith("book.xlsx ")
