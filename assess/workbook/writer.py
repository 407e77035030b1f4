"""Writes one workbook: text stays text, and a disk that fills ends in one error with nothing left over."""

import contextlib
import gc
import io
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import xlsxwriter

from assess.progress import SILENT, Progress

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

_TEXT_STAYS_TEXT = dict.fromkeys(("strings_to_formulas", "strings_to_urls", "strings_to_numbers"), False)


class _Packed(io.BytesIO):
    def __init__(self, progress: Progress) -> None:
        super().__init__()
        self._progress = progress

    def write(self, data: "ReadableBuffer", /) -> int:
        """Write."""
        self._progress.check()
        return super().write(data)


def write_book(
    path: Path, fill: Callable[[xlsxwriter.Workbook], None], by_row: bool = False, progress: Progress = SILENT
) -> None:
    """Write a workbook, to which `fill` adds the sheets; `by_row` in little memory, row by row.

    Raises OSError if it cannot be written; CancelledError if the work was cancelled (no file is left).
    """
    packed = _Packed(progress)
    with tempfile.TemporaryDirectory(prefix=".assess-sheets-", dir=path.parent) as parts:
        try:
            book = xlsxwriter.Workbook(
                packed, {"constant_memory": by_row, "in_memory": not by_row, "tmpdir": parts, **_TEXT_STAYS_TEXT}
            )
            fill(book)
            book.close()
        except (OSError, xlsxwriter.exceptions.FileCreateError) as error:
            _close_files(parts, packed)
            cause = error if isinstance(error, OSError) else error.__context__
            why = OSError(cause.errno, cause.strerror) if isinstance(cause, OSError) else OSError(0, str(error))
            raise why from None
        except BaseException:  # a cancel, or an interrupt
            _close_files(parts, packed)
            raise
    path.write_bytes(packed.getbuffer())


def _close_files(folder: str, packed: io.BytesIO) -> None:
    """Close what a failed write has left open: each would print a traceback once collected.

    XlsxWriter keeps no list of its files; exact types are asked for, as a weak reference may have lost its object.
    """
    for one in gc.get_objects():
        is_part = type(one) is io.TextIOWrapper and not one.closed and str(one.name).startswith(folder)
        if is_part or (type(one) is zipfile.ZipFile and one.fp is packed):
            with contextlib.suppress(OSError):
                one.close()
