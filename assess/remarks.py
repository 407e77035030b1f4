"""What a run remarks on how the floors shake: what was set aside, what was assumed, and what would shake them more.

Whatever is not used is a note; it is a warning where it would have shaken a floor more than what is used.
"""

from collections.abc import Iterator

from assess.demand import AXES, Demands, Ground, find_ground
from assess.errors import Problem, Severity
from assess.inventory.model import Axis, Floor, Inventory
from assess.motion.record import treat
from assess.motion.scenario import PGA_OF_SDS
from assess.units import GRAVITY, ROUNDING

LOSS_TO_TELL = 0.02
"""Where treatment lowers PFA by more than this share, the report says so."""

LOSS_TO_WARN = 0.1
"""Where it lowers PFA by more than this share, the record may be a corrected one that does not say so."""

ALIKE = 0.01
"""Share up to which Ground PGA and 0.4 SDS count as the same."""

SOURCES = {
    "record": "recorded motion",
    "given": "given peaks",
    "interpolated": "interpolated between floors",
    "profile": "a code's design profile",
}
"""The sources of a floor's motion in words."""


def remark(inventory: Inventory, demands: Demands, scenario: str) -> Iterator[Problem]:
    """Yield warnings and notes on the motion of the floors and on the ground's."""
    yield from _losses(demands)
    for floor in inventory.floors:
        for axis in AXES:
            yield from _set_aside(floor, axis, demands, scenario)
    ground = find_ground(inventory)
    for floor in inventory.floors:
        if demands[floor.floor, "X"][0].source == "profile":
            yield from _above_roof(floor, ground)
            yield from _above_stronger(floor, inventory, demands)
    yield from _ground_values(inventory, demands, scenario)
    yield from _mixed(demands)


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
    """Say which record and which given PFA of a floor does not serve, and whether it is larger than what does."""
    used = demands[floor.floor, axis]
    largest = max(one.pfa for one in used)
    own = {one.source for one in used if not one.is_borrowed}
    if floor.records.get(axis) and "record" not in own:
        recorded = max(treat(one.record).pfa for one in floor.records[axis])
        instead = f"the scenario '{scenario}' takes {_in_g(largest)}"
        message = f"Record {axis} is not used: its PFA is {_in_g(recorded)}, {instead}."
        cell = floor.cell(f"record_{axis.lower()}")
        yield Problem(_severity(recorded, largest), "Floors", cell, message, "Scenario 'recorded' uses it.")
    if axis in floor.pfa and "given" not in own:
        serves = "the record serves, with" if "record" in own else f"the scenario '{scenario}' takes"
        message = f"PFA {axis} {_in_g(floor.pfa[axis])} is not used: {serves} {_in_g(largest)}."
        cell = floor.cell(f"pfa_{axis.lower()}")
        yield Problem(_severity(floor.pfa[axis], largest), "Floors", cell, message, "Scenario 'given' uses it.")


def _severity(unused: float, used: float) -> Severity:
    return "warning" if unused > used * (1 + ROUNDING) else "note"


def _above_roof(floor: Floor, ground: Ground) -> Iterator[Problem]:
    if floor.elevation is not None and ground.roof is not None and floor.elevation > ground.roof * (1 + ROUNDING):
        message = f"Elevation {floor.elevation:g} m is above the roof, {ground.roof:g} m: z/h is taken as 1."
        mend = "Check it, and Height in Building."
        yield Problem("warning", "Floors", floor.cell("elevation"), message, mend)


def _above_stronger(floor: Floor, inventory: Inventory, demands: Demands) -> Iterator[Problem]:
    """Warn where a code's profile shakes a floor less than what is known of a floor below it."""
    pfa = demands[floor.floor, "X"][0].pfa
    below = [
        one
        for other in inventory.floors
        if other.elevation is not None and floor.elevation is not None and other.elevation <= floor.elevation
        for axis in AXES
        for one in demands[other.floor, axis]
        if one.source in ("record", "given")
    ]
    worst = max(below, key=lambda one: one.pfa, default=None)
    if worst and worst.pfa > pfa * (1 + ROUNDING):
        message = (
            f"the profile gives {_in_g(pfa)}, less than the {_in_g(worst.pfa)} known of floor '{worst.floor.floor}' "
            "below it."
        )
        mend = "Fill in a PFA or a record, or check Ground PGA in Building."
        yield Problem("warning", "Floors", floor.cell("pfa_x"), message, mend)


def _ground_values(inventory: Inventory, demands: Demands, scenario: str) -> Iterator[Problem]:
    """Say which of Ground PGA and SDS is not used."""
    building = inventory.building
    given = {"ground_pga": building.ground_pga, "sds": building.sds}
    if not list_floors(demands, "profile"):
        for name, label in (("ground_pga", "Ground PGA"), ("sds", "SDS")):
            if given[name] is not None:
                why = "every floor has a motion of its own" if scenario == "as filled" else f"scenario '{scenario}'"
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
