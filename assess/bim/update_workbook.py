"""A building model imported again: what it tells goes into a workbook that people have filled in since, and no more.

A workbook does not remember what the last import wrote, so a value that people changed cannot be told from an old one
of the model. The model therefore owns what it alone measures: floor, room, sizes and position of the pieces whose
Source ID it has, positions and outlines of places, sizes of its types. These follow it wherever they differ by more
than rounding, and each old value is listed; sizes that are marked as measured stay. All else is what people typed, and
stays: type and description, weights, fixings, notes, routes, costs, names of floors and rooms, and every row that the
model does not know. Nothing is ever cleared or deleted.

Cells are set in the bytes of the sheets; the stored results of the live formulas follow, as where cells are corrected.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from math import hypot
from pathlib import Path
from typing import Any, TypeVar

from assess.bim.building_model import Point
from assess.bim.import_workbook import ImportedBuilding, list_rows, name_apart
from assess.bim.update_cells import RENAMED, TOLERANCE, Change, Rows, SheetUpdate, describe
from assess.bim.update_names import Named, Pair, find_offset, match_alike, match_floors, match_rooms, move_rows
from assess.bim.update_plans import PLAN, Files, PlanUpdate
from assess.errors import InputError, Problem, WorkbookError
from assess.i18n import LANGUAGES, fill, load_catalogue, speaking
from assess.model import MEASURED
from assess.pipeline.corrected import write_workbook
from assess.progress import SILENT, Progress
from assess.workbook.catalogue import read_catalogue
from assess.workbook.names import key
from assess.workbook.parse import Row, Table
from assess.workbook.read import open_workbook, parse_workbook
from assess.workbook.schema import CATALOGUE
from assess.workbook.store import Worksheet
from assess.workbook.values import read_text

__all__ = ["Change", "Updated", "describe", "update_workbook"]

SIZES = ("breadth", "width", "height")
POSITION = ("x", "y", "angle_deg")
PLACE = ("x", "y", "outline")
"""Fields of Places that the model owns."""
SITE = ("latitude", "longitude", "azimuth_deg")
"""Lines of Building that are filled in where they are blank."""
NEAR = 0.05
"""Distance up to which two places are at one position [m]."""
_IDLE = frozenset({"Places"})
"""Sheets on which no live formula rests."""
_Row = TypeVar("_Row", Row, Mapping[str, Any])


@dataclass(frozen=True, slots=True)
class Updated:
    """A workbook after an update: the very bytes from before where no cell was to change.

    `changes` is all that was done, and all that was not; `problems` is why new rows could not be added. `moved` was
    added to all positions of the model, so that they have the origin of the workbook [m]. `plans` are to be written
    next to the workbook: those that Floors names, under names that no file of users has.
    """

    data: bytes
    changes: tuple[Change, ...] = ()
    problems: tuple[Problem, ...] = ()
    moved: Point = (0.0, 0.0)
    plans: Mapping[str, bytes] = field(default_factory=dict)

    @property
    def is_changed(self) -> bool:
        """Whether any cell was changed."""
        return any(one.kind in ("changed", "added") for one in self.changes)


def update_workbook(
    data: bytes, imported: ImportedBuilding, name: str, progress: Progress = SILENT, *, records: Files = None
) -> Updated:
    """Bring a workbook up to date with the building model that it was imported from: a second time changes nothing.

    `data`: the workbook as people have filled it in, in any language, units and order of columns; messages call it
    `name`. `imported`: what the model tells now; pieces without a Source ID are not used. `records`: the folder of the
    workbook, or the files next to it: stored results of live formulas may rest on these, and plans replace none of them
    but earlier plans.

    Raises InputError if the model has no furniture, or the workbook has no Source ID of it; WorkbookError if the
    workbook cannot be opened, or something in it cannot be changed with certainty.
    """
    workbook = open_workbook(data, name, progress)
    tables, found = parse_workbook(workbook)
    if not tables["Items"].rows and any(
        one.severity == "error" and one.sheet == tables["Items"].sheet.name for one in found
    ):
        raise WorkbookError(found, workbook.language)
    changes, problems = list[Change](), list[Problem]()
    sheets = {
        one: SheetUpdate(table, workbook.sheets.get(one, Worksheet(one, {})), changes, problems)
        for one, table in tables.items()
    }
    update = _Update(imported, name, sheets, records)
    update.run()
    written = workbook.set({sheet: one.values for sheet, one in sheets.items() if one.values})
    if written.differs(workbook):
        is_idle = all(one in _IDLE for one, sheet in sheets.items() if sheet.values)
        data = written.to_bytes(progress) if is_idle else write_workbook(written, Path(name), records, progress)[0]
    return Updated(data, tuple(changes), tuple(problems), update.moved, update.plans.files)


class _Update:
    """One update: it works out everything that is to be written.

    `floors` and `rooms` are the names of the workbook by those of the model, as names are compared; of rooms with the
    floor before. `types` is what Items calls a type of the model.
    """

    def __init__(self, imported: ImportedBuilding, name: str, sheets: Mapping[str, SheetUpdate], beside: Files) -> None:
        self.imported, self.name, self.sheets, self.items = imported, name, sheets, sheets["Items"]
        rows = list_rows(imported)
        self.pairs, self.new = self._match_items(rows["Items"])
        self.moved = find_offset(self.pairs)
        self.rows = move_rows(rows, self.moved)
        self.pairs, self.new = self._match_items(self.rows["Items"])
        self.kinds = self.rows["Catalogue"][: len(imported.types)]
        self.floors: dict[str, str] = {}
        self.rooms: dict[tuple[str, str], str] = {}
        self.types: dict[str, str] = {}
        sources = set(_list_sources(sheets["Catalogue"].table, Path(imported.source).suffix))
        self.plans = PlanUpdate(sheets["Floors"], imported, sources, beside)

    def run(self) -> None:
        """Update every sheet; floors first, as what is new stands on them."""
        items = self.rows["Items"]
        self._note_duplicates()
        own_floors = {key(row.get("floor")): row for row in reversed(self.sheets["Floors"].table.with_all("floor"))}
        found = match_floors(
            {key(row["floor"]): row.get("elevation") for row in self.rows["Floors"]},
            {one: row.get("elevation") for one, row in own_floors.items()},
            ((key(one["floor"]), key(row.get("floor"))) for one, row in self.pairs if row.get("floor")),
        )
        self.floors = {one: own_floors[name].get("floor") for one, name in found.items()}
        stayed = [
            (one, row) for one, row in self.pairs if key(self._find_floor(one["floor"])) == key(row.get("floor") or "")
        ]
        known = {key(row["room"]) for row in items if row.get("room")}
        known |= {key(row["place"]) for row in self.rows["Places"]}
        self.rooms = match_rooms(
            (
                (key(row.get("floor")), one["room"], row.get("room"))
                for one, row in stayed
                if one.get("room") and row.get("room")
            ),
            known,
        )
        matched, names, renamed = self._match_types()
        self._update_building()
        self._update_floors(own_floors)
        self.items.note_columns(("room", *SIZES, *POSITION), items)
        self._note_renamed(stayed, renamed)
        for model, row in self.pairs:
            self._update_item(model, row)
        self._add_items()
        ids = _by_id(items)
        for one, rows in _by_id(self.items.table.rows).items():
            for row in rows if one not in ids else ():
                self.items.note_row("missing", row)
        self._update_places()
        self._update_types(matched, names)

    # ------------------------------------------------------------ who is who

    def _match_items(self, items: Rows) -> tuple[list[Pair], list[Mapping[str, Any]]]:
        """Return the pieces that both have (InputError if none), and those of the model that the workbook lacks."""
        table = self.items.table
        values = {"name": self.name, "source": self.imported.source, "label": table.label("source_id")}
        if not items:
            raise InputError(fill("{source} holds no furniture that can be imported; {name} stays as it is.", **values))
        own, model = _by_id(table.rows), _by_id(items)
        if not own.keys() & model.keys():
            if "source_id" not in table.places:
                raise InputError(
                    fill("{name} has no column {label} in Items, by which its rows are found again in {source}. "
                         "Import into a new workbook under another name.", **values)
                )  # fmt: skip
            raise InputError(
                fill("{name} does not seem to be a workbook of {source}: it has no {label} of that model. Name the "
                     "workbook that was imported from it, or import into a new one under another name.", **values)
            )  # fmt: skip
        pairs = [(rows[0], own[one][0]) for one, rows in model.items() if len(rows) == 1 == len(own.get(one, ()))]
        return pairs, [row for one, rows in model.items() if one not in own for row in rows]

    def _note_duplicates(self) -> None:
        """List a Source ID of several rows, or of several pieces: which is which cannot be told."""
        model = _by_id(self.rows["Items"])
        for one, rows in _by_id(self.items.table.rows).items():
            if len(rows) > 1 and one in model:
                cells = ", ".join(self.items.address("source_id", row) for row in rows)
                why = fill("its Source ID stands in several rows ({cells})", cells=cells)
                self.items.note_row("kept", rows[0], why)
            elif len(model.get(one, ())) > 1:
                why = fill("the model has {n} pieces of its Source ID", n=len(model[one]))
                self.items.note_row("kept", rows[0], why)

    def _match_types(self) -> tuple[dict[int, Row], dict[str, str], dict[str, str]]:
        """Find out what the workbook calls the types of the model.

        Returns their rows of the Catalogue, by their places; what the Catalogue calls a type, or will call it, by its
        name as names are compared; and what Items calls it, where that is another type.
        """
        catalogue = self.sheets["Catalogue"].table.with_all("type")
        own = [Named(row.get("type"), tuple(row.get(name) for name in SIZES)) for row in catalogue]
        model = [Named(row["type"], _find_sizes(row)) for row in self.kinds]
        found = match_alike(model, own, _are_same)
        new = [one for at, one in enumerate(model) if at not in found]
        added = iter(name_apart((one.name for one in new), [one.name for one in own]))
        names = {key(kind.name): own[found[at]].name if at in found else next(added) for at, kind in enumerate(model)}
        sizes, rows = (
            {key(one.name): one.content for one in model},
            {key(row.get("type")): row for row in reversed(catalogue)},
        )
        renamed = {}
        pairs = (("", one["type"], row.get("type")) for one, row in self.pairs if one.get("type") and row.get("type"))
        for (_, one), other in match_rooms(pairs, {*names, *map(key, names.values())}).items():
            row = rows.get(key(other))
            # people chose it, rather than the model that gave its pieces another type before
            if row is None or _is_built_in(row) or _are_same(sizes.get(one, ()), [row.get(name) for name in SIZES]):
                renamed[one] = other
        self.types = names | renamed
        return {at: catalogue[other] for at, other in found.items()}, names, renamed

    def _find_floor(self, name: str) -> str:
        return self.floors.get(key(name), name)

    def _find_room(self, floor: str, room: str) -> str:
        return self.rooms.get((key(floor), key(room)), room)

    def _find_type(self, name: str) -> str:
        return self.types.get(key(name), name)

    def _note_renamed(self, pairs: Sequence[Pair], types: Mapping[str, str]) -> None:
        rooms, types = dict(self.rooms), dict(types)
        for model, row in pairs:
            room, kind = (key(row.get("floor")), key(model.get("room") or "")), key(model.get("type") or "")
            if room in rooms and key(rooms[room]) == key(row.get("room") or ""):
                self.items.keep(row, "room", model["room"], RENAMED)
                del rooms[room]
            if kind in types and key(types[kind]) == key(row.get("type") or ""):
                self.items.keep(row, "type", model["type"], RENAMED)
                del types[kind]

    # ------------------------------------------------------------ the sheets

    def _update_building(self) -> None:
        sheet = self.sheets["Building"]
        for row in sheet.table.rows:
            for name in SITE:
                sheet.fill_blank(row, name, self.imported.building.get(name))

    def _update_floors(self, own: Mapping[str, Row]) -> None:
        """Update the floors that both have, and add those of the model alone; WorkbookError if they cannot be added."""
        sheet, uses = self.sheets["Floors"], Counter(map(key, self.floors.values()))
        pairs = [(one, row) for one in self.rows["Floors"] if (row := own.get(key(self._find_floor(one["floor"]))))]
        updated = [(model, row) for model, row in pairs if uses[key(row.get("floor"))] == 1]
        self.plans.release(updated)
        new = [row for row in self.rows["Floors"] if key(row["floor"]) not in self.floors]
        if not sheet.add([self.plans.name_new(row) for row in new]):
            faults = [replace(one, severity="error") for one in sheet.problems]
            raise WorkbookError(faults or [Problem("error", "Floors", "", fill("the sheet is missing."))])
        sheet.note_columns(PLAN, self.rows["Floors"])
        for model, row in pairs:
            sheet.keep(row, "floor", model["floor"], RENAMED)
            if (model, row) in updated:
                sheet.fill_blank(row, "elevation", model.get("elevation"))
                self.plans.update(model, row)

    def _update_places(self) -> None:
        """Move the places that both have, and add those of the model alone: rooms, doors, stairs and exits.

        They have no identifier. Points that drafted routes pass have no kind. They do not follow: their names are
        numbers of one draft, by which another draft calls other points, and routes are drafted into new workbooks only.
        """
        sheet = self.sheets["Places"]
        own = sheet.table.with_all("place")
        named = {key(row.get("place")) for row in own}
        model = [{**row, "floor": self._find_floor(row["floor"])} for row in self.rows["Places"] if row.get("kind")]
        for row in model:
            renamed = self._find_room(row["floor"], row["place"])
            row["place"] = renamed if key(renamed) in named else row["place"]
        found = match_alike(
            [Named(row["place"], (key(row["floor"]), row.get("x"), row.get("y"))) for row in model],
            [Named(row.get("place"), (key(row.get("floor") or ""), row.get("x"), row.get("y"))) for row in own],
            _is_near,
            by_content=True,
        )
        sheet.note_columns(PLACE, model)
        for at, other in found.items():
            line, new = own[other], model[at]
            if key(line.get("floor") or "") != key(new["floor"]):
                sheet.keep(line, "floor", new["floor"])
                continue
            sheet.keep(line, "place", new["place"], RENAMED)
            for name in PLACE:
                sheet.replace(line, name, new.get(name))
        added = [row for at, row in enumerate(model) if at not in found]
        names = name_apart((row["place"] for row in added), [str(row.get("place")) for row in own])
        sheet.add([{**row, "place": name} for name, row in zip(names, added, strict=True)])

    def _update_types(self, matched: Mapping[int, Row], names: Mapping[str, str]) -> None:
        sheet = self.sheets["Catalogue"]
        for at, row in matched.items():
            for name in SIZES:
                if _is_built_in(row):
                    sheet.keep(row, name, self.kinds[at].get(name), fill("the type comes with the program"))
                else:
                    sheet.replace(row, name, self.kinds[at].get(name))
        new = [row for at, row in enumerate(self.kinds) if at not in matched]
        sheet.add([{**row, "type": names[key(row["type"])]} for row in new])

    def _update_item(self, model: Mapping[str, Any], row: Row) -> None:
        sheet, floor = self.items, self._find_floor(model["floor"])
        sheet.replace(row, "floor", floor)
        sheet.replace(row, "room", self._find_room(floor, model.get("room") or ""))
        origin, has_sizes = model.get("sizes_from"), any(row.get(name) is not None for name in SIZES)
        # blank is measured; but a workbook of a handover file, which tells of no origin, is blank and follows the file
        unsaid = MEASURED if origin and has_sizes and sheet.can_hold("sizes_from") else None
        is_measured = (row.get("sizes_from") or unsaid) == MEASURED != origin
        for name in SIZES:
            if is_measured:
                sheet.keep(row, name, model.get(name), fill("it was measured"))
            else:
                sheet.replace(row, name, model.get(name))
        if not is_measured:
            sheet.replace(row, "sizes_from", origin)
        number = row.get("quantity") or 1
        for name in POSITION:
            if number == 1:
                sheet.replace(row, name, model.get(name))
            elif name == "x":
                sheet.keep(row, name, model.get(name), fill("the row stands for {n} pieces", n=number))
        if row.get("type"):
            sheet.keep(row, "type", self._find_type(model.get("type") or ""))

    def _add_items(self) -> None:
        taken = [str(row.get("item")) for row in self.items.table.with_all("item")]
        names = name_apart((row["item"] for row in self.new), taken)
        found = []
        for name, row in zip(names, self.new, strict=True):
            floor = self._find_floor(row["floor"])
            room, kind = self._find_room(floor, row.get("room") or ""), self._find_type(row.get("type") or "")
            found.append({**row, "item": name, "floor": floor, "room": room, "type": kind})
        self.items.add(found)


def _find_sizes(row: Mapping[str, Any]) -> tuple[float | None, ...]:
    return tuple(None if row.get(name) is None else row[name] * CATALOGUE.column(name).factor for name in SIZES)


def _are_same(sizes: Sequence[float | None], others: Sequence[float | None]) -> bool:
    pairs = list(zip(sizes, others, strict=False))
    return bool(pairs) and all(one == other if one is None or other is None else abs(one - other) <= TOLERANCE["length"]
                               for one, other in pairs)  # fmt: skip


def _is_built_in(row: Row) -> bool:
    return (key(row.get("type")), key(row.get("source") or "")) in _list_built_in()


@cache
def _list_built_in() -> frozenset[tuple[str, str]]:
    found = set()
    for code in LANGUAGES:
        with speaking(load_catalogue(code)):
            found |= {(key(row["type"]), key(row.get("source") or "")) for row in read_catalogue()}
    return frozenset(found)


def _by_id(rows: Iterable[_Row]) -> dict[str, list[_Row]]:
    found: dict[str, list[_Row]] = {}
    for row in rows:
        if one := read_text(row.get("source_id") or ""):
            found.setdefault(one, []).append(row)
    return found


def _list_sources(catalogue: Table, suffix: str) -> Iterator[str]:
    """Yield what may be the name of a model that types came from: the ends of sources such as "shapes in A 1.ifc"."""
    for text in {row.get("source") for row in catalogue.with_all("source")}:
        words = text.split(" ") if suffix and text.endswith(suffix) else ()
        yield from (" ".join(words[at:]) for at in range(len(words)))


def _is_near(one: Sequence[Any], other: Sequence[Any]) -> bool:
    if one[0] != other[0] or None in (*one, *other):
        return False
    return hypot(one[1] - other[1], one[2] - other[2]) <= NEAR
