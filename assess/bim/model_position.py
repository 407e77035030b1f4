"""Building models far from their origin brought near it, without what lies far from the rest of the building."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain
from statistics import median
from typing import Any

from assess.bim.building_model import Area, BuildingModel, Door, Piece, Point, Stair, count_skipped, name_skipped
from assess.i18n import fill

FARTHEST = 10_000.0
"""Distance from the origin up to which positions are kept as they are [m]."""
ROUND = 100.0
"""What is taken off positions farther away is a multiple of this [m]."""
REACH = 2000.0
"""Distance from the middle of the building up to which something belongs to it, along X and Y [m]."""
FAR = fill("more than {reach:g} km from the middle of the building", reach=REACH / 1000)


def bring_near(model: BuildingModel) -> BuildingModel:
    """Return a model whose positions lie near the origin: a workbook holds them to 100 km only, and plans to 5 km.

    What lies far from most of it is left out: elements forgotten at the origin, damaged positions.
    """
    points = list(_list_points(model))
    if not points:
        return model
    near = _leave_out_far(model, *(median(one[axis] for one in points) for axis in (0, 1)))
    points = list(_list_points(near))
    if not points or max(max(abs(x), abs(y)) for x, y in points) <= FARTHEST:
        return near
    x, y = (ROUND * (min(one[axis] for one in points) // ROUND) for axis in (0, 1))

    def move(some: Any) -> Any:
        return tuple(replace(one, x=one.x - x, y=one.y - y) for one in some)

    def move_area(area: Area) -> Area:
        return tuple(tuple((round(u - x, 3), round(v - y, 3)) for u, v in ring) for ring in area)

    def move_plans(plans: Mapping[str, Sequence[Area]]) -> dict[str, tuple[Area, ...]]:
        return {key: tuple(map(move_area, areas)) for key, areas in plans.items()}

    text = fill("The model stands far from its origin: {x:,.0f} m were taken off every X, and {y:,.0f} m off every Y.",
                x=x, y=y)  # fmt: skip
    return replace(
        near, pieces=move(near.pieces), doors=move(near.doors), stairs=move(near.stairs),
        spaces=tuple(replace(one, area=move_area(one.area)) for one in near.spaces),
        walls=move_plans(near.walls), windows=move_plans(near.windows), shift=(x, y), remarks=(*near.remarks, text),
    )  # fmt: skip


def _list_points(model: BuildingModel) -> Iterator[Point]:
    placed: Sequence[Piece | Door | Stair] = (*model.pieces, *model.doors, *model.stairs)
    yield from ((one.x, one.y) for one in placed)
    for area in (*(one.area for one in model.spaces), *chain.from_iterable(model.walls.values())):
        yield from area[0]


def _leave_out_far(model: BuildingModel, x: float, y: float) -> BuildingModel:
    def is_near(*some: Point) -> bool:
        return all(abs(one - x) <= REACH and abs(other - y) <= REACH for one, other in some)

    def keep(some: Any) -> Any:
        return tuple(one for one in some if is_near((one.x, one.y)))

    def keep_areas(plans: Mapping[str, Sequence[Area]]) -> dict[str, tuple[Area, ...]]:
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
        model,
        spaces=spaces,
        doors=keep(model.doors),
        stairs=keep(model.stairs),
        pieces=tuple(pieces),
        walls=keep_areas(model.walls),
        windows=keep_areas(model.windows),
        skipped=(*model.skipped, *count_skipped(far)),
    )
    lost = _count(model) - _count(near)
    if not lost:
        return near
    text = fill("Rooms, doors, stairs and parts of walls that lie more than {reach:g} km from the middle of the "
                "building were left out: {n:,}.", n=lost, reach=REACH / 1000)  # fmt: skip
    return replace(near, remarks=(*near.remarks, text))


def _count(model: BuildingModel) -> int:
    areas = sum(map(len, (*model.walls.values(), *model.windows.values())))
    return len(model.spaces) + len(model.doors) + len(model.stairs) + areas
