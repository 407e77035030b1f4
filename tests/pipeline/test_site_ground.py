"""A ShakeMap or scenarios: which floors follow them, how uncertain the motion is, and what is said of it."""

import math
import shutil

import pytest

import assess
from assess.motion.floor_medians import find_medians
from assess.motion.ground_scenarios import read_scenarios
from assess.motion.shakemap import parse_shakemap, read_shakemap
from assess.pipeline.annual import evaluate_annual
from assess.pipeline.demand import build_demands, find_site
from assess.pipeline.known_ground import find_ground
from assess.pipeline.live_values import live_values
from assess.pipeline.run import compute
from assess.settings import Settings
from assess.units import GRAVITY
from tests.hazards import write_hazard
from tests.motion.grids import BAY, build_grid
from tests.pipeline.rows import read
from tests.workbooks import UNVERIFIED

FLOORS = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 12}]
PLACE = {"latitude": 37.7893, "longitude": -122.4008}
PGA = 0.1525 * GRAVITY


def _read(floors=FLOORS, ground=None, folder=BAY.parent, **building):
    items = [{"item": floor["floor"], "floor": floor["floor"], "breadth": 40, "height": 180} for floor in floors]
    named = {} if ground else {"shakemap": BAY.name}
    return read(items, floors, folder, ground, **PLACE | named | building)


def _messages(inventory, severity="note"):
    return [one.message for one in compute(inventory, UNVERIFIED).problems if one.severity == severity]


def test_floors_follow_a_beam_on_the_median_of_the_map():
    inventory = _read()
    demands = build_demands(inventory, "as filled")
    ground, roof = demands["1", "X"][0], demands["2", "Y"][0]
    assert (ground.pfa, ground.pfv) == pytest.approx((PGA, 0.1964), rel=1e-3)
    by_pga, by_pgv = find_medians(find_ground(inventory).building.period, 1.0, "unknown", ground.pfv / ground.pfa)
    assert (roof.pfa, roof.pfv) == pytest.approx((by_pga * ground.pfa, by_pgv * ground.pfv))
    assert {one.label for parallel in demands.values() for one in parallel} == {"ShakeMap, beam"}
    assert roof.flags == ("drawn_building", "shakemap")


def test_it_comes_after_ground_pgv_and_sds_and_before_shaking():
    assert find_ground(_read(sds=1.0)).site is None
    with_both = _read(shaking="MMI X, extreme")
    assert find_ground(with_both).shaking is None
    assert find_ground(with_both).pga == pytest.approx(PGA, rel=1e-3)
    assert "Shaking is not used: a ShakeMap gives the ground motion." in _messages(with_both)
    ground = find_ground(_read(ground_pgv=10)).motion
    assert (ground.pga, ground.pgv) == pytest.approx((PGA, 0.1), rel=1e-3)


@pytest.mark.parametrize(("own", "expected"), [(None, 0.0), (0.0, 0.0), (0.3, 0.3)])
def test_its_scatter_adds_to_the_buildings_own(own, expected):
    inventory = _read(motion_uncertainty=own)
    one = build_demands(inventory, "as filled")["2", "X"][0]
    assert one.dispersion == pytest.approx(math.hypot(expected, 0.0904), abs=1e-4)
    assert one.own_dispersion == expected
    assert set(compute(inventory, UNVERIFIED).cases.dispersion.tolist()) == {one.dispersion}


def test_floors_with_a_motion_of_their_own_keep_it_and_where_none_follows_it_nothing_is_added():
    floors = [one | {"pfa_x": 0.4} for one in FLOORS]
    inventory = _read(floors, motion_uncertainty=0.2)
    assert set(compute(inventory, UNVERIFIED).cases.dispersion.tolist()) == {0.2}
    assert "The ShakeMap grid.xml is not used: every floor has a motion of its own." in _messages(inventory)
    inventory = _read([FLOORS[0] | {"elevation": 3, "pfa_x": 0.4}, FLOORS[1]])
    demands = build_demands(inventory, "as filled")
    assert demands["1", "X"][0].source == "given"
    assert demands["2", "X"][0].flags == ("drawn_building", "shakemap")
    assert "floor 1 keeps its own motion, which could be that of another earthquake." in _messages(inventory)


def test_what_is_used_is_told_with_where_its_scatter_comes_from_and_an_automatic_map_is_warned_of():
    (text,) = (one for one in _messages(_read(motion_uncertainty=0.4)) if "gives" in one)
    assert "0.0904 (STDPGA of grid.xml); " in text
    assert "with 0.4, Motion uncertainty, the dispersion is 0.41, the root of the sum of their squares" in text
    data = build_grid({"PGA": ("pctg", (20,) * 4)}, (38.0, 37.0), (-123.0, -122.0), status="AUTOMATIC")
    automatic = _read(ground=parse_shakemap(data, "made.xml"))
    assert any("AUTOMATIC: nobody had reviewed it" in one for one in _messages(automatic, "warning"))
    (text,) = (one for one in _messages(automatic) if "gives" in one)
    assert "0.605 (assumed, as the map has none at this place: the total of Boore et al. 2014" in text


@pytest.mark.slow
def test_annual_chances_go_by_the_pga_and_leave_its_scatter_out(tmp_path):
    write_hazard(tmp_path)
    shutil.copy(BAY, tmp_path)
    inventory = _read(folder=tmp_path, hazard="hazard.csv")
    settings = Settings(runs=25)
    found = evaluate_annual(compute(inventory, settings), jobs=1, progress=assess.progress.SILENT)
    assert found is not None
    assert found.tables.ground_pga_g == pytest.approx(0.1525, rel=1e-3)
    assert found.tables.motion_dispersion == 0


def test_live_columns_leave_it_to_the_program():
    """A PFV that is not typed follows from the map, too."""
    own = FLOORS[0] | {"pfa_x": 0.4}
    one, two = live_values(_read([own | {"pfv_x": 40}, FLOORS[1]]))
    assert one[1] == pytest.approx(0.4), "the floor's own PFA"
    assert "run assess" not in one
    assert two[1:] == ["run assess"] * (len(two) - 1)
    one, _ = live_values(_read([own, FLOORS[1]]))
    assert one[1:] == ["run assess"] * (len(one) - 1)


def test_the_chances_of_a_simulation_hold_the_scatter():
    """The same piece under a map without scatter and with much: chances lie nearer to one half."""
    fields = {"PGA": ("pctg", (15,) * 4)}
    chances = []
    for sigma in (1e-9, 0.9):
        data = build_grid(fields | {"STDPGA": ("", (sigma,) * 4)}, (38.0, 37.0), (-123.0, -122.0))
        inventory = _read(FLOORS[:1], ground=parse_shakemap(data, "grid.xml"), motion_uncertainty=0.0, period=0.5)
        results = assess.run(inventory, Settings(runs=100))
        chances.append(results["1"].adopted.probability)
    assert chances[0] == 0
    assert 0.02 < chances[1] < 0.5


def test_scenarios_carry_their_part_of_the_dispersion(tmp_path):
    (tmp_path / "sites.csv").write_text("site_id,lon,lat\n0,-122.4008,37.7893\n", encoding="utf-8")
    (tmp_path / "gmf-data.csv").write_text(
        "site_id,event_id,gmv_PGA\n" + "".join(f"0,{at},{value}\n" for at, value in enumerate((0.1, 0.2, 0.4))),
        encoding="utf-8",
    )
    inventory = _read(ground=read_scenarios(tmp_path), motion_uncertainty=0.4)
    demands, sigma = build_demands(inventory, "as filled"), math.log(2) * math.sqrt(2 / 3)
    site = find_site(demands)
    assert site is not None
    assert site.dispersion == pytest.approx(sigma)
    assert demands["1", "X"][0].label == "scenarios, beam"
    earthquakes = compute(inventory, UNVERIFIED).cases.earthquakes
    assert earthquakes.given == pytest.approx((-(1.5**0.5), 0, 1.5**0.5))
    assert earthquakes.given_share == pytest.approx(sigma**2 / (sigma**2 + 0.16))


def test_a_run_with_a_map_equals_the_same_map_in_the_workbook():
    named, given = _read(), _read(ground=read_shakemap(BAY))
    one, two = (assess.run(each, UNVERIFIED) for each in (named, given))
    assert [each.adopted.probability for each in one] == [each.adopted.probability for each in two]
    assert one.provenance.site_ground == two.provenance.site_ground
