"""Workbooks for tests, written as a user would fill them in."""

from pathlib import Path
from typing import Any

import assess
from assess.results import Results
from assess.settings import Settings
from assess.workbook.layout import LETTERS
from assess.workbook.template import Content, Units, write_workbook

RECORDS = Path(__file__).parents[1] / "samples" / "records"

UNVERIFIED = Settings(verify="none")
"""By the formulas alone: what a test takes that is not about the verification, which needs a second a floor."""

FLOORS = [{"floor": "1", "pfa_x": 0.3, "pfv_x": 30.0, "pfa_y": 0.2, "pfv_y": 45.0}, {"floor": "2", "pfa_x": 0.5}]
ITEMS = [
    {"item": "A1", "floor": "1", "room": "Hall", "description": "Bookcase", "breadth": 30, "width": 80, "height": 200},
    {"item": "A2", "floor": "1", "breadth": 60, "width": 60, "height": 200, "axis": "Y", "importance": "life safety"},
    {"item": "A3", "floor": "2", "breadth": 40, "width": 90, "height": 180, "quantity": 3, "anchored": "no"},
    {"item": "A4", "floor": "2", "breadth": 45, "width": 90, "height": 90, "anchored": "yes"},
    {"item": "A5", "floor": "2", "type": "Bookcase 5 shelves", "x": 2.0, "y": 3.0, "angle_deg": 90},
]


def address(field: str, row: int, sheet: str = "Items") -> str:
    """Return the cell of such a workbook that holds a field, ``H2``; row 2 is that of the first item."""
    return f"{LETTERS[sheet, field]}{row}"


def write(
    path: Path,
    items: list[dict[str, Any]] | None = None,
    floors: list[dict[str, Any]] | None = None,
    units: Units = "si",
    spare: int | None = 3,
    **building: Any,
) -> Path:
    """Write a workbook with these rows; a small one where none are given. Few rows beyond them have formulas."""
    rows = {"Building": [building], "Floors": floors or FLOORS, "Items": ITEMS if items is None else items}
    write_workbook(path, Content(rows=rows), units, spare=spare)
    return path


def assessed(path: Path, *args: Any, settings: Settings = UNVERIFIED, **named: Any) -> Results:
    """Write such a workbook and assess it, by the formulas alone where no settings are given."""
    return assess.run(assess.read_inventory(write(path, *args, **named)), settings)
