"""The floors: their motion and where it comes from, their counts, plans, and the pieces most likely to fall."""

from collections.abc import Iterator, Sequence

from assess.i18n import fill, gettext as _, ngettext, number
from assess.model import AXES
from assess.report import blocks, measures, words
from assess.report.content import FloorPage
from assess.report.counts import Counts, count
from assess.report.figures.plan import Plan
from assess.report.page_columns import motion_columns
from assess.report.say import ground
from assess.report.say.piece import describe, find_kind, list_apart, list_risky
from assess.report.templates import open_template
from assess.report.view import MOST_ROWS, Part, View
from assess.results import ItemResult, count_pieces
from assess.risk import RiskClass

BESIDE_PLAN, BESIDE_TABLE = 8, 30
"""Rows of the risky pieces that are listed next to a plan, and below the table of the floors without one."""
MOST = 6
"""Motions of a floor that the table lists."""
KINDS = ("exit", "stair", "door", "room")
"""Kinds of places, each with a sign of its own."""


def build_floors(view: View) -> blocks.Section:
    """Return each floor that has a plan, and all others in one table."""
    shown, everything = view.content.shown_floors, view.content.floors
    drawn = [(page, plan) for page in shown if (plan := view.plans.get(page.floor.floor))]
    others = [page for page in shown if not view.plans.get(page.floor.floor)]
    found: list[blocks.Block] = [_build_floor(view, page, plan, at) for at, (page, plan) in enumerate(drawn, start=1)]
    if drawn:
        text = _("Plans show every piece with a position, to scale, with the symbol of its class. Hatched is the floor "
                 "that a piece of medium class or above would cover if it fell: to either side, or away from its wall "
                 "where that is known. Bands are the ways out, as wide as they are clear, in the colour of the worst "
                 "way that uses them; a sign stands on what is not open by itself. ⚓ assumes the anchors "
                 "hold.")  # fmt: skip
        found.insert(0, blocks.Paragraph(text, "small"))
    if others:
        inside: list[blocks.Block] = [blocks.Heading(_("Floors without a plan"))] if drawn else []
        results = [one for page in others for one in page.results]
        inside.append(_count_floors(view, others, is_short=True))
        inside += _list_pieces(view, count("", results), results, BESIDE_TABLE)
        found.append(blocks.Box(inside, "floor brief", "article", f"floor-{len(drawn) + 1}"))
    if empty := len(everything) - len(shown):
        found.append(blocks.Paragraph(ngettext("{n:,} floor has no pieces and is left out.",
                                               "{n:,} floors have no pieces and are left out.", empty)))  # fmt: skip
    return blocks.Section([*view.list_texts("Floors"), *found], "" if drawn else "run-on")


def _build_floor(view: View, page: FloorPage, plan: Plan, at: int) -> blocks.Box:
    counts = page.counts
    apart = (("unconfirmed", counts.unconfirmed), ("formula", counts.by_formula), ("rolls", counts.rolls),
             ("anchored", counts.anchored))  # fmt: skip
    classes = [f"{words.risk_label(risk)} {counts.say(risk)}" for risk in reversed(RiskClass)]
    classes += [f"{words.apart_label(name)} {pieces:,}" for name, pieces in apart if pieces]
    counted = _("{pieces}: {classes}; expected falls {falls}.", pieces=words.plural(counts.total, "piece"),
                classes=", ".join(classes), falls=counts.falls)  # fmt: skip
    found: list[blocks.Block] = [
        blocks.Heading(page.title),
        blocks.Paragraph(ground.say_motions(page.floor, page.motions), "motion"),
        blocks.Paragraph(counted, "motion"),
    ]
    texts = list[str]()
    if plan.pieces:
        if left := sum(one.item.x_m is None or one.item.y_m is None for one in page.results):
            texts.append(ngettext("{n:,} row without a position is left out.",
                                  "{n:,} rows without a position are left out.", left))  # fmt: skip
    else:
        texts.append(_("Plan: no piece of this floor has a position.") if page.results
                     else _("Plan: this floor has no pieces."))  # fmt: skip
    if drafts := sum(one.is_draft for one in plan.ways):
        texts.append(ngettext("{n:,} of {all:,} segments drawn is drafted, not walked.",
                              "{n:,} of {all:,} segments drawn are drafted, not walked.",
                              drafts, all=len(plan.ways)))  # fmt: skip
    found.append(_draw_plan(plan, view, " ".join(texts)))
    found += _list_pieces(view, counts, page.results, BESIDE_PLAN)
    return blocks.Box(found, "floor", "article", f"floor-{at}")


def _draw_plan(plan: Plan, view: View, about: str) -> blocks.Figure:
    """Return the plan, whose pieces and segments lead to their rows on a screen.

    Its legend says what signs and colours mean, the names that had no room, and where the drawing under it comes from.
    """
    rows = {number for number, _one in view.shown_segments}
    text = open_template("plan.svg.j2", view.options).render(
        plan=plan, for_print=view.for_print, segment_rows=rows, most_rows=MOST_ROWS
    )
    image = blocks.Image(text[text.index("<svg") :].rstrip())
    badges = [blocks.Span(words.risk_label(risk), f"badge {words.class_name(risk)}") for risk in RiskClass]
    badges += [
        blocks.Span(words.apart_label(name), "badge apart")
        for name in ("unconfirmed", "formula", "rolls")
        if any(one.symbol == f"apart-{name}" for one in plan.pieces)
    ]
    badges.append(blocks.Span(words.apart_label("anchored"), "badge anchored"))
    legend = [blocks.Paragraph(blocks.join_words(badges), "small legend")]
    if plan.ways:
        signs = open_template("signs.svg.j2", view.options).module
        styles, there = dict.fromkeys(one.style for one in plan.ways), {spot.kind for spot in plan.places}
        ways = [(blocks.Image(str(signs.way_swatch(one))), one.words) for one in styles]  # the worst state first
        ways += [(blocks.Image(str(signs.place_swatch(kind, _(kind)))), _(kind)) for kind in KINDS if kind in there]
        shown = blocks.join_words(blocks.Span([sign, f" {name}"], "key") for sign, name in ways)
        legend.append(blocks.Paragraph(shown, "small legend ways"))
    if plan.keys:
        first = _("Names without room on the plan, with X and Y in {unit}:", unit=measures.unit("m"))
        names: list[blocks.Inline] = [first]
        for at, key in enumerate(plan.keys, start=1):
            place = f"{key.name} ({words.in_m(key.at[0])}; {words.in_m(key.at[1])}){',' if at < len(plan.keys) else ''}"
            names.append(blocks.Span([blocks.strong(str(key.number)), f" {place}"] if key.number else place, "key"))
        legend.append(blocks.Paragraph(blocks.join_words(names), "small legend keys"))
    texts = [_("In grey: the plan {file}, placed by the workbook.", file=plan.underlay.file)] if plan.underlay else []
    if plan.cut_at == "outlines":
        texts.append(_("Hatching ends at the outlines of the floor; inner walls do not stop it."))
    elif plan.cut_at:
        texts.append(_("Hatching ends at the frame of the plan."))
    legend += [blocks.Paragraph(" ".join(texts), "small legend")] if texts else []
    return blocks.Figure(image, about, "plan", legend)


def _list_pieces(view: View, counts: Counts, results: Sequence[ItemResult], most: int) -> list[blocks.Block]:
    """Return the pieces of one floor, or of several, that are high or above, and those that stand apart."""
    risky, left, unconfirmed = list_risky(results), list_risky(results, "formula"), list_apart(results, "unconfirmed")
    place = "room_short" if len({one.item.floor for one in results}) == 1 else "place"
    found: list[blocks.Block] = []

    def list_some(rows: Sequence[ItemResult], text: str, *columns: str) -> None:
        groups: dict[tuple[object, ...], list[ItemResult]] = {}
        for one in rows:
            groups.setdefault((*find_kind(one), one.item.room, round(one.adopted.probability, 6)), []).append(one)
        if groups:
            first = _("The first {most}:", most=most) if len(groups) > most else ""
            found.append(blocks.Paragraph(blocks.join_words((text, first)), "lead-in"))
            shown = view.columns("piece", place, "size", "quantity", *columns)
            cells = [
                [_name_alike(own), *(column.cell(own[0]) if column.key != "quantity" else str(count_pieces(own))
                                     for column in shown[1:])]
                for own in list(groups.values())[:most]
            ]  # fmt: skip
            kind = "short" if "chance" in columns else "apart"
            found.append(blocks.table([one.column for one in shown], cells, kind, is_named=True))

    text = ngettext("{n:,} row is high or very high, including borderline cases.",
                    "{n:,} rows are high or very high, including borderline cases.", len(risky))  # fmt: skip
    list_some(risky, text, "chance", "class")
    if not risky and counts.free and view.content.total.has_apart:
        found.append(blocks.Paragraph(_("No simulated free-standing piece here reaches high.")))
    elif not risky and (counts.free or (results and not counts.has_apart)):
        found.append(blocks.Paragraph(_("No free-standing piece here reaches high.")))
    text = ngettext("{n:,} row is unconfirmed, as nothing is known of the building, or as the motions are too weak to "
                    "confirm its lower class.",
                    "{n:,} rows are unconfirmed, as nothing is known of the building, or as the motions are too weak "
                    "to confirm their lower class.", len(unconfirmed))  # fmt: skip
    list_some(unconfirmed, f"{words.UNCONFIRMED} {text}", "formula", "class")
    text = ngettext("{n:,} row that was not simulated is high or very high by formula.",
                    "{n:,} rows that were not simulated are high or very high by formula.", len(left))  # fmt: skip
    list_some(left, f"{words.BY_FORMULA} {text}", "formula", "class")
    return found


def _name_alike(own: Sequence[ItemResult]) -> str:
    """Return the names of alike pieces, and what they are."""
    return f"{words.name_pieces([one.item.item for one in own], 3, 14)}: {describe(own[0], 34)}"


def build_motions(view: View) -> blocks.Section:
    """Return the floors with their counts, the sources of their motions with cautions, and each motion."""
    found: list[blocks.Block] = [
        _count_floors(view, view.content.floors),
        blocks.Heading(_("Where the motion of each floor comes from")),
        blocks.Bullets(ground.list_sources(view.run.motions)),
        *(blocks.Paragraph(one.text, "caution") for one in view.content.cautions),
    ]
    columns = motion_columns("axis", "source", "pfa_g", "pfv_cm_s", "origin")
    groups = []
    for page in view.content.shown_floors:
        title = page.title
        if page.floor.elevation_m is not None:
            title = _("{floor}, {elevation} above ground", floor=title,
                      elevation=measures.say(page.floor.elevation_m, "m"))  # fmt: skip
        rows = [blocks.part(title, len(columns))]
        rows += [blocks.Row([column.cell(one) for column in columns]) for one in page.motions[:MOST]]
        if (left := len(page.motions) - MOST) > 0:
            text = ngettext("{n:,} more record of this floor: see the appendix.",
                            "{n:,} more records of this floor: see the appendix.", left)  # fmt: skip
            rows.append(blocks.Row([blocks.Cell(text, columns=len(columns))]))
        groups.append(rows)
    return blocks.Section([*found, blocks.Table([one.column for one in columns], groups, "demand", is_named=True)])


def _count_floors(view: View, pages: Sequence[FloorPage], *, is_short: bool = False) -> blocks.Table:
    """Return the pieces of floors by class; with columns of what is counted apart, without those of the changes.

    A short one has no columns of changes, and no sum.
    """
    total = view.content.total
    has_changes = bool(view.content.verified.done) and not total.has_apart and not is_short
    caption = [
        _("Motion of each floor, and its pieces by class; anchored pieces have no class."),
        _("Classes and expected falls are of simulated pieces alone. Unconfirmed pieces and those by formula only are "
          "counted apart; up to as many more could fall as are unconfirmed.")
        if total.has_apart else "",
        _("Lowered: by simulation. Could be higher: the interval reaches into a higher class. Both are included in the "
          "classes on the left.") if has_changes else "",
    ]  # fmt: skip
    further: list[tuple[blocks.Words, str, str]] = []
    if has_changes:
        further += [(_("Lowered"), "w10", "lowered"), (_("Could be higher"), "w8", "may_be")]
    if total.unconfirmed:
        further.append(([f"{words.UNCONFIRMED} ", blocks.BREAK, _("unconfirmed")], "w10", "unconfirmed"))
    if total.by_formula:
        further.append(([f"{words.BY_FORMULA} ", blocks.BREAK, _("by formula only")], "w8", "by_formula"))
    if total.rolls:
        further.append(([f"{words.ROLLING} ", blocks.BREAK, _("rolls")], "w8", "rolls"))
    further += [(_("Anchored"), "w10", "anchored"), (_("All"), "w8", "total")]

    def list_cells(counts: Counts, *, is_total: bool = False) -> Iterator[blocks.Words]:
        for risk in RiskClass:
            share = blocks.Span(f"({counts.share(risk)})", "unit") if is_total else ""
            yield blocks.join_words((counts.say(risk), share))
        yield from (number(getattr(counts, name), ",d") for _heading, _width, name in further)
        yield counts.falls

    names: list[blocks.Runs] = [
        [blocks.Span(risk.symbol, f"badge {words.class_name(risk)}"), " ", blocks.BREAK, words.risk_word(risk)]
        for risk in RiskClass
    ]
    columns = blocks.list_columns(
        (_("Floor"), ""),
        ("PFA X, Y [g]", "w12", "num"),
        *((name, "w8", "num") for name in names),
        *((heading, width, "num") for heading, width, _name in further),
        (_("Expected falls"), "w14" if total.unconfirmed else "w9", "num"),
    )  # fmt: skip
    rows = []
    for page in pages:
        peaks = (words.in_g(max(one.pfa_g for one in page.motions if one.axis == axis)) for axis in AXES)
        cells = [blocks.head(words.cut(page.counts.label, 30)), ", ".join(peaks), *list_cells(page.counts)]
        rows.append(blocks.Row(cells))
    if not is_short:
        rows.append(blocks.Row([blocks.head(total.label), "", *list_cells(total, is_total=True)], "total"))
    return blocks.table(columns, rows, "counts", blocks.join_words(caption))


PARTS = (
    Part(key="floors", heading=fill("Floors"), places={"client": 40, "all": 40}, build=build_floors),
    Part(key="motions", heading=fill("Motion of the floors"), places={"annex": 10, "all": 60}, build=build_motions),
)
