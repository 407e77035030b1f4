"""The live columns where a ShakeMap gives the ground motion, which the program alone can read."""

from pathlib import Path
from typing import Any

import pytest

from tests.workbook.test_live import Rows, by_formualizer, fill, poison

pytestmark = pytest.mark.filterwarnings("ignore:.*extension is not supported")

FLOORS: Rows = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 3.5}]
PLACED = {"shakemap": "grid.xml", "latitude": 37.7893, "longitude": -122.4008}
ITEM = {"item": "A1", "floor": "2", "breadth": 40, "height": 180}


def shown_of(folder: Path, floors: Rows, **building: Any) -> list[Any]:
    return by_formualizer(poison(fill(folder / "book.xlsx", [ITEM], floors, building)))[2]


@pytest.mark.parametrize("more", [{}, {"shaking": "MMI IV, light"}], ids=["alone", "with Shaking"])
def test_every_floor_waits_for_the_program_and_never_shows_a_class_of_shaking(tmp_path: Path, more: Any) -> None:
    assert shown_of(tmp_path, FLOORS, **PLACED | more)[1:] == ["run assess"] * 5


def test_with_a_floor_of_its_own_motion_it_alone_has_a_class(tmp_path: Path) -> None:
    """Whether the piece can start to rock goes by the dispersion of the building, which holds that of the map."""
    shown = shown_of(tmp_path, [FLOORS[0], FLOORS[1] | {"pfa_x": 0.01, "pfa_y": 0.01}], **PLACED)
    assert shown[1] == pytest.approx(0.01)
    assert shown[-1] == "run assess"


def test_where_ground_pga_is_known_the_map_changes_nothing(tmp_path: Path) -> None:
    floors = [FLOORS[0], FLOORS[1] | {"pfa_x": 0.01, "pfa_y": 0.01}]
    assert shown_of(tmp_path, floors, **PLACED, ground_pga=0.01)[-1] == "no"
