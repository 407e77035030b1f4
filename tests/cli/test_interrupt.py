"""Ctrl-C and SIGTERM: the command ends soon, with exit status 130 or 143, and leaves everything as it was."""

import os
import shutil
import signal
import subprocess
import sys
import threading
import time

import pytest

from assess.cli import console
from assess.errors import CancelledError
from assess.methods import Cases
from assess.methods.housner_monte_carlo import evaluate
from assess.progress import SILENT
from assess.settings import Settings
from tests.methods.ensembles import MadeUp
from tests.waiting import PATIENCE
from tests.workbooks import write

FLOORS = [{"floor": str(at), "pfa_x": 0.1 + 0.05 * at, "pfa_y": 0.2} for at in range(1, 5)]
ITEMS = [
    {"item": f"{floor['floor']} {breadth}", "floor": floor["floor"], "breadth": breadth, "height": 180}
    for floor in FLOORS
    for breadth in range(25, 85)
]
HEAD = "import os, signal, sys, time\nfrom assess.cli import console, interrupts\n"


@pytest.mark.parametrize("jobs", [1, 2])
@pytest.mark.slow
def test_an_interrupted_verification_leaves_all_as_it_was(tmp_path, jobs):
    path, out = write(tmp_path / "w.xlsx", ITEMS, FLOORS), tmp_path / "out"
    out.mkdir()
    (out / "mine.txt").write_text("old", encoding="utf-8")
    words = ["assess", "run", str(path), "--verify", "all", "--runs", "auto", "--jobs", str(jobs), "--out", str(out)]
    # what a shell's foreground job has: a background one ignores the signal
    code = (
        f"import signal, sys\nsignal.signal(signal.SIGINT, signal.default_int_handler)\nsys.argv = {words!r}\n"
        "from assess.cli import console\nconsole.QUIET = 0\nfrom assess.cli.app import main\nmain()"
    )
    command = [sys.executable, "-c", code]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert "Simulating 240 rows on 4 floors: 0 %\n" in process.stderr
        process.send_signal(signal.SIGINT)
        try:
            printed, errors = process.communicate(timeout=PATIENCE)
        finally:
            process.kill()
    assert process.returncode == 130
    assert printed == ""
    assert errors.endswith("\nInterrupted; nothing was written.\n")
    assert "Traceback" not in errors
    assert [file.name for file in out.iterdir()] == ["mine.txt"]
    assert (out / "mine.txt").read_text(encoding="utf-8") == "old"


def _interrupt(number, work):
    """Interrupt `work` as its first act; return the progress that it was given."""
    with console.show_progress() as progress:
        os.kill(os.getpid(), number)
        work(progress)
    return progress


@pytest.mark.skipif(os.name == "nt", reason="no signals to send")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_cancels_the_work_and_interrupts_work_that_goes_on(number):
    before = [signal.getsignal(one) for one in (signal.SIGINT, signal.SIGTERM)]
    assert _interrupt(number, lambda _: None).is_cancelled
    with pytest.raises(CancelledError):
        _interrupt(number, lambda progress: progress.check())
    with pytest.raises(KeyboardInterrupt):
        _interrupt(number, lambda _: time.sleep(PATIENCE))
    assert [signal.getsignal(one) for one in (signal.SIGINT, signal.SIGTERM)] == before


@pytest.mark.skipif(os.name == "nt", reason="no signals to send")
def test_a_signal_that_is_ignored_stays_ignored():
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with console.show_progress() as progress:
            os.kill(os.getpid(), signal.SIGINT)
            assert not progress.is_cancelled
    finally:
        signal.signal(signal.SIGINT, before)


# ---------------------------------------------------------------- at any moment

AT = """
import atexit, os, runpy, signal, sys
number, at, sys.argv = int(sys.argv[1]), int(sys.argv[2]), sys.argv[2:]
seen = 0

def interrupt(event, arguments):
    global seen
    if event in EVENTS:
        seen += 1
        if seen == at:
            os.kill(os.getpid(), number)

signal.signal(signal.SIGINT, signal.default_int_handler)
from assess.cli.interrupts import answer_signals
answer_signals()
sys.addaudithook(interrupt)
atexit.register(lambda: print(seen))
runpy.run_module("assess", run_name="__main__", alter_sys=True)
"""
"""The command in a process that sends itself a signal at the n-th event of the interpreter."""


def _interrupted_at(at, events, number, folder, *words):
    """Run the command with a signal at an event; return its status, its errors, and how many events there were."""
    (folder / "tmp").mkdir(exist_ok=True)
    code = AT.replace("EVENTS", repr(events))
    done = subprocess.run(  # Python moves files as well where it keeps what it compiled
        [sys.executable, "-B", "-c", code, str(int(number)), str(at), *map(str, words)],
        env=os.environ | {"TMPDIR": str(folder / "tmp"), "MPLCONFIGDIR": str(folder)},
        cwd=folder, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert "Traceback" not in done.stderr
    assert list((folder / "tmp").iterdir()) == []
    assert not [path.name for path in folder.rglob(".assess*")]
    return done.returncode, done.stderr, int(done.stdout.split()[-1]) if done.returncode == 0 else 0


def _check(found, number, old, now, new):
    """Hold what is left against the exit status."""
    status, errors, _ = found
    if status == 0:
        assert now == new
    else:
        assert status == 128 + number
        last = "what was written before is complete" if now == new else "nothing was written"
        assert errors.endswith(f"\nInterrupted; {last}.\n")
        assert now in (old, new)


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="no signals to send")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_during_any_import_or_file_operation_leaves_nothing_behind(tmp_path, number):
    """From the first import to the last file, at twenty of the events."""
    book, out = write(tmp_path / "w.xlsx"), tmp_path / "out"
    words = ("run", book.name, "--verify", "none", "--formats", "html,xlsx,csv", "--out", "out")
    events, statuses = ("import", "open", "os.rename", "os.mkdir", "os.rmdir", "os.remove"), set()
    count = _interrupted_at(0, events, number, tmp_path, *words)[2]
    for at in range(1, count, count // 20):
        shutil.rmtree(out, ignore_errors=True)
        found = _interrupted_at(at, events, number, tmp_path, *words)
        now = sorted(path.name for path in out.iterdir()) if out.is_dir() else []
        _check(found, number, [], now, ["items.csv", "report.html", "report.xlsx", "results.json"])
        statuses.add(found[0])
    assert 128 + number in statuses


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="no signals to send")
@pytest.mark.parametrize(
    ("number", "first"), [pytest.param(signal.SIGINT, 0.0, marks=pytest.mark.long), (signal.SIGTERM, 0.2)]
)
def test_a_signal_at_any_time_leaves_nothing_behind(tmp_path, number, first):
    """Sent from outside, to all of the command: its threads, the process that lays the PDF out.

    Python's own start, before the first line of the program, is left out: it answers Ctrl-C by a traceback of its own.
    """
    book = write(tmp_path / "w.xlsx")
    (tmp_path / "tmp").mkdir()
    words = [sys.executable, *f"-v -m assess run {book.name} --runs 20 --formats pdf,csv --out out".split()]
    for moment in [*(0.4 * at + first for at in range(5)), *(2 + first + 2 * at for at in range(4))]:
        with subprocess.Popen(
            words, cwd=tmp_path, env=os.environ | {"TMPDIR": str(tmp_path / "tmp")}, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, text=True,
        ) as process:  # fmt: skip
            assert any("assess/cli/interrupts.py" in line for line in process.stderr)  # -v: what is imported
            time.sleep(moment)
            process.send_signal(number)
            _, errors = process.communicate(timeout=PATIENCE)
        assert "Traceback" not in errors, moment
        assert process.returncode in (0, -number, 128 + number)
        assert sorted(path.name for path in tmp_path.iterdir()) in (["tmp", "w.xlsx"], ["out", "tmp", "w.xlsx"])
        assert not list(tmp_path.rglob(".assess*"))
        assert list((tmp_path / "tmp").iterdir()) == []
        if process.returncode == 0:
            break


@pytest.mark.skipif(os.name == "nt", reason="no signals to send")
@pytest.mark.parametrize(
    ("number", "event", "at"),
    [(signal.SIGINT, "import", 1), (signal.SIGTERM, "import", 3), (signal.SIGTERM, "os.rename", 1)],
)
def test_a_signal_at_the_first_imports_or_moves(tmp_path, number, event, at):
    """Before the work nothing is written; while files are moved the signal waits, and comes too late."""
    out = tmp_path / "out"
    out.mkdir()
    (out / "mine.txt").write_text("mine")
    book = write(tmp_path / "w.xlsx")
    words = ("run", book.name, "--verify", "none", "--formats", "csv", "--out", "out")
    found = _interrupted_at(at, (event,), number, tmp_path, *words)
    now = sorted(path.name for path in out.iterdir())
    _check(found, number, ["mine.txt"], now, ["items.csv", "mine.txt", "results.json"])
    assert found[0] == (0 if event == "os.rename" else 128 + number)


def _run_code(code, *words):
    """Return exit status and stderr of a process that runs some code; the code sends the signal."""
    command = [sys.executable, "-c", HEAD + code, *words]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)
    return done.returncode, done.stderr


@pytest.mark.skipif(os.name == "nt", reason="no signals to send")
def test_what_an_interrupt_became_is_no_error_and_work_that_swallows_every_one_is_ended(tmp_path):
    """An import that is interrupted may raise ImportError, a compiled library anything."""
    code = (
        "interrupts.answer_signals()\n"
        "def command():\n"
        "    with console.show_progress():\n"
        "        try:\n"
        "            os.kill(os.getpid(), signal.SIGTERM)\n"
        "            time.sleep(60)\n"
        "        except KeyboardInterrupt:\n"
        "            raise ImportError('numpy is partially initialised') from None\n"
        "console.guard(command)()"
    )
    assert _run_code(code) == (143, "\nInterrupted; nothing was written.\n")
    code = (
        "from pathlib import Path\n"
        "from assess.delivery.folders import make_folder\n"
        "interrupts.PATIENCE = interrupts.CLEANING = 0.05\n"
        "interrupts.answer_signals()\n"
        "make_folder(Path(sys.argv[1]), 'left-')\n"
        "with console.show_progress():\n"
        "    os.kill(os.getpid(), signal.SIGTERM)\n"
        "    while True:\n"
        "        try:\n"
        "            time.sleep(60)\n"
        "        except KeyboardInterrupt:\n"
        "            pass\n"
    )
    assert _run_code(code, tmp_path) == (143, "\nInterrupted; nothing was written.\n")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("threads", "count"), [(1, 1), (2, 3)])
def test_nothing_is_compiled_in_the_thread_that_hears_ctrl_c(threads, count):
    """In the middle of a compilation the exception would end up in the compiler's own code, and be lost."""

    class Watched(MadeUp):
        def open(self, threads, progress=SILENT):
            assert threading.current_thread() is not threading.main_thread()
            return MadeUp.open(self, threads, progress)

    ensembles = tuple(Watched(number) for number in range(count))
    cases = Cases.of(breadth=0.3, height=1.8, ensemble=range(count), ensembles=ensembles)
    evaluate(cases, Settings(runs=2), threads=threads)
    assert all(one.opened for one in ensembles)
