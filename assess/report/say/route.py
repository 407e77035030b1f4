"""What is said of evacuation routes: states, chances, what decides and what to fix or to fill in."""

from collections.abc import Callable, Sequence
from typing import TypeVar

from assess.i18n import gettext as _, nfill, ngettext, number
from assess.report import measures, words
from assess.report.provenance import say_reference
from assess.results import Results
from assess.route_results import (
    DOUBTS,
    FLAGS,
    Chance,
    MissingRow,
    RoomRow,
    RouteRow,
    RouteState,
    RouteTables,
    SegmentRow,
    WayRow,
    find_state,
    join_missing,
)
from assess.routes.widths import LEVEL, RULES, STAIR
from assess.text import natural_key
from assess.units import LENGTH
from assess.workbook.draft_names import is_draft
from assess.workbook.schema import DEFAULT_WIDTH

MOST_NAMED = 3
"""Names that stand in one cell; of a longer list it is said how many more there are."""

UNPLACED = ("positions", "places", "ends", "stair_floor")
"""What is missing, as keys of `assess.route_results.MISSING`, where pieces are left out."""

_Row = TypeVar("_Row")


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


def is_held(one: SegmentRow | RouteRow, risk: float) -> bool:
    """Tell whether anchors alone keep the state of something from being worse, by the chosen risk."""
    fails = one.blocked_if_anchors_fail
    if fails is None or one.state not in (RouteState.OPEN, RouteState.DOUBTFUL):
        return False
    return find_state(fails, risk).severity > one.state.severity


def say_outlook(one: SegmentRow | RouteRow, risk: float) -> str:
    """Return the state of a segment or a route at the chosen risk [-].

    It is said where anchors alone keep it from being worse, and where it is blocked with nothing fallen.
    """
    if one.is_blocked_standing if isinstance(one, SegmentRow) else not one.is_fixed:
        standing = _("blocked as it stands")
        return f"{RouteState.BLOCKED.symbol} {standing}"
    if not is_held(one, risk):
        return say_state(one.state)
    is_open = one.state == RouteState.OPEN
    said = _("open if the anchors hold") if is_open else _("doubtful, and blocked if the anchors fail")
    return f"{one.state.symbol} {said} ⚓"


def say_room_state(one: RoomRow) -> str:
    """Return the state of the best way from a room to the street."""
    standing = _("blocked as it stands")
    return say_state(one.state) if one.is_fixed else f"{RouteState.BLOCKED.symbol} {standing}"


# ---------------------------------------------------------------- chances


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
    if not chance.pieces:
        known = _("no free-standing piece reaches it")
    elif chance.is_joint:
        known = ngettext("{n:,} draw, all together", "{n:,} draws, all together", chance.runs)
    elif chance.unverified:
        known = ngettext("bounds: {unverified:,} of {n:,} piece by the formula's chance alone",
                         "bounds: {unverified:,} of {n:,} pieces by the formula's chance alone", chance.pieces,
                         unverified=chance.unverified)  # fmt: skip
    else:
        known = _("bounds: the pieces were decided after different numbers of draws")
    if not chance.unconfirmed:
        return known
    left = ngettext("{n:,} unconfirmed piece taken as standing", "{n:,} unconfirmed pieces taken as standing",
                    chance.unconfirmed)  # fmt: skip
    return f"{known}; {left}" if chance.pieces else left


def find_chance(one: SegmentRow | RouteRow) -> float:
    """Return the chance by which rows are ordered: 0 if not evaluated, with unconfirmed pieces fallen if not known."""
    found = one.blocked_if_unconfirmed_fall if one.state == RouteState.NOT_KNOWN else one.blocked
    return found.probability if found else 0.0


def say_segment(one: SegmentRow) -> str:
    """Return the name of a segment with its route."""
    return f"{words.cut(one.route, 40)}: {words.cut(one.segment, 40)}"


def say_risk(risk: float) -> str:
    """Return the chosen risk, ``3 %``."""
    return f"{number(100 * risk, 'g')} %"


def say_bounds(chance: Chance) -> str:
    """Return the bounds of a chance, independent and fully correlated, ``58.1 / 34.0 %``."""
    independent, correlated = words.in_percent(chance.independent), words.in_percent(chance.correlated)
    return f"{independent} / {correlated} %".replace(" ", words.NO_BREAK)


# ---------------------------------------------------------------- what is assumed


def list_cautions(routes: RouteTables) -> list[str]:
    """Return the assumptions of the evaluation of routes, and what it leaves out."""
    raised = {flag for one in routes.segments for near in one.pieces for flag in near.flags}
    doubts = (
        _("A piece whose class is not confirmed counts as standing and as fallen. A segment, route or room whose state "
          "differs between the two is not known, and is left out of expected numbers; what is blocked with such pieces "
          "standing is blocked."),
        _("What to fix, and the chances if anchors fail, count unconfirmed pieces as fallen, which is on the safe "
          "side."),
    )  # fmt: skip
    return [
        _("This is screening. No published rule exists for how much of a route a fallen piece takes; the following is "
          "used."),
        _("A piece counts as falling toward the route unless the plan shows that it cannot reach it. Fallen, it covers "
          "Height × Width from its edge on, and where it stood."),
        _("Walls are known only where Routes names the Room of a segment: placed pieces of other rooms do not count "
          "there. Where it is blank, they count through a wall as well."),
        _("The width left is the smallest that some chain of fallen pieces cuts off. A piece known by its Edge "
          "distance alone may stand at any place and face any other."),
        _("A segment is blocked if the width left is below the required one; a route is blocked if a room or an open "
          "end that it serves is cut off from its way out, and a room if all its ways to the street are."),
        _("Segments, routes and the ways of rooms that are blocked under the recorded motion itself count as blocked "
          "whatever their chance."),
        _("Not known: a piece without a position or Route may stand in the way, a stair has no Clear width, or the "
          "class of a piece is not confirmed. Pieces without a position or Route matter where the chance that any of "
          "them falls could change the state; anchored pieces and those on another floor or in another room do not "
          "matter. Nothing falls on a stair but pieces that name it."),
        _("Not counted: pieces that slide or roll on castors, spilt contents, doors that jam or are shut, and people."),
        _("Chances assume that all anchors hold. Simulated pieces fall as they did draw by draw: a draw is one "
          "earthquake, stronger or weaker by the same factor on all floors. Others fall independently. The results for "
          "full independence and full correlation are given as well, as equal pieces fall together."),
        _("Where not all pieces of a route were simulated in the same draws, its chance is the largest of the three, "
          "with their range in brackets. Where there are too many outcomes to evaluate all, {n:,} are drawn at random.",
          n=routes.draws),
        *(doubts if raised.intersection(DOUBTS.values()) else ()),
    ]  # fmt: skip


def say_occupants(one: SegmentRow) -> str:
    """Return the width that its occupants need and the chance that less is left; a dash where none are given."""
    if one.needed_width_m is None:
        return words.DASH
    needed = measures.say(one.needed_width_m, "m")
    if one.insufficient_for_occupants:
        return _("{width}: insufficient for occupants", width=needed)
    if one.insufficient_after_falls is None and one.evaluated:
        return _("{width}: not known whether less is left", width=needed)
    if one.insufficient_after_falls is None or one.insufficient_after_falls.high == 0:
        return needed
    return _("{width}: less in {chance}", width=needed, chance=say_chance(one.insufficient_after_falls))


def say_missing(missing: Sequence[MissingRow], *, has_cells: bool = True) -> str:
    """Return what to fill in, and in which cells if wanted; "" if nothing is missing."""
    texts = []
    for one in missing:
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
            "rolls": _("park {names} out of the way, or tether it and set Anchored to yes", names=names),
            "unconfirmed_motions": _("run with motions of your own that reach the PFA and PFV of the floor"),
        }[one.what]
        texts.append(f"{said} ({cells})" if cells and has_cells else said)
    return "; ".join(texts)


def say_missing_after(one: RouteRow | RoomRow, *, has_cells: bool = True) -> str:
    """Return what keeps a route or a room's way from being known once its fixes are done; "" where nothing does."""
    fix = say_missing(one.missing_after, has_cells=has_cells)
    return _("not known then; to settle it: {fix}", fix=fix) if fix else ""


def list_unfixable(routes: RouteTables) -> list[tuple[RouteRow, str]]:
    """Return the routes that are blocked with nothing fallen, each with the segments where."""
    found = []
    for one in routes.routes:
        if not one.is_fixed:
            own = (routes.segments[at] for at in one.segment_indices)
            found.append((one, name_few([segment.segment for segment in own if segment.is_blocked_standing])))
    return found


def name_few(names: Sequence[str]) -> str:
    """Return the first of some names, cut, and how many more there are; a draft ``route: segment`` keeps its mark."""
    cut = []
    for name in names:
        route, mark, segment = name.rpartition(": ")
        is_both = is_draft(route)
        cut.append(f"{words.cut(route, 30)}{mark}{words.cut(segment, 20)}" if is_both else words.cut(name, 40))
    return words.name_first(cut, MOST_NAMED)


def say_way(way: WayRow, routes: RouteTables) -> str:
    """Return a way out: where it ends, by which segments, the chance of a blockage, and what the first way shares."""
    names = [routes.segments[at].segment for at in way.segment_indices]
    segments, shared = (
        words.name_first([words.cut(name, 30) for name in some], MOST_NAMED) for some in (names, way.shared)
    )
    chance = say_between(way.blocked, way.blocked_if_unconfirmed_fall, is_known=way.is_known)
    said = _("{end} by {segments}: {chance}", end=words.cut(way.end, 40), segments=segments, chance=chance)
    return _("{way}; shares {segments} with the first", way=said, segments=shared) if way.shared else said


def say_left_out(segments: Sequence[str]) -> str:
    """Return how many segments are not evaluated; nothing where all are."""
    return ngettext("{n:,} segment not evaluated", "{n:,} segments not evaluated", len(segments)) if segments else ""


def list_widths() -> list[tuple[str, list[str]]]:
    """Return the publications that ask for widths, each with what it asks for where."""
    found: dict[str, list[str]] = {}
    for rule in RULES:
        asked = _("{width}: {where}", width=measures.say(rule.width, "m"), where=_(rule.holds))
        found.setdefault(say_reference(rule.reference), []).append(asked)
    return list(found.items())


def say_default_width() -> str:
    """Return the width that counts where the workbook gives none, and what an occupant needs."""
    return _("Where the workbook gives no Required width, {default} is taken. Occupants need {level:g} mm each, on "
             "stairs {stair:g} mm (0.2 and 0.3 in, International Building Code, section 1005.3).",
             default=measures.say(DEFAULT_WIDTH, "m"), level=LEVEL / LENGTH["mm"],
             stair=STAIR / LENGTH["mm"])  # fmt: skip


# ---------------------------------------------------------------- sentences


def describe_routes(routes: RouteTables) -> list[str]:
    """Return the routes of a building in plain words, as sentences."""
    return [*count_all(routes), _("These are chances in an earthquake like this one, not per year.")]


def count_all(routes: RouteTables) -> list[str]:
    """Return how many routes and rooms are in which state, on what that rests, and how many would be blocked."""
    texts = [
        ngettext("{n:,} evacuation route: {states}.", "{n:,} evacuation routes: {states}.", len(routes.routes),
                 states=count_states([one.state for one in routes.routes])),
        *count_rooms(routes),
        *say_reservations(routes),
    ]  # fmt: skip
    blocked = words.fixed(routes.blocked_routes_expected, 2)
    if routes.rooms:
        texts.append(_("On average {count} routes would be blocked and {rooms} rooms would lose all exits.",
                       count=blocked, rooms=words.fixed(routes.cut_off_rooms_expected, 2)))  # fmt: skip
    else:
        texts.append(_("On average {count} routes would be blocked.", count=blocked))
    if routes.unknown_routes or routes.unknown_rooms:
        texts.append(_("Left out of these averages, as not known: routes {routes:,}, rooms {rooms:,}.",
                       routes=routes.unknown_routes, rooms=routes.unknown_rooms))  # fmt: skip
    return texts


def say_reservations(routes: RouteTables) -> list[str]:
    """Return that routes are drafts, and that rooms have no furniture listed: states may rest on less than is there."""
    drafts = say_drafts(routes)
    if any(row.what == "furniture" for one in routes.segments for row in one.missing):
        return [*drafts, _("No furniture is listed, so whether ways through rooms stay open is not known.")]
    if routes.furnished_rooms == routes.counted_rooms:
        return drafts
    return [
        *drafts,
        ngettext("No furniture is listed in the only room or corridor: ways through it count as free of furniture.",
                 "Furniture is listed in {listed:,} of {n:,} rooms and corridors. Ways through the others count as "
                 "free of furniture.", routes.counted_rooms, listed=routes.furnished_rooms),
    ]  # fmt: skip


def say_drafts(routes: RouteTables) -> list[str]:
    """Return how many routes are drafts that nobody has walked; nothing where none is."""
    drafts = sum(is_draft(one.route) for one in routes.routes)
    return [ngettext("{n:,} of {all:,} routes is a draft from a building model that nobody has walked yet.",
                     "{n:,} of {all:,} routes are drafts from a building model that nobody has walked yet.",
                     drafts, all=len(routes.routes))] if drafts else []  # fmt: skip


def count_rooms(routes: RouteTables) -> list[str]:
    """Return how many rooms have a best way to the street in which state, and which have none in the workbook."""
    texts, unjoined = [], routes.unjoined_rooms
    if routes.rooms:
        texts.append(ngettext("Best way from {n:,} room to the street: {states}.",
                              "Best way from each of {n:,} rooms to the street: {states}.", len(routes.rooms),
                              states=count_states([one.state for one in routes.rooms])))  # fmt: skip
    if unjoined:
        texts.append(ngettext(
            "The workbook joins {n:,} more room to no exit or stair, so that its way out is not known: {named}. Add "
            "the way to Routes.",
            "The workbook joins {n:,} more rooms to no exit or stair, so that their way out is not known: {named}. Add "
            "the ways to Routes.",
            len(unjoined), named=words.name_first([words.cut(room, 30) for room in unjoined], MOST_NAMED),
        ))  # fmt: skip
    return texts


def count_states(states: Sequence[RouteState]) -> str:
    """Return how many of some routes or rooms are in which state: ``3 blocked, 14 open``."""
    texts = {
        RouteState.OPEN: nfill("{n:,} open", "{n:,} open", 0),
        RouteState.DOUBTFUL: nfill("{n:,} doubtful", "{n:,} doubtful", 0),
        RouteState.BLOCKED: nfill("{n:,} blocked", "{n:,} blocked", 0),
        RouteState.NOT_KNOWN: nfill("{n:,} not known", "{n:,} not known", 0),
    }
    counts = [(texts[one], states.count(one)) for one in sorted(RouteState, key=lambda one: -one.severity)]
    return ", ".join(ngettext(text.template, text.many, n) for text, n in counts if n)


def say_to_fill_in(routes: RouteTables) -> list[str]:
    """Return what to fill in so that routes and rooms are known; nothing where all are."""
    of_rooms = [row for one in routes.rooms for row in one.missing]
    missing = join_missing([row for one in routes.routes for row in one.missing] + of_rooms)
    return [_("To settle what is not known: {fix}.", fix=say_missing(missing))] if missing else []


def say_uncounted(routes: RouteTables) -> str:
    """Return how many pieces are left out, as it is unknown whether they fall onto a route; nothing without any."""
    count = routes.uncounted_pieces
    if not count:
        return ""
    left_out = ngettext("{n:,} piece has no usable position or route and is left out.",
                        "{n:,} pieces have no usable position or route and are left out.", count)  # fmt: skip
    rows: list[RouteRow | RoomRow] = [*routes.routes, *routes.rooms]
    if any(row.what in UNPLACED for one in rows for row in one.missing):
        return left_out
    if any(row.what in UNPLACED for one in rows for row in one.missing_after):
        later = _("They could change a result above once the pieces listed are fixed.")
        return f"{left_out} {later}"
    if any(row.what in UNPLACED for one in routes.segments for row in one.missing):
        return left_out
    none = _("They could not change any result above.")
    return f"{left_out} {none}"


def say_routes(results: Results) -> list[str]:
    """Return what a summary says of the routes; nothing where the workbook names none."""
    routes = results.route_tables
    if not results.has_routes:
        return []
    texts = [*count_all(routes), *say_to_fill_in(routes)]
    at_risk = (RouteState.DOUBTFUL, RouteState.BLOCKED)
    rooms = [(one.loses_every_exit, one.room) for one in routes.rooms if one.state in at_risk]
    if not routes.rooms:
        texts.append(_("No room has a way out in the workbook, so none is evaluated."))
    elif rooms:
        chance, room = min(rooms, key=lambda one: (-one[0].probability, -one[0].high, natural_key(one[1])))
        texts.append(_("The room most likely to lose all exits is {room} with {chance}.", room=words.cut(room, 30),
                       chance=say_chance(chance)))  # fmt: skip
    texts += say_held(routes)
    if short := sum(one.insufficient_for_occupants for one in routes.segments):
        texts.append(ngettext("{n:,} segment is too narrow for its occupants as it stands.",
                              "{n:,} segments are too narrow for their occupants as they stand.", short))  # fmt: skip
    return [*texts, *([say_uncounted(routes)] if routes.uncounted_pieces else [])]


def say_held(routes: RouteTables) -> list[str]:
    """Return which ways out only anchors keep as they are; nothing where none."""
    held = [one.route for one in routes.routes if is_held(one, routes.risk)]
    return [ngettext("Way out {names} stays as it is only if the anchors beside it hold.",
                     "Ways out {names} stay as they are only if the anchors beside them hold.", len(held),
                     names=name_few(held))] if held else []  # fmt: skip


def choose_rows(rows: Sequence[_Row], most: int, chance: Callable[[_Row], float]) -> list[_Row]:
    """Return rows in their own order where they are few enough, else the likeliest."""
    return list(rows) if len(rows) <= most else sorted(rows, key=lambda row: -chance(row))[:most]


def list_segments(routes: RouteTables, most: int, *, is_short: bool = False) -> list[tuple[int, SegmentRow]]:
    """Return segments, or the likeliest to be blocked, with numbers from 1; a short list leaves out untouched ones."""
    numbered = [(at, one) for at, one in enumerate(routes.segments, start=1) if not is_short or not is_untouched(one)]
    return choose_rows(numbered, most, lambda row: find_chance(row[1]))


def is_untouched(one: SegmentRow) -> bool:
    """Tell whether a segment was evaluated, no piece reaches it, and it needs no remark."""
    if one.pieces or one.other_rooms or one.insufficient_for_occupants or one.is_blocked_standing or not one.evaluated:
        return False
    return {*one.flags} <= {"own_rooms", "walls_unknown", "required_assumed"}  # of no matter where no piece reaches it


def list_flags(routes: RouteTables) -> dict[str, str]:
    """Return the marks that occur, and what each means; where its own rooms count, they are named instead."""
    raised = [one.flags for one in routes.segments] + [near.flags for one in routes.segments for near in one.pieces]
    found = {flag for flags in raised for flag in flags if flag != "own_rooms"}
    return {flag: _(text) for flag, text in FLAGS.items() if flag in found}


def list_at_risk(routes: RouteTables) -> list[RouteRow]:
    """Return the routes that are not open, the worst first."""
    found = [one for one in routes.routes if one.state != RouteState.OPEN]
    return sorted(found, key=lambda one: (-one.state.severity, -find_chance(one), natural_key(one.route)))
