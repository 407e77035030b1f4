"""One open workbook: its bytes, its cells in memory, what was edited, and the file on the disk that is saved.

The cells are those of `assess.workbook.store`, and are written by it. What differs from what was saved last is not
saved yet. All methods may be called from any thread.
"""

import secrets
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from threading import RLock
from typing import Any, Literal, Self

from assess.errors import AssessError, InputError, OutputError, WorkbookError
from assess.i18n import fill
from assess.pipeline.corrected import LiveRows, find_live_rows, find_results
from assess.web.cell_edits import Contents, EditsRefused, History, Step, change_rows, say, take_edits
from assess.web.columns import PageSheet, find_sheets, find_units, show
from assess.web.disk_file import ChangedOutsideError, DiskFile, find_hash
from assess.web.file_names import FILES, add_file, list_missing
from assess.web.journal import Journal, list_saved
from assess.web.request_errors import CONFLICT, UNAVAILABLE, UNUSABLE, RequestError
from assess.web.simulating import Simulator
from assess.web.snapshot import Snapshot
from assess.workbook.kept_files import KeptFiles
from assess.workbook.read import open_workbook, parse_workbook
from assess.workbook.schema import ITEMS
from assess.workbook.store import Workbook, is_same

__all__ = ["Book", "ChangedOutsideError", "EditsRefused", "Snapshot", "VersionError"]


class VersionError(RequestError):
    """The book has another version than the one that was to be changed; `state` is its state."""

    def __init__(self, state: dict[str, Any]) -> None:
        self.state = state
        super().__init__(fill("The workbook was changed elsewhere."), CONFLICT, more={"state": state})


class Book:
    """One open workbook; made by `open_disk` or `hold`."""

    def __init__(self, name: str, data: bytes, folder: Path, file: DiskFile | None, version: int = 1) -> None:
        self.name, self.folder, self._file = name, folder.resolve(), file
        self.version = version
        self._journal: Journal | None = None
        self.opening, self.remark = secrets.token_hex(8), ""
        self._lock, self._saving = RLock(), RLock()  # who needs both takes the one of saving first
        self._kept, self.simulator = KeptFiles(), Simulator()
        self._save_error, self._changed_outside = "", False
        self._hindrance = file.find_hindrance() if file else ""
        self._take_in(data)

    @classmethod
    def open_disk(cls, path: Path) -> Self:
        """Open a workbook that is saved to its file; WorkbookError where it is none."""
        file = DiskFile(path)
        return cls(path.name, file.read(), path.resolve().parent, file)

    @classmethod
    def hold(cls, name: str, data: bytes, folder: Path) -> Self:
        """Open the bytes of a workbook; files that it names are looked for in a folder of its own.

        Raises WorkbookError if they are no workbook.
        """
        return cls(name, data, folder, None)

    @classmethod
    def restore(cls, journal: Journal) -> Self | None:
        """Return the book that a process held which was killed: its version, history and file; None without one."""
        if not (head := journal.read_head()):
            return None
        data, steps = journal.read(head)
        file = DiskFile(Path(head["path"]), head["digest"]) if head["path"] else None
        book = cls(head["name"], data, Path(head["files"]), file, head["version"])
        book.opening = head["opening"]
        acts: dict[str, Callable[..., Any]] = {
            "edit": book.edit, "rows": book.change_rows, "undo": book.undo, "redo": book.redo,
        }  # fmt: skip
        marks, now = list_saved(head, steps), None
        if file is not None:
            with suppress(OSError):
                now = file.path.read_bytes()
        found = now and find_hash(now)
        saved_version, digest = next((one for one in reversed(marks) if one[1] == found), marks[0])
        for what, *given in steps:
            if what in acts:
                acts[what](book.version, *given)
            elif what == "file":
                book._note_file()
            if book.version == saved_version:
                book._saved = book._now.workbook
        if file is not None:
            book._saved_version, file.digest = saved_version, digest
            book._data = now if found == digest else None
        book._compare()
        book._journal = journal
        return book

    def keep_in(self, journal: Journal) -> None:
        """Have every step be written in a journal before it is answered."""
        with self._saving, self._lock:
            self._journal = journal
            path, digest = (str(self._file.path.absolute()), self._file.digest) if self._file else ("", "")
            journal.begin(
                self._opened.workbook.data, self.folder, name=self.name, path=path, digest=digest, opening=self.opening,
                version=self.version,
            )  # fmt: skip

    def _note(self, *step: Any) -> None:
        if self._journal is not None:
            try:
                self._journal.note(*step)
            except OSError as error:
                text = fill("A file cannot be used: {why}.", why=error.strerror or str(error))
                raise RequestError(text, UNAVAILABLE) from None

    def _note_save(self, what: str, version: int, digest: str) -> None:
        with self._lock, suppress(RequestError):  # without it, a kill has the file be called changed by another program
            self._note(what, version, digest)

    def _take_in(self, data: bytes) -> None:
        workbook = open_workbook(data, self.name)
        if not workbook.sheets:
            raise WorkbookError(workbook.problems)
        tables, _ = parse_workbook(workbook)
        self.sheets: dict[str, PageSheet] = find_sheets(workbook, tables)
        self.language, self.units = workbook.language, find_units(self.sheets)
        self._history = History()
        self._saved_version = self._read_version = self.version
        self._now = self._opened = self._snap(workbook)
        self._saved, self._is_saved = workbook, True
        self._data: bytes | None = data  # of the file, None where it is not known
        self._answered = "", dict[str, Any]()  # the last request that has changed it, and the answer
        self._opened_live: LiveRows | None = None
        self._written: tuple[Snapshot, bytes] = (self._now, data)
        self._missing: list[dict[str, Any]] | None = None

    def _snap(self, workbook: Workbook) -> Snapshot:
        return Snapshot(self.version, workbook, self.sheets, self.path or Path(self.name), self.folder, self._kept,
                        self.simulator)  # fmt: skip

    # ------------------------------------------------------------ what it is

    @property
    def mode(self) -> Literal["disk", "held"]:
        """Whether it is saved to its file, or downloaded."""
        return "held" if self._file is None else "disk"

    @property
    def path(self) -> Path | None:
        """The file on the disk."""
        return None if self._file is None else self._file.path

    def snapshot(self) -> Snapshot:
        """Return the book as it is now; it does not change with the book."""
        with self._lock:
            return self._now

    def state(self) -> dict[str, Any]:
        """Return what the page shows of the book as a whole."""
        with self._lock:
            return {
                "version": self.version,
                "server": self.opening,
                "saved_version": self._saved_version,
                "read_version": self._read_version,
                "unsaved": not self._is_saved,
                "save_error": say(self._save_error or self._hindrance),
                "changed_outside": self._changed_outside,
                "can_undo": self._history.at > 0,
                "can_redo": self._history.at < len(self._history.steps),
            }

    def describe(self) -> dict[str, Any]:
        """Return everything that the page shows of the cells and of the files."""
        with self._lock:
            now = self._now
            found = {
                "version": now.version,
                "name": self.name,
                "mode": self.mode,
                "language": self.language,
                "file": find_hash(str(self.path and self.path.resolve()).encode())[:16],
                "remark": say(self.remark),
                "units": self.units,
                "state": self.state(),
                "missing": self._find_missing(anew=True),
            }
        held = now.workbook.sheets
        return found | {"sheets": [one.describe(held.get(name)) for name, one in now.sheets.items()]}

    # ------------------------------------------------------------ edits

    def edit(self, version: int, edits: object, label: str, request: str = "") -> dict[str, Any]:
        """Change cells, all of them or none; return every cell that was edited, as it is now.

        `version` is that which the edits rest on, `edits` a list of ``[sheet, row, at, value]``, `label` what the step
        is, in a word, `request` what tells the request from others. Raises VersionError if the book has another
        version; EditsRefused if any cell cannot be changed so; InputError if `edits` is no list of edits.
        """
        with self._lock:
            self._check_version(version)
            workbook = self._now.workbook
            wanted = take_edits(edits, self.sheets, workbook)
            new = {place: workbook.sheets[place[0]].as_read(place[1:], value) for place, value in wanted.items()}
            old = {place: workbook.sheets[place[0]].value(place[1:]) for place in new}
            changed = {place: value for place, value in new.items() if not is_same(old[place], value)}
            step = Step(label, {place: old[place] for place in changed}, changed)
            if changed:
                self._apply(step, "edit", edits, label, request)
            return self._answer(request, self._describe_change(new))

    def change_rows(
        self, version: int, sheet: str, do: object, at: object, count: object, to: object = None, request: str = ""
    ) -> dict[str, Any]:
        """Insert, delete or move rows of a sheet, as `assess.web.cell_edits.change_rows`; one step of the history.

        Raises VersionError if the book has another version; InputError if they cannot be changed so.
        """
        with self._lock:
            self._check_version(version)
            found, workbook = self.sheets.get(sheet), self._now.workbook
        if found is None:
            raise InputError.about("The sheet is not known.")
        try:
            step = change_rows(found, workbook, do, at, count, to)
        except WorkbookError as error:
            one = error.problems[0]
            why = fill("{place}: {why}", place=one.place, why=one.message)
            raise RequestError(why, UNUSABLE, one.fix) from None
        with self._lock:
            self._check_version(version)
            return self._go(step, "rows", sheet, do, at, count, to, request)

    def undo(self, version: int, request: str = "") -> dict[str, Any]:
        """Take the last step back; raises VersionError if the book has another version."""
        with self._lock:
            self._check_version(version)
            return self._go(self._history.back(), "undo", request)

    def redo(self, version: int, request: str = "") -> dict[str, Any]:
        """Do the last step again that was taken back; raises VersionError if the book has another version."""
        with self._lock:
            self._check_version(version)
            return self._go(self._history.forward(), "redo", request)

    def _go(self, step: Step | None, *noted: Any) -> dict[str, Any]:
        if step is None:
            return self._describe_change({})
        self._apply(step, *noted)
        inserted = [row for one in step.shifts if one.back(one.at) is None for row in range(one.at, one.at + one.count)]
        cells = self._now.workbook.sheets[step.label].cells if inserted else {}
        found = {(step.label, row, at): None for row in inserted for at in cells.get(row, ())}
        rows = [[step.label, one.at, one.count, getattr(one, "to", None)] for one in step.shifts]
        return self._answer(noted[-1], {**self._describe_change({**step.after, **found}), "rows": rows})

    def _answer(self, request: str, answer: dict[str, Any]) -> dict[str, Any]:
        self._answered = request, answer
        return answer

    def find_answer(self, request: str) -> dict[str, Any] | None:
        """Return the answer to a request that comes again; None of any but the very last that has changed it."""
        with self._lock:
            known, answer = self._answered
            is_last = bool(request) and known == request and answer["state"]["version"] == self.version
            return {**answer, "state": self.state()} if is_last else None

    def _check_version(self, version: int) -> None:
        if version != self.version:
            raise VersionError(self.state())

    def _apply(self, step: Step, *noted: Any) -> None:
        by_sheet: dict[str, dict[tuple[int, int], Any]] = {}
        for (sheet, row, at), value in step.after.items():
            by_sheet.setdefault(sheet, {})[row, at] = value
        workbook = step.books[1] if step.books else self._now.workbook.put(by_sheet)
        self._note(*noted)
        self._history.take(step, noted[0])
        self.version += 1
        self._now = self._snap(workbook)
        self._compare()
        columns = ((sheet, self.sheets[sheet].find(row, at)) for sheet, row, at in step.after)
        if step.books or any(one and one.column and (sheet, one.column.name) in FILES for sheet, one in columns):
            self._missing = None

    def _compare(self) -> None:
        self._is_saved = not self._now.workbook.differs(self._saved)
        if self._is_saved:
            self._saved_version = self.version

    def _describe_change(self, places: Contents) -> dict[str, Any]:
        held = self._now.workbook.sheets
        shown = [[sheet, row, at, show(held[sheet].value((row, at)))] for sheet, row, at in places]
        return {
            "state": self.state(), "cells": shown, "language": self.language, "missing": self._find_missing(),
        }  # fmt: skip

    # ------------------------------------------------------------ bytes and the disk

    def write(self) -> bytes:
        """Return the workbook with all changes and the live values that follow; its very bytes where nothing differs.

        Raises WorkbookError if something in it cannot be changed with certainty.
        """
        return self._write()[1]

    def _write(self) -> tuple[Snapshot, bytes]:
        with self._saving:
            with self._lock:
                now, opened, live, written = self._now, self._opened, self._opened_live, self._written
                if self._is_saved and self._data is not None:
                    return now, self._data
            if written[0] is now:  # a file that was added changes results as well
                return now, written[1]
            if live is None:
                is_live = bool(self.sheets[ITEMS.name].live)
                live = find_live_rows(opened.tables, opened.inventory) if is_live else {}
            data = now.workbook.data
            if now.workbook.differs(opened.workbook):
                results = find_results(now.workbook, now.tables, now.inventory, live)
                data = now.workbook.store(results).to_bytes()
            with self._lock:
                if self._opened is opened:
                    self._opened_live, self._written = live, (now, data)
            return now, data

    def save(self) -> None:
        """Save the changes to the file, whole or not at all; ChangedOutsideError if another program has changed it.

        ``state()["save_error"]`` says why a file cannot be written (read-only, gone, no space); nothing is lost.
        """
        if self._file is None:
            return
        try:
            with self._saving:
                with self._lock:
                    is_saved = self._is_saved
                now, data = self._write()
                if not is_saved:
                    self._file.replace(data, lambda digest: self._note_save("saving", now.version, digest))
                with self._lock:
                    self._save_error = self._hindrance = ""
                    if not is_saved:
                        self._changed_outside, self._saved_version = False, now.version
                        self._saved, self._data = now.workbook, data
                        self._compare()  # more may have been edited meanwhile
                        self._note_save("saved", now.version, self._file.digest)
        except ChangedOutsideError:
            with self._lock:
                self._changed_outside = True
            raise
        except (OutputError, WorkbookError) as error:
            with self._lock:
                self._save_error = error.message

    def check_outside(self) -> bool:
        """Return whether another program has changed the file since it was opened or saved."""
        if self._file is None:
            return False
        with self._saving:
            is_changed, hindrance = self._file.is_changed(), self._file.find_hindrance()
        with self._lock:
            self._changed_outside, self._hindrance = is_changed, hindrance
        return is_changed

    def follow_outside(self) -> None:
        """Read a file again that another program has changed, unless that would drop changes.

        One that cannot be read, such as one that is still being written, is tried at the next call.
        """
        with self._saving, self._lock, suppress(AssessError, OSError):
            if self.check_outside() and self._is_saved:
                self.reload()

    def reload(self) -> None:
        """Read the file again; what was not saved, and the history, are dropped.

        Raises WorkbookError if it is no longer a workbook; the book stays as it is.
        """
        if self._file is None:
            return
        with self._saving, self._lock:
            file = DiskFile(self._file.path)
            data = file.read()
            self.version += 1
            self._take_in(data)
            self._file, self._save_error, self._changed_outside = file, "", False
            self._hindrance = file.find_hindrance()
            if self._journal is not None:
                self.keep_in(self._journal)

    # ------------------------------------------------------------ the files that it names

    def _find_missing(self, *, anew: bool = False) -> list[dict[str, Any]]:
        if self._missing is None or anew:
            self._missing = list_missing(self._now.workbook, self.sheets, self.folder)
        return self._missing

    def add_file(self, name: str, data: bytes) -> None:
        """Write a file that it names and that is missing; the book gets a new version.

        Raises InputError if it names no such file, or the file is there; OutputError if it cannot be written.
        """
        with self._lock:
            add_file(name, data, self._find_missing(anew=True), self.folder)
            self._note("file")
            self._note_file()

    def _note_file(self) -> None:
        self.version += 1
        self._now, self._missing = self._snap(self._now.workbook), None
