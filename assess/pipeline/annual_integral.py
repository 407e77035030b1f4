"""Shares that fall at several levels of ground PGA, integrated over a hazard curve, with their sampling interval."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.annual_results import YEARS, AnnualRow
from assess.fragility import fit_fragility
from assess.hazard import HazardCurve
from assess.i18n import Text
from assess.methods._method import BoolArray, FloatArray
from assess.rates import evaluate_rate, integrate_table, list_remarks
from assess.risk import NORMAL_95
from assess.units import GRAVITY


@dataclass(frozen=True)
class Integral:
    """The hazard curve, and the levels of ground PGA [m/s2] at which shares are known, from so many draws."""

    curve: HazardCurve
    levels: FloatArray
    runs: int

    @cached_property
    def weights(self) -> FloatArray:
        """What a share of 1 at each level alone adds to an annual rate [1/year], (levels,)."""
        return np.array([integrate_table(self.curve, self.levels, one).rate for one in np.eye(self.levels.size)])

    def of_draws(self, happened: BoolArray, *, at_least: bool) -> AnnualRow:
        """Return the annual row of what happened at each level and draw, (levels, draws)."""
        return self.of_shares(happened.mean(axis=1), self.find_spread(happened), at_least=at_least)

    def of_shares(self, shares: FloatArray, spread: float | None, *, at_least: bool) -> AnnualRow:
        """Return the annual row of shares (levels,); `spread` is the half width of the interval over the rate."""
        fitted = fit_fragility(self.levels, np.minimum(shares, 1) * self.runs, np.full(self.levels.size, self.runs))
        found = evaluate_rate(self.curve, fitted)
        is_fitted = fitted.is_lognormal
        return AnnualRow(
            rate=found.rate,
            low=None if spread is None else max(0.0, found.rate * (1 - spread)),
            high=None if spread is None else found.rate * (1 + spread),
            chance_a_year=found.chance_within(1),
            chance_in_50_years=found.chance_within(YEARS),
            fit="lognormal" if is_fitted else "table",
            median_g=fitted.median / GRAVITY if is_fitted else None,
            dispersion=fitted.dispersion if is_fitted else None,
            misfit=fitted.misfit if is_fitted else None,
            at_least=at_least,
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

    def list_remarks(self, happened: FloatArray) -> tuple[Text, ...]:
        """Return what a reader has to know of the curve, by what happened at each level and draw, on average."""
        return list_remarks(self.curve, integrate_table(self.curve, self.levels, happened.mean(axis=1)))
