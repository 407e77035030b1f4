"""Workbooks as people fill them in: habits that are understood, mistakes that are named once, rows that are no entries."""

from pathlib import Path
from typing import Any

import openpyxl
import pytest

import assess
from assess.errors import Problem, WorkbookError
from assess.i18n import fill
from assess.model import Inventory
from assess.report.content import Content
from assess.results import Results
from assess.workbook.habits import count_kinds, group_problems
from assess.workbook.read import read_inventory
from tests.cli.calling import run
from tests.workbook.books import FLOORS, ITEMS, Sheet, errors_of, read, remarks, write
from tests.workbooks import UNVERIFIED

HEADER = [
    "Item", "Floor", "Room", "Type", "Quantity", "Breadth [cm]", "Width [cm]", "Height [cm]", "Anchored", "Weight [kg]",
    "Centre of gravity [%]", "X [m]", "Y [m]",
]  # fmt: skip


def piece(name: str, floor: Any = "0", **cells: Any) -> list[Any]:
    """Return a sound row of furniture but for the cells given, by the first word of their labels."""
    sound = {"Item": name, "Floor": floor, "Breadth": 45, "Width": 90, "Height": 180, "Anchored": "no"}
    return [(sound | cells).get(label.split(" ")[0]) for label in HEADER]


def hospital(folder: Path) -> Path:
    """Write a hospital's workbook with every habit of a facility manager."""
    rows: list[list[Any]] = [["St Mary's hospital, furniture as of May"], [], HEADER, ["WARD 1 - ground floor"]]
    rows += [piece(f"W1-{at}", "0 ", Breadth="45 cm", Height="1.80 m", Anchored="N") for at in range(30)]
    rows += [[], [None, None, "Pharmacy"]]
    rows += [piece(f"P-{at}", "0\u00a0", Breadth="40,5", Width="90", Anchored="n") for at in range(10)]
    rows += [piece(f"P-B{at}", 1, Quantity="12", Weight="12 kg", Anchored="Y") for at in range(5)]
    rows += [HEADER, ["WARD 2", *[None] * 12]]
    rows += [piece(f"W2-{at}", "L\u20132", Type="Infusion stand", Height="1800 mm", Anchored="sì") for at in range(8)]
    rows += [piece("W2-x", "l-2", Type="Gurney", X="\u22121,5", Y="3,25 m", Centre="45 %", Anchored="U")]
    floors: Sheet = [
        ["Floor", "Elevation [m]", "PFA X [g]", "PFA Y [g]", "Plan image"],
        ["0", "0,0", "15 %", "0,15", None], [1, "4,0 m", "20 %g", " 0.2", None], ["L-2", 8, 0.25, "2,5 m/s2", None],
    ]  # fmt: skip
    building: Sheet = [["Building", "St Mary's"], ["Report date", "31/12/2026"], ["Piece uncertainty", "y"]]
    path = write(folder, rows, floors, Building=building, Catalogue=[["Type", "Breadth [cm]"], ["Wardrobe", 50]])
    book = openpyxl.load_workbook(path)
    page = book["Items"]
    page.merge_cells("A1:M1")
    ward = next(row[0].row for row in page.iter_rows() if row[0].value == "WARD 2")
    page.merge_cells(f"A{ward}:M{ward}")
    for row in (6, 9, 10, 11):
        page.row_dimensions[row].hidden = True
    book.save(path)
    return path


def test_a_hospital_typed_with_every_habit_is_read_with_notes_and_no_error(tmp_path: Path) -> None:
    inventory = read_inventory(hospital(tmp_path))
    assert len(inventory.items) == 54
    by_name = {one.item: one for one in inventory.items}
    first, last = by_name["W1-0"], by_name["W2-x"]
    assert (first.floor, first.breadth, first.height, first.anchored) == ("0", 0.45, 1.8, "no")
    assert (by_name["P-0"].breadth, by_name["P-B0"].quantity, by_name["P-B0"].weight) == (0.405, 12, 12)
    assert (last.floor, last.x, last.y, last.centre_of_gravity, last.anchored) == ("L-2", -1.5, 3.25, 0.45, "unknown")
    assert inventory.floors[0].pfa["X"] == pytest.approx(0.15 * 9.80665)
    assert inventory.building.report_date == "2026-12-31"
    assert inventory.errors == ()
    shown = group_problems(inventory.problems)
    assert {str(one) for one in shown if one.severity == "warning"} == {
        "Items!D54: Type 'Infusion stand' is not in the Catalogue sheet; the sizes typed in its row are used. The same "
        "in 8 cells (D54, D55, D56, ...). Choose one of the Catalogue sheet, or add it there.",
        "Items!D62: Type 'Gurney' is not in the Catalogue sheet; the sizes typed in its row are used. Choose one of "
        "the Catalogue sheet, or add it there.",
    }
    assert {
        "Items!F5: Breadth [cm]: 30 cells hold their unit, such as '45 cm', which is read as 45 cm (F5, F6, F7, ...).",
        "Items!A4: 2 rows hold a text alone, such as 'WARD 1 - ground floor'; they are taken for headings and skipped "
        "(A4 'WARD 1 - ground floor', A53 'WARD 2').",
        "Items!C36: 'Pharmacy' stands alone in its row; it is taken for a heading and skipped.",
        "Items!A52: the row repeats the headers; it is skipped.",
        "Items!A6: 4 hidden rows are assessed as well: 6, 9 to 11.",
    } <= {str(one) for one in shown if one.severity == "note"}
    assert len(shown) < 30 < len(inventory.problems)
    results: Results = assess.run(inventory, UNVERIFIED)
    for rows, count in ((results.problem_rows, 30), (Content(results).problems, 1)):  # data keep each cell
        assert len([one for one in rows if one.group == "breadth: unit"]) == count


def test_mistakes_of_one_habit_are_one_message_and_problems_that_differ_stay_apart(tmp_path: Path) -> None:
    """Names that differ are different mistakes."""
    rows = [
        HEADER,
        *(piece(f"m{at}", "7" if at < 5 else "8", Height="1,800", Breadth=f"{at} stone") for at in range(9)),
    ]
    path = write(tmp_path, rows, [["Floor", "PFA X [g]"], ["0", 0.3]])
    done = run("check", path)
    assert done.exit_code == 2
    assert done.stderr.splitlines() == [
        "error    Items!F2: Breadth is the text '0 stone', expected a number [cm]. The same in 9 cells (F2 '0 stone', "
        "F3 '1 stone', F4 '2 stone', ...). Type the number alone.",
        "error    Items!H2: Height is the text '1,800', which can be read as 1.8 cm or as 1800 cm. The same in 9 cells ("
        "H2, H3, H4, ...). Type the number without a separator between thousands.",
        "error    Items!B2: Floor '7' is not in the Floors sheet. The same in 5 cells (B2, B3, B4, ...). "
        "Choose one of the Floors sheet, or add it there.",
        "error    Items!B7: Floor '8' is not in the Floors sheet. The same in 4 cells (B7, B8, B9, ...). "
        "Choose one of the Floors sheet, or add it there.",
        "4 kinds of error in 27 places; nothing was written.",
    ]
    assert len(errors_of(path)) == 27, "the data keep one problem a cell"

    def problem(cell: str, text: str = "{label} is odd.", group: str = "height", sheet: str = "Items") -> Problem:
        return Problem("error", sheet, cell, fill(text, label="Height"), "", group)

    alike = [problem("H2"), problem("H9")]
    others = [problem("G2"), problem("H3", "{label} is even."), problem("H4", group=""), problem("H5", sheet="Floors")]
    shown = group_problems([alike[0], *others, alike[1]])
    assert [one.cell for one in shown] == ["H2", "G2", "H3", "H4", "H5"]
    assert shown[0].message == "Height is odd. The same in 2 cells (H2, H9)."
    assert count_kinds([*alike, *others]) == (5, 6)
    assert group_problems([]) == []


def read_merged(folder: Path, merged: str, items: Sheet, floors: Sheet = FLOORS, sheet: str = "Items") -> Inventory:
    path = write(folder, items, floors)
    book = openpyxl.load_workbook(path)
    book[sheet].merge_cells(merged)
    book.save(path)
    return read_inventory(path)


def test_merged_cells_are_fine_in_headings_and_blank_rows_and_an_error_in_entries_and_headers(tmp_path: Path) -> None:
    items = [ITEMS[0], ["Ground floor"], ITEMS[1], [None, "Upper floor"], [], ["A2", "1", 40, 180]]
    for merged in ("A2:D2", "A4:D5", "B4:C4"):
        assert [one.row for one in read_merged(tmp_path, merged, items).items] == [3, 6]
    items = [ITEMS[0], ITEMS[1], ["A2", "1", 40, 180], ["Upper floor"], ["A3", "1", 40, 180]]
    for merged in ("A2:A3", "C1:D1", "B2:B4", "C3:D3", "D2:D4"):
        with pytest.raises(WorkbookError, match=f"Items!{merged}: cells are merged inside the table") as caught:
            read_merged(tmp_path, merged, items)
        errors = [one.cell for one in caught.value.problems if one.severity == "error"]
        assert errors == [merged, *(["A1"] if merged == "C1:D1" else [])]  # a header that is gone


def test_rows_that_may_be_entries_are_no_headings_unless_merged(tmp_path: Path) -> None:
    floors = [*FLOORS, ["Upper floors"], ["2", 0.5]]
    assert errors_of(write(tmp_path, floors=floors))
    assert [one.floor for one in read_merged(tmp_path, "A3:B3", ITEMS, floors, "Floors").floors] == ["1", "2"]
    for row in ([None, None, 40], ["12"], ["A2", "1"], [None, None, None, None, "see above"], ["#REF!"]):
        assert errors_of(write(tmp_path, [[*ITEMS[0], "Notes"], [*ITEMS[1], None], row])), row


def test_hidden_columns_and_sheets_are_noted_and_an_earlier_label_is_read(tmp_path: Path) -> None:
    path = write(
        tmp_path, [[*ITEMS[0], "Friction", "Axis"], [*ITEMS[1], 0.4, None]], Places=[["Place", "Floor"], ["P", "1"]]
    )
    book = openpyxl.load_workbook(path)
    for letter in "EF":
        book["Items"].column_dimensions[letter].hidden = True
    book["Floors"].row_dimensions[2].hidden = True
    book["Places"].sheet_state = "hidden"
    book.save(path)
    assert remarks(read_inventory(path), "note") == {
        "Items!E1: the hidden column Friction is read as well.", "Floors!A2: hidden row 2 is read as well.",
        "Places: the sheet is hidden; it is read as well.",
    }  # fmt: skip
    for label in ("Plan image", "plan  IMAGE", "Immagine della pianta"):
        assert errors_of(write(tmp_path, floors=[["Floor", "PFA X [g]", label], ["1", 0.5, "none.png"]])) == {
            "Floors!C2: the file 'none.png' was not found next to the workbook. Check the name, or copy the file there."
        }
    assert errors_of(write(tmp_path, floors=[["Floor", "PFA X [g]", "Plan", "Plan image"], ["1", 0.5]])) == {
        "Floors!D1: duplicate column Plan, also in C1. Delete one of them."
    }


def test_an_unknown_type_is_a_warning_beside_typed_sizes_and_else_an_error(
    tmp_path: Path,
) -> None:
    types: Sheet = [["Type", "Height [cm]"], ["Locker", 180]]
    header = [*ITEMS[0], "Type"]
    inventory = read(tmp_path, [header, ["A1", "1", 40, 180, "Lokcer"]], Catalogue=types)
    assert (inventory.items[0].type, inventory.items[0].height, inventory.errors) == ("Lokcer", 1.8, ())
    assert remarks(inventory, "warning") == {
        "Items!E2: Type 'Lokcer' is not in the Catalogue sheet; the sizes typed in its row are used. "
        "Choose one of the Catalogue sheet, or add it there. Did you mean Locker?"
    }
    without = read(tmp_path, [header, ["A1", "1", 40, 180, "Bed"], ["A2", "1", 40, 180, "Cot"]])
    assert remarks(without, "warning") == {
        "Items!E2: Type 'Bed' and others are named in 2 rows, but there is no Catalogue sheet; the sizes typed in those "
        "rows are used. Add the sheet, or clear the column."
    }
    # The width is missing where the piece may block a route.
    header = ["Item", "Floor", "Breadth [cm]", "Height [cm]", "Type", "X [m]", "Y [m]", "Edge distance [m]"]
    rows = [
        ["A1", "1", 40, None, "Bed"],
        ["A2", "1", 40, 180, "Bed", 1.0, 1],
        ["A3", "1", 40, 180, "Bed", None, 1, 0.5],
    ]
    found = errors_of(write(tmp_path, [header, *rows], Catalogue=types))
    for row in (2, 3, 4):
        assert any(f"E{row}: Type 'Bed' is not in the Catalogue sheet. Choose" in one for one in found)
