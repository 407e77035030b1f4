"""What is taken of an earthquake and of a building of which little is known: medians, and what is drawn about them.

A floor of unknown elevation lies at the number in its name times the height of a storey: storeys are taken as of one
height, and floors as numbered from the ground floor, which is 0. Where the ground floor is 1, elevations come out one
storey too high, which is on the safe side; where lower storeys are higher than others, they may come out too low.

References
----------
Miranda E, Reyes CJ (2002). Approximate lateral drift demands in multistory buildings with nonuniform stiffness. Journal
of Structural Engineering 128(7):840-849. doi:10.1061/(ASCE)0733-9445(2002)128:7(840) (alpha by structure: 0 to 2 for
walls, 1.5 to 6 for dual systems, 5 to 20 for frames). Assumed: not compared with the print.
"""

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

import numpy as np

from assess.arrays import FloatArray
from assess.intensity import RATIO
from assess.motion.stratified import draw_normal, draw_uniform

RATIO_SCATTER = 0.40
"""Standard deviation of ln PGV/PGA from one earthquake to another [-]: assumed; the same components have 0.37."""
ALONG = 0.57
"""Correlation of ln PGV/PGA between two axes [-]: measured on the 22 pairs of FEMA P-695."""
UNKNOWN = "unknown"
STIFFNESS: Mapping[str, tuple[float, float]] = MappingProxyType(
    {
        "frame": (5.0, 20.0),
        "walls": (0.5, 2.0),
        "dual": (1.5, 6.0),
        "timber": (5.0, 20.0),
        "masonry": (1.5, 6.0),
        UNKNOWN: (1.0, 20.0),
    }
)
"""Range of alpha by structure [-], within which ln alpha is uniform: after Miranda and Reyes (2002) for frames, walls
and dual systems; that of timber and masonry, which shear more than slender walls, is assumed."""
ALPHAS = 8
"""Values of alpha that are drawn in each range."""

CODE_FACTOR, CODE_POWER = 0.0488, 0.75
"""T1 [s] of a building of height h [m] is about CODE_FACTOR h**CODE_POWER: ASCE 7-22 Eq. 12.8-7, "all other structural
systems". It is meant to be short."""
LONGER = 1.4
"""Median T1 over that of the code [-]: assumed. 575 Market Street has 2.5, Alhambra 1.5, Berkeley 0.9 to 1.1."""
STOREY = 3.0
"""Height of a storey [m], where only their number is known: assumed."""
HIGH_STOREY = 3.3
"""Height of a storey by which a new floor is placed [m]: assumed, above `STOREY`, so that it rather lies too high."""
SCATTER, GIVEN_SCATTER = 0.35, 0.10
"""Standard deviation of ln T1 by height, and where T1 is given, which changes with amplitude [-]: assumed."""
SHORTEST, LONGEST = 0.15, 3.0
"""Range of T1 [s], ln uniform, where nothing is known of the building: assumed."""
LOWEST = 0.25
"""Least height z/h of a floor of which the height is not known, uniform from there to 1 [-]: assumed."""
CUT = 2.5
"""Standard deviations beyond which neither T1 nor PGV/PGA is drawn."""
_RATIO, _OWN, _PERIOD, _STRUCTURE, _PLACE = range(5, 10)
"""Streams of random numbers of a seed; those below are of `assess.rocking.draws` and `assess.motion.drawn_ground`."""


Meets = Literal["nothing", "medians", "pfa", "peaks"]
"""What the draws of a floor are brought to: nothing, on a ground that has its peaks; its medians; its PFA in every draw
and its median PFV; both in every draw."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ground:
    """What is known of the ground motion: medians, of which one at least is known.

    * `pga`, `pgv`: [m/s2], [m/s]
    * `number`: by which the ratios of a building differ from those of others, from `assess.rocking.draws.name_number`.
    """

    pga: float | None = None
    pgv: float | None = None
    number: int = 0

    @property
    def ratio(self) -> float:
        """Median PGV/PGA [s]."""
        return RATIO if self.pga is None or self.pgv is None else self.pgv / self.pga

    @property
    def peaks(self) -> tuple[float, float]:
        """Median PGA [m/s2] and PGV [m/s]."""
        if self.pga is None:
            return (self.pgv or 0.0) / RATIO, self.pgv or 0.0
        return self.pga, self.pga * RATIO if self.pgv is None else self.pgv

    def draw_ratios(self, seed: int, axis: str, first: int, count: int) -> FloatArray:
        """Return PGV/PGA of draws `first` and further ones [s], (count,)."""
        if self.pga is not None and self.pgv is not None:
            return np.full(count, self.ratio)
        number = draw_normal([seed, _RATIO, self.number], first, count, CUT)
        if axis == "Y":
            own = draw_normal([seed, _OWN, self.number], first, count, CUT)
            number = ALONG * number + math.sqrt(1 - ALONG**2) * own
        return RATIO * np.exp(RATIO_SCATTER * number)


def estimate_period(height: float | None) -> float | None:
    """Return the median T1 [s] of a building of this height [m]; None where that is not known."""
    return LONGER * CODE_FACTOR * height**CODE_POWER if height else None


@dataclass(frozen=True, slots=True, kw_only=True)
class Building:
    """What is known of a building, and by what it draws the rest.

    * `period`: T1 [s], given or the median by height; None where nothing is known.
    * `scatter`: standard deviation of ln T1 [-].
    * `structure`: key of `STIFFNESS`.
    * `number`: by which its draws differ from those of other buildings, from `assess.rocking.draws.name_number`; 0: of
      none.
    """

    period: float | None = None
    scatter: float = GIVEN_SCATTER
    structure: str = UNKNOWN
    number: int = 0

    @property
    def longest(self) -> float:
        """The longest T1 that is drawn [s]."""
        return LONGEST if self.period is None else self.period * math.exp(CUT * self.scatter)

    def draw_periods(self, seed: int, first: int, count: int) -> FloatArray:
        """Return T1 of draws `first` and further ones [s], (count,)."""
        stream = [seed, _PERIOD, self.number]
        if self.period is None:
            low, high = math.log(SHORTEST), math.log(LONGEST)
            return np.exp(low + (high - low) * draw_uniform(stream, first, count))
        return self.period * np.exp(self.scatter * draw_normal(stream, first, count, CUT))

    def draw_alphas(self, seed: int, first: int, count: int) -> FloatArray:
        """Return alpha of draws `first` and further ones [-], (count,)."""
        low, high = (math.log(one) for one in STIFFNESS[self.structure])
        part = np.floor(ALPHAS * draw_uniform([seed, _STRUCTURE, self.number], first, count))
        return np.exp(low + (high - low) * (part + 0.5) / ALPHAS)


def draw_places(seed: int, first: int, count: int, number: int = 0) -> FloatArray:
    """Return heights z/h of a floor of which the height is not known, in each draw [-], (count,)."""
    return LOWEST + (1 - LOWEST) * draw_uniform([seed, _PLACE, number], first, count)


@dataclass(frozen=True, slots=True, kw_only=True)
class FloorTarget:
    """What the draws of a floor are to meet.

    * `place`: z/h [-]; None where it is not known.
    * `pfa`, `pfv`: peaks [m/s2], [m/s]: medians where the draws are not brought to each.
    * `meets`: what they are brought to.
    * `factor`: of the ground motions' unit [-].
    * `anchors`: z/h [-] and PFA [m/s2] of floors with a known PFA, by which the factor in height goes.
    * `is_ground_known`: whether that factor comes down to 1 at the ground.
    """

    place: float | None
    pfa: float
    pfv: float
    meets: Meets
    factor: float = 1.0
    anchors: tuple[tuple[float, float], ...] = ()
    is_ground_known: bool = True


_NUMBERED = re.compile(
    r"(?:floor|level|storey|story|piano|livello|[lfp])?[ .]*(\d{1,3})(?:°|º|st|nd|rd|th)?"
    r"(?: (?:floor|level|storey|story|piano|livello))?"
)
_BELOW = re.compile(r"(?:b|-)[ .]*\d{1,2}|(?:basement|interrato)[ .]*\d{0,2}")
_GROUND = frozenset({"g", "gf", "ground", "ground floor", "pt", "p.t.", "terra", "piano terra", "eg", "rdc"})


def find_storey(name: str) -> int | None:
    """Return the number of storeys that a floor lies above the ground floor, from its name; None where it has none."""
    return 0 if is_below_ground(name) else find_number(name)


def is_below_ground(name: str) -> bool:
    """Tell whether a floor is called as one below the ground: B1, Basement, -1."""
    return bool(_BELOW.fullmatch(" ".join(name.split()).casefold()))


def find_number(name: str) -> int | None:
    """Return the number that a floor is called by, 0 for the ground floor; None for any other name."""
    plain = " ".join(name.split()).casefold()
    found = _NUMBERED.fullmatch(plain)
    return 0 if plain in _GROUND else int(found[1]) if found else None


def find_lowest_number(floors: Iterable[tuple[str, float | None]]) -> int | None:
    """Return the number that the ground floor is called by, from the names and the elevations [m] of all floors.

    It is that of the floor with an Elevation of 0, and 0 where there is none. None where floors are not to be placed by
    their numbers: one has an Elevation above the ground, or floors of several numbers have 0.
    """
    known = [(name, elevation) for name, elevation in floors if elevation is not None]
    at_grade = {find_storey(name) for name, elevation in known if elevation == 0} - {None}
    if any(elevation > 0 for _, elevation in known) or len(at_grade) > 1:
        return None
    return next(iter(at_grade), 0)


def assume_elevation(name: str, height: float | None, storeys: int | None, lowest: int = 0) -> float | None:
    """Return the elevation [m] of a floor from its name, and the height [m] and the storeys of its building.

    `lowest` is the number of the ground floor. None where the building or the name does not tell; at most the height.
    """
    storey = find_storey(name)
    if storey is None or height is None or storeys is None:
        return None
    return min(max(storey - lowest, 0) * height / storeys, height)


def guess_elevation(
    name: str, floors: Iterable[tuple[str, float | None]], height: float | None, storeys: int | None
) -> float | None:
    """Return the elevation [m] of a floor by its number, from those of other floors, else by storeys; None if none.

    Between and beyond floors of known elevation it goes straight on from the two nearest; it is at most `height`.
    """
    number = None if is_below_ground(name) else find_number(name)
    if number is None:
        return None
    known = {at: z for one, z in floors if z is not None and (at := find_number(one)) is not None}
    near = sorted(known, key=lambda at: (abs(at - number), at))[:2]
    step = height / storeys if height and storeys else HIGH_STOREY
    if len(near) == 2:
        step = (known[near[1]] - known[near[0]]) / (near[1] - near[0])
    first = near[0] if near else 0
    found = known.get(first, 0.0) + (number - first) * step
    return round(found if height is None else min(found, height), 3)
