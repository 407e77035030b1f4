"""Where the pieces of a building come from: its workbook, a COBie file, or quantities by use and floor area."""

from dataclasses import replace

import pytest

from assess.bim.cobie import read_cobie
from assess.bim.import_workbook import build_workbook
from assess.errors import InputError, WorkbookError
from assess.portfolio.building_inventory import Quantity, _is_near, build_assumed, read_building, spread_pieces
from assess.portfolio.sources import IndexRow, Source
from assess.workbook.read import read_inventory
from tests.bim.cobie_files import one_type, write_cobie
from tests.refusals import check_refusals
from tests.workbooks import write_sheets

SHAKEN = IndexRow(path="c.xlsx", ground_pga_g=0.3)


def _read(source, file=None):
    return read_building(source, None if file is None else file.read_bytes(), None)


def test_a_cobie_file_is_handed_over_as_its_imported_workbook_and_says_what_was_left_out(tmp_path):
    """A building of a city can be assessed alone: import it, and run the workbook."""
    path = write_cobie(tmp_path / "c.xlsx")
    origin, inventory = _read(Source(path="c.xlsx", file=path, index=SHAKEN), path)
    assert origin.inventory == "handover"
    assert [one.item for one in inventory.items] == ["Bookcase A:1", "Bookcase A:2"]
    messages = [one.message for one in inventory.problems]
    assert "1 component left out (AssetType is Fixed): Door B (1)." in messages
    assert origin.left_out == 0, "a door is no furniture"
    alone = read_inventory(build_workbook(read_cobie(path, "c.xlsx")), building={"ground_pga": 0.3})
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


def test_an_index_that_contradicts_its_workbook_is_told_in_one_warning_and_one_that_says_the_same_in_none(tmp_path):
    row = {"building": "Library", "latitude": 38, "longitude": -121, "use": "Shop", "storeys": 4, "height_m": 14}
    (warning,) = _warn(tmp_path, **row)
    assert warning.message == (
        "the index says Building Library, Latitude 38, Longitude -121, Use Shop, Storeys 4, Height 14; the workbook "
        "says Town hall, 37.77509, -122.41, School, 3, 10: the workbook holds."
    )
    assert warning.fix == "Check that the line of the index belongs to this workbook."
    assert warning.sheet == "Building"
    for other in ({}, SAME, {"floor_area_m2": 500.0, "ground_pga_g": 0.4}):
        assert _warn(tmp_path, **other) == []
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


OFFICE = IndexRow(
    building="Town office", use="Office", storeys=4, height_m=16.0, floor_area_m2=1000.0, ground_pga_g=0.3
)

INCH = 0.0254


def _count(row: IndexRow) -> dict[str, tuple[int, int, int]]:
    """Return 10 %, 50 % and 90 % quantity of the building by kind of piece."""
    origin, rows, _problems = build_assumed(row)
    assert origin.low is not None and origin.high is not None  # noqa: PT018
    sums: dict[str, list[int]] = {}
    for item in rows["Items"]:
        name = item["item"]
        total = sums.setdefault(name.rpartition(" ")[0], [0, 0, 0])
        for at, number in enumerate((origin.low[name], item["quantity"], origin.high[name])):
            total[at] += number
    return {kind: (one[0], one[1], one[2]) for kind, one in sums.items()}


@pytest.mark.parametrize(
    ("use", "expected"),
    [
        ("Ospedale", {"bookcase": (27, 108, 323), "lateral file": (22, 43, 65)}),
        ("laboratory", {"bookcase": (54, 323, 431), "lateral file": (22, 32, 43)}),
        ("Uffici", {"bookcase": (54, 215, 431), "lateral file": (54, 86, 215)}),
    ],
)
def test_quantities_by_use(use, expected):
    assert _count(replace(OFFICE, use=use, floor_area_m2=10_000.0)) == expected
    assert _count(OFFICE) == {"bookcase": (5, 22, 43), "lateral file": (5, 9, 22)}
    assert _count(replace(OFFICE, floor_area_m2=50.0))["lateral file"] == (0, 1, 1), "many buildings have one"


def test_storeys_keep_the_quantities_of_the_building_and_what_is_left_over_stands_on_the_upper_ones():
    for area in (60.0, 1000.0, 33_333.0):
        whole = _count(replace(OFFICE, storeys=1, floor_area_m2=area))
        for storeys in (2, 7, 60):
            assert _count(replace(OFFICE, storeys=storeys, floor_area_m2=area)) == whole
    assert spread_pieces(Quantity(2, 5, 9), 3) == [Quantity(0, 1, 3), Quantity(1, 2, 3), Quantity(1, 2, 3)]
    assert spread_pieces(Quantity(1, 2, 7), 4) == [
        Quantity(0, 0, 0), Quantity(0, 0, 0), Quantity(0, 1, 3), Quantity(1, 1, 4),
    ]  # fmt: skip


def test_uses_without_quantities_are_refused_with_the_reason():
    for use in ("School", "Home", "apartment", "retail", "Shop", "warehouse", "hospitality", "Library", "xyz"):
        match = f"^no inventory can be assumed for the use '{use}': FEMA P-58 gives quantities of furniture for "
        with pytest.raises(InputError, match=match):
            build_assumed(replace(OFFICE, use=use))


def test_what_is_needed():
    check_refusals(InputError, lambda blank: build_assumed(replace(OFFICE, **blank)), [
        ({"use": ""}, r"^no inventory can be assumed without use\. Give it in the index"),
        ({"storeys": None}, r"^no inventory can be assumed without storeys\. Give it in"),
        ({"floor_area_m2": None, "storeys": None}, r"without storeys, floor_area_m2\."),
        ({"floor_area_m2": 5.0}, "for a floor area of 5 m2: FEMA P-58 gives less than one piece"),
        ({"floor_area_m2": 1e7},
         "10,000,000 m2 on 4 storeys is more than 10,000 pieces of a kind a storey: check both"),
    ])  # fmt: skip


def test_it_is_an_inventory_with_the_sizes_of_p58_and_a_blank_height_is_assumed_and_said():
    _origin, rows, problems = build_assumed(replace(OFFICE, height_m=None))
    assert problems[1].message == "height_m is blank: 4 m a storey assumed, 16 m."
    assert rows["Building"][0]["height"] == 16.0
    _origin, rows, problems = build_assumed(OFFICE)
    assert problems[0].message.startswith(
        "inventory assumed: no piece of this building has been seen. 22 bookcases (5 to 43), 9 lateral files (5 to "
        "22), by its use (office) and its gross floor area (1,000 m2)"
    )
    inventory = read_inventory(rows)
    found = {one.type: one for one in inventory.items}
    bookcase, file = found["Bookcase 6 shelves"], found["Lateral file 4 drawers"]
    assert (bookcase.breadth, bookcase.height) == pytest.approx((12.625 * INCH, 81.25 * INCH), abs=1e-3)
    assert (file.breadth, file.height) == pytest.approx((18.6 * INCH, 52.5 * INCH), abs=1e-3)
    assert (bookcase.width, file.width) == (0.914, None)
    assert [floor.elevation for floor in inventory.floors] == [0.0, 4.0, 8.0, 12.0]
    assert {one.anchored for one in inventory.items} == {"unknown"}
    assert not [one for one in inventory.problems if one.severity == "error"]
