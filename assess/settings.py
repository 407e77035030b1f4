"""What a run can be told, with its defaults."""

import math
import re
import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, get_args

Verify = Literal["none", "high", "all"]
VERIFY: tuple[str, ...] = get_args(Verify)
"""Which pieces are verified by direct integration: none; those that are high or very high by a formula, outside its
checked range, or on a route; or all."""

AUTO = "auto"
RUNS, MOST_RUNS = 200, 100_000
SEED = 1
ROUTE_RISK = 0.03

Scenario = Literal["as filled", "recorded", "given", "ASCE 7-22", "ASCE 7-16", "EN 1998-1", "NTC 2018"]
SCENARIOS: tuple[str, ...] = get_args(Scenario)
"""Where the floor motion comes from: as filled, floor by floor a record, then given PFA and PFV, then between the
floors above and below, then a code's profile; or records alone, given peaks alone, or one profile on every floor."""


def match_choice(text: str, choices: Iterable[str]) -> str | None:
    """Return the choice that a text means, None if none: letter case, spaces, hyphens and underscores do not count."""
    return next((choice for choice in choices if _plain(choice) == _plain(text)), None)


def _plain(text: str) -> str:
    return re.sub(r"[\s_\-\u2010-\u2015\u2212]", "", unicodedata.normalize("NFKC", text)).casefold()


def read_runs(text: str | None) -> int | Literal["auto"] | None:
    """Return the number of motions that a text means, the usual one for None, and None for a text that means none."""
    if text is None:
        return RUNS
    if text.casefold() == AUTO:
        return "auto"
    is_number = text.isascii() and text.isdigit() and len(text) < 10
    return int(text) if is_number and 1 <= int(text) <= MOST_RUNS else None


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """How an inventory is assessed.

    Parameters
    ----------
    scenario : str, optional
        One of `SCENARIOS`; None takes the workbook's own, which is "as filled" where it is blank.
    verify : str
        Which pieces are verified by direct integration, one of `VERIFY`.
    runs : int or "auto"
        Motions of each floor and axis, 1 to 100,000; "auto" adds motions until every piece's interval lies
        within one class, at most 5,000. 0 of 100 cannot show "low": the interval's upper end is 0.037.
    seed : int
        Of the generated motions, 0 or above.
    scale_motions : bool
        Whether motions of the user's own are scaled to each floor's PFA.
    zeta_acceleration, zeta_velocity : float
        Logarithmic standard deviations of Kaneko and Hayashi's two branches [-]. The paper prints neither:
        0.20 fits 23 of the 27 rows of its Table 2; 0.5 is assumed, after FEMA P-58's dispersion on PFV.
    slide_coefficient : float
        Kaneko and Hayashi's slide coefficient, alpha of eq. 5 [-]; 1 is no sliding, the paper's assumption.
    ductility_reduction : float
        R_mu of ASCE 7-22 [-], at least 1: by how much the building's ductility lowers the PFA that this code's profile
        gives above the ground. 1 is no reduction.
    route_risk : float
        The chance [-], above 0 and below 1, under which every evacuation route is to be brought: what is to be fixed
        for it is sought down to there, and a route is called blocked or reduced from there on. 0.03 is where the class
        low ends.

    Raises
    ------
    ValueError
        If a value is not one of those allowed.
    """

    scenario: Scenario | None = None
    verify: Verify = "high"
    runs: int | Literal["auto"] = RUNS
    seed: int = SEED
    scale_motions: bool = False
    zeta_acceleration: float = 0.20
    zeta_velocity: float = 0.5
    slide_coefficient: float = 1.0
    ductility_reduction: float = 1.0
    route_risk: float = ROUTE_RISK

    def __post_init__(self) -> None:
        if self.scenario is not None and self.scenario not in SCENARIOS:
            raise ValueError(f"scenario is {self.scenario!r}, expected one of: {', '.join(SCENARIOS)}")
        if self.verify not in VERIFY:
            raise ValueError(f"verify is {self.verify!r}, expected one of: {', '.join(VERIFY)}")
        if self.runs != AUTO and not (isinstance(self.runs, int) and 1 <= self.runs <= MOST_RUNS):
            raise ValueError(f"runs is {self.runs!r}, expected 1 to {MOST_RUNS:,}, or {AUTO}")
        if self.seed < 0:
            raise ValueError(f"seed is {self.seed}, expected 0 or above")
        if not (0 < self.zeta_acceleration < math.inf and 0 < self.zeta_velocity < math.inf):
            raise ValueError("zeta_acceleration and zeta_velocity must be finite and above 0")
        if not 0 <= self.slide_coefficient <= 1:
            raise ValueError(f"slide_coefficient is {self.slide_coefficient}, expected 0 to 1")
        if not 1 <= self.ductility_reduction < math.inf:
            raise ValueError(f"ductility_reduction is {self.ductility_reduction}, expected at least 1, and finite")
        if not 0 < self.route_risk < 1:
            raise ValueError(f"route_risk is {self.route_risk}, expected above 0 and below 1")
