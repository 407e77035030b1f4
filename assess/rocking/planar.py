"""Bodies in general: any centre of gravity, vertical motion of the floor, a wall at the back.

`assess.rocking.ensemble` integrates many blocks under horizontal motion alone, and does so several times faster. What
is found with a wall stands next to its results and lowers none: the wall's own motion and pounding feed in energy that
is left out here. Importing this imports numba: do so where bodies are to be rocked.

The equation of `assess.rocking.kernel` with a vertical acceleration a_v. While the body turns about one edge by the
angle phi >= 0, with s the edge (the sign of theta), h = s a_h / g and w = 1 + a_v / g:

    phi'' = -p2 [w sin(alpha - phi) + h cos(alpha - phi)]

It leaves rest where |a_h| / g exceeds w tan(alpha). Where phi comes back to zero it strikes: its other edge, about
which it turns from then on with eta times its angular velocity; or, beside a wall, the wall, from which it rebounds
about the same edge. Accelerations are linear within a sample, so that phi has a Taylor series whose terms follow one
from the other; steps end at samples, are at most `LONGEST_STEP` / p long, and are cut into parts on which their
polynomial rises or falls throughout, so that no peak, impact or fall within a step is missed.

Time is in s, angles in rad, accelerations in g.

Reference: Sorrentino L, AlShawa O, Decanini LD (2011). The relevance of energy damping in unreinforced masonry rocking
mechanisms. Experimental and analytic investigations. Bulletin of Earthquake Engineering 9(5):1617-1642.
doi:10.1007/s10518-011-9291-1. The restitution of the one-sided motion is assumed: not compared with the printed paper.
"""

import math
from dataclasses import dataclass
from typing import Literal, Self

import numpy as np
from numpy.typing import ArrayLike

from assess.arrays import FloatArray
from assess.compiled import compiled, compiled_into
from assess.motion.rows import run_rows
from assess.progress import SILENT, Progress
from assess.rocking import block
from assess.rocking.ensemble import MOST_TRACED, Response, Rocking, check_motions
from assess.rocking.kernel import MOST_AFTER, OVERTURNED, REST, SHORTEST
from assess.units import GRAVITY

Away = Literal[-1, 0, 1]
"""To which side a body may turn: 1 is that of positive acceleration, with the wall on the other; 0 without a wall."""
ORDER = 9
"""Highest power of a step's polynomial."""
LONGEST_STEP = 0.1
"""Largest p dt of a step [-]."""
ROUNDS = 60
"""Most rounds of Newton's rule or halving; Newton's takes three or four."""
STATES = 9
PHI, VELOCITY, EDGE, PEAK, IMPACTS, DONE, RESTS, FALL, ROWS = range(STATES)
"""State: angle, its velocity, edge, largest angle, impacts, time within the sample, 1 at rest, time of the fall or -1,
points of the path."""
NOTHING, STRIKES, FALLS, STAYS = range(4)
"""How a step ends: nothing of note, an impact, overturned, or it has not left the ground, but for rounding."""
ALPHA, P, ETA, REBOUND = range(4)
"""Body: critical angle, frequency parameter, restitution, velocity after an impact on a wall over that before it."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Body:
    """A rigid body as it rocks; each field a number or an array, which broadcast.

    * `critical_angle`: angle alpha between the side and the line from an edge to the centre of gravity [rad]:
      tan(alpha) = b/z_c is the acceleration [g] that lifts an edge.
    * `frequency_parameter`: p [rad/s]: p2 = m g R/I_0.
    * `restitution`: angular velocity after an impact on the floor over that before it [-], 0 to 1.
    * `rebound`: angular velocity after an impact on a wall over that before it, in the other direction [-], 0 to 1.
    """

    critical_angle: FloatArray
    frequency_parameter: FloatArray
    restitution: FloatArray
    rebound: FloatArray

    @classmethod
    def of(
        cls,
        *,
        half_base: ArrayLike,
        centre_height: ArrayLike,
        frequency_parameter: ArrayLike,
        restitution: ArrayLike = math.nan,
    ) -> Self:
        """Build a body of given half base b, height of the centre of gravity z_c [m] and p [rad/s].

        With 2 m R2/I_0 = 2 p2 R/g, restitution is 1 - (2 m R2/I_0) sin2(alpha) where it is NaN; the rebound from a wall
        is that of `wall_restitution`.

        Raises ValueError if a number is not finite and above 0, or the restitution is outside 0 to 1.
        """
        b, z, p, eta = (
            np.asarray(values, dtype=np.float64)
            for values in (half_base, centre_height, frequency_parameter, restitution)
        )
        for name, values in (("half_base", b), ("centre_height", z), ("frequency_parameter", p)):
            if not (np.isfinite(values) & (values > 0)).all():
                raise ValueError(f"{name} must be finite and above 0")
        alpha, shape = np.arctan2(b, z), 2 * p**2 * np.hypot(b, z) / GRAVITY
        eta = np.where(np.isnan(eta), 1 - shape * np.sin(alpha) ** 2, eta)
        if not ((eta >= 0) & (eta <= 1)).all():
            raise ValueError("restitution must be 0 to 1")
        rebound = np.clip(-wall_restitution(alpha, eta, shape=shape), 0, 1)
        return cls(critical_angle=alpha, frequency_parameter=p, restitution=eta, rebound=rebound)

    @classmethod
    def rectangular(
        cls, breadth: ArrayLike, height: ArrayLike, *, centre: ArrayLike = 0.5, restitution: ArrayLike = math.nan
    ) -> Self:
        """Build a body of sizes [m], its centre of gravity at `centre` times the height, I_cg = m (B2 + H2)/12."""
        B, H = np.asarray(breadth, dtype=np.float64), np.asarray(height, dtype=np.float64)
        p = block.frequency_parameter(B, H, np.asarray(centre))
        return cls.of(
            half_base=B / 2, centre_height=np.asarray(centre) * H, frequency_parameter=p, restitution=restitution
        )


def wall_restitution(critical_angle: ArrayLike, restitution: ArrayLike, *, shape: ArrayLike = 1.5) -> FloatArray:
    """Angular velocity after an impact on a wall over that before it [-]: below 0 where the body rebounds.

    e = eta2 (1 - 1.5 cos2(alpha)); with Housner's eta = 1 - 1.5 sin2(alpha) that of Sorrentino et al. (2011), to be
    checked against the printed paper. A body strikes the floor, the wall and the floor again.

    * `critical_angle`: alpha [rad].
    * `restitution`: eta of an impact on the floor [-].
    * `shape`: 2 m R2/I_0 [-]; 1.5 for a homogeneous rectangle.
    """
    eta, alpha = np.asarray(restitution, dtype=np.float64), np.asarray(critical_angle, dtype=np.float64)
    return np.asarray(eta**2 * (1 - np.asarray(shape) * np.cos(alpha) ** 2))


def rock_bodies(
    body: Body,
    motions: FloatArray,
    time_step: float,
    *,
    vertical: FloatArray | None = None,
    away: Away = 0,
    scale: ArrayLike = 1.0,
    threads: int = 1,
    progress: Progress = SILENT,
) -> Rocking:
    """Integrate m bodies under k motions each, from rest.

    A motion is linear between its samples and followed by rest, to which it falls within one step; a body that is still
    rocking then is followed until it can no longer fall.

    * `body`: of arrays that broadcast to (m, k); (m, 1) for bodies that are the same under all motions.
    * `motions` (k, n): horizontal accelerations of the floor [m/s2].
    * `time_step`: [s].
    * `vertical` (k, n): vertical accelerations, upwards positive [m/s2].
    * `away`: -1 or 1 beside a wall; see `Away`.
    * `scale` (k,): each motion is multiplied by its own [-], the vertical one too.
    * `threads`: share the motions; they do not change a result.
    * `progress`: asked before each motion whether to stop; CancelledError then.

    Raises ValueError if the motions, their scale or their time step are
    not finite numbers of that shape, or the vertical acceleration is 1 g or more downwards, where a body leaves the
    floor.
    """
    across, up = _check_motions(motions, vertical, time_step, scale)
    fields = (body.critical_angle, body.frequency_parameter, body.restitution, body.rebound)
    shape = np.broadcast_shapes(*(np.shape(field) for field in fields), (1, len(across)))
    bodies = np.stack([np.broadcast_to(field, shape) for field in fields], axis=-1)
    states = np.zeros((*shape, STATES))

    def run(row: int) -> None:
        for at in range(shape[0]):
            _rock(bodies[at, row], across[row], up[row], time_step, away, states[at, row], 0)

    run_rows(run, len(across), threads, progress)
    return _build(bodies[..., 0], states)


def follow_body(
    body: Body, acceleration: FloatArray, time_step: float, *, vertical: FloatArray | None = None, away: Away = 0
) -> Response:
    """Integrate one body under one motion, as `rock_bodies` does, and keep its path.

    Parameters and errors are those of `rock_bodies`: a `body` of numbers, and accelerations (n,) [m/s2].
    """
    both = (np.asarray(acceleration)[np.newaxis], None if vertical is None else np.asarray(vertical)[np.newaxis])
    (across,), (up,) = _check_motions(*both, time_step, 1.0)
    numbers = np.array(
        [float(one) for one in (body.critical_angle, body.frequency_parameter, body.restitution, body.rebound)]
    )
    states = np.zeros((2, STATES))
    _rock(numbers, across, up, time_step, away, states[0], 0)
    trace = _rock(numbers, across, up, time_step, away, states[1], min(int(states[0, ROWS]), MOST_TRACED))
    found = _build(numbers[:1, np.newaxis], states[:1, np.newaxis])
    struck = np.diff(trace[:, 2], prepend=0.0) > 0
    end = (np.size(acceleration) - 1) * time_step
    ends = [end] if not found.overturned[0, 0] and (not len(trace) or trace[-1, 0] < end) else []
    return Response(
        critical_angle=float(numbers[0]), frequency_parameter=float(numbers[1]), restitution=float(numbers[2]),
        overturned=bool(found.overturned[0, 0]), rotation=float(found.rotation[0, 0]),
        fall_time=float(found.fall_time[0, 0]), impacts=int(found.impacts[0, 0]),
        times=np.concatenate([[0.0], trace[:, 0], ends]),
        theta=np.concatenate([[0.0], trace[:, 1], np.zeros(len(ends))]), impact_times=trace[struck, 0],
    )  # fmt: skip


def _check_motions(
    motions: FloatArray, vertical: FloatArray | None, time_step: float, scale: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Return both motions, scaled [g] and padded as the kernel takes them, (k, n + 2); ValueError as `rock_bodies`."""
    across = check_motions(np.asarray(motions, dtype=np.float64), time_step)
    up = np.zeros_like(across) if vertical is None else np.asarray(vertical, dtype=np.float64)
    if up.shape != across.shape or not np.isfinite(up).all():
        raise ValueError(f"vertical motions have shape {up.shape}, expected {across.shape} finite samples")
    factors = np.array(np.broadcast_to(scale, len(across)), dtype=np.float64)[:, np.newaxis] / GRAVITY
    if not np.isfinite(factors).all():
        raise ValueError("scale must be finite numbers")
    if (up * factors).min() <= -1:
        raise ValueError(f"the vertical acceleration is {(up * factors).min():.3g} g, expected above -1 g")
    pad = ((0, 0), (0, 2))
    return np.pad(across * factors, pad), np.pad(up * factors, pad)


def _rock(
    body: FloatArray, across: FloatArray, up: FloatArray, time_step: float, away: Away, state: FloatArray, points: int
) -> FloatArray:
    """Integrate one body and fill its `state`; returns `points` points of its path, (t, 3)."""
    trace = np.zeros((points, 3))
    state[RESTS], state[FALL] = 1.0, -1.0
    rock(np.ascontiguousarray(body), across, up, time_step, away, state, trace)
    return trace


def _build(critical_angle: FloatArray, states: FloatArray) -> Rocking:
    """Return what bodies of angles (m, k) did, from their states (m, k, 9)."""
    fell = states[..., FALL] >= 0
    return Rocking(
        overturned=fell,
        rotation=np.where(fell, math.pi / 2, states[..., PEAK]) / critical_angle,
        fall_time=np.where(fell, states[..., FALL], math.nan),
        impacts=states[..., IMPACTS].astype(np.int64),
    )


# ---------------------------------------------------------------- compiled, one body at a time


@compiled
def rock(
    body: FloatArray,
    horizontal: FloatArray,
    vertical: FloatArray,
    time_step: float,
    away: int,
    state: FloatArray,
    trace: FloatArray,
) -> None:  # pragma: no cover
    """Integrate one body that starts at rest.

    * `body` (4,): `ALPHA` [rad], `P` [rad/s], `ETA` [-], `REBOUND` [-].
    * `horizontal`, `vertical` (n + 2,): accelerations of the floor [g], followed by two zeros.
    * `time_step`: [s].
    * `away`: sign of theta to which a wall leaves the body free; 0 without a wall.
    * `state` (9,): as the body is at first: zeros but for `RESTS`, 1, and `FALL`, -1. Filled with what it did.
    * `trace` (t, 3): filled with time [s], theta [rad] and impacts so far at each start and after each step; empty for
      none.
    """
    terms = np.zeros((3, ORDER + 1))
    last, tan = horizontal.size - 2, math.tan(body[ALPHA])
    for at in range(last + MOST_AFTER):
        place = min(at, last)
        if state[RESTS] > 0.0:
            # Where no edge lifts at either end of a sample, none does in it: most samples of most motions.
            first = abs(horizontal[place]) - tan * (1.0 + vertical[place])
            final = abs(horizontal[place + 1]) - tan * (1.0 + vertical[place + 1])
            if max(first, final) <= 0.0:
                if at >= last - 1:
                    return
                continue
        ground = (horizontal[place], horizontal[place + 1], vertical[place], vertical[place + 1])
        state[DONE] = 0.0
        while state[DONE] < time_step * (1.0 - SHORTEST):
            if state[RESTS] > 0.0 and not _start(body, state, ground, time_step, away):
                break
            if state[DONE] >= time_step * (1.0 - SHORTEST):
                break
            if state[PHI] == 0.0 and state[VELOCITY] == 0.0:
                _note(state, trace, at * time_step)
            _step(body, state, terms, ground, time_step, away)
            _note(state, trace, at * time_step)
            if state[PHI] >= OVERTURNED:
                state[FALL] = at * time_step + state[DONE]
                return
        if at < last - 1:
            continue
        if state[RESTS] > 0.0:
            return
        # The floor is at rest: a body is done with once it can no longer fall; its next peak counts.
        pp, factor = body[P] ** 2, body[ETA] if away == 0 else body[REBOUND]
        energy, level = state[VELOCITY] ** 2 / 2.0 + pp * math.cos(body[ALPHA] - state[PHI]), pp * math.cos(body[ALPHA])
        if state[PHI] < body[ALPHA] and energy < pp:
            after = level + factor**2 * (energy - level) if state[VELOCITY] < 0.0 else energy
            state[PEAK] = max(state[PEAK], body[ALPHA] - math.acos(min(1.0, after / pp)))
            return


@compiled_into
def _note(state: FloatArray, trace: FloatArray, since: float) -> None:  # pragma: no cover
    row = int(state[ROWS])
    if row < len(trace):
        trace[row, 0] = since + state[DONE]
        trace[row, 1], trace[row, 2] = state[EDGE] * state[PHI], state[IMPACTS]
    state[ROWS] += 1.0


@compiled_into
def _start(
    body: FloatArray, state: FloatArray, ground: tuple[float, float, float, float], time_step: float, away: int
) -> bool:  # pragma: no cover
    """Find where in the sample a body at rest lifts an edge, from where it is on; False if it does not."""
    tan, share, first = math.tan(body[ALPHA]), state[DONE] / time_step, 2.0
    for edge in (-1.0, 1.0):
        if away != 0 and edge != away:
            continue
        begin = -edge * ground[0] - tan * (1.0 + ground[2])
        end = -edge * ground[1] - tan * (1.0 + ground[3])
        here = begin + share * (end - begin)
        when = share if here > 0.0 else 2.0
        if here <= 0.0 < end:
            when = share + (1.0 - share) * here / (here - end)
        if when < first:
            first, state[EDGE] = when, edge
    if first > 1.0:
        return False
    state[PHI], state[VELOCITY], state[RESTS], state[DONE] = 0.0, 0.0, 0.0, first * time_step
    return True


@compiled_into
def _step(
    body: FloatArray,
    state: FloatArray,
    terms: FloatArray,
    ground: tuple[float, float, float, float],
    time_step: float,
    away: int,
) -> None:  # pragma: no cover
    """Follow a body to the end of the sample or of the longest step, its impact or its fall."""
    span = min(time_step - state[DONE], LONGEST_STEP / body[P])
    _expand(body, state, terms, ground, time_step, span)
    path, low, bound = terms[0], state[PHI], 0.0
    for power in range(1, ORDER + 1):
        bound += power * abs(path[power])
    if low - bound > 0.0 and low + bound < min(OVERTURNED, state[PEAK]):
        u, event = 1.0, NOTHING  # no impact, fall or new peak is within reach
    else:
        u, event = _find_event(path, state)
    phi, speed = _evaluate(path, 0, u)
    state[PHI], state[VELOCITY], state[DONE] = phi, speed / span, state[DONE] + u * span
    if event == STAYS:
        state[PHI], state[VELOCITY], state[RESTS] = 0.0, 0.0, 1.0
    elif event == FALLS:
        state[PHI] = OVERTURNED
    elif event == STRIKES:
        factor, share = body[ETA] if away == 0 else body[REBOUND], state[DONE] / time_step
        state[VELOCITY], state[PHI] = factor * max(0.0, -state[VELOCITY]), 0.0
        state[EDGE] = -state[EDGE] if away == 0 else state[EDGE]
        state[IMPACTS] += 1.0
        # As long as its weight brings it back, the next hop is v2 / 2 f high.
        h = state[EDGE] * (ground[0] + share * (ground[1] - ground[0]))
        w = 1.0 + ground[2] + share * (ground[3] - ground[2])
        back = body[P] ** 2 * (w * math.sin(body[ALPHA]) + h * math.cos(body[ALPHA]))
        if state[VELOCITY] ** 2 < 2.0 * back * REST * body[ALPHA]:
            state[VELOCITY], state[RESTS] = 0.0, 1.0


@compiled_into
def _expand(
    body: FloatArray,
    state: FloatArray,
    terms: FloatArray,
    ground: tuple[float, float, float, float],
    time_step: float,
    span: float,
) -> None:  # pragma: no cover
    """Fill `terms` with the Taylor terms of phi, sin(alpha - phi) and cos(alpha - phi) over a step."""
    path, sine, cosine = terms[0], terms[1], terms[2]
    share, part = state[DONE] / time_step, span / time_step
    h0 = state[EDGE] * (ground[0] + share * (ground[1] - ground[0]))
    h1 = state[EDGE] * part * (ground[1] - ground[0])
    w0, w1 = 1.0 + ground[2] + share * (ground[3] - ground[2]), part * (ground[3] - ground[2])
    q = (body[P] * span) ** 2
    path[0], path[1] = state[PHI], state[VELOCITY] * span
    sine[0], cosine[0] = math.sin(body[ALPHA] - path[0]), math.cos(body[ALPHA] - path[0])
    for k in range(ORDER - 1):
        pull = w0 * sine[k] + h0 * cosine[k]
        if k > 0:
            pull += w1 * sine[k - 1] + h1 * cosine[k - 1]
        path[k + 2] = -q * pull / ((k + 1) * (k + 2))
        ds, dc = 0.0, 0.0
        for j in range(k + 1):
            ds -= (j + 1) * path[j + 1] * cosine[k - j]
            dc += (j + 1) * path[j + 1] * sine[k - j]
        sine[k + 1], cosine[k + 1] = ds / (k + 1), dc / (k + 1)
    if path[0] == 0.0 and path[1] == 0.0:
        path[2] = max(0.0, path[2])  # it leaves the ground where its pull is zero but for rounding


@compiled_into
def _find_event(path: FloatArray, state: FloatArray) -> tuple[float, int]:  # pragma: no cover
    """Return at which share of a step the body strikes or has fallen, 1 if neither, and which; keeps the peak."""
    bends = _find_between(path, 2, 0.0, 1.0)
    low, before = 0.0, path[0]
    for first, last in ((0.0, bends), (bends, 1.0)):
        turn = _find_between(path, 1, first, last)
        for high in (turn, last):
            here = _evaluate(path, 0, high)[0]
            if here < 0.0:
                return (_find(path, 0, 0.0, low, high), STRIKES) if before > 0.0 else (1.0, STAYS)
            if here >= OVERTURNED:
                state[PEAK] = OVERTURNED
                return _find(path, 0, OVERTURNED, low, high), FALLS
            state[PEAK] = max(state[PEAK], here)
            low, before = high, here
    return 1.0, NOTHING


@compiled_into
def _find_between(path: FloatArray, order: int, low: float, high: float) -> float:  # pragma: no cover
    """Return where a derivative of a step's polynomial changes its sign between two shares; `high` if it does not."""
    first, last = _evaluate(path, order, low)[0], _evaluate(path, order, high)[0]
    return _find(path, order, 0.0, low, high) if first * last < 0.0 else high


@compiled_into
def _find(path: FloatArray, order: int, goal: float, low: float, high: float) -> float:  # pragma: no cover
    """Return where a derivative of a step's polynomial passes `goal` between two shares, on whose sides it lies."""
    rises = _evaluate(path, order, high)[0] > goal
    u = (low + high) / 2.0
    for _ in range(ROUNDS):
        value, slope = _evaluate(path, order, u)
        low, high = (low, u) if (value > goal) == rises else (u, high)
        better = u - (value - goal) / slope if slope != 0.0 else low
        better = better if low < better < high else (low + high) / 2.0
        change, u = abs(better - u), better
        if change < 1e-14:
            break
    return u


@compiled_into
def _evaluate(path: FloatArray, order: int, u: float) -> tuple[float, float]:  # pragma: no cover
    """Return a derivative of a step's polynomial, 0 to 2, and the one above it, per length of the step."""
    value, slope = 0.0, 0.0
    for power in range(ORDER, order - 1, -1):
        factor = 1.0
        for less in range(order):
            factor *= power - less
        slope = slope * u + value
        value = value * u + factor * path[power]
    return value, slope
