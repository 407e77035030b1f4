"""Which risk is adopted, from arrays by hand: nothing may come out lower than it should without a word."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, strategies as st

from assess.methods import Cases, Outcome, adopted_formula, all_methods, paper_formula, simulation
from assess.pipeline.adopt import Adoption, adopt, choose_items, find_governing
from assess.results import BASES
from assess.risk import RiskClass, classify, wilson_interval
from assess.settings import Settings
from assess.units import GRAVITY

LOW, MEDIUM, HIGH, VERY_HIGH = RiskClass
FORMULA, SIMULATION = adopted_formula().key, simulation().key

LARGEST = math.exp(3 * math.sqrt(0.4**2 + 0.25**2 + 0.05**2 + 0.02**2 + (0.05 / 0.5) ** 2))
"""Of the earthquake, the peak of its motion, and the base, the height and the centre of gravity of the piece."""


@dataclass(frozen=True)
class Case:
    """One case: what the formula gives, how many of its motions overturned it, and what is in doubt."""

    formula: float
    overturned: int = 0
    runs: int = 0
    is_unknown: bool = False
    is_weak: bool = False
    fell: bool = False
    ideal: int | None = None
    pfa: float = 0.5
    faster: float = 0.0

    @property
    def share(self) -> float:
        return self.overturned / self.runs if self.runs else math.nan

    @property
    def ideal_share(self) -> float:
        return self.share if self.ideal is None else self.ideal / self.runs

    @property
    def can_rock(self) -> bool:
        """PFA times the largest factor that is drawn, against 0.65 B/H of a piece of 0.4 x 1.8 m."""
        return self.pfa * LARGEST >= 0.65 * 0.4 / 1.8


def adopted(*given: Case, settings: Settings = Settings()) -> Adoption:  # noqa: B008
    ends = [wilson_interval(one.overturned, one.runs) if one.runs else (math.nan, math.nan) for one in given]
    low, high = (np.array([float(pair[at]) for pair in ends]) for at in (0, 1))
    flags = {
        "unknown_building": np.array([one.is_unknown for one in given], dtype=np.bool_),
        "weak_motions": np.array([one.is_weak for one in given], dtype=np.bool_),
        "fell_in_record": np.array([one.fell for one in given], dtype=np.bool_),
    }
    ideal = np.array([one.ideal_share for one in given])
    detail = {
        "low": low, "high": high, "ideal": ideal, "ideal_low": 0.9 * ideal, "ideal_high": 0.9 * ideal + 0.1,
        "if_faster": np.array([one.faster if one.runs else math.nan for one in given]),
    }  # fmt: skip
    outcomes = {
        FORMULA: Outcome(np.array([one.formula for one in given])),
        SIMULATION: Outcome(np.array([one.share for one in given]), detail, flags),
    }
    cases = Cases.of(breadth=np.full(len(given), 0.4), height=1.8, pfa=[one.pfa * GRAVITY for one in given])
    return adopt(outcomes, cases, settings, np.zeros(len(given), dtype=np.bool_))


def basis_of(found: Adoption, at: int = 0) -> str:
    return BASES[found.basis[at]]


ADOPTED = [
    (Case(0.5), (0.5, HIGH, HIGH, "formula")),
    (Case(0.5, 0, 100), (0.0, LOW, MEDIUM, "simulated")),  # the upper class is that of the interval's end
    (Case(0.5, 0, 200), (0.0, LOW, LOW, "simulated")),
    (Case(0.5, 55, 200), (0.275, MEDIUM, HIGH, "simulated")),
    (Case(0.5, 160, 200), (0.8, VERY_HIGH, VERY_HIGH, "simulated")),
    # motions that are too weak raise a class but do not lower it; a lower number of the same class is taken
    (Case(0.5, 20, 200, is_weak=True), (0.5, HIGH, HIGH, "unconfirmed")),
    (Case(0.5, 70, 200, is_weak=True), (0.35, HIGH, HIGH, "simulated")),
    (Case(0.5, 160, 200, is_weak=True), (0.8, VERY_HIGH, VERY_HIGH, "simulated")),
    # where the formula stands the interval may still raise the upper class: 5 of 20 may be as many as half
    (Case(0.1, 5, 20, is_weak=True), (0.25, MEDIUM, HIGH, "simulated")),
    # of an unknown building the class is that of the faster third where it is higher
    (Case(0.5, 20, 200, is_unknown=True), (0.1, MEDIUM, MEDIUM, "unconfirmed")),
    (Case(0.1, 20, 200, is_unknown=True, faster=0.8), (0.1, VERY_HIGH, VERY_HIGH, "unconfirmed")),
    (Case(0.1, 20, 200, faster=0.8), (0.1, MEDIUM, MEDIUM, "simulated")),
    # a piece that falls in the record is at least high
    (Case(0.1, 2, 200, fell=True), (0.01, HIGH, HIGH, "simulated")),
    (Case(0.0, 0, 200, fell=True, pfa=0.01), (0.0, HIGH, HIGH, "simulated")),  # so it can rock
    # 0.4 x 1.8 m starts at 0.222 g; with 4.28 times 0.033 g it stays below 0.65 of that, with 0.034 g it does not
    (Case(0.5, pfa=0.033), (0.0, LOW, LOW, "cannot rock")),
    (Case(0.5, 0, 200, is_unknown=True, pfa=0.033), (0.0, LOW, LOW, "cannot rock")),
    (Case(0.5, 20, 200, pfa=0.01), (0.1, MEDIUM, MEDIUM, "simulated")),  # what fell under stronger motions can rock
    (Case(0.5, pfa=0.034), (0.5, HIGH, HIGH, "formula")),
    # a higher class of the piece as given raises the upper class alone
    (Case(0.5, 130, 200, ideal=190), (0.65, HIGH, VERY_HIGH, "simulated")),
]


def test_what_is_adopted():
    found = adopted(*(case for case, _ in ADOPTED))
    for at, (case, expected) in enumerate(ADOPTED):
        shown = (found.probability[at], RiskClass(found.risk[at]), RiskClass(found.upper[at]), basis_of(found, at))
        assert shown == (pytest.approx(expected[0]), *expected[1:]), case
        interval = wilson_interval(case.overturned, case.runs) if expected[3] == "simulated" else (math.nan, math.nan)
        np.testing.assert_array_equal((found.low[at], found.high[at]), interval)


def test_a_stocky_piece_is_low_whatever_the_motion():
    unknown, no = np.full(1, np.nan), np.zeros(1, dtype=np.bool_)
    detail = dict.fromkeys(("low", "high", "ideal", "ideal_low", "ideal_high", "if_faster"), unknown)
    simulated = Outcome(unknown, detail, dict.fromkeys(("unknown_building", "weak_motions", "fell_in_record"), no))
    outcomes = {FORMULA: Outcome(np.array([0.9])), SIMULATION: simulated}
    found = adopt(outcomes, Cases.of(breadth=1.5, height=1.0, pfa=2 * GRAVITY), Settings(), np.array([False]))
    assert (basis_of(found), found.probability[0], found.upper[0]) == ("cannot rock", 0.0, LOW)
    narrow = adopt(outcomes, Cases.of(breadth=1.4, height=1.0, pfa=2 * GRAVITY), Settings(), np.array([False]))
    assert (basis_of(narrow), narrow.probability[0]) == ("formula", 0.9)


def test_ideal_adopts_what_happens_if_exactly_this_motion_recurs():
    case = Case(0.5, 100, 200, ideal=4)
    found = adopted(case, settings=Settings(ideal=True))
    assert (found.probability[0], RiskClass(found.risk[0]), RiskClass(found.upper[0])) == (0.02, LOW, MEDIUM)
    assert (found.low[0], found.high[0]) == pytest.approx((0.018, 0.118))
    assert adopted(case).probability[0] == 0.5
    ideal = adopted(Case(0.5, 0, 200, pfa=0.06), settings=Settings(ideal=True))
    assert not ideal.can_rock[0], "only peaks of motions vary"


probabilities = st.one_of(st.floats(0, 1), st.sampled_from([0.03, 0.3, 0.7]))


@st.composite
def any_case(draw):
    runs = draw(st.one_of(st.just(0), st.integers(1, 300)))
    overturned = draw(st.integers(0, runs))
    doubts = {name: draw(st.booleans()) for name in ("is_unknown", "is_weak")}
    ideal = draw(st.integers(0, runs)) if runs and draw(st.booleans()) else None
    fell, pfa = bool(runs) and draw(st.booleans()), draw(st.sampled_from([0.01, 0.05, 0.5]))
    faster = draw(probabilities)
    return Case(draw(probabilities), overturned, runs, fell=fell, ideal=ideal, pfa=pfa, faster=faster, **doubts)


@given(st.lists(any_case(), min_size=1, max_size=20))
@pytest.mark.slow
def test_nothing_comes_out_lower_than_it_should(given):
    found = adopted(*given)
    for at, case in enumerate(given):
        by_formula, risk, upper = classify(case.formula), found.risk[at], found.upper[at]
        assert upper >= risk >= classify(float(found.probability[at]))
        basis = basis_of(found, at)
        if basis == "cannot rock":
            assert not case.can_rock
            assert (case.overturned, case.fell) == (0, False)
            assert found.probability[at] == 0
            continue
        if not case.runs:
            assert found.probability[at] == case.formula
            assert (risk, basis) == (by_formula, "formula")
            continue
        assert basis != "formula"
        assert upper >= classify(case.ideal_share)
        assert found.ideal_higher[at] == (classify(case.ideal_share) > risk)
        assert upper >= classify(float(wilson_interval(case.overturned, case.runs)[1]))
        assert found.probability[at] in (case.share, case.formula)
        assert risk >= classify(case.share)
        if case.is_weak:
            assert risk >= by_formula, "where motions are too weak, the higher class of both"
        else:
            assert found.probability[at] == case.share
        if case.is_unknown:
            assert (risk >= classify(case.faster), basis) == (True, "unconfirmed")
        elif not case.is_weak:
            assert basis == "simulated"
        if case.fell:
            assert risk >= HIGH


@given(st.lists(any_case(), min_size=1, max_size=8))
@pytest.mark.slow
def test_cases_do_not_touch_each_other(given):
    together = adopted(*given)
    for at, case in enumerate(given):
        alone = adopted(case)
        for name in ("probability", "low", "high", "risk", "upper", "basis", "doubtful", "ideal_higher", "can_rock"):
            np.testing.assert_array_equal(getattr(alone, name)[0], getattr(together, name)[at])


# --- which case governs ---


def governing(*probabilities, items=None, pfa=None, basis=None):
    """Return which case governs, item by item, of adoptions of which only the chance and the basis are known."""
    count = len(probabilities)
    item = np.zeros(count, dtype=np.intp) if items is None else np.array(items)
    peaks = np.ones(count) if pfa is None else np.array(pfa)
    unknown, no, classes = np.full(count, np.nan), np.zeros(count, dtype=np.bool_), np.zeros(count, dtype=np.int64)
    bases = np.array([BASES.index(one) for one in basis or ["simulated"] * count], dtype=np.int8)
    chances = np.array(probabilities, dtype=np.float64)
    adoption = Adoption(chances, unknown, unknown, classes, classes, bases, no, no, no, unknown, no)
    return find_governing(adoption, item, peaks * GRAVITY).tolist()


def test_the_larger_chance_governs_then_the_larger_pfa_then_the_first():
    assert governing(0.2, 0.25, pfa=[2, 1]) == [1]
    assert governing(0.2, 0.2, pfa=[1, 2]) == [1]
    assert governing(0.2, 0.2, pfa=[1, 1]) == [0]
    assert governing(0.5, 0.5 + 1e-13, pfa=[1, 1]) == governing(0.5, 0.5, pfa=[1, 1 + 1e-13]) == [0], "rounding"
    assert governing(0.0, 0.0, pfa=[2, 1], basis=["cannot rock", "simulated"]) == [1]
    assert governing(0.0, 0.4, 0.01, 0.9, 0.0, items=[0, 0, 1, 2, 2]) == [1, 2, 3], "each item has its own"
    assert governing() == []


# --- which pieces are verified ---


SELECTING = [method for method in all_methods() if method.selects]
OTHER, PAPER = "kaneko_hayashi", paper_formula().key


def chosen(verify, formula, kaneko_hayashi=None, extrapolated=None, items=None, routes=None):
    count = len(formula)
    kaneko_hayashi = [0.0] * count if kaneko_hayashi is None else kaneko_hayashi
    flags = {"extrapolated": np.array(extrapolated or [False] * count, dtype=np.bool_)}
    outcomes = {
        FORMULA: Outcome(np.array(formula), flags=flags),
        OTHER: Outcome(np.array(kaneko_hayashi)),
        PAPER: Outcome(np.zeros(count), flags={"extrapolated": np.zeros(count, dtype=np.bool_)}),
    }
    item = np.arange(count) if items is None else np.array(items)
    on_routes = np.array(routes or [False] * len({*item.tolist()}), dtype=np.bool_)
    return choose_items(verify, SELECTING, outcomes, item, on_routes).tolist()


def test_which_pieces_are_simulated():
    assert chosen("none", [0.9, 0.1], routes=[True, False]) == [False, False]
    assert chosen("all", [0.9, 0.1]) == [True, True]
    assert chosen("high", []) == []
    for formulas in (([0.0, 0.2999, 0.3, 0.7],), ([0.0] * 4, [0.0, 0.2999, 0.3, 0.7])):
        assert chosen("high", *formulas) == [False, False, True, True], "by either formula"
    assert chosen("high", [0.5, 0.0], [np.nan, np.nan]) == [True, False], "unknown is no class"
    assert chosen("high", [0.0, 0.0], extrapolated=[False, True]) == [False, True]
    assert chosen("high", [0.0, 0.0], routes=[True, False]) == [True, False]
    under_any = {"items": [0, 0, 1, 1]}
    assert chosen("high", [0.0, 0.5, 0.0, 0.0], **under_any) == [True, False]
    assert chosen("high", [0.0] * 4, [0.0, 0.0, 0.0, 0.5], **under_any) == [False, True]
    assert chosen("high", [0.0] * 4, extrapolated=[True, False, False, False], **under_any) == [True, False]
