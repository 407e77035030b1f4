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

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from assess.i18n import Text, fill
from assess.methods.cases import Cases
from assess.methods.expression import G, localise, number, plain, show, show_pfa, show_ratio
from assess.methods.method import (
    BLOCK,
    BY_RATIO,
    CLIPPED,
    Column,
    Example,
    LiveCells,
    Method,
    Outcome,
    Range,
    Reason,
    Reference,
)
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
"""As printed under equation (9)."""

THIN_PFA_CAP = 640.0
"""Largest PFA [cm/s2] that `turning_breadth_to_height` reads: our departure, not the paper's."""

CHECKED_BREADTH_TO_HEIGHT = Range(0.14, 0.39)
CHECKED_PFA = Range(0.10, 0.90, "g")

SYMBOLS = ("b/(B/H)", "c·PFA", "d/(B/H)²", "e·PFA²", "f·PFA/(B/H)")


def _list_coefficients(names: str) -> Text:
    return localise(", ".join(f"{name} = {plain(getattr(COEFFICIENTS, name))}" for name in names))


# Equation (9), term by term
def _terms(B_H: Any, PFA: Any) -> tuple[Any, ...]:
    k = COEFFICIENTS
    return k.a, k.b / B_H, k.c * PFA, k.d / B_H**2, k.e * PFA**2, k.f * PFA / B_H


# Equation (9)
def _eq9(B_H: Any, PFA: Any) -> Any:
    a, *others = _terms(B_H, PFA)
    return sum(others, a)


def turning_breadth_to_height(PFA: Any) -> Any:
    """B/H* [-], where equation (9) is largest over B/H for a PFA [cm/s2]; the PFA it reads is capped."""
    b, d, f = COEFFICIENTS.b, COEFFICIENTS.d, COEFFICIENTS.f
    return -2 * d / (b + f * np.minimum(PFA, THIN_PFA_CAP))


def turning_pfa(B_H: Any) -> Any:
    """PFA* [cm/s2], where equation (9) is largest over PFA for a B/H [-]."""
    c, e, f = COEFFICIENTS.c, COEFFICIENTS.e, COEFFICIENTS.f
    return (c + f / B_H) / (-2 * e)


def _held(B_H: Any, PFA: Any) -> Any:
    """Equation (9) with departures 1 and 2."""
    B_H_used = np.maximum(B_H, turning_breadth_to_height(PFA))
    return _eq9(B_H_used, np.minimum(PFA, turning_pfa(B_H_used)))


@np.errstate(all="ignore")
def evaluate(cases: Cases, settings: Settings) -> Outcome:
    """Evaluate equation (9) with its departures; `raw` is without them."""
    B_H, PFA = cases.breadth_to_height, cases.pfa / ACCELERATION["cm/s2"]
    B_H_star, held = turning_breadth_to_height(PFA), _held(B_H, PFA)
    value = np.maximum(0.0, np.minimum(1.0, held))
    known = ~np.isnan(value)
    inside = CHECKED_BREADTH_TO_HEIGHT.holds(B_H) & CHECKED_PFA.holds(cases.pfa / ACCELERATION["g"])
    flags = {
        "extrapolated": known & ~inside,
        "held": turning_pfa(np.maximum(B_H, B_H_star)) < PFA,
        "thin": B_H_star > B_H,
        "clipped": known & (value != held),
    }
    return Outcome(value, {"raw": _eq9(B_H, PFA)}, flags)


def live(cells: LiveCells) -> Mapping[str, Any]:
    """Return the value and equation (9) as printed."""
    B_H, PFA = cells.breadth_to_height, cells.pfa_g * G
    return {"value": np.maximum(0.0, np.minimum(1.0, _held(B_H, PFA))), "raw": _eq9(B_H, PFA)}


def steps(example: Example) -> list[Text]:
    """Work equation (9) term by term, then the departures from it."""
    x, y = number(example.breadth / example.height, ".5f"), number(example.pfa, ".6g")
    is_thin, is_held = "thin" in example.flags, "held" in example.flags
    a, *terms = _terms(x, y)
    rounded = [number(float(term.value), ".4f") for term in terms]
    turning_x = turning_breadth_to_height(y)
    used_x = number(float(turning_x.value), ".5f") if is_thin else x
    turning_y = turning_pfa(used_x)
    used = _eq9(used_x, number(float(turning_y.value), ".6g") if is_held else y)
    found = [
        show_ratio(example),
        show_pfa(example),
        _list_coefficients("a"),
        *(show(symbol, term, ".4f") for symbol, term in zip(SYMBOLS, terms, strict=True)),
        show("OR_9", sum(rounded, number(a, ".8f")), ".4f"),
        show("B/H* = -2d/(b + f·min(PFA, 640))", turning_x, ".5f"),
        fill("B/H lies below B/H*, where equation (9) would give a thinner piece a lower risk: B/H* is used instead.")
        if is_thin
        else fill("B/H is not below B/H*: it is used as it is."),
        show("PFA* = (c + f/(B/H))/(-2e)", turning_y, ".6g", "cm/s²"),
        fill("PFA lies above PFA*, beyond which equation (9) would fall again: PFA* is used instead.")
        if is_held
        else fill("PFA is not above PFA*: it is used as it is."),
    ]
    found += [show("OR", used, ".4f")] if is_thin or is_held else []
    if "clipped" in example.flags:
        above = fill("A probability lies between 0 and 1: the result is above 1 and is set to 1.")
        below = fill("A probability lies between 0 and 1: the result is below 0 and is set to 0.")
        found.append(above if used.value > 1 else below)
    return found


METHOD = Method(
    key="proposed_or",
    title="Proposed OR formula",
    short_title="OR",
    symbol="OR",
    role="proposed OR",
    kind="probability",
    order=10,
    selects=True,
    selecting_flags=("extrapolated",),
    predicts=BY_RATIO,
    reference=Reference(
        title="Overturning Risk of Furniture in Earthquake Affected Areas",
        remark="Section 4, equations (8) and (9), Table 3.",
    ),
    needs=frozenset({"breadth", "height", "pfa"}),
    valid={"breadth_to_height": CHECKED_BREADTH_TO_HEIGHT, "pfa": CHECKED_PFA},
    evaluate=evaluate,
    steps=steps,
    live=live,
    columns=(Column("raw", "OR as printed"),),
    equations=(
        "OR = a + b/(B/H) + c·PFA + d/(B/H)² + e·PFA² + f·PFA/(B/H)   (9), PFA in cm/s²",
        *(_list_coefficients(names) for names in ("abc", "def")),
    ),
    reasons=(
        Reason(
            "PFA {pfa_g} g is {pfa_to_start} times g·B/H, above which rocking can start; the proposed formula is a "
            "surface fitted to results and knows no such threshold: it still gives {value}.",
            side="above",
            can_rock=False,
        ),
        Reason(
            "The proposed formula depends on B/H {breadth_to_height} and PFA {pfa_g} g only and gives {value}, "
            "whatever the size of the piece and the velocity of the floor."
        ),
        Reason(
            "B/H {breadth_to_height} is below the range of the proposed formula: its value is that of the B/H of "
            "largest risk.",
            flag="thin",
        ),
        Reason(
            "B/H {breadth_to_height} at PFA {pfa_g} g lies outside the range in which the proposed formula was "
            "checked.",
            flag="extrapolated",
        ),
    ),
    assumptions=(
        BLOCK,
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
        "clipped": CLIPPED,
    },
)
