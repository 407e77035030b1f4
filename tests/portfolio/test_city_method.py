"""How the numbers were made: whatever the settings change stands in words, and nothing is cited that was not used."""

from dataclasses import replace

from assess.portfolio.city_content import build_content
from assess.portfolio.city_method import list_basis, list_method, list_references
from assess.portfolio.city_totals import RunGround, build_totals
from assess.portfolio.city_words import list_cautions, list_group_lines, say_nothing, say_title
from assess.settings import Settings
from tests.portfolio.test_city_totals import DRAWS, view

GROUND = RunGround(kind="shakemap", file="grid.xml", sha256="12ab")


def _method(city):
    return " ".join(list_method(city, build_totals(city)))


def test_every_setting_that_changes_a_number_is_listed():
    settings = Settings(city=True, scale=1.2, scenario="ASCE 7-22", route_risk=0.25, runs=400, seed=3)
    city = replace(view([{"path": "a"}], draws={"a": DRAWS}), settings=settings, ground=GROUND)
    assert {
        ("SHA-256 of grid.xml", "12ab"), ("Simulated", "all pieces"), ("Draws, seed", "400, 3"),
        ("Motion of the floors", "ASCE 7-22"), ("Factor on all motions", "1.2"),
        ("Limit on the chance that a route is blocked", "25.0 %"),
    } <= set(list_basis(city))  # fmt: skip
    cautions = list_cautions(city, build_totals(city))
    assert "The motion of every floor is multiplied by 1.2." in cautions
    assert "The motion of every floor follows ASCE 7-22, as the settings ask." in cautions


def test_states_of_routes_are_defined_by_the_limits_that_hold():
    city = replace(view([{"path": "a"}], draws={"a": DRAWS}), settings=Settings(city=True, route_risk=0.01))
    assert "A route is open where the upper end of its chance of being blocked is below 1.0 %" in _method(city)
    assert "doubtful below 30 %, blocked from 30 % on" in _method(city)
    none = view([{"path": "a", "routes_open": 0, "routes_not_known": 0}], draws={"a": DRAWS})
    assert "A route is open" not in _method(none)


def test_the_dispersion_is_told_where_it_was_drawn_alone():
    rows = [{"path": "a", "motion_uncertainty": 0.41}, {"path": "b", "motion_uncertainty": 0.725}]
    city = replace(view(rows, draws={"a": DRAWS, "b": DRAWS}), ground=GROUND)
    assert "√(β² + σ²): β the Motion uncertainty of the workbook, 0 where that is blank" in _method(city)
    assert "It is 0.41 to 0.73." in _method(city) or "It is 0.41 to 0.72." in _method(city)
    formula = [{"path": "a", "basis": "formula", "draws": 0}]
    assert "√(β² + σ²)" not in _method(replace(view(formula), ground=GROUND))


def test_the_formula_is_named_and_cited_with_the_pieces_that_cannot_rock():
    city = view([{"path": "a", "basis": "formula", "draws": 0, "cannot_rock": 4}])
    assert "chances by FEMA P-58 contents, under the median of the ground motion" in _method(city)
    assert "FEMA P-58" in list_references(city, build_totals(city))[0]
    asked = replace(city, settings=Settings(city=True, class_by="proposed OR"))
    assert "chances by Proposed OR formula, under" in _method(asked)
    assert "Overturning Risk of Furniture" in list_references(asked, build_totals(asked))[0]
    lines = list_group_lines(build_totals(city).groups[0])
    assert any("4 of the pieces are low as they cannot rock" in one for one in lines)
    assert "leaves its uncertainty out" in lines[0]


def test_ranges_say_what_they_are_over():
    city = view([{"path": "a"}], draws={"a": DRAWS})
    ideal = replace(city, settings=Settings(city=True, ideal=True), ground=GROUND)
    for one, said in (
        (replace(city, ground=GROUND), "In nine of ten earthquakes like this one between"),
        (city, "as if the ground motions of all workbooks were of one earthquake"),
        (ideal, "In nine of ten motions like the given ones, without the uncertainty of the earthquake"),
    ):
        assert said in list_group_lines(build_totals(one).groups[0])[0]
    assert not any("eqe.922" in text for text in list_references(ideal, build_totals(ideal)))


def test_no_fall_seen_is_not_said_to_be_none_expected():
    row = {"path": "a", "expected_falls": 0.0, "people_blocked": 0.0, "routes_not_known": 2}
    city = view([row], draws={"a": [(0, 0)] * 20})
    said = say_nothing(build_totals(city).groups[0])
    assert said.startswith("No fall was seen in 20 draws. An expected number of up to ")
    assert said.endswith("The state of 2 routes is not known.")
    assert "is expected" not in said


def test_copies_are_counted_before_the_numbers_and_skipped_buildings_not_in_the_title():
    rows = [{"path": "a", "building": "School"}, {"path": "b", "building": "School", "same_as": "a"},
            {"path": "c", "status": "skipped"}]  # fmt: skip
    city = view(rows, draws={"a": DRAWS, "b": DRAWS})
    assert "1 workbook has the same content as another" in " ".join(list_cautions(city, build_totals(city)))
    content = build_content(city)
    assert content.name_building("School", "b") == "School (b)"
    assert content.name_building("Town hall", "c") == "Town hall"
    assert say_title(city) == "Furniture in an earthquake: 2 of 3 buildings"
