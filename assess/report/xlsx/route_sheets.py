"""The sheets on evacuation routes: Routes (segments, routes, floors), Route pieces (with steps), Route rooms.

All of it is as run.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from assess.i18n import gettext as _
from assess.report import words
from assess.report.content import Content
from assess.report.findings import route_words as say
from assess.report.ranking import list_steps
from assess.report.xlsx.item_formulas import ANCHORED
from assess.report.xlsx.pen import CHANCE, COUNT, Column, Pen, with_unit
from assess.results import ItemResult
from assess.route_results import FLAGS, BesideRow, Chance, RoomRow, RouteTables, SegmentRow, WayRow
from assess.workbook.formulas import say_class

Read = Callable[[Any], Any]


def _metres(label: str, width: int, read: Read) -> Column:
    return Column(with_unit(label, "m"), width, read, "0.00")


def _chance(label: str, width: int, read: Callable[[Any], Chance | None], name: str = "probability") -> Column:
    """Return the column of one number of a chance; blank where there is no chance."""

    def value(row: Any) -> float | None:
        found = read(row)
        return None if found is None else getattr(found, name)

    return Column(label, width, value, CHANCE)


def _interval(read: Callable[[Any], Chance | None], width: int = 9) -> list[Column]:
    return [_chance(_("Interval low"), width, read, "low"), _chance(_("Interval high"), width, read, "high")]


def _yes_or_no(holds: bool) -> str:
    return _("yes") if holds else _("no")


def _say_flags(flags: Sequence[str]) -> str:
    """Return the cautions on a segment or a piece beside it in words."""
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
        Column(_("Route"), 16, lambda one: one.route),
        Column(_("Segment"), 18, lambda one: one.segment),
        Column(_("Floor"), 10, lambda one: one.floor),
        Column(_("From"), 18, lambda one: one.from_place),
        Column(_("To"), 18, lambda one: one.to_place),
        Column(_("State"), 26, lambda one: say.say_segment_state(one, routes.risk)),
        *_outlook(),
        _metres(_("Clear width"), 10, lambda one: one.clear_width_used_m),
        _metres(_("Required width"), 10, lambda one: one.required_width_used_m),
        _metres(_("Width now"), 11, lambda one: one.standing_width_m),
        _metres(_("Width if all fall"), 10, lambda one: one.least_width_m),
        Column(_("Occupants"), 11, lambda one: one.occupants, COUNT),
        _metres(_("Width that they need"), 10, lambda one: one.needed_width_m),
        Column(_("Insufficient for occupants"), 13, _say_insufficient),
        _chance(_("Chance too narrow for occupants"), 11, lambda one: one.insufficient_after_falls),
        Column(_("Room"), 18, lambda one: one.room),
        Column(_("Not counted, in another room"), 24, lambda one: ", ".join(other.item for other in one.other_rooms)),
        Column(_("Remarks"), 60, lambda one: _say_flags(one.flags)),
        Column(_("Notes"), 40, lambda one: one.notes),
    ]


def _say_insufficient(one: SegmentRow) -> str:
    return "" if one.needed_width_m is None else _yes_or_no(one.insufficient_for_occupants)


def _outlook() -> list[Column]:
    """Return the chances of a segment or a route; blank where it is not evaluated: a 0 would say more than is known."""

    def of(read: Read) -> Read:
        return lambda one: None if one.blocked is None else read(one)

    return [
        _chance(_("Chance blocked"), 11, lambda one: one.blocked),
        *_interval(lambda one: one.blocked, 11),
        _chance(_("Chance blocked or reduced"), 11, lambda one: one.blocked_or_reduced),
        _chance(_("Blocked, all independent"), 11, lambda one: one.blocked, "independent"),
        _chance(_("Blocked, fully correlated"), 11, lambda one: one.blocked, "correlated"),
        _chance(_("Blocked if anchors fail"), 11, lambda one: one.blocked_if_anchors_fail),
        Column(
            _("Under the record"), 13, of(lambda one: say.say_recorded(one) if one.under_record is not None else "")
        ),
        Column(_("Most likely piece"), 14, of(_name_piece)),
        Column(_("Pieces"), 8, of(lambda one: one.blocked.pieces), COUNT),
        Column(_("By the formula alone"), 9, of(lambda one: one.blocked.unverified), COUNT),
        Column(_("Basis"), 30, of(lambda one: say.say_basis(one.blocked))),
    ]


def _route_columns(routes: RouteTables) -> list[Column]:
    return [
        Column(_("Route"), 0, lambda one: one.route),
        Column(_("Floors"), 0, lambda one: ", ".join(one.floors)),
        Column(_("Segments"), 0, lambda one: len(one.segment_indices), COUNT),
        Column(_("Pieces to anchor or move"), 0, lambda one: ", ".join(fix.item for fix in one.fixes)),
        Column(_("Segments not evaluated"), 0, lambda one: ", ".join(one.unevaluated_segments)),
        Column(_("State"), 0, lambda one: say.say_route_state(one, routes.risk)),
        *_outlook(),
        Column(_("Chance left then"), 0, lambda one: one.fixes[-1].left if one.fixes else None, CHANCE),
    ]


def _floor_columns() -> list[Column]:
    return [
        Column(_("Floor"), 0, lambda one: one.floor),
        Column(_("Segments"), 0, lambda one: one.segments, COUNT),
        Column(_("Blocked segments expected"), 0, lambda one: one.blocked_segments_expected, "0.00"),
        Column(_("Routes"), 0, lambda one: one.routes, COUNT),
        Column(_("Blocked routes expected"), 0, lambda one: one.blocked_routes_expected, "0.00"),
        Column(_("Rooms"), 0, lambda one: one.rooms, COUNT),
        Column(_("Rooms expected to lose every exit"), 0, lambda one: one.cut_off_rooms_expected, "0.00"),
        _chance(_("Chance that any room does"), 0, lambda one: one.any_room_cut_off),
        *_interval(lambda one: one.any_room_cut_off, 0),
        Column(_("Pieces not counted"), 0, lambda one: one.uncounted_pieces, COUNT),
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
        Column(_("Item"), 14, of(lambda one: one.item.item)),
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
        return f"{ANCHORED}{words.risk_words(one)}"
    return ", ".join([say_class(one.adopted.risk), *words.risk_notes(one)])


def _beside_columns() -> list[Column]:
    return [
        Column(_("Route"), 16, lambda row: row.segment.route),
        Column(_("Segment"), 18, lambda row: row.segment.segment),
        Column(_("Floor"), 9, lambda row: row.result.item.floor),
        *_piece_columns(),
        Column(_("Chance of overturning"), 11, lambda row: row.result.adopted.probability, CHANCE),
        Column(_("Falls and blocked"), 14, lambda row: row.near.falls_while_blocked, CHANCE),
        _metres(_("From the edge of the route"), 11, lambda row: row.near.distance_m),
        _metres(_("Reaches into it"), 10, lambda row: row.near.reach_m),
        _metres(_("Width left beside it alone"), 11, lambda row: row.near.left_m),
        Column(_("Blocks alone"), 9, lambda row: _yes_or_no(row.near.blocks_alone)),
        Column(_("Known by"), 14, lambda row: _("plan") if row.near.by_plan else _("Edge distance")),
        Column(_("Remarks"), 60, _say_remarks),
    ]


def _say_remarks(row: _Beside) -> str:
    held = _("anchored: its chances are those without the anchor") if row.result.is_anchored else ""
    return "; ".join(filter(None, (held, _say_flags(row.near.flags))))


def _step_columns() -> list[Column]:
    return [
        Column(_("Route"), 0, lambda row: row.route),
        Column(_("Step"), 0, lambda row: row.text if row.result else ""),
        Column(_("Floor"), 0, lambda row: row.floor),
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
    pen.bar(page, f"D2:D{below}")
    page.freeze_panes(1, 1)
    page.repeat_columns(0)


def _room_columns(routes: RouteTables) -> list[Column]:
    return [
        Column(_("Room"), 22, lambda one: one.room),
        Column(_("Floor"), 8, lambda one: one.floor),
        Column(_("Exits that can be reached"), 26, _say_exits),
        _chance(_("Chance of losing every exit"), 11, lambda one: one.loses_every_exit),
        *_interval(lambda one: one.loses_every_exit),
        _chance(_("All independent"), 12, lambda one: one.loses_every_exit, "independent"),
        _chance(_("Fully correlated"), 10, lambda one: one.loses_every_exit, "correlated"),
        _chance(_("If anchors fail"), 9, lambda one: one.loses_if_anchors_fail),
        Column(_("Most likely piece"), 14, _name_piece),
        Column(_("Basis"), 30, lambda one: say.say_basis(one.loses_every_exit)),
        Column(_("Ways out"), 8, lambda one: len(one.ways), COUNT),
        *_way_columns(routes, 0, (_("Safest way: to"), _("Safest way: by"), _("Safest way: chance of a blockage"))),
        *_way_columns(routes, 1, (_("Alternative: to"), _("Alternative: by"), _("Alternative: chance of a blockage"))),
        Column(_("Alternative: shared with the safest way"), 40, lambda one: _name(routes, _shared(one))),
        Column(_("Segments not evaluated, taken as open"), 40, lambda one: _name(routes, one.unevaluated_indices)),
    ]


def _way_columns(routes: RouteTables, place: int, labels: tuple[str, str, str]) -> list[Column]:
    def of(read: Callable[[WayRow], Any]) -> Read:
        return lambda one: read(one.ways[place]) if len(one.ways) > place else None

    def chance(way: WayRow) -> float | None:
        is_known = any(routes.segments[at].evaluated for at in way.segment_indices)
        return way.blocked.probability if is_known else None

    return [
        Column(labels[0], 16, of(lambda way: way.end)),
        Column(labels[1], 60, of(lambda way: _name(routes, way.segment_indices))),
        Column(labels[2], 11, of(chance), CHANCE),
    ]


def _shared(one: RoomRow) -> list[int]:
    """Return the segments of the alternative that the safest way has, too."""
    ways = [way.segment_indices for way in one.ways[:2]]
    return [at for at in ways[1] if at in ways[0]] if len(ways) > 1 else []


def _name(routes: RouteTables, segments: Iterable[int]) -> str:
    """Return the names of segments with their routes."""
    return ", ".join(f"{routes.segments[at].route}: {routes.segments[at].segment}" for at in segments)


def _say_exits(one: RoomRow) -> str:
    exits = ", ".join(one.exits)
    return _("{stairs} (stairs: beyond them nothing is known)", stairs=exits) if one.by_stairs else exits
