"""Dates as people type them, and which of them can be read in one way only."""

import datetime
import re
from collections.abc import Iterator

from assess.i18n import Text, fill
from assess.workbook.habits import CellError

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
