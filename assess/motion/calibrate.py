"""How the recipe of an ensemble is found on its first realisations: the filter, the bending and the wavelets."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from assess.motion.bending import bend_to
from assess.motion.filtering import choose_periods, gains_of, guess_power, improve, response_matrix
from assess.motion.noise import Transforms, find_rates
from assess.motion.record import FloatArray
from assess.motion.recipe import Bending, Recipe
from assess.motion.rows import GROUP, run_groups
from assess.motion.sweep import Single, Sweep
from assess.motion.target import JUDGED_FROM, Target, matched_to
from assess.motion.wavelets import Correction, build_wavelets
from assess.progress import Progress

ROUNDS = (40, 40, 40, 40, 100, 100)
"""Realisations made in each round of filtering: few are enough for the first steps."""
PFV_LOW, PFV_HIGH = 0.88, 1.01
"""Shares of PFV between which its mean is left [-]: sharpening adds scatter, and wavelets add 3 % where it is high."""
MOST_SHARPENED, MOST_PFA = 1.2, 0.0
"""Limits of the bending of velocity, and of acceleration in the rounds of filtering [-]: sharper peaks scatter more, and
the filter would follow them."""
LAST_PFA = 0.5
"""Limit of the bending of acceleration afterwards [-]."""
TURNED = 0.7
"""Share of the bending of velocity that is changed in a round [-]."""
LEVELLED = 0.8
"""Share of the logarithm by which PFV is missed that the cap of a generic spectrum is changed by in a round [-]."""
FAINT = 0.1
"""Weight of ordinates far beyond the periods at which the match is judged [-]."""

SHORT, LONG, BEND = "short", "long", "bend"
STEPS = (
    *(SHORT, SHORT, LONG, LONG, LONG, SHORT, SHORT, BEND),
    *(LONG, LONG, SHORT, SHORT, SHORT, BEND),
    *(LONG, LONG, SHORT, SHORT, LONG, LONG, SHORT, SHORT, BEND),
)
"""Rounds of wavelets at periods below and above `DIVIDED`, and of bending what they add to PFA."""
DIVIDED = 0.5
"""[s]; long periods are watched in a fifth of the time."""
CORRECTED, MOST_CORRECTED = 0.7, 1.4
"""Share of the logarithm of a ratio that is applied in one round, and the ratio up to which it is [-]."""
APART = 9
"""A round takes the ordinate that is most off among this many neighbours: two would act on one cycle."""
WITHIN = 0.02
"""Ordinates this close to the target [-] are not corrected."""
BEYOND = 1.2
"""Ordinates are corrected up to this ratio beyond the periods at which the match is judged [-]."""
LIFTED = 0.1
"""What the PFA of a generic floor is lifted at most [-]: its spectrum may not allow more."""


@dataclass(frozen=True, slots=True)
class Bench:
    """Where the work is done: in how many threads, and whether to stop."""

    threads: int
    progress: Progress

    def run(self, work: Callable[[slice], object], count: int) -> None:
        """Call `work` with the rows of each group of `count` motions."""
        run_groups(work, count, self.threads, self.progress)

    def shape(self, recipe: Recipe, noise: Sequence[Transforms], count: int) -> tuple[Single, FloatArray]:
        """Return filtered motions (count, n) and their peaks (count, 2), as `Recipe.shape`."""
        motions, peaks = np.empty((count, recipe.grid.count), np.float32), np.empty((count, 2))

        def work(rows: slice) -> None:
            peaks[rows] = recipe.shape(noise[rows.start // GROUP], motions[rows])

        self.run(work, count)
        return motions, peaks

    def watch(self, sweep: Sweep, motions: Single) -> tuple[Single, NDArray[np.int32]]:
        """Return the peaks of oscillators and when they come, as `Sweep.peaks`."""
        peaks = np.empty((len(motions), sweep.periods.size), np.float32)
        when = np.empty(peaks.shape, np.int32)

        def work(rows: slice) -> None:
            peaks[rows], when[rows] = sweep.peaks(motions[rows])

        self.run(work, len(motions))
        return peaks, when

    def mean(self, sweep: Sweep, motions: Single) -> FloatArray:
        """Return the mean spectrum of motions (k, n), (m,)."""
        return np.asarray(np.abs(self.watch(sweep, motions)[0]).mean(axis=0, dtype=np.float64))


@dataclass(frozen=True, slots=True, eq=False)
class Filtering:
    """What the rounds of filtering match: `wanted` (m,) [m/s2] at `periods` (m,) [s], each with its weight."""

    target: Target
    places: NDArray[np.int64]
    periods: FloatArray
    weight: FloatArray
    matrix: FloatArray
    sweep: Sweep
    frequencies: FloatArray

    @classmethod
    def of(cls, target: Target, recipe: Recipe) -> "Filtering":
        """Return it for a target on the grid of a recipe."""
        places, step = choose_periods(target), recipe.grid.time_step
        periods = target.periods[places]
        farthest = BEYOND**2 * matched_to(periods, target.capped(target.velocity_level)[places])
        return cls(
            target=target, places=places, periods=periods, weight=np.where(periods > farthest, FAINT, 1.0),
            matrix=response_matrix(periods, step), sweep=Sweep.of(periods, step),
            frequencies=find_rates(recipe.grid).frequencies,
        )  # fmt: skip

    def wanted(self, level: float) -> FloatArray:
        """Return the ordinates to match, with pseudo-velocity kept to `level` [m/s]."""
        return self.target.capped(level)[self.places]

    def gains(self, power: FloatArray) -> Single:
        """Return the filter of this power (m,)."""
        return gains_of(power, self.periods, self.frequencies)


def find_filter(
    target: Target, recipe: Recipe, noise: Sequence[Transforms], bench: Bench
) -> tuple[Target, Recipe, Single]:
    """Return the target with the spectrum that can be had, the recipe with filter and bending, and all its motions.

    `noise` holds the groups of the realisations by which everything is set.
    """
    work, level = Filtering.of(target, recipe), target.velocity_level
    power = guess_power(work.matrix, work.periods, work.wanted(level))
    recipe = replace(recipe, gains=work.gains(power))
    power = power * _level(work, recipe, noise, bench) ** 2
    for size in ROUNDS:
        recipe = replace(recipe, gains=work.gains(power))
        motions, peaks = bench.shape(recipe, noise, size)
        _bend(motions, peaks[:, 1], target.pfa, MOST_PFA, bench)
        error = np.log(work.wanted(level) / bench.mean(work.sweep, motions))
        power = improve(work.matrix, power, error, work.weight)
        if target.is_generic and target.pfv > 0:
            level *= float(target.pfv / peaks[:, 0].mean()) ** LEVELLED
        elif target.pfv > 0:
            wanted = bend_to(peaks[:, 0], target.pfv, MOST_SHARPENED, PFV_LOW, PFV_HIGH)
            recipe = replace(recipe, by_pfv=recipe.by_pfv + TURNED * (wanted - recipe.by_pfv))
    recipe = replace(recipe, gains=work.gains(power))
    motions, peaks = bench.shape(recipe, noise, GROUP * len(noise))
    bending = _bend(motions, peaks[:, 1], target.pfa, LAST_PFA, bench)
    target = replace(target, pseudo=target.capped(level), velocity_level=level)
    return target, replace(recipe, steps=(bending,)), motions


def _level(work: Filtering, recipe: Recipe, noise: Sequence[Transforms], bench: Bench) -> float:
    """Return the factor by which motions of a first filter meet the spectrum: only then can peaks be judged by it."""
    motions, _ = bench.shape(replace(recipe, by_pfv=0.0), noise, ROUNDS[0])
    return float(np.median(work.wanted(work.target.velocity_level) / bench.mean(work.sweep, motions)))


def _bend(motions: Single, peaks: FloatArray, pfa: float, most: float, bench: Bench) -> Bending:
    """Bend motions (k, n) with these PFA (k,) in place so that their mean is met; return how."""
    bending = Bending(pfa, bend_to(peaks, pfa, most))
    bench.run(lambda rows: bending.apply(motions[rows]), len(motions))
    return bending


def find_corrections(target: Target, recipe: Recipe, motions: Single, bench: Bench) -> Recipe:
    """Correct the mean spectrum and PFA of `motions` (k, n), in place; return the recipe with what was done."""
    farthest = BEYOND * matched_to(target.periods, target.pseudo)
    near = (target.periods > JUDGED_FROM / BEYOND) & (target.periods < farthest)
    is_short = target.periods < DIVIDED
    places = {SHORT: np.flatnonzero(near & is_short), LONG: np.flatnonzero(near & ~is_short)}
    step = recipe.grid.time_step
    sweeps = {kind: Sweep.of(target.periods[own], step) for kind, own in places.items()}
    found: list[Bending | Correction] = []
    for kind in STEPS:
        if kind == BEND:
            found.append(_bend(motions, _pfa(motions), target.pfa, LAST_PFA, bench))
        else:
            found.extend(_correct(target, places[kind], sweeps[kind], motions, bench))
    recipe = replace(recipe, steps=recipe.steps + tuple(found))
    lift = target.pfa / float(_pfa(motions).mean())
    if target.is_generic:
        lift, scale = float(np.clip(lift, 1 - LIFTED, 1 + LIFTED)), lift / float(np.clip(lift, 1 - LIFTED, 1 + LIFTED))
        recipe = replace(recipe, scale=scale)
    recipe = replace(recipe, lift=lift)
    bench.run(lambda rows: recipe.finish(motions[rows]), len(motions))
    return recipe


def _pfa(motions: Single) -> FloatArray:
    return np.maximum(motions.max(axis=1), -motions.min(axis=1)).astype(np.float64)


def _correct(
    target: Target, places: NDArray[np.int64], sweep: Sweep, motions: Single, bench: Bench
) -> list[Correction]:
    """Correct the ordinates at `places` that are most off among their neighbours; none may be."""
    peaks, when = bench.watch(sweep, motions)
    errors = np.log(target.pseudo[places] / np.abs(peaks).mean(axis=0, dtype=np.float64))
    chosen = _worst(errors)
    if not chosen.size:
        return []
    most = np.log(MOST_CORRECTED)
    shares = np.expm1(np.clip(CORRECTED * errors[chosen], -most, most)).astype(np.float32)
    step = sweep.time_step
    wavelets = build_wavelets(tuple(target.periods), step)
    correction = Correction(wavelets, places[chosen], shares, Sweep.of(sweep.periods[chosen], step))
    bench.run(lambda rows: correction.add(motions[rows], peaks[rows, chosen], when[rows, chosen]), len(motions))
    return [correction]


def _worst(errors: FloatArray) -> NDArray[np.int64]:
    """Return where logarithms of ratios (m,) are most off among their neighbours."""
    from scipy.ndimage import maximum_filter1d

    off = np.abs(errors)
    return np.flatnonzero((off > WITHIN) & (off == maximum_filter1d(off, APART)))
