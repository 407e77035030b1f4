"""Temporary folders, the lock by which it is known that the process which made one still lives, and files in motion.

The system releases a lock when the process that holds it dies: a temporary folder without one was left behind by a
process that was killed, and is removed by the next process that makes one of its kind there.

Where the system locks a folder itself (Linux and macOS, local disks), nothing is written for a lock. Elsewhere
(Windows, network file systems) a file `FILE` in the folder is locked, and removed at the end.

A process has one set of signals: what ends it early asks here what it has on the disk for a time, and whether it is
moving files into place.
"""

import os
import shutil
import stat
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

from assess.errors import OutputError
from assess.progress import SILENT, Progress

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

FILE = ".assess-lock"  # the file that is locked where a folder cannot be
PREFIX = ".assess-writing-"  # how the names of stages begin
NEW, OLD = "new", "old"  # folders of a stage: what is to be delivered, and what it replaces
PATIENCE = 20.0  # time that another run is waited for [s]; it holds a lock for less than a second
_ASKED_EVERY = 0.05
_OLD = 24 * 3600.0  # age [s] of a folder that no process writes to any more, for file systems without locks


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
        """Return False if another holds the lock; True also where the file system has no locks: nothing can be known
        there.
        """
        for path in (self._folder, self._file):
            try:
                handle = self._open(path)
            except OSError:
                continue
            try:
                if sys.platform == "win32":
                    msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
                else:
                    fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                is_held: bool | None = True
            except (BlockingIOError, PermissionError):
                is_held = False
            except OSError:  # it cannot be locked here
                is_held = None
            with suppress(OSError):
                if is_held and os.path.samestat(os.fstat(handle), path.stat()):
                    self._handle, self._is_file = handle, path == self._file
                    return True
            os.close(handle)
            if is_held is not None:
                return False  # held by another one, or replaced in the meantime: asked again
        return True

    def _open(self, path: Path) -> int:
        return os.open(path, os.O_RDONLY if path == self._folder else os.O_RDWR | os.O_CREAT, 0o600)

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


@contextmanager
def locked(folder: Path, progress: Progress = SILENT) -> Iterator[None]:
    """Hold the lock on a folder; OutputError if another run has held it for `PATIENCE`, CancelledError if cancelled."""
    lock, latest = FolderLock(folder), time.monotonic() + PATIENCE
    while not lock.take():
        progress.check()
        if time.monotonic() > latest:
            raise OutputError.about(
                "{folder} is in use: another run is writing to it. Wait until it has ended.", folder=folder
            )
        time.sleep(_ASKED_EVERY)
    try:
        yield
    finally:
        lock.release()


@contextmanager
def private_folder(prefix: str, where: Path | None = None) -> Iterator[Path]:
    """Yield a new folder that others cannot read, locked while this process lives, and removed however that ends.
    `where`: by default the folder for temporary files. OSError if nothing can be made there.
    """
    where = where or Path(tempfile.gettempdir())
    sweep(where, prefix)
    while True:
        folder = make_folder(where, prefix)
        lock = FolderLock(folder)
        if lock.take() and folder.is_dir():
            break
        lock.release()  # another process took it for one that was left behind
        forget_folder(folder)
    try:
        yield folder
    finally:
        lock.release()
        remove_folder(folder)


@contextmanager
def staging(where: Path) -> Iterator[Path]:
    """Make a stage in a folder, in which files are written, in its folder `NEW`, before they come to their place."""
    with private_folder(PREFIX, where) as stage:
        (stage / NEW).mkdir()
        yield stage


def sweep(where: Path, prefix: str = PREFIX) -> None:
    """Remove the temporary folders in a folder that killed processes left behind."""
    for folder in where.glob(f"{prefix}*"):
        lock = FolderLock(folder)
        if is_ours(folder) and lock.take():
            is_left = lock.is_held or time.time() - folder.stat().st_mtime > _OLD  # where locks tell nothing
            if is_left:
                remove_folder(folder)
            lock.release()
            if is_left and folder.is_dir():  # on Windows it cannot be removed while its lock is open
                remove_folder(folder)


def is_ours(folder: Path) -> bool:
    """Tell whether a folder is there, not a link, and this user's."""
    try:
        found = folder.lstat()
    except OSError:
        return False
    return stat.S_ISDIR(found.st_mode) and (not hasattr(os, "getuid") or found.st_uid == os.getuid())


def is_left(folder: Path) -> bool:
    """Tell whether the process that made a folder has ended; False where the file system has no locks."""
    lock = FolderLock(folder)
    found = lock.take() and lock.is_held
    lock.release()
    return found


# ---------------------------------------------------------------- what this process has on the disk for a time


@dataclass(slots=True)
class _Traces:
    """Temporary folders, how many threads are moving files, and whether any have been moved since `begin_command`."""

    folders: set[Path] = field(default_factory=set)
    moving: int = 0
    has_delivered: bool = False
    gate: threading.RLock = field(default_factory=threading.RLock)


_TRACES = _Traces()


def make_folder(where: Path, prefix: str) -> Path:
    """Make a temporary folder, for this user alone; it is known before it exists. OSError if it cannot be made."""
    while True:
        path = where / f"{prefix}{os.urandom(6).hex()}"
        _TRACES.folders.add(path)
        try:
            path.mkdir(mode=0o700)
        except OSError as error:
            _TRACES.folders.discard(path)
            if not isinstance(error, FileExistsError):
                raise
        else:
            return path


def remove_folder(path: Path) -> None:
    """Remove a temporary folder."""
    shutil.rmtree(path, ignore_errors=True)
    forget_folder(path)


def forget_folder(path: Path) -> None:
    """Note that a temporary folder is gone, or is to stay."""
    _TRACES.folders.discard(path)


def remove_all() -> None:
    """Remove all temporary folders of this process, which is about to end."""
    for path in list(_TRACES.folders):
        shutil.rmtree(path, ignore_errors=True)


@contextmanager
def moving() -> Iterator[None]:
    """Keep the process from being ended by a signal while files are moved into place: it takes milliseconds."""
    with _TRACES.gate:
        _TRACES.moving += 1
    try:
        yield
        _TRACES.has_delivered = True
    finally:
        with _TRACES.gate:
            _TRACES.moving -= 1


def is_moving() -> bool:
    """Whether files are being moved into place at this moment."""
    return _TRACES.moving > 0


def has_delivered() -> bool:
    """Whether files have been moved into place since `begin_command`."""
    return _TRACES.has_delivered


def begin_command() -> None:
    """Note that a command begins, which has delivered nothing."""
    _TRACES.has_delivered = False


def may_end() -> bool:
    """Return whether the process may end at this moment; if so, no thread moves a file from here on."""
    _TRACES.gate.acquire()
    if is_moving():
        _TRACES.gate.release()
        return False
    return True
