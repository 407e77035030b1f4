"""Tasks on processes of this machine, each of which may die without harm to the others.

Each process works on one building at a time, so that it is known which one it died of: that is tried again by another
process, and skipped with the reason once `MOST_DEATHS` have died of it. They are started as commands, not by
`multiprocessing`, which would run the script of the user again.
"""

import os
import pickle
import queue
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any

from assess.errors import CancelledError, OutputError
from assess.portfolio.building_task import Summary, Task, give_up
from assess.progress import SILENT, Progress

MOST_DEATHS = 3  # processes that may die of one building before it is skipped
MOST_STARTS = 3  # processes in a row that may end before they are ready: then none can be started here
ALONE = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Variables by which libraries take no more than one thread."""
_ASKED_EVERY = 0.1  # time [s] after which it is looked whether the work is to stop
Process = subprocess.Popen[bytes]


def run_local(tasks: Sequence[Task], jobs: int, progress: Progress = SILENT) -> Iterator[Summary]:
    """Yield the summaries of tasks as `jobs` processes get them done, in no order.

    Raises CancelledError if the work was cancelled, which ends the processes at once; OutputError if none can be
    started.
    """
    processes, done = _Processes(), queue.SimpleQueue[Future[Summary]]()
    threads = ThreadPoolExecutor(min(jobs, len(tasks)))
    try:
        for task in tasks:
            threads.submit(processes.run, task).add_done_callback(done.put)
        for _task in tasks:
            future = None
            while future is None:
                progress.check()
                with suppress(queue.Empty):
                    future = done.get(timeout=_ASKED_EVERY)
            yield future.result()
    finally:
        processes.kill()
        threads.shutdown(cancel_futures=True)
        processes.close()


class _Processes:
    def __init__(self) -> None:
        self._idle: list[Process] = []
        self._all: set[Process] = set()
        self._lock, self._is_closed = threading.Lock(), False

    def run(self, task: Task) -> Summary:
        """Have a process do a task, another one where it dies; raises what kept it from doing any."""
        for _attempt in range(MOST_DEATHS):
            process = self._take()
            try:
                assert process.stdin is not None  # noqa: S101 - it is a pipe
                pickle.dump(pickle.dumps(task), process.stdin)
                process.stdin.flush()
                answer: Summary | Exception = _receive(process)
            except (OSError, EOFError, pickle.UnpicklingError):  # it died
                self._end(process)
                continue
            self._idle.append(process)
            if isinstance(answer, Exception):
                raise answer
            return answer
        return give_up(task)

    def kill(self) -> None:
        """End the processes, whatever they are doing, and start no others."""
        with self._lock:
            self._is_closed = True
            for one in self._all:
                one.kill()

    def close(self) -> None:
        """Free what the processes that are left have taken."""
        for one in list(self._all):
            self._end(one)

    def _take(self) -> Process:
        status = None
        for _attempt in range(MOST_STARTS):
            with self._lock:
                if self._is_closed:
                    raise CancelledError
                if self._idle:
                    return self._idle.pop()
                package = str(Path(__file__).parents[2])
                path = os.pathsep.join(filter(None, (package, os.environ.get("PYTHONPATH"))))
                process = subprocess.Popen(
                    [sys.executable, "-m", "assess.portfolio.local_worker"],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    env=os.environ | dict.fromkeys(ALONE, "1") | {"PYTHONPATH": path},
                    start_new_session=True,  # Ctrl-C in the terminal does not reach it
                    creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),  # of Windows alone
                )
                self._all.add(process)
            with suppress(EOFError, OSError):
                _receive(process)  # that it is ready
                return process
            with suppress(subprocess.TimeoutExpired):
                process.wait(1)
            status = self._end(process)
        raise OutputError.about("processes end as soon as they are started (exit status {how}).", how=status)

    def _end(self, process: Process) -> int:
        """End a process, unless it did so itself, and return its exit status."""
        with self._lock:
            self._all.discard(process)
        process.kill()
        for stream in filter(None, (process.stdin, process.stdout)):
            with suppress(OSError):  # what it does not read any more
                stream.close()
        return process.wait()


def _receive(process: Process) -> Any:
    assert process.stdout is not None  # noqa: S101 - it is a pipe
    return pickle.load(process.stdout)  # noqa: S301 - of our own process
