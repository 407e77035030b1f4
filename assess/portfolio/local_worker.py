"""A process that assesses buildings for `local_pool`: tasks come in by standard input, summaries go out.

It ends as soon as its standard input does, whatever it is doing: so it does not outlive the process that started it.
"""

import os
import pickle
import queue
import sys
import threading
from typing import IO

ALONE = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Variables by which libraries take no more than one thread."""

READY = b"ready"
"""The first message, once all is imported."""


def main() -> None:
    """Say that it is ready, then assess what comes in, one building after another."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints must not stand among the answers
    waiting: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(sys.stdin.buffer, waiting), daemon=True).start()
    try:
        from assess.errors import AssessError
        from assess.portfolio.building_task import run_task
    except Exception as error:
        os.write(2, f"error  a process cannot start: {type(error).__name__}: {error}\n".encode("utf-8", "replace"))
        os._exit(1)
    send(answers, READY)
    while True:
        try:
            task = pickle.loads(waiting.get())  # noqa: S301 - from the process that started this one
            answer: object = run_task(task)
        except AssessError as error:  # its ground motion is not what it was
            answer = type(error)(str(error))
        send(answers, pickle.dumps(answer))


def _listen(stream: IO[bytes], waiting: "queue.SimpleQueue[bytes]") -> None:
    """Hand on what comes in; end the process where nothing more can come."""
    while (data := receive(stream)) is not None:
        waiting.put(data)
    os._exit(0)


def send(stream: IO[bytes], data: bytes) -> None:
    """Write a message: its length, then its bytes. OSError if nobody reads any more."""
    stream.write(len(data).to_bytes(8, "big") + data)
    stream.flush()


def receive(stream: IO[bytes]) -> bytes | None:
    """Return the next message; None where the stream has ended."""
    head = stream.read(8)
    if len(head) < 8:
        return None
    data = stream.read(size := int.from_bytes(head, "big"))
    return data if len(data) == size else None


if __name__ == "__main__":
    main()
