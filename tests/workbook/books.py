"""Workbooks for the tests of reading: real files, made sheet by sheet, and changed byte by byte."""

import zipfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import openpyxl
import pytest
import xlsxwriter

from assess.errors import Problem, WorkbookError
from assess.model import Inventory, Item
from assess.workbook.read import read_inventory
from tests.motion.writers import zipped
from tests.workbooks import parts_of

Sheet = Sequence[Sequence[Any]]

FLOORS: Sheet = [["Floor", "PFA X [g]"], ["1", 0.5]]
ITEMS: Sheet = [["Item", "Floor", "Breadth [cm]", "Height [cm]"], ["A1", "1", 40, 180]]


def write_book(path: Path, sheets: Mapping[str, Sheet]) -> Path:
    book = openpyxl.Workbook()
    book.remove(book.worksheets[0])
    for name, rows in sheets.items():
        page = book.create_sheet(name)
        for row in rows:
            page.append(list(row))
    book.save(path)
    return path


def write_shared(path: Path, sheets: Mapping[str, Sheet], **options: Any) -> Path:
    """Write these sheets with XlsxWriter, which keeps texts in a part of their own, as Excel does."""
    with xlsxwriter.Workbook(path, options) as book:
        for name, rows in sheets.items():
            page = book.add_worksheet(name)
            for number, row in enumerate(rows):
                for at, value in enumerate(row):
                    if value is not None:
                        page.write(number, at, value)
    return path


def write(folder: Path, items: Sheet = ITEMS, floors: Sheet = FLOORS, **others: Sheet) -> Path:
    """Write a workbook with Items and Floors, sound where they are not given."""
    return write_book(folder / "book.xlsx", {"Items": items, "Floors": floors, **others})


def read(folder: Path, items: Sheet = ITEMS, floors: Sheet = FLOORS, **others: Sheet) -> Inventory:
    return read_inventory(write(folder, items, floors, **others))


def problems_of(path: Path) -> list[Problem]:
    with pytest.raises(WorkbookError) as caught:
        read_inventory(path)
    return list(caught.value.problems)


def errors_of(path: Path) -> set[str]:
    """Return the errors of a faulty workbook, in words."""
    return {str(problem) for problem in problems_of(path) if problem.severity == "error"}


def remarks(inventory: Inventory, severity: str) -> set[str]:
    """Return the warnings, or the notes, of a sound workbook, in words."""
    return {str(problem) for problem in inventory.problems if problem.severity == severity}


def read_part(path: Path, part: str) -> str:
    with zipfile.ZipFile(path) as archive:
        return archive.read(part).decode()


def change_parts(path: Path, changes: Mapping[str, Callable[[bytes], bytes] | bytes]) -> Path:
    """Change or add parts of a workbook's zip, in place."""
    parts = parts_of(path)
    for name, change in changes.items():
        parts[name] = change if isinstance(change, bytes) else change(parts[name])
    path.write_bytes(zipped(parts))
    return path


def replace(old: str, new: str) -> Callable[[bytes], bytes]:
    """Return a change of one text, which must be there, into another."""

    def change(data: bytes) -> bytes:
        assert old.encode() in data, f"{old} is not there"
        return data.replace(old.encode(), new.encode())

    return change


def read_item(folder: Path, header: list[str], row: list[Any], **others: Sheet) -> Item:
    """Return the one item of a workbook with these columns beside Item and Floor."""
    return read(folder, [["Item", "Floor", *header], ["A1", "1", *row]], **others).items[0]
