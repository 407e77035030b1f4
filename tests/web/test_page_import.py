"""A building model on the page: dropped or chosen, read, what was skipped, and the new workbook."""

import re
from pathlib import Path

import pytest
from playwright.sync_api import expect

from assess.web.limits import MOST_MODEL
from tests.bim import scan_files
from tests.waiting import wait_until
from tests.web.looking import examine, open_menu
from tests.web.model_reader import hold_reader, is_gone, linux, write_house
from tests.web.opened import write_office
from tests.web.sheet_page import CLASS, SheetPage
from tests.web.test_page_phone import OVER_THE_EDGE, WIDTH
from tests.web.test_page_shell import drop

pytestmark = [pytest.mark.browser, pytest.mark.slow]

MODELS = Path(__file__).parents[2] / "samples" / "models"
DUPLEX = MODELS / "duplex.ifc"


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    return write_house(tmp_path_factory.mktemp("house") / "house.ifc")


def _choose(page, *files):
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Open a file").press("Enter")
    chooser.value.set_files(*files)


def _see_list(page, name):
    expect(page.get_by_role("heading", name=f"What was taken from {name}")).to_be_visible()
    return page.locator("#view-import")


def test_a_dropped_model_shows_what_was_taken_and_becomes_a_workbook(page, served_here):
    server = served_here()
    found = page(server)
    expect(found.get_by_label("Draft evacuation routes")).not_to_be_checked()
    drop(found, "scan.json", scan_files.write(scan_files.office()))
    shown = _see_list(found, "scan.json")
    expect(found.get_by_role("heading", name="What was taken")).to_be_focused()
    expect(shown).to_contain_text("4 of 5 pieces on 1 floor")
    expect(shown).to_contain_text("1 piece skipped that may be furniture")
    table = shown.get_by_role("table").first
    expect(table.get_by_role("rowheader", name="Not on the floor")).to_be_visible()
    rows = table.locator("tr:not(.reason) td.num").all_inner_texts()
    assert rows == ["1"]
    expect(shown.get_by_role("heading", name="What to check")).to_be_visible()
    assert examine(found) == []
    found.set_viewport_size({"width": WIDTH, "height": 844})
    assert found.evaluate(OVER_THE_EDGE, WIDTH) == []
    found.set_viewport_size({"width": 1280, "height": 900})
    found.reload()
    _see_list(found, "scan.json")
    shown.get_by_label("Shaking of the ground").select_option(label="MMI VIII, severe")
    shown.get_by_role("button", name="Open the workbook").click()
    expect(found.get_by_role("heading", name="scan.xlsx")).to_be_visible()
    expect(SheetPage(found, server).cell(CLASS, 2)).to_contain_text(re.compile("low|medium|high"))
    assert (server.folder / "scan.xlsx").is_file()
    open_menu(found).get_by_role("link", name="Imported").click()
    _see_list(found, "scan.json")
    found.get_by_role("link", name="Back to scan.xlsx").click()
    expect(found.locator("#view-sheet")).to_be_visible()


FORMULAS = ('=HYPERLINK("https://example.org")', "+1", "-1", "@SUM(A1)", "\t=1", " =1", "Desk\t=1", "Desk\n=1", "A=1")


def test_the_list_of_what_was_skipped_is_copied_and_none_of_it_becomes_a_formula(page, served_here, house):
    found = page(served_here(), permissions=["clipboard-read", "clipboard-write"])
    _choose(found, house)
    _see_list(found, house.name).get_by_role("button", name="Copy the list").click()
    expect(found.locator(".notice")).to_contain_text("The list was copied")
    lines = found.evaluate("() => navigator.clipboard.readText()").splitlines()
    assert lines[0].split("\t") == ["Reason", "Type", "Number"]
    assert [line.split("\t")[1:] for line in lines[1:]] == [["IfcFurniture Shelf", "1"]]
    found.get_by_role("button", name="Discard").click()
    expect(found.get_by_role("button", name="Open a file")).to_be_visible()
    rows = [["Not on the floor", name, 3] for name in FORMULAS]
    text = found.evaluate("async (rows) => (await import('/clipboard.mjs')).writeList(rows)", rows)
    cells = [line.split("\t") for line in text.split("\n")]
    assert [(one[0], one[2]) for one in cells] == [("Not on the floor", "3")] * len(FORMULAS)
    assert [one[1] for one in cells] == [
        '\'=HYPERLINK("https://example.org")', "'+1", "'-1", "'@SUM(A1)", "' =1", "' =1", "Desk =1", "Desk =1", "A=1",
    ]  # fmt: skip


def test_a_model_that_cannot_be_read_is_told_and_a_second_try_works(page, served_here, house, tmp_path):
    server = served_here()
    found = page(server)
    cut = tmp_path / "cut.ifc"
    cut.write_bytes(DUPLEX.read_bytes()[:200_000])
    _choose(found, cut)
    fault = found.locator(".import-card [role=alert]")
    expect(fault).to_contain_text("cut.ifc")
    expect(fault).to_contain_text("END-ISO-10303-21")
    expect(found.get_by_role("button", name="Open a file")).to_be_focused()
    assert examine(found) == []
    huge = tmp_path / "huge.ifc"
    with huge.open("wb") as file:
        file.truncate(MOST_MODEL + 1)
    _choose(found, huge)
    expect(fault).to_contain_text("huge.ifc is larger than 256 MB.")
    assert list(server.folder.iterdir()) == []
    _choose(found, house)
    _see_list(found, house.name)


@linux
def test_a_reading_is_shown_and_cancelled_by_a_button_or_by_leaving(page, served_here):
    server = served_here()
    found = page(server)
    _choose(found, DUPLEX)
    hold_reader(server)
    card = found.locator(".import-card")
    expect(card.get_by_role("progressbar", name="Reading the building model")).to_be_visible()
    expect(card.get_by_role("status")).to_have_text("Reading duplex.ifc")
    expect(card).to_contain_text("you may go on working")
    expect(found.get_by_role("button", name="Cancel")).to_be_focused()
    assert examine(found) == []
    found.keyboard.press("Enter")
    expect(card.locator(".fault")).to_have_text("Reading duplex.ifc was cancelled. Nothing of it was kept.")
    expect(found.get_by_role("button", name="Open a file")).to_be_focused()
    _choose(found, DUPLEX)  # a page that is left ends its reading
    reader = hold_reader(server)
    expect(found.locator(".import-card").get_by_role("status")).to_have_text("Reading duplex.ifc")
    found.goto("about:blank")
    wait_until(lambda: is_gone(reader), bool)


def test_a_model_dropped_on_an_open_workbook_becomes_another(page, served_here, house, tmp_path):
    server = served_here(write_office(tmp_path / "office.xlsx"))
    before = (tmp_path / "office.xlsx").read_bytes()
    found = page(server)
    expect(found.get_by_role("heading", name="office.xlsx")).to_be_visible()
    drop(found, "house.ifc", house.read_bytes())
    asked = found.get_by_role("dialog")
    expect(asked).to_contain_text("house.ifc is read into a new workbook. office.xlsx stays as it is.")
    asked.get_by_role("button", name="Cancel").click()
    expect(found.get_by_role("heading", name="office.xlsx")).to_be_visible()
    drop(found, "house.ifc", house.read_bytes())
    asked.get_by_role("button", name="Read it", exact=True).click()
    shown = _see_list(found, house.name)
    expect(open_menu(found).get_by_role("link", name="Imported")).to_be_hidden()  # office.xlsx was not
    found.keyboard.press("Escape")
    shown.get_by_role("button", name="Open the workbook").click()
    expect(found.get_by_role("heading", name="house.xlsx")).to_be_visible()
    expect(found.locator(".notice")).to_contain_text("choose Shaking in Building")
    found.locator(".notice").get_by_role("button", name="Choose the shaking").click()
    expect(found.locator(".sheet-tabs [data-sheet=Building]")).to_have_attribute("aria-selected", "true")
    assert (tmp_path / "office.xlsx").read_bytes() == before
