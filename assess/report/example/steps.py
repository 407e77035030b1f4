"""What the worked example is made of: a piece in the units of the paper, and the steps that methods share.

Every step that computes reads ``symbol = numbers = result [unit]``, with more digits than a result needs, so that a
reader with a calculator finds the result again. Formulas go through `fill_in`, sentences through ``_``.
"""

import math
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from assess.cases import CaseResult
from assess.language import gettext as _
from assess.language import spoken
from assess.methods import Method
from assess.methods._method import normal_cdf
from assess.methods.kaneko_hayashi import G
from assess.report.words import percent
from assess.risk import classify
from assess.settings import Settings
from assess.units import ACCELERATION, GRAVITY

Worked = tuple[list[str], str]
"""The steps, and the result in words."""
_DECIMAL = re.compile(r"\d+\.\d+")
"""A decimal number in a formula; the precision of a ``{}`` has no digit before its point."""


@dataclass(frozen=True, slots=True)
class Piece:
    """A piece [cm] and its motion [cm/s², cm/s], in the symbols of the paper; PFV and restitution may be NaN."""

    B: float
    H: float
    PFA: float
    PFV: float
    case: CaseResult
    settings: Settings
    restitution: float

    @property
    def put(self) -> dict[str, float]:
        """The numbers that most formulas need."""
        return {"B": self.B, "H": self.H, "x": self.B / self.H, "PFA": self.PFA, "PFV": self.PFV, "g": G}

    def value(self, method: Method) -> float:
        """Return the value of a method that was evaluated."""
        return float(self.case.methods[method.key].value or 0.0)

    def detail(self, method: Method, name: str) -> float:
        """Return a number that stands beside a method's value; NaN where it is unknown."""
        value = self.case.methods[method.key].detail[name]
        return math.nan if value is None else float(value)

    def has(self, method: Method, flag: str) -> bool:
        """Tell whether a method raised a flag."""
        return flag in self.case.methods[method.key].flags


def fill_in(template: str, /, **values: Any) -> str:
    """Return a formula with `values` put in, numbers as the language in use writes them.

    A formula holds symbols only and is the same in every language, so it is not collected for translation; decimals
    that are part of it are written likewise. A word beside the symbols, such as the name of a result, comes in as one
    of the `values`, from ``_``.
    """
    return _(_DECIMAL.sub(lambda found: spoken().number(found[0]), template), **values)


def chance(symbol: str, value: float) -> str:
    """Return a probability as the result of a calculation, with its class."""
    risk = classify(value)
    word = _(risk.word) if risk is not None else ""
    return _("{symbol} = {value:.4f}, that is {percent}: {risk}", symbol=symbol, value=value, percent=percent(value),
             risk=word)  # fmt: skip


def verdict(piece: Piece, method: Method) -> str:
    """Return the outcome of a criterion in words."""
    return _(method.words[0] if piece.value(method) else method.words[1])


def show_ratio(piece: Piece) -> str:
    """Return the step from breadth and height to B/H."""
    return fill_in("B/H = {B:.6g}/{H:.6g} = {x:.5f}", **piece.put)


def show_acceleration(piece: Piece) -> str:
    """Return the step from PFA in g to that in cm/s²."""
    in_g = piece.PFA * ACCELERATION["cm/s2"] / GRAVITY
    return fill_in("PFA = {in_g:.6g}·{g:.3f} = {PFA:.6g} cm/s²", **piece.put, in_g=in_g)


def phi(z: float) -> float:
    """Return the standard normal distribution function of `z` [-]."""
    return float(normal_cdf(np.array(z)))
