"""The sheet Route pieces: what stands beside each segment, and below it what to fix for each route, step by step."""

from collections.abc import Iterator, Sequence
from typing import Any

from assess.inventory.live import say_class
from assess.language import gettext as _
from assess.ranking import list_steps
from assess.report import words
from assess.report.content import Content
from assess.report.findings import routes as say
from assess.report.xlsx.pen import Pen, with_unit
from assess.report.xlsx.routes import CHANCE, Heads, say_flags, say_whether
from assess.report.xlsx.said import ANCHORED
from assess.results import ItemResult
from assess.routes.model import Beside, Routes, SegmentResult


def has_pieces(content: Content) -> bool:
    """Tell whether any piece stands beside a segment, or a route is blocked as it stands."""
    routes = content.assessment.routes
    return routes is not None and (any(one.beside for one in routes.segments) or bool(say.list_unmended(routes)))


def write_route_pieces(pen: Pen, page: Any, content: Content) -> None:
    """Write the pieces beside every segment, and the steps of every route."""
    routes, heads = content.assessment.routes, _heads()
    if routes is None:
        return
    widths = [width for width, _code in heads.values()]
    formats = {at: code for at, (_width, code) in enumerate(heads.values()) if code}
    rows = [_beside(one, near, content.results[near.item]) for one in routes.segments for near in one.beside]
    pen.listing(page, tuple(heads), widths, rows, formats)
    page.repeat_columns(0, 3)
    if rows:
        pen.bar(page, f"H2:H{len(rows) + 1}")
    title = _("What to anchor or move for each route, step by step")
    pen.below(page, len(rows) + 2, title, _step_heads(), widths, list(_steps(routes, content.results)))


def _heads() -> Heads:
    return {
        _("Route"): (16, ""),
        _("Segment"): (18, ""),
        _("Floor"): (9, ""),
        _("Item"): (14, ""),
        _("Description"): (30, ""),
        _("Pieces"): (8, "#,##0"),
        _("Class (as run)"): (34, ""),
        _("Chance of overturning"): (11, CHANCE),
        _("Falls and blocked"): (14, CHANCE),
        with_unit(_("From the edge of the route"), "m"): (11, "0.00"),
        with_unit(_("Reaches into it"), "m"): (10, "0.00"),
        with_unit(_("Width left beside it alone"), "m"): (11, "0.00"),
        _("Blocks alone"): (9, ""),
        _("Known by"): (14, ""),
        _("Remarks"): (60, ""),
    }


def _beside(one: SegmentResult, near: Beside, result: ItemResult) -> tuple[Any, ...]:
    segment, flags = one.segment, say_flags(near.flags)
    held = _("anchored: its chances are those without the anchor") if result.is_anchored else ""
    return (
        segment.route, segment.segment, result.item.floor, *_piece(result), result.adopted.probability, near.together,
        near.distance, near.reach, near.left, say_whether(near.blocks_alone),
        _("plan") if near.by_plan else _("Edge distance"), "; ".join(text for text in (held, flags) if text),
    )  # fmt: skip


def _piece(one: ItemResult) -> tuple[Any, ...]:
    said = ", ".join([say_class(one.adopted.risk), *words.risk_notes(one)])
    shown = f"{ANCHORED}{words.risk_words(one)}" if one.is_anchored else said
    return one.item.item, one.item.description or one.item.type, one.item.quantity, shown


def _step_heads() -> dict[str, str]:
    return {
        _("Route"): "", _("Step"): "", _("Floor"): "", _("Item"): "", _("Description"): "", _("Pieces"): "#,##0",
        _("Class (as run)"): "", _("Chance blocked before"): CHANCE, _("Chance blocked after"): CHANCE,
    }  # fmt: skip


def _steps(routes: Routes, results: Sequence[ItemResult]) -> Iterator[tuple[Any, ...]]:
    """Yield every step of every route; then the routes that no step mends."""
    for step in list_steps(routes):
        one, told = results[step.item], _("{place:,} of {steps:,}", place=step.place, steps=step.steps)
        yield (step.route, told, one.item.floor, *_piece(one), step.before, step.after)
    for route, where in say.list_unmended(routes):
        told, chance = _("blocked with nothing fallen: {segments}", segments=where), route.outlook.blocked.probability
        yield (route.route, "", ", ".join(route.floors), "", told, None, "", chance, chance)
