"""What ends the command early: Ctrl-C, SIGTERM, a terminal that is closed. Imports next to nothing, as it comes first.

Three ways, as far as the command has come:

* before the work (imports, options) and after it, the process ends at once;
* during the work it is asked to stop, and interrupted if it does not (`cancel_by_signal`);
* while files are moved into place, which takes milliseconds, a signal waits.

In each case temporary folders are removed and no traceback is shown; the exit status is 128 plus the number of the
first signal, as shells have it: 130 for Ctrl-C, 143 for SIGTERM.
"""

import _thread
import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

NAMES = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")
NUMBERS = tuple(int(getattr(signal, name)) for name in NAMES if hasattr(signal, name))
"""The signals that are answered, as far as the system has them."""
PATIENCE = 0.4  # time that the work has to stop by itself before it is interrupted [s]
CLEANING = 2.0  # time that it then has to clean up before it is interrupted again [s]
MOST = 3  # interrupts after which the process is ended wherever it is

heard: list[int] = []  # the signals since this command began, in their order: a process has one set of them


def answer_signals() -> None:
    """Have signals end the process without a traceback; one that is ignored, as with nohup, stays ignored."""

    def stop(number: int, _frame: object = None) -> None:
        heard.append(number)
        end()

    for number in NUMBERS:
        if signal.getsignal(number) not in (signal.SIG_IGN, None):
            signal.signal(number, stop)
    # what a destructor raised is shown, unless it was interrupted
    sys.unraisablehook = lambda error: (
        None if heard and issubclass(error.exc_type, KeyboardInterrupt) else sys.__unraisablehook__(error)
    )


def start() -> None:
    """Note that a command begins."""
    heard.clear()
    if traces := sys.modules.get("assess.delivery.folders"):
        traces.begin_command()


def end(remains: str = "") -> None:
    """End the process at once; return only if files are being moved into place at this moment.

    `remains` says what is kept of the work.
    """
    traces = sys.modules.get("assess.delivery.folders")
    if traces is not None and not traces.may_end():
        return
    has_written = traces is not None and traces.has_delivered()
    remains = remains or ("what was written before is complete" if has_written else "nothing was written")
    with contextlib.suppress(Exception):  # a closed pipe
        sys.stdout.flush()
    with contextlib.suppress(OSError):
        os.write(2, f"\nInterrupted; {remains}.\n".encode("utf-8", "replace"))
    if traces is not None:
        traces.remove_all()
    os._exit(128 + (heard[0] if heard else signal.SIGINT))


def end_surely(remains: str = "") -> None:
    """End the process, as soon as no other thread moves files into place."""
    while True:
        end(remains)
        time.sleep(0.01)


@contextmanager
def cancel_by_signal(cancel: threading.Event) -> Iterator[None]:
    """Have the first signal set `cancel`, and the next one raise KeyboardInterrupt in the main thread."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    signalled, done = threading.Event(), threading.Event()

    def stop(number: int, _frame: object = None) -> None:
        heard.append(number)
        traces = sys.modules.get("assess.delivery.folders")
        if traces is not None and traces.is_moving():
            return
        if cancel.is_set():
            raise KeyboardInterrupt
        cancel.set()
        signalled.set()

    def insist() -> None:
        """Interrupt until the work has ended, as what a compiled library swallows is lost; at last, end the process."""
        signalled.wait()
        wait = PATIENCE
        for _ in range(MOST):
            if done.wait(wait):
                return
            wait = CLEANING
            if hasattr(signal, "pthread_kill"):
                signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)
            else:
                _thread.interrupt_main()
        if not done.wait(wait):
            end_surely()

    before = {number: signal.getsignal(number) for number in NUMBERS}
    taken = [number for number, handler in before.items() if handler not in (signal.SIG_IGN, None)]
    for number in taken:
        signal.signal(number, stop)
    threading.Thread(target=insist, daemon=True).start()
    try:
        yield
    finally:
        for number in taken:
            signal.signal(number, before[number])
        done.set()
        signalled.set()
