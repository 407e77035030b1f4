"""Overturning limits under pulses: the published ones, and the same as found by each solver."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from assess.studies.solver.pulses import Case, Response, Solver, follow
from assess.studies.study import read_facts

EXACT, KERNEL = Solver("DOP853", "DOP853", 1e-12, 1e-14), Solver("our kernel")
RK45, ODE23S = Solver("RK45", "RK45"), Solver("ODE23s", "ODE23s")
TIGHT = Solver("RK45 tight", "RK45", 1e-7, 1e-9)
LOOSE = Solver("RK45 loose", "RK45", 1e-3, 1e-6), Solver("ODE23s loose", "ODE23s", 1e-3, 1e-6)
"""At the default tolerances of MATLAB."""
SOLVERS = (EXACT, KERNEL, RK45, ODE23S, TIGHT, *LOOSE)
SHOWN = (KERNEL, RK45, ODE23S)
NEAR = 0.005
"""Verdicts and histories are those at this distance from a listed limit [alpha g]."""
SIDE, SPACING, WITHIN = 0.16, 0.02, 5e-7
"""A limit is searched up to this distance from the listed one, at this spacing, to this accuracy [alpha g]."""
Check = Callable[[], None]


@dataclass(frozen=True, slots=True)
class Limit:
    """A published limit [alpha g], as printed; the block overturns below it, or above."""

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
    """A limit as a solver finds it [alpha g], NaN if it does not; `changes` counts changes of the verdict around it.

    `below` and `above` are the responses at the distance `NEAR` from the listed limit.
    """

    limit: float
    changes: int
    below: Response
    above: Response


def read_limits() -> list[Limit]:
    """Return the limits of the table `facts/rocking_pulses.csv`."""
    return [
        Limit(Case(row["pulse"], row["equation"], float(row["frequency_ratio"])), row["limit"], row["below"] == "yes")
        for row in read_facts("rocking_pulses")
    ]


def find_limit(limit: Limit, solver: Solver, check: Check = lambda: None) -> Found:
    """Find a limit by the verdicts around it, and bisection where they change as listed, nearest to the listed one.

    `check` is called before each run of the solver; it may raise CancelledError.
    """

    def respond(amplitude: float) -> Response:
        check()
        return follow(limit.case, amplitude, solver)

    count = round(SIDE / SPACING)
    amplitudes = [limit.listed + SPACING * at for at in range(-count, count + 1)]
    over = [respond(one).overturned for one in amplitudes]
    changes = [at for at in range(2 * count) if over[at] != over[at + 1]]
    right = [at for at in changes if over[at] == limit.over_below]
    found = math.nan
    if right:
        low = amplitudes[min(right, key=lambda at: abs(at + 0.5 - count))]
        high = low + SPACING
        while high - low > WITHIN:
            middle = (low + high) / 2
            low, high = (middle, high) if respond(middle).overturned == limit.over_below else (low, middle)
        found = (low + high) / 2
    return Found(found, len(changes), respond(limit.listed - NEAR), respond(limit.listed + NEAR))


def solve_half_sine(ratio: float) -> float:
    """Return the limit of the linear equation under one lobe of a sine [alpha g], in closed form, for w/p = `ratio`."""
    from scipy.optimize import brentq

    def excess(x: float) -> float:
        return x * math.exp(-(math.pi - math.asin(1 / x)) / ratio) + math.sqrt(x**2 - 1) - ratio

    return float(brentq(excess, 1.0, 2.0 + ratio, xtol=1e-14))
