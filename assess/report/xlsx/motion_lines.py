"""The lines of the sheet Floors: one a floor, then one for every further record that serves a floor.

Where several records serve a floor, the one with the largest peak that rules the formula, along each axis, stands in
the floor's own line, which formulas look up by its name; the others stand in lines of the same name below the last
floor.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter

from assess.model import AXES
from assess.report.row_order import order_floors
from assess.results import FloorRow, MotionRow, Results


@dataclass(frozen=True, slots=True)
class MotionLine:
    """One line: the motion of a floor along each axis that has one; `further` are the places of its other records.

    Places count the lines from 0. `further` is empty in a line that is not the floor's own.
    """

    floor: FloorRow
    motions: Mapping[str, MotionRow]
    further: tuple[int, ...] = ()


def list_lines(results: Results) -> list[MotionLine]:
    """Return the lines in order."""
    floors = order_floors(results.floor_rows)
    ruling = results.formula.ruled_by
    sorted_motions = [{axis: _sort(results.motions_of(floor.floor, axis), ruling) for axis in AXES} for floor in floors]
    below: list[MotionLine] = []
    own = []
    for floor, motions in zip(floors, sorted_motions, strict=True):
        first = len(floors) + len(below)
        below += [
            MotionLine(floor, {axis: rows[at] for axis, rows in motions.items() if at < len(rows)})
            for at in range(1, max(map(len, motions.values())))
        ]
        places = tuple(range(first, len(floors) + len(below)))
        own.append(MotionLine(floor, {axis: rows[0] for axis, rows in motions.items() if rows}, places))
    return [*own, *below]


def _sort(motions: Sequence[MotionRow], ruling: str) -> list[MotionRow]:
    """Return parallel motions, that of the largest ruling peak first; in the results' order otherwise."""
    peak = attrgetter({"pfa": "pfa_g", "pfv": "pfv_cm_s"}[ruling])
    largest = max(motions, key=lambda one: round(peak(one) or 0.0, 9), default=None)
    return sorted(motions, key=lambda one: one is not largest)


def find_places(lines: Sequence[MotionLine]) -> dict[int, int]:
    """Return the line of every motion by `MotionRow.index`, 1 for the first."""
    return {motion.index: place for place, line in enumerate(lines, 1) for motion in line.motions.values()}
