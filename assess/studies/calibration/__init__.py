"""Study `calibration`: whether chances of generated motions are right, by what the floor motions themselves overturn.

No part of the paper. A chance of 30 % should come true in 30 of 100 cases: here it is held against the one outcome that
is known of each floor motion, its own.
"""

from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass, fields
from functools import partial
from typing import Any

import numpy as np

from assess.report.figures.draw import draw
from assess.risk import LIMITS, RiskClass
from assess.studies.calibration.floor_motions import (
    FREE_FIELD,
    HEIGHTS,
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
from assess.studies.calibration.scoring import Outcomes, Score, by_chance, by_class, find_score
from assess.studies.calibration.shear_beam import DAMPING, HIGHEST
from assess.studies.study import Finding, Options, Row, Study, Table
from assess.studies.study_pages import write_finding
from assess.units import LENGTH

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
    return write_finding(
        "calibration",
        collect(found, options),
        tables=_build_tables(found),
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


def _build_tables(found: Mapping[str, Calibrated]) -> dict[str, Table]:
    scores: list[Row] = []
    for name, own in found.items():
        scores += [(name, risk.word, *astuple(score)) for risk, score in own.classes.items()]
        scores.append((name, ALL, *astuple(own.whole)))
    cases = [row for name, own in found.items() for one in own.tried for row in _case_rows(name, one)]
    return {
        "calibration": Table(columns=SCORES, rows=scores),
        "calibration-cases": Table(columns=COLUMNS, rows=cases),
    }


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
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(fontsize=6, frameon=False, loc="lower right")


STUDY = Study(name="calibration", order=35, title="Chances against what records overturn", of="", run=run)
