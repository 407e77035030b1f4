"""Study `fit`: surfaces fitted to the chances by direct integration and ranked, and a bounded alternative with size.

The paper's section 4: equation (8) was chosen among surfaces by a program for surface fits, and fitted to its own
integrations. Here the candidates are those of `assess.studies._surfaces`, and the integrations those of study `table2`.
"""

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np

from assess.methods._fitted import Fitted, write_model
from assess.methods._fitted_model import Polynomial, Probit
from assess.methods._method import BoolArray, FloatArray, Range
from assess.report.figures.draw import draw
from assess.report.figures.risk_map import paint_legend, paint_risk
from assess.studies._fit_page import describe, say_failures, summarise
from assess.studies._fits import Fits, fit_all
from assess.studies._formulas import INTEGRATION
from assess.studies._judged import rock_all
from assess.studies._study import Finding, Options, Row, Study, Table
from assess.studies._surfaces import LeftOut, Ranked
from assess.studies._trials import LEVELS, RATIOS
from assess.units import GRAVITY, LENGTH, VELOCITY

COLUMNS = (
    "place", "name", "equation", "coefficients", "r2", "adjusted_r2", "aic", "left_out_rmse", "left_out_spread",
    "level_with_the_best", "place_by_adjusted_r2", "place_by_aic", "condition", "ill_conditioned", "values",
)  # fmt: skip


def run(options: Options) -> Finding:
    """Fit, rank, and write the two models as files."""
    fits = fit_all(rock_all(options))
    return Finding(
        page=list(describe(fits)),
        summary=[summarise(fits)],
        failures=list(say_failures(fits)),
        tables={"fit": Table(columns=COLUMNS, rows=[_row(one) for one in fits.ranked])},
        figures={"fit.svg": draw(7, 2.7, partial(_paint, fits))},
        files={f"{one.key}.toml": write_model(one) for one in build_models(fits, options)},
    )


def _row(one: Ranked) -> Row:
    surface = one.surface
    return (
        one.place, surface.candidate.name, surface.candidate.equation, len(surface.coefficients), surface.r2,
        surface.adjusted_r2, surface.aic, surface.left_out.error, surface.left_out.spread, one.is_level,
        one.place_adjusted_r2, one.place_aic, surface.condition, surface.is_ill_conditioned,
        " ".join(map(repr, surface.coefficients)),
    )  # fmt: skip


def build_models(fits: Fits, options: Options) -> Iterator[Fitted]:
    """Yield the models to be saved: equation (8) fitted again, and the probit."""
    data = f"{len(fits.buildings)} instrumented buildings, {options.runs} motions a channel, seed {options.seed}"
    counts, eighth = fits.counts, fits.equation_8.surface
    chosen: list[tuple[str, str, Polynomial | Probit, LeftOut]] = [
        ("fitted_eq8", "Equation (8) fitted again", eighth.polynomial, eighth.left_out),
        ("fitted_probit", "Probit in PFA and PFV", fits.probit.probit, fits.probit.left_out),
    ]
    for key, title, formula, left_out in chosen:
        yield Fitted(
            key=key, title=title, fitted_on=data, formula=formula,
            breadth_to_height=_span(fits.points.x, 1, ""), pfa=_span(counts.pfa, GRAVITY, "g"),
            height=_span(counts.height, LENGTH["cm"], "cm"), pfv=_span(counts.pfv, VELOCITY["cm/s"], "cm/s"),
            pfv_to_pfa=_span(counts.pfv / counts.pfa, 1, "s"),
            error=left_out.error, error_spread=left_out.spread, error_constant=fits.constant.surface.left_out.error,
        )  # fmt: skip


def _span(values: FloatArray, unit: float, name: str) -> Range:
    return Range(float(values.min() / unit), float(values.max() / unit), name)


def _paint(fits: Fits, figure: Any) -> None:
    """Paint Fig. 7 again: what was fitted to beside the two models, each the mean over all channels and heights."""
    ratios, values = np.array(RATIOS), np.array(LEVELS) * GRAVITY
    places = [_near(fits, one, other) for other in values for one in ratios]
    surface = fits.equation_8.surface.predict(fits.points.x, fits.points.y)
    panels = {
        INTEGRATION: fits.points.z,
        "equation (8), fitted here": np.clip(surface, 0, 1),
        "probit": fits.probit.probit.evaluate(fits.counts.cases),
    }
    for axes, (name, risk) in zip(figure.subplots(1, 3, sharex=True, sharey=True), panels.items(), strict=True):
        means = np.array([risk[place].mean() for place in places])
        paint_risk(axes, ratios, values / GRAVITY, means.reshape(values.size, ratios.size))
        axes.set_title(name, fontsize=8, loc="left")
        axes.set_xlabel("B/H [-]", fontsize=7)
        axes.tick_params(labelsize=6)
    figure.axes[0].set_ylabel("PFA [g]", fontsize=7)
    paint_legend(figure, has_checked=False)


def _near(fits: Fits, x: float, y: float) -> BoolArray:
    return np.isclose(fits.points.x, x) & np.isclose(fits.counts.pfa, y)


STUDY = Study(
    name="fit",
    order=60,
    title="Surfaces fitted and ranked, and a bounded alternative",
    of="section 4",
    run=run,
)
