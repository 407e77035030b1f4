from pathlib import Path
from typing import Any

import pytest

from assess.bim.cobie import convert, read_cobie
from assess.bim.import_workbook import ImportedBuilding
from assess.errors import WorkbookError
from assess.workbook.read import read_inventory
from tests.bim.cobie_files import COMPONENTS, FLOORS, TYPES, make_sheets, one_type, write_cobie
from tests.workbook.books import write_book

SHAKEN = {"ground_pga": 0.3}


def _read(folder: Path, **rows: Any) -> ImportedBuilding:
    path = write_cobie(folder / "handover.xlsx", **rows)
    return read_cobie(path, path.name)


def _skipped(found: ImportedBuilding) -> list[tuple[str, int, str, bool]]:
    return [(one.type, one.count, str(one.reason), one.is_furniture) for one in found.skipped]


def test_moveable_components_become_pieces_with_room_floor_and_identifier(tmp_path: Path) -> None:
    found = _read(tmp_path)
    assert found.items == [
        {"item": "Bookcase A:1", "floor": "Ground", "room": "G01", "description": "Bookcase A", "type": "Bookcase A",
         "breadth": 30.3, "width": 90.0, "height": 200.0, "source_id": "3rGjfVfe$JIh3c7s8Nfdyk"},
        {"item": "Bookcase A:2", "floor": "Upper", "room": "U01", "description": "Bookcase A", "type": "Bookcase A",
         "breadth": 30.3, "width": 90.0, "height": 200.0, "source_id": "Bookcase A:2"},
    ]  # fmt: skip
    assert found.building == {"building": "East wing", "address": "1 Main Street", "use": "Hospital", "height": 8.0}
    assert found.floors == [{"floor": "Ground", "elevation": 0.0}, {"floor": "Upper", "elevation": 4.0}]
    assert _skipped(found) == [("Door B", 1, "AssetType is Fixed", False)]
    assert found.is_complete, "what is fixed is no furniture"
    assert any("do not record fixings or positions: fill in Anchored" in one for one in found.remarks)


def test_the_workbook_of_a_conversion_is_an_inventory(tmp_path: Path) -> None:
    path = write_cobie(tmp_path / "handover.xlsx")
    (tmp_path / "building.xlsx").write_bytes(convert(path.read_bytes(), path.name))
    inventory = read_inventory(tmp_path / "building.xlsx", building=SHAKEN)
    assert [one.item for one in inventory.items] == ["Bookcase A:1", "Bookcase A:2"]
    assert [one.breadth for one in inventory.items] == pytest.approx([0.303, 0.303])
    assert [one.height for one in inventory.items] == pytest.approx([2.0, 2.0])
    assert inventory.items[0].more["source_id"] == "3rGjfVfe$JIh3c7s8Nfdyk"
    assert inventory.items[0].anchored == "unknown"


# ---------------------------------------------------------------- units and sizes


@pytest.mark.parametrize(
    ("unit", "size", "cm"),
    [
        ("millimeters", 2000, 200),
        ("Millimetres", "2000.0", 200),
        ("mm", 2000, 200),
        ("centimeters", 200, 200),
        ("Meters", 2, 200),
        ("metre", "2.0", 200),
        ("feet", 6, 182.88),
        ("Inches", 81, 205.74),
        ("millimeters", "914.400", 91.44),  # of a program: a point, never thousands
        ("millimeters", "2e3", 200),
    ],
)
def test_units_and_numbers_stored_as_texts(tmp_path: Path, unit: str, size: Any, cm: float) -> None:
    sizes = dict.fromkeys(("NominalLength", "NominalWidth", "NominalHeight"), size)
    found = _read(tmp_path, facility={"LinearUnits": unit}, **one_type(**sizes))
    assert found.items[0]["height"] == found.items[0]["breadth"] == cm


@pytest.mark.parametrize(
    ("unit", "size", "message"),
    [
        ("feet", 1.0, r"LinearUnits is 'feet', but all sizes of furniture are out of range in that unit: "
                      r"NominalLength of 'Bookcase A' would be 900 ft\. Check LinearUnits: in mm most of them are"),
        ("millimeters", 0.001, r"would be 0\.9 mm\. Check LinearUnits: in m, ft most of them are in range"),
    ],
)  # fmt: skip
def test_a_unit_in_which_no_size_can_be_is_refused_with_its_cell(
    tmp_path: Path, unit: str, size: float, message: str
) -> None:
    sizes = {"NominalLength": 900 * size, "NominalWidth": 303 * size, "NominalHeight": 2000 * size}
    with pytest.raises(WorkbookError, match=message) as caught:
        _read(tmp_path, facility={"LinearUnits": unit}, **one_type(**sizes))
    assert caught.value.problems[0].place == "Facility!G2"


def test_pieces_that_no_unit_makes_furniture_are_left_out_and_the_unit_is_not_doubted(tmp_path: Path) -> None:
    found = _read(tmp_path, **one_type(NominalLength=30_000, NominalWidth=1, NominalHeight=0.001))
    assert [one.type for one in found.skipped] == ["Bookcase A"]


BLANK, ODD = "AssetType is blank, so that it is not known whether they are furniture", "expected 50 to 6000 mm"
LEFT_OUT: list[tuple[dict[str, Any], str]] = [
    *(({"NominalHeight": blank}, "no NominalHeight") for blank in ("n/a", None, "", 0, "0.0", "N/A", "-")),
    ({"NominalLength": "n/a", "NominalWidth": 0, "NominalHeight": None},
     "no NominalLength, NominalWidth, NominalHeight"),
    ({"NominalHeight": -2000}, f"NominalHeight is -2000 mm, {ODD}"),
    ({"NominalHeight": "-2000"}, f"NominalHeight is -2000 mm, {ODD}"),
    ({"NominalHeight": 20}, f"NominalHeight is 20 mm, {ODD}"),
    ({"NominalHeight": 20000000}, f"NominalHeight is 2e+07 mm, {ODD}"),
    ({"NominalHeight": "1e400"}, "NominalHeight is the text '1e400', expected a number"),
    ({"NominalHeight": "nan"}, "NominalHeight is the text 'nan', expected a number"),
    ({"NominalHeight": "tall"}, "NominalHeight is the text 'tall', expected a number"),
    ({"NominalHeight": "#VALUE!"}, "NominalHeight holds the error #VALUE!"),
    ({"NominalHeight": True}, "NominalHeight is TRUE, expected a number"),
    ({"AssetType": "n/a"}, BLANK),
    ({"AssetType": "Loose"}, "AssetType is 'Loose', expected Fixed or Moveable"),
]  # fmt: skip


@pytest.mark.parametrize(("values", "reason"), LEFT_OUT)
def test_a_type_that_cannot_be_taken_is_named_with_its_number_and_the_reason(
    tmp_path: Path, values: dict[str, Any], reason: str
) -> None:
    found = _read(tmp_path, **one_type(**values))
    ((kind, number, why, is_furniture),) = _skipped(found)
    assert (kind, number, is_furniture) == ("Bookcase A", 1, True)
    assert why.startswith(reason)
    assert (found.items, found.is_complete) == ([], False)


def test_spellings_of_moveable(tmp_path: Path) -> None:
    for typed in ("Movable", "MOVEABLE", " moveable "):
        assert len(_read(tmp_path, **one_type(AssetType=typed)).items) == 1


# ---------------------------------------------------------------- components, spaces and floors


@pytest.mark.parametrize(
    ("change", "kind", "reason"),
    [
        ({"TypeName": "Bookcase Z"}, "Bookcase Z", "not in the sheet Type"),
        ({"TypeName": None}, "-", "TypeName is blank"),
        ({"Space": "n/a"}, "Bookcase A", "Space is blank, so that the floor is not known"),
        ({"Space": "X99"}, "Bookcase A", "its Space is not in the sheet Space"),
    ],
)
def test_components_that_lead_nowhere_are_reported(tmp_path: Path, change: Any, kind: str, reason: str) -> None:
    found = _read(tmp_path, components=({**COMPONENTS[0], **change}, COMPONENTS[1]))
    ((own, number, why, is_furniture),) = _skipped(found)
    assert (own, number, is_furniture) == (kind, 1, True)
    assert why.startswith(reason)
    assert len(found.items) == 1


def test_of_several_spaces_the_first_known_is_taken_and_said(tmp_path: Path) -> None:
    found = _read(tmp_path, components=({**COMPONENTS[0], "Space": "Site, U01, G01"},))
    assert found.items[0]["floor"] == "Upper"
    assert "1 piece names several spaces; the first that is known was taken." in found.remarks


def test_elevations_from_another_datum_and_basements_are_kept_and_warned_of(tmp_path: Path) -> None:
    """Counted from the lowest floor, the pieces of upper floors handed over alone would shake as at the ground."""
    floors = tuple({**one, "Elevation": 100_000 + one["Elevation"]} for one in FLOORS)
    found = _read(tmp_path, floors=floors)
    assert [row["elevation"] for row in found.floors] == [100.0, 104.0]
    assert found.building["height"] == 108.0
    (warning,) = found.warnings
    assert warning.startswith("The lowest floor, Ground, is at 100 m in the file. If it lies at the ground, subtract")
    found = _read(tmp_path, floors=({"Name": "Cellar", "Category": "Floor", "Elevation": -3500}, *FLOORS))
    assert [row["elevation"] for row in found.floors] == [-3.5, 0.0, 4.0]
    assert found.warnings[0].startswith(
        "Below the ground by their elevation, so that they shake as the ground does: Cell"
    )


@pytest.mark.parametrize(("elevation", "count"), [("n/a", 1), ("high", 2), (10**9, 2)])
def test_an_elevation_that_is_missing_or_wrong_stays_blank(tmp_path: Path, elevation: Any, count: int) -> None:
    found = _read(tmp_path, floors=(FLOORS[0], {**FLOORS[1], "Elevation": elevation}))
    assert [row.get("elevation") for row in found.floors if row["floor"] == "Upper"] == [None]
    assert found.warnings[-1] == "No Elevation is given of: Upper."
    assert len(found.warnings) == count


def test_thin_pieces_are_named_as_what_may_hang_on_a_wall(tmp_path: Path) -> None:
    found = _read(tmp_path, **one_type(NominalWidth=60))
    assert any("Thinner than 10 cm" in text and "Bookcase A" in text for text in found.remarks)


def test_components_of_one_name_are_told_apart_and_names_compared_without_letter_case(tmp_path: Path) -> None:
    components = tuple({**COMPONENTS[0], "ExtIdentifier": f"id{at}"} for at in range(3))
    other = {**COMPONENTS[1], "TypeName": "BOOKCASE  a", "Space": "g01"}
    found = _read(tmp_path, components=(*components, other))
    names = ["Bookcase A:1", "Bookcase A:1 (2)", "Bookcase A:1 (3)", "Bookcase A:2"]
    assert [one["item"] for one in found.items] == names
    assert [one["source_id"] for one in found.items[:3]] == ["id0", "id1", "id2"]
    assert {(one["type"], one["room"]) for one in found.items} == {("Bookcase A", "G01")}


def test_a_type_named_as_one_of_the_catalogue_takes_its_place(tmp_path: Path) -> None:
    types = ({**TYPES[0], "Name": "Sideboard"},)
    path = write_cobie(tmp_path / "c.xlsx", types=types, components=({**COMPONENTS[0], "TypeName": "Sideboard"},))
    inventory = read_inventory(convert(path.read_bytes()), building=SHAKEN)
    (kind,) = (one for one in inventory.catalogue if one.type == "Sideboard")
    assert kind.breadth == pytest.approx(0.303)
    assert kind.source == "COBie file COBie.xlsx, sheet Type: nominal sizes"


def test_a_file_without_furniture_and_with_several_facilities_gives_its_floors(tmp_path: Path) -> None:
    sheets = make_sheets(types=(), components=())
    sheets["Facility"].append(sheets["Facility"][1])
    path = write_book(tmp_path / "c.xlsx", sheets)
    found = read_cobie(path, path.name)
    assert (len(found.floors), found.items, found.is_complete) == (2, [], False)
    assert found.remarks[0] == "The sheet Facility has 2 rows; the first was taken."
