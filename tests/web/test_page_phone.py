"""The page on a phone: everything can be read, nothing runs off the edge."""

import pytest
from playwright.sync_api import expect

from tests.conftest import EXAMPLE
from tests.web.looking import THEMES, VIEWS, examine, show
from tests.web.sheet_page import SheetPage

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WIDTH, HEIGHT = 390, 844
OVER_THE_EDGE = """width => [...document.querySelectorAll("body *")].filter((one) => {
    if (one.getBoundingClientRect().width === 0 || one.closest("svg *, .unseen, .skip")) return false;
    for (let up = one.parentElement; up !== document.body && up; up = up.parentElement) {
        if (/auto|scroll|hidden|clip/.test(getComputedStyle(up).overflowX) && !up.matches(".view")) return false;
    }
    return one.getBoundingClientRect().right > width + 0.5;
}).map((one) => `${one.tagName}.${one.className}: ${one.textContent.trim().slice(0, 40)}`)"""
SMALL_TABS = """() => [...document.querySelectorAll("nav.tabs a")]
    .filter((one) => one.getBoundingClientRect().height < 40).length"""


def test_every_view_can_be_read(page, served_here):
    found = page(served_here(EXAMPLE), width=WIDTH, height=HEIGHT, has_touch=True)
    for view in VIEWS:
        show(found, view)
        for theme, rules in THEMES:
            found.emulate_media(color_scheme=theme)
            assert found.evaluate("() => document.documentElement.scrollWidth") <= WIDTH, (view, theme)
            assert found.evaluate(OVER_THE_EDGE, WIDTH) == [], (view, theme)
            assert examine(found, rules) == [], (view, theme)
    assert found.evaluate(SMALL_TABS) == 0


def test_on_a_phone_the_tabs_are_at_the_bottom_nothing_is_edited_and_notices_leave_room(page, served_here):
    server = served_here(EXAMPLE)
    found = page(server, width=WIDTH, height=HEIGHT, has_touch=True)
    expect(found.locator(".counts")).to_contain_text("very high")
    tabs = found.get_by_role("navigation", name="Views").bounding_box()
    assert tabs["y"] + tabs["height"] == HEIGHT
    expect(found.get_by_text("at least 900 pixels wide")).to_be_visible()
    expect(found.locator(".problems-rows")).to_be_hidden()
    expect(found.get_by_role("button", name="Undo")).to_be_hidden()
    found.get_by_role("button", name="Menu").click()
    expect(found.get_by_role("link", name="Download a copy")).to_be_visible()
    found.get_by_role("button", name="Menu").click()
    expect(found.get_by_label("Language of the page")).to_be_hidden()
    before = found.evaluate("async () => (await import('/store.mjs')).store.state.version")
    sheet = SheetPage(found, server)
    found.get_by_role("gridcell").first.tap()
    sheet.type("x", "<Enter>").settle()
    assert found.evaluate("async () => (await import('/store.mjs')).store.state.version") == before
    sheet.open("Building")
    expect(found.get_by_label("Address", exact=True)).not_to_be_editable()
    found.evaluate("""async () => {
        const { notice } = await import("/messages.mjs");
        for (const n of [1, 2, 3, 4]) notice(`${n} ${"cannot be saved ".repeat(20)}`, { kind: "error", lasting: true });
    }""")
    assert found.locator("#notices").bounding_box()["height"] <= HEIGHT / 3
    for left in (3, 2, 1, 0):
        found.locator(".notice").first.get_by_role("button", name="Close").click()
        expect(found.locator(".notice")).to_have_count(left)
    found.set_viewport_size({"width": 900, "height": 800})
    expect(found.get_by_role("button", name="Undo")).to_be_visible()
