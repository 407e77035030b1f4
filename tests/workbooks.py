"""Workbooks for tests, written as a user would fill them in."""

import io
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import xlsxwriter

import assess
from assess.i18n import gettext
from assess.results import Results
from assess.settings import Settings
from assess.workbook.catalogue import read_catalogue
from assess.workbook.lists import LETTERS, PLACES
from assess.workbook.open import Place
from assess.workbook.patch import Value
from assess.workbook.plain_rows import split_address
from assess.workbook.read import open_workbook
from assess.workbook.schema import CATALOGUE, SHEETS
from assess.workbook.template import Units

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


def write_sheets(path: Path, rows: Mapping[str, Sequence[Mapping[str, Any]]], units: Units = "si") -> Path:
    """Write the sheets of a workbook with these rows, each where the template has it, and nothing else.

    The template, with its help, lists and formulas, takes five times as long (`assess.workbook.template`).
    """
    with xlsxwriter.Workbook(path, {"in_memory": True}) as book:
        for sheet in SHEETS:
            page = book.add_worksheet(gettext(sheet.name))
            given = rows.get(sheet.name) or (read_catalogue(units) if sheet is CATALOGUE else [])
            for column in sheet.columns:
                at, is_form = PLACES[sheet.name, column.name], sheet.layout == "form"
                page.write_string(
                    *((at, 0) if is_form else (0, at)), replace(column, label=gettext(column.label)).header(units)
                )
                for number, row in enumerate(given, 1):
                    value = row.get(column.name)
                    if value is not None:
                        value = gettext(value) if column.choices and isinstance(value, str) else value
                        (page.write_string if isinstance(value, str) else page.write_number)(
                            *((at, 1) if is_form else (number, at)), value
                        )
    return path


def write(
    path: Path,
    items: list[dict[str, Any]] | None = None,
    floors: list[dict[str, Any]] | None = None,
    units: Units = "si",
    **building: Any,
) -> Path:
    """Write a workbook with these rows; a small one where none are given."""
    rows = {"Building": [building], "Floors": floors or FLOORS, "Items": ITEMS if items is None else items}
    return write_sheets(path, rows, units)


def assessed(path: Path, *args: Any, settings: Settings = UNVERIFIED, **named: Any) -> Results:
    """Write such a workbook and assess it, by the formulas alone where no settings are given."""
    return assess.run(assess.read_inventory(write(path, *args, **named)), settings)


def edited(data: bytes, values: Mapping[str, Mapping[str, Value]], name: str = "book.xlsx") -> bytes:
    """Return a workbook with cells set, by its own names of sheets and the addresses of cells."""
    workbook = open_workbook(data, name)
    return workbook.set(workbook.by_english({sheet: places(one) for sheet, one in values.items()})).to_bytes()


def places(values: Mapping[str, Value]) -> dict[Place, Value]:
    """Return values by the places of their cells."""
    found = {split_address(address): value for address, value in values.items()}
    return {(place[1], place[0] - 1): value for place, value in found.items() if place is not None}


def parts_of(workbook: Path | bytes) -> dict[str, bytes]:
    """Return the parts of a workbook's zip by their names."""
    with zipfile.ZipFile(workbook if isinstance(workbook, Path) else io.BytesIO(workbook)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}
