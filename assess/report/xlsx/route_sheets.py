"""The sheets on evacuation routes: Routes (segments, routes, floors), Route pieces (with steps), Route rooms.

All of it is as run.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from assess.fields import route_fields
from assess.i18n import gettext as _
from assess.report import words
from assess.report.content import Content
from assess.report.say import route as say
from assess.report.say.work import list_steps
from assess.report.xlsx.item_formulas import ANCHORED, build_terms
from assess.report.xlsx.pen import CHANCE, COUNT, Column, Pen, of_field
from assess.results import ItemResult
from assess.route_results import (
    FLAGS,
    BesideRow,
    FloorRoutesRow,
    RoomRow,
    RouteRow,
    RouteState,
    RouteTables,
    SegmentRow,
    WayRow,
)
from assess.workbook.formulas import say_class

Read = Callable[[Any], Any]


def _of(row: type, *keys: str, **more: Any) -> list[Column]:
    """Return the columns of fields of a row by their keys; `more` are parameters of `Column` that differ."""
    return [of_field(route_fields(row)[key], **more) for key in keys]


def _said(row: type, key: str, width: int, read: Read) -> Column:
    """Return the column of a field that the sheet puts in words."""
    return of_field(route_fields(row)[key], width=width, read=read, format="")


def _known(row: type, key: str, width: int, is_known: Callable[[Any], bool]) -> Column:
    """Return the column of a number that is blank where it is not known."""
    field = route_fields(row)[key]
    return of_field(field, width=width, read=lambda one: field.read(one) if is_known(one) else None)


def _yes_or_no(holds: bool) -> str:
    return _("yes") if holds else _("no")


def _say_flags(flags: Sequence[str]) -> str:
    return "; ".join(_(FLAGS[flag]) for flag in flags)


def _name_piece(one: Any) -> str:
    return one.most_likely_piece.item if one.most_likely_piece else ""


# ---------------------------------------------------------------- Routes


def write_routes(pen: Pen, page: Any, content: Content) -> None:
    """Write every segment, every route and every floor with its chances."""
    routes = content.run.route_tables
    columns = _segment_columns(routes)
    widths = [one.width for one in columns]
    if not content.run.has_routes:
        message = Column(columns[0].label, columns[0].width, str)
        rest = [Column(one.label, one.width, lambda _row: None) for one in columns[1:]]
        pen.listing(page, [message, *rest], [_("The workbook names no routes.")])
        return
    row = pen.listing(page, columns, routes.segments)
    for letter in "GJ":
        pen.bar(page, f"{letter}2:{letter}{row}")
    row = pen.below(page, row + 1, _("Routes"), _route_columns(routes), widths, routes.routes)
    row = pen.below(page, row + 1, _("To be expected floor by floor"), _floor_columns(), widths, routes.floors)
    as_run = _("All of this is as run: it does not follow when a cell of another sheet is edited.")
    for at, text in enumerate((as_run, *say.list_cautions(routes)), row + 2):
        page.write_string(at, 0, text)
    page.freeze_panes(1, 2)
    page.repeat_columns(0, 1)
    page.fit_to_pages(2, 0)


def _segment_columns(routes: RouteTables) -> list[Column]:
    return [
        *_of(SegmentRow, "route", width=16),
        *_of(SegmentRow, "segment", width=18),
        *_of(SegmentRow, "floor", width=10),
        *_of(SegmentRow, "from_place", "to_place", width=18),
        _said(SegmentRow, "state", 26, lambda one: say.say_segment_state(one, routes.risk)),
        *_outlook(SegmentRow),
        *_of(SegmentRow, "clear_width_used_m", "required_width_used_m", width=10),
        *_of(SegmentRow, "standing_width_m", width=11),
        *_of(SegmentRow, "least_width_m", width=10),
        *_of(SegmentRow, "occupants", width=11),
        *_of(SegmentRow, "needed_width_m", width=10),
        _said(SegmentRow, "insufficient_for_occupants", 13, _say_insufficient),
        *_of(SegmentRow, "insufficient_after_falls_probability", width=11),
        *_of(SegmentRow, "room", width=18),
        _said(SegmentRow, "other_rooms", 24, lambda one: ", ".join(other.item for other in one.other_rooms)),
        _said(SegmentRow, "flags", 60, lambda one: _say_flags(one.flags)),
        *_of(SegmentRow, "notes", width=40),
    ]


def _say_insufficient(one: SegmentRow) -> str:
    return "" if one.needed_width_m is None else _yes_or_no(one.insufficient_for_occupants)


def _outlook(row: type) -> list[Column]:
    """Return the chances of a segment or a route; blank where it is not evaluated: a 0 would say more than is known.

    Where it is not known, only the chance with unconfirmed pieces fallen is there, and what settles it.
    """

    def of(read: Read) -> Read:
        return lambda one: None if one.blocked is None else read(one)

    names = ("blocked_probability", "blocked_low", "blocked_high", "blocked_or_reduced_probability",
             "blocked_independent", "blocked_correlated")  # fmt: skip
    return [
        *(_known(row, name, 11, lambda one: one.state != RouteState.NOT_KNOWN) for name in names),
        *_of(row, "blocked_if_unconfirmed_fall_probability", width=13),
        _said(row, "missing", 30, lambda one: say.say_missing(one.missing)),
        *_of(row, "blocked_if_anchors_fail_probability", width=11),
        _said(row, "under_record", 13, of(lambda one: say.say_recorded(one) if one.under_record is not None else "")),
        _said(row, "most_likely_piece", 14, of(_name_piece)),
        *_of(row, "blocked_pieces", width=8),
        *_of(row, "blocked_unverified", width=9),
        _said(row, "blocked_is_joint", 30, of(lambda one: say.say_basis(one.blocked))),
    ]


def _route_columns(routes: RouteTables) -> list[Column]:
    return [
        *_of(RouteRow, "route"),
        _said(RouteRow, "fixes", 0, _name_fixes),
        _said(RouteRow, "floors", 0, lambda one: ", ".join(one.floors)),
        _said(RouteRow, "from_places", 0, lambda one: ", ".join(one.from_places)),
        _said(RouteRow, "to_places", 0, lambda one: ", ".join(one.to_places)),
        _said(RouteRow, "state", 0, lambda one: say.say_route_state(one, routes.risk)),
        *_outlook(RouteRow),
        Column(_("Chance left then"), 0, lambda one: one.fixes[-1].left if one.fixes else None, CHANCE),
        of_field(route_fields(RouteRow)["segment_indices"], read=lambda one: len(one.segment_indices), format=COUNT),
        _said(RouteRow, "decisive_segment", 0, lambda one: _name_segment(routes, one.decisive_segment)),
        _said(RouteRow, "unevaluated_segments", 0, lambda one: ", ".join(one.unevaluated_segments)),
        _said(RouteRow, "missing_after", 0, lambda one: say.say_missing(one.missing_after)),
    ]


def _floor_columns() -> list[Column]:
    return [
        *_of(FloorRoutesRow, "floor", "segments", "blocked_segments_expected", "unknown_segments"),
        *_of(FloorRoutesRow, "routes", "blocked_routes_expected", "unknown_routes"),
        *_of(FloorRoutesRow, "rooms", "cut_off_rooms_expected", "unknown_rooms"),
        *_of(FloorRoutesRow, "any_room_cut_off_probability", "any_room_cut_off_low", "any_room_cut_off_high", width=0),
        *_of(FloorRoutesRow, "uncounted_pieces"),
    ]


# ---------------------------------------------------------------- Route pieces


@dataclass(frozen=True, slots=True)
class _Beside:
    """A piece beside a segment; in the list of steps it stands for itself."""

    segment: SegmentRow
    near: BesideRow
    result: ItemResult


@dataclass(frozen=True, slots=True)
class _Step:
    """A step of a route, or a route that no step fixes: then `result` is None."""

    route: str
    text: str
    floor: str
    result: ItemResult | None
    before: float
    after: float


def has_pieces(content: Content) -> bool:
    """Tell whether any piece stands beside a segment, or a route is blocked as it stands."""
    routes = content.run.route_tables
    return any(one.pieces for one in routes.segments) or bool(say.list_unfixable(routes))


def write_route_pieces(pen: Pen, page: Any, content: Content) -> None:
    """Write the pieces beside every segment, and the steps of every route."""
    routes, results, columns = content.run.route_tables, content.results, _beside_columns()
    rows = [_Beside(one, near, results[near.item_index]) for one in routes.segments for near in one.pieces]
    below = pen.listing(page, columns, rows)
    page.repeat_columns(0, 3)
    if rows:
        pen.bar(page, f"H2:H{below}")
    title = _("What to anchor or move for each route, step by step")
    widths = [one.width for one in columns]
    pen.below(page, below + 1, title, _step_columns(), widths, list(_steps(routes, results)))


def _piece_columns() -> list[Column]:
    def of(read: Callable[[ItemResult], Any]) -> Read:
        return lambda row: None if row.result is None else read(row.result)

    return [
        _said(BesideRow, "item", 14, of(lambda one: one.item.item)),
        Column(_("Description"), 30, _describe),
        Column(_("Pieces"), 8, of(lambda one: one.item.quantity), COUNT),
        Column(_("Class (as run)"), 34, of(_say_class)),
    ]


def _describe(row: _Beside | _Step) -> str:
    if row.result is None:
        return row.text if isinstance(row, _Step) else ""
    return row.result.item.description or row.result.item.type


def _say_class(one: ItemResult) -> str:
    if one.is_anchored:
        bracket = words.say_bracket(one)
        return ANCHORED + "; ".join([words.risk_words(one), *([bracket] if bracket else [])])
    return ", ".join([say_class(one.adopted.risk), *words.risk_notes(one)])


def _beside_columns() -> list[Column]:
    def near(key: str, width: int, **more: Any) -> Column:
        field = route_fields(BesideRow)[key]
        return of_field(field, **{"width": width, "read": lambda row: field.read(row.near), **more})

    bases = build_terms().bases
    return [
        _said(SegmentRow, "route", 16, lambda row: row.segment.route),
        _said(SegmentRow, "segment", 18, lambda row: row.segment.segment),
        _said(SegmentRow, "floor", 9, lambda row: row.result.item.floor),
        *_piece_columns(),
        Column(_("Chance of overturning"), 11, lambda row: row.result.adopted.probability, CHANCE),
        Column(_("Basis"), 12, lambda row: bases[row.result.adopted.basis]),
        near("falls_while_blocked", 14),
        near("distance_m", 11),
        near("reach_m", 10),
        near("left_m", 11),
        near("blocks_alone", 9, read=lambda row: _yes_or_no(row.near.blocks_alone)),
        near("by_plan", 14, read=lambda row: _("plan") if row.near.by_plan else _("Edge distance")),
        near("flags", 60, read=_say_remarks),
    ]


def _say_remarks(row: _Beside) -> str:
    held = _("anchored: its chances are those without the anchor") if row.result.is_anchored else ""
    return "; ".join(filter(None, (held, _say_flags(row.near.flags))))


def _step_columns() -> list[Column]:
    return [
        _said(SegmentRow, "route", 0, lambda row: row.route),
        Column(_("Step"), 0, lambda row: row.text if row.result else ""),
        _said(SegmentRow, "floor", 0, lambda row: row.floor),
        *_piece_columns(),
        Column(_("Chance blocked before"), 0, lambda row: row.before, CHANCE),
        Column(_("Chance blocked after"), 0, lambda row: row.after, CHANCE),
    ]


def _steps(routes: RouteTables, results: Sequence[ItemResult]) -> Iterator[_Step]:
    """Yield every step of every route; then the routes that no step fixes."""
    for step in list_steps(routes):
        one = results[step.item_index]
        text = _("{place:,} of {steps:,}", place=step.place, steps=step.steps)
        yield _Step(step.route, text, one.item.floor, one, step.before, step.after)
    for route, where in say.list_unfixable(routes):
        text, chance = _("blocked with nothing fallen: {segments}", segments=where), say.find_chance(route)
        yield _Step(route.route, text, ", ".join(route.floors), None, chance, chance)


# ---------------------------------------------------------------- Route rooms


def write_route_rooms(pen: Pen, page: Any, content: Content) -> None:
    """Write every room with its safest way out, and the next, which shares as few segments with it as possible."""
    rooms = content.run.route_tables.rooms
    below = pen.listing(page, _room_columns(content.run.route_tables), rooms)
    pen.bar(page, f"I2:I{below}")
    page.freeze_panes(1, 1)
    page.repeat_columns(0)


def _room_columns(routes: RouteTables) -> list[Column]:
    return [
        *_of(RoomRow, "room", width=22),
        *_of(RoomRow, "floor", width=8),
        _said(RoomRow, "exits", 26, _say_exits),
        _said(RoomRow, "state", 18, say.say_room_state),
        _said(RoomRow, "decisive_segment", 24, lambda one: _name_segment(routes, one.decisive_segment)),
        _said(RoomRow, "fixes", 30, _name_fixes),
        _said(RoomRow, "missing", 30, lambda one: say.say_missing(one.missing)),
        _said(RoomRow, "missing_after", 30, lambda one: say.say_missing(one.missing_after)),
        *(
            _known(RoomRow, f"loses_every_exit_{part}", width, lambda one: one.is_known)
            for part, width in (("probability", 11), ("low", 9), ("high", 9), ("independent", 12), ("correlated", 10))
        ),
        *_of(RoomRow, "loses_if_unconfirmed_fall_probability", width=12),
        *_of(RoomRow, "loses_if_anchors_fail_probability", width=9),
        _said(RoomRow, "most_likely_piece", 14, _name_piece),
        _said(RoomRow, "loses_every_exit_is_joint", 30, lambda one: say.say_basis(one.loses_every_exit)),
        of_field(route_fields(RoomRow)["ways"], width=8, read=lambda one: len(one.ways), format=COUNT),
        *_way_columns(routes, 0, (_("Safest way: to"), _("Safest way: by"), _("Safest way: chance of a blockage"))),
        *_way_columns(routes, 1, (_("Alternative: to"), _("Alternative: by"), _("Alternative: chance of a blockage"))),
        Column(_("Alternative: shared with the safest way"), 40, lambda one: _name(routes, _shared(one))),
        _said(RoomRow, "unevaluated_indices", 40, lambda one: _name(routes, one.unevaluated_indices)),
    ]


def _way_columns(routes: RouteTables, place: int, labels: tuple[str, str, str]) -> list[Column]:
    def of(read: Callable[[WayRow], Any]) -> Read:
        return lambda one: read(one.ways[place]) if len(one.ways) > place else None

    def chance(way: WayRow) -> float | None:
        return way.blocked.probability if way.is_known else None

    return [
        Column(labels[0], 16, of(lambda way: way.end)),
        Column(labels[1], 60, of(lambda way: _name(routes, way.segment_indices))),
        Column(labels[2], 11, of(chance), CHANCE),
    ]


def _name_fixes(one: RouteRow | RoomRow) -> str:
    return ", ".join(fix.item for fix in one.fixes)


def _name_segment(routes: RouteTables, at: int | None) -> str:
    return "" if at is None else _name(routes, [at])


def _shared(one: RoomRow) -> list[int]:
    """Return the segments of the alternative that the safest way has, too."""
    ways = [way.segment_indices for way in one.ways[:2]]
    return [at for at in ways[1] if at in ways[0]] if len(ways) > 1 else []


def _name(routes: RouteTables, segments: Iterable[int]) -> str:
    return ", ".join(f"{routes.segments[at].route}: {routes.segments[at].segment}" for at in segments)


def _say_exits(one: RoomRow) -> str:
    exits = ", ".join(one.exits)
    return _("{stairs} (stairs: beyond them nothing is known)", stairs=exits) if one.by_stairs else exits
