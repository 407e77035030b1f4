"""Cells that follow a building model: compared in their unit, set or kept, and listed as changes; and new rows.

New rows are added only where it is certain that they belong there.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from assess.errors import Problem
from assess.i18n import Text, fill, nfill
from assess.units import QUANTITIES
from assess.workbook.habits import CellError, shorten
from assess.workbook.names import is_live, key, split_header, translate_choices
from assess.workbook.open import LOCKED, MAX_ROWS, UNSAVED, Percent, Place
from assess.workbook.parse import Row, Table
from assess.workbook.patch import Value
from assess.workbook.plain_rows import column_letters, split_range
from assess.workbook.schema import NO, YES, Column
from assess.workbook.store import MERGED, Worksheet
from assess.workbook.values import is_blank, parse_outline, read_text

Rows = Sequence[Mapping[str, Any]]
Kind = Literal["changed", "added", "missing", "kept", "left_out"]
RENAMED = fill("it seems to have been renamed")
"""Why a name stays."""


@dataclass(frozen=True, slots=True)
class Change:
    """One thing that an update did, or deliberately did not do.

    Of `kind` "changed" the cell got another value. "added": the row is new. "missing": the model no longer has what the
    row was imported from; the row stays. "kept": the model has another value (`now`), and the workbook's stays.
    "left_out": what the model has was not written.

    `sheet` and `label` are as the workbook calls them, `cell` is the address, of a row that of its name; "" where there
    is none. `item` is the name of the row, "" in Building. Numbers are in the unit of the header.
    """

    kind: Kind
    sheet: str
    cell: str
    item: str = ""
    label: str = ""
    was: Value = None
    now: Value = None
    reason: Text | str = ""


def describe(change: Change) -> Text:
    """Return a change as a sentence: "Items H14 Breadth [cm] of Wardrobe 3: 54.5 -> 60"."""
    place = f"{change.sheet} {change.cell}".strip()
    what = fill("{place} {name}", place=place, name=change.label or change.item)
    if change.label and change.item:
        what = fill("{place} {label} of {name}", place=place, label=change.label, name=change.item)
    if change.kind == "changed":
        return fill("{what}: {was} -> {now}", what=what, was=_say(change.was), now=_say(change.now))
    if change.kind == "added":
        return fill("{what} was added", what=what)
    if change.kind == "missing":
        return fill("{what} is missing in the model; its row stays", what=what)
    if change.kind == "left_out":
        text = fill("{what} of the model was left out", what=what)
    elif change.label:
        text = fill("{what} stays {was}; the model has {now}", what=what, was=_say(change.was), now=_say(change.now))
    else:
        text = fill("{what} stays as it is", what=what)
    return fill("{text}: {reason}", text=text, reason=change.reason) if change.reason else text


def _say(value: Value) -> Text | str:
    if value is None:
        return fill("blank")
    if isinstance(value, int | float) and not isinstance(value, bool):
        return fill("{number:.10g}{unit}", number=value, unit="")
    return shorten(value)


TOLERANCE = {"length": 5e-4, "angle": 0.05}
"""Differences up to which two numbers are the same, by quantity [m, deg]."""
TURN, HALF_TURN = 360.0, 180.0
"""After so many degrees an angle is the same again; that of a piece, whose sides have no front, after half of them."""
DECIMALS = {"mm": 1, "cm": 2, "m": 4, "in": 3, "ft": 4}
"""Decimals that a converted length keeps, by unit: no more than 0.05 mm are rounded away."""
_DIGITS = 9


@dataclass(slots=True)
class SheetUpdate:
    """One sheet of a workbook while it is updated; of one that the workbook lacks the table is empty.

    All that happens is noted in `changes`, and why rows could not be added in `problems`: sheets share these. `values`
    is what is to be written.
    """

    table: Table
    cells: Worksheet
    changes: list[Change]
    problems: list[Problem]
    values: dict[Place, Value] = field(default_factory=dict)

    def can_hold(self, name: str) -> bool:
        """Tell whether the sheet has a column, or a line, for a field, in a unit that is known."""
        return name in self.table.places and name not in self.table.blind

    def address(self, name: str, row: Row) -> str:
        """Return the cell of a field of a row."""
        return self.table.cell(name, row.number)

    def place(self, name: str, row: Row) -> Place:
        """Return the row and the column of a field of a row."""
        at = self.table.places[name]
        return (at, 1) if self.table.sheet.layout == "form" else (row.number, at)

    def _raw(self, name: str, row: Row) -> Any:
        """Return what a cell holds, unread; None where it is blank."""
        value = self.cells.value(self.place(name, row))
        return None if is_blank(value) else value

    def _to_cell(self, name: str, wanted: Any) -> Value:
        """Return what a cell has to hold for a value in the unit of SI headers; None where nothing can be written."""
        column, unit = self.table.sheet.column(name), self.table.units.get(name, "")
        if isinstance(wanted, bool):
            return self._to_cell(name, YES if wanted else NO)
        if column.kind == "outline" and unit != column.unit:
            try:
                corners = parse_outline(str(wanted), 1.0)
            except CellError:
                return None
            return "; ".join(f"{_convert(column, unit, x):.10g} {_convert(column, unit, y):.10g}" for x, y in corners)
        if not isinstance(wanted, str):
            return _convert(column, unit, wanted)
        if wanted in column.choices:
            return translate_choices(column.choices, column.language)[column.choices.index(wanted)]
        return wanted

    def replace(self, row: Row, name: str, wanted: Any) -> None:
        """Set a cell that the model owns, unless it holds the same but for rounding; nothing never clears a cell."""
        if not self._differs(row, name, wanted):
            return
        why = self._find_lock(self.place(name, row))
        self._note("kept" if why else "changed", row, name, wanted, why)
        if not why:
            self.values[self.place(name, row)] = self._to_cell(name, wanted)

    def fill_blank(self, row: Row, name: str, wanted: Any) -> None:
        """Set a cell if it is blank; note where it holds something else than the model has."""
        if self.can_hold(name) and self._raw(name, row) is None:
            self.replace(row, name, wanted)
        else:
            self.keep(row, name, wanted)

    def keep(self, row: Row, name: str, wanted: Any, reason: Text | str = "") -> None:
        """Note that a cell stays, if it holds something else than the model has."""
        if self._differs(row, name, wanted):
            self._note("kept", row, name, wanted, reason)

    def _differs(self, row: Row, name: str, wanted: Any) -> bool:
        if wanted is None or wanted == "" or not self.can_hold(name):
            return False
        value, raw = self._to_cell(name, wanted), self._raw(name, row)
        if value is None or (raw == value and isinstance(raw, bool) == isinstance(value, bool)):
            return False
        read = row.get(name)
        return read is None or not _is_same(self.table.sheet.column(name), read, wanted)

    def _find_lock(self, place: Place) -> Text | str:
        """Return why a cell is left as it is, "" where it can be set; one of an array formula stops the update."""
        why = self.cells.locks.find(*place)
        if place in self.cells.marks.formulas and why not in LOCKED.values():
            return fill("the cell holds a formula")
        return fill("merged cells cover the cell") if why == MERGED else ""

    def _note(self, kind: Kind, row: Row, name: str, wanted: Any, reason: Text | str = "") -> None:
        was, unit, label = self._raw(name, row), self.table.units.get(name), self.table.label(name)
        if isinstance(was, Percent):
            was = float(was)
        elif was is UNSAVED:
            was = None
        elif not isinstance(was, bool | int | float | str | None):
            was = read_text(was)
        label = f"{label} [{unit}]" if unit else label
        self.changes.append(
            Change(kind, self.cells.title, self.address(name, row), self._name_of(row), label, was,
                   self._to_cell(name, wanted), reason)
        )  # fmt: skip

    def _name_of(self, row: Row) -> str:
        is_form = self.table.sheet.layout == "form"
        return "" if is_form else str(row.get(self.table.sheet.columns[0].name) or "")

    def note_row(self, kind: Kind, row: Row, reason: Text | str = "") -> None:
        """Note something of a row as a whole."""
        cell = self.address(self.table.sheet.columns[0].name, row)
        self.changes.append(Change(kind, self.cells.title, cell, self._name_of(row), reason=reason))

    def note_columns(self, names: Iterable[str], rows: Iterable[Mapping[str, Any]]) -> None:
        """Note the fields of a model's rows that have no column here."""
        filled = {name for row in rows for name, value in row.items() if value not in (None, "")}
        for name in names if self.table.found else ():
            if name in filled and not self.can_hold(name):
                why = fill("the sheet has no such column")
                if name in self.table.blind:
                    why = fill("its header gives no known unit")
                label = self.table.label(name)
                self.changes.append(Change("left_out", self.cells.title, "", label=label, reason=why))

    def add(self, rows: Rows) -> bool:
        """Fill in new rows after the last one that is filled, and return whether it is certain that they belong there.

        Formulas that are prepared there stay. Rows that are not added are listed as left out, and the problem says why.
        """
        if not rows:
            return True
        last = self._find_last()
        why: Text | str = fill("the workbook lacks the sheet")
        total = next((row for row in sorted(self.cells.totals) if last < row <= last + len(rows)), None)
        if self.table.found:
            why = self._find_hindrance(last, len(rows))
            if not why and total is not None:
                why = fill("row {row} is the totals row of a table", row=str(total))
            if not why:
                for number, row in enumerate(rows, last + 1):
                    self._write_row(number, row)
                return True
            message = nfill(
                "{n:,} new row of the model was not added: {why}.",
                "{n:,} new rows of the model were not added: {why}.", len(rows), why=why,
            )  # fmt: skip
            fix = fill("Move what stands below the last complete row of this sheet elsewhere, then import again.")
            if total is not None:
                fix = fill("Turn the totals row of the table off (Table Design), import again, and turn it on.")
            cell = self.cells.address(last, 0) if last else ""
            self.problems.append(Problem("warning", self.cells.title, cell, message, fix))
        for row in rows:
            reason = "" if self.table.found else why
            self.changes.append(Change("left_out", self.cells.title, "", str(next(iter(row.values()))), reason=reason))
        return False

    def _write_row(self, number: int, row: Mapping[str, Any]) -> None:
        for name, wanted in row.items():
            if self.can_hold(name) and wanted not in (None, ""):
                self.values[number, self.table.places[name]] = self._to_cell(name, wanted)
        first = self.table.sheet.columns[0].name
        cell = f"{column_letters(self.table.places[first])}{number}"
        self.changes.append(Change("added", self.cells.title, cell, str(row[first])))

    def _find_last(self) -> int:
        table, cells = self.table, self.cells
        headers = cells.cells.get(table.header, {})
        named = {at: split_header(read_text(value))[0] for at, value in headers.items() if isinstance(value, str)}
        typed = {at for at, label in named.items() if not is_live(table.sheet, label)}
        known = {*table.places.values()}
        formulas = cells.marks.formulas
        for number in sorted(cells.cells, reverse=True):
            if number <= table.header:
                break
            if number in cells.totals:
                continue
            filled = {at for at, value in cells.cells[number].items() if at in typed and not is_blank(value)}
            if any(at in known or (number, at) not in formulas for at in filled):
                return number
        return table.header

    def _find_hindrance(self, last: int, count: int) -> Text | str:
        table = self.table
        needed = [column.name for column in table.sheet.columns if column.required]
        if not table.header or not all(name in table.places for name in needed):
            return fill("the sheet lacks its headers")
        entry = next((row for row in table.rows if row.number == last), None)
        is_entry = entry is not None and all(entry.get(name) is not None for name in needed)
        if last > table.header and not is_entry:
            return fill("row {row}, the last that holds something, is not a complete entry", row=str(last))
        if last + count > MAX_ROWS:
            return fill("at most {most:,} rows are read", most=MAX_ROWS)
        areas = [span for one in self.cells.merged if (span := split_range(one))]
        areas += [area for area, _ in self.cells.marks.locked]
        if any(top <= last + count and bottom > last for _, _, top, bottom in areas):
            return fill("merged cells or a formula of several cells stand below row {row}", row=str(last))
        return ""


def _convert(column: Column, unit: str, number: float) -> float:
    if not column.quantity or unit == column.unit:
        return number
    return round(number * column.factor / QUANTITIES[column.quantity][unit], DECIMALS.get(unit, _DIGITS))


def _is_same(column: Column, read: Any, wanted: Any) -> bool:
    """Tell whether a value as it was read, in SI, is that of the model but for rounding and spelling."""
    if column.kind == "outline":
        try:
            corners = parse_outline(str(wanted), column.factor)
        except CellError:
            return False
        close = TOLERANCE["length"]
        return len(corners) == len(read) and all(
            abs(x - u) <= close and abs(y - v) <= close for (x, y), (u, v) in zip(corners, read, strict=True)
        )
    if isinstance(wanted, str):
        return key(str(read)) == key(wanted)
    difference = abs(float(read) - wanted * column.factor)
    if column.quantity == "angle":
        period = HALF_TURN if column.name == "angle_deg" else TURN
        difference = min(difference % period, -difference % period)
    return bool(difference <= TOLERANCE.get(column.quantity, 1e-9 * abs(wanted * column.factor)))
