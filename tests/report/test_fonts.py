"""The report's own fonts: which files they are, what may be done with them, and what helps out in figures."""

import hashlib
from pathlib import Path

import matplotlib as mpl
import pytest
from matplotlib.ft2font import FT2Font

import assess
from assess import resources
from assess.report import fonts
from assess.report.fonts import FIGURE_FAMILY, figure_families, find_missing, find_undrawn

FOLDER = Path(assess.__file__).with_name("fonts")
SIGNS = "■▲◇○⚓✕●◆△□"


@pytest.fixture
def no_cache():
    figure_families.cache_clear()
    yield
    figure_families.cache_clear()


def test_the_files_are_those_of_the_publisher_and_signs_that_one_lacks_are_in_the_other():
    """The OFL reserves the name: a font that is changed may not bear it."""
    files = {
        "IBMPlexSans-Regular.woff2": "ba711a3085ff9f27440b6b9c4550cfc47c97bf36591d5da958b975bb3add8c1a",
        "IBMPlexSans-SemiBold.woff2": "f78048030eab62e860efa39a0df79e2e5581bf122eb95b9bc42c0b8a4988d205",
    }
    for name, digest in files.items():
        assert hashlib.sha256((FOLDER / name).read_bytes()).hexdigest() == digest
    text = FT2Font(str(resources.fonts()["Report", "regular"]))
    assert [sign for sign in SIGNS if text.get_char_index(ord(sign))] == []
    assert find_missing(SIGNS) == ""
    assert find_undrawn(SIGNS) == ""


def test_figures_borrow_a_font_with_east_asian_characters_where_there_is_one(monkeypatch, no_cache):
    """Stood in for by a serif font that matplotlib brings along: it holds ℵ₀, say, and is found by its name."""
    assert find_undrawn("本棚") == "本棚"
    assert figure_families() == (FIGURE_FAMILY, "DejaVu Sans")
    figure_families.cache_clear()
    lent = "STIXSizeOneSym"
    monkeypatch.setattr(fonts, "EAST_ASIAN", ("No Such Font", lent))
    assert figure_families() == (FIGURE_FAMILY, "DejaVu Sans", lent)
    path = mpl.font_manager.findfont(lent)
    held = [chr(code) for code in FT2Font(path).get_charmap() if find_missing(chr(code))]
    assert held, "a character that our own fonts lack"
    assert find_undrawn(held[0] + "本") == "本"
