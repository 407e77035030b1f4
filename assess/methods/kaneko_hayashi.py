"""Kaneko and Hayashi's simplified formula (key ``kaneko_hayashi``): the chance of overturning from size, PFA and PFV.

Reference
---------
Kaneko M, Hayashi Y (2004), 13th World Conference on Earthquake Engineering, as equations (5) to (7) of "Overturning
Risk of Furniture in Earthquake Affected Areas" print it.

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
* α is the setting everywhere; a piece that slides, or slides and rocks, at the floor's PFA by Shenton's limits is only
  flagged.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from assess.i18n import Text, fill
from assess.methods.cases import Cases
from assess.methods.expression import G, normal_cdf, number, show, show_pfa, show_ratio
from assess.methods.method import BY_SIZE, Column, Example, LiveCells, Method, Outcome, Parameter, Reason, Reference
from assess.methods.simulate import SLIDING, find_branch
from assess.settings import Settings
from assess.units import ACCELERATION, LENGTH, ROUNDING, VELOCITY

NEAR_SWITCH = 1.1
"""F_f within this factor of F_b is flagged: our choice."""


# Equation (6), first
def _eq6_lambda_a(B_H: Any, g: float) -> Any:
    return np.log(B_H * g * (1 + B_H))


# Equation (6), second
def _eq6_lambda_v(B: Any, H: Any, B_H: Any) -> Any:
    return np.log(10.0 * B / np.sqrt(H) * (1 + B_H) ** 2.5)


# Equation (7), first
def _eq7_floor_frequency(PFA: Any, PFV: Any) -> Any:
    return PFA / (2 * np.pi * PFV)


# Equation (7), second
def _eq7_boundary_frequency(H: Any, B_H: Any) -> Any:
    return 15.6 / np.sqrt(H) * (1 + B_H) ** -1.5


# Equation (5), either line
def _eq5(alpha: Any, ln_P: Any, lambda_: Any, zeta: Any) -> Any:
    return alpha * normal_cdf((ln_P - lambda_) / zeta)


def _risk(B: Any, H: Any, B_H: Any, PFA: Any, PFV: Any, alpha: Any, zeta_A: Any, zeta_V: Any) -> Any:
    """Equation (5) in cm and s; where PFV is unknown, its upper bound over every PFV."""
    lambda_A, lambda_V = _eq6_lambda_a(B_H, G), _eq6_lambda_v(B, H, B_H)
    R_A, R_V = _eq5(alpha, np.log(PFA), lambda_A, zeta_A), _eq5(alpha, np.log(PFV), lambda_V, zeta_V)
    bound = np.maximum(R_A, _eq5(alpha, np.log(PFA), lambda_A, zeta_V))
    switched = np.where(_eq7_floor_frequency(PFA, PFV) > _eq7_boundary_frequency(H, B_H), R_V, R_A)
    return np.where(np.isnan(PFV), bound, switched)


@np.errstate(all="ignore")
def evaluate(cases: Cases, settings: Settings) -> Outcome:
    """Evaluate equation (5); where PFV is unknown, its upper bound over every PFV."""
    B, H = cases.breadth / LENGTH["cm"], cases.height / LENGTH["cm"]
    PFA, PFV = cases.pfa / ACCELERATION["cm/s2"], cases.pfv / VELOCITY["cm/s"]
    alpha, zeta_A, zeta_V = settings.slide_coefficient, settings.zeta_acceleration, settings.zeta_velocity
    value = _risk(B, H, B / H, PFA, PFV, alpha, zeta_A, zeta_V)
    F_f, F_b = _eq7_floor_frequency(PFA, PFV), _eq7_boundary_frequency(H, B / H)
    known = ~np.isnan(value)
    branch = np.select([~known, np.isnan(PFV), F_f > F_b], ["", "bound", "pfv"], default="pfa")
    detail = {
        "branch": branch,
        "median_pfa_g": np.exp(_eq6_lambda_a(B / H, G)) / G,
        "median_pfv_cm_s": np.exp(_eq6_lambda_v(B, H, B / H)),
        "floor_frequency_hz": F_f,
        "boundary_frequency_hz": F_b,
    }
    flags = {
        "pfv_unknown_upper_bound": branch == "bound",
        "near_switch": known & (np.abs(np.log(F_f / F_b)) <= math.log(NEAR_SWITCH) * (1 + ROUNDING)),
        "slides": known & np.isin(find_branch(cases), SLIDING),
    }
    return Outcome(value, detail, flags)


def live(cells: LiveCells) -> Mapping[str, Any]:
    """Return the value; 0 without shaking, where a spreadsheet has no logarithm."""
    B_H, H, PFA, own = cells.breadth_to_height, cells.height_cm, cells.pfa_g * G, cells.parameters
    alpha, zeta_A, zeta_V = (own[name] for name in ("slide_coefficient", "zeta_acceleration", "zeta_velocity"))
    risk = _risk(B_H * H, H, B_H, PFA, cells.pfv_cm_s, alpha, zeta_A, zeta_V)
    return {"value": np.where(cells.pfa_g <= 0, 0, risk)}


def steps(example: Example) -> list[Text]:
    """Work equations (5) to (7), or the upper bound where PFV is unknown."""
    settings = example.settings
    alpha, zeta_A, zeta_V = settings.slide_coefficient, settings.zeta_acceleration, settings.zeta_velocity
    x, PFA = number(example.breadth / example.height, ".5f"), number(example.pfa, ".6g")
    found = _eq6_lambda_a(x, number(G, ".3f"))
    steps = [show_ratio(example), show_pfa(example), show("λ_A = ln[(B/H)·g·(1 + B/H)]", found, ".5f")]
    lambda_A = number(float(found.value), ".5f")
    if math.isnan(example.pfv):
        k = PFA / np.exp(lambda_A)
        z = np.log(number(float(k.value), ".5f"))
        phi_A, phi_V = (normal_cdf(z / zeta) for zeta in (zeta_A, zeta_V))
        largest = max(phi_A.value, phi_V.value)
        return [
            *steps,
            fill("PFV is unknown: the largest risk that any PFV could give is taken."),
            show("k = PFA/exp(λ_A)", k, ".5f"),
            show("Φ(ln k/ζ_A)", phi_A, ".4f"),
            show("Φ(ln k/ζ_V)", phi_V, ".4f"),
            fill("The larger of the two counts, times the slide coefficient α."),
            show("R", alpha * number(float(largest), ".4f"), ".4f"),
        ]
    B, H, PFV = (number(one, ".6g") for one in (example.breadth, example.height, example.pfv))
    lambda_V = _eq6_lambda_v(B, H, x)
    if example.detail["branch"] == "pfv":
        note = fill("F_f is above F_b: the second line of equation (5) applies, that of the velocity.")
        symbols, z = "z = (ln PFV - λ_V)/ζ_V", (np.log(PFV) - number(float(lambda_V.value), ".5f")) / zeta_V
    else:
        note = fill("F_f is not above F_b: the first line of equation (5) applies, that of the acceleration.")
        symbols, z = "z = (ln PFA - λ_A)/ζ_A", (np.log(PFA) - lambda_A) / zeta_A
    return [
        *steps,
        show("λ_V = ln[10·B/√H·(1 + B/H)^2.5]", lambda_V, ".5f"),
        show("F_f = PFA/(2π·PFV)", _eq7_floor_frequency(PFA, PFV), ".4f", "Hz"),
        show("F_b = 15.6/√H·(1 + B/H)^-1.5", _eq7_boundary_frequency(H, x), ".4f", "Hz"),
        note,
        show(symbols, z, ".4f"),
        show("R = α·Φ(z)", alpha * normal_cdf(number(float(z.value), ".4f")), ".4f"),
    ]


METHOD = Method(
    key="kaneko_hayashi",
    title="Kaneko-Hayashi formula",
    short_title="Kaneko-Hayashi",
    kind="probability",
    order=20,
    selects=True,
    predicts=BY_SIZE,
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
    steps=steps,
    live=live,
    columns=(
        Column("branch", "Branch", kind="text", format=""),
        Column("median_pfa_g", "Median PFA", "g"),
        Column("median_pfv_cm_s", "Median PFV", "cm/s", ".1f"),
        Column("floor_frequency_hz", "Floor frequency F_f", "Hz", ".2f"),
        Column("boundary_frequency_hz", "Boundary frequency F_b", "Hz", ".2f"),
    ),
    parameters=(
        Parameter("zeta_acceleration", "ζ_A", "zeta_a"),
        Parameter("zeta_velocity", "ζ_V", "zeta_v"),
        Parameter("slide_coefficient", "α", "slide_alpha"),
    ),
    reasons=(
        Reason(
            "PFA {pfa_g} g is {pfa_to_start} times g·B/H, above which rocking can start; the Kaneko-Hayashi formula "
            "depends on velocity here and knows no such threshold: it still gives {value}.",
            side="above",
            column="branch",
            equals="pfv",
            can_rock=False,
        ),
        Reason(
            "PFV is unknown: the Kaneko-Hayashi formula shows the largest risk that any velocity could give; the risk "
            "at the true velocity may be much lower. PFA is {pfa_g} g, its median {median_pfa_g} g.",
            column="branch",
            equals="bound",
        ),
        Reason(
            "The Kaneko-Hayashi formula depends on velocity here (F_f {floor_frequency_hz} Hz, above F_b "
            "{boundary_frequency_hz} Hz): PFV is {pfv_cm_s} cm/s, its median for such pieces {median_pfv_cm_s} cm/s.",
            column="branch",
            equals="pfv",
        ),
        Reason(
            "The Kaneko-Hayashi formula depends on acceleration here (F_f {floor_frequency_hz} Hz, not above F_b "
            "{boundary_frequency_hz} Hz): PFA is {pfa_g} g, its median for such pieces {median_pfa_g} g.",
            column="branch",
            equals="pfa",
        ),
        Reason(
            "F_f {floor_frequency_hz} Hz lies within 10 % of F_b {boundary_frequency_hz} Hz, where the Kaneko-Hayashi "
            "formula jumps between acceleration and velocity: a slightly different size or motion may change it much.",
            flag="near_switch",
        ),
    ),
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
        "How α falls with friction is not printed: α stays as set, and a piece that slides by the limits of Shenton "
        "(1996) is flagged.",
    ),
    flags={
        "pfv_unknown_upper_bound": "peak floor velocity unknown: the largest risk over every velocity is shown",
        "near_switch": "within 10 % of the frequency at which the formula jumps from acceleration to velocity",
        "slides": "at the floor's PFA the piece slides, or slides and rocks (Shenton 1996), which the result does not "
        "count in its favour",
    },
)
