"""Headers: which row holds them, which column each names, and the unit in its brackets."""

import difflib
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain, islice
from typing import Any, Protocol

from openpyxl.utils import get_column_letter

from assess.errors import Severity
from assess.inventory.cells import read_text, shorten
from assess.inventory.columns import Column, Sheet
from assess.inventory.labels import split_header
from assess.inventory.wording import find_column, is_live, plain, versions
from assess.language import fill
from assess.units import QUANTITIES, read_unit

HEADER_ROWS = 20

Values = tuple[Any, ...]
Rows = Iterator[tuple[int, Values]]


class Report(Protocol):
    """Takes down a problem of one cell."""

    def __call__(self, cell: str, message: str, mend: str = "", severity: Severity = "error") -> None:
        """Take down a problem."""


@dataclass(slots=True)
class Headers:
    """The headers of one sheet, in any language: `english` is the sheet with its English names, `sheet` with its own.

    `columns` and `others` tell by place what stands in a column: one that is known, or the header of one that is not.
    `cells` and `units` tell by field name where the header stands and which unit it gives; `blind` are the fields
    whose unit is not known; `found` the columns with the labels that they have here.
    """

    english: Sheet
    sheet: Sheet
    report: Report
    columns: dict[int, Column] = field(default_factory=dict)
    others: dict[int, str] = field(default_factory=dict)
    cells: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    blind: set[str] = field(default_factory=set)
    found: list[Column] = field(default_factory=list)

    def read(self, number: int, values: Values) -> None:
        """Read the header row of a table."""
        texts = {at: read_text(value) for at, value in enumerate(values) if value is not None}
        labels = {plain(split_header(text)[0]) for text in texts.values()}
        for at, text in texts.items():
            cell = f"{get_column_letter(at + 1)}{number}"
            if not text or is_live(self.english, split_header(text)[0]):
                continue
            column, is_wrong = self.match(text, cell, "column", labels)
            if column:
                self.columns[at] = column
            elif not is_wrong:
                self.others[at] = text
                message = fill("the column {name} is not known; it is kept, not used.", name=shorten(text))
                self.report(cell, message, severity="note")
        for column in self.missing():
            self.report(f"A{number}", f"the column {column.header()} is missing.", "Add it to the header row.")

    def missing(self) -> list[Column]:
        """Return the required columns that no header names."""
        return [column for column in self.sheet.columns if column.required and column.name not in self.cells]

    def match(self, header: str, cell: str, what: str, labels: Collection[str] = ()) -> tuple[Column | None, bool]:
        """Return the column that a header names, and whether the header was reported as wrong."""
        label, unit = split_header(header)
        column = find_column(self.english, label)
        if column is None:
            near = self._near(label, unit, labels)
            if near:
                self.report(cell, f"the {what} {shorten(header)} is not known.", f"Did you mean {near.header()}?")
            return None, near is not None
        if column.name in self.cells:
            also = self.cells[column.name]
            self.report(cell, f"the {what} {column.label} is here twice, also in {also}.", "Delete one of them.")
            return None, True
        self.cells[column.name] = cell
        self.found.append(column)
        self._read_unit(column, unit, cell)
        return column, False

    def _read_unit(self, column: Column, unit: str | None, cell: str) -> None:
        spelt = read_unit(unit or "")
        self.units[column.name] = spelt if column.quantity else ""
        if column.quantity and spelt not in QUANTITIES[column.quantity]:
            known = ", ".join(QUANTITIES[column.quantity])
            wrong = f"{column.label} has no unit"
            if unit is not None:
                wrong = f"the unit {shorten(unit)} of {column.label} is not known"
            mend = f"Write the unit that the numbers are in, such as {column.header()}; known units: {known}."
            self.report(cell, f"{wrong}.", mend)
            self.blind.add(column.name)

    def _near(self, label: str, unit: str | None, labels: Collection[str]) -> Column | None:
        """Return the column that a header nearly names; Weight [kg] beside Height [cm] is no slip."""
        folded = plain(label)
        for one in chain(self.sheet.columns, *(sheet.columns for sheet in versions(self.english))):
            known = plain(one.label)
            if unit is None and _has_bare_unit(folded, known, one):
                return one
            if unit is not None and read_unit(unit) not in QUANTITIES.get(one.quantity, {}):
                continue
            if difflib.SequenceMatcher(None, folded, known).ratio() < 0.8:
                continue
            if known not in labels or folded[:1] == known[:1]:
                return one
        return None


def _has_bare_unit(folded: str, known: str, column: Column) -> bool:
    """Tell whether a header gives its unit without brackets: ``Height (cm)``, ``Height, cm``."""
    rest = folded.removeprefix(known).strip("()_,;:-/.")
    return folded.startswith(known) and read_unit(rest) in QUANTITIES.get(column.quantity, {})


def find_header(headers: Headers, rows: Rows) -> tuple[int, Values, Rows] | None:
    """Return number and values of the header row, and the rows below it; None, reported, where there is none."""
    sheet, report = headers.sheet, headers.report
    top = list(islice(rows, HEADER_ROWS))
    best = _best_row(headers.english, top)
    if best is not None:
        return top[best][0], top[best][1], chain(top[best + 1 :], rows)
    if sheet.required or any(value is not None for _, values in top for value in values):
        needed = " and ".join(column.header() for column in sheet.columns if column.required)
        message = f"no header row was found in the first {HEADER_ROWS} rows."
        report("A1", message, f"It needs the columns {needed}.")
    return None


def _best_row(sheet: Sheet, top: Sequence[tuple[int, Values]]) -> int | None:
    """Return which row names most columns, the first of them; other languages count where English falls short."""
    rows = [[plain(split_header(str(cell))[0]) for cell in values if cell is not None] for _, values in top]
    known: set[str] = set()
    for said in versions(sheet):
        known |= {plain(column.label) for column in said.columns}
        scores = [sum(label in known for label in labels) for labels in rows]
        best = scores.index(max(scores)) if any(scores) else None
        if best is not None and {plain(column.label) for column in said.columns if column.required} <= {*rows[best]}:
            return best
    return best
