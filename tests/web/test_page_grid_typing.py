"""Typing into the sheets: classes that follow, lists, problems in their cells, keys alone, undo."""

import html
import re
import shutil

import pytest
from playwright.sync_api import expect

from tests.conftest import EXAMPLE
from tests.web.opened import write_office
from tests.web.sheet_page import CLASS, opened
from tests.workbooks import ITEMS

pytestmark = [pytest.mark.browser, pytest.mark.slow]

BLANK = EXAMPLE.with_name("blank.xlsx")


def tab_to(sheet, selector, key="Tab"):
    for _ in range(30):
        if sheet.page.locator(f"{selector}:focus").count():
            return
        sheet.keyboard.press(key)
    raise AssertionError(f"{selector} cannot be reached by {key}")


def edit_elsewhere(sheet, room):
    client = sheet.server.client
    version = client.get("/api/book").json()["version"]
    done = client.post("/api/edit", {"version": version, "edits": [["Items", 2, 3, room]], "label": ""})
    assert done.status == 200, done.data


def test_a_first_piece_by_keyboard_alone(page, served_here, tmp_path):
    shutil.copy(BLANK, tmp_path / "new.xlsx")
    sheet = opened(page, served_here(tmp_path / "new.xlsx"))
    tab_to(sheet, "[role=tab]", "Shift+Tab")
    for _ in range(7):
        if sheet.page.locator("[data-sheet=Floors]:focus").count():
            break
        sheet.type("<ArrowRight>")
    tab_to(sheet, ".grid-input")
    sheet.type("1", "<Tab>", "Ground", "<Tab>", "<Tab>", "0.4", "<Tab>", "0.4", "<Tab>", "40", "<Enter>")
    sheet.type("<Escape>")
    tab_to(sheet, "[role=tab]", "Shift+Tab")
    sheet.type("<ArrowRight>")
    tab_to(sheet, ".grid-input")
    sheet.type("A1", "<Tab>", "<Tab>", "1", "<Tab>", "<Tab>", "<Tab>", "bookcase t")
    expect(sheet.options).to_have_text(["Bookcase tall", "Bookcase tall narrow"])
    sheet.type("<ArrowDown>", "<Tab>")
    expect(sheet.cell(CLASS, 2)).to_contain_text(re.compile("low|medium|high"))
    assert sheet.settle().cells("Items", 2)[:6] == ["A1", None, "1", None, None, "Bookcase tall"]
    assert sheet.cells("Floors", 2)[:6] == ["1", "Ground", None, 0.4, 0.4, 40]


def test_a_bad_value_is_marked_in_its_cell_and_other_rows_keep_their_classes(small):
    for row in (2, 4):
        expect(small.cell(CLASS, row)).to_contain_text(re.compile("^[^≈]*%"))
    others = [small.cell(CLASS, row).inner_text() for row in (2, 4)]
    small.select("Height", 3).type("tall", "<Enter>")
    expect(small.cell("Height", 3)).to_have_attribute("aria-invalid", "true")
    expect(small.cell("Height", 3)).to_have_attribute("title", re.compile("'tall'.*number"))
    expect(small.cell(CLASS, 3)).to_have_text("check")
    assert [small.cell(CLASS, row).inner_text() for row in (2, 4)] == others
    small.select("Item", 2)
    small.page.locator(".problems-button").click()
    small.page.get_by_role("button", name=re.compile("Items!J3")).click()
    small.cell("Height", 3).click(trial=True)  # the list of problems does not cover it
    expect(small.page.locator("#grid-active")).to_have_text("tall")
    expect(small.page.locator(".sheet-about")).to_contain_text("'tall'")
    expect(small.page.get_by_role("status").filter(has_text="Items!J3")).to_contain_text("tall")
    small.page.get_by_role("button", name="1 error").click()
    expect(small.page.get_by_role("button", name=re.compile("Items!J3"))).to_have_count(0)
    small.select("Height", 3).type("190", "<Enter>")
    expect(small.cell("Height", 3)).not_to_have_attribute("aria-invalid", "true")
    expect(small.cell(CLASS, 3)).to_contain_text(re.compile("low|medium|high"))


def test_a_cell_typed_again_while_its_first_answer_is_missing(small):
    def lose(route):
        route.fetch()
        route.abort()

    small.page.route("**/api/edit", lose, times=1)
    small.select("Description", 2).type("first", "<Enter>")
    small.select("Description", 2).type("second", "<Enter>")
    small.settle()
    assert small.values("Items", "description")[2] == "second"
    expect(small.cell("Description", 2)).to_have_text("second")
    expect(small.page.locator(".notice").filter(has_text="another window")).to_have_count(0)


def test_lists_filter_while_one_types_and_an_input_method_composes(small):
    small.select("Axis", 2).type("<Alt+ArrowDown>")
    options = small.options
    expect(options).to_have_text(["X", "Y"])
    small.type("<ArrowDown>", "<Enter>")
    assert small.settle().values("Items", "axis")[2] == "X"
    small.select("Anchored", 2).type("n")
    expect(options).to_have_text(["no", "unknown"])
    small.type("<Enter>")
    small.select("Floor", 3).type("<Alt+ArrowDown>")
    expect(options).to_have_text(["1", "2"])
    options.nth(1).click()
    small.select("Type", 4).type("bookcase 5", "<Escape>", "<Enter>")  # the list closes, what is typed stays
    small.settle()
    assert small.values("Items", "anchored")[2] == "no"
    assert small.values("Items", "floor")[3] in ("2", 2)
    assert small.values("Items", "type")[4] == "bookcase 5"
    box = small.select("Importance", 2).cell("Importance", 2).bounding_box()
    small.page.mouse.click(box["x"] + box["width"] - 8, box["y"] + box["height"] / 2)
    expect(options.first).to_be_visible()
    small.type("<Escape>", "<Escape>")
    assert 2 not in small.settle().values("Items", "importance")
    client = small.page.context.new_cdp_session(small.page)
    small.select("Room", 3)
    for text in ("k", "か", "会議"):
        client.send("Input.imeSetComposition", {"text": text, "selectionStart": len(text), "selectionEnd": len(text)})
    client.send("Input.insertText", {"text": "会議室"})
    small.type("<Enter>")
    assert small.settle().values("Items", "room")[3] == "会議室"


def test_keys_of_a_spreadsheet(small):
    active, frame = small.page.locator("#grid-active"), small.page.locator(".sheet-cell")
    small.select("Item", 2).type("<Control+ArrowDown>")
    expect(active).to_have_text(ITEMS[-1]["item"])
    small.type("<Control+Home>", "<End>", "<Home>")
    expect(frame).to_have_text("Items!A2")
    small.type("<Control+End>")
    expect(frame).to_contain_text(f"{len(ITEMS) + 1}")
    small.type("<Control+Home>", "<F2>", "x", "<Escape>")
    expect(active).to_have_text("A1")
    small.type("<F2>", "x", "<Enter>")
    expect(frame).to_have_text("Items!A3")
    small.select("Room", 2, "Room", 5).type("Store", "<Control+Enter>")
    small.select("Notes", 2).type("one", "<Alt+Enter>", "two", "<Enter>")
    small.select("Description", 2, "Description", 4).type("<Control+d>")
    small.select("Anchored", 5).type("<Delete>")
    small.settle()
    assert small.values("Items", "item")[2] == "A1x"
    assert [small.values("Items", "room").get(row) for row in range(2, 7)] == ["Store"] * 4 + [None]
    assert small.values("Items", "notes")[2] == "one\ntwo"
    assert [small.values("Items", "description").get(row) for row in (2, 3, 4)] == ["Bookcase"] * 3
    assert 5 not in small.values("Items", "anchored")
    small.select("Width", 2, "Height", 3)
    expect(small.grid.locator("[role=gridcell][aria-selected=true]")).to_have_count(4)
    small.type("<Shift+Space>")
    expect(small.grid.locator("[role=gridcell][aria-selected=true]")).not_to_have_count(4)


def test_undo_goes_back_across_sheets_in_order_and_quick_edits_reach_the_server_so(small):
    small.select("Room", 3).type("Hall", "<Enter>")
    small.open("Floors").select("Name", 2).type("Ground", "<Enter>")
    small.open("Items").select("Room", 4).type("Store", "<Enter>").settle()
    small.type("<Control+z>", "<Control+z>")
    expect(small.page.locator("[data-sheet=Floors]")).to_have_attribute("aria-selected", "true")
    small.settle()
    assert (small.values("Floors", "name"), small.values("Items", "room")) == ({}, {2: "Hall", 3: "Hall"})
    small.type("<Control+y>", "<Control+Shift+Z>").settle()
    assert small.values("Floors", "name") == {2: "Ground"}
    assert small.values("Items", "room") == {2: "Hall", 3: "Hall", 4: "Store"}
    client = small.page.context.new_cdp_session(small.page)
    slow = {"offline": False, "latency": 150, "downloadThroughput": -1, "uploadThroughput": -1}
    client.send("Network.emulateNetworkConditions", slow)
    small.select("Quantity", 2).type(*(part for n in range(2, 6) for part in (str(n), "<Enter>")))
    small.select("Quantity", 2).type("7", "<Enter>", "8", "<Enter>", "<Control+z>").settle()
    assert small.values("Items", "quantity") == {2: 7, 3: 3, 4: 4, 5: 5}
    expect(small.cell("Quantity", 3)).to_have_text("3")


def test_a_cell_that_cannot_be_changed_goes_back_and_is_named(page, served_here, tmp_path):
    from openpyxl import load_workbook

    path = write_office(tmp_path / "office.xlsx")
    book = load_workbook(path)
    column = book["Items"].max_column + 1
    book["Items"].cell(1, column, "Our number")
    book["Items"].cell(2, column, "=1+1")
    book.save(path)
    sheet = opened(page, served_here(path)).open("Items")
    sheet.type("<End>")
    sheet.select("Our number", 2).type("5", "<Enter>")
    name = sheet.cell("Our number", 2)
    expect(sheet.page.get_by_role("alert")).to_contain_text(re.compile(r"Items!A\w2"))
    expect(name).not_to_have_text("5")
    sheet.select("Our number", 3).type("6", "<Enter>").settle()
    expect(sheet.cell("Our number", 3)).to_have_text("6")


def test_what_is_typed_meets_a_change_from_elsewhere(small):
    small.select("Description", 3).type("Des")
    edit_elsewhere(small, "Attic")
    expect(small.cell("Room", 2)).to_have_text("Attic")  # the page asks every two seconds
    small.type("k", "<Enter>").settle()
    assert small.values("Items", "description")[3] == "Desk"
    edit_elsewhere(small, "Cellar")
    small.select("Description", 3).type("Table", "<Enter>")
    expect(small.cell("Room", 2)).to_have_text("Cellar")
    small.settle()
    assert (small.values("Items", "description")[3], small.values("Items", "room")[2]) == ("Table", "Cellar")
    expect(small.cell("Description", 3)).to_have_text("Table")


def test_a_form_is_typed_into_line_by_line_and_keeps_what_is_typed(small):
    small.open("Building")
    height, period = (small.page.get_by_label(re.compile(f"^{label}")) for label in ("Height", "Period T1"))
    height.fill("=3*4")
    small.type("<Enter>")
    expect(period).to_be_focused()
    expect(height).to_have_value("12")
    small.type("long")
    edit_elsewhere(small, "Attic")  # the page draws anew with every answer
    small.page.wait_for_function(
        "async () => (await import('/store.mjs')).store.sheet('Items').value(2, 3) === 'Attic'"
    )
    expect(period).to_have_value("long")
    small.type("<Enter>")
    expect(period).to_have_attribute("aria-invalid", "true")
    expect(small.page.locator(".form-problem.error")).to_contain_text("'long'")
    structure = small.page.get_by_label(re.compile("^Structure"))
    expect(structure).to_be_focused()
    assert small.page.locator(f"#{structure.get_attribute('list')} option").count() > 2
    small.type("<Control+z>")
    expect(period).to_have_value("")
    small.settle()


def test_markup_in_a_cell_is_text(page, served_here, tmp_path):
    markup = '<img src=x onerror="document.title=1">'
    items = [ITEMS[0] | {"room": markup, "description": markup}, ITEMS[1] | {"item": markup, "axis": markup}]
    sheet = opened(page, served_here(write_office(tmp_path / "office.xlsx", items))).open("Items")
    expect(sheet.cell("Room", 2)).to_have_text(markup)
    expect(sheet.page.locator(".problems")).to_contain_text("<img")
    sheet.head("Room").get_by_role("button").click()
    sheet.page.keyboard.press("Escape")
    sheet.copy_text(markup, f"<table><tr><td style='color:red'>{html.escape(markup)}{markup}</td></tr></table>").select(
        "Notes", 3
    ).type("<Control+v>")
    sheet.select("Type", 3).type("<img", "<Enter>").settle()
    assert sheet.values("Items", "notes")[3] == markup
    assert sheet.page.locator("img").count() == 0
    assert sheet.page.title() != "1"
