"""The Word edition: the client's report as headings, paragraphs, tables and pictures of Word."""

import re
from importlib import util
from threading import Event

import docx
import pytest
from lxml import html

import assess
from assess.environment import say_install
from assess.errors import CancelledError, InputError
from assess.progress import Progress
from assess.report.content import Content
from assess.report.pages.html import render
from assess.report.report_options import ReportOptions
from assess.settings import Settings
from tests.cli.calling import run
from tests.workbooks import assessed, parts_of, write

ITEMS = [
    {"item": "A1", "floor": "1", "breadth": 30, "width": 90, "height": 190, "x": 1.0, "y": 2.0},
    {"item": "A2", "floor": "1", "breadth": 60, "width": 90, "height": 120, "x": 4.0, "y": 2.0, "anchored": "yes"},
    {"item": "A3", "floor": "2", "breadth": 40, "width": 80, "height": 180},
]  # fmt: skip
FLOORS = [{"floor": "1", "pfa_x": 0.4, "pfa_y": 0.3}, {"floor": "2", "pfa_x": 0.5, "pfa_y": 0.5}]


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("word")
    results = assessed(folder / "w.xlsx", ITEMS, FLOORS, settings=Settings(verify="none", scale=1.5))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", "1700000000")
        files = assess.write_reports(results, folder / "out", ("docx",))
    options = ReportOptions(language="en")
    with pytest.MonkeyPatch.context() as patch, options.spoken():
        patch.setenv("SOURCE_DATE_EPOCH", "1700000000")
        page = render(Content(results), options, for_print=True, edition="client")
    return files["docx"], html.fromstring(page).find("body"), docx.Document(str(files["docx"]))


def test_what_is_drawn_has_words_every_page_its_condition_and_the_contents_lead_to_the_headings(written):
    path, *_, page, document = written
    pictures = [one.get("descr") for one in document.element.iter("{*}docPr")]
    assert len(pictures) == len(list(page.iter("svg"))) > 0
    assert any(text and "plan" in text.lower() for text in pictures)
    images = [data for name, data in parts_of(path).items() if name.startswith("word/media/")]
    assert images
    assert all(image.startswith(b"\x89PNG") and len(image) > 60 for image in images)
    section = document.sections[0]
    assert section.header.paragraphs[0].text == "Every floor's motion times 1.5"
    fields = [one.get(f"{{{one.nsmap['w']}}}instr") for one in section.footer._element.iter("{*}fldSimple")]
    assert fields == ["PAGE", "NUMPAGES"]
    targets = {one.get(f"{{{one.nsmap['w']}}}anchor") for one in document.element.iter("{*}hyperlink")}
    places = {one.get(f"{{{one.nsmap['w']}}}name") for one in document.element.iter("{*}bookmarkStart")}
    assert targets
    assert targets <= places


def test_a_cancelled_one_leaves_nothing_and_without_its_packages_it_says_what_to_install(tmp_path, monkeypatch):
    results, stop = assessed(tmp_path / "w.xlsx", ITEMS, FLOORS), Event()
    stop.set()
    with pytest.raises(CancelledError):
        assess.write_reports(results, tmp_path / "out", "docx", progress=Progress(cancel=stop))
    assert list((tmp_path / "out").glob("*")) == []
    find = util.find_spec
    monkeypatch.setattr(util, "find_spec", lambda name, *rest: None if name == "docx" else find(name, *rest))
    path = write(tmp_path / "w.xlsx", ITEMS, FLOORS)
    done = run("run", str(path), "--verify", "none", "--formats", "docx", "--out", str(tmp_path / "out"))
    assert done.exit_code == 2
    said = " ".join(done.stderr.split())
    assert f"docx needs python-docx, which is not installed. {say_install('word')}" in said
    assert not (tmp_path / "out").exists()
    with pytest.raises(InputError, match=re.escape("pip install '.[word]'")):
        assess.write_reports(assess.run(assess.read_inventory(path), Settings(verify="none")), tmp_path, "docx")
