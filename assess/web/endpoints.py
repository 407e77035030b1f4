"""The Starlette application: addresses, bodies, answers and the status of what is refused."""

import json
import logging
import math
import shutil
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any
from urllib.parse import quote

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response
from starlette.routing import Route

from assess.errors import AssessError
from assess.i18n import fill, load_catalogue, speaking
from assess.web import answers
from assess.web.answers import Answer, Asked, Content
from assess.web.guard import MODELS, MOST_MODEL, MOST_SKIPPED, SESSION, skip_body
from assess.web.importing import SOURCE
from assess.web.request_errors import BAD_REQUEST, NOT_FOUND, TOO_LARGE, RequestError, describe_fault
from assess.web.sessions import Session, check_share
from assess.web.texts import COOKIE, choose_language

MOST_JSON = 32 * 2**20
"""Bytes of a request in JSON: a whole sheet that is pasted."""
MOST_FILE = 64 * 2**20
"""Bytes of a file that is sent."""
POLLED = ("/api/state", "/api/job", MODELS)
"""What a page asks by itself: it is not its user who asks."""
LOG = logging.getLogger("assess.web")

Handler = Callable[[Asked], Answer]

READ: dict[str, Handler] = {
    "/api/book": answers.describe_book,
    "/api/state": answers.describe_state,
    "/api/download": answers.download,
    "/api/live": answers.describe_live,
    "/api/routes": answers.describe_routes,
    "/api/plan": answers.describe_plan,
    "/api/picture": answers.find_picture,
    "/api/catalogue": answers.describe_catalogue,
    "/api/job": answers.describe_job,
    "/api/job/file/{name:path}": answers.find_job_file,
    "/api/job/report": answers.find_report,
    MODELS: answers.describe_import,
    "/api/start": answers.describe_start,
    "/api/texts": answers.describe_texts,
}
CHANGE: dict[str, Handler] = {
    "/api/edit": answers.edit,
    "/api/undo": answers.undo,
    "/api/redo": answers.redo,
    "/api/save": answers.save,
    "/api/reload": answers.reload,
    "/api/close": answers.close,
    "/api/what-if": answers.try_out,
    "/api/job": answers.simulate,
    "/api/job/cancel": answers.cancel,
    "/api/import/cancel": answers.cancel_import,
    "/api/import/open": answers.open_import,
    "/api/start": answers.start,
}
SEND: dict[str, Handler] = {"/api/upload": answers.upload, "/api/file": answers.add_file}


NoteEdit = Callable[[Session], None]
Take = Callable[[Request, Asked], Awaitable[Asked]]
"""Takes in the body of a request; RequestError or OSError where it cannot be taken."""


def build_application(note_edit: NoteEdit) -> Starlette:
    """Return the application; `note_edit` is called after every change of a workbook."""

    def route(path: str, method: str, take: Take, handler: Handler) -> Route:
        async def serve(request: Request) -> Response:
            asked, fault = _ask(request, note_edit), None
            try:
                asked = await take(request, asked)
            except (RequestError, OSError) as error:
                fault = error
            return await run_in_threadpool(_carry_out, handler, asked, fault)

        return Route(path, serve, methods=[method])

    routes = [route(path, "GET", _take_nothing, handler) for path, handler in READ.items()]
    routes += [route(path, "POST", _take_json, handler) for path, handler in CHANGE.items()]
    routes += [route(path, "POST", _take_file, handler) for path, handler in SEND.items()]
    routes += [route(MODELS, "POST", _take_model, answers.import_model)]
    routes += [Route("/{name:path}", _give_file, methods=["GET"])]
    return Starlette(routes=routes)


# ---------------------------------------------------------------- bodies


async def _take_nothing(_request: Request, asked: Asked) -> Asked:
    return asked


async def _take_json(request: Request, asked: Asked) -> Asked:
    return replace(asked, body=parse_body(await _read_body(request, MOST_JSON)))


async def _take_file(request: Request, asked: Asked) -> Asked:
    return replace(asked, data=await _read_body(request, MOST_FILE))


async def _read_body(request: Request, most: int) -> bytes:
    return b"".join([part async for part in _stream(request, most, partial(_check_size, most))])


async def _take_model(request: Request, asked: Asked) -> Asked:
    """Save a file that is too large for the memory in a folder of its own, one at a time."""
    session, place = asked.session, object()
    try:
        session.sending_slots.take(place)
        path, room = await run_in_threadpool(_make_room, session, request)
    except (RequestError, OSError):
        session.sending_slots.leave(place)
        await skip_body(request.receive)
        raise

    def check(size: int) -> None:
        _check_size(MOST_MODEL, size)
        check_share(size, room, session.limits)

    try:
        with path.open("xb") as file:
            async for part in _stream(request, min(room, MOST_MODEL), check):
                await run_in_threadpool(file.write, part)
    except BaseException:  # what is too large, or breaks off, leaves nothing
        shutil.rmtree(path.parent, ignore_errors=True)
        raise
    finally:
        session.sending_slots.leave(place)
    return replace(asked, file=path)


def _make_room(session: Session, request: Request) -> tuple[Path, int]:
    """Return where the body of a request goes, and how many bytes it may have: not every request tells its length."""
    room = session.find_room()
    check_share(int(request.headers.get("content-length", "0")), room, session.limits)
    return session.make_import_folder() / SOURCE, room


async def _stream(request: Request, most: int, check: Callable[[int], None]) -> AsyncIterator[bytes]:
    """Yield the body of a request in parts, up to `most` bytes; then `check` its size.

    What is too large is read to its end, so that the browser gets to the answer. Raises RequestError if it breaks off.
    """
    size = 0
    try:
        async for part in request.stream():
            size += len(part)
            if size > MOST_SKIPPED:
                break
            if size <= most:
                yield part
    except ClientDisconnect:
        raise RequestError(fill("The request broke off."), BAD_REQUEST) from None
    check(size)


def _check_size(most: int, size: int) -> None:
    if size > most:
        raise RequestError(fill("It is larger than {most:.0f} MB.", most=most / 2**20), TOO_LARGE)


def parse_body(data: bytes) -> dict[str, Any]:
    """Return a JSON body, {} for an empty one.

    Raises RequestError if it is no JSON object, or holds what no workbook can: numbers that are not finite, halves of
    characters.
    """
    if not data:
        return {}
    try:
        found = json.loads(data, parse_constant=_refuse_constant)
        json.dumps(found, ensure_ascii=False, allow_nan=False).encode()
    except (ValueError, RecursionError):  # also UnicodeError, and a number such as 1e999
        found = None
    if not isinstance(found, dict):
        raise RequestError(fill("The request cannot be read."), BAD_REQUEST)
    return found


def _refuse_constant(name: str) -> None:
    raise ValueError(name)


# ---------------------------------------------------------------- answers


async def _give_file(request: Request) -> Response:
    found = await run_in_threadpool(answers.find_page_file, request.path_params["name"])
    if found is None:
        return _refuse(RequestError(fill("There is nothing at this address."), NOT_FOUND))
    return await run_in_threadpool(_respond, found)


def _ask(request: Request, note_edit: NoteEdit) -> Asked:
    session: Session = request.scope[SESSION]
    if request.url.path not in POLLED:
        session.seen = time.monotonic()
    language = session.language or (session.book.language if session.book else "")
    accepted = request.headers.get("accept-language", "")
    language = choose_language(request.cookies.get(COOKIE, ""), language, accepted)
    return Asked(session, {**request.query_params, **request.path_params}, language=language, note_edit=note_edit)


def _carry_out(handler: Handler, asked: Asked, fault: Exception | None) -> Response:
    with speaking(load_catalogue(asked.language)):
        try:
            if fault is not None:
                raise fault
            return _respond(handler(asked))
        except Exception as error:
            if not isinstance(error, AssessError | OSError):
                LOG.exception("a request failed")
            return _refuse(error)


def _refuse(error: Exception) -> Response:
    status, body = describe_fault(error)
    return Response(to_json(body), status, media_type="application/json")


def _respond(answer: Answer) -> Response:
    if not isinstance(answer, Content):
        return Response(to_json(answer), media_type="application/json")
    data = answer.data.read_bytes() if isinstance(answer.data, Path) else answer.data
    headers = dict(answer.headers)
    if answer.name:
        headers["content-disposition"] = f"attachment; filename*=UTF-8''{quote(answer.name, safe='')}"
    return Response(data, media_type=answer.media_type, headers=headers)


def to_json(body: dict[str, Any]) -> bytes:
    """Return JSON; a number that is not finite is null."""
    try:
        text = json.dumps(body, ensure_ascii=False, allow_nan=False, separators=(",", ":"), default=_simplify)
    except ValueError:
        text = json.dumps(_finite(body), ensure_ascii=False, allow_nan=False, separators=(",", ":"), default=_simplify)
    return text.encode("utf-8", "replace")


def _simplify(value: Any) -> Any:
    """Return a number of numpy, or rows of them, as Python's own."""
    found = value.tolist() if hasattr(value, "tolist") else str(value)
    return _finite(found)


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _finite(one) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
