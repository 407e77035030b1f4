"""A building as a beam that bends and shears: how its floors move when a ground motion shakes it.

The beam is uniform and fixed at its base. Its shape is ruled by alpha, the ratio of shear to flexural stiffness: 0 is a
cantilever that bends, beyond 20 it shears alone. Eight modes of 5 % damping are taken, each as an oscillator on the
ground, exact for motions that are straight lines between samples; what they lack, and modes of short periods, move with
the ground. So the floors of a building have the phases and signs of one earthquake.

The motions of floors without a record are made of it: a ground motion, drawn or made for a record of the ground, shakes
the beam of its draw; every floor of the draw moves as one building. Then

* a floor whose PFA is known meets it in every draw, and so its PFV where that is known;
* between such floors, and down to a ground that is known, the factor by which they were met goes on, its logarithm
  straight in height;
* the medians of any other floor are brought to those of `assess.motion.floor_medians` by two bands, all draws alike.

The modes of a building are kept, in so many bytes; a floor's motions are made when they are asked for.

References
----------
Miranda E, Taghavi S (2005). Approximate floor acceleration demands in multistory buildings. I: Formulation. Journal of
Structural Engineering 131(2):203-211. doi:10.1061/(ASCE)0733-9445(2005)131:2(203).
Smallwood DO (1981). An improved recursive formula for calculating shock response spectra. Shock and Vibration Bulletin
51(2):211-217.
"""

import math
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np

from assess.arrays import FloatArray, Single
from assess.compiled import compiled
from assess.motion.assumed import Building, FloorTarget, draw_places
from assess.motion.bands import find_common, meet_peaks, split_bands
from assess.motion.kept import Kept
from assess.motion.rows import GROUP, make_groups
from assess.motion.target import Grid
from assess.motion.target_fit import measure_peaks
from assess.progress import Progress

DAMPING = 0.05
"""Share of critical damping of every mode [-]: assumed. 575 Market Street would want less, Berkeley 8 to 10 %."""
MODES, CELLS = 8, 80
"""Modes; cells of the beam."""
PASSED = 50
"""Beams by whose medians the peaks above a recorded ground are estimated."""
RIGID_BELOW = 0.03
"""Modes of shorter period move with the ground [s]."""
KEPT: Kept[Single] = Kept(160_000_000)
"""Modes for further floors: 200 draws of 37 s on one axis take 54 million bytes."""
CALIBRATED = 200
"""Draws by whose medians the bands of a floor are set, a multiple of a group; further ones take the same."""


@lru_cache(maxsize=128)
def solve_beam(alpha: float) -> tuple[FloatArray, FloatArray]:
    """Return the period ratios T_m/T_1 (m,) and, at `CELLS` + 1 heights z/h, participation times shape of modes (m, c).

    Miranda and Taghavi's uniform beam u'''' - alpha^2 u'' = lambda u, fixed at the base, by its energy on cells.
    """
    from scipy.linalg import eigh

    h = 1 / CELLS
    slope = (np.eye(CELLS) - np.eye(CELLS, k=-1)) / h
    bend = np.diff(slope, axis=0, prepend=0.0) / h
    bend[0] = math.sqrt(2) * slope[0] / h  # half a cell of the curvature 2 u_1/h^2 at the base
    mass = np.full(CELLS, h)
    mass[-1] = h / 2
    root = np.sqrt(mass)
    values, vectors = eigh(h * (bend.T @ bend + alpha**2 * slope.T @ slope) / root[:, None] / root)
    shapes = vectors[:, :MODES] / root[:, None]
    shares = np.pad((shapes * (mass @ shapes)).T, ((0, 0), (1, 0)))
    return np.sqrt(values[0] / values[:MODES]), shares


def find_shares(alphas: FloatArray, places: FloatArray) -> FloatArray:
    """Return participation times shape of each mode at z/h `places` (k,) of beams `alphas` (k,), (k, m) [-]."""
    cells = np.clip(places, 0.0, 1.0) * CELLS
    low = np.minimum(cells.astype(int), CELLS - 1)
    found = np.empty((alphas.size, MODES))
    for k, (alpha, at, part) in enumerate(zip(alphas.tolist(), low.tolist(), (cells - low).tolist(), strict=True)):
        shares = solve_beam(alpha)[1]
        found[k] = (1 - part) * shares[:, at] + part * shares[:, at + 1]
    return found


def swing_modes(ground: Single, time_step: float, periods: FloatArray, alphas: FloatArray) -> Single:
    """Return ground motions (k, n) [m/s2] and after each what its modes move relative to it, (k, 1 + m, n).

    `periods` (k,) are T1 [s]. A floor is the ground and, each times its share, the modes.
    """
    found = np.zeros((len(ground), 1 + MODES, ground.shape[1]), np.float32)
    found[:, 0] = ground
    every = periods[:, None] * np.array([solve_beam(alpha)[0] for alpha in alphas.tolist()])
    angle = 2 * np.pi * time_step / np.where(every > RIGID_BELOW, every, np.inf)
    damped, decay = angle * math.sqrt(1 - DAMPING**2), np.exp(-DAMPING * angle)
    cosine = decay * np.cos(damped)
    sine = decay * np.divide(np.sin(damped), damped, out=np.ones_like(damped), where=damped > 0)
    steps = np.stack([1 - sine, 2 * (sine - cosine), decay**2 - sine, 2 * cosine, -(decay**2)], axis=-1)
    steps[angle == 0] = 0.0
    _swing(found, steps)
    return found


@compiled
def _swing(motions: Single, steps: FloatArray) -> None:  # pragma: no cover
    """Fill motions[:, 1:] with the absolute acceleration of each oscillator less that of the ground, motions[:, 0]."""
    for k in range(motions.shape[0]):
        ground = motions[k, 0]
        for m in range(steps.shape[1]):
            b_0, b_1, b_2, a_1, a_2 = steps[k, m]
            if a_1 == 0:
                continue  # moves with the ground
            x_1, x_2, y_1, y_2 = 0.0, 0.0, 0.0, 0.0
            out = motions[k, 1 + m]
            for i in range(ground.size):
                x = ground[i]
                y = b_0 * x + b_1 * x_1 + b_2 * x_2 + a_1 * y_1 + a_2 * y_2
                x_2, x_1, y_2, y_1 = x_1, x, y_1, y
                out[i] = y - x


def combine_modes(modes: Single, alphas: FloatArray, places: FloatArray) -> Single:
    """Return the accelerations (k, n) of floors at z/h `places` (k,) from the modes of beams `alphas` (k,)."""
    shares = np.pad(find_shares(alphas, places), ((0, 0), (1, 0)), constant_values=1.0).astype(np.float32)
    return np.asarray(np.matmul(shares[:, None], modes)[:, 0], np.float32)


def shake_record(
    acceleration: FloatArray, time_step: float, building: Building, place: float | None
) -> tuple[float, float]:
    """Return the median PFA [m/s2] and PFV [m/s] at z/h `place` of drawn beams on one ground motion (n,) [m/s2].

    The beams are the same whatever the seed of a run.
    """
    ground = np.tile(acceleration.astype(np.float32), (PASSED, 1))
    alphas = building.draw_alphas(0, 0, PASSED)
    places = draw_places(0, 0, PASSED) if place is None else np.full(PASSED, place)
    modes = swing_modes(ground, time_step, building.draw_periods(0, 0, PASSED), alphas)
    pfa, pfv = np.median(measure_peaks(combine_modes(modes, alphas, places), time_step), axis=0).tolist()
    return pfa, pfv


@dataclass(frozen=True, slots=True, eq=False)
class Beams:
    """A building, a beam a draw, on ground motions along one axis.

    `key` is all that the ground motions depend on; `make_ground` gives those of a group by its number, (GROUP, n), in
    a unit of which floors give the factor.
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

        def swing() -> Single:
            periods = self.building.draw_periods(self.seed, first, GROUP)
            modes = swing_modes(self.make_ground(group), self.grid.time_step, periods, alphas)
            modes.flags.writeable = False
            return modes

        modes = KEPT.find_or_make((self.key, self.building, self.grid, self.seed, group), swing)
        places = np.full(GROUP, place) if place is not None else draw_places(self.seed, first, GROUP)
        return combine_modes(modes, alphas, places)


@dataclass(frozen=True, slots=True, eq=False)
class FloorMotions:
    """The motions of one floor along one axis; `open_floor` finds the factors of its two bands.

    `high` and `low` are those above and below the corner at PFA/(2 pi PFV) [-], the same in all draws.
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
        step = self.beams.grid.time_step
        low = split_bands(motions, step, np.full(GROUP, target.pfa / (2 * math.pi * target.pfv)))
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
    low = split_bands(motions, beams.grid.time_step, np.full(len(motions), target.pfa / (2 * math.pi * target.pfv)))
    each = target.meets == "pfa"
    found = find_common(motions, low, beams.grid.time_step, target.pfa, target.pfv, each=each)
    return FloorMotions(beams, target, *found)


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
    low, high = (
        one and np.log(one[1] / (target.factor * np.abs(beams.shake(group, one[0])).max(axis=1))).astype(np.float64)
        for one in (below, above)
    )
    if low is None and target.is_ground_known:
        below, low = (0.0, 0.0), np.zeros(GROUP)
    if low is None or high is None or below is None or above is None:
        found = low if high is None else high
        return np.zeros(GROUP) if found is None else found
    return np.asarray(low + (high - low) * (place - below[0]) / (above[0] - below[0]), np.float64)
