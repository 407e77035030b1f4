"""A lognormal fragility fitted to how many fell at each level of shaking, and the table itself.

Reference
---------
Baker JW (2015). Efficient analytical fragility function fitting using dynamic structural analysis. Earthquake Spectra
31(1):579-599. doi:10.1193/021113EQS025M (maximum likelihood of binomial counts)
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from assess.arrays import FloatArray
from assess.i18n import Text, fill

Kind = Literal["fitted", "none fell", "all fell", "one level", "separated", "not rising"]

MOST_MISFIT = 0.05  # largest misfit [-] with which the lognormal stands in for the table

MOST_DISPERSION = 10.0
"""From this dispersion on [-] the chance hardly rises: 16 and 84 % fall at levels that are a factor of e^20 apart."""

WHY: Mapping[Kind, Text] = {
    "fitted": fill("fitted by maximum likelihood"),
    "none fell": fill("not fitted: nothing fell at any level"),
    "all fell": fill("not fitted: everything fell at every level"),
    "one level": fill("not fitted: the levels are fewer than two"),
    "separated": fill(
        "not fitted: below one level nothing fell, above it everything did, so that no dispersion follows"
    ),
    "not rising": fill("not fitted: the share that fell does not rise with the level, or hardly"),
}
"""What each kind means, in words."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Fragility:
    """How many `fallen` of `trials` at each of the rising `levels` of one intensity measure, (n,), and the lognormal.

    Its median (in the unit of `levels`), dispersion and misfit, the largest difference from a share, are NaN where
    nothing was fitted; `kind` tells why: a key of `WHY`.
    """

    levels: FloatArray
    fallen: FloatArray
    trials: FloatArray
    kind: Kind
    median: float = math.nan
    dispersion: float = math.nan
    misfit: float = math.nan

    @property
    def shares(self) -> FloatArray:
        """Share that fell at each level [-], (n,)."""
        return self.fallen / self.trials

    @property
    def is_lognormal(self) -> bool:
        """Whether the lognormal is near enough to the table to stand in for it."""
        return self.kind == "fitted" and self.misfit <= MOST_MISFIT

    @property
    def why(self) -> Text:
        """Whether and how it was fitted, in words."""
        return WHY[self.kind]


def fit_fragility(levels: ArrayLike, fallen: ArrayLike, trials: ArrayLike) -> Fragility:
    """Fit the chance of falling, Phi(ln(im / theta) / beta), by maximum binomial likelihood.

    `fallen` of `trials` (n,), not necessarily whole, fell at each of the `levels` (n,), above 0 in any one unit. Levels
    without trials are left out, the others sorted, and equal ones put together. Where the likelihood has no maximum at
    a rising chance, nothing is fitted and `Fragility.kind` tells why. Raises ValueError if the arrays do not fit this.
    """
    im, fell, count = (np.asarray(values, dtype=np.float64) for values in (levels, fallen, trials))
    if not im.ndim == 1 or not im.shape == fell.shape == count.shape:
        raise ValueError(
            f"levels, fallen and trials have shapes {im.shape}, {fell.shape}, {count.shape}: one is needed"
        )
    if not (np.isfinite(im) & np.isfinite(fell) & np.isfinite(count)).all():
        raise ValueError("levels, fallen and trials must be finite")
    if (im <= 0).any() or (fell < 0).any() or (fell > count).any():
        raise ValueError("levels must be above 0, and fallen 0 to trials")
    if not (count > 0).any():
        raise ValueError("there are no trials")
    tried = count > 0
    im, place = np.unique(im[tried], return_inverse=True)
    fell, count = (np.bincount(place, weights=values[tried]).astype(np.float64) for values in (fell, count))
    kind = _classify(im, fell, count)
    if kind != "fitted":
        return Fragility(levels=im, fallen=fell, trials=count, kind=kind)
    intercept, slope = _maximise(np.log(im), fell, count)
    if not slope * MOST_DISPERSION > 1:
        return Fragility(levels=im, fallen=fell, trials=count, kind="not rising")
    median, dispersion = math.exp(-intercept / slope), 1 / slope
    misfit = float(np.abs(lognormal_chance(im, median, dispersion) - fell / count).max())
    return Fragility(
        levels=im, fallen=fell, trials=count, kind=kind, median=median, dispersion=dispersion, misfit=misfit
    )


def lognormal_chance(im: ArrayLike, median: float, dispersion: float) -> FloatArray:
    """Return Phi(ln(im / median) / dispersion) [-]; with a dispersion of 0, a step from 0 to 1 at the median."""
    from scipy.special import ndtr

    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.log(np.asarray(im, dtype=np.float64) / median)
        x = np.where(ratio == 0, 0.0, ratio / dispersion)
    return np.asarray(ndtr(x) if dispersion > 0 else np.where(ratio >= 0, 1.0, 0.0), dtype=np.float64)


def _classify(im: FloatArray, fell: FloatArray, count: FloatArray) -> Kind:
    stood = count - fell
    if not fell.any():
        return "none fell"
    if not stood.any():
        return "all fell"
    if im.size < 2:
        return "one level"
    if im[stood > 0].max() <= im[fell > 0].min():
        return "separated"
    if im[fell > 0].max() <= im[stood > 0].min():
        return "not rising"
    return "fitted"


def _maximise(x: FloatArray, fell: FloatArray, count: FloatArray) -> tuple[float, float]:
    """Return a and b of the largest likelihood of Phi(a + b x); it is concave, so that there is one maximum.

    Newton's rule in a trust region finds it, on x brought to mean 0 and deviation 1.
    """
    from scipy.optimize import minimize
    from scipy.special import log_ndtr

    centre, width = float(np.average(x, weights=count)), float(x.std())
    design = np.stack([np.ones(x.size), (x - centre) / width])
    shares = np.stack([fell, count - fell]) / count.sum()
    signs = np.array([[1.0], [-1.0]])

    def evaluate(parameters: FloatArray) -> tuple[float, FloatArray, FloatArray]:
        z = signs * (parameters @ design)
        logs = log_ndtr(z)
        ratio = np.exp(-z * z / 2 - math.log(2 * math.pi) / 2 - logs)  # phi(z) / Phi(z)
        gradient = -(shares * signs * ratio).sum(axis=0)
        curvature = (shares * ratio * (ratio + z)).sum(axis=0)
        return -float((shares * logs).sum()), design @ gradient, (design * curvature) @ design.T

    found = minimize(
        lambda at: evaluate(at)[:2], np.array([0.0, 1.0]), jac=True, hess=lambda at: evaluate(at)[2],
        method="trust-exact", options={"gtol": 1e-12},
    )  # fmt: skip
    slope = float(found.x[1]) / width
    return float(found.x[0]) - slope * centre, slope
