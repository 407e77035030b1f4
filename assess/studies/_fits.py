"""What study `fit` fits to the chances by direct integration of study `table2`, and the errors of all of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from assess.methods._fitted_model import Probit
from assess.methods._method import FloatArray
from assess.risk import LIMITS
from assess.studies._formulas import FORMULAS
from assess.studies._judged import Judged, pool
from assess.studies._probit import Counts, find_left_out, fit_probit, fit_without
from assess.studies._surfaces import CONSTANT, EQUATION_8, Candidate, LeftOut, Points, Ranked, rank_surfaces
from assess.studies._trials import LEVELS
from assess.units import ACCELERATION, GRAVITY, ROUNDING


@dataclass(frozen=True, slots=True)
class Alternative:
    """A probit, what it becomes without each building in turn, and its errors for that."""

    probit: Probit
    without: tuple[Probit, ...]
    left_out: LeftOut


@dataclass(frozen=True, eq=False)
class Fits:
    """What was fitted: the data, the surfaces ranked, and the probits.

    Parameters
    ----------
    points, counts : Points, Counts
        The n cases: every block at every common PFA under every channel.
    ranked : tuple of Ranked
        The surfaces, the first first.
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

    @property
    def best(self) -> Ranked:
        """The surface of the smallest error, whatever its coefficients."""
        return min(self.ranked, key=lambda one: one.surface.left_out.error)

    @cached_property
    def equation_8(self) -> Ranked:
        """The paper's choice, fitted again."""
        return self.find(EQUATION_8)

    @cached_property
    def constant(self) -> Ranked:
        """What knows nothing."""
        return self.find(CONSTANT)

    @property
    def buildings(self) -> list[str]:
        """Names of the groups, in the order of the errors of what is left out."""
        return [str(one) for one in np.unique(self.points.group)]

    @property
    def said_at_rest(self) -> float:
        """Share of the cases with PFA below g B/H that the probit puts into class medium or higher [-]."""
        start = GRAVITY * self.counts.breadth / self.counts.height
        said = self.probit.probit.evaluate(self.counts.cases)[self.counts.pfa < start * (1 - ROUNDING)]
        return float(np.mean(said >= LIMITS[0]))


def fit_all(judged: Sequence[Judged]) -> Fits:
    """Fit everything to the trials of all channels."""
    counts, group = gather(judged)
    points = Points(counts.breadth / counts.height, counts.pfa / ACCELERATION["cm/s2"], counts.risk, group)
    return Fits(
        points=points,
        counts=counts,
        ranked=rank_surfaces(points),
        probit=fit_alternative(counts, group, with_pfv=True),
        probit_without_pfv=fit_alternative(counts, group, with_pfv=False),
        published={title: find_errors(pool(judged, key)[0], points) for key, title in FORMULAS.items()},
    )


def fit_alternative(counts: Counts, group: NDArray[np.str_], *, with_pfv: bool) -> Alternative:
    """Fit a probit to all, and to all but each building."""
    without = fit_without(counts, group, with_pfv=with_pfv)
    return Alternative(fit_probit(counts, with_pfv=with_pfv), without, find_left_out(counts, group, without))


def find_errors(values: FloatArray, points: Points) -> LeftOut:
    """Return the errors, building by building, of what was not fitted to any of them (n,)."""
    off = (values - points.z) ** 2
    return LeftOut(tuple(float(off[points.group == one].mean()) for one in np.unique(points.group)))


def gather(judged: Sequence[Judged]) -> tuple[Counts, NDArray[np.str_]]:
    """Return the cases of all channels at the common values of PFA, and the building of each."""
    sizes = [len(LEVELS) * one.trials.breadth.size for one in judged]
    cases = [one.trials.cases for one in judged]

    def join(name: str) -> FloatArray:
        return np.concatenate([getattr(one, name)[:size] for one, size in zip(cases, sizes, strict=True)])

    counts = Counts(
        breadth=join("breadth"), height=join("height"), pfa=join("pfa"), pfv=join("pfv"),
        fallen=np.concatenate([one.trials.fallen.ravel()[:size] for one, size in zip(judged, sizes, strict=True)]),
        runs=np.repeat([one.trials.runs for one in judged], sizes),
    )  # fmt: skip
    return counts, np.repeat([one.building.name for one in judged], sizes)
