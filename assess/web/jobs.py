"""The simulation of a session: what it takes from the workbook, a process of its own, how far it is, what it leaves."""

import io
import json
import logging
import secrets
import shutil
import signal
import subprocess
import threading
import zipfile
from collections.abc import Mapping
from contextlib import suppress
from contextvars import copy_context
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from assess.errors import WorkbookError
from assess.i18n import Text, fill, gettext, spoken
from assess.model import Inventory
from assess.processes import start_module
from assess.report_formats import FILES
from assess.settings import change_settings
from assess.web.file_names import list_present
from assess.web.job_process import INPUT, LIMITS, ORDER, OUT, SUMMARY
from assess.web.limits import OWN, Limits
from assess.web.request_errors import NOT_FOUND, UNUSABLE, RequestError
from assess.web.slots import Slots
from assess.workbook.records import find_place

if TYPE_CHECKING:
    from assess.web.book import Book

PATIENCE = 0.5
"""Time that the process has to end by itself before it is killed [s]."""
ARCHIVE = "report.zip"
"""The name under which all files are given at once."""
REPORT = "report.html"
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
    "rendering": fill("Writing reports"),
}
"""What the stages are called; others by their own names."""
BUSY = fill("Other simulations are running. Try again in some minutes.")
"""Why there is no place for another."""


class Job:
    """One simulation of one version of a workbook; InputError for a wrong option or workbook, or no free slot."""

    def __init__(self, book: "Book", body: Mapping[str, Any], parent: Path, slots: Slots, limits: Limits = OWN) -> None:
        self.id, self._lock = secrets.token_hex(8), threading.RLock()
        self._folder = parent / f"job-{self.id}"
        self._now: dict[str, Any] = {
            "state": "running", "stage": "", "detail": "", "share": 0.0, "seconds_left": None, "message": "",
            "problems": [],
        }  # fmt: skip
        self._slot = slots.take()
        temporary = str(self._folder / TEMPORARY)  # out of the reach of a Ctrl-C in the terminal, too
        try:
            self._folder.mkdir(mode=0o700)
            self._order, self._inventory = prepare(book, body, self._folder)
            Path(temporary).mkdir()
            self._limits = limits
            (self._folder / LIMITS).write_text(json.dumps([limits.memory, limits.job_seconds]), encoding="utf-8")
            variables = dict.fromkeys(("TMPDIR", "TEMP", "TMP"), temporary)
            with (self._folder / ERRORS).open("wb") as errors:
                self._process = start_module("assess.web.job_process", self._folder, errors=errors, variables=variables)
        except BaseException:
            self._slot.release()
            shutil.rmtree(self._folder, ignore_errors=True)
            raise
        self._reader = threading.Thread(target=copy_context().run, args=(self._listen,), name="assess-job", daemon=True)
        self._reader.start()

    @property
    def is_running(self) -> bool:
        """Whether it has not ended yet."""
        return bool(self._now["state"] == "running")

    def _listen(self) -> None:
        """Follow the process to its end, then remove all that is no result."""
        lost = fill("The simulation ended unexpectedly; memory may have run out. Nothing was written.")
        last: dict[str, Any] = {"state": "failed", "message": gettext(lost)}
        with self._process as process:
            for line in process.stdout or ():
                message = json.loads(line)
                if "state" in message:
                    last = message
                elif self.is_running:
                    self._now.update(message)
        if process.returncode == -getattr(signal, "SIGXCPU", 0) != 0:
            n = self._limits.job_seconds
            slow = fill("The simulation takes more than {n:,.0f} s of processor time, which is the limit here.", n=n)
            last["message"] = gettext(slow)
        self._slot.release()
        with self._lock:
            if self.is_running:
                self._now.update(last)
            if self._now["state"] == "failed" and not self._now["problems"]:
                with suppress(OSError):  # what it wrote is shown in the window of the server
                    text = (self._folder / ERRORS).read_text(encoding="utf-8", errors="replace")[-MOST_SHOWN:]
                    if text:
                        LOG.error("a simulation ended with:\n%s", text)
            for name in (TEMPORARY, INPUT) if self._now["state"] == "done" else ("",):
                shutil.rmtree(self._folder / name, ignore_errors=True)

    def cancel(self) -> None:
        """End it at once and remove what it has written."""
        with self._lock:
            if not self.is_running:
                return
            self._now["state"] = "cancelled"
        self._process.terminate()
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
        self._reader.join(timeout=2 * PATIENCE)

    def close(self) -> None:
        """End it, and remove its results as well."""
        self.cancel()
        self._reader.join(timeout=2 * PATIENCE)
        shutil.rmtree(self._folder, ignore_errors=True)

    def summarise(self) -> dict[str, Any]:
        """Return what the page shows of it wherever it is."""
        with self._lock:
            now, label = self._now, gettext(STAGES.get(self._now["stage"], self._now["stage"].capitalize()))
            version = self._order["version"]
            return {"id": self.id, "label": label, "version": version, "state": now["state"], "share": now["share"]}

    def describe(self, book: "Book | None") -> dict[str, Any]:
        """Return all that the page shows; `book` is the workbook now, of which changed rows are found once."""
        with self._lock:
            order, found, stale = self._order, {"items": None, "before_after": None}, list[int]()
            is_old = book is None or book.version != order["version"]
            if is_old and book:
                now = book.snapshot()
                stale = now.keep(("stale", self.id), lambda: list_stale(self._inventory, now.inventory))
            if self._now["state"] == "done":
                found = json.loads((self._folder / SUMMARY).read_text(encoding="utf-8"))
            sizes = {path.name: path.stat().st_size for path in self._list_files()}
            sizes |= {ARCHIVE: sum(sizes.values())} if sizes else {}
            return {
                **self._now, **self.summarise(), "is_old": is_old, "stale": stale, "formats": order["formats"],
                "settings": order["settings"], **found,
                "files": [{"name": name, "bytes": size} for name, size in sizes.items()],
            }  # fmt: skip

    def _list_files(self) -> list[Path]:
        if self._now["state"] != "done":
            return []
        return sorted(path for path in (self._folder / OUT).iterdir() if path.is_file() and path.name[0] != ".")

    def read_file(self, name: str) -> bytes:
        """Return a file of its results, or all in one archive; RequestError where there is none of this name."""
        with self._lock:
            paths = {path.name: path for path in self._list_files()}
            if name == ARCHIVE and paths:
                stream = io.BytesIO()
                with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
                    for path in paths.values():
                        archive.write(path, path.name)
                return stream.getvalue()
            if name not in paths:
                raise RequestError(fill("The simulation has no file of this name."), NOT_FOUND)
            return paths[name].read_bytes()


FORMATS = tuple(name for name in FILES if name not in ("npz", "parquet"))
"""Files that the page offers; results.json is always written."""
OPTIONS = ("verify", "runs", "seed", "scale", "scenario")
"""Settings that the page may choose; fitted models and templates are code, and never come from a page."""
ITEM_INPUTS = (
    "item", "floor", "breadth", "width", "height", "centre_of_gravity", "weight", "bracket_height", "bracket_capacity",
    "axis", "anchored", "friction", "angle_deg", "quantity",
)  # fmt: skip
"""Fields of a piece by which its simulated chance, whether it counts as anchored, or how many it is, is found."""
BUILDING_INPUTS = (
    "storeys", "height", "period", "structure", "azimuth_deg", "scenario_kind", "class_by", "ground_pga", "ground_pgv",
    "sds", "shaking", "friction", "restitution", "motion_uncertainty", "piece_uncertainty",
)  # fmt: skip
"""Fields of the building by which the chances of all pieces are found."""
FLOOR_INPUTS = ("floor", "elevation", "pfa", "pfv", "records")
"""Fields of a floor; those of one floor serve the floors between, so that a change counts for all."""


def prepare(book: "Book", body: Mapping[str, Any], folder: Path) -> tuple[dict[str, Any], Inventory]:
    """Write the order of a job and a copy of the workbook with the files that it names.

    Returns the order of the process, with the version of the workbook, and what that holds. Raises InputError if an
    option cannot be used, a format needs a package that is not installed, or the workbook has errors: as `assess run`,
    which works with whole workbooks only.
    """
    from assess.report import check_folder

    changes = {name: body[name] for name in OPTIONS if body.get(name) not in (None, "")}
    first = body.get("first") or 0
    if isinstance(first, bool) or not isinstance(first, int) or first < 0:
        raise RequestError(fill("first is {first}, expected a whole number, 0 or above.", first=str(first)), UNUSABLE)
    changes |= {"anchor": f"first:{first}"} if first else {}
    change_settings(None, changes)
    given = body.get("formats", ["html"])
    formats = list(dict.fromkeys(map(str, given if isinstance(given, list) else [given])))
    unknown = [one for one in formats if one not in FORMATS] or ([] if formats else [""])
    if unknown:
        known = ", ".join(FORMATS)
        text = fill("formats: {name!r} is unknown, expected some of: {known}", name=unknown[0][:40], known=known)
        raise RequestError(text, UNUSABLE)
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
    order = {"workbook": book.name, "version": snapshot.version, "settings": changes, "formats": formats}
    (folder / ORDER).write_text(json.dumps({**order, "language": spoken().code}), encoding="utf-8")
    return order, snapshot.inventory


def list_stale(before: Inventory, now: Inventory) -> list[int]:
    """Return the rows of furniture that were simulated otherwise, are gone, or now have an error."""
    building, floor, piece = (attrgetter(*names) for names in (BUILDING_INPUTS, FLOOR_INPUTS, ITEM_INPUTS))
    known, left = {one.row: piece(one) for one in before.items}, {one.row for one in now.items}
    is_other = (
        building(before.building) != building(now.building)
        or (before.hazard, before.site_ground) != (now.hazard, now.site_ground)
        or [*map(floor, before.floors)] != [*map(floor, now.floors)]
    )
    changed = [one.row for one in now.items if is_other or known.get(one.row) != piece(one)]
    return [*changed, *(row for row in known if row not in left)]
