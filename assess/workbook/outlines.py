"""The outline of a place in a cell, ``x y; x y; x y``: its corners, or what is wrong with it."""

import math
import re
from itertools import combinations

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
    corners: list[Corner] = []
    parts = (part.strip() for part in text.replace("\n", ";").split(";"))
    for number, typed in enumerate(filter(None, parts), 1):
        part = typed.split()
        shown, count = " ".join(part)[:40], len(part)
        if count == 2 and all(_NUMBER.fullmatch(one) or _DECIMAL_COMMA.fullmatch(one) for one in part):
            if any(_MAYBE_THOUSANDS.fullmatch(one) for one in part):
                raise OutlineError(
                    fill("corner {n} is '{text}', which can be read in two ways: write decimals with a point.",
                         n=number, text=shown)
                )  # fmt: skip
            part = [one.replace(",", ".") for one in part]
        if count != 2 or not all(_NUMBER.fullmatch(one) for one in part):
            raise OutlineError(fill("corner {n} is '{text}', expected two numbers, x and y.", n=number, text=shown))
        x, y = (float(one) * factor for one in part)
        if max(abs(x), abs(y)) > FARTHEST:
            raise OutlineError(fill("corner {n} lies more than {most:,} km away.", n=number, most=int(FARTHEST / 1000)))
        corners.append((x, y))
    if len(corners) > 1 and math.dist(corners[0], corners[-1]) <= SAME:
        corners.pop()
    if not LEAST <= len(corners) <= MOST:
        raise OutlineError(nfill(
            "it has {n:,} corner, expected {least} to {most}.",
            "it has {n:,} corners, expected {least} to {most}.",
            len(corners), least=LEAST, most=MOST,
        ))  # fmt: skip
    for at, corner in enumerate(corners):
        if math.dist(corner, corners[at - 1]) <= SAME:
            raise OutlineError(fill("corner {n} is the same as the one before it.", n=at + 1))
    sides = list(zip(corners, [*corners[1:], corners[0]], strict=True))
    for one, other in combinations(range(len(sides)), 2):
        if _cross(sides, one, other):
            names = {"one": one + 1, "other": other + 1}
            raise OutlineError(fill("its sides {one} and {other} cross or touch each other.", **names))
    return tuple(corners)


def _cross(sides: list[tuple[Corner, Corner]], one: int, other: int) -> bool:
    """Return whether two sides meet other than at the corner that they share, or fold back there."""
    if other - one == 1 or (one == 0 and other == len(sides) - 1):
        (a, b), (_, c) = (sides[at] for at in ((one, other) if other - one == 1 else (other, one)))
        along = (a[0] - b[0]) * (c[0] - b[0]) + (a[1] - b[1]) * (c[1] - b[1])
        return along > 0 and _turn(b, a, c) == 0
    (a, b), (c, d) = sides[one], sides[other]
    ends = ((a, b, c), (a, b, d), (c, d, a), (c, d, b))
    turns = [_turn(*end) for end in ends]
    if turns[0] * turns[1] < 0 and turns[2] * turns[3] < 0:
        return True
    return any(
        turn == 0 and all(min(x, y) - SAME <= at <= max(x, y) + SAME for x, y, at in zip(*end, strict=True))
        for turn, end in zip(turns, ends, strict=True)
    )


def _turn(a: Corner, b: Corner, c: Corner) -> float:
    """Return twice the area of a triangle, 0 where its corners lie on one line."""
    cross = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return 0.0 if abs(cross) <= ROUNDING * math.dist(a, b) * math.dist(a, c) else cross
