"""The gaps between fallen pieces and the walls of a segment, and the clear width that they leave.

A person of a given width passes unless a chain of pieces leads from one wall to the other with every gap on the way
narrower. The residual clear width is the smallest width that some chain cuts off: over all chains, the least of their
widest gaps. So pieces that face each other count together, and pieces far apart along the segment do not.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from assess.methods._method import BoolArray, FloatArray

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

Key = tuple[int, int]
"""A piece that may fall: its index in the inventory, and 0, or 1 for a second piece of the same row."""
MOST = 4_000_000
"""Gaps that are worked on at once."""
MOST_KNOWN = 16
"""Pieces beside a segment up to which the widths of all that may fall together are kept."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Obstacle:
    """Something that lies in a segment: a piece on the plan, or one that takes `depth` from a side.

    Parameters
    ----------
    item : int
        Index of the piece in the inventory.
    number : int
        0, or 1 for a second piece of the same row.
    falls : bool
        Whether the piece has to fall for it to be there; else it stands there anyway.
    left, right : float
        Gaps to the two walls [m].
    shape : shapely geometry, optional
        What it covers, in the band's own coordinates; None where its place along the segment is not known.
    side : "left" or "right", optional
        From which wall it reaches in, where its place is not known.
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

    Parameters
    ----------
    keys : tuple of n keys
        The pieces that may fall.
    column : (m,) integer array
        Which of `keys` each obstacle needs; -1 where it stands there anyway.
    left, right : (m,) arrays
        Gaps to the walls [m].
    between : (m, m) array
        Gaps between two obstacles [m]; inf where the two cannot be there together.
    sided : (m,) integer array
        Number of the piece, from 1, of an obstacle that reaches in from the left, and its negative from the right; 0
        for one on the plan.
    clear : float
        Width with no obstacle [m].
    """

    keys: tuple[Key, ...]
    column: NDArray[np.intp]
    left: FloatArray
    right: FloatArray
    between: FloatArray
    sided: NDArray[np.intp]
    clear: float
    _known: list[FloatArray] = field(default_factory=list)
    """What has been worked out already, where the pieces are few: by the number whose bits are the fallen ones."""

    def residual(self, fell: BoolArray) -> FloatArray:
        """Return the clear width left (k,) [m] where the pieces `fell` (k, n)."""
        if len(self.keys) > MOST_KNOWN:
            first, back = find_distinct(fell)
            return self._compute(fell[first])[back]
        if not self._known:
            self._known.append(np.full(2 ** len(self.keys), np.nan))
        known, code = self._known[0], _encode(fell)
        lacking = np.unique(code[np.isnan(known[code])])
        if lacking.size:
            bits = (lacking[:, np.newaxis] >> np.arange(len(self.keys))) & 1
            known[lacking] = self._compute(bits.astype(np.bool_))
        return np.asarray(known[code], dtype=np.float64)

    def _compute(self, fell: BoolArray) -> FloatArray:
        size = max(1, MOST // max(1, self.column.size**2))
        parts = [self._residual(fell[at : at + size]) for at in range(0, len(fell), size)]
        return np.concatenate(parts) if parts else np.zeros(0)

    def _residual(self, fell: BoolArray) -> FloatArray:
        there = np.column_stack((fell, np.ones(len(fell), dtype=np.bool_)))[:, self.column]
        return np.asarray(np.min([self._narrowest(there & one) for one in self._sides()], axis=0), dtype=np.float64)

    def _sides(self) -> list[BoolArray]:
        """Return which obstacles (m,) are looked at together: never one piece on both sides.

        A chain takes at most one piece from either wall. The numbers of two pieces differ in some bit; by that bit, one
        is on the left and the other on the right, or the reverse.
        """
        if not self.sided.any() or (self.sided != 0).all():
            return [np.ones(self.sided.size, dtype=np.bool_)]  # on the plan all, or none of them: a pair is kept apart
        bits = range(max(1, int(np.abs(self.sided).max()).bit_length()))
        lefts = [(np.abs(self.sided) >> bit) & 1 == one for bit in bits for one in (0, 1)]
        return [(self.sided == 0) | ((self.sided > 0) == left) for left in lefts]

    def _narrowest(self, there: BoolArray) -> FloatArray:
        """Find the least widest gap of all chains from the left wall, obstacle by obstacle until nothing changes."""
        widest: FloatArray = np.where(there, self.left, np.inf)
        while widest.size:
            nearer = np.maximum(widest[:, :, np.newaxis], self.between).min(axis=1)
            nearer = np.where(there, np.minimum(widest, nearer), np.inf)
            if np.array_equal(nearer, widest):
                break
            widest = nearer
        return np.asarray(np.maximum(widest, self.right).min(axis=1, initial=self.clear), dtype=np.float64)


def build_gaps(obstacles: Sequence[Obstacle], clear: float) -> Gaps:
    """Return the gaps between obstacles, of which `clear` [m] is the width of the segment."""
    keys = tuple(sorted({one.key for one in obstacles if one.falls}))
    place = {key: at for at, key in enumerate(keys)}
    pieces = sorted({one.key for one in obstacles})
    between = np.full((len(obstacles), len(obstacles)), math.inf)
    for at, one in enumerate(obstacles):
        for other_at, other in enumerate(obstacles[:at]):
            between[at, other_at] = between[other_at, at] = _gap(one, other, clear)
    return Gaps(
        keys=keys,
        column=np.array([place[one.key] if one.falls else -1 for one in obstacles], dtype=np.intp),
        left=np.array([one.left for one in obstacles], dtype=np.float64),
        right=np.array([one.right for one in obstacles], dtype=np.float64),
        between=between,
        sided=np.array([_side(one, pieces) for one in obstacles], dtype=np.intp),
        clear=clear,
    )


def _side(one: Obstacle, pieces: Sequence[Key]) -> int:
    return {"left": 1, "right": -1, None: 0}[one.side] * (pieces.index(one.key) + 1)


def _gap(one: Obstacle, other: Obstacle, clear: float) -> float:
    """Return the gap between two obstacles [m]; those whose place along the segment is not known may be abreast."""
    if one.shape is not None and other.shape is not None:
        return float(one.shape.distance(other.shape))
    if one.shape is not None:
        one, other = other, one
    if other.shape is not None:
        depth = clear - (one.right if one.side == "left" else one.left)
        return max(0.0, (other.left if one.side == "left" else other.right) - depth)
    if one.side == other.side or one.key == other.key:
        return math.inf  # on one side, or one and the same piece
    left, right = (one, other) if one.side == "left" else (other, one)
    return max(0.0, left.right + right.left - clear)


def _encode(fell: BoolArray) -> NDArray[np.intp]:
    """Return for each row of an array (k, n), of at most 16 columns, the number of which its values are the bits."""
    packed = np.packbits(fell, axis=1, bitorder="little")
    code = np.zeros(len(fell), dtype=np.intp)
    for at in range(packed.shape[1]):
        code |= packed[:, at].astype(np.intp) << 8 * at
    return code


def find_distinct(fell: BoolArray) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return where each distinct row of an array (k, n) stands first, and for each row which of those it is."""
    if not fell.size:
        return np.arange(min(len(fell), 1)), np.zeros(len(fell), dtype=np.intp)
    packed = np.packbits(fell, axis=1)
    words = np.zeros((len(fell), -(-packed.shape[1] // 8) * 8), dtype=np.uint8)
    words[:, : packed.shape[1]] = packed
    as_one = words.view(np.uint64) if words.shape[1] == 8 else words.view(np.dtype((np.void, words.shape[1])))
    _, first, back = np.unique(as_one.ravel(), return_index=True, return_inverse=True)
    return first, back
