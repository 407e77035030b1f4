"""How the pieces of a building fall at one level of shaking, by what was rocked there."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray, FloatArray
from assess.methods import Alike, Cases, Joint, Outcome, adopted_formula, simulation
from assess.pipeline.adopt import adopt, build_falls, find_governing, find_ruling
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
    here. A piece that was not falls by the formula's chance at that PFA, or not where it cannot rock. Of several
    motions of a piece that of the larger chance governs.
    """
    scaled = replace(cases, pfa=pfa, pfv=cases.pfv * pfa / cases.pfa)
    formula = adopted_formula(settings.class_by)
    outcomes = {formula.key: formula.evaluate(scaled, settings), simulation().key: _outcome(cases, rocked)}
    inventory, case_item = assessment.inventory, assessment.case_item
    adoption = adopt(outcomes, scaled, settings)
    adoption, united = unite_axes(adoption, outcomes, cases, inventory, case_item, assessment.case_demand, settings)
    governing = find_governing(adoption, case_item, find_ruling(scaled, settings))
    held = find_held(inventory, pfa[governing], cases.dispersion[governing])
    falls = build_falls(inventory, adoption, outcomes, governing, settings, united, held)
    return replace(falls, stands=np.zeros_like(held))  # the same pieces at every level


def _outcome(cases: Cases, rocked: Sequence[tuple[NDArray[np.intp], BoolArray]]) -> Outcome:
    """Return what was rocked as the outcome of a simulation of the cases, without the recorded motion."""
    count = cases.breadth.size
    value: FloatArray = np.full(count, np.nan)
    joints = []
    for number, (own, one) in enumerate(rocked):
        value[own] = Alike.of(cases.alike[own], cases.quantity[own]).average(one.sum(axis=1)) / one.shape[1]
        runs, rotation = np.full(own.size, one.shape[1]), np.zeros((0, 0), dtype=np.float32)
        joint = Joint(
            ensemble=number, cases=own, runs=runs, fell=one, ideal=one, rotation=rotation, examples=(), fit=None
        )
        joints.append(joint)
    unknown, no = np.full(count, np.nan), np.zeros(count, dtype=np.bool_)
    return Outcome(
        value,
        {
            "ideal": value,
            **dict.fromkeys(("low", "high", "ideal_low", "ideal_high", "record_overturned", "if_faster"), unknown),
        },
        dict.fromkeys(("unknown_building", "weak_motions", "fell_in_record"), no),
        tuple(joints),
    )
