"""The worked example in a report: which piece, in the language of the report, with its results in words."""

import pytest

from assess.report.content import build_content
from assess.settings import Settings
from tests.shaking import write_records
from tests.workbooks import ITEMS, assessed


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    return assessed(tmp_path_factory.mktemp("worked") / "w.xlsx")


def test_the_worst_free_standing_piece_is_worked_by_every_method(found):
    content = build_content(found)
    free = [one for one in found if not one.is_anchored]
    assert content.example.adopted.upper == max(one.adopted.upper for one in free)
    assert not content.example.is_anchored
    methods = content.example.governing.methods
    assert [one.method.key for one in content.worked] == [key for key, one in methods.items() if one.value is not None]


@pytest.mark.slow
def test_the_simulation_is_worked_too(tmp_path):
    write_records(tmp_path, "slow")
    floors, settings = [{"floor": "1", "record_x": "slow.csv"}], Settings(verify="all", runs=20)
    content = build_content(assessed(tmp_path / "w.xlsx", ITEMS[:1], floors, settings=settings))
    assert content.worked[-1].method.role == "simulation"
    found = content.example.governing.simulation
    assert f"R = {found.probability:.4f}, that is" in content.worked[-1].result
    ideal = f"it would overturn under {found.ideal.overturned} of 20 motions."
    assert sum(step.endswith(ideal) for step in content.worked[-1].steps) == 1


@pytest.mark.slow
def test_a_simulation_on_assumed_motion_is_worked_without_what_would_recur(tmp_path):
    settings = Settings(verify="all", runs=20)
    content = build_content(assessed(tmp_path / "w.xlsx", ITEMS[:1], settings=settings, period=1.0))
    found = content.example.governing.simulation
    assert f"R = {found.probability:.4f}, that is" in content.worked[-1].result
    assert found.ideal is None
    assert not any("it would overturn under" in step for step in content.worked[-1].steps)


def test_without_pieces_there_is_none(tmp_path):
    content = build_content(assessed(tmp_path / "w.xlsx", []))
    assert (content.example, content.worked) == (None, ())


def test_an_anchored_piece_comes_last(tmp_path):
    held = [dict(ITEMS[0], item=name, anchored="yes") for name in ("one", "two")]
    assert build_content(assessed(tmp_path / "held.xlsx", held)).example.item.item == "one"
    safer = dict(ITEMS[1], item="safer", breadth=70, width=70)
    assert build_content(assessed(tmp_path / "both.xlsx", [*held, safer])).example.item.item == "safer"
