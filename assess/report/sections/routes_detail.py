"""Evacuation routes in detail: routes, what to fix for each, rooms, floors, segments, and the pieces that matter."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from assess.i18n import fill, ngettext
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import (
    BREAK,
    Block,
    Box,
    Bullets,
    Cell,
    Column,
    Heading,
    Inline,
    Paragraph,
    Row,
    Section,
    Terms,
    Words,
    head,
    join_words,
    list_columns,
    more,
    note,
    rich,
    table,
)
from assess.report.page_columns import PageColumn, flags, route_columns, say_flag
from assess.report.say import route
from assess.report.sections.routes import show_state
from assess.report.view import Part, View, shorten
from assess.route_results import BesideRow, Chance, RoomRow, RouteRow, RouteState, SegmentRow

MOST_ROUTES, MOST_ROOMS, MOST_BESIDE, MOST_STEPS = 100, 150, 300, 120
"""Rows of the tables that are shown, those most likely to be blocked; the Excel report holds all."""
Show = Callable[[Any], "Cell | Words"]


def build(view: View) -> Sequence[Section]:
    """Return what is said of routes and rooms, then the wide tables of segments and of pieces near them."""
    found = view.run.route_tables
    columns = route_columns(
        has_anchors=any(one.blocked_if_anchors_fail for one in found.routes),
        has_unknown=any(one.unknown_segments or one.unknown_routes or one.unknown_rooms for one in found.floors),
    )
    blocks: list[Block] = [
        *_list_routes(view, columns["routes"]), *_list_fixes(view), *_list_rooms(view, columns["rooms"]),
        *_list_floors(view, columns["floors"]),
        Heading(_("Assumptions of the evaluation")),
        Box([Bullets(route.list_cautions(found))], "caution"),
        Heading(_("Widths required by codes and guidance")),
        Paragraph(f"{route.say_default_width()} "
                  + _("Which of these widths applies is to be entered as Required width in the workbook."), "lead-in"),
        table(list_columns((_("Clear width"), "w36"), (_("Publication"), "")),
              ((join_words(asked, BREAK), publication) for publication, asked in route.list_widths()),
              "widths few"),
    ]  # fmt: skip
    wide = [*_list_segments(view, columns["segments"]), *_list_beside(view, columns["beside"])]
    return [Section(blocks), Section(wide, "wide", "route-segments")]


def _build_row(columns: Sequence[PageColumn], one: Any, shown: Mapping[str, Show], id_: str = "") -> Row:
    """Return a row of the fields of a table, some of them shown otherwise than their values."""
    return Row([shown[each.key](one) if each.key in shown else each.cell(one) for each in columns], id=id_)


def _say_state(one: SegmentRow | RouteRow, text: str) -> Words:
    state = show_state(one.state, text)
    if not one.evaluated or one.under_record is None:
        return state
    return [state, BREAK, note(_("record: {state}", state=route.say_recorded(one)))]


def _say_perhaps(chance: Chance | None, *, is_known: bool = True) -> str:
    return route.say_chance(chance) if chance is not None and is_known else words.DASH


def _list_routes(view: View, columns: Sequence[PageColumn]) -> list[Block]:
    found = view.run.route_tables
    caption = [_("Bounds: pieces fall independently / fully correlated.")]
    if any(one.under_record is not None for one in found.routes):
        caption.append(_("Record: state under the recorded motion itself; pieces that were not simulated are assumed "
                         "to stand."))  # fmt: skip

    def say_bounds(one: RouteRow) -> Words:
        if one.missing:
            return route.say_missing(one.missing)
        if one.blocked is None or not one.evaluated:
            return words.DASH
        left_out = route.say_left_out(one.unevaluated_segments)
        basis = note("; ".join(filter(None, (route.say_basis(one.blocked), left_out))))
        return [route.say_bounds(one.blocked), BREAK, basis] if one.blocked.pieces else basis

    def name_piece(one: RouteRow) -> Words:
        likely = one.most_likely_piece
        if likely is None or route.is_blocked_standing(one):
            return words.DASH
        return view.name_piece(likely.item_index)

    shown: Mapping[str, Show] = {
        "route": lambda one: head(words.cut(one.route, 40)),
        "floors": lambda one: route.name_few(one.floors),
        "state": lambda one: _say_state(one, route.say_route_state(one, found.risk)),
        "blocked_probability": route.say_blocked,
        "blocked_or_reduced_probability": route.say_taken,
        "blocked_is_joint": say_bounds,
        "blocked_if_anchors_fail_probability":
            lambda one: _say_perhaps(one.blocked_if_anchors_fail, is_known=one.evaluated),
        "most_likely_piece": name_piece,
    }  # fmt: skip
    chosen = route.choose_rows(found.routes, MOST_ROUTES, route.find_chance)
    rows = [_build_row(columns, one, shown) for one in chosen]
    return [
        Heading(_("Routes")),
        table([one.column for one in columns], rows, "routes", " ".join(caption), is_named=True),
        *more(len(found.routes) - len(chosen),
              lambda n: ngettext("{n:,} more route, less likely to be blocked, is in the Excel report.",
                                 "{n:,} more routes, less likely to be blocked, are in the Excel report.", n)),
    ]  # fmt: skip


def _list_fixes(view: View) -> list[Block]:
    """Return what to fix for each route step by step, the routes that no fix opens, and those that are open."""
    found = view.run.route_tables
    blocks: list[Block] = [Heading(_("What to fix for each route"))]
    steps, left = shorten(route.list_steps(found), MOST_STEPS)
    if steps:
        lead = rich(_(
            "The smallest set of rows found that opens each route: its whole range is below {risk} <em>if the anchors "
            "hold</em>. Anchor all pieces of a row, or move them away. Fix all listed rows; fixing only some may have "
            "no effect, as pieces that fall together must all be fixed."
        ), risk=route.say_risk(found.risk))  # fmt: skip
        then = (_("A route that is not known then says what to fill in.")
                if any(one.missing_after for one in found.routes) else "")  # fmt: skip
        heads = list_columns(
            (_("Route"), "w24"), (_("Step"), "w6", "num"), (_("Piece"), ""), (_("Reduces by"), "w14", "num"),
            (_("Leaves"), "w14", "num"), (_("Then"), "w24"),
        )  # fmt: skip
        rows = [
            Row((words.cut(one.route, 40), str(at), view.name_row(step.item_index, 40), words.deviation(step.gain),
                 words.percent(step.left),
                 (route.say_missing_after(one) or _("open")) if at == len(one.fixes) else ""),
                "first" if at == 1 else "")
            for one, at, step in steps
        ]  # fmt: skip
        blocks += [Paragraph(join_words((lead, route.say_fixes_bound(found), then)), "lead-in"),
                   table(heads, rows, "steps")]  # fmt: skip
        blocks += more(left, lambda n: ngettext("{n:,} more step is in the Excel report.",
                                                "{n:,} more steps are in the Excel report.", n))  # fmt: skip
    unfixable, left = shorten(route.list_unfixable(found), MOST_ROUTES)
    if unfixable:
        lead = [_("Blocked with nothing fallen, so that no anchor helps: widen them, or move what stands inside; check "
                  "the Clear width.")]  # fmt: skip
        lines = [f"{words.cut(one.route, 40)}: {where or words.DASH}" for one, where in unfixable]
        blocks += [Paragraph(lead, "lead-in"), Bullets(lines)]
        blocks += more(left, lambda n: ngettext("{n:,} more route is in the Excel report.",
                                                "{n:,} more routes are in the Excel report.", n))  # fmt: skip
    count, names = route.name_untouched(found)
    if count:
        text = ngettext("{n:,} route is open as it is: {names}.", "{n:,} routes are open as they are: {names}.", count,
                        names=names)  # fmt: skip
        blocks.append(Paragraph(text))
    return blocks


def _list_rooms(view: View, columns: Sequence[PageColumn]) -> list[Block]:
    found = view.run.route_tables
    chosen = route.choose_rows(found.rooms, MOST_ROOMS, lambda one: one.loses_every_exit.probability)
    if not chosen:
        none = _("No room has a way out in the workbook, so none is evaluated.")
        return [Heading(_("Rooms")), Paragraph(none)]
    caption = _(
        "Chance that a room loses all exits; where it has no exit, all stairs, beyond which nothing is known. The "
        "first way out is the safest; others share as few segments with it as possible, and name those that they share."
    )

    def list_ways(one: RoomRow) -> Words:
        lines: list[Inline] = [f"{at}. {route.say_way(way, found)}" for at, way in enumerate(one.ways, start=1)]
        lines += [_("no other way")] if len(one.ways) == 1 else []
        return join_words([*lines, route.say_left_out(one.unevaluated_segments)], BREAK)

    def name_exits(one: RoomRow) -> str:
        names = route.name_few(one.exits)
        return _("stairs: {names}", names=names) if one.by_stairs else names

    shown: Mapping[str, Show] = {
        "room": lambda one: head(words.cut(one.room, 40)),
        "exits": name_exits,
        "state": lambda one: show_state(one.state, route.say_room_state(one)),
        "loses_every_exit_probability": route.say_lost,
        "loses_if_anchors_fail_probability": lambda one: _say_perhaps(one.loses_if_anchors_fail),
        "most_likely_piece": lambda one: view.name_piece(one.most_likely_piece.item_index)
        if one.most_likely_piece is not None else words.DASH,
        "ways": list_ways,
    }  # fmt: skip
    rows = [_build_row(columns, one, shown) for one in chosen]
    return [
        Heading(_("Rooms")),
        table([one.column for one in columns], rows, "rooms", caption, is_named=True),
        *more(len(found.rooms) - len(chosen),
              lambda n: ngettext("{n:,} more room, less likely to be cut off, is in the Excel report.",
                                 "{n:,} more rooms, less likely to be cut off, are in the Excel report.", n)),
    ]  # fmt: skip


def _list_floors(view: View, columns: Sequence[PageColumn]) -> list[Block]:
    floors = view.run.route_tables.floors
    if not floors:
        return []
    caption = _(
        "A route counts on every floor on which it has segments, as blocked there if its segments of that floor alone "
        "cut off what it serves. Left out: pieces without a usable position or route."
    )
    shown: Mapping[str, Show] = {
        "floor": lambda one: head(words.cut(view.floor_titles[one.floor], 40)),
        "any_room_cut_off_probability": lambda one: _say_perhaps(one.any_room_cut_off),
    }
    rows = [_build_row(columns, one, shown) for one in floors]
    return [
        Heading(_("Routes by floor")),
        table([one.column for one in columns], rows, "route-floors", caption, is_named=True),
    ]


def _list_segments(view: View, columns: Sequence[PageColumn]) -> list[Block]:
    found = view.run.route_tables
    caption = _(
        "Widths in m. Width now: with nothing fallen; all fallen: what is left with every free-standing piece fallen. "
        "Bounds: independent / fully correlated."
    )

    def say_bounds(one: SegmentRow) -> str:
        is_known = one.evaluated and one.state != RouteState.NOT_KNOWN
        return route.say_bounds(one.blocked) if one.blocked and is_known else words.DASH

    def list_remarks(one: SegmentRow) -> Words:
        fail = one.blocked_if_anchors_fail
        parts: list[Words] = [
            route.say_missing(one.missing),
            route.say_occupants(one) if one.needed_width_m is not None else "",
            _("if anchors fail: blocked in {chance}", chance=route.say_chance(fail)) if fail else "",
            _("room: {rooms}", rooms=words.cut(route.name_rooms(one), 40)) if one.room else "",
            route.say_other_rooms(one, view.content.results),
            flags(flag for flag in one.flags if flag != "own_rooms"),
            words.clip(one.notes, 80),
        ]
        return join_words(parts, "; ") or words.DASH

    shown: Mapping[str, Show] = {
        "segment": lambda one: head(route.say_segment(one)),
        "floor": lambda one: words.cut(one.floor or "", 20) or words.DASH,
        "from_place": lambda one: f"{words.cut(one.from_place or '', 40)} – {words.cut(one.to_place or '', 40)}",
        "state": lambda one: _say_state(one, route.say_segment_state(one, found.risk)),
        "blocked_probability": route.say_blocked,
        "blocked_independent": say_bounds,
        "blocked_or_reduced_probability": route.say_taken,
        "needed_width_m": list_remarks,
    }
    rows = [_build_row(columns, one, shown, f"segment-{number}") for number, one in view.shown_segments]
    left_out = sum(map(route.is_untouched, found.segments)) if view.for_print else 0
    return [
        Heading(_("Segments")),
        table([one.column for one in columns], rows, "segments", caption, is_named=True),
        *more(left_out,
              lambda n: ngettext("{n:,} segment that no piece reaches is left out; the Excel report has all.",
                                 "{n:,} segments that no piece reaches are left out; the Excel report has all.", n)),
        *more(len(found.segments) - left_out - len(view.shown_segments),
              lambda n: ngettext("{n:,} more segment, less likely to be blocked, is in the Excel report.",
                                 "{n:,} more segments, less likely to be blocked, are in the Excel report.", n)),
    ]  # fmt: skip


def _list_beside(view: View, columns: Sequence[PageColumn]) -> list[Block]:
    """Return the pieces that reach segments, and what the marks of routes mean."""
    beside = route.list_beside(view.run.route_tables)
    blocks: list[Block] = [Heading(_("The pieces that matter"))]
    if beside:
        shown, left = shorten(beside, MOST_BESIDE)
        caption = _(
            "The segments most likely to be blocked come first. Distance to the edge of the route, how far the piece "
            "lies in it once fallen, and the width that it alone leaves, in m. Falls and blocked: chance that it falls "
            "and the segment is blocked, of a row that at least one of its pieces does; for an anchored one, if "
            "anchors fail."
        )
        heads = [
            Column(_("Segment"), "segment"), Column(_("Floor"), "floor"),
            *(Column(one.heading, one.column.width, one.is_number) for one in columns),
            Column(_("Overturns"), "overturns", is_number=True), Column(_("Marks")),
        ]  # fmt: skip
        rows = [_list_near(view, columns, one, near) for one, near in shown]
        blocks.append(table(heads, rows, "beside", f"{caption} {view.marks}".rstrip(), is_named=True))
        blocks += more(left, lambda n: ngettext("{n:,} more row is in the Excel report.",
                                                "{n:,} more rows are in the Excel report.", n))  # fmt: skip
    else:
        blocks.append(Paragraph(_("No piece reaches any segment.")))
    meanings = route.list_flags(view.run.route_tables)
    return [*blocks, Terms([(say_flag(flag), text) for flag, text in meanings.items()])] if meanings else blocks


def _list_near(
    view: View, columns: Sequence[PageColumn], one: SegmentRow, near: BesideRow | None
) -> list[Cell | Words]:
    first: list[Cell | Words] = [route.say_segment(one), words.cut(one.floor or "", 20) or words.DASH]
    if near is None:
        return [*first, Cell(_("no piece reaches it"), columns=len(columns) + 1), flags(one.flags)]
    piece = view.content.results[near.item_index]
    shown: Mapping[str, Show] = {
        "item": lambda row: view.name_row(row.item_index),
        "by_plan": lambda row: _("the plan") if row.by_plan else _("Edge distance"),
    }
    cells = _build_row(columns, near, shown).cells
    sign = "" if piece.is_anchored else f" {piece.adopted.risk.symbol}{words.class_marks(piece)}"
    anchored = words.apart_label("anchored") if piece.is_anchored else ""
    return [*first, *cells, f"{words.chance(piece)}{sign}", join_words((anchored, flags(near.flags)))]


PART = Part(
    key="routes_detail", heading=fill("Evacuation routes in detail"), places={"annex": 100, "all": 100}, build=build,
    is_shown=lambda view: view.run.has_routes,
)  # fmt: skip
