"""The floor motions of the calibration: recorded ones, and those of shear beams that stand on recorded ground motions.

For each, motions are generated for its 5 % spectrum, as `assess run` does, and blocks are rocked under them and under
the floor motion itself. The result of each floor motion is kept as soon as it is known.

Stiffness and mass of a beam are constant over the height h. Mode n has the period T1/(2n - 1) and the shape
sin((2n - 1) pi z/(2 h)), with a participation factor of 4/((2n - 1) pi); all modes have the same damping. The absolute
acceleration of a floor is the sum of those of its modes, each an oscillator on the ground. Modes above `HIGHEST` are
taken as rigid: their share of the floor moves with the ground.

Reference: Miranda E, Taghavi S (2005). Approximate floor acceleration demands in multistory buildings. I: Formulation.
Journal of Structural Engineering 131(2):203-211. doi:10.1061/(ASCE)0733-9445(2005)131:2(203). The beam is theirs
without its flexural part.
"""

import hashlib
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from assess.compiled import compiled
from assess.errors import InputError
from assess.motion.formats import read_records
from assess.motion.record import FloatArray, Motion, treat
from assess.motion.spectrum import oscillator_step
from assess.motion.target import build_grid, put_on_grid, recorded_target
from assess.resources import record
from assess.studies.buildings import all_buildings
from assess.studies.studied_methods import BoolArray
from assess.studies.study import Options
from assess.studies.study_files import PARTS, Arrays, load_or_compute
from assess.units import GRAVITY

RATIOS, HEIGHTS = (0.12, 0.18, 0.26, 0.38), (0.9, 1.5, 2.1)
"""B/H [-] and heights [m] of the blocks, in every combination."""
LEVELS = (0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.1, 1.5)
"""PFA to which all floor motions are scaled [g]."""
PERIODS, PLACES = (0.5, 1.0, 2.0, 4.0), (0.5, 1.0)
"""T1 [s] of the beams and heights z/h [-] of their floors, in every combination."""
GROUND = ("ground", "basement")
"""Levels of the buildings that beams are put on."""
FREE_FIELD = (
    ("Redwood City", "X", "133 deg", "np01002p_4225a_a.smc"), ("Redwood City", "Y", "43 deg", "np01002p_4225c_a.smc"),
)  # fmt: skip
"""Station, axis, name and file of ground motions that are of no building: APEEL array 2, Loma Prieta 1989."""
CYCLES = 5.0
"""Rest after the ground motion, while beams swing, in multiples of T1 [-]."""


@dataclass(frozen=True, slots=True)
class Beam:
    """A uniform shear beam: T1 [s], and the height z/h of a floor in it [-]."""

    period: float
    place: float


@dataclass(frozen=True, slots=True)
class FloorMotion:
    """One floor motion: the place, level, axis and name of its record, the file, and the beam on it, if any."""

    site: str
    level: str
    axis: str
    name: str
    file: Path
    beam: Beam | None = None

    @property
    def source(self) -> str:
        """What is not independent of it: all motions along one axis of one site are of one earthquake."""
        return f"{self.site}, {self.axis}"

    def read(self) -> Motion:
        """Return its motion."""
        motion = treat(read_records(self.file)[0])
        return motion if self.beam is None else _shake(motion, self.beam)

    def __str__(self) -> str:
        beam = "" if self.beam is None else f", shear beam, T1 {self.beam.period:g} s, z/h {self.beam.place:g}"
        return f"{self.site}, {self.level}, {self.name}{beam}"


def _shake(ground: Motion, beam: Beam) -> Motion:
    """Return the motion of a floor of a beam, from the start of the ground motion until some cycles after its end."""
    from scipy.integrate import cumulative_trapezoid

    grid = build_grid([ground])
    rest = np.zeros(round(CYCLES * beam.period / grid.time_step))
    shaking = np.concatenate([put_on_grid(ground, grid), rest])
    acceleration = shake_beam(shaking, grid.time_step, beam.period, beam.place)
    velocity = cumulative_trapezoid(acceleration, dx=grid.time_step, initial=0)
    displacement = cumulative_trapezoid(velocity, dx=grid.time_step, initial=0)
    return Motion(acceleration, velocity, displacement, grid.time_step)


def list_recorded() -> list[FloorMotion]:
    """Return the recorded floor motions, ground floors and basements among them."""
    return [
        FloorMotion(one.building, one.level, one.axis, one.name, one.file)
        for building in all_buildings()
        for one in building.channels
    ]


def list_beams() -> list[FloorMotion]:
    """Return the floor motions of shear beams on all ground motions; InputError if a record is missing."""
    return [
        FloorMotion(one.site, one.level, one.axis, one.name, one.file, Beam(period, place))
        for one in _list_grounds()
        for period in PERIODS
        for place in PLACES
    ]


def _list_grounds() -> Iterator[FloorMotion]:
    yield from (one for one in list_recorded() if one.level in GROUND)
    for site, axis, name, file in FREE_FIELD:
        path = record(file)
        if not path.is_file():
            raise InputError(f"{path} is missing: the record of {site} is part of the package. Install it again.")
        yield FloorMotion(site, "ground", axis, name, path)


# ---------------------------------------------------------------- what falls


@dataclass(frozen=True, slots=True, eq=False)
class Tried:
    """The response of the blocks to a floor motion at all `LEVELS`, and to the motions generated for it.

    * `factors` (a,): factors by which it is scaled [-].
    * `fallen` (a, b): number of generated motions, of `runs`, under which each block overturned.
    * `fell` (a, b): whether it overturned under the floor motion itself.
    * `runs`: number of generated motions.
    """

    floor: FloorMotion
    factors: FloatArray
    fallen: NDArray[np.int64]
    fell: BoolArray
    runs: int


def build_blocks() -> tuple[FloatArray, FloatArray]:
    """Return breadths and heights of the blocks [m]: each height with every B/H."""
    heights, ratios = np.meshgrid(HEIGHTS, RATIOS, indexing="ij")
    return (ratios * heights).ravel(), heights.ravel()


def draw_seed(floor: FloorMotion, seed: int) -> int:
    """Return a seed of a floor motion's own, so that the phases of its motions are independent of the others'."""
    return int.from_bytes(hashlib.sha256(f"{seed}: {floor}, {floor.axis}".encode()).digest()[:4], "big")


def try_floors(floors: list[FloorMotion], options: Options) -> list[Tried]:
    """Rock the blocks under each floor motion and under the motions generated for it, or load earlier results."""
    return [_try_floor(floor, part) for floor, part in options.each(floors)]


def _try_floor(floor: FloorMotion, options: Options) -> Tried:
    digest = hashlib.sha256(floor.file.read_bytes()).hexdigest()
    inputs = ("calibration", digest, str(floor), floor.axis, options.runs, options.seed, LEVELS, RATIOS, HEIGHTS)
    kept = load_or_compute(options.out / PARTS, inputs, lambda: _integrate(floor, options))
    return Tried(
        floor=floor, factors=kept["factors"].astype(np.float64), fallen=kept["fallen"].astype(np.int64),
        fell=kept["fell"].astype(np.bool_), runs=options.runs,
    )  # fmt: skip


def _integrate(floor: FloorMotion, options: Options) -> Arrays:
    from assess.motion.generate import build_generator
    from assess.rocking.ensemble import rock_blocks

    (breadth, height), motion, threads = build_blocks(), floor.read(), options.jobs
    grid, seed = build_grid([motion]), draw_seed(floor, options.seed)
    generator = build_generator(recorded_target(motion, grid), grid, seed=seed, axis=floor.axis, threads=threads)
    factors = np.array(LEVELS) * GRAVITY / motion.pfa
    sizes = np.tile(breadth, factors.size), np.tile(height, factors.size)
    scale, shape = np.repeat(factors, breadth.size), (factors.size, breadth.size)
    made = rock_blocks(*sizes, generator.realise(0, options.runs), grid.time_step, scale=scale, threads=threads)
    itself = rock_blocks(*sizes, motion.acceleration[None], motion.time_step, scale=scale)
    return {
        "factors": factors,
        "fallen": made.overturned.sum(axis=1).reshape(shape),
        "fell": itself.overturned[:, 0].reshape(shape),
    }


DAMPING = 0.05
"""Share of critical damping of every mode [-]."""
HIGHEST = 25.0
"""Highest frequency of a mode that is not taken as rigid [Hz]: records hold little above."""


def count_modes(period: float) -> int:
    """Return how many modes of a beam with T1 [s] are up to `HIGHEST`, at least 1."""
    return max(1, math.floor((HIGHEST * period + 1) / 2))


def find_shares(modes: int, place: float) -> FloatArray:
    """Return participation factor times shape of each mode at the height z/h [-], (modes,); over all modes they are 1.

    At z/h 0 they are 0: the ground.
    """
    odd = 2 * np.arange(modes) + 1
    return np.asarray(4 / (np.pi * odd) * np.sin(odd * np.pi / 2 * place), dtype=np.float64)


def shake_beam(
    ground: FloatArray, time_step: float, period: float, place: float, *, modes: int | None = None
) -> FloatArray:
    """Return the absolute acceleration of a floor [m/s2], (n,), of a beam at rest that a ground motion shakes.

    * `ground` (n,): ground acceleration [m/s2], linear between its samples.
    * `time_step`: [s].
    * `period`: T1 [s].
    * `place`: height of the floor over that of the building, z/h [-].
    * `modes`: number of modes that are not taken as rigid; `count_modes` if it is not given.

    Raises ValueError if T1 is not above 0, or z/h is outside 0 to 1.
    """
    if not (0 < period < math.inf and 0 <= place <= 1):
        raise ValueError(f"T1 is {period} s and z/h {place}, expected above 0 and 0 to 1")
    count = count_modes(period) if modes is None else modes
    shares, periods = find_shares(count, place), period / (2 * np.arange(count) + 1)
    floor = (1 - shares.sum()) * ground
    _add_modes(np.ascontiguousarray(ground), oscillator_step(periods, time_step, DAMPING), shares, floor)
    return np.asarray(floor)


@compiled
def _add_modes(ground: FloatArray, step: FloatArray, shares: FloatArray, floor: FloatArray) -> None:  # pragma: no cover
    """Add to `floor` (n,) the absolute accelerations of oscillators, each multiplied by its share."""
    u, v = np.zeros(shares.size), np.zeros(shares.size)
    for i in range(ground.size - 1):
        a, b = ground[i], ground[i + 1]
        for j in range(shares.size):
            next_u = step[0, j] * u[j] + step[1, j] * v[j] + step[4, j] * a + step[5, j] * b
            next_v = step[2, j] * u[j] + step[3, j] * v[j] + step[6, j] * a + step[7, j] * b
            u[j], v[j] = next_u, next_v
            floor[i + 1] -= shares[j] * (step[8, j] * next_v + step[9, j] * next_u)
