"""The index: columns by name, numbers of many countries, and errors that name the line."""

import pytest

from assess.errors import InputError
from assess.portfolio.sources import read_index
from tests.refusals import check_refusals

HEAD = "path,building,latitude,longitude,use,storeys,height_m,floor_area_m2,ground_pga_g\n"


def _read(tmp_path, text, encoding="utf-8"):
    file = tmp_path / "index.csv"
    file.write_bytes(text if isinstance(text, bytes) else text.encode(encoding))
    return read_index(file)


def test_a_row_fills_in_the_sheet_building(tmp_path):
    (row,) = _read(tmp_path, HEAD + 'a.xlsx,"Hall, east",37.8,-122.4,Office,5,20.5,1000,0.4\n', "utf-8-sig")
    assert (row.line, row.path, row.floor_area_m2) == (2, "a.xlsx", 1000.0)
    assert row.as_building() == {
        "building": "Hall, east", "latitude": 37.8, "longitude": -122.4, "use": "Office", "storeys": 5, "height": 20.5,
        "ground_pga": 0.4,
    }  # fmt: skip


def test_semicolons_and_tabs_go_with_decimal_commas_and_latin_1_is_read(tmp_path):
    text = "path|latitude|longitude|building\na.xlsx|37,8|-122,4|Rossi, Café\n"
    for mark in (";", "\t"):
        (row,) = _read(tmp_path, text.replace("|", mark), "latin-1")
        assert (row.latitude, row.longitude, row.building) == (37.8, -122.4, "Rossi, Café")


def test_a_slip_is_named_with_its_line(tmp_path):
    check_refusals(InputError, lambda text: _read(tmp_path, text), [
        ("path,lattitude\na.xlsx,1\n", r"index.csv: line 1: 'lattitude' is an unknown column. Did you mean latitude\?"),
        ("path,colour\na.xlsx,1\n", "line 1: 'colour' is an unknown column, expected some of: path, building"),
        ("path,path\na.xlsx,1\n", "line 1: the column path is there twice"),
        ("latitude,longitude\n1,2\n", "line 1: expected the column path, or building"),
        ("path\n", "no building is listed below the headings"),
        ("", r"index.csv: the index is empty\. Its first line holds the names of the columns"),
        ("path,latitude,longitude\na.xlsx,91,0\n", "line 2: latitude is 91, expected -90 to 90"),
        ("path,latitude,longitude\na.xlsx,nan,0\n", "line 2: latitude is 'nan', not a number"),
        ("path,latitude\na.xlsx,1\n", "line 2: give both latitude and longitude, or neither"),
        ("path,storeys\na.xlsx,2.5\n", "line 2: storeys is 2.5, expected a whole number"),
        ("path,ground_pga_g\na.xlsx,40\n", "line 2: ground_pga_g is 40, expected"),
        ("path\na.xlsx,b\n", "line 2: there are more cells than headings"),
        ("path,use\n,office\n", "line 2: give a path, or the name of a building without a survey"),
        ("path\na.xlsx\n./a.xlsx\n",
         r"^index\.csv: lines 2 and 3 list the same workbook, a\.xlsx: keep one of them\.$"),
        ("path\n" + 13 * "a.xlsx\n", r"lines 2, 3, 4, 5, 6, 7, 8, 9, 10, 11 and 3 more list the same workbook"),
        ("building\nHall\nHall\n", "lines 2 and 3 list the same building without a workbook, Hall: keep one of them"),
        ("path,building\na.xlsx,\n,a.xlsx\n", "line 3: 'a.xlsx' is also the path of a workbook"),
        (b"PK\x03\x04", "not plain text. Save it as CSV UTF-8"),
        ("building\n" + "x" * 5000 + "\n", "line 2: a cell is longer than 4,000 characters"),
        # quotation marks that do not pair, and line breaks in cells
        ('path,building\na.xlsx,"Old town hall\nb.xlsx,Library\n', "line 2: a quotation mark is not closed"),
        ('path,building\na.xlsx,x\nb.xlsx,"Old\ntown hall"\n', "line 3: .* a cell cannot hold a line break"),
        ('path,building\r\na.xlsx,"Old\rtown"\r\n', "line 2: .* a cell cannot hold a line break"),
        ('path,building\na.xlsx,"Old" hall\n',
         "line 2: characters follow a closing quotation mark. Write a quotation"),
        ("path\n" + "x" * 200_000, "line 2 cannot be read: field larger"),
    ])  # fmt: skip


def test_quotation_marks_in_comments_and_inside_of_cells_are_no_slips(tmp_path):
    text = '# a, "note\n"# another, one"\npath,building\na.xlsx,Hall "A\nb.xlsx,"The ""Hall"", east"\n'
    assert [(one.line, one.building) for one in _read(tmp_path, text)] == [(4, 'Hall "A'), (5, 'The "Hall", east')]


def test_a_number_that_can_be_read_in_two_ways_is_refused_with_both(tmp_path):
    head = HEAD.replace(",", ";")
    check_refusals(InputError, lambda typed: _read(tmp_path, f"{head};Semi;37,7;-122,4;office;3;10,5;{typed};\n"), [
        ("25.000", r"line 2: floor_area_m2: 25\.000 can be 25 or 25,000: write 25 or 25000\."),
        ("25,000", r"line 2: floor_area_m2: 25,000 can be 25 or 25,000: write 25 or 25000\."),
        ("25.125", r"25\.125 can be 25\.125 or 25,125: write 25\.1250 or 25125\."),
    ])  # fmt: skip


def test_a_number_that_can_be_read_in_one_way_within_the_range_is_read(tmp_path):
    for name, typed, number in (
        ("latitude", "37.789", 37.789), ("longitude", "\u2212122,419", -122.419), ("ground_pga_g", "0,150", 0.15),
        ("height_m", "10.500", 10.5), ("floor_area_m2", "25.000,5", 25000.5),
        ("floor_area_m2", "1.250.000", 1250000.0), ("floor_area_m2", "25 000", 25000.0),
        ("floor_area_m2", "2.5e3", 2500.0),
    ):  # fmt: skip
        other = {"latitude": "longitude", "longitude": "latitude"}.get(name, "use")
        assert getattr(_read(tmp_path, f"path;{name};{other}\na.xlsx;{typed};1\n")[0], name) == number, typed
    with pytest.raises(InputError, match=r"line 2: height_m is 1050\.5, expected 2 to 1000"):
        _read(tmp_path, "path;height_m;use\na.xlsx;1.050,5;1\n")


def test_a_slip_is_told_once_and_together_with_those_of_names(tmp_path):
    with pytest.raises(InputError) as caught:
        _read(tmp_path, "path,latitude,longitude\na.xlsx,95,10\na.xlsx,x,10\n,,\n,1,2\n")
    assert str(caught.value).split("\n") == [
        "index.csv: line 2: latitude is 95, expected -90 to 90.",
        "line 3: latitude is 'x', not a number.",
        "line 5: give a path, or the name of a building without a survey.",
        "lines 2 and 3 list the same workbook, a.xlsx: keep one of them.",
    ]
    with pytest.raises(InputError, match=r"and 10 more\.$"):
        _read(tmp_path, "path,storeys\n" + "".join(f"{at}.xlsx,x\n" for at in range(30)))
    with pytest.raises(InputError, match=r"gone\.csv: the index cannot be read: No such file"):
        read_index(tmp_path / "gone.csv")
