"""Targets of recorded floors, and the samples that the floors of a building share."""

import numpy as np
import pytest

from assess.motion.spectrum import build_periods, response_spectrum
from assess.motion.target import (
    COUNT,
    LONGEST,
    SHORTEST,
    TIME_STEP,
    Grid,
    build_grid,
    matched_to,
    put_on_grid,
    recorded_target,
)
from tests.motion.motions import cut, make_motion, read_motion

# --- grid ---


def test_a_grid_is_as_long_as_the_longest_record_or_as_drawn_motions() -> None:
    motions = [
        make_motion(np.sin(np.arange(count)), step) for count, step in [(1001, 0.01), (301, 0.02), (5001, 0.001)]
    ]
    assert build_grid(motions) == Grid(0.005, 2001)
    assert build_grid(motions).duration == pytest.approx(10.0)
    assert build_grid(motions[2:]) == Grid(0.005, 1001)
    assert build_grid([make_motion(np.sin(np.arange(101)), 1 / 300)]) == Grid(0.005, 68), "a step that does not divide"
    short = [make_motion(np.sin(np.arange(1001)), 0.01)]
    assert build_grid(short, at_least=Grid(0.005, 7001)) == Grid(0.005, 7001)
    assert build_grid(short, at_least=Grid(0.005, 101)) == Grid(0.005, 2001)
    assert build_grid([], at_least=Grid(0.005, 7001)) == Grid(0.005, 7001)


def test_a_motion_is_put_on_the_grid_along_straight_lines_and_one_on_it_is_kept_to_the_bit() -> None:
    motion = make_motion(np.array([0.0, 2.0, 4.0, 1.0, 0.0, -2.0, 0.0, 1.0, 1.0, 3.0]), 0.01)
    on = put_on_grid(motion, Grid(0.005, 25))
    np.testing.assert_allclose(on[:7], [0.0, 1.0, 2.0, 3.0, 4.0, 2.5, 1.0])
    assert on[18] == 3.0
    np.testing.assert_array_equal(on[19:], 0.0)
    assert on.size == 25
    motion = read_motion("a")
    np.testing.assert_allclose(put_on_grid(motion, build_grid([motion])), motion.acceleration, atol=1e-12)


# --- targets ---


def test_matched_to_by_hand() -> None:
    periods = np.array([1.0, 2.0, 4.0, 5.0, 8.0])
    assert matched_to(periods, np.array([10.0, 6.0, 5.0, 4.9, 4.0]) / periods) == 6.0
    assert matched_to(periods, np.array([10.0, 4.0, 4.0, 4.0, 4.0]) / periods) == 3.0
    assert matched_to(periods, np.array([10.0, 4.0, 4.0, 4.0, 8.0]) / periods) == 10.0
    assert matched_to(periods, np.array([1e-4, 4e-5, 4e-5, 6e-5, 4e-5]) / periods) == 7.5


def test_the_target_of_a_record() -> None:
    motion = cut("a", 5, 15)
    target = recorded_target(motion, Grid(TIME_STEP, 3001))
    assert (target.pfa, target.pfv) == (motion.pfa, motion.pfv)
    np.testing.assert_array_equal(target.periods, build_periods(SHORTEST, LONGEST, COUNT))
    longer = np.pad(motion.acceleration, (0, 1000))
    periods = np.array([0.07, 0.7, 7.0])
    np.testing.assert_allclose(target.ordinates(periods), response_spectrum(longer, TIME_STEP, periods).pseudo)
    np.testing.assert_allclose(target.ordinates(target.periods), target.pseudo)
    assert target.envelopes.values.shape == (9, 3001)
