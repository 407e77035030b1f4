"""The cells of a workbook in memory: read once from its bytes, then changed without reading them again.

A change makes a new form of the sheet and shares every row that it does not touch. Its cells hold what reading the
bytes would find that `assess.workbook.patch` writes for the same values: a number in a cell that shows dates is a date.
"""

import datetime
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice
from typing import Any, ClassVar

from assess.errors import Problem
from assess.workbook.open import HEADER_ROWS, UNSAVED, Book, Cells, Marks, Percent, Place, read_number
from assess.workbook.patch import Value, read_back
from assess.workbook.plain_rows import column_letters

_TIMES = (datetime.datetime, datetime.date, datetime.time, datetime.timedelta)


@dataclass(slots=True)
class KeptRows:
    """Rows that `assess.workbook.parse` has read, by number: cells, the row, what was reported and corrected."""

    headers: object = None
    rows: dict[int, tuple[Cells, Any, Sequence[Any], Sequence[Any]]] = field(default_factory=dict)

    def serve(self, headers: object) -> None:
        """Forget all rows unless they were parsed by equal headers."""
        if self.headers != headers:
            self.headers, self.rows = headers, {}


@dataclass(frozen=True, slots=True)
class HeldCells:
    """The cells of one sheet, for `assess.workbook.parse.parse_sheet` as `SheetCells` are.

    `cells` holds the rows that hold any, in their order; nothing of it is ever changed. The other attributes are those
    of `SheetCells`.
    """

    header_rows: ClassVar[int] = HEADER_ROWS
    top: ClassVar[str] = "A1"

    title: str
    cells: dict[int, Cells]
    marks: Marks = field(default_factory=Marks)
    far: str = ""
    merged: Sequence[str] = ()
    hidden_rows: Sequence[int] = ()
    hidden_columns: frozenset[int] = frozenset()
    kept: KeptRows = field(default_factory=KeptRows, compare=False)

    def rows(self) -> Iterator[tuple[int, Cells]]:
        """Yield the number and the cells of each row that holds any, from the top."""
        return iter(self.cells.items())

    @property
    def last_row(self) -> int:
        """The last row that holds a value or a formula, 0 in an empty sheet."""
        return max(self.marks.low, *islice(reversed(self.cells), 1), 0)

    @staticmethod
    def address(row: int, at: int | None = None) -> str:
        """Return how messages call a cell, ``C3``; that of the first column where no column is given."""
        return f"{column_letters(at or 0)}{row}"

    def value(self, place: Place) -> Any:
        """Return what a cell holds, None where it is blank."""
        return self.cells.get(place[0], {}).get(place[1])

    def as_read(self, place: Place, value: Value) -> Any:
        """Return what reading finds in a cell once `patch_workbook` has written a value into it."""
        found = read_back(value)
        if found is None or isinstance(found, bool | str):
            return found
        return read_number(found, self.marks.format_at(place), is_1904=self.marks.is_1904)

    def as_written(self, value: Any) -> Value:
        """Return the value to write, for a cell whose value was read."""
        if isinstance(value, _TIMES):
            from openpyxl.utils.datetime import MAC_EPOCH, WINDOWS_EPOCH, to_excel

            serial: float = to_excel(value, MAC_EPOCH if self.marks.is_1904 else WINDOWS_EPOCH)  # type: ignore[no-untyped-call]
            return serial
        found: Value = float(value) if isinstance(value, Percent) else value
        return found

    def changed(self, edits: Mapping[Place, Value]) -> "HeldCells":
        """Return the sheet with the values of some cells changed, as `patch_workbook` would write them."""
        return self.replaced({place: self.as_read(place, value) for place, value in edits.items()})

    def replaced(self, values: Mapping[Place, Any]) -> "HeldCells":
        """Return the sheet with what reading finds in some cells replaced; None for a blank one."""
        rows: dict[int, Cells] = {}
        for (row, at), value in values.items():
            if row not in rows:
                rows[row] = dict(self.cells.get(row, {}))
            if value is None:
                rows[row].pop(at, None)
            else:
                rows[row][at] = value
        cells = dict(self.cells) | {row: dict(sorted(found.items())) for row, found in rows.items() if found}
        for row in (row for row, found in rows.items() if not found):
            cells.pop(row, None)
        if any(row not in self.cells for row in rows):
            cells = dict(sorted(cells.items()))
        return replace(self, cells=cells)


@dataclass(frozen=True, slots=True)
class HeldSheets:
    """The sheets of a workbook that are read, by their English names; those of one's own are left out.

    `name` is how messages call it, `languages` those of the names of its sheets, `problems` sheets that are missing,
    there twice or hidden.
    """

    name: str
    cells: Mapping[str, HeldCells]
    languages: Mapping[str, str]
    language: str
    problems: tuple[Problem, ...] = ()

    def changed(self, edits: Mapping[str, Mapping[Place, Value]]) -> "HeldSheets":
        """Return the workbook with the values of some cells changed, as `patch_workbook` would write them."""
        changed = {name: self.cells[name].changed(one) for name, one in edits.items()}
        return replace(self, cells={**self.cells, **changed})

    def replaced(self, values: Mapping[str, Mapping[Place, Any]]) -> "HeldSheets":
        """Return the workbook with what reading finds in some cells replaced."""
        changed = {name: self.cells[name].replaced(one) for name, one in values.items()}
        return replace(self, cells={**self.cells, **changed})


# ---------------------------------------------------------------- reading


def hold_cells(book: Book, sheet: str) -> HeldCells:
    """Return the cells of a sheet of an open workbook."""
    found = book.cells(sheet, is_marked=True)
    cells = dict(found.rows())
    return HeldCells(
        title=sheet,
        cells=cells,
        marks=found.marks or Marks(),
        far=found.far,
        merged=tuple(found.merged),
        hidden_rows=tuple(found.hidden_rows),
        hidden_columns=frozenset(found.hidden_columns),
    )


def list_formulas(data: bytes, sheet: str, *, name: str = "workbook.xlsx") -> dict[str, bool]:
    """Return whether each formula of a sheet has stored a result that is not blank, by its address.

    Raises WorkbookError if the workbook cannot be opened.
    """
    with Book(data, name) as book:
        held = hold_cells(book, sheet)
    return {held.address(*place): held.value(place) not in (None, UNSAVED) for place in sorted(held.marks.formulas)}
