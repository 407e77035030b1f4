"""Headers: units, spelling, order, what is near and what is not."""

from datetime import datetime
from pathlib import Path

import pytest

from assess.units import GRAVITY
from tests.workbook.books import ITEMS, Sheet, errors_of, read, remarks, write

UNITS = {
    "PFA X": (0.5 * GRAVITY, {
        "g": 0.5, "m/s2": 0.5 * GRAVITY, "m/s²": 0.5 * GRAVITY, "m/s^2": 0.5 * GRAVITY, "cm/s2": 50 * GRAVITY,
        "cm/s²": 50 * GRAVITY, "gal": 50 * GRAVITY, "Gal": 50 * GRAVITY, " G ": 0.5, "M / S2": 0.5 * GRAVITY,
    }),
    "PFV X": (0.5, {"cm/s": 50, "m/s": 0.5, "in/s": 50 / 2.54}),
    "Elevation": (0.4, {"mm": 400, "cm": 40, "m": 0.4, "in": 40 / 2.54, "ft": 40 / 30.48, "inch": 40 / 2.54,
                        "inches": 40 / 2.54, "feet": 40 / 30.48}),
}  # fmt: skip
"""By the header of Floors: a value, and its number in each unit."""


def test_units_of_headers(tmp_path: Path) -> None:
    for label, (value, units) in UNITS.items():
        for unit, number in units.items():
            given = {} if label == "PFA X" else {"PFA X [g]": 0.5}
            cells = {"Floor": "1", **given, f"{label} [{unit}]": number}
            (floor,) = read(tmp_path, floors=[list(cells), list(cells.values())]).floors
            found = {"PFA X": floor.pfa.get("X"), "PFV X": floor.pfv.get("X"), "Elevation": floor.elevation}[label]
            assert found == pytest.approx(value, rel=1e-12), (label, unit)


def test_headers_of_a_table_and_lines_of_a_form_that_are_wrong(tmp_path: Path) -> None:
    units = "Write the unit that the numbers are in, such as Height [cm]; known units: mm, cm, m, in, ft."
    unknown = "the column '{}' is not known. Did you mean {}?"
    wrong = {
        "Height [kg]": f"the unit 'kg' of Height is not known. {units}",
        "Height []": f"the unit '' of Height is not known. {units}",
        "Height": f"Height has no unit. {units}",
        "Weight [cm]": "the unit 'cm' of Weight is not known. Write the unit that the numbers are in, such as Weight [kg]; "
                       "known units: kg, lb.",
    } | {slip: unknown.format(slip, meant) for slip, meant in {
        "Height (cm)": "Height [cm]", "Height cm": "Height [cm]", "Heigth [mm]": "Height [cm]",
        "Angel [deg]": "Angle [deg]", "Quantitty": "Quantity",
    }.items()}  # fmt: skip
    for header, message in wrong.items():
        path = write(tmp_path, [["Item", "Floor", "Breadth [cm]", "Type", header], ["A1", "1", 40, "T", 180]],
                     Catalogue=[["Type", "Height [cm]"], ["T", 180]])  # fmt: skip
        assert errors_of(path) == {f"Items!E1: {message}"}
    building: Sheet = [
        ["Buildng", "Town hall"], ["Period T1 [ms]", 900], ["Storeys", 4], ["storeys ", 5], ["Colour", "red"],
    ]  # fmt: skip
    path = write(tmp_path, Building=building)
    assert errors_of(path) == {
        "Building!A1: the line 'Buildng' is not known. Did you mean Building?",
        "Building!A2: the unit 'ms' of Period T1 is not known. Write the unit that the numbers are in, such as Period T1 [s]; known units: s.",
        "Building!A4: duplicate line Storeys, also in A3. Delete one of them.",
    }


def test_headers_in_any_order_and_spelling_below_a_title_and_unknown_ones_which_are_kept(tmp_path: Path) -> None:
    items: Sheet = [["  HEIGHT [ CM ]", "fLoOr", "breadth[cm]", None, "It em", "Edge\u00a0 distance [m]"],
             [180, "1", 40, None, "A1", -0.5]]  # fmt: skip
    found = read(tmp_path, items).items[0]
    assert (found.item, found.floor, found.breadth, found.height, found.edge_distance) == ("A1", "1", 0.4, 1.8, -0.5)
    for above in (1, 19):
        title = [["Furniture of the town hall"], *([[]] * (above - 1))]
        inventory = read(tmp_path, [*title, *ITEMS, [], ["A2", "1", 50, 180]])
        assert [(one.item, one.row) for one in inventory.items] == [("A1", above + 2), ("A2", above + 4)]
    assert errors_of(write(tmp_path, [*([["remark"]] * 20), *ITEMS])) == {
        "Items!A1: no header row was found in the first 20 rows. It needs the headers: Item, Floor."
    }
    live = ["B/H", "PFA used [g]", "OR", "Kaneko-Hayashi", "Class (formula)"]
    own = [
        "Picture", "Inventory no.", "Bought", "Mass [kg]", "Mass", "Colour", "Owner", "Age [years]", "Z [m]",
        "Depth [cm]",
    ]  # fmt: skip
    rows: Sheet = [
        ["A1", "1", 40, 180, *["=C2/D2"] * 5, "left", 4711.0, datetime(2020, 5, 1)],
        ["A2", "1", 50, 180, *["=1"] * 5, None, "x\u202ey", True],
        [*[None] * 4, *["=1"] * 5],
    ]
    inventory = read(tmp_path, [[*ITEMS[0], *live, *own], *rows])
    assert inventory.extra_columns == tuple(own)
    assert [one.extra[:3] for one in inventory.items] == [
        ("left", "4711", "2020-05-01T00:00:00"), ("", "xy", "TRUE"),
    ]  # fmt: skip
    assert remarks(inventory, "note") == {
        f"Items!{letter}1: the column '{header}' is not known; it is kept, not used."
        for letter, header in zip("JKLMNOPQRS", own, strict=True)
    }
    inventory = read(tmp_path, [[*ITEMS[0], "Picture"], [*ITEMS[1], None], [None, None, None, " ", "right"]])
    assert len(inventory.items) == 1
    assert remarks(inventory, "warning") == {"Items!E3: stands in a row without an entry; the row is left out."}
