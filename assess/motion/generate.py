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

from dataclasses import dataclass

import numpy as np

from assess.arrays import Single
from assess.motion.calibrate import Bench, find_corrections, find_filter
from assess.motion.noise import Signs, Transforms, draw_noise
from assess.motion.recipe import Recipe
from assess.motion.rows import GROUP, make_groups, run_rows
from assess.motion.target import Grid, Target
from assess.motion.target_fit import Fit, Spectra, measure_match
from assess.progress import SILENT, Progress

CALIBRATED = 100
"""Realisations by whose mean everything is set, a multiple of a group; further ones pass through the same steps."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Generator:
    """Makes the motions of one floor along one axis; `build_generator` finds what it holds.

    * `target`: of the floor.
    * `grid`, `seed`, `axis`, `threads`, `progress`, `signs`: as given to `build_generator`.
    * `recipe`: what turns noise into motions.
    * `made` (100, n): the first realisations [m/s2], which were made while it was found.
    * `fit`: how they meet the target.
    * `spectra`: their spectra.
    """

    target: Target
    grid: Grid
    seed: int
    axis: str
    threads: int
    progress: Progress
    recipe: Recipe
    made: Single
    fit: Fit
    spectra: Spectra
    signs: Signs | None = None

    def realise(self, first: int = 0, count: int = CALIBRATED) -> Single:
        """Return realisations `first` to `first + count - 1`: accelerations [m/s2], (count, n), in single precision.

        A realisation is the same whatever else is made with it. It has the same phases on all floors of a building but
        for the signs of those that have any.

        Raises CancelledError if the caller stops the work.
        """

        def make(group: int) -> Single:
            if group * GROUP < len(self.made):
                return self.made[group * GROUP : (group + 1) * GROUP]
            noise = draw_noise(
                self.target.envelopes, self.grid, seed=self.seed, axis=self.axis, group=group, progress=self.progress,
                signs=self.signs,
            )  # fmt: skip
            motions = np.empty((GROUP, self.grid.count), np.float32)
            self.recipe.make(noise, motions, self.progress)
            return motions

        return make_groups(make, first, count, self.grid.count, self.threads, self.progress)


def build_generator(
    target: Target,
    grid: Grid,
    *,
    seed: int,
    axis: str,
    threads: int = 1,
    progress: Progress = SILENT,
    signs: Signs | None = None,
) -> Generator:
    """Find the filter, the bending and the wavelets that make an ensemble meet its target.

    * `target`: of the floor, on the grid of its building.
    * `grid`: the building's samples.
    * `seed`: 0 or above. Phases and durations come from (seed, axis, number of the realisation) only.
    * `axis` "X" or "Y": each axis has its own phases.
    * `threads`: number of threads that share the work; it does not change a result.
    * `progress`: asked often, here and in `Generator.realise`, whether to stop.
    * `signs` (b,): of the floor, 1 or -1 by octave, from `assess.motion.floor_signs.find_signs`.

    Raises CancelledError if the caller stops the work; KeyError if the axis is not "X" or "Y".
    """
    bench = Bench(threads, progress)
    noise: list[Transforms] = [np.empty((0, 0), np.complex64)] * (CALIBRATED // GROUP)

    def draw(group: int) -> None:
        noise[group] = draw_noise(
            target.envelopes, grid, seed=seed, axis=axis, group=group, progress=progress, signs=signs
        )

    run_rows(draw, len(noise), threads, progress)
    recipe = Recipe.of(target, grid)
    recipe, motions = find_filter(target, recipe, noise, bench)
    recipe = find_corrections(target, recipe, motions, bench)
    fit, spectra = measure_match(target, motions, grid.time_step, threads, progress)
    return Generator(
        target=target, grid=grid, seed=seed, axis=axis, threads=threads, progress=progress,
        recipe=recipe, made=motions, fit=fit, spectra=spectra, signs=signs,
    )  # fmt: skip
