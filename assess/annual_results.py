"""Annual chances in the results, over all earthquakes of the site's hazard curve: falls, blocked routes, lost exits."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

YEARS = 50
"""Years of the longer chance."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AnnualRow:
    """How often a year something happens: the `rate`, and chances of at least once.

    * `low`, `high`: 95 % sampling interval of the rate, for the number of draws only. None where it happened in no
      draw, where not all was simulated, or where the hazard curve does not reach far enough.
    * `fit`: what was integrated: a lognormal fitted to the shares, or their table where that is not near enough.
    * `median_g` [g], `dispersion`, `misfit`: of that lognormal in ground PGA, and its largest difference from a share;
      None where it was not used, or half was not reached within the curve.
    * `at_least`: whether the rate is a lower bound: the motions may be too weak, the hazard curve does not reach far
      enough, or several pieces of one row were taken to fall together.
    * `ends_matter`: whether more than 5 % of the rate comes, or could come, from outside the hazard curve.
    """

    rate: float
    low: float | None
    high: float | None
    chance_a_year: float
    chance_in_50_years: float
    fit: Literal["lognormal", "table"]
    median_g: float | None
    dispersion: float | None
    misfit: float | None
    at_least: bool
    ends_matter: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class AnnualTables:
    """What annual chances rest on, and those of the building.

    * `missing`: why nothing was evaluated, and what to fill in; empty where it was.
    * `file`, `latitude`, `longitude` [deg]: of the hazard curve and its site, `distance_km` from the building.
    * `curve_pga_g`, `curve_rate`: points of the curve: peak ground acceleration, and how often a year it is exceeded.
    * `ground_pga_g`: of the scenario: the floors' motions are taken to grow in proportion to it.
    * `motion_dispersion`: logarithmic standard deviation of the floors' motions at a ground PGA.
    * `runs`, `factors`: draws at each level, and factors on the motions of the scenario.
    * `pieces`, `not_evaluated`, `cannot_rock`: free-standing pieces that are counted, not simulated, or too stocky.
    * `at_least`: those of the counted ones whose motions may be too weak.
    * `is_lower_bound`: whether the expected falls are one: for that, because some pieces were not simulated, or because
      the hazard curve does not reach far enough.
    * `expected_falls`, `expected_low`, `expected_high`: pieces that fall a year on average, and the 95 % sampling
      interval of that; None where nothing fell.
    * `life_safety_pieces`, `life_safety`: counted pieces of that Importance, and that any of them falls (those of one
      row together); None where there are none.
    """

    file: str
    missing: str = ""
    latitude: float | None = None
    longitude: float | None = None
    distance_km: float | None = None
    curve_pga_g: tuple[float, ...] = ()
    curve_rate: tuple[float, ...] = ()
    ground_pga_g: float | None = None
    motion_dispersion: float = 0.0
    runs: int = 0
    factors: tuple[float, ...] = ()
    pieces: int = 0
    not_evaluated: int = 0
    cannot_rock: int = 0
    at_least: int = 0
    is_lower_bound: bool = False
    expected_falls: float = 0.0
    expected_low: float | None = None
    expected_high: float | None = None
    life_safety_pieces: int = 0
    life_safety: AnnualRow | None = None
    remarks: tuple[str, ...] = ()

    @property
    def is_evaluated(self) -> bool:
        """Whether there are annual chances."""
        return not self.missing


@dataclass(frozen=True, slots=True)
class AnnualWays:
    """Annual rows of routes and rooms by name; `routes_if_anchors_fail` where anchored pieces can reach the route."""

    routes: Mapping[str, AnnualRow]
    routes_if_anchors_fail: Mapping[str, AnnualRow]
    rooms: Mapping[str, AnnualRow]


@dataclass(frozen=True, slots=True)
class Annual:
    """Annual chances: those of the building, of its pieces by index, of its routes and rooms."""

    tables: AnnualTables
    items: Mapping[int, AnnualRow]
    ways: AnnualWays
