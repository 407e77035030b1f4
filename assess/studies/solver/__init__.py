"""Study `solver`: overturning limits of a block under pulses by the paper's two solvers, by the kernel, and exactly.

The paper's section 2.1 and Fig. 2 compare ODE45 and ODE23s with Zhang and Makris (2001) and choose ODE23s.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from assess.report.figures.draw import draw
from assess.studies.solver.pulses import (
    ALPHA,
    ETA,
    EXACT,
    KERNEL,
    NEAR,
    ODE23S,
    OVERTURNED,
    RK45,
    SHOWN,
    SIDE,
    SOLVERS,
    TIGHT,
    Case,
    Found,
    Limit,
    P,
    Response,
    Solver,
    find_limit,
    follow,
    read_limits,
    solve_half_sine,
)
from assess.studies.studied_methods import FloatArray
from assess.studies.study import Finding, Options, Row, Study, Table, write_finding
from assess.units import GRAVITY

BANDS = tuple(round(1.25 + 0.25 * at, 2) for at in range(32))
"""Amplitudes of the scan for bands of overturning [alpha g]."""
BAND_COLUMNS = "equation", "amplitude_alpha_g", "solver", "overturned", "impacts"
LIMIT_COLUMNS = (
    "pulse", "equation", "frequency_ratio", "listed_alpha_g", "solver", "rtol", "atol", "limit_alpha_g",
    "less_listed_alpha_g", "less_exact_alpha_g", "changes", "overturned_below", "overturned_above",
    "impacts_below", "impacts_above", "evaluations_below", "evaluations_above",
)  # fmt: skip
Results = Mapping[Solver, Sequence[Found]]
"""The limits in the order of the table, by solver."""


def run(options: Options) -> Finding:
    """Find all limits by all solvers."""
    limits = read_limits()
    found = find_all(limits, options.narrow(0.0, 0.85))
    bands = find_bands(options.narrow(0.85, 0.95))
    drawn = [limit for limit in limits if limit.case.pulse == "one_sine"]
    paths = follow_near(drawn, options.narrow(0.95, 1.0))
    return write_finding(
        "solver",
        collect(limits, found, bands),
        tables={
            "solver-limits": Table(columns=LIMIT_COLUMNS, rows=list(_limit_rows(limits, found))),
            "solver-bands": Table(columns=BAND_COLUMNS, rows=bands),
            "solver-histories": tabulate_histories(drawn, paths),
        },
        figures={"solver-histories.svg": draw_histories(drawn, paths)},
    )


def collect(limits: Sequence[Limit], found: Results, bands: Sequence[Row]) -> dict[str, object]:
    """Return what the page shows."""
    exact, strongest = found[EXACT], max(one.limit for one in found[EXACT]) * ALPHA
    halves = [(limit, one) for limit, one in zip(limits, exact, strict=True) if limit.case.pulse == "half_sine"]
    return {
        "limits": limits, "found": found, "exact": exact, "shown": SHOWN,
        "EXACT": EXACT, "KERNEL": KERNEL, "RK45": RK45, "ODE23S": ODE23S, "TIGHT": TIGHT,
        "p": P, "alpha": ALPHA, "eta": ETA, "height": 3 * GRAVITY / (2 * P**2) * math.cos(ALPHA),
        "errors": {solver: _find_errors(found, solver) for solver in found},
        "worst": {solver: _find_worst(found, solver) for solver in found},
        "cost": {solver: _count_evaluations(own) for solver, own in found.items()},
        "right": {solver: _count_right(limits, own) for solver, own in found.items()},
        "near": NEAR, "side": SIDE,
        "missing": {solver.name: sum(math.isnan(one.limit) for one in own) for solver, own in found.items()},
        "closed": max((abs(one.limit - solve_half_sine(limit.case.ratio)) for limit, one in halves), default=0.0),
        "off": [
            (limit.printed, limit.listed - one.limit)
            for limit, one in zip(limits, exact, strict=True)
            if abs(limit.listed - one.limit) > 0.5 * 10.0 ** -len(limit.printed.partition(".")[2])
        ],
        "bands": BANDS, "other": _find_other_bands(bands),
        "closer": {"ode23s": _count_closer(found, ODE23S, RK45), "tight": _count_closer(found, TIGHT, ODE23S)},
        "fastest": P * (1 + strongest**2) ** 0.25,
    }  # fmt: skip


def find_all(limits: Sequence[Limit], options: Options) -> Results:
    """Find all limits by each solver."""
    return {
        solver: [find_limit(limit, solver, partial(one.report_share, 0.0)) for limit, one in part.each(limits)]
        for solver, part in options.each(SOLVERS)
    }


def find_bands(options: Options) -> list[Row]:
    """Return equation, amplitude [alpha g], solver, verdict and impacts under one-sine pulses from weak to strong."""
    rows: list[Row] = []
    for (equation, amplitude, solver), _ in options.each(list(product(("linear", "nonlinear"), BANDS, SOLVERS))):
        one = follow(Case("one_sine", equation, 5.0), amplitude, solver)
        rows.append((equation, amplitude, solver.name, one.overturned, one.impacts if one.overturned else None))
    return rows


def _limit_rows(limits: Sequence[Limit], found: Results) -> Iterator[Row]:
    for solver, own in found.items():
        for limit, one, exact in zip(limits, own, found[EXACT], strict=True):
            yield (
                limit.case.pulse, limit.case.equation, limit.case.ratio, limit.listed,
                solver.name, *((solver.rtol, solver.atol) if solver.method else (None, None)),
                one.limit, one.limit - limit.listed, one.limit - exact.limit, one.changes,
                one.below.overturned, one.above.overturned, one.below.impacts, one.above.impacts,
                *((one.below.evaluations, one.above.evaluations) if solver.method else (None, None)),
            )  # fmt: skip


def _find_errors(found: Results, solver: Solver) -> list[float]:
    """Return the differences of a solver's limits from the exact ones [alpha g]."""
    return [one.limit - exact.limit for one, exact in zip(found[solver], found[EXACT], strict=True)]


def _find_worst(found: Results, solver: Solver) -> float:
    return max((abs(one) for one in _find_errors(found, solver) if not math.isnan(one)), default=math.nan)


def _count_evaluations(found: Sequence[Found]) -> float:
    return float(np.mean([side.evaluations for one in found for side in (one.below, one.above)]))


def _count_right(limits: Sequence[Limit], own: Sequence[Found]) -> int:
    return sum(
        (one.below.overturned == limit.over_below) + (one.above.overturned != limit.over_below)
        for limit, one in zip(limits, own, strict=True)
    )


def _count_closer(found: Results, one: Solver, other: Solver) -> int:
    pairs = zip(_find_errors(found, one), _find_errors(found, other), strict=True)
    return sum(abs(a) < abs(b) for a, b in pairs)


def _find_other_bands(bands: Sequence[Row]) -> list[str]:
    seen = {tuple(row[:3]): tuple(row[3:]) for row in bands}
    return [
        f"{name} at {amplitude} ({equation})"
        for equation, amplitude, name in seen
        if seen[equation, amplitude, name] != seen[equation, amplitude, EXACT.name]
    ]


# ---------------------------------------------------------------- histories near the limits, as in Fig. 2

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


STUDY = Study(
    name="solver",
    order=20,
    title="Solvers: the overturning limits under a pulse",
    of="section 2.1 and Fig. 2",
    run=run,
)
