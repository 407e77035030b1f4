"""What a session holds, on the disk: the workbook as it was opened, and every step since, so that no kill loses any.

A step is written before it is answered. A process that is started again reads the workbook and takes the steps again,
which brings it to the same version with the same history.
"""

import json
import secrets
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from assess.delivery.folders import is_left, is_ours
from assess.web.limits import PREFIX

HEAD = "book.json"
"""In the folder of a session: which workbook is open, and the names of the files that hold it and its steps."""
TAKEN = "assess-taken-"
"""Beginning of the name of the folder in which what a killed server has left waits for the next one."""


class Journal:
    """The journal in the folder of a session; one is kept, that of the workbook that is open."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._steps: Path | None = None

    def begin(self, data: bytes, files: Path, **book: Any) -> None:
        """Begin with a workbook as it was opened, or read again: its bytes, the folder of its files, and what it is."""
        name, before = secrets.token_hex(8), self.read_head()
        opened, steps = self._folder / f"opened-{name}", self._folder / f"steps-{name}"
        opened.write_bytes(data)
        steps.touch()
        own = self._folder.resolve()
        place = str(files.relative_to(own) if files.is_relative_to(own) else files)
        head = {**book, "files": place, "opened": opened.name, "steps": steps.name}
        part = self._folder / f"{HEAD}.part"
        part.write_text(json.dumps(head), encoding="utf-8")
        part.replace(self._folder / HEAD)
        self._steps = steps
        self._remove(before)

    def note(self, *step: Any) -> None:
        """Write a step."""
        if self._steps is not None:
            with self._steps.open("ab") as file:
                file.write(json.dumps(step).encode() + b"\n")

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


def take_left(path: Path | None) -> Path | None:
    """Return a folder with the session that a killed server of this user left, out of the reach of who tidies up.

    That of a workbook of the disk, or for None the latest of one that was held. None where there is none.
    """
    found = sorted(_find_left(path), key=lambda one: (one / HEAD).stat().st_mtime)
    if not found:
        return None
    taken = Path(tempfile.mkdtemp(prefix=TAKEN))
    shutil.move(found[-1], taken)
    return taken / found[-1].name


def put_back(left: Path, folder: Path) -> None:
    """Move what was left into the folder of a new session."""
    for one in left.iterdir():
        shutil.move(one, folder / one.name)
    shutil.rmtree(left.parent, ignore_errors=True)


def _find_left(path: Path | None) -> Iterator[Path]:
    for head in Path(tempfile.gettempdir()).glob(f"{PREFIX}*/*/{HEAD}"):
        session, server = head.parent, head.parent.parent
        with suppress(OSError, ValueError, KeyError):
            own = json.loads(head.read_text(encoding="utf-8"))["path"]
            is_wanted = not own if path is None else bool(own) and path.samefile(own)
            if is_wanted and not server.is_symlink() and is_ours(server) and is_left(server):
                yield session
