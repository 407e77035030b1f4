"""Risk classes.

The limits are those of Kaneko and Hayashi (2004) as section 2.2 of the paper prints them. The paper leaves open to
which class a limit itself belongs; here it belongs to the higher one.
"""

import math
from enum import IntEnum
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray


class RiskClass(IntEnum):
    """Classes of the chance of overturning, in rising order: each with a word and a symbol, never a colour alone.

    The backgrounds (`fill`), light to dark, are distinct without red and green, and in grey; `ink` is text on them.
    """

    word: str
    symbol: str
    fill: str
    ink: str

    LOW = 0, "low", "○", "#eaf3fb", "#1c1c1c"
    MEDIUM = 1, "medium", "◇", "#f7cf5c", "#1c1c1c"
    HIGH = 2, "high", "▲", "#db7133", "#1c1c1c"
    VERY_HIGH = 3, "very high", "■", "#8c1d3f", "#ffffff"

    def __new__(cls, value: int, *given: str) -> Self:
        """Return a class with its word, symbol and colours."""
        one = int.__new__(cls, value)
        one._value_ = value
        one.word, one.symbol, one.fill, one.ink = given
        return one

    @property
    def label(self) -> str:
        """Symbol and word, ``■ very high``."""
        return f"{self.symbol} {self.word}"


LIMITS = (0.03, 0.3, 0.7)  # lower limits of medium, high and very high [-]


def classify(probability: float) -> RiskClass | None:
    """Return the class of a probability, None where it is unknown (NaN); ValueError if it is outside [0, 1]."""
    if math.isnan(probability):
        return None
    if not 0.0 <= probability <= 1.0:
        raise ValueError(f"probability is {probability}, expected 0 to 1")
    return RiskClass(sum(probability >= limit for limit in LIMITS))


def classify_all(probability: ArrayLike) -> NDArray[np.int64]:
    """Return the classes, as integers, of probabilities in [0, 1]; -1 for NaN."""
    values = np.asarray(probability, dtype=np.float64)
    return np.where(np.isnan(values), -1, np.searchsorted(LIMITS, values, side="right")).astype(np.int64)


ENDS = (0.05, 0.95)  # shares of the draws that do not exceed the ends of a range over earthquakes


def find_ends(numbers: ArrayLike | None) -> tuple[float, float] | tuple[None, None]:
    """Return what 5 and 95 % of the draws of a sum do not exceed; None for each where there are no draws."""
    if numbers is None:
        return None, None
    low, high = np.quantile(np.asarray(numbers), ENDS, method="inverted_cdf").tolist()
    return low, high


NORMAL_95 = 1.959963984540054  # half width of the central 95 % of the standard normal distribution [-]


def wilson_interval(count: ArrayLike, runs: ArrayLike, z: float = NORMAL_95) -> tuple[NDArray[np.float64], ...]:
    """Return the ends of the interval of a probability of which `count` of `runs` independent trials are known.

    Source: Wilson EB (1927). Probable inference, the law of succession, and statistical inference. Journal of the
    American Statistical Association 22(158):209-212. doi:10.1080/01621459.1927.10502953
    """
    k, n = np.asarray(count, dtype=np.float64), np.asarray(runs, dtype=np.float64)
    # The ends are exact where none or all have fallen; rounding would leave a hair.
    low = np.where(k == 0, 0.0, wilson_end(k / n, n, z, is_high=False))
    return low, np.where(k == n, 1.0, wilson_end(k / n, n, z, is_high=True))


def wilson_end(share: Any, runs: Any, z: Any, *, is_high: bool) -> Any:
    """Return one end of the interval of a `share` of `runs` trials, rounding included."""
    widening = z * z / runs
    centre = share + widening / 2
    half = z * np.sqrt(share * (1 - share) / runs + widening / (4 * runs))
    return (centre + half if is_high else centre - half) / (1 + widening)
