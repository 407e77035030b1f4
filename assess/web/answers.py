"""What is answered to each request of the page: see docs/page.md. Knows nothing of HTTP but the status of an error."""

import base64
import hashlib
import re
import shutil
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from assess.i18n import fill
from assess.web.guard import MOST_MODEL
from assess.web.importing import SOURCE, choose_routes
from assess.web.jobs import REPORT, Job
from assess.web.request_errors import NOT_FOUND, UNUSABLE, RequestError
from assess.web.safe_names import clean_name
from assess.web.sessions import Session
from assess.web.texts import PAGE

if TYPE_CHECKING:
    from assess.web.book import Book

WORKBOOK = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
LOOK = 1.5
"""Shortest time between two looks at whether the file was changed by another program [s]."""


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
            from assess.web.starting import describe_start

            start = describe_start(self.session.home)
            raise RequestError(fill("No workbook is open."), NOT_FOUND, more=start)
        return self.session.book


@dataclass(frozen=True, slots=True)
class Content:
    """Bytes, or a file: its kind, the name under which a browser saves it, and headers of its own."""

    data: bytes | Path
    media_type: str
    name: str = ""
    headers: Mapping[str, str] = field(default_factory=dict)


Answer = dict[str, Any] | Content


# ---------------------------------------------------------------- the book


def describe_book(asked: Asked) -> Answer:
    """Answer with the whole workbook."""
    return _note_download(asked, asked.book.describe())


def _note_download(asked: Asked, answer: dict[str, Any]) -> dict[str, Any]:
    """Return an answer with a state in which changes of a held workbook that were downloaded are not called unsaved."""
    session, state = asked.session, answer["state"]
    is_downloaded = asked.book.mode == "held" and session.downloaded == state["version"]
    return {**answer, "state": {**state, "unsaved": False}} if is_downloaded else answer


def describe_state(asked: Asked) -> Answer:
    """Answer with the state of the workbook and of the job, after a look at the file now and then."""
    session = asked.session
    if session.book is not None and time.monotonic() - session.looked > LOOK:
        session.looked = time.monotonic()
        session.book.follow_outside()
    job = session.job.summarise() if session.job else None
    if session.book is None:
        return {"state": None, "job": job}
    return _note_download(asked, {"state": session.book.state(), "job": job})


def edit(asked: Asked) -> Answer:
    """Change cells."""
    edits = asked.body.get("edits")
    if not isinstance(edits, list):
        raise RequestError(fill("The request cannot be read."), UNUSABLE)
    label = str(asked.body.get("label") or "")
    return _change(asked, lambda book, version: book.edit(version, edits, label))


def undo(asked: Asked) -> Answer:
    """Take back the last change."""
    return _change(asked, lambda book, version: book.undo(version))


def redo(asked: Asked) -> Answer:
    """Make a change that was taken back once more."""
    return _change(asked, lambda book, version: book.redo(version))


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


def download(asked: Asked) -> Answer:
    """Answer with the bytes of the workbook."""
    book = asked.book
    version = book.version
    data = book.write()
    asked.session.downloaded = version
    return Content(data, WORKBOOK, book.name)


def save(asked: Asked) -> Answer:
    """Save the workbook to its file."""
    asked.book.save()
    return asked.book.state()


def reload(asked: Asked) -> Answer:
    """Read the file again."""
    asked.book.reload()
    return asked.book.describe()


def close(asked: Asked) -> Answer:
    """End with the workbook; what is on disk is saved first."""
    session = asked.session
    with session.lock:
        if asked.book.mode == "disk" and asked.book.state()["unsaved"]:
            asked.book.save()
        session.drop_book()
    return {}


def upload(asked: Asked) -> Answer:
    """Hold a workbook that was dropped in; a COBie file, which is no inventory yet, is read as a building model is."""
    from assess.bim.cobie_sheets import is_cobie

    name = _name(asked)
    if not is_cobie(asked.data):
        return asked.session.hold(name, asked.data).describe()
    asked.session.check_room(len(asked.data))
    folder = asked.session.make_import_folder()
    (folder / SOURCE).write_bytes(asked.data)
    return import_model(replace(asked, file=folder / SOURCE))


def add_file(asked: Asked) -> Answer:
    """Take a file that the workbook names."""
    with asked.session.lock:
        asked.session.check_room(len(asked.data))
        asked.book.add_file(_name(asked), asked.data)
    return asked.book.describe()


def _name(asked: Asked) -> str:
    name = asked.query.get("name", "")
    if not name.strip():
        raise RequestError(fill("The request does not name the file."), UNUSABLE)
    return name


# ---------------------------------------------------------------- live values, the plan, what if


def describe_live(asked: Asked) -> Answer:
    """Answer with the classes and live values that changed."""
    book, text = asked.book, asked.query.get("since", "")
    return asked.session.view().answer(
        book, int(text) if text.isascii() and text.isdigit() and len(text) < 10 else None
    )


def describe_routes(asked: Asked) -> Answer:
    """Answer with the states of routes and rooms."""
    from assess.web import route_states

    return route_states.describe_routes(asked.book.snapshot())


def describe_plan(asked: Asked) -> Answer:
    """Answer with one floor."""
    from assess.web import floor_plan

    return floor_plan.describe_plan(asked.book.snapshot(), asked.query.get("floor"))


def find_picture(asked: Asked) -> Answer:
    """Answer with the picture of a floor; as an address of its own it could hold scripts, which are not run."""
    from assess.web import floor_plan

    found = floor_plan.find_picture(asked.book.snapshot(), asked.query.get("floor", ""))
    if found is None:
        raise RequestError(fill("This floor has no picture."), NOT_FOUND)
    data, media_type = found
    return Content(data, media_type, headers={"content-security-policy": PICTURE_POLICY})


PICTURE_POLICY = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; frame-ancestors 'none'; sandbox"
"""An SVG has styles and pictures of its own; nothing else of it counts."""


def describe_catalogue(asked: Asked) -> Answer:
    """Answer with the types of the catalogue."""
    from assess.web import floor_plan

    return floor_plan.describe_catalogue(asked.book.snapshot())


def try_out(asked: Asked) -> Answer:
    """Answer with classes before and after a change that is not saved."""
    from assess.web.what_if_answer import try_out

    return try_out(asked.book.snapshot(), dict(asked.body))


# ---------------------------------------------------------------- the job


def describe_job(asked: Asked) -> Answer:
    """Answer with the simulation of this session."""
    session = asked.session
    return {"job": session.job.describe(session.book) if session.job else None}


def simulate(asked: Asked) -> Answer:
    """Start a simulation."""
    asked.session.simulate(asked.body)
    return describe_job(asked)


def cancel(asked: Asked) -> Answer:
    """End the simulation."""
    if asked.session.job is not None:
        asked.session.job.cancel()
    return describe_job(asked)


def find_job_file(asked: Asked) -> Answer:
    """Answer with a file of the results, to be saved."""
    name = asked.query.get("name", "")
    return Content(_job(asked).find_file(name), "application/octet-stream", name)


def find_report(asked: Asked) -> Answer:
    """Answer with the report for a frame: its own script and styles count, and it belongs to no address."""
    found = _job(asked).find_file(REPORT)
    text = found.read_text(encoding="utf-8") if isinstance(found, Path) else ""
    headers = {"content-security-policy": _frame_policy(text), "x-frame-options": "SAMEORIGIN"}
    return Content(text.encode(), "text/html", headers=headers)


def _frame_policy(html: str) -> str:
    """Return what a report may do: run the one script that it brings along, and no other."""
    scripts = re.findall(r"<script>(.*?)</script>", html, re.DOTALL)
    hashes = (base64.b64encode(hashlib.sha256(one.encode()).digest()).decode() for one in scripts)
    allowed = " ".join(f"'sha256-{one}'" for one in hashes) or "'none'"
    return (
        f"sandbox allow-scripts; default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; img-src data:; "
        "font-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'self'"
    )


def _job(asked: Asked) -> Job:
    if asked.session.job is None:
        raise RequestError(fill("Nothing has been simulated yet."), NOT_FOUND)
    return asked.session.job


# ---------------------------------------------------------------- building models


def import_model(asked: Asked) -> Answer:
    """Begin to read a building model that was sent."""
    if asked.file is None:
        raise RequestError(fill("The request cannot be read."), UNUSABLE)
    try:
        name, routes = clean_name(_name(asked)), choose_routes(asked.query.get("routes", ""))
    except RequestError:
        shutil.rmtree(asked.file.parent, ignore_errors=True)
        raise
    asked.session.read_model(asked.file.parent, name or SOURCE, routes)
    return describe_import(asked)


def describe_import(asked: Asked) -> Answer:
    """Answer with the building model that is or was read, and with that of the open workbook."""
    session = asked.session
    found, opened = session.reading, session.imported
    return {
        "import": found.describe() if found else None,
        "opened": opened.describe() if opened else None,
        "most": MOST_MODEL,
    }


def cancel_import(asked: Asked) -> Answer:
    """End the reading, or drop what was read."""
    asked.session.cancel_import()
    return describe_import(asked)


def open_import(asked: Asked) -> Answer:
    """Open a new workbook of what was read."""
    from assess.web.starting import choose_shaking

    return asked.session.open_imported(choose_shaking(asked.body)).describe()


# ---------------------------------------------------------------- start and texts


def describe_start(asked: Asked) -> Answer:
    """Answer with what a new workbook can be made of."""
    from assess.web import starting

    return starting.describe_start(asked.session.home)


def start(asked: Asked) -> Answer:
    """Make a new workbook."""
    return asked.session.begin(asked.body).describe()


def describe_texts(asked: Asked) -> Answer:
    """Answer with the texts of the page in a language."""
    from assess.web import texts

    return texts.describe_texts(asked.query.get("language") or asked.language)


# ---------------------------------------------------------------- files of the page


TYPES = {
    ".html": "text/html",
    ".css": "text/css",
    ".mjs": "text/javascript",
    ".js": "text/javascript",
    ".svg": "image/svg+xml",
}
"""Kinds of the files of the page, whatever the registry of the machine calls them."""


def find_page_file(name: str) -> Content | None:
    """Return a file of the page by its name; nothing outside its folder has one."""
    files = {path.relative_to(PAGE).as_posix(): path for path in PAGE.rglob("*") if path.is_file()}
    path = files.get(name or "index.html")
    if path is None:
        return None
    kind = TYPES.get(path.suffix, "application/octet-stream")
    return Content(path, kind)
