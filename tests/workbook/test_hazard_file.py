"""The Hazard file of the sheet Building: found, read, and every fault named by its cell."""

import hashlib
from pathlib import Path
from typing import Any

import pytest

import assess
from assess.errors import WorkbookError
from assess.workbook.template import Content, write_workbook
from tests.hazards import write_hazard

SITES = Path(__file__).parents[1] / "data" / "hazard" / "oq-case44-hazard_curve-mean-PGA.csv"
FLOORS = [{"floor": "1", "pfa_x": 0.3}]
ITEMS = [{"item": "a", "floor": "1", "breadth": 40, "width": 90, "height": 180}]


def workbook(folder: Path, **building: Any) -> Path:
    path = folder / "w.xlsx"
    write_workbook(path, Content(rows={"Building": [building], "Floors": FLOORS, "Items": ITEMS}), "si")
    return path


def fault(folder: Path, **building: Any):
    with pytest.raises(WorkbookError) as caught:
        assess.read_inventory(workbook(folder, **building))
    (one,) = caught.value.problems
    return one


def test_it_is_read_and_its_hash_kept(tmp_path):
    data = write_hazard(tmp_path, points=7).read_bytes()
    inventory = assess.read_inventory(workbook(tmp_path, hazard="hazard.csv"))
    assert inventory.hazard.pga.size == 7
    assert inventory.building.hazard == "hazard.csv"
    assert inventory.files == {"hazard.csv": hashlib.sha256(data).hexdigest()}
    assert inventory == assess.read_inventory(tmp_path / "w.xlsx")


def test_it_may_be_handed_over_as_bytes(tmp_path):
    data = write_hazard(tmp_path).read_bytes()
    book = workbook(tmp_path, hazard="hazard.csv").read_bytes()
    assert assess.read_inventory(book, records={"hazard.csv": data}).hazard.pga.size == 20


def test_of_many_sites_the_nearest_is_taken(tmp_path):
    (tmp_path / "map.csv").write_bytes(SITES.read_bytes())
    inventory = assess.read_inventory(workbook(tmp_path, hazard="map.csv", latitude=0.0, longitude=0.05))
    assert inventory.hazard.distance < 10_000
    assert not [one for one in inventory.problems if one.cell == inventory.building.cell("hazard")]


def test_a_far_site_is_warned_of(tmp_path):
    (tmp_path / "map.csv").write_bytes(SITES.read_bytes())
    inventory = assess.read_inventory(workbook(tmp_path, hazard="map.csv", latitude=5.0, longitude=0.05))
    (one,) = [one for one in inventory.problems if one.cell == inventory.building.cell("hazard")]
    assert one.severity == "warning"
    assert "km from the building" in one.message


def write(folder: Path, text: str) -> dict[str, str]:
    (folder / "bad.csv").write_text(text, encoding="utf-8")
    return {"hazard": "bad.csv"}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("pga,rate\n0.1,0.01\n", "pga_g,annual_rate"),
        ("pga_g,annual_rate\n0.1,0.01\n0.2,abc\n", "line 3: annual_rate is 'abc'"),
        ("pga_g,annual_rate\n0.1,0.01\n0.2,475\n", "give rates, not return periods"),
        ("pga_g,annual_rate\n10,0.01\n98,0.001\n", "at most 50, in g"),
        ("pga_g,annual_rate\n0.1,0.01\n", "two or more"),
        ("", "there is no table"),
    ],
)
def test_a_damaged_file_is_an_error_at_its_cell(tmp_path, text, words):
    one = fault(tmp_path, **write(tmp_path, text))
    assert one.sheet == "Building"
    assert one.cell.startswith("B")
    assert words in one.message
    assert "bad.csv" in one.message
    assert one.fix


@pytest.mark.parametrize(("name", "words"), [("none.csv", "was not found"), ("../other.csv", "outside")])
def test_a_file_that_is_not_there_is_an_error(tmp_path, name, words):
    assert words in fault(tmp_path, hazard=name).message


def test_many_sites_need_the_buildings_place(tmp_path):
    lines = SITES.read_text(encoding="utf-8").splitlines()
    (tmp_path / "map.csv").write_text("\n".join([*lines, "1" + lines[-1]]), encoding="utf-8")
    assert "latitude and longitude are needed" in fault(tmp_path, hazard="map.csv").message


@pytest.mark.parametrize(("given", "lacks"), [("latitude", "Longitude"), ("longitude", "Latitude")])
def test_one_of_latitude_and_longitude_alone_is_an_error(tmp_path, given, lacks):
    one = fault(tmp_path, **{given: 10.0})
    assert f"is given without {lacks}" in one.message


@pytest.mark.parametrize(("name", "value"), [("latitude", 91), ("longitude", -181)])
def test_a_place_that_is_not_on_earth_is_one_error(tmp_path, name, value):
    assert fault(tmp_path, **{"latitude": 1, "longitude": 1, name: value}).sheet == "Building"
