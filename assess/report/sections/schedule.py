"""What to fix, room by room: with what, what it has to carry, and what it changes."""

from collections.abc import Iterator, Sequence

from assess.details import Detail
from assess.fields import schedule_fields
from assess.i18n import fill, ngettext
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import (
    BREAK,
    Block,
    Box,
    Cell,
    Column,
    Heading,
    Image,
    Inline,
    Paragraph,
    Row,
    Section,
    Span,
    Table,
    Words,
    head,
    join_words,
    list_columns,
    lower_indices,
    note,
    part,
    rich,
    strong,
    table,
)
from assess.report.page_columns import mark
from assess.report.say import work as say_work
from assess.report.say.work import Change, Work
from assess.report.view import Part, View, in_whole
from assess.schedule_results import WorkRow

MOST = 150
"""Entries that are shown; the Excel report holds all."""


def build(view: View) -> Section:
    """Return what the schedule changes, the work by room, and the details."""
    schedule = view.run.schedule
    lead = say_work.say_effect_of_all(schedule)
    if not lead:
        none = (_("No simulated free-standing piece reaches medium, and no route needs one fixed.") if view.has_apart
                else _("No free-standing piece reaches medium, and no route needs one fixed."))  # fmt: skip
        return Section([Paragraph(none)])
    at_risk = say_work.say_rooms_at_risk(schedule)
    before = _(
        "Before and after: the draws of this run, with every piece of the list anchored and all anchors holding."
    )
    return Section([
        Paragraph(" ".join(lead), "lead"),
        Paragraph(before, "lead-in"),
        Box(_list_changes(*say_work.list_changes(schedule)), "before-after"),
        *([Paragraph(at_risk, "small")] if at_risk else []),
        Heading(_("Work by room")),
        *_list_work(view),
        Heading(_("How to fix it")),
        Paragraph(say_work.say_disagreement(), "lead-in"),
        _list_details(view),
    ])  # fmt: skip


def _list_changes(pieces: Sequence[Change], routes: Sequence[Change]) -> list[Block]:
    return [
        Box([table(
            list_columns((name, ""), (_("Before"), "w18", "num"), (_("After"), "w18", "num")),
            [(head(one.label), *(words.fixed(value, one.decimals) for value in (one.before, one.after)))
             for one in changes],
            "changes",
        )])
        for name, changes in ((_("Pieces"), pieces), (_("Routes and rooms"), routes))
        if changes
    ]  # fmt: skip


def _list_work(view: View) -> Iterator[Block]:
    schedule, shown = view.run.schedule, view.content.summary.fixes[:MOST]
    works = say_work.list_work(shown, list(view.floor_titles))
    has_code, has_cost = any(one.row.tension_code_kn is not None for one in works), schedule.cost is not None
    forces = _(
        "Forces are those of each piece: the tension that its fixings carry together, at the bracket or, for a base "
        "angle, at the base, and the shear at its base at PFA."
    )
    code = lower_indices(_("By code: F_p of ASCE 7-22.")) if has_code else ""
    yield Paragraph(join_words((f"{say_work.say_order()} {forces}", code)), "lead-in")
    columns = list(_list_columns(has_code=has_code, has_cost=has_cost))
    groups = [
        [part(room.heading, len(columns)),
         *(Row(list(_list_cells(view, one, has_code=has_code, has_cost=has_cost))) for one in room.works)]
        for room in say_work.list_rooms(works, view.floor_titles)
    ]  # fmt: skip
    caption = rich(_("Force on each piece [kN]: <em>{caveat}</em>"), caveat=say_work.say_screening())
    yield Table(columns, groups, "named schedule", [*caption, "."], is_named=True)
    if left := len(schedule.rows) - len(shown):
        yield Paragraph(ngettext("{n:,} more entry is in the Excel report.",
                                 "{n:,} more entries are in the Excel report.", left))  # fmt: skip
    held = f"{say_work.HELD}: {say_work.say_held()}." if any(one.is_held_by_weight for one in works) else ""
    left_over = _("Falls left: once this entry and all of smaller number are fixed.")
    texts = (say_work.say_checks(), left_over, held, *say_work.list_marks(schedule), view.marks)
    yield Paragraph(join_words(texts), "small")


def _list_columns(*, has_code: bool, has_cost: bool) -> Iterator[Column]:
    fields = schedule_fields(WorkRow)
    yield Column(_("No."), "w4", is_number=True)
    yield Column(_("Pieces, class and chance, and why"))
    yield Column(_("Fix with"), "w14")
    forces = (_("T at PFA"), _("T at 84 %"), *([_("T by code")] if has_code else []), _("Shear"))
    yield from (Column([f"{name} ", Span("[kN]", "unit")], "w5", is_number=True, kind="force") for name in forces)
    yield Column(_("Fixings each × pieces"), "w8", is_number=True)
    if has_cost:
        yield from (Column(fields[key].short_heading(), "w7", is_number=True) for key in ("unit_cost", "cost"))
    yield Column(_("Falls avoided"), "w7", is_number=True)
    yield Column(_("Falls left"), "w6", is_number=True)


def _list_cells(view: View, work: Work, *, has_code: bool, has_cost: bool) -> Iterator[Words]:
    row, entry, force = work.row, work.entry, say_work.say_force
    yield str(entry.place)
    yield _describe(view, work)
    yield join_words((_(work.detail.title), note(f"({work.marks})") if work.marks else ""))
    yield force(row.tension_kn)
    yield f"{force(row.tension_high_kn)}{f' {say_work.HELD}' if work.is_held_by_weight else ''}"
    if has_code:
        yield force(row.tension_code_kn)
    yield force(row.shear_kn)
    yield f"{say_work.say_fixings(row)} × {in_whole(row.pieces)}"
    if has_cost:
        yield from (say_work.say_cost(cost) for cost in (row.unit_cost, row.cost))
    yield words.fixed(entry.saved, 2) if work.is_first else words.DASH
    yield words.fixed(entry.row.falls_left, 2) if work.is_first else words.DASH


def _describe(view: View, work: Work) -> list[Inline]:
    """Return the pieces with what they are, their class, chance and reason, and a photo."""
    row = work.row
    count = f" ({words.plural(row.pieces, 'piece')})" if row.pieces > len(row.items) else ""
    reason = f"; {work.reason}" if work.reason != words.DASH else ""
    found: list[Inline] = [strong(work.names), f": {words.cut(work.described, 50)}{count} "]
    found += [*mark(work.results[0]), f" {work.chance}{reason}"]
    photo = view.photos.first_photo(work.results)
    return [*found, Image(photo[1], _("Photo of {piece}", piece=photo[0]), "photo")] if photo else found


def _list_details(view: View) -> Table:
    used, others = say_work.list_details(view.run.schedule)
    notes = [(one, words.plural(pieces, "piece")) for one, pieces in used]
    notes += [(one, _("alternative")) for one in others]
    heads = list_columns((_("Detail"), "w12"), (_("What is done"), "w24"), (_("Known weakness"), ""),
                         (_("Capacity of one fixing"), "w24"), (_("Source"), "w12"))  # fmt: skip
    return table(heads, (_list_detail(one, text) for one, text in notes), "named details")


def _list_detail(one: Detail, text: str) -> list[Cell | Words]:
    title = head([f"{_(one.title)} ", BREAK, note(text)])
    return [title, _(one.what), _(one.weakness), _(one.fixing), _(one.source)]


PART = Part(
    key="schedule", heading=fill("What to fix"), places={"client": 20, "all": 20}, build=build,
    is_shown=lambda view: bool(view.content.results),
)  # fmt: skip
