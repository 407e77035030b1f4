"""Two bands: how motions are split, and brought to peaks one by one or all alike."""

import numpy as np
import pytest

from assess.arrays import FloatArray, Single
from assess.motion.bands import NEAR, find_common, meet_peaks, split_bands
from assess.motion.target_fit import measure_peaks

STEP, COUNT = 0.005, 4000
CORNERS = np.full(40, 1.5)


def make_motions() -> Single:
    """Return noise between 0.2 and 20 Hz that starts and ends at rest."""
    values = np.random.default_rng(3).standard_normal((40, COUNT))
    frequencies = np.fft.rfftfreq(COUNT, STEP)
    inside = (frequencies > 0.2) & (frequencies < 20)
    made = np.fft.irfft(np.fft.rfft(values) * inside / np.sqrt(np.maximum(frequencies, 0.2)), COUNT)
    return np.asarray(made * np.hanning(COUNT), np.float32)


def split(motions: Single) -> Single:
    return split_bands(motions, STEP, CORNERS)


def off(motions: Single, pfa: FloatArray | float, pfv: FloatArray | float) -> FloatArray:
    """Return how far peaks are from those wanted [-], (k, 2)."""
    return np.asarray(measure_peaks(motions, STEP) / np.stack(np.broadcast_arrays(pfa, pfv), axis=-1) - 1)


@pytest.mark.parametrize(("frequency", "share"), [(0.3, 1.0), (1.5, 0.5), (8.0, 0.0)])
def test_the_lower_band_has_half_of_the_amplitude_at_the_corner_and_no_shift(frequency: float, share: float) -> None:
    wave = np.sin(2 * np.pi * frequency * np.arange(COUNT) * STEP)
    low = split_bands(wave[None].astype(np.float32), STEP, np.array([1.5]))[0]
    np.testing.assert_allclose(low[1000:3000], share * wave[1000:3000], atol=0.01)


def test_pfa_is_met_exactly_and_pfv_nearly() -> None:
    motions, wanted = make_motions(), np.linspace(1.0, 9.0, 40)
    speeds = wanted / (2 * np.pi * 1.5) * np.linspace(0.8, 1.3, 40)
    meet_peaks(motions, split(motions), STEP, wanted, speeds)
    by_pfa, by_pfv = np.abs(off(motions, wanted, speeds)).T
    assert by_pfa.max() < 1e-6
    assert np.quantile(by_pfv, 0.9) < 1.01 * NEAR
    assert by_pfv.max() < 0.05
    meet_peaks(motions, split(motions), STEP, np.full(40, 3.0), np.full(40, 1e-6))
    assert np.abs(off(motions, 3.0, 1.0)[:, 0]).max() < 1e-6, "also where PFV cannot be met"


@pytest.mark.parametrize("free", [np.nan, 0.0])
def test_without_a_pfv_a_motion_is_but_scaled(free: float) -> None:
    before = make_motions()
    motions = before.copy()
    meet_peaks(motions, split(motions), STEP, np.full(40, 3.0), np.full(40, free))
    np.testing.assert_allclose(motions, 3.0 * before / np.abs(before).max(axis=1, keepdims=True), rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize("pfv", [0.2, 0.32, 0.5])
def test_two_factors_bring_the_medians_to_peaks(pfv: float) -> None:
    motions = make_motions()
    low = split(motions)
    high, slow = find_common(motions, low, STEP, 3.0, pfv, each=False)
    made = np.float32(high) * motions + np.float32(slow - high) * low
    np.testing.assert_allclose(np.median(measure_peaks(made, STEP), axis=0), [3.0, pfv], rtol=2 * NEAR)


def test_so_they_do_where_each_has_the_pfa() -> None:
    motions = make_motions()
    low = split(motions)
    high, slow = find_common(motions, low, STEP, 3.0, 0.4, each=True)
    assert high == 1.0
    made = motions + np.float32(slow - 1) * low
    made *= np.float32(3.0) / np.abs(made).max(axis=1, keepdims=True)
    assert np.median(measure_peaks(made, STEP)[:, 1]) == pytest.approx(0.4, rel=2 * NEAR)
