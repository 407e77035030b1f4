"""The page of a comparison in a browser, and what axe-core says of it."""

import pytest

from assess.compare.changes import compare
from assess.compare.comparison_files import write_comparison
from assess.compare.past_run import read_run
from assess.settings import Settings
from tests.compare.past import write_routed_run
from tests.report.test_phone import DESK, OVER_THE_EDGE, PHONE, examine, pytestmark
from tests.workbooks import UNVERIFIED

__all__ = ["pytestmark"]


@pytest.fixture(scope="module")
def page_path(tmp_path_factory):
    folder = tmp_path_factory.mktemp("browser")
    before = write_routed_run(folder / "a", Settings(verify="none", scale=0.05))
    found = compare(read_run(before), read_run(write_routed_run(folder / "b", UNVERIFIED)))
    return write_comparison(found, folder / "out")["html"]


@pytest.mark.parametrize("width", [DESK, PHONE])
def test_axe_finds_nothing_in_a_comparison(browser, page_path, width):
    page = browser.new_page(viewport={"width": width, "height": 844})
    page.goto(page_path.as_uri())
    assert page.locator(".conditions").inner_text() == "BEFORE: motion × 0.05"
    assert examine(page) == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.evaluate(OVER_THE_EDGE, width) == []
    page.close()
