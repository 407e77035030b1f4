"""The plan of a floor as SVG, by the template plan.svg.j2, and its legend."""

from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import Block, Image, Inline, Paragraph, Span, join_words, strong
from assess.report.figures.plan import Plan
from assess.report.templates import open_template
from assess.report.view import MOST_ROWS, View
from assess.risk import RiskClass

KINDS = ("exit", "stair", "door", "room")
"""Kinds of places, each with a sign of its own."""


def draw_plan(plan: Plan, view: View) -> Image:
    """Return the plan; on a screen its pieces and segments lead to their rows."""
    rows = {number for number, _one in view.shown_segments}
    text = open_template("plan.svg.j2", view.options).render(
        plan=plan, for_print=view.for_print, segment_rows=rows, most_rows=MOST_ROWS
    )
    return Image(text[text.index("<svg") :].rstrip())


def list_legend(plan: Plan, view: View) -> list[Block]:
    """Return what signs and colours mean, the names that had no room, and where the drawing under it comes from."""
    badges = [Span(words.risk_label(risk), f"badge {words.class_name(risk)}") for risk in RiskClass]
    badges += [
        Span(words.apart_label(name), "badge apart")
        for sign, name in ((words.UNCONFIRMED, "unconfirmed"), (words.BY_FORMULA, "formula"))
        if any(one.symbol == sign for one in plan.pieces)
    ]
    badges.append(Span(words.apart_label("anchored"), "badge anchored"))
    blocks: list[Block] = [Paragraph(join_words(badges), "small legend")]
    if plan.ways:
        signs = open_template("signs.svg.j2", view.options).module
        styles, there = dict.fromkeys(one.style for one in plan.ways), {spot.kind for spot in plan.places}
        ways = [(Image(str(signs.way_swatch(one))), one.words) for one in styles]  # the worst state first
        ways += [(Image(str(signs.place_swatch(kind, _(kind)))), _(kind)) for kind in KINDS if kind in there]
        blocks.append(
            Paragraph(join_words(Span([sign, f" {text}"], "key") for sign, text in ways), "small legend ways")
        )
    if plan.keys:
        names: list[Inline] = [_("Names without room on the plan, with X and Y in m:")]
        for at, key in enumerate(plan.keys, start=1):
            place = f"{key.name} ({words.in_m(key.at[0])}; {words.in_m(key.at[1])}){',' if at < len(plan.keys) else ''}"
            names.append(Span([strong(str(key.number)), f" {place}"] if key.number else place, "key"))
        blocks.append(Paragraph(join_words(names), "small legend keys"))
    texts = [_("In grey: the plan {file}, placed by the workbook.", file=plan.underlay.file)] if plan.underlay else []
    if plan.cut_at == "outlines":
        texts.append(_("Hatching ends at the outlines of the floor; inner walls do not stop it."))
    elif plan.cut_at:
        texts.append(_("Hatching ends at the frame of the plan."))
    return [*blocks, Paragraph(" ".join(texts), "small legend")] if texts else blocks
