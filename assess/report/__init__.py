"""Reports: results in, files out, whole or not at all.

Every file is first written into a folder of its own beside the reports and then moved into place; the moves come last
and take no space. A disk that fills, or a process that is killed, leaves the old report as it was.
"""

import os
import shutil
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from assess.errors import InputError, OutputError, PdfUnavailableError
from assess.i18n import fill
from assess.progress import SILENT, Progress
from assess.report.report_options import ReportOptions
from assess.results import Results

if TYPE_CHECKING:
    from assess.report.content import Content

_STAGE = ".assess-writing-"
_STALE = 24 * 3600.0


@dataclass(frozen=True)
class Job:
    """One set of reports that is written; the content is built once for all of them."""

    results: Results
    options: ReportOptions
    progress: Progress
    stage: Path

    @cached_property
    def content(self) -> "Content":
        """What HTML, PDF and Excel show, in the language of the reports."""
        from assess.report.content import build_content

        return self.progress.wait_for(lambda: build_content(self.results))

    @cached_property
    def data(self) -> Path:
        """results.json, written once: the PDF carries it as well."""
        from assess.report.data import write_json

        path = self.stage / FILES["json"]
        write_json(self.results, path, self.progress)
        return path


# What writes each format is imported only when it is wanted.


def _write_pdf(job: Job, path: Path) -> None:
    from assess.report.pages.pdf import write_pdf

    write_pdf(job.content, path, job.options, job.progress, data=job.data)


def _write_xlsx(job: Job, path: Path) -> None:
    from assess.report.xlsx import write_xlsx

    write_xlsx(job.content, path, job.progress)


def _write_html(job: Job, path: Path) -> None:
    from assess.report.pages.html import write_html

    write_html(job.content, path, job.options, job.progress)


def _write_json(job: Job, _path: Path) -> None:
    job.data  # noqa: B018 - written on first use


def _write_csv(job: Job, path: Path) -> None:
    from assess.report.data import write_csv

    write_csv(job.results, path, job.progress)


def _write_npz(job: Job, path: Path) -> None:
    from assess.report.data import write_npz

    write_npz(job.results, path, job.progress)


_WRITERS: Mapping[str, tuple[str, Callable[[Job, Path], None]]] = {
    "pdf": ("report.pdf", _write_pdf),
    "xlsx": ("report.xlsx", _write_xlsx),
    "html": ("report.html", _write_html),
    "json": ("results.json", _write_json),
    "csv": ("items.csv", _write_csv),
    "npz": ("outcomes.npz", _write_npz),
}
FILES: Mapping[str, str] = {name: file for name, (file, _) in _WRITERS.items()}
"""The formats, and the file that each is written to."""
FORMATS = tuple(name for name in FILES if name != "npz")
"""The formats that are written where none are asked for; the outcomes of every motion are for other programs."""


def write_reports(
    results: Results,
    folder: str | Path,
    formats: str | Sequence[str] = FORMATS,
    options: ReportOptions | None = None,
    *,
    progress: Progress = SILENT,
) -> dict[str, Path]:
    """Write the reports of a run.

    Parameters
    ----------
    results : Results
        From `assess.run`.
    folder : str or Path
        Where to; made where it is missing. Other files in it are left alone.
    formats : str or sequence of str
        Of "pdf", "xlsx", "html", "json", "csv", "npz"; all but the last by default.
    options : ReportOptions, optional
        Language, templates and kind of PDF; by default in the workbook's language, with the standard templates.
    progress : Progress, optional
        Notified of how far the work is; once it is cancelled, nothing is written.

    Returns
    -------
    dict of str to Path
        The file of each format.

    Raises
    ------
    InputError
        If a format is unknown, or a template of the firm's own cannot be used.
    PdfUnavailableError
        If the native libraries of the PDF are missing; all other formats have been written.
    OutputError
        If a file cannot be written; what was there before is left as it was.
    CancelledError
        If the work was cancelled; nothing was written.
    """
    formats = (formats,) if isinstance(formats, str) else formats
    unknown = [name for name in formats if name not in FILES]
    if unknown:
        known = ", ".join(FILES)
        raise InputError(fill("formats: {name!r} is unknown, expected some of: {known}", name=unknown[0], known=known))
    folder, options = Path(folder), options or ReportOptions()
    options = options if options.language else replace(options, language=results.provenance.language)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _sweep(folder)
        stage = Path(tempfile.mkdtemp(prefix=_STAGE, dir=folder))
    except OSError as error:
        why = error.strerror or str(error)
        raise OutputError(fill("{folder} cannot be written to: {why}.", folder=folder, why=why)) from None
    try:
        with options.spoken():
            return _write_staged(Job(results, options, progress, stage), folder, stage, tuple(dict.fromkeys(formats)))
    finally:
        shutil.rmtree(stage, ignore_errors=True)


def check_folder(folder: Path) -> None:
    """Raise OutputError if reports cannot be written to `folder`, which need not be there yet: before the long work."""
    there = next((one for one in (folder, *folder.absolute().parents) if one.exists()), folder)
    if not (there.is_dir() and os.access(there, os.W_OK)):
        why = fill("you have no right to write there") if there.is_dir() else fill("{path} is a file", path=there)
        raise OutputError(fill("{folder} cannot be written to: {why}. Name another folder.", folder=folder, why=why))


def _sweep(folder: Path) -> None:
    """Remove what a killed run left behind over a day ago; a run that is still going is younger than that."""
    for old in folder.glob(f"{_STAGE}*"):
        if time.time() - old.stat().st_mtime > _STALE:
            shutil.rmtree(old, ignore_errors=True)


def _write_staged(job: Job, folder: Path, stage: Path, formats: Sequence[str]) -> dict[str, Path]:
    missing: PdfUnavailableError | None = None
    written: dict[str, Path] = {}
    with job.progress.stage("rendering", ", ".join(formats)) as reports:
        for at, name in enumerate(formats):
            reports.at(at / len(formats))
            file, write = _WRITERS[name]
            try:
                write(job, stage / file)
                _flush(stage / file)
                written[name] = folder / file
            except PdfUnavailableError as error:
                missing = error
            except OSError as error:
                why = error.strerror or str(error)
                text = fill(
                    "{file} could not be written: {why}. {folder} is left as it was.", file=file, why=why, folder=folder
                )
                raise OutputError(text) from None
        reports.check()
    for name, path in written.items():
        try:
            (stage / FILES[name]).replace(path)
        except OSError as error:
            why = error.strerror or str(error)
            text = fill("{path} could not be replaced: {why}. Is it open in another program?", path=path, why=why)
            raise OutputError(text) from None
    if missing:
        raise missing
    return written


def _flush(path: Path) -> None:
    """Have the system put the file's bytes on the disk, where a full disk shows."""
    with path.open("rb+") as file:
        os.fsync(file.fileno())
