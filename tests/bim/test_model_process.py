"""Work in a process of its own: what it returns, raises, and how it ends when it crashes or reaches a limit."""

import os
import signal
import sys
import threading
from pathlib import Path

import pytest

from assess.bim import model_process
from assess.bim.cobie import read_cobie
from assess.bim.model_process import run_apart
from assess.errors import CancelledError, ModelError, WorkbookError
from assess.progress import SILENT, Progress

ON_LINUX = pytest.mark.skipif(sys.platform != "linux", reason="only Linux limits addresses")


def test_it_returns_and_raises_what_the_work_in_another_process_does():
    assert run_apart("a.ifc", SILENT, divmod, 17, 5) == (3, 2)
    assert run_apart("a.ifc", SILENT, os.getpid) != os.getpid()
    with pytest.raises(WorkbookError, match="not an Excel workbook") as caught:
        run_apart("a.ifc", SILENT, read_cobie, b"no workbook", "a.xlsx")
    assert caught.value.problems


def test_what_a_killed_process_left_is_removed_and_a_file_of_the_users_replaces_no_module(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    (tmp_path / f"{model_process.PREFIX}left").mkdir()
    (tmp_path / f"{model_process.PREFIX}left" / "order").write_bytes(b"a building")
    assert run_apart("a.ifc", SILENT, divmod, 17, 5) == (3, 2)
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "pickle.py").write_text("raise SystemExit(7)", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert run_apart("a.ifc", SILENT, divmod, 17, 5) == (3, 2)


@pytest.mark.skipif(os.name == "nt", reason="Windows has no signals of this kind")
def test_a_crash_is_told_in_words():
    with pytest.raises(ModelError, match=r"a\.ifc could not be read: the library .* stopped"):
        run_apart("a.ifc", SILENT, signal.raise_signal, signal.SIGSEGV)


@ON_LINUX
def test_memory_is_limited():
    with pytest.raises(ModelError, match="needs more than 4 GB of memory"):
        run_apart("a.ifc", SILENT, eval, "bytes(6 * 2**30)")


@ON_LINUX
@pytest.mark.slow
def test_processor_time_is_limited(monkeypatch):
    monkeypatch.setattr(model_process, "SECONDS", 1)
    with pytest.raises(ModelError, match="takes more than 1 s of processor time"):
        run_apart("a.ifc", SILENT, eval, "sum(range(10**12))")


WORK_ON = """open({path!r}, "w").write(str(__import__("os").getpid())), sum(range(10**12))"""


class _Begun(threading.Event):
    """A cancel that is asked for once the work has left the number of its process in a file."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.path = path

    def is_set(self) -> bool:
        return self.path.exists() and self.path.read_text().isdigit()


@pytest.mark.skipif(os.name == "nt", reason="Windows has no signal 0, which only asks for a process")
def test_a_cancel_stops_the_process(tmp_path):
    cancel = _Begun(tmp_path / "pid")
    with pytest.raises(CancelledError):
        run_apart("a.ifc", Progress(cancel=cancel), eval, WORK_ON.format(path=str(cancel.path)))
    with pytest.raises(ProcessLookupError):
        os.kill(int(cancel.path.read_text()), 0)
