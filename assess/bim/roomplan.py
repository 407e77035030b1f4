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
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
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

MOST_BYTES = 64 * 2**20  # size of a file that is read [bytes]
MOST_VALUES = 4_000_000
"""Values that it may hold, by its commas and brackets: they bound the memory that reading takes."""
MOST_OBJECTS, MOST_SURFACES = 5_000, 500
"""Objects, and elements of each other list, that are read; where walls cross, rooms are found in their number squared.
"""
MOST_STORY = 99  # largest number of a storey
FARTHEST, LARGEST = 10_000.0, 1_000.0
"""Distance of an element from the origin, and its size, beyond which something is wrong [m]."""
RIGID = 0.02  # how far the axes of an element may be from perpendicular ones of length 1 [-]
LONGEST_WORD = 60  # characters that are kept of a category or label
LISTS = ("objects", "walls", "doors", "windows", "openings", "floors")
"""Lists of elements of a CapturedRoom and a CapturedStructure."""
_AGAIN = fill("Export the scan again.")
Label = tuple[str, int, FloatArray | None]
"""What a part of a storey is used for, the storey, and its centre, None where the file does not tell it."""
_UPWARDS = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Turns the axes of a file, Y upwards, into those of a plan, Z upwards."""
SCHEMA = "RoomPlan"
NEAR_STOREY = 0.5  # how far from a storey's floor a stair may end to lead to it [m]
FIXED = ("sink", "toilet", "bathtub", "fireplace")  # categories that are fixed to the building
STAIRS = "stairs"
BUILT_IN = ("oven", "dishwasher", "stove", "washerDryer", "refrigerator")
"""Categories that are built in where they belong to an object of the category storage."""
FITTED = ("oven", "dishwasher")  # categories that are usually built in
WALL = 0.1  # thickness with which walls are drawn: a scan knows their faces alone [m]
JOINS = 0.15  # gap at a corner across which two walls are joined to close a room [m]

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

    @property
    def height(self) -> float:
        """Z of its outline, or of its middle [m]: of a floor."""
        return float(self.corners[:, 2].mean() if len(self.corners) else self.origin[2])

    def direction(self, axis: int) -> float:
        """Return the direction of one of its axes in plan [deg]."""
        return math.degrees(math.atan2(self.axes[1, axis], self.axes[0, axis]))

    def lay(self, least: float) -> Polygon:
        """Return the plan of what stands, at least so thick [m]."""
        width, thick = self.sizes[0] / 2, max(self.sizes[2], least) / 2
        along, across = (self.axes[:2, axis] for axis in (0, 2))
        return Polygon([self.origin[:2] + x * along + y * across for x, y in _around(width, thick)])


def _load(data: bytes, name: str) -> dict[str, Any]:
    """Return the document of a file, its "rooms" a list; ModelError if it is not a scan, not complete, or too large."""
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
    if isinstance(document, dict) and any(isinstance(document.get(one), list) for one in (*LISTS, "rooms")):
        rooms = document.get("rooms") or []
        if isinstance(rooms, list) and all(
            isinstance(one, dict) and any(isinstance(one.get(kind), list) for kind in LISTS) for one in rooms
        ):
            return {**document, "rooms": rooms}
    raise ModelError(
        fill("{name} is not a scan of RoomPlan: it has none of the lists {lists}. Export the CapturedRoom or "
             "CapturedStructure as JSON.", name=name, lists=", ".join((*LISTS, "rooms")))
    )  # fmt: skip


class _Reader:
    """Reads the elements of a document; the message of a ModelError names the place in the file, as ``objects[3]``."""

    def __init__(self, data: bytes, name: str) -> None:
        self.name = name
        self.counts: Counter[str] = Counter()
        self.places: dict[str, str] = {}  # of objects by their identifier
        document = _load(data, name)
        rooms = [(f"rooms[{at}].", one) for at, one in enumerate(document["rooms"])]
        is_whole = any(document.get(one) for one in LISTS)
        parts = [("", document)] if is_whole or not rooms else rooms
        self.separate = len(parts) if parts is rooms and len(rooms) > 1 else 0
        self.lists = {kind: [self._read(*one, kind) for one in self._list(parts, kind)] for kind in LISTS}
        self.labels: list[Label] = []
        for place, one, story in self._list([("", document), *rooms], "sections"):
            words, centre = _spell(_read_word(one.get("label"))), one.get("center")
            if centre is not None and not _are_numbers(centre, 3, FARTHEST):
                raise self._fault(f"{place}.center", fill("expected three numbers."))
            if words and words != "Unidentified":
                at = None if centre is None else _UPWARDS @ np.array(centre, dtype=np.float64)
                self.labels.append((words, _whole(one.get("story"), story), at))

    def _list(
        self, parts: Sequence[tuple[str, Mapping[str, Any]]], kind: str
    ) -> Iterator[tuple[str, Mapping[str, Any], int]]:
        """Yield the elements of a list in all parts, with their places and the storeys of their parts."""
        for start, part in parts:
            found = part.get(kind) or []
            if not isinstance(found, list):
                raise self._fault(f"{start}{kind}", fill("expected a list."))
            self.counts[kind] += len(found)
            most = MOST_OBJECTS if kind == "objects" else MOST_SURFACES
            if self.counts[kind] > most:
                raise ModelError(
                    fill("{name} holds more than {most:,} {kind}, the most that is read of a scan. Scan fewer rooms "
                         "at a time.", name=self.name, most=most, kind=kind)
                )  # fmt: skip
            for at, one in enumerate(found):
                place = f"{start}{kind}[{at}]"
                if not isinstance(one, dict):
                    raise self._fault(place, fill("expected an object in braces."))
                yield place, one, _whole(part.get("story"), 0)

    def _read(self, place: str, data: Mapping[str, Any], story: int, kind: str) -> Scanned:
        values = data.get("transform")
        if isinstance(values, list) and len(values) == 4 and all(isinstance(one, list) for one in values):
            values = [value for column in values for value in column]
        if not _are_numbers(values, 16, FARTHEST):
            expected = fill("expected 16 numbers, or 4 lists of 4, none beyond {most:,.0f} m.", most=FARTHEST)
            raise self._fault(f"{place}.transform", expected)
        matrix = np.array(values, dtype=np.float64).reshape(4, 4).T
        axes = matrix[:3, :3]
        is_rigid = np.abs(axes.T @ axes - np.eye(3)).max() <= RIGID and np.linalg.det(axes) > 0
        if not is_rigid or np.abs(matrix[3] - (0, 0, 0, 1)).max() > RIGID:
            raise self._fault(f"{place}.transform", fill("it does not hold a rotation and a position, by columns."))
        axes, origin = _UPWARDS @ axes, _UPWARDS @ matrix[:3, 3]
        corners = data.get("polygonCorners") or []
        if not isinstance(corners, list) or not all(_are_numbers(one, 3, FARTHEST) for one in corners):
            expected = fill("expected points of three numbers, none beyond {most:,.0f} m.", most=FARTHEST)
            raise self._fault(f"{place}.polygonCorners", expected)
        key, is_object = _text(data.get("identifier")), kind == "objects"
        if is_object and (not key or key in self.places):
            why = fill("{other} has the same one.", other=self.places[key]) if key else fill("it is missing.")
            raise self._fault(f"{place}.identifier", why)
        if is_object:
            self.places[key] = place
        sizes: Any = data.get("dimensions")
        if not _are_numbers(sizes, 3, LARGEST):
            expected = fill("expected three numbers in metres up to {most:g}.", most=LARGEST)
            raise self._fault(f"{place}.dimensions", expected)
        width, height, depth = map(float, sizes)
        least = min(width, height, depth)
        if least < 0 or (is_object and least == 0):
            raise self._fault(f"{place}.dimensions", fill("a size of {size:g} m is not above 0.", size=least))
        return Scanned(
            key=key or place, kind=_read_word(data.get("category")), confidence=_read_word(data.get("confidence")),
            parent=_text(data.get("parentIdentifier")), sizes=(width, height, depth), axes=axes, origin=origin,
            corners=origin + np.array(corners, dtype=np.float64).reshape(-1, 3) @ axes.T,
            story=_whole(data.get("story"), story), is_curved=bool(data.get("curve")),
        )  # fmt: skip

    def _fault(self, place: str, fault: Text) -> ModelError:
        return ModelError(fill("{name}, {place}: {fault} {fix}", name=self.name, place=place, fault=fault, fix=_AGAIN))


def _are_numbers(found: object, count: int, most: float) -> bool:
    return (
        isinstance(found, list)
        and len(found) == count
        and all(isinstance(one, (int, float)) and not isinstance(one, bool) and -most <= one <= most for one in found)
    )


def _whole(value: object, otherwise: int) -> int:
    return value if isinstance(value, int) and not isinstance(value, bool) and abs(value) <= MOST_STORY else otherwise


def _text(value: object) -> str:
    """Return a text without characters that cannot be printed, "" for anything else."""
    if not isinstance(value, str):
        return ""
    return "".join(one for one in value[:LONGEST_WORD] if one.isprintable()).strip()


def _read_word(value: object) -> str:
    """Return a category, a confidence or a label: a text, or the only key of an object, as different apps write it."""
    return _text(next(iter(value)) if isinstance(value, dict) and value else value)


def _spell(word: str) -> str:
    """Return a word of the file as people write it: ``washerDryer`` is "Washer dryer"."""
    parts = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", word.replace("_", " ")).lower()
    return parts[:1].upper() + parts[1:]


def _around(x: float, y: float) -> tuple[tuple[float, float], ...]:
    return (-x, -y), (x, -y), (x, y), (-x, y)


# ---------------------------------------------------------------- the building


def read_roomplan(data: bytes, name: str) -> BuildingModel:
    """Return what a scan tells of a building; ModelError, with the place in the file, if damaged or too large."""
    scan = _Scan(_Reader(data, name))
    rooms = scan.find_rooms()
    pieces, unsure, skipped = scan.find_pieces(rooms)
    doors = tuple(scan.list_doors())
    warnings = [EXPERIMENTAL, SCANNED_SIZES, UNKNOWN_AXES, *([EXITS] if doors else [])]
    if scan.separate:
        warnings.append(
            fill("The {n:,} rooms were scanned one by one and not merged: whether they lie where they are in the "
                 "building is not known. Merge them in the app that scanned them, or check the plan.", n=scan.separate)
        )  # fmt: skip
    remarks = [] if scan.objects else [fill("The scan holds no objects: fill in Items by hand.")]
    total = unsure.total()
    if total:
        kinds = ", ".join(f"{kind} ({number:,})" for kind, number in unsure.items() if number)
        remarks.append(nfill(
            "{n:,} piece was recognised with low confidence: check what it is: {kinds}.",
            "{n:,} pieces were recognised with low confidence: check what they are: {kinds}.",
            total, kinds=kinds,
        ))  # fmt: skip
    curved = sum(one.is_curved for one in scan.walls)
    if curved:
        remarks.append(nfill("{n:,} curved wall is not drawn.", "{n:,} curved walls are not drawn.", curved))
    ground = min(scan.levels.values(), default=0.0)
    walls, windows = dict[str, tuple[Area, ...]](), dict[str, tuple[Area, ...]]()
    for story in scan.levels:
        own, glazed, holes = (
            [one for one in some if one.story == story and one.is_upright]
            for some in (scan.walls, scan.windows, (*scan.doors, *scan.windows, *scan.openings))
        )
        solid = shapely.union_all([one.lay(WALL) for one in own if not one.is_curved])
        open_parts = shapely.union_all([one.lay(3 * WALL) for one in holes])
        walls[str(story)] = merge(list_polygons(solid.difference(open_parts)))
        windows[str(story)] = merge(one.lay(WALL) for one in glazed)
    return BuildingModel(
        source=name, schema=SCHEMA, sizes_from="scan",
        storeys=tuple(
            Storey(str(story), gettext("Storey {n}", n=story), level - ground, level)
            for story, level in scan.levels.items()
        ),
        spaces=tuple(rooms), doors=doors, stairs=tuple(scan.list_stairs()), pieces=tuple(pieces), walls=walls,
        windows=windows, skipped=skipped, warnings=tuple(warnings), remarks=tuple(remarks),
    )  # fmt: skip


class _Scan:
    """A scan, turned so that its walls, by their lengths, run along X and Y. `levels` are those of the storeys [m],
    from the lowest: where their floors lie, else where their walls begin, else their objects.
    """

    def __init__(self, read: _Reader) -> None:
        self.separate = read.separate
        ways = [(one.sizes[0], math.radians(one.direction(0))) for one in read.lists["walls"] if one.is_upright]
        x, y = (sum(length * way(4 * angle) for length, angle in ways) for way in (math.cos, math.sin))
        angle = -math.atan2(y, x) / 4 if math.hypot(x, y) > 0 else 0.0
        c, s = math.cos(angle), math.sin(angle)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        self.objects, self.walls, self.doors, self.windows, self.openings, self.floors = (
            [
                replace(one, axes=turn @ one.axes, origin=turn @ one.origin, corners=one.corners @ turn.T)
                for one in read.lists[kind]
            ]
            for kind in LISTS
        )
        self.labels = [(words, own, None if at is None else turn @ at) for words, own, at in read.labels]
        levels: dict[int, float] = {}
        for story in sorted({one.story for one in (*self.objects, *self.walls, *self.floors, *self.doors)}):
            floors = [one.height for one in self.floors if one.story == story]
            walls = [one.bottom for one in self.walls if one.story == story and one.is_upright]
            objects = [one.bottom for one in self.objects if one.story == story]
            levels[story] = median(floors or walls) if floors or walls else min(objects, default=0.0)
        self.levels = dict(sorted(levels.items(), key=lambda one: (one[1], one[0])))

    def find_pieces(self, rooms: Sequence[Space]) -> tuple[list[Piece], Counter[str], tuple[Skipped, ...]]:
        """Return the pieces, the numbers of those recognised with low confidence by kind, and what was left out."""
        pieces, unsure, skipped = list[Piece](), Counter[str](), list[tuple[str, Text, bool]]()
        kinds, search = {one.key: one.kind for one in self.objects}, SpaceSearch(rooms)
        for one in self.objects:
            x, y, _z = one.origin.tolist()
            room = next(iter(search.find(str(one.story), (x, y))), None)
            kind = _spell(one.kind) or gettext("Object")
            bottom = one.bottom - (room.bottom if room else self.levels[one.story])
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
            unsure[kind] += one.confidence == "low"
        return pieces, unsure, count_skipped(skipped)

    def list_doors(self) -> Iterator[Door]:
        taken: set[str] = set()
        named = ((gettext("Door"), self.doors), (gettext("Opening"), self.openings))
        for name, one in ((name, one) for name, several in named for one in several):
            is_passable = one.bottom - self.levels.get(one.story, one.bottom) <= SILL
            if one.key not in taken and one.is_upright and is_passable and one.sizes[0] > 0:
                taken.add(one.key)
                yield Door(
                    key=one.key, storey=str(one.story), name=name, x=float(one.origin[0]), y=float(one.origin[1]),
                    normal_deg=one.direction(2), width=one.sizes[0], thickness=one.sizes[2],
                    overall=one.sizes[0] if one in self.doors else 0.0,
                )  # fmt: skip

    def list_stairs(self) -> Iterator[Stair]:
        for one in (one for one in self.objects if one.kind == STAIRS):
            x, y, top = float(one.origin[0]), float(one.origin[1]), one.bottom + one.sizes[1]
            yield Stair(one.key, str(one.story), _spell(one.kind), "foot", x, y)
            others = ((own, level) for own, level in self.levels.items() if own != one.story)
            above = next((own for own, level in others if abs(level - top) <= NEAR_STOREY), None)
            if above is not None:
                yield Stair(one.key, str(above), _spell(one.kind), "head", x, y)

    def find_rooms(self) -> list[Space]:
        """Return the rooms of the storeys: the outlines of floors, else those that walls close."""
        found = [(story, *one) for story in self.levels for one in self._list_outlines(story)]
        taken: set[str] = set()
        rooms = []
        for number, (story, key, polygon, level) in enumerate(found, 1):
            own = key if key not in taken else f"{key} {number}"
            taken.add(own)
            uses = [
                words
                for words, at_story, at in self.labels
                if len(found) == 1 or (at_story == story and at is not None and polygon.covers(Point(at[:2])))
            ]
            name = " / ".join(dict.fromkeys(uses)) or gettext("Room {n}", n=number)
            # How high a ceiling lies says nothing of the roof of the building: a space without height tells none.
            rooms.append(Space(own, str(story), name, "", to_area(polygon), level, level))
        return rooms

    def _list_outlines(self, story: int) -> list[tuple[str, Polygon, float]]:
        """Return the floors of a storey, else the areas that its walls close, each lengthened by `JOINS` to meet."""
        found = []
        for one in (one for one in self.floors if one.story == story):
            corners = one.corners
            if len(corners) < 3:
                width, height, depth = (size / 2 for size in one.sizes)
                is_flat = height <= depth
                around = _around(width, depth if is_flat else height)
                local = np.array([(x, 0.0, y) if is_flat else (x, y, 0.0) for x, y in around])
                corners = one.origin + local @ one.axes.T
            found.append((one.key, find_valid(Polygon(corners[:, :2])), one.height))
        if not any(polygon.area >= SMALLEST_ROOM for _, polygon, _ in found):
            lines = []
            for one in self.walls:
                if one.story == story and one.is_upright and not one.is_curved:
                    reach = (one.sizes[0] / 2 + JOINS) * one.axes[:2, 0]
                    lines.append(LineString([one.origin[:2] - reach, one.origin[:2] + reach]))
            rings = list(list_polygons(shapely.polygonize([shapely.union_all(lines)]))) if lines else []
            closed = enumerate(rings[:MOST_SURFACES], 1)
            found = [(f"room {story} {number}", polygon, self.levels[story]) for number, polygon in closed]
        return [one for one in found if one[1].area >= SMALLEST_ROOM]
