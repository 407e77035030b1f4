"""An assumed intensity: which ground motion serves the floors, how uncertain it is, and what is said of it."""

import pytest

import assess
from assess.intensity import SHAKINGS
from assess.motion.scenario import cap_pfv, estimate_pfv
from assess.pipeline.annual import evaluate_annual
from assess.pipeline.demand import build_demands, find_ground, find_shaking
from assess.pipeline.run import compute
from assess.settings import Settings
from assess.units import GRAVITY
from tests.hazards import write_hazard
from tests.workbooks import UNVERIFIED, assessed, write

CHOICE = "MMI VII, very strong"
SEVEN = SHAKINGS[CHOICE]
FLOORS = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 12}]


def _read(folder, floors=FLOORS, **building):
    items = [{"item": floor["floor"], "floor": floor["floor"], "breadth": 40, "height": 180} for floor in floors]
    return assess.read_inventory(write(folder / "w.xlsx", items, floors, **{"shaking": CHOICE} | building))


def test_every_floor_follows_the_profile_from_its_median_pga(tmp_path):
    demands = build_demands(_read(tmp_path), "as filled")
    ground, roof = demands["1", "X"][0], demands["2", "Y"][0]
    assert ground.pfa == SEVEN.pga
    assert roof.pfa == pytest.approx(3.5 * SEVEN.pga)
    assert {one.label for parallel in demands.values() for one in parallel} == {"Shaking MMI VII, ASCE 7-22"}
    assert roof.flags == ("code_profile", "assumed_shaking")
    assert find_shaking(demands) is SEVEN


def test_a_chosen_code_starts_from_it_too(tmp_path):
    demands = build_demands(_read(tmp_path), "NTC 2018")
    assert demands["2", "X"][0].pfa == pytest.approx(2 * SEVEN.pga)
    assert demands["2", "X"][0].label == "Shaking MMI VII, NTC 2018"


@pytest.mark.parametrize(("known", "pga"), [({"ground_pga": 0.1}, 0.1), ({"sds": 0.5}, 0.2)])
def test_what_is_known_of_the_ground_comes_first(tmp_path, known, pga):
    inventory = _read(tmp_path, **known)
    ground, demands = find_ground(inventory), build_demands(inventory, "as filled")
    assert ground.pga == pytest.approx(pga * GRAVITY)
    assert ground.shaking is None
    assert find_shaking(demands) is None
    assert "assumed_shaking" not in demands["1", "X"][0].flags


def test_its_pgv_caps_an_estimated_pfv_unless_a_ground_pgv_is_given(tmp_path):
    own = build_demands(_read(tmp_path, period=3.0), "as filled")["2", "X"][0]
    assert own.pfv == cap_pfv(SEVEN.pgv) < estimate_pfv(own.pfa, 3.0)
    assert own.flags == ("code_profile", "assumed_shaking", "pfv_estimated", "pfv_capped")
    given = build_demands(_read(tmp_path, period=3.0, ground_pgv=10), "as filled")["2", "X"][0]
    assert given.pfv == pytest.approx(cap_pfv(0.1))


def test_it_does_not_cap_floors_with_a_pfa_of_their_own(tmp_path):
    floors = [{"floor": "1", "elevation": 0, "pfa_x": 1.5}, {"floor": "2", "elevation": 12}]
    own = build_demands(_read(tmp_path, floors, period=3.0), "as filled")["1", "X"][0]
    assert own.flags == ("pfv_estimated",)
    assert own.pfv == estimate_pfv(1.5 * GRAVITY, 3.0) > cap_pfv(SEVEN.pgv)


@pytest.mark.parametrize(
    ("given", "used"),
    [({}, 0.81), ({"motion_uncertainty": 0.3}, 0.81), ({"motion_uncertainty": 0}, 0.81),
     ({"motion_uncertainty": 1.2}, 1.2)],
)  # fmt: skip
def test_the_motion_is_at_least_as_uncertain_as_pga_given_the_intensity(tmp_path, given, used):
    """The published scatter stands in for a smaller value: sqrt(0.3^2 + 0.81^2) would be 0.86."""
    assert compute(_read(tmp_path, **given), UNVERIFIED).cases.uncertainty.motion == used


@pytest.mark.parametrize(
    "unused", [{"ground_pga": 0.3}, {"floors": [{"floor": "1", "pfa_x": 0.3}, {"floor": "2", "pfa_x": 0.3}]}]
)
def test_where_it_serves_no_floor_it_changes_no_uncertainty(tmp_path, unused):
    assert compute(_read(tmp_path, **unused), UNVERIFIED).cases.uncertainty.motion == 0.4


def test_chances_a_year_leave_out_the_scatter_of_pga_given_an_intensity(tmp_path):
    """A hazard curve is of PGA itself: its chances hold at a PGA, not at an intensity."""
    hazard = write_hazard(tmp_path).name
    settings = Settings(runs=20)
    for known in ({}, {"ground_pga": SEVEN.pga / GRAVITY, "shaking": None}):
        assessment = compute(_read(tmp_path, hazard=hazard, period=0.5, **known), settings)
        annual = evaluate_annual(assessment, jobs=1, progress=assess.progress.SILENT)
        assert annual.tables.motion_dispersion == 0.4


def _notes(results):
    return {str(one).partition(": ")[2] for one in results.problem_rows if one.severity == "note"}


def test_a_smaller_motion_uncertainty_is_not_used_and_the_log_says_so(tmp_path):
    results = assessed(tmp_path / "w.xlsx", floors=FLOORS, shaking=CHOICE, motion_uncertainty=0.3)
    wanted = "Motion uncertainty 0.3 is not used: 0.81, the scatter of ln PGA given the assumed intensity, is larger."
    assert wanted in _notes(results)
    results = assessed(tmp_path / "w.xlsx", floors=FLOORS, shaking=CHOICE, motion_uncertainty=0.9)
    assert not [note for note in _notes(results) if note.startswith("Motion uncertainty")]


@pytest.mark.parametrize(
    ("unused", "why"),
    [({"ground_pga": 0.3}, "Ground PGA or SDS is filled in"),
     ({"floors": [{"floor": "1", "pfa_x": 0.3}, {"floor": "2", "pfa_x": 0.3}]}, "no floor follows a profile")],
)  # fmt: skip
def test_an_intensity_that_is_not_used_has_a_note(tmp_path, unused, why):
    results = assessed(tmp_path / "w.xlsx", **{"floors": FLOORS, "shaking": CHOICE} | unused)
    assert f"Shaking is not used: {why}." in _notes(results)
    assert results.provenance.shaking is None


@pytest.mark.parametrize("typed", ["mmi vii, very strong", "MMI VII", " JMA 5- ", "JMA 5+, upper"])
def test_a_choice_as_people_type_it(tmp_path, typed):
    wanted = {"J": SHAKINGS["JMA 5-, lower" if "-" in typed else "JMA 5+, upper"]}.get(typed.strip()[0].upper(), SEVEN)
    assert find_ground(_read(tmp_path, shaking=typed)).shaking is wanted


# ---------------------------------------------------------------- a town, storeys and a height


NUMBERED = [{"floor": "G"}, {"floor": "1"}, {"floor": "3"}]


def test_numbered_floors_need_no_elevation_where_height_and_storeys_are_known(tmp_path):
    """The third floor of four lies at 9 of 12 m: H_f = 1 + 2.5 x 0.75."""
    inventory = _read(tmp_path, NUMBERED, height=12, storeys=4)
    demands = build_demands(inventory, "as filled")
    ratios = [demands[floor["floor"], "X"][0].height_ratio for floor in NUMBERED]
    assert ratios == pytest.approx([0, 0.25, 0.75])
    assert demands["3", "Y"][0].pfa == pytest.approx((1 + 2.5 * 0.75) * SEVEN.pga)
    assert demands["3", "Y"][0].flags == ("code_profile", "assumed_shaking", "assumed_elevation")
    wanted = "3 floors have no Elevation (G, 1, 3); their numbers times Height over Storeys"
    results = assess.run(inventory, UNVERIFIED)
    (note,) = [note for note in _notes(results) if note.startswith(wanted)]
    assert "place a floor too low where lower storeys are higher" in note


def test_with_a_ground_pga_too(tmp_path):
    demands = build_demands(_read(tmp_path, NUMBERED, height=12, storeys=4, shaking=None, ground_pga=0.2), "EN 1998-1")
    assert demands["3", "X"][0].pfa == pytest.approx(0.2 * GRAVITY * (1 + 1.5 * 0.75))


@pytest.mark.parametrize(
    ("floors", "building"),
    [
        (NUMBERED, {"height": 12}), (NUMBERED, {"storeys": 4}), ([{"floor": "Roof"}], {"height": 12, "storeys": 4}),
        ([{"floor": "2", "elevation": 8}, {"floor": "3"}], {"height": 12, "storeys": 4}),
    ],
    ids=["no storeys", "no height", "no number", "a floor with an elevation"],
)  # fmt: skip
def test_else_elevation_stays_required(tmp_path, floors, building):
    with pytest.raises(assess.WorkbookError, match=r"no Elevation from which its motion could be derived") as caught:
        _read(tmp_path, floors, **building)
    assert caught.value.is_incomplete


def test_the_choices_of_shaking_hold_commas_and_are_told_apart(tmp_path):
    with pytest.raises(assess.WorkbookError, match=r"expected one of: MMI IV, light; MMI V, moderate; MMI VI, strong;"):
        assess.read_inventory(write(tmp_path / "w.xlsx", shaking="MMI 3"))
