"""results.json of unknown origin, read back: a `PastRun`, or an error that names the file, the place and the fault.

A comparison knows no more of a run. Read are the files of one major version of the schema; of a later minor version
what is new is left alone.
"""

import datetime
import hashlib
import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Never, TypeVar

from assess.delivery.deliver import explain_unfinished, is_unfinished
from assess.errors import InputError
from assess.fields import item_fields
from assess.i18n import Text, fill
from assess.model import MEASURED
from assess.report.data import VERSION
from assess.report.ownership import DATA
from assess.resources import read_input
from assess.results import BASES, CANNOT_ROCK, ROLLS
from assess.risk import RiskClass
from assess.table import Field, unnest
from assess.text import plain_line
from assess.workbook.names import key

CLASSES: Mapping[str, RiskClass] = {risk.word: risk for risk in reversed(RiskClass)}
"""The classes by their words, the highest first."""
UNCONFIRMED, BY_FORMULA, ANCHORED = "unconfirmed", "by formula", "anchored"
APART = (UNCONFIRMED, BY_FORMULA, ROLLS, ANCHORED)
"""What stands outside the classes of a run."""
_EVERY = {one.key: one for one in item_fields(())}
INPUTS: Mapping[str, Field] = {
    key: _EVERY[key]
    for key in (
        "floor", "room", "type", "quantity", "breadth_cm", "width_cm", "height_cm", "sizes_from", "centre_of_gravity",
        "weight_kg", "friction", "anchored", "bracket_height_cm", "bracket_capacity_kn", "against_wall", "axis",
        "pfa_g", "pfv_cm_s",
    )
}  # fmt: skip
"""Inputs of a piece, whose change explains that of its chance."""


@dataclass(frozen=True, slots=True)
class PastChance:
    """A chance [-] with the ends of its interval, None where there is none."""

    probability: float
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class PastPiece:
    """One row of furniture with what was adopted for it; one that `is_held` counts as anchored, and has no class.

    `inputs` is what the run was given or used for it, by the fields of `INPUTS`.
    """

    item: str
    floor: str
    room: str
    description: str
    quantity: int
    is_held: bool
    basis: str
    risk: RiskClass
    chance: PastChance
    inputs: Mapping[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class PastState:
    """A route (`floor` is "") or a room, whose state is that of its best way to the street.

    `chance` is that of being blocked, or of losing every exit, None where that was not evaluated.
    """

    name: str
    floor: str
    state: str
    chance: PastChance | None


@dataclass(frozen=True, slots=True, kw_only=True)
class PastEntry:
    """One entry of what to fix: its pieces by name, and how they are fixed; `phase` is "" in earlier versions."""

    place: int
    phase: str
    floor: str
    room: str
    items: tuple[str, ...]
    details: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class PastRun:
    """One run, as its results.json has it.

    `sha256` is that of the file, `written` when it was last changed, in UTC; `code` the SHA-256 of the program, "" in
    earlier versions. `uncertainty` is what the draws vary, `shaking` an assumed intensity, `site_ground` file, PGA and
    hash of a ShakeMap or of scenarios, "" where there is none; `motions` are hashes by the names of files. Expected
    numbers of routes and rooms are of those that are known; a room that no segment joins to an exit is unjoined.
    """

    path: Path
    sha256: str
    written: datetime.datetime
    schema: str
    version: str
    code: str
    platform: Mapping[str, str]
    settings: Mapping[str, Any]
    building: Mapping[str, Any]
    uncertainty: Mapping[str, Any]
    shaking: str
    site_ground: str
    workbook: str
    workbook_sha256: str
    motions: Mapping[str, str]
    is_simulated: bool
    pieces: tuple[PastPiece, ...]
    routes: tuple[PastState, ...]
    rooms: tuple[PastState, ...]
    route_risk: float
    blocked_routes: float
    cut_off_rooms: float
    unknown_routes: int
    unknown_rooms: int
    unjoined_rooms: tuple[str, ...]
    entries: tuple[PastEntry, ...] = ()

    @property
    def name(self) -> str:
        """Name of the building; "" where it has none."""
        return str(self.building.get("building") or "")

    @property
    def main_basis(self) -> str:
        """What its classes, counts and sums rest on: "simulated" or "formula"."""
        return "simulated" if self.is_simulated else "formula"

    def is_counted(self, piece: PastPiece) -> bool:
        """Whether a piece is in the classes and sums: free-standing, and of the basis of the run or unable to rock."""
        return not piece.is_held and piece.basis in (self.main_basis, CANNOT_ROCK)

    def standing(self, piece: PastPiece) -> str:
        """Return the class of a piece in words, or one of `APART`."""
        if piece.is_held:
            return ANCHORED
        if self.is_counted(piece):
            return piece.risk.word
        return piece.basis if piece.basis in (UNCONFIRMED, ROLLS) else BY_FORMULA


COMPARISON = "comparison"
"""Entry that distinguishes compare.json, which is not a run, from results.json."""
MOST_BYTES = 1 << 30
"""Size [bytes] above which a file is not read: 20,000 items take a tenth of it."""
_MISSING = object()
_Row = TypeVar("_Row")


def read_run(path: Path) -> PastRun:
    """Read the results of a run.

    * `path`: a results.json under any name, or the folder that holds one.

    Raises InputError if there is none, it cannot be read, is cut off, was written by another program or by a version of
    this one with another major version of the schema, or a value in it is not what it may be.
    """
    return read_record(path)[0]


def read_record(path: Path) -> tuple[PastRun, "Part"]:
    """Read the results of a run, and return its record as well, of which further values can be read."""
    file = path / DATA if path.is_dir() else path
    try:
        if not file.exists():
            if is_unfinished(file.parent, file.name):
                raise InputError(explain_unfinished(file.parent))
            if path.is_dir():
                raise InputError.about(
                    "{folder} contains no {name}: name the folder of a report, or its {name}.", folder=path, name=DATA
                )
            raise InputError.about(
                "{path} does not exist: name a {name}, or the folder that holds it.", path=path, name=DATA
            )
        status = file.stat()
        if status.st_size > MOST_BYTES:
            sizes = {"size": status.st_size >> 20, "most": MOST_BYTES >> 20}
            raise InputError.about(
                "{path} is too large: {size:,} MB, at most {most:,} MB are read.", path=file, **sizes
            )
        data = read_input(file, MOST_BYTES)
    except OSError as error:
        why = error.strerror or str(error)
        raise InputError.about("{path} cannot be read: {why}.", path=file, why=why) from None
    record, written = Part(file, "", _parse(file, data)), datetime.datetime.fromtimestamp(status.st_mtime, datetime.UTC)
    return _read_run(record, hashlib.sha256(data).hexdigest(), written), record


def _parse(file: Path, data: bytes) -> Mapping[str, Any]:
    text = ""
    try:
        text = data.decode("utf-8-sig")
        record = json.loads(text, parse_constant=_refuse)
    except (ValueError, RecursionError) as error:
        raise InputError(_describe_fault(file, text, error)) from None
    foreign = fill("{path} was not written by assess: name a {name} written by assess.", path=file, name=DATA)
    if not isinstance(record, dict):
        raise InputError(foreign)
    schema = record.get("schema")
    if not isinstance(schema, str) or not isinstance(record.get("assess"), dict):
        raise InputError(foreign)
    if COMPARISON in record:
        raise InputError.about("{path} is a comparison, not a run: name the {name} of each run.", path=file, name=DATA)
    major, ours = (one.partition(".")[0] for one in (schema, VERSION))
    if not (major.isascii() and major.isdigit() and len(major) < 6):
        raise InputError(foreign)
    if major.lstrip("0") != ours:
        values = {"path": file, "schema": schema[:20], "ours": ours}
        if int(major) < int(ours):
            raise InputError.about(
                "{path} was written by an earlier version of assess: its schema is {schema}, this version reads "
                "{ours}.x. Run its workbook again.",
                **values,
            )
        raise InputError.about(
            "{path} was written by a later version of assess: its schema is {schema}, this version reads {ours}.x. "
            "Update assess.",
            **values,
        )
    if missing := [name for name in ("building", "floors", "items", "routes") if name not in record]:
        raise InputError.about("{path} is incomplete: {name} is missing. Run assess again.", path=file, name=missing[0])
    return record


def _refuse(name: str) -> Never:
    raise ValueError(name)


def _describe_fault(file: Path, text: str, error: Exception) -> Text:
    whole = text.strip()
    if isinstance(error, UnicodeDecodeError) or (whole and not whole.startswith(("{", "["))):
        return fill("{path} is not a JSON file: name a {name} written by assess, or its folder.", path=file, name=DATA)
    if not whole:
        return fill("{path} is empty: run assess again, or use another copy of the file.", path=file)
    at_end = isinstance(error, json.JSONDecodeError) and error.pos >= len(text.rstrip())
    if whole.startswith("{") and (at_end or not whole.endswith("}")):
        return fill("{path} is truncated: run assess again, or use another copy of the file.", path=file)
    if isinstance(error, json.JSONDecodeError):
        line = f"{error.lineno}"
        return fill("{path} is damaged: line {line} is not valid JSON. Run assess again.", path=file, line=line)
    return fill("{path} is damaged: it is not valid JSON. Run assess again.", path=file)


@dataclass(frozen=True, slots=True)
class Part:
    """An object of a record, which stands at a place in its file.

    A method that takes `name` returns the value of this name; it raises InputError where the value is missing or not
    what it may be.
    """

    file: Path
    place: str
    values: Mapping[str, Any]

    def find_place(self, name: str) -> str:
        """Return the place of a value."""
        return f"{self.place}.{name}" if self.place else name

    def read(self, name: str, expected: Text, is_right: Callable[[Any], bool]) -> Any:
        """Return a value."""
        value = self.values.get(name, _MISSING)
        if value is not _MISSING and is_right(value):
            return value
        raise InputError.about(
            "{path}: {place} is {value}, expected {expected}. Run assess again.",
            path=self.file,
            place=self.find_place(name),
            value=fill("missing") if value is _MISSING else repr(value)[:40],
            expected=expected,
        )

    def part(self, name: str) -> "Part":
        """Return an object."""
        found = self.read(name, fill("an object"), lambda value: isinstance(value, dict))
        return Part(self.file, self.find_place(name), found)

    def rows(self, name: str) -> list["Part"]:
        """Return a list of objects."""
        found = self.read(name, fill("a list of objects"), lambda value: _is_list(value, dict))
        return [Part(self.file, f"{self.find_place(name)}[{at}]", row) for at, row in enumerate(found)]

    def text(self, name: str) -> str:
        """Return a text on one line, safe to show."""
        return plain_line(self.read(name, fill("a text"), lambda value: isinstance(value, str)))

    def texts(self, name: str) -> dict[str, str]:
        """Return an object of texts."""
        found = self.part(name)
        return {plain_line(one): found.text(one) for one in found.values}

    def list_texts(self, name: str) -> tuple[str, ...]:
        """Return a list of texts, each on one line; none where an earlier version did not write it."""
        if name not in self.values:
            return ()
        found = self.read(name, fill("a list of texts"), lambda value: _is_list(value, str))
        return tuple(plain_line(one) for one in found)

    def choice(self, name: str, choices: Sequence[str]) -> str:
        """Return one of some words."""
        expected = fill("one of: {names}", names=", ".join(choices))
        return str(self.read(name, expected, lambda value: value in choices))

    def risk(self, name: str) -> RiskClass:
        """Return a class by its word."""
        return CLASSES[self.choice(name, [risk.word for risk in RiskClass])]

    def count(self, name: str) -> int:
        """Return a whole number from 0."""
        expected = fill("a whole number, 0 or above")
        return int(self.read(name, expected, lambda value: isinstance(value, int) and _is_number(value, 1e9)))

    def number(self, name: str) -> float:
        """Return a number from 0."""
        return float(self.read(name, fill("a number, 0 or above"), _is_number))

    def share(self, name: str) -> float:
        """Return a number from 0 to 1."""
        return float(self.read(name, fill("a number from 0 to 1"), lambda value: _is_number(value, 1.0)))

    def plainly(self, name: str) -> dict[str, Any]:
        """Return an object of values that are shown as they are; a list becomes a tuple of texts."""
        return {
            plain_line(key): tuple(plain_line(str(one)) for one in value) if isinstance(value, list) else _plain(value)
            for key, value in self.part(name).values.items()
        }


def _read_run(record: Part, sha256: str, written: datetime.datetime) -> PastRun:
    items, origin, routes = record.rows("items"), record.part("assess"), record.part("routes")
    inputs, shaking, site_ground = origin.part("inputs"), origin.values.get("shaking"), ""
    if origin.values.get("site_ground") is not None:  # absent before version 5.1 of the schema
        found = origin.part("site_ground")
        site_ground = f"{found.text('file')}, {found.number('pga_g'):.3f} g, SHA-256 {found.text('sha256')[:16]}"
    has_schedule = isinstance(record.values.get("schedule"), dict)
    demands = (demand for floor in record.rows("floors") for demand in floor.rows("demands"))

    def read_states(kind: str, chance: str) -> tuple[PastState, ...]:
        """Return the routes or the rooms; their chance, of this name, may be null or absent."""

        def read(row: Part) -> PastState:
            return PastState(
                name=row.text(kind),
                floor=row.text("floor") if kind == "room" else "",
                state=row.text("state"),
                chance=None if row.values.get(chance) is None else _read_chance(row.part(chance)),
            )

        return _read_unique(routes.rows(f"{kind}s"), read, lambda one: (key(one.floor), key(one.name)))

    return PastRun(
        path=record.file,
        sha256=sha256,
        written=written,
        schema=plain_line(record.values["schema"])[:20],
        version=origin.text("version"),
        code=origin.text("code") if "code" in origin.values else "",
        platform=origin.texts("platform"),
        settings=origin.plainly("settings"),
        building=record.plainly("building"),
        uncertainty=origin.plainly("uncertainty"),
        shaking=plain_line(str(shaking.get("name", ""))) if isinstance(shaking, dict) else "",
        site_ground=site_ground,
        workbook=inputs.text("workbook"),
        workbook_sha256=inputs.text("sha256"),
        motions=inputs.texts("records") | inputs.texts("motions"),
        is_simulated=any(one.values.get("ensemble") for one in demands)
        or any(one.values.get("verification") for one in items),
        pieces=_read_unique(items, _read_piece, lambda one: key(one.item)),
        routes=read_states("route", "blocked"),
        rooms=read_states("room", "loses_every_exit"),
        route_risk=routes.share("risk"),
        blocked_routes=routes.number("blocked_routes_expected"),
        cut_off_rooms=routes.number("cut_off_rooms_expected"),
        unknown_routes=routes.count("unknown_routes"),
        unknown_rooms=routes.count("unknown_rooms"),
        unjoined_rooms=routes.list_texts("unjoined_rooms"),
        entries=tuple(map(_read_entry, record.part("schedule").rows("entries") if has_schedule else ())),
    )


def _read_entry(row: Part) -> PastEntry:
    works = row.rows("works")
    return PastEntry(
        place=row.count("place"),
        phase=row.text("phase") if "phase" in row.values else "",
        floor=row.text("floor"),
        room=row.text("room"),
        items=tuple(item for one in works for item in one.list_texts("items")),
        details=tuple(dict.fromkeys(one.text("detail") for one in works)),
    )


def _read_piece(row: Part) -> PastPiece:
    adopted, anchor = row.part("adopted"), row.values.get("anchor")
    anchor = anchor if isinstance(anchor, dict) else {}
    held, inputs = anchor.get("counts_as_anchored"), unnest(row.values, INPUTS.values())
    if anchor.get("is_height_assumed") is True:
        inputs["bracket_height_cm"] = None
    inputs["sizes_from"] = inputs["sizes_from"] or MEASURED  # absent before version 5.2 of the schema
    return PastPiece(
        item=row.text("item"),
        floor=row.text("floor"),
        room=row.text("room"),
        description=row.text("description"),
        quantity=row.count("quantity"),
        is_held=held if isinstance(held, bool) else row.values.get("anchored") == "yes",
        basis=adopted.choice("basis", BASES),
        risk=adopted.risk("class"),
        chance=_read_chance(adopted),
        inputs={name: _plain(value) for name, value in inputs.items()},
    )


def _read_chance(row: Part) -> PastChance:
    ends = (row.share(name) if row.values.get(name) is not None else None for name in ("low", "high"))
    return PastChance(row.share("probability"), *ends)


def _read_unique(rows: Sequence[Part], read: Callable[[Part], _Row], name: Callable[[_Row], Any]) -> tuple[_Row, ...]:
    found: dict[Any, _Row] = {}
    for row in rows:
        one = read(row)
        if name(one) in found:
            raise InputError.about("{path}: {place}: duplicate name. Run assess again.", path=row.file, place=row.place)
        found[name(one)] = one
    return tuple(found.values())


def _plain(value: Any) -> Any:
    if isinstance(value, str):
        return plain_line(value)
    is_shown = isinstance(value, bool) or (isinstance(value, int | float) and -1e15 < value < 1e15)
    return value if is_shown else None


def _is_number(value: Any, most: float = 1e300) -> bool:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return is_number and 0 <= value <= most and math.isfinite(value)


def _is_list(value: Any, kind: type) -> bool:
    return isinstance(value, list) and all(isinstance(one, kind) for one in value)
