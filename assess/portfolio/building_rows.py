"""What a run found of one building, as rows of the tables of a portfolio."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from assess.details import DETAILS
from assess.errors import Problem
from assess.i18n import fill
from assess.model import Inventory
from assess.pipeline.draw_sums import SIMULATED, DrawSums, count_people
from assess.pipeline.known_ground import find_ground
from assess.portfolio.index_file import IndexRow
from assess.portfolio.table_schemas import TABLES
from assess.report.counts import count
from assess.report.findings.assumed_intensity import uses_scatter
from assess.report.findings.route_words import say_missing
from assess.results import ItemResult, Results
from assess.risk import RiskClass, find_ends
from assess.route_results import RouteRow, RouteState, RouteTables
from assess.units import to_edge
from assess.workbook.schema import BUILDING, USES

if TYPE_CHECKING:
    from assess.schedule_results import ScheduleRow, WorkRow

Record = dict[str, Any]
OWN_MOTIONS = ("record", "given")
"""Sources of a floor's motion that are not of the ground motion of the run."""
MOST_PROBLEMS = 200
"""Problems of one building that the tables hold; the rest is counted."""
MOST_BLOCKERS = 20
"""Pieces that a route names."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Origin:
    """Where the pieces of a building come from.

    Parameters
    ----------
    path : str
        The building, as in the tables.
    inventory : str
        One of `assess.portfolio.table_schemas.INVENTORIES`.
    index : IndexRow, optional
        Its row of the index.
    low, high : mapping of str to int
        10 % and 90 % quantities of an assumed inventory, by item.
    left_out : int, optional
        Components of a handover file that may be furniture and were left out.
    """

    path: str
    inventory: str
    index: IndexRow | None = None
    low: Mapping[str, int] | None = None
    high: Mapping[str, int] | None = None
    left_out: int | None = None


def build_tables(origin: Origin, inventory: Inventory, results: Results, sums: DrawSums) -> dict[str, list[list[Any]]]:
    """Return the rows of the tables buildings, pieces, routes and problems."""
    records: dict[str, Iterable[Record]] = {
        "buildings": [_build_building(origin, inventory, results, sums)],
        "pieces": _list_pieces(origin, results),
        "routes": _list_routes(origin.path, results),
        "problems": list_problems(origin.path, results.problem_rows),
    }
    return {name: [to_row(name, record) for record in rows] for name, rows in records.items()}


def build_skipped(
    path: str, problems: Sequence[Problem], index: IndexRow | None = None, inventory: str | None = None
) -> dict[str, list[list[Any]]]:
    """Return the rows of a building that could not be assessed, with the reasons."""
    known = {} if index is None else {name: getattr(index, name) for name in _OF_INDEX}
    record = {
        "path": path,
        "status": "skipped",
        "inventory": inventory,
        **known,
        "use": None if index is None else spell_use(index.use),
        "warnings": sum(one.severity == "warning" for one in problems),
    }
    rows = [to_row("problems", one) for one in list_problems(path, problems)]
    return {"buildings": [to_row("buildings", record)], "pieces": [], "routes": [], "problems": rows}


_OF_INDEX = ("building", "latitude", "longitude", "use", "storeys", "height_m", "floor_area_m2")


def spell_use(text: str) -> str:
    """Return a use as the drop-down of the workbook offers it, where it is one of those but for letter case."""
    return _USES.get(text.strip().casefold(), text)


_USES = {use.casefold(): use for use in USES}


def to_row(name: str, record: Mapping[str, Any]) -> list[Any]:
    """Return a record as a row of a table: plain values in the order of its columns, None for what is not known."""
    unknown = set(record) - {column.name for column in TABLES[name]}
    if unknown:
        raise ValueError(f"the table {name} has no column {', '.join(sorted(unknown))}")
    return [_to_plain(record.get(column.name), column.type) for column in TABLES[name]]


def _to_plain(value: Any, kind: str) -> Any:
    if value is None or value == "":
        return None
    if kind == "text":
        return str(value)
    if kind == "flag":
        return bool(value)
    if kind == "count":
        return int(value)
    number = float(value)
    return number if math.isfinite(number) else None


# ---------------------------------------------------------------- the building


def _build_building(origin: Origin, inventory: Inventory, results: Results, sums: DrawSums) -> Record:
    is_placed = results.building.latitude is not None and results.building.longitude is not None
    own = {one.floor for one in results.motions if one.source in OWN_MOTIONS}
    routes = results.route_tables.routes
    is_any_known = any(one.state is not RouteState.NOT_KNOWN and one.blocked is not None for one in routes)
    return {
        "path": origin.path,
        "status": "assessed",
        "inventory": origin.inventory,
        **_describe_site(origin, inventory),
        "own_motions": len(own),
        "largest_pfa_g": max((one.pfa_g for one in results.motions), default=None),
        "motion_uncertainty": results.provenance.uncertainty.motion if uses_scatter(results) else None,
        "is_placed": is_placed,
        **_count_pieces(origin, results),
        "left_out": origin.left_out,
        **_count_draws(sums),
        **_count_works(results),
        **_count_routes(results.route_tables),
        "people_not_known": sums.people_not_known,
        "people_blocked": sums.people_expected if is_any_known else None,
        "warnings": sum(one.severity == "warning" for one in results.problem_rows),
    }


def _describe_site(origin: Origin, inventory: Inventory) -> Record:
    building = inventory.building
    source, pga, pgv = _find_shaking(inventory)
    site = inventory.site_ground if source == "scenarios" else None
    return {
        "building": building.building,
        "latitude": building.latitude,
        "longitude": building.longitude,
        "use": spell_use(building.use),
        "storeys": building.storeys,
        "height_m": building.height,
        "floor_area_m2": None if origin.index is None else origin.index.floor_area_m2,
        "ground_source": source,
        "ground_distance_km": None if site is None or site.distance is None else site.distance / 1000,
        "ground_pga_g": None if pga is None else to_edge(pga, BUILDING.column("ground_pga").factor),
        "ground_pgv_cm_s": None if pgv is None else to_edge(pgv, BUILDING.column("ground_pgv").factor),
    }


def _find_shaking(inventory: Inventory) -> tuple[str, float | None, float | None]:
    """Return what the motion of the ground rests on, its PGA [m/s2] and its PGV [m/s]."""
    site, ground = inventory.site_ground, find_ground(inventory)
    if inventory.building.ground_pga is None and inventory.building.sds is None and site is not None:
        return site.kind, site.pga, site.pgv
    if ground.pga is None:
        return "", None, ground.pgv
    if ground.shaking is not None:
        return "shaking", ground.pga, ground.shaking.pgv
    return "sds" if ground.is_from_sds else "ground_pga", ground.pga, ground.pgv


def _count_pieces(origin: Origin, results: Results) -> Record:
    rows = tuple(results)
    counts = count("", rows)
    main = [one for one in rows if not one.is_anchored and not one.apart]

    def expect(quantities: Mapping[str, int] | None) -> float | None:
        if quantities is None:
            return None
        return math.fsum(one.adopted.probability * quantities[one.item.item] for one in main)

    return {
        "basis": results.main_basis,
        "pieces": counts.total,
        **{risk.word.replace(" ", "_"): counts.by_class[risk] for risk in RiskClass},
        "unconfirmed": counts.unconfirmed,
        "by_formula": counts.by_formula,
        "cannot_rock": counts.cannot_rock,
        "anchored": counts.anchored,
        "expected_falls": counts.expected,
        "falls_low_inventory": expect(origin.low),
        "falls_high_inventory": expect(origin.high),
    }


def _count_draws(sums: DrawSums) -> Record:
    if sums.falls is None:
        return {"draws": 0}
    low, high = find_ends(sums.falls)
    return {"draws": len(sums.falls), "falls_p05": low, "falls_p95": high}


def _count_works(results: Results) -> Record:
    works = [work for entry in results.schedule.rows for work in entry.works]
    return {
        "falls_avoided": math.fsum(entry.falls_avoided for entry in results.schedule.rows),
        "works": sum(one.pieces for one in works),
        "cost": results.schedule.cost,
        "works_without_cost": sum(one.pieces for one in works if one.cost is None),
    }


_STATES = {
    RouteState.OPEN: "routes_open", RouteState.DOUBTFUL: "routes_doubtful", RouteState.BLOCKED: "routes_blocked",
    RouteState.NOT_KNOWN: "routes_not_known",
}  # fmt: skip


def _count_routes(tables: RouteTables) -> Record:
    people = [count_people(tables, one) for one in tables.routes]
    known = [one for one in people if one is not None]
    return {
        "routes": len(tables.routes),
        **{name: sum(one.state is state for one in tables.routes) for state, name in _STATES.items()},
        "occupants": sum(known) if known else None,
    }


# ---------------------------------------------------------------- its pieces, routes and problems


def _list_pieces(origin: Origin, results: Results) -> Iterator[Record]:
    works = {
        index: (entry, work) for entry in results.schedule.rows for work in entry.works for index in work.item_indices
    }
    for one in results:
        yield {
            "path": origin.path,
            "inventory": origin.inventory,
            **{name: getattr(one.item, name) for name in _OF_ITEM},
            "assumed": join(one.item.assumed),
            "route": join(one.routes),
            **_describe_risk(one),
            **_describe_work(works.get(one.item.index)),
            "quantity_low": None if origin.low is None else origin.low[one.item.item],
            "quantity_high": None if origin.high is None else origin.high[one.item.item],
        }


_OF_ITEM = (
    "item", "floor", "room", "description", "type", "quantity", "breadth_cm", "width_cm", "height_cm", "anchored",
    "is_held", "importance", "row",
)  # fmt: skip


def join(names: Iterable[str]) -> str:
    """Return names as one text, separated by semicolons."""
    return "; ".join(names)


def _describe_risk(one: ItemResult) -> Record:
    motion, adopted = one.governing.motion, one.adopted
    return {
        "axis": motion.axis,
        "pfa_g": motion.pfa_g,
        "pfv_cm_s": motion.pfv_cm_s,
        "pfa_source": motion.source,
        "basis": adopted.basis,
        "probability": adopted.probability,
        "probability_low": adopted.low,
        "probability_high": adopted.high,
        "risk_class": adopted.risk.word,
        "risk_class_upper": adopted.upper.word,
        "flags": join(adopted.flags),
    }


def _describe_work(found: "tuple[ScheduleRow, WorkRow] | None") -> Record:
    if found is None:
        return {}
    entry, work = found
    return {"work_place": entry.place, "detail": DETAILS[work.detail].title, "unit_cost": work.unit_cost}


def _list_routes(path: str, results: Results) -> Iterator[Record]:
    """Yield the routes; one has a range only where simulation gave it one, as a range of no width would look exact."""
    tables = results.route_tables
    for one in tables.routes:
        blocked = None if one.state is RouteState.NOT_KNOWN else one.blocked
        ranged = blocked if results.main_basis == SIMULATED and blocked and blocked.low < blocked.high else None
        yield {
            "path": path,
            "route": one.route,
            "state": one.state.value,
            "probability": None if blocked is None else blocked.probability,
            "probability_low": None if ranged is None else ranged.low,
            "probability_high": None if ranged is None else ranged.high,
            "occupants": count_people(tables, one),
            "blockers": join(_list_blockers(tables, one)),
            "to_fill_in": say_missing(one.missing),
        }


def _list_blockers(tables: RouteTables, route: RouteRow) -> list[str]:
    """Return the pieces that may block a route, the likeliest first."""
    chances: dict[str, float] = {}
    for at in route.segment_indices:
        for near in tables.segments[at].pieces:
            chance = 1.0 if near.falls_while_blocked is None else near.falls_while_blocked
            chances[near.item] = max(chance, chances.get(near.item, 0.0))
    able = [(-chance, item) for item, chance in chances.items() if chance > 0]
    return [item for _chance, item in sorted(able)[:MOST_BLOCKERS]]


def list_problems(path: str, problems: Sequence[Problem]) -> Iterator[Record]:
    """Yield the problems of a building, those of one habit as one, errors first."""
    from assess.workbook.habits import group_problems

    order = {"error": 0, "warning": 1, "note": 2}
    shown = sorted(group_problems(problems), key=lambda one: order[one.severity])
    for one in shown[:MOST_PROBLEMS]:
        yield {
            "path": path,
            "severity": one.severity,
            "sheet": one.sheet,
            "cell": one.cell,
            "message": one.message,
            "fix": one.fix,
        }
    if len(shown) > MOST_PROBLEMS:
        left = len(shown) - MOST_PROBLEMS
        more = fill("and {left:,} more problems; `assess check` lists them all.", left=left)
        yield {"path": path, "severity": "note", "message": more}
