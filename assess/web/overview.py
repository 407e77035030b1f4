"""The overview: what is to be expected of the building, where, and what to do first, in the words of the reports."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import TYPE_CHECKING, Any

from assess.errors import AssessError
from assess.i18n import gettext
from assess.pipeline.adopt import Assessment
from assess.pipeline.run import build_results, compute, evaluate_route_tables
from assess.progress import SILENT
from assess.report import words
from assess.report.content import Content
from assess.report.say.ground import say_ground
from assess.report.say.outcome import say_outcome
from assess.report.say.piece import describe, find_kind, list_apart, say_apart
from assess.results import ItemResult, Results, count_pieces
from assess.risk import RiskClass
from assess.route_results import RouteState
from assess.routes.evaluate import KeptRoutes
from assess.settings import Settings
from assess.web.evaluation import AS_RUN, Evaluation, copy_kept, evaluate, list_floors, tabulate_routes
from assess.web.live import describe_failure
from assess.web.route_states import describe_states, describe_unknown
from assess.workbook.names import key
from assess.workbook.parse import Tables

if TYPE_CHECKING:
    from assess.web.snapshot import Snapshot

BY_FORMULA = Settings(verify="none")
"""How it is worked out until all is simulated."""
MOST = 5
"""Pieces and entries of what to fix that it names."""
MOST_ROOMS = 4
"""Rooms that it names of each floor."""
STATES = tuple(one.name.lower() for one in sorted(RouteState, key=lambda one: -one.severity))
"""How the page calls the states of routes and rooms, the worst first."""


def describe_overview(snapshot: "Snapshot") -> dict[str, Any]:
    """Return the answer of `GET /api/overview`, in the language in use."""
    stamp, found, fault = snapshot.stamp, Evaluation(None, frozenset(), ()), ""
    try:
        found = evaluate(snapshot)
        fault = describe_failure(snapshot.problems, found)
    except AssessError as error:
        fault = gettext(error.message)
    settings, assessment = AS_RUN, found.assessment
    if assessment is not None and found.simulation.state in ("running", "waiting"):
        inventory, settings = assessment.inventory, BY_FORMULA  # sums of pieces of both kinds would mean nothing
        found = replace(found, assessment=snapshot.keep("by formula", lambda: compute(inventory, BY_FORMULA)))
        assessment = found.assessment
    answer = {
        "version": snapshot.version, "stamp": stamp, "basis": "", "error": fault,
        "floors": _list_floors(snapshot.tables), "ways": _describe_ways(snapshot, found, settings),
    }  # fmt: skip
    if assessment is None:
        return answer
    routes, kept = tabulate_routes(snapshot, found, settings), copy_kept(snapshot, settings)
    results = snapshot.keep(
        ("results", settings), lambda: build_results(assessment, figures=False, routes=routes, kept=kept), found.arrived
    )
    left: Sequence[Mapping[str, int] | None] = ()
    if settings == AS_RUN:
        left = snapshot.keep("left", lambda: _count_left(assessment, results, kept), found.arrived)
    return {**answer, "basis": results.main_basis, **describe_results(results, left)}


def describe_results(results: Results, left: Sequence[Mapping[str, int] | None] = ()) -> dict[str, Any]:
    """Return what is to be expected of a building; `left` are the routes by state once each of the first is fixed."""
    content = Content(results)
    total, rows = content.total, content.results
    worst = [*list_apart(rows, ""), *list_apart(rows, "unconfirmed"), *list_apart(rows, "formula")]
    counts = {risk.name.lower(): total.by_class[risk] for risk in RiskClass}
    ways, after = left or [None] * MOST, results.schedule.after
    return {
        "outcome": say_outcome(total, results.route_tables),
        "about": [*filter(None, [say_ground(results, shortly=True)]), *say_apart(rows), *total.say_cannot_rock()],
        "counts": {**counts, "unconfirmed": total.unconfirmed, "formula": total.by_formula, "rolls": total.rolls,
                   "anchored": total.anchored},
        "falls": [total.expected, total.falls_low, total.falls_high],
        "worst": [{**_describe_piece(alike[0]), "item": words.name_pieces([one.item.item for one in alike], 2),
                   "pieces": count_pieces(alike)} for alike in islice(_group(worst), MOST)],
        "fixes": [
            {**_describe_piece(one.results[0]), "item": one.names, "rows": [each.item.row for each in one.results],
             "pieces": one.row.pieces, "why": one.reason, "falls_left": one.row.falls_left, "ways_left": ways[at]}
            for at, one in enumerate(content.fixes[:MOST])
        ],
        "entries": len(content.fixes),
        "after": {"falls": after.falls, "ways": {RouteState(state).name.lower(): n for state, n in after.routes}},
    }  # fmt: skip


def _group(rows: Iterable[ItemResult]) -> Iterable[list[ItemResult]]:
    """Return identical pieces together, in their order."""
    groups: dict[tuple[object, ...], list[ItemResult]] = {}
    for one in rows:
        groups.setdefault(find_kind(one), []).append(one)
    return groups.values()


def _describe_piece(one: ItemResult) -> dict[str, Any]:
    return {
        "row": one.item.row, "item": one.item.item, "what": describe(one, 60), "floor": one.item.floor,
        "class": one.adopted.risk.name.lower(), "basis": one.adopted.basis, "chance": words.chance(one),
    }  # fmt: skip


def _count_left(
    assessment: Assessment, results: Results, kept: KeptRoutes | None
) -> list[dict[str, int] | None]:  # fmt: skip
    """Return the routes by state once the first entry of what to fix is done, the first two, and so on."""
    reaching = {near.item_index for segment in assessment.obstructions for near in segment.pieces}
    held, found, left = set[int](), results.route_tables, list[dict[str, int] | None]()
    for entry in results.schedule.rows[:MOST]:
        held.update(entry.item_indices)
        if reaching & {*entry.item_indices}:
            found = evaluate_route_tables(assessment, SILENT, held, kept)
        left.append(_count(one.state.name.lower() for one in found.routes) if found.routes else None)
    return left


def _count(states: Iterable[str]) -> dict[str, int]:
    counts = Counter(states)
    return {state: counts[state] for state in STATES}


def _list_floors(tables: Tables) -> list[dict[str, Any]]:
    """Return the floors from the top, where all have an elevation, with the rows of the furniture on each.

    The last one has no name: it holds what stands on no floor of the workbook.
    """
    on: dict[str, list[int]] = {}
    for row in tables["Items"].with_all("item"):
        on.setdefault(key(row.get("floor") or ""), []).append(row.number)
    floors = list_floors(tables)
    heights = [height for row in floors if (height := row.get("elevation")) is not None]
    if len(heights) == len(floors):
        floors.sort(key=lambda row: row.get("elevation"), reverse=True)
    found = [
        {
            "row": row.number,
            "floor": row.get("floor"),
            "name": row.get("name") or "",
            "items": on.pop(key(row.get("floor")), []),
        }
        for row in floors
    ]
    lost = sorted(row for rows in on.values() for row in rows)
    return [*found, *([{"row": None, "floor": "", "name": "", "items": lost}] if lost else [])]


def _describe_ways(snapshot: "Snapshot", found: Evaluation, settings: Settings) -> dict[str, Any]:
    """Return the ways out: routes and rooms by state, and the floors, the worst first, with their worst rooms."""
    tables = snapshot.tables
    try:
        states = describe_states(snapshot, snapshot.inventory, found, settings)
    except AssessError as error:
        states = describe_unknown(tables, gettext(error.message))

    def rank(one: Mapping[str, Any]) -> tuple[Any, ...]:
        return STATES.index(one["state"]), -(one["chance"] or 0.0)

    on: dict[str, list[dict[str, Any]]] = {}
    for room in sorted(states["rooms"], key=rank):
        on.setdefault(key(room["floor"]), []).append(room)
    rows = {key(row.get("floor")): row.number for row in list_floors(tables)}
    floors = [
        {"floor": rooms[0]["floor"], "row": rows.get(name), "rooms": _count(one["state"] for one in rooms),
         "worst": [one for one in rooms if one["state"] != "open"][:MOST_ROOMS]}
        for name, rooms in on.items()
    ]  # fmt: skip
    floors.sort(key=lambda one: [-n for n in one["rooms"].values()])
    worst = [one for one in sorted(states["routes"], key=rank) if one["state"] != "open"]
    routes, rooms = (_count(one["state"] for one in states[name]) for name in ("routes", "rooms"))
    return {"routes": routes, "rooms": rooms, "floors": floors, "worst": worst[:MOST], "error": states["error"]}
