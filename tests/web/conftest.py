"""Fixtures: a server of the page, and a browser in it."""

import tempfile
from contextlib import ExitStack

import pytest

from assess.web.simulating import Simulator
from tests.waiting import PATIENCE
from tests.web.serving import Client, serve_here, start


@pytest.fixture(autouse=True)
def _end_simulations(monkeypatch):
    """End what books of the test still simulate."""
    made, make = [], Simulator.__init__

    def begin(self):
        make(self)
        made.append(self)

    monkeypatch.setattr(Simulator, "__init__", begin)
    yield
    for one in made:
        one.close()


UNFOLDED = "try { localStorage['assess-folded'] ??= '[]' } catch { /* not of the page */ }"


@pytest.fixture
def folders(tmp_path):
    """Make the folders of servers: temporary files go to `tmp` of `tmp_path`, new workbooks to `home`."""
    (tmp_path / "tmp").mkdir()
    (tmp_path / "home").mkdir()
    return tmp_path


@pytest.fixture
def served(folders):
    """Return a function that serves a workbook, or none, by the command: `served(path, "--language", "it")`."""
    with ExitStack() as stack:

        def serve(workbook=None, *options, cwd=None):
            words = [*([workbook] if workbook else []), "--no-browser", "--port", "0", *options]
            running = start(*words, cwd=cwd or folders / "home", temporary=folders / "tmp")
            stack.callback(running.stop)
            return running

        yield serve


@pytest.fixture
def served_here(folders, monkeypatch):
    """Return a function that serves a workbook, or none, in a thread, for tests of what the page does."""
    monkeypatch.setenv("TMPDIR", str(folders / "tmp"))
    monkeypatch.setattr(tempfile, "tempdir", None)
    with ExitStack() as stack:
        yield lambda workbook=None: stack.enter_context(serve_here(workbook, folders / "home"))


@pytest.fixture
def page(browser):
    """Return a function that opens a page of a server: `page(served(path))`; it fails on errors in the console.

    `page(server, width=390, height=844, locale="it-IT")`: other options of a Playwright context. `view` is what it
    shows where a workbook is open; "" for the first view. All groups of columns are shown, unless it `folds` some as
    at first.
    """
    opened = []
    with ExitStack() as stack:

        def open_page(server, *, width=1280, height=900, view="sheet", folds=False, **options):
            context = browser.new_context(viewport={"width": width, "height": height}, **options)
            if not folds:
                context.add_init_script(UNFOLDED)
            stack.callback(context.close)
            context.set_default_timeout(1e3 * PATIENCE)
            found = context.new_page()
            found.errors = []
            found.on("pageerror", lambda error: found.errors.append(str(error)))
            # an error of the page: a script, the policy; not the status of an answer
            found.on("console", lambda said: found.errors.append(said.text)
                     if said.type == "error" and "Failed to load resource" not in said.text else None)  # fmt: skip
            opened.append(found)
            if server.entered is None:
                found.goto(server.url)
                found.wait_for_url(lambda address: "/enter" not in address)
                cookies = "; ".join(f"{one['name']}={one['value']}" for one in context.cookies())
                server.entered = Client(server.base, cookies)  # the same session: a ticket serves once
            else:
                name, value = server.entered.headers["Cookie"].split("=", 1)
                context.add_cookies([{"name": name, "value": value, "url": server.base}])
                found.goto(f"{server.base}/")
            found.evaluate("view => { location.hash = view; }", view)
            return found

        yield open_page
        faults = [fault for one in opened for fault in one.errors]
    assert faults == []


@pytest.fixture
def small(page, served_here, tmp_path):
    from tests.web.opened import write_office
    from tests.web.sheet_page import opened

    return opened(page, served_here(write_office(tmp_path / "office.xlsx"))).open("Items")
