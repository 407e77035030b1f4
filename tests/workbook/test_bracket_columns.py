"""Weight, Bracket height and Bracket capacity of Items: read in any unit."""

import pytest

import assess
from tests.workbooks import write

PIECE = {"item": "a", "floor": "1", "breadth": 40, "width": 90, "height": 180, "anchored": "yes"}


def read(folder, units="si", **given):
    return assess.read_inventory(write(folder / "w.xlsx", [PIECE | given], None, units))


@pytest.mark.parametrize(
    ("units", "piece", "expected"),
    [
        ("si", {"weight": 120, "bracket_height": 170, "bracket_capacity": 1.5}, (120, 1.7, 1500)),
        ("imperial", {"breadth": 16, "width": 36, "height": 72, "weight": 100, "bracket_height": 60,
                      "bracket_capacity": 250}, (45.359237, 1.524, 1112.0554)),
    ],
)  # fmt: skip
def test_they_are_read_in_either_units(tmp_path, units, piece, expected):
    (item,) = read(tmp_path, units, **piece).items
    assert (item.weight, item.bracket_height, item.bracket_capacity) == pytest.approx(expected, rel=1e-6)


def test_a_bracket_of_a_piece_that_is_not_anchored_is_warned_of(tmp_path):
    (problem,) = read(tmp_path, bracket_capacity=1, anchored="no").problems
    assert (problem.severity, problem.message) == ("warning", "Bracket capacity is given, but Anchored is no.")
