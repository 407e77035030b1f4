"""``assess portfolio``: a city from the command line."""

import os
import re
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest
from typer.testing import CliRunner

from assess.cli.app import app
from assess.cli.command_portfolio import _say_repeat
from assess.portfolio import example_city
from assess.portfolio.city_tables import read_table
from assess.portfolio.example_city import BUILDINGS, write_example_city
from assess.settings import Settings
from tests.portfolio.staged import write_building, write_city
from tests.waiting import PATIENCE, wait_until

run = CliRunner().invoke


def _write(tmp_path, count=2):
    return write_city(tmp_path / "city", [40.0] * count, ground_pga=0.4)


def _call(*words, formats="parquet"):
    return run(app, ["portfolio", *map(str, words), "--verify", "none", "--formats", formats, "--jobs", "1"])


@pytest.mark.slow
def test_a_folder_is_assessed_and_told_in_words_and_the_same_command_goes_on_from_what_is_there(tmp_path):
    city = _write(tmp_path)
    result = _call(city, "--out", tmp_path / "out")
    assert result.exit_code == 0
    assert result.stdout.startswith("2 buildings assessed, 0 skipped.\nEvery building has the ground motion of its own")
    assert "Surveyed buildings, by formula only: 10 pieces, 2 anchored." in result.stdout
    expected = read_table(tmp_path / "out", "buildings")["expected_falls"].sum()
    assert f"Expected to overturn: {expected:.1f} of 8 free-standing pieces in 2 buildings." in result.stdout
    assert "not per year" in result.stdout
    assert "1 workbook has the same content as another; it is counted as a building of its own." in result.stdout
    assert read_table(tmp_path / "out", "buildings")["same_as"].tolist() == [None, "b00.xlsx"]
    notes = read_table(tmp_path / "out", "problems").query("message.str.contains('same content')")
    assert notes["path"].tolist() == ["b01.xlsx"]
    assert "same content as b00.xlsx: it counts as a building of its own" in notes["message"].iloc[0]
    assert f"wrote {tmp_path / 'out' / 'pieces.parquet'}" in result.stderr
    again = _call(city, "--out", tmp_path / "out").stdout
    assert "2 buildings assessed (2 of them by an earlier run), 0 skipped." in again


@pytest.mark.slow
def test_a_skipped_building_is_named_and_the_exit_status_is_1(tmp_path):
    city = _write(tmp_path, 1)
    (city / "bad\x1b[31m.xlsx").write_bytes(b"no workbook")
    write_building(city / "unshaken.xlsx")
    result = _call(city, "--out", tmp_path / "out")
    assert result.exit_code == 1
    assert "1 building assessed, 2 skipped." in result.stdout
    assert "\x1b" not in result.stderr
    assert re.search(r"^error  bad.*\.xlsx: skipped\. .* is not an Excel workbook", result.stderr, re.MULTILINE)
    assert "error  unshaken.xlsx: skipped. " in result.stderr


@pytest.mark.slow
def test_runs_that_do_not_fit_the_scenarios_are_refused_and_leave_the_results(tmp_path):
    city = write_city(tmp_path / "city", [40.0])
    ground, out = tmp_path / "gm", tmp_path / "out"
    ground.mkdir()
    rows = "".join(f"0,{event},{0.2 + event / 100}\n" for event in range(5))
    (ground / "gmf-data.csv").write_text(f"site_id,event_id,gmv_PGA\n{rows}")
    (ground / "sitemesh.csv").write_text("site_id,lon,lat\n0,10.0,40.0\n")
    words = ("portfolio", city, "--ground-motions", ground, "--formats", "html", "--jobs", "1", "--out", out)
    assert run(app, [str(word) for word in (*words, "--runs", "10")]).exit_code == 0
    before = {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}
    result = run(app, [str(word) for word in (*words, "--runs", "12")])
    assert result.exit_code == 2
    said = "error  --runs is 12, expected a multiple of 5, the number of scenarios: each has to count alike."
    assert said in result.stderr
    assert {path: path.read_bytes() for path in out.rglob("*") if path.is_file()} == before


def test_an_extra_that_is_missing_is_told_before_the_example_is_written(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "duckdb", None)
    monkeypatch.setitem(sys.modules, "distributed", None)
    result = _call(tmp_path / "bay", "--example", "--out", tmp_path / "out")
    assert (result.exit_code, result.stderr.count("\n")) == (2, 1)
    assert "the format parquet needs duckdb, which is not installed. Install it from the folder" in result.stderr
    words = [tmp_path / "bay", "--example", "--out", tmp_path / "out", "--scheduler", "tcp://127.0.0.1:1"]
    result = run(app, ["portfolio", *map(str, words), "--formats", "html"])
    assert (result.exit_code, result.stderr.count("\n")) == (2, 1)
    assert "--scheduler: dask is needed, which is not installed" in result.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(os.name == "nt", reason="no signals to send")
@pytest.mark.slow
def test_an_example_that_is_interrupted_leaves_nothing(tmp_path):
    words = ["assess", "portfolio", "bay", "--example", "--verify", "none", "--formats", "html"]
    code = (
        f"import signal, sys\nsignal.signal(signal.SIGINT, signal.default_int_handler)\nsys.argv = {words!r}\n"
        "from assess.cli.app import main\nmain()"
    )
    with subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True, cwd=tmp_path) as process:
        wait_until(lambda: list(tmp_path.glob(".assess-writing-*/new/*/*.xlsx")))
        process.send_signal(signal.SIGINT)
        try:
            _printed, errors = process.communicate(timeout=PATIENCE)
        finally:
            process.kill()
    assert process.returncode == 128 + signal.SIGINT
    assert errors.endswith("Interrupted; nothing was written.\n")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize("count", [30, pytest.param(BUILDINGS, marks=pytest.mark.long)])
def test_the_example_is_a_city_whose_buildings_are_all_assessed(tmp_path, monkeypatch, count):
    monkeypatch.setattr(example_city, "write_example_city", partial(write_example_city, buildings=count))
    result = _call(tmp_path / "bay", "--example", "--out", tmp_path / "out")
    assert result.exit_code == 0, result.stderr
    rows = read_table(tmp_path / "out", "buildings")
    assert len(rows) == count
    assert [set(rows[name]) for name in ("status", "ground_source", "inventory")] == [
        {"assessed"}, {"shakemap"}, {"surveyed", "assumed"},
    ]  # fmt: skip


@pytest.mark.skipif(os.name == "nt", reason="no signals to send")
@pytest.mark.slow
@pytest.mark.parametrize("number", [pytest.param(signal.SIGINT, marks=pytest.mark.long), signal.SIGTERM])
def test_a_signal_ends_the_command_and_keeps_what_is_done(tmp_path, number):
    city = _write(tmp_path, 120)
    words = f"assess portfolio {city} --verify none --out {tmp_path / 'out'} --formats parquet".split()
    code = (
        f"import signal, sys\nsignal.signal(signal.SIGINT, signal.default_int_handler)\nsys.argv = {words!r}\n"
        "from assess.cli.app import main\nmain()"
    )
    parts = tmp_path / "out" / "parts"
    with subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        wait_until(lambda: list(parts.glob("*/*.part")))
        process.send_signal(number)
        try:
            printed, errors = process.communicate(timeout=PATIENCE)
        finally:
            process.kill()
    assert process.returncode == 128 + number
    assert (printed, "Traceback" in errors) == ("", False)
    assert errors.endswith("the same command goes on.\n")
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["parts"]
    result = _call(city, "--out", tmp_path / "out")
    assert re.match(r"120 buildings assessed \(\d+ of them by an earlier run\)", result.stdout)


def test_the_line_that_repeats_a_building_names_what_differs_from_the_defaults():
    assert _say_repeat(Path(), Settings(), None, None) == "assess run ./{path} --city"
    assert _say_repeat(Path("city/index.csv"), Settings(), None, None) == "assess run city/{path} --city"
    assert _say_repeat(Path("-c/index.csv"), Settings(), Path("-g.xml"), None) == (
        "assess run ./-c/{path} --city --shakemap ./-g.xml"
    )
    assert _say_repeat(Path("{path}/index.csv"), Settings(), None, None) == ""
    given = Settings(verify="none", seed=3, scenario="NTC 2018", ideal=True)
    assert _say_repeat(Path("index.csv"), given, Path("my grid.xml"), None) == (
        "assess run ./{path} --city --shakemap 'my grid.xml' --verify none --seed 3 --scenario 'NTC 2018' --ideal"
    )
