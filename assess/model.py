"""The inventory: what a workbook holds, checked, in SI units."""

import hashlib
import math
import posixpath
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import lru_cache, partial
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from assess.errors import Correction, Problem, RecordError
from assess.hazard import HazardCurve
from assess.i18n import count, fill, find_language
from assess.motion.formats import parse_records, select
from assess.motion.record import Record
from assess.motion.scenario import PGA_OF_SDS
from assess.motion.site_ground import SiteGround
from assess.rocking.block import MIDDLE
from assess.text import plain_line
from assess.units import LENGTH, to_edge

if TYPE_CHECKING:
    import pandas as pd

Axis = Literal["X", "Y"]
Outline = tuple[tuple[float, float], ...]
"""Corners of a polygon on the plan of a floor [m], in order; the last one is joined to the first."""
AXES: tuple[Axis, Axis] = ("X", "Y")
ANCHORED = ("no", "yes", "partly", "unknown")
SIZES_FROM = ("measured", "model", "scan")
"""Where the sizes of a piece come from: of those of a scan base and height are drawn wider."""
MEASURED, SCANNED = SIZES_FROM[0], SIZES_FROM[-1]
IMPORTANCE = ("life safety", "function", "property")
UNITS = ("workbook's", "SI", "US")
"""Units of the reports."""
LEVELS = ("0", "1", "2", "3")
COST_PER = ("piece", "fixing")
TEXT_SECTIONS = ("Summary", "What to believe", "What to fix", "Ways out", "Floors", "Limits")
STRUCTURES = ("frame", "walls", "dual", "timber", "masonry", "unknown")

NEAR_AXIS = 15.0  # up to this angle [deg] from an axis a piece, or a record, counts as lying along it

ASSUMABLE = ("breadth", "width", "height", "weight", "centre_of_gravity", "axis", "friction", "quantity", "anchored")
"""Fields of an item that may be filled in where the workbook leaves them blank."""

_FRAMED = (
    "item", "floor", "room", "description", "type", "quantity", "breadth", "width", "height", "centre_of_gravity",
    "axis", "angle_deg", "x", "y", "against_wall", "friction", "importance", "anchored", "route", "segment",
    "edge_distance", "sizes_from", "notes",
)  # fmt: skip
"""Fields in the order of `Inventory.frame`."""


def angle_between(one: float, other: float) -> float:
    """Return the smallest angle between two undirected lines [deg]."""
    return abs((one - other + 90) % 180 - 90)


def axis_of(angle: float) -> Axis | None:
    """Return the axis that a line at `angle` [deg] from X lies along, None where it lies between the two."""
    if angle_between(angle, 0) <= NEAR_AXIS:
        return "X"
    return "Y" if angle_between(angle, 90) <= NEAR_AXIS else None


def split_names(text: str | None) -> list[str]:
    """Return the names in a cell that holds several, split by semicolons."""
    return [name for part in (text or "").split(";") if (name := part.strip())]


@dataclass(frozen=True, slots=True, kw_only=True)
class Building:
    """The building and the earthquake, in SI units; a blank text or None where the workbook says nothing.

    `azimuth_deg` is clockwise from north, `latitude` and `longitude` in degrees, north and east positive. `structure`
    is one of `STRUCTURES`, `shaking` a key of `assess.intensity.SHAKINGS`; `shakemap` and `hazard` name files.
    `motion_uncertainty` is a standard deviation of ln PFA [-], `piece_uncertainty` whether pieces vary from one
    simulated earthquake to the next. `report_units` is "SI" or "US", those of the workbook where its line is blank;
    `anchor_code` is one of `assess.settings.ANCHOR_CODES`. `cells` tells in which cell of the sheet a field stands.
    """

    building: str = ""
    address: str = ""
    latitude: float | None = None
    longitude: float | None = None
    use: str = ""
    client: str = ""
    storeys: int | None = None
    height: float | None = None
    period: float | None = None
    structure: str = ""
    azimuth_deg: float | None = None
    prepared_by: str = ""
    checked_by: str = ""
    approved_by: str = ""
    revision: str = ""
    report_date: str = ""
    organisation: str = ""
    licence: str = ""
    project_number: str = ""
    survey_date: str = ""
    surveyed_by: str = ""
    extent: str = ""
    rooms_not_entered: str = ""
    investigation_level: str = ""
    documents: str = ""
    purpose: str = ""
    logo: Path | None = None
    scenario: str = ""
    scenario_kind: str = ""
    class_by: str = ""
    ground_pga: float | None = None
    ground_pgv: float | None = None
    sds: float | None = None
    anchor_code: str = ""
    shakemap: str = ""
    shaking: str = ""
    hazard: str = ""
    friction: float | None = None
    restitution: float | None = None
    motion_uncertainty: float | None = None
    piece_uncertainty: bool | None = None
    language: str = ""
    report_units: str = ""
    cells: Mapping[str, str] = field(default_factory=dict)

    @property
    def known_pga(self) -> float | None:
        """Ground PGA [m/s2], 0.4 SDS where that is given alone."""
        by_sds = None if self.sds is None else PGA_OF_SDS * self.sds
        return by_sds if self.ground_pga is None else self.ground_pga

    @property
    def own_dispersion(self) -> float:
        """Motion uncertainty [-], 0 where it is blank."""
        return self.motion_uncertainty or 0.0

    def cell(self, name: str) -> str:
        """Address of a field; "" where the sheet lacks it."""
        return self.cells.get(name, "")


class FloorRecord:
    """One recorded motion that a floor names, referred to by the hash of its file.

    It pickles without its waveform, unless it comes from no file; two are equal where their hashes and channels are.
    `name` is the text of the floor's cell (one of those split by ;), `file` and `channel` ("" for the only one) as it
    names them, `sha256` "" where the waveform comes from no file, `path` where the file is, if it is in a folder.
    """

    __slots__ = ("_record", "channel", "file", "name", "path", "sha256")

    def __init__(
        self, *, name: str, record: Record | None = None, file: str = "", channel: str = "", sha256: str = "",
        path: Path | None = None,
    ) -> None:  # fmt: skip
        self.name, self.file, self.channel, self.sha256, self.path = name, file, channel, sha256, path
        self._record = record

    @property
    def record(self) -> Record:
        """The waveform; after unpickling it is read again from its file on first use.

        Raises RecordError if the file is gone or has changed since the workbook was read.
        """
        if self._record is None:
            self._record = select(_read_again(self.path, self.file, self.sha256), self.channel or None)
        return self._record

    def _address(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in ("name", "file", "channel", "sha256", "path")}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, FloorRecord):
            return NotImplemented
        one, two = (part._address() | {"path": None} for part in (self, other))
        if one != two or self.sha256:
            return one == two
        mine, its = self.record, other.record
        return mine.time_step == its.time_step and mine.acceleration.tobytes() == its.acceleration.tobytes()

    def __hash__(self) -> int:
        return hash((self.name, self.file, self.channel, self.sha256))

    def __repr__(self) -> str:
        return f"<FloorRecord {self.name}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(FloorRecord, **self._address(), record=None if self.sha256 else self._record), ()


@lru_cache(maxsize=2)  # channels of one file follow one another
def _read_again(path: Path | None, file: str, sha256: str) -> tuple[Record, ...]:
    if path is None:
        raise RecordError(
            fill("{file}: its recorded motion is not loaded: pass its bytes to `with_records`.", file=file)
        )
    try:
        data = path.read_bytes()
    except OSError as error:
        why = error.strerror or error
        raise RecordError(fill("{file} cannot be read again: {why}.", file=path, why=why)) from None
    return _parse_checked(data, file, sha256)


def _parse_checked(data: bytes, file: str, sha256: str) -> tuple[Record, ...]:
    if hashlib.sha256(data).hexdigest() != sha256:
        raise RecordError(fill("{file} has changed since the workbook was read: read the workbook again.", file=file))
    return parse_records(data, Path(file.replace("\\", "/")).name)


@dataclass(frozen=True, slots=True, kw_only=True)
class FloorPlan:
    """A plan as it lies under the pieces of a floor: its lower left corner and sides [m], turned about that corner.

    `content` is a grey JPEG; or, if `is_lines`, what `linework.unpack` reads. `turn_deg`: anticlockwise.
    """

    path: Path
    content: bytes = field(repr=False)
    is_lines: bool
    left: float
    bottom: float
    width: float
    height: float
    turn_deg: float = 0.0

    def holds(self, at: tuple[float, float]) -> bool:
        """Tell whether a point of the floor [m] lies on the plan."""
        cos, sin = math.cos(math.radians(self.turn_deg)), math.sin(math.radians(self.turn_deg))
        x, y = at[0] - self.left, at[1] - self.bottom
        return 0 <= x * cos + y * sin <= self.width and 0 <= y * cos - x * sin <= self.height


@dataclass(frozen=True, slots=True, kw_only=True)
class Floor:
    """One floor: `elevation` [m], `pfa` [m/s2], `pfv` [m/s] and `records` by axis; `cells` as in `Building`."""

    row: int
    floor: str
    name: str = ""
    elevation: float | None = None
    pfa: Mapping[Axis, float] = field(default_factory=dict)
    pfv: Mapping[Axis, float] = field(default_factory=dict)
    records: Mapping[Axis, tuple[FloorRecord, ...]] = field(default_factory=dict)
    plan: FloorPlan | None = None
    cells: Mapping[str, str] = field(default_factory=dict)

    def cell(self, name: str) -> str:
        """Address of a field; the first column where the sheet lacks it."""
        return self.cells.get(name, f"A{self.row}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Item:
    """One row of furniture. Lengths in m, `weight` in kg, `bracket_capacity` in N; None where blank.

    `angle_deg` is anticlockwise from X to Breadth, `bracket_height` above the floor, `centre_of_gravity` its height as
    a share of the piece's [-]; `against_wall`: whether one of its long sides stands against a wall; `mobile`: whether
    it stands on castors, its Type's where its own is blank; `fix_by`: the detail that its Type is fixed by, a key of
    `assess.details.DETAILS`, "" where that is not known. `assumed` names the fields that were blank and were filled in:
    sizes, weight and centre of gravity from the catalogue, the axis from the angle. A blank `friction` is the
    building's: see `Inventory.complete`. `extra` holds what stood in columns that `assess` does not know; `more` the
    values of columns of the schema that nothing is computed with.
    """

    row: int
    item: str
    floor: str
    room: str = ""
    description: str = ""
    type: str = ""
    quantity: int = 1
    breadth: float
    width: float | None = None
    height: float
    centre_of_gravity: float = MIDDLE
    weight: float | None = None
    bracket_height: float | None = None
    bracket_capacity: float | None = None
    axis: Axis | None = None
    anchored: str = "unknown"
    friction: float | None = None
    x: float | None = None
    y: float | None = None
    angle_deg: float | None = None
    route: str = ""
    segment: str = ""
    edge_distance: float | None = None
    importance: str = ""
    against_wall: bool | None = None
    mobile: bool | None = None
    fix_by: str = ""
    sizes_from: str = MEASURED
    notes: str = ""
    assumed: tuple[str, ...] = ()
    extra: tuple[str, ...] = ()
    more: Mapping[str, Any] = field(default_factory=dict, hash=False)

    @property
    def is_scanned(self) -> bool:
        """Whether its sizes were measured by a scan, and are less certain."""
        return self.sizes_from == SCANNED


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """A room, door, stair or exit; position in m. `outline` holds the corners of its walls on the plan [m]."""

    row: int
    place: str
    floor: str
    x: float | None = None
    y: float | None = None
    kind: str = ""
    outline: Outline = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Segment:
    """One segment of an evacuation route; widths in m; `room` names the rooms that it runs through, split by ;."""

    row: int
    route: str
    segment: str
    floor: str = ""
    start: str = ""
    end: str = ""
    room: str = ""
    clear_width: float | None = None
    required_width: float | None = None
    occupants: int | None = None
    notes: str = ""

    @property
    def rooms(self) -> tuple[str, ...]:
        """The rooms that it runs through, each by its name."""
        return tuple(split_names(self.room))


@dataclass(frozen=True, slots=True, kw_only=True)
class CatalogueType:
    """A type of furniture: sizes [m], weight [kg], height of the centre of gravity as a share of its own [-].

    `fix_by` is a word of `assess.details.FIX_BY`.
    """

    row: int
    type: str
    breadth: float | None = None
    width: float | None = None
    height: float | None = None
    weight: float | None = None
    centre_of_gravity: float | None = None
    fix_by: str = ""
    mobile: bool | None = None
    source: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """What it costs to fix one piece in the way that `detail` names, or one fixing of it: `per`, one of `COST_PER`.

    `currency` is an ISO code, "" where the workbook names none.
    """

    row: int
    detail: str
    unit_cost: float
    currency: str = ""
    per: str = COST_PER[0]
    source: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Passage:
    """A paragraph of the surveyor's own for a section of the report, one of `TEXT_SECTIONS`: data, never markup."""

    row: int
    section: str = TEXT_SECTIONS[0]
    text: str


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Inventory:
    """A building's furniture, its floors and how they shake.

    `problems` holds warnings and notes, errors as well where it was read with ``strict=False``; `corrections` cells
    that were understood although they are not typed as their column asks. `hazard` tells how often a year the ground
    shakes, `site_ground` how it does by a ShakeMap or scenarios; `photos` are small JPEGs by what `photo` in
    `Item.more` names, `files` SHA-256 hashes by name. `language` is that of more than half of the sheets by their
    names, else English; `sheets` are their own names by the English ones, `letters` the columns of fields by sheet.
    `data`, the workbook's bytes, is neither compared nor pickled.
    """

    source: Path
    sha256: str
    building: Building
    floors: tuple[Floor, ...]
    items: tuple[Item, ...]
    places: tuple[Place, ...] = ()
    routes: tuple[Segment, ...] = ()
    catalogue: tuple[CatalogueType, ...] = ()
    costs: tuple[Cost, ...] = ()
    texts: tuple[Passage, ...] = ()
    problems: tuple[Problem, ...] = ()
    extra_columns: tuple[str, ...] = ()
    hazard: HazardCurve | None = field(default=None, compare=False)
    site_ground: SiteGround | None = None
    files: Mapping[str, str] = field(default_factory=dict)
    photos: Mapping[str, bytes] = field(default_factory=dict)
    language: str = "en"
    sheets: Mapping[str, str] = field(default_factory=dict)
    letters: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    corrections: tuple[Correction, ...] = ()

    data: bytes | None = field(default=None, compare=False)

    @property
    def report_language(self) -> str:
        """Code of the language of the reports: what Building asks for, else the workbook's own."""
        return find_language(self.building.language or self.language)

    @property
    def errors(self) -> tuple[Problem, ...]:
        """The errors, if it was read with ``strict=False``."""
        return tuple(one for one in self.problems if one.severity == "error")

    @property
    def file_name(self) -> str:
        """The name of the workbook's file as it is shown: what is no text in it is replaced."""
        return plain_line(self.source.name)

    def locate(self, sheet: str, row: int, field: str) -> str:
        """Return the cell of a field in a row of a sheet, as ``H14``; in column A where it has no column."""
        return f"{self.letters.get(sheet, {}).get(field, 'A')}{row}"

    def friction_of(self, item: Item) -> float | None:
        """Return the coefficient of friction of an item: its own, else the building's; None where it cannot slide."""
        return self.building.friction if item.friction is None else item.friction

    def assumed_of(self, item: Item) -> tuple[str, ...]:
        """Return the fields of an item that were blank and are filled in, the building's friction with them."""
        given = {*item.assumed}
        if item.friction is None and self.building.friction is not None:
            given.add("friction")
        return tuple(name for name in ASSUMABLE if name in given)

    def complete(self, item: Item) -> Item:
        """Return an item as it is assessed: with the building's friction where its own is blank."""
        if item.friction is not None or self.building.friction is None:
            return item
        return replace(item, friction=self.friction_of(item), assumed=self.assumed_of(item))

    def with_records(self, files: Mapping[str, bytes]) -> "Inventory":
        """Return the inventory with the waveforms of its floors read from bytes, by the names in `files`.

        Raises RecordError if the bytes of a file are not those that were there when the workbook was read.
        """
        given = {_file_key(name): data for name, data in files.items()}

        def load(one: FloorRecord) -> FloorRecord:
            data = given.get(_file_key(one.file)) if one.sha256 else None
            if data is None:
                return one
            record = select(_parse_checked(data, one.file, one.sha256), one.channel or None)
            return FloorRecord(record=record, **one._address())

        floors = (
            replace(floor, records={axis: tuple(map(load, ones)) for axis, ones in floor.records.items()})
            for floor in self.floors
        )
        return replace(self, floors=tuple(floors))

    def read_bytes(self) -> bytes | None:
        """Return the workbook's bytes, as they were read; None where they are gone, or it was built in code."""
        if self.data is not None:
            return self.data
        try:
            data = self.source.read_bytes()
        except OSError:
            return None
        return data if hashlib.sha256(data).hexdigest() == self.sha256 else None

    def place(self, problem: Problem) -> Problem:
        """Return a problem with the workbook's own name of its sheet."""
        return replace(problem, sheet=self.sheets.get(problem.sheet, problem.sheet))

    def frame(self) -> "pd.DataFrame":
        """Return the items as a table, one row an item, units in the names as in items.csv."""
        import pandas as pd

        rows = []
        for item in self.items:
            found: dict[str, Any] = {}
            for name in _FRAMED:
                value = getattr(item, name)
                if name in ("breadth", "width", "height"):
                    found[f"{name}_cm"] = None if value is None else to_edge(value, LENGTH["cm"])
                else:
                    found[f"{name}_m" if name in ("x", "y", "edge_distance") else name] = value
            rows.append(found | {"friction": self.friction_of(item), "assumed": list(self.assumed_of(item))})
        return pd.DataFrame(rows).set_index("item", drop=False)

    def __repr__(self) -> str:
        return f"<Inventory {self.file_name}: {count(len(self.items), 'item')} on {count(len(self.floors), 'floor')}>"

    def _repr_html_(self) -> str:
        name, problems = escape(self.building.building or self.file_name), len(self.problems)
        return (
            f"<p><b>{name}</b>: {count(len(self.items), 'item')} on {count(len(self.floors), 'floor')}, "
            f"{count(len(self.routes), 'route segment')}, {count(problems, 'problem')} reported. <code>frame()</code> "
            "lists the items.</p>"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        kept = {one.name: getattr(self, one.name) for one in fields(self) if one.name != "data"}
        return partial(Inventory, **kept), ()


def _file_key(name: str) -> str:
    return posixpath.normpath(name.replace("\\", "/"))
