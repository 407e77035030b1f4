"""The models of study `fit`, fitted to the chances by direct integration of study `table2`, with their errors.

A bounded and monotone alternative to a surface, which depends on the size of a piece.

R = Φ(b0 + b1 ln A + b2 ln V), A = PFA/(g B/H), V = p PFV/(g B/H), p = √(3g/(4r)), r half the diagonal; b1, b2 ≥ 0.

The groups A and V are those of Dimitrakopoulos and Paraskeva (2015), with B/H for tan α. The coefficients are fitted to
counts, fallen of runs, by maximum likelihood of independent binomials.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from assess.errors import InputError
from assess.risk import LIMITS
from assess.studies.agreement import Compared, pool
from assess.studies.buildings import LEVELS
from assess.studies.fit.surfaces import (
    CANDIDATES,
    CONSTANT,
    EQUATION_8,
    Candidate,
    LeftOut,
    Points,
    Ranked,
    rank_surfaces,
)
from assess.studies.studied_methods import FORMULAS, BoolArray, Cases, FloatArray, Probit, find_groups
from assess.studies.study import Options
from assess.units import ACCELERATION, GRAVITY, ROUNDING

IntArray = NDArray[np.int64]
Group = NDArray[np.str_] | NDArray[np.int64]
Check = Callable[[], None]
LARGEST = 1e3
"""Bound of the coefficients; realistic ones are far below."""


@dataclass(frozen=True, slots=True, eq=False)
class Counts:
    """The n cases that a probit is fitted to, each a piece under the motions of one floor, scaled to a peak.

    * `breadth`, `height` (n,): of the piece [m].
    * `pfa`, `pfv` (n,): peaks of the floor motion [m/s2], [m/s].
    * `fallen`, `runs` (n,): motions under which it overturned, and all motions.
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

    Raises InputError if the counts do not determine it: all fell, or none; a limit separates both without an overlap;
    or A and V vary too little.
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


@dataclass(frozen=True, slots=True)
class Alternative:
    """A probit, the probits fitted without each building in turn, and their errors for that building."""

    probit: Probit
    without: tuple[Probit, ...]
    left_out: LeftOut


@dataclass(frozen=True, eq=False)
class Fits:
    """The data, the surfaces ranked, and the probits.

    * `points`, `counts`: the n cases: every block at every common PFA under every channel.
    * `ranked`: the surfaces in order.
    * `probit`, `probit_without_pfv`: with PFV in it, and without.
    * `published`: errors of the formulas as published, by title.
    """

    points: Points
    counts: Counts
    ranked: tuple[Ranked, ...]
    probit: Alternative
    probit_without_pfv: Alternative
    published: Mapping[str, LeftOut]

    def find(self, candidate: Candidate) -> Ranked:
        """Return a surface by its candidate."""
        return next(one for one in self.ranked if one.surface.candidate == candidate)

    @cached_property
    def best(self) -> Ranked:
        """The surface of the smallest error, however many coefficients it has."""
        return min(self.ranked, key=lambda one: one.surface.left_out.error)

    @cached_property
    def equation_8(self) -> Ranked:
        """The paper's choice, fitted again."""
        return self.find(EQUATION_8)

    @cached_property
    def constant(self) -> Ranked:
        """The trivial model."""
        return self.find(CONSTANT)

    @property
    def buildings(self) -> list[str]:
        """Names of the groups, in the order of the errors of those left out."""
        return [str(one) for one in np.unique(self.points.group)]

    @property
    def medium_at_rest(self) -> float:
        """Share of the cases with PFA below g B/H that the probit puts into class medium or higher [-]."""
        start = GRAVITY * self.counts.breadth / self.counts.height
        chances = self.probit.probit.evaluate(self.counts.cases)[self.counts.pfa < start * (1 - ROUNDING)]
        return float(np.mean(chances >= LIMITS[0]))


def fit_all(compared: Sequence[Compared], options: Options) -> Fits:
    """Fit everything to the trials of all channels."""
    surfaces, probits = options.narrow(0.0, 0.5), options.narrow(0.5, 1.0)
    check = partial(probits.report_share, 0.0)
    counts, group = gather(compared)
    points = Points(counts.breadth / counts.height, counts.pfa / ACCELERATION["cm/s2"], counts.risk, group)
    return Fits(
        points=points,
        counts=counts,
        ranked=rank_surfaces(points, (one for one, _ in surfaces.each(CANDIDATES))),
        probit=fit_alternative(counts, group, with_pfv=True, check=check),
        probit_without_pfv=fit_alternative(counts, group, with_pfv=False, check=check),
        published={title: find_errors(pool(compared, key)[0], points) for key, title in FORMULAS.items()},
    )


def fit_alternative(counts: Counts, group: NDArray[np.str_], *, with_pfv: bool, check: Check) -> Alternative:
    """Fit a probit to all, and to all but each building."""
    without = fit_without(counts, group, with_pfv=with_pfv, check=check)
    return Alternative(
        fit_probit(counts, with_pfv=with_pfv, check=check), without, find_left_out(counts, group, without)
    )


def find_errors(values: FloatArray, points: Points) -> LeftOut:
    """Return the errors, building by building, of values (n,) that were not fitted to any of them."""
    off = (values - points.z) ** 2
    return LeftOut(tuple(float(off[points.group == one].mean()) for one in np.unique(points.group)))


def gather(compared: Sequence[Compared]) -> tuple[Counts, NDArray[np.str_]]:
    """Return the cases of all channels at the common values of PFA, and the building of each."""
    sizes = [len(LEVELS) * one.trials.breadth.size for one in compared]
    cases = [one.trials.cases for one in compared]

    def join(name: str) -> FloatArray:
        return np.concatenate([getattr(one, name)[:size] for one, size in zip(cases, sizes, strict=True)])

    breadth, height, pfa, pfv = map(join, ("breadth", "height", "pfa", "pfv"))
    counts = Counts(
        breadth, height, pfa, pfv,
        fallen=np.concatenate([one.trials.fallen.ravel()[:size] for one, size in zip(compared, sizes, strict=True)]),
        runs=np.repeat([one.trials.runs for one in compared], sizes),
    )  # fmt: skip
    return counts, np.repeat([one.building.name for one in compared], sizes)
