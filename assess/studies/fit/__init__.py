"""Study `fit`: surfaces fitted to the chances by direct integration and ranked, and a bounded alternative with size.

The paper's section 4: equation (8) was chosen among surfaces by a program for surface fits, and fitted to the paper's
own integrations. Here the candidates are those of `surfaces`, and the integrations those of study `table2`.
"""

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np

from assess.report.figures.draw import draw
from assess.report.figures.risk_map import paint_legend, paint_risk
from assess.studies.agreement import rock_all
from assess.studies.buildings import LEVELS, RATIOS
from assess.studies.fit.fits import Alternative, Fits, fit_all
from assess.studies.fit.surfaces import CONSTANT, EQUATION_8, NEGLIGIBLE, LeftOut, Ranked
from assess.studies.studied_methods import (
    COEFFICIENTS,
    INTEGRATION,
    QUANTITIES,
    Fitted,
    FittedOn,
    Polynomial,
    Probit,
    Range,
    write_model,
)  # fmt: skip
from assess.studies.study import Finding, Options, Row, Study, Table, write_finding
from assess.units import GRAVITY

COLUMNS = (
    "place", "name", "equation", "coefficients", "r2", "adjusted_r2", "aic", "left_out_rmse", "left_out_spread",
    "level_with_the_best", "place_by_adjusted_r2", "place_by_aic", "condition", "ill_conditioned", "values",
)  # fmt: skip

SHOWN = 4
"""Candidates that the page lists, besides equation (8), the constant and that of the smallest error."""
LETTERS = {"a": (0, 0), "b": (1, 0), "c": (0, 1), "d": (2, 0), "e": (0, 2), "f": (1, 1)}
"""Of the coefficients of equation (8): the powers of their terms."""


def run(options: Options) -> Finding:
    """Fit and rank the models, and write the two that can be used as files."""
    fits = fit_all(rock_all(options.narrow(0.0, 0.9)), options.narrow(0.9, 1.0))
    return write_finding(
        "fit",
        collect(fits),
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
    cases, eighth = fits.counts.cases, fits.equation_8.surface
    ranges = {}
    for name, one in QUANTITIES.items():
        values = one.measure(cases)
        ranges[name] = Range(float(values.min()), float(values.max()), one.unit)
    chosen: list[tuple[str, str, Polynomial | Probit, LeftOut]] = [
        ("fitted_eq8", "Equation (8) fitted again", eighth.polynomial, eighth.left_out),
        ("fitted_probit", "Probit in PFA and PFV", fits.probit.probit, fits.probit.left_out),
    ]
    constant = fits.constant.surface.left_out.error
    for key, title, formula, left_out in chosen:
        fitted = FittedOn(data=data, error=left_out.error, spread=left_out.spread, constant=constant)
        yield Fitted(key=key, title=title, formula=formula, fitted=fitted, ranges=ranges)


def _paint(fits: Fits, figure: Any) -> None:
    """Paint the counterpart of Fig. 7: integration and the two models, each the mean over all channels and heights."""
    ratios, values = np.array(RATIOS), np.array(LEVELS) * GRAVITY
    places = [np.isclose(fits.points.x, x) & np.isclose(fits.counts.pfa, y) for y in values for x in ratios]
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


# ---------------------------------------------------------------- the page: every conclusion follows from the numbers


def collect(fits: Fits) -> dict[str, object]:
    """Return what the page shows."""
    best, values = fits.best.surface, dict(zip(EQUATION_8.powers, fits.equation_8.surface.coefficients, strict=True))
    named = {CONSTANT: "", EQUATION_8: " (eq. 8)", best.candidate: " (smallest error)"}
    return {
        "fits": fits, "surfaces": len(fits.ranked) - 1, "best": best.left_out,
        "eighth": fits.equation_8.surface.left_out, "constant": fits.constant.surface.left_out,
        "probit": fits.probit.left_out, "alone": fits.probit_without_pfv.left_out,
        "pfv_reduces": fits.probit.left_out.error < min(best.left_out.error, fits.probit_without_pfv.left_out.error),
        "level": sum(one.is_level for one in fits.ranked), "negligible": NEGLIGIBLE, "ratios": RATIOS, "levels": LEVELS,
        "listed": [
            (one, named.get(one.surface.candidate, ""))
            for one in fits.ranked
            if one.place <= SHOWN or one.surface.candidate in named
        ],
        "printed": {name: getattr(COEFFICIENTS, name) for name in LETTERS},
        "fitted": [values[powers] for powers in LETTERS.values()],
        "coefficients": _describe_coefficients(fits.probit), "models": list(_list_models(fits)),
    }  # fmt: skip


def _describe_coefficients(fitted: Alternative) -> list[dict[str, object]]:
    found: list[dict[str, object]] = []
    for name, letter in (("b0", "b₀"), ("b1", "b₁"), ("b2", "b₂")):
        value, *spread = (float(getattr(one, name)) for one in (fitted.probit, *fitted.without))
        found.append({"letter": letter, "value": value, "at_bound": name != "b0" and value == 0, "spread": spread})
    return found


def _list_models(fits: Fits) -> Iterator[tuple[str, int, LeftOut]]:
    for title, left_out in fits.published.items():
        yield f"{title} (not fitted)", 0, left_out
    named = {CONSTANT: "", EQUATION_8: " (equation (8) fitted again)", fits.best.surface.candidate: " (smallest error)"}
    for candidate, name in named.items():
        yield f"{candidate.name}{name}", len(candidate.powers), fits.find(candidate).surface.left_out
    yield "probit without PFV (b₀, b₁)", 2, fits.probit_without_pfv.left_out
    yield "probit (b₀, b₁, b₂)", 3, fits.probit.left_out


STUDY = Study(
    name="fit",
    order=60,
    title="Surfaces fitted and ranked, and a bounded alternative",
    of="section 4",
    run=run,
)
