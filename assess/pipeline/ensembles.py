"""The motions of every floor and axis: generated for its record or for a generic spectrum, or the user's own."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from assess.model import Building
from assess.motion.record import FloatArray, treat
from assess.pipeline.demand import Demand, Demands
from assess.pipeline.phase_signs import find_phase_signs
from assess.progress import SILENT, Progress

if TYPE_CHECKING:
    from assess.motion.suite import Suite
    from assess.motion.target import Grid, Target
    from assess.motion.target_fit import Fit, Spectra

WEAK_PFA, WEAK_PFV = 0.9, 0.85
"""Shares of the floor's PFA and PFV [-]: motions whose own are lower on average may not lower a class."""


@dataclass(frozen=True, slots=True, eq=False)
class OpenMotions:
    """Motions that have been made ready: `make` returns those from a number on, and a count of them.

    `fit` and `spectra` are those of the first 100 motions; `is_weak` tells whether they are weaker than the floor's.
    """

    make: Callable[[int, int], list[tuple[NDArray[Any], float]]]
    fit: "Fit | None" = None
    spectra: "Spectra | None" = None
    is_weak: bool = False

    def realise(self, first: int, count: int) -> list[tuple[NDArray[Any], float]]:
        """Return motions `first` to `first + count - 1` in batches: (k, n) [m/s2], and their time step [s]."""
        return self.make(first, count)


@dataclass(frozen=True, slots=True, eq=False)
class GeneratedEnsemble:
    """Motions made for the spectrum of one demand.

    Parameters
    ----------
    demand : Demand
        The floor motion that they stand for.
    grid : Grid
        The samples that all floors of the building share, so that motion k is one earthquake.
    seed : int
        Of the phases.
    period, height : float, optional
        T1 [s] and height [m] of the building, by which a generic spectrum is shaped.
    signs : tuple of int, optional
        By which its phases are turned, 1 or -1 by octave; None where they are not known.
    """

    demand: Demand
    grid: "Grid"
    seed: int
    period: float | None = None
    height: float | None = None
    signs: tuple[int, ...] | None = None

    @property
    def is_generic(self) -> bool:
        """Whether its spectrum is a generic one, since no record is known."""
        return self.demand.motion is None

    @property
    def is_unshaped(self) -> bool:
        """Whether its generic spectrum rests on neither T1 nor the building's height."""
        return self.is_generic and self.period is None and self.height is None

    @property
    def record(self) -> tuple[FloatArray, float] | None:
        """The recorded motion as treated [m/s2], and its time step [s]."""
        return _record(self.demand)

    @property
    def factor(self) -> float:
        """What the floor's motions are of those for `build_target` [-]: its PFA [m/s2], or the scale of its record."""
        if self.demand.motion is None:
            return self.demand.pfa
        return 1.0 if self.demand.record is None else self.demand.scale

    def build_target(self) -> "Target":
        """Return what the motions are to match, but for `factor`.

        It is that of the record as it is, or a generic one of a PFA of 1 m/s2: floors with targets of one shape take
        the same motions. The ratio of PFV to PFA, T1 and the height are taken to six digits, so that rounding errors of
        products make no shape of its own.
        """
        from assess.motion.target import generic_target, recorded_target

        demand = self.demand
        if demand.motion is not None:
            own = demand.motion if demand.record is None or demand.scale == 1.0 else treat(demand.record)
            return recorded_target(own, self.grid)
        pfv = math.nan if "pfv_estimated" in demand.flags else _round(demand.pfv / demand.pfa)
        return generic_target(1.0, self.grid, pfv=pfv, period=_round(self.period), height=_round(self.height))

    def open(self, threads: int, progress: Progress = SILENT) -> OpenMotions:
        """Find the filter and the corrections that meet the target; the motions are in single precision."""
        from assess.motion.shared_motions import share_motions

        shared = share_motions(
            self.build_target(), self.grid, factor=self.factor, seed=self.seed, axis=self.demand.axis, threads=threads,
            progress=progress, signs=self.signs,
        )  # fmt: skip
        step = self.grid.time_step
        is_weak = shared.fit.pfv_ratio < WEAK_PFV  # NaN where no PFV is to be met
        return OpenMotions(
            lambda first, count: [(shared.realise(first, count), step)], shared.fit, shared.spectra, is_weak
        )


@overload
def _round(value: None) -> None: ...
@overload
def _round(value: float) -> float: ...
def _round(value: float | None) -> float | None:
    """Return a number to six digits."""
    return None if value is None else float(f"{value:.6g}")


@dataclass(frozen=True, slots=True, eq=False)
class SuiteEnsemble:
    """The user's own motions on one floor along one axis, scaled to its PFA where that is wanted, else by a factor."""

    demand: Demand
    suite: "Suite"
    is_scaled: bool
    factor: float = 1.0
    is_generic: bool = False
    is_unshaped: bool = False
    signs: tuple[int, ...] | None = None

    @property
    def peaks(self) -> tuple[float, float]:
        """Median PFA [m/s2] and PFV [m/s] of the motions on this floor."""
        from statistics import median

        motions = [motion for _, motion in self.suite.motions]
        scales = [self.demand.pfa / motion.pfa if self.is_scaled else self.factor for motion in motions]
        scaled = [(one.pfa * scale, one.pfv * scale) for one, scale in zip(motions, scales, strict=True)]
        return median(pfa for pfa, _ in scaled), median(pfv for _, pfv in scaled)

    @property
    def is_weak(self) -> bool:
        """Whether their median PFA is over 10 % below the floor's, or their median PFV over 15 % below a known one."""
        pfa, pfv = self.peaks
        is_slow = pfv < WEAK_PFV * self.demand.pfv and "pfv_estimated" not in self.demand.flags
        return pfa < WEAK_PFA * self.demand.pfa or is_slow

    @property
    def record(self) -> tuple[FloatArray, float] | None:
        """The recorded motion as treated [m/s2], and its time step [s]."""
        return _record(self.demand)

    def open(self, threads: int, progress: Progress = SILENT) -> OpenMotions:
        """Take them as they are."""
        pfa = self.demand.pfa if self.is_scaled else None
        spectra = self.suite.scaled_spectra(pfa, progress=progress)
        is_weak = self.is_weak
        if self.is_scaled or self.factor == 1.0:
            return OpenMotions(lambda first, count: self.suite.realise(first, count, pfa), None, spectra, is_weak)
        spectra = replace(spectra, ordinates=spectra.ordinates * np.float32(self.factor))
        return OpenMotions(self._realise_scaled, None, spectra, is_weak)

    def _realise_scaled(self, first: int, count: int) -> list[tuple[FloatArray, float]]:
        return [(self.factor * batch, step) for batch, step in self.suite.realise(first, count)]


FloorEnsemble = GeneratedEnsemble | SuiteEnsemble


def _record(demand: Demand) -> tuple[FloatArray, float] | None:
    return None if demand.motion is None else (demand.motion.acceleration, demand.motion.time_step)


def build_ensembles(
    chosen: Sequence[Demand], demands: Demands, building: Building, *, seed: int
) -> tuple[GeneratedEnsemble, ...]:
    """Return one ensemble a demand of `chosen`, on the grid that all `demands` of the building share.

    Their signs are found among all `demands`, so that they do not depend on which are chosen.
    """
    from assess.motion.target import build_grid, estimate_period

    every = {id(one): one for parallel in demands.values() for one in parallel}.values()
    grid = build_grid(
        [one.motion for one in every if one.motion is not None],
        has_generic=any(one.motion is None for one in every),
        period=building.period or estimate_period(building.height),
    )
    signs = find_phase_signs(every, grid, building.azimuth_deg)
    return tuple(GeneratedEnsemble(one, grid, seed, building.period, building.height, signs.get(one)) for one in chosen)
