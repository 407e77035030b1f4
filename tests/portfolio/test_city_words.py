"""The answer in words: what is left out of a number stands beside it, and no sentence is empty."""

from assess.portfolio.city_method import list_method
from assess.portfolio.city_totals import build_totals
from assess.portfolio.city_words import list_cautions, list_group_lines, list_total_rows, say_title
from tests.portfolio.test_city_totals import DRAWS, view

ALONE = "If every building had an earthquake of its own"


def _say(city):
    return list_group_lines(build_totals(city).groups[0])


def test_people_are_out_of_those_on_routes_that_are_known():
    routes = [
        {"path": "a", "route": "A", "state": "blocked", "probability": 0.5, "occupants": 12},
        {"path": "a", "route": "B", "state": "not known", "probability": None, "occupants": 38},
    ]
    city = view([{"path": "a"}], routes=routes, draws={"a": DRAWS})
    people = next(text for text in _say(city) if "evacuation routes" in text)
    assert "6.0 of 12 people" in people
    assert "38 people are on routes whose state is not known, and are in no number." in people
    assert list_total_rows(build_totals(city))[0][-4:] == ["6.0", "12", "0 to 10", "38"]


def test_where_no_route_is_known_no_number_of_people_is_given():
    routes = [{"path": "a", "route": "B", "state": "not known", "probability": None, "occupants": 50}]
    city = view([{"path": "a", "people_blocked": None}], routes=routes, draws={"a": [(1, 0), (2, 0)]})
    assert "50 people are on routes whose state is not known, and are in no number." in _say(city)
    assert list_total_rows(build_totals(city))[0][-4:] == ["–", "–", "–", "50"]


def test_the_range_of_independent_buildings_is_left_out_where_it_is_the_same():
    one = view([{"path": "a"}], draws={"a": DRAWS})
    same = view([{"path": "a"}, {"path": "b"}], draws={"a": [(2, 0)] * 4, "b": [(1, 0)] * 4})
    steep = [(0, 0)] * 10 + [(9, 0)] * 10
    differing = view([{"path": "a"}, {"path": "b"}], draws={"a": steep, "b": steep[::-1]})
    for city, said in ((one, False), (same, False), (differing, True)):
        assert any(ALONE in text for text in list_method(city, build_totals(city))) is said


def test_a_made_up_city_says_so_in_its_title_and_before_its_numbers():
    city = view([{"path": "a", "building": "Home (made up)"}], draws={"a": DRAWS})
    assert say_title(city) == "Furniture in an earthquake: 1 made-up building"
    assert list_cautions(city, build_totals(city))[0].startswith("All buildings are made up")
    real = view([{"path": "a", "building": "Home"}], draws={"a": DRAWS})
    assert say_title(real) == "Furniture in an earthquake: 1 building"
    assert not any("made up" in text for text in list_cautions(real, build_totals(real)))
