"""Notes and warnings on the motion of the floors: input that is not used, assumptions, implausible values.

Input that is not used gets a note; a warning where it is larger than what is used.
"""

import math
from collections.abc import Iterator

from assess.errors import Problem, Severity
from assess.i18n import Text, fill, join, nfill
from assess.model import AXES, Axis, Floor, Inventory
from assess.motion.record import treat
from assess.motion.scenario import PGA_OF_SDS, Profile, cap_pfv
from assess.motion.target import estimate_period
from assess.pipeline.assumed_shaking import remark_on_shaking
from assess.pipeline.demand import Demands, find_ground, serve_by_profile
from assess.pipeline.site_remarks import remark_on_site
from assess.units import GRAVITY, ROUNDING, VELOCITY

LOSS_TO_NOTE = 0.02
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
    "record": fill("recorded motion"),
    "given": fill("given peaks"),
    "interpolated": fill("interpolated between floors"),
    "profile": fill("a code's design profile"),
}
"""The sources of a floor's motion in words."""


def remark(
    inventory: Inventory, demands: Demands, scenario: str, ductility_reduction: float = 1.0
) -> Iterator[Problem]:
    """Yield warnings and notes on the motion of the floors and on the ground's."""
    yield from _losses(demands)
    yield from _on_shaking(inventory, demands, scenario, ductility_reduction)
    yield from remark_on_site(inventory, demands)
    if list_floors(demands, "profile"):
        yield from _above_roof(inventory, demands)
        yield from _assumed_elevations(inventory, demands)
        yield from _implausible(inventory, demands)
    yield from _mixed(demands)


def list_too_low(
    inventory: Inventory, demands: Demands, scenario: str, ductility_reduction: float = 1.0
) -> list[Problem]:
    """Return the warnings that a larger peak is known of a floor, or of the ground, than the one used."""
    found = _on_shaking(inventory, demands, scenario, ductility_reduction)
    return [problem for problem in found if problem.severity == "warning"]


def _on_shaking(inventory: Inventory, demands: Demands, scenario: str, ductility_reduction: float) -> Iterator[Problem]:
    for floor in inventory.floors:
        for axis in AXES:
            yield from _set_aside(floor, axis, demands, scenario)
    yield from _profile_below_known(inventory, demands, ductility_reduction)
    yield from _ground_values(inventory, demands, scenario)
    yield from remark_on_shaking(inventory, demands)
    yield from _ground_velocity(inventory, demands)


def list_floors(demands: Demands, source: str) -> list[str]:
    """Return the names of the floors that a source serves along any axis."""
    return list(dict.fromkeys(name for (name, _), ones in demands.items() if any(o.source == source for o in ones)))


def _losses(demands: Demands) -> Iterator[Problem]:
    """Report where treatment lowers the peak of a record noticeably."""
    for demand in (one for ones in demands.values() for one in ones if not one.is_borrowed):
        if demand.loss > LOSS_TO_NOTE:
            before = demand.pfa / (1 - demand.loss)
            message = fill(
                "treatment lowers the PFA of {record} from the file's {before:.3f} g to {pfa:.3f} g ({loss:.1%}).",
                record=demand.name,
                before=before / GRAVITY,
                pfa=demand.pfa / GRAVITY,
                loss=demand.loss,
            )
            much = demand.loss > LOSS_TO_WARN
            fix = fill("If the file is corrected already, say so in it (plain CSV: # corrected: yes).") if much else ""
            yield Problem("warning" if much else "note", "Floors", f"A{demand.floor.row}", message, fix)


def _set_aside(floor: Floor, axis: Axis, demands: Demands, scenario: str) -> Iterator[Problem]:
    """Report the record and the given peaks of a floor that are not used; a warning where they are larger."""
    used = demands[floor.floor, axis]
    largest = max(one.pfa for one in used)
    own = {one.source for one in used if not one.is_borrowed}
    serves = _describe_serving("" if "record" in own else scenario, _in_g(largest))
    if floor.records.get(axis) and "record" not in own:
        recorded = max(treat(one.record).pfa for one in floor.records[axis])
        text = fill("its PFA is {pfa:.3f} g, {serves}", pfa=recorded / GRAVITY, serves=serves)
        message = _describe_unused(fill("Record {axis}", axis=axis), floor, text)
        cell = floor.cell(f"record_{axis.lower()}")
        yield Problem(_severity(recorded, largest), "Floors", cell, message, fill("Scenario 'recorded' uses it."))
    if axis in floor.pfa and "given" not in own:
        what = fill("PFA {axis} {pfa:.3f} g", axis=axis, pfa=floor.pfa[axis] / GRAVITY)
        cell = floor.cell(f"pfa_{axis.lower()}")
        message = _describe_unused(what, floor, serves)
        yield Problem(_severity(floor.pfa[axis], largest), "Floors", cell, message, _USES_GIVEN)
    if axis in floor.pfv and "given" not in own:
        fastest = max(one.pfv for one in used)
        what = fill("PFV {axis} {pfv}", axis=axis, pfv=_in_cm_s(floor.pfv[axis]))
        serves = _describe_serving("" if "record" in own else scenario, _in_cm_s(fastest))
        cell = floor.cell(f"pfv_{axis.lower()}")
        fix = _USES_GIVEN if axis in floor.pfa else ""
        yield Problem(_severity(floor.pfv[axis], fastest), "Floors", cell, _describe_unused(what, floor, serves), fix)


def _describe_unused(what: Text, floor: Floor, why: Text) -> Text:
    return fill("{what} of floor '{floor}' is not used: {why}.", what=what, floor=floor.floor, why=why)


def _describe_serving(scenario: str, peak: Text) -> Text:
    """Say that the record is used with its peak, or which peak a scenario uses."""
    if not scenario:
        return fill("the record is used, with {peak}", peak=peak)
    return fill("the scenario '{scenario}' uses {peak}", scenario=fill(scenario), peak=peak)


_USES_GIVEN = fill("Scenario 'given' uses it.")


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
            message = _describe_below(floor, pfa, worst.pfa, _above_weaker(floor, worst.pfa, inventory, demands))
            fix = fill("Fill in a PFA or a record on those, or check Ground PGA in Building.")
            cell = floor.cell(f"{'pfa' if worst.source == 'given' else 'record'}_{worst.axis.lower()}")
            yield Problem("warning", "Floors", cell, message, fix)


def _describe_below(floor: Floor, pfa: float, known: float, weaker: list[Text]) -> Text:
    text = fill(
        "the profile would give {pfa:.3f} g on floor '{floor}', where {known:.3f} g is known: the PFA of floors that "
        "follow the profile may be too low.",
        pfa=pfa / GRAVITY,
        floor=floor.floor,
        known=known / GRAVITY,
    )
    shown = [*weaker[:MOST], *(["..."] if len(weaker) > MOST else [])]
    return (
        fill("{warning} Floors above with less: {floors}.", warning=text, floors=join(", ", shown)) if weaker else text
    )


def _above_weaker(known: Floor, pfa: float, inventory: Inventory, demands: Demands) -> list[Text]:
    """Name the floors on the profile above a known one that come out weaker than it."""
    return [
        fill("'{floor}' ({pfa:.3f} g)", floor=floor.floor, pfa=one.pfa / GRAVITY)
        for floor in inventory.floors
        for one in demands[floor.floor, "X"][:1]
        if one.source == "profile" and (floor.elevation or 0) >= (known.elevation or 0) and one.pfa < pfa
    ]


def find_profile(demands: Demands) -> Profile | None:
    """Return the code's profile that serves floors, of which a run has one at most."""
    return next((one.profile for ones in demands.values() for one in ones if one.profile), None)


def _above_roof(inventory: Inventory, demands: Demands) -> Iterator[Problem]:
    roof = find_ground(inventory).roof
    for floor in inventory.floors:
        z = floor.elevation
        is_served = demands[floor.floor, "X"][0].source == "profile"
        if is_served and z is not None and roof is not None and z > max(roof, 0.0) * (1 + ROUNDING):
            message = fill("Elevation {z:g} m is above the roof, {roof:g} m: z/h is taken as 1.", z=z, roof=roof)
            fix = fill("Check it, and Height in Building.")
            yield Problem("warning", "Floors", floor.cell("elevation"), message, fix)


def _assumed_elevations(inventory: Inventory, demands: Demands) -> Iterator[Problem]:
    """Name the floors whose elevation is assumed."""
    flagged = {name for (name, _), ones in demands.items() if any("assumed_elevation" in one.flags for one in ones)}
    floors = [floor for floor in inventory.floors if floor.floor in flagged]
    if floors:
        message = nfill(
            "floor {floors} has no Elevation; its number times Height over Storeys, counted from the ground floor as "
            "0, is assumed. It lies higher where lower storeys are higher than the others.",
            "{n:,} floors have no Elevation ({floors}); their numbers times Height over Storeys, counted from the "
            "ground floor as 0, are assumed. Evenly spaced storeys place a floor too low where lower storeys are "
            "higher.",
            len(floors), floors=", ".join(floor.floor for floor in floors),
        )  # fmt: skip
        yield Problem("note", "Floors", floors[0].cell("elevation"), message, fill("Fill in Elevation."))


def _implausible(inventory: Inventory, demands: Demands) -> Iterator[Problem]:
    """Check what a profile starts from: Height against Storeys and floors, T1 against the height."""
    building, ground = inventory.building, find_ground(inventory)
    if building.height and building.storeys:
        each = building.height / building.storeys
        if not STOREY[0] <= each <= STOREY[1]:
            effect = fill("too large a Height lowers the profile")
            if each < STOREY[0]:
                effect = fill("too small a Height raises the profile")
            message = nfill(
                "Height {height:g} m over {n} storey is {each:.3g} m a storey, outside {low:g} to {high:g} m; "
                "{effect}.",
                "Height {height:g} m over {n} storeys is {each:.3g} m a storey, outside {low:g} to {high:g} m; "
                "{effect}.",
                building.storeys,
                height=building.height,
                each=each,
                low=STOREY[0],
                high=STOREY[1],
                effect=effect,
            )
            yield Problem("warning", "Building", building.cell("height"), message, fill("Check Height and Storeys."))
    highest = max((z for floor in inventory.floors if (z := ground.place(floor)[0]) is not None), default=0.0)
    if building.height and building.height > FAR_ABOVE * max(highest, 0.0):
        message = fill(
            "z/h is taken against Height {height:g} m; the highest floor listed is at {highest:g} m.",
            height=building.height,
            highest=highest,
        )
        yield Problem("note", "Building", building.cell("height"), message)
    if building.period and ground.roof:
        yield from _odd_period(inventory, demands, ground.roof)


def _odd_period(inventory: Inventory, demands: Demands, roof: float) -> Iterator[Problem]:
    building, profile = inventory.building, find_profile(demands)
    usual = estimate_period(roof) or math.inf
    low, high = (times * usual for times in TIMES_USUAL)
    if building.period and profile and not low <= building.period <= high:
        lowers = profile.clause_without_period
        message = fill(
            "Period T1 {period:g} s is outside {low:.3g} to {high:.3g} s, {least:g} to {most:g} times 0.0488 h^0.75 "
            "(ASCE 7-22 Eq. 12.8-7) for a height h of {roof:g} m; {effect}.",
            period=building.period,
            low=low,
            high=high,
            least=TIMES_USUAL[0],
            most=TIMES_USUAL[1],
            roof=roof,
            effect=fill("a longer T1 lowers the profile") if lowers else fill("a longer T1 raises the PFV"),
        )
        fix = fill("Check Period T1 and Height.")
        yield Problem("warning", "Building", building.cell("period"), message, fix)


def _ground_values(inventory: Inventory, demands: Demands, scenario: str) -> Iterator[Problem]:
    """Report which of Ground PGA and SDS no floor uses; with a hazard file chances a year refer to the former.

    The code's force on anchors uses SDS where it is given, else Ground PGA.
    """
    building = inventory.building
    for_anchors = "ground_pga" if building.sds is None else "sds"
    given = {"ground_pga": None if inventory.hazard else building.ground_pga, "sds": building.sds}
    if not list_floors(demands, "profile"):
        for name, label in (("ground_pga", "Ground PGA"), ("sds", "SDS")):
            if given[name] is not None:
                why = fill("no floor follows a profile")
                if scenario != "as filled":
                    why = fill("scenario '{scenario}'", scenario=fill(scenario))
                message = fill("{what} is not used: {why}.", what=fill(label), why=why)
                if name == for_anchors:
                    message = fill(
                        "{what} is used for the code's force on anchors only: {why}.", what=fill(label), why=why
                    )
                yield Problem("note", "Building", building.cell(name), message)
    elif building.ground_pga is not None and building.sds is not None:
        by_sds = PGA_OF_SDS * building.sds
        if abs(by_sds - building.ground_pga) > ALIKE * max(building.ground_pga, by_sds):
            message = fill(
                "SDS is used for the code's force on anchors only: 0.4 SDS is {by_sds:.3f} g, but floors follow Ground "
                "PGA {used:.3f} g.",
                by_sds=by_sds / GRAVITY,
                used=building.ground_pga / GRAVITY,
            )
            kind = _severity(by_sds, building.ground_pga)
            yield Problem(kind, "Building", building.cell("sds"), message, fill("Correct one of them, or clear it."))


def _mixed(demands: Demands) -> Iterator[Problem]:
    """List the sources where a run has more than one."""
    by_source = {text: list_floors(demands, source) for source, text in SOURCES.items()}
    used = [
        fill("{source} ({floors})", source=text, floors=", ".join(floors))
        for text, floors in by_source.items()
        if floors
    ]
    if len(used) > 1:
        message = fill("the motion of the floors comes from mixed sources: {sources}.", sources=join("; ", used))
        yield Problem("note", "Floors", "", message)


def _in_g(pfa: float) -> Text:
    return fill("{pfa:.3f} g", pfa=pfa / GRAVITY)


def _ground_velocity(inventory: Inventory, demands: Demands) -> Iterator[Problem]:
    """Report a Ground PGV that caps no estimate, and one that is too small for the PFV of a floor."""
    pgv, cell = inventory.building.ground_pgv, inventory.building.cell("ground_pgv")
    if pgv is None:
        return
    every = [one for parallel in demands.values() for one in parallel]
    if not any("pfv_estimated" in one.flags for one in every):
        why = fill("no PFV is estimated")
        yield Problem("note", "Building", cell, fill("{what} is not used: {why}.", what=fill("Ground PGV"), why=why))
        return
    known = [one for one in every if one.source in ("record", "given") and "pfv_estimated" not in one.flags]
    fastest = max(
        (one for one in known if one.pfv > cap_pfv(pgv) * (1 + ROUNDING)), key=lambda one: one.pfv, default=None
    )
    if fastest is not None:
        message = fill(
            "Ground PGV {pgv} caps the PFV that is estimated at {cap}, but the PFV of floor '{floor}' is {pfv}: the "
            "estimate for other floors may be too low.",
            pgv=_in_cm_s(pgv),
            cap=_in_cm_s(cap_pfv(pgv)),
            floor=fastest.floor.floor,
            pfv=_in_cm_s(fastest.pfv),
        )
        yield Problem("warning", "Building", cell, message, fill("Check Ground PGV in Building."))


def _in_cm_s(pfv: float) -> Text:
    return fill("no PFV") if math.isnan(pfv) else fill("{pfv:.1f} cm/s", pfv=pfv / VELOCITY["cm/s"])
