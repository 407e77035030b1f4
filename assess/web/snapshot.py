"""A book at one version: nothing of it changes, so that answers can be worked out while the book is edited."""

from collections import OrderedDict
from collections.abc import Callable, Hashable, Mapping
from pathlib import Path
from threading import Lock, RLock
from typing import TypeVar

from assess.errors import Problem
from assess.model import Inventory
from assess.plans import Drawing
from assess.progress import SILENT
from assess.web.columns import PageSheet
from assess.web.simulating import Simulator
from assess.workbook.kept_files import KeptFiles
from assess.workbook.parse import Tables
from assess.workbook.picture_files import PictureReader
from assess.workbook.read import build_inventory, parse_workbook
from assess.workbook.store import Workbook

T = TypeVar("T")
MOST_FOUND = 12
"""How much of what was worked out from a version is kept, the latest: an assessment of 20,000 rows takes 60 MB."""


class Snapshot:
    """One version of a book: its cells, and its sheets with their columns by their English names.

    * `path`: the workbook, which may lie in no folder.
    * `files`: the folder in which the files that it names are looked for.
    * `simulator`: what simulates the pieces, and knows what they did in all versions of the book.
    """

    def __init__(
        self, version: int, workbook: Workbook, sheets: Mapping[str, PageSheet], path: Path, files: Path,
        kept: KeptFiles, simulator: Simulator,
    ) -> None:  # fmt: skip
        self.version, self.workbook, self.sheets, self.path, self.files = version, workbook, sheets, path, files
        self._kept, self.simulator = kept, simulator
        self._lock, self._reading_lock = Lock(), Lock()
        self._keeping: dict[Hashable, RLock] = {}
        self._found: OrderedDict[Hashable, tuple[int, object]] = OrderedDict()
        self._read: tuple[Tables, Inventory] | None = None

    @property
    def stamp(self) -> str:
        """What tells its state from others: its version, and how much has been simulated."""
        return f"{self.version}.{self.simulator.arrived}"

    @property
    def tables(self) -> Tables:
        """The typed rows of every sheet, those with errors among them."""
        return self._reading()[0]

    @property
    def inventory(self) -> Inventory:
        """What the workbook holds; rows with errors are left out. It has neither bytes nor their hash."""
        return self._reading()[1]

    @property
    def problems(self) -> tuple[Problem, ...]:
        """All problems, errors among them."""
        return self._reading()[1].problems

    def keep(self, name: Hashable, make: Callable[[], T], at: int = 0) -> T:
        """Return what `make` works out from it, once for all who ask under this name, and anew where `at` is later."""
        with self._lock:
            lock = self._keeping.setdefault(name, RLock())
        with lock:
            found: tuple[int, object] | None = self._found.get(name)
            if found is None or found[0] != at:
                found = at, make()
            with self._lock:
                self._found[name] = found
                self._found.move_to_end(name)
                if len(self._found) > MOST_FOUND:
                    self._found.popitem(last=False)
            return found[1]  # type: ignore[return-value]

    def find_drawing(self, text: str, width: float | None) -> Drawing | None:
        """Return what is drawn of the plan of a floor, placed or not; None where its file cannot be used.

        `text` is the file as the floor names it, `width` the width of the whole plan [m], where it is filled in.
        """
        with self._kept.lock:
            return PictureReader(self.files, SILENT, self._kept).find_drawing(text, width)

    def _reading(self) -> tuple[Tables, Inventory]:
        """Return what is read of the cells: once, by the first who asks."""
        with self._reading_lock:
            if self._read is None:
                tables, problems = parse_workbook(self.workbook)
                with self._kept:
                    inventory = build_inventory(tables, problems, self.path, self.files, SILENT, self._kept)
                self._read = tables, inventory
            return self._read
