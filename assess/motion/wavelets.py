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
    """Return the displacement of largest size, signed, and the sample at which it comes.

    Two steps a turn: the second follows from the state before both, which halves the wait of one step for another.
    """
    r0, r1, r2, r3, r4, r5, r6, r7 = step[0], step[1], step[2], step[3], step[4], step[5], step[6], step[7]
    u_u, u_v, v_u, v_v = r0 * r0 + r1 * r2, r0 * r1 + r1 * r3, r2 * r0 + r3 * r2, r2 * r1 + r3 * r3
    u, v, peak, at, last = 0.0, 0.0, 0.0, 0, acceleration.size - 1
    for i in range(0, last, 2):
        a, b, c = acceleration[i], acceleration[i + 1], acceleration[min(i + 2, last)]
        u_a, v_a = r4 * a + r5 * b, r6 * a + r7 * b
        u_b, v_b = r0 * u_a + r1 * v_a + r4 * b + r5 * c, r2 * u_a + r3 * v_a + r6 * b + r7 * c
        first = r0 * u + r1 * v + u_a
        if abs(first) > abs(peak):
            peak, at = first, i + 1
        u, v = u_u * u + u_v * v + u_b, v_u * u + v_v * v + v_b
        if i + 2 <= last and abs(u) > abs(peak):
            peak, at = u, i + 2
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
