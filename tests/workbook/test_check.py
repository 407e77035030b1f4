"""Many faults in one workbook: one run names them all, each with its cell and its mend."""

from datetime import datetime
from pathlib import Path
from typing import Any

import openpyxl

from tests.cli.calling import run
from tests.workbook.books import FLOORS, ITEMS, Sheet, errors_of, problems_of, write, write_book

HEADER = [
    "Item", "Floor", "Type", "Quantity", "Breadth [cm]", "Width [cm]", "Height [cm]", "Axis", "Route", "Notes",
]  # fmt: skip


def row(item: str, **cells: Any) -> list[Any]:
    sound = {"Item": item, "Floor": "1", "Breadth [cm]": 40, "Width [cm]": 80, "Height [cm]": 180}
    named = {next(label for label in HEADER if label.startswith(name)): value for name, value in cells.items()}
    return [(sound | named).get(label) for label in HEADER]


ROWS = [
    row("A2", Height="high"), row("A3", Breadth=-40), row("A4", Height=1.8), row("A5", Floor="9"), row("A2"),
    row("A7", Type="Lokcer", Height=None), row("A8", Axis="Z"), row("A9", Breadth="#DIV/0!"),
    row("A10", Height="=2*90"), row("A11", Notes="merged with the next"), row("A12"), row("A13", Route="R1"),
    row("A14", Route="R2"), row("A15", Breadth="1,385"), row("A16", Width=datetime(2024, 3, 1)), row("A17", Breadth=90),
    row("A18", Quantity=0), row("A19", Quantity=1.5),
]  # fmt: skip
FLOOR_ROWS: Sheet = [
    ["Floor", "Elevaton [m]", "PFA X [m/s3]", "Record X"],
    ["1", 0, 4, None],
    ["2", 4, None, "roof.csv"],
    ["3", 8, None, "../secret/roof.csv"],
]
TYPES: Sheet = [["Type", "Breadth [cm]", "Height [cm]", "breadth [in]"], ["Locker", 30, 180, None]]

EXPECTED = {
    "Items!G2: Height is the text 'high', expected a number [cm]. Type the number alone.",
    "Items!E3: Breadth is -40 cm, expected 5 to 600 cm. Remove the minus sign.",
    "Items!G4: Height is 1.8 cm, expected 5 to 600 cm. Did you mean 1.8 m = 180 cm?",
    "Items!B5: Floor '9' is not in the Floors sheet. Choose one of the Floors sheet, or add it there.",
    "Items!A6: duplicate Item 'A2', also in A2. Give each its own name.",
    "Items!C7: Type 'Lokcer' is not in the Catalogue sheet. Choose one of the Catalogue sheet, or add it there. "
    "Did you mean Locker?",
    "Items!H8: Axis is 'Z', expected one of: X, Y. Choose from the list.",
    "Items!E9: Breadth holds the error #DIV/0!. Correct the formula in the cell, or type the number.",
    "Items!G10: the formula has no saved value. Open the workbook in Excel and save it.",
    "Items!J11:J12: cells are merged inside the table. Unmerge them and fill each cell.",
    "Items!I13: Route 'R1' and others are named in 2 rows, but there is no Routes sheet. "
    "Add the sheet, or clear the column.",
    "Items!E15: Breadth is the text '1,385', which can be read as 1.385 cm or as 1385 cm. "
    "Type the number without a separator between thousands.",
    "Items!F16: Width holds a date or time (2024-03-01 00:00:00), expected a number [cm]. "
    "Set the cell's format to General and type the number again.",
    "Items!E17: Breadth 90 cm is greater than Width 80 cm. Breadth is the shorter plan side: exchange the two.",
    "Items!D18: Quantity is 0, expected a whole number from 1 to 10000. Delete the row if the piece is not there.",
    "Items!D19: Quantity is 1.5, expected a whole number from 1 to 10000. Type a whole number.",
    "Floors!B1: the column 'Elevaton [m]' is not known. Did you mean Elevation [m]?",
    "Floors!C1: the unit 'm/s3' of PFA X is not known. Write the unit that the numbers are in, such as PFA X [g]; known units: g, m/s2, cm/s2, gal.",
    "Floors!D3: the file 'roof.csv' was not found next to the workbook. Check the name, or copy the file there.",
    "Floors!D4: the file '../secret/roof.csv' is outside the workbook's folder. "
    "Copy it next to the workbook and write its name alone.",
    "Catalogue!D1: duplicate column Breadth, also in B1. Delete one of them.",
}


def test_one_run_of_the_command_names_every_fault_and_writes_nothing(tmp_path: Path) -> None:
    path = write(tmp_path, [HEADER, *ROWS], FLOOR_ROWS, Catalogue=TYPES)
    book = openpyxl.load_workbook(path)
    book["Items"].merge_cells("J11:J12")
    book.save(path)
    assert errors_of(path) == EXPECTED
    problems = problems_of(path)
    assert all(one.cell and (one.fix or one.severity == "note") for one in problems)
    severities = [one.severity for one in problems]
    assert severities == sorted(severities, key=["error", "warning", "note"].index)
    before = sorted(tmp_path.rglob("*"))
    done = run("run", str(path), "--out", str(tmp_path / "out"))
    assert done.exit_code == 2
    shown = {line.removeprefix("error").strip() for line in done.stderr.splitlines() if line.startswith("error")}
    assert shown == EXPECTED
    assert f"{len(EXPECTED)} errors; nothing was written." in done.stderr
    assert sorted(tmp_path.rglob("*")) == before


HEADLESS = "no header row was found in the first 20 rows. It needs the headers:"
START = "Add it, or start from a workbook made with `assess new`."


def test_sheets_columns_and_cells_that_are_missing_or_cannot_be_read_are_reported_once(tmp_path: Path) -> None:
    for sheets, errors in (
        ({"Notes": [["hello"]]}, {f"Items: the sheet is missing. {START}", f"Floors: the sheet is missing. {START}"}),
        ({"Items": [*ITEMS, ["A2", "2", 40, 180]], "Places": [["Place", "Floor"]]},
         {f"Floors: the sheet is missing. {START}"}),
        *(({"Items": rows, "Floors": rows}, {f"Items!A1: {HEADLESS} Item, Floor.", f"Floors!A1: {HEADLESS} Floor."})
          for rows in ([], [[None, None]], [["   "]])),
        ({"Items": ITEMS, "Floors": FLOORS, "Places": [["Lift", "1"]]}, {f"Places!A1: {HEADLESS} Place, Floor."}),
        ({"Items": ITEMS[:1], "Floors": FLOORS[:1]}, {"Floors!A2: the table has no rows. Fill in at least one."}),
        ({"Items": ITEMS, "I tems": ITEMS, "Floors": FLOORS},
         {"Items: there are 2 sheets of this name. Delete all but one, or rename them."}),
        *((dict(zip(names, (ITEMS, FLOORS, [["Route", "Segment"]]), strict=True)),
           {f"{near}: there is no sheet named {name}. Did you mean {name}? Rename it."})
          for names, near, name in ((("Itmes", "Floors", "Routes"), "Itmes", "Items"),
                                    (("Items", "Floor", "Routes"), "Floor", "Floors"),
                                    (("Items", "Floors", "Route"), "Route", "Routes"))),
    ):  # fmt: skip
        assert errors_of(write_book(tmp_path / "book.xlsx", sheets)) == errors, (sheets, errors)
    for sheet, header, values, missing in REQUIRED:
        path = write_book(tmp_path / "book.xlsx", {"Items": ITEMS, "Floors": FLOORS, sheet: [header, values]})
        assert errors_of(path) == {
            f"{sheet}!A1: the column {label} is missing. Add it to the header row." for label in missing
        }
    items = [[*ITEMS[0], "Notes"], ["\u200e", "1", 40, 180], ["A2", None, 40, 180], ["A3", "1", None, None, "new"]]
    assert errors_of(write(tmp_path, items)) == {
        "Items!A2: Item is blank. Fill it in, or delete the row.",
        "Items!B3: Floor is blank. Fill it in, or delete the row.",
        "Items!C4: Breadth is blank and no Type gives it. Fill it in, or choose a Type that has one.",
        "Items!D4: Height is blank and no Type gives it. Fill it in, or choose a Type that has one.",
    }
    # A size that cannot be read is not reported as missing, too; nor is a floor whose PFA cannot be read.
    path = write(tmp_path, [ITEMS[0], ["A1", "1", "wide", 180]], [FLOORS[0], ["1", "strong"]])
    assert errors_of(path) == {
        "Items!C2: Breadth is the text 'wide', expected a number [cm]. Type the number alone.",
        "Floors!B2: PFA X is the text 'strong', expected a number [g]. Type the number alone.",
    }


REQUIRED: list[tuple[str, list[Any], list[Any], list[str]]] = [
    ("Items", ["Floor", "Breadth [cm]", "Height [cm]"], ["1", 40, 180], ["Item"]),
    ("Items", ["Breadth [cm]", "Height [cm]"], [40, 180], ["Item", "Floor"]),
    ("Floors", ["PFA X [g]"], [0.5], ["Floor"]), ("Catalogue", ["Source", "Breadth [cm]"], ["here", 40], ["Type"]),
    ("Places", ["Floor", "X [m]"], ["1", 2], ["Place"]), ("Places", ["Place", "X [m]"], ["Lift", 2], ["Floor"]),
    ("Routes", ["Segment", "Floor"], ["S1", "1"], ["Route"]), ("Routes", ["Route", "Floor"], ["R1", "1"], ["Segment"]),
]  # fmt: skip
