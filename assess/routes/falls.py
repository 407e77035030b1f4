"""How each piece falls: its adopted chance, and what it did motion by motion where that was integrated."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from assess.adoption import VERIFICATION, Adoption
from assess.demand import Demand
from assess.inventory.model import Inventory
from assess.methods import Outcome
from assess.methods._method import BoolArray, FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Falls:
    """How the n pieces of an inventory fall, each under its governing motion.

    Parameters
    ----------
    probability : (n,) array
        Adopted chance of overturning [-].
    group : (n,) integer array
        Pieces of one group were integrated under the motions of one source, motion k of which is one earthquake for the
        whole building; -1 where a piece was not verified, or where its verified chance is not adopted.
    fell : mapping of int to (k,) boolean array
        For a piece with a group (by its index) whether it overturned, motion by motion.
    in_record : (n,) array
        1 where it overturns under the recorded motion itself, 0 where it does not, NaN where that is not known.
    anchored : (n,) boolean array
        Pieces whose fall depends on an anchor; their outcomes are those of a free-standing piece.
    quantity : (n,) integer array
        Pieces in the row.
    """

    probability: FloatArray
    group: NDArray[np.intp]
    fell: Mapping[int, BoolArray]
    in_record: FloatArray
    anchored: BoolArray
    quantity: NDArray[np.intp]

    @classmethod
    def of(
        cls,
        probability: Sequence[float],
        *,
        fell: Mapping[int, Sequence[bool]] | None = None,
        group: Sequence[int] | None = None,
        in_record: Sequence[float] | None = None,
        anchored: Sequence[bool] | None = None,
        quantity: Sequence[int] | None = None,
    ) -> "Falls":
        """Build it from plain numbers: without outcomes, free-standing and single where nothing else is said."""
        n, known = len(probability), {at: np.array(one, dtype=np.bool_) for at, one in (fell or {}).items()}
        return cls(
            probability=np.array(probability, dtype=np.float64),
            group=np.array(
                group if group is not None else [0 if at in known else -1 for at in range(n)], dtype=np.intp
            ),
            fell=known,
            in_record=np.array(in_record if in_record is not None else [np.nan] * n, dtype=np.float64),
            anchored=np.array(anchored if anchored is not None else [False] * n, dtype=np.bool_),
            quantity=np.array(quantity if quantity is not None else [1] * n, dtype=np.intp),
        )


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

    Motions from records, given peaks, interpolation and profiles have nothing in common; the user's own (`is_suite`)
    are the same on every floor. A piece whose verified class may not be adopted enters by its adopted chance.
    """
    verification = outcomes[VERIFICATION]
    sources: dict[str, int] = {}
    rows = {int(case): (joint, row) for joint in verification.joints for row, case in enumerate(joint.cases)}
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
        in_record=verification.detail["record_overturned"].astype(np.float64)[governing],
        anchored=np.array([item.anchored == "yes" for item in inventory.items], dtype=np.bool_),
        quantity=np.array([item.quantity for item in inventory.items], dtype=np.intp),
    )
