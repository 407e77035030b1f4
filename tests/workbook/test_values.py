"""Cells: what is wrong with a value, what is unusual of it, texts that are cleaned, and formulas."""

import re
from datetime import time
from pathlib import Path
from typing import Any

import pytest

from assess.units import QUANTITIES
from assess.workbook.read import read_inventory
from tests.workbook.books import (
    FLOORS,
    ITEMS,
    Sheet,
    change_parts,
    errors_of,
    read,
    remarks,
    replace,
    write,
    write_shared,
)

SHEET = "xl/worksheets/sheet1.xml"  # Items

CHECK = "Check the number and the unit in the header."
CLEAR = "Clear the cell if it is not known."
MINUS = "Remove the minus sign."
ALONE = "Type the number alone."
LIST = "Choose from the list."
STRUCTURES = "frame, walls, dual, timber, masonry, unknown"
WRONG: dict[str, list[tuple[str, Any, str]]] = {
    "Items": [
        ("Height [cm]", 1.8, "Height is 1.8 cm, expected 5 to 600 cm. Did you mean 1.8 m = 180 cm?"),
        ("Height [cm]", 1800, "Height is 1800 cm, expected 5 to 600 cm. Did you mean 1800 mm = 180 cm?"),
        ("Height [cm]", 0, f"Height is 0 cm, expected 5 to 600 cm. {CLEAR}"),
        ("Height [cm]", 4.99, "Height is 4.99 cm, expected 5 to 600 cm. Did you mean 4.99 ft = 152.1 cm?"),
        ("Height [cm]", 1e30, f"Height is 1e+30 cm, expected 5 to 600 cm. {CHECK}"),
        ("Height [cm]", True, "Height is TRUE, expected a number [cm]. Type the number."),
        ("Height [cm]", time(1, 30), "Height holds a date or time (01:30:00), expected a number [cm]. "
                                     "Set the cell's format to General and type the number again."),
        ("Height [cm]", "1,80", "Height is 1.8 cm, expected 5 to 600 cm. Did you mean 1.8 m = 180 cm?"),
        ("Height [cm]", "1,800", "Height is the text '1,800', which can be read as 1.8 cm or as 1800 cm. "
                                 "Type the number without a separator between thousands."),
        ("Height [cm]", "x" * 100, f"Height is the text '{'x' * 60}…', expected a number [cm]. {ALONE}"),
        ("Height [m]", 180, "Height is 180 m, expected 0.05 to 6 m. Did you mean 180 cm = 1.8 m?"),
        ("Height [in]", 1.8, "Height is 1.8 in, expected 1.969 to 236.2 in. Did you mean 1.8 ft = 21.6 in?"),
        ("Height [ft]", 72, "Height is 72 ft, expected 0.164 to 19.69 ft. Did you mean 72 in = 6 ft?"),
        ("Height [mm]", 6, "Height is 6 mm, expected 50 to 6000 mm. Did you mean 6 ft = 1829 mm?"),
        ("Weight [kg]", -5, "Weight is -5 kg"),
        ("Bracket height [cm]", -10, "Bracket height is -10 cm"),
        ("Bracket height [cm]", 190, "Bracket height 190 cm is greater than Height 180 cm."),
        ("Bracket capacity [kN]", 0, "Bracket capacity is 0 kN"),
        ("Friction", 3, f"Friction is 3, expected 0.01 to 2. {CHECK}"),
        ("Friction", 0, "Friction is 0, expected 0.01 to 2"),
        ("Friction", "smooth", "Friction is the text 'smooth'"),
        ("Centre of gravity [%]", 120, f"Centre of gravity is 120 %, expected 5 to 95 %. {CHECK}"),
        ("Centre of gravity [%]", 0.45, "Centre of gravity is 0.45 %, expected 5 to 95 %. Write 45 for 45 %."),
        ("Centre of gravity [%]", 0.02, f"Centre of gravity is 0.02 %, expected 5 to 95 %. {CHECK}"),
        ("Centre of gravity [%]", -50, f"Centre of gravity is -50 %, expected 5 to 95 %. {MINUS}"),
        ("Angle [deg]", 400, f"Angle is 400 deg, expected -360 to 360 deg. {CHECK}"),
        ("Quantity", "two", f"Quantity is the text 'two', expected a number. {ALONE}"),
        ("Anchored", "partially", "Anchored is 'partially', expected one of: no, yes, partly, unknown. Did you mean"),
        ("Against wall", "north", f"Against wall is 'north', expected one of: yes, no. {LIST}"),
        ("Importance", "#REF!", "Importance holds the error #REF!. Correct the formula in the cell."),
        ("Notes", "#NAME?", "Notes holds the error #NAME?. Correct the formula in the cell."),
    ],
    "Floors": [
        ("PFA X [g]", 35, "PFA X is 35 g, expected 0.0001 to 5 g. Did you mean 35 %g = 0.35 g, or 35 cm/s2 = 0.03569 g?"),
        ("PFA X [g]", 0, f"PFA X is 0 g, expected 0.0001 to 5 g. {CLEAR}"),
        ("PFA X [g]", 9.81, "PFA X is 9.81 g, expected 0.0001 to 5 g. "
                            "Did you mean 9.81 %g = 0.0981 g, or 9.81 m/s2 = 1 g?"),
        ("PFA X [g]", 350, "PFA X is 350 g, expected 0.0001 to 5 g. Did you mean 350 cm/s2 = 0.3569 g?"),
        ("PFA X [m/s2]", 350, "PFA X is 350 m/s2, expected 0.0009807 to 49.03 m/s2. Did you mean 350 cm/s2 = 3.5 m/s2?"),
        ("PFV Y [m/s]", 50, "PFV Y is 50 m/s, expected 0.0001 to 10 m/s. Did you mean 50 cm/s = 0.5 m/s?"),
        ("PFV X [cm/s]", 30, "PFV X is filled in without PFA X"),
        ("Elevation [m]", 5000, "Elevation is 5000 m, expected -200 to 1000 m. "
                                "Did you mean 5000 cm = 50 m, or 5000 mm = 5 m?"),
    ],
    "Building": [
        ("Motion uncertainty", -0.1, f"Motion uncertainty is -0.1, expected 0 to 1.5. {MINUS}"),
        ("Motion uncertainty", 40, "Motion uncertainty is 40, expected 0 to 1.5. Did you mean 0.4?"),
        ("Piece uncertainty", 1, f"Piece uncertainty is '1', expected one of: yes, no. {LIST}"),
        ("Piece uncertainty", "partly", f"Piece uncertainty is 'partly', expected one of: yes, no. {LIST}"),
        ("Ground PGV [cm/s]", 0, f"Ground PGV is 0 cm/s, expected 0.01 to 1000 cm/s. {CLEAR}"),
        ("Ground PGV [m/s]", 25, "Ground PGV is 25 m/s, expected 0.0001 to 10 m/s. Did you mean 25 cm/s = 0.25 m/s?"),
        ("Period T1 [s]", 0, f"Period T1 is 0 s, expected 0.02 to 20 s. {CLEAR}"),
        ("Period T1 [s]", 60, f"Period T1 is 60 s, expected 0.02 to 20 s. {CHECK}"),
        ("Structure", "bamboo", f"Structure is 'bamboo', expected one of: {STRUCTURES}. {LIST}"),
        ("Structure", "frmae", f"Structure is 'frmae', expected one of: {STRUCTURES}. Did you mean frame?"),
        *(("Shaking", typed, f"Shaking is '{typed}', expected one of: MMI IV, light; ")
          for typed in ("VII", "MCS 7", "EMS VII")),
        ("Latitude [deg]", 10, "Latitude is given without Longitude"),
        ("Longitude [deg]", 10, "Longitude is given without Latitude"),
        ("Latitude [deg]", 91, "Latitude is 91 deg"),
    ],
    "Catalogue": [
        ("Weight [kg]", -3, "Weight is -3 kg"),
        ("Centre of gravity [%]", 0.6, "Centre of gravity is 0.6 %, expected 5 to 95 %. Write 60 for 60 %."),
    ],
    "Costs": [
        ("Unit cost", -4, "Unit cost is -4, expected 0 to 900000."),
        ("Unit cost", 1e7, "Unit cost is 1e+07, expected 0 to 900000."),
        ("Unit cost", "40 apples", "Unit cost is the text '40 apples', expected a number."),
    ],
}  # fmt: skip
"""By sheet: a header, a value below it, and how its error begins; more of them stand in test_check."""
CELLS = {"Items": "D2", "Floors": "C2", "Building": "B2", "Catalogue": "D2", "Costs": "B2"}


def write_one(folder: Path, sheet: str, header: str, value: Any) -> Path:
    """Write a sound workbook with one more value, in a sheet's cell of `CELLS`."""
    sheets: dict[str, list[list[Any]]] = {
        "Items": [["Item", "Floor", "Type"], ["A1", "1", "T"]],
        "Floors": [["Floor", "PFA Y [g]"], ["1", 0.5]],
        "Building": [["Use", "Office"]],
        "Catalogue": [["Type", "Breadth [cm]", "Height [cm]"], ["T", 10, 180]],
        "Costs": [["Detail"], ["base angle"]],
    }
    if sheet == "Building":
        sheets[sheet].append([header, value])
    else:
        head, row = sheets[sheet]
        head.append(header)
        row.append(value)
    return write(folder, sheets.pop("Items"), sheets.pop("Floors"), **sheets)


@pytest.mark.parametrize("sheet", WRONG)
def test_a_wrong_value_is_one_error_at_its_cell(tmp_path: Path, sheet: str) -> None:
    for header, value, message in WRONG[sheet]:
        (error,) = errors_of(write_one(tmp_path, sheet, header, value))
        assert error.startswith(f"{sheet}!{CELLS[sheet]}: {message}"), (header, value, error)


def test_unusual_numbers_and_formulas_are_reported_where_they_stand_and_texts_are_cleaned(
    tmp_path: Path,
) -> None:
    unusual = [
        ("Items", "Height [cm]", 350, "Height is 350 cm, usual is 20 to 300 cm."),
        ("Items", "Height [in]", 120, "Height is 120 in, usual is 7.874 to 118.1 in."),
        ("Floors", "PFA X [g]", 2.5, "PFA X is 2.5 g, usual is 0.01 to 2 g."),
        ("Floors", "PFA X [cm/s2]", 0.3, "PFA X is 0.3 cm/s2, usual is 9.807 to 1961 cm/s2."),
    ]
    for sheet, header, value, message in unusual:
        found = remarks(read_inventory(write_one(tmp_path, sheet, header, value)), "warning")
        assert found == {f"{sheet}!{CELLS[sheet]}: {message} Check the number and the unit."}
    path = change_parts(write(tmp_path), {SHEET: replace('<c r="D2" t="n"><v>180</v>', "<c><f>2*90</f>")})
    assert errors_of(path) == {f"Items!D2: {NO_VALUE}"}
    # Written by XlsxWriter, which escapes control characters as Excel does.
    texts = [
        ("bell\x07", "bell\ufffd", 1), ("_x0007_", "\ufffd", 1), ("\u202egnp.exe", "gnp.exe", 1),
        ("a\u200eb\u2066c\u2069", "abc", 3), ("zero\u200b width", "zero width", 1),
        ("two\nlines\tand a tab", "two\nlines\tand a tab", 0), ("carriage\r\nreturn", "carriage\nreturn", 0),
        ("=1+1", "=1+1", 0), ("<b>&amp;</b>", "<b>&amp;</b>", 0), ("家具 ✓ ß", "家具 ✓ ß", 0),
    ]  # fmt: skip
    rows = [[f"A{at}", "1", 40, 180, text] for at, (text, *_) in enumerate(texts)]
    sheets = {"Items": [[*ITEMS[0], "Notes"], *rows], "Floors": FLOORS}
    inventory = read_inventory(write_shared(tmp_path / "book.xlsx", sheets, strings_to_formulas=False))
    assert [one.notes for one in inventory.items] == [clean for _, clean, _ in texts]
    assert remarks(inventory, "warning") == {
        f"Items!E{row}: {removed} control or direction character{' in Notes was' if removed == 1 else 's in Notes were'} "
        "taken out."
        for row, (*_, removed) in enumerate(texts, 2)
        if removed
    }


def test_a_limit_itself_is_allowed_in_every_unit_and_floors_have_names_of_every_kind(tmp_path: Path) -> None:
    for unit in ("mm", "cm", "m", "in", "ft"):
        limits = (5, 20, 300, 600)
        numbers = [limit * 0.01 / QUANTITIES["length"][unit] for limit in limits]
        header = ["Item", "Floor", f"Breadth [{unit}]", f"Height [{unit}]", "Centre of gravity [%]"]
        rows = [[f"A{at}", "1", one, one, 5 if at % 2 else 95] for at, one in enumerate(numbers)]
        found = read(tmp_path, [header, *rows])
        assert [one.height for one in found.items] == pytest.approx([limit / 100 for limit in limits]), unit
    # As they are typed in Items, in Floors, and as they are read.
    names = [(42.0, "42", "42"), ("42", 42, "42"), (" 42 ", "42", "42"), (4.5, 4.5, "4.5"),
             ("E\u0301tage  1", "Étage 1", "Étage 1"), ("b1", "B1", "B1"), ("B\u20131", "B-1", "B-1")]  # fmt: skip
    for typed, defined, name in names:
        inventory = read(tmp_path, [ITEMS[0], ["A1", typed, 40, 180]], [FLOORS[0], [defined, 0.5]])
        assert inventory.items[0].floor == inventory.floors[0].floor == name
    floors = [FLOORS[0], ["Ground", 0.5], ["GROUND ", 0.6]]
    assert errors_of(write(tmp_path, [ITEMS[0], ["A1", "ground", 40, 180], ["A2", "Grond", 40, 180]], floors)) == {
        "Floors!A3: duplicate Floor 'GROUND', also in A2. Give each its own name.",
        "Items!B3: Floor 'Grond' is not in the Floors sheet. "
        "Choose one of the Floors sheet, or add it there. Did you mean Ground?",
    }


SAVED = '<c r="E2" t="str"><f>IF(A2="A1","Y","")</f><v>{}</v></c>'


@pytest.mark.parametrize(("saved", "axis"), [("Y", "Y"), ("", None)])
def test_saved_results_of_formulas_are_read(tmp_path: Path, saved: str, axis: str | None) -> None:
    """As Excel and LibreOffice write them; one that was saved as an empty text is a blank cell."""
    path = write(tmp_path, [[*ITEMS[0], "Axis"], [*ITEMS[1], "here"]])

    def put(data: bytes) -> bytes:
        return re.sub(rb'<c r="E2".*?</c>', SAVED.format(saved).encode(), data)

    inventory = read_inventory(change_parts(path, {SHEET: put}))
    assert (inventory.items[0].axis, inventory.problems) == (axis, ())


UNSAVED = ["<f>1+1</f>", "<f>1+1</f><v/>", "<f>1+1</f><v></v>", '<f t="shared" si="0"/>', "<f/>"]
NO_VALUE = "the formula has no saved value. Open the workbook in Excel and save it."


@pytest.mark.parametrize("prefix", ["", "x:"])
def test_formulas_without_a_saved_result(tmp_path: Path, prefix: str) -> None:
    """Also in a cell that may stay blank, where the catalogue would fill in another size."""

    def rename(data: bytes) -> bytes:
        text = re.sub(r"<(/?)(\w)", rf"<\1{prefix}\2", data.decode())
        return text.replace("xmlns=", "xmlns:x=").encode() if prefix else data

    items: Sheet = [[*ITEMS[0], "Type"], [*ITEMS[1], "T"], ["=A2", "=B2", "=C2", "=D2"]]
    path = write(tmp_path, items, Catalogue=[["Type", "Height [cm]"], ["T", 200]])
    sound = path.read_bytes()
    expected = {f"Items!{cell}: {NO_VALUE}" for cell in ("D2", "A3", "B3", "C3", "D3")}
    for formula in UNSAVED:
        path.write_bytes(sound)
        change_parts(path, {SHEET: replace("<v>180</v>", formula)})
        assert errors_of(change_parts(path, {SHEET: rename})) == expected, formula
