"""The plan of one storey for the drafting of routes: rooms, walls, furniture, and what joins rooms."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import shapely
from shapely.geometry.base import BaseGeometry

from assess.bim.building_model import ON_FLOOR, BuildingModel, Door, Point, Space, Stair, Storey
from assess.bim.door_sides import Sides
from assess.bim.plan_shapes import box_at, direction_of, find_largest, list_polygons, place_at, to_polygon

LOW = 0.1
"""A piece that is no higher than this is stepped over [m]."""
JAMB = 0.1
"""What is kept free from either edge of a passage [m]."""
NARROWEST = 0.2
"""Least half width of a passage in which ways may run [m]."""
FAR = 2.0
"""A stair end is joined to rooms up to this far away [m]."""
DOOR_LESS = 0.1
"""What frame and leaf take of the overall width of a door, assumed [m]."""
SAME = 0.005
"""Difference up to which two widths are the same [m]."""
TOLERANCE = 0.1
"""To this the middle of the free floor is found [m]; in large rooms to a share of their extent."""
EXTENT_SHARE = 200
MIDWAY = 0.1
"""A point that is this near to the middle between two walls is moved there [m]."""
APART = 0.3
"""The place of a room is at least this far from doors and stairs, where there is room [m]."""


@dataclass(frozen=True, slots=True)
class Link:
    """What joins two rooms, or leads out of one: a door, an opening without a door, or the end of a stair.

    `name` is its key among all nodes of a draft, `at` its centre, `normal` the direction of the normal of its wall;
    (0, 0) for a stair, which is reached from any side. `width` is that in the plan, `clear` is taken to be clear, 0
    where nothing is known of it, and `overall` is the smaller of the stated width of a door and its opening [m], 0
    where it is no door. `spaces` are the keys of the spaces that it joins.
    """

    name: str
    at: Point
    normal: Point
    width: float
    clear: float
    spaces: tuple[str, ...]
    overall: float = 0.0


@dataclass(frozen=True)
class FloorPlan:
    """The plan of one storey. `spaces` and `polygons` are in the same order.

    `solids` are walls and windows, `footprints` those of the furniture that stands on the floor.
    """

    storey: Storey
    spaces: tuple[Space, ...]
    polygons: tuple[shapely.Polygon, ...]
    solids: tuple[shapely.Polygon, ...]
    footprints: tuple[shapely.Polygon, ...]

    @cached_property
    def tree(self) -> shapely.STRtree:
        """Return the index of the polygons of spaces."""
        return shapely.STRtree(self.polygons)

    @cached_property
    def _solid_tree(self) -> shapely.STRtree:
        return shapely.STRtree(self.solids)

    @cached_property
    def piece_tree(self) -> shapely.STRtree:
        """Return the index of the furniture."""
        return shapely.STRtree(self.footprints)

    @cached_property
    def by_key(self) -> dict[str, shapely.Polygon]:
        """Return the plans of the spaces by their keys."""
        return {space.key: polygon for space, polygon in zip(self.spaces, self.polygons, strict=True)}

    def solids_near(self, shape: BaseGeometry) -> BaseGeometry:
        """Return walls and windows that touch a shape, as one."""
        return shapely.union_all([self.solids[at] for at in sorted(self._solid_tree.query(shape))])

    def spaces_along(self, line: BaseGeometry, least: float) -> list[str]:
        """Return the keys of the spaces in which more than `least` [m] of a line lies."""
        near = sorted(self.tree.query(line))
        return [self.spaces[at].key for at in near if self.polygons[at].intersection(line).length > least]

    def hides(self, line: BaseGeometry, space: str, within: float) -> bool:
        """Tell whether furniture of a space is within some distance [m] of a line, with a wall between."""
        near = (self.footprints[at] for at in self.piece_tree.query(line, predicate="dwithin", distance=within))
        ways = [shapely.shortest_line(line, one) for one in near if self.by_key[space].intersects(one)]
        return any(self.solids_near(way).intersection(way).length > 0 for way in ways)


def build_plan(model: BuildingModel, storey: Storey) -> FloorPlan:
    """Return the plan of a storey; spaces without an area are left out."""
    pairs = [(space, to_polygon(space.area)) for space in model.spaces if space.storey == storey.key]
    pairs = [(space, polygon) for space, polygon in pairs if polygon.area > 0]
    areas = (*model.walls.get(storey.key, ()), *model.windows.get(storey.key, ()))
    return FloorPlan(
        storey=storey,
        spaces=tuple(space for space, _ in pairs),
        polygons=tuple(polygon for _, polygon in pairs),
        solids=tuple(polygon for area in areas if (polygon := to_polygon(area)).area > 0),
        footprints=tuple(
            box_at((piece.x, piece.y), direction_of(piece.angle_deg), piece.breadth / 2, piece.width / 2)
            for piece in model.pieces
            if piece.storey == storey.key and piece.bottom <= ON_FLOOR and piece.height > LOW
        ),
    )


def link_door(door: Door, sides: Sides) -> Link:
    """Return a door as a link; of its stated width and that of its opening in the plan the smaller is believed."""
    stated, drawn = door.overall, door.width
    overall = drawn if stated <= 0 or 0 < drawn < stated - SAME else stated
    spaces = tuple(dict.fromkeys(key for key in sides if key))
    at, clear = (door.x, door.y), max(overall - DOOR_LESS, 0.0)
    return Link(f"door {door.key}", at, direction_of(door.normal_deg), door.width, clear, spaces, overall)


def link_stairs(model: BuildingModel, plan: FloorPlan) -> list[Link]:
    """Return the ends of stairs on a storey, each joined to the nearest space that no wall keeps from it."""
    found = []
    for stair in model.stairs:
        if stair.storey != plan.storey.key or not plan.spaces:
            continue
        at = shapely.Point(stair.x, stair.y)
        near = plan.tree.query(at, predicate="dwithin", distance=FAR).tolist()
        for one in sorted(near, key=lambda one: (plan.polygons[one].distance(at), plan.polygons[one].area, one)):
            way = shapely.shortest_line(at, plan.polygons[one])
            if plan.solids_near(way).intersection(way).length <= JAMB:
                name, spaces = f"stair {stair.key} {stair.end}", (plan.spaces[one].key,)
                found.append(Link(name, (stair.x, stair.y), (0.0, 0.0), 1.0, 0.0, spaces))
                break
    return found


@dataclass(frozen=True)
class Room:
    """One space with what leads out of it: `area` is its plan, `floor` that less the walls, `free` less furniture."""

    space: Space
    area: shapely.Polygon
    floor: BaseGeometry
    free: BaseGeometry
    links: tuple[Link, ...]

    def passage(self, link: Link, depth: float) -> BaseGeometry:
        """Return where ways may run through a link, up to `depth` [m] into the room; before a door they may fan out."""
        at = shapely.Point(link.at)
        reach = self.floor.distance(at)
        if link.normal == (0.0, 0.0):
            inner = self.floor.buffer(-depth)
            way = shapely.shortest_line(at, self.floor if inner.is_empty else inner)
            return way.buffer(NARROWEST).intersection(shapely.union_all([self.floor, way.buffer(NARROWEST / 2)]))
        inward, far = self.inward(link), reach + depth + JAMB
        if link.overall <= 0:
            half = max(link.width / 2 - depth, JAMB / 2)
            before = box_at(link.at, inward, far, half, 0.0)
        else:
            half = max(link.width / 2 - JAMB, NARROWEST)
            before = place_at(link.at, inward, ((0.0, half), (far, half + far), (far, -half - far), (0.0, -half)))
        through = box_at(link.at, inward, reach + JAMB / 2, half, JAMB / 2)
        return shapely.union_all([through, before.intersection(self.floor)])

    def inward(self, link: Link) -> Point:
        """Return the direction of the normal of a link that points into the room."""
        (x, y), (u, v) = link.at, link.normal
        ways = [shapely.LineString([(x, y), (x + sign * u, y + sign * v)]) for sign in (1, -1)]
        lengths = [self.floor.intersection(way).length for way in ways]
        sign = 1 if lengths[0] >= lengths[1] else -1
        return sign * u, sign * v


def build_rooms(plan: FloorPlan, links: Iterable[Link]) -> dict[str, Room]:
    """Return the rooms of a storey by the keys of their spaces."""
    of_space: dict[str, list[Link]] = {space.key: [] for space in plan.spaces}
    for link in links:
        for key in link.spaces:
            if key in of_space:
                of_space[key].append(link)
    rooms = {}
    for space, polygon in zip(plan.spaces, plan.polygons, strict=True):
        floor = _widest(polygon.difference(plan.solids_near(polygon)), polygon)
        pieces = shapely.union_all([plan.footprints[at] for at in sorted(plan.piece_tree.query(polygon))])
        free = floor if pieces.is_empty else _widest(floor.difference(pieces), floor)
        rooms[space.key] = Room(space, polygon, floor, free, tuple(of_space[space.key]))
    return rooms


def _widest(area: BaseGeometry, otherwise: BaseGeometry) -> BaseGeometry:
    polygons = list(list_polygons(area))
    return shapely.MultiPolygon(polygons) if len(polygons) > 1 else polygons[0] if polygons else otherwise


def find_room_points(model: BuildingModel) -> dict[str, Point]:
    """Return the position of the place of each space, by its key: the middle of its widest free floor [m].

    Drafted routes begin there. A space without an area has its first corner.
    """
    found: dict[str, Point] = {}
    ends: tuple[Door | Stair, ...] = (*model.doors, *model.stairs)
    for storey in model.storeys:
        taken = shapely.MultiPoint([(one.x, one.y) for one in ends if one.storey == storey.key])
        rooms = build_rooms(build_plan(model, storey), ())
        found |= {key: _find_middle(room.free, taken) for key, room in rooms.items()}
    return {
        space.key: found.get(space.key) or next((ring[0] for ring in space.area if ring), (0.0, 0.0))
        for space in model.spaces
    }


def _find_middle(area: BaseGeometry, taken: BaseGeometry) -> Point:
    from shapely.ops import polylabel

    whole = find_largest(area)
    near = taken.intersection(whole.buffer(APART))
    polygon = find_largest(whole.difference(near.buffer(APART)), whole)
    low_x, low_y, high_x, high_y = polygon.bounds
    extent = math.hypot(high_x - low_x, high_y - low_y)
    try:
        middle = polylabel(polygon, max(min(TOLERANCE, polygon.area / extent / 4), extent / EXTENT_SHARE))
    except shapely.errors.ShapelyError:
        middle = polygon.representative_point()
    x, y = middle.x, middle.y
    wall = shapely.shortest_line(middle, polygon.boundary)
    if wall.length >= MIDWAY:  # nearly midway between two walls is exactly there, so that it is in line with others
        near_by = wall.length
        u, v = ((one - other) / near_by for one, other in zip((x, y), wall.coords[1], strict=True))
        ray = shapely.LineString([(x, y), (x + 2 * near_by * u, y + 2 * near_by * v)])
        far = middle.distance(ray & polygon.boundary)
        move = (far - near_by) / 2 if near_by < far < near_by + 2 * MIDWAY else 0.0
        x, y = x + move * u, y + move * v
    return round(x, 2), round(y, 2)
