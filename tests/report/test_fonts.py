"""The report's own fonts: which files they are, what may be done with them, and what helps out in figures."""

import hashlib
from pathlib import Path

import matplotlib as mpl
import pytest
from matplotlib.ft2font import FT2Font

import assess
from assess import resources
from assess.report import fonts
from assess.report.figures.draw import draw
from assess.report.fonts import FIGURE_FAMILY, figure_families, find_missing, find_undrawn
from tests.report.reading import write_html

FOLDER = Path(assess.__file__).with_name("fonts")
SIGNS = "■▲◇○⚓✕●◆△□"


@pytest.fixture
def no_cache():
    figure_families.cache_clear()
    yield
    figure_families.cache_clear()


def test_the_text_face_comes_along_with_its_licence():
    assert (FOLDER / "LICENSE.txt").read_text(encoding="utf-8").splitlines()[0].endswith('Reserved Font Name "Plex"')
    own = {style: path for (family, style), path in resources.fonts().items() if family == "Report"}
    assert set(own) == {"regular", "bold", "italic"}
    assert {FT2Font(str(path)).family_name for path in own.values()} == {FIGURE_FAMILY}
    assert {path.parent for path in own.values()} | {path.parent for path in resources.web_fonts().values()} == {FOLDER}


def test_the_files_are_those_of_the_publisher():
    """The OFL reserves the name: a font that is changed may not bear it."""
    files = {
        "IBMPlexSans-Regular.woff2": "ba711a3085ff9f27440b6b9c4550cfc47c97bf36591d5da958b975bb3add8c1a",
        "IBMPlexSans-SemiBold.woff2": "f78048030eab62e860efa39a0df79e2e5581bf122eb95b9bc42c0b8a4988d205",
    }
    for name, digest in files.items():
        assert hashlib.sha256((FOLDER / name).read_bytes()).hexdigest() == digest


def test_signs_that_the_text_face_lacks_are_in_the_other():
    text = FT2Font(str(resources.fonts()["Report", "regular"]))
    assert [sign for sign in SIGNS if text.get_char_index(ord(sign))] == []
    assert find_missing(SIGNS) == ""
    assert find_undrawn(SIGNS) == ""


@pytest.mark.slow
def test_a_page_names_every_face(example, tmp_path):
    html = write_html(example, tmp_path)
    assert html.count("@font-face") == 2, "each once, as data"
    assert html.count("src: url(data:font/woff2;base64,") == 2
    assert "font-src data:" in html


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


def test_figures_are_drawn_in_the_report_s_face_without_a_word_in_the_log(caplog):
    seen = []

    def paint(figure):
        axes = figure.subplots()
        axes.set_title("Title ■ ⚓ 本")
        seen.extend(axes.title.get_fontfamily())

    drawn = draw(3, 2, paint)
    assert drawn.startswith(b"<?xml")
    assert seen[:2] == [FIGURE_FAMILY, "DejaVu Sans"]
    assert caplog.text == ""
