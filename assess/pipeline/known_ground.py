"""Ground motion and building as the workbook gives them, from which floors without a motion follow."""

import math
from collections.abc import Collection
from dataclasses import dataclass, field, replace

from assess.intensity import SHAKINGS, Shaking
from assess.model import Floor, Inventory
from assess.motion import assumed
from assess.motion.assumed import assume_elevation, find_lowest_number
from assess.motion.site_ground import SiteGround


@dataclass(frozen=True, slots=True, kw_only=True)
class Ground:
    """The ground motion, the roof and the building.

    * `motion`: medians of PGA and PGV, as far as they are known; None where nothing gives them: Ground PGA or PGV, SDS,
      a ShakeMap, scenarios, Shaking.
    * `building`: T1, by its height where it is not given, and its structure.
    * `is_from_sds`: whether PGA is 0.4 SDS.
    * `roof`: height of the roof [m], at least 0; None where neither Height nor Storeys nor any Elevation is given.
    * `is_highest_floor`: whether `roof` is the highest floor of the workbook, which makes z/h too large.
    * `shaking`, `site`: the assumed intensity, the ShakeMap or the scenarios that `motion` is the median of.
    * `storeys`: storeys above ground, from which the elevations of numbered floors are assumed; None where a floor
      above the ground has its own.
    * `lowest`: the number of the ground floor.
    """

    motion: assumed.Ground | None = None
    building: assumed.Building = field(default_factory=assumed.Building)
    is_period_given: bool = False
    is_from_sds: bool = False
    roof: float | None = None
    is_highest_floor: bool = False
    shaking: Shaking | None = None
    site: SiteGround | None = None
    storeys: int | None = None
    lowest: int = 0

    @property
    def pga(self) -> float | None:
        """Median peak ground acceleration [m/s2]."""
        return None if self.motion is None else self.motion.peaks[0]

    @property
    def pgv(self) -> float | None:
        """Median peak ground velocity [m/s], where it is known."""
        return None if self.motion is None else self.motion.pgv

    @property
    def dispersion(self) -> float:
        """Standard deviation of ln of what is known of the ground [-]: of PGV where that is; 0 of a typed value."""
        if self.site:
            return self.site.dispersion
        return self.shaking.scatter if self.shaking else 0.0

    def find_pga(self, sources: Collection[str]) -> float | None:
        """Return the peak that motions of floors with these sources belong to [m/s2]; None where it is not known.

        Only Ground PGA is that of floors with motions of their own: an SDS, an intensity or a map serves the others.
        """
        serves_others = self.is_from_sds or self.shaking or self.site
        return None if serves_others and not set(sources) <= {"profile", "beam"} else self.pga

    def place(self, floor: Floor) -> tuple[float | None, tuple[str, ...]]:
        """Return the elevation of a floor [m] with its flags: as filled in, else by Storeys and Height, else None."""
        if floor.elevation is not None:
            return floor.elevation, ()
        assumed = None if self.is_highest_floor else assume_elevation(floor.floor, self.roof, self.storeys, self.lowest)
        return assumed, () if assumed is None else ("assumed_elevation",)

    def find_ratio(self, floor: Floor) -> float | None:
        """Return z/h of a floor, 0 at and below grade, at most 1 [-]; None where it is not known."""
        z, _ = self.place(floor)
        if z is None or z <= 0:
            return z if z is None else 0.0
        return min(z / self.roof, 1.0) if self.roof else None


def find_ground(inventory: Inventory) -> Ground:
    """Return what the workbook gives, as far as it does."""
    building = inventory.building
    highest = max((floor.elevation for floor in inventory.floors if floor.elevation is not None), default=None)
    lowest = find_lowest_number((floor.floor, floor.elevation) for floor in inventory.floors)
    pga = building.known_pga
    site = inventory.site_ground if pga is None else None
    shaking = SHAKINGS.get(building.shaking) if pga is None and site is None else None
    motion, pgv = None, building.ground_pgv  # a Ground PGV that is typed rules that of a map or an intensity
    if site:
        motion = assumed.Ground(pga=site.pga, pgv=site.pgv if pgv is None else pgv)
    elif shaking:
        motion = assumed.Ground(pga=None if shaking.is_derived else shaking.pga, pgv=pgv or shaking.pgv)
    elif pga is not None or pgv is not None:
        motion = assumed.Ground(pga=pga, pgv=pgv)
    by_storeys, is_highest = assumed.STOREY * building.storeys if building.storeys else 0.0, False
    if building.height is not None:
        roof: float | None = building.height
    elif by_storeys > max(highest or 0.0, 0.0):
        roof = by_storeys
    else:
        roof, is_highest = None if highest is None else max(highest, 0.0), True
    known = assumed.Building(structure=building.structure or assumed.UNKNOWN)
    if building.period is not None:
        known = replace(known, period=building.period)
    elif (by_height := assumed.estimate_period(roof)) is not None:
        known = replace(known, period=by_height, scatter=assumed.SCATTER)
    return Ground(
        motion=motion, building=known, is_period_given=building.period is not None,
        is_from_sds=building.ground_pga is None and building.sds is not None, roof=roof, is_highest_floor=is_highest,
        shaking=shaking, site=site, storeys=None if lowest is None else building.storeys, lowest=lowest or 0,
    )  # fmt: skip


def find_dispersion(ground: Ground, given: float | None) -> float:
    """Return the standard deviation of ln amplitude of floors that follow from the ground [-].

    `given` is Motion uncertainty. The scatter of an assumed intensity is the total one, of earthquakes and sites alike:
    it stands in for a smaller value, and adds to none; that of a map or of scenarios adds to its variance.
    """
    if ground.site:
        return math.hypot(given or 0.0, ground.dispersion)
    return max(given or 0.0, ground.dispersion)
