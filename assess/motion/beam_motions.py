"""The motions of floors without a record: one earthquake a draw through a drawn building, brought to what is known.

A ground motion, drawn or made for a record of the ground, shakes the beam of its draw; every floor of the draw moves as
one building. Then

* a floor whose PFA is known meets it in every draw, and so its PFV where that is known;
* between such floors, and down to a ground that is known, the factor by which they were met goes on, its logarithm
  straight in height;
* the medians of any other floor are brought to those of `assess.motion.floor_medians` by two bands, all draws alike.

The modes of a building are kept, in so many bytes; a floor's motions are made when they are asked for.
"""

import math
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from functools import partial

import numpy as np

from assess.arrays import FloatArray, Single
from assess.motion.assumed import Building, FloorTarget, draw_places
from assess.motion.bands import find_common, meet_peaks, split_bands
from assess.motion.beam import find_shares, swing_modes
from assess.motion.kept import Kept
from assess.motion.rows import GROUP, make_groups
from assess.motion.target import Grid
from assess.progress import Progress

KEPT: Kept[Single] = Kept(160_000_000)
"""Modes for further floors: 200 draws of 37 s on one axis take 54 million bytes."""
CALIBRATED = 200
"""Draws by whose medians the bands of a floor are set, a multiple of a group; further ones take the same."""


@dataclass(frozen=True, slots=True, eq=False)
class Beams:
    """A building, a beam a draw, on ground motions along one axis.

    * `building`: of which the beams are drawn.
    * `grid`: the samples.
    * `seed`: of the draws.
    * `key`: all that the ground motions depend on.
    * `make_ground`: gives the ground motions of a group, by its number: (GROUP, n), in a unit of which floors give the
      factor.
    """

    building: Building
    grid: Grid
    seed: int
    key: Hashable
    make_ground: Callable[[int], Single]

    def shake(self, group: int, place: float | None) -> Single:
        """Return the accelerations of a floor at z/h `place` in a group of draws, (GROUP, n); None: a drawn height."""
        if place is not None and place <= 0:
            return self.make_ground(group)
        first = group * GROUP
        alphas = self.building.draw_alphas(self.seed, first, GROUP)
        places = np.full(GROUP, place) if place is not None else draw_places(self.seed, first, GROUP)
        shares = np.pad(find_shares(alphas, places), ((0, 0), (1, 0)), constant_values=1.0).astype(np.float32)
        return np.asarray(np.matmul(shares[:, None], self._find_modes(group, alphas))[:, 0], np.float32)

    def _find_modes(self, group: int, alphas: FloatArray) -> Single:
        def make() -> Single:
            periods = self.building.draw_periods(self.seed, group * GROUP, GROUP)
            modes = swing_modes(self.make_ground(group), self.grid.time_step, periods, alphas)
            modes.flags.writeable = False
            return modes

        return KEPT.find_or_make((self.key, self.building, self.grid, self.seed, group), make)


@dataclass(frozen=True, slots=True, eq=False)
class FloorMotions:
    """The motions of one floor along one axis; `open_floor` finds the factors of its two bands.

    * `beams`, `target`: as given.
    * `high`, `low`: factors above and below the corner at PFA/(2 pi PFV) [-], the same in all draws.
    """

    beams: Beams
    target: FloorTarget
    high: float
    low: float

    def realise(self, first: int, count: int, threads: int, progress: Progress) -> Single:
        """Return draws `first` to `first + count - 1`: accelerations [m/s2], (count, n), each whatever the others."""
        return make_groups(self._make, first, count, self.beams.grid.count, threads, progress)

    def _make(self, group: int) -> Single:
        motions, target = _shake(self.beams, self.target, group), self.target
        if target.meets == "nothing":
            return motions
        low, step = _split(motions, target, self.beams.grid), self.beams.grid.time_step
        if target.meets == "peaks":
            meet_peaks(motions, low, step, np.full(GROUP, target.pfa), np.full(GROUP, target.pfv))
            return motions
        motions *= np.float32(self.high)
        motions += np.float32(self.low - self.high) * low
        if target.meets == "pfa":
            meet_peaks(motions, low, step, np.full(GROUP, target.pfa), np.zeros(GROUP))
        return motions


def open_floor(beams: Beams, target: FloorTarget, threads: int, progress: Progress) -> FloorMotions:
    """Find the factors that bring the medians of the first draws to the floor's."""
    if target.meets in ("nothing", "peaks"):
        return FloorMotions(beams, target, 1.0, 1.0)
    make = partial(_shake, beams, target)
    motions = make_groups(make, 0, CALIBRATED, beams.grid.count, threads, progress)
    low = _split(motions, target, beams.grid)
    each = target.meets == "pfa"
    found = find_common(motions, low, beams.grid.time_step, target.pfa, target.pfv, each=each)
    return FloorMotions(beams, target, *found)


def _split(motions: Single, target: FloorTarget, grid: Grid) -> Single:
    corner = target.pfa / (2 * math.pi * target.pfv)
    return split_bands(motions, grid.time_step, np.full(len(motions), corner))


def _shake(beams: Beams, target: FloorTarget, group: int) -> Single:
    """Return the motions of a floor before its bands are set, with the factor in height of every draw."""
    motions = np.float32(target.factor) * beams.shake(group, target.place)
    if target.meets == "medians" and target.anchors and target.place is not None:
        motions *= np.exp(_find_height_factor(beams, target, target.place, group)).astype(np.float32)[:, None]
    return motions


def _find_height_factor(beams: Beams, target: FloorTarget, place: float, group: int) -> FloatArray:
    """Return ln of the factor at a height in each draw (GROUP,), between the next floors with a known PFA."""
    below = max((one for one in target.anchors if one[0] <= place), default=None)
    above = min((one for one in target.anchors if one[0] > place), default=None)
    low, high = (None if one is None else _find_factor(beams, target, one, group) for one in (below, above))
    if low is None and target.is_ground_known:
        below, low = (0.0, 0.0), np.zeros(GROUP)
    if low is None or high is None or below is None or above is None:
        found = low if high is None else high
        return np.zeros(GROUP) if found is None else found
    return low + (high - low) * (place - below[0]) / (above[0] - below[0])


def _find_factor(beams: Beams, target: FloorTarget, anchor: tuple[float, float], group: int) -> FloatArray:
    strongest = target.factor * np.abs(beams.shake(group, anchor[0])).max(axis=1)
    return np.asarray(np.log(anchor[1] / strongest), dtype=np.float64)
