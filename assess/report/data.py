"""results.json: the numbers for other programs; `table.py` writes the same as items.csv.

It is written item by item, so that 20,000 items take no more memory than one. Units stand in the names.
"""

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

from assess.cases import CaseResult, MethodResult, VerificationResult
from assess.demand import Demand
from assess.errors import Problem
from assess.inventory.columns import BUILDING
from assess.report.provenance import versions
from assess.report.routes_data import routes_record
from assess.results import Assessment, ItemResult
from assess.risk import RiskClass
from assess.units import ACCELERATION, LENGTH, VELOCITY, to_edge
from assess.version import __version__

if TYPE_CHECKING:
    from assess.motion.fit import Fit

SCHEMA_VERSION = "2.0"
SCHEMA = Path(__file__).with_name("results.schema.json")
"""JSON Schema of results.json."""


def write_json(assessment: Assessment, path: Path) -> None:
    """Write results.json; its shape is that of `SCHEMA`."""
    sheet = assessment.inventory.sheets.get("Items", "Items")
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.write("{\n")
        for name, value in describe_run(assessment).items():
            file.write(f" {json.dumps(name)}: {_dump(value)},\n")
        _write_list(file, "items", (item_record(one, sheet) for one in assessment))
        file.write(",\n")
        _write_routes(file, routes_record(assessment))
        file.write(",\n")
        _write_list(file, "problems", (problem_record(one) for one in assessment.problems))
        file.write("\n}\n")


def _write_routes(file: TextIO, record: Mapping[str, Any]) -> None:
    """Write the routes: a line a segment, a route, a room and a floor."""
    file.write(' "routes": {\n')
    for at, (name, value) in enumerate(record.items()):
        file.write(",\n" if at else "")
        if isinstance(value, list):
            _write_list(file, name, iter(value), " ")
        else:
            file.write(f"  {json.dumps(name)}: {_dump(value)}")
    file.write("\n }")


def _write_list(file: TextIO, name: str, records: Iterator[Mapping[str, Any]], indent: str = "") -> None:
    file.write(f"{indent} {json.dumps(name)}: [")
    for at, record in enumerate(records):
        file.write(f"{',' if at else ''}\n{indent}  {_dump(record)}")
    file.write(f"\n{indent} ]")


_dump = json.JSONEncoder(ensure_ascii=False, allow_nan=False, separators=(", ", ": ")).encode


def describe_run(assessment: Assessment) -> dict[str, Any]:
    """Return what stands before the items: the program and its settings, the building, the floors."""
    inventory = assessment.inventory
    return {
        "schema": SCHEMA_VERSION,
        "assess": {
            "version": __version__,
            "seed": assessment.settings.seed,
            "settings": asdict(assessment.settings) | {"scenario": assessment.scenario},
            "platform": versions(has_rocked=bool(assessment.joints), has_routes=assessment.routes is not None),
            "inputs": {
                "workbook": inventory.source.name,
                "sha256": inventory.sha256,
                "records": dict(inventory.files),
                "motions": dict(assessment.suite.files) if assessment.suite else {},
            },
            **_fitted_record(assessment),
        },
        "building": building_record(assessment),
        "floors": [floor_record(assessment, floor.floor) for floor in inventory.floors],
    }


def _fitted_record(assessment: Assessment) -> dict[str, Any]:
    """Return what fitted models stand among the methods; nothing where there are none."""
    found = {one.key: one for one in assessment.methods if one.fitted is not None}
    texts = {key: {"title": str(one.title), "reference": str(one.reference)} for key, one in found.items()}
    return {"fitted_models": texts} if texts else {}


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
        "demands": [
            demand_record(demand) | {"ensemble": ensemble_record(assessment, demand)}
            for axis in ("X", "Y")
            for demand in assessment.demands[name, axis]
        ],
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


def ensemble_record(assessment: Assessment, demand: Demand) -> dict[str, Any] | None:
    """Return the motions that pieces were integrated under on a floor; None where none were."""
    joint = assessment.joints.get(demand)
    if joint is None:
        return None
    return {
        "motions": int(joint.runs.max()),
        "generic_spectrum": assessment.cases.ensembles[joint.ensemble].is_generic,
        "weak_motions": assessment.cases.ensembles[joint.ensemble].is_weak,
        "fit": None if joint.fit is None else fit_record(joint.fit),
    }


def fit_record(fit: "Fit") -> dict[str, float | None]:
    """Return how generated motions meet their target."""
    return {
        "matched_to_s": fit.matched_to,
        "mean_deviation": fit.mean_deviation,
        "worst_deviation": fit.worst_deviation,
        "worst_period_s": fit.worst_period,
        "pfa_ratio": fit.pfa_ratio,
        "pfa_scatter": fit.pfa_scatter,
        "pfv_ratio": None if math.isnan(fit.pfv_ratio) else fit.pfv_ratio,
        "pfv_scatter": fit.pfv_scatter,
        "spectrum_scatter": fit.spectrum_scatter,
    }


def item_record(one: ItemResult, sheet: str = "Items") -> dict[str, Any]:
    """Return one item as it stands in results.json; `sheet` is what the workbook calls its sheet of items."""
    item, case = one.item, one.governing
    return {
        **_piece_record(one),
        "pfa_g": edge(case.demand.pfa, "g"),
        "pfv_cm_s": edge(case.demand.pfv, "cm/s"),
        "pfa_source": case.demand.label,
        "methods": {key: method_record(method) for key, method in case.methods.items()},
        "verification": verification_record(case.verification),
        "adopted": adopted_record(one),
        "axes": [axis_record(other) for other in one.cases],
        "anchored": item.anchored,
        "route": item.route or None,
        "segment": item.segment or None,
        "edge_distance_m": item.edge_distance,
        "notes": item.notes,
        "assumed": list(item.assumed),
        "source": {"sheet": sheet, "row": item.row},
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


def verification_record(one: VerificationResult | None) -> dict[str, Any] | None:
    """Return what direct integration found under the governing motion; None where it did not run."""
    if one is None:
        return None
    record = {"overturned": one.record_overturned, "max_rotation_ratio": one.record_rotation}
    return {
        "runs": one.runs,
        "overturned": one.overturned,
        "probability": one.probability,
        "low": one.low,
        "high": one.high,
        "record": None if one.record_overturned is None else record,
    }


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
        "verification": verification_record(case.verification),
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
