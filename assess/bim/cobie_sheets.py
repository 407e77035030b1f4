"""The sheets of a COBie file as rows of plain values: columns found by name, n/a and template rows left out.

Reference: COBie 2.4, the spreadsheet of the National BIM Standard - United States, Version 3, section 4.2 and Annex A.
Files differ from it: sheets and columns in other letter case, numbers stored as texts, a coloured row above the header,
a second row that says "required" and "lookup", the header repeated as a first row.
"""

import io
import re
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from assess.errors import Problem, WorkbookError
from assess.i18n import fill
from assess.progress import SILENT, Progress
from assess.workbook.names import find_sheet, is_cobie_list, plain
from assess.workbook.open import DAMAGE, HEADER_ROWS, MAX_ROWS, UNSAVED, WORKBOOK, Book, Cells, read_file, unreadable
from assess.workbook.plain_rows import column_letters
from assess.workbook.values import ERRORS, is_blank, read_text

COLUMNS: Mapping[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "Facility": (("Name", "LinearUnits"), ("Category", "SiteName")),
    "Floor": (("Name", "Elevation"), ("Category", "Height", "Description")),
    "Space": (("Name", "FloorName"), ()),
    "Type": (("Name", "AssetType", "NominalLength", "NominalWidth", "NominalHeight"), ()),
    "Component": (("Name", "TypeName", "Space"), ("ExtIdentifier", "ExternalIdentifier")),
}
"""Sheets that are read, with the columns that each must have, and those that are read where they are there."""

_NOT_GIVEN = frozenset({"n/a", "n.a.", "#n/a", "na", "null", "-", "--"})
_TEMPLATE = frozenset({"required", "lookup", "reference", "external reference", "if specified as required", ""})
"""What the second row of some templates holds in place of data, next to n/a."""
_MAX_LIST = 2**20
_SHEET = re.compile(rb"<(?:\w+:)?sheet\s[^>]*?\bname=[\"']([^\"']*)", re.IGNORECASE)

Row = Mapping[str, Any]
"""Values by the column's name in COBie; what is blank or n/a is left out."""


@dataclass(frozen=True, slots=True)
class CobieSheet:
    """One sheet: how the file calls it, the letters of its columns by their names, and its rows by number."""

    name: str
    letters: Mapping[str, str]
    rows: tuple[tuple[int, Row], ...]


def is_cobie(source: Path | bytes) -> bool:
    """Tell whether a file looks like a COBie spreadsheet, by the names of its sheets alone; never an error.

    Its sheets Type, Component and Space are there, and it is no inventory workbook. Only the list of sheets is read.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(source) if isinstance(source, bytes) else source) as archive:
            is_small = archive.getinfo(WORKBOOK).file_size <= _MAX_LIST
            names = _SHEET.findall(archive.read(WORKBOOK)) if is_small else []
    except DAMAGE:
        return False
    return is_cobie_list([name.decode("utf-8", "replace") for name in names])


def read_sheets(source: Path | bytes, name: str, progress: Progress = SILENT) -> dict[str, CobieSheet]:
    """Return the sheets of `COLUMNS` by their names in COBie.

    `source`: the .xlsx, within the limits of `assess.workbook.open`.
    Raises WorkbookError if it cannot be opened, is no COBie file, or a sheet, a column or the header row is missing.
    """
    data = source if isinstance(source, bytes) else read_file(source)
    try:
        with Book(data, name, progress) as book:
            return {sheet: _read_sheet(book, sheet, own) for sheet, own in _find_sheets(book, name).items()}
    except WorkbookError as error:  # the fix of an inventory that is too large is none for a handover file
        fix = fill("Delete the sheets Attribute, Document and Coordinate in a copy of it, and import that.")
        problems = [replace(one, fix=fix) if "assess new" in one.fix else one for one in error.problems]
        raise WorkbookError(problems) from None


def _find_sheets(book: Book, name: str) -> dict[str, str]:
    present = {plain(one): one for one in reversed(list(book.sheets))}
    missing = [sheet for sheet in COLUMNS if plain(sheet) not in present]
    if not missing:
        return {sheet: present[plain(sheet)] for sheet in COLUMNS}
    known = {found[0] for one in book.sheets if (found := find_sheet(one))}
    if {"Items", "Floors"} <= known:
        message = fill("{name} is an inventory workbook already, not a COBie file.", name=name)
        raise unreadable(message, fill("Check it with `assess check`."))
    listed = ", ".join(missing)
    message = fill("{name} is no COBie file: it has no sheet named {sheets}.", name=name, sheets=listed)
    raise unreadable(
        message, fill("Export it from the building model as a COBie spreadsheet (.xlsx) with these sheets.")
    )


def _read_sheet(book: Book, sheet: str, own: str) -> CobieSheet:
    needed, others = COLUMNS[sheet]
    wanted = {plain(column): column for column in (*needed, *others)}
    columns: dict[int, str] = {}
    best: dict[int, str] = {}
    rows: list[tuple[int, Row]] = []
    for number, cells in book.cells(own).rows():
        if number > MAX_ROWS:
            message = fill("the sheet has more than {most:,} rows.", most=MAX_ROWS)
            raise WorkbookError([Problem("error", own, f"A{MAX_ROWS + 1}", message, fill("Split the file by floors."))])
        if columns:
            rows += _read_row(number, cells, columns)
            continue
        found = _find_columns(cells, wanted)
        best = max(best, found, key=len)
        if set(needed) <= set(found.values()):
            columns = found
        elif number >= HEADER_ROWS:
            break
    if not columns:
        missing = ", ".join(column for column in needed if column not in best.values())
        message = fill("the header row lacks {columns}.", columns=missing)
        if not best:
            message = fill("the sheet has no header row with {columns}.", columns=missing)
        fix = fill("Name the columns as COBie 2.4 does, in one of the first {most} rows.", most=HEADER_ROWS)
        raise WorkbookError([Problem("error", own, "", message, fix)])
    return CobieSheet(own, {column: column_letters(at) for at, column in columns.items()}, tuple(rows))


def _find_columns(cells: Cells, wanted: Mapping[str, str]) -> dict[int, str]:
    found: dict[int, str] = {}
    for at, value in sorted(cells.items()):
        column = wanted.get(plain(value)) if isinstance(value, str) else None
        if column and column not in found.values():
            found[at] = column
    return found


def _read_row(number: int, cells: Cells, columns: Mapping[int, str]) -> Iterator[tuple[int, Row]]:
    typed = {columns[at]: value for at, value in cells.items() if at in columns and not is_blank(value)}
    texts = {column: say(value).casefold() for column, value in typed.items()}
    is_header = all(plain(text) == plain(column) for column, text in texts.items())
    if not is_header and not set(texts.values()) <= (_TEMPLATE | _NOT_GIVEN):
        yield number, {column: typed[column] for column, text in texts.items() if text not in _NOT_GIVEN}


def say(value: object) -> str:
    """Return a cell as a text; "" for one that is blank, an error or a formula without a saved value."""
    text = "" if value is None or value is UNSAVED else read_text(value)
    return "" if text in ERRORS else " ".join(text.split())
