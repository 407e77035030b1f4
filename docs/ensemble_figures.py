"""The figure of generated motions: how an ensemble meets its target."""

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.motion.generate import Generator
from assess.motion.spectrum import build_periods, response_spectrum
from assess.report.figures.draw import draw
from assess.units import GRAVITY

TICKS = (0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10)
TARGET, MEAN, ONE = "#000000", "#b03a2e", "#c8c8c8"


def draw_ensemble(generator: Generator, title: str, kind: str = "svg") -> bytes:
    """Draw the target, every realisation's 5 % spectrum and their mean; beside it the record and three realisations."""
    return draw(10, 4.6, partial(_paint_ensemble, generator, title), kind)


def _paint_ensemble(generator: Generator, title: str, figure: Any) -> None:
    left, right = figure.subfigures(1, 2, width_ratios=(1.25, 1))
    target, motions = generator.target, generator.realise()
    _paint_spectra(left.subplots(), generator, motions)
    left.suptitle(title.replace("$", r"\$"), x=0.02, ha="left", fontsize=9)
    recorded = [] if target.acceleration is None else [("record", target.acceleration)]
    series = [*recorded, *((f"realisation {number + 1}", motions[number]) for number in range(3))]
    for axes, (name, values) in zip(
        right.subplots(len(series), 1, sharex=True, sharey=True, squeeze=False)[:, 0], series, strict=True
    ):
        times = np.arange(values.size) * generator.phases.grid.time_step
        axes.plot(times, values / GRAVITY, color=TARGET if name == "record" else "#666666", linewidth=0.5)
        axes.set_title(f"{name}: PFA {np.abs(values).max() / GRAVITY:.3f} g", loc="left", fontsize=7)
        axes.margins(x=0)
        axes.set_ylabel("[g]")
    axes.set_xlabel("time [s]")


def _paint_spectra(axes: Any, generator: Generator, motions: NDArray[Any]) -> None:
    fit = generator.fit
    periods = build_periods(0.03, 10.0, 250)
    spectra = response_spectrum(motions, generator.phases.grid.time_step, periods).pseudo / GRAVITY
    axes.plot(periods, spectra.T, color=ONE, linewidth=0.4)
    axes.plot([], [], color=ONE, label=f"each of {len(motions)} realisations")
    target = generator.target.ordinates(periods, generator.phases.grid.time_step) / GRAVITY
    axes.plot(periods, target, color=TARGET, linewidth=1.6, label="target")
    axes.plot(periods, spectra.mean(axis=0), color=MEAN, linewidth=1.2, linestyle="--", label="mean")
    _dress(axes)
    axes.set_ylabel("5 % pseudo-acceleration [g]")
    if fit is not None:
        axes.axvspan(0.05, fit.matched_to, color="#f2f2f2", zorder=-1)
        words = (
            f"0.05 to {fit.matched_to:.1f} s: mean within {fit.mean_deviation:.1%} on average, at most "
            f"{abs(fit.worst_deviation):.1%} at {fit.worst_period:.2f} s\nPFA {fit.pfa_ratio:.2f} times the target's "
            f"(± {fit.pfa_scatter:.2f})"
        )
        words += f", PFV {fit.pfv_ratio:.2f} (± {fit.pfv_scatter:.2f})" if fit.pfv_ratio == fit.pfv_ratio else ""
        axes.set_title(words, fontsize=7, loc="left")
    axes.legend(fontsize=7, frameon=False)


def _dress(axes: Any) -> None:
    axes.set_xscale("log")
    axes.set_xticks(TICKS, [f"{tick:g}" for tick in TICKS])
    axes.minorticks_off()
    axes.set_xlim(0.03, 10)
    axes.set_ylim(bottom=0)
    axes.set_xlabel("period [s]")
    axes.grid(visible=True, color="#e0e0e0", linewidth=0.5)
