"""The evacuation routes on a plan: every segment as a band in the colour and line of the worst way that uses it.

Its sign stands where the segment itself is not open.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from assess.i18n import gettext as _
from assess.report import words
from assess.report.figures.labels import Bounds, Corners, Point, box_around, find_covered
from assess.report.say.route import is_held, say_blocked, say_missing, say_outlook, say_segment
from assess.route_results import RouteState, RouteTables
from assess.routes.geometry import rectangle
from assess.workbook.draft_names import is_draft

NAMED = 20
"""Characters of a segment's name that are drawn."""
SIGN = 7.0
"""Radius of a sign [px]."""
_ALONG = (0.5, 0.35, 0.65, 0.2, 0.8)
"""Where along a band its sign is tried."""
_GROWN = 1.2
"""Room that a sign takes over its own size, with the mark next to it."""


@dataclass(frozen=True, slots=True)
class Style:
    """How a state is drawn: its name, words, sign, colours, and the dashes and width [px] of its lines."""

    name: str
    words: str
    symbol: str
    fill: str
    ground: str
    ink: str
    dash: str
    width: float


@dataclass(frozen=True, slots=True)
class Stretch:
    """A segment as it is drawn; `number` is that of its row among all segments, from 1.

    `sign` is where its sign stands: None where there is no room and nothing to warn of; `marks` stand next to it.
    `is_draft`: its route was drafted from a building model and not walked. `is_open`: it is open by itself.
    """

    number: int
    name: str
    title: str
    style: Style
    start: Point
    end: Point
    corners: Corners
    marks: str = ""
    is_draft: bool = False
    is_open: bool = True
    sign: Point | None = None


def build_stretches(routes: RouteTables) -> Mapping[str, Sequence[Stretch]]:
    """Return by floor the segments whose places both have a position on it, those with most to warn of last."""
    white, dark, opened, blocked = "#ffffff", "#1c1c1c", RouteState.OPEN, RouteState.BLOCKED
    doubtful, unknown, standing = RouteState.DOUBTFUL, RouteState.NOT_KNOWN, _("blocked as it stands")
    styles = (  # the best first; none differs by colour alone
        Style("open", _("open"), opened.symbol, opened.fill, white, dark, "", 0.8),
        Style("doubtful", _("doubtful"), doubtful.symbol, doubtful.fill, white, dark, "8 3", 1.2),
        Style("unknown", _("not known"), unknown.symbol, unknown.fill, white, dark, "8 3 2 3", 1.6),
        Style("blocked", _("blocked"), blocked.symbol, blocked.fill, white, dark, "2 2.5", 2.0),
        Style("standing", standing, blocked.symbol, blocked.fill, dark, white, "", 2.6),
    )
    order = [one.name for one in styles]
    worst: dict[int, RouteState] = {}
    for way in routes.routes:
        for at in way.segment_indices:
            worst[at] = max(worst.get(at, way.state), way.state, key=lambda state: state.severity)
    found: dict[str, list[Stretch]] = {}
    for number, one in enumerate(routes.segments, start=1):
        if not one.length_m or one.floor is None:
            continue
        shown = max(one.state, worst.get(number - 1, one.state), key=lambda state: state.severity)
        state = "unknown" if shown == RouteState.NOT_KNOWN else str(shown)
        start, end = (one.start_x_m or 0.0, one.start_y_m or 0.0), (one.end_x_m or 0.0, one.end_y_m or 0.0)
        along = (-one.extends_start_m, one.length_m + one.extends_end_m)  # as far as it goes on round a bend
        title = _("{segment}: {state}; chance of blockage {chance}",
                  segment=say_segment(one), state=say_outlook(one, routes.risk), chance=say_blocked(one))  # fmt: skip
        piece = one.most_likely_piece
        if one.missing:
            title = f"{title}; {say_missing(one.missing)}"
        elif one.state != RouteState.OPEN and piece is not None and not one.is_blocked_standing:
            title = _("{segment}; most likely by {item}", segment=title, item=words.cut(piece.item, 40))
        angle = math.degrees(math.atan2(end[1] - start[1], end[0] - start[0]))
        found.setdefault(one.floor, []).append(Stretch(
            number=number, name=words.cut(one.segment, NAMED), title=title,
            style=styles[order.index("standing" if one.is_blocked_standing else state)], start=start, end=end,
            corners=rectangle(start, angle, along, one.clear_width_used_m),
            marks=words.ANCHORED if is_held(one, routes.risk) else "",  # anchors alone keep it from being worse
            is_draft=is_draft(one.route), is_open=one.state == RouteState.OPEN,
        ))  # fmt: skip
    return {floor: sorted(own, key=lambda one: order.index(one.style.name)) for floor, own in found.items()}


def place_signs(ways: Sequence[Stretch], taken: Sequence[Bounds], unit: float) -> Iterator[Stretch]:
    """Place the sign of each segment on its centre line, where it covers least; an open one may go without."""
    held: list[Bounds] = []
    for one in reversed(ways):
        (x, y), (x_end, y_end) = one.start, one.end
        tried = [sign_box((x + share * (x_end - x), y + share * (y_end - y)), unit) for share in _ALONG]
        ranked = zip(find_covered(tried, held), find_covered(tried, taken), tried, strict=True)
        *covered, best = min(ranked, key=lambda found: found[:2])
        if one.is_open and not one.marks and (one.style.name != "open" or sum(covered) > 0):
            yield one
            continue
        held.append(best)
        yield replace(one, sign=((best[0] + best[2]) / 2, (best[1] + best[3]) / 2))


def sign_box(at: Point, unit: float) -> Bounds:
    """Return the room that a sign takes [m]."""
    size = 2 * _GROWN * SIGN * unit
    return box_around(at, size, size)
