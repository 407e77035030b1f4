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
from typing import TypeVar

from assess.compare.past_run import (
    ANCHORED,
    APART,
    CLASSES,
    NOT_KNOWN,
    PastChance,
    PastPiece,
    PastRun,
    PastState,
)
from assess.errors import InputError
from assess.i18n import fill
from assess.natural import natural_key
from assess.results import CANNOT_ROCK
from assess.workbook.names import key

SAME = 1e-6
"""Difference of chances [-] up to which they are equal: rounding of other machines."""
SEVERITY: Mapping[str, int] = {
    "open": 0,
    "doubtful": 1,
    "blocked": 2,
}
"""States of routes and rooms in rising order; from and to any other state no direction is told."""
ABSENT = ""
"""The standing of a piece in a run that does not have it."""


_Row = TypeVar("_Row")


class Direction(StrEnum):
    """Where a row goes from BEFORE to AFTER; the order is that of lists.

    Worse and better: to another class or state, or from and to anchored. Rises and falls: the chance within one class
    or state. Unclear: the chances rest on different bases, or a state is not known. Added and removed: the row is in
    one run alone.
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
class PieceChange:
    """One row of furniture in both runs, or in one.

    `standing_before` and `standing_after` are a class in words or one of `past_run.APART`; `ABSENT` where the run
    lacks it. `is_within` is whether the difference of the chances lies within the sampling interval, None where a
    chance has none or the bases differ. `inputs` are the fields that differ, with their values before and after.
    """

    before: PastPiece | None
    after: PastPiece | None
    standing_before: str
    standing_after: str
    direction: Direction
    is_within: bool | None
    inputs: Mapping[str, tuple[object, object]]

    @property
    def piece(self) -> PastPiece:
        """The row as it is after, or was before."""
        return _either(self.after, self.before)

    @property
    def more(self) -> int:
        """Pieces that the row has more after than before; below 0 fewer."""
        return (self.after.quantity if self.after else 0) - (self.before.quantity if self.before else 0)

    @property
    def pieces(self) -> int:
        """Pieces that a change concerns: those of both runs, or of the one that has the row."""
        if self.before is None or self.after is None:
            return self.piece.quantity
        return min(self.before.quantity, self.after.quantity)


@dataclass(frozen=True, slots=True, kw_only=True)
class StateChange:
    """One route or room in both runs, or in one; `floor` is "" for a route. The rest is as in `PieceChange`."""

    name: str
    floor: str
    before: PastState | None
    after: PastState | None
    direction: Direction
    is_within: bool | None

    @property
    def states(self) -> tuple[str, str]:
        """The states before and after; `ABSENT` where the run lacks it."""
        return (self.before.state if self.before else ABSENT, self.after.state if self.after else ABSENT)


@dataclass(frozen=True, slots=True)
class Total:
    """A sum before and after; `is_within` as in `PieceChange`, `is_comparable`: whether a difference means anything."""

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
    def has_same_code(self) -> bool:
        """Whether the same code of the program computed both runs, as far as they tell."""
        return self.before.code == self.after.code

    @property
    def has_same_basis(self) -> bool:
        """Whether the classes and sums of both runs rest on the same basis."""
        return self.before.main_basis == self.after.main_basis

    @property
    def is_other_building(self) -> bool:
        """Whether both runs name their building, differently."""
        names = {key(run.name) for run in (self.before, self.after)}
        return len(names - {""}) > 1

    @property
    def is_same_file(self) -> bool:
        """Whether both are the same results."""
        return self.before.sha256 == self.after.sha256

    @cached_property
    def by_direction(self) -> Mapping[Direction, list[PieceChange]]:
        """The pieces of every direction."""
        found: dict[Direction, list[PieceChange]] = {one: [] for one in Direction}
        for change in self.pieces:
            found[change.direction].append(change)
        return found

    def count(self, *directions: Direction) -> int:
        """Count pieces, not rows, of some directions."""
        return sum(count for one in directions for _change, count in self.list_counted(one))

    def list_counted(self, direction: Direction) -> list[tuple[PieceChange, int]]:
        """Return the rows of a direction with their pieces: a row that grows adds some, one that shrinks loses some."""
        if direction not in ONE_SIDED:
            return [(one, one.pieces) for one in self.by_direction[direction]]
        sign = 1 if direction == Direction.ADDED else -1
        more = [(one, sign * one.more) for one in self.pieces]
        return [(one, count) for one, count in more if count > 0]

    @cached_property
    def moves(self) -> Mapping[tuple[str, str], int]:
        """Pieces by their standing before and after; `ABSENT` stands for those that a run lacks.

        Where a row has more pieces in one run, those beyond are of that run alone: rows and columns add up to the
        counts of the runs.
        """
        found: Counter[tuple[str, str]] = Counter()
        for one in self.pieces:
            quantities = (one.before.quantity if one.before else 0, one.after.quantity if one.after else 0)
            both = min(quantities)
            found[one.standing_before, one.standing_after] += both
            found[one.standing_before, ABSENT] += quantities[0] - both
            found[ABSENT, one.standing_after] += quantities[1] - both
        return {move: count for move, count in found.items() if count}

    def standings(self) -> list[str]:
        """Return the classes, and of what stands apart what a run has."""
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
        both = [
            (replace(one.before, quantity=one.pieces), replace(one.after, quantity=one.pieces))
            for one in self.pieces
            if one.before and one.after and self.before.is_counted(one.before) and self.after.is_counted(one.after)
        ]
        if not (self.has_same_basis and both) or all(self._is_whole(one) for one in self.pieces):
            return None
        return _add_up([one for one, _ in both], [one for _, one in both], is_comparable=True)

    def _is_whole(self, one: PieceChange) -> bool:
        counted = [one.before is not None and self.before.is_counted(one.before)]
        counted.append(one.after is not None and self.after.is_counted(one.after))
        return counted[0] == counted[1] and (not counted[0] or not one.more)


def compare(before: PastRun, after: PastRun) -> Comparison:
    """Compare two runs; raises InputError if they have no item in common: they are of different buildings."""
    pieces = _match(before.pieces, after.pieces, lambda one: key(one.item))
    if (before.pieces or after.pieces) and not any(one and other for one, other in pieces):
        raise InputError(
            fill(
                "{before} and {after} have no item in common: they cannot be compared. Name two runs of one building.",
                before=before.path,
                after=after.path,
            )
        )
    routes = _match(before.routes, after.routes, lambda one: key(one.name))
    rooms = _match(before.rooms, after.rooms, lambda one: (key(one.floor), key(one.name)))
    is_comparable = before.main_basis == after.main_basis
    return Comparison(
        before,
        after,
        _arrange(
            (_compare_piece(before, after, *pair) for pair in pieces),
            lambda one: (one.direction, -_difference(one), one.piece.item),
        ),
        _arrange(
            (_compare_states(*pair, is_comparable) for pair in routes), lambda one: (one.direction, 0.0, one.name)
        ),
        _arrange((_compare_states(*pair, is_comparable) for pair in rooms), lambda one: (one.direction, 0.0, one.name)),
    )


def _match(
    before: Sequence[_Row], after: Sequence[_Row], name: Callable[[_Row], object]
) -> list[tuple[_Row | None, _Row | None]]:
    was, now = {name(one): one for one in before}, {name(one): one for one in after}
    return [(was.get(one), now.get(one)) for one in dict.fromkeys((*was, *now))]


def _arrange(changes: Iterable[_Row], rank: Callable[[_Row], tuple[Direction, float, str]]) -> tuple[_Row, ...]:
    def place(one: _Row) -> tuple[object, ...]:
        direction, number, name = rank(one)
        return ORDER.index(direction), number, natural_key(name)

    return tuple(sorted(changes, key=place))


# ---------------------------------------------------------------- one row


def _compare_piece(was: PastRun, now: PastRun, before: PastPiece | None, after: PastPiece | None) -> PieceChange:
    standings = (was.standing(before) if before else ABSENT, now.standing(after) if after else ABSENT)
    direction, is_within = _direct(before, after)
    return PieceChange(
        before=before,
        after=after,
        standing_before=standings[0],
        standing_after=standings[1],
        direction=direction,
        is_within=is_within,
        inputs=_compare_inputs(before, after),
    )


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


def _compare_inputs(before: PastPiece | None, after: PastPiece | None) -> dict[str, tuple[object, object]]:
    if before is None or after is None:
        return {}
    pairs = {name: (before.inputs[name], after.inputs.get(name)) for name in before.inputs}
    return {name: (one, other) for name, (one, other) in pairs.items() if not _is_equal(one, other)}


def _is_equal(one: object, other: object) -> bool:
    if isinstance(one, int | float) and isinstance(other, int | float):
        return math.isclose(one, other, rel_tol=SAME, abs_tol=1e-9)
    return one == other


def _difference(change: PieceChange) -> float:
    if change.before is None or change.after is None or change.direction == Direction.UNCLEAR:
        return 0.0
    return change.after.chance.probability - change.before.chance.probability


def _compare_states(before: PastState | None, after: PastState | None, is_comparable: bool) -> StateChange:
    one = _either(after, before)
    direction, is_within = _direct_state(before, after, is_comparable)
    return StateChange(
        name=one.name,
        floor=one.floor,
        before=before,
        after=after,
        direction=direction,
        is_within=is_within,
    )


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


def _either(one: _Row | None, other: _Row | None) -> _Row:
    found = other if one is None else one
    if found is None:
        raise ValueError("a change has neither side")
    return found


# ---------------------------------------------------------------- sampling


def lies_within(before: PastChance, after: PastChance) -> bool | None:
    """Whether no difference of two chances can be told from their intervals; None where one has no interval.

    The interval of the difference is that of two independent samples, from the interval of each. Runs with the same
    seed share their draws, which makes the true interval shorter: then this is on the safe side, and holds a difference
    for sampling that may be none.

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
    sums = [_sum(side) for side in (before, after)]
    has_basis = is_comparable and all(one.low is not None for one in sums)
    is_within = lies_within(*sums) if has_basis else None
    return Total(sums[0].probability, sums[1].probability, is_comparable, is_within)


def _sum(pieces: Sequence[PastPiece]) -> PastChance:
    def total(read: Callable[[PastChance], float | None]) -> float | None:
        values = [(one.quantity, read(one.chance)) for one in pieces]
        known = [quantity * value for quantity, value in values if value is not None]
        return math.fsum(known) if len(known) == len(values) else None

    expected = total(lambda one: one.probability) or 0.0
    return PastChance(expected, total(lambda one: one.low), total(lambda one: one.high))


def count_states(rows: Iterable[PastState]) -> Counter[str]:
    """Count routes or rooms by their states."""
    return Counter(one.state for one in rows)


def list_states(*runs: Iterable[PastState]) -> list[str]:
    """Return the states of the routes, or rooms, of runs: from the worst down, then those without a place in that."""
    there = {one.state for rows in runs for one in rows}
    return sorted(there, key=lambda state: (-SEVERITY.get(state, 0 if state == NOT_KNOWN else -1), state))
