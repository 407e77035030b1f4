"""What a report comes from: its date, the publications, and what its numbers were computed with."""

import contextlib
import datetime
import os
import platform
import re
from collections.abc import Mapping
from functools import cache

from assess.language import LANGUAGES, spoken
from assess.language import gettext as _
from assess.methods._method import Reference


def report_time() -> datetime.datetime:
    """Return the time of the report in UTC: that of SOURCE_DATE_EPOCH where it is set (reproducible-builds.org)."""
    with contextlib.suppress(KeyError, ValueError, OverflowError, OSError):
        epoch = int(os.environ["SOURCE_DATE_EPOCH"])
        if epoch >= 0:
            return datetime.datetime.fromtimestamp(epoch, datetime.UTC)
    return datetime.datetime.now(datetime.UTC)


def say_date(iso: str) -> str:
    """Return a date as the language in use writes it, as November 21, 2026; what is no ISO date stays as it is."""
    from babel.dates import format_date

    with contextlib.suppress(ValueError):
        if re.fullmatch(r"\d{4}-\d{2}-\d{2}", iso.strip(), re.ASCII):
            code = spoken().code if spoken().code in LANGUAGES else "en"
            return format_date(datetime.date.fromisoformat(iso.strip()), "long", locale=code)
    return iso


def say_reference(reference: Reference) -> str:
    """Return a reference with its remark in the language in use; its bibliographic part is never translated."""
    return f"{reference.bibliographic} {_(reference.remark)}" if reference.remark else reference.bibliographic


@cache
def versions(*, has_rocked: bool = False, has_routes: bool = False) -> Mapping[str, str]:
    """Return what the numbers were computed with; the verification also depends on the kind of processor."""
    from importlib.metadata import version

    import numpy as np

    found = {
        "python": platform.python_version(),
        "numpy": np.__version__,
        "system": platform.system(),
        "machine": platform.machine(),
    }
    if has_rocked:
        from llvmlite.binding import get_host_cpu_name
        from numba import config

        processor = getattr(config, "CPU_NAME", None) or get_host_cpu_name()
        found |= {"scipy": version("scipy"), "numba": version("numba"), "processor": processor}
    if has_routes:
        found |= {name: version(name) for name in ("shapely", "networkx")}
    return found
