"""The summary of a city as PDF: the answer, the map, what to start with, what is not in it, method and references."""

from collections.abc import Sequence
from typing import Any

from assess.delivery.private_folder import private_folder
from assess.environment import find_source_date
from assess.i18n import gettext as _
from assess.portfolio.background import Background
from assess.portfolio.city_content import build_content
from assess.portfolio.city_map import Isoline
from assess.portfolio.city_page import STYLE, build_context
from assess.portfolio.city_totals import CityView
from assess.progress import SILENT, Progress
from assess.report.pages.html import build_style
from assess.report.pages.pdf import print_page
from assess.report.report_options import ReportOptions
from assess.report.templates import render_template
from assess.workbook.template import CREATED

TEMPLATE = "city_summary.html.j2"
MOST_SKIPPED = 12
"""Skipped buildings that the summary names; the ranking names all."""


def render_summary(
    view: CityView,
    background: Background | None = None,
    *,
    options: ReportOptions | None = None,
    isolines: Sequence[Isoline] = (),
    progress: Progress = SILENT,
) -> bytes:
    """Return the summary of a city as PDF/A-3u, or PDF/UA-1 where the options ask for it.

    Its date is SOURCE_DATE_EPOCH or a fixed one: the same tables give the same bytes.

    Raises
    ------
    PdfUnavailableError
        If WeasyPrint's native libraries are missing.
    InputError
        If a template cannot be used.
    CancelledError
        If the work was cancelled.
    """
    options = options or ReportOptions()
    with options.spoken(), private_folder("assess-page-") as folder:
        html = progress.wait_for(lambda: _render(view, background, isolines, options))
        path = folder / "city.pdf"
        print_page(html, path, (), options, progress, moment=find_source_date() or CREATED)
        return path.read_bytes()


def _render(view: CityView, background: Background | None, isolines: Sequence[Isoline], options: ReportOptions) -> str:
    content = build_content(view)
    context: dict[str, Any] = build_context(content, background, isolines, options, is_live=False)
    context |= {
        "for_print": True,
        "style": build_style(options, True, STYLE),
        "most_skipped": MOST_SKIPPED,
        "building_heads": [_("Building"), _("Share expected to fall"), _("Expected falls"),
                           _("People on blocked routes"), _("Routes blocked")],
    }  # fmt: skip
    return render_template(TEMPLATE, options, context)
