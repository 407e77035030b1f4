"""One page: every way to the street that is not open, what decides it, and which piece to fix or what to fill in."""

from collections.abc import Sequence

from assess.i18n import fill, ngettext
from assess.i18n import gettext as _
from assess.report.blocks import (
    Block,
    Heading,
    Inline,
    Paragraph,
    Section,
    Span,
    Words,
    head,
    join_words,
    list_columns,
    more,
    put_words,
    strong,
    table,
)
from assess.report.say import route
from assess.report.say.route import Line
from assess.report.view import Part, View, shorten
from assess.route_results import RouteState


def show_state(state: RouteState, text: str) -> Span:
    """Return the state of a route, room or segment with its colour."""
    return Span(text, f"way-state {state.replace(' ', '-')}")


def build(view: View) -> Section:
    """Return the states in words, then a line for each way that is not open, by room and by route."""
    if not view.run.has_routes:
        return Section([Paragraph(_("The workbook names no routes."))], "run-on")
    found, items = view.run.route_tables, view.run.item_rows
    blocks: list[Block] = [Paragraph(" ".join(route.describe_routes(found)), "lead")]
    uncounted = route.say_uncounted(found)
    blocks += [Paragraph(uncounted)] if uncounted else []
    rules = route.list_rules(found.risk)
    states = [
        Span([show_state(state, route.say_state(state)), f": {rule}{';' if at < len(rules) else '.'}"], "key")
        for at, (state, rule) in enumerate(rules, start=1)
    ]
    blocks.append(Paragraph(join_words([*states, _("The chances assume that all anchors hold.")]), "legend states"))
    rooms = route.list_room_lines(found, items)
    if rooms:
        text = _(
            "By the best way out, stairs included. The chance is that of losing every exit. Anchor or move all pieces "
            "of a line."
        )
        blocks += [Heading(_("From each room to the street")),
                   Paragraph(" ".join([text, *route.say_drafts(found)]), "lead-in"),
                   *_list_lines(view, rooms, _("Route rooms"), _("From → to"))]  # fmt: skip
    else:
        blocks.append(Paragraph(_("No room has a way out in the workbook, so none is evaluated.")))
    routes = route.list_route_lines(found, items)
    return Section([
        *blocks, Heading(_("Routes")), *_list_lines(view, routes, _("Routes"), _("Route: from → to"))
    ])  # fmt: skip


def _list_lines(view: View, lines: Sequence[Line], sheet: str, first: str) -> list[Block]:
    shown, left = shorten(lines, route.MOST_LINES)
    heads = list_columns((first, ""), (_("State"), ""), (_("Chance blocked"), "", "num"), (_("Decisive segment"), ""),
                         (_("What to fix or fill in"), ""))  # fmt: skip
    rows = [
        (head(_name_ends(one)), show_state(one.state, one.said), one.chance, one.decisive or "–", _say_fixes(view, one))
        for one in shown
    ]
    return [
        table(heads, rows, "way-page"),
        *more(left, lambda n: ngettext("{n:,} more line is in the Excel report, sheet {sheet}.",
                                       "{n:,} more lines are in the Excel report, sheet {sheet}.", n, sheet=sheet)),
    ]  # fmt: skip


def _name_ends(one: Line) -> Words:
    to = f" → {one.to_places}" if one.to_places else ""
    if one.from_places and one.from_places != one.names:
        return [strong(one.names), f": {one.from_places}{to}"]
    return f"{one.names}{to}"


def _say_fixes(view: View, one: Line) -> Words:
    """Return the pieces to fix, runs of them by their ends, and what else to do."""
    if not one.fixes:
        return one.advice or "–"
    runs = []
    for run in one.fixes:
        ends: list[Inline] = view.name_row(run[0])
        if len(run) > 1:
            ends = put_words(_("{first} to {last}"), first=ends, last=view.name_row(run[-1]))
        runs.append(ends)
    words = join_words(runs, ", ")
    words += [" " + ngettext("and {n:,} more", "and {n:,} more", one.more)] if one.more else []
    return [*words, f"; {one.advice}"] if one.advice else words


PART = Part(key="routes", heading=fill("Evacuation routes"), places={"client": 30, "all": 30}, build=build)
