"""The force that an anchored piece brings to its bracket, and the force that a code asks for.

A piece of weight W turns about its toe; a bracket at height h holds it back. For a horizontal acceleration k and an
upward one k_v, both as shares of g, moments about the toe give the tension T = W [k z - (1 - k_v) B/2]/h, and nothing
where the weight alone holds it. What the base has to carry is |k W - T|: friction carries at most mu (1 - k_v) W of
it. A bracket below z - B/(2 k), without k_v, takes more than k W, and the base slides towards the wall.

References
----------
ASCE/SEI 7-22, Minimum Design Loads and Associated Criteria for Buildings and Other Structures, section 13.3.1:
F_p = 0.4 S_DS I_p W (H_f/R_mu)(C_AR/R_po), at least 0.3 and at most 1.6 S_DS I_p W. As in public implementations of it.
EN 1998-1:2004, 4.3.5.2: F_a = S_a W_a gamma_a/q_a, S_a = alpha S [3 (1 + z/H)/(1 + (1 - T_a/T_1)^2) - 0.5], at least
alpha S. From memory: not checked against the code's own text.
NTC 2018, 7.2.3, eq. (7.2.1): F_a = S_a W_a/q_a; where nothing specific is known, S_a and q_a may follow "documenti di
comprovata validita", here EN 1998-1. From a public transcription of the clause.
"""

import numpy as np
from numpy.typing import ArrayLike

from assess.arrays import FloatArray
from assess.motion.scenario import PROFILES

LEAST, MOST = 0.3, 1.6  # limits of F_p over S_DS I_p W [-]
LEAST_DUCTILITY = 1.3  # R_mu is at least this above grade; 1 at or below it [-]


def find_tension(
    *, weight: ArrayLike, acceleration: ArrayLike, breadth: ArrayLike, centre: ArrayLike, height: ArrayLike,
    vertical: ArrayLike = 0.0,
) -> FloatArray:  # fmt: skip
    """Return the tension in a bracket, at least 0, in the unit of `weight`; ValueError if it is not above the floor.

    `weight`: W; `acceleration`: k, horizontal, over g [-]: PFA/g, or F_p/W; `breadth`: B, the side parallel to the
    motion; `centre`: z, height of the centre of gravity; `height`: h, of the bracket [m]; `vertical`: k_v, upward, over
    g [-].
    """
    w, k, b, z, h, up = (np.asarray(one, float) for one in (weight, acceleration, breadth, centre, height, vertical))
    _check_height(h)
    return np.asarray(np.maximum(w * (k * z - (1 - up) * b / 2) / h, 0.0))


def find_tension_without_weight(
    *, weight: ArrayLike, acceleration: ArrayLike, centre: ArrayLike, height: ArrayLike
) -> FloatArray:
    """Return the tension if the weight helped nothing, k W z/h: a bound; parameters and errors as `find_tension`."""
    w, k, z, h = (np.asarray(one, float) for one in (weight, acceleration, centre, height))
    _check_height(h)
    return np.asarray(w * k * z / h)


def find_needed_friction(
    *, weight: ArrayLike, acceleration: ArrayLike, tension: ArrayLike, vertical: ArrayLike = 0.0
) -> FloatArray:
    """Return the coefficient of friction below which an anchored piece slides at its base, out or to the wall [-].

    `tension` is that of its bracket; the other parameters are as in `find_tension`. Infinite where k_v is 1 or more.
    """
    w, k, t, up = (np.asarray(one, float) for one in (weight, acceleration, tension, vertical))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(up < 1, np.abs(k - t / w) / (1 - up), np.inf))


def find_code_demand(
    *, sds: float, height_ratio: float, resonance: float, strength: float, importance: float = 1.0,
    ductility: float = LEAST_DUCTILITY, period: float | None = None,
) -> float:  # fmt: skip
    """Return F_p/W by ASCE 7-22, 13.3.1 [-]; ValueError if the height ratio is not between 0 and 1.

    `sds`: S_DS, over g [-]; `height_ratio`: z/h of the floor, 0 is at or below grade; `resonance`, `strength`: C_AR and
    R_po of the piece; `importance`: I_p; `ductility`: R_mu of the building, at least 1.3 above grade and 1 at or below
    it; `period`: T_a of the building [s]; None where it is not known.
    """
    if not 0 <= height_ratio <= 1:
        raise ValueError(f"height_ratio is {height_ratio}, expected 0 to 1")
    is_above = height_ratio > 0
    reduction = max(ductility, LEAST_DUCTILITY) if is_above else 1.0
    amplification = PROFILES["ASCE 7-22"].amplification(height_ratio, period)
    share = 0.4 * amplification / reduction * resonance / strength
    return sds * importance * min(max(share, LEAST), MOST)


def find_european_demand(
    *, ground: float, height_ratio: float, behaviour: float, importance: float = 1.0, element_period: float = 0.0,
    period: float | None = None,
) -> float:  # fmt: skip
    """Return F_a/W_a by EN 1998-1, 4.3.5.2 [-]; ValueError if the height ratio is not between 0 and 1.

    `ground`: alpha S, over g [-]; `height_ratio`: z/H of the floor; `behaviour`: q_a; `importance`: gamma_a, 1 by NTC
    2018; `element_period`: T_a of the piece [s]; `period`: T_1 of the building [s], None where it is not known: the
    piece is then taken to be at resonance, unless T_a is 0.
    """
    if not 0 <= height_ratio <= 1:
        raise ValueError(f"height_ratio is {height_ratio}, expected 0 to 1")
    detuning = 1 - element_period / period if period else float(element_period == 0)
    # Equation (4.25)
    share = 3 * (1 + height_ratio) / (1 + detuning**2) - 0.5
    # Equation (4.24)
    return ground * max(share, 1.0) * importance / behaviour


def _check_height(height: FloatArray) -> None:
    if not (height > 0).all():
        raise ValueError("the height of a bracket must be above 0")
