"""compare.html and compare.pdf: one template with the style of the reports; nothing fetched, every text escaped."""

from pathlib import Path
from typing import Any

from assess.compare import comparison_view as say
from assess.compare.changes import Direction
from assess.compare.comparison_view import View
from assess.compare.past_run import PastPiece
from assess.i18n import LANGUAGES, number
from assess.i18n import gettext as _
from assess.progress import SILENT, Progress
from assess.report import words
from assess.report.pages.html import build_style
from assess.report.pages.pdf import attach, print_page
from assess.report.report_options import ReportOptions
from assess.report.templates import render_template
from assess.version import __version__

TEMPLATE, STYLE = "compare.html.j2", "compare.css"
MOST_ROWS, MOST_PRINTED, MOST_STATES = 5000, 300, 300
"""Rows of pieces on a screen and on paper, and rows of routes and of rooms; the Excel file has all."""


def write_print(view: View, path: Path, data: Path, options: ReportOptions, progress: Progress = SILENT) -> None:
    """Write compare.pdf, which carries the file `data`; raises what `assess.report.pages.pdf.write_pdf` does."""
    html = render_comparison(view, options, for_print=True, progress=progress)
    files = [attach(data.name, "Data", _("The comparison, for other programs"), data.read_bytes())]
    print_page(html, path, files, options, progress)


def render_comparison(
    view: View, options: ReportOptions, *, for_print: bool = False, progress: Progress = SILENT
) -> str:
    """Return the page in the language in use (see `ReportOptions.spoken`)."""
    context = progress.wait_for(lambda: _build_context(view, options, for_print=for_print))
    return render_template(TEMPLATE, options, context, progress, filters=FILTERS)


def _build_context(view: View, options: ReportOptions, *, for_print: bool) -> dict[str, Any]:
    changed = view.list_changed()
    authors = [str(view.after.building.get(name) or "") for name in ("prepared_by", "organisation")]
    return {
        "view": view,
        "language": options.language or LANGUAGES[0],
        "for_print": for_print,
        "version": __version__,
        "author": ", ".join(filter(None, authors)),
        "style": build_style(options, for_print, STYLE),
        "warnings": view.list_warnings(),
        "worse": view.list_worse(),
        "others": view.list_others(),
        "tiles": view.list_tiles(),
        "counts": view.list_counts(),
        "route_counts": view.list_route_counts(),
        "matrix": view.build_matrix(),
        "changed": changed,
        "unchanged": len(view.found.pieces) - len(changed),
        "routes": [one for one in view.found.routes if one.direction != Direction.SAME],
        "rooms": [one for one in view.found.rooms if one.direction != Direction.SAME],
        "facts": view.list_facts(),
        "basis_before": view.bases["before"],
        "basis_after": view.bases["after"],
        "most_rows": MOST_PRINTED if for_print else MOST_ROWS,
        "most_states": MOST_STATES,
    }


def _say_adopted(piece: PastPiece) -> str:
    """Return the chance of a piece; of an anchored one that it is the chance if it stood free."""
    chance = say.say_chance(piece.chance)
    return _("free-standing: {chance}", chance=chance) if piece.is_held else chance


FILTERS = {
    "cut": words.cut,
    "in_share": lambda count: number(count, ",d") if count else words.DASH,
    "in_whole": lambda value: number(value, ",d"),
    "say_adopted": _say_adopted,
    "say_chance": say.say_chance,
    "say_direction": say.say_direction,
    "say_inputs": say.say_inputs,
    "standing_label": say.label_standing,
    "standing_style": say.style_standing,
    "state_name": say.name_state,
    "tone": say.find_tone,
}
"""Filters of the template besides those of the reports."""
