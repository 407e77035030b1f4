"""An assumed intensity: which ground motion serves the floors, how uncertain it is, and what is said of it."""

import pytest

import assess
from assess.intensity import SHAKINGS
from assess.motion.floor_medians import find_medians
from assess.pipeline.annual import evaluate_annual
from assess.pipeline.demand import build_demands, find_shaking
from assess.pipeline.known_ground import find_ground
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


def test_every_floor_follows_a_beam_on_its_median_pga_and_pgv(tmp_path):
    inventory = _read(tmp_path)
    demands = build_demands(inventory, "as filled")
    ground, roof = demands["1", "X"][0], demands["2", "Y"][0]
    assert (ground.pfa, ground.pfv) == pytest.approx((SEVEN.pga, SEVEN.pgv))
    by_pga, by_pgv = find_medians(find_ground(inventory).building.period, 1.0, "unknown", SEVEN.pgv / SEVEN.pga)
    assert (roof.pfa, roof.pfv) == pytest.approx((by_pga * SEVEN.pga, by_pgv * SEVEN.pgv))
    assert {one.label for parallel in demands.values() for one in parallel} == {"Shaking MMI VII, beam"}
    assert roof.flags == ("drawn_building", "assumed_shaking")
    assert find_shaking(demands) is SEVEN


def test_a_jma_class_gives_pgv_and_pga_is_drawn(tmp_path):
    inventory = _read(tmp_path, shaking="JMA 5+, upper")
    motion, shaking = find_ground(inventory).motion, SHAKINGS["JMA 5+, upper"]
    assert (motion.pga, motion.pgv) == (None, shaking.pgv)
    assert build_demands(inventory, "as filled")["1", "X"][0].pfa == pytest.approx(shaking.pga)


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


def test_a_ground_pgv_comes_before_its_own(tmp_path):
    ground = find_ground(_read(tmp_path, ground_pgv=10)).motion
    assert (ground.pga, ground.pgv) == (SEVEN.pga, pytest.approx(0.1))


def test_floors_with_a_pfa_of_their_own_keep_it_and_do_not_scatter(tmp_path):
    floors = [{"floor": "1", "elevation": 3, "pfa_x": 1.5}, {"floor": "2", "elevation": 12}]
    demands = build_demands(_read(tmp_path, floors), "as filled")
    own, other = demands["1", "X"][0], demands["2", "X"][0]
    assert (own.pfa, own.flags, own.dispersion) == (1.5 * GRAVITY, (), 0)
    assert (other.flags, other.dispersion) == (("drawn_building", "assumed_shaking"), 0.88)


@pytest.mark.parametrize(
    ("given", "used"),
    [({}, 0.88), ({"motion_uncertainty": 0.3}, 0.88), ({"motion_uncertainty": 0}, 0.88),
     ({"motion_uncertainty": 1.2}, 1.2)],
)  # fmt: skip
def test_the_motion_is_at_least_as_uncertain_as_pgv_given_the_intensity(tmp_path, given, used):
    """The published scatter stands in for a smaller value: sqrt(0.3^2 + 0.88^2) would be 0.93."""
    assert set(compute(_read(tmp_path, **given), UNVERIFIED).cases.dispersion.tolist()) == {used}


@pytest.mark.parametrize(
    "unused", [{"ground_pga": 0.3}, {"floors": [{"floor": "1", "pfa_x": 0.3}, {"floor": "2", "pfa_x": 0.3}]}]
)
def test_where_it_serves_no_floor_it_changes_no_uncertainty(tmp_path, unused):
    assert set(compute(_read(tmp_path, **unused), UNVERIFIED).cases.dispersion.tolist()) == {0}
    given = compute(_read(tmp_path, motion_uncertainty=0.3, **unused), UNVERIFIED)
    assert set(given.cases.dispersion.tolist()) == {0.3}


def test_chances_a_year_leave_out_the_scatter_of_pgv_given_an_intensity(tmp_path):
    """A hazard curve is of PGA itself: its chances hold at a PGA, not at an intensity; drawn motions scatter alone."""
    hazard = write_hazard(tmp_path).name
    settings = Settings(runs=20)
    for known in ({}, {"ground_pga": SEVEN.pga / GRAVITY, "shaking": None}):
        for given, used in ((None, 0.0), (0.3, 0.3)):
            inventory = _read(tmp_path, hazard=hazard, period=0.5, motion_uncertainty=given, **known)
            annual = evaluate_annual(compute(inventory, settings), jobs=1, progress=assess.progress.SILENT)
            assert annual.tables.motion_dispersion == used


def _notes(results):
    return {str(one).partition(": ")[2] for one in results.problem_rows if one.severity == "note"}


def test_a_smaller_motion_uncertainty_is_not_used_and_the_log_says_so(tmp_path):
    results = assessed(tmp_path / "w.xlsx", floors=FLOORS, shaking=CHOICE, motion_uncertainty=0.3)
    wanted = "Motion uncertainty 0.3 is not used: 0.88, the scatter of ln PGV given the assumed intensity, is larger."
    assert wanted in _notes(results)
    results = assessed(tmp_path / "w.xlsx", floors=FLOORS, shaking=CHOICE, motion_uncertainty=0.9)
    assert not [note for note in _notes(results) if note.startswith("Motion uncertainty")]


@pytest.mark.parametrize(
    ("unused", "why"),
    [({"ground_pga": 0.3}, "Ground PGA or SDS is filled in"),
     ({"floors": [{"floor": "1", "pfa_x": 0.3}, {"floor": "2", "pfa_x": 0.3}]}, "every floor has a motion of its own")],
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
    """The third floor of four lies at 9 of 12 m."""
    inventory = _read(tmp_path, NUMBERED, height=12, storeys=4)
    demands = build_demands(inventory, "as filled")
    ratios = [demands[floor["floor"], "X"][0].height_ratio for floor in NUMBERED]
    assert ratios == pytest.approx([0, 0.25, 0.75])
    placed = [{"floor": "3", "elevation": 9}]
    assert demands["3", "Y"][0].pfa == build_demands(_read(tmp_path, placed, height=12), "as filled")["3", "Y"][0].pfa
    assert demands["3", "Y"][0].flags == ("drawn_building", "assumed_shaking", "assumed_elevation")
    wanted = "3 floors have no Elevation (G, 1, 3); their numbers times Height over Storeys"
    results = assess.run(inventory, UNVERIFIED)
    (note,) = [note for note in _notes(results) if note.startswith(wanted)]
    assert "place a floor too low where lower storeys are higher" in note


def test_with_a_ground_pga_too(tmp_path):
    demands = build_demands(_read(tmp_path, NUMBERED, height=12, storeys=4, shaking=None, ground_pga=0.2), "EN 1998-1")
    assert demands["3", "X"][0].pfa == pytest.approx(0.2 * GRAVITY * (1 + 1.5 * 0.75))


def test_a_ground_floor_at_0_begins_the_numbers_of_the_others(tmp_path):
    """As the templates fill it in: floor 1 at 0, so that floor 3 lies two of four storeys up."""
    floors = [{"floor": "1", "elevation": 0}, {"floor": "2"}, {"floor": "3"}]
    inventory = _read(tmp_path, floors, height=12, storeys=4)
    demands = build_demands(inventory, "as filled")
    assert [demands[floor["floor"], "X"][0].height_ratio for floor in floors] == pytest.approx([0, 0.25, 0.5])
    notes = _notes(assess.run(inventory, UNVERIFIED))
    assert any(
        "2 floors have no Elevation (2, 3)" in one and "the ground floor as 1, are assumed" in one for one in notes
    )


def test_a_new_template_needs_no_elevations_beside_height_and_storeys(tmp_path):
    """Found by a first user: the Elevation of 0 that the template fills in made all others necessary."""
    floors = [{"floor": "1", "elevation": 0, "pfa_x": 0.2}, {"floor": "2"}]
    served = _read(tmp_path, floors, height=12, storeys=4, shaking=None)
    assert build_demands(served, "as filled")["2", "X"][0].height_ratio == pytest.approx(0.25)
    with pytest.raises(assess.WorkbookError, match="floor '2' has neither a record nor a PFA, no Elevation"):
        _read(tmp_path, [floors[0] | {"elevation": 4}, floors[1]], height=12, storeys=4, shaking=None)


def test_storeys_alone_give_the_height(tmp_path):
    """Three metres each."""
    inventory = _read(tmp_path, NUMBERED, storeys=4)
    assert find_ground(inventory).roof == 12
    demands = build_demands(inventory, "as filled")
    assert [demands[floor["floor"], "X"][0].height_ratio for floor in NUMBERED] == pytest.approx([0, 0.25, 0.75])


@pytest.mark.parametrize(
    ("floors", "building"),
    [
        (NUMBERED[1:], {"height": 12}), ([{"floor": "Roof"}], {"height": 12, "storeys": 4}),
        ([{"floor": "3"}, {"floor": "2", "elevation": 8}], {"height": 12, "storeys": 4}),
    ],
    ids=["no storeys", "no number", "a floor with an elevation"],
)  # fmt: skip
def test_else_its_height_is_drawn(tmp_path, floors, building):
    inventory = _read(tmp_path, floors, **building)
    one = build_demands(inventory, "as filled")[floors[0]["floor"], "X"][0]
    assert (one.height_ratio, one.flags) == (None, ("drawn_building", "assumed_shaking", "unknown_height"))


def test_the_choices_of_shaking_hold_commas_and_are_told_apart(tmp_path):
    with pytest.raises(assess.WorkbookError, match=r"expected one of: MMI IV, light; MMI V, moderate; MMI VI, strong;"):
        assess.read_inventory(write(tmp_path / "w.xlsx", shaking="MMI 3"))
