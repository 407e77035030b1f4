"""An assumed intensity: which ground motion serves the floors, how uncertain it is, and what is said of it."""

import pytest

import assess
from assess.intensity import SHAKINGS
from assess.motion.floor_medians import find_medians
from assess.pipeline.demand import build_demands, find_shaking
from assess.pipeline.known_ground import find_ground
from assess.pipeline.run import compute
from assess.settings import Settings
from assess.units import GRAVITY
from tests.hazards import write_hazard
from tests.pipeline.rows import read
from tests.workbooks import UNVERIFIED

CHOICE = "MMI VII, very strong"
SEVEN = SHAKINGS[CHOICE]
FLOORS = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 12}]


def _read(floors=FLOORS, folder=None, **building):
    items = [{"item": floor["floor"], "floor": floor["floor"], "breadth": 40, "height": 180} for floor in floors]
    return read(items, floors, folder, **{"shaking": CHOICE} | building)


def test_every_floor_follows_a_beam_on_its_median_pga_and_pgv():
    inventory = _read()
    demands = build_demands(inventory, "as filled")
    ground, roof = demands["1", "X"][0], demands["2", "Y"][0]
    assert (ground.pfa, ground.pfv) == pytest.approx((SEVEN.pga, SEVEN.pgv))
    by_pga, by_pgv = find_medians(find_ground(inventory).building.period, 1.0, "unknown", SEVEN.pgv / SEVEN.pga)
    assert (roof.pfa, roof.pfv) == pytest.approx((by_pga * SEVEN.pga, by_pgv * SEVEN.pgv))
    assert {one.label for parallel in demands.values() for one in parallel} == {"Shaking MMI VII, beam"}
    assert roof.flags == ("drawn_building", "assumed_shaking")
    assert find_shaking(demands) is SEVEN


def test_a_jma_class_gives_pgv_and_pga_is_drawn_and_a_chosen_code_starts_from_it_too():
    inventory = _read(shaking="JMA 5+, upper")
    motion, shaking = find_ground(inventory).motion, SHAKINGS["JMA 5+, upper"]
    assert (motion.pga, motion.pgv) == (None, shaking.pgv)
    assert build_demands(inventory, "as filled")["1", "X"][0].pfa == pytest.approx(shaking.pga)
    demands = build_demands(_read(), "NTC 2018")
    assert demands["2", "X"][0].pfa == pytest.approx(2 * SEVEN.pga)
    assert demands["2", "X"][0].label == "Shaking MMI VII, NTC 2018"


@pytest.mark.parametrize(("known", "pga"), [({"ground_pga": 0.1}, 0.1), ({"sds": 0.5}, 0.2)])
def test_what_is_known_of_the_ground_comes_first(known, pga):
    inventory = _read(**known)
    ground, demands = find_ground(inventory), build_demands(inventory, "as filled")
    assert ground.pga == pytest.approx(pga * GRAVITY)
    assert ground.shaking is None
    assert find_shaking(demands) is None
    assert "assumed_shaking" not in demands["1", "X"][0].flags


@pytest.mark.parametrize(
    ("unused", "why"),
    [({"ground_pga": 0.3}, "Ground PGA or SDS is filled in"),
     ({"floors": [{"floor": "1", "pfa_x": 0.3}, {"floor": "2", "pfa_x": 0.3}]}, "every floor has a motion of its own")],
)  # fmt: skip
def test_where_it_serves_no_floor_it_changes_no_uncertainty_and_a_note_says_so(unused, why):
    for given in (None, 0.3):
        inventory = _read(motion_uncertainty=given, **unused)
        assert set(compute(inventory, UNVERIFIED).cases.dispersion.tolist()) == {given or 0}
        assert f"Shaking is not used: {why}." in _notes(inventory)


@pytest.mark.parametrize(("given", "used"), [(None, 0.0), (0.3, 0.3)])
def test_chances_a_year_leave_out_the_scatter_of_pgv_given_an_intensity(tmp_path, given, used):
    """A hazard curve is of PGA itself: its chances hold at a PGA, not at an intensity; drawn motions scatter alone."""
    hazard = write_hazard(tmp_path).name
    inventory = _read(FLOORS[:1], tmp_path, hazard=hazard, period=0.5, motion_uncertainty=given)
    assert compute(inventory, Settings(runs=20)).annual.tables.motion_dispersion == used


def _notes(inventory):
    return {one.message for one in compute(inventory, UNVERIFIED).problems if one.severity == "note"}


def test_a_smaller_motion_uncertainty_is_not_used_and_the_log_says_so():
    wanted = "Motion uncertainty 0.3 is not used: 0.88, the scatter of ln PGV given the assumed intensity, is larger."
    assert wanted in _notes(_read(motion_uncertainty=0.3))
    assert not [one for one in _notes(_read(motion_uncertainty=0.9)) if one.startswith("Motion uncertainty")]


@pytest.mark.parametrize("typed", ["mmi vii, very strong", "MMI VII", " JMA 5- ", "JMA 5+, upper"])
def test_a_choice_as_people_type_it(typed):
    wanted = {"J": SHAKINGS["JMA 5-, lower" if "-" in typed else "JMA 5+, upper"]}.get(typed.strip()[0].upper(), SEVEN)
    assert find_ground(_read(shaking=typed)).shaking is wanted


# ---------------------------------------------------------------- a town, storeys and a height


NUMBERED = [{"floor": "G"}, {"floor": "1"}, {"floor": "3"}]


def test_numbered_floors_need_no_elevation_where_storeys_are_known():
    """The third floor of four lies at 9 of 12 m; a storey is 3 m where Height is blank."""
    for height in (12, None):
        inventory = _read(NUMBERED, height=height, storeys=4)
        assert find_ground(inventory).roof == 12
        demands = build_demands(inventory, "as filled")
        ratios = [demands[floor["floor"], "X"][0].height_ratio for floor in NUMBERED]
        assert ratios == pytest.approx([0, 0.25, 0.75])
    one, placed = demands["3", "Y"][0], _read([{"floor": "3", "elevation": 9}], height=12)
    assert one.pfa == build_demands(placed, "as filled")["3", "Y"][0].pfa
    assert one.flags == ("drawn_building", "assumed_shaking", "assumed_elevation")
    text = "3 floors have no Elevation (G, 1, 3); their numbers times Height over Storeys"
    assert len([note for note in _notes(_read(NUMBERED, height=12, storeys=4)) if note.startswith(text)]) == 1
    by_code = build_demands(_read(NUMBERED, height=12, storeys=4, shaking=None, ground_pga=0.2), "EN 1998-1")
    assert by_code["3", "X"][0].pfa == pytest.approx(0.2 * GRAVITY * (1 + 1.5 * 0.75))


def test_a_ground_floor_at_0_begins_the_numbers_of_the_others():
    """As the templates fill it in: floor 1 at 0, so that floor 3 lies two of four storeys up."""
    inventory = _read([FLOORS[0], {"floor": "2"}, {"floor": "3"}], height=12, storeys=4)
    demands = build_demands(inventory, "as filled")
    assert [demands[one, "X"][0].height_ratio for one in "123"] == pytest.approx([0, 0.25, 0.5])
    (note,) = [one for one in _notes(inventory) if one.startswith("2 floors have no Elevation (2, 3)")]
    assert "counted from the ground floor as 1, are assumed" in note


def test_a_new_template_needs_no_elevations_beside_height_and_storeys():
    """Found by a first user: the Elevation of 0 that the template fills in made all others necessary."""
    floors = [{"floor": "1", "elevation": 0, "pfa_x": 0.2}, {"floor": "2"}]
    served = _read(floors, height=12, storeys=4, shaking=None)
    assert build_demands(served, "as filled")["2", "X"][0].height_ratio == pytest.approx(0.25)
    with pytest.raises(assess.WorkbookError, match="floor '2' has neither a record nor a PFA, no Elevation"):
        build_demands(_read([floors[0] | {"elevation": 4}, floors[1]], height=12, storeys=4, shaking=None), "as filled")


@pytest.mark.parametrize(
    ("floors", "building"),
    [
        (NUMBERED[1:], {"height": 12}), ([{"floor": "Roof"}], {"height": 12, "storeys": 4}),
        ([{"floor": "3"}, {"floor": "2", "elevation": 8}], {"height": 12, "storeys": 4}),
    ],
    ids=["no storeys", "no number", "a floor with an elevation"],
)  # fmt: skip
def test_else_its_height_is_drawn(floors, building):
    inventory = _read(floors, **building)
    one = build_demands(inventory, "as filled")[floors[0]["floor"], "X"][0]
    assert (one.height_ratio, one.flags) == (None, ("drawn_building", "assumed_shaking", "unknown_height"))


def test_the_choices_of_shaking_hold_commas_and_are_told_apart():
    with pytest.raises(assess.WorkbookError, match=r"expected one of: MMI IV, light; MMI V, moderate; MMI VI, strong;"):
        _read(shaking="MMI 3")
