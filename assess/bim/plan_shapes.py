"""Sizes and outlines of shapes made of triangles: boxes of pieces, plans of rooms, sections of walls. Metres, Z up.

Also which room holds a point of a plan, and which bodies stand on each other.
"""

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPoint, Polygon

from assess.bim.building_model import Area, Point, Space, half_turn
from assess.i18n import Text, nfill
from assess.workbook.habits import name_some

FloatArray = NDArray[np.float64]

AT_FLOOR = 0.03  # height above the lowest point up to which a piece is taken to touch the floor [m]
UPRIGHT = 0.999  # least Z of the vertical axis of a piece that stands upright [-]: within 2.6 degrees
CLEARLY_SMALLER = 0.97
"""Share of the rectangle in its own axes below which the smallest rectangle round a piece is taken instead [-]."""
BASE = 0.02  # height above the lowest point up to which a triangle is part of the base of a room [m]
SMALLEST = 1e-6  # area below which a triangle is a line [m2]
JOINED = 1e-3  # gap across which two parts of an outline are joined [m]
NEAREST = 1e-3  # edges of a base whose distances from the middle differ by less are as near [m]
SLENDER, NARROW = 3.0, 2.5
LONG, WIDE = 6.0, 5.0
"""A corridor is `SLENDER` times as long as wide and up to `NARROW` wide [m], or `LONG` times and up to `WIDE` [m]."""
NARROWEST = 0.6  # walls that are nearer than this to each other have no way between them [m]
NOTHING = Polygon()


@dataclass(frozen=True, slots=True)
class Shape:
    """Triangles of an element: corners (n, 3) [m], indices (m, 3) of those of each, its axes (3, 3) as columns."""

    points: FloatArray
    triangles: NDArray[np.int64]
    axes: FloatArray

    @property
    def bottom(self) -> float:
        """Z of its lowest point [m]."""
        return float(self.points[:, 2].min())

    @property
    def top(self) -> float:
        """Z of its highest point [m]."""
        return float(self.points[:, 2].max())


def join(shapes: Sequence[Shape]) -> Shape:
    """Return the shapes of the parts of an element as one; its axes are those of the first."""
    starts = np.cumsum([0, *(len(one.points) for one in shapes)])
    triangles = [one.triangles + start for one, start in zip(shapes, starts, strict=False)]
    return Shape(np.vstack([one.points for one in shapes]), np.vstack(triangles), shapes[0].axes)


# ---------------------------------------------------------------- boxes


@dataclass(frozen=True, slots=True)
class Box:
    """The box round a piece, with the fields of `Piece`; the base is the convex hull of the points at the floor."""

    x: float
    y: float
    breadth: float
    width: float
    height: float
    angle_deg: float
    support_breadth: float
    support_width: float
    support_reach: float
    support_angle_deg: float
    support_across: float


def find_box(shape: Shape) -> Box:
    """Return the box round a piece in its own axes.

    Where the piece is tilted, or the smallest rectangle round its plan is clearly smaller, that rectangle is taken. Of
    edges of the base that are as near to the middle, that along the short side is taken.
    """
    plan, box = shape.points[:, :2], None
    if abs(shape.axes[2, 2]) >= UPRIGHT:
        own = shape.axes[:2, 0] / math.hypot(*shape.axes[:2, 0])
        other = np.array([-own[1], own[0]])
        p, q = plan @ own, plan @ other
        centre = own * (p.max() + p.min()) / 2 + other * (q.max() + q.min()) / 2
        box = _order(centre, own, float(np.ptp(p)), float(np.ptp(q)))
    smallest = find_rectangle(plan)
    if smallest is not None and (
        box is None or smallest.short * smallest.long < CLEARLY_SMALLER * (box.short * box.long)
    ):
        box = smallest
    if box is None:  # a line: no breadth
        x, y = plan.mean(axis=0)
        box = Rectangle(float(x), float(y), 0.0, float(np.ptp(plan, axis=0).max()), 0.0)
    feet = plan[shape.points[:, 2] <= shape.bottom + AT_FLOOR]
    u, v = direction_of(box.angle_deg)
    supports = float(np.ptp(feet @ np.array([u, v]))), float(np.ptp(feet @ np.array([-v, u])))
    edge = 0.0, box.angle_deg, box.long
    middle, hull = np.array([box.x, box.y]), MultiPoint(feet).convex_hull
    if isinstance(hull, Polygon) and hull.covers(shapely.Point(middle)):
        corners = np.array(shapely.geometry.polygon.orient(hull).exterior.coords)
        edges = np.diff(corners, axis=0)
        normals = np.stack([edges[:, 1], -edges[:, 0]], axis=1) / np.hypot(edges[:, 0], edges[:, 1])[:, None]
        far = ((corners[:-1] - middle) * normals).sum(axis=1)
        near = np.flatnonzero(far < far.min() + NEAREST)
        x, y = normals[near[np.abs(normals @ np.array([u, v]))[near].argmax()]].tolist()
        across = float(np.ptp(plan @ np.array([-y, x])))
        edge = max(float(far.min()), 0.0), half_turn(math.degrees(math.atan2(y, x))), across
    height = shape.top - shape.bottom
    return Box(box.x, box.y, box.short, box.long, height, box.angle_deg, *supports, *edge)


@dataclass(frozen=True, slots=True)
class Rectangle:
    """Centre and sides [m], and the direction of the short side in [-90, 90) [deg]."""

    x: float
    y: float
    short: float
    long: float
    angle_deg: float


def _order(centre: FloatArray, x: FloatArray, along: float, across: float) -> Rectangle:
    angle = math.degrees(math.atan2(x[1], x[0]))
    if along > across:
        along, across, angle = across, along, angle + 90
    return Rectangle(float(centre[0]), float(centre[1]), along, across, half_turn(angle))


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
        flat: Any = shapely.polygons(chosen[:, :, :2])
        parts = [one for one in flat if one.area > SMALLEST]
        area = shapely.union_all(parts).buffer(JOINED, join_style="mitre").buffer(-JOINED, join_style="mitre")
        if not area.is_empty:
            return to_area(find_largest(area))
    return None


def cut(shape: Shape, level: float) -> list[Polygon]:
    """Return the polygons in which a horizontal plane at Z `level` [m] cuts a shape."""
    if not shape.bottom < level < shape.top:
        return []
    height = shape.points[:, 2] - level
    height[np.abs(height) < 1e-9] = 1e-9
    above = height[shape.triangles] > 0
    is_cut = above.any(axis=1) & ~above.all(axis=1)
    crossing, above = shape.triangles[is_cut], above[is_cut]
    if not len(crossing):
        return []
    # one corner of each triangle lies alone on its side of the plane
    alone = np.where(above.sum(axis=1) == 1, above.argmax(axis=1), (~above).argmax(axis=1))
    first, second, third = (crossing[np.arange(len(crossing)), (alone + step) % 3] for step in range(3))
    ends = []
    for other in (second, third):
        share = (height[first] / (height[first] - height[other]))[:, None]
        ends.append((shape.points[first] + share * (shape.points[other] - shape.points[first]))[:, :2])
    lines: Any = shapely.linestrings(np.round(np.stack(ends, axis=1), 4))
    noded = shapely.union_all([one for one in lines if one.length > 0])
    rings = [one for one in shapely.polygonize([noded]).geoms if isinstance(one, Polygon)]
    # without those that fill the holes of others: a hollow column is a ring
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
    rings = (polygon.exterior, *polygon.interiors)
    return tuple(tuple((round(float(x), 3), round(float(y), 3)) for x, y, *_ in ring.coords[:-1]) for ring in rings)


def to_polygon(area: Area) -> Polygon:
    """Return plain data as a polygon of shapely; where its sides cross, its largest valid part, which may be empty."""
    return find_valid(Polygon(area[0], area[1:]))


def find_valid(polygon: Polygon) -> Polygon:
    """Return a polygon; where its sides cross, its largest valid part, which may be empty."""
    return polygon if polygon.is_valid else find_largest(shapely.make_valid(polygon))


def find_largest(geometry: Any, otherwise: Polygon = NOTHING) -> Polygon:
    """Return the largest polygon of a geometry of shapely; `otherwise` where it has none."""
    return max(list_polygons(geometry), key=lambda one: one.area, default=otherwise)


def list_rings(geometry: Any) -> Iterator[shapely.LinearRing]:
    """Yield the rings of the polygons of a geometry: their holes clockwise, then their outer ring anticlockwise."""
    for one in list_polygons(geometry):
        oriented = shapely.geometry.polygon.orient(one)
        yield from (*oriented.interiors, oriented.exterior)


def direction_of(angle_deg: float) -> Point:
    """Return a direction, anticlockwise from X, as a vector of length 1."""
    turn = math.radians(angle_deg)
    return math.cos(turn), math.sin(turn)


def place_at(at: Point, direction: Point, corners: Sequence[Point]) -> Polygon:
    """Return a polygon whose corners are given along a direction and to the left of it, from a point [m]."""
    (x, y), (u, v) = at, direction
    return Polygon([(x + a * u - b * v, y + a * v + b * u) for a, b in corners])


def box_at(at: Point, direction: Point, along: float, across: float, behind: float | None = None) -> Polygon:
    """Return a rectangle: `along` a direction, `behind` against it (as far, if not given) and `across` each way [m]."""
    back = -along if behind is None else -behind
    return place_at(at, direction, ((along, -across), (along, across), (back, across), (back, -across)))


def merge(polygons: Iterable[Polygon]) -> tuple[Area, ...]:
    """Return the union of polygons as plain data."""
    union = shapely.union_all(list(polygons))
    return tuple(to_area(one) for one in list_polygons(union.simplify(JOINED / 2)) if one.area > SMALLEST)


def find_width(area: shapely.geometry.base.BaseGeometry) -> float:
    """Return the width of a long narrow area [m], that of the rectangle of its area and perimeter; 0 for others."""
    half, size = area.length / 2, area.area
    root = half**2 - 4 * size
    if root <= 0:
        return 0.0
    width = (half - math.sqrt(root)) / 2
    ratio = (half - width) / width if width > 0 else math.inf
    is_narrow = width <= NARROW and ratio >= SLENDER
    return width if width >= NARROWEST and (is_narrow or (width <= WIDE and ratio >= LONG)) else 0.0


class SpaceSearch:
    """Finds the spaces that hold a point: some programs export the gross area of a storey as a space, too."""

    def __init__(self, spaces: Iterable[Space]) -> None:
        self._spaces: dict[str, list[Space]] = {}
        for one in spaces:
            self._spaces.setdefault(one.storey, []).append(one)
        self._polygons = {storey: [to_polygon(one.area) for one in own] for storey, own in self._spaces.items()}
        self._trees = {storey: shapely.STRtree(polygons) for storey, polygons in self._polygons.items()}

    def find(self, storey: str, point: Point, reach: float = 0.0) -> list[Space]:
        """Return the spaces up to `reach` [m] from a point in plan, the smallest first; of those that are as large the
        first.
        """
        if storey not in self._trees:
            return []
        hits = self._trees[storey].query(shapely.Point(point), predicate="dwithin", distance=reach).tolist()
        polygons, spaces = self._polygons[storey], self._spaces[storey]
        return [spaces[at] for at in sorted(hits, key=lambda at: (polygons[at].area, at))]


# ---------------------------------------------------------------- bodies that stand on each other


TOUCHING = 0.02  # gap up to which two bodies touch [m]
LEAST_COVER = 0.5
"""Share of the plan of the lower body from which the upper one belongs to it; a lamp on a table covers less [-]."""
MOST_NAMED = 5

Bounds = FloatArray  # least and largest X, Y and Z of bodies, (n, 6): x, y, z, X, Y, Z [m]


def find_pairs(upper: Bounds, lower: Bounds, *, at_side: bool = False) -> list[tuple[int, int]]:
    """Return the pairs of an upper body, which does not stand on the floor, and one on which it stands.

    `at_side`: also of one that it touches at a side, as a shelf between the sides of a bookcase does.
    """
    tree = shapely.STRtree(shapely.box(lower[:, 0], lower[:, 1], lower[:, 3], lower[:, 4]))
    gap = TOUCHING
    wide = shapely.box(upper[:, 0] - gap, upper[:, 1] - gap, upper[:, 3] + gap, upper[:, 4] + gap)
    above, below = tree.query(wide)
    bottom = upper[above, 2]
    least = lower[below, 2 if at_side else 5] - gap
    reach = (least <= bottom) & (bottom <= lower[below, 5] + gap)
    over = np.minimum(upper[above, 3:5], lower[below, 3:5]) - np.maximum(upper[above, :2], lower[below, :2])
    own, area = ((one[:, 3:5] - one[:, :2]).prod(axis=1) for one in (upper, lower))
    cover = own[above] if at_side else over.clip(0).prod(axis=1)
    found = reach & (cover >= LEAST_COVER * area[below])
    return [(int(one), int(other)) for one, other in zip(above[found], below[found], strict=True)]


def find_stacks(
    groups: Iterable[Sequence[int]], bounds: Mapping[int, Bounds], on_floor: Collection[int], *, at_side: bool = False
) -> Iterator[tuple[list[int], bool]]:
    """Yield the bodies of a group that are one piece, the lowest first, and whether they are the whole group.

    What is off the floor belongs to what it touches; bodies that stand next to each other on the floor stay apart.
    `at_side`: see `find_pairs`.
    """
    for members in groups:
        off, own = [one for one in members if one not in on_floor], np.array([bounds[one] for one in members])
        label = {one: at for at, one in enumerate(members)}
        for at, other in find_pairs(np.array([bounds[one] for one in off]).reshape(-1, 6), own, at_side=at_side):
            one, two = label[off[at]], label[members[other]]
            label = {each: min(one, two) if kind in (one, two) else kind for each, kind in label.items()}
        for kind in dict.fromkeys(label.values()):
            stack = [one for one in members if label[one] == kind]
            if len(stack) > 1:
                yield sorted(stack, key=lambda one: (one not in on_floor, bounds[one][2])), len(stack) == len(members)


def note_stacked(names: Sequence[str], bounds: Bounds, left: Bounds) -> list[Text]:
    """Return the warning about the taken pieces on which others stand that were left out."""
    pairs = find_pairs(left, bounds) if len(bounds) and len(left) else []
    if not pairs:
        return []
    carriers = dict.fromkeys(other for _, other in pairs)
    text = nfill(
        "Something that was left out stands on {n:,} piece, whose height is then not the whole: {names}. Check its "
        "Height in Items.",
        "Something that was left out stands on {n:,} pieces, whose heights are then not the whole: {names}. Check "
        "their Height in Items.", len(carriers), names=name_some([names[at] for at in carriers], MOST_NAMED),
    )  # fmt: skip
    return [text]
