"""Tasks on processes of this machine, each of which may die without harm to the others.

A process that dies is replaced, and its building tried again by the new one; a building under which `MOST_DEATHS`
processes have died is skipped with that reason. Each process works on one building at a time, so that it is known which
one it died of. They are started as commands, not by `multiprocessing`, which would run the script of the user again.
"""

import os
import pickle
import queue
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from assess.errors import OutputError
from assess.i18n import fill
from assess.portfolio.building_task import Summary, Task, give_up
from assess.portfolio.local_worker import ALONE, READY, receive, send
from assess.progress import SILENT, Progress

MOST_DEATHS = 3
"""Processes that may die of one building before it is skipped."""
MOST_STARTS = 3
"""Processes in a row that may end before they are ready: then none can be started here."""
_ASKED_EVERY = 0.1
"""Time [s] after which it is looked whether the work is to stop."""
Worker = subprocess.Popen[bytes]


def run_local(tasks: Sequence[Task], jobs: int, progress: Progress = SILENT) -> Iterator[Summary]:
    """Yield the summaries of tasks as they are done, in no order.

    Parameters
    ----------
    tasks : sequence of Task
        What to do.
    jobs : int
        Processes.
    progress : Progress
        Checked for a cancel, which ends the processes at once.

    Raises
    ------
    CancelledError
        If the work was cancelled; parts that are written stay.
    OutputError
        If no process can be started.
    """
    pool = _Pool(tasks)
    threads = [threading.Thread(target=pool.work, daemon=True) for _ in range(min(jobs, len(tasks)))]
    for one in threads:
        one.start()
    try:
        for _ in tasks:
            yield pool.take_answer(progress)
    finally:
        pool.close()
        for one in threads:
            one.join()


class _Pool:
    """The tasks that are left, and the processes that work on them, one a thread."""

    def __init__(self, tasks: Sequence[Task]) -> None:
        self._left = deque((task, 0) for task in tasks)
        self._answers: queue.SimpleQueue[Summary | Exception] = queue.SimpleQueue()
        self._workers: set[Worker] = set()
        self._lock, self._is_closed, self._failed_starts = threading.Lock(), False, 0

    def take_answer(self, progress: Progress) -> Summary:
        """Return the next summary; raise what kept a thread from working."""
        while True:
            progress.check()
            with suppress(queue.Empty):
                found = self._answers.get(timeout=_ASKED_EVERY)
                if isinstance(found, Exception):
                    raise found
                return found

    def close(self) -> None:
        """End the processes, whatever they are doing."""
        with self._lock:
            self._is_closed = True
            self._left.clear()
            for one in self._workers:
                one.kill()

    def work(self) -> None:
        """Have one process after another do tasks, until none is left."""
        try:
            while worker := self._start():
                try:
                    if self._is_ready(worker):
                        self._serve(worker)
                finally:
                    self._end(worker)
        except Exception as error:  # raised in the thread that waits
            self._answers.put(error)

    def _start(self) -> Worker | None:
        """Return a new process; None where nothing is left to do."""
        with self._lock:
            if self._is_closed or not self._left:
                return None
            worker = _start_process()
            self._workers.add(worker)
            return worker

    def _end(self, worker: Worker) -> None:
        with self._lock:
            self._workers.discard(worker)
        worker.kill()
        for stream in filter(None, (worker.stdin, worker.stdout)):
            with suppress(OSError):
                stream.close()
        worker.wait()

    def _is_ready(self, worker: Worker) -> bool:
        """Wait for the first message of a process; return whether it came. OutputError if many end without it."""
        if worker.stdout is not None and receive(worker.stdout) == READY:
            self._failed_starts = 0
            return True
        self._failed_starts += 1
        if self._failed_starts >= MOST_STARTS and not self._is_closed:
            raise OutputError(fill("processes end as soon as they are started (exit status {how}).", how=worker.wait()))
        return False

    def _serve(self, worker: Worker) -> None:
        """Hand tasks to a process until none is left, or it dies."""
        while True:
            try:
                task, deaths = self._left.popleft()
            except IndexError:  # nothing is left
                return
            answer = _ask(worker, task)
            if isinstance(answer, Exception):
                raise answer
            if answer is None:  # it died
                if deaths + 1 >= MOST_DEATHS:
                    self._answers.put(give_up(task))
                elif not self._is_closed:
                    self._left.appendleft((task, deaths + 1))
                return
            self._answers.put(answer)


def _start_process() -> Worker:
    """Return a new process; Ctrl-C in the terminal does not reach it, as the process that started it ends it."""
    package = str(Path(__file__).parents[2])
    path = os.pathsep.join(filter(None, (package, os.environ.get("PYTHONPATH"))))
    return subprocess.Popen(
        [sys.executable, "-m", "assess.portfolio.local_worker"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env=os.environ | dict.fromkeys(ALONE, "1") | {"PYTHONPATH": path},
        start_new_session=True,
        creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),  # of Windows alone
    )


def _ask(worker: Worker, task: Task) -> Summary | Exception | None:
    """Have a process do a task; None if it dies, an error if it cannot do any."""
    assert worker.stdin is not None and worker.stdout is not None  # noqa: S101, PT018 - both are pipes
    try:
        send(worker.stdin, pickle.dumps(task))
        data = receive(worker.stdout)
    except OSError:
        return None
    return None if data is None else pickle.loads(data)  # noqa: S301 - of our own process
