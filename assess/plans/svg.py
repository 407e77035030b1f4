"""The lines of a user's SVG: known shapes alone, with their transforms; nothing else of the file is kept.

What a browser would run or fetch (scripts, pictures, references, styles by address) never leaves this module: of an
element only the numbers of its shape are read. Entities are refused, and sizes bounded.

Source: W3C (2011), Scalable Vector Graphics 1.1, second edition, 7.6 (transforms), 7.7 (viewBox), 9 (shapes).
"""

import math
import re
from collections import Counter
from collections.abc import Callable, Mapping
from xml.parsers import expat

from assess.i18n import fill
from assess.pictures import MOST_BYTES, PictureError, damaged
from assess.plans.linework import MOST_ELEMENTS, MOST_RAW, Box, describe_left_out, find_box, pack, too_many
from assess.plans.svg_path import NUMBER, PathReader, Point, bend, read_number, unreadable

DEEPEST = 100
"""Elements inside each other."""
SILENT = frozenset({"title", "desc", "metadata", "defs", "style", "namedview", "symbol", "clipPath", "mask", "marker"})
"""Elements that are left out without a word: they show nothing by themselves."""
UNITS: Mapping[str, float] = {
    "": 1.0, "px": 1.0, "mm": 96 / 25.4, "cm": 96 / 2.54, "in": 96.0, "pt": 96 / 72, "pc": 16.0,
}  # fmt: skip
"""Pixels of each unit of a length."""
_LENGTH = re.compile(rf"({NUMBER})\s*+([a-z]*+)")
_ENTRY = re.compile(rf"[\s,]*+({NUMBER})[\s,]*+")
_STEP = re.compile(r"[\s,]*+(matrix|translate|scale|rotate|skewX|skewY)\s*+\(([^()]*+)\)[\s,]*+")
_STYLE = re.compile(r"(?:^|;)\s*+(display|visibility|fill|stroke)\s*+:\s*+([^;!]*+)")
_ROUND = 0.5522847498
"""Distance of the control points of a quarter circle, over its radius."""

Matrix = tuple[float, float, float, float, float, float]
SAME: Matrix = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)


def read_svg(data: bytes) -> tuple[bytes, float, tuple[str, ...]]:
    """Return the lines of an SVG as `assess.plans.linework.pack` keeps them, its aspect, and what is left out.

    Its frame is the viewBox, else its width and height, else the box round its lines.

    Raises PictureError if it is too large, damaged, declares entities, holds something that cannot be read, or no
    lines.
    """
    if len(data) > MOST_BYTES:
        raise PictureError(fill("it is larger than {most} MB. Save it smaller", most=MOST_BYTES >> 20))
    reader = SvgReader()
    try:
        reader.parser.Parse(data, True)
    except (expat.ExpatError, ValueError, LookupError):  # an encoding that is not known
        raise damaged() from None
    box = reader.frame or find_box(reader.lines)
    return *pack(reader.lines, box, is_down=True), describe_left_out(reader.left_out)


class SvgReader:
    """Takes in the elements of an SVG; `lines` are in the units of its root."""

    def __init__(self) -> None:
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler, self.parser.EndElementHandler = self.enter, self.leave
        self.parser.EntityDeclHandler = self._refuse
        self.lines: list[list[Point]] = []
        self.frame: Box | None = None
        self.left_out: Counter[str] = Counter()
        self._open: list[tuple[Matrix, dict[str, str]]] = []
        self._skipped = self._elements = self._points = 0

    def enter(self, tag: str, attributes: dict[str, str]) -> None:
        """Take in an element that begins."""
        self._elements += 1
        if self._elements > MOST_ELEMENTS:
            raise too_many()
        if len(self._open) + self._skipped >= DEEPEST:
            raise damaged()
        if self._skipped:
            self._skipped += 1
            return
        prefix, _, name = tag.rpartition(":")
        if not self._open:
            self._begin(name, attributes)
        elif prefix not in ("", "svg") or not (name == "g" or name in _SHAPES):
            self._skipped = 1
            if prefix in ("", "svg") and name not in SILENT:
                self.left_out[name] += 1
        else:
            self._inside(name, attributes)

    def leave(self, _tag: str) -> None:
        """Take in the end of an element."""
        if self._skipped:
            self._skipped -= 1
        else:
            self._open.pop()

    def _refuse(self, *_: object) -> None:
        raise PictureError(fill("it declares XML entities, as an attack does. Save it as plain SVG, or as PNG"))

    def _begin(self, name: str, attributes: dict[str, str]) -> None:
        if name != "svg":
            raise PictureError(fill("it is no PNG, JPEG, SVG or DXF file. Save it as one of them"))
        box = read_list(attributes["viewBox"]) if "viewBox" in attributes else None
        if box is None:
            width, height = (read_length(attributes, side) for side in ("width", "height"))
            box = [0.0, 0.0, width, height] if width and height else None
        if box is not None:
            if len(box) != 4 or box[2] <= 0 or box[3] <= 0:
                raise unreadable()
            self.frame = (box[0], box[1], box[0] + box[2], box[1] + box[3])
        self._open.append((SAME, read_style(attributes, {})))

    def _inside(self, name: str, attributes: dict[str, str]) -> None:
        above, style = self._open[-1]
        matrix = multiply(above, read_transform(attributes["transform"])) if "transform" in attributes else above
        style = read_style(attributes, style)
        self._open.append((matrix, style))
        if name == "g" or not is_shown(style):
            return
        for line in _SHAPES[name](attributes):
            self._points += max(len(line), 1)
            if self._points > MOST_RAW:
                raise too_many()
            if len(line) > 1:
                self.lines.append([apply(matrix, point) for point in line])


# ---------------------------------------------------------------- attributes


def read_style(attributes: Mapping[str, str], above: Mapping[str, str]) -> dict[str, str]:
    """Return what decides whether a shape is seen: its own, else that of the element round it.

    What lies in an element that is not displayed stays hidden, whatever it says itself (SVG 1.1, 11.5).
    """
    own = {name: attributes[name] for name in ("display", "visibility", "fill", "stroke") if name in attributes}
    own |= {found[1]: found[2] for found in _STYLE.finditer(attributes.get("style", ""))}
    if above.get("display") == "none":
        own["display"] = "none"
    return {**above, **{name: value.strip() for name, value in own.items()}}


def is_shown(style: Mapping[str, str]) -> bool:
    """Tell whether a shape of this style is seen."""
    is_drawn = style.get("fill", "black") != "none" or style.get("stroke", "none") != "none"
    return is_drawn and style.get("display") != "none" and style.get("visibility") not in ("hidden", "collapse")


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


def read_length(attributes: Mapping[str, str], name: str) -> float | None:
    """Return a length in pixels, 0 where it is not there; None where it is relative to something else."""
    text = attributes.get(name, "0").strip()
    if text == "auto" or text.endswith(("%", "em", "ex", "rem", "vw", "vh")):
        return None
    found = _LENGTH.fullmatch(text)
    if not found or found[2] not in UNITS:
        raise unreadable()
    return read_number(found[1]) * UNITS[found[2]]


def read_transform(text: str) -> Matrix:
    """Return the matrix of a list of transforms, or raise PictureError."""
    at, matrix = 0, SAME
    while at < len(text):
        found = _STEP.match(text, at)
        if not found:
            raise unreadable()
        matrix, at = multiply(matrix, _step(found[1], read_list(found[2]))), found.end()
    return matrix


def _step(name: str, given: list[float]) -> Matrix:
    counts = {"matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3), "skewX": (1,), "skewY": (1,)}
    if len(given) not in counts[name]:
        raise unreadable()
    first, last = given[0], given[-1]
    if name == "matrix":
        a, b, c, d, e, f = given
        return a, b, c, d, e, f
    if name == "translate":
        return 1.0, 0.0, 0.0, 1.0, first, last if len(given) == 2 else 0.0
    if name == "scale":
        return first, 0.0, 0.0, last, 0.0, 0.0
    cos, sin, tan = math.cos(math.radians(first)), math.sin(math.radians(first)), math.tan(math.radians(first))
    if name != "rotate":
        return (1.0, 0.0, tan, 1.0, 0.0, 0.0) if name == "skewX" else (1.0, tan, 0.0, 1.0, 0.0, 0.0)
    x, y = (given[1], given[2]) if len(given) == 3 else (0.0, 0.0)
    return cos, sin, -sin, cos, x - cos * x + sin * y, y - sin * x - cos * y


def multiply(one: Matrix, other: Matrix) -> Matrix:
    """Return the matrix that does `other` first."""
    a, b, c, d, e, f = one
    p, q, r, s, t, u = other
    return a * p + c * q, b * p + d * q, a * r + c * s, b * r + d * s, a * t + c * u + e, b * t + d * u + f


def apply(matrix: Matrix, point: Point) -> Point:
    """Return where a point comes to lie; raises PictureError where that is beyond all bounds."""
    a, b, c, d, e, f = matrix
    x, y = a * point[0] + c * point[1] + e, b * point[0] + d * point[1] + f
    if not max(abs(x), abs(y)) <= 1e12:
        raise unreadable()
    return x, y


# ---------------------------------------------------------------- shapes

Attributes = Mapping[str, str]
Lines = list[list[Point]]


def _lengths(attributes: Attributes, *names: str) -> list[float] | None:
    """Return lengths; None where one of them is relative to something else."""
    found = [read_length(attributes, name) for name in names]
    return None if None in found else [one for one in found if one is not None]


def _line(attributes: Attributes) -> Lines:
    given = _lengths(attributes, "x1", "y1", "x2", "y2")
    return [[(given[0], given[1]), (given[2], given[3])]] if given else []


def _polyline(attributes: Attributes) -> Lines:
    given = read_list(attributes.get("points", ""))
    points = list(zip(given[::2], given[1::2], strict=False))
    return [points] if len(points) > 1 else []


def _polygon(attributes: Attributes) -> Lines:
    return [[*points, points[0]] for points in _polyline(attributes)]


def _rect(attributes: Attributes) -> Lines:
    given = _lengths(attributes, "x", "y", "width", "height")
    if not given or given[2] <= 0 or given[3] <= 0:
        return []
    x, y, wide, tall = given
    return [[(x, y), (x + wide, y), (x + wide, y + tall), (x, y + tall), (x, y)]]


def _round(x: float, y: float, rx: float, ry: float) -> Lines:
    if rx <= 0 or ry <= 0:
        return []
    u, v = _ROUND * rx, _ROUND * ry
    quarters = (
        ((x + rx, y), (x + rx, y + v), (x + u, y + ry), (x, y + ry)),
        ((x, y + ry), (x - u, y + ry), (x - rx, y + v), (x - rx, y)),
        ((x - rx, y), (x - rx, y - v), (x - u, y - ry), (x, y - ry)),
        ((x, y - ry), (x + u, y - ry), (x + rx, y - v), (x + rx, y)),
    )
    return [[(x + rx, y), *(point for quarter in quarters for point in bend(*quarter))]]


def _circle(attributes: Attributes) -> Lines:
    given = _lengths(attributes, "cx", "cy", "r")
    return _round(given[0], given[1], given[2], given[2]) if given else []


def _ellipse(attributes: Attributes) -> Lines:
    given = _lengths(attributes, "cx", "cy", "rx", "ry")
    return _round(given[0], given[1], given[2], given[3]) if given else []


_SHAPES: Mapping[str, Callable[[Attributes], Lines]] = {
    "path": lambda attributes: PathReader(attributes.get("d", "")).read(), "line": _line, "polyline": _polyline,
    "polygon": _polygon, "rect": _rect, "circle": _circle, "ellipse": _ellipse,
}  # fmt: skip
"""The elements whose lines are drawn."""
