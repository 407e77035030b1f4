"""One page that a manager can act on: what is expected, the worst pieces, what to fix first, and the routes at risk."""

from collections.abc import Sequence

from assess.i18n import fill, gettext as _, ngettext, number
from assess.report import blocks, words
from assess.report.counts import Counts
from assess.report.figures.bars import draw_bars
from assess.report.page_columns import build_table, mark
from assess.report.say import route
from assess.report.say.ground import say_ground
from assess.report.say.piece import describe, list_apart, say_apart
from assess.report.say.simulation import say_condition
from assess.report.say.work import Entry, say_doubtful_brackets
from assess.report.sections.floors import say_changes
from assess.report.view import Part, View
from assess.results import ItemResult
from assess.risk import RiskClass
from assess.text import natural_key

FIXES, ROUTES = 4, 4
"""Fixes and routes that the page has room for."""
NEEDED = 28
"""Letters that it has room for of what to fix or fill in for a route."""


def build(view: View) -> blocks.Section:
    """Return the page; with many floors or cautions its lists are shorter."""
    content, total = view.content, view.content.total
    furnished = [page.counts for page in content.floors if page.results]
    most = 3 if total.unconfirmed else 6  # floors that there is room for, next to sentences on unconfirmed pieces
    floors = furnished  # all, or those with most risky pieces
    if len(floors) > most:
        floors = sorted(floors, key=lambda one: (-one.risky, -one.expected, -one.unconfirmed))[:most]
    short = list(dict.fromkeys(one.short for one in content.cautions))
    shaking = say_ground(view.run, shortly=True)
    is_tight = len(floors) > 4 or len(short) > 1 or content.annual is not None
    worst = list_apart(view.results, "")
    found: list[blocks.Block] = [
        blocks.Paragraph(" ".join(say_plainly(total, worst, content.fixes, view.results)), "lead"),
        *(blocks.Paragraph(text, "caution apart") for text in say_apart(view.results)),
        _say_conditions(view, shaking, short[: 2 if is_tight and total.has_apart else 3]),
    ]
    tiles = []
    for risk, limits in words.list_limits():
        note = _("{share} of pieces; chance {limits}", share=total.share(risk), limits=limits)
        tiles.append(blocks.Tile(words.class_name(risk), words.risk_label(risk), total.say(risk),
                                 note.replace(" %", f"{words.NO_BREAK}%")))  # fmt: skip
    for kind, name, pieces, note in (
        ("apart-unconfirmed", "unconfirmed", total.unconfirmed, _("counted apart")),
        ("apart-formula", "formula", total.by_formula, _("not simulated")),
        ("apart-rolls", "rolls", total.rolls, _("on castors, not covered")),
        ("anchored", "anchored", total.anchored, _("not classified")),
    ):
        if pieces or kind == "anchored":
            tiles.append(blocks.Tile(kind, words.apart_label(name), number(pieces, ",d"), note))
    found.append(blocks.Tiles(tiles))
    title = _("Bars: pieces of each class on every floor; the numbers are in the table of the floors")
    if bars := draw_bars(floors, title):
        texts = [_("Pieces by class and floor.")]
        if len(floors) < len(furnished):
            texts.append(ngettext("The floor with most pieces of high and very high class of {all:,}.",
                                  "The {n:,} floors with most pieces of high and very high class of {all:,}.",
                                  len(floors), all=len(furnished)))  # fmt: skip
        caption = blocks.join_words([*texts, say_changes(total)])
        found.append(blocks.Figure(bars[0], caption, "counts"))
    found.append(blocks.Heading(_("The pieces most likely to fall")))
    if worst:
        most = (2 if total.has_apart else 3) if is_tight else 4 if shaking else 6
        found.append(build_table(view.columns("piece", "place", "chance", "class"), worst[:most], "short worst named"))
    else:
        none = (_("No free-standing piece has a class by simulation.") if total.has_apart
                else _("There are no free-standing pieces."))  # fmt: skip
        found.append(blocks.Paragraph(none))
    found += _list_fixes(view, is_tight=is_tight)
    if content.annual:
        lead = blocks.strong(view.lead_to("annual", _("Chances a year.")))
        found.append(blocks.Paragraph([lead, f" {content.annual.paragraphs[0]}"]))
    found += _list_routes(view, is_tight=is_tight)
    anchored = f"{words.ANCHORED} " + _("anchored: depends on its anchors") + "."
    return blocks.Section([
        *found, blocks.Paragraph(blocks.join_words([*view.legend, anchored]), "small legend")
    ])  # fmt: skip


def _say_conditions(view: View, shaking: str, cautions: Sequence[str]) -> blocks.Paragraph:
    """Return what every percentage of the report is, and the cautions on the motion of the floors."""
    text = blocks.rich(
        _("Each percentage is the chance of overturning <em>in this scenario</em>, not per year, {condition}; "
          "{interval}."),
        condition=say_condition(view.run), interval=view.content.verified.interval,
    )  # fmt: skip
    lines: list[blocks.Runs] = [blocks.join_words([text, shaking])]
    lines += [[one] for one in cautions]
    if n := len(view.content.cautions):
        all_ = ngettext("{n:,} caution on the motion of the floors", "All {n:,} cautions on the motion of the floors",
                        n)  # fmt: skip
        lines[-1] += [" ", *view.lead_to("motions" if view.shows("motions") else "approach", all_)]
    lines += [[text] for text in view.content.total.say_cannot_rock()]
    return blocks.Paragraph(blocks.join_words(([*one, " "] for one in lines), blocks.BREAK), "caution")


def _list_fixes(view: View, *, is_tight: bool) -> list[blocks.Block]:
    fixes = [one for one in view.content.fixes if not one.results[0].apart]
    heading = blocks.Heading(_("What to fix first"))
    if not fixes:
        none = (_("No simulated free-standing piece reaches medium.") if view.content.total.has_apart
                else _("No free-standing piece reaches medium."))  # fmt: skip
        return [heading, blocks.Paragraph(none)]
    heads = blocks.list_columns(
        (_("No."), "w4", "num"), (_("Piece"), ""), (_("Floor"), "w6"), (_("Why first"), "w30"), (_("Class"), "w12"),
        (_("Pieces"), "w8", "num"), (_("Falls avoided"), "w8", "num"), (_("Together"), "w8", "num"),
    )  # fmt: skip
    rows = [
        (str(one.row.place),
         f"{words.cut(one.names, 16 if is_tight else 22)}: {describe(one.results[0], 18)}",
         words.cut(one.results[0].item.floor, 12), words.cut(one.reason, 66), mark(one.results[0]),
         number(one.row.pieces, ",d"), words.fixed(one.row.falls_avoided, 3),
         f"{number(100 * (one.together or 0.0), '.0f')} %")
        for one in fixes[:FIXES]
    ]  # fmt: skip
    text = blocks.rich(_("Falls avoided <em>if the anchors hold</em>; together: share of all expected falls, with the "
                         "rows above. Sorted by class (upper estimate), then life safety and routes."))  # fmt: skip
    n = len(view.content.fixes)
    all_ = ngettext("What to fix has the {n:,} entry.", "What to fix has all {n:,} entries.", n)
    see = [blocks.Span(all_, href="#schedule")] if n > min(len(fixes), FIXES) else ""
    return [
        heading,
        blocks.table(heads, rows, "short named"),
        blocks.Paragraph(blocks.join_words((text, see)), "small"),
    ]


def _list_routes(view: View, *, is_tight: bool) -> list[blocks.Block]:
    said, found = route.say_routes(view.run), route.list_at_risk(view.run.route_tables)
    most = min(max(7 - len(said), 1), 3) if is_tight else ROUTES
    left = len(found) - most
    further = ngettext("{n:,} more than those below is at risk.", "{n:,} more than those below are at risk.", left)
    texts = said or [_("The workbook names no routes.")]
    see = view.lead_to("routes", further) if left > 0 else ""
    lead = blocks.Paragraph(blocks.join_words((blocks.strong(_("Evacuation routes.")), *texts, see)))
    heads = blocks.list_columns((_("Route"), ""), (_("Floors"), "w10"), (_("State"), "w20"),
                                (_("Chance blocked (interval)"), "w24", "num"),
                                (_("To anchor or move"), "w24"))  # fmt: skip
    rows = []
    for one in found[:most]:
        pieces = [view.run.result(fix.item_index).item for fix in one.fixes]
        names = [each.item if each.quantity == 1 else f"{each.item} ({words.plural(each.quantity, 'piece')})"
                 for each in pieces]  # fmt: skip
        needed = words.fit_pieces(sorted(names, key=natural_key), NEEDED)
        needed = needed or words.cut(route.say_missing(one.missing), NEEDED) or words.DASH
        rows.append((words.cut(one.route, 30), words.cut(", ".join(one.floors), 16),
                     route.say_outlook(one, view.run.route_tables.risk), route.say_blocked(one),
                     needed + ("; " + _("then not known") if one.missing_after else "")))  # fmt: skip
    return [lead, *([blocks.table(heads, rows, "short named")] if found else [])]


def say_plainly(
    total: Counts, worst: Sequence[ItemResult], fixes: Sequence[Entry], rows: Sequence[ItemResult] = ()
) -> list[str]:
    """Return the first paragraph; `rows` are all pieces: the anchored ones are named whose brackets may fail."""
    texts = [_say_counts(total)]
    if total.anchored:
        texts.append(ngettext("{n:,} further piece is anchored and not classified: it depends on its anchors.",
                              "{n:,} further pieces are anchored and not classified: they depend on their anchors.",
                              total.anchored))  # fmt: skip
    texts += say_doubtful_brackets(rows)
    if worst and worst[0].adopted.risk > RiskClass.LOW:
        one = worst[0]
        texts.append(_("The worst is {item} ({what}, floor {floor}) with a chance of {chance}.",
                       item=words.cut(one.item.item, 40), what=describe(one, 60),
                       floor=words.cut(one.item.floor, 20), chance=words.chance(one)))  # fmt: skip
    if total.expected >= 0.05 or total.unconfirmed:
        expected = _("About {expected:.1f} pieces are expected to fall", expected=total.expected)
        if n := total.unconfirmed:
            expected += ", " + ngettext("and up to {n:,} unconfirmed piece", "and up to {n:,} unconfirmed pieces", n)
        if total.falls_low is not None and total.falls_high is not None:
            range_ = words.say_span((round(total.falls_low), round(total.falls_high)))
            expected += "; " + _("{range} in 90 % of such earthquakes", range=range_)
        texts.append(f"{expected}.")
    first = [one for one in fixes[:FIXES] if one.together is not None]
    if total.expected >= 0.05 and first:
        texts.append(ngettext("Fixing the first entry of the list below avoids {share:.0f} % of the expected falls.",
                              "Fixing the first {n} entries of the list below avoids {share:.0f} % of the expected "
                              "falls.", len(first), share=100 * (first[-1].together or 0.0)))  # fmt: skip
    return texts


def _say_counts(total: Counts) -> str:
    if not total.free:
        return (_("No free-standing piece has a class by simulation.") if total.has_apart
                else _("There are no free-standing pieces."))  # fmt: skip
    values = {"risky": words.say_span(total.risky_span), "very_high": words.say_span(total.span(RiskClass.VERY_HIGH))}
    if total.has_apart:
        if not total.risky_span[1]:
            return ngettext("The {n:,} simulated free-standing piece has no high or very high chance of overturning in "
                            "this scenario.",
                            "None of {n:,} simulated free-standing pieces has a high or very high chance of "
                            "overturning in this scenario.", total.free)  # fmt: skip
        if total.free == 1 and total.risky_span[0]:
            return _("The one simulated free-standing piece has a high or very high chance of overturning.")
        return ngettext("The {n:,} simulated free-standing piece may have a high or very high chance of overturning: "
                        "the limit lies within the interval of its chance.",
                        "Of {n:,} simulated free-standing pieces, {risky} have a high or very high chance of "
                        "overturning, {very_high} a very high one.", total.free, **values)  # fmt: skip
    if not total.risky_span[1]:
        return ngettext("The {n:,} free-standing piece has no high or very high chance of overturning in this "
                        "scenario.",
                        "None of {n:,} free-standing pieces has a high or very high chance of overturning in this "
                        "scenario.", total.free)  # fmt: skip
    if total.free == 1 and total.risky_span[0]:
        return (
            _("The one free-standing piece has a very high chance of overturning in this scenario.")
            if total.by_class[RiskClass.VERY_HIGH]
            else _("The one free-standing piece has a high chance of overturning in this scenario.")
        )
    return ngettext("The {n:,} free-standing piece may have a high or very high chance of overturning: the limit lies "
                    "within the interval of its chance.",
                    "Of {n:,} free-standing pieces, {risky} have a high or very high chance of overturning, "
                    "{very_high} a very high one.", total.free, **values)  # fmt: skip


PARTS = (Part(key="summary", heading=fill("Summary"), places={"client": 10, "all": 10}, build=build),)
