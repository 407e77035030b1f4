"""Directions: which axis of the building a piece, or a record, lies along."""

from assess.inventory.model import Axis

NEAR_AXIS = 15.0
"""Up to this angle [deg] from an axis a piece, or a record, counts as lying along it."""


def angle_between(one: float, other: float) -> float:
    """Return the smallest angle between two undirected lines [deg]."""
    return abs((one - other + 90) % 180 - 90)


def axis_of(angle: float) -> Axis | None:
    """Return the axis that a line at `angle` [deg] from X lies along, None where it lies between the two."""
    if angle_between(angle, 0) <= NEAR_AXIS:
        return "X"
    return "Y" if angle_between(angle, 90) <= NEAR_AXIS else None
