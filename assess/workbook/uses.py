"""What a new workbook starts from in a building of one use: its types of furniture, and one room as an example.

The rooms stand in ``rooms.csv``: the pieces of one room each, made up, of types of that use.
"""

from collections.abc import Iterator
from typing import Any

from assess.workbook.catalogue import read_catalogue, read_table
from assess.workbook.example import SCENARIO, convert_row
from assess.workbook.lists import Units
from assess.workbook.schema import BUILDING, CATALOGUE, FLOORS, ITEMS
from assess.workbook.template import Content

ROOM = "Example room: delete these rows"
"""Name of the room of every example row."""

FLOOR = {"floor": "1", "name": "Ground floor", "elevation": 0}

SHAKING = {"pfa_x": 0.3, "pfa_y": 0.25, "pfv_x": 28, "pfv_y": 24}
"""Made-up shaking of the floor [g, cm/s], for an example that can be run at once."""


def room_content(use: str, units: Units = "si", *, is_shaken: bool = False) -> Content:
    """Return the types of a use and its example room, in the language in use.

    Parameters
    ----------
    use : str
        One of `assess.workbook.schema.USES`.
    units : "si" or "imperial"
        Of the headers.
    is_shaken : bool
        Whether the floor gets a made-up shaking, so that the workbook can be run; otherwise shaking is all it lacks.
    """
    building = {"use": use} | ({"scenario": SCENARIO} if is_shaken else {})
    floor = FLOOR | (SHAKING if is_shaken else {})
    items = [_read_item(line) for line in read_table("rooms.csv") if line["use"] == use]
    filled = ((BUILDING, [building]), (FLOORS, [floor]), (ITEMS, items))
    rows = {sheet.name: [convert_row(sheet, row, units) for row in rows] for sheet, rows in filled}
    return Content({**rows, CATALOGUE.name: read_catalogue(units, use)})


def room_texts() -> Iterator[str]:
    """Yield every text of the rooms that is translated, but for the names of types and choices."""
    yield from (ROOM, str(FLOOR["name"]))
    lines = read_table("rooms.csv")
    yield from dict.fromkeys(line[name] for line in lines for name in ("description", "notes") if line[name])


def _read_item(line: dict[str, str]) -> dict[str, Any]:
    row = {name: text for name, text in line.items() if text and name not in ("use", "quantity")}
    quantity = int(line["quantity"])
    return {**row, "floor": "1", "room": ROOM} | ({"quantity": quantity} if quantity > 1 else {})
