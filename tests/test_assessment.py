import shutil
from dataclasses import replace

import pytest

import assess
from assess.ranking import fix_first
from assess.risk import RiskClass
from tests.workbooks import FLOORS, RECORDS, UNVERIFIED, assessed, write

PIECE = {"floor": "1", "breadth": 40, "width": 90, "height": 180}


def _result(assessment, item):
    return next(one for one in assessment if one.item.item == item)


def test_an_item_with_an_axis_takes_that_axis_alone(tmp_path):
    items = [{"item": "x", "axis": "X", **PIECE}, {"item": "y", "axis": "Y", **PIECE}, {"item": "both", **PIECE}]
    assessment = assessed(tmp_path / "w.xlsx", items)
    assert [one.demand.axis for one in _result(assessment, "x").cases] == ["X"]
    assert [one.demand.axis for one in _result(assessment, "y").cases] == ["Y"]
    assert [one.demand.axis for one in _result(assessment, "both").cases] == ["X", "Y"]


def test_the_larger_probability_governs_a_blank_axis(tmp_path):
    floors = [{"floor": "1", "pfa_x": 0.2, "pfa_y": 0.4}]
    one = _result(assessed(tmp_path / "w.xlsx", [{"item": "a", **PIECE}], floors), "a")
    assert one.governing.demand.axis == "Y"
    assert one.adopted.probability == max(case.methods["proposed_or"].value for case in one.cases)


def test_at_equal_probability_the_larger_pfa_governs_then_x(tmp_path):
    """Both PFA lie past the peak of the formula, where its value is held: the probabilities are equal."""
    floors = [{"floor": "1", "pfa_x": 1.1, "pfa_y": 1.4}, {"floor": "2", "pfa_x": 1.2, "pfa_y": 1.2}]
    items = [{"item": "a", **PIECE}, {"item": "b", **PIECE, "floor": "2"}]
    assessment = assessed(tmp_path / "w.xlsx", items, floors)
    assert _result(assessment, "a").governing.demand.axis == "Y"
    assert _result(assessment, "b").governing.demand.axis == "X"
    assert {case.methods["proposed_or"].value for case in _result(assessment, "a").cases} == {
        _result(assessment, "a").adopted.probability
    }


def test_the_worst_of_parallel_records_governs_and_all_are_kept(tmp_path):
    for name in ("0165a_u.smc", "np01002p_4225a_a.smc"):
        shutil.copy(RECORDS / name, tmp_path / name)
    floors = [{"floor": "1", "record_x": "np01002p_4225a_a.smc; 0165a_u.smc"}]
    one = _result(assessed(tmp_path / "w.xlsx", [{"item": "a", "axis": "X", **PIECE}], floors), "a")
    assert [case.demand.name for case in one.cases] == ["np01002p_4225a_a.smc", "0165a_u.smc"]
    assert one.governing.demand.pfa == max(case.demand.pfa for case in one.cases)
    assert one.governing.demand.name == "0165a_u.smc"


def test_treatment_that_takes_over_two_percent_of_the_peak_is_told(tmp_path):
    folder = tmp_path / "records"
    shutil.copytree(RECORDS.parents[1] / "inventories" / "records" / "575-market", folder)
    floors = [{"floor": "1", "record_x": "records/891018_1.cra-1.0210a.smc"}]
    assessment = assessed(tmp_path / "w.xlsx", [{"item": "a", **PIECE}], floors)
    (note,) = [one for one in assessment.problems if "treatment lowers the PFA" in one.message]
    assert note.severity == "note"
    assert "from the file's 0.233 g to 0.222 g (4.5%)" in note.message


def test_an_assessment_without_items_is_empty(tmp_path):
    inventory = assess.read_inventory(write(tmp_path / "w.xlsx"))
    assessment = assess.run(replace(inventory, items=()), UNVERIFIED)
    assert len(assessment) == 0
    assert list(assessment) == []
    written = assess.write_reports(assessment, tmp_path / "out")
    assert all(path.stat().st_size for path in written.values())


def test_flags_of_piece_and_motion_reach_the_adopted_risk(tmp_path):
    floors = [{"floor": "1", "pfa_x": 0.95}]
    items = [
        {"item": "stocky", "floor": "1", "breadth": 150, "height": 100, "axis": "Y"},
        {"item": "slippery", "floor": "1", "breadth": 60, "height": 120, "friction": 0.3, "axis": "X"},
        {"item": "thin", "floor": "1", "breadth": 10, "height": 150, "axis": "X"},
    ]
    assessment = assessed(tmp_path / "w.xlsx", items, floors, period=1.0)
    flags = {one.item.item: set(one.adopted.flags) for one in assessment}
    assert flags["stocky"] >= {"does_not_rock", "one_axis_only", "pfv_estimated", "extrapolated"}
    assert _result(assessment, "stocky").governing.methods["fema_p58"].value is None
    assert flags["slippery"] >= {"slides", "pfv_estimated", "extrapolated"}
    assert flags["thin"] >= {"thin", "held", "extrapolated"}


def test_what_to_fix_first(tmp_path):
    items = [
        {"item": "plain", "floor": "1", "breadth": 28, "height": 200},
        {"item": "few", "floor": "1", "breadth": 40, "height": 180, "importance": "life safety"},
        {"item": "many", "floor": "1", "breadth": 40, "height": 180, "importance": "life safety", "quantity": 5},
        {
            "item": "anchored",
            "floor": "1",
            "breadth": 28,
            "height": 200,
            "anchored": "yes",
            "importance": "life safety",
        },
        {"item": "stable", "floor": "1", "breadth": 90, "height": 90, "importance": "life safety"},
        {"item": "worst", "floor": "1", "breadth": 28, "height": 200, "importance": "life safety"},
        {"item": "mild", "floor": "1", "breadth": 70, "height": 180, "importance": "life safety"},
    ]
    results = list(assessed(tmp_path / "w.xlsx", items, [{"floor": "1", "pfa_x": 0.25}]))
    assert [one.item.item for one in fix_first(iter(results))] == ["worst", "many", "few", "plain", "mild"]
    assert results[6].adopted.risk is RiskClass.MEDIUM  # no life safety puts it before what is likely to fall
    assert results[4].adopted.risk is RiskClass.LOW


def test_frames_are_for_notebooks(tmp_path):
    assessment = assessed(tmp_path / "w.xlsx")
    table, items = assessment.frame(), assessment.inventory.frame()
    assert list(table.index) == list(items.index) == ["A1", "A2", "A3", "A4", "A5"]
    assert table.loc["A1", "breadth"] == pytest.approx(0.30)
    assert table.loc["A1", "probability"] == table.loc["A1", "proposed_or"]
    assert set(table["risk_class"]) <= {"low", "medium", "high", "very high"}


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"scenario": "tsunami"}, "scenario is 'tsunami', expected one of: as filled, recorded, given"),
        ({"verify": "maybe"}, "verify is 'maybe', expected one of: none, high, all"),
        ({"zeta_velocity": 0.0}, "must be finite and above 0"),
        ({"slide_coefficient": 1.5}, r"slide_coefficient is 1\.5, expected 0 to 1"),
    ],
)
def test_settings_are_checked(settings, message):
    with pytest.raises(ValueError, match=message):
        assess.Settings(**settings)


def test_settings_change_what_they_say(tmp_path):
    inventory = assess.read_inventory(write(tmp_path / "w.xlsx", [{"item": "a", **PIECE}], FLOORS))
    usual, wide = (
        next(iter(assess.run(inventory, replace(UNVERIFIED, zeta_velocity=zeta)))).worst("kaneko_hayashi")
        for zeta in (0.5, 1.5)
    )
    assert usual != wide
