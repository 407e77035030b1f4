"""What simulations of many pieces under many motions share: batches, threads, draws, and what stands next to a chance.

Slip, and falls with a wall at the back, are shown next to a chance, which they never lower. Slip is that of Newmark's
block, which slides and does not rock: it depends on the friction and the motion alone, so that pieces of one friction
on one floor share it. In a draw in which a piece does not slide by Shenton's limits, for the peak of that draw's motion
and the piece as it is given, its slip is 0. One-sided falls are those of the piece with a wall at its back, under the
same draws as its chance without one.

References: `assess.rocking.sliding` (Shenton 1996, Newmark 1965), `assess.rocking.planar` (Sorrentino et al. 2011).
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from assess.arrays import BoolArray, FloatArray
from assess.methods.cases import SIDE_UNKNOWN, Alike, Cases, Motions
from assess.progress import SILENT, Progress
from assess.risk import NORMAL_95
from assess.rocking.draws import CUT, DrawnBodies, Uncertainty, draw_bodies
from assess.rocking.sliding import Branch, branch, peak_slip
from assess.settings import AUTO, Settings
from assess.units import LENGTH

LOOKS = (125, 250, 500, 1000, 2500, 5000)
"""Numbers of motions at which runs="auto" checks whether the interval of a piece lies within one class."""
LOOKS_Z = 2.64
"""Half width of the intervals of "auto" [-]: 95 % for all six checks together (Bonferroni, 0.83 % each)."""

HIGH = 0.84
"""Share of the draws whose slip is at most the one shown next to the median: about one standard deviation above [-]."""
SLIDING = (Branch.SLIDE, Branch.SLIDE_AND_ROCK)

_Result = TypeVar("_Result")


def interval_width(settings: Settings) -> float:
    """Return z, the half width of the intervals in standard deviations [-]."""
    return LOOKS_Z if settings.runs == AUTO else NORMAL_95


def run_side_by_side(work: Callable[..., _Result], tasks: list[Any], threads: int) -> Iterator[_Result]:
    """Yield the results of `work` in the order of `tasks`, several of which are worked on at once.

    Never in the calling thread: a Ctrl-C that arrives during a compilation would be lost there.
    """
    if not tasks:
        return
    from concurrent.futures import ThreadPoolExecutor

    pool = ThreadPoolExecutor(threads)
    try:
        yield from [future.result() for future in [pool.submit(work, *task) for task in tasks]]
    finally:
        pool.shutdown(wait=False, cancel_futures=True)  # after Ctrl-C nobody waits for the rest


def make_batches(motions: Motions, first: int, last: int, size: int) -> Iterator[tuple[int, FloatArray, float]]:
    """Yield motions `first` to `last` - 1: the number of the first of a batch, the batch, its time step."""
    at = first
    for start in range(first, last, size):
        for batch, time_step in motions.realise(start, min(size, last - start)):
            yield at, batch, time_step
            at += len(batch)


def rock_cases(
    cases: Cases,
    own: NDArray[np.intp],
    motions: NDArray[Any],
    time_step: float,
    threads: int,
    progress: Progress = SILENT,
) -> tuple[BoolArray, FloatArray]:
    """Return whether each of the cases `own`, as it is given, overturns under each motion, and how far it turns.

    (m, k) each.
    """
    from assess.rocking.ensemble import rock_blocks

    found = rock_blocks(
        cases.breadth[own], cases.height[own], motions, time_step,
        restitution=cases.restitution[own], centre=cases.centre[own], threads=threads, progress=progress,
    )  # fmt: skip
    return found.overturned, found.rotation


def draw_body(cases: Cases, own: NDArray[np.intp], seed: int, first: int, count: int) -> DrawnBodies:
    """Return the bodies of the cases `own` in each draw, (m, k) each: as given where pieces are not uncertain."""
    shape = cases.breadth[own], cases.height[own], cases.centre[own], cases.restitution[own]
    if cases.uncertainty.piece:
        return draw_bodies(*shape, cases.name[own], seed=seed, first=first, count=count, scanned=cases.scanned[own])
    return DrawnBodies(*(np.repeat(one[:, None], count, axis=1) for one in shape))


def rock_draws(
    cases: Cases,
    own: NDArray[np.intp],
    motions: NDArray[Any],
    time_step: float,
    *,
    first: int,
    dispersions: Sequence[float | FloatArray],
    seed: int,
    threads: int,
    progress: Progress = SILENT,
) -> tuple[BoolArray, FloatArray]:
    """Return whether each of the cases `own` overturns in each draw, and how far it turns: (d, m, k) each.

    Motion k of `motions`, draw `first` + k, is scaled by one factor for the whole building, and the pieces are those of
    that draw where they are uncertain; once for each of d `dispersions` of the motion, of all cases or of each (m,).
    """
    from assess.rocking.ensemble import rock_blocks

    count = len(motions)
    drawn = draw_body(cases, own, seed, first, count)
    b, h, z, eta = drawn.breadth, drawn.height, drawn.centre, drawn.restitution
    numbers = cases.earthquakes.draw(seed, first, count)
    scales = [np.exp(np.broadcast_to(one, own.size)[:, None] * numbers) for one in dispersions]
    every = len(dispersions), 1
    found = rock_blocks(
        np.tile(b, every), np.tile(h, every), motions, time_step,
        restitution=np.tile(eta, every), centre=np.tile(z, every), scale=np.concatenate(scales),
        threads=threads, progress=progress,
    )  # fmt: skip
    wanted = len(dispersions), own.size, count
    return found.overturned.reshape(wanted), found.rotation.reshape(wanted)


# ---------------------------------------------------------------- next to a chance


def find_branch(cases: Cases) -> NDArray[np.int64]:
    """Return how each case starts to move at the floor's PFA, (n,): `Branch`, or `UNKNOWN` without a friction."""
    return branch(cases.breadth, cases.height, cases.friction, cases.pfa, centre=cases.centre)


def may_slide(cases: Cases, settings: Settings) -> BoolArray:
    """Return where a piece slides under the strongest motion that may be drawn, whose peak may be above the PFA."""
    strongest = cases.pfa * (1.0 if settings.ideal else np.exp(CUT * cases.dispersion)) / cases.still
    found = branch(cases.breadth, cases.height, cases.friction, strongest, centre=cases.centre)
    return np.isin(found, SLIDING)


@dataclass(slots=True)
class SlipAndWall:
    """Finds slip, and falls with a wall at the back, of cases of one ensemble, batch by batch of its motions.

    `sliders` (p,) and `walled` (q,) are the cases whose slip, and whose falls, are wanted.
    """

    cases: Cases
    settings: Settings
    sliders: NDArray[np.intp]
    walled: NDArray[np.intp]
    _slips: list[FloatArray] = field(default_factory=list)
    """Of each slider under each motion, (p, k) [m]."""
    _fell: list[BoolArray] = field(default_factory=list)
    """Whether each walled piece falls in each draw, (2, q, k): turning in either direction, if it can."""

    def __post_init__(self) -> None:
        if self.settings.ideal:  # nothing is drawn
            certain, none = Uncertainty(motion=0.0, piece=False), np.zeros_like(self.cases.dispersion)
            self.cases = replace(self.cases, uncertainty=certain, dispersion=none)

    def add(
        self, motions: NDArray[np.floating], time_step: float, first: int, threads: int, progress: Progress = SILENT
    ) -> None:
        """Take in motions `first` to `first + k - 1`, (k, n) [m/s2]."""
        both = np.concatenate([self.sliders, self.walled])
        if not both.size:
            return
        numbers = self.cases.earthquakes.draw(self.settings.seed, first, len(motions))
        scale = np.exp(self.cases.dispersion[both[0]] * numbers)  # all are on one floor
        every, cases = motions.astype(np.float64), self.cases
        if self.sliders.size:
            own = self.sliders
            frictions, which = np.unique(cases.friction[own], return_inverse=True)
            slips = peak_slip(frictions, every, time_step, scale=scale, threads=threads, progress=progress)
            B, H, mu, centre = (one[own, None] for one in (cases.breadth, cases.height, cases.friction, cases.centre))
            starts = branch(B, H, mu, np.abs(every).max(axis=1) * scale, centre=centre)
            self._slips.append(np.where(np.isin(starts, SLIDING), slips[which], 0.0))
        if not self.walled.size:
            return
        from assess.rocking.planar import Away, Body, rock_bodies

        fell = np.zeros((2, self.walled.size, len(motions)), dtype=np.bool_)
        ways: tuple[Away, Away] = (1, -1)
        for at, away in enumerate(ways):
            here = np.isin(cases.wall[self.walled], (away, SIDE_UNKNOWN))
            if here.any():
                drawn = draw_body(cases, self.walled[here], self.settings.seed, first, len(motions))
                body = Body.rectangular(drawn.breadth, drawn.height, centre=drawn.centre, restitution=drawn.restitution)
                fell[at, here] = rock_bodies(
                    body, every, time_step, away=away, scale=scale, threads=threads, progress=progress
                ).overturned
        self._fell.append(fell)

    def find(
        self, alone: BoolArray, has_wall: BoolArray, alike: Alike
    ) -> list[tuple[NDArray[np.intp], dict[str, NDArray[Any]]]]:
        """Return by name what was found of the sliders, and of the cases with a wall.

        Of m cases on the floor, in groups of `alike`, those that `has_wall` fell so without one, `alone` (m, k).
        """
        slips = np.concatenate(self._slips, axis=1) if self._slips else np.zeros((0, 1))
        median, high = np.quantile(slips / LENGTH["cm"], (0.5, HIGH), axis=1)
        fell = np.concatenate(self._fell, axis=2) if self._fell else np.zeros((2, 0, 1))
        one_sided = np.zeros(len(alone))
        one_sided[has_wall] = fell.mean(axis=2).max(axis=0)  # the larger of its directions
        # Whether the chance is above that without a wall in the same draws
        free, chance = (alike.average(one)[has_wall] for one in (alone[:, : fell.shape[2]].mean(axis=1), one_sided))
        return [
            (self.sliders, {"slip_median_cm": median, "slip_84_cm": high}),
            (self.walled, {"one_sided": chance, "wall_higher": chance > free}),
        ]
