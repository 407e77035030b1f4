"""What is read of a building model, as plain data: what makes rows, plans and routes of it needs no reader of models.

Lengths are in metres in the axes of the model, X and Y in plan and Z upwards; angles in degrees anticlockwise from X.
Readers fill it in (`ifc_model`, `roomplan`, `sweet_home`), and `model_rows`, `floor_drawing` and `draft_routes` use it.
Models far from their origin are brought near it, without what lies far from the rest of the building.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from statistics import median
from typing import Any, Literal

from assess.i18n import Text, fill

ON_FLOOR = 0.15  # height of its lowest point above the floor up to which a piece stands on it [m]
SILL = 0.3  # height of its lower edge above the floor up to which people walk through an opening [m]
NOT_ON_FLOOR = fill("not on the floor: its lowest point is more than 15 cm above it")
IS_TILTED = fill("not upright")
LONGEST_NAME = 120  # characters that are kept of a name
SMALLEST_ROOM = 0.5  # area below which an outline is not taken as a room [m2]
FARTHEST = 10_000.0  # distance from the origin up to which positions are kept as they are [m]
ROUND = 100.0  # what is taken off positions farther away is a multiple of this [m]
REACH = 2000.0  # distance from the middle of the building up to which something belongs to it, along X and Y [m]
FAR = fill("more than {reach:g} km from the middle of the building", reach=REACH / 1000)

Point = tuple[float, float]
Ring = tuple[Point, ...]  # corners in order round it; the last is not the first again
Area = tuple[Ring, ...]  # a polygon: its outer ring, then those of its holes


@dataclass(frozen=True, slots=True)
class Storey:
    """A storey, with the Z of its floor above the building's zero (`elevation`) and in the model (`level`) [m]. `key`
    is "" where the model has no storeys, and this one stands for all of it.
    """

    key: str
    name: str
    elevation: float
    level: float


@dataclass(frozen=True, slots=True)
class Space:
    """A room or corridor: its plan, Z of floor and ceiling [m]; `name` is often a number, `title` its longer name."""

    key: str
    storey: str
    name: str
    title: str
    area: Area
    bottom: float
    top: float


@dataclass(frozen=True, slots=True)
class Door:
    """A door: its centre, the normal of its wall, and the sizes of its opening in the plan and of the wall [m].
    `overall` is the OverallWidth that the model states, 0 where it states none.
    """

    key: str
    storey: str
    name: str
    x: float
    y: float
    normal_deg: float
    width: float
    thickness: float
    overall: float


@dataclass(frozen=True, slots=True)
class Stair:
    """One end of a stair or ramp on a storey."""

    key: str
    storey: str
    name: str
    end: Literal["foot", "head"]
    x: float
    y: float


@dataclass(frozen=True, slots=True)
class Piece:
    """A piece of furniture: `x`, `y` are the centre of its plan, its height is from its lowest point [m].

    * `breadth`, `width`: shorter and longer side of its plan [m]; `angle_deg` is the direction of the first.
    * `support_breadth`, `support_width`: distance between its outermost points at the floor along either side [m].
    * `bottom`: height of its lowest point above the floor of its room, or of its storey [m].
    * `is_fitted`: whether its name tells of kitchen or fitted furniture, which is usually fixed.
    * `support_reach`: least distance from the middle of its plan to an edge of its base, the convex hull of its points
      at the floor [m]: 0 where the middle lies outside it, None where the shape of the base is not known.
    * `support_angle_deg`, `support_across`: direction to that edge, and extent of its plan across that direction [m].

    `space` and `type` are "" where it has none; angles lie in [-90, 90).
    """

    key: str
    storey: str
    space: str
    ifc_class: str
    name: str
    type: str
    x: float
    y: float
    breadth: float
    width: float
    height: float
    angle_deg: float
    support_breadth: float
    support_width: float
    bottom: float
    is_fitted: bool = False
    support_reach: float | None = None
    support_angle_deg: float = 0.0
    support_across: float = 0.0


@dataclass(frozen=True, slots=True)
class Skipped:
    """Elements of one type, or class, that were left out for one reason; not `is_furniture` where the file says so."""

    type: str
    count: int
    reason: Text
    is_furniture: bool = True


def half_turn(angle_deg: float) -> float:
    """Return a direction of a side, whose two ends are alike, in [-90, 90) [deg]."""
    return (angle_deg + 90) % 180 - 90


def name_skipped(ifc_class: str, kind: str) -> str:
    """Return the type of an element that is left out: its class in the file, and its type where that says more."""
    return (kind if kind == ifc_class else f"{ifc_class} {kind}")[:LONGEST_NAME]


def count_skipped(each: Iterable[tuple[str, Text, bool]]) -> tuple[Skipped, ...]:
    """Return what was left out from the type, the reason and `is_furniture` of each element."""
    counts = Counter(each)
    return tuple(Skipped(kind, number, reason, is_one) for (kind, reason, is_one), number in counts.items())


@dataclass(frozen=True, slots=True, kw_only=True)
class BuildingModel:
    """A building model; "" or None where it does not say. Storeys are ordered from the lowest. Walls, with columns and
    curtain walls, and windows are cut at 1.2 m above the floor, by the storey's key. `azimuth_deg` is the compass
    direction of X. `shift` was taken off X and Y [m]: 0 unless the model stands far from its origin. `warnings` may
    distort results.
    """

    source: str
    schema: str
    sizes_from: Literal["model", "scan"] = "model"  # words of the column Sizes from
    name: str = ""
    address: str = ""
    storeys: tuple[Storey, ...] = ()
    spaces: tuple[Space, ...] = ()
    doors: tuple[Door, ...] = ()
    stairs: tuple[Stair, ...] = ()
    pieces: tuple[Piece, ...] = ()
    walls: Mapping[str, tuple[Area, ...]] = field(default_factory=dict)
    windows: Mapping[str, tuple[Area, ...]] = field(default_factory=dict)
    skipped: tuple[Skipped, ...] = ()
    azimuth_deg: float | None = None
    latitude: float | None = None
    longitude: float | None = None
    shift: Point = (0.0, 0.0)
    warnings: tuple[Text, ...] = ()
    remarks: tuple[Text, ...] = ()


def bring_near(model: BuildingModel) -> BuildingModel:
    """Return a model near the origin, as workbooks hold positions to 100 km, without what lies far from the rest."""
    points = list(_list_points(model))
    if not points:
        return model
    middle = tuple(median(one[axis] for one in points) for axis in (0, 1))

    def is_near(*some: Point) -> bool:
        return all(abs(one - at) <= REACH for point in some for one, at in zip(point, middle, strict=True))

    def keep(plans: Mapping[str, Sequence[Area]]) -> dict[str, tuple[Area, ...]]:
        return {key: tuple(one for one in areas if is_near(*one[0])) for key, areas in plans.items()}

    spaces = tuple(one for one in model.spaces if is_near(*one.area[0]))
    known = {one.key for one in spaces}
    pieces, far = [], []
    for one in model.pieces:
        if is_near((one.x - one.width, one.y - one.width), (one.x + one.width, one.y + one.width)):
            pieces.append(one if one.space in known else replace(one, space=""))
        else:
            far.append((name_skipped(one.ifc_class, one.type), FAR, True))
    near = replace(
        model, spaces=spaces, doors=tuple(one for one in model.doors if is_near((one.x, one.y))),
        stairs=tuple(one for one in model.stairs if is_near((one.x, one.y))), pieces=tuple(pieces),
        walls=keep(model.walls), windows=keep(model.windows), skipped=(*model.skipped, *count_skipped(far)),
    )  # fmt: skip
    before, after = (
        sum(map(len, (one.spaces, one.doors, one.stairs, *one.walls.values(), *one.windows.values())))
        for one in (model, near)
    )
    if before > after:
        text = fill("Rooms, doors, stairs and parts of walls that lie more than {reach:g} km from the middle of the "
                    "building were left out: {n:,}.", n=before - after, reach=REACH / 1000)  # fmt: skip
        near = replace(near, remarks=(*near.remarks, text))
    points = list(_list_points(near))
    if not points or max(max(abs(x), abs(y)) for x, y in points) <= FARTHEST:
        return near
    x, y = (ROUND * (min(one[axis] for one in points) // ROUND) for axis in (0, 1))

    def move(some: Any) -> Any:
        return tuple(replace(one, x=one.x - x, y=one.y - y) for one in some)

    def move_area(area: Area) -> Area:
        return tuple(tuple((round(u - x, 3), round(v - y, 3)) for u, v in ring) for ring in area)

    walls, windows = (
        {key: tuple(map(move_area, areas)) for key, areas in plans.items()} for plans in (near.walls, near.windows)
    )
    text = fill("The model stands far from its origin: {x:,.0f} m were taken off every X, and {y:,.0f} m off every Y.",
                x=x, y=y)  # fmt: skip
    return replace(
        near, pieces=move(near.pieces), doors=move(near.doors), stairs=move(near.stairs), walls=walls, windows=windows,
        spaces=tuple(replace(one, area=move_area(one.area)) for one in near.spaces), shift=(x, y),
        remarks=(*near.remarks, text),
    )  # fmt: skip


def _list_points(model: BuildingModel) -> Iterator[Point]:
    placed: Sequence[Piece | Door | Stair] = (*model.pieces, *model.doors, *model.stairs)
    yield from ((one.x, one.y) for one in placed)
    for area in (*(one.area for one in model.spaces), *chain.from_iterable(model.walls.values())):
        yield from area[0]
