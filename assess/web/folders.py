"""The folder of a server, for its user alone; folders of servers that were killed are removed at the next start."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from assess.delivery.folder_lock import FolderLock
from assess.delivery.traces import make_folder, remove_folder

PREFIX = "assess-open-"


@contextmanager
def private_folder() -> Iterator[Path]:
    """Yield a new folder that others cannot read, locked while this process lives; it is removed at the end.

    It is known to what ends the process early, which removes it as well.
    """
    where = Path(tempfile.gettempdir())
    sweep(where)
    folder = make_folder(where, PREFIX)
    lock = FolderLock(folder)
    lock.take()
    try:
        yield folder
    finally:
        lock.release()
        remove_folder(folder)


def sweep(where: Path) -> list[Path]:
    """Remove the folders of servers that have ended without removing theirs: nobody holds their locks any more."""
    removed = []
    for folder in where.glob(f"{PREFIX}*"):
        if not folder.is_symlink() and folder.is_dir() and _is_ours(folder) and _is_left(folder):
            shutil.rmtree(folder, ignore_errors=True)
            removed.append(folder)
    return removed


def _is_ours(folder: Path) -> bool:
    return not hasattr(os, "getuid") or folder.stat().st_uid == os.getuid()


def _is_left(folder: Path) -> bool:
    """Tell whether the process that made a folder has ended; False where the file system has no locks."""
    lock = FolderLock(folder)
    is_left = lock.take() and lock.is_held
    lock.release()
    return is_left
