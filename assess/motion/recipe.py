"""What turns the noise of a realisation into its motion: the same steps with the same numbers for all of them.

Peaks are bent by one smooth rule, so that their mean over an ensemble is what it should be. Bending leaves small values
alone and acts on the few samples about a peak; it is the same for all realisations, so that their peaks go on to
scatter: x becomes x (1 + b q/(1 + q)), with q = (x/P)^4 and P the peak that is wanted.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from assess.arrays import FloatArray, Single
from assess.compiled import compiled
from assess.motion.noise import Transforms, find_rates
from assess.motion.target import Grid, Target
from assess.motion.wavelets import Correction
from assess.progress import Progress

TAPER = 1.0
"""Time over which velocity grows from zero and fades to it [s]."""
MOST_BENT = -0.5
"""Limit of the bending [-]; from -0.6 on, larger peaks would come out smaller than lesser ones."""


def bend_to(peaks: FloatArray, wanted: float, most: float, low: float = 1.0, high: float = 1.0) -> float:
    """Return the bending b [-] that brings the mean of `peaks` (k,) between two shares of `wanted`; at most `most`.

    A mean that lies there already is left.
    """
    q = (peaks / wanted) ** 4
    missing = wanted * np.clip(peaks.mean() / wanted, low, high) - peaks.mean()
    return float(np.clip(missing / (peaks * q / (1 + q)).mean(), MOST_BENT, most))


@lru_cache(maxsize=4)
def build_taper(grid: Grid) -> tuple[Single, Single]:
    """Return the taper of velocity (n,) [-] and its slope [1/s]."""
    part = np.clip(np.arange(grid.count) * grid.time_step / TAPER, 0.0, 1.0)
    rise, steep = part * part * (3 - 2 * part), 6 * part * (1 - part) / TAPER
    taper, slope = rise * rise[::-1], steep * rise[::-1] - rise * steep[::-1]
    return taper.astype(np.float32), slope.astype(np.float32)


@compiled
def shape_rows(
    acceleration: Single,
    taper: Single,
    slope: Single,
    time_step: float,
    pfv: float,
    by_pfv: float,
    motions: Single,
    peaks: FloatArray,
) -> None:  # pragma: no cover
    """Fill `motions` (k, n) with the slopes of velocities that are bent and tapered.

    `acceleration` (k, f) holds the samples and what follows them until velocity has died away, by which it is made to
    have no mean. `peaks` (k, 2) take PFV before it is bent, and PFA after.
    """
    count, length = taper.size, acceleration.shape[1]
    one, four, inverse, bend = np.float32(1), np.float32(4), np.float32(1 / pfv), np.float32(by_pfv)
    velocity = np.empty(length, np.float32)
    for k in range(acceleration.shape[0]):
        row, out = acceleration[k], motions[k]
        total, speed = 0.0, 0.0
        for i in range(length):
            half = row[i] * (time_step / 2)
            velocity[i] = speed + half
            total += speed
            speed += 2 * half
        mean, pfa, fastest = np.float32(total / length), np.float32(0), np.float32(0)
        for i in range(count):
            v = velocity[i] - mean
            x = (v * inverse) * (v * inverse)
            y = one / (one + x * x)
            z = bend * (one - y)
            out[i] = taper[i] * (one + z * (one + four * y)) * row[i] + slope[i] * v * (one + z)
        for i in range(count):  # a loop of their own: with peaks in it, the one above has no vector lanes
            fastest = max(fastest, abs(taper[i] * (velocity[i] - mean)))
            pfa = max(pfa, abs(out[i]))
        peaks[k, 0], peaks[k, 1] = fastest, pfa


@compiled
def bend_rows(motions: Single, pfa: float, by_pfa: float) -> None:  # pragma: no cover
    """Bend the accelerations of motions (k, n) in place."""
    one, inverse, bend = np.float32(1), np.float32(1 / pfa), np.float32(by_pfa)
    for k in range(motions.shape[0]):
        row = motions[k]
        for i in range(row.size):
            x = (row[i] * inverse) * (row[i] * inverse)
            row[i] *= one + bend * (one - one / (one + x * x))


@compiled
def lift_rows(motions: Single, factor: float) -> None:  # pragma: no cover
    """Multiply PFA by `factor`, less of it the smaller the acceleration is; leave no velocity."""
    one, by = np.float32(1), np.float32(factor - 1)
    for k in range(motions.shape[0]):
        row, pfa, area = motions[k], np.float32(0), 0.0
        for i in range(row.size):
            pfa = max(pfa, abs(row[i]))
        inverse = one / pfa if pfa > 0 else one
        for i in range(row.size):
            x = (row[i] * inverse) * (row[i] * inverse)
            row[i] *= one + by * x * x
            area += row[i]
        offset = np.float32((area - (row[0] + row[row.size - 1]) / 2) / (row.size - 1))
        for i in range(row.size):
            row[i] -= offset


@compiled
def measure_rows(motions: Single, time_step: float, peaks: FloatArray) -> None:  # pragma: no cover
    """Fill `peaks` (k, 3) with PFA [m/s2], PFV and the final velocity [m/s] of motions (k, n) that start at rest."""
    for k in range(motions.shape[0]):
        row, pfa, pfv, speed = motions[k], abs(motions[k, 0]), 0.0, 0.0
        for i in range(1, row.size):
            speed += (row[i - 1] + row[i]) * (time_step / 2)
            pfa, pfv = max(pfa, abs(row[i])), max(pfv, abs(speed))
        peaks[k, 0], peaks[k, 1], peaks[k, 2] = pfa, pfv, speed


@dataclass(frozen=True, slots=True)
class Bending:
    """Accelerations bent by `by_pfa` [-] about a PFA [m/s2]."""

    pfa: float
    by_pfa: float

    def apply(self, motions: Single) -> None:
        """Bend the peaks of motions (k, n), in place."""
        bend_rows(motions, self.pfa, self.by_pfa)


@dataclass(frozen=True, slots=True, eq=False)
class Recipe:
    """The steps from noise to motions.

    * `grid`: the samples.
    * `gains` (f,): the filter.
    * `pfv`, `by_pfv`: velocities are bent by `by_pfv` [-] about `pfv` [m/s].
    * `steps`: what is done to the filtered motions, in this order.
    * `lift`: factor on PFA [-].
    """

    grid: Grid
    gains: Single
    pfv: float
    by_pfv: float = 0.0
    steps: tuple[Bending | Correction, ...] = ()
    lift: float = 1.0

    @classmethod
    def of(cls, target: Target, grid: Grid) -> "Recipe":
        """Return a recipe for a target, with no filter yet."""
        return cls(grid, np.ones(find_rates(grid).frequencies.size, np.float32), target.pfv)

    def make(self, noise: Transforms, motions: Single, progress: Progress) -> None:
        """Fill `motions` (k, n) [m/s2]."""
        self.shape(noise, motions)
        for step in self.steps:
            progress.check()
            step.apply(motions)
        self.finish(motions)

    def shape(self, noise: Transforms, motions: Single) -> FloatArray:
        """Fill `motions` (k, n) with filtered noise whose velocity is bent and tapered.

        Returned (k, 2): PFV before it is bent [m/s], and PFA after [m/s2].
        """
        from scipy.fft import irfft

        acceleration = irfft(noise * self.gains, find_rates(self.grid).length, axis=1, overwrite_x=True)
        taper, slope = build_taper(self.grid)
        peaks = np.empty((len(noise), 2))
        shape_rows(acceleration, taper, slope, self.grid.time_step, self.pfv, self.by_pfv, motions, peaks)
        return peaks

    def finish(self, motions: Single) -> None:
        """Lift motions (k, n) in place, and leave no final velocity."""
        lift_rows(motions, self.lift)
