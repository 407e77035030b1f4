"""The simulation of a session: a process of its own, how far it is, and what it leaves."""

import io
import json
import logging
import os
import secrets
import shutil
import subprocess
import sys
import threading
import zipfile
from collections.abc import Mapping, Sequence
from contextvars import copy_context
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from assess.i18n import Text, fill, gettext
from assess.web.job_inputs import list_stale, prepare
from assess.web.job_process import INPUT, OUT, SUMMARY
from assess.web.request_errors import CONFLICT, NOT_FOUND, TOO_MANY, RequestError

if TYPE_CHECKING:
    from assess.model import Inventory
    from assess.web.book import Book

PATIENCE = 0.5
"""Time that the process has to end by itself before it is killed [s]."""
ARCHIVE = "report.zip"
"""The name under which all files are given at once."""
REPORT = "report.html"
TEMPORARY, ERRORS = "tmp", "errors.txt"
MOST_SHOWN = 4000
"""Characters of what a process that broke down has written."""
LOG = logging.getLogger("assess.web")
STAGES: Mapping[str, Text] = {
    "": fill("Starting"),
    "reading": fill("Reading"),
    "motions": fill("Preparing motions"),
    "verification": fill("Simulating"),
    "rocking": fill("Simulating"),
    "routes": fill("Evaluating routes"),
    "rendering": fill("Writing reports"),
}
"""What the stages are called; others by their own names."""
BUSY = fill("Other simulations are running. Try again in some minutes.")
READING = fill("Other building models are being read. Try again in a minute.")
"""Why there is no place for another."""


class Slots:
    """How many jobs may run at once, in all sessions; `refusal` says why there is no place."""

    def __init__(self, most: int, refusal: Text = BUSY) -> None:
        self._most, self._refusal = most, refusal
        self._running, self._lock = set[object](), threading.Lock()

    def take(self, job: object) -> None:
        """Take a place; RequestError where there is none."""
        with self._lock:
            if len(self._running) >= self._most:
                raise RequestError(self._refusal, TOO_MANY)
            self._running.add(job)

    def leave(self, job: object) -> None:
        """Give a place back."""
        with self._lock:
            self._running.discard(job)


@dataclass(slots=True)
class _Progress:
    state: str = "running"
    stage: str = ""
    detail: str = ""
    share: float = 0.0
    seconds_left: float | None = None
    message: str = ""
    problems: list[dict[str, Any]] = field(default_factory=list)

    def take(self, said: Mapping[str, Any]) -> None:
        """Take in a line of the process; what it does not mention stays."""
        for name in ("state", "stage", "detail", "share", "seconds_left", "message", "problems"):
            if name in said:
                setattr(self, name, said[name])


class Job:
    """One simulation of one version of a workbook.

    Raises InputError if an option cannot be used, the workbook has errors, or there is no place.

    Parameters
    ----------
    book : Book
        The workbook, which may be changed meanwhile.
    body : mapping
        What the page asked for.
    parent : Path
        The folder of the session, in which the job gets one of its own.
    slots : Slots
        Places of all sessions.
    """

    def __init__(self, book: "Book", body: Mapping[str, Any], parent: Path, slots: Slots) -> None:
        self.id, self._slots, self._lock = secrets.token_hex(8), slots, threading.RLock()
        self._folder = parent / f"job-{self.id}"
        self._progress, self._seen = _Progress(), _Seen()
        slots.take(self)
        try:
            self._folder.mkdir(mode=0o700)
            self._order, self._inventory = prepare(book, body, self._folder)
            self._process = _start(self._folder)
        except BaseException:
            slots.leave(self)
            shutil.rmtree(self._folder, ignore_errors=True)
            raise
        self._reader = threading.Thread(target=copy_context().run, args=(self._listen,), name="assess-job", daemon=True)
        self._reader.start()

    @property
    def is_running(self) -> bool:
        """Whether it has not ended yet."""
        return self._progress.state == "running"

    # ------------------------------------------------------------ its course

    def _listen(self) -> None:
        lost = fill("The simulation ended unexpectedly; memory may have run out. Nothing was written.")
        last: dict[str, Any] = {"state": "failed", "message": gettext(lost)}
        if self._process.stdout is None:
            raise RuntimeError("the process has no output")
        for line in self._process.stdout:
            said = json.loads(line)
            if "state" in said:
                last = said
            elif self.is_running:
                self._progress.take(said)
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                stream.close()
        self._slots.leave(self)
        with self._lock:
            if self.is_running:
                self._progress.take(last)
            self._clean(is_done=self._progress.state == "done")

    def _clean(self, *, is_done: bool) -> None:
        """Remove all that is no result; what a process wrote that broke down is shown in the window of the server."""
        if self._progress.state == "failed" and not self._progress.problems and (said := self._read_errors()):
            LOG.error("a simulation ended with:\n%s", said)
        for name in (TEMPORARY, INPUT) if is_done else ("",):
            shutil.rmtree(self._folder / name, ignore_errors=True)

    def _read_errors(self) -> str:
        try:
            return (self._folder / ERRORS).read_text(encoding="utf-8", errors="replace")[-MOST_SHOWN:]
        except OSError:
            return ""

    def cancel(self) -> None:
        """End it at once and remove what it has written."""
        with self._lock:
            if not self.is_running:
                return
            self._progress.state = "cancelled"
        self._process.terminate()
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
        self._reader.join(timeout=2 * PATIENCE)

    def close(self) -> None:
        """End it, and remove its results as well."""
        self.cancel()
        self._reader.join(timeout=2 * PATIENCE)
        shutil.rmtree(self._folder, ignore_errors=True)

    # ------------------------------------------------------------ what the page is told

    def summarise(self) -> dict[str, Any]:
        """Return what the page shows of it wherever it is."""
        with self._lock:
            now, version = self._progress, self._order["version"]
            label = gettext(STAGES.get(now.stage, now.stage.capitalize()))
            return {"id": self.id, "state": now.state, "label": label, "share": now.share, "version": version}

    def describe(self, book: "Book | None") -> dict[str, Any]:
        """Return all that the page shows; `book` is the workbook as it is now."""
        with self._lock:
            now, order = self._progress, self._order
            is_old = book is None or book.version != order["version"]
            return {
                **self.summarise(),
                "stage": now.stage,
                "detail": now.detail,
                "seconds_left": now.seconds_left,
                "is_old": is_old,
                "stale": self._seen.list_stale(self._inventory, book) if is_old and book else [],
                "message": now.message,
                "problems": now.problems,
                "formats": order["formats"],
                "settings": order["settings"],
                "files": self._list_files(),
                **self._read_summary(),
            }

    def _read_summary(self) -> dict[str, Any]:
        if self._progress.state != "done":
            return {"items": None, "before_after": None}
        found: dict[str, Any] = json.loads((self._folder / SUMMARY).read_text(encoding="utf-8"))
        return found

    def _list_files(self) -> list[dict[str, Any]]:
        paths = self._list_paths()
        listed = [{"name": path.name, "bytes": path.stat().st_size} for path in paths]
        return [*listed, {"name": ARCHIVE, "bytes": sum(path.stat().st_size for path in paths)}] if listed else []

    def _list_paths(self) -> Sequence[Path]:
        if self._progress.state != "done":
            return ()
        return sorted(path for path in (self._folder / OUT).iterdir() if path.is_file() and path.name[0] != ".")

    def find_file(self, name: str) -> Path | bytes:
        """Return a file of its results, or all in one archive; RequestError where there is none of this name."""
        with self._lock:
            paths = {path.name: path for path in self._list_paths()}
            if name == ARCHIVE and paths:
                stream = io.BytesIO()
                with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
                    for path in paths.values():
                        archive.write(path, path.name)
                return stream.getvalue()
        if name not in paths:
            raise RequestError(fill("The simulation has no file of this name."), NOT_FOUND)
        return paths[name]


class _Seen:
    """The rows that changed since the simulation, found once for each version of the workbook."""

    def __init__(self) -> None:
        self._version, self._rows = -1, list[int]()

    def list_stale(self, before: "Inventory", book: "Book") -> list[int]:
        snapshot = book.snapshot()
        if snapshot.version != self._version:
            self._version, self._rows = snapshot.version, list_stale(before, snapshot.inventory)
        return self._rows


def check_free(job: Job | None) -> None:
    """Raise RequestError while a job runs."""
    if job is not None and job.is_running:
        raise RequestError(fill("A simulation is running already."), CONFLICT)


_OWN_GROUP: int = getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0)
"""Windows only; elsewhere the process gets a session of its own."""


def _start(folder: Path) -> "subprocess.Popen[bytes]":
    """Start the process: with temporary files in its own folder, and out of the reach of a Ctrl-C in the terminal."""
    temporary = folder / TEMPORARY
    temporary.mkdir()
    root = str(Path(__file__).parents[2])
    paths = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH"))))
    variables = {"TMPDIR": temporary, "TEMP": temporary, "TMP": temporary, "PYTHONPATH": paths, "PYTHONSAFEPATH": "1"}
    with (folder / ERRORS).open("wb") as errors:
        return subprocess.Popen(  # noqa: S603 - our own module, in a folder that we named
            [sys.executable, "-m", "assess.web.job_process", str(folder)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors, cwd=folder, creationflags=_OWN_GROUP,
            env={**os.environ, **{name: str(value) for name, value in variables.items()}}, start_new_session=True,
        )  # fmt: skip
