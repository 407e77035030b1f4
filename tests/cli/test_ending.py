"""Blank words, names that are too long, dates that are none, outputs that cannot be written: one line, and a status."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import assess
from assess.cli.app import find_blank
from assess.environment import say_install
from assess.errors import InputError
from assess.report.provenance import report_time
from tests.bim.export_runs import DUPLEX, write_results
from tests.cli.calling import run
from tests.shaking import write_records
from tests.waiting import PATIENCE
from tests.workbooks import write

LONG = "x" * 300
FULL = Path("/dev/full")
ROOT = {"PYTHONPATH": str(Path(assess.__file__).parents[1])}
needs_full = pytest.mark.skipif(not FULL.exists(), reason="the system has no device that is always full")


def call(folder, *words, out=subprocess.PIPE, err=subprocess.PIPE, **variables):
    """Call `assess` in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "assess", *map(str, words)], cwd=folder, stdout=out, stderr=err, text=True, timeout=300,
        env=os.environ | ROOT | variables, check=False,
    )  # fmt: skip


def one_line(done, status):
    """The message of a call that failed as it should."""
    text = done.stderr
    assert done.returncode == status, text
    assert "Traceback" not in text
    last = text.splitlines()[-1]
    assert [line for line in text.splitlines() if not line.startswith(("warning", "note", "Working"))] == [last]
    return last


# ---------------------------------------------------------------- names


def test_names_that_are_too_long(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "book.xlsx")
    for words in (
        ("run", "book.xlsx", "--out", LONG), ("run", "book.xlsx", "--out", f"{LONG}/inner"), ("run", f"{LONG}.xlsx"),
        ("check", f"{LONG}.xlsx"), ("new", f"{LONG}.xlsx"), ("run", "book.xlsx", "--motions", LONG),
        ("run", "book.xlsx", "--template", LONG), ("run", "book.xlsx", "--method", LONG), ("record", LONG),
        ("fragility", "book.xlsx", "--out", LONG), ("routes", "book.xlsx", "--plot", f"{LONG}.png"),
        ("check", "book.xlsx", "--fix", f"{LONG}.xlsx"), ("study", "table1", "--out", LONG),
    ):  # fmt: skip
        done = run(*words)
        assert done.exit_code == (1 if "study" in words else 2), words
        assert isinstance(done.exception, SystemExit)
        assert "xxxxx" in done.stderr
        assert [one.name for one in tmp_path.iterdir()] == ["book.xlsx"]


def test_blank_words(tmp_path):
    for words, named in (
        (["run", "a.xlsx", "--out", ""], "--out"), (["run", "a.xlsx", "--motions="], "--motions"),
        (["run", "a.xlsx", "--template", " "], "--template"), (["check", " "], "word 2"),
        (["run", "a.xlsx", "--out", "b"], None), (["study", "fit", "--", ""], None), ([], None),
    ):  # fmt: skip
        found = find_blank(words)
        assert found == named or (named and found.startswith(named))
    write(tmp_path / "book.xlsx")
    text = one_line(call(tmp_path, "run", "book.xlsx", "--verify", "none", "--out="), 2)
    assert text == "error  --out is blank: fill it in, or leave it out."
    assert [one.name for one in tmp_path.iterdir()] == ["book.xlsx"]


@pytest.mark.parametrize(
    ("module", "words", "status", "said"),
    [
        ("ifcopenshell", "export . --ifc model.ifc -o new.ifc", 2, "need the library ifcopenshell. Install it"),
        ("uvicorn", "open", 1, f"error  the page needs uvicorn, which is not installed. {say_install('web')}"),
    ],
)
def test_without_an_extra_one_line_tells_what_to_install(tmp_path, module, words, status, said):
    write_results(tmp_path)
    (tmp_path / "model.ifc").write_bytes(DUPLEX.read_bytes())
    code = f"import sys\nsys.modules[{module!r}] = None\nfrom assess.__main__ import main\nmain()"
    command = [sys.executable, "-c", code, *words.split()]
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, cwd=tmp_path, timeout=PATIENCE, env=os.environ | ROOT
    )
    assert said in one_line(done, status)
    assert done.stdout == ""
    assert not (tmp_path / "new.ifc").exists()


# ---------------------------------------------------------------- the date


def test_a_date_that_is_none_is_refused_before_the_work(tmp_path, monkeypatch):
    for date in ("abc", "-1", " ", "1e5", "9" * 30, "253402300800", "²", "1.5", "\x1b[31m"):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", date)
        with pytest.raises(InputError, match=r"SOURCE_DATE_EPOCH is '.*', expected seconds since 1970, 0 to 25340230"):
            report_time()
    done = run("run", write(tmp_path / "book.xlsx"), "--out", tmp_path / "out")
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr.startswith("error  the environment variable SOURCE_DATE_EPOCH is '")
    assert (done.stderr.count("\n"), "\x1b" in done.stderr) == (1, False)
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_dates(tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "")
    assert report_time().year >= 2025
    path = write(tmp_path / "b.xlsx")
    for date, year in (("1700000000", 2023), ("0", 1970), ("253402300799", 9999)):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", date)
        assert report_time().year == year
        done = run("run", path, "--verify", "none", "--formats", "html,xlsx,json", "--out", tmp_path / date)
        assert done.exit_code == 0, done.output
        assert str(year) in (tmp_path / date / "report.html").read_text(encoding="utf-8")


# ---------------------------------------------------------------- outputs


@needs_full
@pytest.mark.slow
def test_an_output_that_is_full(tmp_path):
    write_records(tmp_path, "fast")
    write(tmp_path / "book.xlsx")
    with FULL.open("w") as full:
        for words in (("check", "book.xlsx"), ("run", "--help"), ("--version",), ("record", "fast.csv", "--json")):
            done = call(tmp_path, *words, out=full)
            assert one_line(done, 1) == "error  the output could not be written: No space left on device."
        assert call(tmp_path, "methods", out=full, err=full).returncode == 1
        assert call(tmp_path, "check", "missing.xlsx", err=full).returncode == 1


@pytest.mark.slow
def test_a_reader_that_leaves(tmp_path):
    """As head does, or a pager that is left."""
    write(tmp_path / "book.xlsx")
    for words in (("check", "book.xlsx"), ("methods",), ("--help",)):
        reading, writing = os.pipe()
        os.close(reading)
        done = call(tmp_path, *words, out=writing)
        os.close(writing)
        assert (done.returncode, [line for line in done.stderr.splitlines() if "warning" not in line]) == (1, [])


@pytest.mark.skipif(sys.platform == "win32", reason="no shell")
def test_an_output_that_is_closed(tmp_path):
    write(tmp_path / "book.xlsx")
    code = f'"{sys.executable}" -m assess check book.xlsx >&-'
    done = subprocess.run(
        ["/bin/sh", "-c", code], cwd=tmp_path, stderr=subprocess.PIPE, text=True, check=False, env=os.environ | ROOT
    )
    assert done.returncode == 0
    assert "Traceback" not in done.stderr
