"""Annual chances in the results, over all earthquakes of the site's hazard curve: falls, blocked routes, lost exits."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

YEARS = 50
"""Years of the longer chance."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AnnualRow:
    """How often a year something happens.

    * `rate`: times a year.
    * `low`, `high`: 95 % sampling interval of the rate: it covers the number of draws only. None where it happened in
      no draw, where not all was simulated, or where the hazard curve does not reach far enough.
    * `chance_a_year`, `chance_in_50_years`: chance of at least once.
    * `fit`: what was integrated: a lognormal fitted to the shares, or the table of shares where that is not near
      enough.
    * `median_g`: ground PGA at which it happens in half of the draws [g], by the lognormal; None where that was not
      used, or half was not reached within the curve.
    * `dispersion`: logarithmic standard deviation of the lognormal; None likewise.
    * `misfit`: its largest difference from a share.
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

    * `file`: the file of the hazard curve.
    * `missing`: why nothing was evaluated, and what to fill in; empty where it was.
    * `latitude`, `longitude`: of the site of the curve [deg].
    * `distance_km`: from there to the building.
    * `curve_pga_g`, `curve_rate`: points of the curve: peak ground acceleration, and how often a year it is exceeded.
    * `ground_pga_g`: ground PGA of the scenario: the floors' motions are taken to grow in proportion to it.
    * `motion_dispersion`: logarithmic standard deviation of the floors' motions at a ground PGA.
    * `runs`: draws at each level.
    * `factors`: factors on the motions of the scenario under which every piece was rocked.
    * `pieces`, `not_evaluated`, `cannot_rock`: free-standing pieces that are counted, those that are not, as they were
      not simulated, and those that are too stocky to rock.
    * `at_least`: those of the counted ones whose motions may be too weak.
    * `is_lower_bound`: whether the expected falls are a lower bound: for that, because some pieces were not simulated,
      or because the hazard curve does not reach far enough.
    * `expected_falls`: free-standing pieces that fall a year, on average.
    * `expected_low`, `expected_high`: 95 % sampling interval of that; None where nothing fell.
    * `life_safety_pieces`: counted pieces whose Importance is life safety; those of one row fall together.
    * `life_safety`: any of those falls; None where there are none.
    * `remarks`: what a reader has to know of the curve and its ends.
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
