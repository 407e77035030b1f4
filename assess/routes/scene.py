"""What every evaluation of routes starts from: the segments, how pieces fall, and which of them are blocked by that."""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from assess.inventory.model import Inventory, Segment
from assess.routes.bits import union
from assess.routes.couplings import ROUNDED, Couplings, Happens, build_couplings, find_chances
from assess.routes.draws import Draws
from assess.routes.falls import Falls
from assess.routes.gaps import Key
from assess.routes.model import Chance, Outlook, RouteState
from assess.routes.network import Blocked
from assess.routes.reach import Reached


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """The segments of a building with the pieces that reach them, and how those fall.

    `risk` is the chosen risk [-], `seed` that of draws, `z` the half width of intervals [-].
    """

    inventory: Inventory
    reached: Sequence[Reached]
    falls: Falls
    risk: float
    seed: int
    z: float
    _couplings: dict[tuple[Key, ...], Couplings] = field(default_factory=dict)
    _of_all: dict[bool, Couplings] = field(default_factory=dict)
    """Of all pieces, by whether anchors fail: those of fewer take from it what they may."""

    def segments_of(self, route: str) -> Mapping[int, Segment]:
        """Return the segments of a route by their number."""
        return {at: one.segment for at, one in enumerate(self.reached) if one.segment.route == route}

    def keys(self, segments: Iterable[int], *, anchors_fail: bool = False) -> tuple[Key, ...]:
        """Return the pieces that reach any of some segments: the free-standing ones, or all of them."""
        found = {key for at in segments for key in self.reached[at].keys}
        return tuple(sorted(key for key in found if anchors_fail or not self.falls.anchored[key[0]]))

    def couplings(self, segments: Iterable[int], *, anchors_fail: bool = False) -> Couplings:
        """Return how the pieces that reach any of some segments fall together."""
        keys = self.keys(segments, anchors_fail=anchors_fail)
        if keys not in self._couplings:
            takes_anchored = any(self.falls.anchored[item] for item, _ in keys)  # the same pieces, the same couplings
            self._couplings[keys] = build_couplings(self.falls, keys, self.seed, lambda: self._all(takes_anchored))
        return self._couplings[keys]

    def _all(self, anchors_fail: bool) -> Couplings:
        if anchors_fail not in self._of_all:
            keys = self.keys(range(len(self.reached)), anchors_fail=anchors_fail)
            self._of_all[anchors_fail] = build_couplings(self.falls, keys, self.seed)
        return self._of_all[anchors_fail]

    # ------------------------------------------------------------ what happens in draws

    def narrower(self, draws: Draws, segment: int, width: float) -> int:
        """Return the set of the draws in which what is left of a segment is narrower than a width [m].

        Pieces that the draws do not know of stand.
        """
        if (segment, width) not in draws.narrower:
            found = self.reached[segment].narrower(draws.fallen, draws.every, width)
            draws.narrower[segment, width] = found
        return draws.narrower[segment, width]

    def blocked(self, draws: Draws, segments: Iterable[int]) -> Blocked:
        """Return for each of some segments the set of the draws in which it is blocked."""
        return {at: self.narrower(draws, at, self.reached[at].required) for at in segments}

    def taken(self, draws: Draws, segments: Iterable[int]) -> int:
        """Return the set of the draws in which any of some segments is narrowed at all."""
        return union(self.narrower(draws, at, self.reached[at].standing) for at in segments)

    # ------------------------------------------------------------ chances

    def chances(self, segments: Collection[int], happens: Happens) -> list[Chance]:
        """Return the chances of what happens on some segments, if all anchors hold."""
        return find_chances(self.couplings(segments), happens, self.z)

    def chances_unanchored(self, segments: Collection[int], happens: Happens) -> list[Chance] | None:
        """Return the same with anchored pieces taken as free-standing; None where there are none."""
        if not any(self.falls.anchored[item] for item, _ in self.keys(segments, anchors_fail=True)):
            return None
        return find_chances(self.couplings(segments, anchors_fail=True), happens, self.z)

    def outlook(self, segments: Collection[int], is_blocked: Callable[[Blocked, int], int]) -> Outlook:
        """Return the outlook of some segments together.

        `is_blocked` tells from the sets of the draws in which segments are blocked, and that of all draws, in which of
        them they count as blocked together.
        """

        def happens(draws: Draws) -> Sequence[int]:
            blocked = is_blocked(self.blocked(draws, segments), draws.every)
            return blocked, blocked | self.taken(draws, segments)

        blocked, taken = self.chances(segments, happens)
        unanchored = self.chances_unanchored(segments, happens)
        together = self.together(segments, happens)
        in_record = self._in_record(segments, happens)
        least = in_record or RouteState.OPEN
        return Outlook(
            state=max(self._state(blocked.probability, taken.probability), least),
            upper=max(self._state(blocked.high, taken.high), least),
            blocked=blocked,
            taken=taken,
            if_anchors_fail=unanchored[0] if unanchored else None,
            in_record=in_record,
            blocker=max(together, key=lambda item: (together[item], -item), default=None),
        )

    def together(self, segments: Collection[int], happens: Happens, *, anchors_fail: bool = False) -> dict[int, float]:
        """Return for each piece the chance that it falls while the first of what happens does, where there is any."""
        couplings = self.couplings(segments, anchors_fail=anchors_fail)
        draws, happened = couplings.joint, happens(couplings.joint)[0]
        found: dict[int, float] = {}
        for key in couplings.keys:
            value = round(draws.share(happened & draws.fallen[key]), ROUNDED)
            found[key[0]] = max(found.get(key[0], 0.0), value)
        return {item: value for item, value in found.items() if value > 0}

    def _state(self, blocked: float, taken: float) -> RouteState:
        if blocked >= self.risk:
            return RouteState.BLOCKED
        return RouteState.REDUCED if taken >= self.risk else RouteState.OPEN

    def _in_record(self, segments: Collection[int], happens: Happens) -> RouteState | None:
        """Return the state under the recorded motion itself; a piece of which that is not known counts as standing."""
        keys = self.keys(segments)
        known = self.falls.in_record[np.array([item for item, _ in keys], dtype=np.intp)]
        if not keys or np.isnan(known).all():
            return None
        blocked, taken = happens(Draws.of(keys, known[np.newaxis] == 1, np.ones(1)))
        return RouteState.BLOCKED if blocked else RouteState.REDUCED if taken else RouteState.OPEN
