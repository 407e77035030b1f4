"""The HTML report of the worked example on a phone, and what axe-core says of it."""

import os
from pathlib import Path

import pytest

import assess
from docs.screenshot import find_browser

AXE = Path(__file__).parents[1] / "data" / "axe-core" / "axe.min.js"
PHONE, DESK = 390, 1400

pytestmark = [
    pytest.mark.browser,
    pytest.mark.slow,
    pytest.mark.skipif(
        find_browser() is None and "ASSESS_CI" not in os.environ, reason="no Chromium or Chrome is installed"
    ),
]

OVER_THE_EDGE = """width => [...document.querySelectorAll("body *")]
    .filter((one) => !one.closest("svg *, .scroller") && one.getBoundingClientRect().width > 0)
    .filter((one) => one.getBoundingClientRect().right > width + 0.5)
    .map((one) => `${one.tagName}.${one.className}: ${one.textContent.trim().slice(0, 40)}`)"""
MARK_SCROLLERS = """() => [...document.querySelectorAll("body *")]
    .filter((one) => /auto|scroll/.test(getComputedStyle(one).overflowX) && one.scrollWidth > one.clientWidth + 1)
    .map((one) => (one.classList.add("scroller"), one))
    .map((one) => [one.tabIndex, one.ariaLabel ?? one.getAttribute("aria-labelledby")])"""
LINES_OF_TEXT = """all => all.map((one) => {
    const range = document.createRange();
    range.selectNodeContents(one);
    return range.getClientRects().length;
})"""
FURTHER_ROWS_AWAY = """rows => document.querySelectorAll(`tbody tr:nth-child(n + ${rows + 1})`)
    .forEach((one) => one.remove())"""
CELLS_WITHOUT_A_LABEL = """() => [...document.querySelectorAll("table:has(thead) tbody td")]
    .filter((one) => one.dataset.label === undefined || (one.dataset.label === "" && one.textContent.trim() !== ""))
    .map((one) => one.closest("table").className + ": " + one.textContent.trim().slice(0, 40))"""


@pytest.fixture(scope="module")
def report(example, tmp_path_factory):
    return assess.write_reports(example, tmp_path_factory.mktemp("phone"), "html")["html"]


@pytest.fixture
def open_page(browser, report):
    pages = []

    def open_page(width, path=report):
        pages.append(browser.new_page(viewport={"width": width, "height": 844}))
        if path:
            pages[-1].goto(path.as_uri())
        return pages[-1]

    yield open_page
    for page in pages:
        page.close()


@pytest.fixture(scope="module")
def look(browser, report):
    """Open the report once at each width, for tests that change nothing that is seen."""
    pages = {}

    def look(width):
        if width not in pages:
            pages[width] = browser.new_page(viewport={"width": width, "height": 844})
            pages[width].goto(report.as_uri())
        return pages[width]

    yield look
    for page in pages.values():
        page.close()


@pytest.mark.parametrize("width", [PHONE, 320])
def test_nothing_runs_off_the_edge(look, width):
    page = look(width)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    for tab_index, name in page.evaluate(MARK_SCROLLERS):
        assert tab_index == 0
        assert name
    assert page.evaluate(OVER_THE_EDGE, width) == []


def test_an_element_that_does_run_off_is_found(open_page):
    page = open_page(PHONE, None)
    page.set_content('<main><p style="width: 50rem">x</p></main>')
    page.evaluate(MARK_SCROLLERS)
    assert page.evaluate(OVER_THE_EDGE, PHONE) == ["P.: x"]


def test_rows_are_cards_whose_cells_have_the_heads_of_their_columns(look):
    page = look(PHONE)
    assert page.evaluate(CELLS_WITHOUT_A_LABEL) == []
    heads = page.locator("#pieces thead th").evaluate_all("all => all.map(one => one.textContent)")
    row = page.locator("#row-1 td")
    assert row.evaluate_all("all => all.map(one => one.dataset.label)") == heads
    shown = "one => getComputedStyle(one, '::before').content"
    assert row.first.evaluate(shown) == '"Item"'
    boxes = [row.nth(at).bounding_box() for at in range(3)]
    assert boxes[0]["y"] < boxes[1]["y"] < boxes[2]["y"]
    for name in ("routes", "segments", "beside"):
        first, second = (page.locator(f"table.{name} tbody tr").first.locator("td").nth(at) for at in (0, 1))
        assert first.bounding_box()["y"] < second.bounding_box()["y"]
        assert first.evaluate(shown) != "none"


def test_who_is_responsible_is_whole_and_asks_for_no_signature(look):
    table = look(PHONE).locator("table.signing")
    for role in ("Prepared by", "Checked by", "Approved by"):
        box = table.get_by_text(role, exact=True).bounding_box()
        assert box["height"] < 40, "on one line"
    labels = table.locator("tbody tr").first.locator("td").evaluate_all("all => all.map(one => one.dataset.label)")
    assert labels == ["Name"], "a page is not signed"


def test_filters_work_with_a_thumb(open_page):
    page = open_page(PHONE)
    bar = page.locator("#filter-bar")
    floors = bar.get_by_label("Floor", exact=True)
    floors.select_option("42")
    shown = page.locator("#pieces tbody tr:visible")
    assert 0 < shown.count() < page.locator("#pieces tbody tr").count()
    assert set(shown.evaluate_all("all => all.map(one => one.dataset.floor)")) == {"42"}
    for control in bar.locator("select:visible, input:visible, button:visible").all():
        assert control.bounding_box()["height"] >= 44, "WCAG 2.2, 2.5.5: a target of 44 pixels"


@pytest.mark.parametrize("width", [DESK, PHONE])
def test_no_name_of_a_piece_is_broken_at_its_hyphen(look, width):
    names = look(width).locator("#routes td a[href^='#row-']:visible")
    assert names.count() > 30
    assert set(names.evaluate_all(LINES_OF_TEXT)) == {1}


@pytest.mark.parametrize("rows", [8, pytest.param(10_000, marks=pytest.mark.long)])
@pytest.mark.parametrize("width", [pytest.param(DESK, marks=pytest.mark.long), PHONE])
def test_axe_finds_nothing_serious(open_page, width, rows):
    """Also none of less weight: whatever axe-core is sure of. Of the rows of each table, which are alike, so many."""
    page = open_page(width)
    page.evaluate(FURTHER_ROWS_AWAY, rows)
    assert page.evaluate("matchMedia('(prefers-color-scheme: dark)').matches") is False, "there is one scheme"
    assert _examine(page) == []


def test_axe_can_find_something(open_page):
    page = open_page(PHONE, None)
    page.set_content('<main><img src="data:,"><p style="color: #ccc">pale</p></main>')
    assert {name for name, _impact, _html in _examine(page)} >= {"image-alt", "color-contrast"}


def _examine(page):
    """Return what axe-core finds: rule, impact and the first element of each."""
    page.evaluate(AXE.read_text(encoding="utf-8"))
    found = page.evaluate("axe.run({resultTypes: ['violations']})")["violations"]
    return [(one["id"], one["impact"], one["nodes"][0]["html"]) for one in found]
