"""How an ensemble of motions meets its target, in figures that a report can print, and its spectra."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.arrays import FloatArray
from assess.motion.rows import run_groups
from assess.motion.target import JUDGED_FROM, Target, matched_to
from assess.progress import SILENT, Progress


@dataclass(frozen=True, slots=True, kw_only=True)
class Fit:
    """How the mean of an ensemble meets its target, and how its realisations scatter.

    * `matched_to`: longest period at which the spectrum is judged [s]; the shortest is 0.05 s.
    * `mean_deviation`, `worst_deviation`: of the mean spectrum from the target's [-]: the mean size, and the largest,
      signed.
    * `worst_period`: where the largest is [s].
    * `pfa_ratio`, `pfv_ratio`: mean peaks over the target's [-].
    * `pfa_scatter`, `pfv_scatter`, `spectrum_scatter`: coefficients of variation [-]: of the peaks, and of the
      spectrum, averaged over its periods.
    * `drift`: largest final velocity over PFV [-].
    """

    count: int
    matched_to: float
    mean_deviation: float
    worst_deviation: float
    worst_period: float
    pfa_ratio: float
    pfa_scatter: float
    pfv_ratio: float
    pfv_scatter: float
    spectrum_scatter: float
    drift: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Spectra:
    """Response spectra of the first motions of an ensemble.

    * `periods` (p,): [s]
    * `ordinates` (k, p): 5 % pseudo-acceleration of each motion [m/s2].
    * `target` (p,): what their mean is to meet [m/s2]; None for motions that were given.
    """

    periods: FloatArray
    ordinates: NDArray[np.float32]
    target: FloatArray | None = None

    def first(self, count: int) -> "Spectra":
        """Return those of the first `count` motions, or of all where there are fewer."""
        return replace(self, ordinates=self.ordinates[:count])


def measure_peaks(acceleration: NDArray[Any], time_step: float) -> FloatArray:
    """Return PFA [m/s2] and PFV [m/s] of motions (k, n) [m/s2] that start at rest, (k, 2)."""
    from assess.motion.recipe import measure_rows

    peaks = np.empty((len(acceleration), 3))
    measure_rows(np.asarray(acceleration, np.float32), time_step, peaks)
    return peaks[:, :2]


def measure_match(
    target: Target, acceleration: NDArray[Any], time_step: float, threads: int = 1, progress: Progress = SILENT
) -> tuple[Fit, Spectra]:
    """Return how motions (k, n) [m/s2] meet their target, and the spectra by which this was measured.

    The periods lie half-way between those that were matched, from 0.05 s to where the match is judged. Motions and
    spectra are in single precision.
    """
    from assess.motion.recipe import measure_rows
    from assess.motion.sweep import Sweep

    wanted_to = matched_to(target.periods, target.pseudo)
    periods = np.sqrt(target.periods[1:] * target.periods[:-1])
    periods = periods[(periods >= JUDGED_FROM) & (periods <= wanted_to)]
    motions, sweep = np.asarray(acceleration, np.float32), Sweep.of(periods, time_step, acceleration.shape[1])
    pseudo, peaks = np.empty((len(motions), periods.size), np.float32), np.empty((len(motions), 3))

    def measure(rows: slice) -> None:
        pseudo[rows] = sweep.spectra(motions[rows])
        measure_rows(motions[rows], time_step, peaks[rows])

    run_groups(measure, len(motions), threads, progress)
    wanted = target.ordinates(periods, time_step)
    mean = pseudo.mean(axis=0, dtype=np.float64)
    deviation = mean / wanted - 1
    worst, (pfa, pfv, end) = int(np.abs(deviation).argmax()), peaks.T
    fit = Fit(
        count=len(pseudo), matched_to=wanted_to, mean_deviation=float(np.abs(deviation).mean()),
        worst_deviation=float(deviation[worst]), worst_period=float(periods[worst]),
        pfa_ratio=float(pfa.mean() / target.pfa), pfa_scatter=float(pfa.std() / pfa.mean()),
        pfv_ratio=float(pfv.mean() / target.pfv), pfv_scatter=float(pfv.std() / pfv.mean()),
        spectrum_scatter=float((pseudo.std(axis=0, dtype=np.float64) / mean).mean()),
        drift=float((np.abs(end) / pfv).max()),
    )  # fmt: skip
    return fit, Spectra(periods=periods, ordinates=pseudo, target=wanted)
