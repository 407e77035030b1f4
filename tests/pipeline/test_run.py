import gc
from dataclasses import replace
from threading import Event

import pytest

import assess
from assess.pipeline.schedule import plan
from assess.risk import RiskClass, classify
from tests.motion.motions import MARKET
from tests.pipeline import rows
from tests.workbooks import RECORDS, UNVERIFIED, write

PIECE = {"floor": "1", "breadth": 40, "width": 90, "height": 180}


def test_an_axis_alone_or_the_one_of_the_larger_probability():
    items = [{"item": "x", "axis": "X", **PIECE}, {"item": "y", "axis": "Y", **PIECE}, {"item": "both", **PIECE}]
    results = rows.assessed(items, [{"floor": "1", "pfa_x": 0.2, "pfa_y": 0.4}])
    assert [[one.motion.axis for one in each.cases] for each in results] == [["X"], ["Y"], ["X", "Y"]]
    assert results["both"].governing.motion.axis == "Y"
    assert results["both"].adopted.probability == results["both"].worst("fema_p58")


def test_the_larger_velocity_governs_a_blank_axis_and_by_the_papers_formula_the_larger_acceleration(tmp_path):
    floors = [{"floor": "1", "pfa_x": 0.4, "pfv_x": 20, "pfa_y": 0.3, "pfv_y": 40}]
    best = rows.assessed([{"item": "a", **PIECE}], floors)["a"]
    paper = rows.assessed([{"item": "a", **PIECE}], floors, class_by="proposed OR")["a"]
    assert (best.governing.motion.axis, best.adopted.method) == ("Y", "fema_p58")
    assert (paper.governing.motion.axis, paper.adopted.method) == ("X", "proposed_or")
    assert paper.formula_class is paper.paper_class is classify(paper.worst("proposed_or"))
    assert best.paper_class is classify(best.governing.methods["proposed_or"].value)
    path = write(tmp_path / "w.xlsx", [{"item": "a", **PIECE}], class_by="proposed OR")
    assert assess.run(path, UNVERIFIED)["a"].adopted.method == "proposed_or"
    by_option = assess.run(path, UNVERIFIED, class_by="best formula")
    assert by_option["a"].adopted.method == "fema_p58", "the option comes before the workbook"


def test_at_equal_probability_the_larger_pfa_governs_then_x():
    """Both PFA lie past the peak of the formula, where its value is held: the probabilities are equal."""
    floors = [{"floor": "1", "pfa_x": 1.1, "pfa_y": 1.4}, {"floor": "2", "pfa_x": 1.2, "pfa_y": 1.2}]
    items = [{"item": "a", **PIECE}, {"item": "b", **PIECE, "floor": "2"}]
    results = rows.assessed(items, floors, class_by="proposed OR")
    assert results["a"].governing.motion.axis == "Y"
    assert results["b"].governing.motion.axis == "X"
    assert {case.methods["proposed_or"].value for case in results["a"].cases} == {results["a"].adopted.probability}


def test_the_worst_of_parallel_records_governs_and_all_are_kept():
    floors = [{"floor": "1", "record_x": "np01002p_4225a_a.smc; 0165a_u.smc"}]
    one = rows.assessed([{"item": "a", "axis": "X", **PIECE}], floors, RECORDS)["a"]
    assert [case.motion.record for case in one.cases] == ["np01002p_4225a_a.smc", "0165a_u.smc"]
    assert one.governing.motion.pfv_cm_s == max(case.motion.pfv_cm_s or 0.0 for case in one.cases)
    assert one.governing.motion.record == "np01002p_4225a_a.smc"
    assert one.governing.motion.pfa_g < max(case.motion.pfa_g for case in one.cases)


def test_treatment_that_takes_over_two_percent_of_the_peak_is_told():
    floors = [{"floor": "1", "record_x": "891018_1.cra-1.0210a.smc"}]
    results = rows.assessed([{"item": "a", **PIECE}], floors, MARKET)
    (note,) = [one for one in results.problem_rows if "treatment lowers the PFA" in one.message]
    assert note.severity == "note"
    assert "from the file's 0.233 g to 0.222 g (4.5%)" in note.message


def test_an_assessment_without_items_is_empty(tmp_path):
    inventory = assess.read_inventory(write(tmp_path / "w.xlsx"))
    results = assess.run(replace(inventory, items=()), UNVERIFIED)
    assert len(results) == 0
    assert list(results) == []
    written = assess.write_reports(results, tmp_path / "out", ("html", "xlsx", "json", "csv"))
    assert all(path.stat().st_size for path in written.values())


def test_flags_of_piece_and_motion_reach_the_adopted_risk():
    floors = [{"floor": "1", "pfa_x": 0.95}]
    items = [
        {"item": "stocky", "floor": "1", "breadth": 150, "height": 100, "axis": "Y"},
        {"item": "slippery", "floor": "1", "breadth": 60, "height": 120, "friction": 0.3, "axis": "X"},
        {"item": "thin", "floor": "1", "breadth": 10, "height": 150, "axis": "X"},
    ]
    results = rows.assessed(items, floors, period=1.0)
    flags = {one.item.item: set(one.adopted.flags) for one in results}
    assert flags["stocky"] >= {"does_not_rock", "one_axis_only", "unknown_height"}
    assert (results["stocky"].adopted.basis, results["stocky"].adopted.risk) == ("cannot rock", RiskClass.LOW)
    assert results["stocky"].governing.methods["fema_p58"].value is None
    assert flags["slippery"] >= {"slides", "unknown_height"}
    assert "extrapolated" in flags["thin"]
    by_paper = rows.assessed(items, floors, period=1.0, class_by="proposed OR")
    assert {"thin", "held", "extrapolated"} <= set(by_paper["thin"].adopted.flags)


def test_what_to_fix_first():
    safety, thin = {"importance": "life safety"}, {"floor": "1", "breadth": 28, "height": 200}
    items = [
        {"item": "plain", **thin},
        {"item": "few", **PIECE, **safety},
        {"item": "many", **PIECE, **safety, "quantity": 5},
        {"item": "anchored", **thin, **safety, "anchored": "yes"},
        {"item": "stable", "floor": "1", "breadth": 90, "height": 90, **safety},
        {"item": "worst", **thin, **safety},
        {"item": "mild", "floor": "1", "breadth": 70, "height": 180, **safety},
    ]
    results = list(rows.assessed(items, [{"floor": "1", "pfa_x": 0.25}], class_by="proposed OR"))
    found = [(one.phase, one.pieces[0].item.item) for one in plan(results, ())]
    assert found == [("A", "worst"), ("A", "many"), ("A", "few"), ("B", "plain"), ("B", "mild")]
    assert results[6].adopted.risk is RiskClass.MEDIUM  # no life safety puts it before what is likely to fall
    assert results[4].adopted.risk is RiskClass.LOW


def test_a_path_is_read_and_keywords_are_settings(tmp_path):
    results = assess.run(write(tmp_path / "w.xlsx"), verify="none", scenario="AS_filled")
    assert results.settings == replace(UNVERIFIED, scenario="as filled", class_by="best formula")
    assert [one.item.item for one in results] == ["A1", "A2", "A3", "A4", "A5"]
    with pytest.raises(assess.InputError, match=r"verifi is an unknown setting\. Did you mean verify"):
        assess.run(write(tmp_path / "w.xlsx"), verifi="none")
    with pytest.raises(assess.WorkbookError, match=r"nowhere\.xlsx"):
        assess.run(tmp_path / "nowhere.xlsx")


def test_a_building_value_that_is_replaced_and_a_setting_count():
    inventory = rows.read([{"item": "a", **PIECE}])
    smooth = replace(inventory, building=replace(inventory.building, friction=0.1))
    before, after = (assess.run(one, UNVERIFIED)["a"] for one in (inventory, smooth))
    assert (before.item.friction, after.item.friction) == (None, 0.1)
    assert "slides" not in before.adopted.flags
    assert "slides" in after.adopted.flags
    wide = assess.run(inventory, replace(UNVERIFIED, zeta_velocity=1.5))["a"]
    assert wide.worst("kaneko_hayashi") != before.worst("kaneko_hayashi")


def test_a_cancelled_run_stops_and_leaves_nothing(tmp_path):
    cancel, stages = Event(), []

    def listen(report):
        stages.append(report.stage)
        if report.stage == "verification":
            cancel.set()

    items = [{"item": f"p{at}", **PIECE} for at in range(3)]
    with pytest.raises(assess.CancelledError):
        assess.run(write(tmp_path / "w.xlsx", items), verify="all", runs=20, progress=listen, cancel=cancel,
                   series_folder=tmp_path / "series")  # fmt: skip
    assert stages[0] == "reading"
    assert stages[-1] == "verification"
    assert not (tmp_path / "series").exists()


def test_series_lie_where_the_caller_says_else_they_go_with_the_results(tmp_path):
    inventory = assess.read_inventory(write(tmp_path / "w.xlsx"))
    kept = assess.run(inventory, UNVERIFIED, series_folder=tmp_path / "series")
    assert (tmp_path / "series" / "series.npz").is_file()
    assert bytes(kept.series["workbook"]) == (tmp_path / "w.xlsx").read_bytes()
    passing = assess.run(inventory, UNVERIFIED)
    folder = passing.series.path.parent
    assert passing.series.is_there
    del passing
    gc.collect()
    assert not folder.exists()
