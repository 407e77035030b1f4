"""The sessions as the server has them: who may ask what, a private folder and a process each, and when they end.

On the own machine there is one session, and the address that was printed opens it once: its ticket becomes a cookie.
Behind a proxy that authenticates, every user whom the proxy names has a session of their own.
"""

import asyncio
import hmac
import json
import secrets
import shutil
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

from starlette.requests import HTTPConnection

from assess.i18n import fill
from assess.web.frames import Reply
from assess.web.limits import HOSTED, Limits
from assess.web.request_errors import TOO_MANY, RequestError
from assess.web.workers import Link, WorkerGoneError, ask_own

ENTRANCE = "/enter"
"""The path to which the printed address leads."""
COOKIE = "assess"
"""Beginning of the name of the cookie; browsers send cookies of a host to all its ports, so its end is the port."""
WHO = "user.json"
"""In the folder of a session that stays: its user, and its key."""
BODY = "body-"
"""Beginning of the name of a file that holds the body of a request."""
LONGEST_USER = 200
"""Characters of a name that a proxy may give."""
IN_WORK = 2
"""Requests of a session that are worked out at once, besides one of those that are answered at once, such as edits."""
T = TypeVar("T")


class User:
    """The session of one user; `key` is the value of its cookie.

    * `link`: its process, None until something is asked of it; `is_coming`, `is_ending`: it is being started, or ended;
      `is_asleep`: it was ended, and not killed.
    * `language`: that of its workbook.
    * `seen`: when its user last asked for anything.
    * `in_work`, `at_once`: places of requests, and of those that take no time; `waiting`: how many want one.
    * `is_sending`: whether a building model is being sent: one at a time.
    * `busy`: how many requests are in work; `last`: answers to what a page asks by itself, for when its process sleeps.
    * `stays`: whether its folder stays on the disk, for a server that is started later.
    """

    def __init__(self, folder: Path, start: Callable[[Path], Link], *, stays: bool = False) -> None:
        self.key, self.folder, self.start, self.stays = secrets.token_urlsafe(32), folder, start, stays
        self.link: Link | None = None
        self.is_coming = self.is_ending = self.is_asleep = False
        self.busy, self.last = 0, dict[str, Reply]()
        self.language, self.seen = "", time.monotonic()
        self.in_work, self.at_once = asyncio.Semaphore(IN_WORK), asyncio.Semaphore(1)
        self.waiting, self.is_sending, self.starting = 0, False, asyncio.Lock()
        self._pool = ThreadPoolExecutor(IN_WORK + 2, "assess-user")
        self.drop_bodies()

    def drop_bodies(self) -> None:
        """Remove the bodies of requests that a server which was killed has left."""
        for left in self.folder.glob(f"{BODY}*"):
            left.unlink(missing_ok=True)

    async def run(self, work: Callable[..., T], *args: object) -> T:
        """Return what work returns, in a thread of this session."""
        return await asyncio.get_running_loop().run_in_executor(self._pool, work, *args)

    @property
    def is_awake(self) -> bool:
        """Whether its process runs, or is on its way."""
        return self.is_coming or (self.link is not None and not self.link.is_gone)

    def sleep(self) -> bool:
        """End its process unless something runs in it; what it holds is on the disk. Return whether it has ended."""
        link = self.link
        with suppress(WorkerGoneError):
            if link is not None and not ask_own(link, "idle")["idle"]:
                return False
        self._end()
        return not self.is_awake

    def _end(self) -> None:
        if self.link is not None:
            self.is_ending = True
            self.link.close()  # it has its place until then
            self.is_ending, self.is_asleep = False, True

    def close(self, *, forget: bool = True) -> None:
        """End its process, and remove its folder unless that stays for a later server."""
        self._end()
        self._pool.shutdown(wait=False)
        if forget or not self.stays:
            shutil.rmtree(self.folder, ignore_errors=True)


def _is_same(one: str, other: str) -> bool:
    return bool(other) and hmac.compare_digest(one.encode("utf-8", "replace"), other.encode())


def _introduce(user: User, name: str) -> None:
    """Note whose session it is, for a server that is started later."""
    if user.stays:
        path = user.folder / WHO
        path.touch(mode=0o600)
        path.write_text(json.dumps({"user": name, "key": user.key}), encoding="utf-8")


def _recognise(user: User) -> str:
    """Return whose session it is, and take its key; "" where that is not known."""
    with suppress(OSError, ValueError, KeyError, TypeError):
        found = json.loads((user.folder / WHO).read_text(encoding="utf-8"))
        user.key = str(found["key"])
        return str(found["user"])
    return ""


class Keys:
    """The sessions, and who may come in.

    Without a `header` there is one session; whoever opens the address with a ticket first gets its cookie. Else every
    user whom a proxy names in that header has a session, and the page gets its cookie at the entrance.
    """

    def __init__(
        self, header: str, port: int, make: Callable[[], User], limits: Limits = HOSTED, *, kept: Sequence[User] = ()
    ) -> None:
        self.cookie, self._ticket = f"{COOKIE}-{port}", ""
        self._header, self._make, self._limits = header, make, limits
        self._users: dict[str, User] = {} if header else {"": make()}
        self._users |= {name: user for user in kept if (name := _recognise(user))}
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

    def find(self, visit: HTTPConnection) -> User | None:
        """Return the session of the user where the cookie is its own."""
        session = self._users.get(self._name(visit))
        return session if session and _is_same(visit.cookies.get(self.cookie, ""), session.key) else None

    def admit(self, visit: HTTPConnection) -> User | None:
        """Return the session of a ticket, void from then on, or of a user who opens the page, new if there is room."""
        user, path = self._name(visit), visit.scope["path"]
        with self._lock:
            if not self._header:
                if path != ENTRANCE or not _is_same(visit.query_params.get("t", ""), self._ticket):
                    return None
                self._ticket = ""
            elif path != "/" or not user:
                return None
            if user not in self._users:
                if len(self._users) >= self._limits.users:
                    raise RequestError(fill("Too many users have a workbook open. Try again later."), TOO_MANY)
                self._users[user] = self._make()
                _introduce(self._users[user], user)
            return self._users[user]

    def users(self) -> Sequence[User]:
        """Return all sessions."""
        with self._lock:
            return tuple(self._users.values())

    def expire(self, now: float) -> None:
        """End the sessions whose users have asked for nothing for too long; what they held is thrown away."""
        with self._lock:
            idle = [user for user, one in self._users.items() if now - one.seen > self._limits.idle]
            ended = [self._users.pop(user) for user in idle]
        for session in ended:
            session.close()
