"""The empty state of the page: a new building on one screen, a blank workbook, the worked example."""

import re

import pytest
from openpyxl import load_workbook
from playwright.sync_api import expect

import assess
from tests.conftest import EXAMPLE
from tests.web.looking import examine
from tests.web.sheet_page import CLASS, SheetPage

pytestmark = [pytest.mark.browser, pytest.mark.slow]
A_CLASS = re.compile("low|medium|high")
RECORD = EXAMPLE.parents[1] / "samples" / "records" / "1103.HN2.NP.RE_a.smc"


@pytest.fixture
def started(page, served_here):
    server = served_here()
    found = page(server)
    expect(found.get_by_role("button", name="New building")).to_be_visible()
    return found, server


def test_the_worked_example_with_one_click_and_a_blank_workbook(started):
    page, server = started
    page.get_by_role("link", name="Open the worked example").click()
    expect(page.get_by_role("heading", name=EXAMPLE.name)).to_be_visible()
    expect(SheetPage(page, server).cell(CLASS, 5)).to_contain_text("high")
    expect(page.get_by_role("button", name=re.compile("missing"))).to_be_hidden()
    page.evaluate("location.hash = 'start'")
    page.get_by_role("link", name="Open the worked example").press("Enter")
    expect(page.get_by_role("heading", name="market-street-2.xlsx")).to_be_visible()
    assert (server.folder / EXAMPLE.name).read_bytes() == EXAMPLE.read_bytes()
    page.evaluate("location.hash = 'start'")
    page.get_by_role("button", name="New building").click()
    page.get_by_label("Name of the file").fill("market-street")
    page.get_by_role("button", name="Blank workbook").click()
    expect(page.locator(".new [role=alert]")).to_contain_text("market-street.xlsx exists already.")
    page.get_by_label("Name of the file").fill("blank")
    page.get_by_role("button", name="Blank workbook").click()
    expect(page.get_by_role("heading", name="blank.xlsx")).to_be_visible()
    assert (server.folder / "blank.xlsx").is_file()


def test_hospital_3rd_floor_mmi_viii_ends_in_a_class_by_keyboard_alone(started):
    """The name of each field that has the focus is looked at before anything is typed."""
    page, server = started
    page.get_by_role("button", name="New building").focus()
    page.keyboard.press("Enter")
    for name, keys in (
        ("use", "Hospital"), ("building", "Ospedale San Carlo"), ("address", ""), ("storeys", ""), ("height", ""),
        ("structure", ""), ("coordinates", ""), ("", ""), ("shaking", "MMI VIII"), ("floor", "3rd floor"),
    ):  # fmt: skip
        expect(page.locator(f"[name={name}]" if name else "summary")).to_be_focused()
        if name == "floor":
            page.keyboard.press("Control+a")
        page.keyboard.type(keys)
        page.keyboard.press("Tab")
    assert examine(page) == []
    expect(page.get_by_label("Name of the file")).to_have_value("ospedale-san-carlo.xlsx")
    page.keyboard.press("Enter")
    expect(page.get_by_role("heading", name="ospedale-san-carlo.xlsx")).to_be_visible()
    expect(SheetPage(page, server).cell(CLASS, 2)).to_contain_text(A_CLASS)
    inventory = assess.read_inventory(server.folder / "ospedale-san-carlo.xlsx")
    assert [(one.floor, one.elevation) for one in inventory.floors] == [("0", 0), ("1", 3.3), ("2", 6.6), ("3", 9.9)]
    assert (inventory.items[0].floor, inventory.building.shaking) == ("3", "MMI VIII, severe")


def test_fields_say_what_is_wrong_as_one_types_and_a_click_on_the_map_sets_coordinates(started):
    page, server = started
    page.get_by_role("button", name="New building").click()
    page.get_by_label("Name of the building").fill("Scuola Manzoni, Pisa")
    page.get_by_label("Use").select_option("School")
    for field, wrong, why, right in (
        ("storeys", "2.5", "whole number from 1 to 300", "4"), ("height", "1", "from 2 to 1000 m", "14 m"),
        ("coordinates", "Berkeley", "such as 37.87, -122.27", "43,7° N 10,4° E"),
    ):  # fmt: skip
        cell = page.locator(f"[name={field}]")
        cell.press_sequentially(wrong)
        expect(page.locator(f"#new-{field}-help")).to_contain_text(why)
        expect(cell).to_have_attribute("aria-invalid", "true")
        page.get_by_role("button", name="Make the workbook").click()
        expect(cell).to_be_focused()
        cell.fill(right)
        expect(cell).not_to_have_attribute("aria-invalid", "true")
    page.get_by_label("Floor").fill("9")
    expect(page.locator("#new-floor-help")).to_have_text("The building has 4 storeys: its floors are 0 to 3.")
    page.get_by_label("Floor").fill("2")
    page.get_by_text("On the map of San Francisco Bay").click()
    page.locator(".map").click(position={"x": 136, "y": 120})
    expect(page.locator("[name=coordinates]")).to_have_value(re.compile(r"^37\.\d{4}, -122\.\d{4}$"))
    assert examine(page) == []
    page.get_by_label("Shaking of the ground").select_option("I know PGA and PGV")
    page.get_by_label("Ground PGA").fill("0.35")
    page.get_by_label("Ground PGV").fill("4000")
    expect(page.locator("#new-ground_pgv-help")).to_contain_text("0.01 to 1000 cm/s")
    page.get_by_label("Ground PGV").fill("40")
    page.get_by_label("Type of furniture").select_option("Bookcase tall")
    expect(page.locator("#view-start")).to_contain_text("28 × 80 × 202 cm")
    page.get_by_label("How many").fill("3")
    page.get_by_role("button", name="Add another type").click()
    page.get_by_role("button", name="Make the workbook").click()
    expect(page.get_by_role("heading", name="scuola-manzoni-pisa.xlsx")).to_be_visible()
    expect(SheetPage(page, server).cell(CLASS, 2)).to_contain_text(A_CLASS)
    found = assess.read_inventory(server.folder / "scuola-manzoni-pisa.xlsx")
    assert [(one.room, one.floor) for one in found.items] == [("Classroom", "2")] * 4
    assert (found.building.storeys, found.building.height) == (4, 14)
    assert found.building.latitude == pytest.approx(37.8, abs=0.3)


def test_the_record_of_the_nearest_station_goes_to_the_folder_and_serves_the_floors(started):
    page, server = started
    page.get_by_role("button", name="New building").click()
    page.get_by_label("Shaking of the ground").select_option("I have a record of the nearest station")
    page.locator("[name=records]").set_input_files(RECORD)
    page.get_by_label("Floor").fill("2")
    page.get_by_role("button", name="Make the workbook").click()
    expect(page.get_by_role("heading", name="office.xlsx")).to_be_visible()
    expect(SheetPage(page, server).cell(CLASS, 2)).to_contain_text(A_CLASS)
    assert (server.folder / RECORD.name).read_bytes() == RECORD.read_bytes()
    (record,) = assess.read_inventory(server.folder / "office.xlsx").floors[0].records["X"]
    assert record.file == RECORD.name


def test_in_italian_the_workbook_and_the_example_are_italian(page, served_here):
    server = served_here()
    found = page(server, locale="it-IT")
    found.get_by_role("button", name="Nuovo edificio").click()
    found.get_by_role("button", name="Crea la cartella di lavoro").click()
    expect(found.get_by_role("heading", name="uffici.xlsx")).to_be_visible()
    assert "Arredi" in load_workbook(server.folder / "uffici.xlsx").sheetnames
    assert server.client.get("/api/book").json()["language"] == "it"
    found.evaluate("location.hash = 'start'")
    found.get_by_role("link", name="Apri l'esempio svolto").click()
    expect(found.get_by_role("heading", name=EXAMPLE.name)).to_be_visible()
    expect(found.get_by_text("Ufficio sud").first).to_be_visible()
    assert server.client.get("/api/book").json()["language"] == "it"
