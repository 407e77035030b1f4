"""The evacuation routes on a plan: every segment as a band, with its state in colour, line and sign."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from assess.i18n import gettext as _
from assess.report import words
from assess.report.figures.labels import LINE, MOST, Bounds, Corners, Label, Point, overlap, place_each
from assess.report.say.route import (
    is_held,
    say_blocked,
    say_missing,
    say_segment,
    say_segment_state,
)
from assess.route_results import RouteState, RouteTables, SegmentRow
from assess.workbook.draft_names import is_draft

NAMED = 20
"""Characters of a segment's name that are drawn."""
SIGN = 6.0
"""Radius of a sign [px]."""
_ALONG = (0.5, 0.35, 0.65, 0.2, 0.8)
"""Where along a band its sign is tried."""
_GROWN = 1.2
"""Room that a sign takes over its own size, with the mark beside it."""


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

    `sign` is where its sign stands: None where there is no room and nothing to warn of. `is_held` tells that anchors
    alone keep its state from being worse, `is_draft` that its route is drafted from a building model and not walked.
    """

    number: int
    name: str
    title: str
    style: Style
    start: Point
    end: Point
    corners: Corners
    is_held: bool = False
    is_draft: bool = False
    sign: Point | None = None

    @property
    def is_open(self) -> bool:
        """Whether there is nothing to warn of."""
        return self.style.name == "open" and not self.marks

    @property
    def marks(self) -> str:
        """What stands beside its sign."""
        return "⚓" if self.is_held else ""


def list_styles() -> dict[str, Style]:
    """Return how each state is drawn, the best first; none is told by colour alone."""
    white, dark = "#ffffff", "#1c1c1c"
    fills = {state: state.fill for state in RouteState}
    drawn = (
        ("open", _("open"), RouteState.OPEN, white, dark, "", 0.8),
        ("doubtful", _("doubtful"), RouteState.DOUBTFUL, white, dark, "8 3", 1.2),
        ("unknown", _("not known"), RouteState.NOT_KNOWN, white, dark, "8 3 2 3", 1.6),
        ("blocked", _("blocked"), RouteState.BLOCKED, white, dark, "2 2.5", 2.0),
        ("standing", _("blocked as it stands"), RouteState.BLOCKED, dark, white, "", 2.6),
    )
    return {
        name: Style(name, said, state.symbol, fills[state], ground, ink, dash, width)
        for name, said, state, ground, ink, dash, width in drawn
    }


def build_stretches(routes: RouteTables) -> Mapping[str, Sequence[Stretch]]:
    """Return by floor the segments whose places both have a position on it, those with most to warn of last."""
    found: dict[str, list[Stretch]] = {}
    styles, order = list_styles(), list(list_styles())
    for number, one in enumerate(routes.segments, start=1):
        if one.length_m and one.floor is not None:
            found.setdefault(one.floor, []).append(_stretch(number, one, routes.risk, styles))
    return {floor: sorted(own, key=lambda one: order.index(one.style.name)) for floor, own in found.items()}


def _stretch(number: int, one: SegmentRow, risk: float, styles: Mapping[str, Style]) -> Stretch:
    state = "unknown" if one.state == RouteState.NOT_KNOWN else str(one.state)
    return Stretch(
        number=number,
        name=words.cut(one.segment, NAMED),
        title=_title(one, risk),
        style=styles["standing" if one.is_blocked_standing else state],
        start=(one.start_x_m or 0.0, one.start_y_m or 0.0),
        end=(one.end_x_m or 0.0, one.end_y_m or 0.0),
        corners=_outline(one),
        is_held=is_held(one, risk),
        is_draft=is_draft(one.route),
    )


def _title(one: SegmentRow, risk: float) -> str:
    """Return the state and the chance of a segment, and which piece to fix or what to fill in where it is not open."""
    said = _(
        "{segment}: {state}; chance of blockage {chance}",
        segment=say_segment(one),
        state=say_segment_state(one, risk),
        chance=say_blocked(one),
    )
    if one.missing:
        return f"{said}; {say_missing(one.missing)}"
    if one.state == RouteState.OPEN or one.most_likely_piece is None or one.is_blocked_standing:
        return said
    return _("{segment}; most likely by {item}", segment=said, item=words.cut(one.most_likely_piece.item, 40))


def _outline(one: SegmentRow) -> Corners:
    """Return the corners of a band on the plan, as far as it goes on round a bend."""
    x0, y0, x1, y1 = (at or 0.0 for at in (one.start_x_m, one.start_y_m, one.end_x_m, one.end_y_m))
    long, half, before = one.length_m or 0.0, one.clear_width_used_m / 2, -one.extends_start_m
    behind = long + one.extends_end_m
    along, across = ((x1 - x0) / long, (y1 - y0) / long), (-(y1 - y0) / long, (x1 - x0) / long)
    local = ((before, -half), (behind, -half), (behind, half), (before, half))
    first, two, three, four = ((x0 + u * along[0] + v * across[0], y0 + u * along[1] + v * across[1]) for u, v in local)
    return first, two, three, four


def place_signs(ways: Sequence[Stretch], taken: Sequence[Bounds], unit: float) -> Iterator[Stretch]:
    """Place the sign of each segment on its centre line, where it covers least; an open one may go without."""
    held: list[Bounds] = []
    for one in reversed(ways):
        tried = [sign_box(_point(one, share), unit) for share in _ALONG]
        best = min(tried, key=lambda box: (_covered(box, held), _covered(box, taken)))
        if one.is_open and _covered(best, (*held, *taken)) > 0:
            yield one
            continue
        held.append(best)
        yield replace(one, sign=((best[0] + best[2]) / 2, (best[1] + best[3]) / 2))


def sign_box(at: Point, unit: float) -> Bounds:
    """Return the room that a sign takes [m]."""
    off = _GROWN * SIGN * unit
    return at[0] - off, at[1] - off, at[0] + off, at[1] + off


def name_ways(ways: Sequence[Stretch], taken: Sequence[Bounds], frame: Bounds, unit: float) -> list[Label]:
    """Name the segments beside their signs, those with most to warn of first, where a name covers nothing else."""
    signed = [(one.name, sign_box(one.sign, unit)) for one in ways if one.sign is not None]
    blocked = [*taken, *(box for _name, box in signed)]
    found = place_each(signed[:MOST], blocked, frame, unit)
    small = LINE * LINE * unit * unit / 20
    return [one for one in found if one and one.lead is None and _covered(one.box, blocked) < small]


def _point(one: Stretch, share: float) -> Point:
    return tuple(start + share * (end - start) for start, end in zip(one.start, one.end, strict=True))  # type: ignore[return-value]


def _covered(box: Bounds, others: Sequence[Bounds]) -> float:
    return sum(overlap(box, other) for other in others)
