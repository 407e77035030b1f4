"""The gaps between fallen pieces and the walls of a segment, and the clear width that they leave.

A person of a given width passes unless a chain of pieces leads from one wall to the other with every gap on the way
narrower. The residual clear width is the smallest width that some chain cuts off: over all chains, the least of their
widest gaps. So pieces that face each other count together, and pieces far apart along the segment do not.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray, FloatArray
from assess.routes.chances import Key, union

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

SIDES: tuple[Literal["left", "right"], ...] = ("left", "right")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Obstacle:
    """Something that lies in a segment: a piece on the plan, or one that takes `depth` from a side.

    * `item`: index of the piece in the inventory.
    * `number`: 0, or 1 for a second piece of the same row.
    * `falls`: whether the piece has to fall for it to be there; else it stands there anyway.
    * `left`, `right`: gaps to the two walls [m].
    * `shape`: what it covers, in the band's own coordinates; None where its place along the segment is not known.
    * `side`: from which wall it reaches in, where its place is not known.
    """

    item: int
    number: int = 0
    falls: bool
    left: float
    right: float
    shape: "BaseGeometry | None" = None
    side: Literal["left", "right"] | None = None

    @property
    def key(self) -> Key:
        """The piece."""
        return self.item, self.number


@dataclass(frozen=True, slots=True, eq=False)
class Gaps:
    """All obstacles of a segment.

    * `keys`: the pieces that may fall.
    * `column` (m,): which of `keys` each obstacle needs; -1 where it stands there anyway.
    * `left`, `right` (m,): gaps to the walls [m].
    * `between` (m, m): gaps between two obstacles [m]; inf where the two cannot be there together.
    * `sided` (m,): number of the piece, from 1, of an obstacle that reaches in from the left, and its negative from the
      right; 0 for one on the plan.
    * `clear`: width with no obstacle [m].
    """

    keys: tuple[Key, ...]
    column: NDArray[np.intp]
    left: FloatArray
    right: FloatArray
    between: FloatArray
    sided: NDArray[np.intp]
    clear: float
    _chains: dict[float, list["_Chains"]] = field(default_factory=dict)
    """The chains of each width, kept once found."""

    def residual(self, fell: BoolArray) -> float:
        """Return the clear width left [m] where the pieces `fell` (n,)."""
        there, found = np.append(fell, True)[self.column], []
        for side in self._sides():
            own = np.flatnonzero(there & side)
            ways = np.full((2 + own.size, 2 + own.size), self.clear)
            ways[0, 2:] = ways[2:, 0] = self.left[own]
            ways[1, 2:] = ways[2:, 1] = self.right[own]
            ways[2:, 2:] = self.between[np.ix_(own, own)]
            for _ in own:  # the least widest gap of all ways from wall to wall, obstacle by obstacle
                ways = np.minimum(ways[:-1, :-1], np.maximum(ways[-1, :-1, np.newaxis], ways[-1, np.newaxis, :-1]))
            found.append(float(ways[0, 1]))
        return min(found)

    def narrower(self, fallen: Mapping[Key, int], every: int, width: float) -> int:
        """Return the set of the draws in which less than a width [m] is left: some chain has narrower gaps alone.

        `fallen` has for each piece the set of the draws in which it falls; others stand. `every`, the set of all draws,
        is returned where the segment itself is narrower.
        """
        if self.clear < width:
            return every
        if width not in self._chains:
            self._chains[width] = [_Chains.of(self, side, width) for side in self._sides()]
        there = [every if at < 0 else fallen.get(self.keys[at], 0) for at in self.column.tolist()]
        return union(one.lead(there) for one in self._chains[width])

    def _sides(self) -> list[BoolArray]:
        """Return which obstacles (m,) are considered together: never one piece on both sides.

        A chain takes at most one piece from either wall. The numbers of two pieces differ in some bit; by that bit, one
        is on the left and the other on the right, or the reverse.
        """
        if not self.sided.any() or (self.sided != 0).all():
            return [np.ones(self.sided.size, dtype=np.bool_)]  # on the plan all, or none of them: a pair is kept apart
        bits = range(max(1, int(np.abs(self.sided).max()).bit_length()))
        lefts = [(np.abs(self.sided) >> bit) & 1 == one for bit in bits for one in (0, 1)]
        return [(self.sided == 0) | ((self.sided > 0) == left) for left in lefts]


@dataclass(frozen=True, slots=True)
class _Chains:
    """The chains of gaps under a width, by obstacles.

    `alone` are too near to both walls, and need no other; `first` too near to the left wall only. `inner` are pairs too
    near to each other, one of which may be a first; `closing` such pairs of which the second is too near to the right
    wall only.
    """

    alone: list[int]
    first: list[int]
    inner: list[list[int]]
    closing: list[list[int]]

    @classmethod
    def of(cls, gaps: Gaps, side: BoolArray, width: float) -> "_Chains":
        """Find those of some obstacles (m,)."""
        left, right = side & (gaps.left < width), side & (gaps.right < width)
        alone, first, last, rest = left & right, left & ~right, right & ~left, side & ~left & ~right
        near, before = gaps.between < width, first | rest
        inner = np.triu(near & np.outer(before, before) & ~np.outer(first, first), 1)
        closing = near & np.outer(before, last)
        pairs = np.argwhere(inner).tolist(), np.argwhere(closing).tolist()
        return cls(np.flatnonzero(alone).tolist(), np.flatnonzero(first).tolist(), *pairs)

    def lead(self, there: Sequence[int]) -> int:
        """Return the set of the draws in which some chain leads from wall to wall, of obstacles `there` in sets."""
        reached = [0] * len(there)
        for at in self.first:
            reached[at] = there[at]
        changed = bool(self.first and self.closing)
        while changed:
            changed = False
            for one, other in self.inner:
                both = (reached[one] | reached[other]) & there[one] & there[other]
                if both & ~(reached[one] & reached[other]):
                    changed = True
                    reached[one] |= both
                    reached[other] |= both
        closed = union(reached[one] & there[end] for one, end in self.closing)
        return closed | union(there[at] for at in self.alone)


def build_gaps(obstacles: Sequence[Obstacle], clear: float) -> Gaps:
    """Return the gaps between obstacles, of which `clear` [m] is the width of the segment."""
    keys = tuple(sorted({one.key for one in obstacles if one.falls}))
    place = {key: at for at, key in enumerate(keys)}
    pieces = {key: at for at, key in enumerate(sorted({one.key for one in obstacles if one.side}), start=1)}
    sign = {"left": 1, "right": -1}
    left, right = (np.array([getattr(one, side) for one in obstacles], dtype=np.float64) for side in SIDES)
    sided = np.array([sign[one.side] * pieces[one.key] if one.side else 0 for one in obstacles], dtype=np.intp)
    column = np.array([place[one.key] if one.falls else -1 for one in obstacles], dtype=np.intp)
    # gaps between two: those whose place along the segment is not known may be abreast; two on one side, and one piece
    # on both sides, are never in one chain: inf
    placed, lefts, rights = (np.flatnonzero(one) for one in (sided == 0, sided > 0, sided < 0))
    between = np.full((sided.size, sided.size), math.inf)
    if placed.size > 1:
        from shapely import distance

        shapes = np.array([one.shape for one in obstacles if one.shape is not None])
        rows, columns = np.tril_indices(placed.size, -1)
        between[placed[rows], placed[columns]] = distance(shapes[rows], shapes[columns])
    for own, to_own, to_other in ((lefts, left, right), (rights, right, left)):
        between[np.ix_(own, placed)] = np.maximum(0.0, to_own[placed] - (clear - to_other[own])[:, np.newaxis])
    facing = np.maximum(0.0, right[lefts, np.newaxis] + left[rights] - clear)
    between[np.ix_(lefts, rights)] = np.where(sided[lefts, np.newaxis] == -sided[rights], math.inf, facing)
    return Gaps(keys, column, left, right, np.minimum(between, between.T), sided, clear)
