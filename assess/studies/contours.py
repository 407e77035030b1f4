"""Study `contours`: risk over breadth and PFA by Kaneko-Hayashi, by direct integration and by OR, building by building.

The paper's Figs. 6 to 8 (section 3.2.3): for each building, the channel of the highest risk, its record scaled.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from assess.arrays import FloatArray
from assess.report.figures.draw import draw
from assess.report.figures.risk_map import paint_checked, paint_legend, paint_risk
from assess.settings import Settings
from assess.studies.agreement import Compared, by_building, rock_all
from assess.studies.buildings import LEVELS, RECORDED
from assess.studies.studied_methods import FORMULAS, INTEGRATION, KANEKO, METHODS, OR, PRINTED, Cases, evaluate_formulas
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

    def find_falls(self, panel: str) -> FloatArray:
        """Return the decreases of the risk of a piece from one PFA to the next larger one [-]."""
        steps = -np.diff(self.risk[panel], axis=0)
        return np.asarray(steps[steps > 1e-9])

    def find_rises(self, panel: str) -> FloatArray:
        """Return the increases of the risk from one piece to the next broader one [-]."""
        steps = np.diff(self.risk[panel], axis=1)
        return np.asarray(steps[steps > 1e-9])

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

    def rank(one: Compared) -> tuple[float, float]:
        return float(one.trials.risk[RECORDED].mean()), float(one.trials.pfa[RECORDED])

    return [build_contours(max(own, key=rank)) for own in by_building(compared).values()]


def build_contours(one: Compared) -> Contours:
    """Return the contours of one channel."""
    trials, n = one.trials, len(LEVELS)
    own = np.flatnonzero(trials.height == HEIGHT)
    values = {**one.formulas, DIRECT: trials.risk}
    return Contours(one, trials.breadth[own], trials.pfa[:n], {key: values[key][:n, own] for key in PANELS})


def run(options: Options) -> Finding:
    """Draw the contours, and count where they are irregular."""
    every, last = choose_contours(rock_all(options.narrow(0.0, 0.9))), options.narrow(0.9, 1.0)
    columns = ("building", "channel", "pfa_g", "breadth_cm", "height_cm", *PANELS)
    values = {
        "every": every, "height": HEIGHT, "panels": PANELS, "levels": LEVELS, "count": count_irregular,
        "steps": [(len(one.pfa) - 1) * len(one.breadth) for one in every],
        "DIRECT": DIRECT, "KANEKO": KANEKO, "PRINTED": PRINTED, "OR": OR,
    }  # fmt: skip
    return write_finding(
        "contours",
        values,
        tables={"contours": Table(columns=columns, rows=[row for one in every for row in _rows(one)])},
        figures={f"contours-{_slug(one)}.svg": draw(7, 2.3, partial(_paint, one)) for one, _ in last.each(every)},
    )


def count_irregular(every: Sequence[Contours], panel: str) -> dict[str, float]:
    """Return the numbers of `falls` and `rises`, and the largest of each [-], `by` and `over`."""
    falls = np.concatenate([one.find_falls(panel) for one in every])
    rises = np.concatenate([one.find_rises(panel) for one in every])
    return {"falls": falls.size, "by": falls.max(initial=0), "rises": rises.size, "over": rises.max(initial=0)}


def _slug(one: Contours) -> str:
    return one.compared.building.place.lower().replace(" ", "-")


def _rows(one: Contours) -> Iterator[Row]:
    channel = one.compared.trials.channel
    for at, pfa in enumerate(one.pfa):
        for block, breadth in enumerate(one.breadth):
            values = [float(one.risk[key][at, block]) for key in PANELS]
            yield (channel.building, channel.name, float(pfa / GRAVITY), 100 * float(breadth), 100 * HEIGHT, *values)


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
