"""What to fix, room by room: with what, what it has to carry, and what it changes."""

from collections.abc import Iterator, Sequence
from itertools import groupby

from assess.details import DETAILS
from assess.fields import schedule_fields
from assess.i18n import fill, gettext as _, number
from assess.report import blocks, words
from assess.report.page_columns import mark
from assess.report.say import work as say
from assess.report.view import Part, View, say_left
from assess.schedule_results import WorkRow

MOST = 150
"""Entries that are shown; the Excel report holds all."""


def build(view: View) -> blocks.Section:
    """Return what the schedule changes, the work by room, and the details."""
    schedule = view.run.schedule
    lead = say.say_effect_of_all(schedule)
    if not lead:
        none = (_("No simulated free-standing piece reaches medium, and no route needs one fixed.")
                if view.content.total.has_apart
                else _("No free-standing piece reaches medium, and no route needs one fixed."))  # fmt: skip
        return blocks.Section([blocks.Paragraph(none)])
    changes = []
    for name, own in zip((_("Pieces"), _("Routes and rooms")), say.list_changes(schedule), strict=True):
        heads = blocks.list_columns((name, ""), (_("Before"), "w18", "num"), (_("After"), "w18", "num"))
        rows = [
            (blocks.head(one.label), words.fixed(one.before, one.decimals), words.fixed(one.after, one.decimals))
            for one in own
        ]
        changes += [blocks.Box([blocks.table(heads, rows, "changes")])] if own else []
    at_risk, after = schedule.before.rooms_at_risk, schedule.after.rooms_at_risk
    text = _("Rooms that may lose every exit before: {rooms}.", rooms=words.name_first(at_risk, say.MOST_NAMES))
    left = _("after: {rooms}.", rooms=words.name_first(after, say.MOST_NAMES)) if after else _("after: none.")
    used: dict[str, int] = {}
    for work in (work for row in schedule.rows for work in row.works):
        used[work.detail] = used.get(work.detail, 0) + work.pieces
    notes = [(one, words.plural(used[key], "piece")) for key, one in DETAILS.items() if key in used]
    notes += [(one, _("alternative")) for key, one in DETAILS.items() if key not in used]
    heads = blocks.list_columns((_("Detail"), "w12"), (_("What is done"), "w24"), (_("Known weakness"), ""),
                                (_("Capacity of one fixing"), "w24"), (_("Source"), "w12"))  # fmt: skip
    details: Iterator[Sequence[blocks.Cell | blocks.Words]] = (
        (blocks.head([f"{_(one.title)} ", blocks.BREAK, blocks.note(text)]), _(one.what), _(one.weakness),
         _(one.fixing), _(one.source))
        for one, text in notes
    )  # fmt: skip
    return blocks.Section([
        blocks.Paragraph(" ".join(lead), "lead"),
        blocks.Paragraph(_("Before and after: the draws of this run, with every piece of the list anchored and all "
                           "anchors holding."), "lead-in"),
        blocks.Box(changes, "before-after"),
        *([blocks.Paragraph(f"{text[:-1]}; {left}", "small")] if at_risk else []),
        blocks.Heading(_("Work by room")),
        *_list_work(view),
        blocks.Heading(_("How to fix it")),
        blocks.Paragraph(_(say.DISAGREEMENT), "lead-in"),
        blocks.table(heads, details, "named details"),
    ])  # fmt: skip


def _list_work(view: View) -> Iterator[blocks.Block]:
    schedule, shown = view.run.schedule, view.content.fixes[:MOST]
    works = say.list_work(shown, list(view.floor_titles))
    has_code, has_cost = any(one.row.tension_code_kn is not None for one in works), schedule.cost is not None
    forces = _("Forces are those of each piece: the tension that its fixings carry together, at the bracket or, for a "
               "base angle, at the base, and the shear at its base at PFA.")  # fmt: skip
    code = blocks.lower_indices(_("By code: {force}.", force=say.say_code(view.run))) if has_code else ""
    yield blocks.Paragraph(blocks.join_words((f"{_(say.ORDER)} {forces}", code)), "lead-in")
    fields = schedule_fields(WorkRow)
    columns = [
        blocks.Column(_("No."), "w4", is_number=True),
        blocks.Column(_("Pieces, class and chance, and why")),
        blocks.Column(_("Fix with"), "w14"),
        *(blocks.Column([f"{name} ", blocks.Span("[kN]", "unit")], "w5", is_number=True, kind="force")
          for name in (_("T at PFA"), _("T at 84 %"), *([_("T by code")] if has_code else []), _("Shear"))),
        blocks.Column(_("Fixings each × pieces"), "w8", is_number=True),
        *(blocks.Column(fields[key].short_heading(), "w7", is_number=True)
          for key in ("unit_cost", "cost") if has_cost),
        blocks.Column(_("Falls avoided"), "w7", is_number=True),
        blocks.Column(_("Falls left"), "w6", is_number=True),
    ]  # fmt: skip
    groups = []
    for (floor, room), own in groupby(works, key=lambda one: (one.row.floor, one.row.room)):
        nowhere = _("no room given")
        heading = f"{view.floor_titles[floor]}: {words.cut(room, 60) or nowhere}"
        groups.append([blocks.part(heading, len(columns))])
        for one in own:
            row, entry = one.row, one.entry.row
            count = f" ({words.plural(row.pieces, 'piece')})" if row.pieces > len(row.items) else ""
            reason = f"; {one.reason}" if one.reason != words.DASH else ""
            found: blocks.Runs = [blocks.strong(one.names), f": {words.cut(one.described, 50)}{count} "]
            found += [*mark(one.results[0]), f" {one.chance}{reason}"]
            if photo := view.photos.first_photo(one.results):
                found.append(blocks.Image(photo[1], _("Photo of {piece}", piece=photo[0]), "photo"))
            groups[-1].append(blocks.Row([
                str(entry.place),
                found,
                blocks.join_words((_(DETAILS[row.detail].title), blocks.note(f"({one.marks})") if one.marks else "")),
                say.say_force(row.tension_kn),
                f"{say.say_force(row.tension_high_kn)}{f' {say.HELD}' if one.is_held_by_weight else ''}",
                *([say.say_force(row.tension_code_kn)] if has_code else []),
                say.say_force(row.shear_kn),
                f"{say.say_fixings(row)} × {number(row.pieces, ',d')}",
                *([say.say_cost(each, schedule.currency) for each in (row.unit_cost, row.cost)] if has_cost else []),
                words.fixed(entry.falls_avoided, 2) if one.is_first else words.DASH,
                words.fixed(entry.falls_left, 2) if one.is_first else words.DASH,
            ]))  # fmt: skip
    caption = blocks.rich(_("Force on each piece [kN]: <em>{caveat}</em>"), caveat=_(say.SCREENING))
    yield blocks.Table(columns, groups, "named schedule", [*caption, "."], is_named=True)
    yield from say_left(len(schedule.rows) - len(shown))
    held = f"{say.HELD}: {_(say.HOLDS)}." if any(one.is_held_by_weight for one in works) else ""
    left_over = _("Falls left: once this entry and all of smaller number are fixed.")
    texts = (_(say.CHECKS), left_over, held, *say.list_marks(schedule), view.marks)
    yield blocks.Paragraph(blocks.join_words(texts), "small")


PARTS = (
    Part(key="schedule", heading=fill("What to fix"), places={"client": 20, "all": 20}, build=build,
         is_shown=lambda view: bool(view.results)),
)  # fmt: skip
