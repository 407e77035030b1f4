"""How the pieces of a building fall at one level of shaking, by what was rocked there."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from assess.methods import Cases, Joint, Outcome, adopted_formula, simulation
from assess.methods._method import BoolArray, FloatArray
from assess.pipeline.adopt import adopt, build_falls, find_governing
from assess.pipeline.anchors import find_held
from assess.pipeline.assessment import Assessment
from assess.pipeline.either_axis import unite_axes
from assess.routes.chances import Falls
from assess.settings import Settings


def find_falls(
    assessment: Assessment,
    cases: Cases,
    pfa: FloatArray,
    rocked: Sequence[tuple[NDArray[np.intp], BoolArray]],
    settings: Settings,
) -> Falls:
    """Return how the pieces fall where case i has the PFA `pfa[i]` [m/s2], and its PFV in proportion.

    What was rocked (cases, and whether they overturn in each draw, (m, k)) is taken as it is: nothing is unconfirmed
    here. A piece that was not falls by the formula's chance at that PFA. Of several motions of a piece that of the
    larger chance governs.
    """
    scaled = replace(cases, pfa=pfa, pfv=cases.pfv * pfa / cases.pfa, pfv_estimated=pfa < 0)
    formula = adopted_formula().evaluate(scaled, settings)
    outcomes = {adopted_formula().key: formula, simulation().key: _outcome(pfa.size, rocked)}
    inventory, case_item = assessment.inventory, assessment.case_item
    adoption = adopt(outcomes, scaled, settings)
    adoption, united = unite_axes(adoption, outcomes, inventory, case_item, assessment.case_demand, settings)
    governing = find_governing(adoption.probability, case_item, pfa)
    held = find_held(inventory, pfa[governing], cases.uncertainty.motion)
    return build_falls(inventory, adoption, outcomes, governing, settings, united, held)


def _outcome(count: int, rocked: Sequence[tuple[NDArray[np.intp], BoolArray]]) -> Outcome:
    """Return what was rocked as the outcome of a simulation of `count` cases, without the recorded motion."""
    value: FloatArray = np.full(count, np.nan)
    joints = []
    for number, (own, one) in enumerate(rocked):
        value[own] = one.sum(axis=1) / one.shape[1]
        runs, rotation = np.full(own.size, one.shape[1]), np.zeros((0, 0), dtype=np.float32)
        joint = Joint(
            ensemble=number, cases=own, runs=runs, fell=one, ideal=one, rotation=rotation, examples=(), fit=None
        )
        joints.append(joint)
    unknown, no = np.full(count, np.nan), np.zeros(count, dtype=np.bool_)
    return Outcome(
        value,
        {"ideal": value, **dict.fromkeys(("low", "high", "ideal_low", "ideal_high", "record_overturned"), unknown)},
        dict.fromkeys(("unknown_period", "weak_motions", "fell_in_record"), no),
        tuple(joints),
    )
