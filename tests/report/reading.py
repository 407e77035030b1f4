"""Reports as tests read them: written as a user would have them written, and their text without markup."""

import html
import re
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from copy import copy
from dataclasses import replace
from pathlib import Path
from typing import Any

import pypdfium2
import pytest

import assess
from assess.progress import SILENT, Progress
from assess.report.content import Content
from assess.report.data import write_json
from assess.report.figures import math_figures, motion_figures, risk_map
from assess.report.figures.math_figures import MathFigure
from assess.report.figures.plan import Plan, build_plan
from assess.report.figures.ways import build_stretches
from assess.report.fonts import print_fonts
from assess.report.pages import html as pages
from assess.report.pages.pdf import finish_pdf, start_pdf
from assess.report.pages.pdf_layout import open_page
from assess.report.report_options import ReportOptions
from assess.report.view import Edition
from assess.results import ItemResult, Results


@contextmanager
def no_figures() -> Iterator[None]:
    """Leave figures out of pages, which take most of the time: they have empty pictures in their places."""
    with pytest.MonkeyPatch.context() as patch:
        for module in (motion_figures, risk_map):
            patch.setattr(module, "draw", lambda *_, **__: b"")
        yield


def leave_room(tex: str) -> MathFigure:
    """Return an equation without its letters, whose drawing takes half the time of a PDF."""
    return replace(math_figures.draw_math(tex), letters={}, placed="")


def changed(one: ItemResult, **values: Any) -> ItemResult:
    """Return a piece with other values of what is worked out of it."""
    other = copy(one)
    vars(other).update(values)
    return other


def write_html(results: Results, folder: Path, *, figures: bool = False) -> str:
    with nullcontext() if figures else no_figures():
        return assess.write_reports(results, folder, ("html",))["html"].read_text(encoding="utf-8")


def render(
    results: Results, options: ReportOptions | None = None, *, for_print: bool = False, edition: Edition = "all"
) -> str:
    """Return the HTML of a report in its language; with `for_print` as the PDF is laid out from it, with figures."""
    options = options or ReportOptions(language=results.provenance.language)
    with options.spoken(), nullcontext() if for_print else no_figures():
        return pages.render(Content(results), options, for_print=for_print, edition=edition)


def write_pdf(
    content: Content, path: Path, options: ReportOptions, progress: Progress = SILENT, *, edition: Edition = "client"
) -> None:
    """Write one PDF as a run does, with results.json beside it."""
    data = path.with_name("results.json")
    write_json(content.run, data)
    with start_pdf(content, options, progress, edition=edition) as layout:
        finish_pdf(layout, content.run, path, options, progress, data)


def lay_out(page: str) -> list[Any]:
    """Return the boxes of the pages of a report that was rendered for print."""
    return [one._page_box for one in open_page(page, print_fonts()).render().pages]


def read_pages(path: Path) -> list[str]:
    """Return the texts of the pages of a PDF, with single spaces."""
    return [" ".join(page.get_textpage().get_text_range().split()) for page in pypdfium2.PdfDocument(path)]


def plans_of(results: Results) -> list[Plan | None]:
    """Return the plan of each floor as the report draws it; None where it has none."""
    ways = build_stretches(results.route_tables)
    return [build_plan(page, results, ways.get(page.floor.floor, ())) for page in Content(results).floors]


def read_text(page: str) -> str:
    """Return what a reader of HTML sees, with single spaces; no-break spaces count as spaces."""
    page = re.sub(r"<(style|script|template).*?</\1>", " ", page, flags=re.DOTALL)
    text = html.unescape(re.sub(r"<[^>]+>", " ", page))
    return re.sub(r" (?=[,.;:)])", "", " ".join(text.split()))
