"""The probit: known coefficients come back from counts, and what it must keep to."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from scipy.stats import norm

from assess.errors import InputError
from assess.methods import Cases
from assess.methods.fitted import Probit, find_groups
from assess.studies.fit import Counts, design, fit_alternative, fit_probit, loss
from assess.units import GRAVITY
from tests.refusals import check_refusals

RUNS = 100


def counts(known: Probit, seed: int = 1, n: int = 600, runs: int = RUNS) -> Counts:
    """Return simulated counts of blocks as the studies have them."""
    random = np.random.default_rng(seed)
    height, ratio = random.uniform(0.9, 2.1, n), random.uniform(0.1, 0.5, n)
    pfa = random.uniform(0.1, 0.9, n) * GRAVITY
    pfv = pfa / (2 * np.pi * random.uniform(0.5, 3.0, n))
    risk = known.evaluate(Cases.of(breadth=ratio * height, height=height, pfa=pfa, pfv=pfv))
    return Counts(ratio * height, height, pfa, pfv, random.binomial(runs, risk), np.full(n, runs))


KNOWN = Probit(-1.2, 1.8, 0.9)
GIVEN = counts(KNOWN)


def test_groups_worked_by_hand_have_no_dimension():
    # B 0.3, H 0.4 m: r = 0.25 m, p = sqrt(3 g) rad/s; g B/H = 0.75 g
    A, V = find_groups(breadth=np.array([0.3]), height=np.array([0.4]), pfa=np.array([GRAVITY]), pfv=np.array([1.0]))
    assert A[0] == pytest.approx(4 / 3)
    assert V[0] == pytest.approx(math.sqrt(3 * GRAVITY) / (0.75 * GRAVITY))
    # lengths and times scaled so that g stays: sizes by s, velocities by root s, accelerations by 1
    s = 3.7
    one = {name: np.array([value]) for name, value in (("breadth", 0.3), ("height", 1.8), ("pfa", 3.0), ("pfv", 0.4))}
    other = {"breadth": one["breadth"] * s, "height": one["height"] * s, "pfa": one["pfa"], "pfv": one["pfv"] * s**0.5}
    np.testing.assert_allclose(find_groups(**one), find_groups(**other))


def errors(probit, columns, runs):
    """Standard errors by the expected information: the sum of runs density²/(chance (1 - chance)) x xᵀ."""
    eta = columns @ np.array(dataclasses.astuple(probit))
    weight = runs * norm.pdf(eta) ** 2 / (norm.cdf(eta) * norm.sf(eta))
    return np.sqrt(np.diag(np.linalg.inv(columns.T @ (weight[:, None] * columns))))


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("known", [KNOWN, Probit(0.4, 0.5, 3.0), Probit(-2.0, 4.0, 0.3)])
def test_known_coefficients_come_back_within_their_errors(known, seed):
    given = counts(known, seed)
    found = fit_probit(given)
    apart = np.subtract(dataclasses.astuple(found), dataclasses.astuple(known))
    assert np.all(np.abs(apart) < 4 * errors(known, design(given), given.runs))


def test_it_is_the_best_there_is_and_without_pfv_the_best_in_pfa_alone():
    columns, random = design(GIVEN), np.random.default_rng(4)
    best, in_pfa = (np.array(dataclasses.astuple(fit_probit(GIVEN, with_pfv=both))) for both in (True, False))
    least, gradient = loss(best, columns, GIVEN.fallen, GIVEN.runs)
    assert np.abs(gradient).max() < 1e-4 * GIVEN.runs.sum()
    for _ in range(50):
        near = best + random.normal(0, 0.05, 3)
        assert loss(near, columns, GIVEN.fallen, GIVEN.runs)[0] >= least
    assert in_pfa[2] == 0
    more, gradient = loss(in_pfa, columns, GIVEN.fallen, GIVEN.runs)
    assert np.abs(gradient[:2]).max() < 1e-4 * GIVEN.runs.sum()
    assert more > least


@settings(deadline=None, max_examples=60)
@given(st.tuples(st.floats(-3, 3), st.floats(0, 5), st.floats(0, 5)))
def test_gradient_is_that_of_finite_differences(b):
    columns, b = design(GIVEN), np.array(b)
    _, gradient = loss(b, columns, GIVEN.fallen, GIVEN.runs)
    for at, step in enumerate(1e-6 * np.eye(3)):
        ends = [loss(b + sign * step, columns, GIVEN.fallen, GIVEN.runs)[0] for sign in (1, -1)]
        assert gradient[at] == pytest.approx((ends[0] - ends[1]) / 2e-6, rel=1e-5, abs=0.05)


def test_a_slope_is_never_negative_and_nothing_falls_where_nothing_moves():
    found = fit_probit(counts(Probit(-1.0, -0.8, 2.0)))
    assert found.b1 == 0
    assert found.b2 > 0
    cases = Cases.of(breadth=0.3, height=1.8, pfa=[0.0, 3.0, 3.0], pfv=[0.4, 0.0, np.nan])
    np.testing.assert_array_equal(Probit(5.0, 0.0, 0.0).evaluate(cases), [0.0, 0.0, np.nan])


@settings(deadline=None, max_examples=100)
@given(
    probit=st.builds(Probit, st.floats(-10, 10), st.floats(0, 10), st.floats(0, 10)),
    height=st.floats(0.2, 3.0), ratio=st.floats(0.02, 2.0), pfa=st.floats(0, 50), pfv=st.floats(0, 10),
    factor=st.floats(1, 10), larger=st.floats(1, 10),
)  # fmt: skip
def test_bounded_and_monotone(probit, height, ratio, pfa, pfv, factor, larger):
    def chance(size=1.0, a=1.0, v=1.0, thin=1.0):
        cases = Cases.of(breadth=ratio * height * size / thin, height=height * size, pfa=pfa * a, pfv=pfv * v)
        return float(probit.evaluate(cases)[0])

    start = chance()
    assert 0 <= start <= 1
    assert chance(a=factor) >= start - 1e-12
    assert chance(v=factor) >= start - 1e-12
    assert chance(thin=factor) >= start - 1e-12
    assert chance(size=larger) <= start + 1e-12


def test_left_out_errors_are_small_for_its_own_kind_and_large_for_another_building():
    group = np.repeat([0, 1, 2], GIVEN.fallen.size // 3)
    alike = fit_alternative(GIVEN, group).left_out
    assert alike.error < 0.06  # the scatter of a share of 100: at most 0.05
    other = dataclasses.replace(GIVEN, fallen=np.where(group == 2, GIVEN.runs - GIVEN.fallen, GIVEN.fallen))
    assert fit_alternative(other, group).left_out.error > 3 * alike.error


def test_a_fit_without_a_group_is_that_to_the_others():
    group = np.repeat(["a", "b", "c"], GIVEN.fallen.size // 3)
    names = [one.name for one in dataclasses.fields(GIVEN)]
    for one, probit in zip("abc", fit_alternative(GIVEN, group).without, strict=True):
        others = Counts(**{name: getattr(GIVEN, name)[group != one] for name in names})
        assert probit == fit_probit(others)


def test_counts_that_cannot_be_fitted_are_reported():
    check_refusals(InputError, lambda change: fit_probit(dataclasses.replace(GIVEN, **change)), [
        ({"fallen": np.zeros(600, dtype=int)}, "all fell, or none"),
        ({"fallen": GIVEN.runs}, "all fell, or none"),
        ({"fallen": GIVEN.runs + 1}, "more have fallen than ran"),
        ({"pfa": np.zeros(600)}, "not above 0"),
        ({"pfv": np.full(600, np.nan)}, "not finite"),
        ({"pfv": np.ones(3)}, "different lengths"),
        ({name: np.ones(600) for name in ("breadth", "height", "pfa", "pfv")}, "do not vary"),
        ({"fallen": np.where(design(GIVEN)[:, 1] > 0.2, GIVEN.runs, 0)}, "separates all that fell"),
    ])  # fmt: skip


def test_chances_that_depend_on_nothing_leave_both_slopes_at_zero():
    """Pieces fall less under stronger motions: the best of the allowed curves is flat, at the share of all."""
    pfa = np.array([2.0, 4.0, 6.0, 8.0, 3.0, 5.0])
    counts = Counts(
        breadth=np.full(6, 0.4), height=np.array([1.0, 1.2, 1.5, 1.8, 2.0, 1.1]), pfa=pfa,
        pfv=pfa / 12 * np.array([1, 2, 1, 2, 1, 2]), fallen=np.array([8, 6, 4, 2, 7, 5]), runs=np.full(6, 10),
    )  # fmt: skip
    found = fit_probit(counts)
    assert (found.b1, found.b2) == pytest.approx((0, 0), abs=1e-6)
    assert found.evaluate(counts.cases) == pytest.approx(np.full(6, 32 / 60), abs=1e-6)
