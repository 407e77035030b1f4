"""Natural order of names, in a function and in what reports show."""

import random

import pytest
from hypothesis import given, strategies as st

from assess.report.content import Content
from assess.report.say.piece import list_apart
from assess.text import natural_key
from tests.workbooks import UNVERIFIED, assessed


def test_numbers_in_names_count_by_their_value():
    for names in (
        ["L3", "L11"],
        ["25-7", "25-07", "25-9", "25-10", "25-10a", "25-10b"],
        ["B2", "b2", "B10"],
        ["Room 9", "room 10", "Room 10", "Room 11"],
        ["1.9", "1.10", "2"],
        ["", "1", "01", "A"],
        ["٣", "x²", "x3"],  # other digits and raised ones are not refused
        ["7" * 5000, "8" * 5000, "1" + "0" * 5000],  # longer than Python turns into a number
    ):
        shuffled = sorted(names, reverse=True)
        random.Random(1).shuffle(shuffled)
        found = [one.casefold() for one in sorted(shuffled, key=natural_key)]
        assert found == [one.casefold() for one in names], names


@given(st.lists(st.text(max_size=12), max_size=8))
def test_the_order_does_not_depend_on_that_of_the_input(names):
    turned = names[::-1]
    assert sorted(names, key=natural_key) == sorted(turned, key=natural_key)


TALL = {"description": "Bookcase", "breadth": 30, "width": 80, "height": 200, "anchored": "no"}
LOW = {"description": "Desk", "breadth": 80, "width": 160, "height": 74, "anchored": "no"}
ITEMS = [
    {"item": "A10", "floor": "L11", "room": "Room 10", **TALL},
    {"item": "A9", "floor": "L11", "room": "Room 9", **LOW},
    {"item": "A2", "floor": "L11", "room": "Room 10", **TALL},
    {"item": "B11", "floor": "L3", "room": "Room 1", **LOW},
    {"item": "B3", "floor": "L3", "room": "Room 1", **TALL},
    {"item": "B1", "floor": "L3", "room": "Room 1", **LOW},
]


def floors(*elevations):
    motion = {"pfa_x": 0.6, "pfv_x": 60.0, "pfa_y": 0.6, "pfv_y": 60.0}
    return [{"floor": name, "elevation": at} | motion for name, at in zip(("L11", "L3"), elevations, strict=True)]


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return assessed(tmp_path_factory.mktemp("natural") / "w.xlsx", ITEMS, floors(44.0, 12.0), settings=UNVERIFIED)


def test_equal_pieces_and_rooms_are_ranked_by_name(results):
    content = Content(results)
    listed = [one.item.item for one in content.listed]
    assert listed == ["A2", "A10", "A9", "B1", "B11", "B3"], "identical rows together"
    assert [one.item.item for one in list_apart(results, "")][:3] == ["A2", "A10", "B3"]
    fixed = [one.item.item for entry in content.fixes for one in entry.results]
    assert fixed.index("A2") < fixed.index("A10") < fixed.index("B3")
