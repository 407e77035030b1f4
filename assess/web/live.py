"""Classes and live values of every piece as one types, the problems of the workbook, and what of them has changed.

All comes from one `Evaluation`. In place of a class stands the word that the class column of the workbook shows, but
that the evaluation knows more: of a floor with a record, say, Excel shows ``run assess`` and the page the class.
"""

import re
from collections import OrderedDict
from collections.abc import Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from itertools import islice, product
from threading import Lock
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from assess.errors import AssessError, Gap, Problem
from assess.i18n import gettext, load_catalogue, speaking
from assess.methods import Method, paper_formula, simulation
from assess.model import AXES, Inventory
from assess.pipeline.adopt import ROLLS, SIMULATED, UNCONFIRMED, Assessment
from assess.results import BASES
from assess.risk import RiskClass, classify_all
from assess.units import GRAVITY, LENGTH, VELOCITY
from assess.web.evaluation import Evaluation, evaluate, list_floors, wait_for_simulation
from assess.web.fixes import Fixes
from assess.web.request_errors import say_sentence
from assess.workbook.formulas import LIVE_METHODS, OUTSIDE, say_class
from assess.workbook.habits import list_groups
from assess.workbook.lists import NO_SHAKING, NO_UNIT, RUN_ASSESS, WRONG
from assess.workbook.live_row import IS_ANCHORED, IS_ROLLING, NO_AXIS, NO_FLOOR, NO_TYPE
from assess.workbook.names import find_sheet, key
from assess.workbook.parse import Row, Table, Tables
from assess.workbook.plain_rows import column_number
from assess.workbook.resolve import defined, filled_sizes, types_by_name
from assess.workbook.schema import CLASS, CLASS_OR, LIVE, NO, SHEETS, WORKINGS, YES

if TYPE_CHECKING:
    from assess.web.book import Book, Snapshot

MOST_STATES = 4
"""States of which it is known what was sent of them: an older page is answered whole."""
FEW, SOON, MANY = 60, 0.1, 5000
"""So few cases that are still to be rocked are waited for, and how long [s], of so many pieces at most: an edit is
answered with them."""
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
MOST_OF_RANGE = 400
"""Cells of one range that are marked."""
_RANGE = re.compile(r"([A-Z]{1,3})(\d+)(?::([A-Z]{1,3})(\d+))?")
_FORMS = frozenset(sheet.name for sheet in SHEETS if sheet.layout == "form")
_SEVERITIES = ("error", "warning", "note")


class LiveRow(NamedTuple):
    """What is shown of a row: `values` are those of the columns that Excel computes, in their order in the sheet.

    `basis` is one of `assess.results.BASES`, with "_", "formula" until it is simulated; `quick` is the formula's class.
    """

    risk: str = ""
    word: str = ""
    basis: str = ""
    assumed: bool = False
    chance: float | None = None
    low: float | None = None
    high: float | None = None
    quick: str = ""
    outside: bool = False
    values: tuple[float | str | None, ...] = ()


Rows = Mapping[int, LiveRow]
SHOWN = ("class", *LiveRow._fields[1:-1])
"""The names of the fields of a row, but for its values, as the page gets them."""


class _State(NamedTuple):
    """What is shown of one version: rows by number, the live columns, and all of the answer but the rows."""

    rows: Rows
    columns: tuple[int, ...]
    rest: Mapping[str, Any]


class LiveView:
    """What the page of one session knows of each state of its workbook: of a version, and what had been simulated."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._book: Book | None = None
        self._states: OrderedDict[str, _State] = OrderedDict()

    def answer(self, book: "Book", since: str | None) -> dict[str, Any]:
        """Return the answer of `GET /api/live`: the rows that changed since a stamp, all where that is not known."""
        snapshot = book.snapshot()
        with suppress(AssessError):
            if len(snapshot.inventory.items) <= MANY:
                wait_for_simulation(snapshot, seconds=SOON, most=FEW)
        with self._lock:
            if book is not self._book:
                self._book, self._states = book, OrderedDict()
            stamp = snapshot.stamp
            before, now = None if since is None else self._states.get(since), self._states.get(stamp)
            if now is None:
                now = _describe_state(snapshot)
                if self._states:  # rows that are alike are held once
                    known = next(reversed(self._states.values())).rows
                    rows = {at: known[at] if known.get(at) == row else row for at, row in now.rows.items()}
                    now = now._replace(rows=rows)
                self._states[stamp] = now
                while len(self._states) > MOST_STATES:
                    self._states.popitem(last=False)
        is_whole = before is None or before.columns != now.columns
        old: Rows = {} if is_whole or before is None else before.rows
        changed = {number: row for number, row in now.rows.items() if old.get(number) != row}
        gone = [number for number in old if number not in now.rows]
        found = {"version": snapshot.version, "stamp": stamp, "whole": is_whole, "gone": gone, **now.rest}
        return {**found, "items": describe_rows(changed, now.columns)}


def describe_rows(rows: Rows, columns: Iterable[int] = ()) -> dict[str, Any]:
    """Return rows as columns; `columns` are the places of the live ones."""
    *compared, values = map(list, zip(*rows.values(), strict=True) if rows else [()] * len(LiveRow._fields))
    own = {str(at): [row[place] for row in values] for place, at in enumerate(columns)}
    return {"row": list(rows), **dict(zip(SHOWN, compared, strict=True)), "values": own}


def _describe_state(snapshot: "Snapshot") -> _State:
    """Return all that is shown of one version of a workbook, in its language; of live columns those that are known."""
    inventory = snapshot.inventory
    with speaking(load_catalogue(inventory.language)):
        every = snapshot.sheets["Items"].columns
        columns = {at: every[at].live for at in sorted(every) if every[at].live in (*SHOWN_WORKINGS, *LIVE)}
        try:
            found = evaluate(snapshot, routes=False)
            fault = describe_failure(snapshot.problems, found)
        except AssessError as error:
            found = Evaluation(None, frozenset(key(one.floor) for one in inventory.floors), ())
            fault = say_sentence(error.message)
        rows = list_rows(snapshot.tables, inventory, found, columns.values())
        problems = describe_problems((*snapshot.problems, *found.problems), inventory.sheets, Fixes(snapshot))
        demands, floors = {} if found.assessment is None else found.assessment.demands, []
        for row in list_floors(snapshot.tables):
            peaks = {axis: [one.pfa for one in demands.get((row.get("floor"), axis), ())] for axis in AXES}
            largest = {f"pfa_{axis.lower()}": max(own) / GRAVITY if own else None for axis, own in peaks.items()}
            floors.append({"row": row.number, "floor": row.get("floor"), **largest})
        rest = {
            "problems": problems[:MOST_PROBLEMS], "more": max(0, len(problems) - MOST_PROBLEMS), "floors": floors,
            "counts": count_classes(rows, snapshot.tables["Items"]), "simulation": found.describe(), "error": fault,
        }  # fmt: skip
        return _State(rows, tuple(columns), rest)


def describe_failure(problems: Sequence[Problem], found: Evaluation) -> str:
    """Return why nothing could be computed, by the problems of reading and evaluation; "" where something was."""
    if found.assessment is not None:
        return ""
    why = [*found.problems, *(one for one in problems if isinstance(one, Gap) and one.severity == "error")]
    return " ".join(say_sentence(one.message) for one in dict.fromkeys(why[:MOST_NAMED]))


def list_rows(
    tables: Tables, inventory: Inventory, evaluation: Evaluation, columns: Iterable[str] = ()
) -> dict[int, LiveRow]:
    """Return what is shown of each row of Items that holds anything, by its number, in the language in use.

    `columns`: the live ones, by their headers in English. A piece without a class has the word that the class column of
    the workbook shows in its place.
    """
    labels, table, rows = tuple(columns), tables["Items"], dict[int, LiveRow]()
    known = {} if evaluation.assessment is None else _list_assessed(evaluation.assessment, labels)
    types, floors = types_by_name(tables["Catalogue"]), defined(tables["Floors"])
    anchored = {one.row: one.anchored for one in inventory.items}  # counts in place of the cell
    for row in table.rows:
        if row.number in known:
            rows[row.number] = known[row.number]
            continue
        sizes = filled_sizes(table, row, types)
        word = gettext(found) if (found := _find_word(table, row, sizes, types, floors, evaluation.unserved)) else ""
        shown: dict[str, float | str] = dict.fromkeys(LIVE, word)
        if found == NO_SHAKING:
            shown[LIVE[0]] = round(sizes["breadth"] / sizes["height"], DECIMALS)
            if (anchored.get(row.number) or row.get("anchored")) == YES:
                is_known = row.get("bracket_capacity") is not None and row.get("anchored") == YES
                word = shown[CLASS] = shown[CLASS_OR] = gettext(RUN_ASSESS if is_known else IS_ANCHORED)
        rows[row.number] = LiveRow(word=word, values=tuple(shown.get(label) for label in labels))
    return rows


def _find_word(
    table: Table, row: Row, filled: Mapping[str, float], types: Collection[str], floors: Collection[str],
    unserved: Collection[str],
) -> str:  # fmt: skip
    """Return why a row has no class, "" where name and sizes are not filled in; collections are of compared names."""
    sizes, kind, floor = ("breadth", "height"), row.get("type"), key(row.get("floor") or "")
    if row.get("item") is None:
        return ""
    if any(name in table.blind for name in sizes):
        return NO_UNIT
    if any(table.spoilt(name, row) for name in sizes):
        return WRONG
    if not filled.keys() >= set(sizes):
        return "" if kind is None or key(kind) in types else NO_TYPE
    if floor not in floors:
        return NO_FLOOR
    if table.spoilt("axis", row):
        return NO_AXIS
    return NO_SHAKING if floor in unserved else WRONG


def count_classes(rows: Rows, items: Table) -> dict[str, int]:
    """Return the number of pieces (not rows) of each class, "" for those without; `items` has their quantities."""
    counts = dict.fromkeys((*CLASSES, ""), 0)
    for row in items.rows:
        quantity = row.get("quantity")
        counts[rows[row.number].risk] += 1 if quantity is None else quantity
    return counts


def _list_assessed(assessment: Assessment, labels: Sequence[str]) -> dict[int, LiveRow]:
    """Return what is shown of each piece: as the reports, the worst class of its motions once it is simulated."""
    at, adoption, count = assessment.governing, assessment.adoption, len(assessment.inventory.items)
    if not count:
        return {}
    simulated, formula = (assessment.outcomes[one.key] for one in (simulation(), assessment.formula))
    firsts = np.searchsorted(assessment.case_item, np.arange(count))
    has_run = np.logical_or.reduceat(~np.isnan(simulated.value), firsts)
    risks = np.where(has_run, np.maximum.reduceat(adoption.risk, firsts), adoption.risk[at])
    quick = np.maximum.reduceat(np.where(adoption.can_rock, classify_all(formula.value), RiskClass.LOW), firsts)
    bases, waits = adoption.basis[at], assessment.waits
    low, high = _find_ranges(assessment)
    is_assumed, outside = simulated.flags["assumed_motion"][at], _find_outside(assessment, assessment.formula)
    held, texts = (assessment.held | (bases == ROLLS)).tolist(), _name_classes(assessment, risks, outside)
    columns, blank = _list_columns(assessment, texts) if labels else {}, [None] * count
    values = zip(*(columns.get(label, blank) for label in labels), strict=True) if labels else [()] * count
    shown = zip(
        assessment.inventory.items, held, risks.tolist(), texts, bases.tolist(), waits.tolist(), is_assumed.tolist(),
        adoption.probability[at].tolist(), low, high, quick.tolist(), outside.tolist(), values, strict=True,
    )  # fmt: skip
    rows = {}
    for item, is_held, risk, text, basis, is_open, assumed, chance, least, most, by_formula, is_outside, own in shown:
        named = "formula" if is_open else BASES[basis].replace(" ", "_")
        rows[item.row] = LiveRow(
            "" if is_held else CLASSES[risk], text if is_held else "", named, assumed, chance, least, most,
            CLASSES[by_formula], is_outside and not is_held, own,
        )  # fmt: skip
    return rows


def _find_ranges(assessment: Assessment) -> tuple[list[float | None], list[float | None]]:
    """Return the ends of the range of each piece's chance, as `assess.report.words.find_range`; None by the formula."""
    at, adoption, simulated = assessment.governing, assessment.adoption, assessment.outcomes[simulation().key]
    ends = np.stack([adoption.low[at], adoption.high[at]])
    thirds = np.stack([simulated.detail[name][at].astype(np.float64) for name in ("if_slower", "if_faster")])
    every = np.vstack([thirds, adoption.probability[at]])
    basis, is_unknown = adoption.basis[at], simulated.flags["unknown_building"][at]
    is_found = (basis == SIMULATED) | ((basis == UNCONFIRMED) & is_unknown)
    by_thirds = np.stack([every.min(axis=0), every.max(axis=0)])  # NaN where a third is
    low, high = np.where(is_found & ~np.isnan(by_thirds[0]), by_thirds, ends).tolist()
    return [None if one != one else one for one in low], [None if one != one else one for one in high]


def _find_outside(assessment: Assessment, method: Method) -> NDArray[np.bool_]:
    """Return which pieces lie outside the range in which a method was checked, and can rock."""
    found = assessment.outcomes[method.key].flags["extrapolated"] & assessment.adoption.can_rock
    return np.asarray(found[assessment.governing])


def _name_classes(assessment: Assessment, risks: NDArray[Any], outside: NDArray[np.bool_]) -> list[str]:
    words = {risk: say_class(risk) for risk in RiskClass}
    rolling = assessment.adoption.basis[assessment.governing] == ROLLS
    apart = np.select([assessment.held, rolling], [gettext(IS_ANCHORED), gettext(IS_ROLLING)], "").tolist()
    found = zip(risks.tolist(), outside.tolist(), apart, strict=True)
    return [word or words[RiskClass(risk)] + OUTSIDE * marked for risk, marked, word in found]


def _list_columns(assessment: Assessment, classes: Sequence[str]) -> dict[str, Sequence[Any]]:
    at, cases = assessment.governing, assessment.cases
    yes, no = gettext(YES), gettext(NO)
    paper, can_rock_at = paper_formula(), assessment.adoption.can_rock[at]
    of_paper = np.where(can_rock_at, classify_all(assessment.outcomes[paper.key].value[at]), RiskClass.LOW)
    ratio, pfa, *methods, risk, by_paper, can_rock = LIVE
    axis, pfv, breadth, height = SHOWN_WORKINGS
    numbers = {
        ratio: cases.breadth_to_height,
        pfa: cases.pfa / GRAVITY,
        **{name: assessment.outcomes[one.key].value for name, one in zip(methods, LIVE_METHODS, strict=True)},
        pfv: cases.pfv / VELOCITY["cm/s"],
        breadth: cases.breadth / LENGTH["cm"],
        height: cases.height / LENGTH["cm"],
    }
    rounded = {name: np.round(values[at], DECIMALS).tolist() for name, values in numbers.items()}
    return {
        **{name: ["" if one != one else one for one in own] for name, own in rounded.items()},  # NaN as in a sheet
        risk: classes,
        by_paper: _name_classes(assessment, of_paper, _find_outside(assessment, paper)),
        can_rock: [yes if one else no for one in can_rock_at.tolist()],
        axis: [assessment.case_demand[case].axis for case in at.tolist()],
    }


def describe_problems(
    problems: Iterable[Problem], sheets: Mapping[str, str], fixes: Fixes | None = None
) -> list[dict[str, Any]]:
    """Return problems as `GET /api/live` answers them, the errors first; `sheets` are own names by English ones."""
    english, described = {own: name for name, own in sheets.items()}, list[dict[str, Any]]()
    for shown, alike in list_groups(dict.fromkeys(problems)):
        sheet = english.get(shown.sheet) or (find_sheet(shown.sheet) or (shown.sheet,))[0]
        found = [(cell, one) for one in alike for cell in _list_cells(sheet, one.cell)]
        row, at = found[0][0] if found else (None, None)
        described.append({
            "severity": shown.severity, "sheet": sheet, "cell": shown.cell, "row": row, "at": at,
            "message": say_sentence(shown.message), "fix": say_sentence(shown.fix), "count": len(alike),
            "cells": [cell for cell, _ in found],
            "own": [(say_sentence(one.message), say_sentence(one.fix)) for _, one in found] if len(alike) > 1 else [],
            "lacks": shown.lacks if isinstance(shown, Gap) else "",
            "actions": fixes.find(sheet, found) if fixes and found and len(described) < MOST_PROBLEMS else [],
        })  # fmt: skip
    return sorted(described, key=lambda one: _SEVERITIES.index(one["severity"]))


def _list_cells(sheet: str, address: str) -> list[tuple[int, int]]:
    """Return the cells of an address, ``H14`` or ``A1:C2``, by row from 1 and column from 0; of a form in column 1."""
    found = _RANGE.fullmatch(address)
    if found is None:
        return []
    first, top, last, bottom = found.groups()
    columns = range(1, 2) if sheet in _FORMS else range(column_number(first) - 1, column_number(last or first))
    return list(islice(product(range(int(top), int(bottom or top) + 1), columns), MOST_OF_RANGE))
