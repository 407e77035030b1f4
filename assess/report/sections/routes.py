"""Evacuation routes: on one page every way to the street that is not open; then each route, room, segment and piece."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

from assess.i18n import fill, gettext as _, ngettext
from assess.report import blocks, measures, words
from assess.report.page_columns import PageColumn, flags, route_columns, say_flag
from assess.report.say import route
from assess.report.view import Part, View, say_left
from assess.route_results import BLOCKED_FROM, Chance, RoomRow, RouteRow, RouteState, SegmentRow
from assess.text import natural_key

MOST_LINES, MOST_FIXES, MOST_NAMES, LONGEST = 10, 10, 6, 20
"""Lines of either table of the page, pieces and names of a line, and characters of the name of a piece."""
MOST_ROUTES, MOST_ROOMS, MOST_BESIDE, MOST_STEPS = 100, 150, 300, 120
"""Rows of the tables that are shown, those most likely to be blocked; the Excel report holds all."""
Show = Callable[[Any], blocks.Cell | blocks.Words]
_Row = TypeVar("_Row", RouteRow, RoomRow)


def show_state(state: RouteState, text: str) -> blocks.Span:
    """Return the state of a route, room or segment with its colour."""
    return blocks.Span(text, f"way-state {state.replace(' ', '-')}")


class Line(NamedTuple):
    """A line of the page: a route, or rooms with identical ways to the street, represented by `one`."""

    one: RouteRow | RoomRow
    names: str
    ends: blocks.Words
    said: str
    chance: str


def build_page(view: View) -> blocks.Section:
    """Return the states in words, then a line for each way that is not open, by room and by route."""
    found = view.run.route_tables
    uncounted = route.say_uncounted(found)
    limit = route.say_risk(found.risk)
    rules = [
        (RouteState.BLOCKED, _("chance {limit} or more", limit=route.say_risk(BLOCKED_FROM))),
        (RouteState.NOT_KNOWN, _("something missing could change the state")),
        (RouteState.DOUBTFUL, _("less, but its range reaches {limit}", limit=limit)),
        (RouteState.OPEN, _("its whole range is below {limit}", limit=limit)),
    ]
    states = [
        blocks.Span([show_state(state, route.say_state(state)), f": {rule}{';' if at < len(rules) else '.'}"], "key")
        for at, (state, rule) in enumerate(rules, start=1)
    ]
    legend = blocks.join_words([*states, _("The chances assume that all anchors hold.")])
    rooms = _list_room_lines(view)
    text = _("By the best way out, stairs included. The chance is that of losing every exit. Anchor or move all pieces "
             "of a line.")  # fmt: skip
    return blocks.Section([
        blocks.Paragraph(" ".join(route.describe_routes(found)), "lead"),
        *view.list_texts("Ways out"),
        *([blocks.Paragraph(uncounted)] if uncounted else []),
        blocks.Paragraph(legend, "legend states"),
        *([blocks.Heading(_("From each room to the street")),
           blocks.Paragraph(" ".join([text, *route.say_drafts(found)]), "lead-in"),
           *_list_lines(view, rooms, _("From → to"))] if rooms else
          [blocks.Paragraph(_("No room has a way out in the workbook, so none is evaluated."))]),
        blocks.Heading(_("Routes")),
        *_list_lines(view, _list_route_lines(view), _("Route: from → to")),
    ])  # fmt: skip


def _list_lines(view: View, lines: Sequence[Line], first: str) -> list[blocks.Block]:
    heads = blocks.list_columns((first, ""), (_("State"), ""), (_("Chance blocked"), "", "num"),
                                (_("Decisive segment"), ""), (_("What to fix or fill in"), ""))  # fmt: skip
    rows = []
    for line in lines[:MOST_LINES]:
        at = None if line.one.state == RouteState.OPEN else line.one.decisive_segment
        decisive = words.DASH if at is None else route.say_segment(view.run.route_tables.segments[at])
        cells = (blocks.head(line.ends), show_state(line.one.state, line.said), line.chance, decisive)
        rows.append((*cells, _say_fixes(view, line.one)))
    return [blocks.table(heads, rows, "way-page"), *say_left(len(lines) - MOST_LINES)]


def _list_route_lines(view: View) -> list[Line]:
    routes, lines = view.run.route_tables, []
    for one in route.list_at_risk(routes):
        name, (start, end) = words.cut(one.route, 40), map(_name_few, (one.from_places, one.to_places))
        to = f" → {end}" if end else ""
        ends: blocks.Words = [blocks.strong(name), f": {start}{to}"] if start and start != name else f"{name}{to}"
        lines.append(Line(one, name, ends, route.say_outlook(one, routes.risk), route.say_blocked(one)))
    is_open = [one for one in routes.routes if one.state == RouteState.OPEN]
    for said, own in _group(is_open, lambda one: route.say_outlook(one, routes.risk)):
        highest = max(one.blocked.high for one in own if one.blocked)
        chance = _("at most {chance}", chance=words.percent(highest)) if highest else words.percent(0.0)
        names = words.name_first([words.cut(one.route, 30) for one in own], MOST_NAMES)
        lines.append(Line(own[0], names, names, said, chance))
    return lines


def _list_room_lines(view: View) -> list[Line]:
    """Return the rooms by their best way to the street, the worst first; identical ones as one line."""

    def kind(one: RoomRow) -> tuple[object, ...]:
        if one.state == RouteState.OPEN:
            return one.state, one.exits
        lack, fixed = (one.missing, one.missing_after), frozenset(fix.item_index for fix in one.fixes)
        return one.state, one.exits, route.say_lost(one), one.decisive_segment, fixed, lack

    rooms = sorted(
        view.run.route_tables.rooms, key=lambda one: (-one.state.severity, -one.loses_every_exit.probability)
    )
    lines = []
    for _kind, own in _group(rooms, kind):
        one = own[0]
        names = words.name_first([words.cut(room.room, 30) for room in own], MOST_NAMES)
        high = max(room.loses_every_exit.high for room in own)
        is_open = one.state == RouteState.OPEN and high
        chance = _("at most {chance}", chance=words.percent(high)) if is_open else route.say_lost(one)
        exits = _name_few(one.exits)
        to = _("stairs: {names}", names=exits) if one.by_stairs else exits
        lines.append(Line(one, names, f"{names} → {to}" if to else names, route.say_room_state(one), chance))
    return lines


def _group(rows: Iterable[_Row], kind: Callable[[_Row], Any]) -> list[tuple[Any, list[_Row]]]:
    found: dict[Any, list[_Row]] = {}
    for one in rows:
        found.setdefault(kind(one), []).append(one)
    return list(found.items())


def _name_few(places: Sequence[str]) -> str:
    return words.name_first([words.cut(one, 30) for one in places], 2)


def _say_fixes(view: View, one: RouteRow | RoomRow) -> blocks.Words:
    """Return the pieces to fix, rows of one piece each by the ends of their runs, and what else to do."""
    if one.missing:
        return route.say_missing(one.missing, has_cells=False) or words.DASH
    if not one.is_fixed:
        advice = _("widen it, or move what stands inside; check the Clear width")
    elif one.state == RouteState.DOUBTFUL and not one.fixes:
        advice = _("no draw blocks it: simulate more draws to settle it")
    else:
        advice = route.say_missing_after(one, has_cells=False)
    if not one.fixes:
        return advice or words.DASH
    items = view.run.item_rows
    fixes = sorted((items[fix.item_index] for fix in one.fixes), key=lambda row: natural_key(row.item))
    names = [row.item if row.quantity == 1 else f"{row.item} ({row.quantity})" for row in fixes]
    runs, texts = words.find_runs(names, LONGEST), []
    for run in runs[:MOST_FIXES]:
        ends: blocks.Runs = view.name_row(fixes[run[0]].index)
        if len(run) > 1:
            last = view.name_row(fixes[run[-1]].index)
            ends = blocks.put_words(_("{first} to {last}"), first=ends, last=last)
        texts.append(ends)
    found = blocks.join_words(texts, ", ")
    if more := sum(map(len, runs[MOST_FIXES:])):
        found.append(" " + ngettext("and {n:,} more", "and {n:,} more", more))
    return [*found, f"; {advice}"] if advice else found


def build_detail(view: View) -> Sequence[blocks.Section]:
    """Return what is said of routes and rooms, then the wide tables of segments and of pieces near them."""
    found = view.run.route_tables
    columns = route_columns(
        has_anchors=any(one.blocked_if_anchors_fail for one in found.routes),
        has_unknown=any(one.unknown_segments or one.unknown_routes or one.unknown_rooms for one in found.floors),
    )
    widths = blocks.table(
        blocks.list_columns((_("Clear width"), "w36"), (_("Publication"), "")),
        ((blocks.join_words(asked, blocks.BREAK), publication) for publication, asked in route.list_widths()),
        "widths few",
    )
    which = _("Which of these widths applies is to be entered as Required width in the workbook.")
    shown: Mapping[str, Show] = {
        "floor": lambda one: blocks.head(words.cut(view.floor_titles[one.floor], 40)),
        "any_room_cut_off_probability": lambda one: _say_perhaps(one.any_room_cut_off),
    }
    by_floor: list[blocks.Block] = [blocks.Heading(_("Routes by floor")), _build_table(
        columns["floors"], (_build_row(columns["floors"], one, shown) for one in found.floors), "route-floors",
        _("A route counts on every floor on which it has segments, as blocked there if its segments of that floor "
          "alone cut off what it serves. Left out: pieces without a usable position or route."),
    )]  # fmt: skip
    listed: list[blocks.Block] = [
        *_list_routes(view, columns["routes"]), *_list_steps(view), *_list_rooms(view, columns["rooms"]),
        *(by_floor if found.floors else []),
        blocks.Heading(_("Assumptions of the evaluation")),
        blocks.Box([blocks.Bullets(route.list_cautions(found))], "caution"),
        blocks.Heading(_("Widths required by codes and guidance")),
        blocks.Paragraph(f"{route.say_default_width()} {which}", "lead-in"),
        widths,
    ]  # fmt: skip
    wide = [*_list_segments(view, columns["segments"]), *_list_beside(view, columns["beside"])]
    return [blocks.Section(listed), blocks.Section(wide, "wide", "route-segments")]


def _build_row(columns: Sequence[PageColumn], one: Any, shown: Mapping[str, Show], id_: str = "") -> blocks.Row:
    """Return a row of the fields of a table, some of them shown otherwise than their values."""
    return blocks.Row([shown[each.key](one) if each.key in shown else each.cell(one) for each in columns], id=id_)


def _build_table(
    columns: Sequence[PageColumn], rows: Iterable[blocks.Row], kind: str, caption: blocks.Words
) -> blocks.Table:
    return blocks.table([one.column for one in columns], rows, kind, caption, is_named=True)


def _say_state(one: SegmentRow | RouteRow, text: str) -> blocks.Words:
    state = show_state(one.state, text)
    if not one.evaluated or one.under_record is None:
        return state
    recorded = _("record: {state}", state=route.say_state(one.under_record))
    return [state, blocks.BREAK, blocks.note(recorded)]


def _say_perhaps(chance: Chance | None, *, is_known: bool = True) -> str:
    return route.say_chance(chance) if chance is not None and is_known else words.DASH


def _list_routes(view: View, columns: Sequence[PageColumn]) -> list[blocks.Block]:
    found = view.run.route_tables
    caption = [_("Bounds: pieces fall independently / fully correlated.")]
    if any(one.under_record is not None for one in found.routes):
        caption.append(_("Record: state under the recorded motion itself; pieces that were not simulated are assumed "
                         "to stand."))  # fmt: skip

    def say_bounds(one: RouteRow) -> blocks.Words:
        if one.missing:
            return route.say_missing(one.missing)
        if one.blocked is None or not one.evaluated:
            return words.DASH
        left_out = route.say_left_out(one.unevaluated_segments)
        basis = blocks.note("; ".join(filter(None, (route.say_basis(one.blocked), left_out))))
        return [route.say_bounds(one.blocked), blocks.BREAK, basis] if one.blocked.pieces else basis

    shown: Mapping[str, Show] = {
        "route": lambda one: blocks.head(words.cut(one.route, 40)),
        "floors": lambda one: route.name_few(one.floors),
        "state": lambda one: _say_state(one, route.say_outlook(one, found.risk)),
        "blocked_probability": route.say_blocked,
        "blocked_or_reduced_probability": route.say_taken,
        "blocked_is_joint": say_bounds,
        "blocked_if_anchors_fail_probability":
            lambda one: _say_perhaps(one.blocked_if_anchors_fail, is_known=one.evaluated),
        "most_likely_piece": lambda one: view.name_piece(one.most_likely_piece.item_index)
        if one.most_likely_piece is not None and one.is_fixed else words.DASH,
    }  # fmt: skip
    chosen = route.choose_rows(found.routes, MOST_ROUTES, route.find_chance)
    rows = [_build_row(columns, one, shown) for one in chosen]
    return [
        blocks.Heading(_("Routes")),
        _build_table(columns, rows, "routes", " ".join(caption)),
        *say_left(len(found.routes) - len(chosen), is_likely=True),
    ]


def _list_steps(view: View) -> list[blocks.Block]:
    found = view.run.route_tables
    listed: list[blocks.Block] = [blocks.Heading(_("What to fix for each route"))]
    steps = [(one, at, step) for one in found.routes for at, step in enumerate(one.fixes, start=1)]
    if steps:
        lead = blocks.rich(_("The smallest set of rows found that opens each route: its whole range is below {risk} "
                             "<em>if the anchors hold</em>. Anchor all pieces of a row, or move them away. Fix all "
                             "listed rows; fixing only some may have no effect, as pieces that fall together must all "
                             "be fixed."), risk=route.say_risk(found.risk))  # fmt: skip
        bound = then = ""
        if any(one.fixes and one.blocked_if_unconfirmed_fall for one in found.routes):
            bound = _("Pieces whose class is not confirmed count as fallen in these chances, which is on the safe "
                      "side.")  # fmt: skip
        if any(one.missing_after for one in found.routes):
            then = _("A route that is not known then says what to fill in.")
        heads = blocks.list_columns(
            (_("Route"), "w24"), (_("Step"), "w6", "num"), (_("Piece"), ""), (_("Reduces by"), "w14", "num"),
            (_("Leaves"), "w14", "num"), (_("Then"), "w24"),
        )  # fmt: skip
        rows = [
            blocks.Row(
                (words.cut(one.route, 40), str(at), view.name_row(step.item_index, 40), words.deviation(step.gain),
                 words.percent(step.left),
                 (route.say_missing_after(one) or _("open")) if at == len(one.fixes) else ""),
                "first" if at == 1 else "")
            for one, at, step in steps[:MOST_STEPS]
        ]  # fmt: skip
        listed += [blocks.Paragraph(blocks.join_words((lead, bound, then)), "lead-in"),
                   blocks.table(heads, rows, "steps"), *say_left(len(steps) - MOST_STEPS)]  # fmt: skip
    unfixable = route.list_unfixable(found)
    if unfixable:
        lead = [_("Blocked with nothing fallen, so that no anchor helps: widen them, or move what stands inside; check "
                  "the Clear width.")]  # fmt: skip
        lines = [f"{words.cut(one.route, 40)}: {where or words.DASH}" for one, where in unfixable[:MOST_ROUTES]]
        listed += [blocks.Paragraph(lead, "lead-in"), blocks.Bullets(lines), *say_left(len(unfixable) - MOST_ROUTES)]
    names = [words.cut(one.route, 40) for one in found.routes if one.state == RouteState.OPEN]
    if names:
        text = ngettext("{n:,} route is open as it is: {names}.", "{n:,} routes are open as they are: {names}.",
                        len(names), names=words.name_first(names, 12))  # fmt: skip
        listed.append(blocks.Paragraph(text))
    return listed


def _list_rooms(view: View, columns: Sequence[PageColumn]) -> list[blocks.Block]:
    found, heading = view.run.route_tables, blocks.Heading(_("Rooms"))
    chosen = route.choose_rows(found.rooms, MOST_ROOMS, lambda one: one.loses_every_exit.probability)
    if not chosen:
        return [heading, blocks.Paragraph(_("No room has a way out in the workbook, so none is evaluated."))]
    caption = _("Chance that a room loses all exits; where it has no exit, all stairs, beyond which nothing is known. "
                "The first way out is the safest; others share as few segments with it as possible, and name those "
                "that they share.")  # fmt: skip

    def list_ways(one: RoomRow) -> blocks.Words:
        lines: blocks.Runs = [f"{at}. {route.say_way(way, found)}" for at, way in enumerate(one.ways, start=1)]
        lines += [_("no other way")] if len(one.ways) == 1 else []
        return blocks.join_words([*lines, route.say_left_out(one.unevaluated_segments)], blocks.BREAK)

    shown: Mapping[str, Show] = {
        "room": lambda one: blocks.head(words.cut(one.room, 40)),
        "exits": lambda one: _("stairs: {names}", names=route.name_few(one.exits)) if one.by_stairs
        else route.name_few(one.exits),
        "state": lambda one: show_state(one.state, route.say_room_state(one)),
        "loses_every_exit_probability": route.say_lost,
        "loses_if_anchors_fail_probability": lambda one: _say_perhaps(one.loses_if_anchors_fail),
        "most_likely_piece": lambda one: view.name_piece(one.most_likely_piece.item_index)
        if one.most_likely_piece is not None else words.DASH,
        "ways": list_ways,
    }  # fmt: skip
    rows = [_build_row(columns, one, shown) for one in chosen]
    left = say_left(len(found.rooms) - len(chosen), is_likely=True)
    return [heading, _build_table(columns, rows, "rooms", caption), *left]


def _list_segments(view: View, columns: Sequence[PageColumn]) -> list[blocks.Block]:
    found = view.run.route_tables
    caption = _("Widths in {unit}. Width now: with nothing fallen; all fallen: what is left with every free-standing "
                "piece fallen. Bounds: independent / fully correlated.", unit=measures.unit("m"))  # fmt: skip

    def say_bounds(one: SegmentRow) -> str:
        is_known = one.evaluated and one.state != RouteState.NOT_KNOWN
        return route.say_bounds(one.blocked) if one.blocked and is_known else words.DASH

    def list_remarks(one: SegmentRow) -> blocks.Words:
        fail = one.blocked_if_anchors_fail
        rooms = ", ".join(name for part in (one.room or "").split(";") if (name := part.strip()))
        items = [view.results[other.item_index].item for other in one.other_rooms]
        others = [f"{words.cut(item.item, 20)} ({words.cut(item.room, 20)})" if item.room else words.cut(item.item, 20)
                  for item in items]  # fmt: skip
        named = words.name_first(others, route.MOST_NAMED)
        parts: list[blocks.Words] = [
            route.say_missing(one.missing),
            route.say_occupants(one) if one.needed_width_m is not None else "",
            _("if anchors fail: blocked in {chance}", chance=route.say_chance(fail)) if fail else "",
            _("room: {rooms}", rooms=words.cut(rooms, 40)) if one.room else "",
            _("not counted, in another room: {pieces}", pieces=named) if others else "",
            flags(flag for flag in one.flags if flag != "own_rooms"),
            words.clip(one.notes, 80),
        ]
        return blocks.join_words(parts, "; ") or words.DASH

    shown: Mapping[str, Show] = {
        "segment": lambda one: blocks.head(route.say_segment(one)),
        "floor": lambda one: words.cut(one.floor or "", 20) or words.DASH,
        "from_place": lambda one: f"{words.cut(one.from_place or '', 40)} – {words.cut(one.to_place or '', 40)}",
        "state": lambda one: _say_state(one, route.say_outlook(one, found.risk)),
        "blocked_probability": route.say_blocked,
        "blocked_independent": say_bounds,
        "blocked_or_reduced_probability": route.say_taken,
        "needed_width_m": list_remarks,
    }
    rows = [_build_row(columns, one, shown, f"segment-{number}") for number, one in view.shown_segments]
    left_out = sum(map(route.is_untouched, found.segments)) if view.for_print else 0
    text = ngettext("{n:,} segment that no piece reaches is left out; the Excel report has all.",
                    "{n:,} segments that no piece reaches are left out; the Excel report has all.",
                    left_out)  # fmt: skip
    return [
        blocks.Heading(_("Segments")),
        _build_table(columns, rows, "segments", caption),
        *([blocks.Paragraph(text, "small")] if left_out else []),
        *say_left(len(found.segments) - left_out - len(view.shown_segments), is_likely=True),
    ]


def _list_beside(view: View, columns: Sequence[PageColumn]) -> list[blocks.Block]:
    """Return the pieces that reach segments, the segments most likely to be blocked first, and what the marks mean.

    A segment that no piece reaches is there only if it is too narrow as it stands.
    """
    likeliest = sorted(view.run.route_tables.segments, key=lambda one: -route.find_chance(one))
    named = [one for one in likeliest if one.pieces or one.insufficient_for_occupants or one.is_blocked_standing]
    beside = [(one, near) for one in named for near in (one.pieces or (None,))]
    found: list[blocks.Block] = [blocks.Heading(_("The pieces that matter"))]
    if beside:
        caption = _("The segments most likely to be blocked come first. Distance to the edge of the route, how far the "
                    "piece lies in it once fallen, and the width that it alone leaves, in {unit}. Falls and blocked: "
                    "chance that it falls and the segment is blocked, of a row that at least one of its pieces does; "
                    "for an anchored one, if anchors fail.", unit=measures.unit("m"))  # fmt: skip
        heads = [
            blocks.Column(_("Segment"), "segment"), blocks.Column(_("Floor"), "floor"),
            *(blocks.Column(one.heading, one.column.width, one.is_number) for one in columns),
            blocks.Column(_("Overturns"), "overturns", is_number=True), blocks.Column(_("Marks")),
        ]  # fmt: skip
        shown: Mapping[str, Show] = {
            "item": lambda row: view.name_row(row.item_index),
            "by_plan": lambda row: _("the plan") if row.by_plan else _("Edge distance"),
        }
        rows = []
        for one, near in beside[:MOST_BESIDE]:
            cells = [route.say_segment(one), words.cut(one.floor or "", 20) or words.DASH]
            if near is None:
                none = blocks.Cell(_("no piece reaches it"), columns=len(columns) + 1)
                rows.append(blocks.Row([*cells, none, flags(one.flags)]))
                continue
            piece = view.results[near.item_index]
            sign = "" if piece.is_anchored else f" {piece.adopted.risk.symbol}"
            anchored = words.apart_label("anchored") if piece.is_anchored else ""
            rows.append(blocks.Row([
                *cells, *_build_row(columns, near, shown).cells, f"{words.chance(piece)}{sign}",
                blocks.join_words((anchored, flags(near.flags))),
            ]))  # fmt: skip
        found.append(blocks.table(heads, rows, "beside", caption, is_named=True))
        found += say_left(len(beside) - MOST_BESIDE)
    else:
        found.append(blocks.Paragraph(_("No piece reaches any segment.")))
    meanings = route.list_flags(view.run.route_tables)
    return [*found, blocks.Terms([(say_flag(flag), text) for flag, text in meanings.items()])] if meanings else found


PARTS = (
    Part(key="routes", heading=fill("Evacuation routes"), places={"client": 30, "all": 30}, build=build_page,
         is_shown=lambda view: view.run.has_routes),
    Part(key="routes_detail", heading=fill("Evacuation routes in detail"), places={"annex": 100, "all": 100},
         build=build_detail, is_shown=lambda view: view.run.has_routes),
)  # fmt: skip
