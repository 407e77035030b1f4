"""The two formulas and the class as Excel formulas, so that a sheet shows them as one types.

Only A1 references, plain names and functions of Excel 2007 are used: every spreadsheet program evaluates them alike.
The numbers come from the methods themselves, so the sheet and the program cannot drift apart; a test recalculates
workbooks in a spreadsheet engine and holds both to 1e-9.
"""

from typing import Any

from assess.language import gettext
from assess.methods import kaneko_hayashi as kh
from assess.methods._method import ALIKE
from assess.methods.proposed_or import CHECKED_BREADTH_TO_HEIGHT, CHECKED_PFA, COEFFICIENTS, THIN_PFA_CAP
from assess.risk import LIMITS, RiskClass
from assess.units import ROUNDING


def write_plainly(page: Any) -> None:
    """Have a sheet of XlsxWriter take formulas as they are.

    It searches each for some 70 functions that are newer than Excel 2007, which ours are not: that was nine tenths of
    the time of writing a report. Should a later XlsxWriter name its search otherwise, it is merely slow again.
    """
    page._prepare_formula = lambda formula, expand_future_functions=False: formula.lstrip("=")


OUTSIDE = "*"
"""Mark behind a class: outside the range in which the formula was checked by tests."""


def equation_9(ratio: str, pfa: str) -> str:
    """Return equation (9) as printed, without departures; `ratio` is B/H, `pfa` in g."""
    return _plain(_terms(ratio, f"({pfa}*{kh.G!r})"))


def _terms(ratio: str, pfa: str) -> str:
    k = COEFFICIENTS
    return f"{k.a!r}+{k.b!r}/{ratio}+{k.c!r}*{pfa}+{k.d!r}/{ratio}^2+{k.e!r}*{pfa}^2+{k.f!r}*{pfa}/{ratio}"


def proposed_or(ratio: str, pfa: str) -> str:
    """Return the value of equation (9) with its departures; `ratio` is B/H, `pfa` in g."""
    k = COEFFICIENTS
    y = f"({pfa}*{kh.G!r})"
    thin = f"MAX({ratio},{-2 * k.d!r}/({k.b!r}+{k.f!r}*MIN({y},{THIN_PFA_CAP!r})))"
    held = f"MIN({y},({k.c!r}+{k.f!r}/{thin})/{-2 * k.e!r})"
    return _plain(f"MAX(0,MIN(1,{_terms(thin, held)}))")


def kaneko_hayashi(ratio: str, height: str, pfa: str, pfv: str, zeta_a: str, zeta_v: str, alpha: str) -> str:
    """Return equation (5); `height` in cm, `pfa` in g, `pfv` in cm/s or an empty text, where the upper bound stands."""
    y = f"({pfa}*{kh.G!r})"
    k = f"LN({pfa}/({ratio}*(1+{ratio})))"
    v = f"LN({pfv}/({kh.VELOCITY_FACTOR!r}*{ratio}*SQRT({height})*(1+{ratio})^{kh.VELOCITY_POWER!r}))"
    boundary = f"{kh.BOUNDARY_FACTOR!r}/SQRT({height})*(1+{ratio})^({kh.BOUNDARY_POWER!r})"
    by_pfa = f"NORMSDIST({k}/{zeta_a})"
    bound = f"MAX({by_pfa},NORMSDIST({k}/{zeta_v}))"
    switched = f"IF({y}/(2*PI()*{pfv})<={boundary},{by_pfa},NORMSDIST({v}/{zeta_v}))"
    return _plain(f"IF({pfa}<=0,0,{alpha}*IF(ISNUMBER({pfv}),{switched},{bound}))")


def risk_class(probability: str, ratio: str, pfa: str, limits: tuple[str, str, str] | None = None) -> str:
    """Return the class in the language in use, with `OUTSIDE` behind it where the formula was not checked."""
    medium, high, very_high = limits or tuple(repr(limit) for limit in LIMITS)
    words, *labels = (f'"{say_class(risk)}"' for risk in RiskClass)
    for limit, label in zip((medium, high, very_high), labels, strict=True):
        words = f"IF({probability}>={limit},{label},{words})"
    inside = ",".join((_between(ratio, CHECKED_BREADTH_TO_HEIGHT.low, CHECKED_BREADTH_TO_HEIGHT.high),
                       _between(pfa, CHECKED_PFA.low, CHECKED_PFA.high)))  # fmt: skip
    return _plain(f'{words}&IF(AND({inside}),"","{OUTSIDE}")')


def say_class(risk: RiskClass) -> str:
    """Return symbol and word of a class in the language in use."""
    return f"{risk.symbol} {gettext(risk.word)}"


def worse_axis(x: str, y: str) -> str:
    """Return the axis of the larger PFA [g], X where they are alike to `ALIKE` decimals, as conversions leave them."""
    return f'IF(ROUND({x},{ALIKE})>=ROUND({y},{ALIKE}),"X","Y")'


def _between(value: str, low: float, high: float) -> str:
    return f"{value}>={low * (1 - ROUNDING)!r},{value}<={high * (1 + ROUNDING)!r}"


def _plain(formula: str) -> str:
    """Rewrite ``--`` and ``+-``, which some programs read differently."""
    return formula.replace("+-", "-").replace("--", "+")
