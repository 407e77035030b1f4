"""Shares that fall at several levels of ground PGA, integrated over a hazard curve, with their sampling interval.

At a level the motions are those of the scenario times one factor. At a given ground PGA they scatter about that, by one
scale for the whole building: the share at a ground PGA is the mean of the shares at levels about it, weighted by the
normal distribution of ln scale, cut at 3 standard deviations as in a run. That is the same as to draw the scale, but
without the error of drawing it, of which rare strong scales would make the most.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.annual_results import YEARS, AnnualRow
from assess.arrays import BoolArray, FloatArray
from assess.fragility import fit_fragility
from assess.hazard import HazardCurve
from assess.rates import AnnualRate, evaluate_rate, integrate_table
from assess.risk import NORMAL_95
from assess.rocking.draws import CUT
from assess.units import GRAVITY

STEP = 1.25
"""Each level is about so many times the one before [-]."""
MOST_LEVELS = 30
NODES = 61
"""Scales over which a share is averaged."""


def space(first: float, last: float) -> FloatArray:
    """Return levels from a first to a last, each about `STEP` times the one before."""
    return np.geomspace(first, last, min(MOST_LEVELS, math.ceil(math.log(last / first) / math.log(STEP)) + 1))


@dataclass(frozen=True)
class Integral:
    """A hazard curve, and levels at which shares are known.

    * `curve`: of the site.
    * `levels` (n,): rising levels, as ground PGA [m/s2].
    * `dispersion`: standard deviation of ln scale at a ground PGA [-], above 0.
    * `runs`: draws that a share comes from.
    """

    curve: HazardCurve
    levels: FloatArray
    dispersion: float
    runs: int

    @cached_property
    def points(self) -> FloatArray:
        """Ground PGA at which shares are integrated [m/s2], (m,)."""
        first, last = self.curve.pga[[0, -1]].tolist()
        return space(min(max(first, self.levels[0] * math.exp(-CUT * self.dispersion)), last / STEP), last)

    @cached_property
    def average(self) -> FloatArray:
        """The shares at `points` are this, (m, n), times those at the levels: below the first of them it is 0."""
        scales = np.linspace(-CUT, CUT, NODES)
        weight = np.exp(-(scales**2) / 2)
        known = np.log(np.concatenate([self.levels[:1] / STEP, self.levels]))
        at = np.log(self.points)[:, np.newaxis] + self.dispersion * scales
        shares = [np.interp(at, known, one) for one in np.eye(known.size)[1:]]
        return np.stack([one @ weight / weight.sum() for one in shares], axis=1)

    @cached_property
    def weights(self) -> FloatArray:
        """What a share of 1 at each level alone adds to an annual rate [1/year], (n,)."""
        at_points = [integrate_table(self.curve, self.points, one).rate for one in np.eye(self.points.size)]
        return np.asarray(np.array(at_points) @ self.average)

    @property
    def never(self) -> AnnualRow:
        """The annual row of what cannot happen."""
        return AnnualRow(
            rate=0.0, low=None, high=None, chance_a_year=0.0, chance_in_50_years=0.0, fit="table", median_g=None,
            dispersion=None, misfit=None, at_least=False, ends_matter=False,
        )  # fmt: skip

    def of_draws(self, happened: BoolArray | FloatArray, *, at_least: bool) -> AnnualRow:
        """Return the annual row of what happened, or its share, at each level and draw, (levels, draws)."""
        return self.of_shares(happened.mean(axis=1), self.find_spread(happened), at_least=at_least)

    def of_shares(self, shares: FloatArray, spread: float | None, *, at_least: bool) -> AnnualRow:
        """Return the annual row of shares (levels,); `spread` is the half width of the interval over the rate.

        Where the curve does not reach far enough it is a lower bound, without an interval.
        """
        at_points = np.clip(self.average @ shares, 0, 1)
        fitted = fit_fragility(self.points, at_points * self.runs, np.full(self.points.size, self.runs))
        found = evaluate_rate(self.curve, fitted)
        is_fitted, is_cut = fitted.is_lognormal, found.is_cut
        has_half = is_fitted and at_points.min() <= 0.5 <= at_points.max()
        spread = None if is_cut else spread
        return AnnualRow(
            rate=found.rate,
            low=None if spread is None else max(0.0, found.rate * (1 - spread)),
            high=None if spread is None else found.rate * (1 + spread),
            chance_a_year=found.chance_within(1),
            chance_in_50_years=found.chance_within(YEARS),
            fit="lognormal" if is_fitted else "table",
            median_g=fitted.median / GRAVITY if has_half else None,
            dispersion=fitted.dispersion if has_half else None,
            misfit=fitted.misfit if is_fitted else None,
            at_least=at_least or is_cut,
            ends_matter=found.ends_matter,
        )

    def find_spread(self, happened: NDArray[Any]) -> float | None:
        """Return the half width of the 95 % sampling interval of a rate, over the rate; None where nothing happened.

        By the table the rate is a mean over the draws, each with a rate of its own.
        """
        rates = self.weights @ happened
        mean = float(rates.mean())
        return (
            NORMAL_95 * float(rates.std(ddof=1)) / math.sqrt(rates.size) / mean if mean > 0 and rates.size > 1 else None
        )

    def add_up(self, falls: FloatArray, pieces: int) -> AnnualRate:
        """Return how many of so many pieces, 1 or more, fall a year, by the table.

        `falls` (n, draws) are their numbers at each level and draw.
        """
        shares = np.clip(self.average @ falls.mean(axis=1) / pieces, 0, 1)
        found = integrate_table(self.curve, self.points, shares)
        return replace(found, rate=pieces * found.rate, most=pieces * found.most)
