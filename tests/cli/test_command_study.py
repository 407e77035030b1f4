"""`assess study`: its files, what it prints, how it ends, and bad input, which names the fix and writes nothing."""

import csv
import os
import signal
import subprocess
import sys

import pytest

from assess.errors import OutputError
from assess.resources import record
from assess.studies import PAGE, PARTS, Finding, Options, Study, all_studies, check_folder, run_study, write_files
from assess.studies.study import load_or_compute
from tests.cli.calling import run
from tests.waiting import PATIENCE

NAMES = ["table1", "solver", "table2", "calibration", "contours", "table3", "fit"]


def study(*words):
    return run("study", *words)


def made_up(name, order=1, takes=(), of=lambda _: Finding(page=["a page"], summary=["a sentence"])):
    return Study(name=name, order=order, title=f"Of {name}", of="section 1", run=of, takes=frozenset(takes))


@pytest.fixture
def two(monkeypatch):
    """Two studies that are done at once, in place of those of the paper."""
    import assess.studies

    def tell(name):
        return lambda options: Finding(page=[f"{options.breadth:g}"], summary=[f"{name} came out", f"{name} twice"])

    studies = made_up("first", 1, {"records", "breadth"}, tell("first")), made_up("second", 2, of=tell("second"))
    monkeypatch.setattr(assess.studies, "all_studies", lambda: studies)


def test_all_studies_are_there_with_what_they_take():
    assert [one.name for one in all_studies()] == NAMES
    assert {one.name for one in all_studies() if not one.of} == {"calibration"}, "it repeats no part of the paper"
    assert all(one.title for one in all_studies())
    taken = {one.name: one.takes for one in all_studies() if one.takes}
    assert taken == {"table1": {"records", "breadth", "height"}, "table2": {"breadth", "height"}}


# ---------------------------------------------------------------- files


@pytest.mark.slow
def test_a_study_writes_its_page_tables_and_figure(tmp_path):
    found = study("table3", "--out", tmp_path / "out")
    assert found.exit_code == 0
    files = {file.name for file in (tmp_path / "out").iterdir()}
    assert files == {"table3.md", "table3.csv", "table3-methods.csv", "table3-printed.csv", "table3.svg"}
    page = (tmp_path / "out" / "table3.md").read_text(encoding="utf-8")
    assert page.startswith("# Formulas against shaking-table tests\n")
    assert "](table3.svg)" in page
    with (tmp_path / "out" / "table3.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert {row["sample"] for row in rows} >= {"AL1", "IB4"}
    assert "27 printed OR" in found.stdout
    assert found.stderr.endswith(f"wrote {tmp_path / 'out' / 'table3.md'}\n")


@pytest.mark.slow
def test_the_same_again_gives_the_same_bytes(tmp_path):
    for name in ("one", "other"):
        assert study("table1", "--out", tmp_path / name).exit_code == 0
    one, other = ({file.name: file.read_bytes() for file in (tmp_path / name).iterdir()} for name in ("one", "other"))
    assert one == other


@pytest.mark.usefixtures("two")
def test_all_of_them_have_one_page(tmp_path):
    found = study("all", "--out", tmp_path, "--breadth", "30")
    assert found.exit_code == 0
    assert found.stdout.splitlines() == ["first came out", "first twice", "second came out", "second twice"]
    assert {file.name for file in tmp_path.iterdir()} == {"first.md", "second.md", PAGE}
    assert found.stderr == f"wrote {tmp_path / PAGE}\n"
    assert "0.3" in (tmp_path / "first.md").read_text(encoding="utf-8").split()


@pytest.mark.usefixtures("two")
def test_names_are_taken_in_any_case_and_what_is_kept_is_told(tmp_path):
    assert [study(name, "--out", tmp_path).exit_code for name in ("FIRST", "All")] == [0, 0]
    assert (tmp_path / PAGE).is_file()
    (tmp_path / PARTS).mkdir()
    found = study("second", "--out", tmp_path)
    assert f"second.md; {tmp_path / PARTS} keeps the long integrations for the next run" in found.stderr


def test_files_appear_whole_or_not_at_all(tmp_path):
    """One of them cannot be written, or a later study fails: what was there is left."""
    write_files(tmp_path, {"a.csv": b"old", "inside/b.svg": b"old"})
    (tmp_path / "c.md").mkdir()
    with pytest.raises(OutputError, match=r"c\.md could not be written: it is a folder\. Move it away\."):
        write_files(tmp_path, {"a.csv": b"new", "inside/b.svg": b"new", "c.md": b"new"})
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "inside" / "b.svg").read_bytes() == b"old"
    assert {file.name for file in tmp_path.iterdir()} == {"a.csv", "inside", "c.md"}

    def fail(_):
        raise ArithmeticError

    with pytest.raises(ArithmeticError):
        run_study(made_up("other", of=fail), Options(out=tmp_path / "other"))
    assert not (tmp_path / "other").exists()


def test_two_runs_in_one_folder_do_not_disturb_each_other(tmp_path):
    """Each has written when the other begins to: neither finds a folder or a file of the other's gone."""

    def meanwhile(options):
        run_study(made_up("inner"), options)
        return Finding(page=["a page"])

    run_study(made_up("outer", of=meanwhile), Options(out=tmp_path))
    assert {file.name for file in tmp_path.iterdir()} == {"inner.md", "outer.md"}


@pytest.mark.slow
def test_two_commands_at_once_in_a_new_folder(tmp_path):
    runs = [_start("study", name, "--out", tmp_path / "out") for name in ("table1", "table3")]
    assert [one.wait(120) for one in runs] == [0, 0]
    assert {"table1.md", "table1.svg", "table3.md", "table3.svg"} <= {one.name for one in (tmp_path / "out").iterdir()}
    assert not list((tmp_path / "out").glob(".assess-writing-*"))


# ---------------------------------------------------------------- bad input


@pytest.mark.parametrize("below", ["", "further/down"])
def test_a_file_in_place_of_the_folder_is_told_before_the_work(tmp_path, monkeypatch, below):
    import assess.studies

    monkeypatch.setattr(assess.studies, "all_studies", lambda: (made_up("long", of=lambda _: pytest.fail("worked")),))
    (tmp_path / "out").write_text("mine", encoding="utf-8")
    found = study("long", "--out", tmp_path / "out" / below)
    assert found.exit_code == 1
    assert "could not be written" in found.stderr
    assert "Make room, or name another folder" in found.stderr
    assert (tmp_path / "out").read_text(encoding="utf-8") == "mine"
    assert len(list(tmp_path.iterdir())) == 1


def test_looking_whether_a_folder_can_be_written_to_leaves_nothing_and_a_full_disk_is_told(tmp_path, monkeypatch):
    check_folder(tmp_path / "new" / "and" / "more")
    assert not list(tmp_path.iterdir())

    def refuse(*_args, **_more):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("tempfile.mkdtemp", refuse)
    with pytest.raises(OutputError, match=r"new could not be written: Permission denied\."):
        check_folder(tmp_path / "new")

    def fail(*_args, **_more):
        raise OSError(28, "No space left on device")

    monkeypatch.undo()
    monkeypatch.setattr("os.fsync", fail)
    with pytest.raises(OutputError, match=r"No space left on device\. Make room, or name another folder"):
        load_or_compute(tmp_path / PARTS, "one", dict)
    assert list(tmp_path.iterdir()) == []


# ---------------------------------------------------------------- records of one's own


@pytest.mark.slow
def test_a_folder_of_records_has_a_table_of_its_own(tmp_path, monkeypatch):
    """The folder in which one stands, with our own files in it: their folder is none of the records, run by run."""
    folder = tmp_path / "my records"
    folder.mkdir()
    (folder / "alhambra.smc").write_bytes(record("0165a_u.smc").read_bytes())
    monkeypatch.chdir(folder)
    for _ in range(2):
        found = study("table1", "--records", ".", "--out", "studies")
        assert found.exit_code == 0
        with (folder / "studies" / "table1-records.csv").open(encoding="utf-8") as file:
            (row,) = csv.DictReader(file)
        assert row["record"] == "alhambra.smc"
        assert not (folder / "studies" / "table1-records-left-out.csv").exists()
        assert "(folder `my records`," in (folder / "studies" / "table1.md").read_text(encoding="utf-8")


# ---------------------------------------------------------------- how it ends

SLOW = """
import sys, time
import assess.studies as studies
import numpy as np
from assess.studies.study import PARTS, load_or_compute
from assess.cli.app import app

def work(options):
    if {keeps}:
        load_or_compute(options.out / PARTS, "one", lambda: {{"one": np.ones(2)}})
    print("begun", flush=True)
    time.sleep(60)

own = studies.Study(name="slow", order=1, title="Slow", of="none", run=work)
studies.all_studies = lambda: (own,)
app(["study", "slow", "--out", sys.argv[1]])
"""


def _start(*words, **more):
    return subprocess.Popen([sys.executable, "-m", "assess", *map(str, words)], stderr=subprocess.DEVNULL, **more)


@pytest.mark.skipif(os.name == "nt", reason="no signals to send")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("keeps", [True, False])
def test_a_run_that_is_interrupted_says_where_it_goes_on(tmp_path, number, keeps):
    words = [sys.executable, "-c", SLOW.format(keeps=keeps), str(tmp_path / "out")]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as run:
        assert run.stdout.readline() == "begun\n"
        run.send_signal(number)
        _, told = run.communicate(timeout=PATIENCE)
    assert run.returncode == 128 + number
    assert "Traceback" not in told
    parts = tmp_path / "out" / PARTS
    if keeps:
        assert f"Interrupted; finished parts are kept in {parts}; the same command continues from there." in told
        assert [file.suffix for file in parts.iterdir()] == [".npz"]
    else:
        assert "Interrupted; nothing was written." in told
        assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_a_request_to_end_is_as_before_afterwards(tmp_path):
    before = signal.getsignal(signal.SIGTERM)
    assert study("table3", "--out", tmp_path).exit_code == 0
    assert signal.getsignal(signal.SIGTERM) is before
