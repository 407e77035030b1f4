"""What generated motions of a floor have to match: a 5 % response spectrum, peaks, and how the shaking grows and fades.

A recorded motion gives all of it. For a floor of which only a peak is known there is a generic spectrum: an
assumption, built from the shape of ICC-ES AC156 and checked against the recorded floors that come with the tests.

References
----------
ICC-ES AC156, Acceptance criteria for seismic certification by shake-table testing of nonstructural components: corners
at 8.3 and 33.3 Hz, slope of the long-period branch, and envelope of 5, 15 and 10 s. Assumed: not compared with the
document.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from assess.motion.envelope import Envelopes, hold_envelopes, hold_times, husid_envelopes
from assess.motion.record import FloatArray, Motion, resample

TIME_STEP = 0.005
"""Step of generated motions [s]: ten samples in the shortest period that is matched."""
SHORTEST, LONGEST, COUNT = 0.03, 10.0, 160
"""Periods at which spectra are matched [s], evenly spaced in their logarithm."""
JUDGED_FROM = 0.05
"""Shortest period at which a match is judged [s]; below, a spectrum holds little more than PFA."""

RIGID_BELOW, PLATEAU_FROM = 1 / 33.3, 1 / 8.3
"""Periods [s] up to which PSA equals PFA, and from which the plateau runs: AC156's corners."""
PLATEAU = 2.5
"""PSA/PFA of the plateau [-]: AC156's A_FLX/A_RIG, which it lowers up a building and which is kept here."""
SLOPE = 0.89771
"""Fall of PSA with frequency below AC156's lowest corner, 1.3 Hz [-]."""
PLATEAU_TO = 1 / 1.3
"""Period at which the plateau ends where T1 is unknown [s]."""

RESONANCE = 4.0
"""PSA/PFA at a resonance [-]."""
RESONANCES = ((1 / 6.5, 1 / 4.5), (1.0, 1.0))
"""Bands of resonance, as ratios to T1 [-]: a higher mode, and T1. The 21 recorded motions of buildings that we hold
peak at 3 to 5, most at a higher mode: 575 Market Street (T1 of 5 to 6 s) at 0.9 to 1.0 s, Berkeley (T1 of 0.8 to 1 s)
at 0.09 to 0.2 s, Alhambra (2 s) at 0.25 s; a shear beam has its third mode at T1/5."""
LONGER = 2.5
"""How much longer than estimated by height T1 may be [-]: that of 575 Market Street is, 6 s for 2.35 s. The band of the
higher mode is widened as much where T1 is estimated."""
RAMP = 1.25
"""Ratio of periods [-] over which a resonance fades into the plateau."""
SHORTEST_PLATEAU_END = 1.0
"""The plateau runs at least to this period [s], however stiff the building."""

LEVEL_OF_PFV = 2.0
"""Pseudo-velocity over PFV [-] from which the cap of a generic spectrum starts; it is adapted until PFV is met."""

CODE_FACTOR, CODE_POWER = 0.0488, 0.75
"""T1 [s] of a building of height h [m] is about CODE_FACTOR h**CODE_POWER: ASCE 7-22 Eq. 12.8-7, "all other structural
systems". It is meant to be short."""


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

    Parameters
    ----------
    periods, pseudo : (m,) arrays
        5 % pseudo-acceleration [m/s2] over period [s].
    velocity_level : float
        Pseudo-velocity that caps a generic spectrum [m/s], to begin with; infinite where no PFV is given.
    pfa, pfv : float
        Peaks [m/s2], [m/s]; `pfv` is NaN where none is to be matched.
    envelopes : Envelopes
        How the shaking grows and fades.
    acceleration : (n,) array, optional
        The recorded motion that sets it [m/s2].
    """

    periods: FloatArray
    pseudo: FloatArray
    velocity_level: float
    pfa: float
    pfv: float
    envelopes: Envelopes
    acceleration: FloatArray | None = None

    @property
    def is_generic(self) -> bool:
        """Whether it was made from peaks alone."""
        return self.acceleration is None

    def ordinates(self, periods: FloatArray, time_step: float = TIME_STEP) -> FloatArray:
        """Return pseudo-acceleration [m/s2] at other periods [s]: a record's own, else between those matched.

        `time_step` [s] is that of the grid.
        """
        if self.acceleration is None:
            return np.exp(np.interp(np.log(periods), np.log(self.periods), np.log(self.pseudo)))
        from assess.motion.spectrum import response_spectrum

        return response_spectrum(self.acceleration, time_step, periods).pseudo

    def capped(self, level: float) -> FloatArray:
        """Return pseudo-acceleration to match [m/s2], (m,), with pseudo-velocity kept to `level` [m/s]."""
        return np.minimum(self.pseudo, level * 2 * np.pi / self.periods)


def matched_to(periods: FloatArray, pseudo: FloatArray) -> float:
    """Return the longest period at which the match to a spectrum is judged [s].

    It is 1.5 times the longest at which pseudo-velocity is half its maximum or more, at least 3 s, at most 10 s.
    """
    velocity = pseudo * periods
    longest = periods[velocity >= velocity.max() / 2].max()
    return float(min(max(3.0, 1.5 * longest), LONGEST))


def build_grid(motions: Iterable[Motion], *, has_generic: bool = False, period: float | None = None) -> Grid:
    """Return the grid of a building: as long as its longest record, and as the envelope of floors without one.

    Parameters
    ----------
    motions : iterable of Motion
        The recorded motions of all its floors.
    has_generic : bool
        Whether it has floors without a record; it has if there are no motions.
    period : float, optional
        T1 [s]; it lengthens the envelope of floors without a record.
    """
    seconds = [(motion.acceleration.size - 1) * motion.time_step for motion in motions]
    if has_generic or not seconds:
        seconds.append(sum(hold_times(period)))
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
        periods=periods,
        pseudo=response_spectrum(acceleration, grid.time_step, periods).pseudo,
        velocity_level=math.inf,
        pfa=motion.pfa,
        pfv=motion.pfv,
        envelopes=husid_envelopes(acceleration, grid.time_step),
        acceleration=acceleration,
    )


def generic_target(
    pfa: float, grid: Grid, *, pfv: float = math.nan, period: float | None = None, height: float | None = None
) -> Target:
    """Return the target of a floor of which only a peak is known.

    Parameters
    ----------
    pfa : float
        Peak floor acceleration [m/s2].
    grid : Grid
        The building's samples.
    pfv : float
        Peak floor velocity, where one is given [m/s]; the level of the long-period branch follows it.
    period, height : float, optional
        T1 of the building [s]; its height [m], by which T1 is estimated where it is unknown. With neither, the spectrum
        is that of a building of a few storeys, and unsafe for a tall one.

    Raises
    ------
    ValueError
        If a number is not above 0.
    """
    given, is_capped = (pfa, pfv, period, height), not math.isnan(pfv)
    if not all(value is None or 0 < value < math.inf for value in (pfa, pfv if is_capped else None, period, height)):
        raise ValueError(f"pfa, pfv, period and height are {given}, expected finite numbers above 0")
    from assess.motion.spectrum import build_periods

    periods = build_periods(SHORTEST, LONGEST, COUNT)
    first = period or estimate_period(height)
    return Target(
        periods=periods,
        pseudo=pfa * generic_shape(periods, first, is_estimated=period is None, falls=not is_capped),
        velocity_level=LEVEL_OF_PFV * pfv if is_capped else math.inf,
        pfa=pfa,
        pfv=pfv,
        envelopes=hold_envelopes(grid.count, grid.time_step, first),
    )


def estimate_period(height: float | None) -> float | None:
    """Return T1 [s] of a building of this height [m], by which a generic spectrum is shaped where T1 is unknown."""
    return None if height is None else CODE_FACTOR * height**CODE_POWER


def generic_shape(
    periods: FloatArray, period: float | None, *, is_estimated: bool = False, falls: bool = True
) -> FloatArray:
    """Return PSA/PFA [-], (m,), of a floor of a building with T1 [s], which may be estimated, or with T1 unknown.

    Where it `falls`, the plateau ends where pseudo-velocity is that of the resonance at T1, at 1.6 T1 but not before
    1 s, and pseudo-velocity is constant beyond (T1 unknown: AC156's slope beyond 0.77 s); else the plateau goes on, and
    a pseudo-velocity taken from a known PFV has to cap it.
    """
    rise = math.log(PLATEAU) / math.log(PLATEAU_FROM / RIGID_BELOW)
    shape = np.clip((periods / RIGID_BELOW) ** rise, 1.0, PLATEAU)
    if period is None:
        return np.where(falls & (periods > PLATEAU_TO), PLATEAU * (periods / PLATEAU_TO) ** -SLOPE, shape)
    (mode_from, mode_to), own = RESONANCES
    for first, last in ((mode_from, mode_to * (LONGER if is_estimated else 1.0)), own):
        away = np.maximum(np.log(periods / (last * period)), np.log(first * period / periods)) / math.log(RAMP)
        shape = shape * (1 + (RESONANCE / PLATEAU - 1) * np.clip(1 - away, 0.0, 1.0))
    level = max(RESONANCE * period, PLATEAU * max(period, SHORTEST_PLATEAU_END))
    return np.minimum(shape, level / periods) if falls else shape
