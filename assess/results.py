"""What an assessment found: arrays for computing, one view per item for reading."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from assess.adoption import FORMULA, VERIFICATION, Adoption
from assess.cases import Adopted, CaseReader, CaseResult
from assess.demand import Demand
from assess.errors import Problem
from assess.inventory.model import Axis, Inventory, Item
from assess.methods import Cases, Method, Outcome
from assess.methods._method import ALIKE, Joint
from assess.risk import RiskClass, classify
from assess.settings import Settings
from assess.units import GRAVITY

if TYPE_CHECKING:
    import pandas as pd

    from assess.motion.suite import Suite
    from assess.routes.model import Routes

MOST_KEPT = 2000
"""Items up to which results are kept once they have been read; a larger inventory's would fill the memory."""


@dataclass(frozen=True, slots=True)
class ItemResult:
    """One row of furniture with its governing case, the risk adopted from it, and all its cases.

    `routes` are those that it names, or has a segment of which it can reach.
    """

    item: Item
    governing: CaseResult
    adopted: Adopted
    cases: tuple[CaseResult, ...]
    routes: tuple[str, ...] = ()

    @property
    def by_formula(self) -> CaseResult:
        """The case that the formula alone would have govern: its larger value, then the larger PFA, then X."""
        return min(self.cases, key=_formula_first)

    @property
    def formula_class(self) -> RiskClass:
        """The highest class that the formula gives under any of its motions."""
        return _formula_class(self.cases)

    @property
    def is_verified(self) -> bool:
        """Whether its rocking was integrated under the governing motion."""
        return self.governing.verification is not None

    @property
    def is_anchored(self) -> bool:
        """Anchored pieces stand outside the classes: their risk depends on the anchor."""
        return self.item.anchored == "yes"

    @property
    def is_urgent(self) -> bool:
        """Whether its fall endangers life or a route, which comes first in the list of what to fix."""
        return self.item.importance == "life safety" or bool(self.routes)

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
    suite : Suite, optional
        The user's own motions, where they stood in for generated ones.
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
    adoption : Adoption
        The risk that is adopted for each case.
    governing : (items,) array
        Index of each item's governing case.
    routes : Routes, optional
        What may become of the evacuation routes; None where the workbook names none.
    problems : tuple of Problem
        Warnings and notes about the input.
    """

    inventory: Inventory
    settings: Settings
    scenario: str
    suite: "Suite | None"
    demands: Mapping[tuple[str, Axis], tuple[Demand, ...]]
    methods: tuple[Method, ...]
    cases: Cases
    case_item: NDArray[np.intp]
    case_demand: tuple[Demand, ...]
    outcomes: Mapping[str, Outcome]
    adoption: Adoption
    governing: NDArray[np.intp]
    routes: "Routes | None"
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
        cases = {case: self._read(case) for case in own}
        governing = cases[int(self.governing[index])]
        adopted = _adopt_worst(governing, cases.values())
        item = self.inventory.items[index]
        routes = self._reached.get(index, (item.route,) if item.route else ())
        return ItemResult(item, governing, adopted, tuple(cases.values()), routes)

    @cached_property
    def _reached(self) -> Mapping[int, tuple[str, ...]]:
        """The routes of which a piece reaches a segment, by its index: that which it names first."""
        found: dict[int, dict[str, None]] = {}
        for one in self.routes.segments if self.routes else ():
            for near in one.beside:
                named = self.inventory.items[near.item].route
                found.setdefault(near.item, {named: None} if named else {})[one.segment.route] = None
        return {index: tuple(names) for index, names in found.items()}

    @cached_property
    def _first(self) -> list[int]:
        """Index of each item's first case, and of the one after the last: the cases of an item stand together."""
        return [int(at) for at in np.searchsorted(self.case_item, np.arange(len(self) + 1))]

    @cached_property
    def _read(self) -> CaseReader:
        return CaseReader(self.case_demand, self.methods, self.outcomes, self.adoption)

    @cached_property
    def joints(self) -> Mapping[Demand, Joint]:
        """What the pieces on a floor motion did, motion by motion, where they were integrated."""
        joints = self.outcomes[VERIFICATION].joints
        return {self.case_demand[int(joint.cases[0])]: joint for joint in joints}

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
                "adopted_method": one.adopted.method,
                "probability": one.adopted.probability,
                "low": one.adopted.low,
                "high": one.adopted.high,
                "risk_class": one.adopted.risk.word,
                "risk_class_upper": one.adopted.upper.word,
                "lowered_from": None if one.adopted.lowered_from is None else one.adopted.lowered_from.word,
                "is_anchored": one.is_anchored,
                "flags": ", ".join(one.adopted.flags),
            }
            for one in self
        ]
        return pd.DataFrame(rows).set_index("item", drop=False)


def _formula_class(cases: Iterable[CaseResult]) -> RiskClass:
    """Return the highest class that the formula gives under any of the motions of a piece."""
    classes = [classify(value) for case in cases if (value := case.methods[FORMULA].value) is not None]
    return max((one for one in classes if one is not None), default=RiskClass.LOW)


CARRIED = ("fell_in_record", "undecided")
"""Flags that count for a piece under whichever of its motions they were raised."""


def _adopt_worst(governing: CaseResult, cases: Iterable[CaseResult]) -> Adopted:
    """Return the risk of a piece: the governing chance, with the highest classes under any motion of the piece.

    A class that is lower than the highest that the formula gives under any of them is marked.
    """
    cases = tuple(cases)
    if all(case.verification is None for case in cases):
        return governing.adopted  # the formula's, of which the largest governs
    risk, upper = max(case.adopted.risk for case in cases), max(case.adopted.upper for case in cases)
    formula = _formula_class(cases)
    carried = [flag for flag in CARRIED if any(flag in case.adopted.flags for case in cases)]
    return replace(
        governing.adopted,
        risk=risk,
        upper=upper,
        lowered_from=formula if risk < formula else None,
        flags=tuple(dict.fromkeys((*governing.adopted.flags, *carried))),
    )


def _formula_first(case: CaseResult) -> tuple[float, float]:
    value = case.methods[FORMULA].value
    return -round(value if value is not None else 0.0, ALIKE), -round(case.demand.pfa / GRAVITY, ALIKE)
