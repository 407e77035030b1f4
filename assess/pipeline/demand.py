"""How each floor shakes: from records, given peaks and the ground motion to one demand per floor, axis and source.

Precedence, as filled: a floor's record on an axis, then its given PFA and PFV. Where one axis alone is known it serves
both, flagged ``one_axis_only``. A floor of which nothing is known is interpolated between the nearest floors above and
below where both have records, flagged ``interpolated``; else it is that of a beam on the ground motion, flagged
``drawn_building``: on the record of the ground where a floor at grade has one, else on drawn motions of Ground PGA and
Ground PGV, else of 0.4 SDS, else of the median of a ShakeMap or of computed scenarios at the building, flagged
``shakemap`` or ``scenarios``, else of the published median of an assumed intensity (Shaking), flagged
``assumed_shaking``. A PFV that is not given follows from PFA as the beam has it.

Medians of a drawn ground are those of `assess.motion.floor_medians`. A record of the ground is passed through beams
itself. Where peaks of floors above the ground are known, the factors by which they differ from the beam's go on in
height, their logarithms straight from floor to floor, and down to 1 on a ground that is known.
"""

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from assess.arrays import FloatArray
from assess.errors import Gap, Problem, WorkbookError
from assess.i18n import fill, join
from assess.intensity import Shaking
from assess.model import AXES, Axis, Floor, Inventory
from assess.motion import assumed
from assess.motion.assumed import FloorTarget, Meets
from assess.motion.floor_medians import find_medians, is_within
from assess.motion.record import Motion, Record, treat
from assess.motion.scenario import PROFILES, Profile
from assess.motion.site_ground import SiteGround
from assess.pipeline.known_ground import Ground, find_dispersion, find_ground
from assess.progress import SILENT, Progress
from assess.results import MOTION_FLAGS
from assess.rocking.draws import MOTION
from assess.workbook.check import describe_unserved

Source = Literal["record", "given", "interpolated", "profile", "beam"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Drawn:
    """What the draws of a floor start from, and what they are brought to.

    * `building`: of which each draw has a beam.
    * `ground`: the ground motion in a unit of its own, of which `target.factor` is the multiple.
    * `record`: the record of the ground that takes its place.
    * `at_grade`: the floor at grade whose motion that of the ground is; "" where Building gives it.
    """

    building: assumed.Building
    ground: assumed.Ground
    record: "Demand | None"
    target: FloorTarget
    at_grade: str = ""

    @property
    def is_unknown(self) -> bool:
        """Whether nothing is known of the building, nor of the floor's height."""
        return self.building.period is None and self.target.place is None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Demand:
    """The motion of one floor along one axis from one source.

    * `pfa`, `pfv`: peak floor acceleration [m/s2] and velocity [m/s]: medians, where its draws are not brought to each.
    * `name`: the record as the workbook names it, else "".
    * `record`, `motion`: the recorded motion, as in the file and as treated.
    * `between`: the floors below and above that it is interpolated between.
    * `drawn`: how its draws are made where it has no record.
    * `profile`: the code's profile, with its clause.
    * `height_ratio`, `amplification`: z/h [-], and PFA over the ground's PGA where PFA follows from it [-].
    * `shaking`, `site`: the assumed intensity, the ShakeMap or the scenarios that give the ground motion.
    * `own_dispersion`, `dispersion`: standard deviation of ln amplitude from one earthquake to the next [-]: at a known
      ground motion, and with the scatter of what gives the ground motion.
    * `flags`: keys of `assess.results.MOTION_FLAGS`.
    * `scale`: factor by which all of this was multiplied [-].
    """

    floor: Floor
    axis: Axis
    source: Source
    pfa: float
    pfv: float
    name: str = ""
    record: Record | None = None
    motion: Motion | None = None
    between: tuple[str, ...] = ()
    drawn: Drawn | None = None
    profile: Profile | None = None
    clause: str = ""
    height_ratio: float | None = None
    amplification: float | None = None
    shaking: Shaking | None = None
    site: SiteGround | None = None
    own_dispersion: float = MOTION
    dispersion: float = MOTION
    flags: tuple[str, ...] = ()
    scale: float = 1.0

    @property
    def loss(self) -> float:
        """Share of the file's own peak that treatment took away [-]; 0 where no record is."""
        return 1 - self.pfa / (self.scale * self.record.file_pfa) if self.record and self.record.file_pfa else 0.0

    def scaled(self, factor: float) -> "Demand":
        """Return it with its motion multiplied by a factor [-]; the record stays as it is in its file."""
        if factor == 1.0:
            return self
        series = ("acceleration", "velocity", "displacement")
        motion = self.motion and replace(self.motion, **{one: factor * getattr(self.motion, one) for one in series})
        drawn, target = self.drawn, self.drawn and self.drawn.target
        if drawn and target:
            anchors = tuple((place, factor * pfa) for place, pfa in target.anchors)
            peaks = {name: factor * getattr(target, name) for name in ("pfa", "pfv", "factor")}
            drawn = replace(drawn, target=replace(target, **peaks, anchors=anchors))
        scaled = {name: factor * getattr(self, name) for name in ("pfa", "pfv", "scale")}
        return replace(self, **scaled, motion=motion, drawn=drawn)

    @property
    def label(self) -> str:
        """Its source in short: the record's name, "given", the profile's code with its intensity, or two floors."""
        if self.between:
            below, above = self.between
            if below == above:
                return fill("as floor {floor}", floor=below)
            return fill("interpolated between {below} and {above}", below=below, above=above)
        if self.profile:
            is_from = self.shaking or self.site
            return join(", ", [self._ground, self.profile.key]) if is_from else self.profile.key
        if self.source != "beam":
            return self.name or fill("given")
        return fill("{ground}, beam", ground=self._ground)

    @property
    def _ground(self) -> str:
        """The ground motion of its beam in short."""
        if self.drawn and self.drawn.record:
            return self.drawn.record.name
        if self.drawn and self.drawn.at_grade:
            return fill("floor {floor}", floor=self.drawn.at_grade)
        if self.shaking:
            return fill("Shaking {intensity}", intensity=self.shaking.name)
        if self.site:
            return fill("ShakeMap") if self.site.kind == "shakemap" else fill("scenarios")
        return fill("Ground PGA") if self.amplification else fill("known floors")

    @property
    def recorded(self) -> tuple[FloatArray, float] | None:
        """The recorded motion as treated [m/s2], and its time step [s]."""
        return None if self.motion is None else (self.motion.acceleration, self.motion.time_step)

    @property
    def is_borrowed(self) -> bool:
        """Whether it is the motion of the floor's other axis."""
        return "one_axis_only" in self.flags and not self.between


Demands = Mapping[tuple[str, Axis], tuple[Demand, ...]]
"""The demands of every floor (by its name) and axis; parallel records give several."""


_ByAxis = Mapping[Axis, tuple[Demand, ...]]


def build_demands(
    inventory: Inventory, scenario: str, *, ductility_reduction: float = 1.0, progress: Progress = SILENT
) -> dict[tuple[str, Axis], tuple[Demand, ...]]:
    """Return the demands of every floor (by its name) and axis; parallel records give several.

    `scenario` is one of `assess.settings.SCENARIOS`, `ductility_reduction` R_mu of ASCE 7-22 [-]; `progress` is checked
    for a cancel while records are treated. Raises WorkbookError that names every floor without a motion of the kind
    that `scenario` asks for.
    """
    demands, problems = serve_floors(inventory, scenario, ductility_reduction=ductility_reduction, progress=progress)
    if problems:
        raise WorkbookError(problems)
    return demands


def serve_floors(
    inventory: Inventory, scenario: str, *, ductility_reduction: float = 1.0, progress: Progress = SILENT
) -> tuple[dict[tuple[str, Axis], tuple[Demand, ...]], list[Problem]]:
    """Return the demands of the floors that have any, and why the others have none; as `build_demands` takes them."""
    ground = find_ground(inventory)
    own = {floor.floor: _own_demands(floor, scenario, progress) for floor in inventory.floors}
    bases = {axis: _find_basis(ground, own.values(), axis) for axis in AXES}
    building = _Building(inventory, ground, own, bases, scenario, ductility_reduction)
    problems: list[Problem] = []
    if scenario in PROFILES and ground.pga is None:
        message = fill(
            "Ground PGA, SDS, ShakeMap file and Shaking are blank; the scenario '{scenario}' needs one of them.",
            scenario=fill(scenario),
        )
        fix = fill("Fill in Ground PGA, choose Shaking, or choose another scenario.")
        problems.append(Gap("error", "Building", inventory.building.cell("ground_pga"), message, fix))
    demands: dict[tuple[str, Axis], tuple[Demand, ...]] = {}
    for floor in inventory.floors:
        served = building.serve(floor)
        if not served:
            problems += _missing(floor, scenario)
        demands |= {(floor.floor, axis): served[axis] for axis in served}
    return demands, [inventory.place(problem) for problem in problems]


def find_shaking(demands: Demands) -> Shaking | None:
    """Return the assumed intensity that serves a floor, of which a run has one at most."""
    return next((one.shaking for parallel in demands.values() for one in parallel if one.shaking), None)


def find_site(demands: Demands) -> SiteGround | None:
    """Return the ShakeMap or the scenarios that serve a floor, of which a run has one at most."""
    return next((one.site for parallel in demands.values() for one in parallel if one.site), None)


def scale_demands(demands: Demands, factor: float) -> Demands:
    """Return the demands with every motion multiplied by a factor [-]."""
    return {place: tuple(one.scaled(factor) for one in parallel) for place, parallel in demands.items()}


# ---------------------------------------------------------------- what a floor has of its own


def _own_demands(floor: Floor, scenario: str, progress: Progress) -> _ByAxis:
    """Return the motions that the workbook gives for a floor and `scenario` uses, if any; a PFV not given is NaN."""
    found: dict[Axis, tuple[Demand, ...]] = {}
    for axis in AXES:
        if scenario in ("as filled", "recorded") and floor.records.get(axis):
            treated = ((one, treat(one.record, progress=progress)) for one in floor.records[axis])
            found[axis] = tuple(
                Demand(
                    floor=floor, axis=axis, source="record", pfa=motion.pfa, pfv=motion.pfv, name=one.name,
                    record=one.record, motion=motion,
                )
                for one, motion in treated
            )  # fmt: skip
        elif scenario in ("as filled", "given") and axis in floor.pfa:
            pfv = floor.pfv.get(axis, math.nan)
            found[axis] = (Demand(floor=floor, axis=axis, source="given", pfa=floor.pfa[axis], pfv=pfv),)
    if len(found) == 1:
        ((known, demands),) = found.items()
        axis = "Y" if known == "X" else "X"
        found[axis] = tuple(replace(one, axis=axis, flags=(*one.flags, "one_axis_only")) for one in demands)
    return {axis: found[axis] for axis in AXES} if found else {}


# ---------------------------------------------------------------- floors of which nothing is known


def _interpolate(floor: Floor, known: Iterable[_ByAxis]) -> _ByAxis:
    """Return the motion of a floor from the nearest known ones below and above it; nothing where it lacks either.

    Where one of them has no record, the beam serves what lies between them.
    """
    z, found = floor.elevation, dict[Axis, tuple[Demand, ...]]()
    if z is None:
        return found
    for axis in AXES:
        floors = [
            (level, max(one.pfa for one in parallel), max(one.pfv for one in parallel), parallel)
            for parallel in (demands[axis] for demands in known)
            if (level := parallel[0].floor.elevation) is not None
        ]
        below = max((one for one in floors if one[0] <= z), key=lambda one: one[:2], default=None)
        above = min((one for one in floors if one[0] >= z), key=lambda one: (one[0], -one[1]), default=None)
        if below is None or above is None:
            continue
        (z_0, *peaks, lower), (z_1, *others, upper) = below, above
        if z_1 > z_0 and not all(one.source == "record" for one in (*lower, *upper)):
            continue
        share = (z - z_0) / (z_1 - z_0) if z_1 > z_0 else 0.0
        pfa, pfv = (one + (other - one) * share if share else one for one, other in zip(peaks, others, strict=True))
        names = (lower[0].floor.floor, upper[0].floor.floor)
        carried = {flag for one in (*lower, *upper) for flag in one.flags}
        flags = tuple(flag for flag in MOTION_FLAGS if flag == "interpolated" or flag in carried)
        one = Demand(floor=floor, axis=axis, source="interpolated", pfa=pfa, pfv=pfv, between=names, flags=flags)
        found[axis] = (one,)
    return found


# ---------------------------------------------------------------- floors on a beam


_UNIT = assumed.Ground(pga=1.0)
"""The ground motion of a building of which the ground is not known: of any PGA."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Basis:
    """What shakes the floors of a building along one axis.

    * `motion`: of the ground; None where it is not known.
    * `record`: the record of the ground.
    * `known`: z/h of the floors above the ground of which peaks are known [-], and those.
    * `is_recorded`: whether any floor has a record.
    * `at_grade`: the floor at grade whose motion that of the ground is; "" where Building gives it.
    """

    building: assumed.Building
    motion: assumed.Ground | None = None
    record: Demand | None = None
    known: Sequence[tuple[float, Demand]] = ()
    is_recorded: bool = False
    at_grade: str = ""
    _found: dict[float | None, tuple[float, float]] = field(default_factory=dict)

    @property
    def is_known(self) -> bool:
        """Whether the ground motion is known."""
        return self.motion is not None or self.record is not None

    @property
    def ground(self) -> assumed.Ground:
        """Medians of the ground motion: those of the record, the known ones, or those of 1 m/s2."""
        if self.record is not None:
            return assumed.Ground(pga=self.record.pfa, pgv=self.record.pfv)
        return self.motion or _UNIT

    def find_beam(self, place: float | None) -> tuple[float, float]:
        """Return the median PFA [m/s2] and PFV [m/s] that the beam has at z/h `place`."""
        if place in self._found:
            return self._found[place]
        (pga, pgv), building = self.ground.peaks, self.building
        motion = None if self.record is None else self.record.motion
        if motion is not None and not (place is not None and place <= 0):
            from assess.motion.beam import shake_record

            found = shake_record(motion.acceleration, motion.time_step, building, place)
        else:
            by_pga, by_pgv = find_medians(building.period, place, building.structure, self.ground.ratio)
            found = pga * by_pga, pgv * by_pgv
        self._found[place] = found
        return found

    def find_velocity(self, place: float | None) -> float:
        """Return PFV over PFA [s] of a floor of which PFA alone is known."""
        pfa, pfv = self.find_beam(place)
        return pfv / pfa

    def find_peaks(self, place: float | None) -> tuple[float, float]:
        """Return the median PFA [m/s2] and PFV [m/s] of a floor at z/h `place`, by the beam and by known floors."""
        found = self.find_beam(place)
        if place is None or not self.known or (place <= 0 and self.is_known):
            return found
        places, logs = [], []
        for at, demand in sorted(self.known, key=lambda one: one[0]):
            beam = self.find_beam(at)
            places.append(at)
            logs.append((math.log(demand.pfa / beam[0]), math.log(demand.pfv / beam[1])))
        if self.is_known:
            places, logs = [0.0, *places], [(0.0, 0.0), *logs]
        by_pfa, by_pfv = (math.exp(float(np.interp(place, places, one))) for one in zip(*logs, strict=True))
        return found[0] * by_pfa, found[1] * by_pfv

    def draw(self, place: float | None, pfa: float, pfv: float, meets: Meets) -> Drawn:
        """Return how the draws of a floor with these peaks are made; on a known ground with its peaks as it is."""
        ground, factor = self.ground, self.ground.pga or self.ground.pgv or 1.0
        unit = assumed.Ground(pga=_round(1.0 if ground.pga else None), pgv=_round(ground.pgv and ground.pgv / factor))
        is_ground = place is not None and place <= 0 and self.is_known
        if is_ground and meets != "peaks" and abs(pfa / ground.peaks[0] - 1) < 1e-9:
            meets = "nothing"
        target = FloorTarget(
            place=place, pfa=pfa, pfv=pfv, meets=meets, is_ground_known=self.is_known,
            factor=1.0 if self.record is not None else factor,
            anchors=tuple((at, demand.pfa) for at, demand in self.known) if meets == "medians" else (),
        )  # fmt: skip
        building = replace(self.building, period=_round(self.building.period))
        return Drawn(building=building, ground=unit, record=self.record, target=target, at_grade=self.at_grade)


def _round(value: float | None) -> float | None:
    """Return a number to six digits, so that rounding errors of products make no motions of their own."""
    return None if value is None else float(f"{value:.6g}")


@dataclass(frozen=True, slots=True)
class _Building:
    inventory: Inventory
    ground: Ground
    own: Mapping[str, _ByAxis]
    bases: Mapping[Axis, Basis]
    scenario: str
    ductility_reduction: float

    def serve(self, floor: Floor) -> _ByAxis:
        """Return the motion of a floor; nothing where it has none."""
        own = self.own[floor.floor]
        found = own or _interpolate(floor, [one for one in self.own.values() if one])
        profile, ground = PROFILES.get(self.scenario), self.ground
        (z, placed), ratio = ground.place(floor), ground.find_ratio(floor)
        if not found and profile and z is not None and ratio is not None and ground.pga is not None:
            period = ground.building.period if ground.is_period_given else None
            amplification = profile.amplification(ratio, period, ductility_reduction=self.ductility_reduction)
            one = Demand(
                floor=floor, axis="X", source="profile", pfa=ground.pga * amplification, pfv=math.nan,
                flags=("code_profile", *_name_ground(ground), *placed), profile=profile, clause=profile.cite(period),
                height_ratio=ratio, amplification=amplification, shaking=ground.shaking, site=ground.site,
            )  # fmt: skip
            found = {"X": (one,), "Y": (replace(one, axis="Y"),)}  # alike along both axes
        if found:
            return {axis: tuple(self._complete(one) for one in found[axis]) for axis in found}
        served = {axis: self._serve_by_beam(floor, axis) for axis in AXES}
        return {axis: (one,) for axis, one in served.items() if one} if all(served.values()) else {}

    def _complete(self, one: Demand) -> Demand:
        """Return a demand with how its draws are made, its PFV and its dispersions."""
        place = self.ground.find_ratio(one.floor)
        if one.motion is not None:
            given = self.inventory.building.motion_uncertainty
            spread = MOTION if given is None else given
            return replace(one, height_ratio=place, own_dispersion=spread, dispersion=spread)
        basis = self.bases[one.axis]
        is_met = one.pfv > 0
        pfv = one.pfv if is_met else one.pfa * basis.find_velocity(place)
        drawn = basis.draw(place, one.pfa, pfv, "peaks" if is_met else "pfa")
        return self._finish(replace(one, pfv=pfv, height_ratio=place, drawn=drawn), basis)

    def _serve_by_beam(self, floor: Floor, axis: Axis) -> Demand | None:
        place, basis = self.ground.find_ratio(floor), self.bases[axis]
        places = [one for one, _ in basis.known]
        if self.scenario in PROFILES:
            return None
        if self.scenario == "as filled":
            can_serve = basis.is_known or (place is not None and bool(places))
        else:  # only between the ground or floors of which peaks are known, and such floors
            is_above = basis.is_known or (place is not None and bool(places) and min(places) <= place)
            can_serve = is_above and place is not None and place <= max(places, default=-math.inf)
        if not can_serve:
            return None
        (pfa, pfv), (pga, _) = basis.find_peaks(place), basis.ground.peaks
        named = _name_ground(self.ground) if basis.record is None else ()
        flags = ("drawn_building", *named, *self.ground.place(floor)[1])
        one = Demand(
            floor=floor, axis=axis, source="beam", pfa=pfa, pfv=pfv, flags=flags, height_ratio=place,
            drawn=basis.draw(place, pfa, pfv, "medians"), amplification=pfa / pga if basis.is_known else None,
            shaking=self.ground.shaking if named else None, site=self.ground.site if named else None,
        )  # fmt: skip
        return self._finish(one, basis)

    def _finish(self, one: Demand, basis: Basis) -> Demand:
        """Return a demand with the flags of what is drawn, and with its dispersions."""
        flags = dict.fromkeys(one.flags)
        if one.height_ratio is None:
            flags["unknown_building" if basis.building.period is None else "unknown_height"] = None
        elif one.height_ratio > 0 and not is_within(basis.building.period, basis.ground.ratio):
            flags["beyond_table"] = None
        given, is_recorded = self.inventory.building.motion_uncertainty, basis.is_recorded
        own = (MOTION if given is None else given) if is_recorded else given or 0.0
        dispersion = find_dispersion(self.ground, given) if one.source == "beam" and not is_recorded else own
        return replace(one, flags=tuple(flags), own_dispersion=own, dispersion=dispersion)


def _name_ground(ground: Ground) -> tuple[str, ...]:
    """Return the flag of what gives the ground motion, none where the workbook does."""
    if ground.shaking:
        return ("assumed_shaking",)
    return (ground.site.kind,) if ground.site else ()


def _find_basis(ground: Ground, own: Collection[_ByAxis], axis: Axis) -> Basis:
    """Return what shakes the floors along one axis: a motion that is known at grade comes before the ground's."""
    placed = [(ground.find_ratio(served[axis][0].floor), served[axis]) for served in own if served]
    known = [(place, max(parallel, key=lambda one: one.pfa)) for place, parallel in placed if place is not None]
    at_grade = next((one for place, one in known if place <= 0), None)
    motion, record = ground.motion, None
    if at_grade is not None and at_grade.source == "record":
        motion, record = None, at_grade
    elif at_grade is not None:
        motion = assumed.Ground(pga=at_grade.pfa, pgv=at_grade.pfv if at_grade.pfv > 0 else None)
    is_recorded = any(one.source == "record" for served in own for parallel in served.values() for one in parallel)
    basis = Basis(
        building=ground.building, motion=motion, record=record, is_recorded=is_recorded,
        at_grade="" if at_grade is None else at_grade.floor.floor,
    )  # fmt: skip
    above = [(place, one) for place, one in known if place > 0]
    known = [
        (place, one if one.pfv > 0 else replace(one, pfv=one.pfa * basis.find_velocity(place))) for place, one in above
    ]
    return replace(basis, known=known)


# ---------------------------------------------------------------- what is missing


def _missing(floor: Floor, scenario: str) -> list[Problem]:
    """Return why the motion of a floor is not known, and how to fix it."""
    placed = floor.elevation is not None
    if scenario in PROFILES:
        message = fill(
            "floor '{floor}' has no Elevation, which the scenario '{scenario}' needs.",
            floor=floor.floor, scenario=fill(scenario),
        )  # fmt: skip
        return [] if placed else [Problem("error", "Floors", floor.cell("elevation"), message, _FILL_IN)]
    if scenario == "as filled":
        message, fix = describe_unserved(f"'{floor.floor}'", has_elevation=placed)
        return [Gap("error", "Floors", floor.cell("pfa_x"), message, fix)]
    wanted, where = {"recorded": (fill("record"), "record_x"), "given": ("PFA", "pfa_x")}[scenario]
    message = fill(
        "floor '{floor}' has no {wanted}, which the scenario '{scenario}' needs; it cannot be interpolated, as {why}.",
        floor=floor.floor, wanted=wanted, scenario=fill(scenario),
        why=fill("it does not lie between two floors that have one") if placed else fill("its Elevation is blank"),
    )  # fmt: skip
    return [Problem("error", "Floors", floor.cell(where), message, _FILL_IN)]


_FILL_IN = fill("Fill it in, or choose another scenario.")
