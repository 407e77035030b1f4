"""The adopted risk: that of the simulation where it ran and its motions can be relied on, else that of the formula.

A class that simulation lowers is marked. Where its motions may be too weak (a generic spectrum of a building of which
neither T1 nor height is known, motions weaker than the floor's) simulation may raise a class, but not lower it: then
the formula's class stands, unconfirmed. A piece that cannot start to rock is low whatever its motions are. A piece
that overturns under the record itself is at least high.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from assess.methods import Cases, Method, Outcome, adopted_formula, simulation
from assess.methods._method import ALIKE, BoolArray, FloatArray
from assess.model import Inventory
from assess.results import BASES
from assess.risk import RiskClass, classify_all
from assess.route_results import DOUBTS
from assess.routes.chances import Falls
from assess.settings import Settings
from assess.units import GRAVITY

IntArray = NDArray[np.int64]

FORMULA, SIMULATED, UNCONFIRMED = range(len(BASES))


@dataclass(frozen=True, slots=True, eq=False)
class Adoption:
    """The adopted risk of n cases.

    Parameters
    ----------
    probability : (n,) array
        [-]
    low, high : (n,) arrays
        The sampling interval of a simulated risk [-]; NaN where the formula's is adopted.
    risk, upper : (n,) integer arrays
        Class by the probability, and by the upper end of the interval.
    basis : (n,) integer array
        Place in `assess.results.BASES`.
    doubtful : (n,) boolean array
        Where simulation may not lower a class.
    ideal_higher : (n,) boolean array
        Where the class of the piece as given, under exactly this motion, is above the adopted one.
    can_rock : (n,) boolean array
        Where the strongest motion that may be drawn can start the piece rocking.
    either_axis : (n,) boolean array
        Where it is the chance of a fall along either axis; see `assess.pipeline.either_axis`.
    """

    probability: FloatArray
    low: FloatArray
    high: FloatArray
    risk: IntArray
    upper: IntArray
    basis: NDArray[np.int8]
    doubtful: BoolArray
    ideal_higher: BoolArray
    can_rock: BoolArray
    either_axis: BoolArray


def find_can_rock(cases: Cases, settings: Settings) -> BoolArray:
    """Return where the strongest motion that may be drawn can start a piece rocking: PFA e^(3 beta) >= 0.85 g b/z.

    0.64 takes the place of 0.85 where the sizes were measured by a scan.
    """
    strongest = cases.pfa * (1.0 if settings.ideal else cases.uncertainty.largest)
    return np.asarray(strongest >= cases.still * GRAVITY * cases.threshold)


def adopt(outcomes: Mapping[str, Outcome], cases: Cases, settings: Settings) -> Adoption:
    """Adopt a risk for every case."""
    formula, simulated = outcomes[adopted_formula().key].value, outcomes[simulation().key]
    ideal, raised = simulated.detail["ideal"].astype(np.float64), simulated.flags
    names = ("ideal_low", "ideal_high") if settings.ideal else ("low", "high")
    value, (low, high) = ideal if settings.ideal else simulated.value, (_numbers(simulated, name) for name in names)
    has_run, can_rock = ~np.isnan(value), find_can_rock(cases, settings)
    doubtful = (raised["unknown_period"] | raised["weak_motions"]) & can_rock
    unconfirmed = has_run & doubtful & (classify_all(value) < classify_all(formula))
    confirmed = has_run & ~unconfirmed
    probability = np.where(confirmed, value, formula)
    at_least = np.where(raised["fell_in_record"], int(RiskClass.HIGH), int(RiskClass.LOW))
    risk = np.maximum(classify_all(probability), at_least)
    ideal_higher = has_run & (classify_all(ideal) > risk)
    upper = np.where(has_run, np.maximum(risk, classify_all(high)), risk)
    return Adoption(
        probability=probability,
        low=np.where(confirmed, low, np.nan),
        high=np.where(confirmed, high, np.nan),
        risk=risk,
        upper=np.where(ideal_higher, np.maximum(upper, classify_all(ideal)), upper),
        basis=np.where(unconfirmed, UNCONFIRMED, np.where(confirmed, SIMULATED, FORMULA)).astype(np.int8),
        doubtful=doubtful,
        ideal_higher=ideal_higher,
        can_rock=can_rock,
        either_axis=np.zeros(value.size, dtype=np.bool_),
    )


def _numbers(outcome: Outcome, name: str) -> FloatArray:
    return outcome.detail[name].astype(np.float64)


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
    governing: NDArray[np.intp],
    settings: Settings,
    either_axis: Mapping[int, BoolArray],
    held: BoolArray,
) -> Falls:
    """Return how the pieces of an inventory fall: a blank axis takes the outcomes of the governing one.

    A piece of `either_axis` (by its index) takes those instead: in which draws it falls along either axis. `held` tells
    which pieces count as anchored.

    Draw k is one earthquake for the whole building: all simulated pieces share its scale, and on floors whose motions
    were generated along one axis its phases. A piece whose simulated class may not be adopted is unconfirmed. With
    `settings.ideal` the verdicts are those of the pieces as given under the motions as they are.
    """
    found = outcomes[simulation().key]
    rows = {int(case): (joint, row) for joint in found.joints for row, case in enumerate(joint.cases)}
    fell = {}
    for at, case in enumerate(int(one) for one in governing):
        if case in rows and adoption.basis[case] == SIMULATED:
            joint, row = rows[case]
            fell[at] = (joint.ideal if settings.ideal else joint.fell)[row, : joint.runs[row]]
    fell |= either_axis
    return Falls(
        probability=adoption.probability[governing],
        high=np.fmax(adoption.probability, adoption.high)[governing],
        fell=fell,
        unconfirmed={
            at: tuple(name for flag, name in DOUBTS.items() if found.flags[flag][case])
            for at, case in enumerate(governing.tolist())
            if adoption.basis[case] == UNCONFIRMED
        },
        in_record=_numbers(found, "record_overturned")[governing],
        anchored=held,
        quantity=np.array([item.quantity for item in inventory.items], dtype=np.intp),
    )
