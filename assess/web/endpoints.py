"""The Starlette application: what each address answers (see docs/page.md), bodies, the status of what is refused.

Every answer is worked out in a thread, in the language of the request.
"""

import base64
import hashlib
import json
import logging
import math
import re
import shutil
import time
from collections.abc import AsyncIterator, Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response
from starlette.routing import Route

from assess.errors import AssessError
from assess.i18n import fill, load_catalogue, speaking
from assess.web.assets import answer_asset, find_asset, pack
from assess.web.file_names import clean_name
from assess.web.guard import MODELS, MOST_MODEL, MOST_SKIPPED, SESSION, skip_body
from assess.web.importing import FOLDER, ROUTES, SOURCE
from assess.web.jobs import REPORT, Job
from assess.web.request_errors import BAD_REQUEST, NOT_FOUND, TOO_LARGE, UNUSABLE, RequestError, describe_fault
from assess.web.sessions import Session
from assess.web.starting import choose, choose_shaking, describe_start
from assess.web.texts import COOKIE, choose_language, describe_texts

if TYPE_CHECKING:
    from assess.web.book import Book

MOST_JSON = 32 * 2**20
"""Bytes of a request in JSON: a whole sheet that is pasted."""
MOST_FILE = 64 * 2**20
"""Bytes of a file that is sent."""
POLLED = ("/api/state", "/api/job", MODELS)
"""What a page asks by itself: it is not its user who asks."""
LOOK = 1.5
"""Shortest time between two looks at whether the file was changed by another program [s]."""
WORKBOOK = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
PICTURE_POLICY = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; frame-ancestors 'none'; sandbox"
"""An SVG has styles and pictures of its own; nothing else of it counts."""
LOG = logging.getLogger("assess.web")
Answer = dict[str, Any] | Response
Handler = Callable[["Asked"], Answer]


@dataclass(frozen=True, slots=True)
class Asked:
    """A request: its session, the values of its address, its body or the file that holds it, what an edit calls."""

    session: Session
    query: Mapping[str, str] = field(default_factory=dict)
    body: Mapping[str, Any] = field(default_factory=dict)
    data: bytes = b""
    file: Path | None = None
    language: str = "en"
    note_edit: Callable[[Session], None] = lambda _session: None

    @property
    def book(self) -> "Book":
        """The open workbook; RequestError where there is none."""
        if self.session.book is None:
            raise RequestError(fill("No workbook is open."), NOT_FOUND)
        return self.session.book

    @property
    def job(self) -> Job:
        """The simulation of the session; RequestError where there is none."""
        if self.session.job is None:
            raise RequestError(fill("Nothing has been simulated yet."), NOT_FOUND)
        return self.session.job

    @property
    def name(self) -> str:
        """The name of the file that is sent; RequestError where there is none."""
        name = self.query.get("name", "")
        if not name.strip():
            raise RequestError(fill("The request does not name the file."), UNUSABLE)
        return name


# ---------------------------------------------------------------- the book


def _note_download(asked: Asked, answer: dict[str, Any]) -> dict[str, Any]:
    """Return an answer with a state in which changes of a held workbook that were downloaded are not called unsaved."""
    session, state = asked.session, answer["state"]
    is_downloaded = asked.book.mode == "held" and session.downloaded == state["version"]
    return {**answer, "state": {**state, "unsaved": False}} if is_downloaded else answer


def _describe_book(asked: Asked) -> Answer:
    """Answer with the book; with what can be begun where there is none yet, which is no error."""
    if asked.session.book is None:
        return describe_start(asked.session.home)
    return _note_download(asked, asked.book.describe())


def _describe_state(asked: Asked) -> Answer:
    session = asked.session
    job = session.job.summarise() if session.job else None
    if session.book is None:
        return {"state": None, "job": job}
    if time.monotonic() - session.looked > LOOK:
        session.looked = time.monotonic()
        session.book.follow_outside()
    return _note_download(asked, {"state": session.book.state(), "job": job})


def _edit(asked: Asked) -> Answer:
    edits = asked.body.get("edits")
    if not isinstance(edits, list):
        raise RequestError(fill("The request cannot be read."), UNUSABLE)
    label = str(asked.body.get("label") or "")
    return _change(asked, lambda book, version: book.edit(version, edits, label))


def _change(asked: Asked, change: "Callable[[Book, int], dict[str, Any]]") -> Answer:
    """Change the workbook; VersionError where the page has another opening of it, or another book."""
    from assess.web.book import VersionError

    book, version = asked.book, asked.body.get("version")
    if asked.body.get("server") not in (None, book.opening):
        raise VersionError(book.state())
    if not isinstance(version, int) or isinstance(version, bool):
        raise RequestError(fill("The request does not name the version of the workbook."), UNUSABLE)
    answer = change(book, version)
    asked.note_edit(asked.session)
    return _note_download(asked, answer)


def _download(asked: Asked) -> Answer:
    book = asked.book
    version = book.version
    data = book.write()
    asked.session.downloaded = version
    return _attach(data, WORKBOOK, book.name)


def _attach(data: bytes, media_type: str, name: str) -> Response:
    headers = {"content-disposition": f"attachment; filename*=UTF-8''{quote(name, safe='')}"}
    return Response(data, media_type=media_type, headers=headers)


def _close(asked: Asked) -> Answer:
    session = asked.session
    with session.lock:
        if asked.book.mode == "disk" and asked.book.state()["unsaved"]:
            asked.book.save()
        session.drop_book()
    return {}


def _upload(asked: Asked) -> Answer:
    """Hold a workbook that was dropped in; a COBie file, which is no inventory yet, is read as a building model is."""
    from assess.workbook.read import is_cobie

    name, session = asked.name, asked.session
    if not is_cobie(asked.data):
        return session.hold(name, asked.data).describe()
    session.check_room(len(asked.data))
    file = session.make_folder(FOLDER) / SOURCE
    file.write_bytes(asked.data)
    return _import(replace(asked, file=file))


def _add_file(asked: Asked) -> Answer:
    with asked.session.lock:
        asked.session.check_room(len(asked.data))
        asked.book.add_file(asked.name, asked.data)
    return asked.book.describe()


# ---------------------------------------------------------------- live values, the plan, what if


def _describe_live(asked: Asked) -> Answer:
    from assess.web.live import LiveView

    book, session, text = asked.book, asked.session, asked.query.get("since", "")
    with session.lock:
        view = session.live = session.live or LiveView()
    return view.answer(book, int(text) if text.isascii() and text.isdigit() and len(text) < 10 else None)


def _evaluate(what: str, asked: Asked) -> Answer:
    """Answer with what follows from the workbook by the formulas; what that takes is imported when it is asked for."""
    from assess.web.floor_plan import describe_catalogue, describe_plan, find_picture
    from assess.web.route_states import describe_routes
    from assess.web.what_if_answer import try_out

    snapshot, floor = asked.book.snapshot(), asked.query.get("floor")
    if what == "routes":
        return describe_routes(snapshot)
    if what == "plan":
        return describe_plan(snapshot, floor)
    if what == "catalogue":
        return describe_catalogue(snapshot)
    if what == "what-if":
        return try_out(snapshot, dict(asked.body))
    found = find_picture(snapshot, floor or "")
    if found is None:
        raise RequestError(fill("This floor has no picture."), NOT_FOUND)
    # as an address of its own it could hold scripts, which are not run
    return Response(found[0], media_type=found[1], headers={"content-security-policy": PICTURE_POLICY})


# ---------------------------------------------------------------- the job


def _describe_job(asked: Asked) -> Answer:
    session = asked.session
    return {"job": session.job.describe(session.book) if session.job else None}


def _cancel(asked: Asked) -> Answer:
    if asked.session.job is not None:
        asked.session.job.cancel()
    return _describe_job(asked)


def _find_report(asked: Asked) -> Answer:
    """Answer with the report for a frame: its one script and its styles count, and it belongs to no address."""
    html = asked.job.read_file(REPORT).replace(b"\r\n", b"\n")  # as browsers read it
    scripts = re.findall(rb"<script>(.*?)</script>", html, re.DOTALL)
    hashes = (base64.b64encode(hashlib.sha256(one).digest()).decode() for one in scripts)
    allowed = " ".join(f"'sha256-{one}'" for one in hashes) or "'none'"
    policy = (
        f"sandbox allow-scripts; default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; img-src data:; "
        "font-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'self'"
    )
    headers = {"content-security-policy": policy, "x-frame-options": "SAMEORIGIN"}
    return Response(html, media_type="text/html", headers=headers)


# ---------------------------------------------------------------- building models


def _import(asked: Asked) -> Answer:
    if asked.file is None:
        raise RequestError(fill("The request cannot be read."), UNUSABLE)
    try:
        name, routes = clean_name(asked.name), choose(asked.query, "routes", ROUTES)
    except RequestError:
        shutil.rmtree(asked.file.parent, ignore_errors=True)
        raise
    asked.session.read_model(asked.file.parent, name or SOURCE, routes)
    return _describe_import(asked)


def _describe_import(asked: Asked) -> Answer:
    found, opened = asked.session.reading, asked.session.imported
    described = {"import": found and found.describe(), "opened": opened and opened.describe()}
    return {**described, "most": MOST_MODEL}


# ---------------------------------------------------------------- what answers


def _after(act: Callable[[Asked], object], describe: Handler) -> Handler:
    """Return a handler that does something, and then answers as another one."""

    def handle(asked: Asked) -> Answer:
        act(asked)
        return describe(asked)

    return handle


TABLE: tuple[tuple[str, int, Mapping[str, Handler]], ...] = (
    ("GET", 0, {
        "/api/book": _describe_book,
        "/api/state": _describe_state, "/api/download": _download, "/api/live": _describe_live,
        **{f"/api/{one}": partial(_evaluate, one) for one in ("routes", "plan", "picture", "catalogue")},
        "/api/job": _describe_job, "/api/job/report": _find_report,
        "/api/job/file/{name:path}": lambda asked: _attach(
            asked.job.read_file(asked.query["name"]), "application/octet-stream", asked.query["name"]
        ),
        MODELS: _describe_import,
        "/api/start": lambda asked: describe_start(asked.session.home),
        "/api/texts": lambda asked: describe_texts(asked.query.get("language") or asked.language),
    }),
    ("POST", MOST_JSON, {
        "/api/edit": _edit, "/api/close": _close, "/api/what-if": partial(_evaluate, "what-if"),
        "/api/save": _after(lambda asked: asked.book.save(), lambda asked: asked.book.state()),
        "/api/reload": _after(lambda asked: asked.book.reload(), lambda asked: asked.book.describe()),
        "/api/undo": lambda asked: _change(asked, lambda book, version: book.undo(version)),
        "/api/redo": lambda asked: _change(asked, lambda book, version: book.redo(version)),
        "/api/job": _after(lambda asked: asked.session.simulate(asked.body), _describe_job),
        "/api/job/cancel": _cancel,
        "/api/import/cancel": _after(lambda asked: asked.session.cancel_import(), _describe_import),
        "/api/import/open": lambda asked: asked.session.open_imported(choose_shaking(asked.body)).describe(),
        "/api/start": lambda asked: asked.session.begin(asked.body).describe(),
    }),
    ("POST", MOST_FILE, {"/api/upload": _upload, "/api/file": _add_file}),
    ("POST", MOST_MODEL, {MODELS: _import}),
)  # fmt: skip
"""By method, the bytes that a body may have, and address what answers: bodies up to `MOST_JSON` are JSON, larger ones
files, and building models are saved in a folder."""


def build_application(note_edit: Callable[[Session], None]) -> Starlette:
    """Return the application; `note_edit` is called after every change of a workbook."""

    def route(path: str, method: str, most: int, handler: Handler) -> Route:
        async def serve(request: Request) -> Response:
            asked, fault = _ask(request, note_edit), None
            try:
                if most == MOST_MODEL:
                    asked = replace(asked, file=await _save_model(request, asked.session))
                elif most:
                    data = b"".join([part async for part in _stream(request, most, partial(_check_size, most))])
                    asked = replace(asked, data=data) if most == MOST_FILE else replace(asked, body=_parse_body(data))
            except (RequestError, OSError) as error:
                fault = error
            return await run_in_threadpool(lambda: pack(_carry_out(handler, asked, fault), request.headers))

        return Route(path, serve, methods=[method])

    def give_file(request: Request) -> Response:
        found = find_asset(request.path_params["name"])
        if found is None:
            return _refuse(RequestError(fill("There is nothing at this address."), NOT_FOUND))
        return answer_asset(found, request.headers, request.query_params.get("v", ""))

    routes = [route(path, method, most, one) for method, most, every in TABLE for path, one in every.items()]
    return Starlette(routes=[*routes, Route("/{name:path}", give_file, methods=["GET"])])


def _ask(request: Request, note_edit: Callable[[Session], None]) -> Asked:
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
            answer = handler(asked)
            return answer if isinstance(answer, Response) else _to_json(answer)
        except Exception as error:
            if not isinstance(error, AssessError | OSError):
                LOG.exception("a request failed")
            return _refuse(error)


def _refuse(error: Exception) -> Response:
    status, body = describe_fault(error)
    return _to_json(body, status)


def _to_json(body: dict[str, Any], status: int = 200) -> Response:
    """Return JSON; a number that is not finite is null, numbers of numpy and rows of them are Python's own."""
    dump = partial(
        json.dumps, ensure_ascii=False, allow_nan=False, separators=(",", ":"),
        default=lambda value: _finite(value.tolist() if hasattr(value, "tolist") else str(value)),
    )  # fmt: skip
    try:
        text = dump(body)
    except ValueError:
        text = dump(_finite(body))
    return Response(text.encode("utf-8", "replace"), status, media_type="application/json")


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _finite(one) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


# ---------------------------------------------------------------- bodies


async def _save_model(request: Request, session: Session) -> Path:
    """Save a file that is too large for the memory in a folder of its own, one at a time."""

    def begin() -> tuple[Path, int]:
        session.sending_slots.take()
        try:
            room = session.find_room()
            session.check_room(int(request.headers.get("content-length", "0")), room)  # not every request tells it
            return session.make_folder(FOLDER) / SOURCE, room
        except BaseException:
            session.sending_slots.release()
            raise

    def check(size: int) -> None:
        _check_size(MOST_MODEL, size)
        session.check_room(size, room)

    try:
        path, room = await run_in_threadpool(begin)
    except (RequestError, OSError):
        await skip_body(request.receive)
        raise
    try:
        with path.open("xb") as file:
            async for part in _stream(request, min(room, MOST_MODEL), check):
                await run_in_threadpool(file.write, part)
    except BaseException:  # what is too large, or breaks off, leaves nothing
        shutil.rmtree(path.parent, ignore_errors=True)
        raise
    finally:
        session.sending_slots.release()
    return path


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


def _parse_body(data: bytes) -> dict[str, Any]:
    """Return a JSON object, {} for an empty body; RequestError if it holds NaN, infinity or halves of characters."""
    if not data:
        return {}
    try:
        found = json.loads(data)
        json.dumps(found, ensure_ascii=False, allow_nan=False).encode()
    except (ValueError, RecursionError):  # also UnicodeError, and a number such as NaN or 1e999
        found = None
    if not isinstance(found, dict):
        raise RequestError(fill("The request cannot be read."), BAD_REQUEST)
    return found
