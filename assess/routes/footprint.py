"""What a piece covers on the plan: where it stands, and where it lies once it has fallen."""

import math

from assess.inventory.model import Item

Point = tuple[float, float]
Corners = tuple[Point, Point, Point, Point]


def turn(item: Item) -> float:
    """Return the direction of Breadth [deg], anticlockwise from X: that of the axis where no angle is given."""
    if item.angle_deg is not None:
        return item.angle_deg
    return 90.0 if item.axis == "Y" else 0.0


def rectangle(at: Point, angle: float, along: tuple[float, float], across: float) -> Corners:
    """Return the corners of a rectangle, anticlockwise.

    Parameters
    ----------
    at : (2,) floats
        Centre of the piece [m].
    angle : float
        Direction of Breadth, anticlockwise from X [deg].
    along : (2,) floats
        Where it begins and ends along Breadth, from the centre [m].
    across : float
        Its width across Breadth [m], half of it on each side.
    """
    cos, sin = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    (x, y), (near, far), half = at, along, across / 2
    local = ((near, -half), (far, -half), (far, half), (near, half))
    one, two, three, four = ((x + u * cos - v * sin, y + u * sin + v * cos) for u, v in local)
    return one, two, three, four


def fallen(at: Point, angle: float, breadth: float, width: float, height: float) -> tuple[Corners, Corners]:
    """Return what a piece covers beyond its footprint if it falls over either of its edges across Breadth.

    Either, as the sign of a motion says nothing of the way in which a piece falls.
    """
    edge = breadth / 2
    return rectangle(at, angle, (edge, edge + height), width), rectangle(at, angle, (-edge - height, -edge), width)
