"""Boxes of pieces, and the base on which each stands."""

import itertools
import math
from itertools import pairwise

import numpy as np
import pytest
import shapely

from assess.bim.plan_shapes import Shape, find_box


def draw(*boxes: tuple[float, float, float, float, float, float], turn: float = 0.0) -> Shape:
    """Return boxes as one shape, each by two corners (x, y, z), turned about Z [deg]; of triangles it has none."""
    points = [(x, y, z) for one in boxes for x in one[0::3] for y in one[1::3] for z in one[2::3]]
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    axes = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return Shape(np.array(points) @ axes.T, np.empty((0, 3), np.int64), axes)


def leg(x: float, y: float, half: float = 0.001) -> tuple[float, float, float, float, float, float]:
    return x - half, y - half, 0.0, x + half, y + half, 0.5


WARDROBE = (-0.3, -0.5, 0.1, 0.3, 0.5, 2.0)


def test_a_plinth_set_back_at_the_front_only_and_a_base_in_the_form_of_a_cross():
    for turn in (0.0, 30.0, -75.0):
        found = find_box(draw(WARDROBE, (-0.3, -0.5, 0.0, 0.2, 0.5, 0.1), turn=turn))
        assert (found.breadth, found.support_breadth) == pytest.approx((0.6, 0.5)), turn
        assert (found.support_reach, found.support_angle_deg) == pytest.approx((0.2, turn)), turn
        assert found.support_across == pytest.approx(1.0), turn
    # Four feet on the axes, 35 cm from the middle: the edges between them are at 45 degrees, and nearer.
    body = (-0.35, -0.35, 0.5, 0.35, 0.35, 1.0)
    found = find_box(draw(body, leg(0.349, 0), leg(0, 0.349), leg(-0.349, 0), leg(0, -0.349)))
    assert found.support_breadth == pytest.approx(0.7)
    assert found.support_reach == pytest.approx(0.35 / math.sqrt(2), abs=2e-3)
    assert abs(found.support_angle_deg) == pytest.approx(45, abs=0.5)
    assert found.support_across == pytest.approx(0.7 * math.sqrt(2))


def test_feet_at_the_corners_of_a_rectangle_about_the_middle_and_a_middle_beside_its_base_has_no_reach():
    # The edge along the longer side is the nearest; of a square, one along its own axes.
    for turn, width in itertools.product((0.0, 30.0, -75.0), (1.0, 0.6)):
        feet = [leg(i * 0.25, j * (width / 2 - 0.05)) for i in (-1, 1) for j in (-1, 1)]
        found = find_box(draw((-0.3, -width / 2, 0.5, 0.3, width / 2, 0.6), *feet, turn=turn))
        assert found.support_reach == pytest.approx(found.support_breadth / 2), (turn, width)
        assert found.support_angle_deg == pytest.approx(found.angle_deg), (turn, width)
        assert found.support_across == pytest.approx(found.width), (turn, width)
    # Beside the middle, two feet, one foot.
    for on in ([(0.2, -0.4), (0.2, 0.4), (0.28, 0.0)], [(0.1, -0.4), (0.1, 0.4)], [(0.0, 0.0)]):
        found = find_box(draw(WARDROBE, *(leg(x, y, 0.0) for x, y in on)))
        assert (found.support_reach, found.support_angle_deg) == (0.0, found.angle_deg), on


def test_no_direction_is_nearer_than_the_edge_that_is_found():
    """Of any base: the distance from the middle to its outline, followed all the way round."""
    rng = np.random.default_rng(7)
    for _ in range(50):
        feet = rng.uniform(-0.3, 0.3, (12, 2))
        found = find_box(draw((-0.3, -0.3, 0.5, 0.3, 0.3, 1.0), *(leg(x, y, 0.0) for x, y in feet)))
        ring = shapely.get_coordinates(shapely.MultiPoint(feet).convex_hull).tolist()
        steps = np.linspace(0, 1, 500)[:, None]
        around = np.vstack([np.array(one) + steps * np.subtract(other, one) for one, other in pairwise(ring)])
        nearest = around[np.hypot(*around.T).argmin()]
        assert found.support_reach == pytest.approx(np.hypot(*nearest), abs=1e-3)
        assert found.support_across >= 2 * found.support_reach
