"""The elevation that is assumed of a floor from its name."""

import pytest

from assess.motion.assumed import assume_elevation, find_lowest_number, find_storey, guess_elevation

NAMES = {
    "0": 0, "G": 0, "Ground floor": 0, " pt ": 0, "Piano terra": 0, "B1": 0, "b 2": 0, "-2": 0, "Basement": 0,
    "basement 2": 0,
    "1": 1, "03": 3, "L11": 11, "Floor 2": 2, "level  7": 7, "Piano 4": 4, "2nd floor": 2, "3rd": 3,
    "1\N{DEGREE SIGN}": 1, "3\N{DEGREE SIGN} piano": 3, "4th storey": 4,
}  # fmt: skip
UNNUMBERED = ["Roof", "Mezzanine", "25A", "Block 3 floor 10", "A", "", "2/3", "Wing 2", "B", "b.", "-", "- "]


def test_the_storey_that_a_name_tells():
    assert {name: find_storey(name) for name in NAMES} == NAMES
    assert {find_storey(name) for name in UNNUMBERED} == {None}
    assert {assume_elevation(name, 12.0, 4) for name in UNNUMBERED} == {None}
    assert assume_elevation("2", None, 4) is assume_elevation("2", 12.0, None) is None
    # storeys are of one height, and no floor is above the roof
    assert [assume_elevation(str(one), 12.0, 4) for one in range(6)] == [0, 3, 6, 9, 12, 12]


def test_the_ground_floor_begins_the_numbers():
    cases: list[tuple[int | None, dict[str, float | None]]] = [
        (0, {"1": None, "2": None}), (0, {"0": 0.0, "1": None}), (0, {"Hall": 0.0, "1": None}), (0, {"1": -4.0}),
        (1, {"1": 0.0, "2": None}), (2, {"B1": -3.0, "2": 0.0}), (None, {"1": 0.0, "2": 0.0}),
        (None, {"1": 0.0, "2": 3.0}),
    ]  # fmt: skip
    for lowest, floors in cases:
        assert find_lowest_number(floors.items()) == lowest, floors
    assert [assume_elevation(str(one), 12.0, 4, lowest=1) for one in range(6)] == [0, 0, 3, 6, 9, 12]


@pytest.mark.parametrize(
    ("name", "floors", "height", "storeys", "expected"),
    [
        ("3", [], None, None, 9.9), ("3", [], 16, 4, 12), ("9", [], 16, 4, 16), ("Roof", [], 16, 4, None),
        ("-1", [], 16, 4, None), ("3rd floor", [("1", 0.0)], None, None, 6.6),
        ("2", [("1", 0.0), ("4", 12.0)], 9, 2, 4),
        ("5", [("1", 0.0), ("3", 6.0), ("4", 10.0), ("Roof", 20.0)], None, None, 14), ("0", [("2", None)], 9, 3, 0),
    ],
)  # fmt: skip
def test_the_elevation_that_is_offered_goes_on_from_other_floors_else_by_storeys(
    name, floors, height, storeys, expected
):
    assert guess_elevation(name, floors, height, storeys) == expected
