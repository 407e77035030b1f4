"""Every shown field of the schedule, once: its entries, what is to be done of each, and the state before and after.

results.json, its schema, the work list of the Excel report and the tables of the pages derive from the lists below.
"""

from collections.abc import Mapping
from functools import partial
from operator import attrgetter
from typing import Any

from assess.details import DETAILS
from assess.fields import Field, Kind, Shape
from assess.i18n import fill
from assess.risk import RiskClass
from assess.schedule_results import Schedule, ScheduleRow, State, WorkRow


def _of(name: str, kind: Kind = "text", label: str = "", **more: Any) -> Field:
    formats = {"number": "0.00", "count": "#,##0"}
    given: dict[str, Any] = {
        "key": name,
        "read": attrgetter(name),
        "format": formats.get(kind, ""),
        "kind": kind,
        "label": label,
    }
    return Field(**given | more)


def _force(name: str, label: str, short: str, **more: Any) -> Field:
    return _of(name, "number", label, short=short, unit="kN", width=9, **more)


def _count(risk: RiskClass, state: State) -> int:
    return state.count(risk)


WORK_FIELDS = (
    _of("floor", label=fill("Floor"), width=8),
    _of("room", label=fill("Room"), width=16),
    _of("items", "list", fill("Items"), read=lambda one: list(one.items), width=24, help="The most urgent first."),
    _of("pieces", "count", fill("Pieces"), width=7, help="How many pieces they are, quantities counted."),
    _of(
        "detail", label=fill("Detail"), width=20, choices=tuple(DETAILS),
        help="A generic way to fix them: screening, not design.",
    ),
    _force(
        "tension_kn", fill("Tension at PFA"), fill("T at PFA"),
        help="What the fixings of each piece carry together: at the bracket, or, where it is fixed at its base, at the "
        "far edge of the base, on the lever of its breadth.",
    ),
    _force("tension_high_kn", fill("Tension at 84 % of PFA"), fill("T at 84 %")),
    _force(
        "tension_code_kn", fill("Tension by the code"), fill("T by code"), is_optional=True,
        help="For F_p of ASCE 7-22; null where neither SDS nor Ground PGA is known.",
    ),
    _force("shear_kn", fill("Shear at the base"), fill("Shear"), help="Of each piece at PFA."),
    _of(
        "fixings", "count", fill("Fixings each"), width=8,
        help="Of one piece, by the larger of the tensions at 84 % and by the code over the printed capacity of one.",
    ),
    _of(
        "fixings_are_least", "flag", read=attrgetter("is_least"),
        help="Whether they are the least, not a result: no capacity is printed.",
    ),
    _of("weights_assumed", "count", help="Pieces whose weight is an estimate."),
    _of("heights_assumed", "count", help="Pieces whose bracket height is assumed."),
    _of("is_per_metre", "flag", help="Whether forces are those of one metre of a piece, as its width is not known."),
    _of("unit_cost", "number", fill("Unit cost"), width=10, is_optional=True, help="Of one piece, of the sheet Costs."),
    _of("cost", "number", fill("Cost"), width=10, is_optional=True),
    _of("cost_source", label=fill("Source of the cost"), width=24),
)  # fmt: skip
"""Alike pieces of one room that are fixed in the same way."""
_WORK = Shape(WORK_FIELDS)

ENTRY_FIELDS = (
    _of("place", "count", fill("No."), width=5, help="Its place in the order of urgency, from 1."),
    _of("floor", help="Of its most urgent piece."),
    _of("room"),
    _of("pieces", "count"),
    _of("only_together", "flag", read=attrgetter("is_together"), help="Whether fixing some of them opens no route."),
    _of("falls_avoided", "number", fill("Falls avoided"), format="0.000", help="Expected number, if anchors hold."),
    _of(
        "falls_left", "number", fill("Falls left"), format="0.000",
        help="Expected number once it and those before it are fixed.",
    ),
    _of("cost", "number", is_optional=True, help="null where the sheet Costs leaves any part of it open."),
    _of("works", "records", read=lambda one: [_WORK.nest(work) for work in one.works], help="What is to be done."),
)  # fmt: skip
"""One entry of the schedule."""

STATE_FIELDS = (
    _of("falls", "number", fill("Expected falls"), help="Of free-standing pieces of the run's basis."),
    _of("falls_low", "number", is_optional=True, help="Falls that 5 % of the draws do not exceed."),
    _of("falls_high", "number", is_optional=True, help="Falls that 95 % of the draws do not exceed."),
    *(
        Field(
            key=f"pieces_{risk.word.replace(' ', '_')}", path=("pieces", risk.word.replace(" ", "_")), kind="count",
            read=partial(_count, risk),
        )
        for risk in RiskClass
    ),
    _of(
        "pieces_apart", "count", fill("Unconfirmed, or by formula only"), path=("pieces", "apart"),
        read=attrgetter("apart"), help="Unconfirmed, or by formula only where others were simulated.",
    ),
    _of("pieces_anchored", "count", fill("Anchored"), path=("pieces", "anchored"), read=attrgetter("anchored")),
    _of("routes", "records", read=lambda one: dict(one.routes), help="How many there are by their state."),
    _of("blocked_routes_expected", "number", fill("Blocked routes, expected"), read=attrgetter("blocked_routes")),
    _of("cut_off_rooms_expected", "number", fill("Rooms that lose every exit, expected"),
        read=attrgetter("cut_off_rooms")),
    _of("rooms_at_risk", "list", fill("Rooms that may lose every exit"), read=lambda one: list(one.rooms_at_risk),
        help="Their chance of losing every exit is at least the chosen risk, or not known."),
    _of("unknown_routes", "count", fill("Left out of these averages: routes not known"),
        help="Routes that blocked_routes_expected leaves out."),
    _of("unknown_rooms", "count", fill("Left out of these averages: rooms not known"),
        help="Rooms that cut_off_rooms_expected leaves out."),
)  # fmt: skip
"""What is to be expected of the building."""
_ENTRY, _STATE = Shape(ENTRY_FIELDS), Shape(STATE_FIELDS)


def schedule_fields(row: type) -> Mapping[str, Field]:
    """Return the fields of one of the rows of `assess.schedule_results` by their keys."""
    return {one.key: one for one in {WorkRow: WORK_FIELDS, ScheduleRow: ENTRY_FIELDS, State: STATE_FIELDS}[row]}


def to_record(schedule: Schedule) -> dict[str, Any]:
    """Return the content of `schedule` in results.json; its entries are made one by one, as they are asked for."""
    return {
        "entries": map(_ENTRY.nest, schedule.rows),
        "before": _STATE.nest(schedule.before),
        "after": _STATE.nest(schedule.after),
        "cost": schedule.cost,
        "entries_without_cost": schedule.uncosted,
    }
