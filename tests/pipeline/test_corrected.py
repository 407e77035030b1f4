"""The corrected workbook: the cells that were understood, and the results that rest on them."""

import io
import re
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import openpyxl
import pytest

from assess.pipeline.corrected import correct_workbook
from assess.pipeline.live_values import live_values, with_live
from assess.workbook.example import example_content
from assess.workbook.plain_rows import column_letters
from assess.workbook.read import open_workbook, read_inventory
from assess.workbook.schema import LIVE
from assess.workbook.template import write_workbook
from tests.recalculate import libreoffice, needs_libreoffice, stored_cells
from tests.workbook.books import change_parts
from tests.workbook.test_patch import changed_parts
from tests.workbooks import address, edited

BREADTH, WIDTH, HEIGHT = (address(field, 2) for field in ("breadth", "width", "height"))
SECOND, ANCHORED, WRONG = address("height", 3), address("anchored", 4), address("breadth", 5)
PFA = address("pfa_x", 2, "Floors")
HABITS: dict[str, dict[str, Any]] = {
    "Items": {BREADTH: "30 cm", WIDTH: " 80", HEIGHT: "200cm", SECOND: "2 m", ANCHORED: "N", WRONG: "0,6"},
    "Floors": {PFA: "0,3"},
}


@cache
def uncorrected() -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        write_workbook(Path(folder) / "book.xlsx", with_live(example_content()))
        return (Path(folder) / "book.xlsx").read_bytes()


def example(path: Path, changes: dict[str, dict[str, Any]]) -> Path:
    path.write_bytes(edited(uncorrected(), changes))
    return path


def list_formulas(data: bytes, sheet: str) -> list[str]:
    marks = open_workbook(data, "book.xlsx").sheet(sheet).marks
    return [f"{column_letters(at)}{row}" for row, at in sorted(marks.formulas)]


@pytest.mark.slow
def test_the_corrections_are_in_the_workbook_and_nothing_else_is_nor_left_to_correct(tmp_path: Path) -> None:
    path = example(tmp_path / "book.xlsx", HABITS)
    done = correct_workbook(path)
    typed = {sheet: set(cells) - {WRONG} for sheet, cells in HABITS.items()}
    assert {sheet: {one.cell for one in done.changed if one.sheet == sheet} for sheet in typed} == typed
    (tmp_path / "out.xlsx").write_bytes(done.inventory.data or b"")
    found, before = stored_cells(tmp_path / "out.xlsx"), stored_cells(path)
    assert [found["Items", cell] for cell in (BREADTH, WIDTH, HEIGHT, SECOND, ANCHORED)] == [30, 80, 200, 200, "no"]
    assert found["Floors", PFA] == 0.3
    formulas = {(sheet, cell) for sheet in ("Items", "Lists") for cell in list_formulas(path.read_bytes(), sheet)}
    same = {key for key in before if found.get(key) == before[key]} | formulas
    assert {*before, *found} - same == {(one.sheet, one.cell) for one in done.changed}
    sheets = openpyxl.load_workbook(path).sheetnames
    numbers = {f"xl/worksheets/sheet{1 + sheets.index(name)}.xml" for name in ("Items", "Floors", "Lists")}
    assert changed_parts(path.read_bytes(), done.inventory.data or b"") == numbers
    again = correct_workbook(tmp_path / "out.xlsx")
    assert (again.changed, again.kept) == ((), ())
    assert again.inventory.data == done.inventory.data
    assert again.inventory.items == done.inventory.items
    assert again.inventory.sha256 == done.inventory.sha256


@pytest.mark.slow
def test_the_live_columns_store_what_they_show(tmp_path: Path) -> None:
    done = correct_workbook(example(tmp_path / "book.xlsx", {**HABITS, "Items": {BREADTH: "30 cm", HEIGHT: "2 m"}}))
    page = openpyxl.load_workbook(io.BytesIO(done.inventory.data or b""), data_only=True)["Items"]
    places = {cell.value: cell.column for cell in page[1]}
    expected = live_values(done.inventory)
    found = [[page.cell(item.row, places[head]).value for head in LIVE[:5]] for item in done.inventory.items]
    assert found == [row[:5] for row in expected]
    assert page.cell(2, places["B/H"]).value == 0.15
    assert page.cell(2, places["Class (formula)"]).value in expected[0]
    assert page.cell(2, places["Height used [cm]"]).value is None, "computed by every program on opening"


@needs_libreoffice
@pytest.mark.libreoffice
@pytest.mark.slow
def test_libreoffice_recalculates_what_rests_on_corrected_cells(tmp_path: Path) -> None:
    """It keeps stored results as they are: those that a correction changes must be new, or missing."""
    done = correct_workbook(example(tmp_path / "book.xlsx", HABITS))
    assert done.inventory.errors, "a row that cannot be used"
    (tmp_path / "out.xlsx").write_bytes(done.inventory.data or b"")
    shown = stored_cells(libreoffice(tmp_path / "out.xlsx", tmp_path / "shown.xlsx", recalculates=False))
    recalculated = stored_cells(libreoffice(tmp_path / "out.xlsx", tmp_path / "new.xlsx"))
    formulas = [("Items", cell) for cell in list_formulas(done.inventory.data or b"", "Items")]
    assert {cell: shown.get(cell) for cell in formulas} == {
        cell: pytest.approx(value, rel=1e-9) if isinstance(value := recalculated.get(cell), float) else value
        for cell in formulas
    }
    head = next(cell for (sheet, cell), value in shown.items() if (sheet, value) == ("Items", "B/H"))
    assert shown["Items", head.replace("1", "2")] == pytest.approx(0.15), "30 cm by 2 m"


@pytest.mark.slow
def test_a_formula_stays_a_formula(tmp_path: Path) -> None:
    path = example(tmp_path / "book.xlsx", {"Items": {BREADTH: 30}})
    sheet = f"xl/worksheets/sheet{1 + openpyxl.load_workbook(path).sheetnames.index('Items')}.xml"
    place = BREADTH.encode()
    cell = b'<c r="%b" t="str"><f>"30 "&amp;"cm"</f><v>30 cm</v></c>' % place
    change_parts(path, {sheet: lambda data: re.sub(rb'<c r="%b".*?</c>' % place, cell, data, count=1)})
    done = correct_workbook(path)
    assert ([one.cell for one in done.kept], done.changed) == ([BREADTH], ())
    assert done.inventory.data == path.read_bytes()


@pytest.mark.slow
def test_an_italian_workbook(tmp_path: Path) -> None:
    from assess.i18n import load_catalogue, speaking

    path = tmp_path / "edificio.xlsx"
    with speaking(load_catalogue("it")):
        write_workbook(path, with_live(example_content()))
    (sheet,) = (name for english, name in read_inventory(path).sheets.items() if english == "Items")
    path.write_bytes(edited(path.read_bytes(), {sheet: {BREADTH: "30 cm"}}))
    done = correct_workbook(path)
    assert [one.value for one in done.changed] == [30]
    with speaking(load_catalogue("it")):
        expected = live_values(done.inventory)[0]
    page = openpyxl.load_workbook(io.BytesIO(done.inventory.data or b""), data_only=True)[sheet]
    row = [cell.value for cell in page[2]]
    assert set(expected) <= set(row)
