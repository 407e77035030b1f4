"""What every evaluation of routes starts from: the segments, how pieces fall, and which of them are blocked by that."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from assess.inventory.model import Inventory, Segment
from assess.methods._method import BoolArray
from assess.routes.couplings import Couplings, Happens, build_couplings, find_chances
from assess.routes.falls import Falls
from assess.routes.gaps import Key
from assess.routes.model import Chance, Outlook, RouteState
from assess.routes.reach import Reached

Blocking = Callable[[BoolArray], BoolArray]
"""Tells for each of m draws (m, n) of which pieces fell which of all segments are blocked (m, all)."""


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

    def segments_of(self, route: str) -> Mapping[int, Segment]:
        """Return the segments of a route by their number."""
        return {at: one.segment for at, one in enumerate(self.reached) if one.segment.route == route}

    def keys(self, segments: Iterable[int], *, anchors_fail: bool = False) -> tuple[Key, ...]:
        """Return the pieces that reach any of some segments: the free-standing ones, or all of them."""
        found = {key for at in segments for key in self.reached[at].gaps.keys}
        return tuple(sorted(key for key in found if anchors_fail or not self.falls.anchored[key[0]]))

    def couplings(self, keys: tuple[Key, ...]) -> Couplings:
        """Return how pieces fall together."""
        if keys not in self._couplings:
            self._couplings[keys] = build_couplings(self.falls, keys, self.seed)
        return self._couplings[keys]

    def blocking(self, segments: Iterable[int], keys: tuple[Key, ...]) -> Blocking:
        """Return what tells which of some segments are blocked where pieces `keys` fell; the others count as open."""
        own = {at: self.picking(at, keys) for at in segments}

        def blocked(fell: BoolArray) -> BoolArray:
            found = np.zeros((len(fell), len(self.reached)), dtype=np.bool_)
            for at, pick in own.items():
                one = self.reached[at]
                found[:, at] = one.narrows(pick(fell), one.required)
            return found

        return blocked

    def taking(self, segments: Iterable[int], keys: tuple[Key, ...]) -> Happens:
        """Return what tells whether any of some segments is narrowed at all (m,) where pieces `keys` fell."""
        own = [(self.reached[at], self.picking(at, keys)) for at in segments]

        def taken(fell: BoolArray) -> BoolArray:
            found = np.zeros(len(fell), dtype=np.bool_)
            for one, pick in own:
                found |= one.narrows(pick(fell), one.standing)
            return found

        return taken

    def chances(self, segments: Iterable[int], happens: Callable[[tuple[Key, ...]], Happens]) -> list[Chance]:
        """Return the chances of what `happens` with the pieces that it is given, if all anchors hold."""
        keys = self.keys(segments)
        return find_chances(self.couplings(keys), happens(keys), self.z)

    def chances_unanchored(
        self, segments: Iterable[int], happens: Callable[[tuple[Key, ...]], Happens]
    ) -> list[Chance] | None:
        """Return the same with anchored pieces taken as free-standing; None where there are none."""
        segments = tuple(segments)
        keys = self.keys(segments, anchors_fail=True)
        if not any(self.falls.anchored[item] for item, _ in keys):
            return None
        return find_chances(self.couplings(keys), happens(keys), self.z)

    def outlook(self, segments: Sequence[int], is_blocked: Callable[[BoolArray], BoolArray]) -> Outlook:
        """Return the outlook of some segments together; `is_blocked` (m,) tells from those that are (m, all)."""

        def happens(keys: tuple[Key, ...]) -> Happens:
            blocking, taking = self.blocking(segments, keys), self.taking(segments, keys)

            def both(fell: BoolArray) -> BoolArray:
                blocked = is_blocked(blocking(fell))
                return np.column_stack((blocked, blocked | taking(fell)))

            return both

        blocked, taken = self.chances(segments, happens)
        unanchored, keys = self.chances_unanchored(segments, happens), self.keys(segments)
        in_record, together = self._in_record(keys, happens(keys)), self.together(keys, happens(keys))
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

    def together(self, keys: tuple[Key, ...], happens: Happens) -> dict[int, float]:
        """Return for each piece the chance that it falls while the first of what `happens` does, where there is any."""
        draws = self.couplings(keys).joint
        happened = happens(draws.fell)
        share = (draws.weight * (happened[:, 0] if happened.ndim == 2 else happened)) @ draws.fell
        found: dict[int, float] = {}
        for (item, _), value in zip(keys, share, strict=True):
            found[item] = max(found.get(item, 0.0), float(value))
        return {item: value for item, value in found.items() if value > 0}

    def _state(self, blocked: float, taken: float) -> RouteState:
        if blocked >= self.risk:
            return RouteState.BLOCKED
        return RouteState.REDUCED if taken >= self.risk else RouteState.OPEN

    def _in_record(self, keys: tuple[Key, ...], happens: Happens) -> RouteState | None:
        """Return the state under the recorded motion itself; a piece of which that is not known counts as standing."""
        known = self.falls.in_record[np.array([item for item, _ in keys], dtype=np.intp)]
        if not keys or np.isnan(known).all():
            return None
        blocked, taken = happens(known[np.newaxis] == 1)[0]
        return RouteState.BLOCKED if blocked else RouteState.REDUCED if taken else RouteState.OPEN

    def picking(self, segment: int, keys: tuple[Key, ...]) -> Happens:
        """Return what picks the pieces of a segment (m, c) from `keys` (m, n); those that are not among them stand."""
        place = {key: at for at, key in enumerate(keys)}
        columns = np.array([place.get(key, len(keys)) for key in self.reached[segment].gaps.keys], dtype=np.intp)

        def pick(fell: BoolArray) -> BoolArray:
            widened = np.column_stack((fell, np.zeros(len(fell), dtype=np.bool_)))
            return np.asarray(widened[:, columns], dtype=np.bool_)

        return pick
