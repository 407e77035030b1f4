"""Sums over a city: never over inventories or bases that differ, with what a reader has to know beside them."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from assess.motion.spatial_field import EARTH, SCATTERS
from assess.portfolio.city import FIRST, City, build_spread, find_sampling
from assess.risk import RiskClass
from assess.rocking.draws import Earthquakes
from assess.route_results import RouteState
from assess.settings import Settings
from tests.portfolio.city_samples import frame

BUILDING = {
    "status": "assessed", "inventory": "surveyed", "basis": "simulated", "draws": 4, "pieces": 10, "low": 4,
    "medium": 3, "high": 1, "very_high": 0, "unconfirmed": 1, "by_formula": 0, "rolls": 0,
    "anchored": 1, "expected_falls": 1.0, "is_placed": True, "own_motions": 0, "works": 2, "works_without_cost": 1,
    "cost": 150.0, "falls_avoided": 0.75,
    "routes": 2, "routes_open": 1, "routes_doubtful": 0, "routes_blocked": 0, "routes_not_known": 1, "occupants": 50,
    "people_blocked": 6.0, "people_not_known": 0, "warnings": 3,
}  # fmt: skip
PIECE = {"inventory": "surveyed", "basis": "simulated", "is_held": False, "quantity": 2, "probability": 0.25,
         "breadth_cm": 38.0, "height_cm": 195.0}  # fmt: skip


def view(buildings, pieces=(), draws=None):
    """Return a city of these rows; `draws` are falls and blocked people of each path."""
    rows = [
        {"path": path, "draw": k, "falls": falls, "people_blocked": people, "routes_blocked": 0}
        for path, every in (draws or {}).items()
        for k, (falls, people) in enumerate(every)
    ]
    return City(
        buildings=frame("buildings", [BUILDING | one for one in buildings]),
        pieces=frame("pieces", [PIECE | one for one in pieces]),
        routes=frame("routes", []),
        problems=frame("problems", []),
        draws=frame("draws", rows),
        settings=Settings(city=True),
    )


DRAWS = [(0, 0), (0, 0), (1, 10), (3, 10)]


def test_cities_without_sums_and_made_up_ones():
    found = view([{"path": "bad", "status": "skipped", "inventory": None, "basis": None}])
    assert (found.groups, len(found.skipped)) == ((), 1)
    names = [{"path": "a", "building": "Home 1 (made up)"}, {"path": "b", "building": "Home 2 (made up)"}]
    unnamed = {"path": "bad.xlsx", "status": "skipped", "building": None}
    assert view([*names, unnamed]).is_made_up
    assert not view([*names, {"path": "c", "building": "City hall"}]).is_made_up
    assert not view([unnamed]).is_made_up


def test_buildings_with_most_people_on_blocked_routes_come_first_then_most_falls():
    rows = [
        {"path": "few people", "people_blocked": 1.6, "expected_falls": 1.0},
        {"path": "a tenth of a person", "people_blocked": 0.1, "expected_falls": 2.0},
        {"path": "falls", "people_blocked": None, "expected_falls": 90.0},
        {"path": "people", "people_blocked": 30.0, "expected_falls": 0.5},
        {"path": "nothing", "people_blocked": 0.0, "expected_falls": 0.0},
    ]
    found = view([one | {"basis": "formula"} for one in rows]).groups[0].first_buildings
    assert [one["path"] for one in found] == ["people", "few people", "falls", "a tenth of a person"]
    alike = [{"path": f"{at:02d}", "basis": "formula"} for at in reversed(range(25))]
    found = view(alike).groups[0].first_buildings
    assert [one["path"] for one in found] == [f"{at:02d}" for at in range(FIRST)], "in the order of paths where alike"


def test_types_with_most_expected_falls_come_first_and_blank_ones_by_size():
    pieces = [
        {"path": "a", "type": "Bookcase", "quantity": 2},
        {"path": "b", "type": "bookcase ", "quantity": 4},
        {"path": "a", "type": None, "quantity": 20},
        {"path": "a", "type": "Shelf", "quantity": 100, "is_held": True},
        {"path": "a", "type": "Shelf", "quantity": 100, "basis": "unconfirmed"},
        {"path": "a", "type": "Desk", "quantity": 100, "probability": 0.0},
    ]
    first = view([{"path": "a"}, {"path": "b"}], pieces, draws={}).groups[0].first_types
    assert [(str(one.label), one.pieces, one.buildings, one.expected_falls) for one in first] == [
        ("no Type: Breadth 30 to 40 cm, Height 180 to 200 cm", 20, 1, 5.0),
        ("Bookcase", 6, 2, 1.5),
    ]


SHARED = SCATTERS["PGA"].shared
RUNS = 2048
DOCS = Path(__file__).parents[2] / "docs"


def grid(count, step_km=4.0):
    """Return places on a square grid around San Francisco Bay [deg], (count, 2)."""
    side = math.ceil(math.sqrt(count))
    rows, columns = np.divmod(np.arange(count), side)
    degree = EARTH * math.pi / 180
    latitude = 37.3 + rows * step_km / degree
    return np.stack([latitude, -122.4 + columns * step_km / (degree * np.cos(np.radians(latitude)))], axis=1)


def draw(places, runs=RUNS, seed=1):
    """Return the numbers of each place and draw, (n, runs)."""
    return np.array([Earthquakes(place=(float(lat), float(lon))).draw(seed, 0, runs) for lat, lon in places])


def tabulate(falls):
    """Return the table draws of buildings whose pieces fall so, (n, runs)."""
    rows = [
        {"path": f"{at:03d}.xlsx", "draw": k, "falls": int(n), "people_blocked": 0, "routes_blocked": 0}
        for at, own in enumerate(falls)
        for k, n in enumerate(own)
    ]
    return frame("draws", rows)


@pytest.fixture(scope="module")
def city():
    """250 buildings, 60 km across, and their numbers."""
    places = grid(250)
    return places, draw(places)


def test_variance_of_a_sum_of_falls_is_that_of_both_parts_and_one_more_building_changes_no_draw_of_another(city):
    """All pieces of a building fall in half of the draws: their covariance is asin(correlation)/2π."""
    places, numbers = city
    quantity = 1 + np.arange(len(places)) % 20
    falls = quantity[:, None] * (numbers > 0)
    phi, lam = np.radians(places).T
    points = EARTH * np.stack([np.cos(phi) * np.cos(lam), np.cos(phi) * np.sin(lam), np.sin(phi)], axis=1)
    distances = np.linalg.norm(points[:, None] - points[None], axis=2)  # km
    correlation = np.minimum(1, SHARED + (1 - SHARED) * np.exp(-3 * distances / SCATTERS["PGA"].range_km))
    wanted = quantity @ (np.arcsin(correlation) / (2 * math.pi)) @ quantity
    assert falls.sum(axis=0).var() == pytest.approx(wanted, rel=4 * math.sqrt(2 / RUNS))

    more = draw(np.concatenate([places[:50], [[37.8, -122.27]], places[50:60]]), 300)
    assert more[:50].tobytes() == numbers[:50, :300].tobytes()
    assert more[51:].tobytes() == numbers[50:60, :300].tobytes()


def test_a_sum_over_buildings_is_made_draw_by_draw_in_any_order_of_rows_and_what_has_no_draws_stands_apart():
    spread = build_spread(tabulate(np.array([[0, 1, 2, 3], [0, 10, 20, 30]])), "falls", 16.5, 100)
    assert (spread.low, spread.high, spread.draws) == (0, 33, 4)
    assert (spread.expected, spread.apart) == (16.5, 0)
    table = tabulate(np.random.default_rng(1).poisson(3, (5, 50)))
    shuffled = table.sample(frac=1, random_state=3)
    assert build_spread(shuffled, "falls", 15.0, 100) == build_spread(table, "falls", 15.0, 100)
    assert build_spread(tabulate([]), "falls", 7.5, 10).apart == 7.5
    assert build_spread(tabulate([]), "falls", 7.5, 10).low is None
    assert build_spread(tabulate([[2, 4]]), "falls", 5.0, 10).apart == pytest.approx(2)


def test_the_interval_of_the_expected_number_is_that_of_a_mean_and_no_falls_do_not_show_that_nothing_falls():
    falls = np.random.default_rng(1).poisson(50, (1, 400))
    spread = build_spread(tabulate(falls), "falls", float(falls.mean()), 1000)
    half = 1.96 * falls.std(ddof=1) / 20
    assert spread.sampling_high - spread.sampling_low == pytest.approx(2 * half, rel=0.001)
    # of 200 draws none: Wilson's upper end is 1.88 %, and in such a draw every piece could fall
    assert find_sampling(np.zeros(200), 1000) == pytest.approx((0.0, 18.8), abs=0.1)
    rare = np.zeros(200)
    rare[7] = 30
    assert find_sampling(rare, 1000) == pytest.approx((0.0, 30 * 0.0278), rel=0.01)


def test_draws_that_differ_between_buildings_are_refused():
    table = tabulate([[1, 2], [3, 4]])
    for one in (table.iloc[:3], table.assign(draw=[0, 1, 0, 2])):
        with pytest.raises(ValueError, match="does not hold the same draws for all buildings"):
            build_spread(one, "falls", 1.0, 10)


def test_the_range_of_the_docs_is_that_of_this_city():
    """250 buildings of 20 pieces with a chance of 0.1, 200 draws: the range, and the one if buildings were alone."""
    falls = 20 * (draw(grid(250), 200) > 1.2816)
    spread = build_spread(tabulate(falls), "falls", float(falls.sum(axis=0).mean()), 5000)
    assert spread.high > 3 * spread.independent_high - 2 * spread.expected
    text = " ".join((DOCS / "methods.md").read_text(encoding="utf-8").split())
    said = r"5 to 95 % of the earthquakes bring ([\d,]+) to ([\d,]+) falls.* it would be ([\d,]+) to ([\d,]+)"
    found = re.search(said, text)
    assert found is not None
    numbers = [int(one.replace(",", "")) for one in found.groups()]
    assert numbers == [spread.low, spread.high, spread.independent_low, spread.independent_high]


@pytest.fixture(scope="module")
def sums():
    buildings = [
        {"path": "a.xlsx", "people_not_known": 30},
        {"path": "b.xlsx", "is_placed": False, "cost": None, "works_without_cost": 2},
        {"path": "formula.xlsx", "basis": "formula", "draws": 0, "expected_falls": 40.0, "own_motions": 2},
        {"path": "cobie.xlsx", "inventory": "handover", "basis": "formula", "draws": 0, "expected_falls": 7.0},
        {"path": "assumed", "inventory": "assumed", "basis": "simulated", "expected_falls": 20.0, "is_placed": None,
         "falls_low_inventory": 5.0, "falls_high_inventory": 60.0, "people_blocked": None, "occupants": None},
        {"path": "bad.xlsx", "status": "skipped", "inventory": None, "basis": None, "pieces": None},
    ]  # fmt: skip
    draws = {"a.xlsx": DRAWS, "b.xlsx": DRAWS, "assumed": [(10, 0), (20, 0), (20, 0), (30, 0)]}
    return view(buildings, draws=draws)


def find(sums, inventory, basis):
    return next(one for one in sums.groups if (one.inventory, one.basis) == (inventory, basis))


def test_inventories_and_bases_are_never_in_one_sum(sums):
    assert [(one.inventory, one.basis, one.buildings, one.falls.expected) for one in sums.groups] == [
        ("surveyed", "simulated", 2, 2.0),
        ("surveyed", "formula", 1, 40.0),
        ("handover", "formula", 1, 7.0),
        ("assumed", "simulated", 1, 20.0),
    ]
    assert [one["path"] for one in sums.skipped] == ["bad.xlsx"]


def test_falls_have_a_range_over_earthquakes_where_simulated_and_people_of_unknown_states_stand_apart(sums):
    surveyed = find(sums, "surveyed", "simulated").falls
    assert (surveyed.low, surveyed.high, surveyed.draws, surveyed.apart) == (0, 6, 4, 0)
    formula = find(sums, "surveyed", "formula").falls
    assert (formula.low, formula.draws, formula.apart) == (None, 0, 40.0)
    group = find(sums, "surveyed", "simulated")  # of 12 expected people 10 are in the draws
    assert (group.people.expected, group.people.apart, group.people.high) == (12, pytest.approx(2), 20)
    assert (group.occupants, group.people_not_known, group.people_known) == (100, 30, 70)
    assert (group.routes[RouteState.NOT_KNOWN], group.routes[RouteState.OPEN]) == (2, 2)


def test_pieces_are_counted_by_class_and_costs_that_are_not_known_are_not_taken_as_nothing(sums):
    group = find(sums, "surveyed", "simulated")
    assert (group.pieces, group.counted, group.unconfirmed, group.anchored) == (20, 16, 2, 2)
    assert list(group.by_class.items()) == list(zip(RiskClass, (8, 6, 2, 0), strict=True))
    assert (group.cost, group.works, group.works_without_cost) == (150, 4, 3)
    blank = view([{"path": "a", "cost": None, "draws": 0, "basis": "formula"}])
    assert blank.groups[0].cost is None


def test_buildings_that_are_not_of_this_earthquake_without_a_place_or_assumed_are_counted(sums):
    surveyed, assumed = find(sums, "surveyed", "simulated"), find(sums, "assumed", "simulated")
    assert (surveyed.unplaced, assumed.unplaced) == (1, 1)
    assert find(sums, "surveyed", "formula").own_motions == 1
    assert (assumed.falls_low_inventory, assumed.falls_high_inventory) == (5, 60)
    assert (surveyed.falls_low_inventory, assumed.people.expected) == (None, 0)
