"""A bounded and monotone alternative to a surface, which depends on the size of a piece.

R = Φ(b0 + b1 ln A + b2 ln V), A = PFA/(g B/H), V = p PFV/(g B/H), p = √(3g/(4r)), r half the diagonal; b1, b2 ≥ 0.

The groups A and V are those of Dimitrakopoulos and Paraskeva (2015), with B/H for tan α. The coefficients are fitted to
counts, fallen of runs, by maximum likelihood of independent binomials.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from assess.errors import InputError
from assess.studies.fit.surfaces import LeftOut
from assess.studies.studied_methods import BoolArray, Cases, FloatArray, Probit, find_groups

IntArray = NDArray[np.int64]
Group = NDArray[np.str_] | NDArray[np.int64]
Check = Callable[[], None]
LARGEST = 1e3
"""Bound of the coefficients; realistic ones are far below."""


@dataclass(frozen=True, slots=True, eq=False)
class Counts:
    """The n cases that a probit is fitted to, each a piece under the motions of one floor, scaled to a peak.

    Parameters
    ----------
    breadth, height : (n,) arrays
        Of the piece [m].
    pfa, pfv : (n,) arrays
        Peaks of the floor motion [m/s2], [m/s].
    fallen, runs : (n,) integer arrays
        Motions under which it overturned, and all motions.
    """

    breadth: FloatArray
    height: FloatArray
    pfa: FloatArray
    pfv: FloatArray
    fallen: IntArray
    runs: IntArray

    def __post_init__(self) -> None:
        n = self.breadth.size
        given = (self.breadth, self.height, self.pfa, self.pfv, self.fallen, self.runs)
        if any(one.shape != (n,) for one in given):
            raise InputError(
                "breadth, height, pfa, pfv, fallen and runs have different lengths: give one for every case"
            )
        if not all((np.isfinite(one) & (one > 0)).all() for one in (*given[:4], self.runs)):
            raise InputError("a size, a peak or a number of runs is not above 0, or not finite: leave such cases out")
        if not ((self.fallen >= 0) & (self.fallen <= self.runs)).all():
            raise InputError("more have fallen than ran, or less than none: correct the counts")

    @property
    def cases(self) -> Cases:
        """The pieces and their motions."""
        return Cases.of(breadth=self.breadth, height=self.height, pfa=self.pfa, pfv=self.pfv)

    @property
    def risk(self) -> FloatArray:
        """Share that fell [-], (n,)."""
        return np.asarray(self.fallen / self.runs, dtype=np.float64)


def design(counts: Counts) -> FloatArray:
    """Return the columns 1, ln A, ln V, (n, 3)."""
    A, V = find_groups(breadth=counts.breadth, height=counts.height, pfa=counts.pfa, pfv=counts.pfv)
    return np.column_stack([np.ones_like(A), np.log(A), np.log(V)])


def loss(b: FloatArray, columns: FloatArray, fallen: IntArray, runs: IntArray) -> tuple[float, FloatArray]:
    """Return the negative logarithm of the likelihood at coefficients (3,), and its gradient (3,)."""
    from scipy.special import log_ndtr

    eta = columns @ b
    below, above = log_ndtr(eta), log_ndtr(-eta)
    log_density = -0.5 * eta**2 - 0.5 * np.log(2 * np.pi)
    slope = fallen * np.exp(log_density - below) - (runs - fallen) * np.exp(log_density - above)
    return -float(fallen @ below + (runs - fallen) @ above), -np.asarray(columns.T @ slope)


def fit_probit(counts: Counts, *, with_pfv: bool = True, check: Check = lambda: None) -> Probit:
    """Fit a probit to counts by maximum likelihood, b1 and b2 not below 0; without PFV b2 is 0.

    `check` is called in each iteration; it may raise CancelledError.

    Raises
    ------
    InputError
        If the counts do not determine it: all fell, or none; a limit separates both without an overlap; or A and V
        vary too little.
    """
    columns, total = design(counts), int(counts.runs.sum())
    if not 0 < int(counts.fallen.sum()) < total:
        raise InputError("all fell, or none: add weaker or stronger motions, so that some fall and others do not")
    centre, scale = columns[:, 1:].mean(axis=0), columns[:, 1:].std(axis=0)
    scaled = np.column_stack([columns[:, 0], (columns[:, 1:] - centre) / np.where(scale > 0, scale, 1.0)])
    if np.linalg.matrix_rank(scaled) < 3:
        raise InputError("A and V do not vary independently: add pieces of other sizes, or other motions")
    found = _minimise(scaled, counts, total, with_pfv, check)
    slopes = found[1:] / scale
    return Probit(float(found[0] - slopes @ centre), *map(float, slopes))


def _minimise(scaled: FloatArray, counts: Counts, total: int, with_pfv: bool, check: Check) -> FloatArray:
    """Return the coefficients (3,) of columns with a mean of 0 and a scatter of 1."""
    from scipy.optimize import minimize

    def mean_loss(b: FloatArray) -> tuple[float, FloatArray]:
        check()
        value, gradient = loss(b, scaled, counts.fallen, counts.runs)
        return value / total, gradient / total

    bounds = [(-LARGEST, LARGEST), (0.0, LARGEST), (0.0, LARGEST if with_pfv else 0.0)]
    options = {"maxiter": 1000, "ftol": 1e-15, "gtol": 1e-10}
    found = minimize(
        mean_loss, np.array([0.0, 1.0, float(with_pfv)]), jac=True, method="L-BFGS-B", bounds=bounds, options=options
    )
    eta = scaled @ found.x
    lowest, highest = eta[counts.fallen > 0].min(), eta[counts.fallen < counts.runs].max()
    is_separated = (np.ptp(eta) > 0 and lowest >= highest) or found.fun < 1e-9
    if is_separated or not np.isfinite(found.x).all() or np.abs(found.x).max() >= LARGEST:
        raise InputError("a limit separates all that fell from all that did not: add cases in between, or more runs")
    return np.asarray(found.x)


def fit_without(
    counts: Counts, group: Group, *, with_pfv: bool = True, check: Check = lambda: None
) -> tuple[Probit, ...]:
    """Fit to all but each group of cases (n,) in turn, in the order of `numpy.unique`."""
    return tuple(
        fit_probit(_choose(counts, np.asarray(group != one)), with_pfv=with_pfv, check=check)
        for one in np.unique(group)
    )


def find_left_out(counts: Counts, group: Group, probits: Sequence[Probit]) -> LeftOut:
    """Return the errors for each group of cases (n,) by the probit that was fitted without it."""
    squares = []
    for one, probit in zip(np.unique(group), probits, strict=True):
        own = _choose(counts, np.asarray(group == one))
        squares.append(float(np.mean((probit.evaluate(own.cases) - own.risk) ** 2)))
    return LeftOut(tuple(squares))


def _choose(counts: Counts, mask: BoolArray) -> Counts:
    return Counts(*(getattr(counts, name)[mask] for name in ("breadth", "height", "pfa", "pfv", "fallen", "runs")))
