"""The instrumented buildings whose records come with the package, and direct integration of blocks on their floors.

For each channel, motions are generated for the 5 % spectrum of its record, as `assess run` does, and scaled so that the
PFA of the record becomes each of the required values, as in the paper's section 3.2.3. The result of each channel is
kept as soon as it is known, so that an interrupted run continues from there.
"""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from assess.arrays import FloatArray
from assess.errors import InputError
from assess.methods import Cases
from assess.methods.simulate import rock_draws
from assess.motion.formats import read_records
from assess.motion.record import Motion, treat
from assess.motion.target import Grid, build_grid, recorded_target
from assess.resources import record
from assess.studies.study import PARTS, Arrays, Options, load_or_compute
from assess.units import GRAVITY

RATIOS = tuple(round(0.10 + 0.025 * at, 3) for at in range(17))
HEIGHTS = (0.9, 1.2, 1.5, 1.8, 2.1)
"""B/H [-] and heights [m] of the blocks, in every combination."""
LEVELS = tuple(round(0.05 * at, 2) for at in range(2, 19))
"""PFA to which all records are scaled [g]."""
TOGETHER = (0.3, 0.5, 0.7)
"""PFA of the strongest channel of a floor [g] at which the channels of that floor are compared with each other."""
RECORDED, FIRST_TOGETHER = len(LEVELS), len(LEVELS) + 1
"""Index of the recorded PFA among the values of a channel, after `LEVELS`, and of the first of `TOGETHER`."""


@dataclass(frozen=True, slots=True)
class Channel:
    """One horizontal channel: file, floor, and axis of the building; two of one axis may point in opposite ways."""

    building: str
    level: str
    axis: str
    name: str
    file: Path

    def read(self) -> Motion:
        """Return its motion, treated as everywhere (`assess.motion.record.treat`)."""
        return _read(self.file)

    def __str__(self) -> str:
        return f"{self.building}, {self.level}, {self.name}"


@lru_cache(maxsize=64)
def _read(file: Path) -> Motion:
    return treat(read_records(file)[0])


@dataclass(frozen=True, slots=True)
class Building:
    """An instrumented building: its name, the earthquake, and its horizontal channels, floor by floor."""

    name: str
    place: str
    event: str
    channels: tuple[Channel, ...]


MARKET = (
    ("ground", "Y", "k"), ("25th floor", "X", "g"), ("25th floor", "X", "h"), ("25th floor", "Y", "i"),
    ("34th floor", "X", "d"), ("34th floor", "X", "e"),
    ("42nd floor", "X", "a"), ("42nd floor", "X", "b"), ("42nd floor", "Y", "c"),
)  # fmt: skip
BERKELEY = (
    ("basement", "X", "HN2.NP.BE"), ("basement", "X", "HN2.NP.BW"), ("basement", "Y", "HN3.NP.BE"),
    ("basement", "Y", "HN3.NP.BW"), ("4th floor", "X", "HN2.NP.4E"), ("4th floor", "X", "HN2.NP.4W"),
    ("roof", "X", "HN2.NP.RC"), ("roof", "X", "HN2.NP.RE"), ("roof", "X", "HN2.NP.RS"), ("roof", "Y", "HN3.NP.RE"),
    ("roof", "Y", "HN3.NP.RS"),
)  # fmt: skip
ALHAMBRA = (("12th floor", "X", "0165a_u"),)
"""Floor, axis and name of every horizontal channel, the lowest first."""
BUILDINGS = (
    ("575 Market Street", "San Francisco", "Loma Prieta, 18 October 1989 UTC", "891018_1.cra-1.0210{}.smc", MARKET),
    ("Great Western Savings", "Berkeley", "Berkeley, 4 January 2018", "1103.{}_a.smc", BERKELEY),
    ("LACPW headquarters", "Alhambra", "Whittier Narrows, 1 October 1987", "{}.smc", ALHAMBRA),
)
"""Name, place, earthquake, names of the files, and channels."""


def all_buildings() -> tuple[Building, ...]:
    """Return the three buildings; InputError if a record is missing."""
    return tuple(
        Building(
            name, place, event, tuple(Channel(name, *row, find_record(pattern.format(row[-1]), name)) for row in rows)
        )
        for name, place, event, pattern, rows in BUILDINGS
    )


def find_record(name: str, site: str) -> Path:
    """Return the file of a record; InputError if it is missing."""
    file = record(name)
    if not file.is_file():
        raise InputError(f"{file} is missing: the records of {site} are part of the package. Install it again.")
    return file


def find_levels(building: Building) -> dict[Channel, list[float]]:
    """Return the values of PFA of each channel [g]: `LEVELS`, its own as recorded, and those of `TOGETHER`.

    For the latter, all channels of a floor are scaled by the factor that gives the strongest of them that PFA.
    """
    found = {}
    for channel in building.channels:
        own = channel.read().pfa
        strongest = max(one.read().pfa for one in building.channels if one.level == channel.level)
        found[channel] = [*LEVELS, own / GRAVITY, *(own / strongest * value for value in TOGETHER)]
    return found


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Trials:
    """The response of the blocks to the motions of one channel.

    * `channel`: the motions were generated for its record.
    * `pfa`, `pfv` (a,): peaks of the record as scaled [m/s2], [m/s].
    * `breadth`, `height` (b,): the blocks [m].
    * `fallen` (a, b): number of motions, of `runs`, under which each block overturned.
    * `fallen_uncertain` (a, b): the same where the amplitude of each motion and the piece are drawn
      (`assess.rocking.draws.Uncertainty`): as in the chances that `assess run` adopts.
    * `fell_in_record` (a, b): whether it overturned under the record itself, as scaled.
    * `mean_pfa`, `mean_pfv`: mean peaks of the motions over those of the record [-].
    """

    channel: Channel
    pfa: FloatArray
    pfv: FloatArray
    breadth: FloatArray
    height: FloatArray
    fallen: NDArray[np.int64]
    fallen_uncertain: NDArray[np.int64]
    fell_in_record: NDArray[np.bool_]
    runs: int
    mean_pfa: float
    mean_pfv: float

    @property
    def risk(self) -> FloatArray:
        """Share of the motions under which each block overturned [-], (a, b)."""
        return np.asarray(self.fallen / self.runs, dtype=np.float64)

    @property
    def cases(self) -> Cases:
        """Every block at every PFA, the blocks of one PFA together, (a b,)."""
        a, b = self.fallen.shape
        return Cases.of(
            breadth=np.tile(self.breadth, a), height=np.tile(self.height, a),
            pfa=np.repeat(self.pfa, b), pfv=np.repeat(self.pfv, b),
        )  # fmt: skip


def build_blocks(ratios: Sequence[float] = RATIOS, heights: Sequence[float] = HEIGHTS) -> tuple[FloatArray, FloatArray]:
    """Return breadths and heights of the blocks [m]: each height with every B/H."""
    tall, slender = np.meshgrid(heights, ratios, indexing="ij")
    return (slender * tall).ravel(), tall.ravel()


def rock_building(building: Building, levels: Mapping[Channel, Sequence[float]], options: Options) -> list[Trials]:
    """Rock the blocks under the motions of each channel of a building, at the values of PFA of `levels` [g]."""
    grid = build_grid([channel.read() for channel, _ in options.narrow(0.0, 0.0).each(building.channels)])
    (breadth, height), found = build_blocks(), []
    for channel, part in options.each(building.channels):
        motion, pfa = channel.read(), np.array(levels[channel]) * GRAVITY
        digest = hashlib.sha256(channel.file.read_bytes()).hexdigest()
        sizes = breadth.tolist(), height.tolist()
        inputs = (digest, channel.axis, grid, options.runs, options.seed, pfa.tolist(), sizes)
        kept = load_or_compute(options.out / PARTS, inputs, partial(_integrate, channel, grid, pfa, part))
        trials = Trials(
            channel=channel, pfa=pfa, pfv=pfa / motion.pfa * motion.pfv, breadth=breadth, height=height,
            fallen=kept["fallen"].astype(np.int64), fallen_uncertain=kept["fallen_uncertain"].astype(np.int64),
            fell_in_record=kept["fell_in_record"].astype(np.bool_), runs=options.runs,
            mean_pfa=float(kept["means"][0]), mean_pfv=float(kept["means"][1]),
        )  # fmt: skip
        found.append(trials)
    return found


def _integrate(channel: Channel, grid: Grid, pfa: FloatArray, options: Options) -> Arrays:
    from assess.motion.generate import build_generator
    from assess.rocking.ensemble import rock_blocks

    (breadth, height), motion = build_blocks(), channel.read()
    target, threads, every = recorded_target(motion, grid), options.jobs, np.arange(breadth.size)
    made = build_generator(target, grid, seed=options.seed, axis=channel.axis, threads=threads).realise(0, options.runs)
    cases = Cases.of(breadth=breadth, height=height, name=every)
    fallen, uncertain, fell = [], [], []
    for scale, _ in options.each((pfa / motion.pfa).tolist()):
        rocking = rock_blocks(breadth, height, scale * made, grid.time_step, threads=threads)
        record = rock_blocks(breadth, height, scale * motion.acceleration[None], motion.time_step, threads=threads)
        drawn, _ = rock_draws(
            cases, every, scale * made, grid.time_step,
            first=0, dispersions=(cases.uncertainty.motion,), seed=options.seed, threads=threads,
        )  # fmt: skip
        fallen.append(rocking.overturned.sum(axis=1))
        uncertain.append(drawn[0].sum(axis=1))
        fell.append(record.overturned[:, 0])
    velocity = np.cumsum((made[:, 1:] + made[:, :-1]) / 2, axis=1) * grid.time_step
    means = np.array([np.abs(made).max(axis=1).mean() / motion.pfa, np.abs(velocity).max(axis=1).mean() / motion.pfv])
    return {
        "fallen": np.array(fallen), "fallen_uncertain": np.array(uncertain), "fell_in_record": np.array(fell),
        "means": means,
    }  # fmt: skip
