"""Models far from their origin, with elements far from the building, and with identifiers that are no such."""

import pytest

from assess.bim.building_model import BuildingModel
from assess.bim.ifc_model import read_model
from assess.bim.model_rows import list_building
from assess.workbook.read import read_inventory
from tests.bim.ifc_files import ModelWriter, one_room, read, write_import

SHELF = (0, 0, 0, 0.4, 0.8, 1.9)
SHAKEN = {"shaking": "MMI VIII, severe"}


def check(model: BuildingModel, folder):
    """Return the inventory of a model's workbook, with its plans beside it."""
    return read_inventory(write_import(list_building(model), folder), building=SHAKEN)


def test_what_was_forgotten_at_the_origin_leaves_the_building_where_it_is(tmp_path):
    model = ModelWriter()
    storey = model.storey()
    room = model.space(storey, (412_003, 5_654_002, 0, 6, 4, 3))
    model.piece("Shelf", SHELF, within=room, at=(412_002, 5_654_001, 0))
    model.piece("Forgotten", SHELF, within=storey, at=(1, 1, 0))
    model.element("IfcWall", "Forgotten wall", (3, 0, 0, 6, 0.2, 3), within=storey)
    model.element("IfcWall", "Wall", (412_003, 5_654_000, 0, 6, 0.2, 3), within=storey)
    model.element("IfcDoor", "Forgotten door", (2, 0, 0, 0.9, 0.1, 2.1), within=storey)
    found = read(model, tmp_path)
    assert [one.name for one in found.pieces] == ["Shelf"]
    assert found.shift == pytest.approx((412_000, 5_653_900))
    assert [(one.type, str(one.reason)) for one in found.skipped] == [
        ("IfcFurniture Forgotten", "more than 2 km from the middle of the building")
    ]
    remark = (
        "Rooms, doors, stairs and parts of walls that lie more than 2 km from the middle of the building were left "
        "out: 2."
    )
    assert remark in found.remarks
    (item,) = check(found, tmp_path).items
    assert (item.x, item.y) == pytest.approx((2, 101), abs=1e-3)


@pytest.mark.parametrize("size", [1e7, 1e20, 1e300])
def test_a_size_beyond_reason_leaves_the_plan_as_it_is(tmp_path, size):
    model, storey, room = one_room()
    model.piece("Shelf", SHELF, within=room, at=(2, 1, 0))
    model.piece("Mountain", (0, 0, 0, size, 1, 1), within=room, at=(2, 1, 0))
    model.element("IfcWall", "Ridge", (0, 0, 0, size, 0.2, 3), within=storey)
    found = read(model, tmp_path)
    assert [one.name for one in found.pieces] == ["Shelf"]
    assert [one.type for one in found.skipped] == ["IfcFurniture Mountain"]
    (floor,) = check(found, tmp_path).floors
    assert floor.plan is not None


@pytest.mark.parametrize("elevation", [1655.0, 1e20])
def test_an_elevation_that_no_workbook_takes_is_left_blank(tmp_path, elevation):
    model = ModelWriter()
    storey = model.storey("Level 1", elevation, z=0.0)
    model.piece("Shelf", SHELF, within=storey, at=(2, 1, 0))
    found = list_building(read(model, tmp_path))
    assert "elevation" not in found.floors[0]
    assert [str(one) for one in found.warnings] == [
        "Elevation is blank for Level 1: in the model it is outside -200 to 1000 m. Fill in the height above the "
        "ground."
    ]
    assert "height" not in found.building


def test_elements_that_share_an_identifier_stay_apart_and_a_storey_without_one_is_known_by_its_number(tmp_path):
    model, storey, room = one_room()
    other = model.space(storey, (9, 2, 0, 6, 4, 3), "102", "Store")
    doors = [model.element("IfcDoor", "Door", (x, 0, 0, 0.9, 0.1, 2.1), within=storey) for x in (2, 9)]
    pieces = [model.piece("Shelf", SHELF, within=storey, at=(x, 1, 0)) for x in (2, 9)]
    for first, second in ((room, other), doors, pieces):
        second.GlobalId = first.GlobalId
    found = read(model, tmp_path)
    inventory = check(found, tmp_path)
    assert sorted(one.place for one in inventory.places) == ["101 Office", "102 Store", "Exit 101", "Exit 102"]
    assert sorted(one.room for one in inventory.items) == ["101 Office", "102 Store"]
    ids = sorted(one.more["source_id"] for one in inventory.items)
    assert ids == [pieces[0].GlobalId, f"{pieces[0].GlobalId} #{pieces[1].id()}"]
    model, storey, room = one_room()
    model.piece("Shelf", SHELF, within=room, at=(2, 1, 0))
    model.site.RefLatitude, model.site.RefLongitude = (92, 0, 0), (9, 0, 0)
    path = model.write(tmp_path / "a.ifc")
    path.write_text(path.read_text().replace(f"'{storey.GlobalId}'", "$"))
    found = read_model(path, "a.ifc")
    assert [one.key for one in found.storeys] == [f"#{storey.id()}"]
    assert found.latitude is None, "beyond the pole"
    assert [(one.floor, one.room) for one in check(found, tmp_path).items] == [("Level 1", "101 Office")]
