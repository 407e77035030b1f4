"""Notes and warnings on the motion of the floors: input that is not used, assumptions, implausible values.

Input that is not used gets a note; a warning where it is larger than what is used.
"""

import math
from collections.abc import Iterator, Set

from assess.errors import Problem, Severity
from assess.i18n import Text, fill, join, nfill
from assess.intensity import RATIO, SHAKINGS
from assess.model import AXES, Axis, Floor, Inventory
from assess.motion.assumed import CODE_FACTOR, CODE_POWER
from assess.motion.record import treat
from assess.motion.scenario import PGA_OF_SDS
from assess.motion.site_ground import SiteGround
from assess.pipeline.demand import Demand, Demands, find_shaking, find_site
from assess.pipeline.known_ground import find_ground
from assess.units import GRAVITY, ROUNDING, VELOCITY

LOSS_TO_NOTE, LOSS_TO_WARN = 0.02, 0.1
"""Where treatment lowers PFA by more than these shares the report says so, and the record may be corrected already."""
STOREY = (2.5, 6.0)
"""Usual height of a storey [m]."""
FAR_ABOVE = 1.5
"""Height over the highest floor listed, from which the report says which of them a profile takes."""
TIMES_USUAL = (0.3, 4.0)
"""Limits of T1 as multiples of a code's formula."""
LEAST_RATIO, LARGEST_RATIO = 10.0, 600.0
"""Usual limits of PGV over PGA [cm/s per g]."""
ALIKE = 0.01
"""Share up to which Ground PGA and 0.4 SDS count as the same."""
SOURCES = {
    "record": fill("recorded motion"),
    "given": fill("given peaks"),
    "interpolated": fill("interpolated between floors"),
    "profile": fill("a code's design profile"),
    "beam": fill("drawn buildings on the ground motion"),
}
"""The sources of a floor's motion in words."""
UNKNOWN = {
    "unknown_building": (
        fill(
            "neither T1, Height, Storeys nor an Elevation is known, so that buildings of every period and floors of "
            "every height are drawn"
        ),
        fill("Fill in Storeys in Building, and Elevation."),
    ),
    "unknown_height": (fill("its height in the building is not known and is drawn"), fill("Fill in Elevation.")),
}
"""What is not known of a floor, by its flag, and how to fix it."""


def remark(
    inventory: Inventory, demands: Demands, scenario: str, unconfirmed: Set[str] = frozenset()
) -> Iterator[Problem]:
    """Yield remarks on the motion of floors and ground; on `unconfirmed` floors a simulated piece is unconfirmed."""
    for demand in (one for ones in demands.values() for one in ones if not one.is_borrowed):
        if demand.loss > LOSS_TO_NOTE:
            message = fill(
                "treatment lowers the PFA of {record} from the file's {before:.3f} g to {pfa:.3f} g ({loss:.1%}).",
                record=demand.name, before=demand.pfa / (1 - demand.loss) / GRAVITY, pfa=demand.pfa / GRAVITY,
                loss=demand.loss,
            )  # fmt: skip
            much = demand.loss > LOSS_TO_WARN
            fix = fill("If the file is corrected already, say so in it (plain CSV: # corrected: yes).") if much else ""
            yield Problem("warning" if much else "note", "Floors", f"A{demand.floor.row}", message, fix)
    yield from remark_on_shaking(inventory, demands, scenario)
    yield from _on_site(inventory, demands)
    for flag, (text, fix) in UNKNOWN.items():
        found = [name for (name, _), parallel in demands.items() if any(flag in one.flags for one in parallel)]
        floors = [floor for floor in inventory.floors if floor.floor in found]
        if floors:
            named, what = ", ".join(floor.floor for floor in floors), text
            if flag == "unknown_building" and not unconfirmed.isdisjoint(found):
                what = fill("{drawn}; classes stay unconfirmed", drawn=text)
            message = nfill("floor {floors}: {what}.", "floors {floors}: {what}.", len(floors), floors=named, what=what)
            yield Problem("warning", "Floors", floors[0].cell("elevation"), message, fix)
    if list_floors(demands, "profile") or list_floors(demands, "beam"):
        yield from _on_heights(inventory, demands)
    used = [
        fill("{source} ({floors})", source=text, floors=", ".join(names))
        for source, text in SOURCES.items()
        if (names := list_floors(demands, source))
    ]
    if len(used) > 1:
        message = fill("the motion of the floors comes from mixed sources: {sources}.", sources=join("; ", used))
        yield Problem("note", "Floors", "", message)


def remark_on_shaking(inventory: Inventory, demands: Demands, scenario: str) -> Iterator[Problem]:
    """Yield remarks on peaks that are not used; a warning where one is larger than that which is."""
    for floor in inventory.floors:
        for axis in AXES:
            yield from _set_aside(floor, axis, demands, scenario)
    yield from _on_ground_pga(inventory, demands, scenario)
    yield from _on_assumed_shaking(inventory, demands)
    yield from _on_ground_pgv(inventory, demands)


def list_floors(demands: Demands, source: str) -> list[str]:
    """Return the names of the floors that a source serves along any axis."""
    return list(dict.fromkeys(name for (name, _), ones in demands.items() if any(o.source == source for o in ones)))


def _set_aside(floor: Floor, axis: Axis, demands: Demands, scenario: str) -> Iterator[Problem]:
    used = demands[floor.floor, axis]
    own, uses_given = {one.source for one in used if not one.is_borrowed}, fill("Scenario 'given' uses it.")
    largest, fastest = max(one.pfa for one in used), max(one.pfv for one in used)

    def report(name: str, what: Text, why: Text, unused: float, serving: float, fix: Text | str) -> Problem:
        message = fill("{what} of floor '{floor}' is not used: {why}.", what=what, floor=floor.floor, why=why)
        return Problem(_severity(unused, serving), "Floors", floor.cell(f"{name}_{axis.lower()}"), message, fix)

    def serve(peak: Text) -> Text:
        if "record" in own:
            return fill("the record is used, with {peak}", peak=peak)
        return fill("the scenario '{scenario}' uses {peak}", scenario=fill(scenario), peak=peak)

    serves = serve(fill("{pfa:.3f} g", pfa=largest / GRAVITY))
    if floor.records.get(axis) and "record" not in own:
        pfa, what = max(treat(one.record).pfa for one in floor.records[axis]), fill("Record {axis}", axis=axis)
        text = fill("its PFA is {pfa:.3f} g, {serves}", pfa=pfa / GRAVITY, serves=serves)
        yield report("record", what, text, pfa, largest, fill("Scenario 'recorded' uses it."))
    if axis in floor.pfa and "given" not in own:
        what = fill("PFA {axis} {pfa:.3f} g", axis=axis, pfa=floor.pfa[axis] / GRAVITY)
        yield report("pfa", what, serves, floor.pfa[axis], largest, uses_given)
    if axis in floor.pfv and "given" not in own:
        what = fill("PFV {axis} {pfv}", axis=axis, pfv=_in_cm_s(floor.pfv[axis]))
        fix = uses_given if axis in floor.pfa else ""
        yield report("pfv", what, serve(_in_cm_s(fastest)), floor.pfv[axis], fastest, fix)


def _unused(what: Text, why: Text) -> Text:
    return fill("{what} is not used: {why}.", what=what, why=why)


def _severity(unused: float, used: float) -> Severity:
    return "warning" if unused > used * (1 + ROUNDING) else "note"


def _on_heights(inventory: Inventory, demands: Demands) -> Iterator[Problem]:
    """Check Elevation against the roof, Height against Storeys and floors, and T1 against the height."""
    building, ground = inventory.building, find_ground(inventory)
    for floor in inventory.floors:
        z, roof = floor.elevation, ground.roof
        is_served = demands[floor.floor, "X"][0].source in ("profile", "beam")
        if is_served and z is not None and roof is not None and z > max(roof, 0.0) * (1 + ROUNDING):
            message = fill("Elevation {z:g} m is above the roof, {roof:g} m: z/h is taken as 1.", z=z, roof=roof)
            fix = fill("Check it, and Height in Building.")
            yield Problem("warning", "Floors", floor.cell("elevation"), message, fix)
    flagged = {name for (name, _), ones in demands.items() if any("assumed_elevation" in one.flags for one in ones)}
    floors = [floor for floor in inventory.floors if floor.floor in flagged]
    if floors:
        message = nfill(
            "floor {floors} has no Elevation; its number times Height over Storeys, counted from the ground floor as "
            "{lowest}, is assumed. It lies higher where lower storeys are higher than the others.",
            "{n:,} floors have no Elevation ({floors}); their numbers times Height over Storeys, counted from the "
            "ground floor as {lowest}, are assumed. Evenly spaced storeys place a floor too low where lower storeys "
            "are higher.",
            len(floors), floors=", ".join(floor.floor for floor in floors), lowest=ground.lowest,
        )  # fmt: skip
        yield Problem("note", "Floors", floors[0].cell("elevation"), message, fill("Fill in Elevation."))
    if building.height and building.storeys:
        each = building.height / building.storeys
        if not STOREY[0] <= each <= STOREY[1]:
            message = nfill(
                "Height {height:g} m over {n} storey is {each:.3g} m a storey, outside {low:g} to {high:g} m.",
                "Height {height:g} m over {n} storeys is {each:.3g} m a storey, outside {low:g} to {high:g} m.",
                building.storeys, height=building.height, each=each, low=STOREY[0], high=STOREY[1],
            )  # fmt: skip
            yield Problem("warning", "Building", building.cell("height"), message, fill("Check Height and Storeys."))
    highest = max((z for floor in inventory.floors if (z := ground.place(floor)[0]) is not None), default=0.0)
    if building.height and building.height > FAR_ABOVE * max(highest, 0.0):
        message = fill(
            "z/h is taken against Height {height:g} m; the highest floor listed is at {highest:g} m.",
            height=building.height, highest=highest,
        )  # fmt: skip
        yield Problem("note", "Building", building.cell("height"), message)
    low, high = (times * CODE_FACTOR * (ground.roof or 0.0) ** CODE_POWER for times in TIMES_USUAL)
    if building.period and ground.roof and not low <= building.period <= high:
        message = fill(
            "Period T1 {period:g} s is outside {low:.3g} to {high:.3g} s, {least:g} to {most:g} times 0.0488 h^0.75 "
            "(ASCE 7-22 Eq. 12.8-7) for a height h of {roof:g} m.",
            period=building.period, low=low, high=high, least=TIMES_USUAL[0], most=TIMES_USUAL[1], roof=ground.roof,
        )  # fmt: skip
        fix = fill("Check Period T1 and Height.")
        yield Problem("warning", "Building", building.cell("period"), message, fix)


def _on_ground_pga(inventory: Inventory, demands: Demands, scenario: str) -> Iterator[Problem]:
    """Report which of Ground PGA and SDS no floor uses; with a hazard file chances a year refer to the former.

    The code's force on anchors uses SDS where it is given, else Ground PGA.
    """
    building = inventory.building
    for_anchors = "ground_pga" if building.sds is None else "sds"
    given = {"ground_pga": None if inventory.hazard else building.ground_pga, "sds": building.sds}
    if not _list_drawn(demands):
        for name, label in (("ground_pga", "Ground PGA"), ("sds", "SDS")):
            if given[name] is None:
                continue
            why = _explain_unused(demands)
            if scenario != "as filled":
                why = fill("scenario '{scenario}'", scenario=fill(scenario))
            message = _unused(fill(label), why)
            if name == for_anchors:
                message = fill("{what} is used for the code's force on anchors only: {why}.", what=fill(label), why=why)
            yield Problem("note", "Building", building.cell(name), message)
    elif building.ground_pga is not None and building.sds is not None:
        by_sds = PGA_OF_SDS * building.sds
        if abs(by_sds - building.ground_pga) > ALIKE * max(building.ground_pga, by_sds):
            message = fill(
                "SDS is used for the code's force on anchors only: 0.4 SDS is {by_sds:.3f} g, but floors follow Ground "
                "PGA {used:.3f} g.",
                by_sds=by_sds / GRAVITY, used=building.ground_pga / GRAVITY,
            )  # fmt: skip
            kind = _severity(by_sds, building.ground_pga)
            yield Problem(kind, "Building", building.cell("sds"), message, fill("Correct one of them, or clear it."))


def _list_drawn(demands: Demands) -> list[Demand]:
    """Return the demands that follow from the ground motion of Building."""
    every = (one for parallel in demands.values() for one in parallel)
    return [one for one in every if one.drawn is not None and not one.drawn.at_grade]


def _explain_unused(demands: Demands) -> Text:
    if any(one.drawn for parallel in demands.values() for one in parallel):
        return fill("the motion at grade is known")
    return fill("every floor has a record")


def _on_ground_pgv(inventory: Inventory, demands: Demands) -> Iterator[Problem]:
    """Report a Ground PGV that no floor follows, one without a PGA, and an implausible ratio of the two."""
    building = inventory.building
    pga, pgv, cell = find_ground(inventory).pga, building.ground_pgv, building.cell("ground_pgv")
    if not _list_drawn(demands):
        if pgv is not None:
            yield Problem("note", "Building", cell, _unused(fill("Ground PGV"), _explain_unused(demands)))
    elif pgv is None:
        if building.ground_pga is not None or building.sds is not None:
            message = fill(
                "Ground PGV is blank: PGV/PGA is drawn as in earthquakes of magnitude 6.5 to 7.5, {ratio:.0f} cm/s per "
                "g in the median. Chances depend on it most.",
                ratio=100 * RATIO * GRAVITY,
            )
            fix = fill("Fill in Ground PGV, or name the record of the nearest station on a floor of Elevation 0.")
            yield Problem("note", "Building", cell, message, fix)
    elif building.ground_pga is None and building.sds is None and not building.shakemap and not building.shaking:
        message = fill(
            "Ground PGV is filled in without Ground PGA, which is drawn: {pga:.3f} g in the median.",
            pga=(pga or 0.0) / GRAVITY,
        )
        yield Problem("warning", "Building", cell, message, fill("Fill in Ground PGA."))
    elif pga and not LEAST_RATIO <= 100 * pgv / pga * GRAVITY <= LARGEST_RATIO:
        message = fill(
            "Ground PGV over the ground's PGA is {ratio:.3g} cm/s per g, outside {low:g} to {high:g}.",
            ratio=100 * pgv / pga * GRAVITY, low=LEAST_RATIO, high=LARGEST_RATIO,
        )  # fmt: skip
        yield Problem("warning", "Building", cell, message, fill("Check Ground PGV, Ground PGA and their units."))


def _in_cm_s(pfv: float) -> Text:
    return fill("no PFV") if math.isnan(pfv) else fill("{pfv:.1f} cm/s", pfv=pfv / VELOCITY["cm/s"])


def _on_site(inventory: Inventory, demands: Demands) -> Iterator[Problem]:
    """Yield the notes and warnings on a ShakeMap or scenarios; none where the building has neither."""
    building, site = inventory.building, inventory.site_ground
    cell = building.cell("shakemap")
    if site is None:
        if building.shakemap:
            message = _unused(fill("ShakeMap file"), fill("Ground PGA or SDS is filled in"))
            yield Problem("note", "Building", cell, message)
        return
    used = find_site(demands)
    if used is None:
        yield Problem("note", "Building", cell, _unused(_name(site), fill("every floor has a motion of its own")))
        return
    message = fill(
        "{what} gives the ground a PGA of {pga:.3f} g{pgv} at the building. The standard deviation of ln {measure} "
        "there is {sigma:.3g} ({source}); with {own:.3g}, Motion uncertainty, the dispersion is {motion:.3g}, the root "
        "of the sum of their squares.",
        what=_name(used), pga=used.pga / GRAVITY,
        pgv="" if used.pgv is None else fill(" and a PGV of {pgv:.1f} cm/s", pgv=100 * used.pgv), measure=used.measure,
        sigma=used.dispersion, source=used.dispersion_source, own=building.motion_uncertainty or 0.0,
        motion=max(one.dispersion for parallel in demands.values() for one in parallel if one.site),
    )  # fmt: skip
    yield Problem("note", "Building", cell, message)
    every = {name: {one.source for one in parallel} for (name, _), parallel in demands.items()}
    own = [name for name, sources in every.items() if not sources & {"profile", "beam"}]
    if own:
        message = nfill(
            "floor {floors} keeps its own motion, which could be that of another earthquake.",
            "floors {floors} keep their own motions, which could be those of another earthquake.",
            len(own), floors=", ".join(own),
        )  # fmt: skip
        yield Problem("note", "Floors", "", message)
    for caution in used.cautions:
        yield Problem("warning", "Building", cell, fill("{caution}.", caution=caution))


def _name(site: SiteGround) -> Text:
    if site.kind == "shakemap":
        return fill("The ShakeMap {file}", file=site.file)
    return fill("The ground motion of {file}", file=site.file)


def _on_assumed_shaking(inventory: Inventory, demands: Demands) -> Iterator[Problem]:
    """Yield the notes on the line Shaking of Building; none where it is blank."""
    building = inventory.building
    if building.shaking not in SHAKINGS:
        return
    cell, used = building.cell("shaking"), find_shaking(demands)
    if used is None:
        ground, why = find_ground(inventory), fill("every floor has a motion of its own")
        if ground.shaking is None:
            why = fill("a ShakeMap gives the ground motion") if ground.site else fill("Ground PGA or SDS is filled in")
        yield Problem("note", "Building", cell, _unused(fill("Shaking"), why))
        return
    message = fill(
        "the shaking is assumed: '{choice}' stands for a ground PGA of {pga:.3f} g and a PGV of {pgv:.1f} cm/s, the "
        "published medians.",
        choice=fill(used.choice), pga=used.pga / GRAVITY, pgv=used.pgv / VELOCITY["cm/s"],
    )  # fmt: skip
    fix = fill(
        "To know it better: type the PGA of a hazard map or a ShakeMap at the address into Ground PGA, or name records "
        "in Floors."
    )
    yield Problem("note", "Building", cell, message, fix)
    given = building.motion_uncertainty
    if given is not None and given < used.scatter:
        why = fill("{scatter:.2f}, the scatter of ln PGV given the assumed intensity, is larger", scatter=used.scatter)
        message = _unused(fill("Motion uncertainty {given:g}", given=given), why)
        yield Problem("note", "Building", building.cell("motion_uncertainty"), message)
