"""Openings without doors between rooms: stretches of the edge of a room from which another is near, without a wall.

A model has no element for them. Along the edges of each room rays lead outward every `STEP`; where rays next to each
other reach the same room over at least `NARROWEST_OPENING`, and meet no wall, window or door, there is an opening: in
the part without furniture where that is wide enough.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from assess.bim.building_model import Door, Point
from assess.bim.draft_floor import FloorPlan, Link
from assess.bim.plan_shapes import FloatArray, box_at, direction_of, list_polygons

NARROWEST_OPENING = 0.6
"""Least width of an opening that a person walks through [m]."""
STEP = 0.1
WIDEST_GAP = 0.55
"""Two rooms that are farther apart than this are not joined without a door [m]."""
INSIDE = 0.05
"""Rays begin this far inside a room, so that a wall drawn on its edge is met [m]."""
NEXT_TO_DOOR = 0.15
"""Up to this far from a door no opening is looked for: the wall is cut away there [m]."""
SAME = 1.0
"""Two openings between the same rooms that are nearer than this are one [m]."""
MOST_RAYS = 200_000
"""So many rays are followed on a storey; rooms with more edges than that are left out."""
AT_ONCE, MOST_HITS = 5_000, 1_000_000
"""Rays that are followed at once, and hits of rooms after which no more are: rooms that lie in each other have many."""


@dataclass(frozen=True, slots=True)
class _Rays:
    """Rays from the edges of the rooms of a storey: where each begins, on the edge, and its direction; (n, 2) arrays.

    `room` and `edge` (n,) are the number of the room, and of the edge among all edges.
    """

    at: FloatArray
    outward: FloatArray
    room: NDArray[np.intp]
    edge: NDArray[np.intp]


def find_openings(plan: FloorPlan, doors: Sequence[Door]) -> list[Link]:
    """Return the openings between the rooms of a storey; none where the storey has no walls to see them by."""
    if len(plan.spaces) < 2 or not plan.solids:
        return []
    rays = _cast(plan)
    if not rays.room.size:
        return []
    reached, full = _find_reached(plan, rays, doors)
    found: dict[frozenset[str], list[Link]] = {}
    free = [-1 if is_full else room for room, is_full in zip(reached, full, strict=True)]
    for is_free, rooms in ((True, free), (False, reached)):
        for other, own in _group(rays, rooms):
            link = _link(plan, rays, own, other)
            pair = found.setdefault(frozenset(link.spaces), [])
            is_new = not pair or (is_free and all(math.dist(one.at, link.at) >= SAME for one in pair))
            if is_new and link.width >= NARROWEST_OPENING - STEP / 2:
                pair.append(link)
    return [link for pair in found.values() for link in pair]


def _cast(plan: FloorPlan) -> _Rays:
    at, outward, room, edge = [np.empty((0, 2))], [np.empty((0, 2))], list[int](), list[int]()
    count = 0
    for number, polygon in enumerate(plan.polygons):
        for start, end in _list_edges(polygon):
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


def _list_edges(polygon: shapely.Polygon) -> Iterator[tuple[Point, Point]]:
    simple = polygon.simplify(STEP / 5)
    for one in list_polygons(simple if simple.is_valid else polygon):
        oriented = shapely.geometry.polygon.orient(one)
        for ring in (oriented.exterior, *oriented.interiors):
            yield from pairwise([(float(x), float(y)) for x, y, *_ in ring.coords])


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


def _group(rays: _Rays, reached: Sequence[int]) -> list[tuple[int, list[int]]]:
    """Return rays next to each other that lead to another room, with the number of that, the widest stretch first."""
    edges = rays.edge.tolist()
    groups = groupby(range(len(edges)), key=lambda ray: (edges[ray], reached[ray]))
    found = [(other, list(own)) for (_, other), own in groups if other >= 0]
    return sorted(found, key=lambda one: (-len(one[1]), one[1][0]))


def _link(plan: FloorPlan, rays: _Rays, own: Sequence[int], other: int) -> Link:
    first, width = own[0], len(own) * STEP
    middle = rays.at[[first, own[-1]]].mean(axis=0)
    u, v = rays.outward[first].tolist()
    gap = float(plan.polygons[other].distance(shapely.Point(middle)))
    at = float(middle[0]) + gap / 2 * u, float(middle[1]) + gap / 2 * v
    spaces = tuple(plan.spaces[room].key for room in (int(rays.room[first]), other))
    return Link(f"opening {spaces[0]} {spaces[1]} {first}", at, (u, v), width, width, spaces)
