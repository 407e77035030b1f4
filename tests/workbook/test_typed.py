"""What a person means: numbers, choices, dates and names as they are typed, and what is ambiguous."""

import math
from pathlib import Path
from typing import Any

import openpyxl
import pytest
from hypothesis import given
from hypothesis import strategies as st

from assess.errors import Correction
from assess.units import GRAVITY, QUANTITIES
from assess.workbook.habits import CellError
from assess.workbook.names import translate
from assess.workbook.number_formats import Percent
from assess.workbook.read import read_inventory
from assess.workbook.schema import BUILDING, FLOORS, ITEMS, Column
from assess.workbook.typed import find_meant, straighten, understand
from tests.workbook.books import Sheet, errors_of, read, read_item, remarks, write, write_book

HEIGHT, WEIGHT, CENTRE = (ITEMS.column(name) for name in ("height", "weight", "centre_of_gravity"))
FRICTION, QUANTITY, PFA = ITEMS.column("friction"), ITEMS.column("quantity"), FLOORS.column("pfa_x")
X, ANGLE, PERIOD = ITEMS.column("x"), ITEMS.column("angle_deg"), BUILDING.column("period")
ANCHORED, WALL, SCENARIO = ITEMS.column("anchored"), ITEMS.column("against_wall"), BUILDING.column("scenario_kind")
DATE = BUILDING.column("report_date")


def meant(column: Column, value: object, unit: str | None = None) -> tuple[object, str]:
    """Return what a cell is taken for, and the habit that it shows."""
    found, remark = understand(column, value, column.unit if unit is None else unit, repr)
    return found, remark.habit if remark else ""


NUMBERS: list[tuple[Column, str, str, object, str]] = [
    (HEIGHT, "cm", "45 cm", 45, "unit"),
    (HEIGHT, "cm", "1.80 m", 180, "unit"),
    (HEIGHT, "cm", "1,80m", 180, "unit"),
    (HEIGHT, "cm", "450 mm", 45, "unit"),
    (HEIGHT, "cm", "1'800 MM.", 180, "unit"),
    (HEIGHT, "in", "6 ft", 72, "unit"),
    (HEIGHT, "m", "180 cm", 1.8, "unit"),
    (HEIGHT, "cm", "1.8 metres", 180, "unit"),
    (HEIGHT, "cm", "40,5", 40.5, "comma"),
    (HEIGHT, "cm", " 180", 180, "text"),
    (HEIGHT, "cm", "180\u00a0", 180, "text"),
    (HEIGHT, "cm", "1\u202f800,5", 1800.5, "thousands"),
    (HEIGHT, "cm", "1.234,5", 1234.5, "thousands"),
    (HEIGHT, "cm", "1,234.5", 1234.5, "thousands"),
    (HEIGHT, "cm", "1.234.567", 1234567, "thousands"),
    (HEIGHT, "cm", "1 234,567", 1234.567, "thousands"),
    (HEIGHT, "cm", "１８０", 180, "signs"),
    (HEIGHT, "cm", "1.8e2", 180, "text"),
    (HEIGHT, "cm", "'200", 200, "text"),
    (HEIGHT, "cm", "\u2019200", 200, "signs"),
    (HEIGHT, "cm", "' 1.80 m", 180, "unit"),
    (X, "m", "'-1.5", -1.5, "text"),
    (X, "m", "\u22121,5", -1.5, "comma"),
    (X, "m", "\u2013 3", -3, "signs"),
    (X, "m", "+3", 3, "text"),
    (HEIGHT, "in", "5' 11\"", 71, "unit"),
    (HEIGHT, "in", "5\u2019 11\u201d", 71, "unit"),
    (HEIGHT, "in", "5\u2032-11\u2033", 71, "unit"),
    (HEIGHT, "cm", "1'4\"", 40.64, "unit"),
    (HEIGHT, "cm", "5 ft 11 in", 180.34, "unit"),
    (HEIGHT, "ft", "5 feet 6 inches", 5.5, "unit"),
    (HEIGHT, "in", "5' 1,5''", 61.5, "unit"),
    (HEIGHT, "in", "6'", 72, "unit"),
    (HEIGHT, "in", "5.5'", 66, "unit"),
    (HEIGHT, "ft", '66"', 5.5, "unit"),
    (X, "ft", "-1' 6\"", -1.5, "unit"),
    (WEIGHT, "kg", "12 kg", 12, "unit"),
    (WEIGHT, "kg", "10 lbs", 4.5359237, "unit"),
    (FRICTION, "", "0,15", 0.15, "comma"),
    (FRICTION, "", "0,150", 0.15, "comma"),
    (FRICTION, "", ",150", 0.15, "comma"),
    (FRICTION, "", "40 %", 0.4, "percent"),
    (CENTRE, "%", "45 %", 45, "unit"),
    (QUANTITY, "", "12", 12, "text"),
    (PFA, "g", "15 %", 0.15, "percent"),
    (PFA, "g", "15 %g", 0.15, "percent"),
    (PFA, "m/s2", "15 % g", float(f"{0.15 * GRAVITY:.12g}"), "percent"),
    (PFA, "g", "1.5 m/s²", float(f"{1.5 / GRAVITY:.12g}"), "unit"),
    (PFA, "g", "0.15 G", 0.15, "unit"),
    (ANGLE, "deg", "15°", 15, "unit"),
    (PERIOD, "s", "0,9 s", 0.9, "unit"),
]


@pytest.mark.parametrize(("column", "unit", "text", "number", "habit"), NUMBERS, ids=[one[2] for one in NUMBERS])
def test_numbers_as_they_are_typed(column: Column, unit: str, text: str, number: float, habit: str) -> None:
    assert meant(column, text, unit) == (number, habit)


@pytest.mark.parametrize(
    "text", ["45 kg", "about 45", "40-45", "40 x 60", "1.2.3", "1,2,3", "12,34,567", "1.234,5.6", "4²", "½", "45 cm²",
             "1e999", "0e999", "١,٥٠٠", "9" * 400, "#N/A", "--3", "high", "%",
             "'high", "''200", "'200'", "'", "5' 11", "1'800\"", "5' 12\"", "5 11\"", "5.5' 3\"", "1.125\"", "\""],
)  # fmt: skip
def test_texts_that_are_no_number_of_the_column(text: str) -> None:
    assert meant(HEIGHT, text) == (text, "")


@pytest.mark.parametrize(
    ("column", "text", "one", "other"),
    [
        (HEIGHT, "1,500", "1.5 cm", "1500 cm"),
        (HEIGHT, "1.500", "1.5 cm", "1500 cm"),
        (HEIGHT, "-12,345", "-12.345 cm", "-12345 cm"),
        (HEIGHT, "1,500 mm", "0.15 cm", "150 cm"),
        (QUANTITY, "1.000", "1", "1000"),
    ],
)
def test_one_separator_before_three_digits_is_ambiguous(column: Column, text: str, one: str, other: str) -> None:
    with pytest.raises(CellError) as caught:
        meant(column, text)
    assert f"which can be read as {one} or as {other}." in caught.value.message


@pytest.mark.parametrize(
    ("text", "number"), [("0,150", 0.15), ("0.150", 0.15), ("012,500", 12.5), ("1234,500", 1234.5)]
)
def test_what_cannot_part_thousands_is_a_decimal_sign(text: str, number: float) -> None:
    assert meant(FRICTION, text)[0] == number


def _format(number: float, digits: int, point: str, mark: str) -> str:
    """Write a number with a decimal sign and a sign between thousands."""
    return f"{number:,.{digits}f}".translate({ord(","): mark, ord("."): point})


def _spaced(text: str, before: str, after: str) -> str:
    return f"{before}{text}{after}"


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
    text = _format(number, digits, *signs)
    if digits == 0 and text.count(signs[1] or "none") == 1 and signs[1] in (",", "."):
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


def test_a_cell_that_shows_a_percentage(tmp_path: Path) -> None:
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


# ---------------------------------------------------------------- choices


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


@pytest.mark.parametrize(
    ("column", "text", "choice", "word"), CHOICES, ids=[f"{one[0].name} {one[1]}" for one in CHOICES]
)
def test_choices_as_they_are_typed(column: Column, text: str, choice: str | None, word: str) -> None:
    assert find_meant(text, column.choices, "en") == (choice, word)


def test_a_choice_is_corrected_in_the_language_of_its_column() -> None:
    column = translate(ITEMS, "it").column("anchored")
    assert [find_meant(text, column.choices, "it")[1] for text in ("s", "N", "in p", "y")] == [
        "sì", "no", "in parte", "sì",
    ]  # fmt: skip


def test_true_and_false_of_a_spreadsheet_are_choices(tmp_path: Path) -> None:
    assert read_item(tmp_path, ["Breadth [cm]", "Height [cm]", "Anchored"], [40, 180, True]).anchored == "yes"


# ---------------------------------------------------------------- dates


DATES = [
    ("2026-12-31", "2026-12-31", ""), ("31/12/2026", "2026-12-31", "date"), ("12.31.2026", "2026-12-31", "date"),
    ("31-12-2026", "2026-12-31", "date"), ("2026/12/31", "2026-12-31", "date"), ("4/4/2026", "2026-04-04", "date"),
    ("31 Dec 2026", "2026-12-31", "date"), ("31 December 2026", "2026-12-31", "date"),
    ("December 31st, 2026", "2026-12-31", "date"), ("31 dicembre 2026", "2026-12-31", "date"),
    ("1º gen. 2026", "2026-01-01", "date"), ("31-Dec-2026", "2026-12-31", "date"),
    ("29/02/2028", "2028-02-29", "date"), ("marzo 2026", "marzo 2026", ""), ("2026", "2026", ""),
]  # fmt: skip


@pytest.mark.parametrize(("text", "date", "habit"), DATES, ids=[one[0] for one in DATES])
def test_dates_as_they_are_typed(text: str, date: str, habit: str) -> None:
    assert meant(DATE, text) == (date, habit)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("31/02/2026", "which is not a date: month 2 of 2026 has 28 days."),
        ("02/31/2028", "which is not a date: month 2 of 2028 has 29 days."),
        ("31 April 2026", "which is not a date: month 4 of 2026 has 30 days."),
        ("13/13/2026", "which is not a date: there is no month 13."),
        ("2026-13-01", "which is not a date: there is no month 13."),
        ("03/04/2026", "which can be read as 2026-04-03 or as 2026-03-04."),
        ("31/12/26", "the year has two digits."),
    ],
)
def test_dates_that_are_wrong(text: str, why: str) -> None:
    with pytest.raises(CellError) as caught:
        meant(DATE, text)
    assert str(caught.value.message).endswith(why)


def test_a_date_in_words_of_its_own_is_kept_and_warned_of(tmp_path: Path) -> None:
    inventory = read(tmp_path, Building=[["Report date", "after Easter"]])
    assert inventory.building.report_date == "after Easter"
    assert remarks(inventory, "warning") == {
        "Building!B1: Report date is 'after Easter', which is not read as a date; it is shown as typed. "
        "Write it as year-month-day: 2026-12-31."
    }


# ---------------------------------------------------------------- through the workbook


def test_every_cell_that_is_taken_has_a_note_and_a_correction(tmp_path: Path) -> None:
    items: Sheet = [["Item", "Floor", "Breadth [cm]", "Height [cm]", "Anchored"],
                    ["A1", "1 ", "45 cm", "1.80 m", "N"]]  # fmt: skip
    inventory = read(tmp_path, items, [["Floor", "PFA X [g]"], ["1", "15 %"]])
    assert (inventory.items[0].breadth, inventory.items[0].height, inventory.items[0].anchored) == (0.45, 1.8, "no")
    assert [(one.sheet, one.cell, one.was, one.value) for one in inventory.corrections] == [
        ("Floors", "B2", "15 %", 0.15), ("Items", "B2", "1 ", "1"), ("Items", "C2", "45 cm", 45),
        ("Items", "D2", "1.80 m", 180), ("Items", "E2", "N", "no"),
    ]  # fmt: skip
    assert all(isinstance(one, Correction) and one.why for one in inventory.corrections)
    assert remarks(inventory, "note") == {
        "Floors!B2: PFA X [g]: '15 %' is a percentage; it is read as 0.15 g.",
        "Items!B2: Floor: '1 ' has stray spaces; it is read as '1'.",
        "Items!C2: Breadth [cm]: '45 cm' holds its unit; it is read as 45 cm.",
        "Items!D2: Height [cm]: '1.80 m' holds its unit; it is read as 180 cm.",
        "Items!E2: Anchored: 'N' is read as no.",
    }


def test_an_intensity_in_arabic_numerals_is_taken_with_a_note_and_a_correction(tmp_path: Path) -> None:
    rows: Sheet = [["Item", "Floor", "Breadth [cm]", "Height [cm]"], ["A1", "1", 40, 180]]
    sheets: dict[str, Sheet] = {"Building": [["Shaking", "MMI 7"]], "Items": rows,
                                "Floors": [["Floor", "Elevation [m]"], ["1", 0]]}  # fmt: skip
    inventory = read_inventory(write_book(tmp_path / "book.xlsx", sheets))
    assert inventory.building.shaking == "MMI VII, very strong"
    assert [(one.cell, one.was, one.value) for one in inventory.corrections] == [
        ("B1", "MMI 7", "MMI VII, very strong")
    ]
    assert "Building!B1: Shaking: 'MMI 7' is read as MMI VII, very strong." in remarks(inventory, "note")


@pytest.mark.parametrize("typed", ["VII", "MCS 7", "MCS VII", "EMS VII"])
def test_an_intensity_of_another_scale_or_of_none_is_an_error(tmp_path: Path, typed: str) -> None:
    rows: Sheet = [["Item", "Floor", "Breadth [cm]", "Height [cm]"], ["A1", "1", 40, 180]]
    sheets: dict[str, Sheet] = {"Building": [["Shaking", typed]], "Items": rows,
                                "Floors": [["Floor", "Elevation [m]"], ["1", 0]]}  # fmt: skip
    (error,) = errors_of(write_book(tmp_path / "book.xlsx", sheets))
    assert error.startswith(f"Building!B1: Shaking is '{typed}', expected one of: MMI IV, light; ")


def test_a_number_behind_an_apostrophe_is_taken_with_a_note_and_a_correction(tmp_path: Path) -> None:
    inventory = read(tmp_path, [["Item", "Floor", "Breadth [cm]", "Height [cm]"], ["A1", "1", 40, "'200"]])
    assert inventory.items[0].height == 2.0
    assert [(one.cell, one.was, one.value) for one in inventory.corrections] == [("D2", "'200", 200)]
    assert remarks(inventory, "note") == {
        "Items!D2: Height [cm]: ''200' is a number stored as text; it is read as 200 cm."
    }


def test_corrections_name_the_sheet_as_the_workbook_does_and_survive_errors(tmp_path: Path) -> None:
    items: Sheet = [["Item", "Floor", "Breadth [cm]", "Height [cm]"], ["A1", "1", "40 cm", "high"]]
    path = write_book(tmp_path / "book.xlsx", {"ITEMS": items, "Floors": [["Floor", "PFA X [g]"], ["1", 0.5]]})
    (correction,) = read_inventory(path, strict=False).corrections
    assert (correction.sheet, correction.cell) == ("ITEMS", "C2")


@pytest.mark.parametrize("value", [45, 45.5, "A1", True])
def test_cells_typed_as_asked_for_have_none(tmp_path: Path, value: Any) -> None:
    header = ["Breadth [cm]", "Height [cm]", "Against wall" if value is True else "Notes"]
    inventory = read(tmp_path, [["Item", "Floor", *header], ["A1", "1", 40, 180, value]])
    assert (inventory.corrections, inventory.problems) == ((), ())


def test_rows_in_code_are_taken_without_corrections() -> None:
    rows = {"Items": [{"item": "A1", "floor": "1", "breadth": "45 cm", "height": 180}],
            "Floors": [{"floor": "1", "pfa_x": 0.5}]}  # fmt: skip
    inventory = read_inventory(rows)
    assert (inventory.items[0].breadth, inventory.corrections) == (0.45, ())
    assert remarks(inventory, "note") == {
        "Items row 1 Breadth: Breadth [cm]: '45 cm' holds its unit; it is read as 45 cm."
    }


def test_names_with_another_dash_are_the_same(tmp_path: Path) -> None:
    path = write(tmp_path, [["Item", "Floor", "Breadth [cm]", "Height [cm]"], ["A1", "B\u20131", 40, 180]],
                 [["Floor", "PFA X [g]"], ["B-1", 0.5]])  # fmt: skip
    inventory = read_inventory(path)
    assert inventory.items[0].floor == "B-1"
    assert [(one.cell, one.value) for one in inventory.corrections] == [("B2", "B-1")]
    assert remarks(inventory, "note") == {
        "Items!B2: Floor: 'B\u20131' has look-alike signs or digits; it is read as 'B-1'."
    }


def test_a_percentage_is_thought_of_where_a_pfa_is_too_large(tmp_path: Path) -> None:
    path = write(tmp_path, floors=[["Floor", "PFA X [g]"], ["1", 15]])
    assert errors_of(path) == {
        "Floors!B2: PFA X is 15 g, expected 0.0001 to 5 g. Did you mean 15 %g = 0.15 g, or 15 m/s2 = 1.53 g?"
    }


@pytest.mark.parametrize(
    ("text", "plain"),
    [("a\u00a0 b", "a b"), ("\u22121", "-1"), ("１２ｃｍ", "12cm"), ("3\u2019000", "3'000"), ("4²", "4²")],
)
def test_look_alikes_become_plain(text: str, plain: str) -> None:
    assert straighten(text) == plain
