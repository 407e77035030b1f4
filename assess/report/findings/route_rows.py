"""The first sentences of the section on evacuation routes, and the rows of its tables, as far as each is shown."""

from collections.abc import Callable, Sequence
from typing import TypeVar

from assess.i18n import gettext as _
from assess.i18n import ngettext
from assess.report import words
from assess.report.findings.route_words import find_chance, name_few, say_risk, say_to_settle
from assess.route_results import (
    DOUBTS,
    FLAGS,
    BesideRow,
    RoomRow,
    RouteFixRow,
    RouteRow,
    RouteState,
    RouteTables,
    SegmentRow,
)

Row = TypeVar("Row")
QUIET = ("own_rooms", "walls_unknown", "required_assumed")
"""Flags that do not keep a segment in a short list: they matter only where a piece reaches it."""


# ---------------------------------------------------------------- sentences


def describe_routes(routes: RouteTables) -> list[str]:
    """Return the routes of a building in plain words, as sentences."""
    return [
        *_count_states(routes),
        _("On average {count} routes would be blocked.", count=words.fixed(routes.blocked_routes_expected, 2)),
        ngettext(
            "Of {n:,} room, on average {count} would lose all exits.",
            "Of {n:,} rooms, on average {count} would lose all exits.",
            len(routes.rooms),
            count=words.fixed(routes.cut_off_rooms_expected, 2),
        )
        if routes.rooms
        else _("No room has a way out in the workbook, so none is evaluated."),
        *say_not_counted(routes),
        _("These are chances in this scenario, not per year."),
        _("Routes count as blocked or reduced from a chance of {risk}.", risk=say_risk(routes.risk)),
    ]


def _count_states(routes: RouteTables) -> list[str]:
    states = [one.state for one in routes.routes if one.evaluated and one.state != RouteState.NOT_KNOWN]
    blocked, reduced = states.count(RouteState.BLOCKED), states.count(RouteState.REDUCED)
    texts = []
    if states:
        counted = ngettext(
            "{n:,} evacuation route: {blocked:,} may be blocked, {reduced:,} may be reduced, {open:,} below the chosen "
            "risk.",
            "{n:,} evacuation routes: {blocked:,} may be blocked, {reduced:,} may be reduced, {open:,} below the "
            "chosen risk.",
            len(states), blocked=blocked, reduced=reduced, open=len(states) - blocked - reduced,
        )  # fmt: skip
        texts.append(counted)
    return texts + say_unknown(routes)


def say_unknown(routes: RouteTables) -> list[str]:
    """Return how many routes and rooms are not known, and could not be evaluated; nothing where all are."""
    texts = _say_not_known(routes)
    if whole := sum(not one.evaluated for one in routes.routes):
        texts.append(ngettext("{n:,} route could not be evaluated: the workbook places no furniture there.",
                              "{n:,} routes could not be evaluated: the workbook places no furniture there.",
                              whole))  # fmt: skip
    if parts := sum(len(one.unevaluated_segments) for one in routes.routes if one.evaluated):
        texts.append(ngettext("{n:,} segment of the other routes could not be evaluated.",
                              "{n:,} segments of the other routes could not be evaluated.",
                              parts))  # fmt: skip
    return texts


def _say_not_known(routes: RouteTables) -> list[str]:
    """Return which routes and rooms depend on unconfirmed pieces, and what to fill in to settle it."""
    texts = []
    if routes.unknown_routes:
        texts.append(ngettext("{n:,} route is not known: it depends on pieces whose class is not confirmed ({pieces}).",
                              "{n:,} routes are not known: they depend on pieces whose class is not confirmed "
                              "({pieces}).", routes.unknown_routes,
                              pieces=name_few(_list_deciding(routes))))  # fmt: skip
    if routes.unknown_rooms:
        texts.append(ngettext("For {n:,} room it is not known whether it could lose all exits.",
                              "For {n:,} rooms it is not known whether they could lose all exits.",
                              routes.unknown_rooms))  # fmt: skip
    raised = {flag for row in (routes.routes, routes.rooms) for one in row for flag in one.doubts}
    if fix := say_to_settle([flag for flag in DOUBTS.values() if flag in raised]):
        texts.append(_("To settle this: {fix}.", fix=fix))
    return texts


def _list_deciding(routes: RouteTables) -> list[str]:
    """Return the names of the unconfirmed pieces that reach a route that is not known, each once."""
    unknown = [at for one in routes.routes if one.state == RouteState.NOT_KNOWN for at in one.segment_indices]
    near = [piece for at in unknown for piece in routes.segments[at].pieces]
    return list(dict.fromkeys(one.item for one in near if set(one.flags) & set(DOUBTS.values())))


def say_not_counted(routes: RouteTables) -> list[str]:
    """Return how many routes and rooms expected numbers leave out; nothing where all are known."""
    if not routes.unknown_routes and not routes.unknown_rooms:
        return []
    return [_("Left out of these averages, as not known: routes {routes:,}, rooms {rooms:,}.",
              routes=routes.unknown_routes, rooms=routes.unknown_rooms)]  # fmt: skip


def say_fixes_bound(routes: RouteTables) -> str:
    """Return that unconfirmed pieces count as fallen in what to fix; nothing where none does."""
    if not any(one.fixes and one.blocked_if_unconfirmed_fall for one in routes.routes):
        return ""
    return _("Pieces whose class is not confirmed count as fallen in these chances, which is on the safe side.")


def say_uncounted(routes: RouteTables) -> str:
    """Return how many pieces are left out, as it is unknown whether they fall onto a route; nothing without any."""
    count = routes.uncounted_pieces
    if not count:
        return ""
    return ngettext(
        "{n:,} piece has no usable position or route and is left out.",
        "{n:,} pieces have no usable position or route and are left out.",
        count,
    )


# ---------------------------------------------------------------- rows


def choose_rows(rows: Sequence[Row], most: int, chance: Callable[[Row], float]) -> list[Row]:
    """Return rows in their own order where they are few enough, else the likeliest."""
    return list(rows) if len(rows) <= most else sorted(rows, key=lambda row: -chance(row))[:most]


def list_segments(routes: RouteTables, most: int, *, is_short: bool = False) -> list[tuple[int, SegmentRow]]:
    """Return segments with their numbers, from 1: all, or those most likely to be blocked.

    A short list leaves out those that no piece reaches and that need no remark.
    """
    numbered = [(at, one) for at, one in enumerate(routes.segments, start=1) if not is_short or not is_untouched(one)]
    return choose_rows(numbered, most, lambda row: find_chance(row[1]))


def is_untouched(one: SegmentRow) -> bool:
    """Tell whether a segment was evaluated, no piece reaches it, and it needs no remark."""
    if one.pieces or one.other_rooms or one.insufficient_for_occupants or one.is_blocked_standing or not one.evaluated:
        return False
    return not [flag for flag in one.flags if flag not in QUIET]


def list_beside(routes: RouteTables) -> list[tuple[SegmentRow, BesideRow | None]]:
    """Return the pieces beside each segment, the segments most likely to be blocked first.

    A segment that no piece reaches is there only if it is too narrow as it stands.
    """
    likeliest = sorted(routes.segments, key=lambda one: -find_chance(one))
    shown = [one for one in likeliest if one.pieces or one.insufficient_for_occupants or one.is_blocked_standing]
    return [(one, near) for one in shown for near in (one.pieces or (None,))]


def list_steps(routes: RouteTables) -> list[tuple[RouteRow, int, RouteFixRow]]:
    """Return what to fix for each route, step by step: the route, the number of the step from 1, and the step."""
    return [(one, at, step) for one in routes.routes for at, step in enumerate(one.fixes, start=1)]


def name_untouched(routes: RouteTables) -> tuple[int, str]:
    """Return how many routes are under the chosen risk as they are, as far as they are evaluated, and their names."""
    found = [one for one in routes.routes if one.is_fixed and one.evaluated and not one.fixes]
    names = [words.cut(one.route, 40) for one in found]
    return len(names), words.name_first(names, 12)


def has_evaluated_way(one: RoomRow, routes: RouteTables) -> bool:
    """Tell whether any segment of its ways out is evaluated: else its chance rests on nothing."""
    return not one.ways or any(routes.segments[at].evaluated for way in one.ways for at in way.segment_indices)


def list_flags(routes: RouteTables) -> dict[str, str]:
    """Return the marks that occur, and what each means; where its own rooms count, they are named instead."""
    raised = [one.flags for one in routes.segments] + [near.flags for one in routes.segments for near in one.pieces]
    found = {flag for flags in raised for flag in flags if flag != "own_rooms"}
    return {flag: _(text) for flag, text in FLAGS.items() if flag in found}
