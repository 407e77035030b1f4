"""The worked city: on land, inside the ShakeMap, the same every time, and without a problem but the missing shaking."""

import csv
import hashlib
import xml.etree.ElementTree as ET
from collections import Counter

import pytest

import assess
from assess import resources
from assess.errors import InputError
from assess.portfolio.background import read_background
from assess.portfolio.example_city import BUILDINGS, COAST, GRID, INDEX, README, list_buildings, write_example_city
from assess.portfolio.sources import COLUMNS
from tests.workbooks import UNVERIFIED


@pytest.fixture(scope="module")
def city():
    return list_buildings(BUILDINGS)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bay") / "city"
    write_example_city(folder, 28)
    return folder


def test_it_has_at_least_200_buildings_of_all_uses_and_a_few_without_a_survey(city):
    assert len(city) == BUILDINGS >= 200
    assert len({one.path or one.name for one in city}) == BUILDINGS
    assert list_buildings(12) == city[:12], "a larger city has the same buildings, and more"
    uses = Counter(one.use for one in city if one.path)
    assert set(uses) == {"Office", "School", "Hospital", "Library", "Home"}
    assert min(uses.values()) >= 10
    unsurveyed = [one for one in city if not one.path]
    assert len(unsurveyed) == 8
    assert {one.use for one in unsurveyed} == {"office", "healthcare"}
    assert min(one.storeys for one in city) == 1
    assert max(one.storeys for one in city) == 12


def test_every_building_stands_on_land_and_inside_the_shakemap(city):
    import shapely

    coast = read_background(resources.city_file(COAST))
    land = shapely.union_all([shapely.Polygon(area[0], area[1:]) for area in coast.areas])
    assert [one.name for one in city if not land.contains(shapely.Point(one.longitude, one.latitude))] == []
    space = "{http://earthquake.usgs.gov/eqcenter/shakemap}"
    edges = ET.parse(resources.city_file(GRID)).getroot().find(f"{space}grid_specification").attrib
    south, north, west, east = (float(edges[name]) for name in ("lat_min", "lat_max", "lon_min", "lon_max"))
    assert all(south < one.latitude < north and west < one.longitude < east for one in city)


def test_the_folder_holds_a_workbook_a_building_the_index_and_real_ground_motion(folder):
    with (folder / INDEX).open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert tuple(rows[0]) == COLUMNS
    assert len(rows) == 28
    assert {row["path"] for row in rows} - {""} == {
        path.relative_to(folder).as_posix() for path in folder.rglob("*.xlsx")
    }
    bare = [row for row in rows if not row["path"]]
    assert len(bare) == 1
    assert bare[0]["use"] in {"office", "healthcare"}
    assert all(bare[0][name] for name in ("latitude", "storeys", "height_m", "floor_area_m2"))
    assert (folder / GRID).read_bytes() == resources.city_file(GRID).read_bytes()
    said = (folder / README).read_text(encoding="utf-8")
    assert "The ground motion is real" in said
    assert "The buildings are made up" in said
    assert "28 buildings" in said
    inventory = assess.read_inventory(sorted(folder.rglob("office-*.xlsx"))[0], building={"ground_pga": 0.2})
    assert 12 <= sum(item.quantity for item in inventory.items) <= 40
    found = assess.run(inventory, UNVERIFIED)
    assert len(found.items) == len(inventory.items)
    assert "made up" in inventory.building.scenario


@pytest.mark.slow
def test_it_is_the_same_to_the_byte(folder, tmp_path):
    write_example_city(tmp_path / "again", 6)
    again = {path.relative_to(tmp_path / "again"): path for path in (tmp_path / "again").rglob("*.xlsx")}
    assert len(again) == 6
    for name, path in again.items():
        first, second = (hashlib.sha256(one.read_bytes()).hexdigest() for one in (path, folder / name))
        assert first == second, name


@pytest.mark.slow
def test_a_city_that_is_there_is_used_and_one_that_was_changed_is_not(tmp_path):
    bay = tmp_path / "bay"
    bay.mkdir()
    assert write_example_city(bay, 3)
    before = {path: path.stat().st_mtime_ns for path in bay.rglob("*")}
    (bay / ".DS_Store").write_bytes(b"of the system")
    assert not write_example_city(bay, 3)
    assert {path: path.stat().st_mtime_ns for path in before} == before
    (bay / COAST).write_bytes(b"{}")
    with pytest.raises(InputError, match="is not empty, and not the worked city as it was written; name a folder"):
        write_example_city(bay, 3)
    (bay / COAST).unlink()
    with pytest.raises(InputError, match="is not empty"):
        write_example_city(bay, 3)
    assert [path.name for path in tmp_path.iterdir()] == ["bay"]
