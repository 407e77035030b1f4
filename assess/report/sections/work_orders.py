"""Work orders: what to bring, a page a room with its plan, its lines and how each is done, and stickers."""

from collections.abc import Sequence
from itertools import islice

from assess.details import DETAILS, WHO
from assess.i18n import fill, gettext as _, ngettext, number
from assess.report import blocks, measures, words
from assess.report.figures.codes import draw_code
from assess.report.figures.plan import crop_plan
from assess.report.say import orders as say, work as say_work
from assess.report.say.orders import RoomOrder, Sticker
from assess.report.templates import open_template
from assess.report.view import Part, View

MOST_ROOMS, MOST_STICKERS = 400, 2400
"""Rooms and stickers that are printed; the Excel report lists every line."""
A_SHEET = 24
"""Stickers of a sheet: 3 x 8 labels of 63.5 x 33.9 mm on A4, a size that is sold."""
BOX = "☐"
WALLS = {"studs": fill("In studs"), "concrete": fill("In concrete"), "masonry": fill("In masonry")}


def build(view: View) -> list[blocks.Section]:
    """Return an overview, and a page of each room."""
    orders = say.list_orders(view.content)
    if not orders:
        return [blocks.Section([blocks.Paragraph(_("There is nothing to do: no piece is to be fixed or checked."))])]
    shown = orders[:MOST_ROOMS]
    rooms = [_build_room(view, one, at) for at, one in enumerate(view.progress.checked(shown), 1)]
    return [_build_overview(view, orders, len(shown)), *rooms]


def _build_overview(view: View, orders: Sequence[RoomOrder], shown: int) -> blocks.Section:
    lines = [line for one in orders for line in one.lines]
    heads = blocks.list_columns((_("How"), ""), (_("Who may do it"), "w30"), (_("Pieces"), "w12", "num"),
                                (_("Fixings in all"), "w15", "num"))  # fmt: skip
    material = [
        (blocks.head(_(DETAILS[key].title)), _(WHO[DETAILS[key].who]), number(pieces, ",d"), fixings)
        for key, pieces, fixings in say.list_material(lines)
    ]  # fmt: skip
    rooms = [
        (blocks.head(blocks.Span(one.title, "leads", f"#work-{at}") if at <= shown else one.title),
         ", ".join(sorted({line.when for line in one.lines})), number(len(one.lines), ",d"),
         number(one.pieces, ",d"), BOX)
        for at, one in enumerate(orders, 1)
    ]  # fmt: skip
    marks = say_work.list_marks(view.run.schedule)
    none = _("Pull of one, none: {why}.", why=_(say_work.HOLDS))
    of_rooms = blocks.list_columns((_("Room, and its page"), ""), (_("Phase"), "w10"), (_("Lines"), "w10", "num"),
                                   (_("Pieces"), "w10", "num"), (_("Done"), "w8"))  # fmt: skip
    stickers = sum(len(list(say.list_stickers([one], ""))) for one in orders)
    cut = _("Stickers: the first {most:,} of {n:,} are printed.", most=MOST_STICKERS, n=stickers)
    cut = cut if stickers > MOST_STICKERS else ""
    more = ngettext("{n:,} more room is in the Excel report.", "{n:,} more rooms are in the Excel report.",
                    len(orders) - shown) if len(orders) > shown else ""  # fmt: skip
    return blocks.Section([
        blocks.Paragraph(_("Each room has a page of its own: take it there, tick each line, and sign at the foot. The "
                           "numbers are those of the list of what to fix in the report, and stand on the plan of the "
                           "room. Put a sticker on each piece that is done."), "lead"),
        blocks.Heading(_("What to bring")),
        blocks.table(heads, material, "material"),
        blocks.Paragraph(blocks.join_words((_(say_work.CHECKS), *marks, none)), "small"),
        blocks.Heading(_("Rooms")),
        blocks.table(of_rooms, rooms, "rooms-of-work", is_named=True),
        blocks.Paragraph(blocks.join_words((*say.say_phases(lines), more, cut)), "small"),
    ])  # fmt: skip


def _build_room(view: View, order: RoomOrder, at: int) -> blocks.Section:
    found: list[blocks.Block] = []
    numbers = {one.item.index + 1: line.number for line in order.lines for one in line.work.results}
    plan = view.plans.get(order.floor)
    crop = crop_plan(plan, view.run, order.room, numbers, f"work-plan-{at}") if plan else None
    if crop:
        text = open_template("plan.svg.j2", view.options).render(plan=crop, for_print=True)
        found.append(blocks.Figure(blocks.Image(text[text.index("<svg") :].rstrip()), kind="plan"))
    found.append(_list_lines(view, order))
    used = {key for line in order.lines for key in (line.work.row.detail, line.work.row.like)}
    found.append(blocks.Box([_show_detail(view, key) for key in DETAILS if key in used], "details"))
    heads = blocks.list_columns((_("Signed off"), "w20"), (_("Name"), ""), (_("Signature"), "w30"), (_("Date"), "w18"))
    signs = [(blocks.head(role), "", "", "") for role in (_("Done by"), _("Checked by"))]
    found.append(blocks.table(heads, signs, "signing"))
    return blocks.Section(found, "room-order", f"work-{at}", order.title)


def _list_lines(view: View, order: RoomOrder) -> blocks.Table:
    columns = blocks.list_columns(
        (_("No."), "number"), (_("Pieces"), ""), (_("How, and who may do it"), "how"),
        (_("Fixings each"), "few", "num"), (_("in all"), "few", "num"),
        (_("Pull of one"), "pull", "num"), (_("Phase"), "few"), (_("Done"), "tick"),
        (_("Initials"), "initials"), (_("Date"), "initials"),
    )  # fmt: skip
    rows: list[blocks.Row] = []
    for line in order.lines:
        work = line.work
        count = words.plural(work.row.pieces, "piece")
        pieces: blocks.Runs = [blocks.strong(work.names), f": {words.cut(work.described, 60)}, {count}"]
        if photo := view.photos.first_photo(work.results):
            pieces.append(blocks.Image(photo[1], _("Photo of {piece}", piece=photo[0]), "photo"))
        who = blocks.note(f"({_(WHO[DETAILS[work.row.detail].who])})")
        rows.append(blocks.Row([
            blocks.Cell(blocks.strong(line.number)), pieces, [f"{line.how} ", who], line.say_fixings(),
            line.say_fixings(in_all=True), line.say_pull(), line.when, blocks.Span(BOX, "tick"), "", "",
        ]))  # fmt: skip
    sums = "; ".join(
        f"{_(DETAILS[key].title)}: {fixings}" for key, _pieces, fixings in say.list_material(order.lines)
        if fixings != words.DASH
    )  # fmt: skip
    total: list[blocks.Cell | blocks.Words] = [
        blocks.head(""), words.plural(order.pieces, "piece"),
        blocks.Cell(_("Fixings in all: {sums}.", sums=sums) if sums else "", columns=8),
    ]  # fmt: skip
    return blocks.table(columns, [*rows, blocks.Row(total, "total")], "orders", is_named=True)


def _show_detail(view: View, key: str) -> blocks.Box:
    detail = DETAILS[key]
    drawn = view.read_drawing(detail)
    drawing = [blocks.Figure(blocks.Image(drawn))] if drawn else []
    fixings: blocks.Block = blocks.Paragraph(_("Fixings: {text}.", text=_(detail.fixing)))
    if detail.is_at_wall:
        us = measures.is_us()
        fixings = blocks.Bullets([f"{_(name)}: {_(detail.say_fixing(wall, us=us))}." for wall, name in WALLS.items()])
    what = blocks.Paragraph([blocks.strong(_(detail.title)), f": {_(detail.say_what(us=measures.is_us()))}."])
    return blocks.Box([*drawing, what, fixings], "detail")


def build_stickers(view: View) -> blocks.Section:
    """Return sheets of stickers, in the order of the pages."""
    orders = say.list_orders(view.content)[:MOST_ROOMS]
    stickers = list(islice(say.list_stickers(orders, view.content.title), MOST_STICKERS))
    drawn = {text: blocks.Figure(blocks.Image(draw_code(text))) for text in dict.fromkeys(one.text for one in stickers)}
    labels = [blocks.Box([drawn[one.text], _say_label(one)], "sticker") for one in stickers]
    sheets = [blocks.Box(labels[at : at + A_SHEET], "sheet") for at in range(0, len(labels), A_SHEET)]
    return blocks.Section(sheets, "stickers")


def _say_label(one: Sticker) -> blocks.Paragraph:
    item = one.result.item
    texts = blocks.strong(words.cut(item.item, 24)), words.cut(one.room or item.floor, 40), words.cut(one.detail, 40)
    return blocks.Paragraph([texts[0], blocks.BREAK, texts[1], blocks.BREAK, texts[2]])


PARTS = (
    Part(key="work", heading=fill("Work orders"), places={"work": 10}, build=build),
    Part(key="stickers", heading=fill("Stickers: labels of 63.5 x 33.9 mm, 24 a sheet of A4, printed at 100 %"),
         places={"work": 20}, build=build_stickers, is_shown=lambda view: bool(say.list_orders(view.content))),
)  # fmt: skip
