"""Ishiyama's criterion (key ``ishiyama``): lower limits of PFA and PFV, both of which overturning must exceed.

Reference
---------
Ishiyama Y (1982), Earthquake Engineering & Structural Dynamics 10(5):635-650.

Equations
---------
Overturning is possible where PFA > g·B/H and PFV > 10·B/√H (cm, cm/s). 10·B/√H is 0.4 times the velocity
√[(8 g r/3)(1 - cos α)/cos² α] of an impulse that just overturns a slender block, within 2 % where B/H is small.

Validity
--------
Rigid blocks that do not slide. The limits are lower limits: exceeded, overturning is possible, not certain.

Departures
----------
The velocity limit is taken in its rounded form, as in Japanese practice (4 of the Japanese rule is PFV = 40 cm/s).
Where PFA alone is below its limit the answer is known without PFV.
"""

import math
from typing import Any

import numpy as np

from assess.i18n import Text, fill
from assess.methods.cases import Cases
from assess.methods.expression import G, compare, number, show, show_ratio
from assess.methods.method import PFV_FLAGS, Column, Example, Method, Outcome, Reference
from assess.settings import Settings
from assess.units import ACCELERATION, LENGTH, VELOCITY


def _acceleration_limit(B_H: Any, g: Any) -> Any:
    return g * B_H


def _velocity_limit(B: Any, H: Any) -> Any:
    return 10 * B / np.sqrt(H)


def evaluate(cases: Cases, settings: Settings) -> Outcome:
    """Tell where PFA and PFV both exceed their limits."""
    B, H, PFV = cases.breadth / LENGTH["cm"], cases.height / LENGTH["cm"], cases.pfv / VELOCITY["cm/s"]
    limit_A, limit_V = _acceleration_limit(B / H, ACCELERATION["g"]), _velocity_limit(B, H)
    sizes_and_pfa = ~np.isnan(limit_A) & ~np.isnan(cases.pfa)
    unknown = sizes_and_pfa & (cases.pfa > limit_A) & np.isnan(PFV)
    known = sizes_and_pfa & ~unknown
    value = np.where(known, (cases.pfa > limit_A) & (limit_V < PFV), np.nan)
    detail = {"threshold_pfa_g": limit_A / ACCELERATION["g"], "threshold_pfv_cm_s": limit_V}
    return Outcome(value, detail, {"pfv_unknown": unknown})


def steps(example: Example) -> list[Text]:
    """Work both limits."""
    limit_A = _acceleration_limit(number(example.breadth / example.height, ".5f"), number(G, ".3f"))
    limit_V = _velocity_limit(number(example.breadth, ".6g"), number(example.height, ".6g"))
    return [
        show_ratio(example),
        show("g·B/H", limit_A, ".6g", "cm/s²"),
        compare("PFA", example.pfa, limit_A, "cm/s²", is_above=example.pfa > limit_A.value),
        show("10·B/√H", limit_V, ".6g", "cm/s"),
        fill("PFV is unknown, but need not be known.")
        if math.isnan(example.pfv)
        else compare("PFV", example.pfv, limit_V, "cm/s", is_above=example.pfv > limit_V.value),
    ]


METHOD = Method(
    key="ishiyama",
    title="Ishiyama criterion",
    short_title="Ishiyama",
    kind="criterion",
    order=40,
    predicts="Whether the floor's peak acceleration and velocity both exceed the least that can overturn a "
    "free-standing piece.",
    reference=Reference(
        authors="Ishiyama Y",
        year="1982",
        title="Motions of Rigid Bodies and Criteria for Overturning by Earthquake Excitations",
        source="Earthquake Engineering & Structural Dynamics 10(5):635-650",
    ),
    needs=frozenset({"breadth", "height", "pfa", "pfv"}),
    evaluate=evaluate,
    steps=steps,
    columns=(
        Column("threshold_pfa_g", "Lower limit of PFA", "g"),
        Column("threshold_pfv_cm_s", "Lower limit of PFV", "cm/s", ".1f"),
    ),
    equations=("Overturning possible where PFA > g·(B/H) and PFV > 10·B/√H (cm, cm/s)",),
    assumptions=(
        "The piece is free-standing, rigid and homogeneous, its centroid at mid-height, and it does not slide.",
        "Lower limits: above them overturning is possible, not certain.",
    ),
    departures=(
        "The velocity limit is used in its rounded form 10·B/√H, which is 0.4 times the overturning velocity of an "
        "impulse.",
        "Where the acceleration alone is below its limit, overturning is not expected whatever the velocity, known "
        "or not.",
    ),
    flags=PFV_FLAGS,
    words=("overturning possible", "overturning not expected"),
)
