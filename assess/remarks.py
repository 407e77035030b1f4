"""What a run remarks on how the floors shake: what was set aside, what was assumed, and what would shake them more.

Whatever is not used is a note; it is a warning where it would have shaken a floor more than what is used.
"""

import math
from collections.abc import Iterator

from assess.demand import AXES, Demands, find_ground, serve_by_profile
from assess.errors import Problem, Severity
from assess.inventory.model import Axis, Floor, Inventory
from assess.motion.record import treat
from assess.motion.scenario import PGA_OF_SDS, Profile
from assess.motion.target import estimate_period
from assess.units import GRAVITY, ROUNDING, VELOCITY

LOSS_TO_TELL = 0.02
"""Where treatment lowers PFA by more than this share, the report says so."""

LOSS_TO_WARN = 0.1
"""Where it lowers PFA by more than this share, the record may be a corrected one that does not say so."""

STOREY = (2.5, 6.0)
"""Usual height of a storey [m]."""

FAR_ABOVE = 1.5
"""Height over the highest floor listed, from which the report says which of them a profile takes."""

TIMES_USUAL = (0.3, 4.0)
"""Limits of T1 as multiples of a code's formula."""

MOST = 5
"""Floors, or warnings, that are named before the rest is only counted or left out."""

ALIKE = 0.01
"""Share up to which Ground PGA and 0.4 SDS count as the same."""

SOURCES = {
    "record": "recorded motion",
    "given": "given peaks",
    "interpolated": "interpolated between floors",
    "profile": "a code's design profile",
}
"""The sources of a floor's motion in words."""


def remark(
    inventory: Inventory, demands: Demands, scenario: str, ductility_reduction: float = 1.0
) -> Iterator[Problem]:
    """Yield warnings and notes on the motion of the floors and on the ground's."""
    yield from _losses(demands)
    yield from _on_shaking(inventory, demands, scenario, ductility_reduction)
    if list_floors(demands, "profile"):
        yield from _above_roof(inventory, demands)
        yield from _implausible(inventory, demands)
    yield from _mixed(demands)


def list_too_low(
    inventory: Inventory, demands: Demands, scenario: str, ductility_reduction: float = 1.0
) -> list[Problem]:
    """Return the warnings that say of a floor, or of the ground, that more is known than what is used."""
    told = _on_shaking(inventory, demands, scenario, ductility_reduction)
    return [problem for problem in told if problem.severity == "warning"]


def _on_shaking(inventory: Inventory, demands: Demands, scenario: str, ductility_reduction: float) -> Iterator[Problem]:
    for floor in inventory.floors:
        for axis in AXES:
            yield from _set_aside(floor, axis, demands, scenario)
    yield from _profile_below_known(inventory, demands, ductility_reduction)
    yield from _ground_values(inventory, demands, scenario)


def list_floors(demands: Demands, source: str) -> list[str]:
    """Return the names of the floors that a source serves along any axis."""
    return list(dict.fromkeys(name for (name, _), ones in demands.items() if any(o.source == source for o in ones)))


def _losses(demands: Demands) -> Iterator[Problem]:
    """Say where treatment took a noticeable part of a record's own peak."""
    for demand in (one for ones in demands.values() for one in ones if not one.is_borrowed):
        if demand.loss > LOSS_TO_TELL:
            before = demand.pfa / (1 - demand.loss)
            change = f"{before / GRAVITY:.3f} g to {demand.pfa / GRAVITY:.3f} g ({demand.loss:.1%})"
            message = f"treatment lowers the PFA of {demand.name} from the file's {change}."
            much = demand.loss > LOSS_TO_WARN
            mend = "If the file is corrected already, say so in it (plain CSV: # corrected: yes)." if much else ""
            yield Problem("warning" if much else "note", "Floors", f"A{demand.floor.row}", message, mend)


def _set_aside(floor: Floor, axis: Axis, demands: Demands, scenario: str) -> Iterator[Problem]:
    """Say which record and which given peaks of a floor do not serve, and whether they are larger than what does."""
    used = demands[floor.floor, axis]
    largest = max(one.pfa for one in used)
    own = {one.source for one in used if not one.is_borrowed}
    serves = "the record serves, with" if "record" in own else f"the scenario '{scenario}' takes"
    of_floor = f"of floor '{floor.floor}'"
    if floor.records.get(axis) and "record" not in own:
        recorded = max(treat(one.record).pfa for one in floor.records[axis])
        message = f"Record {axis} {of_floor} is not used: its PFA is {_in_g(recorded)}, {serves} {_in_g(largest)}."
        cell = floor.cell(f"record_{axis.lower()}")
        yield Problem(_severity(recorded, largest), "Floors", cell, message, "Scenario 'recorded' uses it.")
    if axis in floor.pfa and "given" not in own:
        message = f"PFA {axis} {_in_g(floor.pfa[axis])} {of_floor} is not used: {serves} {_in_g(largest)}."
        cell = floor.cell(f"pfa_{axis.lower()}")
        yield Problem(_severity(floor.pfa[axis], largest), "Floors", cell, message, _USES_GIVEN)
    if axis in floor.pfv and "given" not in own:
        fastest = max(one.pfv for one in used)
        instead = "no PFV" if math.isnan(fastest) else _in_cm_s(fastest)
        message = f"PFV {axis} {_in_cm_s(floor.pfv[axis])} {of_floor} is not used: {serves} {instead}."
        mend = _USES_GIVEN if axis in floor.pfa else ""
        cell = floor.cell(f"pfv_{axis.lower()}")
        yield Problem(_severity(floor.pfv[axis], fastest), "Floors", cell, message, mend)


_USES_GIVEN = "Scenario 'given' uses it."


def _severity(unused: float, used: float) -> Severity:
    return "warning" if unused > used * (1 + ROUNDING) else "note"


def _profile_below_known(inventory: Inventory, demands: Demands, ductility_reduction: float) -> Iterator[Problem]:
    """Warn where the profile that serves other floors would shake a known one less than it is known to be."""
    profile, ground = find_profile(demands), find_ground(inventory)
    for floor in inventory.floors if profile else ():
        known = [
            one
            for axis in AXES
            for one in demands[floor.floor, axis]
            if one.source in ("record", "given") and not one.is_borrowed
        ]
        if not known or not profile:
            continue
        worst = max(known, key=lambda one: one.pfa)
        by_profile = serve_by_profile(floor, profile, ground, inventory.building.period, ductility_reduction)
        pfa = by_profile["X"][0].pfa if by_profile else math.inf
        if worst.pfa > pfa * (1 + ROUNDING):
            message = (
                f"the profile would give {_in_g(pfa)} on floor '{floor.floor}', {_in_g(worst.pfa)} is known there: "
                f"floors on the profile may come out too low.{_above_weaker(floor, worst.pfa, inventory, demands)}"
            )
            mend = "Fill in a PFA or a record on those, or check Ground PGA in Building."
            cell = floor.cell(f"{'pfa' if worst.source == 'given' else 'record'}_{worst.axis.lower()}")
            yield Problem("warning", "Floors", cell, message, mend)


def _above_weaker(known: Floor, pfa: float, inventory: Inventory, demands: Demands) -> str:
    """Name the floors on the profile above a known one that come out weaker than it, in a sentence."""
    names = [
        f"'{floor.floor}' ({_in_g(one.pfa)})"
        for floor in inventory.floors
        for one in demands[floor.floor, "X"][:1]
        if one.source == "profile" and (floor.elevation or 0) >= (known.elevation or 0) and one.pfa < pfa
    ]
    shown = names[:MOST] + (["..."] if len(names) > MOST else [])
    return f" Above it get less: {', '.join(shown)}." if names else ""


def find_profile(demands: Demands) -> Profile | None:
    """Return the code's profile that serves floors, of which a run has one at most."""
    return next((one.profile for ones in demands.values() for one in ones if one.profile), None)


def _above_roof(inventory: Inventory, demands: Demands) -> Iterator[Problem]:
    roof = find_ground(inventory).roof
    for floor in inventory.floors:
        z = floor.elevation
        is_served = demands[floor.floor, "X"][0].source == "profile"
        if is_served and z is not None and roof is not None and z > max(roof, 0.0) * (1 + ROUNDING):
            message = f"Elevation {z:g} m is above the roof, {roof:g} m: z/h is taken as 1."
            mend = "Check it, and Height in Building."
            yield Problem("warning", "Floors", floor.cell("elevation"), message, mend)


def _implausible(inventory: Inventory, demands: Demands) -> Iterator[Problem]:
    """Question what a profile starts from: Height against Storeys and floors, T1 against the height."""
    building, ground = inventory.building, find_ground(inventory)
    if building.height and building.storeys:
        each = building.height / building.storeys
        if not STOREY[0] <= each <= STOREY[1]:
            message = (
                f"Height {building.height:g} m over {building.storeys} storeys is {each:.3g} m a storey, outside "
                f"{STOREY[0]:g} to {STOREY[1]:g} m; too large a Height lowers the profile."
            )
            yield Problem("warning", "Building", building.cell("height"), message, "Check Height and Storeys.")
    highest = max(floor.elevation for floor in inventory.floors if floor.elevation is not None)
    if building.height and building.height > FAR_ABOVE * max(highest, 0.0):
        message = f"z/h is taken against Height {building.height:g} m; the highest floor listed is at {highest:g} m."
        yield Problem("note", "Building", building.cell("height"), message)
    if building.period and ground.roof:
        yield from _odd_period(inventory, demands, ground.roof)


def _odd_period(inventory: Inventory, demands: Demands, roof: float) -> Iterator[Problem]:
    building, profile = inventory.building, find_profile(demands)
    usual = estimate_period(roof) or math.inf
    low, high = (times * usual for times in TIMES_USUAL)
    if building.period and profile and not low <= building.period <= high:
        effect = "lowers the profile" if profile.clause_without_period else "raises the PFV"
        message = (
            f"Period T1 {building.period:g} s is outside {low:.3g} to {high:.3g} s, {TIMES_USUAL[0]:g} to "
            f"{TIMES_USUAL[1]:g} times 0.0488 h^0.75 (ASCE 7-22 Eq. 12.8-7) for a height h of {roof:g} m; a longer T1 "
            f"{effect}."
        )
        mend = "Check Period T1 and Height."
        yield Problem("warning", "Building", building.cell("period"), message, mend)


def _ground_values(inventory: Inventory, demands: Demands, scenario: str) -> Iterator[Problem]:
    """Say which of Ground PGA and SDS is not used."""
    building = inventory.building
    given = {"ground_pga": building.ground_pga, "sds": building.sds}
    if not list_floors(demands, "profile"):
        for name, label in (("ground_pga", "Ground PGA"), ("sds", "SDS")):
            if given[name] is not None:
                why = "no floor needs a profile" if scenario == "as filled" else f"scenario '{scenario}'"
                message = f"{label} is kept, not used: {why}."
                yield Problem("note", "Building", building.cell(name), message)
    elif building.ground_pga is not None and building.sds is not None:
        by_sds = PGA_OF_SDS * building.sds
        if abs(by_sds - building.ground_pga) > ALIKE * max(building.ground_pga, by_sds):
            message = f"SDS is not used: 0.4 SDS is {_in_g(by_sds)}, Ground PGA {_in_g(building.ground_pga)} is used."
            kind = _severity(by_sds, building.ground_pga)
            yield Problem(kind, "Building", building.cell("sds"), message, "Correct one of them, or clear it.")


def _mixed(demands: Demands) -> Iterator[Problem]:
    """List the sources where a run has more than one."""
    by_source = {text: list_floors(demands, source) for source, text in SOURCES.items()}
    used = [f"{text} ({', '.join(floors)})" for text, floors in by_source.items() if floors]
    if len(used) > 1:
        yield Problem("note", "Floors", "", f"the motion of the floors comes from mixed sources: {'; '.join(used)}.")


def _in_g(pfa: float) -> str:
    return f"{pfa / GRAVITY:.3f} g"


def _in_cm_s(pfv: float) -> str:
    return f"{pfv / VELOCITY['cm/s']:.1f} cm/s"
