"""From the arrays of an assessment to the rows of `assess.results`: the edge, where units are put into names."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from typing import TYPE_CHECKING

import numpy as np

from assess.annual_results import AnnualWays
from assess.methods import Joint, simulation
from assess.methods.simulate import LOOKS, interval_width
from assess.model import AXES, Floor, FloorPlan, Inventory, Item
from assess.motion.record import Record, treatment
from assess.motion.scenario import PROFILES, UNVERIFIED, VERIFIED, Profile
from assess.pipeline.adopt import build_falls
from assess.pipeline.anchors import Anchors
from assess.pipeline.assessment import Assessment
from assess.pipeline.city_draws import describe_draws
from assess.pipeline.demand import find_shaking
from assess.pipeline.floor_demand import Demand, Demands
from assess.pipeline.remarks import describe_site
from assess.pipeline.versions import versions
from assess.results import (
    AssumedShaking,
    CaseTable,
    DrawTable,
    EnsembleRow,
    FitRow,
    FloorRow,
    ItemRow,
    MotionRow,
    PlanRow,
    ProfileInfo,
    Provenance,
    SuiteInfo,
)
from assess.routes.chances import Falls
from assess.routes.walls import find_walls
from assess.units import ACCELERATION, FORCE, LENGTH, VELOCITY, to_edge
from assess.version import __version__, find_code

if TYPE_CHECKING:
    from assess.motion.suite import Suite
    from assess.motion.target_fit import Fit
    from assess.route_results import RouteTables

_FACTORS: Mapping[str, float] = {**LENGTH, **ACCELERATION, **VELOCITY, **FORCE}


def edge(value: float | None, unit: str) -> float | None:
    """Convert an SI value to a unit of the edge; None for what is unknown."""
    return None if value is None or value != value else to_edge(value, _FACTORS[unit])


def _sure(value: float, unit: str) -> float:
    return to_edge(value, _FACTORS[unit])


# ---------------------------------------------------------------- floors and their motions


def build_floor(floor: Floor) -> FloorRow:
    """Return the row of a floor."""
    return FloorRow(
        row=floor.row, floor=floor.floor, name=floor.name, elevation_m=floor.elevation, cells=dict(floor.cells),
        plan=None if floor.plan is None else _plan(floor.plan),
    )  # fmt: skip


def _plan(plan: FloorPlan) -> PlanRow:
    return PlanRow(
        file=plan.path.name,
        is_lines=plan.is_lines,
        left_m=plan.left,
        bottom_m=plan.bottom,
        width_m=plan.width,
        height_m=plan.height,
        turn_deg=plan.turn_deg,
    )


def list_demands(assessment: Assessment) -> list[Demand]:
    """Return the motions of every floor, along X and then along Y: the order of `Results.motions`."""
    return [
        demand
        for floor in assessment.inventory.floors
        for axis in AXES
        for demand in assessment.demands[floor.floor, axis]
    ]


def build_motions(assessment: Assessment, demands: Sequence[Demand]) -> tuple[MotionRow, ...]:
    """Return a row for each motion, with what pieces were simulated under."""
    joints, rows = assessment.joints, []
    for index, demand in enumerate(demands):
        row = build_motion(index, demand)
        joint = joints.get(demand)
        rows.append(row if joint is None else replace(row, ensemble=_ensemble(assessment, joint)))
    return tuple(rows)


def build_motion(index: int, demand: Demand) -> MotionRow:
    """Return the row of one motion."""
    row = MotionRow(
        index=index,
        floor=demand.floor.floor,
        axis=demand.axis,
        source=demand.source,
        label=demand.label,
        pfa_g=_sure(demand.pfa, "g"),
        pfv_cm_s=edge(demand.pfv, "cm/s"),
        flags=demand.flags,
        between=demand.between,
        profile=describe_profile(demand.profile) if demand.profile else None,
        clause=demand.clause,
        height_ratio=demand.height_ratio,
        amplification=demand.amplification,
        record=demand.name,
        pfv_follows=demand.drawn is not None and demand.drawn.target.meets != "peaks",
        dispersion=demand.dispersion,
    )
    return row if demand.record is None else _add_record(row, demand.record)


def _add_record(row: MotionRow, record: Record) -> MotionRow:
    return replace(
        row,
        pfa_file_g=edge(record.file_pfa, "g"),
        format=record.format,
        station=record.station,
        location=record.location,
        channel=record.channel,
        event=record.event,
        azimuth_deg=record.azimuth_deg,
        corrected=record.corrected,
        time_step_s=record.time_step,
        samples=len(record.acceleration),
        treatment=treatment(record),
        notes=tuple(record.notes),
    )


def describe_profile(profile: Profile) -> ProfileInfo:
    """Return the description of a code's profile."""
    return ProfileInfo(
        key=profile.key,
        title=profile.title,
        clause=profile.clause,
        clause_without_period=profile.clause_without_period,
        equation=profile.equation,
        reference=profile.reference,
        verified=profile.verified,
        status=VERIFIED if profile.verified else UNVERIFIED,
        remark=profile.remark,
        reduced=profile.reduced,
    )


def _ensemble(assessment: Assessment, joint: Joint) -> EnsembleRow:
    ensemble = assessment.cases.ensembles[joint.ensemble]
    fell = assessment.outcomes[simulation().key].detail["record_overturned"][joint.cases].astype(np.float64)
    known = fell[~np.isnan(fell)]
    return EnsembleRow(
        motions=int(joint.runs.max()),
        least_motions=int(joint.runs.min()),
        assumed_motion=ensemble.is_assumed,
        unknown_building=ensemble.is_unknown,
        weak_motions=joint.is_weak,
        is_generated=assessment.suite is None,
        cases=int(joint.cases.size),
        fell_in_record=int(known.sum()) if known.size else None,
        fit=None if joint.fit is None else _fit(joint.fit),
        signs=ensemble.signs,
        bands=joint.bands,
    )


def _fit(fit: "Fit") -> FitRow:
    return FitRow(
        matched_to_s=fit.matched_to,
        mean_deviation=fit.mean_deviation,
        worst_deviation=fit.worst_deviation,
        worst_period_s=fit.worst_period,
        pfa_ratio=fit.pfa_ratio,
        pfa_scatter=fit.pfa_scatter,
        pfv_ratio=fit.pfv_ratio,
        pfv_scatter=fit.pfv_scatter,
        spectrum_scatter=fit.spectrum_scatter,
    )


# ---------------------------------------------------------------- furniture


def build_items(assessment: Assessment, routes: "RouteTables") -> tuple[ItemRow, ...]:
    """Return a row for each row of furniture."""
    inventory = assessment.inventory
    firsts = np.searchsorted(assessment.case_item, np.arange(len(inventory.items) + 1)).tolist()
    annual = {} if assessment.annual is None else assessment.annual.items
    governing, named = assessment.governing.tolist(), _list_routes(inventory, routes)
    toward = {at: wall.falls_toward for at, wall in find_walls(inventory).items()}
    anchors = assessment.anchors
    rows = (
        _item(
            inventory.complete(item),
            index,
            anchors,
            governing[index],
            (firsts[index], firsts[index + 1]),
            named.get(index),
        )
        for index, item in enumerate(inventory.items)
    )
    return tuple(replace(row, falls_toward_deg=toward.get(row.index), annual=annual.get(row.index)) for row in rows)


def _item(
    item: Item, index: int, anchors: Anchors, governing: int, cases: tuple[int, int],
    routes: tuple[str, ...] | None,
) -> ItemRow:  # fmt: skip
    return ItemRow(
        index=index,
        row=item.row,
        item=item.item,
        floor=item.floor,
        room=item.room,
        description=item.description,
        type=item.type,
        quantity=item.quantity,
        breadth_cm=_sure(item.breadth, "cm"),
        width_cm=edge(item.width, "cm"),
        height_cm=_sure(item.height, "cm"),
        centre_of_gravity=item.centre_of_gravity,
        weight_kg=item.weight,
        breadth_to_height=item.breadth / item.height,
        axis_given=item.axis,
        angle_deg=item.angle_deg,
        against_wall=item.against_wall,
        sizes_from=item.sizes_from,
        x_m=item.x,
        y_m=item.y,
        friction=item.friction,
        importance=item.importance,
        anchored=item.anchored,
        route=item.route,
        segment=item.segment,
        edge_distance_m=item.edge_distance,
        notes=item.notes,
        assumed=tuple(item.assumed),
        extra=tuple(item.extra),
        more=item.more,
        routes=routes if routes is not None else (item.route,) if item.route else (),
        governing=governing,
        first_case=cases[0],
        last_case=cases[1],
        anchor=anchors.describe(index),
        is_held=bool(anchors.held[index]),
    )


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


def _list_routes(inventory: Inventory, routes: "RouteTables") -> Mapping[int, tuple[str, ...]]:
    """Return the routes of which a piece reaches a segment, by its index: that which it names first."""
    found: dict[int, dict[str, None]] = {}
    for segment in routes.segments:
        for piece in segment.pieces:
            named = inventory.items[piece.item_index].route
            found.setdefault(piece.item_index, {named: None} if named else {})[segment.route] = None
    return {index: tuple(names) for index, names in found.items()}


def build_cases(assessment: Assessment, demands: Sequence[Demand]) -> CaseTable:
    """Return every pair of piece and motion with what each method gives, as columns."""
    place = {demand: index for index, demand in enumerate(demands)}
    return CaseTable(
        item=assessment.case_item.astype(np.int32),
        motion=np.array([place[demand] for demand in assessment.case_demand], dtype=np.int32),
        outcomes={key: replace(outcome, joints=()) for key, outcome in assessment.outcomes.items()},
        adopted=asdict(assessment.adoption),
    )


def find_falls(assessment: Assessment) -> Falls:
    """Return how the pieces fall, each under its governing motion."""
    return build_falls(
        assessment.inventory, assessment.adoption, assessment.outcomes, assessment.governing, assessment.settings,
        assessment.either_axis, assessment.anchors.held,
    )  # fmt: skip


def build_draws(assessment: Assessment) -> DrawTable:
    """Return in which draws each item falls."""
    falls, count = find_falls(assessment), len(assessment.inventory.items)
    draws = min((one.size for one in falls.fell.values()), default=0)
    fell = np.zeros((count, draws), dtype=np.bool_)
    for item, one in falls.fell.items():
        fell[item] = one[:draws]
    is_known = falls.stands.copy()
    is_known[list(falls.fell)] = True
    return DrawTable(draws, np.packbits(fell, axis=1), is_known)


# ---------------------------------------------------------------- provenance


def build_provenance(assessment: Assessment) -> Provenance:
    """Return what the run is made again from."""
    inventory = assessment.inventory
    return Provenance(
        version=__version__,
        code=find_code(),
        platform=versions(has_rocked=bool(assessment.joints), has_routes=bool(inventory.routes)),
        workbook=inventory.file_name,
        sha256=inventory.sha256,
        files=dict(inventory.files),
        scenario=assessment.scenario,
        uncertainty=replace(
            assessment.cases.uncertainty,
            motion=max((one.dispersion for parallel in assessment.demands.values() for one in parallel), default=0.0),
        ),
        earthquakes=describe_draws(assessment.inventory, assessment.settings, assessment.cases.earthquakes),
        shaking=_describe_shaking(assessment.demands),
        site_ground=describe_site(inventory.building, assessment.demands),
        suite=_suite(assessment.suite, assessment.settings.scale_motions),
        language=inventory.report_language,
        sheets=dict(inventory.sheets),
        letters={sheet: dict(letters) for sheet, letters in inventory.letters.items()},
        extra_columns=tuple(inventory.extra_columns),
        interval_z=interval_width(assessment.settings),
        looks=LOOKS,
        profiles=tuple(map(describe_profile, PROFILES.values())),
    )


def _describe_shaking(demands: Demands) -> AssumedShaking | None:
    shaking = find_shaking(demands)
    if shaking is None:
        return None
    return AssumedShaking(
        choice=shaking.choice,
        name=shaking.name,
        intensity=shaking.intensity,
        pga_g=_sure(shaking.pga, "g"),
        pgv_cm_s=_sure(shaking.pgv, "cm/s"),
        scatter=shaking.scatter,
        is_derived=shaking.is_derived,
        is_open=shaking.is_open,
        sources=shaking.sources,
        references=shaking.references,
    )


def _suite(suite: "Suite | None", is_scaled: bool) -> SuiteInfo | None:
    if suite is None:
        return None
    return SuiteInfo(
        folder=suite.folder,
        names=tuple(name for name, _ in suite.motions),
        files=dict(suite.files),
        is_scaled=is_scaled,
        pfa_g=tuple(_sure(motion.pfa, "g") for _, motion in suite.motions),
        pfv_cm_s=tuple(_sure(motion.pfv, "cm/s") for _, motion in suite.motions),
    )
