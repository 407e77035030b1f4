"""What one user has open, in the process of a session: a workbook and what it holds, imports, a simulation."""

import json
import shutil
import tempfile
import threading
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, ExitStack, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from assess.delivery.folders import is_left, is_ours
from assess.errors import AssessError
from assess.i18n import fill
from assess.web.file_names import make_safe
from assess.web.importing import FOLDER, ORDER, READING, SOURCE, Import, Routes
from assess.web.jobs import Runs
from assess.web.journal import Journal
from assess.web.limits import OWN, PREFIX, Limits, check_room, find_room
from assess.web.request_errors import NOT_FOUND, RequestError
from assess.web.simulating import SECONDS
from assess.web.slots import Slots, take
from assess.web.starting import Made, build_workbook, place_files, place_workbook

if TYPE_CHECKING:
    from assess.web.book import Book
    from assess.web.live import LiveView

DOWNLOADED = "downloaded"
"""In the folder of a session: the version of the workbook that was downloaded last."""
NOTE = "opened.json"
"""In the folder of a session: which workbook it has open, and the server; other servers of the same user read it."""


@dataclass(slots=True, eq=False)
class Session:
    """What one user has open; its `folder` lies in that of the server.

    * `home`: where new workbooks are made: the folder in which the command was started; None: they are only held.
    * `server`: the process of the server.
    * `reading`, `imported`: the building model that was sent last, until it is a workbook, and that of the workbook.
    * `looked`: when the file was last looked at.
    * `downloaded`: version of the workbook that was downloaded last.
    * `note_edit`: called after every change of the workbook.
    """

    folder: Path
    home: Path | None = None
    limits: Limits = OWN
    language: str = ""
    server: int = 0
    book: "Book | None" = None
    live: "LiveView | None" = None
    reading: Import | None = None
    imported: Import | None = None
    looked: float = 0.0
    downloaded: int = 0
    note_edit: Callable[[], None] = lambda: None
    lock: threading.RLock = field(default_factory=threading.RLock)
    runs: Runs = field(init=False)
    _journal: Journal = field(init=False)
    _slots: Slots = field(init=False)

    def __post_init__(self) -> None:
        self.runs = Runs(self.folder, self.limits)
        self._slots = Slots(self.folder.parent, "models", self.limits.models, READING)
        self._journal = Journal(self.folder, is_own=self.home is not None)

    def check_room(self, size: int) -> None:
        """Raise RequestError where so many bytes more are too many for one session."""
        check_room(size, find_room(self.folder, self.limits), self.limits)

    def make_folder(self, kind: str) -> Path:
        """Return a new folder whose name begins so: of a building model, or of the files of a held workbook."""
        return Path(tempfile.mkdtemp(prefix=kind, dir=self.folder))

    def take(self, book: "Book") -> "Book":
        """Have a workbook be the open one; the one before is saved, if it is on the disk."""
        with self.lock:
            self.save()
            self.drop_book(kept=book.folder)
            self._set(book)
            book.keep_in(self._journal)
            self.note_download(book.version)
            if book.path is not None and self.folder.parent.name.startswith(PREFIX):
                other = _find_other(self.folder, book.path)
                note = json.dumps({"path": str(book.path.resolve()), "pid": self.server})
                with suppress(OSError):  # it only serves a warning
                    (self.folder / NOTE).write_text(note, encoding="utf-8")
                if other is not None:
                    book.remark = fill(
                        "{name} is also open in another window that assess started (process {pid}). Use only one of "
                        "them, so that the changes of one do not stand in the way of the other's.",
                        name=book.name, pid=str(other),
                    )  # fmt: skip
        return book

    def _set(self, book: "Book") -> None:
        self.book = book
        book.simulator.limit(self._hold_place, min(self.limits.job_seconds, SECONDS))
        threading.Thread(target=_begin, args=(book,), name="assess-begin", daemon=True).start()

    def restore(self) -> None:
        """Open again what a process of this session held that was killed, or ended to save memory."""
        from assess.web.book import Book

        for folder in self.folder.glob(f"{FOLDER}*"):
            try:
                name, routes, number = json.loads((folder / ORDER).read_text(encoding="utf-8"))
                self.reading = Import(folder, name, routes, self._slots, number)
            except (AssessError, OSError, ValueError):
                shutil.rmtree(folder, ignore_errors=True)
        book = Book.restore(self._journal)
        if book is not None:
            with suppress(OSError, ValueError):
                self.downloaded = int((self.folder / DOWNLOADED).read_text())
            self._set(book)

    def note_download(self, version: int) -> None:
        """Note that a version was downloaded."""
        self.downloaded = version
        (self.folder / DOWNLOADED).write_text(str(version))

    def _hold_place(self) -> AbstractContextManager[object] | None:
        """Take a place among the sessions that simulate while one types."""
        place = take(self.folder.parent, "live", self.limits.simulations)
        stack = ExitStack()
        if place is not None:
            stack.callback(place.release)
        return None if place is None else stack

    def hold(self, name: str, data: bytes) -> "Book":
        """Open a workbook that was sent."""
        with self.lock:
            return self._open(Made(make_safe(name), data), None)

    def begin(self, body: Mapping[str, Any]) -> "Book":
        """Open a new workbook: in the folder of new workbooks where there is one, else held."""
        return self._open(build_workbook(body), self.home)

    def _open(self, made: Made, home: Path | None) -> "Book":
        from assess.web.book import Book

        if home is not None:
            return self.take(Book.open_disk(place_workbook(made, home)))
        self.check_room(len(made.data))
        folder = self.make_folder("files-")
        place_files(made, folder)
        return self.take(Book.hold(made.name, made.data, folder))

    def read_model(self, sent: Path | bytes, name: str, routes: Routes = "none") -> None:
        """Read a building model, which is removed then; an earlier one that is not opened is dropped."""
        with self.lock:
            if self.reading is not None:
                self.reading.close()
            self.reading = None
            folder = self.make_folder(FOLDER)
            if isinstance(sent, Path):
                sent.rename(folder / SOURCE)
            else:
                (folder / SOURCE).write_bytes(sent)
            self.reading = Import(folder, name, routes, self._slots)

    def cancel_import(self) -> None:
        """End the reading of a building model, or drop what was read."""
        with self.lock:
            if self.reading is not None:
                self.reading.close()
                self.reading = self.reading if self.reading.state == "cancelled" else None

    def open_imported(self, shaking: str) -> "Book":
        """Open a new workbook of the building model that was read."""
        with self.lock:
            if self.reading is None:
                raise RequestError(fill("No building model has been read."), NOT_FOUND)
            found = self.reading
            book = self._open(found.build(self.home or self.folder, shaking), self.home)
            found.note_opened(book.opening)
            self.reading, self.imported = None, found
            return book

    def begin_run(self, body: Mapping[str, Any]) -> None:
        """Begin a run of the open workbook as it is."""
        with self.lock:
            if self.book is None:
                raise RequestError(fill("No workbook is open."), NOT_FOUND)
            self.check_room(0)
            self.runs.begin(self.book, body)

    def save(self) -> None:
        """Save a workbook of the disk; what stands in the way is part of its state."""
        book = self.book
        with suppress(AssessError, OSError):
            if book is not None and book.mode == "disk" and book.state()["unsaved"]:
                book.save()

    def drop_book(self, kept: Path | None = None) -> None:
        """End with the workbook and its runs, and remove the files of one that was held."""
        if self.book is not None:
            self.book.simulator.close()
        self.runs.clear()
        self.book = self.live = self.imported = None
        self._journal.end()
        (self.folder / NOTE).unlink(missing_ok=True)
        for folder in self.folder.glob("files-*"):
            if folder.resolve() != kept:
                shutil.rmtree(folder, ignore_errors=True)

    def close(self) -> None:
        """End what runs; the workbook, and runs with results, are found by the next process of the session."""
        with self.lock:
            self.runs.close()
            if self.book is not None:
                self.book.simulator.close()
            if self.reading is not None:
                self.reading.close(is_kept=True)


def _begin(book: "Book") -> None:
    """Assess a workbook that was opened, and have it simulated, before a page asks for it."""
    from assess.web.evaluation import evaluate

    with suppress(AssessError, OSError):  # the page is told once it asks
        evaluate(book.snapshot(), routes=False)


def _find_other(session: Path, workbook: Path) -> int | None:
    """Return the process of another running server of this user that has a workbook open, None where there is none."""
    for note in session.parent.parent.glob(f"{PREFIX}*/*/{NOTE}"):
        with suppress(OSError, ValueError, KeyError, TypeError):
            folder = note.parent.parent
            if folder == session.parent or folder.is_symlink() or not is_ours(folder):
                continue
            found = json.loads(note.read_text(encoding="utf-8"))
            if Path(found["path"]).samefile(workbook) and not is_left(folder):
                return int(found["pid"])
    return None
