"""The live methods and the class as Excel formulas, so that a sheet shows them as one types.

Only A1 references, plain names and functions of Excel 2007 are used: every spreadsheet program evaluates them alike.
The formulas are written by the methods' own functions, so the sheet and the program cannot differ; a test recalculates
workbooks in a spreadsheet engine and holds both to 1e-9.
"""

from collections.abc import Mapping
from typing import Any

from assess.i18n import LANGUAGES, gettext
from assess.methods import ALIKE, LiveCells, Method, MethodInfo, all_methods
from assess.methods.expression import EXCEL, Expression
from assess.risk import LIMITS, RiskClass
from assess.rocking.block import STOCKY
from assess.units import ROUNDING
from assess.workbook.names import fold, plain, translate_choices
from assess.workbook.schema import Column

LIVE_METHODS = tuple(one for one in all_methods() if one.is_live)
"""The methods that have a column in the workbook; those that give a class are among them."""
OUTSIDE = "*"
"""Mark behind a class: outside the range in which its formula was checked."""


def write_plainly(page: Any) -> None:
    """Have a sheet of XlsxWriter take formulas as they are.

    It searches each for some 70 functions that are newer than Excel 2007, and for those that spill over cells, none of
    which is used here: that was nine tenths of the time of writing a report.
    """
    from xlsxwriter.worksheet import CellFormulaTuple

    def write_formula(row: int, at: int, formula: str, style: Any = None, value: Any = 0) -> None:
        page._check_dimensions(row, at)
        if page.constant_memory and row > page.previous_row:
            page._write_single_row(row)
        page.table[row][at] = CellFormulaTuple(formula.removeprefix("="), style, value)

    page.write_formula = write_formula


def write_live(method: Method, cells: Mapping[str, str], parameters: Mapping[str, str]) -> dict[str, str]:
    """Return the formulas of a method, without ``=``, by "value" and its columns; `cells` as in `LiveCells`."""
    if method.live is None:
        raise ValueError(f"{method.key} has no live formula")
    operands = {name: Expression(EXCEL, text) for name, text in cells.items()}
    own = {one.setting: Expression(EXCEL, parameters[one.setting]) for one in method.parameters}
    return {name: str(one) for name, one in method.live(LiveCells(parameters=own, **operands)).items()}


def is_slender(ratio: str, centre: str) -> str:
    """Expression for whether a piece is not too stocky to rock, by B/H and the height of its centre of gravity [-]."""
    return f"{ratio}<{STOCKY!r}*SQRT(0.25+3*({centre})^2)"


def is_stocky(ratio: str) -> str:
    """Expression for whether a piece of uniform weight is too stocky to rock, by B/H."""
    return f"{ratio}>={STOCKY!r}"


def risk_class(
    method: MethodInfo, probability: str, ratio: str, pfa: str, limits: tuple[str, str, str] | None = None
) -> str:
    """Return the class in the language in use, with `OUTSIDE` behind it where its method was not checked."""
    medium, high, very_high = limits or tuple(repr(limit) for limit in LIMITS)
    words, *labels = (f'"{say_class(risk)}"' for risk in RiskClass)
    for limit, label in zip((medium, high, very_high), labels, strict=True):
        words = f"IF({probability}>={limit},{label},{words})"
    cells = {"breadth_to_height": ratio, "pfa": pfa}
    inside = ",".join(
        f"{cells[quantity]}>={one.low * (1 - ROUNDING)!r},{cells[quantity]}<={one.high * (1 + ROUNDING)!r}"
        for quantity, one in method.valid.items()
    )
    return f'{words}&IF(AND({inside}),"","{OUTSIDE}")'


def say_class(risk: RiskClass) -> str:
    """Return symbol and word of a class in the language in use."""
    return f"{risk.symbol} {gettext(risk.word)}"


def between(number: str, column: Column, scale: float = 1.0) -> str:
    """Return an expression for whether a number, in SI times `scale`, lies in the range of a column."""
    low, high = ((limit or 0) * column.factor * scale for limit in (column.low, column.high))
    least, most = (min(one * (1 - ROUNDING), one * (1 + ROUNDING)) for one in (low, -high))
    return f"AND({number}>={least:.12g},{number}<={-most:.12g})"


def worse_axis(x: str, y: str) -> str:
    """Return the axis of the larger peak, X where they are alike to `ALIKE` decimals, as conversions leave them."""
    return f'IF(ROUND({x},{ALIKE})>=ROUND({y},{ALIKE}),"X","Y")'


def quote(text: str) -> str:
    """Return a text in the language in use as formulas write it."""
    return f'"{gettext(text)}"'


_SPACE = "\u00a0"
"""The space that breaks no line, which texts from documents and pages hold; TRIM leaves it."""
_WILD = "~*?"
"""Signs that MATCH takes for other signs unless a tilde stands before them."""


def trim(cell: str) -> str:
    """Return an expression for the text of a cell without leading, trailing and repeated spaces."""
    return f'TRIM(SUBSTITUTE({cell},"{_SPACE}"," "))'


def find_row(name: str, keys: str) -> str:
    """Return an expression for the place of a trimmed name among `keys`, an error where it is none of them."""
    for sign in _WILD:
        name = f'SUBSTITUTE({name},"{sign}","~{sign}")'
    return f"MATCH({name},{keys},0)"


def is_among(cell: str, words: str) -> str:
    """Return an expression for whether a cell holds one of `words`, written by `list_words`."""
    return f'ISNUMBER(FIND("|"&LOWER({trim(cell)})&"|",{words}))'


def list_words(choices: tuple[str, ...], choice: str) -> str:
    """Return the ways to type a choice, in every language and short, as one text: ``|yes|y|``."""
    ways: list[str] = []
    for code in LANGUAGES:
        words = dict(zip(choices, translate_choices(choices, code), strict=True))
        word, others = words.pop(choice), [fold(other) for other in words.values()]
        ways += [fold(word), plain(word), f"{plain(word)}'"]
        if not any(other.startswith(plain(word)[0]) for other in others):
            ways.append(plain(word)[0])
    return f"|{'|'.join(dict.fromkeys(ways))}|"
