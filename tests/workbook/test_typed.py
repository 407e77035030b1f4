"""What a person means: numbers, choices, dates and names as they are typed, and what is ambiguous."""

import math
from pathlib import Path

import openpyxl
import pytest
from hypothesis import given, strategies as st

from assess.errors import Correction
from assess.units import GRAVITY, QUANTITIES
from assess.workbook.habits import CellError
from assess.workbook.names import translate
from assess.workbook.open import Percent
from assess.workbook.read import read_inventory
from assess.workbook.schema import BUILDING, FLOORS, ITEMS, Column
from assess.workbook.values import find_meant, understand
from tests.workbook.books import Sheet, read, remarks, write

HEIGHT, WEIGHT, CENTRE = (ITEMS.column(name) for name in ("height", "weight", "centre_of_gravity"))
FRICTION, QUANTITY, PFA = ITEMS.column("friction"), ITEMS.column("quantity"), FLOORS.column("pfa_x")
X, ANGLE, PERIOD = ITEMS.column("x"), ITEMS.column("angle_deg"), BUILDING.column("period")
ANCHORED, WALL, SCENARIO = ITEMS.column("anchored"), ITEMS.column("against_wall"), BUILDING.column("scenario_kind")
DATE = BUILDING.column("report_date")


def meant(column: Column, value: object, unit: str | None = None) -> tuple[object, str]:
    """Return what a cell is taken for, and the habit that it shows."""
    found, remark = understand(column, value, column.unit if unit is None else unit)
    return found, remark.habit if remark else ""


NUMBERS: dict[tuple[Column, str, str], dict[str, float]] = {
    (HEIGHT, "cm", "unit"): {"1m80": 180, "1 m 80": 180, "1 m 5 cm": 105, "45 cm": 45, "1.80 m": 180, "1,80m": 180, "450 mm": 45, "1'800 MM.": 180,
        "1.8 metres": 180, "' 1.80 m": 180, "1'4\"": 40.64, "5 ft 11 in": 180.34},
    (HEIGHT, "in", "unit"): {"6 ft": 72, "5' 11\"": 71, "5\u2019 11\u201d": 71, "5\u2032-11\u2033": 71,
        "5' 1,5''": 61.5, "6'": 72, "5.5'": 66},
    (HEIGHT, "m", "unit"): {"180 cm": 1.8},
    (HEIGHT, "cm", "comma"): {"40,5": 40.5},
    (HEIGHT, "cm", "text"): {" 180": 180, "180\u00a0": 180, "1.8e2": 180, "'200": 200},
    (HEIGHT, "cm", "thousands"): {"1\u202f800,5": 1800.5, "1.234,5": 1234.5, "1,234.5": 1234.5,
        "1.234.567": 1234567, "1 234,567": 1234.567},
    (HEIGHT, "cm", "signs"): {"１８０": 180, "\u2019200": 200}, (X, "m", "text"): {"'-1.5": -1.5, "+3": 3},
    (X, "m", "comma"): {"\u22121,5": -1.5}, (X, "m", "signs"): {"\u2013 3": -3},
    (HEIGHT, "ft", "unit"): {"5 feet 6 inches": 5.5, '66"': 5.5}, (X, "ft", "unit"): {"-1' 6\"": -1.5},
    (WEIGHT, "kg", "unit"): {"12 kg": 12, "10 lbs": 4.5359237},
    (FRICTION, "", "comma"): {"0,15": 0.15, "0,150": 0.15, ",150": 0.15, "012,500": 12.5, "1234,500": 1234.5},
    (FRICTION, "", "text"): {"0.150": 0.15}, (FRICTION, "", "percent"): {"40 %": 0.4},
    (CENTRE, "%", "unit"): {"45 %": 45}, (QUANTITY, "", "text"): {"12": 12},
    (PFA, "g", "percent"): {"15 %": 0.15, "15 %g": 0.15},
    (PFA, "m/s2", "percent"): {"15 % g": float(f"{0.15 * GRAVITY:.12g}")},
    (PFA, "g", "unit"): {"1.5 m/s²": float(f"{1.5 / GRAVITY:.12g}"), "0.15 G": 0.15},
    (ANGLE, "deg", "unit"): {"15°": 15}, (PERIOD, "s", "unit"): {"0,9 s": 0.9},
}  # fmt: skip
"""By column, unit of its header and habit: texts, and the numbers that they are taken for."""


def test_numbers_as_they_are_typed_texts_that_are_none_and_what_is_ambiguous() -> None:
    for (column, unit, habit), numbers in NUMBERS.items():
        assert {text: meant(column, text, unit) for text in numbers} == {
            text: (number, habit) for text, number in numbers.items()
        }
    assert {text: meant(HEIGHT, text) for text in NO_NUMBERS} == {text: (text, "") for text in NO_NUMBERS}
    for column, text, one, other in (
        (HEIGHT, "1,500", "1.5 cm", "1500 cm"), (HEIGHT, "1.500", "1.5 cm", "1500 cm"),
        (HEIGHT, "-12,345", "-12.345 cm", "-12345 cm"), (HEIGHT, "1,500 mm", "0.15 cm", "150 cm"),
        (QUANTITY, "1.000", "1", "1000"),
    ):  # fmt: skip
        with pytest.raises(CellError) as caught:
            meant(column, text)
        assert f"which can be read as {one} or as {other}." in caught.value.message


NO_NUMBERS = [
    "45 kg", "about 45", "40-45", "40 x 60", "1.2.3", "1,2,3", "12,34,567", "1.234,5.6", "4²", "½", "45 cm²", "1e999",
    "0e999", "١,٥٠٠", "9" * 400, "#N/A", "--3", "high", "%", "'high", "''200", "'200'", "'", "5' 11", "1'800\"",
    "5' 12\"", "5 11\"", "5.5' 3\"", "1.125\"", "\"",
]  # fmt: skip


UNITS = [(column, unit) for column in (HEIGHT, WEIGHT, PFA, X, CENTRE) for unit in QUANTITIES[column.quantity]]


@given(
    thousandths=st.integers(-(10**9), 10**9),
    digits=st.sampled_from([0, 1, 2, 4]),
    signs=st.sampled_from([(".", ""), (",", ""), (".", ","), (",", "."), (",", " "), (".", "'"), (",", "\u202f")]),
    minus=st.sampled_from(["-", "\u2212", "\u2013", "\uff0d", "\u2011"]),
    spaces=st.tuples(*[st.sampled_from(["", " ", "\u00a0", "\u2009"])] * 3),
    where=st.sampled_from(UNITS),
    is_wide=st.booleans(),
)
def test_a_number_written_in_any_accepted_way_reads_back(
    thousandths: int, digits: int, signs: tuple[str, str], minus: str, spaces: tuple[str, str, str],
    where: tuple[Column, str], *, is_wide: bool
) -> None:  # fmt: skip
    """What it is converted to is compared in the header's unit, in 11 digits."""
    column, unit = where
    number = float(f"{thousandths / 1000:.{digits}f}")
    point, mark = signs
    text = f"{number:,.{digits}f}".translate({ord(","): mark, ord("."): point})
    if digits == 0 and text.count(mark or "none") == 1 and mark in (",", "."):
        return  # "1,500" is ambiguous
    text = text.replace("-", minus)
    if is_wide:
        text = text.translate({ord(str(digit)): chr(0xFF10 + digit) for digit in range(10)})
    typed = f"{spaces[0]}{text}{spaces[1]}{unit}{spaces[2]}"
    expected = number * QUANTITIES[column.quantity][unit] / QUANTITIES[column.quantity][column.unit]
    found, habit = meant(column, typed)
    assert isinstance(found, float)
    assert math.isclose(found, expected, rel_tol=1e-11, abs_tol=1e-12)
    assert habit == "unit"
    assert meant(column, text, unit)[0] == number, "without a unit it is in that of the header"


def test_a_percentage_and_every_cell_that_is_taken_have_a_note_and_a_correction(tmp_path: Path) -> None:
    """Excel stores 45 % as 0.45: a share is read as it shows; a PFA of 15 % is 0.15 g by itself."""
    path = write(tmp_path, [["Item", "Floor", "Breadth [cm]", "Height [cm]", "Centre of gravity [%]"],
                            ["A1", "1", 40, 180, 0.45], ["A2", "1", 40, 180, 45]],
                 [["Floor", "PFA X [g]"], ["1", 0.15]])  # fmt: skip
    book = openpyxl.load_workbook(path)
    for sheet, cell in (("Items", "E2"), ("Items", "E3"), ("Floors", "B2")):
        book[sheet][cell].number_format = "0.0%"
    book.save(path)
    inventory = read_inventory(path)
    assert [one.centre_of_gravity for one in inventory.items] == [0.45, 0.45]
    assert inventory.floors[0].pfa["X"] == pytest.approx(0.15 * GRAVITY)
    assert inventory.corrections == (), "the cell shows 45 %, as it should"
    assert remarks(inventory, "note") == {
        "Items!E2: Centre of gravity [%]: 45.000% is a percentage; it is read as 45 %."
    }
    assert meant(HEIGHT, Percent(0.45))[0] == 0.45
    items: Sheet = [["Item", "Floor", "Breadth [cm]", "Height [cm]", "Anchored", "Against wall", "Notes"],
                    ["A1", "B\u20131", "45 cm", "1.80 m", "N", True, "x"], ["A2", "B-1 ", 45.5, "'200", True, "no", 4],
                    ["A3", "B-1", 45, 180, "no", None, None]]  # fmt: skip
    building: Sheet = [["Report date", "after Easter"], ["Shaking", "MMI 7"]]
    inventory = read(tmp_path, items, [["Floor", "PFA X [g]"], ["B-1", "15 %"]], Building=building)
    first, second, _ = inventory.items
    assert (first.floor, first.breadth, first.height) == ("B-1", 0.45, 1.8)
    assert (first.anchored, first.against_wall) == ("no", True)
    assert (second.height, second.anchored, inventory.building.report_date) == (2.0, "yes", "after Easter")
    assert {(one.sheet, one.cell, one.was, one.value) for one in inventory.corrections} == {
        ("Building", "B2", "MMI 7", "MMI VII, very strong"), ("Floors", "B2", "15 %", 0.15),
        ("Items", "B2", "B\u20131", "B-1"), ("Items", "C2", "45 cm", 45), ("Items", "D2", "1.80 m", 180),
        ("Items", "E2", "N", "no"), ("Items", "B3", "B-1 ", "B-1"), ("Items", "D3", "'200", 200), ("Items", "E3", "True", "yes"),
    }  # fmt: skip
    assert all(isinstance(one, Correction) and one.why for one in inventory.corrections)
    assert {one for one in remarks(inventory, "note") if ": '" in one} == {
        "Building!B2: Shaking: 'MMI 7' is read as MMI VII, very strong.",
        "Floors!B2: PFA X [g]: '15 %' is a percentage; it is read as 0.15 g.",
        "Items!B2: Floor: 'B\u20131' has look-alike signs or digits; it is read as 'B-1'.",
        "Items!B3: Floor: 'B-1 ' has stray spaces; it is read as 'B-1'.",
        "Items!C2: Breadth [cm]: '45 cm' holds its unit; it is read as 45 cm.",
        "Items!D2: Height [cm]: '1.80 m' holds its unit; it is read as 180 cm.",
        "Items!D3: Height [cm]: ''200' is a number stored as text; it is read as 200 cm.",
        "Items!E2: Anchored: 'N' is read as no.",
        "Items!E3: Anchored: 'True' is read as yes.",
    }
    assert remarks(inventory, "warning") == {
        "Building!B1: Report date is 'after Easter', which is not read as a date; it is shown as typed. "
        "Write it as year-month-day: 2026-12-31."
    }
    rows = {"Items": [{"item": "A1", "floor": "1", "breadth": "45 cm", "height": 180}],
            "Floors": [{"floor": "1", "pfa_x": 0.5}]}  # fmt: skip
    inventory = read_inventory(rows)
    assert (inventory.items[0].breadth, inventory.corrections) == (0.45, ())
    assert remarks(inventory, "note") == {
        "Items row 1 Breadth: Breadth [cm]: '45 cm' holds its unit; it is read as 45 cm."
    }


SHAKING = BUILDING.column("shaking")
CHOICES = [
    (ANCHORED, "N", "no", "no"), (ANCHORED, "y", "yes", "yes"), (ANCHORED, "Ye", "yes", "yes"),
    (ANCHORED, "si", "yes", "yes"), (ANCHORED, "S", "yes", "yes"), (ANCHORED, "SI\u0300 ", "yes", "yes"),
    (ANCHORED, "yes ", "yes", "yes"), (ANCHORED, "part", "partly", "partly"), (ANCHORED, "in p", "partly", "partly"),
    (ANCHORED, "U", "unknown", "unknown"), (ANCHORED, "non n", "unknown", "unknown"), (ANCHORED, "YES", "yes", ""),
    (ANCHORED, "sì", "yes", ""), (ANCHORED, "x", None, ""), (ANCHORED, "yesterday", None, ""), (ANCHORED, "?", None, ""),
    (WALL, "Y", "yes", "yes"), (SCENARIO, "rec", "recorded", "recorded"), (SCENARIO, "ASCE", None, ""),
    (SCENARIO, "en", "EN 1998-1", "EN 1998-1"), (ITEMS.column("axis"), "x", "X", ""),
    (ITEMS.column("importance"), "life", "life safety", "life safety"),
    *((SHAKING, text, "MMI VII, very strong", "MMI VII, very strong")
      for text in ("MMI VII", "MMI 7", "mmi7", " MMI\u00a0\uff17 ", "MMI 07", "MMI 7, very strong")),
    (SHAKING, "MMI 10", "MMI X, extreme", "MMI X, extreme"), (SHAKING, "MMI 4", "MMI IV, light", "MMI IV, light"),
    *((SHAKING, text, None, "") for text in ("VII", "7", "MCS VII", "MCS 7", "EMS 7", "EMS VII", "MMI 3", "MMI 13",
                                             "MMI 0", "MMI 7.5", "MMI 7-8", "MMI", "MMI 7, strong", "JMA VII")),
    (SHAKING, "JMA 7", "JMA 7", ""),
]  # fmt: skip


def test_choices_and_dates_as_they_are_typed_and_dates_that_are_wrong() -> None:
    wrong_dates = {
        "31/02/2026": "which is not a date: month 2 of 2026 has 28 days.",
        "02/31/2028": "which is not a date: month 2 of 2028 has 29 days.",
        "31 April 2026": "which is not a date: month 4 of 2026 has 30 days.",
        "2026-13-01": "which is not a date: there is no month 13.",
        "03/04/2026": "which can be read as 2026-04-03 or as 2026-03-04.",
        "31/12/26": "the year has two digits.",
    }
    dates = [
        ("2026-12-31", "2026-12-31", ""), ("31/12/2026", "2026-12-31", "date"), ("12.31.2026", "2026-12-31", "date"),
        ("31-12-2026", "2026-12-31", "date"), ("2026/12/31", "2026-12-31", "date"), ("4/4/2026", "2026-04-04", "date"),
        ("31 Dec 2026", "2026-12-31", "date"), ("31 December 2026", "2026-12-31", "date"),
        ("December 31st, 2026", "2026-12-31", "date"), ("31 dicembre 2026", "2026-12-31", "date"),
        ("1º gen. 2026", "2026-01-01", "date"), ("31-Dec-2026", "2026-12-31", "date"),
        ("29/02/2028", "2028-02-29", "date"), ("marzo 2026", "marzo 2026", ""), ("2026", "2026", ""),
    ]  # fmt: skip
    for column, text, choice, word in CHOICES:
        assert find_meant(text, column.choices, "en") == (choice, word), (column.name, text)
    anchored = translate(ITEMS, "it").column("anchored").choices
    assert [find_meant(text, anchored, "it")[1] for text in ("s", "N", "in p", "y")] == ["sì", "no", "in parte", "sì"]
    assert {text: meant(DATE, text) for text, *_ in dates} == {text: (date, habit) for text, date, habit in dates}
    for text, why in wrong_dates.items():
        with pytest.raises(CellError) as caught:
            meant(DATE, text)
        assert str(caught.value.message).endswith(why)
