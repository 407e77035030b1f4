"""The figure of `assess fragility`: fitted lognormals with the shares that fell, over PFA or PFV."""

import math
import textwrap
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from assess.cli.fragility_output import Curves
from assess.cli.route_figure import LINES, ROOM
from assess.fragility import lognormal_chance
from assess.i18n import count
from assess.pipeline.piece_fragility import UNITS, PieceFragility
from assess.report.figures.draw import label
from assess.report.interchange.exchange_files import LABELS

A_PANEL, MOST_PANELS = 6, 4
POINTS = 200
"""Points of a fitted curve."""
TICKS = (1, 2, 3, 5, 7)

Panels = Sequence[Sequence[PieceFragility]]


def choose_drawn(curves: Sequence[PieceFragility]) -> tuple[list[list[PieceFragility]], int]:
    """Return the curves panel by panel, the lowest medians first, and how many there is no room for."""
    ordered = sorted(curves, key=lambda one: one.curve.median if one.curve.kind == "fitted" else math.inf)
    shown = ordered[: A_PANEL * MOST_PANELS]
    each = math.ceil(len(shown) / math.ceil(len(shown) / A_PANEL))
    return [shown[at : at + each] for at in range(0, len(shown), each)], len(ordered) - len(shown)


def size(panels: Panels) -> tuple[float, float]:
    """Return width and height [inches]."""
    return (8.0, 4.6) if len(panels) == 1 else (13.0, 0.8 + 3.6 * math.ceil(len(panels) / 2))


def paint(curves: Curves, panels: Panels, figure: Any) -> None:
    """Paint the panels, and above them what they mean."""
    columns = min(len(panels), 2)
    every = figure.subplots(math.ceil(len(panels) / columns), columns, squeeze=False, sharey=True)
    for axes, drawn in zip(every.flat, panels, strict=False):
        unit = UNITS[curves.found.im]
        limits = min(_shown(one)[0] for one in drawn) / unit, max(_shown(one)[1] for one in drawn) / unit
        for one, style in zip(drawn, LINES, strict=False):
            _paint_curve(axes, one, curves, style, limits)
        _dress(axes, limits)
        axes.set_xlabel(f"{curves.measure} of the floor [{LABELS[curves.found.im]}]")
    for axes in every.flat[len(panels) :]:
        axes.set_axis_off()
    for axes in every[:, 0]:
        axes.set_ylabel("Chance of overturning")
    figure.suptitle("\n".join(_notes(curves, ROOM * columns)), x=0.01, ha="left", fontsize=7.5)


def _paint_curve(
    axes: Any, one: PieceFragility, curves: Curves, style: tuple[str, str, str], limits: tuple[float, float]
) -> None:
    """Paint the shares that fell as points and the lognormal as a line; without one, thin dots from point to point."""
    colour, line, marker = style
    curve, unit = one.curve, UNITS[curves.found.im]
    levels = curve.levels / unit
    kept = (levels >= limits[0]) & (levels <= limits[1])
    marks = {"marker": marker, "markersize": 4.0, "color": colour}
    axes.plot(levels[kept], curve.shares[kept], linestyle="", clip_on=False, **marks)
    if curve.kind == "fitted":
        at = np.geomspace(*limits, POINTS)
        axes.plot(at, lognormal_chance(at, curve.median / unit, curve.dispersion), color=colour, linestyle=line,
                  linewidth=1.3)  # fmt: skip
        said = f"median {curve.median / unit:.3g} {LABELS[curves.found.im]}, beta {curve.dispersion:.2f}"
        said += "" if curve.is_lognormal else f", misfit {curve.misfit:.3f}"
    else:
        axes.plot(levels[kept], curve.shares[kept], color=colour, linestyle=(0, (1, 4)), linewidth=0.7)
        said, line = curve.kind, ""
    weak = " *" if one.may_be_too_low else ""
    axes.plot([], [], linestyle=line, linewidth=1.3, label=f"{label(one.name)}{weak}\n{said}", **marks)


def _dress(axes: Any, limits: tuple[float, float]) -> None:
    low, high = limits
    axes.set_xscale("log")
    decades = range(math.floor(math.log10(low)) - 1, math.ceil(math.log10(high)) + 1)
    ticks = [first * 10.0**decade for decade in decades for first in TICKS]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.set_xlim(low / 1.03, high * 1.03)
    axes.set_ylim(-0.02, 1.02)
    axes.set_yticks([0, 0.2, 0.4, 0.6, 0.8, 1], [f"{share} %" for share in (0, 20, 40, 60, 80, 100)])
    axes.grid(visible=True, color="#eeeeee", linewidth=0.5)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(fontsize=7, frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0), handlelength=4)


def _shown(one: PieceFragility) -> tuple[float, float]:
    """Return the levels between which a curve is shown: from the last at which nothing falls to where all do."""
    curve = one.curve
    some = np.flatnonzero((curve.shares > 0) & (curve.shares < 1))
    if not some.size:
        return float(curve.levels[0]), float(curve.levels[-1])
    return float(curve.levels[max(some[0] - 1, 0)]), float(curve.levels[min(some[-1] + 1, curve.levels.size - 1)])


def _notes(curves: Curves, wide: int) -> Iterator[str]:
    ratios = [ratio for one in curves.found.curves for ratio in one.pfv_per_pfa]
    pieces = "pieces uncertain" if curves.found.has_drawn_pieces else "pieces exactly as filled in"
    yield from textwrap.wrap(
        f"Points: share of {count(curves.found.runs, 'draw')} that overturned; lines: lognormal fitted. Given the "
        f"floor's {curves.measure}: the uncertainty of the motion is not in it; {pieces}. Holds for motions of this "
        f"shape of spectrum: PFV/PFA {min(ratios):.2f} to {max(ratios):.2f} s.",
        wide,
    )
    if any(one.may_be_too_low for one in curves.found.curves):
        yield "* Its motions may be too weak: pieces may overturn at lower levels than the curve says."
