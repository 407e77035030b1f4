"""Study `table1`: the risk of one piece up each of the paper's 50 monitored buildings, and under a folder of records.

The paper's Table 1 and Fig. 3b (section 3.1). Its floor records are not published; a beam on the PGA of the base
replaces them. Under the records of a folder the piece is evaluated by every formula and rocked by each record itself.
"""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from assess.arrays import FloatArray
from assess.errors import InputError, RecordError
from assess.intensity import RATIO
from assess.methods import Cases
from assess.motion.assumed import CODE_FACTOR, CODE_POWER, LONGER, UNKNOWN, estimate_period
from assess.motion.floor_medians import find_medians
from assess.motion.formats import Channel, read_channels
from assess.report.figures.draw import draw
from assess.report.words import cut
from assess.risk import LIMITS, RiskClass, classify
from assess.rocking.block import STOCKY
from assess.studies.agreement import (
    CRITERIA,
    FORMULAS,
    KANEKO,
    METHODS,
    OR,
    SHORT_TITLES,
    STATIC,
    evaluate_formulas,
)  # fmt: skip
from assess.studies.study import Finding, Options, Row, Study, Table, read_facts, write_finding
from assess.units import GRAVITY, LENGTH, VELOCITY

TABLED = {key: one for key, one in METHODS.items() if key in FORMULAS or key in CRITERIA}
"""The formulas and criteria of the tables, in the order of reports."""
METHOD_COLUMNS = tuple(name for key in TABLED for name in (key, f"{key}_class"))
"""Columns of a .csv: the value of each method, and its class or, for a criterion, its outcome in words."""
DIRECTIONS = ("transverse", "longitudinal")
DRAWN = {key: SHORT_TITLES[key] for key in (KANEKO, OR)}
LONGEST = 1.8
"""How much longer than estimated by height T1 may be [-]: that of 575 Market Street is, 6 s for 3.3 s."""
PAPERS_WORST = ("003", "004", "005")
"""The buildings that the paper finds in class very high (section 3.1) and examines further."""
WORST = 5
"""Buildings in the table of the worst."""
COLUMNS = (
    "id", "station", "storeys", "height_m", "earthquake", "direction", "floor", "z_over_h",
    "base_pga_g", "period_s", "pfa_g", "pfv_cm_s", *METHOD_COLUMNS,
)  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class Station:
    """One line of the paper's Table 1.

    `storeys` are those above the ground, `height` [m] is that of the building, `pga` [m/s2] that at the base, by
    direction; empty where it is not printed. `period` is T1 as estimated from the height [s].
    """

    number: str
    name: str
    earthquake: str
    storeys: int
    height: float
    pga: Mapping[str, float]
    period: float


def read_stations() -> list[Station]:
    """Return the 50 lines of Table 1."""
    return [
        Station(
            number=row["id"], name=row["station"], earthquake=row["earthquake"], storeys=int(row["storeys"]),
            height=(height := float(row["height_in"]) * LENGTH["in"]), period=estimate_period(height) or 0.0,
            pga={one: float(row[f"pga_{one}_g"]) * GRAVITY for one in DIRECTIONS if row[f"pga_{one}_g"]},
        )
        for row in read_facts("table1_buildings")
    ]  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Level:
    """One floor of a building in one direction, with z/h [-] and its median peaks [m/s2], [m/s].

    `number` is that of the paper's Table 2: 1 is the ground, the number of storeys plus one the roof.
    """

    station: Station
    direction: str
    number: int
    place: float
    pfa: float
    pfv: float
    is_roof: bool


def climb(station: Station, period: float) -> Iterator[Level]:
    """Yield every floor of a building with T1 [s] in both directions; storeys are assumed to be of one height."""
    for direction, pga in station.pga.items():
        for number in range(1, station.storeys + 2):
            place = (number - 1) / station.storeys
            by_pga, by_pgv = find_medians(period, place, UNKNOWN, RATIO)
            yield Level(station, direction, number, place, pga * by_pga, pga * RATIO * by_pgv, is_roof=place == 1)


@dataclass(frozen=True, slots=True, eq=False)
class Climbed:
    """Values (n,) of the formulas and criteria for a piece on every floor, by key, in the order of `levels`."""

    levels: Sequence[Level]
    values: Mapping[str, FloatArray]

    def find_worst(self, key: str) -> dict[str, float]:
        """Return the value [-] at the roof in the worse direction, by building; NaN: unknown."""
        found: dict[str, float] = {}
        for level, value in zip(self.levels, self.values[key].tolist(), strict=True):
            if level.is_roof:
                number = level.station.number
                found[number] = float(np.fmax(found.get(number, math.nan), value))
        return found

    def rank(self, key: str) -> list[str]:
        """Return the buildings, the worst roof first."""
        found = self.find_worst(key)
        return sorted(found, key=lambda number: (-np.nan_to_num(found[number], nan=-1.0), number))


def climb_all(stations: Sequence[Station], options: Options, longer: float = 1.0) -> Climbed:
    """Evaluate the piece of the options on every floor of buildings with T1 `longer` times as estimated [-]."""
    levels = [level for one in stations for level in climb(one, longer * one.period)]
    pfa, pfv = [level.pfa for level in levels], [level.pfv for level in levels]
    cases = Cases.of(breadth=options.breadth, height=options.height, pfa=pfa, pfv=pfv)
    return Climbed(levels, evaluate_formulas(cases, options.settings))


def method_cells(values: Mapping[str, FloatArray], at: int) -> list[object]:
    """Return the cells of case `at` for `METHOD_COLUMNS`; "" where a method was not evaluated."""
    cells: list[object] = []
    for key, method in TABLED.items():
        value = float(values[key][at])
        risk = classify(value)
        words = method.words[0 if value else 1] if method.kind == "criterion" else "" if risk is None else risk.word
        cells += ["", ""] if math.isnan(value) else [value, words]
    return cells


def _paint(climbed: Climbed, figure: Any) -> None:
    """Paint the risk by each formula of `DRAWN` over the buildings: every floor, and the roofs."""
    panels = figure.subplots(len(DRAWN), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (key, name) in zip(panels, DRAWN.items(), strict=True):
        every = zip(climbed.levels, climbed.values[key].tolist(), strict=True)
        dashes = sorted({(int(one.station.number), round(value, 3)) for one, value in every if value == value})
        points = np.array([((at - 0.3, risk), (at + 0.3, risk), (at, np.nan)) for at, risk in dashes]).reshape(-1, 2)
        axes.plot(*points.T, linewidth=1, color="#8fb3cc", label="every floor, both directions")
        roofs = {int(number): value for number, value in climbed.find_worst(key).items()}
        axes.plot(list(roofs), list(roofs.values()), "D", ms=3, color="#8c1d3f", label="roof, worse direction")
        for limit in LIMITS:
            axes.axhline(limit, color="#444444", linewidth=0.6, linestyle="--")
        axes.set_yscale("function", functions=(lambda values: np.sqrt(np.maximum(values, 0)), np.square))
        axes.set_ylim(0, 1)
        axes.set_yticks([0, *LIMITS, 1], [f"{tick:g}" for tick in (0, *LIMITS, 1)])
        axes.set_title(name, loc="left", fontsize=8)
        axes.tick_params(labelsize=6)
        edges = np.sqrt([0, *LIMITS, 1])
        for risk, middle in zip(RiskClass, (edges[1:] + edges[:-1]) / 2, strict=True):
            axes.text(1.01, middle, risk.label, transform=axes.transAxes, fontsize=6, va="center")
    panels[-1].set_xlim(0, 51)
    panels[-1].set_xticks([1, *range(5, 51, 5)], [f"{number:03d}" for number in (1, *range(5, 51, 5))])
    panels[-1].set_xlabel("building (ID of Table 1)", fontsize=7)
    figure.supylabel("risk R (square-root scale)", fontsize=7)
    panels[0].legend(fontsize=6, framealpha=1, edgecolor="none", loc="upper right")


LISTED = 8
"""Channels, and files left out, on the page; the .csv has all."""
LONGEST_REASON = 110
"""Characters of a reason on the page."""
RECORD_COLUMNS = (
    "record", "location", "azimuth_deg", "station", "event", "corrected", "notes", "pfa_g", "pfv_cm_s",
    *METHOD_COLUMNS, "overturned", "rotation_over_critical_angle", "impacts",
)  # fmt: skip


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
    why = {True: "vertical channel: choose a horizontal one", None: "its direction is not known: is it horizontal?"}
    for file in files:
        if file.is_dir():
            left_out.append((_spell(file.name), "a folder: subfolders are not searched"))
        elif not file.is_file():  # pipes are not opened
            left_out.append((_spell(file.name), "not a regular file"))
        else:
            try:
                found = read_channels(str(file))
            except RecordError as error:
                left_out.append((_spell(file.name), _spell(str(error).removeprefix(f"{file.name}: "))))
                continue
            for one in found:
                if one.record.vertical is False:
                    channels.append(one._replace(name=_spell(one.name)))
                else:
                    left_out.append((_spell(one.name), why[one.record.vertical]))
    if not channels:
        seen = _list_first([f"{name}: {cut(reason, LONGEST_REASON)}" for name, reason in left_out]) or "it is empty"
        raise InputError(f"{path}: it has no readable horizontal channel ({seen}). Put floor records into it")
    return Folder(path, channels, left_out)


def _spell(text: str) -> str:
    """Return a name that can be written in UTF-8: other characters by their number."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def _list_first(texts: Sequence[str]) -> str:
    rest = len(texts) - LISTED
    return "; ".join(texts[:LISTED]) + (f"; and {rest} more" if rest > 0 else "")


def evaluate_folder(folder: Folder, options: Options) -> Finding:
    """Evaluate the piece under every channel of a folder, and rock it by the record unless it is too stocky."""
    from assess.rocking.ensemble import rock_blocks

    breadth, height = options.breadth, options.height
    pfa, pfv = [one.motion.pfa for one in folder.channels], [one.motion.pfv for one in folder.channels]
    values = evaluate_formulas(Cases.of(breadth=breadth, height=height, pfa=pfa, pfv=pfv), options.settings)
    rows = []
    for at, (one, _) in enumerate(options.each(folder.channels)):
        record, motion = one.record, one.motion
        verdict: Row = ("", "", "")
        if breadth / height < STOCKY:
            found = rock_blocks(breadth, height, motion.acceleration[None], motion.time_step)
            verdict = bool(found.overturned[0, 0]), float(found.rotation[0, 0]), int(found.impacts[0, 0])
        rows.append((
            one.name, record.location, "" if record.azimuth_deg is None else record.azimuth_deg, record.station,
            record.event, record.corrected, "; ".join(str(note) for note in record.notes), motion.pfa / GRAVITY,
            motion.pfv / VELOCITY["cm/s"], *method_cells(values, at), *verdict,
        ))  # fmt: skip
    tables = {"table1-records": Table(columns=RECORD_COLUMNS, rows=rows)}
    if folder.left_out:
        tables["table1-records-left-out"] = Table(columns=("file", "reason"), rows=folder.left_out)
    cells = [dict(zip(RECORD_COLUMNS, row, strict=True)) for row in rows]
    worst = sorted(
        cells, key=lambda one: (one["overturned"] is not True, -float(str(one["pfa_g"])), str(one["record"]))
    )
    full = folder.path.resolve()
    shown = {
        "name": quote(_spell(full.name or str(full))), "cells": cells, "worst": worst[:LISTED], "titles": SHORT_TITLES,
        "rest": len(worst) - LISTED, "fell": sum(one["overturned"] is True for one in cells),
        "rocked": sum(one["impacts"] != "" and float(str(one["rotation_over_critical_angle"])) > 0 for one in cells),
        "high": {
            key: _count_high(value for one in cells if isinstance(value := one[key], float)) for key in SHORT_TITLES
        }, "quote": quote,
        "is_stocky": breadth / height >= STOCKY, "stocky": STOCKY,
        "left_out": _list_first([f"{quote(name)} ({cut(reason, LONGEST_REASON)})" for name, reason in folder.left_out]),
    }  # fmt: skip
    return write_finding("table1-records", shown, tables=tables, figures={})


def quote(name: str) -> str:
    """Return a name as Markdown shows it letter for letter, with any backticks."""
    line = re.sub(r"[\r\n]", " ", name)
    fence = "`" * (1 + max((len(one) for one in re.findall("`+", line)), default=0))
    edge = " " if line.startswith("`") or line.endswith("`") else ""
    return f"{fence}{edge}{line}{edge}{fence}"


def count_classes(chances: Mapping[str, float]) -> dict[RiskClass, int]:
    """Return how many buildings are in each class."""
    found = [classify(value) for value in chances.values()]
    return {risk: found.count(risk) for risk in reversed(RiskClass)}


def run(options: Options) -> Finding:
    """Evaluate the piece up the buildings, and under the records of a folder if one is given."""
    folder, every = None if options.records is None else read_folder(options.records, options.out), read_stations()
    known = [one for one in every if one.pga]
    usual, longer = climb_all(known, options), climb_all(known, options, LONGEST)
    own = None if folder is None else evaluate_folder(folder, options)
    rows = [
        (
            one.station.number, one.station.name, one.station.storeys, one.station.height, one.station.earthquake,
            one.direction, one.number, one.place, one.station.pga[one.direction] / GRAVITY, one.station.period,
            one.pfa / GRAVITY, one.pfv / VELOCITY["cm/s"], *method_cells(usual.values, at),
        )
        for at, one in enumerate(usual.levels)
    ]  # fmt: skip
    chances, order = {key: usual.find_worst(key) for key in SHORT_TITLES}, usual.rank(OR)
    cannot_rock = [number for number, value in usual.find_worst(STATIC).items() if value == 0]
    ranks = {key: usual.rank(key) for key in SHORT_TITLES if not np.isnan(usual.values[key]).any()}
    values = {
        "options": options, "ratio": options.breadth / options.height,
        "checked": METHODS[OR].valid["breadth_to_height"], "stations": known,
        "left_out": [one.number for one in every if not one.pga],
        "period": (LONGER * CODE_FACTOR, CODE_POWER), "velocity_ratio": 100 * RATIO * GRAVITY,
        "titles": SHORT_TITLES, "OR": OR, "KANEKO": KANEKO, "papers_worst": PAPERS_WORST,
        "risks": list(reversed(RiskClass)), "classes": {key: count_classes(one) for key, one in chances.items()},
        "worst": [_describe_roof(usual, one) for at, one in enumerate(order) if at < WORST or one in PAPERS_WORST],
        "roofs": len(order),
        "places": {key: [ranked.index(one) + 1 for one in PAPERS_WORST] for key, ranked in ranks.items()},
        "others": sorted(one for one in order[: len(PAPERS_WORST)] if one not in PAPERS_WORST),
        "longer": LONGEST,
        "high": {key: [_count_high(one.find_worst(key).values()) for one in (usual, longer)] for key in SHORT_TITLES},
        "cannot_rock": _count_high(chances[OR][number] for number in cannot_rock),
        "very_high": {
            key: sorted(name for name, value in one.items() if classify(value) == RiskClass.VERY_HIGH)
            for key, one in chances.items()
        }, "longest": 2 * WORST, "own": "" if own is None else "\n".join(own.page),
    }  # fmt: skip
    return write_finding(
        "table1",
        values,
        tables={"table1": Table(columns=COLUMNS, rows=rows), **(own.tables if own else {})},
        figures={"table1.svg": draw(7, 4.2, partial(_paint, usual))},
    )


def _describe_roof(climbed: Climbed, number: str) -> dict[str, object]:
    """Return the roof, and the chances in the paper's Table 2 at the highest storey, if the building is listed."""
    roof = max((one for one in climbed.levels if one.station.number == number and one.is_roof), key=lambda one: one.pfa)
    printed = [row for row in read_facts("table2_methods") if row["building"] == number]
    top = max((int(row["storey"]) for row in printed), default=0)
    return {
        "station": roof.station, "pfa_g": roof.pfa / GRAVITY, "pfv_cm_s": roof.pfv / VELOCITY["cm/s"],
        "chances": [(value := climbed.find_worst(key)[number], classify(value)) for key in SHORT_TITLES],
        "printed": [[float(row[key]) for row in printed if int(row["storey"]) == top] for key in (OR, KANEKO)],
    }  # fmt: skip


def _count_high(chances: Iterable[float]) -> int:
    return sum((classify(value) or RiskClass.LOW) >= RiskClass.HIGH for value in chances)


STUDY = Study(
    name="table1", order=10, title="One piece up the 50 monitored buildings", of="Table 1 and Fig. 3b, section 3.1",
    run=run, takes=frozenset({"records", "breadth", "height"}),
)  # fmt: skip
