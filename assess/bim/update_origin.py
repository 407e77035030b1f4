"""The origin of a workbook: a model far from its own is brought near in round steps, today perhaps by another step.

What an import takes off positions follows the outermost element of the model, so that a single new piece may change it
by `assess.bim.model_position.ROUND`. People's own rows and the points of routes keep the origin of the first import.
"""

from collections.abc import Iterable, Mapping
from statistics import median
from typing import Any

from assess.bim.building_model import Point
from assess.bim.model_position import ROUND
from assess.bim.update_rows import Rows
from assess.workbook.parse import Row

Pair = tuple[Mapping[str, Any], Row]
"""A row of the model, and that of the workbook that was imported from it."""
NEAR = 1.0
"""Distance from a whole number of steps up to which pieces tell of another origin [m]."""
ALONG_X, ALONG_Y = ("x", "plan_left"), ("y", "plan_bottom")
"""Fields of all sheets along each axis [m]."""


def find_offset(pairs: Iterable[Pair]) -> Point:
    """Return what is to be added to the positions of a model, so that they have the origin of the workbook [m].

    It is the median over the pieces that both have, along each axis in whole steps of `ROUND`; (0, 0) unless more than
    half of them lie within `NEAR` of where it puts them.
    """
    steps = [
        (row.get("x") - model["x"], row.get("y") - model["y"])
        for model, row in pairs
        if None not in (model.get("x"), model.get("y"), row.get("x"), row.get("y"))
    ]
    if not steps:
        return 0.0, 0.0
    x, y = (ROUND * round(median(step[axis] for step in steps) / ROUND) for axis in (0, 1))
    near = sum(abs(step[0] - x) <= NEAR and abs(step[1] - y) <= NEAR for step in steps)
    return (x, y) if 2 * near > len(steps) else (0.0, 0.0)


def move_rows(rows: Mapping[str, Rows], by: Point) -> dict[str, Rows]:
    """Return the rows of an import, by sheet, with all their positions and outlines moved [m]."""
    return {sheet: [_move_row(row, by) for row in some] for sheet, some in rows.items()} if any(by) else dict(rows)


def _move_row(row: Mapping[str, Any], by: Point) -> dict[str, Any]:
    moved = dict(row)
    for names, distance in zip((ALONG_X, ALONG_Y), by, strict=True):
        for name in names:
            if row.get(name) is not None:
                moved[name] = round(row[name] + distance, 3)
    if row.get("outline"):
        moved["outline"] = "; ".join(
            " ".join(f"{round(float(one) + distance, 3):g}" for one, distance in zip(corner.split(), by, strict=True))
            for corner in row["outline"].split(";")
        )
    return moved
