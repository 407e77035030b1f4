"""Sums over a city: never over inventories or bases that differ, with what a reader has to know beside them."""

import pytest

from assess.portfolio.city import FIRST, City
from assess.risk import RiskClass
from assess.route_results import RouteState
from assess.settings import Settings
from tests.portfolio.city_samples import frame

BUILDING = {
    "status": "assessed", "inventory": "surveyed", "basis": "simulated", "draws": 4, "pieces": 10, "low": 4,
    "medium": 3, "high": 1, "very_high": 0, "unconfirmed": 1, "by_formula": 0, "anchored": 1, "expected_falls": 1.0,
    "is_placed": True, "own_motions": 0, "works": 2, "works_without_cost": 1, "cost": 150.0, "falls_avoided": 0.75,
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


def test_falls_have_a_range_over_earthquakes_where_they_were_simulated(sums):
    surveyed = find(sums, "surveyed", "simulated").falls
    assert (surveyed.low, surveyed.high, surveyed.draws, surveyed.apart) == (0, 6, 4, 0)
    formula = find(sums, "surveyed", "formula").falls
    assert (formula.low, formula.draws, formula.apart) == (None, 0, 40.0)


def test_people_on_routes_without_joint_outcomes_and_of_an_unknown_state_stand_apart(sums):
    """Of 12 expected people 10 are in the draws."""
    group = find(sums, "surveyed", "simulated")
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


def test_a_city_of_skipped_buildings_has_no_sums():
    found = view([{"path": "bad", "status": "skipped", "inventory": None, "basis": None}])
    assert (found.groups, len(found.skipped)) == ((), 1)


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


def test_a_city_is_made_up_where_all_its_names_say_so():
    names = [{"path": "a", "building": "Home 1 (made up)"}, {"path": "b", "building": "Home 2 (made up)"}]
    unnamed = {"path": "bad.xlsx", "status": "skipped", "building": None}
    assert view([*names, unnamed]).is_made_up
    assert not view([*names, {"path": "c", "building": "City hall"}]).is_made_up
    assert not view([unnamed]).is_made_up


def test_buildings_of_one_name_are_named_with_their_files():
    city = view([{"path": "a", "building": "School"}, {"path": "b", "building": "School"}, {"path": "c"}])
    assert [city.name_building(row) for row in city.ranked] == ["School (a)", "School (b)", "c"]
