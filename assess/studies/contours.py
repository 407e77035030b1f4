"""Study `contours`: risk over breadth and PFA by Kaneko-Hayashi, by direct integration and by OR, building by building.

The paper's Figs. 6 to 8 (section 3.2.3): for each building, the channel of the highest risk, its record scaled.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from assess.arrays import FloatArray
from assess.methods import Cases
from assess.report.figures.draw import draw
from assess.report.figures.risk_map import paint_checked, paint_legend, paint_risk
from assess.settings import Settings
from assess.studies.agreement import (
    FORMULAS,
    INTEGRATION,
    KANEKO,
    METHODS,
    OR,
    PRINTED,
    Compared,
    by_building,
    evaluate_formulas,
    rock_all,
)  # fmt: skip
from assess.studies.buildings import LEVELS, RECORDED
from assess.studies.study import Finding, Options, Row, Study, Table, write_finding
from assess.units import GRAVITY, LENGTH

HEIGHT = 1.8
"""Of the pieces that are drawn [m]; the paper does not print that of its own."""
FINE = 121
"""Points along each side at which formulas are drawn."""
DIRECT = "integration"
PANELS = {KANEKO: FORMULAS[KANEKO], DIRECT: INTEGRATION, PRINTED: FORMULAS[PRINTED], OR: FORMULAS[OR]}


@dataclass(frozen=True, slots=True, eq=False)
class Contours:
    """The risks of the pieces of one height under one channel: at each PFA (a,) [m/s2] and breadth (b,) [m], (a, b)."""

    compared: Compared
    breadth: FloatArray
    pfa: FloatArray
    risk: dict[str, FloatArray]

    def find_irregular(self, panel: str) -> tuple[FloatArray, FloatArray]:
        """Return the falls of the risk with PFA, and its rises from one piece to the next broader one [-]."""
        falls, rises = -np.diff(self.risk[panel], axis=0), np.diff(self.risk[panel], axis=1)
        return np.asarray(falls[falls > 1e-9]), np.asarray(rises[rises > 1e-9])

    def refine(self, panel: str) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return breadths [m], PFA [m/s2] and risks to draw: for a formula, which may jump, on a finer grid."""
        if panel == DIRECT:
            return self.breadth, self.pfa, self.risk[panel]
        breadth, pfa = (np.linspace(ends[0], ends[-1], FINE) for ends in (self.breadth, self.pfa))
        breadths, pfas = (values.ravel() for values in np.meshgrid(breadth, pfa))
        cases = Cases.of(breadth=breadths, height=HEIGHT, pfa=pfas, pfv=self.compared.ratio * pfas)
        return breadth, pfa, evaluate_formulas(cases, Settings())[panel].reshape(FINE, FINE)


def choose_contours(compared: Sequence[Compared]) -> list[Contours]:
    """Return for each building those of the channel of the highest risk as recorded; of equals, of the largest PFA."""
    found, n = [], len(LEVELS)
    for channels in by_building(compared).values():
        one = max(channels, key=lambda one: (float(one.trials.risk[RECORDED].mean()), float(one.trials.pfa[RECORDED])))
        own, values = np.flatnonzero(one.trials.height == HEIGHT), {**one.formulas, DIRECT: one.trials.risk}
        risk = {key: values[key][:n, own] for key in PANELS}
        found.append(Contours(one, one.trials.breadth[own], one.trials.pfa[:n], risk))
    return found


def run(options: Options) -> Finding:
    """Draw the contours, and count where they are irregular."""
    every, last = choose_contours(rock_all(options.narrow(0.0, 0.9))), options.narrow(0.9, 1.0)
    columns, rows = ("building", "channel", "pfa_g", "breadth_cm", "height_cm", *PANELS), list[Row]()
    for one in every:
        channel = one.compared.trials.channel
        for at, pfa in enumerate(one.pfa):
            for block, breadth in enumerate(one.breadth):
                risks = [float(one.risk[key][at, block]) for key in PANELS]
                sizes = 100 * float(breadth), 100 * HEIGHT
                rows.append((channel.building, channel.name, float(pfa / GRAVITY), *sizes, *risks))
    places = [one.compared.building.place.lower().replace(" ", "-") for one in every]
    values = {
        "every": every, "height": HEIGHT, "panels": PANELS, "levels": LEVELS, "count": count_irregular,
        "steps": [(len(one.pfa) - 1) * len(one.breadth) for one in every],
        "DIRECT": DIRECT, "KANEKO": KANEKO, "PRINTED": PRINTED, "OR": OR,
    }  # fmt: skip
    return write_finding(
        "contours",
        values,
        tables={"contours": Table(columns=columns, rows=rows)},
        figures={
            f"contours-{place}.svg": draw(7, 2.3, partial(_paint, one))
            for place, (one, _) in zip(places, last.each(every), strict=True)
        },
    )


def count_irregular(every: Sequence[Contours], panel: str) -> dict[str, float]:
    """Return the numbers of `falls` and `rises`, and the largest of each [-], `by` and `over`."""
    falls, rises = map(np.concatenate, zip(*(one.find_irregular(panel) for one in every), strict=True))
    return {"falls": falls.size, "by": falls.max(initial=0), "rises": rises.size, "over": rises.max(initial=0)}


def _paint(one: Contours, figure: Any) -> None:
    panels = figure.subplots(1, len(PANELS), sharex=True, sharey=True)
    for axes, (key, name) in zip(panels, PANELS.items(), strict=True):
        breadth, pfa, risk = one.refine(key)
        paint_risk(axes, breadth / LENGTH["cm"], pfa / GRAVITY, risk)
        if key == OR:
            paint_checked(axes, METHODS[OR], HEIGHT / LENGTH["cm"])
        axes.set_title(name, fontsize=7, loc="left")
        axes.set_xlabel("breadth [cm]", fontsize=7)
        axes.tick_params(labelsize=6)
    panels[0].set_ylabel("PFA [g]", fontsize=7)
    figure.suptitle(str(one.compared.trials.channel), fontsize=8)
    paint_legend(figure)


STUDY = Study(name="contours", order=40, title="Risk over breadth and PFA", of="Figs. 6 to 8, section 3.2.3", run=run)
