"""The ground motion of a building: a ShakeMap that the workbook names, one of the run, and blanks from an index."""

import shutil

import pytest

import assess
from assess.errors import WorkbookError
from assess.motion.shakemap import read_shakemap
from assess.units import GRAVITY
from tests.motion.grids import BAY, EPICENTRE
from tests.workbooks import write

FLOORS = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 6}]
PLACE = {"latitude": 37.7893, "longitude": -122.4008}


def _write(folder, **building):
    shutil.copy(BAY, folder / "grid.xml")
    return write(folder / "w.xlsx", floors=FLOORS, **building)


def _notes(inventory):
    return [(one.place, one.message) for one in inventory.problems if one.severity == "note"]


def test_a_shakemap_beside_the_workbook_gives_the_ground_motion_or_is_told_at_its_cell(tmp_path):
    inventory = assess.read_inventory(_write(tmp_path, shakemap="grid.xml", **PLACE))
    assert inventory.errors == ()
    assert inventory.site_ground.pga == pytest.approx(0.1525 * GRAVITY, rel=1e-3)
    assert inventory.building.shakemap == "grid.xml"
    assert inventory.files == {"grid.xml": inventory.site_ground.sha256}
    for known in ({"ground_pga": 0.3}, {"sds": 0.7}):  # they come before it
        assert assess.read_inventory(_write(tmp_path, shakemap="grid.xml", **PLACE, **known)).site_ground is None
    files = {path.name: path.read_bytes() for path in EPICENTRE.parent.iterdir()}
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
    path = write(tmp_path / "w.xlsx", floors=FLOORS, shakemap="grid.xml", latitude=37.04, longitude=-121.88)
    for inventory in (assess.read_inventory(path), assess.read_inventory(path.read_bytes(), records=files)):
        assert sorted(inventory.files) == ["grid.xml", "uncertainty.xml"]
        assert inventory.site_ground.shared == pytest.approx(0.182, abs=1e-3)
    blank = r"Latitude, Longitude are blank; .* grid\.xml needs .* Fill in .*\(cells B3, B4\)"
    for building, match in (
        ({}, blank),
        ({"latitude": 10, "longitude": 10}, r"grid\.xml: latitude 10\.0000, .* is outside the map"),
        (PLACE | {"shakemap": "map.xml"}, r"the file 'map\.xml' was not found next to the workbook"),
        (PLACE | {"shakemap": "../grid.xml"}, "outside the workbook's folder"),
        (PLACE | {"shakemap": "w.xlsx"}, r"the ShakeMap cannot be used: w\.xlsx: the file is not XML"),
    ):
        with pytest.raises(WorkbookError, match=match) as caught:
            assess.read_inventory(_write(tmp_path, **{"shakemap": "grid.xml"} | building))
        assert [one.place for one in caught.value.problems if one.severity == "error"] == ["Building!B24"]


def test_a_ground_motion_of_the_run_takes_the_place_of_the_workbooks_own_or_completes_it(tmp_path):
    own = {"ground_pga": 0.5, "ground_pgv": 80, "sds": 1.0, "shaking": "MMI X, extreme", "shakemap": "gone.xml"}
    inventory = assess.read_inventory(_write(tmp_path, **PLACE, **own), ground=read_shakemap(BAY))
    building = inventory.building
    assert (building.ground_pga, building.ground_pgv, building.sds, building.shakemap, building.shaking) == (
        None, None, None, "", "",
    )  # fmt: skip
    assert inventory.site_ground is not None
    assert inventory.site_ground.pga == pytest.approx(0.1525 * GRAVITY, rel=1e-3)
    labels = "Ground PGA, SDS, Ground PGV, ShakeMap file, Shaking are not used: the ground motion of grid.xml takes"
    assert _notes(inventory) == [("Building!B21", f"{labels} their place.")]
    # Where the place of the building is known.
    path, ground = _write(tmp_path, **PLACE), read_shakemap(BAY)
    lacking = "neither Ground PGA nor Ground PGV nor SDS nor a ShakeMap file nor Shaking"
    with pytest.raises(WorkbookError, match=lacking):
        assess.read_inventory(path)
    assert assess.read_inventory(path, ground=ground).errors == ()
    blank = r"Building!B3: Latitude, Longitude are blank; the ground motion of grid\.xml"
    with pytest.raises(WorkbookError, match=blank):
        assess.read_inventory(_write(tmp_path), ground=ground)
    outside = r"Building!B3: no ground motion at the building: grid\.xml: latitude 30"
    with pytest.raises(WorkbookError, match=outside):
        assess.read_inventory(_write(tmp_path, latitude=30, longitude=-120), ground=ground)


def test_values_from_an_index_fill_blanks_only_and_are_checked_as_those_of_the_sheet(tmp_path):
    path = _write(tmp_path, building="Town hall", ground_pga=0.2)
    given = {"building": "Other", "latitude": 37.8, "Longitude [deg]": -122.4, "height": 40, "ground_pga": 9}
    inventory = assess.read_inventory(path, building=given)
    building = inventory.building
    assert (building.building, building.latitude, building.longitude, building.height) == (
        "Town hall", 37.8, -122.4, 40,
    )  # fmt: skip
    assert building.ground_pga == pytest.approx(0.2 * GRAVITY)
    labels = "Latitude, Longitude, Height are blank in the workbook"
    assert _notes(inventory) == [("Building", f"{labels}: the values come from the index.")]
    path = _write(tmp_path, ground_pga=0.2)
    for wrong, match in (
        ({"latitude": 137.8}, "of the index: Latitude is 137.8"),
        ({"height": "tall"}, "of the index: Height is the text 'tall'"),
        ({"storeys": 2.5}, "of the index: Storeys"),
        ({"latitude": 37.8}, "Latitude is given without Longitude"),
    ):
        with pytest.raises(WorkbookError, match=match):
            assess.read_inventory(path, building=wrong)
    rows = {"Items": [{"item": "A", "floor": "1", "breadth": 30, "height": 200}], "Floors": FLOORS}
    found = assess.read_inventory(rows, building={**PLACE, "building": "Shed"}, ground=read_shakemap(BAY))
    assert (found.building.building, found.site_ground is None) == ("Shed", False)
