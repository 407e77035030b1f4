"""Reports of unusual buildings: nothing on them, very long names, very many pieces."""

import re

import openpyxl
import pypdfium2
import pytest

import assess
from tests.benchmarks.measuring import write_thousand
from tests.workbooks import ITEMS, UNVERIFIED, assessed

LONG = "N" * 299 + "Z"
BARE = {"item": "A1", "floor": "1", "breadth": 30, "height": 200}
CASES = {
    "no items": ({"items": []}, ["There are no free-standing pieces.", "There are no pieces.", "2 floors have no"]),
    "an item with no name but its number": ({"items": [BARE]}, ["A1: no description", "1 floor has no"]),
    "names of 300 characters": (
        {"items": [dict(ITEMS[0], item=LONG, room=LONG, description=LONG)], "building": LONG},
        ["N" * 38, "…"],
    ),
}  # fmt: skip


def _read(*paths):
    return [page.get_textpage().get_text_range() for path in paths for page in pypdfium2.PdfDocument(path)]


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        "names of 300 characters",
        *(pytest.param(name, marks=pytest.mark.long) for name in ("no items", "an item with no name but its number")),
    ],
)
def test_it_renders(tmp_path, name):
    given, told = CASES[name]
    formats = ("pdf", "annex", "xlsx")
    written = assess.write_reports(assessed(tmp_path / "w.xlsx", **given), tmp_path / "out", formats)
    pages = _read(written["pdf"], written["annex"])
    text = re.sub(r"\s+", " ", " ".join(pages).replace("\ufffe", "-"))
    for one in told:
        assert one in text, one
    assert "Summary" in pages[0]
    assert "How sure this is" in pages[1], "the summary is one page"
    book = openpyxl.load_workbook(written["xlsx"])
    assert "Items" in book.sheetnames
    book.close()
    assert LONG not in text or name != "names of 300 characters"


@pytest.mark.long
@pytest.mark.slow
def test_a_thousand_items_take_forty_pages_and_an_appendix(tmp_path):
    book = write_thousand(tmp_path / "w.xlsx")
    written = assess.write_reports(
        assess.run(assess.read_inventory(book), UNVERIFIED), tmp_path / "out", ("pdf", "annex")
    )
    assert len(_read(written["pdf"])) <= 40
    pages = _read(written["annex"])
    first = next(at for at, page in enumerate(pages) if "One line for each row" in page)
    assert first <= 40
    listed = " ".join(pages[first:])
    for at in range(1000):
        assert listed.count(f"P{at:04d} ") == 2, at  # all pieces, and what every method says of them
