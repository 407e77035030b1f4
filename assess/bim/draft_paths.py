"""Straight ways inside one room between its doors, openings, stairs and its own place, round walls and furniture.

Ways bend at corners of the floor that is left at a distance from walls and pieces. Where that leaves no way, the
distance is reduced, then furniture is walked through: what stands in a way is for the assessment to find.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise, product

import networkx as nx
import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from assess.bim.building_model import Point
from assess.bim.draft_corridors import Axis, Spot, find_axes, find_spots, is_corridor, measure_width
from assess.bim.draft_floor import Link, Room, measure, see
from assess.bim.plan_shapes import list_polygons

TRIES = ((0.48, True, 1.0), (0.35, True, 1.5), (0.2, False, 3.0), (0.05, False, 5.0))
"""What is tried in this order: the distance kept [m], whether ways go round furniture, and the cost of a metre [-]."""
BEND = 0.5
"""What a segment costs beyond its length, so that a way has few of them [m]."""
OFF_AXIS = 3.0
"""Cost of a metre in a corridor off its middle line [-]."""
SHORTEST = 0.05
"""Two nodes that are nearer than this are not joined [m]."""
TIGHT = 0.01
"""What rounding may take of the floor [m]."""
MOST_CORNERS, NEAREST = 100, 20
"""In a room with more corners, or more doors, than this each is joined to so many of its nearest only."""
MOST_OF_ROOM = 1500
"""Corners of one room that are used; of more, those are left out that are far from its doors."""


@dataclass(frozen=True, slots=True)
class Way:
    """A straight way between two nodes of a room, by their names: its cost, and its free width in a corridor [m]."""

    start: str
    end: str
    cost: float
    width: float | None = None


@dataclass(slots=True)
class Ways:
    """The ways inside one room: `ends` are its links and its own place by name, `points` the nodes that are added."""

    room: Room
    ends: Mapping[str, Point]
    points: dict[str, Point]
    found: list[Way]

    def at(self, name: str) -> Point:
        """Return where a node is."""
        return self.ends[name] if name in self.ends else self.points[name]

    def add(self, points: Iterable[Point]) -> dict[str, Point]:
        """Add nodes; return them by name."""
        start = len(self.points)
        added = {f"point {self.room.space.key} {start + at}": point for at, point in enumerate(points)}
        self.points |= added
        return added

    def join(self, pairs: Sequence[tuple[str, str]], area: BaseGeometry, cost: float) -> None:
        """Join nodes that see each other in an area."""
        places = [(self.at(one), self.at(other)) for one, other in pairs]
        for (one, other), (start, end), seen in zip(pairs, places, see(area, places), strict=True):
            length = measure(start, end)
            if seen and length >= SHORTEST:
                self.found.append(Way(one, other, cost * length + BEND))

    def is_joined(self) -> bool:
        """Tell whether every end is joined to every other."""
        graph = nx.Graph([(way.start, way.end) for way in self.found])
        graph.add_nodes_from(self.ends)
        return set(self.ends) <= nx.node_connected_component(graph, next(iter(self.ends)))


def find_ways(room: Room, own: str, place: Point) -> Ways:
    """Return the ways inside a room.

    Parameters
    ----------
    room : Room
        The room, with its links.
    own : str
        Name of the node of the room's own place.
    place : Point
        Where that is.
    """
    ends = {own: place} | {link.name: link.at for link in room.links}
    ways = Ways(room, ends, {}, [])
    factor = 1.0
    if is_corridor(room):
        factor = OFF_AXIS
        _follow_axes(ways)
    for distance, goes_round, cost in TRIES:
        if len(ends) < 2 or ways.is_joined():
            break
        _walk(ways, distance, room.free if goes_round else room.floor, cost * factor)
    return ways


def _walk(ways: Ways, distance: float, floor: BaseGeometry, cost: float) -> None:
    room = ways.room
    inner = floor.buffer(-distance, join_style="mitre")
    passages = [_clear(room, link, distance, floor) for link in room.links]
    reached = [_reach(room, inner, point) for point in ways.ends.values()]
    area = shapely.union_all([inner, *passages, *reached]).buffer(TIGHT)
    before = [
        (link.at[0] + far * x, link.at[1] + far * y)
        for link in room.links
        if link.normal != (0.0, 0.0)
        for x, y in (room.inward(link),)
        for far in (room.floor.distance(shapely.Point(link.at)) + distance + TIGHT,)
    ]
    corners = ways.add(_choose(ways, [*before, *_list_corners(inner)]))
    near = {
        tuple(sorted(pair))
        for pair in (*_near(ways.ends, ways.ends), *_near(ways.ends, corners), *_near(corners, corners))
    }
    ways.join(sorted((one, other) for one, other in near if one != other), area, cost)


def _clear(room: Room, link: Link, distance: float, floor: BaseGeometry) -> BaseGeometry:
    """Return where ways may run through a link, apart from furniture that they go round."""
    passage, around = room.passage(link, distance), min(max(link.clear / 2, SHORTEST), distance)
    return passage if floor is room.floor else passage.difference(room.floor.difference(floor).buffer(around))


def _reach(room: Room, inner: BaseGeometry, point: Point) -> BaseGeometry:
    """Return a strip from a point inside a room to the floor at a distance from its walls."""
    at = shapely.Point(point)
    if inner.is_empty or not room.floor.covers(at):
        return shapely.Polygon()
    return shapely.shortest_line(at, inner).buffer(TIGHT).intersection(room.floor)


def _list_corners(area: BaseGeometry) -> Iterator[Point]:
    """Yield the corners of an area round which a shortest way bends: where its edge turns to the right."""
    for polygon in list_polygons(area):
        for ring in (oriented := shapely.geometry.polygon.orient(polygon)).interiors, [oriented.exterior]:
            for one in ring:
                yield from _list_bends(np.array(one.simplify(SHORTEST).coords)[:-1, :2])


def _list_bends(corners: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Iterator[Point]:
    before, after = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
    for at in np.flatnonzero(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0] < 0):
        yield float(corners[at, 0]), float(corners[at, 1])


def _choose(ways: Ways, points: Iterable[Point]) -> list[Point]:
    """Return points that are not where another is, those nearest to the ends of a room if they are too many."""
    ends = np.array([*ways.ends.values()])
    own = np.array(sorted(set(points))).reshape(-1, 2)
    far = np.abs(own[:, None] - ends[None]).sum(axis=2).min(axis=1)
    own = own[np.argsort(far, kind="stable")[:MOST_OF_ROOM]]
    grid = {tuple(np.round(point / SHORTEST)): (float(point[0]), float(point[1])) for point in own}
    return list(grid.values())


def _near(own: Mapping[str, Point], others: Mapping[str, Point]) -> Iterator[tuple[str, str]]:
    """Yield each of some nodes with each of others, or with its nearest where they are many."""
    if max(len(own), len(others)) <= MOST_CORNERS:
        yield from product(own, others)
        return
    names, places = list(others), np.array([*others.values()])
    for name, at in own.items():
        far = ((places - at) ** 2).sum(axis=1)
        yield from ((name, names[one]) for one in np.argsort(far, kind="stable")[: NEAREST + 1].tolist())


def _follow_axes(ways: Ways) -> None:
    room = ways.room
    axes = find_axes(room)
    joints = [
        (f"end {at} {end}", point)
        for at, axis in enumerate(axes)
        for end, point in enumerate((axis.point(axis.inset), axis.point(axis.length - axis.inset)))
    ]
    every = [*ways.ends.items(), *joints]
    area = shapely.union_all([room.floor, *(room.passage(link, SHORTEST) for link in room.links)]).buffer(TIGHT)
    own: dict[str, list[str]] = {}
    for at, axis in enumerate(axes):
        others = [one for one in every if one[0] not in (f"end {at} 0", f"end {at} 1")]
        names = _add_axis(ways, axis, find_spots(axis, others), own, at)
        ways.found += _along(ways, axis, names)
    pairs = {(name, spot) for name, spots in own.items() for spot in spots if name in ways.ends and name != spot}
    pairs |= {(one, other) for at in range(len(joints)) for one in own.get(f"from {joints[at][0]}", ())
              for other in own.get(joints[at][0], ()) if one != other}  # fmt: skip
    pairs |= {*_near({name: at for name, at in ways.ends.items() if name not in own}, ways.points)}
    ways.join(sorted(pairs), area, 1.0)


def _add_axis(ways: Ways, axis: Axis, spots: Sequence[Spot], own: dict[str, list[str]], number: int) -> list[str]:
    """Add the places on an axis, and note in `own` which nodes are joined to each; return their names."""
    names = []
    for spot in spots:
        on_axis = (name for name in spot.joined if name in ways.ends and _is_on(axis, ways.ends[name]))
        name = next(on_axis, "") or next(iter(ways.add([axis.point(spot.along)])))
        names.append(name)
        for joined in spot.joined:
            own.setdefault(joined, []).append(name)
    for end, name in ((0, names[0]), (1, names[-1])):
        own.setdefault(f"from end {number} {end}", []).append(name)
    return names


def _is_on(axis: Axis, point: Point) -> bool:
    along, away = axis.find(point)
    return away < SHORTEST and axis.inset <= along <= axis.length - axis.inset


def _along(ways: Ways, axis: Axis, names: Sequence[str]) -> Iterator[Way]:
    """Yield the ways between neighbours on an axis; they cost no more for being many."""
    for one, other in pairwise(sorted(names, key=lambda name: axis.find(ways.at(name))[0])):
        ends = ways.at(one), ways.at(other)
        if measure(*ends) >= SHORTEST:
            yield Way(one, other, measure(*ends), measure_width(axis.width, ends, ways.room.floor))
