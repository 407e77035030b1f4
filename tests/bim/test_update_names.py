"""Which floor and room is which: by the pieces that stand there, then by names and elevations."""

from typing import Any

import pytest

from assess.bim.update_names import Named, match_alike, match_floors, match_rooms

LEVELS = {"1": 0.0, "2": 3.0, "3": 6.0}
ALL_THREE = {"1": "1", "2": "2", "3": "3"}
FLOORS: dict[str, tuple[Any, Any, list[tuple[str, str, int]], dict[str, str]]] = {
    "the same names": (LEVELS, LEVELS, [("1", "1", 3), ("2", "2", 1)], ALL_THREE),
    "most pieces tell that a floor was renamed": (
        {"1": 0.0, "2": 3.0}, {"eg": None, "2": None}, [("1", "eg", 4), ("1", "2", 1), ("2", "2", 2)],
        {"1": "eg", "2": "2"},
    ),
    "renumbered floors are told by their pieces": (
        LEVELS, {"0": 0.0, "1": 3.0, "2": 6.0}, [("1", "0", 5), ("1", "1", 1), ("2", "1", 4)],
        {"1": "0", "2": "1", "3": "2"},
    ),
    "pieces that moved to another floor rename none": (
        LEVELS, LEVELS, [("1", "1", 4), ("2", "1", 6), ("2", "2", 3)], ALL_THREE,
    ),
    "a floor that was cleared into another has its own elevation": ({"2": 3.0}, LEVELS, [("2", "1", 6)], {"2": "2"}),
    "floors that people joined are one": (
        {"1a": 0.0, "1b": 0.5}, {"eg": 0.0}, [("1a", "eg", 2), ("1b", "eg", 2)], {"1a": "eg", "1b": "eg"},
    ),
    "a floor without pieces is told by its elevation": (
        {"1": 0.0, "roof": 6.0, "attic": 9.0}, {"1": 0.0, "dach": 6.02}, [("1", "1", 2)], {"1": "1", "roof": "dach"},
    ),
    "half of the pieces are not enough": ({"1": None}, {"a": None, "b": None}, [("1", "a", 2), ("1", "b", 2)], {}),
}  # fmt: skip
"""Elevations of the model and of the workbook, how many pieces stand on which floor of both, and what is the same."""


@pytest.mark.parametrize("case", FLOORS)
def test_which_floor_of_the_workbook_is_that_of_the_model(case: str) -> None:
    model, own, counts, same = FLOORS[case]
    pairs = [(one, other) for one, other, number in counts for _ in range(number)]
    assert match_floors(model, own, pairs) == same


def test_a_room_was_renamed_where_the_model_does_not_know_its_name() -> None:
    trios = [("1", "101", "Archive"), ("1", "101", "archive"), ("1", "102", "101"), ("2", "101", "101")]
    assert match_rooms(trios, {"101", "102"}) == {("1", "101"): "Archive"}
    assert match_rooms([("1", "101", "Archive")] * 3 + [("1", "101", "101")], {"101"}) == {}


def test_alike_are_those_of_one_name_but_for_a_number_and_of_one_content() -> None:
    model = [Named("Desk", (160,)), Named("Desk (2)", (120,)), Named("Desk (3)", (80,)), Named("Sofa", (200,))]
    own = [Named("desk", (120,)), Named("Desk (2)", (160,)), Named("Desk (3)", (90,)), Named("Couch", (200,))]
    same = {0: 1, 1: 0, 2: 2}
    assert match_alike(model, own, lambda one, other: one == other) == same
    assert match_alike(model, own, lambda one, other: one == other, by_content=True) == same | {3: 3}
