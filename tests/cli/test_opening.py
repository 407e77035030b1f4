"""``assess run --open``: a program that stands for the browser records what it is given."""

import os
import subprocess
import sys
import webbrowser
from pathlib import Path

import pytest

from assess.cli.console import open_file
from tests.workbooks import write

pytestmark = pytest.mark.skipif(os.name == "nt", reason="the program that stands for the browser is a shell script")


@pytest.fixture
def browser(tmp_path):
    """A program that writes its arguments to a file beside it."""
    program = tmp_path / "browser"
    program.write_text(f'#!/bin/sh\nprintf "%s\\n" "$@" >> "{tmp_path}/opened"\n', encoding="utf-8")
    program.chmod(0o755)
    return program


def run_open(folder, formats, **variables):
    """Run the command in a process of its own, with nothing in the environment that tells of a display."""
    words = ("run", write(folder / "my w.xlsx"), "--verify", "none", "--formats", formats, "--out", folder / "a b")
    hidden = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")
    environment = {name: value for name, value in os.environ.items() if name not in hidden} | variables
    return subprocess.run(
        [sys.executable, "-m", "assess", *map(str, words), "--open"],
        capture_output=True, text=True, env=environment, timeout=120, check=False,
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
    ("formats", "opened"),
    [("json,csv,xlsx", "report.xlsx"), pytest.param("json,html,xlsx", "report.html", marks=pytest.mark.long)],
)
def test_the_report_is_opened_in_the_browser(tmp_path, browser, formats, opened):
    done = run_open(tmp_path, formats, BROWSER=str(browser))
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "opened").read_text(encoding="utf-8") == f"{(tmp_path / 'a b' / opened).as_uri()}\n"
    assert done.stderr.splitlines()[-1].startswith("wrote ")


@pytest.mark.skipif(sys.platform == "darwin", reason="always has a display")
@pytest.mark.slow
def test_away_from_a_display_one_line_says_where_the_report_is(tmp_path):
    done = run_open(tmp_path, "json,xlsx")
    report = tmp_path / "a b" / "report.xlsx"
    assert (done.returncode, report.is_file()) == (0, True)
    assert done.stderr.splitlines()[-1] == f"There is no display here. The report is {report}"


@pytest.mark.parametrize("fault", [webbrowser.Error("none"), OSError("not found"), False])
def test_a_browser_that_does_not_start_is_no_error(monkeypatch, fault):
    def fail(_address):
        if isinstance(fault, Exception):
            raise fault
        return fault

    monkeypatch.setenv("BROWSER", "any")
    monkeypatch.setattr(webbrowser, "open", fail)
    report = Path("report.html").resolve()
    assert open_file(Path("report.html")) == f"No browser could be started. The report is {report}"
