"""The arrays of a run, before they become the tables of `assess.results`."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from assess.annual_results import Annual
from assess.arrays import BoolArray
from assess.errors import Problem
from assess.methods import Cases, Joint, Method, Outcome, simulation
from assess.model import Axis, Inventory
from assess.pipeline.adopt import Adoption, build_falls
from assess.pipeline.demand import Demand
from assess.routes.chances import Falls
from assess.settings import Settings

if TYPE_CHECKING:
    from assess.motion.suite import Suite
    from assess.routes.obstructions import Obstructions


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
