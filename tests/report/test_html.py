"""What the HTML and PDF reports say, read back from the files."""

import base64
import re
import struct
from html.parser import HTMLParser

import pytest

import assess
from assess.methods import all_methods
from assess.report.pages.context import LIMITS
from assess.report.pages.html import hash_script
from assess.results import MOTION_FLAGS, PIECE_FLAG_TEXTS
from tests.pictures import picture
from tests.report.reading import render
from tests.workbooks import assessed


class _Page(HTMLParser):
    """Collects the text, and the tags that are open in the wrong order."""

    def __init__(self):
        super().__init__()
        self.text, self.open, self.wrong = [], [], []

    def handle_starttag(self, tag, attrs):
        if tag not in ("meta", "img", "br", "col", "link", "input"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append(tag)

    def handle_data(self, data):
        if not self.open or self.open[-1] not in ("style", "script"):
            self.text.append(data)


def _read(html):
    page = _Page()
    page.feed(html)
    assert page.wrong == []
    assert page.open == []
    return " ".join(" ".join(page.text).split())


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = tmp_path_factory.mktemp("html")
    assessment = assessed(folder / "w.xlsx", building="Town hall", scenario="A test", period=0.9)
    return assessment, assess.write_reports(assessment, folder / "out", ("html", "pdf", "json"))


def test_html_is_well_formed_and_says_what_must_be_said(report):
    assessment, written = report
    text = _read(written["html"].read_text(encoding="utf-8"))
    assert (
        "chance of overturning in this scenario , not per year, by a published formula, as no rocking has been "
        "simulated" in text
    )
    assert "Not simulated" in text
    assert "Town hall" in text
    for method in all_methods():
        assert method.title in text
        assert " ".join(str(method.reference).split()) in text
        for flag, meaning in method.flags.items():
            assert flag.replace("_", " ") in text
            assert meaning in text or flag in MOTION_FLAGS or flag in PIECE_FLAG_TEXTS
    for one in assessment:
        assert one.item.item in text
        assert f"{100 * one.adopted.probability:.1f} %" in text


def test_html_fetches_nothing_and_runs_its_one_script_alone(report):
    _, written = report
    html = written["html"].read_text(encoding="utf-8")
    assert "default-src 'none'" in html
    assert not re.search(r'(?:src|href)="(?!data:image/|#)', html)
    (script,) = re.findall(r"<script>(.*?)</script>", html, flags=re.DOTALL)
    assert html.count("<script") == 1
    assert f"script-src '{hash_script(script)}'" in html
    assert "url(" not in re.sub(r"url\((data:|#)", "", html)


def test_every_picture_has_an_alternative_text_and_every_heading_cell_a_scope(report):
    _, written = report
    html = written["html"].read_text(encoding="utf-8")
    images = re.findall(r"<img [^>]*>", html)
    assert images
    assert all(re.search(r'alt="[^"]{10,}"', image) for image in images)
    assert all('scope="' in head for head in re.findall(r"<th[ >][^>]*", html))


def test_a_long_list_is_cut_with_a_word(tmp_path, monkeypatch):
    monkeypatch.setattr("assess.report.pages.context.LIMITS", LIMITS | {"most_rows": 3})
    text = _read(render(assessed(tmp_path / "w.xlsx")))
    assert "5 rows, the first 3 of which are shown: the Excel report holds all" in text


def test_a_logo_is_embedded(tmp_path):
    for size, shown in (((40, 30), (40, 30)), ((4000, 50), (1334, 17))):
        (tmp_path / "logo.png").write_bytes(picture("PNG", size=size))
        html = render(assessed(tmp_path / "w.xlsx", logo="logo.png", organisation="Us & Co"))
        found = re.search(r'<img class="logo" src="data:image/png;base64,([^"]+)" alt="Logo of Us &amp; Co">', html)
        assert found
        assert struct.unpack(">II", base64.b64decode(found[1])[16:24]) == shown
