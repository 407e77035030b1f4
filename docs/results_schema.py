"""Write the JSON Schema of results.json beside what writes it: ``python docs/results_schema.py``.

It is made from the fields of `assess.fields` and from the rows of `assess.route_results`; descriptions are the fields'
help and the rows' docstrings. A test compares the file with what this script makes.
"""

import inspect
import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from enum import StrEnum
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

from assess import route_results as rows
from assess.annual_results import AnnualRow, AnnualTables
from assess.errors import Problem
from assess.fields import (
    ENTRY_FIELDS,
    GROUND_FIELDS,
    MOTION_FIELDS,
    PHASE_FIELDS,
    SHAKING_FIELDS,
    SIMULATION_FIELDS,
    STATE_FIELDS,
    item_fields,
)
from assess.model import AXES, TEXT_SECTIONS
from assess.report.data import SCHEMA, VERSION, building_key
from assess.results import EarthquakeDraws, Provenance
from assess.risk import RiskClass
from assess.settings import ANCHOR_CODES, MOST_SCALE, SCENARIOS, Settings
from assess.table import Field, Tree, build_tree
from assess.workbook.schema import BUILDING

Schema = dict[str, Any]
UNCERTAINTY = get_type_hints(Provenance)["uncertainty"]

TEXT: Schema = {"type": "string"}
HASH: Schema = {"type": "string", "pattern": "^[0-9a-f]{64}$"}
SHARE: Schema = {"type": "number", "minimum": 0, "maximum": 1}
INSIDE: Schema = {"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1}
COUNT: Schema = {"type": "integer", "minimum": 0}
ROW: Schema = {"type": "integer", "minimum": 1}


def build_schema() -> Schema:
    """Return the schema."""
    kinds = {"number": _or_null({"type": "number"}), "count": _or_null({"type": "integer"}),
             "flag": _or_null({"type": "boolean"}), "file": _or_null(TEXT)}  # fmt: skip
    verification = _of_fields(SIMULATION_FIELDS)["properties"]["verification"]
    top = {
        "schema": {"const": VERSION},
        "assess": _assess(),
        "building": _object({building_key(column): kinds.get(column.kind, TEXT) for column in BUILDING.columns}),
        "floors": _list(_object({
            "floor": TEXT, "name": TEXT, "elevation_m": _or_null({"type": "number"}),
            "demands": _list(_ref("demand")) | {"minItems": len(AXES)},
        })),
        "items": _list(_ref("item")),
        "routes": _of_row(rows.RouteTables),
        "schedule": _schedule(),
        "texts": _list(_object({"section": {"enum": list(TEXT_SECTIONS)}, "text": TEXT}))
        | {"description": "The surveyor's own paragraphs, in their order: data, never markup."},
        "annual": _or_null(_of_row(AnnualTables))
        | {"description": "What annual chances rest on, and those of the building; null: no Hazard file was given."},
        "problems": _list(_of_row(Problem) | {"description": "Warnings and notes about the input."}),
    }  # fmt: skip
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "assess: results.json",
        "description": "Results of one run. Units are in the names; null is unknown. `schema` rises with each change.",
        **_object(top),
        "$defs": {
            "method": _method(),
            "demand": _of_fields(MOTION_FIELDS) | {"description": "A motion that serves a floor along an axis."},
            "item": _item(),
            "verification": verification | {"description": "What simulation found; null: it was not simulated."},
            **{name: _of_row(row) | _conditions(row) for row, name in _ROWS.items()},
        },
    }


# ---------------------------------------------------------------- parts


def _object(properties: Mapping[str, Schema], *, optional: Iterable[str] = ()) -> Schema:
    required = [name for name in properties if name not in optional]
    return {"type": "object", "properties": dict(properties), "required": required, "additionalProperties": False}


def _list(items: Schema) -> Schema:
    return {"type": "array", "items": items}


def _map(values: Schema) -> Schema:
    return {"type": "object", "additionalProperties": values}


def _ref(name: str) -> Schema:
    return {"$ref": f"#/$defs/{name}"}


def _or_null(schema: Schema) -> Schema:
    if "enum" in schema:
        return schema | {"enum": [*schema["enum"], None]}
    return schema | {"type": [schema["type"], "null"]} if "type" in schema else {"oneOf": [schema, {"type": "null"}]}


# ---------------------------------------------------------------- fields


_KINDS: Mapping[str, Schema] = {
    "text": TEXT, "number": {"type": "number"}, "count": COUNT, "share": SHARE, "flag": {"type": "boolean"},
    "class": {"enum": [risk.word for risk in RiskClass]}, "list": _list(TEXT),
    "signs": _list({"enum": [1, -1]}), "factors": _list({"type": "number"}),
}  # fmt: skip
_GROUPS_OR_NULL = {
    ("verification",), ("verification", "record"), ("verification", "ideal"), ("ensemble",), ("sliding",),
    ("ensemble", "fit"), ("annual",), ("anchor",),
}  # fmt: skip


def _of_fields(chosen: Iterable[Field]) -> Schema:
    """Return the schema of the records of a table."""
    return _of_tree(build_tree(chosen), ())


def _of_tree(tree: Tree, place: tuple[str, ...]) -> Schema:
    made = {name: _leaf(one) if isinstance(one, Field) else _of_tree(one, (*place, name)) for name, one in tree.items()}
    return _or_null(_object(made)) if place in _GROUPS_OR_NULL else _object(made)


def _leaf(one: Field) -> Schema:
    if one.choices:
        schema: Schema = {"enum": list(one.choices)}
    else:
        schema = _list(_of_fields(one.records)) if one.records else _KINDS.get(one.kind, {})
    schema = _or_null(schema) if one.is_optional else schema
    return schema | ({"description": one.help} if one.help else {})


def _item() -> Schema:
    item = _of_fields(item_fields(()))
    own = item["properties"]
    own["axes"] = _list(_object({
        "axis": own["axis"], "source": own["pfa_source"], "pfa_g": {"type": "number"},
        "pfv_cm_s": _or_null({"type": "number"}), "methods": _map(_or_null(SHARE)),
        "verification": _ref("verification"),
    })) | {"description": own["axes"]["description"]}  # fmt: skip
    methods = _map(_ref("method")) | {"description": "By the keys of the methods."}
    return _object(own | {"verification": _ref("verification"), "methods": methods})


def _method() -> Schema:
    value = _or_null(SHARE) | {"description": "Chance of overturning, or 1 met and 0 not met; null: not evaluated."}
    return _object({"value": value, "flags": _list(TEXT)}) | {
        "additionalProperties": {"type": ["number", "string", "boolean", "null"]},
        "description": "Beside the value are the method's own details, units in their names.",
    }


def _schedule() -> Schema:
    """Return the schema of the schedule."""
    entry, state, phase = _of_fields(ENTRY_FIELDS), _of_fields(STATE_FIELDS), _of_fields(PHASE_FIELDS)
    state["properties"]["routes"] |= _map(COUNT)
    made = _object({
        "entries": _list(entry) | {"description": "The most urgent first."},
        "checks": _list(entry) | {"description": "Pieces that are anchored or roll, to check or to park: in no sum."},
        "phases": _list(_object(phase["properties"] | {"after": state})),
        "before": state,
        "after": state | {"description": "With the pieces of phases A and B anchored, and their anchors holding."},
        "cost": _or_null({"type": "number"}) | {"description": "Sum of the costs that are known."},
        "currency": TEXT | {"description": "ISO code of the currency of all costs; empty: the workbook names none."},
        "entries_without_cost": COUNT,
    })  # fmt: skip
    return made | {"description": "What to fix, with what, and what it changes: screening, not design."}


def _assess() -> Schema:
    fitted = _object({"title": TEXT, "reference": TEXT})
    return _object(
        {
            "version": TEXT,
            "code": HASH | {"description": "SHA-256 over the program's modules and tables."},
            "seed": COUNT | {"description": "Of the generated motions."},
            "settings": _of_row(Settings),
            "anchor_code": {"enum": ["", *ANCHOR_CODES]}
            | {"description": "Code of the force on anchors; empty: no ground motion is known for one."},
            "uncertainty": _of_row(UNCERTAINTY) | {"description": "What the draws of the simulation vary."},
            "earthquakes": _or_null(_of_row(EarthquakeDraws))
            | {"description": "How draws of the earthquake depend on the place and on scenarios; null: they do not."},
            "shaking": _or_null(_of_fields(SHAKING_FIELDS))
            | {"description": "The assumed intensity that stands in for a known motion of the ground; null: none."},
            "site_ground": _or_null(_of_fields(GROUND_FIELDS))
            | {"description": "The ground motion at the building by a ShakeMap or scenarios; null: none."},
            "language": TEXT | {"description": "Code of the language that reports are in where none is asked for."},
            "platform": _map(TEXT),
            "inputs": _object({"workbook": TEXT, "sha256": HASH, "records": _map(HASH), "motions": _map(HASH)}),
            "fitted_models": _map(fitted)
            | {"propertyNames": {"pattern": "^fitted_[a-z0-9_]+$"},
               "description": "The user's own models among the methods, by key; absent where there are none."},
            "files": _map(_or_null(HASH))
            | {"description": "The other files of the run, by name, with their SHA-256: a later run into the folder "
               "replaces or removes these alone. null: a PDF, which carries this file; its file identifier tells "
               "whether it was changed. Absent where the results were not written as a report."},
        },
        optional=("fitted_models", "files"),
    )  # fmt: skip


# ---------------------------------------------------------------- rows


_ROWS: Mapping[type, str] = {
    rows.Chance: "chance", rows.PieceRef: "piece", rows.BesideRow: "beside", rows.SegmentRow: "segment",
    rows.RouteRow: "route", rows.RouteFixRow: "route_fix", rows.WayRow: "way", rows.RoomRow: "room",
    rows.FloorRoutesRow: "route_floor", rows.MissingRow: "missing", AnnualRow: "annual",
}  # fmt: skip
"""The rows that are defined once, by their names in the schema."""

_SPECIAL: Mapping[tuple[type, str], Schema] = {
    **{(row, "row"): ROW for row in (rows.PieceRef, rows.BesideRow, rows.RouteFixRow)},
    (rows.RouteTables, "risk"): INSIDE,
    (rows.SegmentRow, "other_rooms"): _list(TEXT),
    (rows.BesideRow, "falls_while_blocked"): {"oneOf": [SHARE, {"type": "null"}]},
    (rows.RouteFixRow, "gain"): SHARE,
    (rows.RouteFixRow, "left"): SHARE,
    (Settings, "scenario"): {"enum": list(SCENARIOS)},
    (Settings, "anchor"): TEXT,
    (Settings, "route_risk"): INSIDE,
    (Settings, "scale"): {"type": "number", "exclusiveMinimum": 0, "maximum": MOST_SCALE},
    (Settings, "ductility_reduction"): {"type": "number", "minimum": 1},
    (UNCERTAINTY, "motion"): {"type": "number", "minimum": 0},
    (Problem, "severity"): {"enum": ["error", "warning", "note"]},
}
"""What is not as its type says."""


def _of_row(row: Any) -> Schema:
    hints, texts = get_type_hints(row), _describe(row)
    made = {}
    for field in fields(row):
        if field.name not in rows.NOT_IN_JSON:
            schema = _SPECIAL.get((row, field.name)) or _of_type(hints[field.name], _number_in(row, field.name))
            text = {"description": texts[field.name]} if field.name in texts else {}
            made[rows.JSON_NAMES.get(field.name, field.name)] = schema | text
    return _object(made)


def _number_in(row: type, name: str) -> Schema:
    """Return the schema of a number: a chance, an expected number or a width that cannot be negative, or any."""
    if row is rows.Chance:
        return SHARE
    is_size = row is rows.SegmentRow and name.endswith("_m") and not name.endswith(("_x_m", "_y_m"))
    return {"type": "number", "minimum": 0} if is_size or name.endswith("_expected") else {"type": "number"}


def _of_type(hint: Any, number: Schema) -> Schema:
    parts = [one for one in get_args(hint) if one is not NoneType]
    if get_origin(hint) in (Union, UnionType):
        made = [_of_type(one, number) for one in parts]
        schema = made[0] if len(made) == 1 else {"oneOf": made}
        return _or_null(schema) if NoneType in get_args(hint) else schema
    if get_origin(hint) is Literal:
        return {"enum": parts}
    if get_origin(hint) is tuple:
        return _list(_of_type(parts[0], number))
    if is_dataclass(hint):
        return _ref(_ROWS[hint]) if hint in _ROWS else _of_row(hint)  # type: ignore[index]
    if issubclass(hint, StrEnum):
        return {"enum": [str(one) for one in hint]}
    return {bool: {"type": "boolean"}, int: COUNT, float: number, str: TEXT}[hint]


def _conditions(row: type) -> Schema:
    """Return what also holds of a segment or route: it has chances if and only if it is evaluated."""
    if row not in (rows.SegmentRow, rows.RouteRow):
        return {}
    chances = ("blocked", "blocked_or_reduced")
    return {
        "if": {"properties": {"evaluated": {"const": True}}},
        "then": {"properties": dict.fromkeys(chances, _ref("chance"))},
        "else": {"properties": {name: {"type": "null"} for name in chances}},
    }


def _describe(row: type) -> dict[str, str]:
    """Return the descriptions of a row's fields in its docstring, but for those that are as in another row."""
    found: dict[str, str] = {}
    listed = re.findall(r"^\* (`.*?`)(?: \(.*?\))?: ((?:.*\n?)(?:  .*\n?)*)", inspect.getdoc(row) or "", re.MULTILINE)
    for names, text in listed:
        plain = " ".join(text.split())
        found |= {
            name: plain[0].upper() + plain[1:]
            for name in re.findall(r"`(\w+)`", names)
            if not plain.startswith("As in ")
        }
    return found


if __name__ == "__main__":
    text = json.dumps(build_schema(), indent=1, ensure_ascii=False)
    SCHEMA.write_text(f"{text}\n", encoding="utf-8")
