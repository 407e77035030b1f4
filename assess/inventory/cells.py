"""One cell: what was typed in, as a value of its column, or what is wrong with it in words."""

import datetime
import difflib
import math
import re
import unicodedata

from assess.errors import InputError
from assess.inventory.columns import Column
from assess.inventory.wording import find_choice, plain, say_choices
from assess.language import Text, fill, find_language
from assess.units import QUANTITIES

ERRORS = frozenset({"#DIV/0!", "#N/A", "#NAME?", "#NULL!", "#NUM!", "#REF!", "#VALUE!", "#GETTING_DATA", "#SPILL!"})
_COMMA = re.compile(r"\s*[-+]?\d+,\d+\s*")
_NUMERAL = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)\s*")
_UNSEEN = frozenset("\u200e\u200f\u061c\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069\u200b\u2060\ufeff")
_ESCAPE = re.compile(r"_x(00[01][0-9A-Fa-f])_")  # how a workbook writes control characters
_SHOWN = 60


class CellError(Exception):
    """A cell does not hold what its column needs; the text names the value, the rule and the likely slip."""

    def __init__(self, message: str, mend: str = "") -> None:
        super().__init__(message)
        self.message, self.mend = message, mend


def shorten(value: object) -> str:
    """Return a value as it may be quoted in a message: clean, in quotes, at most 60 characters."""
    text = clean(str(value))[0]
    return f"'{text[:_SHOWN]}…'" if len(text) > _SHOWN else f"'{text}'"


def clean(text: str) -> tuple[str, int]:
    """Take out of a text what is not text, and count it.

    Control characters become the replacement character; unseen marks, such as those that turn the direction of
    writing, are left out, since they make a text show other than it reads. Line breaks and tabs stay.
    """
    if text.isascii() and text.isprintable() and "_x0" not in text:
        return text, 0
    text = _ESCAPE.sub(lambda match: chr(int(match[1], 16)), text).replace("\r\n", "\n").replace("\r", "\n")
    kept = [_plain(character) for character in text]
    return "".join(kept), sum(new != old for new, old in zip(kept, text, strict=True))


def _plain(character: str) -> str:
    if character in "\n\t":
        return character
    if character in _UNSEEN:
        return ""
    category = unicodedata.category(character)
    noncharacter = ord(character) & 0xFFFE == 0xFFFE
    return "\ufffd" if category in ("Cc", "Cs") or noncharacter else character


def read_text(value: object) -> str:
    """Return a cell's content as text: whole numbers without a decimal point, dates as ISO dates."""
    if isinstance(value, str):
        return clean(value)[0].strip()
    if isinstance(value, bool):
        return str(value).upper()
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    if isinstance(value, datetime.datetime | datetime.date | datetime.time):
        return value.isoformat()
    return clean(str(value))[0].strip()


def read_number(column: Column, value: object, unit: str) -> float:
    """Return a cell's number as it was typed, in `unit`.

    Raises
    ------
    CellError
        If it is no number, or lies outside the column's range.
    """
    label = column.label
    if isinstance(value, bool):
        raise CellError(f"{label} is {str(value).upper()}, expected a number{_in(unit)}.", "Type the number.")
    if isinstance(value, datetime.datetime | datetime.date | datetime.time | datetime.timedelta):
        raise CellError(
            f"{label} holds a date or time ({value}), expected a number{_in(unit)}.",
            "Set the cell's format to General and type the number again.",
        )
    if isinstance(value, str):
        raise _not_a_number(label, value, unit)
    if not isinstance(value, int | float) or not math.isfinite(value):
        raise CellError(f"{label} is {shorten(value)}, expected a number{_in(unit)}.", "Type the number.")
    number = float(value)
    if not _within(column, number, unit):
        raise CellError(*_out_of_range(column, number, unit))
    return number


def read_count(column: Column, value: object) -> int:
    """Return a whole number; raises CellError otherwise."""
    number = read_number(Column(name="", label=column.label, kind="number", help=""), value, "")
    low, high = int(column.low or 0), int(column.high or 0)
    if number != int(number) or not low <= number <= high:
        mend = "Delete the row if the piece is not there." if number == 0 else "Type a whole number."
        raise CellError(f"{column.label} is {number:g}, expected a whole number from {low} to {high}.", mend)
    return int(number)


def read_choice(column: Column, value: object) -> str:
    """Return the choice that was meant; raises CellError if there is none such."""
    text = read_text(value)
    if (choice := find_choice(text, column.choices)) is not None:
        return choice
    own = say_choices(column.choices, column.language)
    allowed, words = ", ".join(own), {plain(word): word for word in (*column.choices, *own)}
    near = difflib.get_close_matches(plain(text), words, 1, 0.75)
    meant = words[near[0]] if near else None
    hint = f"Did you mean {meant}?" if meant else "Choose from the list."
    raise CellError(f"{column.label} is {shorten(text)}, expected one of: {allowed}.", hint)


def read_language(column: Column, value: object) -> str:
    """Return the language that was meant by any of its names, or its code; raises CellError if there is none such."""
    try:
        code = find_language(read_text(value))
    except InputError:
        return read_choice(column, value)
    return next(choice for choice in column.choices if find_language(choice) == code)


def read_date(value: object) -> str:
    """Return a date as text: an ISO date, or as it was typed."""
    return read_text(value.date() if isinstance(value, datetime.datetime) else value)


def is_unusual(column: Column, number: float, unit: str) -> bool:
    """Tell whether a number is allowed but outside what is usual."""
    value = number * _scale(column, unit)
    return (column.usual_low is not None and value < column.usual_low) or (
        column.usual_high is not None and value > column.usual_high
    )


def describe_unusual(column: Column, number: float, unit: str) -> Text:
    """Say that a number is not what is usual, which is given in the unit of the column's header."""
    return fill(
        "{column} is {number:g} {unit}, usual is {usual}.",
        column=fill(column.label),
        number=number,
        unit=unit,
        usual=_span(column.usual_low, column.usual_high, _scale(column, unit), unit),
    )


def describe_removed(count: int, column: Column) -> Text:
    """Say how many characters `clean` took out of a text."""
    return fill(
        "{count} control or direction characters in {column} were taken out.", count=count, column=fill(column.label)
    )


def _not_a_number(label: str, text: str, unit: str) -> CellError:
    quoted = shorten(text)
    if text.strip() in ERRORS:
        return CellError(
            f"{label} holds the error {text.strip()}.", "Mend the formula in the cell, or type the number."
        )
    if _COMMA.fullmatch(text):
        return CellError(
            f"{label} is the text {quoted} with a decimal comma, expected a number{_in(unit)}.",
            "Set the cell's format to General and type the number again.",
        )
    if _NUMERAL.fullmatch(text):
        return CellError(
            f"{label} is {quoted} stored as text, expected a number{_in(unit)}.",
            "Clear the cell, set its format to General, and type the number again.",
        )
    return CellError(f"{label} is the text {quoted}, expected a number{_in(unit)}.", "Type the number alone.")


def _in(unit: str) -> str:
    return f" [{unit}]" if unit else ""


def _scale(column: Column, unit: str) -> float:
    """Factor from the header's unit to the unit in which the column's ranges are written."""
    return QUANTITIES[column.quantity][unit] / column.factor if column.quantity else 1.0


def _within(column: Column, number: float, unit: str) -> bool:
    value = number * _scale(column, unit)
    slack = 1e-9 * abs(value)
    return (column.low is None or value >= column.low - slack) and (column.high is None or value <= column.high + slack)


def _out_of_range(column: Column, number: float, unit: str) -> tuple[str, str]:
    expected = _span(column.low, column.high, _scale(column, unit), unit)
    message = f"{column.label} is {number:g}{f' {unit}' if unit else ''}, expected {expected}."
    return message, _likely_slip(column, number, unit)


def _likely_slip(column: Column, number: float, unit: str) -> str:
    """Guess the unit that was meant: one in which the number would be usual."""
    if number < 0:
        return "Remove the minus sign." if (column.low or 0) >= 0 else ""
    names = {"cm": "centimetres", "m": "metres", "mm": "millimetres", "in": "inches", "ft": "feet"}
    first = ("in", "ft") if unit in ("in", "ft") else ()
    for other in (*first, *names, "g", "m/s2", "cm/s2", "m/s", "cm/s"):
        if other != unit and other in QUANTITIES.get(column.quantity, {}):
            usual = not is_unusual(column, number, other)
            if usual and _within(column, number, other):
                return f"Did you type {names.get(other, other)}?"
    return "Check the number and the unit in the header."


def _span(low: float | None, high: float | None, scale: float, unit: str) -> Text:
    suffix = f" {unit}" if unit else ""
    if low is not None and high is not None:
        return fill("{low:.4g} to {high:.4g}{unit}", low=low / scale, high=high / scale, unit=suffix)
    if low is not None:
        return fill("at least {low:.4g}{unit}", low=low / scale, unit=suffix)
    return fill("at most {high:.4g}{unit}", high=(high or 0) / scale, unit=suffix)
