"""Simulate and report: a job from the page, its results, its report in a frame."""

import re
import zipfile

import pytest
from playwright.sync_api import expect

from tests.web.looking import examine, show
from tests.workbooks import ITEMS, write

pytestmark = [pytest.mark.browser, pytest.mark.slow]

LONG = 120_000
SIMULATED = [4, 6]
"""Rows for which the simulation is adopted; the others are anchored, or keep the formula's class."""


@pytest.fixture
def simulating(page, served, tmp_path):
    """Return a page that shows the simulation of a small workbook."""
    found = page(served(write(tmp_path / "office.xlsx")))
    show(found, "simulate")
    return found


def choose(page, *formats):
    """Have only these formats written."""
    for box in page.get_by_role("checkbox").all():
        box.set_checked(any(one in box.locator("xpath=..").inner_text() for one in formats))


def run(page, *formats, runs="100"):
    choose(page, *formats)
    page.get_by_label("Motions of each floor").select_option(runs)
    page.get_by_role("button", name=re.compile("Start the run|Simulate again")).click()
    expect(page.get_by_role("heading", name="Results")).to_be_visible(timeout=LONG)


def simulated(page):
    return page.evaluate(
        "async () => [...(await import('/store.mjs')).store.simulated].map(([row, one]) => [row, one.stale])"
    )


def test_from_start_to_report(simulating):
    page = simulating
    run(page, "HTML", "CSV")
    frame = page.frame_locator("iframe[title=Report]")
    expect(frame.locator("h1").first).to_be_visible(timeout=LONG)
    assert page.locator("iframe").get_attribute("sandbox") == "allow-scripts"
    rows = [row for row, _ in simulated(page)]
    assert rows == SIMULATED
    counts = page.get_by_role("region", name="Results").get_by_role("table").first
    assert counts.locator("tbody tr").count() == 4
    assert examine(page) == []
    with page.expect_download() as download:
        page.get_by_role("link", name="Download all in one file").click()
    with zipfile.ZipFile(download.value.path()) as archive:
        assert {"items.csv", "report.html", "results.json"} <= set(archive.namelist())
    page.reload()
    expect(page.frame_locator("iframe[title=Report]").locator("h1").first).to_be_visible(timeout=LONG)
    assert [row for row, _ in simulated(page)] == SIMULATED


def test_pieces_changed_since_are_told_apart(simulating):
    page = simulating
    run(page, "CSV")
    expect(page.locator(".stale-note")).to_have_count(0)
    page.evaluate("""async () => {
        const { store } = await import("/store.mjs");
        store.edit([["Items", 4, store.sheet("Items").column("height").at, 60]], "typing");
    }""")
    expect(page.locator(".stale-note")).to_contain_text("1 piece.")
    assert [row for row, is_stale in simulated(page) if is_stale] == [4]
    page.get_by_role("button", name="Undo").click()
    expect(page.locator(".stale-note")).to_have_count(0)


def test_reports_by_the_formula_alone(simulating):
    page = simulating
    page.get_by_label("None: reports by the formula only").check()
    run(page, "HTML")
    expect(page.get_by_text("Nothing was simulated")).to_be_visible()
    assert simulated(page) == []


def test_a_run_is_found_again_after_a_reload_and_can_be_cancelled(simulating):
    page = simulating
    choose(page, "PDF", "HTML")
    page.get_by_label("Motions of each floor").select_option("auto")
    page.get_by_role("button", name="Start the run").click()
    expect(page.get_by_role("progressbar")).to_be_visible()
    page.reload()
    expect(page.get_by_role("progressbar")).to_be_visible()
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_text("was cancelled")).to_be_visible()
    expect(page.get_by_role("button", name="Start the run")).to_be_enabled()
    assert page.evaluate("async () => (await (await fetch('/api/job')).json()).job.state") == "cancelled"


def test_a_workbook_with_errors_says_which(page, served, tmp_path):
    found = page(served(write(tmp_path / "office.xlsx", [ITEMS[0] | {"height": "tall"}, *ITEMS[1:]])))
    show(found, "simulate")
    found.get_by_role("button", name="Start the run").click()
    said = found.locator("#view-simulate [role=alert]")
    expect(said).to_contain_text("'tall'")
    said.get_by_role("button").first.click()
    expect(found.locator("#view-sheet")).to_be_visible()
    expect(found.locator(".sheet-cell")).to_contain_text("2")
