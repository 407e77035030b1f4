"""What lies on either side of the doors of a building model, and which of them lead out of the building.

IsExternal of IFC is not used: it is wrong in many models. A door leads out where it has a space on one side only and
is on the ground storey; on another storey such a door leads onto a balcony, a roof or into a shaft.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Literal

import shapely

from assess.bim.building_model import BuildingModel, Door, Space, Storey
from assess.bim.plan_shapes import to_polygon

Sides = tuple[str, str]
"""Keys of the spaces on the side to which the normal of a door points, and on the other; "" where there is none."""
DoorKind = Literal["inside", "exit", "outside", "same room", "no room"]

PROBES = (0.15, 0.35, 0.65)
"""Distances from the face of the wall at which a space is looked for, the nearest first [m]."""
THINNEST = 0.1
"""A wall is taken to be at least so thick [m]."""
REACH = 0.02
"""How far a space may be from the point at which it is looked for [m]."""
BASEMENT = -1.0
"""A storey whose floor is lower than this above the building's zero is a basement [m]."""


def find_sides(model: BuildingModel) -> dict[str, Sides]:
    """Return the spaces on both sides of every door, by the door's key; of spaces that overlap the smallest."""
    found: dict[str, Sides] = {}
    for storey, doors in _by_storey(model.doors).items():
        spaces = [one for one in model.spaces if one.storey == storey]
        found.update(zip((door.key for door in doors), _probe(doors, spaces), strict=True))
    return {door.key: found[door.key] for door in model.doors}


def find_ground(model: BuildingModel) -> Storey | None:
    """Return the storey from which doors lead out of the building; None where no storey has spaces and doors.

    It is the lowest with spaces and doors that is no basement, by its elevation above the building's zero; where all
    are basements, the highest.
    """
    with_spaces, with_doors = ({one.storey for one in some} for some in (model.spaces, model.doors))
    storeys = [one for one in model.storeys if one.key in with_spaces & with_doors]
    above = [one for one in storeys if one.elevation >= BASEMENT]
    if above:
        return min(above, key=lambda one: one.elevation)
    return max(storeys, key=lambda one: one.elevation, default=None)


def find_kinds(model: BuildingModel, sides: Mapping[str, Sides] | None = None) -> dict[str, DoorKind]:
    """Return what each door is, by its key.

    Parameters
    ----------
    model : BuildingModel
        The building.
    sides : mapping of str to Sides, optional
        From `find_sides`, where they are known already.
    """
    sides = find_sides(model) if sides is None else sides
    ground = find_ground(model)
    return {door.key: _classify(door, sides[door.key], ground) for door in model.doors}


def _classify(door: Door, sides: Sides, ground: Storey | None) -> DoorKind:
    one, other = sides
    if one and other:
        return "inside" if one != other else "same room"
    if not (one or other):
        return "no room"
    return "exit" if ground is not None and door.storey == ground.key else "outside"


def find_normal(door: Door) -> tuple[float, float]:
    """Return the direction of the normal of a door's wall, of length 1."""
    turn = math.radians(door.normal_deg)
    return math.cos(turn), math.sin(turn)


def _by_storey(doors: Sequence[Door]) -> dict[str, list[Door]]:
    found: dict[str, list[Door]] = {}
    for door in doors:
        found.setdefault(door.storey, []).append(door)
    return found


def _probe(doors: Sequence[Door], spaces: Sequence[Space]) -> Iterator[Sides]:
    """Yield the sides of the doors of one storey."""
    polygons = [to_polygon(space.area) for space in spaces]
    sizes = [polygon.area for polygon in polygons]
    points = [shapely.Point(at) for door in doors for at in _place_probes(door)]
    hits: dict[int, int] = {}
    for at, space in zip(*_query(polygons, points), strict=True):
        hits[at] = min(hits.get(at, space), space, key=lambda one: (sizes[one], one))
    count = len(PROBES)
    for start in range(0, len(points), 2 * count):
        near = [next((hits[at] for at in range(one, one + count) if at in hits), -1) for one in (start, start + count)]
        one, other = ("" if at < 0 else spaces[at].key for at in near)
        yield one, other


def _query(polygons: Sequence[shapely.Polygon], points: Sequence[shapely.Point]) -> tuple[list[int], list[int]]:
    """Return which points are in which polygons: the numbers of points, and of polygons."""
    found = shapely.STRtree(polygons).query(points, predicate="dwithin", distance=REACH)
    return found[0].tolist(), found[1].tolist()


def _place_probes(door: Door) -> list[tuple[float, float]]:
    """Return where spaces are looked for on the side of a door's normal, then on the other."""
    x, y = find_normal(door)
    away = [max(door.thickness, THINNEST) / 2 + probe for probe in PROBES]
    return [(door.x + sign * far * x, door.y + sign * far * y) for sign in (1, -1) for far in away]
