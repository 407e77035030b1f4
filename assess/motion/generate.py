"""Ensembles of motions that are compatible with a target spectrum.

A realisation is white noise under the target's envelopes, passed through a filter that makes the mean spectrum of the
ensemble that of the target. Each realisation's own spectrum scatters about it as the noise does, which keeps the
variability from record to record. What a filter cannot do is done in two more steps: high peaks of velocity and of
acceleration are bent, all by one rule, until their means are those of the target; then wavelets correct the
ordinates of the mean that are still off. `tight` corrects those of each realisation instead, and fixes its PFA, which
hides variability.
Nothing drifts: velocity grows from zero and fades to it.

Filtering noise until its spectrum fits: Gasparini DA, Vanmarcke EH (1976). Simulated earthquake motions compatible with
prescribed response spectra. MIT, Department of Civil Engineering, R76-4. The envelope of each octave, the bending and
the wavelets on the mean are of this program.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from assess.motion.bending import Bend, bend_row, build_taper, lift_peaks, settle
from assess.motion.envelope import draw_noise, filter_frequencies, filter_length
from assess.motion.record import CORNER, FloatArray
from assess.motion.rows import run_rows, transform_rows
from assess.motion.spectrum import pseudo_acceleration
from assess.motion.target import JUDGED_FROM, Grid, Target, matched_to
from assess.motion.target_fit import Fit, Spectra, measure_match
from assess.motion.wavelets import Wavelets, adjust, build_wavelets
from assess.progress import SILENT, Progress

CALIBRATED = 100
"""Realisations by whose mean everything is set; further ones pass through the same steps."""
FILTERINGS, CORRECTIONS, TIGHT_CORRECTIONS = 12, 20, 30
"""Rounds of filtering, and of wavelets."""
FILTERED, CORRECTED = 0.8, 0.6
"""Share of the logarithm of a ratio that is applied in one round [-]."""
APART = 7
"""A round of wavelets takes the ordinate that is most off among this many neighbours: two would act on one cycle."""
WITHIN = 0.02
"""Ordinates this close to the target [-] are not corrected."""
BEYOND = 1.2
"""Ordinates are corrected up to this ratio beyond the periods at which the match is judged [-]."""
MOST_CORRECTED = 1.3
"""Ratio up to which a round corrects an ordinate [-]."""
LIFTED = 0.1
"""What all rounds together lift at most of the PFA of a generic floor [-]: its spectrum may not allow more."""
ROLL_OFF = 8
"""Order with which the filter falls off below the corner of the records' own treatment."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Generator:
    """Makes the motions of one floor along one axis; `build_generator` finds what it holds.

    Parameters
    ----------
    target, grid, seed, axis, is_tight, threads, progress
        As given to `build_generator`.
    gains : (f,) array
        The filter [-].
    bend : Bend
        How peaks are bent.
    corrections : tuple of ((m,) array, float)
        Rounds of wavelets: ratios of the spectrum, and of PFA [-]; none where each realisation has its own.
    scale : float
        Factor on the whole motion [-]; other than 1 only where a generic spectrum and its PFA disagree.
    made : (100, n) array, optional
        The first realisations [m/s2], which were made while it was found.
    fit : Fit, optional
        How they meet the target.
    spectra : Spectra, optional
        Their spectra.
    """

    target: Target
    grid: Grid
    seed: int
    axis: str
    is_tight: bool
    threads: int
    gains: FloatArray
    bend: Bend
    corrections: tuple[tuple[FloatArray, float], ...] = ()
    scale: float = 1.0
    made: FloatArray | None = None
    fit: Fit | None = None
    spectra: Spectra | None = None
    progress: Progress = SILENT

    def realise(self, first: int = 0, count: int = CALIBRATED) -> FloatArray:
        """Return realisations `first` to `first + count - 1`: accelerations [m/s2], (count, n).

        A realisation is the same whatever else is made with it, and has the same phases on all floors of a building.
        """
        if self.made is not None and first + count <= len(self.made):
            return self.made[first : first + count].copy()
        motions = [
            self._batch(start, min(CALIBRATED, first + count - start))
            for start in range(first, first + count, CALIBRATED)
        ]
        return np.concatenate(motions)

    def _noise(self, first: int, count: int) -> NDArray[np.complex128]:
        return draw_noise(
            self.target.envelopes, self.grid.time_step, seed=self.seed, axis=self.axis,
            first=first, count=count, threads=self.threads, progress=self.progress,
        )  # fmt: skip

    def _batch(self, first: int, count: int) -> FloatArray:
        motions, _ = _synthesise(self._noise(first, count), self)
        wavelets = build_wavelets(self.target.periods, self.grid.time_step)
        for ratios, lift in self.corrections:
            _correct(motions, np.broadcast_to(ratios, (count, ratios.size)), wavelets, self)
            lift_peaks(motions, np.full(count, lift), self.threads, self.progress)
        if self.is_tight:
            _tighten(motions, self)
        return self.scale * motions


def build_generator(
    target: Target,
    grid: Grid,
    *,
    seed: int,
    axis: str,
    is_tight: bool = False,
    threads: int = 1,
    progress: Progress = SILENT,
) -> Generator:
    """Find the filter, the bending and the wavelets that make an ensemble meet its target.

    Parameters
    ----------
    target : Target
        Of the floor, on the grid of its building.
    grid : Grid
        The building's samples.
    seed : int
        0 or above. Phases and durations come from (seed, axis, number of the realisation) only.
    axis : "X" or "Y"
        Each axis has its own phases.
    is_tight : bool
        Match each realisation on its own, which hides the variability from record to record.
    threads : int
        Number of threads that share the work; it does not change a result.
    progress : Progress
        Asked often, here and in `Generator.realise`, whether to stop.

    Raises
    ------
    CancelledError
        If the caller stops the work.
    """
    start = Generator(
        target=target, grid=grid, seed=seed, axis=axis, is_tight=is_tight, threads=threads, progress=progress,
        gains=_first_gains(target, grid), bend=Bend(),
    )  # fmt: skip
    generator, motions = _find_filter(start._noise(0, CALIBRATED), start)
    if is_tight:
        _tighten(motions, generator)
    else:
        generator = replace(generator, corrections=_find_corrections(motions, generator))
    if target.is_generic:
        scale = target.pfa / float(np.abs(motions).max(axis=1).mean())
        generator, motions = replace(generator, scale=scale), scale * motions
    fit, spectra = measure_match(generator.target, motions, grid.time_step, threads, progress)
    return replace(generator, made=motions, fit=fit, spectra=spectra)


def _first_gains(target: Target, grid: Grid) -> FloatArray:
    """Return gains in proportion to the target's pseudo-velocity, falling off below the corner of the records'."""
    frequencies = filter_frequencies(grid.count, grid.time_step)
    pseudo = target.capped(target.velocity_level)
    gains = np.exp(_over_frequency(frequencies, target.periods, np.log(pseudo * target.periods)))
    fall = 1 / np.sqrt(1 + (CORNER / np.maximum(frequencies, 1e-9)) ** ROLL_OFF)
    return np.asarray(gains * np.where(frequencies > 0, fall, 0.0))


def _over_frequency(frequencies: FloatArray, periods: FloatArray, values: FloatArray) -> FloatArray:
    places = np.log(np.maximum(frequencies, 1e-9))
    return np.interp(places, -np.log(periods[::-1]), values[::-1])


def _find_filter(noise: NDArray[np.complex128], generator: Generator) -> tuple[Generator, FloatArray]:
    """Return the generator with gains, bend and the spectrum to match, and the motions that it makes of `noise`."""
    target, grid = generator.target, generator.grid
    frequencies = filter_frequencies(grid.count, grid.time_step)
    level = target.velocity_level
    for number in range(FILTERINGS + 1):
        motions, peaks = _synthesise(noise, generator)
        pseudo = target.capped(level)
        if number == FILTERINGS:
            break
        mean = _pseudo(motions, generator).mean(axis=0)
        errors = np.log(pseudo / mean)
        if number == 0:  # the level alone: only then can peaks be judged by it
            generator = replace(generator, gains=generator.gains * math.exp(float(np.median(errors))))
            continue
        pfa_error, pfv_error = (
            math.log(wanted / got) if wanted > 0 else 0.0
            for wanted, got in zip((target.pfa, target.pfv), peaks.mean(axis=0), strict=True)
        )
        if target.is_generic:
            level *= math.exp(FILTERED * pfv_error)
            pfv_error = 0.0
        gains = generator.gains * np.exp(FILTERED * _over_frequency(frequencies, target.periods, errors))
        generator = replace(generator, gains=gains, bend=generator.bend.turned(pfv_error, pfa_error))
    return replace(generator, target=replace(target, pseudo=pseudo, velocity_level=level)), motions


def _pseudo(motions: FloatArray, generator: Generator) -> FloatArray:
    """Return the pseudo-acceleration [m/s2] of each motion at the target's periods, (k, m)."""
    periods, step = generator.target.periods, generator.grid.time_step
    return pseudo_acceleration(motions, step, periods, threads=generator.threads, progress=generator.progress)


def _synthesise(noise: NDArray[np.complex128], generator: Generator) -> tuple[FloatArray, FloatArray]:
    """Return filtered, bent and tapered motions [m/s2], (k, n), and their PFA [m/s2] and PFV [m/s], (k, 2)."""
    from scipy.fft import irfft

    grid, target, bend, threads = generator.grid, generator.target, generator.bend, generator.threads
    length = filter_length(grid.count, grid.time_step)
    frequencies = filter_frequencies(grid.count, grid.time_step)
    filtered = noise * generator.gains
    generator.progress.check()
    acceleration = transform_rows(irfft, filtered, length, threads, generator.progress)
    integrated = filtered / (2j * np.pi * np.maximum(frequencies, 1e-9))
    velocity = transform_rows(irfft, integrated, length, threads, generator.progress)
    taper, slope = build_taper(grid)
    motions, peaks = np.empty((len(noise), grid.count)), np.empty((len(noise), 2))
    pfv = target.pfv if target.pfv > 0 else 1.0  # not bent where it is unknown

    def finish(row: int) -> None:
        bend_row(
            acceleration[row], velocity[row], taper, slope, grid.time_step, target.pfa, pfv,
            bend.acceleration, bend.velocity, motions[row], peaks[row],
        )  # fmt: skip

    run_rows(finish, len(noise), threads, generator.progress)
    return motions, peaks


def _find_corrections(motions: FloatArray, generator: Generator) -> tuple[tuple[FloatArray, float], ...]:
    """Correct the mean spectrum of `motions` and their mean PFA, in place; return the rounds."""
    target, grid = generator.target, generator.grid
    wavelets = build_wavelets(target.periods, grid.time_step)
    found: list[tuple[FloatArray, float]] = []
    for _ in range(CORRECTIONS):
        mean = _pseudo(motions, generator).mean(axis=0)
        ratios = _worst(target.pseudo / mean, target)
        _correct(motions, np.broadcast_to(ratios, (len(motions), mean.size)), wavelets, generator)
        lift = target.pfa / float(np.abs(motions).max(axis=1).mean())
        if target.is_generic:
            applied = math.prod(one for _, one in found)
            lift = min(max(lift, (1 - LIFTED) / applied), (1 + LIFTED) / applied)
        lift_peaks(motions, np.full(len(motions), lift), generator.threads, generator.progress)
        found.append((ratios, lift))
    return tuple(found)


def _worst(wanted: FloatArray, target: Target) -> FloatArray:
    """Return what a round corrects of the ratios wanted, (..., m): the ordinates most off among their neighbours."""
    from scipy.ndimage import maximum_filter1d

    periods, longest = target.periods, matched_to(target.periods, target.pseudo)
    off = np.where((periods > JUDGED_FROM / BEYOND) & (periods < longest * BEYOND), np.abs(np.log(wanted)), 0.0)
    return np.where(
        (off > WITHIN) & (off == maximum_filter1d(off, APART, axis=-1)),
        np.clip(wanted**CORRECTED, 1 / MOST_CORRECTED, MOST_CORRECTED),
        1.0,
    )


def _correct(motions: FloatArray, ratios: FloatArray, wavelets: Wavelets, generator: Generator) -> None:
    def correct_row(row: int) -> None:
        adjust(motions[row], ratios[row], wavelets.samples, wavelets.start, wavelets.peak, wavelets.at, wavelets.step)
        settle(motions[row], motions[row].sum())

    run_rows(correct_row, len(motions), generator.threads, generator.progress)


def _tighten(motions: FloatArray, generator: Generator) -> None:
    """Correct each motion's own spectrum and PFA, in place."""
    target, grid = generator.target, generator.grid
    wavelets = build_wavelets(target.periods, grid.time_step)
    for _ in range(TIGHT_CORRECTIONS):
        own = _pseudo(motions, generator)
        _correct(motions, _worst(target.pseudo / own, target), wavelets, generator)
        lift_peaks(motions, target.pfa / np.abs(motions).max(axis=1), generator.threads, generator.progress)
