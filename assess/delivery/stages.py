"""The folders in which files are written before they come to their place.

A stage is a folder ``.assess-writing-*``; what is to be delivered is in its folder `NEW`. It is locked as long as its
process lives: one that is not was left behind by a process that was killed, and the next run that writes there removes
it.
"""

import os
import stat
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from assess.delivery.folder_lock import FolderLock
from assess.delivery.traces import forget_folder, make_folder, remove_folder

PREFIX = ".assess-writing-"
NEW, OLD = "new", "old"
_OLD = 24 * 3600.0
"""Age [s] of a stage that no process writes to any more, for file systems without locks."""


@contextmanager
def staging(where: Path) -> Iterator[Path]:
    """Make a stage in a folder; it is removed at the end. OSError if nothing can be made there."""
    sweep(where)
    stage, lock = _make(where)
    try:
        (stage / NEW).mkdir()
        yield stage
    finally:
        lock.release()
        remove_folder(stage)


def _make(where: Path) -> tuple[Path, FolderLock]:
    while True:
        stage = make_folder(where, PREFIX)
        lock = FolderLock(stage)
        if lock.take() and stage.is_dir():
            return stage, lock
        lock.release()  # somebody took it for a stage that was left behind
        forget_folder(stage)


def sweep(where: Path) -> None:
    """Remove the stages in a folder that killed processes left behind."""
    for stage in where.glob(f"{PREFIX}*"):
        lock = FolderLock(stage)
        if _is_ours(stage) and lock.take():
            if lock.is_held or _is_old(stage):
                remove_folder(stage)
            lock.release()
            if stage.is_dir() and _is_old(stage):  # on Windows it could not be removed while its lock was open
                remove_folder(stage)


def _is_ours(stage: Path) -> bool:
    try:
        found = stage.lstat()
    except OSError:
        return False
    return stat.S_ISDIR(found.st_mode) and (not hasattr(os, "getuid") or found.st_uid == os.getuid())


def _is_old(stage: Path) -> bool:
    """Whether a stage is older than any run, where locks tell nothing."""
    return time.time() - stage.stat().st_mtime > _OLD
