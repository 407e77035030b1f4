"""The inventory: what a workbook holds, checked, in SI units."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from assess.errors import Problem
from assess.language import find_language
from assess.motion.record import Record

if TYPE_CHECKING:
    import pandas as pd

Axis = Literal["X", "Y"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Building:
    """The building and the earthquake; a blank text or None where the workbook says nothing.

    Lengths in m, `period` in s, accelerations in m/s2, `azimuth_deg` clockwise from north. `cells` tells in which cell
    of the sheet a field stands.
    """

    building: str = ""
    address: str = ""
    use: str = ""
    client: str = ""
    storeys: int | None = None
    height: float | None = None
    period: float | None = None
    azimuth_deg: float | None = None
    prepared_by: str = ""
    checked_by: str = ""
    approved_by: str = ""
    revision: str = ""
    report_date: str = ""
    organisation: str = ""
    logo: Path | None = None
    scenario: str = ""
    scenario_kind: str = ""
    ground_pga: float | None = None
    sds: float | None = None
    friction: float | None = None
    restitution: float | None = None
    language: str = ""
    cells: Mapping[str, str] = field(default_factory=dict)

    def cell(self, name: str) -> str:
        """Address of a field; "" where the sheet lacks it."""
        return self.cells.get(name, "")


@dataclass(frozen=True, slots=True, kw_only=True)
class FloorRecord:
    """One recorded motion that a floor names: the text of its cell (one of those split by ;) and the record."""

    name: str
    record: Record


@dataclass(frozen=True, slots=True, kw_only=True)
class Floor:
    """One floor. `elevation` [m], `pfa` [m/s2] and `pfv` [m/s] by axis where given, `records` by axis.

    `cells` tells in which cell of the sheet a field stands.
    """

    row: int
    floor: str
    name: str = ""
    elevation: float | None = None
    pfa: Mapping[Axis, float] = field(default_factory=dict)
    pfv: Mapping[Axis, float] = field(default_factory=dict)
    records: Mapping[Axis, tuple[FloorRecord, ...]] = field(default_factory=dict)
    plan: Path | None = None
    cells: Mapping[str, str] = field(default_factory=dict)

    def cell(self, name: str) -> str:
        """Address of a field; the first column where the sheet lacks it."""
        return self.cells.get(name, f"A{self.row}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Item:
    """One row of furniture. Sizes, positions and distances in m; `angle_deg` anticlockwise from X to Breadth.

    `assumed` names the fields that were blank in the workbook and were filled in: sizes from the catalogue, the axis
    from the angle, the building's friction. `extra` holds what stood in columns that `assess` does not know.
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
    notes: str = ""
    assumed: tuple[str, ...] = ()
    extra: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """A room, door, stair or exit; position in m."""

    row: int
    place: str
    floor: str
    x: float | None = None
    y: float | None = None
    kind: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Segment:
    """One segment of an evacuation route; widths in m.

    `room` names the rooms that it runs through, split by ;: walls keep pieces of others away. Blank: not known.
    """

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
        return tuple(name for part in self.room.split(";") if (name := part.strip()))


@dataclass(frozen=True, slots=True, kw_only=True)
class CatalogueType:
    """A type of furniture with its sizes [m]."""

    row: int
    type: str
    breadth: float | None = None
    width: float | None = None
    height: float | None = None
    source: str = ""


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Inventory:
    """A building's furniture, its floors and how they shake.

    Parameters
    ----------
    source : Path
        The workbook.
    sha256 : str
        Hash of the workbook's bytes.
    building, floors, items, places, routes, catalogue
        The sheets.
    problems : tuple of Problem
        Warnings and notes; an inventory with errors is never built.
    extra_columns : tuple of str
        Headers of the columns of Items that `assess` does not know.
    files : mapping of str to str
        Hashes (SHA-256) of the recorded motions, by name.
    language : str
        Code of the workbook's language: that of more than half of the sheets it has, by their names; else English.
    sheets : mapping of str to str
        The workbook's own names of its sheets, by the English ones.
    letters : mapping of str to mapping of str to str
        In which column of a sheet a field stands: letters by field, by the English name of the sheet.
    """

    source: Path
    sha256: str
    building: Building
    floors: tuple[Floor, ...]
    items: tuple[Item, ...]
    places: tuple[Place, ...] = ()
    routes: tuple[Segment, ...] = ()
    catalogue: tuple[CatalogueType, ...] = ()
    problems: tuple[Problem, ...] = ()
    extra_columns: tuple[str, ...] = ()
    files: Mapping[str, str] = field(default_factory=dict)
    language: str = "en"
    sheets: Mapping[str, str] = field(default_factory=dict)
    letters: Mapping[str, Mapping[str, str]] = field(default_factory=dict)

    @property
    def report_language(self) -> str:
        """Code of the language of the reports: what Building asks for, else the workbook's own."""
        return find_language(self.building.language or self.language)

    def place(self, problem: Problem) -> Problem:
        """Return a problem with the workbook's own name of its sheet."""
        return replace(problem, sheet=self.sheets.get(problem.sheet, problem.sheet))

    def __repr__(self) -> str:
        return f"<Inventory {self.source.name}: {len(self.items):,} items on {len(self.floors):,} floors>"

    def frame(self) -> "pd.DataFrame":
        """Return the items as a table, one row an item, SI units."""
        import pandas as pd

        return pd.DataFrame([asdict(item) for item in self.items]).set_index("item", drop=False)
