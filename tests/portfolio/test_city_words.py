"""What a city says of its ground motion, its sums, its rows and its method: no number without what it leaves out."""

from dataclasses import replace

import pytest

from assess.motion.ground_scenarios import read_scenarios
from assess.portfolio import city_words as say
from assess.portfolio.city import RunGround
from assess.portfolio.city_method import list_basis, list_method, list_references
from assess.portfolio.run_portfolio import run_portfolio
from assess.settings import Settings
from tests.portfolio.staged import StagedGround, write_city
from tests.portfolio.test_city import DRAWS, view

GROUND = RunGround(kind="shakemap", file="grid.xml", sha256="12ab")
ALONE = "If every building had an earthquake of its own"


def _answer(city):
    return say.list_group_lines(city.groups[0])


def _method(city):
    return " ".join(list_method(city))


# ---------------------------------------------------------------- sums


def test_people_are_out_of_those_on_routes_that_are_known():
    routes = [
        {"path": "a", "route": "A", "state": "blocked", "probability": 0.5, "occupants": 12},
        {"path": "a", "route": "B", "state": "not known", "probability": None, "occupants": 38},
    ]
    city = view([{"path": "a"}], routes=routes, draws={"a": DRAWS})
    people = next(text for text in _answer(city) if "evacuation routes" in text)
    assert "6.0 of 12 people" in people
    assert "38 people are on routes whose state is not known, and are in no number." in people
    assert say.list_total_rows(city)[0][-4:] == ["6.0", "12", "0 to 10", "38"]
    routes = [{"path": "a", "route": "B", "state": "not known", "probability": None, "occupants": 50}]
    city = view([{"path": "a", "people_blocked": None}], routes=routes, draws={"a": [(1, 0), (2, 0)]})
    assert "50 people are on routes whose state is not known, and are in no number." in _answer(city)
    assert say.list_total_rows(city)[0][-4:] == ["–", "–", "–", "50"]


def test_a_city_says_in_its_title_and_before_its_numbers_what_it_is():
    city = view([{"path": "a", "building": "Home (made up)"}], draws={"a": DRAWS})
    assert say.say_title(city) == "Furniture in an earthquake: 1 made-up building"
    assert say.list_cautions(city)[0].startswith("All buildings are made up")
    real = view([{"path": "a", "building": "Home"}], draws={"a": DRAWS})
    assert say.say_title(real) == "Furniture in an earthquake: 1 building"
    assert not any("made up" in text for text in say.list_cautions(real))
    rows = [{"path": "a"}, {"path": "b", "same_as": "a"}, {"path": "c", "status": "skipped"}]
    copied = view(rows, draws={"a": DRAWS, "b": DRAWS})
    assert say.say_title(copied) == "Furniture in an earthquake: 2 of 3 buildings"
    assert "1 workbook has the same content as another" in " ".join(say.list_cautions(copied))


def test_ranges_say_what_they_are_over():
    city = view([{"path": "a"}], draws={"a": DRAWS})
    ideal = replace(city, settings=Settings(city=True, ideal=True), ground=GROUND)
    known = replace(city, ground=RunGround(kind="scenarios", file="gmf-data.csv", sha256="0", is_known=True))
    for one, said in (
        (replace(city, ground=GROUND), "In nine of ten earthquakes like this one between"),
        (city, "as if the ground motions of all workbooks were of one earthquake"),
        (ideal, "In nine of ten motions like the given ones, without the uncertainty of the earthquake"),
        (known, "In nine of ten draws, with the motion of the ground taken as known: between 0 and 3."),
    ):
        assert said in _answer(one)[0]
    assert "earthquakes like this one" not in _answer(known)[0]
    assert "The motion of the ground is taken as known." in _method(known)
    assert "takes one of the computed scenarios" not in _method(known)
    assert not any("eqe.922" in text for text in list_references(ideal))


def test_no_fall_seen_is_not_said_to_be_none_expected():
    row = {"path": "a", "expected_falls": 0.0, "people_blocked": 0.0, "routes_not_known": 2}
    said = say.say_nothing(view([row], draws={"a": [(0, 0)] * 20}).groups[0])
    assert said.startswith("No fall was seen in 20 draws. An expected number of up to ")
    assert said.endswith("The state of 2 routes is not known.")
    assert "is expected" not in said


def test_components_that_cobie_files_left_out_stand_next_to_the_sum():
    rows = [{"path": "a", "inventory": "handover", "left_out": 9}, {"path": "b", "inventory": "handover"}]
    (group,) = view(rows, draws={"a": DRAWS, "b": DRAWS}).groups
    assert "9 components of the handover files were left out" in say.list_group_lines(group)[0]
    assert say.say_falls(group.first_buildings[0]).endswith("9 left out of the COBie file")


# ---------------------------------------------------------------- rows


def test_what_is_not_known_stands_next_to_the_number_of_a_building():
    for expected, unconfirmed, by_formula, said in (
        (1.6, 0, 0, "1.6"), (1.6, 25, 0, "1.6 and up to 25 unconfirmed"),
        (0.0, 25, 3, "0.0 and up to 25 unconfirmed, 3 by formula only"),
    ):  # fmt: skip
        row = {"expected_falls": expected, "unconfirmed": unconfirmed, "by_formula": by_formula, "left_out": None}
        assert say.say_falls(row) == said
    for blocked, occupants, not_known, said in (
        (42.0, 100, 58, "42.0 of 42; 58 on routes not known"), (3.0, 20, 0, "3.0 of 20"),
        (0.0, 30, 30, "not known: 30 on routes not known"), (None, 30, 30, "not known: 30 on routes not known"),
        (None, None, None, "–"),
    ):  # fmt: skip
        row = {"people_blocked": blocked, "occupants": occupants, "people_not_known": not_known}
        assert say.say_people(row) == said
    for routes, blocked, not_known, said in ((0, 0, 0, "–"), (2, 0, 2, "not known"), (3, 1, 1, "1; 1 not known"),
                                             (3, 0, 0, "0")):  # fmt: skip
        row = {"routes": routes, "routes_blocked": blocked, "routes_not_known": not_known}
        assert say.say_blocked(row) == said
    assert say.mark_own_motions("School", {"own_motions": 2}) == "School (floors with motions of their own)"
    assert say.name_skipped("School", "s.xlsx") == "School (s.xlsx)"
    assert say.name_skipped(None, "s.xlsx") == say.name_skipped("s.xlsx", "s.xlsx") == "s.xlsx"
    piece = {"risk_class": "high", "risk_class_upper": "very high", "is_held": False, "basis": "unconfirmed"}
    assert say.label_piece(piece, "simulated") == "◌ unconfirmed (high)", "not said to be that of the formula"


# ---------------------------------------------------------------- method


def test_every_setting_that_changes_a_number_is_listed():
    settings = Settings(city=True, scale=1.2, scenario="ASCE 7-22", route_risk=0.25, runs=400, seed=3)
    city = replace(view([{"path": "a"}], draws={"a": DRAWS}), settings=settings, ground=GROUND)
    assert {
        ("SHA-256 of grid.xml", "12ab"), ("Simulated", "all pieces"), ("Draws, seed", "400, 3"),
        ("Motion of the floors", "ASCE 7-22"), ("Factor on all motions", "1.2"),
        ("Limit on the chance that a route is blocked", "25.0 %"),
    } <= set(list_basis(city))  # fmt: skip
    assert {
        "The motion of every floor is multiplied by 1.2.",
        "The motion of every floor follows ASCE 7-22, as the settings ask.",
    } <= set(say.list_cautions(city))
    assert "A route is open where the upper end of its chance of being blocked is below 25.0 %" in _method(city)
    assert "doubtful below 30 %, blocked from 30 % on" in _method(city)
    none = view([{"path": "a", "routes_open": 0, "routes_not_known": 0}], draws={"a": DRAWS})
    assert "A route is open" not in _method(none)


def test_the_dispersion_is_given_where_it_was_drawn_alone():
    rows = [{"path": "a", "motion_uncertainty": 0.41}, {"path": "b", "motion_uncertainty": 0.725}]
    city = replace(view(rows, draws={"a": DRAWS, "b": DRAWS}), ground=GROUND)
    assert "√(β² + σ²): β the Motion uncertainty of the workbook, 0 where that is blank" in _method(city)
    assert "It is 0.41 to 0.72." in _method(city)
    formula = [{"path": "a", "basis": "formula", "draws": 0}]
    assert "√(β² + σ²)" not in _method(replace(view(formula), ground=GROUND))


def test_the_formula_is_named_and_cited_with_the_pieces_that_cannot_rock():
    city = view([{"path": "a", "basis": "formula", "draws": 0, "cannot_rock": 4}])
    assert "chances by FEMA P-58 contents, under the median of the ground motion" in _method(city)
    assert "FEMA P-58" in list_references(city)[0]
    asked = replace(city, settings=Settings(city=True, class_by="proposed OR"))
    assert "chances by Proposed OR formula, under" in _method(asked)
    assert "Overturning Risk of Furniture" in list_references(asked)[0]
    assert any("4 of the pieces are low as they cannot rock" in one for one in _answer(city))
    assert "leaves its uncertainty out" in _answer(city)[0]


def test_the_range_of_independent_buildings_is_left_out_where_it_is_the_same():
    one = view([{"path": "a"}], draws={"a": DRAWS})
    same = view([{"path": "a"}, {"path": "b"}], draws={"a": [(2, 0)] * 4, "b": [(1, 0)] * 4})
    steep = [(0, 0)] * 10 + [(9, 0)] * 10
    differing = view([{"path": "a"}, {"path": "b"}], draws={"a": steep, "b": steep[::-1]})
    assert [ALONE in _method(city) for city in (one, same, differing)] == [False, False, True]


# ---------------------------------------------------------------- the ground motion


def _run(tmp_path, latitudes, ground):
    write_city(tmp_path / "city", latitudes)
    settings = Settings(verify="none", city=True)
    return run_portfolio(tmp_path / "city", tmp_path / "out", settings, ground=ground, jobs=1, formats=()).city


def test_buildings_far_from_the_sites_of_scenarios_are_counted():
    for distances, said in (
        ((None, 9.9), []),
        ((1.0, 12.4), ["1 building is farther than 10 km from the nearest site of the scenarios, 12 km: its"]),
        ((31.0, 12.4), ["2 buildings are farther than 10 km from the nearest site of the scenarios, 31 km at most:"]),
    ):
        rows = [{"path": f"b{at}", "ground_distance_km": one} for at, one in enumerate(distances)]
        city = view(rows, draws={row["path"]: DRAWS for row in rows})
        found = list(say.list_ground_cautions(city))
        assert [text[: len(start)] for text, start in zip(found, said, strict=True)] == said
        assert found == [text for text in say.list_cautions(city) if "km from" in text]


@pytest.mark.slow
def test_a_released_map_has_nothing_to_warn_of(tmp_path):
    city = _run(tmp_path, (37.8,), StagedGround(tmp_path))
    assert [one["status"] for one in city.ranked] == ["assessed"]
    assert city.buildings["ground_distance_km"].isna().all()
    assert (city.ground.is_known, list(say.list_ground_cautions(city))) == (False, [])


@pytest.mark.slow
def test_one_scenario_is_warned_of_and_far_and_farther_buildings_are_named(tmp_path):
    (tmp_path / "gmf-data.csv").write_text("site_id,event_id,gmv_PGA\n0,0,0.3\n")
    (tmp_path / "sites.csv").write_text("site_id,lon,lat\n0,10.0,37.8\n")
    city = _run(tmp_path, (37.8, 38.1, 39.0), read_scenarios(tmp_path))
    assert list(city.buildings["status"]) == ["assessed", "assessed", "skipped"]
    assert city.ground.is_known
    known, far = say.list_ground_cautions(city)
    assert known.startswith("The scenarios do not differ at the building: the motion of the ground is taken as known")
    assert far.startswith("1 building is farther than 10 km")
    warnings = [one for one in city.problems_of["b00.xlsx"] if "taken as known" in one["message"]]
    assert [one["severity"] for one in warnings] == ["warning"]
    assert any("expected at most 50 km" in one["message"] for one in city.problems_of["b02.xlsx"])
    (tmp_path / "near").mkdir()
    alone = _run(tmp_path / "near", (38.1,), read_scenarios(tmp_path))
    assert [text for text in say.list_ground_cautions(alone) if " km" in text] == [far], "said once"
