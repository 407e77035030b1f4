"""Bending of peaks: its limits, its slope, and that nothing drifts."""

import numpy as np
import pytest

from assess.arrays import FloatArray
from assess.motion.generate import MOST_SHARPENED
from assess.motion.recipe import MOST_BENT, TAPER, bend_rows, bend_to, build_taper, lift_rows, measure_rows, shape_rows
from assess.motion.target import Grid
from tests.motion.motions import GROUND, TWELFTH, read_motion

GRID = Grid(0.005, 2001)


def final_velocity(motion: FloatArray, time_step: float = 0.005) -> float:
    return float((motion[1:] + motion[:-1]).sum() * time_step / 2)


# --- the taper ---


def test_the_taper_grows_in_a_second_and_fades_in_one_and_on_a_shorter_grid_stays_below_one() -> None:
    taper, _ = build_taper(GRID)
    assert TAPER == 1.0
    assert (taper[0], taper[-1]) == (0.0, 0.0)
    np.testing.assert_array_equal(taper[200:-200], 1.0)
    assert taper[100] == pytest.approx(0.5)
    np.testing.assert_allclose(taper, taper[::-1], rtol=1e-6)
    assert (np.diff(taper[:201]) > 0).all()
    taper, slope = build_taper(Grid(0.005, 201))
    assert taper.max() == pytest.approx(0.25)
    np.testing.assert_allclose(np.gradient(taper, 0.005)[1:-1], slope[1:-1], atol=1e-2)


# --- how much is bent ---

PEAKS = np.array([0.7, 0.9, 1.1, 1.5])


def bent(values: FloatArray, bend: float) -> FloatArray:
    return np.asarray(values * (1 + bend * values**4 / (1 + values**4)))


@pytest.mark.parametrize("wanted", [0.9, 1.0, 1.05, 1.2])
def test_the_mean_of_peaks_becomes_what_is_wanted(wanted: float) -> None:
    bend = bend_to(PEAKS, wanted, 5.0)
    assert wanted * bent(PEAKS / wanted, bend).mean() == pytest.approx(wanted, rel=1e-12)


def test_within_its_share_a_mean_is_left_and_bending_is_limited() -> None:
    assert bend_to(PEAKS, PEAKS.mean() / 0.97, 1.0, 0.95, 0.98) == 0.0
    bend = bend_to(PEAKS, PEAKS.mean() / 0.9, 1.0, 0.95, 0.98)
    wanted = PEAKS.mean() / 0.9
    assert wanted * bent(PEAKS / wanted, bend).mean() == pytest.approx(0.95 * wanted)
    assert bend_to(PEAKS, 10.0, 0.4) == 0.4
    assert bend_to(PEAKS, 0.1, 0.4) == MOST_BENT


# --- motions that are bent ---


@pytest.mark.parametrize("bend", [0.0, MOST_BENT, 0.7, MOST_SHARPENED])
def test_velocity_is_bent_by_the_rule(bend: float) -> None:
    """The slope of the bent velocity, integrated, is the bent velocity."""
    grid = Grid(0.001, 10_001)
    times = np.arange(grid.count) * grid.time_step  # of a wave that grows and fades; its velocity reaches 1.5
    envelope, rate = 1.5 * np.sin(np.pi * times / 10), 1.5 * np.pi / 10 * np.cos(np.pi * times / 10)
    turn = 2 * np.pi * times
    acceleration, velocity = rate * np.sin(turn) + 2 * np.pi * envelope * np.cos(turn), envelope * np.sin(turn)
    longer = np.pad(acceleration, (0, 2000)).astype(np.float32)[None]  # two seconds of rest follow
    motions, peaks = np.empty((1, grid.count), np.float32), np.empty((1, 2))
    shape_rows(longer, *build_taper(grid), grid.time_step, 1.0, bend, motions, peaks)
    motion = motions[0].astype(np.float64)
    own = np.concatenate([[0.0], np.cumsum((motion[1:] + motion[:-1]) / 2 * grid.time_step)])
    taper = build_taper(grid)[0]
    np.testing.assert_allclose(own, taper * bent(velocity, bend), atol=5e-3)
    assert peaks[0, 0] == pytest.approx(np.abs(taper * velocity).max(), rel=1e-2)
    assert peaks[0, 1] == pytest.approx(np.abs(motion).max(), rel=1e-6)


@pytest.mark.parametrize("bend", [MOST_BENT, 0.7, MOST_SHARPENED])
def test_acceleration_is_bent_by_the_rule(bend: float) -> None:
    motions = np.linspace(-10, 10, 1001).astype(np.float32)[None].repeat(2, axis=0)
    expected = 5.0 * bent(motions.astype(np.float64) / 5.0, bend)
    bend_rows(motions, 5.0, bend)
    np.testing.assert_allclose(motions, expected, atol=1e-5)


# --- lifted peaks ---


@pytest.mark.parametrize("factor", [0.8, 0.99, 1.0, 1.05, 1.3])
@pytest.mark.parametrize("name", ["a", TWELFTH, GROUND])
def test_pfa_is_lifted_to_what_is_asked(name: str, factor: float) -> None:
    """Up to the constant that takes off the final velocity; each motion by its own PFA."""
    before = read_motion(name).acceleration
    pfa = np.abs(before).max()
    motions = np.stack([before, 0.1 * before]).astype(np.float32)
    lift_rows(motions, factor)
    lifted = before * (1 + (factor - 1) * (before / pfa) ** 4)
    constant = (lifted[1:] + lifted[:-1]).sum() / 2 / (before.size - 1)
    assert abs(constant) < 2e-3 * pfa
    np.testing.assert_allclose(motions[0], lifted - constant, atol=1e-6 * pfa)
    np.testing.assert_allclose(motions[1], 0.1 * motions[0], atol=1e-6 * pfa)


@pytest.mark.parametrize("name", ["a", TWELFTH, GROUND])
def test_nothing_drifts(name: str) -> None:
    motions = (read_motion(name).acceleration + 0.01)[None].astype(np.float32)
    assert abs(final_velocity(motions[0].astype(np.float64))) > 0.1
    lift_rows(motions, 1.1)
    assert abs(final_velocity(motions[0].astype(np.float64))) < 1e-5


def test_a_silent_motion_stays_silent() -> None:
    motions = np.zeros((1, 100), np.float32)
    lift_rows(motions, 1.2)
    np.testing.assert_array_equal(motions, 0.0)


def test_peaks_and_final_velocity_are_measured() -> None:
    """By hand: velocities 0, 1, 2, 1.5, 1 times the step."""
    peaks = np.empty((1, 3))
    measure_rows(np.array([[0.0, 2.0, 0.0, -1.0, 0.0]], np.float32), 0.01, peaks)
    np.testing.assert_allclose(peaks, [[2.0, 0.01 * 2.0, 0.01 * 1.0]], rtol=1e-6)
