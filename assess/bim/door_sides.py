"""What lies on either side of the doors of a building model, and which of them lead out of the building.

IsExternal of IFC is not used: it is wrong in many models. A door leads out where it has a space on one side only and
is on the ground storey; on another storey such a door leads onto a balcony, a roof or into a shaft.
"""

from collections.abc import Mapping
from typing import Literal

import shapely
from shapely.geometry.base import BaseGeometry

from assess.bim.building_model import BuildingModel, Door, Point, Storey
from assess.bim.plan_shapes import SpaceSearch, direction_of, to_polygon

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
    search = SpaceSearch(model.spaces)
    solids = {storey: [to_polygon(one) for one in walls] for storey, walls in model.walls.items()}
    trees = {storey: shapely.STRtree(polygons) for storey, polygons in solids.items()}

    def probe(door: Door, sign: int) -> str:
        (x, y), storey = direction_of(door.normal_deg), door.storey
        way = shapely.LineString([(door.x, door.y), (door.x + sign * THICKEST * x, door.y + sign * THICKEST * y)])
        near = [solids[storey][at] for at in sorted(trees[storey].query(way))] if storey in trees else []
        places = _place_probes(door, way, shapely.union_all(near))
        return next((held[0].key for place in places if (held := search.find(storey, place, REACH))), "")

    return {door.key: (probe(door, 1), probe(door, -1)) for door in model.doors}


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


def find_kinds(model: BuildingModel, sides: Mapping[str, Sides]) -> dict[str, DoorKind]:
    """Return what each door is, by its key, from `find_sides`."""
    ground = find_ground(model)

    def classify(door: Door) -> DoorKind:
        one, other = sides[door.key]
        if one and other:
            return "inside" if one != other else "same room"
        if not (one or other):
            return "no room"
        return "exit" if ground is not None and door.storey == ground.key else "outside"

    return {door.key: classify(door) for door in model.doors}


def _place_probes(door: Door, way: shapely.LineString, walls: BaseGeometry) -> list[Point]:
    """Return where spaces are looked for on one side of a door: from its face, and from that of the wall round it.

    `way`: from the centre of the door through the thickest wall.
    """
    face = max(door.thickness, THINNEST) / 2
    far, start = face, shapely.Point(way.coords[0])
    parts = [one for one in shapely.get_parts(way.intersection(walls)) if isinstance(one, shapely.LineString)]
    for part in sorted(parts, key=start.distance):
        if start.distance(part) > far + REACH:
            break
        far = max(far, start.hausdorff_distance(part))
    away = [face + probe for probe in PROBES]
    if far > face:  # a leaf without an opening is often much thinner than its wall
        away += [far + probe for probe in PROBES]
    (x, y), (u, v) = way.coords
    return [(x + one / way.length * (u - x), y + one / way.length * (v - y)) for one in away]
