"""Starting and ending: the socket, uvicorn, signals, folders; saving and ending sessions while the server runs."""

import ipaddress
import os
import secrets
import signal
import socket
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import uvicorn

from assess.delivery.deliver import saving
from assess.errors import AssessError, InputError
from assess.web.endpoints import build_application
from assess.web.guard import Guard
from assess.web.importing import find_free
from assess.web.jobs import READING, Slots
from assess.web.sessions import ENTRANCE, HOSTED, Keys, Limits, Session

if TYPE_CHECKING:
    from assess.web.book import Book

LOOPBACK = "127.0.0.1"
SAVED_AFTER = 1.0
"""Time from the last change of a workbook to its being saved [s]; longer where saving itself takes long."""
SAVED_AT_LATEST = 3.0
"""Time from the first change that is not saved to its being saved, however much is changed after it [s]; as above."""
SAVED_AGAIN_AFTER = 3.0
"""Time after which saving that has failed is tried again [s]."""
SAVING_SHARE = 0.3
"""Most of the time that saving may take while a workbook is being changed [-]."""
LOOKED_EVERY = 60.0
"""Time between two looks for sessions that have ended [s]."""
HTTP = 80
GRACE = 2
"""Time that requests have to end once the server is to end [s]."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where the server listens: at any free port for 0; and in which language, if not that of workbook or browser.

    `allowed` are names by which browsers reach it through a proxy, with a port where that is not the usual one;
    `user_header` is the header in which the proxy names the user, blank on the own machine.
    """

    host: str = LOOPBACK
    port: int = 0
    allowed: tuple[str, ...] = ()
    user_header: str = ""
    language: str = ""

    @property
    def is_hosted(self) -> bool:
        """Whether users come through a proxy."""
        return bool(self.user_header)


@dataclass(frozen=True, slots=True)
class Ending:
    """How a server ended: the workbook of the disk that holds all changes, blank without one.

    `kept` are workbooks whose changes could not be saved in them, and the files in which they are kept; of those in
    `lost` the changes are lost.
    """

    saved: str = ""
    kept: list[tuple[str, str]] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)


def is_loopback(host: str) -> bool:
    """Tell whether an address is of this machine alone."""
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return host == "localhost"


def bind(place: Place) -> socket.socket:
    """Return a socket that listens; InputError if the port is taken, or the address is not one of this machine."""
    family = socket.AF_INET6 if ":" in place.host else socket.AF_INET
    listening = socket.socket(family, socket.SOCK_STREAM)
    try:
        if os.name == "posix":  # on Windows this would let two servers share a port
            listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind((place.host.strip("[]"), place.port))
        listening.listen(128)
    except OSError as error:
        listening.close()
        where = f"{place.host}:{place.port}"
        raise InputError.about(
            "port: {where} cannot be used: {why}. Choose another.", where=where, why=error.strerror or str(error)
        ) from None
    return listening


class Keeper(threading.Thread):
    """Saves workbooks of the disk a moment after their last change, and ends sessions."""

    def __init__(self, keys: Keys) -> None:
        super().__init__(name="assess-keeper", daemon=True)
        self._keys, self._due = keys, dict[Session, float]()
        self._latest = dict[Session, float]()
        self._took = 0.0  # by the last save [s]
        self._woken, self._is_ended = threading.Condition(), False
        self._next_look = time.monotonic() + LOOKED_EVERY

    def note_edit(self, session: Session) -> None:
        """Have a workbook be saved, once nothing more is changed for a moment, or soon."""
        if session.book is not None and session.book.mode == "disk":
            with self._woken:
                now, pause = time.monotonic(), self._took / SAVING_SHARE
                latest = self._latest.setdefault(session, now + max(SAVED_AT_LATEST, pause))
                self._due[session] = min(now + max(SAVED_AFTER, pause), latest)
                self._woken.notify()

    def end(self) -> None:
        """End, after what is being saved."""
        with self._woken:
            self._is_ended = True
            self._woken.notify()
        self.join()

    def run(self) -> None:
        """Save what is due and end sessions until the end."""
        while (sessions := self._wait()) is not None:
            for session in sessions:
                started = time.monotonic()
                session.save()
                self._took = time.monotonic() - started
                state = session.book.state() if session.book else {}
                if state.get("unsaved") and state["save_error"] and not state["changed_outside"]:
                    pause = max(SAVED_AGAIN_AFTER, self._took / SAVING_SHARE)  # what stood in the way may be gone
                    with self._woken:
                        self._due.setdefault(session, time.monotonic() + pause)
            if time.monotonic() >= self._next_look:
                self._next_look = time.monotonic() + LOOKED_EVERY
                self._keys.expire(time.monotonic())

    def _wait(self) -> list[Session] | None:
        with self._woken:
            while not self._is_ended:
                now = time.monotonic()
                due = [session for session, at in self._due.items() if at <= now]
                if due or now >= self._next_look:
                    for session in due:
                        del self._due[session]
                        self._latest.pop(session, None)
                    return due
                self._woken.wait(min([*self._due.values(), self._next_look]) - now)
        return None


class Server:
    """The page of one workbook, or of several users, until it is stopped."""

    def __init__(self, listening: socket.socket, place: Place, folder: Path, home: Path) -> None:
        self._listening, self._place = listening, place
        self.port = int(listening.getsockname()[1])
        limits = HOSTED if place.is_hosted else Limits()
        slots, reading_slots = Slots(limits.jobs), Slots(limits.jobs, READING)
        self._keys = Keys(place.user_header, self.port, lambda: Session(
            secrets.token_urlsafe(32), Path(tempfile.mkdtemp(prefix="session-", dir=folder)),
            None if place.is_hosted else home, limits, slots=slots, reading_slots=reading_slots,
            language=place.language,
        ), limits)  # fmt: skip
        names = (LOOPBACK, "localhost", "[::1]")
        hosts = [*(f"{name}:{self.port}" for name in names), *(names[:2] if self.port == HTTP else ())]
        schemes = ["http"]
        if place.is_hosted:
            hosts, schemes = list(place.allowed), ["http", "https"]
        self._keeper = Keeper(self._keys)
        application = build_application(self._keeper.note_edit)
        config = uvicorn.Config(Guard(application, self._keys, hosts, schemes), access_log=False, log_config=None,
                                log_level="critical", lifespan="off", ws="none", http="h11", loop="asyncio",
                                server_header=False, date_header=False, proxy_headers=False,
                                timeout_graceful_shutdown=GRACE, timeout_keep_alive=30)  # fmt: skip
        self._uvicorn = _Uvicorn(config)

    def take(self, book: "Book") -> str:
        """Open a workbook in the session of the own machine; return what its user should know, blank without."""
        return self._keys.sessions()[0].take(book).remark

    def issue_address(self) -> str:
        """Return an address that opens the page once, in one browser; where a proxy is in front, its way in."""
        host = f"[{self._place.host}]" if ":" in self._place.host else self._place.host
        ticket = f"{ENTRANCE}?t={self._keys.issue()}" if not self._place.is_hosted else "/"
        return f"http://{host}:{self.port}{ticket}"

    def run(self, signals: Sequence[int], started: Callable[[], None]) -> Ending:
        """Answer requests until one of `signals` comes; save what there is to save.

        `started` is called at once: who asks while the server begins waits for it, as the socket listens already.
        """

        def stop(_number: int, _frame: object = None) -> None:
            """Have the first signal end the server, and the next one no longer wait for requests."""
            self._uvicorn.force_exit = self._uvicorn.should_exit
            self._uvicorn.should_exit = True

        before = {number: signal.getsignal(number) for number in signals}
        with ExitStack() as stack:
            for number, handler in before.items():
                if handler not in (signal.SIG_IGN, None):
                    stack.callback(signal.signal, number, handler)
                    signal.signal(number, stop)
            self._keeper.start()
            try:
                started()
                self._uvicorn.run(sockets=[self._listening])
            finally:
                self._keeper.end()
                ending = self._save_all()
                for session in self._keys.sessions():
                    session.close()
        return ending

    def _save_all(self) -> Ending:
        ending = Ending()
        for session in self._keys.sessions():
            book = session.book
            if book is None:
                continue
            session.save()
            is_unsaved = book.state()["unsaved"] and (book.mode == "disk" or session.downloaded != book.version)
            path = _keep_changes(book, session.home) if is_unsaved and not self._place.is_hosted else None
            if path is not None:
                ending.kept.append((book.name, str(path)))
            elif is_unsaved:
                ending.lost.append(book.name)
            elif book.mode == "disk":
                ending = replace(ending, saved=book.name)
        return ending


class _Uvicorn(uvicorn.Server):
    """A server that leaves signals to us."""

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Leave signals alone."""
        yield


def _keep_changes(book: "Book", home: Path | None) -> Path | None:
    """Write a workbook, with its changes, under a new name: next to its file, else where one may; None if nowhere."""
    with suppress(AssessError):
        data = book.write()
        for folder in filter(None, (book.path and book.path.parent, home, Path.home())):
            with suppress(OSError):
                path = folder / find_free(f"{Path(book.name).stem}-changes{Path(book.name).suffix}", folder)
                with saving(path) as part:
                    part.write_bytes(data)
                return path
    return None
