"""Which pieces can lie on which segment once they have fallen, and the gaps that they leave.

No publication gives a closed rule for this; ours is for screening. A fallen piece covers Height x Width outward from
its tipping edge, and where it stood. Where the plan tells the place of piece and segment, what is covered follows from
it, and a piece that may fall either way covers whatever of both ways lies in the segment. Else the Edge distance d
tells that it covers Height - d of the width, on a side and at a place along the segment that are not known: it may face
any other. Walls are known only where Routes names the Room: placed pieces of other rooms cannot reach the segment then.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from assess.inventory.labels import key
from assess.inventory.model import Inventory, Item, Segment
from assess.inventory.routes import DEFAULT_WIDTH
from assess.routes.band import Band, build_bands
from assess.routes.flags import BLIND
from assess.routes.gaps import Gaps, Key, Obstacle, build_gaps
from assess.routes.model import Beside
from assess.routes.shapes import Shape, build_shapes
from assess.routes.widths import NARROWER

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

TELLING = 0.1
"""By how much [m] a given Edge distance must be nearer than the plan says for it to count instead."""
TOUCH = 1e-6
"""Area [m2] up to which two shapes only touch."""

SIDES: tuple[Literal["left", "right"], ...] = ("left", "right")


@dataclass(frozen=True, slots=True, eq=False)
class Reached:
    """One segment with the pieces that reach it, before anything is known of their chances.

    `clear` and `required` are the widths used [m], `standing` is the one left with nothing fallen; `flags` are keys
    of `assess.routes.flags.FLAGS`. `other_rooms` are pieces that only their Room keeps away.
    """

    segment: Segment
    clear: float
    required: float
    band: Band | None
    flags: tuple[str, ...]
    beside: tuple[Beside, ...]
    gaps: Gaps
    other_rooms: tuple[int, ...]
    standing: float

    @property
    def is_evaluated(self) -> bool:
        """Whether anything tells which pieces can reach it; where it is too narrow as it stands, none need."""
        return bool(self.beside) or BLIND.isdisjoint(self.flags) or self.standing < self.required - NARROWER

    @property
    def keys(self) -> tuple[Key, ...]:
        """The pieces that may fall onto it."""
        return self.gaps.keys

    def narrower(self, fallen: Mapping[Key, int], every: int, width: float) -> int:
        """Return the set of the draws, of `every`, in which it is narrower than a width [m], by more than rounding.

        `fallen` has for each piece the set of those in which it falls; others stand.
        """
        return self.gaps.narrower(fallen, every, width - NARROWER)

    def blocked(self, fallen: Mapping[Key, int], every: int) -> int:
        """Return the same for its required width."""
        return self.narrower(fallen, every, self.required)


@dataclass(frozen=True, slots=True)
class _Told:
    """What is told of one piece beside one segment."""

    distance: float
    obstacles: Sequence[Obstacle]
    flags: tuple[str, ...]


def find_reached(inventory: Inventory) -> tuple[Reached, ...]:
    """Return every segment of the inventory with the pieces that reach it."""
    if not inventory.routes:
        return ()
    clear = [one.clear_width or one.required_width or DEFAULT_WIDTH for one in inventory.routes]
    bands = build_bands(inventory, dict(enumerate(clear)))
    shapes = build_shapes(inventory.items, {inventory.routes[at].floor for at in bands})
    named, near = _named(inventory), _near(inventory, shapes, bands)
    floors = {place.place: place.floor for place in inventory.places}
    found = []
    for at, segment in enumerate(inventory.routes):
        told: dict[int, _Told] = {}
        for index in near.get(at, ()):
            told |= _by_plan(index, shapes[index], bands[at])
        others = [index for index in told if _is_walled_off(inventory.items[index], segment)]
        told = {index: one for index, one in told.items() if index not in others}
        for index in named.get(at, ()):
            told |= _by_distance(index, inventory.items[index], clear[at], bands.get(at), shapes.get(index))
        is_flight = floors.get(segment.start) != floors.get(segment.end)
        found.append(_reach(segment, clear[at], bands.get(at), told, others, is_flight=is_flight))
    return tuple(found)


def _is_walled_off(item: Item, segment: Segment) -> bool:
    """Tell whether a wall stands between: the rooms are known and not the same, and the piece does not name it."""
    is_named = item.route == segment.route and item.segment in ("", segment.segment)
    rooms = {key(room) for room in segment.rooms}
    return not is_named and bool(rooms) and bool(item.room) and key(item.room) not in rooms


def _reach(
    segment: Segment,
    clear: float,
    band: Band | None,
    told: Mapping[int, _Told],
    others: Sequence[int],
    *,
    is_flight: bool,
) -> Reached:
    required = segment.required_width or DEFAULT_WIDTH
    obstacles = [obstacle for index in sorted(told) for obstacle in told[index].obstacles]
    flags = {
        "clear_assumed": segment.clear_width is None,
        "required_assumed": segment.required_width is None,
        "no_plan": band is None and not is_flight,
        "between_floors": band is None and is_flight,
        "walls_unknown": band is not None and not segment.rooms,
        "own_rooms": band is not None and bool(segment.rooms),
    }
    gaps = build_gaps(obstacles, clear)
    return Reached(
        segment=segment,
        clear=clear,
        required=required,
        band=band,
        flags=tuple(flag for flag, holds in flags.items() if holds),
        beside=tuple(_beside(index, told[index], clear, required) for index in sorted(told)),
        gaps=gaps,
        other_rooms=tuple(sorted(others)),
        standing=gaps.residual(np.zeros(len(gaps.keys), dtype=np.bool_)),
    )


def _beside(index: int, told: _Told, clear: float, required: float) -> Beside:
    gaps = build_gaps([one for one in told.obstacles if one.number == 0], clear)
    left = gaps.residual(np.ones(len(gaps.keys), dtype=np.bool_))
    stands = any(not one.falls for one in told.obstacles)
    return Beside(
        item=index,
        by_plan=told.obstacles[0].shape is not None,
        distance=told.distance,
        reach=clear - left,
        left=left,
        blocks_alone=left < required - NARROWER,
        flags=(*told.flags, *(["standing_inside"] if stands else [])),
    )


def _named(inventory: Inventory) -> dict[int, list[int]]:
    """Return for each segment the pieces that name it, or its route alone, on its floor."""
    by_route: dict[str, list[int]] = {}
    for at, segment in enumerate(inventory.routes):
        by_route.setdefault(segment.route, []).append(at)
    found: dict[int, list[int]] = {}
    for index, item in enumerate(inventory.items):
        own = [at for at in by_route.get(item.route, ()) if item.segment in ("", inventory.routes[at].segment)]
        here = [at for at in own if inventory.routes[at].floor == item.floor]
        for at in here or [at for at in own if not inventory.routes[at].floor]:
            found.setdefault(at, []).append(index)
    return found


def _near(inventory: Inventory, shapes: Mapping[int, Shape], bands: Mapping[int, Band]) -> dict[int, list[int]]:
    """Return for each band the placed pieces of its floor that lie near enough to cover some of it."""
    if not shapes:
        return {}
    from shapely import STRtree

    on_floor: dict[str, list[int]] = {}
    for index in shapes:
        on_floor.setdefault(inventory.items[index].floor, []).append(index)
    trees = {floor: STRtree([shapes[index].everything for index in own]) for floor, own in on_floor.items()}
    found = {}
    for at, band in bands.items():
        floor = inventory.routes[at].floor
        hits = trees[floor].query(band.ground()) if floor in trees else ()
        found[at] = [on_floor[floor][hit] for hit in sorted(hits)]
    return found


# ---------------------------------------------------------------- by the plan


def _by_plan(index: int, shape: Shape, band: Band) -> dict[int, _Told]:
    """Return what a placed piece covers of a band: nothing where the plan shows that it cannot reach it."""
    outline = band.outline()
    standing = _clip(band.turn_in(shape.standing), outline)
    ways = [one for fall in shape.falls if (one := _clip(band.turn_in(fall), outline)) is not None]
    obstacles = [] if standing is None else [_placed(index, standing, band, falls=False)]
    if ways:
        from shapely import union_all

        covered = union_all([*ways, *([] if standing is None else [standing])])
        obstacles.append(_placed(index, covered, band, falls=True))
    if not obstacles:
        return {}
    distance = band.turn_in(shape.standing).distance(outline)
    depth = 0.0 if standing is None else band.width - max(obstacles[0].left, obstacles[0].right)
    return {index: _Told(distance - depth, obstacles, shape.flags)}


def _clip(shape: "BaseGeometry", outline: "BaseGeometry") -> "BaseGeometry | None":
    inside = shape.intersection(outline)
    return inside if inside.area > TOUCH else None


def _placed(index: int, shape: "BaseGeometry", band: Band, *, falls: bool) -> Obstacle:
    _, low, _, high = shape.bounds
    left, right = max(0.0, band.width / 2 - high), max(0.0, low + band.width / 2)
    return Obstacle(item=index, falls=falls, left=left, right=right, shape=shape)


# ---------------------------------------------------------------- by the Edge distance


def _by_distance(index: int, item: Item, clear: float, band: Band | None, shape: Shape | None) -> dict[int, _Told]:
    """Return what a piece covers by its Edge distance; nothing where the plan tells it, and no nearer one is given."""
    distance, flags = item.edge_distance, []
    if band is not None and shape is not None:
        by_plan = float(band.turn_in(shape.standing).distance(band.outline()))
        if distance is None or distance > by_plan - TELLING or by_plan <= 0:
            return {}
        flags.append("nearer_than_plan")
    if distance is None:
        distance = 0.0
        flags.append("edge_assumed")
    if not item.segment:
        flags.append("segment_assumed")
    obstacles = list(_from_sides(index, item, distance, clear))
    return {index: _Told(distance, obstacles, (*flags, "side_unknown"))} if obstacles else {}


def _from_sides(index: int, item: Item, distance: float, clear: float) -> Iterator[Obstacle]:
    """Yield what reaches in from either side: where it stands inside already, the first and a second piece fallen."""
    for number in range(min(item.quantity, 2)):
        for falls, reach in ((False, -distance), (True, item.height - distance)):
            depth = min(max(reach, 0.0), clear)
            for side in SIDES if depth > 0 else ():
                left, right = (0.0, clear - depth) if side == "left" else (clear - depth, 0.0)
                yield Obstacle(item=index, number=number, falls=falls, left=left, right=right, side=side)
