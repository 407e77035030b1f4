"""Natural order of names, in a function and in what reports show."""

import json
import random
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

import assess
from assess.natural import natural_key
from assess.report.content import build_content
from tests.report.reading import render
from tests.workbooks import UNVERIFIED, assessed


@pytest.mark.parametrize(
    "names",
    [
        ["L3", "L11"],
        ["25-7", "25-07", "25-9", "25-10", "25-10a", "25-10b"],
        ["B2", "b2", "B10"],
        ["Room 9", "room 10", "Room 10", "Room 11"],
        ["1.9", "1.10", "2"],
        ["", "1", "01", "A"],
        ["٣", "x²", "x3"],  # other digits and raised ones are not refused
        ["7" * 5000, "8" * 5000, "1" + "0" * 5000],  # longer than Python turns into a number
    ],
)
def test_numbers_in_names_count_by_their_value(names):
    shuffled = sorted(names, reverse=True)
    random.Random(1).shuffle(shuffled)
    assert [one.casefold() for one in sorted(shuffled, key=natural_key)] == [one.casefold() for one in names]


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


@pytest.mark.parametrize(
    ("elevations", "names"),
    [
        ((None, None), ["L11", "L3"]),
        ((44.0, 12.0), ["L11", "L3"]),
        ((None, 12.0), ["L11", "L3"]),
    ],
)
def test_floors_stay_as_the_workbook_begins(tmp_path, elevations, names):
    content = build_content(assessed(tmp_path / "w.xlsx", ITEMS, floors(*elevations)))
    assert [page.floor.floor for page in content.floors] == names


@pytest.mark.parametrize(("order", "shown"), [((0, 2, 1), ["L11", "L7", "L3"]), ((2, 0, 1), ["L11", "L7", "L3"]),
                                              ((1, 0, 2), ["L3", "L7", "L11"])])  # fmt: skip
def test_floors_out_of_order_are_shown_by_elevation(tmp_path, order, shown):
    top, bottom = floors(44.0, 12.0)
    rows = [top, bottom, top | {"floor": "L7", "elevation": 28.0}]
    content = build_content(assessed(tmp_path / "w.xlsx", ITEMS, [rows[at] for at in order]))
    assert [page.floor.floor for page in content.floors] == shown


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return assessed(tmp_path_factory.mktemp("natural") / "w.xlsx", ITEMS, floors(44.0, 12.0), settings=UNVERIFIED)


def test_identical_rows_stand_together_in_the_table_of_pieces(results):
    assert [one.item.item for one in build_content(results).listed] == ["A2", "A10", "A9", "B1", "B11", "B3"]
    table = render(results).partition('id="pieces"')[2].partition("</table>")[0]
    assert re.findall(r'<tr id="row-(\d)"', table) == ["3", "1", "2", "6", "4", "5"]


def test_equal_pieces_and_rooms_are_ranked_by_name(results):
    content = build_content(results)
    assert [one.item.item for one in content.summary.worst][:3] == ["A2", "A10", "B3"]
    fixed = [one.item.item for entry in content.summary.fixes for one in entry.results]
    assert fixed.index("A2") < fixed.index("A10") < fixed.index("B3")
    assert [bar.label for bar in content.floors[0].rooms.bars] == ["Room 10", "Room 9"]  # the riskier one first


def test_data_files_keep_the_order_of_the_workbook(results, tmp_path):
    written = assess.write_reports(results, tmp_path, ("json", "csv"))
    wanted = [one["item"] for one in ITEMS]
    assert [one["item"] for one in json.loads(written["json"].read_text(encoding="utf-8"))["items"]] == wanted
    lines = written["csv"].read_text(encoding="utf-8-sig").splitlines()[1:]
    assert [line.split(",")[0].strip('"') for line in lines] == wanted
