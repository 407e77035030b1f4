"""Envelopes of recorded floors, and the octaves that they are of."""

import numpy as np
import pytest

from assess.arrays import FloatArray
from assess.motion.target import husid_envelopes, octaves, split
from tests.motion.motions import read_motion

STEP = 0.005

# --- octaves ---


def test_octaves_and_their_weights_by_hand() -> None:
    np.testing.assert_allclose(octaves(), [0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 6.4, 12.8, 25.6])
    frequencies = np.concatenate([[0.0], np.geomspace(1e-6, 1000, 5001)])
    weights = split(frequencies, octaves())
    np.testing.assert_allclose(weights.sum(axis=0), 1.0, rtol=1e-12, err_msg="they sum to one")
    assert weights.min() >= 0
    # one at its centre and half way between; the first and last reach to the ends; a single octave takes all
    np.testing.assert_allclose(split(octaves(), octaves()), np.eye(9), atol=1e-12)
    np.testing.assert_allclose(split(np.array([0.8 * 2**0.5]), octaves())[3:5, 0], [0.5, 0.5])
    weights = split(np.array([0.0, 0.05, 40.0, 100.0]), octaves())
    np.testing.assert_array_equal(weights[0], [1, 1, 0, 0])
    np.testing.assert_array_equal(weights[-1], [0, 0, 1, 1])
    np.testing.assert_array_equal(split(np.array([0.0, 1.0, 100.0]), np.array([0.1])), np.ones((1, 3)))


# --- recorded floors ---


def bursts(*parts: tuple[float, float, float]) -> FloatArray:
    """Return 30 s with sines of (frequency, from, to)."""
    times = np.arange(6000) * STEP
    values = np.zeros(6000)
    for frequency, start, end in parts:
        inside = (times >= start) & (times < end)
        values[inside] += np.sin(2 * np.pi * frequency * (times[inside] - start))
    return values


def shares(envelope: FloatArray, *times: float) -> FloatArray:
    """Return the envelope at these times over its maximum."""
    return np.asarray([envelope[round(seconds / STEP)] for seconds in times] / envelope.max())


def test_a_burst_is_followed() -> None:
    envelopes = husid_envelopes(bursts((1.6, 10, 15)), STEP)
    envelope = envelopes.values[4]
    np.testing.assert_array_less(shares(envelope, 5, 20, 28), 0.01)
    np.testing.assert_array_less(0.8, shares(envelope, 12, 13))
    np.testing.assert_allclose(shares(envelope, 10, 15), 0.5**0.5, atol=0.12)
    assert envelopes.half_time == pytest.approx(12.5, abs=0.02)


def test_each_octave_has_its_own() -> None:
    envelopes = husid_envelopes(bursts((0.4, 15, 25), (6.4, 3, 6)), STEP)
    low, high = envelopes.values[2], envelopes.values[6]
    np.testing.assert_array_less(shares(high, 10, 20), 0.02)
    np.testing.assert_array_less(shares(low, 1, 3, 6), 0.25)  # it is smoothed over 5 s
    np.testing.assert_array_less(0.9, [*shares(high, 4.5), *shares(low, 20)])


def test_they_are_of_mean_square_one_whatever_the_level() -> None:
    motion = read_motion("a")
    envelopes = husid_envelopes(motion.acceleration, motion.time_step)
    np.testing.assert_allclose((envelopes.values**2).mean(axis=1), 1.0)
    fainter = husid_envelopes(motion.acceleration * 1e-4, motion.time_step)
    np.testing.assert_allclose(envelopes.values, fainter.values, rtol=1e-6)
    assert envelopes.half_time == fainter.half_time


def test_a_silent_octave_is_no_division_by_zero() -> None:
    assert np.isfinite(husid_envelopes(np.eye(1, 500, 250)[0], STEP).values).all()
