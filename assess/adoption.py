"""Which risk a report goes by: that of the formula, or that of the verification where one ran and may be believed.

Nothing may come out lower than it should without a word. A class that verification lowers is marked. Where the motions
follow a generic spectrum or are weaker than the floor's, or PFV is an estimate, verification may raise a class, but not
lower it. A piece that
overturns under the recorded motion itself is at least high.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from assess.methods import Cases, Outcome
from assess.methods._method import ALIKE, BoolArray, FloatArray
from assess.risk import RiskClass, classify_all
from assess.units import GRAVITY

FORMULA = "proposed_or"
"""The method whose value is adopted where no verification has run."""
VERIFICATION = "housner_monte_carlo"
"""The method by which pieces are verified."""

IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Adoption:
    """The adopted risk of n cases.

    Parameters
    ----------
    probability : (n,) array
        [-]
    low, high : (n,) arrays
        The interval of a verified risk [-]; NaN where the formula's is adopted.
    risk, upper : (n,) integer arrays
        Class by the probability, and by the upper end of the interval.
    verified : (n,) boolean array
        Whether it is that of the verification.
    doubtful : (n,) boolean array
        Where verification may not lower a class.
    not_lowered : (n,) boolean array
        Where verification gave a lower class, which it may not.
    """

    probability: FloatArray
    low: FloatArray
    high: FloatArray
    risk: IntArray
    upper: IntArray
    verified: BoolArray
    doubtful: BoolArray
    not_lowered: BoolArray


def adopt(outcomes: Mapping[str, Outcome], cases: Cases) -> Adoption:
    """Adopt a risk for every case."""
    formula, verification = outcomes[FORMULA].value, outcomes[VERIFICATION]
    value, low, high = (verification.value, *(verification.detail[end].astype(np.float64) for end in ("low", "high")))
    doubtful = verification.flags["generic_spectrum"] | verification.flags["weak_motions"] | cases.pfv_estimated
    has_run = ~np.isnan(value)
    not_lowered = has_run & doubtful & (classify_all(value) < classify_all(formula))
    verified = has_run & ~not_lowered
    probability = np.where(verified, value, formula)
    at_least = np.where(verification.flags["fell_in_record"], int(RiskClass.HIGH), int(RiskClass.LOW))
    risk = np.maximum(classify_all(probability), at_least)
    upper = np.where(has_run, np.maximum(risk, classify_all(high)), risk)
    return Adoption(
        probability=probability,
        low=np.where(verified, low, np.nan),
        high=np.where(verified, high, np.nan),
        risk=risk,
        upper=upper,
        verified=verified,
        doubtful=doubtful,
        not_lowered=not_lowered,
    )


def find_governing(probability: FloatArray, case_item: NDArray[np.intp], pfa: FloatArray) -> NDArray[np.intp]:
    """Return the index of the case that governs each item.

    That of the larger probability, then of the larger PFA, then the first, which is X.
    """
    by_peak, by_chance = -np.round(pfa / GRAVITY, ALIKE), -np.round(probability, ALIKE)
    order = np.lexsort((by_peak, by_chance, case_item))
    first = np.searchsorted(case_item[order], np.arange(case_item[-1] + 1 if len(case_item) else 0))
    return order[first]


def choose_items(
    verify: str, outcomes: Mapping[str, Outcome], case_item: NDArray[np.intp], has_route: BoolArray
) -> BoolArray:
    """Tell which items (m,) are to be verified, of which `has_route` says whether they stand on a route.

    "high": those that are high or very high by the formula or by Kaneko and Hayashi under any of their motions, that
    are outside the formula's checked range, or on a route.
    """
    if verify != "high":
        return np.full(has_route.size, verify == "all")
    by_class = np.maximum(*(classify_all(outcomes[key].value) for key in (FORMULA, "kaneko_hayashi")))
    wanted = (by_class >= RiskClass.HIGH) | outcomes[FORMULA].flags["extrapolated"]
    chosen = has_route.copy()
    np.logical_or.at(chosen, case_item, wanted)
    return chosen
