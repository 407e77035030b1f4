"""Characters that the report's fonts lack: told by cell, never a crash, and the PDF stays valid."""

import os
import subprocess
import sys

import pytest

from assess.i18n import load_catalogue, speaking
from assess.report.fonts import find_missing, print_fonts, replace_signs
from assess.report.pages import glyphs, pdf
from assess.report.pages.pdf_layout import open_page
from tests.report.reading import read_pages, render
from tests.workbooks import assessed, write

FIX = "Install a font that does, such as Noto (Debian: apt install fonts-noto-core fonts-noto-cjk)."


def _items(*descriptions, **more):
    return [
        {"item": f"i{at}", "floor": "1", "breadth": 30, "height": 200, "description": text, **more}
        for at, text in enumerate(descriptions)
    ]


def test_the_fonts_hold_every_text_of_ours_and_what_they_lack_is_found():
    for text, missing in (
        ("Bücherregal, scaffale, étagère", ""), ("ντουλάπι βιβλίων", ""), ("книжный шкаф", ""),
        ("خزانة كتب", ""),  # Arabic: DejaVu holds it
        ("本棚と椅子", "本棚と椅子"), ("书柜", "书柜"), ("책장", "책장"), ("🪑 chair", "🪑"),
        ("≤ 1 m² ± α → ○ ◇ ▲ ■ ⚓ �", ""), ("plain\tASCII\n", ""),
    ):  # fmt: skip
        assert find_missing(text) == missing, (text, missing)
    for code in ("en", "it"):
        with speaking(load_catalogue(code)):
            texts = [text for texts in load_catalogue(code).messages.values() for text in texts]
        assert find_missing("".join(texts)) == ""


def test_each_field_is_told_once_many_are_counted_marks_are_not_told_and_borrowed_fonts_a_note(tmp_path, monkeypatch):
    monkeypatch.setattr(pdf, "find_nowhere", frozenset)
    items = [*_items("Shelf"), *_items("本棚", "椅子", room="書庫", notes="机")]
    items = [item | {"item": f"A{at}"} for at, item in enumerate(items)]
    results = assessed(tmp_path / "w.xlsx", items, building="東京", scenario="a quake")
    assert [str(one) for one in pdf.list_problems(results)] == [
        f"Building!B1: Building: no font here holds 東 (U+6771), 京 (U+4EAC); the PDF has � instead. {FIX}",
        f"Items!D3: Room of 2 rows: no font here holds 書 (U+66F8), 庫 (U+5EAB); the PDF has � instead. {FIX}",
        "Items!E3: Description of 2 rows: no font here holds 本 (U+672C), 棚 (U+68DA), 椅 (U+6905), 子 (U+5B50); "
        f"the PDF has � instead. {FIX}",
        f"Items!AD3: Notes of 2 rows: no font here holds 机 (U+673A); the PDF has � instead. {FIX}",
    ]
    assert {one.severity for one in pdf.list_problems(results)} == {"warning"}
    missing = [glyphs.Missing("Items", f"A{at}", "Room", 1, "本") for at in range(14)]
    told = glyphs.describe(missing, {"本"})
    assert len(told) == 11
    assert str(told[-1]) == "the same is true of 4 more fields."
    assert str(glyphs.describe(missing[:11], {"本"})[-1]) == "the same is true of 1 more field."
    monkeypatch.setattr(pdf, "find_nowhere", lambda _: frozenset())
    text = "wide\u3000space, \u2068isolate\u2069, \ufe0f, \u00ad"
    assert pdf.list_problems(assessed(tmp_path / "w.xlsx", _items(text))) == []
    monkeypatch.setattr(pdf, "find_nowhere", lambda _: frozenset())
    results = assessed(tmp_path / "w.xlsx", _items("一二三四五六七"))
    (problem,) = pdf.list_problems(results)
    assert problem.severity == "note"
    assert problem.message == (
        "Description: a font of this machine lends the PDF 一 (U+4E00), 二 (U+4E8C), 三 (U+4E09), 四 (U+56DB), "
        "五 (U+4E94) and 2 more; figures may have boxes instead."
    )


_ON_A_BARE_MACHINE = """
import sys
from pathlib import Path
import assess
from assess.report.content import Content
from assess.report.pages import pdf
from assess.report.report_options import ReportOptions
from matplotlib import font_manager
from tests.report.reading import write_pdf
font_manager.X11FontDirectories.clear()  # searched as well, whatever fontconfig says
results = assess.run(sys.argv[1], verify="none")
print(*pdf.list_problems(results), sep="\\n")
for accessible in (False, True):
    options = ReportOptions(accessible=accessible)
    write_pdf(Content(results), Path(sys.argv[2 + accessible]), options, edition="all")
"""


@pytest.mark.long
@pytest.mark.slow
def test_a_machine_without_fonts_writes_the_same_report(tmp_path):
    """WeasyPrint ends the process where a family has no font at all: every family of ours is embedded."""
    (tmp_path / "fonts.conf").write_text('<?xml version="1.0"?><fontconfig></fontconfig>')
    items = _items("本棚", "خزانة", "ντουλάπι", "🪑", "अलमारी")
    book = write(tmp_path / "w.xlsx", items, building="東京 Tower", scenario="地震")
    code, plain, accessible = _ON_A_BARE_MACHINE, tmp_path / "a.pdf", tmp_path / "u.pdf"
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code, book, plain, accessible],
        env=os.environ | {"FONTCONFIG_FILE": str(tmp_path / "fonts.conf")},
        capture_output=True, text=True, timeout=600, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    told = done.stdout.splitlines()
    assert [line.split(":")[0] for line in told] == ["Building!B1", "Building!B19", "Items!E2"]
    assert "本 (U+672C), 棚 (U+68DA), 🪑 (U+1FA91), अ (U+0905), ल (U+0932) and " in told[2]
    for path in (plain, accessible):
        text = " ".join(read_pages(path))
        assert "�� Tower" in text
        assert "ντουλάπι" in text
        assert "no font here holds � (U+6771)" in text
        assert not set(text) & set("東京本棚🪑")


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # WeasyPrint's own profile of colours
def test_no_box_is_in_a_pdf(tmp_path, caplog, monkeypatch):
    """PDF/A forbids them; WeasyPrint would log each."""
    monkeypatch.setattr(pdf, "find_nowhere", frozenset)
    results = assessed(tmp_path / "表.xlsx", _items("本棚 \u20d0", room="🪑"), building="ビル")
    page = render(results, for_print=True, edition="client")
    shown = open_page(replace_signs(page, find_missing(page)), print_fonts())  # in this process, for its log
    shown.write_pdf(tmp_path / "a.pdf", pdf_variant="pdf/a-3u")
    assert ".notdef" not in caplog.text
    assert "��" in " ".join(read_pages(tmp_path / "a.pdf"))
