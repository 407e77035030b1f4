"""Proposed OR formula (key ``proposed_or``): the chance of overturning from B/H and PFA alone.

Reference
---------
"Overturning Risk of Furniture in Earthquake Affected Areas", section 4 (the paper prints neither authors nor DOI).

Equations
---------
(9)  OR = a + b/(B/H) + c·PFA + d/(B/H)² + e·PFA² + f·PFA/(B/H), PFA in cm/s².

Validity
--------
Fitted to direct integrations of Housner's block in three buildings; checked by shaking-table tests (Table 3) for B/H
0.14 to 0.39 and PFA 0.10 to 0.90 g. `raw` gives all 27 values of Table 3 within 0.0051 (AL1, mean: 0.65495 against
0.66).

Departures
----------
`raw` is equation (9) as printed. `value` is what is used, so that no stronger motion and no thinner piece comes out
safer:

1. a thin piece: as B/H falls, equation (9) rises to B/H* = -2d/(b + f·PFA) and falls below it. It is evaluated at
   max(B/H, B/H*), with PFA in B/H* capped at 640 cm/s²: where B/H* and PFA* meet, near 656 cm/s², both stand still;
2. strong motion: as PFA rises, it rises to PFA* = (c + f/(B/H))/(-2e) and falls past it. The value at PFA* is held;
3. a fit knows no bounds: clipped to [0, 1].

The small residue of the cap (B/H 0.1526 to 0.154) lies where equation (9) is above 1, so the clip hides it.
"""

from dataclasses import dataclass

import numpy as np

from assess.methods._method import Cases, FloatArray, Method, Outcome, Range, Reference
from assess.settings import Settings
from assess.units import ACCELERATION


@dataclass(frozen=True, slots=True)
class Coefficients:
    """The six coefficients of equation (9), for PFA in cm/s²."""

    a: float
    b: float
    c: float
    d: float
    e: float
    f: float


COEFFICIENTS = Coefficients(
    a=-0.97758451, b=0.30856415, c=0.0032112873, d=-0.018590461, e=-0.000001941, f=-0.00010152672
)
"""As printed under equation (9); formulas elsewhere (live columns of the workbook) are made from them."""

THIN_PFA_CAP = 640.0
"""Largest PFA [cm/s2] that `turning_breadth_to_height` reads: our departure, not the paper's."""

CHECKED_BREADTH_TO_HEIGHT = Range(0.14, 0.39)
CHECKED_PFA = Range(0.10, 0.90, "g")


# Equation (9)
def _eq9(B_H: FloatArray, PFA: FloatArray) -> FloatArray:
    k = COEFFICIENTS
    return k.a + k.b / B_H + k.c * PFA + k.d / B_H**2 + k.e * PFA**2 + k.f * PFA / B_H


def turning_breadth_to_height(PFA: FloatArray) -> FloatArray:
    """B/H* [-], where equation (9) is largest over B/H for a PFA [cm/s2]; the PFA it reads is capped."""
    b, d, f = COEFFICIENTS.b, COEFFICIENTS.d, COEFFICIENTS.f
    return -2 * d / (b + f * np.minimum(PFA, THIN_PFA_CAP))


def turning_pfa(B_H: FloatArray) -> FloatArray:
    """PFA* [cm/s2], where equation (9) is largest over PFA for a B/H [-]."""
    c, e, f = COEFFICIENTS.c, COEFFICIENTS.e, COEFFICIENTS.f
    return (c + f / B_H) / (-2 * e)


def evaluate(cases: Cases, settings: Settings) -> Outcome:
    """Evaluate equation (9) with its departures; `raw` beside it is without them."""
    B_H, PFA = cases.breadth_to_height, cases.pfa / ACCELERATION["cm/s2"]
    with np.errstate(all="ignore"):
        B_H_star = turning_breadth_to_height(PFA)
        B_H_used = np.maximum(B_H, B_H_star)
        PFA_star = turning_pfa(B_H_used)
        unclipped = _eq9(B_H_used, np.minimum(PFA, PFA_star))
        raw = _eq9(B_H, PFA)
    value = np.clip(unclipped, 0.0, 1.0)
    known = ~np.isnan(value)
    inside = CHECKED_BREADTH_TO_HEIGHT.holds(B_H) & CHECKED_PFA.holds(cases.pfa / ACCELERATION["g"])
    flags = {
        "extrapolated": known & ~inside,
        "held": PFA_star < PFA,
        "thin": B_H_star > B_H,
        "clipped": known & (value != unclipped),
    }
    return Outcome(value, {"raw": raw}, flags)


METHOD = Method(
    key="proposed_or",
    title="Proposed OR formula",
    kind="probability",
    order=10,
    predicts="The chance that a free-standing piece overturns, from its breadth-to-height ratio and the peak floor "
    "acceleration alone.",
    reference=Reference(
        authors="",
        year="",
        title="Overturning Risk of Furniture in Earthquake Affected Areas",
        source="",
        remark="Section 4, equations (8) and (9), Table 3.",
    ),
    needs=frozenset({"breadth", "height", "pfa"}),
    valid={"breadth_to_height": CHECKED_BREADTH_TO_HEIGHT, "pfa": CHECKED_PFA},
    evaluate=evaluate,
    equations=(
        "OR = a + b/(B/H) + c·PFA + d/(B/H)² + e·PFA² + f·PFA/(B/H)   (9), PFA in cm/s²",
        "a = -0.97758451, b = 0.30856415, c = 0.0032112873",
        "d = -0.018590461, e = -0.000001941, f = -0.00010152672",
    ),
    assumptions=(
        "The piece is free-standing, rigid and homogeneous, its centroid at mid-height; it does not slide; vertical "
        "motion is left out.",
        "Size is not considered: two pieces of the same B/H have the same risk, though a larger one is harder to "
        "overturn.",
        "A surface fitted to computed overturning ratios, not a law: with no shaking at all it still gives 0.28 at "
        "B/H 0.14 and 0.10 at B/H 0.20, and it calls pieces high below the acceleration at which they can start to "
        "rock.",
        "Checked by tests only for B/H 0.14 to 0.39 and PFA 0.10 to 0.90 g.",
    ),
    departures=(
        "Thin pieces: as printed, pieces thinner than B/H* = -2d/(b + f·PFA), about 0.12 to 0.15, come out safer "
        "the thinner they are. The formula is evaluated at max(B/H, B/H*), with PFA in B/H* capped at 640 cm/s².",
        "Strong motion: as printed, the risk falls again past PFA* = (c + f/(B/H))/(-2e), 0.65 to 0.82 g for B/H "
        "0.14 to 1. The value at PFA* is held for every larger PFA.",
        "The result is clipped to [0, 1]. The formula as printed, without any of this, is kept as the raw value.",
        "Of the 27 values of Table 3, to the two decimals printed, these departures change one: IB0, maximum (0.91 "
        "in place of 0.87).",
    ),
    flags={
        "extrapolated": "outside the range checked by tests (B/H 0.14 to 0.39, PFA 0.10 to 0.90 g)",
        "held": "PFA lies past the peak of the printed formula, where it would fall again: the value at the peak is "
        "used",
        "thin": "thinner than the printed formula can tell, which would call it safer: evaluated at the B/H of "
        "largest risk",
        "clipped": "the formula gave less than 0 or more than 1, and was set to 0 or 1",
    },
)
