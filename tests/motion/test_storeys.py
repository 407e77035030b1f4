"""The elevation that is assumed of a floor from its name."""

from assess.motion.assumed import assume_elevation, find_lowest_number, find_storey

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
