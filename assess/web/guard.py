"""What every request must satisfy before anything else sees it, and the headers of every answer. Plain ASGI.

In this order: the request names a host that is ours, else 421 (a foreign name may lead to this address); it has a
session, or comes in by its entrance, else 401; it changes something only if it comes from our page, else 403; its body
is not larger than anything that is accepted, else 413.
"""

import asyncio
import json
from collections.abc import AsyncIterator, Collection, Mapping
from contextlib import suppress
from html import escape

from starlette.requests import HTTPConnection
from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from assess.i18n import Text, fill, gettext, load_catalogue, speaking
from assess.web.limits import MOST, MOST_MODEL, SMALL, say_large
from assess.web.request_errors import (
    BAD_REQUEST,
    FORBIDDEN,
    NO_SESSION,
    TIMEOUT,
    TOO_LARGE,
    WRONG_HOST,
    RequestError,
)
from assess.web.texts import COOKIE, choose_language
from assess.web.users import ENTRANCE, Keys, User

MOST_SKIPPED = 2 * MOST_MODEL
"""Bytes of a body that is too large which are still read, so that the browser gets to the answer."""
COOKIE_AGE = 30 * 24 * 3600
"""Time that a browser keeps the cookie [s]; its key is void once the server has ended."""
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; "
    "font-src 'self'; frame-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS: Mapping[bytes, bytes] = {
    b"content-security-policy": POLICY.encode(),
    b"x-content-type-options": b"nosniff",
    b"referrer-policy": b"no-referrer",
    b"cross-origin-opener-policy": b"same-origin",
    b"cross-origin-resource-policy": b"same-origin",
    b"cache-control": b"no-store",
    b"x-frame-options": b"DENY",
    b"permissions-policy": b"camera=(), microphone=(), geolocation=(), payment=(), usb=()",
}
"""Headers of every answer; one that an answer sets by itself stays."""
READING = ("GET", "HEAD")
SESSION = "assess.session"
"""Where the session of a request stands in its scope."""
_TO_PAGE = '<meta http-equiv="refresh" content="0; url=/">'
_NO_ICON = '<link rel="icon" href="data:,">'
"""Browsers ask for an icon otherwise."""
_CLOSED = fill("This page is closed for this browser.")
_AGAIN = fill("Press Enter in the window in which assess runs: it opens the page again. Or start assess open again.")


class Guard:
    """Lets through what comes from our page and belongs to a session."""

    def __init__(
        self, app: ASGIApp, keys: Keys, hosts: Collection[str], schemes: Collection[str] = ("http",),
        silence: float = 20.0,
    ) -> None:  # fmt: skip
        self._app, self._keys, self._silence = app, keys, silence
        self._hosts = frozenset(host.lower() for host in hosts)
        self._origins = frozenset(f"{scheme}://{host}" for scheme in schemes for host in self._hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or hand it on."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008})
        elif scope["type"] == "http":

            async def send_on(message: Message) -> None:
                if message["type"] == "http.response.start":
                    own = {name.lower() for name, _ in message.get("headers", ())}
                    added = [(name, value) for name, value in HEADERS.items() if name not in own]
                    message = {**message, "headers": [*message.get("headers", ()), *added]}
                await send(message)

            answer = await self._refuse(HTTPConnection(scope), receive) or self._app
            await answer(scope, receive, send_on)

    async def _refuse(self, visit: HTTPConnection, receive: Receive) -> Response | None:
        """Return the answer to a request that does not get any further; None of one that does, in its session."""
        hosts, path = visit.headers.getlist("host"), visit.scope["path"]
        if len(hosts) != 1 or hosts[0].lower() not in self._hosts:
            return _refuse(visit, WRONG_HOST, fill("This server does not answer to that name."))
        session = self._keys.find(visit)
        if session is None or path == ENTRANCE:
            return self._enter(visit, session)
        site = visit.headers.get("sec-fetch-site", "same-origin")
        if visit.scope["method"] in READING:  # which may also be a visit, such as a link
            is_visit = visit.headers.get("sec-fetch-dest") == "document" and path == "/"
            is_ours = site in ("same-origin", "none") or is_visit
        else:
            is_own = visit.headers.get("origin", "") in self._origins
            is_ours = site == "same-origin" and is_own and "x-assess" in visit.headers
        if not is_ours:
            return _refuse(visit, FORBIDDEN, fill("The request does not come from this page."))
        length = visit.headers.get("content-length", "0")
        size = int(length) if length.isascii() and length.isdigit() and len(length) < 20 else MOST_MODEL + 1
        if size > MOST.get(path, SMALL):
            await skip_body(receive, self._silence)
            return _refuse(visit, TOO_LARGE, say_large(MOST.get(path, SMALL)))
        visit.scope[SESSION] = session
        return None

    def _enter(self, visit: HTTPConnection, session: User | None) -> Response:
        """Let a first request in, or lead to the page; not by a redirect, which would lose a strict cookie."""
        is_visit = visit.scope["method"] == "GET" and "sec-purpose" not in visit.headers  # no browser looking ahead
        try:
            admitted = self._keys.admit(visit) if is_visit else None
        except RequestError as error:
            return _refuse(visit, error.status, error.message)
        if (session or admitted) is None or not is_visit:
            return _refuse(visit, NO_SESSION, _CLOSED, _AGAIN)
        answer = Response(
            f'<!DOCTYPE html><html lang="en"><meta charset="utf-8">{_TO_PAGE}{_NO_ICON}<title>assess</title></html>',
            media_type="text/html",
        )
        if admitted is not None:
            secure = "; Secure" if visit.headers.get("x-forwarded-proto") == "https" else ""
            cookie = f"{self._keys.cookie}={admitted.key}; HttpOnly; SameSite=Strict; Path=/; Max-Age={COOKIE_AGE}"
            answer.headers["set-cookie"] = cookie + secure
        return answer


async def read_parts(receive: Receive, silence: float) -> AsyncIterator[bytes]:
    """Yield the body of a request in parts; RequestError if it breaks off, or nothing comes for so long [s]."""
    is_more = True
    while is_more:
        try:
            async with asyncio.timeout(silence):
                message = await receive()
        except TimeoutError:
            text = fill("Nothing of the request came for {seconds:.0f} s.", seconds=silence)
            raise RequestError(text, TIMEOUT) from None
        if message["type"] == "http.disconnect":
            raise RequestError(fill("The request broke off."), BAD_REQUEST)
        is_more = message.get("more_body", False)
        yield message.get("body", b"")


async def skip_body(receive: Receive, silence: float) -> None:
    """Read what is sent and is refused: a browser that is still sending when the connection ends shows no answer."""
    size = 0
    with suppress(RequestError):
        async for part in read_parts(receive, silence):
            size += len(part)
            if size > MOST_SKIPPED:
                break


def _refuse(visit: HTTPConnection, status: int, message: Text | str, fix: Text | str = "") -> Response:
    """Answer with a short page to a browser that wanted one, else as every request of the page is answered."""
    code = choose_language(visit.cookies.get(COOKIE, ""), "", visit.headers.get("accept-language", ""))
    with speaking(load_catalogue(code)):
        shown, fixed = gettext(message), gettext(fix)
    if any("text/html" in one for one in visit.headers.getlist("accept")):
        # a link of another site brings no strict cookie along: the browser asks once more from here
        is_linked = visit.headers.get("sec-fetch-site") in ("cross-site", "same-site")
        again = _TO_PAGE if status == NO_SESSION and visit.scope["path"] == "/" and is_linked else ""
        text = f"{again}<p>{escape(shown)}</p><p>{escape(fixed)}</p>"
        page = f'<!DOCTYPE html><html lang="{code}"><meta charset="utf-8"><title>assess</title>{text}</html>'
        return Response(page, status, media_type="text/html")
    return Response(json.dumps({"message": shown, "fix": fixed, "problems": []}), status, media_type="application/json")
