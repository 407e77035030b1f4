"""The corrected workbook: the cells that were understood, and the results that rest on them."""

import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import openpyxl
import pytest

from assess.pipeline.corrected import Corrected, correct_workbook
from assess.pipeline.live_values import with_live
from assess.workbook.example import example_content
from assess.workbook.held import list_formulas
from assess.workbook.patch import patch_workbook
from assess.workbook.template import write_workbook
from tests.recalculate import libreoffice, needs_libreoffice, stored_cells
from tests.workbook.test_patch import changed_parts
from tests.workbooks import address

BREADTH, WIDTH, HEIGHT = (address(field, 2) for field in ("breadth", "width", "height"))
SECOND, ANCHORED, WRONG = address("height", 3), address("anchored", 4), address("breadth", 5)
PFA = address("pfa_x", 2, "Floors")
HABITS: dict[str, dict[str, Any]] = {
    "Items": {BREADTH: "30 cm", WIDTH: " 80", HEIGHT: "200cm", SECOND: "2 m", ANCHORED: "N", WRONG: "0,6"},
    "Floors": {PFA: "0,3"},
}


@cache
def uncorrected() -> bytes:
    """Return the example of `assess new`."""
    with tempfile.TemporaryDirectory() as folder:
        write_workbook(Path(folder) / "book.xlsx", with_live(example_content()))
        return (Path(folder) / "book.xlsx").read_bytes()


def example(path: Path, changes: dict[str, dict[str, Any]]) -> Path:
    """The example of `assess new` with some cells as people type them."""
    path.write_bytes(patch_workbook(uncorrected(), changes).data)
    return path


def stored(done: Corrected, path: Path) -> dict[tuple[str, str], Any]:
    path.write_bytes(done.inventory.data or b"")
    return stored_cells(path)


@pytest.mark.slow
def test_the_corrections_are_in_the_workbook_and_nothing_else_is(tmp_path: Path) -> None:
    path = example(tmp_path / "book.xlsx", HABITS)
    done = correct_workbook(path)
    typed = {sheet: set(cells) - {WRONG} for sheet, cells in HABITS.items()}
    assert {sheet: {one.cell for one in done.changed if one.sheet == sheet} for sheet in typed} == typed
    found, before = stored(done, tmp_path / "out.xlsx"), stored_cells(path)
    assert [found["Items", cell] for cell in (BREADTH, WIDTH, HEIGHT, SECOND, ANCHORED)] == [30, 80, 200, 200, "no"]
    assert found["Floors", PFA] == 0.3
    formulas = {(sheet, cell) for sheet in ("Items", "Lists") for cell in list_formulas(path.read_bytes(), sheet)}
    same = {key for key in before if found.get(key) == before[key]} | formulas
    assert {*before, *found} - same == {(one.sheet, one.cell) for one in done.changed}
    sheets = openpyxl.load_workbook(path).sheetnames
    numbers = {f"xl/worksheets/sheet{1 + sheets.index(name)}.xml" for name in ("Items", "Floors", "Lists")}
    assert changed_parts(path.read_bytes(), done.inventory.data or b"") == numbers


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
