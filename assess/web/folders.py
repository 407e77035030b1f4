"""The folder of a server, for its user alone; folders of servers that were killed are removed at the next start."""

import json
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from assess.delivery.folder_lock import FolderLock
from assess.delivery.traces import make_folder, remove_folder

PREFIX = "assess-open-"
NOTE = "opened.json"
"""In the folder of a session: which workbook it has open, and the process."""


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


def note_opened(session: Path, workbook: Path) -> None:
    """Write down, for other servers of this user, which workbook a session has open."""
    text = json.dumps({"path": str(workbook.resolve()), "pid": os.getpid()})
    with suppress(OSError):  # it only serves a warning
        (session / NOTE).write_text(text, encoding="utf-8")


def find_other(session: Path, workbook: Path) -> int | None:
    """Return the process of another running server of this user that has a workbook open, None where there is none."""
    for note in session.parent.parent.glob(f"{PREFIX}*/*/{NOTE}"):
        with suppress(OSError, ValueError, KeyError, TypeError):
            folder = note.parent.parent
            if folder == session.parent or folder.is_symlink() or not _is_ours(folder):
                continue
            found = json.loads(note.read_text(encoding="utf-8"))
            if Path(found["path"]).samefile(workbook) and not _is_left(folder):
                return int(found["pid"])
    return None
