"""Response spectra against eqsig, closed forms and their limits."""

import math

import numpy as np
import pytest
from eqsig import sdof
from hypothesis import given, settings
from hypothesis import strategies as st

from assess.motion.rows import run_rows
from assess.motion.spectrum import build_periods, response_spectrum
from assess.progress import SILENT
from tests.motion.motions import GROUND, ROOF, TWELFTH, read_motion

PERIODS = build_periods(0.05, 10.0, 60)
NOISE = np.random.default_rng(1).standard_normal((3, 400))


# --- against another implementation ---


OFTEN, SELDOM = ("a", ROOF), ("b", "c", "k", TWELFTH, GROUND)


@pytest.mark.parametrize(
    ("name", "damping"),
    [
        *((name, damping) for name in OFTEN for damping in (0.02, 0.05, 0.2)),
        *((name, 0.05) for name in SELDOM),
        *(pytest.param(name, damping, marks=pytest.mark.long) for name in SELDOM for damping in (0.02, 0.2)),
    ],
)
def test_against_eqsig(name: str, damping: float) -> None:
    """It has 2 pi to eight digits, hence 1e-8; the formulas in eqsig.sdof, unlike its AccSignal, do not resample."""
    motion = read_motion(name)
    ours = response_spectrum(motion.acceleration, motion.time_step, PERIODS, damping=damping)
    arguments = (motion.acceleration, motion.time_step, PERIODS, damping)
    _, _, pseudo = sdof.pseudo_response_spectra(*arguments)
    np.testing.assert_allclose(ours.pseudo, pseudo, rtol=1e-6)
    np.testing.assert_allclose(ours.absolute, sdof.true_response_spectra(*arguments)[2], rtol=1e-6)


def test_short_periods_are_computed_where_eqsig_puts_the_peak() -> None:
    """Below six time steps eqsig replaces PSA by PFA; with steps of 0.005 s that is below 0.03 s."""
    motion = read_motion("a")
    periods = np.array([0.029, 0.031])
    ours = response_spectrum(motion.acceleration, motion.time_step, periods).pseudo
    theirs = sdof.pseudo_response_spectra(motion.acceleration, motion.time_step, periods, 0.05)[2]
    assert theirs[0] == motion.pfa != ours[0]
    assert ours[0] == pytest.approx(ours[1], rel=0.2)
    assert ours[1] == pytest.approx(theirs[1], rel=1e-6)


# --- against closed forms ---


@pytest.mark.parametrize("damping", [0.01, 0.05, 0.3])
def test_a_sudden_constant_acceleration(damping: float) -> None:
    step, root = 0.01, math.sqrt(1 - damping**2)
    periods = 2 * step * root * np.array([20, 100, 437])  # the peak, half a damped period later, falls on a sample
    spectrum = response_spectrum(np.full(3000, -2.0), step, periods, damping=damping)
    overshoot = math.exp(-math.pi * damping / root)
    np.testing.assert_allclose(spectrum.pseudo, 2.0 * (1 + overshoot), rtol=1e-10)
    angle = 2 * np.pi * step * np.arange(3000)[:, None] / periods
    decay = np.exp(-damping * angle)
    wave = np.cos(root * angle) - damping / root * np.sin(root * angle)
    np.testing.assert_allclose(spectrum.absolute, np.abs(2.0 * (1 - decay * wave)).max(axis=0), rtol=1e-10)


def test_after_a_kick_it_swings_as_duhamel_says() -> None:
    """The first sample alone is a falling ramp of one step; then the ground is at rest."""
    step, damping, periods = 0.01, 0.05, np.array([0.08, 0.3, 1.0])
    kick = np.zeros(400)
    kick[0] = 3.0
    nodes, weights = np.polynomial.legendre.leggauss(30)
    tau = (nodes + 1) / 2 * step
    omega = 2 * np.pi / periods[:, None, None]
    damped = omega * math.sqrt(1 - damping**2)
    since = np.arange(1, 400)[:, None] * step - tau
    kernel = np.exp(-damping * omega * since) * np.sin(damped * since) / damped
    displacement = (kernel * 3.0 * (1 - tau / step) * weights * step / 2).sum(axis=-1)
    peaks = displacement.max(axis=1), -displacement.min(axis=1)
    exact = np.maximum(*peaks) * omega[:, 0, 0] ** 2
    np.testing.assert_allclose(response_spectrum(kick, step, periods).pseudo, exact, rtol=1e-10)


# --- limits ---


@pytest.mark.parametrize("name", ["a", ROOF, GROUND])
def test_a_stiff_oscillator_moves_with_the_floor(name: str) -> None:
    motion = read_motion(name)
    spectrum = response_spectrum(motion.acceleration, motion.time_step, np.array([1e-4, 1e-3]))
    np.testing.assert_allclose(spectrum.pseudo, motion.pfa, rtol=2e-3)
    np.testing.assert_allclose(spectrum.absolute, motion.pfa, rtol=2e-3)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_soft_oscillator_stays_where_it_is(seed: int) -> None:
    """Its relative displacement is that of the ground, which moves from rest along the parabolas of straight lines."""
    a, step = np.random.default_rng(seed).standard_normal(300), 0.02
    velocity = np.concatenate([[0.0], np.cumsum((a[1:] + a[:-1]) / 2 * step)])
    displacement = np.cumsum(velocity[:-1] * step + (2 * a[:-1] + a[1:]) / 6 * step**2)
    period = 400.0
    spectrum = response_spectrum(a, step, np.array([period]), damping=0.01)
    assert spectrum.pseudo[0] * (period / 2 / np.pi) ** 2 == pytest.approx(np.abs(displacement).max(), rel=5e-3)
    assert spectrum.absolute[0] < 2e-3


# --- arrays ---


def test_shapes_follow_those_of_the_motions() -> None:
    many, one = (response_spectrum(motions, 0.01, PERIODS) for motions in (NOISE, NOISE[1]))
    assert many.pseudo.shape == many.absolute.shape == (3, PERIODS.size)
    assert one.pseudo.shape == one.absolute.shape == PERIODS.shape
    np.testing.assert_array_equal(many.pseudo[1], one.pseudo)
    np.testing.assert_array_equal(many.absolute[1], one.absolute)


def test_threads_change_nothing() -> None:
    alone, shared = (response_spectrum(NOISE, 0.01, PERIODS, threads=number) for number in (1, 5))
    np.testing.assert_array_equal(alone.pseudo, shared.pseudo)
    np.testing.assert_array_equal(alone.absolute, shared.absolute)


@settings(max_examples=50, deadline=None)
@given(factor=st.floats(1e-6, 1e6), seed=st.integers(0, 1000), damping=st.floats(0.005, 0.95))
def test_it_scales_and_has_no_sign(factor: float, seed: int, damping: float) -> None:
    motion = np.random.default_rng(seed).standard_normal(60)
    plain, scaled = (
        response_spectrum(motion * by, 0.02, PERIODS[::6], damping=damping) for by in (1.0, -factor)
    )  # fmt: skip
    np.testing.assert_allclose(scaled.pseudo, factor * plain.pseudo, rtol=1e-9)
    np.testing.assert_allclose(scaled.absolute, factor * plain.absolute, rtol=1e-9)


def test_every_row_is_worked_once_and_an_error_in_a_thread_is_raised() -> None:
    for threads in (1, 3):
        done: list[int] = []
        run_rows(done.append, 20, threads, SILENT)
        assert sorted(done) == list(range(20))
    with pytest.raises(ZeroDivisionError):
        run_rows(lambda row: 1 // row, 4, 2, SILENT)


def test_what_cannot_be() -> None:
    periods: list[object] = [[], [[1.0]], 1.0, [0.0], [-1.0, 1.0], [1.0, math.nan], [math.inf]]
    for one in periods:
        with pytest.raises(ValueError, match="periods must be a list of finite numbers above 0 s"):
            response_spectrum(NOISE, 0.01, one)
    for damping in (0.0, 1.0, -0.05, 5.0, math.nan):
        with pytest.raises(ValueError, match=f"damping is {damping}, expected above 0 and below 1"):
            response_spectrum(NOISE, 0.01, PERIODS, damping=damping)
    for step in (0.0, -0.01, math.nan, math.inf):
        with pytest.raises(ValueError, match=f"time_step is {step} s, expected above 0"):
            response_spectrum(NOISE, step, PERIODS)
    for shape in ((), (1,), (0,), (3, 1), (2, 2, 2)):
        with pytest.raises(ValueError, match=r"acceleration has shape \(.*, expected \(n,\) or \(k, n\) with n of 2"):
            response_spectrum(np.ones(shape), 0.01, PERIODS)
