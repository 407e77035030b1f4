"""The words for evacuation routes: what may become of them, how likely, and what that rests on."""

import math
from collections.abc import Sequence

from assess.inventory.routes import DEFAULT_WIDTH
from assess.language import gettext as _
from assess.language import ngettext, number
from assess.report import words
from assess.report.provenance import say_reference
from assess.results import ItemResult
from assess.routes.model import (
    Chance,
    Outlook,
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


def say_state(state: RouteState) -> str:
    """Return a state with its sign, as a chance: ``✕ may be blocked``."""
    said = {
        RouteState.OPEN: _("open"),
        RouteState.REDUCED: _("may be reduced"),
        RouteState.BLOCKED: _("may be blocked"),
    }
    return f"{state.symbol} {said[state]}"


def say_outlook(outlook: Outlook, risk: float = math.inf) -> str:
    """Return the state, and the one that it may come to by the upper end of the interval.

    With the chosen risk it is said as well where the state hangs on anchors.
    """
    if outlook.blocked.low >= 1:
        blocked = _("blocked")
        return f"{RouteState.BLOCKED.symbol} {blocked}"
    said = _say_held(outlook.state) if is_held(outlook, risk) else say_state(outlook.state)
    if outlook.upper == outlook.state:
        return said
    upper = say_state(outlook.upper)
    return _("{state}, not excluded: {upper}", state=said, upper=upper)


def _say_held(state: RouteState) -> str:
    if state == RouteState.OPEN:
        said = _("open if the anchors hold")
    else:
        said = _("may be reduced, and blocked if the anchors fail")
    return f"{state.symbol} {said} ⚓"


def is_held(outlook: Outlook, risk: float) -> bool:
    """Tell whether anchors alone keep something from being blocked, by the chosen risk."""
    fails = outlook.if_anchors_fail
    return outlook.state < RouteState.BLOCKED and fails is not None and fails.probability >= risk


def say_unevaluated() -> str:
    """Return what is said of a segment or route of which nothing tells what can reach it."""
    said = _("not evaluated")
    return f"{words.DASH} {said}"


def say_standing() -> str:
    """Return what is said of a segment or route that is blocked with nothing fallen."""
    standing = _("blocked as it stands")
    return f"{RouteState.BLOCKED.symbol} {standing}"


def say_segment_state(one: SegmentResult, risk: float = math.inf) -> str:
    """Return the state of a segment, told apart from one blocked with nothing fallen and from one not evaluated."""
    if one.is_blocked_standing:
        return say_standing()
    return say_outlook(one.outlook, risk) if one.is_evaluated else say_unevaluated()


def say_route_state(one: RouteResult, risk: float = math.inf) -> str:
    """Return the state of a route, told apart from one blocked with nothing fallen and from one not evaluated."""
    if is_blocked_standing(one):
        return say_standing()
    return say_outlook(one.outlook, risk) if one.is_evaluated else say_unevaluated()


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
            "bounds: {n:,} of {pieces:,} pieces by the formula's chance alone",
            "bounds: {n:,} of {pieces:,} pieces by the formula's chance alone",
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


def list_cautions(routes: Routes) -> list[str]:
    """Return what the evaluation of routes takes for granted, and what it leaves out."""
    return [*_of_pieces(), *_of_states(), *_of_chances(routes)]


def _of_pieces() -> tuple[str, ...]:
    return (
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
    )


def _of_states() -> tuple[str, ...]:
    return (
        _(
            "A segment is blocked where the width left is under the required one, reduced where pieces take width and "
            "it is not; a route is blocked where a room or an open end that it serves is cut off from its way out."
        ),
        _("Either is also blocked or reduced where it is so under the recorded motion itself, whatever its chance."),
        _("Not counted: pieces that slide or roll on castors, spilt contents, doors that jam or are shut, and people."),
    )


def _of_chances(routes: Routes) -> tuple[str, ...]:
    return (
        _(
            "Chances hold if all anchors do. Pieces whose verified chance counts fall as they did motion by motion, "
            "others independently; what full independence and full correlation give stands beside, as equal pieces "
            "fall together."
        ),
        _(
            "Where that is not so of all pieces of a route together, the largest of the three is its chance, in "
            "brackets their range. Where outcomes are too many to go through, {n:,} are drawn.",
            n=routes.draws,
        ),
    )


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


def list_unmended(routes: Routes) -> list[tuple[RouteResult, str]]:
    """Return the routes that are blocked with nothing fallen, each with the segments where."""
    found = [one for one in routes.routes if is_blocked_standing(one)]
    narrow = [[routes.segments[at] for at in one.segments if routes.segments[at].is_blocked_standing] for one in found]
    return [
        (one, name_few([segment.segment.segment for segment in own])) for one, own in zip(found, narrow, strict=True)
    ]


def name_few(names: Sequence[str]) -> str:
    """Return the first of some names of the workbook, cut, and how many more there are."""
    return words.name_first([words.cut(name, 40) for name in names], MOST_NAMED)


def say_way(way: Way, routes: Routes) -> str:
    """Return a way out: where it ends, by which segments, the chance of a blockage, and what the first way shares."""
    segments = [routes.segments[at] for at in way.segments]
    said = _(
        "{end} by {segments}: {chance}",
        end=words.cut(way.end, 40),
        segments=_name_segments(segments),
        chance=say_chance(way.blocked) if any(one.is_evaluated for one in segments) else _("not evaluated"),
    )
    if not way.shared:
        return said
    shared = _name_segments([routes.segments[at] for at in way.shared])
    return _("{way}; shares {segments} with the first", way=said, segments=shared)


def _name_segments(segments: Sequence[SegmentResult]) -> str:
    return words.name_first([words.cut(one.segment.segment, 30) for one in segments], MOST_NAMED)


def say_left_out(unevaluated: Sequence[int]) -> str:
    """Return how many segments are not evaluated; nothing where all are."""
    if not unevaluated:
        return ""
    return ngettext("{n:,} segment not evaluated", "{n:,} segments not evaluated", len(unevaluated))


def say_other_rooms(one: SegmentResult, results: Sequence[ItemResult]) -> str:
    """Return the pieces that would reach a segment, were they not in another room; nothing where there are none."""
    if not one.other_rooms:
        return ""
    items = [results[at].item for at in one.other_rooms]
    named = [f"{words.cut(item.item, 20)} ({words.cut(item.room, 20)})" if item.room else words.cut(item.item, 20)
             for item in items]  # fmt: skip
    return _("not counted, in another room: {pieces}", pieces=words.name_first(named, MOST_NAMED))


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
