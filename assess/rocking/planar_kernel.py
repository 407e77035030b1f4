"""One rigid body under horizontal and vertical motion of the floor, free or beside a wall: compiled, one at a time.

The equation of `assess.rocking.kernel` with a vertical acceleration a_v. While the body turns about one edge by the
angle phi >= 0, with s the edge (the sign of theta), h = s a_h / g and w = 1 + a_v / g:

    phi'' = -p2 [w sin(alpha - phi) + h cos(alpha - phi)]

It leaves rest where |a_h| / g exceeds w tan(alpha). Where phi comes back to zero it strikes: its other edge, about
which it turns from then on with eta times its angular velocity; or, beside a wall, the wall, from which it rebounds
about the same edge. Accelerations are linear within a sample, so that phi has a Taylor series whose terms follow one
from the other; steps end at samples, are at most `LONGEST_STEP` / p long, and are cut into parts on which their
polynomial rises or falls throughout, so that no peak, impact or fall within a step is missed.

Time is in s, angles in rad, accelerations in g.
"""

import math

import numpy as np

from assess.arrays import FloatArray
from assess.compiled import compiled, compiled_into
from assess.rocking.kernel import MOST_AFTER, OVERTURNED, REST, SHORTEST

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
