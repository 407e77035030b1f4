"""Page one: how bad, where, what first, how much, and who answers for it."""

from collections.abc import Iterator

from assess.i18n import fill, gettext as _, ngettext, number
from assess.report import blocks, words
from assess.report.figures.building import draw_building
from assess.report.say import orders, route, work
from assess.report.say.outcome import say_outcome
from assess.report.say.piece import say_apart
from assess.report.say.simulation import name_earthquake
from assess.report.sections.methods import list_signing
from assess.report.view import Part, View
from assess.risk import RiskClass
from assess.route_results import RouteState


def build(view: View) -> blocks.Section:
    """Return the sentence of consequence, the building with a dot a piece, the plan, and the signatures."""
    content, total = view.content, view.content.total
    outcome = say_outcome(total, view.run.route_tables, name_earthquake(view.run))
    if not total.free and not total.has_apart:
        none = _("No free-standing piece has a class.") if total.total else _("No furniture is listed.")
        outcome = " ".join(filter(None, (none, outcome)))
    first = say_first(view)
    found: list[blocks.Block] = [
        blocks.Paragraph(blocks.join_words([outcome, blocks.strong(first) if first else ""]), "lead decision"),
        *_count(view),
        *view.list_texts("Summary"),
    ]  # fmt: skip
    if drawn := draw_building(content.floors, view.run.route_tables):
        image, dots = drawn
        found.append(blocks.Figure(image, blocks.join_words([dots, *list_classes(view)]), "building"))
    found += _build_plan(view)
    found += [blocks.Paragraph(text, "caution apart") for text in list_outside(view)]
    if content.annual:
        found.append(blocks.Paragraph([blocks.strong(_("Chances a year.")), f" {content.annual.paragraphs[0]}"]))
    status, why = content.verified.status
    said: blocks.Runs = [blocks.strong(_("Status: {status}", status=status)), f" ({why}). "]
    found.append(blocks.Paragraph([*said, *view.lead_to("certainty", _("How sure this is"))], "small"))
    return blocks.Section([*found, *(list_signing(view) if view.for_print else ())], "decision")


def say_first(view: View) -> str:
    """Return what the first phase of the plan takes away; "" where there is nothing to fix."""
    phases = [one for one in view.run.schedule.phases if one.phase == "A" and one.pieces]
    total = view.run.schedule.before.falls
    if not phases or total < 0.05:
        return ""
    first = phases[0]
    share = f"{number(100 * first.falls_avoided / total, '.0f')}{words.NO_BREAK}%"
    return ngettext("Fixing {n:,} piece in {places} takes {share} of the falls away.",
                    "Fixing {n:,} pieces in {places} takes {share} of the falls away.", first.pieces,
                    places=words.plural(first.places, "place"), share=share)  # fmt: skip


def _count(view: View) -> Iterator[blocks.Tiles]:
    """Yield the counts that are read first: falls, ways out, rooms."""
    total, routes = view.content.total, view.run.route_tables
    falls = words.round_falls(total.expected)
    tiles = []
    if total.free:
        note = ngettext("of {n:,} free-standing piece", "of {n:,} free-standing pieces", total.free)
        if total.falls_low is not None and total.falls_high is not None:
            range_ = words.say_span((round(total.falls_low), round(total.falls_high)))
            note = _("{pieces}; {range} in 9 of 10 such earthquakes", pieces=note, range=range_)
        tiles.append(blocks.Tile("falls", _("Expected to fall"), falls, note))
        share = _("chance of 30 % or more; {n:,} of them 70 % or more", n=total.by_class[RiskClass.VERY_HIGH])
        tiles.append(blocks.Tile("risky", _("High or very high"), words.say_span(total.risky_span), share))
    if routes.routes:
        states = [one.state for one in routes.routes]
        doubtful = ngettext("of {n:,}; {doubtful:,} more doubtful, {unknown:,} not known",
                            "of {n:,}; {doubtful:,} more doubtful, {unknown:,} not known", len(states),
                            doubtful=states.count(RouteState.DOUBTFUL),
                            unknown=states.count(RouteState.NOT_KNOWN))  # fmt: skip
        tiles.append(blocks.Tile("ways", _("Ways out likely blocked"), number(states.count(RouteState.BLOCKED), ",d"),
                                 doubtful))  # fmt: skip
    if routes.rooms:
        lost = [one for one in routes.rooms if one.state == RouteState.BLOCKED]
        at_risk = sum(one.state == RouteState.DOUBTFUL for one in routes.rooms)
        tiles.append(blocks.Tile("rooms", _("Rooms likely cut off"), number(len(lost), ",d"),
                                 ngettext("of {n:,} room; {doubtful:,} more doubtful",
                                          "of {n:,} rooms; {doubtful:,} more doubtful", len(routes.rooms),
                                          doubtful=at_risk)))  # fmt: skip
    if tiles:
        yield blocks.Tiles(tiles)


def list_classes(view: View) -> list[blocks.Words]:
    """Return how many pieces are of each class, and how many stand outside the classes, as the key of the dots."""
    total = view.content.total
    counted = [(words.class_name(risk), words.risk_label(risk), total.say(risk)) for risk in reversed(RiskClass)]
    counted += [
        (f"apart-{name}", words.apart_label(name), number(pieces, ",d"))
        for name, pieces in (("unconfirmed", total.unconfirmed), ("formula", total.by_formula), ("rolls", total.rolls))
        if pieces
    ]
    counted.append(("anchored", words.apart_label("anchored"), number(total.anchored, ",d")))
    return [blocks.Span([blocks.Span(label, f"badge {kind}"), f" {pieces}"], "key") for kind, label, pieces in counted]


def list_outside(view: View) -> list[str]:
    """Return a sentence on each kind of piece outside the classes, and on what could be worse than it seems."""
    texts = [*say_apart(view.results), *work.say_doubtful_brackets(view.results)]
    return [*texts, *route.say_held(view.run.route_tables)]


def _build_plan(view: View) -> Iterator[blocks.Block]:
    """Yield the plan: a line a phase, with what remains after it as a bar."""
    schedule, total = view.run.schedule, view.content.total
    yield blocks.Heading(_("What to do"))
    if not schedule.phases and not schedule.checks:
        none = _("No free-standing piece reaches medium, and no route needs one fixed.")
        if total.has_apart:
            none = _("No simulated free-standing piece reaches medium, and no route needs one fixed.")
        yield blocks.Paragraph(none)
        return
    has_cost = schedule.cost is not None
    heads = blocks.list_columns(
        (_("Phase"), "w18"), (_("What"), ""), (_("Cost") if has_cost else _("Work (assumed hours)"), "w14"),
        (_("Falls that remain"), "w24"),
    )  # fmt: skip
    before = schedule.before.falls
    rows: list[tuple[blocks.Words, ...]] = [
        (blocks.strong(_("Today")), _say_ways(schedule.before.routes), "", _draw_bar(before, before))
    ]
    for one in schedule.phases:
        what = blocks.join_words([_say_size(one.pieces, one.places), work.name_places(schedule, one.phase)], "; ")
        if one.phase == "C":
            rows.append((blocks.strong(_(orders.PHASES[one.phase])), what, words.DASH, words.DASH))
            continue
        ways = _say_ways(one.after.routes)
        rows.append((blocks.strong(_(orders.PHASES[one.phase])), blocks.join_words([what, f"({ways})" if ways else ""]),
                     work.say_effort(one, schedule), _draw_bar(one.after.falls, before)))  # fmt: skip
    if checks := work.say_checks(schedule):
        rows.append((blocks.strong(_("Also")), checks, "", ""))
    yield blocks.table(heads, rows, "phases named")


def _say_size(pieces: int, places: int) -> str:
    return _("{pieces} in {places}", pieces=words.plural(pieces, "piece"), places=words.plural(places, "place"))


def _say_ways(states: "tuple[tuple[str, int], ...]") -> str:
    """Return how many ways out are in which state; "" where there are none."""
    found = [RouteState(state) for state, n in states for _each in range(n)]
    return _("ways out: {states}", states=route.count_states(found)) if found else ""


def _draw_bar(value: float, most: float) -> blocks.Words:
    """Return a number with a bar of its share of the largest."""
    width = 0.0 if most <= 0 else 100 * value / most
    drawn = (
        '<svg xmlns="http://www.w3.org/2000/svg" class="bar" aria-hidden="true" viewBox="0 0 102 10" width="102" '
        f'height="10"><rect x="1" y="1" width="100" height="8" fill="#ffffff" stroke="#767c82" stroke-width="0.6"/>'
        f'<rect x="1" y="1" width="{width:.1f}" height="8" fill="#8c1d3f"/></svg>'
    )
    return [blocks.Image(drawn), f" {words.round_falls(value)}"]


PARTS = (Part(key="summary", heading=fill("Summary"), places={"client": 10, "all": 10}, build=build),)
