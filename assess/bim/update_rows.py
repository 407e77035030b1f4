"""The sheets of a workbook while it is updated, and new rows: only where it is certain that they belong there."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from assess.bim.update_cells import Change, SheetUpdate
from assess.errors import Problem
from assess.i18n import Text, fill, nfill
from assess.workbook.names import is_live, split_header
from assess.workbook.open import MAX_ROWS
from assess.workbook.places import split_range
from assess.workbook.values import is_blank, read_text

Rows = Sequence[Mapping[str, Any]]


@dataclass(slots=True)
class BookUpdate:
    """A workbook while it is updated.

    Attributes
    ----------
    sheets : mapping of str to SheetUpdate
        Those that it has, by their English names.
    changes : list of Change
        All that was done, and not done.
    problems : list of Problem
        Why rows could not be added.
    """

    sheets: Mapping[str, SheetUpdate]
    changes: list[Change]
    problems: list[Problem] = field(default_factory=list)

    def add(self, sheet: str, rows: Rows) -> bool:
        """Add rows to a sheet, and return whether there was room for them; else each is listed as left out."""
        if not rows:
            return True
        update = self.sheets.get(sheet)
        problem = add_rows(update, rows) if update else None
        if update and problem is None:
            return True
        self.problems += [problem] if problem else []
        title, why = (update.cells.title, "") if update else (sheet, fill("the workbook lacks the sheet"))
        for row in rows:
            self.changes.append(Change("left_out", title, "", str(next(iter(row.values()))), reason=why))
        return False


def add_rows(update: SheetUpdate, rows: Rows) -> Problem | None:
    """Fill in new rows after the last one that is filled; formulas that are prepared there stay.

    Returns why no row was added, where it is not certain that they belong there: a warning.
    """
    last = _find_last(update)
    total = next((row for row in sorted(update.totals) if last < row <= last + len(rows)), None)
    why = _find_hindrance(update, last, len(rows))
    if not why and total is not None:
        why = fill("row {row} is the totals row of a table", row=str(total))
    if not why:
        for number, row in enumerate(rows, last + 1):
            update.write_row(number, row)
        return None
    message = nfill(
        "{n:,} new row of the model was not added: {why}.", "{n:,} new rows of the model were not added: {why}.",
        len(rows), why=why,
    )  # fmt: skip
    fix = (
        fill("Move what stands below the last complete row of this sheet elsewhere, then import again.")
        if total is None
        else fill("Turn the totals row of the table off (Table Design), import again, and turn it on.")
    )
    cell = update.cells.address(last, 0) if last else ""
    return Problem("warning", update.cells.title, cell, message, fix)


def _find_last(update: SheetUpdate) -> int:
    table, cells = update.table, update.cells
    headers = cells.cells.get(table.header, {})
    named = {at: split_header(read_text(value))[0] for at, value in headers.items() if isinstance(value, str)}
    typed = {at for at, label in named.items() if not is_live(table.sheet, label)}
    known = {*table.places.values()}
    formulas = cells.marks.formulas
    for number in sorted(cells.cells, reverse=True):
        if number <= table.header:
            break
        if number in update.totals:
            continue
        filled = {at for at, value in cells.cells[number].items() if at in typed and not is_blank(value)}
        if any(at in known or (number, at) not in formulas for at in filled):
            return number
    return table.header


def _find_hindrance(update: SheetUpdate, last: int, count: int) -> Text | str:
    table = update.table
    needed = [column.name for column in table.sheet.columns if column.required]
    if not table.header or not all(name in table.places for name in needed):
        return fill("the sheet lacks its headers")
    entry = next((row for row in table.rows if row.number == last), None)
    is_entry = entry is not None and all(entry.get(name) is not None for name in needed)
    if last > table.header and not is_entry:
        return fill("row {row}, the last that holds something, is not a complete entry", row=str(last))
    if last + count > MAX_ROWS:
        return fill("at most {most:,} rows are read", most=MAX_ROWS)
    areas = [span for one in update.cells.merged if (span := split_range(one))]
    areas += [area for area, _ in update.cells.marks.locked]
    if any(top <= last + count and bottom > last for _, _, top, bottom in areas):
        return fill("merged cells or a formula of several cells stand below row {row}", row=str(last))
    return ""
