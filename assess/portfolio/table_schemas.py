"""The tables of a portfolio: every column once, with its type, and where its value stands in what a run found.

Writers and readers follow the types that are given here, never a file's own. A table is the union of the rows of all
buildings, in the order of their paths.
"""

from collections.abc import Mapping

from assess.i18n import fill
from assess.risk import RiskClass
from assess.route_results import RouteState
from assess.table import Field, Kind

STATUSES = ("assessed", "skipped")
INVENTORIES = ("surveyed", "handover", "assumed")
"""Where the pieces of a building come from: its workbook, a COBie file, or quantities by use and floor area. Sums never
mix them."""

CLASS_COLUMNS: Mapping[RiskClass, str] = {risk: risk.word.replace(" ", "_") for risk in RiskClass}
STATE_COLUMNS: Mapping[RouteState, str] = {state: f"routes_{state.replace(' ', '_')}" for state in RouteState}
"""Columns of the table buildings that count pieces by class, and routes by state."""

MADE_UP = "(made up)"  # what the names of the buildings of the worked city end with


def _fields(*rows: tuple[str, Kind, str] | tuple[str, Kind, str, str]) -> tuple[Field, ...]:
    """Columns by key with the unit, kind, what they mean, and where they stand in a record of `building_rows`."""
    return tuple(Field(key=key, kind=kind, help=text, source="".join(source)) for key, kind, text, *source in rows)


TABLES: Mapping[str, tuple[Field, ...]] = {
    "buildings": _fields(
        ("path", "text", fill("the workbook in the folder, or the name of the row of the index without one")),
        ("status", "text", fill("assessed; or skipped, as it could not be assessed: see the table problems")),
        ("building", "text", fill("its name"), "site.building"),
        ("same_as", "text", fill("an earlier building whose workbook has the same content; blank where there is none")),
        ("inventory", "text", fill("where its pieces come from: surveyed, handover (COBie), or assumed")),
        ("latitude", "number", fill("degrees, north positive"), "site.latitude"),
        ("longitude", "number", fill("degrees, east positive"), "site.longitude"),
        ("use", "text", fill("its use")),
        ("storeys", "count", fill("storeys above ground"), "site.storeys"),
        ("height_m", "number", fill("height above the ground"), "site.height"),
        ("floor_area_m2", "number", fill("gross floor area, as the index gives it"), "index.floor_area_m2"),
        ("ground_source", "text", fill("what its ground motion rests on: shakemap, scenarios, ground_pga, sds, shaking, or blank where only its floors have motions")),
        ("ground_pga_g", "number", fill("PGA at its place, the median of a ShakeMap or of scenarios")),
        ("ground_pgv_cm_s", "number", fill("PGV at its place")),
        ("ground_distance_km", "number", fill("distance to the site of the scenarios that gives its ground motion")),
        ("own_motions", "count", fill("floors that keep a record or a PFA of their own")),
        ("largest_pfa_g", "number", fill("largest PFA of its floors")),
        ("motion_uncertainty", "number", fill("standard deviation of ln PFA that was drawn; blank where none was")),
        ("is_placed", "flag", fill("whether latitude and longitude are known; else its draws are fully correlated with those of others without them")),
        ("basis", "text", fill("what its sums rest on: simulated or formula"), "results.main_basis"),
        ("draws", "count", fill("draws of an earthquake; 0 where nothing was simulated")),
        ("pieces", "count", fill("pieces of furniture, quantities counted"), "counts.total"),
        ("low", "count", fill("free-standing pieces of the basis by class")),
        ("medium", "count", fill("likewise")),
        ("high", "count", fill("likewise")),
        ("very_high", "count", fill("likewise")),
        ("unconfirmed", "count", fill("pieces whose class is not confirmed: not in the classes"), "counts.unconfirmed"),
        ("by_formula", "count", fill("pieces that were not simulated in a run that simulated others: not in the classes"), "counts.by_formula"),
        ("rolls", "count", fill("pieces on castors, which no method covers: not in the classes"), "counts.rolls"),
        ("cannot_rock", "count", fill("pieces that are low as they cannot rock: too stocky, or no motion that may be drawn can start them"), "counts.cannot_rock"),
        ("anchored", "count", fill("pieces that count as anchored: not in the classes"), "counts.anchored"),
        ("left_out", "count", fill("components of a handover file that may be furniture and were left out: in no number; see the table problems"), "origin.left_out"),
        ("expected_falls", "number", fill("expected number of pieces that fall, of those in the classes"), "counts.expected"),
        ("falls_p05", "number", fill("number of falls that 5 % of the draws do not exceed")),
        ("falls_p95", "number", fill("number of falls that 95 % of the draws do not exceed")),
        ("falls_low_inventory", "number", fill("expected falls with the 10 % quantities of an assumed inventory")),
        ("falls_high_inventory", "number", fill("expected falls with its 90 % quantities")),
        ("falls_avoided", "number", fill("expected falls that the work list avoids")),
        ("works", "count", fill("pieces on the work list")),
        ("cost", "number", fill("what the work list costs, as far as the sheet Costs tells"), "results.schedule.cost"),
        ("works_without_cost", "count", fill("pieces on the work list of which no cost is known")),
        ("routes", "count", fill("evacuation routes")),
        ("routes_open", "count", fill("routes by state")),
        ("routes_doubtful", "count", fill("likewise")),
        ("routes_blocked", "count", fill("likewise")),
        ("routes_not_known", "count", fill("likewise")),
        ("occupants", "count", fill("people on its routes, as filled in: counted once for each route")),
        ("people_not_known", "count", fill("those of them on routes whose state is not known: in no other number"), "sums.people_not_known"),
        ("people_blocked", "number", fill("expected number of people whose route is blocked: counted once for each route, of those that are known; blank where none is")),
        ("warnings", "count", fill("warnings in the table problems")),
    ),
    "pieces": _fields(
        ("path", "text", fill("the building")),
        ("item", "text", fill("name of the row of Items"), "one.item.item"),
        ("floor", "text", fill("its floor"), "one.item.floor"),
        ("room", "text", fill("its room"), "one.item.room"),
        ("description", "text", fill("as filled in"), "one.item.description"),
        ("type", "text", fill("its Type"), "one.item.type"),
        ("inventory", "text", fill("surveyed, handover or assumed")),
        ("quantity", "count", fill("pieces of the row"), "one.item.quantity"),
        ("quantity_low", "count", fill("10 % quantity of an assumed inventory")),
        ("quantity_high", "count", fill("90 % quantity of an assumed inventory")),
        ("breadth_cm", "number", fill("its sizes"), "one.item.breadth_cm"),
        ("width_cm", "number", fill("likewise"), "one.item.width_cm"),
        ("height_cm", "number", fill("likewise"), "one.item.height_cm"),
        ("assumed", "text", fill("fields that were filled in for it, separated by semicolons"), "one.item.assumed"),
        ("axis", "text", fill("axis of the governing motion"), "one.governing.motion.axis"),
        ("anchored", "text", fill("as filled in"), "one.item.anchored"),
        ("is_held", "flag", fill("whether it counts as anchored"), "one.item.is_held"),
        ("importance", "text", fill("as filled in"), "one.item.importance"),
        ("pfa_g", "number", fill("of the governing motion"), "one.governing.motion.pfa_g"),
        ("pfv_cm_s", "number", fill("likewise"), "one.governing.motion.pfv_cm_s"),
        ("pfa_source", "text", fill("where it comes from: record, given, interpolated, profile, beam"), "one.governing.motion.source"),
        ("basis", "text", fill("simulated, formula, unconfirmed, cannot rock or rolls"), "one.adopted.basis"),
        ("probability", "number", fill("chance of overturning in this scenario, of one piece"), "one.adopted.probability"),
        ("probability_low", "number", fill("its sampling interval"), "one.adopted.low"),
        ("probability_high", "number", fill("likewise"), "one.adopted.high"),
        ("risk_class", "text", fill("low, medium, high or very high"), "one.adopted.risk.word"),
        ("risk_class_upper", "text", fill("by the upper end of the interval"), "one.adopted.upper.word"),
        ("flags", "text", fill("separated by semicolons"), "one.adopted.flags"),
        ("route", "text", fill("routes that it names or can reach, separated by semicolons"), "one.routes"),
        ("work_place", "count", fill("its place on the building's work list")),
        ("detail", "text", fill("how to fix it, where it is on the list")),
        ("unit_cost", "number", fill("what that costs a piece")),
        ("row", "count", fill("row of the sheet"), "one.item.row"),
    ),
    "routes": _fields(
        ("path", "text", fill("the building")),
        ("route", "text", fill("its name"), "one.route"),
        ("state", "text", fill("open, doubtful, blocked or not known"), "one.state"),
        ("probability", "number", fill("chance that it is blocked in this scenario; blank where its state is not known"), "chance.probability"),
        ("probability_low", "number", fill("its interval; blank where nothing was simulated, or no draw blocks it or all do"), "range.low"),
        ("probability_high", "number", fill("likewise"), "range.high"),
        ("occupants", "count", fill("as filled in")),
        ("blockers", "text", fill("pieces that may block it, the likeliest first, separated by semicolons")),
        ("to_fill_in", "text", fill("what is missing that could change its state")),
    ),
    "problems": _fields(
        ("path", "text", fill("the building")),
        ("severity", "text", fill("error, warning or note"), "one.severity"),
        ("sheet", "text", fill("where it is"), "one.sheet"),
        ("cell", "text", fill("likewise"), "one.cell"),
        ("message", "text", fill("what is wrong"), "one.message"),
        ("fix", "text", fill("how to fix it"), "one.fix"),
    ),
    "draws": _fields(
        ("path", "text", fill("the building")),
        ("draw", "count", fill("number of the draw: one earthquake for all buildings")),
        ("falls", "count", fill("pieces that fall in it, of those in the classes")),
        ("people_blocked", "count", fill("people whose route is blocked in it, as far as routes have joint outcomes")),
        ("routes_blocked", "count", fill("routes that are blocked in it, likewise")),
    ),
}  # fmt: skip
"""Columns by table. Kinds are text (VARCHAR), number (DOUBLE), count (BIGINT) and flag (BOOLEAN); all may be NULL, where nothing is known."""
