"""What to fix: the plan in phases, room by room, the anchors to check, and how each fix is made."""

from collections.abc import Iterator, Sequence
from itertools import groupby

from assess.details import DETAILS, WALLS, WHO
from assess.fields import schedule_fields
from assess.i18n import fill, gettext as _, ngettext, number
from assess.pipeline.schedule import PHASE_RULE
from assess.report import blocks, measures, words
from assess.report.page_columns import mark
from assess.report.say import orders, work as say
from assess.report.view import Part, View, say_left
from assess.schedule_results import Schedule, WorkRow

MOST = 150
"""Entries that are shown; the Excel report holds all."""


def build(view: View) -> blocks.Section:
    """Return what the plan changes, the work of phases A and B by room, what is only listed, and the details."""
    schedule = view.run.schedule
    lines = orders.list_lines(view.content)
    found: list[blocks.Block] = [
        blocks.Paragraph(" ".join(say.say_effect_of_all(schedule)), "lead"),
        blocks.Paragraph(_(PHASE_RULE)),
        *view.list_texts("What to fix"),
    ]
    for phase in ("A", "B", ""):
        if own := [one for one in lines if one.phase == phase]:
            found += [blocks.Heading(_(orders.PHASES[phase])), _list_work(view, own[:MOST]), *say_left(len(own) - MOST)]
    found += _list_only(view)
    texts = [_(say.CHECKS), blocks.lower_indices(say.say_code(view.run)), _(say.DISAGREEMENT)]
    works = [work for row in (*schedule.rows, *schedule.checks) for work in row.works if row.phase != "C"]
    used = {key for work in works for key in (work.detail, work.like)}
    found += [
        *_list_changes(schedule),
        blocks.Heading(_("How each fix is made")),
        blocks.Paragraph(blocks.join_words([*texts, *say.list_marks(schedule)]), "lead-in"),
        *_list_details(view, [key for key in DETAILS if key in used]),
    ]
    return blocks.Section(found)


def _list_work(view: View, lines: Sequence[orders.Line]) -> blocks.Table:
    """Return the work of a phase, room by room."""
    schedule = view.run.schedule
    has_cost = any(one.work.row.cost is not None for one in lines)
    columns = blocks.list_columns(
        (_("No."), "w5", "num"), (_("Pieces"), ""), (_("How"), "w18"), (_("Fixings each"), "w7", "num"),
        (_("In all"), "w6", "num"), (_("Pull of one"), "w9", "num"), (_("What it does"), "w24"),
        *([(schedule_fields(WorkRow)["cost"].label, "w11", "num")] if has_cost else []),
    )  # fmt: skip
    groups = []
    for (floor, room), own in groupby(lines, key=lambda one: (one.work.row.floor, one.work.row.room)):
        nowhere = _("no room given")
        heading = f"{view.floor_titles[floor]}: {words.cut(room, 60) or nowhere}"
        groups.append([blocks.part(heading, len(columns))])
        for line in own:
            work, row = line.work, line.work.row
            count = f" ({words.plural(row.pieces, 'piece')})" if row.pieces > len(row.items) else ""
            piece: blocks.Runs = [blocks.strong(work.names), f": {words.cut(work.described, 50)}{count} "]
            piece += [*mark(work.results[0]), f" {work.chance}"]
            if photo := view.photos.first_photo(work.results):
                piece.append(blocks.Image(photo[1], _("Photo of {piece}", piece=photo[0]), "photo"))
            does = [line.say_effect(schedule.before.falls), "" if work.reason == words.DASH else work.reason]
            groups[-1].append(blocks.Row([
                line.number, piece, f"{line.how} ({DETAILS[row.detail].who})", line.say_fixings(),
                line.say_fixings(in_all=True), line.say_pull(), "; ".join(filter(None, does)),
                *([say.say_cost(row.cost, schedule.currency)] if has_cost else []),
            ]))  # fmt: skip
    return blocks.Table(columns, groups, "named schedule", is_named=True)


def _list_only(view: View) -> Iterator[blocks.Block]:
    """Yield the entries of phase C by name: they are in the Excel report with all that is known of them."""
    entries = [one for one in view.content.fixes if one.row.phase == "C"]
    if not entries:
        return
    named = [f"{one.names} ({words.cut(one.results[0].item.floor, 12)})" for one in entries]
    text = ngettext("{n:,} entry that takes {falls} falls away: {names}.",
                    "{n:,} entries that together take {falls} falls away: {names}.", len(entries),
                    falls=number(sum(one.row.falls_avoided for one in entries), ",.1f"),
                    names=words.name_first(named, 40))  # fmt: skip
    yield blocks.Heading(_(orders.PHASES["C"]))
    yield blocks.Paragraph(text)


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
        drawing, what = view.read_drawing(one), _(one.say_what(us=measures.is_us()))
        lines: blocks.Runs = [blocks.strong(_(one.title)), f" – {one.who}: {_(WHO[one.who])}", blocks.BREAK]
        lines.append(what if one.is_at_wall else f"{what}; {_(one.fixing)}")
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
