"""The PDF report: the HTML with print.css, laid out by WeasyPrint."""

import contextlib
import io
import logging
import sys
from pathlib import Path
from typing import Any

from assess.errors import PdfUnavailableError
from assess.report.html import render
from assess.report.look import Look
from assess.results import Assessment

DEBIAN = "apt install libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0"


def write_pdf(assessment: Assessment, path: Path, look: Look) -> None:
    """Write report.pdf.

    Raises
    ------
    PdfUnavailableError
        If WeasyPrint's native libraries are missing.
    """
    weasyprint = load_weasyprint()
    html = render(assessment, look, for_print=True)
    document = weasyprint.HTML(string=html, url_fetcher=_closed_fetcher())
    document.write_pdf(path, pdf_tags=True)


def load_weasyprint() -> Any:
    """Return the module weasyprint; raises PdfUnavailableError with the mend where its libraries are missing."""
    logging.getLogger("weasyprint").addHandler(logging.NullHandler())
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # it prints a page of advice where a library is missing
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
