"""Scans of rooms by a phone: the JSON of Apple RoomPlan, a CapturedRoom or a CapturedStructure. Experimental.

Apple documents the Swift types, and not the JSON that apps write of them. The reading rests on these types and on how
public programs read such files; it was tried on files made by hand after them, not on a scan. See `scan_values`.

A structure has lists of all its rooms in common axes: those are read, and its rooms only where it has none. RoomPlan
begins its axes wherever the scan began: the plan is turned so that most walls run along X and Y.
"""

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from statistics import median

import numpy as np
import shapely
from shapely import LineString, Point, Polygon

from assess.bim.building_model import (
    IS_TILTED,
    NOT_ON_FLOOR,
    ON_FLOOR,
    SILL,
    SMALLEST_ROOM,
    Area,
    BuildingModel,
    Door,
    Piece,
    Skipped,
    Space,
    Stair,
    Storey,
    count_skipped,
    half_turn,
    name_skipped,
)
from assess.bim.plan_shapes import SpaceSearch, find_valid, list_polygons, merge, to_area
from assess.bim.scan_values import MOST_SURFACES, FloatArray, Label, Scan, Scanned, parse_scan, say_word
from assess.i18n import Text, fill, gettext, nfill

SCHEMA = "RoomPlan"
NEAR_STOREY = 0.5
"""How far from a storey's floor a stair may end to lead to it [m]."""
FIXED = ("sink", "toilet", "bathtub", "fireplace")
"""Categories that are fixed to the building."""
STAIRS = "stairs"
BUILT_IN = ("oven", "dishwasher", "stove", "washerDryer", "refrigerator")
"""Categories that are built in where they belong to an object of the category storage."""
FITTED = ("oven", "dishwasher")
"""Categories that are usually built in."""
LOW = "low"
WALL = 0.1
"""Thickness with which walls are drawn: a scan knows their faces alone [m]."""
JOINS = 0.15
"""Gap at a corner across which two walls are joined to close a room [m]."""

IS_FIXED = fill("fixed to the building")
IS_BUILT_IN = fill("built into a cabinet, which is imported")

EXPERIMENTAL = fill(
    "Scans of RoomPlan are read experimentally, as Apple does not document their files. Compare pieces, rooms and "
    "doors with the building."
)
SCANNED_SIZES = fill(
    "Sizes were measured by scan: the simulation varies them more than others. Measure slender pieces, and change "
    "Sizes from to measured."
)
UNKNOWN_AXES = fill(
    "A scan does not tell which way the building stands, nor how high its floors lie: the plan is turned so that walls "
    "run along X and Y, and the lowest scanned floor is at 0 m. Check that X is that of PFA X, and Elevation."
)
EXITS = fill(
    "A door with a scanned room on one side only is taken for an exit. Where it leads into the building, change its "
    "Kind in Places to door."
)


def read_roomplan(data: bytes, name: str) -> BuildingModel:
    """Return what a scan tells of a building.

    Raises ModelError if it is no scan, damaged, or beyond a limit; the message names the place in the file, as
    ``objects[3]``.
    """
    scan = parse_scan(data, name)
    scan = scan.turned(_find_turn(scan.walls))
    storeys = _list_storeys(scan)
    levels = {int(one.key): one.level for one in storeys}
    rooms = _find_rooms(scan, levels)
    pieces, unsure, skipped = _find_pieces(scan, rooms, levels)
    doors = tuple(_list_doors(scan, levels))
    warnings = [EXPERIMENTAL, SCANNED_SIZES, UNKNOWN_AXES, *([EXITS] if doors else [])]
    if scan.separate:
        warnings.append(
            fill("The {n:,} rooms were scanned one by one and not merged: whether they lie where they are in the "
                 "building is not known. Merge them in the app that scanned them, or check the plan.", n=scan.separate)
        )  # fmt: skip
    return BuildingModel(
        source=name,
        schema=SCHEMA,
        sizes_from="scan",
        storeys=storeys,
        spaces=tuple(rooms),
        doors=doors,
        stairs=tuple(_list_stairs(scan, levels)),
        pieces=tuple(pieces),
        walls={str(story): _draw_walls(scan, story) for story in levels},
        windows={
            str(story): merge(_lay(one, WALL) for one in scan.windows if one.story == story and one.is_upright)
            for story in levels
        },
        skipped=skipped,
        warnings=tuple(warnings),
        remarks=tuple(_remark(scan, unsure)),
    )


def _list_storeys(scan: Scan) -> tuple[Storey, ...]:
    """Return the storeys that hold something, from the lowest, which is taken to be at 0 m."""
    every = (*scan.objects, *scan.walls, *scan.floors, *scan.doors)
    levels = {story: _find_level(scan, story) for story in sorted({one.story for one in every})}
    ground = min(levels.values(), default=0.0)
    return tuple(
        Storey(str(story), gettext("Storey {n}", n=story), level - ground, level)
        for story, level in sorted(levels.items(), key=lambda one: (one[1], one[0]))
    )


def _find_pieces(
    scan: Scan, rooms: Sequence[Space], levels: Mapping[int, float]
) -> tuple[list[Piece], Counter[str], tuple[Skipped, ...]]:
    """Return the pieces, how many were recognised with low confidence by category, and what was left out."""
    pieces, unsure, skipped = list[Piece](), Counter[str](), list[tuple[str, Text, bool]]()
    kinds, search = {one.key: one.kind for one in scan.objects}, SpaceSearch(rooms)
    for one in scan.objects:
        x, y, _z = one.origin.tolist()
        room = next(iter(search.find(str(one.story), (x, y))), None)
        kind = say_word(one.kind) or gettext("Object")
        bottom = one.bottom - (room.bottom if room else levels[one.story])
        left: tuple[Text, bool] | None = None
        if one.kind in (*FIXED, STAIRS):
            left = IS_FIXED, False
        elif one.kind in BUILT_IN and kinds.get(one.parent) == "storage":
            left = IS_BUILT_IN, False
        elif not one.is_upright:
            left = IS_TILTED, True
        elif bottom > ON_FLOOR:
            left = NOT_ON_FLOOR, True
        if left is not None:
            skipped.append((name_skipped(SCHEMA, kind), *left))
            continue
        width, height, depth = one.sizes
        short, long = sorted((width, depth))
        pieces.append(
            Piece(
                key=one.key, storey=str(one.story), space=room.key if room else "", ifc_class=SCHEMA, name=kind,
                type=kind, x=x, y=y, breadth=short, width=long, height=height,
                angle_deg=half_turn(one.direction(0 if width <= depth else 2)), support_breadth=short,
                support_width=long, bottom=bottom, is_fitted=one.kind in FITTED,
            )
        )  # fmt: skip
        unsure[kind] += one.confidence == LOW
    return pieces, unsure, count_skipped(skipped)


def _list_doors(scan: Scan, levels: Mapping[int, float]) -> Iterator[Door]:
    taken: set[str] = set()
    named = ((gettext("Door"), scan.doors), (gettext("Opening"), scan.openings))
    for name, one in ((name, one) for name, several in named for one in several):
        is_passable = one.bottom - levels.get(one.story, one.bottom) <= SILL
        if one.key not in taken and one.is_upright and is_passable and one.sizes[0] > 0:
            taken.add(one.key)
            yield Door(
                key=one.key, storey=str(one.story), name=name, x=float(one.origin[0]), y=float(one.origin[1]),
                normal_deg=one.direction(2), width=one.sizes[0], thickness=one.sizes[2],
                overall=one.sizes[0] if one in scan.doors else 0.0,
            )  # fmt: skip


def _list_stairs(scan: Scan, levels: Mapping[int, float]) -> Iterator[Stair]:
    for one in scan.objects:
        if one.kind == STAIRS:
            x, y, top = float(one.origin[0]), float(one.origin[1]), one.bottom + one.sizes[1]
            yield Stair(one.key, str(one.story), say_word(one.kind), "foot", x, y)
            above = [story for story, level in levels.items() if abs(level - top) <= NEAR_STOREY and story != one.story]
            yield from (Stair(one.key, str(story), say_word(one.kind), "head", x, y) for story in above[:1])


def _remark(scan: Scan, unsure: Counter[str]) -> Iterator[Text]:
    if not scan.objects:
        yield fill("The scan holds no objects: fill in Items by hand.")
    total = unsure.total()
    if total:
        kinds = ", ".join(f"{kind} ({number:,})" for kind, number in unsure.items() if number)
        yield nfill(
            "{n:,} piece was recognised with low confidence: check what it is: {kinds}.",
            "{n:,} pieces were recognised with low confidence: check what they are: {kinds}.",
            total, kinds=kinds,
        )  # fmt: skip
    curved = sum(one.is_curved for one in scan.walls)
    if curved:
        yield nfill("{n:,} curved wall is not drawn.", "{n:,} curved walls are not drawn.", curved)


# ---------------------------------------------------------------- the plan


def _find_turn(walls: Sequence[Scanned]) -> FloatArray:
    """Return the matrix (3, 3) that turns a plan so that the walls run along X and Y.

    Their direction is the mean of all, by their lengths, within 45 degrees of X.
    """
    ways = [(wall.sizes[0], math.radians(wall.direction(0))) for wall in walls if wall.is_upright]
    x, y = (sum(length * way(4 * angle) for length, angle in ways) for way in (math.cos, math.sin))
    turn = -math.atan2(y, x) / 4 if math.hypot(x, y) > 0 else 0.0
    return np.array([[math.cos(turn), -math.sin(turn), 0.0], [math.sin(turn), math.cos(turn), 0.0], [0.0, 0.0, 1.0]])


def _find_level(scan: Scan, story: int) -> float:
    """Return the height of the floor of a storey [m]: of its floors, else where its walls, else its objects begin."""
    floors = [_height_of(one) for one in scan.floors if one.story == story]
    if floors:
        return median(floors)
    walls = [one.bottom for one in scan.walls if one.story == story and one.is_upright]
    if walls:
        return median(walls)
    return min((one.bottom for one in scan.objects if one.story == story), default=0.0)


def _height_of(floor: Scanned) -> float:
    return float(floor.corners[:, 2].mean() if len(floor.corners) else floor.origin[2])


def _draw_walls(scan: Scan, story: int) -> tuple[Area, ...]:
    """Return the walls of a storey with gaps at its doors, windows and openings; those of cylinders are left out."""
    walls = [_lay(one, WALL) for one in scan.walls if one.story == story and one.is_upright and not one.is_curved]
    openings = (*scan.doors, *scan.windows, *scan.openings)
    holes = [_lay(one, 3 * WALL) for one in openings if one.story == story and one.is_upright]
    return merge(list_polygons(shapely.union_all(walls).difference(shapely.union_all(holes))))


def _lay(one: Scanned, least: float) -> Polygon:
    width, thick = one.sizes[0] / 2, max(one.sizes[2], least) / 2
    along, across = (one.axes[:2, axis] for axis in (0, 2))
    return Polygon([one.origin[:2] + x * along + y * across for x, y in _around(width, thick)])


def _around(x: float, y: float) -> tuple[tuple[float, float], ...]:
    return (-x, -y), (x, -y), (x, y), (-x, y)


def _find_rooms(scan: Scan, stories: Iterable[int]) -> list[Space]:
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
            corners = one.corners
            if len(corners) < 3:
                width, height, depth = (size / 2 for size in one.sizes)
                is_flat = height <= depth
                around = _around(width, depth if is_flat else height)
                local = np.array([(x, 0.0, y) if is_flat else (x, y, 0.0) for x, y in around])
                corners = one.origin + local @ one.axes.T
            polygon = find_valid(Polygon(corners[:, :2]))
            if polygon.area >= SMALLEST_ROOM:
                yield one.key, polygon, _height_of(one)


def _close_walls(scan: Scan, story: int) -> Iterator[tuple[str, Polygon, float]]:
    """Yield the areas that the walls of a storey close, each lengthened by `JOINS` so that they meet at corners."""
    level, lines = _find_level(scan, story), []
    for one in scan.walls:
        if one.story == story and one.is_upright and not one.is_curved:
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
