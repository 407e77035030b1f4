"""A building of a portfolio is assessed alone to the same numbers: by `--city`, with the same settings."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from assess.cli.app import app
from assess.portfolio.building_task import Task, read_part, run_task
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
