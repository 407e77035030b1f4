"""What the number of a cell means: a date, a time or a percentage where its format shows it so."""

from collections.abc import Mapping
from typing import Any

_DATES = frozenset({*range(14, 23), 45, 46, 47})
"""Numbers of the built-in formats that show a number as a date or a time."""


class Percent(float):
    """A number that its cell shows as a percentage."""


def find_format(number: str, codes: Mapping[str, str]) -> str | None:
    """Return the format that shows a number as a date or a time, or as a percentage ("%"); else None."""
    code = codes.get(number, "")
    if number in ("9", "10") or "%" in code:
        return "%"
    if not code:
        return ("[h]" if number == "46" else "d") if number.isdigit() and int(number) in _DATES else None
    if not any(letter in "dmhys" for letter in code.lower()):
        return None
    from openpyxl.styles.numbers import is_date_format

    return code if is_date_format(code) else None


def read_number(number: float, code: str | None, *, is_1904: bool) -> Any:
    """Return what the number of a cell means: a date, a time or a percentage where its format shows it so."""
    if code is None:
        return number
    if code == "%":
        return Percent(number)
    from openpyxl.styles.numbers import is_timedelta_format
    from openpyxl.utils.datetime import MAC_EPOCH, WINDOWS_EPOCH, from_excel

    try:
        epoch = MAC_EPOCH if is_1904 else WINDOWS_EPOCH
        return from_excel(number, epoch, timedelta=is_timedelta_format(code))
    except (OverflowError, ValueError):
        return "#VALUE!"
