"""The formulas as the studies name them, the proposed one as printed beside what this program makes of it."""

from collections.abc import Mapping

import numpy as np

from assess.methods import Cases, all_methods, proposed_or
from assess.methods._method import FloatArray
from assess.settings import Settings

PRINTED = "equation_9"
"""Key of the proposed formula as printed, cut to 0 and 1: what is used holds it where it would fall."""
FORMULAS: Mapping[str, str] = {
    PRINTED: "OR, eq. (9) as printed",
    "proposed_or": "OR as used",
    "kaneko_hayashi": "Kaneko-Hayashi",
    "fema_p58": "FEMA P-58",
}
"""Formulas that tell a chance, by key, as pages call them."""
CRITERIA: Mapping[str, str] = {one.key: one.title for one in all_methods() if one.kind == "criterion"}
"""Those that say yes or no."""
INTEGRATION = "direct integration"


def evaluate_formulas(cases: Cases, settings: Settings) -> dict[str, FloatArray]:
    """Return what each formula and each criterion says of n cases, by key, (n,); NaN where it cannot."""
    outcomes = {one.key: one.evaluate(cases, settings) for one in all_methods() if one.tier == "screening"}
    printed = np.clip(outcomes[proposed_or.METHOD.key].detail["raw"].astype(np.float64), 0.0, 1.0)
    return {PRINTED: printed} | {key: outcome.value for key, outcome in outcomes.items()}


def percent(share: float) -> str:
    """Return a share as pages write it."""
    return f"{100 * share:.0f} %"
