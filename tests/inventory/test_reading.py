"""What a sound workbook is read as, and what is said of each thing that is not sound."""

import re
from datetime import datetime, time
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import pytest

from assess.errors import WorkbookError
from assess.inventory.axes import axis_of
from assess.inventory.columns import BUILDING, SHEETS
from assess.inventory.model import Item
from assess.inventory.workbook import read_inventory
from assess.units import GRAVITY, QUANTITIES
from tests.inventory.books import (
    FLOORS,
    ITEMS,
    Sheet,
    change_parts,
    errors_of,
    read,
    read_part,
    remarks,
    replace,
    write,
    write_book,
    write_shared,
)
from tests.recalculate import libreoffice, needs_libreoffice

SHEET = "xl/worksheets/sheet1.xml"  # Items
FLOOR_SHEET = "xl/worksheets/sheet2.xml"
PNG = b"\x89PNG\r\n\x1a\n" + bytes(100)


def item(folder: Path, header: list[str], row: list[Any], **others: Sheet) -> Item:
    """Return the one item of a workbook with these columns beside Item and Floor."""
    return read(folder, [["Item", "Floor", *header], ["A1", "1", *row]], **others).items[0]


# ---------------------------------------------------------------- units


@pytest.mark.parametrize(
    ("unit", "number"), [("mm", 400), ("cm", 40), ("m", 0.4), ("in", 40 / 2.54), ("ft", 40 / 30.48)]
)
def test_lengths(tmp_path: Path, unit: str, number: float) -> None:
    found = item(tmp_path, [f"Breadth [{unit}]", f"Height [{unit}]"], [number, 4 * number])
    assert (found.breadth, found.height) == pytest.approx((0.4, 1.6), rel=1e-12)


ACCELERATIONS = [
    ("g", 0.5), ("m/s2", 0.5 * GRAVITY), ("m/s²", 0.5 * GRAVITY), ("m/s^2", 0.5 * GRAVITY), ("cm/s2", 50 * GRAVITY),
    ("cm/s²", 50 * GRAVITY), ("gal", 50 * GRAVITY), ("Gal", 50 * GRAVITY), (" G ", 0.5), ("M / S2", 0.5 * GRAVITY),
]  # fmt: skip


@pytest.mark.parametrize(("unit", "number"), ACCELERATIONS)
def test_accelerations(tmp_path: Path, unit: str, number: float) -> None:
    floor = read(tmp_path, floors=[["Floor", f"PFA X [{unit}]"], ["1", number]]).floors[0]
    assert floor.pfa == {"X": pytest.approx(0.5 * 9.80665, rel=1e-12)}


@pytest.mark.parametrize(("unit", "number"), [("cm/s", 50), ("m/s", 0.5), ("in/s", 50 / 2.54)])
def test_velocities(tmp_path: Path, unit: str, number: float) -> None:
    floor = read(tmp_path, floors=[["Floor", "PFA X [g]", f"PFV Y [{unit}]"], ["1", 0.5, number]]).floors[0]
    assert floor.pfv == {"Y": pytest.approx(0.5, rel=1e-12)}


@pytest.mark.parametrize(
    ("header", "message"),
    [
        ("Height [kg]", "the unit 'kg' of Height is not known. Write Height [cm]; known units: mm, cm, m, in, ft."),
        ("Height []", "the unit '' of Height is not known. Write Height [cm]; known units: mm, cm, m, in, ft."),
        ("Height", "Height has no unit. Write Height [cm]; known units: mm, cm, m, in, ft."),
        ("Height (cm)", "the column 'Height (cm)' is not known. Did you mean Height [cm]?"),
        ("Height cm", "the column 'Height cm' is not known. Did you mean Height [cm]?"),
        ("Heigth [mm]", "the column 'Heigth [mm]' is not known. Did you mean Height [cm]?"),
        ("Angel [deg]", "the column 'Angel [deg]' is not known. Did you mean Angle [deg]?"),
        ("Quantitty", "the column 'Quantitty' is not known. Did you mean Quantity?"),
    ],
)
def test_headers_that_are_wrong(tmp_path: Path, header: str, message: str) -> None:
    path = write(tmp_path, [["Item", "Floor", "Breadth [cm]", "Type", header], ["A1", "1", 40, "T", 180]],
                 Catalogue=[["Type", "Height [cm]"], ["T", 180]])  # fmt: skip
    assert errors_of(path) == {f"Items!E1: {message}"}


def test_a_form_has_lines(tmp_path: Path) -> None:
    building: Sheet = [
        ["Buildng", "Town hall"],
        ["Period T1 [ms]", 900],
        ["Storeys", 4],
        ["storeys ", 5],
        ["Colour", "red"],
    ]
    path = write(tmp_path, Building=building)
    assert errors_of(path) == {
        "Building!A1: the line 'Buildng' is not known. Did you mean Building?",
        "Building!A2: the unit 'ms' of Period T1 is not known. Write Period T1 [s]; known units: s.",
        "Building!A4: the line Storeys is here twice, also in A3. Delete one of them.",
    }


# ---------------------------------------------------------------- tables and headers


def test_columns_in_any_order_and_spelling(tmp_path: Path) -> None:
    items: Sheet = [["  HEIGHT [ CM ]", "fLoOr", "breadth[cm]", None, "It em", "Edge\u00a0 distance [m]"],
             [180, "1", 40, None, "A1", -0.5]]  # fmt: skip
    found = read(tmp_path, items).items[0]
    assert (found.item, found.floor, found.breadth, found.height, found.edge_distance) == ("A1", "1", 0.4, 1.8, -0.5)


@pytest.mark.parametrize("above", [1, 5, 19])
def test_header_below_a_title(tmp_path: Path, above: int) -> None:
    title = [["Furniture of the town hall"], *([[]] * (above - 1))]
    inventory = read(tmp_path, [*title, *ITEMS, [], ["A2", "1", 50, 180]])
    assert [(one.item, one.row) for one in inventory.items] == [("A1", above + 2), ("A2", above + 4)]


def test_header_too_far_down(tmp_path: Path) -> None:
    assert errors_of(write(tmp_path, [*([["note"]] * 20), *ITEMS])) == {
        "Items!A1: no header row was found in the first 20 rows. It needs the columns Item and Floor."
    }


def test_unknown_columns_are_kept(tmp_path: Path) -> None:
    header = [*ITEMS[0], "Photo", "Inventory no.", "Bought"]
    rows: Sheet = [
        ["A1", "1", 40, 180, "a.jpg", 4711.0, datetime(2020, 5, 1)],
        ["A2", "1", 50, 180, None, "x\u202ey", True],
    ]
    inventory = read(tmp_path, [header, *rows])
    assert inventory.extra_columns == ("Photo", "Inventory no.", "Bought")
    assert [one.extra for one in inventory.items] == [("a.jpg", "4711", "2020-05-01T00:00:00"), ("", "xy", "TRUE")]
    assert remarks(inventory, "note") == {
        "Items!E1: the column 'Photo' is not known; it is kept, not used.",
        "Items!F1: the column 'Inventory no.' is not known; it is kept, not used.",
        "Items!G1: the column 'Bought' is not known; it is kept, not used.",
    }


def test_a_row_without_an_entry_is_left_out(tmp_path: Path) -> None:
    inventory = read(tmp_path, [[*ITEMS[0], "Photo"], [*ITEMS[1], None], [None, None, None, " ", "b.jpg"]])
    assert len(inventory.items) == 1
    assert remarks(inventory, "warning") == {"Items!E3: stands in a row without an entry; the row is left out."}


@pytest.mark.parametrize("header", ["Weight [kg]", "Weight", "Colour", "Owner", "Age [years]", "Z [m]", "Depth [cm]"])
def test_headers_that_are_no_slip(tmp_path: Path, header: str) -> None:
    assert read(tmp_path, [[*ITEMS[0], header], [*ITEMS[1], 80]]).extra_columns == (header,)


def test_weight_in_place_of_height(tmp_path: Path) -> None:
    """Where Height itself is missing, Weight in a unit of weight is still no slip, but Weight [cm] is."""
    types: Sheet = [["Type", "Height [cm]"], ["T", 180]]
    header = ["Type", "Breadth [cm]"]
    assert item(tmp_path, [*header, "Weight [kg]"], ["T", 40, 80], Catalogue=types).height == 1.8
    with pytest.raises(WorkbookError, match=re.escape("Items!E1: the column 'Weight [cm]' is not known. Did you mean")):
        item(tmp_path, [*header, "Weight [cm]"], ["T", 40, 80], Catalogue=types)


def test_live_columns_are_ignored(tmp_path: Path) -> None:
    live = ["B/H", "PFA used [g]", "OR", "Kaneko-Hayashi", "Class (formula)"]
    inventory = read(tmp_path, [[*ITEMS[0], *live], [*ITEMS[1], "=C2/D2", "=1", "=1", "=1", "=1"], [*[None] * 4, "=1"]])
    assert (len(inventory.items), inventory.extra_columns, inventory.problems) == (1, (), ())


def test_merged_cells_above_the_table_are_fine(tmp_path: Path) -> None:
    path = write(tmp_path, [["Furniture"], *ITEMS])
    book = openpyxl.load_workbook(path)
    book["Items"].merge_cells("A1:D1")
    book.save(path)
    assert len(read_inventory(path).items) == 1


# ---------------------------------------------------------------- cells

SIZES = [
    (1.8, "Height is 1.8 cm, expected 5 to 600 cm. Did you type metres?"),
    (1800, "Height is 1800 cm, expected 5 to 600 cm. Did you type millimetres?"),
    (0, "Height is 0 cm, expected 5 to 600 cm. Check the number and the unit in the header."),
    (4.99, "Height is 4.99 cm, expected 5 to 600 cm. Did you type feet?"),
    (-180, "Height is -180 cm, expected 5 to 600 cm. Remove the minus sign."),
    (1e30, "Height is 1e+30 cm, expected 5 to 600 cm. Check the number and the unit in the header."),
    (True, "Height is TRUE, expected a number [cm]. Type the number."),
    (time(1, 30), "Height holds a date or time (01:30:00), expected a number [cm]. "
                  "Set the cell's format to General and type the number again."),
    ("180 cm", "Height is the text '180 cm', expected a number [cm]. Type the number alone."),
    ("180", "Height is '180' stored as text, expected a number [cm]. "
            "In Excel: select the column, Data, Text to Columns, Finish."),
    ("1,80", "Height is the text '1,80' with a decimal comma, expected a number [cm]. "
             "Type 1.80 as your Excel writes numbers, without quotes or spaces."),
    ("#N/A", "Height holds the error #N/A. Mend the formula in the cell, or type the number."),
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
        ("Height [m]", 180, "Height is 180 m, expected 0.05 to 6 m. Did you type centimetres?"),
        ("Height [in]", 1.8, "Height is 1.8 in, expected 1.969 to 236.2 in. Did you type metres?"),
        ("Height [ft]", 72, "Height is 72 ft, expected 0.164 to 19.69 ft. Did you type inches?"),
        ("Height [mm]", 6, "Height is 6 mm, expected 50 to 6000 mm. Did you type feet?"),
        ("Friction", 3, "Friction is 3, expected 0.01 to 2. Check the number and the unit in the header."),
        ("Angle [deg]", 400, "Angle is 400 deg, expected -360 to 360 deg. Check the number and the unit in the "),
        ("Quantity", -1, "Quantity is -1, expected a whole number from 1 to 10000. Type a whole number."),
        ("Quantity", "two", "Quantity is the text 'two', expected a number. Type the number alone."),
        ("Axis", "XY", "Axis is 'XY', expected one of: X, Y. Choose from the list."),
        ("Anchored", "partially", "Anchored is 'partially', expected one of: no, yes, partly, unknown. Did you"),
        ("Importance", "#REF!", "Importance holds the error #REF!. Mend the formula in the cell."),
        ("Notes", "#NAME?", "Notes holds the error #NAME?. Mend the formula in the cell."),
    ],
)  # fmt: skip
def test_cells_that_are_wrong(tmp_path: Path, header: str, value: Any, message: str | None) -> None:
    types: Sheet = [["Type", "Breadth [cm]", "Height [cm]"], ["T", 10, 180]]
    if message is None:
        assert item(tmp_path, ["Type", header], ["T", value], Catalogue=types)
        return
    with pytest.raises(WorkbookError, match=re.escape(f"Items!D2: {message}")):
        item(tmp_path, ["Type", header], ["T", value], Catalogue=types)


@pytest.mark.parametrize(
    ("header", "value", "message"),
    [
        ("PFA X [g]", 35, "PFA X is 35 g, expected 0 to 5 g. Did you type cm/s2?"),
        ("PFA X [g]", 9.81, "PFA X is 9.81 g, expected 0 to 5 g. Did you type m/s2?"),
        ("PFA X [g]", 350, "PFA X is 350 g, expected 0 to 5 g. Did you type cm/s2?"),
        ("PFA X [m/s2]", 350, "PFA X is 350 m/s2, expected 0 to 49.03 m/s2. Did you type cm/s2?"),
        ("PFV X [m/s]", 50, "PFV X is 50 m/s, expected 0.0001 to 10 m/s. Did you type cm/s?"),
        (
            "PFV X [cm/s]",
            0,
            "PFV X is 0 cm/s, expected 0.01 to 1000 cm/s. Check the number and the unit in the header.",
        ),
        ("Elevation [m]", 5000, "Elevation is 5000 m, expected -200 to 1000 m. Did you type millimetres?"),
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
    ("Floors", "PFA X [g]", 0, "Floors!B2: PFA X is 0 g, usual is 0.01 to 2 g."),
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
    found = item(tmp_path, [f"Breadth [{unit}]", f"Height [{unit}]"], [number, number])
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
        "Floors!A3: Floor 'GROUND' is here twice, also in A2. Give each its own name."
    }


def test_near_name_of_a_floor(tmp_path: Path) -> None:
    path = write(tmp_path, [ITEMS[0], ["A1", "Grond", 40, 180]], [FLOORS[0], ["Ground", 0.5]])
    assert errors_of(path) == {
        "Items!B2: Floor 'Grond' is not in the Floors sheet. "
        "Choose one of the Floors sheet, or add it there. Did you mean Ground?"
    }


def test_choices_in_any_letter_case(tmp_path: Path) -> None:
    found = item(
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
    assert inventory.items[0].notes == clean
    assert remarks(inventory, "warning") == ({message} if removed else set())


# ---------------------------------------------------------------- formulas


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
    assert errors_of(path) == {"Items!D2: holds a formula with no saved value. Open the workbook in Excel and save it."}


def test_a_row_of_formulas_without_saved_results(tmp_path: Path) -> None:
    path = write(tmp_path, [*ITEMS, ["=A2", "=B2", "=C2", "=D2"]])
    assert errors_of(path) == {
        f"Items!{letter}3: holds a formula with no saved value. Open the workbook in Excel and save it."
        for letter in "ABCD"
    }


def test_formulas_without_results_or_addresses(tmp_path: Path) -> None:
    path = change_parts(write(tmp_path), {SHEET: replace('<c r="D2" t="n"><v>180</v>', "<c><f>2*90</f>")})
    assert errors_of(path) == {
        "xl/worksheets/sheet1.xml is full of formulas with no saved value. Open it in Excel and save it."
    }


# ---------------------------------------------------------------- catalogue and defaults

TYPES: Sheet = [["Type", "Breadth [in]", "Width [in]", "Height [in]", "Source"], ["Locker", 12, 24, 72, "catalogue"]]


def test_blank_sizes_come_from_the_catalogue(tmp_path: Path) -> None:
    found = item(tmp_path, ["Type", "Breadth [cm]", "Height [cm]"], ["locker", None, 200], Catalogue=TYPES)
    assert (found.type, found.breadth, found.width, found.height) == (
        "Locker", 12 * 0.0254, 24 * 0.0254, 2.0,
    )  # fmt: skip
    assert found.assumed == ("breadth", "width", "quantity", "anchored")


def test_no_assumption_where_all_is_given(tmp_path: Path) -> None:
    header = ["Type", "Breadth [cm]", "Width [cm]", "Height [cm]", "Quantity", "Anchored", "Friction", "Axis"]
    found = item(tmp_path, header, ["Locker", 40, 60, 200, 2, "no", 0.4, "X"], Catalogue=TYPES)
    assert (found.assumed, found.friction, found.quantity) == ((), 0.4, 2)


def test_a_type_without_that_size(tmp_path: Path) -> None:
    path = write(tmp_path, [["Item", "Floor", "Type"], ["A1", "1", "Shelf"]],
                 Catalogue=[["Type", "Breadth [cm]"], ["Shelf", 30]])  # fmt: skip
    assert errors_of(path) == {
        "Items!A2: Height is blank and no Type gives it. Fill it in, or choose a Type that has one."
    }


def test_breadth_is_the_shorter_side_with_the_catalogue_too(tmp_path: Path) -> None:
    path = write(tmp_path, [["Item", "Floor", "Type", "Breadth [cm]"], ["A1", "1", "Locker", 70]],
                 Catalogue=[*TYPES, ["Bench", 30, 20, 40, ""]])  # fmt: skip
    assert errors_of(path) == {
        "Items!D2: Breadth 70 cm is greater than Width 60.96 cm. Breadth is the shorter plan side: exchange the two.",
        "Catalogue!B3: Breadth 76.2 cm is greater than Width 50.8 cm. "
        "Breadth is the shorter plan side: exchange the two.",
    }


def test_breadth_equal_to_width_in_other_units(tmp_path: Path) -> None:
    assert item(tmp_path, ["Breadth [in]", "Width [cm]", "Height [cm]"], [40 / 2.54, 40, 180]).width == 0.4


def test_breadth_greater_than_height_is_warned_of(tmp_path: Path) -> None:
    inventory = read(tmp_path, [ITEMS[0], ["A1", "1", 180, 75]])
    assert remarks(inventory, "warning") == {
        "Items!C2: Breadth 180 cm is greater than Height 75 cm. Are the two exchanged?"
    }


ANGLES = [
    (0, "X"), (15, "X"), (15.001, None), (-15, "X"), (45, None), (74.999, None), (75, "Y"), (90, "Y"), (105, "Y"),
    (106, None), (164, None), (165, "X"), (180, "X"), (-90, "Y"), (270, "Y"), (360, "X"), (-345, "X"), (-344, None),
]  # fmt: skip


@pytest.mark.parametrize(("angle", "axis"), ANGLES)
def test_axis_from_the_angle(tmp_path: Path, angle: float, axis: str | None) -> None:
    found = item(tmp_path, ["Breadth [cm]", "Height [cm]", "Angle [deg]"], [40, 180, angle])
    assert found.axis == axis_of(angle) == axis
    assert ("axis" in found.assumed) == (axis is not None)


def test_a_given_axis_comes_before_the_angle(tmp_path: Path) -> None:
    found = item(tmp_path, ["Breadth [cm]", "Height [cm]", "Angle [deg]", "Axis"], [40, 180, 90, "X"])
    assert (found.axis, "axis" in found.assumed) == ("X", False)


def test_friction_of_the_building(tmp_path: Path) -> None:
    items: Sheet = [[*ITEMS[0], "Friction"], [*ITEMS[1], None], ["A2", "1", 40, 180, 0.7]]
    one, other = read(tmp_path, items, Building=[["Default friction", 0.3]]).items
    assert (one.friction, "friction" in one.assumed) == (0.3, True)
    assert (other.friction, "friction" in other.assumed) == (0.7, False)


def test_no_friction(tmp_path: Path) -> None:
    assert read(tmp_path).items[0].friction is None


def test_one_row_a_piece_on_the_plan(tmp_path: Path) -> None:
    path = write(
        tmp_path, [[*ITEMS[0], "Quantity", "X [m]", "Y [m]"], [*ITEMS[1], 2, 1, 3], ["A2", "1", 40, 180, 1, 1, 3]]
    )
    assert errors_of(path) == {
        "Items!E2: Quantity is 2 on a row with a position. Write one row a piece, or clear X and Y."
    }


@pytest.mark.parametrize(("x", "y", "cell"), [(1, None, "F2"), (None, 2, "E2")])
def test_half_a_position(tmp_path: Path, x: float | None, y: float | None, cell: str) -> None:
    inventory = read(tmp_path, [[*ITEMS[0], "X [m]", "Y [m]"], [*ITEMS[1], x, y]])
    message = "a position needs both X and Y. Fill in the other, or clear both."
    assert remarks(inventory, "warning") == {f"Items!{cell}: {message}"}


# ---------------------------------------------------------------- building, places, routes


def test_building(tmp_path: Path) -> None:
    rows: Sheet = [["Building", "Town hall"], ["Storeys", 4], ["Height [ft]", 50], ["Period T1 [s]", 0.9],
            ["Azimuth of X [deg]", 30], ["Scenario kind", "Given"], ["Ground PGA [m/s2]", 3], ["SDS [g]", 1],
            ["Restitution", 0.9], ["Architect", "N. N."], ["Report language", None], [None, "stray"]]  # fmt: skip
    inventory = read(tmp_path, Building=rows)
    found = inventory.building
    assert (found.building, found.storeys, found.period, found.azimuth_deg) == ("Town hall", 4, 0.9, 30)
    assert (found.height, found.ground_pga, found.sds) == pytest.approx((15.24, 3, GRAVITY))
    assert (found.scenario_kind, found.restitution, found.language, found.logo) == ("given", 0.9, "", None)
    assert remarks(inventory, "note") == {
        "Building!A10: 'Architect' is not known; it is not used.",
        "Building!B7: Ground PGA is kept, not used: every floor has its own motion.",
        "Building!B8: SDS is kept, not used: every floor has its own motion.",
        "Building!B9: Restitution is kept, not used: direct integration is not part of this version.",
    }


def test_the_building_may_be_missing(tmp_path: Path) -> None:
    assert read(tmp_path).building.building == ""


PLACES: Sheet = [["Place", "Floor", "X [m]", "Kind"], ["Hall", 1, 2, "Room"], ["Exit", "1", None, None]]
ROUTES: Sheet = [["Route", "Segment", "Floor", "From", "To", "Clear width [cm]", "Occupants"],
                 ["R1", "a", "1", "Hall", "Exit", 120, 40], ["R1", "b", None, None, None, None, None]]  # fmt: skip


def test_places_and_routes(tmp_path: Path) -> None:
    items: Sheet = [[*ITEMS[0], "Route", "Segment"], [*ITEMS[1], "r1", "A"]]
    inventory = read(tmp_path, items, Places=PLACES, Routes=ROUTES)
    assert [(one.place, one.floor, one.x, one.kind) for one in inventory.places] == [
        ("Hall", "1", 2, "room"), ("Exit", "1", None, ""),
    ]  # fmt: skip
    assert [(one.route, one.segment, one.clear_width, one.occupants) for one in inventory.routes] == [
        ("R1", "a", 1.2, 40), ("R1", "b", None, None),
    ]  # fmt: skip
    assert inventory.items[0].route == "R1"
    assert remarks(inventory, "note") == {"Routes: routes are kept and listed; this version does not evaluate them."}


def test_names_of_places_and_routes_that_do_not_fit(tmp_path: Path) -> None:
    items: Sheet = [[*ITEMS[0], "Route", "Segment"], [*ITEMS[1], "R2", None], ["A2", "1", 40, 180, "R1", "c"],
             ["A3", "1", 40, 180, None, "a"]]  # fmt: skip
    path = write(tmp_path, items, Places=[*PLACES, ["hall", "9", None, None]], Routes=[*ROUTES, ["R3", "a", "8"]])
    listed = "Choose one of the {0} sheet, or add it there."
    assert errors_of(path) == {
        f"Items!E2: Route 'R2' is not in the Routes sheet. {listed.format('Routes')}",
        "Items!F3: Route 'R1' has no segment 'c'. Add it to Routes, or clear the cell.",
        "Items!F4: a Segment is named without its Route. Fill in Route.",
        "Places!A4: Place 'hall' is here twice, also in A2. Give each its own name.",
        f"Places!B4: Floor '9' is not in the Floors sheet. {listed.format('Floors')}",
        f"Routes!C4: Floor '8' is not in the Floors sheet. {listed.format('Floors')}",
    }


# ---------------------------------------------------------------- files


def write_record(path: Path, heading: str = "time [s],NS [g]", comments: str = "") -> None:
    times = np.arange(0, 4, 0.01)
    motion = 0.2 * np.sin(6 * times) * np.sin(np.pi * times / 4)
    channels = heading.count(",")
    rows = [f"{t:.2f}," + ",".join([f"{a:.6f}"] * channels) for t, a in zip(times, motion, strict=True)]
    path.write_text(comments + heading + "\n" + "\n".join(rows) + "\n", encoding="utf-8")


def floors_with(record: str, axis: str = "X") -> Sheet:
    return [["Floor", f"Record {axis}"], ["1", record]]


def test_records(tmp_path: Path) -> None:
    (tmp_path / "records").mkdir()
    write_record(tmp_path / "one.csv")
    write_record(tmp_path / "records" / "two.csv", "time [s],NS [g],EW [g]")
    inventory = read(tmp_path, floors=floors_with(r" one.csv ; records\two.csv#ew; records/two.csv # 1;"))
    records = inventory.floors[0].records
    assert list(records) == ["X"]
    assert [one.name for one in records["X"]] == ["one.csv", r"records\two.csv#ew", "records/two.csv # 1"]
    assert [one.record.channel for one in records["X"]] == ["NS", "EW", "NS"]
    assert sorted(inventory.files) == ["one.csv", r"records\two.csv"]
    assert all(re.fullmatch("[0-9a-f]{64}", digest) for digest in inventory.files.values())


BAD_RECORDS = [
    ("two.csv", "two.csv holds 2 channels: NS, Up. Write which, as two.csv#NS."),
    ("two.csv#9", "two.csv has no channel '9'. It holds: NS, Up."),
    ("two.csv#up", "'two.csv#up' is a vertical channel. Name a horizontal one."),
    ("gone.csv", "the file 'gone.csv' is not beside the workbook. Check the name, or copy the file there."),
    ("gone.csv#NS", "the file 'gone.csv' is not beside the workbook."),
    ("#NS", "the file '' is not beside the workbook."),
    ("noise.csv", "the record cannot be read: noise.csv: the content is of no known format"),
    (" ; ", "';' names no file. Name a record, or clear the cell."),
    (".", "the file '.' is not beside the workbook."),
    ("n" * 300 + ".csv", f"the file '{'n' * 60}…' cannot be looked up. Give it a shorter, simpler name."),
]


@pytest.mark.parametrize(("record", "message"), BAD_RECORDS, ids=[record[:12] for record, _ in BAD_RECORDS])
def test_records_that_cannot_be_used(tmp_path: Path, record: str, message: str) -> None:
    write_record(tmp_path / "two.csv", "time [s],NS [g],Up [g]")
    (tmp_path / "noise.csv").write_text("no record", encoding="utf-8")
    (error,) = errors_of(write(tmp_path, floors=floors_with(record)))
    assert error.startswith(f"Floors!B2: {message}")


OUTSIDE = [
    "../roof.csv", r"..\roof.csv", "sub/../../roof.csv", "/etc/passwd", r"\roof.csv", r"C:\roof.csv", "C:roof.csv",
    r"\\server\share\roof.csv", "//server/share/roof.csv", "file:///etc/passwd", "http://example.org/roof.csv",
    "roof.csv:stream", "CON", "nul.csv", "sub/COM1.csv", "roof\u200d.csv", "n" * 600,
]  # fmt: skip


@pytest.mark.parametrize("record", OUTSIDE)
def test_records_outside_the_folder(tmp_path: Path, record: str) -> None:
    with pytest.raises(
        WorkbookError, match=r"lies outside the workbook's folder\. Copy it beside the workbook and write"
    ):
        read(tmp_path, floors=floors_with(record))


def test_links_that_lead_outside(tmp_path: Path) -> None:
    inside = tmp_path / "inside"
    inside.mkdir()
    write_record(tmp_path / "roof.csv")
    (inside / "link.csv").symlink_to(tmp_path / "roof.csv")
    (inside / "circle.csv").symlink_to(inside / "circle.csv")
    with pytest.raises(WorkbookError, match=r"'link.csv' leads outside the workbook's folder\. Copy it"):
        read(inside, floors=floors_with("link.csv"))
    with pytest.raises(WorkbookError, match=r"'circle.csv' (cannot be looked up|is not beside)"):
        read(inside, floors=floors_with("circle.csv"))


@pytest.mark.parametrize(
    ("building", "record", "axis", "off"),
    [(0, 15, "X", None), (0, 16, "X", 16), (0, 196, "X", 16), (0, 180, "X", None), (0, 90, "Y", None),
     (0, 0, "Y", 90), (350, 10, "X", 20), (350, 360, "X", None), (-90, 0, "Y", None), (None, 45, "X", None)],
)  # fmt: skip
def test_direction_of_records(
    tmp_path: Path, building: float | None, record: float, axis: str, off: float | None
) -> None:
    write_record(tmp_path / "one.csv", comments=f"# azimuth: {record}\n")
    inventory = read(tmp_path, floors=floors_with("one.csv", axis), Building=[["Azimuth of X [deg]", building]])
    message = f"Floors!B2: 'one.csv' points to {record:g} deg, {off or 0:.0f} deg off the {axis} axis."
    mend = "Check the axis, or Azimuth of X in Building."
    assert remarks(inventory, "warning") == (set() if off is None else {f"{message} {mend}"})


def test_a_floor_without_motion(tmp_path: Path) -> None:
    floors: Sheet = [["Floor", "Name", "PFA X [g]", "PFV X [cm/s]"], ["1", "Ground", None, 30]]
    assert errors_of(write(tmp_path, floors=floors)) == {
        "Floors!C2: floor '1' has neither a record nor a PFA. Fill in PFA X or PFA Y, or name a record."
    }


def test_floor(tmp_path: Path) -> None:
    (tmp_path / "plan.png").write_bytes(PNG)
    header = ["Floor", "Name", "Elevation [ft]", "PFA X [g]", "PFA Y [gal]", "PFV Y [m/s]", "Plan image"]
    inventory = read(tmp_path, floors=[header, [1, "Ground floor", 10, 0.5, 300, 0.4, "plan.png"]])
    floor = inventory.floors[0]
    assert (floor.row, floor.floor, floor.name) == (2, "1", "Ground floor")
    found = (floor.elevation, floor.pfa["X"], floor.pfa["Y"], floor.pfv["Y"])
    assert found == pytest.approx((3.048, 0.5 * GRAVITY, 3, 0.4))
    assert floor.plan == tmp_path / "plan.png"
    assert remarks(inventory, "note") == {"Floors!G2: Plan image is kept, not drawn by this version."}


@pytest.mark.parametrize("head", [PNG, b"\xff\xd8\xff\xe0" + bytes(100)])
def test_logo(tmp_path: Path, head: bytes) -> None:
    (tmp_path / "logo").write_bytes(head)
    assert read(tmp_path, Building=[["Logo file", "logo"]]).building.logo == tmp_path / "logo"


PICTURES = [
    (b"<svg onload='x'/>", "logo.png", "'logo.png' is no PNG or JPEG picture. Save it as PNG or JPEG."),
    (b"", "logo.png", "'logo.png' is no PNG or JPEG picture. Save it as PNG or JPEG."),
    (PNG + bytes(10 * 2**20), "logo.png", "'logo.png' is larger than 10 MB. Save a smaller picture."),
    (PNG, "other.png", "the file 'other.png' is not beside the workbook. Check the name, or copy the file there."),
    (PNG, "../logo.png", "the file '../logo.png' lies outside the workbook's folder. "
                         "Copy it beside the workbook and write its name alone."),
]  # fmt: skip


@pytest.mark.parametrize(("data", "name", "message"), PICTURES, ids=range(len(PICTURES)))
@pytest.mark.parametrize("sheet", ["Building", "Floors"])
def test_pictures_that_cannot_be_used(tmp_path: Path, data: bytes, name: str, message: str, sheet: str) -> None:
    (tmp_path / "logo.png").write_bytes(data)
    if sheet == "Building":
        path = write(tmp_path, Building=[["Logo file", name]])
        assert errors_of(path) == {f"Building!B1: {message}"}
    else:
        path = write(tmp_path, floors=[["Floor", "PFA X [g]", "Plan image"], ["1", 0.5, name]])
        assert errors_of(path) == {f"Floors!C2: {message}"}


# ---------------------------------------------------------------- files of other programs


def items_of(path: Path) -> list[tuple[str, str, float, float]]:
    return [(one.item, one.floor, one.breadth, one.height) for one in read_inventory(path).items]


@pytest.mark.parametrize("options", [{}, {"constant_memory": True}, {"in_memory": True}])
def test_files_by_xlsxwriter(tmp_path: Path, options: dict[str, bool]) -> None:
    assert items_of(write_shared(tmp_path / "book.xlsx", {"Items": ITEMS, "Floors": FLOORS}, **options)) == [
        ("A1", "1", 0.4, 1.8)
    ]


def without_addresses(data: bytes) -> bytes:
    text = re.sub(r'<c r="[A-Z]+\d+"', "<c", data.decode())
    return re.sub(r'<row r="\d+"[^>]*>', "<row>", re.sub(r"<dimension[^>]*/>", "", text)).encode()


def single_quotes(data: bytes) -> bytes:
    return data.replace(b'"', b"'")


def with_prefix(data: bytes) -> bytes:
    text = re.sub(r"<(/?)(?=[a-z])", r"<\1x:", data.decode())
    return text.replace("xmlns=", "xmlns:x=").encode()


def with_lines(data: bytes) -> bytes:
    return data.replace(b"><", b">\n\t<")


@pytest.mark.parametrize("change", [without_addresses, single_quotes, with_prefix, with_lines])
def test_files_of_other_programs(tmp_path: Path, change: Any) -> None:
    """As WPS, Java and JavaScript libraries write them: no addresses, no dimension, prefixes, line breaks."""
    path = write(tmp_path, [*ITEMS, ["A2", "1", 50, 200]])
    change_parts(path, {SHEET: change, FLOOR_SHEET: change})
    assert items_of(path) == [("A1", "1", 0.4, 1.8), ("A2", "1", 0.5, 2.0)]


def test_cells_out_of_order(tmp_path: Path) -> None:
    """Openpyxl's quick reader takes the last cell for the widest, and leaves out what is right of it."""

    def exchange(data: bytes) -> bytes:
        found = re.search(rb'(<row r="2"[^>]*>)(.*)(<c r="D2".*?</c>)(</row>)', data)
        assert found
        return data.replace(found[0], found[1] + found[3] + found[2] + found[4])

    assert items_of(change_parts(write(tmp_path), {SHEET: exchange})) == [("A1", "1", 0.4, 1.8)]


def test_inline_and_shared_strings(tmp_path: Path) -> None:
    path = write_shared(tmp_path / "book.xlsx", {"Items": ITEMS, "Floors": FLOORS})
    rich = '<c r="A2" t="inlineStr"><is><r><t>A</t></r><r><rPr><b/></rPr><t>1b</t></r></is></c>'
    change_parts(path, {SHEET: lambda data: re.sub(rb'<c r="A2" t="s"><v>\d+</v></c>', rich.encode(), data)})
    assert items_of(path)[0][0] == "A1b"


def test_sheets_of_excel_with_extensions(tmp_path: Path) -> None:
    """What openpyxl remarks on never reaches the user: warnings are errors here."""
    extension = (
        '<extLst><ext xmlns:x14="http://schemas.microsoft.com/office/spreadsheetml/2009/9/main" '
        'uri="{CCE6A557-97BC-4b89-ADB6-D9C93CAAB3DF}"><x14:dataValidations count="0"/></ext></extLst></worksheet>'
    )
    path = change_parts(write(tmp_path), {SHEET: replace("</worksheet>", extension)})
    assert len(items_of(path)) == 1


def test_a_date_beyond_the_calendar(tmp_path: Path) -> None:
    path = write(tmp_path, [ITEMS[0], ["A1", "1", datetime(2024, 1, 1), 180]])
    change_parts(path, {SHEET: lambda data: re.sub(rb"<v>45292</v>|<v>2024-01-01[^<]*</v>", b"<v>99999999</v>", data)})
    with pytest.raises(WorkbookError, match="Items!C2: Breadth holds"):
        read_inventory(path)


def test_broken_names_and_other_sheets_do_no_harm(tmp_path: Path) -> None:
    """Print areas whose sheet is gone, and a sheet that is none of ours and damaged."""
    path = write_book(tmp_path / "book.xlsx", {"Items": ITEMS, "Floors": FLOORS, "Photos": [["x"]]})
    names = '<definedNames><definedName name="_xlnm.Print_Titles" localSheetId="0">#REF!</definedName></definedNames>'
    workbook = "xl/workbook.xml"
    text = re.sub(r"<definedNames\s*/>", names, read_part(path, workbook))
    assert "#REF!" in text
    change_parts(path, {workbook: text.encode(), "xl/worksheets/sheet3.xml": b"<worksheet><broken"})
    assert len(items_of(path)) == 1


def test_hidden_sheets_are_read(tmp_path: Path) -> None:
    path = write(tmp_path)
    book = openpyxl.load_workbook(path)
    book.create_sheet("Front")
    book.active = 2
    book["Floors"].sheet_state = "hidden"
    book.save(path)
    assert len(items_of(path)) == 1


def test_the_sheets_may_be_spelt_otherwise(tmp_path: Path) -> None:
    assert len(items_of(write_book(tmp_path / "book.xlsx", {" ITEMS": ITEMS, "floors ": FLOORS}))) == 1


@pytest.mark.libreoffice
@needs_libreoffice
def test_files_by_libreoffice(tmp_path: Path) -> None:
    path = write(tmp_path, [[*ITEMS[0], "Quantity", "Notes"], [*ITEMS[1], "=1+1", "ä\n2"]], Building=[["Use", "x"]])
    found = read_inventory(libreoffice(path, tmp_path / "again.xlsx")).items[0]
    assert (found.item, found.breadth, found.quantity, found.notes) == ("A1", 0.4, 2, "ä\n2")


def test_a_workbook_is_read_from_any_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_record(tmp_path / "one.csv")
    path = write(tmp_path, floors=floors_with("one.csv"))
    monkeypatch.chdir(tmp_path)
    here = read_inventory(path.name)
    assert (here.source, here.sha256) == (Path("book.xlsx"), read_inventory(str(path)).sha256)


# ---------------------------------------------------------------- many rows


def test_20000_rows(tmp_path: Path) -> None:
    rows = [[f"A{n}", "1", 30 + n % 50, 180] for n in range(20_000)]
    inventory = read_inventory(write_shared(tmp_path / "book.xlsx", {"Items": [ITEMS[0], *rows], "Floors": FLOORS}))
    assert len(inventory.items) == 20_000
    assert inventory.items[-1].row == 20_001


# ---------------------------------------------------------------- the model


def test_every_field_of_the_model_has_a_column() -> None:
    from dataclasses import fields

    from assess.inventory import model

    kinds = {"Building": model.Building, "Items": model.Item, "Places": model.Place, "Routes": model.Segment,
             "Catalogue": model.CatalogueType}  # fmt: skip
    for sheet in SHEETS:
        if sheet.name != "Floors":
            own = {one.name for one in fields(kinds[sheet.name])} - {"row", "assumed", "extra"}
            assert {column.name for column in sheet.columns} == own


def test_labels_are_told_apart() -> None:
    for sheet in SHEETS:
        labels = [column.label.replace(" ", "").casefold() for column in sheet.columns]
        assert len(set(labels)) == len(labels)
    assert BUILDING.column("period").header("imperial") == "Period T1 [s]"
