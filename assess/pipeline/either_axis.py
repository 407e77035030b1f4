"""Pieces that are nearly square on plan and may topple along both axes: they fall in a draw if they fall along either.

A piece whose axis is blank is integrated along both. Where its width is less than 1.3 times its breadth it is about as
slender along one as along the other, so that the larger of its two chances is too low. Both axes of draw k are of one
earthquake and one body, with phases of their own.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray
from assess.methods import Alike, Cases, Outcome, simulation
from assess.methods.simulate import interval_width
from assess.model import AXES, Inventory, Item
from assess.pipeline.adopt import Adoption, list_verdicts
from assess.pipeline.floor_demand import Demand
from assess.risk import classify_all, wilson_interval
from assess.settings import Settings

SQUARE = 1.3
"""Width over breadth [-] below which a piece counts as square on plan."""

_CHANGED = ("probability", "low", "high", "risk", "upper", "either_axis")


def is_square(item: Item) -> bool:
    """Whether an item is nearly square on plan, and the workbook leaves open along which axis it topples."""
    return item.axis is None and item.width is not None and item.width < SQUARE * item.breadth


def unite_axes(
    adoption: Adoption,
    outcomes: Mapping[str, Outcome],
    cases: Cases,
    inventory: Inventory,
    case_item: NDArray[np.intp],
    case_demand: Sequence[Demand],
    settings: Settings,
) -> tuple[Adoption, Mapping[int, BoolArray]]:
    """Return the adoption with the chance of a fall along either axis, and of each such item in which draws it falls.

    Of parallel motions of an axis that with the larger chance counts. Only where both axes are simulated and adopted.
    """
    adoption = replace(adoption, **{name: getattr(adoption, name).copy() for name in _CHANGED})
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
    for index, share in _average(cases, pairs, united).items():
        pair, runs = pairs[index], united[index].size
        low, high = wilson_interval(share * runs, runs, interval_width(settings))
        changed = {
            "probability": share,
            "low": low,
            "high": high,
            "risk": np.maximum(adoption.risk[pair], classify_all(share)),
            "upper": np.maximum(adoption.upper[pair], classify_all(high)),
            "either_axis": True,
        }
        for name, value in changed.items():
            getattr(adoption, name)[pair] = value
    return adoption, united


def _average(cases: Cases, pairs: Mapping[int, list[int]], united: Mapping[int, BoolArray]) -> dict[int, float]:
    """Return the share of the draws in which each item falls, that of all items alike together."""
    kinds: dict[tuple[int, ...], int] = {}
    numbers = [kinds.setdefault(tuple(cases.alike[pair].tolist()), len(kinds)) for pair in pairs.values()]
    alike = Alike.of(numbers, [cases.quantity[pair[0]] for pair in pairs.values()])
    shares = np.array([united[index].mean() for index in pairs])
    return dict(zip(pairs, alike.average(shares).tolist(), strict=True))
