"""The verification: which pieces are integrated, and under which motions."""

import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from assess.demand import Demand, Demands
from assess.ensembles import FloorEnsemble, SuiteEnsemble, build_ensembles
from assess.errors import InputError, Problem
from assess.inventory.model import Building
from assess.language import Text, fill, join
from assess.methods import Cases, Outcome
from assess.methods._method import BoolArray
from assess.methods.housner_monte_carlo import LOOKS, Tell, evaluate
from assess.rocking.block import STOCKY
from assess.settings import AUTO, Settings
from assess.units import GRAVITY

if TYPE_CHECKING:
    from assess.motion.suite import Suite


@dataclass(frozen=True, slots=True, eq=False)
class Work:
    """What is to be verified: for each ensemble the items (their places in the inventory), and the floor."""

    items: tuple[NDArray[np.intp], ...]
    floors: tuple[str, ...]

    @property
    def pieces(self) -> int:
        """Rows of furniture."""
        return len(np.unique(np.concatenate(self.items)))


MOST_PAIRS = 400_000_000
"""Results of one motion on one piece that are kept at most: they take five bytes each."""

Progress = Callable[[Work], Tell]
"""Called once with what is to be verified; returns what is called as that goes on."""


def choose_motions(
    cases: Cases,
    chosen: BoolArray,
    case_demand: tuple[Demand, ...],
    demands: Demands,
    building: Building,
    settings: Settings,
    suite: "Suite | None",
) -> Cases:
    """Return the cases with the motions under which those `chosen` (n,) that can rock are to be integrated."""
    chosen = chosen & (cases.breadth_to_height < STOCKY)
    wanted = list(dict.fromkeys(demand for demand, one in zip(case_demand, chosen, strict=True) if one))
    ensembles: tuple[FloorEnsemble, ...]
    if suite is None:
        ensembles = build_ensembles(wanted, demands, building, seed=settings.seed) if wanted else ()
    else:
        ensembles = tuple(SuiteEnsemble(demand, suite, settings.scale_motions) for demand in wanted)
    place = {demand: at for at, demand in enumerate(wanted)}
    which = [place[demand] if one else -1 for demand, one in zip(case_demand, chosen, strict=True)]
    return replace(cases, ensemble=np.array(which, dtype=np.intp), ensembles=ensembles)


def remark_suite(suite: "Suite | None", cases: Cases) -> list[Problem]:
    """Tell what was left out of the user's own motions, and which floors they are weaker than."""
    if suite is None:
        return []
    ensembles = [one for one in cases.ensembles if isinstance(one, SuiteEnsemble) and one.is_weak]
    told = [fill("Motions of the folder {folder}: {note}.", folder=suite.folder, note=note) for note in suite.notes]
    notes = [Problem("note", "", "", text) for text in told]
    return notes + [Problem("warning", "", "", _describe_weak(one), WEAK) for one in ensembles]


WEAK = fill("Verification may raise a class there, never lower it: scale them (--scale-motions), or choose others.")


def _describe_weak(one: SuiteEnsemble) -> Text:
    pfa, pfv = one.peaks
    peaks = fill("median PFA {pfa:.3f} g for {wanted:.3f} g", pfa=pfa / GRAVITY, wanted=one.demand.pfa / GRAVITY)
    if one.demand.pfv > 0:
        median, wanted = 100 * pfv, 100 * one.demand.pfv
        text = fill("median PFV {pfv:.1f} cm/s for {wanted:.1f} cm/s", pfv=median, wanted=wanted)
        peaks = join(", ", [peaks, text])
    return fill(
        "the motions of the user's own are weaker than floor '{floor}' {axis}: {peaks}.",
        floor=one.demand.floor.floor,
        axis=one.demand.axis,
        peaks=peaks,
    )


def verify(
    cases: Cases,
    case_item: NDArray[np.intp],
    case_demand: tuple[Demand, ...],
    settings: Settings,
    *,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Outcome:
    """Integrate the cases that have motions; `jobs` threads, one for each processor by default."""
    runs = LOOKS[0] if settings.runs == AUTO else int(settings.runs)
    pairs = int((cases.ensemble >= 0).sum()) * runs
    if pairs > MOST_PAIRS:
        raise InputError(
            f"--runs: {runs:,} motions of every piece are {pairs:,} results, which the memory may not hold; expected "
            f"at most {MOST_PAIRS:,}. Take fewer motions, or split the workbook"
        )
    tell = None
    if progress and cases.ensembles:
        own = [np.flatnonzero(cases.ensemble == number) for number in range(len(cases.ensembles))]
        floors = tuple(case_demand[one[0]].floor.floor for one in own)
        tell = progress(Work(tuple(case_item[one] for one in own), floors))
    return evaluate(cases, settings, threads=jobs or os.cpu_count() or 1, tell=tell)
