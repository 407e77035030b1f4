"""The page opens, a cell is edited, the class of its piece follows: the one test of a browser in `make test`."""

import pytest
from playwright.sync_api import expect

from docs.screenshot import find_browser
from tests.web.opened import write_office
from tests.web.sheet_page import CLASS, opened


@pytest.mark.skipif(find_browser() is None, reason="no Chromium or Chrome is installed")
@pytest.mark.slow
def test_an_edited_piece_gets_another_class(page, served, tmp_path):
    path = write_office(tmp_path / "office.xlsx")
    before = path.read_bytes()
    sheet = opened(page, served(path)).open("Items")
    expect(sheet.cell(CLASS, 4)).to_contain_text("▲ high")
    sheet.select("Height", 4).type("60", "<Enter>")
    expect(sheet.cell(CLASS, 4)).to_contain_text("○ low*")
    sheet.type("<Control+z>")
    expect(sheet.cell(CLASS, 4)).to_contain_text("▲ high")
    assert sheet.settle().values("Items", "height")[4] == 180
    assert sheet.server.client.get("/api/download").data == before
