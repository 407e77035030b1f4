"""Where the methods disagree and why, and the result of every method for each row."""

from assess.i18n import fill, ngettext
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import BREAK, Block, Heading, Paragraph, Section, list_columns, more, table
from assess.report.page_columns import build_table
from assess.report.view import Part, View, shorten

MOST_GROUPS = 15
"""Groups of disagreements that are shown."""


def build(view: View) -> Section:
    """Return the disagreements by their reason, and the table of all methods where the rows have room."""
    content = view.content
    blocks: list[Block] = [Paragraph(content.total.say_cannot_rock)] if content.total.cannot_rock else []
    if not content.results:
        return Section([*blocks, Paragraph(_("There are no pieces."))], "run-on")
    blocks += [
        Heading(_("Where the methods disagree by more than one class, and why")),
        Paragraph(content.disagreements.summary),
        *_list_groups(view),
        Heading(_("Results of every method for each row")),
    ]
    if view.is_long:
        see = (_("See the appendix, and the sheet Items of the Excel report.") if view.is_compact
               else _("See the sheet Items of the Excel report."))  # fmt: skip
        return Section([*blocks, Paragraph(see)])
    text = _(
        "Under the governing motion of the row: that of the highest adopted class, then of the largest adopted chance. "
        "A larger value under another motion of the row (its other axis, or a parallel record) follows an arrow. "
        "Criteria are met or not met and have no class. A dash: not evaluated, for the reason in the marks of the "
        "method, or not simulated."
    )
    return Section(
        [*blocks, Paragraph(text), build_table(view.columns("methods"), content.listed, "items methods")], "wide"
    )


def _list_groups(view: View) -> list[Block]:
    groups = view.content.disagreements.groups
    if not groups:
        return []
    shown, left = shorten(groups, MOST_GROUPS)
    rows = []
    for one in shown:
        further = ngettext("and {n:,} more", "and {n:,} more", one.left) if one.left else ""
        named = f"{words.plural(len(one.rows), 'row')}: {', '.join(one.named)} {further}".rstrip()
        rows.append((named, [one.highest, BREAK, one.lowest], " ".join(one.reasons)))
    heads = list_columns((_("Rows"), "w20"), (_("Highest and lowest"), "w20"), (_("Why"), ""))
    has_left = any(one.left for one in groups)
    return [
        table(heads, rows, "disagreements"),
        *([Paragraph(_("The sheet Items of the Excel report has all rows."), "small")] if has_left else []),
        *more(left, lambda n: ngettext("{n:,} further group is left out.", "{n:,} further groups are left out.", n)),
    ]


PART = Part(key="comparison", heading=fill("Comparison of the methods"), places={"annex": 120, "all": 90}, build=build)
