"""One page that a manager can act on: what is expected, the worst pieces, what to fix first, and the routes at risk."""

from collections.abc import Iterator

from assess.i18n import fill, ngettext, number
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import (
    BREAK,
    Block,
    Figure,
    Heading,
    Inline,
    Paragraph,
    Section,
    Span,
    Tile,
    Tiles,
    join_words,
    list_columns,
    rich,
    strong,
    table,
)
from assess.report.figures.bars import draw_bars
from assess.report.page_columns import build_table, mark
from assess.report.say.simulation import say_condition
from assess.report.sections.floors import say_changes
from assess.report.summary import CAUTIONS, FIXES, ROUTES, describe
from assess.report.view import Part, View, in_whole

TIGHT_FLOORS = 4
"""Floors above which lists are shorter, so that they stay on one page."""


def build(view: View) -> Section:
    """Return the page; with many floors or cautions its lists are shorter."""
    content = view.content
    is_tight = len(content.worst_floors) > TIGHT_FLOORS or len(content.short_cautions) > 1 or content.annual is not None
    blocks = [
        Paragraph(" ".join(content.summary.plainly), "lead"),
        *(Paragraph(text, "caution apart") for text in content.summary.apart),
        _say_conditions(view, 2 if is_tight and view.has_apart else CAUTIONS),
        Tiles(list(_list_tiles(view))),
        *_draw_counts(view),
        *_list_worst(view, is_tight=is_tight),
        *_list_fixes(view, is_tight=is_tight),
    ]
    if content.annual:
        lead = strong(view.lead_to("annual", _("Chances a year.")))
        blocks.append(Paragraph([lead, f" {content.annual.paragraphs[0]}"]))
    blocks += _list_routes(view, is_tight=is_tight)
    legend = [view.marks, f"{words.apart_legend()}." if view.has_apart else ""]
    anchored = f"{words.ANCHORED} " + _("anchored: depends on its anchors") + "."
    return Section([*blocks, Paragraph(join_words([*legend, anchored]), "small legend")])


def _say_conditions(view: View, most: int) -> Paragraph:
    """Return what every percentage of the report is, and the cautions on the motion of the floors."""
    content = view.content
    text = rich(
        _("Each percentage is the chance of overturning <em>in this scenario</em>, not per year, {condition}; "
          "{interval}."),
        condition=say_condition(view.run), interval=content.verified.interval,
    )  # fmt: skip
    lines: list[list[Inline]] = [join_words([text, *content.summary.shaking])]
    lines += [[one] for one in content.short_cautions[:most]]
    if content.cautions:
        all_ = ngettext("{n:,} caution on the motion of the floors", "All {n:,} cautions on the motion of the floors",
                        len(content.cautions))  # fmt: skip
        lines[-1] += [" ", *view.lead_to("motions" if view.shows("motions") else "approach", all_)]
    lines += [[content.total.say_cannot_rock]] if content.total.cannot_rock else []
    return Paragraph(join_words(([*one, " "] for one in lines), BREAK), "caution")


def _list_tiles(view: View) -> Iterator[Tile]:
    total = view.content.total
    for risk, limits in view.content.class_limits:
        said = _("{share} of pieces; chance {limits}", share=total.share(risk), limits=limits)
        name = words.class_name(risk)
        yield Tile(name, words.risk_label(risk), total.say(risk), said.replace(" %", f"{words.NO_BREAK}%"))
    if total.unconfirmed:
        name = words.apart_label("unconfirmed")
        yield Tile("apart-unconfirmed", name, in_whole(total.unconfirmed), _("counted apart"))
    if total.by_formula:
        name = words.apart_label("formula")
        yield Tile("apart-formula", name, in_whole(total.by_formula), _("not simulated"))
    name = words.apart_label("anchored")
    yield Tile("anchored", name, in_whole(total.anchored), _("not classified"))


def _draw_counts(view: View) -> list[Block]:
    content = view.content
    title = _("Bars: pieces of each class on every floor; the numbers are in the table of the floors")
    bars = draw_bars(content.worst_floors, title)
    if bars is None:
        return []
    texts = [_("Pieces by class and floor.")]
    if len(content.worst_floors) < len(content.furnished):
        texts.append(ngettext("The floor with most pieces of high and very high class of {all:,}.",
                              "The {n:,} floors with most pieces of high and very high class of {all:,}.",
                              len(content.worst_floors), all=len(content.furnished)))  # fmt: skip
    return [Figure(bars[0], join_words([*texts, say_changes(content.total)]), "counts")]


def _list_worst(view: View, *, is_tight: bool) -> list[Block]:
    summary, total = view.content.summary, view.content.total
    heading = Heading(_("The pieces most likely to fall"))
    if not summary.worst:
        none = (_("No free-standing piece has a class by simulation.") if total.unconfirmed or total.by_formula
                else _("There are no free-standing pieces."))  # fmt: skip
        return [heading, Paragraph(none)]
    most = (2 if view.has_apart else 3) if is_tight else 4 if summary.shaking else 6
    columns = view.columns("piece", "place", "chance", "class")
    return [heading, build_table(columns, summary.worst[:most], "short worst named")]


def _list_fixes(view: View, *, is_tight: bool) -> list[Block]:
    fixes = [one for one in view.content.summary.fixes if not one.result.apart]
    heading = Heading(_("What to fix first"))
    if not fixes:
        none = (_("No simulated free-standing piece reaches medium.") if view.has_apart
                else _("No free-standing piece reaches medium."))  # fmt: skip
        return [heading, Paragraph(none)]
    heads = list_columns(
        (_("No."), "w4", "num"), (_("Piece"), ""), (_("Floor"), "w6"), (_("Why first"), "w30"), (_("Class"), "w12"),
        (_("Pieces"), "w8", "num"), (_("Falls avoided"), "w8", "num"), (_("Together"), "w8", "num"),
    )  # fmt: skip
    rows = [
        (str(one.place),
         f"{words.cut(one.names, 16 if is_tight else 22)}: {describe(one.result, 18)}",
         words.cut(one.result.item.floor, 12), words.cut(one.reason, 66), mark(one.result), in_whole(one.pieces),
         words.fixed(one.saved, 3), f"{number(100 * (one.together or 0.0), '.0f')} %")
        for one in fixes[:FIXES]
    ]  # fmt: skip
    text = rich(_(
        "Falls avoided <em>if the anchors hold</em>; together: share of all expected falls, with the rows above. "
        "Sorted by class (upper estimate), then life safety and routes."
    ))  # fmt: skip
    n = len(view.content.summary.fixes)
    all_ = ngettext("What to fix has the {n:,} entry.", "What to fix has all {n:,} entries.", n)
    see = [Span(all_, href="#schedule")] if n > min(len(fixes), FIXES) else ""
    return [heading, table(heads, rows, "short named"), Paragraph(join_words((text, see)), "small")]


def _list_routes(view: View, *, is_tight: bool) -> list[Block]:
    summary = view.content.summary
    most = min(max(7 - len(summary.of_routes), 1), 3) if is_tight else ROUTES
    left = len(summary.routes) - most
    further = ngettext("{n:,} more than those below is at risk.", "{n:,} more than those below are at risk.", left)
    texts = list(summary.of_routes) or [_("The workbook names no routes.")]
    see = view.lead_to("routes", further) if left > 0 else ""
    lead = Paragraph(join_words((strong(_("Evacuation routes.")), *texts, see)))
    if not summary.routes:
        return [lead]
    heads = list_columns((_("Route"), ""), (_("Floors"), "w10"), (_("State"), "w20"),
                         (_("Chance blocked (interval)"), "w24", "num"), (_("To anchor or move"), "w24"))  # fmt: skip
    rows = [
        (words.cut(one.route, 30), words.cut(one.floors, 16), one.state, one.chance,
         (one.needed or words.DASH) + ("; " + _("then not known") if one.result.missing_after else ""))
        for one in summary.routes[:most]
    ]  # fmt: skip
    return [lead, table(heads, rows, "short named")]


PART = Part(key="summary", heading=fill("Summary"), places={"client": 10, "all": 10}, build=build)
