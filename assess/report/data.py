"""The files for other programs: results.json, items.csv and .parquet, outcomes.npz; the same in every language.

Their fields are those of `assess.fields`; units stand in the names. They are written row by row, so that 20,000 items
take little more memory than one.
"""

import csv
import io
import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from assess.fields import ENTRY_FIELDS, GROUND_FIELDS, MOTION_FIELDS, PHASE_FIELDS, SHAKING_FIELDS, STATE_FIELDS
from assess.progress import SILENT, Progress
from assess.results import Results
from assess.table import Kind, Table
from assess.units import to_edge
from assess.workbook.schema import BUILDING, Column

# ---------------------------------------------------------------- results.json

VERSION = "5.4"
SCHEMA = Path(__file__).with_name("results.schema.json")
"""JSON Schema of results.json, which docs/results_schema.py makes from the fields."""
_dump = json.JSONEncoder(ensure_ascii=False, allow_nan=False, separators=(", ", ": ")).encode


def write_json(
    results: Results, path: Path, progress: Progress = SILENT, *, files: Mapping[str, str | None] | None = None
) -> None:
    """Write results.json in the shape of `SCHEMA`; `files` are the others of the run, with their SHA-256 if known."""
    routes, schedule = results.route_tables.to_record(), results.schedule
    states = (schedule.before, schedule.after, *(one.after for one in schedule.phases))
    before, after, *later = (text for part in Table.of(STATE_FIELDS, states).json_parts() for text in part)
    phases = (text for part in Table.of(PHASE_FIELDS, schedule.phases).json_parts() for text in part)
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.write("{\n")
        for name, value in describe_run(results, files).items():
            file.write(f" {json.dumps(name)}: {_dump(value)},\n")
        _write_list(file, "items", progress.checked(results.table("items").json_parts()))
        file.write(',\n "routes": {')
        for at, (name, value) in enumerate(routes.items()):
            file.write(",\n" if at else "\n")
            if isinstance(value, list):
                _write_list(file, name, [map(_dump, value)], " ")
            else:
                file.write(f"  {json.dumps(name)}: {_dump(value)}")
        file.write('\n },\n "schedule": {\n')
        _write_list(file, "entries", results.table("schedule").json_parts(), " ")
        file.write(",\n")
        _write_list(file, "checks", Table.of(ENTRY_FIELDS, schedule.checks).json_parts(), " ")
        file.write(",\n")
        pairs = zip(phases, later, strict=True)
        _write_list(file, "phases", [(f'{one.removesuffix("}")}, "after": {state}}}' for one, state in pairs)], " ")
        file.write(f',\n  "before": {before},\n  "after": {after},\n  "cost": {_dump(schedule.cost)}')
        file.write(f',\n  "currency": {_dump(schedule.currency)}')
        file.write(f',\n  "entries_without_cost": {schedule.uncosted}\n }}')
        file.write(f',\n "texts": {_dump([{"section": one, "text": text} for one, text in results.texts])}')
        file.write(f',\n "annual": {_dump(results.annual and asdict(results.annual))},\n')
        _write_list(file, "problems", [(_dump(asdict(one)) for one in results.problem_rows)])
        file.write("\n}\n")


def _write_list(file: TextIO, name: str, parts: Iterable[Iterable[str]], indent: str = "") -> None:
    """Write a list of records that are texts: a line each."""
    file.write(f"{indent} {json.dumps(name)}: [")
    gap = between = f"\n{indent}  "
    for records in parts:
        if text := f",{between}".join(records):
            file.write(gap + text)
            gap = f",{between}"
    file.write(f"\n{indent} ]")


def describe_run(results: Results, files: Mapping[str, str | None] | None = None) -> dict[str, Any]:
    """Return what stands before the items: the program, its settings and files, the building, the floors."""
    origin = results.provenance
    fitted = {
        one.key: {"title": str(one.title), "reference": str(one.reference)}
        for one in results.methods
        if one.fitted is not None
    }
    building: dict[str, Any] = {}
    for column in BUILDING.columns:
        value = getattr(results.building, column.name)
        if column.quantity and column.quantity != "angle":
            value = None if value is None else to_edge(value, column.factor)
        building[building_key(column)] = value.name if isinstance(value, Path) else value
    demands: dict[str, list[dict[str, Any]]] = {one.floor: [] for one in results.floor_rows}
    motions = sorted(results.motions, key=lambda one: one.axis)
    for motion, record in zip(motions, Table.of(MOTION_FIELDS, motions).records(), strict=True):
        demands[motion.floor].append(record)
    return {
        "schema": VERSION,
        "assess": {
            "version": origin.version,
            "code": origin.code,
            "seed": results.settings.seed,
            "settings": results.settings.as_record() | {"scenario": origin.scenario},
            "anchor_code": origin.anchor_code,
            "uncertainty": asdict(origin.uncertainty),
            "earthquakes": origin.earthquakes and asdict(origin.earthquakes),
            "shaking": origin.shaking and next(Table.of(SHAKING_FIELDS, [origin.shaking]).records()),
            "site_ground": origin.site_ground and next(Table.of(GROUND_FIELDS, [results]).records()),
            "language": origin.language,
            "platform": dict(origin.platform),
            "inputs": {
                "workbook": origin.workbook,
                "sha256": origin.sha256,
                "records": dict(origin.files),
                "motions": dict(origin.suite.files) if origin.suite else {},
            },
            **({"fitted_models": fitted} if fitted else {}),
            **({} if files is None else {"files": dict(files)}),
        },
        "building": building,
        "floors": [
            {"floor": one.floor, "name": one.name, "elevation_m": one.elevation_m, "demands": demands[one.floor]}
            for one in results.floor_rows
        ],
    }


def building_key(column: Column) -> str:
    """Return what results.json calls a line of the sheet Building: its field, with the unit but for angles."""
    has_unit = column.quantity and column.quantity != "angle"
    return f"{column.name}_{column.unit.replace('/', '_')}" if has_unit else column.name


# ---------------------------------------------------------------- items.csv

_SEPARATORS = frozenset(';,|\t\r\n"')
_FIRST = re.compile(r"""(?<![;,|\s"'])([;,|\s"']*)([=+\-@＝＋－＠])""")


def write_csv(results: Results, path: Path, progress: Progress = SILENT) -> None:
    """Write items.csv, a row an item, with disarmed texts: UTF-8 with a byte order mark, by which Excel knows it."""
    table = results.table("items")
    with path.open("w", encoding="utf-8-sig", newline="") as file:
        writer = csv.writer(file)
        writer.writerow([disarm(field.key) for field in table.fields])
        for part in progress.checked(table.parts()):
            writer.writerows(zip(*table.flat_columns(part, disarm), strict=True))


def disarm(value: object) -> object:
    """Return a value so that no spreadsheet program takes any part of it for a formula; numbers stay as they are.

    Where the list separator of a program is not the comma, it splits a text at other signs than it was joined by. So
    each of ``= + - @`` and their full-width forms gets an apostrophe before it if it begins the text, or follows one
    of ``; , |``, a tab, a line break or a quotation mark; blanks, quotation marks and apostrophes between are passed
    over. One apostrophe taken away before each such sign restores the text.

    A list becomes one text, joined by "; ".
    """
    if isinstance(value, list):
        value = "; ".join(map(str, value))
    if not isinstance(value, str):
        return value
    return _FIRST.sub(
        lambda found: (
            f"{found[1]}'{found[2]}" if found.start() == 0 or not _SEPARATORS.isdisjoint(found[1]) else found[0]
        ),
        value,
    )


# ---------------------------------------------------------------- items.parquet

_SQL_TYPES: Mapping[Kind, str] = {"number": "DOUBLE", "share": "DOUBLE", "count": "BIGINT", "flag": "BOOLEAN"}
"""Of the columns by what a field holds, never by the values, so that the files of many buildings can be read as one
table; all others are VARCHAR."""


def write_parquet(results: Results, path: Path) -> None:
    """Write items.parquet by DuckDB: items.csv with types, always the same bytes; raises OSError."""
    import duckdb

    table = results.table("items")
    types, frame = {one.key: _SQL_TYPES.get(one.kind, "VARCHAR") for one in table.fields}, table.to_frame()
    for key in (key for key, sql in types.items() if sql == "VARCHAR"):
        frame[key] = frame[key].astype("object").map(
            lambda value: "; ".join(map(str, value)) if isinstance(value, list)
            else value if isinstance(value, str) else None
        )  # fmt: skip
    names = {key: '"' + key.replace('"', '""') + '"' for key in types}
    columns = ", ".join(f"{names[key]}::{sql} AS {names[key]}" for key, sql in types.items())
    target = str(path).replace("'", "''")
    try:
        with duckdb.connect(config={"threads": 1, "autoinstall_known_extensions": False}) as connection:
            connection.register("found", frame)
            connection.execute(
                f"COPY (SELECT {columns} FROM found) TO '{target}' (FORMAT parquet, COMPRESSION zstd)"  # noqa: S608
            )
    except duckdb.Error as error:
        raise OSError(str(error).splitlines()[0]) from None


# ---------------------------------------------------------------- outcomes.npz


def write_npz(results: Results, path: Path, progress: Progress = SILENT) -> None:
    """Write outcomes.npz: under which motions each piece overturned, for those who count what falls together.

    Draw k is one earthquake for every floor of the building, by its scale and, along one axis, by the phases of its
    motions. Between floors that have records of one earthquake on one clock the sign of each octave is kept; elsewhere
    the signs of modes are not known. Two pieces fall together in draw k where both have bit k set.

    Arrays: ``item``, ``row`` (of the sheet Items), ``axis``, ``source`` and ``governs`` (m,) describe the m simulated
    cases (a piece under one floor motion), most of which have k motions; ``runs`` (m,) how many motions each was
    simulated under, the first ones; ``overturned`` (m, ceil(k/8)) has one bit a motion, the first in the highest bit
    (`numpy.unpackbits`); ``max_rotation_ratio`` (m, k) is the largest |theta| over the critical angle, NaN beyond the
    runs.

    Raises OSError if the file cannot be written; CancelledError if `progress` was cancelled.
    """
    path.write_bytes(progress.wait_for(lambda: _pack_outcomes(results)))


def _pack_outcomes(results: Results) -> bytes:
    names, series = ("cases", "runs", "overturned", "rotation"), results.series
    blocks: list[tuple[Any, ...]] = [
        (one, *(series[f"motion/{one.index}/{name}"] for name in names))
        for one in results.motions
        if one.ensemble is not None
    ]
    most = max((rotation.shape[1] for *_rest, rotation in blocks), default=0)
    cases = np.concatenate([np.zeros(0, np.int64), *(own.astype(np.int64) for _one, own, *_rest in blocks)])
    items = [results.item_rows[at] for at in results.cases_table.item[cases]]
    motions = [one for one, own, *_rest in blocks for _ in own]
    rotations = []
    for _one, _cases, runs, _bits, rotation in blocks:
        wide = np.pad(rotation.astype(np.float32), ((0, 0), (0, most - rotation.shape[1])), constant_values=np.nan)
        rotations.append(np.where(np.arange(most) >= runs.astype(np.int64)[:, np.newaxis], np.float32(np.nan), wide))
    bits = [
        np.pad(packed, ((0, 0), (0, -(-most // 8) - packed.shape[1]))) for _one, _cases, _runs, packed, _wide in blocks
    ]
    packed = io.BytesIO()
    np.savez_compressed(
        packed,
        item=np.array([item.item for item in items], dtype=np.str_),
        row=np.array([item.row for item in items], dtype=np.int64),
        axis=np.array([motion.axis for motion in motions], dtype=np.str_),
        source=np.array([motion.label for motion in motions], dtype=np.str_),
        governs=np.isin(cases, [item.governing for item in results.item_rows]),
        runs=np.concatenate([np.zeros(0, np.int64), *(runs.astype(np.int64) for _one, _cases, runs, *_ in blocks)]),
        overturned=np.concatenate([np.zeros((0, -(-most // 8)), np.uint8), *bits]),
        max_rotation_ratio=np.concatenate([np.zeros((0, most), np.float32), *rotations]),
    )
    return packed.getvalue()
