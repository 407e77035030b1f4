"""Forms that people know, filled in from the results: FEMA E-74's inventory, and the Tokyo Fire Department's checklist.

References
----------
FEMA (2012). Reducing the Risks of Nonstructural Earthquake Damage, E-74, appendices C (inventory form) and E (ratings).
Tokyo Fire Department. Handbook on measures against the overturning, falling and moving of furniture: checklist of 21
items for offices, as reprinted at jecom.jp/annzen/selfcheck.html. Items are given here in our own words.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

from assess.details import DETAILS
from assess.i18n import LANGUAGES, Text, fill, gettext as _, load_catalogue
from assess.report import words
from assess.report.content import Content
from assess.report.say import work as say_work
from assess.report.say.orders import list_lines
from assess.report.xlsx.pen import COUNT, LINE, Column, Pen, count_lines
from assess.results import ItemResult, count_pieces
from assess.risk import RiskClass
from assess.text import natural_key
from assess.workbook.names import key

TALL = 150.0
"""Height [cm] from which a piece counts as tall, assumed: the checklist gives none."""
RATINGS = ("L", "M", "H")
_CONCERNS = {"life safety": fill("LS"), "property": fill("PL"), "function": fill("FL")}
E74_RULE = fill(
    "LS (life safety), PL (property loss) and FL (functional loss) are derived, not judged on the spot: H where the "
    "upper class is high or very high, M where it is medium, L where it is low; one step lower where Importance does "
    "not name that concern, a piece on an evacuation route being one of life safety. Priority 1: LS is H; 2: PL or FL "
    "is H; 3: one of them is M; 4: all are L. NE, PR, ER: who may fix it, anyone, by a standard detail, or after an "
    "engineer's design; – where nothing is to be fixed. Form: FEMA E-74, appendix C."
)


def rate(one: ItemResult) -> dict[str, str]:
    """Return the ratings of a piece by FEMA E-74's concerns, which `E74_RULE` derives; "" of one that rolls."""
    if one.apart == "rolls":
        return dict.fromkeys(_CONCERNS.values(), "")
    level = 0 if one.is_anchored else min(max(one.adopted.risk, one.adopted.upper), RiskClass.HIGH)
    named = {_CONCERNS.get(one.item.importance, ""), "LS" if one.routes else ""}
    return {name: RATINGS[level if name in named else max(level - 1, 0)] for name in _CONCERNS.values()}


def find_priority(ratings: Mapping[str, str]) -> int:
    """Return 1 to 4, by `E74_RULE`."""
    return 1 if ratings["LS"] == "H" else 2 if "H" in ratings.values() else 3 if "M" in ratings.values() else 4


class _Alike(NamedTuple):
    """Alike pieces of a room, a line of the form."""

    results: Sequence[ItemResult]
    ratings: Mapping[str, str]
    detail: str

    @property
    def notes(self) -> str:
        first = self.results[0]
        texts = [_("check anchor")] if first.is_anchored else []
        texts += [_("rolls: not covered")] if first.apart == "rolls" else []
        texts += [_("unconfirmed")] if first.apart == "unconfirmed" else []
        photos = dict.fromkeys(str(one.item.field("photo")) for one in self.results if one.item.field("photo"))
        return "; ".join((*texts, *([_("photo {names}", names=", ".join(photos))] if photos else [])))


def _say_rating(name: str, row: _Alike) -> str:
    return row.ratings[name] or words.DASH


def write_e74(pen: Pen, page: Any, content: Content) -> None:
    """Write the inventory form, a line for alike pieces, the most urgent first."""
    details = {
        at: line.work.row.detail for line in list_lines(content) for at in line.work.row.item_indices
    }  # fmt: skip
    groups: dict[tuple[Any, ...], list[ItemResult]] = {}
    for one in content.listed:
        item = one.item
        alike = (item.floor, item.room, item.description or item.type, words.size(one), one.is_anchored, one.apart,
                 details.get(item.index, ""), *rate(one).values())  # fmt: skip
        groups.setdefault(alike, []).append(one)
    rows = [_Alike(own, rate(own[0]), details.get(own[0].item.index, "")) for own in groups.values()]
    rows.sort(key=lambda row: find_priority(row.ratings))
    columns = [
        Column(_("Priority"), 8, lambda row: find_priority(row.ratings), align="center"),
        Column(_("Item"), 44, lambda row: ": ".join(filter(None, (
            row.results[0].item.description or row.results[0].item.type,
            say_work.join_names(say_work.shorten_names(one.item.item for one in row.results)))))),
        Column(_("Location"), 28, lambda row: ", ".join(filter(None, (row.results[0].item.floor,
                                                                      row.results[0].item.room)))),
        Column(_("Quantity"), 9, lambda row: count_pieces(row.results), COUNT),
        *(Column(_(name), 6, partial(_say_rating, name)) for name in _CONCERNS.values()),
        Column(_("NE / PR / ER"), 9, lambda row: DETAILS[row.detail].who if row.detail else words.DASH),
        Column(_("Notes (photo)"), 40, lambda row: row.notes),
    ]  # fmt: skip
    _write_form(pen, page, _(E74_RULE), columns, rows)


def _write_form(pen: Pen, page: Any, rule: str, columns: Sequence[Column], rows: Sequence[Any]) -> None:
    """Write a table, and below it the rule that it goes by."""
    below = pen.listing(page, columns, rows) + 1
    page.merge_range(below, 0, below, len(columns) - 1, "", pen.style("text"))
    page.set_row(below, LINE * count_lines(rule, sum(one.width for one in columns)))
    pen.put(page, below, 0, rule, pen.style("text"))


# ---------------------------------------------------------------- the checklist of 21 items

Answer = tuple[str, Sequence[str]]
"""``yes``, ``no`` or "" for not known, and the pieces that say so."""


def _held(pieces: Iterable[ItemResult], *, at_all: bool = True) -> Answer:
    """Return yes if all of some pieces are held, no if one is not; not known where there is none, or none is told."""
    own = list(pieces)
    loose = [one.item.item for one in own if one.item.anchored in ("no", "partly") and not one.is_anchored]
    if loose:
        return "no", loose
    return ("yes", ()) if own and at_all and all(one.is_anchored for one in own) else ("", ())


def _is_type(one: ItemResult, name: str) -> bool:
    return key(one.item.type) in {key(load_catalogue(code).find(name)) for code in LANGUAGES}


def _in_the_way(content: Content, *, falls: bool) -> Answer:
    """Return whether pieces stand in a segment of a route, or may fall into one."""
    routes, rows = content.run.route_tables, content.results
    near = [one for segment in routes.segments if segment.evaluated for one in segment.pieces]
    if not any(segment.evaluated for segment in routes.segments):
        return "", ()
    found = {
        one.item for one in near
        if (not rows[one.item_index].is_anchored and rows[one.item_index].adopted.risk >= RiskClass.MEDIUM
            if falls else one.distance_m < 0)
    }  # fmt: skip
    return ("no", sorted(found, key=natural_key)) if found else ("yes", ())


def _unknown(_content: Content) -> Answer:
    return "", ()


TOKYO: Sequence[tuple[Text, Callable[[Content], Answer]]] = (
    (fill("No tall piece stands by itself."), lambda content: _held(
        one for one in content.results if one.item.height_cm >= TALL)),
    (fill("Unstable pieces are joined back to back."), _unknown),
    (fill("Storage along walls is fixed to the wall or the floor."), lambda content: _held(
        one for one in content.results if one.item.against_wall)),
    (fill("Of pieces of two parts the upper is joined to the lower."), _unknown),
    (fill("Low partitions stand in a U or an H and are fixed to the floor."), lambda content: _held(
        (one for one in content.results if _is_type(one, "Partition screen")), at_all=False)),
    (fill("Office machines cannot fall from where they stand."), _unknown),
    (fill("Drawers and doors cannot open by themselves."), _unknown),
    (fill("Clocks, frames and notice boards cannot come down."), _unknown),
    (fill("Glass has a film that holds its splinters."), _unknown),
    (fill("Nothing on the floor makes people stumble."), _unknown),
    (fill("Nothing is left in the ways out."), lambda content: _in_the_way(content, falls=False)),
    (fill("Nothing along the ways out is likely to overturn."), lambda content: _in_the_way(content, falls=True)),
    (fill("Emergency exits are easy to see."), _unknown),
    (fill("Openings for the fire brigade are free."), _unknown),
    (fill("Nothing stands on top of furniture."), _unknown),
    (fill("What pieces hold does not stick out or make them top-heavy."), lambda content: (
        ("no", heavy) if (heavy := [one.item.item for one in content.results if one.item.centre_of_gravity > 0.5])
        else ("", ()))),
    (fill("Nothing dangerous is stored, such as chemicals or what burns."), _unknown),
    (fill("Nothing is kept under desks."), _unknown),
    (fill("Drawers and doors are kept shut."), _unknown),
    (fill("Nothing that may overturn stands in front of windows."), _unknown),
    (fill("Copiers are held against overturning and moving."), lambda content: _held(
        one for one in content.results if _is_type(one, "Photocopier"))),
)  # fmt: skip
"""The items in our own words, each with what the workbook tells of it."""


def write_tokyo(pen: Pen, page: Any, content: Content) -> None:
    """Write the checklist, answered where the workbook can tell."""
    rows = [(at, _(text), *answer(content)) for at, (text, answer) in enumerate(TOKYO, 1)]
    columns = [
        Column(_("No."), 5, lambda row: row[0], align="center"),
        Column(_("Item"), 60, lambda row: row[1]),
        Column(_("Answer"), 16, lambda row: _(row[2]) if row[2] else _("not known: look")),
        Column(_("Rows"), 60, lambda row: words.name_pieces(row[3], 30)),
        Column(_("Seen by, date"), 24, lambda _row: ""),
    ]  # fmt: skip
    rule = _("The items are those of the Tokyo Fire Department's checklist for offices, in our own words; they are "
             "answered from the workbook where that can tell. yes: as it should be, as far as the workbook lists the "
             "furniture; no: see the rows; not known: look. Tall: from {tall:g} cm, assumed.", tall=TALL)  # fmt: skip
    _write_form(pen, page, rule, columns, rows)
