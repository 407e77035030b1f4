"""The outline of a place in a cell, ``x y; x y; x y``: its corners, or what is wrong with it."""

import math
import re
from itertools import combinations
from math import hypot

from assess.i18n import Text, fill, nfill
from assess.model import Outline
from assess.units import ROUNDING

LEAST, MOST = 3, 200
"""Corners of an outline."""
FARTHEST = 1e5
"""Largest coordinate [m], as of positions."""
SAME = 1e-3
"""Distance up to which two corners are the same [m]."""
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)")
_DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+")
_MAYBE_THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2},\d{3}")

Corner = tuple[float, float]


class OutlineError(Exception):
    """An outline that cannot be used; `message` tells why."""

    def __init__(self, message: Text) -> None:
        super().__init__(message)
        self.message = message


def parse_outline(text: str, factor: float) -> Outline:
    """Return the corners of an outline [m]; its last corner may repeat the first.

    `text`: ``x y; x y; x y``; the comma of ``6,5 0`` is a decimal one.
    `factor`: from its unit to m.
    Raises OutlineError if a corner is not two numbers or can be read in two ways (``1,500 0``), two that follow each
    other are the same, there are fewer than three or more than 200, or its sides cross or touch each other.
    """
    parts = [part.split() for part in text.replace("\n", ";").split(";") if part.strip()]
    corners = [_read_corner(at, part, factor) for at, part in enumerate(parts, 1)]
    if len(corners) > 1 and _is_same(corners[0], corners[-1]):
        corners.pop()
    if not LEAST <= len(corners) <= MOST:
        raise OutlineError(nfill(
            "it has {n:,} corner, expected {least} to {most}.",
            "it has {n:,} corners, expected {least} to {most}.",
            len(corners), least=LEAST, most=MOST,
        ))  # fmt: skip
    for at, corner in enumerate(corners):
        if _is_same(corner, corners[at - 1]):
            raise OutlineError(fill("corner {n} is the same as the one before it.", n=at + 1))
    _check_sides(corners)
    return tuple(corners)


def _read_corner(number: int, part: list[str], factor: float) -> Corner:
    part = _take_commas(number, part)
    if len(part) != 2 or not all(_NUMBER.fullmatch(one) for one in part):
        shown = " ".join(part)[:40]
        raise OutlineError(fill("corner {n} is '{text}', expected two numbers, x and y.", n=number, text=shown))
    x, y = (float(one) * factor for one in part)
    if max(abs(x), abs(y)) > FARTHEST:
        raise OutlineError(fill("corner {n} lies more than {most:,} km away.", n=number, most=int(FARTHEST / 1000)))
    return x, y


def _take_commas(number: int, part: list[str]) -> list[str]:
    if len(part) != 2 or not all(_NUMBER.fullmatch(one) or _DECIMAL_COMMA.fullmatch(one) for one in part):
        return part
    if any(_MAYBE_THOUSANDS.fullmatch(one) for one in part):
        shown = " ".join(part)[:40]
        raise OutlineError(
            fill("corner {n} is '{text}', which can be read in two ways: write decimals with a point.",
                 n=number, text=shown)
        )  # fmt: skip
    return [one.replace(",", ".") for one in part]


def _is_same(one: Corner, other: Corner) -> bool:
    return hypot(one[0] - other[0], one[1] - other[1]) <= SAME


def _check_sides(corners: list[Corner]) -> None:
    """Raise OutlineError where two sides meet other than at the corner that they share, or fold back there."""
    count = len(corners)
    sides = [(corners[at], corners[(at + 1) % count]) for at in range(count)]
    for one, other in combinations(range(count), 2):
        is_next = other - one == 1 or (one == 0 and other == count - 1)
        if _fold_back(sides, one, other) if is_next else _meet(*sides[one], *sides[other]):
            names = {"one": one + 1, "other": other + 1}
            raise OutlineError(fill("its sides {one} and {other} cross or touch each other.", **names))


def _fold_back(sides: list[tuple[Corner, Corner]], one: int, other: int) -> bool:
    first, last = (one, other) if other - one == 1 else (other, one)
    (a, b), (_, c) = sides[first], sides[last]
    back, on = (a[0] - b[0], a[1] - b[1]), (c[0] - b[0], c[1] - b[1])
    turn = back[0] * on[1] - back[1] * on[0]
    along = back[0] * on[0] + back[1] * on[1]
    return along > 0 and abs(turn) <= ROUNDING * math.hypot(*back) * math.hypot(*on)


def _meet(a: Corner, b: Corner, c: Corner, d: Corner) -> bool:
    turns = _turn(a, b, c), _turn(a, b, d), _turn(c, d, a), _turn(c, d, b)
    if turns[0] * turns[1] < 0 and turns[2] * turns[3] < 0:
        return True
    ends = ((a, b, c), (a, b, d), (c, d, a), (c, d, b))
    return any(turn == 0 and _is_between(*end) for turn, end in zip(turns, ends, strict=True))


def _turn(a: Corner, b: Corner, c: Corner) -> float:
    cross = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    size = hypot(b[0] - a[0], b[1] - a[1]) * hypot(c[0] - a[0], c[1] - a[1])
    return 0.0 if abs(cross) <= ROUNDING * size else cross


def _is_between(a: Corner, b: Corner, c: Corner) -> bool:
    return all(min(one, two) - SAME <= at <= max(one, two) + SAME for one, two, at in zip(a, b, c, strict=True))
