"""Sheets as rows of values: reads each cell by its column.

Every problem is collected with its cell; reading goes on, so that one run names them all.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from openpyxl.utils import get_column_letter, range_boundaries

from assess.errors import Problem, Severity, WorkbookError
from assess.inventory.archive import MAX_COLUMNS, MAX_ROWS
from assess.inventory.cells import (
    ERRORS,
    CellError,
    clean,
    describe_removed,
    describe_unusual,
    is_unusual,
    read_choice,
    read_count,
    read_date,
    read_language,
    read_number,
    read_text,
    shorten,
)
from assess.inventory.columns import Column, Sheet
from assess.inventory.headers import Headers, Rows, Values, find_header
from assess.inventory.scan import Scan
from assess.inventory.wording import ENGLISH
from assess.language import fill
from assess.units import QUANTITIES


@dataclass(frozen=True, slots=True)
class Row:
    """One row of a table: its number, its values by field name (SI), and the texts of the unknown columns."""

    number: int
    values: dict[str, Any]
    extra: tuple[str, ...] = ()

    def filled(self) -> dict[str, Any]:
        """Return the values that are not blank."""
        return {name: value for name, value in self.values.items() if value is not None}


@dataclass(slots=True)
class Table:
    """One sheet as it was read.

    `sheet` has the names that the workbook gives it and its columns; `language` is that of the sheet's name. `letters`
    tells in which column of the sheet a field stands; `form` and `lines` hold the values and rows of a form; `failed`
    the cells that have been reported as wrong, `blind` the fields whose column has no known unit.
    """

    sheet: Sheet
    problems: list[Problem]
    found: bool = False
    language: str = ENGLISH
    letters: dict[str, str] = field(default_factory=dict)
    rows: list[Row] = field(default_factory=list)
    extra: tuple[str, ...] = ()
    form: dict[str, Any] = field(default_factory=dict)
    lines: dict[str, int] = field(default_factory=dict)
    failed: set[str] = field(default_factory=set)
    blind: set[str] = field(default_factory=set)

    def report(self, cell: str, message: str, mend: str = "", severity: Severity = "error") -> None:
        """Take down a problem of one cell."""
        self.problems.append(Problem(severity, self.sheet.name, cell, message, mend))
        if severity == "error":
            self.failed.add(cell)

    def cell(self, name: str, row: int) -> str:
        """Address of a field in a row; the first column where the sheet lacks the field."""
        return f"{self.letters.get(name, 'A')}{row}"

    def label(self, name: str) -> str:
        """Return the label of a field as the workbook's language has it."""
        return self.sheet.column(name).label

    def spoilt(self, name: str, row: int) -> bool:
        """Tell whether a field of a row was filled in but could not be read, which has been reported."""
        return name in self.blind or (name in self.letters and self.cell(name, row) in self.failed)

    def sound(self, name: str, row: Row) -> Any:
        """Return the value of a field that is filled in and right, else None."""
        return None if self.spoilt(name, row.number) else row.values.get(name)

    def with_all(self, *names: str) -> list[Row]:
        """Return the rows that have these fields; why others lack one has been reported."""
        return [row for row in self.rows if all(row.values.get(name) is not None for name in names)]


class SheetReader:
    """Reads one sheet into its table; holds what every step needs. `sheet` has the English names."""

    def __init__(self, table: Table, sheet: Sheet, scan: Scan) -> None:
        self.table, self.scan, self.sheet, self.report = table, scan, table.sheet, table.report
        self.headers = Headers(sheet, table.sheet, table.report)

    def read(self, worksheet: Any) -> None:
        """Read the sheet; problems are reported to its table."""
        if self.scan.last_row > MAX_ROWS:
            message = f"holds a value far below the table; at most {MAX_ROWS:,} rows are read."
            self.report(f"A{self.scan.last_row}", message, "Delete the rows below the table.")
        elif self.scan.far:
            message = f"holds a value far right of the table; {MAX_COLUMNS} columns are read."
            self.report(self.scan.far, message, "Delete the columns right of the table.")
        elif self.sheet.layout == "form":
            self._read_form(self._rows(worksheet))
        else:
            self._read_table(self._rows(worksheet))
        self.table.blind = self.headers.blind
        named = {column.name: column for column in self.headers.found}
        self.table.sheet = replace(
            self.sheet, columns=tuple(named.get(column.name, column) for column in self.sheet.columns)
        )

    def _rows(self, worksheet: Any) -> Iterator[tuple[int, Values]]:
        """Yield the rows up to the last that holds a value: below it there can be a million that are only styled."""
        last = self.scan.last_row
        if last:
            for number, values in enumerate(worksheet.iter_rows(1, last, 1, MAX_COLUMNS, values_only=True), 1):
                yield number, values
                if number == last:
                    return

    # ------------------------------------------------------------------ forms

    def _read_form(self, rows: Rows) -> None:
        for number, (header, value, *_) in rows:
            if _blank(header):
                continue
            cell, text = f"A{number}", read_text(header)
            column, is_wrong = self.headers.match(text, cell, "line")
            if column:
                self.table.lines[column.name] = number
                self.table.form[column.name] = self._value(column, value, f"B{number}")
            elif value is not None and not is_wrong:
                self.report(cell, fill("{name} is not known; it is not used.", name=shorten(text)), severity="note")

    # ----------------------------------------------------------------- tables

    def _read_table(self, rows: Rows) -> None:
        head = find_header(self.headers, rows)
        if head is None:
            return
        number, header, body = head
        self.headers.read(number, header)
        self.table.letters = {column.name: get_column_letter(at + 1) for at, column in self.headers.columns.items()}
        self.table.extra = tuple(self.headers.others.values())
        for reference in self.scan.merged:
            if (range_boundaries(reference)[3] or 0) >= number:
                self.report(reference, "cells are merged inside the table.", "Unmerge them and fill each cell.")
        for at, values in body:
            self._read_row(at, values)
        if self.sheet.required and not self.table.rows and not self.headers.missing():
            self._report_no_rows(f"A{number + 1}")

    def _report_no_rows(self, cell: str) -> None:
        """Report a table without rows: a building may have no furniture, yet no report can do without a floor."""
        if self.sheet.name == "Items":
            message = fill("the table has no rows: nothing is assessed.")
            self.report(cell, message, fill("Fill in at least one."), "warning")
        else:
            self.report(cell, "the table has no rows.", "Fill in at least one.")

    def _read_row(self, number: int, values: Values) -> None:
        columns, others = self.headers.columns, self.headers.others
        if all(_blank(values[at]) for at in columns) and not self._uncached(number):
            stray = next((at for at in others if not _blank(values[at])), None)
            if stray is not None:
                cell = f"{get_column_letter(stray + 1)}{number}"
                message = fill("stands in a row without an entry; the row is left out.")
                self.report(cell, message, severity="warning")
            return
        extra = tuple("" if _blank(values[at]) else read_text(values[at]) for at in others)
        parsed = {
            column.name: self._value(column, values[at], f"{get_column_letter(at + 1)}{number}")
            for at, column in columns.items()
        }
        self.table.rows.append(Row(number, parsed, extra))

    def _uncached(self, number: int) -> bool:
        return bool(self.scan.uncached) and any(
            f"{letter}{number}" in self.scan.uncached for letter in self.table.letters.values()
        )

    # ------------------------------------------------------------------ cells

    def _value(self, column: Column, value: Any, cell: str) -> Any:
        """Return a cell's value in SI, None where it is blank or wrong."""
        if _blank(value) and cell in self.scan.uncached:
            self.report(cell, "holds a formula with no saved value.", "Open the workbook in Excel and save it.")
            return None
        try:
            found = None if _blank(value) else self._parse(column, value, cell)
        except CellError as error:
            self.report(cell, error.message, error.mend)
            return None
        if found is None and column.required:
            self.report(cell, f"{column.label} is blank.", "Fill it in, or delete the row.")
        return found

    def _parse(self, column: Column, value: Any, cell: str) -> Any:
        if column.kind == "number":
            return self._number(column, value, cell)
        if column.kind == "count":
            return read_count(column, value)
        if isinstance(value, str) and value.strip() in ERRORS:
            raise CellError(f"{column.label} holds the error {value.strip()}.", "Mend the formula in the cell.")
        if column.kind == "choice":
            return read_choice(column, value)
        if column.kind == "language":
            return read_language(column, value)
        if column.kind == "date":
            return read_date(value)
        removed = clean(value)[1] if isinstance(value, str) else 0
        if removed:
            self.report(cell, describe_removed(removed, column), severity="warning")
        return read_text(value) or None

    def _number(self, column: Column, value: Any, cell: str) -> float | None:
        unit = self.headers.units[column.name]
        if column.name in self.headers.blind:
            return None  # the header's unit is unknown, and has been reported there
        number = read_number(column, value, unit)
        if is_unusual(column, number, unit):
            message, mend = describe_unusual(column, number, unit), fill("Check the number and the unit.")
            self.report(cell, message, mend, "warning")
        return number * QUANTITIES[column.quantity][unit] if column.quantity else number


def _blank(value: Any) -> bool:
    return value is None or (isinstance(value, str) and not value.strip())


def raise_errors(problems: Sequence[Problem], sheets: Sequence[str]) -> None:
    """Raise WorkbookError if any of `problems` is an error: by the order of `sheets`, and from the top of each down."""
    if any(problem.severity == "error" for problem in problems):
        order = {name: at for at, name in enumerate(sheets)}
        raise WorkbookError(sorted(problems, key=lambda problem: (order.get(problem.sheet, -1), _find_row(problem))))


def _find_row(problem: Problem) -> int:
    number = re.search(r"\d+", problem.cell)
    return int(number[0]) if number else 0
