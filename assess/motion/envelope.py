"""How a generated motion grows and fades.

A recorded motion has its low frequencies at other times than its high ones: a tall building's first mode goes on while
the shaking of its higher modes has passed. One envelope for all makes the peaks of the modes meet, and PFV up to half
as large again as the record's; so each octave has its own, from the record's Husid curve in that octave.

References
----------
Husid RL (1969). Características de terremotos, análisis general. Revista del IDIEM 8:21-42.
"""

import math
from dataclasses import dataclass

import numpy as np

from assess.motion.record import FloatArray

LOWEST, HIGHEST = 0.1, 25.6
"""Centres of the first and last octave [Hz]; the first reaches down to 0, the last up to the Nyquist frequency."""
SMOOTHED, CYCLES = 0.5, 2.0
"""A Husid curve is smoothed over this time [s], and over this many cycles of its octave, whichever is longer."""
REACH = 4.0
"""Standard deviations to which that smoothing reaches [-]."""

RISE, HOLD, DECAY = 5.0, 15.0, 10.0
"""Envelope of a floor without a record [s]: AC156's."""
HOLD_CYCLES = 5.0
"""The hold lasts at least as many times T1 [-], so that a tall building's first mode can build up."""

STRETCH = 0.2
"""Standard deviation of the logarithm of duration among realisations [-]: an assumption. Equations that predict the
duration of ground motion leave 0.4 and more unexplained from one earthquake to another."""
PAD = 20.0
"""Zeros after the samples while motions are filtered [s], so that what is filtered does not come round."""


@dataclass(frozen=True, slots=True, eq=False)
class Envelopes:
    """Amplitudes `values` (b, n) of b octaves with `centres` (b,) [Hz].

    Durations are stretched about `half_time` [s]: when half of a record's energy has passed, or the middle of a hold.
    """

    centres: FloatArray
    values: FloatArray
    half_time: float


def octaves() -> FloatArray:
    """Return the centres of the octaves [Hz]."""
    return np.geomspace(LOWEST, HIGHEST, round(math.log2(HIGHEST / LOWEST)) + 1)


def split(frequencies: FloatArray, centres: FloatArray) -> FloatArray:
    """Return the weight of each octave at each frequency [-], (b, f): between two centres one fades into the next."""
    place = np.log2(np.maximum(frequencies, 1e-9) / centres[0])
    away = np.abs(np.clip(place, 0, centres.size - 1) - np.arange(centres.size)[:, None])
    return np.where(away < 1, np.cos(np.pi / 2 * np.minimum(away, 1)) ** 2, 0.0)


def husid_envelopes(acceleration: FloatArray, time_step: float) -> Envelopes:
    """Return the envelopes of a motion (n,) [m/s2]: the root of the slope of its Husid curve in each octave."""
    from scipy.fft import irfft, next_fast_len, rfft

    count, centres = acceleration.size, octaves()
    length = int(next_fast_len(count + math.ceil(PAD / time_step), real=True))
    weights = split(np.asarray(np.fft.rfftfreq(length, time_step), np.float64), centres)
    bands = irfft(rfft(acceleration, length) * weights, length, axis=1)[:, :count]
    power = np.array(
        [
            _smooth(band**2, max(SMOOTHED, CYCLES / centre) / time_step)
            for band, centre in zip(bands, centres, strict=True)
        ]
    )
    passed = np.cumsum(acceleration**2)
    half = float(np.searchsorted(passed, passed[-1] / 2)) * time_step
    return Envelopes(centres, np.sqrt(power / np.maximum(power.mean(axis=1, keepdims=True), 1e-300)), half)


def _smooth(values: FloatArray, width: float) -> FloatArray:
    """Return values (n,) under a normal curve with a standard deviation of `width` samples; zeros beyond the ends."""
    from scipy.fft import irfft, next_fast_len, rfft

    length = int(next_fast_len(values.size + math.ceil(REACH * width), real=True))
    curve = np.exp(-2 * (np.pi * width * np.fft.rfftfreq(length)) ** 2)
    return np.asarray(np.maximum(irfft(rfft(values, length) * curve, length)[: values.size], 0.0))


def hold_times(period: float | None) -> tuple[float, float, float]:
    """Return rise, hold and decay [s] of a floor without a record, in a building with T1 [s], if that is known."""
    return RISE, max(HOLD, HOLD_CYCLES * (period or 0.0)), DECAY


def hold_envelopes(count: int, time_step: float, period: float | None) -> Envelopes:
    """Return the envelope of a floor without a record, the same for all frequencies; a short grid cuts the hold."""
    rise, hold, decay = hold_times(period)
    duration = (count - 1) * time_step
    hold = max(0.0, min(hold, duration - rise - decay))
    corners = np.array([0.0, rise, rise + hold, rise + hold + decay])
    values = np.interp(np.arange(count) * time_step, corners, [0.0, 1.0, 1.0, 0.0])
    return Envelopes(np.array([LOWEST]), values[None], float(rise + hold / 2))
