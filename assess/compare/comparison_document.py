"""A comparison as a document of blocks, what gets worse first; Excel and terminal take their words from it."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
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
    Status,
    Total,
    count_states,
)
from assess.compare.past_run import ANCHORED, BY_FORMULA, CLASSES, INPUTS, UNCONFIRMED, PastChance
from assess.details import DETAILS
from assess.i18n import Text, fill, gettext as _, nfill, ngettext, number
from assess.progress import SILENT, Progress
from assess.report import blocks, measures, words
from assess.report.data import building_key
from assess.report.pages.html import render_document
from assess.report.provenance import say_date
from assess.report.report_options import ReportOptions
from assess.results import ROLLS
from assess.risk import RiskClass
from assess.route_results import RouteState
from assess.version import __version__
from assess.workbook.schema import BUILDING

MOST_STATES = 300
"""Rows of routes and of rooms that the page shows; the Excel file has all."""

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
    "anchor_behaviour": fill("Anchors: behaviour factor"),
    "anchor_period": fill("Anchors: period of the piece"),
    "route_risk": fill("Limit on the chance that a route is blocked"),
}
"""Settings by name; of later versions' others the name is shown."""
_KINDS: Mapping[Direction, tuple[Text, str]] = {
    Direction.WORSE: (fill("worse"), "worse"),
    Direction.RISES: (fill("higher chance"), "worse"),
    Direction.BETTER: (fill("better"), "better"),
    Direction.FALLS: (fill("lower chance"), "better"),
    Direction.SAME: (fill("unchanged"), ""),
    Direction.UNCLEAR: (fill("not comparable"), "unclear"),
    Direction.ADDED: (fill("only in AFTER"), "unclear"),
    Direction.REMOVED: (fill("only in BEFORE"), "unclear"),
}
"""Name and tone of each direction."""
_STATUSES: Mapping[Status, tuple[Text, str]] = {
    Status.OPEN: (fill("still open"), "worse"),
    Status.NEW: (fill("new"), "worse"),
    Status.DROPPED: (fill("no longer recommended"), "unclear"),
    Status.DONE: (fill("done"), "better"),
}
"""Name and tone of what became of a recommendation."""
_APART = {UNCONFIRMED: "unconfirmed", BY_FORMULA: "formula", ROLLS: ROLLS, ANCHORED: "anchored"}
"""What stands outside the classes, as the reports call it."""
_PIECES: Mapping[Direction, Text] = {
    Direction.WORSE: nfill("{n:,} piece goes to a higher class or is no longer anchored: {names}.",
                           "{n:,} pieces go to a higher class or are no longer anchored: {names}.", 0, names=""),
    Direction.RISES: nfill("{n:,} piece has a higher chance of overturning in the same class: {names}.",
                           "{n:,} pieces have a higher chance of overturning in the same class: {names}.", 0, names=""),
    Direction.ADDED: nfill("{n:,} piece is only in AFTER: {names}.",
                           "{n:,} pieces are only in AFTER: {names}.", 0, names=""),
    Direction.REMOVED: nfill("{n:,} piece is only in BEFORE: {names}.",
                             "{n:,} pieces are only in BEFORE: {names}.", 0, names=""),
    Direction.UNCLEAR: nfill("{n:,} piece cannot be compared, as its chances rest on different bases: {names}.",
                             "{n:,} pieces cannot be compared, as their chances rest on different bases: {names}.",
                             0, names=""),
}  # fmt: skip
"""What a number of pieces, with their names, is said to do."""


def name_direction(direction: Direction) -> str:
    """Return a direction in words."""
    return _(_KINDS[direction][0])


def find_tone(direction: Direction) -> str:
    """Return "worse", "better", "unclear" or "same"."""
    return _KINDS[direction][1] or "same"


def name_basis(basis: str) -> str:
    """Return what a chance rests on."""
    return _("by formula") if basis == "formula" else _(words.BASES[basis])


def name_state(state: str) -> str:
    """Return the state of a route or room in words; a dash where the run lacks it."""
    return blocks.DASH if state == ABSENT else _(state)


def mark_standing(standing: str) -> blocks.Span:
    """Return the standing of a piece with its symbol; a dash where the run lacks it."""
    if standing in CLASSES:
        return blocks.Span(words.risk_label(CLASSES[standing]), f"badge {words.class_name(CLASSES[standing])}")
    label = words.apart_label(_APART[standing]) if standing in _APART else blocks.DASH
    return blocks.Span(label, f"badge {standing if standing == ANCHORED else f'apart-{_APART.get(standing)}'}")


def _say_chance(chance: PastChance) -> str:
    return words.say_chance(chance.probability, chance.low, chance.high)


def say_inputs(change: PieceChange) -> list[str]:
    """Return what differs in the inputs of a piece: ``Height: 180 → 200 cm``."""
    texts = []
    for name, sides in change.inputs.items():
        field, unit = INPUTS[name], measures.unit(INPUTS[name].unit)
        was, now = (measures.convert(one, field.unit) if isinstance(one, float) else one for one in sides)
        values = _("{before} → {after}", before=_say_value(was), after=_say_value(now))
        texts.append(_("{label}: {value}", label=_(field.label), value=f"{values} {unit}".rstrip()))
    return texts


def _say_value(value: Any) -> str:
    if value is None or value in ("", ()):
        return blocks.DASH
    if isinstance(value, bool):
        return words.yes_or_no(value)
    if isinstance(value, int | float):
        return number(value, ".6g")
    if isinstance(value, tuple):
        return words.name_first([words.cut(one, 30) for one in value], 5)
    return words.cut(_(str(value)), 60)


def say_anchor(value: Any) -> str:
    """Return the setting of what is taken as anchored, ``A1,A2`` or ``first:3``, in words."""
    if first := re.fullmatch(r"first:(\d{1,9})", str(value)):
        return ngettext("the first entry of what to fix", "the first {n:,} entries of what to fix", int(first[1]))
    return _say_value(tuple(value.split(",")) if isinstance(value, str) and value else value)


def _name_all(sentence: Text, names: Sequence[str], n: int | None = None, mark: str = ", ", **values: str) -> str:
    if not names:
        return ""
    listed, n = words.name_first(names, 6, mark), len(names) if n is None else n
    return ngettext(sentence.template, sentence.many, n, names=listed, **values)


def _name_states(rows: Sequence[StateChange], directions: Sequence[Direction], sentence: Text) -> str:
    names = []
    for one in (one for one in rows if one.direction in directions):
        name, (before, after) = words.cut(one.row.name, 30), map(name_state, one.states)
        if one.states[0] == one.states[1]:
            chances = [words.percent(run.chance.probability) for run in one.sides if run and run.chance]
            before, after = (chances[0], chances[-1]) if chances else ("", "")
        names.append(_("{name} ({before} → {after})", name=name, before=before, after=after) if before else name)
    return _name_all(sentence, names, mark="; ")


def _say_sum(value: float) -> str:
    return number(value, ",d" if isinstance(value, int) else ",.2f")


def _count_line(
    label: blocks.Words, total: Total, *, is_worse_up: bool = False, is_worse_down: bool = False
) -> blocks.Row:
    """Return a count or sum of both runs; it is worse where it goes up or down as said, better the other way.

    A count is shown whole, an expected number with two decimals; less than half of that is no change.
    """
    difference, tone = total.after - total.before, ""
    is_seen = total.is_comparable and abs(difference) >= (0.5 if isinstance(total.before, int) else 0.005)
    if is_seen and not total.is_within and (is_worse_up or is_worse_down):
        tone = "worse" if (difference > 0) == is_worse_up else "better"
    change = _say_sum(0 * total.before) if total.is_comparable else _("not comparable")
    if is_seen:
        change = f"{'+' if difference > 0 else '−'}{_say_sum(abs(difference))}"
        change = _("{change} (within the sampling interval)", change=change) if total.is_within else change
    sides = (blocks.Cell(_say_sum(value), sort=value) for value in (total.before, total.after))
    return blocks.Row((blocks.head(label), *sides, blocks.Cell(change, "change")), tone)


class Fact(NamedTuple):
    """One line about the two runs; `differs` is whether they differ in it."""

    label: str
    before: str
    after: str
    differs: bool


class View:
    """What a comparison says in the language in use."""

    def __init__(self, comparison: Comparison) -> None:
        self.found = comparison
        self.before, self.after = comparison.before, comparison.after
        self.title = words.cut(self.after.name or self.before.name or self.after.workbook, 120)
        self.bases = {"before": name_basis(self.before.main_basis), "after": name_basis(self.after.main_basis)}

    @property
    def conditions(self) -> str:
        """What sets the runs apart from their workbooks as they are, for every page; "" where nothing does."""
        texts = []
        for name, run in ((_("BEFORE"), self.before), (_("AFTER"), self.after)):
            scale, anchor, found = run.settings.get("scale", 1), run.settings.get("anchor"), list[str]()
            if run.shaking:
                found.append(_("assumed shaking, {intensity}", intensity=words.cut(_(run.shaking), 40)))
            if scale != 1:
                found.append(_("motion × {scale}", scale=_say_value(scale)))
            if anchor:
                found.append(_("taken as anchored: {items}", items=say_anchor(anchor)))
            if run.settings.get("ideal"):
                found.append(_("if exactly this motion recurred"))
            texts += [f"{name}: {', '.join(found)}"] if found else []
        return "; ".join(texts)

    @property
    def footer(self) -> str:
        """What stands at the foot of every page."""
        return _("Chance of overturning in the scenario of each run, not per year. BEFORE {before}, AFTER {after}.",
                 **self.bases)  # fmt: skip

    def list_warnings(self) -> Iterator[str]:
        """Yield what stands in the way of a comparison."""
        found = self.found
        if self.before.code != self.after.code:
            yield _("The two runs were computed by different code of assess: what differs between them may come from "
                    "the program, not from the furniture.")  # fmt: skip
        if not found.has_same_basis:
            yield _("The two runs rest on different bases: BEFORE is {before}, AFTER is {after}. Their chances, "
                    "classes and sums are shown next to each other, but are neither compared nor added up. Run both in "
                    "the same way to compare them.", **self.bases)  # fmt: skip
        if found.is_other_building:
            yield _("The two runs name different buildings: {before} and {after}. Pieces are matched by their names "
                    "alone.", before=words.cut(self.before.name, 60), after=words.cut(self.after.name, 60))  # fmt: skip
        if bool(self.before.settings.get("ideal")) != bool(self.after.settings.get("ideal")):
            yield _("One run gives the chance if exactly its motion recurred, the other run includes the uncertainty "
                    "of the earthquake and of the pieces: their chances differ for that reason alone.")  # fmt: skip
        if abs(self.before.route_risk - self.after.route_risk) > 1e-9 and (found.routes or found.rooms):
            yield _("The limit on the chance that a route is blocked differs: {before} and {after}. Every state is by "
                    "the limit of its own run.", before=words.percent(self.before.route_risk),
                    after=words.percent(self.after.route_risk))  # fmt: skip

    def list_status(self) -> list[str]:
        """Return how many recommendations of the last report are done, open and new, and falls and ways out."""
        counts, texts = Counter(one.status for one in self.found.recommendations), list[str]()
        if n := counts.total() - counts[Status.NEW]:
            done = counts.pop(Status.DONE, 0)
            text = ngettext("{done:,} of {n:,} recommendation of the last report is done",
                            "{done:,} of {n:,} recommendations of the last report are done", n,
                            done=done)  # fmt: skip
            more = (f"{number(counts[one], ',d')} {_(_STATUSES[one][0])}" for one in _STATUSES if counts[one])
            texts.append(f"{', '.join((text, *more))}.")
        values = {"before": _say_sum(self.found.falls.before), "after": _say_sum(self.found.falls.after)}
        if self.found.has_same_basis:
            texts.append(_("Expected falls: {before} before, {after} after.", **values))
        was, now = count_states(self.before.routes, self.after.routes).get(RouteState.BLOCKED, (0, 0))
        if self.before.routes or self.after.routes:
            texts.append(
                _("Ways out that are likely blocked: {before:,} before, {after:,} after.", before=was, after=now)
            )
        return texts

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
        if self.before.sha256 == self.after.sha256:
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
        for rows, text in (
            (found.routes, nfill("{some:,} of {n:,} route", "{some:,} of {n:,} routes", 0, some=0)),
            (found.rooms, nfill("{some:,} of {n:,} room", "{some:,} of {n:,} rooms", 0, some=0)),
        ):
            if some := sum(one.direction in directions for one in rows):
                texts.append(ngettext(text.template, text.many, len(rows), some=some))
        return ", ".join(texts)

    def list_worse(self) -> list[str]:
        """Return what gets worse, a sentence each."""
        routes = nfill("{n:,} route gets worse: {names}.", "{n:,} routes get worse: {names}.", 0, names="")
        rooms = nfill("The best way from {n:,} room to the street gets worse: {names}.",
                      "The best ways from {n:,} rooms to the street get worse: {names}.", 0, names="")  # fmt: skip
        ways = (_name_states(self.found.routes, WORSE, routes), _name_states(self.found.rooms, WORSE, rooms))
        return [text for text in (*map(self._name_pieces, WORSE), *ways) if text]

    def list_others(self) -> list[str]:
        """Return what is in one run only, cannot be compared, or is not joined to an exit."""
        texts = [*map(self._name_pieces, ONE_SIDED)]
        if self.found.has_same_basis:
            routes = nfill("{n:,} route cannot be compared: {names}.", "{n:,} routes cannot be compared: {names}.", 0,
                           names="")  # fmt: skip
            rooms = nfill("{n:,} room cannot be compared: {names}.", "{n:,} rooms cannot be compared: {names}.", 0,
                          names="")  # fmt: skip
            texts += [
                self._name_pieces(Direction.UNCLEAR),
                _name_states(self.found.routes, (Direction.UNCLEAR,), routes),
                _name_states(self.found.rooms, (Direction.UNCLEAR,), rooms),
            ]
        unjoined = nfill("In {run}, {n:,} room is joined to no exit or stair, so that its way out is not known: "
                         "{names}.",
                         "In {run}, {n:,} rooms are joined to no exit or stair, so that their way out is not known: "
                         "{names}.", 0, run="", names="")  # fmt: skip
        in_both = nfill("In both runs, {n:,} room is joined to no exit or stair, so that its way out is not known: "
                        "{names}.",
                        "In both runs, {n:,} rooms are joined to no exit or stair, so that their way out is not known: "
                        "{names}.", 0, names="")  # fmt: skip
        was, now = ([words.cut(one, 30) for one in run.unjoined_rooms] for run in (self.before, self.after))
        if self.before.unjoined_rooms == self.after.unjoined_rooms:
            texts.append(_name_all(in_both, now))
        else:
            texts += [_name_all(unjoined, was, run=_("BEFORE")), _name_all(unjoined, now, run=_("AFTER"))]
        return [text for text in texts if text]

    def _name_pieces(self, direction: Direction) -> str:
        changes, names = self.found.list_counted(direction), []
        for one, count in changes:
            name = words.cut(one.row.item, 30)
            names.append(f"{name} (×{words.NO_BREAK}{number(count, ',d')})" if count > 1 else name)
        text = _name_all(_PIECES[direction], names, sum(count for _, count in changes))
        within = 0 if direction in ONE_SIDED else sum(count for one, count in changes if one.is_within)
        if not within:
            return text
        said = ngettext("For {n:,} of them the difference lies within the sampling interval.",
                        "For {n:,} of them the difference lies within the sampling interval.", within)  # fmt: skip
        return f"{text} {said}"

    def list_counts(self) -> list[blocks.Row]:
        """Return the pieces by class, those counted apart, and the expected falls."""
        found = self.found
        is_fair = not found.count(Direction.UNCLEAR, *ONE_SIDED)  # else a count changes for other reasons as well
        lines = [
            _count_line(
                mark_standing(one),
                found.count_standing(one),
                is_worse_up=is_fair and CLASSES.get(one, RiskClass.LOW) >= RiskClass.HIGH,
                is_worse_down=is_fair and CLASSES.get(one) == RiskClass.LOW,
            )
            for one in found.standings()
        ]
        was, now = (sum(piece.quantity for piece in run.pieces) for run in (self.before, self.after))
        lines.append(_count_line(_("all pieces"), Total(was, now, is_comparable=True)))
        lines.append(_count_line(_("expected falls"), found.falls, is_worse_up=is_fair))
        if both := found.falls_of_both:
            lines.append(_count_line(_("expected falls of the pieces counted in both runs"), both, is_worse_up=True))
        return lines

    def list_route_counts(self) -> list[blocks.Row]:
        """Return the routes and rooms by state, the expected numbers blocked or cut off, and the rooms not joined."""
        found, was, now, lines = self.found, self.before, self.after, list[blocks.Row]()
        for label, changes, rows, other_rows, expected, sums in (
            (fill("routes: {state}", state=""), found.routes, was.routes, now.routes,
             _("expected blocked routes"), (was.blocked_routes, now.blocked_routes)),
            (fill("rooms: {state}", state=""), found.rooms, was.rooms, now.rooms,
             _("expected rooms that lose every exit"), (was.cut_off_rooms, now.cut_off_rooms)),
        ):  # fmt: skip
            for state, sides in count_states(rows, other_rows).items():
                total, rank = Total(*sides, found.has_same_basis), SEVERITY.get(state, -1)
                text = _(label.template, state=name_state(state))
                lines.append(_count_line(text, total, is_worse_up=rank > 0, is_worse_down=rank == 0))
            if changes:
                lines.append(_count_line(expected, Total(*sums, found.has_same_basis), is_worse_up=True))
        for line, before, after in (
            (_("left out of these averages: routes not known"), was.unknown_routes, now.unknown_routes),
            (_("left out of these averages: rooms not known"), was.unknown_rooms, now.unknown_rooms),
            (_("rooms joined to no exit or stair"), len(was.unjoined_rooms), len(now.unjoined_rooms)),
        ):
            lines += [_count_line(line, Total(before, after, is_comparable=True))] if before or after else []
        return lines

    def tabulate_counts(self) -> list[blocks.Table]:
        """Return the counts of pieces, and those of routes and rooms where there are any."""
        heads = ((_("BEFORE"), "w15", "num"), (_("AFTER"), "w15", "num"), (_("Change"), "w30", "num"))
        parts = ((_("Pieces"), self.list_counts()), (_("Evacuation routes"), self.list_route_counts()))
        return [
            blocks.table(blocks.list_columns((label, ""), *heads), rows, "compared counts", is_cards=False)
            for label, rows in parts
            if rows
        ]

    def tabulate_status(self, most: int) -> blocks.Table:
        """Return what became of the recommendations of the last report, and the new ones, at most so many."""
        rows: list[tuple[blocks.Cell | blocks.Words, ...]] = []
        for one in self.found.recommendations[:most]:
            entry, left = one.entry, len(one.items) if one.status == Status.OPEN else 0
            names = words.name_pieces(one.items or entry.items, 6)
            if 0 < left < len(entry.items):
                names = _("{names} ({left:,} of {n:,})", names=names, left=left, n=len(entry.items))
            fixes = [_(DETAILS[key].title) if key in DETAILS else key for key in entry.details]
            place = ", ".join(filter(None, (words.cut(entry.floor, 20), words.cut(entry.room, 30))))
            name, tone = _STATUSES[one.status]
            status = blocks.Span(_(name), f"change {tone}")
            rows.append((status, blocks.head(names), place, entry.phase or blocks.DASH, "; ".join(fixes)))
        heads = (
            (_("Status"), "w18"),
            (_("Pieces"), ""),
            (_("Place"), "w20"),
            (_("Phase"), "w9"),
            (_("Fix with"), "w20"),
        )
        return blocks.table(blocks.list_columns(*heads), rows, "compared cards", is_named=True)

    def list_facts(self) -> list[Fact]:
        """Return what the two runs are, and the settings, uncertainties, motions, lines and versions that differ."""
        before, after = self.before, self.after
        uncertainty = {"motion": _("Motion uncertainty"), "piece": _("Piece uncertainty")}
        lines = {building_key(column): _(column.label) for column in BUILDING.columns}
        settings = {name: _(label) for name, label in SETTINGS.items()}
        origins = [
            (_("Results"), ["/".join(run.path.absolute().parts[-2:]) for run in (before, after)]),
            (_("Building"), [before.name, after.name]),
            (_("Workbook"), [before.workbook, after.workbook]),
            (_("SHA-256 of the workbook"), [before.workbook_sha256, after.workbook_sha256]),
            (_("Date of the report"), [say_date(str(run.building.get("report_date") or ""))
                                       for run in (before, after)]),
            (_("Results written (UTC)"), [f"{run.written:%Y-%m-%d %H:%M}" for run in (before, after)]),
            (_("Classes rest on"), [self.bases["before"], self.bases["after"]]),
            (_("Version of assess"), [_("{version}, schema {schema}", version=run.version, schema=run.schema)
                                      for run in (before, after)]),
            (_("SHA-256 of the program's code"), [before.code, after.code]),
        ]  # fmt: skip
        facts = []
        for label, texts in origins:
            was, now = (words.cut(text, 80) or blocks.DASH for text in texts)
            facts.append(Fact(label, was, now, differs=was != now))
        motions = []
        for run, other in ((before, after), (after, before)):
            own = [name for name, digest in run.motions.items() if other.motions.get(name) != digest]
            motions.append(ngettext("{n:,} file; differs: {names}", "{n:,} files; differ: {names}", len(run.motions),
                                    names=words.name_first(own, 3))
                           if own else ngettext("{n:,} file", "{n:,} files", len(run.motions)))  # fmt: skip
        return [
            *facts,
            *_list_differing(before.settings, after.settings, settings, always=("scale", "anchor")),
            *_list_differing(before.uncertainty, after.uncertainty, uncertainty),
            *_list_differing({"": before.shaking}, {"": after.shaking}, {"": _("Assumed shaking")}),
            *_list_differing({"": before.site_ground}, {"": after.site_ground}, {"": _("Ground motion")}),
            *([Fact(_("Recorded motions"), motions[0], motions[1], True)] if before.motions != after.motions else []),
            *_list_differing(before.building, after.building, lines, left_out=("building", "report_date")),
            *_list_differing(before.platform, after.platform, {}),
        ]


def _list_differing(
    before: Mapping[str, Any],
    after: Mapping[str, Any],
    names: Mapping[str, str],
    left_out: Sequence[str] = (),
    always: Sequence[str] = (),
) -> Iterator[Fact]:
    for name in dict.fromkeys((*names, *before, *after)):
        was, now = before.get(name), after.get(name)
        if name in always or (was != now and name not in left_out):
            show = say_anchor if name == "anchor" else _say_value
            yield Fact(names.get(name, name), show(was), show(now), differs=was != now)


def render_comparison(
    view: View, options: ReportOptions, *, for_print: bool = False, progress: Progress = SILENT
) -> str:
    """Return the page in the language in use (see `ReportOptions.spoken`)."""

    def build() -> blocks.Document:
        authors = [str(view.after.building.get(name) or "") for name in ("prepared_by", "organisation")]
        about = _("Overturning of furniture in an earthquake: what has changed since the last report")
        title = blocks.Title(view.title, words.cut(view.title, 60), view.footer, words.cut(view.conditions, 150))
        counts, *routes = view.tabulate_counts()
        sums = _("Expected falls are sums over the free-standing pieces that have a class in their run: BEFORE "
                 "{before}, AFTER {after}. Unconfirmed pieces and pieces by formula only are not in them. For the "
                 "interval of a sum the pieces are taken as fully correlated.", **view.bases)  # fmt: skip
        counted: list[blocks.Block] = [counts, blocks.Paragraph(sums, "small")]
        counted += routes or [blocks.Paragraph(_("Neither run has evacuation routes."))]
        pieces = _list_pieces(view, 300 if for_print else 5000)  # rows on paper and on a screen; the Excel file has all
        sections = [
            blocks.Section(list(_list_status(view)), "", "status", _("Status of the last report's recommendations")),
            blocks.Section(list(_say_worse(view)), "", "worse", _("What gets worse")),
            blocks.Section(counted, "run-on", "counts", _("Counts before and after")),
            blocks.Section(list(pieces), "", "changes", _("Pieces that changed")),
        ]
        if view.found.routes or view.found.rooms:
            found = [
                *_list_states(view.found.routes, _("Route"), _("No route changed.")),
                blocks.Heading(_("Rooms that changed")),
                *_list_states(view.found.rooms, _("Room"), _("No room changed."), with_floor=True),
            ]
            sections.append(blocks.Section(found, "run-on", "routes", _("Evacuation routes that changed")))
        sections.append(blocks.Section(_list_runs(view), "run-on", "runs", _("The two runs")))
        return blocks.Document(
            title=_("Furniture in earthquakes, before and after: {building}", building=words.cut(view.title, 80)),
            cover=[blocks.Paragraph(about, "kind"), title],
            sections=sections,
            author=", ".join(filter(None, authors)),
            description=about,
            conditions=view.conditions,
            kind="comparison",
        )

    return render_document(progress.wait_for(build), options, "compare.css", for_print=for_print, progress=progress)


def _list_status(view: View) -> Iterator[blocks.Block]:
    first, *others = view.list_status() or [_("The last report recommends nothing.")]
    yield blocks.Paragraph([blocks.strong(first), " ", " ".join(others)], "lead")
    if view.found.recommendations:
        yield view.tabulate_status(MOST_STATES)
        yield from blocks.more(len(view.found.recommendations) - MOST_STATES, _say_more)


def _say_worse(view: View) -> Iterator[blocks.Block]:
    yield from (blocks.Paragraph(text, "caution") for text in view.list_warnings())
    worse, others = view.list_worse(), view.list_others()
    verdict: list[blocks.Block] = [
        blocks.Paragraph(blocks.strong(view.headline), "lead"),
        *([blocks.Bullets(worse)] if worse else []),
    ]
    yield blocks.Box(verdict, f"verdict {view.tone}")
    if others:
        yield blocks.Bullets(others)
    yield blocks.Paragraph(
        _("Pieces are matched by the name of their item. A difference within the sampling "
          "interval cannot be told from chance at 95 % (Newcombe 1998, method 10, draws of both runs taken as "
          "independent). Percentages without a range come from the formula only."),
        "small",
    )  # fmt: skip


def _list_runs(view: View) -> list[blocks.Block]:
    rows = []
    for fact in view.list_facts():
        mark: blocks.Runs = [" ", blocks.Span(_("differs"), "change unclear")] if fact.differs else []
        cells = (blocks.head([fact.label, *mark]), blocks.Cell(fact.before, "hash"), blocks.Cell(fact.after, "hash"))
        rows.append(blocks.Row(cells, "differs" if fact.differs else ""))
    columns = blocks.list_columns((_("What"), "w30"), (_("BEFORE"), ""), (_("AFTER"), ""))
    same = _("Settings and lines of the workbook that are not named are the same in both runs. Made with assess "
             "{version}.", version=__version__)  # fmt: skip
    table = blocks.table(columns, rows, "compared facts-of-two", is_cards=False)
    return [table, blocks.Paragraph(same, "small")]


def _mark_change(one: PieceChange | StateChange) -> blocks.Words:
    text = name_direction(one.direction)
    if one.is_within and one.direction != Direction.SAME:
        text = _("{change} (within the sampling interval)", change=text)
    return blocks.Span(text, f"change {find_tone(one.direction)}")


def _say_more(left: int) -> str:
    return ngettext("{n:,} more is in the Excel file.", "{n:,} more are in the Excel file.", left)


def _list_pieces(view: View, most: int) -> Iterator[blocks.Block]:
    changed = [one for one in view.found.pieces if one.direction != Direction.SAME or one.inputs]
    if not changed:
        yield blocks.Paragraph(_("No piece changed."))
        return
    unchanged = len(view.found.pieces) - len(changed)
    lines = [
        ngettext("{n:,} row changed.", "{n:,} rows changed; the changes for the worse come first.", len(changed)),
        ngettext("{n:,} row did not change.", "{n:,} rows did not change.", unchanged) if unchanged else "",
    ]
    yield blocks.Paragraph(" ".join(filter(None, lines)))
    columns = blocks.list_columns(
        (_("Item"), "w14"), (_("Change"), "w18"), (_("Place"), "w9"), (_("Pieces"), "w7", "num"), (_("BEFORE"), "w18"),
        (_("AFTER"), "w18"), (_("Input that differs"), ""),
    )  # fmt: skip
    shown = []
    for one in changed[:most]:
        piece, sides = one.row, list[blocks.Words]()
        name: blocks.Runs = [words.cut(piece.item, 40)]
        if piece.description:
            name += [blocks.BREAK, blocks.note(words.cut(piece.description, 40))]
        place = ", ".join(filter(None, (words.cut(piece.floor, 20), words.cut(piece.room, 30))))
        for side, state in zip(one.sides, one.states, strict=True):
            chance = _say_chance(side.chance) if side else ""
            chance = _("free-standing: {chance}", chance=chance) if side and side.is_held else chance
            sides.append([mark_standing(state), blocks.BREAK, blocks.note(chance)] if side else blocks.DASH)
        inputs = "; ".join(say_inputs(one) or [blocks.DASH])
        cells = (blocks.head(name), _mark_change(one), place, _say_sum(one.pieces), *sides, inputs)
        shown.append(blocks.Row(cells, find_tone(one.direction)))
    yield blocks.table(columns, shown, "compared cards changed", is_named=True)
    yield from blocks.more(len(changed) - most, _say_more)


def _list_states(
    rows: Sequence[StateChange], label: str, none: str, *, with_floor: bool = False
) -> Iterator[blocks.Block]:
    changed = [one for one in rows if one.direction != Direction.SAME]
    if not changed:
        yield blocks.Paragraph(none)
        return
    columns = blocks.list_columns(
        (label, "w20"), (_("Change"), "w20"), *([(_("Floor"), "w10")] if with_floor else []), (_("BEFORE"), ""),
        (_("AFTER"), ""),
    )  # fmt: skip
    shown = []
    for one in changed[:MOST_STATES]:
        floor, sides = [words.cut(one.row.floor, 20)] if with_floor else [], list[blocks.Words]()
        for side, state in zip(one.sides, one.states, strict=True):
            chance = side.chance if side and side.state != RouteState.NOT_KNOWN else None
            sides.append([name_state(state), *([blocks.BREAK, blocks.note(_say_chance(chance))] if chance else [])])
        cells = (blocks.head(words.cut(one.row.name, 60)), _mark_change(one), *floor, *sides)
        shown.append(blocks.Row(cells, find_tone(one.direction)))
    yield blocks.table(columns, shown, "compared cards", is_named=True)
    yield from blocks.more(len(changed) - MOST_STATES, _say_more)
