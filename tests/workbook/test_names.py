import pytest

import assess
from assess.workbook.names import find_near_name
from tests.workbooks import write


@pytest.mark.parametrize("name", ["B*", "what?", "~1"])
def test_a_name_that_a_look_up_reads_as_a_pattern_is_warned_of(tmp_path, name):
    path = write(tmp_path / "w.xlsx", [{"item": "a", "floor": name, "breadth": 30, "height": 180}],
                 [{"floor": name, "pfa_x": 0.3}])  # fmt: skip
    (warning,) = [one for one in assess.read_inventory(path).problems if one.severity == "warning"]
    assert warning.place == "Floors!A2"
    assert f"Floor '{name}' holds *, ? or ~, which Excel's look-ups read as patterns." in warning.message


def test_a_pfv_without_its_pfa_is_an_error(tmp_path):
    """It would not be used, and tells of shaking that the PFA then does not."""
    path = write(tmp_path / "w.xlsx", None, [{"floor": "1", "pfa_x": 0.5, "pfv_y": 300}, {"floor": "2", "pfa_x": 0.3}])
    with pytest.raises(assess.WorkbookError, match=r"Floors!G2: PFV Y is filled in without PFA Y .* Fill in PFA Y"):
        assess.read_inventory(path)


def test_an_axis_that_the_angle_contradicts_is_warned_of(tmp_path):
    items = [{"item": "a", "floor": "1", "breadth": 30, "height": 180, "axis": "X", "angle_deg": 90}]
    (warning,) = [one for one in assess.read_inventory(write(tmp_path / "w.xlsx", items)).problems
                  if one.severity == "warning"]  # fmt: skip
    assert (
        str(warning) == "Items!K2: Axis is X, but an Angle of 90 deg lies along Y; X is used. Correct one of the two."
    )


def test_a_missing_column_of_sizes_is_said_once(tmp_path):
    import openpyxl

    path = write(tmp_path / "w.xlsx", [{"item": f"i{at}", "floor": "1", "breadth": 30} for at in range(40)])
    book = openpyxl.load_workbook(path)
    book["Items"]["J1"] = "Höhe [cm]"
    book.save(path)
    with pytest.raises(assess.WorkbookError) as caught:
        assess.read_inventory(path)
    errors = [str(one) for one in caught.value.problems if one.severity == "error"]
    assert errors == [
        "Items!A1: the column Height [cm] is missing, and 40 rows, from row 2 on, have no Type that gives it. "
        "Add the column, or give those rows such a Type."
    ]


@pytest.mark.parametrize(("unit", "factor"), [("inch", 2.54), ("inches", 2.54), ("feet", 30.48)])
def test_units_written_out_are_understood(tmp_path, unit, factor):
    import openpyxl

    path = write(tmp_path / "w.xlsx", [{"item": "a", "floor": "1", "breadth": 30, "height": 4.5}])
    book = openpyxl.load_workbook(path)
    book["Items"]["J1"] = f"Height [{unit}]"
    book["Items"]["J2"] = 180 / factor
    book.save(path)
    assert assess.read_inventory(path).items[0].height == pytest.approx(1.8)


TYPES = (
    "tray cabinet",
    "locker",
    "locker 2 doors",
    "coat stand",
    "conference table",
    "steel shelving",
    "bookcase tall",
)


@pytest.mark.parametrize(
    ("typed", "meant"),
    [("try cabinet", "tray cabinet"), ("tray cabnet", "tray cabinet"), ("lokcer", "locker"), ("lockr", "locker"),
     ("steel shelfing", "steel shelving"), ("book case tall", "bookcase tall"), ("locker 2 dors", "locker 2 doors"),
     ("mystery cabinet", None), ("tall cabinet", None), ("hat stand", None), ("conference cabinet", None),
     ("locker 3 doors", None), ("bed", None)],
)  # fmt: skip
def test_each_word_of_a_slip_is_near(typed, meant):
    assert find_near_name(typed, TYPES) == meant


def test_a_poor_guess_is_not_made(tmp_path):
    path = write(tmp_path / "w.xlsx", [{"item": "a", "floor": "1", "type": "Mystery cabinet"}])
    with pytest.raises(assess.WorkbookError) as caught:
        assess.read_inventory(path)
    assert "Type 'Mystery cabinet' is not in the Catalogue sheet." in str(caught.value)
    assert "Did you mean" not in str(caught.value)
