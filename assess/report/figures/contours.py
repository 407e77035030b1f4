"""The figure of risk over breadth and PFA for pieces of one height, with the pieces of the inventory on it."""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from assess.language import gettext as _
from assess.language import ngettext
from assess.methods import Cases, Method
from assess.methods._method import FloatArray
from assess.report.content import Content
from assess.report.figures.draw import draw
from assess.report.figures.risk_map import (
    Place,
    paint_chances,
    paint_checked,
    paint_legend,
    paint_names,
    paint_pieces,
    paint_risk,
)
from assess.results import ItemResult
from assess.risk import RiskClass
from assess.settings import Settings
from assess.units import ACCELERATION, LENGTH, ROUNDING, VELOCITY

METHODS = ("proposed_or", "kaneko_hayashi")
"""Keys of the methods that are drawn, each in a panel: those that need no more than sizes and peaks."""
ALIKE = 0.1
"""Pieces whose height is this close to the chosen one are drawn [-]."""
FINE_BELOW = 0.5
"""Heights [m] below which they are rounded to 1 cm in place of 10 cm."""
STEPS = 121
"""Points of the grid along each side."""
SLENDER, STOUT = 0.08, 0.45
"""The grid reaches from the first to the second B/H [-], and further where pieces lie."""
WEAKEST, STRONGEST, BEYOND = 0.02, 0.4, 2.0
"""It reaches from the first to the second PFA [g], at least to as many times the largest of a piece as the third."""


@dataclass(frozen=True, slots=True, eq=False)
class Contours:
    """What the figure shows.

    Parameters
    ----------
    height : float
        Of the pieces that it is drawn for [m].
    pieces : tuple of ItemResult
        Those drawn: free-standing rows whose height is within 10 % of it, the worst first.
    ratio : float, optional
        PFV over PFA [s] with which Kaneko-Hayashi is evaluated; None where the upper bound over every PFV is.
    methods : tuple of Method
        Of the panels.
    caption : tuple of str
        Sentences that belong below the figure.
    alt : str
        What it shows, for those who cannot see it.
    """

    height: float
    pieces: tuple[ItemResult, ...]
    ratio: float | None
    methods: tuple[Method, ...]
    caption: tuple[str, ...]
    alt: str


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """Breadths (b,) [m] and PFA (a,) [m/s2] at which the methods are evaluated."""

    breadth: FloatArray
    pfa: FloatArray


def choose_contours(content: Content) -> Contours | None:
    """Return what to draw: for the height that most risky pieces share, else the commonest; None without pieces."""
    free = [one for one in content.results if not one.is_anchored]
    if not free:
        return None
    height = _commonest([one for one in free if one.adopted.upper >= RiskClass.HIGH] or free)
    near = [one for one in free if abs(one.item.height - height) <= ALIKE * height * (1 + ROUNDING)]
    pieces = tuple(sorted(near, key=lambda one: (-one.adopted.upper, -one.adopted.probability, one.item.item)))
    demand = pieces[0].governing.demand
    ratio = demand.pfv / demand.pfa if demand.pfv > 0 and demand.pfa > 0 else None
    methods = tuple(method for method in content.methods if method.key in METHODS)
    caption = (*_describe_figure(height, pieces), *_describe_ratio(pieces[0], ratio))
    return Contours(height, pieces, ratio, methods, caption, _describe_alt(height, pieces))


def _commonest(results: Sequence[ItemResult]) -> float:
    """Return the height [m] that most pieces (not rows) share, rounded; of several the largest."""
    counts: Counter[float] = Counter()
    for one in results:
        counts[_round(one.item.height)] += one.item.quantity
    return max(counts, key=lambda height: (counts[height], height))


def _round(height: float) -> float:
    """Return a height [m] rounded to 10 cm, or to 1 cm where it is small; halves go up."""
    parts = 10 if height >= FINE_BELOW else 100
    return math.floor(height * parts * (1 + ROUNDING) + 0.5) / parts


def _describe_figure(height: float, pieces: Sequence[ItemResult]) -> Iterator[str]:
    count, size = sum(one.item.quantity for one in pieces), height / LENGTH["cm"]
    yield _(
        "Chance of overturning of pieces {height:.0f} cm high, by the proposed OR formula and by Kaneko-Hayashi.",
        height=size,
    )
    yield ngettext(
        "The symbol is the one free-standing piece within 10 % of this height, at its breadth and the PFA of the "
        "motion that governs it.",
        "The symbols are the {n:,} free-standing pieces within 10 % of this height, each at its breadth and the PFA of "
        "the motion that governs it.",
        count,
    )
    yield _(
        "A symbol is that of the class adopted for the piece, which may be another than the one it lies on: colours "
        "are those of the formulas, for this height."
    )
    yield _(
        "A name is that of the worst piece at its place, with the number of further rows there; names for which there "
        "is no room are left out."
    )


def _describe_ratio(worst: ItemResult, ratio: float | None) -> Iterator[str]:
    """Say which PFV goes with a PFA under Kaneko-Hayashi."""
    if ratio is None:
        yield _(
            "PFV is not known for the worst of these pieces: Kaneko-Hayashi shows the largest chance that any PFV "
            "gives."
        )
        return
    demand, per_g = worst.governing.demand, ratio * ACCELERATION["g"] / VELOCITY["cm/s"]
    names = {"floor": demand.floor.floor, "axis": demand.axis, "ratio": per_g}
    if "pfv_estimated" in demand.flags:
        yield _(
            "For Kaneko-Hayashi PFV grows with PFA, {ratio:.0f} cm/s for each g: the ratio estimated for floor {floor} "
            "{axis}, whose motion governs the worst of these pieces.",
            **names,
        )
    else:
        yield _(
            "For Kaneko-Hayashi PFV grows with PFA, {ratio:.0f} cm/s for each g: the ratio of floor {floor} {axis}, "
            "whose motion governs the worst of these pieces.",
            **names,
        )
    yield _("Where this formula passes from PFA to PFV it jumps, which shows as a step.")


def _describe_alt(height: float, pieces: Sequence[ItemResult]) -> str:
    return ngettext(
        "Two maps of the chance of overturning over breadth and PFA for a height of {height:.0f} cm, by the proposed "
        "OR formula and by Kaneko-Hayashi, with {n:,} piece on them; its chance stands in the table of all pieces",
        "Two maps of the chance of overturning over breadth and PFA for a height of {height:.0f} cm, by the proposed "
        "OR formula and by Kaneko-Hayashi, with {n:,} pieces on them; their chances stand in the table of all pieces",
        sum(one.item.quantity for one in pieces),
        height=height / LENGTH["cm"],
    )


def build_grid(contours: Contours) -> Grid:
    """Return the grid: from slender to stout pieces and from weak to strong motions, around all pieces drawn."""
    breadth = [one.item.breadth for one in contours.pieces]
    pfa = [one.governing.demand.pfa for one in contours.pieces]
    height, g = contours.height, ACCELERATION["g"]
    thinnest, widest = min(SLENDER * height, 0.85 * min(breadth)), max(STOUT * height, 1.1 * max(breadth))
    weakest, strongest = min(WEAKEST * g, 0.85 * min(pfa)), max(STRONGEST * g, BEYOND * max(pfa))
    return Grid(np.linspace(thinnest, widest, STEPS), np.linspace(weakest, strongest, STEPS))


def evaluate_grid(contours: Contours, method: Method, grid: Grid, settings: Settings) -> FloatArray:
    """Return the chance by a method [-] at every PFA (rows) and breadth (columns) of the grid, (a, b)."""
    breadth, pfa = (values.ravel() for values in np.meshgrid(grid.breadth, grid.pfa))
    pfv = math.nan if contours.ratio is None else contours.ratio * pfa
    cases = Cases.of(breadth=breadth, height=contours.height, pfa=pfa, pfv=pfv)
    return method.evaluate(cases, settings).value.reshape(grid.pfa.size, grid.breadth.size)


def draw_contours(contours: Contours, settings: Settings) -> bytes:
    """Draw the figure as SVG."""
    return draw(7, 3.6, partial(_paint, contours, settings))


def _paint(contours: Contours, settings: Settings, figure: Any) -> None:
    grid = build_grid(contours)
    places = _find_places(contours.pieces)
    panels = figure.subplots(1, len(contours.methods), sharex=True, sharey=True, squeeze=False)[0]
    for axes, method in zip(panels, contours.methods, strict=True):
        risk = evaluate_grid(contours, method, grid, settings)
        lines = paint_risk(axes, grid.breadth / LENGTH["cm"], grid.pfa / ACCELERATION["g"], risk)
        paint_checked(axes, method, contours.height)
        paint_pieces(axes, places)
        _frame(axes, method, grid)
        taken = paint_chances(axes, lines, places)
        paint_names(axes, places, taken)
    panels[0].set_ylabel(_("PFA [g]"), fontsize=7)
    paint_legend(figure)


def _find_places(pieces: Sequence[ItemResult]) -> dict[Place, list[ItemResult]]:
    """Return the pieces at each place, the worst first."""
    places: dict[Place, list[ItemResult]] = {}
    for one in pieces:
        pfa = round(one.governing.demand.pfa / ACCELERATION["g"], 6)
        places.setdefault((round(one.item.breadth / LENGTH["cm"], 6), pfa), []).append(one)
    return places


def _frame(axes: Any, method: Method, grid: Grid) -> None:
    axes.set_xlim(*(grid.breadth[[0, -1]] / LENGTH["cm"]))
    axes.set_ylim(*(grid.pfa[[0, -1]] / ACCELERATION["g"]))
    axes.set_title(_(method.title), fontsize=8, loc="left")
    axes.set_xlabel(_("breadth [cm]"), fontsize=7)
    axes.tick_params(labelsize=6)
