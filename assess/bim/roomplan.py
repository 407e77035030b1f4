"""Scans of rooms by a phone: the JSON of Apple RoomPlan, a CapturedRoom or a CapturedStructure. Experimental.

Apple documents the Swift types, and not the JSON that apps write of them. The reading rests on these types (Surface,
Object and Section) as `JSONEncoder` writes them, and on how public programs read such files; it was tried on files made
by hand after them, not on a scan. Lengths are in metres. A position is a matrix of 4 x 4 numbers, column after column,
16 in a row or 4 lists of 4. In the file Y points upwards; here Z does, and plan X and Y are x and -z.

A structure has lists of all its rooms in common axes: those are read, and its rooms only where it has none. RoomPlan
begins its axes wherever the scan began: the plan is turned so that most walls run along X and Y.
"""

import json
import math
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from statistics import median
from typing import Any

import numpy as np
import shapely
from shapely import LineString, Point, Polygon

from assess.bim.building_model import (
    IS_TILTED,
    NOT_ON_FLOOR,
    ON_FLOOR,
    SILL,
    SMALLEST_ROOM,
    Area,
    BuildingModel,
    Door,
    Piece,
    Skipped,
    Space,
    Stair,
    Storey,
    count_skipped,
    half_turn,
    name_skipped,
)
from assess.bim.plan_shapes import UPRIGHT, FloatArray, SpaceSearch, find_valid, list_polygons, merge, to_area
from assess.errors import ModelError
from assess.i18n import Text, fill, gettext, nfill

MOST_BYTES = 64 * 2**20
"""Size of a file that is read [bytes]."""
MOST_VALUES = 4_000_000
"""Values that it may hold, by its commas and brackets: they bound the memory that reading takes."""
MOST_OBJECTS, MOST_SURFACES = 5_000, 500
"""Objects, and elements of each other list, that are read; where walls cross, rooms are found in their number squared.
"""
MOST_STORY = 99
"""Largest number of a storey."""
FARTHEST, LARGEST = 10_000.0, 1_000.0
"""Distance of an element from the origin, and its size, beyond which something is wrong [m]."""
RIGID = 0.02
"""How far the axes of an element may be from perpendicular ones of length 1 [-]."""
LONGEST_WORD = 60
"""Characters that are kept of a category or label."""
LISTS = ("objects", "walls", "doors", "windows", "openings", "floors")
"""Lists of elements of a CapturedRoom and a CapturedStructure."""
_AGAIN = fill("Export the scan again.")
_UPWARDS = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Turns the axes of a file, Y upwards, into those of a plan, Z upwards."""
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
WALL = 0.1
"""Thickness with which walls are drawn: a scan knows their faces alone [m]."""
JOINS = 0.15
"""Gap at a corner across which two walls are joined to close a room [m]."""

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


# ---------------------------------------------------------------- the file as checked values


@dataclass(frozen=True, slots=True, eq=False)
class Scanned:
    """One element: an object, or a wall, door, window, opening or floor.

    `key` is its identifier, its place in the file without one; `parent` that of the element that it belongs to, "" if
    it belongs to none. `kind` and `confidence` are its category and how sure the phone was of it, as the file names
    them. `sizes` are width, height and depth along its own axes [m], 0 for some of surfaces. `axes` (3, 3) are these
    axes as columns, the second one upwards for all that stands; `corners` (n, 3) are those of its outline [m].
    """

    key: str
    kind: str
    confidence: str
    parent: str
    sizes: tuple[float, float, float]
    axes: FloatArray
    origin: FloatArray
    corners: FloatArray
    story: int
    is_curved: bool = False

    @property
    def bottom(self) -> float:
        """Z of its lower edge if it stands upright [m]."""
        return float(self.origin[2]) - self.sizes[1] / 2

    @property
    def is_upright(self) -> bool:
        """Whether the second of its own axes is vertical."""
        return bool(abs(self.axes[2, 1]) >= UPRIGHT)

    def direction(self, axis: int) -> float:
        """Return the direction of one of its axes in plan [deg]."""
        return math.degrees(math.atan2(self.axes[1, axis], self.axes[0, axis]))

    def turned(self, turn: FloatArray) -> "Scanned":
        """Return it turned about the origin by a matrix, (3, 3)."""
        return replace(self, axes=turn @ self.axes, origin=turn @ self.origin, corners=self.corners @ turn.T)


@dataclass(frozen=True, slots=True, eq=False)
class Label:
    """What a part of a storey is used for; its centre is None where the file does not tell it."""

    words: str
    story: int
    centre: FloatArray | None

    def turned(self, turn: FloatArray) -> "Label":
        """Return it turned about the origin by a matrix, (3, 3)."""
        return self if self.centre is None else replace(self, centre=turn @ self.centre)


@dataclass(frozen=True, slots=True, eq=False)
class Scan:
    """All that is read of a scan; `separate` is the number of rooms that were not merged into one structure."""

    objects: tuple[Scanned, ...]
    walls: tuple[Scanned, ...]
    doors: tuple[Scanned, ...]
    windows: tuple[Scanned, ...]
    openings: tuple[Scanned, ...]
    floors: tuple[Scanned, ...]
    labels: tuple[Label, ...]
    separate: int = 0

    def turned(self, turn: FloatArray) -> "Scan":
        """Return all of it turned about the origin by a matrix, (3, 3)."""
        lists: dict[str, Any] = {
            name: tuple(one.turned(turn) for one in getattr(self, name)) for name in (*LISTS, "labels")
        }
        return replace(self, **lists)


def _parse_scan(data: bytes, name: str) -> Scan:
    """Return the values of a file.

    Raises ModelError if it is no scan, damaged, or beyond a limit; the message names the place in the file.
    """
    document = _load(data, name)
    rooms = document.get("rooms") or []
    if not isinstance(rooms, list) or not all(
        isinstance(one, dict) and any(isinstance(one.get(kind), list) for kind in LISTS) for one in rooms
    ):
        raise _no_scan(name)
    rooms = [(f"rooms[{at}].", one) for at, one in enumerate(rooms)]
    is_whole = any(document.get(one) for one in LISTS)
    parts = [("", document)] if is_whole or not rooms else rooms
    reader = _Reader(name)
    lists = {one: tuple(reader.read(parts, one)) for one in LISTS}
    labels = tuple(reader.read_labels([("", document), *rooms]))
    return Scan(**lists, labels=labels, separate=len(parts) if parts is rooms and len(rooms) > 1 else 0)


def _load(data: bytes, name: str) -> dict[str, Any]:
    fault = None
    if len(data) > MOST_BYTES:
        fault = fill("{name} is larger than {most} MB, the most that is read of a scan. Scan fewer rooms at a time.",
                     name=name, most=MOST_BYTES // 2**20)  # fmt: skip
    elif sum(map(data.count, (b",", b"[", b"{"))) > MOST_VALUES:
        fault = fill("{name} holds more than {most:,} values, the most that is read of a scan. Scan fewer rooms at a "
                     "time.", name=name, most=MOST_VALUES)  # fmt: skip
    if fault is not None:
        raise ModelError(fault)
    try:
        found = json.loads(data)
    except json.JSONDecodeError as error:
        raise ModelError(
            fill("{name} is not complete JSON: line {line}, column {column}. Export or copy the scan again.",
                 name=name, line=error.lineno, column=error.colno)
        ) from None  # fmt: skip
    except (ValueError, RecursionError):
        raise ModelError(fill("{name} cannot be read as JSON. Export or copy the scan again.", name=name)) from None
    document = {"rooms": found} if isinstance(found, list) else found
    if not isinstance(document, dict) or not any(isinstance(document.get(one), list) for one in (*LISTS, "rooms")):
        raise _no_scan(name)
    return document


def _no_scan(name: str) -> ModelError:
    return ModelError(
        fill("{name} is not a scan of RoomPlan: it has none of the lists {lists}. Export the CapturedRoom or "
             "CapturedStructure as JSON.", name=name, lists=", ".join((*LISTS, "rooms")))
    )  # fmt: skip


# ---------------------------------------------------------------- elements


@dataclass(slots=True)
class _Reader:
    """Reads elements, and counts them by the name of their list."""

    name: str
    counts: Counter[str] = field(default_factory=Counter)
    known: dict[str, str] = field(default_factory=dict)
    """Places of objects by their identifier."""

    def read(self, parts: Sequence[tuple[str, Mapping[str, Any]]], kind: str) -> Iterator[Scanned]:
        for start, part in parts:
            story = _whole(part.get("story"), 0)
            for place, data in self._list(part, start, kind):
                yield self._read_one(data, place, kind, story)

    def _list(self, part: Mapping[str, Any], start: str, kind: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
        found = part.get(kind) or []
        if not isinstance(found, list):
            raise self._fault(f"{start}{kind}", fill("expected a list."))
        self.counts[kind] += len(found)
        most = MOST_OBJECTS if kind == "objects" else MOST_SURFACES
        if self.counts[kind] > most:
            raise ModelError(
                fill("{name} holds more than {most:,} {kind}, the most that is read of a scan. Scan fewer rooms at a "
                     "time.", name=self.name, most=most, kind=kind)
            )  # fmt: skip
        for at, data in enumerate(found):
            place = f"{start}{kind}[{at}]"
            if not isinstance(data, dict):
                raise self._fault(place, fill("expected an object in braces."))
            yield place, data

    def _read_one(self, data: Mapping[str, Any], place: str, kind: str, story: int) -> Scanned:
        axes, origin = self._read_transform(data.get("transform"), f"{place}.transform")
        corners = data.get("polygonCorners") or []
        if not isinstance(corners, list) or not all(_is_point(one) for one in corners):
            expected = fill("expected points of three numbers, none beyond {most:,.0f} m.", most=FARTHEST)
            raise self._fault(f"{place}.polygonCorners", expected)
        key, is_object = _text(data.get("identifier")), kind == "objects"
        if is_object and (not key or key in self.known):
            why = fill("{other} has the same one.", other=self.known[key]) if key else fill("it is missing.")
            raise self._fault(f"{place}.identifier", why)
        if is_object:
            self.known[key] = place
        return Scanned(
            key=key or place,
            kind=read_word(data.get("category")),
            confidence=read_word(data.get("confidence")),
            parent=_text(data.get("parentIdentifier")),
            sizes=self._read_sizes(data.get("dimensions"), f"{place}.dimensions", is_object=is_object),
            axes=axes,
            origin=origin,
            corners=origin + np.array(corners, dtype=np.float64).reshape(-1, 3) @ axes.T,
            story=_whole(data.get("story"), story),
            is_curved=bool(data.get("curve")),
        )

    def _read_sizes(self, found: object, place: str, *, is_object: bool) -> tuple[float, float, float]:
        if not isinstance(found, list) or len(found) != 3 or not all(_is_number(one, LARGEST) for one in found):
            raise self._fault(place, fill("expected three numbers in metres up to {most:g}.", most=LARGEST))
        width, height, depth = map(float, found)
        least = min(width, height, depth)
        if least < 0 or (is_object and least == 0):
            raise self._fault(place, fill("a size of {size:g} m is not above 0.", size=least))
        return width, height, depth

    def _read_transform(self, found: object, place: str) -> tuple[FloatArray, FloatArray]:
        values = found
        if isinstance(found, list) and len(found) == 4 and all(isinstance(one, list) for one in found):
            values = [value for column in found for value in column]
        if not isinstance(values, list) or len(values) != 16 or not all(_is_number(one, FARTHEST) for one in values):
            raise self._fault(
                place, fill("expected 16 numbers, or 4 lists of 4, none beyond {most:,.0f} m.", most=FARTHEST)
            )
        matrix = np.array(values, dtype=np.float64).reshape(4, 4).T
        axes = matrix[:3, :3]
        is_rigid = np.abs(axes.T @ axes - np.eye(3)).max() <= RIGID and np.linalg.det(axes) > 0
        if not is_rigid or np.abs(matrix[3] - (0, 0, 0, 1)).max() > RIGID:
            raise self._fault(place, fill("it does not hold a rotation and a position, by columns."))
        return _UPWARDS @ axes, _UPWARDS @ matrix[:3, 3]

    def read_labels(self, parts: Sequence[tuple[str, Mapping[str, Any]]]) -> Iterator[Label]:
        """Yield what the parts of storeys are used for, of the document and its rooms."""
        for start, part in parts:
            story = _whole(part.get("story"), 0)
            for place, data in self._list(part, start, "sections"):
                words, centre = _say_word(read_word(data.get("label"))), data.get("center")
                if centre is not None and not _is_point(centre):
                    raise self._fault(f"{place}.center", fill("expected three numbers."))
                if words and words != "Unidentified":
                    at = None if centre is None else _UPWARDS @ np.array(centre, dtype=np.float64)
                    yield Label(words, _whole(data.get("story"), story), at)

    def _fault(self, place: str, fault: Text) -> ModelError:
        return ModelError(fill("{name}, {place}: {fault} {fix}", name=self.name, place=place, fault=fault, fix=_AGAIN))


def _is_number(value: object, most: float) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and -most <= value <= most


def _is_point(value: object) -> bool:
    return isinstance(value, list) and len(value) == 3 and all(_is_number(one, FARTHEST) for one in value)


def _whole(value: object, otherwise: int) -> int:
    return value if isinstance(value, int) and not isinstance(value, bool) and abs(value) <= MOST_STORY else otherwise


def _text(value: object) -> str:
    """Return a text without what no file can hold, "" for what is no text."""
    if not isinstance(value, str):
        return ""
    return "".join(one for one in value[:LONGEST_WORD] if one.isprintable()).strip()


def read_word(value: object) -> str:
    """Return a category, a confidence or a label: a text, or the only key of an object, as different apps write it."""
    if isinstance(value, dict) and value:
        return _text(next(iter(value)))
    return _text(value)


def _say_word(word: str) -> str:
    """Return a word of the file as people write it: ``washerDryer`` is "Washer dryer"."""
    parts = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", word.replace("_", " ")).lower()
    return parts[:1].upper() + parts[1:]


# ---------------------------------------------------------------- the building


def read_roomplan(data: bytes, name: str) -> BuildingModel:
    """Return what a scan tells of a building.

    Raises ModelError if it is no scan, damaged, or beyond a limit; the message names the place in the file, as
    ``objects[3]``.
    """
    scan = _parse_scan(data, name)
    scan = scan.turned(_find_turn(scan.walls))
    storeys = _list_storeys(scan)
    levels = {int(one.key): one.level for one in storeys}
    rooms = _find_rooms(scan, levels)
    pieces, unsure, skipped = _find_pieces(scan, rooms, levels)
    doors = tuple(_list_doors(scan, levels))
    warnings = [EXPERIMENTAL, SCANNED_SIZES, UNKNOWN_AXES, *([EXITS] if doors else [])]
    if scan.separate:
        warnings.append(
            fill("The {n:,} rooms were scanned one by one and not merged: whether they lie where they are in the "
                 "building is not known. Merge them in the app that scanned them, or check the plan.", n=scan.separate)
        )  # fmt: skip
    return BuildingModel(
        source=name,
        schema=SCHEMA,
        sizes_from="scan",
        storeys=storeys,
        spaces=tuple(rooms),
        doors=doors,
        stairs=tuple(_list_stairs(scan, levels)),
        pieces=tuple(pieces),
        walls={str(story): _draw_walls(scan, story) for story in levels},
        windows={
            str(story): merge(_lay(one, WALL) for one in scan.windows if one.story == story and one.is_upright)
            for story in levels
        },
        skipped=skipped,
        warnings=tuple(warnings),
        remarks=tuple(_remark(scan, unsure)),
    )


def _list_storeys(scan: Scan) -> tuple[Storey, ...]:
    every = (*scan.objects, *scan.walls, *scan.floors, *scan.doors)
    levels = {story: _find_level(scan, story) for story in sorted({one.story for one in every})}
    ground = min(levels.values(), default=0.0)
    return tuple(
        Storey(str(story), gettext("Storey {n}", n=story), level - ground, level)
        for story, level in sorted(levels.items(), key=lambda one: (one[1], one[0]))
    )


def _find_pieces(
    scan: Scan, rooms: Sequence[Space], levels: Mapping[int, float]
) -> tuple[list[Piece], Counter[str], tuple[Skipped, ...]]:
    pieces, unsure, skipped = list[Piece](), Counter[str](), list[tuple[str, Text, bool]]()
    kinds, search = {one.key: one.kind for one in scan.objects}, SpaceSearch(rooms)
    for one in scan.objects:
        x, y, _z = one.origin.tolist()
        room = next(iter(search.find(str(one.story), (x, y))), None)
        kind = _say_word(one.kind) or gettext("Object")
        bottom = one.bottom - (room.bottom if room else levels[one.story])
        left: tuple[Text, bool] | None = None
        if one.kind in (*FIXED, STAIRS):
            left = IS_FIXED, False
        elif one.kind in BUILT_IN and kinds.get(one.parent) == "storage":
            left = IS_BUILT_IN, False
        elif not one.is_upright:
            left = IS_TILTED, True
        elif bottom > ON_FLOOR:
            left = NOT_ON_FLOOR, True
        if left is not None:
            skipped.append((name_skipped(SCHEMA, kind), *left))
            continue
        width, height, depth = one.sizes
        short, long = sorted((width, depth))
        pieces.append(
            Piece(
                key=one.key, storey=str(one.story), space=room.key if room else "", ifc_class=SCHEMA, name=kind,
                type=kind, x=x, y=y, breadth=short, width=long, height=height,
                angle_deg=half_turn(one.direction(0 if width <= depth else 2)), support_breadth=short,
                support_width=long, bottom=bottom, is_fitted=one.kind in FITTED,
            )
        )  # fmt: skip
        unsure[kind] += one.confidence == LOW
    return pieces, unsure, count_skipped(skipped)


def _list_doors(scan: Scan, levels: Mapping[int, float]) -> Iterator[Door]:
    taken: set[str] = set()
    named = ((gettext("Door"), scan.doors), (gettext("Opening"), scan.openings))
    for name, one in ((name, one) for name, several in named for one in several):
        is_passable = one.bottom - levels.get(one.story, one.bottom) <= SILL
        if one.key not in taken and one.is_upright and is_passable and one.sizes[0] > 0:
            taken.add(one.key)
            yield Door(
                key=one.key, storey=str(one.story), name=name, x=float(one.origin[0]), y=float(one.origin[1]),
                normal_deg=one.direction(2), width=one.sizes[0], thickness=one.sizes[2],
                overall=one.sizes[0] if one in scan.doors else 0.0,
            )  # fmt: skip


def _list_stairs(scan: Scan, levels: Mapping[int, float]) -> Iterator[Stair]:
    for one in scan.objects:
        if one.kind == STAIRS:
            x, y, top = float(one.origin[0]), float(one.origin[1]), one.bottom + one.sizes[1]
            yield Stair(one.key, str(one.story), _say_word(one.kind), "foot", x, y)
            above = [story for story, level in levels.items() if abs(level - top) <= NEAR_STOREY and story != one.story]
            yield from (Stair(one.key, str(story), _say_word(one.kind), "head", x, y) for story in above[:1])


def _remark(scan: Scan, unsure: Counter[str]) -> Iterator[Text]:
    if not scan.objects:
        yield fill("The scan holds no objects: fill in Items by hand.")
    total = unsure.total()
    if total:
        kinds = ", ".join(f"{kind} ({number:,})" for kind, number in unsure.items() if number)
        yield nfill(
            "{n:,} piece was recognised with low confidence: check what it is: {kinds}.",
            "{n:,} pieces were recognised with low confidence: check what they are: {kinds}.",
            total, kinds=kinds,
        )  # fmt: skip
    curved = sum(one.is_curved for one in scan.walls)
    if curved:
        yield nfill("{n:,} curved wall is not drawn.", "{n:,} curved walls are not drawn.", curved)


# ---------------------------------------------------------------- the plan


def _find_turn(walls: Sequence[Scanned]) -> FloatArray:
    """Return the matrix (3, 3) that turns a plan so that the walls run along X and Y.

    Their direction is the mean of all, by their lengths, within 45 degrees of X.
    """
    ways = [(wall.sizes[0], math.radians(wall.direction(0))) for wall in walls if wall.is_upright]
    x, y = (sum(length * way(4 * angle) for length, angle in ways) for way in (math.cos, math.sin))
    turn = -math.atan2(y, x) / 4 if math.hypot(x, y) > 0 else 0.0
    return np.array([[math.cos(turn), -math.sin(turn), 0.0], [math.sin(turn), math.cos(turn), 0.0], [0.0, 0.0, 1.0]])


def _find_level(scan: Scan, story: int) -> float:
    """Return the height of the floor of a storey [m]: of its floors, else where its walls, else its objects begin."""
    floors = [_height_of(one) for one in scan.floors if one.story == story]
    if floors:
        return median(floors)
    walls = [one.bottom for one in scan.walls if one.story == story and one.is_upright]
    if walls:
        return median(walls)
    return min((one.bottom for one in scan.objects if one.story == story), default=0.0)


def _height_of(floor: Scanned) -> float:
    return float(floor.corners[:, 2].mean() if len(floor.corners) else floor.origin[2])


def _draw_walls(scan: Scan, story: int) -> tuple[Area, ...]:
    walls = [_lay(one, WALL) for one in scan.walls if one.story == story and one.is_upright and not one.is_curved]
    openings = (*scan.doors, *scan.windows, *scan.openings)
    holes = [_lay(one, 3 * WALL) for one in openings if one.story == story and one.is_upright]
    return merge(list_polygons(shapely.union_all(walls).difference(shapely.union_all(holes))))


def _lay(one: Scanned, least: float) -> Polygon:
    width, thick = one.sizes[0] / 2, max(one.sizes[2], least) / 2
    along, across = (one.axes[:2, axis] for axis in (0, 2))
    return Polygon([one.origin[:2] + x * along + y * across for x, y in _around(width, thick)])


def _around(x: float, y: float) -> tuple[tuple[float, float], ...]:
    return (-x, -y), (x, -y), (x, y), (-x, y)


def _find_rooms(scan: Scan, stories: Iterable[int]) -> list[Space]:
    """Return the rooms of the storeys: the outlines of floors, else those that walls close."""
    found = [
        (key, story, polygon, level)
        for story in stories
        for key, polygon, level in (list(_list_floors(scan, story)) or list(_close_walls(scan, story)))
    ]
    taken: set[str] = set()
    rooms = []
    for number, (key, story, polygon, level) in enumerate(found, 1):
        own = key if key not in taken else f"{key} {number}"
        taken.add(own)
        name = _name(scan.labels, story, polygon, is_only=len(found) == 1) or gettext("Room {n}", n=number)
        # How high a ceiling lies says nothing of the roof of the building: a space without height tells none.
        rooms.append(Space(own, str(story), name, "", to_area(polygon), level, level))
    return rooms


def _list_floors(scan: Scan, story: int) -> Iterator[tuple[str, Polygon, float]]:
    for one in scan.floors:
        if one.story == story:
            corners = one.corners
            if len(corners) < 3:
                width, height, depth = (size / 2 for size in one.sizes)
                is_flat = height <= depth
                around = _around(width, depth if is_flat else height)
                local = np.array([(x, 0.0, y) if is_flat else (x, y, 0.0) for x, y in around])
                corners = one.origin + local @ one.axes.T
            polygon = find_valid(Polygon(corners[:, :2]))
            if polygon.area >= SMALLEST_ROOM:
                yield one.key, polygon, _height_of(one)


def _close_walls(scan: Scan, story: int) -> Iterator[tuple[str, Polygon, float]]:
    """Yield the areas that the walls of a storey close, each lengthened by `JOINS` so that they meet at corners."""
    level, lines = _find_level(scan, story), []
    for one in scan.walls:
        if one.story == story and one.is_upright and not one.is_curved:
            reach = (one.sizes[0] / 2 + JOINS) * one.axes[:2, 0]
            lines.append(LineString([one.origin[:2] - reach, one.origin[:2] + reach]))
    rings = list(list_polygons(shapely.polygonize([shapely.union_all(lines)]))) if lines else []
    for number, polygon in enumerate(rings[:MOST_SURFACES], 1):
        if polygon.area >= SMALLEST_ROOM:
            yield f"room {story} {number}", polygon, level


def _name(labels: Sequence[Label], story: int, polygon: Polygon, *, is_only: bool) -> str:
    own = [
        one.words
        for one in labels
        if is_only or (one.story == story and one.centre is not None and polygon.covers(Point(one.centre[:2])))
    ]
    return " / ".join(dict.fromkeys(own))
