"""One block under a sine pulse, by any solver: the block of the paper's Fig. 2, whose overturning limits are published.

Reference: Zhang J, Makris N (2001). Rocking response of free-standing blocks under cycloidal pulses. Journal of
Engineering Mechanics 127(5):473-483. Their limits are those of the linear equation of slender blocks; eq. 3 of the
paper is nonlinear.

Amplitudes are in alpha g. Time runs from the zero of the sine; the block starts where the sine reaches its threshold.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from assess.studies.studied_methods import FloatArray
from assess.studies.study import read_facts
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

    def can_fall(self, velocity: float, time: float) -> bool:
        """Return whether a block that has just struck its base can still overturn."""
        depth = ALPHA**2 / 2 if self.is_linear else 1 - math.cos(ALPHA)
        return time < self.end or velocity**2 / 2 >= P**2 * depth


@dataclass(frozen=True, slots=True)
class Solver:
    """A solver of scipy, or "ODE23s", and its tolerances; without a method, the kernel of `assess.rocking`."""

    name: str
    method: str = ""
    rtol: float = 1e-5
    atol: float = 1e-7

    @property
    def options(self) -> dict[str, Any]:
        """Keyword arguments of `solve_ivp`."""
        from assess.studies.solver.ode23s import Ode23s

        method = Ode23s if self.method == "ODE23s" else self.method
        return {"method": method, "rtol": self.rtol, "atol": self.atol, "first_step": FIRST}


@dataclass(slots=True, eq=False)
class Response:
    """The response of a block.

    * `overturned`: whether |theta| reached pi/2.
    * `impacts`: impacts until the outcome was certain.
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
    response, edge, velocity = Response(), -1.0, 0.0
    time = case.start(amplitude, 0.0)
    while time < math.inf and (time < until or case.can_fall(velocity, time)):
        time, phi, velocity = _fly(case, amplitude, solver, response, (time, velocity, edge), until > 0)
        if phi > ALPHA:
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


def _fly(
    case: Case, amplitude: float, solver: Solver, response: Response, at: tuple[float, float, float], keep: bool
) -> tuple[float, float, float]:
    """Follow the block from a start or an impact to its next impact or its fall; return time, phi and its velocity."""
    from scipy.integrate import solve_ivp

    since, velocity, edge = at

    def rates(time: float, state: FloatArray) -> tuple[float, float]:
        response.evaluations += 1
        phi, speed = state.tolist()
        return speed, case.accelerate(phi, edge * case.shake(amplitude, time))

    span = (since, since + LONGEST)
    found = solve_ivp(rates, span, [0.0, velocity], events=[_strike, _fall], dense_output=keep, **solver.options)
    if found.status != 1:
        raise ArithmeticError(f"{solver.name} at {amplitude:g} alpha g: {found.message}")
    last = float(found.t[-1])
    if keep:
        points = np.append(np.arange(since, last, POINT), last)
        response.times = np.append(response.times, points)
        response.theta = np.append(response.theta, edge * found.sol(points)[0])
    return last, float(found.y[0, -1]), float(found.y[1, -1])


def _strike(_time: float, state: FloatArray) -> float:
    return float(state[0])


def _fall(_time: float, state: FloatArray) -> float:
    return float(state[0]) - OVERTURNED


for _event, _direction in ((_strike, -1), (_fall, 1)):
    _event.terminal, _event.direction = True, _direction  # type: ignore[attr-defined]  # read by `solve_ivp`


def _follow_by_kernel(case: Case, amplitude: float, until: float) -> Response:
    """Rock the block by `assess.rocking`; for the linear equation, a block so slender that the difference vanishes."""
    from assess.rocking.response import follow_block

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
