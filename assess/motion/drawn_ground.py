"""Ground motions of earthquakes of which only peaks are known: each draw is one, with a PGA and a PGV of its own.

Where PGA and PGV are both known, every draw has them. Where one is, their ratio is drawn. White noise under an envelope
of drawn length is filtered until its median 5 % spectrum is that of Newmark and Hall for the draw's PGV/PGA. Then one
factor below and one above PGA/(2 pi PGV) bring it to the draw's PGA and PGV. Noise is that of `assess.motion.noise`:
draw k has the same random phases whatever the ground motion, as it has on floors with a record.

References
----------
Newmark NM, Hall WJ (1982). Earthquake Spectra and Design. Earthquake Engineering Research Institute (amplifications,
corners at 33 and 8 Hz, PGA PGD/PGV^2 of 6). The amplifications
are those of public implementations; the others are assumed: not compared with the print.
Boore DM (2003). Simulation of ground motion using the stochastic method. Pure and Applied Geophysics 160:635-676
(envelope, after Saragoni and Hart 1974). Assumed: not compared with the print.
"""

import math
from functools import lru_cache

import numpy as np

from assess.arrays import FloatArray, Single
from assess.motion.assumed import Ground
from assess.motion.bands import meet_peaks, split_bands
from assess.motion.noise import Phases, draw_noise, find_rates
from assess.motion.rows import GROUP
from assess.motion.stratified import draw_normal
from assess.motion.target import LOWEST, TIME_STEP, Envelopes, Grid
from assess.progress import Progress

AMPLIFIED = 2.12, 1.65, 1.39
"""PSA/PGA, PSV/PGV, SD/PGD of the three branches at 5 % damping, medians [-]: Newmark and Hall."""
RIGID, PLATEAU = 1 / 33, 1 / 8
"""Period up to which PSA is PGA, and from which the first branch runs [s]: Newmark and Hall."""
DISPLACEMENT = 6.0
"""PGA PGD/PGV^2 [-]: Newmark and Hall."""
EARLY, FAINT = 0.2, 0.05
"""Envelope (t/p e^(1-t/p))^b: its peak comes at this share of its length, at whose end it is so faint [-]: Boore."""
LENGTH, LENGTH_SCATTER = 21.0, 0.4
"""Median length of the envelope [s], about twice the time from 5 to 95 % of the energy of those components; standard
deviation of its logarithm [-], that which equations of duration leave from one earthquake to another."""
SHORT, LONG = 2.0, 1.2
"""Standard deviations to which that logarithm is drawn, below and above [-]."""
LEAD, REACH, REST = 2.0, 1.3, 8.0
"""Time before the envelope [s], how much of its median length is kept [-], and time for a building to come to rest [s];
a building of a longer period has as many times it."""
STRONG = 7.0
"""Time in which the peak of a response is sought by random vibration [s]."""
CORNER, ORDER = 0.1, 8
"""Motions fade out below this frequency [Hz], with this order: as records do when treated."""
GRID = np.geomspace(0.006, 1.0, 27)
"""PGV/PGA [s] at which filters are found; between two of them they are straight in logarithms."""
DAMPING = 0.05
_LENGTH = 4
"""Stream of random numbers of a seed."""


def build_beam_grid(longest: float | None) -> Grid:
    """Return the samples of drawn motions in a building of which T1 is drawn up to `longest` [s]; None: of none."""
    rest = REST * max(1, math.ceil((longest or 0.0) / 4))
    return Grid(TIME_STEP, math.ceil((LEAD + REACH * LENGTH + rest) / TIME_STEP) + 1)


def draw_ground(ground: Ground, phases: Phases, group: int, progress: Progress) -> Single:
    """Return the ground motions of a group of draws, (GROUP, n) [m/s2]."""
    from scipy.fft import irfft

    first, grid = group * GROUP, phases.grid
    ratios = ground.draw_ratios(phases.seed, phases.axis, first, GROUP)
    length = draw_normal([phases.seed, _LENGTH], first, GROUP, 3.0).clip(-SHORT, LONG)
    # The envelope of median length; before `LEAD` it is 0, and its time is stretched about that.
    power = -EARLY * math.log(FAINT) / (1 + EARLY * (math.log(EARLY) - 1))
    time = np.maximum(np.arange(grid.count) * grid.time_step - LEAD, 0.0) / (EARLY * LENGTH)
    envelope = Envelopes(np.array([LOWEST]), ((time * np.exp(1 - time)) ** power)[None], LEAD)
    noise = draw_noise(envelope, phases, group, progress, stretches=np.exp(LENGTH_SCATTER * length))
    # The filter of each draw by its PGV/PGA, (k, f)
    place = np.clip(np.interp(np.log(ratios), np.log(GRID), np.arange(GRID.size)), 0, GRID.size - 1.001)
    low = place.astype(int)
    logs = {at: _resample(grid, at) for at in {*low.tolist(), *(low + 1).tolist()}}
    part = (place - low)[:, None].astype(np.float32)
    under, over = (np.stack([logs[at] for at in which.tolist()]) for which in (low, low + 1))
    noise *= np.asarray(np.exp(under + part * (over - under)), np.float32)
    rates = find_rates(grid)
    filtered = irfft(noise, rates.length, axis=1, overwrite_x=True)[:, : grid.count]
    motions: Single = np.ascontiguousarray(filtered, np.float32)
    pga = ground.peaks[0] if ground.pga is not None else (ground.pgv or 0.0) / ratios
    peaks = np.broadcast_to(pga, ratios.shape)
    slow = split_bands(motions, grid.time_step, 1 / (2 * np.pi * ratios))
    meet_peaks(motions, slow, grid.time_step, peaks, peaks * ratios)
    return motions


@lru_cache(maxsize=64)
def _resample(grid: Grid, at: int) -> Single:
    frequencies, logs = fit_noise(float(GRID[at]))
    own = np.maximum(find_rates(grid).frequencies, frequencies[0])
    return np.asarray(np.interp(np.log(own), np.log(frequencies), logs), np.float32)


def find_shape(periods: FloatArray, ratio: float) -> FloatArray:
    """Return Newmark and Hall's median PSA/PGA [-] at periods [s] for PGV/PGA `ratio` [s]."""
    a, v, d = AMPLIFIED
    first, second = 2 * np.pi * v / a * ratio, 2 * np.pi * d / v * DISPLACEMENT * ratio
    rise = np.clip((periods / RIGID) ** (math.log(a) / math.log(PLATEAU / RIGID)), 1.0, a)
    return np.asarray(np.minimum(rise, a * np.minimum(first / periods, first * second / periods**2)))


@lru_cache(maxsize=64)
def fit_noise(ratio: float, rounds: int = 25) -> tuple[FloatArray, FloatArray]:
    """Return frequencies (f,) [Hz] and ln of the amplitude (f,) of noise with the median spectrum of a ratio [s].

    Random vibration: a peak is the deviation of the response times a factor that grows with its cycles. No motion is
    made for it.
    """
    periods, f = np.geomspace(0.03, 9.0, 60), np.geomspace(0.04, 60.0, 500)
    lone = 1 / periods[:, None]
    # The variance of each response to unit power at each frequency, (m, f)
    weight = lone**4 / ((lone**2 - f**2) ** 2 + (2 * DAMPING * lone * f) ** 2) * np.gradient(f)
    wanted = find_shape(periods, ratio) ** 2 / (2 * np.log(2.8 * np.maximum(STRONG / periods, 1.0)))
    own = 1 / (1 + (CORNER / f) ** ORDER)
    power = find_shape(np.clip(1 / f, periods[0], periods[-1]), ratio) ** 2 / f
    for _ in range(rounds):
        missing = wanted / (weight * (power * own)).sum(axis=1)
        power = power * np.exp(0.8 * np.interp(-np.log(f), np.log(periods), np.log(missing)))
    return f, np.log(power * own) / 2
