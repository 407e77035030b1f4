"""The worked example: one piece, and what each method computes for it, step by step with its numbers."""

import math
from collections.abc import Iterator

import numpy as np

from assess.methods import Example, simulation
from assess.pipeline.assessment import Assessment
from assess.results import WorkedMethod
from assess.units import ACCELERATION, LENGTH, VELOCITY, to_edge


def choose_example(assessment: Assessment) -> int | None:
    """Return the index of the piece that is worked through: the worst that is free-standing and simulated.

    A free-standing piece comes before a simulated one, and that before one of a higher risk; None of no pieces.
    """
    items = assessment.inventory.items
    if not items:
        return None
    firsts, governing = np.searchsorted(assessment.case_item, np.arange(len(items))), assessment.governing
    upper = np.maximum.reduceat(assessment.adoption.upper, firsts)
    is_simulated = ~np.isnan(assessment.outcomes[simulation().key].value[governing])
    return int(np.lexsort((-assessment.adoption.probability[governing], -upper, ~is_simulated, assessment.held))[0])


def work_example(index: int, assessment: Assessment) -> tuple[WorkedMethod, ...]:
    """Return the calculation of every method that was evaluated for a piece, under the motion that governs it."""
    return tuple(_work(index, assessment))


def _work(index: int, assessment: Assessment) -> Iterator[WorkedMethod]:
    item, case = assessment.inventory.items[index], int(assessment.governing[index])
    demand, restitution = assessment.case_demand[case], assessment.inventory.building.restitution
    for method in assessment.methods:
        outcome = assessment.outcomes[method.key]
        value = float(outcome.value[case])
        if method.steps is None or math.isnan(value):
            continue
        example = Example(
            breadth=to_edge(item.breadth, LENGTH["cm"]),
            height=to_edge(item.height, LENGTH["cm"]),
            pfa=demand.pfa / ACCELERATION["cm/s2"],
            pfv=demand.pfv / VELOCITY["cm/s"],
            centre=item.centre_of_gravity,
            restitution=math.nan if restitution is None else restitution,
            settings=assessment.settings,
            value=value,
            detail={name: array[case].item() for name, array in outcome.detail.items()},
            flags=tuple(flag for flag, array in outcome.flags.items() if array[case]),
        )
        yield WorkedMethod(method.key, tuple(method.steps(example)), value)
