"""What the numbers of a report were computed with."""

import contextlib
import datetime
import os
import platform
from collections.abc import Mapping
from functools import cache


def report_time() -> datetime.datetime:
    """Return the time of the report in UTC: that of SOURCE_DATE_EPOCH where it is set (reproducible-builds.org)."""
    with contextlib.suppress(KeyError, ValueError, OverflowError, OSError):
        epoch = int(os.environ["SOURCE_DATE_EPOCH"])
        if epoch >= 0:
            return datetime.datetime.fromtimestamp(epoch, datetime.UTC)
    return datetime.datetime.now(datetime.UTC)


@cache
def versions(*, has_rocked: bool = False) -> Mapping[str, str]:
    """Return what the numbers were computed with; the verification also depends on the kind of processor."""
    import numpy as np

    found = {
        "python": platform.python_version(),
        "numpy": np.__version__,
        "system": platform.system(),
        "machine": platform.machine(),
    }
    if has_rocked:
        from importlib.metadata import version

        from llvmlite.binding import get_host_cpu_name
        from numba import config

        processor = getattr(config, "CPU_NAME", None) or get_host_cpu_name()
        found |= {"scipy": version("scipy"), "numba": version("numba"), "processor": processor}
    return found
