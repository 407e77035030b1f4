"""What to fix, in which phase and order and with what; and what is to be expected before and after.

Its entries are pieces, alike pieces of one room, and pieces that only help a route together. What comes after is not
simulated again: the draws of the run are evaluated with the pieces of the schedule held, as a run with these pieces
anchored would.

The phases are by rule (`PHASE_RULE`). Anchored pieces whose anchor is not known to hold are listed to be checked, and
pieces that roll to be parked; what that avoids is in no sum.
"""

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

from assess.details import AT_BASE, AT_WALL, DETAILS, count_fixings, find_detail
from assess.i18n import fill
from assess.model import Cost, Inventory
from assess.pipeline.anchors import WHAT_IF
from assess.results import ROLLS, ItemResult, ItemRow, Results, count_pieces, sum_falls
from assess.risk import RiskClass, find_ends
from assess.route_results import BLOCKED_FROM, RouteFixRow, RouteRow, RouteState, RouteTables
from assess.schedule_results import PHASES, PhaseRow, Schedule, ScheduleRow, State, WorkRow
from assess.text import natural_key

APART = ("", "unconfirmed", "formula", ROLLS)
"""The bases in the order of lists: that of the run, and what stands apart."""
NO_FALLS = 1e-12
"""Expected number of falls below which what is left is that of rounding, and 0."""
FILES = ("vertical file", "lateral file", "file cabinet", "filing cabinet", "schedario", "classificatore")
"""Words of a description or type, in every language of the workbook, by which a piece is fixed at its base."""
ENOUGH, LITTLE = 0.8, 0.1
"""Share of the falls that all entries avoid that phase A reaches; falls below which one is not worth it. Assumed."""
PHASE_RULE = fill(
    "A: what a blocked way out needs, life-safety pieces of high class or above (upper estimate), and the entries of "
    "the highest class until A avoids {enough:.0f} % of the falls that all entries avoid. C: other entries of low "
    "class, or of medium class that avoid less than {little:g} falls, unless they open a way out or are of life "
    "safety. B: the rest. Within a phase: by class (upper estimate), then life safety, then the falls that fixing "
    "avoids.",
    enough=100 * ENOUGH, little=LITTLE,
)  # fmt: skip
"""How entries are put into phases, for reports."""
_A, _B, _C = PHASES
CLEAR = "clear"
"""The detail that fixes nothing: such a piece is out of the way, but may still fall."""


class Planned(NamedTuple):
    """The pieces of an entry, the most urgent first, with its phase and what it avoids; at most, of what is apart."""

    phase: str
    pieces: list[ItemResult]
    avoided: float
    at_most: float


def build_schedule(
    results: Results, inventory: Inventory, evaluate: Callable[[Collection[int]], RouteTables]
) -> Schedule:
    """Return the schedule of a run; `evaluate` returns its routes with further pieces (indices) held."""
    rows, tables = tuple(results), results.route_tables
    planned, checked = plan(rows, tables.routes), plan_checks(rows, tables.routes)
    found = ((find_detail(one.detail), one) for one in inventory.costs)
    costs = {detail.key: one for detail, one in found if detail}
    together = _list_together(tables.routes)
    left = sum(count_falls(one) for one in rows if not one.is_anchored)
    described = []
    for place, entry in enumerate((*planned, *checked), 1):
        left = left - entry.avoided if left - entry.avoided >= NO_FALLS else 0.0
        indices, alike = tuple(one.item.index for one in entry.pieces), dict[object, list[ItemResult]]()
        for one in entry.pieces:
            alike.setdefault(_kind(one), []).append(one)
        first = entry.pieces[0].item
        row = ScheduleRow(
            place=place, phase=entry.phase, floor=first.floor, room=first.room, item_indices=indices,
            pieces=count_pieces(entry.pieces), is_together=any(len(one & set(indices)) > 1 for one in together),
            works=tuple(_describe_work(own, costs) for own in alike.values()), falls_avoided=entry.avoided,
            falls_left=left, falls_at_most=entry.at_most,
        )  # fmt: skip
        described.append(row)
    fixes, checks = tuple(described[: len(planned)]), tuple(described[len(planned) :])
    before = after = _sum_up(rows, tables, ())
    phases, held, last = [], set[int](), sum(count_falls(one) for one in rows if not one.is_anchored)
    for phase in PHASES:
        own = [one for one in fixes if one.phase == phase]
        if not own:
            continue
        if phase != _C:
            held.update(index for one in own for index in one.item_indices)
            fixed = {at for at in held if choose_detail(results.item_rows[at]) != CLEAR}
            after, last = _sum_up(rows, evaluate(frozenset(held)), fixed), own[-1].falls_left
        priced = [work.cost for one in own for work in one.works if work.cost is not None]
        places = {(work.floor, work.room or work.items) for one in own for work in one.works}
        row_of_phase = PhaseRow(
            phase=phase, entries=len(own), pieces=sum(one.pieces for one in own), places=len(places),
            falls_avoided=sum(one.falls_avoided for one in own), falls_left=last,
            cost=sum(priced) if priced else None, uncosted=sum(one.cost is None for one in own),
            hours=sum(one.hours for one in own), after=after,
        )  # fmt: skip
        phases.append(row_of_phase)
    currency = next((one.currency for one in inventory.costs), "")
    return Schedule(rows=fixes, before=before, after=after, checks=checks, phases=tuple(phases), currency=currency)


def plan(rows: Sequence[ItemResult], routes: Sequence[RouteRow]) -> list[Planned]:
    """Return the entries of the schedule by `PHASE_RULE`: by phase, upper class, life safety, and what each avoids."""
    entries = [
        Planned(_B, one, *(sum(_count_avoided(each) for each in one if bool(each.apart) == at) for at in (False, True)))
        for one in _group_entries(rows, routes)
    ]
    entries.sort(key=lambda one: -one.avoided - one.at_most)
    entries.sort(key=lambda one: (
        APART.index(one.pieces[0].apart), -max(each.adopted.upper for each in one.pieces),
        not any(map(_is_safety, one.pieces)),
    ))  # fmt: skip
    opening = {fix.item_index for one in routes for fix in one.fixes}
    blocked = [one for one in routes if one.state == RouteState.BLOCKED and one.is_fixed]
    urgent = {fix.item_index for one in blocked for fix in one.fixes if _is_still_blocked(one, fix)}
    total = sum(one.avoided for one in entries)

    def is_needed(one: Planned) -> bool:
        is_dangerous = (_is_safety(each) and each.adopted.upper >= RiskClass.HIGH for each in one.pieces)
        return any(is_dangerous) or not urgent.isdisjoint(each.item.index for each in one.pieces)

    def is_poor(one: Planned) -> bool:
        highest = max(each.adopted.risk for each in one.pieces)
        has_few = highest == RiskClass.LOW or (highest == RiskClass.MEDIUM and one.avoided < LITTLE)
        return has_few and not any(each.apart or each.item.index in opening or _is_safety(each) for each in one.pieces)

    reached, phased = sum(one.avoided for one in entries if is_needed(one)), []
    for one in entries:
        phase = _A if is_needed(one) else _C if is_poor(one) else _B
        is_first = phase != _A and not one.pieces[0].apart and reached < ENOUGH * total - NO_FALLS
        if is_first and max(each.adopted.risk for each in one.pieces) >= RiskClass.MEDIUM:
            phase, reached = _A, reached + one.avoided
        phased.append(one._replace(phase=phase))
    return sorted(phased, key=lambda one: one.phase)


def plan_checks(rows: Sequence[ItemResult], routes: Sequence[RouteRow]) -> list[Planned]:
    """Return entries of pieces to check: anchored ones whose anchor is not known to hold, and those that roll.

    Of anchored ones those of at least medium class if they stood free. Phase A: those of high class then, of life
    safety, or on a route; of pieces that roll the last two.
    """
    opening = {fix.item_index for one in routes for fix in one.fixes}
    groups: dict[object, list[ItemResult]] = {}
    for one in rows:
        anchor, is_anchored = one.item.anchor, one.is_anchored and not one.item.more.get(WHAT_IF)
        is_open = anchor.holds is not True or False in (anchor.holds_high, anchor.holds_code)
        if (is_anchored and is_open and one.adopted.upper >= RiskClass.MEDIUM) or _rolls(one):
            groups.setdefault(_kind(one), []).append(one)
    found = []
    for own in groups.values():
        is_high = not _rolls(own[0]) and any(one.adopted.upper >= RiskClass.HIGH for one in own)
        is_near = any(_is_safety(one) or one.routes or one.item.index in opening for one in own)
        found.append(Planned(_A if is_high or is_near else _B, own, 0.0, sum(map(_count_at_most, own))))
    return sorted(found, key=lambda one: (one.phase, _rolls(one.pieces[0]), -one.at_most))


def _is_still_blocked(one: RouteRow, fix: RouteFixRow) -> bool:
    """Return whether a route is blocked before a step; always, where it is so by the recorded motion alone."""
    is_by_chance = one.blocked is not None and one.blocked.probability >= BLOCKED_FROM
    return fix.left + fix.gain >= BLOCKED_FROM or not is_by_chance


def _rolls(one: ItemResult) -> bool:
    return one.apart == ROLLS and not one.is_anchored


def _is_safety(one: ItemResult) -> bool:
    return one.item.importance == "life safety"


def _count_at_most(one: ItemResult) -> float:
    return one.adopted.probability * one.item.quantity


def _count_avoided(one: ItemResult) -> float:
    """Return how many falls fixing a row avoids: none of what is only kept out of the way."""
    return 0.0 if choose_detail(one.item) == CLEAR else _count_at_most(one)


def count_falls(one: ItemResult) -> float:
    """Return the expected number of falls of a row, 0 where it stands apart from the run's basis."""
    return 0.0 if one.apart else _count_at_most(one)


def list_entries(rows: Sequence[ItemResult], routes: Sequence[RouteRow]) -> list[list[ItemResult]]:
    """Return the pieces of each entry of the schedule, in its order."""
    return [one.pieces for one in plan(rows, routes)]


def _group_entries(rows: Sequence[ItemResult], routes: Sequence[RouteRow]) -> list[list[ItemResult]]:
    """Return the pieces of each entry, the most urgent first: free ones of at least medium class, or that a way needs.

    Those that only help together, and alike ones of one room, stand in one entry.
    """
    needed = {fix.item_index for route in routes for fix in route.fixes}
    free = (one for one in rows if not (one.is_anchored or one.apart == ROLLS))
    chosen = [one for one in free if one.adopted.upper >= RiskClass.MEDIUM or one.item.index in needed]
    chosen.sort(key=lambda one: (-one.adopted.upper, -_count_at_most(one), natural_key(one.item.item)))
    leader = {one.item.index: one.item.index for one in chosen}

    def find(index: int) -> int:
        while leader[index] != index:
            index = leader[index]
        return index

    kinds: dict[tuple[object, ...], int] = {}
    for one in chosen:
        first = kinds.setdefault(_kind(one), one.item.index)
        leader[find(one.item.index)] = find(first)
    for joined in _list_together(routes):
        own = sorted(joined & leader.keys())
        for index in own[1:]:
            leader[find(index)] = find(own[0])
    entries: dict[int, list[ItemResult]] = {}
    for one in chosen:
        entries.setdefault(find(one.item.index), []).append(one)
    return list(entries.values())


def _kind(one: ItemResult) -> tuple[object, ...]:
    """Return what alike pieces of one room share; a piece without a room is like no other."""
    item, adopted = one.item, one.adopted
    room = item.room or item.index
    sizes = (item.breadth_cm, item.width_cm, item.height_cm, item.anchor.tension_high_kn)
    bracket = (item.anchored, item.anchor.holds, item.anchor.holds_high) if item.anchor.holds is not None else ()
    described = item.floor, room, item.type, item.description, choose_detail(item), sizes, bracket
    return *described, item.importance, one.is_anchored, one.apart, adopted.upper, one.routes


def _list_together(routes: Sequence[RouteRow]) -> list[frozenset[int]]:
    """Return the sets of pieces that only help together: steps without effect, up to the one that has some."""
    found = []
    for route in routes:
        waiting: list[int] = []
        for step in route.fixes:
            waiting.append(step.item_index)
            if step.gain > 0:
                found.append(frozenset(waiting))
                waiting = []
    return [one for one in found if len(one) > 1]


def _describe_work(alike: Sequence[ItemResult], costs: Mapping[str, Cost]) -> WorkRow:
    """Return the work on alike pieces: the largest forces that their fixings have to carry.

    Moments about the toe give the tension at the bracket; at the base the same moment acts on the breadth, and the base
    carries the whole horizontal force, k W: that of the tension without the help of the weight, k W z/h. An anchor that
    is to be checked or completed has the forces and fixings of the detail that its type would have.
    """
    first, rows = alike[0].item, [one.item for one in alike]
    detail = DETAILS[choose_detail(first)]
    done = (
        "check" if first.is_held else "complete" if first.anchored in ("yes", "partly") and detail.least else detail.key
    )
    pieces, cost = sum(one.quantity for one in rows), costs.get(done)
    tension, high, codes, shear = [], [], [], []
    for one in rows:
        anchor = one.anchor
        lever = anchor.bracket_height_cm / one.breadth_cm if detail.is_at_base else 1.0
        whole = anchor.tension_without_weight_kn * anchor.bracket_height_cm / (one.centre_of_gravity * one.height_cm)
        tension.append(anchor.tension_kn * lever)
        high.append(anchor.tension_high_kn * lever)
        codes += [] if anchor.tension_code_kn is None else [anchor.tension_code_kn * lever]
        shear.append(whole if detail.is_at_base else anchor.shear_kn)
    code = max(codes, default=None)
    fixings = count_fixings(detail, 1000 * max(*high, code or 0.0))
    return WorkRow(
        floor=first.floor, room=first.room, items=tuple(one.item for one in rows),
        item_indices=tuple(one.index for one in rows), pieces=pieces, detail=done, like=detail.key,
        tension_kn=max(tension), tension_high_kn=max(high), tension_code_kn=code, shear_kn=max(shear), fixings=fixings,
        weights_assumed=sum(one.quantity for one in rows if one.anchor.weight_source == "estimate"),
        heights_assumed=0 if detail.is_at_base else sum(one.quantity for one in rows if one.anchor.is_height_assumed),
        is_per_metre=any(one.anchor.is_per_metre for one in rows),
        unit_cost=None if cost is None else cost.unit_cost,
        cost=None if cost is None else pieces * cost.unit_cost * (fixings if cost.per == "fixing" else 1),
        cost_per="" if cost is None else cost.per,
        cost_source="" if cost is None else cost.source, hours=pieces * DETAILS[done].hours,
    )  # fmt: skip


def choose_detail(item: ItemRow) -> str:
    """Return the generic detail for a piece: that of its type, else a bracket, or at the base of a filing cabinet.

    What stands free of walls is held at its base instead of at a wall, what stands on castors at neither.
    """
    named = f"{item.type} {item.description}".casefold()
    detail = item.fix_by or (AT_BASE if any(word in named for word in FILES) else AT_WALL)
    if detail in (AT_WALL, AT_BASE, "strap") and item.mobile:
        return "castors"
    return AT_BASE if detail in (AT_WALL, "strap") and item.against_wall is False else detail


def _sum_up(rows: Sequence[ItemResult], routes: RouteTables, held: Collection[int]) -> State:
    free = [one for one in rows if not (one.is_anchored or one.item.index in held)]
    counted = [one for one in free if not one.apart]
    classes = Counter[RiskClass]()
    for one in counted:
        classes[one.adopted.risk] += one.item.quantity
    states = Counter(one.state for one in routes.routes)
    low, high = find_ends(sum_falls(counted))
    return State(
        falls=sum(map(count_falls, counted)), falls_low=low, falls_high=high,
        apart=count_pieces(one for one in free if one.apart),
        classes=tuple(classes[risk] for risk in RiskClass),
        anchored=count_pieces(rows) - count_pieces(free),
        routes=tuple((str(state), states[state]) for state in RouteState if states[state]),
        blocked_routes=routes.blocked_routes_expected, cut_off_rooms=routes.cut_off_rooms_expected,
        rooms_at_risk=tuple(list_rooms_at_risk(routes)), unknown_routes=routes.unknown_routes,
        unknown_rooms=routes.unknown_rooms,
    )  # fmt: skip


def list_rooms_at_risk(routes: RouteTables) -> Iterator[str]:
    """Yield the rooms whose best way to the street is not open, those last that no segment joins to one."""
    for room in routes.rooms:
        if room.state != RouteState.OPEN:
            yield room.room
    yield from routes.unjoined_rooms
