"""The map of risk over breadth and PFA for pieces of one height: classes, lines of equal chance, pieces and names."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from assess.i18n import gettext as _, ngettext, number
from assess.progress import SILENT, Progress
from assess.report import measures, words
from assess.report.blocks import Figure
from assess.report.figures.draw import HATCHES, build_figure, draw, label
from assess.report.figures.labels import Point, box_around, is_inside, overlap
from assess.results import ROLLS, ItemResult, Results, count_pieces
from assess.risk import LIMITS, RiskClass
from assess.units import ROUNDING

if TYPE_CHECKING:
    from assess.methods import MethodInfo

FloatArray = NDArray[np.float64]

LINES = (0.03, 0.1, 0.3, 0.5, 0.7, 0.9)
"""Chances at which lines are drawn [-]."""
MOST_NAMES = 12
PANEL = (148.0, 190.0)
"""About the size of a panel of three [points], by which texts are kept off each other."""
MARKERS = {RiskClass.LOW: "o", RiskClass.MEDIUM: "D", RiskClass.HIGH: "^", RiskClass.VERY_HIGH: "s"}
"""The symbols of the classes, as matplotlib names them."""
APART = {"unconfirmed": "p", "formula": "v", ROLLS: "8"}
"""Those of pieces that stand apart from the simulated ones, without a class's colour."""
LETTER, LINE, GAP = 3.7, 7.0, 5.0
"""About the width of a letter and the height of a line of 6 points, and a text's distance from a symbol."""

INK, HALO, HATCHING = words.INK, "#ffffff", "#a08c78"
_BACKING = {"boxstyle": "round,pad=0.1", "facecolor": HALO, "alpha": 0.75, "linewidth": 0}
"""Behind a text, so that it can be read on a hatch."""

Line = tuple[float, FloatArray]
"""A chance [-] and the places (n, 2) that its line goes through."""


def paint_risk(axes: Any, breadth: FloatArray, pfa: FloatArray, risk: FloatArray) -> list[Line]:
    """Paint the classes as fields with their colour and hatch, and lines of equal chance, which are returned.

    `risk` (a, b) [-] is that at `breadth` (b,) [cm] and `pfa` (a,) [g].
    """
    colours, hatches = [one.fill for one in RiskClass], [2 * HATCHES[one] for one in RiskClass]
    fields = axes.contourf(breadth, pfa, risk, levels=(0, *LIMITS, 1 + ROUNDING), colors=colours, hatches=hatches)
    fields.set_edgecolor(HATCHING)
    fields.set_linewidth(0)
    levels = [one for one in LINES if risk.min() < one < risk.max()]
    if not levels:
        return []
    widths = [0.9 if one in LIMITS else 0.5 for one in levels]
    inks = [INK if one < LIMITS[-1] else HALO for one in levels]
    lines = axes.contour(breadth, pfa, risk, levels=levels, linewidths=widths, colors=inks)
    lines.set_gid("lines")
    return [(level, path.vertices) for level, path in zip(levels, lines.get_paths(), strict=True)]


def paint_checked(axes: Any, method: "MethodInfo", height_cm: float) -> None:
    """Outline where a method has been checked, in so far as it says, for pieces of one height; at any PFA its sides."""
    slender, pfa = method.valid.get("breadth_to_height"), method.valid.get("pfa")
    if slender is None:
        return
    left, right = (end * height_cm for end in (slender.low, slender.high))
    if pfa is None:
        corners = ([left, left, np.nan, right, right], [0, 1, np.nan, 0, 1])
        where = {"transform": axes.get_xaxis_transform()}
    else:
        corners = ([left, right, right, left, left], [pfa.low, pfa.low, pfa.high, pfa.high, pfa.low])
        where = {}
    axes.plot(*corners, color=HALO, linewidth=2.2, **where)
    axes.plot(*corners, color=INK, linewidth=1.2, linestyle=":", **where)[0].set_gid("checked")


def _in_points(axes: Any, places: Any) -> FloatArray:
    """Return where places (n, 2) of a panel are, about, from its lower left corner [points], (n, 2)."""
    first, last = np.array([axes.get_xlim(), axes.get_ylim()]).T
    return np.asarray((np.reshape(np.array(list(places), dtype=np.float64), (-1, 2)) - first) / (last - first) * PANEL)


def _write_texts(axes: Any, lines: Sequence[Line], places: Mapping[Point, Sequence[ItemResult]]) -> None:
    """Write its chance on each line, clear of the symbols, and name the worst piece of each place, as there is room."""
    symbols = others = _in_points(axes, places)
    taken = [box_around((x, y), GAP, GAP) for x, y in symbols]
    for level, vertices in lines:
        along = _in_points(axes, vertices)
        inside = np.all((along >= 3 * GAP) & (along <= np.array(PANEL) - 3 * GAP), axis=1)
        if not inside.any():
            continue
        away = np.hypot(*(along[:, np.newaxis] - others[np.newaxis]).transpose(2, 0, 1))
        nearest = np.where(inside, away.min(axis=1, initial=np.inf), -1.0)
        at, text = int(nearest.argmax()), f"{number(100 * level, 'g')} %"
        axes.text(*vertices[at], text, fontsize=7, ha="center", va="center", color=INK, zorder=4,
                  bbox=_BACKING).set_gid("chance")  # fmt: skip
        others = np.vstack([others, along[at]])
        x, y = along[at].tolist()
        taken.append(box_around((x, y), LETTER * len(text), LINE))
    named = 0
    for place, (x, y), ones in zip(places, symbols, places.values(), strict=True):
        name = label(ones[0].item.item, 14) + (f" +{len(ones) - 1}" if len(ones) > 1 else "")
        width = LETTER * len(name)
        aside, above = GAP + width / 2, GAP + LINE / 2
        around = ((x + aside, y), (x - aside, y), (x, y + above), (x, y - above))
        tried = [box_around(centre, width, LINE) for centre in around if named < MOST_NAMES]
        tried = [box for box in tried if is_inside(box, (0.0, 0.0, *PANEL))]
        box = next((box for box in tried if not any(overlap(box, one) for one in taken)), None)
        if box is not None:
            offset = ((box[0] + box[2]) / 2 - x, (box[1] + box[3]) / 2 - y)
            axes.annotate(name, place, xytext=offset, textcoords="offset points", fontsize=7, ha="center", va="center",
                          color=INK, zorder=6, bbox=_BACKING).set_gid("name")  # fmt: skip
            taken.append(box)
            named += 1


def paint_legend(figure: Any, *, has_checked: bool = True) -> None:
    """Explain the fields, the symbols and the outline, where there is one, below the panels."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    fields = [Patch(facecolor=one.fill, hatch=2 * HATCHES[one], edgecolor=HATCHING, linewidth=0.5,
                    label=words.risk_label(one)) for one in RiskClass]  # fmt: skip
    checked = Line2D([], [], color=INK, linewidth=1.2, linestyle=":", label=_("range in which the formula is checked"))
    handles = [*fields, checked] if has_checked else fields
    figure.legend(handles=handles, loc="outside lower center", ncols=5, fontsize=7, frameon=False)


# ---------------------------------------------------------------- the figure of a report


def draw_contours(results: Results, progress: Progress = SILENT) -> Figure:
    """Draw what the series hold: the methods over breadth and PFA, and the free-standing pieces of about one height."""
    series = results.series
    pieces = [results.result(int(at)) for at in series["contours/items"]]
    height, ratio = float(series["contours/height_cm"]), float(series["contours/pfv_per_pfa_s"])
    panels = [
        (method, series[f"contours/{method.key}"]) for method in results.methods if f"contours/{method.key}" in series
    ]
    methods = [method for method, _risk in panels]
    breadth, pfa = series["contours/breadth_cm"], series["contours/pfa_g"]
    places: dict[Point, list[ItemResult]] = {}  # at each the worst first
    for one in pieces:
        place = round(one.item.breadth_cm, 6), round(one.governing.motion.pfa_g, 6)
        places.setdefault(place, []).append(one)

    def paint(figure: Any) -> None:
        drawn = figure.subplots(1, len(panels), sharex=True, sharey=True, squeeze=False)[0]
        for axes, (method, risk) in zip(drawn, panels, strict=True):
            lines = paint_risk(axes, breadth, pfa, risk)
            paint_checked(axes, method, height)
            shown = dict.fromkeys((place, one.adopted.risk, one.apart) for place, own in places.items() for one in own)
            for (x, y), own, apart in sorted(shown, key=lambda found: (not found[2], found[1])):  # the worst on top
                marker, fill = (APART[apart], HALO) if apart else (MARKERS[own], own.fill)
                axes.plot([x], [y], marker, color=HALO, markersize=7, zorder=5)
                axes.plot([x], [y], marker, markersize=5, markerfacecolor=fill, markeredgecolor=INK,
                          markeredgewidth=0.8, zorder=5)[0].set_gid("piece")  # fmt: skip
            axes.set_xlim(*breadth[[0, -1]])
            axes.set_ylim(*pfa[[0, -1]])
            axes.set_title(_(method.title), fontsize=8, loc="left")
            axes.set_xlabel(_("breadth [{unit}]", unit=measures.unit("cm")), fontsize=8)
            axes.xaxis.set_major_formatter(lambda value, _at: words.in_cm(value))
            axes.tick_params(labelsize=7)
            _write_texts(axes, lines, places)
        drawn[0].set_ylabel(_("PFA [g]"), fontsize=8)
        paint_legend(figure)

    alternative = ngettext(
        "Maps of the chance of overturning over breadth and PFA for a height of {height} ({methods}), with "
        "{n:,} piece on them; its chance is in the table of all pieces",
        "Maps of the chance of overturning over breadth and PFA for a height of {height} ({methods}), with "
        "{n:,} pieces on them; their chances are in the table of all pieces",
        count_pieces(pieces), height=measures.say(round(height), "cm"), methods=_name(methods),
    )  # fmt: skip
    drawing = draw(7, 3.6, paint, progress=progress)
    return build_figure(drawing, alternative, " ".join(_describe(height, pieces, ratio, methods)))


def _name(methods: Sequence["MethodInfo"]) -> str:
    return ", ".join(_(method.title) for method in methods)


def _describe(
    height: float, pieces: Sequence[ItemResult], ratio: float, methods: Sequence["MethodInfo"]
) -> Iterator[str]:
    yield _("Chance of overturning of pieces {height} high by these methods: {methods}.",
            height=measures.say(round(height), "cm"), methods=_name(methods))  # fmt: skip
    yield ngettext(
        "The symbol is the one free-standing piece within 10 % of this height, at its breadth and the PFA of the "
        "motion that governs it.",
        "The symbols are the {n:,} free-standing pieces within 10 % of this height, each at its breadth and the PFA of "
        "the motion that governs it.",
        count_pieces(pieces),
    )
    yield _("A symbol shows the class adopted for the piece, which may differ from the field it lies on: the fields "
            "are those of the formulas, for this height.")  # fmt: skip
    if any(one.apart for one in pieces):
        yield _("White symbols show pieces that are counted apart: a pentagon is unconfirmed, a triangle that points "
                "down is by formula only.")  # fmt: skip
    yield _("Names are those of the worst piece at each place, with the number of further rows there; names for which "
            "there is no room are left out.")  # fmt: skip
    by_velocity = [method for method in methods if any(flag.startswith("pfv_") for flag in method.flags)]
    if not by_velocity:
        return
    switching = _name([method for method in by_velocity if method.ruled_by == "pfa"])
    if math.isnan(ratio):
        yield _("PFV is not known for the worst of these pieces: the panel {methods} shows the largest chance that any "
                "PFV gives.", methods=switching)  # fmt: skip
        return
    motion = pieces[0].governing.motion
    yield _(
        "PFV grows with PFA, {ratio} for each g: the ratio of floor {floor} {axis}, whose motion governs the "
        "worst of these pieces. Methods that depend on it: {methods}.",
        ratio=measures.say(round((motion.pfv_cm_s or 0.0) / motion.pfa_g), "cm/s"), floor=motion.floor,
        axis=motion.axis, methods=_name(by_velocity),
    )  # fmt: skip
    if switching:
        yield _("Where a method changes from PFA to PFV, it jumps, which shows as a step: {methods}.",
                methods=switching)  # fmt: skip
