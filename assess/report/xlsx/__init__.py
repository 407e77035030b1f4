"""The Excel report: live formulas, so that an edited PFA, size or class limit recomputes classes and counts.

A verified class holds until one of its inputs is edited; then it says that it is void.

Sheets are written row by row and in little memory. Every text of the workbook goes in as text. Names of sheets,
headings and the words that formulas compare are in the language in use; formulas find columns by keys.
"""

import datetime
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import xlsxwriter

from assess.inventory.live import write_plainly
from assess.inventory.writer import write_book
from assess.language import gettext as _
from assess.report.content import Content, build_content, report_date
from assess.report.look import Look
from assess.report.xlsx import (
    floors,
    items,
    method,
    quality,
    route_pieces,
    route_rooms,
    routes,
    sheets,
    summary,
    verification,
    worst,
)
from assess.report.xlsx.pen import Pen
from assess.report.xlsx.printing import set_print
from assess.report.xlsx.said import name_sheets
from assess.results import Assessment

SHEETS: Mapping[str, Callable[[Pen, Any, Content], None]] = {
    "Summary": summary.write_summary,
    "Fix first": worst.write_fix_first,
    "Floors": floors.write_floors,
    "Items": items.write_items,
    "Motions": sheets.write_motions,
    "Verification": verification.write_verification,
    "Routes": routes.write_routes,
    "Route pieces": route_pieces.write_route_pieces,
    "Route rooms": route_rooms.write_route_rooms,
    "Methods": method.write_methods,
    "Assumptions": method.write_assumptions,
    "Quality log": quality.write_quality,
    "Notes": quality.write_notes,
}
"""The keys of the sheets in order, and the function that writes each."""


def write_xlsx(assessment: Assessment, path: Path, look: Look | None = None) -> None:
    """Write report.xlsx in the language in use: see `Look.spoken`.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    content = build_content(assessment)

    def fill(book: xlsxwriter.Workbook) -> None:
        created = datetime.datetime.fromisoformat(report_date())
        title = _("Furniture in earthquakes: {title}", title=content.title[:200])
        book.set_properties({"title": title, "created": created})
        _write_sheets(Pen(book, _names(content)), content)

    write_book(path, fill, by_row=True)


def _names(content: Content) -> dict[str, str]:
    """Return the names of the sheets by their keys; some are left out where they would be empty."""
    titles = {
        "Summary": _("Summary"),
        "Fix first": _("Fix first"),
        "Floors": _("Floors"),
        "Items": _("Items"),
        "Motions": _("Motions"),
        "Verification": _("Verification"),
        "Routes": _("Routes"),
        "Route pieces": _("Route pieces"),
        "Route rooms": _("Route rooms"),
        "Methods": _("Methods"),
        "Assumptions": _("Assumptions"),
        "Quality log": _("Quality log"),
        "Notes": _("Notes"),
    }
    there = {
        "Verification": bool(content.assessment.joints),
        "Route pieces": route_pieces.has_pieces(content),
        "Route rooms": route_rooms.has_rooms(content),
        "Notes": quality.has_notes(content),
    }
    titles = {key: title for key, title in titles.items() if there.get(key, True)}
    return name_sheets(titles)


def _write_sheets(pen: Pen, content: Content) -> None:
    pages = {key: pen.book.add_worksheet(name) for key, name in pen.sheets.items()}
    for row, name in enumerate(method.NAMES, 2):
        pen.book.define_name(name, f"={pen.refer('Assumptions')}$B${row}")
    for key, page in pages.items():
        write_plainly(page)
        set_print(page, content.title, pen.sheets[key])
        SHEETS[key](pen, page, content)
