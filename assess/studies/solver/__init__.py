"""Study `solver`: overturning limits of a block under pulses by the paper's two solvers, by the kernel, and exactly.

The paper's section 2.1 and Fig. 2 compare ODE45 and ODE23s with Zhang and Makris (2001) and choose ODE23s. The block is
that of Fig. 2, whose overturning limits are published: those of the linear equation of slender blocks; eq. 3 of the
paper is nonlinear. Amplitudes are in alpha g. Time runs from the zero of the sine; the block starts where the sine
reaches its threshold.

Reference: Zhang J, Makris N (2001). Rocking response of free-standing blocks under cycloidal pulses. Journal of
Engineering Mechanics 127(5):473-483.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from assess.arrays import FloatArray
from assess.report.figures.draw import draw
from assess.studies.study import Finding, Options, Row, Study, Table, read_facts, write_finding
from assess.units import GRAVITY

P, ALPHA, ETA = 2.14, 0.25, 0.9
"""The block: frequency parameter [rad/s], critical angle [rad] and restitution [-]."""
SLENDER = 1e-3
"""Critical angle [rad] at which the kernel, which integrates eq. 3 only, represents the linear equation."""
SAMPLES = 4000
"""Samples of a pulse for the kernel."""
OVERTURNED, REST = math.pi / 2, 1e-5
"""Rotation of a fallen block [rad]; a block rests once its next hop would be lower than this share of alpha."""
FIRST, LONGEST = 1e-4, 60.0
"""First step after a start or an impact, and longest time until an impact or the fall [s]."""
MOST_IMPACTS = 1000
"""More impacts than that are taken for an error of the solver."""
POINT = 0.005
"""Time step of a stored path [s]."""


@dataclass(frozen=True, slots=True)
class Case:
    """An equation under a pulse: "one_sine" is a whole sine, "half_sine" one lobe of it; `ratio` is w/p [-]."""

    pulse: str
    equation: str
    ratio: float

    @property
    def is_linear(self) -> bool:
        """Whether the equation is that of slender blocks."""
        return self.equation == "linear"

    @property
    def omega(self) -> float:
        """Circular frequency w [rad/s]."""
        return self.ratio * P

    @property
    def end(self) -> float:
        """End of the pulse [s]."""
        return (2 if self.pulse == "one_sine" else 1) * math.pi / self.omega

    @property
    def threshold(self) -> float:
        """Acceleration beyond which the block rocks [g]."""
        return ALPHA if self.is_linear else math.tan(ALPHA)

    def shake(self, amplitude: float, time: float) -> float:
        """Return the acceleration of the base [g]."""
        return amplitude * ALPHA * math.sin(self.omega * time) if time < self.end else 0.0

    def accelerate(self, phi: float, push: float) -> float:
        """Return phi'' [rad/s2] at phi = |theta|, where `push` is the acceleration of the base times sgn(theta) [g]."""
        if self.is_linear:
            return -(P**2) * (ALPHA - phi + push)
        return -(P**2) * (math.sin(ALPHA - phi) + push * math.cos(ALPHA - phi))  # Equation (3)

    def start(self, amplitude: float, time: float) -> float:
        """Return when a block that rests at `time` starts to rock, if for more than an instant [s]; else infinity."""
        if amplitude * ALPHA <= self.threshold:
            return math.inf
        first, half = math.asin(self.threshold / (amplitude * ALPHA)) / self.omega, math.pi / self.omega
        for lobe in (0.0, half):
            if lobe < 0.999 * self.end and time < lobe + half - first - FIRST:
                return max(time, lobe + first)
        return math.inf


@dataclass(frozen=True, slots=True)
class Solver:
    """A solver of scipy, or "ODE23s", and its tolerances; without a method, the kernel of `assess.rocking`."""

    name: str
    method: str = ""
    rtol: float = 1e-5
    atol: float = 1e-7


@dataclass(slots=True, eq=False)
class Response:
    """The response of a block.

    * `impacts`: impacts until the outcome was certain: |theta| reached pi/2, or it can no longer.
    * `evaluations`: of eq. 3, including those for derivatives; 0 for the kernel.
    * `times`, `theta` (t,): path [s, rad], if required; it ends with the fall, or at rest.
    """

    overturned: bool = False
    impacts: int = 0
    evaluations: int = 0
    times: FloatArray = field(default_factory=lambda: np.zeros(1))
    theta: FloatArray = field(default_factory=lambda: np.zeros(1))


def follow(case: Case, amplitude: float, solver: Solver, until: float = 0.0) -> Response:
    """Rock the block under a pulse until it has fallen, or until it can no longer fall and `until` [s] is past.

    Raises ArithmeticError if it neither strikes its base nor falls within a minute, or its impacts do not end.
    """
    if not solver.method:
        return _follow_by_kernel(case, amplitude, until)
    from scipy.integrate import solve_ivp

    from assess.studies.solver.ode23s import Ode23s

    response, edge, velocity = Response(), -1.0, 0.0
    time, depth = case.start(amplitude, 0.0), ALPHA**2 / 2 if case.is_linear else 1 - math.cos(ALPHA)

    def rates(time: float, state: FloatArray) -> tuple[float, float]:
        response.evaluations += 1
        phi, speed = state.tolist()
        return speed, case.accelerate(phi, edge * case.shake(amplitude, time))

    while time < math.inf and (time < max(until, case.end) or velocity**2 / 2 >= P**2 * depth):  # it can still fall
        span = (time, time + LONGEST)  # from a start or an impact to the next impact, or to the fall
        found = solve_ivp(
            rates, span, [0.0, velocity], Ode23s if solver.method == "ODE23s" else solver.method, rtol=solver.rtol,
            atol=solver.atol, first_step=FIRST, events=[_strike, _fall], dense_output=until > 0,
        )  # fmt: skip
        if found.status != 1:
            raise ArithmeticError(f"{solver.name} at {amplitude:g} alpha g: {found.message}")
        since, time, velocity = time, float(found.t[-1]), float(found.y[1, -1])
        if until > 0:
            points = np.append(np.arange(since, time, POINT), time)
            response.times = np.append(response.times, points)
            response.theta = np.append(response.theta, edge * found.sol(points)[0])
        if found.y[0, -1] > ALPHA:
            response.overturned = True
            break
        response.impacts += 1
        if response.impacts > MOST_IMPACTS:
            raise ArithmeticError(f"{solver.name} at {amplitude:g} alpha g: its impacts do not end")
        edge, velocity = -edge, -ETA * velocity
        ground = case.shake(amplitude, time)
        if velocity**2 < -2 * case.accelerate(0.0, edge * ground) * REST * ALPHA:
            time, velocity = case.start(amplitude, time), 0.0
            edge = -math.copysign(1.0, case.shake(amplitude, time))
    return response


def _strike(_time: float, state: FloatArray) -> float:
    return float(state[0])


def _fall(_time: float, state: FloatArray) -> float:
    return float(state[0]) - OVERTURNED


for _event, _direction in ((_strike, -1), (_fall, 1)):
    _event.terminal, _event.direction = True, _direction  # type: ignore[attr-defined]  # read by `solve_ivp`


def _follow_by_kernel(case: Case, amplitude: float, until: float) -> Response:
    """Rock the block by `assess.rocking`; for the linear equation, a block so slender that the difference vanishes."""
    from assess.rocking.ensemble import follow_block

    alpha = SLENDER if case.is_linear else ALPHA
    acceleration = amplitude * (math.tan(alpha) if case.is_linear else alpha)
    step = case.end / SAMPLES
    phases = np.linspace(0, case.omega * case.end, SAMPLES + 1)
    ground = np.append(acceleration * np.sin(phases), np.zeros(math.ceil(max(0.0, until - case.end) / step)))
    ground[SAMPLES] = 0.0
    diagonal = 3 * GRAVITY / (2 * P**2)  # of r = 3 g / (4 p2)
    sizes = diagonal * math.sin(alpha), diagonal * math.cos(alpha)
    one = follow_block(*sizes, ground * GRAVITY, step, restitution=ETA)
    return Response(one.overturned, one.impacts, times=one.times, theta=one.theta * (ALPHA / alpha))


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
    found = {
        solver: [find_limit(limit, solver, partial(one.report_share, 0.0)) for limit, one in part.each(limits)]
        for solver, part in options.narrow(0.0, 0.85).each(SOLVERS)
    }
    bands: list[Row] = []  # under one-sine pulses from weak to strong
    every = list(product(("linear", "nonlinear"), BANDS, SOLVERS))
    for (equation, amplitude, solver), _ in options.narrow(0.85, 0.95).each(every):
        one = follow(Case("one_sine", equation, 5.0), amplitude, solver)
        bands.append((equation, amplitude, solver.name, one.overturned, one.impacts if one.overturned else None))
    drawn = [limit for limit in limits if limit.case.pulse == "one_sine"]
    paths = follow_near(drawn, options.narrow(0.95, 1.0))
    rows = [
        (
            limit.case.pulse, limit.case.equation, limit.case.ratio, limit.listed,
            solver.name, *((solver.rtol, solver.atol) if solver.method else (None, None)),
            one.limit, one.limit - limit.listed, one.limit - exact.limit, one.changes,
            one.below.overturned, one.above.overturned, one.below.impacts, one.above.impacts,
            *((one.below.evaluations, one.above.evaluations) if solver.method else (None, None)),
        )
        for solver, own in found.items()
        for limit, one, exact in zip(limits, own, found[EXACT], strict=True)
    ]  # fmt: skip
    return write_finding(
        "solver",
        collect(limits, found, bands),
        tables={
            "solver-limits": Table(columns=LIMIT_COLUMNS, rows=rows),
            "solver-bands": Table(columns=BAND_COLUMNS, rows=bands),
            "solver-histories": tabulate_histories(drawn, paths),
        },
        figures={"solver-histories.svg": draw(7, 7.5, partial(_paint, drawn, paths))},
    )


def collect(limits: Sequence[Limit], found: Results, bands: Sequence[Row]) -> dict[str, object]:
    """Return what the page shows; errors are a solver's limits less the exact ones [alpha g]."""
    exact, strongest = found[EXACT], max(one.limit for one in found[EXACT]) * ALPHA
    halves = [(limit, one) for limit, one in zip(limits, exact, strict=True) if limit.case.pulse == "half_sine"]
    errors = {
        solver: [one.limit - true.limit for one, true in zip(own, exact, strict=True)] for solver, own in found.items()
    }
    seen = {tuple(row[:3]): tuple(row[3:]) for row in bands}

    def count_closer(one: Solver, other: Solver) -> int:
        return sum(abs(a) < abs(b) for a, b in zip(errors[one], errors[other], strict=True))

    return {
        "limits": limits, "found": found, "exact": exact, "shown": SHOWN,
        "EXACT": EXACT, "KERNEL": KERNEL, "RK45": RK45, "ODE23S": ODE23S, "TIGHT": TIGHT,
        "p": P, "alpha": ALPHA, "eta": ETA, "height": 3 * GRAVITY / (2 * P**2) * math.cos(ALPHA),
        "errors": errors,
        "worst": {
            solver: max((abs(one) for one in own if not math.isnan(one)), default=math.nan)
            for solver, own in errors.items()
        },
        "cost": {
            solver: float(np.mean([side.evaluations for one in own for side in (one.below, one.above)]))
            for solver, own in found.items()
        },
        "right": {
            solver: sum(
                (one.below.overturned == limit.over_below) + (one.above.overturned != limit.over_below)
                for limit, one in zip(limits, own, strict=True)
            )
            for solver, own in found.items()
        },
        "near": NEAR, "side": SIDE,
        "missing": {solver.name: sum(math.isnan(one.limit) for one in own) for solver, own in found.items()},
        "closed": max((abs(one.limit - solve_half_sine(limit.case.ratio)) for limit, one in halves), default=0.0),
        "off": [
            (limit.printed, limit.listed - one.limit)
            for limit, one in zip(limits, exact, strict=True)
            if abs(limit.listed - one.limit) > 0.5 * 10.0 ** -len(limit.printed.partition(".")[2])
        ],
        "bands": BANDS,
        "other": [
            f"{name} at {amplitude} ({equation})"
            for equation, amplitude, name in seen
            if seen[equation, amplitude, name] != seen[equation, amplitude, EXACT.name]
        ],
        "closer": {"ode23s": count_closer(ODE23S, RK45), "tight": count_closer(TIGHT, ODE23S)},
        "fastest": P * (1 + strongest**2) ** 0.25,
    }  # fmt: skip


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


def _paint(drawn: Sequence[Limit], paths: Paths, figure: Any) -> None:
    """Paint Fig. 2 again: the pulses, and under them the responses near each limit; one column an equation."""
    columns = {name: [one for one in drawn if one.case.equation == name] for name in ("linear", "nonlinear")}
    panels = figure.subplots(4, 2, sharex=True, sharey="row")
    titles = "linear equation of slender blocks", "eq. 3 of the paper"
    for title, column, limits in zip(titles, panels.T, columns.values(), strict=True):
        fine, times = np.arange(0, END, STEP / 10), np.arange(0, END, STEP)
        for limit in limits:
            values = [limit.case.shake(limit.listed, time) / ALPHA for time in fine.tolist()]
            column[0].plot(fine, values, lw=0.8, color="#444444")
        column[0].axhline(limits[0].case.threshold / ALPHA, lw=0.5, ls=":", color="#444444")
        column[0].set_title(title, fontsize=8, loc="left")
        for axes, limit in zip(column[1:], limits, strict=True):
            for solver, (side, dash) in product(SHOWN, ((-NEAR, "-"), (NEAR, "--"))):
                style = {"color": COLOURS[solver], "lw": WIDTHS[solver], "ls": dash}
                label = solver.name if side < 0 else None
                axes.plot(times, paths[limit, side, solver], label=label, **style)
            low, high = (f"{limit.listed + side:.3f}" for side in (-NEAR, NEAR))
            axes.set_title(f"{low} αg (solid), {high} (dashed)", fontsize=7, loc="right")
            axes.set_ylim(-2.2, 2.2)
            axes.axhline(0, lw=0.4, color="#444444")
        column[-1].set_xlabel("time from the beginning of the sine [s]")
    for row, name in enumerate(("acceleration / αg", *(("θ / α",) * 3))):
        panels[row, 0].set_ylabel(name)
    lines, names = panels[1, 0].get_legend_handles_labels()
    figure.legend(lines, names, loc="outside lower center", ncols=3, fontsize=7, frameon=False)


STUDY = Study(
    name="solver", order=20, title="Solvers: the overturning limits under a pulse", of="section 2.1 and Fig. 2", run=run
)
