"""The runs of a session: what each takes from the workbook, a process of its own, how far it is, its files.

A run has one folder: its results are kept there, so that its files are made as they are asked for, one after another.
"""

import json
import logging
import secrets
import shutil
import signal
import subprocess
import threading
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from contextvars import copy_context
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from assess.errors import WorkbookError
from assess.i18n import Text, fill, gettext, spoken
from assess.model import Inventory
from assess.processes import start_module
from assess.report_formats import FILES
from assess.settings import change_settings
from assess.web.file_names import list_present
from assess.web.job_process import INPUT, ORDER, OUT, RESULTS, SUMMARY
from assess.web.limits import Limits
from assess.web.request_errors import CONFLICT, NOT_FOUND, UNUSABLE, RequestError
from assess.web.slots import Slots
from assess.workbook.records import find_place

if TYPE_CHECKING:
    from assess.compare.comparison_document import View
    from assess.web.book import Book

PATIENCE = 0.5
"""Time that the process has to end by itself before it is killed [s]."""
PREFIX = "job-"
"""Beginning of the name of the folder of a run."""
MOST_RUNS = 10
"""Runs that are kept; the oldest goes first."""
MOST_CHANGED = 40
"""Pieces that a comparison names."""
TEMPORARY, ERRORS = "tmp", "errors.txt"
MOST_SHOWN = 4000
"""Characters of what a process that broke down has written."""
LOG = logging.getLogger("assess.web")
STAGES: Mapping[str, Text] = {
    "": fill("Starting"),
    "reading": fill("Reading"),
    "motions": fill("Preparing motions"),
    "verification": fill("Simulating"),
    "rocking": fill("Simulating"),
    "routes": fill("Evaluating routes"),
}
"""What the stages until the results are called; others by their own names."""
PARTS: Mapping[str, tuple[float, float]] = {
    "reading": (0.0, 0.05), "motions": (0.05, 0.3), "verification": (0.1, 0.95), "rocking": (0.3, 0.95),
    "routes": (0.95, 1.0),
}  # fmt: skip
"""How much of the way to the results is done at their beginnings and ends [-]."""
SIMULATING, BY_FORMULA, FASTEST = 15.0, 3.0, 0.3
WEIGHTS: Mapping[str, float] = {"html": 6.0, "pdf": 6.5, "annex": 16.5, "work": 5.0, "docx": 3.0, "xlsx": 0.5}
"""Times that results, and the file of each format, took of the worked example [s]: how they are to each other."""
BUSY = fill("Other simulations are running. Try again in some minutes.")
"""Why there is no place for another."""
RUNNING = fill("A run is at work already.")
LOST = fill("The run ended unexpectedly; memory may have run out.")
SLOW = fill("The run takes more than {n:,.0f} s of processor time, which is the limit here.", n=0)
FORMATS = tuple(name for name in FILES if name not in ("npz", "parquet"))
"""Files that the page offers; results.json is always written."""
OPTIONS = ("verify", "runs", "seed", "scale", "scenario")
"""Settings that the page may choose; fitted models and templates are code, and never come from a page."""


class Run:
    """The assessment of one version of a workbook, and its files; where it is not given, that of an earlier process."""

    def __init__(self, folder: Path, order: Mapping[str, Any], inventory: Inventory | None = None) -> None:
        self.id, self.folder, self._order, self._inventory = folder.name.removeprefix(PREFIX), folder, order, inventory
        self._lock = threading.RLock()
        self._now: dict[str, Any] = {"state": "done", "stage": "", "detail": "", "message": "", "problems": []}
        self._faults: dict[str, str] = {}
        self._wanted: list[str] = []
        self._steps: list[tuple[str, float]] = []  # of the batch at work: formats, "" for the results, and weights
        self._done, self._since, self._within, self._share, self._pace = 0, 0.0, 0.0, 0.0, 1.0
        self._process: subprocess.Popen[bytes] | None = None
        self._reader: threading.Thread | None = None

    @property
    def is_running(self) -> bool:
        """Whether its process is at work."""
        return bool(self._now["state"] == "running")

    @property
    def has_results(self) -> bool:
        """Whether its results are there."""
        return (self.folder / RESULTS).is_file()

    # ------------------------------------------------------------ its process

    def make(self, formats: Sequence[str], slots: Slots) -> None:
        """Have files be made, after those that are being made; RequestError where there is no place for a process."""
        with self._lock:
            new = [one for one in formats if one not in self._wanted and self._find(one) is None]
            if not new:
                return
            slot = None if self.is_running else slots.take()
            if slot is not None:
                self._steps, self._done, self._share = [], 0, 0.0
                if not self.has_results:
                    is_long = self._order["settings"].get("verify") != "none"
                    self._steps.append(("", SIMULATING if is_long else BY_FORMULA))
            for name in new:
                self._faults.pop(name, None)
                shutil.rmtree(self.folder / OUT / name, ignore_errors=True)
            self._wanted += [one for one in new if one != "json"]  # it is there with the results
            self._steps += [(one, WEIGHTS.get(one, FASTEST)) for one in new if one != "json"]
            self._write_order()
            if slot is not None:
                self._now |= {"state": "running", "stage": "", "detail": "", "message": "", "problems": []}
                self._since = time.monotonic()
                work = copy_context().run
                self._reader = threading.Thread(target=work, args=(self._work, slot), name="assess-job", daemon=True)
                self._reader.start()

    def _write_order(self) -> None:
        part = self.folder / f"{ORDER}.part"
        part.write_text(json.dumps({**self._order, "formats": self._wanted}), encoding="utf-8")
        part.replace(self.folder / ORDER)

    def _work(self, slot: Any) -> None:
        """Follow its process to its end; start it again where files were asked for as it ended."""
        temporary = self.folder / TEMPORARY  # out of the reach of a Ctrl-C in the terminal, too
        variables = dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(temporary))
        while True:
            temporary.mkdir(exist_ok=True)
            with (self.folder / ERRORS).open("wb") as errors, self._lock:
                process = self._process = start_module(
                    "assess.web.job_process", self.folder, errors=errors, variables=variables
                )
                if not self.is_running:
                    process.kill()
            last: dict[str, Any] = {"state": "failed", "message": gettext(LOST)}
            with process:
                for line in process.stdout or ():
                    message = json.loads(line)
                    last = message if "state" in message else last
                    with self._lock:
                        self._note(message)
            shutil.rmtree(temporary, ignore_errors=True)
            if process.returncode == -getattr(signal, "SIGXCPU", 0) != 0:
                last["message"] = gettext(fill(SLOW.template, n=self._order["limits"][1]))
            with self._lock:
                self._wanted = [one for one in self._wanted if not (self.folder / OUT / one).exists()]
                if self.is_running and last["state"] == "done" and self._wanted:
                    continue
                self._process = None
                self._end(last)
                slot.release()
                return

    def _note(self, message: Mapping[str, Any]) -> None:
        """Note what its process tells."""
        if "stage" in message:
            start, end = PARTS.get(message["stage"], (0.0, 0.0))
            self._within = max(self._within, start + (end - start) * message["share"])
            self._now |= {name: message[name] for name in ("stage", "detail")}
        elif "writing" in message:
            self._now |= {"stage": message["writing"], "detail": ""}
            self._since, self._within = time.monotonic(), 0.0
        elif "written" in message or "found" in message:
            name = message.get("written", "")
            if name in self._wanted:
                self._wanted.remove(name)
            if message.get("message"):
                self._faults[name] = message["message"]
            weight = dict(self._steps).get(name, 0.0)
            if weight >= 1:
                self._pace = max(time.monotonic() - self._since, 0.1) / weight
            self._done = min(self._done + 1, len(self._steps))
            self._since, self._within = time.monotonic(), 0.0

    def _end(self, last: Mapping[str, Any]) -> None:
        """Note its end, and remove all that is no result."""
        if self.is_running:
            self._now |= last
        if self._now["state"] == "failed":
            if not self._now["problems"]:
                with suppress(OSError):  # what it wrote is shown in the window of the server
                    text = (self.folder / ERRORS).read_text(encoding="utf-8", errors="replace")[-MOST_SHOWN:]
                    if text:
                        LOG.error("a run ended with:\n%s", text)
            if self.has_results and self._wanted:  # all else of it is there
                self._faults[self._wanted[0]] = self._now["message"]
        if self.has_results:
            self._now["state"] = "done"
        self._wanted = []
        for path in self.folder.glob(f"{OUT}/.*"):
            shutil.rmtree(path, ignore_errors=True)
        shutil.rmtree(self.folder / INPUT if self.has_results else self.folder, ignore_errors=True)

    def cancel(self) -> None:
        """End its process at once, and remove what is not whole."""
        with self._lock:
            process, reader = self._process, self._reader
            if not self.is_running:
                return
            self._now["state"] = "cancelled"
        if process is not None:
            process.terminate()
            try:
                process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                process.kill()
        if reader is not None:
            reader.join(timeout=2 * PATIENCE)

    def remove(self) -> None:
        """End it, and remove its results as well."""
        self.cancel()
        shutil.rmtree(self.folder, ignore_errors=True)

    # ------------------------------------------------------------ what the page shows

    def _find(self, name: str) -> Path | None:
        path = self.folder / OUT / name / FILES[name]
        return path if path.is_file() else None

    def _measure(self) -> tuple[float, float | None]:
        """Return how much of the batch is done [-], never less than before, and an estimate of the time left [s]."""
        weights = [weight for _name, weight in self._steps]
        spent, name = time.monotonic() - self._since, self._steps[self._done][0] if self._done < len(weights) else ""
        here = weights[self._done] if self._done < len(weights) else 0.0
        left: float | None
        if name:
            left = max(here * self._pace - spent, 1.0)
            within = min(spent / max(here * self._pace, 0.1), 0.95)
        else:
            within, left = self._within, None
            if within > 0.1:
                left = spent * (1 - within) / within
        done = (sum(weights[: self._done]) + within * here) / max(sum(weights), 0.1)
        self._share = max(self._share, min(done, 1.0))
        return self._share, None if left is None else left + self._pace * sum(weights[self._done + 1 :])

    def summarise(self) -> dict[str, Any]:
        """Return what the page shows of it wherever it is."""
        with self._lock:
            stage = self._now["stage"]
            label = gettext(STAGES.get(stage, stage.capitalize()))
            if stage in FILES:
                label = gettext("Writing {name}", name=FILES[stage])
            share, left = self._measure() if self.is_running else (1.0, None)
            return {
                "id": self.id, "state": self._now["state"], "label": label, "share": share, "seconds_left": left,
                "version": self._order["version"], "time": self._order["time"], "settings": self._order["settings"],
                "has_results": self.has_results,
            }  # fmt: skip

    def describe(self, book: "Book | None") -> dict[str, Any]:
        """Return all that the page shows; `book` is the workbook now, which may be another than that of the run."""
        with self._lock:
            is_old = book is None or book.version != self._order["version"]
            if is_old and book is not None and self._inventory is not None:
                now = book.snapshot()
                is_old = now.keep(("old", self.id), lambda: self._inventory != now.inventory)
            files = []
            for name in FORMATS:
                path, fault = self._find(name), self._faults.get(name, "")
                state = "there" if path else "failed" if fault else ""
                if name in self._wanted:
                    state = "writing" if self._now["stage"] == name else "waiting"
                size = path.stat().st_size if path else None
                files.append({"format": name, "name": FILES[name], "state": state, "bytes": size, "message": fault})
            more = {name: self._now[name] for name in ("stage", "detail", "message", "problems")}
            return {**self.summarise(), **more, "is_old": is_old, "files": files, "found": self._read_summary()}

    def _read_summary(self) -> dict[str, Any] | None:
        if not self.has_results:
            return None
        found = json.loads((self.folder / SUMMARY).read_text(encoding="utf-8"))
        own: dict[str, Any] = found.get(spoken().code, found["en"])
        return own

    def sum_up(self) -> dict[str, Any]:
        """Return its line in the list of runs."""
        found = self._read_summary() or {}
        files = [{"format": name, "name": FILES[name]} for name in FORMATS if self._find(name)]
        return {**self.summarise(), "outcome": found.get("outcome", ""), "files": files}

    def read_file(self, name: str) -> bytes:
        """Return a file by its name; RequestError where there is none."""
        path = next((found for one in FORMATS if FILES[one] == name and (found := self._find(one))), None)
        if path is None:
            raise RequestError(fill("The run has no file of this name."), NOT_FOUND)
        return path.read_bytes()


class Runs:
    """The runs of a session, the latest last; those that an earlier process of the session has left are among them."""

    def __init__(self, parent: Path, limits: Limits) -> None:
        self._parent, self._limits, self._lock = parent, limits, threading.RLock()
        self._slots = Slots(parent.parent, "simulations", limits.simulations, BUSY)
        self._every: list[Run] = []
        for folder in parent.glob(f"{PREFIX}*"):
            with suppress(OSError, ValueError):
                if (folder / RESULTS).is_file():
                    self._every.append(Run(folder, json.loads((folder / ORDER).read_text(encoding="utf-8"))))
        self._every.sort(key=lambda one: one.summarise()["time"])

    @property
    def latest(self) -> Run | None:
        """The latest run."""
        with self._lock:
            return self._every[-1] if self._every else None

    def find_running(self) -> Run | None:
        """Return the one that is at work."""
        with self._lock:
            return next((one for one in self._every if one.is_running), None)

    def begin(self, book: "Book", body: Mapping[str, Any]) -> None:
        """Begin a run of the workbook as it is; InputError for a wrong option or workbook, or no free slot."""
        with self._lock:
            if self.find_running() is not None:
                raise RequestError(RUNNING, CONFLICT)
            folder = self._parent / f"{PREFIX}{secrets.token_hex(8)}"
            folder.mkdir(mode=0o700)
            try:
                order, inventory, formats = prepare(book, body, folder, self._limits)
                run = Run(folder, order, inventory)
                run.make(formats, self._slots)
            except BaseException:
                shutil.rmtree(folder, ignore_errors=True)
                raise
            self._every = [one for one in self._every if one.has_results]
            for old in self._every[: -MOST_RUNS + 1]:
                self.remove(old.id)
            self._every.append(run)

    def find(self, name: str = "") -> Run:
        """Return a run by its id, the latest without one; RequestError where there is none."""
        with self._lock:
            found = next((one for one in reversed(self._every) if not name or one.id == name), None)
        if found is None:
            raise RequestError(fill("There is no such run."), NOT_FOUND)
        return found

    def make(self, name: str, formats: Sequence[str]) -> None:
        """Have files of a run be made."""
        from assess.report import check_folder

        with self._lock:
            run = self.find(name)
            if self.find_running() not in (None, run):
                raise RequestError(RUNNING, CONFLICT)
            check_folder(run.folder / OUT, formats)
            run.make(formats, self._slots)

    def remove(self, name: str) -> None:
        """Remove a run with its files."""
        with self._lock:
            run = self.find(name)
            self._every.remove(run)
        run.remove()

    def list_all(self) -> list[dict[str, Any]]:
        """Return those that have results, the latest first."""
        with self._lock:
            return [one.sum_up() for one in reversed(self._every) if one.has_results]

    def compare(self, before: str, after: str) -> "View":
        """Compare the results of two runs."""
        from assess.compare.changes import compare
        from assess.compare.comparison_document import View
        from assess.compare.past_run import read_run

        runs = [self.find(one).folder / OUT / "json" for one in (before, after)]
        return View(compare(*map(read_run, runs)))

    def close(self) -> None:
        """End what is at work."""
        for one in list(self._every):
            one.cancel()

    def clear(self) -> None:
        """Remove all of them."""
        with self._lock:
            every, self._every = self._every, []
        for one in every:
            one.remove()


def describe_comparison(view: "View") -> dict[str, Any]:
    """Return what changed between two runs, in the language in use: the words of `assess compare`."""
    from assess.compare.changes import Direction
    from assess.compare.comparison_document import mark_standing, name_direction, name_state, say_inputs
    from assess.report.blocks import Cell, plain_words
    from assess.report.words import say_chance

    def say(chance: Any) -> str:
        return "" if chance is None else say_chance(chance.probability, chance.low, chance.high)

    def read(rows: Sequence[Any]) -> list[list[str]]:
        return [[plain_words(one.words if isinstance(one, Cell) else one) for one in row.cells] for row in rows]

    found, changed = view.found, []
    for one in found.pieces:
        if one.direction != Direction.SAME:
            sides = [
                f"{plain_words(mark_standing(state))} {say(side.chance if side and not side.is_held else None)}".strip()
                for side, state in zip(one.sides, one.states, strict=True)
            ]
            changed.append([one.row.item, *sides, name_direction(one.direction), "; ".join(say_inputs(one))])
    ways = [
        [one.row.name, *(f"{name_state(state)} {say(side and side.chance)}".strip()
                         for side, state in zip(one.sides, one.states, strict=True)), name_direction(one.direction)]
        for one in (*found.routes, *found.rooms) if one.direction != Direction.SAME
    ]  # fmt: skip
    return {
        "headline": view.headline, "tone": view.tone, "warnings": list(view.list_warnings()),
        "counts": read(view.list_counts()), "routes": read(view.list_route_counts()),
        "pieces": changed[:MOST_CHANGED], "ways": ways[:MOST_CHANGED], "more": max(len(changed) - MOST_CHANGED, 0),
        "conditions": view.conditions, "footer": view.footer,
    }  # fmt: skip


def read_formats(given: object) -> list[str]:
    """Return the formats that a request names; RequestError if one is unknown, or it names none."""
    formats = list(dict.fromkeys(map(str, given if isinstance(given, list) else [given])))
    unknown = [one for one in formats if one not in FORMATS] or ([] if formats else [""])
    if unknown:
        known = ", ".join(FORMATS)
        text = fill("formats: {name!r} is unknown, expected some of: {known}", name=unknown[0][:40], known=known)
        raise RequestError(text, UNUSABLE)
    return formats


def prepare(
    book: "Book", body: Mapping[str, Any], folder: Path, limits: Limits
) -> tuple[dict[str, Any], Inventory, list[str]]:  # fmt: skip
    """Copy the workbook with the files that it names into the folder of a run.

    Returns the order of the process, what the workbook holds, and the formats that are asked for. Raises InputError if
    an option cannot be used, a format needs a package that is not installed, or the workbook has errors: as `assess
    run`, which works with whole workbooks only.
    """
    from assess.report import check_folder

    changes = {name: body[name] for name in OPTIONS if body.get(name) not in (None, "")}
    first = body.get("first") or 0
    if isinstance(first, bool) or not isinstance(first, int) or first < 0:
        raise RequestError(fill("first is {first}, expected a whole number, 0 or above.", first=str(first)), UNUSABLE)
    changes |= {"anchor": f"first:{first}"} if first else {}
    change_settings(None, changes)
    formats = read_formats(body.get("formats", ["html"]))
    check_folder(folder / OUT, formats)
    snapshot, data = book.snapshot(), book.write()
    while book.version != snapshot.version:
        snapshot, data = book.snapshot(), book.write()
    if any(one.severity == "error" for one in snapshot.problems):
        raise WorkbookError(snapshot.problems, snapshot.inventory.language)
    source = folder / INPUT
    source.mkdir(parents=True)
    (source / book.name).write_bytes(data)
    for name, path in list_present(snapshot.workbook, snapshot.sheets, snapshot.files).items():
        target = find_place(name, source)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, target)
    order = {
        "workbook": book.name, "version": snapshot.version, "settings": changes, "language": spoken().code,
        "time": datetime.now(UTC).isoformat(timespec="milliseconds"), "limits": [limits.memory, limits.job_seconds],
    }  # fmt: skip
    return order, snapshot.inventory, formats
