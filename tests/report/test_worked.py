"""The worked example in a report: which piece, in the language of the report, with its results in words."""

import pytest

from assess.report.content import build_content
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


def test_without_pieces_there_is_none(tmp_path):
    content = build_content(assessed(tmp_path / "w.xlsx", []))
    assert (content.example, content.worked) == (None, ())


def test_an_anchored_piece_comes_last(tmp_path):
    held = [dict(ITEMS[0], item=name, anchored="yes") for name in ("one", "two")]
    assert build_content(assessed(tmp_path / "held.xlsx", held)).example.item.item == "one"
    safer = dict(ITEMS[1], item="safer", breadth=70, width=70)
    assert build_content(assessed(tmp_path / "both.xlsx", [*held, safer])).example.item.item == "safer"
