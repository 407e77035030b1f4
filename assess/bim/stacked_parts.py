"""Bodies that stand on each other: which parts of a group are one piece, and what stands on a piece that was taken."""

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from assess.i18n import Text, nfill

TOUCHING = 0.02
"""Gap up to which two bodies touch [m]."""
LEAST_COVER = 0.5
"""Share of the plan of the lower body from which the upper one belongs to it; a lamp on a table covers less [-]."""
MOST_NAMED = 5

Bounds = NDArray[np.float64]
"""Least and largest X, Y and Z of bodies, (n, 6): x, y, z, X, Y, Z [m]."""


def find_pairs(upper: Bounds, lower: Bounds, *, beside: bool = False) -> list[tuple[int, int]]:
    """Return the pairs of an upper body, which does not stand on the floor, and one on which it stands.

    `beside`: also of one that it touches at a side, as a shelf between the sides of a bookcase does.
    """
    tree = shapely.STRtree(shapely.box(lower[:, 0], lower[:, 1], lower[:, 3], lower[:, 4]))
    gap = TOUCHING
    wide = shapely.box(upper[:, 0] - gap, upper[:, 1] - gap, upper[:, 3] + gap, upper[:, 4] + gap)
    above, below = tree.query(wide)
    bottom = upper[above, 2]
    least = lower[below, 2 if beside else 5] - gap
    reach = (least <= bottom) & (bottom <= lower[below, 5] + gap)
    over = np.minimum(upper[above, 3:5], lower[below, 3:5]) - np.maximum(upper[above, :2], lower[below, :2])
    cover = _areas(upper)[above] if beside else over.clip(0).prod(axis=1)
    found = reach & (cover >= LEAST_COVER * _areas(lower)[below])
    return [(int(one), int(other)) for one, other in zip(above[found], below[found], strict=True)]


def _areas(bounds: Bounds) -> NDArray[np.float64]:
    found: NDArray[np.float64] = (bounds[:, 3:5] - bounds[:, :2]).prod(axis=1)
    return found


def join_stacked(bounds: Bounds, is_on_floor: Sequence[bool], *, beside: bool = False) -> list[list[int]]:
    """Return which bodies of a group are one piece, by their places: what is off the floor belongs to what it touches.

    Bodies that stand beside each other on the floor stay apart. `beside`: see `find_pairs`. Each piece begins with its
    lowest body.
    """
    floor = np.asarray(is_on_floor, bool)
    label = list(range(len(bounds)))
    off = np.flatnonzero(~floor)
    for at, other in find_pairs(bounds[off], bounds, beside=beside):
        one, two = label[int(off[at])], label[other]
        label = [min(one, two) if each in (one, two) else each for each in label]
    pieces = [[at for at, each in enumerate(label) if each == kind] for kind in dict.fromkeys(label)]
    return [sorted(piece, key=lambda at: (not floor[at], bounds[at, 2], at)) for piece in pieces]


def note_stacked(names: Sequence[str], bounds: Bounds, left: Bounds) -> list[Text]:
    """Return the warning about the taken pieces on which others stand that were left out."""
    if not len(bounds) or not len(left):
        return []
    carriers = dict.fromkeys(other for _, other in find_pairs(left, bounds))
    if not carriers:
        return []
    shown = ", ".join(names[at] for at in list(carriers)[:MOST_NAMED]) + (", ..." if len(carriers) > MOST_NAMED else "")
    return [
        nfill(
            "Something that was left out stands on {n:,} piece, whose height is then not the whole: {names}. Check its "
            "Height in Items.",
            "Something that was left out stands on {n:,} pieces, whose heights are then not the whole: {names}. Check "
            "their Height in Items.",
            len(carriers), names=shown,
        )
    ]  # fmt: skip
