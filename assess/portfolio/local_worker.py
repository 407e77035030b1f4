"""A process that assesses buildings for `local_pool`: pickled tasks come in by standard input, summaries go out.

It ends as soon as its standard input does, whatever it is doing: so it does not outlive the process that started it.
"""

import os
import pickle
import queue
import sys
import threading


def main() -> None:
    """Say that it is ready, then assess what comes in, one building after another."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints must not stand among the answers
    waiting: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(waiting,), daemon=True).start()
    try:
        from assess.errors import AssessError
        from assess.portfolio.building_task import run_task
    except Exception as error:
        os.write(2, f"error  a process cannot start: {type(error).__name__}: {error}\n".encode("utf-8", "replace"))
        os._exit(1)
    answer: object = None  # the first message: all is imported
    while True:
        pickle.dump(answer, answers)
        answers.flush()
        try:
            answer = run_task(pickle.loads(waiting.get()))  # noqa: S301 - from the process that started this one
        except AssessError as error:  # its ground motion is not what it was
            answer = type(error)(str(error))


def _listen(waiting: "queue.SimpleQueue[bytes]") -> None:
    """Hand on what comes in, each task pickled by itself; end the process where nothing more can come."""
    try:
        while True:
            waiting.put(pickle.load(sys.stdin.buffer))  # noqa: S301 - likewise
    finally:
        os._exit(0)


if __name__ == "__main__":
    main()
