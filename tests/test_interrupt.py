"""Ctrl-C while pieces are verified: the command ends at once and leaves everything as it was."""

import signal
import subprocess
import sys
import threading

import pytest

from assess.methods import Cases
from assess.methods.housner_monte_carlo import evaluate
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
"""Seconds within which the process has to end; it takes a fraction of one."""


@pytest.mark.parametrize("jobs", [1, 2])
def test_an_interrupted_verification_leaves_all_as_it_was(tmp_path, jobs):
    path, out = write(tmp_path / "w.xlsx", ITEMS, FLOORS), tmp_path / "out"
    out.mkdir()
    (out / "results.json").write_text("old", encoding="utf-8")
    words = ["assess", "run", str(path), "--verify", "all", "--runs", "auto", "--jobs", str(jobs), "--out", str(out)]
    # what a shell's foreground job has: a background one ignores the signal
    code = f"import signal, sys\nsignal.signal(signal.SIGINT, signal.default_int_handler)\nsys.argv = {words!r}\n"
    command = [sys.executable, "-c", code + "from assess.cli import main\nmain()"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr.readline() == "Verifying 240 pieces on 4 floors.\n"
        process.send_signal(signal.SIGINT)
        try:
            printed, errors = process.communicate(timeout=SOON)
        finally:
            process.kill()
    assert process.returncode == 130
    assert printed == ""
    assert errors == "\nInterrupted; no report was written.\n"
    assert [file.name for file in out.iterdir()] == ["results.json"]
    assert (out / "results.json").read_text(encoding="utf-8") == "old"


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("count", [1, 3])
def test_nothing_is_compiled_in_the_thread_that_hears_ctrl_c(threads, count):
    """In the middle of a compilation the exception would end up in the compiler's own code, and be lost."""

    class Watched(MadeUp):
        def open(self, threads):
            assert threading.current_thread() is not threading.main_thread()
            return MadeUp.open(self, threads)

    ensembles = tuple(Watched(number) for number in range(count))
    evaluate(
        Cases.of(breadth=0.3, height=1.8, ensemble=range(count), ensembles=ensembles), Settings(runs=2), threads=threads
    )
    assert all(one.opened for one in ensembles)
