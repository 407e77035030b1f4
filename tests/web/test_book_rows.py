"""Rows inserted, deleted and moved in an open workbook: formulas, drop-downs and tables follow; undo is exact."""

import io

import openpyxl
import pytest

from assess.errors import InputError
from assess.web.book import Book, VersionError
from assess.web.live import LiveView
from assess.web.request_errors import RequestError
from assess.workbook.lists import LETTERS, PLACES
from tests.conftest import EXAMPLE
from tests.web.opened import settle, write_office
from tests.workbook.books import write_shared
from tests.workbooks import ITEMS

TABLE = EXAMPLE.parents[1] / "tests" / "data" / "workbooks" / "table.xlsx"
BREADTH = LETTERS["Items", "breadth"]


@pytest.fixture
def book(tmp_path):
    path = write_office(tmp_path / "office.xlsx")
    return Book.open_disk(path)


def change(book, do, at, count=1, to=None, sheet="Items"):
    return book.change_rows(book.version, sheet, do, at, count, to)["rows"]


def items(book):
    cells = book.snapshot().workbook.sheets["Items"]
    return [cells.value((row, 0)) for row in range(2, cells.last_row + 1)]


def saved(book):
    return openpyxl.load_workbook(io.BytesIO(book.write()))


def breadths(page):
    """The rows of a sheet to which a drop-down or a check of the first item's Breadth applies, and its live formula."""
    ranges = [str(one.sqref) for one in page.data_validations.dataValidation if f"{BREADTH}2" in one.sqref]
    return ranges, page[f"{LETTERS['Items', 'B/H']}2"].value


def test_rows_and_edits_are_steps_of_one_history_and_each_step_back_is_exact(book):
    names, before = [one["item"] for one in ITEMS], book.write()
    states = [book.snapshot().workbook]

    def step(*asked):
        assert change(book, *asked) if isinstance(asked[0], str) else book.edit(book.version, list(asked), "typing")
        states.append(book.snapshot().workbook)

    step("insert", 4, 2)
    assert items(book)[:6] == [*names[:2], None, None, *names[2:4]]
    step(["Items", 4, 0, "New"], ["Items", 4, PLACES["Items", "breadth"], "=4*10"])
    step("move", 4, 1, 2)
    assert items(book)[:5] == ["New", *names[:2], None, names[2]]
    step("delete", 5, 1)
    step("insert", 2, 1)
    step("delete", 2, 1)
    assert items(book)[: len(names) + 1] == ["New", *names]
    page = saved(book)["Items"]
    ranges, formula = breadths(page)
    was = breadths(openpyxl.load_workbook(io.BytesIO(before))["Items"])
    last = int(was[0][0].split(BREADTH)[-1])
    assert ranges == [was[0][0].replace(str(last), str(last + 1))]  # the first row is not left out
    assert formula == was[1]
    height = LETTERS["Items", "height"]
    for row in range(2, len(names) + 3):
        assert f"{height}{row}" in page[f"{LETTERS['Items', 'Height used [cm]']}{row}"].value
    again = Book.hold("again.xlsx", book.write(), book.folder).snapshot()
    assert again.inventory.items == book.snapshot().inventory.items
    assert [one.item for one in again.inventory.items] == names  # the new one lacks its sizes
    for workbook in reversed(states[:-1]):
        book.undo(book.version)
        assert book.snapshot().workbook is workbook or book.snapshot().workbook == workbook
    assert book.write() == before
    assert not book.state()["unsaved"]
    for workbook in states[1:]:
        book.redo(book.version)
        assert book.snapshot().workbook == workbook


def test_what_the_page_is_told_lets_it_shift_its_own_rows(book):
    """Shifts in their order, then the cells of rows that came back; live values of all rows but where numbers moved."""
    live = LiveView()
    settle(book)
    first = live.answer(book, None)
    assert change(book, "move", 2, 2, 5) == [["Items", 2, 2, 5]]
    settle(book)
    answer = live.answer(book, first["stamp"])
    assert [answer["items"]["row"], answer["gone"], answer["whole"]] == [[2, 3, 4], [], False]
    assert book.undo(book.version)["rows"] == [["Items", 3, 2, 2]]
    assert change(book, "delete", 3, 2) == [["Items", 3, -2, None]]
    back = book.undo(book.version)
    assert back["rows"] == [["Items", 3, 2, None]]
    told = {(row, at): value for _, row, at, value in back["cells"]}
    assert told[3, 0] == ITEMS[1]["item"]
    assert {row for row, _ in told} == {3, 4}
    # all rows: the first stays, blank, so that what is said of the column holds on
    last = book.snapshot().workbook.sheets["Items"].last_row
    all_rows = change(book, "delete", 2, last - 1)
    assert all_rows == [["Items", 3, 2 - last, None]]
    assert items(book) == [None]
    assert "#REF!" not in "".join(one.attr_text for one in saved(book).defined_names.values())
    assert book.undo(book.version)["rows"] == [["Items", 3, last - 2, None]]
    assert items(book)[: len(ITEMS)] == [one["item"] for one in ITEMS]
    change(book, "insert", 2, sheet="Floors")
    book.edit(book.version, [["Floors", 2, 0, "0"]], "typing")
    again = Book.hold("again.xlsx", book.write(), book.folder).snapshot().inventory
    assert [one.floor for one in again.floors] == [one.floor for one in book.snapshot().inventory.floors]
    assert saved(book).defined_names["list_floors"].attr_text.startswith("Floors!$A$2:")


def test_an_excel_table_keeps_its_rows_and_what_is_not_certain_is_refused_with_its_cell(tmp_path):
    table = Book.hold("table.xlsx", TABLE.read_bytes(), tmp_path)
    before, last = table.write(), table.snapshot().workbook.sheets["Items"].tables[0].area[3]
    change(table, "insert", 2)
    assert saved(table)["Items"].tables.popitem()[1].ref.endswith(str(last + 1))
    with pytest.raises(RequestError, match=r"Items!A\d+: rows cannot be moved into or out of a table") as caught:
        change(table, "move", 2, 1, last + 9)
    assert caught.value.fix
    table.undo(table.version)
    assert table.write() == before
    path = write_shared(tmp_path / "own.xlsx", {"Items": [["Item", "Floor"], ["A1", "1"], ["A2", "1"]]})
    own = Book.open_disk(path)
    refused = (
        ("insert", 1), ("insert", 0, 2), ("delete", 2, 0), ("delete", 100_000, 2), ("move", 2, 1, 3), ("drop", 2),
        ("move", 2, 1, 1), ("move", 2, 1, None), ("insert", 2, 100_000), ("insert", True), ("insert", "2"),
    )  # fmt: skip
    for asked in refused:
        with pytest.raises(InputError):
            change(own, *asked)
    for sheet in ("Building", "Places", "Nowhere"):
        with pytest.raises(InputError):
            change(own, "insert", 2, sheet=sheet)
    with pytest.raises(VersionError):
        own.change_rows(own.version + 1, "Items", "insert", 2, 1)
    assert (own.version, own.state()["can_undo"]) == (1, False)


def test_rows_are_changed_by_a_request_and_saved_with_it(served_here, tmp_path):
    served = served_here(path := write_office(tmp_path / "office.xlsx"))
    ask = {"version": 1, "sheet": "Items", "do": "delete", "at": 2, "count": 1}
    done = served.client.post("/api/rows", ask).json()
    assert (done["rows"], done["state"]["saved_version"], done["state"]["unsaved"]) == (
        [["Items", 2, -1, None]],
        2,
        False,
    )
    assert openpyxl.load_workbook(path)["Items"]["A2"].value == ITEMS[1]["item"]
    refused = served.client.post("/api/rows", {**ask, "version": 2, "at": 1})
    assert (refused.status, refused.json()["message"]) == (422, "These rows do not belong to a table that is read.")
    assert served.client.post("/api/rows", ask).status == 409
    back = served.client.post("/api/undo", {"version": 2}).json()
    assert (back["rows"], back["state"]["saved_version"]) == ([["Items", 2, 1, None]], 3)
    assert openpyxl.load_workbook(path)["Items"]["A2"].value == ITEMS[0]["item"]
