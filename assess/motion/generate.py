"""Ensembles of motions that are compatible with a target spectrum.

A realisation is white noise under the target's envelopes, passed through a filter that makes the mean spectrum of the
ensemble that of the target. Each realisation's own spectrum scatters about it as that of random phases does, which is
less than from one earthquake to another. What a filter cannot do is done in two more steps: high peaks of velocity and
of acceleration are bent, all by one rule, until their means are those of the target; then wavelets correct the
ordinates of the mean that are still off. Nothing drifts: velocity grows from zero and fades to it.

Everything is found on the first realisations; further ones pass through the same steps.

References
----------
Gasparini DA, Vanmarcke EH (1976). Simulated earthquake motions compatible with prescribed response spectra. MIT,
Department of Civil Engineering, R76-4 (noise filtered until its spectrum fits).
Al Atik L, Abrahamson N (2010). An improved method for nonstationary spectral matching. Earthquake Spectra
26(3):601-617. doi:10.1193/1.3459159 (wavelets).

Departures: an envelope for each octave; one filter for all realisations, found by steps of Gauss and Newton; bending;
wavelets change the mean of the ensemble, not each motion.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from assess.motion.bending import MOST_BENT, bend_rows, bend_to, build_taper, lift_rows, shape_rows
from assess.motion.filtering import choose_periods, gains_of, guess_power, improve, response_matrix
from assess.motion.noise import Transforms, draw_noise, find_rates
from assess.motion.record import FloatArray
from assess.motion.rows import GROUP, run_groups, run_rows
from assess.motion.sweep import Single, Sweep
from assess.motion.target import JUDGED_FROM, Grid, Target, matched_to
from assess.motion.target_fit import Fit, Spectra, measure_match
from assess.motion.wavelets import Correction, build_wavelets
from assess.progress import SILENT, Progress

CALIBRATED = 100
"""Realisations by whose mean everything is set."""
import os
ROUNDS = eval(os.environ.get("ROUNDS","(40, 60, 100, 100)"))
"""Realisations that are made in each round of filtering: few suffice for the first steps."""
SHARPENED = 1.2
MOST_PFA=float(os.environ.get("MOST_PFA","-0.15"))
LAST_PFA=0.5
PFV_LOW, PFV_HIGH = 0.95, 0.98
TURNED = 0.7
CORRECTIONS = os.environ.get("MEND","sslllsssllsssllssll")
CORRECTED = 0.7
MOST_CORRECTED = 1.4
APART = int(os.environ.get("APART","9"))
WITHIN = 0.02
BEYOND = 1.2
LONG = 0.5
LIFTED = 0.1
HALF=int(os.environ.get("HALF","100"))
NHALF=int(os.environ.get("NHALF","0"))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Generator:
    target: Target
    grid: Grid
    seed: int
    axis: str
    threads: int
    progress: Progress = SILENT
    gains: Single
    by_pfv: float = 0.0
    by_pfa: float = 0.0
    corrections: tuple[Correction, ...] = ()
    lift: float = 1.0
    scale: float = 1.0
    made: Single | None = None
    fit: Fit | None = None
    spectra: Spectra | None = None

    def realise(self, first: int = 0, count: int = CALIBRATED) -> Single:
        start, end = first // GROUP, -(-(first + count) // GROUP)
        motions = np.empty(((end - start) * GROUP, self.grid.count), np.float32)

        def work(at: int) -> None:
            rows = slice(at * GROUP, (at + 1) * GROUP)
            number = (start + at) * GROUP
            if self.made is not None and number < len(self.made):
                motions[rows] = self.made[number : number + GROUP]
            else:
                self._make(start + at, motions[rows])

        run_rows(work, end - start, self.threads, self.progress)
        return motions[first - start * GROUP :][:count]

    def draw(self, group: int) -> Transforms:
        return draw_noise(
            self.target.envelopes, self.grid, seed=self.seed, axis=self.axis, group=group, progress=self.progress
        )

    def _make(self, group: int, motions: Single) -> None:
        self.shape(self.draw(group), motions)
        for one in self.corrections:
            self.progress.check()
            one.apply(motions, *one.sweep.peaks(motions))
        lift_rows(motions, self.lift, self.scale)

    def shape(self, noise: Transforms, motions: Single) -> FloatArray:
        from scipy.fft import irfft

        taper, slope = build_taper(self.grid)
        acceleration = irfft(noise * self.gains, find_rates(self.grid).length, axis=1, overwrite_x=True)
        self.progress.check()
        peaks = np.empty((len(noise), 2))
        pfv = self.target.pfv if self.target.pfv > 0 else 1.0
        shape_rows(
            acceleration, taper.astype(np.float32), slope.astype(np.float32), self.grid.time_step, pfv, self.by_pfv,
            motions, peaks,
        )  # fmt: skip
        bend_rows(motions, self.target.pfa, self.by_pfa)
        return peaks


def build_generator(
    target: Target, grid: Grid, *, seed: int, axis: str, threads: int = 1, progress: Progress = SILENT
) -> Generator:
    start = Generator(
        target=target, grid=grid, seed=seed, axis=axis, threads=threads, progress=progress,
        gains=np.zeros(0, np.float32),
    )  # fmt: skip
    noise: list[Transforms] = [np.zeros((0, 0), np.complex64)] * (CALIBRATED // GROUP)

    def draw(group: int) -> None:
        noise[group] = start.draw(group)

    run_rows(draw, len(noise), threads, progress)
    generator, motions, level = _find_filter(noise, start)
    generator = _correct(motions, generator)
    fit, spectra = measure_match(generator.target, motions, grid.time_step, threads, progress)
    return replace(generator, made=motions, fit=fit, spectra=spectra)


def _shape_all(noise, generator, count):
    motions, peaks = np.empty((count, generator.grid.count), np.float32), np.empty((count, 2))

    def work(rows: slice) -> None:
        peaks[rows] = generator.shape(noise[rows.start // GROUP], motions[rows])

    run_groups(work, count, generator.threads, generator.progress)
    return motions, peaks


def _mean(sweep: Sweep, motions: Single, generator: Generator):
    out = np.empty((len(motions), sweep.periods.size), np.float32)

    def work(rows: slice) -> None:
        out[rows] = sweep.spectra(motions[rows])

    run_groups(work, len(motions), generator.threads, generator.progress)
    return out.mean(axis=0, dtype=float)


def _find_filter(noise, generator):
    target, grid = generator.target, generator.grid
    level, at = target.velocity_level, choose_periods(target)
    periods = target.periods[at]
    sweep, frequencies = Sweep.of(periods, grid.time_step), find_rates(grid).frequencies
    matrix = response_matrix(periods, grid.time_step)
    wanted = target.capped(level)[at]
    weight = np.where(periods > BEYOND**2 * matched_to(periods, wanted), 0.1, 1.0)
    power = guess_power(matrix, periods, wanted, weight)
    for number, size in enumerate((*ROUNDS, CALIBRATED)):
        generator = replace(generator, gains=gains_of(power, periods, frequencies))
        if number == 0:
            generator = replace(generator, by_pfa=0.0)
        motions, peaks = _shape_all(noise, generator, size)
        if number == 0:
            ratio = np.median(wanted / _mean(sweep, motions, generator))
            power = power * ratio**2
            generator = replace(generator, gains=gains_of(power, periods, frequencies))
            motions, peaks = motions*np.float32(ratio), peaks*ratio
        by_pfa = bend_to(peaks[:, 1], target.pfa, MOST_PFA if number < len(ROUNDS) else LAST_PFA, )
        if number < len(ROUNDS): by_pfa=max(by_pfa, -0.5)
        bend_rows(motions, target.pfa, by_pfa)
        if number == len(ROUNDS):
            generator = replace(generator, by_pfa=by_pfa)
            break
        power = improve(matrix, power, np.log(wanted / _mean(sweep, motions, generator)), weight)
        if target.is_generic and target.pfv > 0:
            level *= (target.pfv / peaks[:, 0].mean()) ** 0.8
            wanted = target.capped(level)[at]
        elif target.pfv > 0:
            turned = bend_to(peaks[:, 0], target.pfv, SHARPENED, PFV_LOW, PFV_HIGH)
            generator = replace(generator, by_pfv=generator.by_pfv + TURNED * (turned - generator.by_pfv))
    pseudo = target.capped(level)
    return replace(generator, target=replace(target, pseudo=pseudo, velocity_level=level)), motions, level


def _correct(motions, generator):
    target, grid = generator.target, generator.grid
    longest = matched_to(target.periods, target.pseudo)
    near = (target.periods > JUDGED_FROM / BEYOND) & (target.periods < longest * BEYOND)
    wavelets = build_wavelets(tuple(target.periods), grid.time_step)
    parts = {"s": np.flatnonzero(near & (target.periods < LONG)), "l": np.flatnonzero(near & (target.periods >= LONG)), "a": np.flatnonzero(near)}
    sweeps = {k: Sweep.of(target.periods[places], grid.time_step) for k, places in parts.items()}
    found = []
    for number, letter in enumerate(CORRECTIONS):
        places, sweep = parts[letter], sweeps[letter]
        peaks = np.empty((len(motions), places.size), np.float32)
        when = np.empty(peaks.shape, np.int32)
        part = motions[:HALF] if number < NHALF else motions

        def watch(rows: slice) -> None:
            peaks[rows], when[rows] = sweep.peaks(motions[rows])

        run_groups(watch, len(part), generator.threads, generator.progress)
        errors = np.log(target.pseudo[places] / np.abs(peaks[:len(part)]).mean(axis=0, dtype=float))
        chosen = _worst(errors)
        if not chosen.size:
            continue
        shares = np.exp(np.clip(CORRECTED * errors[chosen], -np.log(MOST_CORRECTED), np.log(MOST_CORRECTED))) - 1
        one = Correction(
            wavelets, places[chosen], shares.astype(np.float32), Sweep.of(target.periods[places[chosen]], grid.time_step)
        )

        def apply(rows: slice) -> None:
            if rows.start < len(part):
                one.apply(motions[rows], peaks[rows, chosen], when[rows, chosen])
            else:
                one.apply(motions[rows], *one.sweep.peaks(motions[rows]))

        run_groups(apply, len(motions), generator.threads, generator.progress)
        found.append(one)
    lift = target.pfa / float(np.abs(motions).max(axis=1).mean())
    scale = 1.0
    if target.is_generic:
        scale, lift = lift / min(max(lift, 1 - LIFTED), 1 + LIFTED), min(max(lift, 1 - LIFTED), 1 + LIFTED)
    run_groups(lambda rows: lift_rows(motions[rows], lift, scale), len(motions), generator.threads, generator.progress)
    return replace(generator, corrections=tuple(found), lift=lift, scale=scale)


def _worst(errors):
    from scipy.ndimage import maximum_filter1d

    off = np.abs(errors)
    return np.flatnonzero((off > WITHIN) & (off == maximum_filter1d(off, APART)))
