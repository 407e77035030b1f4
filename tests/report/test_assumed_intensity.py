"""Reports of a building of which only an intensity is known: they say so where the numbers are."""

import json
import re

import openpyxl
import pytest

from assess.i18n import load_catalogue, speaking
from assess.intensity import MIDORIKAWA, WORDEN
from assess.report import write_reports
from assess.report.content import build_content
from assess.report.findings.assumed_intensity import say_shaking, say_shaking_shortly
from assess.report.findings.uncertain import say_assumed
from assess.settings import Settings
from tests.cli.calling import run
from tests.workbooks import assessed, write

FLOORS = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 6}]
CHOICE = "MMI VII, very strong"
PARAGRAPH = (
    "Assumed shaking: no motion of the ground is known for this building. MMI VII, very strong is assumed, with its "
    "median PGV of 20.0 cm/s and PGA of 0.215 g (Worden et al. 2012). PGV scatters about this median by 0.88 (standard "
    "deviation of ln PGV), which is drawn."
)
SENTENCE = (
    "Assumed shaking: MMI VII, very strong, by its median PGV of 20.0 cm/s and PGA of 0.215 g, scatter of ln PGV 0.88 "
    "(Worden et al. 2012)."
)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The reports of a run from the command line, of a workbook with Shaking, floors with an Elevation, and pieces."""
    folder = tmp_path_factory.mktemp("assumed")
    path = write(folder / "w.xlsx", floors=FLOORS, shaking=CHOICE, period=0.4)
    done = run("run", path, "--out", folder / "out", "--formats", "json,html,xlsx,csv", "--runs", "25")
    assert done.exit_code == 0, done.stderr
    assert "Assumed shaking: MMI VII, very strong." in done.stdout
    return folder / "out"


def _section(html, start, end):
    return " ".join(re.sub(r"<[^>]+>", " ", html[html.index(start) : html.index(end)]).split())


def test_the_cover_and_the_summary_of_the_html_report_say_so(written):
    html = (written / "report.html").read_text(encoding="utf-8")
    cover = _section(html, '<header class="cover">', "</header>")
    summary = _section(html, '<section id="summary">', '<section id="routes"')
    assert PARAGRAPH in cover
    assert SENTENCE in summary
    assert "With a dispersion of" not in summary, "what is drawn scatters by itself"
    assert "for an earthquake like this one (dispersion 0.88, scatter of ln PGV given" in summary
    assert '<p class="conditions" role="note">Assumed shaking: MMI VII, very strong</p>' in html
    assert "Worden CB, Gerstenberger MC" in _section(html, '<section id="references">', "</main>")


def test_the_excel_report_says_so(written):
    book = openpyxl.load_workbook(written / "report.xlsx")
    texts = [str(cell.value) for row in book["Summary"].iter_rows(max_row=12) for cell in row if cell.value]
    assert PARAGRAPH in texts
    assert "assumed shaking, MMI VII" in (book["Summary"].oddHeader.center.text or "")
    book.close()


def test_the_json_names_intensity_source_medians_and_scatter(written):
    found = json.loads((written / "results.json").read_text(encoding="utf-8"))
    shaking = found["assess"]["shaking"]
    assert (shaking["choice"], shaking["scatter"]) == (CHOICE, 0.88)
    assert (shaking["pga_g"], shaking["pgv_cm_s"]) == pytest.approx((0.2152, 19.98), rel=1e-3)
    assert shaking["references"] == [WORDEN]
    assert found["assess"]["uncertainty"]["motion"] == 0.88
    assert found["building"]["shaking"] == CHOICE
    assert {one["pfa_source"] for one in found["items"]} == {"Shaking MMI VII, beam"}
    assert all("assumed_shaking" in one["adopted"]["flags"] for one in found["items"])


def test_a_report_without_it_says_nothing_of_it(tmp_path):
    results = assessed(tmp_path / "w.xlsx")
    write_reports(results, tmp_path, ["json", "html"])
    assert "ssumed shaking" not in (tmp_path / "report.html").read_text(encoding="utf-8").replace(
        "assumed shaking</dt>", ""
    )
    assert json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["assess"]["shaking"] is None
    assert say_shaking(results) == ""


@pytest.mark.parametrize(
    ("settings", "wanted"),
    [
        (Settings(verify="none"), "The formula takes the median; the scatter is not in it."),
        (Settings(runs=25, ideal=True), "the simulation leaves this scatter out"),
    ],
    ids=["formula alone", "ideal"],
)
def test_where_the_scatter_is_left_out_it_is_not_said_to_be_in(tmp_path, settings, wanted):
    results = assessed(tmp_path / "w.xlsx", floors=FLOORS, shaking=CHOICE, settings=settings)
    content = build_content(results)
    paragraph, sentence = say_shaking(results), say_shaking_shortly(results)
    assert wanted in paragraph
    assert dict(content.assumptions)["Shaking"] == paragraph
    assert "by 0.88 (standard deviation of ln PGV)" in paragraph
    assert "which is drawn" not in paragraph
    assert "0.88" not in sentence
    assert "scatter is not in the results" in sentence
    assert "times" not in paragraph


@pytest.mark.parametrize("runs", [None, 25])
def test_a_factor_stands_next_to_the_medians(tmp_path, runs):
    settings = Settings(verify="none", scale=0.5) if runs is None else Settings(runs=runs, scale=0.5)
    results = assessed(tmp_path / "w.xlsx", floors=FLOORS, shaking=CHOICE, settings=settings)
    assert results.provenance.shaking.pga_g == pytest.approx(0.2152, rel=1e-3)
    assert "(Worden et al. 2012). The results are for these medians times 0.5. PGV scatters" in say_shaking(results)
    assert say_shaking_shortly(results).endswith("The results are for these medians times 0.5.")


def test_a_derived_pga_and_an_open_class_are_among_the_assumptions(tmp_path):
    results = assessed(tmp_path / "w.xlsx", floors=FLOORS, shaking="JMA 7")
    content = build_content(results)
    assumed = dict(content.assumptions)
    assert assumed["PGA of the assumed shaking"].startswith("from PGV by the ratio that is drawn")
    shaking = results.provenance.shaking
    assert shaking.pgv_cm_s / shaking.pga_g == pytest.approx(105)
    assert "open above: taken as 7" in assumed["Class of the assumed shaking"]
    assert "(Midorikawa et al. 1999)" in assumed["Shaking"]
    assert MIDORIKAWA in content.references


def test_a_larger_motion_uncertainty_is_the_workbooks(tmp_path):
    results = assessed(tmp_path / "w.xlsx", floors=FLOORS, shaking=CHOICE, motion_uncertainty=1.0,
                       settings=Settings(runs=25))  # fmt: skip
    text = say_assumed(results)
    assert "dispersion of 1 " in text
    assert "as filled in" in text


def test_the_choice_is_said_in_the_language_of_the_report(tmp_path):
    results = assessed(tmp_path / "w.xlsx", floors=FLOORS, shaking=CHOICE)
    with speaking(load_catalogue("it")):
        assert build_content(results).building["shaking"][1] == load_catalogue("it").find(CHOICE)
