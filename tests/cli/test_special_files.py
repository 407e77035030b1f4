"""Names and files that are no plain ones: pipes, devices, names that are not UTF-8 or hold commands to a terminal."""

import json
import os
import shutil
import sys

import pytest

from tests.cli.calling import error, run
from tests.workbooks import write

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="such files and names are those of Unix")

SAID = "it is a pipe or a device, not a file"


@pytest.fixture
def place(tmp_path, monkeypatch):
    """Stand in a folder with a workbook, a pipe and a device that never ends, each under the endings that are read."""
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "w.xlsx")
    for ending in ("ifc", "csv", "json", "xlsx", "xml"):
        os.mkfifo(f"pipe.{ending}")
        (tmp_path / f"zero.{ending}").symlink_to("/dev/zero")
    return tmp_path


def test_what_is_no_file_is_refused_at_once(place):
    for words in (
        ("check", "{}.xlsx"), ("run", "{}.xlsx"), ("record", "{}.csv"), ("import", "{}.ifc", "-o", "new.xlsx"),
        ("import", "{}.json", "-o", "new.xlsx"), ("import", "{}.xlsx", "-o", "new.xlsx"),
        ("rock", "--breadth", 40, "--height", 180, "--record", "{}.csv"),
        ("run", "w.xlsx", "--shakemap", "{}.xml"), ("compare", "{}.json", "w.json"), ("portfolio", "{}.csv"),
    ):  # fmt: skip
        for name in ("pipe", "zero"):
            assert SAID in error(run(*(str(word).format(name) for word in words))), words
            assert not (place / "new.xlsx").exists()


def test_names_that_are_not_utf_8_are_shown_as_far_as_they_can_be_and_command_no_terminal(place):
    name = os.fsdecode(b"b\xff\xfe.xlsx")
    shutil.copy("w.xlsx", name)
    done = run("run", name, "--verify", "none", "--formats", "json,xlsx,html,csv", "--out", "out")
    assert done.exit_code == 0, done.output
    found = json.loads((place / "out" / "results.json").read_bytes())
    assert found["assess"]["inputs"]["workbook"] == "b\ufffd\ufffd.xlsx"
    name = "a\x1b]0;PWN\x07.xlsx"
    shutil.copy("w.xlsx", name)
    for words in (("run", name, "--verify", "none", "--formats", "json"), ("check", name, "--fix", "b\x1b[2J.xlsx")):
        done = run(*words)
        assert done.exit_code == 0, done.output
        assert "\x1b" not in done.output
