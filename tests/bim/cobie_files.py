"""COBie files for tests, written sheet by sheet.

Names of sheets and columns, their order and the pick lists are those of COBie 2.4 (National BIM Standard - United
States, Version 3, Annex A). What programs do otherwise, and the tests hold, was seen in public files: "Movable" for
Moveable, numbers stored as texts, n/a, sizes of 0.0, units as "Millimeters", elevations from 100 m, a row of "required"
and "lookup", the header row repeated.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tests.workbook.books import write_book

Rows = Sequence[Sequence[Any]]

HEADERS: Mapping[str, Sequence[str]] = {
    "Facility": (
        "Name", "CreatedBy", "CreatedOn", "Category", "ProjectName", "SiteName", "LinearUnits", "AreaUnits",
    ),
    "Floor": (
        "Name", "CreatedBy", "CreatedOn", "Category", "ExtSystem", "ExtObject", "ExtIdentifier", "Description",
        "Elevation", "Height",
    ),
    "Space": (
        "Name", "CreatedBy", "CreatedOn", "Category", "FloorName", "Description", "ExtSystem", "ExtObject",
        "ExtIdentifier", "RoomTag",
    ),
    "Type": (
        "Name", "CreatedBy", "CreatedOn", "Category", "Description", "AssetType", "Manufacturer", "ModelNumber",
        "NominalLength", "NominalWidth", "NominalHeight",
    ),
    "Component": (
        "Name", "CreatedBy", "CreatedOn", "TypeName", "Space", "Description", "ExtSystem", "ExtObject", "ExtIdentifier",
    ),
}  # fmt: skip

FACILITY = {"Name": "East wing", "Category": "11-13 24 11: Hospital", "SiteName": "1 Main Street",
            "LinearUnits": "millimeters"}  # fmt: skip
FLOORS = (
    {"Name": "Ground", "Category": "Floor", "Elevation": 0, "Height": 4000},
    {"Name": "Upper", "Category": "Floor", "Elevation": 4000, "Height": "n/a"},
    {"Name": "Roof", "Category": "Roof", "Elevation": 8000},
)
SPACES = ({"Name": "G01", "FloorName": "Ground"}, {"Name": "U01", "FloorName": "Upper"})
BOOKCASE = {
    "Name": "Bookcase A", "AssetType": "Moveable", "NominalLength": 900, "NominalWidth": 303, "NominalHeight": 2000,
}  # fmt: skip
TYPES = (BOOKCASE, {"Name": "Door B", "AssetType": "Fixed", "NominalLength": 900, "NominalHeight": 2100})
COMPONENTS = (
    {"Name": "Bookcase A:1", "TypeName": "Bookcase A", "Space": "G01", "ExtIdentifier": "3rGjfVfe$JIh3c7s8Nfdyk"},
    {"Name": "Bookcase A:2", "TypeName": "Bookcase A", "Space": "U01", "ExtIdentifier": "n/a"},
    {"Name": "Door B:1", "TypeName": "Door B", "Space": "G01,U01"},
)


def sheet(name: str, rows: Sequence[Mapping[str, Any]]) -> list[list[Any]]:
    """Return a sheet with its header row; what a row does not say is n/a, as programs write it."""
    return [list(HEADERS[name]), *([row.get(column, "n/a") for column in HEADERS[name]] for row in rows)]


def make_sheets(
    facility: Mapping[str, Any] | None = None,
    floors: Sequence[Mapping[str, Any]] = FLOORS,
    spaces: Sequence[Mapping[str, Any]] = SPACES,
    types: Sequence[Mapping[str, Any]] = TYPES,
    components: Sequence[Mapping[str, Any]] = COMPONENTS,
) -> dict[str, list[list[Any]]]:
    """Return the five sheets that are read, with these rows; a small building where none are given."""
    rows = {"Facility": [{**FACILITY, **(facility or {})}], "Floor": floors, "Space": spaces, "Type": types,
            "Component": components}  # fmt: skip
    return {"Instruction": [["Title", "COBie"]], **{name: sheet(name, some) for name, some in rows.items()}}


def write_cobie(path: Path, **rows: Any) -> Path:
    return write_book(path, make_sheets(**rows))


def one_type(**values: Any) -> dict[str, Any]:
    """Return rows of types and components for `write_cobie`: the bookcase, with other values, and one piece of it."""
    return {"types": ({**BOOKCASE, **values},), "components": COMPONENTS[:1]}
