"""What every evaluation of routes starts from: the segments, how pieces fall, and which of them are blocked by that.

The workbook may leave open which furniture could reach a segment, and how wide it is. What is assumed on the safe side,
such as a Clear width as small as the required one, does not count as missing. Pieces are left out where it is not known
whether they reach a segment: free-standing ones that may fall, on the floor of the segment, and not in another room
than those that it runs through. Whether they matter depends on how likely any of them falls, all of them together:
`combine` bounds the chance of a blockage by that.
"""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, TypedDict, TypeVar, cast

import numpy as np

from assess.methods.simulate import interval_width
from assess.model import Inventory, Segment
from assess.progress import SILENT, Progress
from assess.risk import wilson_interval
from assess.route_results import DOUBTS, Chance, MissingRow, PieceRef, RouteState, find_state, join_missing
from assess.routes.chances import Couplings, Draws, Falls, Happens, Key, build_couplings, find_chances, union
from assess.routes.network import Blocked, IsBlocked, build_course
from assess.routes.obstructions import Obstructions, is_stair, is_walled_off
from assess.routes.widths import kinds_of
from assess.settings import Settings

_Found = TypeVar("_Found")


@dataclass(frozen=True, slots=True)
class Verdict:
    """A state; where it is not known, whether unconfirmed pieces and what is missing could change it."""

    state: RouteState
    by_unconfirmed: bool = False
    by_missing: bool = False


class Outlook(TypedDict):
    """The fields that the rows of segments and routes have in common."""

    state: RouteState
    missing: tuple[MissingRow, ...]
    blocked: Chance | None
    blocked_or_reduced: Chance | None
    blocked_if_unconfirmed_fall: Chance | None
    blocked_if_anchors_fail: Chance | None
    under_record: RouteState | None
    most_likely_piece: PieceRef | None


@dataclass(frozen=True, slots=True)
class Settled:
    """A state, and the chances that it follows from: with unconfirmed pieces standing, and with them fallen.

    `under_record` is the state under the recorded motion itself, where that is known.
    """

    verdict: Verdict
    standing: Sequence[Chance]
    fallen: Sequence[Chance]
    under_record: RouteState | None

    @property
    def if_unconfirmed_fall(self) -> Chance | None:
        """The chance with unconfirmed pieces fallen; None where there are none."""
        return self.fallen[0] if self.standing[0].unconfirmed else None


@dataclass(frozen=True, slots=True)
class Judgement:
    """The chances of several things if all anchors hold; of the first, also if anchors fail, and the likeliest piece.

    `chances` are those with unconfirmed pieces standing, `at_most` those with them fallen: the same ones where there
    are none. `if_anchors_fail` has them fallen; it is None where there are no anchored pieces.
    """

    chances: list[Chance]
    at_most: list[Chance]
    if_anchors_fail: Chance | None
    most_likely_piece: PieceRef | None


def combine(known: Chance, worst: Chance, any_falls: tuple[float, float]) -> Chance:
    """Return the chance of a blockage at worst, as far as left-out pieces can raise it.

    `known` is without them, `worst` with every segment blocked that they may reach, `any_falls` how likely any of them
    falls and its upper end [-]: a blockage needs one of them, or happens without. That is the sum at most, less the
    product where falls are independent or positively correlated, as they are in one earthquake.
    """
    chance, high = any_falls
    return replace(
        worst,
        probability=min(worst.probability, known.probability + (1 - known.probability) * chance),
        high=min(worst.high, known.high + (1 - known.high) * high),
    )


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """The segments of a building with the pieces that reach them, and how those fall.

    `risk` is the chosen risk [-], `seed` that of draws, `z` the half width of intervals [-].
    """

    inventory: Inventory
    obstructions: tuple[Obstructions, ...]
    falls: Falls
    risk: float
    seed: int
    z: float
    progress: Progress = SILENT
    _kept: dict[Any, Any] = field(default_factory=dict)
    """What was worked out before, by what it is of."""

    @classmethod
    def of(
        cls, inventory: Inventory, obstructions: Sequence[Obstructions], falls: Falls, settings: Settings,
        progress: Progress = SILENT,
    ) -> "Scene":  # fmt: skip
        """Build the scene of a run."""
        z = interval_width(settings)
        return cls(inventory, tuple(obstructions), falls, settings.route_risk, settings.seed, z, progress)

    def _keep(self, of: Any, make: Callable[[], _Found]) -> _Found:
        if of not in self._kept:
            self._kept[of] = make()
        return cast(_Found, self._kept[of])

    def with_held(self, items: Iterable[int]) -> "Scene":
        """Return the scene with further pieces (indices) anchored."""
        held = frozenset(items)

        def make() -> Scene:
            anchored = self.falls.anchored.copy()
            anchored[list(held)] = True
            return replace(self, falls=replace(self.falls, anchored=anchored), _kept={})

        return self._keep(("held", held), make)

    def segments_of(self, route: str) -> dict[int, Segment]:
        """Return the segments of a route by their number."""
        return {at: one.segment for at, one in enumerate(self.obstructions) if one.segment.route == route}

    def course(self, segments: Mapping[int, Segment]) -> IsBlocked:
        """Return when a route of some segments counts as blocked."""
        return build_course(segments, kinds_of(self.inventory.places))

    def missing(self, segment: int) -> tuple[MissingRow, ...]:
        """Return what is missing of a segment; of pieces that are left out, whether or not they matter."""
        return self._keep(("missing", segment), lambda: self._find_missing(segment))

    def _find_missing(self, at: int) -> tuple[MissingRow, ...]:
        one, items = self.obstructions[at], self.inventory.items
        segment = one.segment
        own = [(f"{segment.route}: {segment.segment}", segment.row)]
        if one.is_blocked_standing or (is_stair(one.segment) and not self.is_unknown(at)):
            return ()
        if is_stair(one.segment):
            pieces = [(near.item, near.row) for near in one.pieces]
            width = self._row("clear_width", own, "Routes", "clear_width")
            return width, *([self._row("stair_pieces", pieces, "Items", "route")] if pieces else [])
        left_out, found = [items[index] for index in self.left_out(at)], []
        if one.band is None and (left_out or self.is_unknown(at)):  # why it is not known where it lies
            ends = [name for name in (segment.start, segment.end) if name]
            places = [place for name in ends for place in self.inventory.places if place.place == name]
            if len(ends) < 2 or not places:
                found.append(self._row("ends", own, "Routes", "start"))
            elif len({place.floor for place in places}) > 1:
                found.append(self._row("stair_floor", own, "Routes", "floor"))
            else:
                without = [place for place in places if place.x is None or place.y is None] or places
                found.append(self._row("places", [(place.place, place.row) for place in without], "Places", "x"))
        unplaced = [(item.item, item.row) for item in left_out if item.x is None or item.y is None]
        if unplaced:
            found.append(self._row("positions", unplaced, "Items", "x"))
        if not items:
            cell = self.inventory.locate("Items", 2, "item")
            found.append(MissingRow(what="furniture", cells=(f"Items!{cell}",)))
        return tuple(found)

    def _row(self, what: str, named: Sequence[tuple[str, int]], sheet: str, field: str) -> MissingRow:
        """Return what is to be filled in, of things by their names and rows of a sheet."""
        cells = tuple(f"{sheet}!{self.inventory.locate(sheet, row, field)}" for _, row in named)
        return MissingRow(what=what, names=tuple(name for name, _ in named), cells=cells)

    def left_out(self, segment: int) -> tuple[int, ...]:
        """Return the pieces (indices) that may fall and of which it is not known whether they reach a segment."""
        one, falls = self.obstructions[segment], self.falls

        def find() -> tuple[int, ...]:
            if one.is_blocked_standing or not one.segment.floor:
                return ()
            return tuple(
                at for at, item in enumerate(self.inventory.items)
                if item.floor == one.segment.floor and not item.route
                and (item.x is None or item.y is None or one.band is None) and not is_walled_off(item, one.segment)
                and not (falls.anchored[at] or falls.stands[at]) and (falls.high[at] > 0 or falls.in_record[at] == 1)
            )  # fmt: skip

        return self._keep(("left out", segment), find)

    def any_left_out_falls(self, segments: Iterable[int]) -> tuple[float, float]:
        """Return how likely any piece falls that is left out of some segments, and the upper end [-].

        As of pieces that reach a segment: from the joint outcomes where all were simulated in the same number of draws;
        else the larger one of that, with all others independent, and of all of them independent. 1 where any fell under
        the recorded motion itself.
        """
        falls, items = self.falls, {item for at in segments for item in self.left_out(at)}
        if any(falls.in_record[at] == 1 for at in items):
            return 1.0, 1.0

        def none_falls(own: list[int]) -> tuple[float, float]:
            """Return the chance that none of some pieces falls, all independently, and its lower end [-]."""
            none, low = (np.prod((1 - one[own]) ** falls.quantity[own]) for one in (falls.probability, falls.high))
            return float(none), float(low)

        simulated: dict[int, list[int]] = {}
        for at in items:
            if at in falls.fell:
                simulated.setdefault(falls.fell[at].size, []).append(at)
        none, none_high = none_falls([at for at in items if at not in falls.fell])
        for runs, own in simulated.items():
            count = np.column_stack([falls.fell[at] for at in own]).any(axis=1).sum()
            high = float(wilson_interval(count, runs, self.z)[1])
            none, none_high = none * (1 - count / runs), none_high * (1 - high)
        if len(simulated) == 1 and items <= falls.fell.keys():
            return float(1 - none), 1 - none_high
        alone, alone_high = none_falls(list(items))
        return float(1 - min(none, alone)), 1 - min(none_high, alone_high)

    def is_unknown(self, segment: int) -> bool:
        """Tell whether nothing is known of a segment, whatever falls: its width, its floor or its furniture."""
        one, items = self.obstructions[segment], self.inventory.items
        if one.is_blocked_standing:
            return False
        if is_stair(one.segment):
            return one.segment.clear_width is None
        if not items or one.band is not None:
            return not items
        is_listed = one.is_evaluated or any(item.floor == one.segment.floor for item in items)
        return not one.segment.floor or not is_listed

    def is_evaluated(self, segment: int) -> bool:
        """Tell whether it is known which pieces can reach a segment, or those left out hardly fall, all together."""
        one = self.obstructions[segment]
        if one.is_evaluated:
            return bool(self.inventory.items) or is_stair(one.segment) or one.is_blocked_standing
        return not self.is_unknown(segment) and self.any_left_out_falls([segment])[1] < self.risk

    def piece(self, item: int) -> PieceRef:
        """Return the reference to a piece by its index."""
        return PieceRef(item=self.inventory.items[item].item, row=self.inventory.items[item].row, item_index=item)

    def keys(self, segments: Iterable[int], *, anchors_fail: bool = False) -> tuple[Key, ...]:
        """Return the pieces that reach any of some segments and can rock: the free-standing ones, or all of them."""
        out = self.falls.stands if anchors_fail else self.falls.stands | self.falls.anchored
        found = {key for at in segments for key in self.obstructions[at].keys}
        return tuple(sorted(key for key in found if not out[key[0]]))

    def couplings(
        self, segments: Iterable[int], *, anchors_fail: bool = False, unconfirmed_fall: bool = False
    ) -> Couplings:
        """Return how the pieces that reach any of some segments fall together; unconfirmed ones stand by default."""
        keys = self.keys(segments, anchors_fail=anchors_fail)
        fall = unconfirmed_fall and any(item in self.falls.unconfirmed for item, _ in keys)

        build = partial(build_couplings, self.falls, seed=self.seed, progress=self.progress, unconfirmed_fall=fall)

        def of_all() -> Couplings:
            """Return the couplings of all pieces: those of fewer share its draws."""
            takes_anchored = any(self.falls.anchored[item] for item, _ in keys)  # the same pieces, the same couplings
            every = self.keys(range(len(self.obstructions)), anchors_fail=takes_anchored)
            return self._keep((takes_anchored, fall), lambda: build(every))

        def make() -> Couplings:
            self.progress.check()
            return build(keys, of_all=of_all)

        return self._keep((keys, fall), make)

    def narrower(self, draws: Draws, segment: int, width: float) -> int:
        """Return the set of the draws in which the width left is under a width [m]; pieces not in the draws stand."""
        if (segment, width) not in draws.narrower:
            self.progress.check()
            found = self.obstructions[segment].narrower(draws.fallen, draws.every, width)
            draws.narrower[segment, width] = found
        return draws.narrower[segment, width]

    def blocked(self, draws: Draws, segments: Iterable[int]) -> Blocked:
        """Return for each of some segments the set of the draws in which it is blocked."""
        return {at: self.narrower(draws, at, self.obstructions[at].required) for at in segments}

    def when_blocked(self, segments: Collection[int], is_blocked: IsBlocked) -> Happens:
        """Return what returns the set of the draws in which some segments are blocked together."""
        return lambda draws: [is_blocked(self.blocked(draws, segments), draws.every)]

    def together(self, segments: Collection[int], happens: Happens, *, anchors_fail: bool = False) -> dict[int, float]:
        """Return for each piece the chance that it falls while the first of what happens does, where there is any.

        Unconfirmed pieces stand, or fall where anchors fail.
        """
        couplings = self.couplings(segments, anchors_fail=anchors_fail, unconfirmed_fall=anchors_fail)
        draws, happened = couplings.joint, happens(couplings.joint)[0]
        found: dict[int, float] = {}
        for key in couplings.keys:
            found[key[0]] = max(found.get(key[0], 0.0), draws.share(happened & draws.fallen[key]))
        return {item: value for item, value in found.items() if value > 0}

    def bounds(self, segments: Collection[int], happens: Happens) -> tuple[list[Chance], list[Chance]]:
        """Return chances if all anchors hold, unconfirmed pieces standing and fallen: the same list without any."""
        standing = self.couplings(segments)
        chances = find_chances(standing, happens, self.z)
        if not standing.unconfirmed:
            return chances, chances
        return chances, find_chances(self.couplings(segments, unconfirmed_fall=True), happens, self.z)

    def is_known(self, standing: Chance, fallen: Chance) -> bool:
        """Tell whether two chances, the second of which is the larger one, lie on one side of the chosen risk."""
        return (standing.probability >= self.risk) == (fallen.probability >= self.risk)

    def judge(self, segments: Collection[int], happens: Happens) -> Judgement:
        """Return the chances of what happens on some segments, and what decides the first of them."""
        has_anchored = any(self.falls.anchored[item] for item, _ in self.keys(segments, anchors_fail=True))
        together = self.together(segments, happens)
        likeliest = max(together, key=lambda item: (together[item], -item), default=None)
        chances, at_most = self.bounds(segments, happens)
        if_anchors_fail = None
        if has_anchored:
            failed = self.couplings(segments, anchors_fail=True, unconfirmed_fall=True)
            if_anchors_fail = find_chances(failed, happens, self.z)[0]
        return Judgement(chances, at_most, if_anchors_fail, None if likeliest is None else self.piece(likeliest))

    def outlook(self, segments: Collection[int], is_blocked: IsBlocked, *, is_evaluated: bool) -> Outlook:
        """Return the outlook of some segments together; without chances where they are not evaluated."""

        def happens(draws: Draws) -> tuple[int, ...]:
            best, *others = self.at_best_and_worst(draws, segments, is_blocked)
            narrowed = union(self.narrower(draws, at, self.obstructions[at].standing) for at in segments)
            return best, *others, best | narrowed

        found = self.judge(segments, happens)
        settled = self.settle(segments, happens, found)
        return Outlook(
            state=settled.verdict.state, missing=self.list_missing(settled.verdict, segments),
            blocked=found.chances[0] if is_evaluated else None,
            blocked_or_reduced=found.chances[-1] if is_evaluated else None,
            blocked_if_unconfirmed_fall=settled.if_unconfirmed_fall if is_evaluated else None,
            blocked_if_anchors_fail=found.if_anchors_fail, under_record=settled.under_record,
            most_likely_piece=found.most_likely_piece,
        )  # fmt: skip

    def at_best_and_worst(self, draws: Draws, segments: Collection[int], is_blocked: IsBlocked) -> tuple[int, int, int]:
        """Return the sets of the draws in which segments are blocked together, by what is missing.

        It leaves all open; those are blocked of which nothing is known; those as well that left-out pieces may reach.
        """
        own = self.blocked(draws, segments)
        unknown = [at for at in segments if self.is_unknown(at)]
        reached = [at for at in segments if self.left_out(at)]
        best = is_blocked(own, draws.every)
        known = is_blocked({**own, **dict.fromkeys(unknown, draws.every)}, draws.every) if unknown else best
        blocked = dict.fromkeys([*unknown, *reached], draws.every)
        return best, known, is_blocked({**own, **blocked}, draws.every) if reached else known

    def settle(self, segments: Collection[int], happens: Happens, judged: Judgement | None = None) -> Settled:
        """Return the state of some segments; `happens` returns what `at_best_and_worst` does.

        It is not known where it could be another, unless it is blocked at best. `judged` are its chances, where known.
        """
        standing, fallen = (judged.chances, judged.at_most) if judged else self.bounds(segments, happens)
        any_falls, keys, record = self.any_left_out_falls(segments), self.keys(segments), None
        known = self.falls.in_record[np.array([item for item, _ in keys], dtype=np.intp)]
        if keys and not np.isnan(known).all():  # pieces of which that is not known count as standing
            blocked, *_ = happens(Draws.of(keys, known[np.newaxis] == 1, np.ones(1)))
            record = RouteState.BLOCKED if blocked else RouteState.OPEN
        at_most = [combine(one[1], one[2], any_falls) for one in (standing, fallen)]
        best, if_missing, if_fallen, worst = (
            find_state(one, self.risk, record) for one in (standing[0], at_most[0], fallen[0], at_most[1])
        )
        verdict = Verdict(best)
        if best not in (worst, RouteState.BLOCKED):
            by_unconfirmed, by_missing = if_fallen != best, if_missing != best
            verdict = Verdict(
                RouteState.NOT_KNOWN,
                by_unconfirmed=by_unconfirmed or not by_missing, by_missing=by_missing or not by_unconfirmed,
            )  # fmt: skip
        return Settled(verdict, standing, fallen, record)

    def list_missing(self, verdict: Verdict, segments: Collection[int]) -> tuple[MissingRow, ...]:
        """Return what is to be filled in so that the state of some segments is known; nothing where it is."""
        rows = [row for at in segments for row in self.missing(at)] if verdict.by_missing else []
        if verdict.by_unconfirmed:
            reaching = sorted({item for item, _ in self.keys(segments)} & self.falls.unconfirmed.keys())
            for flag in DOUBTS.values():
                items = [item for item in reaching if flag in self.falls.unconfirmed[item]]
                if items:
                    names = tuple(self.inventory.items[item].item for item in items)
                    rows.append(MissingRow(what=flag, names=names))
        return join_missing(rows)

    def find_decisive(self, rows: Mapping[int, tuple[RouteState, Chance | None]], *, is_known: bool) -> int | None:
        """Return which segment decides the state of several, by the state and chance of each; None where none does.

        Where it is not known the first that is not, or of which something is missing; else the one most likely blocked.
        """
        if not is_known:
            return next(
                (at for at, (state, _) in rows.items() if state == RouteState.NOT_KNOWN),
                next((at for at in rows if self.missing(at)), None),
            )
        chances = {at: chance.probability for at, (_, chance) in rows.items() if chance and chance.high > 0}
        return max(chances, key=lambda at: chances[at], default=None)
