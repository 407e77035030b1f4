"""What the sheets show: many rows, sorted and filtered rows, widths, series, a phone, what axe-core says."""

import re

import pytest
from playwright.sync_api import expect

from tests.web.opened import write_office
from tests.web.sheet_page import TWO_FRAMES, opened

pytestmark = [pytest.mark.browser, pytest.mark.slow]
HEIGHTS = {"B": 150, "a": 90, "C": 210, "d": None, "E": 90}


@pytest.fixture
def sorted_items(page, served_here, tmp_path):
    items = [
        {"item": name, "floor": "1", "room": room, "breadth": 40, "width": 80, "height": height}
        for (name, height), room in zip(HEIGHTS.items(), ("Hall", "Store", "Hall", "Hall", ""), strict=True)
    ]
    return opened(page, served_here(write_office(tmp_path / "office.xlsx", items))).open("Items")


def names_shown(sheet):
    """Return the items in sight from the top, without the blank rows at the end."""
    sheet.page.evaluate(TWO_FRAMES)
    rows = sheet.grid.locator(".grid-row:not([hidden]):not(.grid-head)")
    found = rows.evaluate_all("""all => all.map((row) => [Number(row.getAttribute("aria-rowindex")),
        row.querySelector("[aria-colindex='2']").textContent]).sort((a, b) => a[0] - b[0])""")
    return [name for _, name in found if name]


def choose(sheet, label, *buttons):
    sheet.head(label).get_by_role("button").click()
    for one in buttons:
        sheet.page.locator(".grid-menu").get_by_role("button", name=one, exact=True).click()


def test_sorted_filtered_and_found_rows_leave_the_file_as_it_is(sorted_items):
    sheet = sorted_items
    before = sheet.server.client.get("/api/download").data
    line = sheet.page.locator(".sheet-order")
    choose(sheet, "Item", "Sort descending")
    assert names_shown(sheet) == ["E", "d", "C", "B", "a"]
    choose(sheet, "Height", "Sort ascending")
    expect(line).to_contain_text("5 of 5 rows; sorted by Height")
    assert names_shown(sheet) == ["a", "E", "B", "C", "d"]
    choose(sheet, "Room", "None")
    sheet.page.locator(".grid-menu").get_by_label("Hall").check()
    sheet.page.locator(".grid-menu").get_by_role("button", name="Filter", exact=True).click()
    expect(line).to_contain_text("3 of 5 rows; sorted by Height; filtered by Room")
    assert names_shown(sheet) == ["B", "C", "d"]
    sheet.head("Item").get_by_role("button").click()
    sheet.page.get_by_placeholder("contains").fill("c")
    sheet.keyboard.press("Enter")
    assert names_shown(sheet) == ["C"]
    sheet.type("<Control+f>", "hall")
    expect(sheet.page.locator(".grid-find-count")).to_have_text("1 of 1")
    sheet.type("<Escape>")
    expect(sheet.page.locator("#grid-active")).to_have_text("Hall")
    line.get_by_role("button", name="Show all").click()
    expect(line).to_be_hidden()
    assert names_shown(sheet) == list(HEIGHTS)
    sheet.type("<Control+f>", "hall", "<Enter>", "<Enter>", "<Shift+Enter>")
    expect(sheet.page.locator(".grid-find-count")).to_have_text(re.compile("[123] of 3"))
    assert sheet.server.client.get("/api/download").data == before


def test_an_edit_in_sorted_rows_reaches_its_row_and_nothing_jumps(sorted_items):
    sheet = sorted_items
    choose(sheet, "Height", "Sort ascending")
    sheet.select("Height", 3).type("300", "<Enter>").settle()
    assert names_shown(sheet) == ["a", "E", "B", "C", "d"]
    assert sheet.values("Items", "height")[3] == 300
    sheet.page.get_by_role("button", name="Add a row").click()
    sheet.type("new", "<Enter>").settle()
    assert names_shown(sheet) == ["a", "E", "B", "C", "d", "new"]
    assert sheet.values("Items", "item")[7] == "new"
    sheet.page.get_by_role("button", name="Sort and filter again", exact=True).click()
    assert names_shown(sheet) == ["E", "B", "C", "a", "d", "new"]


def test_the_fill_handle_continues_a_series_and_copies_with_ctrl(sorted_items):
    sheet = sorted_items

    def drag(label, first, last, to, *held):
        sheet.select(label, first, label, last)
        handle = sheet.page.locator(".grid-handle").bounding_box()
        goal = sheet.cell(label, to).bounding_box()
        sheet.page.mouse.move(handle["x"] + 4, handle["y"] + 4)
        sheet.page.mouse.down()
        sheet.page.mouse.move(goal["x"] + 20, goal["y"] + 12, steps=4)
        for key in held:
            sheet.keyboard.down(key)
        sheet.page.mouse.up()
        for key in held:
            sheet.keyboard.up(key)
        sheet.settle()

    sheet.select("Item", 7).type("R08", "<Enter>").select("Room", 7).type("Room 1", "<Enter>")
    sheet.select("Quantity", 7).type("1", "<Enter>", "3", "<Enter>").settle()
    drag("Item", 7, 7, 10)
    drag("Room", 7, 7, 9)
    drag("Quantity", 7, 8, 10)
    drag("Height", 2, 2, 4)
    drag("Width", 6, 6, 8, "Control")
    assert [sheet.values("Items", "item")[row] for row in range(7, 11)] == ["R08", "R09", "R10", "R11"]
    assert [sheet.values("Items", "room")[row] for row in range(7, 10)] == ["Room 1", "Room 2", "Room 3"]
    assert [sheet.values("Items", "quantity")[row] for row in range(7, 11)] == [1, 3, 5, 7]
    assert [sheet.values("Items", "height")[row] for row in range(2, 5)] == [150, 150, 150]
    assert [sheet.values("Items", "width")[row] for row in range(6, 9)] == [80, 81, 82]


def test_rows_are_duplicated_and_cleared(sorted_items):
    sheet = sorted_items
    sheet.cell("Room", 2).dblclick()
    sheet.type(" A", "<Enter>").settle()
    assert sheet.values("Items", "room")[2] == "Hall A"
    sheet.select("Item", 2).page.get_by_role("button", name="Duplicate rows").click()
    sheet.settle()
    assert sheet.cells("Items", 7)[0] == "B 2"
    assert sheet.cells("Items", 7)[2:] == sheet.cells("Items", 2)[2:]
    sheet.select("Item", 3, "Item", 4).type("<Shift+F10>").page.get_by_role("menuitem", name="Clear rows").click()
    sheet.settle()
    assert sheet.values("Items", "item") == {2: "B", 5: "d", 6: "E", 7: "B 2"}
