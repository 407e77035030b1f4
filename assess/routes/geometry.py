"""Geometry on the plan of a floor: what pieces cover, standing and fallen, and segments as bands."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from assess.model import Inventory, Item

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

Point = tuple[float, float]
Corners = tuple[Point, Point, Point, Point]


def turn(item: Item) -> float:
    """Return the direction of Breadth [deg], anticlockwise from X: that of the axis where no angle is given."""
    if item.angle_deg is not None:
        return item.angle_deg
    return 90.0 if item.axis == "Y" else 0.0


def rectangle(at: Point, angle: float, along: tuple[float, float], across: float) -> Corners:
    """Return the corners of a rectangle about a point, anticlockwise [m].

    `angle` is the direction of Breadth, anticlockwise from X [deg]; `along` is where it begins and ends along that, and
    `across` its width, half of it on each side.
    """
    cos, sin = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    (x, y), (near, far), half = at, along, across / 2
    local = ((near, -half), (far, -half), (far, half), (near, half))
    one, two, three, four = ((x + u * cos - v * sin, y + u * sin + v * cos) for u, v in local)
    return one, two, three, four


def fallen(at: Point, angle: float, breadth: float, width: float, height: float) -> tuple[Corners, Corners]:
    """Return what a piece covers beyond its footprint if it falls over either of its edges across Breadth.

    Both, as the sign of a motion does not determine the direction in which a piece falls.
    """
    edge = breadth / 2
    return rectangle(at, angle, (edge, edge + height), width), rectangle(at, angle, (-edge - height, -edge), width)


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """One placed piece: what it covers standing, what each way of falling adds, and all of that together."""

    standing: "BaseGeometry"
    falls: tuple["BaseGeometry", ...]
    everything: "BaseGeometry"
    flags: tuple[str, ...]


@lru_cache(maxsize=4096)
def build_shape(item: Item, is_at_wall: bool = False, toward: float | None = None) -> Shape | None:
    """Return the shape of a piece; None where it has no position.

    `toward` is the direction in which a piece at a wall falls [deg]; None where that is not known.
    """
    if item.x is None or item.y is None:
        return None
    from shapely import Polygon, union_all

    at, across, turns = (item.x, item.y), item.width or item.breadth, [turn(item)]
    if item.axis is None and item.angle_deg is None:  # Breadth may lie along either axis
        turns.append(turn(item) + 90.0)
    standing = union_all([Polygon(rectangle(at, a, (-item.breadth / 2, item.breadth / 2), across)) for a in turns])
    ways = [one for a in turns for one in fallen(at, a, item.breadth, across, item.height)]
    if toward is not None:
        ways = [ways[0] if abs(angle_apart(toward, turn(item))) < 90 else ways[1]]
    falls = tuple(Polygon(one) for one in ways)
    flags = {
        "direction_unknown": len(turns) > 1, "width_assumed": item.width is None,
        "wall_side_unknown": is_at_wall and toward is None, "falls_from_wall": toward is not None,
    }  # fmt: skip
    known = tuple(flag for flag, holds in flags.items() if holds)
    return Shape(standing, falls, union_all([standing, *falls]), known)


def angle_apart(one: float, other: float) -> float:
    """Return how far a direction is from another, -180 to 180 [deg]."""
    return (one - other + 180.0) % 360.0 - 180.0


@dataclass(frozen=True, slots=True)
class Band:
    """A segment on the plan: straight, as wide as it is clear [m].

    Its centre line leads from `start` to `end`; `extends_start` and `extends_end` are how far it goes on beyond them,
    round a bend.
    """

    start: Point
    end: Point
    extends_start: float
    extends_end: float
    width: float

    @property
    def length(self) -> float:
        """From start to end [m]."""
        return float(np.hypot(self.end[0] - self.start[0], self.end[1] - self.start[1]))

    def outline(self) -> "BaseGeometry":
        """Return the band in its own coordinates: along it from its start, and across it from its centre line."""
        from shapely import box

        return box(-self.extends_start, -self.width / 2, self.length + self.extends_end, self.width / 2)

    def to_own(self, shape: "BaseGeometry") -> "BaseGeometry":
        """Return a shape of the plan in the band's own coordinates."""
        import shapely

        along = (np.array(self.end) - self.start) / self.length
        across = (-along[1], along[0])
        return shapely.transform(
            shape, lambda points: np.column_stack([(points - self.start) @ one for one in (along, across)])
        )


def build_bands(inventory: Inventory, clear: Sequence[float]) -> dict[int, Band]:
    """Return the bands of the segments (by their index) whose places both have a position on the segment's floor.

    Where exactly two segments meet at a place, each is extended by half the other's width, so that the bend belongs to
    both. `clear` are the clear widths of all segments [m].
    """
    known = {one.place: one for one in inventory.places if one.x is not None and one.y is not None}
    points = {name: (float(one.x or 0.0), float(one.y or 0.0)) for name, one in known.items()}
    placed = {
        at: one
        for at, one in enumerate(inventory.routes)
        if all(place in known and known[place].floor == one.floor for place in (one.start, one.end))
    }
    meet = Counter(place for one in placed.values() for place in (one.start, one.end))

    def extension(at: int, place: str) -> float:
        others = (other for other, one in placed.items() if other != at and place in (one.start, one.end))
        return max((clear[other] / 2 for other in others), default=0.0) if meet[place] == 2 else 0.0

    return {
        at: Band(points[one.start], points[one.end], extension(at, one.start), extension(at, one.end), clear[at])
        for at, one in placed.items()
    }
