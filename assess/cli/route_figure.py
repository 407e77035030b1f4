"""The figure of `assess routes`: the chance that each route is blocked over the PFA on its floors."""

import math
import textwrap
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from assess.cli.route_verdict import find_verdict
from assess.pipeline.route_sweep import Fragility, RouteFragility, find_jumps
from assess.report import words
from assess.report.figures.draw import label
from assess.risk import LIMITS, RiskClass
from assess.units import GRAVITY

A_PANEL, MOST_PANELS = 8, 6
LINES = (
    ("#1b4f72", "-", "o"), ("#b03a2e", "--", "s"), ("#196f3d", "-.", "^"), ("#6c3483", ":", "D"),
    ("#9a6a00", "-", "v"), ("#117a8b", "--", "x"), ("#444444", "-.", "+"), ("#c2410c", ":", "*"),
)  # fmt: skip
"""Colour, line and marker of the routes of a panel; the last two tell them apart without colour."""
MOST_MARKS = 10
LONGEST = 600
"""Characters of the verdict."""
MOST_NAMED = 12
"""Routes that no piece can block whose names are listed."""
ROOM = 130
"""Characters of a line below one panel."""
MEANING = (
    "Chance that a route is blocked if its floors shake with the PFA along both axes; anchors hold. Light bands or "
    "bars: its range. Thin dots: a jump. Broad: the scenario's PFA on the route's floors."
)

Panels = Sequence[Sequence[RouteFragility]]


def choose_drawn(routes: Sequence[RouteFragility]) -> tuple[list[list[RouteFragility]], list[RouteFragility]]:
    """Return the routes panel by panel, those that a piece can block, else all; and those there is no room for."""
    blockable = [one for one in routes if max(chance.high for chance in one.blocked) > 0] or list(routes)
    shown, left = blockable[: A_PANEL * MOST_PANELS], blockable[A_PANEL * MOST_PANELS :]
    each = math.ceil(len(shown) / math.ceil(len(shown) / A_PANEL))
    return [shown[at : at + each] for at in range(0, len(shown), each)], left


def size(panels: Panels) -> tuple[float, float]:
    """Return width and height [inches]."""
    return (7.5, 4.4) if len(panels) == 1 else (12.0, 0.5 + 3.7 * math.ceil(len(panels) / 2))


def paint(fragility: Fragility, panels: Panels, pfa_g: Sequence[float], figure: Any) -> None:
    """Paint the panels, above them the verdict, and below them what the marks mean."""
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
    verdict = textwrap.wrap(label(find_verdict(fragility, pfa_g).say(), LONGEST), wide * 5 // 6)
    figure.suptitle("\n".join(verdict), x=0.01, ha="left", fontsize=9)
    figure.supxlabel("\n".join(_notes(fragility, wide)), x=0.01, ha="left", fontsize=7)


def _paint_route(axes: Any, one: RouteFragility, pfa_g: Sequence[float], style: tuple[str, str, str]) -> None:
    """Paint a curve with its range and the scenario; where it jumps to the next value, neither line nor band."""
    colour, line, marker = style
    ways = [[getattr(chance, end) for chance in one.blocked] for end in ("probability", "low", "high")]
    jumps = find_jumps(ways[0])
    every = math.ceil(len(pfa_g) / MOST_MARKS)
    ends = {at + side for at in jumps for side in (0, 1)}
    marked = [at for at in range(len(pfa_g)) if at % every == 0 or at in ends]
    pfa, chances, low, high = (np.insert(way, [at + 1 for at in jumps], np.nan) for way in (pfa_g, *ways))
    axes.fill_between(pfa, low, high, color=colour, alpha=0.1, linewidth=0)
    alone = [at for at in range(len(pfa_g)) if {at - 1, at} <= {-1, len(pfa_g) - 1, *jumps}]
    axes.vlines(*([way[at] for at in alone] for way in (pfa_g, *ways[1:])), color=colour, alpha=0.3, linewidth=3)
    curve, marks = {"linestyle": line, "linewidth": 1.3}, {"marker": marker, "markersize": 4.5}
    axes.plot(pfa, chances, color=colour, clip_on=False, **curve)
    axes.plot(pfa_g, ways[0], color=colour, clip_on=False, linestyle="", markevery=marked, **marks)
    axes.plot([], [], color=colour, label=label(one.route), **curve, **marks)
    for at in jumps:
        pair = slice(at, at + 2)
        axes.plot(pfa_g[pair], ways[0][pair], color=colour, linestyle=(0, (1, 4)), linewidth=0.7)
    if one.scenario_pfa is not None:
        _paint_scenario(axes, [peak / GRAVITY for peak in one.scenario_pfa], pfa_g, ways[0], colour)


def _paint_scenario(
    axes: Any, peaks: Sequence[float], pfa_g: Sequence[float], chances: Sequence[float], colour: str
) -> None:
    """Paint the curve broad from one peak to the other, but for where it jumps."""
    low, high = max(peaks[0], pfa_g[0]), min(peaks[1], pfa_g[-1])
    if low > high:
        return
    bounds = [0, *(side for at in find_jumps(chances) for side in (at, at + 1)), len(pfa_g) - 1]
    for number, (first, last) in enumerate(pairwise(bounds)):
        start, end = max(low, pfa_g[first]), min(high, pfa_g[last])
        if number % 2 == 0 and start <= end:
            at = np.unique([start, *(pfa for pfa in pfa_g if start < pfa < end), end])
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


def _say_uncertain(fragility: Fragility) -> str:
    found = fragility.uncertainty
    if found is None:
        return "PFA and pieces exact."
    pieces = "pieces uncertain" if found.piece else "pieces exact"
    return f"PFA uncertain by {found.motion:g} in ln, the same on all floors; {pieces}."


def _notes(fragility: Fragility, wide: int) -> Iterator[str]:
    flat = [one for one in fragility.routes if max(chance.high for chance in one.blocked) == 0]
    free, unknown = ([one.route for one in flat if one.is_evaluated is known] for known in (True, False))
    yield from textwrap.wrap(f"{MEANING} {_say_uncertain(fragility)}", wide)
    if doubtful := [one.route for one in fragility.routes if one.doubtful]:
        named = words.name_first([label(name) for name in doubtful], MOST_NAMED)
        yield from textwrap.wrap(f"Lower bounds, as motions of pieces beside them may be too weak: {named}.", wide)
    if free:
        named = words.name_first([label(name) for name in free], MOST_NAMED)
        yield from textwrap.wrap(f"Always 0 %, as no free-standing piece can block them: {named}.", wide)
    if unknown:
        named = words.name_first([label(name) for name in unknown], MOST_NAMED)
        yield from textwrap.wrap(f"Not evaluated, as the workbook places no furniture there: {named}.", wide)
