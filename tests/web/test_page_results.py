"""Results: files made one by one of one run, the report in a tab of its own, runs kept and compared."""

import json
import re
from pathlib import Path

import pytest
from playwright.sync_api import expect

from tests.web.looking import examine, show
from tests.web.opened import write_office, write_one_floor
from tests.workbooks import ITEMS

pytestmark = [pytest.mark.browser, pytest.mark.slow]

CSV, JSON, PDF, WEB = "Table of the pieces (CSV)", "All results", "Report for the client (PDF)", "Report as a web page"
EDIT = """async ([row, field, value]) => {
    const { store } = await import("/store.mjs");
    store.edit([["Items", row, store.sheet("Items").column(field).at, value]], "typing");
}"""


def open_results(page, server):
    found = page(server)
    show(found, "results")
    return found


def make(page, label):
    page.get_by_role("button", name=f"Make: {label}").click()


def row(page, label):
    return page.locator(".file-rows li").filter(has_text=label)


def read_json(page):
    with page.expect_download() as download:
        page.get_by_role("link", name="Download results.json").click()
    return json.loads(Path(download.value.path()).read_text(encoding="utf-8"))


def test_one_button_a_file_the_report_in_its_own_tab_and_two_runs_compared(page, served_here, tmp_path):
    page = open_results(page, served_here(write_one_floor(tmp_path / "office.xlsx", height=12.0)))
    make(page, WEB)
    make(page, CSV)  # while the first is being made: of the same run, one after another
    expect(page.get_by_role("progressbar", name="Progress")).to_be_visible()
    view = page.locator("#view-results")
    expect(view.locator("h2")).to_have_text(re.compile(r"of \d+ free-standing pieces fall"))
    results = read_json(page)  # as soon as the computation ends
    free = [one for one in results["items"] if not one["anchor"]["counts_as_anchored"]]
    expect(view.locator("h2")).to_contain_text(f"of {sum(one['quantity'] for one in free)} free-standing")
    page.reload()
    expect(row(page, CSV).get_by_role("link", name="Download")).to_be_visible()
    high = sum(one["quantity"] for one in free if one["adopted"]["class"] == "high")
    expect(view.locator(".tiles li").filter(has_text=re.compile(r"^▲ high"))).to_contain_text(f"high {high}")
    assert examine(page) == []
    with page.expect_popup() as opened:
        row(page, WEB).get_by_role("link", name="Open").click()
    report = opened.value
    expect(report.locator("h1").first).to_be_visible()
    report.reload()
    expect(report.locator("h1").first).to_be_visible()
    assert report.evaluate("() => origin") == "null", "it belongs to no address"
    report.close()
    expect(view.get_by_role("row")).to_have_count(2)
    page.evaluate(EDIT, [2, "height", 90])
    expect(view).to_contain_text("The workbook has been changed since.")
    make(page, JSON)
    compared = view.locator(".compared")
    expect(compared.get_by_role("row", name=re.compile("^A1"))).to_contain_text("Height: 200 → 90 cm")
    expect(compared.locator("h3")).to_have_text(re.compile("^Nothing gets worse. Better: 1 of"))
    with page.expect_popup() as opened:
        compared.get_by_role("link", name="Open the whole comparison").click()
    expect(opened.value.locator("h1").first).to_be_visible()
    opened.value.close()
    view.get_by_role("radio", name="Before:").first.check()  # the same run before and after
    expect(compared).to_have_count(0)
    view.get_by_role("radio", name="After:").last.check()
    expect(compared.locator("h3")).to_have_text(re.compile("^Worse: 1 of"))
    view.get_by_role("button", name="Remove the run").last.click()
    expect(view.locator(".runs-table tbody tr")).to_have_count(1)
    expect(compared).to_have_count(0)


REFUSED = """async () => {
    const { jobs } = await import("/job.mjs");
    return jobs.post("/api/job", { formats: ["csv"] }).then(() => 200, (error) => error.status);
}"""
"""Ask for another run meanwhile."""


def test_a_run_is_found_again_and_cancelled_and_goes_by_its_settings(page, served_here, tmp_path):
    page = open_results(page, served_here(write_one_floor(tmp_path / "office.xlsx", height=12.0)))
    page.get_by_text("Settings", exact=True).click()
    page.get_by_label("Motions of each floor").select_option("auto")
    page.get_by_label("Scale of the shaking").fill("2")
    make(page, PDF)
    expect(page.get_by_role("progressbar", name="Progress")).to_be_visible()
    assert page.evaluate(REFUSED) == 409
    with page.expect_request(lambda asked: asked.method == "GET" and asked.url.endswith("/api/job")):
        pass  # how far it is is asked on
    page.reload()
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_text("was cancelled")).to_be_visible()
    assert page.evaluate("async () => (await (await fetch('/api/job')).json()).job.state") == "cancelled"
    page.get_by_text("Settings", exact=True).click()
    page.get_by_label("Which pieces are simulated").select_option("none")
    page.get_by_label("As if fixed").fill("1")
    make(page, CSV)
    expect(page.locator(".runs-table tbody tr")).to_contain_text("1 entry taken as fixed")
    settings = read_json(page)["assess"]["settings"]
    assert (settings["verify"], settings["anchor"]) == ("none", "first:1")


def test_what_is_not_confirmed_is_a_state_of_its_own_with_what_settles_it(page, served_here, tmp_path):
    """Not a class that did not change: nothing is known of the building, and simulation found lower classes."""
    page = open_results(page, served_here(write_one_floor(tmp_path / "office.xlsx")))
    make(page, JSON)
    view = page.locator("#view-results")
    items = [one for one in read_json(page)["items"] if not one["anchor"]["counts_as_anchored"]]
    n = sum(one["quantity"] for one in items if one["adopted"]["basis"] == "unconfirmed")
    assert n > 0
    expect(view.locator(".tiles li").filter(has_text="unconfirmed")).to_have_text(re.compile(rf"unconfirmed\s+{n}$"))
    expect(view.locator("h2")).to_contain_text(f"{n} unconfirmed pieces could fall")
    expect(view).to_contain_text("To settle this, fill in Storeys or Period")
    expect(view).not_to_contain_text("0 classes")


def test_a_workbook_with_errors_says_which(page, served_here, tmp_path):
    items = [ITEMS[0] | {"height": "tall"}, ITEMS[1] | {"type": "Zorp"}, *ITEMS[2:]]
    page = open_results(page, served_here(write_office(tmp_path / "office.xlsx", items)))
    make(page, PDF)
    said = page.locator("#view-results [role=alert]")
    expect(said).to_contain_text("1 error to correct first")
    expect(said.get_by_role("listitem")).to_have_count(1)
    expect(said).to_contain_text("'tall'")
    said.get_by_role("button").first.click()
    expect(page.locator("#view-sheet")).to_be_visible()
    expect(page.locator(".sheet-cell")).to_contain_text("2")
