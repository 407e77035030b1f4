"""Completion, asked for as shells do: a process with their variables, and bash with its own script."""

import json
import os
import shutil
import subprocess
import sys
from contextlib import redirect_stdout
from io import StringIO
from unittest.mock import patch

import pytest

from assess.cli import command_compare, command_fragility, command_portfolio
from assess.cli.app import ASKED, app, list_names
from assess.i18n import LANGUAGES
from assess.settings import SCENARIOS, VERIFY, Settings
from tests.waiting import PATIENCE

ASSESS = (sys.executable, "-m", "assess")
HEAVY = ("numpy", "scipy", "numba", "openpyxl", "jinja2", "matplotlib", "babel", "pandas", "assess.studies")


def ask(variables, *command):
    environment = {name: value for name, value in os.environ.items() if not name.startswith("_TYPER")} | variables
    done = subprocess.run(
        command or ASSESS, capture_output=True, text=True, env=environment, timeout=PATIENCE, check=False
    )
    assert done.stderr == ""
    return done.stdout


def complete(line):
    """Return what bash is offered for the last word of a line; it separates the words by newlines."""
    words = line.split(" ")
    told = {"COMP_WORDS": "\n".join(words), "COMP_CWORD": str(len(words) - 1), ASKED: "complete_bash"}
    with patch.dict(os.environ, told), redirect_stdout(StringIO()) as said, pytest.raises(SystemExit):
        app(prog_name="assess")
    return said.getvalue().split()


def test_all_commands_are_offered_and_a_scenario_is_understood_as_it_is_completed():
    assert sorted(complete("assess ")) == sorted(list_names())
    assert complete("assess r") == ["run", "routes", "rock", "record"]
    offered = complete("assess run --scenario ")
    assert [Settings(scenario=one).scenario for one in offered] == list(SCENARIOS)
    assert not any(" " in one for one in offered)


def test_options_and_values():
    for line, offered in (
        ("assess run b.xlsx --sc", ["--scale-motions", "--scenario", "--scale"]),
        ("assess run b.xlsx --open --o", ["--out"]),
        ("assess run b.xlsx --verify ", list(VERIFY)),
        ("assess run b.xlsx --runs ", ["auto"]),
        ("assess run b.xlsx --scenario ASCE", ["ASCE-7-22", "ASCE-7-16"]),
        ("assess routes b.xlsx --scenario en", ["en-1998-1"]),
        ("assess run b.xlsx --formats pdf,h", ["pdf,html"]),
        ("assess run b.xlsx --formats pdf,xlsx,html,json,",
         [f"pdf,xlsx,html,json,{one}" for one in ("annex", "work", "csv", "docx", "npz", "parquet", "all")]),
        ("assess new w.xlsx --language ", list(LANGUAGES)),
        ("assess new w.xlsx --units i", ["imperial"]),
        ("assess study t", ["table1", "table2", "table3"]),
        ("assess fragility b.xlsx --im ", ["pfa", "pfv"]),
        ("assess fragility b.xlsx --formats ", ["csv", "json", "pelicun", "nrml"]),
        ("assess rock --baseline ", ["standard", "none"]),
        ("assess run ", []),  # files are the shell's own
    ):  # fmt: skip
        assert complete(line) == offered, line


def test_the_formats_are_those_that_can_be_written():
    from assess.cli.fragility_output import FORMATS
    from assess.compare import comparison_files
    from assess.portfolio import run_portfolio

    assert set(command_fragility.KNOWN) == set(FORMATS) > set(command_fragility.DEFAULT.split(","))
    assert command_portfolio.FORMATS == run_portfolio.FORMATS
    assert (*comparison_files.FORMATS, "json") == command_compare.FORMATS


def test_zsh_fish_and_powershell_get_help_whole_on_one_line():
    line = {"_TYPER_COMPLETE_ARGS": "assess run b.xlsx --sce"}
    zsh = ask(line | {ASKED: "complete_zsh"})
    assert '"--scenario":"Source of the floor motion' in zsh
    assert "NTC 2018" in zsh
    fish = ask(line | {ASKED: "complete_fish", "_TYPER_COMPLETE_FISH_ACTION": "get-args"})
    (offered,) = fish.splitlines()
    assert offered.startswith("--scenario\tSource")
    assert "NTC 2018" in offered
    line = {"_TYPER_COMPLETE_ARGS": "assess run b.xlsx --open --ver", "_TYPER_COMPLETE_WORD_TO_COMPLETE": "--ver"}
    (offered,) = ask(line | {ASKED: "complete_powershell"}).splitlines()
    assert offered.startswith("--verify:::Pieces to simulate")


@pytest.mark.parametrize("words", [["assess", ""], ["assess", "run", "--formats", ""], ["assess", "study", ""]])
def test_nothing_heavy_is_loaded_and_only_the_command_that_is_typed(words):
    code = (
        "import sys, os\nsys.argv = ['assess']\nfrom assess.cli.app import main\n"
        "try:\n    main()\nexcept SystemExit:\n    import json\n    print()\n"
        f"    print(json.dumps([[name for name in {HEAVY!r} if name in sys.modules], "
        "[name[19:] for name in sys.modules if name.startswith('assess.cli.command_')]]))"
    )
    told = {"COMP_WORDS": "\n".join(words), "COMP_CWORD": str(len(words) - 1), ASKED: "complete_bash"}
    heavy, commands = json.loads(ask(told, sys.executable, "-c", code).splitlines()[-1])
    assert heavy == []
    assert sorted(commands) == (sorted(list_names()) if words[1] == "" else [words[1]])


BASH = """
eval "$(assess --show-completion)"
COMP_WORDS=(assess run "'my building.xlsx'" --formats html,pd) COMP_CWORD=4
$(complete -p assess | sed 's/.*-F \\([^ ]*\\).*/\\1/') assess
printf '%s\\n' "${COMPREPLY[@]}"
"""


@pytest.mark.skipif(shutil.which("bash") is None or os.name == "nt", reason="bash is not installed")
def test_bash_completes_with_the_script_that_it_is_given(tmp_path):
    program = tmp_path / "assess"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m assess "$@"\n', encoding="utf-8")
    program.chmod(0o755)
    path = f"{tmp_path}{os.pathsep}{os.environ['PATH']}"
    assert ask({"PATH": path}, "bash", "--norc", "-c", BASH).split() == ["html,pdf"]
    assert "bash completion installed" in ask(
        {"PATH": path, "HOME": str(tmp_path)}, "bash", "--norc", "-c", "assess --install-completion; true"
    )
    assert (tmp_path / ".bash_completions" / "assess.sh").is_file()
    assert "assess.sh" in (tmp_path / ".bashrc").read_text(encoding="utf-8")
