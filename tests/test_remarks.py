"""What a run remarks on the motion of the floors."""

import shutil

import pytest

import assess
from tests.workbooks import RECORDS, write

PIECE = [{"item": "a", "floor": "1", "breadth": 40, "height": 180}]
SMC = "0165a_u.smc"


def _remarks(tmp_path, floors, scenario=None, **building):
    shutil.copy(RECORDS / SMC, tmp_path / SMC)
    inventory = assess.read_inventory(write(tmp_path / "w.xlsx", PIECE, floors, **building))
    assessment = assess.run(inventory, assess.Settings(scenario=scenario))
    return {str(one): one.severity for one in assessment.problems if one not in inventory.problems}


def _starting(remarks, start):
    (found,) = [(text, severity) for text, severity in remarks.items() if text.startswith(start)]
    return found


def test_a_plain_run_remarks_nothing(tmp_path):
    assert _remarks(tmp_path, [{"floor": "1", "pfa_x": 0.3}]) == {}


@pytest.mark.parametrize(("pga", "severity"), [(0.01, "warning"), (0.9, "note")])
def test_a_profile_says_which_record_and_pfa_it_sets_aside(tmp_path, pga, severity):
    floors = [{"floor": "1", "elevation": 0, "record_x": SMC, "pfa_y": 0.4}]
    remarks = _remarks(tmp_path, floors, "ASCE 7-22", ground_pga=pga)
    text, kind = _starting(remarks, "Floors!H2: Record X is not used: its PFA is ")
    assert f"the scenario 'ASCE 7-22' takes {pga:.3f} g. Scenario 'recorded' uses it." in text
    assert kind == severity
    text = (
        f"Floors!E2: PFA Y 0.400 g is not used: the scenario 'ASCE 7-22' takes {pga:.3f} g. Scenario 'given' uses it."
    )
    assert remarks[text] == severity


def test_given_sets_a_record_aside_and_recorded_a_pfa(tmp_path):
    floors = [{"floor": "1", "record_x": SMC, "pfa_x": 0.001}]
    text, kind = _starting(_remarks(tmp_path, floors, "given"), "Floors!H2: Record X is not used: its PFA is")
    assert "the scenario 'given' takes 0.001 g" in text
    assert kind == "warning"
    text, kind = _starting(_remarks(tmp_path, floors, "recorded"), "Floors!D2: PFA X 0.001 g is not used: the record")
    assert kind == "note"


@pytest.mark.parametrize(
    ("scenario", "why"), [(None, "every floor has a motion of its own"), ("given", "scenario 'given'")]
)
def test_ground_motion_that_no_floor_needs_is_kept_not_used(tmp_path, scenario, why):
    remarks = _remarks(tmp_path, [{"floor": "1", "pfa_x": 0.3}], scenario, ground_pga=0.2, sds=0.5)
    assert remarks == {
        f"Building!B13: Ground PGA is kept, not used: {why}.": "note",
        f"Building!B14: SDS is kept, not used: {why}.": "note",
    }


@pytest.mark.parametrize(("sds", "severity"), [(0.5, None), (0.503, None), (0.6, "warning"), (0.4, "note")])
def test_ground_pga_comes_before_an_sds_that_differs(tmp_path, sds, severity):
    """0.4 x 0.503 = 0.2012 differs from 0.2 by 0.6 %; 0.24 would shake more, 0.16 less."""
    remarks = _remarks(tmp_path, [{"floor": "1", "elevation": 3}], ground_pga=0.2, sds=sds)
    values = f"0.4 SDS is {0.4 * sds:.3f} g, Ground PGA 0.200 g is used"
    text = f"Building!B14: SDS is not used: {values}. Correct one of them, or clear it."
    assert remarks == ({text: severity} if severity else {})


def test_a_floor_above_the_roof_is_told(tmp_path):
    floors = [{"floor": "1", "elevation": 12}]
    text = "Floors!C2: Elevation 12 m is above the roof, 10 m: z/h is taken as 1. Check it, and Height in Building."
    assert _remarks(tmp_path, floors, ground_pga=0.2, height=10) == {text: "warning"}
    assert _remarks(tmp_path, floors, ground_pga=0.2, height=12) == {}


def test_a_profile_that_gives_less_than_a_floor_below_has_is_told(tmp_path):
    floors = [{"floor": "1", "elevation": 0, "pfa_x": 0.9}, {"floor": "2", "elevation": 4}]
    remarks = _remarks(tmp_path, floors, ground_pga=0.2)
    text, kind = _starting(
        remarks, "Floors!D3: the profile gives 0.700 g, less than the 0.900 g known of floor '1' below"
    )
    assert "Fill in a PFA or a record, or check Ground PGA in Building." in text
    assert kind == "warning"
    text = "Floors: the motion of the floors comes from mixed sources: given peaks (1); a code's design profile (2)."
    assert _remarks(tmp_path, floors, ground_pga=0.3) == {text: "note"}


def test_mixed_sources_are_listed(tmp_path):
    floors = [
        {"floor": "1", "elevation": 0, "record_x": SMC},
        {"floor": "2", "elevation": 4},
        {"floor": "3", "elevation": 8, "pfa_x": 0.1},
        {"floor": "4", "elevation": 12},
    ]
    remarks = _remarks(tmp_path, floors, ground_pga=0.2)
    assert remarks == {
        "Floors: the motion of the floors comes from mixed sources: recorded motion (1); given peaks (3); interpolated "
        "between floors (2); a code's design profile (4).": "note"
    }
