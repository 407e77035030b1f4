"""The page of a city: what it says, that nothing in it is code or a request, and how it is used in a browser."""

import json
import os
import re
import shlex
from dataclasses import replace

import pypdfium2
import pytest
from playwright.sync_api import expect

from assess.portfolio.background import read_background
from assess.portfolio.city_page import render_page, render_summary
from assess.report.pages.html import hash_script
from assess.resources import city_file
from docs.screenshot import find_browser
from tests.portfolio.city_samples import NASTY, make_view
from tests.web.looking import examine

REPEAT = "assess run {path} again"
in_browser = [
    pytest.mark.browser,
    pytest.mark.slow,
    pytest.mark.skipif(
        find_browser() is None and "ASSESS_CI" not in os.environ, reason="no Chromium or Chrome is installed"
    ),
]


def _read_data(html):
    return json.loads(html.split('id="data">')[1].split("</script>")[0])


@pytest.fixture(scope="module")
def view():
    return make_view(150, draws=40)


@pytest.fixture(scope="module")
def html(view):
    return render_page(view, repeat=REPEAT).decode()


@pytest.fixture(scope="module")
def data(html):
    return _read_data(html)


def test_no_name_becomes_markup_one_script_alone_may_run_and_the_data_hold_every_building(html, data, view):
    assert html.count("<script") == 2
    assert "<script>alert" not in html
    script = html[html.rindex("<script>") + 8 : html.rindex("</script>")]
    assert f"script-src '{hash_script(script)}'" in html
    assert "default-src 'none'" in html
    assert not re.findall(r"(?:src|href)=[\"'](?!data:)[^\"'#]", html.split('id="data"')[0])
    assert "innerHTML" not in script
    assert len(data["buildings"]) == 150
    assert [one["kind"] for one in data["buildings"][-13:]] == ["skipped"] * 13
    assert NASTY[:20] in [one["name"][:20] for one in data["buildings"]]
    assert data["tables"]["pieces"]["starts"][-1] == len(view.pieces)


def test_the_command_quotes_the_path_and_is_given_for_assessed_workbooks_alone(view):
    inventories = view.buildings["inventory"].mask(view.buildings["path"] == view.buildings["path"].iloc[1], "handover")
    shown = replace(view, buildings=view.buildings.assign(inventory=inventories))
    indexed = {view.buildings["path"].iloc[0]}
    rows = shown.buildings.set_index("path")
    statuses = set()
    for one in _read_data(render_page(shown, repeat=REPEAT, indexed=indexed).decode())["buildings"]:
        row = rows.loc[one["path"]]
        if row["status"] == "assessed" and row["inventory"] == "surveyed":
            assert one["command"] == f"assess run {shlex.quote(one['path'])} again"
        else:
            assert one["command"] == ""
        assert one["indexed"] == (one["path"] in indexed)
        statuses.add((row["status"], row["inventory"]))
    assert {"assumed", "handover", "surveyed"} <= {inventory for _status, inventory in statuses}


@pytest.mark.slow
def test_the_summary_of_a_large_city_has_two_to_four_pages_with_the_answer_first():
    data = render_summary(make_view(220, draws=40), read_background(city_file("coast.geojson")))
    document = pypdfium2.PdfDocument(data)
    pages = [" ".join(page.get_textpage().get_text_range().split()) for page in document]
    assert 2 <= len(pages) <= 4
    assert "Surveyed buildings, simulated" in pages[0]
    assert "In nine of ten earthquakes like this one between" in pages[0]
    assert "20 buildings could not be assessed" in pages[0]
    assert "8 more are in ranking.xlsx" in " ".join(pages)


@pytest.fixture
def open_page(browser, html, tmp_path):
    complaints, pages = [], []

    def open_page(width=1280, text=html):
        (tmp_path / "city.html").write_text(text, encoding="utf-8")
        page = browser.new_page(viewport={"width": width, "height": 844})
        pages.append(page)
        page.on("console", lambda message: complaints.append(message.text))
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("request", lambda one: complaints.extend([one.url] * (one.url[:5] not in ("file:", "data:"))))
        page.goto((tmp_path / "city.html").as_uri())
        return page

    yield open_page
    for page in pages:
        page.close()
    assert complaints == []


_LINES = """[...document.querySelectorAll('table.sums td.num, section.types td.num')].map((cell) => {
  const range = document.createRange();
  range.selectNodeContents(cell);
  return [cell.textContent, new Set([...range.getClientRects()].map((box) => box.top)).size];
})"""
"""The text of each number of the tables of sums and types, and in how many lines it stands."""


class TestInBrowser:
    """What hands do with it."""

    pytestmark = in_browser

    def test_filters_narrow_list_and_map_and_say_so(self, open_page, data):
        page = open_page()
        assert page.locator("#filter-status").inner_text() == "Buildings: 150, all shown"
        assert page.locator("#ranked tbody tr").count() == 100
        page.get_by_role("button", name="Show 50 more").click()
        assert page.locator("#ranked tbody tr").count() == 150
        page.get_by_label("Use", exact=True).select_option("School")
        shown = page.locator("#ranked tbody tr").count()
        assert 0 < shown < 100
        assert page.locator(".marks > g:visible").count() <= shown
        assert f"{shown} of 150; Use: School" in page.locator("#filter-status").inner_text()
        page.get_by_role("button", name="Show all buildings").click()
        page.get_by_label("Highest class", exact=True).select_option("very-high")
        wanted = sum(one["kind"] == "very-high" for one in data["buildings"])
        assert 0 < wanted < 150
        assert page.locator("#filter-status").inner_text() == f"Buildings: {wanted} of 150; Highest class: very high"
        page.get_by_label("Text").fill("nothing has this name")
        assert page.locator("#ranked tbody tr").count() == 0

    def test_a_row_or_a_sign_opens_its_building_with_its_name_as_it_is_and_back_returns_to_it(self, open_page, data):
        page = open_page()
        page.locator("#ranked tbody button").nth(4).click()
        assert page.locator("#one h1").inner_text() == data["buildings"][4]["name"]
        assert page.evaluate("document.activeElement.tagName") == "H1"
        assert page.locator("#all").is_hidden()
        assert "What to fix first" in page.locator("#one").inner_text()
        assert page.locator("#one pre").inner_text() == data["buildings"][4]["command"]
        page.get_by_role("button", name="Back to all buildings").click()
        expect(page.locator("#all")).to_be_visible()
        assert page.evaluate("document.activeElement.textContent") == data["buildings"][4]["name"]
        mark = page.locator(".marks > g").last
        at = int(mark.get_attribute("data-at"))
        mark.click(force=True)
        assert page.locator("#one h1").inner_text() == " ".join(data["buildings"][at]["name"].split())
        at = next(at for at, one in enumerate(data["buildings"]) if one["name"].startswith("=cmd"))
        page.evaluate(f"location.hash = 'building-{at + 1}'")
        expect(page.locator("#one h1")).to_contain_text("<script>alert(1)</script>")

    def test_the_map_zooms_by_buttons_and_keys_and_shows_states(self, open_page):
        page = open_page()
        box = "document.querySelector('svg.city-map').viewBox.baseVal.width"
        page.get_by_role("button", name="Zoom in").click()
        assert page.evaluate(box) == 500
        assert page.locator(".scale-bar text").text_content() == "10 km"
        page.locator("svg.city-map").focus()
        page.keyboard.press("+")
        assert page.evaluate(box) == 250
        page.keyboard.press("ArrowLeft")
        page.get_by_role("button", name="Show all", exact=True).click()
        assert page.evaluate(box) == 1000

    def test_the_map_shows_the_share_then_the_highest_class_then_states(self, open_page, data):
        page = open_page()
        numbers = "Array.from(document.querySelectorAll('.marks > g'), (mark) => Number(mark.dataset.at))"
        outlines = "Array.from(document.querySelectorAll('.marks path:first-child'), (one) => one.getAttribute('d'))"
        shapes = {}
        for mode in ("share", "kind", "state"):
            if mode != "share":
                page.get_by_label("Signs show").select_option(mode)
            shown = [one for one in ("share", "kind", "state") if page.locator(f"#legend-{one}").is_visible()]
            assert shown == [mode]
            legend = page.locator(f"#legend-{mode} svg")
            order = [legend.nth(at).get_attribute("data-key") for at in range(legend.count())]
            drawn = [data["buildings"][at][mode] for at in page.evaluate(numbers)]
            assert drawn == sorted(drawn, key=order.index, reverse=True)  # the worst lie on top
            shapes[mode] = dict(zip(page.evaluate(numbers), page.evaluate(outlines), strict=True))
        assert shapes["share"] != shapes["kind"] != shapes["state"]
        page.get_by_label("Signs show").select_option("share")
        assert dict(zip(page.evaluate(numbers), page.evaluate(outlines), strict=True)) == shapes["share"]

    @pytest.mark.parametrize("width", [390, 800, 1400])
    def test_no_number_of_the_sums_is_broken_or_cut_off(self, open_page, width):
        page = open_page(width)
        lines = page.evaluate(_LINES)
        assert len(lines) > 20
        assert [text for text, count in lines if count != 1] == []
        if width == 390:
            edges = "[...document.querySelectorAll('#sums *')].map((one) => one.getBoundingClientRect())"
            assert page.evaluate(f"{edges}.filter((box) => box.left < 0 || box.right > innerWidth).length") == 0
            before = "getComputedStyle(document.querySelector('table.sums td'), '::before').content"
            assert page.evaluate(before) != "none"
        else:
            box = "document.querySelector('#sums .scroll')"
            assert page.evaluate(f"{box}.scrollHeight - {box}.clientHeight") <= 1, "it scrolls to the side alone"

    @pytest.mark.parametrize("width", [390, 1400])
    def test_it_fits_the_screen_and_axe_core_finds_nothing_grave(self, open_page, width):
        page = open_page(width)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert examine(page) == []
        page.locator("#ranked tbody button").first.click()
        expect(page.locator("#one")).to_be_visible()
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert examine(page) == []
