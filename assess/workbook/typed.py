"""What a person means: a cell as it was typed, as the cell that its column asks for.

`understand` takes what can be read in one way only, and says so in a note; what can be read in two ways is an error
that offers both. Cells that are typed as asked for, numbers above all, do not come here.
"""

import datetime
import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import lru_cache

from assess.i18n import LANGUAGES, Text, fill
from assess.units import GRAVITY, QUANTITIES, read_unit
from assess.workbook.habits import CellError, Remark, note, shorten
from assess.workbook.names import DASHES, ENGLISH, find_choice, plain, say_choices
from assess.workbook.open import Percent
from assess.workbook.ranges import is_within
from assess.workbook.schema import NO, YES, Column

LONGEST = 60
"""Characters of a text that may be a number or a date."""
INCHES_OF_A_FOOT = 12

_WIDE = {at: at - 0xFEE0 for at in range(0xFF01, 0xFF5F)}
_PLAIN_SIGNS: dict[int, int | str] = {**_WIDE, **DASHES, **dict.fromkeys(map(ord, "\u2019\u02bc"), "'")}
_NUMBER = re.compile(
    r"(?P<sign>[-+]?) ?(?P<digits>\d[\d.,' ]*|[.,]\d+)(?P<power>[eE][-+]?\d{1,3})?(?P<unit>.*)", re.ASCII
)
_FEET = re.compile(
    r"(?P<sign>[-+]?) ?(?:"
    r"(?P<feet>\d+) ?(?:'|ft\.?|foot|feet)(?: ?-? ?(?P<inches>\d+(?:[.,]\d+)?) ?(?:\"|''|in\.?|inch|inches))?"
    r"|(?P<more_feet>\d+[.,]\d{1,2}) ?'|(?P<more_inches>\d+(?:[.,]\d{1,2})?) ?(?:\"|''))",
    re.ASCII | re.IGNORECASE,
)
"""Feet and inches, and either alone with its sign."""
_PRIMES = {ord("\u2032"): "'", **dict.fromkeys(map(ord, "\u2033\u201d\u201c"), '"')}
_PLAIN = re.compile(r"\d+(?:[.,]\d*)?|[.,]\d+", re.ASCII)
_GROUPED = re.compile(
    r"([1-9]\d{0,2}(?P<mark>[ ',.])\d{3}(?:(?P=mark)\d{3})*)(?:(?P<point>[.,])(?P<rest>\d*))?", re.ASCII
)

_ARABIC = re.compile(r"MMI ?(\d{1,2})(|,.*)", re.ASCII | re.IGNORECASE)
_ROMAN = ("", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X", "XI", "XII")


def straighten(text: str) -> str:
    """Return a text with plain spaces, dashes, apostrophes and digits in place of those that look alike."""
    return " ".join(text.translate(_PLAIN_SIGNS).split())


def is_free(column: Column) -> bool:
    """Tell whether a column takes any text as it is."""
    return column.kind == "text" and not (column.required or column.source)


def understand(column: Column, value: object, unit: str) -> tuple[object, Remark | None]:
    """Return what belongs into a cell, and the note on that where it is not what the cell holds.

    The value is a number in the unit of the header, a choice, a date or a name; `value` itself where nothing else can
    be meant.

    Raises CellError if the cell can be read in two ways, or holds a day that does not exist.
    """
    take = _TAKERS.get(column.kind)
    return take(column, value, unit) if take else (value, None)


def _name_column(column: Column, unit: str = "") -> Text:
    label = fill(column.label)
    return fill("{label} [{unit}]", label=label, unit=unit) if unit else label


# ---------------------------------------------------------------- numbers


def _take_number(column: Column, value: object, unit: str) -> tuple[object, Remark | None]:
    if isinstance(value, Percent) and column.quantity == "share" and is_within(column, 100 * value, unit):
        shown = fill("{number:g}{unit}", number=100 * value, unit=f" {unit}")
        found = note("percent", _name_column(column, unit), f"{value:.3%}", shown, 100 * value)
        return 100 * value, replace(found, value=None)
    if not isinstance(value, str) or len(value) > LONGEST:
        return value, None
    if (length := _read_feet(column, value, unit)) is not None:
        typed = fill("{number:g}{unit}", number=length, unit=f" {unit}")
        return length, note("unit", _name_column(column, unit), shorten(value), typed, length)
    match = _NUMBER.fullmatch(straighten(value).removeprefix("'").lstrip())  # the sign by which programs enter a text
    factor = _find_factor(match["unit"].strip(), column, unit) if match else None
    if match is None or factor is None:
        return value, None
    readings = [_convert(match, digits, factor) for digits in read_digits(match["digits"].rstrip())]
    if len(readings) == 2:
        raise _describe_two(column, unit, shorten(value), readings)
    if not readings or not math.isfinite(readings[0]):
        return value, None
    number = readings[0]
    typed = fill("{number:g}{unit}", number=number, unit=f" {unit}" if unit else "")
    return number, note(_find_habit(column, value, match), _name_column(column, unit), shorten(value), typed, number)


def is_converted(column: Column, value: object, unit: str) -> bool:
    """Tell whether a text names another unit than the header, so that the number that it means was computed."""
    if not isinstance(value, str) or len(value) > LONGEST or column.kind not in ("number", "count"):
        return False
    match = _NUMBER.fullmatch(straighten(value).removeprefix("'").lstrip())
    factor = _find_factor(match["unit"].strip(), column, unit) if match else None
    return factor not in (None, 1.0) or _read_feet(column, value, unit) is not None


def _read_feet(column: Column, value: str, unit: str) -> float | None:
    if column.quantity != "length":
        return None
    match = _FEET.fullmatch(straighten(value.translate(_PRIMES)))
    if match is None:
        return None
    feet, inches = (
        float((match[name] or match[f"more_{name}"] or "0").replace(",", ".")) for name in ("feet", "inches")
    )
    if match["inches"] and inches >= INCHES_OF_A_FOOT:  # 1'800" may be one number
        return None
    known = QUANTITIES["length"]
    metres = (feet * known["ft"] + inches * known["in"]) * (-1 if match["sign"] == "-" else 1)
    return float(f"{metres / known[unit]:.12g}")


def read_digits(digits: str) -> list[float]:
    """Return the ways to read digits with separators: none, one or two.

    A single separator before exactly three digits can be a decimal sign or part thousands, except after 0.
    """
    found = [float(digits.replace(",", "."))] if _PLAIN.fullmatch(digits) else []
    match = _GROUPED.fullmatch(digits)
    if match and match["point"] != match["mark"]:
        found.append(float(f"{re.sub(r'[ .,]', '', match[1].replace(chr(39), ''))}.{match['rest'] or 0}"))
    return found


def _convert(match: re.Match[str], digits: float, factor: float) -> float:
    """Return a number in the header's unit, without the noise of binary fractions where it is converted."""
    number = digits * float(f"1{match['power'] or 'e0'}") * (-1 if match["sign"] == "-" else 1)
    return number if factor == 1 else float(f"{number * factor:.12g}")


def _find_factor(typed: str, column: Column, unit: str) -> float | None:
    if not typed:
        return 1.0
    spelt, known = read_unit(typed.rstrip(".")), QUANTITIES.get(column.quantity, {})
    if column.quantity == "acceleration" and spelt in ("%", "%g"):
        return 0.01 * GRAVITY / known[unit]
    if not column.quantity:
        return 0.01 if spelt == "%" and column.kind == "number" else None
    if spelt not in known:
        return None
    return 1.0 if spelt == unit else known[spelt] / known[unit]


def _find_habit(column: Column, value: str, match: re.Match[str]) -> str:
    if unit := match["unit"].strip():
        return "percent" if unit.startswith("%") and column.quantity != "share" else "unit"
    digits = match["digits"].rstrip()
    if _GROUPED.fullmatch(digits):
        return "thousands"
    if "," in digits:
        return "comma"
    return "text" if value.translate(_PLAIN_SIGNS) == value else "signs"


def _describe_two(column: Column, unit: str, shown: str, readings: list[float]) -> CellError:
    suffix = f" {unit}" if unit else ""
    one, other = (fill("{number:.10g}{unit}", number=number, unit=suffix) for number in readings)
    message = fill(
        "{label} is the text {text}, which can be read as {one} or as {other}.",
        label=column.label, text=shown, one=one, other=other,
    )  # fmt: skip
    return CellError(message, fill("Type the number without a separator between thousands."))


# ---------------------------------------------------------------- choices


def _take_choice(column: Column, value: object, unit: str) -> tuple[object, Remark | None]:
    if isinstance(value, bool):
        if column.kind == "flag" or not {YES, NO} <= {*column.choices}:
            return value, None
        choice = YES if value else NO
        word = say_choices((choice,), column.language)[0]
    elif not isinstance(value, str):
        return value, None
    else:
        found, word = find_meant(value, column.choices, column.language)
        if found is None or not word:
            return value, None
        choice = found
    return choice, note("choice", _name_column(column), shorten(value), word, word)


@lru_cache(maxsize=4096)  # the same choices stand in row after row
def find_meant(text: str, choices: tuple[str, ...], language: str) -> tuple[str | None, str]:
    """Return the choice that a text means, in English, and the word that belongs into the cell.

    The word is in the language of the column, and "" where the cell holds that choice as it is written in any
    language. Understood are letter case, spaces and accents left out, the first letters of one choice alone (of these
    the words for yes and no come first), and an intensity in Arabic numerals: ``MMI 7``.
    """
    typed = text.casefold()
    if any(typed == choice.casefold() for choice in choices):
        return find_choice(text, choices), ""
    choice = find_choice(_with_roman(text), choices) or _find_short(plain(text), choices, language)
    if choice is None or any(typed == word.casefold() for code in LANGUAGES for word in say_choices(choices, code)):
        return choice, ""
    return choice, say_choices(choices, language)[choices.index(choice)]


def _with_roman(text: str) -> str:
    """Return the text of an MMI with its number as the scale writes it, in Roman numerals; any other as it is."""
    match = _ARABIC.fullmatch(straighten(text))
    return f"MMI {_ROMAN[int(match[1])]}{match[2]}" if match and int(match[1]) < len(_ROMAN) else text


def _find_short(typed: str, choices: tuple[str, ...], language: str) -> str | None:
    """Return the one choice that begins with some letters: yes or no, else in the column's language, else in others."""
    if not typed:
        return None
    for among in ((YES, NO), choices):
        for code in dict.fromkeys((language, ENGLISH, *LANGUAGES)):
            words = zip(choices, say_choices(choices, code), strict=True)
            found = [choice for choice, word in words if choice in among and plain(word).startswith(typed)]
            if found:
                return found[0] if len(found) == 1 else None
    return None


# ---------------------------------------------------------------- dates and names


def _take_date(column: Column, value: object, unit: str) -> tuple[object, Remark | None]:
    if not isinstance(value, str):
        return value, None
    text = straighten(value[:LONGEST])
    date = read_date(column.label, text, shorten(value))
    if date is None and not is_month(text):
        message = fill(
            "{label} is {text}, which is not read as a date; it is shown as typed.",
            label=_name_column(column), text=shorten(value),
        )  # fmt: skip
        return value, Remark(message, AS_ISO)
    if date is None or date == value:
        return value, None
    return date, note("date", _name_column(column), shorten(value), date, date)


def _take_name(column: Column, value: object, unit: str) -> tuple[object, Remark | None]:
    """Take stray spaces out of a name that other cells compare with."""
    if not isinstance(value, str):
        return value, None
    name = " ".join(value.split())
    return (
        (value, None)
        if name == value
        else (name, note("spaces", _name_column(column), shorten(value), shorten(name), name))
    )


_Taker = Callable[[Column, object, str], tuple[object, Remark | None]]
_TAKERS: Mapping[str, _Taker] = {
    "number": _take_number,
    "count": _take_number,
    "choice": _take_choice,
    "flag": _take_choice,
    "date": _take_date,
    "text": _take_name,
}


# ---------------------------------------------------------------- dates, as people type them

_MONTHS = (
    ("january", "gennaio"), ("february", "febbraio"), ("march", "marzo"), ("april", "aprile"), ("may", "maggio"),
    ("june", "giugno"), ("july", "luglio"), ("august", "agosto"), ("september", "settembre"), ("october", "ottobre"),
    ("november", "novembre"), ("december", "dicembre"),
)  # fmt: skip
_ISO = re.compile(r"(\d{4})([-/.])(\d{1,2})\2(\d{1,2})(?:[T ]00:00(?::00)?)?", re.ASCII)
_NUMBERS = re.compile(r"(\d{1,2}) ?([-/.]) ?(\d{1,2}) ?\2 ?(\d{4})", re.ASCII)
_SHORT_YEAR = re.compile(r"\d{1,2} ?([-/.]) ?\d{1,2} ?\1 ?\d{2}", re.ASCII)
_DAY_FIRST = re.compile(r"(\d{1,2})(?:st|nd|rd|th|[.º°])?[ -]*([^\W\d_]{3,12})[., -]*(\d{4})", re.ASCII)
_MONTH_FIRST = re.compile(r"([^\W\d_]{3,12})[. -]*(\d{1,2})(?:st|nd|rd|th)?[, -]+(\d{4})", re.ASCII)
_MONTH = re.compile(r"(?:([^\W\d_]{3,12})\.?,? |\d{1,2}/|)\d{4}|\d{4}-\d{1,2}", re.ASCII)
AS_ISO = fill("Write it as year-month-day: 2026-12-31.")


def read_date(label: str, text: str, shown: str) -> str | None:
    """Return a date as an ISO date, None for a text that is not written as one.

    Understood are 2026-12-31, 31/12/2026, 12.31.2026, 31 Dec 2026, December 31, 2026 and 31 dicembre 2026.

    `text`: with plain spaces and signs.
    `shown`: the text as messages quote it.
    Raises CellError if there is no such day, or the order of day and month cannot be known.
    """
    if _SHORT_YEAR.fullmatch(text):
        message = fill("{label} is {text}: the year has two digits.", label=label, text=shown)
        raise CellError(message, AS_ISO)
    found = list(dict.fromkeys(_list_readings(text)))
    if not found:
        return None
    days = [day for reading in found if isinstance(day := _build(*reading), datetime.date)]
    if not days:
        why = _build(*min(found, key=lambda reading: not 1 <= reading[1] <= 12))
        raise CellError(
            fill("{label} is {text}, which is not a date: {why}.", label=label, text=shown, why=why), AS_ISO
        )
    if len(days) > 1:
        one, other = (day.isoformat() for day in days)
        message = fill(
            "{label} is {text}, which can be read as {one} or as {other}.",
            label=label, text=shown, one=one, other=other,
        )  # fmt: skip
        raise CellError(message, fill("Write {one} or {other}.", one=one, other=other))
    return days[0].isoformat()


def is_month(text: str) -> bool:
    """Tell whether a text is a month and its year, such as March 2026, or a year: a date without its day."""
    match = _MONTH.fullmatch(text)
    return match is not None and (not match[1] or bool(_find_month(match[1])))


def _list_readings(text: str) -> Iterator[tuple[int, int, int]]:
    if match := _ISO.fullmatch(text):
        yield int(match[1]), int(match[3]), int(match[4])
    elif match := _NUMBERS.fullmatch(text):
        first, second, year = int(match[1]), int(match[3]), int(match[4])
        yield from ((year, second, first), (year, first, second))
    elif (match := _DAY_FIRST.fullmatch(text)) and (month := _find_month(match[2])):
        yield int(match[3]), month, int(match[1])
    elif (match := _MONTH_FIRST.fullmatch(text)) and (month := _find_month(match[1])):
        yield int(match[3]), month, int(match[2])


def _find_month(word: str) -> int:
    typed = word.casefold()
    return next((at for at, names in enumerate(_MONTHS, 1) if any(one.startswith(typed) for one in names)), 0)


def _build(year: int, month: int, day: int) -> datetime.date | Text:
    try:
        return datetime.date(year, month, day)
    except ValueError:
        pass
    if not 1 <= month <= 12:
        return fill("there is no month {month}", month=str(month))
    try:
        last = datetime.date(year + month // 12, month % 12 + 1, 1) - datetime.timedelta(days=1)
    except ValueError:  # before the year 1, or after the year 9999
        return fill("there is no year {year}", year=str(year))
    return fill("month {month} of {year} has {last} days", month=str(month), year=str(year), last=str(last.day))
