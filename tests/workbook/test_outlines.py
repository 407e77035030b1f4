"""Outlines of places, and what is wrong with them, named by their cells; friction and walls likewise."""

import re

import pytest

import assess
from assess.units import LENGTH
from assess.workbook.outlines import OutlineError, parse_outline
from assess.workbook.schema import ITEMS
from assess.workbook.template import Content, write_workbook

SQUARE = ((0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (0.0, 4.0))


@pytest.mark.parametrize(
    "text",
    [
        "0 0; 6 0; 6 4; 0 4",
        "0 0;6 0;6 4;0 4;",
        " 0 0 ; 6.0 0 ;\n6 4; 0 4; 0 0",
        "0  0\n6 0\n6 4\n0 4",
        "+0 0; 6. .0; 6 4; 0 4",
        "0,0 0; 6,00 0; 6 4,0; 0,000 4",
    ],
)
def test_an_outline_is_its_corners(text):
    assert parse_outline(text, 1.0) == SQUARE


def test_an_outline_in_feet():
    found = parse_outline("0 0; 20 0; 0 10", LENGTH["ft"])
    assert [one for corner in found for one in corner] == pytest.approx([0, 0, 6.096, 0, 0, 3.048])


@pytest.mark.parametrize(
    "text", ["0 0; 4 0; 4 2; 2 2; 2 4; 0 4", "0 0; 0 4; 6 4; 6 0", "-1.5 -2; 3 -2; 3 0; 3 5; -1.5 5"]
)
def test_angled_rooms_either_way_round_and_corners_on_a_side_are_fine(text):
    assert len(parse_outline(text, 1.0)) >= 4


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("0 0; 6 0", "2 corners, expected 3 to 200"),
        ("0 0; 6 0; 0 0", "it has 2 corners"),
        ("0 0; 6 4; 6 0; 0 4", r"sides 1 and 3 cross"),
        ("0 0; 6 0; 3 0; 3 4", r"sides 1 and 2 cross"),
        ("0 0; 6 0; 6 4; 3 0; 0 4", r"sides 1 and 3 cross or touch"),
        ("0 0; 6 0; 6 4; 0 y", r"corner 4 is '0 y'"),
        ("0,5; 6 0; 6 4", r"corner 1 is '0,5', expected two numbers"),
        ("0,0 6,0 6,4; 1 1; 2 1", r"corner 1 is '0,0 6,0 6,4', expected two numbers"),
        ("0 0; 6,500 0; 6 4", r"corner 2 is '6,500 0', which can be read in two ways"),
        ("0 0 1; 6 0 1; 6 4 1", r"corner 1 is '0 0 1'"),
        ("5", r"corner 1 is '5'"),
        ("0 0; 6 0; 6 0; 0 4", r"corner 3 is the same as the one before"),
        ("0 0; 6 0; 200000 4", r"corner 3 lies more than 100 km away"),
        ("; ;", "0 corners"),
        ("; ".join(f"{at} {at * at}" for at in range(201)), "201 corners"),
    ],
)
def test_damaged_outlines(text, fault):
    with pytest.raises(OutlineError) as raised:
        parse_outline(text, 1.0)
    assert re.search(fault, str(raised.value.message))


# --- by cell ---


def problems(tmp_path, item=None, place=None):
    rows = {
        "Floors": [{"floor": "1", "pfa_x": 0.3}],
        "Items": [{"item": "a", "floor": "1", "breadth": 40, "width": 90, "height": 180, **(item or {})}],
        "Places": [{"place": "Office", "floor": "1", "x": 1, "y": 1, **place}] if place else [],
    }
    write_workbook(tmp_path / "w.xlsx", Content(rows=rows))
    inventory = assess.read_inventory(tmp_path / "w.xlsx", strict=False)
    return {(one.sheet, one.cell): one for one in inventory.errors}, inventory


@pytest.mark.parametrize(
    ("item", "message", "fix"),
    [
        ({"friction": 0}, "Friction is 0, expected 0.01 to 2", ""),
        ({"friction": -0.3}, "Friction is -0.3, expected 0.01 to 2", "minus"),
        ({"friction": 2.5}, "Friction is 2.5, expected 0.01 to 2", ""),
        ({"friction": "smooth"}, "Friction is the text 'smooth'", "Type the number"),
        ({"against_wall": "north"}, "Against wall is 'north', expected one of: yes, no", "Choose from the list"),
        ({"against_wall": "yess"}, "Against wall is 'yess'", "Did you mean yes"),
    ],
)
def test_friction_and_wall_are_checked_by_cell(tmp_path, item, message, fix):
    found, inventory = problems(tmp_path, item)
    ((_, cell), one), *others = found.items()
    assert not others
    letter = inventory.letters["Items"][next(iter(item))]
    assert (one.sheet, cell) == ("Items", f"{letter}2")
    assert ITEMS.column(next(iter(item))).label in one.message
    assert one.message.startswith(message)
    assert fix in one.fix


def test_a_damaged_outline_is_an_error_of_its_cell(tmp_path):
    found, inventory = problems(tmp_path, place={"outline": "0 0; 6 4; 6 0; 0 4"})
    (one,) = found.values()
    assert (one.sheet, one.cell) == ("Places", f"{inventory.letters['Places']['outline']}2")
    assert one.message == "Outline: its sides 1 and 3 cross or touch each other."
    assert one.fix.startswith("Write the corners in order")


def test_what_is_right_is_read(tmp_path):
    found, inventory = problems(tmp_path, {"against_wall": "yes", "friction": 0.3}, {"outline": "0 0; 6 0; 6 4; 0 4"})
    assert not found
    assert inventory.items[0].against_wall is True
    assert inventory.places[0].outline == SQUARE


def test_an_outline_without_a_unit_is_reported_once():
    rows = {
        "Floors": [{"floor": "1", "pfa_x": 0.3}],
        "Items": [],
        "Places": [{"place": "a", "floor": "1", "Outline": "0 0; 1 1; 2 0"}],
    }
    with pytest.raises(assess.WorkbookError, match="Outline has no unit") as raised:
        assess.read_inventory(rows)
    assert len([one for one in raised.value.problems if one.severity == "error"]) == 1
