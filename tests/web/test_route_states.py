"""States of routes and rooms, as the page is told them."""

import json
from typing import Any

import pytest

import assess
from assess.report.say.route import say_blocked, say_outlook, say_room_state
from assess.route_results import RouteState
from assess.web.route_states import describe_routes
from tests.web.opened import MARKET, edit, hold, settle, write_template

HALL: dict[str, list[dict[str, Any]]] = {
    "Floors": [{"floor": "1", "pfa_x": 0.5, "elevation": 0}, {"floor": "2", "pfa_x": 0.2, "elevation": 4}],
    "Items": [
        {"item": "A1", "floor": "1", "breadth": 30, "width": 90, "height": 200, "x": 2, "y": 1.2, "angle_deg": 90},
        {"item": "A2", "floor": "2", "breadth": 90, "width": 90, "height": 90},
    ],
    "Places": [
        {"place": "Room", "floor": "1", "kind": "room", "x": 0, "y": 0},
        {"place": "Attic", "floor": "2", "kind": "room"},
        {"place": "Door", "floor": "1", "kind": "exit", "x": 6, "y": 0},
    ],
    "Routes": [
        {"route": "R", "segment": "a", "floor": "1", "start": "Room", "end": "Door", "clear_width": 1.2},
        {"route": "S", "segment": "b", "floor": "1", "start": "Room", "end": "Door", "clear_width": 0.5},
    ],
}


def _answer(book):
    settle(book)
    return json.loads(json.dumps(describe_routes(book.snapshot())))


def _states(rows, *names):
    return {tuple(row[name] for name in names): (row["state"], row["word"], row["chance"]) for row in rows}


def _expected(one, word, chance):
    known = one.state != RouteState.NOT_KNOWN
    return one.state.name.lower(), word, chance.probability if known and chance else None


def _compare(answer, results):
    tables = results.route_tables
    risk = tables.risk
    assert _states(answer["routes"], "route") == {
        (one.route,): _expected(one, say_outlook(one, risk), one.blocked) for one in tables.routes
    }
    assert _states(answer["segments"], "row") == {
        (one.workbook_row,): _expected(one, say_outlook(one, risk), one.blocked) for one in tables.segments
    }
    rooms = {(one.room,): _expected(one, say_room_state(one), one.loses_every_exit) for one in tables.rooms}
    found = _states(answer["rooms"], "room")
    assert {name: found[name] for name in rooms} == rooms
    assert {name for (name,) in found.keys() - rooms.keys()} == set(tables.unjoined_rooms)


@pytest.mark.slow
def test_states_are_those_of_the_run_and_a_piece_with_an_error_leaves_the_routes_to_the_others(
    example_inventory, tmp_path
):
    answer, example = _answer(hold(MARKET)), assess.run(example_inventory, figures=False)
    _compare(answer, example)
    detail = {one["route"]: one["detail"] for one in answer["routes"]}
    assert all(detail[one.route].startswith(say_blocked(one)) for one in example.route_tables.routes)
    assert answer["error"] == ""
    places = {one.place: one.row for one in example.places}
    assert all(places[one["room"]] == one["place_row"] for one in answer["rooms"])
    book = hold(MARKET)
    edit(book, ("Items", 5, "height", "tall"))
    (tmp_path / "w.xlsx").write_bytes(book.write())
    inventory = assess.read_inventory(tmp_path / "w.xlsx", records=MARKET.parent, strict=False)
    answer = _answer(book)
    _compare(answer, assess.run(inventory, figures=False))
    assert answer["remarks"][0].startswith("1 row of furniture has an error")


@pytest.fixture
def hall(tmp_path):
    return hold(write_template(tmp_path / "w.xlsx", HALL))


def test_an_edit_changes_a_state_and_a_faulty_segment_leaves_no_route_open(hall):
    before = _answer(hall)
    states = _states(before["routes"], "route")
    assert (states[("R",)][0], states[("S",)][:2]) == ("blocked", ("blocked", "✕ blocked as it stands"))
    assert {(one["room"], one["place_row"]): (one["state"], one["detail"]) for one in before["rooms"]}["Attic", 3] == (
        "not_known", "no segment joins it to an exit or a stair",
    )  # fmt: skip
    edit(hall, ("Items", 2, "anchored", "yes"))
    assert _states(_answer(hall)["routes"], "route")[("R",)][0] == "open"
    edit(hall, *(("Routes", 4, *one) for one in (("route", "R"), ("segment", "c"), ("start", "Nowhere"))))
    (route, *_) = _answer(hall)["routes"]
    assert (route["route"], route["state"], route["chance"]) == ("R", "not_known", None)
    assert "row of the sheet Routes has an error: 4" in route["detail"]


def test_routes_on_a_floor_without_shaking_are_not_known_and_without_routes_there_is_nothing_to_say(hall, tmp_path):
    """What is not crossed does not matter."""
    for floor, state in ((3, "blocked"), (2, "not_known")):
        edit(hall, ("Floors", floor, "pfa_x", None), ("Floors", floor, "elevation", None))
        answer = _answer(hall)
        assert {one["state"] for one in answer["routes"]} == {state}
        assert bool(answer["error"]) == (state == "not_known")
    answer = _answer(hold(write_template(tmp_path / "w.xlsx", {**HALL, "Routes": [], "Places": []})))
    assert [answer[name] for name in ("routes", "rooms", "segments", "remarks", "problems", "error")] == [[]] * 5 + [""]
