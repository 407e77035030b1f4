"""A workbook in memory: read once from its bytes, changed without reading them again, and written back into them.

`Workbook.read` (by `assess.workbook.read.open_workbook`), `set` and `to_bytes` are the whole of it: the page, the
correction of a workbook and an update from a building model write through it. A change makes a new form of the
workbook and shares every row that it does not touch. What its sheets hold is what reading the bytes would find that
`to_bytes` returns: a number in a cell that shows dates is a date. Only cells that differ from those that were opened
are written, so that one that is set back keeps its rich text.
"""

import datetime
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice
from typing import Any, ClassVar

from assess.errors import Problem, WorkbookError
from assess.i18n import Text, fill
from assess.progress import SILENT, Progress
from assess.workbook.open import (
    HEADER_ROWS,
    SHEET_ROWS,
    UNSAVED,
    Area,
    Book,
    Cells,
    Marks,
    Percent,
    Place,
    read_number,
)
from assess.workbook.patch import (
    Locks,
    SheetEdits,
    SheetTable,
    Value,
    check_layout,
    check_value,
    list_headings,
    list_tables,
    read_back,
    write_edits,
)
from assess.workbook.plain_rows import column_letters, split_range
from assess.workbook.row_shift import Growth, RowMove, RowShift, Shift, move_areas

_TIMES = (datetime.datetime, datetime.date, datetime.time, datetime.timedelta)
_FORMULA = fill("it holds a formula: change it in your spreadsheet program.")
_UNKNOWN = fill("it holds something that is not known: change it in your spreadsheet program.")
MERGED = fill("it is covered by merged cells.")


@dataclass(slots=True)
class KeptRows:
    """Rows that `assess.workbook.parse` has read, by number: cells, the row, what was reported and corrected."""

    headers: object = None
    rows: dict[int, tuple[Cells, Any, Sequence[Any], Sequence[Any]]] = field(default_factory=dict)
    made: dict[str, dict[int, tuple[Any, Any, Any]]] = field(default_factory=dict)
    """What was made of rows without an error, by what for and their number: the row, on what else it rests, and it."""

    def serve(self, headers: object) -> None:
        """Forget all rows unless they were parsed by equal headers."""
        if self.headers != headers:
            self.headers, self.rows, self.made = headers, {}, {}


@dataclass(frozen=True, slots=True)
class Worksheet:
    """One sheet, for `assess.workbook.parse.parse_sheet` as `SheetCells` are.

    * `cells`: the rows that hold any, in their order; nothing of it is ever changed.
    * `title`, `marks`, `far`, `merged`, `hidden_rows`, `hidden_columns`: as of `SheetCells`.
    * `tables`: the Excel tables in it.
    * `opened`: the rows as they were opened.
    * `edited`: the columns of the cells that differ from these, by row.
    * `replaced`: those among them that replace a formula, whatever they hold.
    * `results`: stored results of formulas that are to be written.
    * `shifts`: rows inserted, deleted and moved since, in their order.
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
    tables: tuple[SheetTable, ...] = ()
    opened: dict[int, Cells] = field(default_factory=dict, compare=False)
    edited: Mapping[int, frozenset[int]] = field(default_factory=dict, compare=False)
    replaced: frozenset[Place] = field(default=frozenset(), compare=False)
    results: Mapping[Place, Value] = field(default_factory=dict, compare=False)
    shifts: tuple[Shift, ...] = field(default=(), compare=False)
    kept: KeptRows = field(default_factory=KeptRows, compare=False)
    locks: Locks = field(default_factory=lambda: Locks(()), compare=False)

    def rows(self) -> Iterator[tuple[int, Cells]]:
        """Yield the number and the cells of each row that holds any, from the top."""
        return iter(self.cells.items())

    @property
    def last_row(self) -> int:
        """The last row that holds a value or a formula, 0 in an empty sheet."""
        return max(*islice(reversed(self.cells), 1), *self.marks.hollow, 0, 0)

    @property
    def totals(self) -> frozenset[int]:
        """The rows that are totals rows of tables."""
        return frozenset(row for one in self.tables for row in range(one.area[3] - one.totals + 1, one.area[3] + 1))

    @property
    def is_changed(self) -> bool:
        """Whether anything of it is to be written."""
        return bool(self.edited or self.results or self.shifts)

    @staticmethod
    def address(row: int, at: int | None = None) -> str:
        """Return how messages call a cell, ``C3``; that of the first column where no column is given."""
        return f"{column_letters(at or 0)}{row}"

    def value(self, place: Place) -> Any:
        """Return what a cell holds, None where it is blank."""
        return self.cells.get(place[0], {}).get(place[1])

    def find_lock(self, place: Place) -> Text | str:
        """Return why a cell cannot be changed, "" where it can."""
        if place in self.marks.formulas:
            return _FORMULA
        return _UNKNOWN if place in self.marks.unknown else self.locks.find(*place)

    def as_read(self, place: Place, value: Value) -> Any:
        """Return what reading finds in a cell once a value has been written into it."""
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

    # ------------------------------------------------------------ changes

    def put(self, values: Mapping[Place, Any]) -> "Worksheet":
        """Return the sheet with what reading finds in some cells replaced; None for a blank one."""
        rows: dict[int, Cells] = {}
        touched: dict[int, set[int]] = {}
        for (row, at), value in values.items():
            if row not in rows:
                rows[row], touched[row] = dict(self.cells.get(row, {})), {*self.edited.get(row, ())}
            touched[row].add(at)
            if value is None:
                rows[row].pop(at, None)
            else:
                rows[row][at] = value
        replaced = self.replaced | self.marks.formulas.intersection(values)
        edited = dict(self.edited)
        for row, found in rows.items():
            before = self._find_opened(row) or {}
            differing = frozenset(
                at for at in touched[row] if (row, at) in replaced or not is_same(before.get(at), found.get(at))
            )
            edited[row] = differing
            if not differing:
                del edited[row]
        results = {place: one for place, one in self.results.items() if place not in values} if self.results else {}
        return replace(
            self, cells=self._with_rows(rows), marks=self._unmark(values), edited=edited, replaced=replaced,
            results=results,
        )  # fmt: skip

    def set(self, values: Mapping[Place, Value]) -> "Worksheet":
        """Return the sheet with values written into some cells."""
        return self.put({place: self.as_read(place, value) for place, value in values.items()})

    def store(self, results: Mapping[Place, Value]) -> "Worksheet":
        """Return the sheet with other stored results of formulas; None where programs compute it when they open it."""
        rows: dict[int, Cells] = {}
        for (row, at), value in results.items():
            found = rows.setdefault(row, dict(self.cells.get(row, {})))
            found[at] = UNSAVED if value is None else self.as_read((row, at), value)
            if found[at] is None:
                del found[at]
        marks = self._unmark(results, are_formulas=True)
        blank = [place for place in results if place[1] not in rows[place[0]]]
        if blank:
            hollow = {row: {*columns} for row, columns in marks.hollow.items()}
            for row, at in blank:
                hollow.setdefault(row, {*()}).add(at)
            marks = replace(marks, hollow=hollow)
        return replace(self, cells=self._with_rows(rows), marks=marks, results={**self.results, **results})

    def shift(self, shift: Shift) -> "Worksheet":
        """Return the sheet with rows inserted, deleted or moved; WorkbookError where that would tear a thing apart."""
        self._check_shift(shift)
        count = shift.count if isinstance(shift, RowShift) else 0
        marks, like, new = self.marks, shift.like, range(shift.at, shift.at + count)
        torn = Locks(marks.locked)
        copied = [at for row, at in marks.formulas if row == like and not torn.find(row, at)] if like else []
        cells = {moved: row for number, row in self.cells.items() if (moved := shift.row(number))}
        if copied or isinstance(shift, RowMove):
            copies = {row: dict.fromkeys(sorted(copied), UNSAVED) for row in new} if copied else {}
            cells = dict(sorted({**cells, **copies}.items()))
        formats = _move_keys(marks.formats, shift)
        formats |= {(row, at): code for (own, at), code in marks.formats.items() if own == like for row in new}
        row_formats = {moved: code for row, code in marks.row_formats.items() if (moved := shift.row(row))}
        row_formats |= dict.fromkeys(new, marks.row_formats[like]) if like in marks.row_formats else {}
        moved_marks = replace(
            marks,
            formulas=_move_places(marks.formulas, shift).union((row, at) for row in new for at in copied),
            unknown=_move_places(marks.unknown, shift),
            locked=[(area, why) for old, why in marks.locked if (area := shift.area(old))],
            formats=formats,
            row_formats=row_formats,
            hollow={moved: columns for row, columns in marks.hollow.items() if (moved := shift.row(row))},
        )
        tables = (replace(one, area=area) for one in self.tables if (area := shift.area(one.area)))
        merged = [one for old in self.merged if (one := move_areas(old, shift)) and not _is_one_cell(one)]
        sheet = replace(
            self,
            cells=cells,
            marks=moved_marks,
            merged=tuple(merged),
            hidden_rows=tuple(sorted(number for row in self.hidden_rows if (number := shift.row(row)))),
            tables=tuple(tables),
            edited={number: columns for row, columns in self.edited.items() if (number := shift.row(row))},
            replaced=frozenset(_move_places(self.replaced, shift)),
            results=_move_keys(self.results, shift),
            shifts=(*self.shifts, shift),
        )
        return replace(sheet, locks=sheet.list_locks())

    def list_locks(self) -> Locks:
        """Return the cells that no edit may change, but for formulas of their own."""
        covered = ((span, MERGED) for one in self.merged for span in _list_covered(one))
        return Locks([*self.marks.locked, *covered, *list_headings(self.tables)])

    def _check_shift(self, shift: Shift) -> None:
        if isinstance(shift, RowMove):
            self._check_move(shift)
            return
        first, last = shift.at, shift.at - shift.count - 1  # of those that are deleted
        why: Text | str = ""
        for (_, _, top, bottom), reason in self.marks.locked:
            if (top < first <= bottom) or (shift.count < 0 and first <= top <= last < bottom):
                why = reason
        for one in self.tables:
            _, _, top, bottom = one.area
            if shift.count < 0 and first <= bottom and top <= last and not (first <= top and bottom <= last):
                rows = range(top + one.headers, bottom - one.totals + 1)
                is_cut = first < rows.start or last >= rows.stop
                if is_cut or not any(row < first or row > last for row in rows):
                    why = fill("a table keeps its headers, its totals and one row at least.")
            elif shift.count < 0 and first <= top and bottom <= last:
                why = fill("a table keeps its headers, its totals and one row at least.")
        if shift.count > 0 and self.last_row + shift.count > SHEET_ROWS:
            why = fill("the sheet has no room for more rows.")
        self._refuse_row(first, why)

    def _check_move(self, move: RowMove) -> None:
        """Refuse a move into or out of cells that belong together, and over headers and totals of tables."""
        first, last = move.span
        merged = ((area, MERGED) for one in self.merged if (area := split_range(one)))
        for (_, _, top, bottom), why in (*self.marks.locked, *merged):
            is_torn = top < bottom and top <= last and first <= bottom
            if is_torn and not (first <= top and bottom <= last and move.row(bottom) - move.row(top) == bottom - top):
                self._refuse_row(max(top, first), why)
        for one in self.tables:
            _, _, top, bottom = one.area
            rows = range(top + one.headers, bottom - one.totals + 1)
            if top <= last and first <= bottom and not (first in rows and last in rows):
                self._refuse_row(first, fill("rows cannot be moved into or out of a table."))

    def _refuse_row(self, row: int, why: Text | str) -> None:
        if why:
            fix = fill("Change this row in Excel.")
            raise WorkbookError([Problem("error", self.title, self.address(row), why, fix)])

    def opened_row(self, row: int) -> int | None:
        """Return the number that a row had when it was opened; None for one that was inserted."""
        number: int | None = row
        for shift in reversed(self.shifts):
            number = None if number is None else shift.back(number)
        return number

    def _find_opened(self, row: int) -> Cells | None:
        """Return what a row held when it was opened; None for one that was inserted."""
        number = self.opened_row(row)
        return None if number is None else self.opened.get(number, {})

    def _with_rows(self, rows: Mapping[int, Cells]) -> dict[int, Cells]:
        cells = dict(self.cells) | {row: dict(sorted(found.items())) for row, found in rows.items() if found}
        for row in (row for row, found in rows.items() if not found):
            cells.pop(row, None)
        return dict(sorted(cells.items())) if any(row not in self.cells for row in rows) else cells

    def _unmark(self, places: Iterable[Place], *, are_formulas: bool = False) -> Marks:
        """Return the marks without what values that are written replace."""
        marks, found = self.marks, set(places)
        if not are_formulas and not marks.formulas.isdisjoint(found):
            marks = replace(marks, formulas=marks.formulas - found)
        if any(at in marks.hollow.get(row, ()) for row, at in found):
            left = ((row, {at for at in columns if (row, at) not in found}) for row, columns in marks.hollow.items())
            marks = replace(marks, hollow={row: columns for row, columns in left if columns})
        return marks

    # ------------------------------------------------------------ what is to be written

    def list_edits(self) -> SheetEdits:
        """Return what is to be written of it into the bytes that were opened, once its rows have been shifted there."""
        values = {(row, at): self.as_written(self.value((row, at))) for row, some in self.edited.items() for at in some}
        return SheetEdits(values, self.results, growth=self._find_growth())

    def _find_growth(self) -> Growth:
        """Return the blocks of rows that were blank and that hold values now."""
        blocks: list[tuple[int, int, frozenset[int]]] = []
        for row in sorted(self.edited):
            if row in self.cells and self._find_opened(row) == {}:
                columns = self.edited[row]
                if blocks and blocks[-1][1] == row - 1:
                    blocks[-1] = (blocks[-1][0], row, blocks[-1][2] | columns)
                else:
                    blocks.append((row, row, columns))
        return Growth(tuple(blocks))


def is_same(one: Any, other: Any) -> bool:
    """Tell whether two cells hold the same: TRUE is not 1."""
    return isinstance(one, bool) == isinstance(other, bool) and bool(one == other)


def _move_places(places: Iterable[Place], shift: Shift) -> set[Place]:
    return {(moved, at) for row, at in places if (moved := shift.row(row))}


def _move_keys(found: Mapping[Place, Any], shift: Shift) -> dict[Place, Any]:
    return {(moved, at): value for (row, at), value in found.items() if (moved := shift.row(row))}


def _list_covered(merged: str) -> Iterator[Area]:
    if (span := split_range(merged)) is not None:
        left, right, top, bottom = span
        yield left + 1, right, top, top
        yield left, right, top + 1, bottom


def _is_one_cell(area: str) -> bool:
    first, _, last = area.partition(":")
    return first == (last or first)


@dataclass(frozen=True, slots=True)
class Workbook:
    """The sheets of a workbook that are read, by their English names, and others by their own names once asked for.

    `data` are the bytes that were opened, `name` is how messages call it, `languages` those of the names of its sheets,
    `problems` sheets that are missing, there twice or hidden.
    """

    name: str
    data: bytes
    sheets: Mapping[str, Worksheet]
    languages: Mapping[str, str]
    language: str
    problems: tuple[Problem, ...] = ()
    titles: tuple[str, ...] = ()
    """All its sheets by their own names."""
    _shifted: bytes | None = field(default=None, compare=False)
    """The bytes that were opened with the rows of all sheets shifted, None where none are."""
    _faults: dict[str, str] = field(default_factory=dict, compare=False)
    """Why a sheet cannot be changed at all, "" for one that can, once it was asked for."""

    def sheet(self, name: str) -> Worksheet:
        """Return a sheet by its English name, or by its own; WorkbookError if it is missing or cannot be read."""
        if name in self.sheets:
            return self.sheets[name]
        own = next((one for one in self.sheets.values() if one.title == name), None)
        if own is not None:
            return own
        with Book(self.data, self.name) as book:
            if name not in book.sheets:
                raise WorkbookError([Problem("error", name, "", fill("the sheet is missing."))])
            return read_sheet(book, name)

    def by_english(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Return what belongs to sheets by their own names by those under which they are held."""
        names = {one.title: name for name, one in self.sheets.items()}
        return {names.get(title, title): one for title, one in values.items()}

    def _change(self, sheets: Mapping[str, Worksheet]) -> "Workbook":
        return replace(self, sheets={**self.sheets, **sheets})

    def set(self, values: Mapping[str, Mapping[Place, Value]]) -> "Workbook":
        """Return the workbook with values written into some cells, by sheet.

        Raises WorkbookError if a sheet is missing, or naming every cell that cannot hold its value.
        """
        sheets = {name: self.sheet(name) for name in values}
        problems = [
            Problem("error", sheets[name].title, sheets[name].address(*place), why, fill("Change this cell in Excel."))
            for name, one in values.items()
            for place, value in one.items()
            if (why := check_value(place, value))
        ]
        if problems:
            raise WorkbookError(problems)
        return self._change({name: sheets[name].set(one) for name, one in values.items()})

    def put(self, values: Mapping[str, Mapping[Place, Any]]) -> "Workbook":
        """Return the workbook with what reading finds in some cells replaced."""
        return self._change({name: self.sheet(name).put(one) for name, one in values.items()})

    def store(self, results: Mapping[str, Mapping[Place, Value]]) -> "Workbook":
        """Return the workbook with other stored results of formulas; None where programs are to compute them."""
        return self._change({name: self.sheet(name).store(one) for name, one in results.items() if one})

    def insert_rows(self, sheet: str, at: int, count: int = 1, like: int = 0) -> "Workbook":
        """Return the workbook with rows inserted before row `at`, with the styles and formulas of the row `like`.

        Raises WorkbookError where they would tear an array formula apart, or a reference cannot follow with certainty.
        """
        return self._shift(sheet, RowShift(at, count, like))

    def delete_rows(self, sheet: str, at: int, count: int = 1) -> "Workbook":
        """Return the workbook without some rows; WorkbookError where a table or an array formula needs them."""
        return self._shift(sheet, RowShift(at, -count))

    def move_rows(self, sheet: str, at: int, count: int, to: int) -> "Workbook":
        """Return the workbook with rows moved to lie before row `to`, which is numbered as before.

        Raises WorkbookError where that would tear a table, merged cells or an array formula apart.
        """
        return self._shift(sheet, RowMove(at, count, to))

    def _shift(self, sheet: str, shift: Shift) -> "Workbook":
        """Return it with rows shifted in memory and in its bytes: each shift is done once, however often it is saved.

        So what cannot follow with certainty is refused at once.
        """
        one = self.sheet(sheet)
        shifted = one.shift(shift)
        with Book(self._shifted or self.data, self.name) as book:
            data = write_edits(book, {one.title: SheetEdits(shifts=(shift,))})
        return replace(self._change({sheet: shifted}), _shifted=data)

    def find_lock(self, sheet: str, place: Place) -> Text | str:
        """Return why a cell cannot be changed, "" where it can."""
        one = self.sheet(sheet)
        if one.title not in self._faults:
            with Book(self.data, self.name) as book:
                try:
                    check_layout(book, one.title)
                    self._faults[one.title] = ""
                except WorkbookError as error:
                    self._faults[one.title] = error.problems[0].message
        return self._faults[one.title] or one.find_lock(place)

    def differs(self, other: "Workbook") -> bool:
        """Tell whether any cell is other than in another form of the same workbook."""
        for name in {*self.sheets, *other.sheets}:
            one, two = self.sheet(name), other.sheet(name)
            if one is two or one.cells is two.cells:
                continue
            if one.shifts != two.shifts:
                return True
            for row in {*one.edited, *two.edited}:
                cells, others = one.cells.get(row, {}), two.cells.get(row, {})
                if cells is not others and any(not is_same(cells.get(at), others.get(at)) for at in {*cells, *others}):
                    return True
        return False

    def to_bytes(self, progress: Progress = SILENT) -> bytes:
        """Return the bytes of the workbook; those that were opened where nothing of them is to change.

        `progress` is checked meanwhile. Raises WorkbookError if something cannot be changed with certainty: the
        problems name every cell that is refused.
        """
        edits = {one.title: one.list_edits() for one in self.sheets.values() if one.is_changed}
        if not edits:
            return self.data
        with Book(self._shifted or self.data, self.name, progress) as book:
            return write_edits(book, edits)


def read_sheet(book: Book, title: str) -> Worksheet:
    """Return a sheet of an open workbook, by its own name."""
    found = book.cells(title, is_marked=True)
    cells = dict(found.rows())
    sheet = Worksheet(
        title=title,
        cells=cells,
        marks=found.marks or Marks(),
        far=found.far,
        merged=tuple(found.merged),
        hidden_rows=tuple(found.hidden_rows),
        hidden_columns=frozenset(found.hidden_columns),
        tables=tuple(list_tables(book, book.sheets[title])),
        opened=cells,
    )
    return replace(sheet, locks=sheet.list_locks())
