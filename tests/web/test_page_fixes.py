"""Problems fixed with one click: in the list, at the cell, on the plan; each is one step of undo."""

import re

import pytest
from playwright.sync_api import expect

from tests.web.opened import write_office
from tests.web.sheet_page import CLASS, opened

pytestmark = [pytest.mark.browser, pytest.mark.slow]
A_CLASS = re.compile("low|medium|high")


def test_an_unknown_floor_and_slips_are_fixed_where_they_are_shown(page, served_here, tmp_path):
    floors = [{"floor": "0", "name": "Hall", "elevation": 0}]
    items = [{"item": f"A{n}", "floor": "0", "breadth": 40, "height": 180} for n in range(1, 4)]
    path = write_office(tmp_path / "office.xlsx", items, floors, shaking="MMI VIII, severe")
    sheet = opened(page, served_here(path)).open("Items")
    fix = sheet.page.get_by_role("button", name="Add floor 2 at 6.6 m")
    sheet.select("Floor", 2).type("2", "<Enter>", "2", "<Enter>", "ground floor", "<Enter>").settle()
    expect(sheet.cell(CLASS, 2)).not_to_have_text(A_CLASS)
    sheet.page.locator(".problems-button").click()
    listed = sheet.page.locator(".problems")
    listed.get_by_role("button", name="Add floor 2 at 6.6 m").click()
    for row in (2, 3):
        expect(sheet.cell(CLASS, row)).to_have_text(A_CLASS)
    expect(fix).to_have_count(0)
    assert sheet.values("Floors", "elevation") == {2: 0, 3: 6.6}
    sheet.select("Floor", 4)
    sheet.page.locator(".sheet-line").get_by_role("button", name="Use 0").click()
    sheet.settle()
    assert sheet.values("Items", "floor") == {2: "2", 3: "2", 4: "0"}
    sheet.type("<Control+z>").type("<Control+z>").settle()
    assert (sheet.values("Floors", "floor"), sheet.values("Items", "floor")[4]) == ({2: "0"}, "ground floor")


def test_one_click_fixes_all_cells_of_one_kind(page, served_here, tmp_path):
    items = [{"item": f"A{n}", "floor": "1", "type": "Medicin cabinet"} for n in range(1, 4)]
    sheet = opened(page, served_here(write_office(tmp_path / "office.xlsx", items))).open("Items")
    sheet.page.locator(".problems-button").click()
    sheet.page.locator(".problems").get_by_role("button", name="Use Medicine cabinet (all 3)").press("Enter")
    for row in (2, 3, 4):
        expect(sheet.cell(CLASS, row)).to_have_text(A_CLASS)
    sheet.page.get_by_role("button", name="Undo").click()
    expect(sheet.shown("Type", 4)).to_have_text("Medicin cabinet")
    assert set(sheet.settle().values("Items", "type").values()) == {"Medicin cabinet"}
