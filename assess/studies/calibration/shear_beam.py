"""Floor motions of a uniform shear beam that stands on a recorded ground motion.

Stiffness and mass are constant over the height h. Mode n has the period T1/(2n - 1) and the shape
sin((2n - 1) pi z/(2 h)), with a participation factor of 4/((2n - 1) pi); all modes have the same damping. The absolute
acceleration of a floor is the sum of those of its modes, each an oscillator on the ground. Modes above `HIGHEST` are
taken as rigid: their share of the floor moves with the ground.

Reference: Miranda E, Taghavi S (2005). Approximate floor acceleration demands in multistory buildings. I: Formulation.
Journal of Structural Engineering 131(2):203-211. doi:10.1061/(ASCE)0733-9445(2005)131:2(203). The beam of this module
is theirs without its flexural part.
"""

import math

import numpy as np

from assess.compiled import compiled
from assess.motion.record import FloatArray
from assess.motion.spectrum import oscillator_step

DAMPING = 0.05
"""Share of critical damping of every mode [-]."""
HIGHEST = 25.0
"""Highest frequency of a mode that is not taken as rigid [Hz]: records hold little above."""


def count_modes(period: float) -> int:
    """Return how many modes of a beam with T1 [s] are up to `HIGHEST`, at least 1."""
    return max(1, math.floor((HIGHEST * period + 1) / 2))


def find_shares(modes: int, place: float) -> FloatArray:
    """Return participation factor times shape of each mode at the height z/h [-], (modes,); over all modes they are 1.

    At z/h 0 they are 0: the ground.
    """
    odd = 2 * np.arange(modes) + 1
    return np.asarray(4 / (np.pi * odd) * np.sin(odd * np.pi / 2 * place), dtype=np.float64)


def shake_beam(
    ground: FloatArray, time_step: float, period: float, place: float, *, modes: int | None = None
) -> FloatArray:
    """Return the absolute acceleration of a floor [m/s2], (n,), of a beam at rest that a ground motion shakes.

    Parameters
    ----------
    ground : (n,) array
        Ground acceleration [m/s2], linear between its samples.
    time_step : float
        [s]
    period : float
        T1 [s].
    place : float
        Height of the floor over that of the building, z/h [-].
    modes : int, optional
        Number of modes that are not taken as rigid; `count_modes` if it is not given.

    Raises
    ------
    ValueError
        If T1 is not above 0, or z/h is outside 0 to 1.
    """
    if not (0 < period < math.inf and 0 <= place <= 1):
        raise ValueError(f"T1 is {period} s and z/h {place}, expected above 0 and 0 to 1")
    count = count_modes(period) if modes is None else modes
    shares, periods = find_shares(count, place), period / (2 * np.arange(count) + 1)
    floor = (1 - shares.sum()) * ground
    _add_modes(np.ascontiguousarray(ground), oscillator_step(periods, time_step, DAMPING), shares, floor)
    return np.asarray(floor)


@compiled
def _add_modes(ground: FloatArray, step: FloatArray, shares: FloatArray, floor: FloatArray) -> None:  # pragma: no cover
    """Add to `floor` (n,) the absolute accelerations of oscillators, each multiplied by its share."""
    u, v = np.zeros(shares.size), np.zeros(shares.size)
    for i in range(ground.size - 1):
        a, b = ground[i], ground[i + 1]
        for j in range(shares.size):
            next_u = step[0, j] * u[j] + step[1, j] * v[j] + step[4, j] * a + step[5, j] * b
            next_v = step[2, j] * u[j] + step[3, j] * v[j] + step[6, j] * a + step[7, j] * b
            u[j], v[j] = next_u, next_v
            floor[i + 1] -= shares[j] * (step[8, j] * next_v + step[9, j] * next_u)
