"""A building of a city: its draws are those of its place, the same alone as among others, and cover the scenarios."""

from dataclasses import replace

import numpy as np
import pytest

from assess.errors import InputError
from assess.i18n import fill
from assess.motion.ground_scenarios import read_scenarios
from assess.motion.site_ground import SiteGround
from assess.motion.spatial_field import SCATTERS
from assess.pipeline.city_draws import check_draws, choose_runs, find_earthquakes, number_pieces
from assess.pipeline.draw_sums import sum_draws
from assess.pipeline.run import build_results, compute
from assess.rocking.draws import Earthquakes
from assess.settings import Settings
from tests.pipeline.rows import read

CITY = Settings(city=True, runs=40, seed=5)
ITEMS = [{"item": "A", "floor": "1", "axis": "X", "breadth": 40, "width": 90, "height": 180}]
FLOORS = [{"floor": "1", "pfa_x": 0.45}]
PLACE = {"latitude": 37.79, "longitude": -122.40}
OTHER = {"latitude": 37.34, "longitude": -121.89}
MAP = SiteGround(
    kind="shakemap", file="grid.xml", sha256="00", pga=1.5, dispersion=0.3, dispersion_source=fill("the map"),
    shared=0.2,
)  # fmt: skip
SCENARIOS = replace(MAP, kind="scenarios", file="gmf-data.csv", shared=None, scenarios=(-1.0, 0.0, 1.0))


def inventory(ground=None, **building):
    return replace(read(ITEMS, FLOORS, **{"period": 0.8} | building), site_ground=ground)


def assessed(settings=CITY, **building):
    assessment = compute(inventory(**building), settings)
    return assessment, build_results(assessment, figures=False)


# --- which earthquake ---


def test_which_earthquake_a_building_draws():
    """Alone one number for every place; in a city that of its place; the shared part is the map's where it tells."""
    found = find_earthquakes(inventory(**PLACE), Settings())
    assert found == Earthquakes(place=None, shared=SCATTERS["PGA"].shared)
    found = find_earthquakes(inventory(**PLACE), CITY)
    assert found.place == (37.79, -122.40)
    assert find_earthquakes(inventory(), CITY).place is None
    found = find_earthquakes(inventory(MAP, **PLACE), CITY)
    assert found == Earthquakes(place=(37.79, -122.40), shared=0.2)
    blank = find_earthquakes(inventory(replace(MAP, shared=None), **PLACE), CITY)
    assert blank.shared == SCATTERS["PGA"].shared


@pytest.mark.parametrize("settings", [Settings(), CITY])
def test_scenarios_carry_the_variance_of_the_ground_and_the_building_s_own_is_drawn(settings):
    """Of a motion that scatters by the root of 0.4^2 of its own and 0.3^2 of the ground."""
    found = find_earthquakes(inventory(SCENARIOS, motion_uncertainty=0.4, **PLACE), settings)
    assert found.given == (-1.0, 0.0, 1.0)
    assert found.given_share == pytest.approx(0.3**2 / (0.4**2 + 0.3**2))


@pytest.mark.parametrize("own", [{}, {"motion_uncertainty": 0.0}], ids=["blank", "none"])
def test_scenarios_of_a_building_without_uncertainty_of_its_own_decide_alone(own):
    found = find_earthquakes(inventory(SCENARIOS, **own, **PLACE), CITY)
    assert found.given_share == 1
    assert found.draw(1, 0, 4).tolist() == [-1, 0, 1, -1]


def test_scenarios_that_serve_no_floor_decide_nothing():
    """Floor 1 has a PFA of its own: its motion scatters as the building's own does, by numbers of its own."""
    own = {"motion_uncertainty": 0.4} | PLACE
    without, beside = (
        compute(inventory(ground, **own), Settings(verify="none", city=True)).cases for ground in (None, SCENARIOS)
    )
    assert beside.earthquakes == without.earthquakes
    assert beside.earthquakes.given == ()
    assert beside.dispersion.tolist() == without.dispersion.tolist() == [0.4]


# --- how many draws ---


def test_every_scenario_counts_alike_in_at_least_200_draws_or_as_many_as_asked_for():
    for scenarios, runs in ((0, 200), (1, 200), (3, 201), (150, 300), (200, 200), (777, 777)):
        assert choose_runs(scenarios) == runs, scenarios
    assert choose_runs(0, 64) == 64
    assert choose_runs(0, "auto") == "auto"
    assert choose_runs(32, 64) == 64
    with pytest.raises(InputError, match=r"runs is 100, expected a multiple of 32.* or set it to 224\."):
        choose_runs(32, 100)
    with pytest.raises(InputError, match="runs is auto, expected a multiple of 32"):
        choose_runs(32, "auto")
    with pytest.raises(InputError, match=r"5,001 scenarios, expected at most 5,000\. Keep fewer events"):
        choose_runs(5001)


def test_a_run_refuses_draws_that_do_not_fit():
    several = inventory(SCENARIOS, **PLACE)
    with pytest.raises(InputError, match=r"runs is 40, expected a multiple of 3"):
        compute(several, CITY)
    with pytest.raises(InputError, match=r"all buildings of a city need the same draws\. Set runs to a number"):
        compute(inventory(), Settings(city=True, runs="auto"))
    check_draws(several, replace(CITY, verify="none"))


# --- numbers ---


def test_pieces_of_different_places_draw_independently_in_a_city_only():
    one, other = (inventory(**place) for place in (PLACE, OTHER))
    assert number_pieces(one, Settings()) == number_pieces(other, Settings())
    assert number_pieces(one, CITY) != number_pieces(other, CITY)
    nowhere = inventory()
    assert number_pieces(nowhere, CITY) == number_pieces(nowhere, Settings())


@pytest.mark.slow
def test_a_building_has_the_same_draws_alone_and_after_others():
    before = sum_draws(*assessed(**PLACE)).falls
    other = sum_draws(*assessed(**OTHER)).falls
    again = sum_draws(*assessed(**PLACE)).falls
    assert before.tobytes() == again.tobytes()
    assert not np.array_equal(before, other)


def test_a_place_changes_what_is_drawn_but_a_building_alone_ignores_it():
    alone = [assessed(replace(CITY, city=False), **place)[1]["A"] for place in (PLACE, OTHER)]
    assert alone[0].adopted == alone[1].adopted
    assert sum_draws(*assessed(**PLACE)).falls.sum() > 0


def test_draw_k_takes_scenario_k_and_again_from_the_first(tmp_path):
    """Weak, median, strong: by a building and a piece without uncertainty of their own."""
    lines = ["# three events", "site_id,event_id,gmv_PGA", "0,0,0.15", "0,1,0.3", "0,2,0.6"]
    (tmp_path / "gmf-data.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (tmp_path / "sites.csv").write_text("site_id,lon,lat\n0,-122.40,37.79\n", encoding="utf-8")
    given = read(
        ITEMS, [{"floor": "1", "elevation": 0}], ground=read_scenarios(tmp_path), period=0.8, height=12,
        motion_uncertainty=0.0, piece_uncertainty="no", **PLACE,
    )  # fmt: skip
    assessment = compute(given, Settings(runs=60))
    earthquakes = assessment.cases.earthquakes
    assert earthquakes.draw(1, 0, 6) == pytest.approx([-1.2247, 0, 1.2247] * 2, abs=1e-4)
    assert assessment.cases.dispersion == pytest.approx([0.566], abs=0.001)
    falls = sum_draws(assessment, build_results(assessment, figures=False)).falls
    assert falls is not None
    weak, median, strong = (falls[at::3].sum() for at in range(3))
    assert weak <= median <= strong
    assert weak < strong
