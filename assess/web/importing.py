"""A building model, a plan, a scan or a COBie file that becomes a new workbook, read in a thread of its own.

What is read goes to a folder of its own, where what was found takes its place until it is a workbook; a process that is
started again goes on from there.
"""

import json
import logging
import pickle
import secrets
import shutil
import threading
import time
from collections.abc import Iterator, Mapping
from contextvars import copy_context
from dataclasses import replace
from itertools import count
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any, Literal

from assess.errors import AssessError, CancelledError
from assess.i18n import fill, gettext
from assess.progress import Progress, Report
from assess.web.file_names import ENDINGS, make_safe
from assess.web.jobs import STAGES
from assess.web.request_errors import CONFLICT, NOT_FOUND, RequestError, describe_fault
from assess.web.slots import Slots
from assess.web.starting import Made

if TYPE_CHECKING:
    from assess.bim.import_workbook import ImportedBuilding

FOLDER = "import-"
READING = fill("Other building models are being read. Try again in a minute.")
"""Why there is no place for another."""
SOURCE, ORDER, FOUND = "model", "order.json", "found"
"""In its folder: what was sent, whatever it is called; what the process is to know of it; what it has found."""
LEFT_AFTER = 90.0
"""Time after which a reading ends whose page no longer asks how far it is [s]; browsers slow down hidden pages."""
PATIENCE = 2.0
"""Time that a cancelled reading has to end before it is no longer waited for [s]."""
MOST_ROWS = 2000
"""Rows of what was skipped that the page gets."""
LOG = logging.getLogger("assess.web")
Routes = Literal["none", "draft"]
ROUTES: tuple[Routes, ...] = ("none", "draft")


def _describe_taken(taken: Mapping[str, Any]) -> dict[str, Any]:
    """Return a summary as the page shows it, in the language in use; of skipped types as many as `MOST_ROWS`."""
    left, groups, maybe = MOST_ROWS, [], 0
    for reason, is_furniture, rows in taken["skipped"]:
        shown, total = rows[:left], sum(number for _, number in rows)
        left -= len(shown)
        maybe += total * is_furniture
        groups.append({
            "reason": gettext(reason), "is_furniture": is_furniture, "count": total, "types": shown,
            "more": len(rows) - len(shown),
        })  # fmt: skip
    texts = {name: [gettext(text) for text in taken[name]] for name in ("warnings", "remarks")}
    return {**taken, "of": taken["pieces"] + maybe, "skipped": groups, **texts}


class _Asked(threading.Event):
    """Set where a reading is to stop: by hand, or as nobody asks how far it is any more."""

    def __init__(self) -> None:
        super().__init__()
        self.latest = time.monotonic()

    def is_set(self) -> bool:
        return super().is_set() or time.monotonic() - self.latest > LEFT_AFTER


class Import:
    """A file, `SOURCE` in a folder that is removed once it is a workbook; RequestError without a free slot."""

    def __init__(self, folder: Path, name: str, routes: Routes, slots: Slots, number: str = "") -> None:
        self.id, self.name = number or secrets.token_hex(8), name  # the number is that of a process before
        self.state, self.book = "running", ""
        self._folder, self._routes, self._is_kept = folder, routes, False
        self._asked, self._lock = _Asked(), threading.RLock()
        self._started, self._latest = time.monotonic(), Report("", 0.0, "", None)
        self._error: Exception | None = None
        self._found: ImportedBuilding | None = None
        self._taken: dict[str, Any] | None = None
        try:
            self._slot = None if (folder / FOUND).is_file() else slots.take()
        except RequestError:
            shutil.rmtree(folder, ignore_errors=True)
            raise
        (folder / ORDER).write_text(json.dumps([name, routes, self.id]), encoding="utf-8")
        self._thread = threading.Thread(target=copy_context().run, args=(self._run,), name="assess-import", daemon=True)
        self._thread.start()
        if self._slot is None:
            self._thread.join()

    def _run(self) -> None:
        from assess.bim.import_workbook import group_skipped
        from assess.bim.read_source import read_source

        def listen(report: Report) -> None:
            self._latest = report

        state, found, error = "done", None, None
        try:
            progress = Progress(listen, self._asked)
            if (kept := self._folder / FOUND).is_file():
                found = pickle.loads(kept.read_bytes())  # noqa: S301 - written below, in a folder of this user alone
            else:
                found = read_source(self._folder / SOURCE, self.name, progress, routes=self._routes)
                (part := kept.with_suffix(".part")).write_bytes(pickle.dumps(found))
                part.replace(kept)
                (self._folder / SOURCE).unlink()
        except CancelledError:
            state = "cancelled"
        except Exception as fault:
            state, error = "failed", fault
            if not isinstance(fault, AssessError | OSError):
                LOG.exception("a building model could not be read")
        if state != "done" and not self._is_kept:
            shutil.rmtree(self._folder, ignore_errors=True)
        if self._slot is not None:
            self._slot.release()
        with self._lock:
            if self.state != "running":
                return
            self._found, self._error, self.state = found, error, state
            if found is not None:  # all that is kept of a reading once its workbook is open
                self._taken = {
                    "pieces": len(found.items),
                    "types": len({row.get("type") for row in found.items}),
                    "floors": len({row.get("floor") for row in found.items}),
                    "rooms": sum(row.get("kind") == "room" for row in found.places),
                    "routes": len({row.get("route") for row in found.routes}),
                    "plans": sum(name.endswith(".svg") for name in found.files),
                    "skipped": [  # the reason, whether it may be furniture, and the number of pieces of each type
                        (reason, group[0].is_furniture, [(one.type, one.count) for one in group])
                        for reason, group in group_skipped(found.skipped)
                    ],
                    "warnings": found.warnings,
                    "remarks": found.remarks,
                }

    def close(self, *, is_kept: bool = False) -> None:
        """End it at once, and forget what was read, unless its folder is kept for the next process."""
        with self._lock:
            self._is_kept = is_kept
            if self.state == "running":
                self.state = "cancelled"
        self._asked.set()
        self._thread.join(timeout=PATIENCE)
        self._found = None
        if not is_kept:
            shutil.rmtree(self._folder, ignore_errors=True)

    def describe(self) -> dict[str, Any]:
        """Return all that the page shows, in the language in use; notes that it was asked for."""
        self._asked.latest = time.monotonic()
        with self._lock:
            now = self._latest
            fault = describe_fault(self._error)[1] if self._error is not None else {}
            return {
                "id": self.id, "state": self.state, "name": self.name, "book": self.book,
                "label": gettext(STAGES.get(now.stage or "reading", STAGES["reading"])),
                "share": now.share if self.state == "running" else 1.0,
                "seconds": time.monotonic() - self._started, "message": "", "fix": "", "problems": [], **fault,
                "found": _describe_taken(self._taken) if self._taken else None,
                "workbook": name_workbook(self.name),
            }  # fmt: skip

    def build(self, folder: Path, shaking: str) -> Made:
        """Return the new workbook under free names; RequestError if nothing was read, or it was made already."""
        from assess.bim.import_workbook import build_workbook

        with self._lock:
            if self.book:
                raise RequestError(fill("The workbook of {name} is open already.", name=self.name), CONFLICT)
            if self._found is None:
                raise RequestError(fill("No building model has been read."), NOT_FOUND)
            found = _rename_files(self._found, folder)
        if shaking:
            found = replace(found, building={**found.building, "shaking": shaking})
        return Made(find_free(name_workbook(self.name), folder), build_workbook(found), found.files)

    def note_opened(self, book: str) -> None:
        """Note which opening of a workbook holds it; what was read is forgotten, but for the list of it."""
        self.book, self._found = book, None
        shutil.rmtree(self._folder, ignore_errors=True)


def name_workbook(name: str) -> str:
    """Return how the workbook of a file is called: a COBie file is a workbook of that name itself."""
    path = PurePosixPath(name)
    stem = f"{path.stem}-inventory" if path.suffix.lower() in ENDINGS else path.stem
    return make_safe(f"{stem}{ENDINGS[0]}")


def find_free(name: str, folder: Path) -> str:
    """Return a name that no file of a folder has: the name itself, else with a number."""
    return next(one for one in _number(name) if not _is_there(folder / one))


def _number(name: str) -> Iterator[str]:
    path = PurePosixPath(name)
    yield path.as_posix()
    yield from (path.with_name(f"{path.stem}-{n}{path.suffix}").as_posix() for n in count(2))


def _is_there(path: Path) -> bool:
    return path.exists() or path.is_symlink()


def _rename_files(found: "ImportedBuilding", folder: Path) -> "ImportedBuilding":
    """Return a building whose files have names that neither the folder nor another file has, but for the very same."""

    def is_free(path: Path, data: bytes) -> bool:
        return not _is_there(path) or (
            path.is_file() and path.stat().st_size == len(data) and path.read_bytes() == data
        )

    names: dict[str, str] = {}
    for name, data in found.files.items():
        others = {one.casefold() for one in (*found.files, *names.values()) if one != name}
        options = (one for one in _number(name) if one.casefold() not in others)
        names[name] = next(one for one in options if is_free(folder / one, data))
    plans = ((row, row.get("plan", "")) for row in found.floors)
    floors = [{**row, "plan": names.get(plan, plan)} if plan else dict(row) for row, plan in plans]
    return replace(found, floors=floors, files={names[name]: data for name, data in found.files.items()})
