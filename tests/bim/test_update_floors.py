"""Floors, rooms, types, places and plans of a workbook whose names people have changed, when a model comes again."""

from dataclasses import replace
from typing import Any

import pytest

from assess.bim.import_workbook import ImportedBuilding
from assess.bim.update_workbook import update_workbook
from assess.errors import WorkbookError
from assess.workbook.patch import patch_workbook
from tests.bim.update_books import (
    FLOORS,
    ITEMS,
    PLACES,
    TYPES,
    building,
    changed,
    faults,
    inventory,
    kinds,
    piece,
    resaved,
    row,
    table,
    texts,
    typed,
    update,
    without,
    write_first,
)
from tests.workbooks import address


def renamed(data: bytes, names: dict[str, str]) -> bytes:
    """Rename floors, rooms, places and types wherever they stand."""
    changes: dict[str, dict[str, Any]] = {}
    for sheet in ("Floors", "Items", "Places", "Routes", "Catalogue"):
        found = table(data, sheet)
        for one in found.rows:
            for name in ("floor", "room", "place", "type"):
                if one.get(name) in names:
                    changes.setdefault(sheet, {})[found.cell(name, one.number)] = names[one.get(name)]
    return patch_workbook(data, changes).data


NEW_ON_2 = piece(7, "Level 2", "B201 Office")


# ---------------------------------------------------------------- floors


RENAMED = "it seems to have been renamed"


def test_what_people_renamed_keeps_its_name_for_new_pieces_too(book: bytes) -> None:
    """A floor, a room, and a place, which is found by its position."""
    data = renamed(book, {"Level 1": "EG", "A102 Office": "Archive", "Exit A101": "Main entrance"})
    found = update(data, building(items=[*changed(p3={"breadth": 60.0}).items, piece(7, "Level 1", "A102 Office")]))
    assert texts(found) == [
        f"Floors A2 Floor of EG stays 'EG'; the model has 'Level 1': {RENAMED}",
        f"Items {address('room', 4)} Room of A102-03 stays 'Archive'; the model has 'A102 Office': {RENAMED}",
        f"Items {address('breadth', 4)} Breadth [cm] of A102-03: 54.5 -> 60",
        "Items A8 A102-07 was added",
        f"Places A4 Place of Main entrance stays 'Main entrance'; the model has 'Exit A101': {RENAMED}",
    ]
    added = inventory(found.data).items[-1]
    assert (added.floor, added.room) == ("EG", "Archive")
    assert faults(found.data) == []


@pytest.mark.slow
def test_floors_that_were_renumbered_are_not_mixed_up() -> None:
    """People call 0 and 1 what the model calls 1 and 2: pieces stay, new ones go to the floor that is meant."""

    def rename(rows: Any, new: str = "") -> list[dict[str, Any]]:
        return [{**one, "floor": one["floor"].replace("Level ", new)} for one in rows]

    model = building(floors=rename(FLOORS), items=rename(ITEMS), places=rename(PLACES))
    data = renamed(write_first(model), {"1": "0", "2": "1"})
    assert kinds(update(data, model)) == ["kept", "kept"]
    moved = {**ITEMS[2], "floor": "2", "room": "B201 Office"}
    items = rename([*ITEMS[:2], moved, *ITEMS[3:], NEW_ON_2])
    found = update(data, replace(model, items=items))
    assert [one.floor for one in inventory(found.data).items] == ["0", "0", "1", "0", "1", "1", "1"]
    assert [one.get("floor") for one in table(found.data, "Floors").rows] == ["0", "1"]
    anew = building(floors=rename(FLOORS, "L0"), items=rename(ITEMS, "L0"), places=rename(PLACES, "L0"))
    assert kinds(update(data, anew)) == ["kept", "kept"], "names that the model gives anew"


def test_a_new_floor_is_added_with_its_pieces(book: bytes) -> None:
    floor = {"floor": "Level 3", "elevation": 6.2, "plan": "house-Level-3.svg", "plan_left": 0.0}
    found = update(book, building(floors=[*FLOORS, floor], items=[*ITEMS, piece(7, "Level 3", "C301")]))
    assert texts(found) == ["Floors A4 Level 3 was added", "Items A8 C301-07 was added"]
    added = row(found.data, 3, "Floors")
    assert (added.get("elevation"), added.get("plan"), added.get("plan_left")) == (6.2, "house-Level-3.svg", 0.0)
    assert faults(found.data) == []


def test_an_elevation_that_people_corrected_stays(book: bytes) -> None:
    data = typed(typed(book, "Floors", 2, elevation=0.45), "Floors", 3, elevation=None)
    found = update(data)
    cell = address("elevation", 2, "Floors")
    assert texts(found) == [
        f"Floors {cell} Elevation [m] of Level 1 stays 0.45; the model has 0",
        f"Floors {cell[0]}3 Elevation [m] of Level 2: blank -> 3.1",
    ]


def test_a_plan_of_the_import_is_placed_anew_and_one_of_people_stays(book: bytes) -> None:
    data = typed(book, "Floors", 3, plan="survey.png", plan_left=2.0)
    floors = [{**one, "plan_left": -1.5, "plan_width": 22.0} for one in FLOORS]
    found = update(data, building(floors=floors))
    assert kinds(found) == ["changed", "changed", "kept"]
    first, second = table(found.data, "Floors").rows
    assert (first.get("plan_left"), first.get("plan_width")) == (-1.5, 22)
    assert (second.get("plan"), second.get("plan_left")) == ("survey.png", 2.0)
    assert texts(found)[2].endswith(
        "Plan of Level 2 stays 'survey.png'; the model has 'house-Level-2.svg': it is not a plan of the import"
    )


def test_a_plan_of_a_model_of_another_file_name_is_replaced(book: bytes) -> None:
    """The types tell which files the workbook was imported from."""
    floors = [{**one, "plan": one["plan"].replace("house", "house-v2")} for one in FLOORS]
    model = building(source="house_v2.ifc", floors=floors, files={one["plan"]: b"<svg/>" for one in floors})
    found = update(book, model)
    assert [(one.was, one.now) for one in found.changes] == [
        ("house-Level-1.svg", "house-v2-Level-1.svg"), ("house-Level-2.svg", "house-v2-Level-2.svg"),
    ]  # fmt: skip


def test_where_floors_cannot_be_added_nothing_is_written(book: bytes) -> None:
    data = typed(book, "Floors", 6, name="Levels as of the survey in May")
    model = building(floors=[*FLOORS, {"floor": "Level 3", "elevation": 6.2}])
    with pytest.raises(WorkbookError, match="Floors!A6: 1 new row of the model was not added: row 6, the last"):
        update_workbook(data, model, "house.xlsx")


# ---------------------------------------------------------------- rooms and types


def test_a_piece_that_the_model_moved_to_a_room_of_its_own_follows(book: bytes) -> None:
    """The only piece of a room: that it stood in another room of the model is no name that people gave."""
    found = update(book, changed(p5={"room": "B202 Store"}, p6={"room": "A102 Office"}))
    assert [one.now for one in found.changes] == ["B202 Store", "A102 Office"]


def test_a_type_of_the_catalogue_that_people_chose_stays_for_all_pieces(book: bytes) -> None:
    data = book
    for number in (2, 4, 6):
        data = typed(data, row=number, type="Bookcase tall")
    found = update(data, building(items=[*ITEMS, NEW_ON_2]))
    assert texts(found) == [
        f"Items {address('type', 2)} Type of A101-01 stays 'Bookcase tall'; the model has 'Wardrobe 80': it seems to "
        "have been renamed",
        "Items A8 B201-07 was added",
    ]
    assert inventory(found.data).items[-1].type == "Bookcase tall"


def test_a_type_that_the_model_replaced_is_added_and_listed(book: bytes) -> None:
    new = {**TYPES[0], "type": "Wardrobe 90", "width": 90.0}
    pieces = {f"p{number}": {"type": "Wardrobe 90", "width": 90.0} for number in (1, 3, 5)}
    found = update(book, building(items=changed(**pieces).items, types=[new, TYPES[1]]))
    assert kinds(found) == ["changed", "kept"] * 3 + ["added"]
    assert inventory(found.data).items[0].width == pytest.approx(0.9)


def test_sizes_of_a_type_follow_and_its_weight_and_types_of_the_program_stay(book: bytes) -> None:
    data = typed(book, "Catalogue", 2, weight=95)
    own = {"type": "Bookcase tall", "breadth": 77.0, "height": 222.0}
    found = update(data, building(types=[{**TYPES[0], "width": 82.0, "weight": 50.0}, TYPES[1], own]))
    assert kinds(found) == ["changed", "kept", "kept"]
    assert texts(found)[0] == f"Catalogue {address('width', 2, 'Catalogue')} Width [cm] of Wardrobe 80: 80 -> 82"
    assert texts(found)[1].endswith("the model has 77: the type comes with the program")
    kind = row(found.data, sheet="Catalogue")
    assert (kind.get("width"), kind.get("weight")) == (pytest.approx(0.82), 95)


@pytest.mark.slow
def test_types_told_apart_by_a_number_are_found_by_their_sizes() -> None:
    """The numbers follow the order of the pieces: "Desk" of today may be "Desk (2)" of the workbook."""
    small, large = ({"type": "Desk", "breadth": 60.0, "width": width, "height": 75.0} for width in (120.0, 160.0))
    first = building(types=[small, {**large, "type": "Desk (2)"}])
    data = typed(write_first(first), "Catalogue", 2, weight=30)
    again = building(types=[large, {**small, "type": "Desk (2)"}])
    assert update(data, again).changes == ()
    third = {**small, "width": 140.0}
    found = update(data, building(types=[third, {**small, "type": "Desk (2)"}, {**large, "type": "Desk (3)"}]))
    assert texts(found) == [f"Catalogue A{table(data, 'Catalogue').rows[-1].number + 1} Desk (3) was added"]


# ---------------------------------------------------------------- places and routes


def test_places_follow_and_their_kind_stays(book: bytes) -> None:
    data = typed(book, "Places", 2, kind="corridor")
    data = typed(data, "Places", 6, place="Assembly point", floor="Level 1", x=-9, y=0, kind="exit")
    outline = "0 0; 7 0; 7 4; 0 4"
    found = update(data, building(places=[{**PLACES[0], "x": 3.5, "outline": outline}, *PLACES[2:]]))
    assert [(one.label, one.was, one.now) for one in found.changes] == [
        ("X [m]", 3, 3.5), ("Outline [m]", PLACES[0]["outline"], outline),
    ]  # fmt: skip
    assert row(found.data, sheet="Places").get("kind") == "corridor"


def test_a_place_that_people_put_on_another_floor_is_listed(book: bytes) -> None:
    data = typed(book, "Places", 6, place="Exit B", floor="Level 2", x=50, y=50)
    new = {"place": "exit b", "floor": "Level 1", "x": 20.0, "y": 2.0, "kind": "exit"}
    found = update_workbook(data, building(places=[*PLACES, new]), "house.xlsx")
    assert texts(found) == ["Places B6 Floor of Exit B stays 'Level 2'; the model has 'Level 1'"]


@pytest.mark.slow
def test_routes_are_peoples_own_and_points_of_another_draft_move_none_of_theirs() -> None:
    """Drafts number their points: "L1 point 1" of the model may be another one than that of a reviewed route."""
    point = {"place": "L1 point 1", "floor": "Level 1", "x": 5.0, "y": 2.0}
    segment = {"route": "R", "segment": "a", "floor": "Level 1", "start": "L1 point 1", "end": "Exit A101"}
    data = write_first(building(places=[*PLACES, point], routes=[segment]))
    others = [{**point, "x": 9.0}, {**point, "place": "L1 point 2"}]
    other = [{**segment, "segment": "b", "clear_width": 1.2}, segment | {"route": "S"}]
    assert update(data, building(places=[*PLACES, *others], routes=other)).changes == ()


def test_without_a_sheet_of_places_these_are_left_out(book: bytes) -> None:
    found = update(resaved(book, lambda one: one.remove(one["Places"])))
    assert texts(found)[0] == "Places A101 Hall of the model was left out: the workbook lacks the sheet"
    assert kinds(found) == ["left_out"] * len(PLACES)


@pytest.mark.slow
def test_a_model_of_one_storey_alone_touches_that_storey_alone(book: bytes) -> None:
    model: ImportedBuilding = replace(without(changed(p5={"breadth": 60.0}), 1, 2, 3, 4), floors=FLOORS[1:])
    found = update(book, replace(model, places=PLACES[3:]))
    assert kinds(found) == ["changed", *["missing"] * 4]
