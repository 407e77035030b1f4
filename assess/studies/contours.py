"""Study `contours`: risk over breadth and PFA by Kaneko-Hayashi, by direct integration and by OR, building by building.

The paper's Figs. 6 to 8 (section 3.2.3): the channel of the highest risk of each building, its record scaled.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from assess.methods import Cases, proposed_or
from assess.methods._method import FloatArray
from assess.report.figures.draw import draw
from assess.report.figures.risk_map import paint_checked, paint_legend, paint_risk
from assess.settings import Settings
from assess.studies._formulas import FORMULAS, INTEGRATION, PRINTED, evaluate_formulas
from assess.studies._judged import RECORDED, Judged, by_building, rock_all
from assess.studies._study import Finding, Options, Row, Study, Table, table_lines
from assess.studies._trials import LEVELS
from assess.units import GRAVITY, LENGTH

HEIGHT = 1.8
"""Of the pieces that are drawn [m]; the paper does not print that of its own."""
FINE = 121
"""Points along each side at which formulas are drawn."""
DIRECT = "integration"
PANELS = {
    "kaneko_hayashi": FORMULAS["kaneko_hayashi"],
    DIRECT: INTEGRATION,
    PRINTED: FORMULAS[PRINTED],
    "proposed_or": FORMULAS["proposed_or"],
}


@dataclass(frozen=True, slots=True, eq=False)
class Contours:
    """The risks of the pieces of one height under one channel: at each PFA (a,) [m/s2] and breadth (b,) [m], (a, b)."""

    judged: Judged
    breadth: FloatArray
    pfa: FloatArray
    risk: dict[str, FloatArray]

    def find_falls(self, panel: str) -> FloatArray:
        """Return by how much the risk of a piece falls from one PFA to the next, stronger one, where it does [-]."""
        steps = -np.diff(self.risk[panel], axis=0)
        return np.asarray(steps[steps > 1e-9])

    def find_rises(self, panel: str) -> FloatArray:
        """Return by how much the risk of a piece exceeds that of the next thinner one, where it does [-]."""
        steps = np.diff(self.risk[panel], axis=1)
        return np.asarray(steps[steps > 1e-9])

    def refine(self, panel: str) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return breadths [m], PFA [m/s2] and risks to draw: of a formula also between, where it may jump."""
        if panel == DIRECT:
            return self.breadth, self.pfa, self.risk[panel]
        breadth, pfa = (np.linspace(ends[0], ends[-1], FINE) for ends in (self.breadth, self.pfa))
        breadths, pfas = (values.ravel() for values in np.meshgrid(breadth, pfa))
        cases = Cases.of(breadth=breadths, height=HEIGHT, pfa=pfas, pfv=self.judged.ratio * pfas)
        return breadth, pfa, evaluate_formulas(cases, Settings())[panel].reshape(FINE, FINE)


def choose_contours(judged: Sequence[Judged]) -> list[Contours]:
    """Return those of the channel of each building of the highest risk as recorded; of the largest PFA among equals."""
    return [build_contours(max(own, key=_rank)) for own in by_building(judged).values()]


def _rank(one: Judged) -> tuple[float, float]:
    return float(one.trials.risk[RECORDED].mean()), float(one.trials.pfa[RECORDED])


def build_contours(one: Judged) -> Contours:
    """Return the contours of one channel."""
    trials, n = one.trials, len(LEVELS)
    own = np.flatnonzero(trials.height == HEIGHT)
    values = {**one.formulas, DIRECT: trials.risk}
    return Contours(one, trials.breadth[own], trials.pfa[:n], {key: values[key][:n, own] for key in PANELS})


def run(options: Options) -> Finding:
    """Draw the contours, and tell where they are irregular."""
    every = choose_contours(rock_all(options))
    columns = ("building", "channel", "pfa_g", "breadth_cm", "height_cm", *PANELS)
    return Finding(
        page=list(_describe(every)),
        summary=[_summarise(every)],
        failures=list(_say_failures(every)),
        tables={"contours": Table(columns=columns, rows=[row for one in every for row in _rows(one)])},
        figures={f"contours-{_slug(one)}.svg": draw(7, 2.3, partial(_paint, one)) for one in every},
    )


def _slug(one: Contours) -> str:
    return one.judged.building.place.lower().replace(" ", "-")


def _rows(one: Contours) -> Iterator[Row]:
    channel = one.judged.trials.channel
    for at, pfa in enumerate(one.pfa):
        for block, breadth in enumerate(one.breadth):
            values = [float(one.risk[key][at, block]) for key in PANELS]
            yield (channel.building, channel.name, float(pfa / GRAVITY), 100 * float(breadth), 100 * HEIGHT, *values)


# ---------------------------------------------------------------- the page


def _describe(every: Sequence[Contours]) -> Iterator[str]:
    channels = [one.judged.trials.channel for one in every]
    told = "; ".join(f"{one.building}, {one.level}, {one.name}" for one in channels)
    yield (
        f"Pieces {100 * HEIGHT:.0f} cm high, of which breadth and PFA change. Of each building the channel of the "
        f"highest risk as recorded, or of the largest PFA where nothing falls as recorded: {told}. Its record is "
        f"scaled from {LEVELS[0]:g} to {LEVELS[-1]:g} g; colours and axes are the same for all. A surface is irregular "
        "where a stronger motion has a lower risk, or a broader piece a higher one (all three together, largest "
        "step in percentage points):"
    )
    yield ""
    rows = [
        (name, *_count([one.find_falls(key) for one in every]), *_count([one.find_rises(key) for one in every]))
        for key, name in PANELS.items()
    ]
    heads = "less at more PFA", "largest", "more when broader", "largest"
    yield from table_lines(("", *heads), rows)


def _count(steps: Sequence[FloatArray]) -> tuple[int, str]:
    every = np.concatenate(steps)
    return every.size, f"{100 * every.max(initial=0):.0f}"


def _count_steps(every: Sequence[Contours]) -> int:
    return sum((len(one.pfa) - 1) * len(one.breadth) for one in every)


def _summarise(every: Sequence[Contours]) -> str:
    falls, by = _count([one.find_falls(DIRECT) for one in every])
    rises, over = _count([one.find_rises(DIRECT) for one in every])
    kaneko = _count([one.find_falls("kaneko_hayashi") for one in every])[0]
    return (
        "The paper finds Kaneko-Hayashi irregular in all buildings, through the switch of its equation, and "
        f"integration regular. Of {_count_steps(every)} steps to a stronger motion (the worst channel of each "
        f"building) the chance falls in {kaneko} by Kaneko-Hayashi, and in {falls} by integration, by at most {by} "
        f"points: rocking itself is not monotone. With breadth integration rises in {rises}, by at most {over}."
    )


def _say_failures(every: Sequence[Contours]) -> Iterator[str]:
    jumps = {one.judged.building.name: one.find_rises("kaneko_hayashi") for one in every}
    told = ", ".join(f"{steps.size} in {name}" for name, steps in jumps.items())
    largest = _count(list(jumps.values()))[1]
    yield (
        "**Kaneko-Hayashi calls a broader piece more dangerous** where its equation switches between PFA and PFV: "
        f"steps of breadth with a higher chance are {told}, of up to {largest} points."
    )
    one = every[:1]  # it knows neither record nor building: all are alike
    falls, by = _count([own.find_falls(PRINTED) for own in one])
    rises, over = _count([own.find_rises(PRINTED) for own in one])
    used = _count([step("proposed_or") for own in one for step in (own.find_falls, own.find_rises)])[0]
    yield (
        f"**Equation (9) as printed calls a stronger motion safer** in {falls} of {_count_steps(one)} steps of PFA "
        f"(the same in every building), by up to {by} points, and a thinner piece safer in {rises} steps of breadth, "
        f"by up to {over}. OR as `assess` uses it is held at its peaks and does so in {used}; every report keeps the "
        "printed value beside it."
    )


# ---------------------------------------------------------------- the figures


def _paint(one: Contours, figure: Any) -> None:
    panels = figure.subplots(1, len(PANELS), sharex=True, sharey=True)
    for axes, (key, name) in zip(panels, PANELS.items(), strict=True):
        breadth, pfa, risk = one.refine(key)
        paint_risk(axes, breadth / LENGTH["cm"], pfa / GRAVITY, risk)
        if key == proposed_or.METHOD.key:
            paint_checked(axes, proposed_or.METHOD, HEIGHT)
        axes.set_title(name, fontsize=7, loc="left")
        axes.set_xlabel("breadth [cm]", fontsize=7)
        axes.tick_params(labelsize=6)
    panels[0].set_ylabel("PFA [g]", fontsize=7)
    figure.suptitle(str(one.judged.trials.channel), fontsize=8)
    paint_legend(figure)


STUDY = Study(
    name="contours",
    order=40,
    title="Risk over breadth and PFA",
    of="Figs. 6 to 8, section 3.2.3",
    run=run,
)
