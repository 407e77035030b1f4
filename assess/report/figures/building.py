"""The building in section: its floors one above the other, a dot a piece, and what becomes of the ways out."""

from collections.abc import Iterator, Mapping, Sequence

from markupsafe import escape

from assess.i18n import gettext as _, ngettext
from assess.report import words
from assess.report.blocks import Image
from assess.report.content import FloorPage
from assess.report.say.route import count_states
from assess.results import ItemResult, count_pieces
from assess.risk import RiskClass
from assess.route_results import RouteState, RouteTables

MOST = 16
"""Floors that there is room for: of more, those on which most is expected to fall."""
WIDTH, LABEL, ROUTES, GAP = 660.0, 136.0, 196.0, 8.0
"""Width of the drawing, of the names of floors, of the words on ways out, and between them [px]."""
DOT, LINES, TEXT = 10.0, 4, 11.0
"""Side of a dot with the gap to the next [px], rows of dots that a floor has at most, and size of letters [px]."""
SCALES = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
"""Pieces that one dot may stand for."""
_INK, _LINE, _OUTSIDE = "#1c1c1c", "#767c82", "#c9ced2"


def draw_building(floors: Sequence[FloorPage], routes: RouteTables) -> tuple[Image, str] | None:
    """Return the floors as a drawing, and what a dot of it is in words; None where no floor has a piece."""
    furnished = [page for page in floors if page.results]
    if not furnished:
        return None
    kept = furnished
    if len(furnished) > MOST:
        kept = sorted(furnished, key=lambda page: (-page.counts.expected, -page.counts.unconfirmed))[:MOST]
    shown = [page for page in furnished if page in kept]
    for heights in (
        [page.floor.elevation_m for page in shown],
        [next((one.height_ratio for one in page.motions), None) for page in shown],
    ):
        known = [one for one in heights if one is not None]
        if len(known) == len(shown):  # the highest on top
            shown = [shown[at] for at in sorted(range(len(shown)), key=known.__getitem__, reverse=True)]
            break
    has_routes = bool(routes.routes)
    room = WIDTH - LABEL - 2 * GAP - (ROUTES if has_routes else 0.0)
    a_line = int(room / DOT)
    most = max(count_pieces(page.results) for page in shown)
    scale = next((one for one in SCALES if most / one <= LINES * a_line), SCALES[-1])
    drawn, y = list[str](), 1.0
    for page in shown:
        dots = list(_list_dots(page.results, scale))
        lines = min(-(-len(dots) // a_line), LINES)
        tall = max(lines * DOT, TEXT) + 9
        below = y + tall / 2 + 0.36 * TEXT
        drawn.append(f'<rect x="{LABEL:g}" y="{y:g}" width="{room + 2 * GAP:g}" height="{tall:g}" fill="#ffffff" '
                     f'stroke="{_LINE}"/>')  # fmt: skip
        label = escape(words.cut(page.title, 24))
        drawn.append(f'<text x="{LABEL - GAP:g}" y="{below:.1f}" text-anchor="end">{label}</text>')
        top = y + (tall - lines * DOT) / 2 + DOT / 2
        drawn += [
            _draw_dot(kind, LABEL + GAP + DOT * (at % a_line + 0.5), top + DOT * (at // a_line))
            for at, kind in enumerate(dots[: LINES * a_line])
        ]
        if has_routes and (own := [one.state for one in routes.routes if page.floor.floor in one.floors]):
            fill = _INK if RouteState.BLOCKED not in own else RiskClass.VERY_HIGH.fill
            weight = ' font-weight="bold"' if RouteState.BLOCKED in own else ""
            drawn.append(f'<text x="{WIDTH - ROUTES + GAP:g}" y="{below:.1f}" fill="{fill}"{weight}>'
                         f"{escape(_say_ways(own))}</text>")  # fmt: skip
        y += tall
    drawn.append(f'<path d="M{LABEL - 30:g} {y:g}H{WIDTH:g}" stroke="{_INK}" stroke-width="2"/>')
    alternative = _("The building in section: the pieces of every floor by class, and the state of its ways out")
    lines_ = "\n".join(drawn)
    image = Image(
        f'<svg xmlns="http://www.w3.org/2000/svg" class="building" role="img" aria-label="{escape(alternative)}" '
        f'viewBox="0 0 {WIDTH:g} {y + 2:g}" width="{WIDTH:g}" height="{y + 2:g}" '
        f'font-family="Report, Report Signs, DejaVu Sans, sans-serif" font-size="{TEXT:g}" fill="{_INK}">'
        f"<title>{escape(alternative)}</title>\n{lines_}\n</svg>"
    )
    texts = [ngettext("Each dot is {n:,} piece.", "Each dot is up to {n:,} pieces.", scale)]
    if left := len(furnished) - len(shown):
        texts.append(ngettext("{n:,} floor on which less falls is left out.",
                              "{n:,} floors on which less falls are left out.", left))  # fmt: skip
    return image, " ".join(texts)


def _list_dots(results: Sequence[ItemResult], scale: int) -> Iterator[RiskClass | str]:
    """Yield the dots of a floor, the worst first: a class, or why pieces stand outside the classes."""
    counted: dict[RiskClass | str, int] = {}
    for one in results:
        kind = "anchored" if one.is_anchored else one.apart or one.adopted.risk
        counted[kind] = counted.get(kind, 0) + one.item.quantity
    order: list[RiskClass | str] = [*reversed(RiskClass), "unconfirmed", "formula", "rolls", "anchored"]
    for kind in order:
        yield from [kind] * -(-counted.get(kind, 0) // scale)


def _draw_dot(kind: RiskClass | str, x: float, y: float) -> str:
    """Return a dot whose shape tells its class without its colour: square, triangle, diamond, ring; grey outside."""
    shapes: Mapping[RiskClass | str, str] = {
        RiskClass.VERY_HIGH: "M-3.6 -3.6H3.6V3.6H-3.6Z", RiskClass.HIGH: "M0 -4L4 3.4H-4Z",
        RiskClass.MEDIUM: "M0 -4L4 0L0 4L-4 0Z",
    }  # fmt: skip
    place = f'transform="translate({x:.1f} {y:.1f})"'
    if kind in shapes and isinstance(kind, RiskClass):
        return f'<path d="{shapes[kind]}" fill="{kind.fill}" stroke="{_INK}" stroke-width="0.5" {place}/>'
    if kind == RiskClass.LOW:
        return f'<circle r="2.6" fill="#ffffff" stroke="#6d8ba1" stroke-width="1" {place}/>'
    fill, dash = {"anchored": (_OUTSIDE, ""), "rolls": (_OUTSIDE, "")}.get(str(kind), ("#ffffff", "1.6 1.2"))
    dashed = f' stroke-dasharray="{dash}"' if dash else ""
    mark = '<path d="M-2.6 0H2.6" stroke="#1c1c1c"/>' if kind == "rolls" else ""
    return f'<g {place}><circle r="3.2" fill="{fill}" stroke="{_INK}" stroke-width="0.6"{dashed}/>{mark}</g>'


def _say_ways(states: Sequence[RouteState]) -> str:
    """Return what becomes of the ways out of a floor, in few words: those that are not open."""
    shut = [one for one in states if one != RouteState.OPEN]
    if not shut:
        return ngettext("the way out open", "all {n:,} ways out open", len(states))
    return ngettext("{n:,} way out: {states}", "{n:,} ways out: {states}", len(states), states=count_states(shut))
