"""The facts of a piece on which two methods disagree, and how they are written for one piece or for several."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from assess.adoption import FORMULA, VERIFICATION
from assess.language import gettext as _
from assess.language import number
from assess.methods import Cases, Method, all_methods, proposed_or
from assess.report import words
from assess.results import ItemResult
from assess.settings import Settings
from assess.units import ACCELERATION, LENGTH, VELOCITY

__all__ = [
    "FEMA",
    "INTEGRATION",
    "KANEKO",
    "OR",
    "Facts",
    "medians_of",
    "span",
    "spans",
    "title_of",
    "values_of",
]

OR, KANEKO, FEMA, INTEGRATION = FORMULA, "kaneko_hayashi", "fema_p58", VERIFICATION
"""Keys of the methods that give a probability."""


@dataclass(frozen=True)
class Facts:
    """What is known of a piece on which the methods `highest` and `lowest` disagree; `model` is the fitted one of them.

    A fitted model is compared with a published method only, so that there is one at most.
    """

    result: ItemResult
    highest: str
    lowest: str
    model: Method | None = None

    def value(self, key: str) -> float:
        """Return the value of a method [-]; NaN where it was not evaluated."""
        value = self.result.governing.methods[key].value
        return math.nan if value is None else value

    def detail(self, key: str, name: str) -> float:
        """Return a number that stands beside a method's value; NaN where it is unknown."""
        value = self.result.governing.methods[key].detail[name]
        return math.nan if value is None else float(value)

    def has(self, key: str, flag: str) -> bool:
        """Tell whether a method raised a flag."""
        return flag in self.result.governing.methods[key].flags

    def about(self, *keys: str) -> bool:
        """Tell whether one of the two methods is one of these."""
        return self.highest in keys or self.lowest in keys

    @property
    def height(self) -> float:
        """H [cm]."""
        return self.result.item.height / LENGTH["cm"]

    @property
    def ratio(self) -> float:
        """B/H [-]."""
        return self.result.item.breadth / self.result.item.height

    @property
    def pfa(self) -> float:
        """PFA [g]."""
        return self.result.governing.demand.pfa / ACCELERATION["g"]

    @property
    def pfv(self) -> float:
        """PFV [cm/s]; NaN where it is unknown."""
        return self.result.governing.demand.pfv / VELOCITY["cm/s"]

    @property
    def can_start(self) -> bool:
        """Whether PFA exceeds g·B/H, as the static criterion tells it."""
        return self.value("static") == 1

    @property
    def branch(self) -> str:
        """Which line of Kaneko and Hayashi's equation (5) applies: ``pfa``, ``pfv`` or ``bound``."""
        return str(self.result.governing.methods[KANEKO].detail["branch"])

    @property
    def floor_frequency(self) -> float:
        """F_f [Hz]."""
        return self.detail(KANEKO, "floor_frequency_hz")

    @property
    def boundary_frequency(self) -> float:
        """F_b [Hz]."""
        return self.detail(KANEKO, "boundary_frequency_hz")

    @property
    def half_height(self) -> float:
        """Height [cm] of a piece of the same B/H of which FEMA P-58 overturns half: its median grows with √H."""
        return self.height * (self.pfv / self.detail(FEMA, "median_pfv_cm_s")) ** 2

    @property
    def runs(self) -> float:
        """Motions that it was integrated under; NaN where it was not."""
        found = self.result.governing.verification
        return math.nan if found is None else float(found.runs)

    @property
    def to_start(self) -> float:
        """PFA over g·B/H [-]: rocking can start above 1."""
        return self.pfa / self.ratio

    @cached_property
    def or_at_start(self) -> float:
        """What the proposed formula gives at PFA = g·B/H [-]."""
        return self._proposed_or(self.ratio)

    @cached_property
    def or_at_most(self) -> float:
        """The largest that the proposed formula gives for any PFA [-]; it is held past its peak, below 1 g."""
        return self._proposed_or(10.0)

    def _proposed_or(self, pfa: float) -> float:
        item = self.result.item
        case = Cases.of(breadth=item.breadth, height=item.height, pfa=pfa * ACCELERATION["g"])
        return float(proposed_or.evaluate(case, Settings()).value[0])


def span(values: Sequence[float], spec: str) -> str:
    """Return a number, or the range of several, as a format writes them: ``0.25`` or ``0.25 to 0.31``."""
    low, high = number(min(values), spec), number(max(values), spec)
    return low if low == high else _("{low} to {high}", low=low, high=high)


_SPECS: Mapping[str, str] = {"pfa": ".3f", "pfv": ".1f", "ratio": ".3f", "height": ".0f", "half_height": ",.0f",
                             "floor_frequency": ".2f", "boundary_frequency": ".2f", "to_start": ".2f"}  # fmt: skip


def spans(rows: Sequence[Facts], *names: str) -> dict[str, str]:
    """Return the ranges of facts by their names."""
    return {name: span([float(getattr(row, name)) for row in rows], _SPECS[name]) for name in names}


def values_of(rows: Sequence[Facts], key: str) -> str:
    """Return the range of what a method says."""
    return words.percents([row.value(key) for row in rows])


def medians_of(rows: Sequence[Facts], key: str, name: str, motion: str, spec: str) -> dict[str, str]:
    """Return the ranges of a method's median and of the motion over it."""
    medians = [row.detail(key, name) for row in rows]
    times = [float(getattr(row, motion)) / median for row, median in zip(rows, medians, strict=True)]
    return {"median": span(medians, spec), "times": span(times, ".2f")}


def title_of(key: str) -> str:
    """Return the title of a method."""
    return _(next(method.title for method in all_methods() if method.key == key))
