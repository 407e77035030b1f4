"""The sheet Work list: what to fix, room by room, to be printed and ticked off, and what it changes.

All of it is as run, but for the costs: number of pieces times unit cost, so that another unit cost can be tried.
"""

from dataclasses import replace
from functools import partial
from typing import Any

from xlsxwriter.utility import xl_col_to_name, xl_rowcol_to_cell

from assess.details import DETAILS
from assess.fields import schedule_fields
from assess.i18n import gettext as _
from assess.report import words
from assess.report.content import Content
from assess.report.say import work as say_work
from assess.report.xlsx.pen import COUNT, LINE, Column, Pen, count_lines, of_field, row_height, widen
from assess.schedule_results import Schedule, ScheduleRow, WorkRow
from assess.text import natural_key

BOX = "☐"
"""To be ticked on paper."""
FORCE, MONEY = "0.00", "#,##0.00"
CHANGE = 7
"""Column of the numbers of the table before and after, which are wide enough for its labels before them."""


def write_work(pen: Pen, page: Any, content: Content) -> None:
    """Write the work of every room, and below it the building before and after."""
    schedule = content.run.schedule
    works = say_work.list_work(content.fixes, [one.floor.floor for one in content.floors])
    columns = widen(_list_columns(schedule), works)
    at = {one.key: place for place, one in enumerate(columns) if one.key}
    page.fit_to_pages(1, 0)  # on A4 across, as every sheet is printed
    page.repeat_rows(0)
    page.freeze_panes(1, at["place"] + 1)
    widths = [one.width for one in columns]
    pen.heads(page, [one.label for one in columns], widths)
    if not works:
        pen.put(page, 1, 0, _("No free-standing piece reaches medium, and no route needs one fixed."))
        return
    page.data_validation(1, at["done"], len(works), at["done"], {"validate": "list", "source": [BOX, "☑"]})
    page.autofilter(0, 0, len(works), len(columns) - 1)
    for row, work in enumerate(works, 1):
        values = [one.read(work) for one in columns]
        page.set_row(row, row_height(values, widths))
        for place, (column, value) in enumerate(zip(columns, values, strict=True)):
            style = pen.style("text", column.format, bottom=4, align=column.align)
            if column.key == "cost":
                pieces, unit = (xl_rowcol_to_cell(row, at[name]) for name in ("pieces", "unit_cost"))
                each = f"*{work.row.fixings}" if work.row.cost_per == "fixing" else ""
                formula = f'=IF({unit}="","",{pieces}*{unit}{each})'
                page.write_formula(row, place, formula, style, "" if value is None else value)
            else:
                pen.put(page, row, place, value, style)
    below = len(works) + 1
    page.write_string(below, at["room"], _("Sum"), pen.style("total"))
    pieces, cost = (f"{xl_col_to_name(at[name])}2:{xl_col_to_name(at[name])}{below}" for name in ("pieces", "cost"))
    total = sum(one.row.pieces for one in works)
    page.write_formula(below, at["pieces"], f"=SUM({pieces})", pen.style("total", COUNT), total)
    costs = [work.row.cost for work in works if work.row.cost is not None]
    formula, known = f'=IF(COUNT({cost})=0,"",SUM({cost}))', sum(costs) if costs else ""
    page.write_formula(below, at["cost"], formula, pen.style("total", MONEY), known)
    texts = [
        _("This list is as run: it does not follow what is edited in Items and Floors."),
        *say_work.say_effect_of_all(schedule),
        _(say_work.ORDER),
        _(say_work.CHECKS),
        _(say_work.DISAGREEMENT),
        *say_work.list_marks(schedule),
    ]
    for row, text in enumerate(texts, below + 2):
        page.merge_range(row, 0, row, len(widths) - 1, "", pen.style("text"))
        page.set_row(row, LINE * count_lines(text, sum(widths)))
        pen.put(page, row, 0, text, pen.style("text"))
    _write_changes(pen, page, row + 2, schedule)


def _list_columns(schedule: Schedule) -> list[Column]:
    def of_entry(name: str, width: int, *, only_first: bool = False, align: str = "") -> Column:
        """Return a column of the whole entry, which stands with the most urgent part of it alone if `only_first`."""
        field = schedule_fields(ScheduleRow)[name]
        return of_field(field, key=name, width=width, align=align, read=lambda one: (
            field.read(one.entry.row) if one.is_first or not only_first else None))  # fmt: skip

    own = {
        name: of_field(field, key=name, read=partial(lambda field, one: field.read(one.row), field),
                       format=MONEY if name in ("unit_cost", "cost") else field.format)
        for name, field in schedule_fields(WorkRow).items()
    }  # fmt: skip
    screening = _(say_work.SCREENING)
    has_code = any(work.tension_code_kn is not None for row in schedule.rows for work in row.works)
    forces = ["tension_kn", "tension_high_kn", *(["tension_code_kn"] if has_code else []), "shear_kn"]
    return [
        Column(_("Done"), 6, lambda _one: BOX, key="done", align="center"),
        of_entry("place", 5, align="center"),
        replace(own["floor"], width=6),
        replace(own["room"], width=12),
        replace(own["pieces"], align="center"),
        Column(_("Names"), 14, lambda one: ", ".join(sorted(one.row.items, key=natural_key))),
        Column(_("Description"), 16, lambda one: one.described),
        Column(_("Why, as run"), 34, key="why", read=lambda one: "; ".join(
            (f"{words.class_symbol(one.results[0])} {words.risk_words(one.results[0])}", one.chance, one.reason))),
        Column(own["detail"].label, 13, lambda one: _(DETAILS[one.row.detail].title)),
        *(replace(own[key], label=f"{own[key].label}: {screening}", format=FORCE) for key in forces),
        replace(own["fixings"], align="center", read=lambda one: say_work.say_fixings(one.row)),
        own["unit_cost"],
        own["cost"],
        of_entry("falls_avoided", 8, only_first=True),
        of_entry("falls_left", 8, only_first=True),
        Column(_("Remarks on the forces"), 26, key="remarks", read=lambda one: "; ".join(
            filter(None, (_(say_work.HOLDS) if one.is_held_by_weight else "", one.marks)))),
        Column(_("Photo"), 10, lambda one: ", ".join(
            dict.fromkeys(str(each.item.field("photo")) for each in one.results if each.item.field("photo")))),
        Column(_("Notes"), 18, lambda _one: ""),
    ]  # fmt: skip


def _write_changes(pen: Pen, page: Any, row: int, schedule: Schedule) -> None:
    """Write the table before and after: its labels take the columns before those of its numbers."""
    page.write_string(row, 0, _("Before and after"), pen.style("heading"))
    head = pen.style("head")
    lines: list[tuple[tuple[str, Any, Any], Any, Any]] = [(("", _("Before"), _("After")), head, head)]
    for one in (change for part in say_work.list_changes(schedule) for change in part):
        form = pen.style("plain", FORCE if one.decimals else COUNT)
        lines.append(((one.label, one.before, one.after), pen.style("text"), form))
    for at, ((label, *values), wide, form) in enumerate(lines, row + 1):
        page.merge_range(at, 0, at, CHANGE - 1, "", wide)
        pen.put(page, at, 0, label, wide)
        if label:
            page.set_row(at, row_height([label], [40]))
        for place, value in enumerate(values, CHANGE):
            pen.put(page, at, place, value, form)
