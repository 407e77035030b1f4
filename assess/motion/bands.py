"""Motions brought to peaks: one factor below a corner frequency and one above, found for each motion or for all."""

import math

import numpy as np

from assess.arrays import FloatArray, Single
from assess.compiled import compiled, compiled_into

ROUNDS = 12
"""Turns of finding the factor of the lower band, each followed by one on the whole motion."""
NEAR = 0.002
"""PFV is met where it is within this share [-]."""
STEEP, MOST = 1.2, 2.0
"""Power of the missing share of PFV by which the lower band is multiplied, and the largest factor of one turn [-]."""


def split_bands(motions: Single, time_step: float, corners: FloatArray) -> Single:
    """Return what motions (k, n) hold below corners (k,) [Hz], with no shift of phase; the rest is above.

    A Butterworth low-pass of order 2, forward and backward: half of the amplitude at the corner.
    """
    low = motions.copy()
    tangent = np.tan(np.pi * np.clip(corners * time_step, 1e-6, 0.45))
    scale = 1 / (1 + math.sqrt(2) * tangent + tangent**2)
    steps = np.stack([tangent**2 * scale, 2 * (tangent**2 - 1) * scale,
                      (1 - math.sqrt(2) * tangent + tangent**2) * scale], axis=1)  # fmt: skip
    _low_pass(low, steps)
    return low


def meet_peaks(motions: Single, low: Single, time_step: float, pfa: FloatArray, pfv: FloatArray) -> None:
    """Bring motions (k, n) in place to PFA [m/s2] exactly, and to PFV [m/s] (k,; NaN: free) as near as two bands can.

    `low` (k, n) is the lower band.
    """
    wanted = np.nan_to_num(np.asarray(pfv, np.float64), nan=0.0)  # compiled code knows no NaN
    _meet(motions, low, time_step, np.ascontiguousarray(pfa, np.float64), wanted)


def find_common(
    motions: Single, low: Single, time_step: float, pfa: float, pfv: float, *, each: bool
) -> tuple[float, float]:
    """Return the factors above and below the corner that bring the median peaks of motions (k, n) to PFA and PFV.

    With `each` every motion is brought to PFA itself; then the two are relative, and the first is 1.
    """
    by, extra, peaks = 1.0, 0.0, np.empty((len(motions), 2))
    for _ in range(ROUNDS):
        _measure(motions, low, extra, time_step, peaks)
        speeds = pfa / peaks[:, 0] * peaks[:, 1] if each else peaks[:, 1]
        by = 1.0 if each else float(pfa / np.median(peaks[:, 0]))
        off = pfv / (by * float(np.median(speeds)))
        if abs(off - 1) < NEAR:
            break
        extra = (1 + extra) * min(max(off, 1 / MOST), MOST) ** STEEP - 1
    return by, by * (1 + extra)


@compiled_into
def _find_peaks(row: Single, slow: Single, extra: float, time_step: float) -> tuple[float, float]:  # pragma: no cover
    """Return PFA and PFV of row + extra slow, which starts at rest."""
    strongest, fastest, speed, before = 0.0, 0.0, 0.0, 0.0
    for i in range(row.size):
        a = row[i] + extra * slow[i]
        speed += (before + a) * (time_step / 2)
        before = a
        strongest, fastest = max(strongest, abs(a)), max(fastest, abs(speed))
    return strongest, fastest


@compiled
def _measure(rows: Single, low: Single, extra: float, time_step: float, peaks: FloatArray) -> None:  # pragma: no cover
    """Fill `peaks` (k, 2) with PFA and PFV of rows + extra low, which start at rest."""
    for k in range(rows.shape[0]):
        peaks[k, 0], peaks[k, 1] = _find_peaks(rows[k], low[k], extra, time_step)


@compiled
def _low_pass(rows: Single, steps: FloatArray) -> None:  # pragma: no cover
    last = rows.shape[1] - 1
    for k in range(rows.shape[0]):
        b, a_1, a_2 = steps[k]
        row = rows[k]
        for turn in range(2):
            x_1, x_2, y_1, y_2 = 0.0, 0.0, 0.0, 0.0
            for i in range(last + 1):
                at = last - i if turn else i
                x = row[at]
                y = b * (x + 2 * x_1 + x_2) - a_1 * y_1 - a_2 * y_2
                x_2, x_1, y_2, y_1 = x_1, x, y_1, y
                row[at] = y


@compiled
def _meet(rows: Single, low: Single, time_step: float, pfa: FloatArray, pfv: FloatArray) -> None:  # pragma: no cover
    for k in range(rows.shape[0]):
        row, slow = rows[k], low[k]
        by, extra = 1.0, 0.0  # the motion is by (row + extra slow)
        for turn in range(ROUNDS):
            strongest, fastest = _find_peaks(row, slow, extra, time_step)
            by = pfa[k] / strongest if strongest > 0 else 0.0
            if pfv[k] <= 0 or turn == ROUNDS - 1 or abs(by * fastest / pfv[k] - 1) < NEAR:
                break
            off = min(max(pfv[k] / (by * fastest), 1 / MOST), MOST) ** STEEP
            extra = (1 + extra) * off - 1
        for i in range(row.size):
            row[i] = np.float32(by * (row[i] + extra * slow[i]))
