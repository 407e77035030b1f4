"""A model that a study fitted, kept in a small TOML file, as one more method: shown beside the others, never adopted.

Equations
---------
polynomial  R = sum of c·u^i·PFA^j, u = B/H or 1/(B/H), PFA in cm/s², as equation (9) of the paper
probit      R = Φ(b_0 + b_1 ln[PFA/(g B/H)] + b_2 ln[p PFV/(g B/H)]), b_1, b_2 ≥ 0, p of equation (4)

Reference
---------
The groups PFA/(g tan α) and p PFV/(g tan α) are those of Dimitrakopoulos and Paraskeva (2015), tan α = B/H.
"""

import string
from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Literal

import numpy as np

from assess.methods._method import BoolArray, Cases, FloatArray, Outcome, Range, normal_cdf
from assess.rocking.block import frequency_parameter
from assess.settings import Settings
from assess.units import ACCELERATION, GRAVITY, LENGTH, VELOCITY

Base = Literal["x", "1/x"]
Powers = tuple[int, int]
"""Powers i of the base and j of PFA in a term."""

PREFIX = "fitted_"
"""How the key of every such method begins."""


def expand(base: Base, powers: Sequence[Powers], x: FloatArray, y: FloatArray) -> list[FloatArray]:
    """Return u^i y^j, (n,) each, of x = B/H [-] and y = PFA [cm/s2]; u is x or 1/x."""
    u = x if base == "x" else 1 / x
    return [_raise(u, i) * _raise(y, j) for i, j in powers]


def _raise(values: FloatArray, power: int) -> FloatArray:
    return reduce(np.multiply, [values] * power, np.ones_like(values))


def write_sum(base: Base, powers: Sequence[Powers], x: str, y: str) -> str:
    """Return the sum of terms with a, b, c... for their coefficients: ``a + b/x + c·y``."""
    return " + ".join(
        letter + (f"·{y}{_SIGNS[j]}" if j else "") + (f"{'·' if base == 'x' else '/'}{x}{_SIGNS[i]}" if i else "")
        for letter, (i, j) in zip(string.ascii_lowercase, powers, strict=False)
    )


_SIGNS = ("", "", "²", "³")


def find_groups(
    *, breadth: FloatArray, height: FloatArray, pfa: FloatArray, pfv: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return PFA/(g B/H) and p PFV/(g B/H) [-], (n,) each, of sizes [m] and peaks [m/s2], [m/s]."""
    start = GRAVITY * breadth / height
    return pfa / start, frequency_parameter(breadth, height) * pfv / start


@dataclass(frozen=True, slots=True)
class Polynomial:
    """Terms (i, j, coefficient) of B/H [-], or of its inverse, and PFA [cm/s2]."""

    base: Base
    terms: tuple[tuple[int, int, float], ...]

    @property
    def powers(self) -> list[Powers]:
        """The powers of each term."""
        return [(i, j) for i, j, _ in self.terms]

    @np.errstate(all="ignore")
    def evaluate(self, cases: Cases) -> FloatArray:
        """Return the sum of the terms for n cases [-], which knows no bounds."""
        x, y = cases.breadth_to_height, cases.pfa / ACCELERATION["cm/s2"]
        columns = expand(self.base, self.powers, x, y)
        total = sum((c * column for (_, _, c), column in zip(self.terms, columns, strict=True)), np.zeros_like(x))
        return np.where(np.isnan(x) | np.isnan(y), np.nan, total)


@dataclass(frozen=True, slots=True)
class Probit:
    """Coefficients of the probit [-]; `b1` and `b2` are 0 or above."""

    b0: float
    b1: float
    b2: float

    @np.errstate(all="ignore")
    def evaluate(self, cases: Cases) -> FloatArray:
        """Return the chance of n cases [-]; 0 where nothing moves, NaN where PFV is unknown."""
        A, V = find_groups(breadth=cases.breadth, height=cases.height, pfa=cases.pfa, pfv=cases.pfv)
        chance = normal_cdf(self.b0 + self.b1 * np.log(A) + self.b2 * np.log(V))
        return np.where(np.isnan(A) | np.isnan(V), np.nan, np.where((A > 0) & (V > 0), chance, 0.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class Fitted:
    """A fitted model.

    Parameters
    ----------
    key, title : str
        The key begins with `PREFIX`.
    fitted_on : str
        Buildings, motions, runs and seed, in words.
    formula : Polynomial or Probit
        With its coefficients.
    breadth_to_height, pfa, height, pfv, pfv_to_pfa : Range
        What it was fitted to [-], [g], [cm], [cm/s], [s]; the last is PFV over PFA.
    error, error_spread : float
        Root mean square error where a building is left out of the fit, and its standard error [-].
    error_constant : float
        That of a constant, the mean chance of the other buildings [-].
    """

    key: str
    title: str
    fitted_on: str
    formula: Polynomial | Probit
    breadth_to_height: Range
    pfa: Range
    height: Range
    pfv: Range
    pfv_to_pfa: Range
    error: float
    error_spread: float
    error_constant: float

    @property
    def kind(self) -> str:
        """``polynomial`` or ``probit``, as in its file."""
        return "probit" if isinstance(self.formula, Probit) else "polynomial"

    def holds(self, cases: Cases) -> BoolArray:
        """Tell for each of n cases whether it lies inside the data (n,); where PFV is unknown it does not."""
        with np.errstate(all="ignore"):
            pfv_to_pfa = cases.pfv / cases.pfa
        held: Sequence[BoolArray] = (
            self.breadth_to_height.holds(cases.breadth_to_height),
            self.pfa.holds(cases.pfa / ACCELERATION["g"]),
            self.height.holds(cases.height / LENGTH["cm"]),
            self.pfv.holds(cases.pfv / VELOCITY["cm/s"]),
            self.pfv_to_pfa.holds(pfv_to_pfa),
        )
        return reduce(np.logical_and, held)

    def evaluate(self, cases: Cases, settings: Settings) -> Outcome:
        """Return the chance of n cases, with the unbounded value and the cautions."""
        found = self.formula.evaluate(cases)
        raw = np.where(np.isfinite(found), found, np.nan)
        value = np.clip(raw, 0.0, 1.0)
        known = ~np.isnan(value)
        flags = {"extrapolated": known & ~self.holds(cases), "clipped": known & (value != raw)}
        if isinstance(self.formula, Probit):
            flags |= {"pfv_unknown": np.isnan(cases.pfv), "pfv_estimated": known & cases.pfv_estimated}
        return Outcome(value, {"raw": raw}, flags)
