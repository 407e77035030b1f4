"""One rigid body that rocks in a plane: its angle, radius, frequency, restitution, and where its rocking starts.

A block of section 2.1 of the paper is uniform, its centre of gravity at half its height. A piece that is not has its
centre at another `centre`, a share of its height; its moment of inertia about the centre stays that of the rectangle,
m (B2 + H2) / 12. With half base b = B/2, height z of the centre and R2 = b2 + z2, the equation of motion is the same.

Reference: Housner G (1963). The behavior of inverted pendulum structures during earthquakes. Bulletin of the
Seismological Society of America 53(2):403-417.
"""

from typing import Any

import numpy as np

from assess.units import GRAVITY

ROLLS_FROM = 0.35
"""b/z_c [-] from which a piece on castors is taken to roll and not to overturn: one that is more slender may overturn
where a castor meets a kerb or a threshold, or is locked. Assumed."""
STOCKY = 1.41
"""From this B/H on [-] a uniform block does not rock: Housner's restitution 1 - 1.5 sin2(alpha) is zero at sqrt 2."""
MIDDLE = 0.5
"""Height of the centre of gravity of a uniform block, as a share of its own [-]."""


def threshold(breadth: Any, height: Any, centre: Any = MIDDLE) -> Any:
    """Ground acceleration at which rocking starts [g]: tan(alpha) = b/z, which is B/H of a uniform block."""
    return breadth / (2 * centre * height)


def critical_angle(breadth: Any, height: Any, centre: Any = MIDDLE) -> Any:
    """Angle alpha between the side and the line from the edge to the centre of gravity [rad]: tan(alpha) = b/z."""
    return np.arctan(threshold(breadth, height, centre))


def radius(breadth: Any, height: Any, centre: Any = MIDDLE) -> Any:
    """Distance R of the centre of gravity from the edge [m]."""
    return np.hypot(breadth / 2, centre * height)


def frequency_parameter(breadth: Any, height: Any, centre: Any = MIDDLE) -> Any:
    """Frequency parameter p [rad/s]: p2 = m g R / I0, eq. 4; sqrt(3 g / 4 R) of a uniform block."""
    R = radius(breadth, height, centre)
    return np.sqrt(GRAVITY * R / (_inertia(breadth, height) + R**2))


def restitution(breadth: Any, height: Any, centre: Any = MIDDLE) -> Any:
    """Angular velocity after an impact over that before it [-], by equal angular momentum about the new edge.

    1 - 2 m R2 sin2(alpha) / I0, with R sin(alpha) = b; 1 - 1.5 sin2(alpha) of a uniform block.
    """
    return 1 - breadth**2 / (2 * (_inertia(breadth, height) + radius(breadth, height, centre) ** 2))


def stocky_limit(centre: Any = MIDDLE) -> Any:
    """B/H from which on a body does not rock [-]: where its restitution is zero, in proportion to `STOCKY`."""
    return STOCKY * np.sqrt((0.5 + 6 * np.square(centre)) / 2)


def _inertia(breadth: Any, height: Any) -> Any:
    """Moment of inertia about the centre of gravity over the mass [m2]."""
    return (breadth**2 + height**2) / 12
