"""On which side of a piece the wall is that it stands against, so that it falls to the other.

No publication gives a rule for this. The wall is that of the outline of its room, or else one of the building's edge
as far as outlines show it: a side that runs along the piece's Width, within `GAP` of one of its two long faces. Where
no side does, or sides do on both faces, the side of the wall is not known, and the piece may fall either way.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

from assess.errors import Problem
from assess.i18n import Text, fill, nfill
from assess.model import AXES, Axis, Inventory, Item, Outline, Place, axis_of
from assess.routes.geometry import Point, turn
from assess.workbook.names import key

GAP = 0.30
"""Distance from a face up to which a wall counts as behind it [m]: assumed; it leaves room for skirting and pipes."""
ALONG = 10.0
"""Angle up to which a wall runs along Width [deg]."""
SHARE = 0.5
"""Share of Width that must have the wall behind it [-]."""
ON_EDGE = 0.05
"""Distance up to which a corner lies on the building's edge [m]."""
ACROSS = 0.1
"""Cosine of the angle between the way a piece falls and an axis up to which it falls across that axis [-]."""
MOST_NAMED = 3
"""Pieces that a problem names."""

UNPLACED, NO_OUTLINE, OUTSIDE, NO_WALL_NEAR, BOTH, CONTRARY = range(6)
"""Why the side of a wall is not known."""
REASONS: Mapping[int, Text] = {
    UNPLACED: fill("its position or its direction on the plan is not filled in"),
    NO_OUTLINE: fill("neither its room nor any place of its floor has an Outline"),
    OUTSIDE: fill("it stands outside the outline"),
    NO_WALL_NEAR: fill("no side of the outline runs along it within {gap:.2f} m of one of its long faces", gap=GAP),
    BOTH: fill("sides of the outline run along both of its long faces"),
    CONTRARY: fill("its Axis and its Angle contradict each other"),
}


@dataclass(frozen=True, slots=True)
class Wall:
    """The wall at the back of a piece, which falls away from it in a direction, anticlockwise from X [deg].

    None where the side of the wall is not known, for a reason, one of `REASONS`.
    """

    falls_toward: float | None
    reason: int | None = None

    def sense(self, axis: Axis) -> int:
        """Return whether the piece falls toward larger (1) or smaller (-1) X or Y; 0 where that is not known."""
        if self.falls_toward is None:
            return 0
        along = math.cos(math.radians(self.falls_toward - AXES.index(axis) * 90.0))
        return int(math.copysign(1, along)) if abs(along) > ACROSS else 0


def find_walls(inventory: Inventory) -> dict[int, Wall]:
    """Return the walls of the pieces that stand against one, by the piece's index."""
    by_floor: dict[str, list[Place]] = {}
    for place in inventory.places:
        if place.outline:
            by_floor.setdefault(place.floor, []).append(place)
    edges = {floor: _find_edge(tuple(place.outline for place in own)) for floor, own in by_floor.items()}
    return {
        at: _find_wall(item, by_floor.get(item.floor, ()), edges.get(item.floor))
        for at, item in enumerate(inventory.items)
        if item.against_wall
    }


_Edge = tuple[Outline, Sequence[tuple[Point, Point]]]
"""The polygon inside which a piece must stand, and the sides that are walls."""


def _find_wall(item: Item, outlined: Sequence[Place], edge: _Edge | None) -> Wall:
    x, y = item.x, item.y
    if x is None or y is None or (item.axis is None and item.angle_deg is None):
        return Wall(None, UNPLACED)
    along = None if item.angle_deg is None else axis_of(item.angle_deg)
    if item.axis is not None and along is not None and along != item.axis:
        return Wall(None, CONTRARY)
    if edge is None:
        return Wall(None, NO_OUTLINE)
    # the walls of its own room: that of its name, or where it names none with an outline, the one round it
    named = [one.outline for one in outlined if item.room and key(one.place) == key(item.room)]
    rooms = named or [one.outline for one in outlined if is_inside((x, y), one.outline)]
    around, sides = (rooms[0], list(_sides(rooms[0]))) if len(rooms) == 1 else edge
    if not is_inside((x, y), around):
        return Wall(None, OUTSIDE)
    behind = {side for one in sides if (side := _find_side(item, (x, y), one))}
    if len(behind) != 1:
        return Wall(None, BOTH if behind else NO_WALL_NEAR)
    return Wall((turn(item) + (180.0 if behind == {1} else 0.0)) % 360.0)


def _find_side(item: Item, at: Point, side: tuple[Point, Point]) -> int:
    """Return on which side of a piece a wall is, seen along Breadth: 1 ahead, -1 behind, 0 if it is not at its face."""
    angle, half = math.radians(turn(item)), (item.width or item.breadth) / 2
    cos, sin = math.cos(angle), math.sin(angle)
    (u, v), (p, q) = (((x - at[0]) * cos + (y - at[1]) * sin, (y - at[1]) * cos - (x - at[0]) * sin) for x, y in side)
    low, high = max(min(v, q), -half), min(max(v, q), half)
    if abs(p - u) > math.tan(math.radians(ALONG)) * abs(q - v) or high - low < SHARE * 2 * half:
        return 0
    ends = [u + (p - u) * (one - v) / (q - v) for one in (low, high)]
    if min(ends) < 0 < max(ends) or max(map(abs, ends)) - item.breadth / 2 > GAP:
        return 0
    return 1 if ends[0] > 0 else -1


def _sides(outline: Outline) -> Iterator[tuple[Point, Point]]:
    return pairwise((*outline, outline[0]))


def is_inside(at: Point, outline: Outline) -> bool:
    """Tell whether a point lies inside an outline."""
    x, y = at
    crossings = (
        one[0] + (y - one[1]) * (two[0] - one[0]) / (two[1] - one[1])
        for one, two in _sides(outline)
        if (one[1] > y) != (two[1] > y)
    )
    return sum(crossing > x for crossing in crossings) % 2 == 1


@lru_cache(maxsize=64)
def _find_edge(outlines: tuple[Outline, ...]) -> _Edge:
    """Return the building's edge as far as outlines show it: their sides that lie on the hull of them all."""
    from shapely import MultiPoint, get_coordinates

    points = [point for outline in outlines for point in outline]
    hull = tuple((x, y) for x, y in get_coordinates(MultiPoint(points).convex_hull).tolist()[:-1])

    def distance(point: Point, one: Point, two: Point) -> float:
        """Return how far a point is from the line through two others [m]."""
        x, y = two[0] - one[0], two[1] - one[1]
        return abs(x * (point[1] - one[1]) - y * (point[0] - one[0])) / math.hypot(x, y)

    return hull, [
        side for outline in outlines for side in _sides(outline)
        if any(all(distance(point, *line) <= ON_EDGE for point in side) for line in _sides(hull))
    ]  # fmt: skip


def remark_on_walls(inventory: Inventory) -> Iterator[Problem]:
    """Yield notes, one a reason, on pieces of which it is not known on which side their wall is."""
    lost: dict[int, list[Item]] = {}
    for at, wall in find_walls(inventory).items():
        if wall.reason is not None:
            lost.setdefault(wall.reason, []).append(inventory.items[at])
    for reason, items in sorted(lost.items()):
        names = ", ".join(item.item for item in items[:MOST_NAMED]) + (", ..." if len(items) > MOST_NAMED else "")
        message = nfill(
            "'{names}' stands against a wall, but which way it falls is not known, as {reason}: both ways count.",
            "{n:,} rows stand against a wall, but which way they fall is not known ({names}), as for each of them "
            "{reason}: both ways count.",
            len(items), names=names, reason=REASONS[reason],
        )  # fmt: skip
        fix = fill("Fill in X, Y and Angle, and the Outline of the room in Places.")
        yield Problem("note", "Items", inventory.locate("Items", items[0].row, "against_wall"), message, fix)
