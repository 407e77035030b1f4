"""What stands at the top of a city of its ground motion: cautions that hold everywhere, and places far from a site."""

from dataclasses import replace

import pytest

from assess.motion.ground_scenarios import read_scenarios
from assess.portfolio.city_method import list_method
from assess.portfolio.city_totals import RunGround, build_totals
from assess.portfolio.city_words import list_cautions, list_ground_cautions, list_group_lines
from assess.portfolio.run_portfolio import run_portfolio
from assess.settings import Settings
from tests.portfolio.staged import StagedGround, write_city
from tests.portfolio.test_city_totals import DRAWS, view

FORMULAS = Settings(verify="none", city=True)


def _run(tmp_path, latitudes, ground):
    write_city(tmp_path / "city", latitudes)
    return run_portfolio(tmp_path / "city", tmp_path / "out", FORMULAS, ground=ground, jobs=1, formats=()).view


def test_buildings_far_from_the_sites_of_scenarios_are_counted():
    for distances, said in (
        ((None, 9.9), []),
        ((1.0, 12.4), ["1 building is farther than 10 km from the nearest site of the scenarios, 12 km: its"]),
        ((31.0, 12.4), ["2 buildings are farther than 10 km from the nearest site of the scenarios, 31 km at most:"]),
    ):
        rows = [{"path": f"b{at}", "ground_distance_km": one} for at, one in enumerate(distances)]
        city = view(rows, draws={row["path"]: DRAWS for row in rows})
        found = list(list_ground_cautions(city))
        assert [text[: len(start)] for text, start in zip(found, said, strict=True)] == said
        assert found == [text for text in list_cautions(city, build_totals(city)) if "km from" in text]


def test_components_that_cobie_files_left_out_stand_beside_the_sum():
    rows = [{"path": "a", "inventory": "handover", "left_out": 9}, {"path": "b", "inventory": "handover"}]
    city = view(rows, draws={"a": DRAWS, "b": DRAWS})
    (group,) = build_totals(city).groups
    assert group.left_out == 9
    assert "9 components of the handover files were left out" in list_group_lines(group)[0]
    assert group.first_buildings[0].left_out == 9


def test_draws_of_a_ground_motion_that_is_taken_as_known_are_worded_so():
    known = RunGround(kind="scenarios", file="gmf-data.csv", sha256="0", is_known=True)
    city = replace(view([{"path": "a"}], draws={"a": DRAWS}), ground=known)
    texts = list_method(city, build_totals(city))
    assert any("The motion of the ground is taken as known." in text for text in texts)
    assert not any("takes one of the computed scenarios" in text for text in texts)
    answer = list_group_lines(build_totals(city).groups[0])[0]
    assert "In nine of ten draws, with the motion of the ground taken as known: between 0 and 3." in answer
    assert "earthquakes like this one" not in answer


def test_a_released_map_has_nothing_to_warn_of(tmp_path):
    city = _run(tmp_path, (37.8,), StagedGround(tmp_path))
    assert list(city.buildings["status"]) == ["assessed"]
    assert city.buildings["ground_distance_km"].isna().all()
    assert (city.ground.is_known, list(list_ground_cautions(city))) == (False, [])


@pytest.mark.slow
def test_one_scenario_is_warned_of_and_far_and_farther_buildings_are_told(tmp_path):
    (tmp_path / "gmf-data.csv").write_text("site_id,event_id,gmv_PGA\n0,0,0.3\n")
    (tmp_path / "sites.csv").write_text("site_id,lon,lat\n0,10.0,37.8\n")
    city = _run(tmp_path, (37.8, 38.1, 39.0), read_scenarios(tmp_path))
    assert list(city.buildings["status"]) == ["assessed", "assessed", "skipped"]
    assert city.ground.is_known
    known, far = list_ground_cautions(city)
    assert known.startswith("The scenarios do not differ at the building: the motion of the ground is taken as known")
    assert far.startswith("1 building is farther than 10 km")
    problems = city.problems[city.problems["path"] == "b00.xlsx"]
    assert problems[problems["message"].str.contains("taken as known")]["severity"].tolist() == ["warning"]
    refused = city.problems[city.problems["path"] == "b02.xlsx"]
    (tmp_path / "near").mkdir()
    alone = _run(tmp_path / "near", (38.1,), read_scenarios(tmp_path))
    assert [text for text in list_ground_cautions(alone) if " km" in text] == [far], "said once"
    assert refused["message"].str.contains("expected at most 50 km").any()
