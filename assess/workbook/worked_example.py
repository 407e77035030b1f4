"""The worked example, which comes along as a workbook, in the language in use: titles, choices, types and texts."""

import re
from collections.abc import Iterator, Mapping
from typing import Any

from assess import resources
from assess.i18n import gettext
from assess.workbook.catalogue import read_catalogue
from assess.workbook.parse import Row, Table
from assess.workbook.read import open_workbook, parse_workbook
from assess.workbook.schema import CATALOGUE, SHEETS, Sheet
from assess.workbook.store import Worksheet
from assess.workbook.template import Content

_KEPT = frozenset({"item", "floor", "building", "address", "revision"})
"""Fields whose texts are the same in every language."""
_WHOLE = frozenset({"notes", "scenario"})
"""Fields whose texts are sentences."""
_PARTS = re.compile(r"((?:^|; )(?:(?:42|34|25|G) )?)")
"""What stands before each part of a text that is translated: the floor of a place, the sign between two rooms."""


def worked_content() -> Content:
    """Return the example in the language in use and the units of an empty workbook, without results."""
    rows: dict[str, list[dict[str, Any]]] = {CATALOGUE.name: read_catalogue()}
    for sheet, row in _read_rows():
        said = {name: "".join(map(gettext, parts)) for name, parts in _split(sheet, row)}
        rows.setdefault(sheet.name, []).append({**row, **said})
    return Content(rows)


def worked_texts() -> Iterator[str]:
    """Yield every text of the example that is translated."""
    for sheet, row in _read_rows():
        for name, parts in _split(sheet, row):
            yield from (part for part in parts if name != "type" and not _PARTS.fullmatch(part))


def _split(sheet: Sheet, row: Mapping[str, Any]) -> Iterator[tuple[str, list[str]]]:
    """Yield the fields of a row that are translated, each in parts."""
    for column in sheet.columns:
        name = column.name
        if name in row and column.kind == "text" and name not in _KEPT:
            yield name, [row[name]] if name in _WHOLE else [part for part in _PARTS.split(row[name]) if part]


def _read_rows() -> Iterator[tuple[Sheet, Mapping[str, Any]]]:
    """Yield the rows of each sheet but the catalogue, by field, as they are typed."""
    path = resources.example()
    workbook = open_workbook(path.read_bytes(), path.name)
    tables, _ = parse_workbook(workbook)
    for sheet in SHEETS:
        if sheet != CATALOGUE and sheet.name in workbook.sheets:
            for row in tables[sheet.name].rows:
                yield sheet, _read_row(tables[sheet.name], row, workbook.sheets[sheet.name])


def _read_row(table: Table, row: Row, cells: Worksheet) -> dict[str, Any]:
    is_form = table.sheet.layout == "form"
    places = {name: (at, 1) if is_form else (row.number, at) for name, at in table.places.items()}
    return {name: value for name, place in places.items() if (value := cells.value(place)) is not None}
