"""Response spectra, exact for a motion that is linear between its samples.

Importing this module imports numba, which takes a third of a second: import it where a spectrum is asked for.

Source: Nigam NC, Jennings PC (1969). Calculation of response spectra from strong-motion earthquake records. Bulletin of
the Seismological Society of America 59(2):909-922. doi:10.1785/BSSA0590020909
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.arrays import FloatArray
from assess.compiled import compiled
from assess.motion.rows import run_rows
from assess.progress import SILENT, Progress

DAMPING = 0.05
"""Share of critical damping [-]."""


@dataclass(frozen=True, slots=True, eq=False)
class Spectrum:
    """Peak responses of damped oscillators: the arrays have the shape of the motions, periods (m,) in place of samples.

    * `periods` (m,): [s]
    * `pseudo` (..., m): pseudo-acceleration, the peak relative displacement times the circular frequency squared
      [m/s2].
    * `absolute` (..., m): peak absolute acceleration [m/s2].
    """

    periods: FloatArray
    pseudo: FloatArray
    absolute: FloatArray


def build_periods(shortest: float = 0.02, longest: float = 10.0, count: int = 120) -> FloatArray:
    """Return `count` periods [s], evenly spaced in their logarithm."""
    return np.geomspace(shortest, longest, count)


def response_spectrum(
    acceleration: NDArray[Any],
    time_step: float,
    periods: FloatArray,
    *,
    damping: float = DAMPING,
    threads: int = 1,
    progress: Progress = SILENT,
) -> Spectrum:
    """Return the response spectra of one motion or of several.

    Oscillators start at rest and are watched at the samples, from the first to the last.

    * `acceleration` (n,) or (k, n): base acceleration of one motion, or of k [m/s2].
    * `time_step`: [s].
    * `periods` (m,): above 0 [s].
    * `damping`: share of critical damping, above 0 and below 1 [-].
    * `threads`: that share the motions; they do not change a result.
    * `progress`: asked before each motion whether to stop; CancelledError then.

    Raises ValueError if a period, the damping or the time step is outside these limits, or a motion has fewer than two
    samples or one that is not finite.
    """
    periods = np.asarray(periods, dtype=np.float64)
    acceleration = np.asarray(acceleration, dtype=np.float64)
    if not (periods.ndim == 1 and periods.size and np.isfinite(periods).all() and periods.min() > 0):
        raise ValueError("periods must be a list of finite numbers above 0 s")
    if not 0 < damping < 1:
        raise ValueError(f"damping is {damping}, expected above 0 and below 1")
    if not 0 < time_step < math.inf:
        raise ValueError(f"time_step is {time_step} s, expected above 0")
    if acceleration.ndim not in (1, 2) or acceleration.shape[-1] < 2:
        raise ValueError(f"acceleration has shape {acceleration.shape}, expected (n,) or (k, n) with n of 2 or more")
    if not np.isfinite(acceleration).all():
        raise ValueError("acceleration has samples that are not finite numbers")
    rows = np.ascontiguousarray(np.atleast_2d(acceleration))
    step = oscillator_step(periods, time_step, damping)
    peaks = np.zeros((len(rows), 2, periods.size))
    run_rows(lambda row: _peaks(rows[row], step, peaks[row]), len(rows), threads, progress)
    pseudo, absolute = np.moveaxis(peaks.reshape((*acceleration.shape[:-1], 2, periods.size)), -2, 0)
    return Spectrum(periods, pseudo * (2 * np.pi / periods) ** 2, absolute)


def oscillator_step(periods: FloatArray, time_step: float, damping: float = DAMPING) -> FloatArray:
    """Return what takes oscillators over one step of a linear base acceleration, (10, m).

    With displacement u, velocity v and base accelerations a, b at the two ends: u' = r0 u + r1 v + r4 a + r5 b and
    v' = r2 u + r3 v + r6 a + r7 b; the absolute acceleration is -(r8 v' + r9 u').
    """
    omega = 2 * np.pi / periods
    damped = omega * math.sqrt(1 - damping**2)
    decay = np.exp(-damping * omega * time_step)
    sine, cosine = decay * np.sin(damped * time_step), decay * np.cos(damped * time_step)
    u_u, u_v = cosine + damping * omega / damped * sine, sine / damped
    v_u, v_v = -(omega**2) / damped * sine, cosine - damping * omega / damped * sine

    def forced(first: float, last: float) -> tuple[FloatArray, FloatArray]:
        """Displacement and velocity after a step from rest: the particular solution, and what brings it to rest."""
        velocity = -(last - first) / time_step / omega**2
        start = -first / omega**2 - 2 * damping / omega * velocity
        end = -last / omega**2 - 2 * damping / omega * velocity
        return end - u_u * start - u_v * velocity, velocity - v_u * start - v_v * velocity

    (u_a, v_a), (u_b, v_b) = forced(1.0, 0.0), forced(0.0, 1.0)
    return np.array([u_u, u_v, v_u, v_v, u_a, u_b, v_a, v_b, 2 * damping * omega, omega**2])


@compiled
def _peaks(acceleration: FloatArray, step: FloatArray, peaks: FloatArray) -> None:  # pragma: no cover
    """Fill `peaks` (2, m) with peak |u| and peak absolute acceleration; inner loops run in vector lanes."""
    count = step.shape[1]
    r0, r1, r2, r3, r4, r5, r6, r7, r8, r9 = (
        step[0], step[1], step[2], step[3], step[4], step[5], step[6], step[7], step[8], step[9],
    )  # fmt: skip
    u, v = np.zeros(count), np.zeros(count)
    displacement, absolute = peaks[0], peaks[1]
    for i in range(acceleration.size - 1):
        a, b = acceleration[i], acceleration[i + 1]
        for j in range(count):
            next_u = r0[j] * u[j] + r1[j] * v[j] + r4[j] * a + r5[j] * b
            next_v = r2[j] * u[j] + r3[j] * v[j] + r6[j] * a + r7[j] * b
            u[j], v[j] = next_u, next_v
            displacement[j] = max(displacement[j], abs(next_u))
        for j in range(count):
            absolute[j] = max(absolute[j], abs(r8[j] * v[j] + r9[j] * u[j]))
