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
FURTHER_ROWS_AWAY = """rows => document.querySelectorAll(`tbody tr:nth-child(n + ${rows + 1})`)
    .forEach((one) => one.remove())"""
CELLS_WITHOUT_A_LABEL = """() => [...document.querySelectorAll("table:has(thead) tbody td")]
    .filter((one) => one.dataset.label === undefined || (one.dataset.label === "" && one.textContent.trim() !== ""))
    .map((one) => one.closest("table").className + ": " + one.textContent.trim().slice(0, 40))"""


@pytest.fixture(scope="module")
def report(example, tmp_path_factory):
    return assess.write_reports(example, tmp_path_factory.mktemp("phone"), "html")["html"]


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


def test_rows_are_cards_whose_cells_have_the_heads_of_their_columns_and_axe_finds_nothing(look):
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
    # Also none of less weight: whatever axe-core is sure of. Of the rows of each table, which are alike, eight.
    page = look(PHONE)
    page.evaluate(FURTHER_ROWS_AWAY, 8)
    assert page.evaluate("matchMedia('(prefers-color-scheme: dark)').matches") is False, "there is one scheme"
    assert examine(page) == []


def examine(page):
    """Return what axe-core finds: rule, impact and the first element of each."""
    page.evaluate(AXE.read_text(encoding="utf-8"))
    found = page.evaluate("axe.run({resultTypes: ['violations']})")["violations"]
    return [(one["id"], one["impact"], one["nodes"][0]["html"]) for one in found]
