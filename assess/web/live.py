"""Classes and live values of every piece as one types, the problems of the workbook, and what of them has changed.

All comes from the run by the formulas. In place of a class stands the word that the class column of the workbook shows,
but that the run knows more: of a floor with a record, say, Excel shows ``run assess`` and the page the class.
"""

from collections import OrderedDict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from threading import Lock
from typing import TYPE_CHECKING, Any

from assess.errors import AssessError, Gap, Problem
from assess.i18n import gettext, load_catalogue, speaking
from assess.model import AXES
from assess.units import GRAVITY
from assess.web.evaluation import BY_FORMULAS, Evaluation, evaluate_once, list_floors
from assess.web.live_rows import LiveRow, count_classes, find_live_columns, list_quantities, list_rows
from assess.web.problem_cells import describe_problems
from assess.workbook.names import key
from assess.workbook.parse import Row

if TYPE_CHECKING:
    from assess.web.book import Book, Snapshot

MOST_VERSIONS = 4
"""Versions of which it is known what was sent of them: an older page is answered whole."""
MOST_PROBLEMS = 1000
"""Problems in one answer; the rest are counted."""
MOST_NAMED = 3
"""Reasons that are given why nothing could be computed."""

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
