"""Where the elements of an export are: how workbook and model are shifted, and which door a piece obstructs.

Positions of the workbook are those of the model but for a shift of whole metres, which is found from the pieces that
have both. Lengths are in metres, in the axes of the model.
"""

import math
import statistics
from collections.abc import Mapping, Sequence

from assess.bim.export_model import ModelDoor, ModelElement, Place, find_middle
from assess.bim.export_results import ExportPiece, ExportSegment, Point

AGREE = 0.5
"""Distance up to which the positions of workbook and model are the same, in the median [m]."""
NEAR_DOOR = 1.0
"""Distance from an end of a segment, or from its line, up to which a door belongs to it [m]."""
SAME_STOREY = 2.0
"""Difference in height up to which a door is on the storey of a piece [m]."""
Pair = tuple[ExportPiece, ModelElement]


def find_shift(pairs: Sequence[Pair]) -> Point | None:
    """Return what is to be added to positions of the workbook to have those of the model [m].

    Whole metres; None where no position is known, or where those of workbook and model do not agree.
    """
    known = [(one.place, middle) for one, element in pairs if one.place and (middle := _find_middle(element))]
    if not known:
        return None
    x, y = (round(statistics.median(model[axis] - book[axis] for book, model in known)) for axis in (0, 1))
    left = statistics.median(math.dist((book[0] + x, book[1] + y), model[:2]) for book, model in known)
    return (float(x), float(y)) if left <= AGREE else None


def _find_middle(element: ModelElement) -> Place | None:
    return None if element.low is None or element.high is None else find_middle((element.low, element.high))


def find_doors(
    pairs: Sequence[Pair], segments: Sequence[ExportSegment], doors: Sequence[ModelDoor], shift: Point | None
) -> list[ModelDoor]:
    """Return the doors of the segments that some pieces may block: of each piece the nearest, without repetition.

    Doors at an end of such a segment come before those that it passes.
    """
    if shift is None:
        return []
    found: dict[str, ModelDoor] = {}
    for piece, element in pairs:
        ends = [_move(one.ends, shift) for one in segments if one.ends and piece.past.item in one.items]
        door = _find_door(element, ends, doors)
        if door is not None:
            found[door.key] = door
    return list(found.values())


def _move(ends: tuple[Point, Point], shift: Point) -> tuple[Point, Point]:
    (x1, y1), (x2, y2) = ends
    dx, dy = shift
    return (x1 + dx, y1 + dy), (x2 + dx, y2 + dy)


def _find_door(
    element: ModelElement, segments: Sequence[tuple[Point, Point]], doors: Sequence[ModelDoor]
) -> ModelDoor | None:
    middle = _find_middle(element)
    if middle is None or element.low is None:
        return None
    bottom = element.low[2]
    near = [one for one in doors if abs(one.bottom - bottom) <= SAME_STOREY]
    points = [end for ends in segments for end in ends]
    at_end = [one for one in near if any(_distance(one, end, end) <= NEAR_DOOR for end in points)]
    passed = [one for one in near if any(_distance(one, *ends) <= NEAR_DOOR for ends in segments)]
    here = (middle[0], middle[1])
    return min(at_end or passed, key=lambda one: (_distance(one, here, here), one.key), default=None)


def _distance(door: ModelDoor, start: Point, end: Point) -> float:
    return min(_distance_to_line(point, start, end) for point in door.points)


def _distance_to_line(point: Point, start: Point, end: Point) -> float:
    (x, y), (x1, y1), (x2, y2) = point, start, end
    length = (x2 - x1) ** 2 + (y2 - y1) ** 2
    along = 0.0 if length == 0 else max(0.0, min(1.0, ((x - x1) * (x2 - x1) + (y - y1) * (y2 - y1)) / length))
    return math.dist(point, (x1 + along * (x2 - x1), y1 + along * (y2 - y1)))


def find_centre(elements: Mapping[str, ModelElement]) -> Point:
    """Return the middle of the elements whose place is known, (0, 0) where there is none."""
    middles = [middle for one in elements.values() if (middle := _find_middle(one)) is not None]
    if not middles:
        return 0.0, 0.0
    return statistics.fmean(one[0] for one in middles), statistics.fmean(one[1] for one in middles)
