"""How far a formula agrees with direct integration: bias, rank correlation, and classes missed in either direction."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from assess.methods._method import FloatArray
from assess.risk import classify_all, wilson_interval


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """How n chances by a formula agree with those by direct integration.

    Parameters
    ----------
    cases : int
        n.
    bias, scatter : float
        Mean and standard deviation of formula less integration [-].
    rank_correlation : float
        Spearman's [-]; NaN where either says the same of all.
    same_class, within_one_class, class_too_low, class_too_high : float
        Shares of the cases [-]: in the same class; at most one apart; in a lower class than by integration; a higher.
    beyond_too_low, beyond_too_high : float
        The same for the class of the nearer end of the 95 % interval of each case: what lies within the sampling error
        of the motions is not counted.
    """

    cases: int
    bias: float
    scatter: float
    rank_correlation: float
    same_class: float
    within_one_class: float
    class_too_low: float
    class_too_high: float
    beyond_too_low: float
    beyond_too_high: float

    @property
    def rms(self) -> float:
        """Root mean square of formula less integration [-]."""
        return math.hypot(self.bias, self.scatter)


NAMES = tuple(field.name for field in fields(Agreement))


def find_agreement(formula: FloatArray, fallen: NDArray[np.int64], runs: int) -> Agreement:
    """Hold chances (n,) by a formula against counts of `runs` that fell; those that it leaves open are out."""
    known = ~np.isnan(formula)
    said, counts = formula[known], fallen[known]
    done, (low, high) = counts / runs, wilson_interval(counts, np.full(counts.size, runs))
    classes = classify_all(said)
    steps = classes - classify_all(done)
    return Agreement(
        cases=int(said.size),
        bias=float(np.mean(said - done)),
        scatter=float(np.std(said - done)),
        rank_correlation=correlate_ranks(said, done),
        same_class=float(np.mean(steps == 0)),
        within_one_class=float(np.mean(np.abs(steps) <= 1)),
        class_too_low=float(np.mean(steps < 0)),
        class_too_high=float(np.mean(steps > 0)),
        beyond_too_low=float(np.mean(classes < classify_all(low))),
        beyond_too_high=float(np.mean(classes > classify_all(high))),
    )


def correlate_ranks(one: Sequence[float] | FloatArray, other: Sequence[float] | FloatArray) -> float:
    """Return Spearman's rank correlation [-]; NaN where either is constant."""
    from scipy.stats import spearmanr

    if np.ptp(one) == 0 or np.ptp(other) == 0:
        return float("nan")
    return float(spearmanr(one, other).statistic)
