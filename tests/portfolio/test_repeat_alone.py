"""A building of a portfolio is assessed alone to the same numbers: by `--city`, with the same settings."""

import html
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from assess import resources
from assess.cli.app import app
from assess.portfolio.building_task import Task, read_part, run_task
from assess.portfolio.city_tables import read_table
from assess.portfolio.sources import find_sources
from assess.portfolio.table_schemas import TABLES
from assess.settings import Settings
from tests.workbooks import write

ITEMS = [
    {"item": "A", "floor": "1", "axis": "X", "breadth": 40, "width": 90, "height": 180, "quantity": 2},
    {"item": "B", "floor": "1", "axis": "X", "breadth": 50, "width": 90, "height": 180},
]
FLOORS = [{"floor": "1", "pfa_x": 0.45}]
NAMES = [one.key for one in TABLES["pieces"]]


@pytest.mark.slow
def test_a_building_of_a_portfolio_alone_gives_its_numbers(tmp_path):
    """The same workbook at two places: each is repeated to its own numbers, which differ."""
    folder = tmp_path / "city"
    folder.mkdir()
    for name, place in (("a", (37.79, -122.40)), ("b", (37.34, -121.89))):
        write(folder / f"{name}.xlsx", ITEMS, FLOORS, period=0.8, latitude=place[0], longitude=place[1])
    settings, found = Settings(city=True, runs=60, seed=4), {}
    for source in find_sources(folder):
        summary = run_task(Task(source=source, settings=settings, ground=None, out=tmp_path / "out"))
        part = read_part(tmp_path / "out", summary.key)
        report = tmp_path / f"{source.path}-report"
        asked = ["--city", "--runs", "60", "--seed", "4", "--formats", "json", "--out", str(report)]
        done = CliRunner().invoke(app, ["run", str(folder / source.path), *asked])
        assert done.exit_code == 0, done.output
        alone = json.loads((report / "results.json").read_text(encoding="utf-8"))
        rows = [dict(zip(NAMES, row, strict=True)) for row in part.rows("pieces")]
        chances = [one["probability"] for one in rows]
        assert chances == [one["adopted"]["probability"] for one in alone["items"]]
        assert np.mean(part.draws["falls"]) == pytest.approx(2 * chances[0] + chances[1])
        found[source.path] = part.draws["falls"]
    assert found["a.xlsx"] != found["b.xlsx"]


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="the line is one of a POSIX shell")
def test_the_line_on_the_page_works_as_it_stands_where_the_command_was_given(tmp_path, monkeypatch):
    """Names with spaces, quotes and a dash; the line is run by a shell as it stands on the page."""
    monkeypatch.chdir(tmp_path)
    Path("my city").mkdir()
    for name in ("it's one.xlsx", "-two.xlsx"):
        place = {"latitude": 37.79, "longitude": -122.4}
        write(Path("my city", name), ITEMS, [{"floor": "1", "elevation": 0}], height=12, **place)
    Path("my city", "old.xls").write_bytes(b"x")
    shutil.copyfile(resources.city_file("grid.xml"), "-a grid.xml")
    asked = ["--verify", "none", "--scale", "1.2", "--formats", "parquet,html", "--out", "out"]
    asked = ["--shakemap=-a grid.xml", *asked]
    done = CliRunner().invoke(app, ["portfolio", "my city", "--jobs", "1", *asked])
    assert done.exit_code == 1, done.output
    page = Path("out/city.html").read_text(encoding="utf-8")
    found = re.search(r'id="data">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    data = json.loads(found[1])
    lines = {one["path"]: html.unescape(one["command"]) for one in data["buildings"]}
    assert lines["old.xls"] == ""
    assert not any(one["indexed"] for one in data["buildings"])
    environment = os.environ | {"PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    pieces = read_table("out", "pieces")
    for path in ("it's one.xlsx", "-two.xlsx"):
        alone = subprocess.run(lines[path], shell=True, env=environment, capture_output=True, text=True, check=False)
        assert alone.returncode == 0, (lines[path], alone.stderr)
        found = json.loads(Path(f"{Path(path).stem}-report", "results.json").read_text(encoding="utf-8"))
        chances = [one["adopted"]["probability"] for one in found["items"]]
        assert chances == pieces[pieces["path"] == path]["probability"].tolist()
