"""Classes and live values of every piece as one types, the problems of the workbook, and what of them has changed.

All comes from the run by the formulas. In place of a class stands the word that the class column of the workbook shows,
but that the run knows more: of a floor with a record, say, Excel shows ``run assess`` and the page the class.
"""

import re
from collections import OrderedDict
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from threading import Lock
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from assess.errors import AssessError, Gap, Problem
from assess.i18n import LANGUAGES, gettext, load_catalogue, speaking
from assess.methods import Method, adopted_formula, paper_formula
from assess.model import AXES, Inventory
from assess.pipeline.assessment import Assessment
from assess.risk import RiskClass, classify_all
from assess.units import GRAVITY, LENGTH, VELOCITY
from assess.web.columns import PageSheet
from assess.web.evaluation import BY_FORMULAS, Evaluation, evaluate_once, list_floors
from assess.workbook.formulas import LIVE_METHODS, OUTSIDE, say_class
from assess.workbook.habits import list_groups
from assess.workbook.lists import NO_SHAKING, NO_UNIT, RUN_ASSESS, WRONG
from assess.workbook.live_row import IS_ANCHORED, NO_AXIS, NO_FLOOR, NO_TYPE
from assess.workbook.names import find_sheet, key, plain, split_header
from assess.workbook.parse import Row, Table, Tables
from assess.workbook.plain_rows import column_number
from assess.workbook.resolve import build_catalogue, defined, filled_sizes
from assess.workbook.schema import CLASS, CLASS_OR, LIVE, NO, SHEETS, WORKINGS, YES

if TYPE_CHECKING:
    from assess.web.book import Book, Snapshot

MOST_VERSIONS = 4
"""Versions of which it is known what was sent of them: an older page is answered whole."""
MOST_PROBLEMS = 1000
"""Problems in one answer; the rest are counted."""
MOST_NAMED = 3
"""Reasons that are given why nothing could be computed."""
CLASSES = tuple(one.name.lower() for one in RiskClass)
"""How the page calls the classes, in rising order."""
SHOWN_WORKINGS = WORKINGS[2:]
"""Columns from which the live ones are computed: the axis, PFV and sizes that were used."""
DECIMALS = 9
"""Decimals of the live values: what a sheet shows, with room to spare."""
_RANGE = re.compile(r"([A-Z]{1,3})(\d+)(?::([A-Z]{1,3})(\d+))?")
_FORMS = frozenset(sheet.name for sheet in SHEETS if sheet.layout == "form")
_SEVERITIES = ("error", "warning", "note")
MOST_OF_RANGE = 400
"""Cells of one range that are marked."""

Values = tuple[float | str | None, ...]


class LiveRow(NamedTuple):
    """What is shown of a row: `values` are those of the columns that Excel computes, in their order in the sheet."""

    risk: str
    word: str
    chance: float | None
    outside: bool
    values: Values


Rows = Mapping[int, LiveRow]


@dataclass(frozen=True, slots=True)
class _State:
    """What is shown of one version: rows by number, the live columns, and all of the answer but the rows."""

    version: int
    rows: Rows = field(default_factory=dict)
    columns: tuple[int, ...] = ()
    rest: Mapping[str, Any] = field(default_factory=dict)


class LiveView:
    """What the page of one session is told of each version of its workbook."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._book: Book | None = None
        self._states: OrderedDict[int, _State] = OrderedDict()

    def answer(self, book: "Book", since: int | None) -> dict[str, Any]:
        """Return the answer of `GET /api/live`: the rows that changed since a version, all where that is not known."""
        with self._lock:
            if book is not self._book:
                self._book, self._states = book, OrderedDict()
            snapshot = book.snapshot()
            before = None if since is None else self._states.get(since)
            now = self._states.get(snapshot.version)
            return _answer(now or self._evaluate(snapshot), before)

    def _evaluate(self, snapshot: "Snapshot") -> _State:
        latest = next(reversed(self._states.values()), None)
        state = describe_state(snapshot)
        if latest is not None:  # rows that are alike are held once
            known = latest.rows
            rows = {at: known[at] if known.get(at) == row else row for at, row in state.rows.items()}
            state = _State(state.version, rows, state.columns, state.rest)
        self._states[state.version] = state
        while len(self._states) > MOST_VERSIONS:
            self._states.popitem(last=False)
        return state


def _answer(now: _State, before: _State | None) -> dict[str, Any]:
    is_whole = before is None or before.columns != now.columns
    old: Rows = {} if is_whole or before is None else before.rows
    changed = [(number, row) for number, row in now.rows.items() if old.get(number) != row]
    return {
        "version": now.version,
        "whole": is_whole,
        "items": describe_rows(changed, now.columns),
        "gone": [number for number in old if number not in now.rows],
        **now.rest,
    }


def describe_rows(rows: Iterable[tuple[int, LiveRow]], columns: Iterable[int] = ()) -> dict[str, Any]:
    """Return rows as columns; without `columns`, the places of the live ones, what the page compares alone."""
    numbers, shown = [], []
    for number, row in rows:
        numbers.append(number)
        shown.append(row)
    return {
        "row": numbers,
        "class": [row.risk for row in shown],
        "word": [row.word for row in shown],
        "chance": [row.chance for row in shown],
        "outside": [row.outside for row in shown],
        "values": {str(at): [row.values[place] for row in shown] for place, at in enumerate(columns)},
    }


# ---------------------------------------------------------------- one version


def describe_state(snapshot: "Snapshot") -> _State:
    """Return all that is shown of one version of a workbook, in its language."""
    with speaking(load_catalogue(snapshot.inventory.language)):
        inventory = snapshot.inventory
        columns = find_live_columns(snapshot.sheets["Items"])
        found, fault = _evaluate(snapshot)
        rows = list_rows(snapshot.tables, inventory, found, columns.values())
        problems = describe_problems((*snapshot.problems, *found.problems), inventory.sheets)
        rest = {
            "problems": problems[:MOST_PROBLEMS],
            "more": max(0, len(problems) - MOST_PROBLEMS),
            "counts": count_classes(rows, list_quantities(snapshot.tables["Items"])),
            "floors": [_describe_floor(row, found) for row in list_floors(snapshot.tables)],
            "error": fault,
        }
        return _State(snapshot.version, rows, tuple(columns), rest)


def _evaluate(snapshot: "Snapshot") -> tuple[Evaluation, str]:
    """Return what is known of the pieces, and why nothing could be computed; "" where something was."""
    try:
        found = evaluate_once(snapshot, BY_FORMULAS)
    except AssessError as error:
        floors = frozenset(key(one.floor) for one in snapshot.inventory.floors)
        return Evaluation(None, floors, ()), gettext(error.message)
    return found, say_fault(snapshot.problems, found)


def say_fault(problems: Sequence[Problem], found: Evaluation) -> str:
    """Return why nothing could be computed, in the language in use; "" where something was.

    `problems` are those of the reading, which count where it found that nothing tells how the floors shake.
    """
    if found.assessment is not None:
        return ""
    why = [*found.problems, *(one for one in problems if isinstance(one, Gap) and one.severity == "error")]
    return " ".join(gettext(one.message) for one in dict.fromkeys(why[:MOST_NAMED]))


def _describe_floor(row: Row, found: Evaluation) -> dict[str, Any]:
    """Return the peaks of a floor [g], None where its motion is not known."""
    name = row.get("floor")
    demands = {} if found.assessment is None else found.assessment.demands
    peaks = {axis: [one.pfa for one in demands.get((name, axis), ())] for axis in AXES}
    return {
        "row": row.number,
        "floor": name,
        **{f"pfa_{axis.lower()}": max(own) / GRAVITY if own else None for axis, own in peaks.items()},
    }


# ---------------------------------------------------------------- rows


def find_live_columns(sheet: PageSheet) -> dict[int, str]:
    """Return the columns of Items that Excel computes, by their place in the sheet, as `LIVE` and `WORKINGS` have them.

    Those of which nothing is shown, as the row of Floors, are left out.
    """
    labels = {at: _live_labels().get(plain(one.label)) for at, one in sheet.columns.items() if one.is_live}
    return {at: label for at, label in sorted(labels.items()) if label is not None}


@cache
def _live_labels() -> dict[str, str]:
    names = {label: split_header(label)[0] for label in (*SHOWN_WORKINGS, *LIVE)}
    return {plain(load_catalogue(code).find(name)): label for code in LANGUAGES for label, name in names.items()}


def list_rows(
    tables: Tables, inventory: Inventory, evaluation: Evaluation, columns: Iterable[str]
) -> dict[int, LiveRow]:
    """Return what is shown of each row of Items that holds anything, by its number, in the language in use."""
    labels = tuple(columns)
    known = {} if evaluation.assessment is None else _list_assessed(evaluation.assessment, labels)
    words, anchored = _Words(tables, evaluation.unserved), {one.row: one.anchored for one in inventory.items}
    return {
        row.number: known.get(row.number) or words.describe(row, labels, anchored.get(row.number))
        for row in tables["Items"].rows
    }


def count_classes(rows: Mapping[int, LiveRow], quantities: Mapping[int, int]) -> dict[str, int]:
    """Return the number of pieces (not rows) of each class, "" for those without; `quantities` by row."""
    counts = dict.fromkeys((*CLASSES, ""), 0)
    for number, row in rows.items():
        counts[row.risk] += quantities.get(number, 1)
    return counts


def list_quantities(table: Table) -> dict[int, int]:
    """Return how many pieces each row of Items stands for, where that is filled in."""
    return {row.number: row.get("quantity") for row in table.rows if row.get("quantity") is not None}


# ---------------------------------------------------------------- pieces that were assessed


def _list_assessed(assessment: Assessment, labels: Sequence[str]) -> dict[int, LiveRow]:
    """Return what is shown of each piece under the motion that governs it."""
    at, adoption, held = assessment.governing, assessment.adoption, assessment.anchors.held.tolist()
    outside = _find_outside(assessment, adopted_formula(assessment.settings.class_by))
    texts = _say_classes(assessment, adoption.risk[at], outside)
    columns, blank = _columns(assessment, texts), [None] * len(texts)
    values = zip(*(columns.get(label, blank) for label in labels), strict=True) if labels else [()] * len(texts)
    found = zip(
        assessment.inventory.items, adoption.risk[at].tolist(), adoption.probability[at].tolist(), outside.tolist(),
        held, texts, values, strict=True,
    )  # fmt: skip
    return {
        item.row: LiveRow("", text, None, False, shown)
        if is_held
        else LiveRow(CLASSES[risk], "", chance, is_outside, shown)
        for item, risk, chance, is_outside, is_held, text, shown in found
    }


def _find_outside(assessment: Assessment, method: Method) -> NDArray[np.bool_]:
    """Return which pieces lie outside the range in which a method was checked, and can rock."""
    found = assessment.outcomes[method.key].flags["extrapolated"] & assessment.adoption.can_rock
    return np.asarray(found[assessment.governing])


def _say_classes(assessment: Assessment, risks: NDArray[Any], outside: NDArray[np.bool_]) -> list[str]:
    words, anchored = {risk: say_class(risk) for risk in RiskClass}, gettext(IS_ANCHORED)
    found = zip(risks.tolist(), outside.tolist(), assessment.anchors.held.tolist(), strict=True)
    return [anchored if held else words[RiskClass(risk)] + OUTSIDE * marked for risk, marked, held in found]


def _columns(assessment: Assessment, classes: Sequence[str]) -> dict[str, Sequence[Any]]:
    at, cases = assessment.governing, assessment.cases
    yes, no = gettext(YES), gettext(NO)
    paper, can_rock_at = paper_formula(), assessment.adoption.can_rock[at]
    of_paper = np.where(can_rock_at, classify_all(assessment.outcomes[paper.key].value[at]), RiskClass.LOW)
    ratio, pfa, *methods, risk, by_paper, can_rock = LIVE
    axis, pfv, breadth, height = SHOWN_WORKINGS
    outcomes = (assessment.outcomes[method.key].value[at] for method in LIVE_METHODS)
    return {
        ratio: _plain_numbers(cases.breadth_to_height[at]),
        pfa: _plain_numbers(cases.pfa[at] / GRAVITY),
        **dict(zip(methods, map(_plain_numbers, outcomes), strict=True)),
        risk: classes,
        by_paper: _say_classes(assessment, of_paper, _find_outside(assessment, paper)),
        can_rock: [yes if one else no for one in can_rock_at.tolist()],
        axis: [assessment.case_demand[case].axis for case in at.tolist()],
        pfv: _plain_numbers(cases.pfv[at] / VELOCITY["cm/s"]),
        breadth: _plain_numbers(cases.breadth[at] / LENGTH["cm"]),
        height: _plain_numbers(cases.height[at] / LENGTH["cm"]),
    }


def _plain_numbers(values: Any) -> list[float | str]:
    """Return numbers for JSON; "" for NaN, as a sheet shows it."""
    return ["" if one != one else one for one in np.round(values, DECIMALS).tolist()]


# ---------------------------------------------------------------- pieces without a class


class _Words:
    """Why rows have no class, in the words of the class column of the workbook.

    `unserved` are the floors whose motion is not known, as names are compared.
    """

    def __init__(self, tables: Tables, unserved: Collection[str]) -> None:
        self.table, self.unserved = tables["Items"], unserved
        self.types = {key(one.type): one for one in build_catalogue(tables["Catalogue"])}
        self.floors = defined(tables["Floors"])

    def describe(self, row: Row, labels: Sequence[str], anchored: str | None) -> LiveRow:
        """Return what is shown of a row; `anchored` is what counts in place of its own cell, if anything does."""
        sizes, word = filled_sizes(self.table, row, self.types), self.explain(row)
        shown: dict[str, float | str] = dict.fromkeys(LIVE, word)
        if word == gettext(NO_SHAKING):
            shown[LIVE[0]] = round(sizes["breadth"] / sizes["height"], DECIMALS)
            if (anchored or row.get("anchored")) == YES:
                is_known = row.get("bracket_capacity") is not None and row.get("anchored") == YES
                word = shown[CLASS] = shown[CLASS_OR] = gettext(RUN_ASSESS if is_known else IS_ANCHORED)
        return LiveRow("", word, None, False, tuple(shown.get(label) for label in labels))

    def explain(self, row: Row) -> str:
        """Return the word; "" where the row is not filled in as far as its name and sizes."""
        table = self.table
        sizes = ("breadth", "height")
        if row.get("item") is None:
            return ""
        if any(name in table.blind for name in sizes):
            return gettext(NO_UNIT)
        if any(table.spoilt(name, row) for name in sizes):
            return gettext(WRONG)
        if len(filled_sizes(table, row, self.types).keys() & set(sizes)) < len(sizes):
            is_unknown = row.get("type") is not None and key(row.get("type")) not in self.types
            return gettext(NO_TYPE) if is_unknown else ""
        return gettext(self._explain_motion(row))

    def _explain_motion(self, row: Row) -> str:
        floor = key(row.get("floor") or "")
        if floor not in self.floors:
            return NO_FLOOR
        if self.table.spoilt("axis", row):
            return NO_AXIS
        return NO_SHAKING if floor in self.unserved else WRONG


# ---------------------------------------------------------------- problems


def describe_problems(problems: Iterable[Problem], sheets: Mapping[str, str]) -> list[dict[str, Any]]:
    """Return problems as `GET /api/live` answers them, the errors first; `sheets` are own names by English ones."""
    english = {own: name for name, own in sheets.items()}
    found = [_describe(shown, alike, english) for shown, alike in list_groups(dict.fromkeys(problems))]
    return sorted(found, key=lambda one: _SEVERITIES.index(one["severity"]))


def _describe(shown: Problem, alike: list[Problem], english: Mapping[str, str]) -> dict[str, Any]:
    sheet = english.get(shown.sheet) or (find_sheet(shown.sheet) or (shown.sheet,))[0]
    found = [(cell, one) for one in alike for cell in list_cells(sheet, one.cell)]
    cells = [cell for cell, _ in found]
    row, at = cells[0] if cells else (None, None)
    return {
        "severity": shown.severity,
        "sheet": sheet,
        "cell": shown.cell,
        "row": row,
        "at": at,
        "message": gettext(shown.message),
        "fix": gettext(shown.fix),
        "count": len(alike),
        "cells": cells,
        "own": [(gettext(one.message), gettext(one.fix)) for _, one in found] if len(alike) > 1 else [],
        "lacks": shown.lacks if isinstance(shown, Gap) else "",
    }


def list_cells(sheet: str, address: str) -> list[tuple[int, int]]:
    """Return the cells of an address, ``H14`` or ``A1:C2``, by row from 1 and column from 0; of a form in column 1."""
    found = _RANGE.fullmatch(address)
    if found is None:
        return []
    first, top, last, bottom = found.groups()
    columns = range(column_number(first) - 1, column_number(last or first))
    rows = range(int(top), int(bottom or top) + 1)
    if sheet in _FORMS:
        return list(dict.fromkeys((row, 1) for row in rows[:MOST_OF_RANGE]))
    every = ((row, at) for row in rows for at in columns)
    return [cell for _, cell in zip(range(MOST_OF_RANGE), every, strict=False)]
