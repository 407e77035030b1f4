"""The main job: an inventory in, an assessment out."""

from collections.abc import Mapping

import numpy as np

from assess.demand import LOSS_TO_TELL, LOSS_TO_WARN, Demand, build_demands
from assess.errors import Problem, Severity
from assess.inventory.model import Axis, Inventory, Item
from assess.methods import Cases, all_methods
from assess.methods._method import ALIKE
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
        If a floor lacks the motion that the scenario asks for.
    """
    settings = settings or Settings()
    scenario = settings.scenario or inventory.building.scenario_kind or SCENARIOS[0]
    demands = build_demands(inventory, scenario)
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
        problems=(*inventory.problems, *_demand_problems(inventory, demands)),
    )


_BOTH: tuple[Axis, Axis] = ("X", "Y")


def _axes(item: Item) -> tuple[Axis, ...]:
    return (item.axis,) if item.axis else _BOTH


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


def _demand_problems(inventory: Inventory, demands: Mapping[tuple[str, Axis], tuple[Demand, ...]]) -> list[Problem]:
    """Say where treatment took a noticeable part of a record's own peak, and where a given PFA is not used."""
    problems = []
    for demand in (one for ones in demands.values() for one in ones if "one_axis_only" not in one.flags):
        if demand.loss > LOSS_TO_TELL:
            message = f"treatment lowers the PFA of {demand.name} from the file's {_in_g(demand, demand.loss)}."
            much = demand.loss > LOSS_TO_WARN
            mend = "If the file is corrected already, say so in it (plain CSV: # corrected: yes)." if much else ""
            problems.append(Problem("warning" if much else "note", "Floors", f"A{demand.floor.row}", message, mend))
    for floor in inventory.floors:
        for axis, pfa in floor.pfa.items():
            used = [one for one in demands[floor.floor, axis] if one.source == "record"]
            if used:
                largest = max(one.pfa for one in used)
                message = f"PFA {axis} is not used: the record serves, with {largest / GRAVITY:.3f} g."
                kind: Severity = "warning" if pfa > largest else "note"
                problems.append(Problem(kind, "Floors", f"A{floor.row}", message, "Scenario 'given' uses it."))
    return problems


def _in_g(demand: Demand, loss: float) -> str:
    before = demand.pfa / (1 - loss)
    return f"{before / GRAVITY:.3f} g to {demand.pfa / GRAVITY:.3f} g ({loss:.1%})"
