"""States of routes, rooms and segments as the reports word them, for the page."""

from typing import TYPE_CHECKING, Any

from assess.errors import AssessError
from assess.i18n import gettext, load_catalogue, ngettext, speaking
from assess.model import Inventory
from assess.report.say import route as say
from assess.route_results import RoomRow, RouteRow, RouteState, RouteTables, SegmentRow
from assess.routes.obstructions import find_route_problems
from assess.settings import Settings
from assess.web.evaluation import AS_RUN, Evaluation, evaluate, list_floors, tabulate_routes
from assess.web.live import describe_problems
from assess.workbook.names import key
from assess.workbook.parse import Tables
from assess.workbook.resolve import places_by_name

if TYPE_CHECKING:
    from assess.web.book import Snapshot


def describe_routes(snapshot: "Snapshot") -> dict[str, Any]:
    """Return the answer of `GET /api/routes`: all states, in the language of the workbook."""
    inventory, stamp = snapshot.inventory, snapshot.stamp
    simulation = Evaluation(None, frozenset(), ()).describe()
    with speaking(load_catalogue(inventory.language)):
        try:
            found = evaluate(snapshot)
            states, simulation = describe_states(snapshot, inventory, found), found.describe()
            assessed = found.assessment
            shown = () if assessed is None else find_route_problems(assessed.inventory, assessed.obstructions)
            problems = describe_problems(map(inventory.place, shown), inventory.sheets)
        except AssessError as error:
            states, problems = describe_unknown(snapshot.tables, gettext(error.message)), []
    return {
        "version": snapshot.version, "stamp": stamp, **states, "simulation": simulation, "problems": problems,
    }  # fmt: skip


def describe_states(
    snapshot: "Snapshot", inventory: Inventory, found: Evaluation, settings: Settings = AS_RUN
) -> dict[str, Any]:
    """Return the states of routes, rooms and segments of an evaluation, and remarks, in the language in use.

    Where the shaking of a floor with a segment is not known nothing is known of routes. Those with a segment that was
    left out for an error are not known either.
    """
    tables = snapshot.tables
    places_by_key, crossed = places_by_name(tables["Places"]), dict[str, str]()  # floors whose motion is not known
    for row in tables["Routes"].rows:
        ends = [places_by_key.get(key(row.get(name) or "")) for name in ("start", "end")]
        for name in (row.get("floor"), *(end.get("floor") for end in ends if end)):
            if name and key(name) in found.unserved:
                crossed.setdefault(key(name), name)
    if tables["Routes"].rows and (found.assessment is None or crossed):
        floors = [*crossed.values()] or [row.get("floor") for row in list_floors(tables)]
        text = gettext("Routes are not evaluated, as it is not known how these floors shake: {floors}.",
                       floors=say.name_few(floors))  # fmt: skip
        return describe_unknown(tables, text)
    left_out, routes = _find_left_out(tables, inventory), tabulate_routes(snapshot, found, settings)
    stated = {one.route: _describe(one, routes) for one in routes.routes}
    names, places = {key(name): name for name in stated}, {one.place: one for one in inventory.places}
    stated |= {names.get(name, name): _unknown(why) for name, why in left_out.items() if name}
    alone = gettext("no segment joins it to an exit or a stair")
    rooms = [(one.room, _describe(one, routes)) for one in routes.rooms]
    rooms += [(name, _unknown(alone)) for name in routes.unjoined_rooms]
    remarks, faulty = list[str](), len(tables["Items"].rows) - len(inventory.items)
    if faulty and (routes.routes or left_out):
        remarks.append(ngettext(
            "{n:,} row of furniture has an error or a blank, and does not count.",
            "{n:,} rows of furniture have errors or blanks, and do not count.", faulty,
        ))  # fmt: skip
    if routes.routes:
        remarks += [*say.describe_routes(routes), *say.say_to_fill_in(routes)]
        remarks += filter(None, [say.say_uncounted(routes)])
    return {
        "routes": [{"route": name, **state} for name, state in stated.items()],
        "rooms": [
            {"room": name, "floor": places[name].floor, "place_row": places[name].row, **state}
            for name, state in rooms
        ],
        "segments": [
            {"row": one.workbook_row, "route": one.route, "segment": one.segment, **_describe(one, routes)}
            for one in routes.segments
        ],
        "remarks": remarks,
        "error": "",
    }  # fmt: skip


def describe_unknown(tables: Tables, why: str) -> dict[str, Any]:
    """Return every route, room and segment as not known."""
    routes, places = tables["Routes"].with_all("route"), tables["Places"].with_all("place")
    return {
        "routes": [{"route": name, **_unknown()} for name in dict.fromkeys(row.get("route") for row in routes)],
        "rooms": [
            {"room": row.get("place"), "floor": row.get("floor") or "", "place_row": row.number, **_unknown()}
            for row in places
            if row.get("kind") == "room"
        ],
        "segments": [
            {"row": row.number, "route": row.get("route"), "segment": row.get("segment") or "", **_unknown()}
            for row in routes
        ],
        "remarks": [],
        "error": why,
    }


def _unknown(detail: str = "") -> dict[str, Any]:
    state = RouteState.NOT_KNOWN
    return {
        "state": state.name.lower(), "standing": False, "word": say.say_state(state), "chance": None, "detail": detail
    }  # fmt: skip


def _describe(one: SegmentRow | RouteRow | RoomRow, routes: RouteTables) -> dict[str, Any]:
    """Return a state; after its chance stands what is missing, or the piece that decides."""
    if not isinstance(one, RoomRow):
        word, chance, details = say.say_outlook(one, routes.risk), one.blocked, [say.say_blocked(one)]
        further = []
    else:
        word, chance, details = say.say_room_state(one), one.loses_every_exit, [say.say_lost(one)]
        further = [say.say_way(way, routes) for way in one.ways[:1]]
    if one.missing:
        details.append(say.say_missing(one.missing))
    elif one.state != RouteState.OPEN and one.most_likely_piece is not None:
        details.append(gettext("most likely by {item}", item=one.most_likely_piece.item))
    return {
        "state": one.state.name.lower(),
        "standing": one.is_blocked_standing if isinstance(one, SegmentRow) else not one.is_fixed,
        "word": word,
        "chance": None if one.state == RouteState.NOT_KNOWN or chance is None else chance.probability,
        "detail": "; ".join(details + further),
    }


def _find_left_out(tables: Tables, inventory: Inventory) -> dict[str, str]:
    """Return what is said of the segments that were left out for an error, by the name of the route, as compared."""
    known = {one.row for one in inventory.routes}
    found: dict[str, list[int]] = {}
    for row in tables["Routes"].rows:
        if row.number not in known:
            found.setdefault(key(row.get("route") or ""), []).append(row.number)
    return {
        name: ngettext(
            "{n:,} row of the sheet Routes has an error: {rows}", "{n:,} rows of the sheet Routes have errors: {rows}",
            len(rows), rows=", ".join(map(str, rows)),
        )
        for name, rows in found.items()
    }  # fmt: skip
