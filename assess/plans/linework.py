"""Lines of a drawing as points: normalised to its width, cut at a frame, thinned, packed and unpacked."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from assess.pictures import PictureError

FloatArray = NDArray[np.float64]
Line = Sequence[tuple[float, float]] | FloatArray
Box = tuple[float, float, float, float]  # left, low, right and high end

MOST_ELEMENTS = 100_000  # elements of a drawing that are looked at
MOST_RAW = 400_000  # points of its lines as they are read
MOST_POINTS = 60_000  # points that are kept: about 700 kB in a report
FINEST = 1 / 4000  # share of a drawing's width below which two points of a line are the same
NARROWEST, MOST_ASPECT = 1e-6, 1e3
"""Least width and height of a drawing in its own units, and the largest ratio of them [-]."""
FARTHEST = 1e9  # largest coordinate of a drawing, in its own units


def too_many() -> PictureError:
    """Build the error for a drawing that has too much in it."""
    return PictureError.about(
        "it has more than {elements:,} elements or {points:,} points. Save the walls and doors alone",
        elements=MOST_ELEMENTS, points=MOST_POINTS,
    )  # fmt: skip


def empty() -> PictureError:
    """Build the error for a drawing without lines."""
    return PictureError.about("it holds no lines that can be drawn. Save it as PNG")


def find_box(lines: Sequence[Line]) -> Box:
    """Return the box round all lines; raises PictureError if there are none, or they have no width and height."""
    if not lines:
        raise empty()
    points = np.concatenate([np.asarray(line, dtype=np.float64).reshape(-1, 2) for line in lines])
    (left, low), (right, high) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    if not (right > left and high > low):
        raise empty()
    return left, low, right, high


def pack(lines: Sequence[Line], box: Box, *, is_down: bool) -> tuple[bytes, float]:
    """Return lines as bytes, and the aspect (height over width) of `box`, at which they are cut; PictureError if
    nothing is left, or too much. All are in the drawing's units; `is_down`: Y points downwards.
    """
    left, low, right, high = box
    wide, tall = right - left, high - low
    if not min(wide, tall) >= max(NARROWEST, wide / MOST_ASPECT, tall / MOST_ASPECT):
        raise empty()
    aspect = tall / wide
    kept: list[FloatArray] = []
    for line in lines:
        points = (np.asarray(line, dtype=np.float64).reshape(-1, 2) - (left, low)) / wide
        if is_down:
            points[:, 1] = aspect - points[:, 1]
        kept += clip(thin(points), (0.0, 0.0, 1.0, aspect))
    if not kept:
        raise empty()
    if sum(map(len, kept)) > MOST_POINTS:
        raise too_many()
    broken = np.full((1, 2), np.nan)
    joined = np.concatenate([part for points in kept for part in (points, broken)])
    return joined.astype("<f4").tobytes(), aspect


def unpack(content: bytes) -> list[FloatArray]:
    """Return the lines (n, 2) that `pack` kept, in shares of the drawing's width, Y upwards from its lower left."""
    points = np.frombuffer(content, dtype="<f4").astype(np.float64).reshape(-1, 2)
    ends = np.flatnonzero(np.isnan(points[:, 0]))
    return [part[~np.isnan(part[:, 0])] for part in np.split(points, ends) if len(part) > 1]


def thin(points: FloatArray) -> FloatArray:
    """Return a line without points that lie next to the one kept before them; its ends stay."""
    if len(points) < 3:
        return points
    keep = [0]
    for at in range(1, len(points) - 1):
        if np.abs(points[at] - points[keep[-1]]).max() >= FINEST:
            keep.append(at)
    return points[[*keep, len(points) - 1]]


def clip(points: FloatArray, box: Box) -> list[FloatArray]:
    """Return the parts of a line (n, 2) inside a box (Liang and Barsky 1984)."""
    low, high = np.array(box[:2]), np.array(box[2:])
    if len(points) > 1 and (points >= low).all() and (points <= high).all():
        return [points]
    start, way = points[:-1], np.diff(points, axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (low - start) / way, (high - start) / way
    is_still, is_in = way == 0, (start >= low) & (start <= high)
    enter = np.where(is_still, np.where(is_in, -np.inf, np.inf), np.minimum(one, other)).max(axis=1).clip(0, None)
    leave = np.where(is_still, np.where(is_in, np.inf, -np.inf), np.maximum(one, other)).min(axis=1).clip(None, 1)
    found: list[list[FloatArray]] = []
    for at in np.flatnonzero(enter < leave).tolist():
        begin = points[at] if enter[at] == 0 else start[at] + enter[at] * way[at]
        end = points[at + 1] if leave[at] == 1 else start[at] + leave[at] * way[at]
        if found and np.array_equal(found[-1][-1], begin):
            found[-1].append(end)
        else:
            found.append([begin, end])
    return [np.array(part) for part in found]


def describe_left_out(counts: Mapping[str, int]) -> tuple[str, ...]:
    """Return what is not drawn, the commonest first: numbers with the file's own names, ``12 TEXT``."""
    ordered = sorted(counts.items(), key=lambda one: (-one[1], one[0]))
    return tuple(f"{n} {kind[:40]}" for kind, n in ordered[:6])
