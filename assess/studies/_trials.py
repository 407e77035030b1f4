"""Direct integration of many blocks under the motions of every channel: what the studies hold formulas against.

For each channel motions are generated for the 5 % spectrum of its record, as `assess run` does, and scaled so that the
record's PFA becomes each of the values asked for, as the paper does in its section 3.2.3. What a channel takes is kept
in a file of its own as soon as it is done, so that a run that was ended takes up where it was.
"""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from assess.methods import Cases
from assess.methods._method import FloatArray
from assess.motion.target import Grid, build_grid, recorded_target
from assess.studies._buildings import Building, Channel
from assess.studies._parts import PARTS, Arrays, take_up
from assess.studies._study import Options
from assess.units import GRAVITY

RATIOS = tuple(round(0.10 + 0.025 * at, 3) for at in range(17))
HEIGHTS = (0.9, 1.2, 1.5, 1.8, 2.1)
"""B/H [-] and heights [m] of the blocks: every one with every other."""
LEVELS = tuple(round(0.05 * at, 2) for at in range(2, 19))
"""PFA to which the records are scaled [g]."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Trials:
    """What the blocks did under the motions of one channel.

    Parameters
    ----------
    channel : Channel
        Whose record the motions were made for.
    pfa, pfv : (a,) arrays
        Peaks of the record as scaled [m/s2], [m/s].
    breadth, height : (b,) arrays
        The blocks [m].
    fallen : (a, b) integer array
        Motions of `runs` under which each overturned.
    fell_in_record : (a, b) boolean array
        Whether it overturned under the record itself, as scaled.
    runs : int
        Motions.
    mean_pfa, mean_pfv : float
        Means of the peaks of the motions over those of the record [-].
    """

    channel: Channel
    pfa: FloatArray
    pfv: FloatArray
    breadth: FloatArray
    height: FloatArray
    fallen: NDArray[np.int64]
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


def build_blocks() -> tuple[FloatArray, FloatArray]:
    """Return breadths and heights of the blocks [m], each height with every B/H."""
    heights, ratios = np.meshgrid(HEIGHTS, RATIOS, indexing="ij")
    return (ratios * heights).ravel(), heights.ravel()


def rock_building(building: Building, levels: Mapping[Channel, Sequence[float]], options: Options) -> list[Trials]:
    """Rock the blocks under the motions of each channel of a building, at the values of PFA of `levels` [g]."""
    grid = build_grid([one.read() for one in building.channels])
    found = []
    for at, channel in enumerate(building.channels, 1):
        options.tell(f"{building.name}: channel {at} of {len(building.channels)}")
        found.append(_rock(channel, grid, np.array(levels[channel]) * GRAVITY, options))
    return found


def _rock(channel: Channel, grid: Grid, pfa: FloatArray, options: Options) -> Trials:
    """Return what was kept of a channel, or find it and keep it."""
    (breadth, height), motion = build_blocks(), channel.read()
    record = hashlib.sha256(channel.file.read_bytes()).hexdigest()
    sizes = breadth.tolist(), height.tolist()
    told = (record, channel.axis, grid, options.runs, options.seed, pfa.tolist(), sizes)
    kept = take_up(options.out / PARTS, told, lambda: _integrate(channel, grid, pfa, options))
    return Trials(
        channel=channel, pfa=pfa, pfv=pfa / motion.pfa * motion.pfv, breadth=breadth, height=height,
        fallen=kept["fallen"].astype(np.int64), fell_in_record=kept["fell_in_record"].astype(np.bool_),
        runs=options.runs, mean_pfa=float(kept["means"][0]), mean_pfv=float(kept["means"][1]),
    )  # fmt: skip


def _integrate(channel: Channel, grid: Grid, pfa: FloatArray, options: Options) -> Arrays:
    from assess.motion.compatible import build_generator
    from assess.rocking.ensemble import rock_blocks

    (breadth, height), motion = build_blocks(), channel.read()
    generator = build_generator(
        recorded_target(motion, grid), grid, seed=options.seed, axis=channel.axis, threads=options.jobs
    )
    made = generator.realise(0, options.runs)
    fallen, fell = [], []
    for scale in pfa / motion.pfa:
        rocking = rock_blocks(breadth, height, scale * made, grid.time_step, threads=options.jobs)
        record = rock_blocks(breadth, height, scale * motion.acceleration[None], motion.time_step, threads=options.jobs)
        fallen.append(rocking.overturned.sum(axis=1))
        fell.append(record.overturned[:, 0])
    velocity = np.cumsum((made[:, 1:] + made[:, :-1]) / 2, axis=1) * grid.time_step
    means = np.array([np.abs(made).max(axis=1).mean() / motion.pfa, np.abs(velocity).max(axis=1).mean() / motion.pfv])
    return {"fallen": np.array(fallen), "fell_in_record": np.array(fell), "means": means}
