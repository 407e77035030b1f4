"""Wavelets that raise or lower single ordinates of a motion's response spectrum.

A filter that all realisations share cannot make a narrow dip between two modes, where the response is what the
neighbours leave: a wavelet placed at the peak response of each realisation can.

Their form is the tapered cosine of Al Atik and Abrahamson (2010), see `assess.motion.generate`.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from assess.arrays import Single
from assess.compiled import compiled
from assess.motion.sweep import Sweep

CYCLES = 1.2
"""Width of the taper in periods [-]: the wavelet is cos(w t) exp(-(t/CYCLES T)**2)."""
EXTENT = 2.6
"""Half length in widths [-]: the taper has fallen to 1e-3 there."""


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
    shapes = [_tapered_cosine(period, time_step) for period in periods]
    # A quarter of the length after the wavelet is time enough for the response to peak.
    found = [
        Sweep.of(np.array([period]), time_step, shape.size).peaks(np.pad(shape, (0, shape.size // 4))[None])
        for period, shape in zip(periods, shapes, strict=True)
    ]
    return Wavelets(
        samples=np.concatenate(shapes),
        start=np.concatenate([[0], np.cumsum([shape.size for shape in shapes])]),
        peak=np.array([peak[0, 0] for peak, _ in found]),
        at=np.array([at[0, 0] for _, at in found], dtype=np.int64),
    )


def _tapered_cosine(period: float, time_step: float) -> Single:
    width = CYCLES * period
    half = math.ceil(EXTENT * width / time_step)
    times = np.arange(-half, half + 1) * time_step
    taper = np.exp(-((times / width) ** 2))
    wave = taper * np.cos(2 * np.pi * times / period)
    return np.asarray(wave - taper * wave.sum() / taper.sum(), np.float32)


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
