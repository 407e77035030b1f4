"""Study `calibration`: whether chances of generated motions are right, by what the floor motions themselves overturn.

No part of the paper. A chance of 30 % should come true in 30 of 100 cases: here it is held against the one outcome that
is known of each floor motion, its own. Floor motions are recorded ones, and those of shear beams that stand on recorded
ground motions. For each, motions are generated for its 5 % spectrum, as `assess run` does, and blocks are rocked under
them and under the floor motion itself. The result of each floor motion is kept as soon as it is known.

Stiffness and mass of a beam are constant over the height h. Mode n has the period T1/(2n - 1) and the shape
sin((2n - 1) pi z/(2 h)), with a participation factor of 4/((2n - 1) pi); all modes have the same damping. The absolute
acceleration of a floor is the sum of those of its modes, each an oscillator on the ground. Modes above `HIGHEST` are
taken as rigid: their share of the floor moves with the ground.

Chances agree with what happened where the mean chance less the share that fell is within its error. Cases of one floor
motion are not independent of each other: twelve blocks at eight amplitudes fall or stand together. So the error is that
of the delete-one-group jackknife: the mean is found again without each group of cases in turn, and the scatter of these
means gives the error. A group is a floor motion; or, as the floors of a building in one earthquake are not independent
either, all that comes from one site and axis.

References
----------
Efron B (1982). The jackknife, the bootstrap and other resampling plans. Society for Industrial and Applied Mathematics.
doi:10.1137/1.9781611970319
Miranda E, Taghavi S (2005). Approximate floor acceleration demands in multistory buildings. I: Formulation. Journal of
Structural Engineering 131(2):203-211. doi:10.1061/(ASCE)0733-9445(2005)131:2(203). The beam is theirs without its
flexural part.
"""

import hashlib
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import astuple, dataclass, fields
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray, FloatArray
from assess.compiled import compiled
from assess.motion.record import Motion
from assess.motion.spectrum import oscillator_step
from assess.motion.target import build_grid, put_on_grid, recorded_target
from assess.report.figures.draw import draw
from assess.risk import LIMITS, RiskClass, classify_all
from assess.studies.buildings import Channel, all_buildings, build_blocks, find_record
from assess.studies.study import PARTS, Arrays, Finding, Options, Row, Study, Table, load_or_compute, write_finding
from assess.units import GRAVITY, LENGTH

RATIOS, HEIGHTS = (0.12, 0.18, 0.26, 0.38), (0.9, 1.5, 2.1)
"""B/H [-] and heights [m] of the blocks, in every combination."""
BLOCKS = build_blocks(RATIOS, HEIGHTS)
"""Their breadths and heights [m]."""
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
    """One floor motion: the channel of its record, and the beam on it, if any."""

    channel: Channel
    beam: Beam | None = None

    @property
    def source(self) -> str:
        """What is not independent of it: all motions along one axis of one site are of one earthquake."""
        return f"{self.channel.building}, {self.channel.axis}"

    def read(self) -> Motion:
        """Return its motion; that of a beam goes on for some cycles after the end of the ground motion."""
        if self.beam is None:
            return self.channel.read()
        from scipy.integrate import cumulative_trapezoid

        grid = build_grid([ground := self.channel.read()])
        rest = np.zeros(round(CYCLES * self.beam.period / grid.time_step))
        shaking = np.concatenate([put_on_grid(ground, grid), rest])
        acceleration = shake_beam(shaking, grid.time_step, self.beam.period, self.beam.place)
        velocity = cumulative_trapezoid(acceleration, dx=grid.time_step, initial=0)
        displacement = cumulative_trapezoid(velocity, dx=grid.time_step, initial=0)
        return Motion(acceleration, velocity, displacement, grid.time_step)

    def __str__(self) -> str:
        beam = "" if self.beam is None else f", shear beam, T1 {self.beam.period:g} s, z/h {self.beam.place:g}"
        return f"{self.channel}{beam}"


def list_recorded() -> list[FloorMotion]:
    """Return the recorded floor motions, ground floors and basements among them."""
    return [FloorMotion(channel) for building in all_buildings() for channel in building.channels]


def list_beams() -> list[FloorMotion]:
    """Return the floor motions of shear beams on all ground motions; InputError if a record is missing."""
    grounds = [one.channel for one in list_recorded() if one.channel.level in GROUND]
    grounds += [Channel(site, "ground", axis, name, find_record(file, site)) for site, axis, name, file in FREE_FIELD]
    return [FloorMotion(one, Beam(period, place)) for one in grounds for period in PERIODS for place in PLACES]


@dataclass(frozen=True, slots=True, eq=False)
class Tried:
    """The response of the blocks to a floor motion at all `LEVELS`, and to the motions generated for it.

    * `factors` (a,): factors by which it is scaled [-].
    * `fallen` (a, b): number of generated motions, of `runs`, under which each block overturned.
    * `fell` (a, b): whether it overturned under the floor motion itself.
    """

    floor: FloorMotion
    factors: FloatArray
    fallen: NDArray[np.int64]
    fell: BoolArray
    runs: int


def draw_seed(floor: FloorMotion, seed: int) -> int:
    """Return a seed of a floor motion's own, so that the phases of its motions are independent of the others'."""
    return int.from_bytes(hashlib.sha256(f"{seed}: {floor}, {floor.channel.axis}".encode()).digest()[:4], "big")


def try_floors(floors: list[FloorMotion], options: Options) -> list[Tried]:
    """Rock the blocks under each floor motion and under the motions generated for it, or load earlier results."""
    found = []
    for floor, part in options.each(floors):
        digest = hashlib.sha256(floor.channel.file.read_bytes()).hexdigest()
        names = "calibration", digest, str(floor), floor.channel.axis
        inputs = (*names, options.runs, options.seed, LEVELS, RATIOS, HEIGHTS)
        kept = load_or_compute(options.out / PARTS, inputs, partial(_integrate, floor, part))
        factors, fallen = kept["factors"].astype(np.float64), kept["fallen"].astype(np.int64)
        found.append(Tried(floor, factors, fallen, kept["fell"].astype(np.bool_), options.runs))
    return found


def _integrate(floor: FloorMotion, options: Options) -> Arrays:
    from assess.motion.generate import build_generator
    from assess.rocking.ensemble import rock_blocks

    (breadth, height), motion, threads = BLOCKS, floor.read(), options.jobs
    grid, seed = build_grid([motion]), draw_seed(floor, options.seed)
    generator = build_generator(
        recorded_target(motion, grid), grid, seed=seed, axis=floor.channel.axis, threads=threads
    )
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
    """Return participation factor times shape of each mode at z/h [-], (modes,): 0 at the ground, 1 over all modes."""
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


EDGES = (0.0, 0.03, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
"""Limits of the chances that the figure shows together [-]; the lower one belongs to them, and 1 to the last."""


@dataclass(frozen=True, slots=True, eq=False)
class Outcomes:
    """Chances of n cases, what happened, and whose they are.

    * `chance` (n,): share of the generated motions under which the block overturned [-].
    * `fell` (n,): whether it overturned under the floor motion itself.
    * `floor`, `source` (n,): its floor motion; its site and axis.
    """

    chance: FloatArray
    fell: BoolArray
    floor: NDArray[np.int64]
    source: NDArray[np.int64]

    @classmethod
    def of(cls, tried: Sequence[Tried]) -> "Outcomes":
        """Gather the cases of floor motions."""
        counts = [one.fallen.size for one in tried]
        sources = list(dict.fromkeys(one.floor.source for one in tried))
        own = [sources.index(one.floor.source) for one in tried]
        return cls(
            np.concatenate([one.fallen.ravel() / one.runs for one in tried]),
            np.concatenate([one.fell.ravel() for one in tried]),
            np.repeat(np.arange(len(tried)), counts),
            np.repeat(own, counts),
        )

    def take(self, chosen: BoolArray) -> "Outcomes":
        """Return the chosen cases (n,)."""
        return Outcomes(self.chance[chosen], self.fell[chosen], self.floor[chosen], self.source[chosen])


@dataclass(frozen=True, slots=True, kw_only=True)
class Score:
    """How the chances of some cases agree with what happened.

    * `cases`, `fallen`, `floors`: number of cases, of those that fell, and of floor motions among them.
    * `chance`, `share`: mean chance; share of the cases that fell [-].
    * `difference`: the one less the other [-].
    * `error`, `error_by_source`: standard error of the difference [-], floor motions taken as independent, or only
      sites and axes. NaN where there is one, or where no case fell or all did: what did not happen has no scatter.
    """

    cases: int
    fallen: int
    floors: int
    chance: float
    share: float
    difference: float
    error: float
    error_by_source: float

    @property
    def largest_error(self) -> float:
        """The larger of the two errors [-]; NaN where neither is known."""
        return float(np.fmax(self.error, self.error_by_source))

    @property
    def is_clear(self) -> bool:
        """Whether the difference is beyond twice the larger error."""
        return abs(self.difference) > 2 * self.largest_error


def find_error(values: FloatArray, groups: NDArray[np.int64]) -> float:
    """Return the standard error of the mean of `values` (n,) by the jackknife over `groups` (n,); NaN with one."""
    _, which = np.unique(groups, return_inverse=True)
    sums, counts = np.bincount(which, values), np.bincount(which)
    if counts.size < 2:
        return math.nan
    means = (sums.sum() - sums) / (counts.sum() - counts)
    return math.sqrt((counts.size - 1) / counts.size * float(np.sum((means - means.mean()) ** 2)))


def find_score(outcomes: Outcomes) -> Score | None:
    """Return how chances agree with what happened; None without a case."""
    if not outcomes.chance.size:
        return None
    off = outcomes.chance - outcomes.fell
    errors = [find_error(off, groups) for groups in (outcomes.floor, outcomes.source)]
    if outcomes.fell.all() or not outcomes.fell.any():
        errors = [math.nan, math.nan]
    return Score(
        cases=int(off.size), fallen=int(outcomes.fell.sum()), floors=int(np.unique(outcomes.floor).size),
        chance=float(outcomes.chance.mean()), share=float(outcomes.fell.mean()), difference=float(off.mean()),
        error=errors[0], error_by_source=errors[1],
    )  # fmt: skip


def by_class(outcomes: Outcomes) -> dict[RiskClass, Score]:
    """Return the scores of the classes of chance that have cases."""
    classes = classify_all(outcomes.chance)
    found = {risk: find_score(outcomes.take(classes == risk)) for risk in RiskClass}
    return {risk: score for risk, score in found.items() if score is not None}


def by_chance(outcomes: Outcomes) -> Iterator[Score]:
    """Yield the scores of the cases between two `EDGES`, where there are any."""
    place = np.clip(np.searchsorted(EDGES, outcomes.chance, side="right") - 1, 0, len(EDGES) - 2)
    for at in range(len(EDGES) - 1):
        score = find_score(outcomes.take(place == at))
        if score is not None:
            yield score


RECORDED, BEAMS = "recorded floors", "shear-beam floors"
COLUMNS = (
    "kind", "site", "axis", "level", "record", "beam_t1_s", "beam_z_over_h", "pfa_g", "factor", "breadth_cm",
    "height_cm", "fallen", "runs", "fell_itself",
)  # fmt: skip
SCORES = ("kind", "class", *(field.name for field in fields(Score)))
MARKS = {RECORDED: ("o", "#1b4f72"), BEAMS: ("s", "#db7133")}
ALL = "all"


@dataclass(frozen=True, slots=True, eq=False)
class Calibrated:
    """Floor motions of one kind: the trials, their cases, and the scores of all and of each class of chance.

    `sources` is the number of sites and axes, `factors` are those by which floor motions are scaled [-].
    """

    tried: Sequence[Tried]
    outcomes: Outcomes
    whole: Score
    classes: Mapping[RiskClass, Score]
    sources: int
    factors: Sequence[float]


def run(options: Options) -> Finding:
    """Hold chances against the outcome under the floor motions themselves."""
    recorded, beams = list_recorded(), list_beams()
    share = len(recorded) / (len(recorded) + len(beams))
    found = {
        RECORDED: calibrate(try_floors(recorded, options.narrow(0.0, share))),
        BEAMS: calibrate(try_floors(beams, options.narrow(share, 1.0))),
    }
    scores: list[Row] = []
    for name, own in found.items():
        scores += [(name, risk.word, *astuple(score)) for risk, score in own.classes.items()]
        scores.append((name, ALL, *astuple(own.whole)))
    sizes = [(float(b / LENGTH["cm"]), float(h / LENGTH["cm"])) for b, h in zip(*BLOCKS, strict=True)]
    cases: list[Row] = []
    for name, tried in ((name, one) for name, own in found.items() for one in own.tried):
        channel, beam = tried.floor.channel, tried.floor.beam
        place = ("", "") if beam is None else (beam.period, beam.place)
        head = name, channel.building, channel.axis, channel.level, channel.name, *place
        cases += [
            (*head, level, float(factor), *size, int(fallen), tried.runs, bool(fell))
            for level, factor, row, own in zip(LEVELS, tried.factors, tried.fallen, tried.fell, strict=True)
            for size, fallen, fell in zip(sizes, row, own, strict=True)
        ]
    return write_finding(
        "calibration",
        collect(found, options),
        tables={
            "calibration": Table(columns=SCORES, rows=scores),
            "calibration-cases": Table(columns=COLUMNS, rows=cases),
        },
        figures={"calibration.svg": draw(7, 3.4, partial(_paint, found))},
    )


def calibrate(tried: Sequence[Tried]) -> Calibrated:
    """Score the trials of one kind of floor motions, at least one."""
    outcomes = Outcomes.of(tried)
    whole = find_score(outcomes)
    if whole is None:
        raise ValueError("there is no floor motion to score")
    factors = [float(one) for trial in tried for one in trial.factors]
    return Calibrated(tried, outcomes, whole, by_class(outcomes), int(np.unique(outcomes.source).size), factors)


def collect(found: Mapping[str, Calibrated], options: Options) -> dict[str, object]:
    """Return what the page shows."""
    return {
        "RECORDED": RECORDED, "BEAMS": BEAMS, "ALL": ALL, "options": options, "found": found,
        "recorded": found[RECORDED], "beams": found[BEAMS], "risks": list(RiskClass), "LOW": RiskClass.LOW,
        "limits": LIMITS, "ratios": RATIOS, "heights": HEIGHTS, "levels": LEVELS, "periods": PERIODS,
        "places": PLACES, "damping": DAMPING, "highest": HIGHEST, "blocks": len(RATIOS) * len(HEIGHTS),
        "free_field": len(FREE_FIELD),
        "unlike": {name: [risk for risk, one in own.classes.items() if one.is_clear] for name, own in found.items()},
    }  # fmt: skip


def _paint(found: Mapping[str, Calibrated], figure: Any) -> None:
    """Paint the share that fell over the mean chance: a point for the cases of similar chance, with its error."""
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1], color="#888888", lw=0.8)
    for limit in LIMITS:
        axes.axvline(limit, color="#444444", lw=0.6, ls="--")
    for name, own in found.items():
        points = list(by_chance(own.outcomes))
        mark, colour = MARKS[name]
        errors = [2 * np.nan_to_num(one.largest_error) for one in points]
        axes.errorbar(
            [one.chance for one in points], [one.share for one in points], yerr=errors, fmt=mark, ms=4, mfc="none",
            mec=colour, ecolor=colour, elinewidth=0.8, capsize=2, label=name,
        )  # fmt: skip
    axes.set_xlim(-0.02, 1.02)
    axes.set_ylim(-0.02, 1.02)
    axes.set_xlabel("mean chance by generated motions [-]", fontsize=7)
    axes.set_ylabel("share that the floor motion itself overturned [-]", fontsize=7)
    axes.tick_params(labelsize=6)
    axes.legend(fontsize=6, frameon=False, loc="lower right")


STUDY = Study(name="calibration", order=35, title="Chances against what records overturn", of="", run=run)
