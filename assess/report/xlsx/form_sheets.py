"""Forms that people know, filled in from the results: FEMA E-74's inventory, and the Tokyo Fire Department's checklist.

References
----------
FEMA (2012). Reducing the Risks of Nonstructural Earthquake Damage, E-74, appendices C (inventory form) and E (ratings).
Tokyo Fire Department. Handbook on measures against the overturning, falling and moving of furniture: checklist of 21
items for offices, as reprinted at jecom.jp/annzen/selfcheck.html. Items are given here in our own words.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from assess.details import DETAILS
from assess.i18n import LANGUAGES, Text, fill, gettext as _, load_catalogue
from assess.report import measures, words
from assess.report.content import Content
from assess.report.say import work as say_work
from assess.report.say.orders import list_lines
from assess.report.xlsx.pen import COUNT, Column, Pen
from assess.results import ROLLS, ItemResult, ItemRow, count_pieces
from assess.risk import RiskClass
from assess.text import natural_key
from assess.workbook.names import key

TALL = 150.0
"""Height [cm] from which a piece counts as tall, assumed: the checklist gives none."""
CONCERNS = {"LS": "life safety", "PL": "property", "FL": "function"}
"""FEMA E-74's ratings by the word of Importance that names each."""
E74_RULE = fill(
    "LS (life safety), PL (property loss) and FL (functional loss) are derived, not judged on the spot: H where the "
    "upper class is high or very high, M where it is medium, L where it is low; one step lower where Importance does "
    "not name that concern, a piece on an evacuation route or without Importance being one of life safety; L where it "
    "is anchored, – where it rolls. Priority 1: LS is H; 2: PL or FL is H; 3: one of them is M; 4: none is. NE, PR, "
    "ER: who may fix it, anyone, by a standard detail, or after an engineer's design; – where nothing is to be fixed. "
    "Form: FEMA E-74, appendix C."
)


def rate(one: ItemResult) -> dict[str, str]:
    """Return the ratings of a piece, which `E74_RULE` derives; a dash of one that rolls."""
    if one.apart == ROLLS:
        return dict.fromkeys(CONCERNS, words.DASH)
    level = 0 if one.is_anchored else min(max(one.adopted.risk, one.adopted.upper), RiskClass.HIGH)
    is_life = bool(one.routes) or not one.item.importance
    named = {name for name, word in CONCERNS.items() if word == one.item.importance or (name == "LS" and is_life)}
    return {name: "LMH"[level if name in named else max(level - 1, 0)] for name in CONCERNS}


def find_priority(ratings: Mapping[str, str]) -> int:
    """Return 1 to 4, by `E74_RULE`."""
    return 1 if ratings["LS"] == "H" else 2 if "H" in ratings.values() else 3 if "M" in ratings.values() else 4


def write_e74(pen: Pen, page: Any, content: Content) -> None:
    """Write the inventory form, a line for alike pieces, the most urgent first."""
    details = {at: line.work.row.detail for line in list_lines(content) for at in line.work.row.item_indices}
    groups: dict[tuple[Any, ...], list[ItemResult]] = {}
    for one in content.listed:
        item = one.item
        alike = (find_priority(rate(one)), item.floor, item.room, item.description or item.type, words.size(one),
                 one.is_anchored, one.apart, details.get(item.index, ""), *rate(one).values())  # fmt: skip
        groups.setdefault(alike, []).append(one)
    rows = [own for _alike, own in sorted(groups.items(), key=lambda pair: pair[0][0])]

    def say_item(own: Sequence[ItemResult]) -> str:
        names = say_work.join_names(say_work.shorten_names(one.item.item for one in own))
        return ": ".join(filter(None, (own[0].item.description or own[0].item.type, names)))

    def say_who(own: Sequence[ItemResult]) -> str:
        return DETAILS[details[own[0].item.index]].who if own[0].item.index in details else words.DASH

    columns = [
        Column(_("Priority"), 8, lambda own: find_priority(rate(own[0])), align="center"),
        Column(_("Item"), 44, say_item),
        Column(_("Location"), 28, lambda own: ", ".join(filter(None, (own[0].item.floor, own[0].item.room)))),
        Column(_("Quantity"), 9, count_pieces, COUNT),
        *(Column(label, 6, partial(lambda name, own: rate(own[0])[name], name))
          for name, label in zip(CONCERNS, (_("LS"), _("PL"), _("FL")), strict=True)),
        Column(_("NE / PR / ER"), 9, say_who),
        Column(_("Notes (photo)"), 40, _say_notes),
    ]  # fmt: skip
    _write_form(pen, page, _(E74_RULE), columns, rows)


def _say_notes(own: Sequence[ItemResult]) -> str:
    first = own[0]
    texts = [_("check anchor")] if first.is_anchored else []
    texts += [_(words.BASES[first.apart])] if first.apart in (ROLLS, "unconfirmed") else []
    photos = dict.fromkeys(str(one.item.field("photo")) for one in own if one.item.field("photo"))
    return "; ".join((*texts, *([_("photo {names}", names=", ".join(photos))] if photos else [])))


def _write_form(pen: Pen, page: Any, rule: str, columns: Sequence[Column], rows: Sequence[Any]) -> None:
    """Write a table, and below it the rule that it goes by."""
    below = pen.listing(page, columns, rows) + 1
    pen.paragraph(page, below, rule, [one.width for one in columns])


# ---------------------------------------------------------------- the checklist of 21 items

Answer = tuple[str, Sequence[str]]
"""``yes``, ``no`` or "" for not known, and the pieces that say so."""
NOT_KNOWN: Answer = "", ()


def _held(content: Content, which: Callable[[ItemRow], Any], *, tells_all: bool = True) -> Answer:
    """Return no if one of some pieces is loose, yes if all are held and that `tells_all`; else it is not known."""
    own = [one for one in content.results if which(one.item)]
    loose = [one.item.item for one in own if one.item.anchored in ("no", "partly") and not one.is_anchored]
    if loose or not (own and tells_all):
        return ("no", loose) if loose else NOT_KNOWN
    return ("yes", ()) if all(one.is_anchored for one in own) else NOT_KNOWN


def _is_type(item: ItemRow, name: str) -> bool:
    return key(item.type) in {key(load_catalogue(code).find(name)) for code in LANGUAGES}


def _in_the_way(content: Content, *, falls: bool) -> Answer:
    """Return whether pieces stand in a segment of a route, or may fall into one."""
    near = [one for segment in content.run.route_tables.segments if segment.evaluated for one in segment.pieces]
    if not any(segment.evaluated for segment in content.run.route_tables.segments):
        return NOT_KNOWN
    found = set()
    for one in near:
        piece = content.results[one.item_index]
        risky = not piece.is_anchored and not piece.apart and piece.adopted.risk >= RiskClass.MEDIUM
        found |= {one.item} if (risky if falls else one.distance_m < 0) else set()
    return ("no", sorted(found, key=natural_key)) if found else ("yes", ())


def _top_heavy(content: Content) -> Answer:
    heavy = [one.item.item for one in content.results if one.item.centre_of_gravity > 0.5]
    return ("no", heavy) if heavy else NOT_KNOWN


TOKYO: Mapping[Text, Callable[[Content], Answer] | None] = {
    fill("No tall piece stands by itself."): lambda content: _held(content, lambda one: one.height_cm >= TALL),
    fill("Unstable pieces are joined back to back."): None,
    fill("Storage along walls is fixed to the wall or the floor."): lambda content: _held(
        content, lambda one: one.against_wall),
    fill("Of pieces of two parts the upper is joined to the lower."): None,
    fill("Low partitions stand in a U or an H and are fixed to the floor."): lambda content: _held(
        content, lambda one: _is_type(one, "Partition screen"), tells_all=False),
    fill("Office machines cannot fall from where they stand."): None,
    fill("Drawers and doors cannot open by themselves."): None,
    fill("Clocks, frames and notice boards cannot come down."): None,
    fill("Glass has a film that holds its splinters."): None,
    fill("Nothing on the floor makes people stumble."): None,
    fill("Nothing is left in the ways out."): partial(_in_the_way, falls=False),
    fill("Nothing along the ways out is likely to overturn."): partial(_in_the_way, falls=True),
    fill("Emergency exits are easy to see."): None,
    fill("Openings for the fire brigade are free."): None,
    fill("Nothing stands on top of furniture."): None,
    fill("What pieces hold does not stick out or make them top-heavy."): _top_heavy,
    fill("Nothing dangerous is stored, such as chemicals or what burns."): None,
    fill("Nothing is kept under desks."): None,
    fill("Drawers and doors are kept shut."): None,
    fill("Nothing that may overturn stands in front of windows."): None,
    fill("Copiers are held against overturning and moving."): lambda content: _held(
        content, lambda one: _is_type(one, "Photocopier")),
}  # fmt: skip
"""The items in our own words, each with what the workbook tells of it; None: nothing."""


def write_tokyo(pen: Pen, page: Any, content: Content) -> None:
    """Write the checklist, answered where the workbook can tell."""
    answers = [answer(content) if answer else NOT_KNOWN for answer in TOKYO.values()]
    columns = [
        Column(_("No."), 5, lambda row: row[0], align="center"),
        Column(_("Item"), 60, lambda row: _(row[1])),
        Column(_("Answer"), 16, lambda row: _(row[2][0]) if row[2][0] else _("not known: look")),
        Column(_("Rows"), 60, lambda row: words.name_pieces(row[2][1], 30)),
        Column(_("Seen by, date"), 24, lambda _row: ""),
    ]
    rule = _("The items are those of the Tokyo Fire Department's checklist for offices, in our own words; they are "
             "answered from the workbook where that can tell. yes: as it should be, as far as the workbook lists the "
             "furniture; no: see the rows; not known: look. Tall: from {tall}, assumed.",
             tall=measures.say(TALL, "cm"))  # fmt: skip
    _write_form(pen, page, rule, columns, list(zip(range(1, len(TOKYO) + 1), TOKYO, answers, strict=True)))
