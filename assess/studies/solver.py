"""Study `solver`: overturning limits of a block under pulses by the paper's two solvers, by our kernel, and exactly.

The paper's section 2.1 and Fig. 2 hold ODE45 and ODE23s against Zhang and Makris (2001) and choose ODE23s.
"""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from assess.studies import _pulses
from assess.studies._histories import draw_histories, follow_near, tabulate_histories
from assess.studies._limits import (
    EXACT,
    KERNEL,
    NEAR,
    ODE23S,
    RK45,
    SHOWN,
    SIDE,
    SOLVERS,
    TIGHT,
    Found,
    Limit,
    find_limit,
    read_limits,
    solve_half_sine,
)
from assess.studies._pulses import ALPHA, Case, Solver, follow
from assess.studies._study import Finding, Options, Row, Study, Table, table_lines
from assess.units import GRAVITY

BANDS = tuple(round(1.25 + 0.25 * at, 2) for at in range(32))
"""Amplitudes of the coarse look at the bands [alpha g]."""
BAND_COLUMNS = "equation", "amplitude_alpha_g", "solver", "overturned", "impacts"


def run(options: Options) -> Finding:
    """Find all limits by all solvers."""
    limits, found = read_limits(), {}
    for solver in SOLVERS:
        options.tell(f"limits by {solver.name}")
        found[solver] = [find_limit(limit, solver) for limit in limits]
    bands = find_bands()
    drawn = [limit for limit in limits if limit.case.pulse == "one_sine"]
    options.tell("histories")
    paths = follow_near(drawn)
    return Finding(
        page=list(_describe(limits, found, bands)),
        summary=list(_summarise(found)),
        tables={
            "solver-limits": _tabulate(limits, found),
            "solver-bands": Table(columns=BAND_COLUMNS, rows=bands),
            "solver-histories": tabulate_histories(drawn, paths),
        },
        figures={"solver-histories.svg": draw_histories(drawn, paths)},
    )


def find_bands() -> list[Row]:
    """Return equation, amplitude [alpha g], solver, verdict and impacts under one-sine pulses from weak to strong."""
    rows: list[Row] = []
    for equation in ("linear", "nonlinear"):
        for amplitude in BANDS:
            for solver in SOLVERS:
                one = follow(Case("one_sine", equation, 5.0), amplitude, solver)
                rows.append((equation, amplitude, solver.name, one.overturned, one.impacts if one.overturned else None))
    return rows


# ---------------------------------------------------------------- what is told


def _find_errors(found: Mapping[Solver, Sequence[Found]], solver: Solver) -> list[float]:
    """How far a solver's limits are from the exact ones [alpha g]."""
    return [one.limit - exact.limit for one, exact in zip(found[solver], found[EXACT], strict=True)]


def _count_right(limits: Sequence[Limit], found: Sequence[Found]) -> int:
    """How many verdicts `NEAR` the published limits are as published."""
    return sum(
        (one.below.overturned == limit.over_below) + (one.above.overturned != limit.over_below)
        for limit, one in zip(limits, found, strict=True)
    )


def _count_evaluations(found: Sequence[Found]) -> float:
    return float(np.mean([side.evaluations for one in found for side in (one.below, one.above)]))


def _describe(limits: Sequence[Limit], found: Mapping[Solver, Sequence[Found]], bands: Sequence[Row]) -> Iterator[str]:
    height = 3 * GRAVITY / (2 * _pulses.P**2) * math.cos(ALPHA)
    yield (
        f"The block of Fig. 2, p = {_pulses.P} rad/s and alpha = {ALPHA} rad, under one whole sine of w/p = 5 after "
        'Zhang and Makris (2001), and under half-sines, whose limits have a closed form. "H=0.9m" in the paper is '
        f"taken for a restitution of {_pulses.ETA}: p means a height of {height:.2f} m. RK45 has the formulas of "
        "ODE45; ODE23s (low order, for stiff equations) is written here after its publication. Limits in alpha g, and "
        "how far others are from the exact ones (DOP853), in millionths:"
    )
    yield ""
    yield from _describe_limits(limits, found)
    yield ""
    yield from _describe_solvers(limits, found)
    yield ""
    if missing := describe_missing(found):
        yield missing
        yield ""
    yield f"{_describe_list(limits, found[EXACT])} {_describe_bands(bands)}"
    yield ""
    yield _conclude(found)


def _describe_list(limits: Sequence[Limit], exact: Sequence[Found]) -> str:
    """Tell how DOP853 compares with the closed form, and which listed limits are off in their last digit."""
    pairs = list(zip(limits, [one.limit for one in exact], strict=True))
    halves = [(limit.case.ratio, value) for limit, value in pairs if limit.case.pulse == "half_sine"]
    closed = max(abs(value - solve_half_sine(ratio)) for ratio, value in halves)
    off = [
        f"{limit.printed} ({limit.listed - value:+.4f})"
        for limit, value in pairs
        if abs(limit.listed - value) > 0.5 * 10.0 ** -len(limit.printed.partition(".")[2])
    ]
    return (
        f"DOP853 is within {closed:.0e} of the closed form. Listed limits off by more than half of their last digit: "
        f"{', '.join(off) or 'none'}."
    )


def _conclude(found: Mapping[Solver, Sequence[Found]]) -> str:
    def count_closer(one: Solver, other: Solver) -> str:
        pairs = list(zip(_find_errors(found, one), _find_errors(found, other), strict=True))
        return f"{sum(abs(a) < abs(b) for a, b in pairs)} of {len(pairs)}"

    cost = {solver: _count_evaluations(own) for solver, own in found.items()}
    strongest = max(one.limit for one in found[EXACT]) * ALPHA
    fastest = _pulses.P * (1 + strongest**2) ** 0.25
    return (
        f"The paper picked ODE23s. At its tolerances that comes closer than RK45 at {count_closer(ODE23S, RK45)} "
        f"limits, for {cost[ODE23S] / cost[RK45]:.1f} times the evaluations. RK45 a hundred times tighter comes closer "
        f"than ODE23s at {count_closer(TIGHT, ODE23S)}, for {cost[TIGHT] / cost[ODE23S]:.2f} times its evaluations. "
        "The tolerances decide, more than the kind of solver: between impacts the equation is not stiff (eigenvalues "
        f"up to {fastest:.1f} per second). Loose are the tolerances that MATLAB takes where none are given."
    )


def _describe_limits(limits: Sequence[Limit], found: Mapping[Solver, Sequence[Found]]) -> Iterator[str]:
    rows = []
    for at, limit in enumerate(limits):
        exact = found[EXACT][at]
        fall = exact.below if limit.over_below else exact.above
        apart = (_millionths(found[solver][at].limit - exact.limit) for solver in SHOWN)
        turns = f"falls {'below' if limit.over_below else 'above'}, {fall.impacts} impact{'s' * (fall.impacts != 1)}"
        rows.append((limit.name, f"{limit.case.ratio:g}", limit.printed, f"{exact.limit:.6f}", *apart, turns))
    yield from table_lines(
        ("pulse, equation", "w/p", "listed", "exact", *(one.name for one in SHOWN), "the block"), rows
    )  # fmt: skip


def _describe_solvers(limits: Sequence[Limit], found: Mapping[Solver, Sequence[Found]]) -> Iterator[str]:
    rows = []
    for solver in SOLVERS:
        own = found[solver]
        tolerances = f"{solver.rtol:g}, {solver.atol:g}" if solver.method else "-"
        cost = f"{_count_evaluations(own):.0f}" if solver.method else "-"
        worst = f"{_find_worst(found, solver):.6f}" if solver != EXACT else "-"
        rows.append((solver.name, tolerances, worst, f"{_count_right(limits, own)} of {2 * len(limits)}", cost))
    yield from table_lines(
        ("solver", "rtol, atol", "farthest off [alpha g]", f"right verdicts at {NEAR} from the limit",
         "evaluations a run"), rows
    )  # fmt: skip


def _millionths(value: float) -> str:
    return "not found" if math.isnan(value) else f"{round(1e6 * value):+d}"


def _find_worst(found: Mapping[Solver, Sequence[Found]], solver: Solver) -> float:
    """How far a solver's farthest limit is from the exact one [alpha g]; those that it does not find are left out."""
    return max((abs(one) for one in _find_errors(found, solver) if not math.isnan(one)), default=math.nan)


def describe_missing(found: Mapping[Solver, Sequence[Found]]) -> str:
    """Tell how many limits are not found within `SIDE` of the listed ones, and by whom; "" where all are."""
    counts = {solver.name: sum(math.isnan(one.limit) for one in own) for solver, own in found.items()}
    told = ", ".join(f"{count} by {name}" for name, count in counts.items() if count)
    return f"Not found within {SIDE:g} alpha g of the listed limits, and left out: {told}." if told else ""


def _describe_bands(bands: Sequence[Row]) -> str:
    """Tell what the coarse look at amplitudes shows, and who sees it otherwise."""
    seen = {tuple(row[:3]): tuple(row[3:]) for row in bands}
    other = [
        f"{name} at {amplitude} ({equation})"
        for equation, amplitude, name in seen
        if seen[equation, amplitude, name] != seen[equation, amplitude, EXACT.name]
    ]
    return (
        f"Verdicts are not monotone: safe, over with an impact, safe, over without. At {len(BANDS)} amplitudes from "
        f"{BANDS[0]:g} to {BANDS[-1]:g} alpha g these differ from DOP853's: {', '.join(other) or 'none'}."
    )


def _summarise(found: Mapping[Solver, Sequence[Found]]) -> Iterator[str]:
    worst = {solver: _find_worst(found, solver) for solver in SOLVERS}
    cost = {solver: f"{_count_evaluations(own):,.0f}" for solver, own in found.items()}
    missing = describe_missing(found)
    yield (
        "Solvers: at the paper's tolerances ODE23s finds the overturning limits under pulses within "
        f"{worst[ODE23S]:.4f} alpha g, RK45 (ODE45) within {worst[RK45]:.4f} and our kernel within "
        f"{worst[KERNEL]:.6f}. RK45 a hundred times tighter finds them within {worst[TIGHT]:.6f}, for {cost[TIGHT]} "
        f"evaluations a run where ODE23s takes {cost[ODE23S]}.{' ' * bool(missing)}{missing}"
    )


# ---------------------------------------------------------------- files


def _tabulate(limits: Sequence[Limit], found: Mapping[Solver, Sequence[Found]]) -> Table:
    rows = [
        (
            limit.case.pulse, limit.case.equation, limit.case.ratio, limit.listed,
            solver.name, *((solver.rtol, solver.atol) if solver.method else (None, None)),
            one.limit, one.limit - limit.listed, one.limit - exact.limit, one.changes,
            one.below.overturned, one.above.overturned, one.below.impacts, one.above.impacts,
            *((one.below.evaluations, one.above.evaluations) if solver.method else (None, None)),
        )
        for solver in SOLVERS
        for limit, one, exact in zip(limits, found[solver], found[EXACT], strict=True)
    ]  # fmt: skip
    return Table(
        columns=(
            "pulse", "equation", "frequency_ratio", "listed_alpha_g", "solver", "rtol", "atol", "limit_alpha_g",
            "less_listed_alpha_g", "less_exact_alpha_g", "changes", "overturned_below", "overturned_above",
            "impacts_below", "impacts_above", "evaluations_below", "evaluations_above",
        ),
        rows=rows,
    )  # fmt: skip


STUDY = Study(
    name="solver",
    order=20,
    title="Solvers: the overturning limits under a pulse",
    of="section 2.1 and Fig. 2",
    run=run,
)
