"""The arrays of a run, before they become the tables of `assess.results`, and the risk that is adopted.

The adopted risk is that of the simulation where it ran and its motions can be relied on, else that of the formula.
A piece that cannot rock is low whatever a formula says: one that is too stocky to, or that not even the strongest
motion that may be drawn can start. A class that simulation lowers is marked. Where its motions are weaker than the
floor's, simulation may raise a class, but not lower it: then the formula's class stands, unconfirmed. Where nothing is
known of the building, the class is that of the faster third of the draws where that is higher, and unconfirmed. A piece
that overturns under the record itself is at least high.

A piece whose axis is blank is integrated along both. Where it is nearly square on plan it is about as slender along one
as along the other, so that the larger of its two chances is too low: it falls in a draw if it falls along either axis.
Both axes of draw k are of one earthquake and one body, with phases of their own.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from assess.annual_results import Annual
from assess.arrays import BoolArray, FloatArray
from assess.errors import Problem
from assess.methods import ALIKE, Alike, Cases, Joint, Method, Outcome, adopted_formula, simulation
from assess.methods.simulate import interval_width
from assess.model import AXES, Axis, Inventory, Item
from assess.pipeline.demand import Demand
from assess.results import BASES
from assess.risk import RiskClass, classify_all, wilson_interval
from assess.rocking.block import ROLLS_FROM, STOCKY
from assess.rocking.draws import MARGIN, Uncertainty
from assess.route_results import DOUBTS, ROLLING
from assess.routes.chances import Falls
from assess.settings import Settings
from assess.units import GRAVITY, ROUNDING

if TYPE_CHECKING:
    from assess.motion.suite import Suite
    from assess.routes.obstructions import Obstructions

IntArray = NDArray[np.int64]

FORMULA, SIMULATED, UNCONFIRMED, CANNOT_ROCK, ROLLS = range(len(BASES))
SQUARE = 1.3
"""Width over breadth [-] below which a piece counts as square on plan."""


@dataclass(frozen=True, slots=True, eq=False)
class Adoption:
    """The adopted risk of n cases, an array (n,) each.

    * `low`, `high`: the sampling interval of a simulated risk [-]; NaN where the formula's is adopted.
    * `risk`, `upper`: class by the probability, and by the upper end of the interval.
    * `basis`: place in `assess.results.BASES`.
    * `doubtful`: where simulation may not lower a class.
    * `ideal_higher`: where the class of the piece as given, under exactly this motion, is above the adopted one.
    * `either_axis`: where it is the chance of a fall along either axis.
    * `rocks_from`: share of g b/z that PFA has to reach for the piece to rock in any draw [-].
    * `rolls`: where a piece stands on castors and has a class all the same, as it is slender.
    """

    probability: FloatArray
    low: FloatArray
    high: FloatArray
    risk: IntArray
    upper: IntArray
    basis: NDArray[np.int8]
    doubtful: BoolArray
    ideal_higher: BoolArray
    either_axis: BoolArray
    rocks_from: FloatArray
    rolls: BoolArray

    @property
    def can_rock(self) -> BoolArray:
        """Where the piece is not too stocky to rock, and the strongest motion that may be drawn can start it, (n,)."""
        return np.asarray(self.basis != CANNOT_ROCK)


def find_can_rock(cases: Cases, settings: Settings) -> BoolArray:
    """Return where the strongest motion that may be drawn can start a piece rocking: PFA e^(3 s) >= 0.65 g b/z.

    s is the standard deviation of ln of what is drawn: earthquake, peak of the motion, and slenderness of the piece. A
    piece that is too stocky never rocks.
    """
    start = find_start(cases, settings) * GRAVITY * cases.threshold
    return np.asarray((cases.pfa >= start) & ~cases.is_stocky)


def find_rolling(cases: Cases, mobile: BoolArray) -> BoolArray:
    """Return which of the pieces on castors (n,) roll and are not covered: those not so slender as to overturn."""
    return np.asarray(mobile & (cases.threshold >= ROLLS_FROM * (1 - ROUNDING)))


def find_start(cases: Cases, settings: Settings) -> FloatArray:
    """Return the share of g b/z that PFA has to reach for a piece to rock in any draw, (n,) [-]."""
    drawn, spread = Uncertainty(piece=not settings.ideal), np.zeros_like(cases.dispersion)
    spread = spread if settings.ideal else cases.dispersion
    return MARGIN / drawn.largest_start(cases.centre, cases.scanned, spread, cases.peak)


def adopt(outcomes: Mapping[str, Outcome], cases: Cases, settings: Settings, mobile: BoolArray) -> Adoption:
    """Adopt a risk for every case; `mobile` (n,) marks the pieces on castors."""
    found = outcomes[adopted_formula(settings.class_by).key].value
    # FEMA P-58 is for pieces of uniform weight, and has no value where such a piece is too stocky to rock: a top-heavy
    # one can rock all the same, and its chance is taken to be none
    formula = np.where(np.isnan(found) & (cases.breadth_to_height >= STOCKY), 0.0, found)
    simulated = outcomes[simulation().key]
    ideal, raised = simulated.detail["ideal"].astype(np.float64), simulated.flags
    names = ("ideal_low", "ideal_high") if settings.ideal else ("low", "high")
    value, (low, high) = ideal if settings.ideal else simulated.value, (_numbers(simulated, name) for name in names)
    has_run = ~np.isnan(value)
    has_fallen = (has_run & (value > 0)) | raised["fell_in_record"]
    can_rock = find_can_rock(cases, settings) | has_fallen  # motions of the user's own may exceed the floor's
    is_unknown, faster = raised["unknown_building"], _numbers(simulated, "if_faster")
    doubtful, is_lower = (is_unknown | raised["weak_motions"]) & can_rock, classify_all(value) < classify_all(formula)
    lowered = has_run & raised["weak_motions"] & can_rock & is_lower
    unconfirmed = lowered | (has_run & is_unknown & can_rock)
    probability = np.select([~can_rock, has_run & ~lowered], [0.0, value], formula)
    at_least = np.where(raised["fell_in_record"], int(RiskClass.HIGH), int(RiskClass.LOW))
    at_least = np.maximum(at_least, np.where(is_unknown & can_rock, classify_all(faster), int(RiskClass.LOW)))
    risk = np.maximum(classify_all(probability), at_least)
    ideal_higher = has_run & (classify_all(ideal) > risk)
    upper = np.where(has_run & can_rock, np.maximum(risk, classify_all(high)), risk)
    rolls = find_rolling(cases, mobile)
    basis = np.select([rolls, ~can_rock, unconfirmed, has_run], [ROLLS, CANNOT_ROCK, UNCONFIRMED, SIMULATED], FORMULA)
    return Adoption(
        probability=probability, low=np.where(basis == SIMULATED, low, np.nan),
        high=np.where(basis == SIMULATED, high, np.nan), risk=risk,
        upper=np.where(ideal_higher, np.maximum(upper, classify_all(ideal)), upper), basis=basis.astype(np.int8),
        doubtful=doubtful, ideal_higher=ideal_higher, either_axis=np.zeros_like(can_rock),
        rocks_from=find_start(cases, settings), rolls=mobile & ~rolls,
    )  # fmt: skip


def list_mobile(inventory: Inventory) -> BoolArray:
    """Return which pieces of an inventory (n,) stand on castors."""
    return np.array([bool(one.mobile) for one in inventory.items], dtype=np.bool_)


def _numbers(outcome: Outcome, name: str) -> FloatArray:
    return outcome.detail[name].astype(np.float64)


def find_ruling(cases: Cases, settings: Settings) -> FloatArray:
    """Return the peak by which the worse of several motions is chosen, (n,): PFV or PFA, by the adopted formula."""
    return np.asarray(getattr(cases, adopted_formula(settings.class_by).ruled_by))


def find_governing(adoption: Adoption, case_item: NDArray[np.intp], peak: FloatArray) -> NDArray[np.intp]:
    """Return the index of the case that governs each item.

    That of the larger probability, of equal ones first those under which the piece can rock, then that of the larger
    `peak` (`find_ruling`), then the first, which is X.
    """
    by_peak, by_chance = -np.round(peak, ALIKE), -np.round(adoption.probability + adoption.can_rock, ALIKE)
    order = np.lexsort((by_peak, by_chance, case_item))
    first = np.searchsorted(case_item[order], np.arange(case_item[-1] + 1 if len(case_item) else 0))
    return order[first]


def choose_items(
    verify: str, methods: Sequence[Method], outcomes: Mapping[str, Outcome], case_item: NDArray[np.intp],
    has_route: BoolArray,
) -> BoolArray:  # fmt: skip
    """Return which items (m,) are to be simulated; `has_route` (m,) marks those on a route.

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


def list_verdicts(
    simulated: Outcome, adoption: Adoption, settings: Settings, bases: Collection[int] = (SIMULATED,)
) -> dict[int, BoolArray]:
    """Return in which of its draws each case falls that was simulated and has one of `bases`."""
    return {
        case: (joint.ideal if settings.ideal else joint.fell)[row, : joint.runs[row]]
        for joint in simulated.joints
        for row, case in enumerate(joint.cases.tolist())
        if adoption.basis[case] in bases
    }


def is_square(item: Item) -> bool:
    """Whether an item is nearly square on plan, and the workbook leaves open along which axis it topples."""
    return item.axis is None and item.width is not None and item.width < SQUARE * item.breadth


def unite_axes(
    adoption: Adoption, outcomes: Mapping[str, Outcome], cases: Cases, inventory: Inventory,
    case_item: NDArray[np.intp], case_demand: Sequence[Demand], settings: Settings,
) -> tuple[Adoption, Mapping[int, BoolArray]]:  # fmt: skip
    """Return the adoption with the chance of a fall along either axis, and of each such item in which draws it falls.

    Of parallel motions of an axis that with the larger chance counts. Only where both axes are simulated and adopted.
    """
    names = ("probability", "low", "high", "risk", "upper", "either_axis")
    adoption = replace(adoption, **{name: getattr(adoption, name).copy() for name in names})
    verdicts = list_verdicts(outcomes[simulation().key], adoption, settings)
    firsts = np.searchsorted(case_item, np.arange(len(inventory.items) + 1)).tolist()
    united: dict[int, BoolArray] = {}
    pairs: dict[int, list[int]] = {}
    for index in (at for at, item in enumerate(inventory.items) if is_square(item)):
        every = range(firsts[index], firsts[index + 1])
        owns = [[case for case in every if case_demand[case].axis == axis] for axis in AXES]
        pair = [max(own, key=lambda case: adoption.probability[case]) for own in owns if own]
        if len(pair) == len(AXES) and all(case in verdicts for case in pair):
            count = min(verdicts[case].size for case in pair)
            united[index] = np.any([verdicts[case][:count] for case in pair], axis=0)
            pairs[index] = pair
    kinds: dict[tuple[int, ...], int] = {}
    numbers = [kinds.setdefault(tuple(cases.alike[pair].tolist()), len(kinds)) for pair in pairs.values()]
    alike = Alike.of(numbers, [cases.quantity[pair[0]] for pair in pairs.values()])
    shares = alike.average(np.array([united[index].mean() for index in pairs])).tolist()
    for (index, pair), share in zip(pairs.items(), shares, strict=True):
        low, high = wilson_interval(share * united[index].size, united[index].size, interval_width(settings))
        adoption.probability[pair], adoption.low[pair], adoption.high[pair] = share, low, high
        adoption.risk[pair] = np.maximum(adoption.risk[pair], classify_all(share))
        adoption.upper[pair] = np.maximum(adoption.upper[pair], classify_all(high))
        adoption.either_axis[pair] = True
    return adoption, united


def build_falls(
    inventory: Inventory, adoption: Adoption, outcomes: Mapping[str, Outcome], governing: NDArray[np.intp],
    settings: Settings, either_axis: Mapping[int, BoolArray], held: BoolArray,
) -> Falls:  # fmt: skip
    """Return how the pieces of an inventory fall: a blank axis takes the outcomes of the governing one.

    A piece of `either_axis` (by its index) takes those instead: in which draws it falls along either axis. `held` marks
    which pieces count as anchored.

    Draw k is one earthquake for the whole building: all simulated pieces share its scale, and on floors whose motions
    were generated along one axis its phases. A piece whose simulated class may not be adopted is unconfirmed, and so
    is one that rolls: it may stand in the way. With
    `settings.ideal` the verdicts are those of the pieces as given under the motions as they are.
    """
    found = outcomes[simulation().key]
    fell = list_verdicts(found, adoption, settings, (SIMULATED, CANNOT_ROCK))
    return Falls(
        probability=adoption.probability[governing], high=np.fmax(adoption.probability, adoption.high)[governing],
        fell={at: fell[case] for at, case in enumerate(governing.tolist()) if case in fell} | dict(either_axis),
        unconfirmed={
            at: tuple(name for flag, name in DOUBTS.items() if flag != ROLLING and found.flags[flag][case])
            for at, case in enumerate(governing.tolist())
            if adoption.basis[case] == UNCONFIRMED
        } | dict.fromkeys(np.flatnonzero(adoption.basis[governing] == ROLLS).tolist(), (ROLLING,)),
        in_record=_numbers(found, "record_overturned")[governing], stands=~adoption.can_rock[governing], anchored=held,
        quantity=np.array([item.quantity for item in inventory.items], dtype=np.intp),
    )  # fmt: skip


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Assessment:
    """What a run computes with; `assess.pipeline.run.compute` makes it.

    * `scenario`: where the floor motion came from, one of `assess.settings.SCENARIOS`.
    * `suite`: the user's own motions, where they stood in for generated ones.
    * `filled`, `demands`: how every floor shakes, as the workbook says and with the settings' factor on it.
    * `cases`: n pairs of piece and motion: every piece under every motion of its axis, or of both where its axis is
      blank.
    * `case_item`, `case_demand` (n,): which item (its index in the inventory) and which demand each case has.
    * `outcomes`, `adoption`: what each method gives for all cases, and the risk that is adopted for each.
    * `either_axis`: of each piece that may topple along both axes, in which draws it does along either.
    * `governing`, `held` (items,): index of each item's governing case, and which items count as anchored.
    * `annual`: annual chances; None where the workbook names no hazard file.
    * `lacking`: the cases with the motions under which they are still to be rocked; None where nothing is.
    """

    inventory: Inventory
    settings: Settings
    scenario: str
    suite: "Suite | None"
    filled: Mapping[tuple[str, Axis], tuple[Demand, ...]]
    demands: Mapping[tuple[str, Axis], tuple[Demand, ...]]
    methods: tuple[Method, ...]
    cases: Cases
    case_item: NDArray[np.intp]
    case_demand: tuple[Demand, ...]
    outcomes: Mapping[str, Outcome]
    adoption: Adoption
    either_axis: Mapping[int, BoolArray]
    governing: NDArray[np.intp]
    held: BoolArray
    obstructions: "Sequence[Obstructions]"
    problems: tuple[Problem, ...]
    annual: Annual | None = None
    lacking: Cases | None = None

    @property
    def formula(self) -> Method:
        """The formula whose class is adopted of a piece that is not simulated."""
        return adopted_formula(self.settings.class_by)

    @property
    def waits(self) -> BoolArray:
        """Which items (m,) go by the formula until they are rocked."""
        found = np.zeros(len(self.inventory.items), dtype=np.bool_)
        if self.lacking is not None:
            found[self.case_item[self.lacking.ensemble >= 0]] = True
        return found

    @property
    def joints(self) -> Mapping[Demand, Joint]:
        """What the pieces on a floor motion did, motion by motion, where they were simulated."""
        joints = self.outcomes[simulation().key].joints
        return {self.case_demand[int(joint.cases[0])]: joint for joint in joints}

    def find_falls(self, held: Collection[int] = ()) -> Falls:
        """Return how the pieces fall, each under its governing motion, with further ones (indices) held."""
        anchored = self.held.copy()
        anchored[list(held)] = True
        return build_falls(
            self.inventory, self.adoption, self.outcomes, self.governing, self.settings, self.either_axis, anchored
        )
