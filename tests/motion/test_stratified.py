"""Stratified random numbers: each part of a distribution has its share, and a draw depends on its number alone."""

import numpy as np
import pytest
from scipy.stats import kstest, truncnorm

from assess.motion.stratified import draw_normal, draw_uniform, to_normal


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_each_25_draws_have_one_in_each_25th_and_200_one_in_each_200th(seed):
    """So the share beyond 0.95 is 5 % whatever the seed: 10 of 200."""
    shares = draw_uniform([seed, 1], 0, 1000)
    for each in (25, 200):
        for some in shares.reshape(-1, each):
            np.testing.assert_array_equal(np.sort(np.floor(some * each)), np.arange(each))
    assert {int((some > 0.95).sum()) for some in shares.reshape(-1, 200)} == {10}
    orders = {tuple(np.argsort(some).tolist()) for some in shares.reshape(-1, 25)}
    assert len(orders) == 40, "each block is in an order of its own"


def test_a_draw_depends_on_stream_and_number_alone():
    every = draw_uniform([1, 2, 3], 0, 650)
    for first, count in ((0, 1), (24, 2), (190, 30), (399, 251)):
        np.testing.assert_array_equal(draw_uniform([1, 2, 3], first, count), every[first : first + count])
    assert abs(np.corrcoef(every, draw_uniform([1, 2, 4], 0, 650))[0, 1]) < 0.15


def test_normal_numbers_are_cut_where_asked():
    found = draw_normal([1, 9], 0, 20_000, 2.5)
    assert 2.4 < np.abs(found).max() <= 2.5
    assert kstest(found, truncnorm(-2.5, 2.5).cdf).pvalue > 0.01
    shares = np.array([0.0, 0.5, 1.0])
    np.testing.assert_allclose(to_normal(shares, -2.5, 2.5), [-2.5, 0.0, 2.5], atol=1e-12)
    np.testing.assert_allclose(to_normal(shares, np.array([-3.0, 0.0, 1.0]), 1.0)[[0, 2]], [-3.0, 1.0])
