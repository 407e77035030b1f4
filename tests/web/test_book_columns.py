"""What the page is told of sheets, columns and cells, in the language and the units of the workbook."""

import datetime
import json

import pytest

from assess.i18n import load_catalogue, speaking
from assess.web.book import Book, EditsRefused
from assess.web.columns import show
from assess.workbook.open import UNSAVED, Percent
from assess.workbook.read import read_inventory
from assess.workbook.template import Content, write_workbook
from tests.web.opened import write_template
from tests.workbook.books import write_shared
from tests.workbooks import FLOORS, ITEMS

ROWS = {"Building": [{"building": "Hall"}], "Floors": FLOORS, "Items": ITEMS}


def describe(book):
    """What the page gets, as it gets it: through JSON."""
    found = json.loads(json.dumps(book.describe(), allow_nan=False))
    return found, {one["name"]: one for one in found["sheets"]}


def columns(sheet):
    return {one["field"]: one for one in sheet["columns"] if one["field"]}


def test_an_italian_workbook_round_trips(tmp_path):
    rows = ROWS | {"Items": [{"item": "A1", "floor": "1", "breadth": 40, "height": 180, "anchored": "no"}]}
    with speaking(load_catalogue("it")):
        write_workbook(tmp_path / "libro.xlsx", Content(rows), spare=3)
    book = Book.open_disk(tmp_path / "libro.xlsx")
    found, sheets = describe(book)
    assert (found["language"], found["units"]) == ("it", "si")
    assert sheets["Items"]["title"] == "Arredi"
    anchored, height, item = (columns(sheets["Items"])[name] for name in ("anchored", "height", "item"))
    assert {"sì", "no"} < {*anchored["choices"]}
    assert anchored["label"] == "Ancorato"
    shaking = columns(sheets["Building"])["shaking"]
    assert any("molto forte" in one for one in shaking["choices"])
    edits = [["Items", 2, anchored["at"], "si"], ["Items", 2, height["at"], "1,95 m"], ["Items", 3, item["at"], "A2"],
             ["Building", shaking["row"], 1, shaking["choices"][2]]]  # fmt: skip
    assert [one[3] for one in book.edit(1, edits, "x")["cells"]] == ["sì", 195, "A2", shaking["choices"][2]]
    book.save()
    again = read_inventory(tmp_path / "libro.xlsx", strict=False)
    assert again.language == "it"
    assert (again.items[0].anchored, again.items[0].height) == ("yes", 1.95)
    assert again.building.shaking


def test_a_workbook_of_ones_own(tmp_path):
    """Titles above, columns in another order, own columns, headers that are wrong, sheets that are missing."""
    path = write_shared(tmp_path / "own.xlsx", {
        "Items": [["My furniture"], [],
                  [None, "Height [mm]", "Colour", "Floor", "Item", "Breadth [yards]", None, "Mine"],
                  [None, 1800, "red", "1", "A1", 3], [], ["Second room"], [None, 900, None, "1", "A2", 4, "stray"]],
        "Ledger": [["a"]],
    })  # fmt: skip
    found, sheets = describe(book := Book.open_disk(path))
    items = sheets["Items"]
    assert (items["header_row"], items["last_row"], items["frozen"]) == (3, 7, 1)
    assert [(one["at"], one["kind"], one["label"]) for one in items["columns"]] == [
        (0, "own", "A"), (1, "number", "Height"), (2, "own", "Colour"), (3, "text", "Floor"), (4, "text", "Item"),
        (5, "number", "Breadth"), (6, "own", "G"), (7, "own", "Mine"),
    ]  # fmt: skip
    assert columns(items)["height"]["factor"] == 0.001
    assert items["columns"][5]["unit"] == "yards"
    assert [row[0] for row in items["rows"]] == [4, 6, 7]
    assert not sheets["Floors"]["found"]
    assert found["units"] == "si"
    with pytest.raises(EditsRefused, match="lacks this sheet"):
        book.edit(1, [["Floors", 2, 0, "1"]], "x")
    book.edit(1, [["Items", 7, 2, "blue"], ["Items", 8, 4, "A3"], ["Items", 4, 5, "12 in"]], "x")
    book.save()
    again = describe(Book.open_disk(path))[1]["Items"]["rows"]
    assert again[0] == [4, [None, 1800, "red", "1", "A1", "12 in"]]
    assert again[2:] == [[7, [None, 900, "blue", "1", "A2", 4, "stray"]], [8, [None, None, None, None, "A3"]]]


def test_a_date_in_a_cell_and_cells_as_json_has_them(tmp_path):
    items = [["Item", "Floor", "When"], ["A1", "1", datetime.date(2024, 5, 1)]]
    form = [["Report date", datetime.date(2024, 6, 1)]]
    rows = {"Items": items, "Building": form}
    path = write_shared(tmp_path / "own.xlsx", rows, default_date_format="yyyy-mm-dd")
    book = Book.open_disk(path)
    _, sheets = describe(book)
    assert sheets["Items"]["rows"] == [[2, ["A1", "1", "2024-05-01"]]]
    book.edit(1, [["Items", 2, 2, "2 May"], ["Building", 1, 1, "1 July 2024"]], "x")
    book.save()
    assert read_inventory(path, strict=False).building.report_date == "2024-07-01"
    book.undo(2)
    book.save()
    # the cells hold dates again
    assert describe(Book.open_disk(path))[1]["Items"]["rows"] == [[2, ["A1", "1", "2024-05-01"]]]
    assert read_inventory(path, strict=False).building.report_date == "2024-06-01"
    for value, shown in (
        (None, None), (UNSAVED, None), (Percent(0.25), 0.25), (datetime.datetime(2024, 5, 1), "2024-05-01"),
        (datetime.datetime(2024, 5, 1, 12), "2024-05-01T12:00:00"), (datetime.timedelta(hours=30), "1 day, 6:00:00"),
        (float("inf"), "inf"), (True, True), (0, 0), ("text", "text"),
    ):  # fmt: skip
        assert (show(value), type(show(value))) == (shown, type(shown))


def test_an_imperial_workbook_round_trips(tmp_path):
    floors = [{"floor": "1", "pfa_x": 0.3, "elevation": 10}]
    items = [{"item": "A1", "floor": "1", "breadth": 16, "height": 72, "x": 3}]
    book = Book.open_disk(write_template(tmp_path / "book.xlsx", {"Floors": floors, "Items": items}, "imperial"))
    found, sheets = describe(book)
    assert found["units"] == "imperial"
    height, x = columns(sheets["Items"])["height"], columns(sheets["Items"])["x"]
    assert (height["unit"], height["factor"], x["unit"], x["factor"]) == ("in", 0.0254, "ft", 0.3048)
    edits = [["Items", 2, height["at"], "2 m"], ["Items", 2, x["at"], "4"]]
    assert [one[3] for one in book.edit(1, edits, "x")["cells"]] == [78.7402, 4]
    book.save()
    again = read_inventory(tmp_path / "book.xlsx", strict=False).items[0]
    assert again.height == pytest.approx(2, rel=1e-5)
    assert again.x == pytest.approx(4 * 0.3048)
