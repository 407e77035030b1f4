"""From the arrays of an assessment to the rows of `assess.results`: the edge, where units are put into names."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, fields, replace
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from assess.annual_results import AnnualWays
from assess.methods import Example, simulation
from assess.methods.simulate import LOOKS, draw_body, interval_width
from assess.model import AXES, Item
from assess.motion.record import treatment
from assess.motion.scenario import PROFILES
from assess.motion.spatial_field import SCATTERS
from assess.pipeline.adopt import SIMULATED, Assessment
from assess.pipeline.anchors import build_anchors, find_anchor_code
from assess.pipeline.demand import Demand, find_shaking, find_site
from assess.pipeline.remarks import remark_on_shaking
from assess.results import (
    CaseTable,
    DrawTable,
    EarthquakeDraws,
    EnsembleRow,
    FloorRow,
    ItemRow,
    MotionRow,
    Provenance,
    Results,
    Series,
    SuiteInfo,
    WorkedMethod,
)
from assess.routes.walls import find_walls
from assess.units import ACCELERATION, FORCE, LENGTH, VELOCITY, to_edge
from assess.version import __version__, find_code, versions

if TYPE_CHECKING:
    from assess.route_results import RouteTables

_FACTORS: Mapping[str, float] = {**LENGTH, **ACCELERATION, **VELOCITY, **FORCE}


def edge(value: float | None, unit: str) -> float | None:
    """Convert an SI value to a unit of the edge; None for what is unknown."""
    return None if value is None or value != value else to_edge(value, _FACTORS[unit])


def _sure(value: float, unit: str) -> float:
    return to_edge(value, _FACTORS[unit])


_Row = TypeVar("_Row")


def _copy(row: type[_Row], source: Any, **own: Any) -> _Row:
    """Return a row of what `source` has under the names of its fields, and of its own."""
    return row(**{name: getattr(source, name) for name in _shared(row, type(source)) if name not in own}, **own)


def _shared(row: Any, source: type) -> list[str]:
    names = [one.name for one in fields(row)]
    return [name for name in names if hasattr(source, name) or name in source.__annotations__]


def build_rows(assessment: Assessment, demands: Sequence[Demand], folder: Path, routes: "RouteTables") -> Results:
    """Return the results but for their schedule; `folder` is that of their series."""
    inventory, example = assessment.inventory, choose_example(assessment)
    shaking = remark_on_shaking(inventory, assessment.filled, assessment.scenario)
    place = {demand: index for index, demand in enumerate(demands)}
    falls = assessment.find_falls()
    draws, is_known = min((one.size for one in falls.fell.values()), default=0), falls.stands.copy()
    fell = np.zeros((len(inventory.items), draws), dtype=np.bool_)
    for item, one in falls.fell.items():
        fell[item], is_known[item] = one[:draws], True
    return Results(
        settings=assessment.settings, provenance=build_provenance(assessment), building=inventory.building,
        floor_rows=tuple(
            _copy(
                FloorRow, floor, elevation_m=floor.elevation, cells=dict(floor.cells),
                plan=None if floor.plan is None else replace(floor.plan, content=b""),
            )
            for floor in inventory.floors
        ),
        motions=build_motions(assessment, demands), item_rows=build_items(assessment, routes),
        cases_table=CaseTable(  # every pair of piece and motion with what each method gives
            item=assessment.case_item.astype(np.int32),
            motion=np.array([place[demand] for demand in assessment.case_demand], dtype=np.int32),
            outcomes={key: replace(outcome, joints=()) for key, outcome in assessment.outcomes.items()},
            adopted=asdict(assessment.adoption),
        ),
        route_tables=routes, annual=None if assessment.annual is None else assessment.annual.tables,
        places=inventory.places, catalogue=inventory.catalogue, problem_rows=assessment.problems,
        underestimates=tuple(one.message for one in shaking if one.severity == "warning"),
        methods=tuple(one.info for one in assessment.methods),
        texts=tuple((one.section, one.text) for one in inventory.texts),
        worked=() if example is None else tuple(work_example(example, assessment)), worked_item=example,
        series=Series(folder / "series.npz"), draws=DrawTable(draws, np.packbits(fell, axis=1), is_known),
        size_falls=find_size_falls(assessment),
    )  # fmt: skip


def find_size_falls(assessment: Assessment) -> tuple[float, float] | None:
    """Return the expected falls with all pieces of catalogue sizes broader, then narrower, than the Catalogue has them.

    Each such piece counts with the third of its own draws in which it is the stoutest, or the most slender.
    """
    cases, items, settings = assessment.cases, assessment.inventory.items, assessment.settings
    if settings.ideal or not cases.uncertainty.piece:
        return None
    fell, counted = assessment.find_falls().fell, assessment.adoption.basis == SIMULATED
    held, ends, has_any = 0.0, [0.0, 0.0], False
    for at, case in enumerate(assessment.governing.tolist()):
        if assessment.held[at] or not counted[case]:
            continue
        if at not in fell or not {"breadth", "height"} & set(items[at].assumed):
            held += items[at].quantity * float(assessment.adoption.probability[case])
            continue
        has_any, runs = True, fell[at].size
        body = draw_body(cases, np.array([case]), settings.seed, 0, runs)
        order = np.argsort(-(body.breadth / (body.height * body.centre))[0], kind="stable")
        third = max(1, runs // 3)
        for end, draws in enumerate((order[:third], order[-third:])):
            ends[end] += items[at].quantity * float(fell[at][draws].mean())
    return (held + ends[0], held + ends[1]) if has_any else None


def list_demands(assessment: Assessment) -> list[Demand]:
    """Return the motions of every floor, along X and then along Y: the order of `Results.motions`."""
    return [
        demand
        for floor in assessment.inventory.floors
        for axis in AXES
        for demand in assessment.demands[floor.floor, axis]
    ]


def build_motions(assessment: Assessment, demands: Sequence[Demand]) -> tuple[MotionRow, ...]:
    """Return a row for each motion, with what its record says and what pieces were simulated under."""
    names, joints = ("format", "station", "location", "channel", "event", "azimuth_deg", "corrected"), assessment.joints
    overturned, rows = assessment.outcomes[simulation().key].detail["record_overturned"], []
    for index, demand in enumerate(demands):
        record, more = demand.record, dict[str, Any]()
        if record is not None:
            more = {name: getattr(record, name) for name in names} | {
                "pfa_file_g": edge(record.file_pfa, "g"), "time_step_s": record.time_step,
                "samples": len(record.acceleration), "treatment": treatment(record), "notes": tuple(record.notes),
            }  # fmt: skip
        if demand in joints:
            joint = joints[demand]
            ensemble, fell = assessment.cases.ensembles[joint.ensemble], overturned[joint.cases].astype(np.float64)
            known = fell[~np.isnan(fell)]
            more["ensemble"] = EnsembleRow(
                motions=int(joint.runs.max()), least_motions=int(joint.runs.min()), assumed_motion=ensemble.is_assumed,
                unknown_building=ensemble.is_unknown, weak_motions=joint.is_weak, is_generated=assessment.suite is None,
                cases=int(joint.cases.size), fell_in_record=int(known.sum()) if known.size else None, fit=joint.fit,
                signs=ensemble.signs, bands=joint.bands,
            )  # fmt: skip
        row = _copy(
            MotionRow,
            demand,
            index=index, floor=demand.floor.floor, pfa_g=_sure(demand.pfa, "g"), pfv_cm_s=edge(demand.pfv, "cm/s"),
            record=demand.name, pfv_follows=demand.drawn is not None and demand.drawn.target.meets != "peaks",
            **more,
        )  # fmt: skip
        rows.append(row)
    return tuple(rows)


def build_items(assessment: Assessment, routes: "RouteTables") -> tuple[ItemRow, ...]:
    """Return a row for each row of furniture."""
    inventory = assessment.inventory
    firsts = np.searchsorted(assessment.case_item, np.arange(len(inventory.items) + 1)).tolist()
    annual = {} if assessment.annual is None else assessment.annual.items
    named: dict[int, dict[str, None]] = {}  # the routes of which a piece reaches a segment, the one that it names first
    for at, item in enumerate(inventory.items):
        named[at] = {item.route: None} if item.route else {}
    for segment in routes.segments:
        for piece in segment.pieces:
            named[piece.item_index][segment.route] = None
    governing = assessment.governing.tolist()
    walls, held = find_walls(inventory), assessment.held.tolist()
    shared = [name for name in _shared(ItemRow, Item) if name not in ("assumed", "extra")]
    read = attrgetter(*shared)
    anchors, rows = build_anchors(inventory, assessment.cases, assessment.governing, assessment.settings), []
    for index, (item, anchor) in enumerate(zip(map(inventory.complete, inventory.items), anchors, strict=True)):
        row = ItemRow(
            **dict(zip(shared, read(item), strict=True)),
            index=index, breadth_cm=_sure(item.breadth, "cm"), width_cm=edge(item.width, "cm"),
            height_cm=_sure(item.height, "cm"), weight_kg=item.weight, breadth_to_height=item.breadth / item.height,
            axis_given=item.axis, x_m=item.x, y_m=item.y, edge_distance_m=item.edge_distance,
            assumed=tuple(item.assumed), extra=tuple(item.extra), routes=tuple(named[index]),
            governing=governing[index], first_case=firsts[index], last_case=firsts[index + 1], anchor=anchor,
            is_held=held[index], falls_toward_deg=walls[index].falls_toward if index in walls else None,
            annual=annual.get(index),
        )  # fmt: skip
        rows.append(row)
    return tuple(rows)


def add_annual(tables: "RouteTables", ways: AnnualWays) -> "RouteTables":
    """Return the tables of routes with how often a year routes are blocked and rooms lose every exit."""
    fail = ways.routes_if_anchors_fail
    return replace(
        tables,
        routes=tuple(
            replace(one, annual=ways.routes.get(one.route), annual_if_anchors_fail=fail.get(one.route))
            for one in tables.routes
        ),
        rooms=tuple(replace(one, annual=ways.rooms.get(one.room)) for one in tables.rooms),
    )


def choose_example(assessment: Assessment) -> int | None:
    """Return the index of the piece that is worked through: the worst that is free-standing and simulated.

    A free-standing piece comes before a simulated one, and that before one of a higher risk; None of no pieces.
    """
    items = assessment.inventory.items
    if not items:
        return None
    firsts, governing = np.searchsorted(assessment.case_item, np.arange(len(items))), assessment.governing
    upper = np.maximum.reduceat(assessment.adoption.upper, firsts)
    is_simulated = ~np.isnan(assessment.outcomes[simulation().key].value[governing])
    return int(np.lexsort((-assessment.adoption.probability[governing], -upper, ~is_simulated, assessment.held))[0])


def work_example(index: int, assessment: Assessment) -> Iterator[WorkedMethod]:
    """Yield the calculation of every method that was evaluated for a piece, under the motion that governs it."""
    item, case = assessment.inventory.items[index], int(assessment.governing[index])
    demand, restitution = assessment.case_demand[case], assessment.inventory.building.restitution
    for method in assessment.methods:
        outcome = assessment.outcomes[method.key]
        value = float(outcome.value[case])
        if method.steps is None or math.isnan(value):
            continue
        example = Example(
            breadth=to_edge(item.breadth, LENGTH["cm"]), height=to_edge(item.height, LENGTH["cm"]),
            pfa=demand.pfa / ACCELERATION["cm/s2"], pfv=demand.pfv / VELOCITY["cm/s"], centre=item.centre_of_gravity,
            restitution=math.nan if restitution is None else restitution, settings=assessment.settings, value=value,
            detail={name: array[case].item() for name, array in outcome.detail.items()},
            flags=tuple(flag for flag, array in outcome.flags.items() if array[case]),
        )  # fmt: skip
        yield WorkedMethod(method.key, tuple(method.steps(example)), value)


def build_provenance(assessment: Assessment) -> Provenance:
    """Return what the run is made again from."""
    inventory, demands, suite = assessment.inventory, assessment.demands, assessment.suite
    spread = max((one.dispersion for parallel in demands.values() for one in parallel), default=0.0)
    drawn, ground = assessment.cases.earthquakes, inventory.site_ground
    earthquakes = None  # how draws depend on the place and on scenarios
    if assessment.settings.city or drawn.given:
        earthquakes = EarthquakeDraws(
            is_city=assessment.settings.city, is_placed=drawn.place is not None, shared=drawn.shared,
            is_shared_given=ground is not None and ground.shared is not None, measure=drawn.measure,
            range_km=SCATTERS[drawn.measure].range_km, scenarios=len(drawn.given), scenario_share=drawn.given_share,
        )  # fmt: skip
    return Provenance(
        version=__version__, code=find_code(),
        platform=versions(has_rocked=bool(assessment.joints), has_routes=bool(inventory.routes)),
        workbook=inventory.file_name, sha256=inventory.sha256, files=dict(inventory.files),
        scenario=assessment.scenario, anchor_code=find_anchor_code(assessment.inventory, assessment.settings),
        uncertainty=replace(assessment.cases.uncertainty, motion=spread),
        earthquakes=earthquakes, shaking=find_shaking(demands), site_ground=find_site(demands),
        suite=None if suite is None else SuiteInfo(
            folder=suite.folder, names=tuple(name for name, _ in suite.motions), files=dict(suite.files),
            is_scaled=assessment.settings.scale_motions,
            pfa_g=tuple(_sure(motion.pfa, "g") for _, motion in suite.motions),
            pfv_cm_s=tuple(_sure(motion.pfv, "cm/s") for _, motion in suite.motions),
        ),
        language=inventory.report_language, sheets=dict(inventory.sheets),
        letters={sheet: dict(letters) for sheet, letters in inventory.letters.items()},
        extra_columns=tuple(inventory.extra_columns), interval_z=interval_width(assessment.settings), looks=LOOKS,
        profiles=tuple(PROFILES.values()),
    )  # fmt: skip
