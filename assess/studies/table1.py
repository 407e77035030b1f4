"""Study `table1`: the risk of one piece up each of the paper's 50 monitored buildings, and under any folder of records.

The paper's Table 1 and Fig. 3b (section 3.1). Its floor records are not to be had, so a code's profile stands in.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from assess.methods.proposed_or import METHOD as PROPOSED_OR
from assess.motion.estimate import HIGHEST_FLOOR_FREQUENCY
from assess.motion.scenario import DEFAULT
from assess.motion.target import CODE_FACTOR, CODE_POWER, LONGER
from assess.report.figures.draw import draw
from assess.risk import RiskClass, classify
from assess.studies._facts import read_facts
from assess.studies._folder import read_folder, tell_folder
from assess.studies._study import Finding, Options, Row, Study, Table, table_lines
from assess.studies._tower import (
    SHORT_TITLES,
    Climbed,
    Level,
    Station,
    climb_all,
    method_cells,
    method_columns,
    paint_climbed,
    read_stations,
)
from assess.units import GRAVITY, VELOCITY

DRAWN = ("kaneko_hayashi", "proposed_or")
PAPERS_WORST = ("003", "004", "005")
"""The buildings that the paper finds in class very high (section 3.1) and examines further."""
WORST = 5
"""Buildings in the table of the worst."""
COLUMNS = (
    "id", "station", "storeys", "height_m", "earthquake", "direction", "floor", "z_over_h",
    "base_pga_g", "period_s", "pfa_g", "pfv_cm_s", "flags",
)  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Climbs:
    """The piece up every building: T1 as estimated from the height, and `LONGER` times that."""

    stations: Sequence[Station]
    usual: Climbed
    longer: Climbed


def climb_buildings(options: Options) -> Climbs:
    """Evaluate the piece on every floor of the buildings whose base PGA is printed."""
    known = [one for one in read_stations() if one.pga]
    periods = [one.period for one in known]
    longer = [LONGER * one for one in periods]
    return Climbs(known, climb_all(known, periods, options), climb_all(known, longer, options))


def count_classes(chances: Mapping[str, float]) -> dict[RiskClass, int]:
    """Return how many buildings reach each class."""
    found = [classify(value) for value in chances.values()]
    return {risk: found.count(risk) for risk in reversed(RiskClass)}


def run(options: Options) -> Finding:
    """Evaluate the piece up the buildings, and under the records of a folder where one is given."""
    folder = None if options.records is None else read_folder(options.records, options.out)
    climbs = climb_buildings(options)
    told = None if folder is None else tell_folder(folder, options)
    columns = (*COLUMNS, *method_columns())
    table = Table(columns=columns, rows=[_row(climbs.usual, at) for at in range(len(climbs.usual.levels))])
    return Finding(
        page=[*_describe(climbs, options), *(told.page if told else _offer())],
        summary=list(_summarise(climbs, options)),
        tables={"table1": table} | (told.tables if told else {}),
        figures={
            "table1.svg": draw(7, 4.2, partial(paint_climbed, climbs.usual, {key: SHORT_TITLES[key] for key in DRAWN}))
        },
    )


def _row(climbed: Climbed, at: int) -> Row:
    level = climbed.levels[at]
    station, demand = level.station, level.demand
    return (
        station.number, station.name, station.storeys, station.height, station.earthquake, level.direction,
        level.number, demand.height_ratio, station.pga[level.direction] / GRAVITY, station.period,
        demand.pfa / GRAVITY, demand.pfv / VELOCITY["cm/s"], " ".join(demand.flags),
        *method_cells(climbed.values, at),
    )  # fmt: skip


# ---------------------------------------------------------------- the page


def _describe(climbs: Climbs, options: Options) -> Iterator[str]:
    yield from _describe_inputs(climbs, options)
    yield ""
    yield "Buildings by class at the roof, in the worse direction:"
    yield ""
    yield from _class_lines(climbs.usual)
    yield ""
    yield "The worst roofs by OR, the paper's three among them, with the range of the channels in its Table 2:"
    yield ""
    yield from _worst_lines(climbs.usual)
    yield ""
    yield _describe_paper(climbs.usual)
    yield ""
    yield _describe_limits(climbs)


def _piece(options: Options) -> str:
    return f"{100 * options.breadth:g} x {100 * options.height:g} cm"


def _slenderness(options: Options) -> str:
    """Return B/H, and what OR is checked for where that lies outside."""
    ratio, checked = options.breadth / options.height, PROPOSED_OR.valid["breadth_to_height"]
    told = f"B/H {ratio:.2f}"
    if checked.holds(np.array(ratio)):
        return told
    return f"{told}, outside the range in which OR is checked, {checked.low:g} to {checked.high:g}"


def _describe_inputs(climbs: Climbs, options: Options) -> Iterator[str]:
    left_out = ", ".join(one.number for one in read_stations() if not one.pga)
    yield (
        f"A free-standing piece of {_piece(options)} ({_slenderness(options)}) on every floor of "
        f"{len(climbs.stations)} of the 50 buildings, in both directions; for {left_out} Table 1 prints no PGA. **The "
        "floors are a scenario, not records:** Table 1 prints PGA at the base alone. "
        f"PFA is by the profile of {DEFAULT.key} ({DEFAULT.clause}), a design envelope, "
        f"mostly above what is recorded; T1 = {CODE_FACTOR:g} h^{CODE_POWER:g} from the height, and PFV = PFA/(2 pi f) "
        f"with f = min(1/T1, {HIGHEST_FLOOR_FREQUENCY:g} Hz)."
    )


def _class_lines(climbed: Climbed) -> list[str]:
    rows = [(name, *count_classes(climbed.find_worst(key)).values()) for key, name in SHORT_TITLES.items()]
    return table_lines(("", *(one.label for one in reversed(RiskClass))), rows)


def _class_at_roof(climbed: Climbed, key: str, number: str) -> RiskClass:
    return classify(climbed.find_worst(key)[number]) or RiskClass.LOW


def _rank(climbed: Climbed, key: str) -> list[str]:
    """Return the buildings by their risk at the roof, the highest first."""
    found = climbed.find_worst(key)
    return sorted(found, key=lambda number: (-np.nan_to_num(found[number], nan=-1.0), number))


def _strongest(climbed: Climbed, number: str) -> Level:
    """Return the roof of a building in its stronger direction."""
    own = [one for one in climbed.levels if one.station.number == number and one.is_roof]
    return max(own, key=lambda one: one.demand.pfa)


def _worst_lines(climbed: Climbed) -> list[str]:
    order, rows = _rank(climbed, "proposed_or"), []
    for number in [one for at, one in enumerate(order) if at < WORST or one in PAPERS_WORST]:
        roof = _strongest(climbed, number)
        cells = [_chance(climbed.find_worst(key)[number]) for key in SHORT_TITLES]
        peaks = f"{roof.demand.pfa / GRAVITY:.2f}", f"{roof.demand.pfv / VELOCITY['cm/s']:.0f}"
        printed = [_printed(number, key) for key in ("proposed_or", "kaneko_hayashi")]
        rows.append((f"{number}, {roof.station.name}", roof.station.storeys, *peaks, *cells, *printed))
    names = (*SHORT_TITLES.values(), "Table 2: OR", "Table 2: Kaneko-Hayashi")
    return table_lines(("building", "storeys", "PFA [g]", "PFV [cm/s]", *names), rows)


def _chance(value: float) -> str:
    found = classify(value)
    return "-" if found is None else f"{value:.2f} {found.symbol}"


def _printed(number: str, key: str) -> str:
    """Return the range that the paper's Table 2 prints at the highest storey of a building; "-" if it has it not."""
    rows = [row for row in read_facts("table2_methods") if row["building"] == number]
    top = max((int(row["storey"]) for row in rows), default=0)
    values = [float(row[key]) for row in rows if int(row["storey"]) == top]
    return f"{min(values):.2f} to {max(values):.2f}" if values else "-"


def _describe_paper(climbed: Climbed) -> str:
    count = len({one.station.number for one in climbed.levels})
    known = [key for key in SHORT_TITLES if not np.isnan(climbed.values[key]).any()]
    places = {key: [_rank(climbed, key).index(one) + 1 for one in PAPERS_WORST] for key in known}
    told = ", ".join(f"{_join(places[key])} by {SHORT_TITLES[key]}" for key in known)
    others = [one for one in _rank(climbed, "proposed_or")[: len(PAPERS_WORST)] if one not in PAPERS_WORST]
    with_them = (
        f"; {' and '.join(sorted(others))} rank with them, as a profile only amplifies the base" if others else ""
    )
    return (
        f"The paper, from records, finds {', '.join(PAPERS_WORST[:-1])} and {PAPERS_WORST[-1]} very high by "
        "Kaneko-Hayashi. Of "
        f"{count} roofs theirs are here in places {told}{with_them}. Its piece is not printed; it need not be this."
    )


def _join(places: Sequence[int]) -> str:
    return "/".join(map(str, places))


def _describe_limits(climbs: Climbs) -> str:
    """Tell how much hangs on T1, and where OR says high though the piece cannot rock."""
    counts = {key: [str(_count_high(one, key)) for one in (climbs.usual, climbs.longer)] for key in SHORT_TITLES}
    told = ", ".join(f"{' / '.join(counts[key])} by {name}" for key, name in SHORT_TITLES.items())
    still = [number for number, value in climbs.usual.find_worst("static").items() if value == 0]
    high = [one for one in still if _class_at_roof(climbs.usual, "proposed_or", one) >= RiskClass.HIGH]
    return (
        f"High or very high at the roof, with T1 as estimated / {LONGER:g} times as long: {told}. In {len(high)} OR "
        "says so though PFA is below g B/H, where rocking cannot start."
    )


def _count_high(climbed: Climbed, key: str) -> int:
    counts = count_classes(climbed.find_worst(key))
    return counts[RiskClass.HIGH] + counts[RiskClass.VERY_HIGH]


def _offer() -> list[str]:
    return [
        "",
        "`--records DIR` evaluates, and integrates, the same piece under every record of a folder.",
    ]


def _summarise(climbs: Climbs, options: Options) -> Iterator[str]:
    names = {key: _very_high(climbs.usual, key) for key in ("proposed_or", "kaneko_hayashi")}
    yield (
        f"Up {len(climbs.stations)} of the paper's 50 buildings, with the design profile of {DEFAULT.key} in place of "
        f"records, a piece of {_piece(options)} is very high at the roof in {names['proposed_or']} by OR and in "
        f"{names['kaneko_hayashi']} by Kaneko-Hayashi; the paper has {', '.join(PAPERS_WORST)} from records."
    )


def _very_high(climbed: Climbed, key: str) -> str:
    found = [one for one in _rank(climbed, key) if _class_at_roof(climbed, key, one) == RiskClass.VERY_HIGH]
    return f"{len(found)} ({', '.join(sorted(found))})" if 0 < len(found) <= 2 * WORST else str(len(found))


STUDY = Study(
    name="table1",
    order=10,
    title="One piece up the 50 monitored buildings",
    of="Table 1 and Fig. 3b, section 3.1",
    run=run,
    takes=frozenset({"records", "breadth", "height"}),
)
