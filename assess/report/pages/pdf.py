"""The PDF reports: the HTML with print.css, laid out by WeasyPrint; the workbook and results.json are attached."""

import base64
import contextlib
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from datetime import datetime
from pathlib import Path
from typing import IO

from assess.delivery.folders import private_folder
from assess.errors import AssessError, PdfUnavailableError, Problem
from assess.i18n import fill, gettext as _
from assess.progress import ASKED_EVERY, SILENT, Progress
from assess.report.content import Content
from assess.report.fonts import find_missing, find_nowhere, print_fonts, replace_signs
from assess.report.ownership import DATA
from assess.report.pages import glyphs
from assess.report.pages.html import list_missing_figures, render
from assess.report.pages.pdf_layout import MISSING, UNWRITTEN
from assess.report.provenance import report_time
from assess.report.report_options import ReportOptions
from assess.report.view import Edition
from assess.results import Results

DEBIAN = "apt install libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0"
_KINDS = {
    ".xlsx": "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
    ".xlsm": "application/vnd.ms-excel.sheet.macroenabled.12",
    ".json": "application/json",
}


@dataclass(frozen=True, slots=True)
class Attached:
    """One file inside the PDF; `relationship` is one of PDF/A-3's, `kind` its media type, `data` in base64."""

    name: str
    kind: str
    relationship: str
    description: str
    data: str


@contextlib.contextmanager
def start_pdf(
    content: Content, options: ReportOptions, progress: Progress = SILENT, *, edition: Edition = "client"
) -> Iterator["Layout"]:
    """Begin to lay a PDF out in a process of its own, for `finish_pdf`; raises CancelledError if cancelled."""
    problems = progress.wait_for(lambda: [*list_problems(content.run), *list_missing_figures(content)])
    html = render(content.with_problems(problems), options, for_print=True, edition=edition, progress=progress)
    with start_layout(html) as layout:
        yield layout


def finish_pdf(
    layout: "Layout", results: Results, path: Path, options: ReportOptions, progress: Progress, data: Path
) -> None:
    """Write report.pdf or annex.pdf that was begun: PDF/A-3u, or PDF/UA-1 where it is to be accessible.

    It carries the workbook and `data`, results.json. Raises PdfUnavailableError if native libraries of WeasyPrint are
    missing; OSError if the file cannot be written; CancelledError; what is written of the file is of no use then.
    """
    files = [attach(DATA, "Data", _("The results, for other programs"), data.read_bytes())]
    if "workbook" in results.series:
        description, workbook = _("The inventory that this report was made from"), results.series["workbook"].tobytes()
        files.append(attach(results.provenance.workbook, "Source", description, workbook))
    files.sort(key=lambda file: file.name.encode("utf-8", "ignore"))  # as a PDF wants them
    layout.finish(path, files, options, progress)


def print_page(
    html: str,
    path: Path,
    files: Sequence[Attached],
    options: ReportOptions,
    progress: Progress = SILENT,
    *,
    moment: datetime | None = None,
) -> None:
    """Write a page that was rendered for print as a PDF that carries `files`; raises what `finish_pdf` does.

    `moment` is its date, in place of that of the report: for files that are the same whenever they are made.
    """
    with start_layout(html) as layout:
        layout.finish(path, files, options, progress, moment)


def list_problems(results: Results) -> list[Problem]:
    """Return what concerns the PDF alone: characters that it cannot show, a workbook that it cannot hold."""
    missing = glyphs.list_missing(results)
    nowhere = find_nowhere("".join(sorted({sign for one in missing for sign in one.characters})))
    found = glyphs.describe(missing, nowhere)
    if "workbook" in results.series:
        return found
    message = fill("{name} is not attached to the PDF: the results hold no copy of it.",
                   name=results.provenance.workbook)  # fmt: skip
    return [Problem("warning", "", "", message), *found]


def find_weasyprint() -> str:
    """Return the version of WeasyPrint; raises PdfUnavailableError with how to fix it where it cannot be loaded."""
    with start_layout("") as layout:
        return layout.finish(None).strip()


def fix() -> str:
    """Return how to install the native libraries on this system."""
    if sys.platform == "darwin":
        found = "export DYLD_FALLBACK_LIBRARY_PATH=/opt/homebrew/lib (on Intel /usr/local/lib)"
        return f"Install them: brew install pango. If they are not found then: {found}"
    if sys.platform == "win32":
        return "Install MSYS2, then in its UCRT64 shell: pacman -S mingw-w64-ucrt-x86_64-pango"
    return f"Install them: {DEBIAN} (Debian, Ubuntu), or the packages of Pango of your system."


def attach(name: str, relationship: str, description: str, data: bytes) -> Attached:
    """Return a file as it is attached to a PDF; `relationship` is one of PDF/A-3's."""
    kind = _KINDS.get(Path(name).suffix.lower(), "application/octet-stream")
    return Attached(name, kind, relationship, description, base64.b64encode(data).decode())


# ---------------------------------------------------------------- the process that lays it out


@dataclass(frozen=True, slots=True)
class Layout:
    """A page that `pdf_layout` lays out in its process while other work goes on."""

    process: "subprocess.Popen[bytes]"
    printed: IO[bytes]
    errors: IO[bytes]

    def finish(
        self,
        path: Path | None,
        files: Sequence[Attached] = (),
        options: ReportOptions | None = None,
        progress: Progress = SILENT,
        moment: datetime | None = None,
    ) -> str:
        """Have the PDF written, without `options` a plain one; return what was printed. Raises as `finish_pdf` does."""
        job = {
            "path": str(path),
            "variant": options and ("pdf/ua-1" if options.accessible else "pdf/a-3u"),
            "time": (moment or report_time()).isoformat(),
            "attachments": [asdict(file) for file in files],
        }
        with private_folder("assess-page-") as folder:
            rest = folder / "job.json"
            rest.write_text(json.dumps(job), encoding="utf-8")
            self.send(f"{rest}\n")
            while True:
                progress.check()
                with contextlib.suppress(subprocess.TimeoutExpired):
                    self.process.wait(ASKED_EVERY)
                    break
        for file in (self.printed, self.errors):
            file.seek(0)
        answer, reason = (file.read().decode("utf-8", "replace") for file in (self.printed, self.errors))
        lines = reason.strip().splitlines() or ["no reason is given"]
        if self.process.returncode == MISSING:
            raise PdfUnavailableError(f"the PDF was not written: a native library is missing ({lines[-1]}). {fix()}")
        if self.process.returncode == UNWRITTEN:
            raise OSError(*json.loads(lines[-1]))
        if self.process.returncode:
            raise AssessError(f"the PDF could not be laid out: {lines[-1]}")
        return answer

    def send(self, text: str) -> None:
        """Send a line to the process; where that has ended already, `finish` says why."""
        with contextlib.suppress(OSError):
            if self.process.stdin:
                self.process.stdin.write(text.encode())
                self.process.stdin.flush()


@contextlib.contextmanager
def start_layout(html: str) -> Iterator[Layout]:
    """Begin to lay out a page in a process, which is killed at the end; of an empty one the version is asked for."""
    from assess.report.pages import pdf_layout

    code = f"import sys, runpy; sys.path[:] = {sys.path!r}; runpy.run_path({pdf_layout.__file__!r})['main']()"
    with tempfile.TemporaryFile() as printed, tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(  # noqa: S603 - this Python with the same folders of modules, and its own code
            [sys.executable, "-W", "ignore", "-c", code], stdin=subprocess.PIPE, stdout=printed, stderr=errors,
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )  # fmt: skip
        layout = Layout(process, printed, errors)
        try:
            page = {"html": replace_signs(html, find_nowhere(find_missing(html))), "fonts": print_fonts()}
            layout.send(json.dumps(page if html else None) + "\n")
            yield layout
        finally:
            process.kill()
            process.communicate()
