"""How each floor shakes: from records, given peaks and design profiles to one demand per floor, axis and source.

Precedence, as filled: a floor's record on an axis, then its given PFA and PFV. Where one axis alone is known it serves
both, flagged ``one_axis_only``. A floor of which nothing is known is interpolated between the nearest floors above and
below of which something is, flagged ``interpolated``; where it does not lie between two such, a code's profile serves
it from Ground PGA, flagged ``code_profile``: else from 0.4 SDS, else from the median of a ShakeMap or of computed
scenarios at the building, flagged ``shakemap`` or ``scenarios``, else from the published median of an assumed intensity
(Shaking), flagged ``assumed_shaking``. A PFV that is not given is estimated from T1, flagged ``pfv_estimated``; where
Ground PGV is known, or that of the map or the intensity, a larger estimate is capped by it, flagged ``pfv_capped``.
"""

import math
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

from assess.errors import ElevationGap, Gap, Problem, WorkbookError
from assess.i18n import fill
from assess.intensity import SHAKINGS, Shaking
from assess.model import AXES, Axis, Floor, FloorRecord, Inventory
from assess.motion.record import Motion, Record, treat
from assess.motion.scenario import DEFAULT, PGA_OF_SDS, PROFILES, Profile, cap_pfv, estimate_pfv
from assess.motion.site_ground import SiteGround
from assess.motion.storeys import assume_elevation
from assess.progress import SILENT, Progress
from assess.results import MOTION_FLAGS
from assess.workbook.check import describe_unserved

Source = Literal["record", "given", "interpolated", "profile"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Demand:
    """The motion of one floor along one axis from one source.

    Parameters
    ----------
    floor : Floor
        The floor.
    axis : "X" or "Y"
        The axis that it serves.
    source : "record", "given", "interpolated" or "profile"
        Where it comes from.
    pfa, pfv : float
        Peak floor acceleration [m/s2] and velocity [m/s]; `pfv` is NaN where it is unknown.
    name : str
        The record as the workbook names it, else "".
    record, motion : Record, Motion, optional
        The recorded motion, as in the file and as treated.
    between : tuple of str
        The floors below and above that it is interpolated between.
    profile : Profile, optional
        The code's profile, with its clause, the height ratio z/h and the amplification [-] that it gave.
    shaking : Shaking, optional
        The assumed intensity from which the profile starts.
    site : SiteGround, optional
        The ShakeMap or the scenarios from which it starts.
    flags : tuple of str
        Keys of `assess.results.MOTION_FLAGS`.
    scale : float
        Factor by which all of this was multiplied [-].
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
    profile: Profile | None = None
    clause: str = ""
    height_ratio: float | None = None
    amplification: float | None = None
    shaking: Shaking | None = None
    site: SiteGround | None = None
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
        motion = self.motion and replace(
            self.motion, acceleration=factor * self.motion.acceleration, velocity=factor * self.motion.velocity,
            displacement=factor * self.motion.displacement,
        )  # fmt: skip
        return replace(self, pfa=factor * self.pfa, pfv=factor * self.pfv, motion=motion, scale=factor * self.scale)

    @property
    def label(self) -> str:
        """Its source in short: the record's name, "given", the profile's code with its intensity, or two floors."""
        if self.is_level:
            return fill("as floor {floor}", floor=self.between[0])
        if self.between:
            below, above = self.between
            return fill("interpolated between {below} and {above}", below=below, above=above)
        if self.profile and self.shaking:
            return fill("Shaking {intensity}, {code}", intensity=self.shaking.name, code=self.profile.key)
        if self.profile and self.site:
            from_map = fill("ShakeMap, {code}", code=self.profile.key)
            return from_map if self.site.kind == "shakemap" else fill("scenarios, {code}", code=self.profile.key)
        return self.profile.key if self.profile else self.name or fill("given")

    @property
    def is_level(self) -> bool:
        """Whether it is the motion of another floor at the same height."""
        return len(set(self.between)) == 1

    @property
    def is_borrowed(self) -> bool:
        """Whether it is the motion of the floor's other axis."""
        return "one_axis_only" in self.flags and not self.between


Demands = Mapping[tuple[str, Axis], tuple[Demand, ...]]
"""The demands of every floor (by its name) and axis; parallel records give several."""

_ByAxis = Mapping[Axis, tuple[Demand, ...]]
_Estimate = Callable[[float, float], tuple[float, tuple[str, ...]]]


@dataclass(frozen=True, slots=True)
class Ground:
    """The ground motion that a profile and the estimate of PFV start from, and the roof.

    Parameters
    ----------
    pga : float, optional
        Peak ground acceleration [m/s2]; None where nothing gives it: Ground PGA, SDS, a ShakeMap, scenarios, Shaking.
    is_from_sds : bool
        Whether it is 0.4 SDS.
    roof : float, optional
        Height of the roof [m], at least 0; None where neither Height nor any Elevation is given.
    is_highest_floor : bool
        Whether `roof` is the highest floor of the workbook, which makes z/h larger than the roof would.
    pgv : float, optional
        Peak ground velocity [m/s] as filled in, which caps the PFV that is estimated from T1.
    shaking : Shaking, optional
        The assumed intensity that `pga` is the median of; its PGV caps as `pgv` does, on floors that follow a profile.
    site : SiteGround, optional
        The ShakeMap or the scenarios whose median `pga` is, likewise.
    storeys : int, optional
        Storeys above ground, from which the elevations of numbered floors are assumed; None where a floor has its own.
    """

    pga: float | None
    is_from_sds: bool
    roof: float | None
    is_highest_floor: bool
    pgv: float | None = None
    shaking: Shaking | None = None
    site: SiteGround | None = None
    storeys: int | None = None

    @property
    def profile_pgv(self) -> float | None:
        """Peak ground velocity [m/s] that belongs to `pga`: as filled in, else of the map or the assumed intensity."""
        source = self.site or self.shaking
        return source.pgv if self.pgv is None and source else self.pgv

    def find_pga(self, sources: Collection[Source]) -> float | None:
        """Return the peak that motions of floors with these sources belong to [m/s2]; None where it is not known.

        Only Ground PGA is that of floors with motions of their own: an SDS, an intensity or a map serves profiles.
        """
        serves_profiles = self.is_from_sds or self.shaking or self.site
        return None if serves_profiles and set(sources) != {"profile"} else self.pga

    def place(self, floor: Floor) -> tuple[float | None, tuple[str, ...]]:
        """Return the elevation of a floor [m] with its flags: as filled in, else by Storeys and Height, else None."""
        if floor.elevation is not None:
            return floor.elevation, ()
        assumed = None if self.is_highest_floor else assume_elevation(floor.floor, self.roof, self.storeys)
        return assumed, () if assumed is None else ("assumed_elevation",)


def find_ground(inventory: Inventory) -> Ground:
    """Return what profiles and estimates start from, as far as the workbook gives it."""
    building = inventory.building
    highest = max((floor.elevation for floor in inventory.floors if floor.elevation is not None), default=None)
    by_sds = building.ground_pga is None and building.sds is not None
    pga = PGA_OF_SDS * building.sds if by_sds and building.sds is not None else building.ground_pga
    site = inventory.site_ground if pga is None else None
    shaking = SHAKINGS.get(building.shaking) if pga is None and site is None else None
    found = site or shaking
    return Ground(
        pga=found.pga if found else pga,
        is_from_sds=by_sds,
        roof=building.height if building.height is not None or highest is None else max(highest, 0.0),
        is_highest_floor=building.height is None,
        pgv=building.ground_pgv,
        shaking=shaking,
        site=site,
        storeys=building.storeys if highest is None else None,
    )


def build_demands(
    inventory: Inventory, scenario: str, *, ductility_reduction: float = 1.0, progress: Progress = SILENT
) -> dict[tuple[str, Axis], tuple[Demand, ...]]:
    """Return the demands of every floor (by its name) and axis; parallel records give several.

    Parameters
    ----------
    inventory : Inventory
        The floors, and the building with its ground motion.
    scenario : str
        One of `assess.settings.SCENARIOS`.
    ductility_reduction : float
        R_mu of ASCE 7-22 [-].
    progress : Progress
        Checked for a cancel while records are treated.

    Raises
    ------
    CancelledError
        If the caller stops the work.
    WorkbookError
        If a floor has no motion of the kind that `scenario` asks for; it names every such floor.
    """
    demands, problems = serve_floors(inventory, scenario, ductility_reduction=ductility_reduction, progress=progress)
    if problems:
        raise WorkbookError(problems)
    return demands


def serve_floors(
    inventory: Inventory, scenario: str, *, ductility_reduction: float = 1.0, progress: Progress = SILENT
) -> tuple[dict[tuple[str, Axis], tuple[Demand, ...]], list[Problem]]:
    """Return the demands of the floors that have any, and why the others have none; as `build_demands` takes them."""
    period, ground = inventory.building.period, find_ground(inventory)
    profile = DEFAULT if scenario == "as filled" else PROFILES.get(scenario)
    own = {floor.floor: own_demands(floor, scenario, period, ground.pgv, progress) for floor in inventory.floors}
    known = [demands for demands in own.values() if demands]
    problems = list(_check_ground(inventory, scenario, ground))
    demands: dict[tuple[str, Axis], tuple[Demand, ...]] = {}
    for floor in inventory.floors:
        served = own[floor.floor] or _interpolate(floor, known)
        if not served and profile:
            served = serve_by_profile(floor, profile, ground, period, ductility_reduction)
        if not served:
            problems += _missing(floor, scenario, ground)
        demands |= {(floor.floor, axis): served[axis] for axis in served}
    return demands, [inventory.place(problem) for problem in problems]


def find_assumed(demands: Demands) -> tuple[Shaking, Profile] | None:
    """Return the assumed intensity that serves a floor, of which a run has one at most, and its profile."""
    every = (one for parallel in demands.values() for one in parallel)
    return next(((one.shaking, one.profile) for one in every if one.shaking and one.profile), None)


def find_shaking(demands: Demands) -> Shaking | None:
    """Return the assumed intensity that serves a floor, of which a run has one at most."""
    found = find_assumed(demands)
    return None if found is None else found[0]


def find_site(demands: Demands) -> SiteGround | None:
    """Return the ShakeMap or the scenarios that serve a floor, of which a run has one at most."""
    return next((one.site for parallel in demands.values() for one in parallel if one.site), None)


def scale_demands(demands: Demands, factor: float) -> Demands:
    """Return the demands with every motion multiplied by a factor [-]."""
    return {place: tuple(one.scaled(factor) for one in parallel) for place, parallel in demands.items()}


# ---------------------------------------------------------------- what a floor has of its own


def own_demands(
    floor: Floor, scenario: str, period: float | None, ground_pgv: float | None = None, progress: Progress = SILENT
) -> _ByAxis:
    """Return the motions that the workbook gives for a floor itself and `scenario` uses; empty where there are none.

    From the building's T1 [s] and the ground's PGV [m/s], as far as they are known, a PFV that is not given follows.
    """
    estimate = partial(_velocity, period=period, ground_pgv=ground_pgv)
    found = {axis: _on_axis(floor, axis, scenario, estimate, progress) for axis in AXES}
    if not any(found.values()):
        return {}
    return {"X": found["X"] or _borrow(found["Y"], "X"), "Y": found["Y"] or _borrow(found["X"], "Y")}


def _on_axis(floor: Floor, axis: Axis, scenario: str, estimate: _Estimate, progress: Progress) -> tuple[Demand, ...]:
    if scenario in ("as filled", "recorded") and floor.records.get(axis):
        return tuple(_recorded(floor, axis, one, progress) for one in floor.records[axis])
    if scenario in ("as filled", "given") and axis in floor.pfa:
        pfv, flags = estimate(floor.pfa[axis], floor.pfv.get(axis, math.nan))
        return (Demand(floor=floor, axis=axis, source="given", pfa=floor.pfa[axis], pfv=pfv, flags=flags),)
    return ()


def _recorded(floor: Floor, axis: Axis, one: FloorRecord, progress: Progress) -> Demand:
    motion = treat(one.record, progress=progress)
    return Demand(
        floor=floor, axis=axis, source="record", pfa=motion.pfa, pfv=motion.pfv,
        name=one.name, record=one.record, motion=motion,
    )  # fmt: skip


def _velocity(pfa: float, pfv: float, period: float | None, ground_pgv: float | None) -> tuple[float, tuple[str, ...]]:
    """Return PFV with its flags: as given, else by T1, at most what Ground PGV allows, else NaN."""
    if not math.isnan(pfv) or period is None:
        return pfv, ()
    estimate = estimate_pfv(pfa, period)
    cap = math.inf if ground_pgv is None else cap_pfv(ground_pgv)
    return (cap, ("pfv_estimated", "pfv_capped")) if estimate > cap else (estimate, ("pfv_estimated",))


def _borrow(demands: tuple[Demand, ...], axis: Axis) -> tuple[Demand, ...]:
    return tuple(replace(demand, axis=axis, flags=(*demand.flags, "one_axis_only")) for demand in demands)


# ---------------------------------------------------------------- floors of which nothing is known


def _interpolate(floor: Floor, known: Iterable[_ByAxis]) -> _ByAxis:
    """Return the motion of a floor from the nearest known ones below and above it; nothing where it lacks either."""
    found = {axis: _between(floor, axis, [demands[axis] for demands in known]) for axis in AXES}
    return {axis: (demand,) for axis, demand in found.items() if demand is not None}


def _between(floor: Floor, axis: Axis, known: Iterable[tuple[Demand, ...]]) -> Demand | None:
    z = floor.elevation
    placed = [(level, demands) for demands in known if (level := demands[0].floor.elevation) is not None]
    below = [one for one in placed if z is not None and one[0] <= z]
    above = [one for one in placed if z is not None and one[0] >= z]
    if z is None or not below or not above:
        return None
    (z_0, lower), (z_1, upper) = (
        max(below, key=lambda one: (one[0], _worst(one[1])[0])),
        min(above, key=lambda one: (one[0], -_worst(one[1])[0])),
    )
    share = (z - z_0) / (z_1 - z_0) if z_1 > z_0 else 0.0
    pfa, pfv = (
        one + (other - one) * share if share else one for one, other in zip(_worst(lower), _worst(upper), strict=True)
    )
    names = (lower[0].floor.floor, upper[0].floor.floor)
    carried = {flag for one in (*lower, *upper) for flag in one.flags}
    flags = tuple(flag for flag in MOTION_FLAGS if flag == "interpolated" or flag in carried)
    return Demand(floor=floor, axis=axis, source="interpolated", pfa=pfa, pfv=pfv, between=names, flags=flags)


def _worst(demands: tuple[Demand, ...]) -> tuple[float, float]:
    """Return the largest PFA and the largest PFV of parallel records."""
    return max(demand.pfa for demand in demands), max(demand.pfv for demand in demands)


def find_height_ratio(elevation: float, roof: float) -> float:
    """Return z/h of a floor, 0 at and below grade, at most 1 [-]; both heights are above the ground [m]."""
    return min(elevation / roof, 1.0) if elevation > 0 else 0.0


def serve_by_profile(
    floor: Floor, profile: Profile, ground: Ground, period: float | None, ductility_reduction: float
) -> _ByAxis:
    """Return the motion of a floor by a code's profile, alike along both axes; nothing where its inputs are missing."""
    z, placed = ground.place(floor)
    if z is None or ground.pga is None or ground.roof is None:
        return {}
    ratio = find_height_ratio(z, ground.roof)
    amplification = profile.amplification(ratio, period, ductility_reduction=ductility_reduction)
    pfa = ground.pga * amplification
    pfv, flags = _velocity(pfa, math.nan, period, ground.profile_pgv)
    assumed = ("assumed_shaking",) if ground.shaking else (ground.site.kind,) if ground.site else ()
    one = Demand(
        floor=floor, axis="X", source="profile", pfa=pfa, pfv=pfv, flags=("code_profile", *assumed, *placed, *flags),
        profile=profile, clause=profile.cite(period), height_ratio=ratio, amplification=amplification,
        shaking=ground.shaking, site=ground.site,
    )  # fmt: skip
    return {"X": (one,), "Y": (replace(one, axis="Y"),)}


# ---------------------------------------------------------------- what is missing


def _check_ground(inventory: Inventory, scenario: str, ground: Ground) -> Iterable[Problem]:
    if scenario in PROFILES and ground.pga is None:
        message = fill(
            "Ground PGA, SDS, ShakeMap file and Shaking are blank; the scenario '{scenario}' needs one of them.",
            scenario=fill(scenario),
        )
        fix = fill("Fill in Ground PGA, choose Shaking, or choose another scenario.")
        yield Gap("error", "Building", inventory.building.cell("ground_pga"), message, fix)


def _missing(floor: Floor, scenario: str, ground: Ground) -> list[Problem]:
    """Return why the motion of a floor is not known, and how to fix it."""
    placed = floor.elevation is not None
    if scenario in PROFILES:
        message = fill(
            "floor '{floor}' has no Elevation, which the scenario '{scenario}' needs.",
            floor=floor.floor,
            scenario=fill(scenario),
        )
        return [] if placed else [Problem("error", "Floors", floor.cell("elevation"), message, _FILL_IN)]
    if scenario == "as filled":
        message, fix = describe_unserved(f"'{floor.floor}'", has_elevation=placed)
        is_unplaced = ground.pga is not None and not placed
        where, kind = ("elevation", ElevationGap) if is_unplaced else ("pfa_x", Gap)
        return [kind("error", "Floors", floor.cell(where), message, fix)]
    wanted, where = {"recorded": (fill("record"), "record_x"), "given": ("PFA", "pfa_x")}[scenario]
    message = fill(
        "floor '{floor}' has no {wanted}, which the scenario '{scenario}' needs; it cannot be interpolated, as {why}.",
        floor=floor.floor,
        wanted=wanted,
        scenario=fill(scenario),
        why=fill("it does not lie between two floors that have one") if placed else fill("its Elevation is blank"),
    )
    return [Problem("error", "Floors", floor.cell(where), message, _FILL_IN)]


_FILL_IN = fill("Fill it in, or choose another scenario.")
