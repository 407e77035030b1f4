"""ObsPy, the optional package that reads SAC and miniSEED."""

import importlib
import io
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from assess.errors import RecordError
from assess.language import fill

MOST_NOTES = 3
"""Warnings of ObsPy that are passed on."""


def read_traces(data: bytes, form: str) -> tuple[list[Any], tuple[str, ...]]:
    """Return ObsPy's traces of a file in its format `form`, and what it warned of.

    Raises
    ------
    RecordError
        If ObsPy is not installed, or cannot read the file.
    """
    read = _import_read()
    with warnings.catch_warnings(record=True) as caught, _watch_callbacks() as failed:
        warnings.simplefilter("always")
        try:
            traces = list(read(io.BytesIO(data), format=form))
        except Exception as error:  # what ObsPy raises of damaged files is any of twenty kinds
            why = " ".join(f"{error}".split())[:160] or type(error).__name__
            raise RecordError(f"ObsPy cannot read it ({why}). Get the file again") from error
    if failed:
        raise RecordError(f"ObsPy cannot read it ({failed[0]}). Get the file again")
    if not traces:
        raise RecordError("ObsPy finds no channel in it. Get the file again")
    # Deprecations are for programmers.
    of_data = [warning for warning in caught if issubclass(warning.category, UserWarning)]
    said = dict.fromkeys(" ".join(f"{warning.message}".split())[:160] for warning in of_data)
    return traces, tuple(fill("ObsPy warns: {text}", text=text) for text in list(said)[:MOST_NOTES])


@contextmanager
def _watch_callbacks() -> Iterator[list[str]]:
    """Collect what goes wrong where ObsPy's library in C calls Python: it would only be printed.

    Its messages quote names of stations, which in damaged files are no text.
    """
    failed: list[str] = []
    before = sys.unraisablehook
    sys.unraisablehook = lambda what: failed.append(f"{what.exc_value}"[:160])
    try:
        yield failed
    finally:
        sys.unraisablehook = before


def start_of(trace: Any) -> str:
    """Return when a trace starts; "" where its header has no date that can be."""
    try:
        return f"{trace.stats.starttime.strftime('%Y-%m-%d %H:%M:%S')} UTC"
    except (ValueError, OverflowError):
        return ""


def _import_read() -> Any:
    """Import only here: it takes a second, and need not be there."""
    with warnings.catch_warnings():
        # Of what ObsPy's own imports are about to lose; nothing that we could mend.
        warnings.simplefilter("ignore", DeprecationWarning)
        warnings.simplefilter("ignore", PendingDeprecationWarning)
        try:
            return importlib.import_module("obspy").read
        except ImportError:
            raise RecordError(
                'this format needs the package ObsPy: install it with: pip install "assess[obspy]"'
            ) from None
