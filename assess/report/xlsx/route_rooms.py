"""The sheet Route rooms: the chance of every room to lose all its exits, and its ways out."""

from collections.abc import Sequence
from typing import Any

from assess.language import gettext as _
from assess.report.content import Content
from assess.report.findings import routes as say
from assess.report.xlsx.pen import Pen
from assess.report.xlsx.routes import CHANCE, Heads, interval, name_piece
from assess.routes.model import RoomResult, Routes, Way


def has_rooms(content: Content) -> bool:
    """Tell whether any room was evaluated."""
    return content.assessment.routes is not None and bool(content.assessment.routes.rooms)


def write_route_rooms(pen: Pen, page: Any, content: Content) -> None:
    """Write every room with its safest way out, and the next that shares as few segments with it as may be."""
    routes, heads = content.assessment.routes, _heads()
    if routes is None:
        return
    widths = [width for width, _code in heads.values()]
    formats = {at: code for at, (_width, code) in enumerate(heads.values()) if code}
    items = [item.item for item in content.assessment.inventory.items]
    rows = [_room(one, routes, items) for one in routes.rooms]
    pen.listing(page, tuple(heads), widths, rows, formats)
    pen.bar(page, f"D2:D{len(rows) + 1}")
    page.freeze_panes(1, 1)
    page.repeat_columns(0)


def _heads() -> Heads:
    return {
        _("Room"): (22, ""),
        _("Floor"): (8, ""),
        _("Exits that can be reached"): (26, ""),
        _("Chance of losing every exit"): (11, CHANCE),
        _("Interval low"): (9, CHANCE),
        _("Interval high"): (9, CHANCE),
        _("All independent"): (12, CHANCE),
        _("Fully correlated"): (10, CHANCE),
        _("If anchors fail"): (9, CHANCE),
        _("Most likely piece"): (14, ""),
        _("Basis"): (30, ""),
        _("Ways out"): (8, "#,##0"),
        _("Safest way: to"): (16, ""),
        _("Safest way: by"): (60, ""),
        _("Safest way: chance of a blockage"): (11, CHANCE),
        _("Alternative: to"): (16, ""),
        _("Alternative: by"): (60, ""),
        _("Alternative: chance of a blockage"): (11, CHANCE),
        _("Alternative: shared with the safest way"): (40, ""),
        _("Segments not evaluated, taken as open"): (40, ""),
    }


def _room(one: RoomResult, routes: Routes, items: Sequence[str]) -> tuple[Any, ...]:
    loses, anchors = one.loses, one.if_anchors_fail
    exits = ", ".join(one.exits)
    ways: list[Way | None] = [*one.ways[:2], None, None]
    return (
        one.place.place, one.place.floor,
        _("{stairs} (stairs: beyond them nothing is known)", stairs=exits) if one.by_stairs else exits,
        *interval(loses), loses.independent, loses.correlated, anchors.probability if anchors else None,
        name_piece(one.blocker, items), say.say_basis(loses), len(one.ways),
        *_way(ways[0], routes), *_way(ways[1], routes), _name(ways[1].shared if ways[1] else (), routes),
        _name(one.unevaluated, routes),
    )  # fmt: skip


def _way(way: Way | None, routes: Routes) -> tuple[Any, ...]:
    if way is None:
        return "", "", None
    is_known = any(routes.segments[at].is_evaluated for at in way.segments)
    return way.end, _name(way.segments, routes), way.blocked.probability if is_known else None


def _name(segments: Sequence[int], routes: Routes) -> str:
    """Return the names of segments with their routes."""
    own = (routes.segments[at].segment for at in segments)
    return ", ".join(f"{one.route}: {one.segment}" for one in own)
