"""Plans of a model next to a workbook that is updated: which are written, and under which names. Files of users stay.

A plan is an import's where Floors names it, its name is one that an import gives, and its file is as an import draws
it. Only such files are replaced, and only plans that Floors names in the end are written.
"""

import re
from collections.abc import Collection, Iterable, Mapping
from itertools import chain
from pathlib import Path
from typing import Any

from assess.bim.floor_drawing import is_drawn, name_plan, number_plan
from assess.bim.import_workbook import ImportedBuilding
from assess.bim.update_cells import SheetUpdate
from assess.i18n import fill
from assess.workbook.names import key
from assess.workbook.parse import Row

PLAN = ("plan", "plan_left", "plan_bottom", "plan_width", "plan_turn")  # fields of Floors that tell of a plan
_NUMBER = re.compile(r"-\d+(?=\.svg$)", re.IGNORECASE)
"""What tells a plan from another file of its name: the 2 of ``a-1-2.svg``."""

Files = Path | Mapping[str, bytes] | None  # the folder of a workbook, or the files next to it


class PlanUpdate:
    """The plans of one update: `files` are to be written. `sheet` is Floors of the workbook, `sources` are names that
    the model had when it was imported, `beside` is the folder of the workbook, or the files in it.
    """

    def __init__(self, sheet: SheetUpdate, imported: ImportedBuilding, sources: Collection[str], beside: Files) -> None:
        self.files: dict[str, bytes] = {}
        self._sheet, self._imported, self._beside = sheet, imported, beside
        self._sources = {imported.source, *sources}
        self._wanted = {key(name) for name in imported.files}
        self._named = {key(row.get("plan")) for row in sheet.table.with_all("plan")}
        self._taken = set(self._named)

    def release(self, pairs: Iterable[tuple[Mapping[str, Any], Row]]) -> None:
        """Note the floors that are to be updated: others of them may get the names of their plans."""
        rows = {
            row.number
            for model, row in pairs
            if model.get("plan") and row.get("plan") and self._is_imported(model, row)
        }
        self._taken = {key(row.get("plan")) for row in self._sheet.table.with_all("plan") if row.number not in rows}

    def name_new(self, model: Mapping[str, Any]) -> dict[str, Any]:
        """Return the row of a new floor with the name under which its plan is written."""
        data = self._imported.files.get(model.get("plan", ""))
        if data is None or not self._sheet.can_hold("plan"):
            return dict(model)
        name = self._find_name(model["plan"], data)
        self._give(name, data)
        return {**model, "plan": name}

    def update(self, model: Mapping[str, Any], row: Row) -> None:
        """Update the plan of a floor that both have, unless it is one of people."""
        if not model.get("plan"):
            return
        sheet, own = self._sheet, row.get("plan")
        if own is not None and not self._is_imported(model, row):
            if key(own) == key(model["plan"]):
                sheet.note_row("kept", row, fill("{name} is not a plan of the import", name=own))
            sheet.keep(row, "plan", model["plan"], fill("it is not a plan of the import"))
            return
        name, data = model["plan"], self._imported.files.get(model["plan"])
        if data is not None:
            # that of today first, where it is the one that is wanted but for its number
            is_same = own is not None and key(_NUMBER.sub("", own)) in (key(name), key(_NUMBER.sub("", name)))
            name = self._find_name(name, data, (own,) if own is not None and is_same else ())
        for field in PLAN:
            sheet.replace(row, field, name if field == "plan" else model.get(field))
        if data is not None and sheet.can_hold("plan"):
            held = sheet.values.get(sheet.place("plan", row), row.get("plan"))  # the cell may be one that is not set
            if key(str(held)) == key(name):
                self._give(name, data)

    def _give(self, name: str, data: bytes) -> None:
        self._taken.add(key(name))
        if self._read(name) != data:
            self.files[name] = data

    def _find_name(self, wanted: str, data: bytes, first: Iterable[str] = ()) -> str:
        """Return the first name, `first` before the wanted one, under which no file of users and no other plan is."""
        others = self._taken | self._wanted - {key(wanted)}

        def is_free(name: str) -> bool:
            there = self._read(name)
            return there is None or there == data or (key(name) in self._named and is_drawn(there))

        return next(one for one in chain(first, number_plan(wanted)) if key(one) not in others and is_free(one))

    def _is_imported(self, model: Mapping[str, Any], row: Row) -> bool:
        """Tell whether the plan of a floor is one that an import wrote: of this model, or of an earlier name of it."""
        own, floors = row.get("plan"), {model["floor"], row.get("floor")}
        names = {key(name_plan(one, floor)) for one in self._sources for floor in floors} | self._wanted
        names.add(key(model.get("plan", "")))
        if not names & {key(own), key(_NUMBER.sub("", own))}:
            return False
        there = self._read(own)
        return there is None or is_drawn(there) or there in self._imported.files.values()

    def _read(self, name: str) -> bytes | None:
        if not isinstance(self._beside, Path):
            return (self._beside or {}).get(name)
        path = self._beside / name
        if not (path.exists() or path.is_symlink()):
            return None
        try:
            return path.read_bytes()
        except OSError:
            return b""
