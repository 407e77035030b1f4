"""The index: columns by name, numbers of many countries, and errors that name the line."""

import pytest

from assess.errors import InputError
from assess.portfolio.index_file import read_index

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


def test_columns_stand_in_any_order_and_blanks_are_not_known(tmp_path):
    one, other = _read(tmp_path, "# made by hand\n\nLatitude,PATH,longitude\n37.8,a.xlsx,-122\n,b.xlsx,\n")
    assert (one.latitude, one.line) == (37.8, 4)
    assert other.as_building() == {}


@pytest.mark.parametrize("mark", [";", "\t"])
def test_semicolons_and_tabs_go_with_decimal_commas(tmp_path, mark):
    text = "path|latitude|longitude|building\na.xlsx|37,8|-122,4|Rossi, Bianchi\n"
    (row,) = _read(tmp_path, text.replace("|", mark))
    assert (row.latitude, row.longitude, row.building) == (37.8, -122.4, "Rossi, Bianchi")


def test_latin_1_is_read(tmp_path):
    assert _read(tmp_path, "building\nCafé\n", "latin-1")[0].building == "Café"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("path,lattitude\na.xlsx,1\n", r"index.csv: line 1: 'lattitude' is an unknown column. Did you mean latitude\?"),
        ("path,colour\na.xlsx,1\n", "line 1: 'colour' is an unknown column, expected some of: path, building"),
        ("path,path\na.xlsx,1\n", "line 1: the column path is there twice"),
        ("latitude,longitude\n1,2\n", "line 1: expected the column path, or building"),
        ("path\n", "no building is listed below the headings"),
        ("", r"index.csv: the index is empty\. Its first line holds the names of the columns"),
        ("\n# a comment\n", "the index is empty"),
        ("path,latitude,longitude\na.xlsx,91,0\n", "line 2: latitude is 91, expected -90 to 90"),
        ("path,latitude,longitude\na.xlsx,nan,0\n", "line 2: latitude is 'nan', not a number"),
        ("path,latitude,longitude\na.xlsx,1e999,0\n", "line 2: latitude is inf"),
        ("path,latitude\na.xlsx,1\n", "line 2: give both latitude and longitude, or neither"),
        ("path,storeys\na.xlsx,2.5\n", "line 2: storeys is 2.5, expected a whole number"),
        ("path,storeys\na.xlsx,0\n", "line 2: storeys is 0, expected 1 to 300"),
        ("path,ground_pga_g\na.xlsx,40\n", "line 2: ground_pga_g is 40, expected"),
        ("path,floor_area_m2\na.xlsx,-5\n", "line 2: floor_area_m2 is -5"),
        ("path\na.xlsx,b\n", "line 2: there are more cells than headings"),
        ("path,use\n,office\n", "line 2: give a path, or the name of a building without a survey"),
        ("path\na.xlsx\n./a.xlsx\n", "line 2: 'a.xlsx' is listed more than once"),
        ("building\nHall\nHall\n", "line 3: 'Hall' is listed more than once"),
        ("path,building\na.xlsx,\n,a.xlsx\n", "line 3: 'a.xlsx' is also the path of a workbook"),
        (b"PK\x03\x04", "not plain text. Save it as CSV UTF-8"),
        ("building\n" + "x" * 5000 + "\n", "line 2: a cell is longer than 4,000 characters"),
    ],
)
def test_a_slip_is_named_with_its_line(tmp_path, text, message):
    with pytest.raises(InputError, match=message):
        _read(tmp_path, text)


def test_all_slips_are_named_at_once_up_to_a_limit(tmp_path):
    with pytest.raises(InputError) as caught:
        _read(tmp_path, "path,storeys\n" + "".join(f"{at}.xlsx,x\n" for at in range(30)))
    assert str(caught.value).count("not a number") == 20
    assert str(caught.value).endswith("and 10 more.")


def test_a_slip_is_told_once_and_together_with_those_of_names(tmp_path):
    with pytest.raises(InputError) as caught:
        _read(tmp_path, "path,latitude,longitude\na.xlsx,95,10\na.xlsx,x,10\n,,\n,1,2\n")
    assert str(caught.value).split("\n") == [
        "index.csv: line 2: latitude is 95, expected -90 to 90.",
        "line 3: latitude is 'x', not a number.",
        "line 5: give a path, or the name of a building without a survey.",
        "line 2: 'a.xlsx' is listed more than once.",
        "line 3: 'a.xlsx' is listed more than once.",
    ]


def test_a_missing_index_is_named(tmp_path):
    with pytest.raises(InputError, match=r"index\.csv: the index cannot be read: No such file"):
        read_index(tmp_path / "index.csv")
