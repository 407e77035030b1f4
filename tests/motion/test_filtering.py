"""The filter: its choice of periods, random vibration, and that steps go where they should."""

import math

import numpy as np
import pytest

from assess.motion.drawn_ground import find_shape
from assess.motion.generate import choose_periods, gains_of, guess_power, improve, response_matrix, roll_off
from assess.motion.target import Grid, recorded_target
from tests.motion.motions import read_motion

STEP = 0.005
GRID = Grid(STEP, 4000)
PERIODS = np.geomspace(0.03, 10, 80)


def test_of_two_neighbours_the_one_that_stands_out_is_chosen() -> None:
    target = recorded_target(read_motion("a"), GRID)
    places = choose_periods(target)
    assert places.size == target.periods.size // 2
    assert set(places // 2) == set(range(places.size))
    logs = np.log(target.pseudo)
    out = np.abs(logs[2:-2] - (logs[:-4] + logs[4:]) / 2)
    for pair, place in enumerate(places[1:-1], start=1):
        assert out[place - 2] == out[2 * pair - 2 : 2 * pair].max()


def test_the_variance_of_a_response_to_white_noise() -> None:
    """Of power 1 per Hz: pi f / (4 damping) [Crandall and Mark], while the filter's ends are far away."""
    matrix = response_matrix(PERIODS, STEP)
    for place in (20, 30, 40):
        frequency = 1 / PERIODS[place]
        expected = math.pi * frequency / (4 * 0.05)
        # The integral over d(log f) of power times f is that over df.
        fine = np.geomspace(0.02, 100, 800)
        assert matrix[place].sum() * math.log(fine[1] / fine[0]) == pytest.approx(expected, rel=0.03)


def test_the_first_guess_gives_the_variances_that_are_wanted() -> None:
    wanted = 2.0 * find_shape(PERIODS, 0.1)
    matrix = response_matrix(PERIODS, STEP)
    power = guess_power(matrix, PERIODS, wanted)
    factor = np.sqrt(2 * np.log(2.8 * np.maximum(20.0 / PERIODS, 1)))
    got = factor * np.sqrt((matrix * power).sum(axis=1))
    near = (PERIODS > 0.06) & (PERIODS < 5)
    np.testing.assert_allclose(got[near], wanted[near], rtol=0.15)


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


def test_gains_are_the_root_of_power_and_fall_off_below_the_corner() -> None:
    gains = gains_of(np.full(80, 4.0), PERIODS, np.array([0.0, 0.01, 0.1, 1.0, 50.0]))
    assert gains[0] == 0.0
    assert gains[1] < 1e-3
    assert gains[2] == pytest.approx(2 / math.sqrt(2), rel=1e-5)
    np.testing.assert_allclose(gains[3:], 2.0, rtol=1e-5)
    np.testing.assert_allclose(roll_off(np.array([0.0, 0.1])), [0.0, 0.5])
