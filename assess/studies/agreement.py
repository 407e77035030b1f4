"""How formulas agree with direct integration: bias, rank correlation, and the classes missed in either direction."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray, FloatArray
from assess.methods import Cases, Method, all_methods
from assess.risk import classify_all, wilson_interval
from assess.settings import Settings
from assess.studies.buildings import RECORDED, Building, Trials, all_buildings, find_levels, rock_building
from assess.studies.study import Options

OR, KANEKO, FEMA, STATIC, JAPAN = "proposed_or", "kaneko_hayashi", "fema_p58", "static", "japan_rule"
PRINTED = "equation_9"
"""Key of the proposed formula as printed, clipped to 0 and 1; the method in use holds it at its peaks."""
METHODS: Mapping[str, Method] = {one.key: one for one in all_methods() if one.tier == "screening"}
FORMULAS: Mapping[str, str] = {
    PRINTED: "OR, eq. (9) as printed", OR: "OR as used", KANEKO: "Kaneko-Hayashi", FEMA: "FEMA P-58"
}  # fmt: skip
"""Titles, as pages show them, of the formulas that give a chance, by key."""
SHORT_TITLES: Mapping[str, str] = {OR: "OR", KANEKO: FORMULAS[KANEKO], FEMA: FORMULAS[FEMA]}
"""The same on pages that do not show OR as printed."""
CRITERIA: Mapping[str, str] = {key: one.title for key, one in METHODS.items() if one.kind == "criterion"}
"""Titles of the methods that are met or not, by key."""
INTEGRATION = "direct integration"


def evaluate_formulas(cases: Cases, settings: Settings) -> dict[str, FloatArray]:
    """Return the value of each formula and each criterion for n cases, by key, (n,); NaN where it has none."""
    outcomes = {key: one.evaluate(cases, settings) for key, one in METHODS.items()}
    printed = np.clip(outcomes[OR].detail["raw"].astype(np.float64), 0.0, 1.0)
    return {PRINTED: printed} | {key: outcome.value for key, outcome in outcomes.items()}


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """How n chances by a formula agree with those by direct integration.

    * `bias`, `scatter`: mean and standard deviation of formula less integration [-].
    * `rank_correlation`: Spearman's [-]; NaN where either is constant.
    * `same_class`, `within_one_class`, `class_too_low`, `class_too_high`: shares of the cases [-]: in the class of the
      integration; at most one apart; in a lower class; in a higher.
    * `beyond_too_low`, `beyond_too_high`: the same for the class of the nearer end of the 95 % interval of each case,
      so that differences within the sampling error of the motions are not counted.
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
    """Compare chances (n,) by a formula with counts of overturned motions of `runs`; cases of NaN are left out."""
    known = ~np.isnan(formula)
    chances, counts = formula[known], fallen[known]
    reference, (low, high) = counts / runs, wilson_interval(counts, np.full(counts.size, runs))
    classes = classify_all(chances)
    steps = classes - classify_all(reference)
    return Agreement(
        cases=int(chances.size), bias=float(np.mean(chances - reference)), scatter=float(np.std(chances - reference)),
        rank_correlation=correlate_ranks(chances, reference), same_class=float(np.mean(steps == 0)),
        within_one_class=float(np.mean(np.abs(steps) <= 1)), class_too_low=float(np.mean(steps < 0)),
        class_too_high=float(np.mean(steps > 0)), beyond_too_low=float(np.mean(classes < classify_all(low))),
        beyond_too_high=float(np.mean(classes > classify_all(high))),
    )  # fmt: skip


def correlate_ranks(one: Sequence[float] | FloatArray, other: Sequence[float] | FloatArray) -> float:
    """Return Spearman's rank correlation [-]; NaN where either is constant."""
    from scipy.stats import spearmanr

    if np.ptp(one) == 0 or np.ptp(other) == 0:
        return math.nan
    return float(spearmanr(one, other).statistic)


@dataclass(frozen=True, slots=True, eq=False)
class Compared:
    """The trials of a channel with the values of the formulas, by key: (a, b) each.

    `factors` (a,) are those by which the record is scaled [-]. `ratio` is PFV/PFA of the record [s]: the lower the
    frequency of the motion, the larger.
    """

    building: Building
    trials: Trials
    formulas: Mapping[str, FloatArray]
    factors: FloatArray
    ratio: float


Chosen = Callable[[Compared], BoolArray]
"""Chooses cases of a channel: (a, b)."""


def every_case(one: Compared, rows: int | slice = slice(0, RECORDED)) -> BoolArray:
    """Choose all cases at the common values of PFA, or at those of some rows."""
    chosen = np.zeros(one.trials.fallen.shape, dtype=np.bool_)
    chosen[rows] = True
    return chosen


def evaluate_trials(building: Building, trials: Trials, options: Options) -> Compared:
    """Return trials with the values of the formulas."""
    values = evaluate_formulas(trials.cases, options.settings)
    formulas = {key: value.reshape(trials.fallen.shape) for key, value in values.items()}
    factors = np.asarray(trials.pfa / trials.channel.read().pfa)
    return Compared(building, trials, formulas, factors, float(trials.pfv[0] / trials.pfa[0]))


def rock_all(options: Options) -> list[Compared]:
    """Rock the blocks in all buildings, or load the results of an earlier run."""
    found: list[Compared] = []
    total = sum(len(one.channels) for one in all_buildings())
    for building in all_buildings():
        part = options.narrow(len(found) / total, (len(found) + len(building.channels)) / total)
        trials = rock_building(building, find_levels(building), part)
        found += [evaluate_trials(building, one, options) for one in trials]
    return found


def pool(
    compared: Sequence[Compared], key: str, chosen: Chosen = every_case, *, uncertain: bool = False
) -> tuple[FloatArray, NDArray[np.int64]]:
    """Return chances by a formula, and numbers of motions that overturned the block, of the chosen cases, (n,) each.

    The latter for exactly the recorded motion and the piece as given, or with both `uncertain`.
    """
    values = [one.formulas[key][chosen(one)] for one in compared]
    counts = [(one.trials.fallen_uncertain if uncertain else one.trials.fallen)[chosen(one)] for one in compared]
    return np.concatenate(values), np.concatenate(counts)


def agree(compared: Sequence[Compared], key: str, chosen: Chosen = every_case, *, uncertain: bool = False) -> Agreement:
    """Return how a formula agrees with integration on some channels, with motion and piece `uncertain` or not."""
    return find_agreement(*pool(compared, key, chosen, uncertain=uncertain), compared[0].trials.runs)


def by_building(compared: Sequence[Compared]) -> dict[str, list[Compared]]:
    """Return the channels of each building, by its name."""
    found: dict[str, list[Compared]] = {}
    for one in compared:
        found.setdefault(one.building.name, []).append(one)
    return found
