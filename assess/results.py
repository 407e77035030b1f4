"""What an assessment found: arrays for computing, one view per item for reading."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from assess.demand import Demand
from assess.errors import Problem
from assess.inventory.model import Axis, Inventory, Item
from assess.methods import Cases, Method, Outcome
from assess.risk import RiskClass, classify
from assess.settings import Settings

if TYPE_CHECKING:
    import pandas as pd

Detail = float | str | bool | None

MOST_KEPT = 2000
"""Items up to which results are kept once they have been read; a larger inventory's would fill the memory."""


@dataclass(frozen=True, slots=True)
class MethodResult:
    """What one method says of one case; `value` is None where it was not evaluated."""

    value: float | None
    detail: Mapping[str, Detail]
    flags: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class CaseResult:
    """One piece under one motion: the demand and every method's result by key."""

    demand: Demand
    methods: Mapping[str, MethodResult]


@dataclass(frozen=True, slots=True)
class Adopted:
    """The risk that the report goes by.

    `low` and `high` bound the interval of a verified risk, `lowered_from` is the class by formula where verification
    lowered it; all three are None while no verification has run. `upper` is the class by the upper bound.
    """

    method: str
    probability: float
    low: float | None
    high: float | None
    risk: RiskClass
    upper: RiskClass
    lowered_from: RiskClass | None
    flags: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ItemResult:
    """One row of furniture with its governing case, the risk adopted from it, and all its cases."""

    item: Item
    governing: CaseResult
    adopted: Adopted
    cases: tuple[CaseResult, ...]

    @property
    def is_anchored(self) -> bool:
        """Anchored pieces stand outside the classes: their risk depends on the anchor."""
        return self.item.anchored == "yes"

    @property
    def is_urgent(self) -> bool:
        """Whether its fall endangers life or a route, which comes first in the list of what to fix."""
        return self.item.importance == "life safety" or bool(self.item.route)

    def worst(self, key: str) -> float | None:
        """Return the largest value of a method over all motions, which may be above that of the governing one."""
        values = [value for case in self.cases if (value := case.methods[key].value) is not None]
        return max(values, default=None)

    @property
    def does_not_rock(self) -> bool:
        """Whether it is too stocky for Housner's equations."""
        return "does_not_rock" in self.adopted.flags


@dataclass(frozen=True, eq=False, repr=False)
class Assessment:
    """The result of `assess.run`.

    Parameters
    ----------
    inventory, settings
        What was assessed, and how.
    scenario : str
        Where the floor motion came from, one of `assess.settings.SCENARIOS`.
    demands : mapping of (floor, axis) to demands
        How every floor shakes.
    methods : tuple of Method
        The methods, in the order of reports.
    cases : Cases
        n pairs of piece and motion: every piece under every motion of its axis, or of both where its axis is blank.
    case_item, case_demand : (n,) arrays, list of Demand
        Which item (its index in the inventory) and which demand each case has.
    outcomes : mapping of method key to Outcome
        What each method says of all cases.
    governing : (items,) array
        Index of each item's governing case.
    problems : tuple of Problem
        Warnings and notes about the input.
    """

    inventory: Inventory
    settings: Settings
    scenario: str
    demands: Mapping[tuple[str, Axis], tuple[Demand, ...]]
    methods: tuple[Method, ...]
    cases: Cases
    case_item: NDArray[np.intp]
    case_demand: tuple[Demand, ...]
    outcomes: Mapping[str, Outcome]
    governing: NDArray[np.intp]
    problems: tuple[Problem, ...]

    def __len__(self) -> int:
        return len(self.inventory.items)

    def __iter__(self) -> Iterator[ItemResult]:
        return iter(self._kept) if len(self) <= MOST_KEPT else map(self.result, range(len(self)))

    @cached_property
    def _kept(self) -> list[ItemResult]:
        """The results of a small inventory: every report reads them again."""
        return [self.result(index) for index in range(len(self))]

    def __repr__(self) -> str:
        return f"<Assessment of {self.inventory.source.name}: {len(self):,} items, scenario {self.scenario!r}>"

    def result(self, index: int) -> ItemResult:
        """Return the result of the item at `index` in the inventory; raises IndexError beyond it."""
        index = range(len(self))[index]
        own = range(self._first[index], self._first[index + 1])
        cases = {case: self._case(case) for case in own}
        governing = cases[int(self.governing[index])]
        return ItemResult(self.inventory.items[index], governing, _adopt(governing), tuple(cases.values()))

    def _case(self, case: int) -> CaseResult:
        return CaseResult(self.case_demand[case], {key: result(case) for key, result in self._readers.items()})

    @cached_property
    def _first(self) -> list[int]:
        """Index of each item's first case, and of the one after the last: the cases of an item stand together."""
        return [int(at) for at in np.searchsorted(self.case_item, np.arange(len(self) + 1))]

    @cached_property
    def _readers(self) -> Mapping[str, "_Reader"]:
        return {method.key: _Reader(self.outcomes[method.key]) for method in self.methods}

    def frame(self) -> "pd.DataFrame":
        """Return one row an item: its fields in SI units, the adopted risk and every method's value."""
        import pandas as pd

        rows = [
            {
                **asdict(one.item),
                "governing_axis": one.governing.demand.axis,
                "pfa": one.governing.demand.pfa,
                "pfv": one.governing.demand.pfv,
                **{key: method.value for key, method in one.governing.methods.items()},
                "proposed_or_raw": one.governing.methods[FORMULA].detail["raw"],
                "probability": one.adopted.probability,
                "risk_class": one.adopted.risk.word,
                "risk_class_upper": one.adopted.upper.word,
                "is_anchored": one.is_anchored,
                "flags": ", ".join(one.adopted.flags),
            }
            for one in self
        ]
        return pd.DataFrame(rows).set_index("item", drop=False)


class _Reader:
    """Reads one method's outcome case by case, from lists: indexing arrays one by one is slow."""

    def __init__(self, outcome: Outcome) -> None:
        self.values = _known(outcome.value)
        self.detail = {name: _known(array) for name, array in outcome.detail.items()}
        self.flags = {flag: array.tolist() for flag, array in outcome.flags.items() if array.any()}

    def __call__(self, case: int) -> MethodResult:
        return MethodResult(
            self.values[case],
            {name: values[case] for name, values in self.detail.items()},
            tuple([flag for flag, raised in self.flags.items() if raised[case]]),
        )


def _known(array: NDArray[Any]) -> list[Any]:
    """Return an array as a list, None in place of NaN; words pass through."""
    return [None if value != value else value for value in array.tolist()]


FORMULA = "proposed_or"
"""The method whose value is adopted while no verification has run."""

FLAGS: Mapping[str, str] = {
    "does_not_rock": "B/H is 1.41 or more: too stocky to rock, direct integration and FEMA P-58 do not apply",
    "slides": "friction is below B/H: it slides before it rocks, which no method here counts",
}
"""Meanings of the flags that belong to a piece rather than to one method."""


def _adopt(case: CaseResult) -> Adopted:
    formula = case.methods[FORMULA]
    probability = formula.value
    if probability is None:
        raise ValueError("the proposed OR formula gave no value")
    risk = classify(probability)
    if risk is None:
        raise ValueError("the proposed OR formula gave no class")
    piece = [flag for flag in FLAGS if any(flag in method.flags for method in case.methods.values())]
    flags = dict.fromkeys((*formula.flags, *case.demand.flags, *piece))
    return Adopted(FORMULA, probability, None, None, risk, risk, None, tuple(flags))


def count_pieces(results: Iterable[ItemResult]) -> tuple[dict[RiskClass, int], int]:
    """Count pieces, not rows: the free-standing ones by class, and the anchored ones, which have no class."""
    by_class, anchored = dict.fromkeys(RiskClass, 0), 0
    for one in results:
        if one.is_anchored:
            anchored += one.item.quantity
        else:
            by_class[one.adopted.risk] += one.item.quantity
    return by_class, anchored


def fix_first(results: Iterator[ItemResult]) -> list[ItemResult]:
    """Return the free-standing pieces of at least medium class, what to fix first at the top.

    Life safety or on a route first; then the upper class; then probability times quantity; then name.
    """
    chosen = [one for one in results if not one.is_anchored and one.adopted.upper >= RiskClass.MEDIUM]
    return sorted(
        chosen,
        key=lambda one: (
            not one.is_urgent,
            -one.adopted.upper,
            -one.adopted.probability * one.item.quantity,
            one.item.item.casefold(),
        ),
    )
