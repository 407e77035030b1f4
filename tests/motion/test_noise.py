"""Noise that depends on nothing but seed, axis and number, and the octaves that it is made of."""

import numpy as np
import pytest

from assess.arrays import FloatArray
from assess.motion import noise
from assess.motion.kept import Kept
from assess.motion.noise import Phases, draw_bands, draw_noise, find_rates
from assess.motion.rows import GROUP
from assess.motion.target import STRETCH, Envelopes, Grid, octaves
from assess.progress import SILENT

STEP = 0.005
GRID = Grid(STEP, 2000)
FLAT = Envelopes(octaves(), np.ones((9, 2000)), 5.0)


def draw(envelopes: Envelopes, *, seed: int = 1, axis: str = "X", groups: int = 1) -> FloatArray:
    grid = Grid(STEP, envelopes.values.shape[1])
    made = [draw_noise(envelopes, Phases(grid, seed, axis), group, SILENT) for group in range(groups)]
    assert made[0].shape == (GROUP, find_rates(grid).frequencies.size)
    return np.concatenate([np.fft.irfft(one, find_rates(grid).length, axis=1) for one in made])


# --- rates ---


@pytest.mark.parametrize("time_step", [0.0025, 0.005, 0.01, 0.02])
def test_an_octaves_own_rate_holds_its_frequencies(time_step: float) -> None:
    """What is left of its weight beyond the Nyquist frequency of its rate is nothing."""
    rates = find_rates(Grid(time_step, 3000))
    for weight, depth in zip(rates.weights, rates.depths, strict=True):
        if depth > 1:
            assert weight[rates.frequencies >= 0.5 / time_step / depth].max() < 1e-6


# --- noise ---


def test_it_is_white_in_the_samples_and_of_one_level() -> None:
    """Octaves at their own rates add up to what one band at the full rate is."""
    made = draw(FLAT, groups=5)[:, 100:1900]
    power = (np.abs(np.fft.rfft(made, axis=1)) ** 2).mean(axis=0)[20:]
    coarse = power[: power.size // 40 * 40].reshape(-1, 40).mean(axis=1)
    np.testing.assert_allclose(coarse / coarse.mean(), 1.0, atol=0.2)


def test_axes_and_seeds_and_numbers_differ_floors_share_their_phases_and_there_is_no_axis_but_x_and_y() -> None:
    rows = np.concatenate([draw(FLAT)[:3], draw(FLAT, axis="Y")[:3], draw(FLAT, seed=2)[:3]])
    assert np.abs(np.corrcoef(rows) - np.eye(9)).max() < 0.1
    with pytest.raises(KeyError):
        draw(FLAT, axis="Z")
    # octaves or one envelope for all: where both are flat the noise is one
    one = Envelopes(np.array([0.1]), np.ones((1, 2000)), 5.0)
    np.testing.assert_array_equal(draw(one), draw(FLAT))


def test_an_envelope_shapes_the_noise() -> None:
    values = np.interp(np.arange(2000) * STEP, [0.0, 5.0, 8.0, 10.0], [0.0, 1.0, 1.0, 0.0])
    made = draw(Envelopes(np.array([0.1]), values[None], 5.0), groups=2)[:, :2000]
    level = np.sqrt((made**2).mean(axis=0))
    near = [level[round(seconds / STEP) - 40 : round(seconds / STEP) + 40].mean() for seconds in (0.3, 4.5, 9.5)]
    assert near[0] < 0.2 * near[1]
    assert near[2] < near[1]


def test_each_octave_is_under_its_own_envelope() -> None:
    """The highest octave in the first half, all others in the second: the first is of its frequencies."""
    values = np.zeros((9, 2000))
    values[8, :1000], values[:8, 1000:] = 1.0, 1.0
    made = draw(Envelopes(octaves(), values, 5.0), groups=2)[:, :2000]
    first, second = (
        np.abs(np.fft.rfft(part * np.hanning(700), axis=1)) ** 2 for part in (made[:, :700], made[:, 1300:])
    )
    frequencies = np.fft.rfftfreq(700, STEP)
    low, high = (frequencies > 0.5) & (frequencies < 10), frequencies > 30
    assert first[:, high].mean() > 100 * first[:, low].mean()
    assert second[:, low].mean() > 100 * second[:, high].mean()


def test_durations_scatter() -> None:
    """The edge of a burst moves with the duration drawn for each realisation, by STRETCH in logarithms."""
    values = np.zeros((9, 4000))
    values[8, 1000:3000] = 1.0  # the highest octave has sharp edges
    made = draw(Envelopes(octaves(), values, 10.0), groups=10)[:, :4000]
    lengths = np.log(measure_lengths(made) / 2000)
    assert lengths.std() == pytest.approx(STRETCH, rel=0.2)
    assert lengths.mean() == pytest.approx(0.0, abs=0.06)


def measure_lengths(made: FloatArray) -> FloatArray:
    """Return the samples from the first to the last that is not silent, (k,)."""
    inside = np.abs(made) > 1e-3 * np.abs(made).max()
    return np.asarray(made.shape[1] - inside[:, ::-1].argmax(axis=1) - inside.argmax(axis=1), np.float64)


def test_given_stretches_take_the_place_of_drawn_ones() -> None:
    values = np.zeros((9, 4000))
    values[8, 1000:3000] = 1.0
    stretches, grid = np.linspace(0.5, 1.5, GROUP), Grid(STEP, 4000)
    made = draw_noise(Envelopes(octaves(), values, 10.0), Phases(grid, 1, "X"), 0, SILENT, stretches=stretches)
    lengths = measure_lengths(np.fft.irfft(made, find_rates(grid).length, axis=1)[:, :4000])
    np.testing.assert_allclose(lengths, 2000 * stretches, rtol=0.05)


# --- what is kept ---


def test_noise_is_drawn_once_for_all_floors_and_what_is_kept_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(noise, "KEPT", Kept(noise.KEPT.most))
    first = draw_bands(Phases(GRID, 1, "X"), 0, SILENT)
    assert draw_bands(Phases(GRID, 1, "X"), 0, SILENT) is first
    other = draw_bands(Phases(GRID, 1, "X"), 1, SILENT)
    assert other is not first
    assert draw_bands(Phases(GRID, 1, "Y"), 0, SILENT) is not first
    assert draw_bands(Phases(Grid(STEP, 2001), 1, "X"), 0, SILENT) is not first
    monkeypatch.setattr(noise, "KEPT", Kept(2 * first.nbytes))
    for group in (1, 2, 3):
        draw_bands(Phases(GRID, 1, "X"), group, SILENT)
        assert noise.KEPT.nbytes <= 2 * first.nbytes
    again = draw_bands(Phases(GRID, 1, "X"), 0, SILENT)
    assert again is not first
    for now, before in zip(again.octaves, first.octaves, strict=True):
        np.testing.assert_array_equal(now, before)
