"""Which floor, room, type or place of a workbook is which of a building model, although people may have renamed it.

What tells is where the pieces stand that both have. Names alone would mislead: whoever calls the floors 0 and 1 that
the model calls 1 and 2 has a floor 1 that is another.

The pieces also tell the origin of the workbook. A model far from its own is brought near in round steps; what an import
takes off follows the outermost element, so that a single new piece may change it by `assess.bim.building_model.ROUND`.
People's own rows and the points of routes keep the origin of the first import.
"""

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any

from assess.bim.building_model import ROUND, Point
from assess.bim.update_cells import Rows
from assess.workbook.names import key
from assess.workbook.parse import Row

Levels = Mapping[str, float | None]
"""Elevations of floors [m] by their names as names are compared; None where it is not known."""

SAME_LEVEL = 0.05  # difference up to which two floors are at one elevation [m]
NEAR = 1.0  # distance from a whole number of steps up to which pieces tell of another origin [m]
ALONG_X, ALONG_Y = ("x", "plan_left"), ("y", "plan_bottom")  # fields of all sheets along each axis [m]
Pair = tuple[Mapping[str, Any], Row]  # a row of the model, and that of the workbook that was imported from it
_NUMBER = re.compile(r"(?: \(\d+\))+$")


def match_floors(model: Levels, workbook: Levels, pairs: Iterable[tuple[str, str]]) -> dict[str, str]:
    """Return the floor of the workbook that each floor of a model is; those of the model alone are left out.

    `model` and `workbook`: the floors, with their elevations [m]. `pairs`: the floors, in the model and in the
    workbook, of every piece that both have.

    A floor has kept its name where no floor of the workbook has more of its pieces than that of the same name. Else it
    is the one that has more than half of them, unless another has kept that name, or the elevations say that the
    pieces, not the names, have moved. Floors without pieces are found by their names and elevations.
    """
    counts: dict[str, Counter[str]] = {}
    for one, own in pairs:
        counts.setdefault(one, Counter())[own] += 1
    found = {one: one for one in workbook if one in counts and counts[one][one] == max(counts[one].values())}
    kept = set(found)

    def is_at(one: str, own: str) -> bool:
        level, other = model[one], workbook.get(own)
        return level is not None and other is not None and abs(level - other) <= SAME_LEVEL

    for one in model:
        own = _find_majority(counts.get(one, Counter()))
        have_moved = is_at(one, one) and not is_at(one, own)  # the pieces, not the names
        if one not in found and own in workbook and own not in kept and not have_moved:
            found[one] = own
    for one in model:  # those of which no pieces tell
        near = [own for own in workbook if own not in found.values() and is_at(one, own)]
        is_named = one in workbook and (one in near or workbook[one] is None or len(near) != 1)
        if one not in found and (is_named or len(near) == 1):
            found[one] = one if is_named else near[0]
    return {one: own for one, own in found.items() if one in model}


def _find_majority(counter: Counter[str]) -> str:
    best, number = max(counter.items(), key=lambda one: one[1], default=("", 0))
    return best if 2 * number > counter.total() else ""


def match_rooms(trios: Iterable[tuple[str, str, str]], known: Collection[str]) -> dict[tuple[str, str], str]:
    """Return the names that people gave to rooms, by floor and room of the model as names are compared: more than half
    of the pieces are in one room that the model does not know, and none in a room of its own name. `trios`: of every
    piece that both have: its floor, its room in the model and in the workbook. `known`: all rooms of the model.
    """
    counts: dict[tuple[str, str], Counter[str]] = {}
    spelt: dict[str, str] = {}
    for floor, room, own in trios:
        counts.setdefault((floor, key(room)), Counter())[key(own)] += 1
        spelt.setdefault(key(own), own)
    found = {}
    for (floor, room), counter in counts.items():
        own = _find_majority(counter)
        if own and own not in known and not counter[room]:
            found[floor, room] = spelt[own]
    return found


@dataclass(frozen=True, slots=True)
class Named:
    """A type or a place: its name, and what tells it from others of that name, such as its sizes or its position."""

    name: str
    content: tuple[Any, ...]

    @property
    def stem(self) -> str:
        """The name as names are compared, without the number by which an import tells it from others."""
        return _NUMBER.sub("", key(self.name))


def match_alike(
    model: Sequence[Named], own: Sequence[Named], is_same: Callable[[Any, Any], bool], *, by_content: bool = False
) -> dict[int, int]:
    """Return which of `own` each of `model` is, by their places in the sequences.

    The number in "Desk (2)" follows the order of the model, which may have changed: what has the same name but for the
    number, and the same content, is the same; then what has the same name; and `by_content` what has the same content,
    although people have renamed it.
    """
    stems: dict[str, list[int]] = {}
    for at, one in enumerate(own):
        stems.setdefault(one.stem, []).append(at)
    found: dict[int, int] = {}
    last = [(False, True, True)] if by_content else []
    for by_name, by_what, of_any_name in ((True, True, False), (False, True, False), (True, False, False), *last):
        taken = set(found.values())
        for at, one in ((at, one) for at, one in enumerate(model) if at not in found):
            for other in range(len(own)) if of_any_name else stems.get(one.stem, ()):
                is_namesake = not by_name or key(one.name) == key(own[other].name)
                if other not in taken and is_namesake and (not by_what or is_same(one.content, own[other].content)):
                    found[at] = other
                    taken.add(other)
                    break
    return found


def find_offset(pairs: Iterable[Pair]) -> Point:
    """Return what leads from positions of a model to the origin of the workbook [m]: the median over the pieces that
    both have, in whole steps of `ROUND`; (0, 0) unless more than half of them lie within `NEAR` of where it puts them.
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

    def move(row: Mapping[str, Any]) -> dict[str, Any]:
        moved = dict(row)
        for names, distance in zip((ALONG_X, ALONG_Y), by, strict=True):
            for name in names:
                if row.get(name) is not None:
                    moved[name] = round(row[name] + distance, 3)
        if row.get("outline"):
            corners = (zip(corner.split(), by, strict=True) for corner in row["outline"].split(";"))
            moved["outline"] = "; ".join(
                " ".join(f"{round(float(one) + distance, 3):g}" for one, distance in corner) for corner in corners
            )
        return moved

    return {sheet: list(map(move, some)) for sheet, some in rows.items()} if any(by) else dict(rows)
