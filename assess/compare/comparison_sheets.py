"""compare.xlsx: what the pages say, and every row, whether it changed or not; numbers are numbers, text stays text."""

import datetime
from collections.abc import Callable, Sequence
from functools import partial
from operator import attrgetter
from pathlib import Path
from typing import Any

from assess.compare import comparison_words as say
from assess.compare.changes import PieceChange, StateChange
from assess.compare.comparison_facts import list_facts
from assess.compare.comparison_view import CountLine, View
from assess.compare.past_run import NOT_KNOWN, PastChance, PastPiece, PastState
from assess.i18n import gettext as _
from assess.progress import SILENT, Progress
from assess.report import words
from assess.report.provenance import report_time
from assess.report.xlsx.pen import CHANCE, COUNT, Column, Pen, name_sheets, set_page
from assess.workbook.writer import write_book

LONGEST_HEAD = 80
"""Characters of the texts above and below a printed page, of which Excel takes 255 in all."""
Side = Callable[[Any], Any]


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
    sheets: dict[str, Callable[[Pen, Any, View], object]] = {
        _("Summary"): _write_summary,
        _("Moved classes"): _write_matrix,
        _("Items"): lambda pen, page, view: pen.listing(page, _list_item_columns(), view.found.pieces),
    }
    if view.found.routes:
        sheets[_("Routes")] = partial(_write_states, label=_("Route"), rows=view.found.routes, with_floor=False)
    if view.found.rooms:
        sheets[_("Rooms")] = partial(_write_states, label=_("Room"), rows=view.found.rooms, with_floor=True)
    sheets[_("The two runs")] = _write_facts
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
        write(pen, page, view)


def _write_summary(pen: Pen, page: Any, view: View) -> None:
    page.set_column(0, 0, 52)
    page.set_column(1, 2, 12)
    page.set_column(3, 3, 34)
    pen.put(page, 0, 0, view.title, pen.style("title"))
    row = 1
    for texts, look in (
        ([view.conditions], "warning"),
        (view.list_warnings(), "warning"),
        ([view.headline], "heading"),
        (view.list_worse(), "plain"),
        (view.list_others(), "plain"),
        ([view.footer], "plain"),
    ):
        for text in filter(None, texts):
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


_TONES: dict[str, dict[str, Any]] = {
    "worse": {"bg_color": "#8c1d3f", "font_color": "#ffffff", "bold": True},
    "better": {"bg_color": "#d5e9f6", "font_color": "#1c1c1c"},
    "same": {"bg_color": "#e9edf0"},
}
"""Looks of what gets worse or better."""


def _write_matrix(pen: Pen, page: Any, view: View) -> None:
    matrix = view.build_matrix()
    labels = [
        _("BEFORE ↓ AFTER →"),
        *(say.label_standing(one) if one else _("not in AFTER") for one in matrix.columns),
        _("all"),
    ]
    pen.heads(page, labels, [24, *(14 for _label in labels[1:])])
    for at, row in enumerate(matrix.rows, 1):
        pen.put(
            page, at, 0, say.label_standing(row.standing) if row.standing else _("not in BEFORE"), pen.style("plain")
        )
        for column, (count, tone) in enumerate(zip(row.counts, row.tones, strict=True), 1):
            look = _TONES.get(tone, {}) if count or tone == "same" else {}
            pen.put(page, at, column, count, pen.style("plain", COUNT, **look))
        pen.put(page, at, len(labels) - 1, row.total, pen.style("total", COUNT))
    below = len(matrix.rows) + 1
    for column, value in enumerate((_("all"), *matrix.totals, sum(matrix.totals))):
        pen.put(page, below, column, value, pen.style("total", COUNT))
    note = _(
        "Rows: class in BEFORE ({before}). Columns: class in AFTER ({after}).",
        before=say.name_basis(view.before.main_basis),
        after=say.name_basis(view.after.main_basis),
    )
    pen.put(page, below + 1, 0, note, pen.style("plain"))


def _list_item_columns() -> list[Column]:
    sides = ((_("BEFORE"), attrgetter("before")), (_("AFTER"), attrgetter("after")))
    return [
        Column(_("Change"), 20, lambda one: say.name_direction(one.direction)),
        Column(_("Within the sampling interval"), 12, lambda one: _say_flag(one.is_within)),
        Column(_("Item"), 14, lambda one: one.piece.item),
        Column(_("Description"), 22, lambda one: one.piece.description),
        Column(_("Floor"), 8, lambda one: one.piece.floor),
        Column(_("Room"), 14, lambda one: one.piece.room),
        *(
            Column(_("Pieces, {run}", run=name), 9, partial(_read, side, lambda one: one.quantity), COUNT)
            for name, side in sides
        ),
        Column(_("Class, {run}", run=_("BEFORE")), 16, lambda one: say.label_standing(one.standing_before)),
        Column(_("Class, {run}", run=_("AFTER")), 16, lambda one: say.label_standing(one.standing_after)),
        *(
            column
            for name, side in sides
            for column in _list_chances(name, partial(_read, side, lambda one: one.chance))
        ),
        *(
            Column(_("Basis, {run}", run=name), 13, partial(_read, side, lambda one: say.name_basis(one.basis)))
            for name, side in sides
        ),
        Column(_("Input that differs"), 40, lambda one: "; ".join(say.say_inputs(one))),
    ]


def _write_states(
    pen: Pen, page: Any, _view: View, *, label: str, rows: Sequence[StateChange], with_floor: bool
) -> None:
    sides = ((_("BEFORE"), attrgetter("before")), (_("AFTER"), attrgetter("after")))
    columns = [
        Column(_("Change"), 20, name_direction),
        Column(_("Within the sampling interval"), 12, lambda one: _say_flag(one.is_within)),
        Column(label, 20, lambda one: one.name),
        *([Column(_("Floor"), 8, lambda one: one.floor)] if with_floor else []),
        Column(_("State, {run}", run=_("BEFORE")), 16, lambda one: say.name_state(one.states[0])),
        Column(_("State, {run}", run=_("AFTER")), 16, lambda one: say.name_state(one.states[1])),
        *(column for name, side in sides for column in _list_chances(name, partial(_read, side, _read_known))),
    ]
    pen.listing(page, columns, rows)


def _list_chances(run: str, read: Callable[[Any], PastChance | None]) -> list[Column]:
    def part(name: str, one: Any) -> float | None:
        found = read(one)
        return None if found is None else getattr(found, name)

    return [
        Column(_("Chance, {run}", run=run), 10, partial(part, "probability"), CHANCE),
        Column(_("Interval low, {run}", run=run), 10, partial(part, "low"), CHANCE),
        Column(_("Interval high, {run}", run=run), 10, partial(part, "high"), CHANCE),
    ]


def _write_facts(pen: Pen, page: Any, view: View) -> None:
    columns = [
        Column(_("What"), 40, lambda one: one.label),
        Column(_("BEFORE"), 44, lambda one: one.before),
        Column(_("AFTER"), 44, lambda one: one.after),
        Column(_("Differs"), 10, lambda one: _say_flag(one.differs)),
    ]
    pen.listing(page, columns, list_facts(view.found))


def name_direction(one: PieceChange | StateChange) -> str:
    """Return where a row goes."""
    return say.name_direction(one.direction)


def _read(side: Side, read: Callable[[Any], Any], one: Any) -> Any:
    found: PastPiece | None = side(one)
    return None if found is None else read(found)


def _read_known(state: PastState) -> PastChance | None:
    """Return the chance of a route or room; None where it is not known, as that leaves out what is missing."""
    return None if state.state == NOT_KNOWN else state.chance


def _say_flag(flag: bool | None) -> str:
    return "" if flag is None else _("yes") if flag else _("no")
