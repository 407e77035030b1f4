"""One cell: its content as a value of its column in SI, or what is wrong with it in words.

`READERS` says how each kind of column is read; a reader returns the value, or raises `CellError`.
"""

import datetime
import math
from collections.abc import Callable, Mapping
from functools import lru_cache, partial

from assess.errors import InputError
from assess.i18n import fill, find_language, nfill
from assess.model import Outline
from assess.units import QUANTITIES
from assess.workbook.habits import SHOWN, CellError, Remark, clean, shorten
from assess.workbook.names import find_choice, find_near, plain, say_choices
from assess.workbook.open import UNSAVED
from assess.workbook.outlines import OutlineError, parse_outline
from assess.workbook.schema import YES, Column
from assess.workbook.typed import find_slip, is_free, is_unusual, is_within, span, understand

CellReader = Callable[[object], tuple[object, tuple[Remark, ...]]]
"""Returns a cell's value in SI, and what is remarkable about it; raises CellError."""

ERRORS = frozenset({"#DIV/0!", "#N/A", "#NAME?", "#NULL!", "#NUM!", "#REF!", "#VALUE!", "#GETTING_DATA", "#SPILL!"})
_TIMES = (datetime.datetime, datetime.date, datetime.time)
_WRITE_OUTLINE = fill(
    "Write the corners in order round the room, x and y with a space between and a point as decimal sign: "
    "0 0; 6.5 0; 6.5 4; 0 4."
)


def is_blank(value: object) -> bool:
    """Tell whether a cell holds nothing to read."""
    return value is None or (isinstance(value, str) and not value.strip())


def read_text(value: object) -> str:
    """Return a cell's content as text: whole numbers without a decimal point, dates as ISO dates."""
    if isinstance(value, bool):
        return str(value).upper()
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    if isinstance(value, _TIMES):
        return value.isoformat()
    return clean(str(value))[0].strip()


@lru_cache(maxsize=512)
def cell_reader(column: Column, unit: str) -> CellReader:
    """Return what gives the value in SI of a column's cell, and what is remarkable about it.

    `unit` is that of the column's header. The value of a blank cell is None, as of a text of unseen marks alone. What
    was read is kept: the same values stand in row after row, book after book.

    What is returned raises CellError if the cell does not hold what the column needs.
    """
    read_new = partial(_read_cell, column, unit)
    read_known = lru_cache(maxsize=1024, typed=True)(read_new)

    def read(value: object) -> tuple[object, tuple[Remark, ...]]:
        is_rare = (isinstance(value, str) and len(value) > SHOWN) or value == 0  # 0 and -0 are equal, not the same
        return (read_new if is_rare else read_known)(value)

    return read


def _read_cell(column: Column, unit: str, value: object) -> tuple[object, tuple[Remark, ...]]:
    meant, remarks = value, list[Remark]()
    if not (type(value) is float or type(value) is int):
        if is_blank(value):
            return None, ()
        if value is UNSAVED:
            raise CellError(fill("the formula has no saved value."), fill("Open the workbook in Excel and save it."))
        if column.kind not in ("number", "count") and isinstance(value, str) and value.strip() in ERRORS:
            raise CellError(
                fill("{label} holds the error {error}.", label=column.label, error=value.strip()),
                fill("Correct the formula in the cell."),
            )
        if not is_free(column):
            meant, remark = understand(column, value, unit)
            remarks += [remark] if remark else []
    found = READERS[column.kind](column, meant, unit)
    if column.kind == "number" and isinstance(meant, int | float) and is_unusual(column, float(meant), unit):
        usual = span(column.usual_low, column.usual_high, column, unit)
        message = fill(
            "{column} is {number:g} {unit}, usual is {usual}.",
            column=fill(column.label), number=meant, unit=unit, usual=usual,
        )  # fmt: skip
        remarks.append(Remark(message, fill("Check the number and the unit.")))
    elif isinstance(value, str) and column.kind in ("text", "file", "records") and (removed := clean(value)[1]):
        message = nfill(
            "{n} control or direction character in {column} was taken out.",
            "{n:,} control or direction characters in {column} were taken out.",
            removed, column=fill(column.label),
        )  # fmt: skip
        remarks.append(Remark(message))
    return found, tuple(remarks)


def _read_plain(column: Column, value: object, unit: str) -> str | None:
    return read_text(value) or None


def _read_number(column: Column, value: object, unit: str) -> float:
    number = _read_typed(column.label, value, unit)
    if not is_within(column, number, unit):
        expected = span(column.low, column.high, column, unit)
        typed = fill("{number:g}{unit}", number=number, unit=f" {unit}" if unit else "")
        message = fill("{label} is {typed}, expected {expected}.", label=column.label, typed=typed, expected=expected)
        raise CellError(message, find_slip(column, number, unit))
    return number * QUANTITIES[column.quantity][unit] if column.quantity else number


def _read_typed(label: str, value: object, unit: str) -> float:
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        return float(value)
    named = {"label": label, "text": shorten(value), "unit": f" [{unit}]" if unit else ""}
    retype = fill("Set the cell's format to General and type the number again.")
    if isinstance(value, (*_TIMES, datetime.timedelta)):
        raise CellError(
            fill("{label} holds a date or time ({value}), expected a number{unit}.", value=value, **named), retype
        )
    if not isinstance(value, str):
        shown = str(value).upper() if isinstance(value, bool) else shorten(value)
        message = fill("{label} is {value}, expected a number{unit}.", value=shown, **named)
        raise CellError(message, fill("Type the number."))
    if value.strip() in ERRORS:
        message = fill("{label} holds the error {error}.", label=label, error=value.strip())
        raise CellError(message, fill("Correct the formula in the cell, or type the number."))
    raise CellError(
        fill("{label} is the text {text}, expected a number{unit}.", **named), fill("Type the number alone.")
    )


def _read_count(column: Column, value: object, unit: str) -> int:
    number = _read_typed(column.label, value, "")
    low, high = int(column.low or 0), int(column.high or 0)
    if number != int(number) or not low <= number <= high:
        raise CellError(
            fill("{label} is {number:g}, expected a whole number from {low} to {high}.",
                 label=column.label, number=number, low=str(low), high=str(high)),
            fill("Delete the row if the piece is not there.") if number == 0 else fill("Type a whole number."),
        )  # fmt: skip
    return int(number)


def _read_choice(column: Column, value: object, unit: str) -> str:
    text = read_text(value)
    if (choice := find_choice(text, column.choices)) is not None:
        return choice
    own = say_choices(column.choices, column.language)
    words = {plain(word): word for word in (*column.choices, *own)}
    near = find_near(plain(text), words)
    mark = "; " if any("," in one for one in own) else ", "
    raise CellError(
        fill("{label} is {text}, expected one of: {choices}.",
             label=column.label, text=shorten(text), choices=mark.join(own)),
        fill("Did you mean {name}?", name=words[near]) if near else fill("Choose from the list."),
    )  # fmt: skip


def _read_language(column: Column, value: object, unit: str) -> str:
    try:
        code = find_language(read_text(value))
    except InputError:
        return _read_choice(column, value, unit)
    return next(choice for choice in column.choices if find_language(choice) == code)


def _read_outline(column: Column, value: object, unit: str) -> Outline:
    try:
        return parse_outline(read_text(value), QUANTITIES[column.quantity][unit])
    except OutlineError as error:
        fault = fill("{label}: {fault}", label=column.label, fault=error.message)
        raise CellError(fault, _WRITE_OUTLINE) from None


READERS: Mapping[str, Callable[[Column, object, str], object]] = {
    "text": _read_plain,
    "file": _read_plain,
    "records": _read_plain,
    "number": _read_number,
    "count": _read_count,
    "choice": _read_choice,
    "flag": lambda column, value, unit: value if isinstance(value, bool) else _read_choice(column, value, unit) == YES,
    "language": _read_language,
    "date": lambda column, value, unit: read_text(value.date() if isinstance(value, datetime.datetime) else value),
    "outline": _read_outline,
}
