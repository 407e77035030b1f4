"""Study `table1`: the risk of one piece up each of the paper's 50 monitored buildings, and under a folder of records.

The paper's Table 1 and Fig. 3b (section 3.1). Its floor records are not available; a beam on the base replaces them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from assess.intensity import RATIO
from assess.motion.assumed import CODE_FACTOR, CODE_POWER, LONGER
from assess.report.figures.draw import draw
from assess.risk import RiskClass, classify
from assess.studies.studied_methods import KANEKO, METHODS, OR, SHORT_TITLES, STATIC
from assess.studies.study import Finding, Options, Row, Study, Table, read_facts, write_finding
from assess.studies.table1.records_folder import evaluate_folder, read_folder
from assess.studies.table1.tower import (
    METHOD_COLUMNS,
    Climbed,
    Station,
    climb_all,
    method_cells,
    paint_climbed,
    read_stations,
)
from assess.units import GRAVITY, VELOCITY

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


@dataclass(frozen=True, slots=True, eq=False)
class Climbs:
    """The piece up every building: with T1 as estimated from the height, and with `LONGEST` times that."""

    stations: Sequence[Station]
    usual: Climbed
    longer: Climbed


def climb_buildings(options: Options) -> Climbs:
    """Evaluate the piece on every floor of the buildings whose base PGA is printed."""
    known = [one for one in read_stations() if one.pga]
    periods = [one.period for one in known]
    longer = [LONGEST * one for one in periods]
    return Climbs(known, climb_all(known, periods, options), climb_all(known, longer, options))


def count_classes(chances: Mapping[str, float]) -> dict[RiskClass, int]:
    """Return how many buildings are in each class."""
    found = [classify(value) for value in chances.values()]
    return {risk: found.count(risk) for risk in reversed(RiskClass)}


def run(options: Options) -> Finding:
    """Evaluate the piece up the buildings, and under the records of a folder if one is given."""
    folder = None if options.records is None else read_folder(options.records, options.out)
    climbs = climb_buildings(options)
    usual, own = climbs.usual, None if folder is None else evaluate_folder(folder, options)
    rows = [_row(usual, at) for at in range(len(usual.levels))]
    return write_finding(
        "table1",
        _collect(climbs, options) | {"own": "" if own is None else "\n".join(own.page)},
        tables={"table1": Table(columns=COLUMNS, rows=rows), **(own.tables if own else {})},
        figures={"table1.svg": draw(7, 4.2, partial(paint_climbed, usual, DRAWN))},
    )


def _collect(climbs: Climbs, options: Options) -> dict[str, object]:
    usual, longer = climbs.usual, climbs.longer
    chances = {key: usual.find_worst(key) for key in SHORT_TITLES}
    cannot_rock = [number for number, value in usual.find_worst(STATIC).items() if value == 0]
    order = _rank(usual, OR)
    return {
        "options": options, "ratio": options.breadth / options.height,
        "checked": METHODS[OR].valid["breadth_to_height"], "stations": climbs.stations,
        "left_out": [one.number for one in read_stations() if not one.pga],
        "period": (LONGER * CODE_FACTOR, CODE_POWER), "velocity_ratio": 100 * RATIO * GRAVITY,
        "titles": SHORT_TITLES, "OR": OR, "KANEKO": KANEKO, "papers_worst": PAPERS_WORST,
        "risks": list(reversed(RiskClass)), "classes": {key: count_classes(one) for key, one in chances.items()},
        "worst": [_describe_roof(usual, one) for at, one in enumerate(order) if at < WORST or one in PAPERS_WORST],
        "roofs": len(order), "places": _find_places(usual),
        "others": sorted(one for one in order[: len(PAPERS_WORST)] if one not in PAPERS_WORST),
        "longer": LONGEST,
        "high": {key: [_count_high(one.find_worst(key)) for one in (usual, longer)] for key in SHORT_TITLES},
        "cannot_rock": _count_high({number: chances[OR][number] for number in cannot_rock}),
        "very_high": {key: _list_very_high(one) for key, one in chances.items()}, "longest": 2 * WORST,
    }  # fmt: skip


def _rank(climbed: Climbed, key: str) -> list[str]:
    found = climbed.find_worst(key)
    return sorted(found, key=lambda number: (-np.nan_to_num(found[number], nan=-1.0), number))


def _find_places(climbed: Climbed) -> dict[str, list[int]]:
    known = [key for key in SHORT_TITLES if not np.isnan(climbed.values[key]).any()]
    return {key: [_rank(climbed, key).index(one) + 1 for one in PAPERS_WORST] for key in known}


def _describe_roof(climbed: Climbed, number: str) -> dict[str, object]:
    roofs = [one for one in climbed.levels if one.station.number == number and one.is_roof]
    roof = max(roofs, key=lambda one: one.pfa)
    return {
        "station": roof.station, "pfa_g": roof.pfa / GRAVITY, "pfv_cm_s": roof.pfv / VELOCITY["cm/s"],
        "chances": [(value := climbed.find_worst(key)[number], classify(value)) for key in SHORT_TITLES],
        "printed": [_find_printed(number, key) for key in (OR, KANEKO)],
    }  # fmt: skip


def _find_printed(number: str, key: str) -> list[float]:
    """Return the chances in the paper's Table 2 at the highest storey of a building; none if it is not listed there."""
    rows = [row for row in read_facts("table2_methods") if row["building"] == number]
    top = max((int(row["storey"]) for row in rows), default=0)
    return [float(row[key]) for row in rows if int(row["storey"]) == top]


def _count_high(chances: Mapping[str, float]) -> int:
    counts = count_classes(chances)
    return counts[RiskClass.HIGH] + counts[RiskClass.VERY_HIGH]


def _list_very_high(chances: Mapping[str, float]) -> list[str]:
    return sorted(one for one, value in chances.items() if classify(value) == RiskClass.VERY_HIGH)


def _row(climbed: Climbed, at: int) -> Row:
    level = climbed.levels[at]
    station = level.station
    return (
        station.number, station.name, station.storeys, station.height, station.earthquake, level.direction,
        level.number, level.place, station.pga[level.direction] / GRAVITY, station.period,
        level.pfa / GRAVITY, level.pfv / VELOCITY["cm/s"],
        *method_cells(climbed.values, at),
    )  # fmt: skip


STUDY = Study(
    name="table1",
    order=10,
    title="One piece up the 50 monitored buildings",
    of="Table 1 and Fig. 3b, section 3.1",
    run=run,
    takes=frozenset({"records", "breadth", "height"}),
)
