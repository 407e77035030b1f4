"""What a run remarks on the motion of the floors."""

import shutil

import pytest

import assess
from assess.i18n import count
from tests.workbooks import RECORDS, write

PIECE = [{"item": "a", "floor": "1", "breadth": 40, "height": 180}]
SMC = "0165a_u.smc"


def _remarks(tmp_path, floors, scenario=None, **building):
    shutil.copy(RECORDS / SMC, tmp_path / SMC)
    inventory = assess.read_inventory(write(tmp_path / "w.xlsx", PIECE, floors, **building))
    assessment = assess.run(inventory, assess.Settings(scenario=scenario, verify="none"))
    return {str(one): one.severity for one in assessment.problem_rows if one not in inventory.problems}


def _starting(remarks, start):
    (found,) = [(text, severity) for text, severity in remarks.items() if text.startswith(start)]
    return found


def test_a_plain_run_remarks_nothing(tmp_path):
    assert _remarks(tmp_path, [{"floor": "1", "pfa_x": 0.3}]) == {}


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


@pytest.mark.parametrize(("scenario", "why"), [(None, "no floor follows a profile"), ("given", "scenario 'given'")])
def test_ground_motion_that_no_floor_needs_is_kept_not_used(tmp_path, scenario, why):
    remarks = _remarks(tmp_path, [{"floor": "1", "pfa_x": 0.3}], scenario, ground_pga=0.2, sds=0.5)
    assert remarks == {
        f"Building!B20: Ground PGA is not used: {why}.": "note",
        f"Building!B22: SDS is used for the code's force on anchors only: {why}.": "note",
    }


def test_without_sds_the_codes_force_on_anchors_follows_ground_pga(tmp_path):
    remarks = _remarks(tmp_path, [{"floor": "1", "pfa_x": 0.3}], ground_pga=0.2)
    text = "Building!B20: Ground PGA is used for the code's force on anchors only: no floor follows a profile."
    assert remarks == {text: "note"}


@pytest.mark.parametrize("floor", [{"pfa_x": 0.3}, {"pfa_x": 0.3, "pfv_x": 40}])
def test_a_ground_velocity_that_caps_no_estimate_is_not_used(tmp_path, floor):
    period = 2.0 if "pfv_x" in floor else None
    remarks = _remarks(tmp_path, [{"floor": "1", **floor}], ground_pgv=23, period=period)
    assert remarks == {"Building!B21: Ground PGV is not used: no PFV is estimated.": "note"}


@pytest.mark.parametrize(("pgv", "is_small"), [(10, True), (11, False)])
def test_a_ground_velocity_too_small_for_a_floor_is_told(tmp_path, pgv, is_small):
    """3.93 x 10 = 39.3 cm/s is below the 40 cm/s of floor 2, 3.93 x 11 = 43.2 cm/s above."""
    floors = [{"floor": "1", "pfa_x": 0.3}, {"floor": "2", "pfa_x": 0.2, "pfv_x": 40}]
    text = (
        "Building!B21: Ground PGV 10.0 cm/s caps the PFV that is estimated at 39.3 cm/s, but the PFV of floor '2' is "
        "40.0 cm/s: the estimate for other floors may be too low. Check Ground PGV in Building."
    )
    remarks = _remarks(tmp_path, floors, ground_pgv=pgv, period=2.0)
    assert remarks == ({text: "warning"} if is_small else {})


@pytest.mark.parametrize(("sds", "severity"), [(0.5, None), (0.503, None), (0.6, "warning"), (0.4, "note")])
def test_ground_pga_comes_before_an_sds_that_differs(tmp_path, sds, severity):
    """0.4 x 0.503 = 0.2012 differs from 0.2 by 0.6 %; 0.24 would shake more, 0.16 less."""
    remarks = _remarks(tmp_path, [{"floor": "1", "elevation": 3}], ground_pga=0.2, sds=sds)
    values = f"0.4 SDS is {0.4 * sds:.3f} g, but floors follow Ground PGA 0.200 g"
    text = (
        f"Building!B22: SDS is used for the code's force on anchors only: {values}. Correct one of them, or clear it."
    )
    assert remarks == ({text: severity} if severity else {})


def test_a_floor_above_the_roof_is_told(tmp_path):
    floors = [{"floor": "1", "elevation": 12}]
    text = "Floors!C2: Elevation 12 m is above the roof, 10 m: z/h is taken as 1. Check it, and Height in Building."
    assert _remarks(tmp_path, floors, ground_pga=0.2, height=10) == {text: "warning"}
    assert _remarks(tmp_path, floors, ground_pga=0.2, height=12) == {}


MIXED = "Floors: the motion of the floors comes from mixed sources: given peaks (1); a code's design profile (2)."


def test_a_profile_below_what_is_known_of_a_floor_is_told_once(tmp_path):
    """On floor 1 the profile gives the ground's 0.1 g; on floor 2, the roof, 3.5 x 0.1 = 0.35 g."""
    floors = [{"floor": "1", "elevation": 0, "pfa_x": 0.3, "pfa_y": 0.2}, {"floor": "2", "elevation": 4}]
    text = (
        "Floors!D2: the profile would give 0.100 g on floor '1', where 0.300 g is known: the PFA of floors that follow "
        "the profile may be too low. Fill in a PFA or a record on those, or check Ground PGA in Building."
    )
    assert _remarks(tmp_path, floors, ground_pga=0.1) == {text: "warning", MIXED: "note"}
    assert _remarks(tmp_path, floors, ground_pga=0.3) == {MIXED: "note"}


def test_a_known_floor_without_elevation_says_nothing_of_the_profile(tmp_path):
    floors = [{"floor": "1", "pfa_x": 0.9}, {"floor": "2", "elevation": 4}]
    assert _remarks(tmp_path, floors, ground_pga=0.1) == {MIXED: "note"}


def test_the_reduction_of_the_profile_counts_when_it_is_held_against_a_known_floor(tmp_path):
    """z/h = 0.5: 0.2 x 2.25 = 0.45 g, 0.2 x 2.25/1.5 = 0.3 g by R_mu 1.5."""
    floors = [{"floor": "1", "elevation": 4, "pfa_x": 0.4}, {"floor": "2", "elevation": 8}]
    inventory = assess.read_inventory(write(tmp_path / "w.xlsx", PIECE, floors, ground_pga=0.2))
    for reduction, known in ((1, 0), (1.5, 1)):
        found = assess.run(inventory, assess.Settings(ductility_reduction=reduction, verify="none")).problem_rows
        assert sum("would give 0.300 g on floor '1', where 0.400 g is known" in one.message for one in found) == known


def test_floors_above_that_the_profile_leaves_weaker_are_named(tmp_path):
    """Floors 2 to 8 stand at 4, 6 ... 16 of 16 m: 0.2 (1 + 2.5 z/h); 0.9 g is known of floor 1."""
    floors = [{"floor": "1", "elevation": 0, "pfa_x": 0.9}]
    floors += [{"floor": str(2 + at), "elevation": 4 + 2 * at} for at in range(7)]
    text, _ = _starting(_remarks(tmp_path, floors, ground_pga=0.2), "Floors!D2: the profile would give 0.200 g")
    assert (
        "Floors above with less: '2' (0.325 g), '3' (0.388 g), '4' (0.450 g), '5' (0.513 g), '6' (0.575 g), ..." in text
    )


@pytest.mark.parametrize(("pga", "severity"), [(0.01, "warning"), (0.9, "note")])
def test_a_given_pfv_that_a_profile_sets_aside_is_told(tmp_path, pga, severity):
    """T1 = 0.2 s: PFV = PFA/(2 pi 1.3 Hz), 1.2 cm/s of 0.01 g and 108.1 cm/s of 0.9 g."""
    floors = [{"floor": "1", "elevation": 4, "pfa_x": 0.001, "pfv_x": 30}]
    remarks = _remarks(tmp_path, floors, "ASCE 7-16", ground_pga=pga / 3, period=0.2)
    takes = pga * 980.665 / (2 * 3.141592653589793 * 1.3)
    text = f"Floors!F2: PFV X 30.0 cm/s of floor '1' is not used: the scenario 'ASCE 7-16' uses {takes:.1f} cm/s."
    assert remarks[f"{text} Scenario 'given' uses it."] == severity


def test_a_given_pfv_beside_a_record_or_an_unknown_one_is_told(tmp_path):
    floors = [{"floor": "1", "elevation": 4, "record_x": SMC, "pfv_x": 300}]
    text, kind = _starting(_remarks(tmp_path, floors), "Floors!F2: PFV X 300.0 cm/s of floor '1' is not used: the rec")
    assert "the record is used, with " in text
    assert kind == "warning"
    remarks = _remarks(tmp_path, floors, "NTC 2018", ground_pga=0.5)
    text = "Floors!F2: PFV X 300.0 cm/s of floor '1' is not used: the scenario 'NTC 2018' uses no PFV."
    assert remarks[text] == "note"


def test_in_a_building_of_basements_no_floor_is_above_the_roof(tmp_path):
    floors = [{"floor": "1", "elevation": -3}, {"floor": "B2", "elevation": -6}]
    assert _remarks(tmp_path, floors, ground_pga=0.2) == {}


@pytest.mark.parametrize(("storeys", "each"), [(1, "30"), (4, "7.5"), (15, "2"), (5, ""), (12, ""), (None, "")])
def test_a_height_that_does_not_fit_the_storeys_is_told(tmp_path, storeys, each):
    floors = [{"floor": "1", "elevation": 27}]
    effect = "too small a Height raises the profile" if each == "2" else "too large a Height lowers the profile"
    text = (
        f"Building!B8: Height 30 m over {count(storeys or 0, 'storey')} is {each} m a storey, outside 2.5 to 6 m; "
        f"{effect}. Check Height and Storeys."
    )
    building = {"storeys": storeys} if storeys else {}
    remarks = _remarks(tmp_path, floors, ground_pga=0.2, height=30, **building)
    assert remarks == ({text: "warning"} if each else {})


def test_a_height_far_above_the_floors_listed_is_noted(tmp_path):
    text = "Building!B8: z/h is taken against Height 131 m; the highest floor listed is at 36 m."
    floors = [{"floor": "1", "elevation": 36}]
    assert _remarks(tmp_path, floors, ground_pga=0.2, height=131) == {text: "note"}
    assert _remarks(tmp_path, floors, ground_pga=0.2, height=54) == {}


@pytest.mark.parametrize(("scenario", "effect"), [("ASCE 7-22", "lowers the profile"), ("NTC 2018", "raises the PFV")])
@pytest.mark.parametrize(("period", "odd"), [(0.1, True), (0.12, False), (1.5, False), (1.6, True)])
def test_a_period_that_does_not_fit_the_height_is_told(tmp_path, scenario, effect, period, odd):
    """0.0488 x 16^0.75 = 0.3904 s; x 0.3 = 0.117 s, x 4 = 1.56 s."""
    remarks = _remarks(tmp_path, [{"floor": "1", "elevation": 16}], scenario, ground_pga=0.2, period=period)
    text = (
        f"Building!B9: Period T1 {period:g} s is outside 0.117 to 1.56 s, 0.3 to 4 times 0.0488 h^0.75 (ASCE 7-22 Eq. "
        f"12.8-7) for a height h of 16 m; a longer T1 {effect}. Check Period T1 and Height."
    )
    assert remarks == ({text: "warning"} if odd else {})


def test_what_no_profile_starts_from_is_not_questioned(tmp_path):
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
    assert remarks == {
        "Floors: the motion of the floors comes from mixed sources: recorded motion (1); given peaks (3); interpolated "
        "between floors (2); a code's design profile (4).": "note"
    }
