"""What the server does with a request that has come through the guard: its turn, its body, the process that answers it.

Nothing here works for long: what takes time is done in threads of the session's own, or in its process.
"""

import asyncio
import logging
import secrets
import time
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager, suppress
from dataclasses import replace
from pathlib import Path

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.types import Receive, Scope, Send

from assess.i18n import fill, load_catalogue, speaking
from assess.web.assets import answer_asset, find_asset
from assess.web.frames import Call, Reply
from assess.web.guard import MOST_SKIPPED, READING, SESSION, read_parts, skip_body
from assess.web.limits import MODELS, MOST, SMALL, Limits, check_room, check_size, find_room
from assess.web.request_errors import (
    NOT_FOUND,
    TIMEOUT,
    TOO_MANY,
    UNAVAILABLE,
    WRONG_METHOD,
    RequestError,
    describe_fault,
)
from assess.web.texts import COOKIE, choose_language
from assess.web.users import BODY, User
from assess.web.workers import Link, WorkerGoneError, ask_own

LOG = logging.getLogger("assess.web")
API = "/api/"
POLLED = ("/api/state", "/api/job", MODELS)
"""What a page asks by itself: it is not its user who asks."""
AT_ONCE = ("/api/edit", "/api/rows", "/api/undo", "/api/redo", "/api/job/cancel", "/api/import/cancel")
"""What takes no time, and does not wait for what does."""
MOST_WAITING = 20
"""Requests of a session that wait for their turn."""
ASKED_EVERY = 0.2
"""Time after which a place for a process is looked for again [s]."""
PART = 2**20
"""Bytes that are written at once."""
SENDING = fill("Another building model is being sent. Wait until it has been received, then try again.")


class Front:
    """Answers requests: files of the page here, all others in the process of their session. Plain ASGI."""

    def __init__(self, limits: Limits, users: Callable[[], Sequence[User]]) -> None:
        self._limits, self._users = limits, users

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request."""
        request, user = Request(scope, receive), scope[SESSION]
        try:
            response = await self._answer(request, user)
        except Exception as error:
            if not isinstance(error, RequestError | OSError):
                LOG.exception("a request failed")
            response = _refuse(request, user, error)
        await response(scope, receive, send)

    async def _answer(self, request: Request, user: User) -> Response:
        path: str = request.scope["path"]
        if not path.startswith(API):
            if request.method not in READING:
                raise RequestError(fill("This address does not answer to that method."), WRONG_METHOD)
            found = await user.run(find_asset, path.removeprefix("/"))
            if found is None:
                raise RequestError(fill("There is nothing at this address."), NOT_FOUND)
            return answer_asset(found, request.headers, request.query_params.get("v", ""))
        if path not in POLLED or request.method not in READING:
            user.seen = time.monotonic()
        elif (user.is_ending or user.is_asleep) and path in user.last:
            return _respond(user.last[path])
        async with _turn(user, path):
            call = await self._receive(request, user)
            try:
                reply = await self._ask(user, call)
            finally:
                if call.file:
                    Path(call.file).unlink(missing_ok=True)
        user.language = reply.language
        if path in POLLED and request.method in READING:
            user.last[path] = reply
        else:
            user.last.clear()
        return _respond(reply)

    async def _ask(self, user: User, call: Call) -> Reply:
        """Return the answer of the process of a session; one that ends meanwhile is started again, and asked again."""
        for _ in range(2):
            link = await self._wake(user)
            asked = asyncio.ensure_future(user.run(link.ask, call))
            seconds = self._limits.seconds
            done, _late = await asyncio.wait({asked}, timeout=seconds if seconds < float("inf") else None)
            if not done:
                link.kill()
                asked.add_done_callback(lambda found: found.exception())  # it is known that there is none
                text = fill("It takes more than {seconds:.0f} s, which is the limit here.", seconds=seconds)
                raise RequestError(text, UNAVAILABLE)
            with suppress(WorkerGoneError):
                return asked.result()
        raise RequestError(
            fill("The program behind your workbook ended unexpectedly; memory may have run out."), UNAVAILABLE
        )

    async def _wake(self, user: User) -> Link:
        """Return the process of a session, which is started where there is none, and ready to answer."""
        async with user.starting:
            link = user.link
            if link is None or link.is_gone:
                await self._make_place(user)
                user.is_coming, user.is_asleep = True, False
                try:
                    link = user.link = await user.run(user.start, user.folder)
                finally:
                    user.is_coming = False
                with suppress(WorkerGoneError):
                    await user.run(ask_own, link, "hello")
        return link

    async def _make_place(self, user: User) -> None:
        """End the process that has been idle for longest where there are as many as may be; wait where all work."""
        late = time.monotonic() + self._limits.wait
        while len(awake := [one for one in self._users() if one.is_awake and one is not user]) >= self._limits.workers:
            for idle in sorted((one for one in awake if not one.busy), key=lambda one: one.seen):
                if await idle.run(idle.sleep):
                    break  # another session may have taken the place by now
            else:
                if time.monotonic() > late:
                    raise RequestError(fill("Too many users are at work. Try again in a moment."), UNAVAILABLE)
                await asyncio.sleep(ASKED_EVERY)

    # ------------------------------------------------------------ bodies

    async def _receive(self, request: Request, user: User) -> Call:
        """Return a request with its body, or with the file of the session that holds it."""
        path, cookies = request.scope["path"], request.cookies
        method = "GET" if request.method in READING else request.method
        accepted, encoding = (request.headers.get(f"accept-{one}", "")[:200] for one in ("language", "encoding"))
        chosen = cookies.get(COOKIE, "")[:10]
        call = Call(method, path, dict(request.query_params), chosen=chosen, accepted=accepted, encoding=encoding)
        is_model = path == MODELS and method == "POST"
        if method == "GET":
            return call
        if is_model and user.is_sending:
            await skip_body(request.receive, self._limits.silence)
            raise RequestError(SENDING, TOO_MANY)
        user.is_sending |= is_model
        body = _Body(user, MOST.get(path, SMALL), self._limits)
        try:
            await body.read(request)
        except BaseException:
            body.drop()
            raise
        finally:
            user.is_sending &= not is_model
        return replace(call, data=bytes(body.held), file=str(body.path or ""))


class _Body:
    """The body of a request: what is larger than `SMALL` is written to a file, as long as the session has room."""

    def __init__(self, user: User, most: int, limits: Limits) -> None:
        self._user, self._most, self._limits = user, most, limits
        self._room = float("inf")
        self.held = bytearray()
        self.path: Path | None = None
        self._size = 0

    async def read(self, request: Request) -> None:
        """Read it to its end, so that the browser gets to the answer; RequestError if it is too large."""
        fault = await self._check(int(request.headers.get("content-length", "0")))  # not every request has it
        async for part in read_parts(request.receive, self._limits.silence):
            self._size += len(part)
            fault = fault or await self._check(self._size)
            if fault is None:
                await self._take(part)
            elif self._size > MOST_SKIPPED:
                break
        if fault is not None:
            raise fault
        if self.path is not None:
            await self._write(self.path)

    async def _check(self, size: int) -> RequestError | None:
        try:
            check_size(size, self._most)
            if size > SMALL and self._room == float("inf"):
                self._room = await self._user.run(find_room, self._user.folder, self._limits)
            check_room(size, self._room, self._limits)
        except RequestError as error:
            return error
        return None

    async def _take(self, part: bytes) -> None:
        self.held += part
        if self._size > SMALL and self.path is None:
            self.path = self._user.folder / f"{BODY}{secrets.token_hex(8)}"
        if len(self.held) > PART and self.path is not None:
            await self._write(self.path)

    async def _write(self, path: Path) -> None:
        def write(data: bytes) -> None:
            with path.open("ab") as file:
                file.write(data)

        data = bytes(self.held)
        self.held.clear()
        await self._user.run(write, data)

    def drop(self) -> None:
        """Remove its file."""
        if self.path is not None:
            self.path.unlink(missing_ok=True)


@asynccontextmanager
async def _turn(user: User, path: str) -> AsyncIterator[None]:
    """Wait for the turn of a request; RequestError where too many wait already."""
    places = user.at_once if path in AT_ONCE else user.in_work
    if user.waiting >= MOST_WAITING:
        raise RequestError(fill("Too many requests at once. Try again in a moment."), TOO_MANY)
    user.waiting += 1
    user.busy += 1
    try:
        await places.acquire()
    except BaseException:
        user.busy -= 1
        raise
    finally:
        user.waiting -= 1
    try:
        yield
    finally:
        user.busy -= 1
        places.release()


def _respond(reply: Reply) -> Response:
    response = Response(reply.data, reply.status)
    response.raw_headers = [(name.encode("latin-1"), value.encode("latin-1")) for name, value in reply.headers]
    return response


def _refuse(request: Request, user: User, error: Exception) -> Response:
    code = choose_language(request.cookies.get(COOKIE, ""), user.language, request.headers.get("accept-language", ""))
    with speaking(load_catalogue(code)):
        status, body = describe_fault(error)
    return JSONResponse(body, status, {"connection": "close"} if status == TIMEOUT else None)
