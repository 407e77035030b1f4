"""Names on a plan, in metres: none over another, each where it covers least; what finds no room gets a number."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from assess.model import Place
from assess.report import words

Point = tuple[float, float]
Bounds = tuple[float, float, float, float]
"""Left, low, right and high end."""
Corners = tuple[Point, Point, Point, Point]

LINE = 12.5
"""Height of a line of a name [px]."""
MOST = 40
"""Labels of pieces on one plan."""
_NARROW, _WIDE = frozenset("iljtfrI1.,:;'|()[] -"), frozenset("mwMWQO@%&")
_FAR = 12.0
"""Distance [px] beyond which a line leads from a label to its piece."""


@dataclass(frozen=True, slots=True)
class Label:
    """The name of a piece in its box; `lead` is where a line to the piece begins and ends, if it lies away from it."""

    text: str
    box: Bounds
    lead: tuple[Point, Point] | None


def _lead(box: Bounds, piece: Bounds) -> tuple[Point, Point]:
    """Return the points of the label and of the piece that lie nearest to each other, the middle where they overlap."""
    ends = []
    for low, high, other_low, other_high in zip(box[:2], box[2:], piece[:2], piece[2:], strict=True):
        middle = (max(low, other_low) + min(high, other_high)) / 2
        ends.append((high, other_low) if high < other_low else (low, other_high) if low > other_high else (middle,) * 2)
    return (ends[0][0], ends[1][0]), (ends[0][1], ends[1][1])


def find_covered(boxes: Sequence[Bounds], others: Sequence[Bounds]) -> list[float]:
    """Return the area [m2] of each box that others share, counted once for each of them."""
    one, other = np.reshape(boxes, (-1, 1, 4)), np.reshape(others, (1, -1, 4))
    sides = np.minimum(one[..., 2:], other[..., 2:]) - np.maximum(one[..., :2], other[..., :2])
    areas: list[float] = np.maximum(sides, 0).prod(axis=2).sum(axis=1).tolist()
    return areas


def is_inside(box: Bounds, frame: Bounds) -> bool:
    """Whether a box lies in a frame, to its edges."""
    return frame[0] <= box[0] and frame[1] <= box[1] and box[2] <= frame[2] and box[3] <= frame[3]


def overlap(one: Bounds, other: Bounds) -> float:
    """Return the area [m2] that two boxes share."""
    wide = min(one[2], other[2]) - max(one[0], other[0])
    tall = min(one[3], other[3]) - max(one[1], other[1])
    return wide * tall if wide > 0 and tall > 0 else 0.0


def box_around(centre: Point, width: float, height: float) -> Bounds:
    """Return the box with its centre at a point."""
    x, y = centre
    return x - width / 2, y - height / 2, x + width / 2, y + height / 2


def bounds(corners: Sequence[Point]) -> Bounds:
    """Return the box around some corners."""
    xs, ys = zip(*corners, strict=True)
    return min(xs), min(ys), max(xs), max(ys)


# ---------------------------------------------------------------- of places, rooms and pieces

NAMED = 24
"""Characters of a place's name that are drawn."""
RANKS = {"": 3, "corridor": 3, "door": 2}
"""Of kinds of places: 3 are mere points of routes, which are not named, 2 are named where there is room."""
LARGE = ("exit", "stair")
"""Kinds of places whose sign is a large one, and whose names come first."""


@dataclass(frozen=True, slots=True)
class Spot:
    """A place with its name, "" where there is no room for it, and the sign of its kind.

    The name begins or, if `is_before`, ends at `label`; `box` is the room that it takes; a line leads to it from the
    sign where `lead` is given.
    """

    name: str
    kind: str
    at: Point
    label: Point
    is_before: bool
    box: Bounds
    lead: tuple[Point, Point] | None = None


@dataclass(frozen=True, slots=True)
class Key:
    """A name that is not on the plan; `number` stands there in its place, None where there is no room for that."""

    number: int | None
    name: str
    at: Point


class Names:
    """Places names on a plan one group after another, none on a piece; `keys` are those that found no room."""

    def __init__(self, frame: Bounds, unit: float, pieces: Sequence[Bounds] = ()) -> None:
        self.frame, self.unit = frame, unit
        self.held = list(pieces)
        self.keys: list[Key] = []

    def place(self, named: Sequence[tuple[str, Bounds]], taken: Sequence[Bounds]) -> list[Label | None]:
        """Return the label of each name, a number in its place, or None."""
        found = self._place_each(named, taken, self.held)
        self.held += [one.box for one in found if one is not None]
        for at, (text, box) in enumerate(named):
            if found[at] is None:
                number = sum(key.number is not None for key in self.keys) + 1
                (label,) = self._place_each([(str(number), box)], taken, self.held)
                point = ((box[0] + box[2]) / 2, (box[1] + box[3]) / 2)
                self.keys.append(Key(None if label is None else number, text, point))
                self.held += [] if label is None else [label.box]
                found[at] = label
        return found

    def place_spots(self, places: Sequence[tuple[Place, Point]], taken: Sequence[Bounds]) -> list[Spot]:
        """Return each place, rooms, exits and stairs with their names; exits and stairs first."""
        ordered = sorted(places, key=lambda pair: RANKS.get(pair[0].kind, pair[0].kind not in LARGE))
        ranks = [RANKS.get(one.kind, 0) for one, _at in ordered]
        sizes = [(12 if one.kind in LARGE else 6) * self.unit for one, _at in ordered]
        signs = [box_around(at, size, size) for (_one, at), size in zip(ordered, sizes, strict=True)]
        named = [(words.cut(one.place, NAMED), sign) for (one, _at), sign in zip(ordered, signs, strict=True)]
        free = [*taken, *signs]
        labels = self.place(named[: ranks.count(0)], free)
        for name in named[ranks.count(0) : len(ranks) - ranks.count(3)]:  # left out unless it covers nothing
            (label,) = self._place_each([name], free, self.held)
            is_free = label is not None and label.lead is None and not any(overlap(label.box, box) for box in free)
            labels.append(label if is_free else None)
            self.held += [label.box] if label is not None and is_free else []
        labels += [None] * ranks.count(3)
        spots = []
        for (one, at), sign, label in zip(ordered, signs, labels, strict=True):
            if label is None:
                spots.append(Spot("", one.kind, at, at, False, sign))
                continue
            is_before = label.box[2] <= at[0]
            start = (label.box[2 if is_before else 0], label.box[1] + 0.2 * LINE * self.unit)
            spots.append(Spot(label.text, one.kind, at, start, is_before, label.box, label.lead))
        return spots

    def place_ways(self, signed: Sequence[tuple[str, Bounds]]) -> list[Label]:
        """Return the names of segments next to their signs, where a name covers nothing else."""
        taken = [*self.held, *(box for _name, box in signed)]
        small = LINE * LINE * self.unit * self.unit / 20
        return [
            one
            for one in self._place_each(signed[:MOST], taken, ())
            if one and one.lead is None and find_covered([one.box], taken)[0] < small
            and not any(overlap(one.box, other) for other in self.held)
        ]  # fmt: skip

    def _place_each(
        self, named: Sequence[tuple[str, Bounds]], taken: Sequence[Bounds], names: Sequence[Bounds]
    ) -> list[Label | None]:
        """Place each name next to its box, or farther off with a line to it; None where there is no room for it.

        `named` are names with the boxes of their pieces, the most important first; `taken` is what is to stay free,
        and `names` what no name may overlap [m].
        """
        held, unit = [*names], self.unit
        placed: list[Label | None] = []
        for text, piece in named:
            width = sum(3.6 if sign in _NARROW else 9.4 if sign in _WIDE else 6.2 for sign in text)  # [px], about
            wide, tall = 1.1 * width * unit, LINE * unit  # bold
            left, low, right, high = piece
            x, y = (left + right - wide) / 2, (low + high - tall) / 2
            starts = [(x, y)] if left == right else []  # on a point, else right, left, above, below and at the corners
            starts += [
                (x0, y0)
                for off in (2 * unit, 14 * unit, 28 * unit, 44 * unit)
                for x0 in (right + off, left - off - wide, x)
                for y0 in (y, high + off, low - off - tall)
                if (x0, y0) != (x, y)
            ]
            tried = [(x0, y0, x0 + wide, y0 + tall) for x0, y0 in starts]
            tried = [box for box in tried if is_inside(box, self.frame)]
            tried = [box for box, area in zip(tried, find_covered(tried, held), strict=True) if not area]
            if not tried:
                placed.append(None)
                continue
            hidden = [math.floor(10 * area / (wide * tall)) for area in find_covered(tried, taken)]
            leads = [_lead(box, piece) for box in tried]
            ranked = zip(hidden, (round(math.dist(*lead) / unit) for lead in leads), tried, leads, strict=True)
            *_rank, best, lead = min(ranked, key=lambda one: one[:2])  # a tenth more hides no more
            held.append(best)
            placed.append(Label(text, best, lead if math.dist(*lead) > _FAR * unit else None))
        return placed
