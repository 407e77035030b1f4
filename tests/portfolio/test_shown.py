"""Every output of a made-up city, in which all that may be said of one is said, says what it said."""

import html
import json
import re
from pathlib import Path

import pytest

from assess.cli.command_portfolio import describe_city
from assess.i18n import fill
from assess.portfolio.city import City, RunGround
from assess.portfolio.city_page import render_page, render_summary
from assess.portfolio.ranking_workbook import render_ranking
from assess.portfolio.run_portfolio import PortfolioResult
from assess.report.report_options import ReportOptions
from assess.settings import Settings
from tests.nets.lines import flatten, read_excel, read_html, read_pdf
from tests.portfolio.city_samples import BUILDING, NASTY, PIECE, frame

LANGUAGES = ("en", "it")
RENDERERS = {"html": (render_page, read_html), "xlsx": (render_ranking, read_excel), "pdf": (render_summary, read_pdf)}
BUILDINGS = (
    {"path": "a/school.xlsx", "building": "School", "use": "School", "unconfirmed": 1, "by_formula": 1, "rolls": 0,
     "routes": 3, "routes_open": 1, "routes_blocked": 1, "routes_not_known": 1, "occupants": 90, "people_not_known": 30,
     "people_blocked": 18.4, "own_motions": 2, "warnings": 3, "works_without_cost": 2},
    {"path": "b/school.xlsx", "building": "School", "use": "school", "same_as": "a/school.xlsx", "is_placed": False,
     "latitude": None, "longitude": None, "cost": None, "works_without_cost": 4, "routes": 1, "routes_doubtful": 1,
     "occupants": 12, "people_not_known": 0, "people_blocked": 0.3},
    {"path": "formula.xlsx", "building": NASTY, "basis": "formula", "draws": 0, "falls_p05": None, "falls_p95": None,
     "storeys": 12, "ground_source": "sds", "ground_distance_km": 14.2, "motion_uncertainty": None},
    {"path": "hospital.xlsx", "building": "Hospital", "inventory": "handover", "use": "Hospital", "left_out": 7,
     "low": 0, "medium": 0, "high": 0, "very_high": 0, "unconfirmed": 8, "expected_falls": 0.0, "falls_p95": 0.0,
     "latitude": 37.75, "routes": 1, "routes_not_known": 1, "occupants": 40, "people_not_known": 40, "works": 0},
    {"path": "Tower", "building": "Tower", "inventory": "assumed", "falls_low_inventory": 0.4, "low": 25,
     "expected_falls": 11.2, "falls_high_inventory": 19.75, "longitude": -122.1, "ground_pga_g": None,
     "ground_pgv_cm_s": None},
    {"path": "broken.xlsx", "building": "Town hall", "status": "skipped", "inventory": None, "basis": None,
     "latitude": None, "longitude": None},
    {"path": "gone.xlsx", "status": "skipped", "inventory": None, "basis": None, "latitude": None, "longitude": None},
)  # fmt: skip
PIECES = (
    {"item": "A1", "work_place": 1, "detail": "L-bracket to studs", "unit_cost": 90.0, "route": "East"},
    {"item": "A2", "risk_class": "very high", "risk_class_upper": "very high", "probability": 0.95, "work_place": 2,
     "probability_low": 0.9, "probability_high": 0.99, "description": "Archive shelf", "detail": "base angle"},
    {"item": "A3", "is_held": True, "anchored": "yes", "type": None, "width_cm": None},
    {"item": "A4", "basis": "unconfirmed", "risk_class": "high"},
    {"item": "A5", "basis": "formula", "probability_low": None, "probability_high": None},
    {"item": "A6", "basis": "cannot rock", "risk_class": "low", "risk_class_upper": "low", "probability": 0.0,
     "probability_low": None, "probability_high": None, "type": None},
)  # fmt: skip
ROUTES = (
    {"path": "a/school.xlsx", "route": "East", "state": "open", "probability": 0.01, "probability_low": 0.004,
     "probability_high": 0.02, "occupants": 30, "blockers": "A1; A2"},
    {"path": "a/school.xlsx", "route": "North", "state": "blocked", "probability": 0.6, "occupants": 30},
    {"path": "a/school.xlsx", "route": "West", "state": "not known", "occupants": 30, "to_fill_in": "Clear width"},
    {"path": "b/school.xlsx", "route": "South", "state": "doubtful", "probability": 0.03, "occupants": 12},
    {"path": "hospital.xlsx", "route": "Way out", "state": "not known", "occupants": 40},
)  # fmt: skip
PROBLEMS = (
    {"path": "a/school.xlsx", "severity": "warning", "sheet": "Floors", "cell": "B2", "message": "a warning."},
    {"path": "a/school.xlsx", "severity": "note", "message": "a note."},
    {"path": "broken.xlsx", "severity": "error", "sheet": "Items", "cell": "H14", "fix": "Did you type metres?",
     "message": "height is 1.8 cm, expected 5 to 600."},
)  # fmt: skip


def build_city() -> City:
    """Return a city of all inventories and bases, with whatever may be missing or be warned of."""
    drawn = [one for one in BUILDINGS if one.get("basis", "simulated") == "simulated" and "draws" not in one]
    draws = [
        {"path": one["path"], "draw": at, "falls": at % (3 + number), "people_blocked": 10 * (at % 4 == number),
         "routes_blocked": int(at % 4 == number)}
        for number, one in enumerate(drawn)
        for at in range(20)
    ]  # fmt: skip
    facts = ((fill("Event"), fill("Loma Prieta, magnitude 6.9")), (fill("Map status"), fill("RELEASED")))
    return City(
        buildings=frame("buildings", [BUILDING | one for one in BUILDINGS]),
        pieces=frame(
            "pieces",
            [PIECE | {"path": building["path"], "row": 2 + at} | one
             for building in BUILDINGS[:4] for at, one in enumerate(PIECES)],
        ),
        routes=frame("routes", ROUTES),
        problems=frame("problems", PROBLEMS),
        draws=frame("draws", draws),
        settings=Settings(city=True, runs=20, scale=1.2, scenario="ASCE 7-22"),
        ground=RunGround(kind="shakemap", file="grid.xml", sha256="0" * 64, facts=facts,
                         cautions=(fill("the map is automatic"),)),
    )  # fmt: skip


def show(kind: str, language: str, folder: Path) -> list[str]:
    """Return the lines of an output; the data of the page follow its words."""
    city = build_city()
    if kind == "txt":
        result = PortfolioResult(folder=folder, files=(), removed=(), kept=1, skipped=(), city=city)
        return list(describe_city(result))
    render, read = RENDERERS[kind]
    path = folder / f"city.{kind}"
    more = {"repeat": "assess run {path} --city", "indexed": {"formula.xlsx"}} if kind == "html" else {}
    path.write_bytes(render(city, options=ReportOptions(language=language), **more))
    if kind != "html":
        return read(path)
    page = path.read_text(encoding="utf-8")
    data = json.loads(page.split('id="data">')[1].split("</script>")[0])
    texts = dict(re.findall(r'  data-(\w+)="(.*?)"', html.unescape(page.split('id="texts"')[1].split("</div>")[0])))
    data["tables"] = {name: dict(_unpack(table)) for name, table in data["tables"].items()}
    return [*read(path), *flatten(data | {"texts": texts}, "")]


def _unpack(table):
    yield "heads", " | ".join(table["heads"])
    yield "numeric", str(table["numeric"])
    for at, (start, end) in enumerate(zip(table["starts"], table["starts"][1:], strict=False)):
        for row in range(start, end):
            cells = (texts[column[row]] for texts, column in zip(table["texts"], table["columns"], strict=True))
            yield f"{at}/{row - start}", " | ".join(cells)


CASES = [(kind, language) for kind in RENDERERS for language in LANGUAGES] + [("txt", "en")]


@pytest.mark.parametrize(
    ("kind", "language"), [pytest.param(*one, marks=[pytest.mark.slow] if one[0] == "pdf" else []) for one in CASES]
)
def test_outputs_say_what_they_said(kind, language, tmp_path, monkeypatch, differ):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1767225600")
    assert differ(f"city.{language}.{kind}", show(kind, language, tmp_path)) == []
