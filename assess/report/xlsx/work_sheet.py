"""The sheet Work list: what to fix, floor by floor and room by room, to be printed and ticked off, and what it changes.

All of it is as run, but for the costs: number of pieces times unit cost, so that another unit cost can be tried.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from xlsxwriter.utility import xl_col_to_name, xl_rowcol_to_cell

from assess.details import DETAILS, WHO
from assess.i18n import gettext as _
from assess.pipeline.schedule import PHASE_RULE
from assess.report import words
from assess.report.content import Content
from assess.report.say import work as say_work
from assess.report.say.orders import Line, list_lines, say_phases
from assess.report.xlsx.pen import COUNT, Column, Pen, row_height
from assess.schedule_results import Schedule
from assess.text import natural_key

BOX = "☐"
"""To be ticked on paper."""
MONEY = "#,##0.00"
HEAD = 1
"""Row of the headings: above them stands that the list is as run."""
MARGIN = 0.4
"""Of the printed pages [in]."""
LABELS = 7
"""Columns that the labels of the table before and after take."""


def write_work(pen: Pen, page: Any, content: Content) -> None:
    """Write the work of every room, a page a floor, and below it the building before and after each phase."""
    schedule, lines = content.run.schedule, list_lines(content)
    columns = _list_columns(content)
    at = {one.key: place for place, one in enumerate(columns) if one.key}
    widths, last = [one.width for one in columns], len(columns) - 1
    for place, width in enumerate(widths):
        page.set_column(place, place, width)
    page.set_margins(left=MARGIN, right=MARGIN, top=0.75, bottom=0.75)
    page.repeat_rows(0, HEAD)
    page.freeze_panes(HEAD + 1, at["number"] + 1)
    as_run = _("As run on {date}: this list does not follow what is edited in Items and Floors. To bring it up to "
               "date, make the same changes in {file} and run it again.", date=content.date,
               file=content.run.provenance.workbook)  # fmt: skip
    pen.paragraph(page, 0, as_run, widths)
    pen.heads(page, [one.label for one in columns], widths, HEAD)
    if not lines:
        none = _("No free-standing piece reaches medium, and no route needs one fixed.")
        pen.put(page, HEAD + 1, 0, none)
        return
    below = HEAD + 1 + len(lines)
    page.data_validation(HEAD + 1, at["done"], below - 1, at["done"], {"validate": "list", "source": [BOX, "☑"]})
    page.autofilter(HEAD, 0, below - 1, last)
    floors = [line.work.row.floor for line in lines]
    page.set_h_pagebreaks([HEAD + 1 + row for row in range(1, len(lines)) if floors[row] != floors[row - 1]])
    for row, line in enumerate(lines, HEAD + 1):
        values = [one.read(line) for one in columns]
        page.set_row(row, row_height(values, widths))
        for place, (column, value) in enumerate(zip(columns, values, strict=True)):
            mark = f'"{say_work.LEAST}"' if line.work.row.is_least and "fixings" in column.key else ""
            style = pen.style("text", f"{column.format}{mark}", bottom=4, align=column.align)
            if column.key == "cost":
                unit = xl_rowcol_to_cell(row, at["unit_cost"])
                each = f"*{line.work.row.fixings}" if line.work.row.cost_per == "fixing" else ""
                formula = f'=IF({unit}="","",{xl_rowcol_to_cell(row, at["pieces"])}*{unit}{each})'
                page.write_formula(row, place, formula, style, "" if value is None else value)
            else:
                pen.put(page, row, place, value, style)
    page.write_string(below, at["room"], _("Sum of A and B"), pen.style("total"))
    phase = f"{xl_col_to_name(at['phase'])}{HEAD + 2}:{xl_col_to_name(at['phase'])}{below}"
    for name, code in (("pieces", COUNT), ("all_fixings", COUNT), ("cost", MONEY)):
        if name in at:
            area = f"{xl_col_to_name(at[name])}{HEAD + 2}:{xl_col_to_name(at[name])}{below}"
            read = columns[at[name]].read
            known = [value for one in lines if one.phase in ("A", "B") and (value := read(one)) is not None]
            formula = f'=SUMIFS({area},{phase},"A")+SUMIFS({area},{phase},"B")'
            page.write_formula(below, at[name], formula, pen.style("total", code), sum(known))
    texts = [*say_work.say_effect_of_all(schedule), *say_phases(lines), _(PHASE_RULE), _(say_work.CHECKS),
             _(say_work.DISAGREEMENT), *say_work.list_marks(schedule)]  # fmt: skip
    for row, text in enumerate(texts, below + 2):
        pen.paragraph(page, row, text, widths)
    _write_changes(pen, page, below + 3 + len(texts), schedule)


def _list_columns(content: Content) -> list[Column]:
    """Return the columns; together they are so wide that a page across A4 shows letters of 8 pt."""
    schedule, total = content.run.schedule, content.run.schedule.before.falls

    def photos(line: Line) -> str:
        found = (str(one.item.field("photo") or "") for one in line.work.results)
        return ", ".join(dict.fromkeys(filter(None, found)))

    currency = f" [{schedule.currency}]" if schedule.currency else ""
    costs = [
        Column(_("Unit cost") + currency, 8, lambda one: one.work.row.unit_cost, MONEY, "unit_cost"),
        Column(_("Cost") + currency, 9, lambda one: one.work.row.cost, MONEY, "cost"),
    ] if schedule.cost is not None else []  # fmt: skip
    return [
        Column(_("Done"), 6, lambda _one: BOX, key="done", align="center"),
        Column(_("No."), 5, lambda one: one.number, key="number", align="center"),
        Column(_("Phase"), 6, lambda one: one.when, key="phase", align="center"),
        Column(_("Floor"), 6, lambda one: one.work.row.floor),
        Column(_("Room"), 12, lambda one: one.work.row.room, key="room"),
        Column(_("Pieces"), 7, lambda one: one.work.row.pieces, COUNT, "pieces", align="center"),
        Column(_("Names"), 13, lambda one: ", ".join(
            words.join_runs(sorted(one.work.row.items, key=natural_key), 30))),
        Column(_("What"), 14, lambda one: one.work.described),
        Column(_("Fix with"), 15, lambda one: one.how),
        Column(_("Who may do it"), 14, lambda one: _(WHO[DETAILS[one.work.row.detail].who])),
        Column(_("Fixings each"), 8, lambda one: one.count_fixings() or None, COUNT, "fixings", align="center"),
        Column(_("Fixings in all"), 8, lambda one: one.count_fixings(in_all=True) or None, COUNT, "all_fixings",
               align="center"),
        Column(_("Pull of one fixing"), 9, lambda one: one.say_pull()),
        Column(_("What it does"), 18, lambda one: one.say_effect(total)),
        *costs,
        Column(_("Photo"), 9, photos),
        Column(_("Initials"), 8, lambda _one: ""),
        Column(_("Date"), 8, lambda _one: ""),
        Column(_("Notes"), 7, lambda _one: ""),
    ]  # fmt: skip


def _write_changes(pen: Pen, page: Any, row: int, schedule: Schedule) -> None:
    """Write the building before, and after each phase that is done; labels take the columns before the numbers."""
    phases = [one for one in schedule.phases if one.phase != "C"]
    heads = [_("Before"), *(_("After {phases}", phases=_and(phases[: at + 1])) for at in range(len(phases)))]
    states = [schedule.before, *(one.after for one in phases)]
    found = [
        {one.label: one for part in say_work.list_changes(replace(schedule, after=state)) for one in part}
        for state in states
    ]
    page.write_string(row, 0, _("Before and after"), pen.style("heading"))
    _write_change(pen, page, row + 1, "", heads, pen.style("head"))
    for at, label in enumerate(dict.fromkeys(label for own in found for label in own), row + 2):
        known = next(own[label] for own in found if label in own)
        values = [own[label].after if label in own else 0 for own in found]
        _write_change(pen, page, at, label, values, pen.style("plain", "0.00" if known.decimals else COUNT))


def _and(phases: Sequence[Any]) -> str:
    return say_work.join_names([one.phase for one in phases])


def _write_change(pen: Pen, page: Any, row: int, label: str, values: Sequence[Any], form: Any) -> None:
    wide = pen.style("text") if label else form
    page.merge_range(row, 0, row, LABELS - 1, "", wide)
    pen.put(page, row, 0, label, wide)
    if label:
        page.set_row(row, row_height([label], [50]))
    for place, value in enumerate(values):
        pen.put(page, row, LABELS + place, value, form)
