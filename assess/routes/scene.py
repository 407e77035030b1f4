"""What every evaluation of routes starts from: the segments, how pieces fall, and which of them are blocked by that."""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from assess.inventory.model import Inventory, Segment
from assess.methods._method import BoolArray, FloatArray
from assess.routes.couplings import ROUNDED, Couplings, Draws, Happens, build_couplings, find_chances
from assess.routes.falls import Falls
from assess.routes.gaps import Key
from assess.routes.model import Chance, Outlook, RouteState
from assess.routes.reach import Reached
from assess.routes.widths import NARROWER

WHOLE = -1
"""Under this number the array stands of which the segments are columns: column by column, as it is read so."""


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
    """Of all pieces, by whether anchors fail: those of pieces that are too many to go through take theirs from it."""

    def segments_of(self, route: str) -> Mapping[int, Segment]:
        """Return the segments of a route by their number."""
        return {at: one.segment for at, one in enumerate(self.reached) if one.segment.route == route}

    def keys(self, segments: Iterable[int], *, anchors_fail: bool = False) -> tuple[Key, ...]:
        """Return the pieces that reach any of some segments: the free-standing ones, or all of them."""
        found = {key for at in segments for key in self.reached[at].gaps.keys}
        return tuple(sorted(key for key in found if anchors_fail or not self.falls.anchored[key[0]]))

    def couplings(self, segments: Iterable[int], *, anchors_fail: bool = False) -> Couplings:
        """Return how the pieces that reach any of some segments fall together."""
        keys = self.keys(segments, anchors_fail=anchors_fail)
        if keys not in self._couplings:
            self._couplings[keys] = build_couplings(self.falls, keys, self.seed, lambda: self._all(anchors_fail))
        return self._couplings[keys]

    def _all(self, anchors_fail: bool) -> Couplings:
        if anchors_fail not in self._of_all:
            keys = self.keys(range(len(self.reached)), anchors_fail=anchors_fail)
            self._of_all[anchors_fail] = build_couplings(self.falls, keys, self.seed)
        return self._of_all[anchors_fail]

    # ------------------------------------------------------------ what happens in draws

    def width(self, draws: Draws, segment: int) -> FloatArray:
        """Return the clear width left of a segment (m,) [m]; pieces that the draws do not know of stand."""
        if segment not in draws.widths:
            gaps = self.reached[segment].gaps
            columns = [draws.place.get(key, -1) for key in gaps.keys]
            fell = draws.fell[:, columns] & (np.array(columns, dtype=np.intp) >= 0) if draws.place else None
            nothing = np.zeros((len(draws.weight), len(columns)), dtype=np.bool_)
            draws.widths[segment] = gaps.residual(nothing if fell is None else fell)
        return draws.widths[segment]

    def narrower(self, draws: Draws, segment: int, width: float) -> BoolArray:
        """Tell whether what is left of a segment (m,) is under a width [m]."""
        return np.asarray(self.width(draws, segment) < width - NARROWER, dtype=np.bool_)

    def blocked(self, draws: Draws, segments: Collection[int]) -> BoolArray:
        """Tell which of some segments are blocked (m, all segments); what stands of the others is not to be used."""
        if not draws.blocked:
            draws.blocked[WHOLE] = np.zeros((len(draws.weight), len(self.reached)), dtype=np.bool_, order="F")
        found = draws.blocked[WHOLE]
        for at in segments:
            if at not in draws.blocked:
                found[:, at] = self.narrower(draws, at, self.reached[at].required)
                draws.blocked[at] = found[:, at]
        return found

    def taken(self, draws: Draws, segments: Collection[int]) -> BoolArray:
        """Tell whether any of some segments is narrowed at all (m,)."""
        every = [self.narrower(draws, at, self.reached[at].standing) for at in segments]
        return np.asarray(np.any(every, axis=0), dtype=np.bool_)

    # ------------------------------------------------------------ chances

    def chances(self, segments: Collection[int], happens: Happens) -> list[Chance]:
        """Return the chances of what happens on some segments, if all anchors hold."""
        return find_chances(self.couplings(segments), happens, self.z)

    def chances_unanchored(self, segments: Collection[int], happens: Happens) -> list[Chance] | None:
        """Return the same with anchored pieces taken as free-standing; None where there are none."""
        if not any(self.falls.anchored[item] for item, _ in self.keys(segments, anchors_fail=True)):
            return None
        return find_chances(self.couplings(segments, anchors_fail=True), happens, self.z)

    def outlook(self, segments: Collection[int], is_blocked: Callable[[BoolArray], BoolArray]) -> Outlook:
        """Return the outlook of some segments together; `is_blocked` (m,) tells from those that are (m, all)."""

        def happens(draws: Draws) -> BoolArray:
            blocked = is_blocked(self.blocked(draws, segments))
            return np.column_stack((blocked, blocked | self.taken(draws, segments)))

        blocked, taken = self.chances(segments, happens)
        unanchored, together = self.chances_unanchored(segments, happens), self.together(segments, happens)
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
        draws, happened = couplings.joint, happens(couplings.joint)
        at = np.flatnonzero(happened[:, 0] if happened.ndim == 2 else happened)
        columns = [draws.place[key] for key in couplings.keys]
        share = draws.weight[at] @ draws.fell[np.ix_(at, np.array(columns, dtype=np.intp))]
        found: dict[int, float] = {}
        for (item, _), value in zip(couplings.keys, share, strict=True):
            found[item] = max(found.get(item, 0.0), round(float(value), ROUNDED))
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
        blocked, taken = happens(Draws(keys, known[np.newaxis] == 1, np.ones(1)))[0]
        return RouteState.BLOCKED if blocked else RouteState.REDUCED if taken else RouteState.OPEN
