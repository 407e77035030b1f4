"""Many blocks under many motions: which of them overturn, and how far the others turn.

Importing this imports numba: do so where blocks are to be rocked.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike, NDArray

from assess.motion.record import FloatArray
from assess.motion.rows import run_rows
from assess.progress import SILENT, Progress
from assess.rocking import block, kernel
from assess.units import GRAVITY

LONGEST_STEP = 0.1
"""Largest p dt of a step [-]; a motion with longer steps is divided for that block, on the straight lines between its
samples. Furniture under a motion of 200 samples a second stays below; `docs/rocking.md` shows what is left out."""
TILE = 8_000_000
"""Samples of all pairs of block and motion that a thread integrates between two checks for a cancel: about 0.1 s."""


@dataclass(frozen=True, slots=True, eq=False)
class Rocking:
    """What m blocks did under k motions.

    Parameters
    ----------
    overturned : (m, k) boolean array
        Whether a block turned by pi/2.
    rotation : (m, k) array
        Largest |theta| over the critical angle [-]; (pi/2) / alpha where it overturned.
    fall_time : (m, k) array
        When it had overturned, from the first sample [s]; NaN where it did not.
    impacts : (m, k) integer array
        Impacts until it was decided.
    """

    overturned: NDArray[np.bool_]
    rotation: FloatArray
    fall_time: FloatArray
    impacts: NDArray[np.int64]


def rock_blocks(
    breadth: ArrayLike,
    height: ArrayLike,
    motions: FloatArray,
    time_step: float,
    *,
    restitution: ArrayLike = math.nan,
    threads: int = 1,
    progress: Progress = SILENT,
) -> Rocking:
    """Integrate every block under every motion (eq. 3 of the paper, with impacts).

    A motion is linear between its samples and followed by rest; a block that is still rocking at its end is followed
    until it can no longer fall. A block at rest starts again where the motion exceeds its threshold g B/H.

    Parameters
    ----------
    breadth, height : (m,) arrays
        Sizes of the blocks [m]; breadth is the side parallel to the motion. Equal blocks are integrated once.
    motions : (k, n) array
        Base accelerations [m/s2].
    time_step : float
        [s]
    restitution : (m,) array or float
        Angular velocity after an impact over that before it [-], 0 to 1; NaN is Housner's 1 - 1.5 sin2(alpha).
    threads : int
        Tiles are shared out among as many; they do not change a result, nor do the order of blocks or of motions.
    progress : Progress
        Asked before each tile whether to stop.

    Raises
    ------
    CancelledError
        If the caller stops the work.
    ValueError
        If a size is not above 0, a block is too stocky to rock (B/H of 1.41 or more), a restitution is outside 0 to 1,
        or the motions or their time step are not finite numbers of that shape.
    """
    b, h, eta = check_blocks(breadth, height, restitution)
    motions = check_motions(motions, time_step)
    sizes, which = np.unique(np.stack([b, h, eta]), axis=1, return_inverse=True)
    outcome = np.zeros((sizes.shape[1], len(motions), 3))
    outcome[..., kernel.FALL] = -1.0
    divisions = count_parts(sizes, time_step)
    for parts in np.unique(divisions):
        own = np.flatnonzero(divisions == parts)
        found = _rock_alike(sizes[:, own], divide(motions, int(parts)), time_step / parts, threads, progress)
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


def check_blocks(breadth: ArrayLike, height: ArrayLike, restitution: ArrayLike) -> tuple[FloatArray, ...]:
    """Return breadth, height [m] and restitution of blocks as (m,) arrays; ValueError as of `rock_blocks`."""
    given = np.broadcast_arrays(*np.atleast_1d(breadth, height, restitution))
    b, h, eta = (np.array(values, dtype=np.float64) for values in given)
    if not (b.ndim == 1 and np.isfinite(b).all() and np.isfinite(h).all() and (b > 0).all() and (h > 0).all()):
        raise ValueError("breadth and height must be lists of finite numbers above 0 m")
    if (b / h >= block.STOCKY).any():
        raise ValueError(f"a block with B/H of {(b / h).max():.3g} does not rock: expected below {block.STOCKY}")
    eta = np.where(np.isnan(eta), block.restitution(b, h), eta)
    if not ((eta >= 0) & (eta <= 1)).all():
        raise ValueError("restitution must be 0 to 1")
    return b, h, eta


def check_motions(motions: FloatArray, time_step: float) -> FloatArray:
    """Return motions (k, n); ValueError as of `rock_blocks`."""
    motions = np.asarray(motions, dtype=np.float64)
    if motions.ndim != 2 or not len(motions) or motions.shape[1] < 2 or not np.isfinite(motions).all():
        raise ValueError(f"motions have shape {motions.shape}, expected (k, n) finite samples with n of 2 or more")
    if not 0 < time_step < math.inf:
        raise ValueError(f"time_step is {time_step} s, expected above 0")
    return motions


def count_parts(sizes: FloatArray, time_step: float) -> NDArray[np.int64]:
    """Return into how many parts the steps are divided for each block of `sizes` (3, m)."""
    p = block.frequency_parameter(sizes[0], sizes[1])
    return np.ceil(p * time_step / LONGEST_STEP).astype(np.int64)


def divide(motions: FloatArray, parts: int) -> FloatArray:
    """Return motions [g] with `parts` steps for each of theirs, followed by two zeros, as the kernel takes them."""
    count = motions.shape[1]
    at = np.arange((count - 1) * parts + 1) / parts
    padded = np.zeros((len(motions), at.size + 2))
    for row, motion in zip(padded, motions, strict=True):
        row[: at.size] = motion if parts == 1 else np.interp(at, np.arange(count), motion)
    padded /= GRAVITY
    return padded


def build_blocks(sizes: FloatArray, time_step: float) -> FloatArray:
    """Return blocks of `sizes` (3, m) as the kernel takes them, (m, 4)."""
    b, h, eta = sizes
    p = block.frequency_parameter(b, h)
    return np.stack([block.critical_angle(b, h), (p * time_step) ** 2, eta, b / h], axis=1)


def _rock_alike(
    sizes: FloatArray, motions: FloatArray, time_step: float, threads: int, progress: Progress
) -> FloatArray:
    """Integrate blocks of `sizes` (3, m) under padded motions (k, n) [g]; returns the kernel's outcome (m, k, 3)."""
    blocks = build_blocks(sizes, time_step)
    outcome = np.zeros((len(blocks), len(motions), 3))
    outcome[..., kernel.FALL] = -1.0
    no_trace, tiles = np.zeros((0, 3)), list(_tiles(len(blocks), *motions.shape))

    def run(number: int) -> None:
        own, rows = tiles[number]
        kernel.rock(blocks[own], motions, rows.start, rows.stop, outcome[own], no_trace)

    run_rows(run, len(tiles), threads, progress)
    return outcome


def _tiles(blocks: int, motions: int, samples: int) -> Iterator[tuple[slice, range]]:
    """Cut blocks x motions into tiles: many blocks under few motions, as the size does not change a result."""
    pairs = max(kernel.LANES, TILE // samples)
    high = min(blocks, pairs)
    wide = max(1, pairs // high)
    for first, start in product(range(0, motions, wide), range(0, blocks, high)):
        yield slice(start, min(start + high, blocks)), range(first, min(first + wide, motions))
