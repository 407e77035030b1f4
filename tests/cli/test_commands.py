import json
import re
import shlex
import subprocess
import sys
import tomllib
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import pytest
from typer.testing import CliRunner

import assess
from assess.cli import command_doctor
from assess.cli.app import app, find_commands
from assess.cli.command_doctor import Requirement
from assess.cli.console import _list_options
from assess.extras import say_install
from tests.waiting import PATIENCE
from tests.workbooks import write

run = CliRunner().invoke
RUN = ("run", "--verify", "none")
ROOT = Path(__file__).parents[2]


def test_the_help_of_each_command_has_examples_that_show_its_options():
    """An option that several commands have in the same way is shown by one; by its argument a message names it."""
    for name, module in find_commands():
        text, options = run(app, [name, "--help"]).output, set(_list_options(module.command).values())
        assert set(re.findall(r"^  (?:-\w, )?(--[a-z-]+)", text, re.MULTILINE)) - {"--help"} == options
        assert len(module.EXAMPLES) >= 2
        shown = set()
        for example in module.EXAMPLES:
            assert f"  {example}\n" in text
            words = shlex.split(example)
            assert words[:2] == ["assess", name]
            shown |= {word for word in words if word.startswith("--")}
        assert shown <= options
        assert options - shown <= ({"--jobs", "--seed", "--runs", "--scenario"} if name != "run" else set())


def test_help_loads_nothing_heavy():
    """Nor does any file of a command, when it is found."""
    heavy = ("numpy", "scipy", "numba", "openpyxl", "jinja2", "matplotlib", "babel", "assess.studies", "assess.report")
    code = (
        "import sys\nsys.argv = ['assess', '--help']\nfrom assess.cli.app import main\n"
        f"try:\n    main()\nexcept SystemExit:\n    print([name for name in {heavy!r} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert done.stdout.splitlines()[-1] == "[]", done.stderr


def test_version():
    assert run(app, ["--version"]).output == f"assess {assess.__version__}\n"


@pytest.mark.parametrize("units", ["si", "imperial"])
def test_the_example_runs(tmp_path, monkeypatch, units):
    monkeypatch.chdir(tmp_path)
    done = run(app, ["new", "w.xlsx", "--example", "--units", units])
    assert (done.exit_code, done.stderr) == (
        0, "wrote w.xlsx. Open it to see its classes. Assess it with: assess run w.xlsx\n",
    )  # fmt: skip
    assert run(app, ["check", "w.xlsx"]).exit_code == 0
    done = run(app, [*RUN, "w.xlsx", "--formats", "json"])
    assert done.exit_code == 0
    assert "not per year. Not simulated." in done.stdout
    folder = tmp_path / "w-report"
    assert json.loads((folder / "results.json").read_text(encoding="utf-8"))["items"]


def test_new_leaves_a_file_alone_unless_forced(tmp_path):
    path = tmp_path / "w.xlsx"
    path.write_text("mine")
    done = run(app, ["new", str(path)])
    assert done.exit_code == 1
    assert "already exists: add --force" in done.stderr
    assert path.read_text() == "mine"
    assert run(app, ["new", str(path), "--force"]).exit_code == 0
    assert path.read_bytes().startswith(b"PK")


def test_new_wants_xlsx_and_a_folder_that_is_there(tmp_path):
    done = run(app, ["new", str(tmp_path / "w.xls")])
    assert (done.exit_code, "does not end in .xlsx" in done.stderr) == (2, True)
    done = run(app, ["new", str(tmp_path / "none" / "w.xlsx")])
    assert (done.exit_code, "could not be written" in done.stderr) == (1, True)


def test_bad_input_writes_nothing(tmp_path):
    path = write(tmp_path / "w.xlsx", [{"item": "a", "floor": "9", "breadth": 30, "height": 180}])
    done = run(app, [*RUN, str(path), "--out", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert "Items!C2: Floor '9' is not in the Floors sheet." in done.stderr
    assert not (tmp_path / "out").exists()


def test_wrong_usage_exits_with_2(tmp_path):
    path = str(write(tmp_path / "w.xlsx"))
    once = "--motions: the simulation uses each of your own motions once; leave out --verify none, --runs and"
    for arguments, message in (
        (["--scale", "0"], "--scale is 0.0, expected above 0 and at most 10"),
        (["--scale", "11"], "--scale is 11.0, expected above 0 and at most 10"),
        (["--scale", "nan"], "--scale is nan, expected above 0 and at most 10"),
        (["--scale", "many"], "Invalid value for '--scale': 'many' is not a number; expected one such as 1.5 or 150%"),
        (["--verify", "none", "--ideal"], "--ideal is about the simulation: leave out --ideal or --verify none"),
        (["--verify", "maybe"], "--verify is 'maybe', expected one of: none, high, all"),
        (["--runs", "0"], "--runs is '0', expected 1 to 100,000, or auto"),
        (["--runs", "9" * 5000], "--runs is '999"),
        (["--seed", "-1"], "--seed is -1, expected a whole number, 0 or above"),
        (["--jobs", "0"], "Invalid value for '--jobs': "),
        *((["--motions", ".", *more], once) for more in (["--runs", "50"], ["--seed", "2"], ["--verify", "none"])),
        (["--scale-motions"], "--scale-motions: there are no motions to scale; name their folder with --motions"),
        (["--formats", "npz", "--verify", "none"], "--formats: npz holds results of the simulation: leave out npz or"),
        (["--scenario", "ASCE 7-10"], "--scenario is 'ASCE 7-10', expected one of: as filled, recorded, given"),
        (["--formats", "json,odt"], "--formats: 'odt' is an unknown format; expected some of: pdf, annex, xlsx"),
        (["--formats", ""], "--formats: no format is named"),
        (["--open", "--formats", "json,csv"], "--open opens a report: write one of html, pdf, xlsx with --formats."),
        (["--language", "fr"], "--language 'fr' is unknown: expected one of en, it"),
        (["--scenario", "recorded"], "Floors!H2: floor '1' has no record, which the scenario 'recorded' needs"),
        (["--scenario", "NTC 2018"], "Building!B21: Ground PGA, SDS, ShakeMap file and Shaking are blank; the"),
        (["--scenario", "NTC 2018"], "Floors!C3: floor '2' has no Elevation, which the scenario 'NTC 2018'"),
    ):
        done = run(app, ["run", path, "--out", str(tmp_path / "out"), *arguments])
        assert done.exit_code == 2, arguments
        assert message in " ".join(re.sub(r"[│\n]", " ", done.stderr).split()), arguments
        assert not (tmp_path / "out").exists()


def test_scale_and_ideal_reach_the_settings(tmp_path, monkeypatch):
    given = []

    def stop(inventory, settings, **_):
        given.append(settings)
        raise assess.InputError("seen")

    monkeypatch.setattr("assess.pipeline.run.run", stop)
    path = write(tmp_path / "w.xlsx")
    for words in ([], ["--scale", "0.9", "--ideal"], ["--verify", "high"], ["--scale", "150%"], ["--scale", " 60 % "]):
        assert run(app, ["run", str(path), "--out", str(tmp_path / "out"), *words]).exit_code == 2
    assert [(one.verify, one.scale, one.ideal, one.scale_motions) for one in given] == [
        ("all", 1.0, False, False), ("all", 0.9, True, False), ("high", 1.0, False, False),
        ("all", 1.5, False, False), ("all", 0.6, False, False),
    ]  # fmt: skip


def test_a_scenario_is_accepted_in_any_spelling(tmp_path):
    path = write(tmp_path / "w.xlsx", floors=[{"floor": at, "elevation": at} for at in (1, 2)], ground_pga=0.2)
    done = run(app, [*RUN, str(path), "--out", str(tmp_path / "out"), "--formats", "json", "--scenario", "asce7-22"])
    assert done.exit_code == 0, done.stderr
    found = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
    assert found["assess"]["settings"]["scenario"] == "ASCE 7-22"


@pytest.mark.slow
def test_doctor_finds_all_that_is_installed_here():
    done = run(app, ["doctor"])
    assert f"assess: {assess.__version__}" in done.output
    assert done.exit_code == (1 if re.search(r"^missing ", done.output, re.MULTILINE) else 0)
    assert re.search(r"^ok +templates: ", done.output, re.MULTILINE)
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["dependencies"]
    names = [re.split(r"[^\w-]", line)[0] for line in declared]
    assert {"numpy", "babel"} <= set(names)
    for name in (*names, "templates", "fonts", "PDF"):
        assert re.search(rf"^(ok|missing)\s+{name}: ", done.output, re.MULTILINE | re.IGNORECASE), name
    assert "pytest" not in done.output


@pytest.mark.parametrize(
    ("one", "works", "detail"),
    [
        (Requirement("typer", "0.1", ""), True, version("typer")),
        (Requirement("typer", "999.1", ""), False, f'{version("typer")} is too old: pip install "typer>=999.1"'),
        (Requirement("no-such", "2.0", ""), False, 'not installed: pip install "no-such>=2.0"'),
        (Requirement("no-such", "", "maps"), True, f"optional, not installed. {say_install('maps')}"),
        (Requirement("typer", "", "maps"), True, f"{version('typer')} (optional: maps)"),
    ],
)
def test_doctor_says_how_to_fix_it(one, works, detail):
    found = command_doctor.examine_package(one)
    assert (found.works, found.detail) == (works, detail)


def test_doctor_reads_the_project_file_where_assess_is_not_installed(monkeypatch):
    def fail(name):
        raise PackageNotFoundError(name)

    installed = {(one.name.lower(), one.least, one.extra) for one in command_doctor.list_requirements()}
    monkeypatch.setattr("importlib.metadata.requires", fail)
    read = {(one.name.lower(), one.least, one.extra) for one in command_doctor.list_requirements()}
    assert ("weasyprint", "") in {(name, extra) for name, _, extra in read}
    assert {name for name, _, _ in read} == {name for name, _, _ in installed}
    assert {("duckdb", "parquet"), ("distributed", "cluster")} <= {(name, extra) for name, _, extra in read}
    assert len(read) == len({name for name, _, _ in read}), "a package that two extras need is there once"


def test_versions_are_compared_by_their_numbers():
    found = [command_doctor._numbers(text) for text in ("2.10.0rc1", "70.0", "10", "")]
    assert found == [(2, 10), (70,), (10,), ()]
