"""What was simulated, under which motions, and what it changed."""

from assess.i18n import fill, ngettext
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import (
    Block,
    Bullets,
    Figure,
    Heading,
    Image,
    Paragraph,
    Section,
    list_columns,
    more,
    rich,
    strong,
    table,
)
from assess.report.embedded import data_uri
from assess.report.figures.motion_figures import choose_traced, draw_traced
from assess.report.page_columns import build_table
from assess.report.say.simulation import LISTED
from assess.report.view import Part, View, in_whole, shorten

MOST, MISFITS = 60, 6
"""Motions, and sentences on large misfits, that are shown."""


def build(view: View) -> Section:
    """Return the status, the motions of each floor with their fit, figures, and what simulation changed."""
    content = view.content
    if not content.verified.done:
        text = rich(_(
            "<strong>Not simulated.</strong> The risks in this report come from published formulas. No rocking has "
            "been simulated, so no class has been confirmed, raised or lowered, and no interval is given."
        ))  # fmt: skip
        return Section([Paragraph(text)], "run-on")
    status, why = content.verified.status
    blocks: list[Block] = [Paragraph([strong(status), f": {why}."], "lead")]
    blocks += [Paragraph(text) for text in content.trials.paragraphs]
    blocks += [Bullets(content.verified.summary), *_list_motions(view)]
    blocks += view.once("verification", lambda: _draw(view))
    return Section([*blocks, *_list_changes(view)])


def _list_motions(view: View) -> list[Block]:
    trials = view.content.trials
    shown, left = shorten(trials.motions, MOST)
    heads = list_columns(
        (_("Floor"), "w8"), (_("Axis"), "w6"), (_("Floor motion"), ""), (_("Motions made for"), "w12"),
        (_("Motions"), "w9", "num"), (_("Rows simulated"), "w11", "num"),
        (_("Spectral misfit (mean; most)"), "w15", "num"), (_("PFA, ratio"), "w11", "num"),
        (_("PFV, ratio"), "w11", "num"),
    )  # fmt: skip
    rows = [
        (one.floor, one.axis, one.source, one.kind, one.motions, in_whole(one.rows), one.spectrum, one.pfa, one.pfv)
        for one in shown
    ]
    misfit = _(
        "Spectral misfit: mean deviation of the motions' mean 5 % spectrum from its target, over its periods; then the "
        "largest, and its period. Ratios: mean peak of the motions over the floor's, ± the scatter from motion to "
        "motion."
    )
    return [
        Heading(_("Motions of each floor")),
        table(heads, rows, "motions"),
        *more(left, lambda n: ngettext("{n:,} more is in the Excel report.", "{n:,} more are in the Excel report.", n)),
        Paragraph(misfit, "small"),
        *(Paragraph(text, "caution") for text in trials.misfits[:MISFITS]),
        *more(
            len(trials.misfits) - MISFITS,
            lambda n: ngettext("{n:,} more floor motion with a large misfit is in the table.",
                               "{n:,} more floor motions with a large misfit are in the table.", n),
        ),
    ]  # fmt: skip


def _draw(view: View) -> list[Figure]:
    return [
        Figure(Image(data_uri(one.drawing, "image/svg+xml"), one.alternative), one.caption)
        for one in draw_traced(view.content, choose_traced(view.content), view.progress)
    ]


def _list_changes(view: View) -> list[Block]:
    changed, fell = view.content.trials.changed, view.content.trials.fell
    blocks: list[Block] = [Heading(_("Classes lowered or raised"))]
    if changed:
        text = ngettext("{n:,} row, raised ones and the largest changes first.",
                        "{n:,} rows, raised ones and the largest changes first.", len(changed))  # fmt: skip
        if len(changed) > LISTED:
            text += " " + _("The first {listed} are shown; the Excel report lists all.", listed=LISTED)
        columns = view.columns(
            "item", "floor", "description", "quantity", "formula", "ideal", "adopted_probability", "adopted_class"
        )
        blocks += [Paragraph(text, "lead-in"), build_table(columns, changed[:LISTED], "pieces")]
    else:
        blocks.append(Paragraph(_("None: every confirmed class is that of the formula.")))
    blocks.append(Heading(_("Pieces that overturn under the record itself")))
    if not fell:
        return [*blocks, Paragraph(_("None of the simulated pieces, as far as a record is known."))]
    if len(fell) > LISTED:
        text = _("The first {listed} of {rows}, the worst first; the Excel report lists all.", listed=LISTED,
                 rows=words.plural(len(fell), "row"))  # fmt: skip
        blocks.append(Paragraph(text, "lead-in"))
    return [*blocks, build_table(view.columns("risky"), fell[:LISTED], "pieces")]


PART = Part(key="verification", heading=fill("Verification"), places={"annex": 30, "all": 110}, build=build)
