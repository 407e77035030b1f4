"""The overview as a user meets it: the first view, on a phone ways out first; each thing leads to where it is."""

import re

import pytest
from playwright.sync_api import expect

from tests.conftest import EXAMPLE
from tests.web.looking import examine
from tests.web.opened import write_office, write_template
from tests.web.plan_page import FLOORS, PLACES, ROUTES, SIZES
from tests.workbooks import ITEMS

pytestmark = [pytest.mark.browser, pytest.mark.slow]

FALLEN = {"item": "A0", "floor": "1", "description": "Shelf", **SIZES, "x": 6.0, "y": 4.2, "angle_deg": 90}
HALL = {
    "Building": [{"height": 12.0}], "Floors": FLOORS, "Places": PLACES, "Routes": ROUTES,
    "Items": [FALLEN, {"item": "B1", "floor": "2", **SIZES, "quantity": 3}],
}  # fmt: skip


@pytest.fixture
def hall(page, served_here, tmp_path):
    return page(served_here(write_template(tmp_path / "hall.xlsx", HALL, spare=8)), view="")


def go_back(page):
    page.get_by_role("link", name="Overview").click()
    expect(page.locator("#view-overview")).to_be_visible()


def test_it_is_the_first_view_follows_changes_and_everything_leads_to_its_place(hall):
    page = hall
    view, outcome = page.locator("#view-overview"), page.locator("#view-overview h2")
    expect(outcome).to_have_text(re.compile(r"of 4 free-standing pieces fall.*; the only way out is doubtful\."))
    assert page.get_by_role("navigation", name="Views").get_by_role("link").first.inner_text() == "Overview"
    assert view.locator(".storey").all_inner_texts() != []
    expect(view.locator(".storey").nth(1).locator(".dot")).to_have_count(3)  # a dot a piece, not a row
    assert examine(page) == []
    view.locator(".storey").nth(1).locator(".dot").first.click()
    expect(page.locator("#view-sheet")).to_be_visible()
    expect(page.locator(".sheet-cell")).to_have_text(
        re.compile(r"^Items!\w+3$")
    )  # also in a grid that was not made yet
    go_back(page)
    view.get_by_role("button", name="First").click()
    expect(page.locator(".plan-floors [aria-pressed=true]")).to_have_text("First")
    go_back(page)
    view.get_by_role("button", name="Hall").click()
    expect(page.locator("#view-plan")).to_be_visible()
    expect(page.locator(".plan-floors [aria-pressed=true]")).to_have_text("Ground")
    go_back(page)
    view.get_by_role("region", name="Most likely to fall").get_by_role("button", name="A0").click()
    expect(page.locator("#view-sheet")).to_be_visible()
    before = outcome.text_content()
    page.evaluate("""async () => {
        const { store } = await import("/store.mjs");
        store.edit([["Items", 3, store.sheet("Items").column("height").at, 90]], "typing");
    }""")
    go_back(page)
    expect(outcome).not_to_have_text(before)
    expect(outcome).to_contain_text("of 4 free-standing")
    fixes = view.get_by_role("region", name="What to fix first, and what remains").first
    expect(fixes.get_by_role("row", name="Today")).to_contain_text("1 doubtful")
    expect(fixes.get_by_role("row", name="1. A0")).to_contain_text(re.compile(r"0\.\d\s*0$"))


def test_what_is_missing_is_listed_and_leads_to_its_cell(page, served_here, tmp_path):
    items = [ITEMS[0] | {"height": "tall"}, *ITEMS[1:]]
    found = page(served_here(write_office(tmp_path / "office.xlsx", items)), view="")
    lacks = found.get_by_role("region", name="What is missing")
    expect(lacks).to_contain_text("'tall'")
    lacks.get_by_role("button", name=re.compile(r"^Items!\w+2$")).click()
    expect(found.locator("#view-sheet")).to_be_visible()
    expect(found.locator(".sheet-cell")).to_have_text(re.compile(r"^Items!\w+2$"))


def test_on_a_phone_ways_out_come_first_and_a_tap_opens_the_plan(page, served_here):
    found = page(served_here(EXAMPLE), width=390, height=844, has_touch=True, view="")
    found.get_by_role("button", name="Menu").click()
    found.get_by_label("Language of the page").select_option("it")
    view = found.locator("#view-overview")
    expect(view.locator("h2")).to_contain_text("elementi non ancorati")
    ways = view.locator(".card").first
    expect(ways.get_by_role("heading")).to_have_text("Vie d'uscita dall'edificio, prima le peggiori")
    assert ways.bounding_box()["y"] < 400
    blocked = [
        int(one)
        for one in re.findall(r"(\d+) ostruit", " ".join(ways.locator(".way-floor button .tally").all_inner_texts()))
    ]
    assert blocked == sorted(blocked, reverse=True) != []
    floor = ways.locator(".way-floor button.quiet").nth(0)
    assert floor.bounding_box()["height"] >= 38
    name = floor.locator("b").inner_text().split()[-1]
    floor.tap()
    expect(found.locator("#view-plan")).to_be_visible()
    expect(found.get_by_role("combobox", name="Piano")).to_have_value(name)
