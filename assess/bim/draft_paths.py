"""Straight ways inside one room between its doors, openings, stairs and its own place, round walls and furniture.

Ways bend at corners of the floor that is left at a distance from walls and pieces. Where that leaves no way, the
distance is reduced, then furniture is walked through: what stands in a way is for the assessment to find.

In corridors, long narrow rooms that people pass through, ways run along the middle between the walls. So the ways from
many rooms share their segments, and each segment lies in the middle of the free width.
"""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Any

import networkx as nx
import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from assess.bim.building_model import Point
from assess.bim.draft_floor import Room
from assess.bim.plan_shapes import NARROWEST, find_largest, find_width, list_rings

TRIES = ((0.48, True, 1.0), (0.35, True, 1.5), (0.2, False, 3.0), (0.05, False, 5.0))
"""What is tried in this order: the distance kept [m], whether ways go round furniture, and the cost of a metre [-]."""
BEND = 0.5  # what a segment costs beyond its length, so that a way has few of them [m]
OFF_AXIS = 3.0  # cost of a metre in a corridor off its middle line [-]
SHORTEST = 0.05  # two nodes that are nearer than this are not joined [m]
TIGHT = 0.01  # what rounding may take of the floor [m]
MOST_CORNERS, NEAREST = 100, 20
"""In a room with more corners, or more doors, than this each is joined to so many of its nearest only."""
MOST_OF_ROOM = 1500  # corners of one room that are used; of more, those are left out that are far from its doors
PARALLEL = 0.996  # least cosine of the angle between two walls that face each other [-]: 5 degrees
OVERLAP = 1.2  # two walls face each other over at least so many times their distance [-]
MUCH_WIDER = 1.6  # walls that are so many times farther apart than the corridor is wide are not its two sides [-]
MOST_WALLS = 80
SNAP = 0.6  # two places on the middle line that are nearer than this are one [m]
BESIDE = 1.2  # a door up to this far outside the two walls is in one of them [m]
BEYOND = 1.5  # what is up to so many widths beyond the end of a middle line is joined to that end [-]
INSET = 0.45  # middle lines end this far from the walls at their ends [m]


@dataclass(slots=True)
class Ways:
    """The straight ways inside one room. `ends` are its links and its own place by name, `points` the nodes that are
    added; `found` joins two nodes, with the cost, and with the free width in a corridor [m].
    """

    room: Room
    ends: Mapping[str, Point]
    points: dict[str, Point]
    found: list[tuple[str, str, dict[str, Any]]]

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
        shapely.prepare(area)
        lines: Any = shapely.linestrings(np.array(places)) if places else []
        for (one, other), (start, end), seen in zip(pairs, places, shapely.covers(area, lines), strict=True):
            length = math.dist(start, end)
            if seen and length >= SHORTEST:
                self.found.append((one, other, {"cost": cost * length + BEND, "width": None}))

    def is_joined(self) -> bool:
        """Tell whether every end is joined to every other."""
        graph = nx.Graph(self.found)
        graph.add_nodes_from(self.ends)
        return set(self.ends) <= nx.node_connected_component(graph, next(iter(self.ends)))


def find_ways(room: Room, own: str, place: Point) -> Ways:
    """Return the ways inside a room with its links; `own` is the name of the node of the room's own place."""
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
    passages = [room.passage(link, distance) for link in room.links]
    if floor is not room.floor:  # apart from furniture that they go round
        pieces = room.floor.difference(floor)
        around = [min(max(link.clear / 2, SHORTEST), distance) for link in room.links]
        passages = [one.difference(pieces.buffer(free)) for one, free in zip(passages, around, strict=True)]
    # from a point inside the room a strip leads to the floor at a distance from its walls
    places = [] if inner.is_empty else [at for at in map(shapely.Point, ways.ends.values()) if room.floor.covers(at)]
    strips = [shapely.shortest_line(at, inner).buffer(TIGHT).intersection(room.floor) for at in places]
    area = shapely.union_all([inner, *passages, *strips]).buffer(TIGHT)
    bends = set[Point]()
    for link in room.links:
        if link.normal != (0.0, 0.0):
            (x, y), (u, v) = link.at, room.inward(link)
            far = room.floor.distance(shapely.Point(link.at)) + distance + TIGHT
            bends.add((x + far * u, y + far * v))
    for ring in list_rings(inner):  # a shortest way bends where the edge turns to the right
        corners = np.array(ring.simplify(SHORTEST).coords)[:-1, :2]
        before, after = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
        right = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0] < 0
        bends |= {(float(x), float(y)) for x, y in corners[right]}
    # of points at one place the last; if they are too many, those nearest to the ends
    own = np.array(sorted(bends)).reshape(-1, 2)
    away = np.abs(own[:, None] - np.array([*ways.ends.values()])[None]).sum(axis=2).min(axis=1)
    own = own[np.argsort(away, kind="stable")[:MOST_OF_ROOM]]
    grid = {tuple(np.round(point / SHORTEST)): (float(point[0]), float(point[1])) for point in own}
    added = ways.add(grid.values())
    near = {
        tuple(sorted(pair)) for pair in (*_near(ways.ends, ways.ends), *_near(ways.ends, added), *_near(added, added))
    }
    ways.join(sorted((one, other) for one, other in near if one != other), area, cost)


def _near(own: Mapping[str, Point], others: Mapping[str, Point]) -> Iterator[tuple[str, str]]:
    """Yield each of some nodes with each of others, or with its nearest where they are many."""
    if max(len(own), len(others)) <= MOST_CORNERS:
        yield from product(own, others)
        return
    names, places = list(others), np.array([*others.values()])
    for name, at in own.items():
        far = ((places - at) ** 2).sum(axis=1)
        yield from ((name, names[one]) for one in np.argsort(far, kind="stable")[: NEAREST + 1].tolist())


class Axis:
    """The middle line between two walls that face each other: its ends, and the distance of the walls [m].

    Ways along it begin at an `inset` from its ends.
    """

    def __init__(self, start: Point, end: Point, width: float = 0.0) -> None:
        self.start, self.end, self.width = start, end, width
        self.length = math.dist(start, end)
        self.inset = min(INSET, self.length / 3)
        u, v = ((there - here) / self.length if self.length else 0.0 for here, there in zip(start, end, strict=True))
        self.direction = u, v

    def find(self, point: Point) -> tuple[float, float]:
        """Return how far along the axis, and how far from it, a point is [m]."""
        (x, y), (u, v) = self.start, self.direction
        dx, dy = point[0] - x, point[1] - y
        return dx * u + dy * v, abs(dy * u - dx * v)

    def point(self, along: float) -> Point:
        """Return the point so far along it [m]."""
        (x, y), (u, v) = self.start, self.direction
        return x + along * u, y + along * v


def is_corridor(room: Room) -> bool:
    """Tell whether a room is a corridor: long and narrow, with more than one way out."""
    return len(room.links) > 1 and find_width(room.area) > 0


def _find_axes(room: Room) -> list[Axis]:
    """Return the middle lines of a corridor, the longest first; none where no walls face each other."""
    width = find_width(room.area)
    area = find_largest(room.floor)
    smooth = area.buffer(-0.3 * width, join_style="mitre").buffer(0.3 * width, join_style="mitre").simplify(0.05)
    walls = [wall for ring in list_rings(smooth) for wall in pairwise((x, y) for x, y, *_ in ring.coords)]
    if len(walls) > MOST_WALLS:
        return []
    inside = area.buffer(0.05)
    axes = []
    for one, other in ((one, other) for at, one in enumerate(walls) for other in walls[:at]):
        wall, back = Axis(*one), Axis(*other)
        if not (wall.length > NARROWEST and back.length > NARROWEST):
            continue
        (x, y), (u, v), (p, q) = wall.start, wall.direction, back.direction
        gap = sum(u * (b - y) - v * (a - x) for a, b in other) / 2
        if u * p + v * q > -PARALLEL or not NARROWEST <= gap <= MUCH_WIDER * width:
            continue
        places = [wall.find(point)[0] for point in other]
        low, high = max(0.0, min(places)), min(wall.length, max(places))
        if high - low >= OVERLAP * gap:
            start, end = ((a - gap / 2 * v, b + gap / 2 * u) for a, b in one)
            middle = Axis(start, end)
            axis = Axis(middle.point(low), middle.point(high), gap)
            if inside.covers(shapely.LineString([axis.start, axis.end])):
                axes.append(axis)
    return sorted(axes, key=lambda axis: -axis.length)


def measure_width(axis_width: float, ends: tuple[Point, Point], floor: BaseGeometry) -> float:
    """Return the free width of a segment in the middle between two walls [m]: less what stands out of them."""
    line = shapely.LineString(ends)
    away = line.buffer(axis_width / 2, cap_style="flat").buffer(-0.02).difference(floor)
    return min(axis_width, 2 * float(line.distance(away))) if not away.is_empty else axis_width


def _follow_axes(ways: Ways) -> None:
    room = ways.room
    axes = _find_axes(room)
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
        names = _add_axis(ways, axis, others, own, at)
        # neighbours on an axis: such ways cost no more for being many
        for one, other in pairwise(sorted(names, key=lambda name: axis.find(ways.at(name))[0])):
            ends = ways.at(one), ways.at(other)
            if math.dist(*ends) >= SHORTEST:
                width = measure_width(axis.width, ends, room.floor)
                ways.found.append((one, other, {"cost": math.dist(*ends), "width": width}))
    pairs = {(name, spot) for name, spots in own.items() for spot in spots if name in ways.ends and name != spot}
    pairs |= {(one, other) for at in range(len(joints)) for one in own.get(f"from {joints[at][0]}", ())
              for other in own.get(joints[at][0], ()) if one != other}  # fmt: skip
    pairs |= {*_near({name: at for name, at in ways.ends.items() if name not in own}, ways.points)}
    ways.join(sorted(pairs), area, 1.0)


def _add_axis(
    ways: Ways, axis: Axis, nodes: Iterable[tuple[str, Point]], own: dict[str, list[str]], number: int
) -> list[str]:
    """Add the places along an axis at which nodes are joined to it (see `own`), and its ends; return their names."""
    beyond = max(BESIDE, BEYOND * axis.width)
    low, high = axis.inset, axis.length - axis.inset
    found, on_axis = [(low, ""), (high, "")], set[str]()
    for name, point in nodes:
        along, away = axis.find(point)
        if -beyond <= along <= axis.length + beyond and away <= axis.width / 2 + BESIDE:
            found.append((min(max(along, low), high), name))
        if name in ways.ends and away < SHORTEST and low <= along <= high:
            on_axis.add(name)
    spots: list[list[tuple[float, str]]] = []
    for one in sorted(found):
        if spots and one[0] - spots[-1][0][0] < SNAP:
            spots[-1].append(one)
        else:
            spots.append([one])
    names = []
    for spot in spots:
        middle = sum(along for along, _ in spot) / len(spot)
        joined = [name for _, name in spot if name]
        name = next((one for one in joined if one in on_axis), "") or next(iter(ways.add([axis.point(middle)])))
        names.append(name)
        for node in joined:
            own.setdefault(node, []).append(name)
    for end, name in ((0, names[0]), (1, names[-1])):
        own.setdefault(f"from end {number} {end}", []).append(name)
    return names
