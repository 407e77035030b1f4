"""Newmark's sliding block (see `assess.rocking.sliding`) under a motion that is linear between samples, compiled.

While a body slides in the direction s its velocity along s, w >= 0, is quadratic in time within a sample: w' is
-s a_g - mu g. It stops where w comes back to zero, rests while |a_g| <= mu g, and starts again against a_g where that
is exceeded. All three instants are solved for in closed form. Importing this imports numba.
"""

import math

from assess.arrays import FloatArray
from assess.compiled import compiled, compiled_into

MOST_PARTS = 8
"""Slides within a sample after which the rest of it is left out: a straight line brings three."""


@compiled
def slide(motion: FloatArray, scale: float, resistance: float, time_step: float) -> float:  # pragma: no cover
    """Return the largest |displacement| relative to the floor [m] of a body that starts at rest.

    * `motion` (n,): acceleration of the floor [m/s2]; after its last sample it falls to zero within one step.
    * `scale`: the motion is multiplied by it [-].
    * `resistance`: friction times gravity [m/s2], above 0.
    * `time_step`: [s].
    """
    place, velocity, peak = 0.0, 0.0, 0.0
    for at in range(motion.size):
        first = scale * motion[at]
        last = scale * motion[at + 1] if at + 1 < motion.size else 0.0
        if velocity == 0.0 and abs(first) <= resistance and abs(last) <= resistance:
            continue
        slope, done = (last - first) / time_step, 0.0
        for _ in range(MOST_PARTS):
            here = first + slope * done
            push = abs(here) - resistance
            side = math.copysign(1.0, velocity)
            if velocity == 0.0:
                side = -math.copysign(1.0, here)
                if push <= 0.0:
                    if abs(last) <= resistance:
                        break
                    done, push, side = (math.copysign(resistance, last) - first) / slope, 0.0, -math.copysign(1.0, last)
            else:
                push = -side * here - resistance
            left, speed, change = time_step - done, abs(velocity), -side * slope
            length = min(left, _find_stop(speed, push, change))
            place += side * length * (speed + length * (push / 2.0 + length * change / 6.0))
            peak = max(peak, abs(place))
            if length >= left:
                velocity = side * max(0.0, speed + left * (push + left * change / 2.0))
                break
            velocity, done = 0.0, done + length
    return max(peak, abs(place + math.copysign(velocity * velocity / (2.0 * resistance), velocity)))


@compiled_into
def _find_stop(speed: float, push: float, change: float) -> float:  # pragma: no cover
    """Return after what time a speed that grows by `push`, itself growing by `change`, is zero; infinity if never."""
    if speed == 0.0:  # it starts: with a push above zero, or one that grows from zero
        return -2.0 * push / change if change < 0.0 else math.inf
    root = push * push - 2.0 * speed * change
    if root < 0.0:
        return math.inf
    below = math.sqrt(root) - push
    return 2.0 * speed / below if below > 0.0 else math.inf
