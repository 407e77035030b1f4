"""Ensembles of motions that are compatible with a target spectrum.

A realisation is white noise under the target's envelopes, passed through a filter that makes the mean spectrum of the
ensemble that of the target. Each realisation's own spectrum scatters about it as that of random phases does, which is
less than from one earthquake to another. What a filter cannot do is done in two more steps: high peaks of velocity and
of acceleration are bent, all by one rule, until their means are those of the target; then wavelets correct the
ordinates of the mean that are still off. Nothing drifts: velocity grows from zero and fades to it.

Everything is found on the first realisations; further ones pass through the same steps. The filter is found by
Gauss-Newton steps of random vibration. It is a power spectrum, straight in logarithms between the oscillators' own
frequencies. The variance of an oscillator's response is a sum over the parts of the filter, and its peak goes with the
root: so the share of each part in the variance is half the slope of the logarithm of the peak, which a step inverts for
all oscillators at once.

References
----------
Gasparini DA, Vanmarcke EH (1976). Simulated earthquake motions compatible with prescribed response spectra. MIT,
Department of Civil Engineering, R76-4 (noise filtered until its spectrum fits; peak factors, here without time).
Al Atik L, Abrahamson N (2010). An improved method for nonstationary spectral matching. Earthquake Spectra
26(3):601-617. doi:10.1193/1.3459159 (wavelets).

Departures: an envelope for each octave; one filter for all realisations, found by steps of Gauss and Newton; bending;
wavelets change the mean of the ensemble, not each motion.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d

from assess.arrays import FloatArray, Single
from assess.motion.noise import Phases, Transforms, draw_noise, find_rates
from assess.motion.recipe import Bending, Correction, Recipe, bend_to, build_wavelets, lift_rows
from assess.motion.record import CORNER
from assess.motion.rows import GROUP, make_groups, run_groups, run_rows
from assess.motion.spectrum import DAMPING
from assess.motion.sweep import Sweep
from assess.motion.target import JUDGED_FROM, Grid, Target, matched_to
from assess.motion.target_fit import Fit, Spectra, measure_match
from assess.progress import SILENT, Progress

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


ROUNDS = (40, 40, 40, 40, 100, 100)
"""Realisations made in each round of filtering: few are enough for the first steps."""
PFV_LOW, PFV_HIGH = 0.88, 1.01
"""Shares of PFV between which its mean is left [-]: sharpening adds scatter, and wavelets add 3 % where it is high."""
MOST_SHARPENED = 1.5
"""Limit of the bending of velocity and of acceleration [-]."""
LAST_PFA = 0.5
"""Sharpening of acceleration that is left to the end [-], where twice as much would do: in the rounds of filtering the
filter follows it, and peaks scatter more."""
LAST_BENT = 0.2
"""Limit of sharpening between rounds of wavelets [-]."""
TURNED = 0.7
"""Share of the bending of velocity that is changed in a round [-]."""
FAINT = 0.1
"""Weight of ordinates far beyond the periods at which the match is judged [-]."""

SHORT, LONG, REST, BEND = "short", "long", "rest", "bend"
STEPS = (
    *(SHORT, SHORT, LONG, LONG, SHORT, SHORT, BEND, LONG, LONG, SHORT, BEND),
    *(REST, REST, REST, BEND, REST, REST, REST, BEND, REST, REST, REST, BEND, REST, REST, REST, BEND),
)
"""Rounds of wavelets at periods below and above `DIVIDED`, then only about what is left; and of bending what they add
to PFA. Narrow dips take many rounds: a response that is lowered at its peak is what its next peak leaves."""
DIVIDED = 0.5
"""[s]; long periods are watched in a third of the time."""
AROUND, LEFT, ENOUGH = 3, 0.045, 0.06
"""What is left is what was off by more than the second, in logarithms, when it was last watched, and as many neighbours
on each side; nothing is where all is within the third."""
RAISED, LOWERED, MOST_CORRECTED = 0.2, 0.8, 1.4
"""Shares of the logarithm of a ratio that are applied in one round, and the ratio up to which they are [-]: what is
raised is raised, and raises its neighbours; what is lowered is what the next peak of the response leaves."""
APART = 9
"""A round takes the ordinate that is most off among this many neighbours: two would act on one cycle."""
WITHIN = 0.02
"""Ordinates this close to the target [-] are not corrected."""
NEARER, BEYOND = 1.04, 1.2
"""Ordinates are corrected from and up to these ratios beyond the periods at which the match is judged [-]."""


Run = Callable[[Callable[[slice], object], int], None]
"""`run_groups` in so many threads: calls some work with the rows of each group of motions, and asks whether to stop."""


def _shape(recipe: Recipe, noise: Sequence[Transforms], count: int, run: Run) -> tuple[Single, FloatArray]:
    """Return filtered motions (count, n) and their peaks (count, 2), as `Recipe.shape`."""
    motions, peaks = np.empty((count, recipe.grid.count), np.float32), np.empty((count, 2))

    def work(rows: slice) -> None:
        peaks[rows] = recipe.shape(noise[rows.start // GROUP], motions[rows])

    run(work, count)
    return motions, peaks


def _watch(sweep: Sweep, motions: Single, run: Run) -> tuple[Single, NDArray[np.int32], FloatArray]:
    """Return the peaks of oscillators and when they come, as `Sweep.peaks`, and the mean spectrum (m,)."""
    peaks = np.empty((len(motions), sweep.periods.size), np.float32)
    when = np.empty(peaks.shape, np.int32)

    def work(rows: slice) -> None:
        peaks[rows], when[rows] = sweep.peaks(motions[rows])

    run(work, len(motions))
    return peaks, when, np.abs(peaks).mean(axis=0, dtype=np.float64)


def find_filter(target: Target, recipe: Recipe, noise: Sequence[Transforms], run: Run) -> tuple[Recipe, Single]:
    """Return the recipe with filter and bending, and its motions, from the groups of `noise` by which it is set."""
    places, grid, frequencies = choose_periods(target), recipe.grid, find_rates(recipe.grid).frequencies
    periods, wanted = target.periods[places], target.pseudo[places]
    weight = np.where(periods > BEYOND**2 * matched_to(periods, wanted), FAINT, 1.0)
    matrix, sweep = response_matrix(periods, grid.time_step), Sweep.of(periods, grid.time_step, grid.count)
    power = guess_power(matrix, periods, wanted)
    for number, size in enumerate(ROUNDS):
        recipe = replace(recipe, gains=gains_of(power, periods, frequencies))
        motions, peaks = _shape(recipe, noise, size, run)
        if number == 0:  # the level first: only then can peaks be judged, and nothing has been bent by them yet
            ratio = float(np.median(wanted / _watch(sweep, motions, run)[2]))
            motions, peaks, power = motions * np.float32(ratio), peaks * ratio, power * ratio**2
        _bend(motions, peaks[:, 1], target.pfa, run, is_last=False)
        power = improve(matrix, power, np.log(wanted / _watch(sweep, motions, run)[2]), weight)
        by_pfv = bend_to(peaks[:, 0], target.pfv, MOST_SHARPENED, PFV_LOW, PFV_HIGH)
        recipe = replace(recipe, by_pfv=recipe.by_pfv + TURNED * (by_pfv - recipe.by_pfv))
    recipe = replace(recipe, gains=gains_of(power, periods, frequencies))
    motions, peaks = _shape(recipe, noise, GROUP * len(noise), run)
    bending = _bend(motions, peaks[:, 1], target.pfa, run)
    return replace(recipe, steps=(bending,)), motions


def _bend(
    motions: Single, peaks: FloatArray, pfa: float, run: Run, *, most: float = MOST_SHARPENED, is_last: bool = True
) -> Bending:
    """Bend motions (k, n) with these PFA (k,) in place so that their mean is met; return how."""
    by_pfa = bend_to(peaks, pfa, most)
    if not is_last:
        by_pfa = min(by_pfa, max(2 * (by_pfa - LAST_PFA), 0.0))
    bending = Bending(pfa, by_pfa)
    run(lambda rows: bending.apply(motions[rows]), len(motions))
    return bending


def find_corrections(target: Target, recipe: Recipe, motions: Single, run: Run) -> Recipe:
    """Correct the mean spectrum and PFA of `motions` (k, n), in place; return the recipe with what was done."""
    periods, sweep = target.periods, Sweep.of(target.periods, recipe.grid.time_step, recipe.grid.count)
    near = (periods > JUDGED_FROM / NEARER) & (periods < BEYOND * matched_to(periods, target.pseudo))
    errors = np.zeros(periods.size)
    found: list[Bending | Correction] = []
    for kind in STEPS:
        if kind == BEND:
            found.append(_bend(motions, np.abs(motions).max(axis=1).astype(float), target.pfa, run, most=LAST_BENT))
            continue
        if kind == REST and np.abs(errors).max() < ENOUGH:
            continue
        is_left = maximum_filter1d(np.abs(errors), 2 * AROUND + 1, mode="nearest") > LEFT
        watched = np.flatnonzero(near & (is_left if kind == REST else (periods < DIVIDED) == (kind == SHORT)))
        if watched.size:
            found += _correct(target, recipe.grid, motions, run, sweep, watched, errors)
    recipe = replace(recipe, steps=recipe.steps + tuple(found))
    recipe = replace(recipe, lift=target.pfa / float(np.abs(motions).max(axis=1).mean(dtype=float)))
    run(lambda rows: lift_rows(motions[rows], recipe.lift), len(motions))
    return recipe


def _correct(
    target: Target, grid: Grid, motions: Single, run: Run, sweep: Sweep, places: NDArray[np.int64],
    errors: FloatArray,
) -> list[Correction]:  # fmt: skip
    """Correct the ordinates of motions (k, n) that are most off among their neighbours, in place; none may be.

    `places` of the target's periods (m,), those of `sweep`, are watched. `errors` (m,), the logarithms by which the
    mean spectrum was off when it was last watched, are renewed there; those of periods that are not judged stay 0.
    """
    peaks, when, mean = _watch(sweep.take(places), motions, run)
    errors[places] = np.log(target.pseudo[places] / mean)
    off = np.zeros(errors.size)
    off[places] = np.abs(errors[places])
    chosen = np.flatnonzero((off > WITHIN) & (off == maximum_filter1d(off, APART, mode="nearest")))
    if not chosen.size:
        return []
    most, own = np.log(MOST_CORRECTED), np.searchsorted(places, chosen)
    applied = np.where(errors[chosen] > 0, RAISED, LOWERED)
    correction = Correction(
        wavelets=build_wavelets(tuple(target.periods), grid.time_step), places=chosen,
        shares=np.expm1(np.clip(applied * errors[chosen], -most, most)).astype(np.float32), sweep=sweep.take(chosen),
    )  # fmt: skip
    run(lambda rows: correction.add(motions[rows], peaks[rows, own], when[rows, own]), len(motions))
    return [correction]


CALIBRATED = 100
"""Realisations by whose mean everything is set, a multiple of a group; further ones pass through the same steps."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Generator:
    """Makes the motions of one floor along one axis; `build_generator` finds what it holds.

    `made` (100, n) are the first realisations [m/s2], made while the recipe was found; `fit` and `spectra` are theirs.
    """

    target: Target
    phases: Phases
    threads: int
    progress: Progress
    recipe: Recipe
    made: Single
    fit: Fit
    spectra: Spectra

    def realise(self, first: int = 0, count: int = CALIBRATED) -> Single:
        """Return realisations `first` to `first + count - 1`: accelerations [m/s2], (count, n), in single precision.

        A realisation is the same whatever else is made with it. It has the same phases on all floors of a building but
        for the signs of those that have any. Raises CancelledError if the caller stops the work.
        """

        def make(group: int) -> Single:
            if group * GROUP < len(self.made):
                return self.made[group * GROUP : (group + 1) * GROUP]
            noise = draw_noise(self.target.envelopes, self.phases, group, self.progress)
            motions = np.empty((GROUP, self.phases.grid.count), np.float32)
            self.recipe.shape(noise, motions)
            for step in self.recipe.steps:
                self.progress.check()
                step.apply(motions)
            lift_rows(motions, self.recipe.lift)
            return motions

        return make_groups(make, first, count, self.phases.grid.count, self.threads, self.progress)


def build_generator(
    target: Target,
    grid: Grid,
    *,
    seed: int,
    axis: str,
    threads: int = 1,
    progress: Progress = SILENT,
    signs: tuple[int, ...] | None = None,
) -> Generator:
    """Find the filter, the bending and the wavelets that make an ensemble meet its target.

    * `target`: of the floor, on the grid of its building.
    * `grid`, `seed`, `axis`, `signs`: as of `assess.motion.noise.Phases`, with its errors.
    * `threads`: that share the work; they do not change a result.
    * `progress`: asked often, here and in `Generator.realise`, whether to stop; CancelledError then.
    """
    phases = Phases(grid, seed, axis, signs)
    run = partial(run_groups, threads=threads, progress=progress)
    noise: list[Transforms] = [np.empty((0, 0), np.complex64)] * (CALIBRATED // GROUP)

    def draw(group: int) -> None:
        noise[group] = draw_noise(target.envelopes, phases, group, progress)

    run_rows(draw, len(noise), threads, progress)
    recipe = Recipe(grid, np.ones(find_rates(grid).frequencies.size, np.float32), target.pfv)  # with no filter yet
    recipe, motions = find_filter(target, recipe, noise, run)
    recipe = find_corrections(target, recipe, motions, run)
    fit, spectra = measure_match(target, motions, grid.time_step, threads, progress)
    return Generator(
        target=target, phases=phases, threads=threads, progress=progress,
        recipe=recipe, made=motions, fit=fit, spectra=spectra,
    )  # fmt: skip
