"""Models far from their origin that come again with another multiple of 100 m taken off: the origin stays."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from assess.bim.import_workbook import ImportedBuilding
from assess.bim.read_source import read_source
from tests.bim.ifc_files import ModelWriter
from tests.bim.update_books import FLOORS, ITEMS, PLACES, building, piece, row, texts, typed, update, write_first


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
def test_new_rows_and_moved_pieces_get_the_origin_of_the_workbook(book: bytes) -> None:
    place = {"place": "B202", "floor": "Level 2", "x": 9.0, "y": 2.0, "kind": "room", "outline": "6 0; 12.5 0; 12.5 4"}
    items = [{**ITEMS[0], "x": 7.0}, *ITEMS[1:], piece(7, "Level 3", "C301")]
    floor = {"floor": "Level 3", "elevation": 6.2, "plan": "house-Level-3.svg", "plan_left": -0.5, "plan_bottom": -0.5}
    model = building(floors=[*FLOORS, floor], items=items, places=[*PLACES, place])
    found, same = (update(book, one) for one in (shift(model, 100, -100), model))
    assert texts(found) == texts(same)
    assert len(found.changes) == 4
    assert found.data == same.data


@pytest.mark.slow
def test_a_building_that_moved_by_no_whole_step_and_half_of_its_pieces_are_moved(book: bytes) -> None:
    found = update(book, shift(building(), 103.0, 0.0))
    assert found.moved == (0.0, 0.0)
    assert row(found.data).get("x") == 104
    moved = shift(building(), 100, 0).items
    found = update(book, building(items=[*moved[:3], *ITEMS[3:]]))
    assert found.moved == (0.0, 0.0)
    assert [one.now for one in found.changes] == [101, 102, 103]


@pytest.mark.slow
def test_a_new_piece_beyond_a_line_of_the_grid_moves_nothing_else(tmp_path: Path) -> None:
    def write(*more: float) -> ImportedBuilding:
        model = ModelWriter()
        storey = model.storey()
        for number, at in enumerate((2.0, 3.0, 4.0, *more)):
            model.piece(f"Shelf {number}", (0, 0, 0, 0.4, 0.8, 1.9), within=storey, at=(412_000 + at, 5_654_001, 0))
        path = model.write(tmp_path / "a.ifc")
        ids = {f"Shelf {number}": f"shelf {number}" for number in range(4)}
        found = read_source(path, path.name)
        return replace(found, items=[{**one, "source_id": ids[one["description"]]} for one in found.items])

    first = write()
    found = update(write_first(first), write(-1.0))
    assert found.moved == (-100.0, 0.0)
    assert [one.kind for one in found.changes if one.sheet == "Items"] == ["added"]
    assert row(found.data, 4).get("x") == pytest.approx(-1.0)
