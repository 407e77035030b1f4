"""The simulation: which pieces are integrated, and under which motions; at several levels of shaking, too.

At a level every motion is multiplied by a factor. Draw k is one earthquake at every level: motion k, one scale for the
whole building where the motion is uncertain, and every piece as it is in that draw. The shape of the spectrum stays,
and PFV scales along with PFA.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray, FloatArray
from assess.errors import InputError, Problem
from assess.i18n import count, fill, join
from assess.methods import Alike, Cases, Joint, Motions, Outcome, adopted_formula, simulation
from assess.methods.simulate import LOOKS, make_batches, may_slide, rock_cases, rock_draws, run_side_by_side
from assess.methods.verdicts import Verdicts
from assess.model import Inventory
from assess.motion.assumed import RATIO_SCATTER
from assess.motion.floor_medians import SCATTER
from assess.motion.target_fit import measure_peaks
from assess.pipeline.adopt import Assessment, adopt, build_falls, find_governing, find_ruling, list_mobile, unite_axes
from assess.pipeline.anchors import find_held
from assess.pipeline.city_draws import number_building
from assess.pipeline.demand import Demand, Demands
from assess.pipeline.ensembles import FloorEnsemble, SuiteEnsemble, build_ensembles
from assess.progress import SILENT, Progress, Stage
from assess.rocking.draws import PEAK
from assess.routes.chances import Falls
from assess.settings import AUTO, Settings, count_processors
from assess.units import GRAVITY, ROUNDING

if TYPE_CHECKING:
    from assess.motion.suite import Suite

MOST_PAIRS = 400_000_000
"""Results of one motion on one piece that are kept at most: they take five bytes each."""


def find_peak(demand: Demand) -> float:
    """Return the standard deviation of ln of the peaks of a floor's motions over its PFA [-]."""
    if demand.drawn is None:
        return PEAK
    if demand.drawn.target.meets == "medians":
        return SCATTER
    is_by_velocity = demand.drawn.target.meets == "nothing" and demand.drawn.ground.pga is None
    return RATIO_SCATTER if is_by_velocity else 0.0


def choose_motions(
    cases: Cases, chosen: BoolArray, case_demand: tuple[Demand, ...], demands: Demands, inventory: Inventory,
    settings: Settings, suite: "Suite | None",
) -> Cases:  # fmt: skip
    """Return the cases with the motions under which those `chosen` (n,) that can rock are to be integrated.

    Those that may slide, too stocky ones too, are to slide under the same. In a city every building is drawn
    otherwise.
    """
    rocks, slides = chosen & ~cases.is_stocky, chosen & may_slide(cases, settings)
    used = rocks | slides
    wanted = list(dict.fromkeys(demand for demand, one in zip(case_demand, used, strict=True) if one))
    ensembles: tuple[FloorEnsemble, ...]
    if suite is None:
        number, building = number_building(inventory, settings), inventory.building
        ensembles = build_ensembles(wanted, demands, building, seed=settings.seed, number=number) if wanted else ()
    else:
        ensembles = tuple(SuiteEnsemble(demand, suite, settings.scale_motions, settings.scale) for demand in wanted)
    place = {demand: at for at, demand in enumerate(wanted)}
    which = np.array([place.get(demand, -1) for demand in case_demand], dtype=np.intp)
    own, under = (np.where(chosen, which, -1) for chosen in (rocks, slides))
    return replace(cases, ensemble=own, slides_under=under, ensembles=ensembles)


def remark_suite(suite: "Suite | None", cases: Cases) -> list[Problem]:
    """Return what was left out of the user's own motions, and the floors for which they are too weak."""
    if suite is None:
        return []
    texts = (fill("Motions of the folder {folder}: {note}.", folder=suite.folder, note=note) for note in suite.notes)
    found = [Problem("note", "", "", text) for text in texts]
    for one in (one for one in cases.ensembles if isinstance(one, SuiteEnsemble) and one.is_weak):
        demand, (pfa, pfv) = one.demand, one.peaks
        peaks = fill("median PFA {pfa:.3f} g for {wanted:.3f} g", pfa=pfa / GRAVITY, wanted=demand.pfa / GRAVITY)
        if demand.pfv > 0:
            median, wanted = 100 * pfv, 100 * demand.pfv
            text = fill("median PFV {pfv:.1f} cm/s for {wanted:.1f} cm/s", pfv=median, wanted=wanted)
            peaks = join(", ", [peaks, text])
        message = fill(
            "the user's own motions are weaker than floor '{floor}' {axis}: {peaks}.",
            floor=demand.floor.floor, axis=demand.axis, peaks=peaks,
        )  # fmt: skip
        fix = fill("Simulation may raise a class there, but not lower it. Scale the motions, or choose stronger ones.")
        found.append(Problem("warning", "", "", message, fix))
    return found


def verify(
    cases: Cases, case_item: NDArray[np.intp], case_demand: tuple[Demand, ...], settings: Settings, *,
    jobs: int | None = None, progress: Progress = SILENT, verdicts: Verdicts | None = None,
) -> Outcome:  # fmt: skip
    """Integrate the cases that have motions, or find them in `verdicts`; `jobs` threads, one for each processor.

    Raises CancelledError if the caller stops the work; InputError if the results would need too much memory.
    """
    check_pairs(int((cases.ensemble >= 0).sum()), settings)
    chosen = (cases.ensemble >= 0) | (cases.slides_under >= 0)
    rows = len(set(case_item[chosen].tolist()))
    floors = len({case_demand[one].floor.floor for one in np.flatnonzero(chosen)})
    evaluate, threads, parts = simulation().evaluate, jobs or count_processors(), len(cases.ensembles)
    if not rows or verdicts is not None:
        return evaluate(cases, settings, verdicts=verdicts)
    with progress.stage("verification", describe_work(rows, floors), parts) as stage:
        return evaluate(cases, settings, threads=threads, stage=stage)


def describe_work(rows: int, floors: int) -> str:
    """Return what is simulated in words: ``121 rows on 4 floors``."""
    return f"{count(rows, 'row')} on {count(floors, 'floor')}"


def check_pairs(cases: int, settings: Settings, repeats: int = 1) -> None:
    """Raise InputError where the results of `cases` under every motion, `repeats` times, may not fit into memory."""
    runs = LOOKS[0] if settings.runs == AUTO else int(settings.runs)
    pairs = cases * runs * repeats
    if pairs > MOST_PAIRS:
        fault = fill(
            "runs is {runs:,}: {pairs:,} results of one motion on one piece may exceed the available memory; expected "
            "at most {most:,}.",
            runs=runs, pairs=pairs, most=MOST_PAIRS,
        )  # fmt: skip
        fix = fill("Use fewer motions, or split the workbook.")
        if repeats > 1:
            fix = fill("Use fewer motions, fewer levels of shaking, or split the workbook.")
        raise InputError(join(" ", (fault, fix)))


# ---------------------------------------------------------------- at several levels of shaking

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

        `wanted` (n, l) marks the levels at which each case is rocked; at all by default. Raises CancelledError if the
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
        adoption = adopt(outcomes, scaled, settings, list_mobile(inventory)[case_item])
        adoption, united = unite_axes(
            adoption, outcomes, cases, inventory, case_item, self.assessment.case_demand, settings
        )
        governing = find_governing(adoption, case_item, find_ruling(scaled, settings))
        held = find_held(inventory, pfa[governing], cases.dispersion[governing])
        falls = build_falls(inventory, adoption, outcomes, governing, settings, united, held)
        return replace(falls, stands=np.zeros_like(held))  # the same pieces at every level
