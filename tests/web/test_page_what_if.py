"""What if: the answer stands beside the present, the file keeps its bytes, writing is asked for and undone."""

import re

import pytest
from playwright.sync_api import expect

from tests.web.plan_page import write_floor
from tests.web.sheet_page import opened

pytestmark = [pytest.mark.browser, pytest.mark.slow]


@pytest.fixture
def path(tmp_path):
    items = [
        {"item": "A1", "floor": "1", "breadth": 40, "width": 80, "height": 200, "x": 6.5, "y": 4.2, "angle_deg": 90},
        {"item": "A2", "floor": "2", "breadth": 45, "width": 80, "height": 150, "quantity": 4},
        {"item": "A3", "floor": "1", "breadth": 45, "width": 80, "height": 90, "anchored": "yes"},
    ]
    return write_floor(tmp_path / "hall.xlsx", items=items)


@pytest.fixture
def sheet(page, served_here, path):
    sheet = opened(page, served_here(path))
    sheet.page.locator("nav.tabs [data-tab=what-if]").click()
    expect(sheet.page.locator(".results")).to_have_attribute("aria-busy", "false")
    return sheet


def counts(page, at):
    """Return the numbers of pieces by class, now (0) or then (1)."""
    expect(page.locator(".results")).to_have_attribute("aria-busy", "false")
    return [int(row.locator("td.num").nth(at).text_content()) for row in page.locator(".bars tbody tr").all()]


def test_sliders_ticks_and_scenarios_change_the_counts_and_not_the_file(sheet, path):
    page, before = sheet.page, path.read_bytes()
    present = counts(page, 0)
    assert counts(page, 1) == present
    assert sum(present) == 6
    slider = page.get_by_role("slider", name="Strength of the shaking")
    slider.focus()
    page.keyboard.press("Home")
    page.keyboard.press("ArrowRight")
    expect(page.get_by_label("Factor on the shaking")).to_have_value("0.3")
    weaker = counts(page, 1)
    assert counts(page, 0) == present
    assert sum(weaker[:3]) < sum(present[:3]), "fewer are of a class above low"
    page.get_by_role("button", name="Reset").click()
    expect(page.get_by_role("heading", name="Pieces of another class (0)")).to_be_visible()
    assert counts(page, 1) == present
    page.get_by_role("checkbox", name=re.compile("A2")).check()
    expect(page.get_by_role("heading", name="Pieces of another class (1)")).to_be_visible()
    assert counts(page, 1)[4] == present[4] + 4
    first = page.get_by_role("slider", name="Anchor the first")
    first.focus()
    page.keyboard.press("End")
    expect(page.get_by_role("heading", name="Pieces of another class (2)")).to_be_visible()
    expect(page.get_by_role("checkbox", name=re.compile("A1"))).to_be_checked()
    expect(page.get_by_role("row", name=re.compile("Way out"))).to_contain_text("open if the anchors hold")
    assert path.read_bytes() == before
    assert sheet.server.client.get("/api/download").data == before
    assert not sheet.server.client.get("/api/state").json()["state"]["can_undo"]
    sheet.page.get_by_label("Scenario").select_option("ASCE 7-22")
    expect(sheet.page.get_by_role("alert")).to_contain_text("SDS")


def test_anchors_are_written_after_a_question_and_undone_in_one_step(sheet):
    page = sheet.page
    write = page.get_by_role("button", name="Write into the workbook")
    expect(write).to_be_disabled()
    for name in ("A1", "A2"):
        page.get_by_role("checkbox", name=re.compile(name)).check()
    expect(write).to_be_enabled()
    expect(page.get_by_role("heading", name="Pieces of another class (2)")).to_be_visible()
    write.click()
    page.get_by_role("button", name="Cancel").click()
    assert sheet.values("Items", "anchored") == {4: "yes"}
    write.click()
    page.get_by_role("dialog").get_by_role("button", name="Write").click()
    expect(page.get_by_role("heading", name="Pieces of another class (0)")).to_be_visible()
    assert sheet.settle().values("Items", "anchored") == {2: "yes", 3: "yes", 4: "yes"}
    page.get_by_role("button", name="Undo").last.click()
    expect(page.get_by_role("checkbox", name=re.compile("A2"))).to_be_visible()
    assert sheet.settle().values("Items", "anchored") == {4: "yes"}
    page.get_by_role("checkbox", name=re.compile("A2")).check()  # an undo that a notice offers undoes nothing else
    page.get_by_role("button", name="Write into the workbook").click()
    page.get_by_role("dialog").get_by_role("button", name="Write").click()
    said = page.locator(".notice").filter(has_text="1 row written.")
    expect(said.get_by_role("button", name="Undo")).to_be_visible()
    page.evaluate("async () => (await import('/store.mjs')).store.edit([['Items', 2, 3, 'Attic']], '')")
    expect(said).to_have_count(0)
    assert sheet.settle().values("Items", "anchored") == {3: "yes", 4: "yes"}
