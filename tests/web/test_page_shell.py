"""The frame of the page: every view opens, in both languages and themes, and nothing is lost on the way."""

import gzip
import os
import re
import shutil
import signal
from base64 import b64encode
from pathlib import Path

import pytest
from openpyxl import load_workbook
from playwright.sync_api import expect

import assess.web
from assess.web.assets import find_asset
from tests.conftest import EXAMPLE
from tests.web.looking import THEMES, VIEWS, examine, note_requests, open_menu, show
from tests.web.opened import write_office
from tests.web.serving import start

PAGE = Path(assess.web.__file__).with_name("page")
MOST_BYTES = 200_000
STATE = ".save-state"


def browsing(test):
    return pytest.mark.browser(pytest.mark.slow(test))


@pytest.fixture
def office(tmp_path):
    return write_office(tmp_path / "office.xlsx")


@pytest.fixture
def example(tmp_path):
    folder = tmp_path / "example"
    folder.mkdir()
    shutil.copytree(EXAMPLE.parent / "records", folder / "records")
    return Path(shutil.copy(EXAMPLE, folder))


def edit(page, sheet, row, at, value):
    """Change a cell as a view does; return when the page shows it."""
    page.evaluate(
        """async ([sheet, row, at, value]) => {
            const { store } = await import("/store.mjs");
            store.edit([[sheet, row, at, value]], "typing");
        }""",
        [sheet, row, at, value],
    )


def value(page, sheet, row, at):
    return page.evaluate(
        "async ([sheet, row, at]) => (await import('/store.mjs')).store.sheet(sheet)?.value(row, at)", [sheet, row, at]
    )


def test_the_page_is_small_and_complete_names_no_other_server_and_makes_no_elements_of_text():
    files = [path for path in PAGE.rglob("*") if path.suffix in (".mjs", ".css", ".html")]
    assert sum(len(gzip.compress(path.read_bytes())) for path in files) <= MOST_BYTES
    name = re.compile(r'(?:from |import\(|href=|src=)"(?:\./)?([\w-]+\.(?:mjs|css))"')
    named = {found for path in files for found in name.findall(path.read_text("utf-8"))}
    assert len(named) > 20
    assert [name for name in sorted(named) if find_asset(name) is None] == []
    for path in PAGE.glob("*.mjs"):
        text = path.read_text("utf-8").replace("http://www.w3.org/", "")
        assert not re.search(r"https?://|innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(", text), (
            path.name
        )
    styles = "".join(path.read_text("utf-8") for path in PAGE.rglob("*.css"))
    assert not re.search(r"https?://|@import|url\((?!#|\"/fonts/)", styles)
    fonts = re.findall(r'"/(fonts/[\w.-]+)\?v=(\w+)"', styles + (PAGE / "index.html").read_text("utf-8"))
    assert len(fonts) == 4
    assert all(find_asset(name).mark.startswith(version) for name, version in fonts)
    icons = re.findall(r'^  "?([\w-]+)"?: "M', (PAGE / "icons.mjs").read_text("utf-8"), re.MULTILINE)
    used = re.findall(r'\bicon\("(\w+)"', "".join(path.read_text("utf-8") for path in PAGE.glob("*.mjs")))
    assert len(icons) == len(set(icons))
    assert set(used) <= set(icons)


@browsing
def test_every_view_is_accessible_and_asks_no_other_server(page, served_here, example):
    server = served_here(example)
    found = page(server, reduced_motion="reduce")
    addresses = note_requests(found)
    found.reload()
    for view in VIEWS:
        show(found, view)
        expect(found.locator(f"#view-{view} [role=alert]:not(:empty)")).to_have_count(0)
        for theme, rules in THEMES:
            found.emulate_media(color_scheme=theme, reduced_motion="reduce")
            assert examine(found, rules) == [], (view, theme)
    assert len(addresses) > 20
    assert [one for one in addresses if not one.startswith((server.base + "/", "data:", "blob:"))] == []


CONTENT = {"sheet": ".sheet-panel", "plan": ".plan-main", "what-if": ".what-if-main", "results": ".page-like"}
"""What begins below the header and the tools of a view."""
CUT_OFF = """() => [...document.querySelectorAll("header, header *, [role=toolbar], .sheet-bar, .what-if-banner")]
    .filter((one) => one.checkVisibility() && !one.closest("#menu, .book-name, .unseen"))
    .filter((one) => one.scrollWidth > one.clientWidth + 1 && getComputedStyle(one).display !== "inline")
    .map((one) => one.outerHTML.slice(0, 90))"""
"""What the header and the tools have no room for; the name and the state of the workbook end with an ellipsis."""
MOVED = """async () => {
    const { store } = await import("/store.mjs");
    const all = "header, header > *, header a, header button, main, main > * > *";
    const boxes = () => [...document.querySelectorAll(all)]
        .filter((one) => one.checkVisibility()).map((one) => JSON.stringify(one.getBoundingClientRect()));
    const before = boxes();
    store.takeState({ ...store.state, unsaved: true, save_error: "The disk is full. ".repeat(30) });
    document.querySelector(".undone").textContent = "Undone: Items!A2";
    document.querySelector("header progress").hidden = false;
    const after = boxes();
    document.querySelector(".undone").textContent = "";
    return [document.querySelector(".save-state").innerText, after.filter((one) => !before.includes(one))];
}"""
"""What is told of a trouble, an undo and a simulation, and what stands elsewhere after it was told."""


@browsing
def test_the_frame_is_one_line_the_tools_another_and_nothing_moves_when_it_tells_something(page, served_here, example):
    found = page(served_here(example))
    expect(found.locator(".counts")).to_contain_text("very high")
    for width in (1400, 900):
        found.set_viewport_size({"width": width, "height": 900})
        for view, content in CONTENT.items():
            show(found, view)
            assert found.locator(f"#view-{view} {content}").first.bounding_box()["y"] <= 96, (view, width)
            assert found.evaluate(CUT_OFF) == [], (view, width)
            assert found.locator(".primary:visible").count() <= 1, (view, width)
    show(found, "start")
    assert found.locator(".primary:visible").count() <= 1
    for width, view in ((1400, "sheet"), (900, "plan"), (390, "sheet")):
        found.set_viewport_size({"width": width, "height": 900})
        show(found, view)
        expect(found.locator(STATE)).to_have_text("All changes saved")
        told, moved = found.evaluate(MOVED)
        assert told.startswith("Not saved: The disk is full.")
        assert moved == [], width
        assert found.locator("header.top").bounding_box()["height"] <= 48
        expect(found.locator(STATE)).to_have_text("All changes saved")  # as the server has it


# the page loads these when it has nothing else to do: a reload before that would get them for the first time
LOADED = """() => Promise.all(["overview", "grid", "plan", "what_if", "results"]
    .map((one) => import(`/${one}_view.mjs`))).then((all) => all.length)"""


@browsing
def test_a_reload_asks_for_the_files_and_gets_none_of_them_again(page, served_here, office):
    found = page(served_here(office))
    expect(found.get_by_role("grid")).to_be_visible()
    assert found.evaluate("() => document.fonts.ready.then(() => document.fonts.check('16px Plex'))")
    assert found.evaluate(LOADED) == 5
    found.reload()
    expect(found.get_by_role("grid")).to_be_visible()
    assert found.evaluate(LOADED) == 5
    sent = found.evaluate("""() => performance.getEntriesByType("resource")
        .filter((one) => /\\.(mjs|css|woff2)/.test(one.name)).map((one) => [one.name, one.transferSize])""")
    assert len(sent) > 30
    assert [(name, size) for name, size in sent if size > 500] == []


@browsing
def test_language_and_colours_are_kept_and_percentages_stay_on_their_side_of_a_limit(page, served_here, office):
    server = served_here(office)
    found = page(server, color_scheme="light")
    expect(found.get_by_role("link", name="Sheet", exact=True)).to_be_visible()
    colour = "() => getComputedStyle(document.body).backgroundColor"
    light = found.evaluate(colour)
    open_menu(found).get_by_label("Colours").select_option("dark")
    dark = found.evaluate(colour)
    percents = "async chances => { const { percent } = await import('/texts.mjs'); return chances.map(percent); }"
    shown = [one.replace("\u00a0", " ") for one in found.evaluate(percents, [0.02999, 0.03, 0.69996, None, 1, 0])]
    assert shown == ["2.999 %", "3.0 %", "69.996 %", "–", "100.0 %", "0.0 %"]
    found.get_by_label("Language of the page").select_option("it")
    expect(found.get_by_role("link", name="Foglio", exact=True)).to_be_visible()
    expect(found.locator(STATE)).to_have_text("Modifiche salvate")
    assert found.locator("html").get_attribute("lang") == "it"
    numbers = found.evaluate("""async () => {
        const { number, percent, t } = await import("/texts.mjs");
        return [number(1.5), number(12345.678, 1, true), percent(0.0123), t("{word}: {n:,}", { word: "x", n: 2000 })];
    }""")
    assert numbers == ["1,5", "12.345,7", "1,2\u00a0%", "x: 2.000"]
    found.reload()
    expect(found.get_by_role("link", name="Foglio", exact=True)).to_be_visible()
    assert found.evaluate(colour) == dark != light
    assert server.client.get("/api/book").json()["language"] == "en"
    open_menu(found)
    found.get_by_label("Lingua della pagina").select_option("en")
    expect(found.get_by_role("link", name="Sheet", exact=True)).to_be_visible()  # loaded again
    expect(open_menu(found).get_by_label("Colours")).to_have_value("dark")


@browsing
def test_what_is_changed_while_the_server_is_gone_reaches_the_file(page, served, office):
    server = served(office)
    found = page(server)
    expect(found.get_by_role("grid")).to_be_visible()
    server.stop()
    edit(found, "Items", 2, 3, "Attic")
    expect(found.get_by_role("alert").filter(has_text="does not answer")).to_contain_text(
        "assess open office.xlsx --port"
    )
    expect(found.locator(STATE)).to_have_text("Not connected: changes are kept in this page")
    port = server.base.rpartition(":")[2]
    again = start(office, "--no-browser", "--port", port, cwd=office.parent)
    try:
        found.context.new_page().goto(again.url)
        expect(found.locator(STATE)).to_have_text("All changes saved")
        expect(found.locator("#notices")).not_to_contain_text(re.compile("answer|connected|sent"))
    finally:
        again.stop()
    assert load_workbook(office)["Items"].cell(2, 4).value == "Attic"


@browsing
def test_an_answer_that_breaks_off_loses_no_edit(page, served_here, office):
    found = page(served_here(office))
    expect(found.get_by_role("grid")).to_be_visible()

    def break_off(route):
        answer = route.fetch()
        route.fulfill(status=answer.status, content_type="application/json", body=answer.body()[:20])

    found.route("**/api/edit", break_off, times=1)
    edit(found, "Items", 2, 3, "Attic")
    edit(found, "Items", 3, 3, "Cellar")
    expect(found.locator(STATE)).to_have_text("All changes saved")
    expect(found.locator("#notices")).not_to_contain_text(re.compile("not been sent|Not changed|read again"))
    assert [load_workbook(office)["Items"].cell(row, 4).value for row in (2, 3)] == ["Attic", "Cellar"]


WHEN_SENT = """async () => {
    const [{ store }, { whenSent }] = await Promise.all([import("/store.mjs"), import("/watch.mjs")]);
    await whenSent(store);
}"""
"""The page knows that the server has taken every edit."""


@browsing
def test_what_a_killed_server_had_taken_and_not_saved_is_sent_again(page, served, office):
    server = served(office)
    found = page(server)
    expect(found.get_by_role("grid")).to_be_visible()
    office.chmod(0o444)  # it is killed before it can save
    edit(found, "Items", 2, 3, "Attic")
    found.evaluate(WHEN_SENT)
    server.stop(signal.SIGKILL)
    office.chmod(0o644)
    assert load_workbook(office)["Items"].cell(2, 4).value != "Attic"
    edit(found, "Items", 3, 3, "Cellar")
    again = start(office, "--no-browser", "--port", server.base.rpartition(":")[2], cwd=office.parent)
    try:
        found.context.new_page().goto(again.url)
        expect(found.locator("#notices")).to_contain_text("1 change that it had not saved was sent again")
        expect(found.locator("#notices")).not_to_contain_text("another window")
        expect(found.locator(STATE)).to_have_text("All changes saved")
    finally:
        again.stop()
    assert [load_workbook(office)["Items"].cell(row, 4).value for row in (2, 3)] == ["Attic", "Cellar"]


def change_outside(path, name):
    other = load_workbook(path)
    other["Items"].cell(2, 4).value = name
    other.save(path)


LOOK = """isHidden => {
    Object.defineProperty(document, "hidden", { value: isHidden, configurable: true });
    document.dispatchEvent(new Event("visibilitychange"));
}"""
"""A window that is not in sight does not look after the file."""


@browsing
def test_a_change_by_another_program_is_read_and_asks_only_where_changes_would_be_lost(page, served_here, office):
    found = page(served_here(office))
    expect(found.locator(STATE)).to_contain_text("All changes saved")
    change_outside(office, "Cellar")
    said = found.locator(".notice").filter(has_text="changed by another program")
    expect(said).to_contain_text("has been read again")
    assert value(found, "Items", 2, 3) == "Cellar"
    said.get_by_role("button", name="Close").click()
    found.evaluate(LOOK, True)
    change_outside(office, "Garage")
    with found.expect_response("**/api/edit"):
        edit(found, "Items", 2, 3, "Attic")
    found.evaluate(LOOK, False)
    expect(said.get_by_role("button", name="Download my version")).to_be_visible()
    said.get_by_role("button", name="Read the file again").click()
    found.get_by_role("dialog").get_by_role("button", name="Read the file again").click()
    expect(said).to_have_count(0)
    expect(found.locator(STATE)).to_contain_text("All changes saved")
    assert value(found, "Items", 2, 3) == "Garage"


@browsing
def test_what_stands_in_the_way_of_saving_is_told_until_it_is_gone(page, served_here, office):
    found = page(served_here(office))
    expect(found.locator(STATE)).to_contain_text("All changes saved")
    office.rename(office.with_name("moved.xlsx"))
    edit(found, "Items", 2, 3, "Attic")
    said = found.get_by_role("alert").filter(has_text="no longer in its folder: put it back")
    expect(said.get_by_role("button", name="Download my version")).to_be_visible()
    office.with_name("moved.xlsx").rename(office)
    expect(said).to_have_count(0)
    expect(found.locator(STATE)).to_have_text("All changes saved")
    assert load_workbook(office)["Items"].cell(2, 4).value == "Attic"


DROP = """([name, data]) => {
    const files = new DataTransfer();
    files.items.add(new File([Uint8Array.from(atob(data), (one) => one.charCodeAt(0))], name));
    const options = { dataTransfer: files, bubbles: true, cancelable: true };
    (document.querySelector("dialog[open]") ?? document.body).dispatchEvent(new DragEvent("drop", options));
}"""


def drop(page, name, data):
    page.evaluate(DROP, [name, b64encode(data).decode()])


@browsing
def test_a_workbook_and_the_files_that_it_names_are_dropped_in(page, served_here, example):
    found = page(served_here())
    expect(found.get_by_role("button", name="Open a file")).to_be_visible()
    drop(found, "old.xls", b"old")
    expect(found.get_by_role("alert").filter(has_text="old.xls cannot be opened")).to_contain_text("LibreOffice")
    drop(found, "broken.xlsx", b"no workbook")
    expect(found.get_by_role("alert").filter(has_text="broken.xlsx was not opened")).to_be_visible()
    drop(found, "tower.xlsx", example.read_bytes())
    expect(found.get_by_role("heading", name="tower.xlsx")).to_be_visible()
    missing = found.get_by_role("button", name=re.compile(r"\d+ files? missing"))
    missing.click()
    dialog = found.get_by_role("dialog")
    names = dialog.locator("tbody th").all_inner_texts()
    expect(dialog.locator("tbody tr").first).to_contain_text("record of a motion")
    expect(dialog.locator("tbody tr").first.get_by_role("button").first).to_have_text(re.compile(r"^Floors!\w+\d+$"))
    assert examine(found) == []
    records = {path.name: path for path in (example.parent / "records").rglob("*") if path.is_file()}
    drop(found, "holiday.jpg", b"picture")
    expect(found.get_by_role("alert").filter(has_text="holiday.jpg was not taken")).to_be_visible()
    for name in names:
        last = name.rpartition("/")[2]
        drop(found, last, records[last].read_bytes())
        expect(dialog.get_by_role("rowheader", name=name, exact=True)).to_have_count(0)
    expect(dialog).to_contain_text("Nothing is missing.")
    dialog.get_by_role("button", name="Close").click()
    expect(missing).to_be_hidden()
    expect(found.locator(".counts")).to_contain_text("very high")


@browsing
def test_a_held_workbook_asks_before_it_is_left(page, served_here, office, tmp_path):
    found = page(served_here())
    expect(found.get_by_role("button", name="Open a file")).to_be_visible()
    drop(found, "mine.xlsx", office.read_bytes())
    expect(found.locator(STATE)).to_have_text("No changes since the last download")
    edit(found, "Items", 2, 3, "Attic")
    expect(found.locator(STATE)).to_have_text("Not downloaded yet")
    drop(found, "other.xlsx", office.read_bytes())
    found.get_by_role("dialog").get_by_role("button", name="Cancel").click()
    expect(found.get_by_role("heading", name="mine.xlsx")).to_be_visible()
    with found.expect_download() as download:
        found.get_by_role("link", name="Download").click()
    expect(found.locator(STATE)).to_have_text("No changes since the last download")
    path = tmp_path / download.value.suggested_filename
    download.value.save_as(path)
    assert (path.name, load_workbook(path)["Items"].cell(2, 4).value) == ("mine.xlsx", "Attic")
    drop(found, "other.xlsx", office.read_bytes())
    expect(found.get_by_role("heading", name="other.xlsx")).to_be_visible()


@browsing
@pytest.mark.skipif(os.name == "nt" or not (os.getuid() or shutil.which("setpriv")), reason="needs rights that count")
def test_a_folder_that_does_not_allow_writing_is_told_at_once(page, office):
    office.parent.chmod(0o555)
    rights = () if os.getuid() else ("setpriv", "--bounding-set", "-dac_override")
    server = start(office, "--no-browser", cwd="/", before=rights)
    try:
        found = page(server)
        said = found.locator(".notice").filter(has_text="The folder of office.xlsx does not allow writing")
        expect(said).to_be_visible()
        expect(found.locator(STATE)).to_contain_text("changes can be downloaded, not saved")
        edit(found, "Items", 2, 3, "Attic")
        told = found.get_by_role("alert").filter(has_text="does not allow writing")
        expect(told.get_by_role("button", name="Download my version")).to_be_visible()
    finally:
        _, _, err = server.stop()
        office.parent.chmod(0o755)
    assert err.startswith("warning  The folder of office.xlsx does not allow writing")


@browsing
def test_a_view_that_fails_leaves_the_others(page, served_here, office):
    found = page(served_here(office))
    found.route(
        "**/what_if_view.mjs",
        lambda route: route.fulfill(body="throw new Error('broken')", content_type="text/javascript"),
    )
    found.reload()
    show(found, "what-if")
    expect(found.locator("#view-what-if").get_by_role("alert")).to_contain_text("other views work")
    show(found, "results")
    expect(found.get_by_role("button", name="Make: Report for the client (PDF)")).to_be_enabled()
    assert [one for one in found.errors if "broken" not in one] == []
    found.errors.clear()
