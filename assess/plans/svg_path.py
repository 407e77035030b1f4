"""The data of an SVG path as points: every command of SVG, curves as chords.

Source: W3C (2011), Scalable Vector Graphics 1.1, second edition, 8.3 (path data), F.6 (arcs from their ends).
"""

import math
import re
from collections.abc import Callable

from assess.i18n import fill
from assess.pictures import PictureError
from assess.plans.linework import FARTHEST, MOST_RAW, too_many

Point = tuple[float, float]

CHORDS = 8
"""Chords of a curve."""
NUMBER = r"[-+]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][-+]?\d{1,3})?"
"""A number; its parts give nothing back, so that no text takes more than one pass."""
_NUMBER = re.compile(rf"[\s,]*+({NUMBER})")
_FLAG = re.compile(r"[\s,]*+([01])")
_COMMAND = re.compile(r"[\s,]*+([MmZzLlHhVvCcSsQqTtAa])")
_BLANK = re.compile(r"[\s,]*+")


def unreadable() -> PictureError:
    """Build the error for a drawing with something that SVG does not know."""
    return PictureError(fill("a path, a number or a transform in it cannot be read. Save it as plain SVG, or as PNG"))


def read_number(text: str) -> float:
    """Return a finite number of the drawing's coordinates, or raise PictureError."""
    value = float(text)
    if not abs(value) <= FARTHEST:
        raise unreadable()
    return value


class PathReader:
    """Reads path data; `lines` are its points, a list for every part."""

    def __init__(self, text: str) -> None:
        self.text, self.at = text, 0
        self.lines: list[list[Point]] = []
        self.here = self.begun = (0.0, 0.0)
        self.control: Point | None = None
        self.kind = ""
        self.count = 0

    def read(self) -> list[list[Point]]:
        """Return the points of every part, or raise PictureError.

        Each command has left a point or a part, though a part may have one point or none: their number tells the work.
        """
        command = ""
        while (blank := _BLANK.match(self.text, self.at)) and blank.end() < len(self.text):
            found = _COMMAND.match(self.text, self.at)
            if found:
                command, self.at = found[1], found.end()
            elif command in "Zz":  # nothing was begun, or numbers follow a closed part
                raise unreadable()
            self._do(command)
            command = {"M": "L", "m": "l"}.get(command, command)
        return self.lines

    def _do(self, command: str) -> None:
        kind = command.upper()
        if not self.lines and kind != "M":
            raise unreadable()
        origin = self.here if command.islower() else (0.0, 0.0)
        steps: dict[str, Callable[[Point], None]] = {
            "M": self._move, "Z": self._close, "L": self._line, "H": self._across, "V": self._up,
            "C": self._cubic, "S": self._cubic, "Q": self._quadratic, "T": self._quadratic, "A": self._arc,
        }  # fmt: skip
        before, self.kind = self.kind, kind
        if (kind == "S" and before not in "CS") or (kind == "T" and before not in "QT") or kind not in "CSQT":
            self.control = None
        steps[kind](origin)

    def _take(self, pattern: re.Pattern[str] = _NUMBER) -> float:
        found = pattern.match(self.text, self.at)
        if not found:
            raise unreadable()
        self.at = found.end()
        return read_number(found[1])

    def _point(self, origin: Point) -> Point:
        x = self._take()
        return origin[0] + x, origin[1] + self._take()

    def _go(self, *points: Point) -> None:
        if not all(abs(value) <= FARTHEST for point in points for value in point):
            raise unreadable()
        self._count(len(points))
        if self.kind not in "MZ" and not self.lines[-1]:
            self.lines[-1].append(self.begun)
        self.lines[-1] += points
        self.here = points[-1]

    def _count(self, done: int) -> None:
        self.count += done
        if self.count > MOST_RAW:
            raise too_many()

    def _move(self, origin: Point) -> None:
        self.begun = self._point(origin)
        self.lines.append([])
        self._go(self.begun)

    def _close(self, _origin: Point) -> None:
        if self.lines[-1]:
            self._go(self.begun)
        self._count(1)
        self.lines.append([])
        self.here = self.begun

    def _line(self, origin: Point) -> None:
        self._go(self._point(origin))

    def _across(self, origin: Point) -> None:
        self._go((origin[0] + self._take(), self.here[1]))

    def _up(self, origin: Point) -> None:
        self._go((self.here[0], origin[1] + self._take()))

    def _reflected(self) -> Point:
        if self.control is None:
            return self.here
        return 2 * self.here[0] - self.control[0], 2 * self.here[1] - self.control[1]

    def _cubic(self, origin: Point) -> None:
        first = self._reflected() if self.kind == "S" else self._point(origin)
        second, end = self._point(origin), self._point(origin)
        points = bend(self.here, first, second, end)
        self.control = second
        self._go(*points)

    def _quadratic(self, origin: Point) -> None:
        control = self._reflected() if self.kind == "T" else self._point(origin)
        end, here = self._point(origin), self.here
        first, second = (
            (one[0] + 2 / 3 * (control[0] - one[0]), one[1] + 2 / 3 * (control[1] - one[1])) for one in (here, end)
        )
        self.control = control
        self._go(*bend(here, first, second, end))

    def _arc(self, origin: Point) -> None:
        rx, ry, turn = abs(self._take()), abs(self._take()), self._take()
        is_large, is_anticlockwise = bool(self._take(_FLAG)), bool(self._take(_FLAG))
        end = self._point(origin)
        if rx == 0 or ry == 0 or end == self.here:
            self._go(end)
        else:
            radii = (rx, ry, math.radians(turn % 360))
            self._go(*arc(self.here, end, radii, is_large=is_large, is_swept=is_anticlockwise))


def bend(start: Point, first: Point, second: Point, end: Point) -> list[Point]:
    """Return points of a cubic Bézier curve, the last at its end."""
    found = []
    for at in range(1, CHORDS):
        t = at / CHORDS
        a, b, c, d = (1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3
        x, y = (a * start[i] + b * first[i] + c * second[i] + d * end[i] for i in (0, 1))
        found.append((x, y))
    return [*found, end]


def arc(start: Point, end: Point, radii: tuple[float, float, float], *, is_large: bool, is_swept: bool) -> list[Point]:
    """Return points of an elliptical arc, the last at its end (F.6.5 and F.6.6); `radii` ends with its turn [rad]."""
    rx, ry, turn = radii
    cos, sin = math.cos(turn), math.sin(turn)
    half_x, half_y = (start[0] - end[0]) / 2, (start[1] - end[1]) / 2
    x, y = cos * half_x + sin * half_y, cos * half_y - sin * half_x
    grown = math.sqrt(max((x / rx) ** 2 + (y / ry) ** 2, 1.0))
    rx, ry = rx * grown, ry * grown
    ratio = (x / rx) ** 2 + (y / ry) ** 2
    root = math.sqrt(max(1 / ratio - 1, 0.0)) * (-1 if is_large == is_swept else 1) if ratio else 0.0
    u, v = root * rx * y / ry, -root * ry * x / rx
    centre = cos * u - sin * v + (start[0] + end[0]) / 2, sin * u + cos * v + (start[1] + end[1]) / 2
    begin = math.atan2((y - v) / ry, (x - u) / rx)
    sweep = (math.atan2((-y - v) / ry, (-x - u) / rx) - begin) % (2 * math.pi)
    sweep -= 0 if is_swept else 2 * math.pi
    found = []
    for at in range(1, 2 * CHORDS):
        angle = begin + sweep * at / (2 * CHORDS)
        along, across = rx * math.cos(angle), ry * math.sin(angle)
        found.append((centre[0] + cos * along - sin * across, centre[1] + sin * along + cos * across))
    return [*found, end]
