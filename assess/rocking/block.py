"""One rigid rectangular block (section 2.1 of the paper): its angle, radius, frequency and restitution.

Reference: Housner G (1963). The behavior of inverted pendulum structures during earthquakes. Bulletin of the
Seismological Society of America 53(2):403-417.
"""

import numpy as np
from numpy.typing import NDArray

from assess.units import GRAVITY

FloatArray = NDArray[np.float64]

STOCKY = 1.41
"""From this B/H on [-] a block does not rock: Housner's restitution 1 - 1.5 sin2(alpha) is zero at B/H = sqrt 2."""


def critical_angle(breadth: FloatArray, height: FloatArray) -> FloatArray:
    """Angle alpha between the side and the diagonal [rad]: tan(alpha) = B/H."""
    return np.arctan(breadth / height)


def radius(breadth: FloatArray, height: FloatArray) -> FloatArray:
    """Half diagonal r [m]."""
    return 0.5 * np.hypot(breadth, height)


def frequency_parameter(breadth: FloatArray, height: FloatArray) -> FloatArray:
    """Frequency parameter p [rad/s], eq. 4: p = sqrt(3 g / 4 r)."""
    return np.sqrt(3 * GRAVITY / (4 * radius(breadth, height)))


def restitution(breadth: FloatArray, height: FloatArray) -> FloatArray:
    """Angular velocity after an impact over that before it [-]: 1 - 1.5 sin2(alpha), equal angular momentum."""
    return 1 - 1.5 * np.sin(critical_angle(breadth, height)) ** 2
