"""From the workbook's tables to the inventory: names that must fit together, defaults, files."""

import hashlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from assess.errors import Problem, RecordError, Severity
from assess.inventory.cells import CellError, shorten
from assess.inventory.columns import key
from assess.inventory.files import find_file
from assess.inventory.model import (
    Axis,
    Building,
    CatalogueType,
    Floor,
    FloorRecord,
    Inventory,
    Item,
    Place,
    Segment,
)
from assess.inventory.tables import Row, Table, raise_errors, read_tables
from assess.motion.formats import read_records, select
from assess.motion.record import Record

NEAR_AXIS = 15.0
"""Up to this angle [deg] from an axis a piece, or a record, counts as lying along it."""

PICTURES = {b"\x89PNG\r\n\x1a\n": "PNG", b"\xff\xd8\xff": "JPEG"}
MAX_PICTURE = 10 * 2**20


def read_inventory(path: str | Path) -> Inventory:
    """Read and check a workbook.

    Parameters
    ----------
    path : str or Path
        The .xlsx (or .xlsm, whose macros are never run). Records are looked for beside it.

    Returns
    -------
    Inventory
        In SI units, with the warnings and notes of the check.

    Raises
    ------
    WorkbookError
        If anything in it cannot be used; its `problems` name every sheet and cell.
    """
    path = Path(path)
    tables, problems = read_tables(path)
    checker = _Checker(path.resolve().parent, tables, problems)
    building = checker.building()
    catalogue = checker.catalogue()
    floors = checker.floors(building)
    routes = checker.routes()
    places = checker.places()
    items = checker.items(building, catalogue)
    raise_errors(problems)
    return Inventory(
        source=path,
        sha256=hashlib.sha256(path.read_bytes()).hexdigest(),
        building=building,
        floors=floors,
        items=items,
        places=places,
        routes=routes,
        catalogue=catalogue,
        problems=tuple(problems),
        extra_columns=tables["Items"].extra,
        files=checker.hashes,
    )


@dataclass(slots=True)
class _Names:
    """The names that a sheet defines, by how they are compared; `known` is false where the sheet itself is missing."""

    found: dict[str, str]
    known: bool


class _Checker:
    """Builds the model from the tables, and reports whatever does not fit together."""

    def __init__(self, folder: Path, tables: dict[str, Table], problems: list[Problem]) -> None:
        self.folder, self.tables, self.problems = folder, tables, problems
        self.records: dict[Path, tuple[Record, ...] | str] = {}
        self.hashes: dict[str, str] = {}

    def report(self, table: Table, cell: str, message: str, mend: str = "", severity: Severity = "error") -> None:
        self.problems.append(Problem(severity, table.sheet.name, cell, message, mend))

    # ------------------------------------------------------------ small sheets

    def building(self) -> Building:
        table = self.tables["Building"]
        values = {name: value for name, value in table.form.items() if value is not None}
        if "logo" in values:
            values["logo"] = self._picture(table, values["logo"], f"B{table.lines['logo']}")
        for name, why in _KEPT.items():
            if name in values:
                self.report(
                    table,
                    f"B{table.lines[name]}",
                    f"{table.sheet.column(name).label} is kept, not used: {why}.",
                    "",
                    "note",
                )
        return Building(**values)

    def catalogue(self) -> tuple[CatalogueType, ...]:
        table = self.tables["Catalogue"]
        self._unique(table, "type")
        types = []
        for row in table.rows:
            if row.values["type"] is not None:
                types.append(CatalogueType(row=row.number, **_filled(row)))
                self._order_of_sizes(table, row.number, row.values.get("breadth"), row.values.get("width"), "breadth")
        return tuple(types)

    def places(self) -> tuple[Place, ...]:
        table = self.tables["Places"]
        self._unique(table, "place")
        self._references(table, "floor", self._names("Floors", "floor"), "Floors")
        rows = [row for row in table.rows if row.values["place"] and row.values["floor"]]
        return tuple(Place(row=row.number, **_filled(row)) for row in rows)

    def routes(self) -> tuple[Segment, ...]:
        table = self.tables["Routes"]
        self._references(table, "floor", self._names("Floors", "floor"), "Floors")
        rows = [row for row in table.rows if row.values["route"] and row.values["segment"]]
        if rows:
            self.report(table, "", "routes are kept and listed; this version does not evaluate them.", "", "note")
        return tuple(Segment(row=row.number, **_filled(row)) for row in rows)

    # ------------------------------------------------------------------ floors

    def floors(self, building: Building) -> tuple[Floor, ...]:
        table = self.tables["Floors"]
        self._unique(table, "floor")
        return tuple(self._floor(table, row, building) for row in table.rows if row.values.get("floor") is not None)

    def _floor(self, table: Table, row: Row, building: Building) -> Floor:
        values = row.values
        records: dict[Axis, tuple[FloorRecord, ...]] = {}
        for axis, name in _BY_AXIS("record"):
            if values.get(name):
                records[axis] = tuple(self._floor_records(table, row, name, axis, building))
        demand = [name for what in ("pfa", "record") for _, name in _BY_AXIS(what)]
        if not any(values.get(name) is not None or table.spoilt(name, row.number) for name in demand):
            self.report(
                table,
                table.cell("pfa_x", row.number) if "pfa_x" in table.letters else table.cell("floor", row.number),
                f"floor {shorten(values['floor'])} has neither a record nor a PFA.",
                "Fill in PFA X or PFA Y, or name a record.",
            )
        plan = None
        if values.get("plan"):
            plan = self._picture(table, values["plan"], table.cell("plan", row.number))
            self.report(
                table, table.cell("plan", row.number), "Plan image is kept, not drawn by this version.", "", "note"
            )
        return Floor(
            row=row.number,
            floor=values["floor"],
            name=values.get("name") or "",
            elevation=values.get("elevation"),
            pfa={axis: values[name] for axis, name in _BY_AXIS("pfa") if values.get(name) is not None},
            pfv={axis: values[name] for axis, name in _BY_AXIS("pfv") if values.get(name) is not None},
            records=records,
            plan=plan,
        )

    def _floor_records(
        self, table: Table, row: Row, name: str, axis: Axis, building: Building
    ) -> Iterable[FloorRecord]:
        cell = table.cell(name, row.number)
        for text in filter(None, (part.strip() for part in row.values[name].split(";"))):
            try:
                record = self._record(text)
            except CellError as error:
                self.report(table, cell, error.message, error.mend)
                continue
            if record.vertical:
                self.report(table, cell, f"{shorten(text)} is a vertical channel.", "Name a horizontal one.")
                continue
            self._check_direction(table, cell, text, record, axis, building)
            yield FloorRecord(name=text, record=record)

    def _record(self, text: str) -> Record:
        """Return the record that ``file`` or ``file#channel`` names; each file is read once."""
        file, _, channel = text.partition("#")
        path = find_file(file.strip(), self.folder)
        if path not in self.records:
            try:
                self.records[path] = read_records(path)
                self.hashes[file.strip()] = hashlib.sha256(path.read_bytes()).hexdigest()
            except RecordError as error:
                self.records[path] = str(error)
        found = self.records[path]
        if isinstance(found, str):
            raise CellError(f"the record cannot be read: {found}")
        try:
            return select(found, channel.strip() or None)
        except RecordError as error:
            raise CellError(str(error)) from None

    def _check_direction(
        self, table: Table, cell: str, text: str, record: Record, axis: Axis, building: Building
    ) -> None:
        if building.azimuth_deg is None or record.azimuth_deg is None:
            return
        along = building.azimuth_deg + (90 if axis == "Y" else 0)
        off = _apart(record.azimuth_deg - along)
        if off > NEAR_AXIS:
            message = f"{shorten(text)} points to {record.azimuth_deg:g} deg, {off:.0f} deg off the {axis} axis."
            self.report(table, cell, message, "Check the axis, or Azimuth of X in Building.", "warning")

    def _picture(self, table: Table, text: str, cell: str) -> Path | None:
        try:
            path = find_file(text, self.folder)
            if path.stat().st_size > MAX_PICTURE:
                raise CellError(f"{shorten(text)} is larger than {MAX_PICTURE >> 20} MB.", "Save a smaller picture.")
            if not any(path.read_bytes()[:8].startswith(magic) for magic in PICTURES):
                raise CellError(f"{shorten(text)} is no PNG or JPEG picture.", "Save it as PNG or JPEG.")
        except CellError as error:
            self.report(table, cell, error.message, error.mend)
            return None
        return path

    # ------------------------------------------------------------------- items

    def items(self, building: Building, catalogue: tuple[CatalogueType, ...]) -> tuple[Item, ...]:
        table = self.tables["Items"]
        self._unique(table, "item")
        self._references(table, "floor", self._names("Floors", "floor"), "Floors")
        self._references(table, "type", self._names("Catalogue", "type"), "Catalogue")
        self._check_routes(table)
        types = {key(one.type): one for one in catalogue}
        built = (self._item(table, row, building, types) for row in table.rows)
        return tuple(item for item in built if item is not None)

    def _item(self, table: Table, row: Row, building: Building, types: dict[str, CatalogueType]) -> Item | None:
        values = dict(row.values)
        assumed = self._sizes(table, row, values, types.get(key(values.get("type") or "")))
        self._check_position(table, row, values)
        if values.get("axis") is None and values.get("angle_deg") is not None:
            values["axis"] = _axis_of(values["angle_deg"])
            assumed += ["axis"] if values["axis"] else []
        if values.get("friction") is None and building.friction is not None:
            values["friction"] = building.friction
            assumed.append("friction")
        assumed += [name for name in ("quantity", "anchored") if values.get(name) is None]
        if any(values.get(name) is None for name in ("item", "floor", "breadth", "height")):
            return None  # the reason has been reported
        filled = {name: value for name, value in values.items() if value is not None}
        return Item(row=row.number, **filled, assumed=tuple(assumed), extra=row.extra)

    def _sizes(self, table: Table, row: Row, values: dict[str, Any], kind: CatalogueType | None) -> list[str]:
        """Fill blank sizes in from the catalogue and check them against each other; return the fields filled in."""
        assumed = []
        for name in ("breadth", "width", "height"):
            if values.get(name) is None and not table.spoilt(name, row.number):
                values[name] = getattr(kind, name, None)
                if values[name] is not None:
                    assumed.append(name)
                elif name != "width" and not table.spoilt("type", row.number):
                    label = table.sheet.column(name).label
                    mend = "Fill it in, or choose a Type that has one."
                    self.report(table, table.cell(name, row.number), f"{label} is blank and no Type gives it.", mend)
        breadth, width, height = (values.get(name) for name in ("breadth", "width", "height"))
        self._order_of_sizes(table, row.number, breadth, width, "breadth")
        if breadth is not None and height is not None and breadth > height * (1 + 1e-9):
            message = f"Breadth {breadth * 100:g} cm is greater than Height {height * 100:g} cm."
            self.report(table, table.cell("breadth", row.number), message, "Are the two exchanged?", "warning")
        return assumed

    def _order_of_sizes(self, table: Table, row: int, breadth: float | None, width: float | None, name: str) -> None:
        if breadth is not None and width is not None and breadth > width * (1 + 1e-9):
            message = f"Breadth {breadth * 100:g} cm is greater than Width {width * 100:g} cm."
            self.report(table, table.cell(name, row), message, "Breadth is the shorter plan side: exchange the two.")

    def _check_position(self, table: Table, row: Row, values: dict[str, Any]) -> None:
        placed = values.get("x") is not None or values.get("y") is not None
        if placed and (values.get("quantity") or 1) > 1:
            self.report(
                table,
                table.cell("quantity", row.number),
                f"Quantity is {values['quantity']} on a row with a position.",
                "Write one row a piece, or clear X and Y.",
            )
        if (values.get("x") is None) != (values.get("y") is None) and not (
            table.spoilt("x", row.number) or table.spoilt("y", row.number)
        ):
            missing = "y" if values.get("y") is None else "x"
            self.report(table, table.cell(missing, row.number), "a position needs both X and Y.", "", "warning")

    def _check_routes(self, table: Table) -> None:
        named = [row for row in table.rows if row.values.get("route")]
        routes = self.tables["Routes"]
        if named and not routes.found:
            more = f" (and {len(named) - 1} more rows)" if len(named) > 1 else ""
            message = f"Route {shorten(named[0].values['route'])}{more} is named, but there is no Routes sheet."
            self.report(table, table.cell("route", named[0].number), message, "Add the sheet, or clear the column.")
            return
        self._references(table, "route", self._names("Routes", "route"), "Routes")
        known = {(key(row.values["route"] or ""), key(row.values["segment"] or "")) for row in routes.rows}
        names = self._names("Routes", "route").found
        for row in table.rows:
            route, segment = row.values.get("route"), row.values.get("segment")
            if segment and not route:
                self.report(
                    table, table.cell("segment", row.number), "a Segment is named without its Route.", "Fill in Route."
                )
            elif route and segment and key(route) in names and (key(route), key(segment)) not in known:
                message = f"Route {shorten(route)} has no segment {shorten(segment)}."
                self.report(table, table.cell("segment", row.number), message, "Add it to Routes, or clear the cell.")

    # ------------------------------------------------------------------- names

    def _names(self, sheet: str, name: str) -> _Names:
        table = self.tables[sheet]
        named = [row.values[name] for row in reversed(table.rows) if row.values.get(name) is not None]
        found = {key(one): one for one in named}
        return _Names(found, table.found and name in table.letters)

    def _unique(self, table: Table, name: str) -> None:
        first: dict[str, int] = {}
        label = table.sheet.column(name).label
        for row in table.rows:
            value = row.values.get(name)
            if value is None:
                continue
            if key(value) in first:
                message = f"{label} {shorten(value)} is here twice, also in {table.cell(name, first[key(value)])}."
                self.report(table, table.cell(name, row.number), message, "Give each its own name.")
            first.setdefault(key(value), row.number)

    def _references(self, table: Table, name: str, names: _Names, sheet: str) -> None:
        """Spell every name of a column as its own sheet does; report those that the sheet does not define."""
        if not names.known and sheet == "Floors":
            return  # the missing sheet or column has been reported
        label = table.sheet.column(name).label
        for row in table.rows:
            value = row.values.get(name)
            if value is not None and key(value) in names.found:
                row.values[name] = names.found[key(value)]
            elif value is not None:
                cell = table.cell(name, row.number)
                table.failed.add(cell)
                mend = f"Choose one of the {sheet} sheet, or add it there.{_suggest(value, names.found)}"
                self.report(table, cell, f"{label} {shorten(value)} is not in the {sheet} sheet.", mend)


_KEPT = {
    "ground_pga": "every floor has its own motion",
    "sds": "every floor has its own motion",
    "restitution": "direct integration is not part of this version",
}


def _BY_AXIS(what: str) -> tuple[tuple[Axis, str], tuple[Axis, str]]:  # noqa: N802
    return ("X", f"{what}_x"), ("Y", f"{what}_y")


def _filled(row: Row) -> dict[str, Any]:
    return {name: value for name, value in row.values.items() if value is not None}


def _apart(angle: float) -> float:
    """Smallest angle between two undirected lines [deg]."""
    return abs((angle + 90) % 180 - 90)


def _axis_of(angle: float) -> Axis | None:
    """Return the building axis that Breadth lies along, None where it lies between the two."""
    if _apart(angle) <= NEAR_AXIS:
        return "X"
    return "Y" if _apart(angle - 90) <= NEAR_AXIS else None


def _suggest(value: str, names: Iterable[str]) -> str:
    import difflib

    near: Callable[..., list[str]] = difflib.get_close_matches
    found = near(key(value), list(names), 1, 0.75)
    return f" Did you mean {found[0]}?" if found else ""
