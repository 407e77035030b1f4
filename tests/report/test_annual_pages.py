"""Chances a year in the files of a run: results.json, items.csv, the pages and the sheet Annual."""

import json

import pytest

import assess
from assess.settings import Settings
from tests.hazards import write_hazard
from tests.pipeline.test_annual import BLOCKS, CABINET, assessed

SETTINGS = Settings(runs=60, seed=3)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("annual")
    items = (
        {**CABINET, **BLOCKS, "importance": "life safety"},
        {**CABINET, "item": "b", "breadth": 160, "width": 160, "height": 110},
    )
    assessed(folder, *items, routes=True)
    results = assess.run(folder / "w.xlsx", SETTINGS)
    assess.write_reports(results, folder / "out", formats=("json", "csv", "html", "xlsx"))
    return folder / "out", results


def test_results_json_has_them(folder):
    out, results = folder
    found = json.loads((out / "results.json").read_text(encoding="utf-8"))
    row = results["a"].item.annual
    assert found["items"][0]["annual"]["rate"] == row.rate
    assert found["items"][1]["annual"] is None, "it was not simulated"
    assert found["annual"]["expected_falls"] == results.annual.expected_falls
    assert found["annual"]["life_safety"]["chance_in_50_years"] == pytest.approx(row.chance_in_50_years)
    assert found["routes"]["routes"][0]["annual"]["rate"] == pytest.approx(row.rate)
    assert found["routes"]["rooms"][0]["annual"]["rate"] == pytest.approx(row.rate)
    assert list(found["assess"]["inputs"]["records"]) == ["hazard.csv"]


def read_section(folder):
    text = (folder / "report.html").read_text(encoding="utf-8")
    return text[text.index('<section id="annual">') :].split("</section>")[0]


def test_a_curve_that_does_not_reach_far_enough_is_told_beside_the_number(tmp_path):
    write_hazard(tmp_path, 0.5, 3.0)
    assessed(tmp_path)
    results = assess.run(tmp_path / "w.xlsx", SETTINGS)
    assess.write_reports(results, tmp_path / "out", formats=("html",))
    text = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "at least" in text[: text.index('<section id="annual">')], "in the summary as well"
    section = read_section(tmp_path / "out")
    assert "begins at 0.5 g" in section
    assert "≥" in section
    row = results["a"].item.annual
    assert (row.at_least, row.low, row.median_g) == (True, None, None)


def test_what_is_missing_is_said(tmp_path):
    write_hazard(tmp_path)
    assessed(tmp_path, ground_pga=None, settings=SETTINGS)
    results = assess.run(tmp_path / "w.xlsx", SETTINGS)
    assess.write_reports(results, tmp_path / "out", formats=("html",))
    text = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert text.count("Chances a year were not evaluated: ") == 2
    assert "fill in Ground PGA in Building" in text
