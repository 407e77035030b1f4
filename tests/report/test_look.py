"""How a report looks: its language, its logo, and a firm's own templates."""

import base64
import re
import struct

import pytest
from typer.testing import CliRunner

import assess
from assess.cli.app import app
from assess.errors import InputError
from assess.i18n import load_catalogue
from assess.report.report_options import ReportOptions
from tests.nets.nets import find_shown
from tests.pictures import picture
from tests.report.reading import render
from tests.workbooks import assessed, write

HEAD = """msgid ""
msgstr ""
"Content-Type: text/plain; charset=utf-8\\n"
"Plural-Forms: nplurals=2; plural=(n != 1);\\n"

"""


@pytest.fixture(scope="module")
def assessment(tmp_path_factory):
    return assessed(tmp_path_factory.mktemp("look") / "w.xlsx", building="Town hall", period=0.9)


def own(folder, name, text):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return ReportOptions(templates=folder)


@pytest.mark.slow
def test_cover_order_and_choice_of_sections_can_be_the_firms_own(assessment, tmp_path):
    own(tmp_path, "cover.html.j2", "<h1>Ours: {{ page.document.title }}</h1>")
    frame = """{% include "cover.html.j2" %}{% for one in page.sections | reverse if one.id in ("limits", "summary") %}
<div title="{{ one.heading }}">{{ one.html }}</div>{% endfor %}"""
    html = render(assessment, own(tmp_path, "page.html.j2", frame))
    assert "<h1>Ours: Furniture in earthquakes: Town hall</h1>" in html
    assert re.findall('<section id="([^"]+)"', html) == ["limits", "summary"]
    assert '<div title="Limits of the methods">' in html
    assert "Every piece is a rigid block" in html
    assert "Data-quality log" not in html


def test_texts_of_the_firms_own_come_first_and_files_for_programs_are_the_same_in_every_language(assessment, tmp_path):
    look = own(tmp_path, "texts/en.po", HEAD + 'msgid "Summary"\nmsgstr "What matters"\n')
    assert '<h2 id="summary-heading">What matters</h2>' in render(assessment, look)
    formats = ("json", "csv")
    english = assess.write_reports(assessment, tmp_path / "en", formats)
    italian = assess.write_reports(assessment, tmp_path / "it", formats, ReportOptions(language="it"))
    for name in formats:
        assert english[name].read_bytes() == italian[name].read_bytes()


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("{{ page.nothing }}", r"cover\.html\.j2, line 2: .*has no attribute 'nothing'"),
        ("{% if %}", r"cover\.html\.j2, line 2: "),
        ("{{ page.__class__ }}", r"cover\.html\.j2, line 2: access to attribute '__class__' .* is unsafe"),
        ("{{ 1 / 0 }}", r"cover\.html\.j2, line 2: division by zero"),
        ("{% include 'other.j2' %}", r"other\.j2"),
    ],
)
def test_a_fault_in_a_template_is_told_with_its_place(assessment, tmp_path, text, told):
    with pytest.raises(InputError, match=f"^templates: .*{told}"):
        render(assessment, own(tmp_path, "cover.html.j2", f"\n{text}"))


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("cover.html.j2", "{% if %}", "cover.html.j2, line 1: Expected an expression"),
        ("texts/en.po", "msgid no quotes", "the texts cannot be read"),
    ],
)
def test_what_cannot_be_read_is_told_before_the_work(tmp_path, name, text, told):
    book = write(tmp_path / "w.xlsx")
    own(tmp_path / "firm", name, text)
    done = CliRunner().invoke(
        app, ["run", str(book), "--out", str(tmp_path / "o"), "--template", str(tmp_path / "firm")]
    )
    assert done.exit_code == 2
    assert told in done.stderr
    assert not (tmp_path / "o").exists()


def test_a_folder_without_templates_and_a_folder_or_language_that_is_not_there_is_told(tmp_path):
    for name, told in (
        ("covers.html.j2", r"replaces no standard template. Did you mean cover.html"),
        ("sections/limits.html.j2", "is no longer a template. Choose and order the sections in page.html.j2"),
        (".hidden", "holds no template: expected some of city.html.j2, cover"),
    ):
        with pytest.raises(InputError, match=told):
            own(tmp_path / name.partition("/")[0], name, "")
    with pytest.raises(InputError, match="templates: there is no folder"):
        ReportOptions(templates=tmp_path / "none")
    with pytest.raises(InputError, match="language is 'xx', expected one of en, it"):
        ReportOptions(language="xx")


def test_an_italian_report_holds_no_english_sentence(assessment):
    """Every text of the catalogue that is more than a word or two, and is another in Italian, is said in Italian."""
    english = {
        one
        for one, texts in load_catalogue("it").messages.items()
        if len(one.split()) >= 3 and one not in texts and "{" not in one and "<" not in one
    }
    assert len(english) > 200
    titles = str([str(method.reference) for method in assessment.methods])  # publications keep their titles
    for kind in ("html", "docx", "pdf", "annex"):
        text = " ".join(find_shown("everything-it", kind).read_text(encoding="utf-8").split())
        found = {one for one in english if one in text and one not in titles}
        assert found <= {"Bookcase 5 shelves"}, "a type of the workbook's own"
        assert re.search(r"\d,\d %", text)
        assert not re.search(r"\d\.\d %", text)


@pytest.mark.slow
def test_a_logo_is_embedded_and_a_style_of_the_firms_own_stands_in(tmp_path, assessment):
    for size, shown in (((40, 30), (40, 30)), ((4000, 50), (1334, 17))):
        (tmp_path / "logo.png").write_bytes(picture("PNG", size=size))
        html = render(assessed(tmp_path / "w.xlsx", logo="logo.png", organisation="Us & Co"))
        found = re.search(r'<img class="logo" src="data:image/png;base64,([^"]+)" alt="Logo of Us &amp; Co">', html)
        assert found
        assert struct.unpack(">II", base64.b64decode(found[1])[16:24]) == shown
    style = "h1 { color: teal; }"
    assert style in render(assessment, own(tmp_path / "firm", "style/screen.css", style))
