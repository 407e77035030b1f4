"""How often a year something falls: a hazard curve and a fragility, integrated without a step.

Equations
---------
λ = ∫ P(im) (-dν(im)), ν the annual rate at which im is exceeded. Between two points of the curve ν is a power law,
ν = ν0 (a/a0)^-k with k = -ln(ν1/ν0)/ln(a1/a0). Integrated by parts, with all that lies beyond the last point counted
at its own P, λ = ν_first P(a_first) + Σ ∫ ν dP. For the lognormal P = Φ(x), x = ln(a/θ)/β, a part is
ν0 exp(k β x0 + k² β²/2) [Φ(x1 + k β) - Φ(x0 + k β)]; for straight lines between tabulated shares it is their slope
times ∫ ν da.

Reference
---------
Cornell CA, Jalayer F, Hamburger RO, Foutch DA (2002). Probabilistic basis for 2000 SAC Federal Emergency Management
Agency steel moment frame guidelines. Journal of Structural Engineering 128(4):526-533.
doi:10.1061/(ASCE)0733-9445(2002)128:4(526) (λ of one power law and a lognormal)
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from assess.arrays import FloatArray
from assess.fragility import Fragility, lognormal_chance
from assess.hazard import HazardCurve
from assess.i18n import Text, fill
from assess.units import GRAVITY

MOST_OUTSIDE = 0.05
"""Share of a rate [-] above which it is remarked that it comes, or could come, from outside the curve."""
REACH = 10.0
"""Factor by which the curve's first power law is carried on below its first point, to see what is missing there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AnnualRate:
    """How often a year, and how much of it the ends of the hazard curve decide.

    * `rate` [1/year]: all that the curve holds, and what lies beyond its last point at the chance there (the share
      `beyond`); `most` if all beyond it made it fall.
    * `below`: share of the sum that the curve's first power law would add, if it went on for a decade; not in `rate`.
    """

    rate: float
    most: float
    beyond: float
    below: float

    @property
    def ends_matter(self) -> bool:
        """Whether more than `MOST_OUTSIDE` of it comes, or could come, from outside the curve."""
        return self.is_cut or self.beyond > MOST_OUTSIDE

    @property
    def is_cut(self) -> bool:
        """Whether it is a lower bound, as the curve begins too late or ends too early."""
        return self.below > MOST_OUTSIDE or self.could_be_more

    @property
    def could_be_more(self) -> bool:
        """Whether it would be more by over `MOST_OUTSIDE` if all beyond the last point made it fall."""
        return self.most > 0 and self.most - self.rate > MOST_OUTSIDE * self.most

    def chance_within(self, years: float) -> float:
        """Return the chance of at least once in so many years [-]: 1 - exp(-rate years)."""
        return -math.expm1(-self.rate * years)


def evaluate_rate(curve: HazardCurve, fragility: Fragility) -> AnnualRate:
    """Return the annual rate of a fragility of PGA [m/s2]: of its lognormal if near enough, else of its table."""
    if fragility.is_lognormal:
        return integrate_lognormal(curve, median=fragility.median, dispersion=fragility.dispersion)
    return integrate_table(curve, fragility.levels, fragility.shares)


def integrate_lognormal(curve: HazardCurve, *, median: float, dispersion: float) -> AnnualRate:
    """Return the annual rate of a lognormal fragility, exact for power laws between the points of the curve.

    `median`: θ, above 0 [m/s2]; `dispersion`: β [-]; with 0 all fall above the median and none below. Raises ValueError
    if one of them is out of range.
    """
    if not (0 < median < math.inf and 0 <= dispersion < math.inf):
        raise ValueError(f"median is {median} and dispersion {dispersion}, expected above 0 and 0 or above")

    def integrate(pga: FloatArray, rate: FloatArray) -> float:
        from scipy.special import log_ndtr

        if dispersion == 0:
            if median > pga[-1]:
                return 0.0
            return float(np.exp(np.interp(math.log(median), np.log(pga), np.log(rate))))
        x = np.log(pga / median) / dispersion
        k = -np.diff(np.log(rate)) / np.diff(np.log(pga))
        low, high = x[:-1] + k * dispersion, x[1:] + k * dispersion
        low, high = np.where(low > 0, -high, low), np.where(low > 0, -low, high)  # of both tails the accurate one
        with np.errstate(divide="ignore"):  # in logarithms: steep segments would overflow
            between = log_ndtr(high) + np.log(-np.expm1(log_ndtr(low) - log_ndtr(high)))
        parts = np.exp(np.log(rate[:-1]) + k * dispersion * (x[:-1] + k * dispersion / 2) + between)
        return float(rate[0] * lognormal_chance(pga[0], median, dispersion)) + float(parts.sum())

    return _build(curve, integrate, float(lognormal_chance(curve.pga[-1], median, dispersion)))


def integrate_table(curve: HazardCurve, levels: ArrayLike, shares: ArrayLike) -> AnnualRate:
    """Return the annual rate of tabulated shares, exact for power laws between the points of the curve.

    `shares` (n,) of 0 to 1 at rising `levels` (n,) of peak ground acceleration [m/s2], else ValueError. The share is
    linear in it between levels, from 0 at no acceleration on; beyond the last level it stays what it is there.
    """
    at = np.concatenate([[0.0], np.asarray(levels, dtype=np.float64)])
    chance = np.concatenate([[0.0], np.asarray(shares, dtype=np.float64)])
    if at.size < 2 or not np.isfinite(at).all() or not (np.diff(at) > 0).all():
        raise ValueError("levels must rise from above 0")
    if chance.shape != at.shape or not ((chance >= 0) & (chance <= 1)).all():
        raise ValueError("shares must be 0 to 1, one for each level")

    def integrate(pga: FloatArray, rate: FloatArray) -> float:
        grid = np.unique(np.concatenate([pga, at[(at > pga[0]) & (at < pga[-1])]]))
        falls = np.interp(grid, at, chance)
        logs = np.interp(np.log(grid), np.log(pga), np.log(rate))
        steps = np.diff(np.log(grid))
        grows = np.diff(logs) + steps  # of ν a, in ln
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = np.where(grows == 0, 1.0, np.expm1(grows) / grows)
        areas = np.exp(logs[:-1]) * grid[:-1] * steps * mean  # ∫ ν da
        return float(rate[0] * falls[0] + (np.diff(falls) / np.diff(grid) * areas).sum())

    return _build(curve, integrate, float(np.interp(curve.pga[-1], at, chance)))


def list_remarks(curve: HazardCurve, found: AnnualRate) -> tuple[Text, ...]:
    """Return what a reader of an annual rate has to know of its hazard curve."""
    remarks = list(curve.remarks)
    first, last = (float(pga) / GRAVITY for pga in curve.pga[[0, -1]])
    if found.below > MOST_OUTSIDE:
        remarks.append(fill(
            "the hazard curve begins at {pga:.3g} g; what lies below is not counted and would be about {percent:.0f} % "
            "of the annual rate: give the curve from a lower PGA on",
            pga=first, percent=100 * found.below,
        ))  # fmt: skip
    if found.could_be_more:
        remarks.append(fill(
            "the hazard curve ends at {pga:.3g} g; the annual rate is {rate:.2g} and could be up to {most:.2g}: give "
            "the curve up to a higher PGA",
            pga=last, rate=found.rate, most=found.most,
        ))  # fmt: skip
    elif found.beyond > MOST_OUTSIDE:
        remarks.append(fill(
            "{percent:.0f} % of the annual rate lie beyond the end of the hazard curve at {pga:.3g} g",
            percent=100 * found.beyond, pga=last,
        ))  # fmt: skip
    return tuple(remarks)


def _build(curve: HazardCurve, integrate: Callable[[FloatArray, FloatArray], float], at_last: float) -> AnnualRate:
    """Return a rate with what the ends of the curve decide; `at_last` is the chance at its last point."""
    pga, rate = curve.pga, curve.rate
    found, last = integrate(pga, rate), float(rate[-1])
    slope = -math.log(rate[1] / rate[0]) / math.log(pga[1] / pga[0])
    more = integrate(np.append(pga[0] / REACH, pga), np.append(rate[0] * REACH**slope, rate))
    return AnnualRate(
        rate=found, most=found + last * (1 - at_last), beyond=last * at_last / found if found > 0 else 0.0,
        below=max(0.0, 1 - found / more) if more > 0 else 0.0,
    )  # fmt: skip
