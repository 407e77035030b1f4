"""Which floor and room is which: by the pieces that stand there, then by names and elevations."""

from dataclasses import replace
from typing import Any

import pytest

from assess.bim.import_workbook import ImportedBuilding
from assess.bim.update_names import match_floors
from tests.bim.update_books import FLOORS, ITEMS, PLACES, building, piece, row, texts, typed, update

LEVELS = {"1": 0.0, "2": 3.0, "3": 6.0}
ALL_THREE = {"1": "1", "2": "2", "3": "3"}
RENAMINGS: dict[str, tuple[Any, Any, list[tuple[str, str, int]], dict[str, str]]] = {
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


@pytest.mark.parametrize("case", RENAMINGS)
def test_which_floor_of_the_workbook_is_that_of_the_model(case: str) -> None:
    model, own, counts, same = RENAMINGS[case]
    pairs = [(one, other) for one, other, number in counts for _ in range(number)]
    assert match_floors(model, own, pairs) == same


def shift(model: ImportedBuilding, x: float, y: float) -> ImportedBuilding:
    """The model as an import sees it that takes more, or less, off all positions."""

    def move(one: dict[str, Any]) -> dict[str, Any]:
        moved = dict(one)
        for name, by in (("x", x), ("y", y), ("plan_left", x), ("plan_bottom", y)):
            if name in one:
                moved[name] = one[name] + by
        if "outline" in one:
            corners = (corner.split() for corner in one["outline"].split(";"))
            moved["outline"] = "; ".join(f"{float(a) + x:g} {float(b) + y:g}" for a, b in corners)
        return moved

    return replace(
        model, **{name: [move(dict(one)) for one in getattr(model, name)] for name in ("floors", "items", "places")}
    )


@pytest.mark.parametrize("by", [(100.0, 0.0), (-200.0, 1300.0), (0.0, 0.0)])
def test_another_origin_of_the_model_is_no_change(book: bytes, by: tuple[float, float]) -> None:
    own = {"item": "Own", "floor": "Level 1", "breadth": 40, "height": 180, "x": 5, "y": 5}
    data = typed(book, row=12, **own)
    found = update(data, shift(building(), *by))
    assert (found.changes, found.data) == ((), data)
    assert found.moved == (-by[0], -by[1])


@pytest.mark.slow
def test_new_rows_get_the_origin_of_the_workbook_and_half_of_the_pieces_or_no_whole_step_are_moved(book: bytes) -> None:
    place = {"place": "B202", "floor": "Level 2", "x": 9.0, "y": 2.0, "kind": "room", "outline": "6 0; 12.5 0; 12.5 4"}
    items = [{**ITEMS[0], "x": 7.0}, *ITEMS[1:], piece(7, "Level 3", "C301")]
    floor = {"floor": "Level 3", "elevation": 6.2, "plan": "house-Level-3.svg", "plan_left": -0.5, "plan_bottom": -0.5}
    model = building(floors=[*FLOORS, floor], items=items, places=[*PLACES, place])
    found, same = (update(book, one) for one in (shift(model, 100, -100), model))
    assert texts(found) == texts(same)
    assert len(found.changes) == 4
    assert found.data == same.data
    found = update(book, shift(building(), 103.0, 0.0))
    assert found.moved == (0.0, 0.0)
    assert row(found.data).get("x") == 104
    moved = shift(building(), 100, 0).items
    found = update(book, building(items=[*moved[:3], *ITEMS[3:]]))
    assert found.moved == (0.0, 0.0)
    assert [one.now for one in found.changes] == [101, 102, 103]
