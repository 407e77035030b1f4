"""The simulation: which pieces are integrated, and under which motions."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray
from assess.errors import InputError, Problem
from assess.i18n import count, fill, join
from assess.methods import Cases, Outcome, simulation
from assess.methods.simulate import LOOKS, may_slide
from assess.model import Building, Inventory
from assess.motion.assumed import RATIO_SCATTER
from assess.motion.floor_medians import SCATTER
from assess.pipeline.city_draws import number_building
from assess.pipeline.demand import Demand, Demands
from assess.pipeline.ensembles import FloorEnsemble, SuiteEnsemble, build_ensembles
from assess.progress import SILENT, Progress
from assess.rocking.draws import PEAK, Uncertainty
from assess.settings import AUTO, Settings, count_processors
from assess.units import GRAVITY

if TYPE_CHECKING:
    from assess.motion.suite import Suite


MOST_PAIRS = 400_000_000
"""Results of one motion on one piece that are kept at most: they take five bytes each."""


def find_uncertainty(building: Building) -> Uncertainty:
    """Return what is taken to be uncertain on floors with a record: what the workbook says, else the defaults.

    On other floors the dispersion of the motion is that of their `Demand`.
    """
    default, given, piece = Uncertainty(), building.motion_uncertainty, building.piece_uncertainty
    return Uncertainty(
        motion=default.motion if given is None else given, piece=default.piece if piece is None else piece
    )


def find_peak(demand: Demand) -> float:
    """Return the standard deviation of ln of the peaks of a floor's motions over its PFA [-]."""
    if demand.drawn is None:
        return PEAK
    if demand.drawn.target.meets == "medians":
        return SCATTER
    is_by_velocity = demand.drawn.target.meets == "nothing" and demand.drawn.ground.pga is None
    return RATIO_SCATTER if is_by_velocity else 0.0


def choose_motions(
    cases: Cases,
    chosen: BoolArray,
    case_demand: tuple[Demand, ...],
    demands: Demands,
    inventory: Inventory,
    settings: Settings,
    suite: "Suite | None",
) -> Cases:
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
        found.append(Problem("warning", "", "", message, WEAK))
    return found


WEAK = fill("Simulation may raise a class there, but not lower it. Scale the motions, or choose stronger ones.")


def verify(
    cases: Cases,
    case_item: NDArray[np.intp],
    case_demand: tuple[Demand, ...],
    settings: Settings,
    *,
    jobs: int | None = None,
    progress: Progress = SILENT,
) -> Outcome:
    """Integrate the cases that have motions; `jobs` threads, one for each processor by default.

    Raises CancelledError if the caller stops the work; InputError if the results would need too much memory.
    """
    check_pairs(int((cases.ensemble >= 0).sum()), settings)
    chosen = (cases.ensemble >= 0) | (cases.slides_under >= 0)
    rows = len(set(case_item[chosen].tolist()))
    floors = len({case_demand[one].floor.floor for one in np.flatnonzero(chosen)})
    evaluate, threads, parts = simulation().evaluate, jobs or count_processors(), len(cases.ensembles)
    if not rows:
        return evaluate(cases, settings)
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
            runs=runs,
            pairs=pairs,
            most=MOST_PAIRS,
        )
        fix = fill("Use fewer motions, or split the workbook.")
        if repeats > 1:
            fix = fill("Use fewer motions, fewer levels of shaking, or split the workbook.")
        raise InputError(join(" ", (fault, fix)))
