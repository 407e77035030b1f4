"""What to fix, in which order and with what; and what is to be expected before and after.

Its entries are pieces, alike pieces of one room, and pieces that only help a route together. What comes after is not
simulated again: the draws of the run are evaluated with the pieces of the schedule held, as a run with these pieces
anchored would.
"""

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from itertools import accumulate

from assess.details import AT_BASE, AT_WALL, DETAILS, count_fixings, find_detail
from assess.model import Cost, Inventory
from assess.results import ItemResult, ItemRow, Results, count_pieces, sum_falls
from assess.risk import RiskClass, find_ends
from assess.route_results import RouteRow, RouteState, RouteTables
from assess.schedule_results import Schedule, ScheduleRow, State, WorkRow
from assess.text import natural_key

APART = ("", "unconfirmed", "formula")
"""The bases in the order of lists: that of the run, and what stands apart."""
NO_FALLS = 1e-12
"""Expected number of falls below which what is left is that of rounding, and 0."""
FILES = ("vertical file", "lateral file", "file cabinet", "filing cabinet", "schedario", "classificatore")
"""Words of a description or type, in every language of the workbook, by which a piece is fixed at its base."""


def build_schedule(
    results: Results, inventory: Inventory, evaluate: Callable[[Collection[int]], RouteTables]
) -> Schedule:
    """Return the schedule of a run; `evaluate` returns its routes with further pieces (indices) held."""
    rows = tuple(results)
    entries = list_entries(rows, results.route_tables.routes)
    avoided = [sum(map(count_falls, one)) for one in entries]
    total = sum(count_falls(one) for one in rows if not one.is_anchored)
    left = list(accumulate(avoided, lambda falls, one: falls - one if falls - one >= NO_FALLS else 0.0, initial=total))
    found = ((find_detail(one.detail), one) for one in inventory.costs)
    costs = {detail.key: one for detail, one in found if detail}
    together = _list_together(results.route_tables.routes)
    held = {one.item.index for entry in entries for one in entry}
    described = []
    for place, entry in enumerate(entries, 1):
        indices, alike = tuple(one.item.index for one in entry), dict[object, list[ItemResult]]()
        for one in entry:
            alike.setdefault(_kind(one), []).append(one)
        row = ScheduleRow(
            place=place, floor=entry[0].item.floor, room=entry[0].item.room, item_indices=indices,
            pieces=count_pieces(entry), is_together=any(len(one & set(indices)) > 1 for one in together),
            works=tuple(_describe_work(own, costs) for own in alike.values()),
            falls_avoided=avoided[place - 1], falls_left=left[place],
        )  # fmt: skip
        described.append(row)
    return Schedule(
        rows=tuple(described),
        before=_sum_up(rows, results.route_tables, ()),
        after=_sum_up(rows, evaluate(held) if held else results.route_tables, held),
    )


def count_falls(one: ItemResult) -> float:
    """Return the expected number of falls of a row, 0 where it stands apart from the run's basis."""
    return 0.0 if one.apart else one.adopted.probability * one.item.quantity


def list_entries(rows: Sequence[ItemResult], routes: Sequence[RouteRow]) -> list[list[ItemResult]]:
    """Return the pieces of each entry of the schedule, in its order.

    Those that only help together, and alike ones of one room, stand in one. It stands where the first of its pieces
    does.
    """
    chosen = fix_first(rows, {fix.item_index for route in routes for fix in route.fixes})
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


def fix_first(results: Iterable[ItemResult], needed: Collection[int] = ()) -> list[ItemResult]:
    """Return the free-standing pieces of at least medium class and those that a route needs fixed, in order.

    `needed` are the indices of the latter. Sorted by basis, so that those that stand apart come last, then by whether
    the upper class is high or above, then life safety and routes, then the upper class, then probability times
    quantity, then name. So a piece of low class that a route needs comes after the urgent pieces of medium class and
    before those that are not urgent.
    """
    chosen = [
        one
        for one in results
        if not one.is_anchored and (one.adopted.upper >= RiskClass.MEDIUM or one.item.index in needed)
    ]
    return sorted(
        chosen,
        key=lambda one: (
            APART.index(one.apart),
            one.adopted.upper < RiskClass.HIGH,
            not one.is_urgent,
            -one.adopted.upper,
            -one.adopted.probability * one.item.quantity,
            natural_key(one.item.item),
        ),
    )


def _kind(one: ItemResult) -> tuple[object, ...]:
    """Return what alike pieces of one room share; a piece without a room is like no other."""
    item, adopted = one.item, one.adopted
    room = item.room or item.index
    sizes = (item.breadth_cm, item.width_cm, item.height_cm, item.anchor.tension_high_kn)
    bracket = (item.anchored, item.anchor.holds, item.anchor.holds_high) if item.anchor.holds is not None else ()
    described = item.floor, room, item.type, item.description, choose_detail(item), sizes, bracket
    return *described, item.importance, one.apart, adopted.upper, one.routes


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
    carries the whole horizontal force, k W: that of the tension without the help of the weight, k W z/h.
    """
    first, rows = alike[0].item, [one.item for one in alike]
    detail = DETAILS[choose_detail(first)]
    pieces, cost = sum(one.quantity for one in rows), costs.get(detail.key)
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
    return WorkRow(
        floor=first.floor, room=first.room,
        items=tuple(one.item for one in rows),
        item_indices=tuple(one.index for one in rows),
        pieces=pieces, detail=detail.key, tension_kn=max(tension), tension_high_kn=max(high), tension_code_kn=code,
        shear_kn=max(shear), fixings=count_fixings(detail, 1000 * max(*high, code or 0.0)),
        weights_assumed=sum(one.quantity for one in rows if one.anchor.weight_source == "estimate"),
        heights_assumed=0 if detail.is_at_base else sum(one.quantity for one in rows if one.anchor.is_height_assumed),
        is_per_metre=any(one.anchor.is_per_metre for one in rows),
        unit_cost=None if cost is None else cost.unit_cost,
        cost=None if cost is None else pieces * cost.unit_cost,
        cost_source="" if cost is None else cost.source,
    )  # fmt: skip


def choose_detail(item: ItemRow) -> str:
    """Return the generic detail for a piece: at the base where it stands free of walls or is a filing cabinet."""
    named = f"{item.type} {item.description}".casefold()
    if item.against_wall is False or any(word in named for word in FILES):
        return AT_BASE
    return AT_WALL


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
