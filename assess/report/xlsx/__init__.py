"""The Excel report: live formulas, so that an edited PFA, size or class limit recomputes classes and counts.

A simulated class holds until one of its inputs is edited; then the row says that assess is to be run again.

Sheets are written row by row and in little memory. Every text of the workbook goes in as text. Names of sheets,
headings and the words that formulas compare are in the language in use; formulas find columns by keys.
"""

import datetime
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from assess.i18n import fill
from assess.i18n import gettext as _
from assess.progress import SILENT, Progress
from assess.report import words
from assess.report.content import Content, report_date
from assess.report.say.ground import name_source
from assess.report.say.simulation import say_scenario
from assess.report.xlsx import floors_sheet, items_sheet, list_sheets, route_sheets, summary_sheet, work_sheet
from assess.report.xlsx.pen import Pen, write_sheets
from assess.results import Results
from assess.workbook.formulas import write_plainly

Write = Callable[[Pen, Any, Content], object]
IsThere = Callable[[Content], bool]


def _always(_content: Content) -> bool:
    return True


def _listing(find: Callable[[Content], list_sheets.Listing]) -> Write:
    return lambda pen, page, content: pen.listing(page, *find(content))


SHEETS: tuple[tuple[str, Write, IsThere], ...] = (
    (fill("Summary"), summary_sheet.write_summary, _always),
    (fill("Work list"), work_sheet.write_work, _always),
    (fill("Floors"), floors_sheet.write_floors, _always),
    (fill("Items"), items_sheet.write_items, _always),
    (fill("Motions"), _listing(list_sheets.list_motions), _always),
    (fill("Verification"), _listing(list_sheets.list_fits), lambda content: content.run.has_simulated),
    (fill("Routes"), route_sheets.write_routes, _always),
    (fill("Route pieces"), route_sheets.write_route_pieces, route_sheets.has_pieces),
    (fill("Route rooms"), route_sheets.write_route_rooms, lambda content: bool(content.run.route_tables.rooms)),
    (fill("Annual"), list_sheets.write_annual, lambda content: content.annual is not None),
    (fill("Methods"), _listing(list_sheets.list_methods), _always),
    (fill("Assumptions"), list_sheets.write_assumptions, _always),
    (fill("Quality log"), _listing(list_sheets.list_quality), _always),
    (fill("Notes"), _listing(list_sheets.list_notes), lambda content: bool(list_sheets.list_notes(content)[1])),
)
"""The sheets in order: title in English, what writes each, and whether it is there, as it is left out if empty."""


def write_xlsx(content: Content, path: Path, progress: Progress = SILENT) -> None:
    """Write report.xlsx in the language in use, as `assess.report.xlsx.pen.write_sheets` does."""

    def write_own(write: Write, pen: Pen, page: Any) -> None:
        write_plainly(page)
        write(pen, page, content)

    write_sheets(
        path,
        [(str(one), _(one), partial(write_own, write)) for one, write, is_there in SHEETS if is_there(content)],
        title=_("Furniture in earthquakes: {title}", title=content.title[:200]),
        created=datetime.datetime.fromisoformat(report_date()),
        texts=(words.cut(content.title, 80), _say_conditions(content.run), say_scenario(content.run).rstrip(".")),
        progress=progress,
    )


def _say_conditions(run: Results) -> str:
    """Return what holds for all numbers, shortly: it stands above every printed page."""
    settings, texts = run.settings, []
    if run.provenance.shaking:
        texts.append(_("assumed shaking, {intensity}", intensity=run.provenance.shaking.name))
    if run.provenance.site_ground:
        texts.append(name_source(run.provenance.site_ground))
    if settings.scale != 1:
        texts.append(_("motion × {scale:g}", scale=settings.scale))
    if settings.ideal:
        texts.append(_("if exactly this motion recurred"))
    return ", ".join(texts)
