"""compare.html and compare.pdf: a document of blocks, what gets worse first, then counts, pieces, routes and rooms."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from assess.compare import comparison_view as say
from assess.compare.changes import Direction, PieceChange, StateChange
from assess.compare.comparison_view import CountLine, View
from assess.compare.past_run import PastPiece, PastState
from assess.i18n import gettext as _
from assess.i18n import ngettext, number
from assess.progress import SILENT, Progress
from assess.report import words
from assess.report.blocks import (
    BREAK,
    DASH,
    Block,
    Box,
    Bullets,
    Cell,
    Column,
    Document,
    Heading,
    Inline,
    Paragraph,
    Row,
    Runs,
    Section,
    Span,
    Tile,
    Tiles,
    Title,
    Words,
    head,
    list_columns,
    more,
    note,
    strong,
    table,
)
from assess.report.pages.html import render_document
from assess.report.pages.pdf import attach, print_page
from assess.report.report_options import ReportOptions
from assess.route_results import RouteState
from assess.version import __version__

STYLE = "compare.css"
MOST_ROWS, MOST_PRINTED, MOST_STATES = 5000, 300, 300
"""Rows of pieces on a screen and on paper, and rows of routes and of rooms; the Excel file has all."""


def write_print(view: View, path: Path, data: Path, options: ReportOptions, progress: Progress = SILENT) -> None:
    """Write compare.pdf, which carries the file `data`; raises what `assess.report.pages.pdf.write_pdf` does."""
    html = render_comparison(view, options, for_print=True, progress=progress)
    files = [attach(data.name, "Data", _("The comparison, for other programs"), data.read_bytes())]
    print_page(html, path, files, options, progress)


def render_comparison(
    view: View, options: ReportOptions, *, for_print: bool = False, progress: Progress = SILENT
) -> str:
    """Return the page in the language in use (see `ReportOptions.spoken`)."""
    document = progress.wait_for(lambda: _build_document(view, MOST_PRINTED if for_print else MOST_ROWS))
    return render_document(document, options, STYLE, for_print=for_print, progress=progress)


def _build_document(view: View, most_rows: int) -> Document:
    authors = [str(view.after.building.get(name) or "") for name in ("prepared_by", "organisation")]
    about = _("Overturning of furniture in an earthquake: two runs compared")
    title = Title(view.title, words.cut(view.title, 60), view.footer, words.cut(view.conditions, 150))
    sections = [
        Section(list(_say_worse(view)), "", "worse", _("What gets worse")),
        Section(list(_count(view)), "run-on", "counts", _("Counts before and after")),
        Section(list(_list_moves(view)), "run-on", "moved", _("Pieces by class, before and after")),
        Section(list(_list_pieces(view, most_rows)), "", "changes", _("Pieces that changed")),
    ]
    if view.found.routes or view.found.rooms:
        blocks = [
            *_list_states(view.found.routes, _("Route"), _("No route changed.")),
            Heading(_("Rooms that changed")),
            *_list_states(view.found.rooms, _("Room"), _("No room changed."), with_floor=True),
        ]
        sections.append(Section(blocks, "run-on", "routes", _("Evacuation routes that changed")))
    sections.append(Section(list(_list_runs(view)), "run-on", "runs", _("The two runs")))
    return Document(
        title=_("Furniture in earthquakes, before and after: {building}", building=words.cut(view.title, 80)),
        cover=[Paragraph(about, "kind"), title],
        sections=sections,
        author=", ".join(filter(None, authors)),
        description=about,
        conditions=view.conditions,
        kind="comparison",
    )


def _whole(value: int) -> str:
    return number(value, ",d")


def _say_worse(view: View) -> Iterator[Block]:
    yield from (Paragraph(text, "caution") for text in view.list_warnings())
    worse, others = view.list_worse(), view.list_others()
    verdict: list[Block] = [Paragraph(strong(view.headline), "lead"), *([Bullets(worse)] if worse else [])]
    yield Box(verdict, f"verdict {view.tone}")
    if others:
        yield Bullets(others)
    yield Tiles(
        [Tile(one.tone if one.count else "", one.label, _whole(one.count), one.note) for one in view.list_tiles()]
    )
    yield Paragraph(
        _(
            "The tiles count pieces. Pieces are matched by the name of their item. A difference within the sampling "
            "interval cannot be told from chance at 95 % (Newcombe 1998, method 10, draws of both runs taken as "
            "independent). Percentages without a range come from the formula only."
        ),
        "small",
    )


def _count(view: View) -> Iterator[Block]:
    yield _tabulate_counts(_("Pieces"), view.list_counts())
    yield Paragraph(
        _(
            "Expected falls are sums over the free-standing pieces that have a class in their run: BEFORE {before}, "
            "AFTER {after}. Unconfirmed pieces and pieces by formula only are not in them. For the interval of a sum "
            "the pieces are taken as fully correlated.",
            **view.bases,
        ),
        "small",
    )
    lines = view.list_route_counts()
    yield (
        _tabulate_counts(_("Evacuation routes"), lines) if lines else Paragraph(_("Neither run has evacuation routes."))
    )


def _tabulate_counts(label: str, lines: Sequence[CountLine]) -> Block:
    columns = list_columns(
        (label, ""), (_("BEFORE"), "w15", "num"), (_("AFTER"), "w15", "num"), (_("Change"), "w30", "num")
    )
    rows = []
    for line in lines:
        name = Span(line.label, f"badge {line.style}") if line.style else line.label
        before, after, change = line.texts
        rows.append(Row((head(name), before, after, Cell(change, "change")), line.tone))
    return table(columns, rows, "compared counts", is_cards=False)


def _mark_standing(standing: str) -> Inline:
    return Span(say.label_standing(standing), f"badge {say.style_standing(standing)}") if standing else DASH


def _list_moves(view: View) -> Iterator[Block]:
    matrix = view.build_matrix()
    if not view.found.pieces:
        yield Paragraph(_("There are no pieces."))
        return

    def share(count: int) -> str:
        return _whole(count) if count else DASH

    heads = [say.label_standing(one) if one else _("not in AFTER") for one in matrix.columns]
    columns = [Column(_("BEFORE ↓ AFTER →")), *(Column(one, is_number=True) for one in (*heads, _("all")))]
    rows = []
    for row in matrix.rows:
        cells = [
            Cell(share(count), tone if count or tone == "same" else "")
            for count, tone in zip(row.counts, row.tones, strict=True)
        ]
        name = _mark_standing(row.standing) if row.standing else _("not in BEFORE")
        rows.append(Row((head(name), *cells, share(row.total))))
    totals = (*matrix.totals, sum(matrix.totals))
    rows.append(Row((head(_("all")), *map(share, totals)), "total"))
    yield Box([table(columns, rows, "matrix", is_cards=False)], "scroll", label=_("Pieces by class, before and after"))
    what = _("Rows: class in BEFORE ({before}). Columns: class in AFTER ({after}).", **view.bases)
    tones = (
        _("Dark cells: a higher class or no longer anchored; light blue cells: a lower class or anchored.")
        if view.found.has_same_basis
        else _("The bases differ, so no change of class is marked as better or worse.")
    )
    yield Paragraph(f"{what} {tones}", "small")


def _mark_change(one: PieceChange | StateChange) -> Words:
    return Span(say.say_direction(one), f"change {say.find_tone(one.direction)}")


def _say_more(left: int) -> str:
    return ngettext("{n:,} more is in the Excel file.", "{n:,} more are in the Excel file.", left)


def _list_pieces(view: View, most: int) -> Iterator[Block]:
    changed = view.list_changed()
    if not changed:
        yield Paragraph(_("No piece changed."))
        return
    unchanged = len(view.found.pieces) - len(changed)
    lines = [
        ngettext("{n:,} row changed.", "{n:,} rows changed; the changes for the worse come first.", len(changed)),
        ngettext("{n:,} row did not change.", "{n:,} rows did not change.", unchanged) if unchanged else "",
    ]
    yield Paragraph(" ".join(filter(None, lines)))
    columns = list_columns(
        (_("Item"), "w14"), (_("Change"), "w18"), (_("Place"), "w9"), (_("Pieces"), "w7", "num"), (_("BEFORE"), "w18"),
        (_("AFTER"), "w18"), (_("Input that differs"), ""),
    )  # fmt: skip
    yield table(columns, map(_show_piece, changed[:most]), "compared cards changed", is_named=True)
    yield from more(len(changed) - most, _say_more)


def _show_piece(one: PieceChange) -> Row:
    piece = one.row
    name: Runs = [words.cut(piece.item, 40)]
    if piece.description:
        name += [BREAK, note(words.cut(piece.description, 40))]
    place = ", ".join(filter(None, (words.cut(piece.floor, 20), words.cut(piece.room, 30))))
    sides: list[Words] = [
        [_mark_standing(state), BREAK, note(_say_adopted(side))] if side else _mark_standing(state)
        for side, state in zip(one.sides, one.states, strict=True)
    ]
    cells = (head(name), _mark_change(one), place, _whole(one.pieces), *sides, "; ".join(say.say_inputs(one) or [DASH]))
    return Row(cells, say.find_tone(one.direction))


def _say_adopted(piece: PastPiece) -> str:
    """Return the chance of a piece; of an anchored one that it is the chance if it stood free."""
    chance = say.say_chance(piece.chance)
    return _("free-standing: {chance}", chance=chance) if piece.is_held else chance


def _list_states(rows: Sequence[StateChange], label: str, none: str, *, with_floor: bool = False) -> Iterator[Block]:
    changed = [one for one in rows if one.direction != Direction.SAME]
    if not changed:
        yield Paragraph(none)
        return
    columns = list_columns(
        (label, "w20"), (_("Change"), "w20"), *([(_("Floor"), "w10")] if with_floor else []), (_("BEFORE"), ""),
        (_("AFTER"), ""),
    )  # fmt: skip
    shown = []
    for one in changed[:MOST_STATES]:
        floor = [words.cut(one.row.floor, 20)] if with_floor else []
        cells = (head(words.cut(one.row.name, 60)), _mark_change(one), *floor, *map(_show_state, one.sides))
        shown.append(Row(cells, say.find_tone(one.direction)))
    yield table(columns, shown, "compared cards", is_named=True)
    yield from more(len(changed) - MOST_STATES, _say_more)


def _show_state(side: PastState | None) -> Words:
    if side is None:
        return DASH
    name = say.name_state(side.state)
    has_chance = side.chance is not None and side.state != RouteState.NOT_KNOWN
    return [name, BREAK, note(say.say_chance(side.chance))] if has_chance else name


def _list_runs(view: View) -> Iterator[Block]:
    rows = []
    for fact in view.list_facts():
        mark: Runs = [" ", Span(_("differs"), "change unclear")] if fact.differs else []
        cells = (head([fact.label, *mark]), Cell(fact.before, "hash"), Cell(fact.after, "hash"))
        rows.append(Row(cells, "differs" if fact.differs else ""))
    columns = list_columns((_("What"), "w30"), (_("BEFORE"), ""), (_("AFTER"), ""))
    yield table(columns, rows, "compared facts-of-two", is_cards=False)
    yield Paragraph(
        _(
            "Settings and lines of the workbook that are not named are the same in both runs. Made with assess "
            "{version}.",
            version=__version__,
        ),
        "small",
    )
