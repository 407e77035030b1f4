"""What turns the noise of a realisation into its motion: the same steps with the same numbers for all of them.

Peaks are bent by one smooth rule, so that their mean over an ensemble is what it should be. Bending leaves small values
alone and acts on the few samples about a peak; it is the same for all realisations, so that their peaks go on to
scatter: x becomes x (1 + b q/(1 + q)), with q = (x/P)^4 and P the peak that is wanted.

Wavelets raise or lower single ordinates of a motion's response spectrum. A filter that all realisations share cannot
make a narrow dip between two modes, where the response is what the neighbours leave: a wavelet placed at the peak
response of each realisation can. Their form is the tapered cosine of Al Atik and Abrahamson (2010), see
`assess.motion.generate`.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from assess.arrays import FloatArray, Single
from assess.compiled import compiled
from assess.motion.noise import Transforms, find_rates
from assess.motion.sweep import Sweep
from assess.motion.target import Grid

TAPER = 1.0
"""Time over which velocity grows from zero and fades to it [s]."""
MOST_BENT = -0.5
"""Limit of the bending [-]; from -0.6 on, larger peaks would come out smaller than lesser ones."""
CYCLES = 1.2
"""Width of the taper of a wavelet in periods [-]: the wavelet is cos(w t) exp(-(t/CYCLES T)**2)."""
EXTENT = 2.6
"""Half length of a wavelet in widths [-]: the taper has fallen to 1e-3 there."""


def bend_to(peaks: FloatArray, wanted: float, most: float, low: float = 1.0, high: float = 1.0) -> float:
    """Return the bending b [-] that brings the mean of `peaks` (k,), if need be, between two shares of `wanted`."""
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
class Wavelets:
    """One wavelet a period, (m,): samples, one after the other, and how an oscillator of that period responds to it.

    `peak` is its largest pseudo-acceleration, with sign, in units of the samples; it comes at the sample `at`.
    """

    samples: Single
    start: NDArray[np.int64]
    peak: Single
    at: NDArray[np.int64]


@lru_cache(maxsize=4)
def build_wavelets(periods: tuple[float, ...], time_step: float) -> Wavelets:
    """Return the wavelets of these periods [s], (m,)."""
    shapes, found = [], []
    for period in periods:
        width = CYCLES * period
        half = math.ceil(EXTENT * width / time_step)
        times = np.arange(-half, half + 1) * time_step
        taper = np.exp(-((times / width) ** 2))
        wave = taper * np.cos(2 * np.pi * times / period)
        shape = np.asarray(wave - taper * wave.sum() / taper.sum(), np.float32)
        # A quarter of the length after the wavelet is time enough for the response to peak.
        padded = np.pad(shape, (0, shape.size // 4))[None]
        shapes.append(shape)
        found.append(Sweep.of(np.array([period]), time_step, shape.size).peaks(padded))
    return Wavelets(
        samples=np.concatenate(shapes), start=np.concatenate([[0], np.cumsum([shape.size for shape in shapes])]),
        peak=np.array([peak[0, 0] for peak, _ in found]), at=np.array([at[0, 0] for _, at in found], dtype=np.int64),
    )  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Correction:
    """Wavelets that change some ordinates of a motion by `shares` (c,) [-], at the periods of `sweep`.

    `places` (c,) are theirs among `wavelets`.
    """

    wavelets: Wavelets
    places: NDArray[np.int64]
    shares: Single
    sweep: Sweep

    def apply(self, motions: Single) -> None:
        """Change motions (k, n) in place, each at the peaks of its own response."""
        self.add(motions, *self.sweep.peaks(motions))

    def add(self, motions: Single, peaks: Single, when: NDArray[np.int32]) -> None:
        """Change motions (k, n) in place, whose oscillators have these peaks at these samples, (k, c) each.

        To first order the ordinates change by the shares. A wavelet that reaches beyond the ends is cut there.
        """
        one = self.wavelets
        sizes = peaks * (self.shares / one.peak[self.places])
        _add(motions, self.places, sizes, when - one.at[self.places], one.samples, one.start)


@compiled
def _add(
    motions: Single,
    places: NDArray[np.int64],
    sizes: Single,
    shifts: NDArray[np.int64],
    samples: Single,
    start: NDArray[np.int64],
) -> None:  # pragma: no cover
    """Add wavelets of these sizes (k, c) to motions (k, n), their first samples at `shifts` (k, c)."""
    count = motions.shape[1]
    for k in range(motions.shape[0]):
        for c in range(places.size):
            first, size, shift = start[places[c]], sizes[k, c], shifts[k, c]
            low, high = max(0, -shift), min(start[places[c] + 1] - first, count - shift)
            for i in range(low, high):
                motions[k, i + shift] += size * samples[first + i]


@dataclass(frozen=True, slots=True, eq=False)
class Recipe:
    """The steps from noise to motions.

    A filter with `gains` (f,); velocities are bent by `by_pfv` [-] about `pfv` [m/s]; then come `steps`, and `lift`, a
    factor on PFA [-].
    """

    grid: Grid
    gains: Single
    pfv: float
    by_pfv: float = 0.0
    steps: tuple[Bending | Correction, ...] = ()
    lift: float = 1.0

    def shape(self, noise: Transforms, motions: Single) -> FloatArray:
        """Fill motions (k, n) with noise, filtered, bent and tapered; return PFV before [m/s] and PFA after [m/s2]."""
        from scipy.fft import irfft

        acceleration = irfft(noise * self.gains, find_rates(self.grid).length, axis=1, overwrite_x=True)
        taper, slope = build_taper(self.grid)
        peaks = np.empty((len(noise), 2))
        shape_rows(acceleration, taper, slope, self.grid.time_step, self.pfv, self.by_pfv, motions, peaks)
        return peaks
