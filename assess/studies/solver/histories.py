"""The motion of a block just below and just above the limits of a pulse, as in the paper's Fig. 2."""

import math
from collections.abc import Mapping, Sequence
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from assess.report.figures.draw import draw
from assess.studies.solver.pulses import (
    ALPHA,
    KERNEL,
    NEAR,
    ODE23S,
    OVERTURNED,
    RK45,
    SHOWN,
    Limit,
    Response,
    Solver,
    follow,
)
from assess.studies.studied_methods import FloatArray
from assess.studies.study import Options, Table

END, STEP = 5.4, 0.03
"""Histories: length and time step [s]."""

Paths = Mapping[tuple[Limit, float, Solver], FloatArray]
"""theta / alpha [-] by limit, side of it and solver."""


def follow_near(limits: Sequence[Limit], options: Options) -> Paths:
    """Rock the block `NEAR` limits, on either side, by the solvers of the figure."""
    return {
        (limit, side, solver): sample(follow(limit.case, limit.listed + side, solver, END))
        for (limit, side, solver), _ in options.each(list(product(limits, (-NEAR, NEAR), SHOWN)))
    }


def sample(response: Response) -> FloatArray:
    """Return theta / alpha at even times up to `END` [-]; NaN once the block has fallen, and 0 once it rests."""
    after = math.nan if response.overturned else 0.0
    theta = np.interp(np.arange(0, END, STEP), response.times, response.theta, right=after)
    return np.where(np.abs(theta) <= OVERTURNED, theta, math.nan) / ALPHA


def tabulate_histories(drawn: Sequence[Limit], paths: Paths) -> Table:
    """Return the histories as a table; empty once the block has fallen."""
    rows = []
    for limit in drawn:
        for side in (-NEAR, NEAR):
            amplitude = limit.listed + side
            for at, time in enumerate(np.arange(0, END, STEP).tolist()):
                theta = (float(paths[limit, side, solver][at]) for solver in SHOWN)
                ground = limit.case.shake(amplitude, time)
                cells = (None if one != one else one for one in theta)  # it has fallen
                rows.append((limit.case.equation, limit.listed, amplitude, time, ground, *cells))
    names = (f"theta_over_alpha_{solver.name.split()[-1].lower()}" for solver in SHOWN)
    return Table(
        columns=("equation", "listed_alpha_g", "amplitude_alpha_g", "time_s", "acceleration_g", *names), rows=rows
    )


COLOURS = {KERNEL: "#b9c4cc", RK45: "#1b4f72", ODE23S: "#db7133"}
WIDTHS = {KERNEL: 3.2, RK45: 1.3, ODE23S: 0.8}


def draw_histories(drawn: Sequence[Limit], paths: Paths) -> bytes:
    """Draw the pulses, and the responses near each limit, as SVG."""
    return draw(7, 7.5, partial(_paint, drawn, paths))


def _paint(drawn: Sequence[Limit], paths: Paths, figure: Any) -> None:
    """Paint Fig. 2 again: the pulses, and under them the responses near each limit; one column an equation."""
    columns = {name: [one for one in drawn if one.case.equation == name] for name in ("linear", "nonlinear")}
    panels = figure.subplots(4, 2, sharex=True, sharey="row")
    titles = "linear equation of slender blocks", "eq. 3 of the paper"
    for title, column, limits in zip(titles, panels.T, columns.values(), strict=True):
        _paint_pulses(column[0], limits)
        column[0].set_title(title, fontsize=8, loc="left")
        for axes, limit in zip(column[1:], limits, strict=True):
            _paint_responses(axes, limit, paths)
        column[-1].set_xlabel("time from the beginning of the sine [s]")
    for axes in panels.flat:
        axes.spines[["top", "right"]].set_visible(False)
    for row, name in enumerate(("acceleration / αg", *(("θ / α",) * 3))):
        panels[row, 0].set_ylabel(name)
    lines, names = panels[1, 0].get_legend_handles_labels()
    figure.legend(lines, names, loc="outside lower center", ncols=3, fontsize=7, frameon=False)


def _paint_pulses(axes: Any, limits: Sequence[Limit]) -> None:
    times = np.arange(0, END, STEP / 10)
    for limit in limits:
        values = [limit.case.shake(limit.listed, time) / ALPHA for time in times.tolist()]
        axes.plot(times, values, lw=0.8, color="#444444")
    axes.axhline(limits[0].case.threshold / ALPHA, lw=0.5, ls=":", color="#444444")


def _paint_responses(axes: Any, limit: Limit, paths: Paths) -> None:
    times = np.arange(0, END, STEP)
    for solver in SHOWN:
        for side, dash in ((-NEAR, "-"), (NEAR, "--")):
            name = solver.name if side < 0 else None
            style = {"color": COLOURS[solver], "lw": WIDTHS[solver], "ls": dash}
            axes.plot(times, paths[limit, side, solver], label=name, **style)
    low, high = (f"{limit.listed + side:.3f}" for side in (-NEAR, NEAR))
    axes.set_title(f"{low} αg (solid), {high} (dashed)", fontsize=7, loc="right")
    axes.set_ylim(-2.2, 2.2)
    axes.axhline(0, lw=0.4, color="#444444")
