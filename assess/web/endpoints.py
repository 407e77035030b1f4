"""What each address answers (see docs/page.md), in the process of a session; bodies, the status of what is refused.

Every answer is worked out in the language of the request.
"""

import base64
import hashlib
import json
import logging
import math
import re
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from starlette.responses import Response

from assess.errors import AssessError
from assess.i18n import fill, gettext, load_catalogue, speaking
from assess.report_formats import FILES
from assess.settings import SCENARIOS
from assess.web.assets import pack
from assess.web.file_names import clean_name
from assess.web.frames import Call
from assess.web.importing import ROUTES, SOURCE
from assess.web.jobs import Run, describe_comparison, read_formats
from assess.web.limits import MODELS, MOST_MODEL
from assess.web.request_errors import (
    BAD_REQUEST,
    NOT_FOUND,
    UNUSABLE,
    WRONG_METHOD,
    RequestError,
    describe_fault,
)
from assess.web.sessions import Session
from assess.web.starting import choose, choose_shaking, describe_map, describe_start
from assess.web.texts import choose_language, describe_texts

if TYPE_CHECKING:
    from assess.web.book import Book

SENT = ("/api/upload", "/api/file", MODELS)
"""Where bodies are files; all others are JSON."""
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
    """A request: its session, the values of its address, its body as JSON, as bytes or as a file that holds them."""

    session: Session
    query: Mapping[str, str] = field(default_factory=dict)
    body: Mapping[str, Any] = field(default_factory=dict)
    sent: bytes = b""
    file: Path | None = None
    language: str = "en"

    @property
    def data(self) -> bytes:
        """The bytes that were sent."""
        return self.file.read_bytes() if self.file else self.sent

    @property
    def book(self) -> "Book":
        """The open workbook; RequestError where there is none."""
        if self.session.book is None:
            raise RequestError(fill("No workbook is open."), NOT_FOUND)
        return self.session.book

    @property
    def run(self) -> Run:
        """The run that the request names, else the latest; RequestError where there is none."""
        return self.session.runs.find(str(self.query.get("id") or self.body.get("id") or ""))

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
    job = session.runs.latest and session.runs.latest.summarise()
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
    return _change(asked, lambda book, version, request: book.edit(version, edits, label, request))


def _change_rows(asked: Asked) -> Answer:
    sheet, do, at, count, to = (asked.body.get(name) for name in ("sheet", "do", "at", "count", "to"))
    return _change(
        asked, lambda book, version, request: book.change_rows(version, str(sheet), do, at, count, to, request)
    )


def _change(asked: Asked, change: "Callable[[Book, int, str], dict[str, Any]]") -> Answer:
    """Change the workbook, once for an `id`; VersionError where the page has another opening of it, or another book."""
    from assess.web.book import VersionError

    book, version = asked.book, asked.body.get("version")
    if asked.body.get("server") not in (None, book.opening):
        raise VersionError(book.state())
    if not isinstance(version, int) or isinstance(version, bool):
        raise RequestError(fill("The request does not name the version of the workbook."), UNUSABLE)
    request = str(asked.body.get("id") or "")
    answer = book.find_answer(request) or change(book, version, request)
    if answer.get("rows"):  # at once: edits that the page keeps until they are saved name other rows than the file has
        with suppress(AssessError):
            book.save()
        answer["state"] = book.state()
    asked.session.note_edit()
    return _note_download(asked, answer)


def _download(asked: Asked) -> Answer:
    book = asked.book
    version = book.version
    data = book.write()
    asked.session.note_download(version)
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

    name, data = asked.name, asked.data
    return _import(asked) if is_cobie(data) else asked.session.hold(name, data).describe()


def _add_file(asked: Asked) -> Answer:
    data = asked.data
    with asked.session.lock:
        asked.session.check_room(len(data))
        asked.book.add_file(asked.name, data)
    return asked.book.describe()


# ---------------------------------------------------------------- live values, the plan, what if


def _describe_live(asked: Asked) -> Answer:
    from assess.web.live import LiveView

    book, session = asked.book, asked.session
    with session.lock:
        view = session.live = session.live or LiveView()
    return view.answer(book, asked.query.get("since"))


def _evaluate(what: str, asked: Asked) -> Answer:
    """Answer with what follows from the workbook; what that takes is imported when it is asked for."""
    from assess.web.floor_plan import describe_catalogue, describe_plan, find_picture
    from assess.web.route_states import describe_routes
    from assess.web.what_if_answer import try_out

    snapshot, floor = asked.book.snapshot(), asked.query.get("floor")
    if what == "routes":
        return describe_routes(snapshot)
    if what == "overview":
        from assess.web.overview import describe_overview

        return describe_overview(snapshot)
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
    runs = asked.session.runs
    scenarios = [(one, gettext(one)) for one in SCENARIOS]
    job = runs.latest and runs.latest.describe(asked.session.book)
    return {"job": job, "runs": runs.list_all(), "scenarios": scenarios}


def _make_files(asked: Asked) -> None:
    session = asked.session
    session.check_room(0)
    session.runs.make(asked.run.id, read_formats(asked.body.get("formats")))


def _compare(asked: Asked) -> Answer:
    """Answer with what changed between two runs, or with the page of it."""
    view = asked.session.runs.compare(*(asked.query.get(name, "-") for name in ("before", "after")))
    if asked.query.get("as") != "page":
        return describe_comparison(view)
    from assess.compare.comparison_document import render_comparison
    from assess.report.report_options import ReportOptions

    return _show_page(render_comparison(view, ReportOptions(language=asked.language)).encode())


def _show_page(html: bytes) -> Response:
    """Answer with a report as a page of its own: its one script and its styles count, and it belongs to no address.

    A page with such a policy is shown only where it may share its window with others.
    """
    html = html.replace(b"\r\n", b"\n")  # as browsers read it
    scripts = re.findall(rb"<script>(.*?)</script>", html, re.DOTALL)
    hashes = (base64.b64encode(hashlib.sha256(one).digest()).decode() for one in scripts)
    allowed = " ".join(f"'sha256-{one}'" for one in hashes) or "'none'"
    policy = (
        f"sandbox allow-scripts allow-modals; default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; "
        "img-src data:; font-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
    headers = {"content-security-policy": policy, "cross-origin-opener-policy": "unsafe-none"}
    return Response(html, media_type="text/html", headers=headers)


# ---------------------------------------------------------------- building models


def _import(asked: Asked) -> Answer:
    name, routes = clean_name(asked.name), choose(asked.query, "routes", ROUTES)
    asked.session.read_model(asked.file or asked.sent, name or SOURCE, routes)
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


TABLE: tuple[tuple[str, Mapping[str, Handler]], ...] = (
    ("GET", {
        "/api/book": _describe_book,
        "/api/state": _describe_state, "/api/download": _download, "/api/live": _describe_live,
        **{f"/api/{one}": partial(_evaluate, one) for one in ("overview", "routes", "plan", "picture", "catalogue")},
        "/api/job": _describe_job, "/api/job/compare": _compare,
        "/api/job/report": lambda asked: _show_page(asked.run.read_file(FILES["html"])),
        "/api/job/file/{name:path}": lambda asked: _attach(
            asked.run.read_file(asked.query["name"]), "application/octet-stream", asked.query["name"]
        ),
        MODELS: _describe_import,
        "/api/start": lambda asked: describe_start(asked.session.home), "/api/map": lambda _asked: describe_map(),
        "/api/texts": lambda asked: describe_texts(asked.query.get("language") or asked.language),
    }),
    ("POST", {
        "/api/edit": _edit, "/api/rows": _change_rows, "/api/close": _close,
        "/api/what-if": partial(_evaluate, "what-if"),
        "/api/save": _after(lambda asked: asked.book.save(), lambda asked: asked.book.state()),
        "/api/reload": _after(lambda asked: asked.book.reload(), lambda asked: asked.book.describe()),
        "/api/undo": lambda asked: _change(asked, lambda book, version, request: book.undo(version, request)),
        "/api/redo": lambda asked: _change(asked, lambda book, version, request: book.redo(version, request)),
        "/api/job": _after(lambda asked: asked.session.begin_run(asked.body), _describe_job),
        "/api/job/files": _after(_make_files, _describe_job),
        "/api/job/remove": _after(lambda asked: asked.session.runs.remove(asked.run.id), _describe_job),
        "/api/job/cancel": _after(lambda asked: asked.session.runs.close(), _describe_job),
        "/api/import/cancel": _after(lambda asked: asked.session.cancel_import(), _describe_import),
        "/api/import/open": lambda asked: asked.session.open_imported(choose_shaking(asked.body)).describe(),
        "/api/start": lambda asked: asked.session.begin(asked.body).describe(),
        "/api/upload": _upload, "/api/file": _add_file, MODELS: _import,
    }),
)  # fmt: skip
"""By method and address what answers; the bytes that a body may have stand in `assess.web.limits`."""
_REST = "{name:path}"
"""The end of an address that holds a name."""


def answer(session: Session, call: Call) -> Response:
    """Return the answer to a request, in the language that its user chose, else that of the workbook or browser."""
    language = _choose(session, call)
    with speaking(load_catalogue(language)):
        try:
            handler, named = _find_handler(call)
            is_json = call.method == "POST" and call.path not in SENT
            file = Path(call.file) if call.file else None
            asked = Asked(session, {**call.query, **named}, {}, call.data, file, language)
            found = handler(replace(asked, body=_parse_body(asked.data)) if is_json else asked)
            response = found if isinstance(found, Response) else _to_json(found)
            return pack(response, {"accept-encoding": call.encoding})
        except MemoryError:  # nothing can be relied upon any more
            raise
        except Exception as error:
            if not isinstance(error, AssessError | OSError):
                LOG.exception("a request failed")
            return _refuse(error)


def refuse(session: Session, call: Call, error: Exception) -> Response:
    """Return the answer to a request that could not be carried out, in the same language."""
    with speaking(load_catalogue(_choose(session, call))):
        return _refuse(error)


def _choose(session: Session, call: Call) -> str:
    of_book = session.language or (session.book.language if session.book else "")
    return choose_language(call.chosen, of_book, call.accepted)


def _find_handler(call: Call) -> tuple[Handler, Mapping[str, str]]:
    is_known = False
    for method, every in TABLE:
        for path, handler in every.items():
            start = path.removesuffix(_REST)
            is_named = start != path and call.path.startswith(start)
            if is_named or path == call.path:
                is_known = True
                if method == call.method:
                    return handler, {"name": call.path.removeprefix(start)} if is_named else {}
    if is_known:
        raise RequestError(fill("This address does not answer to that method."), WRONG_METHOD)
    raise RequestError(fill("There is nothing at this address."), NOT_FOUND)


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


def _parse_body(data: bytes) -> dict[str, Any]:
    """Return a JSON object, {} for an empty body; RequestError if it holds NaN, infinity or halves of characters."""

    def refuse(name: str) -> float:
        raise ValueError(name)

    def read(text: str) -> float:
        found = float(text)
        return found if math.isfinite(found) else refuse(text)

    if not data:
        return {}
    try:
        found = json.loads(data.decode(), parse_float=read, parse_constant=refuse)
        if re.search(rb"\\u[dD]", data):  # a half of a character, maybe
            json.dumps(found, ensure_ascii=False).encode()
    except (ValueError, RecursionError):  # also UnicodeError
        found = None
    if not isinstance(found, dict):
        raise RequestError(fill("The request cannot be read."), BAD_REQUEST)
    return found
