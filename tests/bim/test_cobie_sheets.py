"""COBie files as programs write them, and those that are damaged, of another kind, or made to do harm."""

import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from openpyxl import load_workbook

from assess.bim import cobie_sheets
from assess.bim.cobie import convert, is_cobie, read_cobie
from assess.errors import WorkbookError
from assess.workbook.read import read_inventory
from tests.bim.cobie_files import COMPONENTS, make_sheets, one_type, write_cobie
from tests.workbook.books import write_book, write_shared
from tests.workbooks import write as write_inventory

Sheets = dict[str, list[list[Any]]]


def _error(path: Path) -> str:
    with pytest.raises(WorkbookError) as caught:
        read_cobie(path, path.name)
    (problem,) = caught.value.problems
    return str(problem)


# ---------------------------------------------------------------- as programs write them


def _lower_case(sheets: Sheets) -> Sheets:
    return {name.upper(): [[str(one).lower() for one in rows[0]], *rows[1:]] for name, rows in sheets.items()}


def _coloured_row(sheets: Sheets) -> Sheets:
    return {name: [["Primary key", "", "yellow: required"], [], *rows] for name, rows in sheets.items()}


def _template_rows(sheets: Sheets) -> Sheets:
    marks = ["required", "lookup", "n/a"]
    return {name: [rows[0], rows[0], [marks[at % 3] for at in range(len(rows[0]))], *rows[1:]] if name != "Instruction"
            else rows for name, rows in sheets.items()}  # fmt: skip


def _other_order(sheets: Sheets) -> Sheets:
    return {name: [row[::-1] for row in rows] for name, rows in reversed(sheets.items())}


@pytest.mark.parametrize("change", [_lower_case, _coloured_row, _template_rows, _other_order])
def test_sheets_as_programs_write_them(tmp_path: Path, change: Callable[[Sheets], Sheets]) -> None:
    path = write_shared(tmp_path / "c.xlsx", change(make_sheets()))
    found = read_cobie(path, path.name)
    assert [(one["item"], one["floor"], one["height"]) for one in found.items] == [
        ("Bookcase A:1", "Ground", 200.0), ("Bookcase A:2", "Upper", 200.0),
    ]  # fmt: skip
    assert found.building["building"] == "East wing"


def test_a_cobie_file_is_known_by_its_sheets(tmp_path: Path) -> None:
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


def test_a_cobie_file_in_place_of_an_inventory_is_named(tmp_path: Path) -> None:
    match = "this is a COBie handover file, not an inventory workbook.*`assess import`"
    with pytest.raises(WorkbookError, match=f"(?s){match}") as caught:
        read_inventory(write_cobie(tmp_path / "c.xlsx"))
    assert len(caught.value.problems) == 1


# ---------------------------------------------------------------- of another kind


def test_an_inventory_workbook_is_named_as_one(tmp_path: Path) -> None:
    path = write_inventory(tmp_path / "w.xlsx")
    assert _error(path) == "w.xlsx is an inventory workbook already, not a COBie file. Check it with `assess check`."


def _drop_sheets(sheets: Sheets) -> None:
    del sheets["Type"], sheets["Space"]


def _rename_column(sheets: Sheets) -> None:
    sheets["Type"][0] = [one if one != "NominalHeight" else "Size" for one in sheets["Type"][0]]


def _drop_header(sheets: Sheets) -> None:
    sheets["Space"] = [["a"], ["b"]]


def _drop_facility(sheets: Sheets) -> None:
    del sheets["Facility"][1:]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (_drop_sheets, "c.xlsx is no COBie file: it has no sheet named Space, Type. Export it"),
        (_rename_column, "Type: the header row lacks NominalHeight. Name the columns as COBie 2.4 does"),
        (_drop_header, "Space: the sheet has no header row with Name, FloorName."),
        (_drop_facility, "Facility!G2: LinearUnits is blank"),
    ],
)
def test_what_a_file_lacks_is_named(tmp_path: Path, change: Callable[[Sheets], None], message: str) -> None:
    sheets = make_sheets()
    change(sheets)
    assert _error(write_book(tmp_path / "c.xlsx", sheets)).startswith(message)


def test_a_unit_that_is_not_known_is_an_error(tmp_path: Path) -> None:
    blank = "Facility!G2: LinearUnits is blank, so that no size can be read."
    for unit, fault in (
        (None, blank), ("n/a", blank), ("cubits", "Facility!G2: LinearUnits is 'cubits', which is not read."),
    ):  # fmt: skip
        path = write_cobie(tmp_path / "c.xlsx", facility={"LinearUnits": unit})
        expected = f"{fault} Write the unit of NominalHeight: millimeters, centimeters, meters, inches or feet."
        assert _error(path) == expected


# ---------------------------------------------------------------- damaged, large, hostile


def test_a_file_cut_off(tmp_path: Path) -> None:
    path = write_cobie(tmp_path / "c.xlsx")
    data = path.read_bytes()
    for share in (0.0, 0.3, 0.9, 0.99):
        path.write_bytes(data[: int(share * len(data))])
        assert "c.xlsx is" in _error(path)


def test_rows_without_end_are_an_error_before_they_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cobie_sheets, "MAX_ROWS", 50)
    rows = [{**COMPONENTS[0], "Name": f"B{at}"} for at in range(60)]
    path = write_cobie(tmp_path / "c.xlsx", components=rows)
    assert _error(path) == "Component!A51: the sheet has more than 50 rows. Split the file by floors."


@pytest.mark.slow
def test_a_million_rows_are_refused_in_bounded_memory(tmp_path: Path) -> None:
    """Read in a process of its own, whose memory is limited."""
    import subprocess
    import sys

    path = write_cobie(tmp_path / "c.xlsx")
    row = '<row r="{0}"><c r="A{0}" t="inlineStr"><is><t>B</t></is></c></row>'
    _replace_rows(path, "Component", "".join(row.format(at) for at in range(2, 1_000_000)))
    code = (
        "import resource, sys\nresource.setrlimit(resource.RLIMIT_AS, (2**31, 2**31))\n"
        "from pathlib import Path\nfrom assess.bim.cobie import read_cobie\nfrom assess.errors import WorkbookError\n"
        "try:\n    read_cobie(Path(sys.argv[1]), 'c.xlsx')\nexcept WorkbookError as error:\n    print(error)"
    )
    done = subprocess.run([sys.executable, "-c", code, str(path)], capture_output=True, text=True, check=False)
    assert "Component!A100001: the sheet has more than 100,000 rows." in done.stdout or "zip bomb" in done.stdout, done


def _replace_rows(path: Path, name: str, rows: str) -> None:
    """Put rows as XML in the place of those of a sheet, below its header."""
    at = list(make_sheets()).index(name) + 1
    with zipfile.ZipFile(path) as archive:
        parts = {one: archive.read(one) for one in archive.namelist()}
    part = f"xl/worksheets/sheet{at}.xml"
    text = parts[part].decode()
    head, tail = text[: text.index("</row>") + len("</row>")], text[text.index("</sheetData>") :]
    parts[part] = f"{head}{rows}{tail}".encode()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for one, data in parts.items():
            archive.writestr(one, data)


def test_a_file_too_large_says_which_sheets_to_leave_out(tmp_path: Path) -> None:
    path = write_cobie(tmp_path / "c.xlsx")
    with zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/worksheets/sheet99.xml", b"<a/>" * 2**20)
    text = _error(path)
    assert "zip bomb" in text
    assert "Delete the sheets Attribute, Document and Coordinate in a copy of it, and import that." in text


HOSTILE = (
    '=HYPERLINK("http://x.example","y")', "+1+1", "@SUM(A1)", "<script>alert(1)</script>", "../../etc/passwd",
    "a\u202eb\u0007c", "x" * 20_000, "{name} {0} %s", "'; DROP TABLE", "\U0001f4da",
)  # fmt: skip


def test_names_stay_text(tmp_path: Path) -> None:
    types = [one_type(Name=name)["types"][0] for name in HOSTILE]
    components = [{**COMPONENTS[0], "Name": name, "TypeName": name, "Space": name} for name in HOSTILE]
    spaces = [{"Name": name, "FloorName": "Ground"} for name in HOSTILE]
    sheets = make_sheets(types=types, components=components, spaces=spaces)
    path = write_shared(tmp_path / "c.xlsx", sheets, strings_to_formulas=False, strings_to_urls=False)
    (tmp_path / "w.xlsx").write_bytes(convert(path.read_bytes(), "c.xlsx"))
    items = read_inventory(tmp_path / "w.xlsx", building={"ground_pga": 0.3}).items
    clean = [name.replace("\u202e", "").replace("\u0007", "\ufffd")[:120] for name in HOSTILE]
    assert [(one.item, one.room, one.type) for one in items] == [(name, name, name) for name in clean]
    cells = [cell for row in load_workbook(tmp_path / "w.xlsx")["Items"].iter_rows() for cell in row]
    assert not [cell.value for cell in cells if cell.data_type == "f" and "HYPERLINK" in str(cell.value)]
