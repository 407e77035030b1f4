"""The models of study `fit`, fitted to the chances by direct integration of study `table2`, with their errors."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from assess.risk import LIMITS
from assess.studies.agreement import Compared, pool
from assess.studies.buildings import LEVELS
from assess.studies.fit.probit import Check, Counts, find_left_out, fit_probit, fit_without
from assess.studies.fit.surfaces import (
    CANDIDATES,
    CONSTANT,
    EQUATION_8,
    Candidate,
    LeftOut,
    Points,
    Ranked,
    rank_surfaces,
)
from assess.studies.studied_methods import FORMULAS, FloatArray, Probit
from assess.studies.study import Options
from assess.units import ACCELERATION, GRAVITY, ROUNDING


@dataclass(frozen=True, slots=True)
class Alternative:
    """A probit, the probits fitted without each building in turn, and their errors for that building."""

    probit: Probit
    without: tuple[Probit, ...]
    left_out: LeftOut


@dataclass(frozen=True, eq=False)
class Fits:
    """The data, the surfaces ranked, and the probits.

    Parameters
    ----------
    points, counts : Points, Counts
        The n cases: every block at every common PFA under every channel.
    ranked : tuple of Ranked
        The surfaces in order.
    probit, probit_without_pfv : Alternative
        With PFV in it, and without.
    published : mapping of str to LeftOut
        Errors of the formulas as published, by title.
    """

    points: Points
    counts: Counts
    ranked: tuple[Ranked, ...]
    probit: Alternative
    probit_without_pfv: Alternative
    published: Mapping[str, LeftOut]

    def find(self, candidate: Candidate) -> Ranked:
        """Return a surface by its candidate."""
        return next(one for one in self.ranked if one.surface.candidate == candidate)

    @cached_property
    def best(self) -> Ranked:
        """The surface of the smallest error, however many coefficients it has."""
        return min(self.ranked, key=lambda one: one.surface.left_out.error)

    @cached_property
    def equation_8(self) -> Ranked:
        """The paper's choice, fitted again."""
        return self.find(EQUATION_8)

    @cached_property
    def constant(self) -> Ranked:
        """The trivial model."""
        return self.find(CONSTANT)

    @property
    def buildings(self) -> list[str]:
        """Names of the groups, in the order of the errors of those left out."""
        return [str(one) for one in np.unique(self.points.group)]

    @property
    def medium_at_rest(self) -> float:
        """Share of the cases with PFA below g B/H that the probit puts into class medium or higher [-]."""
        start = GRAVITY * self.counts.breadth / self.counts.height
        chances = self.probit.probit.evaluate(self.counts.cases)[self.counts.pfa < start * (1 - ROUNDING)]
        return float(np.mean(chances >= LIMITS[0]))


def fit_all(compared: Sequence[Compared], options: Options) -> Fits:
    """Fit everything to the trials of all channels."""
    surfaces, probits = options.narrow(0.0, 0.5), options.narrow(0.5, 1.0)
    check = partial(probits.report_share, 0.0)
    counts, group = gather(compared)
    points = Points(counts.breadth / counts.height, counts.pfa / ACCELERATION["cm/s2"], counts.risk, group)
    return Fits(
        points=points,
        counts=counts,
        ranked=rank_surfaces(points, (one for one, _ in surfaces.each(CANDIDATES))),
        probit=fit_alternative(counts, group, with_pfv=True, check=check),
        probit_without_pfv=fit_alternative(counts, group, with_pfv=False, check=check),
        published={title: find_errors(pool(compared, key)[0], points) for key, title in FORMULAS.items()},
    )


def fit_alternative(counts: Counts, group: NDArray[np.str_], *, with_pfv: bool, check: Check) -> Alternative:
    """Fit a probit to all, and to all but each building."""
    without = fit_without(counts, group, with_pfv=with_pfv, check=check)
    return Alternative(
        fit_probit(counts, with_pfv=with_pfv, check=check), without, find_left_out(counts, group, without)
    )


def find_errors(values: FloatArray, points: Points) -> LeftOut:
    """Return the errors, building by building, of values (n,) that were not fitted to any of them."""
    off = (values - points.z) ** 2
    return LeftOut(tuple(float(off[points.group == one].mean()) for one in np.unique(points.group)))


def gather(compared: Sequence[Compared]) -> tuple[Counts, NDArray[np.str_]]:
    """Return the cases of all channels at the common values of PFA, and the building of each."""
    sizes = [len(LEVELS) * one.trials.breadth.size for one in compared]
    cases = [one.trials.cases for one in compared]

    def join(name: str) -> FloatArray:
        return np.concatenate([getattr(one, name)[:size] for one, size in zip(cases, sizes, strict=True)])

    breadth, height, pfa, pfv = map(join, ("breadth", "height", "pfa", "pfv"))
    counts = Counts(
        breadth, height, pfa, pfv,
        fallen=np.concatenate([one.trials.fallen.ravel()[:size] for one, size in zip(compared, sizes, strict=True)]),
        runs=np.repeat([one.trials.runs for one in compared], sizes),
    )  # fmt: skip
    return counts, np.repeat([one.building.name for one in compared], sizes)
