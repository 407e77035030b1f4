"""Overturning limits under pulses: those of the table of limits, and how a solver finds them again."""

import math
from dataclasses import dataclass

from assess.studies._facts import read_facts
from assess.studies._pulses import Case, Response, Solver, follow

EXACT, KERNEL = Solver("DOP853", "DOP853", 1e-12, 1e-14), Solver("our kernel")
RK45, ODE23S = Solver("RK45", "RK45"), Solver("ODE23s", "ODE23s")
TIGHT = Solver("RK45 tight", "RK45", 1e-7, 1e-9)
LOOSE = Solver("RK45 loose", "RK45", 1e-3, 1e-6), Solver("ODE23s loose", "ODE23s", 1e-3, 1e-6)
"""At the tolerances that MATLAB takes where it is given none."""
SOLVERS = (EXACT, KERNEL, RK45, ODE23S, TIGHT, *LOOSE)
SHOWN = (KERNEL, RK45, ODE23S)
NEAR = 0.005
"""Verdicts and histories are those of amplitudes so far from a listed limit [alpha g]."""
SIDE, SPACING, WITHIN = 0.16, 0.02, 5e-7
"""A limit is looked for so far to either side of the listed one, so finely, and then found so closely [alpha g]."""


@dataclass(frozen=True, slots=True)
class Limit:
    """A limit of the table of limits [alpha g], as it is printed; the block overturns below it, or above."""

    case: Case
    printed: str
    over_below: bool

    @property
    def listed(self) -> float:
        """Its value [alpha g]."""
        return float(self.printed)

    @property
    def name(self) -> str:
        """Its pulse and its equation."""
        return f"{self.case.pulse.replace('_', '-')}, {self.case.equation}"


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """A limit as a solver finds it [alpha g], NaN if it does not; `changes` counts the verdict's changes around it.

    `below` and `above` are what the block does `NEAR` the listed limit.
    """

    limit: float
    changes: int
    below: Response
    above: Response


def read_limits() -> list[Limit]:
    """Return the limits of the table `facts/rocking_pulses.csv`."""
    rows = read_facts("rocking_pulses")
    cases = [Case(row["pulse"], row["equation"], float(row["frequency_ratio"])) for row in rows]
    return [Limit(case, row["limit"], row["below"] == "yes") for case, row in zip(cases, rows, strict=True)]


def find_limit(limit: Limit, solver: Solver) -> Found:
    """Find a limit: look at the verdicts around it, and bisect between the two that change as listed, nearest it."""
    count = round(SIDE / SPACING)
    amplitudes = [limit.listed + SPACING * at for at in range(-count, count + 1)]
    over = [follow(limit.case, one, solver).overturned for one in amplitudes]
    changes = [at for at in range(2 * count) if over[at] != over[at + 1]]
    right = [at for at in changes if over[at] == limit.over_below]
    found = math.nan
    if right:
        low = amplitudes[min(right, key=lambda at: abs(at + 0.5 - count))]
        found = bisect(limit, solver, low, low + SPACING)
    near = (follow(limit.case, limit.listed + side, solver) for side in (-NEAR, NEAR))
    return Found(found, len(changes), *near)


def bisect(limit: Limit, solver: Solver, low: float, high: float) -> float:
    """Return a limit between two amplitudes of which the lower one's verdict is that below it [alpha g]."""
    while high - low > WITHIN:
        middle = (low + high) / 2
        is_below = follow(limit.case, middle, solver).overturned == limit.over_below
        low, high = (middle, high) if is_below else (low, middle)
    return (low + high) / 2


def solve_half_sine(ratio: float) -> float:
    """Return the limit of the linear equation under one lobe of a sine [alpha g], in closed form, for w/p = `ratio`."""
    from scipy.optimize import brentq

    def excess(x: float) -> float:
        return x * math.exp(-(math.pi - math.asin(1 / x)) / ratio) + math.sqrt(x**2 - 1) - ratio

    return float(brentq(excess, 1.0, 2.0 + ratio, xtol=1e-14))
