"""Peak floor velocity where it is neither recorded nor given."""

import math

HIGHEST_FLOOR_FREQUENCY = 1.3
"""Upper end [Hz] of the frequency with which PFV is estimated from PFA. The floors of a stiff building move with the
ground, and this keeps their velocity from being underestimated; our choice, the lower corner of ICC-ES AC156."""


def estimate_pfv(pfa: float, period: float) -> float:
    """Return PFV [m/s] = PFA/(2 pi f), f = min(1/T1, 1.3 Hz), from PFA [m/s2] and the building's period T1 [s].

    It is the paper's equivalent floor frequency, equation (7), solved for PFV.
    """
    return pfa / (2 * math.pi * min(1 / period, HIGHEST_FLOOR_FREQUENCY))
