"""What a city says of its ground motion, its sums and its method, where it is not that of test_shown.py."""

from dataclasses import replace

import pytest

from assess.motion.ground_scenarios import read_scenarios
from assess.portfolio import city_words as say
from assess.portfolio.city import RunGround
from assess.portfolio.city_words import list_method, list_references
from assess.portfolio.run_portfolio import run_portfolio
from assess.settings import Settings
from tests.portfolio.staged import write_city
from tests.portfolio.test_city import DRAWS, view

GROUND = RunGround(kind="shakemap", file="grid.xml", sha256="12ab")
ALONE = "If every building had an earthquake of its own"


def _method(city):
    return " ".join(list_method(city))


# ---------------------------------------------------------------- sums


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
        assert said in say.list_group_lines(one.groups[0])[0]
    assert "earthquakes like this one" not in say.list_group_lines(known.groups[0])[0]
    assert "The motion of the ground is taken as known." in _method(known)
    assert "takes one of the computed scenarios" not in _method(known)
    assert not any("eqe.922" in text for text in list_references(ideal))


def test_no_fall_seen_is_not_said_to_be_none_expected():
    row = {"path": "a", "expected_falls": 0.0, "people_blocked": 0.0, "routes_not_known": 2}
    said = say.say_nothing(view([row], draws={"a": [(0, 0)] * 20}).groups[0])
    assert said.startswith("No fall was seen in 20 draws. An expected number of up to ")
    assert said.endswith("The state of 2 routes is not known.")
    assert "is expected" not in said


# ---------------------------------------------------------------- method


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
