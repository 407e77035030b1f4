import pytest

from assess.bim.cobie import convert
from assess.errors import WorkbookError
from assess.portfolio.building_inventory import _is_near, read_building
from assess.portfolio.index_file import IndexRow
from assess.portfolio.sources import Source
from assess.workbook.read import read_inventory
from tests.bim.cobie_files import one_type, write_cobie
from tests.workbooks import write_sheets

SHAKEN = IndexRow(path="c.xlsx", ground_pga_g=0.3)


def _read(source, file=None):
    return read_building(source, None if file is None else file.read_bytes(), None)


def test_a_cobie_file_is_handed_over_and_says_what_was_left_out(tmp_path):
    path = write_cobie(tmp_path / "c.xlsx")
    origin, inventory = _read(Source(path="c.xlsx", file=path, index=SHAKEN), path)
    assert origin.inventory == "handover"
    assert [one.item for one in inventory.items] == ["Bookcase A:1", "Bookcase A:2"]
    messages = [one.message for one in inventory.problems]
    assert "1 component left out (AssetType is Fixed): Door B (1)." in messages
    assert origin.left_out == 0, "a door is no furniture"


def test_a_cobie_file_is_as_its_imported_workbook(tmp_path):
    """A building of a city can be assessed alone: import it, and run the workbook."""
    path = write_cobie(tmp_path / "c.xlsx")
    _, inventory = _read(Source(path="c.xlsx", file=path, index=SHAKEN), path)
    alone = read_inventory(convert(path.read_bytes(), "c.xlsx"), building={"ground_pga": 0.3})
    for name in ("item", "floor", "breadth", "height", "type"):
        assert [getattr(one, name) for one in inventory.items] == [getattr(one, name) for one in alone.items]
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


SURVEYED = {"building": "Town hall", "latitude": 37.77509, "longitude": -122.41, "use": "School", "storeys": 3,
            "height": 10}  # fmt: skip
SAME = {"building": "TOWN  HALL", "latitude": 37.78, "longitude": -122.405, "use": "school", "storeys": 3,
        "height_m": 10.05}  # fmt: skip


def _warn(tmp_path, **index):
    path = tmp_path / "w.xlsx"
    rows = {
        "Building": [{**SURVEYED, "ground_pga": 0.3}],
        "Floors": [{"floor": "1", "elevation": 0}],
        "Items": [{"item": "A1", "floor": "1", "breadth": 30, "height": 200}],
    }
    write_sheets(path, rows)
    origin, inventory = _read(Source(path="w.xlsx", file=path, index=IndexRow(path="w.xlsx", **index)), path)
    assert origin.inventory == "surveyed"
    assert inventory.building.building == "Town hall", "the workbook holds"
    return [one for one in inventory.problems if one.severity == "warning" and "the index says" in one.message]


def test_an_index_that_contradicts_its_workbook_is_told_in_one_warning(tmp_path):
    row = {"building": "Library", "latitude": 38, "longitude": -121, "use": "Shop", "storeys": 4, "height_m": 14}
    (warning,) = _warn(tmp_path, **row)
    assert warning.message == (
        "the index says Building Library, Latitude 38, Longitude -121, Use Shop, Storeys 4, Height 14; the workbook "
        "says Town hall, 37.77509, -122.41, School, 3, 10: the workbook holds."
    )
    assert warning.fix == "Check that the line of the index belongs to this workbook."
    assert warning.sheet == "Building"


def test_an_index_that_says_the_same_or_nothing_is_not_warned_of(tmp_path):
    for row in ({}, SAME, {"floor_area_m2": 500.0, "ground_pga_g": 0.4}):
        assert _warn(tmp_path, **row) == []
    assert _is_near(179.999, -179.999), "on two sides of the date line"
    assert not _is_near(179.9, -179.9)


def test_a_cobie_file_takes_its_name_from_the_index_and_keeps_its_use(tmp_path):
    path = write_cobie(tmp_path / "c.xlsx")
    row = IndexRow(path="c.xlsx", building="Clinic", use="office", height_m=8.0, ground_pga_g=0.3)
    _, inventory = _read(Source(path="c.xlsx", file=path, index=row), path)
    assert (inventory.building.building, inventory.building.use) == ("Clinic", "Hospital")
    (warning,) = (one for one in inventory.problems if "the index says" in one.message)
    assert warning.message == "the index says Use office; the COBie file says Hospital: the COBie file holds."
    assert warning.fix == "Check that the line of the index belongs to this COBie file."
    _, inventory = _read(Source(path="c.xlsx", file=path, index=SHAKEN), path)
    assert inventory.building.building == "East wing"
    assert not any("the index says" in one.message for one in inventory.problems)
