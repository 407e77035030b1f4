"""Corridors: long narrow rooms that people pass through. Ways run along the middle between their walls.

So the ways from many rooms share their segments, and each segment lies in the middle of the free width.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from assess.bim.building_model import Point
from assess.bim.draft_floor import Room, measure
from assess.bim.plan_shapes import list_polygons

SLENDER, NARROW = 3.0, 2.5
LONG, WIDE = 6.0, 5.0
"""A corridor is `SLENDER` times as long as wide and up to `NARROW` wide [m], or `LONG` times and up to `WIDE` [m]."""
NARROWEST = 0.6
"""Walls that are nearer than this to each other have no way between them [m]."""
PARALLEL = 0.996
"""Least cosine of the angle between two walls that face each other [-]: 5 degrees."""
OVERLAP = 1.2
"""Two walls face each other over at least so many times their distance [-]."""
MUCH_WIDER = 1.6
"""Walls that are so many times farther apart than the corridor is wide are not its two sides [-]."""
MOST_WALLS = 80
SNAP = 0.6
"""Two places on the middle line that are nearer than this are one [m]."""
BESIDE = 1.2
"""A door up to this far outside the two walls is in one of them [m]."""
BEYOND = 1.5
"""What is up to so many widths beyond the end of a middle line is joined to that end [-]."""
INSET = 0.45
"""Middle lines end this far from the walls at their ends [m]."""


@dataclass(frozen=True, slots=True)
class Axis:
    """The middle line between two walls that face each other: its ends, and the distance of the walls [m]."""

    start: Point
    end: Point
    width: float

    @property
    def length(self) -> float:
        """Its length [m]."""
        return measure(self.start, self.end)

    @property
    def inset(self) -> float:
        """How far from its ends ways along it begin [m]."""
        return min(INSET, self.length / 3)

    def find(self, point: Point) -> tuple[float, float]:
        """Return how far along the axis, and how far from it, a point is [m]."""
        (x, y), (u, v) = self.start, self._direction()
        dx, dy = point[0] - x, point[1] - y
        return dx * u + dy * v, abs(dy * u - dx * v)

    def point(self, along: float) -> Point:
        """Return the point so far along it [m]."""
        (x, y), (u, v) = self.start, self._direction()
        return x + along * u, y + along * v

    def _direction(self) -> Point:
        (x, y), (u, v) = self.start, self.end
        return (u - x) / self.length, (v - y) / self.length


def find_width(area: BaseGeometry) -> float:
    """Return the width of a long narrow area [m], that of the rectangle of its area and perimeter; 0 for others."""
    half, size = area.length / 2, area.area
    root = half**2 - 4 * size
    if root <= 0:
        return 0.0
    width = (half - math.sqrt(root)) / 2
    ratio = (half - width) / width if width > 0 else math.inf
    is_narrow = width <= NARROW and ratio >= SLENDER
    return width if width >= NARROWEST and (is_narrow or (width <= WIDE and ratio >= LONG)) else 0.0


def is_corridor(room: Room) -> bool:
    """Tell whether a room is a corridor: long and narrow, with more than one way out."""
    return len(room.links) > 1 and find_width(room.area) > 0


def find_axes(room: Room) -> list[Axis]:
    """Return the middle lines of a corridor, the longest first; none where no walls face each other."""
    width = find_width(room.area)
    area = max(list_polygons(room.floor), key=lambda one: one.area)
    smooth = area.buffer(-0.3 * width, join_style="mitre").buffer(0.3 * width, join_style="mitre").simplify(0.05)
    walls = [wall for one in list_polygons(smooth) for wall in _list_walls(one)]
    if len(walls) > MOST_WALLS:
        return []
    axes = [axis for at, one in enumerate(walls) for other in walls[:at] if (axis := _face(one, other, width))]
    inside = area.buffer(0.05)
    own = [axis for axis in axes if inside.covers(shapely.LineString([axis.start, axis.end]))]
    return sorted(own, key=lambda axis: -axis.length)


def _list_walls(area: shapely.Polygon) -> Iterator[tuple[Point, Point]]:
    for ring in (oriented := shapely.geometry.polygon.orient(area)).interiors, [oriented.exterior]:
        for one in ring:
            yield from pairwise([(float(x), float(y)) for x, y, *_ in one.coords])


def _face(one: tuple[Point, Point], other: tuple[Point, Point], width: float) -> Axis | None:
    if not (measure(*one) > NARROWEST and measure(*other) > NARROWEST):
        return None
    wall = Axis(one[0], one[1], 0.0)
    along = (np.subtract(one[1], one[0]) / wall.length).tolist()
    back = (np.subtract(other[1], other[0]) / measure(*other)).tolist()
    across = [-along[1] * (x - one[0][0]) + along[0] * (y - one[0][1]) for x, y in other]
    gap = sum(across) / 2
    if along[0] * back[0] + along[1] * back[1] > -PARALLEL or not NARROWEST <= gap <= MUCH_WIDER * width:
        return None
    places = [wall.find(point)[0] for point in other]
    low, high = max(0.0, min(places)), min(wall.length, max(places))
    if high - low < OVERLAP * gap:
        return None
    middle = Axis(_shift(one[0], along, gap / 2), _shift(one[1], along, gap / 2), 0.0)
    return Axis(middle.point(low), middle.point(high), gap)


def _shift(point: Point, along: Sequence[float], by: float) -> Point:
    return point[0] - by * along[1], point[1] + by * along[0]


@dataclass(frozen=True, slots=True)
class Spot:
    """A place on an axis: how far along it [m], and the nodes that are joined to the axis there."""

    along: float
    joined: tuple[str, ...]


def find_spots(axis: Axis, nodes: Iterable[tuple[str, Point]]) -> list[Spot]:
    """Return the places along an axis at which nodes are joined to it, and its two ends, in their order."""
    inset, beyond = axis.inset, max(BESIDE, BEYOND * axis.width)
    low, high = inset, axis.length - inset
    found = [(low, ""), (high, "")]
    for name, point in nodes:
        along, away = axis.find(point)
        if -beyond <= along <= axis.length + beyond and away <= axis.width / 2 + BESIDE:
            found.append((min(max(along, low), high), name))
    groups: list[list[tuple[float, str]]] = []
    for one in sorted(found):
        if groups and one[0] - groups[-1][0][0] < SNAP:
            groups[-1].append(one)
        else:
            groups.append([one])
    return [
        Spot(sum(along for along, _ in group) / len(group), tuple(name for _, name in group if name))
        for group in groups
    ]


def measure_width(axis_width: float, ends: tuple[Point, Point], floor: BaseGeometry) -> float:
    """Return the free width of a segment in the middle between two walls [m]: less what stands out of them."""
    line = shapely.LineString(ends)
    away = line.buffer(axis_width / 2, cap_style="flat").buffer(-0.02).difference(floor)
    return min(axis_width, 2 * float(line.distance(away))) if not away.is_empty else axis_width
