"""A COBie handover file as an inventory: moveable types with sizes become pieces, each component a row.

Reference: COBie 2.4 (National BIM Standard - United States, Version 3, section 4.2). Used are Facility (Name,
LinearUnits, Category, SiteName), Floor (Name, Category, Elevation, Height), Space (Name, FloorName), Type (Name,
AssetType, NominalLength, NominalWidth, NominalHeight) and Component (Name, TypeName, Space, ExtIdentifier).

Breadth is the shorter of NominalLength and NominalWidth. These are sizes of the product as its maker states them, not
measured between the supports. A size of 0 counts as not given. COBie tells neither positions, which stand in its sheet
Coordinate if anywhere, nor fixings: Anchored stays blank and counts as free-standing.

Elevations in such files count from any datum: the ground, the sea level, 100 m for the ground floor. The inventory
needs them above the ground. They are taken as they stand: from a datum below the ground all floors come out as the
uppermost of a taller building. To count them from the lowest floor would do the contrary to a file that covers upper
floors alone.
"""

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from assess.bim.building_model import count_skipped
from assess.bim.cobie_sheets import CobieSheet, Row, read_sheets, say
from assess.bim.import_workbook import LOWEST_ROOF, ImportedBuilding, name_apart, note_datum
from assess.errors import Problem, WorkbookError
from assess.i18n import Text, fill, nfill
from assess.progress import SILENT, Progress
from assess.units import LENGTH, read_unit
from assess.workbook.habits import CellError, shorten
from assess.workbook.names import key
from assess.workbook.open import UNSAVED
from assess.workbook.schema import BUILDING, CATALOGUE, FLOORS, Column
from assess.workbook.typed import is_within
from assess.workbook.values import cell_reader

THIN, SLENDER = 0.10, 0.10
"""A piece thinner than this [m], or with less breadth to height [-], probably hangs on a wall or a window."""
MOST_NAMED = 10
_CODE = re.compile(r"^[\w .-]*\d[\w .-]*\s*:\s*")
"""The number of a classification before the words of a category: ``11-16 27 00: Dormitory``."""
NO_STOREYS = frozenset({"site", "roof", "foundation"})
"""Categories of rows of the sheet Floor that are no storeys."""
MOVEABLE, FIXED = frozenset({"moveable", "movable", "mobile"}), frozenset({"fixed"})
"""AssetType as COBie 2.4 writes it, and as files have it."""
SIZES = ("NominalLength", "NominalWidth", "NominalHeight")
Left = tuple[str, Text, bool]
"""A type whose components are left out: its name, the reason, and whether it may be furniture."""
_Found = TypeVar("_Found")
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d{1,3})?", re.ASCII)


def read_cobie(source: Path | bytes, name: str, progress: Progress = SILENT) -> ImportedBuilding:
    """Read the furniture of a COBie file.

    `name`: how messages and the Catalogue call it.
    Raises WorkbookError if it is no COBie file, is damaged or larger than the limits, lacks a sheet or a column, names
    no unit of length, or one in which no size of its furniture can be.

    Returns pieces, floors and types, with what was left out and why.
    """
    sheets = read_sheets(source, name, progress)
    facility = sheets["Facility"]
    unit = _find_unit(facility)
    _check_unit(facility, sheets["Type"], unit)
    faults: list[Text] = []
    floors = _by_name(sheets["Floor"], partial(_read_floor, sheets["Floor"], unit, faults))
    origin = fill("COBie file {name}, sheet Type: nominal sizes", name=name)
    types = _by_name(sheets["Type"], lambda kind, _, row: _read_type(kind, row, unit, origin))
    spaces = _by_name(sheets["Space"], lambda room, _, row: (room, floors.get(key(say(row.get("FloorName"))))))
    found = _Sorted(types, spaces)
    for _, row in sheets["Component"].rows:
        found.take(row)
    rows, height, doubts = _list_floors(floors, {row["floor"] for row in found.items})
    own = facility.rows[0][1] if facility.rows else {}
    building = {"building": say(own.get("Name")), "address": say(own.get("SiteName")),
                "use": _CODE.sub("", say(own.get("Category")))}  # fmt: skip
    names = name_apart(row["item"] for row in found.items)
    return ImportedBuilding(
        source=name,
        building={name: text for name, text in building.items() if text} | height,
        floors=rows,
        items=[{**row, "item": own_name} for own_name, row in zip(names, found.items, strict=True)],
        types=list(found.used.values()),
        skipped=count_skipped(found.skipped),
        warnings=(*faults, *doubts),
        remarks=tuple(_list_remarks(facility, found)),
    )


def _by_name(sheet: CobieSheet, read: Callable[[str, int, Row], _Found]) -> dict[str, _Found]:
    """Return what is read of the rows of a sheet, by their names as names are compared; of two alike the first."""
    found: dict[str, _Found] = {}
    for number, row in sheet.rows:
        name = say(row.get("Name"))
        if name and key(name) not in found:
            found[key(name)] = read(name, number, row)
    return found


def _list_remarks(facility: CobieSheet, found: "_Sorted") -> Iterator[Text]:
    if len(facility.rows) > 1:
        yield fill("The sheet Facility has {n} rows; the first was taken.", n=len(facility.rows))
    if found.with_several_spaces:
        yield nfill(
            "{n} piece names several spaces; the first that is known was taken.",
            "{n:,} pieces name several spaces; the first that is known was taken.",
            found.with_several_spaces,
        )
    sizes = ((name, one["breadth"] / 100, one["height"] / 100) for name, one in found.used.items())
    thin = [name for name, breadth, height in sizes if breadth < max(THIN, SLENDER * height)]
    if thin:
        more = fill(" and {n} more", n=len(thin) - MOST_NAMED) if len(thin) > MOST_NAMED else ""
        yield fill(
            "Thinner than 10 cm or than a tenth of their height: {types}{more}. Delete the rows of pieces that hang on "
            "a wall or a window: they do not stand on the floor.",
            types=", ".join(thin[:MOST_NAMED]), more=more,
        )  # fmt: skip
    if found.items:
        yield fill(
            "COBie files do not record fixings or positions: fill in Anchored where you have seen the fixing; blank "
            "counts as free-standing. Pieces without a position are not checked against evacuation routes."
        )


# ---------------------------------------------------------------- floors


@dataclass(frozen=True, slots=True)
class CobieFloor:
    """One row of the sheet Floor: `elevation` above the file's datum, `height` of the storey [m]; None if unknown."""

    name: str
    description: str = ""
    category: str = ""
    elevation: float | None = None
    height: float | None = None


def _read_floor(sheet: CobieSheet, unit: str, faults: list[Text], name: str, number: int, row: Row) -> CobieFloor:
    elevation = height = None
    try:
        if row.get("Elevation") is not None:
            elevation = _read_length(FLOORS.column("elevation"), "Elevation", row["Elevation"], unit)
    except CellError as error:
        cell = f"{sheet.name}!{sheet.letters['Elevation']}{number}"
        faults.append(fill("{cell}: {message} It was left blank.", cell=cell, message=error.message))
    with suppress(CellError):  # only the height of the building rests on it, and that may stay blank
        height = _read_length(BUILDING.column("height"), "Height", row.get("Height"), unit)
    texts = say(row.get("Description")), say(row.get("Category"))
    return CobieFloor(name, *texts, elevation=elevation, height=height)


def _list_floors(
    floors: Mapping[str, CobieFloor], used: Collection[str]
) -> tuple[list[dict[str, Any]], dict[str, Any], list[Text]]:
    """Return the rows of Floors from the lowest, the height as a field of Building if it is known, and warnings.

    `used`: names of those with pieces, which stay even if they are no storeys.
    """
    kept = [floor for floor in floors.values() if floor.category.casefold() not in NO_STOREYS or floor.name in used]
    kept.sort(key=lambda floor: floor.elevation or 0.0)
    known = [(floor, floor.elevation) for floor in kept if floor.elevation is not None]
    warnings = note_datum([(floor.name, elevation) for floor, elevation in known])
    blank = [floor.name for floor in kept if floor.elevation is None]
    if blank:
        warnings.append(fill("No Elevation is given of: {floors}.", floors=", ".join(blank)))
    tops = [one.elevation for one in floors.values() if one.category.casefold() == "roof" and one.elevation is not None]
    tops += [elevation + floor.height for floor, elevation in known if floor.height is not None]
    top, highest = max(tops, default=0.0), max((elevation for _, elevation in known), default=0.0)
    rows = []
    for floor in kept:
        title = floor.description if key(floor.description) != key(floor.name) else ""
        elevation = None if floor.elevation is None else round(floor.elevation, 3)
        row = {"floor": floor.name, "name": title, "elevation": elevation}
        rows.append({name: value for name, value in row.items() if value not in ("", None)})
    return rows, {"height": round(top, 3)} if top > max(highest, LOWEST_ROOF) else {}, warnings


# ---------------------------------------------------------------- types and their sizes


def _find_unit(sheet: CobieSheet) -> str:
    """Return the unit of lengths of the file, one of `assess.units.LENGTH`.

    Raises WorkbookError if LinearUnits is blank or names no unit that sizes of furniture are given in.
    """
    number, row = sheet.rows[0] if sheet.rows else (2, {})
    typed = say(row.get("LinearUnits"))
    found = next((unit for text in (typed, f"{typed}s") if (unit := read_unit(text)) in LENGTH), None)
    if found is None:
        message = fill("LinearUnits is blank, so that no size can be read.")
        if typed:
            message = fill("LinearUnits is {unit}, which is not read.", unit=shorten(typed))
        fix = fill("Write the unit of NominalHeight: millimeters, centimeters, meters, inches or feet.")
        cell = f"{sheet.letters['LinearUnits']}{number}"
        raise WorkbookError([Problem("error", sheet.name, cell, message, fix)])
    return found


def _check_unit(facility: CobieSheet, types: CobieSheet, unit: str) -> None:
    """Refuse the unit of a file if no size of its furniture is in range in it, and most are in another.

    Raises WorkbookError if so; it names the cell of LinearUnits.
    """
    sizes = [
        (say(row.get("Name")), column, number)
        for _, row in types.rows
        if say(row.get("AssetType")).casefold() in MOVEABLE
        for column in SIZES
        if (number := _read_number(row.get(column)))
    ]
    fits = {one: sum(is_within(CATALOGUE.column("height"), size, one) for *_, size in sizes) for one in LENGTH}
    others = [one for one in LENGTH if 2 * fits[one] > len(sizes)]
    if fits[unit] or not others:
        return
    name, column, number = sizes[0]
    line, row = facility.rows[0]
    message = fill(
        "LinearUnits is {unit}, but all sizes of furniture are out of range in that unit: {column} of {name} would be "
        "{number:g} {short}.",
        unit=shorten(say(row.get("LinearUnits"))), column=column, name=shorten(name), number=number, short=unit,
    )  # fmt: skip
    fix = fill("Check LinearUnits: in {units} most of them are in range.", units=", ".join(others))
    raise WorkbookError([Problem("error", facility.name, f"{facility.letters['LinearUnits']}{line}", message, fix)])


def _read_type(name: str, row: Row, unit: str, origin: Text) -> dict[str, Any] | Left:
    """Return a type as its row of the Catalogue, or why its components are left out."""
    asset = say(row.get("AssetType"))
    if asset.casefold() in FIXED:
        return name, fill("AssetType is Fixed"), False
    if asset.casefold() not in MOVEABLE:
        reason = fill("AssetType is blank, so that it is not known whether they are furniture")
        if asset:
            reason = fill("AssetType is {value}, expected Fixed or Moveable", value=shorten(asset))
        return name, reason, True
    # 0 is what programs write of a size that they do not know
    missing = [one for one in SIZES if row.get(one) in (None, UNSAVED) or _read_number(row.get(one)) == 0]
    if missing:
        return name, fill("no {columns}", columns=", ".join(missing)), True
    try:
        length, width, height = (_read_length(CATALOGUE.column("height"), one, row[one], unit) for one in SIZES)
    except CellError as error:
        return name, fill("{message}", message=error.message.rstrip(".")), True
    sizes = {"breadth": min(length, width), "width": max(length, width), "height": height}
    return {"type": name, **{size: round(100 * value, 2) for size, value in sizes.items()}, "source": origin}


def _read_length(column: Column, label: str, value: object, unit: str) -> float:
    """Return a length [m] within the limits of a column of the inventory.

    Numbers stored as texts are read as programs write them, with a point as the decimal sign.

    Raises CellError if it is no number, or out of the limits.
    """
    typed = _read_number(value)
    found, _ = cell_reader(replace(column, label=label), unit)(value if typed is None else typed)
    if not isinstance(found, float):
        raise CellError(fill("{label} is blank.", label=label))
    return found


def _read_number(value: object) -> float | None:
    """Return the number of a cell, also where it is stored as a text; None where it is none."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return float(value)
    text = value.strip() if isinstance(value, str) else ""
    number = float(text) if _NUMBER.fullmatch(text) else math.nan
    return number if math.isfinite(number) else None


# ---------------------------------------------------------------- components and their spaces


@dataclass(slots=True)
class _Sorted:
    """Components sorted into rows of Items, with the types that they use by name, and what is left out.

    `spaces`: room and floor by the name of a space as names are compared.
    """

    types: Mapping[str, dict[str, Any] | Left]
    spaces: Mapping[str, tuple[str, CobieFloor | None]]
    items: list[dict[str, Any]] = field(default_factory=list)
    used: dict[str, dict[str, Any]] = field(default_factory=dict)
    skipped: list[Left] = field(default_factory=list)
    with_several_spaces: int = 0

    def take(self, row: Row) -> None:
        named, space = say(row.get("TypeName")), say(row.get("Space"))
        kind = self.types.get(key(named))
        if kind is None:
            reason = fill("not in the sheet Type") if named else fill("TypeName is blank")
            self.skipped.append((named or "-", reason, True))
            return
        if isinstance(kind, tuple):
            self.skipped.append(kind)
            return
        room, floor = self._find_space(space)
        if floor is None:
            reason = fill("Space is blank, so that the floor is not known")
            if space:
                reason = fill("its Space is not in the sheet Space, or that has no floor of the sheet Floor")
            self.skipped.append((kind["type"], reason, True))
            return
        own = say(row.get("ExtIdentifier")) or say(row.get("ExternalIdentifier"))
        name = say(row.get("Name")) or own or kind["type"]
        sizes = {size: kind[size] for size in ("type", "breadth", "width", "height")}
        self.used[kind["type"]] = kind
        self.items.append({"item": name, "floor": floor.name, "room": room, "description": kind["type"], **sizes,
                           "source_id": own or name})  # fmt: skip

    def _find_space(self, named: str) -> tuple[str, CobieFloor | None]:
        if key(named) in self.spaces:
            return self.spaces[key(named)]
        for part in named.split(","):
            room, floor = self.spaces.get(key(part.strip()), ("", None))
            if floor is not None:
                self.with_several_spaces += 1
                return room, floor
        return "", None
