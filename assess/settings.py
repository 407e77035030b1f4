"""How a run is set up: every setting, its default and what it may be, checked here and nowhere else."""

import math
import operator
import os
import re
import unicodedata
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, fields, replace
from difflib import get_close_matches
from functools import partial
from pathlib import Path
from typing import Any, Literal, get_args

from assess.errors import SettingsError
from assess.i18n import Text, fill, join

Verify = Literal["none", "high", "all"]
VERIFY: tuple[str, ...] = get_args(Verify)
"""Which pieces are simulated by direct integration: none; those that are high or very high by a formula, outside its
checked range, or on a route; or all."""

AUTO = "auto"
RUNS, MOST_RUNS = 200, 100_000
MOST_SCALE = 10.0
MOST_FIRST = 1_000_000
SEED = 1
ROUTE_RISK = 0.03

Scenario = Literal["as filled", "recorded", "given", "ASCE 7-22", "ASCE 7-16", "EN 1998-1", "NTC 2018"]
SCENARIOS: tuple[str, ...] = get_args(Scenario)
"""Source of the floor motion: as filled, floor by floor a record, then given PFA and PFV, then between the floors
above and below, then a code's profile; or records alone, given peaks alone, or one profile on every floor."""

ANCHOR_CODES = ("ASCE 7-22", "EN 1998-1", "NTC 2018")
"""Codes that give the force on anchors; the first where neither the workbook nor its scenario names one of them."""

ClassBy = Literal["best formula", "proposed OR"]
CLASS_BY: tuple[str, ...] = get_args(ClassBy)
"""Which formula gives the class of what is not simulated: that which agrees best with simulation, or the paper's."""

LONGEST_SHOWN = 40  # characters of a wrong value that a message repeats


def match_choice(text: str, choices: Iterable[str]) -> str | None:
    """Return the choice that a text means, None if none: letter case, spaces, hyphens and underscores do not count."""
    return next((choice for choice in choices if _plain(choice) == _plain(text)), None)


def _plain(text: str) -> str:
    return re.sub(r"[\s_\-\u2010-\u2015\u2212]", "", unicodedata.normalize("NFKC", text)).casefold()


def _read_choice(value: Any, choices: tuple[str, ...]) -> str | None:
    return match_choice(value, choices) if isinstance(value, str) else None


def _read_whole(value: Any, low: int, high: float) -> int | None:
    if isinstance(value, str) and value.isascii() and value.isdigit() and len(value) < 20:
        value = int(value)
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        return None
    number = operator.index(value)
    return number if low <= number <= high else None


def _read_number(value: Any, is_allowed: Callable[[float], bool]) -> float | None:
    if isinstance(value, (bool, str)) or not hasattr(value, "__float__"):
        return None
    number = float(value)
    return number if math.isfinite(number) and is_allowed(number) else None


def _read_anchored(value: Any) -> int | tuple[str, ...] | None:
    """Return the names of pieces, or the number of the first entries of the schedule; None for anything else."""
    if isinstance(value, str):
        count = re.fullmatch(r"\s*first\s*:\s*(\d{1,9})\s*", value, re.IGNORECASE)
        value = int(count[1]) if count else [name.strip() for name in value.split(",")]
    if isinstance(value, Iterable):
        names = tuple(dict.fromkeys(value))
        return names if all(isinstance(name, str) and name for name in names) else None
    return _read_whole(value, 1, MOST_FIRST)


_Rule = tuple[Callable[[Any], Any], Text]


def _choice(choices: tuple[str, ...]) -> _Rule:
    return partial(_read_choice, choices=choices), fill("one of: {names}", names=", ".join(choices))


def _number(is_allowed: Callable[[float], bool], expected: Text) -> _Rule:
    return partial(_read_number, is_allowed=is_allowed), expected


_FLAG: _Rule = (lambda value: value if isinstance(value, bool) else None), fill("True or False")
_POSITIVE = _number(lambda number: number > 0, fill("above 0, and finite"))
_RULES: Mapping[str, _Rule] = {
    "scenario": _choice(SCENARIOS),
    "class_by": _choice(CLASS_BY),
    "verify": _choice(VERIFY),
    "runs": (lambda value: _read_choice(value, (AUTO,)) or _read_whole(value, 1, MOST_RUNS),
             fill("1 to {most:,}, or {auto}", most=MOST_RUNS, auto=AUTO)),
    "seed": (partial(_read_whole, low=0, high=math.inf), fill("a whole number, 0 or above")),
    "scale": _number(lambda number: 0 < number <= MOST_SCALE, fill("above 0 and at most {most:g}", most=MOST_SCALE)),
    "ideal": _FLAG,
    "scale_motions": _FLAG,
    "city": _FLAG,
    "zeta_acceleration": _POSITIVE,
    "zeta_velocity": _POSITIVE,
    "slide_coefficient": _number(lambda number: 0 <= number <= 1, fill("0 to 1")),
    "ductility_reduction": _number(lambda number: number >= 1, fill("at least 1, and finite")),
    "anchor": (_read_anchored, fill("names of items, separated by commas, or first:N")),
    "anchor_resonance": _POSITIVE,
    "anchor_strength": _POSITIVE,
    "anchor_importance": _POSITIVE,
    "anchor_behaviour": _POSITIVE,
    "anchor_period": _number(lambda number: number >= 0, fill("0 or above, and finite")),
    "route_risk": _number(lambda number: 0 < number < 1, fill("above 0 and below 1 (write 3 % as 0.03)")),
}  # fmt: skip
"""What reads the value of each setting, None for one that cannot be used, and what was expected."""
_BY_WORKBOOK = ("scenario", "class_by")  # settings of which None stands for what the workbook says


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """How an inventory is assessed.

    Words are accepted in any spelling ("asce 7-22", "ASCE_7-22") and stored in the one listed here.

    * `scenario`: One of `SCENARIOS`; None takes the workbook's own, which is "as filled" where it is blank.
    * `class_by`: Which formula gives the class where nothing was simulated, one of `CLASS_BY`; None takes the
      workbook's own, which is "best formula" where it is blank.
    * `verify`: Which pieces are simulated by direct integration, one of `VERIFY`.
    * `runs` (int or "auto"): Motions of each floor and axis, 1 to 100,000; "auto" adds motions until every piece's
      interval lies within one class, at most 5,000. 0 of 100 cannot show "low": the interval's upper end is 0.037.
    * `seed`: Random seed of the generated motions, 0 or above.
    * `scale`: Factor on the motion of every floor, of records and of peaks alike [-], above 0 and at most 10: what a
      weaker or stronger earthquake of the same kind would do.
    * `ideal`: Whether the adopted chance is that of exactly this motion and of every piece exactly as given, without
      the uncertainty of either.
    * `scale_motions`: Whether motions of the user's own are scaled to each floor's PFA.
    * `city`: Whether a draw of an earthquake differs from place to place, as buildings of a portfolio need it; else it
      is one factor for the building alone.
    * `zeta_acceleration`, `zeta_velocity`: Logarithmic standard deviations of Kaneko and Hayashi's two branches [-].
      The paper prints neither: 0.20 fits 23 of the 27 rows of its Table 2; 0.5 is assumed, after FEMA P-58's dispersion
      on PFV.
    * `slide_coefficient`: Kaneko and Hayashi's slide coefficient, alpha of eq. 5 [-]; 1 is no sliding, the paper's
      assumption.
    * `ductility_reduction`: R_mu of ASCE 7-22 [-], at least 1: the factor by which the building's ductility lowers the
      PFA that this code's profile gives above the ground. 1 is no reduction.
    * `anchor`: What if: names of pieces that are taken as anchored and holding, or how many of the first entries of the
      schedule are; also as one text, ``"25-07, 25-08"`` or ``"first:3"``.
    * `anchor_resonance`, `anchor_strength`, `anchor_importance`: C_AR, R_po and I_p of ASCE 7-22, 13.3.1, for the force
      that the code asks of anchors [-]. 1.0 and 1.5 are those of its table 13.5-1 for storage cabinets, shelving and
      laboratory equipment, as public implementations have it. I_p stands for gamma_a of EN 1998-1, too.
    * `anchor_behaviour`, `anchor_period`: q_a [-] and T_a [s] of EN 1998-1, 4.3.5. q_a 2.0 is that of the anchorage of
      cabinets and book stacks; T_a 0, of a piece that moves with the wall, is assumed.
    * `route_risk`: Limit on the chance that an evacuation route is blocked [-], above 0 and below 1: a route is open
      where the upper end of its interval is below it, and fixes are sought until that holds. 0.03 is where the class
      low ends.

    Raises SettingsError if a value cannot be used: an `InputError` and a `ValueError`, whose message begins with the
    setting's name.
    """

    scenario: Scenario | None = None
    class_by: ClassBy | None = None
    verify: Verify = "all"
    runs: int | Literal["auto"] = RUNS
    seed: int = SEED
    scale: float = 1.0
    ideal: bool = False
    scale_motions: bool = False
    city: bool = False
    zeta_acceleration: float = 0.20
    zeta_velocity: float = 0.5
    slide_coefficient: float = 1.0
    ductility_reduction: float = 1.0
    anchor: tuple[str, ...] | int = ()
    anchor_resonance: float = 1.0
    anchor_strength: float = 1.5
    anchor_importance: float = 1.0
    anchor_behaviour: float = 2.0
    anchor_period: float = 0.0
    route_risk: float = ROUTE_RISK

    def __post_init__(self) -> None:
        for name, (read, expected) in _RULES.items():
            given = getattr(self, name)
            value = None if given is None else read(given)
            if value is None and not (name in _BY_WORKBOOK and given is None):
                shown = show_given(given)
                text = fill("{name} is {value}, expected {expected}", name=name, value=shown, expected=expected)
                raise SettingsError(text)
            object.__setattr__(self, name, value)

    def as_record(self) -> dict[str, Any]:
        """Return the settings by name as they are written: what is taken as anchored as one text, "" for nothing."""
        anchor = self.anchor
        return asdict(self) | {"anchor": f"first:{anchor}" if isinstance(anchor, int) else ",".join(anchor)}


def show_given(value: object) -> str:
    """Return a value that was given as a message shows it."""
    shown = repr(value) if isinstance(value, str) else str(value)
    return shown if len(shown) <= LONGEST_SHOWN else f"{shown[:LONGEST_SHOWN]}..."


def change_settings(settings: Settings | None, changes: Mapping[str, Any]) -> Settings:
    """Return settings, by default the defaults, with `changes`; SettingsError if one of these cannot be used."""
    names = [field.name for field in fields(Settings)]
    for name in changes:
        if name not in names:
            near = get_close_matches(name, names, 1)
            if near:
                fault = fill("{name} is an unknown setting.", name=name)
                raise SettingsError(join(" ", (fault, fill("Did you mean {name}?", name=near[0]))))
            known = ", ".join(names)
            raise SettingsError(fill("{name} is an unknown setting; expected one of: {known}", name=name, known=known))
    return replace(settings or Settings(), **changes)


CPU_QUOTA = Path("/sys/fs/cgroup/cpu.max")
"""Where Linux states the processor time of a container: quota and period, or ``max`` and period."""


def count_processors() -> int:
    """Return how many processors this process may use: by its affinity, and by the quota of its control group."""
    count = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    try:
        quota, period = CPU_QUOTA.read_text(encoding="ascii").split()
        return max(1, min(count, math.ceil(int(quota) / int(period))))
    except (OSError, ValueError):  # no control group, or no quota
        return count
