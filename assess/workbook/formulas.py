"""The live methods and the class as Excel formulas, so that a sheet shows them as one types.

Only A1 references, plain names and functions of Excel 2007 are used: every spreadsheet program evaluates them alike.
The formulas are written by the methods' own functions, so the sheet and the program cannot differ; a test recalculates
workbooks in a spreadsheet engine and holds both to 1e-9.
"""

from collections.abc import Mapping
from typing import Any

from assess.i18n import gettext
from assess.methods import LiveCells, Method, Range, adopted_formula, all_methods
from assess.methods._expression import EXCEL, Expression
from assess.methods._method import ALIKE
from assess.risk import LIMITS, RiskClass
from assess.units import ROUNDING

LIVE_METHODS = tuple(one for one in all_methods() if one.is_live)
"""The methods that have a column in the workbook; the adopted formula is one of them."""

OUTSIDE = "*"
"""Mark behind a class: outside the range in which the adopted formula was checked by tests."""


def write_plainly(page: Any) -> None:
    """Have a sheet of XlsxWriter take formulas as they are.

    It searches each for some 70 functions that are newer than Excel 2007, none of which is used here: that was nine
    tenths of the time of writing a report. Should a later XlsxWriter name its search otherwise, it is slow again.
    """
    page._prepare_formula = lambda formula, expand_future_functions=False: formula.lstrip("=")


def write_live(method: Method, cells: Mapping[str, str], parameters: Mapping[str, str]) -> dict[str, str]:
    """Return the formulas of a live method, without ``=``: its "value", and those of its columns that are live.

    Parameters
    ----------
    method : Method
        One of `LIVE_METHODS`.
    cells : mapping of str to str
        References by the names of `assess.methods.LiveCells`: breadth_to_height, height_cm, pfa_g, pfv_cm_s.
    parameters : mapping of str to str
        References or numbers by the settings that the method reads.
    """
    if method.live is None:
        raise ValueError(f"{method.key} has no live formula")
    operands = {name: Expression(EXCEL, text) for name, text in cells.items()}
    own = {one.setting: Expression(EXCEL, parameters[one.setting]) for one in method.parameters}
    return {name: str(one) for name, one in method.live(LiveCells(parameters=own, **operands)).items()}


def risk_class(probability: str, ratio: str, pfa: str, limits: tuple[str, str, str] | None = None) -> str:
    """Return the class in the language in use, with `OUTSIDE` behind it where the formula was not checked."""
    medium, high, very_high = limits or tuple(repr(limit) for limit in LIMITS)
    words, *labels = (f'"{say_class(risk)}"' for risk in RiskClass)
    for limit, label in zip((medium, high, very_high), labels, strict=True):
        words = f"IF({probability}>={limit},{label},{words})"
    checked = adopted_formula().valid
    inside = ",".join((_between(ratio, checked["breadth_to_height"]), _between(pfa, checked["pfa"])))
    return f'{words}&IF(AND({inside}),"","{OUTSIDE}")'


def say_class(risk: RiskClass) -> str:
    """Return symbol and word of a class in the language in use."""
    return f"{risk.symbol} {gettext(risk.word)}"


def worse_axis(x: str, y: str) -> str:
    """Return the axis of the larger PFA [g], X where they are alike to `ALIKE` decimals, as conversions leave them."""
    return f'IF(ROUND({x},{ALIKE})>=ROUND({y},{ALIKE}),"X","Y")'


def _between(value: str, inside: Range) -> str:
    return f"{value}>={inside.low * (1 - ROUNDING)!r},{value}<={inside.high * (1 + ROUNDING)!r}"
