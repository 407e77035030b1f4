"""Results of runs whose pieces stand in the building models of samples/models, and what an export makes of them."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import assess
from assess.bim.export_files import Export, build_export
from assess.bim.export_results import read_export
from assess.bim.import_workbook import ImportedBuilding, list_rows
from assess.bim.read_source import read_source
from assess.progress import SILENT
from assess.report.data import write_json
from assess.settings import Settings
from assess.workbook.template import Content, write_workbook
from tests.bim.ifc_files import ModelWriter

MODELS = Path(__file__).parents[2] / "samples" / "models"
DUPLEX, OFFICE = MODELS / "duplex.ifc", MODELS / "LargeBuilding.ifc"
SIMULATED = Settings(verify="all", runs=20)
"""Twenty draws tell 0 of 20 from 19 of 20."""
FORMULA = Settings(verify="none")

CUPBOARD_1, CUPBOARD_2 = "0wkEuT1wr1kOyafLY4vyu$", "0wkEuT1wr1kOyafLY4vy_8"
HELD, SOFA = "0wkEuT1wr1kOyafLY4vy3H", "2OBrcmyk58NupXoVOHUshs"
DOOR_B202 = "2OBrcmyk58NupXoVOHUuXp"
"""The door of room B202 to the hall, at 1.85, -11.55 of Level 2."""
DESKS = {"Desk 1": ("2cXV28XOjE6f6irgi0COSH", -13.35, 8.96), "Desk 2": ("2cXV28XOjE6f6irgi0COUq", -10.98, 8.96)}


def piece(item: str, floor: str, key: str | None, x: float, y: float, **more: Any) -> dict[str, Any]:
    row = {"item": item, "floor": floor, "type": "Cupboard", "breadth": 54.5, "width": 80.0, "height": 200.0}
    return {**row, "x": x, "y": y, "angle_deg": 90.0, "source_id": key, **more}


CUPBOARDS = [
    piece("Armadio è 1", "2", CUPBOARD_1, 2.91, -11.41, room="B202", description="Armadio d'angolo \\ 2 m"),
    piece("Armadio è 2", "2", CUPBOARD_2, 3.71, -11.41, room="B202", importance="life safety"),
    piece("Held", "2", HELD, 5.08, -11.41, room="A203", anchored="yes"),
    piece("Sofa", "1", SOFA, 7.98, -2.30, room="B102", breadth=66.0, width=183.0, height=81.0, angle_deg=0.0),
]
"""Of Duplex: two that surely fall, one that is anchored, and one that is unconfirmed."""
FLOORS = [
    {"floor": "1", "pfa_x": 0.8, "pfa_y": 0.8},
    {"floor": "2", "elevation": 0.0, "pfa_x": 1.2, "pfa_y": 1.2, "pfv_x": 400.0, "pfv_y": 400.0},
]
"""Of floor 1 nothing tells how high it lies, nor how high the building is: its class stands unconfirmed."""
BUILDING = {"building": "Palazzo Duè", "revision": "B", "report_date": "2026-05-04", "prepared_by": "Ing. Rossi",
            "scenario": "Forte – 475 anni 🏢", "motion_uncertainty": 0.4}  # fmt: skip
PLACES = [
    {"place": "B202", "floor": "2", "x": 3.3, "y": -13.5, "kind": "room"},
    {"place": "door", "floor": "2", "x": 1.85, "y": -11.55, "kind": "door"},
    {"place": "out", "floor": "2", "x": 1.85, "y": -10.5, "kind": "exit"},
]
ROUTES = [
    {"route": "Scala", "segment": "a", "floor": "2", "start": "B202", "end": "door"},
    {"route": "Scala", "segment": "b", "floor": "2", "start": "door", "end": "out"},
]
"""A way out of B202 that both cupboards there block when they fall."""


def write_results(
    folder: Path,
    items: Sequence[dict[str, Any]] = CUPBOARDS,
    floors: Sequence[dict[str, Any]] = FLOORS,
    settings: Settings = FORMULA,
    *,
    building: dict[str, Any] = BUILDING,
    places: Sequence[dict[str, Any]] = (),
    routes: Sequence[dict[str, Any]] = (),
) -> Path:
    """Write the workbook of an import, assess it, and return its results.json."""
    folder.mkdir(parents=True, exist_ok=True)
    imported = ImportedBuilding(
        source="model.ifc", building=building, floors=floors, items=items, places=places, routes=routes
    )
    book = folder / "building.xlsx"
    write_workbook(book, Content(list_rows(imported)), spare=1)
    out = folder / "results.json"
    write_json(assess.run(assess.read_inventory(book), settings), out)
    return out


def write_flat(path: Path) -> Path:
    """Write a small model with the pieces of `CUPBOARDS` where they stand in Duplex, and the door of their room."""
    writer = ModelWriter("IFC2X3")
    storeys = {name: writer.storey(name, level) for name, level in (("1", 0.0), ("2", 3.1))}
    for row in CUPBOARDS:
        one = writer.piece(
            row.get("description", "Cupboard"),
            (0, 0, 0, row["breadth"] / 100, row["width"] / 100, row["height"] / 100),
            within=storeys[row["floor"]], at=(row["x"], row["y"], 0.0 if row["floor"] == "1" else 3.1), x=(0, 1, 0),
        )  # fmt: skip
        one.GlobalId = row["source_id"]
    door = writer.element("IfcDoor", "Door", (0, 0, 0, 0.9, 0.1, 2.1), within=storeys["2"], at=(1.85, -11.55, 3.1))
    door.GlobalId = DOOR_B202
    return writer.write(path)


def import_results(folder: Path, model: Path) -> Path:
    """Import a model with drafted routes, assess it by formula at 0.5 g, and return its results.json."""
    imported = read_source(model, model.name, routes="draft")
    for name, data in imported.files.items():
        (folder / name).write_bytes(data)
    book, out = folder / "building.xlsx", folder / "results.json"
    write_workbook(book, Content(list_rows(imported)), spare=1)
    inventory = assess.read_inventory(book, building={"ground_pga": 0.5, "height": 6.0})
    write_json(assess.run(inventory, FORMULA, class_by="proposed OR"), out)
    return out


def export(results: Path, model: Path, **wanted: bool) -> Export:
    wanted = {"with_properties": True, "with_topics": True, **wanted}
    return build_export(read_export(results), model, SILENT, **wanted)


def read_rows(results: Path) -> dict[str, dict[str, Any]]:
    """Return the rows of the items of a results.json by their names."""
    return {one["item"]: one for one in json.loads(results.read_text(encoding="utf-8"))["items"]}


def write_adopted(results: Path, folder: Path, *adopted: dict[str, Any]) -> Path:
    """Write results anew with other values of what was adopted for each piece; one set of them serves all."""
    record = json.loads(results.read_text(encoding="utf-8"))
    every = adopted if len(adopted) > 1 else adopted * len(record["items"])
    for row, values in zip(record["items"], every, strict=True):
        row["adopted"] |= values
    changed = folder / "changed.json"
    changed.write_text(json.dumps(record), encoding="utf-8")
    return changed
