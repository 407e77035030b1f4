"""The filter: its choice of periods, random vibration, and that steps go where they should."""

import math

import numpy as np
import pytest

from assess.motion.calibrate import improve, response_matrix

STEP = 0.005
PERIODS = np.geomspace(0.03, 10, 80)


def test_the_variance_of_a_response_to_white_noise() -> None:
    """Of power 1 per Hz: pi f / (4 damping) [Crandall and Mark], while the filter's ends are far away."""
    matrix = response_matrix(PERIODS, STEP)
    for place in (20, 30, 40):
        frequency = 1 / PERIODS[place]
        expected = math.pi * frequency / (4 * 0.05)
        # The integral over d(log f) of power times f is that over df.
        fine = np.geomspace(0.02, 100, 800)
        assert matrix[place].sum() * math.log(fine[1] / fine[0]) == pytest.approx(expected, rel=0.03)


def test_steps_find_a_filter_whose_responses_are_known() -> None:
    """Of a power with a hump, from flat: by the slopes of random vibration itself."""
    matrix = response_matrix(PERIODS, STEP)
    hidden = 1 + 20 * np.exp(-((np.log(PERIODS / 0.5) / 0.3) ** 2))
    wanted, power = np.sqrt((matrix * hidden).sum(axis=1)), np.ones(80)
    off = []
    for _ in range(8):
        error = np.log(wanted / np.sqrt((matrix * power).sum(axis=1)))
        off.append(np.abs(error).max())
        power = improve(matrix, power, error, np.ones(80))
    assert off[0] > 1.0
    assert off[-1] < 0.05
    assert (np.diff(off) < 0.01).all()
