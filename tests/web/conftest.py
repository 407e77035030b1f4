"""Fixtures: a server of the page, and a browser in it."""

from contextlib import ExitStack

import pytest

from tests.waiting import PATIENCE
from tests.web.serving import Client, start


@pytest.fixture
def served(tmp_path):
    """Return a function that serves a workbook, or none, on a free port: `served(path, "--language", "it")`.

    Temporary files of the servers go to the folder `tmp` of `tmp_path`, and the folder of new workbooks is `home`.
    """
    (tmp_path / "tmp").mkdir()
    (tmp_path / "home").mkdir()
    with ExitStack() as stack:

        def serve(workbook=None, *options, cwd=None):
            words = [*([workbook] if workbook else []), "--no-browser", "--port", "0", *options]
            running = start(*words, cwd=cwd or tmp_path / "home", temporary=tmp_path / "tmp")
            stack.callback(running.stop)
            return running

        yield serve


@pytest.fixture
def page(browser):
    """Return a function that opens a page of a server: `page(served(path))`; it fails on errors in the console.

    `page(server, width=390, height=844, locale="it-IT")`: other options of a Playwright context.
    """
    opened = []
    with ExitStack() as stack:

        def open_page(server, *, width=1280, height=900, **options):
            context = browser.new_context(viewport={"width": width, "height": height}, **options)
            stack.callback(context.close)
            context.set_default_timeout(1e3 * PATIENCE)
            found = context.new_page()
            found.errors = []
            found.on("pageerror", lambda error: found.errors.append(str(error)))
            found.on("console", lambda said: found.errors.append(said.text) if _is_fault(said) else None)
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
            return found

        yield open_page
        faults = [fault for one in opened for fault in one.errors]
    assert faults == []


def _is_fault(said):
    """Whether a line of the console is an error of the page: a script, the policy; not the status of an answer."""
    return said.type == "error" and "Failed to load resource" not in said.text
