"""The figure of risk over breadth and PFA for pieces of one height, with the pieces of the inventory on it."""

import math
from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from assess.i18n import gettext as _
from assess.i18n import ngettext
from assess.progress import SILENT, Progress
from assess.report.blocks import Figure, Image
from assess.report.embedded import data_uri
from assess.report.figures.draw import draw
from assess.report.figures.risk_map import (
    FloatArray,
    Place,
    paint_chances,
    paint_checked,
    paint_legend,
    paint_names,
    paint_pieces,
    paint_risk,
)
from assess.results import ItemResult, Results

if TYPE_CHECKING:
    from assess.methods import MethodInfo


Panel = tuple["MethodInfo", FloatArray]
"""A method and its chances on the grid [-], (a, b)."""


def draw_contours(results: Results, progress: Progress = SILENT) -> Figure:
    """Draw what the series hold: the methods over breadth and PFA, and the free-standing pieces of about one height."""
    series = results.series
    pieces = [results.result(int(at)) for at in series["contours/items"]]
    height, ratio = float(series["contours/height_cm"]), float(series["contours/pfv_per_pfa_s"])
    panels = [
        (method, series[f"contours/{method.key}"]) for method in results.methods if f"contours/{method.key}" in series
    ]
    methods = [method for method, _risk in panels]
    paint = partial(_paint, pieces, height, series["contours/breadth_cm"], series["contours/pfa_g"], panels)
    drawn = data_uri(draw(7, 3.6, paint, progress=progress), "image/svg+xml")
    alternative = ngettext(
        "Maps of the chance of overturning over breadth and PFA for a height of {height:.0f} cm ({methods}), with "
        "{n:,} piece on them; its chance is in the table of all pieces",
        "Maps of the chance of overturning over breadth and PFA for a height of {height:.0f} cm ({methods}), with "
        "{n:,} pieces on them; their chances are in the table of all pieces",
        sum(one.item.quantity for one in pieces),
        height=height,
        methods=_name(methods),
    )
    caption = (*_describe_figure(height, pieces, methods), *_describe_ratio(pieces[0], ratio, methods))
    return Figure(Image(drawn, alternative), " ".join(caption))


def _name(methods: Sequence["MethodInfo"]) -> str:
    return ", ".join(_(method.title) for method in methods)


def _describe_figure(height: float, pieces: Sequence[ItemResult], methods: Sequence["MethodInfo"]) -> Iterator[str]:
    yield _(
        "Chance of overturning of pieces {height:.0f} cm high by these methods: {methods}.",
        height=height,
        methods=_name(methods),
    )
    yield ngettext(
        "The symbol is the one free-standing piece within 10 % of this height, at its breadth and the PFA of the "
        "motion that governs it.",
        "The symbols are the {n:,} free-standing pieces within 10 % of this height, each at its breadth and the PFA of "
        "the motion that governs it.",
        sum(one.item.quantity for one in pieces),
    )
    yield _(
        "A symbol shows the class adopted for the piece, which may differ from the field it lies on: the fields are "
        "those of the formulas, for this height."
    )
    if any(one.apart for one in pieces):
        yield _(
            "White symbols show pieces that are counted apart: a pentagon is unconfirmed, a triangle that points down "
            "is by formula only."
        )
    yield _(
        "Names are those of the worst piece at each place, with the number of further rows there; names for which "
        "there is no room are left out."
    )


def _describe_ratio(worst: ItemResult, ratio: float, methods: Sequence["MethodInfo"]) -> Iterator[str]:
    """Say which PFV goes with a PFA under the methods that use it."""
    by_velocity = [method for method in methods if any(flag.startswith("pfv_") for flag in method.flags)]
    if not by_velocity:
        return
    switching = _name([method for method in by_velocity if method.ruled_by == "pfa"])
    if math.isnan(ratio):
        yield _(
            "PFV is not known for the worst of these pieces: the panel {methods} shows the largest chance that any PFV "
            "gives.",
            methods=switching,
        )
        return
    motion = worst.governing.motion
    yield _(
        "PFV grows with PFA, {ratio:.0f} cm/s for each g: the ratio of floor {floor} {axis}, whose motion governs the "
        "worst of these pieces. Methods that depend on it: {methods}.",
        ratio=(motion.pfv_cm_s or 0.0) / motion.pfa_g, floor=motion.floor, axis=motion.axis, methods=_name(by_velocity),
    )  # fmt: skip
    if switching:
        yield _(
            "Where a method changes from PFA to PFV, it jumps, which shows as a step: {methods}.", methods=switching
        )


def _paint(
    pieces: Sequence[ItemResult],
    height: float,
    breadth: FloatArray,
    pfa: FloatArray,
    panels: Sequence[Panel],
    figure: Any,
) -> None:
    """Paint a panel a method; the pieces at each place are the worst first."""
    places: dict[Place, list[ItemResult]] = {}
    for one in pieces:
        place = round(one.item.breadth_cm, 6), round(one.governing.motion.pfa_g, 6)
        places.setdefault(place, []).append(one)
    drawn = figure.subplots(1, len(panels), sharex=True, sharey=True, squeeze=False)[0]
    for axes, (method, risk) in zip(drawn, panels, strict=True):
        lines = paint_risk(axes, breadth, pfa, risk)
        paint_checked(axes, method, height)
        paint_pieces(axes, places)
        axes.set_xlim(*breadth[[0, -1]])
        axes.set_ylim(*pfa[[0, -1]])
        axes.set_title(_(method.title), fontsize=8, loc="left")
        axes.set_xlabel(_("breadth [cm]"), fontsize=8)
        axes.tick_params(labelsize=7)
        paint_names(axes, places, paint_chances(axes, lines, places))
    drawn[0].set_ylabel(_("PFA [g]"), fontsize=8)
    paint_legend(figure)
