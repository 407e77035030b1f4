"""Surfaces z(x, y) fitted to chances and ranked, as in section 4 of the paper: x = B/H, y = PFA [cm/s2], z the risk.

The candidates are polynomials in u = x or u = 1/x and y: equation (8) is one of them. They are fitted by ordinary least
squares and ranked by the error for buildings that were left out of the fit. R2, adjusted R2 and AIC are given as well;
they assume independent cases, which cases of one motion and one building are not.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.errors import InputError
from assess.studies.studied_methods import Base, BoolArray, FloatArray, Polynomial, Powers, expand, write_sum

ORDERS = (1, 2, 3)
ILL = 30.0
"""Condition number of the scaled columns above which the data determine only the sum of terms, not each coefficient.

Source: Belsley DA, Kuh E, Welsch RE (1980). Regression Diagnostics. Wiley: from 30 on, collinearity is strong.
"""
NEGLIGIBLE = 0.001
"""Difference of two errors that is ignored [-]: a tenth of the step of a chance out of 100 motions. Assumed here."""
Refit = Callable[[BoolArray], Callable[[BoolArray], FloatArray]]
"""Fits to the cases of a mask (n,), and returns a function that predicts the cases of another mask."""


@dataclass(frozen=True, slots=True, eq=False)
class Points:
    """The n cases that a surface is fitted to.

    * `x`, `y`, `z` (n,): B/H [-], PFA [cm/s2], and the chance of overturning [-].
    * `group` (n,): cases left out together: the building of each case, as text or number.
    """

    x: FloatArray
    y: FloatArray
    z: FloatArray
    group: NDArray[Any]

    def __post_init__(self) -> None:
        if not (self.x.shape == self.y.shape == self.z.shape == self.group.shape == (self.x.size,)):
            raise InputError("x, y, z and group have different lengths: give one of each for every case")
        if not (np.isfinite([self.x, self.y, self.z]).all() and (self.x > 0).all()):
            raise InputError("x, y or z is not finite, or an x is not above 0: leave such cases out")
        if np.unique(self.group).size < 2:
            raise InputError("all cases are of one group: give at least two, as one is left out")


@dataclass(frozen=True, slots=True)
class Candidate:
    """A polynomial to try: its base, orders, and the powers of its terms, the constant first."""

    base: Base
    order_u: int
    order_y: int
    is_crossed: bool
    powers: tuple[Powers, ...]

    @property
    def name(self) -> str:
        """Its name for readers; equation (8) is ``1/x to order 2, y to order 2, with cross terms``."""
        if len(self.powers) == 1:
            return "a constant"
        orders = f"{self.base} to order {self.order_u}, y to order {self.order_y}"
        return f"{orders}, {'with' if self.is_crossed else 'without'} cross terms"

    @property
    def equation(self) -> str:
        """Its equation, ``z = a + b/x + c·y`` and so on."""
        return f"z = {write_sum(self.base, self.powers, 'x', 'y')}"


def _list_candidates() -> tuple[Candidate, ...]:
    every = product(("x", "1/x"), ORDERS, ORDERS, (False, True))
    found = [Candidate(base, m, n, crossed, _find_powers(m, n, crossed)) for base, m, n, crossed in every]  # type: ignore[arg-type]
    first = {(one.base, one.powers): one for one in reversed(found)}
    return tuple(one for one in found if first[one.base, one.powers] is one)


def _find_powers(m: int, n: int, crossed: bool) -> tuple[Powers, ...]:
    """Return the powers up to orders m and n, as equation (8) orders them; crossed ones up to a degree of max(m, n)."""
    alone = [(0, 0), *((i, 0) for i in range(1, m + 1)), *((0, j) for j in range(1, n + 1))]
    mixed = [(i, j) for i in range(1, m + 1) for j in range(1, n + 1) if crossed and i + j <= max(m, n)]
    return tuple(sorted([*alone, *mixed], key=lambda one: (sum(one), 0 in one and -1, -one[0])))


CONSTANT = Candidate("x", 0, 0, False, ((0, 0),))
"""The trivial model, independent of piece and motion: a surface with no smaller error is of no use."""
CANDIDATES = (CONSTANT, *_list_candidates())
"""Every base, both orders from 1 to 3, with and without cross terms, without duplicates.

The paper calls those in 1/x Taylor series.
"""
EQUATION_8 = next(one for one in CANDIDATES if one.name == "1/x to order 2, y to order 2, with cross terms")


@dataclass(frozen=True, slots=True)
class LeftOut:
    """Errors for the groups left out in turn, each predicted by a fit to all others.

    * `squares`: mean square error of each group [-].
    """

    squares: tuple[float, ...]

    @property
    def error(self) -> float:
        """Root of the mean over groups [-]: every building counts alike, however many cases it has."""
        return float(np.sqrt(np.mean(self.squares)))

    @property
    def spread(self) -> float:
        """Standard error of `error` over the groups [-], to first order; a rough estimate for few groups."""
        scatter = float(np.std(self.squares, ddof=1)) / len(self.squares) ** 0.5
        return scatter / (2 * self.error) if self.error > 0 else 0.0

    def is_level(self, best: "LeftOut") -> bool:
        """Return whether it exceeds the best by at most the standard error of the best, or by `NEGLIGIBLE`."""
        return self.error - best.error <= max(best.spread, NEGLIGIBLE)


def leave_out(z: FloatArray, group: NDArray[Any], refit: Refit) -> LeftOut:
    """Leave out each group of cases (n,) in turn; `refit` fits to the others and predicts those left out."""
    squares = []
    for one in np.unique(group):
        out = np.asarray(group == one)
        squares.append(float(np.mean((refit(~out)(out) - z[out]) ** 2)))
    return LeftOut(tuple(squares))


@dataclass(frozen=True, slots=True)
class Surface:
    """A fitted candidate.

    * `coefficients`: in the order of its powers; PFA in cm/s2.
    * `r2`, `adjusted_r2`, `aic`: shares of the variance explained [-]; AIC = n ln(RSS/n) + 2k of normal errors, k
      coefficients.
    * `left_out`: errors for groups left out of the fit.
    * `condition`: condition number of the columns scaled to unit norm [-].
    """

    candidate: Candidate
    coefficients: tuple[float, ...]
    r2: float
    adjusted_r2: float
    aic: float
    left_out: LeftOut
    condition: float

    @property
    def is_ill_conditioned(self) -> bool:
        """Whether the data determine the sum of the terms, but not each coefficient (see `ILL`)."""
        return self.condition > ILL

    @property
    def polynomial(self) -> Polynomial:
        """The formula as the file of a model holds it."""
        pairs = zip(self.candidate.powers, self.coefficients, strict=True)
        return Polynomial(self.candidate.base, tuple((i, j, c) for (i, j), c in pairs))

    def predict(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return z at x [-] and y [cm/s2], (n,) each, not clipped."""
        columns = np.column_stack(expand(self.candidate.base, self.candidate.powers, x, y))
        return np.asarray(columns @ np.array(self.coefficients), dtype=np.float64)


def fit_surface(candidate: Candidate, points: Points) -> Surface:
    """Fit a candidate by ordinary least squares, and once more without each group.

    Raises InputError if the cases, or those without one group, do not determine it.
    """
    columns = np.column_stack(expand(candidate.base, candidate.powers, points.x, points.y))
    coefficients, condition = _solve(columns, points.z, candidate)

    def refit(mask: BoolArray) -> Callable[[BoolArray], FloatArray]:
        found, _ = _solve(columns[mask], points.z[mask], candidate)
        return lambda chosen: np.asarray(columns[chosen] @ found)

    n, k = columns.shape
    rss, tss = (float(np.sum((points.z - one) ** 2)) for one in (columns @ coefficients, points.z.mean()))
    share = rss / tss if tss > 0 else float("nan")
    with np.errstate(divide="ignore"):
        aic = float(n * np.log(rss / n) + 2 * k)
    return Surface(
        candidate=candidate,
        coefficients=tuple(coefficients.tolist()),
        r2=1 - share,
        adjusted_r2=1 - share * (n - 1) / (n - k),
        aic=aic,
        left_out=leave_out(points.z, points.group, refit),
        condition=condition,
    )


def _solve(columns: FloatArray, z: FloatArray, candidate: Candidate) -> tuple[FloatArray, float]:
    """Return the coefficients (k,) of columns (n, k), scaled to unit norm first, and the condition number of those."""
    n, k = columns.shape
    norms = np.linalg.norm(columns, axis=0)
    if n <= k or not (norms > 0).all():
        raise InputError(f"{candidate.name}: {n} cases do not determine {k} coefficients: give more")
    found, _, rank, singular = np.linalg.lstsq(columns / norms, z, rcond=None)
    if rank < k:
        raise InputError(
            f"{candidate.name}: the cases do not determine {k} coefficients: give more values of B/H or PFA"
        )
    return found / norms, float(singular[0] / singular[-1])


@dataclass(frozen=True, slots=True)
class Ranked:
    """A surface with its places by the errors for groups left out, by adjusted R2, and by AIC.

    `is_level`: its error counts as equal to the smallest; among those, fewest coefficients come first.
    """

    surface: Surface
    place: int
    is_level: bool
    place_adjusted_r2: int
    place_aic: int


def rank_surfaces(points: Points, candidates: Iterable[Candidate] = CANDIDATES) -> tuple[Ranked, ...]:
    """Fit the candidates and return them ranked.

    Those whose error exceeds the smallest by at most its standard error, or `NEGLIGIBLE`, count as equal and are
    ordered by their number of coefficients, then by their error. The others follow by error.

    Source: the rule of one standard error. Hastie T, Tibshirani R, Friedman J (2009). The Elements of Statistical
    Learning, 2nd ed. Springer: section 7.10.1.

    Raises InputError if the cases do not determine one of them.
    """
    surfaces = [fit_surface(one, points) for one in candidates]
    best = min((one.left_out for one in surfaces), key=lambda one: one.error)
    level = [surface.left_out.is_level(best) for surface in surfaces]

    def key(at: int) -> tuple[bool, int, float]:
        one = surfaces[at]
        return not level[at], len(one.coefficients) if level[at] else 0, one.left_out.error

    by_r2 = _find_places([-one.adjusted_r2 for one in surfaces])
    by_aic = _find_places([one.aic for one in surfaces])
    order = sorted(range(len(surfaces)), key=key)
    return tuple(Ranked(surfaces[at], place, level[at], by_r2[at], by_aic[at]) for place, at in enumerate(order, 1))


def _find_places(values: Sequence[float]) -> list[int]:
    order = sorted(range(len(values)), key=values.__getitem__)
    return [place for _, place in sorted((at, place) for place, at in enumerate(order, 1))]
