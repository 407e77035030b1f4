"""What a run can be told, with its defaults."""

import math
import re
import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, get_args

Verify = Literal["none"]
VERIFY: tuple[str, ...] = get_args(Verify)

Scenario = Literal["as filled", "recorded", "given", "ASCE 7-22", "ASCE 7-16", "EN 1998-1", "NTC 2018"]
SCENARIOS: tuple[str, ...] = get_args(Scenario)
"""Where the floor motion comes from: as filled, floor by floor a record, then given PFA and PFV, then between the
floors above and below, then a code's profile; or records alone, given peaks alone, or one profile on every floor."""


def match_choice(text: str, choices: Iterable[str]) -> str | None:
    """Return the choice that a text means, None if none: letter case, spaces, hyphens and underscores do not count."""
    return next((choice for choice in choices if _plain(choice) == _plain(text)), None)


def _plain(text: str) -> str:
    return re.sub(r"[\s_\-\u2010-\u2015\u2212]", "", unicodedata.normalize("NFKC", text)).casefold()


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """How an inventory is assessed.

    Parameters
    ----------
    scenario : str, optional
        One of `SCENARIOS`; None takes the workbook's own, which is "as filled" where it is blank.
    verify : str
        Which pieces are verified by direct integration; "none" so far, and reports say "not verified".
    zeta_acceleration, zeta_velocity : float
        Logarithmic standard deviations of Kaneko and Hayashi's two branches [-]. The paper prints neither:
        0.20 fits 23 of the 27 rows of its Table 2; 0.5 is assumed, after FEMA P-58's dispersion on PFV.
    slide_coefficient : float
        Kaneko and Hayashi's slide coefficient, alpha of eq. 5 [-]; 1 is no sliding, the paper's assumption.
    ductility_reduction : float
        R_mu of ASCE 7-22 [-], at least 1: by how much the building's ductility lowers the PFA that this code's profile
        gives above the ground. 1 is no reduction.

    Raises
    ------
    ValueError
        If a value is not one of those allowed.
    """

    scenario: Scenario | None = None
    verify: Verify = "none"
    zeta_acceleration: float = 0.20
    zeta_velocity: float = 0.5
    slide_coefficient: float = 1.0
    ductility_reduction: float = 1.0

    def __post_init__(self) -> None:
        if self.scenario is not None and self.scenario not in SCENARIOS:
            raise ValueError(f"scenario is {self.scenario!r}, expected one of: {', '.join(SCENARIOS)}")
        if self.verify not in VERIFY:
            raise ValueError(f"verify is {self.verify!r}, expected one of: {', '.join(VERIFY)}")
        if not (0 < self.zeta_acceleration < math.inf and 0 < self.zeta_velocity < math.inf):
            raise ValueError("zeta_acceleration and zeta_velocity must be finite and above 0")
        if not 0 <= self.slide_coefficient <= 1:
            raise ValueError(f"slide_coefficient is {self.slide_coefficient}, expected 0 to 1")
        if not 1 <= self.ductility_reduction < math.inf:
            raise ValueError(f"ductility_reduction is {self.ductility_reduction}, expected at least 1, and finite")
