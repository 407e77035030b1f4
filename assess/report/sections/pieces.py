"""The pieces for a client: alike ones in one row."""

from assess.i18n import fill, ngettext
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import Paragraph, Row, Section, Span, Table, join_words, list_columns, part
from assess.report.page_columns import mark
from assess.report.say.piece import choose_groups, group_rows
from assess.report.summary import describe
from assess.report.view import Part, View, in_whole


def build(view: View) -> Section:
    """Return the groups of pieces, floor by floor, those most likely to fall where there are too many."""
    groups = group_rows(view.content.listed)
    chosen = choose_groups(groups)
    count = sum(len(own) for _floor, own in chosen)
    lead = [
        ngettext("{n:,} row of the workbook; alike ones stand together.",
                 "{n:,} rows of the workbook; alike ones stand together.", len(view.content.results)),
        _("Alike are rows of the same floor, description, type, sizes, anchoring and class; the number of rows is in "
          "brackets. The annex lists every piece."),
        _("The {n:,} groups most likely to fall, of {all:,}, are shown.", n=count, all=len(groups))
        if count < len(groups) else "",
    ]  # fmt: skip
    anchored = _("Chance of an anchored piece: as if free-standing.") if view.content.total.anchored else ""
    legend = [view.marks, f"{words.apart_legend()}." if view.has_apart else "", anchored]
    heads = list_columns(
        (_("Items"), "w15"), (_("Room"), "w12"), (_("What"), ""), (["B × W × H ", Span("[cm]", "unit")], "w15", "num"),
        (_("No."), "w4", "num"), (_("Chance (range)"), "w24", "num"), (_("Class"), "w12"),
    )  # fmt: skip
    rows = [
        [part(view.floor_titles[floor], len(heads)),
         *(Row((one.names, one.rooms, describe(one.first, 48), words.size(one.first), in_whole(one.pieces),
                one.chance, mark(one.first))) for one in own)]
        for floor, own in chosen
    ]  # fmt: skip
    return Section(
        [
            Paragraph(join_words(lead)),
            Paragraph(join_words(legend), "small"),
            Table(heads, rows, "grouped", is_named=True),
        ]
    )


PART = Part(
    key="pieces", heading=fill("Pieces"), places={"client": 50}, build=build,
    is_shown=lambda view: bool(view.content.results),
)  # fmt: skip
