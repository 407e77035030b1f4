"""One open workbook: what an edit changes in memory and in the bytes, what is refused, and what can be undone."""

import io
import re
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import openpyxl
import pytest

from assess.errors import InputError, WorkbookError
from assess.pipeline.live_values import with_live
from assess.web.book import Book, EditsRefused, VersionError
from assess.workbook.lists import LETTERS, PLACES
from assess.workbook.read import read_inventory
from assess.workbook.schema import LIVE
from assess.workbook.template import Content, write_workbook
from tests.workbook.books import change_parts, replace, write_shared
from tests.workbooks import FLOORS, ITEMS, parts_of

ROWS = {"Building": [{"building": "Hall", "ground_pga": 0.2, "period": 0.8}], "Floors": FLOORS, "Items": ITEMS}
ITEMS_PART = "xl/worksheets/sheet4.xml"


@pytest.fixture(scope="module")
def filled(tmp_path_factory):
    path = tmp_path_factory.mktemp("filled") / "office.xlsx"
    write_workbook(path, with_live(Content(ROWS)), spare=3)
    return path.read_bytes()


@pytest.fixture
def book(filled, tmp_path):
    return Book.hold("office.xlsx", filled, tmp_path)


def at(field, sheet="Items"):
    return PLACES[sheet, field]


def edit(book, *edits):
    return book.edit(book.version, [list(one) for one in edits], "test")


def stored(data, sheet="Items"):
    """What the cells of a sheet store, by address; of formulas their results."""
    page = openpyxl.load_workbook(io.BytesIO(data), data_only=True)[sheet]
    return {cell.coordinate: cell.value for row in page.iter_rows() for cell in row if cell.value is not None}


def cells_of(part):
    """The cells of a sheet as they stand in its XML, by address, and all the rest of it."""
    found = {one[1].decode(): one[0] for one in re.finditer(rb'<c r="([A-Z]+\d+)"[^>]*?(?:/>|>.*?</c>)', part)}
    return found, re.sub(rb'<c r="[A-Z]+\d+"[^>]*?(?:/>|>.*?</c>)', b"", part)


def refusals(book, *edits):
    """Why edits are refused, by cell; nothing may have changed."""
    before, cells = book.state(), book.snapshot().workbook
    with pytest.raises(EditsRefused) as caught:
        edit(book, *edits)
    assert book.state() == before
    assert book.snapshot().workbook is cells
    return {tuple(one[:3]): one[3] for one in caught.value.refused}


def test_without_a_difference_the_very_bytes(book, filled):
    assert book.write() is filled
    edit(book, ("Items", 2, at("height"), 150), ("Floors", 2, at("pfa_x", "Floors"), None))
    assert book.write() != filled
    edit(book, ("Items", 2, at("height"), "200 cm"))
    book.undo(book.version)
    book.undo(book.version)
    assert book.write() is filled
    assert not book.state()["unsaved"]
    edit(book, ("Items", 2, at("height"), 150))
    edit(book, ("Items", 2, at("height"), 200))  # typed back, not undone
    assert book.write() is filled


@pytest.mark.slow
def test_an_edit_changes_its_cell_and_the_live_values_that_follow(book, filled, tmp_path):
    edit(book, ("Items", 3, at("height"), 120))
    after = book.write()
    before, now = parts_of(filled), parts_of(after)
    assert list(before) == list(now)
    assert {name for name in before if before[name] != now[name]} == {ITEMS_PART}
    (old, rest), (new, rest_now) = cells_of(before[ITEMS_PART]), cells_of(now[ITEMS_PART])
    assert rest == rest_now
    changed = {cell for cell in old.keys() | new.keys() if old.get(cell) != new.get(cell)}
    live = {f"{LETTERS['Items', label]}3" for label in LIVE}
    own = f"{LETTERS['Items', 'height']}3"
    assert {own, f"{LETTERS['Items', 'B/H']}3"} <= changed <= live | {own}
    edit(book, ("Floors", 3, at("pfa_x", "Floors"), 0.9))  # that of a floor reaches every live value
    found = stored(book.write())
    items = [ITEMS[0], {**ITEMS[1], "height": 120}, *ITEMS[2:]]
    rows = {**ROWS, "Floors": [FLOORS[0], {**FLOORS[1], "pfa_x": 0.9}], "Items": items}
    write_workbook(tmp_path / "anew.xlsx", with_live(Content(rows)), spare=3)
    anew = stored((tmp_path / "anew.xlsx").read_bytes())
    live = {f"{LETTERS['Items', label]}{row}" for label in LIVE for row in range(2, 7)}
    assert {cell: found.get(cell) for cell in live} == {cell: anew.get(cell) for cell in live}


@pytest.mark.slow
def test_what_the_formulas_tell_and_the_core_leaves_out(book, filled):
    """Where a line of Building is wrong no result is stored: each program computes what the formulas say of that."""
    lines = {one["field"]: one["row"] for one in book.describe()["sheets"][0]["columns"]}
    live = {f"{LETTERS['Items', label]}{row}" for label in LIVE for row in range(2, 7)}
    edit(book, ("Building", lines["logo"], 1, "missing.png"))
    before, found = stored(filled), stored(book.write())
    assert {cell: found.get(cell) for cell in live} == {cell: before.get(cell) for cell in live}
    edit(book, ("Building", lines["period"], 1, "long"))
    assert live.isdisjoint(stored(book.write()))
    book.undo(book.version)
    assert stored(book.write()) == found


def test_what_is_held_is_what_is_written(book, tmp_path):
    edit(
        book,
        *(("Items", 300, at(name), value) for name, value in
          {"item": "Z1", "floor": "2", "breadth": "0,5 m", "height": 190, "anchored": "y", "x": 3}.items()),
        ("Items", 2, at("item"), None), ("Items", 4, at("quantity"), 2.5), ("Places", 2, 0, "Door"),
        ("Places", 2, 1, "1"), ("Building", 1, 1, "<b>Hall</b>"), ("Floors", 4, 0, "3"),
    )  # fmt: skip
    (tmp_path / "after.xlsx").write_bytes(book.write())
    after = read_inventory(tmp_path / "after.xlsx", strict=False)
    held = book.snapshot().inventory
    assert held.items == after.items
    assert held.problems == after.problems
    assert (held.building, held.floors, held.places) == (after.building, after.floors, after.places)
    assert any(item.row == 300 for item in held.items)


TYPED: dict[str, list[tuple[Any, Any]]] = {
    "breadth": [("1m80", 180), ("=18*10", 180), ("= (1,5 + 2.25) / -0.5", -7.5), ("=0.1+0.2", 0.3),
                ("45 cm", 45), ("1,80 m", 180), ("45,5", 45.5), ("18 in", 45.72), ("1'4\"", 40.64),
                ("5 11/16", "5 11/16"), ("wide", "wide"), (True, True), (" ", None), ("", None)],
    "anchored": [("Y", "yes"), ("YES", "YES"), ("maybe", "maybe"), (True, "yes")], "axis": [("x", "x")],
    "item": [("  A  9 ", "A 9"), ("007", "007"), (7, 7)],
    "description": [("  as typed ", "  as typed "), ("=1+1", "=1+1"), ("1,8 m", "1,8 m")], "quantity": [("2", 2)],
    "friction": [("0,35", 0.35)], "height": [("1.234", "1.234")], "notes": [("12", "12")],
}  # fmt: skip


def test_texts_are_taken_as_their_column_asks_and_in_columns_of_the_user(book, tmp_path):
    for field, cases in TYPED.items():
        for typed, kept in cases:
            found = edit(book, ("Items", 2, at(field), typed))["cells"]
            assert found == [["Items", 2, at(field), kept]], (field, typed)
            assert type(found[0][3]) is type(kept), (field, typed)
    path = write_shared(tmp_path / "own.xlsx", {"Items": [["Item", "Floor", "Mine"], ["A1", "1", "mine"]]})
    book = Book.open_disk(path)
    same = ("007", "1e5", "1,5", "nan", "٣", 3.5, "x", True)
    for typed, kept in (("12", 12), ("-0.5", -0.5), *((one, one) for one in same)):
        assert edit(book, ("Items", 2, 2, typed))["cells"] == [["Items", 2, 2, kept]]
        assert stored(book.write())["C2"] == kept


def test_cells_that_cannot_be_edited_formulas_in_place_of_values_and_what_is_no_edit(book):
    good = ("Items", 2, at("breadth"), 50)
    found = refusals(
        book, good, ("Items", 1, 0, "Name"), ("Items", 2, at("B/H"), 1), ("Items", 100_001, 0, "x"),
        ("Items", 2, 256, "x"), ("Items", 2, 200, "x"), ("Items", 0, 0, "x"), ("Items", -3, 0, "x"),
        ("Items", 2, -1, "x"), ("Nowhere", 2, 0, "x"), ("Help", 2, 0, "x"), ("Building", 1, 0, "x"),
        ("Building", 500, 1, "x"), ("Items", 2, 0, "x" * 32_768), ("Items", 3, at("breadth"), float("nan")),
        ("Items", 4, at("breadth"), float("inf")), ("Items", 5, at("breadth"), 10**400),
    )  # fmt: skip
    assert len(found) == 16
    assert tuple(good[:3]) not in found
    assert all(found.values())
    # As a text they would stand there as a wrong number, or as no date.
    fields = [
        ("Items", 2, "quantity"), ("Items", 2, "breadth"), ("Items", 3, "anchored"), ("Building", 0, "report_date"),
    ]  # fmt: skip
    places = [(sheet, *book.sheets[sheet].place(field, row)) for sheet, row, field in fields]
    found = refusals(book, *((*place, " =A1+40") for place in places), ("Items", 2, at("notes"), "=1+40"))
    assert found == dict.fromkeys(places, "Formulas are not supported in this sheet. Enter the result instead.")
    sums = ("=A1", "=2**3", "=1,800*2", "=18*", "=1/0", "=()", "=9//2", "=1e3", "=__import__('os')", "=18*10 cm", "=")
    found = refusals(book, *(("Items", 2 + row, at("breadth"), text) for row, text in enumerate(sums)))
    assert len(found) == len(sums)
    cells: list[Any] = [["Items", 2, 0], ["Items", "2", 0, 1], ["Items", 2.0, 0, 1], ["Items", True, 0, 1]]
    cells += [[None, 2, 0, 1], ["Items", 2, 0, [1]], ["Items", 2, 0, {"a": 1}], ["Items", 2, None, 1]]
    wrong: list[Any] = [None, {}, "x", [1], *([one] for one in cells)]
    for edits in wrong:
        with pytest.raises(InputError, match=r"edits? ha(s|ve) to be a list"):
            book.edit(book.version, edits, "x")
    assert book.version == 1


def test_formulas_merges_arrays_workbooks_that_cannot_be_changed_and_what_is_no_workbook(tmp_path, filled):
    """What a change of the bytes would refuse is refused as it is typed."""
    rows: list[list[Any]] = [["Item", "Floor", "Mine", "Sum"], *([f"A{at}", "1", 1, 2] for at in range(1, 5))]
    path = write_shared(tmp_path / "own.xlsx", {"Items": rows})
    change_parts(path, {
        "xl/worksheets/sheet1.xml": replace('<c r="D2"><v>2</v></c>', '<c r="D2"><f>C2+1</f><v>2</v></c>'),
    })  # fmt: skip
    change_parts(path, {
        "xl/worksheets/sheet1.xml": lambda data: data.replace(
            b'<c r="D3"><v>2</v></c>', b'<c r="D3"><f t="array" ref="D3:D4">C3:C4+1</f><v>2</v></c>').replace(
            b"</sheetData>", b'</sheetData><mergeCells count="1"><mergeCell ref="A5:B5"/></mergeCells>').replace(
            b'<c r="C4"><v>1</v></c>', b'<c r="C4"><v>1</v><odd/></c>'),
    })  # fmt: skip
    book = Book.open_disk(path)
    found = refusals(book, *(("Items", row, at, 9) for row, at in [(2, 3), (3, 3), (4, 3), (5, 1), (4, 2), (5, 2)]))
    assert {cell[1:] for cell in found} == {(2, 3), (3, 3), (4, 3), (5, 1), (4, 2)}
    edit(book, ("Items", 5, 0, "first of the merged"), ("Items", 5, 3, 8))
    assert stored(book.write())["D5"] == 8
    path = tmp_path / "signed.xlsx"
    path.write_bytes(filled)
    book = Book.open_disk(change_parts(path, {"_xmlsignatures/sig1.xml": b"<a/>"}))
    assert "signature" in refusals(book, ("Items", 2, at("breadth"), 50))["Items", 2, at("breadth")]
    assert book.write() == path.read_bytes()
    for data in (b"", b"hello", b"PK\x03\x04rest"):
        with pytest.raises(WorkbookError):
            Book.hold("x.xlsx", data, tmp_path)
    with pytest.raises(WorkbookError, match="the sheet is missing"):
        Book.open_disk(write_shared(tmp_path / "other.xlsx", {"Sheet1": [["a"]]}))


def test_hostile_texts_stay_texts(book, tmp_path):
    """No text becomes a formula, markup or broken XML, and each comes back as it was sent."""
    texts = ["=cmd|' /C calc'!A0", "+1+1", "-1+1", "@SUM(1)", "<script>alert(1)</script>", "a\x00\x07b", "]]>", "&lt;",
             "_x0041_", "\ud800x", "\u202eabc", "x" * 32_767, "=HYPERLINK(\"http://x\")", "\r\n\t", "{=1}"]  # fmt: skip
    edit(book, *(("Items", 10 + row, at("description"), text) for row, text in enumerate(texts)))
    data = book.write()
    letters = LETTERS["Items", "description"]
    page = openpyxl.load_workbook(io.BytesIO(data))["Items"]
    assert not any(page[f"{letters}{10 + row}"].data_type == "f" for row in range(len(texts)))
    shown = {row: value for _, row, _, value in edit(
        book, *(("Items", 10 + row, at("description"), text) for row, text in enumerate(texts)))["cells"]}  # fmt: skip
    for row, text in enumerate(texts):
        if text.isprintable():
            assert shown[10 + row] == text
    again = Book.hold("again.xlsx", data, tmp_path).snapshot().workbook.sheets["Items"]
    held = book.snapshot().workbook.sheets["Items"]
    places = [(10 + row, at("description")) for row in range(len(texts))]
    assert [again.value(place) for place in places] == [held.value(place) for place in places]


def test_undo_and_redo_across_sheets(book):
    first = book.snapshot().workbook
    edit(book, ("Items", 2, at("breadth"), 50), ("Floors", 2, at("pfa_x", "Floors"), 0.7))
    second = book.snapshot().workbook
    edit(book, ("Items", 2, at("breadth"), None))
    assert book.undo(book.version)["cells"] == [["Items", 2, at("breadth"), 50]]
    assert book.snapshot().workbook == second
    found = book.undo(book.version)
    assert sorted(found["cells"]) == [["Floors", 2, at("pfa_x", "Floors"), 0.3], ["Items", 2, at("breadth"), 30]]
    assert book.snapshot().workbook == first
    assert not book.state()["can_undo"]
    assert book.undo(book.version)["cells"] == []
    book.redo(book.version)
    assert book.snapshot().workbook == second
    edit(book, ("Items", 3, at("breadth"), 50))
    assert not book.state()["can_redo"]
    assert book.redo(book.version)["cells"] == []


def test_another_version_is_refused(book):
    edit(book, ("Items", 2, at("breadth"), 50))
    for ask in (lambda: book.edit(1, [["Items", 2, 0, "x"]], "x"), lambda: book.undo(1), lambda: book.redo(99)):
        with pytest.raises(VersionError) as caught:
            ask()
        assert caught.value.state["version"] == 2
    assert edit(book, ("Items", 2, at("breadth"), 50))["state"]["version"] == 2  # nothing changes, no new version


def test_edits_from_many_threads(book):
    """Each edit that is answered is there, and no other."""

    def add(row):
        while True:
            try:
                return book.edit(book.version, [["Items", row, 0, f"T{row}"]], "x")["cells"]
            except VersionError:
                continue

    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(add, range(50, 90)))
    assert found == [[["Items", row, 0, f"T{row}"]] for row in range(50, 90)]
    cells = book.snapshot().workbook.sheets["Items"]
    assert [cells.value((row, 0)) for row in range(50, 90)] == [f"T{row}" for row in range(50, 90)]
    assert book.version == 41


def test_a_snapshot_stays_as_it_is(book):
    now = book.snapshot()
    edit(book, ("Items", 2, at("breadth"), "wrong"))
    assert book.snapshot() is not now
    assert now.inventory.items[0].breadth == 0.3
    assert [item.row for item in book.snapshot().inventory.items] == [3, 4, 5, 6]
    assert [one.cell for one in book.snapshot().problems if one.severity == "error"] == [
        f"{LETTERS['Items', 'breadth']}2"
    ]
    assert [row.number for row in book.snapshot().tables["Items"].rows] == [2, 3, 4, 5, 6]
