"""Starting and ending: the socket, uvicorn, signals, folders; saving and ending sessions while the server runs."""

import ipaddress
import os
import signal
import socket
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import uvicorn

from assess.errors import InputError
from assess.i18n import fill
from assess.web.connections import limit_silence
from assess.web.front import Front
from assess.web.guard import Guard
from assess.web.journal import put_back
from assess.web.limits import OWN, Limits
from assess.web.users import ENTRANCE, Keys, User
from assess.web.workers import Link, Process, WorkerGoneError, ask_own, measure_memory

LOOPBACK = "127.0.0.1"
Start = Callable[[Path, Mapping[str, Any]], Link]
"""Starts the process of a session in its folder, with its order."""
SESSION = "session-"
"""Beginning of the name of the folder of a session."""
LOOKED_EVERY = 20.0
"""Longest time between two looks for sessions that have ended, and processes that are idle [s]."""
HTTP = 80
GRACE = 2
"""Time that requests have to end once the server is to end [s]."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where the server listens: at any free port for 0; and in which language, if not that of workbook or browser.

    `allowed` are names by which browsers reach it through a proxy, with a port where that is not the usual one;
    `user_header` is the header in which the proxy names the user, blank on the own machine; `limits` what all may take;
    `stays`: whether sessions stay on the disk, for a server that is started later.
    """

    host: str = LOOPBACK
    port: int = 0
    allowed: tuple[str, ...] = ()
    user_header: str = ""
    language: str = ""
    limits: Limits = OWN
    stays: bool = False

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


class Server:
    """The page of one workbook, or of several users, until it is stopped."""

    def __init__(
        self, listening: socket.socket, place: Place, folder: Path, home: Path, start: Start = Process
    ) -> None:
        self._listening, self._place = listening, place
        self.port = int(listening.getsockname()[1])
        limits = place.limits
        order = {"home": "" if place.is_hosted else str(home), "limits": asdict(limits), "language": place.language,
                 "server": os.getpid()}  # fmt: skip

        def make(own: Path | None = None) -> User:
            session = own or Path(tempfile.mkdtemp(prefix=SESSION, dir=folder))
            return User(session, lambda where: start(where, order), stays=place.stays)

        kept = [make(one) for one in sorted(folder.glob(f"{SESSION}*"))] if place.stays else []
        self._keys = Keys(place.user_header, self.port, make, limits, kept=kept)
        names = (LOOPBACK, "localhost", "[::1]")
        hosts = [*(f"{name}:{self.port}" for name in names), *(names[:2] if self.port == HTTP else ())]
        schemes = ["http"]
        if place.is_hosted:
            hosts, schemes = list(place.allowed), ["http", "https"]
        guard = Guard(Front(limits, self._keys.users), self._keys, hosts, schemes, limits.silence)
        config = uvicorn.Config(guard, access_log=False, log_config=None,
                                log_level="critical", lifespan="off", ws="none", loop="asyncio",
                                http=limit_silence(limits.silence),
                                server_header=False, date_header=False, proxy_headers=False,
                                timeout_graceful_shutdown=GRACE, timeout_keep_alive=30)  # fmt: skip
        self._uvicorn = _Uvicorn(config)

    def open(self, path: Path | None) -> list[str]:
        """Open a workbook in the session of the own machine; return what its user should know.

        What a killed server has left of it is taken over; without a `path`, of a workbook that was held.
        """
        (user,) = self._keys.users()
        is_left = put_back(path, user.folder)
        user.drop_bodies()
        if is_left or path is not None:
            user.link = user.start(user.folder)
        if path is None or user.link is None:
            return [fill("The workbook that was open when assess was ended is open again.")] if is_left else []
        remarks: list[str] | None = ask_own(user.link, "open", path=str(path.absolute()))["remarks"]
        if remarks is None:
            from assess.web.book import Book

            Book.open_disk(path)  # it raises why
            raise InputError.about("{path} cannot be opened.", path=path)
        return remarks

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
            ended = threading.Event()
            threading.Thread(target=self._watch, args=(ended,), name="assess-watch", daemon=True).start()
            try:
                started()
                self._uvicorn.run(sockets=[self._listening])
            finally:
                ended.set()
                ending = self._end()
        return ending

    def _watch(self, ended: threading.Event) -> None:
        limits = self._place.limits
        while not ended.wait(min(LOOKED_EVERY, limits.sleep / 4)):
            now = time.monotonic()
            self._keys.expire(now)
            users = sorted(self._keys.users(), key=lambda one: one.seen)
            idle = [one for one in users if one.is_awake and not one.busy]
            total = sum(measure_memory(one.link.pid) for one in users if isinstance(one.link, Process))
            for user in idle:  # the longest idle first
                if now - user.seen > limits.sleep or total > limits.total:
                    own = measure_memory(user.link.pid) if isinstance(user.link, Process) else 0
                    total -= own if user.sleep() else 0

    def _end(self) -> Ending:
        ending, users = Ending(), self._keys.users()
        with ExitStack() as stack:
            for user, link in [(user, user.link) for user in users if user.link is not None]:
                if link.is_gone and not self._place.is_hosted:
                    user.link = user.start(user.folder)  # to save what it held
                timer = threading.Timer(min(self._place.limits.end, threading.TIMEOUT_MAX), link.kill)
                stack.callback(timer.cancel)
                timer.start()
            for user in users:
                with suppress(WorkerGoneError):
                    found = Ending() if user.link is None else Ending(**ask_own(user.link, "end"))
                    lost = [] if user.stays else found.lost
                    ending = Ending(found.saved or ending.saved, ending.kept + found.kept, ending.lost + lost)
                user.close(forget=False)
        return ending


class _Uvicorn(uvicorn.Server):
    """A server that leaves signals to us."""

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Leave signals alone."""
        yield
