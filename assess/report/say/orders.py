"""Work orders: the lines of each room that are to be done, what they take, and the stickers of their pieces."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby, repeat
from typing import NamedTuple

from assess.details import CHECK, DETAILS
from assess.i18n import fill, gettext as _, number
from assess.report import measures, words
from assess.report.content import Content
from assess.report.say import work as say_work
from assess.results import ItemResult

PHASES = {
    "A": fill("A: now"), "B": fill("B: with the next works"), "C": fill("C: not worth it on its own, listed only"),
    "": fill("Anchors to check, and what rolls"),
}  # fmt: skip
"""The phases as they are called; pieces that are anchored, or roll, have none: they are looked at, or parked."""
SHORT = 30
"""Characters of the building's name on a sticker."""


@dataclass(frozen=True, slots=True)
class Line:
    """One line of a work order; `number` is that of its entry, with a letter where the entry has several lines."""

    number: str
    phase: str
    work: say_work.Work

    @property
    def title(self) -> str:
        """How its pieces are fixed, or are checked."""
        return _(DETAILS[self.work.row.detail].title)

    @property
    def how(self) -> str:
        """The same, and what an anchor that is checked or completed should be, and have."""
        row = self.work.row
        if row.like == row.detail or not row.fixings:
            return self.title
        return _("{how} ({like}: at least {n} each)", how=self.title, like=_(DETAILS[row.like].title), n=row.fixings)

    @property
    def when(self) -> str:
        """Its phase in short."""
        return self.phase or _("to check")

    def count_fixings(self, *, in_all: bool = False) -> int:
        """Return the fixings that one piece, or all, need; none of an anchor that is only checked."""
        row = self.work.row
        return 0 if row.detail == CHECK else row.all_fixings if in_all else row.fixings

    def say_fixings(self, *, in_all: bool = False) -> str:
        """Return the fixings of one piece, or of all, with a mark where they are the least; a dash for none."""
        return mark_fixings(self.count_fixings(in_all=in_all), is_least=self.work.row.is_least)

    def say_pull(self) -> str:
        """Return what one fixing carries, in the reader's units; "none" where the weight of the piece does."""
        pull = self.work.row.pull_kn
        if pull == 0:
            return _("none")
        if pull is None:
            return words.DASH
        said = f"{say_work.say_force(pull)}{words.NO_BREAK}{measures.unit('kN')}"
        return f"{said} ({self.work.marks})" if self.work.marks else said

    def say_effect(self, total: float) -> str:
        """Return what its entry takes away of all expected falls, `total`; "" of all its lines but the first."""
        entry = self.work.entry.row
        if self.work.results[0].apart == "rolls":
            return _("rolls: its chance is not known")
        if not self.work.is_first or not (entry.falls_avoided or entry.falls_at_most):
            return ""
        if entry.falls_avoided:
            return _("takes {n} of {total} expected falls away", n=_few(entry.falls_avoided),
                     total=number(total, ",.1f"))  # fmt: skip
        falls = _few(entry.falls_at_most)
        if self.work.row.detail == CHECK:
            return _("its anchors are trusted to avoid {n} falls", n=falls)
        return _("would avoid at most {n} falls", n=falls)


def _few(falls: float) -> str:
    return number(falls, ",.1f") if falls >= 0.05 else f"< {words.fixed(0.1, 1)}"


def mark_fixings(fixings: int, *, is_least: bool) -> str:
    """Return a number of fixings, with a mark where it is the least; a dash for none."""
    return f"{number(fixings, ',d')}{say_work.LEAST if is_least else ''}" if fixings else words.DASH


class RoomOrder(NamedTuple):
    """The lines of one room; `title` names floor and room, `pieces` is how many are worked on."""

    floor: str
    room: str
    title: str
    lines: Sequence[Line]
    pieces: int


class Sticker(NamedTuple):
    """A sticker of one piece; `text` is what its QR code says: no address, as it must do without a network."""

    result: ItemResult
    room: str
    detail: str
    text: str


def list_lines(content: Content) -> list[Line]:
    """Return every line of the list of what to fix and to check, by floor and room, and there by phase and number."""
    schedule, rows = content.run.schedule, content.results
    checks = [say_work.Entry(one, [rows[at] for at in one.item_indices], (), None) for one in schedule.checks]
    checked = {one.place for one in schedule.checks}
    lines = []
    for work in say_work.list_work([*content.fixes, *checks], [one.floor.floor for one in content.floors]):
        entry = work.entry.row
        letter = chr(ord("a") + entry.works.index(work.row) % 26) if len(entry.works) > 1 else ""
        lines.append(Line(f"{entry.place}{letter}", "" if entry.place in checked else entry.phase, work))
    return lines


def say_phases(lines: Iterable[Line]) -> list[str]:
    """Return what the phases of some lines mean, a sentence each."""
    used = {one.phase for one in lines}
    return [f"{_(text)}." for phase, text in PHASES.items() if phase in used and phase]


def list_orders(content: Content) -> list[RoomOrder]:
    """Return the rooms in which something is to be done: now, with the next works, or to be checked."""
    titles, nowhere, found = {one.floor.floor: one.title for one in content.floors}, _("no room given"), []
    ordered = (one for one in list_lines(content) if one.phase != "C")
    for (floor, room), own in groupby(ordered, key=lambda one: (one.work.row.floor, one.work.row.room)):
        lines, title = tuple(own), f"{titles[floor]}: {words.cut(room, 60) or nowhere}"
        found.append(RoomOrder(floor, room, title, lines, sum(one.work.row.pieces for one in lines)))
    return found


def list_stickers(orders: Iterable[RoomOrder], title: str) -> Iterator[Sticker]:
    """Yield a sticker for each piece of some rooms; `title` is that of the building."""
    building = words.cut(title, SHORT)
    for order, line in ((each, line) for each in orders for line in each.lines):
        for one in line.work.results:
            parts = (one.item.item, order.room, line.title, building)
            text = " | ".join(" ".join(part.split()) for part in parts if part)
            yield from repeat(Sticker(one, order.room, line.title, text), one.item.quantity)


def list_material(lines: Iterable[Line]) -> list[tuple[str, int, str]]:
    """Return details by their key, with the pieces that they hold, and their fixings in all."""
    pieces, fixings, least = Counter[str](), Counter[str](), set[str]()
    for one in lines:
        pieces[one.work.row.detail] += one.work.row.pieces
        fixings[one.work.row.detail] += one.count_fixings(in_all=True)
        least |= {one.work.row.detail} if one.work.row.is_least else set()
    return [(key, pieces[key], mark_fixings(fixings[key], is_least=key in least)) for key in DETAILS if key in pieces]
