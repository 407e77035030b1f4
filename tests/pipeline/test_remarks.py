"""What a run remarks on the motion of the floors."""

import shutil

import pytest

import assess
from assess.i18n import count
from tests.workbooks import RECORDS, write

PIECE = [{"item": "a", "floor": "1", "breadth": 40, "height": 180}]
SMC = "0165a_u.smc"


def _remarks(tmp_path, floors, scenario=None, **building):
    """Return the remarks by their texts; a Ground PGA has a usual Ground PGV beside it."""
    shutil.copy(RECORDS / SMC, tmp_path / SMC)
    building = {"ground_pgv": 100 * building["ground_pga"]} | building if building.get("ground_pga") else building
    inventory = assess.read_inventory(write(tmp_path / "w.xlsx", PIECE, floors, **building))
    assessment = assess.run(inventory, assess.Settings(scenario=scenario, verify="none"))
    return {str(one): one.severity for one in assessment.problem_rows if one not in inventory.problems}


def _starting(remarks, start):
    (found,) = [(text, severity) for text, severity in remarks.items() if text.startswith(start)]
    return found


def test_a_plain_run_remarks_nothing(tmp_path):
    assert _remarks(tmp_path, [{"floor": "1", "elevation": 3, "pfa_x": 0.3}]) == {}


@pytest.mark.parametrize(("pga", "severity"), [(0.01, "warning"), (0.9, "note")])
def test_a_profile_says_which_record_and_pfa_it_sets_aside(tmp_path, pga, severity):
    floors = [{"floor": "1", "elevation": 0, "record_x": SMC, "pfa_y": 0.4}]
    remarks = _remarks(tmp_path, floors, "ASCE 7-22", ground_pga=pga)
    text, kind = _starting(remarks, "Floors!H2: Record X of floor '1' is not used: its PFA is ")
    assert f"the scenario 'ASCE 7-22' uses {pga:.3f} g. Scenario 'recorded' uses it." in text
    assert kind == severity
    text = f"Floors!E2: PFA Y 0.400 g of floor '1' is not used: the scenario 'ASCE 7-22' uses {pga:.3f} g."
    assert remarks[f"{text} Scenario 'given' uses it."] == severity


def test_given_sets_a_record_aside_and_recorded_a_pfa(tmp_path):
    floors = [{"floor": "1", "record_x": SMC, "pfa_x": 0.001}]
    text, kind = _starting(_remarks(tmp_path, floors, "given"), "Floors!H2: Record X of floor '1' is not used: its PFA")
    assert "the scenario 'given' uses 0.001 g" in text
    assert kind == "warning"
    text, kind = _starting(_remarks(tmp_path, floors, "recorded"), "Floors!D2: PFA X 0.001 g of floor '1' is not")
    assert "is not used: the record is used, with 0.271 g." in text
    assert kind == "note"


@pytest.mark.parametrize(("scenario", "why"), [(None, "every floor has a record"), ("recorded", "scenario 'recorded'")])
def test_ground_motion_that_no_floor_needs_is_kept_not_used(tmp_path, scenario, why):
    remarks = _remarks(tmp_path, [{"floor": "1", "record_x": SMC}], scenario, ground_pga=0.2, sds=0.5)
    assert remarks == {
        f"Building!B21: Ground PGA is not used: {why}.": "note",
        "Building!B22: Ground PGV is not used: every floor has a record.": "note",
        f"Building!B23: SDS is used for the code's force on anchors only: {why}.": "note",
    }


def test_without_sds_the_codes_force_on_anchors_follows_ground_pga(tmp_path):
    remarks = _remarks(tmp_path, [{"floor": "1", "record_x": SMC}], ground_pga=0.2, ground_pgv=None)
    text = "Building!B21: Ground PGA is used for the code's force on anchors only: every floor has a record."
    assert remarks == {text: "note"}


@pytest.mark.parametrize(
    ("floor", "building", "text"),
    [
        ({"elevation": None}, {}, "neither T1, Height, Storeys nor an Elevation is known, so that buildings of every"),
        ({"elevation": None}, {"period": 1}, "its height in the building is not known and is drawn. Fill in Elev"),
        ({"elevation": 3}, {}, None),
    ],
)
def test_an_unknown_building_and_an_unknown_height_are_told(tmp_path, floor, building, text):
    for motion in ({"pfa_x": 0.3}, {}):
        remarks = _remarks(tmp_path, [{"floor": "1", **floor, **motion}], ground_pga=0.2, **building)
        found = [(one, severity) for one, severity in remarks.items() if one.startswith("Floors!C2: floor 1: ")]
        assert [severity for _, severity in found] == (["warning"] if text else [])
        assert all(text in one for one, _ in found)


@pytest.mark.parametrize(("sds", "severity"), [(0.5, None), (0.503, None), (0.6, "warning"), (0.4, "note")])
def test_ground_pga_comes_before_an_sds_that_differs(tmp_path, sds, severity):
    """0.4 x 0.503 = 0.2012 differs from 0.2 by 0.6 %; 0.24 would shake more, 0.16 less."""
    remarks = _remarks(tmp_path, [{"floor": "1", "elevation": 3}], ground_pga=0.2, sds=sds)
    values = f"0.4 SDS is {0.4 * sds:.3f} g, but floors follow Ground PGA 0.200 g"
    text = (
        f"Building!B23: SDS is used for the code's force on anchors only: {values}. Correct one of them, or clear it."
    )
    assert remarks == ({text: severity} if severity else {})


def test_a_floor_above_the_roof_is_told(tmp_path):
    floors = [{"floor": "1", "elevation": 12}]
    text = "Floors!C2: Elevation 12 m is above the roof, 10 m: z/h is taken as 1. Check it, and Height in Building."
    assert _remarks(tmp_path, floors, ground_pga=0.2, height=10) == {text: "warning"}
    assert _remarks(tmp_path, floors, ground_pga=0.2, height=12) == {}


@pytest.mark.parametrize(("pga", "severity"), [(0.01, "warning"), (0.9, "note")])
def test_a_given_pfv_that_a_profile_sets_aside_is_told(tmp_path, pga, severity):
    """The profile's PFV is PFA times what the beam has, here of 0.01 g about 1 cm/s and of 0.9 g about 90."""
    floors = [{"floor": "1", "elevation": 4, "pfa_x": 0.001, "pfv_x": 30}]
    remarks = _remarks(tmp_path, floors, "ASCE 7-16", ground_pga=pga / 3, period=0.2)
    text, kind = _starting(
        remarks, "Floors!F2: PFV X 30.0 cm/s of floor '1' is not used: the scenario 'ASCE 7-16' uses"
    )
    assert text.endswith(" cm/s. Scenario 'given' uses it.")
    assert kind == severity


def test_a_given_pfv_beside_a_record_is_told(tmp_path):
    floors = [{"floor": "1", "elevation": 4, "record_x": SMC, "pfv_x": 300}]
    text, kind = _starting(_remarks(tmp_path, floors), "Floors!F2: PFV X 300.0 cm/s of floor '1' is not used: the rec")
    assert "the record is used, with " in text
    assert kind == "warning"


def test_in_a_building_of_basements_no_floor_is_above_the_roof(tmp_path):
    floors = [{"floor": "1", "elevation": -3}, {"floor": "B2", "elevation": -6}]
    assert _remarks(tmp_path, floors, ground_pga=0.2) == {}


@pytest.mark.parametrize(("storeys", "each"), [(1, "30"), (4, "7.5"), (15, "2"), (5, ""), (12, ""), (None, "")])
def test_a_height_that_does_not_fit_the_storeys_is_told(tmp_path, storeys, each):
    floors = [{"floor": "1", "elevation": 27}]
    text = (
        f"Building!B8: Height 30 m over {count(storeys or 0, 'storey')} is {each} m a storey, outside 2.5 to 6 m. "
        "Check Height and Storeys."
    )
    building = {"storeys": storeys} if storeys else {}
    remarks = _remarks(tmp_path, floors, ground_pga=0.2, height=30, **building)
    assert remarks == ({text: "warning"} if each else {})


def test_a_height_far_above_the_floors_listed_is_noted(tmp_path):
    text = "Building!B8: z/h is taken against Height 131 m; the highest floor listed is at 36 m."
    floors = [{"floor": "1", "elevation": 36}]
    assert _remarks(tmp_path, floors, ground_pga=0.2, height=131) == {text: "note"}
    assert _remarks(tmp_path, floors, ground_pga=0.2, height=54) == {}


@pytest.mark.parametrize("scenario", [None, "ASCE 7-22"])
@pytest.mark.parametrize(("period", "odd"), [(0.1, True), (0.12, False), (1.5, False), (1.6, True)])
def test_a_period_that_does_not_fit_the_height_is_told(tmp_path, scenario, period, odd):
    """0.0488 x 16^0.75 = 0.3904 s; x 0.3 = 0.117 s, x 4 = 1.56 s."""
    remarks = _remarks(tmp_path, [{"floor": "1", "elevation": 16}], scenario, ground_pga=0.2, period=period)
    text = (
        f"Building!B9: Period T1 {period:g} s is outside 0.117 to 1.56 s, 0.3 to 4 times 0.0488 h^0.75 (ASCE 7-22 Eq. "
        "12.8-7) for a height h of 16 m. Check Period T1 and Height."
    )
    assert remarks == ({text: "warning"} if odd else {})


def test_what_no_floor_follows_is_not_questioned(tmp_path):
    floors = [{"floor": "1", "elevation": 3, "pfa_x": 0.3, "pfv_x": 30}]
    assert _remarks(tmp_path, floors, height=300, storeys=2, period=15) == {}


def test_mixed_sources_are_listed(tmp_path):
    floors = [
        {"floor": "1", "elevation": 0, "record_x": SMC},
        {"floor": "2", "elevation": 4},
        {"floor": "3", "elevation": 8, "pfa_x": 0.1},
        {"floor": "4", "elevation": 12},
    ]
    remarks = _remarks(tmp_path, floors, ground_pga=0.3)
    text = (
        "Floors: the motion of the floors comes from mixed sources: recorded motion (1); given peaks (3); drawn "
        "buildings on the ground motion (2, 4)."
    )
    assert remarks[text] == "note"
