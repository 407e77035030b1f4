"""The routes at risk and what to fix for them, in the words of the summaries."""

from dataclasses import dataclass

from assess.i18n import gettext as _
from assess.i18n import ngettext
from assess.natural import natural_key
from assess.report import words
from assess.report.findings.route_rows import (
    count_rooms,
    count_routes,
    say_expected,
    say_not_counted,
    say_reservations,
    say_to_fill_in,
    say_uncounted,
)
from assess.report.findings.route_words import (
    find_chance,
    is_blocked_standing,
    is_held,
    name_few,
    say_blocked,
    say_chance,
    say_missing,
    say_route_state,
)
from assess.results import ItemResult, Results
from assess.route_results import RoomRow, RouteRow, RouteState, RouteTables

LINE = 28
"""Letters of what to fix or fill in for a route that the summary has room for."""


@dataclass(frozen=True, slots=True)
class RouteAtRisk:
    """A route that is not open, the piece that most likely blocks it, and in short what to fix or fill in, if any.

    `risk` is the chosen one [-].
    """

    result: RouteRow
    risk: float
    blocker: str
    needed: str

    @property
    def route(self) -> str:
        """Its name."""
        return self.result.route

    @property
    def floors(self) -> str:
        """The floors that it has segments on."""
        return ", ".join(self.result.floors)

    @property
    def state(self) -> str:
        """Its state with its sign, in words."""
        return say_route_state(self.result, self.risk)

    @property
    def chance(self) -> str:
        """The chance that it is blocked, with its interval."""
        return say_blocked(self.result)


def list_routes_at_risk(results: Results) -> list[RouteAtRisk]:
    """Return the routes that are not open, the worst first."""
    routes = results.route_tables
    found = [one for one in routes.routes if one.state != RouteState.OPEN]
    found.sort(key=lambda one: (-one.state.severity, -find_chance(one), natural_key(one.route)))
    return [
        RouteAtRisk(
            one,
            routes.risk,
            "" if one.most_likely_piece is None or is_blocked_standing(one) else one.most_likely_piece.item,
            _name_fixes(results, one) or words.cut(say_missing(one.missing), LINE),
        )
        for one in found
    ]


def _name_fixes(results: Results, route: RouteRow) -> str:
    names = sorted((say_row(results.result(fix.item_index)) for fix in route.fixes), key=natural_key)
    return words.fit_pieces(names, LINE)


def say_row(one: ItemResult) -> str:
    """Return the name of a row, and how many pieces it is if it is several: ``e5 (5 pieces)``."""
    if one.item.quantity == 1:
        return one.item.item
    return f"{one.item.item} ({words.plural(one.item.quantity, 'piece')})"


def describe_at_risk(one: RouteAtRisk) -> str:
    """Return one of them as a sentence."""
    route = _("{route} (floor {floors})", route=one.route, floors=one.floors) if one.floors else one.route
    if not one.blocker:
        return _("{route}: {state}, blocked in {chance}.", route=route, state=one.state, chance=one.chance)
    return _("{route}: {state}, blocked in {chance}, most likely by {item}.",
             route=route, state=one.state, chance=one.chance, item=one.blocker)  # fmt: skip


def list_rooms_at_risk(routes: RouteTables) -> list[RoomRow]:
    """Return the rooms whose best way to the street is doubtful or blocked, the worst first."""
    found = [one for one in routes.rooms if one.state in (RouteState.DOUBTFUL, RouteState.BLOCKED)]
    return sorted(
        found, key=lambda one: (-one.loses_every_exit.probability, -one.loses_every_exit.high, natural_key(one.room))
    )


def say_routes(results: Results) -> list[str]:
    """Return what a summary says of the routes; nothing where the workbook names none."""
    routes = results.route_tables
    if not results.has_routes:
        return []
    return [
        count_routes(routes),
        *count_rooms(routes),
        *say_reservations(routes),
        say_expected(routes),
        *say_not_counted(routes),
        *say_to_fill_in(routes),
        *_say_rooms(routes),
        *_say_beside(routes),
    ]


def _say_rooms(routes: RouteTables) -> list[str]:
    if not routes.rooms:
        return [_("No room has a way out in the workbook, so none is evaluated.")]
    found = list_rooms_at_risk(routes)
    if not found:
        return []
    return [_("The room most likely to lose all exits is {room} with {chance}.",
              room=words.cut(found[0].room, 30), chance=say_chance(found[0].loses_every_exit))]  # fmt: skip


def _say_beside(routes: RouteTables) -> list[str]:
    """Say which routes depend on anchors, how many segments are too narrow as they stand, and what is left out."""
    texts = []
    held = [one.route for one in routes.routes if is_held(one, routes.risk)]
    if held:
        texts.append(ngettext("If anchors fail, {n:,} route is worse: {names}.",
                              "If anchors fail, {n:,} routes are worse: {names}.",
                              len(held), names=name_few(held)))  # fmt: skip
    short = sum(one.insufficient_for_occupants for one in routes.segments)
    if short:
        texts.append(ngettext("{n:,} segment is too narrow for its occupants as it stands.",
                              "{n:,} segments are too narrow for their occupants as they stand.", short))  # fmt: skip
    if routes.uncounted_pieces:
        texts.append(say_uncounted(routes))
    return texts
