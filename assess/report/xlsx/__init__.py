"""The Excel report: live formulas, so that an edited PFA, size or class limit recomputes classes and counts.

A verified class holds until one of its inputs is edited; then it says that it is void.

Sheets are written row by row and in little memory. Every text of the workbook goes in as text.
"""

import datetime
from collections.abc import Callable
from pathlib import Path
from typing import Any

import xlsxwriter

from assess.inventory.live import write_plainly
from assess.inventory.writer import write_book
from assess.report.content import Content, build_content
from assess.report.look import Look
from assess.report.xlsx import floors, items, sheets, summary, verification
from assess.report.xlsx.pen import Pen
from assess.results import Assessment

SHEETS: dict[str, Callable[[Pen, Any, Content], None]] = {
    "Summary": summary.write_summary,
    "Fix first": summary.write_fix_first,
    "Floors": floors.write_floors,
    "Items": items.write_items,
    "Motions": sheets.write_motions,
    "Verification": verification.write_verification,
    "Routes": sheets.write_routes,
    "Methods": sheets.write_methods,
    "Assumptions": sheets.write_assumptions,
    "Notes": sheets.write_notes,
}
"""The sheets in order, and the function that writes each; Verification is left out where no piece was verified."""


def write_xlsx(assessment: Assessment, path: Path, look: Look | None = None) -> None:
    """Write report.xlsx in the language in use: see `Look.spoken`.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    content = build_content(assessment)

    def fill(book: xlsxwriter.Workbook) -> None:
        created = datetime.datetime.fromisoformat(content.date)
        book.set_properties({"title": "Furniture in earthquakes: report", "created": created})
        _write_sheets(Pen(book), content)

    write_book(path, fill, by_row=True)


def _write_sheets(pen: Pen, content: Content) -> None:
    shown = [name for name in SHEETS if name != "Verification" or content.assessment.joints]
    pages = {name: pen.book.add_worksheet(name) for name in shown}
    for row, name in enumerate(sheets.NAMES, 2):
        pen.book.define_name(name, f"=Assumptions!$B${row}")
    for name, page in pages.items():
        write_plainly(page)
        page.set_landscape()
        page.set_paper(9)
        page.fit_to_pages(1, 0)
        page.set_footer("&L&8Chance of overturning in this scenario, not per year&C&8&A&R&8Page &P of &N")
        SHEETS[name](pen, page, content)
