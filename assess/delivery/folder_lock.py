"""A lock on a folder, which the system releases when the process that holds it dies.

Where the system locks a folder itself (Linux and macOS, local disks), nothing is written. Elsewhere (Windows, network
file systems) a file `FILE` in the folder is locked, and removed at the end.
"""

import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from assess.errors import OutputError
from assess.i18n import fill
from assess.progress import SILENT, Progress

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

FILE = ".assess-lock"
"""The file that is locked where a folder cannot be."""
PATIENCE = 20.0
"""Time that another run is waited for [s]; it holds a lock for less than a second."""
_ASKED_EVERY = 0.05


class FolderLock:
    """The lock on one folder."""

    def __init__(self, folder: Path) -> None:
        self._folder, self._file, self._handle = folder, folder / FILE, -1
        self._is_file = False

    @property
    def is_held(self) -> bool:
        """Whether the system knows of the lock."""
        return self._handle >= 0

    def take(self) -> bool:
        """Return False if another process, or another thread, holds the lock.

        True where the file system has no locks: nothing can be known there.
        """
        for path in (self._folder, self._file):
            try:
                handle = self._open(path)
            except OSError:
                continue
            is_held = _lock(handle)
            if is_held and _is_same(handle, path):
                self._handle, self._is_file = handle, path == self._file
                return True
            os.close(handle)
            if is_held is not None:
                return False  # held by another one, or replaced in the meantime: asked again
        return True

    def _open(self, path: Path) -> int:
        flags = os.O_RDONLY if path == self._folder else os.O_RDWR | os.O_CREAT
        return os.open(path, flags, 0o600)

    def release(self) -> None:
        """Release the lock, if it was taken."""
        if self._handle < 0:
            return
        if self._is_file:
            with suppress(OSError):  # on Windows once it is closed
                self._file.unlink()
        os.close(self._handle)
        self._handle = -1
        if self._is_file and sys.platform == "win32":
            with suppress(OSError):
                self._file.unlink()


def _lock(handle: int) -> bool | None:
    """Lock an open file or folder; False: another one holds it, None: it cannot be locked here."""
    try:
        if sys.platform == "win32":
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        else:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        return False
    except OSError:
        return None
    return True


def _is_same(handle: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(handle), path.stat())
    except OSError:
        return False


@contextmanager
def locked(folder: Path, progress: Progress = SILENT) -> Iterator[None]:
    """Hold the lock on a folder.

    Raises OutputError if another run has held it for `PATIENCE`; CancelledError if the work was cancelled.
    """
    lock, latest = FolderLock(folder), time.monotonic() + PATIENCE
    while not lock.take():
        progress.check()
        if time.monotonic() > latest:
            raise OutputError(
                fill("{folder} is in use: another run is writing to it. Wait until it has ended.", folder=folder)
            )
        time.sleep(_ASKED_EVERY)
    try:
        yield
    finally:
        lock.release()
