"""One class, simulated as one types: pale by the formula, then solid; every view and every change goes by it."""

import re

import pytest
from playwright.sync_api import expect

from assess.web.limits import PREFIX
from assess.web.slots import take
from tests.waiting import wait_until
from tests.web.opened import write_template
from tests.web.plan_page import FLOORS, PLACES, ROUTES, SIZES, PlanPage
from tests.web.sheet_page import CLASS, opened

pytestmark = [pytest.mark.browser, pytest.mark.slow]

SOLID = re.compile(r"(low|medium|high) \d.*%.*\(\d+ to \d+\)")
ITEMS = [
    {"item": "A1", "floor": "1", **SIZES, "x": 2.0, "y": 3.4, "angle_deg": 90},
    {"item": "A2", "floor": "2", **SIZES, "x": 5.0, "y": 4.0, "angle_deg": 0, "anchored": "yes"},
    {"item": "A3", "floor": "1", "breadth": 110, "width": 110, "height": 75},
    {"item": "B1", "floor": "2", **SIZES, "x": 1.0, "y": 1.0, "angle_deg": 0},
]  # fmt: skip
BUILDING = {"storeys": 3, "height": 10}
AXES = [
    {"floor": "1", "name": "Ground", "elevation": 0, "pfa_x": 0.7, "pfv_x": 70.0, "pfa_y": 0.25, "pfv_y": 20.0},
    {**FLOORS[1], "elevation": 3.3},
]  # fmt: skip


@pytest.fixture
def server(served_here, tmp_path):
    rows = {"Building": [BUILDING], "Floors": AXES, "Items": ITEMS, "Places": PLACES, "Routes": ROUTES}
    return served_here(write_template(tmp_path / "hall.xlsx", rows, spare=4))


def _counts(page):
    shown = page.locator("header .counts li [aria-hidden]").all_inner_texts()
    return [int(re.sub(r"\D", "", text)) for text in shown]


def test_a_class_is_pale_until_its_piece_has_been_simulated_and_says_what_it_rests_on(page, server, tmp_path):
    """While another session simulates: a place is free once it has ended."""
    sheet = opened(page, server).open("Items")
    folder = next((tmp_path / "tmp").glob(f"{PREFIX}*"))
    place = wait_until(lambda: take(folder, "live", 1))
    sheet.select("Height", 2).type("210", "<Enter>")
    expect(sheet.cell(CLASS, 2)).to_have_text(re.compile("^≈ . (low|medium|high|very high)$"))
    expect(sheet.cell(CLASS, 2)).to_have_class(re.compile("pale"))
    header = sheet.page.locator("header .counts-line")
    expect(header).to_have_attribute("title", re.compile("Other users simulate"))
    expect(header.get_by_role("progressbar")).to_be_visible()
    place.release()
    expect(sheet.cell(CLASS, 2)).to_have_text(SOLID)
    expect(sheet.cell(CLASS, 2)).not_to_have_class(re.compile("pale"))
    expect(sheet.cell(CLASS, 2)).to_have_class(re.compile("assumed"))
    expect(sheet.cell(CLASS, 3)).to_have_text("anchored")
    expect(sheet.cell(CLASS, 4)).to_have_text(re.compile("low cannot rock"))
    expect(header.get_by_role("progressbar")).to_be_hidden()
    expect(header).to_have_attribute("title", re.compile("as simulated and as reports have them"))
    sheet.page.get_by_role("button", name="Menu").click()
    with sheet.page.expect_download():
        sheet.page.get_by_role("link", name="Download a copy").click()
    expect(sheet.page.get_by_role("region", name="Notices")).to_contain_text("Excel shows the class by the formula")
    sheet.select("Item", 2)
    sheet.page.locator("nav.tabs [data-tab=plan]").click()
    sheet.page.locator(".plan-panel [data-panel=pieces]").click()
    expect(sheet.page.locator(".plan-panel")).to_contain_text(re.compile(r"A1.*%\s\(\d+ to \d+\)", re.DOTALL))


def test_typing_undo_turning_and_the_slider_change_the_simulated_class_in_every_view(page, server):
    sheet = opened(page, server).open("Items")
    first = sheet.cell(CLASS, 2)
    expect(first).to_have_text(SOLID)
    before, counts = first.inner_text(), _counts(sheet.page)
    sheet.select("Height", 2).type("90", "<Enter>")
    expect(first).not_to_have_text(before)
    expect(first).to_have_text(re.compile("low"))
    sheet.keyboard.press("Control+z")
    expect(first).to_have_text(before)
    assert _counts(sheet.page) == counts
    plan = PlanPage(sheet).open()
    shown = plan.piece(2).get_attribute("aria-label")
    plan.click(2.0, 3.4).keys("r")
    expect(plan.piece(2)).not_to_have_attribute("aria-label", shown)
    expect(plan.piece(2)).to_have_attribute("aria-label", re.compile(r"chance .*%\s\("))
    sheet.page.locator("nav.tabs [data-tab=sheet]").click()
    expect(first).not_to_have_text(before)  # it topples along the other axis now
    expect(first).to_have_text(SOLID)
    turned = first.inner_text()
    sheet.page.locator("nav.tabs [data-tab=what-if]").click()
    results = sheet.page.locator(".results")
    expect(results).to_have_attribute("aria-busy", "false")
    now = [int(text) for text in results.locator(".bars tbody td.num:nth-of-type(1)").all_inner_texts()]
    assert now == _counts(sheet.page)
    slider = sheet.page.get_by_role("slider", name="Strength of the shaking")
    slider.focus()
    slider.press("End")
    expect(results).to_contain_text(re.compile("Pieces of another class \\([1-9]"))
    expect(results).to_contain_text(re.compile(r"%\s\(\d+ to \d+\)"))
    sheet.page.locator("nav.tabs [data-tab=sheet]").click()
    expect(first).to_have_text(turned)
