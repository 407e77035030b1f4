"""Files that the workbook names: recorded motions, a hazard curve.

Only files inside one folder are touched.

A name is judged as text first, by the rules of both Windows and POSIX, before the file system sees it: resolving a
network path would already talk to another machine.
"""

import hashlib
import posixpath
import unicodedata
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath, PureWindowsPath

from assess.errors import InputError, Problem, RecordError
from assess.hazard import HazardCurve, parse_hazard
from assess.hazard import read_bytes as read_hazard_bytes
from assess.i18n import fill
from assess.model import AXES, NEAR_AXIS, Axis, FloorRecord, angle_between, split_names
from assess.motion.formats import is_archive, parse_records, read_bytes, select
from assess.motion.record import Record
from assess.motion.shakemap import ShakeMap, name_uncertainty, parse_shakemap
from assess.motion.shakemap import read_file as read_grid_file
from assess.motion.site_ground import GroundField, SiteGround
from assess.progress import Progress
from assess.workbook.allowance import Allowance
from assess.workbook.ground_files import STRONGER, GroundReader, report_unplaced
from assess.workbook.habits import CellError
from assess.workbook.kept_files import KeptFiles, find_key
from assess.workbook.parse import Row, Table, Tables
from assess.workbook.values import shorten

_RESERVED = frozenset(
    {"CON", "PRN", "AUX", "NUL", *(f"{port}{number}" for port in ("COM", "LPT") for number in range(10))}
)

Files = Mapping[str, bytes] | Path | None
"""Where files are looked for: handed over as bytes by name, in a folder, or nowhere."""


class FileReader:
    """Reads the files that a workbook names, each once, and checks them as the functions of `check` do.

    Parameters
    ----------
    files : mapping of str to bytes, or Path, optional
        The files by name, or the folder in which they are.
    progress : Progress
        Checked before every file, and every member of an archive.
    kept : KeptFiles, optional
        What earlier readings of the workbook made of its files.
    ground : GroundField, optional
        The ground motion of the run, in place of the workbook's own.

    Attributes
    ----------
    hashes : dict of str to str
        SHA-256 of the recorded motions, of the hazard curve and of the ShakeMap, by the name of the file.
    hazard : HazardCurve, optional
        The hazard curve of the site.
    site_ground : SiteGround, optional
        How the ground shakes at the building by a ShakeMap or scenarios.
    records : dict
        The recorded motions of the floors, by the number of their row and axis.
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
        self._read: dict[str, tuple[tuple[Record, ...] | CellError, str]] = {}
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
            try:
                self.hazard = self._read_hazard(row.get("hazard"), row.get("latitude"), row.get("longitude"))
            except CellError as error:
                yield table.problem("hazard", row, error.message, error.fix)
                continue
            yield from (
                table.problem("hazard", row, fill("the hazard curve: {note}.", note=note), severity="warning")
                for note in self.hazard.remarks
            )

    def _read_hazard(self, file: str, latitude: float | None, longitude: float | None) -> HazardCurve:
        content, address = self._find(file)
        key = find_key(content, "hazard", latitude, longitude)
        found = self.kept.take(key, self._allowance, lambda: _parse_hazard(content, address, latitude, longitude))
        if isinstance(found, CellError):
            raise found
        curve: HazardCurve
        curve, self.hashes[file] = found
        return curve

    def check_ground(self, tables: Tables) -> Iterator[Problem]:
        """Find the ground motion of the run, or of the ShakeMap that is named, at the building, or report a fault."""
        if self.ground is not None:
            yield from self._place(tables, GroundReader(self.ground))
            return
        table = tables["Building"]
        for row in table.with_all("shakemap"):
            try:
                map_ = self._read_shakemap(row.get("shakemap"))
            except CellError as error:
                yield table.problem("shakemap", row, error.message, error.fix)
                continue
            if table.says(row, *STRONGER):
                continue
            if table.lacks(row, "latitude") or table.lacks(row, "longitude"):
                yield from report_unplaced(table, row)
                continue
            yield from self._place(tables, GroundReader(map_, "shakemap"))

    def _place(self, tables: Tables, reader: GroundReader) -> Iterator[Problem]:
        yield from reader.check(tables)
        self.site_ground = reader.found

    def _read_shakemap(self, file: str) -> ShakeMap:
        content, address = self._find(file)
        beside = self._find_beside(file)
        keys = [None if one is None else find_key(one, "shakemap") for one in (content, beside[0])]
        key = None if keys[0] is None else (*keys[0], keys[1])
        found = self.kept.take(key, self._allowance, lambda: _parse_shakemap(content, address, *beside))
        if isinstance(found, CellError):
            raise found
        map_: ShakeMap = found
        self.hashes[file] = map_.grid_sha256
        if map_.uncertainty_file:
            self.hashes[beside[1]] = map_.uncertainty_sha256
        return map_

    def _find_beside(self, file: str) -> tuple[bytes | Path | None, str]:
        """Return the file of uncertainties beside the grid of a ShakeMap, and its name; None where there is none."""
        for path in list_beside(file):
            try:
                return self._find(path)[0], path
            except CellError:
                continue
        return None, ""

    def check_records(self, tables: Tables) -> Iterator[Problem]:
        """Read the recorded motions of the floors, or report what is wrong with them or with their direction."""
        table = tables["Floors"]
        azimuth = next((row.get("azimuth_deg") for row in tables["Building"].rows), None)
        for row in table.with_all("floor"):
            for axis in AXES:
                along = None if azimuth is None else azimuth + (90 if axis == "Y" else 0)
                yield from self._check_cell(table, row, axis, along)

    def _check_cell(self, table: Table, row: Row, axis: Axis, along: float | None) -> Iterator[Problem]:
        name, found = f"record_{axis.lower()}", []
        text = row.get(name)
        names = split_names(text)
        if text is not None and not names:
            message = fill("{text} names no file.", text=shorten(text))
            yield table.problem(name, row, message, fill("Name a record, or clear the cell."))
        for one in names:
            try:
                record = self._record(one)
            except CellError as error:
                yield table.problem(name, row, error.message, error.fix)
                continue
            found.append(record)
            yield from _check_direction(table, name, row, record, axis, along)
        if found:
            self.records[row.number, axis] = tuple(found)

    def _record(self, text: str) -> FloorRecord:
        file, _, channel = (part.strip() for part in text.partition("#"))
        known, digest = self._records(file)
        if isinstance(known, CellError):
            raise known
        try:
            record = select(known, channel or None)
        except RecordError as error:
            raise CellError(fill("{why}.", why=error.message)) from None
        if record.vertical:
            message = fill("{text} is a vertical channel.", text=shorten(text))
            raise CellError(message, fill("Choose a horizontal one."))
        path = None if self.folder is None else (self.folder / _posix(file)).resolve()
        return FloorRecord(name=text, record=record, file=file, channel=channel, sha256=digest, path=path)

    def _records(self, file: str) -> tuple[tuple[Record, ...] | CellError, str]:
        content, address = self._find(file)
        if address not in self._read:
            self.progress.check()
            found, digest = self._read[address] = self._take(content, address)
            if not isinstance(found, CellError):
                self.hashes[file] = digest
        return self._read[address]

    def _take(self, content: bytes | Path, address: str) -> tuple[tuple[Record, ...] | CellError, str]:
        allowance, key = self._allowance, find_key(content, "record")
        try:
            found: tuple[tuple[Record, ...] | CellError, str] = self.kept.take(
                key, allowance, lambda: _parse(content, address, allowance, self.progress)
            )
        except CellError as error:  # of the allowance
            return error, ""
        return found

    def _find(self, file: str) -> tuple[bytes | Path, str]:
        if self.folder is not None:
            path = find_file(file, self.folder)
            return path, str(path)
        address = posixpath.normpath(_posix(file))
        if address not in self.given:
            message = fill("the file {name} is not among the records that were passed.", name=shorten(file))
            raise CellError(message, fill("Pass its bytes in `records`."))
        return self.given[address], address


def _parse(
    data: bytes | Path, address: str, allowance: Allowance, progress: Progress
) -> tuple[tuple[Record, ...] | CellError, str]:
    try:
        read = data if isinstance(data, bytes) else read_bytes(data)
        allowance.take_record(len(read), is_archive=is_archive(read))
        found = parse_records(read, PurePosixPath(_posix(address)).name, progress=progress)
        allowance.take_samples(sum(record.acceleration.size for record in found))
        return found, hashlib.sha256(read).hexdigest()
    except RecordError as error:
        return CellError(fill("the record cannot be read: {why}.", why=error.message)), ""


def _parse_hazard(
    content: bytes | Path, address: str, latitude: float | None, longitude: float | None
) -> tuple[HazardCurve, str] | CellError:
    try:
        data = content if isinstance(content, bytes) else read_hazard_bytes(content)
        name = PurePosixPath(_posix(address)).name
        curve = parse_hazard(data, name, latitude=latitude, longitude=longitude)
    except InputError as error:
        fix = fill("Correct the file, or give a CSV file with the columns pga_g,annual_rate.")
        return CellError(fill("the hazard curve cannot be used: {why}.", why=error.message), fix)
    return curve, hashlib.sha256(data).hexdigest()


def _parse_shakemap(
    content: bytes | Path, address: str, beside: bytes | Path | None, beside_name: str
) -> ShakeMap | CellError:
    try:
        data, more = (read_grid_file(one) if isinstance(one, Path) else one for one in (content, beside))
        name, other = (PurePosixPath(_posix(one)).name for one in (address, beside_name))
        return parse_shakemap(data or b"", name, uncertainty=more, uncertainty_name=other)
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
        message = fill(
            "{record} points to {azimuth:g} deg, {off:.0f} deg off the {axis} axis.",
            record=shorten(one.name),
            azimuth=azimuth,
            off=off,
            axis=axis,
        )
        yield table.problem(name, row, message, fill("Check the axis, or Azimuth of X in Building."), "warning")


# ---------------------------------------------------------------- names of files


def find_file(text: str, folder: Path) -> Path:
    """Return the file that `text` names inside `folder`.

    Raises CellError if the name leads outside the folder, or no such file is there.
    """
    path = find_place(text, folder)
    if not path.is_file():
        message = fill("the file {name} was not found next to the workbook.", name=shorten(text))
        raise CellError(message, fill("Check the name, or copy the file there."))
    return path


def find_place(text: str, folder: Path) -> Path:
    """Return where the file that `text` names inside `folder` belongs, be it there or not.

    Raises CellError if the name leads outside the folder, or can be that of no file.
    """
    name = shorten(text)
    if not _is_inside(text):
        raise CellError(
            fill("the file {name} is outside the workbook's folder.", name=name),
            fill("Copy it next to the workbook and write its name alone."),
        )
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
    """Return how the file of uncertainties beside the grid of a ShakeMap may be called, as a workbook would name it."""
    folder, _, name = _posix(file).rpartition("/")
    return [f"{folder}/{one}" if folder else one for one in name_uncertainty(name)]


def _posix(text: str) -> str:
    return PureWindowsPath(text).as_posix()


def _is_inside(text: str) -> bool:
    windows, posix = PureWindowsPath(text), PurePosixPath(text)
    odd = any(unicodedata.category(character) in ("Cc", "Cf", "Cs") for character in text)
    absolute = windows.drive or windows.root or posix.is_absolute() or ":" in text
    reserved = any(part.split(".")[0].upper() in _RESERVED for part in windows.parts)
    return not (odd or absolute or reserved or ".." in windows.parts or ".." in posix.parts or len(text) > 500)
