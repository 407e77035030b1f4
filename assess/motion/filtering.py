"""The filter that gives noise a mean response spectrum: Gauss-Newton steps by random vibration.

The filter is a power spectrum, straight in logarithms between the oscillators' own frequencies. The variance of an
oscillator's response is a sum over the parts of the filter, and its peak goes with the root: so the share of each part
in the variance is half the slope of the logarithm of the peak, which a step inverts for all oscillators at once.

Source of the idea: Gasparini DA, Vanmarcke EH (1976). Simulated earthquake motions compatible with prescribed response
spectra. MIT, Department of Civil Engineering, R76-4 (peak factors, here without time; the inversion is ours)
"""

import numpy as np
from numpy.typing import NDArray

from assess.motion.record import CORNER, FloatArray
from assess.motion.spectrum import DAMPING
from assess.motion.target import Target

ROLL_OFF = 8
"""Order with which the filter falls off below the corner of the records' own treatment."""
RIDGE = 0.2
"""Damping of a step [-]; less of it raises energy and duration without a better match."""
MOST_OFF, MOST_STEP = 0.5, 2.0
"""Logarithms to which errors and steps of power are clipped [-]."""
GUESSES, GUESSED, CYCLED = 12, 0.8, 20.0
"""Steps before a motion is made, the power of each, and the duration by which peak factors are guessed [s]."""
FINE = 800
"""Frequencies by which variances are integrated."""


def choose_periods(target: Target) -> NDArray[np.int64]:
    """Return places among the target's periods: of each two neighbours the one whose ordinate stands out more."""
    logs = np.pad(np.log(target.pseudo), 2, mode="edge")
    out = np.abs(logs[2:-2] - (logs[:-4] + logs[4:]) / 2)
    pairs = out[: out.size // 2 * 2].reshape(-1, 2)
    return np.asarray(2 * np.arange(len(pairs)) + (pairs[:, 1] > pairs[:, 0]), np.int64)


def roll_off(frequencies: FloatArray) -> FloatArray:
    """Return the filter's power below the corner of the records' treatment [-], at frequencies [Hz] from 0 on."""
    return np.asarray(np.where(frequencies > 0, 1 / (1 + (CORNER / np.maximum(frequencies, 1e-9)) ** ROLL_OFF), 0.0))


def response_matrix(periods: FloatArray, time_step: float) -> FloatArray:
    """Return the variance of the response at each period (m, ) to unit power of each part of the filter (, m)."""
    fine = np.geomspace(CORNER / 5, 0.5 / time_step, FINE)
    places = np.interp(np.log(fine), -np.log(periods[::-1]), np.arange(periods.size, dtype=float)[::-1])
    parts = np.maximum(0, 1 - np.abs(places[:, None] - np.arange(periods.size)))
    own = 1 / periods[:, None]
    gain = own**4 / ((own**2 - fine**2) ** 2 + (2 * DAMPING * own * fine) ** 2)
    # No matrix product: libraries share it out among threads of their own.
    return np.asarray(np.einsum("ij,jk->ik", gain * fine * roll_off(fine), parts))


def improve(matrix: FloatArray, power: FloatArray, error: FloatArray, weight: FloatArray) -> FloatArray:
    """Return the filter's power (m,) after a step towards responses larger by exp(error), each with its weight."""
    share = matrix * power
    share /= share.sum(axis=1, keepdims=True)
    left = share.T * weight
    slope = np.einsum("ij,jk->ik", left, share) + RIDGE * np.eye(power.size)
    step = np.linalg.solve(slope, (left * np.clip(error, -MOST_OFF, MOST_OFF)).sum(axis=1))
    return np.asarray(power * np.exp(np.clip(2 * step, -MOST_STEP, MOST_STEP)))


def guess_power(matrix: FloatArray, periods: FloatArray, wanted: FloatArray) -> FloatArray:
    """Return the power (m,) that random vibration alone gives for mean peaks `wanted` (m,).

    Each part is corrected by what its own oscillator lacks, which keeps the filter smooth where spectra leave it open.
    """
    variance = wanted**2 / (2 * np.log(2.8 * np.maximum(CYCLED / periods, 1)))
    power = (wanted * periods) ** 2
    for _ in range(GUESSES):
        missing = variance / (matrix * power).sum(axis=1)
        power *= missing**GUESSED
    return np.asarray(power)


def gains_of(power: FloatArray, periods: FloatArray, frequencies: FloatArray) -> NDArray[np.float32]:
    """Return the filter at frequencies [Hz] from 0 on: straight in logarithms between the oscillators' own."""
    at = np.log(np.maximum(frequencies, 1e-9))
    shape = np.exp(np.interp(at, -np.log(periods[::-1]), np.log(power[::-1]) / 2))
    return (shape * np.sqrt(roll_off(frequencies))).astype(np.float32)
