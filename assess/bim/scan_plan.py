"""The plan of a scan: which way its walls run, walls and windows as polygons, rooms, and heights of the floors."""

import math
from collections.abc import Iterable, Iterator, Sequence
from statistics import median

import numpy as np
import shapely
from shapely import LineString, Point, Polygon

from assess.bim.building_model import Area, Space
from assess.bim.plan_shapes import list_polygons, merge, to_area
from assess.bim.scan_values import MOST_SURFACES, FloatArray, Label, Scan, Scanned
from assess.i18n import gettext

WALL = 0.1
"""Thickness with which walls are drawn: a scan knows their faces alone [m]."""
UPRIGHT = 0.999
"""Least Z of the vertical axis of what stands upright [-]: within 2.6 degrees."""
JOINS = 0.15
"""Gap at a corner across which two walls are joined to close a room [m]."""
SMALLEST_ROOM = 0.5
"""Area below which an outline is no room [m2]."""


def find_turn(walls: Sequence[Scanned]) -> float:
    """Return the direction in which the walls run, within 45 degrees of X [deg]: the mean of all, by their lengths."""
    ways = [(wall.sizes[0], math.atan2(wall.axes[1, 0], wall.axes[0, 0])) for wall in walls if is_upright(wall)]
    x, y = (sum(length * way(4 * angle) for length, angle in ways) for way in (math.cos, math.sin))
    return math.degrees(math.atan2(y, x)) / 4 if math.hypot(x, y) > 0 else 0.0


def turn_by(angle_deg: float) -> FloatArray:
    """Return the matrix that turns a plan about the origin, anticlockwise, (3, 3)."""
    turn = math.radians(angle_deg)
    return np.array([[math.cos(turn), -math.sin(turn), 0.0], [math.sin(turn), math.cos(turn), 0.0], [0.0, 0.0, 1.0]])


def is_upright(one: Scanned) -> bool:
    """Return whether the second of its own axes is vertical."""
    return bool(abs(one.axes[2, 1]) >= UPRIGHT)


def find_level(scan: Scan, story: int) -> float:
    """Return the height of the floor of a storey [m]: of its floors, else where its walls, else its objects begin."""
    floors = [_height_of(one) for one in scan.floors if one.story == story]
    if floors:
        return median(floors)
    walls = [one.bottom for one in scan.walls if one.story == story and is_upright(one)]
    if walls:
        return median(walls)
    return min((one.bottom for one in scan.objects if one.story == story), default=0.0)


def _height_of(floor: Scanned) -> float:
    return float(floor.corners[:, 2].mean() if len(floor.corners) else floor.origin[2])


def draw_walls(scan: Scan, story: int) -> tuple[Area, ...]:
    """Return the walls of a storey with gaps at its doors, windows and openings; those of cylinders are left out."""
    walls = [_lay(one, WALL) for one in scan.walls if one.story == story and is_upright(one) and not one.is_curved]
    holes = [
        _lay(one, 3 * WALL)
        for one in (*scan.doors, *scan.windows, *scan.openings)
        if one.story == story and is_upright(one)
    ]
    return merge(list_polygons(shapely.union_all(walls).difference(shapely.union_all(holes))))


def draw_windows(scan: Scan, story: int) -> tuple[Area, ...]:
    """Return the windows of a storey."""
    return merge(_lay(one, WALL) for one in scan.windows if one.story == story and is_upright(one))


def _lay(one: Scanned, least: float) -> Polygon:
    width, thick = one.sizes[0] / 2, max(one.sizes[2], least) / 2
    along, across = (one.axes[:2, axis] for axis in (0, 2))
    return Polygon([one.origin[:2] + x * along + y * across for x, y in _around(width, thick)])


def _around(x: float, y: float) -> tuple[tuple[float, float], ...]:
    return (-x, -y), (x, -y), (x, y), (-x, y)


def find_rooms(scan: Scan, stories: Iterable[int]) -> list[Space]:
    """Return the rooms of the storeys: the outlines of floors, else those that walls close."""
    found = [
        (key, story, polygon, level)
        for story in stories
        for key, polygon, level in (list(_list_floors(scan, story)) or list(_close_walls(scan, story)))
    ]
    taken: set[str] = set()
    rooms = []
    for number, (key, story, polygon, level) in enumerate(found, 1):
        own = key if key not in taken else f"{key} {number}"
        taken.add(own)
        name = _name(scan.labels, story, polygon, is_only=len(found) == 1) or gettext("Room {n}", n=number)
        # How high a ceiling lies says nothing of the roof of the building: a space without height tells none.
        rooms.append(Space(own, str(story), name, "", to_area(polygon), level, level))
    return rooms


def _list_floors(scan: Scan, story: int) -> Iterator[tuple[str, Polygon, float]]:
    for one in scan.floors:
        if one.story == story:
            corners = one.corners if len(one.corners) >= 3 else _corners_of(one)
            polygon = max(
                list_polygons(shapely.make_valid(Polygon(corners[:, :2]))), key=lambda one: one.area, default=Polygon()
            )
            if polygon.area >= SMALLEST_ROOM:
                yield one.key, polygon, _height_of(one)


def _corners_of(floor: Scanned) -> FloatArray:
    width, height, depth = (size / 2 for size in floor.sizes)
    is_flat = height <= depth
    local = np.array([(x, 0.0, y) if is_flat else (x, y, 0.0) for x, y in _around(width, depth if is_flat else height)])
    corners: FloatArray = floor.origin + local @ floor.axes.T
    return corners


def _close_walls(scan: Scan, story: int) -> Iterator[tuple[str, Polygon, float]]:
    """Yield the areas that the walls of a storey close, each lengthened by `JOINS` so that they meet at corners."""
    level, lines = find_level(scan, story), []
    for one in scan.walls:
        if one.story == story and is_upright(one) and not one.is_curved:
            reach = (one.sizes[0] / 2 + JOINS) * one.axes[:2, 0]
            lines.append(LineString([one.origin[:2] - reach, one.origin[:2] + reach]))
    rings = list(list_polygons(shapely.polygonize([shapely.union_all(lines)]))) if lines else []
    for number, polygon in enumerate(rings[:MOST_SURFACES], 1):
        if polygon.area >= SMALLEST_ROOM:
            yield f"room {story} {number}", polygon, level


def _name(labels: Sequence[Label], story: int, polygon: Polygon, *, is_only: bool) -> str:
    own = [
        one.words
        for one in labels
        if is_only or (one.story == story and one.centre is not None and polygon.covers(Point(one.centre[:2])))
    ]
    return " / ".join(dict.fromkeys(own))
