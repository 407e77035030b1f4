from assess.bim.building_model import LONGEST_NAME
from assess.bim.import_workbook import ImportedBuilding, build_workbook, list_rows, name_apart
from assess.i18n import load_catalogue, speaking
from assess.workbook.read import read_inventory

PIECE = {"item": "A1", "floor": "1", "type": "Desk", "breadth": 60.0, "width": 120.0, "height": 75.0, "source_id": "g1"}

SHAKEN = {"ground_pga": 0.3}


def _building(**more: object) -> ImportedBuilding:
    rows = {"source": "model.x", "floors": [{"floor": "1", "elevation": 0.0}], "items": [PIECE]}
    return ImportedBuilding(**(rows | more))


def test_rows_of_every_sheet_come_back_in_the_language_in_use_with_names_told_apart() -> None:
    """Positions, outlines and routes are what building models tell, beyond COBie."""
    data = build_workbook(
        _building(
            building={"building": "House", "latitude": 45.5, "longitude": 9.2},
            items=[PIECE | {"x": 2.0, "y": 3.0, "angle_deg": 90.0}],
            places=[{"place": "Hall", "floor": "1", "x": 1.0, "y": 1.0, "outline": "0 0; 6 0; 6 4; 0 4"},
                    {"place": "Door", "floor": "1", "x": 0.0, "y": 1.0, "kind": "exit"}],
            routes=[{"route": "R", "segment": "a", "floor": "1", "start": "Hall", "end": "Door"}],
        )
    )  # fmt: skip
    inventory = read_inventory(data, building=SHAKEN)
    (item,) = inventory.items
    assert (item.x, item.y, item.angle_deg, item.more["source_id"]) == (2.0, 3.0, 90.0, "g1")
    assert list(inventory.places[0].outline) == [(0, 0), (6, 0), (6, 4), (0, 4)]
    assert (inventory.routes[0].start, inventory.building.latitude) == ("Hall", 45.5)
    assert len(inventory.catalogue) > 100
    with speaking(load_catalogue("it")):
        data = build_workbook(_building(types=[{"type": "Desk", "breadth": 60.0, "height": 75.0}]))
    assert read_inventory(data, building=SHAKEN).language == "it"
    first, second = name_apart(["x" * 500] * 2)
    assert (len(first), len(second)) == (LONGEST_NAME, LONGEST_NAME)
    assert second.endswith("x (2)")
    assert name_apart(["Desk", "desk", "Desk (2)", "Desk"]) == ["Desk", "desk (2)", "Desk (2) (2)", "Desk (3)"]
    rooms = "; ".join(f"{number} Waiting area and reception" for number in range(30))
    rows = list_rows(ImportedBuilding(source="a", routes=[{"route": "A", "segment": "1", "room": rooms}]))
    assert rows["Routes"][0]["room"] == rooms
