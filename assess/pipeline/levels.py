"""The same pieces under the same motions at several levels of shaking: every motion multiplied by a factor a level.

Draw k is one earthquake at every level: motion k, one scale for the whole building where the motion is uncertain, and
every piece as it is in that draw. The shape of the spectrum stays, and PFV scales along with PFA.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray, FloatArray
from assess.methods import Alike, Cases, Joint, Motions, Outcome, adopted_formula, simulation
from assess.methods.simulate import make_batches, rock_cases, rock_draws, run_side_by_side
from assess.motion.target_fit import measure_peaks
from assess.pipeline.adopt import adopt, build_falls, find_governing, find_ruling
from assess.pipeline.anchors import find_held
from assess.pipeline.assessment import Assessment
from assess.pipeline.either_axis import unite_axes
from assess.pipeline.verify import check_pairs, describe_work
from assess.progress import SILENT, Progress, Stage
from assess.routes.chances import Falls
from assess.settings import Settings, count_processors
from assess.units import ROUNDING

BATCH = 100
"""Motions made at once: the generator keeps its first hundred."""
MOST_OPENED = 32
"""Ensembles whose motions are kept ready from one call to the next, about 8 MB each."""


@dataclass(frozen=True, slots=True, eq=False)
class RockedLevels:
    """The cases of one ensemble at every level.

    * `own` (m,): the cases; none where the motions serve slip alone.
    * `fell` (levels, m, runs): whether each overturns; False at levels at which it was not rocked.
    * `is_weak`: whether the motions are weaker than the floor's.
    * `pfa`, `pfv`: mean peaks of the motions before any factor [m/s2], [m/s]; NaN without cases.
    """

    own: NDArray[np.intp]
    fell: BoolArray
    is_weak: bool
    pfa: float
    pfv: float


def rock_levels(
    assessment: Assessment,
    cases: Cases,
    levels: FloatArray,
    peaks: FloatArray,
    settings: Settings,
    *,
    dispersion: FloatArray | None,
    wanted: BoolArray | None = None,
    jobs: int | None = None,
    opened: dict[int, Motions] | None = None,
    progress: Progress = SILENT,
) -> list[RockedLevels]:
    """Return what the cases of each ensemble do at each level.

    Parameters
    ----------
    assessment : Assessment
        Gives the piece and the motion of each of n cases.
    cases : Cases
        Those with an ensemble are rocked.
    levels, peaks : (l,) and (n,) arrays
        Levels, and where among them the motions of each case are as they are: they are multiplied by the ratio.
    settings : Settings
        Give the number of draws, which has to be a number, and their seed.
    dispersion : (n,) array, optional
        Of the motion's amplitude [-], with pieces drawn as the cases say; None: motions and pieces as they are.
    wanted : (n, l) boolean array, optional
        At which levels each case is rocked; at all by default.
    jobs : int, optional
        Threads; they do not change a result.
    opened : dict, optional
        Motions that are ready, by the number of their ensemble; takes up to `MOST_OPENED` for further calls.
    progress : Progress
        Receives the stage "rocking".

    Raises
    ------
    CancelledError
        If the caller stops the work.
    InputError
        If the results would need too much memory.
    """
    threads, parts = jobs or count_processors(), len(cases.ensembles)
    owns = [np.flatnonzero(cases.ensemble == number) for number in range(parts)]
    check_pairs(sum(map(len, owns)), settings, levels.size)
    tasks = [(number, own) for number, own in enumerate(owns) if own.size]
    pieces = {int(assessment.case_item[case]) for own in owns for case in own}
    floors = {assessment.case_demand[own[0]].floor.floor for _, own in tasks}
    side_by_side = max(1, min(threads, len(tasks)))
    each = max(1, threads // side_by_side)
    with progress.stage("rocking", describe_work(len(pieces), len(floors)), parts) as stage:

        def work(number: int, own: NDArray[np.intp]) -> RockedLevels:
            every = np.ones((len(own), levels.size), dtype=np.bool_) if wanted is None else wanted[own]
            run = _Run(cases, own, settings, dispersion, each, stage)
            motions = opened.get(number) if opened else None
            motions = motions or cases.ensembles[number].open(each, progress)
            if opened is not None and len(opened) < MOST_OPENED:
                opened[number] = motions
            factors = np.array([_find_factor(level, peaks[own[0]]) for level in levels.tolist()])
            return run.rock(number, motions, factors, every)

        done = dict(zip((number for number, _ in tasks), run_side_by_side(work, tasks, side_by_side), strict=True))
    none = np.zeros((levels.size, 0, int(settings.runs)), dtype=np.bool_)
    return [done.get(at) or RockedLevels(own, none, False, np.nan, np.nan) for at, own in enumerate(owns)]


def _find_factor(value: float, of: float) -> float:
    """Return the factor that brings motions of one peak to another: exactly 1 where they are the same."""
    return 1.0 if abs(value / of - 1) <= ROUNDING else value / of


@dataclass(frozen=True, slots=True)
class _Run:
    """The cases `own` under the motions of one ensemble, which are made once, and scaled."""

    cases: Cases
    own: NDArray[np.intp]
    settings: Settings
    dispersion: FloatArray | None
    threads: int
    stage: Stage

    def rock(self, number: int, motions: Motions, factors: FloatArray, wanted: BoolArray) -> RockedLevels:
        runs = int(self.settings.runs)
        fell = np.zeros((len(factors), len(self.own), runs), dtype=np.bool_)
        peaks = np.empty((runs, 2))
        for at, batch, time_step in make_batches(motions, 0, runs, BATCH):
            draws = slice(at, at + len(batch))
            peaks[draws] = measure_peaks(batch, time_step)
            for level, factor in enumerate(factors.tolist()):
                rows = np.flatnonzero(wanted[:, level])
                if rows.size:
                    fell[level, rows, draws] = self._rock(self.own[rows], factor * batch, time_step, at)
            self.stage.at(draws.stop / runs, number)
        pfa, pfv = peaks.mean(axis=0).tolist()
        return RockedLevels(self.own, fell, motions.is_weak, pfa, pfv)

    def _rock(self, own: NDArray[np.intp], motions: FloatArray, time_step: float, first: int) -> BoolArray:
        """Return whether each case of `own` overturns in draws `first` and further ones, (m, k), as in a run."""
        progress = self.stage.progress
        if self.dispersion is None:
            return rock_cases(self.cases, own, motions, time_step, self.threads, progress)[0]
        fell, _ = rock_draws(
            self.cases, own, motions, time_step, first=first, dispersions=(self.dispersion[own],),
            seed=self.settings.seed, threads=self.threads, progress=progress,
        )  # fmt: skip
        return np.asarray(fell[0])


# ---------------------------------------------------------------- how pieces fall at a level


def find_falls(
    assessment: Assessment,
    cases: Cases,
    pfa: FloatArray,
    rocked: Sequence[RockedLevels],
    at: int,
    settings: Settings,
) -> Falls:
    """Return how the pieces fall at level `at` of those rocked, where case i has the PFA `pfa[i]` [m/s2].

    PFV is in proportion. What was rocked is taken as it is: nothing is unconfirmed here. A piece that was not falls by
    the formula's chance at that PFA, or not where it cannot rock. Of several motions of a piece that of the larger
    chance governs.
    """
    scaled = replace(cases, pfa=pfa, pfv=cases.pfv * pfa / cases.pfa)
    formula = adopted_formula(settings.class_by)
    outcomes = {
        formula.key: formula.evaluate(scaled, settings),
        simulation().key: _outcome(cases, [(one.own, one.fell[at]) for one in rocked]),
    }
    inventory, case_item = assessment.inventory, assessment.case_item
    adoption = adopt(outcomes, scaled, settings)
    adoption, united = unite_axes(adoption, outcomes, cases, inventory, case_item, assessment.case_demand, settings)
    governing = find_governing(adoption, case_item, find_ruling(scaled, settings))
    held = find_held(inventory, pfa[governing], cases.dispersion[governing])
    falls = build_falls(inventory, adoption, outcomes, governing, settings, united, held)
    return replace(falls, stands=np.zeros_like(held))  # the same pieces at every level


def _outcome(cases: Cases, rocked: Sequence[tuple[NDArray[np.intp], BoolArray]]) -> Outcome:
    """Return what was rocked, (m,) and (m, draws), as the outcome of a simulation, without the recorded motion."""
    count = cases.breadth.size
    value: FloatArray = np.full(count, np.nan)
    joints = []
    for number, (own, one) in enumerate(rocked):
        value[own] = Alike.of(cases.alike[own], cases.quantity[own]).average(one.sum(axis=1)) / one.shape[1]
        runs, rotation = np.full(own.size, one.shape[1]), np.zeros((0, 0), dtype=np.float32)
        joint = Joint(
            ensemble=number, cases=own, runs=runs, fell=one, ideal=one, rotation=rotation, examples=(), fit=None
        )
        joints.append(joint)
    unknown, no = np.full(count, np.nan), np.zeros(count, dtype=np.bool_)
    return Outcome(
        value,
        {
            "ideal": value,
            **dict.fromkeys(("low", "high", "ideal_low", "ideal_high", "record_overturned", "if_faster"), unknown),
        },
        dict.fromkeys(("unknown_building", "weak_motions", "fell_in_record"), no),
        tuple(joints),
    )
