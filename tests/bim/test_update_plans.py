"""Plans beside a workbook that is updated: whose they are, what is written, and under which names."""

import os
from pathlib import Path
from typing import Any

import pytest

from assess.bim.building_model import BuildingModel
from assess.bim.floor_drawing import draw_storey, is_drawn
from assess.bim.import_workbook import ImportedBuilding
from assess.bim.update_workbook import Updated, update_workbook
from tests.bim.update_books import FLOORS, ITEMS, building, first_book, piece, table, texts, typed

HEAD = b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 21.000 14.000"><style>.wall{fill:#4d4d4d}</style>'
NEW = {name: HEAD + name.encode() for name in ("house-Level-1.svg", "house-Level-2.svg", "house-Level-3.svg")}
"""Plans as the model gives them today."""
OLD = dict.fromkeys(NEW, HEAD + b"old")
THIRD = {"floor": "Level 3", "elevation": 6.2, "plan": "house-Level-3.svg"}


def model(**more: Any) -> ImportedBuilding:
    return building(files={**{name: NEW[name] for name in list(NEW)[:2]}, "house-import.txt": b"list"}, **more)


def update(folder: Path, data: bytes, imported: ImportedBuilding) -> Updated:
    """Update a workbook and write its plans; the second time, nothing is left to do."""
    found = update_workbook(data, imported, "house.xlsx", records=folder)
    for name, one in found.plans.items():
        (folder / name).write_bytes(one)
    again = update_workbook(found.data, imported, "house.xlsx", records=folder)
    assert (again.data, again.is_changed, again.plans) == (found.data, False, {})
    return found


def put(folder: Path, **files: bytes) -> None:
    for name, data in files.items():
        (folder / f"house-{name.replace('_', '-')}.svg").write_bytes(data)


def named(found: Updated) -> list[str]:
    return [row.get("plan") for row in table(found.data, "Floors").rows]


def test_plans_of_an_import_are_written_and_those_of_people_stay(tmp_path: Path, book: bytes) -> None:
    found = update(tmp_path, book, model())
    assert found.plans == {name: NEW[name] for name in list(NEW)[:2]}
    assert not found.is_changed
    put(tmp_path, Level_1=OLD["house-Level-1.svg"], Level_2=NEW["house-Level-2.svg"])
    found = update(tmp_path, book, model())
    assert (found.plans, found.changes) == ({"house-Level-1.svg": NEW["house-Level-1.svg"]}, ())
    put(tmp_path, Level_1=b"<svg>survey</svg>", Level_2=OLD["house-Level-2.svg"])
    floors = [{**one, "plan_left": -1.5} for one in FLOORS]
    found = update(tmp_path, book, model(floors=floors))
    assert texts(found)[0] == "Floors A2 Level 1 stays as it is: house-Level-1.svg is not a plan of the import"
    assert [row.get("plan_left") for row in table(found.data, "Floors").rows] == [-0.5, -1.5]
    assert list(found.plans) == ["house-Level-2.svg"]
    put(tmp_path, Level_1=OLD["house-Level-1.svg"])
    found = update(tmp_path, typed(book, "Floors", 2, plan="survey.png"), model())
    assert "house-Level-1.svg" not in found.plans, "the floor names another plan"


@pytest.mark.parametrize("mine", [b"<svg>mine</svg>", OLD["house-Level-1.svg"]])
@pytest.mark.slow
def test_a_file_that_floors_do_not_name_keeps_its_name(tmp_path: Path, book: bytes, mine: bytes) -> None:
    """Not even a plan of an import is known to be nobody's then."""
    put(tmp_path, Level_1=mine, Level_3=mine)
    data = typed(book, "Floors", 2, plan=None)
    imported = model(floors=[*FLOORS, THIRD], items=[*ITEMS, piece(7, "Level 3", "C301")])
    found = update(tmp_path, data, building(floors=imported.floors, items=imported.items, files=NEW))
    assert named(found) == ["house-Level-1-2.svg", "house-Level-2.svg", "house-Level-3-2.svg"]
    assert (tmp_path / "house-Level-1.svg").read_bytes() == mine
    assert (tmp_path / "house-Level-3-2.svg").read_bytes() == NEW["house-Level-3.svg"]


def test_no_plan_takes_the_name_of_another_floor(tmp_path: Path) -> None:
    """Floors "EG" and "EG 2", both with the plan of the second, as an earlier version left them."""
    plans = {"house-EG.svg": HEAD + b"1", "house-EG-2.svg": HEAD + b"2"}
    floors = [
        {**one, "floor": name, "plan": plan} for one, name, plan in zip(FLOORS, ("EG", "EG 2"), plans, strict=True)
    ]
    items = [{**one, "floor": "EG" if one["floor"] == "Level 1" else "EG 2"} for one in ITEMS]
    imported = building(floors=floors, items=items, places=[], files=plans)
    data = typed(first_book(floors=floors, items=items, places=[]), "Floors", 2, plan="house-EG-2.svg")
    put(tmp_path, EG=b"mine", EG_2=plans["house-EG-2.svg"])
    found = update(tmp_path, data, imported)
    assert named(found) == ["house-EG-3.svg", "house-EG-2.svg"]
    assert [(tmp_path / name).read_bytes() for name in named(found)] == list(plans.values())
    assert (tmp_path / "house-EG.svg").read_bytes() == b"mine"


@pytest.mark.slow
def test_a_plan_of_a_floor_that_the_model_lost_is_not_replaced(tmp_path: Path, book: bytes) -> None:
    """The model calls Level 2 now what was Level 1, whose plan would get the name of that of the floor that is gone."""
    put(tmp_path, Level_1=OLD["house-Level-1.svg"], Level_2=OLD["house-Level-2.svg"])
    floors = [{**FLOORS[0], "floor": "Level 2", "plan": "house-Level-2.svg"}]
    items = [{**one, "floor": "Level 2"} for one in ITEMS[:4]]
    found = update(tmp_path, book, building(floors=floors, items=items, places=[], files=NEW))
    assert named(found) == ["house-Level-2-2.svg", "house-Level-2.svg"]
    assert (tmp_path / "house-Level-2.svg").read_bytes() == OLD["house-Level-2.svg"]


LINKS = pytest.mark.skipif(os.name == "nt", reason="Windows lets few users make links")


@pytest.mark.parametrize("kind", ["folder", pytest.param("link", marks=LINKS)])
def test_what_is_no_file_is_not_replaced(tmp_path: Path, book: bytes, kind: str) -> None:
    path = tmp_path / "house-Level-1.svg"
    path.mkdir() if kind == "folder" else path.symlink_to(tmp_path / "away.svg")
    found = update(tmp_path, book, model())
    assert texts(found) == ["Floors A2 Level 1 stays as it is: house-Level-1.svg is not a plan of the import"]
    assert list(found.plans) == ["house-Level-2.svg"]


def test_a_plan_as_it_is_drawn_is_known_again_and_one_that_a_program_saved_is_not(duplex: BuildingModel) -> None:
    drawn, _place = next(plan for one in duplex.storeys if (plan := draw_storey(duplex, one)) is not None)
    assert is_drawn(drawn)
    assert not is_drawn(b'<?xml version="1.0"?>\n' + drawn)
    assert not is_drawn(drawn.replace(b"viewBox", b'width="21" viewBox'))
