"""The verification: which pieces are integrated, and under which motions."""

import os
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from assess.demand import Demand, Demands
from assess.ensembles import FloorEnsemble, SuiteEnsemble, build_ensembles
from assess.inventory.model import Building
from assess.methods import Cases, Outcome
from assess.methods._method import BoolArray
from assess.methods.housner_monte_carlo import Tell, evaluate
from assess.motion.suite import Suite
from assess.settings import Settings


@dataclass(frozen=True, slots=True, eq=False)
class Work:
    """What is to be verified: for each ensemble the items (their places in the inventory), and the floor."""

    items: tuple[NDArray[np.intp], ...]
    floors: tuple[str, ...]

    @property
    def pieces(self) -> int:
        """Rows of furniture."""
        return len(np.unique(np.concatenate(self.items)))


Progress = Callable[[Work], Tell]
"""Called once with what is to be verified; returns what is called as that goes on."""


def choose_motions(
    cases: Cases,
    chosen: BoolArray,
    case_demand: tuple[Demand, ...],
    demands: Demands,
    building: Building,
    settings: Settings,
    suite: Suite | None,
) -> Cases:
    """Return the cases with the motions under which those `chosen` (n,) are to be integrated."""
    wanted = list(dict.fromkeys(demand for demand, one in zip(case_demand, chosen, strict=True) if one))
    ensembles: tuple[FloorEnsemble, ...]
    if suite is None:
        ensembles = build_ensembles(wanted, demands, building, seed=settings.seed) if wanted else ()
    else:
        ensembles = tuple(SuiteEnsemble(demand, suite, settings.scale_motions) for demand in wanted)
    place = {demand: at for at, demand in enumerate(wanted)}
    which = [place[demand] if one else -1 for demand, one in zip(case_demand, chosen, strict=True)]
    return replace(cases, ensemble=np.array(which, dtype=np.intp), ensembles=ensembles)


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
    tell = None
    if progress and cases.ensembles:
        own = [np.flatnonzero(cases.ensemble == number) for number in range(len(cases.ensembles))]
        floors = tuple(case_demand[one[0]].floor.floor for one in own)
        tell = progress(Work(tuple(case_item[one] for one in own), floors))
    return evaluate(cases, settings, threads=jobs or os.cpu_count() or 1, tell=tell)
