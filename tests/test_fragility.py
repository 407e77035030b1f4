"""The fit of a fragility: known ones are found again, the optimum is scipy's, and data without a fit say so."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.optimize import minimize
from scipy.stats import binom, norm

from assess.fragility import MOST_MISFIT, WHY, fit_fragility, lognormal_chance
from tests.refusals import check_refusals

LEVELS = np.geomspace(0.05, 1.6, 12)


def expected(median, dispersion, levels=LEVELS, trials=1000):
    """Counts that are what a lognormal expects, to the last fraction."""
    return norm.cdf(np.log(levels / median) / dispersion) * trials


@pytest.mark.parametrize("median", [0.08, 0.4, 1.5])
@pytest.mark.parametrize("dispersion", [0.15, 0.5, 1.2])
def test_a_known_fragility_is_found_again(median, dispersion):
    fit = fit_fragility(LEVELS, expected(median, dispersion), np.full(12, 1000))
    assert fit.kind == "fitted"
    assert fit.median == pytest.approx(median, rel=1e-7)
    assert fit.dispersion == pytest.approx(dispersion, rel=1e-6)
    assert fit.misfit == pytest.approx(0, abs=1e-7)
    assert fit.is_lognormal


def test_drawn_counts_scatter_about_the_known_fragility():
    rng, found = np.random.default_rng(5), []
    for _ in range(200):
        fit = fit_fragility(LEVELS, rng.binomial(200, expected(0.4, 0.5, trials=1)), np.full(12, 200))
        found.append((math.log(fit.median), fit.dispersion))
    mean, scatter = np.mean(found, axis=0), np.std(found, axis=0)
    assert abs(mean[0] - math.log(0.4)) < 4 * scatter[0] / math.sqrt(200)
    assert abs(mean[1] - 0.5) < 4 * scatter[1] / math.sqrt(200) + 0.005  # likelihood is biased a little
    assert scatter[0] < 0.04


@given(st.lists(st.tuples(st.floats(0.05, 3), st.integers(1, 60), st.floats(0, 1)), min_size=2, max_size=10))
def test_no_other_parameters_are_likelier(rows):
    im = np.array([row[0] for row in rows])
    trials = np.array([row[1] for row in rows], dtype=float)
    fallen = np.round(trials * np.array([row[2] for row in rows]))
    fit = fit_fragility(im, fallen, trials)
    if fit.kind != "fitted":
        assert math.isnan(fit.median)
        return

    def likelihood(theta, beta):
        return binom.logpmf(fit.fallen, fit.trials, norm.cdf(np.log(fit.levels / theta) / beta)).sum()

    best = likelihood(fit.median, fit.dispersion)
    for less in (0.99, 1.01):
        assert likelihood(fit.median * less, fit.dispersion) <= best + 1e-9
        assert likelihood(fit.median, fit.dispersion * less) <= best + 1e-9


def test_it_is_the_optimum_that_another_search_finds():
    fallen, trials = np.array([0, 3, 9, 30, 71, 88, 100]), np.array([100, 100, 100, 120, 130, 100, 100])
    im = np.array([0.1, 0.15, 0.2, 0.3, 0.45, 0.7, 1.0])
    fit = fit_fragility(im, fallen, trials)

    def unlikely(at):
        return -binom.logpmf(fallen, trials, norm.cdf((np.log(im) - at[0]) / math.exp(at[1]))).sum()

    found = minimize(unlikely, [0.0, 0.0], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12})
    assert fit.median == pytest.approx(math.exp(found.x[0]), rel=1e-5)
    assert fit.dispersion == pytest.approx(math.exp(found.x[1]), rel=1e-5)
    shares = norm.cdf(np.log(im / fit.median) / fit.dispersion)
    assert fit.misfit == pytest.approx(np.abs(shares - fallen / trials).max(), rel=1e-9)
    np.testing.assert_array_equal(fit.shares, fallen / trials)


def test_a_chance_that_levels_off_is_no_lognormal():
    fallen = np.array([0, 5, 40, 60, 60, 60, 60, 60, 61, 60, 60, 60])
    fit = fit_fragility(LEVELS, fallen, np.full(12, 100))
    assert fit.kind == "fitted"
    assert fit.misfit > MOST_MISFIT
    assert not fit.is_lognormal


def test_order_units_and_division_of_the_trials_do_not_matter():
    fallen, trials = np.round(expected(0.4, 0.5, trials=50)), np.full(12, 50)
    usual = fit_fragility(LEVELS, fallen, trials)
    turned = fit_fragility(LEVELS[::-1], fallen[::-1], trials)
    assert (turned.median, turned.dispersion) == pytest.approx((usual.median, usual.dispersion), rel=1e-9)
    np.testing.assert_array_equal(turned.levels, LEVELS)
    other = fit_fragility(LEVELS * 980.665, fallen, trials)
    assert other.median == pytest.approx(usual.median * 980.665, rel=1e-8)
    halves = fit_fragility(np.repeat(LEVELS, 2), np.stack([fallen, 0 * fallen], axis=1).ravel(), np.full(24, 25) +
                           np.tile([25, -25], 12))  # fmt: skip
    assert halves.median == pytest.approx(usual.median, rel=1e-9)
    assert halves.levels.size == 12
    twice = fit_fragility(np.repeat(LEVELS, 2), np.repeat(fallen, 2), np.full(24, 50))
    np.testing.assert_array_equal(twice.trials, np.full(12, 100))
    assert twice.dispersion == pytest.approx(usual.dispersion, rel=1e-8)


@pytest.mark.parametrize(
    ("fallen", "kind"),
    [
        ([0, 0, 0, 0], "none fell"), ([10, 10, 10, 10], "all fell"), ([0, 0, 10, 10], "separated"),
        ([0, 4, 10, 10], "separated"), ([3, 10, 10, 10], "separated"), ([0, 0, 0, 7], "separated"),
        ([10, 10, 0, 0], "not rising"), ([10, 4, 0, 0], "not rising"), ([8, 6, 5, 3], "not rising"),
        ([5, 5, 5, 5], "not rising"), ([0, 4, 9, 10], "fitted"), ([1, 0, 10, 10], "fitted"),
    ],
)  # fmt: skip
def test_data_without_a_fit_say_so(fallen, kind):
    fit = fit_fragility([0.1, 0.2, 0.4, 0.8], fallen, [10, 10, 10, 10])
    assert fit.kind == kind
    assert fit.why == WHY[kind]
    np.testing.assert_array_equal(fit.shares, np.array(fallen) / 10)
    if kind == "fitted":
        assert 0.1 < fit.median < 0.8
        assert 0 < fit.dispersion < 2
    else:
        assert math.isnan(fit.median)
        assert math.isnan(fit.dispersion)
        assert math.isnan(fit.misfit)
        assert not fit.is_lognormal


def test_levels_without_trials_are_left_out():
    fit = fit_fragility([0.1, 0.2, 0.4, 0.8], [1, 0, 5, 9], [10, 0, 10, 10])
    np.testing.assert_array_equal(fit.levels, [0.1, 0.4, 0.8])
    assert fit.kind == "fitted"
    assert fit_fragility([0.1, 0.2], [4, 0], [10, 0]).kind == "one level"


def test_the_chance_of_a_lognormal():
    assert lognormal_chance(0.4, 0.4, 0.5) == 0.5
    assert lognormal_chance(0.4 * math.exp(0.5), 0.4, 0.5) == pytest.approx(norm.cdf(1), rel=1e-12)
    np.testing.assert_array_equal(lognormal_chance([0.0, 0.39, 0.4, 0.5], 0.4, 0.0), [0, 0, 1, 1])
    assert lognormal_chance(0.0, 0.4, 0.5) == 0


def test_counts_that_cannot_be():
    check_refusals(ValueError, lambda counts: fit_fragility(*counts), [
        (([0.1, 0.2], [1], [2, 2]), "have shapes"),
        (([0.1, math.nan], [1, 1], [2, 2]), "must be finite"),
        (([0.0, 0.2], [1, 1], [2, 2]), "levels must be above 0"),
        (([0.1, 0.2], [1, 3], [2, 2]), "fallen 0 to trials"),
        (([0.1, 0.2], [-1, 1], [2, 2]), "fallen 0 to trials"),
        (([0.1, 0.2], [0, 0], [0, 0]), "no trials"),
        (([], [], []), "no trials"),
    ])  # fmt: skip
