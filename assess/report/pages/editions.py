"""The editions of a report: the sections that each shows, in its order.

A section is a file in templates/sections, whose name is its anchor as well. The client's edition is what a manager acts
on, the annex what it rests on; the page for a screen has both, the answer first.
"""

from collections.abc import Mapping, Sequence
from typing import Literal

from assess.i18n import gettext as _
from assess.report.content import Content
from assess.report.report_options import ReportOptions

Edition = Literal["client", "annex", "all"]
SECTIONS: Mapping[Edition, Sequence[str]] = {
    "client": ("summary", "schedule", "routes", "floors", "pieces", "approach", "limits", "assumptions"),
    "annex": (
        "motions", "annual", "verification", "contours", "methods", "assumptions", "quality", "references", "appendix",
        "routes_detail", "items", "comparison", "lists",
    ),
    "all": (
        "summary", "schedule", "routes", "floors", "items", "motions", "annual", "approach", "comparison",
        "routes_detail", "verification", "contours", "methods", "limits", "assumptions", "quality", "references",
        "appendix", "lists", "about",
    ),
}  # fmt: skip
"""Every section of each edition. The pieces of the client's edition are grouped; elsewhere each has a row. The annex
ends with the wide tables, so that its pages turn once."""
MOST_ASSUMPTIONS = 36
"""Assumptions that the client's edition has room for on a page; where there are more, the annex has all."""


def list_parts(
    edition: Edition, content: Content, options: ReportOptions, *, is_compact: bool
) -> list[tuple[str, str]]:
    """Return the sections of an edition as they are shown: anchor, which is the name of the file, and heading.

    Left out is what a run has nothing on, and a section without a template.

    Parameters
    ----------
    edition : {"client", "annex", "all"}
        Which sections.
    content : Content
        What they show.
    options : ReportOptions
        Where the templates are.
    is_compact : bool
        Whether the pieces have an appendix of lines.
    """
    headings = _headings()
    left_out = {
        "annual": content.annual is None,
        "contours": "contours/items" not in content.run.series,
        "lists": not is_compact,
        "pieces": not content.results,
        "schedule": not content.results,
        "routes_detail": not content.run.has_routes,
        "assumptions": edition == "annex" and len(content.assumptions) <= MOST_ASSUMPTIONS,
    }
    folders = [folder / "sections" for folder in options.folders]
    there = [name for name in SECTIONS[edition] if any((one / f"{name}.html.j2").is_file() for one in folders)]
    return [(name, headings[name]) for name in there if not left_out.get(name)]


def _headings() -> Mapping[str, str]:
    return {
        "summary": _("Summary"),
        "schedule": _("What to fix"),
        "routes": _("Evacuation routes"),
        "floors": _("Floors"),
        "pieces": _("Pieces"),
        "approach": _("How the chances were computed"),
        "limits": _("Limits of the methods"),
        "assumptions": _("Assumptions and defaults"),
        "motions": _("Motion of the floors"),
        "items": _("All pieces"),
        "comparison": _("Comparison of the methods"),
        "routes_detail": _("Evacuation routes in detail"),
        "verification": _("Verification"),
        "contours": _("Risk over breadth and acceleration"),
        "annual": _("Chances a year"),
        "methods": _("Methods"),
        "quality": _("Data-quality log"),
        "references": _("References"),
        "appendix": _("Appendix"),
        "lists": _("Appendix: all pieces"),
        "about": _("About this report"),
    }
