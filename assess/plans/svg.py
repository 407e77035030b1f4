"""The lines of a user's SVG: known shapes alone, with their transforms, curves as chords; nothing else is kept.

What a browser would run or fetch (scripts, pictures, references, styles by address) never leaves this module: of an
element only the numbers of its shape are read. Entities are refused, and sizes bounded.

Source: W3C (2011), Scalable Vector Graphics 1.1, second edition, 7.6 (transforms), 7.7 (viewBox), 8.3 (path data),
9 (shapes), F.6 (arcs from their ends).
"""

import cmath
import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from xml.parsers import expat

import numpy as np

from assess.pictures import MOST_BYTES, PictureError, damaged
from assess.plans.linework import (
    FARTHEST,
    MOST_ELEMENTS,
    MOST_RAW,
    Box,
    FloatArray,
    describe_left_out,
    find_box,
    pack,
    too_many,
)

CHORDS = 8  # chords of a curve
DEEPEST = 100  # elements inside each other
SILENT = frozenset({"title", "desc", "metadata", "defs", "style", "namedview", "symbol", "clipPath", "mask", "marker"})
"""Elements that are left out without a word: they show nothing by themselves."""
UNITS: Mapping[str, float] = {
    "": 1.0, "px": 1.0, "mm": 96 / 25.4, "cm": 96 / 2.54, "in": 96.0, "pt": 96 / 72, "pc": 16.0,
}  # fmt: skip
"""Pixels of each unit of a length."""
NUMBER = r"[-+]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][-+]?\d{1,3})?"
"""A number; its parts give nothing back, so that no text takes more than one pass."""
_LENGTH = re.compile(rf"({NUMBER})\s*+([a-z]*+)")
_ENTRY = re.compile(rf"[\s,]*+({NUMBER})[\s,]*+")
_STEP = re.compile(r"[\s,]*+(matrix|translate|scale|rotate|skewX|skewY)\s*+\(([^()]*+)\)[\s,]*+")
_STYLE = re.compile(r"(?:^|;)\s*+(display|visibility|fill|stroke)\s*+:\s*+([^;!]*+)")
_ROUND = 0.5522847498  # distance of the control points of a quarter circle, over its radius


def unreadable() -> PictureError:
    """Build the error for a drawing with something that SVG does not know."""
    return PictureError.about("a path, a number or a transform in it cannot be read. Save it as plain SVG, or as PNG")


def read_svg(data: bytes) -> tuple[bytes, float, tuple[str, ...]]:
    """Return the lines of an SVG as `assess.plans.linework.pack` keeps them, its aspect, and what is left out.

    Its frame is the viewBox, else its width and height, else the box round its lines.

    Raises PictureError if it is too large, damaged, declares entities, holds something that cannot be read, or no
    lines.
    """
    if len(data) > MOST_BYTES:
        raise PictureError.about("it is larger than {most} MB. Save it smaller", most=MOST_BYTES >> 20)
    reader = _SvgReader()
    try:
        with np.errstate(all="ignore"):  # what lies beyond all bounds is refused
            reader.parser.Parse(data, True)
    except (expat.ExpatError, ValueError, LookupError):  # an encoding that is not known
        raise damaged() from None
    box = reader.frame or find_box(reader.lines)
    return *pack(reader.lines, box, is_down=True), describe_left_out(reader.left_out)


class _SvgReader:
    def __init__(self) -> None:
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler, self.parser.EndElementHandler = self.enter, self.leave
        self.parser.EntityDeclHandler = self.refuse
        self.lines: list[FloatArray] = []
        self.frame: Box | None = None
        self.left_out: Counter[str] = Counter()
        self._open: list[tuple[FloatArray, dict[str, str]]] = []
        self._skipped = self._elements = self._points = 0

    def enter(self, tag: str, attributes: dict[str, str]) -> None:
        self._elements += 1
        if self._elements > MOST_ELEMENTS:
            raise too_many()
        if len(self._open) + self._skipped >= DEEPEST:
            raise damaged()
        prefix, _, name = tag.rpartition(":")
        if self._skipped:
            self._skipped += 1
        elif not self._open:
            if name != "svg":
                raise PictureError.about("it is no PNG, JPEG, SVG or DXF file. Save it as one of them")
            self.frame = _read_frame(attributes)
            self._open.append((np.eye(3), _read_style(attributes, {})))
        elif prefix in ("", "svg") and (name == "g" or name in SHAPES):
            matrix, style = self._open[-1]
            if "transform" in attributes:
                matrix = matrix @ _read_transform(attributes["transform"])
            style = _read_style(attributes, style)
            self._open.append((matrix, style))
            is_drawn = style.get("fill", "black") != "none" or style.get("stroke", "none") != "none"
            is_shown = style.get("display") != "none" and style.get("visibility") not in ("hidden", "collapse")
            if name != "g" and is_drawn and is_shown:
                self._draw(name, attributes, matrix)
        else:
            self._skipped = 1
            if prefix in ("", "svg") and name not in SILENT:
                self.left_out[name] += 1

    def leave(self, _tag: str) -> None:
        if self._skipped:
            self._skipped -= 1
        else:
            self._open.pop()

    def refuse(self, *_: object) -> None:
        raise PictureError.about("it declares XML entities, as an attack does. Save it as plain SVG, or as PNG")

    def _draw(self, name: str, attributes: Mapping[str, str], matrix: FloatArray) -> None:
        for line in _read_shape(name, attributes):
            self._points += max(len(line), 1)
            if self._points > MOST_RAW:
                raise too_many()
            if len(line) > 1:
                points = np.array(line)
                moved = np.column_stack((points.real, points.imag)) @ matrix[:2, :2].T + matrix[:2, 2]
                if not np.abs(moved).max() <= 1e12:
                    raise unreadable()
                self.lines.append(moved)


# ---------------------------------------------------------------- attributes


def _read_frame(attributes: Mapping[str, str]) -> Box | None:
    box = read_list(attributes["viewBox"]) if "viewBox" in attributes else None
    if box is None:
        width, height = (_read_length(attributes, side) for side in ("width", "height"))
        box = [0.0, 0.0, width, height] if width and height else None
    if box is None:
        return None
    if len(box) != 4 or box[2] <= 0 or box[3] <= 0:
        raise unreadable()
    return box[0], box[1], box[0] + box[2], box[1] + box[3]


def _read_style(attributes: Mapping[str, str], above: Mapping[str, str]) -> dict[str, str]:
    """Return what decides whether a shape is seen. What lies in what is not displayed stays hidden (SVG 1.1, 11.5)."""
    own = {name: attributes[name] for name in ("display", "visibility", "fill", "stroke") if name in attributes}
    own |= {found[1]: found[2] for found in _STYLE.finditer(attributes.get("style", ""))}
    if above.get("display") == "none":
        own["display"] = "none"
    return {**above, **{name: value.strip() for name, value in own.items()}}


def read_number(text: str) -> float:
    """Return a finite number of the drawing's coordinates, or raise PictureError."""
    value = float(text)
    if not abs(value) <= FARTHEST:
        raise unreadable()
    return value


def read_list(text: str) -> list[float]:
    """Return numbers split by blanks or commas, or raise PictureError."""
    found, at, text = [], 0, text.strip()
    while at < len(text):
        entry = _ENTRY.match(text, at)
        if not entry:
            raise unreadable()
        found.append(read_number(entry[1]))
        if len(found) > 2 * MOST_RAW:
            raise too_many()
        at = entry.end()
    return found


def _read_length(attributes: Mapping[str, str], name: str) -> float | None:
    """Return a length in pixels, 0 where it is not there; None where it is relative to something else."""
    text = attributes.get(name, "0").strip()
    if text == "auto" or text.endswith(("%", "em", "ex", "rem", "vw", "vh")):
        return None
    found = _LENGTH.fullmatch(text)
    if not found or found[2] not in UNITS:
        raise unreadable()
    return read_number(found[1]) * UNITS[found[2]]


def _read_transform(text: str) -> FloatArray:
    counts = {"matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3), "skewX": (1,), "skewY": (1,)}
    at, matrix = 0, np.eye(3)
    while at < len(text):
        found = _STEP.match(text, at)
        if not found:
            raise unreadable()
        at, name, given = found.end(), found[1], read_list(found[2])
        if len(given) not in counts[name]:
            raise unreadable()
        first, last = given[0], given[-1]
        cos, sin, tan = (way(math.radians(first)) for way in (math.cos, math.sin, math.tan))
        x, y = (given[1], given[2]) if name == "rotate" and len(given) == 3 else (0.0, 0.0)
        a, b, c, d, e, f = {
            "matrix": given,
            "translate": (1.0, 0.0, 0.0, 1.0, first, last if len(given) == 2 else 0.0),
            "scale": (first, 0.0, 0.0, last, 0.0, 0.0),
            "rotate": (cos, sin, -sin, cos, x - cos * x + sin * y, y - sin * x - cos * y),
            "skewX": (1.0, 0.0, tan, 1.0, 0.0, 0.0),
            "skewY": (1.0, tan, 0.0, 1.0, 0.0, 0.0),
        }[name]
        matrix = matrix @ np.array([[a, c, e], [b, d, f], [0.0, 0.0, 1.0]])
    return matrix


# ---------------------------------------------------------------- shapes

Lines = list[list[complex]]  # points of each line, X as the real and Y as the imaginary part
SHAPES: Mapping[str, tuple[str, ...]] = {
    "path": (), "polyline": (), "polygon": (), "line": ("x1", "y1", "x2", "y2"), "rect": ("x", "y", "width", "height"),
    "circle": ("cx", "cy", "r"), "ellipse": ("cx", "cy", "rx", "ry"),
}  # fmt: skip
"""The elements whose lines are drawn, with their lengths."""


def _pair(given: Sequence[float]) -> list[complex]:
    return [complex(x, y) for x, y in zip(given[::2], given[1::2], strict=False)]


def _read_shape(name: str, attributes: Mapping[str, str]) -> Lines:
    """Return the lines of a shape; none where one of its lengths is relative to something else."""
    if name == "path":
        return PathReader().read(attributes.get("d", ""))
    if name in ("polyline", "polygon"):
        points = _pair(read_list(attributes.get("points", "")))
        if len(points) < 2:
            return []
        return [points if name == "polyline" else [*points, points[0]]]
    lengths = [_read_length(attributes, one) for one in SHAPES[name]]
    given = [one for one in lengths if one is not None]
    if len(given) < len(lengths) or (name != "line" and min(given[2:]) <= 0):
        return []
    if name == "line":
        return [_pair(given)]
    x, y, wide, tall = *given[:3], given[-1]
    if name == "rect":
        return [_pair((x, y, x + wide, y, x + wide, y + tall, x, y + tall, x, y))]
    u, v = _ROUND * wide, _ROUND * tall
    ways = ((wide, 0), (wide, v), (u, tall), (0, tall), (-u, tall), (-wide, v), (-wide, 0), (-wide, -v), (-u, -tall),
            (0, -tall), (u, -tall), (wide, -v), (wide, 0))  # fmt: skip
    points = [complex(x + a, y + b) for a, b in ways]
    return [[points[0], *(point for at in range(0, 12, 3) for point in bend(points[at : at + 4]))]]


# ---------------------------------------------------------------- paths

_COMMAND = re.compile(r"[MmZzLlHhVvCcSsQqTtAa]")
_BLANK = re.compile(r"[\s,]*+")
_ARGUMENT = re.compile(rf"[\s,]*+({NUMBER})")
_FLAG = re.compile(r"[\s,]*+([01])")
_ARGUMENTS = {"M": 2, "Z": 0, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7}
"""How many numbers each command takes."""
_CONTINUED = frozenset({("S", "C"), ("S", "S"), ("T", "Q"), ("T", "T")})
"""Commands that go on from the control point of the one before."""


class PathReader:
    """Reads the data of one path; `lines` are its points, a list for every part."""

    def __init__(self) -> None:
        self.lines: Lines = []
        self.here = self.begun = 0j
        self.control: complex | None = None
        self.kind = ""
        self.count = 0

    def read(self, text: str) -> Lines:
        """Return the points of every part, or raise PictureError.

        Each command has left a point or a part, though a part may have one point or none: their number tells the work.
        """
        command, at = "", 0
        while (blank := _BLANK.match(text, at)) and (at := blank.end()) < len(text):
            if found := _COMMAND.match(text, at):
                command, at = found[0], found.end()
            elif command in "Zz":  # nothing was begun, or numbers follow a closed part
                raise unreadable()
            kind, given = command.upper(), list[float]()
            if not self.lines and kind != "M":
                raise unreadable()
            for place in range(_ARGUMENTS[kind]):
                argument = (_FLAG if kind == "A" and place in (3, 4) else _ARGUMENT).match(text, at)
                if not argument:
                    raise unreadable()
                given.append(read_number(argument[1]))
                at = argument.end()
            self._do(kind, given, self.here if command.islower() else 0j)
            command = {"M": "L", "m": "l"}.get(command, command)
        return self.lines

    def _do(self, kind: str, given: list[float], origin: complex) -> None:
        before, self.kind = self.kind, kind
        control = self.control if (kind, before) in _CONTINUED else None
        self.control = None
        if kind == "Z":
            if self.lines[-1]:
                self._go(self.begun)
            self._add(1)
            self.lines.append([])
            self.here = self.begun
        elif kind in "HV":
            x, y = (origin.real + given[0], self.here.imag) if kind == "H" else (self.here.real, origin.imag + given[0])
            self._go(complex(x, y))
        else:
            *controls, end = [origin + point for point in _pair(given[5:] if kind == "A" else given)]
            if kind == "M":
                self.begun = end
                self.lines.append([])
            if kind in "ST":  # the first control point is the reflection of the last of the curve before
                controls.insert(0, 2 * self.here - (self.here if control is None else control))
            if controls:
                self.control = controls[-1]
                if len(controls) == 1:  # quadratic
                    controls = [at + 2 / 3 * (controls[0] - at) for at in (self.here, end)]
                self._go(*bend([self.here, *controls, end]))
            else:
                self._go(*(arc(self.here, end, given) if kind == "A" else [end]))

    def _go(self, *points: complex) -> None:
        if not all(abs(value) <= FARTHEST for point in points for value in (point.real, point.imag)):
            raise unreadable()
        self._add(len(points))
        if self.kind not in "MZ" and not self.lines[-1]:
            self.lines[-1].append(self.begun)
        self.lines[-1] += points
        self.here = points[-1]

    def _add(self, done: int) -> None:
        self.count += done
        if self.count > MOST_RAW:
            raise too_many()


def bend(points: Sequence[complex]) -> list[complex]:
    """Return points of a cubic Bézier curve, from its start, two control points and end; the last at its end."""
    shares = [at / CHORDS for at in range(1, CHORDS)]
    weights = [((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3) for t in shares]
    return [*(sum(a * point for a, point in zip(own, points, strict=True)) for own in weights), points[-1]]


def arc(start: complex, end: complex, given: Sequence[float]) -> list[complex]:
    """Return points of an elliptical arc, the last at its end, from the arguments of its command (F.6.5 and F.6.6)."""
    rx, ry, turn, (is_large, is_swept) = abs(given[0]), abs(given[1]), math.radians(given[2] % 360), given[3:5]
    if rx == 0 or ry == 0 or end == start:
        return [end]
    axis = cmath.rect(1.0, turn)
    half = (start - end) / 2 * axis.conjugate()
    grown = math.sqrt(max((half.real / rx) ** 2 + (half.imag / ry) ** 2, 1.0))
    rx, ry = rx * grown, ry * grown
    ratio = (half.real / rx) ** 2 + (half.imag / ry) ** 2
    root = math.sqrt(max(1 / ratio - 1, 0.0)) * (-1 if is_large == is_swept else 1) if ratio else 0.0
    middle = complex(root * rx * half.imag / ry, -root * ry * half.real / rx)
    begin, stop = (math.atan2((one - middle).imag / ry, (one - middle).real / rx) for one in (half, -half))
    sweep = (stop - begin) % (2 * math.pi) - (0 if is_swept else 2 * math.pi)
    centre = middle * axis + (start + end) / 2
    angles = [begin + sweep * at / (2 * CHORDS) for at in range(1, 2 * CHORDS)]
    return [*(centre + complex(rx * math.cos(one), ry * math.sin(one)) * axis for one in angles), end]
