"""What the marks mean, the notes of the workbook, and the recorded motions."""

from collections.abc import Iterator

from assess.i18n import fill, ngettext
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import (
    Block,
    Box,
    Figure,
    Heading,
    Image,
    Paragraph,
    Section,
    Terms,
    join_words,
    list_columns,
    more,
    table,
)
from assess.report.embedded import data_uri
from assess.report.figures.motion_figures import draw_motion, get_acceleration
from assess.report.page_columns import say_flag
from assess.report.say import ground
from assess.report.view import Part, View, shorten
from assess.results import MotionRow

MOST_NOTES, FEW = 150, 6
"""Notes that are shown; up to how many their table is kept on one page."""
MOST_RECORDS = 16
"""Recorded motions that are drawn, those of the floors that are shaken most; the others are described."""


def build(view: View) -> Section:
    """Return marks, notes and records."""
    content = view.content
    blocks: list[Block] = [
        Heading(_("What the marks mean")),
        Terms([(say_flag(flag), meaning) for flag, meaning in content.flags.items()]),
    ]
    if content.notes:
        shown, left = shorten(content.notes, MOST_NOTES)
        rows = [(words.cut(one.item.item, 40), words.clip(one.item.notes, 300)) for one in shown]
        heads = list_columns((_("Item"), "w12"), (_("Note"), ""))
        blocks += [Heading(_("Notes of the workbook")), table(heads, rows, "few" if len(content.notes) <= FEW else "")]
        blocks += more(left, lambda n: ngettext("{n:,} more is in the Excel report.",
                                                "{n:,} more are in the Excel report.", n))  # fmt: skip
    recorded = view.once("recorded", lambda: list(_list_recorded(view)))
    blocks += [Heading(_("Recorded motions")), *recorded] if recorded else []
    return Section(blocks)


def _list_recorded(view: View) -> Iterator[Box]:
    found = [(page.title, one) for page in view.content.floors for one in page.motions if is_drawn(one)]
    strongest = sorted((one for _title, one in found), key=lambda one: -one.pfa_g)[:MOST_RECORDS]
    for title, one in found:
        name = words.cut(one.record, 60)
        lines = [
            _("{floor}, along {axis}: {name} ({event}). {treatment}", floor=title, axis=one.axis, name=name,
              event=words.cut(one.event, 60), treatment=ground.describe_treatment(one)),
            _("PFA in the file: {pfa} g.", pfa=words.in_g(one.pfa_file_g)) if one.pfa_file_g else "",
        ]  # fmt: skip
        values = get_acceleration(view.run, one) if one in strongest else None
        figures = []
        if values is not None:
            drawn = data_uri(draw_motion(values, one.time_step_s or 0.0, view.progress), "image/svg+xml")
            alternative = _("Acceleration against time of {name}, peak {pfa} g", name=name, pfa=words.in_g(one.pfa_g))
            caption = _("Recorded acceleration along {axis}, treated: {name}.", axis=one.axis, name=name)
            figures = [Figure(Image(drawn, alternative), caption)]
        yield Box([Paragraph(join_words(lines), "small"), *figures], "keep")


def is_drawn(one: MotionRow) -> bool:
    """Tell whether a motion is a record of its own floor and axis."""
    return one.has_record and not one.is_borrowed


PART = Part(key="appendix", heading=fill("Appendix"), places={"annex": 90, "all": 180}, build=build)
