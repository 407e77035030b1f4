"""The plan of one storey of a building model: its rooms, walls, furniture, and what joins rooms or leads out.

IsExternal of IFC is not used: it is wrong in many models. A door leads out where it has a space on one side only and is
on the ground storey; on another storey such a door leads onto a balcony, a roof or into a shaft.

A model has no element for openings without doors: stretches of the edge of a room from which another is near, without a
wall. Along the edges of each room rays lead outward every `STEP`; where rays next to each other reach the same room
over at least `NARROWEST_OPENING`, and meet no wall, window or door, there is an opening: in the part without furniture
where that is wide enough.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby, pairwise
from typing import Any, Literal, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from assess.bim.building_model import ON_FLOOR, BuildingModel, Door, Point, Space, Stair, Storey
from assess.bim.plan_shapes import SpaceSearch, box_at, direction_of, find_largest, list_polygons, place_at, to_polygon

Sides = tuple[str, str]
"""Keys of the spaces on the side to which the normal of a door points, and on the other; "" where there is none."""
DoorKind = Literal["inside", "exit", "outside", "same room", "no room"]

PROBES = (0.15, 0.35, 0.65)
"""Distances from the face of the door, and of the wall, at which a space is looked for, the nearest first [m]."""
THINNEST = 0.1  # a wall is taken to be at least so thick [m]
THICKEST = 1.5  # so far from the centre of a door the face of its wall is looked for [m]
REACH = 0.02  # how far a space may be from the point at which it is looked for [m]
BASEMENT = -1.0  # a storey whose floor is lower than this above the building's zero is a basement [m]
LOW = 0.1  # a piece up to this high is stepped over [m]
JAMB = 0.1  # what is kept free from either edge of a passage [m]
NARROWEST = 0.2  # least half width of a passage in which ways may run [m]
FAR = 2.0  # a stair end is joined to rooms up to this far away [m]
DOOR_LESS = 0.1  # what frame and leaf take of the overall width of a door, assumed [m]
SAME = 0.005  # difference up to which two widths are the same [m]
TOLERANCE = 0.1  # to this the middle of the free floor is found [m]; in large rooms to a share of their extent
EXTENT_SHARE = 200
MIDWAY = 0.1  # a point that is this near to the middle between two walls is moved there [m]
APART = 0.3  # the place of a room is at least this far from doors and stairs, where there is room [m]
NARROWEST_OPENING = 0.6  # least width of an opening that a person walks through [m]
STEP = 0.1
WIDEST_GAP = 0.55  # two rooms that are farther apart than this are not joined without a door [m]
INSIDE = 0.05  # rays begin this far inside a room, so that a wall drawn on its edge is met [m]
NEXT_TO_DOOR = 0.15  # up to this far from a door no opening is looked for: the wall is cut away there [m]
ONE_OPENING = 1.0  # two openings between the same rooms that are nearer than this are one [m]
MOST_RAYS = 200_000  # so many rays are followed on a storey; rooms with more edges than that are left out
AT_ONCE, MOST_HITS = 5_000, 1_000_000
"""Rays that are followed at once, and hits of rooms after which no more are: rooms that lie in each other have many."""


# ---------------------------------------------------------------- doors and what lies on their sides


def find_sides(model: BuildingModel) -> dict[str, Sides]:
    """Return the spaces on both sides of every door, by the door's key; of spaces that overlap the smallest."""
    search = SpaceSearch(model.spaces)
    solids = {storey: [to_polygon(one) for one in walls] for storey, walls in model.walls.items()}
    trees = {storey: shapely.STRtree(polygons) for storey, polygons in solids.items()}

    def probe(door: Door, sign: int) -> str:
        (u, v), storey, centre = direction_of(door.normal_deg), door.storey, shapely.Point(door.x, door.y)
        x, y, p, q = door.x, door.y, door.x + sign * THICKEST * u, door.y + sign * THICKEST * v
        way = shapely.LineString([(x, y), (p, q)])
        near = [solids[storey][at] for at in sorted(trees[storey].query(way))] if storey in trees else []
        parts = shapely.get_parts(way.intersection(shapely.union_all(near)))
        far = face = max(door.thickness, THINNEST) / 2
        for part in sorted((one for one in parts if isinstance(one, shapely.LineString)), key=centre.distance):
            if centre.distance(part) > far + REACH:
                break
            far = max(far, centre.hausdorff_distance(part))
        away = [face + probe for probe in PROBES]
        if far > face:  # a leaf without an opening is often much thinner than its wall
            away += [far + probe for probe in PROBES]
        places = ((x + one / way.length * (p - x), y + one / way.length * (q - y)) for one in away)
        return next((held[0].key for place in places if (held := search.find(storey, place, REACH))), "")

    return {door.key: (probe(door, 1), probe(door, -1)) for door in model.doors}


def find_ground(model: BuildingModel) -> Storey | None:
    """Return the lowest storey with spaces and doors that is not a basement, else the highest of these, if any."""
    with_spaces, with_doors = ({one.storey for one in some} for some in (model.spaces, model.doors))
    storeys = [one for one in model.storeys if one.key in with_spaces & with_doors]
    above = [one for one in storeys if one.elevation >= BASEMENT]
    if above:
        return min(above, key=lambda one: one.elevation)
    return max(storeys, key=lambda one: one.elevation, default=None)


def find_kinds(model: BuildingModel, sides: Mapping[str, Sides]) -> dict[str, DoorKind]:
    """Return what each door is, by its key, from `find_sides`."""
    ground, kinds = find_ground(model), dict[str, DoorKind]()
    for door in model.doors:
        one, other = sides[door.key]
        if one and other:
            kinds[door.key] = "inside" if one != other else "same room"
        elif one or other:
            kinds[door.key] = "exit" if ground is not None and door.storey == ground.key else "outside"
        else:
            kinds[door.key] = "no room"
    return kinds


# ---------------------------------------------------------------- the plan of a storey


@dataclass(frozen=True, slots=True)
class Link:
    """What joins two rooms, or leads out of one: a door, an opening without a door, or the end of a stair. `name` is
    its key among the nodes of a draft, `normal` that of its wall; (0, 0) for a stair. `width` is that in the plan,
    `clear` is taken to be clear, `overall` the smaller of the stated width of a door and its opening [m]; 0 where
    unknown.
    """

    name: str
    at: Point
    normal: Point
    width: float
    clear: float
    spaces: tuple[str, ...]
    overall: float = 0.0


@dataclass(slots=True)
class FloorPlan:
    """The plan of one storey: spaces with their polygons, walls and windows, furniture that stands on the floor."""

    storey: Storey
    spaces: tuple[Space, ...]
    polygons: tuple[shapely.Polygon, ...]
    solids: tuple[shapely.Polygon, ...]
    footprints: tuple[shapely.Polygon, ...]

    tree: shapely.STRtree = field(init=False)
    solid_tree: shapely.STRtree = field(init=False)
    piece_tree: shapely.STRtree = field(init=False)
    by_key: dict[str, shapely.Polygon] = field(init=False)

    def __post_init__(self) -> None:
        trees = (shapely.STRtree(some) for some in (self.polygons, self.solids, self.footprints))
        self.tree, self.solid_tree, self.piece_tree = trees
        self.by_key = {space.key: polygon for space, polygon in zip(self.spaces, self.polygons, strict=True)}

    def solids_near(self, shape: BaseGeometry) -> BaseGeometry:
        """Return walls and windows that touch a shape, as one."""
        return shapely.union_all([self.solids[at] for at in sorted(self.solid_tree.query(shape))])

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


# ---------------------------------------------------------------- openings without doors


class _Rays(NamedTuple):
    """Rays from the edges of rooms: start and direction, (n, 2), the numbers of the room and of the edge, (n,)."""

    at: NDArray[np.float64]
    outward: NDArray[np.float64]
    room: NDArray[np.intp]
    edge: NDArray[np.intp]


def find_openings(plan: FloorPlan, doors: Sequence[Door]) -> list[Link]:
    """Return the openings between the rooms of a storey; none where the storey has no walls to see them by."""
    if len(plan.spaces) < 2 or not plan.solids:
        return []
    rays = _cast_rays(plan)
    if not rays.room.size:
        return []
    reached, full = _find_reached(plan, rays, doors)
    found: dict[frozenset[str], list[Link]] = {}
    free = [-1 if is_full else room for room, is_full in zip(reached, full, strict=True)]
    edges = rays.edge.tolist()
    for is_free, rooms in ((True, free), (False, reached)):
        # stretches of rays next to each other that lead to another room, the widest first
        groups = groupby(range(len(edges)), key=lambda ray, rooms=rooms: (edges[ray], rooms[ray]))  # type: ignore[misc]
        stretches = [(other, list(own)) for (_, other), own in groups if other >= 0]
        for other, own in sorted(stretches, key=lambda one: (-len(one[1]), one[1][0])):
            first, width = own[0], len(own) * STEP
            middle = rays.at[[first, own[-1]]].mean(axis=0)
            u, v = rays.outward[first].tolist()
            half = float(plan.polygons[other].distance(shapely.Point(middle))) / 2
            at = float(middle[0]) + half * u, float(middle[1]) + half * v
            spaces = tuple(plan.spaces[room].key for room in (int(rays.room[first]), other))
            pair = found.setdefault(frozenset(spaces), [])
            is_new = not pair or (is_free and all(math.dist(one.at, at) >= ONE_OPENING for one in pair))
            if is_new and width >= NARROWEST_OPENING - STEP / 2:
                pair.append(Link(f"opening {spaces[0]} {spaces[1]} {first}", at, (u, v), width, width, spaces))
    return [link for pair in found.values() for link in pair]


def _cast_rays(plan: FloorPlan) -> _Rays:
    at, outward, room, edge = [np.empty((0, 2))], [np.empty((0, 2))], list[int](), list[int]()
    count = 0
    for number, polygon in enumerate(plan.polygons):
        simple = polygon.simplify(STEP / 5)
        parts = map(shapely.geometry.polygon.orient, list_polygons(simple if simple.is_valid else polygon))
        rings = (ring for one in parts for ring in (one.exterior, *one.interiors))
        for start, end in (side for ring in rings for side in pairwise((x, y) for x, y, *_ in ring.coords)):
            length = math.dist(start, end)
            n = int((length + 1e-6) // STEP)
            if n * STEP < NARROWEST_OPENING - STEP or len(room) + n > MOST_RAYS:
                continue
            along = np.subtract(end, start) / length
            places = (length - n * STEP) / 2 + STEP * (np.arange(n) + 0.5)
            at.append(np.array(start) + places[:, None] * along)
            outward.append(np.tile([along[1], -along[0]], (n, 1)))
            room += [number] * n
            edge += [count] * n
            count += 1
    return _Rays(np.vstack(at), np.vstack(outward), np.array(room, np.intp), np.array(edge, np.intp))


def _find_reached(plan: FloorPlan, rays: _Rays, doors: Sequence[Door]) -> tuple[list[int], list[bool]]:
    """Return for each ray the number of the room that it reaches first, -1 if none, and whether it meets furniture."""
    lines: Any = shapely.linestrings(
        np.stack([rays.at - INSIDE * rays.outward, rays.at + WIDEST_GAP * rays.outward], axis=1)
    )
    shut, full = np.zeros(len(lines), dtype=np.bool_), np.zeros(len(lines), dtype=np.bool_)
    zones = [
        box_at(
            (one.x, one.y), direction_of(one.normal_deg), one.thickness / 2 + WIDEST_GAP, one.width / 2 + NEXT_TO_DOOR
        )
        for one in doors
    ]
    for shapes, met in ((plan.solids, shut), (zones, shut), (plan.footprints, full)):
        if shapes:
            met[np.unique(shapely.STRtree(shapes).query(lines, predicate="intersects")[0])] = True
    found, polygons, budget = np.full(len(lines), -1), np.array(plan.polygons), MOST_HITS
    for chosen in np.array_split(np.flatnonzero(~shut), max(1, len(lines) // AT_ONCE)):
        hits, rooms = plan.tree.query(lines[chosen], predicate="intersects")
        hits, rooms = (one[rooms != rays.room[chosen[hits]]] for one in (chosen[hits], rooms))
        near = shapely.distance(shapely.points(rays.at[hits]), polygons[rooms])
        order = np.lexsort((rooms, near))[::-1]  # the nearest last, which stays
        found[hits[order]] = rooms[order]
        budget -= len(hits)
        if budget < 0:
            break
    return found.tolist(), full.tolist()


# ---------------------------------------------------------------- rooms


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


def build_rooms(plan: FloorPlan, links: Sequence[Link]) -> dict[str, Room]:
    """Return the rooms of a storey by the keys of their spaces."""
    rooms = {}
    for space, polygon in zip(plan.spaces, plan.polygons, strict=True):
        floor = _widest(polygon.difference(plan.solids_near(polygon)), polygon)
        pieces = shapely.union_all([plan.footprints[at] for at in sorted(plan.piece_tree.query(polygon))])
        free = floor if pieces.is_empty else _widest(floor.difference(pieces), floor)
        rooms[space.key] = Room(space, polygon, floor, free, tuple(one for one in links if space.key in one.spaces))
    return rooms


def _widest(area: BaseGeometry, otherwise: BaseGeometry) -> BaseGeometry:
    polygons = list(list_polygons(area))
    return shapely.MultiPolygon(polygons) if len(polygons) > 1 else polygons[0] if polygons else otherwise


def find_room_points(model: BuildingModel) -> dict[str, Point]:
    """Return the middle of the widest free floor of each space, else a corner [m]: drafted routes begin there."""
    from shapely.ops import polylabel

    found: dict[str, Point] = {
        space.key: next((ring[0] for ring in space.area if ring), (0.0, 0.0)) for space in model.spaces
    }
    ends: tuple[Door | Stair, ...] = (*model.doors, *model.stairs)
    for storey in model.storeys:
        taken = shapely.MultiPoint([(one.x, one.y) for one in ends if one.storey == storey.key])
        for key, room in build_rooms(build_plan(model, storey), ()).items():
            whole = find_largest(room.free)
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
            close = wall.length
            if close >= MIDWAY:  # nearly midway between two walls is exactly there, so that it is in line with others
                u, v = ((one - other) / close for one, other in zip((x, y), wall.coords[1], strict=True))
                ray = shapely.LineString([(x, y), (x + 2 * close * u, y + 2 * close * v)])
                far = middle.distance(ray & polygon.boundary)
                move = (far - close) / 2 if close < far < close + 2 * MIDWAY else 0.0
                x, y = x + move * u, y + move * v
            found[key] = round(x, 2), round(y, 2)
    return found
