"""What a run found of one building, as rows of the tables of a portfolio."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from assess.details import DETAILS
from assess.errors import Problem
from assess.i18n import fill
from assess.model import Inventory
from assess.pipeline.draw_sums import SIMULATED, DrawSums, count_people
from assess.pipeline.known_ground import find_ground
from assess.portfolio.sources import Source
from assess.portfolio.table_schemas import CLASS_COLUMNS, STATE_COLUMNS, TABLES
from assess.report.counts import count
from assess.report.say.ground import uses_scatter
from assess.report.say.route import say_missing
from assess.results import Results
from assess.risk import find_ends
from assess.route_results import RouteState
from assess.units import to_edge
from assess.workbook.schema import BUILDING, USES

Record = dict[str, Any]
OWN_MOTIONS = ("record", "given")  # sources of a floor's motion that are not of the ground motion of the run
MOST_PROBLEMS = 200  # problems of one building that the tables hold; the rest is counted
MOST_BLOCKERS = 20  # pieces that a route names


@dataclass(frozen=True, slots=True, kw_only=True)
class Origin:
    """Where the pieces of a building come from, one of `INVENTORIES`.

    `low` and `high` are the 10 % and 90 % quantities of an assumed inventory by item, `left_out` the components of a
    handover file that may be furniture and were left out.
    """

    inventory: str
    low: Mapping[str, int] | None = None
    high: Mapping[str, int] | None = None
    left_out: int | None = None


def build_tables(
    source: Source, origin: Origin, inventory: Inventory, results: Results, sums: DrawSums
) -> dict[str, list[list[Any]]]:
    """Return the rows of the tables buildings, pieces, routes and problems."""
    path, tables = source.path, results.route_tables
    works = {
        index: {"work_place": entry.place, "detail": DETAILS[work.detail].title, "unit_cost": work.unit_cost}
        for entry in results.schedule.planned
        for work in entry.works
        for index in work.item_indices
    }
    pieces: list[Record] = [
        {
            "path": path, "inventory": origin.inventory, "one": one,
            **works.get(one.item.index, {}),
            "quantity_low": None if origin.low is None else origin.low[one.item.item],
            "quantity_high": None if origin.high is None else origin.high[one.item.item],
        }
        for one in results
    ]  # fmt: skip
    routes: list[Record] = []
    for one in tables.routes:
        blocked = None if one.state is RouteState.NOT_KNOWN else one.blocked
        chances: dict[str, float] = {}
        for near in (near for at in one.segment_indices for near in tables.segments[at].pieces):
            chance = 1.0 if near.falls_while_blocked is None else near.falls_while_blocked
            chances[near.item] = max(chance, chances.get(near.item, 0.0))
        likeliest = sorted((-chance, item) for item, chance in chances.items() if chance > 0)
        # only simulation gives a range, and one of no width would look exact
        is_ranged = results.main_basis == SIMULATED and blocked and blocked.low < blocked.high
        routes.append({
            "path": path, "one": one, "chance": blocked, "range": blocked if is_ranged else None,
            "occupants": count_people(tables, one), "to_fill_in": say_missing(one.missing),
            "blockers": [item for _chance, item in likeliest[:MOST_BLOCKERS]],
        })  # fmt: skip
    return {
        "buildings": [to_row("buildings", _describe_building(source, origin, inventory, results, sums))],
        "pieces": [to_row("pieces", one) for one in pieces],
        "routes": [to_row("routes", one) for one in routes],
        "problems": list_problems(path, results.problem_rows),
    }


def build_skipped(source: Source, problems: Sequence[Problem]) -> dict[str, list[list[Any]]]:
    """Return the rows of a building that could not be assessed, with the reasons."""
    record: Record = {
        "path": source.path, "status": "skipped", "inventory": "assumed" if source.kind == "assumed" else None,
        "warnings": sum(one.severity == "warning" for one in problems),
    }  # fmt: skip
    if source.index is not None:
        use = spell_use(source.index.use)
        record |= {"index": source.index, "site": source.index.as_building(), "use": use}
    rows = {"buildings": [to_row("buildings", record)], "problems": list_problems(source.path, problems)}
    return {name: rows.get(name, []) for name in ("buildings", "pieces", "routes", "problems")}


def spell_use(text: str) -> str:
    """Return a use as the drop-down of the workbook offers it, where it is one of those but for letter case."""
    return _USES.get(text.strip().casefold(), text)


_USES = {use.casefold(): use for use in USES}


def to_row(name: str, record: Record) -> list[Any]:
    """Return a record as a row of a table: plain values in the order of its columns, None for what is not known."""
    unknown = set(record) - {field.source.partition(".")[0] for field in TABLES[name]}
    if unknown:
        raise ValueError(f"the table {name} has no column {', '.join(sorted(unknown))}")
    row: list[Any] = []
    for field in TABLES[name]:
        value = field.read(record)
        if value is None or (isinstance(value, str | tuple | list) and not value):
            row.append(None)
        elif field.kind == "text":
            row.append("; ".join(value) if isinstance(value, tuple | list) else str(value))
        elif field.kind == "number":
            row.append(float(value) if math.isfinite(float(value)) else None)
        else:
            row.append(bool(value) if field.kind == "flag" else int(value))
    return row


def _describe_building(
    source: Source, origin: Origin, inventory: Inventory, results: Results, sums: DrawSums
) -> Record:
    site, rows, routes = inventory.building, tuple(results), results.route_tables
    counts, works = count("", rows), [work for entry in results.schedule.planned for work in entry.works]
    is_any_known = any(one.state is not RouteState.NOT_KNOWN and one.blocked is not None for one in routes.routes)
    people = [one for one in (count_people(routes, route) for route in routes.routes) if one is not None]
    low, high = (None, None) if sums.falls is None else find_ends(sums.falls)
    on_site, ground = inventory.site_ground, find_ground(inventory)
    shaken_by, pga, pgv, distance = "", ground.pga, ground.pgv, None
    if site.ground_pga is None and site.sds is None and on_site is not None:
        shaken_by, pga, pgv = on_site.kind, on_site.pga, on_site.pgv
        distance = on_site.distance if shaken_by == "scenarios" else None
    elif pga is not None and ground.shaking is not None:
        shaken_by, pgv = "shaking", ground.shaking.pgv
    elif pga is not None:
        shaken_by = "sds" if ground.is_from_sds else "ground_pga"

    def expect(quantities: Mapping[str, int] | None) -> float | None:
        if quantities is None:
            return None
        main = [one for one in rows if not one.is_anchored and not one.apart]
        return math.fsum(one.adopted.probability * quantities[one.item.item] for one in main)

    return {
        "path": source.path, "status": "assessed", "inventory": origin.inventory, "origin": origin,
        "index": source.index, "site": site, "counts": counts, "results": results, "sums": sums,
        "use": spell_use(site.use),
        "ground_source": shaken_by,
        "ground_distance_km": None if distance is None else distance / 1000,
        "ground_pga_g": None if pga is None else to_edge(pga, BUILDING.column("ground_pga").factor),
        "ground_pgv_cm_s": None if pgv is None else to_edge(pgv, BUILDING.column("ground_pgv").factor),
        "own_motions": len({one.floor for one in results.motions if one.source in OWN_MOTIONS}),
        "largest_pfa_g": max((one.pfa_g for one in results.motions), default=None),
        "motion_uncertainty": results.provenance.uncertainty.motion if uses_scatter(results) else None,
        "is_placed": site.latitude is not None and site.longitude is not None,
        **{name: counts.by_class[risk] for risk, name in CLASS_COLUMNS.items()},
        "falls_low_inventory": expect(origin.low), "falls_high_inventory": expect(origin.high),
        "draws": 0 if sums.falls is None else len(sums.falls),
        "falls_p05": low, "falls_p95": high,
        "falls_avoided": math.fsum(entry.falls_avoided for entry in results.schedule.planned),
        "works": sum(one.pieces for one in works),
        "works_without_cost": sum(one.pieces for one in works if one.cost is None),
        "routes": len(routes.routes),
        **{name: sum(one.state is state for one in routes.routes) for state, name in STATE_COLUMNS.items()},
        "occupants": sum(people) if people else None,
        "people_blocked": sums.people_expected if is_any_known else None,
        "warnings": sum(one.severity == "warning" for one in results.problem_rows),
    }  # fmt: skip


def list_problems(path: str, problems: Sequence[Problem]) -> list[list[Any]]:
    """Return the problems of a building as rows, those of one habit as one, errors first."""
    from assess.workbook.habits import group_problems

    order = {"error": 0, "warning": 1, "note": 2}
    shown = sorted(group_problems(problems), key=lambda one: order[one.severity])
    if (left := len(shown) - MOST_PROBLEMS) > 0:
        text = fill("and {left:,} more problems; `assess check` lists them all.", left=left)
        shown[MOST_PROBLEMS:] = [Problem("note", "", "", text)]
    return [to_row("problems", {"path": path, "one": one}) for one in shown]
