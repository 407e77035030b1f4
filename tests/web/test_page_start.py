"""The empty state of the page: the worked example, a new workbook in three steps, a blank one."""

import re

import pytest
from openpyxl import load_workbook
from playwright.sync_api import expect

from tests.conftest import EXAMPLE
from tests.web.looking import examine, open_menu
from tests.web.sheet_page import CLASS, SheetPage

pytestmark = [pytest.mark.browser, pytest.mark.slow]


@pytest.fixture
def started(page, served_here):
    server = served_here()
    found = page(server)
    expect(found.get_by_role("heading", name="Make a new workbook")).to_be_visible()
    return found, server


def test_the_worked_example_with_one_click_and_steps_that_are_skipped(started):
    page, server = started
    page.get_by_role("button", name="Open the worked example").click()
    expect(page.get_by_role("heading", name=EXAMPLE.name)).to_be_visible()
    expect(SheetPage(page, server).cell(CLASS, 5)).to_contain_text("high")
    expect(page.get_by_role("button", name=re.compile("missing"))).to_be_hidden()
    open_menu(page).get_by_role("link", name="New or open").click()
    page.get_by_role("button", name="Open the worked example").click()
    expect(page.get_by_role("heading", name="market-street-2.xlsx")).to_be_visible()
    assert (server.folder / EXAMPLE.name).read_bytes() == EXAMPLE.read_bytes()
    open_menu(page).get_by_role("link", name="New or open").click()
    page.get_by_role("button", name="Skip the rest and make it").click()
    expect(page.get_by_role("heading", name="office.xlsx")).to_be_visible()
    open_menu(page).get_by_role("link", name="New or open").click()
    page.get_by_role("button", name="Blank workbook").click()
    expect(page.locator(".steps [role=alert]")).to_contain_text("office.xlsx exists already.")
    page.get_by_label("Name of the file").fill("blank")
    page.get_by_role("button", name="Blank workbook").click()
    expect(page.get_by_role("heading", name="blank.xlsx")).to_be_visible()
    assert (server.folder / "blank.xlsx").is_file()


def test_three_steps_lead_to_the_first_class(started):
    page, server = started
    page.get_by_label("Use").select_option("School")
    page.get_by_label("Name of the building").fill("Scuola Manzoni, Pisa")
    page.get_by_role("button", name="Next").click()
    assert examine(page) == []
    page.get_by_label("Shaking of the ground").select_option(label="MMI VIII, severe")
    page.get_by_role("button", name="Next").click()
    assert examine(page) == []
    expect(page.get_by_label("Name of the file")).to_have_value("scuola-manzoni-pisa.xlsx")
    expect(page.get_by_label("Room")).to_have_value("Classroom")
    page.get_by_label("Type of furniture").select_option("Bookcase tall")
    expect(page.locator("#view-start")).to_contain_text("28 × 80 × 202 cm")
    page.get_by_label("How many").fill("3")
    page.get_by_role("button", name="Add another type").click()
    page.get_by_role("button", name="Make the workbook").click()
    expect(page.get_by_role("heading", name="scuola-manzoni-pisa.xlsx")).to_be_visible()
    expect(SheetPage(page, server).cell(CLASS, 2)).to_contain_text(re.compile("low|medium|high"))
    made = load_workbook(server.folder / "scuola-manzoni-pisa.xlsx")["Items"]
    assert [made.cell(row, 4).value for row in range(2, 7)] == ["Classroom"] * 4 + [None]


def test_in_italian_the_workbook_is_italian(page, served_here):
    server = served_here()
    found = page(server, locale="it-IT")
    found.get_by_role("button", name="Salta il resto e crea").click()
    expect(found.get_by_role("heading", name="uffici.xlsx")).to_be_visible()
    assert "Arredi" in load_workbook(server.folder / "uffici.xlsx").sheetnames
    assert server.client.get("/api/book").json()["language"] == "it"
