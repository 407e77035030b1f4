"""One rigid block: angle, radius, frequency and restitution."""

import math

import numpy as np
import pytest

from assess.arrays import FloatArray
from assess.rocking import block
from assess.units import GRAVITY


def of_radius_and_angle(radius: float, angle: float) -> tuple[FloatArray, FloatArray]:
    return np.array([2 * radius * math.sin(angle)]), np.array([2 * radius * math.cos(angle)])


def test_angle_radius_and_frequency_parameter_of_equation_4():
    breadth, height = np.array([0.6]), np.array([0.8])
    assert block.critical_angle(breadth, height)[0] == pytest.approx(math.atan(0.75))
    assert block.radius(breadth, height)[0] == pytest.approx(0.5)
    assert block.frequency_parameter(breadth, height)[0] == pytest.approx(math.sqrt(3 * GRAVITY / (4 * 0.5)))


def test_the_block_of_figure_2_is_no_block_of_90_centimetres():
    # Figure 2 of the paper: p = 2.14 rad/s at α = 0.25 rad is r = 1.61 m, B = 0.79 m, H = 3.11 m
    breadth, height = of_radius_and_angle(1.606, 0.25)
    assert block.frequency_parameter(breadth, height)[0] == pytest.approx(2.14, abs=0.001)
    assert breadth[0] == pytest.approx(0.79, abs=0.005)
    assert height[0] == pytest.approx(3.11, abs=0.005)
    # its "H = 0.9 m" would be p = 3.98 rad/s
    short = np.array([0.9])
    assert block.frequency_parameter(short * math.tan(0.25), short)[0] == pytest.approx(3.98, abs=0.005)


def test_restitution_vanishes_where_a_block_no_longer_rocks():
    breadth, height = of_radius_and_angle(1.0, 0.25)
    assert block.restitution(breadth, height)[0] == pytest.approx(0.908, abs=0.0005)
    ratios = np.array([0.01, 0.5, block.STOCKY, math.sqrt(2), 1.5])
    restitution = block.restitution(ratios, np.ones(5))
    assert np.all(np.diff(restitution) < 0)
    assert restitution[0] == pytest.approx(1, abs=2e-4)
    assert 0 < restitution[2] < 0.01
    assert restitution[3] == pytest.approx(0, abs=1e-12)
    assert restitution[4] < 0


@pytest.mark.parametrize(
    ("centre", "alpha", "p", "eta", "threshold"),
    [
        (0.4, 0.25732, 2.87596, 0.91414, 0.2632),
        (0.5, 0.20750, 2.75246, 0.93634, 0.2105),
        (0.6, 0.17367, 2.61979, 0.95163, 0.1754),
    ],
)
def test_general_body_rotates_about_its_own_centre_of_gravity(centre, alpha, p, eta, threshold):
    """Physics of a body whose centre of gravity is not in the middle: 0.40 x 1.90 m, computed twice independently."""
    body = 0.40, 1.90, centre
    assert block.critical_angle(*body) == pytest.approx(alpha, abs=5e-6)
    assert block.frequency_parameter(*body) == pytest.approx(p, abs=5e-6)
    assert block.restitution(*body) == pytest.approx(eta, abs=5e-6)
    assert block.threshold(*body) == pytest.approx(threshold, abs=5e-5)


@pytest.mark.parametrize("centre", [0.3, 0.5, 0.7])
def test_body_at_the_stocky_limit_has_almost_no_restitution(centre):
    limit = block.stocky_limit(centre)
    assert 0 < block.restitution(limit, 1.0, centre) < 0.006
    assert block.restitution(math.sqrt(2) / block.STOCKY * limit, 1.0, centre) == pytest.approx(0, abs=1e-12)
