"""What every request must satisfy before anything else sees it, and the headers of every answer. Plain ASGI.

In this order: the request names a host that is ours, else 421 (a foreign name may lead to this address); it has a
session, or comes in by its entrance, else 401; it changes something only if it comes from our page, else 403; its body
is not larger than anything that is accepted, else 413.
"""

import json
from collections.abc import Collection, Mapping
from html import escape
from urllib.parse import parse_qsl

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from assess.i18n import Text, fill, gettext, load_catalogue, speaking
from assess.web.request_errors import FORBIDDEN, NO_SESSION, TOO_LARGE, WRONG_HOST, RequestError
from assess.web.sessions import ENTRANCE, Headers, Keys, Session, Visit
from assess.web.texts import COOKIE, choose_language

MOST_BODY = 64 * 2**20
"""Bytes of the largest body that a request may have, but for a building model; most may have less."""
MOST_MODEL = 256 * 2**20
"""Bytes of the largest building model."""
MODELS = "/api/import"
"""Where building models are sent."""
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


class Guard:
    """Lets through what comes from our page and belongs to a session."""

    def __init__(self, app: ASGIApp, keys: Keys, hosts: Collection[str], schemes: Collection[str] = ("http",)) -> None:
        self._app, self._keys = app, keys
        self._hosts = frozenset(host.lower().encode("latin-1") for host in hosts)
        self._origins = frozenset(scheme.encode() + b"://" + host for scheme in schemes for host in self._hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or hand it on."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008})
        elif scope["type"] == "http":
            await self._answer(scope, receive, _with_headers(send))

    async def _answer(self, scope: Scope, receive: Receive, send: Send) -> None:
        headers = _read_headers(scope)
        if headers.get(b"host", [b""])[0].lower() not in self._hosts or len(headers[b"host"]) != 1:
            await _refuse(scope, send, WRONG_HOST, fill("This server does not answer to that name."))
            return
        visit = _read_visit(scope, headers)
        session = self._keys.find(visit)
        if session is None or visit.path == ENTRANCE:
            await self._enter(scope, send, visit, session)
        elif not self._is_ours(scope["method"], visit):
            await _refuse(scope, send, FORBIDDEN, fill("The request does not come from this page."))
        elif _read_length(headers) > (MOST_MODEL if visit.path == MODELS else MOST_BODY):
            await _skip_body(receive)
            await _refuse(scope, send, TOO_LARGE, fill("The file is too large."))
        else:
            await self._app({**scope, SESSION: session}, receive, send)

    async def _enter(self, scope: Scope, send: Send, visit: Visit, session: Session | None) -> None:
        """Have a first request come in, with a cookie from then on; one that has it already is led to the page."""
        is_visit = scope["method"] == "GET" and b"sec-purpose" not in visit.headers  # no browser looking ahead
        try:
            admitted = self._keys.admit(visit) if is_visit else None
        except RequestError as error:
            await _refuse(scope, send, error.status, error.args[0])
            return
        if (session or admitted) is None or not is_visit:
            await _refuse(scope, send, NO_SESSION, _CLOSED, _AGAIN)
            return
        is_secure = visit.headers.get(b"x-forwarded-proto", [b""])[0] == b"https"
        cookies = [_make_cookie(self._keys.cookie, admitted.key, is_secure)] if admitted else []
        await _lead_in(send, cookies)

    def _is_ours(self, method: str, visit: Visit) -> bool:
        """Tell whether a request comes from our page; what only reads may also be a visit, such as a link."""
        site = visit.headers.get(b"sec-fetch-site", [b"same-origin"])[0]
        if method in READING:
            is_visit = visit.headers.get(b"sec-fetch-dest", [b""])[0] == b"document" and visit.path == "/"
            return site in (b"same-origin", b"none") or is_visit
        origin = visit.headers.get(b"origin", [b""])
        return site == b"same-origin" and origin[0] in self._origins and b"x-assess" in visit.headers


_NO_ICON = '<link rel="icon" href="data:,">'
"""Browsers ask for an icon otherwise."""
_CLOSED = fill("This page is closed for this browser.")
_AGAIN = fill("Press Enter in the window in which assess runs: it opens the page again. Or start assess open again.")


def _read_headers(scope: Scope) -> Headers:
    headers: dict[bytes, list[bytes]] = {}
    for name, value in scope["headers"]:
        headers.setdefault(name.lower(), []).append(value)
    return headers


def _read_visit(scope: Scope, headers: Headers) -> Visit:
    query = dict(parse_qsl(scope.get("query_string", b"").decode("latin-1"), errors="replace"))
    return Visit(scope["path"], query, _read_cookies(headers), headers)


def _read_cookies(headers: Headers) -> dict[str, str]:
    """Return the cookies of a request; those of other servers on this machine may be of any form."""
    pairs = [one for line in headers.get(b"cookie", ()) for one in line.decode("latin-1").split(";")]
    return {name.strip(): value.strip() for name, sign, value in (one.partition("=") for one in pairs) if sign}


def _read_length(headers: Headers) -> int:
    text = headers.get(b"content-length", [b"0"])[0]
    return int(text) if text.isdigit() and len(text) < 20 else MOST_MODEL + 1


async def _skip_body(receive: Receive) -> None:
    """Read what is sent: a browser that is still sending when the connection ends shows no answer."""
    size, is_more = 0, True
    while is_more and size < MOST_SKIPPED:
        message = await receive()
        size += len(message.get("body", b""))
        is_more = message.get("more_body", False)


def _make_cookie(name: str, value: str, is_secure: bool) -> bytes:
    secure = "; Secure" if is_secure else ""
    return f"{name}={value}; HttpOnly; SameSite=Strict; Path=/; Max-Age={COOKIE_AGE}{secure}".encode("latin-1")


def _with_headers(send: Send) -> Send:
    async def send_on(message: Message) -> None:
        if message["type"] == "http.response.start":
            own = {name.lower() for name, _ in message.get("headers", ())}
            added = [(name, value) for name, value in HEADERS.items() if name not in own]
            message = {**message, "headers": [*message.get("headers", ()), *added]}
        await send(message)

    return send_on


async def _lead_in(send: Send, cookies: Collection[bytes]) -> None:
    """Send the browser to the page.

    Not by a redirect: where a link of another site led here, a browser would not send a strict cookie along with it.
    """
    body = b'<!DOCTYPE html><html lang="en"><meta charset="utf-8"><meta http-equiv="refresh" content="0; url=/">'
    body += f"{_NO_ICON}<title>assess</title></html>".encode()
    headers = [(b"content-type", b"text/html; charset=utf-8"), *((b"set-cookie", one) for one in cookies)]
    await _send(send, 200, headers, body)


async def _refuse(scope: Scope, send: Send, status: int, message: Text, fix: Text | str = "") -> None:
    """Answer with a short page to a browser that wanted one, else as every request of the page is answered."""
    code = _find_language(scope)
    with speaking(load_catalogue(code)):
        said, fixed = gettext(message), gettext(fix)
    if any(name == b"accept" and b"text/html" in value for name, value in scope["headers"]):
        kind = b"text/html; charset=utf-8"
        text = f"{_lead_again(scope, status)}<p>{escape(said)}</p><p>{escape(fixed)}</p>"
        body = f'<!DOCTYPE html><html lang="{code}"><meta charset="utf-8"><title>assess</title>{text}</html>'
    else:
        kind, body = b"application/json", json.dumps({"message": said, "fix": fixed, "problems": []})
    await _send(send, status, [(b"content-type", kind)], b"" if scope["method"] == "HEAD" else body.encode())


def _lead_again(scope: Scope, status: int) -> str:
    """Return what has a browser ask once more from here: a link of another site brings no strict cookie along."""
    site = _read_headers(scope).get(b"sec-fetch-site", [b""])[0]
    is_link = status == NO_SESSION and scope["path"] == "/" and site in (b"cross-site", b"same-site")
    return '<meta http-equiv="refresh" content="0; url=/">' if is_link else ""


def _find_language(scope: Scope) -> str:
    headers = _read_headers(scope)
    accepted = headers.get(b"accept-language", [b""])[0].decode("latin-1")
    return choose_language(_read_cookies(headers).get(COOKIE, ""), "", accepted)


async def _send(send: Send, status: int, headers: list[tuple[bytes, bytes]], body: bytes) -> None:
    headers = [*headers, (b"content-length", str(len(body)).encode())]
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": body})
