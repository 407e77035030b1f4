"""A RoomPlan scan as checked values: elements with their category, sizes and position; every fault with its place.

What is read rests on the public Swift interface of RoomPlan (CapturedRoom, CapturedStructure, their Surface, Object and
Section) as `JSONEncoder` writes it, and on what public programs read of such files; Apple documents no JSON. Lengths
are in metres. A position is a matrix of 4 x 4 numbers, column after column, 16 in a row or 4 lists of 4. In the file Y
points upwards; here Z does, and plan X and Y are x and -z.
"""

import json
import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.errors import ModelError
from assess.i18n import Text, fill

FloatArray = NDArray[np.float64]

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
UPRIGHT = 0.999
"""Least Z of the vertical axis of what stands upright [-]: within 2.6 degrees."""
LONGEST_WORD = 60
"""Characters that are kept of a category or label."""
LISTS = ("objects", "walls", "doors", "windows", "openings", "floors")
"""Lists of elements of a CapturedRoom and a CapturedStructure."""
_AGAIN = fill("Export the scan again.")
_UPWARDS = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Turns the axes of a file, Y upwards, into those of a plan, Z upwards."""


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


def parse_scan(data: bytes, name: str) -> Scan:
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
        """Yield the elements of one list."""
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
                words, centre = say_word(read_word(data.get("label"))), data.get("center")
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


def say_word(word: str) -> str:
    """Return a word of the file as people write it: ``washerDryer`` is "Washer dryer"."""
    parts = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", word.replace("_", " ")).lower()
    return parts[:1].upper() + parts[1:]
