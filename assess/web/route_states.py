"""States of routes, rooms and segments as the reports word them, for the page."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from assess.errors import AssessError
from assess.i18n import gettext, load_catalogue, ngettext, speaking
from assess.model import Inventory
from assess.pipeline.assessment import Assessment
from assess.pipeline.run import evaluate_route_tables
from assess.progress import SILENT
from assess.report.say.route import describe_routes as say_routes
from assess.report.say.route import (
    is_blocked_standing,
    name_few,
    say_blocked,
    say_lost,
    say_missing,
    say_room_state,
    say_route_state,
    say_segment_state,
    say_state,
    say_to_fill_in,
    say_uncounted,
    say_way,
)
from assess.route_results import Chance, RoomRow, RouteRow, RouteState, RouteTables, SegmentRow
from assess.routes.obstructions import find_route_problems
from assess.web.evaluation import BY_FORMULAS, Evaluation, evaluate_once, list_floors
from assess.web.live import describe_problems
from assess.workbook.names import key
from assess.workbook.parse import Tables
from assess.workbook.resolve import places_by_name

if TYPE_CHECKING:
    from assess.web.book import Snapshot


def describe_routes(snapshot: "Snapshot") -> dict[str, Any]:
    """Return the answer of `GET /api/routes`: all states by the formulas, in the language of the workbook."""
    inventory = snapshot.inventory
    with speaking(load_catalogue(inventory.language)):
        try:
            found = evaluate_once(snapshot, BY_FORMULAS, routes=True)
            states = describe_states(snapshot.tables, inventory, found)
            problems = [] if found.assessment is None else list(_list_problems(inventory, found.assessment))
        except AssessError as error:
            states, problems = describe_unknown(snapshot.tables, gettext(error.message)), []
    return {"version": snapshot.version, **states, "problems": problems}


def _list_problems(inventory: Inventory, assessment: Assessment) -> Iterable[dict[str, Any]]:
    found = map(inventory.place, find_route_problems(assessment.inventory, assessment.obstructions))
    return describe_problems(found, inventory.sheets)


def describe_states(tables: Tables, inventory: Inventory, found: Evaluation) -> dict[str, Any]:
    """Return the states of routes, rooms and segments, and remarks, in the language in use.

    Where the shaking of a floor with a segment is not known nothing is known of routes. Those with a segment that was
    left out for an error are not known either.
    """
    crossed = _find_crossed(tables, found.unserved)
    if tables["Routes"].rows and (found.assessment is None or crossed):
        text = gettext("Routes are not evaluated, as it is not known how these floors shake: {floors}.",
                       floors=name_few(crossed or [row.get("floor") for row in list_floors(tables)]))  # fmt: skip
        return describe_unknown(tables, text)
    left_out = _find_left_out(tables, inventory)
    routes = RouteTables(risk=0.0)
    if found.assessment is not None and inventory.routes:
        routes = evaluate_route_tables(found.assessment, SILENT)
    return {
        "routes": [*_describe_routes(routes, left_out), *_describe_lost(routes, left_out)],
        "rooms": [*_describe_rooms(routes, inventory), *_describe_unjoined(routes, inventory)],
        "segments": [_describe_segment(one, routes.risk) for one in routes.segments],
        "remarks": list(_list_remarks(tables, inventory, routes, left_out)),
        "error": "",
    }


def describe_unknown(tables: Tables, why: str) -> dict[str, Any]:
    """Return every route, room and segment as not known."""
    routes, places = tables["Routes"].with_all("route"), tables["Places"].with_all("place")
    rooms = [row for row in places if row.get("kind") == "room"]
    return {
        "routes": [{"route": name, **_unknown("")} for name in dict.fromkeys(row.get("route") for row in routes)],
        "rooms": [
            {"room": row.get("place"), "floor": row.get("floor") or "", "place_row": row.number, **_unknown("")}
            for row in rooms
        ],
        "segments": [
            {"row": row.number, "route": row.get("route"), "segment": row.get("segment") or "", **_unknown("")}
            for row in routes
        ],
        "remarks": [],
        "error": why,
    }


def _find_crossed(tables: Tables, unserved: Collection[str]) -> list[str]:
    places, found = places_by_name(tables["Places"]), dict[str, str]()
    for row in tables["Routes"].rows:
        ends = [places.get(key(row.get(name) or "")) for name in ("start", "end")]
        for name in (row.get("floor"), *(end.get("floor") for end in ends if end)):
            if name and key(name) in unserved:
                found.setdefault(key(name), name)
    return list(found.values())


def _unknown(detail: str) -> dict[str, Any]:
    return _state(RouteState.NOT_KNOWN, say_state(RouteState.NOT_KNOWN), None, detail)


def _state(
    state: RouteState, word: str, chance: Chance | None, detail: str, *, is_standing: bool = False
) -> dict[str, Any]:
    is_known = state != RouteState.NOT_KNOWN and chance is not None
    return {
        "state": state.name.lower(),
        "standing": is_standing,
        "word": word,
        "chance": chance.probability if is_known and chance is not None else None,
        "detail": detail,
    }


def _describe_routes(routes: RouteTables, left_out: Mapping[str, Sequence[int]]) -> Iterator[dict[str, Any]]:
    for one in routes.routes:
        if key(one.route) in left_out:
            yield {"route": one.route, **_unknown(_say_left_out(left_out[key(one.route)]))}
        else:
            word, standing = say_route_state(one, routes.risk), is_blocked_standing(one)
            yield {"route": one.route, **_state(one.state, word, one.blocked, _explain(one), is_standing=standing)}


def _describe_segment(one: SegmentRow, risk: float) -> dict[str, Any]:
    named = {"row": one.workbook_row, "route": one.route, "segment": one.segment}
    word, standing = say_segment_state(one, risk), one.is_blocked_standing
    return named | _state(one.state, word, one.blocked, _explain(one), is_standing=standing)


def _explain(one: SegmentRow | RouteRow) -> str:
    return "; ".join([say_blocked(one), *_name_reason(one)])


def _name_reason(one: SegmentRow | RouteRow | RoomRow) -> Iterator[str]:
    if one.missing:
        yield say_missing(one.missing)
    elif one.state != RouteState.OPEN and one.most_likely_piece is not None:
        yield gettext("most likely by {item}", item=one.most_likely_piece.item)


def _describe_rooms(routes: RouteTables, inventory: Inventory) -> Iterator[dict[str, Any]]:
    rows = {one.place: one.row for one in inventory.places}
    for one in routes.rooms:
        detail = "; ".join([say_lost(one), *_name_reason(one), *(say_way(way, routes) for way in one.ways[:1])])
        word, standing = say_room_state(one), is_blocked_standing(one)
        state = _state(one.state, word, one.loses_every_exit, detail, is_standing=standing)
        yield {"room": one.room, "floor": one.floor, "place_row": rows.get(one.room), **state}


def _describe_unjoined(routes: RouteTables, inventory: Inventory) -> Iterator[dict[str, Any]]:
    places = {one.place: one for one in inventory.places}
    for name in routes.unjoined_rooms:
        detail = gettext("no segment joins it to an exit or a stair")
        yield {"room": name, "floor": places[name].floor, "place_row": places[name].row, **_unknown(detail)}


def _find_left_out(tables: Tables, inventory: Inventory) -> dict[str, list[int]]:
    """Return the rows of segments that were left out for an error, by the name of the route as names are compared."""
    known = {one.row for one in inventory.routes}
    found: dict[str, list[int]] = {}
    for row in tables["Routes"].rows:
        if row.number not in known:
            found.setdefault(key(row.get("route") or ""), []).append(row.number)
    return found


def _describe_lost(routes: RouteTables, left_out: Mapping[str, Sequence[int]]) -> Iterator[dict[str, Any]]:
    known = {key(one.route) for one in routes.routes}
    for name, rows in left_out.items():
        if name and name not in known:
            yield {"route": name, **_unknown(_say_left_out(rows))}


def _say_left_out(rows: Sequence[int]) -> str:
    named = ", ".join(map(str, rows))
    return ngettext(
        "{n:,} row of the sheet Routes has an error: {rows}", "{n:,} rows of the sheet Routes have errors: {rows}",
        len(rows), rows=named,
    )  # fmt: skip


def _list_remarks(
    tables: Tables, inventory: Inventory, routes: RouteTables, left_out: Mapping[str, Sequence[int]]
) -> Iterator[str]:
    lost = len(tables["Items"].rows) - len(inventory.items)
    if lost and (routes.routes or left_out):
        yield ngettext(
            "{n:,} row of furniture has an error or a blank, and does not count.",
            "{n:,} rows of furniture have errors or blanks, and do not count.",
            lost,
        )
    if routes.routes:
        yield from say_routes(routes)
        yield from say_to_fill_in(routes)
        yield from filter(None, [say_uncounted(routes)])
