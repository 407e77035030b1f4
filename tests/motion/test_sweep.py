"""Peak responses in single precision, against the exact spectrum."""

import numpy as np
import pytest

from assess.arrays import FloatArray
from assess.motion.spectrum import response_spectrum
from assess.motion.sweep import FEWEST, Sweep, halve
from tests.motion.motions import GROUND, ROOF, TWELFTH, read_motion

STEP = 0.005
PERIODS = np.geomspace(0.03, 10, 160)


def exact(motion: FloatArray, periods: FloatArray = PERIODS) -> FloatArray:
    return response_spectrum(motion, STEP, periods).pseudo


def single(motion: FloatArray) -> np.ndarray:
    return np.atleast_2d(motion).astype(np.float32)


@pytest.mark.parametrize("name", ["a", TWELFTH, ROOF, GROUND])
def test_spectra_are_those_of_the_exact_solution(name: str) -> None:
    motion = read_motion(name).acceleration
    found = Sweep.of(PERIODS, STEP, motion.size).spectra(single(motion))[0]
    ratios = found / exact(motion)
    assert np.abs(ratios - 1).mean() < 0.005
    assert np.abs(ratios - 1).max() < 0.06
    assert np.abs(ratios - 1)[PERIODS < 3].max() < 0.03
    np.testing.assert_allclose(ratios[PERIODS < FEWEST * 2 * STEP], 1.0, rtol=1e-3)  # motions are not halved there


@pytest.mark.parametrize("place", [0, 40, 80, 120, 150])
def test_peaks_come_when_they_do_with_their_sign(place: int) -> None:
    """Without what follows the peak the spectrum is the same, without the peak it is less; a motion turned over turns
    it."""
    motion, period = read_motion(TWELFTH).acceleration, PERIODS[[place]]
    peaks, when = Sweep.of(period, STEP, motion.size).peaks(single(np.stack([motion, -motion])))
    assert peaks[0, 0] == -peaks[1, 0]
    about = max(1, round(period[0] / STEP / FEWEST))
    whole = exact(motion, period)[0]
    assert exact(motion[: when[0, 0] + 2 * about], period)[0] == pytest.approx(whole, rel=0.02)
    assert exact(motion[: when[0, 0] - 2 * about], period)[0] < whole


def test_each_motion_and_each_period_is_found_on_its_own() -> None:
    motions = single(np.stack([read_motion("a").acceleration[:3000], read_motion("b").acceleration[:3000]]))
    both, alone = Sweep.of(PERIODS, STEP, 3000), Sweep.of(PERIODS[[33]], STEP, 3000)
    peaks, when = both.peaks(motions)
    np.testing.assert_array_equal(both.peaks(motions[1:])[0], peaks[1:])
    np.testing.assert_array_equal(both.peaks(motions[1:])[1], when[1:])
    np.testing.assert_allclose(alone.peaks(motions)[0], peaks[:, [33]], rtol=1e-6)


def test_the_last_peak_may_come_after_shaking() -> None:
    """A pulse, and free vibration after it."""
    motion = np.zeros(4001)
    motion[100:200] = 1.0
    periods = np.array([0.3, 3.0])
    np.testing.assert_allclose(
        Sweep.of(periods, STEP, motion.size).spectra(single(motion))[0], exact(motion, periods), rtol=0.01
    )


def test_silence_has_no_peaks_and_short_motions_are_not_halved() -> None:
    """Of short ones the ends count: two seconds keep all their samples."""
    peaks, _ = Sweep.of(PERIODS, STEP, 500).peaks(np.zeros((2, 500), np.float32))
    np.testing.assert_array_equal(peaks, 0.0)
    motion = read_motion("a").acceleration[2000:2401]
    np.testing.assert_allclose(Sweep.of(PERIODS, STEP, 401).spectra(single(motion))[0], exact(motion), rtol=6e-3)
    assert Sweep.of(PERIODS, STEP, 401).depths.max() == 0
    assert Sweep.of(PERIODS, STEP, 12_000).depths.max() == 3


@pytest.mark.parametrize("count", [2, 3, 4, 5, 41, 402])
def test_short_motions_are_no_trouble(count: int) -> None:
    peaks, when = Sweep.of(PERIODS, STEP, count).peaks(np.ones((2, count), np.float32))
    assert np.isfinite(peaks).all()
    assert ((when >= 0) & (when < max(count, 2))).all()


def test_halving_keeps_long_waves_and_takes_off_the_shortest() -> None:
    times = np.arange(4001)
    wave, fastest = np.sin(2 * np.pi * times / 80), (-1.0) ** times
    half = halve(single(np.stack([wave, fastest])))
    assert half.shape == (2, 2001)
    gain = 1 + (2 * np.pi / 80) ** 2 / 4  # straight lines between half as many samples take as much off again
    np.testing.assert_allclose(half[0, 1:-1], gain * wave[::2][1:-1], atol=1e-4)
    np.testing.assert_allclose(half[1, 1:-1], 0.0, atol=1e-6)
