"""The files of a comparison, whole or none of them: compare.html, compare.pdf, compare.xlsx, and compare.json.

As with reports, a later comparison replaces or removes only what compare.json lists, so that it is always written.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from assess.compare.changes import Comparison
from assess.compare.comparison_data import write_data
from assess.compare.comparison_view import View
from assess.delivery.deliver import Written, deliver, explain_fault, stage_for
from assess.delivery.disk import find_digest, flush_file
from assess.delivery.stages import NEW
from assess.errors import InputError, PdfUnavailableError
from assess.i18n import fill
from assess.progress import SILENT, Progress
from assess.report import check_folder
from assess.report.ownership import find_reports
from assess.report.report_options import ReportOptions

FILES: Mapping[str, str] = {
    "xlsx": "compare.xlsx",
    "html": "compare.html",
    "json": "compare.json",
    "pdf": "compare.pdf",
}
"""The formats in the order in which they are written: compare.json lists the others, and the PDF carries it."""
FORMATS = ("html", "pdf", "xlsx")
"""The formats that are written where none are asked for, beside compare.json."""


@dataclass(frozen=True)
class _Job:
    """One set of files; `listed` are those but for compare.json, with their SHA-256, None of what carries it."""

    view: View
    options: ReportOptions
    progress: Progress
    stage: Path
    listed: dict[str, str | None] = field(default_factory=dict)

    @property
    def written(self) -> list[str]:
        return [*self.listed, FILES["json"]]


def write_comparison(
    comparison: Comparison,
    folder: str | Path,
    formats: Sequence[str] = FORMATS,
    options: ReportOptions | None = None,
    *,
    progress: Progress = SILENT,
) -> Written:
    """Write the files of a comparison.

    Parameters
    ----------
    comparison : Comparison
        From `assess.compare.changes.compare`.
    folder : str or Path
        Where to; made where it is missing. Files of an earlier comparison in it are replaced or removed, others stay.
    formats : sequence of str
        Of "html", "pdf", "xlsx", "json"; compare.json is always written.
    options : ReportOptions, optional
        Language and kind of PDF.
    progress : Progress, optional
        Notified of how far the work is; once it is cancelled, nothing is written.

    Returns
    -------
    Written
        The file of each format, and what was removed.

    Raises
    ------
    InputError
        If a format is unknown, or a file of the user's stands at the name of one of the files.
    PdfUnavailableError
        If the native libraries of the PDF are missing; all other formats have been written.
    OutputError
        If a file cannot be written; what was there before is left as it was.
    CancelledError
        If the work was cancelled; nothing was written.
    """
    folder, options = Path(folder), options or ReportOptions()
    wanted = _arrange(formats)
    check_out(folder, formats)
    try:
        with stage_for(folder) as stage, options.spoken():
            job = _Job(View(comparison), options, progress, stage / NEW)
            missing = _write_all(job, wanted)
            gone = deliver(stage, folder, lambda target: _find_old(target, job.written), FILES["json"], progress)
    except OSError as error:
        raise explain_fault(folder, error, FILES.values()) from None
    if missing:
        raise missing
    files = {name: folder / file for name, file in FILES.items() if file in job.written}
    return Written(files, removed=[folder / name for name in gone])


def _find_old(folder: Path, wanted: Collection[str]) -> frozenset[str]:
    return find_reports(folder, wanted, lambda name: name in FILES.values(), FILES["json"])


def check_out(folder: Path, formats: Sequence[str]) -> None:
    """Check before the work that the files can be written to a folder; raises what `write_comparison` does."""
    names = {FILES[name] for name in _arrange(formats)}
    check_folder(folder)
    if folder.is_dir():
        _find_old(folder, names)


def _arrange(formats: Sequence[str]) -> list[str]:
    unknown = [name for name in formats if name not in FILES]
    if unknown:
        known = ", ".join(sorted(FILES))
        raise InputError(fill("formats: {name!r} is unknown, expected some of: {known}", name=unknown[0], known=known))
    return [name for name in FILES if name in {*formats, "json"}]


def _write_all(job: _Job, formats: Sequence[str]) -> PdfUnavailableError | None:
    missing: PdfUnavailableError | None = None
    with job.progress.stage("rendering", ", ".join(formats)) as stage:
        for at, name in enumerate(formats):
            stage.at(at / len(formats))
            if name == "json":
                job.listed.update((FILES[each], None) for each in formats[at + 1 :])
            try:
                _write_one(job, name)
            except PdfUnavailableError as error:
                missing = error
                del job.listed[FILES[name]]
                _write_one(job, "json")
        stage.check()
    return missing


def _write_one(job: _Job, name: str) -> None:
    """Write a file; what does is imported only when it is wanted. A PDF without identifiers is listed by its hash."""
    path, data = job.stage / FILES[name], job.stage / FILES["json"]
    if name == "json":
        write_data(job.view.found, path, dict(sorted(job.listed.items())))
    elif name == "pdf":
        from assess.compare.comparison_pages import write_print
        from assess.report.pages.pdf_seal import seal

        write_print(job.view, path, data, job.options, job.progress)
        if not seal(path, data):
            job.listed[path.name] = find_digest(path)
            _write_one(job, "json")
    elif name == "xlsx":
        from assess.compare.comparison_sheets import write_tables

        write_tables(job.view, path, job.progress)
    else:
        from assess.compare.comparison_pages import write_page

        write_page(job.view, path, job.options, job.progress)
    if name in ("xlsx", "html"):
        job.listed[path.name] = find_digest(path)
    flush_file(path)
