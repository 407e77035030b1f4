import json
import re

import pytest
from typer.testing import CliRunner

import assess
from assess.cli import app
from assess.methods import all_methods
from tests.workbooks import write

run = CliRunner().invoke
RUN = ("run", "--verify", "none")


def test_help_names_every_command():
    text = run(app, ["--help"]).output
    for command in ("new", "check", "run", "routes", "record", "rock", "methods", "doctor"):
        assert re.search(rf"^\s+{command}\b", text, re.MULTILINE)


def test_version():
    assert run(app, ["--version"]).output == f"assess {assess.__version__}\n"


def test_new_then_check_says_what_is_missing(tmp_path):
    path = tmp_path / "w.xlsx"
    assert run(app, ["new", str(path)]).exit_code == 0
    checked = run(app, ["check", str(path)])
    assert checked.exit_code == 2
    assert "Items!A2: the table has no rows: nothing is assessed. Fill in at least one." in checked.stderr
    assert "1 error; nothing was written." in checked.stderr


@pytest.mark.parametrize("units", ["si", "imperial"])
def test_the_example_runs(tmp_path, units):
    path = tmp_path / "w.xlsx"
    assert run(app, ["new", str(path), "--example", "--units", units]).exit_code == 0
    assert run(app, ["check", str(path)]).exit_code == 0
    done = run(app, [*RUN, str(path), "--out", str(tmp_path / "out"), "--formats", "json"])
    assert done.exit_code == 0
    assert "not per year. Not verified." in done.stdout
    assert json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))["items"]


def test_new_leaves_a_file_alone_unless_forced(tmp_path):
    path = tmp_path / "w.xlsx"
    path.write_text("mine")
    done = run(app, ["new", str(path)])
    assert done.exit_code == 1
    assert "is there already; add --force" in done.stderr
    assert path.read_text() == "mine"
    assert run(app, ["new", str(path), "--force"]).exit_code == 0
    assert path.read_bytes().startswith(b"PK")


def test_new_wants_xlsx_and_a_folder_that_is_there(tmp_path):
    done = run(app, ["new", str(tmp_path / "w.xls")])
    assert (done.exit_code, "does not end in .xlsx" in done.stderr) == (1, True)
    done = run(app, ["new", str(tmp_path / "none" / "w.xlsx")])
    assert (done.exit_code, "could not be written" in done.stderr) == (1, True)


def test_bad_input_writes_nothing(tmp_path):
    path = write(tmp_path / "w.xlsx", [{"item": "a", "floor": "9", "breadth": 30, "height": 180}])
    done = run(app, [*RUN, str(path), "--out", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert "Items!B2: Floor '9' is not in the Floors sheet." in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--verify", "maybe"], "Invalid value for --verify: 'maybe' is not one of: none, high, all."),
        (["--runs", "0"], "Invalid value for --runs: '0' is not a number from 1 to 100,000, nor auto."),
        (["--runs", "x"], "Invalid value for --runs: 'x' is not a number from 1 to 100,000, nor auto."),
        (["--runs", "100001"], "Invalid value for --runs: '100001' is not a number from 1 to 100,000, nor auto."),
        (["--runs", "9" * 5000], "Invalid value for --runs: '999"),
        (["--seed", "-1"], "Invalid value for '--seed': "),
        (["--jobs", "0"], "Invalid value for '--jobs': "),
        (
            ["--motions", ".", "--runs", "50"],
            "Invalid value for --motions: your own motions are all taken, in a verification: leave out --verify none, "
            "--runs and --seed.",
        ),
        (["--motions", ".", "--seed", "2"], "Invalid value for --motions: your own motions are all taken"),
        (
            ["--motions", ".", "--verify", "none"],
            "Invalid value for --motions: your own motions are all taken",
        ),
        (["--scale-motions"], "Invalid value for --scale-motions: there are no motions to scale: name their folder by"),
        (
            ["--formats", "npz", "--verify", "none"],
            "Invalid value for --formats: npz holds what verification finds: leave out --verify none.",
        ),
        (["--scenario", "ASCE 7-10"], "'ASCE 7-10' is not one of: as filled, recorded, given, ASCE 7-22, ASCE 7-16"),
        (["--formats", "docx"], "'docx' is not a list of: pdf, xlsx, html, json, csv"),
        (["--formats", ""], "is not a list of"),
    ],
)
def test_wrong_usage_exits_with_2(tmp_path, arguments, message):
    done = run(app, ["run", str(write(tmp_path / "w.xlsx")), "--out", str(tmp_path / "out"), *arguments])
    assert done.exit_code == 2
    assert message in " ".join(re.sub(r"[│\n]", " ", done.stderr).split())
    assert not (tmp_path / "out").exists()


def test_a_scenario_that_a_floor_cannot_serve_names_the_floor(tmp_path):
    path = write(tmp_path / "w.xlsx")
    done = run(app, [*RUN, str(path), "--out", str(tmp_path / "out"), "--scenario", "recorded"])
    assert done.exit_code == 2
    assert "Floors!H2: floor '1' has no record, which the scenario 'recorded' asks for" in done.stderr
    assert "Floors!H3" in done.stderr


@pytest.mark.parametrize("spelt", ["ASCE 7-22", "asce7-22", "Asce_7_22"])
def test_a_scenario_may_be_spelt_loosely(tmp_path, spelt):
    path = write(tmp_path / "w.xlsx", floors=[{"floor": at, "elevation": at} for at in (1, 2)], ground_pga=0.2)
    done = run(app, [*RUN, str(path), "--out", str(tmp_path / "out"), "--formats", "json", "--scenario", spelt])
    assert done.exit_code == 0, done.stderr
    found = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
    assert found["assess"]["settings"]["scenario"] == "ASCE 7-22"


def test_a_profile_without_ground_motion_names_the_cell_and_every_floor_without_elevation(tmp_path):
    done = run(app, [*RUN, str(write(tmp_path / "w.xlsx")), "--out", str(tmp_path / "out"), "--scenario", "NTC 2018"])
    assert done.exit_code == 2
    assert "Building!B18: Ground PGA and SDS are blank; the scenario 'NTC 2018' starts from one" in done.stderr
    for cell in ("C2", "C3"):
        assert re.search(rf"Floors!{cell}: floor '\d' has no Elevation, which the scenario 'NTC 2018'", done.stderr)


def test_the_default_folder_is_named_after_the_workbook(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "tower.xlsx")
    assert run(app, [*RUN, "tower.xlsx", "--formats", "csv"]).exit_code == 0
    assert (tmp_path / "tower-report" / "items.csv").is_file()


def test_methods_lists_every_method():
    text = run(app, ["methods"]).output
    for method in all_methods():
        assert f"{method.key}: {method.title}" in text
        assert str(method.reference) in text


def test_doctor_finds_all_that_is_installed_here():
    done = run(app, ["doctor"])
    assert f"assess: {assess.__version__}" in done.output
    assert done.exit_code == (1 if "missing" in done.output else 0)
    for name in ("numpy", "openpyxl", "shapely", "networkx", "templates", "fonts", "PDF"):
        assert re.search(rf"^(ok|missing)\s+{name}:", done.output, re.MULTILINE)


def test_many_problems_are_counted_not_all_printed(tmp_path):
    items = [{"item": f"i{at}", "floor": "9", "breadth": 30, "height": 180} for at in range(300)]
    done = run(app, ["check", str(write(tmp_path / "w.xlsx", items))])
    assert done.stderr.count("is not in the Floors sheet") == 200
    assert re.search(r"\.\.\. and 10\d more\.", done.stderr)
    assert "300 errors" in done.stderr
