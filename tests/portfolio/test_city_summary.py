"""The summary of a city: two to four pages with the answer, the map and what to start with.

That it is the same every time is held by the runs of test_run_portfolio.py.
"""

import pypdfium2
import pytest

from assess.portfolio.background import read_background
from assess.portfolio.city_summary import render_summary
from assess.resources import city_file
from tests.portfolio.city_samples import make_view

pytestmark = pytest.mark.slow


def test_it_has_two_to_four_pages_with_the_answer_first_then_all_parts():
    data = render_summary(make_view(220, draws=40), read_background(city_file("coast.geojson")))
    document = pypdfium2.PdfDocument(data)
    pages = [" ".join(page.get_textpage().get_text_range().split()) for page in document]
    assert 2 <= len(pages) <= 4
    assert "Surveyed buildings, simulated" in pages[0]
    assert "In nine of ten earthquakes like this one between" in pages[0]
    assert "20 buildings could not be assessed" in pages[0]
    text = " ".join(pages)
    for words in (
        "20 km", "by the share of its free-standing pieces that is expected to fall", "Share expected to fall",
        "30 to 70 % of its pieces expected to fall: ", "Where to start: Surveyed buildings, simulated",
        "Storage cabinet steel", "Skipped buildings", "Did you type metres?", "8 more are in ranking.xlsx",
        "10.1002/eqe.922", "not per year",
    ):  # fmt: skip
        assert words in text, words
    assert "highest class that any" not in text, "its map shows the share"
