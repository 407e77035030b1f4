"""Risk classes: which class a limit belongs to, and what is no probability."""

import math

import pytest

from assess.risk import LIMITS, RiskClass, classify


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
