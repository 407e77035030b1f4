"""Sheets as rows of values: finds the header, the columns and their units, and reads each cell by its column.

Every problem is collected with its cell; reading goes on, so that one run names them all.
"""

import difflib
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain, islice
from pathlib import Path
from typing import Any
from zipfile import ZipFile

from openpyxl import DEFUSEDXML, load_workbook
from openpyxl.utils import get_column_letter, range_boundaries

from assess.errors import Problem, WorkbookError
from assess.inventory.archive import DAMAGE, Scan, open_archive, scan_sheet, sheet_paths, unreadable
from assess.inventory.cells import (
    ERRORS,
    CellError,
    clean,
    is_unusual,
    read_choice,
    read_count,
    read_number,
    read_text,
    shorten,
    usual_range,
)
from assess.inventory.columns import LIVE, SHEETS, Column, Sheet, fold, split_header
from assess.units import QUANTITIES, read_unit

MAX_ROWS = 100_000
MAX_COLUMNS = 256
HEADER_ROWS = 20

Values = tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class Row:
    """One row of a table: its number, its values by field name (SI), and the texts of the unknown columns."""

    number: int
    values: dict[str, Any]
    extra: tuple[str, ...] = ()


@dataclass(slots=True)
class Table:
    """One sheet as it was read.

    `letters` tells in which column of the sheet a field stands; `form` and `lines` hold the values and rows of a form;
    `failed` the cells that have been reported as wrong, `blind` the fields whose column has no known unit.
    """

    sheet: Sheet
    found: bool = False
    letters: dict[str, str] = field(default_factory=dict)
    rows: list[Row] = field(default_factory=list)
    extra: tuple[str, ...] = ()
    form: dict[str, Any] = field(default_factory=dict)
    lines: dict[str, int] = field(default_factory=dict)
    failed: set[str] = field(default_factory=set)
    blind: set[str] = field(default_factory=set)

    def cell(self, name: str, row: int) -> str:
        """Address of a field in a row; the first column where the sheet lacks the field."""
        return f"{self.letters.get(name, 'A')}{row}"

    def spoilt(self, name: str, row: int) -> bool:
        """Tell whether a field of a row was filled in but could not be read, which has been reported."""
        return name in self.blind or self.cell(name, row) in self.failed


def read_tables(path: Path) -> tuple[dict[str, Table], list[Problem]]:
    """Read every sheet of the workbook.

    Raises
    ------
    WorkbookError
        If the file cannot be opened as a workbook at all.
    """
    if not DEFUSEDXML:
        raise unreadable(
            "defusedxml is missing, without which a hostile workbook could do harm.", "pip install defusedxml"
        )
    problems: list[Problem] = []
    try:
        with open_archive(path) as archive:
            return _read_sheets(path, archive, problems), problems
    except DAMAGE as error:
        if type(error).__name__ in ("EntitiesForbidden", "DTDForbidden", "ExternalReferenceForbidden"):
            raise unreadable(
                f"{path.name} declares XML entities, as an attack does.", "Save it again from Excel."
            ) from None
        raise unreadable(
            f"{path.name} is damaged or is no Excel workbook ({type(error).__name__}).",
            "Open it in Excel and save it again.",
        ) from None


def _read_sheets(path: Path, archive: ZipFile, problems: list[Problem]) -> dict[str, Table]:
    paths = sheet_paths(archive)
    names = {fold(name): name for name in paths}
    tables = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # openpyxl's remarks on drawings, footers and the like mean nothing to a user
        workbook = load_workbook(path, read_only=True, data_only=True, keep_links=False)
    try:
        for sheet in SHEETS:
            tables[sheet.name] = table = Table(sheet)
            name = names.get(fold(sheet.name))
            if name is None:
                problems += _missing_sheet(sheet, list(paths))
                continue
            table.found = True
            scan = scan_sheet(archive, paths[name])
            worksheet = workbook[name]
            worksheet.reset_dimensions()
            _Reader(table, scan, problems).read(worksheet)
    finally:
        workbook.close()
    return tables


def _missing_sheet(sheet: Sheet, present: list[str]) -> list[Problem]:
    near = difflib.get_close_matches(fold(sheet.name), [fold(name) for name in present], 1, 0.75)
    if near:
        wrong = next(name for name in present if fold(name) == near[0])
        return [
            Problem(
                "error", wrong, "", f"there is no sheet named {sheet.name}.", f"Did you mean {sheet.name}? Rename it."
            )
        ]
    if sheet.required:
        mend = "Add it, or start from a workbook made with `assess new`."
        return [Problem("error", sheet.name, "", "the sheet is missing.", mend)]
    return []


class _Reader:
    """Reads one sheet into its table; holds what every step needs."""

    def __init__(self, table: Table, scan: Scan, problems: list[Problem]) -> None:
        self.table, self.scan, self.problems = table, scan, problems
        self.sheet = table.sheet
        self.units: dict[str, str] = {}
        self.columns: dict[int, Column] = {}
        self.others: list[int] = []

    def report(self, cell: str, message: str, mend: str = "", severity: Any = "error") -> None:
        self.problems.append(Problem(severity, self.sheet.name, cell, message, mend))
        if severity == "error":
            self.table.failed.add(cell)

    def read(self, worksheet: Any) -> None:
        if self.scan.last and self.scan.last_row > MAX_ROWS:
            self.report(
                self.scan.last,
                f"holds a value far below the table; at most {MAX_ROWS:,} rows are read.",
                "Delete the rows below the table.",
            )
            return
        rows = enumerate(self._rows(worksheet), 1)
        if self.sheet.layout == "form":
            self._read_form(rows)
        else:
            self._read_table(rows)

    def _rows(self, worksheet: Any) -> Iterator[Values]:
        last: int = min(self.scan.last_row, MAX_ROWS)
        if not last:
            return
        for number, values in enumerate(worksheet.iter_rows(max_row=last, values_only=True), 1):
            if len(values) > MAX_COLUMNS:
                far = next((at for at, value in enumerate(values) if at >= MAX_COLUMNS and value is not None), None)
                if far is not None:
                    cell = f"{get_column_letter(far + 1)}{number}"
                    mend = "Delete the columns right of the table."
                    self.report(cell, f"holds a value far right of the table; {MAX_COLUMNS} columns are read.", mend)
                    return
            yield values

    # ------------------------------------------------------------------ forms

    def _read_form(self, rows: Iterator[tuple[int, Values]]) -> None:
        seen: dict[str, str] = {}
        for number, row in rows:
            header, value = (*row, None, None)[:2]
            if _blank(header):
                continue
            column = self._column(read_text(header), f"A{number}", seen, "line")
            if column:
                self.table.lines[column.name] = number
                self.table.form[column.name] = self._value(column, value, f"B{number}")
            elif value is not None and f"A{number}" not in self.table.failed:
                self.report(f"A{number}", f"{shorten(header)} is not known; it is not used.", severity="note")

    # ----------------------------------------------------------------- tables

    def _read_table(self, rows: Iterator[tuple[int, Values]]) -> None:
        head = self._find_header(rows)
        if head is None:
            return
        number, header, body = head
        self._read_header(number, header)
        for reference in self.scan.merged:
            if range_boundaries(reference)[3] >= number:
                self.report(reference, "cells are merged inside the table.", "Unmerge them and fill each cell.")
        for at, values in body:
            self._read_row(at, values)
        if self.sheet.required and not self.table.rows and self._complete():
            self.report(f"A{number + 1}", "the table has no rows.", "Fill in at least one.")

    def _find_header(
        self, rows: Iterator[tuple[int, Values]]
    ) -> tuple[int, Values, Iterator[tuple[int, Values]]] | None:
        """Return number and values of the header row, and the rows below it."""
        known = {fold(column.label) for column in self.sheet.columns}
        top = list(islice(rows, HEADER_ROWS))
        scores = [
            sum(fold(split_header(str(cell))[0]) in known for cell in values if cell is not None) for _, values in top
        ]
        if not any(scores):
            if self.sheet.required or any(value is not None for _, values in top for value in values):
                needed = " and ".join(column.header() for column in self.sheet.columns if column.required)
                self.report(
                    "A1", f"no header row was found in the first {HEADER_ROWS} rows.", f"It needs the columns {needed}."
                )
            return None
        best = scores.index(max(scores))
        return top[best][0], top[best][1], chain(top[best + 1 :], rows)

    def _read_header(self, number: int, header: Values) -> None:
        seen: dict[str, str] = {}
        labels = {fold(split_header(str(cell))[0]) for cell in header if cell is not None}
        live = {fold(split_header(label)[0]) for label in LIVE}
        extra = []
        for at, value in enumerate(header):
            text = read_text(value) if value is not None else ""
            if not text or fold(split_header(text)[0]) in live:
                continue
            cell = f"{get_column_letter(at + 1)}{number}"
            column = self._column(text, cell, seen, "column", labels)
            if column:
                self.columns[at] = column
                self.table.letters[column.name] = get_column_letter(at + 1)
            elif cell not in self.table.failed:
                self.others.append(at)
                extra.append(text)
                self.report(cell, f"the column {shorten(text)} is not known; it is kept, not used.", severity="note")
        self.table.extra = tuple(extra)
        for column in self.sheet.columns:
            if column.required and column.name not in self.table.letters:
                self.report(f"A{number}", f"the column {column.header()} is missing.", "Add it to the header row.")

    def _complete(self) -> bool:
        return all(column.name in self.table.letters for column in self.sheet.columns if column.required)

    def _column(
        self, header: str, cell: str, seen: dict[str, str], what: str, labels: Sequence[str] | set[str] = ()
    ) -> Column | None:
        """Return the column that a header names, with its unit noted; report what is wrong with it."""
        label, unit = split_header(header)
        column = next((one for one in self.sheet.columns if fold(one.label) == fold(label)), None)
        if column is None:
            near = self._near(label, unit, labels)
            if near:
                self.report(cell, f"the {what} {shorten(header)} is not known.", f"Did you mean {near.header()}?")
            return None
        if column.name in seen:
            self.report(
                cell, f"the {what} {column.label} is here twice, also in {seen[column.name]}.", "Delete one of them."
            )
            return None
        seen[column.name] = cell
        self.units[column.name] = spelt = read_unit(unit or "")
        if column.quantity and spelt not in QUANTITIES[column.quantity]:
            known = ", ".join(QUANTITIES[column.quantity])
            what_unit = (
                f"the unit [{unit}] of {column.label} is not known"
                if unit is not None
                else f"{column.label} has no unit"
            )
            self.report(cell, f"{what_unit}.", f"Write {column.header()}; known units: {known}.")
            self.units[column.name] = ""
            self.table.blind.add(column.name)
        return column

    def _near(self, label: str, unit: str | None, labels: Sequence[str] | set[str]) -> Column | None:
        """Return the column that a header nearly names; Weight [kg] beside Height [cm] is no slip."""
        folded = fold(label)
        for one in self.sheet.columns:
            known = fold(one.label)
            if unit is not None and read_unit(unit) not in QUANTITIES.get(one.quantity, {}):
                continue
            if difflib.SequenceMatcher(None, folded, known).ratio() < 0.8:
                continue
            if known not in labels or folded[:1] == known[:1]:
                return one
        return None

    def _read_row(self, number: int, values: Values) -> None:
        cells = {at: values[at] if at < len(values) else None for at in self.columns}
        if all(_blank(value) for value in cells.values()) and not self._uncached(number):
            others = [at for at in self.others if at < len(values) and not _blank(values[at])]
            if others:
                cell = f"{get_column_letter(others[0] + 1)}{number}"
                self.report(cell, "stands in a row without an entry; the row is left out.", severity="warning")
            return
        extra = tuple(
            read_text(values[at]) if at < len(values) and not _blank(values[at]) else "" for at in self.others
        )
        parsed = {
            column.name: self._value(column, cells[at], f"{get_column_letter(at + 1)}{number}")
            for at, column in self.columns.items()
        }
        self.table.rows.append(Row(number, parsed, extra))

    def _uncached(self, number: int) -> bool:
        return bool(self.scan.uncached) and any(
            f"{self.table.letters[column.name]}{number}" in self.scan.uncached for column in self.columns.values()
        )

    # ------------------------------------------------------------------ cells

    def _value(self, column: Column, value: Any, cell: str) -> Any:
        """Return a cell's value in SI, None where it is blank or wrong."""
        if _blank(value):
            if cell in self.scan.uncached:
                self.report(cell, "holds a formula with no saved value.", "Open the workbook in Excel and save it.")
            elif column.required:
                self.report(cell, f"{column.label} is blank.", "Fill it in, or delete the row.")
            return None
        try:
            return self._parse(column, value, cell)
        except CellError as error:
            self.report(cell, error.message, error.mend)
            return None

    def _parse(self, column: Column, value: Any, cell: str) -> Any:
        if column.kind == "number":
            return self._number(column, value, cell)
        if column.kind == "count":
            return read_count(column, value)
        if column.kind == "choice":
            return read_choice(column, value)
        text = read_text(value)
        if isinstance(value, str):
            if value.strip() in ERRORS:
                raise CellError(f"{column.label} holds the error {value.strip()}.", "Mend the formula in the cell.")
            removed = clean(value)[1]
            if removed:
                message = f"{removed} control or direction characters in {column.label} were taken out."
                self.report(cell, message, severity="warning")
        return text

    def _number(self, column: Column, value: Any, cell: str) -> float | None:
        unit = self.units[column.name]
        if column.quantity and not unit:
            return None  # the header's unit is unknown, and has been reported there
        number = read_number(column, value, unit)
        if is_unusual(column, number, unit):
            message = f"{column.label} is {number:g} {unit}, usual is {usual_range(column, unit)}."
            self.report(cell, message, "Check the number and the unit.", "warning")
        return number * QUANTITIES[column.quantity][unit] if column.quantity else number


def _blank(value: Any) -> bool:
    return value is None or (isinstance(value, str) and not value.strip())


def raise_errors(problems: Sequence[Problem]) -> None:
    """Raise WorkbookError if any of `problems` is an error."""
    if any(problem.severity == "error" for problem in problems):
        raise WorkbookError(problems)
