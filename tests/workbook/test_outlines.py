"""Outlines of places, and what is wrong with them, named by their cells."""

import re

import pytest

from assess.units import LENGTH
from assess.workbook.habits import CellError
from assess.workbook.read import read_inventory
from assess.workbook.values import parse_outline
from tests.workbook.books import Sheet, errors_of, write

SQUARE = ((0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (0.0, 4.0))


def test_an_outline_is_its_corners_and_a_damaged_one_says_what_is_wrong(tmp_path):
    for text in (
        "0 0; 6 0; 6 4; 0 4", "0 0;6 0;6 4;0 4;", " 0 0 ; 6.0 0 ;\n6 4; 0 4; 0 0", "0  0\n6 0\n6 4\n0 4",
        "+0 0; 6. .0; 6 4; 0 4", "0,0 0; 6,00 0; 6 4,0; 0,000 4",
    ):  # fmt: skip
        assert parse_outline(text, 1.0) == SQUARE
    for text in ("0 0; 4 0; 4 2; 2 2; 2 4; 0 4", "0 0; 0 4; 6 4; 6 0", "-1.5 -2; 3 -2; 3 0; 3 5; -1.5 5"):
        assert len(parse_outline(text, 1.0)) >= 4
    found = parse_outline("0 0; 20 0; 0 10", LENGTH["ft"])
    assert [one for corner in found for one in corner] == pytest.approx([0, 0, 6.096, 0, 0, 3.048])
    for text, fault in DAMAGED:
        with pytest.raises(CellError) as raised:
            parse_outline(text, 1.0)
        assert re.search(fault, str(raised.value.message))
    row = ["Office", "1", 1, 1]
    outlines: Sheet = [["Place", "Floor", "X [m]", "Y [m]", "Outline [m]"], [*row, "0 0; 6 0; 6 4; 0 4"],
                ["Hall", *row[1:], "0 0; 6 4; 6 0; 0 4"]]  # fmt: skip
    inventory = read_inventory(write(tmp_path, Places=outlines), strict=False)
    assert inventory.places[0].outline == SQUARE
    (one,) = inventory.errors
    assert (one.place, one.message) == ("Places!E3", "Outline: its sides 1 and 3 cross or touch each other.")
    assert one.fix.startswith("Write the corners in order")
    (error,) = errors_of(write(tmp_path, Places=[["Place", "Floor", "Outline"], outlines[1][:3]]))
    assert error.startswith("Places!C1: Outline has no unit")


DAMAGED = [
    ("0 0; 6 0", "2 corners, expected 3 to 200"), ("0 0; 6 0; 0 0", "it has 2 corners"),
    ("0 0; 6 4; 6 0; 0 4", r"sides 1 and 3 cross"), ("0 0; 6 0; 3 0; 3 4", r"sides 1 and 2 cross"),
    ("0 0; 6 0; 6 4; 3 0; 0 4", r"sides 1 and 3 cross or touch"), ("0 0; 6 0; 6 4; 0 y", r"corner 4 is '0 y'"),
    ("0,5; 6 0; 6 4", r"corner 1 is '0,5', expected two numbers"),
    ("0,0 6,0 6,4; 1 1; 2 1", r"corner 1 is '0,0 6,0 6,4', expected two numbers"),
    ("0 0; 6,500 0; 6 4", r"corner 2 is '6,500 0', which can be read in two ways"),
    ("0 0 1; 6 0 1; 6 4 1", r"corner 1 is '0 0 1'"), ("5", r"corner 1 is '5'"),
    ("0 0; 6 0; 6 0; 0 4", r"corner 3 is the same as the one before"),
    ("0 0; 6 0; 200000 4", r"corner 3 lies more than 100 km away"), ("; ;", "0 corners"),
    ("; ".join(f"{at} {at * at}" for at in range(201)), "201 corners"),
]  # fmt: skip
