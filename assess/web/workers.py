"""The processes of the sessions, as the server has them: started, asked, ended."""

import json
import subprocess
import threading
from collections.abc import Mapping
from concurrent.futures import Future
from contextlib import suppress
from itertools import count
from pathlib import Path
from typing import Any, Protocol

from assess.processes import start_module
from assess.web.frames import Call, Reply, pack, read_frame, write_frame

PATIENCE = 2.0
"""Time that a process has to end by itself once nothing more is asked of it [s]."""


class WorkerGoneError(Exception):
    """The process has ended, without an answer."""


class Link(Protocol):
    """What answers the requests of a session; `is_gone`: it has ended."""

    is_gone: bool

    def ask(self, call: Call) -> Reply:
        """Return the answer to a request; WorkerGoneError where there is none. Called by several threads at once."""

    def kill(self) -> None:
        """End it at once."""

    def close(self) -> None:
        """Have it save and end."""


class Process:
    """The process of one session; `order` is what `assess.web.worker.Worker` takes."""

    def __init__(self, folder: Path, order: Mapping[str, Any]) -> None:
        self._process = start_module("assess.web.worker", folder)
        self._numbers, self._lock, self._writing = count(), threading.Lock(), threading.Lock()
        self.is_gone = False
        self._asked: dict[int, Future[Reply]] = {}
        with suppress(OSError):
            write_frame(self._process.stdin, order)  # type: ignore[arg-type]
        self._reader = threading.Thread(target=self._listen, name="assess-answers", daemon=True)
        self._reader.start()

    @property
    def pid(self) -> int:
        """Its number."""
        return self._process.pid

    def _listen(self) -> None:
        while (found := read_frame(self._process.stdout)) is not None:  # type: ignore[arg-type]
            header, data = found
            with self._lock:
                future = self._asked.pop(header.pop("number"))
            future.set_result(Reply(**header, data=data))
        with self._lock:
            self.is_gone, left = True, list(self._asked.values())
        for future in left:
            future.set_exception(WorkerGoneError())
        self._process.wait()

    def ask(self, call: Call) -> Reply:
        """Return the answer to a request."""
        future, number = Future[Reply](), next(self._numbers)
        with self._lock:
            if self.is_gone:
                raise WorkerGoneError
            self._asked[number] = future
        with self._writing, suppress(OSError, ValueError):  # it has ended: its answers end, too
            write_frame(self._process.stdin, *pack(call, number))  # type: ignore[arg-type]
        return future.result()

    def kill(self) -> None:
        """End it at once."""
        self._process.kill()

    def close(self) -> None:
        """Have it save and end."""
        with self._writing, suppress(OSError):
            self._process.stdin.close()  # type: ignore[union-attr]
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.kill()
        self._reader.join()


def measure_memory(pid: int) -> float:
    """Return how much memory a process has [bytes]; 0 where the system does not tell."""
    with suppress(OSError, ValueError, IndexError):
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * 4096.0
    return 0.0


def ask_own(link: Link, what: str, **query: str) -> dict[str, Any]:
    """Return what the process of a session answers to the server itself."""
    found: dict[str, Any] = json.loads(link.ask(Call("POST", f"/own/{what}", query)).data)
    return found
