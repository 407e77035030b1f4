"""Reports as tests read them: written as a user would have them written, and their text without markup."""

import html
import re
from pathlib import Path
from typing import Any

import assess
from assess.report.content import build_content
from assess.report.fonts import print_fonts
from assess.report.pages import html as pages
from assess.report.pages.editions import Edition
from assess.report.pages.pdf_layout import open_page
from assess.report.report_options import ReportOptions
from assess.results import Results


def write_html(results: Results, folder: Path, options: ReportOptions | None = None) -> str:
    """Write the HTML report and return it."""
    return assess.write_reports(results, folder, ("html",), options)["html"].read_text(encoding="utf-8")


def render(
    results: Results, options: ReportOptions | None = None, *, for_print: bool = False, edition: Edition = "all"
) -> str:
    """Return the HTML of a report in its language, with `for_print` as the PDF is laid out from it."""
    options = options or ReportOptions(language=results.provenance.language)
    with options.spoken():
        return pages.render(build_content(results), options, for_print=for_print, edition=edition)


def lay_out(page: str) -> list[Any]:
    """Return the boxes of the pages of a report that was rendered for print."""
    return [one._page_box for one in open_page(page, print_fonts()).render().pages]


def read_text(page: str) -> str:
    """Return what a reader of HTML sees, with single spaces; no-break spaces count as spaces."""
    page = re.sub(r"<(style|script|template).*?</\1>", " ", page, flags=re.DOTALL)
    text = html.unescape(re.sub(r"<[^>]+>", " ", page))
    return re.sub(r" (?=[,.;:)])", "", " ".join(text.split()))
