"""Risk classes: which class a limit belongs to, what is no probability, and the interval of a counted one."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from assess.risk import LIMITS, RiskClass, classify, classify_all, wilson_interval


@pytest.mark.parametrize(
    ("probability", "risk_class"),
    [
        (0.0, RiskClass.LOW),
        (0.0299999, RiskClass.LOW),
        (0.03, RiskClass.MEDIUM),
        (0.2999999, RiskClass.MEDIUM),
        (0.3, RiskClass.HIGH),
        (0.6999999, RiskClass.HIGH),
        (0.7, RiskClass.VERY_HIGH),
        (1.0, RiskClass.VERY_HIGH),
    ],
)
def test_a_limit_belongs_to_the_higher_class(probability, risk_class):
    assert classify(probability) is risk_class


def test_limits_are_those_of_the_paper():
    assert LIMITS == (0.03, 0.3, 0.7)


def test_unknown_has_no_class():
    assert classify(math.nan) is None


@pytest.mark.parametrize("probability", [-0.001, 1.001, 66.0, math.inf, -math.inf])
def test_outside_nought_to_one_is_refused(probability):
    with pytest.raises(ValueError, match=rf"probability is {probability}, expected 0 to 1"):
        classify(probability)


def test_words_and_symbols_are_distinct():
    assert [member.word for member in RiskClass] == ["low", "medium", "high", "very high"]
    assert len({member.symbol for member in RiskClass}) == len(RiskClass)
    assert RiskClass.VERY_HIGH.label == f"{RiskClass.VERY_HIGH.symbol} very high"


def test_classes_rise():
    assert sorted(RiskClass) == list(RiskClass)
    assert max(RiskClass.HIGH, RiskClass.MEDIUM) is RiskClass.HIGH


# --- intervals ---


@pytest.mark.parametrize(
    ("count", "runs", "low", "high"),
    [
        (0, 100, 0.0, 0.0370),
        (1, 100, 0.0018, 0.0545),
        (3, 100, 0.0103, 0.0845),
        (30, 100, 0.2189, 0.3958),
        (70, 100, 0.6042, 0.7811),
        (100, 100, 0.9630, 1.0),
        (0, 200, 0.0, 0.0188),
    ],
)
def test_wilson_intervals(count, runs, low, high):
    assert wilson_interval(count, runs) == pytest.approx((low, high), abs=5e-5)


def test_none_of_100_cannot_show_low_and_none_of_200_can():
    assert [classify(float(wilson_interval(0, runs)[1])) for runs in (100, 200)] == [RiskClass.MEDIUM, RiskClass.LOW]


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


def test_intervals_of_arrays():
    low, high = wilson_interval([0, 1, 100], 100)
    assert low.shape == high.shape == (3,)
    assert [float(one) for one in wilson_interval(1, 100)] == [low[1], high[1]]


@given(st.lists(st.one_of(st.floats(0, 1), st.just(math.nan), st.sampled_from(LIMITS))))
def test_classes_of_arrays_are_those_of_their_numbers(values):
    classes = [classify(value) for value in values]
    assert classify_all(values).tolist() == [-1 if one is None else int(one) for one in classes]
