"""The folders in which files are written before they come to their place.

A stage is a folder ``.assess-writing-*``; what is to be delivered is in its folder `NEW`. It is locked as long as its
process lives: one that is not was left behind by a process that was killed, and the next run that writes there removes
it.
"""

import json
import os
import stat
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from assess.delivery.disk import write_through
from assess.delivery.folder_lock import FolderLock
from assess.delivery.traces import forget_folder, make_folder, remove_folder

PREFIX = ".assess-writing-"
NEW, OLD, MARK = "new", "old", "exchanged.json"
JOURNALS = (".assess-journal.json", ".assess-undo.json")
"""The journal of moves that go on, and of moves that are taken back: see `assess.delivery.moves`."""
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
        discard(stage)


def _make(where: Path) -> tuple[Path, FolderLock]:
    while True:
        stage = make_folder(where, PREFIX)
        lock = FolderLock(stage)
        if lock.take() and stage.is_dir():
            return stage, lock
        lock.release()  # somebody took it for a stage that was left behind
        forget_folder(stage)


def sweep(where: Path) -> None:
    """Remove the stages in a folder that killed processes left behind, unless a journal still needs them."""
    if any((where / name).exists() for name in JOURNALS):
        return
    for stage in where.glob(f"{PREFIX}*"):
        lock = FolderLock(stage)
        if _is_ours(stage) and lock.take():
            if lock.is_held or _is_old(stage):
                discard(stage)
            lock.release()
            if stage.is_dir() and _is_old(stage):  # on Windows it could not be removed while its lock was open
                discard(stage)


def _is_ours(stage: Path) -> bool:
    try:
        found = stage.lstat()
    except OSError:
        return False
    return stat.S_ISDIR(found.st_mode) and (not hasattr(os, "getuid") or found.st_uid == os.getuid())


def _is_old(stage: Path) -> bool:
    """Whether a stage is older than any run, where locks tell nothing."""
    return time.time() - stage.stat().st_mtime > _OLD


def note_exchange(stage: Path, names: Iterable[str]) -> None:
    """Note in a stage what its `NEW` may hold from now on: files of this run, or after the exchange those before it."""
    write_through(stage / MARK, json.dumps(sorted(names)).encode())


def discard(stage: Path) -> None:
    """Remove a stage; one whose folder was exchanged stays if it holds a file that nobody noted."""
    if (stage / MARK).is_file():
        try:
            noted = set(json.loads((stage / MARK).read_bytes()))
            others = {path.name for path in (stage / NEW).iterdir()} - noted if (stage / NEW).is_dir() else set()
        except (OSError, ValueError, TypeError):
            others = set()
        if others:
            forget_folder(stage)
            return
    remove_folder(stage)
