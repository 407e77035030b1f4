"""Study `calibration`: whether chances of generated motions are right, by what the floor motions themselves overturn.

No part of the paper. A chance of 30 % should come true in 30 of 100 cases: here it is held against the one outcome that
is known of each floor motion, its own.

Chances agree with what happened where the mean chance less the share that fell is within its error. Cases of one floor
motion are not independent of each other: twelve blocks at eight amplitudes fall or stand together. So the error is that
of the delete-one-group jackknife: the mean is found again without each group of cases in turn, and the scatter of these
means gives the error. A group is a floor motion; or, as the floors of a building in one earthquake are not independent
either, all that comes from one site and axis.

Reference: Efron B (1982). The jackknife, the bootstrap and other resampling plans. Society for Industrial and Applied
Mathematics. doi:10.1137/1.9781611970319
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import astuple, dataclass, fields
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.report.figures.draw import draw
from assess.risk import LIMITS, RiskClass, classify_all
from assess.studies.calibration.floor_motions import (
    DAMPING,
    FREE_FIELD,
    HEIGHTS,
    HIGHEST,
    LEVELS,
    PERIODS,
    PLACES,
    RATIOS,
    Tried,
    build_blocks,
    list_beams,
    list_recorded,
    try_floors,
)
from assess.studies.studied_methods import BoolArray, FloatArray
from assess.studies.study import Finding, Options, Row, Study, Table, write_finding
from assess.units import LENGTH

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
        """Return some of the cases."""
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
    """Return the standard error of the mean of `values` (n,) by the jackknife over groups of them; NaN with one group.

    Groups (n,) are told apart by their integers.
    """
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
        cases=int(off.size),
        fallen=int(outcomes.fell.sum()),
        floors=int(np.unique(outcomes.floor).size),
        chance=float(outcomes.chance.mean()),
        share=float(outcomes.fell.mean()),
        difference=float(off.mean()),
        error=errors[0],
        error_by_source=errors[1],
    )


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
    """Floor motions of one kind: the trials, their cases, and the scores of all and of each class of chance."""

    tried: Sequence[Tried]
    outcomes: Outcomes
    whole: Score
    classes: Mapping[RiskClass, Score]

    @property
    def sources(self) -> int:
        """Number of sites and axes."""
        return int(np.unique(self.outcomes.source).size)

    @property
    def factors(self) -> list[float]:
        """Factors by which floor motions are scaled [-]."""
        return [float(one) for trial in self.tried for one in trial.factors]


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
    cases = [row for name, own in found.items() for one in own.tried for row in _case_rows(name, one)]
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
    return Calibrated(tried, outcomes, whole, by_class(outcomes))


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


def _case_rows(name: str, tried: Tried) -> list[Row]:
    floor, beam = tried.floor, tried.floor.beam
    place = ("", "") if beam is None else (beam.period, beam.place)
    sizes = [(float(b / LENGTH["cm"]), float(h / LENGTH["cm"])) for b, h in zip(*build_blocks(), strict=True)]
    return [
        (
            name, floor.site, floor.axis, floor.level, floor.name, *place, level, float(factor), *size,
            int(fallen), tried.runs, bool(fell),
        )
        for level, factor, row, own in zip(LEVELS, tried.factors, tried.fallen, tried.fell, strict=True)
        for size, fallen, fell in zip(sizes, row, own, strict=True)
    ]  # fmt: skip


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
