"""The main job: an inventory in, an assessment out."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from assess.adoption import VERIFICATION, adopt, choose_items, find_governing
from assess.demand import AXES, Demand, Demands, build_demands
from assess.errors import InputError, Problem
from assess.inventory.model import Inventory
from assess.methods import Cases, Method, all_methods
from assess.remarks import remark
from assess.results import Assessment
from assess.routes.falls import Falls, build_falls
from assess.settings import SCENARIOS, Settings
from assess.verification import Progress, choose_motions, remark_suite, verify

if TYPE_CHECKING:
    from assess.motion.suite import Suite
    from assess.routes.model import Routes
    from assess.routes.reach import Reached


def run(
    inventory: Inventory,
    settings: Settings | None = None,
    *,
    suite: "Suite | None" = None,
    methods: Sequence[Method] = (),
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Assessment:
    """Assess every piece of an inventory.

    Each piece is paired with every motion of the axis it topples along (of both axes where that is not known). The
    formulas evaluate all pairs at once; then the rocking of the pieces that `settings.verify` asks for is integrated
    under many motions of their floors. The pair of the highest adopted class governs, then the larger probability, then
    the larger PFA, then axis X.

    Parameters
    ----------
    inventory : Inventory
        From `assess.read_inventory`.
    settings : Settings, optional
        Defaults to `Settings()`.
    suite : Suite, optional
        The user's own motions, from `assess.motion.suite.read_suite`, in place of generated ones; `settings.runs` is
        their number then.
    methods : sequence of Method, optional
        Further ones, as from `assess.read_model`: they stand beside the published ones in every report,
        but no adopted risk, choice or count goes by them.
    jobs : int, optional
        Threads; as many as there are processors by default. They do not change a result.
    progress : callable, optional
        Told how far the verification is.

    Returns
    -------
    Assessment

    Raises
    ------
    WorkbookError
        If nothing that the scenario asks for serves a floor.
    InputError
        If two methods have one key or title.
    """
    every, settings = _join_methods(methods), settings or Settings()
    settings = settings if suite is None else replace(settings, runs=len(suite))
    scenario = settings.scenario or inventory.building.scenario_kind or SCENARIOS[0]
    demands = build_demands(inventory, scenario, ductility_reduction=settings.ductility_reduction)
    case_item, case_demand = _pair(inventory, demands)
    cases, reached = _cases(inventory, case_item, case_demand), _find_reached(inventory)
    outcomes = {one.key: one.evaluate(cases, settings) for one in every if one.tier == "screening"}
    chosen = choose_items(settings.verify, outcomes, case_item, _on_route(inventory, reached))
    cases = choose_motions(cases, chosen[case_item], case_demand, demands, inventory.building, settings, suite)
    outcomes[VERIFICATION] = verify(cases, case_item, case_demand, settings, jobs=jobs, progress=progress)
    adoption = adopt(outcomes, cases)
    governing = find_governing(adoption.probability, case_item, cases.pfa)
    falls = build_falls(inventory, adoption, outcomes, case_demand, governing, is_suite=suite is not None)
    told = (*remark(inventory, demands, scenario, settings.ductility_reduction), *remark_suite(suite, cases))
    return Assessment(
        inventory=inventory,
        settings=settings,
        scenario=scenario,
        suite=suite,
        demands=demands,
        methods=every,
        cases=cases,
        case_item=case_item,
        case_demand=case_demand,
        outcomes=outcomes,
        adoption=adoption,
        governing=governing,
        routes=_evaluate_routes(inventory, reached, falls, settings),
        problems=(*inventory.problems, *map(inventory.place, (*told, *_remark_routes(inventory, reached)))),
    )


def _join_methods(further: Sequence[Method]) -> tuple[Method, ...]:
    """Return the published methods and further ones, in the order of reports."""
    every = (*all_methods(), *further)
    for name in ("key", "title"):
        taken = [str(getattr(one, name)) for one in every]
        twice = [one for one in taken if taken.count(one) > 1]
        if twice:
            raise InputError(
                f"two methods have the {name} {twice[0]!r}: give each its own {name}, or name one only once."
            )
    return every


def _pair(inventory: Inventory, demands: Demands) -> tuple[NDArray[np.intp], tuple[Demand, ...]]:
    """Pair each item (its index) with every motion of its axis, or of both; those of an item stand together."""
    pairs = [
        (index, demand)
        for index, item in enumerate(inventory.items)
        for axis in ((item.axis,) if item.axis else AXES)
        for demand in demands[item.floor, axis]
    ]
    return np.array([index for index, _ in pairs], dtype=np.intp), tuple(demand for _, demand in pairs)


def _find_reached(inventory: Inventory) -> "Sequence[Reached]":
    """Return what reaches the segments; what evaluates routes is imported only where there are any."""
    if not inventory.routes:
        return ()
    from assess.routes.reach import find_reached

    return find_reached(inventory)


def _evaluate_routes(
    inventory: Inventory, reached: "Sequence[Reached]", falls: Falls, settings: Settings
) -> "Routes | None":
    if not inventory.routes:
        return None
    from assess.routes.evaluate import evaluate_routes

    return evaluate_routes(inventory, reached, falls, settings)


def _remark_routes(inventory: Inventory, reached: "Sequence[Reached]") -> Iterable[Problem]:
    if not inventory.routes:
        return ()
    from assess.routes.remarks import remark_routes

    return remark_routes(inventory, reached)


def _on_route(inventory: Inventory, reached: "Sequence[Reached]") -> NDArray[np.bool_]:
    """Tell which items name a route, or can reach one by the plan."""
    reaching = {one.item for segment in reached for one in segment.beside}
    return np.array([bool(item.route) or at in reaching for at, item in enumerate(inventory.items)], dtype=np.bool_)


def _cases(inventory: Inventory, case_item: NDArray[np.intp], case_demand: tuple[Demand, ...]) -> Cases:
    def column(values: list[float | None]) -> NDArray[np.float64]:
        return np.array(values, dtype=np.float64)

    items = [inventory.items[index] for index in case_item]
    restitution = inventory.building.restitution
    return Cases(
        breadth=column([item.breadth for item in items]),
        height=column([item.height for item in items]),
        pfa=column([demand.pfa for demand in case_demand]),
        pfv=column([demand.pfv for demand in case_demand]),
        friction=column([item.friction for item in items]),
        pfv_estimated=np.array(["pfv_estimated" in demand.flags for demand in case_demand], dtype=np.bool_),
        restitution=np.full(len(items), math.nan if restitution is None else restitution),
        ensemble=np.full(len(items), -1, dtype=np.intp),
    )
