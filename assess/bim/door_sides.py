"""What lies on either side of the doors of a building model, and which of them lead out of the building.

IsExternal of IFC is not used: it is wrong in many models. A door leads out where it has a space on one side only and
is on the ground storey; on another storey such a door leads onto a balcony, a roof or into a shaft.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Literal

import shapely
from shapely.geometry.base import BaseGeometry

from assess.bim.building_model import Area, BuildingModel, Door, Point, Space, Storey
from assess.bim.plan_shapes import to_polygon
from assess.bim.space_search import SpaceSearch

Sides = tuple[str, str]
"""Keys of the spaces on the side to which the normal of a door points, and on the other; "" where there is none."""
DoorKind = Literal["inside", "exit", "outside", "same room", "no room"]

PROBES = (0.15, 0.35, 0.65)
"""Distances from the face of the door, and of the wall, at which a space is looked for, the nearest first [m]."""
THINNEST = 0.1
"""A wall is taken to be at least so thick [m]."""
THICKEST = 1.5
"""So far from the centre of a door the face of its wall is looked for [m]."""
REACH = 0.02
"""How far a space may be from the point at which it is looked for [m]."""
BASEMENT = -1.0
"""A storey whose floor is lower than this above the building's zero is a basement [m]."""


def find_sides(model: BuildingModel) -> dict[str, Sides]:
    """Return the spaces on both sides of every door, by the door's key; of spaces that overlap the smallest."""
    found: dict[str, Sides] = {}
    by_storey: dict[str, list[Door]] = {}
    for door in model.doors:
        by_storey.setdefault(door.storey, []).append(door)
    for storey, doors in by_storey.items():
        spaces, walls = [one for one in model.spaces if one.storey == storey], model.walls.get(storey, ())
        found.update(zip((door.key for door in doors), _probe(doors, spaces, walls), strict=True))
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

    `sides`: from `find_sides`, where they are known already.
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


def _probe(doors: Sequence[Door], spaces: Sequence[Space], walls: Sequence[Area]) -> Iterator[Sides]:
    search, solids = SpaceSearch(spaces), [to_polygon(one) for one in walls]
    tree = shapely.STRtree(solids)
    for door in doors:
        ways = [_look(door, sign) for sign in (1, -1)]
        near = [shapely.union_all([solids[at] for at in sorted(tree.query(way))]) for way in ways]
        probes = [_place_probes(door, way, wall) for way, wall in zip(ways, near, strict=True)]
        one, other = (next((held[0].key for held in search.find_all(own, REACH) if held), "") for own in probes)
        yield one, other


def _look(door: Door, sign: int) -> shapely.LineString:
    """Return the line from the centre of a door along its normal, or against it, through the thickest wall."""
    x, y = find_normal(door)
    return shapely.LineString([(door.x, door.y), (door.x + sign * THICKEST * x, door.y + sign * THICKEST * y)])


def _place_probes(door: Door, way: shapely.LineString, walls: BaseGeometry) -> list[Point]:
    """Return where spaces are looked for on one side of a door: from its face, and from that of the wall round it."""
    face = max(door.thickness, THINNEST) / 2
    away = [face + probe for probe in PROBES]
    far = _find_face(way, walls, face)
    if far > face:  # a leaf without an opening is often much thinner than its wall
        away += [far + probe for probe in PROBES]
    return [_reach(way, one) for one in away]


def _find_face(way: shapely.LineString, walls: BaseGeometry, face: float) -> float:
    """Return how far along a line from a door the wall round it ends [m]; `face` where it is thinner."""
    start = shapely.Point(way.coords[0])
    parts = [one for one in shapely.get_parts(way.intersection(walls)) if isinstance(one, shapely.LineString)]
    for part in sorted(parts, key=start.distance):
        if start.distance(part) > face + REACH:
            break
        face = max(face, start.hausdorff_distance(part))
    return face


def _reach(way: shapely.LineString, far: float) -> Point:
    """Return the point so far along a line, or beyond its end [m]."""
    (x, y), (u, v) = way.coords
    share = far / way.length
    return x + share * (u - x), y + share * (v - y)
