"""What a comparison says, once, in the language in use: HTML, PDF, Excel and terminal show it."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from assess.compare import comparison_words as say
from assess.compare.changes import (
    ABSENT,
    BETTER,
    ONE_SIDED,
    SEVERITY,
    WORSE,
    Comparison,
    Direction,
    PieceChange,
    StateChange,
    Total,
    count_states,
    list_states,
)
from assess.compare.past_run import ANCHORED, CLASSES, PastState
from assess.i18n import gettext as _
from assess.i18n import ngettext, number
from assess.report import words

NAMED = 6
"""Items, routes and rooms that a sentence names."""
Sentence = Callable[[int, str], str]
"""Makes a sentence of a number and of names."""


@dataclass(frozen=True, slots=True)
class CountLine:
    """One count or sum of both runs; `tone` is "worse", "better" or "", `style` that of its label."""

    label: str
    total: Total
    is_count: bool
    tone: str
    style: str = ""

    @property
    def texts(self) -> tuple[str, str, str]:
        """Before, after, and the change."""
        sides = [say.say_total(value, self.is_count) for value in (self.total.before, self.total.after)]
        return sides[0], sides[1], say.say_difference(self.total, self.is_count)


@dataclass(frozen=True, slots=True)
class Tile:
    """A number of pieces, with what it counts."""

    label: str
    count: int
    note: str
    tone: str


@dataclass(frozen=True, slots=True)
class MatrixRow:
    """The pieces of one standing before, by their standing after; `tones` say which cells are worse or better."""

    standing: str
    counts: tuple[int, ...]
    tones: tuple[str, ...]
    total: int


@dataclass(frozen=True, slots=True)
class Matrix:
    """Pieces by their standing before (rows) and after (columns)."""

    columns: tuple[str, ...]
    rows: tuple[MatrixRow, ...]
    totals: tuple[int, ...]


class View:
    """A comparison in words."""

    def __init__(self, comparison: Comparison) -> None:
        self.found = comparison
        self.before, self.after = comparison.before, comparison.after
        self.title = words.cut(self.after.name or self.before.name or self.after.workbook, 120)

    # ------------------------------------------------------------ what holds for all

    @property
    def conditions(self) -> str:
        """What sets the runs apart from their workbooks as they are, for every page; "" where nothing does."""
        sides = ((_("BEFORE"), self.before), (_("AFTER"), self.after))
        texts = [f"{name}: {', '.join(found)}" for name, run in sides if (found := say.list_conditions(run))]
        return "; ".join(texts)

    @property
    def footer(self) -> str:
        """What stands at the foot of every page."""
        return _(
            "Chance of overturning in the scenario of each run, not per year. BEFORE {before}, AFTER {after}.",
            before=say.name_basis(self.before.main_basis),
            after=say.name_basis(self.after.main_basis),
        )

    def list_warnings(self) -> list[str]:
        """Return what stands in the way of a comparison."""
        return [text for text in self._list_warnings() if text]

    def _list_warnings(self) -> Iterator[str]:
        found = self.found
        if not found.has_same_code:
            yield _(
                "The two runs were computed by different code of assess: what differs between them may come from the "
                "program, not from the furniture."
            )
        if not found.has_same_basis:
            yield _(
                "The two runs rest on different bases: BEFORE is {before}, AFTER is {after}. Their chances, classes "
                "and sums are shown next to each other, but are neither compared nor added up. Run both in the "
                "same way to compare them.",
                before=say.name_basis(self.before.main_basis),
                after=say.name_basis(self.after.main_basis),
            )
        if found.is_other_building:
            yield _(
                "The two runs name different buildings: {before} and {after}. Pieces are matched by their names alone.",
                before=words.cut(self.before.name, 60),
                after=words.cut(self.after.name, 60),
            )
        if bool(self.before.settings.get("ideal")) != bool(self.after.settings.get("ideal")):
            yield _(
                "One run gives the chance if exactly its motion recurred, the other run includes the uncertainty of "
                "the earthquake and of the pieces: their chances differ for that reason alone."
            )
        if abs(self.before.route_risk - self.after.route_risk) > 1e-9 and (found.routes or found.rooms):
            yield _(
                "The limit on the chance that a route is blocked differs: {before} and {after}. Every state is by "
                "the limit of its own run.",
                before=words.percent(self.before.route_risk),
                after=words.percent(self.after.route_risk),
            )

    # ------------------------------------------------------------ what gets worse

    @property
    def tone(self) -> str:
        """What the first lines are: "worse", "unclear", "better" or "same"."""
        there = {one.direction for one in self.found.pieces}
        there |= {one.direction for one in (*self.found.routes, *self.found.rooms)}
        if there & {*WORSE}:
            return "worse"
        is_joined_alike = {*self.before.unjoined_rooms} == {*self.after.unjoined_rooms}
        if is_joined_alike and not there & {Direction.UNCLEAR, *ONE_SIDED}:
            return "better" if there & {*BETTER} else "same"
        return "unclear"

    @property
    def headline(self) -> str:
        """What changed, in one sentence."""
        if self.found.is_same_file:
            return _("Nothing changed: BEFORE and AFTER are the same results.")
        better = self._count_rows(*BETTER)
        if self.tone == "worse":
            worse = self._count_rows(*WORSE)
            return _("Worse: {worse}. Better: {better}.", worse=worse, better=better or _("nothing"))
        if better:
            first = (
                _("Nothing gets worse.")
                if self.tone == "better"
                else _("Nothing gets worse as far as it can be compared.")
            )
            return " ".join((first, _("Better: {better}.", better=better)))
        if self.tone == "same":
            return _("Nothing changed beyond the sampling interval.")
        return _("Nothing gets worse as far as it can be compared.")

    def _count_rows(self, *directions: Direction) -> str:
        """Return how many pieces, routes and rooms go in some directions: ``3 of 7 pieces, 1 of 2 routes``."""
        found = self.found
        routes, rooms = (sum(one.direction in directions for one in rows) for rows in (found.routes, found.rooms))
        pieces, every = found.count(*directions), found.count(*Direction)
        texts = [
            ngettext("{some:,} of {n:,} piece", "{some:,} of {n:,} pieces", every, some=pieces) if pieces else "",
            ngettext("{some:,} of {n:,} route", "{some:,} of {n:,} routes", len(found.routes), some=routes)
            if routes
            else "",
            ngettext("{some:,} of {n:,} room", "{some:,} of {n:,} rooms", len(found.rooms), some=rooms)
            if rooms
            else "",
        ]
        return ", ".join(filter(None, texts))

    def list_worse(self) -> list[str]:
        """Return what gets worse, a sentence each."""
        texts = [
            self._name_pieces(Direction.WORSE, _say_higher),
            self._name_pieces(Direction.RISES, _say_rises),
            self._name_states([one for one in self.found.routes if one.direction in WORSE], _say_routes),
            self._name_states([one for one in self.found.rooms if one.direction in WORSE], _say_rooms),
        ]
        return [text for text in texts if text]

    def list_others(self) -> list[str]:
        """Return what else is to be known at once: what is in one run alone, cannot be compared, or is not joined."""
        texts = [
            self._name_pieces(Direction.ADDED, _say_added),
            self._name_pieces(Direction.REMOVED, _say_removed),
            self._name_pieces(Direction.UNCLEAR, _say_unclear) if self.found.has_same_basis else "",
            *(
                self._name_states([one for one in rows if one.direction == Direction.UNCLEAR], sentence)
                for rows, sentence in ((self.found.routes, _say_unclear_routes), (self.found.rooms, _say_unclear_rooms))
                if self.found.has_same_basis
            ),
            *self._name_unjoined(),
        ]
        return [text for text in texts if text]

    def _name_unjoined(self) -> list[str]:
        was, now = self.before.unjoined_rooms, self.after.unjoined_rooms
        if was == now:
            return [_say_unjoined_in_both(len(now), _name_rooms(now))] if now else []
        sides = ((_("BEFORE"), was), (_("AFTER"), now))
        return [_say_unjoined(len(rooms), _name_rooms(rooms), name) for name, rooms in sides if rooms]

    def _name_pieces(self, direction: Direction, sentence: Sentence) -> str:
        changes = self.found.list_counted(direction)
        if not changes:
            return ""
        names = words.name_first([_name_row(one, count) for one, count in changes], NAMED)
        text = sentence(sum(count for _, count in changes), names)
        within = 0 if direction in ONE_SIDED else sum(count for one, count in changes if one.is_within)
        return f"{text} {_say_within(within)}" if within else text

    def _name_states(self, changes: Sequence[StateChange], sentence: Sentence) -> str:
        if not changes:
            return ""
        names = words.name_first([_name_move(one) for one in changes], NAMED, "; ")
        return sentence(len(changes), names)

    def list_tiles(self) -> list[Tile]:
        """Return the pieces by where they go."""
        found = self.found
        tiles = [
            Tile(_("worse"), found.count(Direction.WORSE), _("higher class, or no longer anchored"), "worse"),
            Tile(_("higher chance"), found.count(Direction.RISES), _("in the same class"), "worse"),
            Tile(_("better"), found.count(Direction.BETTER), _("lower class, or anchored"), "better"),
            Tile(_("lower chance"), found.count(Direction.FALLS), _("in the same class"), "better"),
            Tile(_("unchanged"), found.count(Direction.SAME), _("or within the sampling interval"), ""),
            Tile(_("not comparable"), found.count(Direction.UNCLEAR), _("chances on different bases"), "unclear"),
            Tile(_("only in AFTER"), found.count(Direction.ADDED), _("new items, or a larger quantity"), "unclear"),
            Tile(
                _("only in BEFORE"),
                found.count(Direction.REMOVED),
                _("items removed, or a smaller quantity"),
                "unclear",
            ),
        ]
        return [one for one in tiles if one.count or one.tone in ("worse", "better")]

    # ------------------------------------------------------------ counts

    def list_counts(self) -> list[CountLine]:
        """Return the pieces by class, those that stand apart, and the expected falls."""
        found = self.found
        is_fair = not found.count(Direction.UNCLEAR, *ONE_SIDED)  # else a count changes for other reasons as well
        lines = [
            _line(
                say.label_standing(one),
                found.count_standing(one),
                is_worse_up=is_fair and one in CLASSES[:2],
                is_worse_down=is_fair and one == CLASSES[-1],
                style=say.style_standing(one),
            )
            for one in found.standings()
        ]
        every = [sum(piece.quantity for piece in run.pieces) for run in (self.before, self.after)]
        lines.append(_line(_("all pieces"), Total(every[0], every[1], is_comparable=True)))
        lines.append(_line(_("expected falls"), found.falls, is_count=False, is_worse_up=is_fair))
        if found.falls_of_both:
            lines.append(
                _line(
                    _("expected falls of the pieces counted in both runs"),
                    found.falls_of_both,
                    is_count=False,
                    is_worse_up=True,
                )
            )
        return lines

    def list_route_counts(self) -> list[CountLine]:
        """Return the routes and rooms by state, the expected numbers blocked or cut off, and the rooms not joined."""
        found, (was, now) = self.found, (self.before, self.after)
        lines = self._count_states(was.routes, now.routes, lambda state: _("routes: {state}", state=state))
        if found.routes:
            blocked = Total(was.blocked_routes, now.blocked_routes, found.has_same_basis)
            lines.append(_line(_("expected blocked routes"), blocked, is_count=False, is_worse_up=True))
        if found.rooms:
            lines += self._count_states(was.rooms, now.rooms, lambda state: _("rooms: {state}", state=state))
            cut_off = Total(was.cut_off_rooms, now.cut_off_rooms, found.has_same_basis)
            lines.append(_line(_("expected rooms that lose every exit"), cut_off, is_count=False, is_worse_up=True))
        for label, before, after in (
            (_("left out of these averages: routes not known"), was.unknown_routes, now.unknown_routes),
            (_("left out of these averages: rooms not known"), was.unknown_rooms, now.unknown_rooms),
        ):
            lines += [_line(label, Total(before, after, is_comparable=True))] if before or after else []
        if was.unjoined_rooms or now.unjoined_rooms:
            unjoined = Total(len(was.unjoined_rooms), len(now.unjoined_rooms), is_comparable=True)
            lines.append(_line(_("rooms joined to no exit or stair"), unjoined))
        return lines

    def _count_states(
        self, before: Sequence[PastState], after: Sequence[PastState], label: Callable[[str], str]
    ) -> list[CountLine]:
        was, now = count_states(before), count_states(after)
        return [
            _line(
                label(say.name_state(one)),
                Total(was[one], now[one], self.found.has_same_basis),
                is_worse_up=SEVERITY.get(one, 0) > 0,
                is_worse_down=one == "open",
            )
            for one in list_states(before, after)
        ]

    def build_matrix(self) -> Matrix:
        """Return the pieces by standing before and after; those of one run alone have a row and column of their own."""
        found, moves = self.found, self.found.moves
        standings = found.standings()
        rows = [*standings, ABSENT] if any(was == ABSENT for was, _now in moves) else standings
        columns = [*standings, ABSENT] if any(now == ABSENT for _was, now in moves) else standings
        return Matrix(
            tuple(columns),
            tuple(
                MatrixRow(
                    was,
                    tuple(moves.get((was, now), 0) for now in columns),
                    tuple(self._tone_of(was, now) for now in columns),
                    sum(moves.get((was, now), 0) for now in columns),
                )
                for was in rows
            ),
            tuple(sum(moves.get((was, now), 0) for was in rows) for now in columns),
        )

    def _tone_of(self, was: str, now: str) -> str:
        if was == now:
            return "same"
        if ANCHORED in (was, now) and ABSENT not in (was, now):
            return "worse" if was == ANCHORED else "better"
        if not self.found.has_same_basis or not {was, now} <= {*CLASSES}:
            return ""
        return "worse" if CLASSES.index(now) < CLASSES.index(was) else "better"

    # ------------------------------------------------------------ rows

    def list_changed(self) -> list[PieceChange]:
        """Return the pieces that changed, or of which an input did."""
        return [one for one in self.found.pieces if one.direction != Direction.SAME or one.inputs]

    def list_changed_routes(self) -> list[StateChange]:
        """Return the routes that changed."""
        return [one for one in self.found.routes if one.direction != Direction.SAME]

    def list_changed_rooms(self) -> list[StateChange]:
        """Return the rooms that changed."""
        return [one for one in self.found.rooms if one.direction != Direction.SAME]


# ---------------------------------------------------------------- sentences


def _say_higher(n: int, names: str) -> str:
    return ngettext(
        "{n:,} piece goes to a higher class or is no longer anchored: {names}.",
        "{n:,} pieces go to a higher class or are no longer anchored: {names}.",
        n,
        names=names,
    )


def _say_rises(n: int, names: str) -> str:
    return ngettext(
        "{n:,} piece has a higher chance of overturning in the same class: {names}.",
        "{n:,} pieces have a higher chance of overturning in the same class: {names}.",
        n,
        names=names,
    )


def _say_added(n: int, names: str) -> str:
    return ngettext(
        "{n:,} piece is only in AFTER: {names}.", "{n:,} pieces are only in AFTER: {names}.", n, names=names
    )


def _say_removed(n: int, names: str) -> str:
    return ngettext(
        "{n:,} piece is only in BEFORE: {names}.", "{n:,} pieces are only in BEFORE: {names}.", n, names=names
    )


def _say_unclear(n: int, names: str) -> str:
    return ngettext(
        "{n:,} piece cannot be compared, as its chances rest on different bases: {names}.",
        "{n:,} pieces cannot be compared, as their chances rest on different bases: {names}.",
        n,
        names=names,
    )


def _say_routes(n: int, names: str) -> str:
    return ngettext("{n:,} route gets worse: {names}.", "{n:,} routes get worse: {names}.", n, names=names)


def _say_rooms(n: int, names: str) -> str:
    return ngettext(
        "The best way from {n:,} room to the street gets worse: {names}.",
        "The best ways from {n:,} rooms to the street get worse: {names}.",
        n,
        names=names,
    )


def _say_unclear_routes(n: int, names: str) -> str:
    return ngettext(
        "{n:,} route cannot be compared: {names}.", "{n:,} routes cannot be compared: {names}.", n, names=names
    )


def _say_unclear_rooms(n: int, names: str) -> str:
    return ngettext(
        "{n:,} room cannot be compared: {names}.", "{n:,} rooms cannot be compared: {names}.", n, names=names
    )


def _say_unjoined(n: int, names: str, run: str) -> str:
    return ngettext(
        "In {run}, {n:,} room is joined to no exit or stair, so that its way out is not known: {names}.",
        "In {run}, {n:,} rooms are joined to no exit or stair, so that their way out is not known: {names}.",
        n,
        run=run,
        names=names,
    )


def _say_unjoined_in_both(n: int, names: str) -> str:
    return ngettext(
        "In both runs, {n:,} room is joined to no exit or stair, so that its way out is not known: {names}.",
        "In both runs, {n:,} rooms are joined to no exit or stair, so that their way out is not known: {names}.",
        n,
        names=names,
    )


def _name_rooms(rooms: Sequence[str]) -> str:
    return words.name_first([words.cut(one, 30) for one in rooms], NAMED)


def _say_within(n: int) -> str:
    return ngettext(
        "For {n:,} of them the difference lies within the sampling interval.",
        "For {n:,} of them the difference lies within the sampling interval.",
        n,
    )


def _name_row(one: PieceChange, count: int) -> str:
    name = words.cut(one.piece.item, 30)
    return f"{name} (×{words.NO_BREAK}{number(count, ',d')})" if count > 1 else name


def _name_move(one: StateChange) -> str:
    """Return a route or room with its states, or with its chances where the state stays."""
    name, (before, after) = words.cut(one.name, 30), one.states
    if before != after:
        return _("{name} ({before} → {after})", name=name, before=say.name_state(before), after=say.name_state(after))
    chances = [words.percent(run.chance.probability) for run in (one.before, one.after) if run and run.chance]
    return _("{name} ({before} → {after})", name=name, before=chances[0], after=chances[-1]) if chances else name


def _line(
    label: str,
    total: Total,
    *,
    is_count: bool = True,
    is_worse_up: bool = False,
    is_worse_down: bool = False,
    style: str = "",
) -> CountLine:
    """Return a line; it is worse where the sum goes up or down as said, better the other way."""
    least = 0.5 if is_count else 0.005
    change = total.after - total.before
    tone = ""
    if total.is_comparable and abs(change) >= least and (is_worse_up or is_worse_down) and not total.is_within:
        tone = "worse" if (change > 0) == is_worse_up else "better"
    return CountLine(label, total, is_count, tone, style)


def say_share(count: int) -> str:
    """Return a count in whole numbers, a dash for none."""
    return number(count, ",d") if count else words.DASH
