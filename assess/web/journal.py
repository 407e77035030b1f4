"""What a session holds, on the disk: the workbook as it was opened, and every step since, so that no kill loses any.

A step is written before it is taken. A process that is started again reads the workbook and takes the steps again,
which brings it to the same version with the same history.
"""

import errno
import json
import os
import secrets
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from assess.delivery.folders import FolderLock, is_ours, locked
from assess.errors import OutputError
from assess.web.limits import PREFIX

HEAD = "book.json"
"""In the folder of a session: which workbook is open, and the names of the files that hold it and its steps."""
TAKEN = "assess-taken-"
"""Beginning of the name of the folder in which what a killed server has left waits for the next one."""


class Journal:
    """The journal in the folder of a session; one is kept, that of the workbook that is open."""

    def __init__(self, folder: Path, *, is_own: bool = False) -> None:
        self._folder, self._is_own = folder, is_own  # of the user of this machine, not of one who comes through a proxy
        self._steps: Path | None = None

    def begin(self, data: bytes, files: Path, **book: Any) -> None:
        """Begin with a workbook as it was opened, or read again: its bytes, the folder of its files, and what it is."""
        name, before = secrets.token_hex(8), self.read_head()
        opened, steps = self._folder / f"opened-{name}", self._folder / f"steps-{name}"
        own = self._folder.resolve()
        place = str(files.relative_to(own) if files.is_relative_to(own) else files)
        head = {**book, "files": place, "opened": opened.name, "steps": steps.name, "is_own": self._is_own}
        part = self._folder / f"{HEAD}.part"
        try:
            opened.write_bytes(data)
            steps.touch()
            part.write_text(json.dumps(head), encoding="utf-8")
            part.replace(self._folder / HEAD)
        except OSError:  # the steps of the workbook before would not fit what comes now
            self._remove(head)
            self.end()
            raise
        self._steps = steps
        self._remove(before)

    def note(self, *step: Any) -> None:
        """Write a step, whole or not at all; OSError where there is no room."""
        if self._steps is not None:
            line = json.dumps(step).encode() + b"\n"
            with self._steps.open("ab", buffering=0) as file:
                size = file.seek(0, os.SEEK_END)
                if file.write(line) != len(line):
                    file.truncate(size)
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    def end(self) -> None:
        """Forget the workbook."""
        head, self._steps = self.read_head(), None
        (self._folder / HEAD).unlink(missing_ok=True)
        self._remove(head)

    def _remove(self, head: Mapping[str, Any]) -> None:
        for one in ("opened", "steps"):
            if one in head:
                (self._folder / head[one]).unlink(missing_ok=True)

    def read_head(self) -> dict[str, Any]:
        """Return what stands at the head, nothing where no workbook is open."""
        with suppress(OSError, ValueError):
            found: dict[str, Any] = json.loads((self._folder / HEAD).read_text(encoding="utf-8"))
            return {**found, "files": str(self._folder / found["files"])}
        return {}

    def read(self, head: Mapping[str, Any]) -> tuple[bytes, list[list[Any]]]:
        """Return the workbook as it was opened, and the steps; further ones are written behind them."""
        self._steps = self._folder / head["steps"]
        lines = self._steps.read_bytes().split(b"\n")
        if lines[-1]:  # it was not written to its end, nor answered
            with self._steps.open("r+b") as file:
                file.truncate(self._steps.stat().st_size - len(lines[-1]))
        return (self._folder / head["opened"]).read_bytes(), [json.loads(line) for line in lines[:-1] if line]


def list_saved(head: Mapping[str, Any], steps: Iterable[Sequence[Any]]) -> list[Sequence[Any]]:
    """Return the version that was saved last, and its digest; behind it those that may have been saved since."""
    found: list[Sequence[Any]] = [(head["version"], head["digest"])]
    for what, *given in steps:
        if what in ("saving", "saved"):
            found = [*(found if what == "saving" else ()), given]
    return found


def set_aside(path: Path | None) -> None:
    """Put what killed servers of this user have left out of the reach of who tidies up: where it is not saved, or of
    the workbook that is opened now. The processes of these sessions are waited for: they may still be saving.
    """
    for session, head in _find_left(PREFIX):
        with suppress(FileNotFoundError, ValueError):  # it is no journal
            try:
                with locked(session):
                    pass
            except OutputError:
                if path is not None and _is_of(head, path):
                    raise OutputError.about(
                        "{path} is still being saved by an assess open that was killed. Try again in a minute.",
                        path=path,
                    ) from None
            if _is_of(head, path) or _is_unsaved(session, head):
                session.rename(Path(tempfile.mkdtemp(prefix=TAKEN)) / session.name)


def put_back(path: Path | None, folder: Path) -> bool:
    """Have the latest session that was set aside be in a folder that is still empty; return whether there is one.

    That of a workbook of the disk, or for None of one that was held.
    """
    left = ((session / head["steps"], session) for session, head in _find_left(TAKEN) if _is_of(head, path))
    known = ((steps.stat().st_mtime_ns, session) for steps, session in left if steps.is_file())
    for _, session in sorted(known, reverse=True):
        lock = FolderLock(session.parent)
        is_free = lock.take() and session.is_dir()
        if is_free:
            folder.rmdir()
            session.rename(folder)
        lock.release()
        if is_free:
            session.parent.rmdir()
            return True
    return False


def _is_of(head: Mapping[str, Any], path: Path | None) -> bool:
    with suppress(OSError):
        return bool(head["path"]) and path.samefile(head["path"]) if path is not None else not head["path"]
    return False


def _is_unsaved(session: Path, head: Mapping[str, Any]) -> bool:
    _, steps = Journal(session).read(head)
    changes = sum(what not in ("saving", "saved") for what, *_ in steps)
    return bool(head["version"] + changes > list_saved(head, steps)[0][0])


def _find_left(start: str) -> Iterator[tuple[Path, dict[str, Any]]]:
    """Yield sessions of the own machine, and their heads, in folders of such names, while it has the lock on them."""
    for path in Path(tempfile.gettempdir()).glob(f"{start}*/*/{HEAD}"):
        session, server = path.parent, path.parent.parent
        lock = FolderLock(server)
        try:
            if is_ours(server) and lock.take() and lock.is_held:
                head = Journal(session).read_head()
                if head.get("is_own"):
                    yield session, head
        finally:
            lock.release()
