"""The Starlette application: addresses, bodies, answers and the status of what is refused."""

import json
import logging
import math
import shutil
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any
from urllib.parse import quote

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from assess.errors import AssessError
from assess.i18n import fill, load_catalogue, speaking
from assess.web import answers
from assess.web.answers import Answer, Asked, Content
from assess.web.guard import MODELS, MOST_MODEL, SESSION
from assess.web.importing import SOURCE
from assess.web.request_errors import NOT_FOUND, RequestError, describe_fault
from assess.web.sessions import Session, check_share
from assess.web.texts import COOKIE, choose_language
from assess.web.uploads import check_size, parse_body, read_body, save_body, skip_body

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


def build_application(note_edit: NoteEdit) -> Starlette:
    """Return the application; `note_edit` is called after every change of a workbook."""
    routes = [Route(path, partial(_read, note_edit, handler), methods=["GET"]) for path, handler in READ.items()]
    routes += [Route(path, partial(_change, note_edit, handler), methods=["POST"]) for path, handler in CHANGE.items()]
    routes += [Route(path, partial(_send, note_edit, handler), methods=["POST"]) for path, handler in SEND.items()]
    routes += [Route(MODELS, partial(_receive, note_edit, answers.import_model), methods=["POST"])]
    routes += [Route("/{name:path}", _give_file, methods=["GET"])]
    return Starlette(routes=routes)


async def _read(note_edit: NoteEdit, handler: Handler, request: Request) -> Response:
    return await run_in_threadpool(_carry_out, handler, _ask(request, note_edit))


async def _change(note_edit: NoteEdit, handler: Handler, request: Request) -> Response:
    try:
        body = parse_body(await read_body(request, MOST_JSON))
    except RequestError as error:
        return await run_in_threadpool(_carry_out, _fail(error), _ask(request, note_edit))
    return await run_in_threadpool(_carry_out, handler, replace(_ask(request, note_edit), body=body))


async def _send(note_edit: NoteEdit, handler: Handler, request: Request) -> Response:
    try:
        data = await read_body(request, MOST_FILE)
    except RequestError as error:
        return await run_in_threadpool(_carry_out, _fail(error), _ask(request, note_edit))
    return await run_in_threadpool(_carry_out, handler, replace(_ask(request, note_edit), data=data))


async def _receive(note_edit: NoteEdit, handler: Handler, request: Request) -> Response:
    """Have a handler take a file that is too large for the memory, in a folder of its own; one file at a time."""
    asked = _ask(request, note_edit)
    slots, place = asked.session.sending_slots, object()
    try:
        slots.take(place)
        path, room = await run_in_threadpool(_make_room, asked.session, request)
    except (RequestError, OSError) as error:
        slots.leave(place)
        await skip_body(request)
        return await run_in_threadpool(_carry_out, _fail(error), asked)
    try:
        await _save(asked.session, request, path, room)
    except (RequestError, OSError) as error:
        return await run_in_threadpool(_carry_out, _fail(error), asked)
    finally:
        slots.leave(place)
    return await run_in_threadpool(_carry_out, handler, replace(asked, file=path))


def _make_room(session: Session, request: Request) -> tuple[Path, int]:
    """Return where the body of a request goes, and how many bytes it may have: not every request tells its length."""
    room = session.find_room()
    check_share(int(request.headers.get("content-length", "0")), room, session.limits)
    return session.make_import_folder() / SOURCE, room


async def _save(session: Session, request: Request, path: Path, room: int) -> None:
    """Save a body; what is too large, or breaks off, leaves nothing."""
    try:
        size = await save_body(request, path, min(room, MOST_MODEL))
        check_size(size, MOST_MODEL)
        check_share(size, room, session.limits)
    except BaseException:
        shutil.rmtree(path.parent, ignore_errors=True)
        raise


def _fail(error: RequestError | OSError) -> Handler:
    def refuse(_asked: Asked) -> Answer:
        raise error

    return refuse


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


def _carry_out(handler: Handler, asked: Asked) -> Response:
    with speaking(load_catalogue(asked.language)):
        try:
            return _respond(handler(asked))
        except Exception as error:
            if isinstance(error, AssessError | OSError):
                return _refuse(error)
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
