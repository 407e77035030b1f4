"""A small inventory to learn from: two floors, every sheet in use, no files next to it.

All numbers are made up. They stand here in the SI headers' units and are converted where the headers are imperial.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from assess.i18n import gettext
from assess.units import QUANTITIES
from assess.workbook.catalogue import read_catalogue, read_table
from assess.workbook.schema import BUILDING, CATALOGUE, FLOORS, ITEMS, SHEETS, Sheet
from assess.workbook.template import Content, Units

SCENARIO = "Example values, not a real building"
_DECIMALS = {"in": 1, "ft": 2, "in/s": 1}
"""Decimals that a converted value keeps, by unit."""
_ROWS: Mapping[str, tuple[dict[str, Any], ...]] = {
    "Building": (
        {"building": "Example office", "use": "Office", "storeys": 2, "height": 7.5, "period": 0.4,
         "scenario": SCENARIO},
    ),
    "Floors": (
        {"floor": "1", "name": "First floor", "elevation": 0, "pfa_x": 0.22, "pfa_y": 0.18, "pfv_x": 20, "pfv_y": 17},
        # No PFV Y: it is estimated from T1.
        {"floor": "2", "name": "Second floor", "elevation": 3.8, "pfa_x": 0.36, "pfa_y": 0.3, "pfv_x": 34},
    ),
    "Items": (
        {"item": "1-1", "floor": "1", "room": "Hall", "description": "Display cabinet beside the way out",
         "type": "Display cabinet glass", "anchored": "no", "x": 9, "y": 2.765, "angle_deg": 90,
         "route": "Way out", "segment": "hall", "edge_distance": 0.3, "importance": "life safety"},
        {"item": "1-2", "floor": "1", "room": "Archive", "description": "Shelving with box files",
         "type": "Steel shelving", "anchored": "yes", "x": 2, "y": 7.78, "angle_deg": 90,
         "importance": "property", "notes": "Two brackets to the wall"},
        {"item": "1-3", "floor": "1", "room": "Archive", "description": "Shelving with box files",
         "type": "Steel shelving", "anchored": "no", "x": 2.9, "y": 7.78, "angle_deg": 90, "importance": "property"},
        {"item": "1-4", "floor": "1", "room": "Archive", "description": "File cabinet", "anchored": "no",
         "type": "Vertical file 5 drawers", "x": 4.5, "y": 7.6, "angle_deg": 0, "importance": "property"},
        {"item": "1-5", "floor": "1", "room": "Kitchen", "description": "Refrigerator", "axis": "Y",
         "type": "Refrigerator top freezer", "notes": "No position: its axis is typed in"},
        {"item": "1-6", "floor": "1", "room": "Kitchen", "description": "Cupboard with dishes", "type": "Cupboard",
         "anchored": "partly", "x": 10.2, "y": 7.77, "angle_deg": 90, "importance": "property"},
        {"item": "2-1", "floor": "2", "room": "Open office", "description": "Bookcase at the aisle",
         "type": "Bookcase tall", "anchored": "no", "x": 5, "y": 3, "angle_deg": 90,
         "route": "Way out", "segment": "aisle", "edge_distance": 0.26, "importance": "life safety"},
        {"item": "2-2", "floor": "2", "room": "Open office", "description": "Steel cabinet", "anchored": "no",
         "type": "Storage cabinet steel", "x": 8, "y": 7.74, "angle_deg": 90, "importance": "property"},
        {"item": "2-3", "floor": "2", "room": "Open office", "description": "Lateral file", "anchored": "unknown",
         "type": "Lateral file 5 drawers", "width": 91.4, "x": 9.2, "y": 7.73, "angle_deg": 90,
         "importance": "property"},
        {"item": "2-4", "floor": "2", "room": "Server closet", "description": "Server rack", "anchored": "yes",
         "type": "Server rack 42U", "x": 11.4, "y": 1, "angle_deg": 0, "importance": "function",
         "notes": "Bolted to the slab"},
        {"item": "2-5", "floor": "2", "room": "Meeting room", "description": "Cabinet made to measure",
         "breadth": 35, "width": 120, "height": 210, "centre_of_gravity": 55, "anchored": "no", "friction": 0.4,
         "x": 0.2, "y": 6.5, "angle_deg": 0, "importance": "property"},
        {"item": "2-6", "floor": "2", "room": "Open office", "description": "Desks", "type": "Desk", "quantity": 6,
         "anchored": "no", "importance": "property", "notes": "One row for six alike: no position, no axis"},
    ),
    "Places": (
        {"place": "Open office", "floor": "2", "x": 11, "y": 4, "kind": "room"},
        {"place": "Stair, upper end", "floor": "2", "x": 1, "y": 4, "kind": "stair"},
        {"place": "Stair, lower end", "floor": "1", "x": 1, "y": 4, "kind": "stair"},
        {"place": "Street door", "floor": "1", "x": 12, "y": 4, "kind": "exit"},
    ),
    "Routes": (
        {"route": "Way out", "segment": "aisle", "floor": "2", "start": "Open office", "end": "Stair, upper end",
         "clear_width": 1.2, "required_width": 0.9, "occupants": 8},
        {"route": "Way out", "segment": "flight", "start": "Stair, upper end", "end": "Stair, lower end",
         "clear_width": 1.2, "required_width": 0.9, "occupants": 8},  # between floors: on none
        {"route": "Way out", "segment": "hall", "floor": "1", "start": "Stair, lower end", "end": "Street door",
         "clear_width": 1.5, "required_width": 0.9, "occupants": 14},
    ),
}  # fmt: skip


def example_texts() -> Iterator[str]:
    """Yield every text of the example that is more than a number or the name of a type."""
    for name, rows in _ROWS.items():
        columns = {column.name: column for sheet in SHEETS if sheet.name == name for column in sheet.columns}
        for row in rows:
            for field, value in row.items():
                if isinstance(value, str) and not columns[field].choices and field != "type":
                    yield from (value,) if any(sign.isalpha() for sign in value) else ()


def example_content(units: Units = "si") -> Content:
    """Return the example in the language in use and the units of the headers, without results."""
    sheets = {sheet.name: sheet for sheet in SHEETS}
    return Content({name: [convert_row(sheets[name], row, units) for row in rows] for name, rows in _ROWS.items()})


def convert_row(sheet: Sheet, row: Mapping[str, Any], units: Units) -> dict[str, Any]:
    """Return a row in English and SI headers' units in the language in use and in the units of the headers."""
    converted = dict(row)
    for name, value in row.items():
        column = sheet.column(name)
        if isinstance(value, str) and not column.choices:  # choices are translated where they are written
            converted[name] = gettext(value)
        elif not isinstance(value, str) and units == "imperial" and column.imperial != column.unit:
            factors = QUANTITIES[column.quantity]
            converted[name] = round(value * factors[column.unit] / factors[column.imperial], _DECIMALS[column.imperial])
    return converted


ROOM = "Example room: delete these rows"
"""Name of the room of every example row."""
FLOOR = {"floor": "1", "name": "Ground floor", "elevation": 0}
SHAKING = {"pfa_x": 0.3, "pfa_y": 0.25, "pfv_x": 28, "pfv_y": 24}
"""Made-up shaking of the floor [g, cm/s], for an example that can be run at once."""


def room_content(use: str, units: Units = "si", *, is_shaken: bool = False) -> Content:
    """Return the types of a use and its example room, complete but for the shaking unless `is_shaken`."""
    building = {"use": use} | ({"scenario": SCENARIO} if is_shaken else {})
    floor = FLOOR | (SHAKING if is_shaken else {})
    items: list[dict[str, Any]] = []
    for line in read_table("rooms.csv"):
        if line["use"] == use:
            texts = {name: text for name, text in line.items() if text and name not in ("use", "quantity")}
            quantity = int(line["quantity"])
            items.append({**texts, "floor": "1", "room": ROOM} | ({"quantity": quantity} if quantity > 1 else {}))
    filled = ((BUILDING, [building]), (FLOORS, [floor]), (ITEMS, items))
    rows = {sheet.name: [convert_row(sheet, row, units) for row in rows] for sheet, rows in filled}
    return Content({**rows, CATALOGUE.name: read_catalogue(units, use)})


def room_texts() -> Iterator[str]:
    """Yield every text of the rooms that is translated, but for the names of types and choices."""
    yield from (ROOM, str(FLOOR["name"]))
    lines = read_table("rooms.csv")
    yield from dict.fromkeys(line[name] for line in lines for name in ("description", "notes") if line[name])
