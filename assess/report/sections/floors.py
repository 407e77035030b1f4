"""A page for each floor: its motion, its counts, its plan, and the pieces that are most likely to fall."""

from collections.abc import Sequence

from assess.i18n import fill, ngettext
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import Block, Box, Figure, Heading, Paragraph, Section, join_words
from assess.report.content import FloorPage
from assess.report.counts import Counts
from assess.report.figures.bars import draw_bars
from assess.report.figures.plan import Plan
from assess.report.figures.plan_drawing import draw_plan, list_legend
from assess.report.page_columns import build_table
from assess.report.say.ground import say_counts, say_motions
from assess.report.view import Part, View
from assess.results import ItemResult

BRIEF = 12
"""Rows up to which a floor without a plan shares a page with the next."""
BESIDE_PLAN, WITHOUT_PLAN = 8, 20
"""Rows of the risky pieces that are listed."""


def build(view: View) -> Section:
    """Return the floors that have pieces or a segment of a route on their plan."""
    content = view.content
    boxes: list[Block] = [_build_floor(view, page, at) for at, page in enumerate(content.shown_floors, start=1)]
    empty = len(content.floors) - len(content.shown_floors)
    if empty:
        boxes.append(Paragraph(ngettext("{n:,} floor has no pieces and no page of its own.",
                                        "{n:,} floors have no pieces and no page of their own.", empty)))  # fmt: skip
    return Section(boxes)


def _build_floor(view: View, page: FloorPage, at: int) -> Box:
    plan = view.plans.get(page.floor.floor)
    blocks: list[Block] = [
        Heading(page.title),
        Paragraph(say_motions(page.floor, page.motions), "motion"),
        Paragraph(say_counts(page.counts), "motion"),
    ]
    if plan:
        drawn = draw_plan(plan, view)
        kind = f"plan rows-{min(len(page.risky), BESIDE_PLAN)}"
        blocks.append(Figure(drawn, _caption_plan(view, page, plan), kind, list_legend(plan, view)))
    title = _("Bars: pieces of each class in every room of {floor}", floor=page.title)
    bars = draw_bars(page.rooms, title) if page.results and not (plan and plan.pieces) else None
    if bars:
        caption = [
            _("Pieces by class and room; no piece of this floor has a position on the plan."),
            ngettext("{n:,} more room is left out.", "{n:,} more rooms are left out.", bars[1]) if bars[1] else "",
            say_changes(page.counts),
        ]  # fmt: skip
        blocks.append(Figure(bars[0], join_words(caption)))
    is_brief = not plan and len(page.results) <= BRIEF
    return Box(
        [*blocks, *_list_pieces(view, page, plan)], f"floor{' brief' if is_brief else ''}", "article", f"floor-{at}"
    )


def say_changes(counts: Counts) -> str:
    """Return how many classes were lowered or could be higher; "" where none."""
    if not counts.lowered and not counts.may_be:
        return ""
    return _("Lowered by simulation: {lowered:,}; could be of a higher class: {could_be:,}.",
             lowered=counts.lowered, could_be=counts.may_be)  # fmt: skip


def _caption_plan(view: View, page: FloorPage, plan: Plan) -> str:
    if plan.pieces:
        first = _(
            "Plan: every piece with a position, to scale, with the symbol of its class; hatched: the floor that a "
            "piece of medium class or above would cover if it fell: to either side, or away from its wall where that "
            "is known."
        )
        texts = [first, view.marks]
        if left := len(page.results) - page.placed:
            texts.append(ngettext("{n:,} row without a position is left out.",
                                  "{n:,} rows without a position are left out.", left))  # fmt: skip
    else:
        texts = [_("Plan: no piece of this floor has a position.") if page.results
                 else _("Plan: this floor has no pieces.")]  # fmt: skip
    if plan.ways:
        texts.append(_("Bands: segments of evacuation routes, as wide as they are clear, with the sign of their state. "
                       "? could be worse; ⚓ assumes the anchors hold."))  # fmt: skip
        if drafts := sum(one.is_draft for one in plan.ways):
            texts.append(ngettext("{n:,} of {all:,} segments drawn is drafted, not walked.",
                                  "{n:,} of {all:,} segments drawn are drafted, not walked.",
                                  drafts, all=len(plan.ways)))  # fmt: skip
    return " ".join(filter(None, texts))


def _list_pieces(view: View, page: FloorPage, plan: Plan | None) -> list[Block]:
    """Return the risky pieces of a floor, those that are counted apart, and how many classes were lowered."""
    most = BESIDE_PLAN if plan else WITHOUT_PLAN
    counts = page.counts

    def list_some(rows: Sequence[ItemResult], text: str, *columns: str, after: str = "") -> list[Block]:
        if not rows:
            return []
        first = _("The first {most}:", most=most) if len(rows) > most else ""
        lead = Paragraph(join_words((text, first, after)), "lead-in")
        return [lead, build_table(view.columns(*columns), rows[:most], "short" if "chance" in columns else "apart")]

    risky = ngettext("{n:,} row is high or very high, including borderline cases.",
                     "{n:,} rows are high or very high, including borderline cases.", len(page.risky))  # fmt: skip
    unconfirmed = ngettext(
        "{n:,} row is unconfirmed, as nothing is known of the building, or as the motions are too weak to confirm its "
        "lower class.",
        "{n:,} rows are unconfirmed, as nothing is known of the building, or as the motions are too weak to confirm "
        "their lower class.",
        len(page.unconfirmed),
    )
    by_formula = ngettext("{n:,} row that was not simulated is high or very high by formula.",
                          "{n:,} rows that were not simulated are high or very high by formula.",
                          len(page.risky_by_formula))  # fmt: skip
    shown = ("piece", "room_short", "size", "quantity")
    blocks = list_some(page.risky, risky, *shown, "chance", "class", after="" if plan else view.marks)
    if not page.risky:
        if counts.free and view.has_apart:
            blocks.append(Paragraph(_("No simulated free-standing piece on this floor reaches high.")))
        elif counts.free or (page.results and not counts.unconfirmed and not counts.by_formula):
            blocks.append(Paragraph(_("No free-standing piece on this floor reaches high.")))
    blocks += list_some(page.unconfirmed, f"{words.UNCONFIRMED} {unconfirmed}", *shown, "formula", "class")
    blocks += list_some(page.risky_by_formula, f"{words.BY_FORMULA} {by_formula}", *shown, "formula", "class")
    if counts.lowered:
        blocks.append(Paragraph(ngettext(
            "Simulation lowered the class of {n:,} free-standing piece on this floor; it is marked in the table of all "
            "pieces.",
            "Simulation lowered the class of {n:,} free-standing pieces on this floor; each is marked in the table of "
            "all pieces.",
            counts.lowered,
        )))  # fmt: skip
    return blocks


PART = Part(key="floors", heading=fill("Floors"), places={"client": 40, "all": 40}, build=build)
