"""`assess check` of a workbook in which nothing is wrong, but that lacks the shaking or the furniture."""

from tests.cli.calling import run
from tests.workbooks import ITEMS, write

WAYS = ("Hazard map", "ShakeMap of a past", "Records", "Shaking in Building, such as 'MMI VII, very strong'")
LACKING = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 4}]


def test_a_run_without_shaking_is_an_error_with_the_same_help(tmp_path):
    done = run("run", write(tmp_path / "w.xlsx", floors=LACKING), "--out", tmp_path / "out")
    assert done.exit_code == 2
    assert all(done.stderr.count(way) == 1 for way in WAYS)
    assert "2 errors; nothing was written." in done.stderr
    assert not (tmp_path / "out").exists()


def test_what_is_wrong_stays_an_error_next_to_what_is_missing(tmp_path):
    items = [*ITEMS, {"item": "B", "floor": "9", "breadth": 40, "height": 180}]
    done = run("check", write(tmp_path / "w.xlsx", items, LACKING))
    assert done.exit_code == 2
    assert "3 errors; nothing was written." in done.stderr
    assert "incomplete" not in done.stderr


def test_a_chosen_profile_without_ground_motion_is_incomplete_too(tmp_path):
    done = run("check", write(tmp_path / "w.xlsx", scenario_kind="NTC 2018", floors=LACKING))
    assert done.exit_code == 1
    assert "Hazard map" in done.stderr


def test_shaking_that_is_not_used_is_told_no_ways(tmp_path):
    done = run("check", write(tmp_path / "w.xlsx", shaking="MMI VII, very strong"))
    assert done.exit_code == 0
    assert "Shaking is not used" in done.stderr
    assert "To know the shaking better" not in done.stderr
