"""Which pieces can lie on which segment once they have fallen, what they cover of it, and the gaps that they leave.

No publication gives a closed rule for this; the one used here is for screening. A fallen piece covers Height x Width
outward from its tipping edge, and where it stood. Where the plan gives the position of piece and segment, what is
covered follows from it, and a piece that could fall either way covers whatever of both ways lies in the segment; one
against a wall falls away from it, where it is known on which side that is: see `assess.routes.walls`. Else
it covers Height - Edge distance of the width, on an unknown side and at an unknown place along the segment: it may face
any other. Walls are known only where Routes names the Room: placed pieces of other rooms cannot reach the segment then.

A person of a given width passes unless a chain of pieces leads from one wall to the other with every gap on the way
narrower. The residual clear width is the smallest width that some chain cuts off: over all chains, the least of their
widest gaps. So pieces that face each other count together, and pieces far apart along the segment do not.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import product
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray, FloatArray
from assess.errors import Problem
from assess.i18n import fill, nfill
from assess.model import Inventory, Item, Segment
from assess.progress import SILENT, Progress
from assess.route_results import BesideRow
from assess.routes.chances import Key, union
from assess.routes.geometry import Band, Shape, build_bands, build_shape
from assess.routes.walls import MOST_NAMED, find_walls
from assess.routes.widths import NARROWER
from assess.workbook.names import key
from assess.workbook.schema import DEFAULT_WIDTH

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

SIDES: tuple[Literal["left", "right"], ...] = ("left", "right")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Obstacle:
    """Something that lies in a segment: a piece on the plan, or one that takes `depth` from a side.

    * `number`: 0, or 1 for a second piece of the same row of the inventory, `item`.
    * `falls`: whether the piece has to fall for it to be there; else it stands there anyway.
    * `left`, `right`: gaps to the two walls [m].
    * `shape`: what it covers, in the band's own coordinates; None where its place along the segment is not known.
    * `side`: from which wall it reaches in, where its place is not known.
    """

    item: int
    number: int = 0
    falls: bool
    left: float
    right: float
    shape: "BaseGeometry | None" = None
    side: Literal["left", "right"] | None = None

    @property
    def key(self) -> Key:
        """The piece."""
        return self.item, self.number


@dataclass(frozen=True, slots=True, eq=False)
class Gaps:
    """All obstacles of a segment.

    * `column` (m,): which of `keys` each obstacle needs; -1 where it stands there anyway.
    * `left`, `right` (m,): gaps to the walls [m].
    * `between` (m, m): gaps between two obstacles [m]; inf where the two cannot be there together.
    * `sided` (m,): number of the piece, from 1, of an obstacle that reaches in from the left, and its negative from the
      right; 0 for one on the plan.
    * `clear`: width with no obstacle [m].
    """

    keys: tuple[Key, ...]
    column: NDArray[np.intp]
    left: FloatArray
    right: FloatArray
    between: FloatArray
    sided: NDArray[np.intp]
    clear: float
    _chains: dict[float, list["_Chains"]] = field(default_factory=dict)
    """The chains of each width, kept once found."""

    def residual(self, fell: BoolArray) -> float:
        """Return the clear width left [m] where the pieces `fell` (n,)."""
        there, found = np.append(fell, True)[self.column], []
        for side in self._sides():
            own = np.flatnonzero(there & side)
            ways = np.full((2 + own.size, 2 + own.size), self.clear)
            ways[0, 2:] = ways[2:, 0] = self.left[own]
            ways[1, 2:] = ways[2:, 1] = self.right[own]
            ways[2:, 2:] = self.between[np.ix_(own, own)]
            for _ in own:  # the least widest gap of all ways from wall to wall, obstacle by obstacle
                ways = np.minimum(ways[:-1, :-1], np.maximum(ways[-1, :-1, np.newaxis], ways[-1, np.newaxis, :-1]))
            found.append(float(ways[0, 1]))
        return min(found)

    def narrower(self, fallen: Mapping[Key, int], every: int, width: float) -> int:
        """Return the set of the draws in which less than a width [m] is left: some chain has narrower gaps alone.

        `fallen` has for each piece the set of the draws in which it falls; others stand. `every`, the set of all draws,
        is returned where the segment itself is narrower.
        """
        if self.clear < width:
            return every
        if width not in self._chains:
            self._chains[width] = [_Chains.of(self, side, width) for side in self._sides()]
        there = [every if at < 0 else fallen.get(self.keys[at], 0) for at in self.column.tolist()]
        return union(one.lead(there) for one in self._chains[width])

    def _sides(self) -> list[BoolArray]:
        """Return which obstacles (m,) are considered together: never one piece on both sides.

        A chain takes at most one piece from either wall. The numbers of two pieces differ in some bit; by that bit, one
        is on the left and the other on the right, or the reverse.
        """
        if not self.sided.any() or (self.sided != 0).all():
            return [np.ones(self.sided.size, dtype=np.bool_)]  # on the plan all, or none of them: a pair is kept apart
        bits = range(max(1, int(np.abs(self.sided).max()).bit_length()))
        lefts = [(np.abs(self.sided) >> bit) & 1 == one for bit in bits for one in (0, 1)]
        return [(self.sided == 0) | ((self.sided > 0) == left) for left in lefts]


@dataclass(frozen=True, slots=True)
class _Chains:
    """The chains of gaps under a width, by obstacles.

    `alone` are too near to both walls, and need no other; `first` too near to the left wall only. `inner` are pairs too
    near to each other, one of which may be a first; `closing` such pairs of which the second is too near to the right
    wall only.
    """

    alone: list[int]
    first: list[int]
    inner: list[list[int]]
    closing: list[list[int]]

    @classmethod
    def of(cls, gaps: Gaps, side: BoolArray, width: float) -> "_Chains":
        """Find those of some obstacles (m,)."""
        left, right = side & (gaps.left < width), side & (gaps.right < width)
        alone, first, last, rest = left & right, left & ~right, right & ~left, side & ~left & ~right
        near, before = gaps.between < width, first | rest
        inner = np.triu(near & np.outer(before, before) & ~np.outer(first, first), 1)
        closing = near & np.outer(before, last)
        pairs = np.argwhere(inner).tolist(), np.argwhere(closing).tolist()
        return cls(np.flatnonzero(alone).tolist(), np.flatnonzero(first).tolist(), *pairs)

    def lead(self, there: Sequence[int]) -> int:
        """Return the set of the draws in which some chain leads from wall to wall, of obstacles `there` in sets."""
        reached = [0] * len(there)
        for at in self.first:
            reached[at] = there[at]
        changed = bool(self.first and self.closing)
        while changed:
            changed = False
            for one, other in self.inner:
                both = (reached[one] | reached[other]) & there[one] & there[other]
                if both & ~(reached[one] & reached[other]):
                    changed = True
                    reached[one] |= both
                    reached[other] |= both
        closed = union(reached[one] & there[end] for one, end in self.closing)
        return closed | union(there[at] for at in self.alone)


def build_gaps(obstacles: Sequence[Obstacle], clear: float) -> Gaps:
    """Return the gaps between obstacles, of which `clear` [m] is the width of the segment."""
    keys = tuple(sorted({one.key for one in obstacles if one.falls}))
    place = {key: at for at, key in enumerate(keys)}
    pieces = {key: at for at, key in enumerate(sorted({one.key for one in obstacles if one.side}), start=1)}
    sign = {"left": 1, "right": -1}
    left, right = (np.array([getattr(one, side) for one in obstacles], dtype=np.float64) for side in SIDES)
    sided = np.array([sign[one.side] * pieces[one.key] if one.side else 0 for one in obstacles], dtype=np.intp)
    column = np.array([place[one.key] if one.falls else -1 for one in obstacles], dtype=np.intp)
    # gaps between two: those whose place along the segment is not known may be abreast; two on one side, and one piece
    # on both sides, are never in one chain: inf
    placed, lefts, rights = (np.flatnonzero(one) for one in (sided == 0, sided > 0, sided < 0))
    between = np.full((sided.size, sided.size), math.inf)
    if placed.size > 1:
        from shapely import distance

        shapes = np.array([one.shape for one in obstacles if one.shape is not None])
        rows, columns = np.tril_indices(placed.size, -1)
        between[placed[rows], placed[columns]] = distance(shapes[rows], shapes[columns])
    for own, to_own, to_other in ((lefts, left, right), (rights, right, left)):
        between[np.ix_(own, placed)] = np.maximum(0.0, to_own[placed] - (clear - to_other[own])[:, np.newaxis])
    facing = np.maximum(0.0, right[lefts, np.newaxis] + left[rights] - clear)
    between[np.ix_(lefts, rights)] = np.where(sided[lefts, np.newaxis] == -sided[rights], math.inf, facing)
    return Gaps(keys, column, left, right, np.minimum(between, between.T), sided, clear)


CLEARLY_NEARER = 0.1
"""By how much [m] a given Edge distance must be nearer than the plan says for it to count instead."""
TOUCH = 1e-6
"""Area [m2] up to which two shapes only touch."""


@dataclass(frozen=True, slots=True)
class Coverage:
    """What one piece covers of one segment."""

    distance: float
    obstacles: Sequence[Obstacle]
    flags: tuple[str, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Obstructions:
    """One segment with the pieces that reach it, before anything is known of their chances.

    `clear` and `required` are the widths used [m], `standing` is the one left with nothing fallen; `flags` are keys
    of `assess.route_results.FLAGS`. `other_rooms` are pieces that only their Room keeps away.
    """

    segment: Segment
    clear: float
    required: float
    band: Band | None
    flags: tuple[str, ...]
    pieces: tuple[BesideRow, ...]
    gaps: Gaps
    other_rooms: tuple[int, ...]
    standing: float

    @property
    def is_blocked_standing(self) -> bool:
        """Whether it is under the required width with nothing fallen."""
        return self.standing < self.required - NARROWER

    @property
    def is_evaluated(self) -> bool:
        """Whether it is known which pieces can reach it; where it is too narrow as it stands, none need."""
        is_wide = is_stair(self.segment) and self.segment.clear_width is not None
        return bool(self.pieces) or self.band is not None or self.is_blocked_standing or is_wide

    @property
    def keys(self) -> tuple[Key, ...]:
        """The pieces that could fall onto it."""
        return self.gaps.keys

    def narrower(self, fallen: Mapping[Key, int], every: int, width: float) -> int:
        """Return the set of the draws, of `every`, in which it is narrower than a width [m], by more than rounding.

        `fallen` has for each piece the set of those in which it falls; others stand.
        """
        return self.gaps.narrower(fallen, every, width - NARROWER)

    def blocked(self, fallen: Mapping[Key, int], every: int) -> int:
        """Return the same for its required width."""
        return self.narrower(fallen, every, self.required)


def find_obstructions(inventory: Inventory, progress: Progress = SILENT) -> tuple[Obstructions, ...]:
    """Return every segment of the inventory with the pieces that reach it: the very same where nothing changed."""
    if not inventory.routes:
        return ()
    clear = [one.clear_width or one.required_width or DEFAULT_WIDTH for one in inventory.routes]
    bands, walls = build_bands(inventory, clear), find_walls(inventory)
    pieces = [
        _Piece(at, item, at in walls, walls[at].falls_toward if at in walls else None)
        for at, item in enumerate(inventory.items)
    ]
    on_plan = {inventory.routes[at].floor for at in bands}
    shapes = {
        at: shape
        for at, one in enumerate(progress.checked(pieces))
        if one.item.floor in on_plan and (shape := one.shape) is not None
    }
    progress.check()
    named, near = _find_named(inventory), _find_near(inventory, shapes, bands)
    floors: dict[str, set[str]] = {}
    for place in inventory.places:
        floors.setdefault(place.place, set()).add(place.floor)
    return tuple(
        _obstruct(
            segment, clear[at], bands.get(at), tuple(pieces[one] for one in near.get(at, ())),
            tuple(pieces[one] for one in named.get(at, ())),
            floors.get(segment.start, set()) == floors.get(segment.end, set()),
        )
        for at, segment in enumerate(progress.checked(inventory.routes))
    )  # fmt: skip


class _Piece(NamedTuple):
    """A piece by its index; whether it stands at a wall, and in which direction it then falls [deg], where known."""

    at: int
    item: Item
    is_at_wall: bool
    toward: float | None

    @property
    def shape(self) -> Shape | None:
        """What it covers on the plan; None where it has no position."""
        return build_shape(self.item, self.is_at_wall, self.toward)


@lru_cache(maxsize=2048)
def _obstruct(
    segment: Segment, clear: float, band: Band | None, near: Sequence[_Piece], named: Sequence[_Piece],
    joins_one_floor: bool,
) -> Obstructions:  # fmt: skip
    """Return a segment with the pieces that reach it, of those `near` it on the plan and those that name it."""
    covered, others, items = dict[int, Coverage](), [], {one.at: one.item for one in (*near, *named)}
    for piece in near:
        if band and piece.shape and (one := _cover_by_plan(piece.at, piece.shape, band)):
            if is_walled_off(piece.item, segment):
                others.append(piece.at)
            else:
                covered[piece.at] = one
    for piece in named:
        shape = piece.shape if band else None
        if one := _cover_by_distance(piece.at, piece.item, clear, band, shape):
            covered[piece.at] = one
    required = segment.required_width or DEFAULT_WIDTH
    gaps = build_gaps([one for index in sorted(covered) for one in covered[index].obstacles], clear)
    flags = {
        "stair_width_missing": segment.clear_width is None and is_stair(segment),
        "clear_assumed": segment.clear_width is None and not is_stair(segment),
        "required_assumed": segment.required_width is None,
        "own_rooms": band is not None and bool(segment.rooms),
        "walls_unknown": band is not None and not segment.rooms,
        "no_plan": band is None and joins_one_floor,
        "between_floors": band is None and not joins_one_floor,
    }
    return Obstructions(
        segment=segment, clear=clear, required=required, band=band,
        flags=tuple(flag for flag, holds in flags.items() if holds),
        pieces=tuple(
            _describe_piece(index, items[index], covered[index], clear, required) for index in sorted(covered)
        ),
        gaps=gaps, other_rooms=tuple(sorted(others)), standing=gaps.residual(np.zeros(len(gaps.keys), dtype=np.bool_)),
    )  # fmt: skip


def is_walled_off(item: Item, segment: Segment) -> bool:
    """Return whether a wall stands between: the rooms are known and not the same, and the piece does not name it."""
    is_named = item.route == segment.route and item.segment in ("", segment.segment)
    rooms = {key(room) for room in segment.rooms}
    return not is_named and bool(rooms) and bool(item.room) and key(item.room) not in rooms


def is_stair(segment: Segment) -> bool:
    """Tell whether a segment joins two places and lies on no floor: no piece can fall there but those that name it."""
    return not segment.floor and bool(segment.start and segment.end)


def _describe_piece(index: int, item: Item, covered: Coverage, clear: float, required: float) -> BesideRow:
    gaps = build_gaps([one for one in covered.obstacles if one.number == 0], clear)
    left = gaps.residual(np.ones(len(gaps.keys), dtype=np.bool_))
    stands = any(not one.falls for one in covered.obstacles)
    return BesideRow(
        item=item.item, row=item.row, item_index=index, by_plan=covered.obstacles[0].shape is not None,
        distance_m=covered.distance, reach_m=clear - left, left_m=left, blocks_alone=left < required - NARROWER,
        flags=(*covered.flags, *(["standing_inside"] if stands else [])),
    )  # fmt: skip


def _find_named(inventory: Inventory) -> dict[int, list[int]]:
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


def _find_near(inventory: Inventory, shapes: Mapping[int, Shape], bands: Mapping[int, Band]) -> dict[int, list[int]]:
    if not shapes:
        return {}
    from shapely import LineString, STRtree

    on_floor: dict[str, list[int]] = {}
    for index in shapes:
        on_floor.setdefault(inventory.items[index].floor, []).append(index)
    trees = {floor: STRtree([shapes[index].everything for index in own]) for floor, own in on_floor.items()}
    found = {}
    for at, band in bands.items():
        floor = inventory.routes[at].floor
        beyond = band.width / 2 + max(band.extends_start, band.extends_end)
        area = LineString([band.start, band.end]).buffer(beyond, cap_style="square")  # it contains the band
        hits = trees[floor].query(area) if floor in trees else ()
        found[at] = [on_floor[floor][hit] for hit in sorted(hits)]
    return found


def _cover_by_plan(index: int, shape: Shape, band: Band) -> Coverage | None:
    """Return what a placed piece covers of a band: nothing where the plan shows that it cannot reach it."""
    from shapely import union_all

    outline, stands = band.outline(), band.to_own(shape.standing)
    standing = [one for one in [stands.intersection(outline)] if one.area > TOUCH]
    fallen = (band.to_own(fall).intersection(outline) for fall in shape.falls)
    ways = [one for one in fallen if one.area > TOUCH]
    obstacles = []
    for falls, covered in ((False, standing), (True, [union_all([*ways, *standing])] if ways else [])):
        for one in covered:
            _, low, _, high = one.bounds
            left, right = max(0.0, band.width / 2 - high), max(0.0, low + band.width / 2)
            obstacles.append(Obstacle(item=index, falls=falls, left=left, right=right, shape=one))
    if not obstacles:
        return None
    depth = band.width - max(obstacles[0].left, obstacles[0].right) if standing else 0.0
    return Coverage(stands.distance(outline) - depth, obstacles, shape.flags)


def _cover_by_distance(index: int, item: Item, clear: float, band: Band | None, shape: Shape | None) -> Coverage | None:
    """Return what a piece covers by its Edge distance; nothing where the plan decides it."""
    distance, flags = item.edge_distance, ["side_unknown"]
    if not item.segment:
        flags.insert(0, "segment_assumed")
    if band is not None and shape is not None:
        by_plan = float(band.to_own(shape.standing).distance(band.outline()))
        if distance is None or distance > by_plan - CLEARLY_NEARER or by_plan <= 0:
            return None
        flags.insert(0, "nearer_than_plan")
    if distance is None:
        distance = 0.0
        flags.insert(0, "edge_assumed")
    obstacles = []  # from either side: where it stands inside already, the first and a second piece fallen
    ways = ((False, -distance), (True, item.height - distance))
    for number, (falls, reach), side in product(range(min(item.quantity, 2)), ways, SIDES):
        depth = min(reach, clear)
        if depth > 0:
            left, right = (0.0, clear - depth) if side == "left" else (clear - depth, 0.0)
            obstacles.append(Obstacle(item=index, number=number, falls=falls, left=left, right=right, side=side))
    return Coverage(distance, obstacles, tuple(flags)) if obstacles else None


def find_route_problems(inventory: Inventory, obstructions: Sequence[Obstructions]) -> Iterator[Problem]:
    """Yield warnings where the workbook contradicts itself beside routes, and notes on what could not count."""
    seen: set[tuple[str, int]] = set()
    for segment in obstructions:
        for one in segment.pieces:
            values = {"item": one.item, "route": segment.segment.route, "segment": segment.segment.segment}
            fresh = [flag for flag in one.flags if (flag, one.item_index) not in seen]
            seen |= {(flag, one.item_index) for flag in fresh}
            if "nearer_than_plan" in fresh:
                message = fill(
                    "Edge distance {distance:g} m of '{item}' is smaller than its position on the plan gives; the Edge "
                    "distance is used.",
                    distance=one.distance_m, **values,
                )  # fmt: skip
                cell = inventory.locate("Items", one.row, "edge_distance")
                yield Problem("warning", "Items", cell, message, fill("Correct one of the two."))
            if "standing_inside" in fresh:
                message = fill(
                    "'{item}' stands {depth:.2f} m inside route '{route}', segment '{segment}', with nothing fallen.",
                    depth=-one.distance_m, **values,
                )  # fmt: skip
                cell = inventory.locate("Items", one.row, "x" if one.by_plan else "edge_distance")
                fix = fill("Move it, or correct its position or the Clear width.")
                yield Problem("warning", "Items", cell, message, fix)
    reaching = {(segment.segment.route, one.item_index) for segment in obstructions for one in segment.pieces}
    lost = [item for at, item in enumerate(inventory.items) if item.route and (item.route, at) not in reaching]
    if lost:
        names = ", ".join(item.item for item in lost[:MOST_NAMED]) + (", ..." if len(lost) > MOST_NAMED else "")
        message = nfill(
            "{n:,} row names a route that its pieces cannot reach when they fall: {names}.",
            "{n:,} rows name a route that their pieces cannot reach when they fall: {names}.",
            len(lost),
            names=names,
        )
        yield Problem("note", "Items", inventory.locate("Items", lost[0].row, "route"), message)
