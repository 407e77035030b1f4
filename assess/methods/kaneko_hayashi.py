"""Kaneko and Hayashi's simplified formula (key ``kaneko_hayashi``): the chance of overturning from size, PFA and PFV.

Reference
---------
Kaneko M, Hayashi Y (2004), 13th World Conference on Earthquake Engineering, as equations (5) to (7) of "Overturning
Risk of Furniture in Earthquake Affected Areas" print it (the original was not at hand).

Equations
---------
(5)  R = α·Φ((ln PFA - λ_A)/ζ_A) where F_f ≤ F_b, R = α·Φ((ln PFV - λ_V)/ζ_V) where F_f > F_b
(6)  λ_A = ln[(B/H) g (1 + B/H)], λ_V = ln[10 B/√H (1 + B/H)^2.5]
(7)  F_f = PFA/(2π PFV), F_b = 15.6/√H (1 + B/H)^-1.5
in cm, cm/s, cm/s², Hz. exp(λ_A) and exp(λ_V) are medians: the motion that overturns half of the pieces.

Validity
--------
No range is printed. Compared by Nakamura et al. (2008) with what one 14-storey building went through in 2005; exp(λ_A)
equals five published Japanese values to 1 gal.

Departures
----------
* The paper's prose states the switch the other way round. Equation (5) is right and is used: F_b is the frequency at
  which both medians are the same motion, exp(λ_A) = 2π F_b exp(λ_V) (to 0.05 %: 15.6 is rounded).
* ζ_A, ζ_V are not printed: settings, 0.20 and 0.5 (`Settings` says why). As they differ, R jumps at F_f = F_b, so a
  slightly thinner piece may come out safer there. Flagged within 10 % of the switch; the 10 % is our choice.
* PFV unknown: the largest R that any PFV gives, α·max[Φ(ln k/ζ_A), Φ(ln k/ζ_V)], k = PFA/exp(λ_A); on the velocity
  branch F_f > F_b means PFV/exp(λ_V) < k.
* α is the setting everywhere; friction below B/H is only flagged.
"""

import math

import numpy as np

from assess.methods._method import Cases, FloatArray, Method, Outcome, Reference, normal_cdf
from assess.settings import Settings
from assess.units import ACCELERATION, GRAVITY, LENGTH, ROUNDING, VELOCITY

G = GRAVITY / ACCELERATION["cm/s2"]
"""g of equation (6) [cm/s2]."""

VELOCITY_FACTOR, VELOCITY_POWER = 10.0, 2.5
"""10 and 2.5 of λ_V, equation (6)."""

BOUNDARY_FACTOR, BOUNDARY_POWER = 15.6, -1.5
"""15.6 and -1.5 of F_b, equation (7)."""

NEAR_SWITCH = 1.1
"""F_f within this factor of F_b is flagged: our choice."""


# Equation (6), first
def _eq6_lambda_a(B_H: FloatArray, g: float) -> FloatArray:
    return np.log(B_H * g * (1 + B_H))


# Equation (6), second
def _eq6_lambda_v(B: FloatArray, H: FloatArray) -> FloatArray:
    return np.log(VELOCITY_FACTOR * B / np.sqrt(H) * (1 + B / H) ** VELOCITY_POWER)


# Equation (7), first
def _eq7_floor_frequency(PFA: FloatArray, PFV: FloatArray) -> FloatArray:
    return PFA / (2 * np.pi * PFV)


# Equation (7), second
def _eq7_boundary_frequency(B: FloatArray, H: FloatArray) -> FloatArray:
    return BOUNDARY_FACTOR / np.sqrt(H) * (1 + B / H) ** BOUNDARY_POWER


# Equation (5), either line
def _eq5(alpha: float, ln_P: FloatArray, lambda_: FloatArray, zeta: float) -> FloatArray:
    return alpha * normal_cdf((ln_P - lambda_) / zeta)


@np.errstate(all="ignore")
def evaluate(cases: Cases, settings: Settings) -> Outcome:
    """Evaluate equation (5); where PFV is unknown, its upper bound over every PFV."""
    B, H = cases.breadth / LENGTH["cm"], cases.height / LENGTH["cm"]
    PFA, PFV = cases.pfa / ACCELERATION["cm/s2"], cases.pfv / VELOCITY["cm/s"]
    alpha, zeta_A, zeta_V = settings.slide_coefficient, settings.zeta_acceleration, settings.zeta_velocity

    lambda_A, lambda_V = _eq6_lambda_a(B / H, G), _eq6_lambda_v(B, H)
    F_f, F_b = _eq7_floor_frequency(PFA, PFV), _eq7_boundary_frequency(B, H)
    R_A, R_V = _eq5(alpha, np.log(PFA), lambda_A, zeta_A), _eq5(alpha, np.log(PFV), lambda_V, zeta_V)
    bound = np.maximum(R_A, _eq5(alpha, np.log(PFA), lambda_A, zeta_V))

    known = ~np.isnan(R_A)
    branch = np.select([~known, np.isnan(PFV), F_f > F_b], ["", "bound", "pfv"], default="pfa")
    value = np.select([branch == "bound", branch == "pfv"], [bound, R_V], default=R_A)
    detail = {
        "branch": branch,
        "median_pfa_g": np.exp(lambda_A) / G,
        "median_pfv_cm_s": np.exp(lambda_V),
        "floor_frequency_hz": F_f,
        "boundary_frequency_hz": F_b,
    }
    flags = {
        "pfv_unknown_upper_bound": branch == "bound",
        "pfv_estimated": known & cases.pfv_estimated & (branch != "bound"),
        "near_switch": known & (np.abs(np.log(F_f / F_b)) <= math.log(NEAR_SWITCH) * (1 + ROUNDING)),
        "slides": known & (cases.friction < B / H * (1 - ROUNDING)),
    }
    return Outcome(value, detail, flags)


METHOD = Method(
    key="kaneko_hayashi",
    title="Kaneko-Hayashi formula",
    kind="probability",
    order=20,
    predicts="The chance that a free-standing piece overturns, from its size and the peak acceleration and velocity "
    "of the floor.",
    reference=Reference(
        authors="Kaneko M, Hayashi Y",
        year="2004",
        title="A proposal for simple equations to express a relation between overturning ratios of rigid bodies and "
        "input excitation",
        source="13th World Conference on Earthquake Engineering, Vancouver, Canada",
        remark='As printed in "Overturning Risk of Furniture in Earthquake Affected Areas", section 2.2, '
        "equations (5) to (7).",
    ),
    needs=frozenset({"breadth", "height", "pfa"}),
    evaluate=evaluate,
    equations=(
        "R = α·Φ((ln PFA - λ_A)/ζ_A) where F_f ≤ F_b;  R = α·Φ((ln PFV - λ_V)/ζ_V) where F_f > F_b   (5)",
        "λ_A = ln[(B/H) g (1 + B/H)];  λ_V = ln[10 B/√H (1 + B/H)^2.5]   (6)",
        "F_f = PFA/(2π PFV);  F_b = 15.6/√H (1 + B/H)^-1.5   (7), in cm, cm/s, cm/s², Hz",
        "PFV unknown: R = α·max[Φ(ln k/ζ_A), Φ(ln k/ζ_V)], k = PFA/exp(λ_A)",
    ),
    assumptions=(
        "The standard deviations are not printed. ζ_A = 0.20 unless set otherwise: it fits 23 of the 27 rows of the "
        "paper's Table 2. ζ_V = 0.5 unless set otherwise: assumed, after the dispersion of FEMA P-58 on PFV.",
        "The slide coefficient α is 1 unless set otherwise: friction is high enough that the piece rocks and does "
        "not slide.",
        "The piece is free-standing, rigid and homogeneous, its centroid at mid-height; vertical motion is left out.",
    ),
    departures=(
        "The paper's prose states the switch between acceleration and velocity the other way round; equation (5) is "
        "used, since F_b is the frequency at which both medians are the same motion.",
        "The formula jumps at F_f = F_b, because ζ_A and ζ_V differ: near it a small change of size or motion may "
        "change the result much. Pieces with F_f within 10 % of F_b are flagged; the 10 % is our choice.",
        "Where PFV is unknown, the largest risk that any PFV could give is shown.",
        "How α falls with friction is not printed: below B/H, α stays as set and the piece is flagged.",
    ),
    flags={
        "pfv_unknown_upper_bound": "peak floor velocity unknown: the largest risk over every velocity is shown",
        "pfv_estimated": "peak floor velocity estimated from PFA and the building's period",
        "near_switch": "within 10 % of the frequency at which the formula jumps from acceleration to velocity",
        "slides": "friction is below B/H: the piece would slide before it rocks, which the result does not count in "
        "its favour",
    },
)
