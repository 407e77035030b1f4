"""Housner's rigid block under a motion that is linear between samples: eq. 3 of the paper, compiled, many at once.

The block turns about one edge of its base by the angle phi >= 0 until that is zero; then it strikes its other edge, its
angular velocity falls to eta times that before, and it turns about that one. While it turns, with b = s a_g / g and
s the edge (the sign of theta):

    phi'' = -p2 [sin(alpha - phi) + b cos(alpha - phi)]

Within a sample b is linear in time, so that phi has a Taylor series whose terms follow one from the other. A step goes
from a sample, or from a start or an impact within it, to the next sample, and takes six terms. Starts, impacts and
peaks within a step are found on the step's own polynomial.

Lanes. `LANES` pairs of block and motion are stepped together, each at its own place in its own motion, so that the
inner loop runs in vector lanes. Whatever is rare (impact, peak, overturning, end of the motion) is flagged there and
done lane by lane. A pair at rest takes no steps: it goes on where the motion next exceeds its threshold, and once
nothing can start it again its lane takes up the next pair. What happens in a lane does not depend on its neighbours.

Time is counted in samples here: a velocity is an angle per sample. Angles are in rad, accelerations in g.
"""

import math

import numpy as np

from assess.arrays import FloatArray, IntArray
from assess.compiled import compiled, compiled_into

LANES = 32
OVERTURNED = math.pi / 2
"""Rotation at which a block has fallen [rad]."""
SHORTEST = 1e-10
"""What is left of a sample below this is left out [samples]: it is lost in rounding."""
REST = 1e-7
"""A block rests once the next hop after an impact would be lower than this share of the critical angle [-]."""
STRETCH = 32
"""Samples that a block at rest may skip at once."""
ROUNDS = 40
"""Most rounds of Newton's rule; it takes three or four."""
MOST_AFTER = 1_000_000
"""Steps after the end of a motion after which a block is taken to balance."""

# sin(x) / x and cos(x) as polynomials of x2 for |x| up to pi/2 + 0.15, interpolated at Chebyshev nodes: errors at most
# 3.1e-13 and 8.9e-15. A step starts below pi/2, so that |alpha - phi| stays below it too.
S0, S1, S2, S3, S4, S5, S6 = (
    0.9999999999998216,
    -0.16666666666074081,
    0.008333333301280171,
    -0.00019841263336610666,
    2.755669013718358e-06,
    -2.5020827218347714e-08,
    1.5284724334645856e-10,
)
C0, C1, C2, C3, C4, C5, C6, C7 = (
    0.9999999999999913,
    -0.49999999999963596,
    0.041666666664109224,
    -0.001388888881995025,
    2.4801578154861783e-05,
    -2.75566592572898e-07,
    2.0850328125960945e-09,
    -1.0917414787945595e-11,
)

# Rows of the lanes' state, one after the other in one array, by which the compiler sees that they do not overlap.
PHI, VELOCITY, DONE, EDGE, PEAK, LEFT, MARK = (row * LANES for row in range(7))
"""Where a block is: angle, velocity, share of the sample that is done, edge, largest angle, samples left, a mark."""
ALPHA, PP, ETA, TAN, COS = (row * LANES for row in range(7, 12))
"""The block: critical angle, (p dt)2, restitution, threshold tan(alpha), cosine of the angle."""
A0, A1, START, SPAN, D1, D2, D3, D4, D5, D6 = (row * LANES for row in range(12, 22))
"""Its last step: accelerations at the two samples, angle at its start, its length, and k times the k-th Taylor term."""
SCALE = 22 * LANES
"""Factor on its motion."""
ROWS = 23
AT, STRIDE, BLOCK, MOTION, IMPACTS, AFTER = (row * LANES for row in range(6))
"""Counters: sample, samples a step (0 after the end of the motion), which block (-1: none) and motion, impacts, steps
after the end of the motion."""
COUNTERS = 6
ROTATION, FALL, STRUCK = range(3)
"""Columns of an outcome: largest |theta| / alpha [-], time of overturning [samples] or -1, number of impacts."""


@compiled
def rock(
    blocks: FloatArray, motions: FloatArray, first: int, last: int, outcome: FloatArray, trace: FloatArray
) -> int:  # pragma: no cover
    """Integrate every block under motions `first` to `last` - 1.

    * `blocks` (m, 1 or k, 5): critical angle [rad], (p dt)2 [-], restitution [-], threshold tan(alpha) [g] and factor
      on the motion [-]: the same under all motions, or one a motion.
    * `motions` (k, n + 2): base acceleration [g], each row followed by two zeros.
    * `first`, `last`: rows of `motions`.
    * `outcome` (m, k, 3): filled: `ROTATION`, `FALL`, `STRUCK`.
    * `trace` (t, 3): filled with time [samples], theta [rad] and impacts so far after each step of the first lane;
      empty for none.

    Returned: steps taken by all lanes.
    """
    state, count = np.zeros(ROWS * LANES), np.zeros(COUNTERS * LANES, dtype=np.int64)
    crests, samples = _find_crests(motions, first, last), motions.ravel()
    pair, end, steps, traced = first * len(blocks), last * len(blocks), 0, 0
    for lane in range(LANES):
        pair = _take(state, count, lane, pair, end, blocks, motions, crests)
    live = (count[BLOCK : BLOCK + LANES] >= 0).sum()
    while live > 0:
        steps += LANES
        marked = _step(state, count, samples)
        for lane in range(LANES if marked else 0):
            if state[MARK + lane] > 0.0 and _attend(state, count, lane, motions, crests):
                motion = count[MOTION + lane]
                one = outcome[count[BLOCK + lane], motion]
                one[ROTATION], one[STRUCK] = state[PEAK + lane] / state[ALPHA + lane], count[IMPACTS + lane]
                one[FALL] = -1.0
                if state[PHI + lane] >= OVERTURNED:
                    passed = (OVERTURNED - state[START + lane]) / (state[PHI + lane] - state[START + lane])
                    one[ROTATION] = OVERTURNED / state[ALPHA + lane]
                    step = count[AT + lane] + count[AFTER + lane] + 1 - count[STRIDE + lane]  # the end of the last one
                    one[FALL] = step - motion * motions.shape[1] - state[SPAN + lane] * (1.0 - passed)
                pair = _take(state, count, lane, pair, end, blocks, motions, crests)
                live -= count[BLOCK + lane] < 0
        if traced < len(trace) and count[BLOCK] >= 0:
            trace[traced, 0] = count[AT] + count[AFTER] + state[DONE] - first * motions.shape[1]
            trace[traced, 1], trace[traced, 2] = state[EDGE] * state[PHI], count[IMPACTS]
            traced += 1
    return steps


@compiled
def _find_crests(motions: FloatArray, first: int, last: int) -> FloatArray:  # pragma: no cover
    """Return the peaks of the `STRETCH` samples after every STRETCH-th: a block at rest skips those that are low."""
    width = motions.shape[1] - 1
    crests = np.zeros((len(motions), (width + STRETCH - 1) // STRETCH))
    for motion in range(first, last):
        for sample in range(1, width):
            at = (sample - 1) // STRETCH
            crests[motion, at] = max(crests[motion, at], abs(motions[motion, sample]))
    return crests


@compiled_into
def _step(s: FloatArray, count: IntArray, samples: FloatArray) -> int:  # pragma: no cover
    """Take one step in every lane; mark those with a rare event, and count them. Long, since it is the hot loop."""
    for lane in range(LANES):
        at = count[AT + lane]
        s[A0 + lane], s[A1 + lane] = s[SCALE + lane] * samples[at], s[SCALE + lane] * samples[at + 1]
        count[AT + lane] = at + count[STRIDE + lane]
    for i in range(LANES):
        phi, span = s[PHI + i], 1.0 - s[DONE + i]
        rise = s[EDGE + i] * (s[A1 + i] - s[A0 + i])
        b0, b1 = s[EDGE + i] * s[A0 + i] + s[DONE + i] * rise, span * rise
        q = s[PP + i] * span * span
        x = s[ALPHA + i] - phi
        z = x * x
        s0 = x * (S0 + z * (S1 + z * (S2 + z * (S3 + z * (S4 + z * (S5 + z * S6))))))
        c0 = C0 + z * (C1 + z * (C2 + z * (C3 + z * (C4 + z * (C5 + z * (C6 + z * C7))))))
        # Terms of sin(alpha - phi) and cos(alpha - phi), s1 ... and c1 ..., and of phi: d_k is k times the k-th.
        d1 = s[VELOCITY + i] * span
        d2 = -q * (s0 + b0 * c0)
        s1, c1 = -d1 * c0, d1 * s0
        d3 = -(q / 2) * (s1 + b0 * c1 + b1 * c0)
        s2, c2 = -(d1 * c1 + d2 * c0) / 2, (d1 * s1 + d2 * s0) / 2
        d4 = -(q / 3) * (s2 + b0 * c2 + b1 * c1)
        s3, c3 = -(d1 * c2 + d2 * c1 + d3 * c0) / 3, (d1 * s2 + d2 * s1 + d3 * s0) / 3
        d5 = -(q / 4) * (s3 + b0 * c3 + b1 * c2)
        s4, c4 = -(d1 * c3 + d2 * c2 + d3 * c1 + d4 * c0) / 4, (d1 * s3 + d2 * s2 + d3 * s1 + d4 * s0) / 4
        d6 = -(q / 5) * (s4 + b0 * c4 + b1 * c3)
        end = phi + (d1 + (d2 / 2 + (d3 / 3 + (d4 / 4 + (d5 / 5 + d6 / 6)))))
        speed = d1 + (d2 + (d3 + (d4 + (d5 + d6))))
        turns, dips = (d1 > 0.0) & (speed <= 0.0), (d1 < 0.0) & (speed > 0.0)
        rare = (end < 0.0) | (end >= OVERTURNED) | (s[LEFT + i] <= 1.0)
        rare |= (turns & (phi + d1 > s[PEAK + i])) | (dips & (phi + d1 < 0.0))
        s[START + i], s[SPAN + i] = phi, span
        s[D1 + i], s[D2 + i], s[D3 + i], s[D4 + i], s[D5 + i], s[D6 + i] = d1, d2, d3, d4, d5, d6
        s[PHI + i], s[VELOCITY + i], s[DONE + i] = end, speed / span, 0.0
        s[PEAK + i] = max(s[PEAK + i], end)
        s[LEFT + i] -= 1.0
        s[MARK + i] = 1.0 if rare else 0.0
    marked = 0
    for lane in range(LANES):
        marked += 1 if s[MARK + lane] > 0.0 else 0
    return marked


@compiled_into
def _take(
    s: FloatArray,
    count: IntArray,
    lane: int,
    pair: int,
    end: int,
    blocks: FloatArray,
    motions: FloatArray,
    crests: FloatArray,
) -> int:  # pragma: no cover
    """Have a lane take up the next pair that starts to rock, if there is one; return the pair after it."""
    width = motions.shape[1]
    while pair < end:
        motion, block = pair // len(blocks), pair % len(blocks)
        one = blocks[block, motion if blocks.shape[1] > 1 else 0]
        s[ALPHA + lane], s[PP + lane], s[ETA + lane], s[TAN + lane], s[SCALE + lane] = one
        s[COS + lane] = math.cos(s[ALPHA + lane])
        s[DONE + lane], s[PEAK + lane], s[LEFT + lane] = 0.0, 0.0, width - 2.0
        count[AT + lane], count[STRIDE + lane] = motion * width, 1
        count[BLOCK + lane], count[MOTION + lane] = block, motion
        count[IMPACTS + lane], count[AFTER + lane] = 0, 0
        pair += 1
        if _start(s, count, lane, motions, crests):
            return pair
    # Nothing is left to do: a block that stands still off its edges until all other lanes are done.
    s[PHI + lane], s[VELOCITY + lane], s[DONE + lane], s[EDGE + lane] = 0.1, 0.0, 0.0, 0.0
    s[ALPHA + lane], s[PP + lane], s[PEAK + lane], s[LEFT + lane] = 0.2, 0.0, 1.0, math.inf
    count[AT + lane], count[STRIDE + lane], count[BLOCK + lane] = 0, 0, -1
    return pair


@compiled_into
def _start(
    s: FloatArray, count: IntArray, lane: int, motions: FloatArray, crests: FloatArray
) -> bool:  # pragma: no cover
    """Find where a block at rest starts to rock, from the lane's place on; False if the motion never makes it."""
    motion, crest = motions[count[MOTION + lane]], crests[count[MOTION + lane]]
    row, scale = count[MOTION + lane] * motions.shape[1], s[SCALE + lane]
    at, done, tan = count[AT + lane] - row, s[DONE + lane], s[TAN + lane]
    last = at + int(s[LEFT + lane])
    while at < last:
        a0, a1 = scale * motion[at], scale * motion[at + 1]
        here = a0 + done * (a1 - a0)
        if abs(here) <= tan < abs(a1):
            done = (math.copysign(tan, a1) - a0) / (a1 - a0)
            here = a1 if 1.0 - done >= SHORTEST else 0.0
        if abs(here) > tan:
            s[PHI + lane], s[VELOCITY + lane], s[DONE + lane] = 0.0, 0.0, done
            s[LEFT + lane], s[EDGE + lane] = float(last - at), -math.copysign(1.0, here)
            count[AT + lane] = row + at
            return True
        at, done = at + 1, 0.0
        while at < last and at % STRETCH == 0 and scale * max(abs(motion[at]), crest[at // STRETCH]) <= tan:
            at += STRETCH
    return False


@compiled_into
def _attend(
    s: FloatArray, count: IntArray, lane: int, motions: FloatArray, crests: FloatArray
) -> bool:  # pragma: no cover
    """Handle the rare event of a lane's last step; True once its pair is decided."""
    if s[VELOCITY + lane] <= 0.0 < s[D1 + lane] and s[START + lane] + s[D1 + lane] > s[PEAK + lane]:  # it turns back
        s[PEAK + lane] = max(s[PEAK + lane], _follow(s, lane, _find_turn(s, lane))[0])
    lifts = s[D1 + lane] > 0.0 or s[D2 + lane] > 0.0
    if s[START + lane] == 0.0 and not lifts and s[PHI + lane] < 0.0:  # it has not left the ground
        return not _start(s, count, lane, motions, crests)
    place = _find_impact(s, lane)
    if place >= 0.0:
        if _strike(s, count, lane, place):
            return not _start(s, count, lane, motions, crests)
    elif s[PHI + lane] >= OVERTURNED:
        return True
    if s[LEFT + lane] > 0.0:
        return False
    # After the end of a motion: it is decided if it can no longer fall; its next peak counts. Else it is carried on.
    phi, velocity, alpha, pp = s[PHI + lane], s[VELOCITY + lane], s[ALPHA + lane], s[PP + lane]
    energy, level = velocity * velocity / 2 + pp * math.cos(alpha - phi), pp * math.cos(alpha)
    # What is left of it on the way to its next peak, which is on the other edge if it is falling back now.
    after = level + s[ETA + lane] ** 2 * (energy - level) if velocity < 0.0 else energy
    if phi < alpha and energy < pp:
        s[PEAK + lane] = max(s[PEAK + lane], alpha - math.acos(min(1.0, after / pp)))
        return True
    count[AFTER + lane] += count[STRIDE + lane] == 0
    s[LEFT + lane], count[STRIDE + lane] = 1.0, 0
    return bool(count[AFTER + lane] > MOST_AFTER)


@compiled_into
def _follow(s: FloatArray, lane: int, u: float) -> tuple[float, float, float]:  # pragma: no cover
    """Return angle, velocity and acceleration at the share `u` of a lane's last step, per length of the step."""
    d1, d2, d3, d4, d5, d6 = s[D1 + lane], s[D2 + lane], s[D3 + lane], s[D4 + lane], s[D5 + lane], s[D6 + lane]
    angle = s[START + lane] + u * (d1 + u * (d2 / 2 + u * (d3 / 3 + u * (d4 / 4 + u * (d5 / 5 + u * d6 / 6)))))
    velocity = d1 + u * (d2 + u * (d3 + u * (d4 + u * (d5 + u * d6))))
    return angle, velocity, d2 + u * (2 * d3 + u * (3 * d4 + u * (4 * d5 + u * 5 * d6)))


@compiled_into
def _find_turn(s: FloatArray, lane: int) -> float:  # pragma: no cover
    """Return the share of a lane's last step at which its velocity, of opposite sign at its ends, is zero."""
    first, last = s[D1 + lane], s[VELOCITY + lane] * s[SPAN + lane]
    low, high, u = 0.0, 1.0, first / (first - last)
    for _ in range(ROUNDS):
        _, velocity, acceleration = _follow(s, lane, u)
        low, high = (u, high) if (velocity > 0.0) == (first > 0.0) else (low, u)
        better = u - velocity / acceleration
        better = better if low <= better <= high else (low + high) / 2
        change, u = abs(better - u), better
        if change < 1e-12:
            break
    return float(u)


@compiled_into
def _find_impact(s: FloatArray, lane: int) -> float:  # pragma: no cover
    """Return the share of a lane's last step at which the angle comes back to zero; -1 if it does not."""
    start, d1, high = s[START + lane], s[D1 + lane], 1.0
    if s[PHI + lane] >= 0.0:
        if not (d1 < 0.0 < s[VELOCITY + lane] and start + d1 < 0.0):
            return -1.0
        high = _find_turn(s, lane)
        if _follow(s, lane, high)[0] >= 0.0:
            return -1.0
    # From the parabola that leaves with the step's velocity and acceleration; then by Newton's rule.
    d2 = s[D2 + lane]
    low, root = 0.0, math.sqrt(max(0.0, d1 * d1 - 2.0 * start * d2))
    u = -2.0 * d1 / d2 if start == 0.0 else 2.0 * start / (root - d1)
    u = u if 0.0 < u < high else 0.999 * high
    for _ in range(ROUNDS):
        angle, velocity, _ = _follow(s, lane, u)
        low, high = (u, high) if angle > 0.0 else (low, u)
        # A hop starts from zero: angle / u has the same end, and no zero at the start.
        better = u - (angle / velocity if start > 0.0 else angle * u / (velocity * u - angle))
        better = better if low <= better <= high else (low + high) / 2
        change, u = abs(better - u), better
        if change < 1e-7 * u:
            break
    return float(u)


@compiled_into
def _strike(s: FloatArray, count: IntArray, lane: int, place: float) -> bool:  # pragma: no cover
    """Have a block strike its other edge at a share of the lane's last step; True if it rests then."""
    span, tan, alpha = s[SPAN + lane], s[TAN + lane], s[ALPHA + lane]
    velocity = s[ETA + lane] * max(0.0, -_follow(s, lane, place)[1] / span)
    done = 1.0 - span * (1.0 - place)
    count[IMPACTS + lane] += 1
    s[PHI + lane], s[VELOCITY + lane], s[EDGE + lane] = 0.0, velocity, -s[EDGE + lane]
    if 1.0 - done > SHORTEST:
        s[DONE + lane] = done
        s[LEFT + lane] += 1.0
        count[AT + lane] -= count[STRIDE + lane]
    # As long as its weight brings it back, the next hop is v2 / 2 f high.
    here = s[EDGE + lane] * (s[A0 + lane] + done * (s[A1 + lane] - s[A0 + lane]))
    back = s[PP + lane] * s[COS + lane] * (tan + here)
    return bool(velocity * velocity < 2.0 * back * REST * alpha)
