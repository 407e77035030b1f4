"""A folder of records: the chances of one piece by every formula, and its response to each record itself."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from assess.errors import InputError, RecordError
from assess.motion.formats import Channel, read_channels
from assess.report.words import cut
from assess.risk import RiskClass, classify
from assess.rocking.block import STOCKY
from assess.studies.studied_methods import SHORT_TITLES, Cases, evaluate_formulas
from assess.studies.study import Finding, Options, Row, Table, write_finding
from assess.studies.table1.tower import METHOD_COLUMNS, method_cells
from assess.units import GRAVITY, VELOCITY

SHOWN = 8
"""Channels, and files left out, on the page; the .csv has all."""
LONGEST = 110
"""Characters of a reason on the page."""
COLUMNS = (
    "record", "location", "azimuth_deg", "station", "event", "corrected", "notes", "pfa_g", "pfv_cm_s",
    *METHOD_COLUMNS, "overturned", "rotation_over_critical_angle", "impacts",
)  # fmt: skip
Cells = Mapping[str, object]
"""A row of the .csv by column."""


@dataclass(frozen=True, slots=True, eq=False)
class Folder:
    """The horizontal channels of a folder, and everything else in it with the reason why it was left out."""

    path: Path
    channels: Sequence[Channel]
    left_out: Sequence[tuple[str, str]]


def read_folder(path: Path, out: Path) -> Folder:
    """Read every file of a folder as a record, except for `out`, the folder of the study's own files.

    Raises InputError if the folder is missing, cannot be read, or has no readable horizontal channel.
    """
    if not path.is_dir():
        raise InputError(f"{path}: there is no such folder. Name a folder of floor records")
    try:
        files = sorted(one for one in path.iterdir() if not (one.is_dir() and one.resolve() == out.resolve()))
    except OSError as error:
        raise InputError(f"{path} could not be read: {error.strerror or error}. Name another folder") from None
    channels: list[Channel] = []
    left_out: list[tuple[str, str]] = []
    for file in files:
        found, reasons = _read(file)
        channels += found
        left_out += reasons
    if not channels:
        seen = _list_first([f"{name}: {cut(reason, LONGEST)}" for name, reason in left_out]) or "it is empty"
        raise InputError(f"{path}: it has no readable horizontal channel ({seen}). Put floor records into it")
    return Folder(path, channels, left_out)


def _read(file: Path) -> tuple[list[Channel], list[tuple[str, str]]]:
    """Return the horizontal channels of a file, and what is left out of it, with the reason; pipes are not opened."""
    name = _spell(file.name)
    if file.is_dir():
        return [], [(name, "a folder: subfolders are not searched")]
    if not file.is_file():
        return [], [(name, "not a regular file")]
    try:
        found = read_channels(str(file))
    except RecordError as error:
        return [], [(name, _spell(str(error).removeprefix(f"{file.name}: ")))]
    why = {True: "vertical channel: choose a horizontal one", None: "its direction is not known: is it horizontal?"}
    reasons = [(_spell(one.name), why[one.record.vertical]) for one in found if one.record.vertical is not False]
    return [one._replace(name=_spell(one.name)) for one in found if one.record.vertical is False], reasons


def _spell(text: str) -> str:
    """Return a name that can be written in UTF-8: other characters by their number."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def _list_first(texts: Sequence[str]) -> str:
    rest = len(texts) - SHOWN
    return "; ".join(texts[:SHOWN]) + (f"; and {rest} more" if rest > 0 else "")


def evaluate_folder(folder: Folder, options: Options) -> Finding:
    """Evaluate the piece under every channel of a folder, and rock it."""
    cases = Cases.of(
        breadth=options.breadth,
        height=options.height,
        pfa=[one.motion.pfa for one in folder.channels],
        pfv=[one.motion.pfv for one in folder.channels],
    )
    values = evaluate_formulas(cases, options.settings)
    rows = []
    for at, (one, _) in enumerate(options.each(folder.channels)):
        rows.append((*_describe_channel(one), *method_cells(values, at), *_rock(one, options)))
    tables = {"table1-records": Table(columns=COLUMNS, rows=rows)}
    if folder.left_out:
        tables["table1-records-left-out"] = Table(columns=("file", "reason"), rows=folder.left_out)
    cells = [dict(zip(COLUMNS, row, strict=True)) for row in rows]
    worst = sorted(
        cells, key=lambda one: (one["overturned"] is not True, -float(str(one["pfa_g"])), str(one["record"]))
    )
    full = folder.path.resolve()
    shown = {
        "name": quote(_spell(full.name or str(full))), "cells": cells, "worst": worst[:SHOWN], "titles": SHORT_TITLES,
        "rest": len(worst) - SHOWN, "fell": sum(one["overturned"] is True for one in cells),
        "rocked": sum(one["impacts"] != "" and float(str(one["rotation_over_critical_angle"])) > 0 for one in cells),
        "high": {key: _count_high(cells, key) for key in SHORT_TITLES}, "quote": quote,
        "is_stocky": options.breadth / options.height >= STOCKY, "stocky": STOCKY,
        "left_out": _list_first([f"{quote(name)} ({cut(reason, LONGEST)})" for name, reason in folder.left_out]),
    }  # fmt: skip
    return write_finding("table1-records", shown, tables=tables, figures={})


def _describe_channel(one: Channel) -> Row:
    record, motion = one.record, one.motion
    azimuth = "" if record.azimuth_deg is None else record.azimuth_deg
    origin = record.station, record.event, record.corrected, "; ".join(str(note) for note in record.notes)
    return one.name, record.location, azimuth, *origin, motion.pfa / GRAVITY, motion.pfv / VELOCITY["cm/s"]


def _rock(one: Channel, options: Options) -> Row:
    """Return the response to the record itself by direct integration; "" where the piece is too stocky to rock."""
    if options.breadth / options.height >= STOCKY:
        return "", "", ""
    from assess.rocking.ensemble import rock_blocks

    found = rock_blocks(options.breadth, options.height, one.motion.acceleration[None], one.motion.time_step)
    return bool(found.overturned[0, 0]), float(found.rotation[0, 0]), int(found.impacts[0, 0])


def quote(name: str) -> str:
    """Return a name as Markdown shows it letter for letter, whatever backticks are in it."""
    line = re.sub(r"[\r\n]", " ", name)
    fence = "`" * (1 + max((len(one) for one in re.findall("`+", line)), default=0))
    edge = " " if line.startswith("`") or line.endswith("`") else ""
    return f"{fence}{edge}{line}{edge}{fence}"


def _count_high(cells: Sequence[Cells], key: str) -> int:
    chances = [value for one in cells if isinstance(value := one[key], float)]
    return sum((classify(value) or RiskClass.LOW) >= RiskClass.HIGH for value in chances)
