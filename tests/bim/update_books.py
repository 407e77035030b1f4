"""A small building model as it is imported, and workbooks of it as people leave them."""

import io
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import openpyxl

from assess.bim.import_workbook import ImportedBuilding, list_rows
from assess.bim.update_workbook import Updated, describe, update_workbook
from assess.i18n import load_catalogue, speaking
from assess.model import Inventory
from assess.pipeline.live_values import store_live
from assess.units import QUANTITIES
from assess.workbook.parse import Row, Table
from assess.workbook.patch import Value
from assess.workbook.read import read_inventory, read_tables
from assess.workbook.schema import SHEETS, Column
from assess.workbook.template import Content, write_workbook
from tests.workbooks import address, edited

Rows = list[dict[str, Any]]

SHAKEN = {"ground_pga": 0.3}
FLOORS: Rows = [
    {"floor": "Level 1", "elevation": 0.0, "plan": "house-Level-1.svg", "plan_left": -0.5, "plan_bottom": -0.5,
     "plan_width": 21.0},
    {"floor": "Level 2", "elevation": 3.1, "plan": "house-Level-2.svg", "plan_left": -0.5, "plan_bottom": -0.5,
     "plan_width": 21.0},
]  # fmt: skip
TYPES: Rows = [
    {"type": "Wardrobe 80", "breadth": 54.5, "width": 80.0, "height": 200.0, "source": "shapes in house.ifc"},
    {"type": "Writing desk", "breadth": 60.0, "width": 120.0, "height": 75.0, "source": "shapes in house.ifc"},
]
PLACES: Rows = [
    {"place": "A101 Hall", "floor": "Level 1", "x": 3.0, "y": 2.0, "kind": "room", "outline": "0 0; 6.5 0; 6.5 4; 0 4"},
    {"place": "A102 Office", "floor": "Level 1", "x": 9.0, "y": 2.0, "kind": "room"},
    {"place": "Exit A101", "floor": "Level 1", "x": 0.0, "y": 2.0, "kind": "exit"},
    {"place": "B201 Office", "floor": "Level 2", "x": 3.0, "y": 2.0, "kind": "room"},
]


def piece(number: int, floor: str, room: str, kind: int = 0, **more: Any) -> dict[str, Any]:
    sizes = {name: TYPES[kind][name] for name in ("breadth", "width", "height")}
    return {
        "item": f"{room[:4]}-{number:02}", "floor": floor, "room": room, "description": TYPES[kind]["type"],
        "type": TYPES[kind]["type"], **sizes, "x": float(number), "y": 1.5, "angle_deg": 90.0,
        "source_id": f"2O2Fr$t4X7Zf8NOew3FN{number:02}", "sizes_from": "model", **more,
    }  # fmt: skip


ITEMS: Rows = [
    piece(1, "Level 1", "A101 Hall"), piece(2, "Level 1", "A101 Hall", 1), piece(3, "Level 1", "A102 Office"),
    piece(4, "Level 1", "A102 Office", 1), piece(5, "Level 2", "B201 Office"), piece(6, "Level 2", "B201 Office", 1),
]  # fmt: skip
PLANS = {str(row["plan"]): b"<svg/>" for row in FLOORS}
IDS = [one["source_id"] for one in ITEMS]


def building(**more: Any) -> ImportedBuilding:
    rows = {"floors": FLOORS, "items": ITEMS, "places": PLACES, "types": TYPES}
    known = {"building": "House", "latitude": 45.5, "longitude": 9.2, "azimuth_deg": 30.0}
    return ImportedBuilding(**{"source": "house.ifc", "building": known, **rows, "files": PLANS, **more})


def changed(**changes: Mapping[str, Any]) -> ImportedBuilding:
    """The model with fields of some of its pieces changed, by their number: ``changed(p3={"breadth": 60.0})``."""
    items = [{**row, **changes.get(f"p{number}", {})} for number, row in enumerate(ITEMS, 1)]
    return building(items=items)


def typed(data: bytes, sheet: str = "Items", row: int = 2, **fields: Value) -> bytes:
    """Type values into a row of a workbook as the import wrote it; row 2 is that of the first piece."""
    return edited(data, {sheet: {address(name, row, sheet): value for name, value in fields.items()}})


def line(data: bytes, **fields: Value) -> bytes:
    values = {}
    for name, value in fields.items():
        at = next(at for at, one in enumerate(SHEETS[0].columns, 1) if one.name == name)
        values[f"B{at}"] = value
    return edited(data, {"Building": values})


def resaved(data: bytes, change: Any = None) -> bytes:
    """Open a workbook in another program, change it there, and save it."""
    book = openpyxl.load_workbook(io.BytesIO(data))
    if change:
        change(book)
    packed = io.BytesIO()
    book.save(packed)
    return packed.getvalue()


def in_units(path: Path, imported: ImportedBuilding, language: str = "en") -> bytes:
    """The workbook of an import with imperial headers, in a language."""
    rows = {
        sheet.name: [{name: _to_imperial(sheet.column(name), value) for name, value in row.items()} for row in found]
        for sheet in SHEETS
        if (found := list_rows(imported).get(sheet.name))
    }
    with speaking(load_catalogue(language)):
        write_workbook(path, Content(rows), "imperial")
    return path.read_bytes()


def _to_imperial(column: Column, value: Any) -> Any:
    if column.kind == "outline":
        corners = (corner.split() for corner in value.split(";"))
        return "; ".join(f"{float(x) / 0.3048:.4f} {float(y) / 0.3048:.4f}" for x, y in corners)
    if isinstance(value, str) or not column.quantity:
        return value
    return round(value * column.factor / QUANTITIES[column.quantity][column.imperial], 4)


def update(data: bytes, imported: ImportedBuilding | None = None) -> Updated:
    """Update a workbook twice: the second time, nothing is left to change."""
    model = building() if imported is None else imported
    found = update_workbook(data, model, "house.xlsx")
    again = update_workbook(found.data, model, "house.xlsx")
    assert again.data == found.data
    assert [one for one in again.changes if one.kind in ("changed", "added")] == []
    return found


def first_book(**more: Any) -> bytes:
    return write_first(building(**more))


def write_first(imported: ImportedBuilding) -> bytes:
    """The workbook of an import as `build_workbook` writes it, with fewer prepared rows."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "house.xlsx")
        write_workbook(path, store_live(Content(list_rows(imported)), "si"), spare=12)
        return path.read_bytes()


def table(data: bytes, sheet: str = "Items") -> Table:
    return read_tables(data, "house.xlsx")[0][sheet]


def row(data: bytes, number: int = 1, sheet: str = "Items") -> Row:
    """The first, second, ... row of a sheet, as it is read: in SI units."""
    return table(data, sheet).rows[number - 1]


def inventory(data: bytes) -> Inventory:
    """The inventory of a workbook, with shaking of the ground; its plans are not beside it."""
    return read_inventory(data, building=SHAKEN, strict=False)


def faults(data: bytes) -> list[str]:
    """The errors of a workbook, but for the plans that are not beside it."""
    return [str(one) for one in inventory(data).errors if "picture" not in one.message]


def texts(found: Updated) -> list[str]:
    return [str(describe(one)) for one in found.changes]


def kinds(found: Updated) -> list[str]:
    return [one.kind for one in found.changes]


def without(imported: ImportedBuilding, *numbers: int) -> ImportedBuilding:
    """The model without some of its pieces, by number."""
    gone = {IDS[number - 1] for number in numbers}
    kept: Sequence[Any] = [one for one in imported.items if one["source_id"] not in gone]
    return replace(imported, items=kept)
