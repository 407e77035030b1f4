"""results.json and items.csv: the same numbers for other programs.

Both are written item by item, so that 20,000 items take no more memory than one. Units stand in the names.
"""

import csv
import json
import platform
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any, TextIO

from assess.demand import Demand
from assess.errors import Problem
from assess.inventory.columns import BUILDING
from assess.results import Assessment, CaseResult, ItemResult, MethodResult
from assess.risk import RiskClass
from assess.units import ACCELERATION, LENGTH, VELOCITY, to_edge
from assess.version import __version__

SCHEMA_VERSION = "1.0"
SCHEMA = Path(__file__).with_name("results.schema.json")
"""JSON Schema of results.json."""


def write_json(assessment: Assessment, path: Path) -> None:
    """Write results.json; its shape is that of `SCHEMA`."""
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.write("{\n")
        for name, value in describe_run(assessment).items():
            file.write(f" {json.dumps(name)}: {_dump(value)},\n")
        _write_list(file, "items", (item_record(one) for one in assessment))
        file.write(",\n")
        _write_list(file, "routes", (route_record(one) for one in assessment.inventory.routes))
        file.write(",\n")
        _write_list(file, "problems", (problem_record(one) for one in assessment.problems))
        file.write("\n}\n")


def _write_list(file: TextIO, name: str, records: Iterator[Mapping[str, Any]]) -> None:
    file.write(f" {json.dumps(name)}: [")
    for at, record in enumerate(records):
        file.write((",\n  " if at else "\n  ") + _dump(record))
    file.write("\n ]")


_dump = json.JSONEncoder(ensure_ascii=False, allow_nan=False, separators=(", ", ": ")).encode


def describe_run(assessment: Assessment) -> dict[str, Any]:
    """Return what stands before the items: the program and its settings, the building, the floors."""
    inventory = assessment.inventory
    return {
        "schema": SCHEMA_VERSION,
        "assess": {
            "version": __version__,
            "seed": None,
            "settings": asdict(assessment.settings) | {"scenario": assessment.scenario},
            "platform": versions(),
            "inputs": {"workbook": inventory.source.name, "sha256": inventory.sha256, "records": dict(inventory.files)},
        },
        "building": building_record(assessment),
        "floors": [floor_record(assessment, floor.floor) for floor in inventory.floors],
    }


@cache
def versions() -> Mapping[str, str]:
    """Return what the numbers were computed with."""
    import numpy as np

    return {
        "python": platform.python_version(),
        "numpy": np.__version__,
        "system": platform.system(),
        "machine": platform.machine(),
    }


def building_record(assessment: Assessment) -> dict[str, Any]:
    """Return the lines of the sheet Building, quantities in the units of the empty workbook."""
    record: dict[str, Any] = {}
    for column in BUILDING.columns:
        value = getattr(assessment.inventory.building, column.name)
        if column.quantity and column.quantity != "angle":
            value = None if value is None else to_edge(value, column.factor)
            record[f"{column.name}_{column.unit}"] = value
        else:
            record[column.name] = value.name if isinstance(value, Path) else value
    return record


def floor_record(assessment: Assessment, name: str) -> dict[str, Any]:
    """Return one floor with every motion that serves it."""
    floor = next(floor for floor in assessment.inventory.floors if floor.floor == name)
    return {
        "floor": floor.floor,
        "name": floor.name,
        "elevation_m": floor.elevation,
        "demands": [demand_record(demand) for axis in ("X", "Y") for demand in assessment.demands[name, axis]],
    }


def demand_record(demand: Demand) -> dict[str, Any]:
    """Return the motion of a floor along an axis; what belongs to another source than its own is None."""
    record = demand.record
    return {
        "axis": demand.axis,
        "source": demand.source,
        "pfa_g": edge(demand.pfa, "g"),
        "pfv_cm_s": edge(demand.pfv, "cm/s"),
        "flags": list(demand.flags),
        "between": list(demand.between),
        "profile": demand.profile.key if demand.profile else None,
        "profile_verified": demand.profile.verified if demand.profile else None,
        "clause": demand.clause or None,
        "height_ratio": demand.height_ratio,
        "amplification": demand.amplification,
        "record": demand.name or None,
        "pfa_file_g": edge(record.file_pfa, "g") if record else None,
        "format": record.format if record else None,
        "station": record.station if record else None,
        "location": record.location if record else None,
        "channel": record.channel if record else None,
        "event": record.event if record else None,
        "azimuth_deg": record.azimuth_deg if record else None,
        "corrected": record.corrected if record else None,
        "time_step_s": record.time_step if record else None,
        "samples": len(record.acceleration) if record else None,
        "notes": list(record.notes) if record else [],
    }


def item_record(one: ItemResult) -> dict[str, Any]:
    """Return one item as it stands in results.json."""
    item, case = one.item, one.governing
    return {
        **_piece_record(one),
        "pfa_g": edge(case.demand.pfa, "g"),
        "pfv_cm_s": edge(case.demand.pfv, "cm/s"),
        "pfa_source": case.demand.label,
        "methods": {key: method_record(method) for key, method in case.methods.items()},
        "verification": None,
        "adopted": adopted_record(one),
        "axes": [axis_record(other) for other in one.cases],
        "anchored": item.anchored,
        "route": item.route or None,
        "segment": item.segment or None,
        "edge_distance_m": item.edge_distance,
        "notes": item.notes,
        "assumed": list(item.assumed),
        "source": {"sheet": "Items", "row": item.row},
    }


def _piece_record(one: ItemResult) -> dict[str, Any]:
    item = one.item
    return {
        "item": item.item,
        "floor": item.floor,
        "room": item.room,
        "description": item.description,
        "type": item.type,
        "quantity": item.quantity,
        "breadth_cm": edge(item.breadth, "cm"),
        "width_cm": edge(item.width, "cm"),
        "height_cm": edge(item.height, "cm"),
        "breadth_to_height": item.breadth / item.height,
        "axis": one.governing.demand.axis,
        "axis_given": item.axis,
        "angle_deg": item.angle_deg,
        "x_m": item.x,
        "y_m": item.y,
        "friction": item.friction,
        "importance": item.importance or None,
    }


def method_record(method: MethodResult) -> dict[str, Any]:
    """Return the value of one method with what stands beside it."""
    return {"value": method.value, **method.detail, "flags": list(method.flags)}


def adopted_record(one: ItemResult) -> dict[str, Any]:
    """Return the adopted risk."""
    adopted = one.adopted
    return {
        "method": adopted.method,
        "probability": adopted.probability,
        "low": adopted.low,
        "high": adopted.high,
        "class": adopted.risk.word,
        "class_upper": adopted.upper.word,
        "lowered_from": _word(adopted.lowered_from),
        "flags": list(adopted.flags),
    }


def axis_record(case: CaseResult) -> dict[str, Any]:
    """Return one motion that the item was held against, with the value of every method."""
    return {
        "axis": case.demand.axis,
        "source": case.demand.label,
        "pfa_g": edge(case.demand.pfa, "g"),
        "pfv_cm_s": edge(case.demand.pfv, "cm/s"),
        "methods": {key: method.value for key, method in case.methods.items()},
    }


def route_record(segment: Any) -> dict[str, Any]:
    """Return one segment of a route as the workbook has it."""
    return {
        "route": segment.route,
        "segment": segment.segment,
        "floor": segment.floor or None,
        "from": segment.start or None,
        "to": segment.end or None,
        "clear_width_m": segment.clear_width,
        "required_width_m": segment.required_width,
        "occupants": segment.occupants,
        "notes": segment.notes,
    }


def problem_record(problem: Problem) -> dict[str, str]:
    """Return one warning or note."""
    return asdict(problem)


def edge(value: float | None, unit: str) -> float | None:
    """Convert an SI value to a unit of the edge; None for what is unknown."""
    if value is None or value != value:
        return None
    return to_edge(value, _FACTORS[unit])


_FACTORS = {**LENGTH, **ACCELERATION, **VELOCITY}


def _word(risk: RiskClass | None) -> str | None:
    return None if risk is None else risk.word


def write_csv(assessment: Assessment, path: Path) -> None:
    """Write items.csv: one row an item, UTF-8 with a byte order mark, by which Excel knows it.

    A text that a spreadsheet would take for a formula is written behind an apostrophe; numbers stay numbers.
    """
    with path.open("w", encoding="utf-8-sig", newline="") as file:
        writer = csv.writer(file)
        heads: list[str] = []
        for one in assessment:
            record = item_record(one)
            if not heads:
                heads = list(flatten(record))
                writer.writerow(heads)
            writer.writerow([_safe(value) for value in _flat_values(record)])
        if not heads:
            writer.writerow(["item"])  # a table without rows still has a heading


def flatten(record: Mapping[str, Any]) -> dict[str, Any]:
    """Return an item's record as one flat row: nested names joined by ``_``."""
    return dict(zip(_flat_names(record), _flat_values(record), strict=True))


def _flat_names(record: Mapping[str, Any]) -> Iterator[str]:
    for name, value in record.items():
        if name == "methods":
            for key, method in value.items():
                yield from (key if part == "value" else f"{key}_{part}" for part in method)
        elif isinstance(value, Mapping):
            yield from (f"{name}_{part}" for part in value)
        else:
            yield name


def _flat_values(record: Mapping[str, Any]) -> Iterator[Any]:
    for name, value in record.items():
        if name == "methods":
            for method in value.values():
                yield from method.values()
        elif name == "axes":
            yield [f"{axis['axis']}: {axis['source']} {axis['pfa_g']} g" for axis in value]
        elif isinstance(value, dict):
            yield from value.values()
        else:
            yield value


def _safe(value: object) -> object:
    if value is None or isinstance(value, (float, int)):
        return value
    if isinstance(value, list):
        value = "; ".join(map(str, value))
    if isinstance(value, str) and value[:1] in ("=", "+", "-", "@", "\t", "\r", "\n"):
        return "'" + value
    return value
