"""How chances agree with what happened: mean chance less the share that fell, and an error that knows of dependence.

Cases of one floor motion are not independent of each other: twelve blocks at eight amplitudes fall or stand together.
So the error is that of the delete-one-group jackknife: the mean is found again without each group of cases in turn, and
the scatter of these means gives the error. A group is a floor motion; or, as the floors of a building in one earthquake
are not independent either, all that comes from one site and axis.

Reference: Efron B (1982). The jackknife, the bootstrap and other resampling plans. Society for Industrial and Applied
Mathematics. doi:10.1137/1.9781611970319
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from assess.risk import RiskClass, classify_all
from assess.studies.calibration.floor_motions import Tried
from assess.studies.studied_methods import BoolArray, FloatArray

EDGES = (0.0, 0.03, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
"""Limits of the chances that the figure shows together [-]; the lower one belongs to them, and 1 to the last."""


@dataclass(frozen=True, slots=True, eq=False)
class Outcomes:
    """Chances of n cases, what happened, and whose they are.

    Parameters
    ----------
    chance : (n,) array
        Share of the generated motions under which the block overturned [-].
    fell : (n,) boolean array
        Whether it overturned under the floor motion itself.
    floor, source : (n,) integer arrays
        Its floor motion; its site and axis.
    """

    chance: FloatArray
    fell: BoolArray
    floor: NDArray[np.int64]
    source: NDArray[np.int64]

    @classmethod
    def of(cls, tried: Sequence[Tried]) -> "Outcomes":
        """Gather the cases of floor motions."""
        counts = [one.fallen.size for one in tried]
        sources = list(dict.fromkeys(one.floor.source for one in tried))
        own = [sources.index(one.floor.source) for one in tried]
        return cls(
            np.concatenate([one.fallen.ravel() / one.runs for one in tried]),
            np.concatenate([one.fell.ravel() for one in tried]),
            np.repeat(np.arange(len(tried)), counts),
            np.repeat(own, counts),
        )

    def take(self, chosen: BoolArray) -> "Outcomes":
        """Return some of the cases."""
        return Outcomes(self.chance[chosen], self.fell[chosen], self.floor[chosen], self.source[chosen])


@dataclass(frozen=True, slots=True, kw_only=True)
class Score:
    """How the chances of some cases agree with what happened.

    Parameters
    ----------
    cases, fallen, floors : int
        Number of cases, of those that fell, and of floor motions among them.
    chance, share : float
        Mean chance; share of the cases that fell [-].
    difference : float
        The one less the other [-].
    error, error_by_source : float
        Standard error of the difference [-], floor motions taken as independent, or only sites and axes. NaN where
        there is one, or where no case fell or all did: what did not happen has no scatter.
    """

    cases: int
    fallen: int
    floors: int
    chance: float
    share: float
    difference: float
    error: float
    error_by_source: float

    @property
    def largest_error(self) -> float:
        """The larger of the two errors [-]; NaN where neither is known."""
        return float(np.fmax(self.error, self.error_by_source))

    @property
    def is_clear(self) -> bool:
        """Whether the difference is beyond twice the larger error."""
        return abs(self.difference) > 2 * self.largest_error


def find_error(values: FloatArray, groups: NDArray[np.int64]) -> float:
    """Return the standard error of the mean of `values` (n,) by the jackknife over groups of them; NaN with one group.

    Groups (n,) are told apart by their integers.
    """
    _, which = np.unique(groups, return_inverse=True)
    sums, counts = np.bincount(which, values), np.bincount(which)
    if counts.size < 2:
        return math.nan
    means = (sums.sum() - sums) / (counts.sum() - counts)
    return math.sqrt((counts.size - 1) / counts.size * float(np.sum((means - means.mean()) ** 2)))


def find_score(outcomes: Outcomes) -> Score | None:
    """Return how chances agree with what happened; None without a case."""
    if not outcomes.chance.size:
        return None
    off = outcomes.chance - outcomes.fell
    errors = [find_error(off, groups) for groups in (outcomes.floor, outcomes.source)]
    if outcomes.fell.all() or not outcomes.fell.any():
        errors = [math.nan, math.nan]
    return Score(
        cases=int(off.size),
        fallen=int(outcomes.fell.sum()),
        floors=int(np.unique(outcomes.floor).size),
        chance=float(outcomes.chance.mean()),
        share=float(outcomes.fell.mean()),
        difference=float(off.mean()),
        error=errors[0],
        error_by_source=errors[1],
    )


def by_class(outcomes: Outcomes) -> dict[RiskClass, Score]:
    """Return the scores of the classes of chance that have cases."""
    classes = classify_all(outcomes.chance)
    found = {risk: find_score(outcomes.take(classes == risk)) for risk in RiskClass}
    return {risk: score for risk, score in found.items() if score is not None}


def by_chance(outcomes: Outcomes) -> Iterator[Score]:
    """Yield the scores of the cases between two `EDGES`, where there are any."""
    place = np.clip(np.searchsorted(EDGES, outcomes.chance, side="right") - 1, 0, len(EDGES) - 2)
    for at in range(len(EDGES) - 1):
        score = find_score(outcomes.take(place == at))
        if score is not None:
            yield score
