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
from assess.pipeline.adopt import adopt, build_falls, find_governing, find_ruling, unite_axes
from assess.pipeline.anchors import find_held
from assess.pipeline.assessment import Assessment
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

    * `own` (m,): the cases; none where the motions serve slip alone, or no case is wanted.
    * `fell` (levels, m, runs): whether each overturns; False at levels at which it was not rocked.
    * `is_weak`: whether the motions are weaker than the floor's.
    * `pfa`, `pfv`: mean peaks of the motions before any factor [m/s2], [m/s]; NaN without cases.
    """

    own: NDArray[np.intp]
    fell: BoolArray
    is_weak: bool
    pfa: float
    pfv: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sweep:
    """What is rocked at several levels.

    * `cases`: those (n) of the `assessment`; those with an ensemble are rocked.
    * `peaks` (n,): where among the levels the motions of each case are as they are: they are multiplied by the ratio.
    * `settings`: give the number of draws, which has to be a number, and their seed.
    * `dispersion` (n,): of the motion's amplitude [-], with pieces drawn as the cases say; None: motions and pieces as
      they are.
    * `opened`: motions that are ready, by the number of their ensemble; takes up to `MOST_OPENED` for further calls.
    * `progress`: receives the stage "rocking".
    """

    assessment: Assessment
    cases: Cases
    peaks: FloatArray
    settings: Settings
    dispersion: FloatArray | None
    jobs: int | None = None
    opened: dict[int, Motions] | None = None
    progress: Progress = SILENT

    def rock(self, levels: FloatArray, wanted: BoolArray | None = None) -> list[RockedLevels]:
        """Return what the cases of each ensemble do at each of some levels (l,).

        `wanted` (n, l) tells at which levels each case is rocked; at all by default. Raises CancelledError if the
        caller stops the work; InputError if the results would need too much memory.
        """
        cases, assessment = self.cases, self.assessment
        every = np.ones((cases.breadth.size, levels.size), dtype=np.bool_) if wanted is None else wanted
        numbers = np.where(every.any(axis=1), cases.ensemble, -1)
        owns = [np.flatnonzero(numbers == number) for number in range(len(cases.ensembles))]
        check_pairs(sum(map(len, owns)), self.settings, levels.size)
        rocked = [number for number, own in enumerate(owns) if own.size]
        pieces = {int(assessment.case_item[case]) for own in owns for case in own}
        floors = {assessment.case_demand[owns[number][0]].floor.floor for number in rocked}
        threads = self.jobs or count_processors()
        side_by_side = max(1, min(threads, len(rocked)))
        each = max(1, threads // side_by_side)
        with self.progress.stage("rocking", describe_work(len(pieces), len(floors)), len(rocked)) as stage:

            def work(part: int, number: int) -> RockedLevels:
                motions = (self.opened or {}).get(number) or cases.ensembles[number].open(each, self.progress)
                if self.opened is not None and len(self.opened) < MOST_OPENED:
                    self.opened[number] = motions
                own = owns[number]
                peak = float(self.peaks[own[0]])  # a factor is exactly 1 at the motions as they are
                factors = [1.0 if abs(one / peak - 1) <= ROUNDING else one / peak for one in levels.tolist()]
                return self._rock(own, motions, factors, every[own], each, stage, part)

            done = dict(zip(rocked, run_side_by_side(work, list(enumerate(rocked)), side_by_side), strict=True))
        none = np.zeros((levels.size, 0, int(self.settings.runs)), dtype=np.bool_)
        return [done.get(at) or RockedLevels(own, none, False, np.nan, np.nan) for at, own in enumerate(owns)]

    def _rock(
        self, own: NDArray[np.intp], motions: Motions, factors: Sequence[float], wanted: BoolArray, threads: int,
        stage: Stage, part: int,
    ) -> RockedLevels:  # fmt: skip
        """Return what the cases `own` (m,) do under motions that are made once, and scaled."""
        runs = int(self.settings.runs)
        fell = np.zeros((len(factors), len(own), runs), dtype=np.bool_)
        peaks = np.empty((runs, 2))
        for at, batch, time_step in make_batches(motions, 0, runs, BATCH):
            draws = slice(at, at + len(batch))
            peaks[draws] = measure_peaks(batch, time_step)
            for level, factor in enumerate(factors):
                rows = np.flatnonzero(wanted[:, level])
                if not rows.size:
                    continue
                chosen, scaled = own[rows], factor * batch
                if self.dispersion is None:
                    found = rock_cases(self.cases, chosen, scaled, time_step, threads, stage.progress)[0]
                else:
                    found = rock_draws(
                        self.cases, chosen, scaled, time_step, first=at, dispersions=(self.dispersion[chosen],),
                        seed=self.settings.seed, threads=threads, progress=stage.progress,
                    )[0][0]  # fmt: skip
                fell[level, rows, draws] = found
            stage.at(draws.stop / runs, part)
        pfa, pfv = peaks.mean(axis=0).tolist()
        return RockedLevels(own, fell, motions.is_weak, pfa, pfv)

    def find_falls(self, pfa: FloatArray, rocked: Sequence[RockedLevels], at: int) -> Falls:
        """Return how the pieces fall at level `at` of those rocked, where case i has the PFA `pfa[i]` [m/s2].

        PFV is in proportion. What was rocked is taken as it is: nothing is unconfirmed here. A piece that was not falls
        by the formula's chance at that PFA, or not where it cannot rock. Of several motions of a piece that of the
        larger chance governs.
        """
        cases, settings = self.cases, self.settings
        inventory, case_item = self.assessment.inventory, self.assessment.case_item
        scaled = replace(cases, pfa=pfa, pfv=cases.pfv * pfa / cases.pfa)
        formula, count = adopted_formula(settings.class_by), cases.breadth.size
        value: FloatArray = np.full(count, np.nan)
        joints = []
        for number, level in enumerate(rocked):
            own, fell = level.own, level.fell[at]
            value[own] = Alike.of(cases.alike[own], cases.quantity[own]).average(fell.sum(axis=1)) / fell.shape[1]
            joint = Joint(
                ensemble=number, cases=own, runs=np.full(own.size, fell.shape[1]), fell=fell, ideal=fell,
                rotation=np.zeros((0, 0), dtype=np.float32), examples=(), fit=None,
            )  # fmt: skip
            joints.append(joint)
        names = ("low", "high", "ideal_low", "ideal_high", "record_overturned", "if_faster")
        detail = {"ideal": value, **dict.fromkeys(names, np.full(count, np.nan))}
        flags = dict.fromkeys(("unknown_building", "weak_motions", "fell_in_record"), np.zeros(count, dtype=np.bool_))
        outcomes = {
            formula.key: formula.evaluate(scaled, settings),
            simulation().key: Outcome(value, detail, flags, tuple(joints)),  # without the recorded motion
        }
        adoption, united = unite_axes(
            adopt(outcomes, scaled, settings), outcomes, cases, inventory, case_item, self.assessment.case_demand,
            settings,
        )  # fmt: skip
        governing = find_governing(adoption, case_item, find_ruling(scaled, settings))
        held = find_held(inventory, pfa[governing], cases.dispersion[governing])
        falls = build_falls(inventory, adoption, outcomes, governing, settings, united, held)
        return replace(falls, stands=np.zeros_like(held))  # the same pieces at every level
