"""The main job: an inventory in, an assessment out."""

import numpy as np

from assess.demand import AXES, Demand, build_demands
from assess.inventory.model import Axis, Inventory, Item
from assess.methods import Cases, all_methods
from assess.methods._method import ALIKE
from assess.remarks import remark
from assess.results import FORMULA, Assessment
from assess.settings import SCENARIOS, Settings
from assess.units import GRAVITY


def run(inventory: Inventory, settings: Settings | None = None) -> Assessment:
    """Assess every piece of an inventory.

    Each piece is paired with every motion of the axis it topples along (of both axes where that is not known); every
    method evaluates all pairs at once; the pair with the larger adopted probability governs, then the larger PFA,
    then axis X.

    Parameters
    ----------
    inventory : Inventory
        From `assess.read_inventory`.
    settings : Settings, optional
        Defaults to `Settings()`.

    Returns
    -------
    Assessment

    Raises
    ------
    WorkbookError
        If nothing that the scenario asks for serves a floor.
    """
    settings = settings or Settings()
    scenario = settings.scenario or inventory.building.scenario_kind or SCENARIOS[0]
    demands = build_demands(inventory, scenario, ductility_reduction=settings.ductility_reduction)
    pairs = [
        (index, demand)
        for index, item in enumerate(inventory.items)
        for axis in _axes(item)
        for demand in demands[item.floor, axis]
    ]
    cases = _cases(inventory.items, pairs)
    outcomes = {method.key: method.evaluate(cases, settings) for method in all_methods()}
    case_item = np.array([index for index, _ in pairs], dtype=np.intp)
    return Assessment(
        inventory=inventory,
        settings=settings,
        scenario=scenario,
        demands=demands,
        methods=all_methods(),
        cases=cases,
        case_item=case_item,
        case_demand=tuple(demand for _, demand in pairs),
        outcomes=outcomes,
        governing=_governing(case_item, outcomes[FORMULA].value, cases.pfa),
        problems=(*inventory.problems, *remark(inventory, demands, scenario, settings.ductility_reduction)),
    )


def _axes(item: Item) -> tuple[Axis, ...]:
    return (item.axis,) if item.axis else AXES


def _cases(items: tuple[Item, ...], pairs: list[tuple[int, Demand]]) -> Cases:
    def column(values: list[float | None]) -> np.ndarray:
        return np.array(values, dtype=np.float64)

    return Cases(
        breadth=column([items[index].breadth for index, _ in pairs]),
        height=column([items[index].height for index, _ in pairs]),
        pfa=column([demand.pfa for _, demand in pairs]),
        pfv=column([demand.pfv for _, demand in pairs]),
        friction=column([items[index].friction for index, _ in pairs]),
        pfv_estimated=np.array(["pfv_estimated" in demand.flags for _, demand in pairs], dtype=np.bool_),
    )


def _governing(case_item: np.ndarray, probability: np.ndarray, pfa: np.ndarray) -> np.ndarray:
    """Index of the case that governs each item: larger probability, then larger PFA, then the first, which is X."""
    order = np.lexsort((-np.round(pfa / GRAVITY, ALIKE), -np.round(probability, ALIKE), case_item))
    first = np.searchsorted(case_item[order], np.arange(case_item[-1] + 1 if len(case_item) else 0))
    return order[first]
