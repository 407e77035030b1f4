"""What the program takes from the variables of its environment, and how to install what it lacks there."""

import datetime
import os

from assess.errors import InputError
from assess.i18n import Text, fill

DATE = "SOURCE_DATE_EPOCH"
"""The variable that dates reports, for builds that can be repeated (reproducible-builds.org)."""
LAST = 253_402_300_799  # the last second of the year 9999, the latest that dates are known of [s since 1970]


def find_source_date() -> datetime.datetime | None:
    """Return the time in UTC that SOURCE_DATE_EPOCH gives, None without one; InputError if it is no such number."""
    text = os.environ.get(DATE, "")
    if not text:
        return None
    if not (text.isascii() and text.isdigit() and len(text) <= len(str(LAST)) and int(text) <= LAST):
        message = fill(
            "the environment variable {name} is {value}, expected seconds since 1970, 0 to {last}. Unset it, or give "
            "a number.",
            name=DATE, value=repr(text[:40]), last=LAST,
        )  # fmt: skip
        raise InputError(message)
    return datetime.datetime(1970, 1, 1, tzinfo=datetime.UTC) + datetime.timedelta(seconds=int(text))


def say_install(extra: str) -> Text:
    """Return how to install an extra of pyproject.toml; the name `assess` on PyPI is another project's."""
    return fill(
        "Install it from the folder of the source code of assess: python -m pip install '.[{extra}]', or with pipx: "
        "pipx install --force '.[{extra}]'",
        extra=extra,
    )
