"""The page of evacuation routes: every way to the street that is not open, what decides it, and what to do about it."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from assess.i18n import gettext as _
from assess.natural import natural_key
from assess.report import words
from assess.report.findings.route_words import (
    find_chance,
    is_blocked_standing,
    say_blocked,
    say_lost,
    say_missing,
    say_missing_after,
    say_room_state,
    say_route_state,
    say_segment,
)
from assess.results import ItemRow
from assess.route_results import RoomRow, RouteRow, RouteState, RouteTables

Row = TypeVar("Row")
MOST_LINES = 12
"""Lines of either table that a page has room for."""
MOST_FIXES = 10
"""Pieces that a line names."""
LONGEST = 20
"""Characters of the name of a piece."""
MOST_NAMES = 16
"""Names that a line holds."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """A line of the page: a route, or rooms whose way to the street is alike.

    Parameters
    ----------
    names : str
        The route, or the rooms.
    from_places, to_places : str
        Where it leads from and to.
    state : RouteState
        For its style.
    said : str
        The state with its sign, in words.
    chance : str
        Of a blockage, with its interval.
    decisive : str
        The segment that decides, "" where none does.
    fixes : tuple of tuple of int
        Pieces to anchor or move, by their index in the items: one, or a run of which the ends are named.
    more : int
        Further ones that are not named.
    advice : str
        What else to do, such as what to fill in; "" where nothing is.
    """

    names: str
    from_places: str
    to_places: str
    state: RouteState
    said: str
    chance: str
    decisive: str
    fixes: tuple[tuple[int, ...], ...]
    more: int
    advice: str


def list_route_lines(routes: RouteTables, items: Sequence[ItemRow]) -> list[Line]:
    """Return the routes that are not open, the worst first, and one line for all that are open."""
    found = sorted(
        (one for one in routes.routes if one.state != RouteState.OPEN),
        key=lambda one: (-one.state.severity, -find_chance(one), natural_key(one.route)),
    )
    lines = [
        _line(one, routes, items, words.cut(one.route, 40), say_route_state(one, routes.risk), say_blocked(one),
              _name(one.to_places))
        for one in found
    ]  # fmt: skip
    is_open = [one for one in routes.routes if one.state == RouteState.OPEN]
    return lines + _join_open(is_open, routes) if is_open else lines


def _join_open(found: Sequence[RouteRow], routes: RouteTables) -> list[Line]:
    """Return open routes as one line for those of which the same is to be said."""
    lines = []
    for said, own in _group(found, lambda one: say_route_state(one, routes.risk)):
        highest = max(one.blocked.high for one in own if one.blocked)
        chance = _("at most {chance}", chance=words.percent(highest)) if highest else words.percent(0.0)
        names = words.name_first([words.cut(one.route, 30) for one in own], MOST_NAMES)
        lines.append(Line(
            names=names, from_places="", to_places="", state=RouteState.OPEN, said=str(said), chance=chance,
            decisive="", fixes=(), more=0, advice="",
        ))  # fmt: skip
    return lines


def list_room_lines(routes: RouteTables, items: Sequence[ItemRow]) -> list[Line]:
    """Return the rooms by their best way to the street, the worst first; those that are alike as one line."""

    def kind(one: RoomRow) -> tuple[object, ...]:
        if one.state == RouteState.OPEN:
            return one.state, one.exits
        lack, fixed = (one.missing, one.missing_after), frozenset(fix.item_index for fix in one.fixes)
        return one.state, one.exits, say_lost(one), one.decisive_segment, fixed, lack

    order = sorted(routes.rooms, key=lambda one: (-one.state.severity, -one.loses_every_exit.probability))
    lines = []
    for _kind, own in _group(order, kind):
        rooms = words.name_first([words.cut(one.room, 30) for one in own], MOST_NAMES)
        high = max((one.loses_every_exit for one in own), key=lambda chance: chance.high)
        is_open = own[0].state == RouteState.OPEN
        chance = _("at most {chance}", chance=words.percent(high.high)) if is_open and high.high else say_lost(own[0])
        names = _name(own[0].exits)
        exits = _("stairs: {names}", names=names) if own[0].by_stairs else names
        lines.append(_line(own[0], routes, items, rooms, say_room_state(own[0]), chance, exits))
    return lines


def _group(rows: Iterable[Row], kind: Callable[[Row], object]) -> list[tuple[object, list[Row]]]:
    found: dict[object, list[Row]] = {}
    for one in rows:
        found.setdefault(kind(one), []).append(one)
    return list(found.items())


def _line(
    one: RouteRow | RoomRow,
    routes: RouteTables,
    items: Sequence[ItemRow],
    names: str,
    said: str,
    chance: str,
    ends: str,
) -> Line:
    fixes = () if one.missing else _find_runs(one, items)
    is_open = one.state == RouteState.OPEN
    decisive = None if is_open or one.decisive_segment is None else routes.segments[one.decisive_segment]
    return Line(
        names=names,
        from_places=_name(one.from_places) if isinstance(one, RouteRow) else names,
        to_places=ends,
        state=one.state,
        said=said,
        chance=chance,
        decisive=say_segment(decisive) if decisive else "",
        fixes=fixes[:MOST_FIXES],
        more=sum(map(len, fixes[MOST_FIXES:])),
        advice=say_advice(one),
    )


def _find_runs(one: RouteRow | RoomRow, items: Sequence[ItemRow]) -> tuple[tuple[int, ...], ...]:
    """Return the pieces to fix in natural order, rows of one piece each whose names follow each other as a run."""
    fixes = sorted((items[fix.item_index] for fix in one.fixes), key=lambda row: natural_key(row.item))
    names = [row.item if row.quantity == 1 else f"{row.item} ({row.quantity})" for row in fixes]
    return tuple(tuple(fixes[at].index for at in run) for run in words.find_runs(names, LONGEST))


def say_advice(one: RouteRow | RoomRow) -> str:
    """Return what to do about a route or a room's way but for the pieces to fix; "" where there is nothing."""
    if one.missing:
        return say_missing(one.missing)
    if is_blocked_standing(one):
        return _("widen it, or move what stands inside; check the Clear width")
    if one.state == RouteState.DOUBTFUL and not one.fixes:
        return _("no draw blocks it: simulate more draws to settle it")
    return say_missing_after(one)


def _name(places: Sequence[str]) -> str:
    return words.name_first([words.cut(one, 30) for one in places], 2)
