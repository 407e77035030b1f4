"""A COBie handover file as an inventory: moveable types with sizes become pieces, each component a row.

Reference: COBie 2.4, the spreadsheet of the National BIM Standard - United States, Version 3, section 4.2 and Annex A.
Used are Facility (Name, LinearUnits, Category, SiteName), Floor (Name, Category, Elevation, Height), Space (Name,
FloorName), Type (Name, AssetType, NominalLength, NominalWidth, NominalHeight) and Component (Name, TypeName, Space,
ExtIdentifier). Files differ from it: sheets and columns in other letter case, numbers stored as texts, a coloured row
above the header, a second row that says "required" and "lookup", the header repeated as a first row.

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
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from assess.bim.building_model import count_skipped
from assess.bim.import_workbook import LOWEST_ROOF, ImportedBuilding, name_apart, note_datum
from assess.errors import Problem, WorkbookError
from assess.i18n import Text, fill, nfill
from assess.progress import SILENT, Progress
from assess.units import LENGTH, read_unit
from assess.workbook.habits import CellError, shorten
from assess.workbook.names import find_sheet, key, plain
from assess.workbook.open import HEADER_ROWS, MAX_ROWS, UNSAVED, Book, read_file, unreadable
from assess.workbook.plain_rows import column_letters
from assess.workbook.schema import BUILDING, CATALOGUE, FLOORS, Column
from assess.workbook.values import ERRORS, cell_reader, is_blank, is_within, read_text

COLUMNS: Mapping[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "Facility": (("Name", "LinearUnits"), ("Category", "SiteName")),
    "Floor": (("Name", "Elevation"), ("Category", "Height", "Description")),
    "Space": (("Name", "FloorName"), ()),
    "Type": (("Name", "AssetType", "NominalLength", "NominalWidth", "NominalHeight"), ()),
    "Component": (("Name", "TypeName", "Space"), ("ExtIdentifier", "ExternalIdentifier")),
}
"""Sheets that are read, with the columns that each must have, and those that are read where they are there."""
SIZES = ("NominalLength", "NominalWidth", "NominalHeight")
MOVEABLE, FIXED = frozenset({"moveable", "movable", "mobile"}), frozenset({"fixed"})
"""AssetType as COBie 2.4 writes it, and as files have it."""
NO_STOREYS = frozenset({"site", "roof", "foundation"})  # categories of rows of the sheet Floor that are no storeys
THIN, SLENDER = 0.10, 0.10
"""A piece thinner than this [m], or with less breadth to height [-], probably hangs on a wall or a window."""
MOST_NAMED = 10
_NOT_GIVEN = frozenset({"n/a", "n.a.", "#n/a", "na", "null", "-", "--"})
_TEMPLATE = frozenset({"required", "lookup", "reference", "external reference", "if specified as required", ""})
"""What the second row of some templates holds in place of data, next to n/a."""
_CODE = re.compile(r"^[\w .-]*\d[\w .-]*\s*:\s*")
"""The number of a classification before the words of a category: ``11-16 27 00: Dormitory``."""
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d{1,3})?", re.ASCII)

Row = Mapping[str, Any]  # values by the column's name in COBie; what is blank or n/a is left out
Left = tuple[str, Text, bool]
"""A type whose components are left out: its name, the reason, and whether it may be furniture."""
_Found = TypeVar("_Found")


def read_cobie(source: Path | bytes, name: str, progress: Progress = SILENT) -> ImportedBuilding:
    """Read the furniture of a COBie file, which messages and the Catalogue call `name`. Raises WorkbookError if it is
    not one, is damaged or larger than the limits of `assess.workbook.open`, lacks a sheet or a column, names no unit of
    length, or one in which no size of its furniture can be.
    """
    sheets = _read_sheets(source, name, progress)
    facility = sheets["Facility"]
    unit = _find_unit(facility, sheets["Type"])
    faults: list[Text] = []
    floors = _by_name(sheets["Floor"], partial(_read_floor, sheets["Floor"], unit, faults))
    origin = fill("COBie file {name}, sheet Type: nominal sizes", name=name)
    types = _by_name(sheets["Type"], lambda kind, _, row: _read_type(kind, row, unit, origin))
    spaces = _by_name(sheets["Space"], lambda room, _, row: (room, floors.get(key(cell_text(row.get("FloorName"))))))
    items, used, skipped, in_several = list[dict[str, Any]](), dict[str, dict[str, Any]](), list[Left](), 0
    for _, row in sheets["Component"].rows:
        named, space = cell_text(row.get("TypeName")), cell_text(row.get("Space"))
        kind = types.get(key(named))
        if kind is None:
            skipped.append((named or "-", fill("not in the sheet Type") if named else fill("TypeName is blank"), True))
            continue
        if isinstance(kind, tuple):
            skipped.append(kind)
            continue
        room, floor = spaces.get(key(space), ("", None))
        if key(space) not in spaces:
            several = [spaces.get(key(part.strip()), ("", None)) for part in space.split(",")]
            room, floor = next((one for one in several if one[1] is not None), ("", None))
            in_several += floor is not None
        if floor is None:
            reason = fill("Space is blank, so that the floor is not known")
            if space:
                reason = fill("its Space is not in the sheet Space, or that has no floor of the sheet Floor")
            skipped.append((kind["type"], reason, True))
            continue
        own = cell_text(row.get("ExtIdentifier")) or cell_text(row.get("ExternalIdentifier"))
        item = cell_text(row.get("Name")) or own or kind["type"]
        sizes = {size: kind[size] for size in ("type", "breadth", "width", "height")}
        used[kind["type"]] = kind
        items.append({"item": item, "floor": floor.name, "room": room, "description": kind["type"], **sizes,
                      "source_id": own or item})  # fmt: skip
    rows, height, doubts = _list_floors(floors, {row["floor"] for row in items})
    own_row = facility.rows[0][1] if facility.rows else {}
    building = {"building": cell_text(own_row.get("Name")), "address": cell_text(own_row.get("SiteName")),
                "use": _CODE.sub("", cell_text(own_row.get("Category")))}  # fmt: skip
    names = name_apart(row["item"] for row in items)
    return ImportedBuilding(
        source=name,
        building={field: text for field, text in building.items() if text} | height,
        floors=rows,
        items=[{**row, "item": item} for item, row in zip(names, items, strict=True)],
        types=list(used.values()),
        skipped=count_skipped(skipped),
        warnings=(*faults, *doubts),
        remarks=tuple(_list_remarks(len(facility.rows), used, in_several)),
    )


def _list_remarks(facilities: int, used: Mapping[str, Mapping[str, Any]], in_several: int) -> Iterator[Text]:
    if facilities > 1:
        yield fill("The sheet Facility has {n} rows; the first was taken.", n=facilities)
    if in_several:
        yield nfill(
            "{n} piece names several spaces; the first that is known was taken.",
            "{n:,} pieces name several spaces; the first that is known was taken.",
            in_several,
        )
    sizes = ((name, one["breadth"] / 100, one["height"] / 100) for name, one in used.items())
    thin = [name for name, breadth, height in sizes if breadth < max(THIN, SLENDER * height)]
    if thin:
        more = fill(" and {n} more", n=len(thin) - MOST_NAMED) if len(thin) > MOST_NAMED else ""
        yield fill(
            "Thinner than 10 cm or than a tenth of their height: {types}{more}. Delete the rows of pieces that hang on "
            "a wall or a window: they do not stand on the floor.",
            types=", ".join(thin[:MOST_NAMED]), more=more,
        )  # fmt: skip
    if used:
        yield fill(
            "COBie files do not record fixings or positions: fill in Anchored where you have seen the fixing; blank "
            "counts as free-standing. Pieces without a position are not checked against evacuation routes."
        )


# ---------------------------------------------------------------- sheets as rows of plain values


@dataclass(frozen=True, slots=True)
class _Sheet:
    name: str
    letters: Mapping[str, str]
    rows: tuple[tuple[int, Row], ...]


def _read_sheets(source: Path | bytes, name: str, progress: Progress) -> dict[str, _Sheet]:
    data = source if isinstance(source, bytes) else read_file(source)
    try:
        with Book(data, name, progress) as book:
            present = {plain(one): one for one in reversed(list(book.sheets))}
            missing = ", ".join(sheet for sheet in COLUMNS if plain(sheet) not in present)
            if not missing:
                return {sheet: _read_sheet(book, sheet, present[plain(sheet)]) for sheet in COLUMNS}
            if {"Items", "Floors"} <= {found[0] for one in book.sheets if (found := find_sheet(one))}:
                message = fill("{name} is an inventory workbook already, not a COBie file.", name=name)
                raise unreadable(message, fill("Check it with `assess check`."))
            message = fill("{name} is no COBie file: it has no sheet named {sheets}.", name=name, sheets=missing)
            raise unreadable(
                message, fill("Export it from the building model as a COBie spreadsheet (.xlsx) with these sheets.")
            )
    except WorkbookError as error:  # the fix of an inventory that is too large is none for a handover file
        fix = fill("Delete the sheets Attribute, Document and Coordinate in a copy of it, and import that.")
        problems = [replace(one, fix=fix) if "assess new" in one.fix else one for one in error.problems]
        raise WorkbookError(problems) from None


def _read_sheet(book: Book, sheet: str, own: str) -> _Sheet:
    needed, others = COLUMNS[sheet]
    wanted = {plain(column): column for column in (*needed, *others)}
    columns: dict[int, str] = {}
    best: dict[int, str] = {}
    rows: list[tuple[int, Row]] = []
    for number, cells in book.cells(own).rows():
        if number > MAX_ROWS:
            message = fill("the sheet has more than {most:,} rows.", most=MAX_ROWS)
            raise WorkbookError([Problem("error", own, f"A{MAX_ROWS + 1}", message, fill("Split the file by floors."))])
        if columns:
            typed = {columns[at]: value for at, value in cells.items() if at in columns and not is_blank(value)}
            texts = {column: cell_text(value).casefold() for column, value in typed.items()}
            is_header = all(plain(text) == plain(column) for column, text in texts.items())
            if not is_header and not set(texts.values()) <= (_TEMPLATE | _NOT_GIVEN):
                given = {column: typed[column] for column, text in texts.items() if text not in _NOT_GIVEN}
                rows.append((number, given))
            continue
        found: dict[int, str] = {}
        for at, value in sorted(cells.items()):
            column = wanted.get(plain(value)) if isinstance(value, str) else None
            if column and column not in found.values():
                found[at] = column
        best = max(best, found, key=len)
        if set(needed) <= set(found.values()):
            columns = found
        elif number >= HEADER_ROWS:
            break
    if not columns:
        missing = ", ".join(column for column in needed if column not in best.values())
        message = fill("the header row lacks {columns}.", columns=missing)
        if not best:
            message = fill("the sheet has no header row with {columns}.", columns=missing)
        fix = fill("Name the columns as COBie 2.4 does, in one of the first {most} rows.", most=HEADER_ROWS)
        raise WorkbookError([Problem("error", own, "", message, fix)])
    return _Sheet(own, {column: column_letters(at) for at, column in columns.items()}, tuple(rows))


def cell_text(value: object) -> str:
    """Return a cell as a text; "" for one that is blank, an error or a formula without a saved value."""
    text = "" if value is None or value is UNSAVED else read_text(value)
    return "" if text in ERRORS else " ".join(text.split())


def _by_name(sheet: _Sheet, read: Callable[[str, int, Row], _Found]) -> dict[str, _Found]:
    """Return what is read of the rows of a sheet, by their names as names are compared; of two alike the first."""
    found: dict[str, _Found] = {}
    for number, row in sheet.rows:
        name = cell_text(row.get("Name"))
        if name and key(name) not in found:
            found[key(name)] = read(name, number, row)
    return found


class _Floor(NamedTuple):
    """One row of the sheet Floor: `elevation` above the file's datum, `height` of the storey [m]; None if unknown."""

    name: str
    description: str
    category: str
    elevation: float | None
    height: float | None


def _read_floor(sheet: _Sheet, unit: str, faults: list[Text], name: str, number: int, row: Row) -> _Floor:
    elevation = height = None
    try:
        if row.get("Elevation") is not None:
            elevation = _read_length(FLOORS.column("elevation"), "Elevation", row["Elevation"], unit)
    except CellError as error:
        cell = f"{sheet.name}!{sheet.letters['Elevation']}{number}"
        faults.append(fill("{cell}: {message} It was left blank.", cell=cell, message=error.message))
    with suppress(CellError):  # only the height of the building rests on it, and that may stay blank
        height = _read_length(BUILDING.column("height"), "Height", row.get("Height"), unit)
    return _Floor(name, cell_text(row.get("Description")), cell_text(row.get("Category")).casefold(), elevation, height)


def _list_floors(
    floors: Mapping[str, _Floor], used: Collection[str]
) -> tuple[list[dict[str, Any]], dict[str, Any], list[Text]]:
    """Return the rows of Floors from the lowest, the height as a field of Building if it is known, and warnings."""
    kept = [floor for floor in floors.values() if floor.category not in NO_STOREYS or floor.name in used]
    kept.sort(key=lambda floor: floor.elevation or 0.0)
    known = [(floor, floor.elevation) for floor in kept if floor.elevation is not None]
    warnings = note_datum([(floor.name, elevation) for floor, elevation in known])
    blank = [floor.name for floor in kept if floor.elevation is None]
    if blank:
        warnings.append(fill("No Elevation is given of: {floors}.", floors=", ".join(blank)))
    tops = [one.elevation for one in floors.values() if one.category == "roof" and one.elevation is not None]
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


def _find_unit(facility: _Sheet, types: _Sheet) -> str:
    """Return the unit of lengths of the file, one of `assess.units.LENGTH`.

    Raises WorkbookError if LinearUnits is blank, names no unit that sizes of furniture are given in, or one in which no
    size of the furniture is in range while most are in another.
    """
    line, row = facility.rows[0] if facility.rows else (2, {})
    typed, cell = cell_text(row.get("LinearUnits")), f"{facility.letters['LinearUnits']}{line}"
    unit = next((unit for text in (typed, f"{typed}s") if (unit := read_unit(text)) in LENGTH), None)
    if unit is None:
        message = fill("LinearUnits is blank, so that no size can be read.")
        if typed:
            message = fill("LinearUnits is {unit}, which is not read.", unit=shorten(typed))
        fix = fill("Write the unit of NominalHeight: millimeters, centimeters, meters, inches or feet.")
        raise WorkbookError([Problem("error", facility.name, cell, message, fix)])
    sizes = [
        (cell_text(row.get("Name")), column, number)
        for _, row in types.rows
        if cell_text(row.get("AssetType")).casefold() in MOVEABLE
        for column in SIZES
        if (number := _read_number(row.get(column)))
    ]
    fits = {one: sum(is_within(CATALOGUE.column("height"), size, one) for *_, size in sizes) for one in LENGTH}
    others = [one for one in LENGTH if 2 * fits[one] > len(sizes)]
    if fits[unit] or not others:
        return unit
    name, column, number = sizes[0]
    message = fill(
        "LinearUnits is {unit}, but all sizes of furniture are out of range in that unit: {column} of {name} would be "
        "{number:g} {short}.",
        unit=shorten(typed), column=column, name=shorten(name), number=number, short=unit,
    )  # fmt: skip
    fix = fill("Check LinearUnits: in {units} most of them are in range.", units=", ".join(others))
    raise WorkbookError([Problem("error", facility.name, cell, message, fix)])


def _read_type(name: str, row: Row, unit: str, origin: Text) -> dict[str, Any] | Left:
    asset = cell_text(row.get("AssetType"))
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
    """Return a length [m] within the limits of a column, also of a number stored as a text; else CellError."""
    typed = _read_number(value)
    found, _ = cell_reader(replace(column, label=label), unit)(value if typed is None else typed)
    if not isinstance(found, float):
        raise CellError(fill("{label} is blank.", label=label))
    return found


def _read_number(value: object) -> float | None:
    if isinstance(value, int | float) and not isinstance(value, bool):
        return float(value)
    text = value.strip() if isinstance(value, str) else ""
    number = float(text) if _NUMBER.fullmatch(text) else math.nan
    return number if math.isfinite(number) else None
