"""How a sum over the buildings of a city spreads: over earthquakes, and by the number of draws.

Draw k is one earthquake for all buildings, so that their numbers are added draw by draw before anything is said of the
sum. What the sum would spread if buildings were independent of each other is found by shuffling the draws of each: it
shows how much too narrow a range is that ignores the earthquake they share.
"""

import math
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from assess.risk import NORMAL_95, find_ends, wilson_interval
from assess.rocking.draws import name_number

FloatArray = NDArray[np.float64]

FEW = 10
"""Draws with anything in them below which the normal distribution of a mean is not relied on."""


@dataclass(frozen=True, slots=True)
class Spread:
    """A sum over buildings; where nothing was drawn there are no draws and no ranges.

    `apart` is the part of what is expected that is in no draw, of formulas and of routes without joint outcomes: the
    ranges leave it out. `low` and `high` are what 5 and 95 % of the draws do not exceed: the range over earthquakes;
    those that are `independent` would be it if buildings were independent of each other, which they are not. `sampling`
    is the 95 % interval of the expected value without `apart`, by the number of draws alone.
    """

    expected: float
    apart: float
    draws: int = 0
    low: float | None = None
    high: float | None = None
    sampling_low: float | None = None
    sampling_high: float | None = None
    independent_low: float | None = None
    independent_high: float | None = None


def build_spread(draws: pd.DataFrame, column: str, expected: float, most: float) -> Spread:
    """Return the spread of a column of the table draws, summed over the buildings in it.

    `expected` is that of all buildings, those without draws too; `most` is what the sum cannot exceed: all pieces, or
    all people. Raises ValueError if a building lacks draws that another one has.
    """
    if draws.empty:
        return Spread(expected=expected, apart=expected)
    ordered = draws.sort_values(["path", "draw"], kind="stable")
    paths, firsts = np.unique(ordered["path"].to_numpy(dtype=str), return_index=True)
    values = ordered[column].to_numpy(dtype=np.float64)
    runs = values.size // paths.size
    numbers = ordered["draw"].to_numpy(dtype=np.int64).reshape(-1, runs) if values.size % paths.size == 0 else None
    if numbers is None or (firsts != runs * np.arange(paths.size)).any() or (numbers != numbers[0]).any():
        raise ValueError("the table draws does not hold the same draws for all buildings")
    every = values.reshape(-1, runs)
    total = every.sum(axis=0)
    shuffled = np.zeros(runs)  # the draws of each building in an order of its own
    for path, own in zip(paths.tolist(), every, strict=True):
        shuffled += np.random.default_rng(name_number(path)).permutation(own)
    apart = expected - float(total.mean())
    ends = (*find_ends(total), *find_sampling(total, most), *find_ends(shuffled))
    is_rounding = abs(apart) <= 1e-9 * max(1.0, abs(expected))
    return Spread(expected, 0.0 if is_rounding else apart, runs, *ends)


def find_sampling(total: FloatArray, most: float) -> tuple[float, float]:
    """Return the 95 % interval of the mean of a sum by its number of draws.

    Normal; where fewer than 10 draws hold anything, Wilson's of the share of such draws, times the largest sum seen: of
    none at all, times `most`, as whatever falls in a draw that was not made could be everything.
    """
    mean, runs = float(total.mean()), total.size
    half = NORMAL_95 * float(total.std(ddof=1)) / math.sqrt(runs) if runs > 1 else 0.0
    low, high = max(0.0, mean - half), mean + half
    held = int((total > 0).sum())
    if held < FEW:
        _, share = wilson_interval(held, runs, NORMAL_95)
        low, high = 0.0, max(high, float(share) * (float(total.max()) if held else most))
    return low, min(high, max(most, mean))
