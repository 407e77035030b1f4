"""What lies under the pieces of a plan: the user's drawing of the floor, outlines of rooms, and the building's edge."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from assess.model import FloorPlan, Place
from assess.plans.linework import FloatArray, unpack
from assess.report import words
from assess.report.embedded import data_uri
from assess.report.figures.labels import Bounds, Corners, Point
from assess.results import Results

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

Ring = tuple[Point, ...]
"""Corners of a polygon [m]."""

THICKEST = 0.4
"""Thickness of a wall [m] up to which the outlines of two rooms count as joined: assumed."""
GROWN = 1.0
"""How far beyond its pieces a plan is drawn, over their extent."""
LEAST_GROWN = 20.0
"""That distance is at least this [m]."""


@dataclass(frozen=True, slots=True)
class Underlay:
    """The user's drawing of a floor; `image` is the address of a picture, `lines` [m] those of a drawing."""

    file: str
    plan: FloorPlan
    image: str
    lines: tuple[FloatArray, ...]

    @property
    def corners(self) -> Corners:
        """Its frame [m], from its lower left corner anticlockwise."""
        wide, tall = self.plan.width, self.plan.height
        one, two, three, four = (_turned(self.plan, x, y) for x, y in ((0, 0), (wide, 0), (wide, tall), (0, tall)))
        return one, two, three, four


@dataclass(frozen=True, slots=True)
class Room:
    """An outline of a room; `name` is "" where a sign of the place shows it, `centre` a point inside."""

    name: str
    outline: Ring
    centre: Point


def build_underlay(results: Results, floor: str) -> Underlay | None:
    """Return the drawing of a floor; None where there is none, or its series are gone."""
    at = [one.floor for one in results.floor_rows].index(floor)
    plan = results.floor_rows[at].plan
    if plan is None or f"plan/{at}" not in results.series:
        return None
    content = results.series[f"plan/{at}"].tobytes()
    file = words.cut(plan.path.name, 60)
    if not plan.is_lines:
        return Underlay(file, plan, data_uri(content, "image/jpeg"), ())
    lines = tuple(np.column_stack(_turned(plan, *(line * plan.width).T)) for line in unpack(content))
    return Underlay(file, plan, "", lines)


def _turned(plan: FloorPlan, x: float, y: float) -> Point:
    cos, sin = math.cos(math.radians(plan.turn_deg)), math.sin(math.radians(plan.turn_deg))
    return plan.left + x * cos - y * sin, plan.bottom + x * sin + y * cos


def widen(box: Bounds, frame: Sequence[Point]) -> Bounds:
    """Return a box that shows the frame of a drawing as well, but not far beyond what was in the box."""
    grown = max(GROWN * max(box[2] - box[0], box[3] - box[1]), LEAST_GROWN)
    xs, ys = zip(*frame, strict=True)
    return (
        min(box[0], max(min(xs), box[0] - grown)),
        min(box[1], max(min(ys), box[1] - grown)),
        max(box[2], min(max(xs), box[2] + grown)),
        max(box[3], min(max(ys), box[3] + grown)),
    )


def list_rooms(places: Sequence[Place]) -> tuple[Room, ...]:
    """Return the places of a floor that have an outline, the largest first."""
    outlined = [one for one in places if one.outline]
    if not outlined:
        return ()
    from shapely import Polygon

    ordered = sorted(((Polygon(one.outline), one) for one in outlined), key=lambda pair: -pair[0].area)
    found = []
    for at, (shape, one) in enumerate(ordered):
        left: BaseGeometry = shape
        for inner, _place in ordered[at + 1 :]:  # a core inside a corridor, say
            left = left.difference(inner) if shape.covers(inner) and not inner.covers(left) else left
        centre = left.centroid if left.contains(left.centroid) else left.representative_point()
        name = one.place if one.x is None or one.y is None else ""
        found.append(Room(name, one.outline, (centre.x, centre.y)))
    return tuple(found)


def find_edge(
    rooms: Sequence[Room], frame: Sequence[Point], pieces: Sequence[Point]
) -> "tuple[BaseGeometry, str] | None":
    """Return what falls are drawn within, and what it is of; None where that is not known.

    It is the union of the `outlines` of the floor, with the walls between them, if every piece stands in it: rooms
    without an outline would lose their falls. Else it is the `frame` of the user's drawing, on the same condition.
    """
    if not rooms and not frame:
        return None
    from shapely import MultiPoint, Polygon, union_all

    stand = MultiPoint(list(pieces))
    half = THICKEST / 2
    joined = union_all([Polygon(room.outline) for room in rooms]).buffer(half, join_style="mitre")
    edges = {"outlines": joined.buffer(-half, join_style="mitre"), "frame": Polygon(frame)}
    for name, edge in edges.items():
        if not edge.is_empty and edge.covers(stand):
            return edge, name
    return None


def cut_falls(falls: Sequence[Ring], edge: "BaseGeometry") -> tuple[Ring, ...]:
    """Return the parts of convex polygons inside the building's edge: their rings, those of holes turned about."""
    from shapely import Polygon, get_parts
    from shapely.geometry.polygon import orient

    found: list[Ring] = []
    for fall in falls:
        parts = get_parts(Polygon(fall).intersection(edge))
        for part in (orient(one) for one in parts if isinstance(one, Polygon) and not one.is_empty):
            found += [tuple(ring.coords[:-1]) for ring in (part.exterior, *part.interiors)]
    return tuple(found)
