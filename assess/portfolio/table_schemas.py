"""The tables of a portfolio: every column once, with its type. Writers and readers follow it, never a file's own types.

A table is the union of the rows of all buildings, in the order of their paths.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from assess.i18n import fill
from assess.risk import RiskClass
from assess.route_results import RouteState

Type = Literal["text", "number", "count", "flag"]
"""text: VARCHAR; number: DOUBLE; count: BIGINT; flag: BOOLEAN. All may be NULL: what is unknown."""

STATUSES = ("assessed", "skipped")
INVENTORIES = ("surveyed", "handover", "assumed")
"""Where the pieces of a building come from: its workbook, a COBie file, or quantities by use and floor area. Sums never
mix them."""

CLASS_COLUMNS: Mapping[RiskClass, str] = {risk: risk.word.replace(" ", "_") for risk in RiskClass}
STATE_COLUMNS: Mapping[RouteState, str] = {state: f"routes_{state.replace(' ', '_')}" for state in RouteState}
"""Columns of the table buildings that count pieces by class, and routes by state."""

MADE_UP = "(made up)"
"""What the names of the buildings of the worked city end with."""


@dataclass(frozen=True, slots=True)
class TableColumn:
    """One column: its name with the unit, its type, and what it means."""

    name: str
    type: Type
    help: str


def _columns(*rows: tuple[str, Type, str]) -> tuple[TableColumn, ...]:
    return tuple(TableColumn(*row) for row in rows)


TABLES: Mapping[str, tuple[TableColumn, ...]] = {
    "buildings": _columns(
        ("path", "text", fill("the workbook in the folder, or the name of the row of the index without one")),
        ("status", "text", fill("assessed; or skipped, as it could not be assessed: see the table problems")),
        ("building", "text", fill("its name")),
        ("same_as", "text", fill("an earlier building whose workbook has the same content; blank where there is none")),
        ("inventory", "text", fill("where its pieces come from: surveyed, handover (COBie), or assumed")),
        ("latitude", "number", fill("degrees, north positive")),
        ("longitude", "number", fill("degrees, east positive")),
        ("use", "text", fill("its use")),
        ("storeys", "count", fill("storeys above ground")),
        ("height_m", "number", fill("height above the ground")),
        ("floor_area_m2", "number", fill("gross floor area, as the index gives it")),
        ("ground_source", "text", fill("what its ground motion rests on: shakemap, scenarios, ground_pga, sds, shaking, or blank where only its floors have motions")),
        ("ground_pga_g", "number", fill("PGA at its place, the median of a ShakeMap or of scenarios")),
        ("ground_pgv_cm_s", "number", fill("PGV at its place")),
        ("ground_distance_km", "number", fill("distance to the site of the scenarios that gives its ground motion")),
        ("own_motions", "count", fill("floors that keep a record or a PFA of their own")),
        ("largest_pfa_g", "number", fill("largest PFA of its floors")),
        ("motion_uncertainty", "number", fill("standard deviation of ln PFA that was drawn; blank where none was")),
        ("is_placed", "flag", fill("whether latitude and longitude are known; else its draws are fully correlated with those of others without them")),
        ("basis", "text", fill("what its sums rest on: simulated or formula")),
        ("draws", "count", fill("draws of an earthquake; 0 where nothing was simulated")),
        ("pieces", "count", fill("pieces of furniture, quantities counted")),
        ("low", "count", fill("free-standing pieces of the basis by class")),
        ("medium", "count", fill("likewise")),
        ("high", "count", fill("likewise")),
        ("very_high", "count", fill("likewise")),
        ("unconfirmed", "count", fill("pieces whose class is not confirmed: not in the classes")),
        ("by_formula", "count", fill("pieces that were not simulated in a run that simulated others: not in the classes")),
        ("cannot_rock", "count", fill("pieces that are low as they cannot rock: too stocky, or no motion that may be drawn can start them")),
        ("anchored", "count", fill("pieces that count as anchored: not in the classes")),
        ("left_out", "count", fill("components of a handover file that may be furniture and were left out: in no number; see the table problems")),
        ("expected_falls", "number", fill("expected number of pieces that fall, of those in the classes")),
        ("falls_p05", "number", fill("number of falls that 5 % of the draws do not exceed")),
        ("falls_p95", "number", fill("number of falls that 95 % of the draws do not exceed")),
        ("falls_low_inventory", "number", fill("expected falls with the 10 % quantities of an assumed inventory")),
        ("falls_high_inventory", "number", fill("expected falls with its 90 % quantities")),
        ("falls_avoided", "number", fill("expected falls that the work list avoids")),
        ("works", "count", fill("pieces on the work list")),
        ("cost", "number", fill("what the work list costs, as far as the sheet Costs tells")),
        ("works_without_cost", "count", fill("pieces on the work list of which no cost is known")),
        ("routes", "count", fill("evacuation routes")),
        ("routes_open", "count", fill("routes by state")),
        ("routes_doubtful", "count", fill("likewise")),
        ("routes_blocked", "count", fill("likewise")),
        ("routes_not_known", "count", fill("likewise")),
        ("occupants", "count", fill("people on its routes, as filled in: counted once for each route")),
        ("people_not_known", "count", fill("those of them on routes whose state is not known: in no other number")),
        ("people_blocked", "number", fill("expected number of people whose route is blocked: counted once for each route, of those that are known; blank where none is")),
        ("warnings", "count", fill("warnings in the table problems")),
    ),
    "pieces": _columns(
        ("path", "text", fill("the building")),
        ("item", "text", fill("name of the row of Items")),
        ("floor", "text", fill("its floor")),
        ("room", "text", fill("its room")),
        ("description", "text", fill("as filled in")),
        ("type", "text", fill("its Type")),
        ("inventory", "text", fill("surveyed, handover or assumed")),
        ("quantity", "count", fill("pieces of the row")),
        ("quantity_low", "count", fill("10 % quantity of an assumed inventory")),
        ("quantity_high", "count", fill("90 % quantity of an assumed inventory")),
        ("breadth_cm", "number", fill("its sizes")),
        ("width_cm", "number", fill("likewise")),
        ("height_cm", "number", fill("likewise")),
        ("assumed", "text", fill("fields that were filled in for it, separated by semicolons")),
        ("axis", "text", fill("axis of the governing motion")),
        ("anchored", "text", fill("as filled in")),
        ("is_held", "flag", fill("whether it counts as anchored")),
        ("importance", "text", fill("as filled in")),
        ("pfa_g", "number", fill("of the governing motion")),
        ("pfv_cm_s", "number", fill("likewise")),
        ("pfa_source", "text", fill("where it comes from: record, given, interpolated, profile, beam")),
        ("basis", "text", fill("simulated, formula, unconfirmed or cannot rock")),
        ("probability", "number", fill("chance of overturning in this scenario, of one piece")),
        ("probability_low", "number", fill("its sampling interval")),
        ("probability_high", "number", fill("likewise")),
        ("risk_class", "text", fill("low, medium, high or very high")),
        ("risk_class_upper", "text", fill("by the upper end of the interval")),
        ("flags", "text", fill("separated by semicolons")),
        ("route", "text", fill("routes that it names or can reach, separated by semicolons")),
        ("work_place", "count", fill("its place on the building's work list")),
        ("detail", "text", fill("how to fix it, where it is on the list")),
        ("unit_cost", "number", fill("what that costs a piece")),
        ("row", "count", fill("row of the sheet")),
    ),
    "routes": _columns(
        ("path", "text", fill("the building")),
        ("route", "text", fill("its name")),
        ("state", "text", fill("open, doubtful, blocked or not known")),
        ("probability", "number", fill("chance that it is blocked in this scenario; blank where its state is not known")),
        ("probability_low", "number", fill("its interval; blank where nothing was simulated, or no draw blocks it or all do")),
        ("probability_high", "number", fill("likewise")),
        ("occupants", "count", fill("as filled in")),
        ("blockers", "text", fill("pieces that may block it, the likeliest first, separated by semicolons")),
        ("to_fill_in", "text", fill("what is missing that could change its state")),
    ),
    "problems": _columns(
        ("path", "text", fill("the building")),
        ("severity", "text", fill("error, warning or note")),
        ("sheet", "text", fill("where it is")),
        ("cell", "text", fill("likewise")),
        ("message", "text", fill("what is wrong")),
        ("fix", "text", fill("how to fix it")),
    ),
    "draws": _columns(
        ("path", "text", fill("the building")),
        ("draw", "count", fill("number of the draw: one earthquake for all buildings")),
        ("falls", "count", fill("pieces that fall in it, of those in the classes")),
        ("people_blocked", "count", fill("people whose route is blocked in it, as far as routes have joint outcomes")),
        ("routes_blocked", "count", fill("routes that are blocked in it, likewise")),
    ),
}  # fmt: skip
"""Columns by table."""
