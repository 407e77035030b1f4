"""What is kept of what was made, in so many bytes, for several threads: noise, motions and the modes of buildings."""

import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from typing import Generic, Protocol, TypeVar

from assess.progress import SILENT, Progress

ASKED_EVERY = 0.05
"""Time [s] after which a thread that waits for another asks whether to stop."""


class Sized(Protocol):
    """What has a size in memory."""

    @property
    def nbytes(self) -> int:
        """Bytes."""


Made = TypeVar("Made", bound=Sized)


class Kept(Generic[Made]):
    """What has been made, the latest used last; what is over `most` bytes is dropped."""

    def __init__(self, most: int) -> None:
        self.most = most
        self._held: OrderedDict[Hashable, Made] = OrderedDict()
        self._busy: dict[Hashable, threading.Lock] = {}
        self._lock = threading.Lock()

    @property
    def nbytes(self) -> int:
        """Bytes of all that is kept."""
        with self._lock:
            return sum(one.nbytes for one in self._held.values())

    def keep(self, key: Hashable, made: Made) -> None:
        """Keep something, which may have grown since it was kept last."""
        with self._lock:
            self._held[key] = made
            self._held.move_to_end(key)
            while sum(one.nbytes for one in self._held.values()) > self.most:
                self._held.popitem(last=False)

    def find_or_make(self, key: Hashable, make: Callable[[], Made], progress: Progress = SILENT) -> Made:
        """Return what is kept by a key, or make and keep it; one thread makes what others wait for."""
        with self._lock:
            own = self._busy.setdefault(key, threading.Lock())
        try:
            with waiting(own, progress):
                with self._lock:
                    found = self._held.get(key)
                    if found is not None:
                        self._held.move_to_end(key)
                if found is None:
                    found = make()
                    self.keep(key, found)
                return found
        finally:
            with self._lock:
                self._busy.pop(key, None)

    def forget(self) -> None:
        """Drop all that is kept."""
        with self._lock:
            self._held.clear()


@contextmanager
def waiting(lock: threading.Lock, progress: Progress) -> Iterator[None]:
    """Hold a lock; raise CancelledError while waiting for it if the work is to stop."""
    while not lock.acquire(timeout=ASKED_EVERY):
        progress.check()
    try:
        yield
    finally:
        lock.release()
