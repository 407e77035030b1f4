"""Scans of rooms by a phone: the JSON of Apple RoomPlan, a CapturedRoom or a CapturedStructure. Experimental.

Apple documents the Swift types, and not the JSON that apps write of them. The reading rests on these types and on how
public programs read such files; it was tried on files made by hand after them, not on a scan. See `scan_values`.

A structure has lists of all its rooms in common axes: those are read, and its rooms only where it has none. RoomPlan
begins its axes wherever the scan began: the plan is turned so that most walls run along X and Y.
"""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from assess.bim.building_model import (
    IS_TILTED,
    NOT_ON_FLOOR,
    ON_FLOOR,
    SILL,
    BuildingModel,
    Door,
    LeftOut,
    Piece,
    Space,
    Stair,
    Storey,
)
from assess.bim.scan_plan import (
    draw_walls,
    draw_windows,
    find_level,
    find_rooms,
    find_turn,
    is_upright,
    turn_by,
)
from assess.bim.scan_values import Scan, Scanned, parse_scan, say_word
from assess.bim.space_search import find_rooms_at
from assess.i18n import Text, fill, gettext, nfill

SCHEMA = "RoomPlan"
NEAR_STOREY = 0.5
"""How far from a storey's floor a stair may end to lead to it [m]."""
FIXED = ("sink", "toilet", "bathtub", "fireplace")
"""Categories that are fixed to the building."""
STAIRS = "stairs"
BUILT_IN = ("oven", "dishwasher", "stove", "washerDryer", "refrigerator")
"""Categories that are built in where they belong to an object of the category storage."""
FITTED = ("oven", "dishwasher")
"""Categories that are usually built in."""
LOW = "low"

IS_FIXED = fill("fixed to the building")
IS_BUILT_IN = fill("built into a cabinet, which is imported")

EXPERIMENTAL = fill(
    "Scans of RoomPlan are read experimentally, as Apple does not document their files. Compare pieces, rooms and "
    "doors with the building."
)
SCANNED_SIZES = fill(
    "Sizes were measured by scan: the simulation varies them more than others. Measure slender pieces, and change "
    "Sizes from to measured."
)
UNKNOWN_AXES = fill(
    "A scan does not tell which way the building stands, nor how high its floors lie: the plan is turned so that walls "
    "run along X and Y, and the lowest scanned floor is at 0 m. Check that X is that of PFA X, and Elevation."
)
EXITS = fill(
    "A door with a scanned room on one side only is taken for an exit. Where it leads into the building, change its "
    "Kind in Places to door."
)


def read_roomplan(data: bytes, name: str) -> BuildingModel:
    """Return what a scan tells of a building.

    Raises ModelError if it is no scan, damaged, or beyond a limit; the message names the place in the file, as
    ``objects[3]``.
    """
    scan = parse_scan(data, name)
    scan = scan.turned(turn_by(-find_turn(scan.walls)))
    storeys = _list_storeys(scan)
    levels = {int(one.key): one.level for one in storeys}
    rooms = find_rooms(scan, levels)
    found = _find_pieces(scan, rooms, levels)
    doors = tuple(_list_doors(scan, levels))
    return BuildingModel(
        source=name,
        schema=SCHEMA,
        sizes_from="scan",
        storeys=storeys,
        spaces=tuple(rooms),
        doors=doors,
        stairs=tuple(_list_stairs(scan, levels)),
        pieces=tuple(found.pieces),
        walls={str(story): draw_walls(scan, story) for story in levels},
        windows={str(story): draw_windows(scan, story) for story in levels},
        left_out=found.list_left_out(),
        warnings=(EXPERIMENTAL, SCANNED_SIZES, UNKNOWN_AXES, *((EXITS,) if doors else ()), *_warn_of_rooms(scan)),
        remarks=tuple(_remark(scan, found)),
    )


def _list_storeys(scan: Scan) -> tuple[Storey, ...]:
    """Return the storeys that hold something, from the lowest; the lowest is taken to be at 0 m."""
    every = (*scan.objects, *scan.walls, *scan.floors, *scan.doors)
    levels = {story: find_level(scan, story) for story in sorted({one.story for one in every})}
    ground = min(levels.values(), default=0.0)
    return tuple(
        Storey(str(story), gettext("Storey {n}", n=story), level - ground, level)
        for story, level in sorted(levels.items(), key=lambda one: (one[1], one[0]))
    )


@dataclass(slots=True)
class _Found:
    """Pieces, how many were recognised with low confidence, and how many objects were left out, by category."""

    pieces: list[Piece] = field(default_factory=list)
    unsure: Counter[str] = field(default_factory=Counter)
    left_out: Counter[tuple[str, Text, bool]] = field(default_factory=Counter)

    def list_left_out(self) -> tuple[LeftOut, ...]:
        """Return what was left out."""
        return tuple(
            LeftOut(SCHEMA, kind, reason, number, is_furniture)
            for (kind, reason, is_furniture), number in self.left_out.items()
        )


def _find_pieces(scan: Scan, rooms: Sequence[Space], levels: dict[int, float]) -> _Found:
    found, kinds = _Found(), {one.key: one.kind for one in scan.objects}
    places = [(str(one.story), (float(one.origin[0]), float(one.origin[1]))) for one in scan.objects]
    for one, room in zip(scan.objects, find_rooms_at(places, rooms), strict=True):
        kind = say_word(one.kind) or gettext("Object")
        bottom = one.bottom - (room.bottom if room else levels[one.story])
        if one.kind in (*FIXED, STAIRS):
            found.left_out[kind, IS_FIXED, False] += 1
        elif one.kind in BUILT_IN and kinds.get(one.parent) == "storage":
            found.left_out[kind, IS_BUILT_IN, False] += 1
        elif not is_upright(one):
            found.left_out[kind, IS_TILTED, True] += 1
        elif bottom > ON_FLOOR:
            found.left_out[kind, NOT_ON_FLOOR, True] += 1
        else:
            found.pieces.append(_to_piece(one, kind, room, bottom))
            found.unsure[kind] += one.confidence == LOW
    return found


def _to_piece(one: Scanned, kind: str, room: Space | None, bottom: float) -> Piece:
    width, height, depth = one.sizes
    axis = 0 if width <= depth else 2
    short, long = min(width, depth), max(width, depth)
    angle = math.degrees(math.atan2(one.axes[1, axis], one.axes[0, axis]))
    return Piece(
        key=one.key, storey=str(one.story), space=room.key if room else "", ifc_class=SCHEMA,
        name=kind, type=kind, x=float(one.origin[0]), y=float(one.origin[1]), breadth=short, width=long, height=height,
        angle_deg=(angle + 90) % 180 - 90, support_breadth=short, support_width=long, bottom=bottom,
        is_fitted=one.kind in FITTED,
    )  # fmt: skip


def _list_doors(scan: Scan, levels: dict[int, float]) -> Iterator[Door]:
    taken: set[str] = set()
    named = ((gettext("Door"), scan.doors), (gettext("Opening"), scan.openings))
    for name, one in ((name, one) for name, several in named for one in several):
        is_passable = one.bottom - levels.get(one.story, one.bottom) <= SILL
        if one.key not in taken and is_upright(one) and is_passable and one.sizes[0] > 0:
            taken.add(one.key)
            normal = math.degrees(math.atan2(one.axes[1, 2], one.axes[0, 2]))
            yield Door(
                key=one.key, storey=str(one.story), name=name, x=float(one.origin[0]), y=float(one.origin[1]),
                normal_deg=normal, width=one.sizes[0], thickness=one.sizes[2],
                overall=one.sizes[0] if one in scan.doors else 0.0,
            )  # fmt: skip


def _list_stairs(scan: Scan, levels: dict[int, float]) -> Iterator[Stair]:
    for one in scan.objects:
        if one.kind == STAIRS:
            x, y, top = float(one.origin[0]), float(one.origin[1]), one.bottom + one.sizes[1]
            yield Stair(one.key, str(one.story), say_word(one.kind), "foot", x, y)
            above = [story for story, level in levels.items() if abs(level - top) <= NEAR_STOREY and story != one.story]
            yield from (Stair(one.key, str(story), say_word(one.kind), "head", x, y) for story in above[:1])


def _warn_of_rooms(scan: Scan) -> Iterator[Text]:
    if scan.separate:
        yield fill(
            "The {n:,} rooms were scanned one by one and not merged: whether they lie where they are in the building "
            "is not known. Merge them in the app that scanned them, or check the plan.",
            n=scan.separate,
        )


def _remark(scan: Scan, found: _Found) -> Iterator[Text]:
    if not scan.objects:
        yield fill("The scan holds no objects: fill in Items by hand.")
    unsure = [(kind, number) for kind, number in found.unsure.items() if number]
    total = sum(number for kind, number in unsure)
    if unsure:
        kinds = ", ".join(f"{kind} ({number:,})" for kind, number in unsure)
        yield nfill(
            "{n:,} piece was recognised with low confidence: check what it is: {kinds}.",
            "{n:,} pieces were recognised with low confidence: check what they are: {kinds}.",
            total, kinds=kinds,
        )  # fmt: skip
    curved = sum(one.is_curved for one in scan.walls)
    if curved:
        yield nfill("{n:,} curved wall is not drawn.", "{n:,} curved walls are not drawn.", curved)
