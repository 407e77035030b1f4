"""How far a piece of work is, and whether it is to stop: one object through reading, motions, rocking and rendering."""

import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar, copy_context
from dataclasses import dataclass
from threading import Event
from typing import Self, TypeVar

from assess.errors import CancelledError

ESTIMATE_FROM = 0.02  # share of a stage [-] that has to be done before the time left is estimated
ASKED_EVERY = 0.05  # time [s] after which it is looked whether work that is waited for is to stop

_Found = TypeVar("_Found")


@dataclass(frozen=True, slots=True)
class Report:
    """How far a stage, such as "reading" or "motions", is: the `share` that is done [-] is 1.0 once at its end.

    `detail` is what is worked on, in plain English; `seconds_left` an estimate [s], None while too little is done.
    """

    stage: str
    share: float
    detail: str
    seconds_left: float | None


Listener = Callable[[Report], None]


class Progress:
    """Passes reports on to a listener, and raises `CancelledError` in the work once `cancel` is set.

    It may be used from several threads at once. Work calls `check` at least every 0.2 s, or goes through `wait_for`.
    The listener is called from whichever thread does the work, never from two at once.
    """

    def __init__(self, listener: Listener | None = None, cancel: Event | None = None) -> None:
        self._listener, self._cancel = listener, cancel or Event()
        self._can_stop, self._lock = cancel is not None, threading.Lock()

    @classmethod
    def of(cls, progress: "Progress | Listener | None", cancel: Event | None = None) -> Self:
        """Return a progress as it is, or make one of a listener and an event."""
        if isinstance(progress, cls) and cancel is None:
            return progress
        listener = progress._listener if isinstance(progress, Progress) else progress
        return cls(listener, cancel)

    def check(self) -> None:
        """Raise `CancelledError` if the work is to stop."""
        if self._cancel.is_set():
            raise CancelledError

    def checked(self, rows: Iterable[_Found]) -> Iterator[_Found]:
        """Yield `rows`, with a check before each."""
        for row in rows:
            self.check()
            yield row

    @property
    def is_cancelled(self) -> bool:
        """Whether the work is to stop."""
        return self._cancel.is_set()

    @contextmanager
    def stage(self, name: str, detail: str = "", parts: int = 1) -> Iterator["Stage"]:
        """Report a stage from its beginning to its end; `parts` of it may be worked on side by side."""
        self.check()
        stage = Stage(self, name, detail, parts)
        self.tell(Report(name, 0.0, detail, None))
        yield stage
        self.tell(Report(name, 1.0, detail, 0.0))

    def tell(self, report: Report) -> None:
        """Pass a report on to the listener, unless the work is to stop."""
        if self._listener is not None:
            with self._lock:
                if not self.is_cancelled:
                    self._listener(report)

    def wait_for(self, work: Callable[[], _Found]) -> _Found:
        """Return what `work` returns; raise `CancelledError` at once if it is to stop, whatever it is doing.

        For stretches that cannot be split, such as a compilation, an import or a library's own loop. They are worked on
        in a thread, in the language in use, and go on there after a cancel, which the process waits for when it ends.
        So `work` only computes: it writes no file, and changes nothing that others see. Without an event to cancel by,
        it is just called.
        """
        if not self._can_stop:
            return work()
        self.check()
        found: list[_Found] = []
        errors: list[BaseException] = []
        done = Event()

        def run() -> None:
            try:
                found.append(work())
            except BaseException as error:  # raised in the thread that waits
                errors.append(error)
            finally:
                done.set()

        context = copy_context()
        context.run(_WAITS.set, self)
        threading.Thread(target=context.run, args=(run,), name="assess-aside").start()
        while not done.wait(ASKED_EVERY):
            self.check()
        if errors:
            raise errors[0]
        return found.pop()


class Stage:
    """One stage of the work, in parts of equal weight."""

    def __init__(self, progress: Progress, name: str, detail: str, parts: int) -> None:
        self.progress, self._name, self._detail = progress, name, detail
        self._shares, self._start = [0.0] * max(1, parts), time.monotonic()

    def at(self, share: float, part: int = 0, detail: str = "") -> None:
        """Note that `share` [-] of a part is done, and what is worked on; raises `CancelledError` if it is to stop."""
        self.progress.check()
        self._detail = detail or self._detail
        self._shares[part] = share
        done = sum(self._shares) / len(self._shares)
        spent = time.monotonic() - self._start
        left = spent * (1 - done) / done if done >= ESTIMATE_FROM else None
        if done < 1.0:
            self.progress.tell(Report(self._name, done, self._detail, left))

    def check(self) -> None:
        """Raise `CancelledError` if the work is to stop."""
        self.progress.check()


SILENT = Progress()  # reports to nobody and never stops the work: the default everywhere

_WAITS: ContextVar[Progress] = ContextVar("waits", default=SILENT)


def check_waits() -> None:
    """Raise `CancelledError` in work that nobody waits for any more; for loops that no `Progress` is handed to."""
    _WAITS.get().check()
