"""The pieces: one a row, as lines of fixed columns, and by every method."""

import unicodedata
from collections.abc import Sequence

from assess.i18n import fill, gettext as _, ngettext
from assess.report import blocks, words
from assess.report.page_columns import PageColumn, build_table
from assess.report.say.methods import find_disagreements
from assess.report.say.piece import list_apart, list_risky
from assess.report.view import MOST_ROWS, Part, View
from assess.results import ItemResult

MOST_RISKY = 60
"""Risky pieces that stand in place of the whole table."""
MOST_REASONS = 15
"""Groups of disagreements that are shown."""
MOST_LINES = 5000
"""Rows beyond which a PDF gets too long for anybody to read."""


def build_items(view: View) -> blocks.Section:
    """Return the table of all pieces, or the risky ones in three tables: by class, unconfirmed, by formula."""
    if not view.results:
        return blocks.Section([blocks.Paragraph(_("There are no pieces."))], "run-on")
    verified, n = view.content.verified, len(view.results)
    texts = [
        _("{n:,} rows, the first {shown:,} of which are shown: the Excel report holds all.", n=n, shown=MOST_ROWS)
        if n > MOST_ROWS else ngettext("{n:,} row.", "{n:,} rows.", n)
    ]  # fmt: skip
    if verified.done:
        texts += [
            _("Chance: the adopted risk, simulated where it has a range, otherwise from the formula; {interval}.",
              interval=verified.interval),
            _("Under the record: the behaviour under the recorded motion itself, as largest rotation over the "
              "critical angle, the worst of several records; a dash: no record, or not simulated."),
        ]  # fmt: skip
    else:
        texts.append(_("Chance: the adopted risk, here from: {formula}.", formula=_(view.run.formula.title)))
    texts.append(_("Raw: as printed, before the departures listed in the section Methods. Where the axis is not known, "
                   "the worse of both governs."))  # fmt: skip
    lead = blocks.Paragraph(blocks.join_words(texts))
    if not view.is_compact:
        return blocks.Section([lead, blocks.Box([_list_all(view)], "scroll", label=_("All pieces"))], "wide")
    found: list[blocks.Block] = [lead]
    parts = (
        (_("The rows that are high or very high, including borderline cases, the worst first; all rows are in the "
           "appendix."), list_risky(view.results)),
        (f"{words.UNCONFIRMED} " + _("Unconfirmed, counted apart:"), list_apart(view.results, "unconfirmed")),
        (f"{words.BY_FORMULA} " + _("By formula only, counted apart:"), list_risky(view.results, "formula")),
        (f"{words.ROLLING} " + _("On castors, not covered:"), list_apart(view.results, "rolls")),
    )  # fmt: skip
    for at, (text, rows) in enumerate(parts):
        if rows or not at:
            most = _("The first {n:,} of {all:,}:", n=MOST_RISKY, all=len(rows)) if len(rows) > MOST_RISKY else ""
            found += [blocks.Paragraph(blocks.join_words((text, most)), "lead-in"),
                      build_table(view.columns("risky"), rows[:MOST_RISKY], "pieces")]  # fmt: skip
    return blocks.Section(found)


def _list_all(view: View) -> blocks.Table:
    columns, on_screen, groups = view.columns("pieces"), not view.for_print, []
    for basis, heading in (
        ("", ""),
        ("unconfirmed", _("Unconfirmed: nothing is known of the building, or the motions may be too weak")),
        ("formula", _("By formula only: not simulated")),
        ("rolls", _("On castors: not covered; the chance is that of the piece without them")),
    ):
        own = [blocks.part(heading, len(columns))] if heading else []
        for one in view.content.listed[:MOST_ROWS]:
            if one.apart != basis:
                continue
            at, item = one.item.index + 1, one.item
            is_on_plan = on_screen and item.x_m is not None and item.y_m is not None and view.plans.get(item.floor)
            cells = [
                each.cell(one, can_sort=on_screen) if each.key != "item" else each.text(one) if not is_on_plan
                else blocks.Span(each.text(one), href=f"#piece-{at}", title=_("Show it on the plan"))
                for each in columns
            ]  # fmt: skip
            data = {"floor": item.floor, "room": item.room, "class": words.style_name(one), "route": item.route}
            own.append(blocks.Row(cells, id=f"row-{at}", data=data if on_screen else {}))
        groups += [own] if len(own) > bool(heading) else []
    return blocks.Table([one.column for one in columns], groups, "items", id="pieces", is_named=True)


def build_comparison(view: View) -> blocks.Section:
    """Return the disagreements by their reason, and the table of all methods where the rows have room."""
    found: list[blocks.Block] = [blocks.Paragraph(text) for text in view.content.total.say_cannot_rock()]
    if not view.results:
        return blocks.Section([*found, blocks.Paragraph(_("There are no pieces."))], "run-on")
    summary, groups = find_disagreements(view.run, view.results)
    rows: list[list[blocks.Cell | blocks.Words]] = []
    for one in groups[:MOST_REASONS]:
        left = len(one.rows) - len(one.named)
        further = ngettext("and {n:,} more", "and {n:,} more", left) if left else ""
        named = f"{words.plural(len(one.rows), 'row')}: {', '.join(one.named)} {further}".rstrip()
        rows.append([named, [one.highest, blocks.BREAK, one.lowest], " ".join(one.reasons)])
    heads = blocks.list_columns((_("Rows"), "w20"), (_("Highest and lowest"), "w20"), (_("Why"), ""))
    found += [blocks.Heading(_("Where the methods disagree by more than one class, and why")),
              blocks.Paragraph(summary)]  # fmt: skip
    found += [blocks.table(heads, rows, "disagreements")] if rows else []
    if any(len(one.rows) > len(one.named) for one in groups):
        found.append(blocks.Paragraph(_("The sheet Items of the Excel report has all rows."), "small"))
    if (left := len(groups) - MOST_REASONS) > 0:
        text = ngettext("{n:,} further group is left out.", "{n:,} further groups are left out.", left)
        found.append(blocks.Paragraph(text, "small"))
    found.append(blocks.Heading(_("Results of every method for each row")))
    if view.is_long:
        see = (_("See the appendix, and the sheet Items of the Excel report.") if view.is_compact
               else _("See the sheet Items of the Excel report."))  # fmt: skip
        return blocks.Section([*found, blocks.Paragraph(see)])
    text = _("Under the governing motion of the row: that of the highest adopted class, then of the largest adopted "
             "chance. A larger value under another motion of the row (its other axis, or a parallel record) follows an "
             "arrow. Criteria are met or not met and have no class. A dash: not evaluated, for the reason in the marks "
             "of the method, or not simulated.")  # fmt: skip
    table = build_table(view.columns("methods"), view.content.listed, "items methods")
    return blocks.Section([*found, blocks.Paragraph(text), table], "wide")


def build_lists(view: View) -> blocks.Section:
    """Return one line a row, then the results of every method."""
    texts = [
        _("One line for each row; longer texts are cut, the Excel report has all of them."),
        _("The first {n:,} rows; the Excel report lists all.", n=MOST_LINES) if len(view.results) > MOST_LINES else "",
    ]
    heading = blocks.Heading(_("Results of every method for each row under its governing motion"))
    pieces, methods = (list_lines(view.content.listed, view.columns(name)) for name in ("pieces", "methods"))
    return blocks.Section([blocks.Paragraph(blocks.join_words(texts)), *pieces, heading, *methods], "wide")


def list_lines(results: Sequence[ItemResult], columns: Sequence[PageColumn]) -> list[blocks.Listing]:
    """Return a line a row, with those of the columns of a table that have a place in it, and the class at its end."""
    shown = [one for one in columns if one.places]
    head = "  ".join([*(_put(one, one.line_heading or one.heading) for one in shown), _("Class")])
    lines: list[blocks.Words] = []
    for one in results[:MOST_LINES]:
        text = "  ".join(_put(column, (column.line or column.text)(one)) for column in shown)
        label = words.class_span(one)
        if one.is_anchored:
            lines.append(f"{text}  {words.apart_label('anchored')} ({label})")
        elif one.apart:
            lines.append(f"{text}  {label} ({words.apart_note(one)})")
        else:
            lines.append([f"{text}  ", blocks.Span(label, f"badge {words.style_name(one)}")])
    a_page = 58
    return [blocks.Listing(head, lines[at : at + a_page]) for at in range(0, len(lines), a_page)]


def _put(column: PageColumn, text: str) -> str:
    """Return a text that takes the places of a column in a font of equal widths, cut where it is longer."""
    text, width = " ".join(text.split()), column.places
    taken = sum(map(_places, text))
    if taken > width:
        kept, left = "", width - 1
        for character in text:
            left -= _places(character)
            if left < 0:
                break
            kept += character
        text, taken = kept + "…", sum(map(_places, kept)) + 1
    blank = " " * (width - taken)
    return blank + text if column.is_number or column.is_method else text + blank


def _places(character: str) -> int:
    """Return how many places a character takes: none if it stands above another one, two if it is a wide one."""
    if unicodedata.combining(character):
        return 0
    return 2 if unicodedata.east_asian_width(character) in "WF" else 1


PARTS = (
    Part(key="items", heading=fill("All pieces"), places={"annex": 110, "all": 50}, build=build_items),
    Part(key="comparison", heading=fill("Comparison of the methods"), places={"annex": 120, "all": 90},
         build=build_comparison),
    Part(key="lists", heading=fill("Appendix: all pieces"), places={"annex": 130, "all": 190}, build=build_lists,
         is_shown=lambda view: view.is_compact),
)  # fmt: skip
