"""What is said of what to fix: the entries by urgency, the work by room, the details, and what they change."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from assess.details import CHECK, LEAST_FIXINGS
from assess.fields import schedule_fields
from assess.i18n import fill, gettext as _, ngettext, number
from assess.report import measures, words
from assess.results import ItemResult, Results, count_pieces
from assess.risk import RiskClass
from assess.route_results import RouteTables
from assess.schedule_results import NOTHING, PhaseRow, Schedule, ScheduleRow, State, WorkRow
from assess.text import natural_key

NAMED = 2
"""Routes that a reason names; the rest are counted."""
MOST_NAMES = 8
"""Names, or rows of them, that a page has room for; the Excel report holds all."""
A_DAY = 8.0
"""Hours of a working day."""
LEAST = "+"
"""Mark of a number of fixings that is the least, not a result."""
WEIGHT, HEIGHT, METRE = "w", "h", "m"
"""Marks of forces that rest on an assumed weight or bracket height, and of those of one metre of a piece."""


def shorten_names(names: Iterable[str]) -> list[str]:
    """Return names in natural order, cut, with runs of them joined."""
    return words.join_runs(sorted(names, key=natural_key), 20)


def join_names(parts: Sequence[str]) -> str:
    """Return parts with commas between them and "and" before the last; beyond `MOST_NAMES` they are counted."""
    if len(parts) > MOST_NAMES:
        return words.name_first(parts, MOST_NAMES)
    if len(parts) < 2:
        return "".join(parts)
    return _("{names} and {last}", names=", ".join(parts[:-1]), last=parts[-1])


class RouteStep(NamedTuple):
    """One step of what to fix for a route: step `place` of `steps`, the first of which is 1.

    `item_index` is the index of the piece. The chance [-] that the route is blocked is `before` before this step,
    `after` once this step and those before it are taken, `at_last` once all are; at most, where `is_bound`, as
    unconfirmed pieces count as fallen.
    """

    route: str
    item_index: int
    place: int
    steps: int
    before: float
    after: float
    at_last: float
    is_bound: bool = False


def list_steps(routes: RouteTables) -> list[RouteStep]:
    """Return what to fix for every route, step by step."""
    return [
        RouteStep(one.route, fix.item_index, place, len(one.fixes), fix.left + fix.gain, fix.left, one.fixes[-1].left,
                  is_bound=one.blocked_if_unconfirmed_fall is not None)
        for one in routes.routes for place, fix in enumerate(one.fixes, 1)
    ]  # fmt: skip


def say_effect(steps: Sequence[RouteStep]) -> str:
    """Return the effect of steps of one route in their order: ``route West: from 15.5 % to 3.0 % (step 3 of 3)``.

    It is that of all steps where single ones have none, or other steps stand between them.
    """
    first, last = steps[0], steps[-1]

    def say_left(chance: float) -> str:
        said = words.percent(chance)
        return _("up to {chance}", chance=said) if first.is_bound and chance > 0 else said

    values = {"route": words.cut(first.route, 30), "before": say_left(first.before), "steps": first.steps}
    after = say_left(last.after)
    if len(steps) == 1 and (values["before"] != after or first.steps == 1):
        return _("route {route}: from {before} to {after} (step {place:,} of {steps:,})", after=after,
                 place=first.place, **values)  # fmt: skip
    if len(steps) > 1 and values["before"] != after and last.place - first.place + 1 == len(steps):
        return _("route {route}: from {before} to {after} (steps {place:,} to {last:,} of {steps:,})", after=after,
                 place=first.place, last=last.place, **values)  # fmt: skip
    at_last = say_left(first.at_last)
    return _("route {route}: from {before} to {after} (with all {steps:,} steps)", after=at_last, **values)


@dataclass(frozen=True, slots=True)
class Entry:
    """One entry of the schedule: `results` are its pieces, the most urgent first, `steps` the steps of routes in it.

    `together` is the share of all expected falls that it and the entries before it avoid; None where it stands apart.
    """

    row: ScheduleRow
    results: Sequence[ItemResult]
    steps: Sequence[RouteStep]
    together: float | None

    @property
    def names(self) -> str:
        """Its pieces: ``25-07, 25-08 and 25-09 together`` where fixing some of them opens no route."""
        named = join_names(shorten_names(one.item.item for one in self.results))
        return _("{names} together", names=named) if self.row.is_together else named

    @property
    def reason(self) -> str:
        """Why it has its place, apart from its class: its importance, and the effect on its routes."""
        importance = dict.fromkeys(one.item.importance for one in self.results if one.item.importance)
        routes: dict[str, list[RouteStep]] = {}
        for step in self.steps:
            routes.setdefault(step.route, []).append(step)
        names = dict.fromkeys(route for one in self.results for route in one.routes)
        others = [words.cut(route, 30) for route in names if route not in routes]
        beside = ngettext("route {routes}", "routes {routes}", len(others), routes=words.name_first(others, NAMED))
        parts = [*map(_, importance), *map(say_effect, routes.values()), beside if others and not routes else ""]
        return ", ".join(part for part in parts if part) or words.DASH


def list_entries(results: Results, rows: Sequence[ItemResult]) -> list[Entry]:
    """Return the entries of the schedule, the most urgent first; `rows` are all pieces in the order of the results."""
    total, entries = results.schedule.before.falls, []
    steps = sorted(list_steps(results.route_tables), key=lambda step: (step.route, step.place))
    for row in results.schedule.rows:
        pieces = [rows[at] for at in row.item_indices]
        share = 1 - row.falls_left / total if total else 0.0
        own = [step for step in steps if step.item_index in row.item_indices]
        entries.append(Entry(row, pieces, own, None if pieces[0].apart else share))
    return entries


@dataclass(frozen=True, slots=True)
class Work:
    """The work on identical pieces of a room, as a part of an entry; `results` are these pieces."""

    entry: Entry
    row: WorkRow
    results: Sequence[ItemResult]

    @property
    def is_first(self) -> bool:
        """Whether it is the most urgent part of its entry, with which the effect of the whole entry stands."""
        return self.row is self.entry.row.works[0]

    @property
    def names(self) -> str:
        """Its pieces in short."""
        named = join_names(shorten_names(self.row.items))
        return _("{names} together", names=named) if self.entry.row.is_together and len(self.row.items) > 1 else named

    @property
    def described(self) -> str:
        """Their description, else their type."""
        item = self.results[0].item
        return item.description or item.type or _("no description")

    @property
    def chance(self) -> str:
        """The chance of overturning of each piece, from the least to the largest."""
        return _keep(words.percents([one.adopted.probability for one in self.results]))

    @property
    def reason(self) -> str:
        """The reason of its entry, and the other pieces without which it does not help."""
        others = [one for one in self.entry.row.works if one is not self.row]
        texts = [self.entry.reason] if self.is_first and self.entry.reason != words.DASH else []
        if others and self.entry.row.is_together:
            named = join_names(shorten_names(name for one in others for name in one.items))
            texts.append(_("only together with {names}", names=named))
        texts += dict.fromkeys(filter(None, map(words.say_bracket, self.results)))
        return _keep("; ".join(texts)) or words.DASH

    @property
    def marks(self) -> str:
        """The marks of what its forces rest on."""
        marks = {WEIGHT: self.row.weights_assumed, HEIGHT: self.row.heights_assumed, METRE: self.row.is_per_metre}
        return ", ".join(mark for mark, is_there in marks.items() if is_there)


def _keep(text: str) -> str:
    """Return a text in which no line breaks before a percent sign."""
    return text.replace(" %", f"{words.NO_BREAK}%")


def list_work(entries: Sequence[Entry], floors: Sequence[str]) -> list[Work]:
    """Return the work of entries, which are by urgency, by `floors`, room by room, and there by urgency."""
    rank = {floor: at for at, floor in enumerate(floors)}
    by_index = {one.item.index: one for entry in entries for one in entry.results}
    works = [
        Work(entry, row, [by_index[at] for at in row.item_indices]) for entry in entries for row in entry.row.works
    ]
    works.sort(key=lambda one: (rank[one.row.floor], not one.row.room, natural_key(one.row.room), one.entry.row.place))
    return works


def say_fixings(work: WorkRow) -> int | str:
    """Return how many fixings a piece needs; with a mark where that is the least, as no capacity is printed."""
    return f"{work.fixings}{LEAST}" if work.is_least else work.fixings


def say_force(force: float | None) -> str:
    """Return a force [kN] as a number in the reader's unit, kN or lb, a dash for what is not known."""
    return words.DASH if force is None else measures.show(force, "kN")


def say_cost(cost: float | None, currency: str = "") -> str:
    """Return a cost with the ISO code of its currency, as far as the workbook names one: ``1,530 EUR``."""
    if cost is None:
        return words.DASH
    amount = number(cost, ",.0f" if cost == round(cost) else ",.2f")
    return f"{amount}{words.NO_BREAK}{currency}" if currency else amount


def say_code(results: Results) -> str:
    """Return a sentence on the force that a code asks of anchors, and what is assumed; "" where no code applies."""
    chosen = results.settings
    named = {"q": chosen.anchor_behaviour, "gamma": chosen.anchor_importance, "period": chosen.anchor_period}
    texts = {
        "ASCE 7-22": _("F_p of ASCE 7-22, 13.3.1"),
        "EN 1998-1": _("F_a of EN 1998-1, 4.3.5.2, with q_a {q:g}, γ_a {gamma:g} and T_a {period:g} s (assumed; not "
                       "checked against the code's own text)", **named),
        "NTC 2018": _("F_a of NTC 2018, 7.2.3, with S_a and q_a of EN 1998-1, 4.3.5.2: q_a {q:g} and T_a {period:g} s "
                      "(assumed; EN 1998-1 not checked against its own text)", **named),
    }  # fmt: skip
    force = texts.get(results.provenance.anchor_code, "")
    return _("By code: {force}.", force=force) if force else ""


SCREENING = fill("screening, not design")
CHECKS = fill("Forces are for screening, not design: a structural engineer checks wall, fixings and the body of each "
              "piece.")  # fmt: skip
HOLDS = fill("its own weight holds it at 84 % of PFA; fixings against sliding or for the rest")
"""What a tension of 0 at 84 % of PFA means."""
DISAGREEMENT = fill("Sources disagree on rigid brackets: the Tokyo Fire Department holds L-brackets that are screwed "
                    "to the wall to be the most effective device; the Earthquake Country Alliance advises flexible "
                    "straps to two studs instead.")  # fmt: skip


def say_effect_of_all(schedule: Schedule) -> list[str]:
    """Return what the whole schedule changes, and what it costs; nothing where there is nothing to fix."""
    planned = schedule.planned
    if not planned:
        return []
    before, after = (
        words.say_falls(one.falls, one.falls_low, one.falls_high) for one in (schedule.before, schedule.after)
    )
    effect = ngettext("Phases A and B fix {n:,} piece and lower the expected falls from {before} to {after}, if all "
                      "anchors hold.",
                      "Phases A and B fix {n:,} pieces and lower the expected falls from {before} to {after}, if all "
                      "anchors hold.", sum(one.pieces for one in planned), before=before, after=after)  # fmt: skip
    if schedule.cost is None:
        costs = _("No cost is given: unit costs are read from the sheet {sheet} of the workbook.", sheet=_("Costs"))
        return [effect, costs]
    costs = _("The costs that the workbook gives sum to {cost}.", cost=say_cost(schedule.cost, schedule.currency))
    if schedule.uncosted:
        costs += " " + ngettext("{n:,} entry has a part without a cost.", "{n:,} entries have a part without a cost.",
                                schedule.uncosted)  # fmt: skip
    return [effect, costs]


def say_doubtful_brackets(rows: Iterable[ItemResult]) -> list[str]:
    """Return which pieces count as anchored by brackets that fail at 84 % of PFA or by the code; nothing if none."""
    found = sorted(filter(words.has_doubtful_bracket, rows), key=lambda one: natural_key(one.item.item))
    return [ngettext(
        "{n:,} anchored piece has a bracket that fails at 84 % of PFA or by the code: {names}.",
        "{n:,} anchored pieces have brackets that fail at 84 % of PFA or by the code: {names}.",
        count_pieces(found),
        names=words.name_pieces([one.item.item for one in found], MOST_NAMES, 40),
    )] if found else []  # fmt: skip


def list_marks(schedule: Schedule) -> list[str]:
    """Return what the marks of forces mean, and how many pieces have each; nothing of one that none has."""
    works = [work for row in schedule.rows for work in row.works]
    total = sum(one.pieces for one in works)
    weights, heights = sum(one.weights_assumed for one in works), sum(one.heights_assumed for one in works)
    metres = sum(one.pieces for one in works if one.is_per_metre)
    texts = {
        WEIGHT: ngettext("weight assumed, for {some:,} of {n:,} piece", "weight assumed, for {some:,} of {n:,} pieces",
                         total, some=weights) if weights else "",
        HEIGHT: ngettext("bracket height assumed, 0.9 of the piece's height, for {some:,} of {n:,} piece",
                         "bracket height assumed, 0.9 of the piece's height, for {some:,} of {n:,} pieces",
                         total, some=heights) if heights else "",
        METRE: ngettext("forces and fixings of one metre of the width, which is not known, for {some:,} of {n:,} piece",
                        "forces and fixings of one metre of the width, which is not known, for {some:,} of {n:,} "
                        "pieces", total, some=metres) if metres else "",
    }  # fmt: skip
    if any(one.is_least for one in works):
        texts[f"{LEAST_FIXINGS}{LEAST}"] = _("at least {n}, as no capacity is printed", n=LEAST_FIXINGS)
    return [f"{mark}: {text}." for mark, text in texts.items() if text]


# ---------------------------------------------------------------- the plan


def say_effort(phase: PhaseRow, schedule: Schedule) -> str:
    """Return what a phase costs; where no cost is given its work, by assumed hours of one person."""
    if schedule.cost is not None:
        cost = say_cost(phase.cost, schedule.currency)
        return _("at least {cost}", cost=cost) if phase.uncosted and phase.cost is not None else cost
    if phase.hours < A_DAY:
        return ngettext("about {n:,} hour", "about {n:,} hours", max(1, round(phase.hours)))
    return ngettext("about {n:,} working day", "about {n:,} working days", round(phase.hours / A_DAY))


def name_places(schedule: Schedule, phase: str, most: int = 2) -> str:
    """Return the rooms in which a phase takes most falls away, ``Library (42)``."""
    avoided: dict[tuple[str, str], float] = {}
    for one in schedule.rows:
        if one.phase == phase:
            avoided[one.floor, one.room] = avoided.get((one.floor, one.room), 0.0) + one.falls_avoided
    ordered = sorted(avoided, key=lambda place: -avoided[place])
    names = [
        f"{words.cut(room, 24)} ({words.cut(floor, 8)})" if room else _("floor {floor}", floor=words.cut(floor, 12))
        for floor, room in ordered
    ]
    return words.name_first(names, most)


def say_checks(schedule: Schedule) -> str:
    """Return how many anchors are to be checked and pieces to be parked, in one sentence; "" for none."""
    counted = {key: sum(one.pieces for one in schedule.checks if (one.works[0].detail == CHECK) == key)
               for key in (True, False)}  # fmt: skip
    texts = [
        ngettext("check the anchors of {n:,} piece", "check the anchors of {n:,} pieces", counted[True])
        if counted[True] else "",
        ngettext("lock or park {n:,} piece that rolls", "lock or park {n:,} pieces that roll", counted[False])
        if counted[False] else "",
    ]  # fmt: skip
    return "; ".join(filter(None, texts))


class Change(NamedTuple):
    """One number of the building before and after the schedule; `decimals` is how it is shown."""

    label: str
    before: float
    after: float
    decimals: int = 0


def list_states(states: Sequence[State]) -> list[tuple[str, list[float], int]]:
    """Return what is to be expected of the building in some states: each number with its label and decimals."""
    own = [
        {one.label: one for part in list_changes(replace(NOTHING, before=states[0], after=state)) for one in part}
        for state in states
    ]
    known = {label: one for changes in own for label, one in changes.items()}
    return [
        (label, [changes[label].after if label in changes else 0.0 for changes in own], one.decimals)
        for label, one in known.items()
    ]


def list_changes(schedule: Schedule) -> tuple[list[Change], list[Change]]:
    """Return what the schedule changes: falls and pieces by class; routes by state and rooms that lose every exit."""
    before, after, fields = schedule.before, schedule.after, schedule_fields(State)

    def change(key: str, decimals: int = 0) -> Change:
        return Change(fields[key].heading(), fields[key].read(before), fields[key].read(after), decimals)

    pieces = [
        change("falls", 2),
        *(Change(_("Pieces: {risk}", risk=words.risk_label(risk)), before.count(risk), after.count(risk))
          for risk in reversed(RiskClass)),
        *([change("pieces_apart")] if before.apart else []),
        change("pieces_anchored"),
    ]  # fmt: skip
    counts, later = dict(before.routes), dict(after.routes)
    states = [*dict.fromkeys((*counts, *later))]
    if not states:
        return pieces, []
    left_out = (change("unknown_routes"), change("unknown_rooms"))
    return pieces, [
        *(Change(_("Routes: {state}", state=_(one)), counts.get(one, 0), later.get(one, 0)) for one in states),
        change("blocked_routes_expected", 2),
        change("cut_off_rooms_expected", 2),
        *(one for one in left_out if one.before or one.after),
        Change(fields["rooms_at_risk"].heading(), len(before.rooms_at_risk), len(after.rooms_at_risk)),
    ]
