"""The floors and how they shake: given peaks, and records with their directions."""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from assess.errors import RecordError
from assess.inventory.axes import NEAR_AXIS, angle_between
from assess.inventory.cells import CellError, shorten
from assess.inventory.files import find_file, find_picture
from assess.inventory.model import Axis, Building, Floor, FloorRecord
from assess.inventory.names import check_unique, check_wildcards
from assess.inventory.tables import Row, Table
from assess.language import fill
from assess.motion.formats import read_records, select
from assess.motion.record import Record

_AXES: tuple[Axis, Axis] = ("X", "Y")


@dataclass(slots=True)
class FloorReader:
    """Builds the floors from their table. Each file of records is read once; `hashes` holds SHA-256 by its name.

    `has_ground` tells whether Building says anything of the ground motion, which serves floors that have none.
    """

    table: Table
    folder: Path
    building: Building
    has_ground: bool = False
    hashes: dict[str, str] = field(default_factory=dict)
    _files: dict[Path, tuple[Record, ...] | str] = field(default_factory=dict)

    def read(self) -> tuple[Floor, ...]:
        """Return the floors; problems are reported to the table."""
        check_unique(self.table, "floor")
        check_wildcards(self.table, "floor")
        rows = [row for row in self.table.rows if row.values.get("floor") is not None]
        self._check_demands(rows)
        return tuple(self._floor(row) for row in rows)

    def _floor(self, row: Row) -> Floor:
        values = row.values
        pfa, pfv = (
            {axis: value for axis in _AXES if (value := values.get(f"{what}_{axis.lower()}")) is not None}
            for what in ("pfa", "pfv")
        )
        records = {axis: found for axis in _AXES if (found := tuple(self._records(row, axis)))}
        self._check_velocities(row)
        return Floor(
            row=row.number,
            floor=values["floor"],
            name=values.get("name") or "",
            elevation=values.get("elevation"),
            pfa=pfa,
            pfv=pfv,
            records=records,
            plan=self._plan(row),
            cells={name: f"{letter}{row.number}" for name, letter in self.table.letters.items()},
        )

    def _check_demands(self, rows: list[Row]) -> None:
        """Report floors that nothing can serve, whatever the scenario; what cannot be read has been reported."""
        known = [row for row in rows if self._says(row, "pfa_x", "pfa_y", "record_x", "record_y")]
        levels = [row.values.get("elevation") for row in known]
        heights = [level for level in levels if level is not None]
        is_sure = not any(self.table.spoilt("elevation", row.number) for row in known)
        for row in rows:
            level = row.values.get("elevation")
            if row in known or (level is None and self.table.spoilt("elevation", row.number)):
                continue
            has_neighbours = level is not None and bool(heights) and min(heights) <= level <= max(heights)
            if level is None or not (self.has_ground or has_neighbours or not is_sure):
                message, mend = describe_unserved(shorten(row.values["floor"]), has_elevation=level is not None)
                where = "elevation" if self.has_ground else "pfa_x"
                where = where if where in self.table.letters else "floor"
                self.table.report(self.table.cell(where, row.number), message, mend)

    def _says(self, row: Row, *names: str) -> bool:
        """Tell whether one of these fields is filled in, be it readable or not."""
        return any(row.values.get(name) is not None or self.table.spoilt(name, row.number) for name in names)

    def _check_velocities(self, row: Row) -> None:
        """Report a PFV that nothing would use: it tells of shaking that the PFA then would not."""
        for axis in _AXES:
            name, letter = f"pfv_{axis.lower()}", axis.lower()
            others = [f"pfa_{letter}", f"record_{letter}"]
            if row.values.get(name) is not None and not self._says(row, *others):
                message = f"PFV {axis} stands without PFA {axis} and would not be used."
                self.table.report(
                    self.table.cell(name, row.number), message, f"Fill in PFA {axis}, or clear PFV {axis}."
                )

    def _plan(self, row: Row) -> Path | None:
        text, cell = row.values.get("plan"), self.table.cell("plan", row.number)
        if text is None:
            return None
        self.table.report(cell, fill("Plan image is kept, not drawn by this version."), severity="note")
        try:
            return find_picture(text, self.folder)
        except CellError as error:
            self.table.report(cell, error.message, error.mend)
            return None

    # ----------------------------------------------------------------- records

    def _records(self, row: Row, axis: Axis) -> Iterator[FloorRecord]:
        """Yield the records that a cell names, split by semicolons."""
        name = f"record_{axis.lower()}"
        cell, value = self.table.cell(name, row.number), row.values.get(name)
        if value is None:
            return
        texts = [text for part in value.split(";") if (text := part.strip())]
        if not texts:
            self.table.report(cell, f"{shorten(value)} names no file.", "Name a record, or clear the cell.")
        for text in texts:
            try:
                record = self._record(text)
            except CellError as error:
                self.table.report(cell, error.message, error.mend)
                continue
            if record.vertical:
                self.table.report(cell, f"{shorten(text)} is a vertical channel.", "Name a horizontal one.")
                continue
            self._check_direction(cell, text, record, axis)
            yield FloorRecord(name=text, record=record)

    def _record(self, text: str) -> Record:
        """Return the record that ``file`` or ``file#channel`` names."""
        file, _, channel = text.partition("#")
        path = find_file(file.strip(), self.folder)
        if path not in self._files:
            self._files[path] = self._read_file(path, file.strip())
        found = self._files[path]
        if isinstance(found, str):
            raise CellError(f"the record cannot be read: {found}.")
        try:
            return select(found, channel.strip() or None)
        except RecordError as error:
            raise CellError(f"{error}.") from None

    def _read_file(self, path: Path, name: str) -> tuple[Record, ...] | str:
        try:
            records = read_records(path)
            self.hashes[name] = hashlib.sha256(path.read_bytes()).hexdigest()
        except RecordError as error:
            return str(error)
        return records

    def _check_direction(self, cell: str, text: str, record: Record, axis: Axis) -> None:
        if self.building.azimuth_deg is None or record.azimuth_deg is None:
            return
        along = self.building.azimuth_deg + (90 if axis == "Y" else 0)
        off = angle_between(record.azimuth_deg, along)
        if off > NEAR_AXIS:
            message = fill(
                "{record} points to {azimuth:g} deg, {off:.0f} deg off the {axis} axis.",
                record=shorten(text),
                azimuth=record.azimuth_deg,
                off=off,
                axis=axis,
            )
            self.table.report(cell, message, fill("Check the axis, or Azimuth of X in Building."), "warning")


def describe_unserved(floor: str, *, has_elevation: bool) -> tuple[str, str]:
    """Say of a floor, its name in quotes, that nothing tells how it shakes, and what would."""
    if has_elevation:
        why = "lies between no two floors that have one and an Elevation, and Building gives no Ground PGA or SDS"
        mend = "Fill in PFA X or PFA Y, or name a record; or fill in Ground PGA in Building."
        return f"floor {floor} has neither a record nor a PFA, {why}.", mend
    mend = "Fill in PFA X or PFA Y, or name a record; or fill in Elevation, and Ground PGA in Building."
    return f"floor {floor} has neither a record nor a PFA, and no Elevation to work one out by.", mend
