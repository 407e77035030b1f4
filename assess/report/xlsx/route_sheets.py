"""The sheets on evacuation routes: Routes (segments, routes, floors), Route pieces (with steps), Route rooms.

All of it is as run. A table is named by the fields of its rows (`assess.fields.route_fields`), with the widths of
their columns; one that stands below another has its widths. Some fields the sheet puts in words.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from assess.fields import route_fields
from assess.i18n import gettext as _
from assess.report import words
from assess.report.content import Content
from assess.report.say import route as say
from assess.report.say.work import list_steps
from assess.report.xlsx.item_formulas import ANCHORED
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
)
from assess.workbook.formulas import say_class

Read = Callable[[Any], Any]

OUTLOOK: Mapping[str, int] = {
    "blocked_probability": 11, "blocked_low": 11, "blocked_high": 11, "blocked_or_reduced_probability": 11,
    "blocked_independent": 11, "blocked_correlated": 11, "blocked_if_unconfirmed_fall_probability": 13, "missing": 30,
    "blocked_if_anchors_fail_probability": 11, "under_record": 13, "most_likely_piece": 14, "blocked_pieces": 8,
    "blocked_unverified": 9, "blocked_is_joint": 30,
}  # fmt: skip
"""The chances of a segment or a route."""
CHANCES = tuple(OUTLOOK)[:6]
"""Blank where the state is not known: there is only the chance with unconfirmed pieces fallen, and what settles it."""
SEGMENTS: Mapping[str, int] = {
    "route": 16, "segment": 18, "floor": 10, "from_place": 18, "to_place": 18, "state": 26, **OUTLOOK,
    "clear_width_used_m": 10, "required_width_used_m": 10, "standing_width_m": 11, "least_width_m": 10,
    "occupants": 11, "needed_width_m": 10, "insufficient_for_occupants": 13,
    "insufficient_after_falls_probability": 11, "room": 18, "other_rooms": 24, "flags": 60, "notes": 40,
}  # fmt: skip
FLOORS = (
    "floor", "segments", "blocked_segments_expected", "unknown_segments", "routes", "blocked_routes_expected",
    "unknown_routes", "rooms", "cut_off_rooms_expected", "unknown_rooms", "any_room_cut_off_probability",
    "any_room_cut_off_low", "any_room_cut_off_high", "uncounted_pieces",
)  # fmt: skip
BESIDE: Mapping[str, int] = {
    "falls_while_blocked": 14, "distance_m": 11, "reach_m": 10, "left_m": 11, "blocks_alone": 9, "by_plan": 14,
    "flags": 60,
}  # fmt: skip
ROOMS: Mapping[str, int] = {
    "room": 22, "floor": 8, "exits": 26, "state": 18, "decisive_segment": 24, "fixes": 30, "missing": 30,
    "missing_after": 30, "loses_every_exit_probability": 11, "loses_every_exit_low": 9, "loses_every_exit_high": 9,
    "loses_every_exit_independent": 12, "loses_every_exit_correlated": 10,
    "loses_if_unconfirmed_fall_probability": 12, "loses_if_anchors_fail_probability": 9, "most_likely_piece": 14,
    "loses_every_exit_is_joint": 30, "ways": 8,
}  # fmt: skip


def _columns(row: type, chosen: Mapping[str, int] | Iterable[str], said: Mapping[str, Read]) -> list[Column]:
    """Return the columns of fields of a row; `said` are what reads those that the sheet puts in words."""
    fields, widths = route_fields(row), chosen if isinstance(chosen, Mapping) else dict.fromkeys(chosen, 0)
    return [of_field(fields[key], width=width, read=said.get(key, fields[key].read)) for key, width in widths.items()]


def _read_if(holds: Callable[[Any], bool], read: Read, one: Any) -> Any:
    """Return what is read where it is known: a 0 would say more than is known."""
    return read(one) if holds(one) else None


def _say_flags(flags: Sequence[str]) -> str:
    return "; ".join(_(FLAGS[flag]) for flag in flags)


def _list_said(routes: RouteTables) -> dict[str, Read]:
    return {
        "decisive_segment": lambda one: _name_segments(
            routes, [] if one.decisive_segment is None else [one.decisive_segment]
        ),
        "fixes": lambda one: ", ".join(fix.item for fix in one.fixes),
        "missing": lambda one: say.say_missing(one.missing),
        "missing_after": lambda one: say.say_missing(one.missing_after),
        "most_likely_piece": lambda one: one.most_likely_piece.item if one.most_likely_piece else "",
    }


def _name_segments(routes: RouteTables, places: Iterable[int]) -> str:
    return ", ".join(f"{routes.segments[at].route}: {routes.segments[at].segment}" for at in places)


def write_routes(pen: Pen, page: Any, content: Content) -> None:
    """Write every segment, every route and every floor with its chances."""
    routes = content.run.route_tables
    of_segment: dict[str, Read] = {
        "state": lambda one: say.say_outlook(one, routes.risk),
        "insufficient_for_occupants": lambda one: (
            "" if one.needed_width_m is None else words.yes_or_no(one.insufficient_for_occupants)
        ),
        "other_rooms": lambda one: ", ".join(other.item for other in one.other_rooms),
        "flags": lambda one: _say_flags(one.flags),
    }
    columns = _columns(SegmentRow, SEGMENTS, _list_outlook(SegmentRow, routes) | of_segment)
    widths = [one.width for one in columns]
    if not content.run.has_routes:
        message = replace(columns[0], read=str, format="")
        rest = [replace(one, read=lambda _row: None, format="") for one in columns[1:]]
        pen.listing(page, [message, *rest], [_("The workbook names no routes.")])
        return
    row = pen.listing(page, columns, routes.segments)
    for letter in "GJ":
        pen.bar(page, f"{letter}2:{letter}{row}")
    names = ("floors", "from_places", "to_places", "unevaluated_segments")
    of_route = _list_outlook(RouteRow, routes) | {
        "state": lambda one: say.say_outlook(one, routes.risk),
        **{key: partial(lambda key, one: ", ".join(getattr(one, key)), key) for key in names},
    }
    ways = [
        *_columns(RouteRow, ("route", "fixes", "floors", "from_places", "to_places", "state", *OUTLOOK), of_route),
        Column(_("Chance left then"), 0, lambda one: one.fixes[-1].left if one.fixes else None, CHANCE),
        of_field(route_fields(RouteRow)["segment_indices"], read=lambda one: len(one.segment_indices), format=COUNT),
        *_columns(RouteRow, ("decisive_segment", "unevaluated_segments", "missing_after"), of_route),
    ]
    row = pen.below(page, row + 1, _("Routes"), ways, widths, routes.routes)
    floors = _columns(FloorRoutesRow, FLOORS, {})
    row = pen.below(page, row + 1, _("To be expected floor by floor"), floors, widths, routes.floors)
    as_run = _("All of this is as run: it does not follow when a cell of another sheet is edited.")
    for at, text in enumerate((as_run, *say.list_cautions(routes)), row + 2):
        page.write_string(at, 0, text)
    page.freeze_panes(1, 2)
    page.repeat_columns(0, 1)
    page.fit_to_pages(2, 0)


def _list_outlook(row: type, routes: RouteTables) -> dict[str, Read]:
    """Return what reads the chances of a segment or a route; blank where it is not evaluated."""
    fields, said = route_fields(row), _list_said(routes)
    evaluated: dict[str, Read] = {
        "under_record": lambda one: "" if one.under_record is None else say.say_state(one.under_record),
        "most_likely_piece": said["most_likely_piece"],
        "blocked_is_joint": lambda one: say.say_basis(one.blocked),
    }
    return (
        said
        | {key: partial(_read_if, lambda one: one.state != RouteState.NOT_KNOWN, fields[key].read) for key in CHANCES}
        | {key: partial(_read_if, lambda one: one.blocked is not None, read) for key, read in evaluated.items()}
    )


@dataclass(frozen=True, slots=True)
class _Beside:
    """A piece next to a segment."""

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


def write_route_pieces(pen: Pen, page: Any, content: Content) -> None:
    """Write the pieces next to every segment, and the steps of every route."""
    routes, results, fields = content.run.route_tables, content.results, route_fields(BesideRow)

    held = _("anchored: its chances are those without the anchor")
    of_segment: dict[str, Read] = {
        "route": lambda row: row.segment.route,
        "segment": lambda row: row.segment.segment,
        "floor": lambda row: row.result.item.floor,
    }
    near: dict[str, Read] = {key: partial(lambda read, row: read(row.near), fields[key].read) for key in BESIDE} | {
        "blocks_alone": lambda row: words.yes_or_no(row.near.blocks_alone),
        "by_plan": lambda row: _("plan") if row.near.by_plan else _("Edge distance"),
        "flags": lambda row: "; ".join(
            filter(None, (held if row.result.is_anchored else "", _say_flags(row.near.flags)))
        ),
    }
    columns = [
        *_columns(SegmentRow, {"route": 16, "segment": 18, "floor": 9}, of_segment),
        *_list_piece_columns(),
        Column(_("Chance of overturning"), 11, lambda row: row.result.adopted.probability, CHANCE),
        Column(_("Basis"), 12, lambda row: pen.terms.bases[row.result.adopted.basis]),
        *_columns(BesideRow, BESIDE, near),
    ]
    rows = [_Beside(one, near, results[near.item_index]) for one in routes.segments for near in one.pieces]
    below = pen.listing(page, columns, rows)
    page.repeat_columns(0, 3)
    if rows:
        pen.bar(page, f"H2:H{below}")
    title = _("What to anchor or move for each route, step by step")
    heads = [
        *_columns(SegmentRow, ("route",), {"route": lambda row: row.route}),
        Column(_("Step"), 0, lambda row: row.text if row.result else ""),
        *_columns(SegmentRow, ("floor",), {"floor": lambda row: row.floor}),
        *_list_piece_columns(),
        Column(_("Chance blocked before"), 0, lambda row: row.before, CHANCE),
        Column(_("Chance blocked after"), 0, lambda row: row.after, CHANCE),
    ]
    steps = []
    for step in list_steps(routes):
        one, text = results[step.item_index], _("{place:,} of {steps:,}", place=step.place, steps=step.steps)
        steps.append(_Step(step.route, text, one.item.floor, one, step.before, step.after))
    for route, where in say.list_unfixable(routes):
        text, chance = _("blocked with nothing fallen: {segments}", segments=where), say.find_chance(route)
        steps.append(_Step(route.route, text, ", ".join(route.floors), None, chance, chance))
    pen.below(page, below + 1, title, heads, [one.width for one in columns], steps)


def _list_piece_columns() -> list[Column]:
    def of(read: Callable[[ItemResult], Any]) -> Read:
        return lambda row: None if row.result is None else read(row.result)

    def describe(row: _Beside | _Step) -> str:
        if row.result is None:
            return row.text if isinstance(row, _Step) else ""
        return row.result.item.description or row.result.item.type

    def classify(one: ItemResult) -> str:
        if one.is_anchored:
            return ANCHORED + "; ".join(filter(None, (words.risk_words(one), words.say_bracket(one))))
        return ", ".join([say_class(one.adopted.risk), *words.risk_notes(one)])

    return [
        *_columns(BesideRow, {"item": 14}, {"item": of(lambda one: one.item.item)}),
        Column(_("Description"), 30, describe),
        Column(_("Pieces"), 8, of(lambda one: one.item.quantity), COUNT),
        Column(_("Class (as run)"), 34, of(classify)),
    ]


def write_route_rooms(pen: Pen, page: Any, content: Content) -> None:
    """Write every room with its safest way out, and the next, which shares as few segments with it as possible."""
    routes = content.run.route_tables
    name, fields = partial(_name_segments, routes), route_fields(RoomRow)

    def name_shared(one: RoomRow) -> str:
        ways = [way.segment_indices for way in one.ways[:2]]
        return name([at for at in ways[1] if at in ways[0]]) if len(ways) > 1 else ""

    def of_way(place: int, read: Read) -> Read:
        return lambda one: read(one.ways[place]) if len(one.ways) > place else None

    said = _list_said(routes) | {
        **{key: partial(_read_if, lambda one: one.is_known, fields[key].read)
           for key in ROOMS if key.startswith("loses_every")},
        "exits": lambda one: ", ".join(one.exits) if not one.by_stairs
        else _("{stairs} (stairs: beyond them nothing is known)", stairs=", ".join(one.exits)),
        "state": say.say_room_state,
        "loses_every_exit_is_joint": lambda one: say.say_basis(one.loses_every_exit),
        "ways": lambda one: len(one.ways),
        "unevaluated_indices": lambda one: name(one.unevaluated_indices),
    }  # fmt: skip
    columns = _columns(RoomRow, ROOMS, said)
    columns[-1] = replace(columns[-1], format=COUNT)
    for place, (end, by, chance) in enumerate((
        (_("Safest way: to"), _("Safest way: by"), _("Safest way: chance of a blockage")),
        (_("Alternative: to"), _("Alternative: by"), _("Alternative: chance of a blockage")),
    )):  # fmt: skip
        columns += [
            Column(end, 16, of_way(place, lambda way: way.end)),
            Column(by, 60, of_way(place, lambda way: name(way.segment_indices))),
            Column(chance, 11, of_way(place, lambda way: way.blocked.probability if way.is_known else None), CHANCE),
        ]
    columns.append(Column(_("Alternative: shared with the safest way"), 40, name_shared))
    columns += _columns(RoomRow, {"unevaluated_indices": 40}, said)
    below = pen.listing(page, columns, routes.rooms)
    pen.bar(page, f"I2:I{below}")
    page.freeze_panes(1, 1)
    page.repeat_columns(0)
