"""Missing or unusual input and how it was handled, and how the report was made."""

from assess.i18n import fill, ngettext
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import Block, Cell, Heading, Paragraph, Section, list_columns, more, table
from assess.report.sections.about import list_facts
from assess.report.view import Part, View, shorten

MOST, FEW = 120, 6
"""Problems that are shown; rows up to which a table is kept on one page."""


def build(view: View) -> Section:
    """Return the log, in the annex the building as filled in, and versions and hashes."""
    problems, making = view.content.problems, view.content.making
    shown, left = shorten(problems, MOST)
    blocks: list[Block] = [Paragraph(_("Missing or unusual input and how it was handled."))]
    if problems:
        heads = list_columns((_("Kind"), "w9"), (_("Place"), "w14"), (_("What"), ""))
        rows = [(_(one.severity), words.cut(one.place, 60), f"{_(one.message)} {_(one.fix)}") for one in shown]
        blocks += [table(heads, rows, "few" if len(problems) <= FEW else "")]
        blocks += more(left, lambda n: ngettext("{n:,} more is in the Excel report.",
                                                "{n:,} more are in the Excel report.", n))  # fmt: skip
    else:
        blocks.append(Paragraph(_("None.")))
    if view.edition == "annex":
        blocks += [Heading(_("The building as filled in")), *list_facts(view)]
    heads = list_columns((_("What"), "w24"), (_("Value"), ""))
    made = [(what, Cell(value, "hash")) for what, value in making]
    blocks += [Heading(_("How this report was made")), table(heads, made, "few" if len(making) <= FEW else "")]
    return Section(blocks)


PART = Part(key="quality", heading=fill("Data-quality log"), places={"annex": 70, "all": 160}, build=build)
