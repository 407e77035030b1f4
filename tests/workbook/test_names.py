"""Names of rows and columns: slips of them, and what they may not hold or share."""

import assess
from assess.workbook.names import find_near_name
from tests.workbook.books import errors_of, remarks, write as write_cells
from tests.workbooks import write


def test_names_that_look_ups_read_as_patterns_and_source_ids_that_are_copied_are_warned_of(tmp_path):
    names = ["B*", "what?", "~1"]
    items = [{"item": f"A{at}", "floor": name, "breadth": 30, "height": 180} for at, name in enumerate(names)]
    path = write(tmp_path / "w.xlsx", items, [{"floor": name, "pfa_x": 0.3} for name in names])
    found = sorted(remarks(assess.read_inventory(path), "warning"))
    for row, (name, warning) in enumerate(zip(names, found, strict=True), 2):
        message = f"Floor '{name}' holds *, ? or ~, which Excel's look-ups read as patterns."
        assert warning.startswith(f"Floors!A{row}: {message}")
    ids = ["2OBrcmyk58NupXoVOHUuXp", "", "2oBrcmyk58NupXoVOHUuXp", "2OBrcmyk58NupXoVOHUuXp", ""]
    sizes = {"floor": "1", "breadth": 40, "height": 180}
    path = write(tmp_path / "w.xlsx", [{"item": f"A{at}", "source_id": one, **sizes} for at, one in enumerate(ids)])
    assert remarks(assess.read_inventory(path), "warning") == {
        "Items!AB5: Source ID '2OBrcmyk58NupXoVOHUuXp' is that of row 2, too. Clear it where the row was copied: which "
        "of the two is in the model is not known."
    }


def test_a_missing_column_of_sizes_is_said_once_and_each_word_of_a_slip_is_near(tmp_path):
    rows = [["Item", "Floor", "Breadth [cm]", "Höhe [cm]"], *([f"i{at}", "1", 30, 180] for at in range(40))]
    assert errors_of(write_cells(tmp_path, rows)) == {
        "Items!A1: the column Height [cm] is missing, and 40 rows, from row 2 on, have no Type that gives it. "
        "Add the column, or give those rows such a Type."
    }
    slips = {
        "try cabinet": "tray cabinet", "tray cabnet": "tray cabinet", "lokcer": "locker", "lockr": "locker",
        "steel shelfing": "steel shelving", "book case tall": "bookcase tall", "locker 2 dors": "locker 2 doors",
        "mystery cabinet": None, "tall cabinet": None, "hat stand": None, "conference cabinet": None,
        "locker 3 doors": None, "bed": None,
    }  # fmt: skip
    assert {typed: find_near_name(typed, TYPES) for typed in slips} == slips


TYPES = ("tray cabinet", "locker", "locker 2 doors", "coat stand", "conference table", "steel shelving",
         "bookcase tall")  # fmt: skip
