"""The sheet Routes: a row a segment, and below them the routes and what is to be expected on each floor."""

from collections.abc import Mapping, Sequence
from typing import Any

from assess.language import gettext as _
from assess.report.content import Content
from assess.report.findings import routes as say
from assess.report.xlsx.pen import Pen, with_unit
from assess.routes.flags import FLAGS
from assess.routes.model import Chance, FloorRoutes, Outlook, RouteResult, Routes, SegmentResult

CHANCE = "0.0%"
Heads = Mapping[str, tuple[int, str]]
"""Width and number format of every column, by its heading."""


def write_routes(pen: Pen, page: Any, content: Content) -> None:
    """Write every segment, every route and every floor with its chances."""
    routes, heads = content.assessment.routes, _heads()
    names, widths = tuple(heads), [width for width, _code in heads.values()]
    formats = {at: code for at, (_width, code) in enumerate(heads.values()) if code}
    if routes is None:
        pen.listing(page, names, widths, [(_("The workbook names no routes."), *[None] * (len(heads) - 1))], formats)
        return
    items = [item.item for item in content.assessment.inventory.items]
    rows = [_segment(one, routes, items) for one in routes.segments]
    pen.listing(page, names, widths, rows, formats)
    for letter in "GJ":
        pen.bar(page, f"{letter}2:{letter}{len(rows) + 1}")
    row = _write_totals(pen, page, widths, routes, items, len(rows) + 2)
    as_run = _("All of this is as run: it does not follow when a cell of another sheet is edited.")
    for at, text in enumerate((as_run, *say.list_cautions(routes)), row + 1):
        page.write_string(at, 0, text)
    page.freeze_panes(1, 2)
    page.repeat_columns(0, 1)
    page.fit_to_pages(2, 0)


def _write_totals(pen: Pen, page: Any, widths: Sequence[int], routes: Routes, items: Sequence[str], row: int) -> int:
    """Write the routes and the floors; return the row below them."""
    own = [_route(one, routes, items) for one in routes.routes]
    row = pen.below(page, row, _("Routes"), _route_heads(), widths, own) + 1
    floors = [_floor(one) for one in routes.floors]
    return pen.below(page, row, _("To be expected floor by floor"), _floor_heads(), widths, floors) + 1


def _heads() -> Heads:
    return {
        _("Route"): (16, ""),
        _("Segment"): (18, ""),
        _("Floor"): (10, ""),
        _("From"): (18, ""),
        _("To"): (18, ""),
        _("State"): (26, ""),
        **dict.fromkeys(_chances(), (11, CHANCE)),
        _("Under the record"): (13, ""),
        _("Most likely piece"): (14, ""),
        _("Pieces"): (8, "#,##0"),
        _("By the formula alone"): (9, "#,##0"),
        _("Basis"): (30, ""),
        with_unit(_("Clear width"), "m"): (10, "0.00"),
        with_unit(_("Required width"), "m"): (10, "0.00"),
        with_unit(_("Width now"), "m"): (11, "0.00"),
        with_unit(_("Width if all fall"), "m"): (10, "0.00"),
        _("Occupants"): (11, "#,##0"),
        with_unit(_("Width that they need"), "m"): (10, "0.00"),
        _("Insufficient for occupants"): (13, ""),
        _("Chance too narrow for occupants"): (11, CHANCE),
        _("Room"): (18, ""),
        _("Not counted, in another room"): (24, ""),
        _("Remarks"): (60, ""),
        _("Notes"): (40, ""),
    }


def _chances() -> tuple[str, ...]:
    return (
        _("Chance blocked"), _("Interval low"), _("Interval high"), _("Chance blocked or reduced"),
        _("Blocked, all independent"), _("Blocked, fully correlated"), _("Blocked if anchors fail"),
    )  # fmt: skip


def _segment(one: SegmentResult, routes: Routes, items: Sequence[str]) -> tuple[Any, ...]:
    segment, is_known = one.segment, one.is_evaluated
    crowded = one.crowded if is_known or one.is_short else None
    return (
        segment.route, segment.segment, segment.floor, segment.start, segment.end,
        say.say_segment_state(one, routes.risk),
        *(_outlook(one.outlook, items) if is_known else _NO_OUTLOOK),
        one.clear, one.required, one.standing, one.least if is_known else None, segment.occupants, one.needed,
        None if one.needed is None else say_whether(one.is_short), crowded.probability if crowded else None,
        segment.room, ", ".join(items[at] for at in one.other_rooms), say_flags(one.flags), segment.notes,
    )  # fmt: skip


def _outlook(one: Outlook, items: Sequence[str]) -> tuple[Any, ...]:
    blocked, anchors = one.blocked, one.if_anchors_fail
    return (
        blocked.probability, blocked.low, blocked.high, one.taken.probability, blocked.independent, blocked.correlated,
        anchors.probability if anchors else None, say.say_recorded(one) if one.in_record is not None else "",
        name_piece(one.blocker, items), blocked.pieces, blocked.unverified, say.say_basis(blocked),
    )  # fmt: skip


_NO_OUTLOOK = (None,) * 12
"""The cells of `_outlook` where nothing tells which pieces can reach a segment or route: a 0 would say more."""


def _route_heads() -> dict[str, str]:
    return {
        _("Route"): "", _("Floors"): "", _("Segments"): "#,##0", _("Pieces to anchor or move"): "",
        _("Segments not evaluated"): "", _("State"): "", **dict.fromkeys(_chances(), CHANCE), _("Under the record"): "",
        _("Most likely piece"): "", _("Pieces"): "#,##0", _("By the formula alone"): "#,##0", _("Basis"): "",
        _("Chance left then"): CHANCE,
    }  # fmt: skip


def _route(one: RouteResult, routes: Routes, items: Sequence[str]) -> tuple[Any, ...]:
    fixes = ", ".join(items[fix.item] for fix in one.fixes)
    unknown = ", ".join(routes.segments[at].segment.segment for at in one.unevaluated)
    return (
        one.route, ", ".join(one.floors), len(one.segments), fixes, unknown, say.say_route_state(one, routes.risk),
        *(_outlook(one.outlook, items) if one.is_evaluated else _NO_OUTLOOK),
        one.fixes[-1].left if one.fixes else None,
    )  # fmt: skip


def _floor_heads() -> dict[str, str]:
    return {
        _("Floor"): "", _("Segments"): "#,##0", _("Blocked segments expected"): "0.00", _("Routes"): "#,##0",
        _("Blocked routes expected"): "0.00", _("Rooms"): "#,##0", _("Rooms expected to lose every exit"): "0.00",
        _("Chance that any room does"): CHANCE, _("Interval low"): CHANCE, _("Interval high"): CHANCE,
        _("Pieces not counted"): "#,##0",
    }  # fmt: skip


def _floor(one: FloorRoutes) -> tuple[Any, ...]:
    return (
        one.floor, one.segments, one.blocked_segments, one.routes, one.blocked_routes, one.rooms, one.cut_off_rooms,
        *interval(one.any_room), one.uncounted,
    )  # fmt: skip


def interval(chance: Chance | None) -> tuple[float | None, float | None, float | None]:
    """Return a chance with the ends of its interval."""
    return (chance.probability, chance.low, chance.high) if chance else (None, None, None)


def name_piece(item: int | None, items: Sequence[str]) -> str:
    """Return the name of a piece; "" for none."""
    return "" if item is None else items[item]


def say_whether(holds: bool) -> str:
    """Return yes or no."""
    return _("yes") if holds else _("no")


def say_flags(flags: Sequence[str]) -> str:
    """Return the cautions on a segment or a piece beside it in words."""
    return "; ".join(_(FLAGS[flag]) for flag in flags)
