"""Formulas written by the functions that compute: operands that note what operators and numpy functions do to them.

A function such as ``b / B_H + c * PFA**2`` that gets an `Expression` in place of an array returns the text of its
formula in a `Notation`: of a spreadsheet, or of a worked example with its numbers. So each equation stands once.
"""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from assess.i18n import Text, fill
from assess.methods.method import Example
from assess.units import ACCELERATION, GRAVITY

G = GRAVITY / ACCELERATION["cm/s2"]
"""Standard gravity [cm/s2], as the formulas of the paper take it."""


NORMAL_CDF = np.frompyfunc(lambda x: 0.5 * math.erfc(-x / math.sqrt(2)), 1, 1)
"""Standard normal distribution function as a numpy function; `normal_cdf` gives floats."""


def normal_cdf(x: Any) -> Any:
    """Standard normal distribution function of `x` [-], accurate in both tails; NaN stays NaN."""
    found = NORMAL_CDF(x)
    return np.asarray(found, dtype=np.float64) if isinstance(found, (float, np.ndarray)) else found


COMPARISON, SUM, PRODUCT, POWER, ATOM = range(5)
"""How tightly the outermost operator of a formula binds."""


@dataclass(frozen=True, slots=True)
class Notation:
    """How formulas are written: operators, functions with ``{}`` for their arguments, and numbers."""

    plus: str
    minus: str
    times: str
    power: Callable[[str], str]
    functions: Mapping[Any, str]
    number: Callable[[float], str]

    def write(self, operation: Any, operands: list["Expression"]) -> tuple[str, int]:
        """Return the text of an operation, and how tightly it binds."""
        first, *others = operands
        if operation in (np.add, np.subtract):
            if operation is np.subtract:
                return first.bound(SUM) + self.minus + others[0].bound(PRODUCT, unsigned=True), SUM
            text = others[0].bound(SUM)  # a sum has neither ``+-`` nor ``--``, which some programs read differently
            return first.bound(SUM) + (self.minus + text[1:] if text.startswith("-") else self.plus + text), SUM
        if operation is np.multiply:
            return f"{first.bound(PRODUCT)}{self.times}{others[0].bound(PRODUCT, unsigned=True)}", PRODUCT
        if operation is np.true_divide:
            return f"{first.bound(PRODUCT)}/{others[0].bound(POWER, unsigned=True)}", PRODUCT
        if operation is np.power:
            return first.bound(ATOM, unsigned=True) + self.power(others[0].bound(ATOM, unsigned=True)), POWER
        if operation is np.negative:
            return f"-{first.bound(ATOM, unsigned=True)}", SUM
        if operation in _COMPARISONS:
            return f"{first.bound(SUM)}{_COMPARISONS[operation]}{others[0].bound(SUM)}", COMPARISON
        return self.functions[operation].format(*(one.text for one in operands)), ATOM


_COMPARISONS = {np.greater: ">", np.greater_equal: ">=", np.less: "<", np.less_equal: "<="}


class Expression(NDArrayOperatorsMixin):
    """A formula: its text, how tightly its outermost operator binds, and its value (NaN where that is unknown)."""

    __slots__ = ("level", "notation", "text", "value")

    def __init__(self, notation: Notation, text: str, level: int = ATOM, value: Any = np.nan) -> None:
        self.notation, self.text, self.level, self.value = notation, text, level, value

    def __str__(self) -> str:
        return self.text

    def bound(self, level: int, *, unsigned: bool = False) -> str:
        """Return the text, in brackets where it binds less tightly than `level`, or where its sign would matter."""
        is_loose = self.level < level or (unsigned and self.text.startswith("-"))
        return f"({self.text})" if is_loose else self.text

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **kwargs: Any) -> "Expression":
        return self._apply(ufunc, inputs)

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> "Expression":
        return self._apply(function, args)

    def _apply(self, operation: Any, values: Sequence[Any]) -> "Expression":
        write = self.notation.number
        operands = [
            one if isinstance(one, Expression) else Expression(self.notation, write(float(one)), ATOM, float(one))
            for one in values
        ]
        with np.errstate(all="ignore"):
            value = operation(*(one.value for one in operands))
        return Expression(self.notation, *self.notation.write(operation, operands), value)


EXCEL = Notation(
    plus="+", minus="-", times="*", power="^{}".format,
    number=lambda value: '""' if value != value else repr(value).removesuffix(".0"),
    functions={
        np.log: "LN({})", np.exp: "EXP({})", np.sqrt: "SQRT({})", NORMAL_CDF: "NORMSDIST({})",
        np.cos: "COS({})", np.sin: "SIN({})", np.arctan: "ATAN({})",
        np.maximum: "MAX({},{})", np.minimum: "MIN({},{})", np.where: "IF({},{},{})", np.isnan: "NOT(ISNUMBER({}))",
    },
)  # fmt: skip
"""Functions of Excel 2007; a power never begins with a sign, which Excel would apply first (-2^2 is 4 there)."""


_DECIMAL = re.compile(r"\d+\.\d+")


def plain(value: float) -> str:
    """Return a number of a formula without exponent, to 10 digits at most."""
    return np.format_float_positional(float(f"{value:.10g}"), trim="-")


PAPER = Notation(
    plus=" + ", minus=" - ", times="·", power=lambda exponent: "²" if exponent == "2" else f"^{exponent}", number=plain,
    functions={
        np.log: "ln({})", np.exp: "exp({})", np.sqrt: "√({})", NORMAL_CDF: "Φ({})", np.cos: "cos({})",
        np.sin: "sin({})", np.arctan: "atan({})", np.hypot: "√({}² + {}²)", np.maximum: "max({}, {})",
        np.minimum: "min({}, {})",
    },
)  # fmt: skip


def number(value: float, spec: str) -> Any:
    """Return an operand of a worked example, shown as `spec` formats it."""
    return Expression(PAPER, format(value, spec), ATOM, value)


def show(symbols: str, result: Any, spec: str, unit: str = "") -> Text:
    """Return a step ``symbols = numbers = result unit``, of which a report writes the decimals in its language."""
    step = " = ".join((symbols, result.text, f"{result.value:z{spec}} {unit}".rstrip()))
    return localise(step)


def localise(formula: str) -> Text:
    """Return a formula whose decimal numbers a report writes in its own way; symbols are the same in all languages."""
    numbers = _DECIMAL.findall(formula)
    values = {f"n{at}": float(one) for at, one in enumerate(numbers)}
    formats = (f"{{n{at}:.{len(one.partition('.')[2])}f}}" for at, one in enumerate(numbers))
    return fill(_DECIMAL.sub(lambda _: next(formats), formula), **values)


def show_ratio(example: Example) -> Text:
    """Return the step from breadth and height to B/H."""
    return show("B/H", number(example.breadth, ".6g") / number(example.height, ".6g"), ".5f")


def show_pfa(example: Example) -> Text:
    """Return the step from PFA in g to that in cm/s²."""
    return show("PFA", number(example.pfa / G, ".6g") * number(G, ".3f"), ".6g", "cm/s²")


def compare(symbol: str, peak: float, limit: Any, unit: str, *, is_above: bool) -> Text:
    """Return the comparison of a peak with a limit in words."""
    values = {"symbol": symbol, "peak": peak, "limit": float(limit.value), "unit": unit}
    if is_above:
        return fill("{symbol} = {peak:.6g} {unit} is above {limit:.6g} {unit}.", **values)
    return fill("{symbol} = {peak:.6g} {unit} is not above {limit:.6g} {unit}.", **values)
