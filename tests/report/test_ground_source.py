"""What reports say of the motion of the ground: of a ShakeMap, an assumed intensity, and drawn earthquakes."""

import json
from dataclasses import replace

import openpyxl
import pytest

from assess.report.say.simulation import say_draws
from assess.settings import Settings
from tests.cli.calling import run
from tests.motion.grids import BAY
from tests.report.reading import read_text
from tests.workbooks import assessed, write

FLOORS = [{"floor": "1", "elevation": 0}, {"floor": "2", "elevation": 6}]
PLACE = {"latitude": 37.7893, "longitude": -122.4008}
SENTENCE = (
    "Ground motion: ShakeMap grid.xml of the earthquake Loma Prieta, California, magnitude 6.9, with a median PGA of "
    "0.153 g and PGV of 19.6 cm/s at the building. By its PGV that is about MMI VII, very strong (Worden et al. "
    "2012)."
)
SCATTER = (
    "The standard deviation of ln PGV there is 0.0904 (STDPGA of grid.xml); with 0.4, Motion uncertainty, the "
    "dispersion of the motions is 0.41, the root of the sum of their squares."
)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The reports of a run from the command line with a ShakeMap, of a workbook that lacks only shaking."""
    folder = tmp_path_factory.mktemp("shakemap")
    path = write(folder / "w.xlsx", floors=FLOORS, period=0.4, motion_uncertainty=0.4, **PLACE)
    done = run("run", path, "--out", folder / "out", "--formats", "json,html,xlsx", "--runs", "25", "--shakemap", BAY)
    assert done.exit_code == 0, done.stderr
    assert "Ground motion: ShakeMap grid.xml." in done.stdout
    return folder / "out"


def test_reports_name_source_scatter_and_provenance_where_the_numbers_are(written):
    found = json.loads((written / "results.json").read_text(encoding="utf-8"))
    site = found["assess"]["site_ground"]
    assert (site["kind"], site["file"], site["scenarios"]) == ("shakemap", "grid.xml", 0)
    assert (site["pga_g"], site["pgv_cm_s"], site["dispersion"], site["own_dispersion"]) == pytest.approx(
        (0.1525, 19.64, 0.0904, 0.4), rel=1e-3
    )
    assert [one["period_s"] for one in site["psa"]] == [0.3, 1.0, 3.0]
    assert {"label": "Status of the map", "value": "RELEASED"} in site["facts"]
    assert found["assess"]["uncertainty"]["motion"] == pytest.approx(0.41, abs=1e-3)
    assert {one["pfa_source"] for one in found["items"]} == {"ShakeMap, beam"}
    assert all("shakemap" in one["adopted"]["flags"] for one in found["items"])
    html = (written / "report.html").read_text(encoding="utf-8")
    told = html[html.index('<section id="certainty"') :].partition("</section>")[0]
    assert f"{SENTENCE} {SCATTER}" in read_text(told)
    text = read_text(html)
    assert "dispersion of 0.41 (standard deviation of ln amplitude; the root of 0.4² + 0.0904²: Motion" in text
    for fact in ("19891018000415", "363 m/s; its effect is in the map", f"SHA-256 {site['sha256']}"):
        assert fact in text
    book = openpyxl.load_workbook(written / "report.xlsx")
    texts = [str(cell.value) for row in book["Summary"].iter_rows(max_row=12) for cell in row if cell.value]
    assert any(one.startswith(f"{SENTENCE} {SCATTER}") for one in texts)
    assert "ShakeMap grid.xml" in (book["Summary"].oddHeader.center.text or "")


def test_options_that_contradict_or_cannot_be_used(tmp_path):
    path = write(tmp_path / "w.xlsx", floors=FLOORS, **PLACE)
    both = run("run", path, "--shakemap", BAY, "--ground-motions", tmp_path)
    assert (both.exit_code, "leave one out" in both.stderr) == (2, True)
    none = run("run", path, "--shakemap", tmp_path / "gone.xml", "--out", tmp_path / "out")
    assert (none.exit_code, "gone.xml: the file cannot be read" in none.stderr) == (2, True)
    empty = run("run", path, "--ground-motions", tmp_path, "--out", tmp_path / "out")
    assert (empty.exit_code, "has no gmf-data.csv" in empty.stderr) == (2, True)
    assert not (tmp_path / "out").exists()


ITEMS = [{"item": "A", "floor": "1", "axis": "X", "breadth": 40, "width": 90, "height": 180}]
SETTINGS = Settings(city=True, runs=20)


def test_nothing_is_said_of_draws_that_were_not_made(tmp_path):
    placed = assessed(tmp_path / "w.xlsx", ITEMS, [{"floor": "1", "pfa_x": 0.45}], settings=SETTINGS, period=0.8,
                      motion_uncertainty=0.4, latitude=37.79, longitude=-122.4)  # fmt: skip
    assert say_draws(replace(placed, settings=replace(SETTINGS, ideal=True))) == ""
    fixed = replace(placed.provenance, uncertainty=replace(placed.provenance.uncertainty, motion=0.0))
    assert say_draws(replace(placed, provenance=fixed)) == ""
