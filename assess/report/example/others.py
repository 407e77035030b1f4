"""The worked example of the criteria, of FEMA P-58 and of the direct integration."""

import math

import numpy as np

from assess.cases import VerificationResult
from assess.language import gettext as _
from assess.methods import fema_p58, ishiyama, japan_rule, static
from assess.methods._method import FloatArray
from assess.methods.housner_monte_carlo import interval_width
from assess.report.example.steps import Piece, Worked, chance, fill_in, phi, show_ratio, verdict
from assess.units import GRAVITY, LENGTH


def _array(value: float) -> FloatArray:
    return np.array(value, dtype=np.float64)


def _angle(piece: Piece) -> float:
    return math.atan(piece.B / piece.H)


def _restitution(piece: Piece) -> float:
    return 1 - 1.5 * math.sin(_angle(piece)) ** 2


# ---------------------------------------------------------------- criteria


def _threshold(piece: Piece) -> list[str]:
    """Return the steps of PFA > g·B/H."""
    limit = piece.B / piece.H * piece.put["g"]
    numbers = {"PFA": piece.PFA, "limit": limit}
    return [
        show_ratio(piece),
        fill_in("g·B/H = {g:.3f}·{x:.5f} = {limit:.6g} cm/s²", **piece.put, limit=limit),
        _("PFA = {PFA:.6g} cm/s² is above {limit:.6g} cm/s².", **numbers)
        if piece.value(static.METHOD)
        else _("PFA = {PFA:.6g} cm/s² is not above {limit:.6g} cm/s².", **numbers),
    ]


def work_static(piece: Piece) -> Worked:
    """Work the condition at which rocking starts."""
    return _threshold(piece), verdict(piece, static.METHOD)


def work_ishiyama(piece: Piece) -> Worked:
    """Work both limits; that of the velocity only where the other is exceeded."""
    steps = _threshold(piece)
    limit = piece.detail(ishiyama.METHOD, "threshold_pfv_cm_s")
    steps.append(fill_in("10·B/√H = 10·{B:.6g}/√({H:.6g}) = {limit:.6g} cm/s", **piece.put, limit=limit))
    numbers = {"PFV": piece.PFV, "limit": limit}
    if math.isnan(piece.PFV):
        steps.append(_("PFV is unknown, but need not be known."))
    elif limit < piece.PFV:
        steps.append(_("PFV = {PFV:.6g} cm/s is above {limit:.6g} cm/s.", **numbers))
    else:
        steps.append(_("PFV = {PFV:.6g} cm/s is not above {limit:.6g} cm/s.", **numbers))
    return steps, verdict(piece, ishiyama.METHOD)


def work_japan_rule(piece: Piece) -> Worked:
    """Work B/√H against its limit."""
    ratio = piece.detail(japan_rule.METHOD, "breadth_over_root_height")
    numbers = {"ratio": ratio, "limit": japan_rule.LIMIT}
    steps = [
        fill_in("B/√H = {B:.6g}/√({H:.6g}) = {ratio:.4f} (cm)", **piece.put, ratio=ratio),
        _("{ratio:.4f} is not above {limit:g}.", **numbers)
        if piece.value(japan_rule.METHOD)
        else _("{ratio:.4f} is above {limit:g}.", **numbers),
    ]
    return steps, verdict(piece, japan_rule.METHOD)


# ---------------------------------------------------------------- FEMA P-58


def work_fema_p58(piece: Piece) -> Worked:
    """Work the median velocity from the piece's size, then the chance at the floor's."""
    method, angle, restitution = fema_p58.METHOD, _angle(piece), _restitution(piece)
    put = piece.put | {
        "angle": angle,
        "V_imp": float(fema_p58._impulse_velocity(_array(piece.H), _array(angle), piece.put["g"])),
        "C_R": restitution,
        "gamma": -2 * math.log(restitution),
        "beta_e": float(fema_p58._effective_damping(_array(restitution))),
        "median": piece.detail(method, "median_pfv_cm_s"),
        "beta": fema_p58.BETA,
    }
    put["z"] = float(np.log(piece.PFV / put["median"])) / fema_p58.BETA
    put["P"] = phi(put["z"])
    steps = [
        fill_in("α = atan(B/H) = atan({x:.5f}) = {angle:.6f} rad", **put),
        fill_in("V_imp = √[(4/3)·g·H·(1/cos α - 1)/cos² α] = √((4/3)·{g:.3f}·{H:.6g}·(1/cos({angle:.6f}) - 1)"
                "/cos({angle:.6f})²) = {V_imp:.6g} cm/s", **put),
        fill_in("C_R = 1 - 1.5·sin² α = 1 - 1.5·sin({angle:.6f})² = {C_R:.6f}", **put),
        fill_in("γ = -2·ln C_R = -2·ln({C_R:.6f}) = {gamma:.6f}", **put),
        fill_in("β_e = γ/√(4π² + γ²) = {gamma:.6f}/√(4·π² + {gamma:.6f}²) = {beta_e:.6f}", **put),
        fill_in("PFV50 = V_imp/[2.31 - 0.41·ln(100·β_e)] = {V_imp:.6g}/(2.31 - 0.41·ln(100·{beta_e:.6f})) "
                "= {median:.6g} cm/s", **put),
        fill_in("z = ln(PFV/PFV50)/β = ln({PFV:.6g}/{median:.6g})/{beta:g} = {z:.4f}", **put),
        fill_in("P = Φ(z) = Φ({z:.4f}) = {P:.4f}", **put),
    ]  # fmt: skip
    if piece.has(method, "pfv_estimated"):
        steps.insert(0, _("PFV = {PFV:.6g} cm/s is an estimate from PFA and the building's period T1.", PFV=piece.PFV))
    return steps, chance("P", piece.value(method))


# ---------------------------------------------------------------- direct integration


def work_housner(piece: Piece) -> Worked:
    """Work the numbers of the block, then the share of motions that overturn it, and its interval."""
    found = piece.case.verification
    if found is None:
        raise ValueError("the piece was not integrated")
    return [*_block(piece), *_share(piece, found), *_under_record(found)], chance("R", found.probability)


def _block(piece: Piece) -> list[str]:
    B, H = piece.B * LENGTH["cm"], piece.H * LENGTH["cm"]
    r = 0.5 * math.hypot(B, H)
    put = {
        "x": piece.B / piece.H, "B": B, "H": H, "r": r, "angle": _angle(piece), "g": GRAVITY,
        "p": math.sqrt(3 * GRAVITY / (4 * r)), "eta": _restitution(piece), "limit": GRAVITY * B / H,
    }  # fmt: skip
    fixed = not math.isnan(piece.restitution)
    return [
        fill_in("α = atan(B/H) = atan({x:.5f}) = {angle:.6f} rad", **put),
        fill_in("r = ½·√(B² + H²) = 0.5·√({B:.6g}² + {H:.6g}²) = {r:.5f} m", **put),
        fill_in("p = √(3g/4r) = √(3·{g:.5f}/(4·{r:.5f})) = {p:.4f} rad/s", **put),
        _("η = {eta:g}, as set for the building.", eta=piece.restitution)
        if fixed
        else fill_in("η = 1 - 1.5·sin² α = 1 - 1.5·sin({angle:.6f})² = {eta:.4f}", **put),
        fill_in("g·B/H = {g:.5f}·{x:.5f} = {limit:.4f} m/s²", **put),
        _("The piece starts to rock where the floor's acceleration exceeds {limit:.4f} m/s².", **put),
    ]


def _share(piece: Piece, found: VerificationResult) -> list[str]:
    z = interval_width(piece.settings)
    put = {"k": found.overturned, "n": found.runs, "R": found.probability, "z": z, "low": found.low, "high": found.high}
    return [
        _("It overturned under {k:,} of {n:,} motions.", **put),
        fill_in("R = {k}/{n} = {R:.4f}", **put),
        fill_in("{name} = ({R:.5f} + {z:.4f}²/(2·{n}) - {z:.4f}·√({R:.5f}·(1 - {R:.5f})/{n} "
                "+ {z:.4f}²/(4·{n}²)))/(1 + {z:.4f}²/{n}) = {low:.4f}", **put, name=_("low (Wilson)")),
        fill_in("{name} = ({R:.5f} + {z:.4f}²/(2·{n}) + {z:.4f}·√({R:.5f}·(1 - {R:.5f})/{n} "
                "+ {z:.4f}²/(4·{n}²)))/(1 + {z:.4f}²/{n}) = {high:.4f}", **put, name=_("high (Wilson)")),
        _("The 95 % interval reaches from {low:.4f} to {high:.4f} (Wilson, z = {z:.2f}).", **put),
    ]  # fmt: skip


def _under_record(found: VerificationResult) -> list[str]:
    if found.record_overturned is None:
        return []
    if found.record_overturned:
        return [_("Under the recorded motion itself it overturns, so its class is at least high.")]
    return [_("Under the recorded motion itself it does not overturn.")]
