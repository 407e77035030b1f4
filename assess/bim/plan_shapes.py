"""Sizes and outlines of shapes made of triangles: boxes of pieces, plans of rooms, sections of walls. Metres, Z up."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPoint, Polygon

from assess.bim.building_model import Area, Point, Ring

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

AT_FLOOR = 0.03
"""Height above the lowest point up to which a piece is taken to touch the floor [m]."""
UPRIGHT = 0.999
"""Least Z of the vertical axis of a piece that stands upright [-]: within 2.6 degrees."""
CLEARLY_SMALLER = 0.97
"""Share of the rectangle in its own axes below which the smallest rectangle round a piece is taken instead [-]."""
BASE = 0.02
"""Height above the lowest point up to which a triangle is part of the base of a room [m]."""
SMALLEST = 1e-6
"""Area below which a triangle is a line [m2]."""
JOINED = 1e-3
"""Gap across which two parts of an outline are joined [m]."""
NEAREST = 1e-3
"""Edges of a base whose distances from the middle differ by less are as near [m]."""


@dataclass(frozen=True, slots=True)
class Shape:
    """Triangles of an element.

    Attributes
    ----------
    points : (n, 3) array
        Corners in the axes of the model [m].
    triangles : (m, 3) array of int
        Indices of the corners of each triangle.
    axes : (3, 3) array
        Its own axes as columns, in those of the model.
    """

    points: FloatArray
    triangles: IntArray
    axes: FloatArray

    @property
    def bottom(self) -> float:
        """Z of its lowest point [m]."""
        return float(self.points[:, 2].min())

    @property
    def top(self) -> float:
        """Z of its highest point [m]."""
        return float(self.points[:, 2].max())

    def moved(self, dx: float, dy: float) -> "Shape":
        """Return the shape moved in plan [m]."""
        return Shape(self.points + np.array([dx, dy, 0.0]), self.triangles, self.axes)


def join(shapes: Sequence[Shape]) -> Shape:
    """Return the shapes of the parts of an element as one; its axes are those of the first."""
    starts = np.cumsum([0, *(len(one.points) for one in shapes)])
    triangles = [one.triangles + start for one, start in zip(shapes, starts, strict=False)]
    return Shape(np.vstack([one.points for one in shapes]), np.vstack(triangles), shapes[0].axes)


# ---------------------------------------------------------------- boxes


@dataclass(frozen=True, slots=True)
class Box:
    """The box round a piece: centre of its plan, shorter and longer side, height [m]; direction of the shorter [deg].

    `support_breadth` and `support_width` are the distances between its outermost points at the floor along both [m];
    `base` is what the edge of its base that is nearest to the middle leaves it.
    """

    x: float
    y: float
    breadth: float
    width: float
    height: float
    angle_deg: float
    support_breadth: float
    support_width: float
    base: "Base"


@dataclass(frozen=True, slots=True)
class Base:
    """The base of a piece about the middle of its plan: the convex hull of its points at the floor.

    `reach` is the distance from the middle to the nearest edge [m], 0 where the middle lies beside the base;
    `angle_deg` the direction to that edge, in [-90, 90); `across` the extent of the whole plan across that [m].
    """

    reach: float
    angle_deg: float
    across: float


def find_box(shape: Shape) -> Box:
    """Return the box round a piece in its own axes.

    Where the piece is tilted, or the smallest rectangle round its plan is clearly smaller, that rectangle is taken.
    """
    plan = shape.points[:, :2]
    rectangle = _in_own_axes(shape)
    smallest = find_rectangle(plan)
    if smallest is not None and (rectangle is None or smallest.area < CLEARLY_SMALLER * rectangle.area):
        rectangle = smallest
    if rectangle is None:  # a line: no breadth
        middle = plan.mean(axis=0)
        rectangle = Rectangle(float(middle[0]), float(middle[1]), 0.0, float(np.ptp(plan, axis=0).max()), 0.0)
    feet = plan[shape.points[:, 2] <= shape.bottom + AT_FLOOR]
    turn = math.radians(rectangle.angle_deg)
    along, across = np.array([math.cos(turn), math.sin(turn)]), np.array([-math.sin(turn), math.cos(turn)])
    supports = float(np.ptp(feet @ along)), float(np.ptp(feet @ across))
    sides, height = (rectangle.short, rectangle.long), shape.top - shape.bottom
    base = _find_base_edge(plan, feet, rectangle)
    return Box(rectangle.x, rectangle.y, *sides, height, rectangle.angle_deg, *supports, base)


@dataclass(frozen=True, slots=True)
class Rectangle:
    """Centre and sides [m], and the direction of the short side in [-90, 90) [deg]."""

    x: float
    y: float
    short: float
    long: float
    angle_deg: float

    @property
    def area(self) -> float:
        """Its area [m2]."""
        return self.short * self.long


def _find_base_edge(plan: FloatArray, feet: FloatArray, rectangle: Rectangle) -> Base:
    """Return what the nearest edge of the base leaves a piece; of edges that are as near, that along the short side."""
    middle, hull = np.array([rectangle.x, rectangle.y]), MultiPoint(feet).convex_hull
    if not isinstance(hull, Polygon) or not hull.covers(shapely.Point(middle)):
        return Base(0.0, rectangle.angle_deg, rectangle.long)
    corners = np.array(shapely.geometry.polygon.orient(hull).exterior.coords)
    edges = np.diff(corners, axis=0)
    normals = np.stack([edges[:, 1], -edges[:, 0]], axis=1) / np.hypot(edges[:, 0], edges[:, 1])[:, None]
    far = ((corners[:-1] - middle) * normals).sum(axis=1)
    turn = math.radians(rectangle.angle_deg)
    along = np.abs(normals @ np.array([math.cos(turn), math.sin(turn)]))
    near = np.flatnonzero(far < far.min() + NEAREST)
    x, y = normals[near[along[near].argmax()]].tolist()
    angle = (math.degrees(math.atan2(y, x)) + 90) % 180 - 90
    return Base(max(float(far.min()), 0.0), angle, float(np.ptp(plan @ np.array([-y, x]))))


def _in_own_axes(shape: Shape) -> Rectangle | None:
    if abs(shape.axes[2, 2]) < UPRIGHT:
        return None
    x = shape.axes[:2, 0] / math.hypot(*shape.axes[:2, 0])
    y = np.array([-x[1], x[0]])
    plan = shape.points[:, :2]
    p, q = plan @ x, plan @ y
    centre = x * (p.max() + p.min()) / 2 + y * (q.max() + q.min()) / 2
    return _order(centre, x, float(np.ptp(p)), float(np.ptp(q)))


def _order(centre: FloatArray, x: FloatArray, along: float, across: float) -> Rectangle:
    angle = math.degrees(math.atan2(x[1], x[0]))
    if along > across:
        along, across, angle = across, along, angle + 90
    return Rectangle(float(centre[0]), float(centre[1]), along, across, (angle + 90) % 180 - 90)


def find_rectangle(points: FloatArray) -> Rectangle | None:
    """Return the smallest rectangle round points in plan, (n, 2) [m]; None if they lie on a line."""
    found = MultiPoint(points).convex_hull.minimum_rotated_rectangle
    if not isinstance(found, Polygon):
        return None
    corners = np.array(found.exterior.coords)[:4]
    one, other = corners[1] - corners[0], corners[2] - corners[1]
    side = math.hypot(*one)
    return _order(corners.mean(axis=0), one / side, side, math.hypot(*other)) if side > 0 else None


# ---------------------------------------------------------------- outlines


def find_base(shape: Shape) -> Area | None:
    """Return the plan of a room: of its triangles at the bottom, else of all; None if it has no area."""
    corners = shape.points[shape.triangles]
    low = corners[:, :, 2].max(axis=1) < shape.bottom + BASE
    for chosen in (corners[low], corners):
        flat = _list(shapely.polygons(chosen[:, :, :2])) if len(chosen) else []
        parts = [one for one in flat if one.area > SMALLEST]
        area = shapely.union_all(parts).buffer(JOINED, join_style="mitre").buffer(-JOINED, join_style="mitre")
        found = max(list_polygons(area), key=lambda one: one.area, default=None)
        if found is not None:
            return to_area(found)
    return None


def cut(shape: Shape, level: float) -> list[Polygon]:
    """Return the polygons in which a horizontal plane at Z `level` [m] cuts a shape."""
    if not shape.bottom < level < shape.top:
        return []
    height = shape.points[:, 2] - level
    height[np.abs(height) < 1e-9] = 1e-9
    above = height[shape.triangles] > 0
    crossing = shape.triangles[above.any(axis=1) & ~above.all(axis=1)]
    if not len(crossing):
        return []
    lines = _list(shapely.linestrings(np.round(_cross(shape.points, height, crossing), 4)))
    noded = shapely.union_all([one for one in lines if one.length > 0])
    rings = shapely.polygonize([noded]).geoms
    return _nest([one for one in rings if isinstance(one, Polygon)])


def _list(made: Any) -> list[Any]:
    return list(made) if isinstance(made, np.ndarray) else [made]


def _cross(points: FloatArray, height: FloatArray, triangles: IntArray) -> FloatArray:
    """Return where triangles cross the plane, (m, 2, 2): one corner of each lies alone on its side."""
    above = height[triangles] > 0
    alone = np.where(above.sum(axis=1) == 1, above.argmax(axis=1), (~above).argmax(axis=1))
    rows = np.arange(len(triangles))
    first, second, third = (triangles[rows, (alone + step) % 3] for step in range(3))
    found = []
    for other in (second, third):
        share = (height[first] / (height[first] - height[other]))[:, None]
        found.append((points[first] + share * (points[other] - points[first]))[:, :2])
    return np.stack(found, axis=1)


def _nest(rings: list[Polygon]) -> list[Polygon]:
    """Return polygons without those that fill the holes of others: a hollow column is a ring."""
    holes = {shapely.normalize(Polygon(hole)).wkb for one in rings for hole in one.interiors}
    return [one for one in rings if not holes or shapely.normalize(Polygon(one.exterior)).wkb not in holes]


def list_polygons(geometry: Any) -> Iterator[Polygon]:
    """Yield the polygons of a geometry of shapely."""
    if isinstance(geometry, Polygon):
        if not geometry.is_empty:
            yield geometry
    else:
        for part in getattr(geometry, "geoms", ()):
            yield from list_polygons(part)


def to_area(polygon: Polygon) -> Area:
    """Return a polygon as plain data, to the millimetre."""
    return tuple(_to_ring(ring.coords) for ring in (polygon.exterior, *polygon.interiors))


def _to_ring(coordinates: Iterable[Sequence[float]]) -> Ring:
    corners: list[Point] = [(round(float(one[0]), 3), round(float(one[1]), 3)) for one in coordinates]
    return tuple(corners[:-1])


def to_polygon(area: Area) -> Polygon:
    """Return plain data as a polygon of shapely; where its sides cross, its largest valid part, which may be empty."""
    polygon = Polygon(area[0], area[1:])
    if polygon.is_valid:
        return polygon
    return max(list_polygons(shapely.make_valid(polygon)), key=lambda one: one.area, default=Polygon())


def merge(polygons: Iterable[Polygon]) -> tuple[Area, ...]:
    """Return the union of polygons as plain data."""
    union = shapely.union_all(list(polygons))
    return tuple(to_area(one) for one in list_polygons(union.simplify(JOINED / 2)) if one.area > SMALLEST)
