"""What is said of evacuation routes: states, chances, what decides and what to fix or to fill in."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from assess.i18n import gettext as _
from assess.i18n import ngettext, number
from assess.natural import natural_key
from assess.report import words
from assess.report.provenance import say_reference
from assess.results import ItemResult, ItemRow, Results
from assess.route_results import (
    BLOCKED_FROM,
    DOUBTS,
    FLAGS,
    BesideRow,
    Chance,
    MissingRow,
    RoomRow,
    RouteFixRow,
    RouteRow,
    RouteState,
    RouteTables,
    SegmentRow,
    WayRow,
    find_state,
    join_missing,
)
from assess.routes.widths import LEVEL, RULES, STAIR
from assess.units import LENGTH
from assess.workbook.draft_names import is_draft
from assess.workbook.schema import DEFAULT_WIDTH

MOST_NAMED = 3
"""Names that stand in one cell; of a longer list it is said how many more there are."""


def say_state(state: RouteState) -> str:
    """Return a state with its sign: ``✕ blocked``."""
    return f"{state.symbol} {name_state(state)}"


def name_state(state: RouteState) -> str:
    """Return a state in words."""
    return {
        RouteState.OPEN: _("open"),
        RouteState.DOUBTFUL: _("doubtful"),
        RouteState.BLOCKED: _("blocked"),
        RouteState.NOT_KNOWN: _("not known"),
    }[state]


def count_state(state: RouteState, n: int) -> str:
    """Return how many routes or rooms are in a state: ``3 blocked``."""
    return {
        RouteState.OPEN: ngettext("{n:,} open", "{n:,} open", n),
        RouteState.DOUBTFUL: ngettext("{n:,} doubtful", "{n:,} doubtful", n),
        RouteState.BLOCKED: ngettext("{n:,} blocked", "{n:,} blocked", n),
        RouteState.NOT_KNOWN: ngettext("{n:,} not known", "{n:,} not known", n),
    }[state]


def list_rules(risk: float) -> list[tuple[RouteState, str]]:
    """Return the states, the worst first, and when each holds at the chosen risk [-]."""
    limit = say_risk(risk)
    return [
        (RouteState.BLOCKED, _("chance {limit} or more", limit=say_risk(BLOCKED_FROM))),
        (RouteState.NOT_KNOWN, _("something missing could change the state")),
        (RouteState.DOUBTFUL, _("less, but its range reaches {limit}", limit=limit)),
        (RouteState.OPEN, _("its whole range is below {limit}", limit=limit)),
    ]


def _say_outlook(one: SegmentRow | RouteRow, risk: float) -> str:
    """Return the state; with what anchors alone keep from being worse."""
    if not is_held(one, risk):
        return say_state(one.state)
    if one.state == RouteState.OPEN:
        said = _("open if the anchors hold")
    else:
        said = _("doubtful, and blocked if the anchors fail")
    return f"{one.state.symbol} {said} ⚓"


def is_held(one: SegmentRow | RouteRow, risk: float) -> bool:
    """Tell whether anchors alone keep the state of something from being worse, by the chosen risk."""
    fails = one.blocked_if_anchors_fail
    if fails is None or one.state not in (RouteState.OPEN, RouteState.DOUBTFUL):
        return False
    return find_state(fails, risk).severity > one.state.severity


def say_standing() -> str:
    """Return the state of a segment or route that is blocked with nothing fallen."""
    standing = _("blocked as it stands")
    return f"{RouteState.BLOCKED.symbol} {standing}"


def say_segment_state(one: SegmentRow, risk: float) -> str:
    """Return the state of a segment, as distinct from one blocked with nothing fallen."""
    return say_standing() if one.is_blocked_standing else _say_outlook(one, risk)


def say_route_state(one: RouteRow, risk: float) -> str:
    """Return the state of a route, as distinct from one blocked with nothing fallen."""
    return say_standing() if is_blocked_standing(one) else _say_outlook(one, risk)


def say_room_state(one: RoomRow) -> str:
    """Return the state of the best way from a room to the street."""
    return say_standing() if is_blocked_standing(one) else say_state(one.state)


def is_blocked_standing(one: RouteRow | RoomRow) -> bool:
    """Tell whether a route or a room's way out is blocked with nothing fallen: no anchor helps it then."""
    return not one.is_fixed


def say_chance(chance: Chance) -> str:
    """Return a chance with its interval."""
    return words.say_chance(chance.probability, chance.low, chance.high)


def say_blocked(one: SegmentRow | RouteRow) -> str:
    """Return the chance of a blockage; what it depends on where it is not known, a dash where it is not evaluated."""
    if one.blocked is None:
        return words.DASH
    return say_between(one.blocked, one.blocked_if_unconfirmed_fall, is_known=one.state != RouteState.NOT_KNOWN)


def say_taken(one: SegmentRow | RouteRow) -> str:
    """Return the chance that it is narrowed or blocked; a dash where that is not known."""
    if one.blocked_or_reduced is None or one.state == RouteState.NOT_KNOWN:
        return words.DASH
    return say_chance(one.blocked_or_reduced)


def say_lost(one: RoomRow) -> str:
    """Return the chance that a room loses every exit; what it depends on where it is not known."""
    return say_between(one.loses_every_exit, one.loses_if_unconfirmed_fall, is_known=one.is_known)


def say_between(standing: Chance, fallen: Chance | None, *, is_known: bool) -> str:
    """Return a chance; where it is not known, those with unconfirmed pieces standing and fallen, or at least that."""
    low, high = (words.in_percent(one.probability) for one in (standing, fallen or standing))
    if is_known:
        return say_chance(standing)
    if low == high:
        said = _("not known (at least {low} %)", low=low) if standing.high else _("not known")
        return said.replace(" ", words.NO_BREAK)
    return _("not known ({low} to {high} %)", low=low, high=high).replace(" ", words.NO_BREAK)


def say_basis(chance: Chance) -> str:
    """Return what a chance rests on: the draws of a joint outcome, or the pieces that enter by their bounds."""
    if not chance.unconfirmed:
        return _say_known_basis(chance)
    left = ngettext("{n:,} unconfirmed piece taken as standing", "{n:,} unconfirmed pieces taken as standing",
                    chance.unconfirmed)  # fmt: skip
    return f"{_say_known_basis(chance)}; {left}" if chance.pieces else left


def _say_known_basis(chance: Chance) -> str:
    if not chance.pieces:
        return _("no free-standing piece reaches it")
    if chance.is_joint:
        return ngettext("{n:,} draw, all together", "{n:,} draws, all together", chance.runs)
    if chance.unverified:
        return ngettext(
            "bounds: {unverified:,} of {n:,} piece by the formula's chance alone",
            "bounds: {unverified:,} of {n:,} pieces by the formula's chance alone",
            chance.pieces,
            unverified=chance.unverified,
        )
    return _("bounds: the pieces were decided after different numbers of draws")


def say_recorded(one: SegmentRow | RouteRow) -> str:
    """Return the state under the recorded motion itself."""
    state = one.under_record
    return words.DASH if state is None else say_state(state)


def find_chance(one: SegmentRow | RouteRow) -> float:
    """Return the chance of a blockage for putting rows in order: 0 where it is not evaluated.

    Where it is not known, that with unconfirmed pieces fallen.
    """
    found = one.blocked_if_unconfirmed_fall if one.state == RouteState.NOT_KNOWN else one.blocked
    return found.probability if found else 0.0


def say_segment(one: SegmentRow) -> str:
    """Return the name of a segment with its route."""
    return f"{words.cut(one.route, 40)}: {words.cut(one.segment, 40)}"


def say_risk(risk: float) -> str:
    """Return the chosen risk, ``3 %``."""
    return f"{number(100 * risk, 'g')} %"


def say_bounds(chance: Chance) -> str:
    """Return the bounds beside a chance, independent and fully correlated, ``58.1 / 34.0 %``."""
    independent, correlated = words.in_percent(chance.independent), words.in_percent(chance.correlated)
    return f"{independent} / {correlated} %".replace(" ", words.NO_BREAK)


# ---------------------------------------------------------------- sentences


def list_cautions(routes: RouteTables) -> list[str]:
    """Return the assumptions of the evaluation of routes, and what it leaves out."""
    return [*_of_pieces(), *_of_states(), *_of_chances(routes), *(_of_doubts() if list_doubts(routes) else ())]


def _of_pieces() -> tuple[str, ...]:
    return (
        _(
            "This is screening. No published rule exists for how much of a route a fallen piece takes; the following "
            "is used."
        ),
        _(
            "A piece counts as falling toward the route unless the plan shows that it cannot reach it. Fallen, it "
            "covers Height × Width from its edge on, and where it stood."
        ),
        _(
            "Walls are known only where Routes names the Room of a segment: placed pieces of other rooms do not count "
            "there. Where it is blank, they count through a wall as well."
        ),
        _(
            "The width left is the smallest that some chain of fallen pieces cuts off. A piece known by its Edge "
            "distance alone may stand at any place and face any other."
        ),
    )


def _of_states() -> tuple[str, ...]:
    return (
        _(
            "A segment is blocked if the width left is below the required one; a route is blocked if a room or an open "
            "end that it serves is cut off from its way out, and a room if all its ways to the street are."
        ),
        _(
            "Segments, routes and the ways of rooms that are blocked under the recorded motion itself count as blocked "
            "whatever their chance."
        ),
        _(
            "Not known: a piece without a position or Route may stand in the way, a stair has no Clear width, or the "
            "class of a piece is not confirmed. Pieces without a position or Route matter where the chance that any "
            "of them falls could change the state; anchored pieces and those on another floor or in another room do "
            "not matter. Nothing falls on a stair but pieces that name it."
        ),
        _("Not counted: pieces that slide or roll on castors, spilt contents, doors that jam or are shut, and people."),
    )


def _of_chances(routes: RouteTables) -> tuple[str, ...]:
    return (
        _(
            "Chances assume that all anchors hold. Simulated pieces fall as they did draw by draw: a draw is one "
            "earthquake, stronger or weaker by the same factor on all floors. Others fall independently. The results "
            "for full independence and full correlation are given as well, as equal pieces fall together."
        ),
        _(
            "Where not all pieces of a route were simulated in the same draws, its chance is the largest of the three, "
            "with their range in brackets. Where there are too many outcomes to evaluate all, {n:,} are drawn at "
            "random.",
            n=routes.draws,
        ),
    )


def _of_doubts() -> tuple[str, ...]:
    return (
        _(
            "A piece whose class is not confirmed counts as standing and as fallen. A segment, route "
            "or room whose state differs between the two is not known, and is left out of expected numbers; what is "
            "blocked with such pieces standing is blocked."
        ),
        _(
            "What to fix, and the chances if anchors fail, count unconfirmed pieces as fallen, which is on the safe "
            "side."
        ),
    )


def say_occupants(one: SegmentRow) -> str:
    """Return the width that its occupants need and the chance that less is left; a dash where none are given."""
    if one.needed_width_m is None:
        return words.DASH
    needed = words.in_m(one.needed_width_m)
    if one.insufficient_for_occupants:
        return _("{width} m: insufficient for occupants", width=needed)
    if one.insufficient_after_falls is None and one.evaluated:
        return _("{width} m: not known whether less is left", width=needed)
    if one.insufficient_after_falls is None or one.insufficient_after_falls.high == 0:
        return _("{width} m", width=needed)
    return _("{width} m: less in {chance}", width=needed, chance=say_chance(one.insufficient_after_falls))


# ---------------------------------------------------------------- what is not known


def list_doubts(routes: RouteTables) -> list[str]:
    """Return why pieces that reach routes are unconfirmed, as flags, each once."""
    raised = {flag for one in routes.segments for near in one.pieces for flag in near.flags}
    return [flag for flag in DOUBTS.values() if flag in raised]


def say_missing(missing: Sequence[MissingRow]) -> str:
    """Return what is to be filled in, and in which cells; nothing where nothing is missing."""
    return "; ".join(_say_one_missing(one) for one in missing)


def say_missing_after(one: RouteRow | RoomRow) -> str:
    """Return what keeps a route or a room's way from being known once its fixes are done; "" where nothing does."""
    return _("not known then; to settle it: {fix}", fix=say_missing(one.missing_after)) if one.missing_after else ""


def _say_one_missing(one: MissingRow) -> str:
    names, cells = name_few(one.names), words.name_first(one.cells, MOST_NAMED)
    said = {
        "clear_width": _("fill in the Clear width of {names}", names=names),
        "stair_pieces": _("check the Route of {names}: it names that stair", names=names),
        "stair_floor": _("fill in the Clear width of {names} and, as it is a stair, no Floor", names=names),
        "ends": _("fill in From, To and Floor of {names}", names=names),
        "places": _("fill in X and Y of {names}", names=names),
        "positions": _("fill in X and Y, or the Route, of {names}", names=names),
        "furniture": _("list the furniture of the building"),
        "beyond_stairs": _("add the way from {names} to an exit in Routes", names=names),
        "unconfirmed_building": _("enter Storeys or the Period T1 in the sheet Building"),
        "unconfirmed_motions": _("run with motions of your own that reach the PFA and PFV of the floor"),
    }[one.what]
    return f"{said} ({cells})" if cells else said


# ---------------------------------------------------------------- lists


def list_unfixable(routes: RouteTables) -> list[tuple[RouteRow, str]]:
    """Return the routes that are blocked with nothing fallen, each with the segments where."""
    found = [one for one in routes.routes if is_blocked_standing(one)]
    narrow = [
        [routes.segments[at] for at in one.segment_indices if routes.segments[at].is_blocked_standing] for one in found
    ]
    return [(one, name_few([segment.segment for segment in own])) for one, own in zip(found, narrow, strict=True)]


def name_few(names: Sequence[str]) -> str:
    """Return the first of some names of the workbook, cut, and how many more there are."""
    return words.name_first([_cut_name(name) for name in names], MOST_NAMED)


def _cut_name(name: str) -> str:
    """Return a name, cut; of ``route: segment`` either of both, so that the mark of a draft stays."""
    route, mark, segment = name.rpartition(": ")
    return f"{words.cut(route, 30)}{mark}{words.cut(segment, 20)}" if is_draft(route) else words.cut(name, 40)


def say_way(way: WayRow, routes: RouteTables) -> str:
    """Return a way out: where it ends, by which segments, the chance of a blockage, and what the first way shares."""
    segments = [routes.segments[at] for at in way.segment_indices]
    said = _(
        "{end} by {segments}: {chance}",
        end=words.cut(way.end, 40),
        segments=_name_segments([one.segment for one in segments]),
        chance=say_between(way.blocked, way.blocked_if_unconfirmed_fall, is_known=way.is_known),
    )
    if not way.shared:
        return said
    shared = _name_segments(way.shared)
    return _("{way}; shares {segments} with the first", way=said, segments=shared)


def _name_segments(names: Sequence[str]) -> str:
    return words.name_first([words.cut(name, 30) for name in names], MOST_NAMED)


def say_left_out(unevaluated: Sequence[str]) -> str:
    """Return how many segments are not evaluated; nothing where all are."""
    if not unevaluated:
        return ""
    return ngettext("{n:,} segment not evaluated", "{n:,} segments not evaluated", len(unevaluated))


def say_other_rooms(one: SegmentRow, results: Sequence[ItemResult]) -> str:
    """Return the pieces that would reach a segment, were they not in another room; nothing where there are none."""
    if not one.other_rooms:
        return ""
    items = [results[other.item_index].item for other in one.other_rooms]
    named = [f"{words.cut(item.item, 20)} ({words.cut(item.room, 20)})" if item.room else words.cut(item.item, 20)
             for item in items]  # fmt: skip
    return _("not counted, in another room: {pieces}", pieces=words.name_first(named, MOST_NAMED))


def name_rooms(one: SegmentRow) -> str:
    """Return the rooms that a segment runs through, split by commas."""
    return ", ".join(name for part in (one.room or "").split(";") if (name := part.strip()))


def list_widths() -> list[tuple[str, list[str]]]:
    """Return the publications that ask for widths, each with what it asks for where."""
    found: dict[str, list[str]] = {}
    for rule in RULES:
        asked = _("{width:g} m: {where}", width=rule.width, where=_(rule.holds))
        found.setdefault(say_reference(rule.reference), []).append(asked)
    return list(found.items())


def say_default_width() -> str:
    """Return the width that counts where the workbook gives none, and what an occupant needs."""
    return _(
        "Where the workbook gives no Required width, {default:g} m is taken. Occupants need {level:g} mm each, on "
        "stairs {stair:g} mm (0.2 and 0.3 in, International Building Code, section 1005.3).",
        default=DEFAULT_WIDTH,
        level=LEVEL / LENGTH["mm"],
        stair=STAIR / LENGTH["mm"],
    )


# ---------------------------------------------------------------- sentences and rows of the tables

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


# ---------------------------------------------------------------- the page of ways to the street

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


# ---------------------------------------------------------------- routes at risk

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
