"""Headers: units, spelling, order, what is near and what is not."""

import re
from datetime import datetime
from pathlib import Path

import openpyxl
import pytest

from assess.errors import WorkbookError
from assess.units import GRAVITY
from assess.workbook.read import read_inventory
from tests.workbook.books import (
    ITEMS,
    Sheet,
    errors_of,
    read,
    read_item,
    remarks,
    write,
)


@pytest.mark.parametrize(
    ("unit", "number"), [("mm", 400), ("cm", 40), ("m", 0.4), ("in", 40 / 2.54), ("ft", 40 / 30.48)]
)
def test_lengths(tmp_path: Path, unit: str, number: float) -> None:
    found = read_item(tmp_path, [f"Breadth [{unit}]", f"Height [{unit}]"], [number, 4 * number])
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
    floor = read(tmp_path, floors=[["Floor", "PFA X [g]", f"PFV X [{unit}]"], ["1", 0.5, number]]).floors[0]
    assert floor.pfv == {"X": pytest.approx(0.5, rel=1e-12)}


@pytest.mark.parametrize(
    ("header", "message"),
    [
        (
            "Height [kg]",
            "the unit 'kg' of Height is not known. Write the unit that the numbers are in, such as Height [cm]; known units: mm, cm, m, in, ft.",
        ),
        (
            "Height []",
            "the unit '' of Height is not known. Write the unit that the numbers are in, such as Height [cm]; known units: mm, cm, m, in, ft.",
        ),
        (
            "Height",
            "Height has no unit. Write the unit that the numbers are in, such as Height [cm]; known units: mm, cm, m, in, ft.",
        ),
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
        "Building!A2: the unit 'ms' of Period T1 is not known. Write the unit that the numbers are in, such as Period T1 [s]; known units: s.",
        "Building!A4: duplicate line Storeys, also in A3. Delete one of them.",
    }


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
    assert errors_of(write(tmp_path, [*([["remark"]] * 20), *ITEMS])) == {
        "Items!A1: no header row was found in the first 20 rows. It needs the headers: Item, Floor."
    }


def test_unknown_columns_are_kept(tmp_path: Path) -> None:
    header = [*ITEMS[0], "Picture", "Inventory no.", "Bought"]
    rows: Sheet = [
        ["A1", "1", 40, 180, "left", 4711.0, datetime(2020, 5, 1)],
        ["A2", "1", 50, 180, None, "x\u202ey", True],
    ]
    inventory = read(tmp_path, [header, *rows])
    assert inventory.extra_columns == ("Picture", "Inventory no.", "Bought")
    assert [one.extra for one in inventory.items] == [("left", "4711", "2020-05-01T00:00:00"), ("", "xy", "TRUE")]
    assert remarks(inventory, "note") == {
        "Items!E1: the column 'Picture' is not known; it is kept, not used.",
        "Items!F1: the column 'Inventory no.' is not known; it is kept, not used.",
        "Items!G1: the column 'Bought' is not known; it is kept, not used.",
    }


def test_a_row_without_an_entry_is_left_out(tmp_path: Path) -> None:
    inventory = read(tmp_path, [[*ITEMS[0], "Picture"], [*ITEMS[1], None], [None, None, None, " ", "right"]])
    assert len(inventory.items) == 1
    assert remarks(inventory, "warning") == {"Items!E3: stands in a row without an entry; the row is left out."}


@pytest.mark.parametrize("header", ["Mass [kg]", "Mass", "Colour", "Owner", "Age [years]", "Z [m]", "Depth [cm]"])
def test_headers_that_are_no_slip(tmp_path: Path, header: str) -> None:
    assert read(tmp_path, [[*ITEMS[0], header], [*ITEMS[1], 80]]).extra_columns == (header,)


def test_weight_in_place_of_height(tmp_path: Path) -> None:
    """Where Height itself is missing, Weight is no slip; in a unit of length it is one."""
    types: Sheet = [["Type", "Height [cm]"], ["T", 180]]
    header = ["Type", "Breadth [cm]"]
    assert read_item(tmp_path, [*header, "Weight [kg]"], ["T", 40, 80], Catalogue=types).height == 1.8
    with pytest.raises(WorkbookError, match=re.escape("Items!E1: the unit 'cm' of Weight is not known.")):
        read_item(tmp_path, [*header, "Weight [cm]"], ["T", 40, 80], Catalogue=types)


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
