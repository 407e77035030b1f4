"""The floors of a COBie file: which become rows of Floors, and the height of the building.

Elevations in such files count from any datum: the ground, the sea level, 100 m for the ground floor. The inventory
needs them above the ground. They are taken as they stand: from a datum below the ground all floors come out as the
uppermost of a taller building. To count them from the lowest floor would do the contrary to a file that covers upper
floors alone.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from assess.bim.cobie_sheets import CobieSheet, Row, say
from assess.bim.cobie_types import read_length
from assess.i18n import Text, fill
from assess.workbook.habits import CellError
from assess.workbook.names import key
from assess.workbook.schema import BUILDING, FLOORS

NEAR_GROUND = (-1.0, 3.0)
"""Elevations [m] of a lowest floor that lies at the ground, as far as can be known."""
LOWEST_ROOF = 2.0
"""Least height of a building that a workbook takes [m]."""
NO_STOREYS = frozenset({"site", "roof", "foundation"})
"""Categories of rows of the sheet Floor that are no storeys."""


@dataclass(frozen=True, slots=True)
class CobieFloor:
    """One row of the sheet Floor: `elevation` above the file's datum, `height` of the storey [m]; None if unknown."""

    name: str
    description: str = ""
    category: str = ""
    elevation: float | None = None
    height: float | None = None


def read_floors(sheet: CobieSheet, unit: str) -> tuple[dict[str, CobieFloor], list[Text]]:
    """Return the floors by their names as names are compared, of two alike the first, and remarks."""
    found: dict[str, CobieFloor] = {}
    remarks: list[Text] = []
    for number, row in sheet.rows:
        name = say(row.get("Name"))
        if name and key(name) not in found:
            cell = f"{sheet.name}!{sheet.letters['Elevation']}{number}"
            found[key(name)] = _read_floor(name, row, unit, cell, remarks)
    return found, remarks


def _read_floor(name: str, row: Row, unit: str, cell: str, remarks: list[Text]) -> CobieFloor:
    elevation = height = None
    try:
        if row.get("Elevation") is not None:
            elevation = read_length(FLOORS.column("elevation"), "Elevation", row["Elevation"], unit)
    except CellError as error:
        remarks.append(fill("{cell}: {message} It was left blank.", cell=cell, message=error.message))
    try:
        height = read_length(BUILDING.column("height"), "Height", row.get("Height"), unit)
    except CellError:  # only the height of the building rests on it, and that may stay blank
        height = None
    texts = say(row.get("Description")), say(row.get("Category"))
    return CobieFloor(name, *texts, elevation=elevation, height=height)


def list_rows(
    floors: Mapping[str, CobieFloor], used: Collection[str]
) -> tuple[list[dict[str, Any]], dict[str, Any], list[Text]]:
    """Return the rows of Floors from the lowest, the fields of Building that follow from them, and remarks.

    `floors`: from `read_floors`.
    `used`: names of those with pieces, which stay even if they are no storeys.
    """
    kept = [floor for floor in floors.values() if floor.category.casefold() not in NO_STOREYS or floor.name in used]
    kept.sort(key=lambda floor: floor.elevation or 0.0)
    remarks = note_datum([(floor.name, floor.elevation) for floor in kept if floor.elevation is not None])
    blank = [floor.name for floor in kept if floor.elevation is None]
    if blank:
        remarks.append(fill("No Elevation is given of: {floors}.", floors=", ".join(blank)))
    return [_list_row(floor) for floor in kept], _find_height(floors.values(), kept), remarks


def note_datum(known: Sequence[tuple[str, float]]) -> list[Text]:
    """Return what has to be checked of the floors' names and elevations [m], from the lowest."""
    if not known or NEAR_GROUND[0] <= known[0][1] <= NEAR_GROUND[1]:
        return []
    if known[0][1] > NEAR_GROUND[1]:
        text = fill(
            "The lowest floor, {floor}, is at {elevation:g} m in the file. If it lies at the ground, subtract that "
            "from every Elevation in Floors and from Height in Building: else it shakes as the top of a taller "
            "building.",
            floor=known[0][0], elevation=round(known[0][1], 3),
        )  # fmt: skip
        return [text]
    below = [name for name, elevation in known if elevation < NEAR_GROUND[0]]
    text = fill(
        "Below the ground by their elevation, so that they shake as the ground does: {floors}. Correct Elevation in "
        "Floors if the file does not count from the ground.",
        floors=", ".join(below),
    )
    return [text]


def _list_row(floor: CobieFloor) -> dict[str, Any]:
    row: dict[str, Any] = {"floor": floor.name}
    if floor.description and key(floor.description) != key(floor.name):
        row["name"] = floor.description
    if floor.elevation is not None:
        row["elevation"] = round(floor.elevation, 3)
    return row


def _find_height(floors: Collection[CobieFloor], kept: Sequence[CobieFloor]) -> dict[str, Any]:
    tops = [one.elevation for one in floors if one.category.casefold() == "roof" and one.elevation is not None]
    tops += [one.elevation + one.height for one in kept if one.elevation is not None and one.height is not None]
    highest = max((one.elevation for one in kept if one.elevation is not None), default=0.0)
    top = max(tops, default=0.0)
    return {"height": round(top, 3)} if top > max(highest, LOWEST_ROOF) else {}
