"""Rows inserted, deleted and moved; the menu of the grid; several ranges; groups of columns; chips; the drawer."""

import re
import shutil

import openpyxl
import pytest
from playwright.sync_api import expect

from tests.conftest import EXAMPLE
from tests.web.opened import MARKET, write_office
from tests.web.sheet_page import CLASS, TWO_FRAMES, opened
from tests.workbooks import ITEMS

pytestmark = [pytest.mark.browser, pytest.mark.slow]
NAMES = [one["item"] for one in ITEMS]
COLOURS = "one => [getComputedStyle(one).color, getComputedStyle(one).backgroundColor]"


def names(sheet):
    """Return the names of Items as the server has them, "" for a blank row."""
    found = sheet.settle().values("Items", "item")
    return [found.get(row, "") for row in range(2, max(found) + 1)]


def menu(sheet, entry):
    sheet.page.get_by_role("menu").get_by_role(re.compile("menuitem"), name=entry).click()


def entry(sheet, name):
    return sheet.page.locator(".grid-context button").filter(has_text=name)


def selected(sheet):
    sheet.page.evaluate(TWO_FRAMES)
    return sheet.grid.locator(".grid-number.selected").all_inner_texts()


def test_rows_are_inserted_deleted_and_moved_by_keys_menu_and_mouse_and_undone(small):
    a, b, c, d, e = NAMES
    small.select("Item", 3, "Room", 4).type("<Control+Shift+Equal>")
    assert names(small) == [a, "", "", b, c, d, e]
    assert selected(small) == ["3", "4"]
    small.type("New", "<Tab>", "<Tab>", "1", "<Enter>")
    small.select("Item", 4).type("<Control+Minus>")
    assert names(small) == [a, "New", b, c, d, e]
    expect(small.page.get_by_text("1 row deleted.")).to_be_visible()
    for row in (2, 4, 5):
        expect(small.cell(CLASS, row)).to_contain_text(re.compile("^[^≈]*%"))
    classes = [small.cell(CLASS, row).inner_text() for row in (2, 4, 5)]
    small.select("Item", 3).type("<Shift+Space>", "<Alt+ArrowUp>")
    assert names(small) == ["New", a, b, c, d, e]
    assert selected(small) == ["2"]
    assert [small.cell(CLASS, row).inner_text() for row in (3, 4, 5)] == classes
    # by its number, dragged below the fifth row
    numbers = small.grid.locator(".grid-number")
    numbers.get_by_text("2", exact=True).click()
    start, goal = (numbers.get_by_text(text, exact=True).bounding_box() for text in ("2", "5"))
    small.page.mouse.move(start["x"] + 20, start["y"] + 10)
    small.page.mouse.down()
    small.page.mouse.move(goal["x"] + 20, goal["y"] + 12, steps=4)
    small.page.mouse.up()
    assert names(small) == [a, b, c, "New", d, e]
    small.cell("Room", 2).click(button="right")
    entry(small, "Insert 1 row above").click()
    assert names(small) == ["", a, b, c, "New", d, e]
    # an edit and an undo that reach the server together
    small.select("Item", 8).type("<Control+Minus>").select("Item", 7).type("last", "<Enter>")
    assert names(small) == ["", a, b, c, "New", "last"]
    for before in (["", a, b, c, "New", d], ["", a, b, c, "New", d, e], [a, b, c, "New", d, e], ["New", a, b, c, d, e]):
        small.type("<Control+z>")
        assert names(small) == before
    expect(small.page.locator(".undone")).to_have_text("Undone: rows of Items")
    shown = [small.cell("Item", row).inner_text() for row in range(2, 8)]
    assert shown == ["New", a, b, c, d, e]
    for _ in range(6):
        small.type("<Control+z>")
    assert names(small) == NAMES


def test_what_cannot_be_done_to_rows_is_told_with_its_cell(page, served_here, tmp_path):
    path = shutil.copy(EXAMPLE.parents[1] / "tests" / "data" / "workbooks" / "table.xlsx", tmp_path)
    sheet = opened(page, served_here(path)).open("Items")
    (ref,) = [one.ref for one in openpyxl.load_workbook(path)["Items"].tables.values()]
    row = int(re.findall(r"\d+", ref)[-1])
    sheet.select("Item", row).type("<Shift+Space>", "<Alt+ArrowDown>").settle()
    expect(sheet.page.get_by_role("alert")).to_contain_text(
        re.compile(r"Items!A\d+: Rows cannot be moved", re.IGNORECASE)
    )


def test_the_menu_by_keys_and_clipboard_and_several_ranges(small):
    context = small.page.context
    context.grant_permissions(["clipboard-read", "clipboard-write"])
    small.select("Item", 2, "Room", 3).type("<Shift+F10>")
    items = small.page.locator(".grid-context button")
    expect(items.first).to_be_focused()
    small.type("<ArrowUp>")
    expect(items.last).to_be_focused()
    small.type("<Home>", "<Escape>")
    expect(small.page.locator(".grid-input")).to_be_focused()
    small.type("<ContextMenu>")
    entry(small, "Copy with headers").click()
    small.select("Notes", 9).type("<Shift+F10>")
    expect(items.first).to_be_focused()
    small.type("<Escape>")
    small.select("Item", 8).type("<ContextMenu>")
    entry(small, "Paste").click()
    small.page.wait_for_function("async () => (await import('/store.mjs')).store.sheet('Items').value(10, 0) !== null")
    small.settle()
    assert small.cells("Items", 8)[:4] == ["Item", None, "Floor", "Room"]  # the class is computed
    assert [small.cells("Items", row + 7)[:3] for row in (2, 3)] == [small.cells("Items", row)[:3] for row in (2, 3)]
    small.type("<Control+z>").settle()
    # two ranges: an entry for both, sums, copied one below the other, cleared at once
    small.select("Room", 2)
    small.cell("Room", 4).click(modifiers=["Control"])
    small.cell("Room", 5).click(modifiers=["Shift"])
    small.type("Attic", "<Control+Enter>").settle()
    assert [small.values("Items", "room").get(row) for row in (2, 3, 4, 5)] == [
        "Attic", small.values("Items", "room").get(3), "Attic", "Attic",
    ]  # fmt: skip
    small.select("Height", 2)
    small.shown("Height", 4).click(modifiers=["Control"])
    heights = [ITEMS[0]["height"], ITEMS[2]["height"]]
    sums = small.page.locator(".sheet-sums")
    expect(sums).to_contain_text(f"Count 2   Sum {sum(heights)}   Average {sum(heights) / 2:g}")
    small.type("<Control+c>").select("Height", 9).type("<Control+v>").settle()
    assert [small.values("Items", "height")[row] for row in (9, 10)] == heights
    small.select("Height", 9)
    small.cell("Height", 10).click(modifiers=["Control"])
    small.type("<Delete>").settle()
    assert not {9, 10} & set(small.values("Items", "height"))
    small.select("Room", 2)
    small.shown("Height", 4).click(modifiers=["Control"])
    small.type("<Control+c>")
    expect(small.page.get_by_role("alert")).to_contain_text("Ranges of different columns")


def test_texts_are_replaced_one_by_one_and_all_at_once(small):
    before = small.values("Items", "room")
    small.select("Room", 2).type("Hall (A)", "<Enter>", "hall (a), Hall (A)", "<Enter>").settle()
    small.type("<Control+h>", "HALL (a)")
    expect(small.page.locator(".grid-find-count")).to_have_text(re.compile("of 2"))
    small.page.get_by_label("Replace with").fill("$& Lobby")
    small.page.get_by_role("button", name="Replace all").click()
    expect(small.page.locator(".grid-find-count")).to_have_text("2 cells replaced")
    rooms = small.settle().values("Items", "room")
    assert (rooms[2], rooms[3]) == ("$& Lobby", "$& Lobby, $& Lobby")
    small.page.locator(".grid-find [type=search]").fill("lobby")
    expect(small.page.locator(".grid-find-count")).to_have_text(re.compile("of 2"))
    small.page.get_by_label("Replace with").fill("Attic")
    small.keyboard.press("Enter")
    expect(small.page.locator(".grid-find-count")).to_have_text("1 cell replaced")
    replaced = small.settle().values("Items", "room")
    assert [replaced[row] != rooms[row] for row in (2, 3)].count(True) == 1
    small.type("<Escape>", "<Control+z>", "<Control+z>", "<Control+z>", "<Control+z>").settle()
    assert small.values("Items", "room") == before


def test_groups_of_columns_fold_and_paste_reaches_what_is_folded(page, served_here, tmp_path):
    sheet = opened(page, served_here(write_office(tmp_path / "office.xlsx")), folds=True).open("Items")
    expect(sheet.head("Height")).to_be_attached()
    for label in ("Notes", "Row in Floors", "Axis used"):
        expect(sheet.head(label)).to_have_count(0)
    sheet.page.locator("[data-group=Size]").click()
    expect(sheet.head("Height")).to_have_count(0)
    expect(sheet.page.locator("[data-group=Size]")).to_have_attribute("aria-expanded", "false")
    sheet.copy_text("Z1\t\t1\tRoom\tWhat\t\t1\t40\t80\t190").select("Item", 9).type("<Control+v>").settle()
    assert sheet.cells("Items", 9) == ["Z1", None, "1", "Room", "What", None, 1, 40, 80, 190]
    sheet.page.reload()
    expect(sheet.head("Type")).to_be_attached()
    expect(sheet.head("Height")).to_have_count(0)
    sheet.select("Item", 2).type("<Shift+F10>")
    entry(sheet, "Columns: Details").click()
    expect(sheet.head("Notes")).to_be_attached()
    # a problem of a folded column shows its group
    sheet.page.locator("[data-group=Size]").click()
    sheet.select("Height", 3).type("tall", "<Enter>")
    sheet.page.locator("[data-group=Size]").click()
    sheet.page.locator(".problems-button").click()
    sheet.page.locator(".problems").get_by_role("button", name=re.compile("Items!J3")).click()
    expect(sheet.head("Height")).to_be_attached()
    expect(sheet.page.locator("#grid-active")).to_have_text("tall")


def test_chips_filter_blank_sizes_show_the_catalogue_and_a_row_is_quiet_until_it_is_left(page, served_here, tmp_path):
    folder = shutil.copytree(MARKET.parent, tmp_path / "inventories")
    sheet = opened(page, served_here(folder / MARKET.name)).open("Items")
    expect(sheet.cell(CLASS, 2)).to_contain_text("%")
    high = sheet.page.locator(".sheet-chip[data-only=high]")
    expect(high).not_to_have_class(re.compile("pale"))
    n = int(high.inner_text().split()[-1])
    sheet.select("Item", 20)
    high.click()
    expect(sheet.page.locator(".sheet-order")).to_contain_text("filtered by class")
    expect(sheet.grid.locator(".grid-row:has(#grid-active) .risk")).to_contain_text("high")  # no row that is left out
    shown = sheet.grid.locator(".grid-row:not([hidden]) .risk:not(.none)").all_inner_texts()
    assert 0 < len(shown) <= n
    assert all("high" in one for one in shown)
    high.click()
    expect(sheet.page.locator(".sheet-order")).to_be_hidden()
    box = sheet.page.locator(".grid-box")
    before = box.bounding_box()
    free = max(sheet.values("Items", "item")) + 1
    sheet.select("Item", 2).page.get_by_role("button", name="Add a row").click()
    sheet.type(
        "N1", "<Tab>", "<Tab>", "99", "<Tab>", "<Tab>", "<Tab>", "cabinet storage steel", "<ArrowDown>", "<Tab>"
    ).settle()
    assert sheet.cells("Items", free)[:6] == ["N1", None, "99", None, None, "Storage cabinet steel"]
    ghost = sheet.shown("Height", free)
    expect(ghost).to_have_class(re.compile("ghost"))
    expect(ghost).to_have_text("198.1")
    expect(sheet.shown("Floor", free)).not_to_have_class(re.compile("error"))
    button = sheet.page.locator(".problems-button")
    expect(button).not_to_contain_text("✖")
    sheet.type("<Enter>")
    expect(sheet.shown("Floor", free)).to_have_class(re.compile("error"))
    expect(button).to_contain_text("✖ 1")
    assert box.bounding_box() == before
    button.click()
    expect(sheet.page.locator(".problems")).to_be_visible()
    assert {**box.bounding_box(), "width": 0} == {**before, "width": 0}  # the list stands beside it
    problems = sheet.page.locator("[data-only=problems]")
    problems.click()
    expect(sheet.cell("Item", free)).to_have_text("N1")
    sheet.keyboard.press("Escape")
    for chip, other in ((problems, high), (high, problems)):  # under the pointer it can be read as well as away from it
        other.hover()
        away = chip.evaluate(COLOURS)
        chip.hover()
        assert chip.evaluate(COLOURS) == away
    sheet.page.set_viewport_size({"width": 900, "height": 844})
    expect(problems).to_have_text(re.compile("! [0-9]+$"))  # ▲ is the sign of a class next to it
    sheet.page.set_viewport_size({"width": 390, "height": 844})
    sheet.page.get_by_role("button", name="Show all").click()
    sheet.select("Item", 2)
    found = sheet.cell(CLASS, 2)
    expect(found).to_have_text(re.compile("^[^(]+%$"))
    assert found.evaluate("one => one.scrollWidth <= one.clientWidth")
    sheet.page.locator(".problems").get_by_role("button", name=re.compile(f"Items!C{free}")).click()
    about = sheet.page.locator(".sheet-about.error")
    assert about.bounding_box()["width"] == 390  # above the line, not squeezed into it
