"""The figure of `assess routes`: the chance that each route is blocked over the PFA on its floors."""

import math
import textwrap
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from assess.report import words
from assess.report.figures.draw import label
from assess.risk import LIMITS, RiskClass
from assess.routes.fragility import Fragility, RouteFragility
from assess.units import GRAVITY

A_PANEL, MOST_PANELS = 8, 6
LINES = (
    ("#1b4f72", "-", "o"), ("#b03a2e", "--", "s"), ("#196f3d", "-.", "^"), ("#6c3483", ":", "D"),
    ("#9a6a00", "-", "v"), ("#117a8b", "--", "x"), ("#444444", "-.", "+"), ("#c2410c", ":", "*"),
)  # fmt: skip
"""Colour, line and marker of the routes of a panel, told apart without colour by the last two."""
MOST_MARKS = 10
MOST_NAMED = 12
"""Routes without a piece that are named."""
ROOM = 130
"""Characters of a line above one panel."""
MEANING = (
    "Chance that a route is blocked if its floors shake with the PFA along both axes; anchors hold. Light bands: range "
    "of the chance. Broad: the scenario's PFA on the route's floors, both axes. A stronger motion may spare a piece "
    "that a weaker one overturns."
)

Panels = Sequence[Sequence[RouteFragility]]


def choose_drawn(routes: Sequence[RouteFragility]) -> tuple[list[list[RouteFragility]], list[RouteFragility]]:
    """Return the routes panel by panel, and those that are too many: those that a piece reaches, else all."""
    reached = [one for one in routes if max(chance.high for chance in one.blocked) > 0] or list(routes)
    shown, left = reached[: A_PANEL * MOST_PANELS], reached[A_PANEL * MOST_PANELS :]
    each = math.ceil(len(shown) / math.ceil(len(shown) / A_PANEL))
    return [shown[at : at + each] for at in range(0, len(shown), each)], left


def size(panels: Panels) -> tuple[float, float]:
    """Return width and height [inches]."""
    return (7.5, 4.4) if len(panels) == 1 else (12.0, 0.5 + 3.7 * math.ceil(len(panels) / 2))


def paint(fragility: Fragility, panels: Panels, pfa_g: Sequence[float], figure: Any) -> None:
    """Paint the panels, and above them what the marks mean."""
    columns = min(len(panels), 2)
    every = figure.subplots(math.ceil(len(panels) / columns), columns, squeeze=False, sharex=True, sharey=True)
    for axes, routes in zip(every.flat, panels, strict=False):
        for one, style in zip(routes, LINES, strict=False):
            _paint_route(axes, one, pfa_g, style)
        _dress(axes, pfa_g)
    for axes in every.flat[len(panels) :]:
        axes.set_axis_off()
    for axes in every[:, 0]:
        axes.set_ylabel("Chance of blockage")
    for column in range(columns):
        lowest = max(row for row in range(len(every)) if row * columns + column < len(panels))
        every[lowest, column].set_xlabel("PFA on the route's floors [g]")
        every[lowest, column].tick_params(labelbottom=True)
    wide = ROOM if columns == 1 else 2 * ROOM
    figure.suptitle("\n".join(_notes(fragility, wide)), x=0.01, ha="left", fontsize=7.5)


def _paint_route(axes: Any, one: RouteFragility, pfa_g: Sequence[float], style: tuple[str, str, str]) -> None:
    colour, line, marker = style
    chances = [chance.probability for chance in one.blocked]
    axes.fill_between(
        pfa_g, [chance.low for chance in one.blocked], [chance.high for chance in one.blocked],
        color=colour, alpha=0.1, linewidth=0,
    )  # fmt: skip
    every = math.ceil(len(pfa_g) / MOST_MARKS)
    axes.plot(pfa_g, chances, color=colour, linestyle=line, linewidth=1.3, marker=marker, markersize=4.5,
              markevery=every, label=label(one.route), clip_on=False)  # fmt: skip
    if one.scenario_pfa is None:
        return
    low, high = (max(peak / GRAVITY, pfa_g[0]) for peak in one.scenario_pfa)
    if one.scenario_pfa[1] / GRAVITY >= pfa_g[0] and low <= pfa_g[-1]:
        at = np.unique([low, *(pfa for pfa in pfa_g if low < pfa < high), min(high, pfa_g[-1])])
        axes.plot(at, np.interp(at, pfa_g, chances), color=colour, linewidth=5, alpha=0.35, solid_capstyle="round")


def _dress(axes: Any, pfa_g: Sequence[float]) -> None:
    for limit, risk in zip(LIMITS, list(RiskClass)[1:], strict=True):
        axes.axhline(limit, color="#777777", linewidth=0.5, linestyle=(0, (1, 2)))
        axes.text(0.995, limit, f"{words.risk_word(risk)} from {100 * limit:g} %", fontsize=6, color="#555555",
                  ha="right", va="bottom", transform=axes.get_yaxis_transform())  # fmt: skip
    axes.set_ylim(-0.02, 1.02)
    axes.set_yticks([0, 0.2, 0.4, 0.6, 0.8, 1], [f"{share} %" for share in (0, 20, 40, 60, 80, 100)])
    if pfa_g[0] < pfa_g[-1]:
        axes.set_xlim(pfa_g[0], pfa_g[-1])
    axes.grid(visible=True, color="#eeeeee", linewidth=0.5)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(fontsize=7, frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0), handlelength=4)


def _notes(fragility: Fragility, wide: int) -> Iterator[str]:
    free = [one.route for one in fragility.routes if max(chance.high for chance in one.blocked) == 0]
    yield from textwrap.wrap(MEANING, wide)
    if free:
        named = words.name_first([label(name) for name in free], MOST_NAMED)
        yield from textwrap.wrap(f"Always 0 %, as no free-standing piece can block them: {named}.", wide)
