"""Files that the workbook names: recorded motions, a hazard curve, a ShakeMap.

Only files inside one folder are touched. A name is judged as text first, by the rules of both Windows and POSIX, before
the file system sees it: resolving a network path would already talk to another machine.
"""

import hashlib
import posixpath
import re
import unicodedata
from collections.abc import Callable, Hashable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import partial
from itertools import product
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any

from assess.errors import InputError, Problem, RecordError
from assess.hazard import HazardCurve, parse_hazard, read_bytes as read_hazard_bytes
from assess.i18n import fill, join, nfill
from assess.model import AXES, NEAR_AXIS, Axis, FloorRecord, angle_between, split_names
from assess.motion.formats import is_archive, parse_records, read_bytes, select
from assess.motion.record import Record
from assess.motion.shakemap import ShakeMap, name_uncertainty, parse_shakemap, read_file as read_grid_file
from assess.motion.site_ground import GroundField, SiteGround
from assess.progress import Progress
from assess.workbook.habits import CellError, shorten
from assess.workbook.kept_files import Allowance, KeptFiles, find_key
from assess.workbook.parse import CodeCells, Row, Table, Tables, parse_sheet
from assess.workbook.schema import BUILDING

STRONGER = ("ground_pga", "sds")
"""Fields of Building that come before its ShakeMap."""
REPLACED = ("ground_pga", "sds", "ground_pgv", "shakemap", "shaking")
"""Fields of Building whose place a ground motion of the run takes."""


def fill_building(
    tables: Tables, problems: list[Problem], given: Mapping[str, Any] | None
) -> tuple[Tables, list[Problem]]:
    """Return the tables with the blanks of Building filled in, by `given` as rows in code have it, and all problems."""
    if not given:
        return tables, problems
    own = tables[BUILDING.name]
    new, found = parse_sheet(BUILDING, own.sheet, own.language, CodeCells(BUILDING, [given]))
    row = own.rows[0] if own.rows else Row(0, {})
    unused = {name for name in new.places if own.says(row, name)}
    cells = {new.cell(name, 0) for name in unused}
    new_ones = [one for one in found if one.cell not in cells]
    of_index = (replace(one, message=fill("of the index: {message}", message=one.message)) for one in new_ones)
    problems = [*problems, *of_index]
    values = {name: value for name, value in new.rows[0].values.items() if name not in unused}
    if not values:
        return tables, problems
    labels = join(", ", [own.label(name) for name in values])
    note = nfill("{labels} is blank in the workbook: the value comes from the index.",
                 "{labels} are blank in the workbook: the values come from the index.", len(values),
                 labels=labels)  # fmt: skip
    problems.append(Problem("note", own.sheet.name, "", note))
    base = own if own.rows else replace(new, places={}, rows=(row,))
    filled = replace(base, rows=(replace(row, values={**row.values, **values}),))
    return {**tables, BUILDING.name: filled}, problems


def replace_ground(tables: Tables, ground: GroundField) -> tuple[Tables, list[Problem]]:
    """Return the tables without the ground motion that the workbook fills in, and a note on what is not used."""
    table = tables[BUILDING.name]
    row = table.rows[0] if table.rows else Row(0, {})
    filled = [name for name in REPLACED if row.get(name) is not None]
    cleared = replace(row, values={name: value for name, value in row.values.items() if name not in REPLACED})
    notes = []
    if filled:
        message = nfill("{labels} is not used: the ground motion of {file} takes its place.",
                        "{labels} are not used: the ground motion of {file} takes their place.", len(filled),
                        labels=join(", ", [table.label(name) for name in filled]), file=ground.file)  # fmt: skip
        notes = [table.problem(filled[0], row, message, severity="note")]
    return {**tables, BUILDING.name: replace(table, rows=(cleared,))}, notes


_RESERVED = frozenset(
    {"CON", "PRN", "AUX", "NUL", *(f"{port}{number}" for port in ("COM", "LPT") for number in range(10))}
)
Files = Mapping[str, bytes] | Path | None
"""Where files are looked for: handed over as bytes by name, in a folder, or nowhere."""


class FileReader:
    """Reads the files that a workbook names, each once, and checks them as the functions of `check` do.

    They are in `files` by name, or in that folder; `kept` is what earlier readings made of them, `ground` the ground
    motion of the run, in place of the workbook's own. What is found: `hashes` (SHA-256) by the name of the file, the
    `hazard` curve, `site_ground` by a ShakeMap or scenarios, and the `records` of floors by row and axis.
    """

    def __init__(
        self, files: Files, progress: Progress, kept: KeptFiles | None = None, ground: GroundField | None = None
    ) -> None:
        self.kept, self.ground = kept or KeptFiles(), ground
        self.folder = files.resolve() if isinstance(files, Path) else None
        given = files if isinstance(files, Mapping) else {}
        self.given = {posixpath.normpath(_posix(name)): data for name, data in given.items()}
        self.progress = progress
        self.hashes: dict[str, str] = {}
        self.records: dict[tuple[int, Axis], tuple[FloorRecord, ...]] = {}
        self.hazard: HazardCurve | None = None
        self.site_ground: SiteGround | None = None
        self._read: dict[str, tuple[tuple[Record, ...], str] | CellError] = {}
        self._allowance = Allowance()

    def check_hazard(self, tables: Tables) -> Iterator[Problem]:
        """Read the hazard curve, or report what is wrong with it, or with the building's latitude and longitude."""
        table = tables["Building"]
        for row in table.rows:
            for name, other in (("latitude", "longitude"), ("longitude", "latitude")):
                if row.get(name) is not None and table.lacks(row, other):
                    message = fill(
                        "{label} is given without {other}.", label=table.label(name), other=table.label(other)
                    )
                    yield table.problem(name, row, message, fill("Fill in both, or clear both."))
        for row in table.with_all("hazard"):
            if table.spoilt("latitude", row) or table.spoilt("longitude", row):
                continue
            file, place = row.get("hazard"), {name: row.get(name) for name in ("latitude", "longitude")}
            try:
                curve, self.hashes[file] = self._take(file, "hazard", partial(_parse_hazard, **place), *place.values())
            except CellError as error:
                yield table.problem("hazard", row, error.message, error.fix)
                continue
            self.hazard = curve
            for note in curve.remarks:
                yield table.problem("hazard", row, fill("the hazard curve: {note}.", note=note), severity="warning")

    def _take(self, file: str, purpose: str, parse: Callable[[bytes | Path, str], Any], *more: Hashable) -> Any:
        """Return what `parse` makes of a file and its address; CellError where it cannot be used."""
        content, address = self._find(file)
        key = find_key(content, purpose, *more)
        found = self.kept.take(key, self._allowance, lambda: parse(content, address))
        if isinstance(found, CellError):
            raise found
        return found

    def check_ground(self, tables: Tables) -> Iterator[Problem]:
        """Find the ground motion of the run, or of the ShakeMap that is named, at the building, or report a fault."""
        table = tables["Building"]
        if self.ground is not None:
            row = table.rows[0] if table.rows else Row(0, {})
            yield from self._place(table, row, self.ground, self.ground.file)
            return
        for row in table.with_all("shakemap"):
            file = row.get("shakemap")
            uncertainty, uncertainty_name = None, ""
            for path in list_beside(file):
                with suppress(CellError):
                    uncertainty, uncertainty_name = self._find(path)[0], path
                    break
            given = None if uncertainty is None else find_key(uncertainty, "shakemap")
            parse = partial(_parse_shakemap, uncertainty=uncertainty, uncertainty_name=uncertainty_name)
            try:
                map_ = self._take(file, "shakemap", parse, given)
            except CellError as error:
                yield table.problem("shakemap", row, error.message, error.fix)
                continue
            self.hashes[file] = map_.grid_sha256
            if map_.uncertainty_file:
                self.hashes[uncertainty_name] = map_.uncertainty_sha256
            if not table.says(row, *STRONGER):
                yield from self._place(table, row, map_, file, "shakemap")

    def _place(self, table: Table, row: Row, ground: GroundField, file: str, name: str = "") -> Iterator[Problem]:
        """Find the motion at the building; `name` is the field that asks for it, "" where the run does."""
        if table.spoilt("latitude", row) or table.spoilt("longitude", row):
            return
        lacking = [one for one in ("latitude", "longitude") if row.get(one) is None]
        if not lacking:
            try:
                self.site_ground = ground.at(row.get("latitude"), row.get("longitude"))
            except InputError as error:
                fix = fill("Correct Latitude and Longitude, or name a ground motion that covers the building.")
                message = fill("no ground motion at the building: {why}.", why=error.message)
                yield table.problem(name or "latitude", row, message, fix)
        elif not name or len(lacking) == 2:  # of one alone the other was reported
            message = nfill("{labels} is blank; the ground motion of {file} needs the building's place.",
                            "{labels} are blank; the ground motion of {file} needs the building's place.", len(lacking),
                            labels=join(", ", [table.label(one) for one in lacking]), file=file)  # fmt: skip
            cells = [cell for one in lacking if re.fullmatch(r"[A-Z]+\d+", cell := table.cell(one, row.number))]
            fix = fill("Fill in Latitude and Longitude.")
            if cells:
                fix = fill("Fill in Latitude and Longitude (cells {cells}).", cells=", ".join(cells))
            yield table.problem(name if name in table.places else lacking[0], row, message, fix)

    def check_records(self, tables: Tables) -> Iterator[Problem]:
        """Read the recorded motions of the floors, or report what is wrong with them or with their direction."""
        table = tables["Floors"]
        azimuth = next((row.get("azimuth_deg") for row in tables["Building"].rows), None)
        for row, axis in product(table.with_all("floor"), AXES):
            name, text = f"record_{axis.lower()}", row.get(f"record_{axis.lower()}")
            along = None if azimuth is None else azimuth + (90 if axis == "Y" else 0)
            names, found = split_names(text), []
            if text is not None and not names:
                message = fill("{text} names no file.", text=shorten(text))
                yield table.problem(name, row, message, fill("Name a record, or clear the cell."))
            for one in names:
                try:
                    record = self._read_record(one)
                except CellError as error:
                    yield table.problem(name, row, error.message, error.fix)
                    continue
                found.append(record)
                yield from _check_direction(table, name, row, record, axis, along)
            if found:
                self.records[row.number, axis] = tuple(found)

    def _read_record(self, text: str) -> FloorRecord:
        """Return a recorded motion, ``file#channel``, each file read once; CellError where it cannot be used."""
        file, _, channel = (part.strip() for part in text.partition("#"))
        _content, address = self._find(file)
        if address not in self._read:
            self.progress.check()
            try:
                read = self._take(file, "record", self._parse_record)
                self._read[address], self.hashes[file] = read, read[1]
            except CellError as error:
                self._read[address] = error
        known = self._read[address]
        if isinstance(known, CellError):
            raise known
        try:
            record = select(known[0], channel or None)
        except RecordError as error:
            raise CellError(fill("{why}.", why=error.message)) from None
        if record.vertical:
            message = fill("{text} is a vertical channel.", text=shorten(text))
            raise CellError(message, fill("Choose a horizontal one."))
        path = None if self.folder is None else (self.folder / _posix(file)).resolve()
        return FloorRecord(name=text, record=record, file=file, channel=channel, sha256=known[1], path=path)

    def _parse_record(self, content: bytes | Path, address: str) -> tuple[tuple[Record, ...], str] | CellError:
        try:
            data = content if isinstance(content, bytes) else read_bytes(content)
            self._allowance.take(record_bytes=len(data), archives=int(is_archive(data)))
            found = parse_records(data, _name(address), progress=self.progress)
            self._allowance.take(samples=sum(record.acceleration.size for record in found))
            return found, hashlib.sha256(data).hexdigest()
        except RecordError as error:
            return CellError(fill("the record cannot be read: {why}.", why=error.message))

    def _find(self, file: str) -> tuple[bytes | Path, str]:
        if self.folder is not None:
            path = find_file(file, self.folder)
            return path, str(path)
        address = posixpath.normpath(_posix(file))
        if address not in self.given:
            message = fill("the file {name} is not among the records that were passed.", name=shorten(file))
            raise CellError(message, fill("Pass its bytes in `records`."))
        return self.given[address], address


def _parse_hazard(
    content: bytes | Path, address: str, latitude: float | None, longitude: float | None
) -> tuple[HazardCurve, str] | CellError:
    try:
        data = content if isinstance(content, bytes) else read_hazard_bytes(content)
        curve = parse_hazard(data, _name(address), latitude=latitude, longitude=longitude)
    except InputError as error:
        fix = fill("Correct the file, or give a CSV file with the columns pga_g,annual_rate.")
        return CellError(fill("the hazard curve cannot be used: {why}.", why=error.message), fix)
    return curve, hashlib.sha256(data).hexdigest()


def _parse_shakemap(
    content: bytes | Path, address: str, uncertainty: bytes | Path | None, uncertainty_name: str
) -> ShakeMap | CellError:
    try:
        data, more = (read_grid_file(one) if isinstance(one, Path) else one for one in (content, uncertainty))
        return parse_shakemap(data or b"", _name(address), uncertainty=more, uncertainty_name=_name(uncertainty_name))
    except InputError as error:
        fix = fill("Give the grid.xml of a ShakeMap as the USGS publishes it, unchanged.")
        return CellError(fill("the ShakeMap cannot be used: {why}.", why=error.message), fix)


def _check_direction(
    table: Table, name: str, row: Row, one: FloorRecord, axis: Axis, along: float | None
) -> Iterator[Problem]:
    if one.record.vertical is None:
        message = fill("the direction of {record} is not known: is it horizontal?", record=shorten(one.name))
        fix = fill(
            "If it is vertical, choose another channel. In plain CSV, the heading x or y tells that it is horizontal."
        )
        yield table.problem(name, row, message, fix, "warning")
    azimuth = one.record.azimuth_deg
    off = 0.0 if along is None or azimuth is None else angle_between(azimuth, along)
    if off > NEAR_AXIS:
        message = fill("{record} points to {azimuth:g} deg, {off:.0f} deg off the {axis} axis.",
                       record=shorten(one.name), azimuth=azimuth, off=off, axis=axis)  # fmt: skip
        yield table.problem(name, row, message, fill("Check the axis, or Azimuth of X in Building."), "warning")


def find_file(text: str, folder: Path) -> Path:
    """Return the file that `text` names inside `folder`; CellError if it leads outside, or no such file is there."""
    path = find_place(text, folder)
    if not path.is_file():
        message = fill("the file {name} was not found next to the workbook.", name=shorten(text))
        raise CellError(message, fill("Check the name, or copy the file there."))
    return path


def find_place(text: str, folder: Path) -> Path:
    """Return where a file that `text` names in `folder` belongs; CellError if it leads outside or cannot be."""
    name = shorten(text)
    windows, posix = PureWindowsPath(text), PurePosixPath(text)
    is_odd = any(unicodedata.category(character) in ("Cc", "Cf", "Cs") for character in text) or len(text) > 500
    is_absolute = windows.drive or windows.root or posix.is_absolute() or ":" in text
    is_reserved = any(part.split(".")[0].upper() in _RESERVED for part in windows.parts)
    if is_odd or is_absolute or is_reserved or ".." in windows.parts or ".." in posix.parts:
        raise CellError(fill("the file {name} is outside the workbook's folder.", name=name),
                        fill("Copy it next to the workbook and write its name alone."))  # fmt: skip
    try:
        path = (folder / _posix(text)).resolve()
        path.is_file()
    except (OSError, RuntimeError):  # a name that is too long; links that lead in a circle
        message = fill("the file {name} cannot be found under that name.", name=name)
        raise CellError(message, fill("Give it a shorter, simpler name.")) from None
    if not path.is_relative_to(folder):
        message = fill("the file {name} is a link that leads outside the workbook's folder.", name=name)
        raise CellError(message, fill("Copy it next to the workbook."))
    return path


def list_beside(file: str) -> list[str]:
    """Return how the file of uncertainties of a ShakeMap's grid may be called, as a workbook would name it."""
    folder, _, name = _posix(file).rpartition("/")
    return [f"{folder}/{one}" if folder else one for one in name_uncertainty(name)]


def _posix(text: str) -> str:
    return PureWindowsPath(text).as_posix()


def _name(address: str) -> str:
    return PurePosixPath(_posix(address)).name
