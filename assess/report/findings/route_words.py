"""The words for evacuation routes: their states, how likely these are, and what that rests on."""

from collections.abc import Sequence

from assess.i18n import gettext as _
from assess.i18n import ngettext, number
from assess.report import words
from assess.report.provenance import say_reference
from assess.results import ItemResult
from assess.route_results import (
    BLOCKED_FROM,
    DOUBTS,
    Chance,
    MissingRow,
    RoomRow,
    RouteRow,
    RouteState,
    RouteTables,
    SegmentRow,
    WayRow,
)
from assess.routes.states import find_state
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
