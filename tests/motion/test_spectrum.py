"""Response spectra against eqsig, closed forms and their limits."""

import math

import numpy as np
import pytest
from eqsig import sdof
from hypothesis import given, settings, strategies as st

from assess.arrays import FloatArray
from assess.motion.rows import run_rows
from assess.motion.spectrum import build_periods, oscillator_step, response_spectrum
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


def response_to_cosine(
    forcing: float, period: float, damping: float, times: FloatArray, images: FloatArray, weights: FloatArray
) -> tuple[float, float]:
    """Return peak pseudo and absolute acceleration at `times` under the sum of weights cos(images t), from rest.

    At the samples each image is the cosine of circular frequency `forcing`.
    """
    omega = 2 * math.pi / period
    damped = omega * math.sqrt(1 - damping**2)
    steady = -weights / (omega**2 - images**2 + 2j * damping * omega * images)
    u, v = steady.sum(), (1j * images * steady).sum()
    cosine = -u.real
    sine = (-v.real + damping * omega * cosine) / damped
    decay, turn = np.exp(-damping * omega * times), np.exp(1j * forcing * times)
    c, s = np.cos(damped * times), np.sin(damped * times)
    displacement = (u * turn).real + decay * (cosine * c + sine * s)
    slope = (sine * damped - damping * omega * cosine) * c - (cosine * damped + damping * omega * sine) * s
    velocity = (v * turn).real + decay * slope
    total = omega**2 * displacement + 2 * damping * omega * velocity
    return omega**2 * float(np.abs(displacement).max()), float(np.abs(total).max())


@pytest.mark.parametrize("damping", [0.05, 0.2])
@pytest.mark.parametrize("step", [0.02, 0.005])
def test_a_cosine_on_straight_lines(step: float, damping: float) -> None:
    """Straight lines between samples are the cosine and its images about the sampling frequency, times sinc squared."""
    forcing, times = 2 * np.pi * 1.7, np.arange(2000) * step
    images = forcing + 2 * np.pi / step * np.arange(-2000, 2001)
    weights = np.sinc(images * step / (2 * np.pi)) ** 2
    periods = np.array([0.05, 0.3, 1 / 1.7, 2.0])
    spectrum = response_spectrum(np.cos(forcing * times), step, periods, damping=damping)
    exact = np.array([response_to_cosine(forcing, period, damping, times, images, weights) for period in periods])
    np.testing.assert_allclose(np.transpose([spectrum.pseudo, spectrum.absolute]), exact, rtol=1e-6)


def test_a_cosine_of_fine_steps() -> None:
    """With 4,000 steps a cycle, straight lines take off (w dt)^2/12, 2e-7."""
    step, forcing = 0.00025, 2 * np.pi
    times = np.arange(80_000) * step
    periods = np.array([0.4, 1.0, 3.0])
    spectrum = response_spectrum(np.cos(forcing * times), step, periods)
    exact = [
        response_to_cosine(forcing, period, 0.05, times, np.array([forcing]), np.array([1.0])) for period in periods
    ]
    np.testing.assert_allclose(np.transpose([spectrum.pseudo, spectrum.absolute]), exact, rtol=1e-6)


def test_resonance_nears_its_limit() -> None:
    """PSA = PFA/(2 damping) after many cycles."""
    sine = np.sin(2 * np.pi * np.arange(0, 60, 0.001))
    assert response_spectrum(sine, 0.001, np.array([1.0])).pseudo[0] == pytest.approx(10, rel=1e-3)


@pytest.mark.parametrize("damping", [0.02, 0.05, 0.5])
def test_free_vibration(damping: float) -> None:
    step, period, steps = 0.01, 0.7, 137
    r = oscillator_step(np.array([period]), step, damping)[:4, 0].reshape(2, 2)
    u, v = np.linalg.matrix_power(r, steps) @ [0.3, -1.1]
    omega, time = 2 * np.pi / period, steps * step
    damped = omega * math.sqrt(1 - damping**2)
    sine = (-1.1 + damping * omega * 0.3) / damped
    decay, c, s = math.exp(-damping * omega * time), math.cos(damped * time), math.sin(damped * time)
    assert u == pytest.approx(decay * (0.3 * c + sine * s), rel=1e-10)
    slope = (sine * damped - damping * omega * 0.3) * c - (0.3 * damped + damping * omega * sine) * s
    assert v == pytest.approx(decay * slope, rel=1e-10)


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


def test_finer_steps_along_the_same_lines_change_nothing() -> None:
    """What rounding takes from the coefficients where a step is a small part of a period does not tell."""
    coarse = np.random.default_rng(1).standard_normal(1000)
    motions = [np.interp(np.arange(999 * fine + 1) / fine, np.arange(1000), coarse) for fine in (20, 400)]
    periods = np.array([1.0, 3.0, 10.0])
    fine, finer = (
        response_spectrum(motion, 0.02 / number, periods).pseudo
        for motion, number in zip(motions, (20, 400), strict=True)
    )
    np.testing.assert_allclose(fine, finer, rtol=1e-5)


# --- arrays ---


def test_shapes_follow_those_of_the_motions_and_threads_change_nothing() -> None:
    many, one = (response_spectrum(motions, 0.01, PERIODS) for motions in (NOISE, NOISE[1]))
    assert many.pseudo.shape == many.absolute.shape == (3, PERIODS.size)
    assert one.pseudo.shape == one.absolute.shape == PERIODS.shape
    np.testing.assert_array_equal(many.pseudo[1], one.pseudo)
    np.testing.assert_array_equal(many.absolute[1], one.absolute)
    alone, shared = (response_spectrum(NOISE, 0.01, PERIODS, threads=number) for number in (1, 5))
    np.testing.assert_array_equal(alone.pseudo, shared.pseudo)
    np.testing.assert_array_equal(alone.absolute, shared.absolute)


def test_one_period_is_as_among_many_and_inputs_are_left_alone() -> None:
    """Vector lanes may round otherwise, in the last digits."""
    alone = [response_spectrum(NOISE[0], 0.01, PERIODS[[place]]).pseudo[0] for place in range(PERIODS.size)]
    np.testing.assert_allclose(alone, response_spectrum(NOISE[0], 0.01, PERIODS).pseudo, rtol=1e-12)


def test_inputs_are_left_alone() -> None:
    motions, periods = NOISE.copy(), PERIODS.copy()
    spectrum = response_spectrum(motions, 0.01, periods)
    np.testing.assert_array_equal(motions, NOISE)
    np.testing.assert_array_equal(periods, PERIODS)
    assert not np.shares_memory(spectrum.pseudo, motions)


@settings(max_examples=50, deadline=None)
@given(factor=st.floats(1e-6, 1e6), seed=st.integers(0, 1000), damping=st.floats(0.005, 0.95))
def test_it_scales_and_has_no_sign(factor: float, seed: int, damping: float) -> None:
    motion = np.random.default_rng(seed).standard_normal(60)
    plain, scaled = (
        response_spectrum(motion * by, 0.02, PERIODS[::6], damping=damping) for by in (1.0, -factor)
    )  # fmt: skip
    np.testing.assert_allclose(scaled.pseudo, factor * plain.pseudo, rtol=1e-9)
    np.testing.assert_allclose(scaled.absolute, factor * plain.absolute, rtol=1e-9)


def test_zeros_after_the_motion_only_let_it_ring_on_and_zeros_before_change_nothing() -> None:
    longer = np.pad(NOISE, ((0, 0), (0, 300)))
    assert (response_spectrum(longer, 0.01, PERIODS).pseudo >= response_spectrum(NOISE, 0.01, PERIODS).pseudo).all()
    later = np.pad(NOISE, ((0, 0), (50, 0)))
    later[:, 50] = 0.0
    still = later[:, 50:]
    ours = response_spectrum(later, 0.01, PERIODS), response_spectrum(still, 0.01, PERIODS)
    np.testing.assert_allclose(ours[0].pseudo, ours[1].pseudo, rtol=1e-10)


def test_periods_are_even_in_their_logarithm_and_lists_and_integers_and_strides_are_taken() -> None:
    periods = build_periods(0.1, 10.0, 5)
    np.testing.assert_allclose(periods, [0.1, 10**-0.5, 1.0, 10**0.5, 10.0])
    assert build_periods().size == 120
    values = [0, 3, -1, 2, 0, 1]
    expected = response_spectrum(np.array(values, dtype=float), 0.1, np.array([0.5])).pseudo
    for given_as in (values, np.array(values), np.repeat(values, 2)[::2], np.array(values, dtype=np.float32)):
        np.testing.assert_array_equal(response_spectrum(given_as, 0.1, [0.5]).pseudo, expected)


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
