"""The floors: their motion and where it comes from, their counts, plans, and the pieces most likely to fall."""

from collections.abc import Iterator, Sequence

from assess.i18n import fill, gettext as _, ngettext, number
from assess.model import AXES
from assess.report import blocks, words
from assess.report.content import FloorPage
from assess.report.counts import Counts, count
from assess.report.figures.bars import draw_bars
from assess.report.figures.plan import Plan
from assess.report.page_columns import build_table, motion_columns
from assess.report.say import ground
from assess.report.say.piece import list_apart, list_risky
from assess.report.templates import open_template
from assess.report.view import MOST_ROWS, Part, View
from assess.results import ItemResult
from assess.risk import RiskClass
from assess.text import natural_key

BESIDE_PLAN = 8
"""Rows of the risky pieces that are listed next to a plan."""
MOST = 6
"""Motions of a floor that the table lists."""
KINDS = ("exit", "stair", "door", "room")
"""Kinds of places, each with a sign of its own."""


def build_floors(view: View) -> blocks.Section:
    """Return the floors that have pieces or a segment of a route on their plan, a page each."""
    shown, everything = view.content.shown_floors, view.content.floors
    boxes: list[blocks.Block] = [_build_floor(view, page, at) for at, page in enumerate(shown, start=1)]
    if empty := len(everything) - len(shown):
        boxes.append(blocks.Paragraph(ngettext("{n:,} floor has no pieces and no page of its own.",
                                               "{n:,} floors have no pieces and no page of their own.",
                                               empty)))  # fmt: skip
    return blocks.Section(boxes)


def _build_floor(view: View, page: FloorPage, at: int) -> blocks.Box:
    plan, risky, counts = view.plans.get(page.floor.floor), list_risky(page.results), page.counts
    apart = (
        ("unconfirmed", counts.unconfirmed),
        ("formula", counts.by_formula),
        ("rolls", counts.rolls),
        ("anchored", counts.anchored),
    )
    classes = [f"{words.risk_label(risk)} {counts.say(risk)}" for risk in reversed(RiskClass)]
    classes += [f"{words.apart_label(name)} {pieces:,}" for name, pieces in apart if pieces]
    counted = _("{pieces}: {classes}; expected falls {falls}.", pieces=words.plural(counts.total, "piece"),
                classes=", ".join(classes), falls=counts.falls)  # fmt: skip
    found: list[blocks.Block] = [
        blocks.Heading(page.title),
        blocks.Paragraph(ground.say_motions(page.floor, page.motions), "motion"),
        blocks.Paragraph(counted, "motion"),
    ]
    if plan:
        if plan.pieces:
            texts = [_("Plan: every piece with a position, to scale, with the symbol of its class; hatched: the floor "
                       "that a piece of medium class or above would cover if it fell: to either side, or away from its "
                       "wall where that is known."), view.marks]  # fmt: skip
            if left := sum(one.item.x_m is None or one.item.y_m is None for one in page.results):
                texts.append(ngettext("{n:,} row without a position is left out.",
                                      "{n:,} rows without a position are left out.", left))  # fmt: skip
        else:
            texts = [_("Plan: no piece of this floor has a position.") if page.results
                     else _("Plan: this floor has no pieces.")]  # fmt: skip
        if plan.ways:
            texts.append(_("Bands: segments of evacuation routes, as wide as they are clear, with the sign of their "
                           "state. ? could be worse; ⚓ assumes the anchors hold."))  # fmt: skip
            if drafts := sum(one.is_draft for one in plan.ways):
                texts.append(ngettext("{n:,} of {all:,} segments drawn is drafted, not walked.",
                                      "{n:,} of {all:,} segments drawn are drafted, not walked.",
                                      drafts, all=len(plan.ways)))  # fmt: skip
        kind = f"plan rows-{min(len(risky), BESIDE_PLAN)}"
        about = " ".join(filter(None, texts))
        found.append(_draw_plan(plan, view, about, kind))
    title = _("Bars: pieces of each class in every room of {floor}", floor=page.title)
    bars = draw_bars(count_rooms(page.results), title) if page.results and not (plan and plan.pieces) else None
    if bars:
        caption = [
            _("Pieces by class and room; no piece of this floor has a position on the plan."),
            ngettext("{n:,} more room is left out.", "{n:,} more rooms are left out.", bars[1]) if bars[1] else "",
            say_changes(counts),
        ]  # fmt: skip
        found.append(blocks.Figure(bars[0], blocks.join_words(caption)))
    found += _list_pieces(view, page, risky, BESIDE_PLAN if plan else 20, "" if plan else view.marks)
    is_brief = not plan and len(page.results) <= 12  # then it shares a page with the next
    return blocks.Box(found, f"floor{' brief' if is_brief else ''}", "article", f"floor-{at}")


def _draw_plan(plan: Plan, view: View, about: str, kind: str) -> blocks.Figure:
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
        for sign, name in ((words.UNCONFIRMED, "unconfirmed"), (words.BY_FORMULA, "formula"))
        if any(one.symbol == sign for one in plan.pieces)
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
        names: list[blocks.Inline] = [_("Names without room on the plan, with X and Y in m:")]
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
    return blocks.Figure(image, about, kind, legend)


def say_changes(counts: Counts) -> str:
    """Return how many classes were lowered or could be higher; "" where none."""
    if not counts.lowered and not counts.may_be:
        return ""
    return _("Lowered by simulation: {lowered:,}; could be of a higher class: {could_be:,}.",
             lowered=counts.lowered, could_be=counts.may_be)  # fmt: skip


def count_rooms(results: Sequence[ItemResult]) -> list[Counts]:
    """Count the pieces of each room, the rooms with most of high and very high class first, then by name."""
    rooms: dict[str, list[ItemResult]] = {}
    for one in results:
        rooms.setdefault(one.item.room, []).append(one)
    counts = [
        count(words.cut(room, 40) if room else _("no room named"), rooms[room])
        for room in sorted(rooms, key=natural_key)
    ]
    return sorted(counts, key=lambda one: -one.risky)


def _list_pieces(view: View, page: FloorPage, risky: Sequence[ItemResult], most: int, marks: str) -> list[blocks.Block]:
    counts, left = page.counts, list_risky(page.results, "formula")
    unconfirmed = list_apart(page.results, "unconfirmed")
    found: list[blocks.Block] = []

    def list_some(rows: Sequence[ItemResult], text: str, *columns: str, after: str = "") -> None:
        if rows:
            first = _("The first {most}:", most=most) if len(rows) > most else ""
            found.append(blocks.Paragraph(blocks.join_words((text, first, after)), "lead-in"))
            shown = view.columns("piece", "room_short", "size", "quantity", *columns)
            found.append(build_table(shown, rows[:most], "short" if "chance" in columns else "apart"))

    text = ngettext("{n:,} row is high or very high, including borderline cases.",
                    "{n:,} rows are high or very high, including borderline cases.", len(risky))  # fmt: skip
    list_some(risky, text, "chance", "class", after=marks)
    if not risky and counts.free and view.content.total.has_apart:
        found.append(blocks.Paragraph(_("No simulated free-standing piece on this floor reaches high.")))
    elif not risky and (counts.free or (page.results and not counts.has_apart)):
        found.append(blocks.Paragraph(_("No free-standing piece on this floor reaches high.")))
    text = ngettext("{n:,} row is unconfirmed, as nothing is known of the building, or as the motions are too weak to "
                    "confirm its lower class.",
                    "{n:,} rows are unconfirmed, as nothing is known of the building, or as the motions are too weak "
                    "to confirm their lower class.", len(unconfirmed))  # fmt: skip
    list_some(unconfirmed, f"{words.UNCONFIRMED} {text}", "formula", "class")
    text = ngettext("{n:,} row that was not simulated is high or very high by formula.",
                    "{n:,} rows that were not simulated are high or very high by formula.", len(left))  # fmt: skip
    list_some(left, f"{words.BY_FORMULA} {text}", "formula", "class")
    if counts.lowered:
        found.append(blocks.Paragraph(ngettext(
            "Simulation lowered the class of {n:,} free-standing piece on this floor; it is marked in the table of all "
            "pieces.",
            "Simulation lowered the class of {n:,} free-standing pieces on this floor; each is marked in the table of "
            "all pieces.",
            counts.lowered,
        )))  # fmt: skip
    return found


def build_motions(view: View) -> blocks.Section:
    """Return the floors with their counts, the sources of their motions with cautions, and each motion."""
    found: list[blocks.Block] = [
        _count_floors(view),
        blocks.Heading(_("Where the motion of each floor comes from")),
        blocks.Bullets(ground.list_sources(view.run.motions)),
        *(blocks.Paragraph(one.text, "caution") for one in view.content.cautions),
    ]
    columns = motion_columns("axis", "source", "pfa_g", "pfv_cm_s", "origin")
    groups = []
    for page in view.content.shown_floors:
        title = page.title
        if page.floor.elevation_m is not None:
            title = _("{floor}, {elevation} m above ground", floor=title, elevation=words.in_m(page.floor.elevation_m))
        rows = [blocks.part(title, len(columns))]
        rows += [blocks.Row([column.cell(one) for column in columns]) for one in page.motions[:MOST]]
        if (left := len(page.motions) - MOST) > 0:
            text = ngettext("{n:,} more record of this floor: see the appendix.",
                            "{n:,} more records of this floor: see the appendix.", left)  # fmt: skip
            rows.append(blocks.Row([blocks.Cell(text, columns=len(columns))]))
        groups.append(rows)
    return blocks.Section([*found, blocks.Table([one.column for one in columns], groups, "demand", is_named=True)])


def _count_floors(view: View) -> blocks.Table:
    """Return the pieces of each floor by class; with columns of what is counted apart, without those of the changes."""
    total = view.content.total
    has_changes = bool(view.content.verified.done) and not total.has_apart
    caption = [
        _("Motion of each floor, and its pieces by class; anchored pieces have no class."),
        _("Classes and expected falls are of simulated pieces alone. Unconfirmed pieces and those by formula only are "
          "counted apart; up to as many more could fall as are unconfirmed.") if total.has_apart else "",
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
    for page in view.content.floors:
        peaks = (words.in_g(max(one.pfa_g for one in page.motions if one.axis == axis)) for axis in AXES)
        cells = [blocks.head(words.cut(page.counts.label, 30)), ", ".join(peaks), *list_cells(page.counts)]
        rows.append(blocks.Row(cells))
    rows.append(blocks.Row([blocks.head(total.label), "", *list_cells(total, is_total=True)], "total"))
    return blocks.table(columns, rows, "counts", blocks.join_words(caption))


PARTS = (
    Part(key="floors", heading=fill("Floors"), places={"client": 40, "all": 40}, build=build_floors),
    Part(key="motions", heading=fill("Motion of the floors"), places={"annex": 10, "all": 60}, build=build_motions),
)
