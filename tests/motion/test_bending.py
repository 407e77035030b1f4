"""Bending of peaks: its limits, its slope, and that nothing drifts."""

import math

import numpy as np
import pytest

from assess.motion.bending import (
    BENT,
    MOST_BENT,
    MOST_SHARPENED,
    PFA_FREE,
    PFV_FREE_ABOVE,
    PFV_FREE_BELOW,
    TAPER,
    Bend,
    bend_row,
    build_taper,
    lift_peaks,
    settle,
)
from assess.motion.record import FloatArray
from assess.motion.target import Grid
from tests.motion.motions import GROUND, TWELFTH, read_motion

GRID = Grid(0.005, 2001)


def final_velocity(motion: FloatArray, time_step: float = 0.005) -> float:
    return float((motion[1:] + motion[:-1]).sum() * time_step / 2)


# --- the taper ---


def test_the_taper_grows_in_a_second_and_fades_in_one() -> None:
    taper, _ = build_taper(GRID)
    assert TAPER == 1.0
    assert (taper[0], taper[-1]) == (0.0, 0.0)
    np.testing.assert_array_equal(taper[200:-200], 1.0)
    assert taper[100] == pytest.approx(0.5)
    np.testing.assert_allclose(taper, taper[::-1])
    assert (np.diff(taper[:201]) > 0).all()


def test_its_slope_is_its_derivative() -> None:
    taper, slope = build_taper(GRID)
    np.testing.assert_allclose(np.gradient(taper, 0.005)[1:-1], slope[1:-1], atol=1e-2)
    assert (slope[0], slope[-1]) == (0.0, 0.0)


def test_on_a_grid_shorter_than_both_it_stays_below_one() -> None:
    taper, slope = build_taper(Grid(0.005, 201))
    assert taper.max() == pytest.approx(0.25)
    np.testing.assert_allclose(np.gradient(taper, 0.005)[1:-1], slope[1:-1], atol=1e-2)


# --- how much is bent ---


def test_small_errors_are_left() -> None:
    assert Bend().turned(PFV_FREE_BELOW, PFA_FREE) == Bend()
    assert Bend().turned(-PFV_FREE_ABOVE, -PFA_FREE) == Bend()
    assert Bend().turned(0.0, 0.0) == Bend()


def test_what_is_beyond_is_bent_by_its_share() -> None:
    bend = Bend(0.1, -0.2).turned(PFV_FREE_BELOW + 0.03, -PFA_FREE - 0.05)
    assert bend.velocity == pytest.approx(0.1 + BENT * 0.03)
    assert bend.acceleration == pytest.approx(-0.2 - BENT * 0.05)
    assert Bend().turned(-PFV_FREE_ABOVE - 0.03, 0.0).velocity == pytest.approx(-BENT * 0.03)


def test_it_is_limited() -> None:
    assert Bend().turned(10.0, 10.0) == Bend(MOST_SHARPENED, MOST_SHARPENED)
    assert Bend().turned(-10.0, -10.0) == Bend(MOST_BENT, MOST_BENT)


@pytest.mark.parametrize("bend", [MOST_BENT, -0.2, 0.5, MOST_SHARPENED])
def test_within_its_limits_a_larger_value_stays_larger(bend: float) -> None:
    x = np.linspace(0, 5, 5001)
    bent = x * (1 + bend * x**4 / (1 + x**4))
    assert (np.diff(bent) > 0).all()


def test_beyond_them_it_does_not() -> None:
    x = np.linspace(0, 5, 5001)
    assert (np.diff(x * (1 - 0.66 * x**4 / (1 + x**4))) < 0).any()


# --- a motion that is bent ---


def bend_one(
    acceleration: FloatArray, velocity: FloatArray, grid: Grid, bend: Bend, pfa: float = 1.0, pfv: float = 1.0
) -> tuple[FloatArray, FloatArray]:
    motion, peaks = np.empty(grid.count), np.full(2, 99.0)
    arguments = (grid.time_step, pfa, pfv, bend.acceleration, bend.velocity, motion, peaks)
    bend_row(acceleration, velocity, *build_taper(grid), *arguments)
    return motion, peaks


def wave(grid: Grid) -> tuple[FloatArray, FloatArray]:
    """Return acceleration and velocity of a wave that grows and fades; velocity reaches 1.5."""
    times = np.arange(grid.count) * grid.time_step
    envelope, rate = 1.5 * np.sin(np.pi * times / 10), 1.5 * np.pi / 10 * np.cos(np.pi * times / 10)
    turn = 2 * np.pi * times
    return rate * np.sin(turn) + 2 * np.pi * envelope * np.cos(turn), envelope * np.sin(turn)


@pytest.mark.parametrize("bend", [0.0, MOST_BENT, 0.7, MOST_SHARPENED])
def test_velocity_is_bent_by_the_rule(bend: float) -> None:
    """The slope of the bent velocity, integrated, is the bent velocity."""
    grid = Grid(0.001, 10_001)
    acceleration, velocity = wave(grid)
    motion, peaks = bend_one(acceleration, velocity, grid, Bend(velocity=bend))
    own = np.concatenate([[0.0], np.cumsum((motion[1:] + motion[:-1]) / 2 * grid.time_step)])
    x = velocity**4
    expected = build_taper(grid)[0] * velocity * (1 + bend * x / (1 + x))
    np.testing.assert_allclose(own, expected, atol=2e-4)
    assert peaks[1] == pytest.approx(np.abs(own).max(), rel=1e-9)


@pytest.mark.parametrize("bend", [MOST_BENT, 0.7, MOST_SHARPENED])
def test_acceleration_is_bent_by_the_rule(bend: float) -> None:
    acceleration, velocity = wave(GRID)
    plain, _ = bend_one(acceleration, velocity, GRID, Bend())
    motion, peaks = bend_one(acceleration, velocity, GRID, Bend(acceleration=bend), pfa=5.0)
    y = (plain / 5.0) ** 4
    np.testing.assert_allclose(motion, plain * (1 + bend * y / (1 + y)), atol=0.03)  # less a constant
    assert peaks[0] == np.abs(motion).max()


def test_without_bending_only_the_taper_acts() -> None:
    acceleration, velocity = wave(GRID)
    motion, peaks = bend_one(acceleration, velocity, GRID, Bend())
    np.testing.assert_allclose(motion[200:-200], acceleration[200:-200], atol=1e-3)
    assert peaks[0] == np.abs(motion).max()


@pytest.mark.parametrize("bend", [Bend(), Bend(MOST_BENT, MOST_SHARPENED), Bend(MOST_SHARPENED, MOST_BENT)])
def test_nothing_drifts(bend: Bend) -> None:
    values = np.random.default_rng(1).standard_normal((2, 2001))
    motion, _ = bend_one(values[0], values[1], GRID, bend)
    assert abs(final_velocity(motion)) < 1e-12


# --- lifted peaks ---


@pytest.mark.parametrize("factor", [0.8, 0.99, 1.0, 1.05, 1.3])
@pytest.mark.parametrize("name", ["a", TWELFTH, GROUND])
def test_pfa_is_lifted_to_what_is_asked(name: str, factor: float) -> None:
    """Exactly, up to the constant that takes off the final velocity."""
    before = read_motion(name).acceleration
    pfa = np.abs(before).max()
    motions = before[None].copy()
    lift_peaks(motions, np.array([factor]), 1)
    lifted = before * (1 + (factor - 1) * (before / pfa) ** 4)
    assert np.abs(lifted).max() == pytest.approx(factor * pfa, rel=1e-12)
    constant = (lifted[1:] + lifted[:-1]).sum() / 2 / (before.size - 1)
    assert abs(constant) < 2e-3 * pfa
    np.testing.assert_allclose(motions[0], lifted - constant, atol=1e-12)
    assert abs(final_velocity(motions[0])) < 1e-12


def test_each_row_has_its_own_factor_and_threads_change_nothing() -> None:
    motions = np.random.default_rng(1).standard_normal((5, 1000))
    motions -= motions.mean(axis=1, keepdims=True)
    factors = np.array([0.9, 1.0, 1.1, 1.2, 1.3])
    alone, shared = motions.copy(), motions.copy()
    lift_peaks(alone, factors, 1)
    lift_peaks(shared, factors, 3)
    np.testing.assert_array_equal(alone, shared)
    np.testing.assert_allclose(np.abs(alone).max(axis=1) / np.abs(motions).max(axis=1), factors, rtol=5e-3)


def test_a_constant_is_taken_off_by_hand() -> None:
    motion = np.array([1.0, 2.0, 3.0, 5.0])
    settle(motion, motion.sum())
    np.testing.assert_allclose(motion, np.array([1.0, 2.0, 3.0, 5.0]) - 8 / 3)  # trapezoids 1.5 + 2.5 + 4
    assert math.isclose(final_velocity(motion), 0.0, abs_tol=1e-15)
