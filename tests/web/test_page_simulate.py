"""Simulate and report: a job from the page, its results, its report in a frame."""

import re
import zipfile

import pytest
from playwright.sync_api import expect

from tests.web.looking import examine, show
from tests.web.opened import write_office, write_one_floor
from tests.workbooks import ITEMS

pytestmark = [pytest.mark.browser, pytest.mark.slow]

SIMULATED = [2, 3, 4, 5, 6]
"""Rows for which the simulation is adopted: all, as the height of the building is known; row 5 is anchored."""


@pytest.fixture
def simulating(page, served_here, tmp_path):
    found = page(served_here(write_one_floor(tmp_path / "office.xlsx", height=12.0)))
    show(found, "simulate")
    return found


def choose(page, *formats):
    for box in page.get_by_role("checkbox").all():
        box.set_checked(any(one in box.locator("xpath=..").inner_text() for one in formats))


def run(page, *formats, runs="100"):
    choose(page, *formats)
    page.get_by_label("Motions of each floor").select_option(runs)
    page.get_by_role("button", name=re.compile("Start the run|Simulate again")).click()
    expect(page.get_by_role("heading", name="Results")).to_be_visible()


def simulated(page):
    return page.evaluate(
        "async () => [...(await import('/store.mjs')).store.simulated].map(([row, one]) => [row, one.stale])"
    )


def test_from_start_to_report_and_pieces_changed_since(simulating):
    page = simulating
    run(page, "HTML", "CSV")
    frame = page.frame_locator("iframe[title=Report]")
    expect(frame.locator("h1").first).to_be_visible()
    assert page.locator("iframe").get_attribute("sandbox") == "allow-scripts"
    rows = [row for row, _ in simulated(page)]
    assert rows == SIMULATED
    header = page.locator(".counts-line")
    expect(header.get_by_label("Classes by")).to_have_value("simulated")
    found = header.get_by_role("list").inner_text()
    results = page.get_by_role("region", name="Results")
    counts, fixed = results.get_by_role("table").first, results.get_by_role("table").nth(1)
    for table in (counts, fixed):  # each column is all pieces, and the classes are those of the header
        rows = [row.locator("td").all_inner_texts() for row in table.locator("tbody tr").all()][:7]
        one, other = ([int(row[at]) for row in rows if row[at].isdecimal()] for at in (0, 1))
        assert sum(one[:-1]) == one[-1] == other[-1] == sum(other[:-1])
    assert [row.locator("td").last.inner_text() for row in counts.locator("tbody tr").all()][:4] == re.findall(
        r"[■▲◇○] (\d+)", found)  # fmt: skip
    show(page, "sheet")
    column = page.get_by_role("grid").locator("[data-label='Simulated class']").get_attribute("aria-colindex")
    cells = page.get_by_role("grid").locator(f"[role=gridcell][aria-colindex='{column}']")
    assert cells.evaluate_all("all => all.filter((one) => one.scrollWidth > one.clientWidth).length") == 0
    header.get_by_label("Classes by").select_option("formula")
    expect(header.get_by_role("list", name="Pieces by class, by formula")).to_be_visible()
    header.get_by_label("Classes by").select_option("simulated")
    show(page, "what-if")
    expect(page.locator(".basis-note")).to_contain_text("not those of the simulation, which found")
    expect(page.get_by_text("by the simulation it has")).to_be_visible()
    show(page, "simulate")
    assert examine(page) == []
    with page.expect_download() as download:
        page.get_by_role("link", name="Download all in one file").click()
    with zipfile.ZipFile(download.value.path()) as archive:
        assert {"items.csv", "report.html", "results.json"} <= set(archive.namelist())
    page.reload()
    expect(page.frame_locator("iframe[title=Report]").locator("h1").first).to_be_visible()
    assert [row for row, _ in simulated(page)] == SIMULATED
    expect(page.locator(".stale-note")).to_have_count(0)
    page.evaluate("""async () => {
        const { store } = await import("/store.mjs");
        store.edit([["Items", 4, store.sheet("Items").column("height").at, 60]], "typing");
    }""")
    expect(page.locator(".stale-note")).to_contain_text("1 piece.")
    expect(page.locator(".counts-line")).to_contain_text("1 row changed since")
    assert [row for row, is_stale in simulated(page) if is_stale] == [4]
    page.get_by_role("button", name="Undo").click()
    expect(page.locator(".stale-note")).to_have_count(0)


def test_a_run_is_found_again_after_a_reload_and_cancelled_and_another_is_by_the_formula_alone(simulating):
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
    page.get_by_label("None: reports by the formula only").check()
    run(page, "CSV")
    expect(page.get_by_text("Nothing was simulated")).to_be_visible()
    assert simulated(page) == []


def test_a_workbook_with_errors_says_which(page, served_here, tmp_path):
    items = [ITEMS[0] | {"height": "tall"}, ITEMS[1] | {"type": "Zorp"}, *ITEMS[2:]]
    found = page(served_here(write_office(tmp_path / "office.xlsx", items)))
    expect(found.locator(".counts-line")).to_contain_text("by formula")
    show(found, "simulate")
    found.get_by_role("button", name="Start the run").click()
    said = found.locator("#view-simulate [role=alert]")
    expect(said).to_contain_text("1 error to correct first")
    expect(said.get_by_role("listitem").filter(visible=True)).to_have_count(1)
    expect(said).to_contain_text("'tall'")
    said.get_by_role("button").first.click()
    expect(found.locator("#view-sheet")).to_be_visible()
    expect(found.locator(".sheet-cell")).to_contain_text("2")
