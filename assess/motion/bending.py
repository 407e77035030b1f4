"""Peaks under control: bent by one smooth rule, so that their mean over an ensemble is what it should be.

Bending leaves small values alone and acts on the few samples about a peak; it is the same for all realisations, so that
their peaks go on to scatter. After each step a constant is taken off that leaves no final velocity.
"""

import math
from dataclasses import dataclass

import numpy as np

from assess.compiled import compiled
from assess.motion.record import FloatArray
from assess.motion.rows import run_rows
from assess.motion.target import Grid
from assess.progress import SILENT, Progress

BENT = 2.0
"""Share of the logarithm of a missing peak that is bent in one round [-]; a peak changes by half of its bending."""
TAPER = 1.0
"""Time over which velocity grows from zero and fades to it [s]."""

MOST_BENT, MOST_SHARPENED = -0.5, 1.5
"""Limits of the bending [-]; from -0.6 on, larger peaks would come out smaller than lesser ones."""
PFA_FREE, PFV_FREE_ABOVE, PFV_FREE_BELOW = 0.01, 0.05, 0.10
"""What mean peaks may differ before they are bent, in logarithms [-]. Sharpening PFV adds scatter: less is asked."""


@dataclass(frozen=True, slots=True)
class Bend:
    """How peaks of velocity and acceleration are bent [-]: x becomes x (1 + b q/(1 + q)), with q = (x/PFV or PFA)^4."""

    velocity: float = 0.0
    acceleration: float = 0.0

    def turned(self, pfv_error: float, pfa_error: float) -> "Bend":
        """Return it turned towards what is missing of the mean peaks, as logarithms [-]."""
        by_velocity = BENT * _beyond(pfv_error, PFV_FREE_BELOW if pfv_error > 0 else PFV_FREE_ABOVE)
        by_acceleration = BENT * _beyond(pfa_error, PFA_FREE)
        return Bend(_limited(self.velocity + by_velocity), _limited(self.acceleration + by_acceleration))


def _beyond(error: float, free: float) -> float:
    return math.copysign(max(0.0, abs(error) - free), error)


def _limited(bend: float) -> float:
    return min(max(bend, MOST_BENT), MOST_SHARPENED)


def build_taper(grid: Grid) -> tuple[FloatArray, FloatArray]:
    """Return the taper of velocity (n,) [-] and its slope [1/s]."""
    part = np.clip(np.arange(grid.count) * grid.time_step / TAPER, 0.0, 1.0)
    rise, steep = part * part * (3 - 2 * part), 6 * part * (1 - part) / TAPER
    return rise * rise[::-1], steep * rise[::-1] - rise * steep[::-1]


@compiled
def bend_row(
    acceleration: FloatArray,
    velocity: FloatArray,
    taper: FloatArray,
    slope: FloatArray,
    time_step: float,
    pfa: float,
    pfv: float,
    by_pfa: float,
    by_pfv: float,
    motion: FloatArray,
    peaks: FloatArray,
) -> None:  # pragma: no cover
    """Fill `motion` (n,): velocity bent and tapered, its slope bent, less the constant that brings it to rest."""
    count, area = motion.size, 0.0
    for i in range(count):
        x = (velocity[i] / pfv) ** 4
        bent = velocity[i] * (1 + by_pfv * x / (1 + x))
        rate = 1 + by_pfv * x / (1 + x) * (1 + 4 / (1 + x))
        value = taper[i] * rate * acceleration[i] + slope[i] * bent
        y = (value / pfa) ** 4
        motion[i] = value * (1 + by_pfa * y / (1 + y))
        area += motion[i]
    settle(motion, area)
    peaks[:] = 0.0
    speed = 0.0
    for i in range(count):
        if i:
            speed += (motion[i - 1] + motion[i]) * time_step / 2
        peaks[0], peaks[1] = max(peaks[0], abs(motion[i])), max(peaks[1], abs(speed))


def lift_peaks(motions: FloatArray, factors: FloatArray, threads: int, progress: Progress = SILENT) -> None:
    """Multiply the PFA of each motion by its factor, in place; less of it, the smaller the acceleration is."""
    run_rows(lambda row: _lift_row(motions[row], factors[row]), len(motions), threads, progress)


@compiled
def _lift_row(motion: FloatArray, factor: float) -> None:  # pragma: no cover
    pfa, area = 0.0, 0.0
    for i in range(motion.size):
        pfa = max(pfa, abs(motion[i]))
    for i in range(motion.size):
        motion[i] *= 1 + (factor - 1) * (motion[i] / pfa) ** 4
        area += motion[i]
    settle(motion, area)


@compiled
def settle(motion: FloatArray, area: float) -> None:  # pragma: no cover
    """Take off the constant that leaves a final velocity; `area` is the sum of the samples."""
    count = motion.size
    offset = (area - (motion[0] + motion[count - 1]) / 2) / (count - 1)
    for i in range(count):
        motion[i] -= offset
