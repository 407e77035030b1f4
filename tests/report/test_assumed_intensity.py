"""Reports of a building of which only an intensity is known: they say so where the numbers are."""

import pytest

from assess.intensity import MIDORIKAWA
from assess.report.content import build_content
from assess.report.findings.assumed_intensity import say_shaking, say_shaking_shortly
from assess.report.findings.uncertain import say_assumed
from assess.settings import Settings
from tests.workbooks import assessed

FLOORS = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 6}]
CHOICE = "MMI VII, very strong"


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
