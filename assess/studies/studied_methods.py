"""The methods that studies compare, by key: the one place of the studies that imports methods."""

from collections.abc import Mapping

import numpy as np

from assess.arrays import BoolArray, FloatArray
from assess.methods import Cases, FittedOn, Method, Range, all_methods
from assess.methods.fitted import (
    QUANTITIES,
    Base,
    Fitted,
    Polynomial,
    Powers,
    Probit,
    expand,
    find_groups,
    write_model,
    write_sum,
)
from assess.methods.proposed_or import COEFFICIENTS
from assess.methods.simulate import rock_draws
from assess.settings import Settings

__all__ = [
    "COEFFICIENTS", "CRITERIA", "FORMULAS", "METHODS", "QUANTITIES", "Base", "BoolArray", "Cases", "Fitted", "FittedOn",
    "FloatArray", "Method", "Polynomial", "Powers", "Probit", "Range", "evaluate_formulas", "expand", "find_groups",
    "rock_draws", "write_model", "write_sum",
]  # fmt: skip

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
