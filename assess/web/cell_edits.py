"""Edits of cells as they come from outside: each is taken as its column asks, or refused; steps to undo and redo."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from assess.errors import InputError
from assess.i18n import fill, gettext, nfill
from assess.web.columns import PageColumn, PageSheet
from assess.web.request_errors import UNUSABLE, RequestError
from assess.workbook.habits import CellError
from assess.workbook.open import MAX_COLUMNS, MAX_ROWS
from assess.workbook.patch import LARGEST_NUMBER, LONGEST_TEXT, Value, read_back
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
    """One edit: the cells that it changed, before and after."""

    label: str
    before: Contents
    after: Contents


@dataclass(slots=True)
class History:
    """The steps up to `at` have been done, those behind it undone."""

    steps: list[Step] = field(default_factory=list)
    at: int = 0

    def add(self, step: Step) -> None:
        """Take in a step that has been done; those that were undone are forgotten."""
        self.steps[self.at :] = [step]
        cells = sum(len(one.after) for one in self.steps)
        while len(self.steps) > MOST_STEPS or (cells > MOST_CELLS and len(self.steps) > 1):
            cells -= len(self.steps.pop(0).after)
        self.at = len(self.steps)

    def back(self) -> Contents:
        """Return the cells as they were before the last step, nothing where there is none; it counts as undone."""
        if self.at == 0:
            return {}
        self.at -= 1
        return self.steps[self.at].before

    def forward(self) -> Contents:
        """Return the cells as the next step has them, nothing where there is none; it counts as done."""
        if self.at == len(self.steps):
            return {}
        self.at += 1
        return self.steps[self.at - 1].after


MOST_EDITS = 500_000
"""Cells of one edit."""
COMPUTED_KINDS = ("number", "count", "date", "choice", "flag")
"""Kinds of columns into which a spreadsheet program would take a formula."""
DIGITS = 6
"""Significant digits of a number that was converted from another unit."""
_PLAIN_NUMBER = re.compile(r"-?(?:0|[1-9][0-9]*)(?:\.[0-9]*)?")

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
    return fill("formulas are not computed here: type the value.") if is_formula else ""


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
