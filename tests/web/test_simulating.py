"""The page simulates as one types: it shows what a run finds after every edit, and only what has changed is rocked."""

import json
import random
from contextlib import nullcontext
from dataclasses import replace
from threading import Event

import pytest

import assess
from assess.report.words import find_range
from assess.route_results import RouteState
from assess.routes import evaluate as routes
from assess.settings import Settings
from assess.web.evaluation import LIVE, evaluate
from assess.web.live import LiveView
from assess.web.route_states import describe_routes
from assess.web.what_if_answer import try_out
from tests.waiting import wait_until
from tests.web.opened import edit, hold, settle, write_template

SHOWN = ("class", "basis", "chance", "low", "high", "quick")
ROWS = {
    "Building": [{"storeys": 5, "height": 16}],
    "Floors": [
        {"floor": "0", "elevation": 0, "pfa_x": 0.35, "pfv_x": 30.0}, {"floor": "1", "elevation": 3.2},
        {"floor": "4", "elevation": 12.8, "pfa_x": 0.6, "pfa_y": 0.5, "pfv_x": 70.0, "pfv_y": 60.0},
    ],
    "Items": [
        {"item": "A1", "floor": "0", "breadth": 30, "width": 90, "height": 190, "axis": "X"},
        {"item": "A2", "floor": "0", "breadth": 30, "width": 90, "height": 190, "axis": "X", "quantity": 3},  # alike
        {"item": "A3", "floor": "1", "breadth": 35, "width": 40, "height": 160, "x": 3, "y": 9},  # nearly square
        {"item": "A4", "floor": "1", "breadth": 40, "width": 120, "height": 180, "x": 2, "y": 1.2, "angle_deg": 90},
        {"item": "A5", "floor": "4", "breadth": 45, "width": 80, "height": 200, "anchored": "yes"},
        {"item": "A6", "floor": "4", "breadth": 100, "width": 100, "height": 70},  # too stocky
        {"item": "A7", "floor": "4", "breadth": 38, "width": 80, "height": 180, "against_wall": "yes"},
        {"item": "A8", "floor": "4", "breadth": 38, "width": 80, "height": 180, "x": 3, "y": 1.0, "angle_deg": 90},
    ],
    "Places": [
        {"place": "Office", "floor": "4", "kind": "room", "x": 0, "y": 0},
        {"place": "Way out", "floor": "4", "kind": "exit", "x": 6, "y": 0},
        {"place": "Store", "floor": "1", "kind": "room", "x": 0, "y": 0},
        {"place": "Door", "floor": "1", "kind": "exit", "x": 6, "y": 0},
    ],
    "Routes": [
        {"route": "R", "segment": "a", "floor": "4", "start": "Office", "end": "Way out", "clear_width": 1.6},
        {"route": "S", "segment": "b", "floor": "1", "start": "Store", "end": "Door", "clear_width": 1.6},
    ],
}  # fmt: skip


@pytest.fixture
def book(tmp_path):
    return hold(write_template(tmp_path / "w.xlsx", ROWS, spare=6))


def _look(book, view=None):
    """Return what the page shows of each row that changed, and of each route, once everything is simulated."""
    settle(book)
    answer = json.loads(json.dumps((view or LiveView()).answer(book, None)))
    assert answer["simulation"]["state"] == "done"
    columns = [answer["items"][name] for name in SHOWN]
    routes = describe_routes(book.snapshot())["routes"]
    states = {one["route"]: (one["state"], one["chance"]) for one in routes}
    return dict(zip(answer["items"]["row"], zip(*columns, strict=True), strict=True)), states


def _run(book):
    """Return the same of a run of the workbook, and the classes by which its counts go."""
    results = assess.run(replace(book.snapshot().inventory, hazard=None), figures=False)
    rows = {}
    for one in results:
        low, high = find_range(one) or (None, None)
        risk = "" if one.is_anchored else one.adopted.risk.name.lower()
        quick = one.formula_class.name.lower()
        rows[one.item.row] = (risk, one.adopted.basis.replace(" ", "_"), one.adopted.probability, low, high, quick)
    chances = {
        one.route: None if one.state == RouteState.NOT_KNOWN or one.blocked is None else one.blocked.probability
        for one in results.route_tables.routes
    }
    return rows, {one.route: (one.state.name.lower(), chances[one.route]) for one in results.route_tables.routes}


def test_after_each_of_thirty_edits_the_page_shows_what_a_run_finds_to_the_last_digit(book):
    """Sizes, places, floors, anchors and quantities, undone and done again."""
    random.seed(18)
    view, found = LiveView(), _look(book)
    assert found == _run(book)
    fields = {
        "height": lambda: random.randint(120, 220), "breadth": lambda: random.randint(25, 60),
        "axis": lambda: random.choice(["X", "Y", None]), "anchored": lambda: random.choice(["yes", "no"]),
        "quantity": lambda: random.randint(1, 4), "angle_deg": lambda: random.choice([0, 90, 45]),
        "floor": lambda: random.choice(["0", "1", "4"]),
    }  # fmt: skip
    shown = set()
    for step in range(30):
        if step % 7 == 5:
            book.undo(book.version)
        elif step % 7 == 6:
            book.redo(book.version)
        elif step == 20:
            edit(book, ("Floors", 4, "pfa_x", 0.45))
        elif step == 22:
            edit(book, ("Building", 0, "piece_uncertainty", "no"))
        else:
            field = random.choice([*fields])
            edit(book, ("Items", random.randint(2, 9), field, fields[field]()))
        (rows, states), (of_run, states_of_run) = _look(book, view), _run(book)
        assert {row: rows[row] for row in of_run} == of_run, step
        assert all(one[0] == "" for row, one in rows.items() if row not in of_run), "it has an error"
        assert states == states_of_run, step
        shown |= {one[1] for one in rows.values()} | {state for state, _ in states.values()}
    assert shown >= {"simulated", "cannot_rock", "blocked", "not_known"}


def test_one_edit_rocks_the_pieces_that_it_changes_and_the_routes_that_they_reach_alone(book, monkeypatch):
    settle(book)
    describe_routes(book.snapshot())
    rocked, judged = [], []
    verdicts = book.simulator.verdicts
    rock = verdicts.rock

    def count(cases, own, *more, **named):
        rocked.append(own.size)
        rock(cases, own, *more, **named)

    monkeypatch.setattr(verdicts, "rock", count)
    for name in ("_segment", "_route", "evaluate_room"):
        made = getattr(routes, name)

        def note(scene, of, *more, made=made):
            judged.append(of)
            return made(scene, of, *more)

        monkeypatch.setattr(routes, name, note)
    edit(book, ("Items", 9, "height", 170))
    assert len(_look(book)[0]) == 8
    assert sum(rocked) == 1
    names = {getattr(one, "place", one) for one in judged}
    assert names == {0, "R", "Office"}, "nothing of the other floor"
    rocked.clear()
    book.undo(book.version)
    _look(book)
    edit(book, ("Items", 3, "quantity", 2), ("Items", 6, "anchored", "no"), ("Items", 7, "room", "Office"))
    _look(book)
    assert rocked == [], "known, or nothing that a fall depends on"


def test_until_it_is_simulated_a_class_is_the_formulas_and_says_so(tmp_path):
    """While all places are taken; then the page has the rest, batch by batch, and answers only what changed."""
    book, free = hold(write_template(tmp_path / "w.xlsx", ROWS, spare=6)), Event()
    book.simulator.limit(lambda: nullcontext() if free.is_set() else None, 60.0)
    edit(book, ("Items", 2, "height", 191))
    view = LiveView()
    answer = wait_until(lambda: view.answer(book, None), lambda one: one["simulation"]["state"] == "waiting")
    items, formula = answer["items"], assess.run(book.snapshot().inventory, Settings(verify="none"), figures=False)
    assert answer["simulation"]["done"] == 0
    assert {*items["basis"]} == {"formula", "cannot_rock"}
    assert items["low"] == items["high"] == [None] * 8
    assert items["class"] == ["" if one.is_anchored else one.adopted.risk.name.lower() for one in formula]
    assert describe_routes(book.snapshot())["simulation"]["state"] == "waiting"
    free.set()
    settle(book)
    later = view.answer(book, answer["stamp"])
    assert 0 < len(later["items"]["row"]) < 8, "not those that cannot rock, nor those whose chance is the same"
    assert later["simulation"] == {"state": "done", "done": 7, "of": 7, "message": ""}


def test_a_newer_version_cancels_a_batch_that_it_does_not_ask_for_and_too_long_a_simulation_says_so(book):
    settle(book)
    simulator, started, goes_on = book.simulator, Event(), Event()
    rock = simulator.verdicts.rock

    def slow(*given, progress, **named):
        started.set()
        while not goes_on.wait(0.01):
            progress.check()  # raises once it is cancelled
        rock(*given, progress=progress, **named)

    simulator.verdicts.rock = slow
    edit(book, ("Floors", 4, "pfa_x", 0.75), ("Floors", 4, "pfv_x", 80.0))
    assert evaluate(book.snapshot()).simulation.state == "running"
    assert started.wait(60)
    book.undo(book.version)
    assert evaluate(book.snapshot()).simulation.state == "done"
    wait_until(lambda: simulator._batch, lambda batch: batch is None)
    goes_on.set()
    simulator.limit(nullcontext, 0.0)
    edit(book, ("Items", 2, "height", 150), ("Items", 4, "height", 150))
    found = settle(book)
    assert found.simulation.state == "failed"
    assert "processor time" in found.simulation.message
    book.undo(book.version)
    assert settle(book).simulation.state == "done"
    assert set(simulator._wanted) <= {LIVE}


def test_no_view_has_numbers_of_its_own_after_a_simulation(book):
    """Lowered classes are told as such, routes go by the pieces as they are shown, and so does what if."""
    rows, states = _look(book)
    lowered = [row for row, (risk, *_, quick) in rows.items() if risk and risk != quick]
    assert lowered, "the formula and the simulation differ here"
    answer = try_out(book.snapshot(), {})
    before = dict(zip(answer["before"]["items"]["row"], answer["before"]["items"]["class"], strict=True))
    assert before == {row: risk for row, (risk, *_) in rows.items()}
    assert {one["route"]: (one["state"], one["chance"]) for one in answer["before"]["routes"]} == states
    live = LiveView().answer(book, None)
    assert answer["before"]["counts"] == live["counts"]
    rooms = {one["room"]: one["chance"] for one in describe_routes(book.snapshot())["rooms"]}
    assert rooms == {one["room"]: one["chance"] for one in answer["before"]["rooms"]}


def test_an_unconfirmed_class_is_a_state_of_its_own(tmp_path):
    """Nothing is known of the building but an intensity: simulated chances are shown, and called unconfirmed."""
    rows = {**ROWS, "Building": [{"shaking": "MMI VIII"}], "Floors": [{"floor": one} for one in "014"]}
    book = hold(write_template(tmp_path / "w.xlsx", rows, spare=6))
    found, _ = _look(book)
    assert (found, _) == _run(book)
    assert [one[1] for one in found.values()].count("unconfirmed") > 3
    assert LiveView().answer(book, None)["items"]["assumed"].count(True) == 7
