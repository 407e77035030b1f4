"""The words for evacuation routes: what may become of them, how likely, and what that rests on."""

from collections.abc import Callable, Sequence
from typing import TypeVar

from assess.inventory.routes import DEFAULT_WIDTH
from assess.language import gettext as _
from assess.language import ngettext, number
from assess.report import words
from assess.report.provenance import say_reference
from assess.routes.model import (
    FLAGS,
    Beside,
    Chance,
    Outlook,
    RouteFix,
    RouteResult,
    Routes,
    RouteState,
    SegmentResult,
    Way,
)
from assess.routes.widths import LEVEL, RULES, STAIR
from assess.units import LENGTH

MOST_NAMED = 3
"""Names that stand in one cell; of a longer list it is said how many more there are."""
Row = TypeVar("Row")


def say_state(state: RouteState) -> str:
    """Return a state with its sign, as a chance: ``✕ may be blocked``."""
    said = {
        RouteState.OPEN: _("open"),
        RouteState.REDUCED: _("may be reduced"),
        RouteState.BLOCKED: _("may be blocked"),
    }
    return f"{state.symbol} {said[state]}"


def say_outlook(outlook: Outlook) -> str:
    """Return the state, and the one that it may come to by the upper end of the interval."""
    if outlook.blocked.low >= 1:
        blocked = _("blocked")
        return f"{RouteState.BLOCKED.symbol} {blocked}"
    said = say_state(outlook.state)
    if outlook.upper == outlook.state:
        return said
    upper = say_state(outlook.upper)
    return _("{state}, not excluded: {upper}", state=said, upper=upper)


def say_standing() -> str:
    """Return what is said of a segment or route that is blocked with nothing fallen."""
    standing = _("blocked as it stands")
    return f"{RouteState.BLOCKED.symbol} {standing}"


def say_segment_state(one: SegmentResult) -> str:
    """Return the state of a segment, told apart from one that is blocked with nothing fallen."""
    return say_standing() if one.is_blocked_standing else say_outlook(one.outlook)


def say_route_state(one: RouteResult) -> str:
    """Return the state of a route, told apart from one that is blocked with nothing fallen."""
    return say_standing() if is_blocked_standing(one) else say_outlook(one.outlook)


def is_blocked_standing(one: RouteResult) -> bool:
    """Tell whether a route is blocked with nothing fallen: no anchor helps it then."""
    return not one.is_mended


def say_chance(chance: Chance) -> str:
    """Return a chance with its interval, ``15.5 % (11.1 to 21.2 %)``; one whose ends are the same stands alone."""
    shown = words.percent(chance.probability)
    if words.in_percent(chance.low) == words.in_percent(chance.high):
        return shown
    interval = _("({low} to {high} %)", low=words.in_percent(chance.low), high=words.in_percent(chance.high))
    return f"{shown} {interval.replace(' ', words.NO_BREAK)}"


def say_basis(chance: Chance) -> str:
    """Return what a chance rests on: the motions of a joint outcome, or the pieces that enter by their bounds."""
    if not chance.pieces:
        return _("no free-standing piece reaches it")
    if chance.is_joint:
        return ngettext("{n:,} motion, all together", "{n:,} motions, all together", chance.runs)
    if chance.unverified:
        return ngettext(
            "bounds: {n:,} of {pieces:,} pieces is not verified",
            "bounds: {n:,} of {pieces:,} pieces are not verified",
            chance.unverified,
            pieces=chance.pieces,
        )
    return _("bounds: the floors' motions come from different sources")


def say_recorded(outlook: Outlook) -> str:
    """Return the state under the recorded motion itself."""
    state = outlook.in_record
    said = {RouteState.OPEN: _("open"), RouteState.REDUCED: _("reduced"), RouteState.BLOCKED: _("blocked")}
    return words.DASH if state is None else f"{state.symbol} {said[state]}"


def say_segment(one: SegmentResult) -> str:
    """Return the name of a segment with its route."""
    return f"{words.cut(one.segment.route, 40)}: {words.cut(one.segment.segment, 40)}"


def say_risk(risk: float) -> str:
    """Return the chosen risk, ``3 %``."""
    return f"{number(100 * risk, 'g')} %"


def say_bounds(chance: Chance) -> str:
    """Return the bounds beside a chance, independent and fully correlated, ``58.1 / 34.0 %``."""
    independent, correlated = words.in_percent(chance.independent), words.in_percent(chance.correlated)
    return f"{independent} / {correlated} %".replace(" ", words.NO_BREAK)


# ---------------------------------------------------------------- sentences


def describe_routes(routes: Routes) -> list[str]:
    """Return the routes of a building in plain words, as sentences."""
    states = [one.outlook.state for one in routes.routes]
    blocked, reduced = states.count(RouteState.BLOCKED), states.count(RouteState.REDUCED)
    return [
        ngettext(
            "{n:,} evacuation route: {blocked:,} may be blocked, {reduced:,} may be reduced, {open:,} stay open.",
            "{n:,} evacuation routes: {blocked:,} may be blocked, {reduced:,} may be reduced, {open:,} stay open.",
            len(states),
            blocked=blocked,
            reduced=reduced,
            open=len(states) - blocked - reduced,
        ),
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


def list_cautions(routes: Routes) -> list[str]:
    """Return what the evaluation of routes takes for granted, and what it leaves out."""
    return [
        _("This is screening: no closed rule is published for what a fallen piece takes from a route; ours is this."),
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
        _(
            "A segment is blocked where the width left is under the required one, reduced where pieces take width and "
            "it is not; a route is blocked where a room or an open end that it serves is cut off from its way out."
        ),
        _("Not counted: pieces that slide or roll on castors, spilt contents, doors that jam or are shut, and people."),
        _(
            "Chances hold if all anchors do. Pieces that were verified together fall as they did motion by motion, "
            "others independently; what full independence and full correlation give stands beside, as equal pieces "
            "fall together."
        ),
        _(
            "Where not all pieces of a route were verified together, the largest of the three is its chance, in "
            "brackets their range. Where outcomes are too many to go through, {n:,} are drawn.",
            n=routes.draws,
        ),
    ]


def list_flags(routes: Routes) -> dict[str, str]:
    """Return the marks that occur, and what each means; where its own rooms count, they are named instead."""
    raised = [one.flags for one in routes.segments] + [near.flags for one in routes.segments for near in one.beside]
    found = {flag for flags in raised for flag in flags if flag != "own_rooms"}
    return {flag: _(text) for flag, text in FLAGS.items() if flag in found}


def say_occupants(one: SegmentResult) -> str:
    """Return the width that its occupants need and the chance that less is left; a dash where none are given."""
    if one.needed is None or one.crowded is None:
        return words.DASH
    needed = words.in_m(one.needed)
    if one.is_short:
        return _("{width} m: insufficient for occupants", width=needed)
    if one.crowded.high == 0:
        return _("{width} m", width=needed)
    return _("{width} m: less in {chance}", width=needed, chance=say_chance(one.crowded))


# ---------------------------------------------------------------- lists


def choose_rows(rows: Sequence[Row], most: int, chance: Callable[[Row], float]) -> list[Row]:
    """Return rows in their own order where they are few enough, else the likeliest."""
    return list(rows) if len(rows) <= most else sorted(rows, key=lambda row: -chance(row))[:most]


def list_segments(routes: Routes, most: int) -> list[tuple[int, SegmentResult]]:
    """Return segments with their numbers, from 1: all, or those most likely to be blocked."""
    numbered = list(enumerate(routes.segments, start=1))
    return choose_rows(numbered, most, lambda row: row[1].outlook.blocked.probability)


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


def list_unmended(routes: Routes) -> list[tuple[RouteResult, str]]:
    """Return the routes that are blocked with nothing fallen, each with the segments where."""
    found = [one for one in routes.routes if is_blocked_standing(one)]
    narrow = [[routes.segments[at] for at in one.segments if routes.segments[at].is_blocked_standing] for one in found]
    return [
        (one, name_few([segment.segment.segment for segment in own])) for one, own in zip(found, narrow, strict=True)
    ]


def name_untouched(routes: Routes) -> tuple[int, str]:
    """Return how many routes are under the chosen risk as they are, and their names."""
    names = [words.cut(one.route, 40) for one in routes.routes if one.is_mended and not one.fixes]
    return len(names), words.name_first(names, 12)


def name_few(names: Sequence[str]) -> str:
    """Return the first of some names of the workbook, cut, and how many more there are."""
    return words.name_first([words.cut(name, 40) for name in names], MOST_NAMED)


def say_way(way: Way, routes: Routes) -> str:
    """Return a way out: where it ends, by which segments, and the chance that it is blocked."""
    names = [words.cut(routes.segments[at].segment.segment, 30) for at in way.segments]
    return _(
        "{end} by {segments}: {chance}",
        end=words.cut(way.end, 40),
        segments=words.name_first(names, MOST_NAMED),
        chance=say_chance(way.blocked),
    )


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
