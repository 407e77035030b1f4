"""Chances a year in results.json and on the pages."""

import json

import pytest

from assess.pipeline.run import build_results
from assess.report.data import write_json
from assess.settings import Settings
from tests.hazards import write_hazard
from tests.pipeline.test_annual import BLOCKS, CABINET, assessed
from tests.report.reading import write_html

SETTINGS = Settings(runs=60, seed=3)


def test_results_json_has_them(tmp_path):
    items = ({**CABINET, **BLOCKS, "importance": "life safety"},
             {**CABINET, "item": "b", "breadth": 160, "width": 160, "height": 110})  # fmt: skip
    results = build_results(assessed(tmp_path, *items, routes=True, settings=SETTINGS))
    write_json(results, tmp_path / "r.json")
    found, row = json.loads((tmp_path / "r.json").read_text(encoding="utf-8")), results["a"].item.annual
    assert found["items"][0]["annual"]["rate"] == row.rate
    assert found["items"][1]["annual"] is None, "it was not simulated"
    assert found["annual"]["expected_falls"] == results.annual.expected_falls
    assert found["annual"]["life_safety"]["chance_in_50_years"] == pytest.approx(row.chance_in_50_years)
    for name in ("routes", "rooms"):
        assert found["routes"][name][0]["annual"]["rate"] == pytest.approx(row.rate)
    assert list(found["assess"]["inputs"]["records"]) == ["hazard.csv"]


@pytest.mark.slow
def test_a_curve_that_does_not_reach_far_enough_is_told_beside_the_number(tmp_path):
    write_hazard(tmp_path, 0.5, 3.0)
    results = build_results(assessed(tmp_path, settings=SETTINGS))
    summary, _, section = write_html(results, tmp_path).partition('<section id="annual">')
    assert "at least" in summary
    assert "begins at 0.5 g" in section.partition("</section>")[0]
    assert "≥" in section.partition("</section>")[0]
    row = results["a"].item.annual
    assert (row.at_least, row.low, row.median_g) == (True, None, None)


@pytest.mark.slow
def test_what_is_missing_is_said(tmp_path):
    write_hazard(tmp_path)
    text = write_html(build_results(assessed(tmp_path, ground_pga=None, settings=SETTINGS)), tmp_path)
    assert text.count("Chances a year were not evaluated: ") == 2
    assert "fill in Ground PGA in Building" in text
