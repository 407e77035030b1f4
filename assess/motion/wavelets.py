"""Wavelets that raise or lower single ordinates of a motion's response spectrum.

A filter that all realisations share cannot make a narrow dip between two modes, where the response is what the
neighbours leave: a wavelet placed at the peak response of each realisation can.

Source of the form: Al Atik L, Abrahamson N (2010). An improved method for nonstationary spectral matching. Earthquake
Spectra 26(3):601-617. doi:10.1193/1.3459159 (tapered cosine; we change the mean of an ensemble with it)
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from assess.compiled import compiled
from assess.motion.record import FloatArray
from assess.motion.spectrum import oscillator_step

CYCLES = 1.2
"""Width of the taper in periods [-]: the wavelet is cos(w t) exp(-(t/CYCLES T)**2)."""
EXTENT = 3.0
"""Half length in widths [-]: the taper has fallen to 1e-4 there."""


@dataclass(frozen=True, slots=True, eq=False)
class Wavelets:
    """One wavelet a period, (m,): samples, one after the other, and how an oscillator of that period responds to it.

    `peak` and `at` are its largest displacement [m s2/m] and the sample at which it comes; `step` is that of
    `oscillator_step`.
    """

    samples: FloatArray
    start: NDArray[np.int64]
    peak: FloatArray
    at: NDArray[np.int64]
    step: FloatArray


def build_wavelets(periods: FloatArray, time_step: float) -> Wavelets:
    """Return the wavelets of these periods [s], (m,)."""
    step = oscillator_step(periods, time_step)
    shapes = [_tapered_cosine(period, time_step) for period in periods]
    start = np.concatenate([[0], np.cumsum([shape.size for shape in shapes])])
    # A quarter of the length after the wavelet is time enough for the response to peak.
    found = [_peak_response(np.pad(shape, (0, shape.size // 4)), step[:, place]) for place, shape in enumerate(shapes)]
    peak, at = (np.array(column) for column in zip(*found, strict=True))
    return Wavelets(np.concatenate(shapes), start, peak, at, step)


def _tapered_cosine(period: float, time_step: float) -> FloatArray:
    """Return a wavelet whose velocity ends at 0."""
    width = CYCLES * period
    half = math.ceil(EXTENT * width / time_step)
    times = np.arange(-half, half + 1) * time_step
    taper = np.exp(-((times / width) ** 2))
    wave = taper * np.cos(2 * np.pi * times / period)
    return np.asarray(wave - taper * wave.sum() / taper.sum())


@compiled
def _peak_response(acceleration: FloatArray, step: FloatArray) -> tuple[float, int]:  # pragma: no cover
    """Return the displacement of largest size, signed, and the sample at which it comes."""
    u, v, peak, at = 0.0, 0.0, 0.0, 0
    for i in range(acceleration.size - 1):
        a, b = acceleration[i], acceleration[i + 1]
        next_u = step[0] * u + step[1] * v + step[4] * a + step[5] * b
        u, v = next_u, step[2] * u + step[3] * v + step[6] * a + step[7] * b
        if abs(u) > abs(peak):
            peak, at = u, i + 1
    return peak, at


@compiled
def adjust(
    acceleration: FloatArray,
    ratios: FloatArray,
    samples: FloatArray,
    start: NDArray[np.int64],
    peak: FloatArray,
    at: NDArray[np.int64],
    step: FloatArray,
) -> None:  # pragma: no cover
    """Change one motion (n,) in place so that its spectral ordinates are multiplied by `ratios` (m,), to first order.

    Ordinates whose ratio is 1 are left alone. A wavelet that reaches beyond the ends is cut there.
    """
    count = acceleration.size
    for j in range(ratios.size):
        if ratios[j] == 1.0:
            continue
        response, when = _peak_response(acceleration, step[:, j])
        shift = when - at[j] - start[j]
        size = (ratios[j] - 1.0) * response / peak[j]
        for i in range(max(start[j], -shift), min(start[j + 1], count - shift)):
            acceleration[i + shift] += size * samples[i]
