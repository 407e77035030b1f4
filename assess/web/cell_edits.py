"""Edits of cells and rows as they come from outside: taken as the column asks, or refused; steps to undo and redo."""

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from assess.errors import InputError
from assess.i18n import fill, gettext, nfill
from assess.web.columns import PageColumn, PageSheet
from assess.web.request_errors import UNUSABLE, RequestError
from assess.workbook.habits import CellError
from assess.workbook.open import MAX_COLUMNS, MAX_ROWS
from assess.workbook.patch import LARGEST_NUMBER, LONGEST_TEXT, Value, read_back
from assess.workbook.row_shift import RowMove, RowShift, Shift
from assess.workbook.store import Workbook
from assess.workbook.values import is_blank, is_converted, is_free, understand

MOST_STEPS, MOST_CELLS = 200, 1_000_000
"""Steps, and cells of all of them together, that are kept; the oldest are forgotten first."""

CellPlace = tuple[str, int, int]
"""English name of the sheet, row from 1, column from 0."""
Contents = Mapping[CellPlace, Any]
"""What reading finds in cells."""


@dataclass(frozen=True, slots=True)
class Step:
    """One change: the cells that it changed, before and after.

    `shifts`, `books`: of one that inserts, deletes or moves rows of the sheet `label`, its shifts in their order, and
    the whole workbook before and after.
    """

    label: str
    before: Contents
    after: Contents
    shifts: tuple[Shift, ...] = ()
    books: tuple[Workbook, Workbook] | None = None

    def turn(self) -> "Step":
        """Return the step that takes it back."""
        shifts = tuple(one.reverse() for one in reversed(self.shifts))
        return Step(self.label, self.after, self.before, shifts, self.books and (self.books[1], self.books[0]))

    @property
    def size(self) -> int:
        """About how many cells it keeps."""
        rows = self.books[0].sheet(self.label) if self.books else None
        return len(self.after) + (len(rows.marks.formulas) + len(rows.cells) if rows else 0) // 2


@dataclass(slots=True)
class History:
    """The steps up to `at` have been done, those behind it undone."""

    steps: list[Step] = field(default_factory=list)
    at: int = 0

    def take(self, step: Step, what: str) -> None:
        """Take in a step that has been done: one of "undo" or "redo", else a new one."""
        if what in ("undo", "redo"):
            self.at += 1 if what == "redo" else -1
            return
        self.steps[self.at :] = [step]
        cells = sum(one.size for one in self.steps)
        while len(self.steps) > MOST_STEPS or (cells > MOST_CELLS and len(self.steps) > 1):
            cells -= self.steps.pop(0).size
        self.at = len(self.steps)

    def back(self) -> Step | None:
        """Return the step that takes the last one back, None where there is none."""
        return self.steps[self.at - 1].turn() if self.at else None

    def forward(self) -> Step | None:
        """Return the next step, None where there is none."""
        return self.steps[self.at] if self.at < len(self.steps) else None


MOST_EDITS = 500_000
"""Cells of one edit."""
COMPUTED_KINDS = ("number", "count", "date", "choice", "flag")
"""Kinds of columns into which a spreadsheet program would take a formula."""
DIGITS = 6
"""Significant digits of a number that was converted from another unit."""
_PLAIN_NUMBER = re.compile(r"-?(?:0|[1-9][0-9]*)(?:\.[0-9]*)?")
_SUM = re.compile(r"\s*=([-+*/(). 0-9]{1,100})", re.ASCII)
_DECIMAL_COMMA = re.compile(r"(?<=[0-9]),(?=[0-9]{1,2}(?![0-9])|[0-9]{4})")
_FORMULA = fill("Formulas are not supported in this sheet. Enter the result instead.")

_TOO_LONG = fill("the text is longer than a cell holds: {most:,} characters.", most=LONGEST_TEXT)

Refused = list[list[Any]]
"""Sheet, row, column of each cell that is refused, and why."""


class EditsRefused(RequestError):  # noqa: N818 - what happened, as callers say it
    """Some cells cannot be edited as asked; nothing has changed. `refused` names each with the reason."""

    def __init__(self, refused: Refused) -> None:
        self.refused = refused
        message = nfill(
            "{n:,} cell cannot be changed: {why}", "{n:,} cells cannot be changed: {why}",
            len(refused), why=refused[0][3],
        )  # fmt: skip
        super().__init__(message, UNUSABLE, more={"refused": refused})


def take_edits(edits: object, sheets: Mapping[str, PageSheet], workbook: Workbook) -> dict[CellPlace, Value]:
    """Return the values to write by their cells; of several for one cell the last.

    `edits`: a list of ``[sheet, row, at, value]``, as it came from outside.
    Raises InputError if it is no such list; EditsRefused if any cell cannot be changed so.
    """
    if not isinstance(edits, list) or len(edits) > MOST_EDITS:
        raise InputError.about("edits have to be a list of at most {most:,} cells.", most=MOST_EDITS)
    found: dict[CellPlace, Value] = {}
    refused: Refused = []
    for edit in edits:
        sheet, row, at, value = _take_apart(edit)
        column, why = _find_column(sheets.get(sheet), row, at)
        if column is not None:
            value = _calculate(column, value)
            why = workbook.find_lock(sheet, (row, at)) or _refuse_value(column, value)
        if column is None or why:
            refused.append([sheet, row, at, say(why)])
            continue
        found[sheet, row, at] = taken = _take_value(column, value)
        if isinstance(taken, str) and len(str(read_back(taken) or "")) > LONGEST_TEXT:
            refused.append([sheet, row, at, say(_TOO_LONG)])
    if refused:
        raise EditsRefused(refused)
    return found


def say(text: str) -> str:
    """Return a text in the language in use; nothing stays nothing."""
    return gettext(text) if text else ""


def _take_apart(edit: object) -> tuple[str, int, int, Value]:
    if isinstance(edit, list) and len(edit) == 4:
        sheet, row, at, value = edit
        are_numbers = type(row) is int and type(at) is int
        if isinstance(sheet, str) and are_numbers and (value is None or isinstance(value, bool | int | float | str)):
            return sheet, row, at, value
    raise InputError.about("an edit has to be a list of sheet, row, column and value.")


def _find_column(sheet: PageSheet | None, row: int, at: int) -> tuple[PageColumn | None, str]:
    if sheet is None:
        return None, fill("the sheet is not known.")
    if not sheet.found:
        return None, fill("the workbook lacks this sheet, or its headers.")
    if not (1 <= row <= MAX_ROWS and 0 <= at < MAX_COLUMNS):
        return None, fill("it lies outside the {rows:,} rows and {columns} columns that are read.",
                          rows=MAX_ROWS, columns=MAX_COLUMNS)  # fmt: skip
    column = sheet.find(row, at)
    if column is None and sheet.sheet.layout == "form":
        return None, fill("no line of the form has its value there.")
    if column is None and row <= sheet.header:
        return None, fill("it is a header, or lies above the headers: change it in your spreadsheet program.")
    if column is None:
        return None, fill("its column has no header.")
    if column.live:
        return None, fill("its column is computed.")
    return column, ""


def _refuse_value(column: PageColumn, value: Value) -> str:
    """Return why a value cannot be taken; a formula that is typed would as a text only be a wrong number."""
    if not isinstance(value, str):
        is_number = value is None or abs(value) <= LARGEST_NUMBER
        return "" if is_number else fill("the value is not a number that a cell holds.")
    if len(value) > LONGEST_TEXT:
        return _TOO_LONG
    is_formula = value.lstrip().startswith("=") and column.kind in COMPUTED_KINDS
    return _FORMULA if is_formula else ""


def _calculate(column: PageColumn, value: Value) -> Value:
    """Return the result of a formula of numbers alone, such as =18*10, in a column of numbers; else the value."""
    if column.kind not in ("number", "count") or not isinstance(value, str):
        return value
    found = _SUM.fullmatch(_DECIMAL_COMMA.sub(".", value))
    try:
        result = _compute(ast.parse(found[1].strip(), mode="eval").body) if found else math.nan
    except (SyntaxError, ValueError, ArithmeticError):
        return value
    rounded = float(f"{result:.12g}")  # without the noise of binary fractions
    return value if not math.isfinite(rounded) else int(rounded) if rounded.is_integer() else rounded


def _compute(node: ast.expr) -> float:
    if isinstance(node, ast.Constant) and isinstance(node.value, int | float):
        return float(node.value)
    if isinstance(node, ast.UnaryOp) and type(node.op) in _SIGNS:
        return _SIGNS[type(node.op)](_compute(node.operand))
    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATIONS:
        return _OPERATIONS[type(node.op)](_compute(node.left), _compute(node.right))
    raise ValueError


_SIGNS: Mapping[type, Callable[[float], float]] = {ast.UAdd: operator.pos, ast.USub: operator.neg}
_OPERATIONS: Mapping[type, Callable[[float, float], float]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
}  # fmt: skip


# ---------------------------------------------------------------- rows


def change_rows(sheet: PageSheet, workbook: Workbook, do: object, at: object, count: object, to: object) -> Step:
    """Return the step that inserts rows before row `at`, deletes them from it on, or moves them before row `to`.

    A table keeps its first row: rows above it are inserted below it, and change places; of all rows the first is only
    cleared. So whatever is said of all rows, such as a choice, holds for the new ones. Raises InputError if the
    arguments name no rows of a table; WorkbookError if something in the workbook cannot follow with certainty.
    """
    first, name = sheet.header + 1, sheet.sheet.name
    if not (type(at) is int and type(count) is int and (to is None or type(to) is int)):
        raise InputError.about("Rows have to be given by numbers.")
    last = at + count - 1
    if not sheet.found or not sheet.header or not first <= at <= last <= MAX_ROWS:
        raise InputError.about("These rows do not belong to a table that is read.")
    before: Contents = {}
    if do == "insert":
        if workbook.sheet(name).last_row + count > MAX_ROWS:
            raise InputError.about("The sheet has no room for more rows.")
        below = at + 1 if at == first else at
        book = workbook.insert_rows(name, below, count, like=below - 1)
        shifts: tuple[Shift, ...] = (RowShift(at, count),)
        book = book if below == at else book.move_rows(name, below, count, at)
    elif do == "delete":
        is_all = at == first and last >= workbook.sheet(name).last_row
        cells = workbook.sheet(name).cells.get(at, {}) if is_all else {}
        before = {(name, at, one): value for one, value in cells.items() if not workbook.find_lock(name, (at, one))}
        book = workbook.put({name: {place[1:]: None for place in before}}) if before else workbook
        shifts = (RowShift(at + is_all, is_all - count),) if count > is_all else ()
        book = book.delete_rows(name, at + is_all, count - is_all) if shifts else book
    elif do == "move" and type(to) is int and first <= to <= MAX_ROWS + 1 and not at <= to <= last + 1:
        book, shifts = workbook.move_rows(name, at, count, to), (RowMove(at, count, to),)
    else:
        raise InputError.about("Rows are inserted, deleted, or moved to another place.")
    return Step(name, before, dict.fromkeys(before), shifts, (workbook, book))


def _take_value(column: PageColumn, value: Value) -> Value:
    """Return what belongs into a cell for what was typed: a number in the unit of its header, a choice, a date.

    A text that cannot be read so is returned as it is: reading reports it as a problem of the cell. A text is never
    taken for a formula.
    """
    if not isinstance(value, str | bool):
        return value
    if is_blank(value):
        return None
    known = column.column
    if known is None or column.is_blind:
        return _take_number(value) if isinstance(value, str) else value
    if is_free(known) or (isinstance(value, bool) and known.kind not in ("choice", "flag")):
        return value
    try:
        meant, remark = understand(known, value, column.unit)
    except CellError:
        return value
    if known.kind in ("choice", "flag"):
        word = None if remark is None else remark.value
        return value if word is None else word
    if isinstance(meant, float) and is_converted(known, value, column.unit):
        return float(f"{meant:.{DIGITS}g}")
    return meant.strip() if isinstance(meant, str) else meant if isinstance(meant, float | int) else value


def _take_number(text: str) -> Value:
    """Return the number that a text is, where it is written as programs write numbers: not 007, not 1e5, not 1,5."""
    shown = text.strip()
    if len(shown) > 15 or not _PLAIN_NUMBER.fullmatch(shown):
        return text
    return float(shown) if "." in shown else int(shown)
