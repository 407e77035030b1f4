"""Many blocks under many motions: which of them overturn, and how far the others turn; and one under one, step by step.

Importing this imports numba: do so where blocks are to be rocked.
"""

import math
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from assess.arrays import FloatArray
from assess.motion.rows import run_rows
from assess.progress import SILENT, Progress
from assess.rocking import block, kernel
from assess.units import GRAVITY

LONGEST_STEP = 0.1
"""Largest p dt of a step [-]; a motion with longer steps is divided for that block, on the straight lines between its
samples. Furniture under a motion of 200 samples a second stays below; `docs/rocking.md` shows what is left out."""
TILE = 8_000_000
"""Samples of all pairs of block and motion that a thread integrates between two checks for a cancel: about 0.1 s."""
MOST_TRACED = 10_000_000
"""Steps or points of which the path is kept, 240 MB; the outcome is that of all."""


@dataclass(frozen=True, slots=True, eq=False)
class Rocking:
    """What m blocks did under k motions.

    * `overturned` (m, k): whether a block turned by pi/2.
    * `rotation` (m, k): largest |theta| over the critical angle [-]; (pi/2) / alpha where it overturned.
    * `fall_time` (m, k): when it had overturned, from the first sample [s]; NaN where it did not.
    * `impacts` (m, k): impacts until it was decided.
    """

    overturned: NDArray[np.bool_]
    rotation: FloatArray
    fall_time: FloatArray
    impacts: NDArray[np.int64]


def stack_bodies(
    breadth: ArrayLike, height: ArrayLike, restitution: ArrayLike, centre: ArrayLike, scale: ArrayLike
) -> FloatArray:
    """Return m bodies from (m,) or (m, k) arrays, or numbers, (m, 1 or k, 5); ValueError as of `rock_blocks`.

    Their columns: breadth and height [m], centre of gravity as a share of the height, restitution and scale [-].
    """
    given = [np.asarray(values, dtype=np.float64) for values in (breadth, height, centre, restitution, scale)]
    rows = np.broadcast_arrays(*(one[:, None] if one.ndim == 1 else one for one in np.atleast_1d(*given)))
    b, h, z, eta, factor = rows
    if not (b.ndim == 2 and all((np.isfinite(one) & (one > 0)).all() for one in (b, h))):
        raise ValueError("breadth and height must be lists of finite numbers above 0 m")
    if not ((z > 0) & (z < 1)).all():
        raise ValueError("centre must be above 0 and below 1")
    if not (np.isfinite(factor) & (factor >= 0)).all():
        raise ValueError("scale must be finite, and 0 or above")
    stout = b / h >= block.stocky_limit(z)
    if (stout & np.isnan(eta)).any():
        worst, limit = (b / h)[stout].max(), block.stocky_limit(z)[stout].min()
        raise ValueError(f"a block with B/H of {worst:.3g} does not rock: expected below {limit:.3g}")
    eta = np.where(np.isnan(eta), block.restitution(b, h, z), eta)
    if not ((eta >= 0) & (eta <= 1)).all():
        raise ValueError("restitution must be 0 to 1")
    return np.stack([b, h, z, eta, factor], axis=2)


def count_parts(bodies: FloatArray, time_step: float) -> NDArray[np.int64]:
    """Return into how many parts the steps are divided for each body (m,)."""
    p = block.frequency_parameter(bodies[..., 0], bodies[..., 1], bodies[..., 2]).max(axis=1)
    return np.asarray(np.ceil(p * time_step / LONGEST_STEP), dtype=np.int64)


def to_kernel(bodies: FloatArray, time_step: float) -> FloatArray:
    """Return bodies as the kernel takes them, (m, 1 or k, 5)."""
    *shape, eta, scale = np.moveaxis(bodies, 2, 0)
    p = block.frequency_parameter(*shape)
    columns = block.critical_angle(*shape), (p * time_step) ** 2, eta, block.threshold(*shape), scale
    return np.stack(columns, axis=2)


def rock_blocks(
    breadth: ArrayLike,
    height: ArrayLike,
    motions: NDArray[Any],
    time_step: float,
    *,
    restitution: ArrayLike = math.nan,
    centre: ArrayLike = block.MIDDLE,
    scale: ArrayLike = 1.0,
    threads: int = 1,
    progress: Progress = SILENT,
) -> Rocking:
    """Integrate every block under every motion (eq. 3 of the paper, with impacts).

    A motion is linear between its samples and followed by rest; a block that is still rocking at its end is followed
    until it can no longer fall. A block at rest starts again where the motion exceeds its threshold, g b/z.

    * `breadth`, `height` (m,) or (m, k): sizes of the blocks [m]; breadth is the side parallel to the motion. With (m,
      k) a block has other sizes under each motion. Equal blocks of (m,) are integrated once.
    * `motions` (k, n): base accelerations [m/s2].
    * `time_step`: [s].
    * `restitution` (m,) or (m, k): angular velocity after an impact over that before it [-], 0 to 1; NaN is that of
      equal angular momentum, Housner's 1 - 1.5 sin2(alpha) for a uniform block.
    * `centre` (m,) or (m, k): height of the centre of gravity as a share of the block's [-]; 0.5 for a uniform one.
    * `scale` (m,) or (m, k): factor on the motion [-].
    * `threads`: share the tiles; neither they nor the order of blocks or of motions change a result.
    * `progress`: asked before each tile whether to stop; CancelledError then.

    Raises ValueError if a size is not above 0, a block without a restitution is too stocky to rock (B/H of 1.41 or
    more, if uniform), a centre is not within the block, a restitution is outside 0 to 1, or the motions or their time
    step are not finite numbers of that shape.
    """
    bodies, motions = stack_bodies(breadth, height, restitution, centre, scale), check_motions(motions, time_step)
    which = np.arange(len(bodies))
    if bodies.shape[1] == 1:  # each of several equal bodies once
        bodies, which = np.unique(bodies, axis=0, return_inverse=True)
    elif bodies.shape[1] != len(motions):
        raise ValueError(f"blocks have {bodies.shape[1]} sizes each, expected 1 or {len(motions)}")
    outcome = np.zeros((len(bodies), len(motions), 3))
    divisions = count_parts(bodies, time_step)
    for parts in np.unique(divisions):
        own = np.flatnonzero(divisions == parts)
        found = _rock_alike(bodies[own], divide(motions, int(parts)), time_step / parts, threads, progress)
        found[..., kernel.FALL] *= np.where(found[..., kernel.FALL] < 0, 1, time_step / parts)
        outcome[own] = found
    outcome = outcome[which.ravel()]
    fell = outcome[..., kernel.FALL] >= 0
    return Rocking(
        overturned=fell,
        rotation=outcome[..., kernel.ROTATION],
        fall_time=np.where(fell, outcome[..., kernel.FALL], math.nan),
        impacts=outcome[..., kernel.STRUCK].astype(np.int64),
    )


def check_motions(motions: NDArray[Any], time_step: float) -> NDArray[Any]:
    """Return motions (k, n); ValueError as of `rock_blocks`."""
    motions = np.asarray(motions)
    if motions.ndim != 2 or not len(motions) or motions.shape[1] < 2 or not np.isfinite(motions).all():
        raise ValueError(f"motions have shape {motions.shape}, expected (k, n) finite samples with n of 2 or more")
    if not 0 < time_step < math.inf:
        raise ValueError(f"time_step is {time_step} s, expected above 0")
    return motions


def divide(motions: NDArray[Any], parts: int) -> FloatArray:
    """Return motions [g] with `parts` steps for each of theirs, followed by two zeros, as the kernel takes them."""
    count = motions.shape[1]
    at = np.arange((count - 1) * parts + 1) / parts
    padded = np.zeros((len(motions), at.size + 2))
    for row, motion in zip(padded, motions, strict=True):
        row[: at.size] = motion if parts == 1 else np.interp(at, np.arange(count), motion)
    padded /= GRAVITY
    return padded


def _rock_alike(
    bodies: FloatArray, motions: FloatArray, time_step: float, threads: int, progress: Progress
) -> FloatArray:
    """Integrate m bodies under padded motions (k, n) [g]; returns the kernel's outcome (m, k, 3)."""
    blocks = to_kernel(bodies, time_step)
    outcome = np.zeros((len(blocks), len(motions), 3))
    outcome[..., kernel.FALL] = -1.0
    # Tiles of many blocks under few motions, as their size does not change a result
    pairs = max(kernel.LANES, TILE // motions.shape[1])
    high = min(len(blocks), pairs)
    wide = max(1, pairs // high)
    tiles = [
        (blocks[start : start + high], motions, first, min(first + wide, len(motions)), outcome[start : start + high])
        for first, start in product(range(0, len(motions), wide), range(0, len(blocks), high))
    ]
    no_trace = np.zeros((0, 3))
    run_rows(lambda at: kernel.rock(*tiles[at], no_trace), len(tiles), threads, progress)
    return outcome


# ---------------------------------------------------------------- one block under one motion


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Response:
    """What one block did under one motion.

    * `critical_angle`, `frequency_parameter`, `restitution`: the block's alpha [rad], p [rad/s] and eta [-].
    * `overturned`, `rotation`, `fall_time`, `impacts`: as of `Rocking`, for one pair.
    * `times`, `theta` (t,): path of the rotation [s, rad], whose points are unevenly spaced: the ends of steps,
      impacts, and both ends of each rest. It ends where the block has overturned, at pi/2; else with the motion, or,
      where the block is still rocking then, up to a step before it is known that it can no longer fall. Peaks lie
      between points, so that the largest of `theta` may be below `rotation`.
    * `impact_times` (impacts,): [s]; an impact after which the block rests is put at the next sample.
    """

    critical_angle: float
    frequency_parameter: float
    restitution: float
    overturned: bool
    rotation: float
    fall_time: float
    impacts: int
    times: FloatArray
    theta: FloatArray
    impact_times: FloatArray


def follow_block(
    breadth: float,
    height: float,
    acceleration: FloatArray,
    time_step: float,
    *,
    restitution: float = math.nan,
    centre: float = block.MIDDLE,
) -> Response:
    """Integrate one block under one motion, as `rock_blocks` does, and keep its path.

    Parameters and errors are those of `rock_blocks`, for one pair: sizes [m], `acceleration` (n,) [m/s2] every
    `time_step` [s], restitution [-] and height of the centre of gravity as a share of the block's [-].
    """
    body = stack_bodies(breadth, height, restitution, centre, 1.0)
    motions = check_motions(np.asarray(acceleration)[np.newaxis], time_step)
    parts = int(count_parts(body, time_step)[0])
    motions, step = divide(motions, parts), time_step / parts
    blocks, outcome = to_kernel(body, step), np.array([[[0.0, -1.0, 0.0]]])
    # The first pass counts the steps, the second keeps them, but for the last: together they take milliseconds.
    taken = kernel.rock(blocks, motions, 0, 1, outcome, np.zeros((0, 3))) // kernel.LANES
    trace = np.zeros((min(max(taken - 1, 0), MOST_TRACED), 3))
    kernel.rock(blocks, motions, 0, 1, outcome, trace)
    rotation, fall, struck = (float(value) for value in outcome[0, 0])
    path = _build_path(motions[0], blocks[0, 0, 3], trace, taken - 1 <= MOST_TRACED, fall, int(struck))
    times, theta, impact_times = path
    return Response(
        critical_angle=float(blocks[0, 0, 0]),
        frequency_parameter=float(block.frequency_parameter(breadth, height, centre)),
        restitution=float(body[0, 0, 3]), overturned=fall >= 0, rotation=rotation,
        fall_time=fall * step if fall >= 0 else math.nan, impacts=int(struck), times=times * step, theta=theta,
        impact_times=impact_times * step,
    )  # fmt: skip


def _build_path(
    motion: FloatArray, threshold: float, trace: FloatArray, is_whole: bool, fall: float, struck: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return times, theta and times of impacts [samples] of a trace, with zeros from rest to rest.

    What the last step brought, the fall, or the impact after which the block rests, is not in the trace, and is added
    where that `is_whole`. From the end of the motion on, one sample after its last, the last step shows that the block
    can no longer fall, and the path ends before it.
    """
    own, last = motion[:-2], motion.size - 3.0
    at = int((np.abs(own) > threshold).argmax())
    if abs(own[at]) <= threshold:  # it never starts
        return np.array([0.0, last]), np.zeros(2), np.zeros(0)
    before = own[at - 1]
    start = 0.0 if at == 0 else float(at - 1 + (math.copysign(threshold, own[at]) - before) / (own[at] - before))
    times, theta = np.append(start, trace[:, 0]), np.append(0.0, trace[:, 1])
    ends = np.floor(times) + 1  # of the steps from each point; where the next is later, the block has been at rest
    impact_times = np.minimum(times[1:], ends[:-1])[np.diff(trace[:, 2], prepend=0.0) > 0]
    rests = np.flatnonzero(times[1:] > ends[:-1])
    times, theta = np.insert(times, rests + 1, ends[rests]), np.insert(theta, rests + 1, 0.0)
    rest = np.zeros(1 if start > 0 else 0)
    times, theta = np.append(rest, times), np.append(rest, theta)
    if not is_whole:
        return times, theta, impact_times
    if fall >= 0:
        return np.append(times, fall), np.append(theta, math.copysign(math.pi / 2, theta[-1])), impact_times
    end = math.floor(times[-1]) + 1.0
    strikes = struck > impact_times.size
    added = ([end] if strikes or end <= last else []) + ([last] if end < last else [])
    impact_times = np.append(impact_times, end) if strikes else impact_times
    return np.append(times, added), np.append(theta, np.zeros(len(added))), impact_times
