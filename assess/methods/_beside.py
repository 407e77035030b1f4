"""What stands beside a simulated chance and never lowers it: how a piece slides, and how it falls away from a wall.

Slip is that of Newmark's block, which slides and does not rock: it depends on the friction and the motion alone, so
that pieces of one friction on one floor share it. In a draw in which a piece does not slide by Shenton's limits, for
the peak of that draw's motion and the piece as it is given, its slip is 0. One-sided falls are those of the piece with
a wall at its back, under the same draws as its chance without one.

References: `assess.rocking.sliding` (Shenton 1996, Newmark 1965), `assess.rocking.planar` (Sorrentino et al. 2011).
"""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from assess.methods._method import NO_WALL, SIDE_UNKNOWN, BoolArray, Cases, FloatArray
from assess.methods._simulate import draw_body
from assess.progress import SILENT, Progress
from assess.rocking.draws import CUT, Uncertainty
from assess.rocking.sliding import UNKNOWN, Branch, branch, is_outside_shenton, peak_slip
from assess.settings import Settings
from assess.units import LENGTH

HIGH = 0.84
"""Share of the draws whose slip is at most the one shown beside the median: about one standard deviation above [-]."""
SLIDING = (Branch.SLIDE, Branch.SLIDE_AND_ROCK)
WORDS = np.array([one.word for one in Branch] + [""])
"""Of `Branch`, and last of `UNKNOWN`."""


def find_branch(cases: Cases) -> NDArray[np.int64]:
    """Return how each case starts to move at the floor's PFA, (n,): `Branch`, or `UNKNOWN` without a friction."""
    return branch(cases.breadth, cases.height, cases.friction, cases.pfa, centre=cases.centre)


def name_branch(found: NDArray[np.int64]) -> NDArray[np.str_]:
    """Return branches in words, "" where unknown."""
    return np.asarray(WORDS[found])


def find_sliding(cases: Cases) -> BoolArray:
    """Return where a piece slides, or slides and rocks, at the floor's PFA."""
    return np.isin(find_branch(cases), SLIDING)


def find_extended(cases: Cases) -> BoolArray:
    """Return where a known branch goes beyond Shenton's centre of gravity at half height."""
    return np.asarray((find_branch(cases) != UNKNOWN) & is_outside_shenton(cases.centre))


def may_slide(cases: Cases, settings: Settings) -> BoolArray:
    """Return where a piece slides under the strongest motion that may be drawn, whose peak may be above the PFA."""
    strongest = cases.pfa * (1.0 if settings.ideal else np.exp(CUT * cases.dispersion)) / cases.still
    found = branch(cases.breadth, cases.height, cases.friction, strongest, centre=cases.centre)
    return np.isin(found, SLIDING)


@dataclass(frozen=True, slots=True, eq=False)
class BesideFound:
    """What was found of the `sliders` (p,) and the `walled` (q,): median and 84 % slip [cm], one-sided chance [-].

    In `draws` draws; `is_ideal`: without uncertainty of the motion and of the piece.
    """

    sliders: NDArray[np.intp]
    walled: NDArray[np.intp]
    slip_median_cm: FloatArray
    slip_high_cm: FloatArray
    one_sided: FloatArray
    draws: int
    is_ideal: bool


@dataclass(slots=True)
class Beside:
    """Finds it for cases of one ensemble, batch by batch of its motions.

    Parameters
    ----------
    cases : Cases
        All of them.
    settings : Settings
        Seed, and whether nothing is drawn.
    sliders, walled : (p,) and (q,) integer arrays
        The cases whose slip, and whose falls beside a wall, are wanted.
    """

    cases: Cases
    settings: Settings
    sliders: NDArray[np.intp]
    walled: NDArray[np.intp]
    drawn: Cases = field(init=False)
    """The cases with what is uncertain of them in this run."""
    _slips: list[FloatArray] = field(default_factory=list)
    _fell: list[BoolArray] = field(default_factory=list)

    def __post_init__(self) -> None:
        certain, none = Uncertainty(motion=0.0, piece=False), np.zeros_like(self.cases.dispersion)
        as_given = replace(self.cases, uncertainty=certain, dispersion=none)
        self.drawn = as_given if self.settings.ideal else self.cases

    @property
    def is_wanted(self) -> bool:
        """Whether there is anything to find."""
        return bool(self.sliders.size or self.walled.size)

    def add(
        self, motions: NDArray[np.floating], time_step: float, first: int, threads: int, progress: Progress = SILENT
    ) -> None:
        """Take in motions `first` to `first + k - 1`, (k, n) [m/s2]."""
        if not self.is_wanted:
            return
        numbers = self.drawn.earthquakes.draw(self.settings.seed, first, len(motions))
        floor = np.concatenate([self.sliders, self.walled])[0]  # all are on one
        scale = np.exp(self.drawn.dispersion[floor] * numbers)
        every = motions.astype(np.float64)
        if self.sliders.size:
            self._slips.append(self._slide(every, time_step, scale, threads, progress))
        if self.walled.size:
            self._fell.append(self._rock(every, time_step, scale, first, threads, progress))

    def finish(self) -> BesideFound:
        """Return what all motions together give."""
        slips = np.concatenate(self._slips, axis=1) if self._slips else np.zeros((0, 1))
        fell = np.concatenate(self._fell, axis=2) if self._fell else np.zeros((2, 0, 1))
        middle, high = np.quantile(slips / LENGTH["cm"], (0.5, HIGH), axis=1)
        one_sided, draws = fell.mean(axis=2).max(axis=0), fell.shape[2]
        return BesideFound(self.sliders, self.walled, middle, high, one_sided, draws, self.settings.ideal)

    def _slide(
        self, motions: FloatArray, time_step: float, scale: FloatArray, threads: int, progress: Progress
    ) -> FloatArray:
        """Return the slip of each slider under each motion, (p, k) [m]."""
        cases, own = self.cases, self.sliders
        frictions, which = np.unique(cases.friction[own], return_inverse=True)
        slips = peak_slip(frictions, motions, time_step, scale=scale, threads=threads, progress=progress)
        B, H, mu, centre = (one[own, None] for one in (cases.breadth, cases.height, cases.friction, cases.centre))
        peaks = np.abs(motions).max(axis=1) * scale
        starts = branch(B, H, mu, peaks, centre=centre)
        return np.where(np.isin(starts, SLIDING), slips[which], 0.0)

    def _rock(
        self, motions: FloatArray, time_step: float, scale: FloatArray, first: int, threads: int,
        progress: Progress,
    ) -> BoolArray:  # fmt: skip
        """Return whether each walled piece falls in each draw, (2, q, k): turning in either direction, if it can."""
        from assess.rocking.planar import Away, Body, rock_bodies

        fell = np.zeros((2, self.walled.size, len(motions)), dtype=np.bool_)
        ways: tuple[Away, Away] = (1, -1)
        for at, away in enumerate(ways):
            here = np.isin(self.cases.wall[self.walled], (away, SIDE_UNKNOWN))
            if here.any():
                drawn = draw_body(self.drawn, self.walled[here], self.settings.seed, first, len(motions))
                body = Body.rectangular(drawn.breadth, drawn.height, centre=drawn.centre, restitution=drawn.restitution)
                fell[at, here] = rock_bodies(
                    body, motions, time_step, away=away, scale=scale, threads=threads,
                    progress=progress,
                ).overturned  # fmt: skip
        return fell


def find_walled(cases: Cases) -> BoolArray:
    """Return which cases have a wall at their back."""
    return np.asarray(cases.wall != NO_WALL)
