"""All pieces, a row each; of a long list in print the risky ones, as the appendix has all."""

from collections.abc import Sequence

from assess.i18n import fill, ngettext
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import Block, Box, Paragraph, Row, Section, Span, Table, Words, join_words, part
from assess.report.page_columns import PageColumn, build_table
from assess.report.view import MOST_ROWS, Part, View
from assess.results import ItemResult

MOST_RISKY = 60
"""Risky pieces that stand in place of the whole table."""


def build(view: View) -> Section:
    """Return the table of all pieces, or the risky ones in three tables: by class, unconfirmed, by formula."""
    content = view.content
    if not content.results:
        return Section([Paragraph(_("There are no pieces."))], "run-on")
    lead = Paragraph(join_words(_explain(view)))
    if not view.is_compact:
        label = _("All pieces")
        return Section([lead, Box([_list_all(view)], "scroll", label=label)], "wide")
    blocks: list[Block] = [lead]
    first = _(
        "The rows that are high or very high, including borderline cases, the worst first; all rows are in the "
        "appendix."
    )
    parts: Sequence[tuple[str, Sequence[ItemResult]]] = (
        (first, content.risky),
        (f"{words.UNCONFIRMED} " + _("Unconfirmed, counted apart:"), content.unconfirmed),
        (f"{words.BY_FORMULA} " + _("By formula only, counted apart:"), content.risky_by_formula),
    )
    for at, (text, rows) in enumerate(parts):
        if rows or not at:
            most = _("The first {n:,} of {all:,}:", n=MOST_RISKY, all=len(rows)) if len(rows) > MOST_RISKY else ""
            blocks += [Paragraph(join_words((text, most)), "lead-in"),
                       build_table(view.columns("risky"), rows[:MOST_RISKY], "pieces")]  # fmt: skip
    return Section(blocks)


def _explain(view: View) -> list[str]:
    """Return how many rows there are, and what the columns mean."""
    content, verified, n = view.content, view.content.verified, len(view.content.results)
    if n > MOST_ROWS:
        count = _(
            "{n:,} rows, the first {shown:,} of which are shown: the Excel report holds all.", n=n, shown=MOST_ROWS
        )
    else:
        count = ngettext("{n:,} row.", "{n:,} rows.", n)
    if verified.done:
        chance = _("Chance: the adopted risk, simulated where it has a range, otherwise from the formula; {interval}.",
                   interval=verified.interval)  # fmt: skip
        record = _("Under the record: the behaviour under the recorded motion itself, as largest rotation over the "
                   "critical angle, the worst of several records; a dash: no record, or not simulated.")  # fmt: skip
    else:
        chance = _("Chance: the adopted risk, here from: {formula}.", formula=_(content.run.formula.title))
        record = ""
    raw = _("Raw: as printed, before the departures listed in the section Methods. Where the axis is not known, the "
            "worse of both governs.")  # fmt: skip
    return [count, chance, record, raw]


def _list_all(view: View) -> Table:
    columns = view.columns("pieces")
    groups = [
        [*([part(heading, len(columns))] if heading else []), *(_list_one(view, columns, one) for one in rows)]
        for heading, rows in view.content.parts(MOST_ROWS)
    ]
    return Table([one.column for one in columns], groups, "items", id="pieces", is_named=True)


def _list_one(view: View, columns: Sequence[PageColumn], one: ItemResult) -> Row:
    number, item, on_screen = one.item.index + 1, one.item, not view.for_print
    is_on_plan = on_screen and item.x_m is not None and item.y_m is not None and view.plans.get(item.floor)

    def link(text: str) -> Words:
        return Span(text, href=f"#piece-{number}", title=_("Show it on the plan")) if is_on_plan else text

    return Row(
        [link(one_.text(one)) if one_.key == "item" else one_.cell(one, can_sort=on_screen) for one_ in columns],
        id=f"row-{number}",
        data={"floor": item.floor, "room": item.room, "class": words.style_name(one), "route": item.route}
        if on_screen else {},
    )  # fmt: skip


PART = Part(key="items", heading=fill("All pieces"), places={"annex": 110, "all": 50}, build=build)
