"""Sessions: who may ask what, one workbook and one job each, a private folder, and when they end.

On the own machine there is one session, and the address that was printed opens it once: its ticket becomes a cookie.
Behind a proxy that authenticates, every user whom the proxy names has a session of their own.
"""

import hmac
import json
import os
import secrets
import shutil
import tempfile
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from starlette.requests import HTTPConnection

from assess.delivery.folders import is_left, is_ours
from assess.errors import AssessError
from assess.i18n import fill
from assess.web.file_names import make_safe
from assess.web.importing import Import, Routes
from assess.web.jobs import Job, Slots
from assess.web.request_errors import CONFLICT, NOT_FOUND, TOO_MANY, RequestError
from assess.web.starting import Made, build_workbook, place_files, place_workbook

if TYPE_CHECKING:
    from assess.web.book import Book
    from assess.web.live import LiveView

ENTRANCE = "/enter"
"""The path to which the printed address leads."""
COOKIE = "assess"
"""Beginning of the name of the cookie; browsers send cookies of a host to all its ports, so its end is the port."""
LONGEST_USER = 200
"""Characters of a name that a proxy may give."""
PREFIX = "assess-open-"
"""Beginning of the name of the folder of a server."""
NOTE = "opened.json"
"""In the folder of a session: which workbook it has open, and the process; other servers of the same user read it."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What one session and all of them may take: bytes of the files of one session, sessions and simulations at once.

    `idle` is the time without a request of its user after which a session ends [s].
    """

    bytes: int = 1_000_000_000
    sessions: int = 1
    jobs: int = 1
    idle: float = float("inf")


HOSTED = Limits(bytes=300_000_000, sessions=50, jobs=2, idle=12 * 3600.0)
"""Limits of a server for several users."""
SENDING = fill("Another building model is being sent. Wait until it has been received, then try again.")


@dataclass(slots=True, eq=False)
class Session:
    """What one user has open; `key` is the value of its cookie, `folder` is removed with it.

    * `home`: where new workbooks are made: the folder in which the command was started; None: they are only held.
    * `slots`, `reading_slots`, `sending_slots`: places of simulations and of building models, of all sessions; and of a
      model of this one while it is sent: one at a time, so that their bytes can be counted.
    * `reading`, `imported`: the building model that was sent last, until it is a workbook, and that of the workbook.
    * `seen`, `looked`: when its user last asked for anything, and when the file was last looked at.
    * `downloaded`: version of the workbook that was downloaded last.
    """

    key: str
    folder: Path
    home: Path | None = None
    limits: Limits = field(default_factory=Limits)
    book: "Book | None" = None
    live: "LiveView | None" = None
    job: Job | None = None
    slots: Slots = field(default_factory=lambda: Slots(1))
    reading: Import | None = None
    imported: Import | None = None
    reading_slots: Slots = field(default_factory=lambda: Slots(1))
    sending_slots: Slots = field(default_factory=lambda: Slots(1, SENDING))
    language: str = ""
    seen: float = field(default_factory=time.monotonic)
    looked: float = 0.0
    downloaded: int = 0
    lock: threading.RLock = field(default_factory=threading.RLock)

    def find_room(self) -> int:
        """Return how many bytes more this session may have."""
        return self.limits.bytes - sum(path.stat().st_size for path in self.folder.rglob("*") if path.is_file())

    def check_room(self, size: int, room: int | None = None) -> None:
        """Raise RequestError where so many bytes more are too many for one session; `room` is what it has left."""
        if size > (self.find_room() if room is None else room):
            most = self.limits.bytes / 1e6
            raise RequestError(fill("The files of this session have more than {most:.0f} MB.", most=most), TOO_MANY)

    def make_folder(self, kind: str) -> Path:
        """Return a new folder whose name begins so: of a building model, or of the files of a held workbook."""
        return Path(tempfile.mkdtemp(prefix=kind, dir=self.folder))

    def take(self, book: "Book") -> "Book":
        """Have a workbook be the open one; the one before is saved, if it is on the disk."""
        with self.lock:
            self.save()
            self.drop_book(kept=book.folder)
            self.book, self.downloaded = book, book.version
            if book.path is not None and self.folder.parent.name.startswith(PREFIX):
                other = _find_other(self.folder, book.path)
                note = json.dumps({"path": str(book.path.resolve()), "pid": os.getpid()})
                with suppress(OSError):  # it only serves a warning
                    (self.folder / NOTE).write_text(note, encoding="utf-8")
                if other is not None:
                    book.remark = fill(
                        "{name} is also open in another window that assess started (process {pid}). Use only one of "
                        "them, so that the changes of one do not stand in the way of the other's.",
                        name=book.name, pid=str(other),
                    )  # fmt: skip
        return book

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

    def read_model(self, folder: Path, name: str, routes: Routes = "none") -> None:
        """Read a building model in such a folder; an earlier one that is not opened is dropped."""
        with self.lock:
            if self.reading is not None:
                self.reading.close()
            self.reading = None
            self.reading = Import(folder, name, routes, self.reading_slots)

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

    def simulate(self, body: Mapping[str, Any]) -> None:
        """Start a simulation of the open workbook; the results of an earlier one are removed."""
        with self.lock:
            if self.job is not None and self.job.is_running:
                raise RequestError(fill("A simulation is running already."), CONFLICT)
            if self.book is None:
                raise RequestError(fill("No workbook is open."), NOT_FOUND)
            self.check_room(0)
            new = Job(self.book, body, self.folder, self.slots)
            if self.job is not None:
                self.job.close()
            self.job = new

    def save(self) -> None:
        """Save a workbook of the disk; what stands in the way is part of its state."""
        book = self.book
        with suppress(AssessError, OSError):
            if book is not None and book.mode == "disk" and book.state()["unsaved"]:
                book.save()

    def drop_book(self, kept: Path | None = None) -> None:
        """End with the workbook and its job, and remove the files of one that was held."""
        if self.job is not None:
            self.job.close()
        self.job = self.book = self.live = self.imported = None
        (self.folder / NOTE).unlink(missing_ok=True)
        for folder in self.folder.glob("files-*"):
            if folder.resolve() != kept:
                shutil.rmtree(folder, ignore_errors=True)

    def close(self) -> None:
        """End its job and remove its folder."""
        with self.lock:
            self.drop_book()
            if self.reading is not None:
                self.reading.close()
        shutil.rmtree(self.folder, ignore_errors=True)


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


def _is_same(one: str, other: str) -> bool:
    return bool(other) and hmac.compare_digest(one.encode("utf-8", "replace"), other.encode())


class Keys:
    """The sessions, and who may come in.

    Without a `header` there is one session; whoever opens the address with a ticket first gets its cookie. Else every
    user whom a proxy names in that header has a session, and the page gets its cookie at the entrance.
    """

    def __init__(self, header: str, port: int, make: Callable[[], Session], limits: Limits = HOSTED) -> None:
        self.cookie, self._ticket = f"{COOKIE}-{port}", ""
        self._header, self._make, self._limits = header, make, limits
        self._sessions: dict[str, Session] = {} if header else {"": make()}
        self._lock = threading.Lock()

    def issue(self) -> str:
        """Return a new ticket; an earlier one is void."""
        with self._lock:
            self._ticket = secrets.token_urlsafe(32)
            return self._ticket

    def _name(self, visit: HTTPConnection) -> str:
        """Return the user; blank where the header is missing, or there twice: then it is not the proxy's alone."""
        values = visit.headers.getlist(self._header) if self._header else []
        name = values[0].encode("latin-1").decode("utf-8", "replace").strip() if len(values) == 1 else ""
        return name if len(name) <= LONGEST_USER else ""

    def find(self, visit: HTTPConnection) -> Session | None:
        """Return the session of the user where the cookie is its own."""
        session = self._sessions.get(self._name(visit))
        return session if session and _is_same(visit.cookies.get(self.cookie, ""), session.key) else None

    def admit(self, visit: HTTPConnection) -> Session | None:
        """Return the session of a ticket, void from then on, or of a user who opens the page, new if there is room."""
        user, path = self._name(visit), visit.scope["path"]
        with self._lock:
            if not self._header:
                if path != ENTRANCE or not _is_same(visit.query_params.get("t", ""), self._ticket):
                    return None
                self._ticket = ""
            elif path != "/" or not user:
                return None
            if user not in self._sessions:
                if len(self._sessions) >= self._limits.sessions:
                    raise RequestError(fill("Too many users have a workbook open. Try again later."), TOO_MANY)
                self._sessions[user] = self._make()
            return self._sessions[user]

    def sessions(self) -> Sequence[Session]:
        """Return all sessions."""
        with self._lock:
            return tuple(self._sessions.values())

    def expire(self, now: float) -> None:
        """End the sessions whose users have asked for nothing for too long; what they held is thrown away."""
        with self._lock:
            idle = [user for user, one in self._sessions.items() if now - one.seen > self._limits.idle]
            ended = [self._sessions.pop(user) for user in idle]
        for session in ended:
            session.close()
