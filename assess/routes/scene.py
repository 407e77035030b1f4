"""What every evaluation of routes starts from: the segments, how pieces fall, and which of them are blocked by that."""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypedDict, TypeVar, cast

import numpy as np

from assess.model import Inventory, Segment
from assess.progress import SILENT, Progress
from assess.route_results import DOUBTS, Chance, MissingRow, PieceRef, RouteState, find_state, join_missing
from assess.routes.chances import Couplings, Draws, Falls, Happens, Key, build_couplings, find_chances, union
from assess.routes.missing import combine, find_any_falls, find_missing, is_unknown, list_left_out
from assess.routes.network import Blocked
from assess.routes.obstructions import Obstructions

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
    """A state, and the chances that it follows from: with unconfirmed pieces standing, and with them fallen."""

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

    def missing(self, segment: int) -> tuple[MissingRow, ...]:
        """Return what is missing of a segment; of pieces that are left out, whether or not they matter."""
        one = self.obstructions[segment]
        return self._keep(("missing", segment), lambda: find_missing(one, self.inventory, self.left_out(segment)))

    def left_out(self, segment: int) -> tuple[int, ...]:
        """Return the pieces (indices) that may fall and of which it is not known whether they reach a segment."""
        one = self.obstructions[segment]
        return self._keep(("left out", segment), lambda: tuple(list_left_out(one, self.inventory, self.falls)))

    def any_left_out_falls(self, segments: Iterable[int]) -> tuple[float, float]:
        """Return how likely any piece falls that is left out of some segments, and the upper end [-]."""
        return find_any_falls(self.falls, {item for at in segments for item in self.left_out(at)}, self.z)

    def is_unknown(self, segment: int) -> bool:
        """Tell whether nothing is known of a segment, whatever falls."""
        return is_unknown(self.obstructions[segment], self.inventory)

    def is_evaluated(self, segment: int) -> bool:
        """Tell whether it is known which pieces can reach a segment, or those left out hardly fall, all together."""
        one = self.obstructions[segment]
        if one.is_evaluated:
            return bool(self.inventory.items) or one.is_stair or one.is_blocked_standing
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

        def make() -> Couplings:
            self.progress.check()
            takes_anchored = any(self.falls.anchored[item] for item, _ in keys)  # the same pieces, the same couplings
            return build_couplings(
                self.falls, keys, self.seed, lambda: self._all(takes_anchored, fall), self.progress,
                unconfirmed_fall=fall,
            )  # fmt: skip

        return self._keep((keys, fall), make)

    def _all(self, anchors_fail: bool, fall: bool) -> Couplings:
        """Return the couplings of all pieces: those of fewer share its draws."""
        keys = self.keys(range(len(self.obstructions)), anchors_fail=anchors_fail)
        return self._keep(
            (anchors_fail, fall),
            lambda: build_couplings(self.falls, keys, self.seed, progress=self.progress, unconfirmed_fall=fall),
        )

    def narrower(self, draws: Draws, segment: int, width: float) -> int:
        """Return the set of the draws in which the width left of a segment is under a width [m].

        Pieces that the draws do not contain stand.
        """
        if (segment, width) not in draws.narrower:
            self.progress.check()
            found = self.obstructions[segment].narrower(draws.fallen, draws.every, width)
            draws.narrower[segment, width] = found
        return draws.narrower[segment, width]

    def blocked(self, draws: Draws, segments: Iterable[int]) -> Blocked:
        """Return for each of some segments the set of the draws in which it is blocked."""
        return {at: self.narrower(draws, at, self.obstructions[at].required) for at in segments}

    def narrowed(self, draws: Draws, segments: Iterable[int]) -> int:
        """Return the set of the draws in which any of some segments is narrowed at all."""
        return union(self.narrower(draws, at, self.obstructions[at].standing) for at in segments)

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
        """Return the chances of what happens on some segments if all anchors hold.

        With unconfirmed pieces standing, and with them fallen: the same list where there are none.
        """
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

    def outlook(
        self, segments: Collection[int], is_blocked: Callable[[Blocked, int], int], *, is_evaluated: bool
    ) -> Outlook:
        """Return the outlook of some segments together; without chances where they are not evaluated.

        `is_blocked` returns the set of the draws in which they count as blocked together, from those in which segments
        are blocked, and the set of all draws.
        """

        def happens(draws: Draws) -> tuple[int, int, int, int]:
            found = self.at_best_and_worst(draws, segments, is_blocked)
            return *found, found[0] | self.narrowed(draws, segments)

        found = self.judge(segments, happens)
        settled = self.settle(segments, happens, found)
        return Outlook(
            state=settled.verdict.state,
            missing=self.list_missing(settled.verdict, segments),
            blocked=found.chances[0] if is_evaluated else None,
            blocked_or_reduced=found.chances[-1] if is_evaluated else None,
            blocked_if_unconfirmed_fall=settled.if_unconfirmed_fall if is_evaluated else None,
            blocked_if_anchors_fail=found.if_anchors_fail,
            under_record=settled.under_record,
            most_likely_piece=found.most_likely_piece,
        )

    def at_best_and_worst(
        self, draws: Draws, segments: Collection[int], is_blocked: Callable[[Blocked, int], int]
    ) -> tuple[int, int, int]:
        """Return the sets of the draws in which segments are blocked together, by what is missing.

        It leaves all open; those are blocked of which nothing is known; those as well that left-out pieces may reach.
        `is_blocked` is as in `outlook`.
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
        any_falls, record = self.any_left_out_falls(segments), self.under_record(segments, happens)
        at_most = [combine(one[1], one[2], any_falls) for one in (standing, fallen)]
        best, if_missing, if_fallen, worst = (
            find_state(one, self.risk, record) for one in (standing[0], at_most[0], fallen[0], at_most[1])
        )
        verdict = Verdict(best)
        if best not in (worst, RouteState.BLOCKED):
            by_unconfirmed, by_missing = if_fallen != best, if_missing != best
            verdict = Verdict(
                RouteState.NOT_KNOWN,
                by_unconfirmed=by_unconfirmed or not by_missing,
                by_missing=by_missing or not by_unconfirmed,
            )
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

    def under_record(self, segments: Collection[int], happens: Happens) -> RouteState | None:
        """Return the state under the recorded motion itself; pieces of which that is not known count as standing."""
        keys = self.keys(segments)
        known = self.falls.in_record[np.array([item for item, _ in keys], dtype=np.intp)]
        if not keys or np.isnan(known).all():
            return None
        blocked, *_ = happens(Draws.of(keys, known[np.newaxis] == 1, np.ones(1)))
        return RouteState.BLOCKED if blocked else RouteState.OPEN
