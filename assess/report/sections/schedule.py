"""What to fix: the plan in phases, room by room, the anchors to check, and how each fix is made."""

from collections.abc import Iterator, Sequence
from itertools import groupby

from assess.details import DETAILS, WALLS, WHO
from assess.fields import schedule_fields
from assess.i18n import fill, gettext as _, ngettext
from assess.pipeline.schedule import PHASE_RULE
from assess.report import blocks, measures, words
from assess.report.page_columns import mark
from assess.report.say import work as say
from assess.report.view import Part, View, say_left
from assess.schedule_results import Schedule, WorkRow

MOST = 150
"""Entries that are shown; the Excel report holds all."""


def build(view: View) -> blocks.Section:
    """Return what the plan changes, the work of phases A and B by room, what is only listed, and the details."""
    schedule = view.run.schedule
    lead = say.say_effect_of_all(schedule)
    shown = view.content.fixes[:MOST]
    found: list[blocks.Block] = [
        blocks.Paragraph(" ".join(lead), "lead"),
        blocks.Paragraph(_(PHASE_RULE)),
        *view.list_texts("What to fix"),
    ]
    for phase in ("A", "B"):
        if own := [one for one in shown if one.row.phase == phase]:
            found += [blocks.Heading(say.say_phase(phase)), _list_work(view, own)]
    found += _list_only(view, [one for one in shown if one.row.phase == "C"])
    found += say_left(len(schedule.rows) - len(shown))
    found += _list_checks(view)
    used = {work.detail for row in (*schedule.rows, *schedule.checks) for work in row.works if row.phase != "C"}
    found += [
        *_list_changes(schedule),
        blocks.Heading(_("How each fix is made")),
        blocks.Paragraph(
            blocks.join_words(
                [
                    _(say.CHECKS),
                    blocks.lower_indices(say.say_code(view.run)),
                    _(say.DISAGREEMENT),
                    *say.list_marks(schedule),
                ]
            ),
            "lead-in",
        ),
        *_list_details(view, [key for key in DETAILS if key in used]),
    ]
    return blocks.Section(found)


def _list_work(view: View, entries: Sequence[say.Entry]) -> blocks.Table:
    """Return the work of a phase, room by room."""
    works = say.list_work(entries, list(view.floor_titles))
    has_cost = view.run.schedule.cost is not None
    columns = blocks.list_columns(
        (_("No."), "w4", "num"), (_("Pieces"), ""), (_("How"), "w15"), (_("Fixings"), "w12"),
        (_("What it does"), "w30"), *([(schedule_fields(WorkRow)["cost"].label, "w11", "num")] if has_cost else []),
    )  # fmt: skip
    groups = []
    for (floor, room), own in groupby(works, key=lambda one: (one.row.floor, one.row.room)):
        nowhere = _("no room given")
        heading = f"{view.floor_titles[floor]}: {words.cut(room, 60) or nowhere}"
        groups.append([blocks.part(heading, len(columns))])
        for one in own:
            row, detail = one.row, DETAILS[one.row.detail]
            count = f" ({words.plural(row.pieces, 'piece')})" if row.pieces > len(row.items) else ""
            piece: blocks.Runs = [blocks.strong(one.names), f": {words.cut(one.described, 50)}{count} "]
            piece += [*mark(one.results[0]), f" {one.chance}"]
            if photo := view.photos.first_photo(one.results):
                piece.append(blocks.Image(photo[1], _("Photo of {piece}", piece=photo[0]), "photo"))
            does = _("with no. {n}", n=one.entry.row.place)
            if one.is_first:
                does = say.say_benefit(one, view.run.schedule.before.falls)
            reason = f"; {one.reason}" if one.reason != words.DASH else ""
            groups[-1].append(blocks.Row([
                str(one.entry.row.place), piece, f"{_(detail.title)} ({detail.who})",
                say.say_all_fixings(row), f"{does}{reason}",
                *([say.say_cost(row.cost, view.run.schedule.currency)] if has_cost else []),
            ]))  # fmt: skip
    return blocks.Table(columns, groups, "named schedule", is_named=True)


def _list_only(view: View, entries: Sequence[say.Entry]) -> Iterator[blocks.Block]:
    """Yield the entries of phase C by name: they are in the Excel report with all that is known of them."""
    if not entries:
        return
    named = [f"{one.names} ({words.cut(one.results[0].item.floor, 12)})" for one in entries]
    avoided = sum(one.row.falls_avoided for one in entries)
    text = ngettext("{n:,} entry that takes {falls} falls away: {names}.",
                    "{n:,} entries that together take {falls} falls away: {names}.", len(entries),
                    falls=words.fixed(avoided, 1), names=words.name_first(named, 40))  # fmt: skip
    yield blocks.Heading(say.say_phase("C"))
    yield blocks.Paragraph(text)


def _list_checks(view: View) -> Iterator[blocks.Block]:
    """Yield the anchors to check and the pieces that roll, which the plan does not fix with brackets."""
    checks = view.run.schedule.checks
    if not checks:
        return
    heads = blocks.list_columns(
        (_("Phase"), "w7"), (_("Pieces"), ""), (_("Where"), "w24"), (_("What to do"), "w24"), (_("Why"), "w24")
    )  # fmt: skip
    rows: list[tuple[blocks.Words, ...]] = []
    for one in checks[:MOST]:
        work, where = one.works[0], view.floor_titles[one.floor]
        pieces = [view.results[at] for at in one.item_indices]
        named = say.join_names(say.shorten_names(each.item.item for each in pieces))
        described = words.cut(pieces[0].item.description or pieces[0].item.type, 50)
        rows.append((one.phase, [blocks.strong(named), f": {described}"],
                     f"{where}, {words.cut(one.room, 40)}" if one.room else where, _(DETAILS[work.detail].title),
                     say.say_check(one)))  # fmt: skip
    yield blocks.Heading(_("Anchors to check, and what rolls"))
    yield blocks.table(heads, rows, "named checks", is_named=True)
    yield from say_left(len(checks) - MOST)


def _list_changes(schedule: Schedule) -> Iterator[blocks.Block]:
    """Yield the building today, after phase A, and after A and B."""
    states = [schedule.before, *(one.after for one in schedule.phases if one.phase != "C")]
    if len(states) < 2:
        return
    names = [_("Today"), *(_("After {phase}", phase=one.phase) for one in schedule.phases if one.phase != "C")]
    yield blocks.Heading(_("What the plan changes, if all anchors hold"))
    heads = blocks.list_columns(("", ""), *((name, "w18", "num") for name in names))
    rows: list[list[blocks.Cell | blocks.Words]] = [
        [blocks.head(label), *(words.fixed(value, decimals) for value in values)]
        for label, values, decimals in say.list_states(states)
    ]
    yield blocks.table(heads, rows, "changes few")


def _list_details(view: View, keys: Sequence[str]) -> Iterator[blocks.Table]:
    """Yield the details that are used, with a drawing, by whom, and what is known against each; then the fixings."""
    rows: list[tuple[blocks.Words, ...]] = []
    for one in (DETAILS[key] for key in keys):
        drawing, texts = view.read_drawing(one), [_(one.what), *([] if one.is_at_wall else [_(one.fixing)])]
        lines: blocks.Runs = [blocks.strong(_(one.title)), f" – {one.who}: {_(WHO[one.who])}", blocks.BREAK]
        lines.append("; ".join(texts))
        lines += [blocks.BREAK, blocks.note(". ".join(filter(None, (_(one.weakness), _(one.source)))) + ".")]
        rows.append((blocks.Image(drawing) if drawing else "", lines))
    yield blocks.table(blocks.list_columns(("", "w24"), ("", "")), rows, "details")
    if any(DETAILS[key].is_at_wall for key in keys):
        names = {"studs": _("Studs"), "concrete": _("Concrete"), "masonry": _("Masonry")}
        heads = blocks.list_columns((_("Wall"), "w18"), (_("One fixing"), ""))
        walls = [(blocks.head(names[wall]), _(one.us if measures.is_us() else one.si)) for wall, one in WALLS.items()]
        yield blocks.table(heads, walls, "few")


PARTS = (
    Part(key="schedule", heading=fill("What to fix"), places={"client": 20, "all": 20}, build=build,
         is_shown=lambda view: bool(view.run.schedule.rows or view.run.schedule.checks)),
)  # fmt: skip
