"""The Hazard file of the sheet Building: found, read, and every fault named by its cell."""

import hashlib
from pathlib import Path
from typing import Any

import pytest

import assess
from assess.errors import WorkbookError
from tests.hazards import write_hazard
from tests.workbooks import write_sheets

SITES = Path(__file__).parents[1] / "data" / "hazard" / "oq-case44-hazard_curve-mean-PGA.csv"
FLOORS = [{"floor": "1", "pfa_x": 0.3}]
ITEMS = [{"item": "a", "floor": "1", "breadth": 40, "width": 90, "height": 180}]


def workbook(folder: Path, **building: Any) -> Path:
    return write_sheets(folder / "w.xlsx", {"Building": [building], "Floors": FLOORS, "Items": ITEMS})


def fault(folder: Path, **building: Any):
    with pytest.raises(WorkbookError) as caught:
        assess.read_inventory(workbook(folder, **building))
    (one,) = caught.value.problems
    return one


def test_it_is_read_its_hash_kept_and_of_many_sites_the_nearest_is_taken(tmp_path):
    data = write_hazard(tmp_path, points=7).read_bytes()
    path = workbook(tmp_path, hazard="hazard.csv")
    inventory = assess.read_inventory(path)
    assert inventory.hazard.pga.size == 7
    assert inventory.files == {"hazard.csv": hashlib.sha256(data).hexdigest()}
    assert inventory == assess.read_inventory(path)
    assert assess.read_inventory(path.read_bytes(), records={"hazard.csv": data}).hazard.pga.size == 7
    (tmp_path / "map.csv").write_bytes(SITES.read_bytes())
    for latitude, is_far in ((0.0, False), (5.0, True)):
        inventory = assess.read_inventory(workbook(tmp_path, hazard="map.csv", latitude=latitude, longitude=0.05))
        assert (inventory.hazard.distance < 10_000) != is_far
        told = [one for one in inventory.problems if one.cell == inventory.building.cell("hazard")]
        assert [(one.severity, "km from the building" in one.message) for one in told] == [("warning", True)] * is_far


def test_a_file_that_cannot_be_used_or_has_many_sites_of_no_known_place_is_an_error_at_its_cell(tmp_path):
    """What else may be wrong in it: tests/test_hazard.py."""
    (tmp_path / "bad.csv").write_text("pga_g,annual_rate\n0.1,0.01\n0.2,475\n", encoding="utf-8")
    for name, words in (
        ("bad.csv", "give rates, not return periods"), ("none.csv", "was not found"), ("../other.csv", "outside"),
    ):  # fmt: skip
        one = fault(tmp_path, hazard=name)
        assert (one.sheet, one.cell[0], bool(one.fix)) == ("Building", "B", True)
        assert words in one.message
        assert name in one.message
    lines = SITES.read_text(encoding="utf-8").splitlines()
    (tmp_path / "map.csv").write_text("\n".join([*lines, "1" + lines[-1]]), encoding="utf-8")
    assert "latitude and longitude are needed" in fault(tmp_path, hazard="map.csv").message
