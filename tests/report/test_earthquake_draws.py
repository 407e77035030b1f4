"""What reports say of the draws of an earthquake: right for a building alone, of a city, and under scenarios."""

from dataclasses import replace

import pytest

from assess.report.content import build_content
from assess.report.data import describe_run
from assess.report.findings.earthquake_draws import list_references, say_draws
from assess.results import EarthquakeDraws, SuiteInfo
from assess.settings import Settings
from tests.workbooks import assessed

ITEMS = [{"item": "A", "floor": "1", "axis": "X", "breadth": 40, "width": 90, "height": 180}]
FLOORS = [{"floor": "1", "pfa_x": 0.45}]
SETTINGS = Settings(city=True, runs=20)
JAYARAM, BOORE = "doi:10.1002/eqe.922", "doi:10.1193/070113EQS184M"


@pytest.fixture(scope="module")
def placed(tmp_path_factory):
    path = tmp_path_factory.mktemp("city") / "w.xlsx"
    return assessed(path, ITEMS, FLOORS, settings=SETTINGS, period=0.8, motion_uncertainty=0.4,
                    latitude=37.79, longitude=-122.4)  # fmt: skip


def changed(results, **changes):
    """Return the results with other draws of the earthquake."""
    draws = replace(results.provenance.earthquakes, **changes)
    return replace(results, provenance=replace(results.provenance, earthquakes=draws))


def alone(results):
    """Return the results as of a building alone."""
    return replace(results, provenance=replace(results.provenance, earthquakes=None))


def test_a_building_of_a_city_names_the_correlation_and_its_sources(placed):
    text = " ".join(build_content(placed).trials.paragraphs)
    assert "one normal number ε for the whole building" in text
    assert "what is drawn, of ln PGA, has a part that is common to all places" in text
    assert "a share of 0.331 of its variance (Boore et al. 2014)" in text
    assert "exp(-3h/40.7 km) (Jayaram and Baker 2009)" in text
    assert "Motion k has the same random phases in every building" in text
    assert [key for key in (JAYARAM, BOORE) for one in list_references(placed) if key in one] == [JAYARAM, BOORE]


def test_the_share_of_a_shakemap_is_not_that_of_a_publication(placed):
    results = changed(placed, is_shared_given=True, shared=0.25)
    assert "a share of 0.250 of its variance (as the ShakeMap gives it)" in say_draws(results)
    assert [JAYARAM in one for one in list_references(results)] == [True]


def test_a_building_of_a_city_without_a_place_is_fully_correlated(placed):
    text = say_draws(changed(placed, is_placed=False))
    assert "Latitude and Longitude are not filled in" in text
    assert "buildings without a place are fully correlated" in text
    assert "Jayaram" not in text
    assert list_references(changed(placed, is_placed=False)) == []


def test_scenarios_are_told_with_their_share_also_for_a_building_alone(placed):
    results = changed(placed, is_city=False, is_placed=False, scenarios=250, scenario_share=0.36)
    assert say_draws(results) == (
        "A share of 0.36 of the variance of ε is that of 250 scenarios of the ground, draw by draw in their order; the "
        "rest is drawn."
    )


def test_motions_of_the_user_s_own_have_no_random_phases(placed):
    suite = SuiteInfo.__new__(SuiteInfo)
    results = replace(placed, provenance=replace(placed.provenance, suite=suite))
    assert "random phases" not in say_draws(results)
    assert "random phases" in say_draws(placed)


def test_nothing_is_said_of_draws_that_were_not_made(placed):
    assert say_draws(replace(placed, settings=replace(SETTINGS, ideal=True))) == ""
    fixed = replace(placed.provenance, uncertainty=replace(placed.provenance.uncertainty, motion=0.0))
    assert say_draws(replace(placed, provenance=fixed)) == ""


def test_results_json_holds_how_earthquakes_were_drawn(placed):
    found = describe_run(placed)["assess"]
    assert found["settings"]["city"] is True
    assert found["earthquakes"] == {
        "is_city": True, "is_placed": True, "shared": pytest.approx(0.3308, abs=1e-4), "is_shared_given": False,
        "measure": "PGA", "range_km": 40.7, "scenarios": 0, "scenario_share": 0.0,
    }  # fmt: skip
    assert describe_run(alone(placed))["assess"]["earthquakes"] is None
    assert EarthquakeDraws(**found["earthquakes"]) == placed.provenance.earthquakes
