import assess
from assess.workbook.names import find_near_name
from tests.workbook.books import errors_of
from tests.workbook.books import write as write_cells
from tests.workbooks import write


def test_a_name_that_a_look_up_reads_as_a_pattern_is_warned_of(tmp_path):
    names = ["B*", "what?", "~1"]
    items = [{"item": name, "floor": name, "breadth": 30, "height": 180} for name in names]
    path = write(tmp_path / "w.xlsx", items, [{"floor": name, "pfa_x": 0.3} for name in names])
    warnings = [one for one in assess.read_inventory(path).problems if one.severity == "warning"]
    assert {one.place for one in warnings} >= {"Floors!A2", "Floors!A3", "Floors!A4"}
    for name, one in zip(names, [one for one in warnings if one.sheet == "Floors"], strict=True):
        assert f"Floor '{name}' holds *, ? or ~, which Excel's look-ups read as patterns." in one.message


def test_an_axis_that_the_angle_contradicts_is_warned_of(tmp_path):
    items = [{"item": "a", "floor": "1", "breadth": 30, "height": 180, "axis": "X", "angle_deg": 90}]
    (warning,) = [one for one in assess.read_inventory(write(tmp_path / "w.xlsx", items)).problems
                  if one.severity == "warning"]  # fmt: skip
    assert (
        str(warning) == "Items!K2: Axis is X, but an Angle of 90 deg lies along Y; X is used. Correct one of the two."
    )


def test_a_missing_column_of_sizes_is_said_once(tmp_path):
    rows = [["Item", "Floor", "Breadth [cm]", "Höhe [cm]"], *([f"i{at}", "1", 30, 180] for at in range(40))]
    assert errors_of(write_cells(tmp_path, rows)) == {
        "Items!A1: the column Height [cm] is missing, and 40 rows, from row 2 on, have no Type that gives it. "
        "Add the column, or give those rows such a Type."
    }


TYPES = (
    "tray cabinet",
    "locker",
    "locker 2 doors",
    "coat stand",
    "conference table",
    "steel shelving",
    "bookcase tall",
)


def test_each_word_of_a_slip_is_near():
    slips = {
        "try cabinet": "tray cabinet", "tray cabnet": "tray cabinet", "lokcer": "locker", "lockr": "locker",
        "steel shelfing": "steel shelving", "book case tall": "bookcase tall", "locker 2 dors": "locker 2 doors",
        "mystery cabinet": None, "tall cabinet": None, "hat stand": None, "conference cabinet": None,
        "locker 3 doors": None, "bed": None,
    }  # fmt: skip
    assert {typed: find_near_name(typed, TYPES) for typed in slips} == slips
