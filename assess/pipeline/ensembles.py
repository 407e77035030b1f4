"""The motions of every floor and axis: generated for its record, drawn on a beam, or the user's own.

The phases of floors whose records can be compared are turned by the signs of those. Two records are compared where they
are along one axis, of one earthquake and on one clock, as far as their files show:

* the files give the same event, start and sampling interval, and both records are corrected or neither is;
* and the start is given to a hundredth of a second, or both are channels of one recorder, or both are of one file.

Where that cannot be shown a record has no sign, and its motions keep the phases as they are: a start to the minute is
no common clock, nor is the motion of the other axis a record along this one. Parallel records of one floor count each
for itself, as they are made at different places of it; a sign is found where two floors at least have such records.
"""

import math
import re
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from assess.arrays import FloatArray
from assess.methods import Motions
from assess.model import NEAR_AXIS, Building, angle_between
from assess.motion.kept import Kept
from assess.motion.record import Record, treat
from assess.motion.rows import GROUP
from assess.pipeline.demand import Demand, Demands, Drawn
from assess.progress import SILENT, Progress

if TYPE_CHECKING:
    from assess.motion.suite import Suite
    from assess.motion.target import Grid, Target

WEAK_PFA, WEAK_PFV = 0.9, 0.85
"""Shares of the floor's PFA and PFV [-]: motions whose own are lower on average may not lower a class."""
TARGETS: "Kept[Target]" = Kept(48_000_000)
"""Targets of records, which further motions of the same floor ask for: those of a minute take some 1 million bytes."""


def _identify(demand: Demand) -> tuple[Hashable, ...]:
    """Return what tells the recorded motion of a floor from others."""
    return demand.record or demand.motion, demand.scale, demand.axis


@dataclass(frozen=True, slots=True, eq=False)
class GeneratedEnsemble:
    """Motions made for the spectrum of the record of a `demand`.

    On a `grid` that all floors of the building share, so that motion k is one earthquake. `seed` is that of the phases,
    `signs` those by which they are turned, 1 or -1 by octave; None where they are not known.
    """

    demand: Demand
    grid: "Grid"
    seed: int
    signs: tuple[int, ...] | None = None
    is_assumed: bool = False
    is_unknown: bool = False

    @property
    def record(self) -> tuple[FloatArray, float] | None:
        """The recorded motion as treated [m/s2], and its time step [s]."""
        return self.demand.recorded

    @property
    def key(self) -> Hashable:
        """All that the motions depend on."""
        return (*_identify(self.demand), self.grid, self.seed, self.signs)

    def build_target(self) -> "Target":
        """Return what the motions are to match, but for their scale: the record as it is."""
        from assess.motion.target import recorded_target

        demand = self.demand
        if demand.motion is None:
            raise ValueError(f"floor {demand.floor.floor} has no record")
        if demand.record is None:
            return recorded_target(demand.motion, self.grid)
        record = demand.record
        return TARGETS.find_or_make((record, self.grid), lambda: recorded_target(treat(record), self.grid))

    def open(self, threads: int, progress: Progress = SILENT) -> Motions:
        """Find the filter and the corrections that meet the target; the motions are in single precision."""
        from assess.motion.noise import Phases
        from assess.motion.shared_motions import share_motions

        phases = Phases(self.grid, self.seed, self.demand.axis, self.signs)
        factor, step = 1.0 if self.demand.record is None else self.demand.scale, self.grid.time_step
        shared = share_motions(self.build_target(), phases, factor=factor, threads=threads, progress=progress)
        is_weak = shared.generator.fit.pfv_ratio < WEAK_PFV  # NaN where no PFV is to be met
        return Motions(
            lambda first, count: [(shared.realise(first, count), step)], shared.generator.fit, shared.spectra, is_weak
        )


@dataclass(frozen=True, slots=True, eq=False)
class DrawnEnsemble:
    """Motions of a floor without a record: of drawn buildings on drawn motions of the ground, or on those of a record.

    As `GeneratedEnsemble`; `drawn` is the demand's own, `signs` those of the record of the ground.
    """

    demand: Demand
    drawn: Drawn
    grid: "Grid"
    seed: int
    signs: tuple[int, ...] | None = None
    record: None = None
    is_assumed: bool = True

    @property
    def is_unknown(self) -> bool:
        """Whether nothing is known of the building, nor of the floor's height."""
        return self.drawn.is_unknown

    @property
    def key(self) -> Hashable:
        """All that the motions depend on."""
        drawn = self.drawn
        ground = drawn.record and _identify(drawn.record)
        return drawn.building, drawn.ground, ground, drawn.target, self.demand.axis, self.grid, self.seed, self.signs

    def open(self, threads: int, progress: Progress = SILENT) -> Motions:
        """Find what brings the draws to the floor's peaks; the motions are in single precision."""
        from assess.motion.beam import Beams, open_floor
        from assess.motion.drawn_ground import draw_ground
        from assess.motion.noise import Phases

        record, ground, axis = self.drawn.record, self.drawn.ground, self.demand.axis
        build = partial(Beams, self.drawn.building, self.grid, self.seed)
        if record is None:
            phases = Phases(self.grid, self.seed, axis)
            beams = build((ground, axis), lambda group: draw_ground(ground, phases, group, progress))
        else:
            made = GeneratedEnsemble(record, self.grid, self.seed, self.signs).open(1, progress)
            beams = build((record, axis), lambda group: made.realise(group * GROUP, GROUP)[0][0])
        found, step = open_floor(beams, self.drawn.target, threads, progress), self.grid.time_step
        return Motions(
            lambda first, count: [(found.realise(first, count, threads, progress), step)], bands=(found.high, found.low)
        )


@dataclass(frozen=True, slots=True, eq=False)
class SuiteEnsemble:
    """The user's own motions on one floor along one axis, scaled to its PFA where that is wanted, else by a factor."""

    demand: Demand
    suite: "Suite"
    is_scaled: bool
    factor: float = 1.0
    is_assumed: bool = False
    is_unknown: bool = False
    signs: tuple[int, ...] | None = None

    @property
    def key(self) -> Hashable:
        """All that the motions depend on."""
        return self.suite, self.demand.pfa if self.is_scaled else self.factor, self.demand.motion, self.demand.axis

    @property
    def peaks(self) -> tuple[float, float]:
        """Median PFA [m/s2] and PFV [m/s] of the motions on this floor."""
        from statistics import median

        motions = [motion for _, motion in self.suite.motions]
        scaled = [(one, self.demand.pfa / one.pfa if self.is_scaled else self.factor) for one in motions]
        return median(one.pfa * scale for one, scale in scaled), median(one.pfv * scale for one, scale in scaled)

    @property
    def is_weak(self) -> bool:
        """Whether their median PFA is over 10 % below the floor's, or their median PFV over 15 % below a known one."""
        pfa, pfv = self.peaks
        is_met = self.demand.drawn is None or self.demand.drawn.target.meets == "peaks"
        is_slow = is_met and pfv < WEAK_PFV * self.demand.pfv
        return pfa < WEAK_PFA * self.demand.pfa or is_slow

    @property
    def record(self) -> tuple[FloatArray, float] | None:
        """The recorded motion as treated [m/s2], and its time step [s]."""
        return self.demand.recorded

    def open(self, threads: int, progress: Progress = SILENT) -> Motions:
        """Take them as they are."""
        pfa = self.demand.pfa if self.is_scaled else None
        spectra = self.suite.scaled_spectra(pfa, progress=progress)
        factor = 1.0 if self.is_scaled else self.factor

        spectra = replace(spectra, ordinates=spectra.ordinates * np.float32(factor))
        return Motions(
            lambda first, count: [(factor * one, step) for one, step in self.suite.realise(first, count, pfa)],
            None, spectra, self.is_weak,
        )  # fmt: skip


FloorEnsemble = GeneratedEnsemble | DrawnEnsemble | SuiteEnsemble


def build_ensembles(
    chosen: Sequence[Demand], demands: Demands, building: Building, *, seed: int, number: int = 0
) -> tuple[GeneratedEnsemble | DrawnEnsemble, ...]:
    """Return one ensemble a demand of `chosen`, on the grid that all `demands` of the building share.

    Their signs are found among all `demands`, so that they do not depend on which are chosen. Buildings of another
    `number` draw another T1, structure and PGV/PGA.
    """
    from assess.motion.drawn_ground import build_beam_grid
    from assess.motion.target import build_grid

    every = list({id(one): one for parallel in demands.values() for one in parallel}.values())
    drawn = [one.drawn for one in every if one.drawn is not None]
    longest = max((one.building.longest for one in drawn), default=0.0)
    grid = build_grid(
        [one.motion for one in every if one.motion is not None], at_least=build_beam_grid(longest) if drawn else None
    )
    signs = find_phase_signs(every, grid, building.azimuth_deg)
    of_record = {(id(one.record), one.axis): found for one, found in signs.items()}

    found: list[GeneratedEnsemble | DrawnEnsemble] = []
    for one in chosen:
        if one.drawn is None:
            found.append(GeneratedEnsemble(one, grid, seed, signs.get(one)))
            continue
        shaken, ground = replace(one.drawn.building, number=number), replace(one.drawn.ground, number=number)
        own = replace(one.drawn, building=shaken, ground=ground)
        of_ground = own.record and of_record.get((id(own.record.record), own.record.axis))
        found.append(DrawnEnsemble(one, own, grid, seed, of_ground or None))
    return tuple(found)


_HUNDREDTHS = re.compile(r":\d\d\.\d\d")
_Recorded = tuple[Demand, float | None]
"""A recorded floor motion, and the azimuth of its record [deg]."""


def find_phase_signs(
    demands: Iterable[Demand], grid: "Grid", azimuth: float | None = None
) -> dict[Demand, tuple[int, ...]]:
    """Return the signs of the floor motions that have any, 1 or -1 by octave of `assess.motion.target.octaves`.

    `demands` are all of the building, `grid` the samples that its floors share, `azimuth` that of axis X, clockwise
    from north [deg]. They are relative: those of the strongest motion of an axis are all 1. No factor common to all
    motions changes them. A record that points against its axis is turned before it is compared; one that is more than
    15 deg off is not compared. Where the azimuth is unknown, the strongest record gives the direction. Records of which
    none has a direction are taken to point alike.
    """
    groups: dict[Any, list[_Recorded]] = {}
    for one in demands:
        if one.record is not None and one.motion is not None and not one.is_borrowed:
            key = one.axis, find_clock(one.name, one.record)
            groups.setdefault(key, []).append((one, one.record.azimuth_deg))
    found: dict[Demand, tuple[int, ...]] = {}
    for (axis, _), group in groups.items():
        found |= _find_signs(group, grid, None if azimuth is None else azimuth + 90 * (axis == "Y"))
    return found


def find_clock(name: str, record: Record) -> tuple[Any, ...]:
    """Return clock and earthquake of a record, the same for all on one clock; `name` is as the workbook names it."""
    common = (record.event, record.start, record.time_step, record.corrected)
    if _HUNDREDTHS.search(record.start):
        return ("start", *common)
    if record.recorder and (record.event or record.start):
        return ("recorder", record.recorder, *common)
    return ("file", name.partition("#")[0].strip(), record.file, *common)


def _find_signs(group: Sequence[_Recorded], grid: "Grid", along: float | None) -> dict[Demand, tuple[int, ...]]:
    """Return the signs of records on one clock; nothing where they are not of two floors at least."""
    known = [(one.pfa, azimuth) for one, azimuth in group if azimuth is not None]
    axis = max(known)[1] if along is None and known else along

    def turn(azimuth: float | None) -> int:
        """Return 1 for a record that points along the axis, -1 for one that points against it, else 0."""
        if not known:
            return 1
        if azimuth is None or axis is None or angle_between(azimuth, axis) > NEAR_AXIS:
            return 0
        return 1 if math.cos(math.radians(azimuth - axis)) > 0 else -1

    directed = [(one, turn(azimuth)) for one, azimuth in group if turn(azimuth)]
    if len({one.floor.floor for one, _ in directed}) < 2:
        return {}
    signs = _find_signs_of(tuple((one.record, sign) for one, sign in directed if one.record), grid)
    return {one: own for (one, _), own in zip(directed, signs, strict=True)}


@lru_cache(maxsize=16)
def _find_signs_of(records: tuple[tuple[Record, int], ...], grid: "Grid") -> tuple[tuple[int, ...], ...]:
    """Return the signs of records, each of which points along the axis (1) or against it (-1)."""
    from assess.motion.floor_signs import find_signs
    from assess.motion.target import put_on_grid

    rows = np.stack([sign * put_on_grid(treat(record), grid) for record, sign in records])
    return tuple(map(tuple, find_signs(rows, grid.time_step).tolist()))
