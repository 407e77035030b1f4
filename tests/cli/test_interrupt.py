"""Ctrl-C: the command ends within half a second, with exit status 130, and leaves everything as it was."""

import os
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
from tests.workbooks import write

FLOORS = [{"floor": str(at), "pfa_x": 0.1 + 0.05 * at, "pfa_y": 0.2} for at in range(1, 5)]
ITEMS = [
    {"item": f"{floor['floor']} {breadth}", "floor": floor["floor"], "breadth": breadth, "height": 180}
    for floor in FLOORS
    for breadth in range(25, 85)
]
SOON = 10
"""Seconds within which a process of these tests has to end; it takes a fraction of one."""


@pytest.mark.parametrize("jobs", [1, 2])
def test_an_interrupted_verification_leaves_all_as_it_was(tmp_path, jobs):
    path, out = write(tmp_path / "w.xlsx", ITEMS, FLOORS), tmp_path / "out"
    out.mkdir()
    (out / "results.json").write_text("old", encoding="utf-8")
    words = ["assess", "run", str(path), "--verify", "all", "--runs", "auto", "--jobs", str(jobs), "--out", str(out)]
    # what a shell's foreground job has: a background one ignores the signal
    code = (
        f"import signal, sys\nsignal.signal(signal.SIGINT, signal.default_int_handler)\nsys.argv = {words!r}\n"
        "from assess.cli import console\nconsole.QUIET = 0\nfrom assess.cli.app import main\nmain()"
    )
    command = [sys.executable, "-c", code]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert "Simulating 240 pieces on 4 floors: 0 %\n" in process.stderr
        process.send_signal(signal.SIGINT)
        try:
            printed, errors = process.communicate(timeout=SOON)
        finally:
            process.kill()
    assert process.returncode == 130
    assert printed == ""
    assert errors.endswith("\nInterrupted; nothing was written.\n")
    assert "Traceback" not in errors
    assert [file.name for file in out.iterdir()] == ["results.json"]
    assert (out / "results.json").read_text(encoding="utf-8") == "old"


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
        _interrupt(number, lambda _: time.sleep(SOON))
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


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("count", [1, 3])
def test_nothing_is_compiled_in_the_thread_that_hears_ctrl_c(threads, count):
    """In the middle of a compilation the exception would end up in the compiler's own code, and be lost."""

    class Watched(MadeUp):
        def open(self, threads, progress=SILENT):
            assert threading.current_thread() is not threading.main_thread()
            return MadeUp.open(self, threads, progress)

    ensembles = tuple(Watched(number) for number in range(count))
    evaluate(
        Cases.of(breadth=0.3, height=1.8, ensemble=range(count), ensembles=ensembles), Settings(runs=2), threads=threads
    )
    assert all(one.opened for one in ensembles)
