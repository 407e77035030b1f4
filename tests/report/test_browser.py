"""The HTML report in a browser: filters, sorting, the plan, printing, small screens, and what it may not do."""

import os

import pytest

import assess
from assess.settings import Settings
from docs.screenshot import find_browser
from tests.waiting import PATIENCE
from tests.workbooks import FLOORS, UNVERIFIED, write_sheets

DRAWS_EQUATIONS = True
pytestmark = [
    pytest.mark.browser,
    pytest.mark.slow,
    pytest.mark.skipif(
        find_browser() is None and "ASSESS_CI" not in os.environ, reason="no Chromium or Chrome is installed"
    ),
]

PIECES = [
    {"item": "A1", "floor": "1", "room": "Hall", "breadth": 30, "width": 80, "height": 200, "x": 2.0, "y": 3.0,
     "angle_deg": 90, "route": "R", "segment": "a", "description": "Bookcase"},
    {"item": "A2", "floor": "1", "room": "Office", "breadth": 40, "width": 90, "height": 180, "x": 5.0, "y": 3.0,
     "anchored": "yes"},
    {"item": "A3", "floor": "1", "room": "Office", "breadth": 90, "width": 90, "height": 92, "x": 5.0, "y": 6.0,
     "axis": "Y", "description": "Low chest"},
    {"item": "A10", "floor": "2", "room": "Archive", "breadth": 40, "height": 180, "quantity": 3},
    {"item": "B<i>1</i>", "floor": "2", "room": "Office", "breadth": 25, "width": 90, "height": 210, "x": 1.0,
     "y": 1.0},
]  # fmt: skip
PLACES = [{"place": "Hall", "floor": "1", "x": 1.0, "y": 1.0}, {"place": "Stair", "floor": "1", "x": 6.0, "y": 1.0}]
ROUTES = [{"route": "R", "segment": "a", "floor": "1", "start": "Hall", "end": "Stair", "clear_width": 1.2}]


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = tmp_path_factory.mktemp("browser")
    rows = {"Building": [{"building": "Town hall"}], "Floors": FLOORS, "Items": PIECES, "Places": PLACES}
    path = write_sheets(folder / "w.xlsx", rows | {"Routes": ROUTES})
    assessment = assess.run(assess.read_inventory(path), UNVERIFIED)
    return assess.write_reports(assessment, folder, "html")["html"]


@pytest.fixture
def open_page(browser, report):
    """Open the report in a window of its own; whatever it complains of, or asks the network for, fails the test."""
    contexts, complaints = [], []

    def open_page(width=1280, height=900, **options):
        context = browser.new_context(viewport={"width": width, "height": height}, **options)
        contexts.append(context)
        context.set_default_timeout(1e3 * PATIENCE)
        page = context.new_page()
        page.on("console", lambda message: complaints.append(message.text))
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("request", lambda one: complaints.extend([] if one.url.startswith(("file:", "data:")) else [one.url]))
        page.goto(report.as_uri())
        page.locator("#items > details > summary").click()  # the table of all pieces is folded
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert complaints == []


def _filter(page, label):
    return page.locator("#filter-bar").get_by_label(label, exact=True)


def _shown(page):
    return page.locator("#pieces tbody tr:visible td:first-child").all_inner_texts()


def _status(page):
    return page.locator("#filter-status").inner_text()


def test_it_opens_without_a_complaint_or_a_request_and_print_shows_the_rows_as_filtered(open_page):
    page = open_page()
    assert _shown(page) == ["A1", "A2", "A3", "A10", "B<i>1</i>"]
    assert _status(page) == "Rows: 5, all shown"
    page = open_page()
    page.emulate_media(media="print")
    assert not page.locator("#filter-bar").is_visible()
    page.emulate_media(media="screen")
    _filter(page, "Floor").select_option("1")
    page.emulate_media(media="print")
    assert not page.get_by_role("button", name="Show all").is_visible()
    assert not page.locator("#filter-floor").is_visible()
    assert _status(page) == "Rows: 3 of 5 shown: Floor: 1"
    assert page.locator("#pieces tbody tr:visible").count() == 3


def test_nothing_but_its_own_script_runs(browser, report):
    """A script that is slipped in is refused by the policy, whether inline, as a handler or from elsewhere."""
    page = browser.new_page()
    complaints = []
    page.on("console", lambda message: complaints.append(message.text))
    html = report.read_text(encoding="utf-8")
    slipped = "<script>window.ran = 1</script><img src='x' onerror='window.ran = 1' alt=''><script src='x.js'></script>"
    other = report.with_name("slipped.html")
    other.write_text(html.replace("</main>", f"{slipped}</main>"), encoding="utf-8")
    page.goto(other.as_uri())
    page.locator("#items > details > summary").click()
    assert page.evaluate("window.ran") is None
    assert _status(page) == "Rows: 5, all shown"
    refused = [text for text in complaints if "Content Security Policy" in text]
    assert any("inline script" in text for text in refused)
    assert any("x.js" in text for text in refused)
    page.close()


def test_filters_narrow_the_rows_down_and_say_so(open_page):
    page = open_page()
    rooms = _filter(page, "Room")
    assert rooms.locator("option").all_inner_texts() == ["all", "Archive", "Hall", "Office"]
    rooms.select_option("Hall")
    _filter(page, "Floor").select_option("2")
    assert rooms.locator("option").all_inner_texts() == ["all", "Archive", "Office"], "those of the floor"
    assert rooms.input_value() == ""
    assert _shown(page) == ["A10", "B<i>1</i>"]
    _filter(page, "Floor").select_option("1")
    assert _shown(page) == ["A1", "A2", "A3"]
    assert _status(page) == "Rows: 3 of 5 shown: Floor: 1"
    rooms.select_option("Office")
    assert _shown(page) == ["A2", "A3"]
    _filter(page, "Class").select_option("anchored")
    assert _shown(page) == ["A2"]
    page.get_by_role("button", name="Show all").click()
    assert len(_shown(page)) == 5
    _filter(page, "Class").select_option(label="○ low")
    assert _shown(page) == ["A3"]
    page.get_by_role("button", name="Show all").click()
    _filter(page, "Route").select_option("R")
    assert _shown(page) == ["A1"]


def test_heads_sort_by_mouse_and_keyboard_and_say_so(open_page):
    page = open_page()
    page.get_by_role("button", name="Chance").click()
    head = page.locator("#pieces").get_by_role("columnheader", name="Chance", exact=True)
    assert head.get_attribute("aria-sort") == "descending"
    chances = page.locator("#pieces tbody tr td:nth-child(12)").evaluate_all(
        "cells => cells.map(c => +c.dataset.value)"
    )
    assert chances == sorted(chances, reverse=True)
    page.get_by_role("button", name="Item", exact=True).focus()
    page.keyboard.press("Enter")
    assert _shown(page) == ["A1", "A2", "A3", "A10", "B<i>1</i>"]
    assert head.get_attribute("aria-sort") is None
    page.keyboard.press("Space")
    assert _shown(page) == ["B<i>1</i>", "A10", "A3", "A2", "A1"]
    page.get_by_role("button", name="Show all").click()
    assert _shown(page)[0] == "A1"
    assert page.locator("[aria-sort]").count() == 0
    _filter(page, "Floor").select_option("1")
    page.get_by_role("button", name="B/H").click()
    assert _shown(page) == ["A3", "A2", "A1"], "sorting keeps the filter"


def test_parts_of_the_table_are_sorted_and_filtered_each_by_itself(browser, tmp_path):
    """Pieces that were simulated, and those by formula only, keep apart whatever the rows are sorted by."""
    rows = {"Building": [{"period": 1.0}], "Floors": [FLOORS[0]], "Items": [
        {"item": name, "floor": "1", "breadth": breadth, "width": 90, "height": 200, "axis": "Y"}
        for name, breadth in (("b", 76), ("c", 29), ("a", 74), ("d", 30))
    ]}  # fmt: skip
    inventory = assess.read_inventory(write_sheets(tmp_path / "w.xlsx", rows))
    results = assess.run(inventory, Settings(verify="high", runs=5), jobs=1)
    assert [one.apart for one in results] == ["formula", "", "formula", ""]
    page = browser.new_page()
    page.goto(assess.write_reports(results, tmp_path, "html")["html"].as_uri())
    page.locator("#items > details > summary").click()
    heading = "By formula only: not simulated"
    assert _shown(page) == ["c", "d", "a", "b"]  # by name, not as the workbook has them
    assert page.locator("#pieces tr.part").all_inner_texts() == [heading]
    turn = page.get_by_role("button", name="Item", exact=True)
    turn.click()
    turn.click()
    assert _shown(page) == ["d", "c", "b", "a"]
    page.get_by_role("button", name="Show all").click()
    assert _shown(page) == ["c", "d", "a", "b"]
    _filter(page, "Class").select_option("apart-formula")
    assert _shown(page) == ["a", "b"]
    assert page.locator("#pieces tr.part").is_visible()
    _filter(page, "Search").fill("c")
    _filter(page, "Class").select_option("")
    assert not page.locator("#pieces tr.part").is_visible()
    page.close()


def test_pieces_of_the_plan_and_rows_lead_to_each_other(open_page):
    page = open_page()
    _filter(page, "Floor").select_option("2")
    assert "A1" not in _shown(page)
    page.locator("#piece-1").click()
    assert page.locator("#row-1").is_visible()
    assert _status(page) == "Rows: 5, all shown"
    _assert_marked_and_in_sight(page, page.locator("#row-1"))
    page.get_by_role("link", name="A3, Low chest: low").focus()
    page.keyboard.press("Enter")
    _assert_marked_and_in_sight(page, page.locator("#row-3"))
    _filter(page, "Floor").select_option("2")
    page.go_back()
    assert page.locator("#row-1").is_visible()
    page.locator("#row-1").get_by_role("link", name="A1", exact=True).click()
    assert page.url.endswith("#piece-1")
    assert 0 <= page.locator("#piece-1").evaluate("piece => piece.getBoundingClientRect().top") < 900
    assert page.locator("#row-4 td:first-child a").count() == 0


def _assert_marked_and_in_sight(page, row):
    head = page.locator("#pieces thead").bounding_box()
    box = row.bounding_box()
    assert box["y"] >= head["height"] - 1
    assert box["y"] < 900
    marked = row.locator("td").first.evaluate("cell => getComputedStyle(cell).backgroundColor")
    assert marked == "rgb(255, 243, 191)"


def test_without_javascript_all_rows_are_shown_and_links_work(open_page):
    page = open_page(java_script_enabled=False)
    assert page.locator("#pieces tbody tr:visible").count() == 5
    assert page.locator("#filter-bar, .sort").count() == 0
    page.locator("#piece-3").click()
    assert page.url.endswith("#row-3")
    page.locator("#row-1 a").first.click()
    assert page.url.endswith("#piece-1")


@pytest.mark.parametrize("width", [320, 768, 1600])
def test_the_page_never_scrolls_sideways(open_page, width):
    page = open_page(width=width, height=700)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    too_wide = "heads => heads.filter(h => h.scrollWidth > h.clientWidth + 1).map(h => h.innerText)"
    assert page.locator("thead th").evaluate_all(too_wide) == []
    assert page.locator("#pieces td").evaluate_all(too_wide) == []
    for selector in ("#pieces", "svg.floor-plan", "#filter-bar"):
        assert page.locator(selector).first.is_visible()


def test_what_is_folded_opens_where_a_link_leads_into_it_and_for_printing(browser, report):
    page = browser.new_page()
    page.goto(report.as_uri())
    table, methods = page.locator("#pieces"), page.locator("#methods > details")
    assert not table.is_visible()
    assert page.locator("#summary").is_visible()
    assert page.locator("nav.contents").bounding_box()["y"] < page.locator("#summary").bounding_box()["y"]
    page.locator("a.piece").first.click()
    table.wait_for(state="visible")
    assert not methods.evaluate("one => one.open")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert methods.evaluate("one => one.open")
    page.close()
