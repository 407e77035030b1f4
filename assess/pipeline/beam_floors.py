"""Floors without a record: their peaks by a beam on the ground motion, and what their draws are brought to.

Medians of a drawn ground are those of `assess.motion.floor_medians`. A record of the ground is passed through beams
itself. Where peaks of floors above the ground are known, the factors by which they differ from the beam's go on in
height, their logarithms straight from floor to floor, and down to 1 on a ground that is known.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from assess.model import Axis
from assess.motion.assumed import Building, FloorTarget, Ground, Meets
from assess.motion.floor_medians import find_medians
from assess.pipeline.floor_demand import Demand, Drawn

_UNIT = Ground(pga=1.0)
"""The ground motion of a building of which the ground is not known: of any PGA."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Basis:
    """What shakes the floors of a building along one axis.

    * `axis`: which.
    * `building`: as far as it is known.
    * `motion`: of the ground; None where it is not known.
    * `record`: the record of the ground.
    * `known`: z/h of the floors above the ground of which peaks are known [-], and those.
    * `is_recorded`: whether any floor has a record.
    * `at_grade`: the floor at grade whose motion that of the ground is; "" where it is what Building tells.
    """

    axis: Axis
    building: Building
    motion: Ground | None = None
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
    def ground(self) -> Ground:
        """Medians of the ground motion: those of the record, the known ones, or those of 1 m/s2."""
        if self.record is not None:
            return Ground(pga=self.record.pfa, pgv=self.record.pfv)
        return self.motion or _UNIT

    def can_serve(self, place: float | None) -> bool:
        """Return whether a floor at z/h `place` follows: from the ground, or from floors of which peaks are known."""
        return self.is_known or (place is not None and bool(self.known))

    def lies_between(self, place: float | None) -> bool:
        """Return whether a floor at z/h `place` has floors of which peaks are known at or below and at or above it."""
        places = [one for one, _ in self.known]
        return place is not None and bool(places) and (self.is_known or min(places) <= place) and place <= max(places)

    def find_beam(self, place: float | None) -> tuple[float, float]:
        """Return the median PFA [m/s2] and PFV [m/s] that the beam has at z/h `place`."""
        if place not in self._found:
            self._found[place] = self._pass(place)
        return self._found[place]

    def _pass(self, place: float | None) -> tuple[float, float]:
        (pga, pgv), building = self.ground.peaks, self.building
        motion = None if self.record is None else self.record.motion
        if motion is not None and not (place is not None and place <= 0):
            from assess.motion.beam import shake_record

            return shake_record(motion.acceleration, motion.time_step, building, place)
        by_pga, by_pgv = find_medians(building.period, place, building.structure, self.ground.ratio)
        return pga * by_pga, pgv * by_pgv

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
        unit = Ground(pga=_round(1.0 if ground.pga else None), pgv=_round(ground.pgv and ground.pgv / factor))
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
