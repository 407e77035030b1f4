"""Temporary folders for this user alone; those of processes that were killed are removed by the next that makes one."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from assess.delivery.folder_lock import FolderLock
from assess.delivery.traces import make_folder, remove_folder


@contextmanager
def private_folder(prefix: str) -> Iterator[Path]:
    """Yield a new folder that others cannot read, locked while this process lives; it is removed at the end.

    It is known to what ends the process early, which removes it as well.
    """
    where = Path(tempfile.gettempdir())
    sweep_folders(where, prefix)
    folder = make_folder(where, prefix)
    lock = FolderLock(folder)
    lock.take()
    try:
        yield folder
    finally:
        lock.release()
        remove_folder(folder)


def sweep_folders(where: Path, prefix: str) -> list[Path]:
    """Remove the folders of processes that have ended without removing theirs: nobody holds their locks any more."""
    removed = []
    for folder in where.glob(f"{prefix}*"):
        if not folder.is_symlink() and folder.is_dir() and is_ours(folder) and is_left(folder):
            shutil.rmtree(folder, ignore_errors=True)
            removed.append(folder)
    return removed


def is_ours(folder: Path) -> bool:
    """Tell whether a folder is this user's."""
    return not hasattr(os, "getuid") or folder.stat().st_uid == os.getuid()


def is_left(folder: Path) -> bool:
    """Tell whether the process that made a folder has ended; False where the file system has no locks."""
    lock = FolderLock(folder)
    found = lock.take() and lock.is_held
    lock.release()
    return found
