"""The figures of `assess routes` and `assess fragility`: chances over the PFA or PFV of floors, several to a panel."""

import math
import textwrap
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np

from assess.cli.fragility_output import Curves
from assess.cli.route_output import Sweep
from assess.fragility import lognormal_chance
from assess.i18n import count
from assess.pipeline.piece_fragility import UNITS, PieceFragility
from assess.pipeline.route_sweep import RouteFragility, find_jumps
from assess.report import words
from assess.report.figures.draw import draw, label
from assess.report.interchange.exchange_files import LABELS
from assess.risk import LIMITS, RiskClass
from assess.units import GRAVITY

LINES = (
    ("#1b4f72", "-", "o"), ("#b03a2e", "--", "s"), ("#196f3d", "-.", "^"), ("#6c3483", ":", "D"),
    ("#9a6a00", "-", "v"), ("#117a8b", "--", "x"), ("#444444", "-.", "+"), ("#c2410c", ":", "*"),
)  # fmt: skip
"""Colour, line and marker of the curves of a panel; the last two tell them apart without colour."""
ROOM = 130  # characters of a line beside one panel
ROUTES_A_PANEL, MOST_ROUTE_PANELS = 8, 6
MOST_MARKS = 10
LONGEST = 600  # characters of the verdict
MOST_NAMED = 12  # routes that no piece can block whose names are listed
MEANING = (
    "Chance that a route is blocked if its floors shake with the PFA along both axes; anchors hold. Light bands or "
    "bars: its range. Thin dots: a jump. Broad: the scenario's PFA on the route's floors."
)
CURVES_A_PANEL, MOST_CURVE_PANELS = 6, 4
POINTS = 200  # points of a fitted curve
TICKS = (1, 2, 3, 5, 7)

_Row = TypeVar("_Row")
Panels = Sequence[Sequence[_Row]]


def _split(rows: Sequence[_Row], a_panel: int, most: int) -> tuple[list[list[_Row]], int]:
    """Return the rows panel by panel, about as many in each, and how many there is no room for."""
    shown = rows[: a_panel * most]
    each = math.ceil(len(shown) / math.ceil(len(shown) / a_panel))
    return [list(shown[at : at + each]) for at in range(0, len(shown), each)], len(rows) - len(shown)


def _lay_out(figure: Any, panels: Panels[_Row], y_label: str, **shared: bool) -> Any:
    """Return the axes, in one or two columns; those without a panel are empty."""
    columns = min(len(panels), 2)
    every = figure.subplots(math.ceil(len(panels) / columns), columns, squeeze=False, sharey=True, **shared)
    for axes in every.flat[len(panels) :]:
        axes.set_axis_off()
    for axes in every[:, 0]:
        axes.set_ylabel(y_label)
    return every


def _dress(axes: Any) -> None:
    axes.set_ylim(-0.02, 1.02)
    axes.set_yticks([0, 0.2, 0.4, 0.6, 0.8, 1], [f"{share} %" for share in (0, 20, 40, 60, 80, 100)])
    axes.grid(visible=True, color="#eeeeee", linewidth=0.5)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(fontsize=7, frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0), handlelength=4)


def draw_routes(sweep: Sweep, kind: str) -> tuple[bytes, int]:
    """Return the figure of `assess routes`, and how many routes it has no room for."""
    panels, left = choose_routes(sweep.fragility.routes)
    size = (7.5, 4.4) if len(panels) == 1 else (12.0, 0.5 + 3.7 * math.ceil(len(panels) / 2))
    return draw(*size, lambda figure: paint_routes(sweep, panels, figure), kind), left


def choose_routes(routes: Sequence[RouteFragility]) -> tuple[list[list[RouteFragility]], int]:
    """Return the routes panel by panel, those that a piece can block, else all; and how many have no room."""
    blockable = [one for one in routes if max(chance.high for chance in one.blocked) > 0]
    return _split(blockable or routes, ROUTES_A_PANEL, MOST_ROUTE_PANELS)


def paint_routes(sweep: Sweep, panels: Panels[RouteFragility], figure: Any) -> None:
    """Paint the panels, above them the verdict, and below them what the marks mean."""
    pfa_g = sweep.pfa_g
    every = _lay_out(figure, panels, "Chance of blockage", sharex=True)
    for axes, routes in zip(every.flat, panels, strict=False):
        for one, style in zip(routes, LINES, strict=False):
            _paint_route(axes, one, pfa_g, style)
        for limit, risk in zip(LIMITS, list(RiskClass)[1:], strict=True):
            axes.axhline(limit, color="#777777", linewidth=0.5, linestyle=(0, (1, 2)))
            axes.text(0.995, limit, f"{words.risk_word(risk)} from {100 * limit:g} %", fontsize=6, color="#555555",
                      ha="right", va="bottom", transform=axes.get_yaxis_transform())  # fmt: skip
        if pfa_g[0] < pfa_g[-1]:
            axes.set_xlim(pfa_g[0], pfa_g[-1])
        _dress(axes)
    columns = len(every[0])
    for column in range(columns):
        lowest = max(row for row in range(len(every)) if row * columns + column < len(panels))
        every[lowest, column].set_xlabel("PFA on the route's floors [g]")
        every[lowest, column].tick_params(labelbottom=True)
    found = sweep.fragility.uncertainty
    uncertain = "PFA and pieces exact."
    if found is not None:
        pieces = "pieces uncertain" if found.piece else "pieces exact"
        uncertain = f"PFA uncertain by {found.motion:g} in ln, the same on all floors; {pieces}."
    texts = [f"{MEANING} {uncertain}"]
    flat = [one for one in sweep.fragility.routes if max(chance.high for chance in one.blocked) == 0]
    weak = [one for one in sweep.fragility.routes if one.doubtful]
    for what, routes in (
        ("Lower bounds, as motions of pieces beside them may be too weak", weak),
        ("Always 0 %, as no free-standing piece can block them", [one for one in flat if one.is_evaluated]),
        ("Not evaluated, as the workbook places no furniture there", [one for one in flat if not one.is_evaluated]),
    ):
        if routes:
            texts.append(f"{what}: {words.name_first([label(one.route) for one in routes], MOST_NAMED)}.")
    wide = ROOM * columns
    verdict = textwrap.wrap(label(sweep.verdict.say(), LONGEST), wide * 5 // 6)
    figure.suptitle("\n".join(verdict), x=0.01, ha="left", fontsize=9)
    notes = (line for text in texts for line in textwrap.wrap(text, wide))
    figure.supxlabel("\n".join(notes), x=0.01, ha="left", fontsize=7)


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
    if one.scenario_pfa is None:
        return
    # the curve is broad from one peak of the scenario to the other, but for where it jumps
    peaks = [peak / GRAVITY for peak in one.scenario_pfa]
    first, last = max(peaks[0], pfa_g[0]), min(peaks[1], pfa_g[-1])
    bounds = [0, *(side for at in jumps for side in (at, at + 1)), len(pfa_g) - 1]
    for number, (begin, stop) in enumerate(pairwise(bounds)):
        start, end = max(first, pfa_g[begin]), min(last, pfa_g[stop])
        if number % 2 == 0 and start <= end:
            between = np.unique([start, *(pfa for pfa in pfa_g if start < pfa < end), end])
            axes.plot(between, np.interp(between, pfa_g, ways[0]), color=colour, linewidth=5, alpha=0.35,
                      solid_capstyle="round")  # fmt: skip


def draw_curves(curves: Curves, kind: str) -> tuple[bytes, int]:
    """Return the figure of `assess fragility`, and how many curves it has no room for."""
    panels, left = choose_curves(curves.found.curves)
    size = (8.0, 4.6) if len(panels) == 1 else (13.0, 0.8 + 3.6 * math.ceil(len(panels) / 2))
    return draw(*size, lambda figure: paint_curves(curves, panels, figure), kind), left


def choose_curves(curves: Sequence[PieceFragility]) -> tuple[list[list[PieceFragility]], int]:
    """Return the curves panel by panel, the lowest medians first, and how many there is no room for."""
    ordered = sorted(curves, key=lambda one: one.curve.median if one.curve.kind == "fitted" else math.inf)
    return _split(ordered, CURVES_A_PANEL, MOST_CURVE_PANELS)


def paint_curves(curves: Curves, panels: Panels[PieceFragility], figure: Any) -> None:
    """Paint fitted lognormals with the shares that fell, and above them what they mean."""
    every = _lay_out(figure, panels, "Chance of overturning")
    unit, name = UNITS[curves.found.im], LABELS[curves.found.im]
    for axes, drawn in zip(every.flat, panels, strict=False):
        ends = []  # of each curve, the last level at which nothing falls and the first at which everything does
        for one in drawn:
            some = np.flatnonzero((one.curve.shares > 0) & (one.curve.shares < 1))
            first, last = (max(some[0] - 1, 0), some[-1] + 1) if some.size else (0, one.curve.levels.size)
            ends += one.curve.levels[[first, min(last, one.curve.levels.size - 1)]].tolist()
        low, high = min(ends) / unit, max(ends) / unit
        for one, (colour, style, marker) in zip(drawn, LINES, strict=False):
            curve, levels = one.curve, one.curve.levels / unit
            kept = (levels >= low) & (levels <= high)
            marks = {"marker": marker, "markersize": 4.0, "color": colour}
            axes.plot(levels[kept], curve.shares[kept], linestyle="", clip_on=False, **marks)
            if curve.kind == "fitted":
                at = np.geomspace(low, high, POINTS)
                chances = lognormal_chance(at, curve.median / unit, curve.dispersion)
                axes.plot(at, chances, color=colour, linestyle=style, linewidth=1.3)
                said = f"median {curve.median / unit:.3g} {name}, beta {curve.dispersion:.2f}"
                said += "" if curve.is_lognormal else f", misfit {curve.misfit:.3f}"
            else:  # without a lognormal, thin dots from point to point
                axes.plot(levels[kept], curve.shares[kept], color=colour, linestyle=(0, (1, 4)), linewidth=0.7)
                said = curve.kind
            line, weak = style if curve.kind == "fitted" else "", " *" if one.may_be_too_low else ""
            axes.plot([], [], linestyle=line, linewidth=1.3, label=f"{label(one.name)}{weak}\n{said}", **marks)
        axes.set_xscale("log")
        decades = range(math.floor(math.log10(low)) - 1, math.ceil(math.log10(high)) + 1)
        ticks = [first * 10.0**decade for decade in decades for first in TICKS]
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.minorticks_off()
        axes.set_xlim(low / 1.03, high * 1.03)
        _dress(axes)
        axes.set_xlabel(f"{curves.measure} of the floor [{name}]")
    ratios = [ratio for one in curves.found.curves for ratio in one.pfv_per_pfa]
    pieces = "pieces uncertain" if curves.found.has_drawn_pieces else "pieces exactly as filled in"
    notes = textwrap.wrap(
        f"Points: share of {count(curves.found.runs, 'draw')} that overturned; lines: lognormal fitted. Given the "
        f"floor's {curves.measure}: the uncertainty of the motion is not in it; {pieces}. Holds for motions of this "
        f"shape of spectrum: PFV/PFA {min(ratios):.2f} to {max(ratios):.2f} s.",
        ROOM * len(every[0]),
    )
    if any(one.may_be_too_low for one in curves.found.curves):
        notes.append("* Its motions may be too weak: pieces may overturn at lower levels than the curve says.")
    figure.suptitle("\n".join(notes), x=0.01, ha="left", fontsize=7.5)
