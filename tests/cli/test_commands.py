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
from assess.environment import say_install
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


def test_version_and_help_load_nothing_heavy():
    """Nor does any file of a command, when it is found."""
    assert run(app, ["--version"]).output == f"assess {assess.__version__}\n"
    heavy = ("numpy", "scipy", "numba", "openpyxl", "jinja2", "matplotlib", "babel", "assess.studies", "assess.report")
    code = (
        "import sys\nsys.argv = ['assess', '--help']\nfrom assess.cli.app import main\n"
        f"try:\n    main()\nexcept SystemExit:\n    print([name for name in {heavy!r} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert done.stdout.splitlines()[-1] == "[]", done.stderr


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


def test_scale_and_ideal_reach_the_settings(tmp_path, monkeypatch):
    given = []

    def stop(inventory, settings, **_):
        given.append(settings)
        raise assess.InputError("seen")

    monkeypatch.setattr("assess.pipeline.run.run", stop)
    path = write(tmp_path / "w.xlsx")
    for words in ("", "--scale=0.9 --ideal", "--verify=high --route-risk=0.2", "--scale=60%"):
        assert run(app, ["run", str(path), "--out", str(tmp_path / "out"), *words.split()]).exit_code == 2
    assert [(one.verify, one.scale, one.ideal, one.route_risk) for one in given] == [
        ("all", 1.0, False, 0.03), ("all", 0.9, True, 0.03), ("high", 1.0, False, 0.2), ("all", 0.6, False, 0.03),
    ]  # fmt: skip


def test_numbers_with_more_digits_than_are_read_are_refused_and_scenarios_accepted_in_any_spelling(tmp_path):
    done = run(app, ["run", str(write(tmp_path / "w.xlsx")), "--runs", "9" * 5000, "--out", str(tmp_path / "out")])
    assert (done.exit_code, "--runs is '999" in done.stderr) == (2, True)
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


def test_doctor_says_how_to_fix_it():
    for one, works, detail in (
        (Requirement("typer", "0.1", ""), True, version("typer")),
        (Requirement("typer", "0.3", ""), True, version("typer")),  # of 0.27, by the numbers
        (Requirement("typer", "999.1", ""), False, f'{version("typer")} is too old: pip install "typer>=999.1"'),
        (Requirement("no-such", "2.0", ""), False, 'not installed: pip install "no-such>=2.0"'),
        (Requirement("no-such", "", "maps"), True, f"optional, not installed. {say_install('maps')}"),
        (Requirement("typer", "", "maps"), True, f"{version('typer')} (optional: maps)"),
    ):
        found = command_doctor.examine_package(one)
        assert (found.works, found.detail) == (works, detail), one


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
