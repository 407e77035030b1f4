"""The live columns where only an intensity is known: the program's numbers to 1e-9, or a word in place of a class."""

from itertools import product
from pathlib import Path
from typing import Any

import openpyxl
import pytest

from assess.i18n import load_catalogue, speaking
from assess.intensity import SHAKINGS
from assess.units import GRAVITY
from tests.workbook.test_live import Rows, by_formualizer, check, fill, poison

pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported")

FLOORS: Rows = [{"floor": str(at), "elevation": z} for at, z in enumerate((-3, 0, 3.5, 7.25, 30))]
SIZES: Rows = [
    {"breadth": 30, "height": 190}, {"breadth": 60, "height": 180, "axis": "Y"},
    {"breadth": 120, "height": 100, "centre_of_gravity": 40}, {"type": "Bookcase 5 shelves"},
]  # fmt: skip
ITEMS: Rows = [
    {"item": f"{floor['floor']} {at}", "floor": floor["floor"], **size}
    for floor, (at, size) in product(
        FLOORS,
        enumerate(SIZES),
    )
]
BUILDINGS: list[dict[str, Any]] = [
    {}, {"period": 0.3}, {"period": 2.1, "height": 12}, {"height": 45, "motion_uncertainty": 0.2},
    {"period": 1.2, "ground_pgv": 9.0, "motion_uncertainty": 1.1}, {"scenario_kind": "as filled", "period": 3.0},
]  # fmt: skip


@pytest.mark.parametrize("building", BUILDINGS, ids=["nothing else", "T1", "low roof", "high roof", "PGV", "kind"])
@pytest.mark.parametrize("units", ["si", "imperial"])
def test_they_equal_the_program(tmp_path: Path, units: Any, building: dict[str, Any]) -> None:
    choice = "MMI VI, strong" if "period" in building else "JMA 5-, lower"
    check(fill(tmp_path / "book.xlsx", ITEMS, FLOORS, {"shaking": choice, **building}, units), by_formualizer)


@pytest.mark.parametrize("choice", SHAKINGS)
def test_every_choice_equals_the_program(tmp_path: Path, choice: str) -> None:
    path = fill(tmp_path / "book.xlsx", ITEMS[4:8], FLOORS, {"shaking": choice, "period": 4.0})
    check(path, by_formualizer)
    assert by_formualizer(poison(path))[2][1] == pytest.approx(SHAKINGS[choice].pga / GRAVITY)


def test_an_italian_workbook_equals_the_program(tmp_path: Path) -> None:
    with speaking(load_catalogue("it")):
        items = [{**row, "type": "Libreria a 5 ripiani"} if "type" in row else row for row in ITEMS]
        check(fill(tmp_path / "book.xlsx", items, FLOORS, {"shaking": "MMI VIII, severe"}), by_formualizer)


def shown_of(folder: Path, floors: Rows, **building: Any) -> list[Any]:
    item = {"item": "A1", "floor": "2", "breadth": 150, "height": 180}
    return by_formualizer(poison(fill(folder / "book.xlsx", [item], floors, building)))[2]


@pytest.mark.parametrize(
    "building",
    [{"ground_pga": 0.2}, {"sds": 0.5}, {"scenario_kind": "NTC 2018"}, {"shaking": "much"}],
)
def test_where_something_else_serves_the_floors_no_class_is_shown(tmp_path: Path, building: dict[str, Any]) -> None:
    shown = shown_of(tmp_path, FLOORS, **{"shaking": "MMI VII, very strong"} | building)
    assert shown[1:] == ["run assess"] * 5


@pytest.mark.parametrize("own", [{"pfa_x": 0.4}, {"record_y": "roof.csv"}])
def test_a_floor_with_a_motion_of_its_own_leaves_the_others_to_the_program(tmp_path: Path, own: dict[str, Any]) -> None:
    floors = [*FLOORS[:4], FLOORS[4] | own]
    assert shown_of(tmp_path, floors, shaking="MMI VII, very strong")[1:] == ["run assess"] * 5


@pytest.mark.parametrize("kind", ["given", "recorded"])
def test_where_no_profile_serves_shaking_is_missing(tmp_path: Path, kind: str) -> None:
    shown = shown_of(tmp_path, FLOORS, shaking="MMI VII, very strong", scenario_kind=kind)
    assert shown[1:] == ["shaking?"] * 5


def test_a_floor_without_elevation_shows_no_class(tmp_path: Path) -> None:
    floors = [*FLOORS[:2], {"floor": "2"}]
    assert shown_of(tmp_path, floors, shaking="MMI VII, very strong")[1:] == ["shaking?"] * 5


def test_whether_a_piece_can_rock_goes_by_the_larger_scatter(tmp_path: Path) -> None:
    """0.028 g x 1 x e^(3 x 0.81) = 0.31 g on the ground, against 0.85 x B/H; with 0.4 it would be 0.09 g."""
    floors: Rows = [{"floor": "2", "elevation": 0}]
    shaken = {"shaking": "MMI IV, light", "motion_uncertainty": 0.1}
    can, cannot = ({"item": "A1", "floor": "2", "breadth": one, "height": 180} for one in (60, 70))
    for item, said in ((can, "yes"), (cannot, "no")):
        path = fill(tmp_path / f"{said}.xlsx", [item], floors, shaken)
        assert by_formualizer(poison(path))[2][5] == said
        check(path, by_formualizer)


def test_the_choices_are_a_list(tmp_path: Path) -> None:
    book = openpyxl.load_workbook(fill(tmp_path / "book.xlsx", ITEMS[:1], FLOORS, {}))
    (row,) = [row for row in book["Building"].iter_rows() if row[0].value == "Shaking"]
    lists = {str(one.sqref): one.formula1 for one in book["Building"].data_validations.dataValidation}
    assert lists[f"B{row[0].row}"] == "list_shaking"


@pytest.mark.parametrize("lacking", [0, 1])
def test_next_to_floors_of_their_own_the_larger_scatter_counts_where_a_floor_lacks_one(
    tmp_path: Path, lacking: int
) -> None:
    """0.1 g x e^(3 x 0.4) is 0.33 g, and x e^(3 x 0.81) 1.1 g: a piece of B/H 0.8 needs 0.68 g."""
    floors: Rows = [{"floor": "1", "elevation": 4, "pfa_x": 0.1}, *[{"floor": "2", "elevation": 9}] * lacking]
    item = {"item": "A1", "floor": "1", "breadth": 80, "height": 100}
    path = fill(tmp_path / "book.xlsx", [item], floors, {"shaking": "MMI VI, strong"})
    assert by_formualizer(poison(path))[2][5] == ("no", "yes")[lacking]
    check(path, by_formualizer)
