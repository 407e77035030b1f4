"""The first sentences of the section on evacuation routes, and the rows of its tables, as far as each is shown."""

from collections.abc import Callable, Sequence
from typing import TypeVar

from assess.i18n import gettext as _
from assess.i18n import ngettext
from assess.report import words
from assess.report.findings.route_words import count_state, find_chance, say_missing
from assess.route_results import (
    FLAGS,
    BesideRow,
    RoomRow,
    RouteFixRow,
    RouteRow,
    RouteState,
    RouteTables,
    SegmentRow,
    join_missing,
)
from assess.workbook.draft_names import is_draft

Row = TypeVar("Row")
MOST_ROOMS = 3
"""Rooms without a way out that a sentence names."""
UNPLACED = ("positions", "places", "ends", "stair_floor")
"""What is missing, as keys of `assess.route_results.MISSING`, where pieces are left out."""
QUIET = ("own_rooms", "walls_unknown", "required_assumed")
"""Flags that do not keep a segment in a short list: they matter only where a piece reaches it."""


# ---------------------------------------------------------------- sentences


def describe_routes(routes: RouteTables) -> list[str]:
    """Return the routes of a building in plain words, as sentences."""
    return [
        count_routes(routes),
        *count_rooms(routes),
        *say_reservations(routes),
        say_expected(routes),
        *say_not_counted(routes),
        _("These are chances in this scenario, not per year."),
    ]


def say_reservations(routes: RouteTables) -> list[str]:
    """Return that routes are drafts, and that rooms have no furniture listed: states may rest on less than is there."""
    return [*say_drafts(routes), *_say_furnished(routes)]


def say_drafts(routes: RouteTables) -> list[str]:
    """Return how many routes are drafts that nobody has walked; nothing where none is."""
    drafts = sum(is_draft(one.route) for one in routes.routes)
    if not drafts:
        return []
    return [ngettext("{n:,} of {all:,} routes is a draft from a building model that nobody has walked yet.",
                     "{n:,} of {all:,} routes are drafts from a building model that nobody has walked yet.",
                     drafts, all=len(routes.routes))]  # fmt: skip


def _say_furnished(routes: RouteTables) -> list[str]:
    if any(row.what == "furniture" for one in routes.segments for row in one.missing):
        return [_("No furniture is listed, so whether ways through rooms stay open is not known.")]
    if routes.furnished_rooms == routes.counted_rooms:
        return []
    return [ngettext("No furniture is listed in the only room or corridor: ways through it count as free of furniture.",
                     "Furniture is listed in {listed:,} of {n:,} rooms and corridors. Ways through the others count as "
                     "free of furniture.", routes.counted_rooms, listed=routes.furnished_rooms)]  # fmt: skip


def say_expected(routes: RouteTables) -> str:
    """Return how many routes would be blocked, and how many rooms would lose all exits, on average."""
    blocked, rooms = words.fixed(routes.blocked_routes_expected, 2), words.fixed(routes.cut_off_rooms_expected, 2)
    if not routes.rooms:
        return _("On average {count} routes would be blocked.", count=blocked)
    return _(
        "On average {count} routes would be blocked and {rooms} rooms would lose all exits.", count=blocked, rooms=rooms
    )


def count_routes(routes: RouteTables) -> str:
    """Return how many routes are in which state, as a sentence."""
    return ngettext("{n:,} evacuation route: {states}.", "{n:,} evacuation routes: {states}.", len(routes.routes),
                    states=_count_states([one.state for one in routes.routes]))  # fmt: skip


def count_rooms(routes: RouteTables) -> list[str]:
    """Return how many rooms have a best way to the street in which state, and which rooms have none."""
    unjoined = _say_unjoined(routes)
    if not routes.rooms:
        return unjoined
    return [ngettext("Best way from {n:,} room to the street: {states}.",
                     "Best way from each of {n:,} rooms to the street: {states}.",
                     len(routes.rooms), states=_count_states([one.state for one in routes.rooms])),
            *unjoined]  # fmt: skip


def _say_unjoined(routes: RouteTables) -> list[str]:
    """Return which rooms have no way to an exit or a stair in the workbook."""
    rooms = routes.unjoined_rooms
    if not rooms:
        return []
    named = words.name_first([words.cut(room, 30) for room in rooms], MOST_ROOMS)
    return [ngettext(
        "The workbook joins {n:,} more room to no exit or stair, so that its way out is not known: {named}. Add the "
        "way to Routes.",
        "The workbook joins {n:,} more rooms to no exit or stair, so that their way out is not known: {named}. Add "
        "the ways to Routes.",
        len(rooms), named=named,
    )]  # fmt: skip


def _count_states(states: Sequence[RouteState]) -> str:
    counts = [(state, states.count(state)) for state in sorted(RouteState, key=lambda one: -one.severity)]
    return ", ".join(count_state(state, count) for state, count in counts if count)


def say_to_fill_in(routes: RouteTables) -> list[str]:
    """Return what to fill in so that routes and rooms are known; nothing where all are."""
    of_rooms = [row for one in routes.rooms for row in one.missing]
    missing = join_missing([row for one in routes.routes for row in one.missing] + of_rooms)
    return [_("To settle what is not known: {fix}.", fix=say_missing(missing))] if missing else []


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
    left_out = ngettext(
        "{n:,} piece has no usable position or route and is left out.",
        "{n:,} pieces have no usable position or route and are left out.",
        count,
    )
    rows: list[RouteRow | RoomRow] = [*routes.routes, *routes.rooms]
    if any(row.what in UNPLACED for one in rows for row in one.missing):
        return left_out
    if any(row.what in UNPLACED for one in rows for row in one.missing_after):
        later = _("What is left out could change a state once the pieces listed are fixed.")
        return f"{left_out} {later}"
    if any(row.what in UNPLACED for one in routes.segments for row in one.missing):
        return left_out
    none = _("None of them could change a state.")
    return f"{left_out} {none}"


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
    """Return how many routes are open as they are, and their names."""
    found = [one for one in routes.routes if one.state == RouteState.OPEN]
    names = [words.cut(one.route, 40) for one in found]
    return len(names), words.name_first(names, 12)


def list_flags(routes: RouteTables) -> dict[str, str]:
    """Return the marks that occur, and what each means; where its own rooms count, they are named instead."""
    raised = [one.flags for one in routes.segments] + [near.flags for one in routes.segments for near in one.pieces]
    found = {flag for flags in raised for flag in flags if flag != "own_rooms"}
    return {flag: _(text) for flag, text in FLAGS.items() if flag in found}
