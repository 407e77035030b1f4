"""Figures of a fit, by hand on two tiny motions."""

from dataclasses import replace

import numpy as np
import pytest

from assess.motion.spectrum import response_spectrum
from assess.motion.target import Envelopes, Target
from assess.motion.target_fit import measure_match

STEP = 0.005
MOTIONS = np.array([[0.0, 2.0, 0.0, -1.0, 0.0, 0.0], [0.0, -1.0, 4.0, 0.0, -3.0, 0.0]])
PERIODS = np.array([0.04, 0.1, 0.16])
BETWEEN = np.sqrt([0.004, 0.016])
"""The geometric means of those matched."""
TARGET = Target(
    periods=PERIODS,
    pseudo=np.array([8.0, 2.0, 0.5]),
    pfa=2.0,
    pfv=0.01,
    envelopes=Envelopes(np.array([0.1]), np.ones((1, 6)), 0.01),
    acceleration=np.array([0.0, 0.0, 3.0, 0.0, -2.0, 0.0]),
)
WANTED = response_spectrum(TARGET.acceleration, STEP, BETWEEN).pseudo


def test_peaks_and_their_scatter_and_the_spectrum_between_its_periods() -> None:
    fit, _ = measure_match(TARGET, MOTIONS, STEP)
    assert fit.count == 2
    assert fit.pfa_ratio == pytest.approx(1.5)  # (2 + 4)/2 over 2
    assert fit.pfa_scatter == pytest.approx(1 / 3)  # 1 over 3
    assert fit.pfv_ratio == pytest.approx(1.25)  # (0.010 + 0.015)/2 over 0.01
    assert fit.pfv_scatter == pytest.approx(0.2)  # 0.0025 over 0.0125
    assert fit.drift == pytest.approx(0.5)  # 0.005 over 0.010, and 0
    first, second = response_spectrum(MOTIONS, STEP, BETWEEN).pseudo
    deviation = (first + second) / 2 / WANTED - 1
    worst = int(np.abs(deviation).argmax())
    assert fit.matched_to == 3.0
    assert fit.mean_deviation == pytest.approx(np.abs(deviation).mean(), rel=1e-5)
    assert fit.worst_deviation == pytest.approx(deviation[worst], rel=1e-5)
    assert fit.worst_period == pytest.approx(BETWEEN[worst])
    assert fit.spectrum_scatter == pytest.approx((np.abs(first - second) / (first + second)).mean(), rel=1e-5)


def test_motions_that_are_their_own_target_fit() -> None:
    motion = np.random.default_rng(1).standard_normal(800)
    own = response_spectrum(motion, STEP, PERIODS).pseudo
    target = replace(TARGET, pseudo=own, pfa=float(np.abs(motion).max()), acceleration=motion)
    fit, _ = measure_match(target, np.array([motion, motion]), STEP)
    assert (fit.mean_deviation, fit.worst_deviation) == pytest.approx((0.0, 0.0), abs=0.03)
    assert fit.spectrum_scatter == 0.0
    assert (fit.pfa_ratio, fit.pfa_scatter) == pytest.approx((1.0, 0.0), abs=1e-6)


def test_the_spectra_are_those_that_were_measured_whatever_the_threads() -> None:
    assert measure_match(TARGET, MOTIONS, STEP)[0] == measure_match(TARGET, MOTIONS, STEP, threads=3)[0]
    spectra = measure_match(TARGET, MOTIONS, STEP)[1]
    np.testing.assert_allclose(spectra.periods, BETWEEN, rtol=1e-12)
    assert spectra.ordinates.dtype == np.float32
    for motion, ordinates in zip(MOTIONS, spectra.ordinates, strict=True):
        np.testing.assert_allclose(ordinates, response_spectrum(motion, STEP, BETWEEN).pseudo, rtol=1e-5)
    assert spectra.target is not None
    np.testing.assert_allclose(spectra.target, WANTED, rtol=1e-12)
    assert [len(spectra.first(count).ordinates) for count in (1, 2, 9)] == [1, 2, 2]
    np.testing.assert_array_equal(spectra.first(1).ordinates, spectra.ordinates[:1])
    assert spectra.first(1).target is spectra.target
