"""What generated motions of a floor have to match: the 5 % response spectrum of its record, its peaks, and how it grows
and fades.

A recorded motion has its low frequencies at other times than its high ones: a tall building's first mode goes on while
the shaking of its higher modes has passed. One envelope for all makes the peaks of the modes meet, and PFV up to half
as large again as the record's; so each octave has its own, from the record's Husid curve in that octave.

References
----------
Husid RL (1969). Características de terremotos, análisis general. Revista del IDIEM 8:21-42.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from assess.arrays import FloatArray
from assess.motion.record import Motion, resample

LOWEST, HIGHEST = 0.1, 25.6
"""Centres of the first and last octave [Hz]; the first reaches down to 0, the last up to the Nyquist frequency."""
SMOOTHED, CYCLES = 0.5, 2.0
"""A Husid curve is smoothed over this time [s], and over this many cycles of its octave, whichever is longer."""
REACH = 4.0
"""Standard deviations to which that smoothing reaches [-]."""

STRETCH = 0.2
"""Standard deviation of the logarithm of duration among realisations [-]: an assumption. Equations that predict the
duration of ground motion leave 0.4 and more unexplained from one earthquake to another."""
PAD = 20.0
"""Zeros after the samples while motions are filtered [s], so that what is filtered does not come round."""


@dataclass(frozen=True, slots=True, eq=False)
class Envelopes:
    """Amplitudes `values` (b, n) of b octaves with `centres` (b,) [Hz].

    Durations are stretched about `half_time` [s]: when half of a record's energy has passed.
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
    power = np.empty_like(bands)
    for row, band, centre in zip(power, bands, centres, strict=True):
        # Smoothed by a normal curve with a standard deviation of `width` samples; zeros beyond the ends
        width = max(SMOOTHED, CYCLES / centre) / time_step
        longer = int(next_fast_len(count + math.ceil(REACH * width), real=True))
        curve = np.exp(-2 * (np.pi * width * np.fft.rfftfreq(longer)) ** 2)
        row[:] = np.maximum(irfft(rfft(band**2, longer) * curve, longer)[:count], 0.0)
    passed = np.cumsum(acceleration**2)
    half = float(np.searchsorted(passed, passed[-1] / 2)) * time_step
    return Envelopes(centres, np.sqrt(power / np.maximum(power.mean(axis=1, keepdims=True), 1e-300)), half)


TIME_STEP = 0.005
"""Step of generated motions [s]: ten samples in the shortest period that is matched."""
SHORTEST, LONGEST, COUNT = 0.03, 10.0, 160
"""Periods at which spectra are matched [s], evenly spaced in their logarithm."""
JUDGED_FROM = 0.05
"""Shortest period at which a match is judged [s]; below, a spectrum holds little more than PFA."""


@dataclass(frozen=True, slots=True)
class Grid:
    """The samples that all floors of a building share: `count` of them, one every `time_step` [s]."""

    time_step: float
    count: int

    @property
    def duration(self) -> float:
        """From the first sample to the last [s]."""
        return (self.count - 1) * self.time_step


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Target:
    """What an ensemble is to match.

    * `periods`, `pseudo` (m,): 5 % pseudo-acceleration [m/s2] over period [s].
    * `pfa`, `pfv`: peaks [m/s2], [m/s].
    * `envelopes`: how the shaking grows and fades.
    * `acceleration` (n,): the recorded motion that sets it [m/s2].
    """

    periods: FloatArray
    pseudo: FloatArray
    pfa: float
    pfv: float
    envelopes: Envelopes
    acceleration: FloatArray

    @property
    def nbytes(self) -> int:
        """Bytes."""
        return self.envelopes.values.nbytes + self.acceleration.nbytes + 2 * self.periods.nbytes

    def ordinates(self, periods: FloatArray, time_step: float = TIME_STEP) -> FloatArray:
        """Return the record's pseudo-acceleration [m/s2] at other periods [s]; `time_step` [s] is that of the grid."""
        from assess.motion.spectrum import response_spectrum

        return response_spectrum(self.acceleration, time_step, periods).pseudo


def matched_to(periods: FloatArray, pseudo: FloatArray) -> float:
    """Return the longest period at which the match to a spectrum is judged [s].

    It is 1.5 times the longest at which pseudo-velocity is half its maximum or more, at least 3 s, at most 10 s.
    """
    velocity = pseudo * periods
    longest = periods[velocity >= velocity.max() / 2].max()
    return float(min(max(3.0, 1.5 * longest), LONGEST))


def build_grid(motions: Iterable[Motion], *, at_least: Grid | None = None) -> Grid:
    """Return the grid of a building: as long as its longest record, and as that of drawn motions where it has any."""
    seconds = [(motion.acceleration.size - 1) * motion.time_step for motion in motions]
    if at_least is not None:
        seconds.append(at_least.duration)
    return Grid(TIME_STEP, math.ceil(max(seconds) / TIME_STEP - 1e-6) + 1)


def put_on_grid(motion: Motion, grid: Grid) -> FloatArray:
    """Return a motion's acceleration [m/s2] at the samples of `grid`, (count,): on straight lines, then zeros."""
    times = np.linspace(0.0, (motion.acceleration.size - 1) * motion.time_step, motion.acceleration.size)
    values = resample(times, motion.acceleration, grid.time_step)[: grid.count]
    return np.pad(values, (0, grid.count - values.size))


def recorded_target(motion: Motion, grid: Grid) -> Target:
    """Return the target that a recorded and treated motion sets."""
    from assess.motion.spectrum import build_periods, response_spectrum

    acceleration = put_on_grid(motion, grid)
    periods = build_periods(SHORTEST, LONGEST, COUNT)
    return Target(
        periods=periods, pseudo=response_spectrum(acceleration, grid.time_step, periods).pseudo, pfa=motion.pfa,
        pfv=motion.pfv, envelopes=husid_envelopes(acceleration, grid.time_step), acceleration=acceleration,
    )  # fmt: skip
