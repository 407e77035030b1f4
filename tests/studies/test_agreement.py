"""How far formulas agree, on numbers worked out by hand."""

import math

import numpy as np
import pytest

from assess.studies.agreement import correlate_ranks, find_agreement


def test_by_hand():
    """Classes 0 1 2 3 against 1 1 0 3: one too low, one too high by two, two the same."""
    formula = np.array([0.00, 0.10, 0.50, 0.90, math.nan])
    fallen = np.array([5, 20, 1, 80, 50])
    one = find_agreement(formula, fallen, 100)
    assert one.cases == 4
    assert one.bias == pytest.approx((-0.05 - 0.10 + 0.49 + 0.10) / 4)
    assert (one.same_class, one.within_one_class) == (0.5, 0.75)
    assert (one.class_too_low, one.class_too_high) == (0.25, 0.25)
    assert one.rms == pytest.approx(((0.05**2 + 0.10**2 + 0.49**2 + 0.10**2) / 4) ** 0.5)
    assert one.rank_correlation == pytest.approx(1 - 6 * (1 + 1 + 4 + 0) / (4 * 15))


def test_what_lies_within_the_sampling_error_is_not_beyond_it():
    """Of 5 of 100 the 95 % interval by Wilson is 0.022 to 0.112, of 1 of 100 0.002 to 0.054: low is left open."""
    one = find_agreement(np.array([0.00, 0.50]), np.array([5, 1]), 100)
    assert (one.class_too_low, one.beyond_too_low) == (0.5, 0)
    assert (one.class_too_high, one.beyond_too_high) == (0.5, 0.5)
    many = find_agreement(np.array([0.00, 0.50]), np.array([500, 100]), 10_000)
    assert (many.class_too_low, many.beyond_too_low) == (0.5, 0.5)


def test_ranks_of_what_is_all_the_same_are_not_correlated():
    assert math.isnan(correlate_ranks(np.zeros(3), np.arange(3)))
    assert correlate_ranks(np.exp(np.arange(5)), np.arange(5)) == pytest.approx(1)
