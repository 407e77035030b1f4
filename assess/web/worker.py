"""The process of one session: it holds the workbook and all that follows from it, answers requests and saves.

``python -m assess.web.worker FOLDER``: FOLDER is that of the session. Requests come by the input and answers go by the
output, as frames, the first of which is the order. The process saves and ends once its input is closed, as that is when
the server has ended, however it did.
"""

import gc
import json
import logging
import os
import sys
import threading
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from starlette.responses import Response

from assess.delivery.deliver import saving
from assess.delivery.folders import locked
from assess.errors import AssessError
from assess.i18n import Text, fill
from assess.processes import OUT_OF_MEMORY, limit_process
from assess.web.endpoints import answer, refuse
from assess.web.frames import Call, Reply, pack, read_frame, write_frame
from assess.web.importing import find_free
from assess.web.limits import Limits
from assess.web.request_errors import BROKEN, UNUSABLE, RequestError
from assess.web.sessions import Session

if TYPE_CHECKING:
    from assess.web.book import Book

SAVED_AFTER = 1.0
"""Time from the last change of a workbook to its being saved [s]; longer where saving itself takes long."""
SAVED_AT_LATEST = 3.0
"""Time from the first change that is not saved to its being saved, however much is changed after it [s]; as above."""
SAVED_AGAIN_AFTER = 3.0
"""Time after which saving that has failed is tried again [s]."""
SAVING_SHARE = 0.3
"""Most of the time that saving may take while a workbook is being changed [-]."""
LOWER_PRIORITY = 2
"""How far this process stands back for the server."""
THREADS = 3
"""Requests that are worked out at once."""
LOG = logging.getLogger("assess.web")
COLLECTED = 200_000, 50, 100
"""After how many objects the memory is searched for circles: a search of a large workbook takes a tenth of a second."""
OWN = "/own/"
"""Beginning of what the server asks for itself; no request of a user has such an address."""


class Keeper(threading.Thread):
    """Saves a workbook of the disk a moment after its last change."""

    def __init__(self, session: Session) -> None:
        super().__init__(name="assess-keeper", daemon=True)
        self._session = session
        self._due = self._latest = float("inf")
        self._took = 0.0  # by the last save [s]
        self._woken, self._is_ended = threading.Condition(), False
        session.note_edit = self.note_edit

    def note_edit(self) -> None:
        """Have the workbook be saved, once nothing more is changed for a moment, or soon."""
        if self._session.book is not None and self._session.book.mode == "disk":
            with self._woken:
                now, pause = time.monotonic(), self._took / SAVING_SHARE
                self._latest = min(self._latest, now + max(SAVED_AT_LATEST, pause))
                self._due = min(now + max(SAVED_AFTER, pause), self._latest)
                self._woken.notify()

    def end(self) -> None:
        """End, after what is being saved."""
        with self._woken:
            self._is_ended = True
            self._woken.notify()
        self.join()

    def run(self) -> None:
        """Save what is due until the end."""
        while self._wait():
            started = time.monotonic()
            self._session.save()
            self._took = time.monotonic() - started
            state = self._session.book.state() if self._session.book else {}
            if state.get("unsaved") and state["save_error"] and not state["changed_outside"]:
                pause = max(SAVED_AGAIN_AFTER, self._took / SAVING_SHARE)  # what stood in the way may be gone
                with self._woken:
                    self._due = min(self._due, time.monotonic() + pause)

    def _wait(self) -> bool:
        with self._woken:
            while not self._is_ended and (left := self._due - time.monotonic()) > 0:
                self._woken.wait(min(left, threading.TIMEOUT_MAX))
            self._due = self._latest = float("inf")
            return not self._is_ended


class Worker:
    """What answers in the process of a session. `order`: the fields of `Session` that the server gives."""

    def __init__(self, folder: Path, order: Mapping[str, Any]) -> None:
        home = Path(order["home"]) if order["home"] else None
        self.session = Session(folder, home, Limits(**order["limits"]), order["language"], order["server"])
        self.is_out = False  # of memory: it has to be started again
        self._restore()
        self._keeper = Keeper(self.session)
        self._keeper.start()
        self.session.note_edit()  # what the process before has not saved

    def _restore(self) -> None:
        try:
            self.session.restore()
        except Exception:  # it is kept on the disk; the page begins anew
            LOG.exception("a workbook could not be opened again")

    def ask(self, call: Call) -> Reply:
        """Return the answer to a request."""
        known: dict[str, Callable[[Call], dict[str, Any]]] = {
            "hello": lambda _call: {}, "idle": self._is_idle, "open": self._open, "end": self._end,
        }  # fmt: skip
        own = known.get(call.path.removeprefix(OWN))
        try:
            response = answer(self.session, call) if own is None else Response(json.dumps(own(call)))
        except MemoryError:
            most = self.session.limits.memory / 1e6
            text = fill("It needs more than {most:,.0f} MB of memory, which is the limit here.", most=most)
            response, self.is_out = refuse(self.session, call, RequestError(text, UNUSABLE)), True
        except Exception:
            LOG.exception("the process of a session failed")
            response = Response(status_code=BROKEN)
        headers = [(name.decode("latin-1"), value.decode("latin-1")) for name, value in response.raw_headers]
        book = self.session.book
        return Reply(response.status_code, headers, bytes(response.body), language=book.language if book else "")

    def close(self) -> None:
        """Save, and end what runs."""
        self._keeper.end()
        self.session.save()
        self.session.close()

    def _open(self, call: Call) -> dict[str, Any]:
        """Open a workbook of the disk; return what its user should know."""
        from assess.web.book import Book

        path, book = Path(call.query["path"]), self.session.book
        remarks: list[Text | str] = []
        if book is not None and (book.path is None or book.check_outside()):  # of a server that was killed
            if book.state()["unsaved"] and (kept := keep_changes(book, self.session.home)):
                remarks.append(fill(
                    "{name} was changed by another program since assess was ended. Changes that had not been saved in "
                    "it are kept in {kept}.", name=book.name, kept=str(kept),
                ))  # fmt: skip
            book = None
        elif book is not None and book.state()["unsaved"]:
            remarks.append(fill("Changes that had not been saved when assess was ended have been taken over."))
            self.session.note_edit()
        try:
            book = book or self.session.take(Book.open_disk(path))
        except (AssessError, OSError):
            return {"remarks": None}
        return {"remarks": [str(one) for one in (*remarks, book.remark, book.state()["save_error"]) if one]}

    def _is_idle(self, _call: Call) -> dict[str, Any]:
        """Return whether nothing runs that would be lost."""
        reading = self.session.reading
        return {"idle": self.session.runs.find_running() is None and not (reading and reading.state == "running")}

    def _end(self, _call: Call) -> dict[str, Any]:
        """Save, or keep changes that cannot be saved; return the fields of `Ending`."""
        self._keeper.end()
        session = self.session
        session.save()
        ending: dict[str, Any] = {"saved": "", "kept": [], "lost": []}
        if (book := session.book) is not None:
            is_unsaved = book.state()["unsaved"] and (book.mode == "disk" or session.downloaded != book.version)
            path = keep_changes(book, session.home) if is_unsaved and session.home else None
            if path is not None:
                ending["kept"].append((book.name, str(path)))
            elif is_unsaved:
                ending["lost"].append(book.name)
            elif book.mode == "disk":
                ending["saved"] = book.name
        session.close()
        return ending


def keep_changes(book: "Book", home: Path | None) -> Path | None:
    """Write a workbook, with its changes, under a new name: next to its file, else where one may; None if nowhere."""
    with suppress(AssessError):
        data = book.write()
        for folder in filter(None, (book.path and book.path.parent, home, Path.home())):
            with suppress(OSError):
                path = folder / find_free(f"{Path(book.name).stem}-changes{Path(book.name).suffix}", folder)
                with saving(path) as part:
                    part.write_bytes(data)
                return path
    return None


def main() -> None:
    """Answer what comes by the input until it ends."""
    output = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # whatever is printed goes to the standard error
    gc.set_threshold(*COLLECTED)
    if hasattr(os, "nice"):
        os.nice(LOWER_PRIORITY)
    first = read_frame(sys.stdin.buffer)
    if first is None:
        os._exit(0)
    limit_process(first[0]["limits"]["memory"])
    folder = Path(sys.argv[1])
    with locked(folder):  # for as long as this process lives, which may have to wait for the end of the one before
        _serve(Worker(folder, first[0]), output)


def _serve(worker: Worker, output: BinaryIO) -> None:
    lock = threading.Lock()

    def work(header: dict[str, Any], data: bytes) -> None:
        number = header.pop("number")
        reply = worker.ask(Call(**header, data=data))
        with lock, suppress(OSError):
            write_frame(output, *pack(reply, number))
        if worker.is_out:
            os._exit(OUT_OF_MEMORY)

    pool = ThreadPoolExecutor(THREADS, "assess-request")
    while (found := read_frame(sys.stdin.buffer)) is not None:
        pool.submit(work, *found)
    pool.shutdown(cancel_futures=True)
    worker.close()
    os._exit(0)


if __name__ == "__main__":
    main()
