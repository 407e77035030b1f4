"""Cells: numbers, texts and choices, what is wrong with them, and formulas."""

import re
from datetime import time
from pathlib import Path
from typing import Any

import pytest

from assess.errors import WorkbookError
from assess.units import QUANTITIES
from assess.workbook.read import read_inventory
from tests.workbook.books import (
    FLOORS,
    ITEMS,
    Sheet,
    change_parts,
    errors_of,
    read,
    read_item,
    remarks,
    replace,
    write,
    write_shared,
)

SHEET = "xl/worksheets/sheet1.xml"  # Items


SIZES = [
    (1.8, "Height is 1.8 cm, expected 5 to 600 cm. Did you mean 1.8 m = 180 cm?"),
    (1800, "Height is 1800 cm, expected 5 to 600 cm. Did you mean 1800 mm = 180 cm?"),
    (0, "Height is 0 cm, expected 5 to 600 cm. Clear the cell if it is not known."),
    (4.99, "Height is 4.99 cm, expected 5 to 600 cm. Did you mean 4.99 ft = 152.1 cm?"),
    (-180, "Height is -180 cm, expected 5 to 600 cm. Remove the minus sign."),
    (1e30, "Height is 1e+30 cm, expected 5 to 600 cm. Check the number and the unit in the header."),
    (True, "Height is TRUE, expected a number [cm]. Type the number."),
    (time(1, 30), "Height holds a date or time (01:30:00), expected a number [cm]. "
                  "Set the cell's format to General and type the number again."),
    ("180 kg", "Height is the text '180 kg', expected a number [cm]. Type the number alone."),
    ("1,80", "Height is 1.8 cm, expected 5 to 600 cm. Did you mean 1.8 m = 180 cm?"),
    ("1,800", "Height is the text '1,800', which can be read as 1.8 cm or as 1800 cm. "
              "Type the number without a separator between thousands."),
    ("#N/A", "Height holds the error #N/A. Correct the formula in the cell, or type the number."),
    ("x" * 100, f"Height is the text '{'x' * 60}…', expected a number [cm]. Type the number alone."),
]  # fmt: skip


@pytest.mark.parametrize(("value", "message"), SIZES, ids=[str(value)[:12] for value, _ in SIZES])
def test_sizes_that_are_wrong(tmp_path: Path, value: Any, message: str) -> None:
    rows: Sheet = [["Item", "Floor", "Breadth [cm]", "Room", "Type", "Quantity", "Axis", "Height [cm]"],
            *[["x"] + [None] * 7] * 0, ["A1", "1", 40, None, None, None, None, value]]  # fmt: skip
    with pytest.raises(WorkbookError, match=re.escape(f"Items!H2: {message}")):
        read(tmp_path, rows)


@pytest.mark.parametrize(
    ("header", "value", "message"),
    [
        ("Height [mm]", 180, None),
        ("Height [m]", 180, "Height is 180 m, expected 0.05 to 6 m. Did you mean 180 cm = 1.8 m?"),
        ("Height [in]", 1.8, "Height is 1.8 in, expected 1.969 to 236.2 in. Did you mean 1.8 ft = 21.6 in?"),
        ("Height [ft]", 72, "Height is 72 ft, expected 0.164 to 19.69 ft. Did you mean 72 in = 6 ft?"),
        ("Height [mm]", 6, "Height is 6 mm, expected 50 to 6000 mm. Did you mean 6 ft = 1829 mm?"),
        ("Friction", 3, "Friction is 3, expected 0.01 to 2. Check the number and the unit in the header."),
        ("Centre of gravity [%]", 5, None),
        ("Centre of gravity [%]", 95, None),
        ("Centre of gravity [%]", 120, "Centre of gravity is 120 %, expected 5 to 95 %. Check the number and the unit"),
        ("Centre of gravity [%]", 4.9, "Centre of gravity is 4.9 %, expected 5 to 95 %. Check the number and the unit"),
        ("Centre of gravity [%]", 0.45, "Centre of gravity is 0.45 %, expected 5 to 95 %. Write 45 for 45 %."),
        ("Centre of gravity [%]", 0.02, "Centre of gravity is 0.02 %, expected 5 to 95 %. Check the number and the"),
        ("Centre of gravity [%]", -50, "Centre of gravity is -50 %, expected 5 to 95 %. Remove the minus sign."),
        ("Centre of gravity [%]", "low", "Centre of gravity is the text 'low', expected a number [%]. Type the number"),
        ("Angle [deg]", 400, "Angle is 400 deg, expected -360 to 360 deg. Check the number and the unit in the "),
        ("Quantity", -1, "Quantity is -1, expected a whole number from 1 to 10000. Type a whole number."),
        ("Quantity", "two", "Quantity is the text 'two', expected a number. Type the number alone."),
        ("Axis", "XY", "Axis is 'XY', expected one of: X, Y. Choose from the list."),
        ("Anchored", "partially", "Anchored is 'partially', expected one of: no, yes, partly, unknown. Did you"),
        ("Importance", "#REF!", "Importance holds the error #REF!. Correct the formula in the cell."),
        ("Notes", "#NAME?", "Notes holds the error #NAME?. Correct the formula in the cell."),
    ],
)  # fmt: skip
def test_cells_that_are_wrong(tmp_path: Path, header: str, value: Any, message: str | None) -> None:
    types: Sheet = [["Type", "Breadth [cm]", "Height [cm]"], ["T", 10, 180]]
    if message is None:
        assert read_item(tmp_path, ["Type", header], ["T", value], Catalogue=types)
        return
    with pytest.raises(WorkbookError, match=re.escape(f"Items!D2: {message}")):
        read_item(tmp_path, ["Type", header], ["T", value], Catalogue=types)


@pytest.mark.parametrize(
    ("header", "value", "message"),
    [
        (
            "PFA X [g]",
            35,
            "PFA X is 35 g, expected 0.0001 to 5 g. Did you mean 35 %g = 0.35 g, or 35 cm/s2 = 0.03569 g?",
        ),
        ("PFA X [g]", 0, "PFA X is 0 g, expected 0.0001 to 5 g. Clear the cell if it is not known."),
        (
            "PFA X [g]",
            9.81,
            "PFA X is 9.81 g, expected 0.0001 to 5 g. Did you mean 9.81 %g = 0.0981 g, or 9.81 m/s2 = 1 g?",
        ),
        ("PFA X [g]", 350, "PFA X is 350 g, expected 0.0001 to 5 g. Did you mean 350 cm/s2 = 0.3569 g?"),
        (
            "PFA X [m/s2]",
            350,
            "PFA X is 350 m/s2, expected 0.0009807 to 49.03 m/s2. Did you mean 350 cm/s2 = 3.5 m/s2?",
        ),
        ("PFV X [m/s]", 50, "PFV X is 50 m/s, expected 0.0001 to 10 m/s. Did you mean 50 cm/s = 0.5 m/s?"),
        (
            "PFV X [cm/s]",
            0,
            "PFV X is 0 cm/s, expected 0.01 to 1000 cm/s. Clear the cell if it is not known.",
        ),
        (
            "Elevation [m]",
            5000,
            "Elevation is 5000 m, expected -200 to 1000 m. Did you mean 5000 cm = 50 m, or 5000 mm = 5 m?",
        ),
    ],
)
def test_floors_that_are_wrong(tmp_path: Path, header: str, value: float, message: str) -> None:
    with pytest.raises(WorkbookError, match=re.escape(f"Floors!C2: {message}")):
        read(tmp_path, floors=[["Floor", "PFA Y [g]", header], ["1", 0.5, value]])


UNUSUAL = [
    ("Items", "Height [cm]", 350, "Items!D2: Height is 350 cm, usual is 20 to 300 cm."),
    ("Items", "Height [in]", 120, "Items!D2: Height is 120 in, usual is 7.874 to 118.1 in."),
    ("Floors", "PFA X [g]", 2.5, "Floors!B2: PFA X is 2.5 g, usual is 0.01 to 2 g."),
    ("Floors", "PFA X [cm/s2]", 0.3, "Floors!B2: PFA X is 0.3 cm/s2, usual is 9.807 to 1961 cm/s2."),
    ("Floors", "PFA X [g]", 0.001, "Floors!B2: PFA X is 0.001 g, usual is 0.01 to 2 g."),
]


@pytest.mark.parametrize(("sheet", "header", "value", "message"), UNUSUAL)
def test_unusual_numbers_are_warned_of(tmp_path: Path, sheet: str, header: str, value: float, message: str) -> None:
    items, floors = [list(row) for row in ITEMS], [list(row) for row in FLOORS]
    rows = items if sheet == "Items" else floors
    rows[0][-1], rows[1][-1] = header, value
    assert remarks(read(tmp_path, items, floors), "warning") == {f"{message} Check the number and the unit."}


@pytest.mark.parametrize("limit", [5, 600, 20, 300])
@pytest.mark.parametrize("unit", ["mm", "cm", "m", "in", "ft"])
def test_a_limit_itself_is_allowed_in_every_unit(tmp_path: Path, limit: float, unit: str) -> None:
    number = limit * 0.01 / QUANTITIES["length"][unit]
    found = read_item(tmp_path, [f"Breadth [{unit}]", f"Height [{unit}]"], [number, number])
    assert found.height == pytest.approx(limit / 100)


@pytest.mark.parametrize("name", [42, 42.0, "42", " 42 ", 4.5, "Étage 1", "E\u0301tage  1", "b1"])
def test_floor_names_of_every_kind(tmp_path: Path, name: Any) -> None:
    names = {42: "42", " 42 ": "42", 4.5: "4.5", "E\u0301tage  1": "Étage 1", "b1": "B1"}
    defined = {"42": "42", "4.5": 4.5, "Étage 1": "Étage 1", "B1": "B1"}
    wanted = names.get(name, name)
    inventory = read(tmp_path, [ITEMS[0], ["A1", name, 40, 180]], [FLOORS[0], [defined[wanted], 0.5]])
    assert inventory.items[0].floor == inventory.floors[0].floor == wanted


def test_names_are_compared_without_letter_case(tmp_path: Path) -> None:
    floors = [FLOORS[0], ["Ground", 0.5], ["GROUND ", 0.6]]
    assert errors_of(write(tmp_path, [ITEMS[0], ["A1", "ground", 40, 180]], floors)) == {
        "Floors!A3: duplicate Floor 'GROUND', also in A2. Give each its own name."
    }


def test_near_name_of_a_floor(tmp_path: Path) -> None:
    path = write(tmp_path, [ITEMS[0], ["A1", "Grond", 40, 180]], [FLOORS[0], ["Ground", 0.5]])
    assert errors_of(path) == {
        "Items!B2: Floor 'Grond' is not in the Floors sheet. "
        "Choose one of the Floors sheet, or add it there. Did you mean Ground?"
    }


def test_choices_in_any_letter_case(tmp_path: Path) -> None:
    found = read_item(
        tmp_path,
        ["Breadth [cm]", "Height [cm]", "Axis", "Anchored", "Importance"],
        [40, 180, "y", "PARTLY", " Life  Safety "],
    )
    assert (found.axis, found.anchored, found.importance) == ("Y", "partly", "life safety")


TEXTS = [
    ("bell\x07", "bell\ufffd", 1),
    ("_x0007_", "\ufffd", 1),
    ("\u202egnp.exe", "gnp.exe", 1),
    ("a\u200eb\u2066c\u2069", "abc", 3),
    ("zero\u200b width", "zero width", 1),
    ("two\nlines\tand a tab", "two\nlines\tand a tab", 0),
    ("carriage\r\nreturn", "carriage\nreturn", 0),
    ("=1+1", None, 0),
    ("<b>&amp;</b>", "<b>&amp;</b>", 0),
    ("家具 ✓ ß", "家具 ✓ ß", 0),
]


@pytest.mark.parametrize(("text", "clean", "removed"), TEXTS, ids=range(len(TEXTS)))
def test_texts_are_cleaned(tmp_path: Path, text: str, clean: str | None, removed: int) -> None:
    """Written by XlsxWriter, which escapes control characters as Excel does."""
    if clean is None:
        clean = text
    path = write_shared(
        tmp_path / "book.xlsx",
        {"Items": [[*ITEMS[0], "Notes"], [*ITEMS[1], text]], "Floors": FLOORS},
        strings_to_formulas=False,
    )
    inventory = read_inventory(path)
    message = f"Items!E2: {removed} control or direction characters in Notes were taken out."
    if removed == 1:
        message = "Items!E2: 1 control or direction character in Notes was taken out."
    assert inventory.items[0].notes == clean
    assert remarks(inventory, "warning") == ({message} if removed else set())


SAVED = '<c r="E2" t="str"><f>IF(A2="A1","Y","")</f><v>{}</v></c>'


@pytest.mark.parametrize(("saved", "axis"), [("Y", "Y"), ("", None)])
def test_saved_results_of_formulas_are_read(tmp_path: Path, saved: str, axis: str | None) -> None:
    """As Excel and LibreOffice write them; one that was saved as an empty text is a blank cell."""
    path = write(tmp_path, [[*ITEMS[0], "Axis"], [*ITEMS[1], "here"]])

    def put(data: bytes) -> bytes:
        return re.sub(rb'<c r="E2".*?</c>', SAVED.format(saved).encode(), data)

    inventory = read_inventory(change_parts(path, {SHEET: put}))
    assert (inventory.items[0].axis, inventory.problems) == (axis, ())


UNSAVED = [
    "<f>1+1</f>",
    "<f>1+1</f><v/>",
    "<f>1+1</f><v></v>",
    '<f t="shared" si="0"/>',
    "<f/>",
]


@pytest.mark.parametrize("formula", UNSAVED)
@pytest.mark.parametrize("prefix", ["", "x:"])
def test_formulas_without_a_saved_result(tmp_path: Path, formula: str, prefix: str) -> None:
    """Also in a cell that may stay blank, where the catalogue would fill in another size."""
    path = write(tmp_path, [[*ITEMS[0], "Type"], [*ITEMS[1], "T"]], Catalogue=[["Type", "Height [cm]"], ["T", 200]])
    change_parts(path, {SHEET: replace("<v>180</v>", formula)})
    if prefix:

        def rename(data: bytes) -> bytes:
            text = re.sub(r"<(/?)(\w)", rf"<\1{prefix}\2", data.decode())
            return text.replace("xmlns=", "xmlns:x=").encode()

        change_parts(path, {SHEET: rename})
    assert errors_of(path) == {"Items!D2: the formula has no saved value. Open the workbook in Excel and save it."}


def test_a_row_of_formulas_without_saved_results(tmp_path: Path) -> None:
    path = write(tmp_path, [*ITEMS, ["=A2", "=B2", "=C2", "=D2"]])
    assert errors_of(path) == {
        f"Items!{letter}3: the formula has no saved value. Open the workbook in Excel and save it." for letter in "ABCD"
    }


def test_a_formula_without_result_or_address_is_reported_where_it_stands(tmp_path: Path) -> None:
    path = change_parts(write(tmp_path), {SHEET: replace('<c r="D2" t="n"><v>180</v>', "<c><f>2*90</f>")})
    assert errors_of(path) == {"Items!D2: the formula has no saved value. Open the workbook in Excel and save it."}
