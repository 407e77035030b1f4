"""Where the topics of an export look: from which point, at which elements, and at which door that a piece obstructs.

Positions of the workbook are those of the model but for a shift of whole metres, which is found from the pieces that
have both. Lengths are in metres, in the axes of the model.
"""

import math
import statistics
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from assess.bim.export_model import Box, ModelDoor, ModelElement, Place, find_middle
from assess.bim.export_results import ExportPiece, ExportSegment, Point

AGREE = 0.5
"""Distance up to which the positions of workbook and model are the same, in the median [m]."""
NEAR_DOOR = 1.0
"""Distance from an end of a segment, or from its line, up to which a door belongs to it [m]."""
SAME_STOREY = 2.0
"""Difference in height up to which a door is on the storey of a piece [m]."""
DISTANCE, EYE = 3.0, 2.2
"""Distance of the camera from a piece, and its height above the piece's base: under the usual ceilings [m]."""
ROOM = 1.6
"""Distance from which all is in sight of a screen that is broader than high, over that of a round one."""
LARGEST = 5.0
"""Half the extent of pieces that are looked at together; of others the first is looked at [m]."""
STEEPEST = 1e-3
"""Sine of the angle between the camera's direction and the vertical below which it looks straight down."""
FROM_WALL = 0.3
"""[m]"""
FIELD_OF_VIEW = 60.0
"""Horizontal [deg]; BCF 2.1 allows 45 to 60."""
Pair = tuple[ExportPiece, ModelElement]


@dataclass(frozen=True, slots=True)
class Camera:
    """A perspective camera: its point, the direction in which it looks, and what is up in it, both of length 1."""

    point: Place
    direction: Place
    up: Place


def find_shift(pairs: Sequence[Pair]) -> Point | None:
    """Return what is to be added to positions of the workbook to have those of the model [m].

    Returns
    -------
    tuple of float, optional
        Whole metres; None where no position is known, or where those of workbook and model do not agree.
    """
    known = [(one.place, middle) for one, element in pairs if one.place and (middle := _find_middle(element))]
    if not known:
        return None
    x, y = (round(statistics.median(model[axis] - book[axis] for book, model in known)) for axis in (0, 1))
    left = statistics.median(math.dist((book[0] + x, book[1] + y), model[:2]) for book, model in known)
    return (float(x), float(y)) if left <= AGREE else None


def _find_middle(element: ModelElement) -> Place | None:
    """Return the middle of the box around an element; None where that is not known."""
    return None if element.low is None or element.high is None else find_middle((element.low, element.high))


# ---------------------------------------------------------------- doors


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
    """Return how far a door is from the line between two points in plan."""
    return min(_distance_to_line(point, start, end) for point in door.points)


def _distance_to_line(point: Point, start: Point, end: Point) -> float:
    (x, y), (x1, y1), (x2, y2) = point, start, end
    length = (x2 - x1) ** 2 + (y2 - y1) ** 2
    along = 0.0 if length == 0 else max(0.0, min(1.0, ((x - x1) * (x2 - x1) + (y - y1) * (y2 - y1)) / length))
    return math.dist(point, (x1 + along * (x2 - x1), y1 + along * (y2 - y1)))


# ---------------------------------------------------------------- the camera


def find_camera(pairs: Sequence[Pair], centre: Point) -> Camera | None:
    """Return a camera that sees some pieces from the side to which the first may fall, from above and in its room.

    Parameters
    ----------
    pairs : sequence of (ExportPiece, ModelElement)
        The pieces with their elements, the most urgent first; those of its room are looked at.
    centre : Point
        From there a piece is seen whose back is not known, nor the room that it stands in.

    Returns
    -------
    Camera, optional
        None where no place is known.
    """
    piece, first = pairs[0]
    boxes = [(one.low, one.high) for _, one in pairs if one.low is not None and one.high is not None
             and one.room == first.room]  # fmt: skip
    if not boxes:
        return None
    low, high = _join(boxes)
    if math.dist(low, high) / 2 > LARGEST:
        low, high = boxes[0]
    target = find_middle((low, high))
    middle = find_middle(first.room)[:2] if first.room else centre
    distance = max(DISTANCE, ROOM * math.dist(low, high) / 2 / math.sin(math.radians(FIELD_OF_VIEW / 2)))
    rise = max(EYE + low[2] - target[2], distance / 4)
    flat = math.sqrt(max(distance**2 - rise**2, 1.0))
    x, y = _find_side(piece, target[:2], middle)
    point = (target[0] + flat * x, target[1] + flat * y, target[2] + rise)
    return _look(point if first.room is None else _keep_inside(point, first.room), target)


def _keep_inside(point: Place, room: Box) -> Place:
    """Return the nearest point in a room that is `FROM_WALL` away from its walls and ceiling."""
    low, high = room
    x, y = (
        max(low[at] + FROM_WALL, min(high[at] - FROM_WALL, point[at]))
        if high[at] - low[at] > 2 * FROM_WALL
        else (low[at] + high[at]) / 2
        for at in (0, 1)
    )
    return x, y, max(low[2] + FROM_WALL, min(high[2] - FROM_WALL, point[2]))


def _join(boxes: Sequence[Box]) -> Box:
    """Return the box around boxes."""
    x1, y1, z1 = (min(low[axis] for low, _ in boxes) for axis in range(3))
    x2, y2, z2 = (max(high[axis] for _, high in boxes) for axis in range(3))
    return (x1, y1, z1), (x2, y2, z2)


def _find_side(piece: ExportPiece, middle: Point, centre: Point) -> Point:
    """Return the direction in plan from a piece to the camera, of length 1."""
    dx, dy = centre[0] - middle[0], centre[1] - middle[1]
    if piece.faces is None:
        length = math.hypot(dx, dy)
        return (dx / length, dy / length) if length > AGREE else (-math.sqrt(0.5), -math.sqrt(0.5))
    x, y = math.cos(math.radians(piece.faces)), math.sin(math.radians(piece.faces))
    is_turned = not piece.falls_one_way and x * dx + y * dy < 0
    return (-x, -y) if is_turned else (x, y)


def _look(point: Place, target: Place) -> Camera:
    """Return a camera at a point that looks at another one, upright."""
    length = math.dist(point, target)
    x, y, z = ((to - at) / length for to, at in zip(target, point, strict=True))
    flat = math.hypot(x, y)
    if flat < STEEPEST:
        return Camera(point, (0.0, 0.0, -1.0 if z < 0 else 1.0), (0.0, 1.0, 0.0))
    return Camera(point, (x, y, z), (-z * x / flat, -z * y / flat, flat))


def find_centre(elements: Mapping[str, ModelElement]) -> Point:
    """Return the middle of the elements whose place is known, (0, 0) where there is none."""
    middles = list(_list_middles(elements))
    if not middles:
        return 0.0, 0.0
    return statistics.fmean(x for x, _ in middles), statistics.fmean(y for _, y in middles)


def _list_middles(elements: Mapping[str, ModelElement]) -> Iterator[Point]:
    for one in elements.values():
        middle = _find_middle(one)
        if middle is not None:
            yield middle[0], middle[1]
