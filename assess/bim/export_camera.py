"""Where the elements of an export are, which door a piece obstructs, and from where a topic looks at both.

Positions of the workbook are those of the model but for a shift of whole metres, which is found from the pieces that
have both. A topic has all of its pieces and doors within the picture, if it can be.

The camera stands in the room of the first piece; where not all is in view from there, it steps back through a wall.
BCF 2.1 allows no wider field of view than 60 degrees. A viewer fits it to a picture of its own: here it is taken as the
broader side of 4:3, so that as much is in view where a viewer takes it as the height. Lengths are in metres, in the
axes of the model.
"""

import itertools
import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from assess.bim.export_model import Box, ModelDoor, ModelElement, Place, find_middle
from assess.bim.export_results import ExportPiece, ExportSegment, Point
from assess.bim.plan_shapes import FloatArray, direction_of

FIELD_OF_VIEW = 60.0
"""Horizontal [deg]; BCF 2.1 allows 45 to 60."""
PICTURE = 4 / 3
"""Width over height of the picture."""
USED = 0.95
"""Part of the picture that may be used: a rim stays free."""
DISTANCE, EYE, LOWER = 3.0, 2.2, 1.5
"""Distance of the camera from a piece, and its height above the piece's base: under the usual ceilings [m].

`LOWER` is tried where not all is in view from `EYE`.
"""
FROM_WALL, NEAREST = 0.3, 0.2
"""Least distance of the camera from walls and ceiling, and from what it looks at, along its direction [m]."""
LARGEST = 20.0
"""Extent of pieces and doors that are looked at together; beyond it, doors may be left out of the picture [m]."""
GRID, RAYS, RINGS = 9, 16, (0.6, 0.8, 1.0, 1.5, 2.0)
"""Where in a room a camera is tried: places along each side, directions around the pieces, parts of the distance."""
TURNS = tuple(math.radians(sign * turn) for turn in (0, 22.5, 45, 67.5) for sign in (1, -1))
"""Directions in which the camera steps back, from that to which the first piece may fall."""
FARTHER, STEPS = 1.1, 100
"""Factor by which the camera steps back, and how often at most."""
ROUNDS = 6
"""How often the direction of a camera is turned to the middle of what it sees."""
STEEPEST = 1e-3
"""Sine of the angle between the camera's direction and the vertical below which it looks straight down."""
NO_SIDE = 0.5
"""Distance from the middle of the room up to which a piece whose back is not known is seen from anywhere [m]."""
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
    known = [(one.place, find_middle(element.box)) for one, element in pairs if one.place and element.box]
    if not known:
        return None
    x, y = (round(statistics.median(model[axis] - book[axis] for book, model in known)) for axis in (0, 1))
    left = statistics.median(math.dist((book[0] + x, book[1] + y), model[:2]) for book, model in known)
    return (float(x), float(y)) if left <= AGREE else None


def find_doors(
    pairs: Sequence[Pair], segments: Sequence[ExportSegment], doors: Sequence[ModelDoor], shift: Point | None
) -> list[ModelDoor]:
    """Return the doors of the segments that some pieces may block: of each piece the nearest, without repetition.

    Doors at an end of such a segment come before those that it passes.
    """
    found: dict[str, ModelDoor] = {}
    for piece, element in pairs:
        if shift is None or element.box is None:
            continue
        lines = [
            shapely.LineString([(x + shift[0], y + shift[1]) for x, y in one.ends])
            for one in segments
            if one.ends and piece.item in one.items
        ]
        ends = [shapely.Point(end) for line in lines for end in line.coords]
        here, bottom = shapely.Point(find_middle(element.box)[:2]), element.box[0][2]
        storey = [(one, shapely.MultiPoint(one.points)) for one in doors if abs(one.bottom - bottom) <= SAME_STOREY]
        at_end = [one for one in storey if any(one[1].distance(end) <= NEAR_DOOR for end in ends)]
        near = at_end or [one for one in storey if any(one[1].distance(line) <= NEAR_DOOR for line in lines)]
        if near:
            door, _points = min(near, key=lambda one: (one[1].distance(here), one[0].key))
            found[door.key] = door
    return list(found.values())


@dataclass(frozen=True, slots=True)
class Camera:
    """A perspective camera: its point, the direction in which it looks, and what is up in it, both of length 1."""

    point: Place
    direction: Place
    up: Place


def find_camera(pairs: Sequence[Pair], doors: Sequence[ModelDoor], centre: Point) -> Camera | None:
    """Return a camera that sees all of some pieces, the most urgent first, from the side to which that may fall.

    None where no place is known. Doors are seen as well, if they are not too far away. From `centre` a piece is seen
    whose back is not known, nor the room that it stands in.
    """
    placed = [(piece, one, one.box) for piece, one in pairs if one.box is not None]
    if not placed:
        return None
    piece, first, _ = placed[0]
    boxes = [box for _piece, _one, box in placed]
    middle = find_middle(first.room)[:2] if first.room else centre
    side = _find_side(piece, find_middle(_join(boxes))[:2], middle)
    with_doors = [*boxes, *(one.box for one in doors if one.box is not None)]
    for seen in (with_doors, boxes):
        is_close = seen is boxes or math.dist(*_join(seen)) <= LARGEST
        found = _stand_inside(seen, side, first.room) or (_step_back(seen, side, first.room) if is_close else None)
        if found is not None:
            return found
    return None


def _find_side(piece: ExportPiece, middle: Point, centre: Point) -> Point:
    """Return the direction in plan from a piece to the camera, of length 1."""
    dx, dy = centre[0] - middle[0], centre[1] - middle[1]
    if piece.faces is None:
        length = math.hypot(dx, dy)
        return (dx / length, dy / length) if length > NO_SIDE else (-math.sqrt(0.5), -math.sqrt(0.5))
    x, y = direction_of(piece.faces)
    is_turned = not piece.falls_one_way and x * dx + y * dy < 0
    return (-x, -y) if is_turned else (x, y)


def _join(boxes: Sequence[Box]) -> Box:
    x1, y1, z1 = (min(low[axis] for low, _ in boxes) for axis in range(3))
    x2, y2, z2 = (max(high[axis] for _, high in boxes) for axis in range(3))
    return (x1, y1, z1), (x2, y2, z2)


def _stand_inside(boxes: Sequence[Box], side: Point, room: Box | None) -> Camera | None:
    """Return the camera in a room that is nearest to the usual distance, None where not all is in view from there."""
    if room is None:
        return None
    low, high = _join(boxes)
    target = np.array(find_middle((low, high)))
    start = np.array([target[0] + DISTANCE * side[0], target[1] + DISTANCE * side[1], low[2] + EYE])
    turns = np.arange(RAYS) * 2 * math.pi / RAYS
    rays = np.stack([np.cos(turns), np.sin(turns), np.zeros(RAYS)], axis=1)
    around = [target + DISTANCE * part * rays for part in RINGS]
    least, most = (np.array(corner) + sign * FROM_WALL for corner, sign in zip(room, (1, -1), strict=True))
    sides = (np.linspace(least[axis], most[axis], GRID) for axis in (0, 1))
    grid = np.array([(x, y, 0.0) for x, y in itertools.product(*sides)])
    plan = np.concatenate([start[None], *around, grid])
    for height in (EYE, LOWER):
        points = np.column_stack([plan[:, :2], np.full(len(plan), low[2] + height)])
        within = np.minimum(np.maximum(points, least), np.maximum(most, least))
        order = np.argsort(np.linalg.norm(within - start, axis=1), kind="stable")
        found = _take_first(within[order], boxes)
        if found is not None:
            return found
    return None


def _step_back(boxes: Sequence[Box], side: Point, room: Box | None) -> Camera | None:
    """Return the nearest camera that has all in view, on the side to which the first piece may fall."""
    low, high = _join(boxes)
    target = np.array(find_middle((low, high)))
    own = math.atan2(side[1], side[0])
    rays = np.array([(math.cos(own + turn), math.sin(own + turn), 0.0) for turn in TURNS])
    distances = DISTANCE * FARTHER ** np.arange(STEPS)
    points = (target + distances[:, None, None] * rays).reshape(-1, 3)
    flat = np.repeat(distances, len(rays))
    points[:, 2] = low[2] + EYE if room else np.maximum(low[2] + EYE, target[2] + flat / 4)
    if room:
        points[:, 2] = np.minimum(points[:, 2], room[1][2] - FROM_WALL)
    return _take_first(points, boxes)


def _take_first(points: FloatArray, boxes: Sequence[Box]) -> Camera | None:
    corners = np.unique([corner for low, high in boxes for corner in itertools.product(*zip(low, high, strict=True))],
                        axis=0)  # fmt: skip
    for part in np.array_split(points, max(1, len(points) // 32)):
        forward, fits = _aim(part, corners)
        if fits.any():
            at = int(np.argmax(fits))
            return Camera(_to_place(part[at]), _to_place(forward[at]), _to_place(_find_axes(forward)[1][at]))
    return None


def _to_place(values: FloatArray) -> Place:
    x, y, z = values.tolist()
    return x, y, z


def _aim(points: FloatArray, corners: FloatArray) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Return the directions, of shape (n, 3), in which corners are in the middle of the picture, and if all are in."""
    ways = corners[None] - points[:, None]
    forward = _scale((ways / np.maximum(np.linalg.norm(ways, axis=2, keepdims=True), NEAREST)).mean(axis=1))
    for _ in range(ROUNDS):
        right, up = _find_axes(forward)
        _depth, across, upward = _project(ways, forward)
        x, y = ((one.min(axis=1) + one.max(axis=1))[:, None] / 2 for one in (across, upward))
        forward = _scale(forward + x * right + y * up)
    depth, across, upward = _project(ways, forward)
    most = USED * math.tan(math.radians(FIELD_OF_VIEW / 2))
    in_view: NDArray[np.bool_] = (depth >= NEAREST) & (np.abs(across) <= most) & (np.abs(upward) <= most / PICTURE)
    return forward, np.all(in_view, axis=1)


def _scale(vectors: FloatArray) -> FloatArray:
    lengths: FloatArray = np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), STEEPEST)
    return vectors / lengths


def _find_axes(forward: FloatArray) -> tuple[FloatArray, FloatArray]:
    x, y, _z = forward.T
    flat = np.hypot(x, y)
    right = np.stack([y, -x, np.zeros_like(x)], axis=1) / np.maximum(flat, STEEPEST)[:, None]
    right[flat < STEEPEST] = (1.0, 0.0, 0.0)
    return right, np.cross(right, forward)


def _project(ways: FloatArray, forward: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    depth, *off = (np.einsum("cna,ca->cn", ways, axis) for axis in (forward, *_find_axes(forward)))
    least = np.maximum(depth, NEAREST / 2)
    return depth, off[0] / least, off[1] / least
