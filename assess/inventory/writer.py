"""Writes one workbook: text stays text, and a disk that fills ends in one error with nothing left over."""

import gc
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import xlsxwriter

_TEXT_STAYS_TEXT = dict.fromkeys(("strings_to_formulas", "strings_to_urls", "strings_to_numbers"), False)


def write_book(path: Path, fill: Callable[[xlsxwriter.Workbook], None], by_row: bool = False) -> None:
    """Write a workbook.

    Parameters
    ----------
    path : Path
        Where to; overwritten.
    fill : callable
        Adds the sheets to the open workbook.
    by_row : bool
        Whether the sheets are written row by row, in little memory.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    hook = sys.unraisablehook
    sys.unraisablehook = lambda _: None  # files left open by a failed write would each print a traceback once collected
    try:
        failure = _attempt(path, fill, by_row)
        if failure:
            gc.collect()
    finally:
        sys.unraisablehook = hook
    if failure:
        raise failure


def _attempt(path: Path, fill: Callable[[xlsxwriter.Workbook], None], by_row: bool) -> OSError | None:
    """Return what went wrong, apart from the frames that hold the open files."""
    try:
        with tempfile.TemporaryDirectory(prefix=".assess-sheets-", dir=path.parent) as parts:
            book = xlsxwriter.Workbook(path, {"constant_memory": by_row, "tmpdir": parts, **_TEXT_STAYS_TEXT})
            fill(book)
            book.close()
    except (OSError, xlsxwriter.exceptions.FileCreateError) as error:
        cause = error if isinstance(error, OSError) else error.__context__
        return OSError(cause.errno, cause.strerror) if isinstance(cause, OSError) else OSError(0, str(error))
    return None
