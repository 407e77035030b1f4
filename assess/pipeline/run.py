"""The main job: an inventory in, results out."""

import math
import tempfile
import weakref
from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from assess.delivery.folders import make_folder, remove_folder
from assess.errors import InputError, OutputError
from assess.i18n import fill
from assess.methods import NO_WALL, SIDE_UNKNOWN, Cases, Method, all_methods, simulation
from assess.methods.verdicts import Verdicts
from assess.model import AXES, Inventory
from assess.pipeline.adopt import (
    UNCONFIRMED,
    Assessment,
    adopt,
    choose_items,
    find_governing,
    find_ruling,
    list_mobile,
    unite_axes,
)
from assess.pipeline.anchors import anchor_first, anchor_named, find_held, find_spread, spell_names
from assess.pipeline.city_draws import check_draws, find_earthquakes, number_pieces
from assess.pipeline.demand import Demand, Demands, build_demands, scale_demands
from assess.pipeline.remarks import remark
from assess.pipeline.schedule import build_schedule, list_entries
from assess.pipeline.series import build_series, write_series
from assess.pipeline.tables import add_annual, build_rows, list_demands
from assess.pipeline.verify import choose_motions, find_peak, remark_suite, verify
from assess.progress import SILENT, Listener, Progress
from assess.results import Results
from assess.rocking.draws import Uncertainty
from assess.route_results import RouteTables
from assess.routes.walls import find_walls, remark_on_walls
from assess.settings import CLASS_BY, SCENARIOS, Settings, change_settings

if TYPE_CHECKING:
    from assess.motion.suite import Suite
    from assess.routes.evaluate import KeptRoutes
    from assess.routes.obstructions import Obstructions

NO_SERIES = Path("no-series")
"""The name of a folder that does not exist, where no series are wanted."""


def run(
    inventory: "Inventory | str | Path",
    settings: Settings | None = None,
    *,
    suite: "Suite | None" = None,
    methods: Sequence[Method] = (),
    jobs: int | None = None,
    figures: bool = True,
    series_folder: "str | Path | None" = None,
    progress: "Progress | Listener | None" = None,
    cancel: Event | None = None,
    **options: Any,
) -> Results:
    """Assess every piece of an inventory.

    Each piece is paired with every motion of the axis it topples along (of both axes where that is not known). The
    formulas evaluate all pairs at once; then the rocking of the pieces that `settings.verify` asks for is integrated
    under many motions of their floors. The pair of the highest adopted class governs, then the larger probability, then
    the larger peak that rules the formula (PFV; PFA by the paper's), then axis X.

    * `inventory`: from `assess.read_inventory`, or a workbook, which is read.
    * `settings`: defaults to `Settings()`.
    * `suite`: the user's own motions, from `assess.motion.suite.read_suite`, in place of generated ones;
      `settings.runs` is their number then.
    * `methods`: further ones, as from `assess.read_model`: reports show them next to the published ones, but no adopted
      risk, choice or count goes by them.
    * `jobs`: threads; as many as there are processors by default. They do not change a result.
    * `figures`: whether the series of figures and the outcomes of every motion are kept, in one file. Without them
      reports leave their figures out; json and csv need none.
    * `series_folder`: where the file of series for figures is written; a temporary folder by default, which is removed
      with the results.
    * `progress`: notified of how far the work is: a callable gets an `assess.progress.Report`.
    * `cancel`: stops the work within half a second once it is set.
    * `**options`: settings by their names, which change `settings`: ``run("office.xlsx", verify="none")``.

    Returns
    -------
    Results

    Raises WorkbookError if the workbook cannot be read, or nothing that the scenario asks for serves a floor;
    InputError if a setting is not one of those allowed, or two methods have one key or title; OutputError if the series
    cannot be written; CancelledError if `cancel` was set.
    """
    progress = Progress.of(progress, cancel)
    if isinstance(inventory, str | Path):
        from assess.workbook.read import read_inventory

        inventory = read_inventory(inventory, progress=progress)
    settings = change_settings(settings, options)
    assessment = compute(inventory, settings, suite=suite, methods=methods, jobs=jobs, progress=progress)
    return build_results(assessment, figures=figures, series_folder=series_folder, progress=progress)


def compute(
    inventory: Inventory, settings: Settings, *, suite: "Suite | None" = None, methods: Sequence[Method] = (),
    jobs: int | None = None, progress: Progress = SILENT, verdicts: Verdicts | None = None,
) -> Assessment:  # fmt: skip
    """Return the arrays of a run; parameters and errors are those of `run`.

    With `verdicts` nothing is rocked: a piece of which they know all motions is simulated, any other goes by the
    formula until it is; `Assessment.lacking` tells which cases are to be rocked.
    """
    every = (*all_methods(), *methods)  # in the order of reports
    for name in (fill("key"), fill("title")):
        taken = [str(getattr(one, name)) for one in every]
        twice = [one for one in taken if taken.count(one) > 1]
        if twice:
            raise InputError.about("two methods have the {name} {text!r}: give each its own, or name one only once.",
                     name=name, text=twice[0])  # fmt: skip
    class_by = settings.class_by or inventory.building.class_by or CLASS_BY[0]
    settings = change_settings(settings, {"class_by": class_by} | ({} if suite is None else {"runs": len(suite)}))
    check_draws(inventory, settings)
    if isinstance(settings.anchor, tuple):
        names = spell_names(inventory, settings.anchor)
        settings, inventory = replace(settings, anchor=names), anchor_named(inventory, names)
    assessment = progress.wait_for(lambda: _compute(inventory, settings, suite, every, jobs, progress, verdicts))
    if isinstance(settings.anchor, int):
        schedule = build_results(assessment, figures=False, progress=progress).schedule
        assessment = anchor_first(assessment, schedule.rows)
    if inventory.hazard is None:
        return assessment
    from assess.pipeline.annual import evaluate_annual

    found = progress.wait_for(lambda: evaluate_annual(assessment, jobs=jobs, progress=progress))
    return replace(assessment, annual=found)


def _compute(
    inventory: Inventory, settings: Settings, suite: "Suite | None", every: tuple[Method, ...], jobs: int | None,
    progress: Progress, verdicts: Verdicts | None,
) -> Assessment:  # fmt: skip
    scenario = settings.scenario or inventory.building.scenario_kind or SCENARIOS[0]
    filled = build_demands(inventory, scenario, ductility_reduction=settings.ductility_reduction, progress=progress)
    demands = scale_demands(filled, settings.scale)
    obstructions: Sequence[Obstructions] = ()
    of_routes = list(remark_on_walls(inventory))
    if inventory.routes:  # imported only where there are any
        from assess.routes.evaluate import find_unfurnished
        from assess.routes.obstructions import find_obstructions, find_route_problems

        obstructions = find_obstructions(inventory, progress)
        of_routes += [*find_route_problems(inventory, obstructions), *find_unfurnished(inventory)]
    reaching = {one.item_index for segment in obstructions for one in segment.pieces}
    on_route = np.array([bool(one.route) or at in reaching for at, one in enumerate(inventory.items)], dtype=np.bool_)
    case_item, case_demand, cases = _pair(inventory, demands, settings)
    outcomes = {one.key: one.evaluate(cases, settings) for one in every if one.tier == "screening"}
    chosen = choose_items(settings.verify, every, outcomes, case_item, on_route)
    cases = choose_motions(cases, chosen[case_item], case_demand, demands, inventory, settings, suite)
    lacking = None
    if verdicts is not None:
        is_open = (cases.ensemble >= 0) & ~verdicts.find_known(cases, settings)
        waits = np.zeros(len(inventory.items), dtype=np.bool_)
        waits[case_item[is_open]] = True
        lacking = replace(cases, ensemble=np.where(is_open, cases.ensemble, -1))
        cases = replace(cases, ensemble=np.where(waits[case_item], -1, cases.ensemble))
    simulated = verify(cases, case_item, case_demand, settings, jobs=jobs, progress=progress, verdicts=verdicts)
    outcomes[simulation().key] = simulated
    adoption = adopt(outcomes, cases, settings, list_mobile(inventory)[case_item])
    adoption, both = unite_axes(adoption, outcomes, cases, inventory, case_item, case_demand, settings)
    governing = find_governing(adoption, case_item, find_ruling(cases, settings))
    is_unconfirmed = (adoption.basis == UNCONFIRMED) & simulated.flags["unknown_building"]
    remarks = [
        *remark(inventory, filled, scenario, {inventory.items[int(at)].floor for at in case_item[is_unconfirmed]}),
        *remark_suite(suite, cases),
        *of_routes,
    ]
    return Assessment(
        inventory=inventory, settings=settings, scenario=scenario, suite=suite, filled=filled, demands=demands,
        methods=every, cases=cases, case_item=case_item, case_demand=case_demand, outcomes=outcomes, adoption=adoption,
        either_axis=both, governing=governing,
        held=find_held(inventory, cases.pfa[governing], find_spread(cases)[governing]), obstructions=obstructions,
        problems=(*inventory.problems, *map(inventory.place, remarks)), lacking=lacking,
    )  # fmt: skip


def build_results(
    assessment: Assessment, *, figures: bool = True, series_folder: "str | Path | None" = None,
    progress: Progress = SILENT, routes: RouteTables | None = None, kept: "KeptRoutes | None" = None,
) -> Results:  # fmt: skip
    """Return the tables of a run; `routes` where they are known, `kept` their rows; the rest is as of `run`."""
    demands, is_temporary = list_demands(assessment), figures and series_folder is None
    if series_folder is not None:
        folder = Path(series_folder)
    else:
        folder = make_folder(Path(tempfile.gettempdir()), "assess-") if figures else NO_SERIES

    def build() -> Results:
        found = evaluate_route_tables(assessment, progress) if routes is None else routes
        results = build_rows(assessment, demands, folder, found)
        schedule = build_schedule(
            results, assessment.inventory, lambda held: evaluate_route_tables(assessment, progress, held, kept)
        )
        return replace(results, schedule=schedule)

    try:
        results = progress.wait_for(build)
        if figures:
            arrays = progress.wait_for(lambda: build_series(assessment, demands, results, progress))
            path = results.series.path
            try:
                path.parent.mkdir(parents=True, exist_ok=True)
                write_series(path, arrays, progress)
            except OSError as error:
                why = error.strerror or str(error)
                raise OutputError.about("{path} cannot be written: {why}.", path=path, why=why) from None
    except BaseException:
        if is_temporary:
            remove_folder(folder)
        raise
    if is_temporary:
        weakref.finalize(results, remove_folder, folder)
    return results


def list_first_fixes(assessment: Assessment, routes: RouteTables) -> list[list[int]]:
    """Return the pieces (indices) of each entry of the schedule, in its order, without what comes of them."""
    results = build_rows(assessment, list_demands(assessment), NO_SERIES, routes)
    return [[one.item.index for one in entry] for entry in list_entries(tuple(results), routes.routes)]


def _pair(
    inventory: Inventory, demands: Demands, settings: Settings
) -> tuple[NDArray[np.intp], tuple[Demand, ...], Cases]:
    """Pair each item (its index) with every motion of its axis, or of both; those of an item stand together.

    Alike are cases of one floor motion and of all that is computed with of a piece but its name.
    """
    pairs = [
        (index, item, demand)
        for index, item in enumerate(inventory.items)
        for axis in ((item.axis,) if item.axis else AXES)
        for demand in demands[item.floor, axis]
    ]
    items, case_demand = [item for _, item, _ in pairs], tuple(demand for _, _, demand in pairs)
    found, building, count = find_walls(inventory), inventory.building, len(pairs)
    walls = [found[at].sense(one.axis) or SIDE_UNKNOWN if at in found else NO_WALL for at, _, one in pairs]
    friction = [inventory.friction_of(item) for item in items]
    kinds = [
        (demand, wall, item.breadth, item.height, item.centre_of_gravity, item.is_scanned, mu)
        for item, demand, wall, mu in zip(items, case_demand, walls, friction, strict=True)
    ]
    numbers = {kind: at for at, kind in enumerate(dict.fromkeys(kinds))}
    shaken = inventory if any(one.site for one in case_demand) else replace(inventory, site_ground=None)
    names = number_pieces(inventory, settings)
    given = {"motion": building.motion_uncertainty, "piece": building.piece_uncertainty}
    drawn: dict[str, Any] = {name: one for name, one in given.items() if one is not None}

    def column(values: Iterable[Any], kind: type = np.float64) -> NDArray[Any]:
        return np.array(list(values), dtype=kind)

    cases = Cases(
        breadth=column(item.breadth for item in items),
        height=column(item.height for item in items),
        pfa=column(demand.pfa for demand in case_demand),
        pfv=column(demand.pfv for demand in case_demand),
        friction=column(friction),
        restitution=np.full(count, math.nan if building.restitution is None else building.restitution),
        ensemble=np.full(count, -1, dtype=np.intp),
        centre=column(item.centre_of_gravity for item in items),
        name=column((names[item.item] for item in items), np.int64),
        scanned=column((item.is_scanned for item in items), np.bool_),
        slides_under=np.full(count, -1, dtype=np.intp),
        alike=column((numbers[kind] for kind in kinds), np.intp),
        quantity=column((item.quantity for item in items), np.int64),
        wall=column(walls, np.int8),
        dispersion=column(demand.dispersion for demand in case_demand),
        peak=column(map(find_peak, case_demand)),
        uncertainty=Uncertainty(**drawn),
        earthquakes=find_earthquakes(shaken, settings),
    )
    return column((at for at, _, _ in pairs), np.intp), case_demand, cases


def evaluate_route_tables(
    assessment: Assessment, progress: Progress, held: Collection[int] = (), kept: "KeptRoutes | None" = None
) -> RouteTables:
    """Return the routes, with further pieces (indices) held; `kept` holds the rows of an evaluation before."""
    inventory, settings = assessment.inventory, assessment.settings
    if not inventory.routes:
        return RouteTables(risk=settings.route_risk)
    from assess.routes.evaluate import evaluate_routes

    falls = assessment.find_falls(held)
    found = evaluate_routes(inventory, assessment.obstructions, falls, settings, progress=progress, kept=kept)
    return found if assessment.annual is None or held else add_annual(found, assessment.annual.ways)
