"""Where texts go on a figure so that they lie neither on each other nor on a symbol; all in points."""

from collections.abc import Sequence

import numpy as np

from assess.methods._method import FloatArray

LETTER, LINE, GAP = 3.7, 7.0, 5.0
"""About the width of a letter and the height of a line of 6 points, and a text's distance from a symbol."""

Box = tuple[float, float, float, float]
"""Left, low, right and high end."""


def box_around(x: float, y: float, width: float, height: float) -> Box:
    """Return the box with its centre at (x, y)."""
    return x - width / 2, y - height / 2, x + width / 2, y + height / 2


def find_room(at: tuple[float, float], text: str, panel: tuple[float, float], taken: Sequence[Box]) -> Box | None:
    """Return a box for a text beside the symbol `at`, within the panel and on no box that is taken; None if none is.

    Tried are right, left, above and below.
    """
    (x, y), width = at, LETTER * len(text)
    aside, above = GAP + width / 2, GAP + LINE / 2
    for centre in ((x + aside, y), (x - aside, y), (x, y + above), (x, y - above)):
        box = box_around(*centre, width, LINE)
        if box[0] >= 0 and box[1] >= 0 and box[2] <= panel[0] and box[3] <= panel[1] and not _hits(box, taken):
            return box
    return None


def _hits(box: Box, taken: Sequence[Box]) -> bool:
    return any(box[0] < right and left < box[2] and box[1] < high and low < box[3] for left, low, right, high in taken)


def find_clearest(line: FloatArray, panel: tuple[float, float], others: FloatArray, margin: float) -> int | None:
    """Return the place on a line (n, 2) that is farthest from `others` (k, 2), inside by `margin`; None without one."""
    inside = np.all((line >= margin) & (line <= np.array(panel) - margin), axis=1)
    if not inside.any():
        return None
    away = np.hypot(*(line[:, np.newaxis] - others[np.newaxis]).transpose(2, 0, 1)) if len(others) else np.ones((1, 1))
    nearest = np.where(inside, away.min(axis=1), -1.0)
    return int(nearest.argmax())
