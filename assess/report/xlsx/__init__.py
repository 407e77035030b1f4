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

from assess.i18n import fill, gettext as _
from assess.progress import SILENT, Progress
from assess.report import words
from assess.report.content import Content, report_date
from assess.report.say.ground import name_source
from assess.report.say.route import list_unfixable
from assess.report.say.simulation import say_scenario
from assess.report.xlsx import (
    floors_sheet,
    form_sheets,
    items_sheet,
    list_sheets,
    route_sheets,
    summary_sheet,
    work_sheet,
)
from assess.report.xlsx.pen import Pen, write_sheets

SHEETS: tuple[tuple[str, Callable[[Pen, Any, Content], None], Callable[[Content], bool] | None], ...] = (
    (fill("Summary"), summary_sheet.write_summary, None),
    (fill("Work list"), work_sheet.write_work, None),
    (fill("Floors"), floors_sheet.write_floors, None),
    (fill("Items"), items_sheet.write_items, None),
    (fill("Motions"), list_sheets.write_motions, None),
    (fill("Verification"), list_sheets.write_fits, lambda content: content.run.has_simulated),
    (fill("Routes"), route_sheets.write_routes, None),
    (fill("Route pieces"), route_sheets.write_route_pieces, lambda content: bool(
        list_unfixable(content.run.route_tables) or any(one.pieces for one in content.run.route_tables.segments))),
    (fill("Route rooms"), route_sheets.write_route_rooms, lambda content: bool(content.run.route_tables.rooms)),
    (fill("FEMA E-74"), form_sheets.write_e74, lambda content: bool(content.results)),
    (fill("Tokyo 21 items"), form_sheets.write_tokyo, lambda content: bool(content.results)),
    (fill("Annual"), list_sheets.write_annual, lambda content: content.annual is not None),
    (fill("Methods"), list_sheets.write_methods, None),
    (fill("Assumptions"), list_sheets.write_assumptions, None),
    (fill("Quality log"), list_sheets.write_quality, None),
    (fill("Notes"), list_sheets.write_notes, lambda content: any(
        (*(one.item.notes for one in content.results), *(one.notes for one in content.run.route_tables.segments)))),
)  # fmt: skip
"""The sheets in order: title in English, what writes each, and whether it is there (None: always)."""


def write_xlsx(content: Content, path: Path, progress: Progress = SILENT) -> None:
    """Write report.xlsx in the language in use, as `assess.report.xlsx.pen.write_sheets` does."""
    run, conditions = content.run, list[str]()
    if run.provenance.shaking:
        conditions.append(_("assumed shaking, {intensity}", intensity=run.provenance.shaking.name))
    if run.provenance.site_ground:
        conditions.append(name_source(run.provenance.site_ground))
    if run.settings.scale != 1:
        conditions.append(_("motion × {scale:g}", scale=run.settings.scale))
    if run.settings.ideal:
        conditions.append(_("if exactly this motion recurred"))
    sheets = [(title, write) for title, write, is_there in SHEETS if is_there is None or is_there(content)]
    write_sheets(
        path,
        [
            (str(title), _(title), partial(lambda write, pen, page: write(pen, page, content), write))
            for title, write in sheets
        ],
        title=_("Furniture in earthquakes: {title}", title=content.title[:200]),
        created=datetime.datetime.fromisoformat(report_date()),
        texts=(words.cut(content.title, 80), ", ".join(conditions), say_scenario(run).rstrip(".")),
        progress=progress,
        report_of=run.provenance.workbook,
    )
