"""The worked example of the two formulas of the paper: equation (9), and Kaneko and Hayashi's equations (5) to (7)."""

import math
from collections.abc import Mapping

import numpy as np

from assess.language import gettext as _
from assess.methods import kaneko_hayashi
from assess.methods.kaneko_hayashi import G
from assess.methods.proposed_or import COEFFICIENTS, THIN_PFA_CAP, turning_breadth_to_height, turning_pfa
from assess.methods.proposed_or import METHOD as PROPOSED_OR
from assess.report.example.steps import Piece, Worked, chance, fill_in, phi, show_acceleration, show_ratio

# ---------------------------------------------------------------- proposed OR


def work_proposed_or(piece: Piece) -> Worked:
    """Work equation (9) term by term, then the departures from it."""
    k, x, y = COEFFICIENTS, piece.B / piece.H, piece.PFA
    terms = {"a": k.a, "b": k.b / x, "c": k.c * y, "d": k.d / x**2, "e": k.e * y**2, "f": k.f * y / x}
    put = _sizes() | {"x": x, "y": y}
    total = {name: abs(term) for name, term in terms.items()} | {"raw": piece.detail(PROPOSED_OR, "raw")}
    steps = [
        show_ratio(piece),
        show_acceleration(piece),
        fill_in("a = -{a:.8f}", **put),
        fill_in("b/(B/H) = {b:.8f}/{x:.5f} = {term:.4f}", **put, term=terms["b"]),
        fill_in("c·PFA = {c:.10f}·{y:.6g} = {term:.4f}", **put, term=terms["c"]),
        fill_in("d/(B/H)² = -{d:.9f}/{x:.5f}² = {term:.4f}", **put, term=terms["d"]),
        fill_in("e·PFA² = -{e:.9f}·{y:.6g}² = {term:.4f}", **put, term=terms["e"]),
        fill_in("f·PFA/(B/H) = -{f:.11f}·{y:.6g}/{x:.5f} = {term:.4f}", **put, term=terms["f"]),
        fill_in("{name} = -{a:.4f} + {b:.4f} + {c:.4f} - {d:.4f} - {e:.4f} - {f:.4f} = {raw:.4f}", **total,
                name=_("OR as printed (9)")),
    ]  # fmt: skip
    return steps + _departures(piece), chance("OR", piece.value(PROPOSED_OR))


def _sizes() -> dict[str, float]:
    """Return the coefficients without their signs: b and c are positive, the others negative."""
    return {name: abs(float(getattr(COEFFICIENTS, name))) for name in "abcdef"}


def _departures(piece: Piece) -> list[str]:
    """Return how the departures from equation (9) apply: thin pieces, strong motion, the bounds 0 and 1."""
    is_thin, is_held = piece.has(PROPOSED_OR, "thin"), piece.has(PROPOSED_OR, "held")
    steps = _thin(piece, is_thin) + _held(piece, is_held)
    x, y = _used(piece)
    k = COEFFICIENTS
    value = k.a + k.b / x + k.c * y + k.d / x**2 + k.e * y**2 + k.f * y / x
    if is_thin or is_held:
        steps.append(fill_in(
            "OR = -{a:.8f} + {b:.8f}/{x:.5f} + {c:.10f}·{y:.6g} - {d:.9f}/{x:.5f}² - {e:.9f}·{y:.6g}² "
            "- {f:.11f}·{y:.6g}/{x:.5f} = {value:.4f}", **_sizes(), x=x, y=y, value=value,
        ))  # fmt: skip
    if piece.has(PROPOSED_OR, "clipped"):
        bound = _("above 1: it is set to 1") if value > 1 else _("below 0: it is set to 0")
        steps.append(_("A probability lies between 0 and 1; this is {bound}.", bound=bound))
    return steps


def _used(piece: Piece) -> tuple[float, float]:
    """Return the B/H [-] and PFA [cm/s2] at which equation (9) is evaluated."""
    x = max(piece.B / piece.H, float(turning_breadth_to_height(np.array(piece.PFA))))
    return x, min(piece.PFA, float(turning_pfa(np.array(x))))


def _thin(piece: Piece, applies: bool) -> list[str]:
    y, turn = min(piece.PFA, THIN_PFA_CAP), float(turning_breadth_to_height(np.array(piece.PFA)))
    steps = [_("In B/H*, PFA counts up to {cap:g} cm/s² only.", cap=THIN_PFA_CAP)] if piece.PFA > THIN_PFA_CAP else []
    steps += [
        fill_in("B/H* = -2d/(b + f·PFA) = 2·{d:.9f}/({b:.8f} - {f:.11f}·{y:.6g}) = {turn:.5f}",
                **_sizes(), y=y, turn=turn),
        _("B/H lies below B/H*, where equation (9) would call a thinner piece safer: B/H* is put in its place.")
        if applies else _("B/H is not below B/H*: it is used as it is."),
    ]  # fmt: skip
    return steps


def _held(piece: Piece, applies: bool) -> list[str]:
    x, turn = _used(piece)[0], float(turning_pfa(np.array(_used(piece)[0])))
    return [
        fill_in("PFA* = (c + f/(B/H))/(-2e) = ({c:.10f} - {f:.11f}/{x:.5f})/(2·{e:.9f}) = {turn:.6g} cm/s²",
                **_sizes(), x=x, turn=turn),
        _("PFA lies above PFA*, past which equation (9) would fall again: PFA* is put in its place.")
        if applies else _("PFA is not above PFA*: it is used as it is."),
    ]  # fmt: skip


# ---------------------------------------------------------------- Kaneko-Hayashi


def work_kaneko_hayashi(piece: Piece) -> Worked:
    """Work equations (5) to (7), or the upper bound where PFV is unknown."""
    method, settings = kaneko_hayashi.METHOD, piece.settings
    lambda_a = math.log(piece.detail(method, "median_pfa_g") * G)
    put = piece.put | {
        "lambda_a": lambda_a, "median": math.exp(lambda_a), "alpha": settings.slide_coefficient,
        "zeta_a": settings.zeta_acceleration, "zeta_v": settings.zeta_velocity,
    }  # fmt: skip
    steps = [
        show_ratio(piece),
        show_acceleration(piece),
        fill_in("λ_A = ln[(B/H)·g·(1 + B/H)] = ln({x:.5f}·{g:.3f}·(1 + {x:.5f})) = {lambda_a:.5f}", **put),
    ]
    if math.isnan(piece.PFV):
        steps += _upper_bound(piece, put)
    else:
        steps += _branches(piece, put)
    return steps, chance("R", piece.value(method))


def _upper_bound(piece: Piece, put: Mapping[str, float]) -> list[str]:
    k = piece.PFA / put["median"]
    shares = {zeta: phi(math.log(k) / put[zeta]) if k > 0 else 0.0 for zeta in ("zeta_a", "zeta_v")}
    put = {**put, "k": k, "phi_a": shares["zeta_a"], "phi_v": shares["zeta_v"], "most": max(shares.values())}
    return [
        _("PFV is unknown: the largest risk that any PFV could give is taken."),
        fill_in("k = PFA/exp(λ_A) = {PFA:.6g}/exp({lambda_a:.5f}) = {k:.5f}", **put),
        fill_in("Φ(ln k/ζ_A) = Φ(ln({k:.5f})/{zeta_a:g}) = {phi_a:.4f}", **put),
        fill_in("Φ(ln k/ζ_V) = Φ(ln({k:.5f})/{zeta_v:g}) = {phi_v:.4f}", **put),
        _("The larger of the two counts, times the slide coefficient α."),
        fill_in("R = {alpha:g}·{most:.4f} = {R:.4f}", **put, R=piece.value(kaneko_hayashi.METHOD)),
    ]


def _branches(piece: Piece, put: Mapping[str, float]) -> list[str]:
    method, is_velocity = kaneko_hayashi.METHOD, piece.case.methods["kaneko_hayashi"].detail["branch"] == "pfv"
    lambda_v = math.log(piece.detail(method, "median_pfv_cm_s"))
    z = (np.log(piece.PFV) - lambda_v) / put["zeta_v"] if is_velocity else (
        np.log(piece.PFA) - put["lambda_a"]) / put["zeta_a"]  # fmt: skip
    put = {
        **put, "lambda_v": lambda_v, "z": float(z), "R": piece.value(method),
        "F_f": piece.detail(method, "floor_frequency_hz"), "F_b": piece.detail(method, "boundary_frequency_hz"),
    }  # fmt: skip
    steps = [
        fill_in(
            "λ_V = ln[10·B/√H·(1 + B/H)^2.5] = ln(10·{B:.6g}/√({H:.6g})·(1 + {x:.5f})^2.5) = {lambda_v:.5f}", **put
        ),
        fill_in("F_f = PFA/(2π·PFV) = {PFA:.6g}/(2·π·{PFV:.6g}) = {F_f:.4f} Hz", **put),
        fill_in("F_b = 15.6/√H·(1 + B/H)^-1.5 = 15.6/√({H:.6g})·(1 + {x:.5f})^(-1.5) = {F_b:.4f} Hz", **put),
    ]
    if piece.has(method, "pfv_estimated"):
        steps.insert(0, _("PFV = {PFV:.6g} cm/s is an estimate from PFA and the building's period T1.", PFV=piece.PFV))
    if is_velocity:
        steps += [
            _("F_f is above F_b: the second line of equation (5) applies, that of the velocity."),
            fill_in("z = (ln PFV - λ_V)/ζ_V = (ln({PFV:.6g}) - {lambda_v:.5f})/{zeta_v:g} = {z:.4f}", **put),
        ]
    else:
        steps += [
            _("F_f is not above F_b: the first line of equation (5) applies, that of the acceleration."),
            fill_in("z = (ln PFA - λ_A)/ζ_A = (ln({PFA:.6g}) - {lambda_a:.5f})/{zeta_a:g} = {z:.4f}", **put),
        ]
    return [*steps, fill_in("R = α·Φ(z) = {alpha:g}·Φ({z:.4f}) = {R:.4f}", **put)]
