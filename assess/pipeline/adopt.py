"""The adopted risk: that of the formula, or that of the simulation where it ran and its motions are reliable.

A class that simulation lowers is marked. Where the motions follow a generic spectrum or are weaker than the floor's, or
PFV is an estimate, simulation may raise a class, but not lower it. A piece that overturns under the record itself is at
least high.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from assess.methods import Cases, Method, Outcome, adopted_formula, simulation
from assess.methods._method import ALIKE, BoolArray, FloatArray
from assess.model import Inventory
from assess.pipeline.demand import Demand
from assess.risk import RiskClass, classify_all
from assess.routes.chances import Falls
from assess.units import GRAVITY

IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Adoption:
    """The adopted risk of n cases.

    Parameters
    ----------
    probability : (n,) array
        [-]
    low, high : (n,) arrays
        The interval of a simulated risk [-]; NaN where the formula's is adopted.
    risk, upper : (n,) integer arrays
        Class by the probability, and by the upper end of the interval.
    verified : (n,) boolean array
        Whether it is that of the simulation.
    doubtful : (n,) boolean array
        Where simulation may not lower a class.
    not_lowered : (n,) boolean array
        Where simulation gave a lower class, which is not adopted.
    """

    probability: FloatArray
    low: FloatArray
    high: FloatArray
    risk: IntArray
    upper: IntArray
    verified: BoolArray
    doubtful: BoolArray
    not_lowered: BoolArray


def adopt(outcomes: Mapping[str, Outcome], cases: Cases) -> Adoption:
    """Adopt a risk for every case."""
    formula, simulated = outcomes[adopted_formula().key].value, outcomes[simulation().key]
    value, low, high = (simulated.value, *(simulated.detail[end].astype(np.float64) for end in ("low", "high")))
    doubtful = simulated.flags["generic_spectrum"] | simulated.flags["weak_motions"] | cases.pfv_estimated
    has_run = ~np.isnan(value)
    not_lowered = has_run & doubtful & (classify_all(value) < classify_all(formula))
    verified = has_run & ~not_lowered
    probability = np.where(verified, value, formula)
    at_least = np.where(simulated.flags["fell_in_record"], int(RiskClass.HIGH), int(RiskClass.LOW))
    risk = np.maximum(classify_all(probability), at_least)
    upper = np.where(has_run, np.maximum(risk, classify_all(high)), risk)
    return Adoption(
        probability=probability,
        low=np.where(verified, low, np.nan),
        high=np.where(verified, high, np.nan),
        risk=risk,
        upper=upper,
        verified=verified,
        doubtful=doubtful,
        not_lowered=not_lowered,
    )


def find_governing(probability: FloatArray, case_item: NDArray[np.intp], pfa: FloatArray) -> NDArray[np.intp]:
    """Return the index of the case that governs each item.

    That of the larger probability, then of the larger PFA, then the first, which is X.
    """
    by_peak, by_chance = -np.round(pfa / GRAVITY, ALIKE), -np.round(probability, ALIKE)
    order = np.lexsort((by_peak, by_chance, case_item))
    first = np.searchsorted(case_item[order], np.arange(case_item[-1] + 1 if len(case_item) else 0))
    return order[first]


def choose_items(
    verify: str,
    methods: Sequence[Method],
    outcomes: Mapping[str, Outcome],
    case_item: NDArray[np.intp],
    has_route: BoolArray,
) -> BoolArray:
    """Return which items (m,) are to be simulated; `has_route` (m,) tells which of them stand on a route.

    "high": those that are high or very high by one of the `methods` that select under any of their motions, those with
    a flag of a method that selects, as outside the checked range of the formula, and those on a route.
    """
    if verify != "high":
        return np.full(has_route.size, verify == "all")
    wanted = np.zeros(case_item.size, dtype=np.bool_)
    for method in methods:
        if method.selects:
            wanted |= classify_all(outcomes[method.key].value) >= RiskClass.HIGH
        for flag in method.selecting_flags:
            wanted |= outcomes[method.key].flags[flag]
    chosen = has_route.copy()
    np.logical_or.at(chosen, case_item, wanted)
    return chosen


def build_falls(
    inventory: Inventory,
    adoption: Adoption,
    outcomes: Mapping[str, Outcome],
    case_demand: Sequence[Demand],
    governing: NDArray[np.intp],
    *,
    is_suite: bool,
) -> Falls:
    """Return how the pieces of an inventory fall: a blank axis takes the outcomes of the governing one.

    Motions from records, given peaks, interpolation and profiles are independent of each other; the user's own
    (`is_suite`) are the same on every floor. A piece whose simulated class may not be adopted enters by its adopted
    chance.
    """
    simulated = outcomes[simulation().key]
    sources: dict[str, int] = {}
    rows = {int(case): (joint, row) for joint in simulated.joints for row, case in enumerate(joint.cases)}
    group, fell = np.full(len(governing), -1, dtype=np.intp), {}
    for at, case in enumerate(int(one) for one in governing):
        if case in rows and adoption.verified[case]:
            joint, row = rows[case]
            source = "" if is_suite else case_demand[case].source
            group[at] = sources.setdefault(source, len(sources))
            fell[at] = joint.fell[row, : joint.runs[row]]
    return Falls(
        probability=adoption.probability[governing],
        group=group,
        fell=fell,
        in_record=simulated.detail["record_overturned"].astype(np.float64)[governing],
        anchored=np.array([item.anchored == "yes" for item in inventory.items], dtype=np.bool_),
        quantity=np.array([item.quantity for item in inventory.items], dtype=np.intp),
    )
