"""Which risk is adopted, from arrays by hand: nothing may come out lower than it should without a word."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from assess.methods import Cases, Outcome, adopted_formula, all_methods, simulation
from assess.pipeline.adopt import Adoption, adopt, choose_items, find_governing
from assess.risk import RiskClass, classify, wilson_interval
from assess.units import GRAVITY

LOW, MEDIUM, HIGH, VERY_HIGH = RiskClass
FORMULA, SIMULATION = adopted_formula().key, simulation().key


@dataclass(frozen=True)
class Case:
    """One case: what the formula gives, how many of its motions overturned it, and what is in doubt."""

    formula: float
    overturned: int = 0
    runs: int = 0
    is_generic: bool = False
    is_estimated: bool = False
    is_weak: bool = False
    fell: bool = False

    @property
    def share(self) -> float:
        return self.overturned / self.runs if self.runs else math.nan

    @property
    def is_doubtful(self) -> bool:
        return self.is_generic or self.is_estimated or self.is_weak


def adopted(*given: Case) -> Adoption:
    ends = [wilson_interval(one.overturned, one.runs) if one.runs else (math.nan, math.nan) for one in given]
    low, high = (np.array([float(pair[at]) for pair in ends]) for at in (0, 1))
    flags = {
        "generic_spectrum": np.array([one.is_generic for one in given], dtype=np.bool_),
        "weak_motions": np.array([one.is_weak for one in given], dtype=np.bool_),
        "fell_in_record": np.array([one.fell for one in given], dtype=np.bool_),
    }
    outcomes = {
        FORMULA: Outcome(np.array([one.formula for one in given])),
        SIMULATION: Outcome(np.array([one.share for one in given]), {"low": low, "high": high}, flags),
    }
    cases = Cases.of(breadth=np.full(len(given), 0.4), height=1.8, pfv_estimated=[one.is_estimated for one in given])
    return adopt(outcomes, cases)


def one(case: Case) -> tuple[float, RiskClass, RiskClass, bool, bool]:
    """Return probability, class, upper class, whether it is the verification's, and whether that was not lowered."""
    found = adopted(case)
    return (
        float(found.probability[0]), RiskClass(found.risk[0]), RiskClass(found.upper[0]),
        bool(found.verified[0]), bool(found.not_lowered[0]),
    )  # fmt: skip


def test_what_was_not_verified_keeps_the_formula():
    assert one(Case(0.5)) == (0.5, HIGH, HIGH, False, False)
    found = adopted(Case(0.5))
    assert np.isnan([found.low[0], found.high[0]]).all()


@pytest.mark.parametrize(("overturned", "risk"), [(0, LOW), (20, MEDIUM), (100, HIGH), (160, VERY_HIGH)])
def test_verification_lowers_and_raises(overturned, risk):
    case = Case(0.5, overturned, 200)
    assert one(case)[:2] == (overturned / 200, risk)
    found = adopted(case)
    assert found.verified[0]
    low, high = wilson_interval(overturned, 200)
    assert (found.low[0], found.high[0]) == (low, high)


@pytest.mark.parametrize("doubt", ["is_generic", "is_estimated", "is_weak"])
def test_in_doubt_a_class_is_raised_but_not_lowered(doubt):
    assert one(Case(0.5, 20, 200, **{doubt: True})) == (0.5, HIGH, HIGH, False, True)
    assert one(Case(0.5, 160, 200, **{doubt: True}))[:2] == (0.8, VERY_HIGH)
    assert one(Case(0.5, 70, 200, **{doubt: True}))[:2] == (0.35, HIGH), "a lower number of the same class is taken"
    found = adopted(Case(0.5, 20, 200, **{doubt: True}))
    assert np.isnan([found.low[0], found.high[0]]).all(), "the interval is of a risk that was not adopted"


def test_a_piece_that_falls_in_the_record_is_at_least_high():
    assert one(Case(0.1, 2, 200, fell=True))[:3] == (0.01, HIGH, HIGH)
    assert one(Case(0.1, 150, 200, fell=True))[:2] == (0.75, VERY_HIGH)
    assert one(Case(0.01, 0, 200, fell=True, is_estimated=True))[1] is HIGH


def test_the_upper_class_is_that_of_the_intervals_end():
    assert one(Case(0.5, 0, 100))[1:3] == (LOW, MEDIUM)
    assert one(Case(0.5, 0, 200))[1:3] == (LOW, LOW)
    assert one(Case(0.5, 55, 200))[1:3] == (MEDIUM, HIGH)


def test_where_the_formula_stands_the_interval_may_still_raise_the_upper_class():
    """The formula's medium stands; 5 of 20 may be as many as half."""
    assert one(Case(0.299, 0, 20, is_generic=True))[1:] == (MEDIUM, MEDIUM, False, True)
    assert one(Case(0.31, 5, 20, is_generic=True))[1:] == (HIGH, HIGH, False, True)
    assert one(Case(0.1, 5, 20, is_generic=True))[1:3] == (MEDIUM, HIGH)


probabilities = st.one_of(st.floats(0, 1), st.sampled_from([0.03, 0.3, 0.7]))


@st.composite
def any_case(draw):
    runs = draw(st.one_of(st.just(0), st.integers(1, 300)))
    overturned = draw(st.integers(0, runs))
    doubts = {name: draw(st.booleans()) for name in ("is_generic", "is_estimated", "is_weak")}
    return Case(draw(probabilities), overturned, runs, fell=bool(runs) and draw(st.booleans()), **doubts)


@given(st.lists(any_case(), min_size=1, max_size=20))
def test_nothing_comes_out_lower_than_it_should(given):
    found = adopted(*given)
    for at, case in enumerate(given):
        by_formula, risk, upper = classify(case.formula), found.risk[at], found.upper[at]
        assert upper >= risk >= classify(float(found.probability[at]))
        assert found.probability[at] == (case.share if found.verified[at] else case.formula)
        if not case.runs:
            assert (risk, found.verified[at], found.not_lowered[at]) == (by_formula, False, False)
            continue
        assert found.verified[at] != found.not_lowered[at]
        assert upper >= classify(float(wilson_interval(case.overturned, case.runs)[1]))
        if case.is_doubtful:
            assert risk >= by_formula
            assert risk >= classify(case.share), "in doubt the higher class of both"
        else:
            assert found.verified[at]
        if case.fell:
            assert risk >= HIGH


@given(st.lists(any_case(), min_size=1, max_size=8))
def test_cases_do_not_touch_each_other(given):
    together = adopted(*given)
    for at, case in enumerate(given):
        alone = adopted(case)
        for name in ("probability", "low", "high", "risk", "upper", "verified", "not_lowered"):
            np.testing.assert_array_equal(getattr(alone, name)[0], getattr(together, name)[at])


# --- which case governs ---


def governing(*probabilities, items=None, pfa=None):
    """Return which case governs, item by item."""
    item = np.zeros(len(probabilities), dtype=np.intp) if items is None else np.array(items)
    peaks = np.ones(len(probabilities)) if pfa is None else np.array(pfa)
    return find_governing(np.array(probabilities, dtype=np.float64), item, peaks * GRAVITY).tolist()


def test_the_larger_probability_governs():
    assert governing(0.2, 0.25, pfa=[2, 1]) == [1]


def test_then_the_larger_pfa_then_the_first():
    assert governing(0.2, 0.2, pfa=[1, 2]) == [1]
    assert governing(0.2, 0.2, pfa=[1, 1]) == [0]


def test_rounding_does_not_decide():
    assert governing(0.5, 0.5 + 1e-13, pfa=[1, 1]) == [0]
    assert governing(0.5, 0.5, pfa=[1, 1 + 1e-13]) == [0]


def test_each_item_has_its_own():
    assert governing(0.0, 0.4, 0.01, 0.9, 0.0, items=[0, 0, 1, 2, 2]) == [1, 2, 3]


# --- which pieces are verified ---


SELECTING = [method for method in all_methods() if method.selects]
(OTHER,) = (method.key for method in SELECTING if method.key != FORMULA)


def chosen(verify, formula, kaneko_hayashi=None, extrapolated=None, items=None, routes=None):
    count = len(formula)
    kaneko_hayashi = [0.0] * count if kaneko_hayashi is None else kaneko_hayashi
    flags = {"extrapolated": np.array(extrapolated or [False] * count)}
    outcomes = {
        FORMULA: Outcome(np.array(formula), flags=flags),
        OTHER: Outcome(np.array(kaneko_hayashi)),
    }
    item = np.arange(count) if items is None else np.array(items)
    return choose_items(verify, SELECTING, outcomes, item, np.array(routes or [False] * (item[-1] + 1))).tolist()


def test_none_and_all():
    assert chosen("none", [0.9, 0.1], routes=[True, False]) == [False, False]
    assert chosen("all", [0.9, 0.1]) == [True, True]


def test_high_and_very_high_by_either_formula():
    assert chosen("high", [0.0, 0.2999, 0.3, 0.7]) == [False, False, True, True]
    assert chosen("high", [0.0] * 4, [0.0, 0.2999, 0.3, 0.7]) == [False, False, True, True]
    assert chosen("high", [0.5, 0.0], [np.nan, np.nan]) == [True, False], "unknown is no class"


def test_outside_the_checked_range_and_on_routes():
    assert chosen("high", [0.0, 0.0], extrapolated=[False, True]) == [False, True]
    assert chosen("high", [0.0, 0.0], routes=[True, False]) == [True, False]


def test_under_any_motion_of_the_piece():
    assert chosen("high", [0.0, 0.5, 0.0, 0.0], items=[0, 0, 1, 1]) == [True, False]
    assert chosen("high", [0.0] * 4, [0.0, 0.0, 0.0, 0.5], items=[0, 0, 1, 1]) == [False, True]
    assert chosen("high", [0.0] * 4, extrapolated=[True, False, False, False], items=[0, 0, 1, 1]) == [True, False]


def test_no_items():
    assert (
        choose_items("high", SELECTING, _nothing(), np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.bool_)).tolist()
        == []
    )
    assert governing_of_nothing() == []


def _nothing():
    empty = np.zeros(0)
    return {
        FORMULA: Outcome(empty, flags={"extrapolated": empty.astype(np.bool_)}),
        OTHER: Outcome(empty),
    }


def governing_of_nothing():
    return find_governing(np.zeros(0), np.zeros(0, dtype=np.intp), np.zeros(0)).tolist()
