import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from openpyxl import load_workbook

from assess.bim import cobie
from assess.bim.cobie import read_cobie
from assess.bim.import_workbook import ImportedBuilding, build_workbook
from assess.errors import WorkbookError
from assess.workbook.read import is_cobie, read_inventory
from tests.bim.cobie_files import COMPONENTS, FLOORS, TYPES, make_sheets, one_type, write_cobie
from tests.motion.writers import zipped
from tests.workbook.books import write_book, write_shared
from tests.workbooks import parts_of, write as write_inventory

SHAKEN = {"ground_pga": 0.3}


def _read(folder: Path, **rows: Any) -> ImportedBuilding:
    path = write_cobie(folder / "handover.xlsx", **rows)
    return read_cobie(path, path.name)


def _skipped(found: ImportedBuilding) -> list[tuple[str, int, str, bool]]:
    return [(one.type, one.count, str(one.reason), one.is_furniture) for one in found.skipped]


@pytest.mark.parametrize("moveable", ["Moveable", "Movable", "MOVEABLE", " moveable "])
def test_moveable_components_become_pieces_with_room_floor_and_identifier(tmp_path: Path, moveable: str) -> None:
    found = _read(tmp_path, types=({**TYPES[0], "AssetType": moveable}, *TYPES[1:]))
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


def test_units_and_numbers_stored_as_texts_and_a_unit_of_impossible_sizes(tmp_path: Path) -> None:
    for unit, size, cm in (
        ("millimeters", 2000, 200), ("Millimetres", "2000.0", 200), ("mm", 2000, 200), ("centimeters", 200, 200),
        ("Meters", 2, 200), ("metre", "2.0", 200), ("feet", 6, 182.88), ("Inches", 81, 205.74),
        ("millimeters", "914.400", 91.44),  # of a program: a point, never thousands
        ("millimeters", "2e3", 200),
    ):  # fmt: skip
        sizes = dict.fromkeys(("NominalLength", "NominalWidth", "NominalHeight"), size)
        found = _read(tmp_path, facility={"LinearUnits": unit}, **one_type(**sizes))
        assert found.items[0]["height"] == found.items[0]["breadth"] == cm, (unit, size)
    for unit, scale, message in (
        ("feet", 1.0, r"LinearUnits is 'feet', but all sizes of furniture are out of range in that unit: "
                      r"NominalLength of 'Bookcase A' would be 900 ft\. Check LinearUnits: in mm most of them are"),
        ("millimeters", 0.001, r"would be 0\.9 mm\. Check LinearUnits: in m, ft most of them are in range"),
    ):  # fmt: skip
        scaled = {"NominalLength": 900 * scale, "NominalWidth": 303 * scale, "NominalHeight": 2000 * scale}
        with pytest.raises(WorkbookError, match=message) as caught:
            _read(tmp_path, facility={"LinearUnits": unit}, **one_type(**scaled))
        assert caught.value.problems[0].place == "Facility!G2", (unit, scale)


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
def test_a_type_that_cannot_be_taken_is_named(tmp_path: Path, values: dict[str, Any], reason: str) -> None:
    found = _read(tmp_path, **one_type(**values))
    ((kind, number, why, is_furniture),) = _skipped(found)
    assert (kind, number, is_furniture) == ("Bookcase A", 1, True)
    assert why.startswith(reason)
    assert (found.items, found.is_complete) == ([], False)


def test_components_that_lead_nowhere_are_reported_and_those_of_one_name_told_apart(tmp_path: Path) -> None:
    for change, kind, reason in (
        ({"TypeName": "Bookcase Z"}, "Bookcase Z", "not in the sheet Type"),
        ({"TypeName": None}, "-", "TypeName is blank"),
        ({"Space": "n/a"}, "Bookcase A", "Space is blank, so that the floor is not known"),
        ({"Space": "X99"}, "Bookcase A", "its Space is not in the sheet Space"),
    ):
        found = _read(tmp_path, components=({**COMPONENTS[0], **change}, COMPONENTS[1]))
        ((own, number, why, is_furniture),) = _skipped(found)
        assert (own, number, is_furniture) == (kind, 1, True), (change, kind)
        assert why.startswith(reason), (change, kind)
        assert len(found.items) == 1, (change, kind)
    components = tuple({**COMPONENTS[0], "ExtIdentifier": f"id{at}"} for at in range(3))
    other = {**COMPONENTS[1], "TypeName": "BOOKCASE  a", "Space": "g01"}
    found = _read(tmp_path, components=(*components, other))
    names = ["Bookcase A:1", "Bookcase A:1 (2)", "Bookcase A:1 (3)", "Bookcase A:2"]
    assert [one["item"] for one in found.items] == names
    assert [one["source_id"] for one in found.items[:3]] == ["id0", "id1", "id2"]
    assert {(one["type"], one["room"]) for one in found.items} == {("Bookcase A", "G01")}


def test_elevations_from_another_datum_are_kept_and_warned_of_and_wrong_ones_stay_blank(tmp_path: Path) -> None:
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
    for elevation, count in (("n/a", 1), ("high", 2), (10**9, 2)):
        found = _read(tmp_path, floors=(FLOORS[0], {**FLOORS[1], "Elevation": elevation}))
        assert [row.get("elevation") for row in found.floors if row["floor"] == "Upper"] == [None], (elevation, count)
        assert found.warnings[-1] == "No Elevation is given of: Upper.", (elevation, count)
        assert len(found.warnings) == count, (elevation, count)


Sheets = dict[str, list[list[Any]]]


def _error(path: Path) -> str:
    with pytest.raises(WorkbookError) as caught:
        read_cobie(path, path.name)
    (problem,) = caught.value.problems
    return str(problem)


def _template_rows(sheets: Sheets) -> Sheets:
    marks = ["required", "lookup", "n/a"]
    return {name: [rows[0], rows[0], [marks[at % 3] for at in range(len(rows[0]))], *rows[1:]] if name != "Instruction"
            else rows for name, rows in sheets.items()}  # fmt: skip


AS_WRITTEN: list[Callable[[Sheets], Sheets]] = [
    _template_rows,
    lambda sheets: {name.upper(): [[str(one).lower() for one in rows[0]], *rows[1:]] for name, rows in sheets.items()},
    lambda sheets: {name: [["Primary key", "", "yellow: required"], [], *rows] for name, rows in sheets.items()},
    lambda sheets: {name: [row[::-1] for row in rows] for name, rows in reversed(sheets.items())},
]


@pytest.mark.parametrize("change", AS_WRITTEN, ids=["of the template", "lower case", "a coloured row", "another order"])
def test_sheets_as_programs_write_them(tmp_path: Path, change: Callable[[Sheets], Sheets]) -> None:
    path = write_shared(tmp_path / "c.xlsx", change(make_sheets()))
    found = read_cobie(path, path.name)
    assert [(one["item"], one["floor"], one["height"]) for one in found.items] == [
        ("Bookcase A:1", "Ground", 200.0), ("Bookcase A:2", "Upper", 200.0),
    ]  # fmt: skip
    assert found.building["building"] == "East wing"


def test_files_that_lack_something_or_are_too_large_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write_inventory(tmp_path / "w.xlsx")
    assert _error(path) == "w.xlsx is an inventory workbook already, not a COBie file. Check it with `assess check`."
    sheets = make_sheets()
    head, *types = sheets["Type"]
    for changed, message in (
        ({name: rows for name, rows in sheets.items() if name not in ("Type", "Space")},
         "c.xlsx is no COBie file: it has no sheet named Space, Type. Export it"),
        (sheets | {"Type": [[one if one != "NominalHeight" else "Size" for one in head], *types]},
         "Type: the header row lacks NominalHeight. Name the columns as COBie 2.4 does"),
        (sheets | {"Space": [["a"], ["b"]]}, "Space: the sheet has no header row with Name, FloorName."),
    ):  # fmt: skip
        assert _error(write_book(tmp_path / "c.xlsx", changed)).startswith(message), message
    blank = "Facility!G2: LinearUnits is blank, so that no size can be read."
    for unit, fault in (
        (None, blank), ("n/a", blank), ("cubits", "Facility!G2: LinearUnits is 'cubits', which is not read."),
    ):  # fmt: skip
        path = write_cobie(tmp_path / "c.xlsx", facility={"LinearUnits": unit})
        expected = f"{fault} Write the unit of NominalHeight: millimeters, centimeters, meters, inches or feet."
        assert _error(path) == expected
    path = write_cobie(tmp_path / "c.xlsx")
    with zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/worksheets/sheet99.xml", b"<a/>" * 2**20)
    text = _error(path)
    assert "zip bomb" in text
    assert "Delete the sheets Attribute, Document and Coordinate in a copy of it, and import that." in text
    monkeypatch.setattr(cobie, "MAX_ROWS", 50)
    rows = [{**COMPONENTS[0], "Name": f"B{at}"} for at in range(60)]
    path = write_cobie(tmp_path / "c.xlsx", components=rows)
    assert _error(path) == "Component!A51: the sheet has more than 50 rows. Split the file by floors."


@pytest.mark.slow
def test_a_million_rows_are_refused_in_bounded_memory(tmp_path: Path) -> None:
    import subprocess
    import sys

    path = write_cobie(tmp_path / "c.xlsx")
    row = '<row r="{0}"><c r="A{0}" t="inlineStr"><is><t>B</t></is></c></row>'
    parts, part = parts_of(path), f"xl/worksheets/sheet{list(make_sheets()).index('Component') + 1}.xml"
    head, tail = re.split(r"(?<=</row>).*(?=</sheetData>)", parts[part].decode(), maxsplit=1, flags=re.DOTALL)
    rows = "".join(row.format(at) for at in range(2, 1_000_000))
    path.write_bytes(zipped(parts | {part: f"{head}{rows}{tail}".encode()}))
    code = (
        "import resource, sys\nresource.setrlimit(resource.RLIMIT_AS, (2**31, 2**31))\n"
        "from pathlib import Path\nfrom assess.bim.cobie import read_cobie\nfrom assess.errors import WorkbookError\n"
        "try:\n    read_cobie(Path(sys.argv[1]), 'c.xlsx')\nexcept WorkbookError as error:\n    print(error)"
    )
    done = subprocess.run([sys.executable, "-c", code, str(path)], capture_output=True, text=True, check=False)
    assert "Component!A100001: the sheet has more than 100,000 rows." in done.stdout or "zip bomb" in done.stdout, done


def test_names_stay_text(tmp_path: Path) -> None:
    hostile = (
        '=HYPERLINK("http://x.example","y")', "+1+1", "@SUM(A1)", "<script>alert(1)</script>", "../../etc/passwd",
        "a\u202eb\u0007c", "x" * 20_000, "{name} {0} %s", "'; DROP TABLE", "\U0001f4da",
    )  # fmt: skip
    types = [one_type(Name=name)["types"][0] for name in hostile]
    components = [{**COMPONENTS[0], "Name": name, "TypeName": name, "Space": name} for name in hostile]
    spaces = [{"Name": name, "FloorName": "Ground"} for name in hostile]
    sheets = make_sheets(types=types, components=components, spaces=spaces)
    path = write_shared(tmp_path / "c.xlsx", sheets, strings_to_formulas=False, strings_to_urls=False)
    (tmp_path / "w.xlsx").write_bytes(build_workbook(read_cobie(path, "c.xlsx")))
    items = read_inventory(tmp_path / "w.xlsx", building={"ground_pga": 0.3}).items
    clean = [name.replace("\u202e", "").replace("\u0007", "\ufffd")[:120] for name in hostile]
    assert [(one.item, one.room, one.type) for one in items] == [(name, name, name) for name in clean]
    cells = [cell for row in load_workbook(tmp_path / "w.xlsx")["Items"].iter_rows() for cell in row]
    assert not [cell.value for cell in cells if cell.data_type == "f" and "HYPERLINK" in str(cell.value)]


def test_what_is_taken_of_several_spaces_odd_sizes_other_spellings_thin_pieces_and_known_types(tmp_path: Path) -> None:
    found = _read(tmp_path, components=({**COMPONENTS[0], "Space": "Site, U01, G01"},))
    assert found.items[0]["floor"] == "Upper"
    assert "1 piece names several spaces; the first that is known was taken." in found.remarks
    found = _read(tmp_path, **one_type(NominalLength=30_000, NominalWidth=1, NominalHeight=0.001))
    assert [one.type for one in found.skipped] == ["Bookcase A"]
    for typed in ("Movable", "MOVEABLE", " moveable "):
        assert len(_read(tmp_path, **one_type(AssetType=typed)).items) == 1
    found = _read(tmp_path, **one_type(NominalWidth=60))
    assert any("Thinner than 10 cm" in text and "Bookcase A" in text for text in found.remarks)
    types = ({**TYPES[0], "Name": "Sideboard"},)
    path = write_cobie(tmp_path / "c.xlsx", types=types, components=({**COMPONENTS[0], "TypeName": "Sideboard"},))
    inventory = read_inventory(build_workbook(read_cobie(path, "COBie.xlsx")), building=SHAKEN)
    (kind,) = (one for one in inventory.catalogue if one.type == "Sideboard")
    assert kind.breadth == pytest.approx(0.303)
    assert kind.source == "COBie file COBie.xlsx, sheet Type: nominal sizes"


def test_a_file_without_furniture_gives_its_floors_and_a_cobie_file_is_known_by_its_sheets(tmp_path: Path) -> None:
    sheets = make_sheets(types=(), components=())
    sheets["Facility"].append(sheets["Facility"][1])
    path = write_book(tmp_path / "c.xlsx", sheets)
    found = read_cobie(path, path.name)
    assert (len(found.floors), found.items, found.is_complete) == (2, [], False)
    assert found.remarks[0] == "The sheet Facility has 2 rows; the first was taken."
    cobie = write_cobie(tmp_path / "c.xlsx")
    inventory = write_inventory(tmp_path / "w.xlsx")
    (tmp_path / "t.xlsx").write_bytes(b"PK\x03\x04 not a zip")
    assert is_cobie(cobie)
    assert is_cobie(cobie.read_bytes())
    assert not is_cobie(inventory)
    assert not is_cobie(inventory.read_bytes())
    assert not is_cobie(tmp_path / "t.xlsx")
    assert not is_cobie(tmp_path / "missing.xlsx")
    assert not is_cobie(b"")
