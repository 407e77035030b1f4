"""What happens draw by draw in a building: its mean is what reports expect, and only joint outcomes are in it."""

import numpy as np
import pytest

from assess.pipeline.draw_sums import count_people, sum_draws
from assess.pipeline.run import build_results, compute
from assess.report.counts import count
from assess.settings import Settings
from tests.pipeline.rows import read_sheets

RUNS = 60
SETTINGS = Settings(runs=RUNS, seed=3)
LANE = {"clear_width": 1.0, "required_width": 0.9}
PLACES = [
    {"place": "Room", "floor": "1", "kind": "room"},
    {"place": "Middle", "floor": "1", "kind": "corridor"},
    {"place": "West", "floor": "1", "kind": "exit"},
    {"place": "East", "floor": "2", "kind": "exit"},
    {"place": "South", "floor": "1", "kind": "exit"},
]
ROUTES = [
    {"route": "A", "segment": "one", "floor": "1", "start": "Room", "end": "Middle", "occupants": 20, **LANE},
    {"route": "A", "segment": "two", "floor": "1", "start": "Middle", "end": "West", "occupants": 35, **LANE},
    {"route": "B", "segment": "three", "floor": "2", "start": "Room", "end": "East", "occupants": 12, **LANE},
    {"route": "C", "segment": "four", "floor": "1", "start": "Room", "end": "South", "occupants": 5, **LANE},
]
CABINET = {"breadth": 40, "width": 80, "height": 190}
FAR = {"route": "C", "edge_distance": 9}
"""Far from every route: known not to block it."""
ITEMS = [
    {"item": "one", "floor": "1", "axis": "X", "route": "A", "segment": "one", "edge_distance": 0, **CABINET},
    {"item": "four", "floor": "1", "axis": "Y", "quantity": 4, **FAR, **CABINET},
    {"item": "held", "floor": "1", "axis": "X", "anchored": "yes", **FAR, **CABINET},
    {"item": "square", "floor": "1", **FAR, **CABINET | {"width": 40}},
    {"item": "upstairs", "floor": "2", "axis": "X", "route": "B", "edge_distance": 0, **CABINET},
    {"item": "chest", "floor": "2", "axis": "X", "route": "B", "edge_distance": 9, "breadth": 85, "width": 150,
     "height": 90},
]  # fmt: skip
FLOORS = [{"floor": "1", "pfa_x": 0.45, "pfa_y": 0.4}, {"floor": "2", "pfa_x": 0.5}]


def assessed(settings=SETTINGS, items=ITEMS, **building):
    inventory = read_sheets(
        Building=[{"period": 0.8, **building}], Floors=FLOORS, Items=items, Places=PLACES, Routes=ROUTES
    )
    assessment = compute(inventory, settings)
    return assessment, build_results(assessment, figures=False)


@pytest.fixture(scope="module")
def run():
    return assessed()


def test_mean_over_draws_is_the_expected_number_of_falls(run):
    sums, counts = sum_draws(*run), count("", tuple(run[1]))
    assert sums.falls.shape == (RUNS,)
    assert 0 < counts.expected < counts.free
    assert sums.falls.mean() == pytest.approx(counts.expected, rel=0.05), "one has a chance with an anchored one alike"
    assert sums.falls.max() <= counts.free


def test_pieces_of_a_row_fall_together_and_anchored_ones_are_not_counted():
    only = [one for one in ITEMS if one["item"] in ("four", "held")]
    sums = sum_draws(*assessed(items=only))
    assert set(sums.falls.tolist()) == {0, 4}


def test_routes_and_their_people_the_most_of_any_segment_are_counted_in_each_draw(run):
    sums, tables = sum_draws(*run), run[1].route_tables
    assert sums.joint_routes == ("A", "B", "C")
    by_route = {one.route: one.blocked.probability for one in tables.routes}
    assert 0 < by_route["A"] < 1
    assert 0 < by_route["B"] < 1
    assert by_route["C"] == 0
    assert sums.routes_blocked.mean() == pytest.approx(tables.blocked_routes_expected, rel=1e-12)
    assert set(sums.people_blocked.tolist()) <= {0, 12, 35, 47}
    assert sums.people_expected == pytest.approx(35 * by_route["A"] + 12 * by_route["B"])
    assert sums.people_blocked.mean() == pytest.approx(sums.people_expected)
    assert (sums.people_apart, sums.routes_apart, sums.people_not_known) == (0, 0, 0)
    assert [count_people(tables, one) for one in tables.routes] == [35, 12, 5]


def test_without_simulation_or_with_draws_of_its_own_for_each_piece_there_are_expected_numbers_alone():
    assessment, results = assessed(Settings(verify="none"))
    sums, tables = sum_draws(assessment, results), results.route_tables
    assert sums.falls is sums.people_blocked is sums.routes_blocked is None
    assert sums.routes_expected == pytest.approx(tables.blocked_routes_expected)
    assert sums.routes_apart == sums.routes_expected > 0
    assert sums.people_apart == sums.people_expected > 0
    sums = sum_draws(*assessed(Settings(runs="auto", seed=3)))
    assert sums.falls is None
    assert sums.people_expected > 0


def test_a_route_with_a_piece_that_is_not_confirmed_has_no_joint_outcome():
    """Neither T1 nor the height is known: lower simulated classes are not confirmed."""
    assessment, results = assessed(Settings(runs=RUNS, seed=3, scale=0.35), period=None)
    sums, chances = sum_draws(assessment, results), {one.route: one.blocked for one in results.route_tables.routes}
    assert chances["A"].unconfirmed
    assert "A" not in sums.joint_routes
    assert "C" in sums.joint_routes
    known = {one.route for one in results.route_tables.routes if one.state != "not known"}
    assert sums.people_not_known == sum({"A": 35, "B": 12, "C": 5}[one] for one in {"A", "B", "C"} - known)


def test_ideal_runs_count_verdicts_without_uncertainty():
    assessment, results = assessed(Settings(runs=RUNS, seed=3, ideal=True))
    sums = sum_draws(assessment, results)
    assert sums.falls.mean() == pytest.approx(count("", tuple(results)).expected, rel=1e-12)
    assert np.array_equal(sums.falls, np.round(sums.falls))
