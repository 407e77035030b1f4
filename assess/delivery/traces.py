"""What this process has put on the disk for a time, and whether it is moving files into place.

A process has one set of signals, so that this is known once for the process: whatever ends it early asks here.
"""

import os
import shutil
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(slots=True)
class _Traces:
    """Temporary folders, how many threads are moving files, and whether any have been moved."""

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
        except FileExistsError:
            _TRACES.folders.discard(path)
        except OSError:
            _TRACES.folders.discard(path)
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
    """Whether files have been moved into place since `start`."""
    return _TRACES.has_delivered


def start() -> None:
    """Note that a command begins, which has delivered nothing."""
    _TRACES.has_delivered = False


def close() -> bool:
    """Return whether the process may end at this moment; if so, no thread moves a file from here on."""
    _TRACES.gate.acquire()
    if is_moving():
        _TRACES.gate.release()
        return False
    return True
