"""Bytes that are on the disk, not on their way to it; and what a file holds, as a hash."""

import hashlib
import os
from contextlib import suppress
from pathlib import Path

_BLOCK = 1 << 20


def write_through(path: Path, data: bytes) -> None:
    """Write a file down to the disk, so that a full disk shows here; its folder is made if missing.

    Raises OSError if it cannot be written; `filename` names it, which the system leaves out where the disk is full.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        with path.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), str(path)) from None


def flush_file(path: Path) -> None:
    """Have the system put a file's bytes on the disk, where a full disk shows."""
    with path.open("rb+") as file:
        os.fsync(file.fileno())


def flush_folder(path: Path) -> None:
    """Have the system put a folder's entries on the disk, where it can: Windows cannot open a folder."""
    with suppress(OSError):
        handle = os.open(path, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def find_digest(path: Path) -> str | None:
    """Return the SHA-256 of a file; None if it is no plain file (missing, a folder, a link). OSError if unreadable."""
    if path.is_symlink() or not path.is_file():
        return None
    found = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(_BLOCK):
            found.update(block)
    return found.hexdigest()
