"""The PDF report: the HTML with print.css, laid out by WeasyPrint; its source and its data are attached to it."""

import base64
import contextlib
import datetime
import io
import logging
import sys
import warnings
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from assess.errors import PdfUnavailableError, Problem
from assess.report.look import Look
from assess.report.pages import glyphs
from assess.report.pages.attached import Attached, list_attached, list_unattached
from assess.report.pages.fonts import font_faces
from assess.report.pages.html import render
from assess.report.provenance import report_time
from assess.results import Assessment

DEBIAN = "apt install libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0"
ARCHIVAL, ACCESSIBLE = "pdf/a-3u", "pdf/ua-1"


def write_pdf(assessment: Assessment, path: Path, look: Look) -> None:
    """Write report.pdf: PDF/A-3u, or PDF/UA-1 where the look is to be accessible.

    Raises
    ------
    PdfUnavailableError
        If WeasyPrint's native libraries are missing.
    """
    weasyprint = load_weasyprint()
    moment, problems = report_time(), list_problems(assessment)
    told = replace(assessment, problems=(*assessment.problems, *problems)) if problems else assessment
    html = render(told, look, for_print=True)
    html = glyphs.replace(html, _find_nowhere(glyphs.find_missing(html)))
    document = weasyprint.HTML(string=html, url_fetcher=_closed_fetcher()).render()
    document.metadata.created = document.metadata.modified = f"{moment:%Y-%m-%dT%H:%M:%SZ}"
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "unclosed file .*icc", ResourceWarning)  # WeasyPrint's own profile of colours
        document.write_pdf(
            path,
            pdf_variant=ACCESSIBLE if look.accessible else ARCHIVAL,
            pdf_tags=True,
            attachments=[_attachment(file, moment) for file in list_attached(assessment)],
        )


def list_problems(assessment: Assessment) -> list[Problem]:
    """Return what is to be told of the PDF alone: characters that it cannot show, a workbook that it cannot hold."""
    missing = glyphs.list_missing(assessment.inventory)
    nowhere = _find_nowhere("".join(sorted({sign for one in missing for sign in one.characters})))
    return [*list_unattached(assessment.inventory), *glyphs.describe(missing, nowhere)]


def load_weasyprint() -> Any:
    """Return the module weasyprint; raises PdfUnavailableError with the mend where its libraries are missing."""
    logging.getLogger("weasyprint").addHandler(logging.NullHandler())
    try:
        with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):  # advice where a library is missing
            warnings.filterwarnings("ignore", ".*FontConfig")  # a machine without fonts: the report brings its own
            import weasyprint
    except (ImportError, OSError) as error:
        reason = str(error).splitlines()[0]
        raise PdfUnavailableError(
            f"the PDF was not written: a native library is missing ({reason}). {mend()}"
        ) from None
    return weasyprint


def mend() -> str:
    """Return how to install the native libraries on this system."""
    if sys.platform == "darwin":
        found = "export DYLD_FALLBACK_LIBRARY_PATH=$(brew --prefix)/lib"
        return f"Install them: brew install pango. If they are not found then: {found}"
    if sys.platform == "win32":
        return "Install MSYS2, then in its UCRT64 shell: pacman -S mingw-w64-ucrt-x86_64-pango"
    return f"Install them: {DEBIAN} (Debian, Ubuntu), or the packages of Pango of your system."


def _closed_fetcher() -> Any:
    """Return a fetcher that opens data: URIs and nothing else: a report never reads the network or the disk."""
    from weasyprint.urls import URLFetcher

    return URLFetcher(allowed_protocols={"data"}, allow_redirects=False, fail_on_errors=True)


def _attachment(file: Attached, moment: datetime.datetime) -> Any:
    """Return an attachment of WeasyPrint; as a data: URI, so that it takes our media type, not the system's guess."""
    from weasyprint import Attachment

    return Attachment(
        url=f"data:{file.kind};base64,{base64.b64encode(file.data).decode()}",
        url_fetcher=_closed_fetcher(),
        name=file.name,
        description=file.description,
        relationship=file.relationship,
        created=moment,
        modified=moment,
    )


@cache
def _find_nowhere(characters: str) -> frozenset[str]:
    """Return those of some characters that no font of this machine holds: WeasyPrint says so of a page of them."""
    if not characters:
        return frozenset()
    try:
        weasyprint = load_weasyprint()
    except PdfUnavailableError:  # no PDF, nothing to show
        return frozenset()
    style = f"{font_faces()} p {{ font-family: Report, sans-serif; }}"
    page = f"<style>{style}</style><p>{' '.join(f'&#{ord(sign)};' for sign in characters)}</p>"
    log = _Log()
    logging.getLogger("weasyprint").addHandler(log)
    try:
        weasyprint.HTML(string=page, url_fetcher=_closed_fetcher()).write_pdf()
    finally:
        logging.getLogger("weasyprint").removeHandler(log)
    return frozenset(sign for sign in characters if any(f"(U+{ord(sign):04X})" in line for line in log.lines))


class _Log(logging.Handler):
    """Keeps what is logged."""

    def __init__(self) -> None:
        super().__init__()
        self.lines: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.lines.append(record.getMessage())
