"""What changed between two runs: pieces, routes and rooms one by one, and the counts. Pure; no file, no language.

Rows are matched by their names. A change is a worsening or an improvement only where both chances rest on the same
basis: a simulated chance and one by formula are never set against each other, nor added up.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property
from typing import Generic, TypeVar

from assess.compare.past_run import ANCHORED, APART, CLASSES, PastChance, PastEntry, PastPiece, PastRun, PastState
from assess.errors import InputError
from assess.results import CANNOT_ROCK
from assess.route_results import RouteState
from assess.schedule_results import PHASES
from assess.text import natural_key
from assess.workbook.names import key

SAME = 1e-6
"""Difference of chances [-] up to which they are equal: rounding of other machines."""
SEVERITY: Mapping[str, int] = {RouteState.OPEN: 0, RouteState.DOUBTFUL: 1, RouteState.BLOCKED: 2}
"""States of routes and rooms in rising order; from and to any other state a change has no direction."""
ABSENT = ""
"""The standing of a piece, or the state of a route or room, in a run that does not have it."""

_Row = TypeVar("_Row")
_Past = TypeVar("_Past", PastPiece, PastState)


class Direction(StrEnum):
    """Where a row goes from BEFORE to AFTER; the order is that of lists.

    Worse and better are to another class or state, or from and to anchored; it rises and falls within one. It is
    unclear where chances rest on different bases, or a state is not known.
    """

    WORSE = "worse"
    RISES = "rises"
    UNCLEAR = "unclear"
    ADDED = "added"
    REMOVED = "removed"
    BETTER = "better"
    FALLS = "falls"
    SAME = "same"


ORDER = tuple(Direction)
WORSE = (Direction.WORSE, Direction.RISES)
BETTER = (Direction.BETTER, Direction.FALLS)
ONE_SIDED = (Direction.ADDED, Direction.REMOVED)


@dataclass(frozen=True, slots=True, kw_only=True)
class Change(Generic[_Past]):
    """One row in both runs, or in one: a route or a room, or a piece of furniture (`PieceChange`).

    `states` are those before and after, of a piece its class in words or one of `past_run.APART`; `ABSENT` where the
    run lacks it. `is_within` is whether the difference of the chances lies within the sampling interval, None where a
    chance has none or the bases differ.
    """

    before: _Past | None
    after: _Past | None
    states: tuple[str, str]
    direction: Direction
    is_within: bool | None

    @property
    def sides(self) -> tuple[_Past | None, _Past | None]:
        """The row before and after."""
        return self.before, self.after

    @property
    def row(self) -> _Past:
        """The row as it is after, or was before."""
        found = self.after or self.before
        if found is None:
            raise ValueError("a change has neither side")
        return found


StateChange = Change[PastState]


@dataclass(frozen=True, slots=True, kw_only=True)
class PieceChange(Change[PastPiece]):
    """A row of furniture; `inputs` are the fields that differ, with their values before and after."""

    inputs: Mapping[str, tuple[object, object]]

    @property
    def quantities(self) -> tuple[int, int]:
        """Pieces of the row before and after."""
        before, after = (one.quantity if one else 0 for one in self.sides)
        return before, after

    @property
    def pieces(self) -> int:
        """Pieces that a change concerns: those of both runs, or of the one that has the row."""
        return min(self.quantities) if self.before and self.after else self.row.quantity


class Status(StrEnum):
    """What became of a recommendation of the last report; the order is that of lists."""

    OPEN = "open"
    NEW = "new"
    DROPPED = "no longer recommended"
    DONE = "done"


@dataclass(frozen=True, slots=True)
class Recommendation:
    """An entry of what to fix, of AFTER where it is new; `items` are the pieces that it is still, or newly, about."""

    entry: PastEntry
    status: Status
    items: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Total:
    """A sum before and after; `is_within` as in `Change`, `is_comparable`: whether a difference means anything."""

    before: float
    after: float
    is_comparable: bool
    is_within: bool | None = None


@dataclass(frozen=True)
class Comparison:
    """Two runs and what changed between them; each list begins with what gets worse."""

    before: PastRun
    after: PastRun
    pieces: tuple[PieceChange, ...]
    routes: tuple[StateChange, ...]
    rooms: tuple[StateChange, ...]

    @property
    def has_same_basis(self) -> bool:
        """Whether the classes and sums of both runs rest on the same basis."""
        return self.before.main_basis == self.after.main_basis

    @property
    def is_other_building(self) -> bool:
        """Whether both runs name their building, differently."""
        return len({key(run.name) for run in (self.before, self.after)} - {""}) > 1

    @cached_property
    def recommendations(self) -> tuple[Recommendation, ...]:
        """What became of the entries of BEFORE, and the new ones of AFTER; those that are listed only are left out.

        An entry is done once all of its pieces are anchored and hold, or are gone; open if AFTER recommends any other.
        """
        free = {key(one.item) for one in self.after.pieces if not one.is_held}
        was, now = ([one for one in run.entries if one.phase != PHASES[-1]] for run in (self.before, self.after))
        listed, planned = ({key(item) for one in entries for item in one.items} for entries in (now, was))
        known = {key(item) for one in self.before.entries for item in one.items}
        found = []
        for one in was:
            left = tuple(item for item in one.items if key(item) in free)
            status = Status.OPEN if listed & {*map(key, left)} else Status.DROPPED if left else Status.DONE
            found.append(Recommendation(one, status, left))
        for one in now:  # of those that were listed only, it was known already
            if items := tuple(item for item in one.items if key(item) not in planned):
                status = Status.OPEN if known.issuperset(map(key, items)) else Status.NEW
                found.append(Recommendation(one, status, items))
        return tuple(sorted(found, key=lambda one: ([*Status].index(one.status), one.entry.place)))

    def count(self, *directions: Direction) -> int:
        """Count pieces, not rows, of some directions."""
        return sum(count for one in directions for _change, count in self.list_counted(one))

    def list_counted(self, direction: Direction) -> list[tuple[PieceChange, int]]:
        """Return the rows of a direction with their pieces: a row that grows adds some, one that shrinks loses some."""
        if direction not in ONE_SIDED:
            return [(one, one.pieces) for one in self.pieces if one.direction == direction]
        sign = 1 if direction == Direction.ADDED else -1
        more = [(one, sign * (one.quantities[1] - one.quantities[0])) for one in self.pieces]
        return [(one, count) for one, count in more if count > 0]

    @cached_property
    def moves(self) -> Mapping[tuple[str, str], int]:
        """Pieces by their standing before and after; where a row has more in one run, those beyond are of it alone."""
        found: Counter[tuple[str, str]] = Counter()
        for one in self.pieces:
            (was, now), (before, after), both = one.states, one.quantities, min(one.quantities)
            found[was, now] += both
            found[was, ABSENT] += before - both
            found[ABSENT, now] += after - both
        return {move: count for move, count in found.items() if count}

    def standings(self) -> list[str]:
        """Return the classes, and those of `past_run.APART` that occur."""
        there = {standing for move in self.moves for standing in move}
        return [*CLASSES, *(one for one in APART if one in there)]

    def count_standing(self, standing: str) -> Total:
        """Return the pieces of a class before and after, or of one of `past_run.APART`."""
        before = sum(count for (was, _), count in self.moves.items() if was == standing)
        after = sum(count for (_, now), count in self.moves.items() if now == standing)
        return Total(before, after, self.has_same_basis or standing == ANCHORED)

    @property
    def falls(self) -> Total:
        """Expected falls of the pieces that have a class in their run."""
        sides = [[one for one in run.pieces if run.is_counted(one)] for run in (self.before, self.after)]
        return _add_up(sides[0], sides[1], self.has_same_basis)

    @property
    def falls_of_both(self) -> Total | None:
        """The same of the pieces that have a class in both runs; None where these are all, or none."""
        both, is_whole = [], True
        for one in self.pieces:
            was = one.before is not None and self.before.is_counted(one.before)
            now = one.after is not None and self.after.is_counted(one.after)
            is_whole &= was == now and (not was or one.quantities[0] == one.quantities[1])
            if one.before and one.after and was and now:
                both.append([replace(side, quantity=one.pieces) for side in (one.before, one.after)])
        if is_whole or not (self.has_same_basis and both):
            return None
        return _add_up([was for was, _ in both], [now for _, now in both], is_comparable=True)


def compare(before: PastRun, after: PastRun) -> Comparison:
    """Compare two runs; raises InputError if they have no item in common: they are of different buildings."""
    pairs = _match(before.pieces, after.pieces, lambda one: key(one.item))
    if (before.pieces or after.pieces) and not any(one and other for one, other in pairs):
        raise InputError.about(
            "{before} and {after} have no item in common: they cannot be compared. Name two runs of one building.",
            before=before.path,
            after=after.path,
        )
    pieces = []
    for was, now in pairs:
        direction, is_within = _direct(was, now)
        states = before.standing(was) if was else ABSENT, after.standing(now) if now else ABSENT
        inputs: dict[str, tuple[object, object]] = {}
        for name, one in was.inputs.items() if was else ():
            other = now.inputs.get(name) if now else one
            if isinstance(one, int | float) and isinstance(other, int | float):
                is_equal = math.isclose(one, other, rel_tol=SAME, abs_tol=1e-9)
            else:
                is_equal = one == other
            inputs |= {} if is_equal else {name: (one, other)}
        pieces.append(
            PieceChange(before=was, after=now, states=states, direction=direction, is_within=is_within, inputs=inputs)
        )

    def rises(one: PieceChange) -> float:
        if one.before is None or one.after is None or one.direction == Direction.UNCLEAR:
            return 0.0
        return one.after.chance.probability - one.before.chance.probability

    def compare_states(rows: Sequence[PastState], others: Sequence[PastState]) -> tuple[StateChange, ...]:
        changes = []
        for was, now in _match(rows, others, lambda one: (key(one.floor), key(one.name))):
            direction, is_within = _direct_state(was, now, before.main_basis == after.main_basis)
            states = was.state if was else ABSENT, now.state if now else ABSENT
            changes.append(Change(before=was, after=now, states=states, direction=direction, is_within=is_within))
        return _arrange(changes, lambda one: (0.0, one.row.name))

    return Comparison(
        before,
        after,
        _arrange(pieces, lambda one: (-rises(one), one.row.item)),
        compare_states(before.routes, after.routes),
        compare_states(before.rooms, after.rooms),
    )


def _match(
    before: Sequence[_Row], after: Sequence[_Row], name: Callable[[_Row], object]
) -> list[tuple[_Row | None, _Row | None]]:
    was, now = {name(one): one for one in before}, {name(one): one for one in after}
    return [(was.get(one), now.get(one)) for one in dict.fromkeys((*was, *now))]


_Changed = TypeVar("_Changed", PieceChange, StateChange)


def _arrange(changes: Sequence[_Changed], rank: Callable[[_Changed], tuple[float, str]]) -> tuple[_Changed, ...]:
    return tuple(sorted(changes, key=lambda one: (ORDER.index(one.direction), rank(one)[0], natural_key(rank(one)[1]))))


def _direct(before: PastPiece | None, after: PastPiece | None) -> tuple[Direction, bool | None]:
    if before is None or after is None:
        return (Direction.ADDED if before is None else Direction.REMOVED), None
    if before.is_held or after.is_held:
        if before.is_held and after.is_held:
            return Direction.SAME, None
        return (Direction.WORSE if before.is_held else Direction.BETTER), None
    if before.basis != after.basis and CANNOT_ROCK not in (before.basis, after.basis):
        return Direction.UNCLEAR, None
    is_within = lies_within(before.chance, after.chance)
    if before.risk != after.risk:
        return (Direction.WORSE if after.risk > before.risk else Direction.BETTER), is_within
    return _direct_chance(before.chance, after.chance, is_within), is_within


def _direct_chance(before: PastChance, after: PastChance, is_within: bool | None) -> Direction:
    difference = after.probability - before.probability
    if is_within or abs(difference) <= SAME:
        return Direction.SAME
    return Direction.RISES if difference > 0 else Direction.FALLS


def _direct_state(
    before: PastState | None, after: PastState | None, is_comparable: bool
) -> tuple[Direction, bool | None]:
    if before is None or after is None:
        return (Direction.ADDED if before is None else Direction.REMOVED), None
    was, now = (one.chance if one.state in SEVERITY else None for one in (before, after))
    if not is_comparable:
        is_nothing = was is None and now is None and before.state == after.state
        return (Direction.SAME if is_nothing else Direction.UNCLEAR), None
    is_within = lies_within(was, now) if was and now else None
    if before.state != after.state:
        ranks = [SEVERITY.get(one.state) for one in (before, after)]
        if ranks[0] is None or ranks[1] is None or ranks[0] == ranks[1]:
            return Direction.UNCLEAR, is_within
        return (Direction.WORSE if ranks[1] > ranks[0] else Direction.BETTER), is_within
    if was is None or now is None:
        return (Direction.SAME if was is now else Direction.UNCLEAR), None
    return _direct_chance(was, now, is_within), is_within


def lies_within(before: PastChance, after: PastChance) -> bool | None:
    """Whether the difference of two chances is within sampling error; None where one has no interval.

    The interval of the difference is that of two independent samples. Runs with the same seed share their draws, which
    makes the true interval shorter: then this is on the safe side.

    Source: Newcombe RG (1998). Interval estimation for the difference between independent proportions: comparison of
    eleven methods. Statistics in Medicine 17(8):873-890, method 10.
    doi:10.1002/(SICI)1097-0258(19980430)17:8<873::AID-SIM779>3.0.CO;2-I
    """
    if before.low is None or before.high is None or after.low is None or after.high is None:
        return None
    difference = after.probability - before.probability
    down = math.hypot(after.probability - after.low, before.high - before.probability)
    up = math.hypot(after.high - after.probability, before.probability - before.low)
    return difference - down <= 0.0 <= difference + up


def _add_up(before: Sequence[PastPiece], after: Sequence[PastPiece], is_comparable: bool) -> Total:
    """Return the expected falls of pieces; the ends of their intervals add up, as one earthquake shakes them all."""

    def add(pieces: Sequence[PastPiece]) -> PastChance:
        sums: list[float | None] = []
        for name in ("probability", "low", "high"):
            values = [(one.quantity, getattr(one.chance, name)) for one in pieces]
            is_known = all(value is not None for _quantity, value in values)
            sums.append(math.fsum(quantity * value for quantity, value in values) if is_known else None)
        return PastChance(sums[0] or 0.0, *sums[1:])

    was, now = add(before), add(after)
    return Total(was.probability, now.probability, is_comparable, lies_within(was, now) if is_comparable else None)


def count_states(before: Iterable[PastState], after: Iterable[PastState]) -> dict[str, tuple[int, int]]:
    """Count routes or rooms by their states, before and after: from the worst down, then those without a severity."""
    was, now = (Counter(one.state for one in rows) for rows in (before, after))
    there = sorted({*was, *now}, key=lambda one: (-SEVERITY.get(one, 0 if one == RouteState.NOT_KNOWN else -1), one))
    return {state: (was[state], now[state]) for state in there}
