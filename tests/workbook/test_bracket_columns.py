"""Weight, Bracket height and Bracket capacity of Items: read in any unit."""

import json

import pytest

import assess
from tests.workbooks import UNVERIFIED, write

PIECE = {"item": "a", "floor": "1", "breadth": 40, "width": 90, "height": 180, "anchored": "yes"}


def read(folder, units="si", **given):
    return assess.read_inventory(write(folder / "w.xlsx", [PIECE | given], None, units))


def test_they_are_read_and_kept_in_the_results(tmp_path):
    """What is blank is assumed, or null."""
    pieces = [PIECE | {"weight": 120, "bracket_height": 170, "bracket_capacity": 1.5}, PIECE | {"item": "b"}]
    inventory = assess.read_inventory(write(tmp_path / "w.xlsx", pieces))
    item = inventory.items[0]
    assert (item.weight, item.bracket_height, item.bracket_capacity) == pytest.approx((120, 1.7, 1500))
    assess.write_reports(assess.run(inventory, UNVERIFIED), tmp_path / "out", formats=("json",))
    given, blank = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))["items"]
    names = ("weight_source", "weight_kn", "bracket_height_cm", "bracket_capacity_kn", "holds", "counts_as_anchored")
    weight = pytest.approx(120 * 9.80665 / 1000)
    assert (given["weight_kg"], *map(given["anchor"].get, names)) == (120, "given", weight, 170, 1.5, True, True)
    names = [name for name in names if name != "weight_kn"]
    assert (blank["weight_kg"], *map(blank["anchor"].get, names)) == (
        None, "estimate", pytest.approx(162), None, None, True,
    )  # fmt: skip


def test_other_units_are_read(tmp_path):
    piece = {"breadth": 16, "width": 36, "height": 72, "weight": 100, "bracket_height": 60, "bracket_capacity": 250}
    (item,) = read(tmp_path, "imperial", **piece).items
    found = (item.weight, item.bracket_height, item.bracket_capacity)
    assert found == pytest.approx((45.359237, 1.524, 1112.0554), rel=1e-6)


def test_a_bracket_of_a_piece_that_is_not_anchored_is_warned_of(tmp_path):
    (problem,) = read(tmp_path, bracket_capacity=1, anchored="no").problems
    assert (problem.severity, problem.message) == ("warning", "Bracket capacity is given, but Anchored is no.")
