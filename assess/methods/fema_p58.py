"""FEMA P-58 contents (key ``fema_p58``): the chance that unanchored contents overturn, lognormal in PFV.

Reference
---------
FEMA P-58, second edition, fragility database 3.1.2, E.20.22.102a to 125a (unanchored bookcases and filing cabinets),
as the SimCenter DamageAndLossModelLibrary carries it.

Equations
---------
P = Φ(ln(PFV/PFV50)/β), β = 0.5
PFV50 = V_imp/[2.31 - 0.41 ln(100 β_e)]
V_imp = √[(4/3) g H (1/cos α - 1)/cos² α], α = atan(B/H)
C_R = 1 - 1.5 sin² α, γ = -2 ln C_R, β_e = γ/√(4π² + γ²)

Validity
--------
The nine published medians lie at B/H 0.155 to 0.625; the closed form gives all of them within 2 %.

Departures
----------
FEMA P-58 publishes nine medians and no formula. The closed form is *inferred* from them: it is the reserve-energy
method of ASCE 43-05, Appendix A, at a rotation of α, with the Newmark-Hall median amplification of velocity (1.65 at
5 % damping).
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from assess.arrays import FloatArray
from assess.i18n import Text
from assess.methods.cases import Cases
from assess.methods.expression import G, normal_cdf, number, show
from assess.methods.method import PFV_FLAGS, Column, Example, LiveCells, Method, Outcome, Range, Reason, Reference
from assess.rocking.block import STOCKY, critical_angle
from assess.settings import Settings
from assess.units import GRAVITY, VELOCITY

BETA = 0.5
"""Published dispersion: logarithmic standard deviation of the median PFV [-]."""

CHECKED_BREADTH_TO_HEIGHT = Range(0.155, 0.625)


# Velocity of an impulse that just overturns the block (West, Ishiyama)
def _impulse_velocity(H: Any, alpha: Any, g: Any) -> Any:
    return np.sqrt(4 / 3 * g * H * (1 / np.cos(alpha) - 1) / np.cos(alpha) ** 2)


# ASCE 43-05, Appendix A: damping that loses as much as the impacts do
def _restitution(alpha: Any) -> Any:
    return 1 - 1.5 * np.sin(alpha) ** 2


def _gamma(C_R: Any) -> Any:
    return -2 * np.log(C_R)


def _damping(gamma: Any) -> Any:
    return gamma / np.sqrt(4 * np.pi**2 + gamma**2)


# Newmark and Hall: median amplification of velocity
def _velocity_amplification(beta_e: Any) -> Any:
    return 2.31 - 0.41 * np.log(100 * beta_e)


@np.errstate(all="ignore")
def median_pfv(breadth: FloatArray, height: FloatArray) -> FloatArray:
    """Median PFV that overturns the piece [m/s]; NaN where the piece does not rock."""
    V_imp = _impulse_velocity(height, critical_angle(breadth, height), GRAVITY)
    beta_e = _damping(_gamma(_restitution(critical_angle(breadth, height))))
    return np.where(breadth / height < STOCKY, V_imp / _velocity_amplification(beta_e), np.nan)


@np.errstate(all="ignore")
def evaluate(cases: Cases, settings: Settings) -> Outcome:
    """Evaluate the fragility at the floor's PFV."""
    median = median_pfv(cases.breadth, cases.height)
    value = normal_cdf(np.log(cases.pfv / median) / BETA)
    is_rocking = ~np.isnan(cases.pfv) & ~cases.is_stocky
    flags = {
        "pfv_unknown": np.isnan(cases.pfv),
        "does_not_rock": cases.is_stocky,
        "extrapolated": is_rocking & ~CHECKED_BREADTH_TO_HEIGHT.holds(cases.breadth_to_height),
    }
    return Outcome(value, {"median_pfv_cm_s": median / VELOCITY["cm/s"]}, flags)


def live(cells: LiveCells) -> Mapping[str, Any]:
    """Return the value; blank where PFV is unknown or the piece is too stocky, 0 without shaking."""
    B_H, PFV, alpha = cells.breadth_to_height, cells.pfv_cm_s, np.arctan(cells.breadth_to_height)
    beta_e = _damping(_gamma(_restitution(alpha)))
    median = _impulse_velocity(cells.height_cm, alpha, G) / _velocity_amplification(beta_e)
    chance = np.where(PFV <= 0, 0, normal_cdf(np.log(PFV / median) / BETA))
    return {"value": np.where(B_H < STOCKY, np.where(np.isnan(PFV), np.nan, chance), np.nan)}


def steps(example: Example) -> list[Text]:
    """Work the median velocity from the piece's size, then the chance at the floor's."""
    B, H, PFV = (number(one, ".6g") for one in (example.breadth, example.height, example.pfv))
    alpha: Any = np.arctan(B / H)
    C_R: Any = _restitution(number(float(alpha.value), ".6f"))
    V_imp = _impulse_velocity(H, number(float(alpha.value), ".6f"), number(G, ".3f"))
    gamma = _gamma(number(float(C_R.value), ".6f"))
    beta_e = _damping(number(float(gamma.value), ".6f"))
    median = number(float(V_imp.value), ".6g") / _velocity_amplification(number(float(beta_e.value), ".6f"))
    z = np.log(PFV / number(example.number("median_pfv_cm_s"), ".6g")) / BETA
    return [
        show("α = atan(B/H)", alpha, ".6f", "rad"),
        show("V_imp = √[(4/3)·g·H·(1/cos α - 1)/cos² α]", V_imp, ".6g", "cm/s"),
        show("C_R = 1 - 1.5·sin² α", C_R, ".6f"),
        show("γ = -2·ln C_R", gamma, ".6f"),
        show("β_e = γ/√(4π² + γ²)", beta_e, ".6f"),
        show("PFV50 = V_imp/[2.31 - 0.41·ln(100·β_e)]", median, ".6g", "cm/s"),
        show("z = ln(PFV/PFV50)/β", z, ".4f"),
        show("P = Φ(z)", normal_cdf(number(float(z.value), ".4f")), ".4f"),
    ]


METHOD = Method(
    key="fema_p58",
    title="FEMA P-58 contents",
    short_title="FEMA P-58",
    symbol="P",
    role="best formula",
    kind="probability",
    order=5,
    selects=True,
    selecting_flags=("extrapolated",),
    predicts="The chance that unanchored contents overturn, from their size and the peak floor velocity.",
    reference=Reference(
        authors="Federal Emergency Management Agency",
        year="2018",
        title="Seismic Performance Assessment of Buildings, FEMA P-58, second edition",
        source="Fragility database 3.1.2",
        remark="E.20.22.102a to E.20.22.125a, as carried by the SimCenter DamageAndLossModelLibrary.",
    ),
    needs=frozenset({"breadth", "height", "pfv"}),
    valid={"breadth_to_height": CHECKED_BREADTH_TO_HEIGHT},
    evaluate=evaluate,
    steps=steps,
    live=live,
    columns=(Column("median_pfv_cm_s", "Median PFV", "cm/s", ".1f"),),
    reasons=(
        Reason(
            "PFA {pfa_g} g is {pfa_to_start} times g·B/H, above which rocking can start; FEMA P-58 depends on velocity "
            "only and knows no such threshold: it still gives {value}.",
            side="above",
            can_rock=False,
        ),
        Reason(
            "FEMA P-58 depends on velocity only: PFV is {pfv_cm_s} cm/s, its median for such pieces {median_pfv_cm_s} "
            "cm/s."
        ),
        Reason("B/H {breadth_to_height} lies outside that of the published medians of FEMA P-58.", flag="extrapolated"),
    ),
    equations=(
        "P = Φ(ln(PFV/PFV50)/β), β = 0.5;  PFV50 = V_imp/[2.31 - 0.41 ln(100 β_e)]",
        "V_imp = √[(4/3) g H (1/cos α - 1)/cos² α], α = atan(B/H)",
        "C_R = 1 - 1.5 sin² α;  γ = -2 ln C_R;  β_e = γ/√(4π² + γ²)",
    ),
    assumptions=(
        "The published medians are for bookcases and filing cabinets of B/H 0.155 to 0.625; other pieces are taken "
        "to be alike.",
        "The piece is free-standing, rigid and homogeneous, its centroid at mid-height, and it does not slide.",
    ),
    departures=(
        "FEMA P-58 publishes nine medians and no formula. The closed form is inferred from them: it is the "
        "reserve-energy method of ASCE 43-05, Appendix A, with the Newmark-Hall median amplification of velocity, "
        "and it gives all nine within 2 %. That FEMA P-58 used it was not confirmed.",
        "Pieces of B/H 1.41 and above are not evaluated: Housner's restitution vanishes near there, and they do not "
        "rock.",
    ),
    flags={
        **PFV_FLAGS,
        "does_not_rock": "not evaluated: B/H is 1.41 or more, so the piece does not rock",
        "extrapolated": "outside the B/H of the nine published medians (0.155 to 0.625)",
    },
)
