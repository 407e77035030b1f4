"""`assess check` of a workbook in which nothing is wrong, but that lacks the shaking or the furniture."""

import pytest

from tests.cli.calling import run
from tests.workbooks import ITEMS, write

WAYS = ("Hazard map", "ShakeMap of a past", "Records", "Shaking in Building, such as 'MMI VII, very strong'")
LACKING = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 4}]


@pytest.mark.parametrize("floors", [LACKING, [{"floor": "1"}, {"floor": "2"}]])
def test_a_workbook_without_shaking_is_told_the_ways_to_it(tmp_path, floors):
    done = run("check", write(tmp_path / "w.xlsx", floors=floors))
    assert (done.exit_code, done.stdout) == (1, "")
    assert "w.xlsx is incomplete: what is filled in can be used" in done.stderr
    assert all(done.stderr.count(way) == 1 for way in WAYS)
    assert "Furniture:" not in done.stderr
    assert "Floors!" in done.stderr


def test_a_run_without_shaking_is_an_error_with_the_same_help(tmp_path):
    done = run("run", write(tmp_path / "w.xlsx", floors=LACKING), "--out", tmp_path / "out")
    assert done.exit_code == 2
    assert all(done.stderr.count(way) == 1 for way in WAYS)
    assert "2 errors; nothing was written." in done.stderr
    assert not (tmp_path / "out").exists()


def test_who_has_chosen_the_shaking_needs_no_elevation_and_is_warned(tmp_path):
    floors = [{"floor": "1"}, {"floor": "2"}]
    done = run("check", write(tmp_path / "w.xlsx", floors=floors, shaking="MMI VII, very strong"))
    assert done.exit_code == 0
    assert "floors 1, 2: neither T1, Height, Storeys nor an Elevation is known" in done.stderr
    assert "Fill in Storeys in Building, and Elevation." in done.stderr
    assert "To fill in what is missing" not in done.stderr


def test_a_workbook_without_furniture_is_told_how_to_list_it(tmp_path):
    done = run("check", write(tmp_path / "w.xlsx", items=[]))
    assert (done.exit_code, done.stdout) == (1, "")
    assert done.stderr.count("Furniture: in Items, write one row for each piece.") == 1
    assert "Hazard map" not in done.stderr


def test_what_is_wrong_stays_an_error_next_to_what_is_missing(tmp_path):
    items = [*ITEMS, {"item": "B", "floor": "9", "breadth": 40, "height": 180}]
    done = run("check", write(tmp_path / "w.xlsx", items, LACKING))
    assert done.exit_code == 2
    assert "3 errors; nothing was written." in done.stderr
    assert "incomplete" not in done.stderr


@pytest.mark.parametrize("scenario", ["NTC 2018", "ASCE 7-16"])
def test_a_chosen_profile_without_ground_motion_is_incomplete_too(tmp_path, scenario):
    done = run("check", write(tmp_path / "w.xlsx", scenario_kind=scenario, floors=LACKING))
    assert done.exit_code == 1
    assert "Hazard map" in done.stderr


def test_where_shaking_is_assumed_the_three_ways_to_know_it_better_are_a_list_below_the_note(tmp_path):
    done = run("check", write(tmp_path / "w.xlsx", floors=LACKING, shaking="MMI VII, very strong"))
    assert done.exit_code == 0
    (note,) = [line for line in done.stderr.splitlines() if "the shaking is assumed" in line]
    assert note.startswith("note ")
    assert "0.215 g" in note
    assert note.endswith(
        "the published medians. To know it better: type the PGA of a hazard map or a ShakeMap at the address into "
        "Ground PGA, or name records in Floors."
    )
    lines = done.stderr.splitlines()
    at = lines.index("To know the shaking better:")
    assert at > lines.index(note)
    assert [line[:12] for line in lines[at + 1 :]] == [f"  {n}. {way}"[:12] for n, way in enumerate(WAYS[:3], 1)]
    assert "no errors" in done.stdout


def test_shaking_that_is_not_used_is_told_no_ways(tmp_path):
    done = run("check", write(tmp_path / "w.xlsx", shaking="MMI VII, very strong"))
    assert done.exit_code == 0
    assert "Shaking is not used" in done.stderr
    assert "To know the shaking better" not in done.stderr


def test_a_complete_workbook_is_told_no_ways(tmp_path):
    done = run("check", write(tmp_path / "w.xlsx"))
    assert done.exit_code == 0
    assert "Hazard map" not in done.stderr
