"""The motion of the floors, where it comes from, and how many pieces each floor has of which class."""

from collections.abc import Iterator

from assess.i18n import fill, ngettext
from assess.i18n import gettext as _
from assess.model import AXES
from assess.report import words
from assess.report.blocks import (
    BREAK,
    Block,
    Bullets,
    Cell,
    Column,
    Heading,
    Paragraph,
    Row,
    Section,
    Span,
    Table,
    Words,
    head,
    join_words,
    part,
    table,
)
from assess.report.content import FloorPage
from assess.report.counts import Counts
from assess.report.page_columns import motion_columns
from assess.report.view import Part, View, in_whole
from assess.risk import RiskClass

MOST = 6
"""Motions of a floor that the table lists."""


def build(view: View) -> Section:
    """Return the floors with their counts, the sources of their motions with cautions, and each motion."""
    blocks: list[Block] = [_count_floors(view), Heading(_("Where the motion of each floor comes from"))]
    blocks += [Bullets(view.content.sources), *(Paragraph(text, "caution") for text in view.content.cautions)]
    columns = motion_columns("axis", "source", "pfa_g", "pfv_cm_s", "origin")
    groups = []
    for page in view.content.shown_floors:
        title = page.title
        if page.floor.elevation_m is not None:
            title = _("{floor}, {elevation} m above ground", floor=title, elevation=words.in_m(page.floor.elevation_m))
        rows = [part(title, len(columns))]
        rows += [Row([column.cell(one) for column in columns]) for one in page.motions[:MOST]]
        if (left := len(page.motions) - MOST) > 0:
            text = ngettext("{n:,} more record of this floor: see the appendix.",
                            "{n:,} more records of this floor: see the appendix.", left)  # fmt: skip
            rows.append(Row([Cell(text, columns=len(columns))]))
        groups.append(rows)
    return Section([*blocks, Table([one.column for one in columns], groups, "demand", is_named=True)])


def _count_floors(view: View) -> Table:
    """Return the pieces of each floor by class.

    With columns of what is counted apart there is no room for those of the changes, which the section Verification has.
    """
    total, has_changes = view.content.total, bool(view.content.verified.done) and not view.has_apart
    caption = [
        _("Motion of each floor, and its pieces by class; anchored pieces have no class."),
        _("Classes and expected falls are of simulated pieces alone. Unconfirmed pieces and those by formula only are "
          "counted apart; up to as many more could fall as are unconfirmed.") if view.has_apart else "",
        _("Lowered: by simulation. Could be higher: the interval reaches into a higher class. Both are included in the "
          "classes on the left.") if has_changes else "",
    ]  # fmt: skip
    further: list[tuple[Words, str, str]] = []
    if has_changes:
        further += [(_("Lowered"), "w10", "lowered"), (_("Could be higher"), "w8", "may_be")]
    if total.unconfirmed:
        further.append(([f"{words.UNCONFIRMED} ", BREAK, _("unconfirmed")], "w10", "unconfirmed"))
    if total.by_formula:
        further.append(([f"{words.BY_FORMULA} ", BREAK, _("by formula only")], "w8", "by_formula"))
    further += [(_("Anchored"), "w10", "anchored"), (_("All"), "w8", "total")]

    def list_cells(counts: Counts, *, is_total: bool = False) -> Iterator[Words]:
        for risk, _limits in view.content.class_limits:
            yield join_words((counts.say(risk), Span(f"({counts.share(risk)})", "unit") if is_total else ""))
        yield from (in_whole(getattr(counts, name)) for _heading, _width, name in further)
        yield counts.falls

    columns = [
        Column(_("Floor")),
        Column("PFA X, Y [g]", "w12", is_number=True),
        *(Column(_head_class(risk), "w8", is_number=True) for risk, _limits in view.content.class_limits),
        *(Column(heading, width, is_number=True) for heading, width, _name in further),
        Column(_("Expected falls"), "w14" if total.unconfirmed else "w9", is_number=True),
    ]
    rows: list[Row] = [
        Row([head(words.cut(page.counts.label, 30)), _say_peaks(page), *list_cells(page.counts)])
        for page in view.content.floors
    ]
    rows.append(Row([head(total.label), "", *list_cells(total, is_total=True)], "total"))
    return table(columns, rows, "counts", join_words(caption))


def _head_class(risk: RiskClass) -> Words:
    return [Span(risk.symbol, f"badge {words.class_name(risk)}"), " ", BREAK, words.risk_word(risk)]


def _say_peaks(page: FloorPage) -> str:
    return ", ".join(words.in_g(max(one.pfa_g for one in page.motions if one.axis == axis)) for axis in AXES)


PART = Part(key="motions", heading=fill("Motion of the floors"), places={"annex": 10, "all": 60}, build=build)
