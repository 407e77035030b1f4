"""The live columns in LibreOffice: in every kind of workbook they are what the other engine computes.

That one is held against the program, workbook by workbook, in test_live.py and test_live_ground.py. LibreOffice takes
most of its time to start: it recalculates all workbooks at once.
"""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import openpyxl
import pytest

from assess.i18n import load_catalogue, speaking
from assess.workbook.lists import PLACES
from assess.workbook.schema import LIVE
from assess.workbook.template import Units
from tests.recalculate import libreoffice_all, needs_libreoffice, same
from tests.workbook import test_live as live, test_live_ground as ground
from tests.workbook.test_live import ITEMS_AT, POISON, by_formualizer, fill, poison

pytestmark = [
    pytest.mark.libreoffice,
    needs_libreoffice,
]

Book = Callable[[Path], Path]
Books = dict[str, Book]


def _grid(units: Units = "si", headers: str | None = None) -> Book:
    def write(path: Path) -> Path:
        fill(path, live.GRID, live.FLOORS, {"period": 0.9 if headers else 0.4}, units)
        return live.retype(path, live.RETYPED[headers]) if headers else path

    return write


def _beside(at: int) -> Book:
    return lambda path: live.floors_beside(path, *live.BESIDE[at])


def _ground(floors: live.Rows, building: dict[str, Any], units: Units = "si") -> Book:
    return lambda path: fill(path, ground.furnish(floors), floors, building, units)


def _typed(name: str) -> Book:
    return _ground(ground.own_floors(name), ground.AROUND[1], "imperial")


def _italian_ground(at: int) -> Book:
    pieces = ground.furnish(ground.FLOORS, ground.ITALIAN_SIZES)
    return lambda path: fill(path, pieces, ground.FLOORS, ground.ITALIAN[at])


def _slender(floors: live.Rows, building: dict[str, Any]) -> Book:
    return lambda path: ground.slender(path, floors, **building)


STOREYS = {"ground_pga": 0.2, "storeys": 4}
BOOKS: Books = {
    "grid, imperial": _grid("imperial"), "grid, mixed units": _grid(headers="mixed"),
    "grid, Italian": lambda path: live.italian_grid(path, "si"),
    "blank rows": lambda path: fill(path, live.GRID[:1], live.FLOORS, {}, spare=None),
    "unknown types": live.unknown_types, "stray names": live.stray_names,
    "signs": lambda path: live.floors_of_signs(path, [*live.SIGNS, "12"]),
    "signs of no floor": lambda path: live.floors_of_signs(path, ["1**", "1?*", "~1?", "*?", "2*"]),
    "anchored": live.anchored_pieces, "on castors": live.pieces_on_castors, "typed capacities": live.typed_capacities, "texts": live.texts_for_numbers,
    "widths": live.breadths_and_widths, "slower motion": live.pieces_of_a_slower_motion,
    **{f"beside {at}": _beside(at) for at in (0, 9)}, "ground, JMA": _ground(ground.FLOORS, ground.BUILDINGS["JMA"]),
    "ground, Italian": _italian_ground(1), "typed, at grade, two ratios": _typed("at grade, two ratios"),
    "roof, more": _slender(ground.AT_9_M, ground.ROOFS["more"]), "two floors at 0": _ground(ground.TWO_AT_0, STOREYS),
    "rows without a name": _slender([*ground.AT_9_M, *ground.NAMELESS], {"ground_pga": 0.2}),
}  # fmt: skip
OTHERS: Books = {
    "grid, SI": _grid("si"),
    "grid, mm": _grid(headers="mm"),
    "grid, Italian, imperial": lambda path: live.italian_grid(path, "imperial"),
    "typed capacities, Italian": live.typed_capacities,
    **{f"beside {at}": _beside(at) for at in range(len(live.BESIDE))},
    **{f"ground, {name}": _ground(ground.FLOORS, building) for name, building in ground.BUILDINGS.items()},
    "ground, Italian": _italian_ground(0),
    **{f"typed, {name}": _typed(name) for name in ground.OWN},
    **{f"roof, {name}": _slender(ground.AT_9_M, building) for name, building in ground.ROOFS.items()},
    "a floor beside one at 0": _ground(ground.BESIDE_0, STOREYS),
}
"""The same claims of more workbooks."""


@pytest.mark.parametrize("books", [BOOKS, pytest.param(OTHERS, marks=pytest.mark.long)], ids=["each kind", "others"])
def test_libreoffice_shows_what_the_other_engine_does(tmp_path: Path, books: Books) -> None:
    paths = {}
    for at, (name, write) in enumerate(books.items()):
        with speaking(load_catalogue("it" if "Italian" in name else "en")):
            paths[name] = poison(write(tmp_path / f"{at}.xlsx"))
    found = {}
    for (name, path), again in zip(
        paths.items(), libreoffice_all(list(paths.values()), tmp_path / "again"), strict=True
    ):
        with speaking(load_catalogue("it" if "Italian" in name else "en")):
            found[name] = list(_differences(path, again))
    assert {name: rows[0] for name, rows in found.items() if rows} == {}


def _differences(path: Path, again: Path) -> Iterator[str]:
    """Yield the rows of Items that two engines show otherwise."""
    page = openpyxl.load_workbook(again, data_only=True).worksheets[ITEMS_AT]
    places = [PLACES["Items", label] + 1 for label in LIVE]
    for row, wanted in by_formualizer(path).items():
        shown = ["" if page.cell(row, at).value is None else page.cell(row, at).value for at in places]
        if POISON in shown or not all(map(same, shown, wanted)):
            yield f"row {row}: {shown}, expected {wanted}"
