"""compare.xlsx: what the pages say, and every row, whether it changed or not; numbers are numbers, text stays text."""

import datetime
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from assess.compare import comparison_view as say
from assess.compare.changes import StateChange
from assess.compare.comparison_view import CountLine, View
from assess.compare.past_run import PastChance
from assess.i18n import gettext as _
from assess.progress import SILENT, Progress
from assess.report import words
from assess.report.provenance import report_time
from assess.report.xlsx.pen import CHANCE, COUNT, Column, Pen, name_sheets, set_page
from assess.route_results import RouteState
from assess.workbook.writer import write_book

LONGEST_HEAD = 80
"""Characters of the texts above and below a printed page, of which Excel takes 255 in all."""
_TONES: dict[str, dict[str, Any]] = {
    "worse": {"bg_color": "#8c1d3f", "font_color": "#ffffff", "bold": True},
    "better": {"bg_color": "#d5e9f6", "font_color": "#1c1c1c"},
    "same": {"bg_color": "#e9edf0"},
}
"""Looks of what gets worse or better."""


def write_tables(view: View, path: Path, progress: Progress = SILENT) -> None:
    """Write compare.xlsx in the language in use.

    Raises OSError if the file cannot be written; CancelledError if `progress` was cancelled (no file is left).
    """

    def write(book: Any) -> None:
        created = datetime.datetime.combine(report_time().date(), datetime.time())
        title = _("Furniture in earthquakes, before and after: {building}", building=words.cut(view.title, 120))
        book.set_properties({"title": title, "created": created})
        _write_sheets(book, view, progress)

    write_book(path, write, by_row=True, progress=progress)


def _write_sheets(book: Any, view: View, progress: Progress) -> None:
    sheets: dict[str, Callable[[Pen, Any], object]] = {
        _("Summary"): partial(_write_summary, view),
        _("Moved classes"): partial(_write_matrix, view),
        _("Items"): lambda pen, page: pen.listing(page, _list_item_columns(), view.found.pieces),
    }
    if view.found.routes:
        own = [Column(_("Route"), 20, lambda one: one.row.name)]
        sheets[_("Routes")] = partial(_write_states, own, view.found.routes)
    if view.found.rooms:
        own = [Column(_("Room"), 20, lambda one: one.row.name), Column(_("Floor"), 8, lambda one: one.row.floor)]
        sheets[_("Rooms")] = partial(_write_states, own, view.found.rooms)
    sheets[_("The two runs")] = partial(_write_facts, view)
    pen = Pen(book, name_sheets({title: title for title in sheets}), progress)
    pages = [book.add_worksheet(name) for name in pen.sheets.values()]
    for page, name, write in zip(pages, pen.sheets.values(), sheets.values(), strict=True):
        set_page(
            page,
            words.cut(view.title, LONGEST_HEAD // 2),
            name,
            words.cut(view.conditions, LONGEST_HEAD),
            words.cut(view.footer, 2 * LONGEST_HEAD),
        )
        write(pen, page)


def _write_summary(view: View, pen: Pen, page: Any) -> None:
    page.set_column(0, 0, 52)
    page.set_column(1, 2, 12)
    page.set_column(3, 3, 34)
    pen.put(page, 0, 0, view.title, pen.style("title"))
    texts = [
        *((text, "warning") for text in (view.conditions, *view.list_warnings())),
        (view.headline, "heading"),
        *((text, "plain") for text in (*view.list_worse(), *view.list_others(), view.footer)),
    ]
    row = 1
    for text, look in texts:
        if text:
            pen.put(page, row, 0, text, pen.style(look))
            row += 1
    for title, lines in ((_("Pieces"), view.list_counts()), (_("Evacuation routes"), view.list_route_counts())):
        if lines:
            row = _write_counts(pen, page, row + 1, title, lines)


def _write_counts(pen: Pen, page: Any, row: int, title: str, lines: Sequence[CountLine]) -> int:
    for at, label in enumerate((title, _("BEFORE"), _("AFTER"), _("Change"))):
        pen.put(page, row, at, label, pen.style("head"))
    for at, line in enumerate(lines, row + 1):
        form = pen.style("plain", COUNT if line.is_count else "#,##0.00")
        tone = pen.style("plain", **_TONES.get(line.tone, {}))
        pen.put(page, at, 0, line.label, pen.style("plain"))
        pen.put(page, at, 1, line.total.before, form)
        pen.put(page, at, 2, line.total.after, form)
        pen.put(page, at, 3, line.texts[2], tone)
    return row + 1 + len(lines)


def _write_matrix(view: View, pen: Pen, page: Any) -> None:
    matrix = view.build_matrix()
    labels = [
        _("BEFORE ↓ AFTER →"),
        *(say.label_standing(one) if one else _("not in AFTER") for one in matrix.columns),
        _("all"),
    ]
    pen.heads(page, labels, [24, *(14 for _label in labels[1:])])
    for at, row in enumerate(matrix.rows, 1):
        label = say.label_standing(row.standing) if row.standing else _("not in BEFORE")
        pen.put(page, at, 0, label, pen.style("plain"))
        for column, (count, tone) in enumerate(zip(row.counts, row.tones, strict=True), 1):
            look = _TONES.get(tone, {}) if count or tone == "same" else {}
            pen.put(page, at, column, count, pen.style("plain", COUNT, **look))
        pen.put(page, at, len(labels) - 1, row.total, pen.style("total", COUNT))
    below = len(matrix.rows) + 1
    for column, value in enumerate((_("all"), *matrix.totals, sum(matrix.totals))):
        pen.put(page, below, column, value, pen.style("total", COUNT))
    note = _("Rows: class in BEFORE ({before}). Columns: class in AFTER ({after}).", **view.bases)
    pen.put(page, below + 1, 0, note, pen.style("plain"))


def _list_item_columns() -> list[Column]:
    return [
        *_list_change_columns(),
        Column(_("Item"), 14, lambda one: one.row.item),
        Column(_("Description"), 22, lambda one: one.row.description),
        Column(_("Floor"), 8, lambda one: one.row.floor),
        Column(_("Room"), 14, lambda one: one.row.room),
        *_of_both(
            lambda run: _("Pieces, {run}", run=run), 9, lambda one, at: getattr(one.sides[at], "quantity", None), COUNT
        ),
        *_of_both(lambda run: _("Class, {run}", run=run), 16, lambda one, at: say.label_standing(one.states[at])),
        *_list_chances(lambda piece: piece.chance),
        *_of_both(
            lambda run: _("Basis, {run}", run=run),
            13,
            lambda one, at: say.name_basis(one.sides[at].basis) if one.sides[at] else None,
        ),
        Column(_("Input that differs"), 40, lambda one: "; ".join(say.say_inputs(one))),
    ]


def _write_states(own: Sequence[Column], rows: Sequence[StateChange], pen: Pen, page: Any) -> None:
    columns = [
        *_list_change_columns(),
        *own,
        *_of_both(lambda run: _("State, {run}", run=run), 16, lambda one, at: say.name_state(one.states[at])),
        # what is missing is not in a chance that is not known
        *_list_chances(lambda state: None if state.state == RouteState.NOT_KNOWN else state.chance),
    ]
    pen.listing(page, columns, rows)


def _list_change_columns() -> list[Column]:
    return [
        Column(_("Change"), 20, lambda one: say.name_direction(one.direction)),
        Column(_("Within the sampling interval"), 12, lambda one: _say_flag(one.is_within)),
    ]


def _of_both(label: Callable[[str], str], width: int, read: Callable[[Any, int], Any], form: str = "") -> list[Column]:
    """Return a column of each run; `read` takes a change, and 0 for BEFORE or 1 for AFTER."""
    return [
        Column(label(run), width, partial(lambda at, one: read(one, at), at), form)
        for at, run in enumerate((_("BEFORE"), _("AFTER")))
    ]


def _list_chances(find: Callable[[Any], PastChance | None]) -> list[Column]:
    def part(at: int, name: str, one: Any) -> float | None:
        return getattr(find(one.sides[at]), name, None) if one.sides[at] else None

    return [
        Column(label, 10, partial(part, at, name), CHANCE)
        for at, run in enumerate((_("BEFORE"), _("AFTER")))
        for label, name in (
            (_("Chance, {run}", run=run), "probability"),
            (_("Interval low, {run}", run=run), "low"),
            (_("Interval high, {run}", run=run), "high"),
        )
    ]


def _write_facts(view: View, pen: Pen, page: Any) -> None:
    columns = [
        Column(_("What"), 40, lambda one: one.label),
        Column(_("BEFORE"), 44, lambda one: one.before),
        Column(_("AFTER"), 44, lambda one: one.after),
        Column(_("Differs"), 10, lambda one: _say_flag(one.differs)),
    ]
    pen.listing(page, columns, view.list_facts())


def _say_flag(flag: bool | None) -> str:
    return "" if flag is None else _("yes") if flag else _("no")
