import pytest

from assess.errors import InputError, WorkbookError
from assess.portfolio.building_inventory import read_building
from assess.portfolio.index_file import IndexRow
from assess.portfolio.sources import Source
from tests.bim.cobie_files import COMPONENTS, TYPES, one_type, write_cobie
from tests.workbooks import write

SHAKEN = IndexRow(path="c.xlsx", ground_pga_g=0.3)


def _read(source, file=None):
    return read_building(source, None if file is None else file.read_bytes(), None)


def test_a_workbook_is_surveyed(tmp_path):
    path = write(tmp_path / "w.xlsx")
    origin, inventory = _read(Source(path="w.xlsx", file=path), path)
    assert (origin.inventory, origin.low, len(inventory.items)) == ("surveyed", None, 5)


def test_a_cobie_file_is_handed_over_and_says_what_was_left_out(tmp_path):
    path = write_cobie(tmp_path / "c.xlsx")
    origin, inventory = _read(Source(path="c.xlsx", file=path, index=SHAKEN), path)
    assert (origin.inventory, origin.path) == ("handover", "c.xlsx")
    assert [one.item for one in inventory.items] == ["Bookcase A:1", "Bookcase A:2"]
    messages = [one.message for one in inventory.problems]
    assert "1 component left out (AssetType is Fixed): Door B (1)." in messages
    assert origin.left_out == 0, "a door is no furniture"


def test_furniture_without_sizes_in_a_cobie_file_is_counted(tmp_path):
    desk = {"Name": "Desk", "AssetType": "Moveable", "NominalLength": 900, "NominalWidth": 600}
    desks = [{"Name": f"Desk:{at}", "TypeName": "Desk", "Space": "G01"} for at in (1, 2, 3)]
    path = write_cobie(tmp_path / "c.xlsx", types=(*TYPES, desk), components=(*COMPONENTS, *desks))
    origin, inventory = _read(Source(path="c.xlsx", file=path, index=SHAKEN), path)
    assert (origin.left_out, len(inventory.items)) == (3, 2)


def test_a_cobie_file_is_as_its_imported_workbook(tmp_path):
    """A building of a city can be assessed alone: import it, and run the workbook."""
    from assess.bim.cobie import convert
    from assess.workbook.read import read_inventory

    path = write_cobie(tmp_path / "c.xlsx")
    _, inventory = _read(Source(path="c.xlsx", file=path, index=SHAKEN), path)
    alone = read_inventory(convert(path.read_bytes(), "c.xlsx"), building={"ground_pga": 0.3})
    sizes = [(one.item, one.floor, one.breadth, one.height, one.type) for one in inventory.items]
    assert sizes == [(one.item, one.floor, one.breadth, one.height, one.type) for one in alone.items]
    assert [one.elevation for one in inventory.floors] == [one.elevation for one in alone.floors]
    assert inventory.building.height == alone.building.height


def test_a_cobie_file_without_sizes_is_an_error_that_names_its_types(tmp_path):
    path = write_cobie(tmp_path / "c.xlsx", **one_type(NominalHeight="n/a"))
    with pytest.raises(WorkbookError, match="no furniture with sizes is found in the COBie file") as caught:
        _read(Source(path="c.xlsx", file=path, index=SHAKEN), path)
    assert caught.value.problems[1].message == "1 piece left out (no NominalHeight): Bookcase A (1)."


def test_a_row_without_a_workbook_is_assumed_with_its_range():
    row = IndexRow(building="Town office", use="office", storeys=2, floor_area_m2=1000.0, ground_pga_g=0.3)
    origin, inventory = _read(Source(path="Town office", kind="assumed", index=row))
    assert origin.inventory == "assumed"
    assert origin.low is not None
    assert origin.high is not None
    assert {one.item for one in inventory.items} == set(origin.low) == set(origin.high)
    assert inventory.building.building == "Town office"
    assert inventory.problems[0].message.startswith("inventory assumed: no piece of this building has been seen.")


def test_a_use_without_quantities_is_refused():
    row = IndexRow(building="School", use="School", storeys=2, floor_area_m2=1000.0, ground_pga_g=0.3)
    with pytest.raises(InputError, match="FEMA P-58 gives quantities of furniture for office, healthcare"):
        _read(Source(path="School", kind="assumed", index=row))
