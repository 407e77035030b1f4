"""Reports: results in, files out, whole or not at all.

In: `assess.results.Results` and nothing else. Out: PDF, HTML, Word, Excel, JSON, CSV, NRML and pelicun files.
Way: `sections` turn results into blocks (`blocks`), with the sentences of `say`; HTML (`html_blocks`, `pages`; the
PDF is the HTML with print CSS) and Word (`word`) render them; `xlsx` writes live formulas, `data` the tables.
May import: `results`, `fields` and what stands below; of methods only how they describe themselves. Evaluates
nothing.

The reports in a folder are of one run. Every file is first written into a temporary folder, which then takes their
place (`assess.delivery`): a disk that fills, or a process that is killed, leaves the reports of the earlier run as they
were. A run replaces and removes only what results.json lists (`assess.report.ownership`), so that it always writes one.
"""

import os
from collections.abc import Collection, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from assess.delivery.deliver import Written, deliver, explain_fault, find_digest, flush_file, stage_for
from assess.delivery.folders import NEW
from assess.errors import InputError, OutputError, PdfUnavailableError
from assess.i18n import fill
from assess.progress import SILENT, Progress
from assess.report.measures import reading
from assess.report.ownership import DATA, find_reports, seal
from assess.report.report_options import ReportOptions
from assess.report_formats import ALL, DEFAULT, FILES, FORMATS, Job
from assess.results import Results

_LAST = ("json", *(one.key for one in FORMATS.values() if one.edition))
"""What is written last: results.json, which lists the files before it, and the PDFs, which carry it."""


def write_reports(
    results: Results,
    folder: str | Path,
    formats: str | Sequence[str] = DEFAULT,
    options: ReportOptions | None = None,
    *,
    progress: Progress = SILENT,
) -> Written:
    """Write the reports of a run.

    * `results`: from `assess.run`.
    * `folder`: where to; made where it is missing. Reports of an earlier run in it, of any format, are replaced
      or removed; other files are left alone.
    * `formats`: of "pdf", "annex", "work", "xlsx", "html", "json", "csv", "docx", "npz", "parquet"; by default all but
      "annex", "work" and the last three; or "all". results.json is always written.
    * `options`: language, templates and kind of PDF; by default in the workbook's language, with the standard
      templates.
    * `progress`: notified of how far the work is; once it is cancelled, nothing is written.

    Returns the file of each format; its `removed` are those of an earlier run that were not replaced.

    Raises InputError if a format is unknown, a template of the firm's own cannot be used, a file of the user's stands
    at the name of a report, or the QR code of a sticker would hold too much (WorkbookError, by cell);
    PdfUnavailableError if the native libraries of the PDFs are missing; all other formats have been written;
    OutputError if a file cannot be written; what was there before is left as it was; CancelledError if the work was
    cancelled; nothing was written.
    """
    formats = list_formats((formats,) if isinstance(formats, str) else formats)
    unknown = [name for name in formats if name not in FILES]
    if unknown:
        known = ", ".join(FILES)
        raise InputError.about("formats: {name!r} is unknown, expected some of: {known}", name=unknown[0], known=known)
    folder, options = Path(folder), options or ReportOptions()
    options = options if options.language else replace(options, language=results.provenance.language)
    check_folder(folder, formats)
    if "work" in formats:
        _check_stickers(results, options)
    wanted = {*formats, "json"}
    ordered = [name for name in FILES if name in wanted - set(_LAST)] + [name for name in _LAST if name in wanted]
    try:
        with stage_for(folder) as stage, options.spoken(), reading(results.building.report_units):
            job = Job(results, options, progress, stage / NEW)
            missing = _write_all(job, folder, ordered)
            gone = deliver(stage, folder, lambda target: _find_old(target, [*job.listed, DATA]), DATA, progress)
    except OSError as error:
        raise explain_fault(folder, error, FILES.values()) from None
    if missing:
        raise missing
    files = {name: folder / file for name, file in FILES.items() if file in {*job.listed, DATA}}
    return Written(files, removed=[folder / name for name in gone])


def _check_stickers(results: Results, options: ReportOptions) -> None:
    from assess.report.content import Content
    from assess.report.figures.codes import check_codes
    from assess.report.say.orders import list_orders, list_stickers

    with options.spoken():
        content = Content(results)
        check_codes(list_stickers(list_orders(content), content.title), content.run)


def list_formats(formats: Sequence[str]) -> Sequence[str]:
    """Return the formats that are named, of "all" every one whose packages are installed."""
    return [one.key for one in FORMATS.values() if not one.missing] if ALL in formats else formats


def _find_old(folder: Path, wanted: Collection[str]) -> frozenset[str]:
    return find_reports(folder, wanted, lambda name: name in FILES.values())


def check_folder(folder: Path, formats: Sequence[str] = ()) -> None:
    """Check before the long work that files can be written to a folder, which need not exist yet.

    With `formats` it is about reports in these. Raises OutputError if nothing can be written there; InputError if a
    folder or a file of the user's stands at the name of a report (see `assess.report.ownership`), or a format needs a
    package that is not installed.
    """
    for name in formats:
        FORMATS[name].check()
    there = next((one for one in (folder, *folder.absolute().parents) if one.exists()), folder)
    if not (there.is_dir() and os.access(there, os.W_OK)):
        why = fill("you have no right to write there") if there.is_dir() else fill("{path} is a file", path=there)
        raise OutputError.about("{folder} cannot be written to: {why}. Name another folder.", folder=folder, why=why)
    if formats and folder.is_dir():
        _find_old(folder, {FILES[name] for name in (*formats, "json")})


def _write_all(job: Job, folder: Path, formats: Sequence[str]) -> PdfUnavailableError | None:
    """Write the formats into the stage; return why there is no PDF, where it was to be written."""
    missing: PdfUnavailableError | None = None
    with ExitStack() as open_, job.progress.stage("rendering") as reports:
        for one in (FORMATS[name] for name in formats):
            if one.edition:
                from assess.report.pages.pdf import start_pdf

                reports.at(0.0, detail=one.file)
                begun = start_pdf(job.content, job.options, job.progress, edition=one.edition)
                job.layouts[one.file] = open_.enter_context(begun)
        for at, name in enumerate(formats):
            file = FILES[name]
            reports.at(at / len(formats), detail=file)
            if name == "json":
                job.listed.update((FILES[each], None) for each in formats[at + 1 :])
            try:
                FORMATS[name].write(job, job.stage / file)
                flush_file(job.stage / file)
                if name not in _LAST:
                    job.listed[file] = find_digest(job.stage / file)
            except PdfUnavailableError as error:
                missing = error
                job.listed.pop(file, None)
                if "json" in formats[:at]:
                    job.write_data()
            except OSError as error:
                raise OutputError.about("{file} could not be written: {why}. {folder} is left as it was.", file=file,
                                        why=error.strerror or str(error), folder=folder) from None  # fmt: skip
        pdfs = [job.stage / file for file in job.layouts if file in job.listed]
        others = [path for path in pdfs if not seal(path, job.data)]
        if others:  # they have no place for identifiers: results.json lists them by a hash
            job.listed.update((path.name, find_digest(path)) for path in others)
            job.write_data()
            for path in pdfs:
                if path not in others:
                    seal(path, job.data)
        for path in (job.data, *pdfs):
            flush_file(path)
        reports.check()
    return missing
