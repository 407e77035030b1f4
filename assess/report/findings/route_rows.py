"""What the page on evacuation routes opens with, and the rows of its tables, as far as each is shown."""

from collections.abc import Callable, Sequence
from typing import TypeVar

from assess.language import gettext as _
from assess.language import ngettext
from assess.report import words
from assess.report.findings.routes import say_risk
from assess.routes.flags import FLAGS
from assess.routes.model import Beside, RoomResult, RouteFix, RouteResult, Routes, RouteState, SegmentResult

Row = TypeVar("Row")
QUIET = ("own_rooms", "walls_unknown", "required_assumed")
"""Flags that do not keep a segment in a short list: they matter only where a piece reaches it."""


# ---------------------------------------------------------------- sentences


def describe_routes(routes: Routes) -> list[str]:
    """Return the routes of a building in plain words, as sentences."""
    return [
        *_count_states(routes),
        _("To be expected: {count} blocked routes.", count=words.fixed(routes.blocked_routes, 2)),
        ngettext(
            "Of {n:,} room, {count} are expected to lose every exit.",
            "Of {n:,} rooms, {count} are expected to lose every exit.",
            len(routes.rooms),
            count=words.fixed(routes.cut_off_rooms, 2),
        )
        if routes.rooms
        else _("No room is joined to a way out, so none is evaluated."),
        _("These are chances in this scenario, not per year."),
        _("A route may be blocked, or reduced, from a chance of {risk} on.", risk=say_risk(routes.risk)),
    ]


def _count_states(routes: Routes) -> list[str]:
    states = [one.outlook.state for one in routes.routes if one.is_evaluated]
    blocked, reduced = states.count(RouteState.BLOCKED), states.count(RouteState.REDUCED)
    texts = []
    if states:
        told = ngettext(
            "{n:,} evacuation route: {blocked:,} may be blocked, {reduced:,} may be reduced, {open:,} below the chosen "
            "risk.",
            "{n:,} evacuation routes: {blocked:,} may be blocked, {reduced:,} may be reduced, {open:,} below the "
            "chosen risk.",
            len(states), blocked=blocked, reduced=reduced, open=len(states) - blocked - reduced,
        )  # fmt: skip
        texts.append(told)
    return texts + say_unknown(routes)


def say_unknown(routes: Routes) -> list[str]:
    """Return how many routes and segments are not evaluated; nothing where all are."""
    texts = []
    if whole := sum(not one.is_evaluated for one in routes.routes):
        texts.append(ngettext("{n:,} route is not evaluated: nothing tells what can reach it.",
                              "{n:,} routes are not evaluated: nothing tells what can reach them.",
                              whole))  # fmt: skip
    if parts := sum(len(one.unevaluated) for one in routes.routes if one.is_evaluated):
        texts.append(ngettext("Of evaluated routes, {n:,} segment is not: nothing tells what can reach it.",
                              "Of evaluated routes, {n:,} segments are not: nothing tells what can reach them.",
                              parts))  # fmt: skip
    return texts


def count_uncounted(routes: Routes) -> int:
    """Return how many pieces there are of which nothing tells whether they fall onto a route."""
    return sum(one.uncounted for one in routes.floors)


def say_uncounted(routes: Routes) -> str:
    """Return that they are not counted; nothing where there are none."""
    count = count_uncounted(routes)
    if not count:
        return ""
    return ngettext(
        "{n:,} piece has neither a position that tells nor a Route: whether it falls onto a route is not known, and it "
        "is not counted.",
        "{n:,} pieces have neither a position that tells nor a Route: whether they fall onto a route is not known, and "
        "they are not counted.",
        count,
    )


# ---------------------------------------------------------------- rows


def choose_rows(rows: Sequence[Row], most: int, chance: Callable[[Row], float]) -> list[Row]:
    """Return rows in their own order where they are few enough, else the likeliest."""
    return list(rows) if len(rows) <= most else sorted(rows, key=lambda row: -chance(row))[:most]


def list_segments(routes: Routes, most: int, *, is_short: bool = False) -> list[tuple[int, SegmentResult]]:
    """Return segments with their numbers, from 1: all, or those most likely to be blocked.

    A short list leaves out those that no piece reaches and of which nothing is to be said.
    """
    numbered = [(at, one) for at, one in enumerate(routes.segments, start=1) if not is_short or not is_untouched(one)]
    return choose_rows(numbered, most, lambda row: row[1].outlook.blocked.probability)


def is_untouched(one: SegmentResult) -> bool:
    """Tell whether a segment was evaluated, no piece reaches it, and nothing else is to be said of it."""
    told = one.beside or one.other_rooms or one.is_short or one.is_blocked_standing or not one.is_evaluated
    return not told and not [flag for flag in one.flags if flag not in QUIET]


def list_beside(routes: Routes) -> list[tuple[SegmentResult, Beside | None]]:
    """Return the pieces beside each segment, the segments most likely to be blocked first.

    A segment that no piece reaches is there only if it is too narrow as it stands.
    """
    likeliest = sorted(routes.segments, key=lambda one: -one.outlook.blocked.probability)
    told = [one for one in likeliest if one.beside or one.is_short or one.is_blocked_standing]
    return [(one, near) for one in told for near in (one.beside or (None,))]


def list_steps(routes: Routes) -> list[tuple[RouteResult, int, RouteFix]]:
    """Return what to fix for each route, step by step: the route, the number of the step from 1, and the step."""
    return [(one, at, step) for one in routes.routes for at, step in enumerate(one.fixes, start=1)]


def name_untouched(routes: Routes) -> tuple[int, str]:
    """Return how many routes are under the chosen risk as they are, as far as they are evaluated, and their names."""
    found = [one for one in routes.routes if one.is_mended and one.is_evaluated and not one.fixes]
    names = [words.cut(one.route, 40) for one in found]
    return len(names), words.name_first(names, 12)


def has_evaluated_way(one: RoomResult) -> bool:
    """Tell whether any segment of its ways out is evaluated: else its chance rests on nothing."""
    return not one.ways or any(at not in one.unevaluated for way in one.ways for at in way.segments)


def list_flags(routes: Routes) -> dict[str, str]:
    """Return the marks that occur, and what each means; where its own rooms count, they are named instead."""
    raised = [one.flags for one in routes.segments] + [near.flags for one in routes.segments for near in one.beside]
    found = {flag for flags in raised for flag in flags if flag != "own_rooms"}
    return {flag: _(text) for flag, text in FLAGS.items() if flag in found}
