"""compare.xlsx: what the pages say, and every row, whether it changed or not; numbers are numbers, text stays text."""

import datetime
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from assess.compare import comparison_document as say
from assess.compare.changes import StateChange
from assess.compare.comparison_document import View
from assess.compare.past_run import PastChance
from assess.i18n import gettext as _
from assess.progress import SILENT, Progress
from assess.report import words
from assess.report.blocks import Cell, Table, plain_words
from assess.report.provenance import report_time
from assess.report.xlsx.pen import CHANCE, COUNT, Column, Pen, write_sheets
from assess.route_results import RouteState

_TONES: dict[str, dict[str, Any]] = {
    "worse": {"bg_color": "#8c1d3f", "font_color": "#ffffff", "bold": True},
    "better": {"bg_color": "#d5e9f6", "font_color": "#1c1c1c"},
    "same": {"bg_color": "#e9edf0"},
}
"""Looks of what gets worse or better."""


def write_tables(view: View, path: Path, progress: Progress = SILENT) -> None:
    """Write compare.xlsx in the language in use, as `assess.report.xlsx.pen.write_sheets` does."""
    found = view.found

    def write_moves(pen: Pen, page: Any) -> None:
        table = view.tabulate_moves()
        labels = [plain_words(one.heading) for one in table.columns]
        pen.heads(page, labels, [24, *(14 for _label in labels[1:])])
        below = _write_rows(pen, page, 1, table)
        pen.put(page, below, 0, view.say_moves(), pen.style("plain"))

    items = [
        *_list_change_columns(),
        Column(_("Item"), 14, lambda one: one.row.item),
        Column(_("Description"), 22, lambda one: one.row.description),
        Column(_("Floor"), 8, lambda one: one.row.floor),
        Column(_("Room"), 14, lambda one: one.row.room),
        *_of_both(lambda run: _("Pieces, {run}", run=run), 9,
                  lambda one, at: getattr(one.sides[at], "quantity", None), COUNT),
        *_of_both(lambda run: _("Class, {run}", run=run), 16,
                  lambda one, at: plain_words(say.mark_standing(one.states[at]))),
        *_list_chances(lambda piece: piece.chance),
        *_of_both(lambda run: _("Basis, {run}", run=run), 13,
                  lambda one, at: say.name_basis(one.sides[at].basis) if one.sides[at] else None),
        Column(_("Input that differs"), 40, lambda one: "; ".join(say.say_inputs(one))),
    ]  # fmt: skip
    facts = [
        Column(_("What"), 40, lambda one: one.label),
        Column(_("BEFORE"), 44, lambda one: one.before),
        Column(_("AFTER"), 44, lambda one: one.after),
        Column(_("Differs"), 10, lambda one: words.yes_or_no(one.differs)),
    ]
    sheets: dict[str, Callable[[Pen, Any], object]] = {
        _("Summary"): partial(_write_summary, view),
        _("Moved classes"): write_moves,
        _("Items"): lambda pen, page: pen.listing(page, items, found.pieces),
    }
    column = partial(Column, width=20, read=lambda one: one.row.name)
    if found.routes:
        sheets[_("Routes")] = partial(_write_states, [column(_("Route"))], found.routes)
    if found.rooms:
        own = [column(_("Room")), Column(_("Floor"), 8, lambda one: one.row.floor)]
        sheets[_("Rooms")] = partial(_write_states, own, found.rooms)
    sheets[_("The two runs")] = lambda pen, page: pen.listing(page, facts, view.list_facts())
    write_sheets(
        path,
        [(title, title, write) for title, write in sheets.items()],
        title=_("Furniture in earthquakes, before and after: {building}", building=words.cut(view.title, 120)),
        created=datetime.datetime.combine(report_time().date(), datetime.time()),
        # Excel takes 255 characters in all above or below a printed page
        texts=(words.cut(view.title, 40), words.cut(view.conditions, 80), words.cut(view.footer, 160)),
        progress=progress,
    )


def _write_summary(view: View, pen: Pen, page: Any) -> None:
    page.set_column(0, 0, 52)
    page.set_column(1, 2, 12)
    page.set_column(3, 3, 34)
    texts = [
        (view.title, "title"),
        *((text, "warning") for text in (view.conditions, *view.list_warnings())),
        (view.headline, "heading"),
        *((text, "plain") for text in (*view.list_worse(), *view.list_others(), view.footer)),
    ]
    texts = [one for one in texts if one[0]]
    for row, (text, look) in enumerate(texts):
        pen.put(page, row, 0, text, pen.style(look))
    below = len(texts)
    for table in view.tabulate_counts():
        for at, column in enumerate(table.columns):
            pen.put(page, below + 1, at, column.heading, pen.style("head"))
        below = _write_rows(pen, page, below + 2, table)


def _write_rows(pen: Pen, page: Any, top: int, table: Table) -> int:
    for number, row in enumerate(table.groups[0], top):
        for at, one in enumerate(row.cells):
            cell = one if isinstance(one, Cell) else Cell(one)
            value = plain_words(cell.words) if cell.sort is None else cell.sort
            form = "" if isinstance(value, str) else COUNT if isinstance(value, int) else "#,##0.00"
            look = _TONES.get(row.kind if cell.kind == "change" else cell.kind, {})
            pen.put(page, number, at, value, pen.style("total" if row.kind == "total" else "plain", form, **look))
    return top + len(table.groups[0])


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
        Column(
            _("Within the sampling interval"),
            12,
            lambda one: "" if one.is_within is None else words.yes_or_no(one.is_within),
        ),
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
