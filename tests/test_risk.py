"""Risk classes: which class a limit belongs to, what is no probability, and the interval of a counted one."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from assess.risk import LIMITS, RiskClass, classify, classify_all, wilson_interval


def test_a_limit_belongs_to_the_higher_class():
    assert LIMITS == (0.03, 0.3, 0.7), "those of the paper"
    for at, limit in enumerate(LIMITS):
        assert [classify(limit - 1e-7), classify(limit)] == [RiskClass(at), RiskClass(at + 1)]
    assert [classify(one) for one in (0.0, 1.0, math.nan)] == [RiskClass.LOW, RiskClass.VERY_HIGH, None]
    for outside in (-0.001, 1.001, 66.0, math.inf, -math.inf):
        with pytest.raises(ValueError, match=rf"probability is {outside}, expected 0 to 1"):
            classify(outside)


# --- intervals ---


def test_wilson_intervals():
    """None of 100 cannot show the class low, none of 200 can."""
    runs = np.array([100, 100, 100, 100, 100, 100, 200])
    low, high = wilson_interval([0, 1, 3, 30, 70, 100, 0], runs)
    assert low == pytest.approx([0.0, 0.0018, 0.0103, 0.2189, 0.6042, 0.9630, 0.0], abs=5e-5)
    assert high == pytest.approx([0.0370, 0.0545, 0.0845, 0.3958, 0.7811, 1.0, 0.0188], abs=5e-5)
    assert wilson_interval(1, 100) == (low[1], high[1])


@given(runs=st.integers(1, 100_000), share=st.floats(0, 1), z=st.floats(0.5, 4))
def test_an_interval_holds_the_share_mirrors_and_widens(runs, share, z):
    count = round(share * runs)
    low, high = (float(end) for end in wilson_interval(count, runs, z))
    assert 0 <= low <= count / runs <= high <= 1
    assert (low == 0) >= (count == 0)
    assert (high == 1) >= (count == runs)
    other_low, other_high = (float(end) for end in wilson_interval(runs - count, runs, z))
    assert (1 - other_high, 1 - other_low) == pytest.approx((low, high), abs=1e-9)
    wider = wilson_interval(count, runs, z + 0.5)
    assert wider[0] <= low + 1e-12
    assert wider[1] >= high - 1e-12


@given(st.lists(st.one_of(st.floats(0, 1), st.just(math.nan), st.sampled_from(LIMITS))))
def test_classes_of_arrays_are_those_of_their_numbers(values):
    classes = [classify(value) for value in values]
    assert classify_all(values).tolist() == [-1 if one is None else int(one) for one in classes]
