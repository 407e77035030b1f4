"""What a report comes from: its date and the publications."""

import contextlib
import datetime
import re
from typing import TYPE_CHECKING

from assess.environment import find_source_date
from assess.i18n import LANGUAGES, gettext as _, spoken

if TYPE_CHECKING:
    from assess.methods import Reference


def report_time() -> datetime.datetime:
    """Return the time of the report in UTC, of SOURCE_DATE_EPOCH where it is set (InputError if that is no date)."""
    return find_source_date() or datetime.datetime.now(datetime.UTC)


def say_date(iso: str) -> str:
    """Return a date as the language in use writes it, as November 21, 2026; what is no ISO date stays as it is."""
    from babel.dates import format_date

    with contextlib.suppress(ValueError):
        if re.fullmatch(r"\d{4}-\d{2}-\d{2}", iso.strip(), re.ASCII):
            code = spoken().code if spoken().code in LANGUAGES else "en"
            return format_date(datetime.date.fromisoformat(iso.strip()), "long", locale=code)
    return iso


def say_reference(reference: "Reference") -> str:
    """Return a reference with its remark in the language in use; its bibliographic part is never translated."""
    return f"{reference.bibliographic} {_(reference.remark)}" if reference.remark else reference.bibliographic
