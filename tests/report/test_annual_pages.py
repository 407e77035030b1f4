"""Chances a year in the files of a run: results.json, items.csv, the pages and the sheet Annual."""

import csv
import json
from contextlib import closing

import openpyxl
import pytest

import assess
from assess.report.findings.ground_source import say_ground
from assess.settings import Settings
from assess.units import GRAVITY
from tests.hazards import K_0, K, write_hazard
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


def test_how_rare_the_ground_motion_is_stands_in_the_summary(folder):
    """The curve of the tests: K_0 times PGA to the power of -2.5."""
    out, results = folder
    years = 1 / (K_0 * (results.building.ground_pga / GRAVITY) ** -K)
    text = f"Its PGA is exceeded about once in {years:,.0f} years, by the hazard curve."
    assert text in say_ground(results)
    assert text in (out / "report.html").read_text(encoding="utf-8")


def test_items_csv_and_tables_have_them(folder):
    out, results = folder
    with (out / "items.csv").open(encoding="utf-8-sig", newline="") as file:
        first, second = csv.DictReader(file)
    assert float(first["annual_rate"]) == results["a"].item.annual.rate
    assert second["annual_chance_a_year"] == ""
    assert results.routes["annual_rate"].iloc[0] == pytest.approx(results["a"].item.annual.rate)


def test_the_page_says_them(folder):
    out, results = folder
    text = (out / "report.html").read_text(encoding="utf-8")
    section = text[text.index('<section id="annual">') :]
    section = section[: section.index("</section>")]
    years = f"{100 * results['a'].item.annual.chance_in_50_years:.1f} %"
    assert section.count(years) >= 3, "piece, route and room"
    assert "1 free-standing piece is counted" in section
    assert "1 more is too stocky to rock" in section
    assert "Anchored pieces are not counted." in section
    assert "unless it is called a chance a year" in text
    assert '<a href="#annual">' in text[: text.index('<section id="annual">')]


def test_the_sheet_annual_lists_them(folder):
    out, results = folder
    rows = read_sheets(out)["Annual"]
    heads = rows[0]
    listed = [dict(zip(heads, row, strict=True)) for row in rows[1:4]]
    assert [(one["What"], one["Name"]) for one in listed] == [("piece", "a"), ("route", "A"), ("room", "Room")]
    assert listed[0]["Times a year"] == pytest.approx(results["a"].item.annual.rate)
    assert any(row[0] and "as run" in str(row[0]) for row in rows)


def read_sheets(folder):
    with closing(openpyxl.load_workbook(folder / "report.xlsx", read_only=True)) as book:
        return {sheet.title: list(sheet.values) for sheet in book}


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


def test_a_route_is_shown_with_anchors_that_fail(tmp_path):
    assessed(tmp_path, {**CABINET, **BLOCKS, "anchored": "yes"}, routes=True)
    results = assess.run(tmp_path / "w.xlsx", SETTINGS)
    assess.write_reports(results, tmp_path / "out", formats=("html", "xlsx"))
    (route,) = results.route_tables.routes
    assert (route.annual.rate, route.annual.at_least) == (0, False)
    share = f"{100 * route.annual_if_anchors_fail.chance_in_50_years:.1f} %"
    assert share in read_section(tmp_path / "out")
    assert "There is no free-standing piece that was simulated and can rock." in read_section(tmp_path / "out")
    rows = read_sheets(tmp_path / "out")["Annual"]
    at = rows[0].index("If anchors fail (50 years)")
    assert rows[1][at] == pytest.approx(route.annual_if_anchors_fail.chance_in_50_years)


@pytest.mark.parametrize(
    ("given", "words"), [(0, "which is assumed"), (None, "which is assumed"), (0.3, "of the workbook")]
)
def test_where_the_scatter_comes_from_is_said(tmp_path, given, words):
    assessed(tmp_path, motion_uncertainty=given)
    results = assess.run(tmp_path / "w.xlsx", SETTINGS)
    assess.write_reports(results, tmp_path / "out", formats=("html",))
    assert words in read_section(tmp_path / "out")


def test_what_is_missing_is_said(tmp_path):
    write_hazard(tmp_path)
    assessed(tmp_path, ground_pga=None, settings=SETTINGS)
    results = assess.run(tmp_path / "w.xlsx", SETTINGS)
    assess.write_reports(results, tmp_path / "out", formats=("html",))
    text = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert text.count("Chances a year were not evaluated: ") == 2
    assert "fill in Ground PGA in Building" in text


def test_without_a_hazard_file_nothing_is_said(tmp_path):
    assessed(tmp_path, hazard=None, settings=Settings(verify="none"))
    results = assess.run(tmp_path / "w.xlsx", Settings(verify="none"))
    assess.write_reports(results, tmp_path / "out", formats=("html", "json", "xlsx"))
    assert "a year" not in (tmp_path / "out" / "report.html").read_text(encoding="utf-8").replace("years", "")
    assert json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))["annual"] is None
    assert "Annual" not in read_sheets(tmp_path / "out")
