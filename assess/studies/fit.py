"""Study `fit`: surfaces fitted to the chances by direct integration and ranked, and a bounded alternative with size.

The paper's section 4: equation (8) was chosen among surfaces z(x, y), x = B/H, y = PFA [cm/s2], by a program for
surface fits, and fitted to the paper's own integrations. Here the integrations are those of study `table2`, and the
candidates polynomials in u = x or u = 1/x and y. They are fitted by ordinary least squares and ranked by the error for
buildings that were left out of the fit. R2, adjusted R2 and AIC are given as well; they assume independent cases, which
cases of one motion and one building are not.

A bounded and monotone alternative, which depends on the size of a piece, is the probit of `assess.methods.fitted`,
fitted to counts, fallen of runs, by maximum likelihood of independent binomials.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray, FloatArray
from assess.errors import InputError
from assess.methods import Cases, FittedOn, Range
from assess.methods.fitted import (
    QUANTITIES,
    Base,
    Fitted,
    Polynomial,
    Powers,
    Probit,
    expand,
    find_groups,
    write_model,
    write_sum,
)  # fmt: skip
from assess.methods.proposed_or import COEFFICIENTS
from assess.report.figures.draw import draw
from assess.report.figures.risk_map import paint_legend, paint_risk
from assess.risk import LIMITS
from assess.studies.agreement import FORMULAS, INTEGRATION, Compared, pool, rock_all
from assess.studies.buildings import LEVELS, RATIOS
from assess.studies.study import Finding, Options, Study, Table, write_finding
from assess.units import ACCELERATION, GRAVITY, ROUNDING

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


def _list_candidates() -> Iterable[Candidate]:
    """Return every base with powers as equation (8) orders them; crossed ones up to a degree of max(m, n)."""
    bases: tuple[Base, ...] = ("x", "1/x")
    found: dict[tuple[Base, tuple[Powers, ...]], Candidate] = {}
    for base, m, n, crossed in product(bases, ORDERS, ORDERS, (False, True)):
        alone = [(0, 0), *((i, 0) for i in range(1, m + 1)), *((0, j) for j in range(1, n + 1))]
        mixed = [(i, j) for i in range(1, m + 1) for j in range(1, n + 1) if crossed and i + j <= max(m, n)]
        powers = tuple(sorted([*alone, *mixed], key=lambda one: (sum(one), 0 in one and -1, -one[0])))
        found.setdefault((base, powers), Candidate(base, m, n, crossed, powers))
    return found.values()


CONSTANT = Candidate("x", 0, 0, False, ((0, 0),))
"""The trivial model, independent of piece and motion: a surface with no smaller error is of no use."""
CANDIDATES = (CONSTANT, *_list_candidates())
"""Every base, both orders from 1 to 3, with and without cross terms, without duplicates.

The paper calls those in 1/x Taylor series.
"""
EQUATION_8 = next(one for one in CANDIDATES if one.name == "1/x to order 2, y to order 2, with cross terms")


@dataclass(frozen=True, slots=True)
class LeftOut:
    """Errors for the groups left out in turn, each predicted by a fit to all others: their mean squares [-]."""

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
    """Fit a candidate by least squares, and without each group; InputError if the cases do not determine it."""
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
        candidate=candidate, coefficients=tuple(coefficients.tolist()), r2=1 - share,
        adjusted_r2=1 - share * (n - 1) / (n - k), aic=aic, left_out=leave_out(points.z, points.group, refit),
        condition=condition,
    )  # fmt: skip


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
    values = np.array([(-one.adjusted_r2, one.aic) for one in surfaces])
    places = 1 + np.argsort(np.argsort(values, axis=0, kind="stable"), axis=0)  # by adjusted R2 and by AIC
    ranks = [
        (not is_level, len(one.coefficients) if is_level else 0, one.left_out.error, at)
        for at, (one, is_level) in enumerate(zip(surfaces, level, strict=True))
    ]
    order = [at for *_, at in sorted(ranks)]
    return tuple(Ranked(surfaces[at], place, level[at], *places[at].tolist()) for place, at in enumerate(order, 1))


# ---------------------------------------------------------------- the probit

IntArray = NDArray[np.int64]
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
    from scipy.optimize import minimize

    columns, total = design(counts), int(counts.runs.sum())
    if not 0 < int(counts.fallen.sum()) < total:
        raise InputError("all fell, or none: add weaker or stronger motions, so that some fall and others do not")
    centre, scale = columns[:, 1:].mean(axis=0), columns[:, 1:].std(axis=0)
    scaled = np.column_stack([columns[:, 0], (columns[:, 1:] - centre) / np.where(scale > 0, scale, 1.0)])
    if np.linalg.matrix_rank(scaled) < 3:
        raise InputError("A and V do not vary independently: add pieces of other sizes, or other motions")

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
    slopes = found.x[1:] / scale
    return Probit(float(found.x[0] - slopes @ centre), *map(float, slopes))


def _choose(counts: Counts, mask: BoolArray) -> Counts:
    return Counts(*(getattr(counts, name)[mask] for name in ("breadth", "height", "pfa", "pfv", "fallen", "runs")))


@dataclass(frozen=True, slots=True)
class Alternative:
    """A probit, the probits fitted without each building in turn, and their errors for that building."""

    probit: Probit
    without: tuple[Probit, ...]
    left_out: LeftOut


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Fits:
    """The data, the surfaces ranked, and the probits.

    * `points`, `counts`: the n cases: every block at every common PFA under every channel.
    * `best`, `equation_8`, `constant`: the surface of the smallest error, however many coefficients it has, the paper's
      choice and the trivial model, each fitted.
    * `published`: errors of the formulas as published, by title.
    """

    points: Points
    counts: Counts
    ranked: tuple[Ranked, ...]
    best: Ranked
    equation_8: Ranked
    constant: Ranked
    probit: Alternative
    probit_without_pfv: Alternative
    published: Mapping[str, LeftOut]

    @property
    def buildings(self) -> list[str]:
        """Names of the groups, in the order of the errors of those left out."""
        return [str(one) for one in np.unique(self.points.group)]


def fit_all(compared: Sequence[Compared], options: Options) -> Fits:
    """Fit everything to the trials of all channels at the common values of PFA."""
    surfaces, probits = options.narrow(0.0, 0.5), options.narrow(0.5, 1.0)
    check = partial(probits.report_share, 0.0)
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
    group = np.repeat([one.building.name for one in compared], sizes)
    points = Points(counts.breadth / counts.height, counts.pfa / ACCELERATION["cm/s2"], counts.risk, group)
    ranked = rank_surfaces(points, (one for one, _ in surfaces.each(CANDIDATES)))
    of = {one.surface.candidate: one for one in ranked}
    return Fits(
        points=points, counts=counts, ranked=ranked, best=min(ranked, key=lambda one: one.surface.left_out.error),
        equation_8=of[EQUATION_8], constant=of[CONSTANT],
        probit=fit_alternative(counts, group, with_pfv=True, check=check),
        probit_without_pfv=fit_alternative(counts, group, with_pfv=False, check=check),
        published={title: find_errors(pool(compared, key)[0], points) for key, title in FORMULAS.items()},
    )  # fmt: skip


def fit_alternative(
    counts: Counts, group: NDArray[np.str_], *, with_pfv: bool = True, check: Check = lambda: None
) -> Alternative:
    """Fit a probit to all, and to all but each building."""
    without: list[Probit] = []

    def refit(mask: BoolArray) -> Callable[[BoolArray], FloatArray]:
        without.append(fit_probit(_choose(counts, mask), with_pfv=with_pfv, check=check))
        return lambda chosen: without[-1].evaluate(_choose(counts, chosen).cases)

    left_out = leave_out(counts.risk, group, refit)
    return Alternative(fit_probit(counts, with_pfv=with_pfv, check=check), tuple(without), left_out)


def find_errors(values: FloatArray, points: Points) -> LeftOut:
    """Return the errors, building by building, of values (n,) that were not fitted to any of them."""
    return leave_out(points.z, points.group, lambda _: lambda chosen: values[chosen])


COLUMNS = (
    "place", "name", "equation", "coefficients", "r2", "adjusted_r2", "aic", "left_out_rmse", "left_out_spread",
    "level_with_the_best", "place_by_adjusted_r2", "place_by_aic", "condition", "ill_conditioned", "values",
)  # fmt: skip

SHOWN = 4
"""Candidates that the page lists, besides equation (8), the constant and that of the smallest error."""
LETTERS = {"a": (0, 0), "b": (1, 0), "c": (0, 1), "d": (2, 0), "e": (0, 2), "f": (1, 1)}
"""Of the coefficients of equation (8): the powers of their terms."""


def run(options: Options) -> Finding:
    """Fit and rank the models, and write the two that can be used as files."""
    fits = fit_all(rock_all(options.narrow(0.0, 0.9)), options.narrow(0.9, 1.0))
    rows = [
        (
            one.place, surface.candidate.name, surface.candidate.equation, len(surface.coefficients), surface.r2,
            surface.adjusted_r2, surface.aic, surface.left_out.error, surface.left_out.spread, one.is_level,
            one.place_adjusted_r2, one.place_aic, surface.condition, surface.is_ill_conditioned,
            " ".join(map(repr, surface.coefficients)),
        )
        for one in fits.ranked
        for surface in [one.surface]
    ]  # fmt: skip
    return write_finding(
        "fit",
        collect(fits),
        tables={"fit": Table(columns=COLUMNS, rows=rows)}, figures={"fit.svg": draw(7, 2.7, partial(_paint, fits))},
        files={f"{one.key}.toml": write_model(one) for one in build_models(fits, options)},
    )  # fmt: skip


def build_models(fits: Fits, options: Options) -> Iterator[Fitted]:
    """Yield the models to be saved: equation (8) fitted again, and the probit."""
    data = f"{len(fits.buildings)} instrumented buildings, {options.runs} motions a channel, seed {options.seed}"
    cases, eighth = fits.counts.cases, fits.equation_8.surface
    ranges = {}
    for name, one in QUANTITIES.items():
        values = one.measure(cases)
        ranges[name] = Range(float(values.min()), float(values.max()), one.unit)
    chosen: list[tuple[str, str, Polynomial | Probit, LeftOut]] = [
        ("fitted_eq8", "Equation (8) fitted again", eighth.polynomial, eighth.left_out),
        ("fitted_probit", "Probit in PFA and PFV", fits.probit.probit, fits.probit.left_out),
    ]
    constant = fits.constant.surface.left_out.error
    for key, title, formula, left_out in chosen:
        fitted = FittedOn(data=data, error=left_out.error, spread=left_out.spread, constant=constant)
        yield Fitted(key=key, title=title, formula=formula, fitted=fitted, ranges=ranges)


def _paint(fits: Fits, figure: Any) -> None:
    """Paint the counterpart of Fig. 7: integration and the two models, each the mean over all channels and heights."""
    ratios, values = np.array(RATIOS), np.array(LEVELS) * GRAVITY
    places = [np.isclose(fits.points.x, x) & np.isclose(fits.counts.pfa, y) for y in values for x in ratios]
    surface = fits.equation_8.surface.predict(fits.points.x, fits.points.y)
    panels = {
        INTEGRATION: fits.points.z,
        "equation (8), fitted here": np.clip(surface, 0, 1),
        "probit": fits.probit.probit.evaluate(fits.counts.cases),
    }
    for axes, (name, risk) in zip(figure.subplots(1, 3, sharex=True, sharey=True), panels.items(), strict=True):
        means = np.array([risk[place].mean() for place in places])
        paint_risk(axes, ratios, values / GRAVITY, means.reshape(values.size, ratios.size))
        axes.set_title(name, fontsize=8, loc="left")
        axes.set_xlabel("B/H [-]", fontsize=7)
        axes.tick_params(labelsize=6)
    figure.axes[0].set_ylabel("PFA [g]", fontsize=7)
    paint_legend(figure, has_checked=False)


# ---------------------------------------------------------------- the page: every conclusion follows from the numbers


def collect(fits: Fits) -> dict[str, object]:
    """Return what the page shows."""
    best, values = fits.best.surface, dict(zip(EQUATION_8.powers, fits.equation_8.surface.coefficients, strict=True))
    named = {CONSTANT: "", EQUATION_8: " (eq. 8)", best.candidate: " (smallest error)"}
    start = GRAVITY * fits.counts.breadth / fits.counts.height
    at_rest = fits.probit.probit.evaluate(fits.counts.cases)[fits.counts.pfa < start * (1 - ROUNDING)]
    of = {one.surface.candidate: one for one in fits.ranked}
    again = {CONSTANT: "", EQUATION_8: " (equation (8) fitted again)", best.candidate: " (smallest error)"}
    coefficients: list[dict[str, object]] = []
    for name, letter in (("b0", "b₀"), ("b1", "b₁"), ("b2", "b₂")):
        value, *spread = (float(getattr(one, name)) for one in (fits.probit.probit, *fits.probit.without))
        at_bound = name != "b0" and value == 0
        coefficients.append({"letter": letter, "value": value, "at_bound": at_bound, "spread": spread})
    return {
        "fits": fits, "surfaces": len(fits.ranked) - 1, "best": best.left_out,
        "eighth": fits.equation_8.surface.left_out, "constant": fits.constant.surface.left_out,
        "probit": fits.probit.left_out, "alone": fits.probit_without_pfv.left_out,
        "pfv_reduces": fits.probit.left_out.error < min(best.left_out.error, fits.probit_without_pfv.left_out.error),
        "level": sum(one.is_level for one in fits.ranked), "negligible": NEGLIGIBLE, "ratios": RATIOS, "levels": LEVELS,
        "listed": [
            (one, named.get(one.surface.candidate, ""))
            for one in fits.ranked
            if one.place <= SHOWN or one.surface.candidate in named
        ],
        "printed": {name: getattr(COEFFICIENTS, name) for name in LETTERS},
        "fitted": [values[powers] for powers in LETTERS.values()],
        "coefficients": coefficients, "medium_at_rest": float(np.mean(at_rest >= LIMITS[0])),
        "models": [
            *((f"{title} (not fitted)", 0, left_out) for title, left_out in fits.published.items()),
            *(
                (f"{one.name}{name}", len(one.powers), of[one].surface.left_out)
                for one, name in again.items()
            ),
            ("probit without PFV (b₀, b₁)", 2, fits.probit_without_pfv.left_out),
            ("probit (b₀, b₁, b₂)", 3, fits.probit.left_out),
        ],
    }  # fmt: skip


STUDY = Study(
    name="fit", order=60, title="Surfaces fitted and ranked, and a bounded alternative", of="section 4", run=run
)
