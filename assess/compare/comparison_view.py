"""What a comparison says, once, in the language in use: HTML, PDF, Excel and terminal show it."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

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
)
from assess.compare.past_run import ANCHORED, BY_FORMULA, CLASSES, INPUTS, UNCONFIRMED, PastChance, PastRun, PastState
from assess.i18n import Text, fill, ngettext, number
from assess.i18n import gettext as _
from assess.report import words
from assess.report.provenance import say_date
from assess.report.results_schema import building_key
from assess.results import CANNOT_ROCK
from assess.risk import RiskClass
from assess.workbook.schema import BUILDING

NAMED, NAMED_VALUES = 6, 5
"""Items, routes and rooms that a sentence names, and values that a line of the two runs lists."""
LONGEST_VALUE, LONGEST_FACT = 60, 80
"""Characters of a value from a run, and of a line of the two runs, that a table shows."""

SETTINGS: Mapping[str, Text] = {
    "scenario": fill("Source of the floor motion"),
    "verify": fill("Pieces simulated"),
    "runs": fill("Draws of each floor and axis"),
    "seed": fill("Random seed"),
    "scale": fill("Factor on the motion of every floor"),
    "ideal": fill("Exactly this motion and these pieces"),
    "scale_motions": fill("Own motions scaled to each floor's PFA"),
    "city": fill("Earthquakes drawn by the building's place"),
    "zeta_acceleration": fill("Kaneko and Hayashi: dispersion of PFA"),
    "zeta_velocity": fill("Kaneko and Hayashi: dispersion of PFV"),
    "slide_coefficient": fill("Ishiyama: sliding coefficient"),
    "ductility_reduction": fill("Reduction of forces for ductility"),
    "anchor": fill("Taken as anchored and holding"),
    "anchor_resonance": fill("Anchors: resonance factor"),
    "anchor_strength": fill("Anchors: strength factor"),
    "anchor_importance": fill("Anchors: importance factor"),
    "route_risk": fill("Limit on the chance that a route is blocked"),
}
"""Settings by name; of later versions' others the name is shown."""
ALWAYS = ("scale", "anchor")
"""Settings that are shown even where both runs have the same."""


class _Kind(NamedTuple):
    """How a direction is shown: its name, what its tile counts, and its tone."""

    label: Text
    note: Text
    tone: str


_KINDS: Mapping[Direction, _Kind] = {
    Direction.WORSE: _Kind(fill("worse"), fill("higher class, or no longer anchored"), "worse"),
    Direction.RISES: _Kind(fill("higher chance"), fill("in the same class"), "worse"),
    Direction.BETTER: _Kind(fill("better"), fill("lower class, or anchored"), "better"),
    Direction.FALLS: _Kind(fill("lower chance"), fill("in the same class"), "better"),
    Direction.SAME: _Kind(fill("unchanged"), fill("or within the sampling interval"), ""),
    Direction.UNCLEAR: _Kind(fill("not comparable"), fill("chances on different bases"), "unclear"),
    Direction.ADDED: _Kind(fill("only in AFTER"), fill("new items, or a larger quantity"), "unclear"),
    Direction.REMOVED: _Kind(fill("only in BEFORE"), fill("items removed, or a smaller quantity"), "unclear"),
}
"""The directions in the order of their tiles."""
_STANDINGS: Mapping[str, tuple[Text, str, str]] = {
    UNCONFIRMED: (fill("unconfirmed"), words.UNCONFIRMED, "apart-unconfirmed"),
    BY_FORMULA: (fill("by formula only"), words.BY_FORMULA, "apart-formula"),
    ANCHORED: (fill("anchored"), words.ANCHORED, "anchored"),
}
"""Word, symbol and style of what stands outside the classes."""
_BASES: Mapping[str, Text] = {
    "simulated": fill("simulated"),
    "formula": fill("by formula"),
    "unconfirmed": fill("unconfirmed"),
    CANNOT_ROCK: fill("cannot rock"),
}


# ---------------------------------------------------------------- words


def name_direction(direction: Direction) -> str:
    """Return a direction in words."""
    return _(_KINDS[direction].label)


def say_direction(one: PieceChange | StateChange) -> str:
    """Return where a row goes, and that the difference lies within the sampling interval where it does."""
    text = name_direction(one.direction)
    if one.is_within and one.direction != Direction.SAME:
        return _("{change} (within the sampling interval)", change=text)
    return text


def find_tone(direction: Direction) -> str:
    """Return "worse", "better", "unclear" or "same"."""
    return _KINDS[direction].tone or "same"


def name_basis(basis: str) -> str:
    """Return what a chance rests on."""
    return _(_BASES[basis])


def name_state(state: str) -> str:
    """Return the standing of a piece or the state of a route or room in words; a dash where the run lacks it."""
    if state == ABSENT:
        return words.DASH
    return _(_STANDINGS[state][0] if state in _STANDINGS else state)


def label_standing(standing: str) -> str:
    """Return the standing of a piece with its symbol."""
    if standing in CLASSES:
        return words.risk_label(CLASSES[standing])
    return f"{_STANDINGS[standing][1]} {name_state(standing)}" if standing in _STANDINGS else name_state(standing)


def style_standing(standing: str) -> str:
    """Return the name of the style of a standing."""
    return words.class_name(CLASSES[standing]) if standing in CLASSES else _STANDINGS[standing][2]


def say_chance(chance: PastChance | None) -> str:
    """Return a chance with its interval, where there is one."""
    return words.DASH if chance is None else words.say_chance(chance.probability, chance.low, chance.high)


def say_inputs(change: PieceChange) -> list[str]:
    """Return what differs in the inputs of a piece: ``Height: 180 → 200 cm``."""
    texts = []
    for name, (before, after) in change.inputs.items():
        field = INPUTS[name]
        values = _("{before} → {after}", before=say_value(before), after=say_value(after))
        texts.append(_("{label}: {value}", label=_(field.label), value=f"{values} {field.unit}".rstrip()))
    return texts


def say_value(value: Any) -> str:
    """Return a value of a run: a dash for none, words for a flag, texts cut."""
    if value is None or value == "" or value == ():
        return words.DASH
    if isinstance(value, bool):
        return _("yes") if value else _("no")
    if isinstance(value, int | float):
        return number(value, ".6g")
    if isinstance(value, tuple):
        return words.name_first([words.cut(one, 30) for one in value], NAMED_VALUES)
    return words.cut(_(str(value)), LONGEST_VALUE)


def say_anchor(value: Any) -> str:
    """Return the setting of what is taken as anchored, ``A1,A2`` or ``first:3``, in words."""
    first = re.fullmatch(r"first:(\d{1,9})", str(value))
    if first:
        return ngettext("the first entry of what to fix", "the first {n:,} entries of what to fix", int(first[1]))
    return say_value(tuple(value.split(",")) if isinstance(value, str) and value else value)


def _list_conditions(run: PastRun) -> Iterator[str]:
    """Yield what sets a run apart from the workbook as it is: a factor, pieces taken as anchored, nothing varied."""
    if run.shaking:
        yield _("assumed shaking, {intensity}", intensity=words.cut(_(run.shaking), 40))
    if run.settings.get("scale", 1) != 1:
        yield _("motion × {scale}", scale=say_value(run.settings.get("scale")))
    if run.settings.get("anchor"):
        yield _("taken as anchored: {items}", items=say_anchor(run.settings.get("anchor")))
    if run.settings.get("ideal"):
        yield _("if exactly this motion recurred")


# ---------------------------------------------------------------- rows


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
        """Before, after, and the change with its sign, and whether that lies within the sampling interval."""
        return self._say(self.total.before), self._say(self.total.after), self._say_difference()

    def _say(self, value: float) -> str:
        return number(int(value), ",d") if self.is_count else number(value, ",.2f")

    def _say_difference(self) -> str:
        if not self.total.is_comparable:
            return _("not comparable")
        difference = self.total.after - self.total.before
        if abs(difference) < _find_least(self.is_count):
            return self._say(0)
        text = f"{'+' if difference > 0 else '−'}{self._say(abs(difference))}"
        return _("{change} (within the sampling interval)", change=text) if self.total.is_within else text


def _find_least(is_count: bool) -> float:
    """Return the least difference that is shown: a count is shown whole, an expected number with two decimals."""
    return 0.5 if is_count else 0.005


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
    change, tone = total.after - total.before, ""
    is_seen = total.is_comparable and abs(change) >= _find_least(is_count) and not total.is_within
    if is_seen and (is_worse_up or is_worse_down):
        tone = "worse" if (change > 0) == is_worse_up else "better"
    return CountLine(label, total, is_count, tone, style)


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

    @property
    def total(self) -> int:
        """All pieces of the row."""
        return sum(self.counts)


@dataclass(frozen=True, slots=True)
class Matrix:
    """Pieces by their standing before (rows) and after (columns)."""

    columns: tuple[str, ...]
    rows: tuple[MatrixRow, ...]

    @property
    def totals(self) -> tuple[int, ...]:
        """All pieces of each column."""
        return tuple(sum(row.counts[at] for row in self.rows) for at in range(len(self.columns)))


@dataclass(frozen=True, slots=True)
class Fact:
    """One line about the two runs; `differs` is whether they differ in it."""

    label: str
    before: str
    after: str
    differs: bool


# ---------------------------------------------------------------- the view


class View:
    """A comparison in words."""

    def __init__(self, comparison: Comparison) -> None:
        self.found = comparison
        self.before, self.after = comparison.before, comparison.after
        self.title = words.cut(self.after.name or self.before.name or self.after.workbook, 120)
        self.bases = {
            "before": name_basis(self.before.main_basis),
            "after": name_basis(self.after.main_basis),
        }

    @property
    def conditions(self) -> str:
        """What sets the runs apart from their workbooks as they are, for every page; "" where nothing does."""
        sides = ((_("BEFORE"), self.before), (_("AFTER"), self.after))
        texts = [f"{name}: {found}" for name, run in sides if (found := ", ".join(_list_conditions(run)))]
        return "; ".join(texts)

    @property
    def footer(self) -> str:
        """What stands at the foot of every page."""
        return _(
            "Chance of overturning in the scenario of each run, not per year. BEFORE {before}, AFTER {after}.",
            **self.bases,
        )

    def list_warnings(self) -> list[str]:
        """Return what stands in the way of a comparison."""
        return list(self._warn())

    def _warn(self) -> Iterator[str]:
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
                **self.bases,
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
        there = {one.direction for rows in (self.found.pieces, self.found.routes, self.found.rooms) for one in rows}
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
        better, tone = self._count_rows(*BETTER), self.tone
        if tone == "worse":
            worse = self._count_rows(*WORSE)
            return _("Worse: {worse}. Better: {better}.", worse=worse, better=better or _("nothing"))
        if tone == "same":
            return _("Nothing changed beyond the sampling interval.")
        first = _("Nothing gets worse.") if tone == "better" else _("Nothing gets worse as far as it can be compared.")
        return " ".join((first, _("Better: {better}.", better=better))) if better else first

    def _count_rows(self, *directions: Direction) -> str:
        """Return how many pieces, routes and rooms go in some directions: ``3 of 7 pieces, 1 of 2 routes``."""
        found, texts = self.found, []
        if some := found.count(*directions):
            every = found.count(*Direction)
            texts.append(ngettext("{some:,} of {n:,} piece", "{some:,} of {n:,} pieces", every, some=some))
        if some := sum(one.direction in directions for one in found.routes):
            n = len(found.routes)
            texts.append(ngettext("{some:,} of {n:,} route", "{some:,} of {n:,} routes", n, some=some))
        if some := sum(one.direction in directions for one in found.rooms):
            n = len(found.rooms)
            texts.append(ngettext("{some:,} of {n:,} room", "{some:,} of {n:,} rooms", n, some=some))
        return ", ".join(texts)

    def list_worse(self) -> list[str]:
        """Return what gets worse, a sentence each."""
        texts = [
            *(self._name_pieces(one) for one in WORSE),
            _name_states(self.found.routes, WORSE, _say_routes),
            _name_states(self.found.rooms, WORSE, _say_rooms),
        ]
        return [text for text in texts if text]

    def list_others(self) -> list[str]:
        """Return what else is to be known at once: what is in one run alone, cannot be compared, or is not joined."""
        texts = [self._name_pieces(one) for one in ONE_SIDED]
        if self.found.has_same_basis:
            texts += [
                self._name_pieces(Direction.UNCLEAR),
                _name_states(self.found.routes, (Direction.UNCLEAR,), _say_unclear_routes),
                _name_states(self.found.rooms, (Direction.UNCLEAR,), _say_unclear_rooms),
            ]
        was, now = self.before.unjoined_rooms, self.after.unjoined_rooms
        if was == now:
            texts.append(_say_unjoined(now, ""))
        else:
            texts += [_say_unjoined(was, _("BEFORE")), _say_unjoined(now, _("AFTER"))]
        return [text for text in texts if text]

    def _name_pieces(self, direction: Direction) -> str:
        changes = self.found.list_counted(direction)
        if not changes:
            return ""
        names = words.name_first([_name_row(one, count) for one, count in changes], NAMED)
        text = _PIECES[direction](sum(count for _, count in changes), names)
        within = 0 if direction in ONE_SIDED else sum(count for one, count in changes if one.is_within)
        if not within:
            return text
        said = ngettext(
            "For {n:,} of them the difference lies within the sampling interval.",
            "For {n:,} of them the difference lies within the sampling interval.",
            within,
        )
        return f"{text} {said}"

    def list_tiles(self) -> list[Tile]:
        """Return the pieces by where they go."""
        tiles = [Tile(_(kind.label), self.found.count(one), _(kind.note), kind.tone) for one, kind in _KINDS.items()]
        return [one for one in tiles if one.count or one.tone in ("worse", "better")]

    # ------------------------------------------------------------ counts

    def list_counts(self) -> list[CountLine]:
        """Return the pieces by class, those that stand apart, and the expected falls."""
        found = self.found
        is_fair = not found.count(Direction.UNCLEAR, *ONE_SIDED)  # else a count changes for other reasons as well
        lines = [
            _line(
                label_standing(one),
                found.count_standing(one),
                is_worse_up=is_fair and CLASSES.get(one, RiskClass.LOW) >= RiskClass.HIGH,
                is_worse_down=is_fair and CLASSES.get(one) == RiskClass.LOW,
                style=style_standing(one),
            )
            for one in found.standings()
        ]
        every = [sum(piece.quantity for piece in run.pieces) for run in (self.before, self.after)]
        lines.append(_line(_("all pieces"), Total(every[0], every[1], is_comparable=True)))
        lines.append(_line(_("expected falls"), found.falls, is_count=False, is_worse_up=is_fair))
        if both := found.falls_of_both:
            label = _("expected falls of the pieces counted in both runs")
            lines.append(_line(label, both, is_count=False, is_worse_up=True))
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
            (_("rooms joined to no exit or stair"), len(was.unjoined_rooms), len(now.unjoined_rooms)),
        ):
            lines += [_line(label, Total(before, after, is_comparable=True))] if before or after else []
        return lines

    def _count_states(
        self, before: Sequence[PastState], after: Sequence[PastState], label: Callable[[str], str]
    ) -> list[CountLine]:
        return [
            _line(
                label(name_state(one)),
                Total(*sides, self.found.has_same_basis),
                is_worse_up=SEVERITY.get(one, 0) > 0,
                is_worse_down=SEVERITY.get(one) == 0,
            )
            for one, sides in count_states(before, after).items()
        ]

    def build_matrix(self) -> Matrix:
        """Return the pieces by standing before and after; those of one run alone have a row and column of their own."""
        moves, standings = self.found.moves, self.found.standings()
        rows = [*standings, ABSENT] if any(was == ABSENT for was, _now in moves) else standings
        columns = [*standings, ABSENT] if any(now == ABSENT for _was, now in moves) else standings
        return Matrix(
            tuple(columns),
            tuple(
                MatrixRow(
                    was,
                    tuple(moves.get((was, now), 0) for now in columns),
                    tuple(self._tone_of(was, now) for now in columns),
                )
                for was in rows
            ),
        )

    def _tone_of(self, was: str, now: str) -> str:
        if was == now:
            return "same"
        if ANCHORED in (was, now) and ABSENT not in (was, now):
            return "worse" if was == ANCHORED else "better"
        if not self.found.has_same_basis or not {was, now} <= {*CLASSES}:
            return ""
        return "worse" if CLASSES[now] > CLASSES[was] else "better"

    # ------------------------------------------------------------ rows

    def list_changed(self) -> list[PieceChange]:
        """Return the pieces that changed, or of which an input did."""
        return [one for one in self.found.pieces if one.direction != Direction.SAME or one.inputs]

    def list_facts(self) -> list[Fact]:
        """Return what the two runs are, and the settings, uncertainties, motions, lines and versions that differ."""
        before, after = self.before, self.after
        uncertainty = {"motion": _("Motion uncertainty"), "piece": _("Piece uncertainty")}
        lines = {building_key(column): _(column.label) for column in BUILDING.columns}
        motions = _say_motions(before, after), _say_motions(after, before)
        return [
            *self._list_origins(),
            *_list_settings(before.settings, after.settings),
            *_list_differing(before.uncertainty, after.uncertainty, uncertainty),
            *_list_differing({"": before.shaking}, {"": after.shaking}, {"": _("Assumed shaking")}),
            *_list_differing({"": before.site_ground}, {"": after.site_ground}, {"": _("Ground motion")}),
            *([Fact(_("Recorded motions"), *motions, differs=True)] if before.motions != after.motions else []),
            *_list_differing(before.building, after.building, lines, left_out=("building", "report_date")),
            *_list_differing(before.platform, after.platform, {}),
        ]

    def _list_origins(self) -> Iterator[Fact]:
        def fact(label: str, read: Callable[[PastRun], str]) -> Fact:
            was, now = (words.cut(read(run), LONGEST_FACT) or words.DASH for run in (self.before, self.after))
            return Fact(label, was, now, differs=was != now)

        yield fact(_("Results"), lambda run: "/".join(run.path.absolute().parts[-2:]))
        yield fact(_("Building"), lambda run: run.name)
        yield fact(_("Workbook"), lambda run: run.workbook)
        yield fact(_("SHA-256 of the workbook"), lambda run: run.workbook_sha256)
        yield fact(_("Date of the report"), lambda run: say_date(str(run.building.get("report_date") or "")))
        yield fact(_("Results written (UTC)"), lambda run: f"{run.written:%Y-%m-%d %H:%M}")
        yield fact(_("Classes rest on"), lambda run: name_basis(run.main_basis))
        yield fact(
            _("Version of assess"),
            lambda run: _("{version}, schema {schema}", version=run.version, schema=run.schema),
        )
        yield fact(_("SHA-256 of the program's code"), lambda run: run.code)


def _list_settings(before: Mapping[str, Any], after: Mapping[str, Any]) -> Iterator[Fact]:
    for name in dict.fromkeys((*SETTINGS, *sorted({*before, *after}))):
        was, now = before.get(name), after.get(name)
        if was != now or name in ALWAYS:
            show = say_anchor if name == "anchor" else say_value
            yield Fact(_(SETTINGS[name]) if name in SETTINGS else name, show(was), show(now), differs=was != now)


def _say_motions(run: PastRun, other: PastRun) -> str:
    own = [name for name, digest in run.motions.items() if other.motions.get(name) != digest]
    if not own:
        return ngettext("{n:,} file", "{n:,} files", len(run.motions))
    return ngettext(
        "{n:,} file; differs: {names}",
        "{n:,} files; differ: {names}",
        len(run.motions),
        names=words.name_first(own, 3),
    )


def _list_differing(
    before: Mapping[str, Any], after: Mapping[str, Any], names: Mapping[str, str], left_out: Sequence[str] = ()
) -> Iterator[Fact]:
    for name in dict.fromkeys((*before, *after)):
        was, now = before.get(name), after.get(name)
        if was != now and name not in left_out:
            yield Fact(names.get(name, name), say_value(was), say_value(now), differs=True)


# ---------------------------------------------------------------- sentences


_PIECES: Mapping[Direction, Callable[[int, str], str]] = {
    Direction.WORSE: lambda n, names: ngettext(
        "{n:,} piece goes to a higher class or is no longer anchored: {names}.",
        "{n:,} pieces go to a higher class or are no longer anchored: {names}.",
        n,
        names=names,
    ),
    Direction.RISES: lambda n, names: ngettext(
        "{n:,} piece has a higher chance of overturning in the same class: {names}.",
        "{n:,} pieces have a higher chance of overturning in the same class: {names}.",
        n,
        names=names,
    ),
    Direction.ADDED: lambda n, names: ngettext(
        "{n:,} piece is only in AFTER: {names}.", "{n:,} pieces are only in AFTER: {names}.", n, names=names
    ),
    Direction.REMOVED: lambda n, names: ngettext(
        "{n:,} piece is only in BEFORE: {names}.", "{n:,} pieces are only in BEFORE: {names}.", n, names=names
    ),
    Direction.UNCLEAR: lambda n, names: ngettext(
        "{n:,} piece cannot be compared, as its chances rest on different bases: {names}.",
        "{n:,} pieces cannot be compared, as their chances rest on different bases: {names}.",
        n,
        names=names,
    ),
}
"""What a number of pieces, with their names, is said to do."""


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


def _say_unjoined(rooms: Sequence[str], run: str) -> str:
    """Return which rooms are joined to nothing in a run, in both where it has no name; "" without rooms."""
    names = words.name_first([words.cut(one, 30) for one in rooms], NAMED)
    if rooms and run:
        return ngettext(
            "In {run}, {n:,} room is joined to no exit or stair, so that its way out is not known: {names}.",
            "In {run}, {n:,} rooms are joined to no exit or stair, so that their way out is not known: {names}.",
            len(rooms),
            run=run,
            names=names,
        )
    if rooms:
        return ngettext(
            "In both runs, {n:,} room is joined to no exit or stair, so that its way out is not known: {names}.",
            "In both runs, {n:,} rooms are joined to no exit or stair, so that their way out is not known: {names}.",
            len(rooms),
            names=names,
        )
    return ""


def _name_row(one: PieceChange, count: int) -> str:
    name = words.cut(one.row.item, 30)
    return f"{name} (×{words.NO_BREAK}{number(count, ',d')})" if count > 1 else name


def _name_states(
    rows: Sequence[StateChange], directions: Sequence[Direction], sentence: Callable[[int, str], str]
) -> str:
    """Return the sentence for the routes or rooms that go in some directions; "" where none does."""
    names = [_name_move(one) for one in rows if one.direction in directions]
    return sentence(len(names), words.name_first(names, NAMED, "; ")) if names else ""


def _name_move(one: StateChange) -> str:
    """Return a route or room with its states, or with its chances where the state stays."""
    name, (before, after) = words.cut(one.row.name, 30), one.states
    if before != after:
        return _("{name} ({before} → {after})", name=name, before=name_state(before), after=name_state(after))
    chances = [words.percent(run.chance.probability) for run in one.sides if run and run.chance]
    return _("{name} ({before} → {after})", name=name, before=chances[0], after=chances[-1]) if chances else name
