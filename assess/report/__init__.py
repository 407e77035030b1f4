"""Reports: an assessment in, files out, whole or not at all.

Every file is first written into a folder of its own beside the reports and then moved into place; the moves come last
and take no space. A disk that fills, or a process that is killed, leaves the old report as it was.
"""

import os
import shutil
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import cast

from assess.errors import OutputError, PdfUnavailableError
from assess.report.look import Look
from assess.results import Assessment

FILES: Mapping[str, str] = {
    "pdf": "report.pdf",
    "xlsx": "report.xlsx",
    "html": "report.html",
    "json": "results.json",
    "csv": "items.csv",
    "npz": "outcomes.npz",
}
"""The formats, and the file that each is written to."""

FORMATS = tuple(name for name in FILES if name != "npz")
"""The formats that are written where none are asked for; the outcomes of every motion are for other programs."""
PLAIN = ("json", "csv", "npz")
"""Formats for programs: the same in every language."""
_WRITERS = {
    "pdf": ("pages.pdf", "write_pdf"),
    "xlsx": ("xlsx", "write_xlsx"),
    "html": ("pages.html", "write_html"),
    "json": ("data", "write_json"),
    "csv": ("table", "write_csv"),
    "npz": ("outcomes", "write_npz"),
}
_STAGE = ".assess-writing-"
_STALE = 24 * 3600.0


def write_reports(
    assessment: Assessment, folder: str | Path, formats: str | Sequence[str] = FORMATS, look: Look | None = None
) -> dict[str, Path]:
    """Write the reports of an assessment.

    Parameters
    ----------
    assessment : Assessment
        From `assess.run`.
    folder : str or Path
        Where to; made where it is missing. Other files in it are left alone.
    formats : str or sequence of str
        Of "pdf", "xlsx", "html", "json", "csv", "npz"; all but the last by default.
    look : Look, optional
        Language, templates and kind of PDF; by default in the workbook's language, with our own templates.

    Returns
    -------
    dict of str to Path
        The file of each format.

    Raises
    ------
    ValueError
        If a format is unknown.
    PdfUnavailableError
        If the native libraries of the PDF are missing; all other formats have been written.
    OutputError
        If a file cannot be written; what was there before is left as it was.
    InputError
        If a template of the firm's own cannot be used.
    """
    formats = (formats,) if isinstance(formats, str) else formats
    unknown = [name for name in formats if name not in FILES]
    if unknown:
        raise ValueError(f"format is {unknown[0]!r}, expected some of: {', '.join(FILES)}")
    folder, look = Path(folder), look or Look(language=assessment.inventory.report_language)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _sweep(folder)
        stage = Path(tempfile.mkdtemp(prefix=_STAGE, dir=folder))
    except OSError as error:
        raise OutputError(f"{folder} cannot be written to: {error.strerror}.") from None
    try:
        return _write_staged(assessment, folder, stage, formats, look)
    finally:
        shutil.rmtree(stage, ignore_errors=True)


def check_folder(folder: Path) -> None:
    """Raise OutputError if reports cannot be written to `folder`, which need not be there yet: before the long work."""
    there = next((one for one in (folder, *folder.absolute().parents) if one.exists()), folder)
    if not (there.is_dir() and os.access(there, os.W_OK)):
        why = "you may not write there" if there.is_dir() else f"{there} is a file"
        raise OutputError(f"{folder} cannot be written to: {why}. Name another folder.")


def _sweep(folder: Path) -> None:
    """Remove what a killed run left behind over a day ago; a run that is still going is younger than that."""
    for old in folder.glob(f"{_STAGE}*"):
        if time.time() - old.stat().st_mtime > _STALE:
            shutil.rmtree(old, ignore_errors=True)


def _write_staged(
    assessment: Assessment, folder: Path, stage: Path, formats: Sequence[str], look: Look
) -> dict[str, Path]:
    missing: PdfUnavailableError | None = None
    written: dict[str, Path] = {}
    for name in dict.fromkeys(formats):
        try:
            _write(name, assessment, stage / FILES[name], look)
            _flush(stage / FILES[name])
            written[name] = folder / FILES[name]
        except PdfUnavailableError as error:
            missing = error
        except OSError as error:
            reason = error.strerror or str(error)
            raise OutputError(f"{FILES[name]} could not be written: {reason}. {folder} is left as it was.") from None
    for name, path in written.items():
        try:
            (stage / FILES[name]).replace(path)
        except OSError as error:
            raise OutputError(
                f"{path} could not be replaced: {error.strerror}. Is it open in another program?"
            ) from None
    if missing:
        raise missing
    return written


def _write(name: str, assessment: Assessment, path: Path, look: Look) -> None:
    """Write one format; what programs read is in English, the others speak the language of the report."""
    writer = _writer(name)
    if name in PLAIN:
        writer(assessment, path)
        return
    with look.spoken():
        writer(assessment, path, look)


def _writer(name: str) -> Callable[..., None]:
    """Return the function that writes a format; each is imported only when it is wanted."""
    module, function = _WRITERS[name]
    return cast(Callable[..., None], getattr(import_module(f"assess.report.{module}"), function))


def _flush(path: Path) -> None:
    """Have the system put the file's bytes on the disk, where a full disk shows."""
    with path.open("rb+") as file:
        os.fsync(file.fileno())
