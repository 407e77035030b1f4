"""The chances a year, of pieces, routes and rooms."""

from collections.abc import Sequence

from assess.i18n import fill, ngettext
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import Block, Heading, Paragraph, Section, head, list_columns, more, table
from assess.report.say.simulation import LISTED, AnnualLine
from assess.report.view import Part, View, shorten


def build(view: View) -> Section:
    """Return what the chances rest on, and the likeliest of each kind."""
    annual = view.content.annual
    if annual is None:
        return Section([])
    blocks: list[Block] = []
    if annual.is_evaluated:
        text = _(
            "These chances count all earthquakes of the site, weak and strong. All other chances in this report are "
            "those in the scenario."
        )
        blocks.append(Paragraph(text, "caution"))
    blocks += [Paragraph(text, "" if at else "lead") for at, text in enumerate(annual.paragraphs)]
    blocks += [Paragraph(_("On the hazard curve: {remark}.", remark=one), "caution") for one in annual.remarks]
    blocks += _list_lines(_("Pieces most likely to fall"), _("Piece"), annual.pieces, has_what=True)
    blocks += _list_lines(_("Routes: blocked, if all anchors hold"), _("Route"), annual.routes)
    blocks += _list_lines(_("Rooms: every exit lost, if all anchors hold"), _("Room"), annual.rooms)
    return Section(blocks)


def _list_lines(title: str, name: str, lines: Sequence[AnnualLine], *, has_what: bool = False) -> list[Block]:
    if not lines:
        return []
    has_fail = any(one.fail for one in lines)
    shown, left = shorten(lines, LISTED)
    heads = list_columns(
        (name, "" if has_what else "w24"),
        *([(_("Description"), "w20")] if has_what else []),
        (_("Floor, room") if has_what else _("Floor"), ""),
        (_("Chance a year"), "w10", "num"), (_("Chance in 50 years"), "w10", "num"),
        (_("Interval (50 years)"), "w18", "num"), (_("Once in [years]"), "w8", "num"),
        (_("Median ground PGA [g] (dispersion)"), "w12", "num"),
        *([(_("If anchors fail (50 years)"), "w10", "num")] if has_fail else []),
    )  # fmt: skip
    rows = [
        (head(words.cut(one.name, 30)), *([words.cut(one.what, 40)] if has_what else []), words.cut(one.where, 24),
         one.a_year, one.in_50_years, one.interval, one.once_in, one.median,
         *([one.if_anchors_fail] if has_fail else []))
        for one in shown
    ]  # fmt: skip
    return [
        Heading(title),
        table(heads, rows, "annual"),
        *more(left, lambda n: ngettext("{n:,} more row, less likely, is in the Excel report.",
                                       "{n:,} more rows, less likely, are in the Excel report.", n)),
    ]  # fmt: skip


PART = Part(
    key="annual", heading=fill("Chances a year"), places={"annex": 20, "all": 70}, build=build,
    is_shown=lambda view: view.content.annual is not None,
)  # fmt: skip
