"""Weight, Bracket height and Bracket capacity of Items: read in any unit, and every fault named by its cell."""

import json

import pytest

import assess
from assess.errors import WorkbookError
from assess.settings import Settings
from tests.workbooks import write

PIECE = {"item": "a", "floor": "1", "breadth": 40, "width": 90, "height": 180, "anchored": "yes"}


def read(folder, units="si", **given):
    return assess.read_inventory(write(folder / "w.xlsx", [PIECE | given], None, units))


def test_they_are_read_and_kept_in_the_results(tmp_path):
    inventory = read(tmp_path, weight=120, bracket_height=170, bracket_capacity=1.5)
    (item,) = inventory.items
    assert (item.weight, item.bracket_height, item.bracket_capacity) == pytest.approx((120, 1.7, 1500))
    results = assess.run(inventory, Settings(verify="none"))
    assess.write_reports(results, tmp_path / "out", formats=("json",))
    (row,) = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))["items"]
    assert row["weight_kg"] == 120
    anchor = row["anchor"]
    assert (anchor["bracket_height_cm"], anchor["bracket_capacity_kn"]) == (170.0, 1.5)
    assert (anchor["weight_source"], anchor["weight_kn"]) == ("given", pytest.approx(120 * 9.80665 / 1000))
    assert (anchor["holds"], anchor["counts_as_anchored"]) == (True, True)


def test_other_units_are_read(tmp_path):
    piece = {"breadth": 16, "width": 36, "height": 72, "weight": 100, "bracket_height": 60, "bracket_capacity": 250}
    (item,) = read(tmp_path, "imperial", **piece).items
    found = (item.weight, item.bracket_height, item.bracket_capacity)
    assert found == pytest.approx((45.359237, 1.524, 1112.0554), rel=1e-6)


def test_what_is_blank_is_assumed_or_null(tmp_path):
    results = assess.run(read(tmp_path), Settings(verify="none"))
    assess.write_reports(results, tmp_path / "out", formats=("json",))
    (row,) = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))["items"]
    anchor = row["anchor"]
    assert (row["weight_kg"], anchor["bracket_capacity_kn"], anchor["holds"]) == (None, None, None)
    assert (anchor["weight_source"], anchor["bracket_height_cm"]) == ("estimate", pytest.approx(162))
    assert anchor["counts_as_anchored"] is True


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"bracket_height": 190}, "Bracket height 190 cm is greater than Height 180 cm."),
        ({"bracket_height": -10}, "Bracket height is -10 cm"),
        ({"bracket_capacity": 0}, "Bracket capacity is 0 kN"),
        ({"weight": -5}, "Weight is -5 kg"),
    ],
)
def test_what_is_impossible_is_an_error_at_its_cell(tmp_path, given, words):
    with pytest.raises(WorkbookError) as caught:
        read(tmp_path, **given)
    (one,) = caught.value.problems
    assert words in one.message
    assert one.sheet == "Items"
    assert one.cell.endswith("2")
    assert one.fix


def test_a_bracket_of_a_piece_that_is_not_anchored_is_warned_of(tmp_path):
    problems = read(tmp_path, bracket_capacity=1, anchored="no").problems
    assert [one.severity for one in problems if "Bracket capacity is given, but Anchored is no" in one.message] == [
        "warning"
    ]
